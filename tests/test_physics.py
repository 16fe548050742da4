"""One frame: what each motion and each correction does, checked by the algebra of a frame.

E is the energy v^2/2 - a x. A wall's side is -1 (left) or +1 (right), and towards it is outwards.
"""

import math
import re
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import CORRECTIONS, MOTIONS, Scene, arrival, render_track, step
from examples import EXAMPLES
from films import HERE, film

# Denormal numbers have few digits, so no bound by round-off holds for them. No scene needs them.
speeds = st.floats(-50, 50, allow_subnormal=False)
accelerations = st.just(0.0) | st.floats(1e-6, 50) | st.floats(-50, -1e-6)
frame_lengths_s = st.floats(1e-3, 1.0)
sides = st.sampled_from([-1, 1])
WIDE: dict[str, Any] = {"left_edge_m": -1000, "right_edge_m": 1000}
LISTING = (HERE / "airtrack.py").read_text()


@pytest.mark.parametrize(("motion", "sign", "told"), [
    ("forward", 1, "adds a^2 dt^2/2 to E."), ("backward", -1, "takes a^2 dt^2/2 from E."),
    ("exact", 0, "No step changes E.")])
@given(x_m=st.floats(-100, 100), v_mps=speeds, a_mps2=accelerations, dt_s=frame_lengths_s)
def test_a_step_changes_E_by_a2_dt2_2_times_1_0_or_minus_1(
        motion: str, sign: int, told: str, x_m: float, v_mps: float, a_mps2: float,
        dt_s: float) -> None:
    assert told in str(MOTIONS[motion].__doc__)
    scene = Scene(motion=motion, a_mps2=a_mps2, **WIDE)
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, dt_s)
    assert mark_m is None
    assert after_mps == pytest.approx(v_mps + a_mps2 * dt_s)
    change = (after_mps**2 - v_mps**2) / 2 - a_mps2 * (after_m - x_m)
    size = v_mps**2 + after_mps**2 + abs(a_mps2) * (abs(x_m) + abs(after_m))
    assert change == pytest.approx(sign * (a_mps2 * dt_s) ** 2 / 2, abs=1e-14 * size + 1e-12)


@pytest.mark.parametrize(("motion", "caught"), [("forward", -1), ("backward", 1), ("exact", 0)])
@given(side=sides, g_mps2=accelerations, dt_s=frame_lengths_s, part=st.floats(0.01, 0.99))
def test_with_none_at_CR_1_the_car_is_caught_if_its_move_out_is_shorter_than_its_way_in(
        motion: str, caught: int, side: int, g_mps2: float, dt_s: float, part: float) -> None:
    u_mps = 2 * abs(g_mps2) * dt_s + 1  # into the wall, more than the acceleration can hold
    scene = Scene(motion=motion, correction="none", CR=1, a_mps2=side * g_mps2, **WIDE)
    move_m = side * MOTIONS[motion](0, side * u_mps, side * g_mps2, dt_s)[0]
    start_m = side * (1000 - part * move_m)
    x_m, v_mps, mark_m = step(scene, start_m, side * u_mps, dt_s)
    after_m, _, _ = step(scene, x_m, v_mps, dt_s)
    shorter_m = move_m - side * (x_m - after_m)
    assert mark_m == x_m
    assert shorter_m == pytest.approx(caught * g_mps2 * dt_s**2, abs=1e-9)
    assert (side * after_m > 1000) is (shorter_m > part * move_m)


@given(side=sides, overlap_m=st.floats(0.001, 20), CR=st.floats(0, 1), track_m=st.floats(0.01, 5))
@example(side=1, overlap_m=3.45, CR=1.0, track_m=1.95)  # example 14
def test_surface_puts_the_car_on_the_wall_and_rebound_CR_overlap_in_front_of_it_or_out(
        side: int, overlap_m: float, CR: float, track_m: float) -> None:
    assume(abs(CR * overlap_m - track_m) > 1e-9)
    walls: dict[str, Any] = {"left_edge_m": -track_m / 2, "right_edge_m": track_m / 2}
    v_mps = side * (track_m / 2 + overlap_m)  # from the middle, in a second
    x_m, after_mps, mark_m = step(Scene(CR=CR, x_m=0, **walls), 0.0, v_mps, 1.0)
    assert mark_m == pytest.approx(side * (track_m / 2 + overlap_m))
    assert side * x_m == pytest.approx(track_m / 2 - CR * overlap_m)
    assert after_mps == -CR * v_mps
    assert (side * x_m < -track_m / 2) is (CR * overlap_m > track_m)  # out at the other end
    for scene in (Scene(CR=CR, correction="surface", x_m=0, **walls), Scene(CR=0, x_m=0, **walls)):
        x_m, after_mps, _ = step(scene, 0.0, v_mps, 1.0)
        assert (x_m, after_mps) == (side * track_m / 2, -scene.CR * v_mps)


@given(side=sides, wall_m=st.floats(-10, 10), overlap_m=st.floats(1e-3, 5), v_mps=speeds,
       g_mps2=accelerations, CR=st.just(0.0) | st.floats(1e-6, 1))
