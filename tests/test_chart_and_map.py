"""The chart and the stability map: that they show what is true."""

import io
import math
import re
from collections.abc import Iterator
from contextlib import redirect_stdout
from dataclasses import replace
from decimal import Decimal
from functools import cache
from typing import Any

import pytest

import airtrack
from airtrack import (
    CUTS,
    METHODS,
    MOTIONS,
    PYTHON,
    VERDICTS,
    Point,
    Sample,
    Scene,
    cell,
    main,
    verdict,
)
from examples import EXAMPLES
from films import apart_m, beside_the_truth
from reference import states

Capture = pytest.CaptureFixture[str]
RATES = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)
Samples = list[tuple[float, ...]]  # x, v, the true x and the true v
simulate = airtrack.simulate


@cache
def simulated(scene: Scene, fps: int, cut: int) -> list[Sample]:
    return simulate(scene, fps, cut)


@cache
def printed(*words: str) -> str:
    """What the program printed, with costs that depend on no machine."""
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as out:
        patch.setenv("COLUMNS", "80")
        patch.setattr(airtrack, "cost_us", lambda scene, fps: fps * len(scene.motion) / 10)
        patch.setattr(airtrack, "simulate", lambda scene, fps, cut: simulated(
            replace(scene, m_to_px=1.0), fps, cut))  # the zoom does not change a run
        assert main(list(words)) == 0
    assert max(map(len, out.getvalue().splitlines())) <= 80
    return out.getvalue()


def errors_m(example: str, letter: str) -> list[float]:
    """The errors of a method in the chart's table, one for each rate."""
    column = 4 + 15 * "abcde".index(letter)
    rows = re.findall(r"(?m)^ *\d+  [0-9.]+e.*$", printed("chart", example))
    assert [int(row[:4]) for row in rows] == list(RATES)
    return [float(row[column:column + 9]) for row in rows]


# The same runs, told plainly: a fall from 2 m at 2 m/s^2 (examples 10 and 12).

def shift_of(cut: int, fps: int) -> float:
    return (3 * cut - 2) / 27 / fps if cut else 0.0


