"""The chart and the map: that they show what is true of the methods."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

import airtrack
from airtrack import METHODS, Frame, Point, Track, main, order_text, verdict
from films import compared, filmed

Capture = pytest.CaptureFixture[str]

# What is measured.

def test_a_run_begins_at_the_truth_a_part_of_a_frame_later_and_lasts_20_s() -> None:
    scene = compared(12, "backward", "rebound")
    truth, begins_s = airtrack.truth_of(scene), 9 / 11 / 60
    first, *others, last = airtrack.simulate(scene, 60, 9, 6)
    assert len(others) == 199  # one is kept each 0.1 s
    assert last.t_s == pytest.approx(20)
    assert (first.x_m, first.v_mps) == airtrack.step(truth, 2.0, 0.0, begins_s)[:2]
    assert last.true_m == pytest.approx(airtrack.step(truth, 2.0, 0.0, begins_s + 20)[0])

def test_in_example_12_a_b_and_c_have_order_1_and_d_has_order_2_and_e_no_error() -> None:
    orders = []
    for letter, method in METHODS.items():
        scene = compared(12, *method)
        coarse_m, fine_m = airtrack.largest_error_m(scene, 30), airtrack.largest_error_m(scene, 240)
        if letter == "e":
            assert fine_m == coarse_m == 0
        else:
            orders.append(math.log2(coarse_m / fine_m) / 3)  # the rate was doubled three times
    assert [round(order) for order in orders] == [1, 1, 1, 2]

@given(st.floats(0.5, 4), st.floats(1e-3, 0.02))
def test_the_order_is_the_power_with_which_errors_get_smaller(order: float, first_m: float) -> None:
    large = Point(5, 0.5, 1)  # as large as the track: it tells nothing of an order,
    small = [Point(80, 1e-12, 1), Point(160, 0.0, 1)]  # and neither does round-off
    points = [Point(10 * rate, first_m / rate**order, 1) for rate in (1, 2, 4)]
    assert float(order_text([large, *points, *small], 1.0)) == pytest.approx(order, abs=0.051)
    assert order_text([large, large, *points[:2]], 1.0) == "?"
    assert order_text([Point(fps, 1e-12, 1) for fps in (10, 20, 40)], 1.0) == "none"

def test_the_cost_is_that_of_the_steps_of_a_simulated_second(
        monkeypatch: pytest.MonkeyPatch) -> None:
    steps = []

    def counted_step(*_: object) -> tuple[float, float, None]:
        steps.append(1)
        return 1.0, 0.0, None

    monkeypatch.setattr(airtrack, "step", counted_step)
    monkeypatch.setattr("time.perf_counter", lambda: 2e-6 * len(steps))  # a step takes 2 us
    assert airtrack.cost_us(Track(), 30) == pytest.approx(2 * 30)

# What the chart shows.

def test_the_chart_of_a_flight_of_20_s_has_the_errors_of_a_closed_form(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr(airtrack, "CHART_FPS", [10, 60, 240])
    monkeypatch.setattr(airtrack, "cost_us", lambda track, fps: float(fps))
    monkeypatch.setenv("COLUMNS", "80")
    main(["chart", "99", "a_mps2=1", "left_edge_m=-1000", "right_edge_m=1000", "m_to_px=20"])
    out = capsys.readouterr().out
    assert max(len(line) for line in out.splitlines()) <= 80
    for fps in (10, 60, 240):
        row, = re.findall(rf"(?m)^ *{fps}  (\S.*)", out)
        error_m, *others_m = [float(word) for word in row.split()[::2]]
        assert error_m == pytest.approx(20 / fps / 2, rel=0.05)  # a t dt/2
        assert max(others_m) < 1e-9
    assert re.search(r"(?m)^order +1\.0 +none +none +none +none$", out)
    assert re.findall(r"(?m)^  a .* from +(\d+) FPS on", out) == ["240"]  # a column is 5 cm
    scale, = re.findall(r"(?m)^.* 1 mm .*$", out)
    drawn_at, = {line.index("|") for line in out.splitlines() if "|" in line}
    assert scale.index("1 cm ") < drawn_at < scale.index("0.1 m ")

def test_the_answer_is_the_cheapest_rate_from_which_on_all_errors_are_within_a_column(
        capsys: Capture) -> None:
    def series(frame_us: float, *errors_mm: float) -> list[Point]:
        return [Point(10 * 2**n, errors_mm[n] / 1000, 10 * 2**n * frame_us) for n in range(4)]

    airtrack.print_answer({
        "a": series(4, 30, 20, 9, 3), "b": series(2, 5, 20, 9, 9.9), "c": series(0.1, 9, 9, 9, 11),
        "d": series(3, 1, 1, 1, 1), "e": series(1, 30, 30, 30, 9)}, 0.01)
    told = re.findall(r"(?m)^  ([a-e]) .* from +(\d+) FPS on +(\d+) us", capsys.readouterr().out)
    assert told == [("d", "10", "30"), ("b", "40", "80"), ("e", "80", "80"), ("a", "40", "160")]

def test_the_picture_has_each_point_below_its_error_and_beside_its_cost(capsys: Capture) -> None:
    airtrack.print_picture({
        "a": [Point(10, 1e-3, 10), Point(20, 1e-2, 100)], "b": [Point(10, 1e-2, 100)],
        "c": [Point(10, 0.0, 10)], "d": [Point(10, 1e9, 1)], "e": [Point(10, 1e-4, 100)] * 2}, 0.1)
    out = capsys.readouterr().out
    scale, = re.findall(r"(?m)^.* 1 mm .*$", out)
    found = []
    for row in re.findall(r"(?m)^ +\d+ .*$", out):
        for mark in re.finditer("[a-e+]", row):
            found.append((mark[0], row.split()[0], scale[mark.start():].partition("  ")[0].strip()))
        if "+" in row:
            assert row.index("|") == scale.index("0.1 m ")  # a column of the film
    assert sorted(found) == [("+", "100", "1 cm"), ("a", "10", "1 mm"), ("c", "10", "<=1 um"),
                             ("d", "1", ">=10 m"), ("e", "100", "0.1 mm")]

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
    scene = compared(number, motion, correction)
    assert airtrack.cell([verdict(scene, 1 / 55, fps, cut) for cut in range(10)]) == letter

def fast(gain: float) -> dict[str, float]:
    """Over a column off, with so many J/kg more than the true car, which is at 0.5 m."""
    return {"x_m": 0.52, "v_mps": math.sqrt(2 * (0.5 + gain - 2 * 0.02))}

@pytest.mark.parametrize(("letter", "true_car_lies", "seconds", "values"), [
    ("-", False, [3], {"x_m": 0.509}), ("P", False, [3], {"x_m": 0.489}),  # a column is 1 cm
    ("P", False, [3], {"x_m": 1.99}), ("X", False, [3], {"x_m": 2.01}),  # the track has 1 m
    ("P", False, [3], {"x_m": -0.99}), ("X", False, [3], {"x_m": -1.01}),
    ("S", True, range(15, 21), {"x_m": -1e-9}), ("S", False, range(15, 21), {"x_m": 1.01}),
    ("L", False, range(15, 20), {"x_m": -1e-9}), ("G", False, range(16, 21), {"x_m": 1.01}),
    ("H", True, [20], {"x_m": 0.0011}), ("-", True, [20], {"x_m": 0.0009}),
    ("-", True, [14], {"x_m": 0.505}), ("-", False, range(15, 21), {"x_m": 0.505, "true_mps": 0}),
    # 1 % of v^2/2 + |a| * 1 m is 0.025 J/kg. The mean of the six frames of the last 5 s counts.
    ("P", False, range(15, 21), fast(0.024)), ("G", False, range(15, 21), fast(0.026)),
    ("P", False, range(15, 21), fast(-0.024)), ("L", False, range(15, 21), fast(-0.026)),
    ("P", False, [17], fast(6 * 0.024)), ("G", False, [17], fast(6 * 0.026)),
    ("P", False, range(15), fast(1)), ("-", False, range(15, 21), {"v_mps": 2.0}),
    ("G", False, [20], {"true_m": 0.0, "true_mps": 0.0})])
def test_the_bounds_of_the_letters(
        letter: str, true_car_lies: bool, seconds: list[int], values: dict[str, float],
        monkeypatch: pytest.MonkeyPatch) -> None:
    frames = []
    for second in range(21):
        frame = Frame(second, 0.5, 1.0, None, 0.5, 1.0)
        if true_car_lies and second >= 15:
            frame = Frame(second, 0.0, 0.0, None, 0.0, 0.0)
        if second in seconds:
            frame = frame._replace(**values)
        frames.append(frame)
    monkeypatch.setattr(airtrack, "simulate", lambda *_: frames)
    track = Track(v_mps=1.0, a_mps2=-2.0, left_edge_m=0.0, right_edge_m=1.0)
    assert verdict(track, 0.01, 10, 0) == letter

@pytest.mark.parametrize(("letters", "letter"), [
    ("XGL-", "x"), ("SHPP", "s"), ("HHGL", "h"), ("HH", "H"), ("GLP-", "W"), ("GL", "W"),
    ("GP", "g"), ("LP", "l"), ("P-", "p"), ("PP", "P"), ("--", "-")])
def test_a_cell_is_the_worst_of_the_runs_and_small_if_only_some_are_so_bad(
        letters: str, letter: str) -> None:
    assert airtrack.cell(list(letters)) == letter

def test_the_map_has_a_row_for_each_pair_and_fits_on_a_screen_with_its_key(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    main(["stability", "10"])
    out = capsys.readouterr().out
    assert max(len(line) for line in out.splitlines()) <= 80
    _, *screen = out.rpartition("\n\n")[2].splitlines()
    rows, key = screen[:-8], screen[-8:]
    assert len(rows) == 4 * len(airtrack.MOTIONS) + 2  # 14, which is 22 lines with the key
    for row in rows:
        assert re.fullmatch(r"\w+ \+ \w+" + r" +[XxSsHhWGgLlPp-]" * 9, row)
    assert [line[0] for line in key] == [*"XSHWGLP-"]
    assert re.search(r"(?m)^backward \+ rebound( +\S){3} +W ", out)  # at 10 FPS

def test_film_chart_and_map_agree_on_what_is_within_a_column(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr(airtrack, "CHART_FPS", [10])
    main(["chart", "10"])
    row, = re.findall(r"(?m)^ +10  (\S.*)", capsys.readouterr().out)
    for (motion, correction), word in zip(METHODS.values(), row.split()[::2], strict=True):
        in_chart_m = float(word)
        car = filmed(10, 200, motion=motion, correction=correction)  # one of the ten runs
        in_film_m = max(frame.error_m() for frame in car.frames)
        assert in_film_m - 1e-9 <= in_chart_m * 1.05  # two digits are printed
        in_map = {verdict(compared(10, motion, correction), 1 / 55, 10, cut) for cut in range(10)}
        assert (in_map == {"-"}) is (in_chart_m <= 1 / 55)