@example(side=1, wall_m=0.0, overlap_m=1.0, v_mps=0.0, g_mps2=9.0, CR=0.5)  # at rest beyond a wall
@example(side=-1, wall_m=0.0, overlap_m=1.0, v_mps=4.0, g_mps2=2.0, CR=0.1)  # it cannot get so far
def test_conserve_leaves_CR_squared_of_the_energy_above_the_wall(
        side: int, wall_m: float, overlap_m: float, v_mps: float, g_mps2: float,
        CR: float) -> None:
    found_m = wall_m + side * overlap_m
    overlap_m = side * (found_m - wall_m)
    x_m, after_mps = CORRECTIONS["conserve"](found_m, v_mps, wall_m, side * g_mps2, CR)
    left = CR**2 * max(0.0, v_mps**2 / 2 - g_mps2 * overlap_m)
    off_m, needed = side * (wall_m - x_m), g_mps2 * CR * overlap_m
    off_by = 1e-12 * (1 + v_mps**2 + abs(g_mps2) * (abs(wall_m) + overlap_m))
    assert after_mps**2 / 2 + g_mps2 * off_m == pytest.approx(left, abs=off_by)
    assert side * after_mps <= 0
    if abs(left - needed) > off_by:
        is_in_front = left > needed
        assert off_m == pytest.approx(CR * overlap_m * is_in_front, abs=1e-12 * (1 + abs(wall_m)))


# Rewind. A car at a distance d from a wall, at u towards it, under an acceleration g towards it,
# is there after t1 at s, with s^2 = u^2 + 2 g d, and leaves it at CR s. Until a time r later it
# is CR s r - g r^2/2 off the wall, and rewind is right: r < 2 CR s/g, when a car that is
# accelerated to the wall is back for a second bounce; r < 2 s/|g|, when a move that turns beyond
# the wall is back on the track. Later rewind puts the car on the wall, or finds no collision.

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


def test_rewind_leaves_a_car_at_rest_on_its_wall_whatever_round_off_says_of_its_speed() -> None:
    for tenths in range(1, 100):
        scene = Scene(motion="exact", correction="rewind", x_m=0.25, a_mps2=-tenths / 10)
        assert step(scene, 0.25, 0.0, 1 / 30)[0] == pytest.approx(0.25, abs=1e-12)


def test_a_car_that_round_off_keeps_from_the_wall_arrives_there_at_no_speed() -> None:
    for side_of_zero in (-2 * (1 - 4e-16), -2.0, -2 * (1 + 4e-16)):  # w^2 = 4 - 4 (1 +- 4e-16)
        t_s, w_mps = arrival(1.0, 2.0, side_of_zero)
        assert (t_s, w_mps) == pytest.approx((1.0, 0.0), abs=5e-8)
    assert w_mps == 0


# The listing's drawings and worked numbers.

def test_the_drawing_of_one_collision_is_the_program_s() -> None:
    start = Scene(x_m=0.32, v_mps=-1, a_mps2=-20, left_edge_m=0.2, motion="exact", CR=0.8,
                  m_to_px=100, width_px=33)

    def energy(x_m: float, v_mps: float) -> float:
        return v_mps**2 / 2 + 20 * (x_m - 0.2)

    def row(name: str, track: str, v_mps: float, x_m: float) -> str:
        return (f"#     {name:11}{track[12:40].rstrip():27} v = {v_mps:5.2f} m/s "
                f"{energy(x_m, v_mps):6.2f} J/kg")

    drawn = [row("start", render_track(start, 0.32, None, {}), -1, 0.32)]
    for correction in CORRECTIONS:
        scene = Scene(**vars(start) | {"correction": correction})
        x_m, v_mps, mark_m = step(scene, 0.32, -1, 0.1)
        assert mark_m == pytest.approx(0.12)
        drawn.append(row(correction, render_track(scene, x_m, mark_m, {}), v_mps, x_m))
    told = re.findall(r"#     \w+ .*J/kg", LISTING)
    assert [" ".join(line.split()) for line in told] == [" ".join(line.split()) for line in drawn]
    for line, plain in zip(told, drawn, strict=True):
        assert line[16:44].rstrip() == plain[16:44].rstrip()
    assert pytest.approx(1.86, abs=0.005) == 0.64 * 2.90


def test_the_three_lines_of_example_3_are_the_program_s() -> None:
    scene = Scene(**EXAMPLES[3].settings)
    x_m, v_mps = scene.x_m, scene.v_mps
    told = re.findall(
        r"frame (\d+)   The move ends at (.*) m\.   v is reversed from (.*) to (.*) m/s", LISTING)
    assert [int(frame) for frame, *_ in told] == [46, 47, 48]
    for frame in range(1, 49):
        moved_m, moved_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, 1 / 30)
        x_m, v_mps, _ = step(scene, x_m, v_mps, 1 / 30)
        if frame >= 46:
            figures = [float(text) for text in told[frame - 46][1:]]
            assert figures == [round(moved_m, 3), round(moved_mps, 2), round(v_mps, 2)]


def test_the_drawn_hop_is_what_the_program_draws(capsys: pytest.CaptureFixture[str]) -> None:
    words, = re.findall(r"in the same line,\n#     (.*)", LISTING)
    lines = film(capsys, "99", "d", *words.split(), "--frames", "18").lines[8:]
    drawn = re.findall("#     ([0-9]): {3}(.{27}) *v = (.{5})", LISTING)
    assert len(drawn) == 10
    for line, (number, track, v_mps) in zip(lines, drawn, strict=True):
        assert line[20:47].rstrip() == track.rstrip()
        assert f"v = {v_mps}" in line
        assert int(number) == lines.index(line) or number == "9"
