"""The chart and the stability map: that they show what is true."""

import io
import math
import re
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import airtrack
from airtrack import METHODS, MOTIONS, Scene, cell, conserve, main, verdict
from examples import EXAMPLES
from figures import RATES, columns, errors_m, no_measuring, plain_letter, printed, told_plainly
from films import HERE, K, apart_m, beside_the_truth, environment

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """For tests of what is done with the figures: only a few of them."""
    no_measuring(monkeypatch)
    monkeypatch.setattr(airtrack, "CHART_FPS", RATES[:4])
    monkeypatch.setattr(airtrack, "MAP_FPS", (1, 2, 5, 10, 30))


@pytest.mark.parametrize("command", ["chart", "stability"])
@pytest.mark.usefixtures("quick")
def test_the_heading_says_what_is_measured_and_is_true(command: str, capsys: Capture) -> None:
    def told(*words: str) -> list[str]:
        main([command, *words])
        return capsys.readouterr().out.split("\n\n", 1)

    heading, rest = told("4", "CR=0.5")
    for part in ("Example 4's scene, CR=0.5.", "at 0.2 m, beyond a wall, moving", "ten times",
                 "from the true state a part of a frame later",
                 "Here all methods start on that wall.", "20 simulated seconds",
                 "motion, correction and rate do not matter"):
        assert part in " ".join(heading.split())
    assert heading.endswith("?")
    on_it, same = told("4", "CR=0.5", "x_m=0.25", "motion=forward", "fps_target=7")
    assert "beyond" not in on_it
    assert same == rest
    assert "Example 10's scene. The car starts" in told()[0]
    assert command == "chart" or re.search(  # without a pull no word of energy
        r"\nYour own scene     (.|\n)* \d+ FPS on.\n$", told("99", "v_mps=1")[1])


@pytest.mark.parametrize(("command", "last"), [
    ("chart", f"\n\nNext: {airtrack.PYTHON} airtrack.py stability\n"),
    ("stability", "\nThat was the tour. README.md has exercises.\n")])
