"""Where each method may be used: a test, or two, for each way in which a method fails.

Each states the law first, from the algebra of a frame, and then checks it over a range of scenes.
E is the energy v^2/2 - a x; a wall's side is -1 (left) or +1 (right); towards it means outwards.
"""

import math
import random
import re
from collections.abc import Iterator
from itertools import pairwise, product
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airtrack import CORRECTIONS, MOTIONS, Scene, step
from examples import EXAMPLES
from films import LAW, K, details, film, hops, starts

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

@pytest.mark.parametrize(("motion", "sign", "told"), [
    ("forward", 1, "adds a^2 dt^2/2 to E."), ("backward", -1, "takes a^2 dt^2/2 from E."),
    ("exact", 0, "No step changes E.")])
@given(x_m=st.floats(-100, 100), v_mps=speeds, a_mps2=pulls, dt_s=frame_lengths_s)
def test_each_step_changes_the_energy_by_the_law_of_its_method(
        motion: str, sign: int, told: str, x_m: float, v_mps: float, a_mps2: float,
        dt_s: float) -> None:
    assert told in str(MOTIONS[motion].__doc__)
    scene = Scene(motion=motion, a_mps2=a_mps2, **WIDE)
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, dt_s)
    assert mark_m is None
    change = (after_mps**2 - v_mps**2) / 2 - a_mps2 * (after_m - x_m)
    size = v_mps**2 + after_mps**2 + abs(a_mps2) * (abs(x_m) + abs(after_m))
    assert change == pytest.approx(sign * (a_mps2 * dt_s) ** 2 / 2, abs=1e-14 * size + 1e-300)


# 2. Sticking, by none. At CR = 1, in equal frames, the move out of a wall is as long as the move in
#    by exact; by backward it is shorter if the pull is into the wall, by forward if it is off it.

@pytest.mark.parametrize(("motion", "caught"), [("forward", -1), ("backward", 1), ("exact", 0)])
@given(side=sides, g_mps2=pulls, dt_s=frame_lengths_s, part=st.floats(0.01, 0.99))
def test_a_car_is_out_of_a_wall_a_frame_later_unless_something_has_shortened_the_move_out(
        motion: str, caught: int, side: int, g_mps2: float, dt_s: float, part: float) -> None:
    u_mps = 2 * abs(g_mps2) * dt_s + 1  # into the wall, in any case longer than the pull can hold
    scene = Scene(motion=motion, correction="none", CR=1, a_mps2=side * g_mps2, **WIDE)
    move_m = side * MOTIONS[motion](0, side * u_mps, side * g_mps2, dt_s)[0]
    start_m = side * (1000 - part * move_m)
    x_m, v_mps, mark_m = step(scene, start_m, side * u_mps, dt_s)
    after_m, _, _ = step(scene, x_m, v_mps, dt_s)
    shorter_m = move_m - side * (x_m - after_m)
    assert mark_m is not None
    assert shorter_m == pytest.approx(caught * g_mps2 * dt_s**2, abs=1e-9)
    assert (side * after_m > 1000) is (shorter_m > part * move_m)


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


# 4. conserve. At a height h off the wall the car has the energy v^2/2 + g h above it. A bounce
#    leaves CR^2 of it (0, where the car cannot have come from the wall). If that is enough for g CR
#    overlap, the car is CR overlap off the wall, otherwise on it.

@given(side=sides, wall_m=st.floats(-10, 10), overlap_m=st.floats(1e-3, 5), v_mps=speeds,
       g_mps2=pulls, CR=st.floats(0, 1))
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
    off_by = 1e-12 * (v_mps**2 + abs(g_mps2) * (abs(wall_m) + overlap_m))
    assert after_mps**2 / 2 + g_mps2 * off_m == pytest.approx(left, abs=off_by)
    assert side * after_mps <= 0
    if abs(left - needed) > off_by:
        assert off_m == pytest.approx(CR * overlap_m * (left > needed), abs=1e-12 * abs(wall_m))


# 5. The law of the hops, counted in lines as in a film. (1) holds in each hop: u + w is hop g dt.
#    The next hop has, on average, CR (hop + k) + k lines. It needs no other wall.

FOUND = [(motion, correction) for motion in ("forward", "exact", "backward")
         for correction in ("surface", "rebound", "conserve")]
TOLD = " ".join(LAW.replace("#", "").split())


@pytest.mark.parametrize("correction", ["none", "surface", "rebound", "conserve"])
@pytest.mark.parametrize("motion", MOTIONS)
@given(side=sides, g_mps2=st.floats(2, 10), CR=st.floats(0, 1), dt_s=st.floats(0.05, 0.1),
       off_m=st.floats(0, 1), v_mps=st.floats(-3, 3))
