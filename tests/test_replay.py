"""The truth (motion=exact, correction=replay) against 60 digits and closed forms."""

import math
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import Track, step, truth_of
from reference import states


def true_track(**settings: Any) -> Track:
    return Track(motion="exact", correction="replay", **settings)


both_signs = st.sampled_from([-1, 1])
some_CR = st.sampled_from([0.0, 0.5, 0.8, 0.98, 1.0]) | st.floats(0, 0.95)
frames_s = st.floats(1e-3, 0.5) | st.floats(0.5, 5)


@st.composite
def true_tracks(draw: st.DrawFn) -> Track:
    """Scenes for which the reference needs no more than some thousand bounces."""
    left_m = draw(st.floats(-5, 5))
    length_m = draw(st.floats(0.1, 10))
    part = draw(st.sampled_from([0.0, 1e-7, 1 - 1e-7, 1.0]) | st.floats(0, 1))
    v_mps = draw(st.just(0.0) | st.floats(-3, 3) | st.floats(-30, 30))
    a_mps2 = draw(both_signs) * draw(st.just(0.0) | st.floats(1e-6, 2) | st.floats(2, 30))
    return true_track(left_edge_m=left_m, right_edge_m=left_m + length_m, CR=draw(some_CR),
                      x_m=left_m + part * length_m, v_mps=v_mps, a_mps2=a_mps2)


@given(track=true_tracks(), lengths_s=st.lists(frames_s, min_size=1, max_size=10))
@example(track=true_track(v_mps=5.0, a_mps2=-2.0, CR=1.0), lengths_s=[3600.0, 0.1])
@settings(max_examples=300)
def test_frames_of_any_length_and_one_as_long_as_all_agree_with_60_digits(
        track: Track, lengths_s: list[float]) -> None:
    x_m, v_mps = track.x_m, track.v_mps
    ended_s, now_s = [], Decimal(0)
    for length_s in lengths_s:
        now_s += Decimal(length_s)
        ended_s.append(now_s)
    for length_s, (true_m, _) in zip(lengths_s, states(track, ended_s), strict=True):
        x_m, v_mps, _ = step(track, x_m, v_mps, length_s)
        assert x_m == pytest.approx(float(true_m), abs=1e-9)
    at_once_m, _, _ = step(track, track.x_m, track.v_mps, float(now_s))
    assert at_once_m == pytest.approx(float(true_m), abs=1e-9)


# Without a loss the hops repeat, so rational numbers tell where the ball is. If step followed each
# of the thousand million hops of the first scene, pytest's timeout would end this test.

@pytest.mark.parametrize(("g_mps2", "rise_mps", "up", "t_s"), [
    (1000.0, 1e-3, 1, 3600.0), (9.81, 7.5, -1, 3333.3), (0.7, 0.1, 1, 3599.9), (2.0, 3.0, -1, 0.1)])
def test_at_CR_1_a_ball_hops_alike_for_an_hour(
        g_mps2: float, rise_mps: float, up: int, t_s: float) -> None:
    track = true_track(left_edge_m=min(0, 100 * up), right_edge_m=max(0, 100 * up), x_m=0.0,
                       a_mps2=-up * g_mps2, CR=1)
    x_m, _, _ = step(track, 0.0, up * rise_mps, t_s)
    g, u = Fraction(g_mps2), Fraction(rise_mps)
    since_s = Fraction(t_s) % (2 * u / g)
    height_m = u * since_s - g * since_s**2 / 2
    assert up * x_m == pytest.approx(float(height_m), abs=1e-11 * rise_mps)  # 1e-11 s in an hour


@given(drop_m=st.floats(0.1, 10), g_mps2=st.floats(1, 30), up=both_signs,
       CR=st.sampled_from([0.3, 0.5, 0.8, 0.98]))
def test_a_dropped_ball_moves_until_the_Zeno_point_and_lies_still_from_then_on(
        drop_m: float, g_mps2: float, up: int, CR: float) -> None:
    track = true_track(left_edge_m=min(0, 20 * up), right_edge_m=max(0, 20 * up),
                       x_m=up * drop_m, a_mps2=-up * g_mps2, CR=CR)
    fall_s = math.sqrt(2 * drop_m / g_mps2)
    zeno_s = fall_s * (1 + 2 * CR / (1 - CR))  # each hop lasts CR times as long as the one before
    _, v_mps, _ = step(track, track.x_m, 0.0, zeno_s - 0.002)
    assert v_mps != 0
    x_m, v_mps, _ = step(track, track.x_m, 0.0, zeno_s + 1e-9)
    assert (x_m, v_mps) == (0, 0)


