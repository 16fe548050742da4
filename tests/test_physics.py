"""One frame: what each motion and each correction does, checked by the algebra of a frame.

Depth, velocity and acceleration at a wall count from it and into it, as in the listing. E is the
energy v^2/2 - a x, and at a wall w^2/2 - a depth.
"""

import math
import re
from dataclasses import replace
from decimal import Decimal, localcontext

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import CORRECTIONS, MOTIONS, Scene, arrival, render_track, step
from examples import EXAMPLES
from films import LISTING, WORDS, sides, value

# Denormal numbers have few digits, so no bound by round-off holds for them. No scene needs them.
speeds = st.floats(-50, 50, allow_subnormal=False)
accelerations = st.just(0.0) | st.floats(1e-6, 50) | st.floats(-50, -1e-6)
depths_m = st.floats(1e-3, 5)
bounces = st.just(0.0) | st.floats(1e-6, 1)


@pytest.mark.parametrize("motion", ["forward", "backward", "exact"])
@given(x_m=st.floats(-100, 100), v_mps=speeds, a_mps2=accelerations, dt_s=st.floats(1e-3, 1))
def test_a_step_changes_E_as_its_docstring_says(
        motion: str, x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> None:
    doc = str(MOTIONS[motion].__doc__)
    told = {"x": x_m, "v": v_mps, "a": a_mps2, "dt": dt_s}
    for formula in re.findall(r"[xv] \+ [^,.]*", doc):  # in their order
        told[formula[0]] = value(formula, **told)
    told_gain = 0.0
    gain = re.search(r"Each step (adds|takes) (.*?) (?:to|from) the energy E", doc)
    assert (gain is None) is ("No step changes the energy E" in doc)
    if gain is not None:
        sign = 1 if gain[1] == "adds" else -1
        told_gain = sign * value(gain[2], **told)
    scene = Scene(motion=motion, a_mps2=a_mps2, left_edge_m=-1000, right_edge_m=1000)
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, dt_s)
    assert mark_m is None
    assert (after_m, after_mps) == pytest.approx((told["x"], told["v"]), abs=1e-9)
    change = (after_mps**2 - v_mps**2) / 2 - a_mps2 * (after_m - x_m)
    size = v_mps**2 + after_mps**2 + abs(a_mps2) * (abs(x_m) + abs(after_m))
    assert change == pytest.approx(told_gain, abs=1e-14 * size + 1e-12)


# The corrections, in the wall's own coordinates.

