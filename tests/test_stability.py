"""Where each method may be used: a test, or two, for each way in which a method fails.

Each states the law first, from the algebra of a frame, and then checks it over a range of scenes.
E is the energy v^2/2 - a x; a wall's side is -1 (left) or +1 (right); towards it means outwards.
"""

import math
import random
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import Scene, step
from films import lines_between_bounces

speeds = st.floats(-50, 50)
pulls = st.floats(-50, 50)
frame_lengths_s = st.floats(1e-3, 1.0)
sides = st.sampled_from([-1, 1])
WIDE: dict[str, Any] = {"left_edge_m": -1000, "right_edge_m": 1000}


# 1. Energy. A step of forward Euler changes E by
#        (v + a dt)^2/2 - a (x + v dt) - v^2/2 + a x = +a^2 dt^2/2,
#    a step of backward Euler by
#        (v + a dt)^2/2 - a (x + (v + a dt) dt) - v^2/2 + a x = -a^2 dt^2/2,
#    and an exact step leaves it alone. Forward Euler's car gets ever faster.

@pytest.mark.parametrize(("motion", "sign"), [("forward", 1), ("backward", -1), ("exact", 0)])
@given(x_m=st.floats(-100, 100), v_mps=speeds, a_mps2=pulls, dt_s=frame_lengths_s)
def test_each_step_changes_the_energy_by_the_law_of_its_method(
        motion: str, sign: int, x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> None:
    scene = Scene(motion=motion, a_mps2=a_mps2, **WIDE)
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, dt_s)
    assert mark_m is None
    change = (after_mps**2 - v_mps**2) / 2 - a_mps2 * (after_m - x_m)
    size = v_mps**2 + after_mps**2 + abs(a_mps2) * (abs(x_m) + abs(after_m))
    assert change == pytest.approx(sign * (a_mps2 * dt_s) ** 2 / 2, abs=1e-14 * size + 1e-300)


# 2. Sticking, under correction none, with g into the wall (below 0: off it). A frame that begins at
#    u off the wall ends at u - g dt off it, and there v is reversed: the next one begins at
#    -CR (u - g dt). With CR < 1 that has one limit, u = CR g dt/(1 + CR), and the frame ends at
#    g dt/(1 + CR) into the wall. Forward Euler moves by the first, backward by the second, exact by
#    their mean.

@pytest.mark.parametrize("motion", ["forward", "backward", "exact"])
@given(side=sides, g_mps2=st.floats(-10, 10), v_mps=st.floats(-1, 1), CR=st.floats(0, 0.9),
       dt_s=st.floats(1e-3, 0.05))
@example(side=-1, g_mps2=1.5, v_mps=0.5, CR=0.6, dt_s=1 / 30)  # example 3's millimetre
def test_the_swings_of_a_car_in_a_wall_die_down_to_a_creep(
        motion: str, side: int, g_mps2: float, v_mps: float, CR: float, dt_s: float) -> None:
    scene = Scene(motion=motion, correction="none", CR=CR, a_mps2=side * g_mps2, x_m=0,
                  left_edge_m=-1, right_edge_m=1)
    x_m = side * 50.0  # far beyond
    for _ in range(400):
        x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
    off_mps, into_mps = CR * g_mps2 * dt_s / (1 + CR), g_mps2 * dt_s / (1 + CR)
    assert -side * v_mps == pytest.approx(off_mps, abs=1e-9)
    after_m, _, _ = step(scene, x_m, v_mps, dt_s)
    out_mps = {"forward": off_mps, "backward": -into_mps, "exact": (off_mps - into_mps) / 2}
    assert -side * (after_m - x_m) == pytest.approx(out_mps[motion] * dt_s, abs=1e-9)


# 3. The rebound puts the car from overlap beyond a wall to CR overlap off it. When that is longer
#    than the track, it is beyond the far wall.

