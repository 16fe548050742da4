"""One frame: what a motion does to the energy, what a correction leaves, what a track may be.

Where no square root is taken, the frames are worked out in rational numbers (Fraction), without
round-off.
"""

import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import Scene, Track, step

Rational = Any  # a Fraction: the program takes it for a float, but mypy does not


def rationals(least: float, largest: float) -> st.SearchStrategy[Rational]:
    """Thousandths from least to largest."""
    thousandths = st.integers(round(1000 * least), round(1000 * largest))
    return thousandths.map(lambda number: Fraction(number, 1000))


both_signs = st.sampled_from([-1, 1])
speeds = rationals(-50, 50)
accelerations = st.just(Fraction(0)) | rationals(-50, 50)
lengths_s = rationals(0.001, 4) | rationals(4, 1000)
parts = rationals(0, 1)
LEFT_M: Rational = Fraction(-3, 4)
RIGHT_M: Rational = Fraction(5, 4)
HALF, ONE = Fraction(1, 2), Fraction(1)


@pytest.mark.parametrize(("motion", "gain"), [("forward", 1), ("backward", -1), ("exact", 0)])
@given(x_m=rationals(-100, 100), v_mps=speeds, a_mps2=accelerations, dt_s=rationals(0.001, 1))
def test_a_step_in_flight_adds_or_takes_a2_dt2_halves_or_leaves_the_energy(
        motion: str, gain: int, x_m: Rational, v_mps: Rational, a_mps2: Rational,
        dt_s: Rational) -> None:
    track = Track(motion=motion, a_mps2=a_mps2, left_edge_m=-1000, right_edge_m=1000)
    after_m, after_mps, mark_m = step(track, x_m, v_mps, dt_s)
    assert mark_m is None
    assert after_mps - v_mps == a_mps2 * dt_s
    change = track.energy(after_m, after_mps) - track.energy(x_m, v_mps)
    assert change == gain * (a_mps2 * dt_s)**2 / 2
    if a_mps2 == 0:
        assert after_m - x_m == v_mps * dt_s


@pytest.mark.parametrize(("a_mps2", "floor_m"), [(-3, 0.5), (3, 2.5)])
def test_the_energy_is_0_on_the_floor_and_g_h_above_it(a_mps2: float, floor_m: float) -> None:
    track = Track(a_mps2=a_mps2, left_edge_m=0.5, right_edge_m=2.5)
    assert track.energy(floor_m, 0.0) == 0
    assert track.energy(1.5, 0.0) == 3 * 1


@given(part=parts, v_mps=speeds, a_mps2=accelerations, dt_s=lengths_s, CR=parts)
@example(part=HALF, v_mps=ONE, a_mps2=0 * ONE, dt_s=ONE, CR=ONE)  # it ends on the right wall
@example(part=HALF, v_mps=-ONE, a_mps2=0 * ONE, dt_s=ONE, CR=ONE)
def test_surface_none_and_rebound_put_a_car_on_the_wall_leave_it_and_mirror_it(
        part: Rational, v_mps: Rational, a_mps2: Rational, dt_s: Rational, CR: Rational) -> None:
    x_m = LEFT_M + part * (RIGHT_M - LEFT_M)
    moved_m = x_m + (2 * v_mps + a_mps2 * dt_s) / 2 * dt_s  # at its mean velocity
    for correction, times_depth in (("surface", 0), ("none", 1), ("rebound", -CR)):
        track = Track(motion="exact", correction=correction, a_mps2=a_mps2, CR=CR,
                      left_edge_m=LEFT_M, right_edge_m=RIGHT_M)
        after_m, after_mps, mark_m = step(track, x_m, v_mps, dt_s)
        if LEFT_M <= moved_m <= RIGHT_M:
            assert (after_m, mark_m) == (moved_m, None)
            continue
        wall_m = LEFT_M if moved_m < LEFT_M else RIGHT_M
        assert mark_m == moved_m
        assert after_m == wall_m + times_depth * (moved_m - wall_m)
        assert after_mps == -CR * (v_mps + a_mps2 * dt_s)


@given(part=parts, v_mps=speeds, a_mps2=accelerations, dt_s=lengths_s, CR=parts)
def test_conserve_leaves_the_car_on_the_wall_with_CR_squared_of_its_energy_however_far_it_moved(
        part: Rational, v_mps: Rational, a_mps2: Rational, dt_s: Rational, CR: Rational) -> None:
    track = Track(motion="exact", correction="conserve", a_mps2=a_mps2, CR=CR,
                  left_edge_m=LEFT_M, right_edge_m=RIGHT_M)
    x_m = LEFT_M + part * (RIGHT_M - LEFT_M)
    after_m, after_mps, mark_m = step(track, x_m, v_mps, dt_s)
    assume(mark_m is not None)
    wall_m = RIGHT_M if mark_m > x_m else LEFT_M
    energy_there = v_mps**2 / 2 - a_mps2 * (x_m - wall_m)
    assert after_m == wall_m
    assert after_mps**2 / 2 == pytest.approx(float(CR**2 * energy_there), rel=1e-12)
    assert after_mps * (mark_m - wall_m) <= 0  # back to the track


# A car meets a wall, at 0, with the speed w into it, after a time and before another one. g is
# its acceleration into the wall. So a time t later it is CR w t - g t^2/2 in front of the wall.

