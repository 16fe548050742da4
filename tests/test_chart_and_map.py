"""The chart and the map: that they show what is true of the methods."""

import math
import re
from dataclasses import replace
from itertools import cycle
from types import SimpleNamespace

import pytest

import airtrack
from airtrack import METHODS, VERDICTS, Car, Point, Scene, main, verdict, worst_of
from films import chart_errors_m, compared, shown

Capture = pytest.CaptureFixture[str]

def letters_of(number: int, motion: str, correction: str, fps: float) -> list[str]:
    """The verdicts on the ten runs."""
    found = []
    for truth in airtrack.true_cars(compared(number, fps)):
        scene = airtrack.with_method(truth.scene, motion, correction)
        found.append(verdict(airtrack.simulated(scene), truth))
    return found

# What is measured.

def test_the_error_is_the_largest_of_ten_runs_that_begin_at_different_moments() -> None:
    """Example 10, a ball that bounces 1.75 m high for ever, by closed forms, and method a anew."""
    fall_s = math.sqrt(1.75)  # from h = 2 t^2/2
    dt_s = 1 / 240

    def true_state(t_s: float) -> tuple[float, float]:
        since_top_s = (t_s + fall_s) % (2 * fall_s) - fall_s
        return 1.75 - since_top_s**2, -2 * since_top_s

    errors_m = []
    for run in range(10):
        begins_s = run / 11 * dt_s
        h_m, v_mps = true_state(begins_s)
        error_m = 0.0
        for frame in range(1, 20 * 240 + 1):
            v_mps -= 2 * dt_s
            h_m += v_mps * dt_s
            if h_m < 0 or h_m > 1.95:
                h_m, v_mps = abs(h_m), -v_mps
                h_m = min(h_m, 3.9 - h_m)
            error_m = max(error_m, abs(h_m - true_state(begins_s + frame * dt_s)[0]))
        errors_m.append(error_m)
    assert chart_errors_m(10, 240)["a"] == pytest.approx(max(errors_m), rel=1e-6)
    assert max(errors_m) > 2 * max(errors_m[0], errors_m[-1])  # neither the first nor the last one

def test_in_example_12_a_b_and_c_have_order_1_and_d_has_order_2() -> None:
    for letter, order in zip("abcd", (1, 1, 1, 2), strict=True):
        ratio = chart_errors_m(12, 30)[letter] / chart_errors_m(12, 240)[letter]
        assert round(math.log2(ratio) / 3) == order  # the rate is doubled three times