@given(depth_m=depths_m, inward_mps=speeds, inward_mps2=accelerations, CR=bounces)
def test_none_surface_and_rebound_leave_1_0_and_minus_CR_of_the_depth_and_minus_CR_of_v(
        depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> None:
    for correction, part in (("none", 1), ("surface", 0), ("rebound", -CR)):
        left = CORRECTIONS[correction](depth_m, inward_mps, inward_mps2, CR)
        assert left == pytest.approx((part * depth_m, -CR * inward_mps))


@given(depth_m=depths_m, inward_mps=speeds, inward_mps2=accelerations, CR=bounces)
@example(depth_m=1.0, inward_mps=0.0, inward_mps2=9.0, CR=0.5)  # it cannot have come so deep
@example(depth_m=1.0, inward_mps=4.0, inward_mps2=2.0, CR=0.1)  # it cannot get so far
def test_conserve_leaves_CR_squared_of_E_where_rebound_does_or_on_the_wall(
        depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> None:
    after_m, after_mps = CORRECTIONS["conserve"](depth_m, inward_mps, inward_mps2, CR)
    left = CR**2 * max(0.0, inward_mps**2 / 2 - inward_mps2 * depth_m)
    off_by = 1e-12 * (1 + inward_mps**2 + abs(inward_mps2) * depth_m)
    assert after_mps**2 / 2 - inward_mps2 * after_m == pytest.approx(left, abs=off_by)
    assert after_mps <= 0
    needed = inward_mps2 * CR * depth_m
    if abs(left - needed) > off_by:
        assert after_m == pytest.approx(-CR * depth_m if left > needed else 0)


# A car meets the wall at w. Until a time r later it is CR w r - g r^2/2 in front of the wall, where
# g is the acceleration into it: until r = 2 CR w/g, when a car that is accelerated to the wall is
# back for a second bounce, or r = 2 w/|g|, when a move that turns beyond the wall is on the track.

@given(side=st.sampled_from([-1, 1]), d_m=st.floats(0.01, 1), w_mps=st.floats(0.1, 20),
       CR=st.floats(0.05, 1), g_mps2=st.floats(-50, -0.1) | st.just(0.0) | st.floats(0.1, 50),
       part=st.floats(0.01, 1 - 1e-9) | st.floats(1.01, 1.99))
@example(side=1, d_m=0.895, w_mps=4.0, CR=0.5, g_mps2=-9.81, part=1 - 1e-9)
def test_rewind_is_right_for_one_bounce_and_puts_a_car_on_the_wall_that_should_bounce_again(
        side: int, d_m: float, w_mps: float, CR: float, g_mps2: float, part: float) -> None:
    u_squared = w_mps**2 - 2 * g_mps2 * d_m
    assume(u_squared > 0)
    assume(part < 1 or g_mps2 > 0)
    flight_s = 2 * d_m / (math.sqrt(u_squared) + w_mps)
    limit_s = 1.0 if g_mps2 == 0 else 2 * w_mps / abs(g_mps2) * (CR if g_mps2 > 0 else 1)
    rest_s = part * limit_s if part < 1 else (1 + CR * (part - 1)) * limit_s
    off_m = CR * w_mps * rest_s - g_mps2 * rest_s**2 / 2
    assume(off_m < 1000)
    scene = Scene(motion="exact", correction="rewind", CR=CR, a_mps2=side * g_mps2, x_m=0,
                  left_edge_m=min(0, -1000 * side), right_edge_m=max(0, -1000 * side))
    x_m, v_mps, mark_m = step(scene, -side * d_m, side * math.sqrt(u_squared), flight_s + rest_s)
    assert mark_m is not None
    if part < 1:
        assert -side * x_m == pytest.approx(off_m, abs=1e-8)
        assert -side * v_mps == pytest.approx(CR * w_mps - g_mps2 * rest_s, abs=1e-8)
    else:
        assert x_m == 0


@given(d_m=st.floats(1e-9, 1), u_mps=st.floats(-50, 50), a_mps2=st.floats(1e-9, 50))
@example(d_m=1e-9, u_mps=50.0, a_mps2=1e-6)  # w - u is nothing but round-off
@example(d_m=1e-9, u_mps=-50.0, a_mps2=10.0)  # u + w is
def test_arrival_has_twelve_right_digits_where_a_textbook_s_root_cancels(
        d_m: float, u_mps: float, a_mps2: float) -> None:
    with localcontext(prec=60):
        d, u, a = Decimal(d_m), Decimal(u_mps), Decimal(a_mps2)
        w = (u * u + 2 * a * d).sqrt()
        t = (w - u) / a
    assert arrival(d_m, u_mps, a_mps2) == pytest.approx((float(t), float(w)), rel=1e-12)


def test_a_car_that_round_off_keeps_from_the_wall_arrives_there_at_no_speed() -> None:
    a_mps2 = -2 * (1 + 4e-16)  # w^2 would be -2e-15
    assert arrival(1.0, 2.0, a_mps2) == pytest.approx((1.0, 0.0), abs=1e-12)


@pytest.mark.parametrize(("motion", "correction"), [
    (motion, correction) for motion in MOTIONS for correction in CORRECTIONS
    if correction != "rewind"] + [("exact", "rewind"), ("exact", "replay")])
@given(x_m=st.floats(-1, 1), v_mps=st.floats(-20, 20), a_mps2=st.floats(-20, 20),
       CR=st.floats(0, 1), half_m=st.floats(1, 5), fps=st.integers(1, 60))
@settings(max_examples=30)
def test_the_mirrored_scene_gives_the_mirrored_film(
        motion: str, correction: str, x_m: float, v_mps: float, a_mps2: float, CR: float,
        half_m: float, fps: int) -> None:
    scene = Scene(x_m=x_m, a_mps2=a_mps2, CR=CR, left_edge_m=-half_m, right_edge_m=half_m,
                  motion=motion, correction=correction)
    mirrored = replace(scene, x_m=-x_m, a_mps2=-a_mps2)
    turned_m, turned_mps = -x_m, -v_mps
    for _ in range(40):
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / fps)
        turned_m, turned_mps, turned_mark_m = step(mirrored, turned_m, turned_mps, 1 / fps)
        assert (mark_m is None) is (turned_mark_m is None)
        assert (x_m, v_mps, mark_m or 0.0) == pytest.approx(
            (-turned_m, -turned_mps, -(turned_mark_m or 0.0)), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("correction", [*CORRECTIONS, "replay"])
def test_a_move_that_ends_on_a_wall_is_no_collision(correction: str) -> None:
    scene = Scene(motion="exact", correction=correction, left_edge_m=0.25)
    assert step(scene, 0.5, -1.0, 0.25) == (0.25, -1.0, None)


# The listing's drawings and worked numbers.

def test_the_drawing_of_one_collision_is_the_program_s_with_depth_velocity_and_energy() -> None:
    a_mps2, CR, wall_m, dt_s = 20, 0.8, 0.2, 0.1
    start = Scene(x_m=0.32, v_mps=-1, a_mps2=-a_mps2, left_edge_m=wall_m, motion="exact", CR=CR,
                  m_to_px=100, width_px=39)
    moved_m, moved_mps = MOTIONS["exact"](start.x_m, start.v_mps, start.a_mps2, dt_s)
    cars = {"start": (start.x_m, start.v_mps, None), "the move": (moved_m, moved_mps, moved_m)}
    for correction in CORRECTIONS:
        cars[correction] = step(
            replace(start, correction=correction), start.x_m, start.v_mps, dt_s)
    energies = {}
    for name, (x_m, v_mps, mark_m) in cars.items():
        energy = v_mps**2 / 2 - a_mps2 * (wall_m - x_m)
        energies[name] = f"{energy:.2f}"
        places_m = {} if name == "the move" else {"*": x_m}
        track = render_track(start, places_m, mark_m)[12:]
        row = f"#     {name:11}{track}{wall_m - x_m:7.3f}{-v_mps:11.2f}{energy:9.2f}"
        assert row in LISTING

    w_mps = math.sqrt(2 * float(energies["start"]))
    for sentence in (
            f"inward_mps2 is {a_mps2}, CR is {CR}, and a column is 1 cm. In one frame of {dt_s} s ",
            f"to the 0, which is {100 * (wall_m - moved_m):.0f} cm beyond the wall.",
            f"of the energy: {CR**2:.2f} * {energies['start']} is {energies['rewind']}.",
            f"in the drawn collision {energies['surface']} J/kg instead of {energies['rewind']}.",
            f"{CR * w_mps:.2f} m/s in the drawn collision",
            f"{(-moved_mps - w_mps) / a_mps2:.3f} s, {w_mps:.2f} m/s"):
        assert sentence in WORDS


def test_the_formulas_beside_conserve_and_arrival_hold() -> None:
    a, d, u, CR, depth, v = 20.0, 0.12, 1.0, 0.8, 0.08, 3.0  # the drawn collision
    t, w = arrival(d, u, a)
    new_depth, new_v = CORRECTIONS["conserve"](depth, v, a, CR)
    assert new_depth == -CR * depth
    values = {"a": a, "d": d, "u": u, "CR": CR, "depth": depth, "v": v, "t": t, "w": w, "s": -new_v}
    for formula in ("w^2 = v^2 - 2 a depth", "s^2 = (CR w)^2 - 2 a CR depth",
                    "w^2 = u^2 + 2 a d", "d = t (u + w)/2", "w = u + a t"):
        assert f" {formula}" in WORDS
        left, right = sides(formula, **values)
        assert left == pytest.approx(right)
    told, = re.findall(r"with d = (\d+), u = (\d+) and a = (-\d+) it is not", WORDS)
    assert float(told[1])**2 + 2 * float(told[2]) * float(told[0]) < 0


def test_the_three_lines_of_example_3_are_the_program_s() -> None:
    doc = " ".join(str(CORRECTIONS["none"].__doc__).split())
    scene = Scene(**EXAMPLES[3].settings)
    assert (f"In example 3 the motion is {scene.motion}, inward_mps2 is {-scene.a_mps2}, "
            f"dt is 1/{scene.fps_target:.0f} s, and CR is {scene.CR}.") in doc
    x_m, v_mps, told = scene.x_m, scene.v_mps, []
    for frame in range(1, 49):
        _, moved_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, 1 / scene.fps_target)
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / scene.fps_target)
        if mark_m is not None:
            told.append(f"frame {frame} The move ends {100 * (scene.left_edge_m - mark_m):.2f} cm "
                        f"deep. inward_mps changes from {-moved_mps:.2f} to {-v_mps:.2f}.")
    assert len(told) == 3
    assert " ".join(told) in doc
