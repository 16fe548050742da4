"""The law of the hops: exact in every hop, its averages, and what it means.

A hop is counted in lines, from one in which a collision is found to the next.
"""

import random
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import pytest

from airtrack import MOTIONS, Scene, step
from examples import EXAMPLES
from films import HERE, hops, states_of

LISTING = (HERE / "airtrack.py").read_text()
LAW = LISTING.partition("# ==== 8. ")[2].partition("# ==== 9. ")[0]
LAW = " ".join(LAW.replace("#", "").split())
MOTION = {"forward": 1, "exact": 0, "backward": -1}
CORRECTION = {"surface": 0.5, "rebound": 1.0, "none": 0.0, "conserve": 0.0}


class Hop(NamedTuple):
    """One hop: its lines, first and last speed, and k, measured from the positions."""

    lines: int
    u_mps: float
    w_mps: float
    k: float


def starts(motion: str, correction: str, CR: float, number: int, low: float = 45,
           high: float = 85) -> Iterator[Scene]:
    """Cars about to meet the wall to which they are accelerated, for hops of so many lines."""
    rng = random.Random(f"{motion} {correction} {CR}")
    for _ in range(number):
        dt_s, g_mps2, side = rng.uniform(0.01, 0.1), rng.uniform(1, 10), rng.choice([-1, 1])
        w_mps = g_mps2 * dt_s * rng.uniform(low, high) / 2 / CR
        yield Scene(
            motion=motion, correction=correction, CR=CR, a_mps2=side * g_mps2, v_mps=side * w_mps,
            x_m=-side * rng.random() * w_mps * dt_s, fps_target=1 / dt_s,
            left_edge_m=min(0, -1000 * side), right_edge_m=max(0, -1000 * side))


def measured(scene: Scene, number: int) -> list[Hop]:
    """The first hops of a scene on the floor at x = 0, with k = m + drop/way."""
    side, dt_s = (1 if scene.a_mps2 > 0 else -1), 1 / scene.fps_target
    g_mps2 = abs(scene.a_mps2)
    x_m, v_mps, line, begun = scene.x_m, scene.v_mps, 0, list[tuple[int, float, float]]()
    found: list[Hop] = []
    while len(found) < number:
        line += 1
        _, moved_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, dt_s)
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        if mark_m is not None:
            for first_line, first_m, u_mps in begun[-1:]:
                lines = line - first_line
                drop_m = side * (mark_m - first_m)
                way_m = lines * g_mps2 * dt_s**2 / 2
                k = MOTION[scene.motion] + drop_m / way_m
                found.append(Hop(lines, u_mps, side * moved_mps, k))
            begun.append((line, x_m, -side * v_mps))
    return found


@pytest.mark.parametrize("CR", [1, 0.9, 0.8, 0.5])
@pytest.mark.parametrize("correction", ["surface", "rebound", "none"])
@pytest.mark.parametrize("motion", MOTION)
def test_the_law_holds_in_every_hop_to_round_off(motion: str, correction: str, CR: float) -> None:
    if correction == "none" and CR < 1:
        return  # the car is caught: no law is claimed
    for scene in starts(motion, correction, CR, 60):
        found = measured(scene, 6)
        g_dt_mps = abs(scene.a_mps2) / scene.fps_target
        for hop, after in pairwise(found):
            if correction == "none" and min(hop.lines, after.lines) == 1:
                break  # it is caught
            assert hop.u_mps + hop.w_mps == pytest.approx(hop.lines * g_dt_mps)  # (1)
            assert hop.w_mps - hop.u_mps == pytest.approx(hop.k * g_dt_mps, abs=1e-9)  # (2)
            assert after.lines == pytest.approx(CR * (hop.lines + hop.k) + after.k, abs=1e-9)  # (3)


@pytest.mark.parametrize("motion", MOTION)
@pytest.mark.parametrize("correction", ["surface", "rebound", "none"])
def test_drop_over_way_is_on_average_a_half_one_and_none(motion: str, correction: str) -> None:
    ks = [hop.k for scene in starts(motion, correction, 1, 400) for hop in measured(scene, 1)
          if hop.lines > 1]
    assert sum(ks) / len(ks) == pytest.approx(MOTION[motion] + CORRECTION[correction], abs=0.08)


@pytest.mark.parametrize(("motion", "mean"), [("forward", 1), ("exact", 0), ("backward", -1)])
def test_with_conserve_the_law_holds_on_average_with_0(motion: str, mean: int) -> None:
    for CR in (1, 0.8):
        off = []
        for scene in starts(motion, "conserve", CR, 400):
            hop, after = hops(scene, 2)
            off.append(after - CR * (hop + mean) - mean)
        assert abs(sum(off) / len(off)) < 0.15
        assert sum(abs(lines) < 1.2 for lines in off) >= 0.9 * len(off)


def test_the_first_hops_of_example_20_have_the_figures_of_the_listing() -> None:
    scene = Scene(**EXAMPLES[20].settings)
    shifted = Scene(**vars(scene) | {"x_m": scene.x_m - 0.25, "left_edge_m": 0})
    first, second, *_ = measured(shifted, 2)
    assert (first.lines, second.lines) == (14, 12)
    assert (round(first.k, 9), round(second.k, 9)) == (0.8, 0.16)
    for told in ("has 14 lines, a drop of 11.2 cm and a way of 14 cm, so k is 0.8",
                 "a drop of 1.92 cm and a way of 12 cm, so k' is 0.16",
                 "0.8 (14 + 0.8) + 0.16 = 12.0 lines"):
        assert told in LAW
    assert pytest.approx((11.2, 1.92)) == (0.8 * 14, 0.16 * 12)
    assert pytest.approx(12.0) == 0.8 * (14 + 0.8) + 0.16


