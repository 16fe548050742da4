"""The chart and the map: that they show what is true of the methods."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import airtrack
from airtrack import METHODS, MOTIONS, Frame, Point, Track, main, order_text, verdict, worst_of
from examples import EXAMPLES
from films import compared, filmed, furthest_m, shown

Capture = pytest.CaptureFixture[str]
COLUMN_M = 1 / 55

Frames = list[Frame]

def ten_runs(number: int, motion: str, correction: str, fps: int) -> list[tuple[Frames, Frames]]:
    """The frames of ten runs of an example with a method, and of their true cars."""
    track = compared(number, motion, correction)
    return [(airtrack.beside(true_frames, track), true_frames)
            for true_frames in airtrack.ten_true_runs(track, fps)]

def largest_m(number: int, letter: str, fps: int) -> float:
    """How far a method gets from the truth in ten runs."""
    return max(airtrack.furthest_m(*run) for run in ten_runs(number, fps=fps, **METHODS[letter]))

def letters_of(number: int, motion: str, correction: str, fps: int) -> list[str]:
    """The verdicts on the ten runs."""
    track = compared(number, motion, correction)
    return [verdict(track, *run, COLUMN_M) for run in ten_runs(number, motion, correction, fps)]

# What is measured.

def test_a_run_begins_at_the_truth_a_part_of_a_frame_later_and_lasts_20_s() -> None:
    track = compared(12, "backward", "rebound")
    truth = airtrack.truth_of(track)
    frames, true_frames = ten_runs(12, "backward", "rebound", 60)[9]
    begins_s = 9 / 11 / 60
    assert frames[0] == true_frames[0]
    assert (frames[0].x_m, frames[0].v_mps) == airtrack.step(truth, 2.0, 0.0, begins_s)[:2]
    assert len(true_frames) == 1201
    assert true_frames[-1].t_s == pytest.approx(20)
    ends_m, _, _ = airtrack.step(truth, 2.0, 0.0, begins_s + 20)
    assert true_frames[-1].x_m == pytest.approx(ends_m)

def test_in_example_12_a_b_and_c_have_order_1_and_d_has_order_2() -> None:
    orders = []
    for letter in "abcd":
        # The rate is doubled three times.
        orders.append(math.log2(largest_m(12, letter, 30) / largest_m(12, letter, 240)) / 3)
    assert [round(order) for order in orders] == [1, 1, 1, 2]

def points(*errors_m: float, first_fps: int = 10) -> list[Point]:
    """Points at one rate, at twice this rate, and so on."""
    return [Point(first_fps * 2**n, error_m, 1) for n, error_m in enumerate(errors_m)]

@given(st.floats(0.5, 4), st.floats(1e-3, 0.02), st.sampled_from([1, 128]))
def test_the_order_is_the_power_with_which_errors_get_smaller(
        order: float, first_m: float, unit: int) -> None:
    large = Point(5, 0.5 * unit, 1)  # as large as the track: it tells nothing of an order,
    small = points(1e-12 * unit, 0.0, first_fps=80)  # and neither does round-off
    telling = points(*[unit * first_m / rate**order for rate in (1, 2, 4)])
    assert float(order_text([large, *telling, *small], unit)) == pytest.approx(order, abs=0.051)
    assert order_text([large, large, *telling[:2]], unit) == "?"
    assert order_text([large, *small], unit) == "none"

def test_the_cost_is_the_least_time_that_the_steps_of_a_simulated_second_take_each_in_its_turn(
        monkeypatch: pytest.MonkeyPatch) -> None:
    # In the third round a step of a takes 2 us, one of b 3 us, and so on. In all others it is 9 us.
    tracks = {letter: Track(x_m=number, **METHODS[letter])
              for number, letter in enumerate(METHODS, start=2)}
    now_us: list[float] = [0.0]
    turns: list[float] = []
    ends_m: dict[float, float] = {}

    def step(track: Track, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, None]:
        assert dt_s == 1 / 30
        if x_m == track.x_m:
            turns.append(track.x_m)  # it begins at the start,
        else:
            assert x_m == ends_m[track.x_m]  # and goes on where the step before has ended
        ends_m[track.x_m] = x_m + 0.25
        now_us[0] += track.x_m if 10 < len(turns) <= 15 else 9
        return x_m + 0.25, v_mps, None

    monkeypatch.setattr(airtrack, "step", step)
    monkeypatch.setattr(airtrack, "time", SimpleNamespace(perf_counter=lambda: 1e-6 * now_us[0]))
    costs = airtrack.costs_us(tracks, 30)
    assert costs == pytest.approx({"a": 2 * 30, "b": 3 * 30, "c": 4 * 30, "d": 5 * 30, "e": 6 * 30})
    assert turns == [2, 3, 4, 5, 6] * (len(turns) // 5)
    assert len(turns) >= 5 * 5

# What the chart shows.

def chart_of(words: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> str:
    """The chart, if a frame costs 1 us with a, 2 us with b, and so on."""
    methods = [*METHODS.values()]

    def costs_us(tracks: dict[str, Track], fps: int) -> dict[str, float]:
        return {letter: fps * (1.0 + methods.index(
            {"motion": track.motion, "correction": track.correction}))
            for letter, track in tracks.items()}

    monkeypatch.setattr(airtrack, "costs_us", costs_us)
    monkeypatch.setenv("COLUMNS", "80")
    main(["chart", *words.split()])
    out = capsys.readouterr().out
    table, _, command = out.rpartition("Next: ")
    assert max(len(line) for line in table.splitlines()) <= 80
    assert command.count("\n") == 1  # it is not broken
    return out

def test_the_chart_of_a_flight_of_20_s_has_the_errors_of_a_closed_form(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr(airtrack, "CHART_FPS", [10, 60, 240])
    words = "99 a_mps2=1 left_edge_m=-1000 right_edge_m=1000 m_to_px=20"
    out = chart_of(words, monkeypatch, capsys)
    for fps in (10, 60, 240):
        row, = re.findall(rf"(?m)^ *{fps} ([-+.e0-9 ]+)$", out)
        error_m, *others_m, no_error = row.split()[::2]
        assert float(error_m) == pytest.approx(20 / fps / 2, rel=0.05)  # a t dt/2
        assert set(others_m) == {"-"}  # no bounce, no error
        assert no_error == "-"  # e is the truth
        assert row.split()[1::2] == [f"{n * fps}.0" for n in (1, 2, 3, 4, 5)]
    assert re.search(r"(?m)^order +1\.0 +none +none +none +none$", out)
    within = r"(?m)^([a-e]): .* from +(\d+) FPS on: +(\d+)\.0 us"
    assert sorted(re.findall(within, out)) == [  # a column is 5 cm
        ("a", "240", "240"), ("b", "10", "20"), ("c", "10", "30"), ("d", "10", "40"),
        ("e", "10", "50")]
    assert re.search(r"(?m)^a: .* 60.0 us, up to 0.17 m off$", out)
    assert re.search(r"(?m)^e: .* 300.0 us, .*by definition$", out)
    scale, = re.findall(r"(?m)^.* 1 mm .*$", out)
    drawn_at, = {line.index("|") for line in out.splitlines() if "|" in line}
    assert scale.index("1 cm ") < drawn_at < scale.index("0.1 m ")
    assert out.endswith(f"airtrack.py stability {words}\n")

def test_the_answer_is_the_cheapest_rate_from_which_on_all_errors_are_within_a_column(
        capsys: Capture) -> None:
    def series(frame_us: float, *errors_mm: float) -> list[Point]:
        return [Point(15 * 2**n, error_mm / 1000, 15 * 2**n * frame_us)
                for n, error_mm in enumerate(errors_mm)]

    airtrack.print_answers({
        "a": series(4, 30, 20, 9, 3), "b": series(2, 5, 20, 9, 9.9), "c": series(0.1, 9, 9, 9, 11),
        "d": series(3, 1, 1, 1, 1), "e": series(1, 0, 0, 0, 0)}, 0.01)
    _, *rows = capsys.readouterr().out.splitlines()
    pattern = r"^([a-e]): .*?(?:from +(\d+) FPS on: +(\d+)\.0 us|at no rate) +(\d+)\.0 us"
    told = [re.findall(pattern, row) for row in rows]
    assert told == [[("e", "15", "15", "60")], [("d", "15", "45", "180")],
                    [("b", "60", "120", "120")], [("a", "60", "240", "240")], [("c", "", "", "6")]]

def test_the_picture_has_each_point_below_its_error_and_beside_its_cost(capsys: Capture) -> None:
    airtrack.print_picture({
        "a": [Point(10, 1e-3, 10), Point(20, 1e-2, 100)], "b": [Point(10, 1e-2, 100)],
        "c": [Point(10, 0.0, 10)], "d": [Point(10, 1e9, 1)], "e": [Point(10, 1e-4, 100)] * 2}, 0.1)
    out = capsys.readouterr().out
    scale, = re.findall(r"(?m)^.* 1 mm .*$", out)
    found = []
    for row in re.findall(r"(?m)^ +\d+\.0 .*$", out):
        for mark in re.finditer("[a-e+]", row):
            error = scale[mark.start():].partition("  ")[0].strip()
            found.append((mark[0], float(row.split()[0]), error))
        if "+" in row:
            assert row.index("|") == scale.index("0.1 m ")  # a column of the film
    assert sorted(found) == [("+", 100, "1 cm"), ("a", 10, "1 mm"), ("c", 10, "<=1 um"),
                             ("d", 1, ">=10 m"), ("e", 100, "0.1 mm")]

# What the map shows.

@pytest.mark.parametrize(("letter", "number", "motion", "correction", "fps"), [
    ("X", 14, "backward", "rebound", 10),  # thrown out by 4.1 m every other frame
    ("S", 3, "backward", "none", 30), ("H", 20, "exact", "rebound", 10),
    ("W", 10, "backward", "rebound", 10),  # the motion loses energy, and the rebound gains some
    ("G", 10, "exact", "surface", 30), ("L", 19, "backward", "surface", 10),
    ("P", 10, "exact", "conserve", 10), ("-", 10, "exact", "rewind", 10),
    ("-", 14, "exact", "replay", 1)])
def test_each_letter_in_a_scene_of_which_it_is_known(
        letter: str, number: int, motion: str, correction: str, fps: int) -> None:
    assert worst_of(letters_of(number, motion, correction, fps)) == letter

# A run of 80 frames of 0.25 s. The track has 1 m, and a column is 1 cm. Both cars are at 0.5 m with
# 1 m/s, but for what is changed in some of the frames. The last 5 s begin with frame 60.
TRACK = Track(x_m=0.5, v_mps=1.0, a_mps2=-2.0, left_edge_m=0.0, right_edge_m=1.0)
LATE = range(60, 81)
FLIES, LIES = (0.5, 1.0), (0.0, 0.0)

def each_quarter_s(states: list[tuple[float, float]]) -> Frames:
    """Frames with these places and velocities."""
    return [Frame(n / 4, 0.25, x_m, v_mps, None) for n, (x_m, v_mps) in enumerate(states)]

def fast(gain: float) -> tuple[float, float]:
    """Two columns off, with so many J/kg more than the true car, which has 1.5."""
    return 0.52, math.sqrt(2 * (0.5 + gain - 2 * 0.02))

@pytest.mark.parametrize(("letter", "true_state", "frames", "state"), [
    ("-", FLIES, [12], (0.509, 1.0)), ("P", FLIES, [12], (0.489, 1.0)),
    ("P", FLIES, [12], (1.99, 1.0)), ("X", FLIES, [12], (2.01, 1.0)),
    ("P", FLIES, [12], (-0.99, 1.0)), ("X", FLIES, [12], (-1.01, 1.0)),
    ("S", LIES, LATE, (-1e-9, 1.0)), ("S", FLIES, LATE, (1.01, 1.0)),
    ("L", FLIES, range(60, 80), (-1e-9, 1.0)), ("G", FLIES, range(61, 81), (1.01, 1.0)),
    # Low is a 650th of 0.75 m, as 1.5 J/kg lift it so high: 1.15 mm. Ten frames are 2.5 s.
    ("H", LIES, LATE, (0.0012, 0.0)), ("P", LIES, LATE, (0.0011, 0.0)),
    ("G", LIES, range(71, 81), (0.0, 0.0)), ("H", LIES, range(72, 81), (0.0, 0.0)),
    # 1 % of 1.5 J/kg is 0.015 J/kg. The mean of the last 5 s counts.
    ("P", FLIES, LATE, fast(0.0149)), ("G", FLIES, LATE, fast(0.0151)),
    ("P", FLIES, LATE, fast(-0.0149)), ("L", FLIES, LATE, fast(-0.0151)),
    ("P", FLIES, [70], fast(21 * 0.0149)), ("G", FLIES, [70], fast(21 * 0.0151)),
    ("P", FLIES, range(60), fast(1)), ("-", FLIES, LATE, (0.505, 2.0))])
def test_the_bounds_of_the_letters(letter: str, true_state: tuple[float, float], frames: Any,
                                   state: tuple[float, float]) -> None:
    states, true_states = [FLIES] * 81, [FLIES] * 81
    if true_state == LIES:
        states[12] = (0.511, 1.0)  # over a column off
    for frame in LATE:
        true_states[frame] = true_state
    for frame in frames:
        states[frame] = state
    assert verdict(TRACK, each_quarter_s(states), each_quarter_s(true_states), 0.01) == letter

def test_a_true_car_that_moves_in_one_of_the_last_frames_does_not_lie_still() -> None:
    true_frames = each_quarter_s([FLIES] * 61 + [LIES] * 20)
    assert verdict(TRACK, each_quarter_s([FLIES] * 81), true_frames, 0.01) == "G"

def test_a_car_that_is_now_beyond_the_one_wall_and_now_beyond_the_other_is_not_stuck() -> None:
    states = [FLIES] * 60 + [(-0.1, 1.0), (1.1, 1.0)] * 10 + [FLIES]
    states[-1] = (-0.1, 1.0)
    assert verdict(TRACK, each_quarter_s(states), each_quarter_s([FLIES] * 81), 0.01) != "S"

@pytest.mark.parametrize("place_m", [-10, 10])
def test_a_car_gets_out_by_the_length_of_its_track_wherever_the_track_is(place_m: float) -> None:
    track = replace(TRACK, x_m=0.5 + place_m, left_edge_m=place_m, right_edge_m=1 + place_m)
    for x_m, letter in [(1.99, "P"), (2.01, "X"), (-0.99, "P"), (-1.01, "X")]:
        frames, true_frames = ([
            frame._replace(x_m=frame.x_m + place_m) for frame in each_quarter_s(states)]
            for states in ([FLIES, (x_m, 1.0), *[FLIES] * 79], [FLIES] * 81))
        assert verdict(track, frames, true_frames, 0.01) == letter

@pytest.mark.parametrize(("frames", "letter"), [
    (8, "L"), (35, "L"), (36, "S"), (40, "S")])  # 3, 9, 10 and 11 of them are late
def test_fewer_than_ten_frames_do_not_show_that_a_car_is_stuck(frames: int, letter: str) -> None:
    stuck = [Frame(20 * n / frames, 0.0, -0.1, 0.0, None) for n in range(frames + 1)]
    flying = [frame._replace(x_m=0.5, v_mps=1.0) for frame in stuck]
    assert verdict(TRACK, stuck, flying, 0.01) == letter

@pytest.mark.parametrize(("letters", "letter"), [
    ("XGL-", "x"), ("SHPP", "s"), ("HHGL", "h"), ("HH", "H"), ("GL", "W"), ("GLLG", "W"),
    ("GLP-", "w"), ("GP", "g"), ("LP", "l"), ("P-", "p"), ("PP", "P"), ("--", "-")])
def test_a_cell_is_the_worst_of_the_runs_and_small_if_only_some_are_so_bad(
        letters: str, letter: str) -> None:
    assert worst_of(list(letters)) == letter

def test_the_map_has_a_row_for_each_pair_and_fits_on_a_screen_with_its_key_and_a_prompt(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    main(["stability", "10"])
    out = capsys.readouterr().out
    assert max(len(line) for line in out.splitlines()) <= 80
    screen = out.rpartition("\n\n")[2].splitlines()
    rows, key = screen[1:-8], screen[-8:]  # with the program's 14 rows and a prompt 24 lines
    assert len(rows) == 4 * len(MOTIONS) + 2
    for row in rows:
        assert re.fullmatch(r"\w+ \+ \w+" + r" +[XxSsHhWwGgLlPp-]" * 9, row)
    assert [line[0] for line in key] == [*"XSHWGLP-"]
    assert re.search(r"(?m)^backward \+ rebound( +\S){3} +W ", out)  # at 10 FPS

# Film, chart and map agree.

def told(words: str) -> str:
    """The name of the verdict that a film has for its *."""
    end = [line for line in shown(words).table if line.startswith("* ")][-1]
    return end.rpartition("; ")[2].strip()

def test_film_chart_and_map_agree_on_what_is_within_a_column() -> None:
    for letter in "abcd":
        in_film_m = furthest_m(filmed(10, 200, **METHODS[letter]))  # one of the ten runs
        in_chart_m = largest_m(10, letter, 10)
        assert in_film_m <= in_chart_m + 1e-9
        in_map = set(letters_of(10, fps=10, **METHODS[letter]))
        assert (in_map == {"-"}) is (in_chart_m <= COLUMN_M)

@given(number=st.sampled_from([1, 2, 3, 8, 10, 13, 14, 18, 19, 20, 22]),
       motion=st.sampled_from([*MOTIONS]), fps=st.sampled_from([1, 5, 10, 30, 60]),
       correction=st.sampled_from(["none", "surface", "rebound", "conserve"]))
@settings(max_examples=40)
def test_a_film_has_the_verdict_of_the_first_of_the_map_s_ten_runs_whenever_it_is_ended(
        number: int, motion: str, correction: str, fps: int) -> None:
    track = compared(number, motion, correction)
    column_m = airtrack.scene_of(EXAMPLES[number].settings).column_m()
    first = ten_runs(number, motion, correction, fps)[0]
    name, _ = airtrack.VERDICTS[verdict(track, *first, column_m)]
    words = f"{number} motion={motion} correction={correction} fps_target={fps} auto_off=False"
    for frames in (1, 7 * fps, 20 * fps, 33 * fps):
        assert told(f"{words} --frames={frames}") == name

def test_a_film_with_jitter_has_the_same_verdict_however_early_it_is_ended() -> None:
    words = "9 jitter=0.5 fps_target=10 auto_off=False"
    assert told(f"{words} --frames=1") == told(f"{words} --frames=300")
