"""The chart and the stability map: that they show what is true."""

import io
import math
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import redirect_stdout
from functools import cache
from itertools import cycle, pairwise
from pathlib import Path
from typing import Any

import pytest

import airtrack
from airtrack import (
    CHART_FPS,
    CUTS,
    MAP_FPS,
    SERIES,
    VERDICTS,
    Points,
    Scene,
    conclusion,
    main,
    picture,
    truths,
    verdict,
)
from examples import EXAMPLES, OWN_SCENE
from films import HERE, environment

Capture = pytest.CaptureFixture[str]
Table = dict[int, list[tuple[float, float]]]  # FPS: (error_m, cost_us) for each series


@cache
def printed(*words: str) -> str:
    """What the program printed. (That a cost is measured well, a test of its own looks at.)"""
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as out:
        patch.setattr(airtrack, "cost_s", lambda scene, fps: fps * 1e-6)
        assert main(list(words)) == 0
    return out.getvalue()


@cache
def chart(*words: str) -> tuple[str, Table, str]:
    """The chart's heading and picture, its table, its sentence."""
    out = printed("chart", *words)
    assert max(map(len, out.splitlines())) <= 80
    table: Table = {}
    for line in out.splitlines():
        if re.fullmatch(r" *[0-9]+( +[0-9.e+-]+){10}", line):
            fps, *figures = line.split()
            numbers = [float(figure) for figure in figures]
            table[int(fps)] = list(zip(numbers[::2], numbers[1::2], strict=True))
    return out[:out.index(" FPS  ")], table, " ".join(out[out.rindex("\n\n"):].split())


@pytest.fixture
def no_measuring(monkeypatch: pytest.MonkeyPatch) -> None:
    """For tests of what is done with the figures."""
    monkeypatch.setattr(airtrack, "measure", lambda _: {
        letter: [(fps, 1 / fps, 1e-6 * fps) for fps in CHART_FPS] for letter in SERIES})


# The figures, against the same told in the plainest way.

def errors_told_plainly(motion: str, CR: float, fps: int) -> Iterator[float]:
    """|x - truth| every 0.1 s in nine cuts of the scene of example 8, or of it with this CR."""
    fall_s, top_m = math.sqrt(1.75), 1.75

    def truth(t_s: float) -> tuple[float, float]:
        before_s, after_s, height_m = 0.0, fall_s, top_m  # the top of each flight, closed form
        while CR**2 * height_m > 1e-20 and t_s > before_s + after_s:
            before_s += after_s * (1 + CR)
            after_s, height_m = after_s * CR, height_m * CR**2
        since_top_s = t_s - before_s
        if abs(since_top_s) > after_s:
            return 0.25, 0.0
        return 0.25 + height_m - since_top_s**2, -2 * since_top_s

    for cut in range(9):
        late_s = cut / 9 / fps
        x, v = truth(late_s)
        for frame in range(1, 20 * fps + 1):
            if motion == "backward":
                v -= 2 / fps
                x += v / fps
            else:
                x += v / fps
                v -= 2 / fps
            for wall, outwards in ((0.25, -1), (2.2, 1)):
                if (x - wall) * outwards > 0:
                    x -= (x - wall) * (1 + CR)
                    v *= -CR
                    break
            if frame % (fps // 10) == 0:
                yield abs(x - truth(late_s + frame / fps)[0])


@pytest.mark.parametrize(("words", "CR"), [("10", 1.0), ("12", 0.8)])
def test_the_errors_are_the_worst_of_nine_cuts_of_the_same_motion(
        words: str, CR: float) -> None:
    _, table, _ = chart(words)
    for fps in (10, 60, 480):
        for column, motion in ((0, "forward"), (2, "backward")):
            plainly_m = max(errors_told_plainly(motion, CR, fps))
            assert table[fps][column][0] == pytest.approx(plainly_m, rel=0.051)


@pytest.mark.parametrize("words", ["10", "12"])
def test_backward_eulers_errors_fall_with_the_step_and_exact_replay_is_round_off(
        words: str) -> None:
    """On log-log axes the slope of error against step is the order of the method: 1."""
    _, table, _ = chart(words)
    rates = CHART_FPS[2:]
    xs = [math.log(1 / fps) for fps in rates]
    for column in (1, 2):
        ys = [math.log(table[fps][column][0]) for fps in rates]
        mean_x, mean_y = sum(xs) / len(xs), sum(ys) / len(ys)
        slope = (sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys, strict=True))
                 / sum((x - mean_x) ** 2 for x in xs))
        assert 0.8 < slope < 1.2
    assert max(errors[4][0] for errors in table.values()) < 1e-10


