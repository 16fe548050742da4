"""The truth (motion=exact, correction=replay) against a reference of 60 digits."""

import math
import random
from decimal import Decimal
from typing import Any
from unittest.mock import Mock

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import airtrack
from airtrack import Scene, step, truth_of
from films import WORDS
from reference import states


def exact(**settings: Any) -> Scene:
    return Scene(motion="exact", correction="replay", **settings)


def random_scene(rng: random.Random) -> Scene:
    left_m = rng.uniform(-5, 5)
    right_m = left_m + 10 ** rng.uniform(-1, 1)
    return exact(
        left_edge_m=left_m, right_edge_m=right_m,
        x_m=rng.choice([left_m, right_m, rng.uniform(left_m, right_m), (left_m + right_m) / 2]),
        v_mps=rng.choice([0.0, rng.uniform(-3, 3), rng.uniform(-30, 30)]),
        a_mps2=rng.choice([0.0, rng.uniform(-2, 2), rng.uniform(-30, 30)]),
        CR=rng.choice([0.0, 1.0, 0.5, 0.8, rng.uniform(0, 0.95), rng.uniform(0.5, 0.95)]),
        fps_target=10 ** rng.uniform(-0.3, 3))


def largest_error_m(scene: Scene, frame_s: float, frames: int) -> float:
    """The largest distance between step's car and the reference's, at eight moments."""
    every = max(1, frames // 8)
    x_m, v_mps, seen = scene.x_m, scene.v_mps, []
    for frame in range(1, frames + 1):
        x_m, v_mps, _ = step(scene, x_m, v_mps, frame_s)
        if frame % every == 0:
            seen.append((frame, x_m))
    times_s = [frame * Decimal(frame_s) for frame, _ in seen]
    pairs = zip(seen, states(scene, times_s), strict=True)
    return max(abs(float(Decimal(x_m) - true_m)) for (_, x_m), (true_m, _) in pairs)


@pytest.mark.parametrize("seed", range(5))
def test_short_frames_and_one_of_20_s_agree_with_60_digits_in_random_scenes(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(200):
        scene = random_scene(rng)
        frames = max(2, min(100, round(3 * scene.fps_target)))
        assert largest_error_m(scene, 1 / scene.fps_target, frames) < 1e-9, scene
        assert largest_error_m(scene, 20.0, 1) < 1e-9, scene


@st.composite
def any_scene(draw: st.DrawFn) -> Scene:
    """Any scene there can be, but for those with thousands of wall-to-wall flights a frame."""
    left_m = draw(st.floats(-1000, 999.98))
    width_m = draw(st.one_of(st.floats(0.01, 5), st.floats(0.01, 2000)))
    right_m = min(left_m + width_m, 1000.0)
    assume(right_m - left_m >= 0.01)
    inside = st.one_of(st.floats(left_m, right_m), st.sampled_from([left_m, right_m]))
    tiny = st.sampled_from([0.0, 1e-300, -1e-300, 5e-324, 1e-12, -1e-12])
    anything = st.one_of(tiny, st.floats(-10, 10), st.floats(-1000, 1000))
    near_elastic = st.sampled_from([0.0, 1.0, 1 - 1e-12, math.nextafter(1, 0), 5e-324])
    scene = exact(x_m=draw(inside), v_mps=draw(anything), a_mps2=draw(anything),
                  left_edge_m=left_m, right_edge_m=right_m,
                  CR=draw(st.one_of(near_elastic, st.floats(0, 1))),
                  fps_target=draw(st.floats(0.5, 1000)))
    fastest_mps = math.hypot(scene.v_mps, math.sqrt(2 * abs(scene.a_mps2) * (right_m - left_m)))
    assume(fastest_mps / (right_m - left_m) / scene.fps_target < 5000)
    return scene


@given(any_scene())
@settings(max_examples=300)
def test_any_scene_stays_on_the_track_and_gains_no_energy_nor_loses_any_at_CR_1(
        scene: Scene) -> None:
    a_mps2, dt_s = scene.a_mps2, 1 / scene.fps_target
    low_m = scene.right_edge_m if a_mps2 > 0 else scene.left_edge_m

    def energy(x_m: float, v_mps: float) -> float:
        return v_mps * v_mps / 2 + abs(a_mps2) * abs(x_m - low_m)

    x_m, v_mps = scene.x_m, scene.v_mps
    off_by = 1e-10 * (energy(x_m, v_mps) + abs(a_mps2) * (abs(scene.left_edge_m) + abs(low_m)))
    for _ in range(5):
        moved_m, moved_mps = x_m + v_mps * dt_s + a_mps2 * dt_s * dt_s / 2, v_mps + a_mps2 * dt_s
        before = energy(x_m, v_mps)
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        assert scene.left_edge_m <= x_m <= scene.right_edge_m
        after = energy(x_m, v_mps)
        assert after <= before + off_by
        assert scene.CR < 1 or after >= before - off_by
        if mark_m is None:  # no collision: nothing but the move
            assert (x_m, v_mps) == pytest.approx((moved_m, moved_mps), rel=1e-9, abs=1e-9)
        else:
            assert mark_m == pytest.approx(moved_m, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(("changes", "x_m", "v_mps", "dt_s", "found"), [
    # 40 m/s on a 2 m track for 0.1 s: 4 m, over and back again, to the same place and velocity
    ({"left_edge_m": 0, "right_edge_m": 2, "CR": 1}, 1.5, 40.0, 0.1, (1.5, 40.0, 5.5)),
    # it bounced and is back, and its move alone ended on the track, too
    ({"left_edge_m": 0, "right_edge_m": 10, "a_mps2": 2, "CR": 1}, 2.0, -3.0, 3.0, (6.0, 5.0, 2.0)),
    # a turn in mid-track is no collision, and a tiny acceleration no leap
    ({"right_edge_m": 5, "a_mps2": 2}, 2.0, -1.0, 1.0, (2.0, 1.0, None)),
    ({"a_mps2": -1e-300}, 1.0, 0.0, 0.1, (1.0, 0.0, None)),
    # CR = 0 ends a bounce on the wall
    ({"CR": 0}, 0.5, -1.0, 1.0, (0.25, 0.0, -0.5)),
    # the frame's end is the Zeno point
    ({"a_mps2": -2, "CR": 0.5}, 0.25, 1.0, 2.0, (0.25, 0.0, -1.75)),
    # a car that is accelerated into its wall stays there, and one that is accelerated off it leaves
    ({"a_mps2": -3}, 0.25, 0.0, 20.0, (0.25, 0.0, -599.75)),
    ({"a_mps2": 2}, 0.25, 0.0, 0.5, (0.5, 1.0, None))])
def test_frames_worked_out_by_hand(
        changes: dict[str, float], x_m: float, v_mps: float, dt_s: float,
        found: tuple[float, float, float | None]) -> None:
    after_m, after_mps, mark_m = step(exact(**changes), x_m, v_mps, dt_s)
    assert (after_m, after_mps) == pytest.approx(found[:2], abs=1e-12)
    assert mark_m == pytest.approx(found[2], abs=1e-12)


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize(("beyond_m", "misses"), [(4.9e-11, True), (5.1e-11, False)])
def test_a_turn_less_than_5e_11_m_beyond_the_ceiling_is_a_miss(
        beyond_m: float, misses: bool, side: int) -> None:
    walls = {"left_edge_m": min(0, -side), "right_edge_m": max(0, -side)}
    v_mps = -side * math.sqrt(4 * (1 + beyond_m))  # turns beyond_m above 1 m after a second
    _, _, mark_m = step(exact(x_m=0, a_mps2=2 * side, **walls), 0.0, v_mps, 1.1)
    assert (mark_m is None) is misses


def test_hops_until_rest_are_as_many_as_the_listing_tells_and_at_CR_1_none_is_followed(
        monkeypatch: pytest.MonkeyPatch) -> None:
    flights = Mock(side_effect=airtrack.arrival)
    monkeypatch.setattr(airtrack, "arrival", flights)
    told = []
    for CR in (0.8, 0.98):
        flights.reset_mock()
        assert step(exact(left_edge_m=0, a_mps2=-9.8, CR=CR), 2.0, 0.0, 1000.0)[:2] == (0, 0)
        told.append(f"at bounce {flights.call_count} if CR is {CR}")
    assert ("if the first hop lasts 1 s, all of them last 1 + CR + CR^2 + ... seconds, and this "
            "sum is 1/(1 - CR).") in WORDS
    assert f"After a drop from 2 m this is {', and '.join(told)}." in WORDS
    flights.reset_mock()
    step(exact(x_m=0.25, a_mps2=-2, CR=1), 0.25, 1e-3, 20.0)  # 20 000 hops
    assert flights.call_count <= 10


@pytest.mark.parametrize(("x_m", "begins_m"), [(0.2, 0.25), (3, 2.2), (1.5, 1.5)])
def test_the_truth_is_the_scene_with_replay_and_starts_on_the_wall_that_the_start_is_beyond(
        x_m: float, begins_m: float) -> None:
    scene = Scene(x_m=x_m, v_mps=3, a_mps2=-2, CR=0.5, motion="forward", correction="none")
    changes = {"x_m": begins_m, "motion": "exact", "correction": "replay"}
    assert truth_of(scene) == Scene(**vars(scene) | changes)
