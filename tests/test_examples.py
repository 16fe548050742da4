"""The examples: the figures of their texts are read there, and compared with the films."""

import math
import re
from typing import Any

import pytest

from airtrack import METHODS, scene_of
from clock import plain
from examples import EXAMPLES
from films import bounces, filmed, furthest_m, hops, shown, tops_m

Changes = dict[str, Any]
REPLAY = {"motion": "exact", "correction": "replay"}
CONSERVE = {"motion": "exact", "correction": "conserve"}

def told(number: int, pattern: str) -> list[float]:
    """The figures in an example's texts, in the order in which the pattern has its groups."""
    example = EXAMPLES[number]
    found = re.search(pattern, plain(f"{example.look_for} {example.seen}"))
    assert found, f"example {number} has no {pattern}"
    return [float(figure) for figure in found.groups()]

@pytest.mark.parametrize(("words", "frames"), [  # what is said of them elsewhere
    ("5", 236), ("12", 130), ("12 correction=replay", 124)])
def test_the_film_stops_in_the_frame_of_the_lesson(words: str, frames: int) -> None:
    assert len(shown(words).lines) == frames

@pytest.mark.parametrize(("number", "pattern", "words"), [
    (1, r"In frame (\d+) the film stops", "1"), (4, r"stops after (\d+) frames", "4"),
    (6, r"stops after (\d+) frames", "6"), (6, r"stops after (\d+) frames, as example 5", "5"),
    (19, r"In frame (\d+) the film stops", "19"),
    (22, r"motion=backward: the film stops in frame (\d+)", "22 motion=backward")])
def test_the_film_stops_in_the_frame_that_is_told(number: int, pattern: str, words: str) -> None:
    assert told(number, pattern) == [len(shown(words).lines)]

@pytest.mark.parametrize(("number", "mark"), [(12, "*"), (20, "o"), (22, "o")])
def test_a_car_is_at_rest_from_the_frame_that_is_told(number: int, mark: str) -> None:
    row = shown(f"{number} auto_off=False --frames=600").rows[mark]
    if number == 12:
        row = shown("12").rows[mark]  # it hops on, too low to be seen
    assert row.endswith(f"from frame {told(number, r'at rest from frame (.+?)[ .)]')[0]:g}")

@pytest.mark.parametrize(("number", "pattern", "changes"), [
    (3, r"In frame (\d+) \(t", {}), (10, r"first bounce, in line (\d+)", {}),
    (10, r"The 0 in frame (\d+)", {}), (13, r"meets the wall, in frame (\d+)", {"motion": "exact"}),
    (17, r"first bounce, in frame (\d+)", {}), (21, r"first bounce, in frame (\d+)", CONSERVE)])
def test_the_first_bounce_is_in_the_frame_that_is_told(
        number: int, pattern: str, changes: Changes) -> None:
    assert told(number, pattern) == bounces(filmed(number, 100, **changes))[:1]

@pytest.mark.parametrize(("number", "pattern", "changes"), [
    (1, r"starts ([\d.]+) m from the left wall, and gets back to ([\d.]+) m, ([\d.]+) m and "
        r"([\d.]+) m", {}),
    (8, r"First only to ([\d.]+) m", {}), (13, r"The \* does. It turns at ([\d.]+) m", {}),
    (9, r"turns at about ([\d.]+) m, then at ([\d.]+) m and ([\d.]+) m", {}),
    (13, r"and the o at ([\d.]+) m", REPLAY)])
def test_on_its_way_to_the_right_it_turns_where_it_is_told(
        number: int, pattern: str, changes: Changes) -> None:
    places_m = filmed(number, 3000, **changes).places_m
    turns_m = tops_m(places_m)
    if number == 1:  # counted from the wall
        turns_m = [x_m - 0.25 for x_m in (places_m[0], *turns_m)]
    figures = told(number, pattern)
    assert turns_m[:len(figures)] == pytest.approx(figures, abs=0.006)

@pytest.mark.parametrize(("number", "changes", "count"), [
    (7, {}, 2), (8, {}, 2), (10, {}, 7), (11, {}, 7), (17, CONSERVE, 7)])
