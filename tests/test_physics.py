"""One frame: what a motion does to the energy, what a correction leaves, what a track may be.

Most frames are worked out in rational numbers (Fraction), so without round-off.
"""

import math
from fractions import Fraction

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import Track, scene_of, step
from reference import Rational, rationals

ONE = Fraction(1)
speeds = rationals(-50, 50)
accelerations = st.just(0 * ONE) | rationals(-50, 50)
parts = rationals(0, 1)

@pytest.mark.parametrize(("motion", "gain"), [("forward", 1), ("backward", -1), ("exact", 0)])
@given(x_m=rationals(-100, 100), v_mps=speeds, a_mps2=accelerations, dt_s=rationals(0.001, 1))
def test_a_step_adds_or_takes_a2_dt2_halves_or_leaves_the_energy_which_is_0_on_the_floor(
        motion: str, gain: int, x_m: Rational, v_mps: Rational, a_mps2: Rational,
        dt_s: Rational) -> None:
    track = Track(motion=motion, a_mps2=a_mps2, left_edge_m=-1000, right_edge_m=1000)
    after_m, after_mps, mark_m = step(track, x_m, v_mps, dt_s)
    assert mark_m is None
    assert after_mps - v_mps == a_mps2 * dt_s
    change = track.energy(after_m, after_mps) - track.energy(x_m, v_mps)
    assert change == gain * (a_mps2 * dt_s)**2 / 2
    floor_m = 1000 if a_mps2 > 0 else -1000
    assert track.energy(floor_m, 0) == 0

@given(part=parts, v_mps=speeds, a_mps2=accelerations, CR=parts,
       dt_s=rationals(0.001, 4) | rationals(4, 1000))
@example(part=ONE / 2, v_mps=10 * ONE, a_mps2=-8 * ONE, CR=ONE / 2, dt_s=2 * ONE)  # has turned
def test_however_far_a_move_goes_each_correction_leaves_the_place_and_speed_that_it_promises(
        part: Rational, v_mps: Rational, a_mps2: Rational, CR: Rational, dt_s: Rational) -> None:
    left_m: Rational = -3 * ONE / 4
    right_m: Rational = 5 * ONE / 4
    x_m = left_m + part * (right_m - left_m)
    moved_m = x_m + (2 * v_mps + a_mps2 * dt_s) / 2 * dt_s  # at its mean velocity
    assume(moved_m < left_m or moved_m > right_m)
    wall_m = left_m if moved_m < left_m else right_m
    depth_m = moved_m - wall_m
    met_squared = v_mps**2 + 2 * a_mps2 * (wall_m - x_m)  # of the speed at the wall: energy
    for correction, stays_m in (
            ("none", depth_m), ("surface", 0), ("rebound", -CR * depth_m), ("conserve", 0)):
        track = Track(motion="exact", correction=correction, a_mps2=a_mps2, CR=CR,
                      left_edge_m=left_m, right_edge_m=right_m)
        after_m, after_mps, mark_m = step(track, x_m, v_mps, dt_s)
        assert mark_m == moved_m
        assert after_m == wall_m + stays_m
        if correction == "conserve":
            assert after_mps**2 == pytest.approx(float(CR**2 * met_squared), rel=1e-12)
            assert after_mps * depth_m <= 0  # out of the wall
        else:
            assert after_mps == -CR * (v_mps + a_mps2 * dt_s)

# A car meets a wall, at 0, with the speed w into it, after a time and before another one. g is
# its acceleration into the wall. So a time t later it is CR w t - g t^2/2 in front of the wall.

@given(side=st.sampled_from([-1, 1]), w_mps=rationals(0.01, 20), g_mps2=accelerations,
       before_s=rationals(0.001, 2), after_s=rationals(0.001, 2), CR=parts)
