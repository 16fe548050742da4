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
from films import HERE

# Denormal numbers have few digits, so no bound by round-off holds for them. No scene needs them.
speeds = st.floats(-50, 50, allow_subnormal=False)
accelerations = st.just(0.0) | st.floats(1e-6, 50) | st.floats(-50, -1e-6)
frame_lengths_s = st.floats(1e-3, 1.0)
depths_m = st.floats(1e-3, 5)
bounces = st.just(0.0) | st.floats(1e-6, 1)
sides = st.sampled_from([-1, 1])
LISTING = (HERE / "airtrack.py").read_text(encoding="utf-8")
PAIRS = [(motion, correction) for motion in MOTIONS for correction in [*CORRECTIONS, "replay"]
         if correction not in ("rewind", "replay") or motion == "exact"]


@pytest.mark.parametrize("motion", ["forward", "backward", "exact"])
@given(x_m=st.floats(-100, 100), v_mps=speeds, a_mps2=accelerations, dt_s=frame_lengths_s)
def test_a_step_changes_E_as_its_docstring_says(
        motion: str, x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> None:
    told = re.search(r"(?:(adds|takes) a\^2 dt\^2/2|No step changes the energy E\.$)",
                     str(MOTIONS[motion].__doc__))
    assert told
    sign = {"adds": 1, "takes": -1, None: 0}[told[1]]
    scene = Scene(motion=motion, a_mps2=a_mps2, left_edge_m=-1000, right_edge_m=1000)
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, dt_s)
    assert mark_m is None
    assert after_mps == pytest.approx(v_mps + a_mps2 * dt_s)
    change = (after_mps**2 - v_mps**2) / 2 - a_mps2 * (after_m - x_m)
    size = v_mps**2 + after_mps**2 + abs(a_mps2) * (abs(x_m) + abs(after_m))
    assert change == pytest.approx(sign * (a_mps2 * dt_s) ** 2 / 2, abs=1e-14 * size + 1e-12)


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


# Rewind. A car meets the wall at w. Until a time r later it is CR w r - g r^2/2 in front of the
# wall, where g is the acceleration into it, and rewind is right: r < 2 CR w/g, when a car that is
# accelerated to the wall is back for a second bounce; r < 2 w/|g|, when a move that turns beyond
# the wall is back on the track. Later rewind puts the car on the wall, or finds no collision.

@given(side=sides, d_m=st.floats(0.01, 1), w_mps=st.floats(0.1, 20), CR=st.floats(0.05, 1),
       g_mps2=st.floats(-50, -0.1) | st.just(0.0) | st.floats(0.1, 50),
       part=st.floats(0.01, 1 - 1e-9) | st.floats(1.01, 1.99))
@example(side=1, d_m=0.895, w_mps=4.0, CR=0.5, g_mps2=-9.81, part=1 - 1e-9)
@settings(max_examples=500)
def test_rewind_is_right_for_one_bounce_whose_move_ends_beyond_the_wall_and_wrong_for_others(
        side: int, d_m: float, w_mps: float, CR: float, g_mps2: float, part: float) -> None:
    u_squared = w_mps**2 - 2 * g_mps2 * d_m
    assume(u_squared > 0)
    flight_s = 2 * d_m / (math.sqrt(u_squared) + w_mps)
    limit_s = 1.0 if g_mps2 == 0 else 2 * w_mps / abs(g_mps2) * (CR if g_mps2 > 0 else 1)
    rest_s = part * limit_s if part < 1 or g_mps2 <= 0 else (1 + CR * (part - 1)) * limit_s
    left_m, right_m = (-1000, 0) if side == 1 else (0, 1000)  # the wall is at 0
    scene = Scene(motion="exact", correction="rewind", CR=CR, a_mps2=side * g_mps2, x_m=0,
                  left_edge_m=left_m, right_edge_m=right_m)
    off_m = CR * w_mps * rest_s - g_mps2 * rest_s**2 / 2
    assume(off_m < 1000)
    x_m, v_mps, mark_m = step(scene, -side * d_m, side * math.sqrt(u_squared), flight_s + rest_s)
    if part < 1 or g_mps2 == 0:
        assert mark_m is not None
        assert -side * x_m == pytest.approx(off_m, abs=1e-8)
        assert -side * v_mps == pytest.approx(CR * w_mps - g_mps2 * rest_s, abs=1e-8)
    elif g_mps2 > 0:
        second_s = rest_s - limit_s
        true_m = CR**2 * w_mps * second_s - g_mps2 * second_s**2 / 2
        assert x_m == 0 < true_m
    else:
        assert mark_m is None
        assert side * v_mps == pytest.approx(w_mps + g_mps2 * rest_s)  # never turned round


def test_rewind_leaves_a_car_at_rest_on_its_wall_whatever_round_off_says_of_its_speed() -> None:
    for tenths in range(1, 100):
        scene = Scene(motion="exact", correction="rewind", x_m=0.25, a_mps2=-tenths / 10)
        assert step(scene, 0.25, 0.0, 1 / 30)[0] == pytest.approx(0.25, abs=1e-12)


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


# step turns the world round at the left wall.

@pytest.mark.parametrize(("motion", "correction"), PAIRS)
@given(x_m=st.floats(-1, 1), v_mps=st.floats(-20, 20), a_mps2=st.floats(-20, 20),
       CR=st.floats(0, 1), half_m=st.floats(1, 5), fps=st.integers(1, 60))