def test_rewind_is_round_off_in_example_10_and_off_where_a_frame_holds_more_bounces() -> None:
    ten, twelve = (chart(words)[1] for words in ("10", "12"))
    assert max(errors[3][0] for errors in ten.values()) < 1e-10
    assert [twelve[fps][3][0] > 1e-7 for fps in CHART_FPS] == [True] * 6 + [False] * 3
    assert max(twelve[fps][3][0] for fps in (960, 1920, 3840)) < 1e-11


@pytest.mark.parametrize("words", ["10", "12", "14"])
def test_the_sentence_follows_from_the_figures(words: str) -> None:
    _, table, sentence = chart(words)
    assert tuple(table) == CHART_FPS
    pixel_m = 1 / 55
    assert "(18.2 mm)" in sentence
    for column, (motion, correction) in enumerate(SERIES.values()):
        said = re.search(rf"{motion} \+ {correction} needs (more than )?([0-9]+) FPS", sentence)
        assert said
        too_large = [fps for fps in CHART_FPS if table[fps][column][0] > pixel_m]
        if said[1]:
            assert CHART_FPS[-1] in too_large
        else:
            assert int(said[2]) == min(
                fps for fps in CHART_FPS if fps > max(too_large, default=0))


def test_the_sentence_asks_for_a_rate_from_which_on_the_error_stays_small() -> None:
    assert conclusion(POINTS, 0.05) == (
        "To stay within one drawn pixel of the truth (50 mm) in all nine cuts, exact + replay "
        "needs 10 FPS and 20 us of processor time for a simulated second, backward + rebound needs "
        "more than 3840 FPS, backward + surface needs more than 3840 FPS, forward + rebound needs "
        "100 FPS and 5 times that.")