@given(drop_m=st.floats(0.1, 10), g_mps2=st.floats(1, 30), up=both_signs)
def test_a_ball_dropped_from_the_ceiling_meets_the_floor_alone(
        drop_m: float, g_mps2: float, up: int) -> None:
    track = true_track(left_edge_m=min(0, drop_m * up), right_edge_m=max(0, drop_m * up),
                       x_m=up * drop_m, a_mps2=-up * g_mps2, CR=1)
    fall_s = math.sqrt(2 * drop_m / g_mps2)
    x_m, v_mps = track.x_m, 0.0
    for quarter in range(40):  # of its way down and up: it ends in mid-air
        x_m, v_mps, mark_m = step(track, x_m, v_mps, fall_s / 4 if quarter == 0 else fall_s / 2)
        assert (mark_m is not None) is (quarter % 4 == 2)


@st.composite
def any_true_track(draw: st.DrawFn) -> Track:
    """Any scene there can be."""
    left_m = draw(st.floats(-1000, 999.98))
    right_m = min(left_m + draw(st.floats(0.01, 5) | st.floats(0.01, 2000)), 1000.0)
    assume(right_m - left_m >= 0.01)
    tiny = st.sampled_from([0.0, 1e-300, -1e-300, 5e-324, 1e-12, -1e-12])
    anything = tiny | st.floats(-10, 10) | st.floats(-1000, 1000)
    near_elastic = st.sampled_from([0.0, 1.0, 1 - 1e-12, math.nextafter(1, 0), 5e-324])
    return true_track(
        left_edge_m=left_m, right_edge_m=right_m, CR=draw(near_elastic | st.floats(0, 1)),
        x_m=draw(st.sampled_from([left_m, right_m]) | st.floats(left_m, right_m)),
        v_mps=draw(anything), a_mps2=draw(anything))


@given(track=any_true_track(), dt_s=st.floats(1e-3, 2))
@settings(max_examples=300)
def test_in_any_scene_it_stays_on_the_track_gains_no_energy_and_moves_freely_where_no_0_is_drawn(
        track: Track, dt_s: float) -> None:
    length_m = track.right_edge_m - track.left_edge_m
    fastest_mps = math.hypot(track.v_mps, math.sqrt(2 * abs(track.a_mps2) * length_m))
    assume(fastest_mps * dt_s / length_m < 5000)  # flights in a frame
    size_m = abs(track.left_edge_m) + abs(track.right_edge_m)
    off_by = 1e-10 * (fastest_mps**2 + abs(track.a_mps2) * size_m)
    x_m, v_mps = track.x_m, track.v_mps
    for _ in range(5):
        before = track.energy(x_m, v_mps)
        moved_m = x_m + v_mps * dt_s + track.a_mps2 * dt_s**2 / 2
        x_m, v_mps, mark_m = step(track, x_m, v_mps, dt_s)
        assert track.left_edge_m <= x_m <= track.right_edge_m
        after = track.energy(x_m, v_mps)
        assert after <= before + off_by
        assert track.CR < 1 or after >= before - off_by
        if mark_m is None:
            assert x_m == pytest.approx(moved_m, rel=1e-9, abs=1e-9)
        else:
            assert mark_m == pytest.approx(moved_m, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("x_m", "begins_m"), [(0.2, 0.25), (3, 2.2), (1.5, 1.5)])
def test_the_truth_of_any_method_moves_as_60_digits_from_the_wall_if_the_start_is_beyond(
        x_m: float, begins_m: float) -> None:
    track = Track(x_m=x_m, v_mps=3, a_mps2=-2, CR=0.5, motion="forward", correction="none")
    truth = truth_of(track)
    moved_m, _, _ = step(truth, truth.x_m, truth.v_mps, 0.5)
    (true_m, _), = states(replace(track, x_m=begins_m), [Decimal("0.5")])
    assert moved_m == pytest.approx(float(true_m), abs=1e-9)
