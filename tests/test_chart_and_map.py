"""The chart and the stability map: that they show what is true."""

import io
import math
import re
from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
from dataclasses import replace
from decimal import Decimal
from functools import cache
from typing import Any

import pytest

import airtrack
from airtrack import (
    METHODS,
    MOTIONS,
    VERDICTS,
    Point,
    Sample,
    Scene,
    cell,
    largest_error_m,
    main,
    methods_of,
    order_text,
    simulate,
    step,
    verdict,
)
from examples import EXAMPLES
from films import LISTING, WORDS, collisions
from films import states as frames_of
from reference import states

Capture = pytest.CaptureFixture[str]
CHART_RATES = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)
MAP_RATES = (1, 2, 5, 10, 30, 60, 120, 240, 1000)
SPAN_S = 20
MAP_METHODS = [(motion, correction) for motion in MOTIONS for correction in (
    "none", "surface", "rebound", "conserve", *["rewind", "replay"] * (motion == "exact"))]


def scene_of(example: int) -> Scene:
    """An example as chart and map take it, without its method."""
    names = ("x_m", "v_mps", "a_mps2", "left_edge_m", "right_edge_m", "CR")
    return Scene(**{name: value for name, value in EXAMPLES[example].settings.items()
                    if name in names})


# Uneven numbers: on a tie of a move and a wall, round-off would decide what is a collision.
@pytest.mark.parametrize("fps", [1, 2, 10, 60])
@pytest.mark.parametrize("scene", [
    Scene(x_m=1.837, v_mps=0.31, a_mps2=-1.913, CR=1),
    Scene(x_m=0.637, v_mps=-0.271, a_mps2=3.17, CR=0.83, motion="exact"),
    Scene(x_m=0.937, v_mps=2.71, CR=0.93, motion="exact", correction="conserve")])