@example(side=1, w_mps=20 * ONE, g_mps2=ONE / 10**9, before_s=ONE, after_s=ONE, CR=ONE)
@example(side=-1, w_mps=ONE, g_mps2=-ONE, before_s=ONE, after_s=ONE * 199 / 100, CR=ONE)
def test_rewind_is_right_after_one_bounce_and_on_the_wall_if_there_was_a_second_one(
        side: int, w_mps: Rational, g_mps2: Rational, before_s: Rational, after_s: Rational,
        CR: Rational) -> None:
    start_m = -w_mps * before_s + g_mps2 * before_s**2 / 2
    start_mps = w_mps - g_mps2 * before_s
    moved_m = w_mps * after_s + g_mps2 * after_s**2 / 2
    height_m = CR * w_mps * after_s - g_mps2 * after_s**2 / 2
    assume(start_m <= 0 < moved_m and max(-start_m, height_m) < 1000)
    track = Track(motion="exact", correction="rewind", CR=CR, a_mps2=side * g_mps2, x_m=0,
                  left_edge_m=min(0, -1000 * side), right_edge_m=max(0, -1000 * side))
    x_m, v_mps, mark_m = step(track, side * start_m, side * start_mps, before_s + after_s)
    assert mark_m == side * moved_m
    assert -side * x_m == pytest.approx(max(0.0, float(height_m)), abs=1e-9)
    if height_m > 0:
        assert -side * v_mps == pytest.approx(float(CR * w_mps - g_mps2 * after_s), abs=1e-9)

tiny = st.sampled_from([0.0, 1e-300, -1e-300, 5e-324, 1e-12, -1e-12])
anything = tiny | st.floats(-10, 10) | st.floats(-1000, 1000)

@pytest.mark.parametrize(("motion", "correction"), [
    ("forward", "conserve"), ("backward", "conserve"), ("exact", "conserve"), ("exact", "rewind"),
    ("exact", "replay")])
@given(left_m=st.floats(-5, 5), length_m=st.floats(0.01, 5) | st.floats(0.01, 900),
       part=st.floats(0, 1), v_mps=anything, a_mps2=anything, dt_s=st.floats(0.001, 10),
       CR=st.sampled_from([0.0, 5e-324, 0.999, 1.0]) | st.floats(0, 0.99))
@settings(max_examples=200)
def test_in_any_scene_the_three_find_numbers_and_conserve_and_replay_stay_on_the_track(
        motion: str, correction: str, left_m: float, length_m: float, part: float, v_mps: float,
        a_mps2: float, dt_s: float, CR: float) -> None:
    fastest_mps = math.hypot(v_mps, math.sqrt(2 * abs(a_mps2) * length_m))
    assume(fastest_mps * dt_s / length_m < 5000)  # flights in a frame
    track = Track(motion=motion, correction=correction, a_mps2=a_mps2, CR=CR, x_m=left_m,
                  left_edge_m=left_m, right_edge_m=left_m + length_m)
    off_by = 1e-12 * (fastest_mps + abs(a_mps2) * dt_s)**2
    off_by += 5e-11 * abs(a_mps2) * length_m  # replay takes a hop under half of this for rest
    x_m = left_m + part * length_m
    for _ in range(5):
        free_m = x_m + (v_mps + a_mps2 * dt_s / 2) * dt_s
        before = track.energy(x_m, v_mps)
        x_m, v_mps, mark_m = step(track, x_m, v_mps, dt_s)
        assert math.isfinite(x_m)  # a complex number is a TypeError here
        assert math.isfinite(v_mps)
        assert correction == "rewind" or left_m <= x_m <= left_m + length_m
        if motion != "forward" and correction != "rewind":
            assert track.energy(x_m, v_mps) <= before + off_by
        if motion == "exact" and correction != "rewind":
            assert CR < 1 or track.energy(x_m, v_mps) >= before - off_by
            moved_m = x_m if mark_m is None else mark_m
            assert moved_m == pytest.approx(free_m, rel=1e-9, abs=1e-9)

def test_every_track_of_one_centimetre_can_be_made() -> None:
    for left_cm in range(-300, 300):
        scene_of({"left_edge_m": left_cm / 100, "right_edge_m": (left_cm + 1) / 100})