@given(side=sides, overlap_m=st.floats(0.001, 20), CR=st.floats(0, 1), track_m=st.floats(0.01, 5))
@example(side=1, overlap_m=3.45, CR=1.0, track_m=1.95)  # example 14
def test_the_rebound_may_throw_the_car_through_the_far_wall(
        side: int, overlap_m: float, CR: float, track_m: float) -> None:
    assume(abs(CR * overlap_m - track_m) > 1e-9)
    scene = Scene(left_edge_m=-track_m / 2, right_edge_m=track_m / 2, CR=CR, x_m=0)
    x_m, _, mark_m = step(scene, 0.0, side * (track_m / 2 + overlap_m), 1.0)
    assert mark_m == pytest.approx(side * (track_m / 2 + overlap_m))
    assert (side * x_m < -track_m / 2) is (CR * overlap_m > track_m)
    scene = Scene(left_edge_m=-track_m / 2, right_edge_m=track_m / 2, CR=0, x_m=0)
    assert abs(step(scene, 0.0, side * (track_m / 2 + overlap_m), 1.0)[0]) == track_m / 2


# 4. The law of the hops. Off the wall to which the car is pulled, a hop of so many frames is
#    followed by one of CR (hop + before) + after. From wall to wall a hop lasts 2 w/(g dt) frames,
#    w the speed of its flight at the wall: w^2 = v^2 + 2 g h, where v is the flight's true speed,
#    by forward Euler's v - a dt/2, by backward v + a dt/2.

MOTION = {"forward": (1, 1), "exact": (0, 0), "backward": (-1, -1)}
PAIRS = [(motion, correction) for motion in MOTION for correction in ("none", "surface", "rebound")]


def before_and_after(motion: str, correction: str, CR: float) -> tuple[float, float]:
    before, after = {"none": (CR, -1), "surface": (1, 0), "rebound": (1, 1)}[correction]
    return MOTION[motion][0] + before, MOTION[motion][1] + after


def starts_on_the_way_to_the_wall(
        motion: str, correction: str, CR: float, starts: int) -> Iterator[Scene]:
    """From hops of 40 to 60 frames, at any moment of a frame, pulled to either wall, at x = 0."""
    rng = random.Random(f"{motion} {correction} {CR}")
    for _ in range(starts):
        dt_s, g_mps2, side = rng.uniform(0.01, 0.1), rng.uniform(1, 10), rng.choice([-1, 1])
        w_mps = g_mps2 * dt_s * rng.uniform(40, 60) / 2
        yield Scene(
            motion=motion, correction=correction, CR=CR, a_mps2=side * g_mps2, v_mps=side * w_mps,
            x_m=-side * rng.random() * w_mps * dt_s, fps_target=1 / dt_s,
            left_edge_m=min(0, -1000 * side), right_edge_m=max(0, -1000 * side))


def ends(motion: str, correction: str, CR: float, starts: int) -> list[float]:
    """How many lines the last hops of each film last, on average."""
    return [sum(lines_between_bounces(scene, 3000)[-20:]) / 20
            for scene in starts_on_the_way_to_the_wall(motion, correction, CR, starts)]


def hop_frames(scene: Scene, x_m: float, v_mps: float) -> float:
    """The length of the hop whose flight has the car here."""
    a_mps2, dt_s = scene.a_mps2, 1 / scene.fps_target
    v_mps -= MOTION[scene.motion][0] * a_mps2 * dt_s / 2
    return 2 * math.sqrt(v_mps**2 - 2 * a_mps2 * x_m) / (abs(a_mps2) * dt_s)


@pytest.mark.parametrize("CR", [1, 0.9, 0.8, 0.5])
@pytest.mark.parametrize(("motion", "correction"), PAIRS)
def test_a_hop_is_followed_by_one_of_the_law_s_length(
        motion: str, correction: str, CR: float) -> None:
    before, after = before_and_after(motion, correction, CR)
    off = []
    for scene in starts_on_the_way_to_the_wall(motion, correction, CR, 2000):
        x_m, v_mps, dt_s, mark_m = scene.x_m, scene.v_mps, 1 / scene.fps_target, None
        hop = hop_frames(scene, x_m, v_mps)
        while mark_m is None:
            x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        is_caught = step(scene, x_m, v_mps, dt_s)[2] is not None
        assert correction == "none" or not is_caught
        if not is_caught:
            off.append(hop_frames(scene, x_m, v_mps) - CR * (hop + before) - after)
    assert len(off) > 800
    assert abs(sum(off) / len(off)) < 0.15
    if (correction, CR) == ("surface", 1):  # lateness cancels: counted in lines, each hop obeys
        for scene in starts_on_the_way_to_the_wall(motion, correction, CR, 100):
            first, second, *_ = lines_between_bounces(scene, 300)
            assert second - first == before + after