@pytest.mark.usefixtures("quick")
def test_a_terminal_gets_a_last_line_and_if_it_wants_them_colours_that_tell_the_letters_apart(
        command: str, last: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    main([command, "12"])
    out = capsys.readouterr().out
    assert out.endswith(last)
    drawn = "".join(out.split("\n\n")[1:])
    inks = {letter: ink for ink, letter in re.findall("\x1b\\[(3[1-6])m(.)\x1b\\[0m", drawn)}
    kinds = "abcde" if command == "chart" else "XSGP-"
    assert len({inks[letter] for letter in kinds}) == 5
    for letter in set(inks) - set(kinds):  # small as capital; the energy's letters alike
        assert inks[letter] == inks["G" if letter in "gWLl" else letter.upper()]
    monkeypatch.setenv("NO_COLOR", "1")
    main([command, "12"])
    assert "\x1b" not in capsys.readouterr().out


@pytest.mark.parametrize("letter", "abc")
@pytest.mark.parametrize(("example", "CR"), [("10", 1.0), ("12", 0.8)])
def test_the_errors_are_the_worst_of_ten_cuts_and_of_first_or_second_order(
        example: str, CR: float, letter: str) -> None:
    errors = errors_m(example, letter)
    for fps, error_m in zip(RATES, errors, strict=True):
        plainly_m = max(abs(x - true_x) for cut in range(10) for x, _, true_x, _ in told_plainly(
            *METHODS[letter], CR, fps, cut))
        assert error_m == pytest.approx(plainly_m, rel=0.051)
    order = 2 if letter == "c" else 1  # half the step, a quarter of the error; or half of it
    assert 32**order < errors[2] / errors[8] < 128**order
    if (example, letter) == ("10", "c"):
        assert "half the dt it is a quarter" in " ".join(str(conserve.__doc__).split())
        assert all(3.5 < a / b < 5.5 for a, b in pairwise(errors[5:]))


@pytest.mark.parametrize("fps", [10, 30, 60, 120, 240, 480, 960])
@pytest.mark.parametrize("letter", "abcd")
def test_no_even_film_is_worse_than_its_chart_says(letter: str, fps: int) -> None:
    motion, correction = METHODS[letter]
    for number in (10, 12):  # 16 d fps_target=960 correction=surface is such a film of 10's scene
        found = beside_the_truth(number, 20 * fps, 0, motion=motion, correction=correction,
                                 fps_target=fps)[fps // 10 - 1::fps // 10]
        assert apart_m(found) <= 1.06 * errors_m(str(number), letter)[RATES.index(fps)] + 1e-9


@pytest.mark.parametrize(("example", "letter", "known_m"), [
    ("10", "d", []), ("10", "e", []), ("12", "e", []), ("14", "e", []),
    ("12", "d", [1.8e-3, 1.3e-4, 4.3e-5, 1.3e-5, 2.7e-6, 2.9e-7])])  # frames of several bounces
def test_exact_motion_is_at_round_off_where_its_correction_suffices(
        example: str, letter: str, known_m: list[float]) -> None:
    errors = errors_m(example, letter)
    assert errors[:len(known_m)] == known_m
    assert max(errors[len(known_m):]) < 1e-10


@pytest.mark.parametrize(("words", "pixel_m", "pixel", "wall_px"), [
    (["10"], 1 / 55, "0.018", 44), (["12"], 1 / 55, "0.018", 44),
    (["14", "m_to_px=1000"], 0.001, "0.001", 34), (["14", "m_to_px=0.001"], 1000, "1000", 66),
    (["10", "m_to_px=0.54"], 1.85, "1.9", 60)])  # b: 1.8 1.9 1.9 1.4
def test_the_end_says_from_which_rate_on_a_series_is_within_a_pixel_the_cheapest_first(
        words: list[str], pixel_m: float, pixel: str, wall_px: int) -> None:
    rates, *cells = columns(*words)
    told: list[tuple[float, str]] = []
    for column, (letter, (motion, correction)) in zip(cells, METHODS.items(), strict=True):
        assert column[:3] == ([f"{letter}:", motion], ["+", correction], ["error", "m", "us"])
        found = math.inf, f"{letter} at none of these rates"
        for fps, (error_m, us) in reversed(list(zip(RATES, column[3:-2], strict=True))):
            assert float(us) == float(f"{fps * len(motion) / 10:.1e}")
            if float(error_m) > pixel_m:
                break
            found = float(us), f"{letter} from {fps} FPS on, {us} us"
        told.append(found)
        first_m, last_m = float(column[8][0]), float(column[11][0])  # three doublings apart
        order, = column[-1]
        assert order == "-" if last_m < 1e-9 else (
            float(order) == pytest.approx((first_m / last_m) ** (1 / 3), rel=0.04))
    assert rates[2:-2] == (["FPS"], *([str(fps)] for fps in RATES))
    *_, advice, picture = printed("chart", *words).split("\n\n")
    says = " ".join(advice.split())
    for part in ("every 0.1 s", "in us (microseconds)", "The best are in the upper left",
                 *(f"{letter}: {' + '.join(method)}" for letter, method in METHODS.items())):
        assert part in says
    assert picture.index("|") == wall_px
    assert " ".join(picture.partition("Within a pixel ")[2].split()) == (
        f"({pixel} m) in all ten runs, the cheapest first: "
        f"{'; '.join(text for _, text in sorted(told))}.")
    # On a screen of 24 rows with the letters' meanings, an empty line, Next's two and a prompt.
    assert len(picture.splitlines()) + 2 + 1 + 2 + 1 <= 24 or "14" in words


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


@pytest.mark.parametrize(("command", "last", "rows"), [
    ("chart", 60, [b"  10", b"  30"]), ("stability", 1, [
        b"forward + none", b"forward + surface", b"forward + rebound", b"forward + conserve"])])
def test_a_row_is_out_before_the_next_is_measured_and_ctrl_c_ends_it_without_a_word(
        command: str, last: int, rows: list[bytes], monkeypatch: pytest.MonkeyPatch,
        capsys: Capture) -> None:
    out, simulate = io.BytesIO(), airtrack.simulate

    def interrupted(scene: Scene, fps: int, cut: int) -> Iterator[tuple[float, ...]]:
        if (scene.motion, fps) == ("backward", last):
            raise KeyboardInterrupt
        return simulate(scene, fps, cut)

    monkeypatch.setattr(airtrack, "simulate", interrupted)
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(out))
    assert main([command]) == 130
    assert re.findall(rb"(?m)^( +\d+|\w+ \+ \w+)  ", out.getvalue()) == rows
    assert capsys.readouterr().err == ""


def test_a_coarse_clock_and_a_series_without_any_error_are_no_fault(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    figure = airtrack.new_figure(".svg")
    monkeypatch.setattr(airtrack, "new_figure", lambda _: figure)
    monkeypatch.setattr(airtrack, "CHART_FPS", RATES[:4])
    monkeypatch.setattr("time.process_time", lambda: 1.0)
    assert main(["chart", "99", "x_m=0.25", "a_mps2=-2", "--save", str(tmp_path / "c.svg")]) == 0
    assert "\n  0.01    " in capsys.readouterr().out
    assert 0 < figure.axes[0].get_lines()[-2].get_xdata()[0] < 1e-12


def test_the_picture_has_each_point_at_its_place_and_a_wall_of_one_pixel(capsys: Capture) -> None:
    # Eight columns and four rows a power of ten: 3 is four columns, 5 three rows further than 1.
    airtrack.picture({
        "c": [(1e9, 1), (1e-2, 10)], "a": [(1e-3, 5), (3e-3, 5), (3e-3, 5)],
        "d": [(1e-6, 10), (1e-4, 20), (1, 20)], "e": [(0, 1), (1e-15, 10), (1e-4, 20)]}, 0.01)
    assert capsys.readouterr().out.split("\n\n")[-1] == """\
                          one drawn pixel |
    us    <=1 um  10 um   0.1 mm  1 mm    1 cm    0.1 m   1 m     >=10 m
     1    e                               |                       c
   1.8                                    |
   3.2                                    |
   5.6                            a   a   |
    10    +                               c
    18                    +               |               d
"""


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(("name", "start"), [
    ("ch\u00e4rt.png", b"\x89PNG"), (".svg", b"<?xml"), ("c.x.pdf", b"%PDF")])
def test_the_saved_picture_has_the_figures_and_explains_itself(
        name: str, start: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
        capsys: Capture) -> None:
    figure, file = airtrack.new_figure(name), tmp_path / name
    monkeypatch.setattr(airtrack, "new_figure", lambda _: figure)
    assert main(["chart", "14", "--save", str(file)]) == 0
    assert file.read_bytes().startswith(start)
    assert f"Saved as {str(file)!a}." in capsys.readouterr().out  # any terminal can print that
    axes, = figure.axes
    *curves, pixel = axes.lines
    for curve, (letter, method) in zip(curves, METHODS.items(), strict=True):
        assert curve.get_label() == f"{letter}: {' + '.join(method)}"
        assert list(curve.get_xdata()) == pytest.approx(errors_m("14", letter)[:4], rel=0.051)
        assert list(curve.get_ydata()) == [rate * len(method[0]) for rate in (1, 3, 6, 12)]
    assert len({curve.get_marker() for curve in curves}) == 5
    film = ["35", "36", "34", "32", "33"]  # what a terminal calls them
    assert [airtrack.COLOURED[ord(letter)][2:4] for letter in METHODS] == film
    assert [curve.get_color() for curve in curves] == [
        "tab:purple", "tab:cyan", "tab:blue", "tab:green", "tab:orange"]
    assert list(pixel.get_xdata()) == [1 / 55, 1 / 55]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert axes.yaxis_inverted()
    said = [text.get_text() for text in figure.findobj(lambda part: hasattr(part, "get_text"))]
    for part in ("Speed against accuracy\nExample 14's scene. The car starts at 1.65 m, "
                 "moving to the right at 40 m/s, not pulled; walls at 0.25 and 2.2 m; CR=1.",
                 "largest error", "better to the left", "processor time", "better upwards",
                 "10 FPS", "120 FPS",
                 *(line.get_label() for line in axes.lines), "one drawn pixel, 0.018 m"):
        assert part in "\n".join(said)
    assert figure.bbox_inches.count_contains(figure.get_tightbbox().corners()) == 4  # not cut off


@pytest.mark.parametrize(("name", "module", "says"), [
    ("chart.doc", None, "must end in .png, .svg or .pdf"), ("png", None, "not 'png'"),
    ("c.png", "raise ModuleNotFoundError(name='matplotlib')", "pip install \".[chart]\""),
    ("c.png", "raise RuntimeError('broken\\nin two lines')", "matplotlib to work: broken in"),
    ("c.png", "raise KeyError", "KeyError()"), ("nowhere/c.png", None, "No such file or directory"),
    ("c.svg", "import nothing", "nothing"), ("nowhere/bad_style.png", None, "zz")])
def test_a_picture_that_cannot_be_saved_is_refused_in_a_line_before_the_measuring_if_possible(
        name: str, module: str | None, says: str, tmp_path: Path) -> None:
    if module is not None:
        (tmp_path / "matplotlib.py").write_text(module)
    if "style" in name:
        (tmp_path / "matplotlibrc").write_text("lines.marker: zz")
    code = ("import sys, airtrack; airtrack.CHART_FPS = (10,) * 4; "
            "sys.exit(airtrack.main(['chart', '--save', sys.argv[1]]))")
    done = subprocess.run([sys.executable, "-c", code, name], capture_output=True, text=True,
                          cwd=HERE, check=False,
                          env=environment(PYTHONPATH=str(tmp_path), MATPLOTLIBRC=str(tmp_path)))
    assert done.returncode == 2
    assert ("FPS" in done.stdout) == name.startswith("nowhere")
    assert re.fullmatch(f"airtrack.py: error: .*{re.escape(says)}.*\n", done.stderr)


# The map.

LONG = {"x_m": 0.0, "left_edge_m": -1000.0, "right_edge_m": 1000.0}
SHORT = {"x_m": 0.5, "left_edge_m": 0.0, "right_edge_m": 1.0, "CR": 1.0, "correction": "none"}


@pytest.mark.parametrize(("settings", "fps", "letter"), [
    (EXAMPLES[13].settings, 10, "G"), (EXAMPLES[14].settings, 10, "X"),
    (EXAMPLES[15].settings, 10, "-"), (EXAMPLES[3].settings, 30, "S"),
    (EXAMPLES[15].settings | {"correction": "rewind"}, 10, "X"),  # thrown through the walls
    (EXAMPLES[3].settings | {"a_mps2": -15.0}, 30, "X"),  # it sinks by more than the track
    (EXAMPLES[13].settings | {"m_to_px": 0.1}, 10, "-"),  # whatever the energy
    # k steps of 1 s gain or lose k a^2/2, in the mean of 16 to 20 steps 9 a^2, and 20 a is 1 %;
    # and 20 steps are off by 10 a.
    *((LONG | {"a_mps2": side * a_mps2, "motion": motion}, 1, letter)
      for side in (-1, 1) for motion, a_mps2, letter in (
          ("forward", 2.25, "G"), ("forward", 2.2, "P"), ("backward", 2.25, "L"),
          ("backward", 2.2, "P"), ("forward", 0.0019, "P"), ("forward", 0.0017, "-"))),
    # A starting v adds 1 % of v^2/2 to that.
    (LONG | {"v_mps": 30.0, "a_mps2": -2.45, "motion": "forward"}, 1, "G"),
    (LONG | {"v_mps": 30.0, "a_mps2": -2.4, "motion": "forward"}, 1, "P"),
    # From mid-track, one step of v ends v - 0.5 m beyond a wall; the last at either in turn.
    (SHORT | {"v_mps": 1.4}, 1, "P"), (SHORT | {"v_mps": -1.6}, 1, "X"),
    (SHORT | {"x_m": 1.0, "v_mps": -1.85, "a_mps2": 0.075}, 1, "L"),
    # At CR = 0 it stays where it is found beyond the wall: in the last 5 of 20 s, or 4.
    (SHORT | {"CR": 0.0, "v_mps": 0.5 / 15.5}, 1, "S"),
    (SHORT | {"CR": 0.0, "v_mps": 0.5 / 16.5}, 1, "-")])
def test_a_verdict_is_the_first_letter_that_fits_a_run(
        settings: dict[str, Any], fps: int, letter: str) -> None:
    assert verdict(Scene(**settings), fps, 0) == letter


@pytest.mark.parametrize(("found", "letter"), [
    ("X", "X"), ("XGL-", "x"), ("SP", "s"), ("GLP-", "W"), ("GL", "W"), ("G", "G"), ("GP", "g"),
    ("L", "L"), ("L-", "l"), ("P", "P"), ("P-", "p"), ("-", "-")])
def test_a_cell_is_the_worst_of_the_cuts_and_small_where_only_some_are_so_bad(
        found: str, letter: str) -> None:
    assert cell(set(found)) == letter


@pytest.mark.parametrize(("example", "CR"), [(10, 1.0), (12, 0.8)])
def test_the_map_has_the_letters_of_a_plain_retelling(example: int, CR: float) -> None:
    _, legend, told = printed("stability", str(example)).split("\n\n")
    assert [line[:3] for line in legend.splitlines()[1:]] == [f"{one}  " for one in "XSWGLP-"]
    rates, *lines = told.splitlines()
    assert 1 + len(lines) <= 21 + 5 * (len(MOTIONS) - 3)  # a screen, with two more
    assert rates.split("scene")[0] == f"Example {example}'s "
    assert rates.split()[3:] == ["1", "2", "5", "10", "30", "60", "120", "240", "1000", "FPS"]
    any_motion = ["none", "surface", "rebound", "conserve"]
    methods = [(motion, correction) for motion in MOTIONS
               for correction in any_motion + ["rewind", "replay"] * (motion == "exact")]
    right: dict[int, list[str]] = {int(fps): [] for fps in rates.split()[3:-1]}
    for (motion, correction), row in zip(methods, lines[:len(methods)], strict=True):
        name = f"{motion} + {correction}"
        letters = row.removeprefix(f"{name} ").split()
        for fps in right:
            if set(letters[list(right).index(fps):]) == {"-"}:
                right[fps].append(name)
                break
        k = K.get(motion, 0) + K.get(correction, 0)
        if CR == 1 and k and correction != "none":  # at 1 and 2 FPS there are few lines to a hop
            assert not set(letters[2:]) & set("LlW" if k > 0 else "GgW")
        if correction in ("rewind", "replay"):
            meets_two = (example, correction) == (12, "rewind")  # bounces in a frame
            assert letters == ([*"Gg"] if meets_two else ["-"] * 2) + ["-"] * 7
            continue
        for fps, letter in zip(right, letters, strict=True):
            found = {plain_letter(told_plainly(motion, correction, CR, fps, cut))
                     for cut in range(10)}
            assert letter == cell(found)
    within = "; ".join(f"{', '.join(right[fps])} from {fps} FPS on" for fps in right if right[fps])
    energy = "conserve if k > 0, lose if k < 0." if CR == 1 else "At CR < 1 a G car hops on"
    end = " ".join(" ".join(lines[len(methods):]).split())
    assert f" not all. Within a pixel in all ten runs: {within}. " in end
    assert energy in end
