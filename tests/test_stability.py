"""Where each method may be used: a test, or two, for each way in which a method fails.

Each states the law first, from the algebra of a frame, and then checks it over a range of scenes.
E is the energy v^2/2 - a x; a wall's side is -1 (left) or +1 (right); towards it means outwards.
"""

import math
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import Scene, step

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


# 2. Sticking, under correction none. A frame has found the car a distance q beyond a wall into
#    which g accelerates it, has turned it round and left it the speed u outwards, off the wall.
#    The next frame takes it off the wall by
#        backward: (u - g dt) dt        exact: u dt - g dt^2/2
#    and so out of it if and only if that is at least q. If it is not, the frame finds it beyond
#    the wall again and turns it inwards, so it moves inwards by some m and is turned back. Then
#    the next move out is at most CR m - g dt^2 (backward), or CR m - (1 + CR) g dt^2/2 (exact):
#    less than m, which it just lost. So with CR < 1 a car that does not get out at once never
#    does. (Forward Euler may; and off the wall it is the other way round, as the next test shows.)

@pytest.mark.parametrize("motion", ["backward", "exact"])
@given(side=sides, inside=st.floats(0, 1), w_mps=st.floats(0.01, 50), g_mps2=st.floats(0, 50),
       dt_s=st.floats(1e-3, 0.2), CR=st.floats(0, 0.999))
@example(side=-1, inside=0.5, w_mps=2.7, g_mps2=0.0, dt_s=1 / 30, CR=0.9)  # gets out
@example(side=-1, inside=0.99, w_mps=2.25, g_mps2=1.5, dt_s=1 / 30, CR=0.6)  # example 3's trap
@settings(max_examples=300)
def test_without_correction_a_car_that_is_not_out_at_once_is_stuck_for_good(
        motion: str, side: int, inside: float, w_mps: float, g_mps2: float, dt_s: float,
        CR: float) -> None:
    scene = Scene(motion=motion, correction="none", CR=CR, a_mps2=side * g_mps2, left_edge_m=-1,
                  right_edge_m=1, x_m=side * 1.0)
    # It is about to enter, at such a distance that the frame ends `inside` of its move beyond.
    free_m = (w_mps + g_mps2 * dt_s / (1 if motion == "backward" else 2)) * dt_s
    x_m, v_mps, mark_m = step(scene, side * (1 - (1 - inside) * free_m), side * w_mps, dt_s)
    assume(mark_m is not None)
    q_m, u_mps = side * x_m - 1, -side * v_mps
    pull_m = g_mps2 * dt_s**2 / (1 if motion == "backward" else 2)
    out_m = u_mps * dt_s - pull_m
    assume(abs(out_m - q_m) > 1e-9)
    for _ in range(200 if out_m < q_m else 1):
        x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
        assert (side * x_m > 1) is (out_m < q_m)


@pytest.mark.parametrize(("motion", "a_mps2", "is_out"), [
    ("forward", -0.5, True), ("backward", -0.5, False), ("exact", -0.5, False),
    ("forward", 0.5, False), ("backward", 0.5, True), ("exact", 0.5, True)])
def test_forward_creeps_out_against_a_pull_into_the_wall_and_the_others_with_one_off_it(
        motion: str, a_mps2: float, is_out: bool) -> None:
    scene = Scene(motion=motion, correction="none", x_m=0.5, v_mps=-3, a_mps2=a_mps2, CR=0.3)
    x_m, v_mps, depths_m = 0.5, -3.0, []
    for _ in range(600):
        x_m, v_mps, _ = step(scene, x_m, v_mps, 1 / 30)
        depths_m.append(0.25 - x_m)
    assert min(depths_m[2:40]) > 0
    assert depths_m[599] < 1e-3 if is_out else depths_m[599] > depths_m[300] > depths_m[60]


# 3. The rebound's throw. It puts the car from overlap beyond a wall to CR overlap off it, so
#    overlap (1 + CR) from where it was found. When CR overlap is longer than the track, that is
#    beyond the far wall.

@given(side=sides, overlap_m=st.floats(0.001, 20), CR=st.floats(0, 1), track_m=st.floats(0.01, 5))
@example(side=1, overlap_m=3.45, CR=1.0, track_m=1.95)  # example 14
def test_the_rebound_throws_the_car_through_the_far_wall_when_CR_overlap_is_longer_than_the_track(
        side: int, overlap_m: float, CR: float, track_m: float) -> None:
    assume(abs(CR * overlap_m - track_m) > 1e-9)
    scene = Scene(left_edge_m=-track_m / 2, right_edge_m=track_m / 2, CR=CR, x_m=0)
    x_m, _, mark_m = step(scene, 0.0, side * (track_m / 2 + overlap_m), 1.0)
    assert mark_m == pytest.approx(side * (track_m / 2 + overlap_m))
    assert side * x_m == pytest.approx(track_m / 2 - CR * overlap_m)
    assert (side * x_m < -track_m / 2) is (CR * overlap_m > track_m)


# 4. The balance at an elastic wall into which g pulls. Both rebound and surface leave the speed as
#    it is and lift the car: rebound by 2 overlap, surface by overlap. So E rises by g times that,
#    for rebound on average by g v dt a bounce, the overlap being anything from 0 to v dt. Backward
#    Euler loses N a^2 dt^2/2 in a flight of N = 2 v/(g dt) steps: g v dt, too. Exact loses nothing.

