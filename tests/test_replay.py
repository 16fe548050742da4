"""The exact engine (motion=exact, correction=replay) against an independent reference."""

import math
import random
from decimal import Decimal, localcontext
from unittest.mock import Mock

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import airtrack
from airtrack import Scene, step
from reference import states


def exact(**settings: float) -> Scene:
    return Scene(motion="exact", correction="replay", **settings)  # type: ignore[arg-type]


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


def largest_error_m(scene: Scene, frame_s: float, frames: int, samples: int = 8) -> float:
    """The largest distance between step's car and the reference's."""
    every = max(1, frames // samples)
    x_m, v_mps, seen = scene.x_m, scene.v_mps, []
    for frame in range(1, frames + 1):
        x_m, v_mps, _ = step(scene, x_m, v_mps, frame_s)
        if frame % every == 0:
            seen.append((frame, x_m))
    times_s = [frame * Decimal(frame_s) for frame, _ in seen]
    pairs = zip(seen, states(scene, times_s), strict=True)
    return max(abs(float(Decimal(x_m) - true_m)) for (_, x_m), (true_m, _) in pairs)


@pytest.mark.parametrize("seed", range(10))
def test_agrees_with_the_decimal_reference_in_random_scenes_at_random_frame_rates(
        seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(300):
        scene = random_scene(rng)
        frames = max(2, min(200, round(3 * scene.fps_target)))
        error_m = largest_error_m(scene, 1 / scene.fps_target, frames)
        assert error_m < 1e-9, scene


def test_one_frame_of_20_s_ends_where_200_frames_of_a_tenth_do() -> None:
    rng = random.Random("long frames")
    for _ in range(300):
        scene = random_scene(rng)
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


def energy(scene: Scene, x_m: float, v_mps: float) -> float:
    """Per kilogram, from the wall to which a points: never negative on the track."""
    low_m = scene.right_edge_m if scene.a_mps2 > 0 else scene.left_edge_m
    return v_mps * v_mps / 2 + abs(scene.a_mps2) * abs(x_m - low_m)


@given(any_scene())
@settings(max_examples=1000)
def test_stays_finite_and_on_the_track_and_gains_no_energy_in_any_scene_nor_loses_any_at_CR_1(
        scene: Scene) -> None:
    x_m, v_mps = scene.x_m, scene.v_mps
    before = energy(scene, x_m, v_mps)
    scale = before + abs(scene.a_mps2) * (abs(scene.left_edge_m) + abs(scene.right_edge_m))
    for _ in range(5):
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / scene.fps_target)
        assert math.isfinite(x_m)
        assert math.isfinite(v_mps)
        assert mark_m is None or math.isfinite(mark_m)
        assert scene.left_edge_m <= x_m <= scene.right_edge_m
        after = energy(scene, x_m, v_mps)
        assert after <= before + 1e-10 * scale
        assert scene.CR < 1 or after >= before - 1e-10 * scale
        before = after


@pytest.mark.parametrize(("changes", "x_m", "v_mps", "dt_s", "found"), [
    # 40 m/s on a 2 m track for 0.1 s: 4 m, over and back again, to the same place and velocity
    ({"left_edge_m": 0, "right_edge_m": 2, "CR": 1}, 1.5, 40.0, 0.1, (1.5, 40.0, 5.5)),
    ({"a_mps2": -2}, 1.0, -1.0, 0.1, (0.89, -1.2, None)),
    # a turn in mid-track is no collision, and a tiny acceleration no leap
    ({"right_edge_m": 5, "a_mps2": 2}, 2.0, -1.0, 1.0, (2.0, 1.0, None)),
    ({"a_mps2": 5e-324}, 1.0, 0.0, 0.1, (1.0, 0.0, None)),
    ({"a_mps2": -1e-300}, 1.0, 0.0, 0.1, (1.0, 0.0, None)),
    # it bounced and is back, and its move alone ended on the track, too
    ({"left_edge_m": 0, "right_edge_m": 10, "a_mps2": 2, "CR": 1}, 2.0, -3.0, 3.0, (6.0, 5.0, 2.0)),
    # CR = 0 ends a bounce on the wall
    ({"a_mps2": -1, "CR": 0}, 0.5, -1.0, 1.0, (0.25, 0.0, -1.0)),
    ({"CR": 0}, 0.5, -1.0, 1.0, (0.25, 0.0, -0.5)),
    ({"CR": 0}, 2.0, 1.0, 1.0, (2.2, 0.0, 3.0)),
    # the frame's end is the Zeno point
    ({"a_mps2": -2, "CR": 0.5}, 0.25, 1.0, 2.0, (0.25, 0.0, -1.75)),
    # a car that is accelerated into its wall stays there, and one that is accelerated off it leaves
    ({"a_mps2": -3}, 0.25, 0.0, 0.001, (0.25, 0.0, 0.25 - 1.5e-6)),
    ({"a_mps2": -3}, 0.25, 0.0, 20.0, (0.25, 0.0, -599.75)),
    ({"a_mps2": 2}, 0.25, 0.0, 0.5, (0.5, 1.0, None)),
    # a start beyond a wall is taken for one at it
    ({"a_mps2": 2}, 0.2, 0.0, 0.1, (0.26, 0.2, None))])
def test_frames_worked_out_by_hand(
        changes: dict[str, float], x_m: float, v_mps: float, dt_s: float,
        found: tuple[float, float, float | None]) -> None:
    after_m, after_mps, mark_m = step(exact(**changes), x_m, v_mps, dt_s)
    assert (after_m, after_mps) == pytest.approx(found[:2], abs=1e-12)
    assert mark_m == pytest.approx(found[2], abs=1e-12)


@pytest.mark.parametrize("fps", [0.5, 1, 3.3, 10, 30, 97, 240, 999, 1000])
@pytest.mark.parametrize(("left_m", "right_m", "within_m"), [
    (0.25, 2.2, 1e-9), (999, 1000, 1e-7)])  # at 1000 m a position's last digit is worth 1e-13 m
def test_a_graze_is_a_miss_and_20_s_of_them_keep_time(
        left_m: float, right_m: float, within_m: float, fps: float) -> None:
    # Elastic, from rest on the right wall: it comes back to that wall with no speed, every time.
    scene = exact(left_edge_m=left_m, right_edge_m=right_m, x_m=right_m, a_mps2=-2, CR=1)
    fall_s = math.sqrt(right_m - left_m)
    x_m, v_mps = float(right_m), 0.0
    for frame in range(1, round(20 * fps) + 1):
        x_m, v_mps, _ = step(scene, x_m, v_mps, 1 / fps)
        since_top_s = math.remainder(frame / fps, 2 * fall_s)
        assert x_m == pytest.approx(right_m - since_top_s**2, abs=within_m)
        assert left_m <= x_m <= right_m


@pytest.mark.parametrize("beyond_m", [1e-10, 1e-9, 1e-8])
def test_a_car_that_overshoots_by_more_than_round_off_hits(beyond_m: float) -> None:
    # It would turn beyond_m behind the right wall; after a hit it is back sooner than after a miss
    # by 2 s/|a|, s = sqrt(2 |a| beyond_m), and 2 m/s fast: at 1e-10 m that makes 4e-5 m.
    scene = exact(x_m=1.0, v_mps=math.sqrt(4 * (1.2 + beyond_m)), a_mps2=-2, CR=1)
    x_m, _, _ = step(scene, 1.0, scene.v_mps, 2.0)
    (true_m, _), = states(scene, [Decimal(2)])
    assert x_m == pytest.approx(float(true_m), abs=1e-7)


@pytest.mark.parametrize("v_mps", [1e-300, 1e-100, 1e-20])
def test_a_hop_too_short_to_count_is_rest_whatever_CR(v_mps: float) -> None:
    for CR in (0.0, 0.5, 1 - 1e-12, 1.0):
        scene = exact(x_m=0.25, v_mps=v_mps, a_mps2=-2, CR=CR)
        assert step(scene, 0.25, v_mps, 2.0)[:2] == (0.25, 0.0)


@pytest.mark.parametrize("CR", [0.9999, 1 - 1e-7 / 3, 1 - 1e-12, math.nextafter(1, 0), 1.0])
@pytest.mark.parametrize("count", [1, 2, 7, 8, 999])
def test_whole_hops_last_as_long_as_the_geometric_series_in_50_digits(
        CR: float, count: int) -> None:
    v_mps = 1e-3
    scene = exact(x_m=0.25, v_mps=v_mps, a_mps2=-2, CR=CR)
    with localcontext(prec=50):
        ratio, hop_s = Decimal(CR), Decimal(v_mps)  # a hop lasts 2 v/a = v at 2 m/s^2
        power = ratio**count
        hops_s = sum(hop_s * ratio**number for number in range(count))
        to_the_next_top_s = hops_s + hop_s * power / 2
        top_m = float((hop_s * power) ** 2 / 4)
    x_m, v_mps, _ = step(scene, 0.25, v_mps, float(to_the_next_top_s))
    assert v_mps == pytest.approx(0, abs=1e-12)
    assert x_m - 0.25 == pytest.approx(top_m, abs=1e-15)


@pytest.mark.parametrize(("CR", "most"), [(0.3, 40), (0.8, 120), (0.95, 500), (1.0, 10)])
@pytest.mark.parametrize("v_mps", [1e-9, 1e-6, 1e-3, 1.0])  # 1 nm/s: two thousand million hops
def test_infinitely_many_hops_take_a_few_hundred_turns_of_the_loop_and_whole_hops_at_CR_1_none(
        CR: float, most: int, v_mps: float, monkeypatch: pytest.MonkeyPatch) -> None:
    spy = Mock(side_effect=airtrack.arrival)
    monkeypatch.setattr(airtrack, "arrival", spy)
    step(exact(x_m=0.25, v_mps=v_mps, a_mps2=-2, CR=CR), 0.25, v_mps, 20.0)
    assert 0 < spy.call_count <= most