def test_in_each_hop_the_pull_adds_g_dt_in_each_frame(
        motion: str, correction: str, side: int, g_mps2: float, CR: float, dt_s: float,
        off_m: float, v_mps: float) -> None:
    scene = Scene(motion=motion, correction=correction, CR=CR, a_mps2=side * g_mps2, x_m=0,
                  left_edge_m=min(0, -1000 * side), right_edge_m=max(0, -1000 * side))
    x_m, begun = -side * off_m, list[tuple[int, float]]()  # hops: the line, and u
    for line in range(300):
        w_mps = side * MOTIONS[motion](x_m, v_mps, scene.a_mps2, dt_s)[1]
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        if mark_m is not None:
            for first_line, u_mps in begun[-1:]:
                assert u_mps + w_mps == pytest.approx((line - first_line) * g_mps2 * dt_s, abs=1e-9)
                if (motion, correction) == ("exact", "surface"):  # at the floor u: w less lag g dt
                    assert w_mps**2 - 2 * g_mps2 * side * mark_m == pytest.approx(u_mps**2)
            begun.append((line, -side * v_mps))
    assert len(begun) > 1


@pytest.mark.parametrize(("motion", "correction", "CR"), [
    *((*method, CR) for method in FOUND for CR in (1, 0.9, 0.8, 0.5)),
    *((motion, "none", 1) for motion in ("forward", "exact", "backward"))])
def test_a_hop_is_followed_on_average_by_one_of_the_law_s_length(
        motion: str, correction: str, CR: float) -> None:
    k = K[motion] + K[correction]
    pairs = [hops(scene, 2) for scene in starts(motion, correction, CR, 45, 85, 1000)]
    off = [after - CR * (hop + k) - k for hop, after in pairs if hop > 1 < after]  # 1: caught
    assert len(off) > (900 if correction == "none" else 999)
    assert abs(sum(off) / len(off)) < 0.1
    assert max(map(abs, off)) < {"surface": 1, "conserve": 3}.get(correction, 2.01)  # lines


def test_the_drawn_hop_is_what_the_program_draws(capsys: pytest.CaptureFixture[str]) -> None:
    words = ("99 d x_m=0.29 v_mps=0.8 a_mps2=-2 CR=0.8 motion=exact fps_target=10 m_to_px=100 "
             "width_px=50 --frames 18")
    lines = film(capsys, *words.split()).lines[8:]
    assert re.findall("#     ([0-9].{34}v = .{5})", LAW) == [
        f"{n}:{line[17:50]}v = {details(line)[1]:5.2f}" for n, line in enumerate(lines)]
    assert MOTIONS["exact"](0.29, -0.8, -2, 0.1) == pytest.approx((0.20, -1.0))


@pytest.mark.parametrize(("motion", "correction"), FOUND)
def test_hops_that_lose_speed_end_where_section_7_says(motion: str, correction: str) -> None:
    def ends(CR: float, low: float, high: float, number: int) -> Iterator[set[int]]:
        """The lengths that are left, from so many starts: {1} is rest."""
        for scene in starts(motion, correction, CR, low, high, number):
            yield set(hops(scene, 150)[-20:])

    row, = re.findall(f"#     {motion} {{3,}}(.*)", LAW)
    told = re.split(" {3,}", row)[("surface", "rebound", "conserve").index(correction)]
    *lowest, highest = map(int, re.findall("[0-9]+", told) or [1])
    lowest = [1] if "rest" in told else lowest
    found = list(ends(0.9, 30, 90, 300))
    rarest, = re.findall("rarest ([0-9]+) of 100", TOLD)
    share = 1 - int(rarest) / 100
    assert sum(lengths <= {*range(lowest[0], highest + 1)} for lengths in found) >= 300 * share
    assert min(map(min, found)) == lowest[0]
    assert max(map(max, found)) >= 0.9 * highest
    k = K[motion] + K[correction]
    if correction == "surface" and k > 0:
        assert lowest[0] > k * 1.9 / 0.1  # "surface ends above n"
    if motion == "forward":  # short hops grow
        assert min(map(min, ends(0.9, 2, 17, 100))) >= 18
    rng, shortest = random.Random(f"{motion} {correction}"), []
    for CR in (rng.uniform(0.6, 0.95) for _ in range(100)):
        n = k * (1 + CR) / (1 - CR)
        lengths, = ends(CR, max(20, 2 * n), max(30, 3 * n), 1)
        shortest.append(min(lengths))
        if k > 0:  # "until they have about n/2 to 2 n"
            low, high = (n - 2.1, n + 1.3) if correction == "conserve" else (n / 2, 2 * n)
            assert low <= min(lengths) <= max(lengths) <= high
        elif k == 0 and correction == "rebound":
            assert max(lengths) < (1 + CR) / (1 - CR)  # the default
        else:
            assert lengths == {1}
    assert (min(shortest) < 2 < max(shortest)) is ((motion, correction) == ("backward", "rebound"))


def test_the_length_that_should_repeat_is_the_one_that_the_law_leaves_as_it_is() -> None:
    law, = re.findall(r"next = (CR \(hop \+ k\) \+ k) ", LAW)
    repeats, = re.findall(r"hop of n = (k \(1 \+ CR\)/\(1 - CR\)) lines repeats", TOLD)
    for text in (law, repeats):
        assert set(re.findall("[A-Za-z]+", text)) <= {"CR", "hop", "k"}
    law, repeats = (re.sub(r"(CR|k) \(", r"\1 * (", text) for text in (law, repeats))
    for CR, k in product((0.2, 0.8, 0.95), (0.5, 1, 2)):
        n = eval(repeats, {"CR": CR, "k": k})
        assert eval(law, {"CR": CR, "k": k, "hop": n}) == pytest.approx(n)