def test_the_cost_is_the_least_time_that_the_steps_of_a_simulated_second_take_each_in_its_turn(
        monkeypatch: pytest.MonkeyPatch) -> None:
    # In the third round a step of a takes 2 us, one of b 3 us, and so on. In all others it is 9 us.
    scenes = {letter: Scene(x_m=number, fps_target=30)
              for number, letter in enumerate(METHODS, start=2)}
    now_us: list[float] = [0.0]
    turns: list[float] = []
    ends_m: dict[float, float] = {}

    def step(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, None]:
        assert dt_s == 1 / 30
        if x_m == scene.x_m:
            turns.append(scene.x_m)  # it begins at the start,
        else:
            assert x_m == ends_m[scene.x_m]  # and goes on where the step before has ended
        ends_m[scene.x_m] = x_m + 0.25
        now_us[0] += scene.x_m if 10 < len(turns) <= 15 else 9
        return x_m + 0.25, v_mps, None

    monkeypatch.setattr(airtrack, "step", step)
    monkeypatch.setattr(airtrack, "time", SimpleNamespace(perf_counter=lambda: 1e-6 * now_us[0]))
    costs = airtrack.costs_us(scenes)
    assert costs == pytest.approx({"a": 2 * 30, "b": 3 * 30, "c": 4 * 30, "d": 5 * 30, "e": 6 * 30})
    assert turns == [2, 3, 4, 5, 6] * (len(turns) // 5)

# What the chart shows.

def test_the_chart_of_a_flight_of_20_s_has_the_errors_of_a_closed_form(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    def costs_us(scenes: dict[str, Scene]) -> dict[str, float]:
        """A frame costs 1 us with a, 2 us with b, and so on."""
        return {letter: scene.fps_target * number
                for number, (letter, scene) in enumerate(scenes.items(), start=1)
                if (scene.motion, scene.correction) == METHODS[letter]}

    monkeypatch.setattr(airtrack, "costs_us", costs_us)
    monkeypatch.setattr(airtrack, "CHART_FPS", [10, 60, 240])
    monkeypatch.setenv("COLUMNS", "80")
    words = "99 a_mps2=1 left_edge_m=-1000 right_edge_m=1000 m_to_px=20"
    main(["chart", *words.split()])
    out = capsys.readouterr().out
    for fps in (10, 60, 240):
        row, = re.findall(rf"(?m)^ *{fps} ([-+.e0-9 ]+)$", out)
        error_m, *others_m, no_error = row.split()[::2]
        assert float(error_m) == pytest.approx(20 / fps / 2, rel=0.05)  # a t dt/2
        assert all(float(other_m) < 1e-9 for other_m in others_m if other_m != "-")  # no bounce
        assert no_error == "-"  # e is the truth
        assert row.split()[1::2] == [f"{n * fps}.0" for n in (1, 2, 3, 4, 5)]
    within = r"(?m)^([a-e]): .* from +(\d+) FPS on: +(\d+)\.0 us"
    assert re.findall(within, out) == [  # a column is 5 cm; the cheapest first
        ("b", "10", "20"), ("c", "10", "30"), ("d", "10", "40"), ("e", "10", "50"),
        ("a", "240", "240")]
    scale, = re.findall(r"(?m)^.* 1 mm .*$", out)
    limit, = [line.index("|") for line in out.splitlines() if line.endswith("column of the film |")]
    assert scale.index("1 cm ") < limit < scale.index("0.1 m ")
    assert max(len(line) for line in out.splitlines()[:-1]) <= 80
    assert out.endswith(f"airtrack.py stability {words}\n")

def test_a_method_is_good_enough_from_the_rate_on_from_which_all_its_errors_are_within_a_column(
        capsys: Capture) -> None:
    series = {"a": (4, 30, 20, 9, 3), "b": (2, 5, 20, 9, 9.9), "c": (0.1, 9, 9, 9, 11),
              "d": (3, 1, 1, 1, 1), "e": (1, 0, 0, 0, 0)}
    points = [Point(letter, 15 * 2**n, error_mm / 1000, 15 * 2**n * frame_us)
              for letter, (frame_us, *errors_mm) in series.items()
              for n, error_mm in enumerate(errors_mm)]
    airtrack.print_answers(points, 0.01)
    told = re.findall(r"(?m)^([a-e]): [a-z +]+(?:(\d+) FPS on: +(\d+)\.0 us)?",
                      capsys.readouterr().out)
    assert told == [("e", "15", "15"), ("d", "15", "45"), ("b", "60", "120"), ("a", "60", "240"),
                    ("c", "", "")]

def test_the_picture_has_each_point_below_its_error_and_beside_its_cost(capsys: Capture) -> None:
    airtrack.print_picture([
        Point("a", 10, 1e-3, 10), Point("a", 20, 1e-2, 100), Point("b", 10, 1e-2, 100),
        Point("c", 10, 0.0, 10), Point("d", 10, 1e9, 1), *[Point("e", 10, 1e-4, 100)] * 2], 0.1)
    out = capsys.readouterr().out
    scale, = re.findall(r"(?m)^.* 1 mm .*$", out)
    found = []
    for row in re.findall(r"(?m)^ +\d+\.0 .*$", out):
        for mark in re.finditer("[a-e+]", row):
            error = scale[mark.start():].partition("  ")[0].strip()
            found.append((mark[0], float(row.split()[0]), error))
        if "+" in row:
            assert row.index("|") == scale.index("0.1 m ")  # a column of the film
            assert out.splitlines()[0].index("|") == row.index("|")
    assert sorted(found) == [("+", 100, "1 cm"), ("a", 10, "1 mm"), ("c", 10, "<=1 um"),
                             ("d", 1, ">=10 m"), ("e", 100, "0.1 mm")]

# What the map shows.

@pytest.mark.parametrize(("letter", "number", "motion", "correction", "fps"), [
    ("X", 14, "backward", "rebound", 10),  # thrown out by 4.1 m every other frame
    ("S", 3, "backward", "none", 30), ("H", 20, "exact", "rebound", 10),
    ("G", 10, "exact", "surface", 30), ("L", 19, "backward", "surface", 10),
    ("P", 10, "exact", "conserve", 10), ("-", 10, "exact", "rewind", 10),
    ("-", 14, "exact", "replay", 1)])
def test_each_letter_in_a_scene_of_which_it_is_known(
        letter: str, number: int, motion: str, correction: str, fps: int) -> None:
    assert worst_of(letters_of(number, motion, correction, fps)) == letter

# A run of 80 frames of 0.25 s. The track has 1 m, and a column is 1 cm. Both cars are at 0.5 m with
# 1 m/s, but for what is changed in some of the frames. The last 5 s begin with frame 60.
SCENE = Scene(x_m=0.5, v_mps=1.0, a_mps2=-2.0, left_edge_m=0.0, right_edge_m=1.0, m_to_px=100,
              fps_target=4)
LATE = range(60, 81)
FLIES, LIES = (0.5, 1.0), (0.0, 0.0)
State = tuple[float, float]
PERCENT = 0.01 * float(re.findall(r"over ([\d.]+) %", VERDICTS["G"])[0])  # of 1.5 J/kg

def car_of(states: list[State], scene: Scene = SCENE) -> Car:
    """A car with these states. It begins with the first one."""
    car = Car(scene)
    car.places_m, car.velocities_mps = [x_m for x_m, _ in states], [v_mps for _, v_mps in states]
    return car

def fast(percent: float) -> State:
    """Two columns off, with so much more energy than the true car, as a part of the key's limit."""
    return 0.52, math.sqrt(2 * (1.5 * (1 + percent * PERCENT) - 2 * 0.52))

@pytest.mark.parametrize(("letter", "true_state", "frames", "state"), [
    ("-", FLIES, [12], (0.509, 1.0)), ("P", FLIES, [12], (0.489, 1.0)),
    ("P", FLIES, [12], (1.99, 1.0)), ("X", FLIES, [12], (2.01, 1.0)),
    ("P", FLIES, [12], (-0.99, 1.0)), ("X", FLIES, [12], (-1.01, 1.0)),
    ("S", LIES, LATE, (-1e-9, 1.0)), ("S", FLIES, LATE, (1.01, 1.0)),
    ("L", FLIES, range(60, 80), (-1e-9, 1.0)), ("G", FLIES, range(61, 81), (1.01, 1.0)),
    # Low is a 650th of 1 m: 1.54 mm. Ten frames are 2.5 s.
    ("H", LIES, LATE, (0.0016, 0.0)), ("P", LIES, LATE, (0.0015, 0.0)),
    ("G", LIES, range(71, 81), (0.0, 0.0)), ("H", LIES, range(72, 81), (0.0, 0.0)),
    ("P", FLIES, LATE, fast(0.99)), ("G", FLIES, LATE, fast(1.01)),
    ("P", FLIES, LATE, fast(-0.99)), ("L", FLIES, LATE, fast(-1.01)),
    ("P", FLIES, [70], fast(21 * 0.99)), ("G", FLIES, [70], fast(21 * 1.01)),  # the mean counts
    ("P", FLIES, range(60), fast(50)), ("-", FLIES, LATE, (0.505, 2.0))])
def test_the_bounds_of_the_letters(
        letter: str, true_state: State, frames: list[int], state: State) -> None:
    states, true_states = [FLIES] * 81, [FLIES] * 81
    if true_state == LIES:
        states[12] = (0.511, 1.0)  # over a column off
    for frame in LATE:
        true_states[frame] = true_state
    for frame in frames:
        states[frame] = state
    assert verdict(car_of(states), car_of(true_states)) == letter

def test_some_late_frames_are_not_all_late_frames() -> None:
    flies = car_of([FLIES] * 81)
    assert verdict(flies, car_of([FLIES] * 61 + [LIES] * 20)) == "G"  # so it does not lie still
    stuck = [FLIES] * 60 + [(-1e-9, 0.0)] * 21  # it is stuck, although never a column off
    assert verdict(car_of(stuck), car_of([FLIES] * 60 + [LIES] * 21)) == "S"
    beyond = [(-0.1, 1.0), (1.1, 1.0)] * 10  # now the one wall, now the other
    assert verdict(car_of([FLIES] * 61 + beyond), flies) != "S"  # so it is not stuck

@pytest.mark.parametrize(("fps", "letter"), [(0.4, "L"), (1.6, "L"), (1.8, "S"), (2, "S")])
def test_fewer_than_ten_frames_do_not_show_that_a_car_is_stuck(fps: float, letter: str) -> None:
    scene = replace(SCENE, fps_target=fps)  # 3, 9, 10 and 11 frames are late
    count = round(20 * fps) + 1
    assert verdict(car_of([(-0.1, 0.0)] * count, scene), car_of([FLIES] * count, scene)) == letter

@pytest.mark.parametrize(("letters", "letter"), [
    ("XGL-", "x"), ("SHPP", "s"), ("HHGL", "h"), ("HH", "H"), ("GL", "g"), ("GLP-", "g"),
    ("LP", "l"), ("P-", "p"), ("PP", "P"), ("--", "-")])
def test_a_cell_is_the_worst_of_the_runs_and_small_if_only_some_are_so_bad(
        letters: str, letter: str) -> None:
    assert worst_of([*letters]) == letter

def test_the_map_has_a_row_for_each_pair_and_its_key_names_the_letters_that_occur(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr(airtrack, "MAP_FPS", [2, 10])
    main(["stability", "10"])
    _, head_and_rows, key = capsys.readouterr().out.split("\n\n")
    cells = re.findall(r"(?m)^\w+ \+ \w+ +(\S) +(\S)$", head_and_rows)
    assert len(cells) == 4 * len(airtrack.MOTIONS) + 2  # 14, but for a motion of one's own
    in_key = [line[0] for line in key.splitlines()]
    assert in_key == [letter for letter in "XSHGLP-" if letter in in_key]  # from worst to best
    assert {cell.upper() for row in cells for cell in row} <= set(in_key) < set(VERDICTS)

def test_the_key_of_the_map_names_a_letter_that_only_stands_below_a_worse_one(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    letters = cycle("GP")
    monkeypatch.setattr(airtrack, "verdict", lambda *_: next(letters))
    monkeypatch.setattr(airtrack, "MAP_FPS", [2])
    main(["stability", "10"])
    key = capsys.readouterr().out.rpartition("\n\n")[2]
    assert [line[0] for line in key.splitlines()] == ["G", "P"]

# Film, chart and map agree.

def test_film_chart_and_map_agree_on_what_is_within_a_column() -> None:
    for letter in "abcd":
        motion, correction = METHODS[letter]
        words = f"10 motion={motion} correction={correction} auto_off=False --frames=200"
        in_film_m = float(shown(words).rows["*"].split()[3])  # one of the ten runs, to 0.1 mm
        in_chart_m = chart_errors_m(10, 10)[letter]
        assert in_film_m <= in_chart_m + 1e-4
        in_map = set(letters_of(10, fps=10, motion=motion, correction=correction))
        assert (in_map == {"-"}) is (in_chart_m <= 1 / 55)