@pytest.mark.parametrize("CR", [0.9, 0.8, 0.5])
@pytest.mark.parametrize(("motion", "correction"), PAIRS)
def test_hops_that_lose_speed_end_around_the_length_that_is_followed_by_itself_or_at_rest(
        motion: str, correction: str, CR: float) -> None:
    before, after = before_and_after(motion, correction, CR)
    n = (CR * before + after) / (1 - CR)
    found = ends(motion, correction, CR, 40)
    mean = sum(found) / 40
    if n < -1e-9:
        assert set(found) == {1}  # it lies on the wall or, by none, sinks into it
    elif n < 1e-9:
        assert 1 <= mean < 5  # by luck
    elif correction == "rebound":
        assert mean == pytest.approx(n, abs=0.5)
    else:
        assert all(end == round(end) for end in found)
        assert n + 1 - 1e-9 <= mean <= 1.9 * n + 0.5


# 5. Rewind. A car at a distance d from a wall, at u towards it, under an acceleration g towards it,
#    is there after t1 at s, with s^2 = u^2 + 2 g d, and leaves it at CR s. Until a time r later it
#    is CR s r - g r^2/2 off the wall, and rewind is right: r < 2 CR s/g, when a car that is pulled
#    to the wall is back for a second bounce; r < 2 s/|g|, when a move that is pulled off it is back
#    on the track. Later rewind puts the car on the wall, or has found no collision at all.

@given(side=sides, d_m=st.floats(0.01, 1), s_mps=st.floats(0.1, 20), CR=st.floats(0.05, 1),
       g_mps2=st.floats(-50, -0.1) | st.just(0.0) | st.floats(0.1, 50),
       part=st.floats(0.01, 1 - 1e-9) | st.floats(1.01, 1.99))
@example(side=1, d_m=0.895, s_mps=4.0, CR=0.5, g_mps2=-9.81, part=1 - 1e-9)
@settings(max_examples=500)
def test_rewind_is_right_for_one_bounce_whose_move_ends_beyond_the_wall_and_wrong_for_others(
        side: int, d_m: float, s_mps: float, CR: float, g_mps2: float, part: float) -> None:
    u_squared = s_mps**2 - 2 * g_mps2 * d_m
    assume(u_squared > 0)
    t1_s = 2 * d_m / (math.sqrt(u_squared) + s_mps)
    limit_s = 1.0 if g_mps2 == 0 else 2 * s_mps / abs(g_mps2) * (CR if g_mps2 > 0 else 1)
    rest_s = part * limit_s if part < 1 or g_mps2 <= 0 else (1 + CR * (part - 1)) * limit_s
    left_m, right_m = (-1000, 0) if side == 1 else (0, 1000)  # the wall is at 0
    scene = Scene(motion="exact", correction="rewind", CR=CR, a_mps2=side * g_mps2, x_m=0,
                  left_edge_m=left_m, right_edge_m=right_m)
    off_m = CR * s_mps * rest_s - g_mps2 * rest_s**2 / 2
    assume(off_m < 1000)
    x_m, v_mps, mark_m = step(scene, -side * d_m, side * math.sqrt(u_squared), t1_s + rest_s)
    if part < 1 or g_mps2 == 0:
        assert mark_m is not None
        assert -side * x_m == pytest.approx(off_m, abs=1e-8)
        assert -side * v_mps == pytest.approx(CR * s_mps - g_mps2 * rest_s, abs=1e-8)
    elif g_mps2 > 0:
        second_s = rest_s - limit_s
        true_m = CR**2 * s_mps * second_s - g_mps2 * second_s**2 / 2
        assert x_m == 0 < true_m
    else:
        assert mark_m is None
        assert side * v_mps == pytest.approx(s_mps + g_mps2 * rest_s)  # never turned round
