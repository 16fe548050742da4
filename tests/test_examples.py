"""The examples: the figures of their texts, beside the films. (The texts round them.)"""

from typing import Any

import pytest

from films import bounces, filmed, furthest_m, hops, shown, tops_m

TRUTH = {"motion": "exact", "correction": "replay"}
CONSERVE = {"motion": "exact", "correction": "conserve"}
Changes = dict[str, Any]

@pytest.mark.parametrize(("words", "frame"), [
    ("1", 251), ("4", 1878), ("5", 236), ("6", 236), ("12", 130), ("12 correction=replay", 124),
    ("19", 136), ("22 motion=backward", 222)])
def test_the_film_stops_in_this_frame(words: str, frame: int) -> None:
    assert len(shown(words).lines) == frame

@pytest.mark.parametrize(("number", "frame", "changes"), [
    (3, 46, {}), (10, 14, {}), (13, 25, {"motion": "exact"}), (17, 14, {}), (21, 14, CONSERVE)])
def test_the_first_bounce_is_in_this_frame(number: int, frame: int, changes: Changes) -> None:
    assert bounces(filmed(number, 100, **changes))[0] == frame

@pytest.mark.parametrize(("number", "turns_m", "changes"), [
    (1, [0.25 + 0.87, 0.25 + 0.46, 0.25 + 0.21], {}), (7, [1.989, 2] * 2, {}),
    (8, [1.88, 2] * 2, {}), (9, [1.81, 1.68, 1.59], {}), (10, [2] * 7, {}), (11, [2] * 7, {}),
    (13, [1.91], {}), (13, [1.79], TRUTH), (17, [2] * 7, CONSERVE)])
def test_on_its_way_to_the_right_it_turns_here(
        number: int, turns_m: list[float], changes: Changes) -> None:
    xs_m = [frame.x_m for frame in filmed(number, 3000, **changes).frames]
    assert tops_m(xs_m)[:len(turns_m)] == pytest.approx(turns_m, abs=0.006)

@pytest.mark.parametrize(("number", "off_m", "frames", "changes"), [
    (12, 0.0042, 130, {}), (13, 0.24, 24, {}), (16, 0.01, 1, {}), (16, 0.02, 2, {}),
    (16, 0.9, 200, {}), (17, 0, 13, {}), (17, 1.8, 200, {}), (18, 0, 2, {}), (18, 0.4, 4, {}),
    (18, 0, 80, TRUTH),
    (21, 0.9, 200, {"motion": "backward", "correction": "rebound"}),
    (21, 1.8, 200, {"correction": "rebound"}), (21, 0.9, 200, CONSERVE), (21, 0, 200, {}),
    (21, 0, 200, TRUTH)])
def test_it_gets_so_far_from_the_truth(
        number: int, off_m: float, frames: int, changes: Changes) -> None:
    found_m = furthest_m(filmed(number, frames, **changes))
    assert found_m == pytest.approx(off_m, rel=0.05, abs=1e-9)

@pytest.mark.parametrize(("number", "first_hops", "changes"), [
    (19, [*range(15, 4, -1)], {}), (19, [*range(18, 26)], {"motion": "exact"}),
    (20, [14, 12, 10, *[9] * 50], {}),
    (22, [46, 39, 34, 30, 27, 25, 23, 21, 19, 18, 17, *[16] * 15], {})])
def test_the_hops_take_so_many_lines(
        number: int, first_hops: list[int], changes: Changes) -> None:
    assert hops(filmed(number, 600, **changes))[:len(first_hops)] == first_hops

@pytest.mark.parametrize(("number", "frames", "g_dt_mps", "changes", "left_at", "came_at"), [
    (19, 90, 0.2, {}, [1.502, 1.498, 1.302, 1.298], [1.498, 1.302, 1.298]),
    (19, 90, 0.2, {"motion": "exact"}, [1.702, 1.898, 1.902], [1.898, 1.902]),
    (20, 1000, 0.2, {}, [0.8], []), (20, 1000, 0.2, {}, [], [1.0]),
    (22, 2000, 1 / 6, {}, [1.185], []), (22, 2000, 1 / 6, {}, [], [1.48])])
def test_a_hop_leaves_and_comes_back_at_these_speeds(
        number: int, frames: int, g_dt_mps: float, changes: Changes, left_at: list[float],
        came_at: list[float]) -> None:
    car = filmed(number, frames, **changes)
    left, came = [], []
    for begins, n in zip(bounces(car), hops(car), strict=False):
        left.append(car.frames[begins].v_mps)
        came.append(n * g_dt_mps - left[-1])
    for told, found in ((left_at, left), (came_at, came)):
        if number == 19:
            assert found[:len(told)] == pytest.approx(told, abs=1e-4)
        elif told:
            assert found[-1] == pytest.approx(told[0], abs=0.006)

def test_0_is_at_the_left_wall_after_45_s_and_flies_until_44_s() -> None:
    frames = filmed(0, 3000).frames
    assert frames[-1].x_m == pytest.approx(0.5, abs=1e-3)
    right_s = [frame.t_s for frame in frames if frame.mark_m is not None and frame.mark_m > 17]
    assert len(right_s) == 3
    flies_s = [frame.t_s for frame in frames if frame.mark_m is None]
    assert flies_s[-1] == pytest.approx(44, abs=0.5)
    line, = shown("0 --frames=1").lines
    assert "v = 16.97" in line  # 17 - 2 * 0.015, and details without d

def test_3_is_caught_sinks_by_1_mm_a_frame_and_gets_out_of_the_picture() -> None:
    xs_m = [frame.x_m for frame in filmed(3, 600).frames]
    assert max(xs_m[46:]) < 0.25
    assert xs_m[500] - xs_m[501] == pytest.approx(0.001, rel=0.5)
    assert 270 <= [line[0] for line in shown("3 --frames=300").lines].index("<") <= 300
