"""The chart and the stability map: that they show what is true."""

import io
import math
import re
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
    PYTHON,
    VERDICTS,
    Point,
    Sample,
    Scene,
    cell,
    main,
    order_text,
    step,
    truth_of,
    verdict,
)
from examples import EXAMPLES
from films import HERE
from reference import states

Capture = pytest.CaptureFixture[str]
LISTING = (HERE / "airtrack.py").read_text(encoding="utf-8")
Samples = list[tuple[float, ...]]  # x, v, the true x and the true v

# What SPEC and the printed texts promise, and what the plain retelling below does.
CHART_RATES = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)
MAP_RATES = (1, 2, 5, 10, 30, 60, 120, 240, 1000)
SPAN_S, EVERY_S, LAST_S, PERCENT, REST_MM = 20, 0.1, 5, 1, 1
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


def told(*words: str) -> str:
    """The same without line breaks."""
    return " ".join(printed(*words).split())


def chart_rows(*words: str) -> list[str]:
    rows = re.findall(r"(?m)^ *\d+  [0-9.]+e.*$", printed("chart", *words))
    assert [int(row[:4]) for row in rows] == list(CHART_RATES)
    return rows


def errors_m(example: str, letter: str) -> list[float]:
    """The errors of a method in the chart's table, one for each rate."""
    column = 4 + 15 * "abcde".index(letter)
    return [float(row[column:column + 9]) for row in chart_rows(example)]


# The same runs, told plainly.

def scene_of(example: int) -> Scene:
    names = ("x_m", "v_mps", "a_mps2", "left_edge_m", "right_edge_m", "CR")
    return Scene(**{name: value for name, value in EXAMPLES[example].settings.items()
                    if name in names})


def frames_a_sample(fps: int) -> int:
    return max(1, round(fps * EVERY_S))


@cache
def truth(scene: Scene, fps: int, cut: int) -> list[tuple[float, float]]:
    """The true states at the start and at the samples, from 60-digit decimals."""
    begins_s = (3 * cut - 2) / 27 / fps if cut else 0.0
    every = frames_a_sample(fps)
    times_s = [Decimal(begins_s + frame / fps) for frame in range(0, SPAN_S * fps + 1, every)]
    return [(float(x), float(v)) for x, v in states(scene, times_s)]


def bounced(correction: str, x: float, v: float, wall: float, a: float,
            CR: float) -> tuple[float, float]:
    side = 1 if x > wall else -1
    deep, g = side * (x - wall), side * a
    if correction == "none":
        return x, -CR * v
    if correction == "surface":
        return wall, -CR * v
    if correction == "rebound":
        return wall - side * CR * deep, -CR * v
    w = math.sqrt(max(0.0, v**2 - 2 * g * deep))  # at the wall
    if correction == "conserve":
        u_squared = (CR * w)**2 - 2 * g * CR * deep
        if u_squared < 0:
            return wall, -side * CR * w
        return wall - side * CR * deep, -side * math.sqrt(u_squared)
    late_s = 2 * deep / (side * v + w) if side * v + w > 0 else 0.0
    after = -CR * w * late_s + g * late_s**2 / 2
    return wall + side * min(0.0, after), side * (-CR * w + g * late_s)


@cache
def told_plainly(scene: Scene, motion: str, correction: str, fps: int, cut: int) -> Samples:
    behind = {"forward": 0, "backward": 2}.get(motion, 1)  # exact, and a reader's own: the mean
    dt, a, left, right = 1 / fps, scene.a_mps2, scene.left_edge_m, scene.right_edge_m
    (x, v), *true_states = truth(scene, fps, cut)
    found: Samples = []
    for true_x, true_v in true_states:
        for _ in range(frames_a_sample(fps)):
            x += (v + behind * a * dt / 2) * dt
            v += a * dt
            wall = min(max(x, left), right)
            if x != wall:
                x, v = bounced(correction, x, v, wall, a, scene.CR)
        if correction == "replay":
            x, v = true_x, true_v
        found.append((x, v, true_x, true_v))
    return found


