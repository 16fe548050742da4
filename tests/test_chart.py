"""The chart and the stability map: that they show what is true."""

import io
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import redirect_stdout
from dataclasses import replace
from decimal import Decimal
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import airtrack
from airtrack import SERIES, Scene, main, verdict
from examples import EXAMPLES
from films import HERE, environment
from reference import positions

Capture = pytest.CaptureFixture[str]
judged, simulate = cache(airtrack.verdict), airtrack.simulate  # judged: each run once
RATES = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)


def no_measuring(patch: pytest.MonkeyPatch) -> None:
    """Costs that depend on no machine. (That they are measured well, a test of its own tells.)"""
    patch.setattr(airtrack, "cost_us", lambda scene, fps: fps * len(scene.motion) / 10)


@cache
def samples(scene: Scene, fps: int, cut: int) -> list[tuple[float, float, float]]:
    """What a run yields, as far as the chart looks at it."""
    return [(0.0, 0.0, error_m) for _, _, error_m in simulate(scene, fps, cut) if error_m] or [
        (0.0, 0.0, 0.0)]


@cache
def printed(*words: str) -> str:
    """What the program printed. Each run is simulated once, as the zoom does not change it."""
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as out:
        no_measuring(patch)
        patch.setenv("COLUMNS", "80")
        patch.setattr(airtrack, "verdict", judged)
        if words[0] == "chart":
            patch.setattr(airtrack, "simulate", lambda scene, fps, cut: samples(
                replace(scene, m_to_px=1.0), fps, cut))
        assert main(list(words)) == 0
    assert max(map(len, out.getvalue().splitlines())) <= 80
    return out.getvalue()


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """For tests of what is done with the figures: only a few of them."""
    no_measuring(monkeypatch)
    monkeypatch.setattr(airtrack, "CHART_FPS", (10, 30))
    monkeypatch.setattr(airtrack, "MAP_FPS", (1, 2, 5, 10, 30))


@pytest.mark.parametrize("command", ["chart", "stability"])
@pytest.mark.usefixtures("quick")
def test_the_heading_says_what_is_measured_and_is_true(command: str, capsys: Capture) -> None:
    def told(*words: str) -> list[str]:
        main([command, *words])
        return capsys.readouterr().out.split("\n\n", 1)

    heading, rest = told("4", "CR=0.5")
    for part in ("Example 4", "CR=0.5", "x = 0.2 m", "20 simulated seconds", "nine ways: the worst",
                 "starts beyond a wall; here, by every method, on it",
                 "motion, correction and rate do not matter"):
        assert part in " ".join(heading.split())
    on_it, same = told("4", "CR=0.5", "x_m=0.25", "motion=forward", "fps_target=7")
    assert "beyond" not in on_it
    assert same == rest
    assert "Example 10" in told()[0]