def last_hops(scene: Scene) -> list[int]:
    return hops(scene, 160)[-20:]


@pytest.mark.parametrize("motion", MOTION)
@pytest.mark.parametrize("correction", ["surface", "rebound", "conserve"])
def test_at_CR_1_hops_grow_if_k_is_above_0_and_end_in_rest_if_it_is_below(
        motion: str, correction: str) -> None:
    k = MOTION[motion] + CORRECTION[correction]
    longer = []
    for scene in starts(motion, correction, 1, 300):
        lines = hops(scene, 20 if k > 0 else 200)
        longer.append((lines[-1] - lines[0]) / (len(lines) - 1))
        assert k >= 0 or set(lines[-20:]) == {1}
    if k > 0:
        assert sum(longer) / len(longer) == pytest.approx(2 * k, abs=0.1)
        assert min(longer) >= 0


@pytest.mark.parametrize("CR", [0.9, 0.8, 0.6])
@pytest.mark.parametrize(("motion", "correction"), [
    (motion, correction) for motion in MOTION for correction in ("surface", "rebound", "conserve")])
def test_at_CR_below_1_hops_end_near_the_length_that_repeats_if_it_is_two_lines_or_more(
        motion: str, correction: str, CR: float) -> None:
    k = MOTION[motion] + CORRECTION[correction]
    largest_k = MOTION[motion] + 2 * CORRECTION[correction]  # the drop of a hop that repeats
    repeats = k * (1 + CR) / (1 - CR)
    for scene in starts(motion, correction, CR, 40, 40, 90):
        lines = last_hops(scene)
        assert max(lines) <= max(1, largest_k * (1 + CR) / (1 - CR)) + 1.5
        if repeats >= 2:
            assert min(lines) > 1  # it never comes to rest
            assert min(lines) >= 0.4 * repeats - 1
        elif largest_k <= 0:
            assert set(lines) == {1}


@pytest.mark.parametrize("CR", [0.5, 0.8, 0.9])
def test_a_bounce_below_2_g_dt_over_1_minus_CR_set_to_0_is_enough_with_forward_and_surface(
        CR: float) -> None:
    for scene in starts("forward", "surface", CR, 200):
        g_dt_mps = abs(scene.a_mps2) / scene.fps_target
        slowest = min(hop.w_mps for hop in measured(scene, 100)[-10:])
        assert CR * slowest < 2 * g_dt_mps / (1 - CR)


def test_a_ball_dropped_from_rest_may_repeat_one_hop_with_backward_and_surface() -> None:
    found = hops(Scene(**EXAMPLES[22].settings | {"CR": 1, "motion": "backward"}), 200)
    assert set(found[2:]) == {54}
    scene = Scene(**EXAMPLES[22].settings | {"CR": 1, "motion": "backward"})
    top_m = max(x_m for x_m, *_ in states_of(scene, 2000)[200:])
    assert top_m == pytest.approx(0.975, abs=5e-4)
    growing = hops(Scene(**EXAMPLES[22].settings | {"CR": 1, "right_edge_m": 9}), 6)
    assert {after - before for before, after in pairwise(growing)} == {4}  # 2 k, and k is 2


# The order of three lines. A game adds gravity, settles contacts and moves the ball, in a circle.

ORDERS = {"contact, gravity, position": 0, "gravity, position, contact": 0,
          "position, contact, gravity": 0, "contact, position, gravity": 16,
          "gravity, contact, position": 16, "position, gravity, contact": 16}


def game(order: str, CR: float, frames: int) -> tuple[list[int], list[float]]:
    """A ball from 1 m at g = 10, 60 FPS: the frames with a contact, and its drawn heights."""
    y_m, v_mps, dt_s, contacts, heights_m = 1.0, 0.0, 1 / 60, [], []
    for frame in range(frames):
        for line in order.split(", "):
            if line == "gravity":
                v_mps -= 10 * dt_s
            elif line == "position":
                y_m += v_mps * dt_s
            elif y_m < 0:
                contacts.append(frame)
                y_m, v_mps = 0.0, -CR * v_mps
        heights_m.append(y_m)
    return contacts, heights_m


@pytest.mark.parametrize("order", ORDERS)
def test_three_orders_come_to_rest_and_the_other_three_hop_for_ever(order: str) -> None:
    for CR in (0.5, 0.8, 0.9):
        contacts, heights_m = game(order, CR, 6000)
        last = {after - before for before, after in pairwise(contacts[-40:])}
        assert (max(last) > 2) is (ORDERS[order] > 0)
        if CR == 0.8 and ORDERS[order]:
            assert last == {16}
            assert max(heights_m[-100:]) == pytest.approx(0.080, abs=6e-3)
        elif not ORDERS[order]:
            below_m = 10 / 60**2 / (1 + CR)  # g dt^2/(1 + CR), if the contact is not settled last
            rests_m = {"contact, gravity, position": -below_m}.get(order, 0.0)
            assert heights_m[-1] == pytest.approx(rests_m, abs=below_m * 1.01)