@cache
def truth(CR: float, fps: int, cut: int) -> list[tuple[float, float]]:
    """The true states at the samples, from 60-digit decimals."""
    shift_s, frames = shift_of(cut, fps), max(1, fps // 10)
    times_s = [Decimal(shift_s + frame / fps) for frame in range(frames, 20 * fps + 1, frames)]
    return [(float(x), float(v)) for x, v in states(Scene(x_m=2, a_mps2=-2, CR=CR), times_s)]


def bounced(correction: str, x: float, v: float, wall: float, CR: float) -> tuple[float, float]:
    if correction != "conserve":
        return {"none": x, "surface": wall, "rebound": wall - CR * (x - wall)}[correction], -CR * v
    energy = CR**2 * max(0.0, v**2 / 2 + 2 * (x - wall))  # above the wall
    rise = CR * (wall - x)
    rise = rise if 2 * rise <= energy else 0.0
    speed = math.sqrt(2 * energy - 4 * rise)
    return wall + rise, speed if x < wall else -speed


@cache
def told_plainly(motion: str, correction: str, CR: float, fps: int, cut: int) -> Samples:
    behind = {"forward": 0, "backward": 2}.get(motion, 1)  # exact, and a reader's own: the mean
    dt_s, shift_s, frames = 1 / fps, shift_of(cut, fps), max(1, fps // 10)
    x, v = 2 - shift_s**2, -2 * shift_s
    found: Samples = []
    for true_x, true_v in truth(CR, fps, cut):
        for _ in range(frames):
            x += (v - behind * dt_s) * dt_s
            v -= 2 * dt_s
            wall = min(max(x, 0.25), 2.2)
            if x != wall:
                x, v = bounced(correction, x, v, wall, CR)
        found.append((x, v, true_x, true_v))
    return found


def plain_letter(samples: Samples) -> str:
    """What a run of that fall gets on the map, at 55 px/m."""
    if any(x < 0.25 - 1.95 or x > 2.2 + 1.95 for x, *_ in samples):
        return "X"
    last = samples[len(samples) * 3 // 4:]
    if all(x < 0.25 for x, *_ in last) or all(x > 2.2 for x, *_ in last):
        return "S"
    if all(abs(x - true_x) * 55 <= 1 for x, _, true_x, _ in samples):
        return "-"
    mean, true_mean = (sum(car[at + 1]**2 / 2 + 2 * car[at] for car in last) / len(last)
                       for at in (0, 2))
    gain = (mean - true_mean) / (2 * 1.95)
    return "G" if gain > 0.01 else "L" if gain < -0.01 else "P"


# The chart.

@pytest.mark.parametrize("letter", "abc")
@pytest.mark.parametrize(("example", "CR"), [("10", 1.0), ("12", 0.8)])
def test_the_errors_are_the_largest_of_ten_cuts_and_of_first_or_second_order(
        example: str, CR: float, letter: str) -> None:
    errors = errors_m(example, letter)
    for fps, error_m in zip(RATES, errors, strict=True):
        plainly_m = max(abs(x - true_x) for cut in range(10) for x, _, true_x, _ in told_plainly(
            *METHODS[letter], CR, fps, cut))
        assert error_m == pytest.approx(plainly_m, rel=0.051)
    order = 2 if letter == "c" else 1  # half the step, a quarter of the error; or half of it
    assert 32**order < errors[2] / errors[8] < 128**order
    told = re.findall("order.*", printed("chart", example))[0].split()
    assert float(told[1 + "abc".index(letter)]) == pytest.approx(
        math.log2(errors[5] / errors[8]) / 3, abs=0.06)


@pytest.mark.parametrize(("example", "letter", "known_m"), [
    ("10", "d", []), ("10", "e", []), ("12", "e", []), ("14", "e", []),
    ("12", "d", [1.8e-3, 1.3e-4, 4.3e-5, 1.3e-5, 2.7e-6, 2.9e-7])])  # frames of several bounces
def test_exact_motion_is_at_round_off_where_its_correction_suffices(
        example: str, letter: str, known_m: list[float]) -> None:
    errors = errors_m(example, letter)
    assert errors[:len(known_m)] == known_m
    assert max(errors[len(known_m):]) < 1e-10


@pytest.mark.parametrize("fps", [10, 30, 240])
@pytest.mark.parametrize("letter", "abcd")
def test_no_film_of_equal_frames_is_worse_than_its_chart_says(letter: str, fps: int) -> None:
    motion, correction = METHODS[letter]
    for number in (10, 12):
        found = beside_the_truth(number, 20 * fps, motion=motion, correction=correction,
                                 fps_target=fps, jitter=0, use_observed_dt=False)
        found = found[fps // 10 - 1::fps // 10]
        assert apart_m(found) <= 1.06 * errors_m(str(number), letter)[RATES.index(fps)] + 1e-9


def test_the_cuts_begin_at_evenly_spread_parts_of_a_frame_none_at_its_edge() -> None:
    scene = Scene(x_m=2, a_mps2=-2, motion="exact", correction="none", left_edge_m=-1000)
    starts_s = [math.sqrt(2 - simulate(scene, 10, cut)[0].x_m) - 0.1 for cut in range(CUTS)]
    assert starts_s[0] == pytest.approx(0)
    assert [10 * 27 * start_s for start_s in starts_s[1:]] == pytest.approx(list(range(1, 27, 3)))


@pytest.mark.parametrize(("words", "pixel_m"), [
    ("10", 1 / 55), ("12", 1 / 55), ("14 m_to_px=1000", 0.001), ("14 m_to_px=0.001", 1000),
    ("10 m_to_px=0.54", 1.85)])  # b: 1.8 1.9 1.9 1.4
def test_the_answer_names_the_methods_within_a_pixel_the_cheapest_first(
        words: str, pixel_m: float) -> None:
    told: list[tuple[float, str]] = []
    out = printed("chart", *words.split())
    rows = re.findall(r"(?m)^ *\d+  [0-9.]+e.*$", out)
    for number, (letter, (motion, _)) in enumerate(METHODS.items()):
        found = math.inf, f"{letter} at none of these rates"
        for row in reversed(rows):
            if float(row[4 + 15 * number:13 + 15 * number]) > pixel_m:
                break
            us = int(row[:4]) * len(motion) / 10
            assert float(row[13 + 15 * number:19 + 15 * number]) == round(us)
            found = us, f"{letter} from {int(row[:4])} FPS on, for {us:.0f} us"
        told.append(found)
    answer = f"the cheapest first: {'; '.join(text for _, text in sorted(told))}. Next: "
    told_plain = " ".join(out.split())
    assert f"Within a drawn pixel, {pixel_m:.2g} m, in all ten runs, {answer}" in told_plain
    assert out.endswith(f"\nNext: {PYTHON} airtrack.py stability\n")


def test_the_chart_asks_its_question_first_and_tells_whose_method_e_is() -> None:
    before = " ".join(printed("chart", "10", "CR=0.9").partition(" FPS")[0].split())
    assert before.startswith("Speed against accuracy: Example 10: The exact solution, CR=0.9. "
                             "x_m=2 v_mps=0 a_mps2=-2 CR=0.9, walls at 0.25 and 2.2 m Which method "
                             "is the cheapest that stays within a drawn pixel of the truth?")
    assert "Method e is the truth's own method, so its error can be nothing but round-off" in before


def test_the_cost_is_the_processor_time_of_the_bare_steps_and_the_least_of_five_runs(
        monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[tuple[float, float]] = []
    run = [(1.0 + frame, 1 / 480) for frame in range(20 * 480)]
    dear = 4 * len(run)  # a step of the first four runs takes 2 us, any other 1 us

    def step(_: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, None]:
        taken.append((x_m, dt_s))
        return x_m + 1, v_mps, None

    monkeypatch.setattr(airtrack, "step", step)
    monkeypatch.setattr("time.perf_counter", lambda: 1e-6 * (len(taken) + min(len(taken), dear)))
    assert airtrack.cost_us(Scene(x_m=1.0), 480) == pytest.approx(480)
    assert taken == run * (len(taken) // len(run))


def test_the_picture_has_each_point_at_its_place_and_a_wall_of_one_pixel(capsys: Capture) -> None:
    # Eight columns and four rows a power of ten: 3 is four columns, 5 three rows further than 1.
    def series(*points: tuple[float, float]) -> list[Point]:
        return [Point(10, *point) for point in points]

    airtrack.picture({
        "c": series((1e9, 1), (1e-2, 10)), "a": series((1e-3, 5), (3e-3, 5), (3e-3, 5)),
        "d": series((1e-6, 10), (1e-4, 20), (1, 20)),
        "e": series((0, 1), (1e-15, 10), (1e-4, 20))}, 0.01)
    assert capsys.readouterr().out == """\
                          one drawn pixel |
    us    <=1 um  10 um   0.1 mm  1 mm    1 cm    0.1 m   1 m     >=10 m
     1    e                               |                       c
     2                                    |
     3                                    |
     6                            a   a   |
    10    +                               c
    18                    +               |               d

"""


@pytest.mark.parametrize(("command", "last", "rows"), [
    ("chart", 60, [b"  10", b"  30"]), ("stability", 1, [
        b"forward + none", b"forward + surface", b"forward + rebound", b"forward + conserve"])])
def test_a_row_is_out_before_the_next_is_measured_and_ctrl_c_ends_it_without_a_word(
        command: str, last: int, rows: list[bytes], monkeypatch: pytest.MonkeyPatch,
        capsys: Capture) -> None:
    out = io.BytesIO()

    def interrupted(scene: Scene, fps: int, cut: int) -> list[Sample]:
        if (scene.motion, fps) == ("backward", last):
            raise KeyboardInterrupt
        return simulated(scene, fps, cut)

    monkeypatch.setattr(airtrack, "simulate", interrupted)
    monkeypatch.setattr(airtrack, "cost_us", lambda scene, fps: 1.0)
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(out))
    assert main([command]) == 130
    assert re.findall(rb"(?m)^( +[136]0|\w+ \+ \w+)  ", out.getvalue()) == rows
    assert capsys.readouterr().err == ""


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
    (SHORT | {"v_mps": 1.49}, 1, "P"), (SHORT | {"v_mps": -1.51}, 1, "X"),
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
    assert cell(list(found)) == letter


def map_rows(example: int) -> dict[str, list[str]]:
    rows = re.findall(r"(?m)^(\w+ \+ \w+) +(.*)$", printed("stability", str(example)))
    return {name: letters.split() for name, letters in rows}


@pytest.mark.parametrize(("example", "CR"), [(10, 1.0), (12, 0.8)])
def test_the_map_has_the_letters_of_a_plain_retelling(example: int, CR: float) -> None:
    any_motion = ["none", "surface", "rebound", "conserve"]
    names = [f"{motion} + {correction}" for motion in MOTIONS
             for correction in any_motion + ["rewind", "replay"] * (motion == "exact")]
    rows = map_rows(example)
    assert list(rows) == names
    for name, letters in rows.items():
        motion, _, correction = name.split()
        assert len(letters) == 9
        if correction in ("rewind", "replay"):
            meets_two = (example, correction) == (12, "rewind")  # bounces in a frame
            assert letters == ([*"Gg"] if meets_two else ["-"] * 2) + ["-"] * 7
            continue
        for fps, letter in zip((1, 2, 5, 10, 30, 60, 120, 240, 1000), letters, strict=True):
            found = [plain_letter(told_plainly(motion, correction, CR, fps, cut))
                     for cut in range(10)]
            assert letter == cell(found)


def test_map_and_key_stand_on_80_by_24_the_key_once_below_it_from_the_worst_to_the_best() -> None:
    before, _, screen = printed("stability", "10").rpartition("\n\n")
    assert "Which methods are right, and from which frame rate on?" in before
    lines = screen.splitlines()
    assert len(lines) + 1 <= 24 + 4 * (len(MOTIONS) - 3)  # and a prompt
    assert lines[0].split() == ["1", "2", "5", "10", "30", "60", "120", "240", "1000", "FPS"]
    assert [line[0] for line in lines[-8:-1]] == [*VERDICTS] == [*"XSWGLP-"]


def test_film_chart_and_map_of_one_scene_agree() -> None:
    for letter, method in METHODS.items():
        letters = map_rows(10)[" + ".join(method)]
        for fps, mark in ((10, letters[3]), (30, letters[4]), (240, letters[7])):
            assert (errors_m("10", letter)[RATES.index(fps)] <= 1 / 55) is (mark == "-")


def runs(scene: Scene) -> Iterator[Samples]:
    for cut in range(CUTS):
        yield [tuple(sample) for sample in simulate(scene, 10, cut)]


def test_every_cut_follows_the_reference() -> None:
    scene = Scene(**EXAMPLES[12].settings | {"use_observed_dt": False, "jitter": 0})
    for cut, samples in enumerate(runs(scene)):
        for (*_, true_m, true_mps), known in zip(samples, truth(0.8, 10, cut), strict=True):
            assert (true_m, true_mps) == pytest.approx(known, abs=1e-5)