@given(side=both_signs, w_mps=rationals(0.01, 20), g_mps2=accelerations,
       before_s=rationals(0.001, 2), after_s=rationals(0.001, 2), CR=parts)
@example(side=1, w_mps=20 * ONE, g_mps2=ONE / 10**9, before_s=ONE, after_s=ONE, CR=ONE)
@example(side=-1, w_mps=ONE, g_mps2=-ONE, before_s=ONE, after_s=ONE * 199 / 100, CR=ONE)
def test_rewind_is_right_after_one_bounce_and_on_the_wall_if_there_was_a_second_one(
        side: int, w_mps: Rational, g_mps2: Rational, before_s: Rational, after_s: Rational,
        CR: Rational) -> None:
    start_m = -w_mps * before_s + g_mps2 * before_s**2 / 2
    moved_m = w_mps * after_s + g_mps2 * after_s**2 / 2
    assume(-1000 < start_m <= 0 < moved_m)
    height_m = CR * w_mps * after_s - g_mps2 * after_s**2 / 2
    assume(height_m < 1000)
    track = Track(motion="exact", correction="rewind", CR=CR, a_mps2=side * g_mps2, x_m=0,
                  left_edge_m=min(0, -1000 * side), right_edge_m=max(0, -1000 * side))
    start_mps = side * (w_mps - g_mps2 * before_s)
    x_m, v_mps, mark_m = step(track, side * start_m, start_mps, before_s + after_s)
    assert mark_m == side * moved_m
    if height_m > 0:
        assert -side * x_m == pytest.approx(float(height_m), abs=1e-9)
        assert -side * v_mps == pytest.approx(float(CR * w_mps - g_mps2 * after_s), abs=1e-9)
    else:
        assert -side * x_m == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(("motion", "correction"), [
    ("forward", "conserve"), ("backward", "conserve"), ("exact", "conserve"), ("exact", "rewind")])
@given(part=st.floats(0, 1), v_mps=st.floats(-1000, 1000), length_m=st.floats(0.01, 1000),
       a_mps2=st.just(0.0) | st.floats(-10, 10) | st.floats(-1000, 1000), CR=st.floats(0, 1),
       dt_s=st.floats(0.001, 10))
@settings(max_examples=200)
def test_conserve_and_rewind_find_a_place_and_a_speed_in_any_scene_and_conserve_on_the_track(
        motion: str, correction: str, part: float, v_mps: float, length_m: float, a_mps2: float,
        CR: float, dt_s: float) -> None:
    track = Track(motion=motion, correction=correction, a_mps2=a_mps2, CR=CR, left_edge_m=0.0,
                  right_edge_m=length_m, x_m=0.0)
    x_m = part * length_m
    for _ in range(20):
        x_m, v_mps, _ = step(track, x_m, v_mps, dt_s)
        assert math.isfinite(x_m)  # a complex number is a TypeError here
        assert math.isfinite(v_mps)
        assert correction == "rewind" or 0 <= x_m <= length_m


# What a track may be.

@pytest.mark.parametrize(("name", "least", "largest"), [
    ("x_m", -1000, 1000), ("v_mps", -1000, 1000), ("a_mps2", -1000, 1000), ("CR", 0, 1),
    ("fps_target", 0.1, 1000), ("jitter", 0, 0.9), ("m_to_px", 0.001, 1000),
    ("width_px", 10, 1000)])
def test_a_number_out_of_range_is_refused_with_name_value_and_range(
        name: str, least: Any, largest: Any) -> None:
    for allowed in (least, largest):
        Scene(**{name: allowed})
    for wrong in (least - 0.001, largest + 0.001, math.nan):
        refusal_tells({name: wrong}, name, str(wrong), str(least), str(largest))


@pytest.mark.parametrize(("changes", "told"), [
    ({"motion": "euler"}, "motion euler forward backward exact"),
    ({"correction": "bounce"}, "correction bounce none surface rebound conserve rewind replay"),
    ({"auto_off": "no"}, "auto_off no True False"),
    ({"left_edge_m": -1001}, "left_edge_m -1001 -1000 1000"),
    ({"right_edge_m": 1001}, "right_edge_m 1001 -1000 1000"),
    ({"left_edge_m": 1.5, "right_edge_m": 1.509}, "right_edge_m 1.509 1.51"),
    ({"correction": "rewind", "motion": "backward"}, "correction rewind backward motion=exact"),
    ({"correction": "replay", "motion": "exact", "x_m": 0.2}, "x_m 0.2 0.25 2.2"),
    ({"correction": "rewind", "motion": "exact", "x_m": 2.3}, "x_m 2.3 0.25 2.2")])
def test_a_wrong_choice_and_a_conflict_are_refused_with_what_is_allowed(
        changes: dict[str, Any], told: str) -> None:
    refusal_tells(changes, *told.split())


def refusal_tells(changes: dict[str, Any], *words: str) -> None:
    with pytest.raises(ValueError, match=words[0]) as refused:
        Scene(**changes)
    assert all(word in str(refused.value) for word in words)


def test_every_track_of_one_centimetre_can_be_made() -> None:
    for left_cm in range(-300, 300):
        Track(left_edge_m=left_cm / 100, right_edge_m=(left_cm + 1) / 100)