def test_a_run_begins_at_one_of_ten_parts_of_a_frame_beside_the_truth_of_60_digits(
        scene: Scene, fps: int) -> None:
    every = max(1, fps // 10)  # a sample each 0.1 s, or each frame
    for cut in range(10):
        begins_s = (3 * cut - 2) / 27 / fps if cut else 0.0
        times_s = [Decimal(begins_s + frame / fps) for frame in range(0, SPAN_S * fps + 1, every)]
        start, *truth = [(float(x), float(v)) for x, v in states(scene, times_s)]
        x_m, v_mps = start
        for sample, true_state in zip(simulate(scene, fps, cut), truth, strict=True):
            for _ in range(every):
                x_m, v_mps, _ = step(scene, x_m, v_mps, 1 / fps)
            assert sample == pytest.approx((x_m, v_mps, *true_state), abs=1e-6)


# What chart and map print, for runs that the test makes up.

def shown(command: str, methods: Iterable[tuple[str, str]], rates: tuple[int, ...],
          run: Callable[[Scene, int, int], list[Sample]]) -> str:
    """What a command prints for example 18 with CR=0.7 and m_to_px=50.

    It asks for ten runs of each method at each rate, and no row waits in a buffer for the next.
    """
    begun = replace(scene_of(18), CR=0.7, m_to_px=50.0)
    wanted = {(replace(begun, motion=motion, correction=correction), fps, cut)
              for motion, correction in methods for fps in rates for cut in range(10)}
    file, asked, rows_out = io.BytesIO(), set(), []

    def noted(*wishes: Any) -> list[Sample]:
        asked.add(wishes)
        rows_out.append(len(re.findall(rb"(?m)^( *\d+  \d|\w+ \+ \w)", file.getvalue())))
        return run(*wishes)

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", "80")
        patch.setattr(airtrack, "simulate", noted)
        patch.setattr(airtrack, "cost_us", lambda scene, fps: fps * len(scene.motion) / 10)
        patch.setattr("sys.stdout", io.TextIOWrapper(file, encoding="utf-8", newline="\n"))
        assert main([command, "18", "CR=0.7", "m_to_px=50"]) == 0
        out = file.getvalue().decode()
    assert asked == wanted
    rows = len(rates) if command == "chart" else len(MAP_METHODS)
    assert list(dict.fromkeys(rows_out)) == list(range(rows))
    assert max(map(len, out.splitlines())) <= 80
    return out


TITLE = "Scene 18: x_m=0.65 v_mps=5 a_mps2=-8 CR=0.7, walls at 0.25 and 2.2 m"
ERRORS_M = {
    "a": [2 / fps for fps in CHART_RATES],  # within 2 cm from 120 FPS on
    "b": [0.01, 0.5, 0.3, 0.1, 0.01, 0.01, 0.03, 0.01, 0.01],  # 240 and 480 do not count
    "c": [50 / fps**2 for fps in CHART_RATES],  # from 60 on
    "d": [1e-12] * 9, "e": [1.0] * 9}
ANSWER = """\
These stay within a drawn pixel (0.02 m) in all ten runs, the cheapest first:
  d  exact + rewind      from   10 FPS on      5 us
  c  exact + conserve    from   60 FPS on     30 us
  a  backward + rebound  from  120 FPS on     96 us
  b  exact + rebound     from 1920 FPS on    960 us
"""


def test_the_chart_shows_the_largest_of_ten_errors_the_cost_and_what_they_mean() -> None:
    letters = {method: letter for letter, method in METHODS.items()}

    def run(scene: Scene, fps: int, cut: int) -> list[Sample]:
        letter = letters[scene.motion, scene.correction]
        side = 1 if letter in "ad" else -1
        off_m = side * ERRORS_M[letter][CHART_RATES.index(fps)]
        samples = [Sample(1.0 + off_m / 2, 0.0, 1.0, 0.0)] * 3
        if cut == 9:
            samples[1] = Sample(1.0 + off_m, 0.0, 1.0, 0.0)
        return samples

    out = shown("chart", METHODS.values(), CHART_RATES, run)
    table = []
    for at, fps in enumerate(CHART_RATES):
        row = f"{fps:4}"
        for letter, (motion, _) in METHODS.items():
            row += f"{ERRORS_M[letter][at]:9.1e}{fps * len(motion) / 10:6.0f}"
        table.append(row)
    assert "\n".join([*table, "order    1.0            0.0            2.0           none"
                      "            0.0"]) in out
    assert "one drawn pixel |".rjust(45) in out  # at 10 + 8 lg(0.02 m/1 um), and behind it
    assert ANSWER in out
    assert out.endswith(" airtrack.py stability\n")
    before = " ".join(out.partition("a: backward")[0].split())
    assert before.startswith(f"Speed against accuracy. {TITLE} Which method is the cheapest that ")
    assert f"runs ten times for {SPAN_S} simulated seconds" in before
    assert "looked at every 0.1 s" in before
    assert "Order: 1 if half the dt makes half the error, 2 if it makes a quarter." in before


def test_where_no_method_stays_within_a_pixel_the_answer_says_so(capsys: Capture) -> None:
    airtrack.conclude({letter: [Point(10, 0.02, 1)] for letter in METHODS}, 0.01)
    assert "none at these rates" in capsys.readouterr().out


@pytest.mark.parametrize(("first_m", "last_m", "order"), [
    (8.8e-8, 1.1e-8, "1.0"), (64e-8, 1e-8, "2.0"), (8e-9, 0.99e-8, "none"), (0.0, 0.0, "none")])
def test_the_order_is_of_three_doublings_and_an_error_of_round_off_has_none(
        first_m: float, last_m: float, order: str) -> None:
    errors_m = (1.0, first_m, 1.0, 1.0, last_m)
    assert order_text([Point(10, error_m, 1.0) for error_m in errors_m]) == order


def test_the_cost_is_the_time_of_the_bare_steps_and_the_least_of_five_runs(
        monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[tuple[float, float]] = []
    run = [(1.0 + frame, 1 / 480) for frame in range(SPAN_S * 480)]
    dear = 4 * len(run)  # a step of the first four runs takes 2 us, any other 1 us

    def one_step(_: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, None]:
        taken.append((x_m, dt_s))
        return x_m + 1, v_mps, None

    monkeypatch.setattr(airtrack, "step", one_step)
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


def test_the_map_has_a_letter_for_ten_runs_of_each_method_at_each_rate_and_a_key() -> None:
    def kind(scene: Scene, fps: int) -> int:
        method = MAP_METHODS.index((scene.motion, scene.correction))
        return (method + MAP_RATES.index(fps)) % 3

    def run(scene: Scene, fps: int, cut: int) -> list[Sample]:
        is_out = kind(scene, fps) == 0 or (kind(scene, fps) == 1 and cut == 9)
        return [Sample(99.0 if is_out else 1.0, 0.0, 1.0, 0.0)] * 4

    before, _, screen = shown("stability", MAP_METHODS, MAP_RATES, run).rpartition("\n\n")
    head, *rows = screen.splitlines()
    assert len(screen.splitlines()) + 1 <= 24 + 4 * (len(MOTIONS) - 3)  # and a prompt
    assert head == " " * 20 + "".join(f"{rate:6}" for rate in MAP_RATES) + " FPS"
    for at, (motion, correction) in enumerate(MAP_METHODS):
        letters = "".join(f"{'Xx-'[(at + column) % 3]:>6}" for column in range(9))
        assert rows[at] == f"{motion} + {correction}".ljust(20) + letters
    key = {line[0]: line for line in rows[len(MAP_METHODS):]}
    assert "".join(key) == "".join(VERDICTS) == "XSHWGLP-"  # from the worst to the best
    assert all("the last 5 s" in key[letter] for letter in "SHGL")
    assert "over 1 mm off" in key["H"]
    assert "over 1 % too much" in key["G"]
    assert "over 1 % too little" in key["L"]
    text = " ".join(before.split())
    assert text.startswith(f"Stability. {TITLE} Which methods are right, and from which frame rate")
    assert f"Each runs ten times for {SPAN_S} simulated seconds" in text


def during(seconds: Iterable[int], **changes: float) -> dict[int, dict[str, float]]:
    return dict.fromkeys(seconds, changes)


EARLY, LATE = range(1, 15), range(15, 20)  # seconds: the last 5 count
OFF = during([0], x_m=0.52)  # over a pixel
REST = during(LATE, true_mps=0.0)
SUNK = during(LATE, x_m=-1e-9)


def energetic(seconds: Iterable[int], energy: float) -> dict[int, dict[str, float]]:
    """Over a pixel off, and with this energy of motion. The true car has 0.5 J/kg."""
    return OFF | during(seconds, v_mps=math.sqrt(2 * energy))


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(("letter", "changes"), [
    ("-", {}), ("-", during([0], x_m=0.509)), ("P", during([0], x_m=0.511)),
    ("P", during([19], x_m=0.489)),
    ("X", during([0], x_m=-1.01)), ("P", during([0], x_m=-0.99)),
    ("X", during([19], x_m=2.01)), ("P", during([0], x_m=1.99)),
    ("S", SUNK), ("S", during(LATE, x_m=-1e-9, true_mps=0)),  # rather than H
    ("L", SUNK | during([15], x_m=0.0)), ("L", SUNK | during([19], x_m=1.1)),
    ("H", REST | during([15], x_m=0.5011, true_mps=0)),
    ("H", REST | during([19], x_m=0.4989, true_mps=0)),
    ("-", REST | during([19], x_m=0.5009, true_mps=0)), ("-", REST | during([14], x_m=0.5011)),
    ("-", REST | during([15], x_m=0.5011, true_mps=1e-9)),
    # 1 % is 0.025 J/kg: of v^2/2 + |a| * 1 m, which is 0.5 + 2. The mean of the last 5 s counts.
    ("G", energetic(LATE, 0.526)), ("P", energetic(LATE, 0.524)), ("P", energetic(EARLY, 1)),
    ("L", energetic(LATE, 0.474)), ("P", energetic(LATE, 0.476)),
    ("G", energetic([17], 0.5 + 5 * 0.026)), ("-", during(LATE, v_mps=math.sqrt(2 * 0.526))),
    ("G", during(LATE, x_m=0.513)), ("P", during(LATE, x_m=0.512)),
    ("L", during(LATE, x_m=0.487)), ("P", during(LATE, x_m=0.488))])
def test_a_verdict_is_the_first_letter_that_fits_a_run(
        letter: str, changes: dict[int, Any], side: int, monkeypatch: pytest.MonkeyPatch) -> None:
    mirrored = []
    for second in range(SPAN_S):
        sample = Sample(0.5, 1.0, 0.5, 1.0)._replace(**changes.get(second, {}))
        mirrored.append(Sample(*[side * number for number in sample]))
    monkeypatch.setattr(airtrack, "simulate", lambda scene, fps, cut: mirrored)
    scene = Scene(v_mps=1.0, a_mps2=-2.0 * side, left_edge_m=min(0, side),
                  right_edge_m=max(0, side), m_to_px=100)
    assert verdict(scene, 1, 0) == letter


@pytest.mark.parametrize(("found", "letter"), [
    ("X", "X"), ("XGL-", "x"), ("SP", "s"), ("SH", "s"), ("HGL", "h"), ("HH", "H"), ("GLP-", "W"),
    ("GL", "W"), ("G", "G"), ("GP", "g"), ("L", "L"), ("L-", "l"), ("P", "P"), ("P-", "p"),
    ("-", "-")])
def test_a_cell_is_the_worst_of_the_runs_and_small_where_only_some_are_so_bad(
        found: str, letter: str) -> None:
    assert cell(list(found)) == letter


# What they show of the program's own scenes.

@cache
def errors_m(words: str, letter: str) -> list[float]:
    """The chart's errors of a method in an example, one for each rate."""
    scene = methods_of(scene_of(int(words)))[letter]
    return [largest_error_m(scene, fps) for fps in CHART_RATES]


@cache
def printed(*words: str) -> str:
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as out:
        patch.setenv("COLUMNS", "80")
        assert main(list(words)) == 0
    return out.getvalue()


def map_rows(example: int) -> dict[str, list[str]]:
    rows = re.findall(r"(?m)^(\w+ \+ \w+) +(.*)$", printed("stability", str(example)))
    return {name: letters.split() for name, letters in rows}


def test_the_map_of_20_shows_the_law() -> None:
    rows = map_rows(20)
    for motion in ("forward", "exact"):
        for correction in ("surface", "rebound"):
            assert "".join(rows[f"{motion} + {correction}"]).startswith("HHHHHH")
    for name in ("backward + surface", "exact + conserve"):
        assert not {"H", "h"} & set(rows[name])


def test_the_table_of_methods_at_the_listing_s_head_is_what_chart_and_map_find() -> None:
    told = re.findall(
        r"(?m)^#     ([a-e])  (\w+) \+ (\w+) +(\w+) +(up and down|too much|right) ", LISTING)
    energies = {"W": "up and down", "G": "too much", "-": "right"}
    found = []
    for letter, (motion, correction) in METHODS.items():
        series = [Point(10, error_m, 1.0) for error_m in errors_m("10", letter)]
        order = order_text(series)
        method = methods_of(scene_of(10))[letter]
        at_60_fps = cell([verdict(method, 60, cut) for cut in range(10)])
        whole = order if order == "none" else f"{float(order):.0f}"
        found.append((letter, motion, correction, whole, energies[at_60_fps]))
    assert told == found


def test_example_10_has_about_as_many_bounces_as_the_listing_says() -> None:
    assert "simulated time: about eight bounces in example 10" in WORDS
    assert len(collisions(frames_of(10, 10 * SPAN_S, motion="exact", correction="replay"))) == 8


def test_the_numbers_beside_the_code_of_chart_and_map_are_its_own() -> None:
    late_s = SPAN_S * (1 - 3 / 4)
    cuts = ", ".join([f"{3 * cut - 2}/27" for cut in (1, 2, 3)])  # tested in the first test
    for sentence in (
            f"Nine parts, 1/9 of a frame apart: {cuts}, ... {3 * 9 - 2}/27.",
            f"At order 1 twice the rate divides the error by {2**1}, at order 2 by {2**2}.",
            f"here begin the samples of the last {late_s:.0f} of {SPAN_S} s",
            f"was it beyond the same wall all through the last {late_s:.0f} s?",
            f"did the true car rest all through the last {late_s:.0f} s, but not this one?",
            "100 % is v^2/2 at the start",
            f"one step() of {SPAN_S} s with motion=exact",
            f"is where the car truly is after {SPAN_S} s."):
        assert sentence in WORDS