@pytest.mark.parametrize(("correction", "off_m"), [
    ("rebound", 0.9 * 2 * 0.1**2 / 1.9**2), ("surface", 0.0)])  # 5 mm
def test_at_rest_it_bounces_in_every_line_some_millimetres_off_the_wall_or_on_it(
        correction: str, off_m: float) -> None:
    scene = Scene(correction=correction, CR=0.9, a_mps2=-2)
    x_m, v_mps = 0.25 + off_m, 0.9 * 2 * 0.1 / 1.9  # v = CR (g dt - v)
    after_m, after_mps, mark_m = step(scene, x_m, v_mps, 0.1)
    assert (after_m, after_mps) == pytest.approx((x_m, v_mps))
    assert mark_m is not None


# The order of three lines. A game's loop adds gravity, settles contacts and moves the ball, in some
# order. From contact to contact, gravity-contact-position moves with the old velocity: forward +
# surface. Where the contact comes after the move, it moves with the new one: backward + surface.

ORDERS = {"gravity, contact, position": 1.5, "gravity, position, contact": -0.5,
          "contact, gravity, position": -0.5}  # and the law's k


def game(order: str, y_m: float, v_mps: float, CR: float, dt_s: float = 1 / 60) -> Iterator[
        tuple[float, float, bool]]:
    """A ball at g = 10 above a floor at 0: after each contact, y, v and whether there was one."""
    lines = order.split(", ")
    for line in (line for _ in range(2000) for line in lines):
        if line == "gravity":
            v_mps -= 10 * dt_s
        elif line == "position":
            y_m += v_mps * dt_s
        else:
            is_below = y_m < 0
            y_m, v_mps = (0.0, -CR * v_mps) if is_below else (y_m, v_mps)
            yield y_m, v_mps, is_below


def test_contacts_between_gravity_and_the_move_are_forward_and_surface() -> None:
    scene = Scene(**EXAMPLES[22].settings)
    assert (scene.motion, scene.correction) == ("forward", "surface")
    state: tuple[float, float, float | None] = (scene.x_m, scene.v_mps, None)
    begun_m = scene.x_m + scene.v_mps / 60  # the loop's own move comes last
    for y_m, v_mps, is_below in game("gravity, contact, position", begun_m, 0.0, scene.CR):
        state = step(scene, *state[:2], 1 / 60)
        assert (y_m, v_mps) == pytest.approx(state[:2], abs=1e-12)
        assert is_below is (state[2] is not None)


@pytest.mark.parametrize("CR", [1, 0.9, 0.8, 0.6])
@pytest.mark.parametrize("order", ORDERS)
def test_two_hops_of_a_loop_tell_its_k(order: str, CR: float) -> None:
    rng, ks = random.Random(f"{order} {CR}"), []
    for _ in range(500):
        falls_mps = 10 / 60 * rng.uniform(30, 60) / CR
        contacts = [n for n, (*_, is_below) in enumerate(
            game(order, rng.random() * falls_mps / 60, -falls_mps, CR)) if is_below]
        first, after = contacts[1] - contacts[0], contacts[2] - contacts[1]
        ks.append((after - CR * first) / (1 + CR))
    assert sum(ks) / len(ks) == pytest.approx(ORDERS[order], abs=0.1)


@pytest.mark.parametrize("order", ORDERS)
def test_a_ball_lies_still_but_where_contacts_are_settled_before_the_move(order: str) -> None:
    states = list(game(order, 1.0, 0.0, 0.5))[-100:]
    contacts = [n for n, (*_, is_below) in enumerate(states) if is_below]
    assert {b - a for a, b in pairwise(contacts)} == ({5} if ORDERS[order] > 0 else {1})
    height_m = max(y_m for y_m, *_ in states)
    assert height_m == pytest.approx(0.0065 if ORDERS[order] > 0 else 0, abs=5e-5)


# 6. Rewind. A car at a distance d from a wall, at u towards it, under an acceleration g towards it,
#    is there after t1 at s, with s^2 = u^2 + 2 g d, and leaves it at CR s. Until a time r later it
#    is CR s r - g r^2/2 off the wall, and rewind is right: r < 2 CR s/g, when a car that is pulled
#    to the wall is back for a second bounce; r < 2 s/|g|, when a move that is pulled off it is back
#    on the track. Later rewind puts the car on the wall, or has found no collision at all.

def test_rewind_leaves_a_car_at_rest_on_its_wall_whatever_round_off_says_of_its_speed() -> None:
    for tenths in range(1, 100):
        scene = Scene(motion="exact", correction="rewind", x_m=0.25, a_mps2=-tenths / 10)
        assert step(scene, 0.25, 0.0, 1 / 30)[0] == pytest.approx(0.25, abs=1e-12)


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