def test_it_comes_back_to_its_mark(number: int, changes: Changes, count: int) -> None:
    turns_m = tops_m(filmed(number, 3000, **changes).places_m)
    if number in (7, 8):
        assert 2 - turns_m[0] > 0.01  # only every second time
        turns_m = turns_m[1::2]
    assert turns_m[:count] == pytest.approx([2] * count, abs=0.006)

def test_7_turns_short_of_its_mark() -> None:
    short_cm, frame, t_s = told(7, r"turns ([\d.]+) cm short .* in frame (\d+) \(t = ([\d.]+) s\)")
    places_m = filmed(7, 1000).places_m
    assert 100 * (2 - places_m[round(frame)]) == pytest.approx(short_cm, abs=0.06)
    assert places_m[round(frame)] == max(places_m[300:])
    assert t_s == pytest.approx(frame / 240, abs=0.005)

@pytest.mark.parametrize(("number", "pattern", "in_m", "frames", "changes"), [
    (12, r"at most about ([\d.]+) mm off", 0.001, 130, {}),
    (16, r"they are ([\d.]+) cm apart in frame 1", 0.01, 1, {}),
    (16, r"([\d.]+) cm in frame 2", 0.01, 2, {}), (16, r"up to ([\d.]+) m within 20 s", 1, 200, {}),
    (17, r"up to ([\d.]+) m within 20 s", 1, 200, {}), (18, r"about ([\d.]+) m apart", 1, 4, {}),
    (21, r"Letter a leaves the \* first, by ([\d.]+) cm", 0.01, 1, "a"),
    (21, r"Within 20 s it gets up to ([\d.]+) m away", 1, 200, "a"),
    (21, r"b gets furthest away, up to ([\d.]+) m", 1, 200, "b"),
    (21, r"seven times, and gets up to ([\d.]+) m away", 1, 200, "c")])
def test_it_gets_so_far_from_the_truth(
        number: int, pattern: str, in_m: float, frames: int, changes: Changes | str) -> None:
    if isinstance(changes, str):
        motion, correction = METHODS[changes]
        changes = {"motion": motion, "correction": correction}
    figure, = told(number, pattern)
    assert furthest_m(filmed(number, frames, **changes)) == pytest.approx(figure * in_m, rel=0.05)

@pytest.mark.parametrize(("number", "frames", "changes"), [
    (10, 200, {}), (11, 200, {}), (13, 24, {"motion": "exact"}), (17, 13, {}), (18, 2, {}),
    (18, 80, REPLAY), (21, 13, CONSERVE)])
def test_it_stays_on_the_truth(number: int, frames: int, changes: Changes) -> None:
    assert furthest_m(filmed(number, frames, **changes)) < 1e-9

@pytest.mark.parametrize(("number", "pattern", "changes", "more"), [
    (19, r"the hops take (\d+), (\d+), (\d+) \.\.\. lines, down", {}, [12, 11, 10, 9]),
    (19, r"Then the hops take (\d+), (\d+), (\d+) \.\.\. lines", {"motion": "exact"}, [21, 22, 23]),
    (20, r"take (\d+), (\d+), (\d+) lines and, from frame 48 on, 9 for ever", {}, [9] * 50)])
def test_the_hops_take_so_many_lines(
        number: int, pattern: str, changes: Changes, more: list[int]) -> None:
    expected = [*told(number, pattern), *more]
    assert hops(filmed(number, 600, **changes))[:len(expected)] == expected

@pytest.mark.parametrize(("number", "pattern", "count"), [
    (20, r"from frame (\d+) on, (\d+) for ever", 50),
    (22, r"From frame (\d+) on the \* hops for ever, in hops of (\d+) lines", 15)])
def test_from_this_frame_on_all_hops_are_equal(number: int, pattern: str, count: int) -> None:
    frame, lines = told(number, pattern)
    car = filmed(number, 600)
    first = bounces(car).index(round(frame))
    assert hops(car)[first:first + count] == [lines] * count
    assert hops(car)[first - 1] != lines

@pytest.mark.parametrize(("number", "pattern", "g_dt_mps", "changes"), [
    (19, r"leaves at ([\d.]+), ([\d.]+), ([\d.]+), ([\d.]+) \.\.\. m/s", 0.2, {}),
    (20, r"in the end it leaves at ([\d.]+) m/s and comes back at ([\d.]+) m/s", 0.2, {})])