def plain_letter(scene: Scene, samples: Samples) -> str:
    """What a run gets on the map, at 55 px/m."""
    left, right, g = scene.left_edge_m, scene.right_edge_m, abs(scene.a_mps2)
    track = right - left
    if any(x < left - track or x > right + track for x, *_ in samples):
        return "X"
    last = samples[len(samples) * (SPAN_S - LAST_S) // SPAN_S:]
    if all(x < left for x, *_ in last) or all(x > right for x, *_ in last):
        return "S"
    if all(true_v == 0 for *_, true_v in last) and any(
            abs(x - true_x) > REST_MM / 1000 for x, _, true_x, _ in last):
        return "H"
    if all(abs(x - true_x) * 55 <= 1 for x, _, true_x, _ in samples):
        return "-"
    mean, true_mean = (sum(car[at + 1]**2 / 2 - scene.a_mps2 * car[at] for car in last) / len(last)
                       for at in (0, 2))
    gain = 100 * (mean - true_mean) / (scene.v_mps**2 / 2 + g * track)
    return "G" if gain > PERCENT else "L" if gain < -PERCENT else "P"


# The chart.

def plain_error_m(scene: Scene, letter: str, fps: int) -> float:
    return max(abs(x - true_x) for cut in range(10)
               for x, _, true_x, _ in told_plainly(scene, *METHODS[letter], fps, cut))


@pytest.mark.parametrize("letter", "abc")
def test_the_errors_are_the_largest_of_ten_runs_and_of_first_or_second_order(letter: str) -> None:
    errors = errors_m("10", letter)
    for fps, error_m in zip(CHART_RATES, errors, strict=True):
        assert error_m == pytest.approx(plain_error_m(scene_of(10), letter, fps), rel=0.051)
    order = 2 if letter == "c" else 1  # half the step, a quarter of the error; or half of it
    assert 32**order < errors[2] / errors[8] < 128**order
    orders = re.findall("order.*", printed("chart", "10"))[0].split()
    assert float(orders[1 + "abc".index(letter)]) == pytest.approx(
        math.log2(errors[5] / errors[8]) / 3, abs=0.06)


@pytest.mark.parametrize("letter", "abcd")
def test_so_they_are_where_a_points_to_the_right_and_CR_is_below_1(letter: str) -> None:
    motion, correction = METHODS[letter]
    scene = scene_of(5)
    for fps in (10, 60):
        error_m = airtrack.largest_error_m(
            replace(scene, motion=motion, correction=correction), fps)
        assert error_m == pytest.approx(plain_error_m(scene, letter, fps), rel=1e-6, abs=1e-9)


def test_rewind_and_replay_are_at_round_off_where_a_frame_holds_one_bounce() -> None:
    assert max(errors_m("10", "d") + errors_m("10", "e")) < 1e-10


def test_an_error_of_round_off_has_no_order() -> None:
    def series(first_m: float, last_m: float) -> list[Point]:
        return [Point(10, error_m, 1.0) for error_m in (1.0, first_m, 1.0, 1.0, last_m)]

    assert order_text(series(8.8e-8, 1.1e-8)) == "1.0"
    assert order_text(series(64e-8, 1e-8)) == "2.0"
    assert order_text(series(8e-9, 0.99e-8)) == order_text(series(1e-9, 1e-12)) == "none"
    assert order_text(series(0.0, 0.0)) == "none"
    orders = re.findall("(?m)^order.*", printed("chart", "10"))
    assert orders[0].split()[4:] == ["none", "none"]


@pytest.mark.parametrize("fps", [10, 30, 2])
def test_a_run_begins_at_the_true_state_of_evenly_spread_parts_of_a_frame(fps: int) -> None:
    fall = Scene(x_m=2, a_mps2=-2, motion="exact", correction="none", left_edge_m=-1000)
    starts_s = []
    for cut in range(10):
        samples = simulate(fall, fps, cut)
        every_s = frames_a_sample(fps) / fps
        assert len(samples) == SPAN_S / every_s
        starts_s.append(math.sqrt(2 - samples[0].x_m) - every_s)
    assert starts_s[0] == pytest.approx(0)
    assert [fps * 27 * start_s for start_s in starts_s[1:]] == pytest.approx(list(range(1, 27, 3)))


@pytest.mark.parametrize("command", ["chart", "stability"])
def test_they_run_the_scene_that_is_asked_for_ten_times_with_each_method_at_each_rate(
        command: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    ran: list[tuple[Scene, int, int]] = []

    def spy(scene: Scene, fps: int, cut: int) -> list[Sample]:
        ran.append((scene, fps, cut))
        return [Sample(1.0, 0.0, 1.0, 0.0)] * 4

    monkeypatch.setattr(airtrack, "simulate", spy)
    monkeypatch.setattr(airtrack, "cost_us", lambda scene, fps: 1.0)
    assert main([command, "18", "CR=0.7", "m_to_px=20"]) == 0
    begun = Scene(**vars(scene_of(18)) | {"CR": 0.7, "m_to_px": 20.0})
    assert capsys.readouterr().out.replace("\n", " ").partition("Which")[0].endswith(
        " 18: x_m=0.65 v_mps=5 a_mps2=-8 CR=0.7, walls at 0.25 and 2.2 m ")
    methods = list(METHODS.values())
    if command == "stability":
        methods = [method_of(name) for name in names_of_methods()]
    asked = [(replace(begun, motion=motion, correction=correction), fps, cut)
             for motion, correction in methods
             for fps in (CHART_RATES if command == "chart" else MAP_RATES) for cut in range(10)]
    assert sorted(ran, key=str) == sorted(asked, key=str)


@pytest.mark.parametrize(("words", "pixel_m"), [
    ("10", 1 / 55), ("10 m_to_px=1000", 0.001), ("10 m_to_px=0.001", 1000),
    ("10 m_to_px=0.54", 1.85)])  # the errors of b are 1.8 1.9 1.9 1.4
def test_the_answer_names_the_methods_within_a_pixel_the_cheapest_first(
        words: str, pixel_m: float) -> None:
    found: list[tuple[float, str]] = []
    rows = chart_rows(*words.split())
    for number, (letter, (motion, correction)) in enumerate(METHODS.items()):
        cheapest = None
        for row in reversed(rows):
            if float(row[4 + 15 * number:13 + 15 * number]) > pixel_m:
                break
            us = int(row[:4]) * len(motion) / 10
            assert float(row[13 + 15 * number:19 + 15 * number]) == round(us)
            name = f"{motion} + {correction}"
            cheapest = us, f"  {letter}  {name:18}  from {int(row[:4]):4} FPS on  {us:5.0f} us"
        if cheapest is not None:
            found.append(cheapest)
    out = printed("chart", *words.split())
    answer = [line for line in out.splitlines() if re.match("  [a-e]  ", line)]
    assert answer == [text for _, text in sorted(found)]
    assert f"within a drawn pixel ({pixel_m:.2g} m) in all ten runs, the cheapest first:" in told(
        "chart", *words.split())
    assert out.endswith(f"\nNext: {PYTHON} airtrack.py stability\n")


def test_where_no_method_stays_within_a_pixel_the_answer_says_so(capsys: Capture) -> None:
    airtrack.conclude({letter: [Point(10, 0.02, 1)] for letter in METHODS}, 0.01)
    assert "none at these rates" in capsys.readouterr().out


def test_the_chart_asks_its_question_and_says_what_is_measured() -> None:
    before = told("chart", "10").partition(" a: backward")[0]
    assert "Which method is the cheapest that stays within a drawn pixel of the truth? " in before
    assert f"runs ten times for {SPAN_S} simulated seconds" in before
    assert f"looked at every {EVERY_S} s" in before
    assert "Order: 1 if half the dt makes half the error, 2 if it makes a quarter." in before
    assert "Method e is the truth's own method, so its error can be nothing but round-off" in before
    legend = ", ".join(f"{letter}: {' + '.join(method)}" for letter, method in METHODS.items())
    picture = told("chart", "10").partition("one drawn pixel")[2]
    assert f"{legend}. Error to the right, cost downwards" in picture
    bounces, = re.findall("simulated time: about (.*) bounces in example 10", LISTING)
    truth_10 = truth_of(scene_of(10))
    x_m, v_mps, met = truth_10.x_m, truth_10.v_mps, 0
    for _ in range(SPAN_S * 10):
        x_m, v_mps, mark_m = step(truth_10, x_m, v_mps, 0.1)
        met += mark_m is not None
    assert (bounces, met) == ("eight", 8)


def test_the_table_of_methods_at_the_listing_s_head_is_what_chart_and_map_find() -> None:
    rows = re.findall(
        r"(?m)^#     ([a-e])  (\w+ \+ \w+) +(\w+) +(up and down|too much|right) ", LISTING)
    orders = re.findall("(?m)^order.*", printed("chart", "10"))[0].split()[1:]
    of_letter = {"W": "up and down", "G": "too much", "-": "right"}
    found = []
    for (letter, method), order in zip(METHODS.items(), orders, strict=True):
        name = " + ".join(method)
        whole = order if order == "none" else f"{float(order):.0f}"
        found.append((letter, name, whole, of_letter[map_rows(10)[name][MAP_RATES.index(60)]]))
    assert rows == found


def test_the_cost_is_the_time_of_the_bare_steps_and_the_least_of_five_runs(
        monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[tuple[float, float]] = []
    run = [(1.0 + frame, 1 / 480) for frame in range(20 * 480)]
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


@pytest.mark.parametrize(("command", "last", "rows"), [
    ("chart", 60, [b"  10", b"  30"]), ("stability", 1, [
        b"forward + none", b"forward + surface", b"forward + rebound", b"forward + conserve"])])
def test_a_row_is_out_before_the_next_is_measured_and_ctrl_c_ends_it_without_a_word(
        command: str, last: int, rows: list[bytes], monkeypatch: pytest.MonkeyPatch,
        capsys: Capture) -> None:
    out, out_by_then = io.BytesIO(), list[bytes]()

    def interrupted(scene: Scene, fps: int, cut: int) -> list[Sample]:
        if (scene.motion, fps) == ("backward", last):
            out_by_then.append(out.getvalue())
            raise KeyboardInterrupt
        return [Sample(1.0, 0.0, 1.0, 0.0)] * 4

    monkeypatch.setattr(airtrack, "simulate", interrupted)
    monkeypatch.setattr(airtrack, "cost_us", lambda scene, fps: 1.0)
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(out))
    assert main([command]) == 130
    assert re.findall(rb"(?m)^( +[136]0|\w+ \+ \w+)  ", out_by_then[0]) == rows
    assert b" 10: x_m=2 v_mps=0 a_mps2=-2 CR=1, walls at" in out_by_then[0]
    assert capsys.readouterr().err == ""


# The map.

def names_of_methods() -> list[str]:
    """All legal pairs, in the order of the map."""
    corrections = ["none", "surface", "rebound", "conserve"]
    return [f"{motion} + {correction}" for motion in MOTIONS
            for correction in corrections + ["rewind", "replay"] * (motion == "exact")]


def method_of(name: str) -> tuple[str, str]:
    motion, correction = name.split(" + ")
    return motion, correction


def map_rows(example: int) -> dict[str, list[str]]:
    rows = re.findall(r"(?m)^(\w+ \+ \w+) +(.*)$", printed("stability", str(example)))
    return {name: letters.split() for name, letters in rows}


def plain_cell(scene: Scene, name: str, fps: int) -> str:
    return cell([plain_letter(scene, told_plainly(scene, *method_of(name), fps, cut))
                 for cut in range(10)])


@pytest.mark.parametrize("example", [10, 20])
def test_the_map_has_the_letters_of_a_plain_retelling(example: int) -> None:
    rows, scene = map_rows(example), scene_of(example)
    assert list(rows) == names_of_methods()
    for name, letters in rows.items():
        assert letters == [plain_cell(scene, name, fps) for fps in MAP_RATES], name


@pytest.mark.parametrize("fps", [1, 2, 5, 10, 60])
def test_so_it_has_where_a_points_to_the_right(fps: int) -> None:
    scene = scene_of(5)
    for name in names_of_methods():
        motion, correction = method_of(name)
        method = replace(scene, motion=motion, correction=correction)
        letters = [verdict(method, fps, cut) for cut in range(10)]
        assert cell(letters) == plain_cell(scene, name, fps), name


def test_the_map_of_20_shows_the_law() -> None:
    rows = map_rows(20)
    for motion in ("forward", "exact"):
        for correction in ("surface", "rebound"):
            assert "".join(rows[f"{motion} + {correction}"]).startswith("HHHHHH")
    for name in ("backward + surface", "exact + conserve"):
        assert not {"H", "h"} & set(rows[name])


LONG = {"x_m": 0.0, "left_edge_m": -1000.0, "right_edge_m": 1000.0}
SHORT = {"x_m": 0.5, "left_edge_m": 0.0, "right_edge_m": 1.0, "CR": 1.0, "correction": "none"}


@pytest.mark.parametrize(("settings", "fps", "letter"), [
    (EXAMPLES[13].settings, 10, "G"), (EXAMPLES[14].settings, 10, "X"),
    (EXAMPLES[15].settings, 10, "-"), (EXAMPLES[3].settings, 30, "S"),
    (EXAMPLES[15].settings | {"correction": "rewind"}, 10, "X"),  # thrown through the walls
    (EXAMPLES[3].settings | {"a_mps2": -15.0}, 30, "X"),  # it sinks by more than the track
    (EXAMPLES[13].settings | {"m_to_px": 0.1}, 10, "-"),  # whatever the energy
    (EXAMPLES[20].settings, 10, "H"),
    (EXAMPLES[20].settings | {"m_to_px": 0.1}, 10, "H"),  # whatever a pixel is
    (EXAMPLES[20].settings | {"CR": 0.96}, 10, "G"),  # the true car does not rest yet
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
    (SHORT | {"CR": 0.0, "v_mps": 0.5 / 16.5}, 1, "-"),
    ])
def test_a_verdict_is_the_first_letter_that_fits_a_run(
        settings: dict[str, Any], fps: int, letter: str) -> None:
    assert verdict(Scene(**settings), fps, 0) == letter


@pytest.mark.parametrize(("late", "off_m", "true_mps", "letter"), [
    (0, 0.0011, 0.0, "H"), (1, 0.0011, 0.0, "H"), (-1, 0.0011, 0.0, "-"), (0, 0.0009, 0.0, "-"),
    (0, -0.0011, 0.0, "S"), (0, 0.0011, 1e-9, "-")])
def test_h_is_for_a_car_over_1_mm_off_in_the_last_5_s_if_the_true_v_is_0_in_all_of_them(
        late: int, off_m: float, true_mps: float, letter: str,
        monkeypatch: pytest.MonkeyPatch) -> None:
    # 20 samples, a second each. The car is off in one of them, or with S in all.
    samples = [Sample(0.25, 0.0, 0.25, true_mps)] * 20
    for at in range(20):
        if at == 15 + late or off_m < 0:
            samples[at] = samples[at]._replace(x_m=0.25 + off_m)
    monkeypatch.setattr(airtrack, "simulate", lambda scene, fps, cut: samples)
    assert verdict(Scene(a_mps2=-2), 1, 0) == letter


@pytest.mark.parametrize(("found", "letter"), [
    ("X", "X"), ("XGL-", "x"), ("SP", "s"), ("SH", "s"), ("HGL", "h"), ("HH", "H"), ("GLP-", "W"),
    ("GL", "W"), ("G", "G"), ("GP", "g"), ("L", "L"), ("L-", "l"), ("P", "P"), ("P-", "p"),
    ("-", "-")])
def test_a_cell_is_the_worst_of_the_runs_and_small_where_only_some_are_so_bad(
        found: str, letter: str) -> None:
    assert cell(list(found)) == letter


def test_map_key_and_prompt_stand_on_80_by_24_the_key_from_the_worst_to_the_best() -> None:
    before, _, screen = printed("stability", "10").rpartition("\n\n")
    lines = screen.splitlines()
    assert len(lines) + 1 <= 24 + 4 * (len(MOTIONS) - 3)  # and a prompt
    assert lines[0].split() == [*map(str, MAP_RATES), "FPS"]
    for line in lines[1:-len(VERDICTS)]:  # each letter stands below the last digit of its rate
        assert [line[at] != " " for at in range(25, 74, 6)] == [True] * 9
    assert [lines[0][at] for at in range(25, 74, 6)] == [str(rate)[-1] for rate in MAP_RATES]
    assert [line[0] for line in lines[-8:]] == [*VERDICTS] == [*"XSHWGLP-"]
    key = dict(zip(VERDICTS, lines[-8:], strict=True))
    for letters, figure in (("SHGL", f"the last {LAST_S} s"), ("H", f"over {REST_MM} mm off"),
                            ("G", f"over {PERCENT} % too much"), ("GL", f"over {PERCENT} % too")):
        assert all(figure in key[letter] for letter in letters)
    text = " ".join(before.split())
    assert "Which methods are right, and from which frame rate on?" in text
    assert f"Each runs ten times for {SPAN_S} simulated seconds" in text
