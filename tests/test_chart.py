"""The chart and the stability map: that they show what is true."""

import math
import re
import subprocess
import sys
from itertools import cycle, pairwise
from pathlib import Path
from typing import Any

import pytest
from test_terminal import airtrack as in_terminal

import airtrack
from airtrack import (
    CHART_FPS,
    MAP_FPS,
    SERIES,
    Points,
    Scene,
    conclusion,
    main,
    picture,
    truth_m,
    verdict,
)
from examples import EXAMPLES, OWN_SCENE
from films import HERE, environment

Capture = pytest.CaptureFixture[str]
Table = dict[int, list[tuple[float, float]]]  # FPS: (error_m, cost_s) for each series


def chart(capsys: Capture, *words: str) -> tuple[str, Table, str]:
    """What the chart printed: its picture, its table, its sentence."""
    assert main(["chart", *words]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert max(len(line) for line in out.splitlines() if "Saved as" not in line) <= 80
    table: Table = {}
    for line in out.splitlines():
        if re.fullmatch(r" *[0-9]+( +[0-9.e+-]+){8}", line):
            fps, *figures = line.split()
            numbers = [float(figure) for figure in figures]
            table[int(fps)] = list(zip(numbers[::2], numbers[1::2], strict=True))
    return out[:out.index("FPS")], table, " ".join(out[out.rindex("\n\n"):].split())


SCENES = ["", "12", "4", "2 v_mps=5", "3", "14", "0", "99", "99 v_mps=1", "8 CR=0.3 x_m=0.25"]


@pytest.mark.parametrize("words", SCENES)
def test_the_chart_of_any_scene_has_its_figures_and_its_sentence_is_true(
        words: str, capsys: Capture) -> None:
    _, table, sentence = chart(capsys, *words.split())
    assert tuple(table) == CHART_FPS
    exact = [errors[3][0] for errors in table.values()]
    assert max(exact) < 1e-9
    example = EXAMPLES.get(int((words or "10").split()[0]), OWN_SCENE)
    pixel_m = 1 / Scene(**example.settings).m_to_px
    for column, (motion, correction) in enumerate(SERIES.values()):
        said = re.search(rf"{motion} \+ {correction} needs (more than )?([0-9]+) FPS", sentence)
        assert said
        too_large = [fps for fps in CHART_FPS if table[fps][column][0] > pixel_m]
        if said[1]:
            assert CHART_FPS[-1] in too_large
        else:
            enough = [fps for fps in CHART_FPS if fps > max(too_large, default=0)]
            assert int(said[2]) == enough[0]


def test_forward_eulers_error_falls_with_the_step_and_the_exact_one_is_round_off(
        capsys: Capture) -> None:
    _, table, _ = chart(capsys)
    errors_m = [table[fps][0][0] for fps in CHART_FPS]
    for coarse_m, fine_m in pairwise(errors_m[4:]):
        assert coarse_m / fine_m == pytest.approx(2, rel=0.15)
    for fps, limit_m in ((10, 1e-13), (120, 1e-12), (960, 1e-11), (3840, 1e-10)):
        assert table[fps][3][0] < limit_m


def test_the_cost_is_the_processor_time_of_the_steps_for_a_simulated_second(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    spent_s = [0.0]

    def step_for_a_microsecond(*args: Any) -> tuple[float, float, float | None]:
        spent_s[0] += 1e-6
        return step(*args)

    step = airtrack.step
    monkeypatch.setattr(airtrack, "step", step_for_a_microsecond)
    monkeypatch.setattr(airtrack, "processor_s", lambda: spent_s[0])
    _, table, _ = chart(capsys)
    for fps in CHART_FPS:
        for column in range(4):
            assert table[fps][column][1] == pytest.approx(fps * 1e-6, rel=0.05)
    for column in range(4):
        assert table[3840][column][1] > 20 * table[10][column][1]


POINTS: Points = {
    "f": [(10, 1.0, 1e-5), (100, 1e-2, 1e-4)], "s": [(10, 1.0, 1e-5), (100, 0.1, 1e-4)],
    "b": [(10, 1e-4, 3e-5), (100, 0.5, 1e-3)], "e": [(10, 1e-6, 2e-5), (100, 0, 2e-4)]}


def test_the_picture_has_each_letter_at_its_error_and_its_cost() -> None:
    lines = picture(POINTS).splitlines()
    labels = {line[:8].strip(): line for line in lines}
    axis = lines[-2]
    columns = {match[0]: match.start() + 2 for match in re.finditer("1e-0[0-9]", axis)}
    assert labels["1e+00"][columns["1e-05"]] == "+"  # f and s
    assert labels["1e-02"][columns["1e-04"]] == "f"
    assert labels["1e-01"][columns["1e-04"]] == "s"
    assert labels["1e-16"].count("e") == 2  # its label's, and no error at all
    apart = columns["1e-04"] - columns["1e-05"]
    assert labels["1e-06"].rindex("e") == columns["1e-05"] + round(math.log10(2) * apart)


def test_the_sentence_asks_for_a_rate_from_which_on_the_error_stays_small() -> None:
    assert conclusion(POINTS, 0.05) == (
        "Exact + replay at 10 FPS takes 20 us of processor time for a simulated second. To stay "
        "within one drawn pixel of the truth (50 mm), forward + rebound needs 100 FPS at 5 times "
        "that time, backward + surface needs more than 3840 FPS, backward + rebound needs more "
        "than 3840 FPS, and exact + replay needs 10 FPS.")


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_save_draws_the_chart_into_a_file_of_the_suffix_s_format(
        suffix: str, tmp_path: Path, capsys: Capture) -> None:
    pytest.importorskip("matplotlib")
    file = tmp_path / f"chart.{suffix}"
    chart(capsys, "12", "--save", str(file))
    starts = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}
    assert file.read_bytes().startswith(starts[suffix])
    if suffix == "svg":
        assert len(re.findall("exact", file.read_text())) >= 1


def test_without_matplotlib_one_line_says_what_to_install(tmp_path: Path) -> None:
    (tmp_path / "matplotlib.py").write_text("raise ImportError")
    done = subprocess.run([sys.executable, str(HERE / "airtrack.py"), "chart", "--save", "c.png"],
                          env=environment(PYTHONPATH=str(tmp_path)), capture_output=True,
                          text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == ("airtrack.py: error: --save needs matplotlib: "
                           "python -m pip install '.[chart]'\n")


def test_on_a_terminal_a_line_tells_the_progress_and_is_gone_in_the_end() -> None:
    with in_terminal("chart", columns=100) as terminal:
        terminal.until("\rmeasuring forward + rebound at 10 FPS",
                       "\rmeasuring exact + replay at 3840 FPS", "\r" + " " * 50 + "\rExample 10")
        assert terminal.ends() == 0


# The map.

def rows(capsys: Capture, *words: str) -> dict[str, str]:
    """The map's rows: the letters of each method."""
    assert main(["stability", *words]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert max(map(len, out.splitlines())) <= 80
    assert re.search("FPS" + "".join(rf" +{fps}" for fps in MAP_FPS) + "\n", out)
    return {line[:20].strip(): "".join(line[20:].split())
            for line in out.splitlines() if re.match(r"\w+ \+ \w+ ", line)}


@pytest.mark.parametrize("words", SCENES)
def test_the_map_has_a_row_for_each_legal_method_and_replay_never_fails(
        words: str, capsys: Capture) -> None:
    found = rows(capsys, *words.split())
    assert len(found) == 10
    assert {len(letters) for letters in found.values()} == {len(MAP_FPS)}
    assert set("".join(found.values())) <= set("XSGo.")
    assert found["exact + replay"] == "........."


def test_the_legend_explains_every_letter(capsys: Capture) -> None:
    main(["stability"])
    out = capsys.readouterr().out
    for letter in "XSGo.":
        assert re.search(rf"^{re.escape(letter)}  \w", out, re.MULTILINE)


@pytest.mark.parametrize(("words", "method", "fps", "letter"), [
    ("14", "backward + rebound", 10, "X"),  # thrown 4.1 m further every other frame
    ("3", "backward + none", 30, "S"),  # the trap
    ("10", "forward + rebound", 30, "G"),
    ("10", "backward + rebound", 240, "o"),  # the table of the chart: 9e-2 m
    ("10", "backward + rebound", 1000, "."),  # 1.4e-3 m at 960
    ("99", "forward + none", 1, "."),  # at rest: nothing to fail at
    ("99 v_mps=1 CR=1", "forward + none", 1, "o"),  # drawn inside the walls
])
def test_verdicts_that_other_tests_and_examples_know(
        words: str, method: str, fps: int, letter: str, capsys: Capture) -> None:
    assert rows(capsys, *words.split())[method][MAP_FPS.index(fps)] == letter


def test_the_worst_verdict_comes_first() -> None:
    # Without correction and with CR < 1, it sinks (S), is far from the truth (o), and, when it is
    # pulled harder, sinks by more than the track's length (X).
    def letter(a_mps2: float) -> str:
        scene = Scene(x_m=2, a_mps2=a_mps2, CR=0.6, correction="none")
        return verdict(scene, 30, truth_m(scene, 10))

    assert [letter(-1.5), letter(-15.0)] == ["S", "X"]


def test_S_is_for_one_wall_and_not_for_a_car_that_is_thrown_to_and_fro(
        monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene(x_m=0.5, v_mps=1, left_edge_m=0, right_edge_m=1)
    truth = truth_m(scene, 1)
    for places_m, letter in (([-0.1, 1.1], "o"), ([-0.1, -0.2], "S"), ([1.2, 1.1], "S")):
        places = cycle(places_m)
        monkeypatch.setattr(airtrack, "step", lambda *_, places=places: (next(places), 1.0, None))
        assert verdict(scene, 1, truth) == letter


def test_G_is_a_gain_of_more_than_one_percent() -> None:
    # 20 steps of forward Euler, 1 s each, gain 20 a^2/2; there were 1000 a, on the way down 1 km.
    for a_mps2, letter in ((-0.9, "o"), (-1.1, "G")):
        scene = Scene(x_m=0, a_mps2=a_mps2, left_edge_m=-1000, right_edge_m=1000, motion="forward")
        assert verdict(scene, 1, truth_m(scene, 1)) == letter


def test_X_is_further_beyond_a_wall_than_the_track_is_long() -> None:
    # From the middle of a track of 1 m, one step of v metres ends v - 0.5 m beyond the wall.
    for v_mps, letter in ((1.4, "o"), (1.6, "X")):
        scene = Scene(x_m=0.5, v_mps=v_mps, CR=1, left_edge_m=0, right_edge_m=1, correction="none")
        assert verdict(scene, 1, truth_m(scene, 1)) == letter