@pytest.mark.parametrize("command", ["chart", "stability"])
@pytest.mark.usefixtures("quick")
def test_colours_tell_the_letters_apart_on_a_terminal_that_wants_them(
        command: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    main([command, "12"])
    drawn = "".join(capsys.readouterr().out.split("\n\n")[2:5])
    letter_of = dict(re.findall("\x1b\\[(3[1-5])m(.)\x1b\\[0m", drawn))
    assert set(letter_of.values()) == set("fsbwe" if command == "chart" else "XSGP-")
    monkeypatch.setenv("NO_COLOR", "1")
    main([command, "12"])
    assert "\x1b" not in capsys.readouterr().out


@cache
def table(*words: str) -> list[tuple[list[str], ...]]:
    """The columns of the chart's table, the rates' and each series': the words in each cell."""
    _, lines, *_ = printed("chart", *words).split("\n\n")
    return list(zip(*(
        [line[:4].split(), *(line[at:at + 15].split() for at in range(4, 79, 15))]
        for line in lines.splitlines()), strict=True))


def errors_m(example: str, letter: str) -> list[float]:
    """The errors of a series, one for each rate."""
    return [float(cell[0]) for cell in table(example)[1 + "fsbwe".index(letter)][3:-2]]


def errors_told_plainly(letter: str, CR: float, fps: int) -> Iterator[float]:
    """|x - truth| every 0.1 s in nine cuts of a fall from 2 m at 2 m/s^2."""
    for cut in range(9):
        late_s = cut / 9 / fps
        x, v = 2 - late_s**2, -2 * late_s
        times_s = [Decimal(late_s + tenth / 10) for tenth in range(1, 201)]
        for truth in positions(Scene(x_m=2, a_mps2=-2, CR=CR), times_s):
            for _ in range(fps // 10):
                v_before, v = v, v - 2 / fps
                x += (v_before if letter == "f" else v) / fps
                wall = min(max(x, 0.25), 2.2)
                if x != wall:
                    x = wall if letter == "s" else wall - CR * (x - wall)
                    v *= -CR
            yield abs(x - float(truth))


@pytest.mark.parametrize("letter", "fsb")
@pytest.mark.parametrize(("example", "CR"), [("10", 1.0), ("12", 0.8)])
def test_eulers_errors_are_the_worst_of_nine_cuts_and_backward_eulers_fall_with_the_step(
        example: str, CR: float, letter: str) -> None:
    errors = errors_m(example, letter)
    for fps, error_m in zip(RATES, errors, strict=True):
        plainly_m = max(errors_told_plainly(letter, CR, fps))
        assert error_m == pytest.approx(plainly_m, rel=0.051)
    if letter != "f":
        assert 32 < errors[2] / errors[8] < 128  # as the steps, 64: its order is 1


@pytest.mark.parametrize(("example", "letter", "known_m"), [
    ("10", "w", []), ("10", "e", []), ("12", "e", []), ("14", "e", []),
    ("12", "w", [2.0e-3, 9.5e-5, 4.3e-5, 1.1e-5, 3.2e-6, 2.8e-7])])  # frames of several bounces
def test_exact_motion_is_at_round_off_where_its_correction_suffices(
        example: str, letter: str, known_m: list[float]) -> None:
    errors = errors_m(example, letter)
    assert errors[:len(known_m)] == known_m
    assert max(errors[len(known_m):]) < 1e-10


@pytest.mark.parametrize(("words", "pixel_m", "wall_px"), [
    (["10"], 1 / 55, 44), (["12"], 1 / 55, 44), (["14", "m_to_px=1000"], 0.001, 34),
    (["14", "m_to_px=0.001"], 1000, 66), (["10", "m_to_px=0.54"], 1.85, 60)])  # f: 1.9 1.8 1.9 1.8
def test_the_last_row_says_from_which_rate_on_the_errors_are_within_a_pixel(
        words: list[str], pixel_m: float, wall_px: int) -> None:
    rates, *columns = table(*words)
    for column, (letter, (motion, correction)) in zip(columns, SERIES.items(), strict=True):
        assert column[:3] == ([letter, motion], ["+", correction], ["error", "m", "us"])
        expected = [">", "3840", "FPS"]
        for fps, (error_m, us) in reversed(list(zip(RATES, column[3:-2], strict=True))):
            assert float(us) == float(f"{fps * len(motion) / 10:.1e}")
            if float(error_m) > pixel_m:
                break
            expected = [str(fps), "FPS", us]
        assert column[-1] == expected
    assert rates[2:-2] == (["FPS"], *([str(fps)] for fps in RATES))
    assert f"({1000 * pixel_m:.3g} mm)" in printed("chart", *words)
    *_, advice, picture = printed("chart", *words).split("\n\n")
    assert "The best are where both are small: in the upper left." in " ".join(advice.split())
    assert picture.index("|") == wall_px


def test_the_cost_is_the_processor_time_of_the_bare_steps_and_the_best_of_five_runs(
        monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[tuple[float, float]] = []
    run = [(1.0 + frame, 1 / 480) for frame in range(20 * 480)]
    dear = 4 * len(run)  # a step of the first four runs takes 2 us, any other 1 us

    def step(_: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, None]:
        taken.append((x_m, dt_s))
        return x_m + 1, v_mps, None

    monkeypatch.setattr(airtrack, "step", step)
    monkeypatch.setattr("time.process_time", lambda: 1e-6 * (len(taken) + min(len(taken), dear)))
    assert airtrack.cost_us(Scene(x_m=1.0), 480) == pytest.approx(480)
    assert taken == run * (len(taken) // len(run))


def test_a_row_is_out_before_the_next_is_measured_and_ctrl_c_ends_it_without_a_word(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    out, simulate = io.BytesIO(), airtrack.simulate

    def until_60(scene: Scene, fps: int, cut: int) -> Iterator[tuple[float, float, float]]:
        if fps == 60:
            raise KeyboardInterrupt
        return simulate(scene, fps, cut)

    monkeypatch.setattr(airtrack, "simulate", until_60)
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(out))
    assert main(["chart"]) == 130
    assert re.findall(rb"(?m)^ +(\d+)  ", out.getvalue()) == [b"10", b"30"]
    assert capsys.readouterr().err == ""


def test_the_picture_has_each_point_at_its_place_and_a_wall_of_one_pixel(capsys: Capture) -> None:
    # Eight columns and four rows a power of ten: 3 is four columns, 5 three rows further than 1.
    airtrack.picture({
        "f": [(1e9, 1), (1e-2, 10)], "s": [(1e-3, 5), (3e-3, 5), (3e-3, 5)],
        "w": [(1e-6, 10), (1e-4, 20), (1, 20)], "e": [(0, 1), (1e-15, 10), (1e-4, 20)]}, 0.01)
    assert capsys.readouterr().out.split("\n\n")[-1] == """\
                          one drawn pixel |
    us    <= 1 um 10 um   0.1 mm  1 mm    1 cm    0.1 m   1 m     >= 10 m
     1    e                               |                       f
   1.8                                    |
   3.2                                    |
   5.6                            s   s   |
    10    +                               f
    18                    +               |               w
"""


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(("suffix", "start"), [
    (".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF")])
def test_the_saved_picture_has_the_figures_and_explains_itself(
        suffix: str, start: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
        capsys: Capture) -> None:
    figure, file = airtrack.new_figure(suffix), tmp_path / f"ch\u00e4rt{suffix}"
    monkeypatch.setattr(airtrack, "new_figure", lambda _: figure)
    assert main(["chart", "14", "--save", str(file)]) == 0
    assert file.read_bytes().startswith(start)
    assert f"Saved as {str(file)!a}." in capsys.readouterr().out  # any terminal can print that
    axes, = figure.axes
    *curves, pixel = axes.lines
    for curve, (letter, method) in zip(curves, SERIES.items(), strict=True):
        assert curve.get_label() == " + ".join(method)
        assert list(curve.get_xdata()) == [len(method[0]), 3 * len(method[0])]
        assert list(curve.get_ydata()) == pytest.approx(errors_m("14", letter)[:2], rel=0.051)
    assert list(pixel.get_ydata()) == [1 / 55, 1 / 55]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    said = [text.get_text() for text in figure.findobj(lambda part: hasattr(part, "get_text"))]
    for part in ("Speed against accuracy", "Example 14", "largest error", "better downwards",
                 "processor time", "better to the left", "10 FPS", "30 FPS",
                 *(line.get_label() for line in axes.lines), "one drawn pixel, 0.018 m"):
        assert part in "\n".join(said)
    assert figure.bbox_inches.count_contains(figure.get_tightbbox().corners()) == 4  # not cut off


@pytest.mark.parametrize(("name", "module", "says"), [
    ("chart.doc", None, "must end in .png, .svg or .pdf"), ("png", None, "not 'png'"),
    ("c.png", "raise ModuleNotFoundError(name='matplotlib')", "pip install '.[chart]'"),
    ("c.png", "raise RuntimeError('broken\\nin two lines')", "broken"),
    ("c.png", "", "matplotlib"), ("nowhere/c.png", None, "No such file or directory")])
def test_a_picture_that_cannot_be_saved_is_refused_in_a_line_before_the_measuring_if_possible(
        name: str, module: str | None, says: str, tmp_path: Path) -> None:
    if module is not None:
        (tmp_path / "matplotlib.py").write_text(module)
    code = ("import sys, airtrack; airtrack.CHART_FPS = (10,); "
            "sys.exit(airtrack.main(['chart', '--save', sys.argv[1]]))")
    done = subprocess.run([sys.executable, "-c", code, name], capture_output=True, text=True,
                          cwd=HERE, env=environment(PYTHONPATH=str(tmp_path)), check=False)
    assert done.returncode == 2
    assert ("FPS" in done.stdout) == name.startswith("nowhere")
    assert re.fullmatch(f"airtrack.py: error: .*{re.escape(says)}.*\n", done.stderr)


# The map.

LONG = {"x_m": 0.0, "left_edge_m": -1000.0, "right_edge_m": 1000.0, "motion": "forward"}
SHORT = {"x_m": 0.5, "left_edge_m": 0.0, "right_edge_m": 1.0, "CR": 1.0, "correction": "none"}


@pytest.mark.parametrize(("settings", "fps", "letter"), [
    (EXAMPLES[13].settings, 10, "G"), (EXAMPLES[14].settings, 10, "X"),
    (EXAMPLES[15].settings, 10, "-"), (EXAMPLES[3].settings, 30, "S"),
    (EXAMPLES[3].settings | {"a_mps2": -15.0}, 30, "X"),  # it sinks by more than the track
    # 20 steps of forward Euler, 1 s each, gain 20 a^2/2 of 1000 a, and are off by 10 a.
    (LONG | {"a_mps2": -1.1}, 1, "G"), (LONG | {"a_mps2": 1.1}, 1, "G"),
    (LONG | {"a_mps2": -0.9}, 1, "P"), (LONG | {"a_mps2": 0.9}, 1, "P"),
    (LONG | {"a_mps2": 0.0019}, 1, "P"), (LONG | {"a_mps2": 0.0017}, 1, "-"),
    # From mid-track, one step of v ends v - 0.5 m beyond a wall; the last is so at both by turns.
    (SHORT | {"v_mps": 1.4}, 1, "P"), (SHORT | {"v_mps": -1.6}, 1, "X"),
    (SHORT | {"x_m": 1.0, "v_mps": -1.2, "a_mps2": 0.005}, 1, "P"),
    # At CR = 0 it stays where it is found beyond the wall: in the last 5 of 20 s, or 4.
    (SHORT | {"CR": 0.0, "v_mps": 0.5 / 15.5}, 1, "S"),
    (SHORT | {"CR": 0.0, "v_mps": 0.5 / 16.5}, 1, "-")])
def test_a_verdict_is_the_worst_that_a_run_deserves(
        settings: dict[str, Any], fps: int, letter: str) -> None:
    assert verdict(Scene(**settings), fps, 0) == letter


@pytest.mark.parametrize("example", [10, 12])
def test_the_map_has_the_worst_of_nine_cuts_for_each_legal_method(example: int) -> None:
    _, rates, *motions, legend = printed("stability", str(example)).split("\n\n")
    assert rates.split() == ["FPS", "1", "2", "5", "10", "30", "60", "120", "240", "1000"]
    assert [line[:3] for line in legend.splitlines()[1:]] == [f"{letter}  " for letter in "XSGP-"]
    rows = "\n\n".join(motions).splitlines()
    assert [line[:20].rstrip() for line in rows] == [
        "forward + none", "forward + surface", "forward + rebound", "",
        "backward + none", "backward + surface", "backward + rebound", "",
        "exact + none", "exact + surface", "exact + rebound", "exact + rewind", "exact + replay"]
    for row in filter(None, rows):
        motion, _, correction, *letters = row.split()
        method = {"motion": motion, "correction": correction}
        scene = Scene(**EXAMPLES[example].settings | method)
        for fps, letter in zip(rates.split()[1:], letters, strict=True):
            found = [judged(scene, int(fps), cut) for cut in range(9)]
            assert letter == min(found, key="XSGP-".index)
        if row.startswith(("backward + surface", "backward + rebound")):
            assert letters == sorted(letters, key="XSGP-".index)
    assert letters == ["-"] * 9  # exact + replay
