"""Where each method may be used: one test, or two, for each way in which a method fails.

Each states the law first, from the algebra of a frame, and then checks it over a range of scenes.
E is the energy v^2/2 - a x; a wall's side is -1 (left) or +1 (right); towards it means outwards.
"""

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import Scene, by_method, main, step
from clock import Capture, Clock, positions_m

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


def test_forward_euler_on_an_elastic_track_gains_half_its_energy_in_20_s_and_exact_none() -> None:
    def energy_after_20_s(motion: str, correction: str) -> float:
        scene = Scene(x_m=2.0, a_mps2=-2.0, CR=1.0, motion=motion, correction=correction)
        x_m, v_mps = 2.0, 0.0
        for _ in range(20 * 30):
            x_m, v_mps, _ = step(scene, x_m, v_mps, 1 / 30)
        return v_mps**2 / 2 + 2.0 * (x_m - 0.25)

    assert energy_after_20_s("forward", "rebound") > 1.5 * 3.5
    assert energy_after_20_s("exact", "replay") == pytest.approx(3.5, rel=1e-12)


# 2. Sticking, under correction none. A frame has found the car a distance q beyond a wall into
#    which g accelerates it, has turned it round and left it the speed u outwards, off the wall.
#    The next frame takes it off the wall by
#        backward: (u - g dt) dt        exact: u dt - g dt^2/2
#    and so out of it if and only if that is at least q. If it is not, the frame finds it beyond
#    the wall again and turns it inwards, so it moves inwards by some m and is turned back. Then
#    the next move out is at most CR m - g dt^2 (backward), or CR m - (1 + CR) g dt^2/2 (exact):
#    less than m, which it just lost. So with CR < 1 a car that does not get out at once never
#    does. (Forward Euler may shake itself loose again, by the energy that it gains.)

@pytest.mark.parametrize("motion", ["backward", "exact"])
@given(side=sides, inside=st.floats(0, 1), w_mps=st.floats(0.01, 50), g_mps2=st.floats(0, 50),
       dt_s=st.floats(1e-3, 0.2), CR=st.floats(0, 0.999))
@example(side=-1, inside=0.5, w_mps=2.7, g_mps2=0.0, dt_s=1 / 30, CR=0.9)  # gets out
@example(side=-1, inside=0.99, w_mps=2.25, g_mps2=1.5, dt_s=1 / 30, CR=0.6)  # example 3's trap
@settings(max_examples=300, deadline=None)
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


# 4. The order of the Euler methods. In free flight for T their velocity is right, and their
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


# 5. Replay, in the scenes of 1 to 4 in which the others fail: it stays on the track, keeps its
#    energy at CR = 1 and only ever loses some below.

@given(x_m=st.floats(-1, 1), v_mps=speeds, a_mps2=pulls, CR=st.floats(0, 1) | st.just(1.0),
       dt_s=frame_lengths_s)
@settings(max_examples=300, deadline=None)
def test_replay_keeps_the_track_and_the_energy_where_the_others_fail(
        x_m: float, v_mps: float, a_mps2: float, CR: float, dt_s: float) -> None:
    scene = Scene(motion="exact", correction="replay", left_edge_m=-1, right_edge_m=1, x_m=x_m,
                  v_mps=v_mps, a_mps2=a_mps2, CR=CR)
    energies = [v_mps**2 / 2 - a_mps2 * x_m]
    for _ in range(20):
        x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
        assert -1 <= x_m <= 1
        energies.append(v_mps**2 / 2 - a_mps2 * x_m)
    slack = 1e-11 * (energies[0] + 2 * abs(a_mps2) + 1)
    assert all(after <= before + slack for before, after in pairwise(energies))
    if CR == 1:
        assert energies[-1] == pytest.approx(energies[0], abs=slack)


@pytest.mark.parametrize("fps", [1, 2, 5, 10, 30, 60, 120, 240, 1000])
def test_replay_is_right_at_every_frame_rate_of_the_map(fps: int) -> None:
    for scene in (Scene(x_m=2, a_mps2=-2, CR=1), Scene(x_m=1.65, v_mps=40, CR=1),
                  Scene(x_m=2, a_mps2=-1.5, CR=0.6), Scene(x_m=1, v_mps=7, a_mps2=3, CR=0.9)):
        exactly, x_m, v_mps = by_method(scene), scene.x_m, scene.v_mps
        for frame in range(1, 20 * fps + 1):
            x_m, v_mps, _ = step(exactly, x_m, v_mps, 1 / fps)
            if frame % fps == 0:
                assert x_m == pytest.approx(
                    step(exactly, scene.x_m, scene.v_mps, frame / fps)[0], abs=1e-9)


# 6. The Zeno time. From rest at height H above the wall (along a) the car falls for
#    T = sqrt(2 H/a), and hops 2 CR T, 2 CR^2 T ...: it rests at T (1 + CR)/(1 - CR), after
#    infinitely many bounces.

@given(height_m=st.floats(0.01, 100), a_mps2=st.floats(0.1, 100), CR=st.floats(0.01, 0.99),
       side=sides)
@settings(deadline=None)
def test_the_car_is_at_rest_from_the_Zeno_time_on(
        height_m: float, a_mps2: float, CR: float, side: int) -> None:
    scene = Scene(motion="exact", correction="replay", CR=CR, a_mps2=side * a_mps2,
                  left_edge_m=0 if side < 0 else -200, right_edge_m=200 if side < 0 else 0,
                  x_m=-side * height_m)
    zeno_s = math.sqrt(2 * height_m / a_mps2) * (1 + CR) / (1 - CR)
    early, late = (step(scene, -side * height_m, 0.0, zeno_s * factor) for factor in (0.999, 1.001))
    assert early[:2] != (0.0, 0.0)
    assert late[:2] == (0.0, 0.0)


# 7. A stall, under observed dt. A frame that took 2 s would be followed by a step of 2 s; at
#    40 m/s that is 80 m, which the rebound cannot settle on a track of 1.95 m. So the car holds
#    still for that frame, and the longest step there is is max(0.15 s, 1.5/FPS).

@pytest.mark.parametrize("v_mps", [0.1, 0.3, 0.5])
def test_a_stall_does_not_become_a_leap(v_mps: float, clock: Clock, capsys: Capture) -> None:
    clock.when_drawn = lambda frame: 2.0 if frame == 10 else 0.0
    main(["99", "d", f"v_mps={v_mps}", "use_observed_dt=True", "fps_target=10", "--frames", "16"])
    xs = positions_m(capsys)
    assert xs[10] == xs[9]
    assert max(abs(b - a) for a, b in pairwise(xs)) <= v_mps * 0.15 + 0.01


def test_what_the_leap_would_do() -> None:
    scene = Scene(x_m=1.65, v_mps=40, CR=1)
    assert not -70 < step(scene, 1.65, 40.0, 2.0)[0] < 70
    exactly = replace(scene, motion="exact", correction="replay")
    assert 0.25 <= step(exactly, 1.65, 40.0, 2.0)[0] <= 2.2
