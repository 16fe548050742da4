"""The truth (motion=exact, correction=replay) against 60 digits and closed forms."""

import math
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from airtrack import Scene, Track, step, truth_of
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
    part = draw(st.sampled_from([0.0, 1e-9, 1 - 1e-9, 1.0]) | st.floats(0, 1))
    v_mps = draw(st.just(0.0) | st.floats(-3, 3) | st.floats(-30, 30))
    a_mps2 = draw(both_signs) * draw(st.just(0.0) | st.floats(1e-6, 2) | st.floats(2, 30))
    return true_track(left_edge_m=left_m, right_edge_m=left_m + length_m, CR=draw(some_CR),
                      x_m=left_m + part * length_m, v_mps=v_mps, a_mps2=a_mps2)

@given(track=true_tracks(), lengths_s=st.lists(frames_s, min_size=1, max_size=10))
@example(track=true_track(v_mps=5.0, a_mps2=-2.0, CR=1.0), lengths_s=[3600.0, 0.1])
@example(track=true_track(x_m=0.25 + 1e-9, v_mps=1.8, a_mps2=-2.0), lengths_s=[2.5])  # cancels
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

def test_two_thousand_million_hops_in_an_hour_take_no_time_and_are_counted() -> None:
    track = true_track(left_edge_m=0.0, right_edge_m=1.0, x_m=0.0, a_mps2=-1000.0, CR=1)
    rise_mps = 0.0009
    x_m, _, _ = step(track, 0.0, rise_mps, 3600.0)  # hop by hop pytest's timeout would end it
    since_s = 3600 % (2 * Fraction(rise_mps) / 1000)
    height_m = Fraction(rise_mps) * since_s - 1000 * since_s**2 / 2
    assert x_m == pytest.approx(float(height_m), abs=1e-11 * rise_mps)  # 1e-11 s in an hour

@given(drop_m=st.floats(0.1, 10), g_mps2=st.floats(1, 30), up=both_signs,
       CR=st.sampled_from([0.3, 0.5, 0.8, 0.98]))
def test_a_dropped_ball_moves_until_the_Zeno_point_and_lies_still_from_then_on(
        drop_m: float, g_mps2: float, up: int, CR: float) -> None:
    track = true_track(left_edge_m=min(0, 20 * up), right_edge_m=max(0, 20 * up),
                       x_m=up * drop_m, a_mps2=-up * g_mps2, CR=CR)
    fall_s = math.sqrt(2 * drop_m / g_mps2)
    zeno_s = fall_s * (1 + 2 * CR / (1 - CR))  # each hop lasts CR times as long as the one before
    _, v_mps, _ = step(track, track.x_m, 0.0, zeno_s - 0.01)
    assert v_mps != 0
    x_m, v_mps, _ = step(track, track.x_m, 0.0, zeno_s + 1e-9)
    assert (x_m, v_mps) == (0, 0)

@given(drop_m=st.floats(0.1, 10), g_mps2=st.floats(1, 30), up=both_signs)
def test_a_ball_dropped_from_the_ceiling_meets_the_floor_alone(
        drop_m: float, g_mps2: float, up: int) -> None:
    track = true_track(left_edge_m=min(0, drop_m * up), right_edge_m=max(0, drop_m * up),
                       x_m=up * drop_m, a_mps2=-up * g_mps2, CR=1)
    fall_s = math.sqrt(2 * drop_m / g_mps2)
    x_m, v_mps, _ = step(track, track.x_m, 0.0, fall_s / 4)
    for frame in range(1, 41):  # each ends in mid-air
        x_m, v_mps, mark_m = step(track, x_m, v_mps, fall_s / 2)
        assert (mark_m is not None) is (frame % 4 == 2)

@pytest.mark.parametrize(("x_m", "begins_m"), [(0.2, 0.25), (3, 2.2), (1.5, 1.5)])
def test_the_truth_of_any_method_moves_as_60_digits_from_the_wall_if_the_start_is_beyond(
        x_m: float, begins_m: float) -> None:
    scene = Scene(x_m=x_m, v_mps=3, a_mps2=-2, CR=0.5, motion="forward", correction="none")
    truth = truth_of(scene)
    moved_m, _, _ = step(truth, truth.x_m, truth.v_mps, 2.5)
    (true_m, _), = states(replace(scene, x_m=begins_m), [Decimal("2.5")])
    assert moved_m == pytest.approx(float(true_m), abs=1e-9)