@pytest.mark.usefixtures("no_measuring")
def test_the_heading_says_what_was_measured(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr(airtrack, "verdict", lambda *_: "-")
    for command in ("chart", "stability"):
        main([command, "4", "CR=0.5"])
        heading = " ".join(capsys.readouterr().out.split("\n\n")[0].split())
        for part in ("x = 0.2 m", "Example 4", "CR=0.5", "20 simulated seconds", "nine ways",
                     "worst of the nine", "motion, correction and frame rate do not matter",
                     "beyond a wall; here, for every method alike, on it"):
            assert part in heading
    main(["stability"])
    assert "wall" not in capsys.readouterr().out.split("\n\n")[0]


def test_the_cost_is_the_processor_time_of_the_bare_loop_for_a_simulated_second(
        monkeypatch: pytest.MonkeyPatch) -> None:
    spent_s = [0.0]

    def step_for_a_microsecond(*args: Any) -> tuple[float, float, float | None]:
        spent_s[0] += 1e-6
        return step(*args)

    step = airtrack.step
    monkeypatch.setattr(airtrack, "step", step_for_a_microsecond)
    monkeypatch.setattr(airtrack, "processor_s", lambda: spent_s[0])
    for fps in (10, 480):
        assert airtrack.cost_s(Scene(), fps) == pytest.approx(fps * 1e-6)


# The picture in the terminal.

POINTS: Points = {
    "f": [(10, 1.0, 1e-5), (100, 1e-2, 1e-4)], "s": [(10, 1.0, 1e-5), (100, 0.1, 1e-4)],
    "b": [(10, 1e-4, 3e-5), (100, 0.5, 1e-3)], "e": [(10, 1e-6, 2e-5), (100, 0, 2e-4)]}


def test_the_picture_has_each_letter_at_its_error_and_its_cost() -> None:
    lines = picture(POINTS, 1e-3, 100).splitlines()
    assert max(map(len, lines)) <= 100
    labels = {line[:6].strip(): line for line in lines}
    ticks = {match[0]: match.start() for match in re.finditer("[0-9]+(?= us)", lines[-2])}
    assert labels["1e+00"][ticks["10"]] == "+"  # f and s
    assert labels["1e-02"][ticks["100"]] == "f"
    assert labels["1e-01"][ticks["100"]] == "s"
    assert labels["1e-16"].count("e") == 2  # its label's, and no error at all
    apart = ticks["100"] - ticks["10"]
    assert labels["1e-06"].rindex("e") == ticks["10"] + round(math.log10(2) * apart)
    assert labels["1e-03"].count("-") > 50
    assert labels["1e-03"].endswith("one pixel")
    assert "10 e" in labels["1e-06"]
    assert "f 100" in labels["1e-02"]


def test_what_a_plus_is_and_the_colours_of_a_terminal(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    assert "+ where series meet" in picture(POINTS, 1e-3, 80)
    monkeypatch.setattr(airtrack, "measure", lambda _: POINTS)
    letters_in_turn = cycle("P" * 9 + "X" * 9 + "S" * 9 + "G" * 9 + "-" * 9)
    monkeypatch.setattr(airtrack, "verdict", lambda *_: next(letters_in_turn))
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    for words, letters in ((["chart", "14"], "fsbe"), (["stability", "14"], VERDICTS)):
        main(words)
        coloured = capsys.readouterr().out
        for letter in letters:
            assert re.search(f"\x1b\\[3[1-5]m{letter}\x1b\\[0m", coloured)
        monkeypatch.setenv("NO_COLOR", "1")
        main(words)
        assert "\x1b" not in capsys.readouterr().out
        monkeypatch.delenv("NO_COLOR")


@pytest.mark.parametrize(("columns", "width"), [(70, 70), (90, 90), (200, 100)])
def test_it_is_as_wide_as_the_terminal_up_to_100_columns(
        columns: int, width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    widest = max(map(len, picture(POINTS, 1e-3, airtrack.picture_columns()).splitlines()))
    assert width - 8 <= widest <= width


def test_the_line_of_progress_is_gone_whatever_ended_the_measuring(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setattr(airtrack, "simulate", interrupted)
    assert main(["chart"]) == 130
    out, err = capsys.readouterr()
    assert out.startswith("\rmeasuring forward + rebound at 10 FPS")
    assert out.endswith("\r" + " " * 50 + "\r")
    assert err == ""


# The picture in a file.

@pytest.mark.usefixtures("no_measuring")
def test_save_draws_the_chart_in_the_format_of_the_suffix(
        tmp_path: Path, capsys: Capture) -> None:
    pytest.importorskip("matplotlib")
    starts = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}
    for suffix, start in starts.items():
        file = tmp_path / f"chart.{suffix}"
        assert main(["chart", "14", "--save", str(file)]) == 0
        assert file.read_bytes().startswith(start)
        assert f"Saved as {str(file)!r}." in capsys.readouterr().out
    assert len(list(tmp_path.iterdir())) == len(starts)


def test_the_saved_picture_explains_itself(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.colors import to_hex

    figure = airtrack.new_figure(str(tmp_path / "chart.png"))
    points = {letter: [(fps, 1 / fps, 1e-6 * fps) for fps in CHART_FPS] for letter in SERIES}
    airtrack.draw(figure, points, 0.02, "The scene in words.")
    axes, = figure.axes
    assert figure.get_suptitle() == "Speed against accuracy"
    assert axes.get_title() == "The scene in words."
    assert "processor time" in axes.get_xlabel()
    assert "error" in axes.get_ylabel()
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    curves = [line for line in axes.lines if len(list(line.get_xdata())) == len(CHART_FPS)]
    for line in curves:
        assert list(line.get_xdata()) == pytest.approx(CHART_FPS)
        assert list(line.get_ydata()) == pytest.approx([1 / fps for fps in CHART_FPS])
    assert len(curves) == len(SERIES)
    texts = {text.get_text(): text for text in axes.texts}
    colours = {to_hex(line.get_color()) for line in curves}
    for method in SERIES.values():
        assert to_hex(texts[" + ".join(method)].get_color()) in colours
    assert len(colours) == len(SERIES)
    for text in ("10 FPS", "3840", "one drawn pixel,\n0.02 m"):
        assert text in texts
    assert any("better" in text for text in texts)
    assert any("rounded" in text for text in texts)
    assert any(list(line.get_ydata()) == [0.02, 0.02] for line in axes.lines)


@pytest.mark.parametrize(("name", "why"), [
    ("folder.png", "directory"), ("nowhere/chart.png", "No such file"), ("chart.doc", "doc"),
    ("chart", "ends in .png, .svg or .pdf"), ("locked/chart.png", "ermission"),
    ("chart.pgf", "tex")])
def test_a_file_that_cannot_be_written_is_refused_before_the_measuring(
        name: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
        capsys: Capture) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(airtrack, "measure", lambda _: pytest.fail("it measured"))
    monkeypatch.setenv("PATH", "")  # no TeX
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "locked").mkdir(mode=0o500)
    if name.startswith("locked") and os.access(tmp_path / "locked", os.W_OK):
        name = "/proc/chart.png"  # root may write everywhere else
        why = "No such file"
    before = sorted(tmp_path.rglob("*"))
    assert main(["chart", "--save", str(tmp_path / name)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("airtrack.py: error: --save")
    assert err.count("\n") == 1
    assert why.lower() in err.lower()
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.usefixtures("no_measuring")
def test_an_existing_file_is_untouched_until_the_new_picture_is_whole(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    file = tmp_path / "chart.png"
    file.write_bytes(b"the old one")

    def broken(*_: object) -> None:
        raise KeyboardInterrupt

    for name in ("measure", "draw"):
        with monkeypatch.context() as patch:
            patch.setattr(airtrack, name, broken)
            assert main(["chart", "14", "--save", str(file)]) == 130
        assert file.read_bytes() == b"the old one"
    assert main(["chart", "14", "--save", str(file)]) == 0
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("module", "says"), [
    ("raise ModuleNotFoundError(name='matplotlib')", "pip install '.[chart]'"),
    ("raise RuntimeError('broken\\nin two lines')", "broken in two lines"),
    ("raise ImportError", "ImportError()"), ("", "matplotlib")])
def test_without_a_working_matplotlib_one_line_says_so(
        module: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "matplotlib.py").write_text(module)
    done = subprocess.run([sys.executable, str(HERE / "airtrack.py"), "chart", "--save", "c.png"],
                          env=environment(PYTHONPATH=str(tmp_path)), capture_output=True,
                          text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("airtrack.py: error: --save 'c.png': ")
    assert says in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.skipif(sys.platform != "linux", reason="needs Linux's locales")
def test_a_name_that_the_terminal_cannot_print_is_no_fault(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    code = ("import sys, airtrack; airtrack.CHART_FPS = (10, 30); "
            "sys.exit(airtrack.main(['chart', '--save', *sys.argv[1:]]))")
    for name in ("\u00fcber.png", "\udcff.png"):
        done = subprocess.run([sys.executable, "-c", code, os.fsencode(tmp_path / name)], cwd=HERE,
                              capture_output=True, check=False,
                              env=environment(PYTHONIOENCODING="ascii", PYTHONUTF8="1"))
        assert (done.returncode, done.stderr) == (0, b"")
        assert (tmp_path / name).exists()


# The map.

@cache
def rows(*words: str) -> tuple[dict[str, str], str]:
    """The map's rows, the letters of each method; its sentence."""
    out = printed("stability", *words)
    assert max(map(len, out.splitlines())) <= 80
    assert re.search("FPS" + "".join(rf" +{fps}" for fps in MAP_FPS) + "\n", out)
    found = {line[:20].strip(): "".join(line[20:].split())
             for line in out.splitlines() if re.match(r"\w+ \+ \w+  ", line)}
    return found, " ".join(out[out.rindex("\n\n"):].split())


@pytest.mark.parametrize("words", ["10", "12"])
def test_the_map_has_a_row_for_each_legal_method_and_its_sentence_is_true(words: str) -> None:
    found, sentence = rows(words)
    assert len(found) == 11
    assert set("".join(found.values())) <= set(VERDICTS)
    assert found["exact + replay"] == "-" * len(MAP_FPS)
    parts = sentence.removesuffix(".").split(", ", 1)[1].split("; ")
    said = {name: part.split(": ")[0] for part in parts for name in part.split(": ")[1].split(", ")}
    for name, letters in found.items():
        good = [fps for i, fps in enumerate(MAP_FPS) if set(letters[i:]) == {"-"}]
        assert said[name] == ("at every rate" if len(good) == len(MAP_FPS) else
                              f"from {good[0]} FPS on" if good else "not even at 1000 FPS")


@pytest.mark.parametrize("words", ["10", "12"])
def test_no_letter_of_backward_euler_is_worse_at_a_higher_rate(words: str) -> None:
    found, _ = rows(words)
    for name in ("backward + surface", "backward + rebound"):
        ranks = [list(VERDICTS).index(letter) for letter in found[name]]
        assert ranks == sorted(ranks)


def test_the_legend_explains_every_letter_and_motions_stand_apart() -> None:
    out = printed("stability", "10")
    for letter in VERDICTS:
        assert re.search(rf"^{re.escape(letter)}  \w", out, re.MULTILINE)
    for above, below in pairwise(re.findall(r"^(?:\w+(?= \+ \w+  )|$)", out, re.MULTILINE)):
        assert above == below or "" in (above, below)


@pytest.mark.parametrize(("number", "motion", "correction", "fps", "letter"), [
    (14, "backward", "rebound", 10, "X"),  # thrown 4.1 m further every other frame
    (14, "exact", "rewind", 10, "X"),
    (14, "exact", "replay", 1, "-"),
    (3, "backward", "none", 30, "S"),  # the trap
    (10, "forward", "rebound", 30, "G"),
    (10, "backward", "rebound", 1000, "P"),  # the table of the chart: 52 mm at 960
    (12, "exact", "rewind", 1, "P"),
    (99, "forward", "none", 1, "-"),  # at rest: nothing to fail at
])
def test_verdicts_that_other_tests_and_examples_know(
        number: int, motion: str, correction: str, fps: int, letter: str) -> None:
    settings = EXAMPLES.get(number, OWN_SCENE).settings
    scene = Scene(**settings | {"motion": motion, "correction": correction})
    found = {judged(scene, fps, cut) for cut in range(CUTS)}
    assert next(worst for worst in VERDICTS if worst in found) == letter


def judged(scene: Scene, fps: int, cut: int = 0) -> str:
    return verdict(scene, fps, cut, truths(scene))


def test_the_worst_of_the_cuts_is_the_one_that_is_shown(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr(airtrack, "verdict", lambda scene, fps, cut, _: "-PGP-GP-P"[cut])
    main(["stability"])
    letters = re.findall(r"^\w+ \+ \w+ +(.*)", capsys.readouterr().out, re.MULTILINE)
    assert {"".join(row.split()) for row in letters} == {"G" * len(MAP_FPS)}
    assert CUTS == 9


def test_the_worst_verdict_comes_first() -> None:
    # Without correction and with CR < 1, it sinks (S), is far from the truth (P), and, when it is
    # pulled harder, sinks by more than the track's length (X).
    found = [judged(Scene(x_m=2, a_mps2=a_mps2, CR=0.6, correction="none"), 30)
             for a_mps2 in (-1.5, -15.0)]
    assert found == ["S", "X"]


def test_S_is_for_one_wall_all_through_the_last_five_seconds(
        monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene(x_m=0.5, v_mps=1, left_edge_m=0, right_edge_m=1)
    tenths, out, inside = truths(scene), -0.1, 0.5
    for places_m, letter in (
            ([-0.1, 1.1] * 10, "P"), ([-0.1, -0.2] * 10, "S"), ([1.2, 1.1] * 10, "S"),
            ([inside] * 15 + [out] * 5, "S"), ([inside] * 16 + [out] * 4, "P")):
        places = cycle(places_m)
        monkeypatch.setattr(airtrack, "simulate", lambda *_, places=places: (
            (next(places), 1.0, 1.0) for _ in range(20)))
        assert verdict(scene, 1, 0, tenths) == letter


def test_G_is_a_gain_of_more_than_one_percent() -> None:
    # 20 steps of forward Euler, 1 s each, gain 20 a^2/2; there were 1000 a, on the way down 1 km.
    for a_mps2, letter in ((-0.9, "P"), (-1.1, "G")):
        scene = Scene(x_m=0, a_mps2=a_mps2, left_edge_m=-1000, right_edge_m=1000, motion="forward")
        assert judged(scene, 1) == letter


def test_X_is_further_beyond_a_wall_than_the_track_is_long() -> None:
    # From the middle of a track of 1 m, one step of v metres ends v - 0.5 m beyond the wall.
    for v_mps, letter in ((1.4, "P"), (1.6, "X")):
        scene = Scene(x_m=0.5, v_mps=v_mps, CR=1, left_edge_m=0, right_edge_m=1, correction="none")
        assert judged(scene, 1) == letter