def test_a_hop_leaves_and_comes_back_at_these_speeds(
        number: int, pattern: str, g_dt_mps: float, changes: Changes) -> None:
    car = filmed(number, 1000)
    left = [car.velocities_mps[begins] for begins in bounces(car)]
    figures = told(number, pattern)
    if number == 19:
        assert left[:4] == pytest.approx(figures, abs=0.0006)
    else:
        came = hops(car)[-1] * g_dt_mps - left[-2]
        assert [left[-2], came] == pytest.approx(figures, abs=0.006)

@pytest.mark.parametrize(("number", "pattern"), [
    (12, r"before t = ([\d.]+) s, the Zeno point"), (20, r"still from t = ([\d.]+) s on"),
    (22, r"still from t = ([\d.]+) s on")])
def test_the_zeno_point_is_that_of_the_closed_form(number: int, pattern: str) -> None:
    scene = scene_of(EXAMPLES[number].settings)
    g, h_m, v_mps = -scene.a_mps2, scene.x_m - scene.left_edge_m, scene.v_mps
    hits_mps = math.sqrt(v_mps**2 + 2 * g * h_m)
    zeno_s = (v_mps + hits_mps) / g + 2 * 0.8 * hits_mps / g / (1 - 0.8)
    assert told(number, pattern) == pytest.approx([zeno_s], abs=0.006)

def test_0_is_at_the_left_wall_after_45_s_and_flies_until_44_s() -> None:
    flies_s, = told(0, r"From about t = ([\d.]+) s on")
    car = filmed(0, 3000)
    assert car.places_m[-1] == pytest.approx(0.5, abs=1e-3)
    assert sum(mark_m > 17 for mark_m in car.marks_m if mark_m is not None) == 3
    last = max(number for number, mark_m in enumerate(car.marks_m) if mark_m is None)
    assert last * 0.015 == pytest.approx(flies_s, abs=0.5)
    line, = shown("0 --frames=1").lines
    assert "v = 16.97" in line  # 17 - 2 * 0.015, and details without d

def test_3_is_caught_sinks_by_1_mm_a_frame_and_gets_out_of_the_picture() -> None:
    sinks_mm, = told(3, r"in the end by (\d+) mm a frame")
    places_m = filmed(3, 600).places_m
    assert max(places_m[46:]) < 0.25
    assert 1000 * (places_m[500] - places_m[501]) == pytest.approx(sinks_mm, rel=0.5)
    assert 270 <= [line[0] for line in shown("3 --frames=300").lines].index("<") <= 300

def test_5_shows_only_some_of_its_collisions() -> None:
    hidden, collisions = told(5, r"(\d+) of the (\d+) collisions show no 0")
    lines = shown("5").lines
    assert collisions == len(bounces(filmed(5, 236)))
    assert collisions - hidden == sum("0" in line for line in lines)

def test_8_is_so_far_beyond_the_wall_when_its_bounces_are_found() -> None:
    figures_cm = told(8, r"first bounce the car was (\d+) cm .* second it was (\d+) cm beyond")
    found_m = [mark_m for mark_m in filmed(8, 60).marks_m if mark_m is not None]
    assert [25 - 100 * mark_m for mark_m in found_m] == pytest.approx(figures_cm)

def test_22_hops_so_high_because_each_hop_gets_so_much_speed() -> None:
    high_mm, gain_mps = told(22, r"lines that are about (\d+) mm high.*ball gets ([\d.]+) m/s")
    car = filmed(22, 2000)
    assert 1000 * max(car.places_m[1000:]) == pytest.approx(high_mm, abs=5)
    left_mps = car.velocities_mps[bounces(car)[-2]]
    assert hops(car)[-1] / 6 - 2 * left_mps == pytest.approx(gain_mps, abs=0.05)  # w - u

def test_14_gets_out_4_1_m_further_each_time_and_1_2_km_away_in_a_minute() -> None:
    further_m, away_km = told(14, r"it is ([\d.]+) m further out.* it is ([\d.]+) km away")
    places_m = filmed(14, 600).places_m
    assert abs(places_m[102]) - abs(places_m[100]) == pytest.approx(further_m)
    assert abs(places_m[600]) / 1000 == pytest.approx(away_km, abs=0.05)