@settings(max_examples=30)
def test_the_mirrored_scene_gives_the_mirrored_film(
        motion: str, correction: str, x_m: float, v_mps: float, a_mps2: float, CR: float,
        half_m: float, fps: int) -> None:
    width_px = 101
    scene = Scene(
        x_m=x_m, v_mps=v_mps, a_mps2=a_mps2, CR=CR, left_edge_m=-half_m, right_edge_m=half_m,
        motion=motion, correction=correction, m_to_px=(width_px - 1) / (2 * half_m),
        width_px=width_px)
    mirrored = replace(scene, x_m=-x_m, v_mps=-v_mps, a_mps2=-a_mps2)
    turned_v_mps, turned_m = -v_mps, -x_m
    for _ in range(40):
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / fps)
        turned_m, turned_v_mps, turned_mark_m = step(mirrored, turned_m, turned_v_mps, 1 / fps)
        marks_m = 0.0 if mark_m is None else mark_m, 0.0 if turned_mark_m is None else turned_mark_m
        assert (mark_m is None) is (turned_mark_m is None)
        assert (x_m, v_mps, marks_m[0]) == pytest.approx(
            (-turned_m, -turned_v_mps, -marks_m[1]), rel=1e-9, abs=1e-9)
        drawn = [(place + half_m) * scene.m_to_px for place in (x_m, marks_m[0])]
        if all(abs(column % 1 - 0.5) > 1e-6 for column in drawn):  # which way is a half rounded?
            line = render_track(scene, {"*": x_m}, mark_m)
            turned = render_track(mirrored, {"*": turned_m}, turned_mark_m)
            assert line == turned[::-1].translate(str.maketrans("<>", "><"))


# The listing's drawings and worked numbers.

def test_the_drawing_of_one_collision_is_the_program_s_with_depth_velocity_and_energy() -> None:
    a_mps2, CR, wall_m = 20, 0.8, 0.2
    text = " ".join(LISTING.replace("#", "").split())
    assert f"inward_mps2 is {a_mps2}, CR is {CR}, and a column is 1 cm" in text
    start = Scene(x_m=0.32, v_mps=-1, a_mps2=-a_mps2, left_edge_m=wall_m, motion="exact", CR=CR,
                  m_to_px=100, width_px=33)

    def row(name: str, places_m: dict[str, float], mark_m: float | None, x_m: float,
            v_mps: float) -> str:
        depth_m, inward_mps = wall_m - x_m, -v_mps
        energy = inward_mps**2 / 2 - a_mps2 * depth_m
        track = render_track(start, places_m, mark_m)[12:]
        return f"{name:11}{track:27}{depth_m:7.3f}{inward_mps:11.2f}{energy:9.2f}"

    moved_m, moved_mps = MOTIONS["exact"](0.32, -1, -a_mps2, 0.1)
    drawn = [row("start", {"*": 0.32}, None, 0.32, -1),
             row("the move", {}, moved_m, moved_m, moved_mps)]
    for correction in CORRECTIONS:
        x_m, v_mps, mark_m = step(replace(start, correction=correction), 0.32, -1, 0.1)
        assert mark_m == moved_m
        drawn.append(row(correction, {"*": x_m}, mark_m, x_m, v_mps))
    names = "|".join(["start", "the move", *CORRECTIONS])
    told = re.findall(rf"(?m)^#     ((?:{names}) .*[0-9])$", LISTING)
    for line, again in zip(told, drawn, strict=True):
        assert line.split() == again.split()
        assert line[:38].rstrip() == again[:38].rstrip()  # the marks stand in their columns

    # What is said of it.
    assert re.findall(r"In one frame of (.*?) s .* to the 0, which is (.*?) cm beyond", text) == [
        ("0.1", f"{100 * (wall_m - moved_m):.0f}")]
    energies = {line.split()[0]: line.split()[-1] for line in drawn}
    E, left = energies["start"], energies["rewind"]
    assert f"it keeps CR^2 of the energy: {CR**2:.2f} * {E} is {left}." in text
    assert CR**2 * float(E) == pytest.approx(float(left), abs=0.005)
    assert f"in the drawn collision {energies['surface']} J/kg instead of {left}." in text
    w_mps = math.sqrt(2 * float(E))
    assert f"# {CR * w_mps:.2f} m/s in the drawn collision" in LISTING
    assert f"# {(-moved_mps - w_mps) / a_mps2:.3f} s, {w_mps:.2f} m/s" in LISTING


def test_the_three_lines_of_example_3_are_the_program_s() -> None:
    scene = Scene(**EXAMPLES[3].settings)
    doc = str(CORRECTIONS["none"].__doc__)
    known = {"acceleration": -scene.a_mps2, "CR": scene.CR, "dt": scene.fps_target}
    given_there = re.findall(r"(acceleration|CR|dt) is (?:1/)?(\d+\.?\d*)",
                             doc.partition("In example 3 ")[2])
    assert {name: float(text) for name, text in given_there} == known
    told = re.findall(r"frame (\d+)   The move ends (.*) cm deep\.   inward_mps changes from +(.*) "
                      r"to +(.*)\.\n", doc)
    x_m, v_mps, found = scene.x_m, scene.v_mps, []
    for frame in range(1, 49):
        _, moved_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, 1 / scene.fps_target)
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / scene.fps_target)
        if mark_m is not None:
            deep_cm = 100 * (scene.left_edge_m - mark_m)
            found.append((str(frame), f"{deep_cm:.1f}", f"{-moved_mps:.2f}", f"{-v_mps:.2f}"))
    assert told == found