@pytest.mark.parametrize(("correction", "lifts"), [("none", 0), ("surface", 1), ("rebound", 2)])
@given(side=sides, u_mps=st.floats(0.1, 50), g_mps2=st.floats(0, 50), inside=st.floats(0.01, 0.99),
       dt_s=st.floats(1e-3, 0.2))
def test_an_elastic_correction_lifts_the_car_against_the_pull(
        correction: str, lifts: int, side: int, u_mps: float, g_mps2: float, inside: float,
        dt_s: float) -> None:
    free_m = u_mps * dt_s + g_mps2 * dt_s**2 / 2
    scene = Scene(motion="exact", correction=correction, CR=1, a_mps2=side * g_mps2,
                  left_edge_m=-50, right_edge_m=50, x_m=0)
    x_m, v_mps = side * (50 - (1 - inside) * free_m), side * u_mps
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, dt_s)
    assert mark_m is not None
    gained = (after_mps**2 - v_mps**2) / 2 - scene.a_mps2 * (after_m - x_m)
    assert gained == pytest.approx(g_mps2 * lifts * inside * free_m, abs=1e-9)


@given(v_mps=st.floats(0.5, 20), g_mps2=st.floats(0.5, 20), hops=st.integers(100, 1000))
def test_a_flight_by_backward_euler_loses_what_a_rebound_gains_on_average(
        v_mps: float, g_mps2: float, hops: int) -> None:
    dt_s = 2 * v_mps / g_mps2 / hops
    scene = Scene(a_mps2=-g_mps2, x_m=0, **WIDE)
    x_m, now_mps = 0.0, v_mps
    for _ in range(hops):
        x_m, now_mps, _ = step(scene, x_m, now_mps, dt_s)
    lost = v_mps**2 / 2 - (now_mps**2 / 2 + g_mps2 * x_m)
    assert lost == pytest.approx(g_mps2 * v_mps * dt_s, rel=1e-6)


@given(side=sides, u_mps=st.floats(0.1, 50), inside=st.floats(0, 1, exclude_min=True),
       dt_s=st.floats(1e-3, 0.2))
def test_from_the_surface_the_car_leaves_up_to_a_frame_late(
        side: int, u_mps: float, inside: float, dt_s: float) -> None:
    scene = Scene(correction="surface", CR=1, left_edge_m=-50, right_edge_m=50, x_m=0)
    x_m = side * (50 - (1 - inside) * u_mps * dt_s)
    after_m, after_mps, mark_m = step(scene, x_m, side * u_mps, dt_s)
    assume(mark_m is not None)
    true_m = side * (50 - inside * u_mps * dt_s)
    assert (true_m - after_m) / after_mps == pytest.approx(inside * dt_s, abs=1e-9)


# 5. Rewind. A car at a distance d from a wall, at u towards it, under an acceleration g towards it,
#    is there after t1 at s, with s^2 = u^2 + 2 g d, and leaves it at CR s. Right to round-off is
#    rewind where the frame holds this one bounce and its move ends beyond the wall. That is so in
#    the time r after t1 that is shorter than 2 CR s/g, when a car that is pulled to the wall
#    (g > 0) is back for a second bounce, and shorter than 2 s/|g|, when a move that is pulled off
#    the wall (g < 0) is back on the track. Then the car is CR s r - g r^2/2 off the wall. Later
#    rewind puts the car on the wall (g > 0), or has found no collision at all: g < 0,
#    u^2 > 2 |g| d and u dt - |g| dt^2/2 < d.

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


@given(x_m=st.floats(-1000, 1000), v_mps=st.just(0.0) | speeds, a_mps2=pulls.filter(bool),
       CR=st.floats(0, 1), dt_s=frame_lengths_s)
def test_rewind_puts_a_car_that_it_threw_beyond_a_wall_on_it_or_off_it(
        x_m: float, v_mps: float, a_mps2: float, CR: float, dt_s: float) -> None:
    scene = Scene(motion="exact", correction="rewind", CR=CR, a_mps2=a_mps2)
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, dt_s)
    assert math.isfinite(after_m)
    assert math.isfinite(after_mps)
    if mark_m is not None:
        wall_m = scene.to_track(mark_m)
        assert (after_m - wall_m) * (mark_m - wall_m) <= 0


# 6. The order of the Euler methods. In free flight for T their velocity is right, and their
#    position is off by the sum of the steps' a dt^2/2: by -a T dt/2 (forward), +a T dt/2
#    (backward). Half the step, half the error.

@pytest.mark.parametrize(("motion", "sign"), [("forward", -1), ("backward", 1)])
@given(v_mps=speeds, a_mps2=pulls.filter(lambda a: abs(a) > 0.01), steps=st.integers(1, 200))
def test_half_the_step_is_half_the_error(
        motion: str, sign: int, v_mps: float, a_mps2: float, steps: int) -> None:
    scene = Scene(motion=motion, a_mps2=a_mps2, **WIDE)

    def error_m(dt_s: float, count: int) -> float:
        x_m, t_s, now_mps = 0.0, dt_s * count, v_mps
        for _ in range(count):
            x_m, now_mps, _ = step(scene, x_m, now_mps, dt_s)
        return x_m - (v_mps * t_s + a_mps2 * t_s**2 / 2)

    whole_m, half_m = error_m(2.0 / steps, steps), error_m(1.0 / steps, 2 * steps)
    assert whole_m == pytest.approx(sign * a_mps2 * 2.0 * (2.0 / steps) / 2, rel=1e-6, abs=1e-10)
    assert half_m == pytest.approx(whole_m / 2, rel=1e-6, abs=1e-10)
