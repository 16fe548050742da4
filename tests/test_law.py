"""The law of the hops, the bounds of k and what they mean, measured in the program's films.

A hop is counted in frames, from one in which a collision is found to the next. Its first speed u is
upwards, where the correction has put the car; its last speed w is downwards, where its last move
has ended.
"""

import random
import re
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import pytest

from airtrack import MOTIONS, Scene, render_track, step
from examples import EXAMPLES
from films import LISTING, running_text, sides, value

LAW = LISTING.partition("# ==== 9. ")[2].partition("# ==== 10. ")[0]
WORDS = running_text(LAW)
S = {"forward": 1, "exact": 0, "backward": -1}  # what a frame does to the energy, in g^2 dt^2/2
METHODS = [(motion, correction) for motion in S for correction in ("surface", "rebound")]
BOUNDS = {(motion, correction): (int(low), int(high))
          for motion, *row in re.findall(
              r"(?m)^#     (\w+) +(-?\d) to (-?\d) +(-?\d) to (-?\d)$", LAW)
          for correction, low, high in (("surface", *row[:2]), ("rebound", *row[2:]))}


class Hop(NamedTuple):
    """One hop: its frames, its speeds in g dt, and drop and way in m."""

    frames: int
    u: float
    w: float
    drop_m: float
    way_m: float
    k: float  # from the places: s + drop/way


def measured(scene: Scene, number: int) -> list[Hop]:
    """The first hops of a scene on the wall to which it is accelerated."""
    down, dt_s = (1 if scene.a_mps2 > 0 else -1), 1 / scene.fps_target
    g_mps2 = abs(scene.a_mps2)
    x_m, v_mps, frame = scene.x_m, scene.v_mps, 0
    begun: tuple[int, float, float] | None = None
    found: list[Hop] = []
    while len(found) < number:
        frame += 1
        _, moved_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, dt_s)
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        if mark_m is None:
            continue
        if begun is not None:
            first, first_m, u_mps = begun
            drop_m, way_m = down * (mark_m - first_m), (frame - first) * g_mps2 * dt_s**2 / 2
            found.append(Hop(frame - first, u_mps / g_mps2 / dt_s, down * moved_mps / g_mps2 / dt_s,
                             drop_m, way_m, S[scene.motion] + drop_m / way_m))
        begun = frame, x_m, -down * v_mps
    return found


def random_scene(rng: random.Random, motion: str, correction: str, CR: float) -> Scene:
    """A car about to meet the floor, at any g and dt, for a first hop of 2 to 80 frames."""
    dt_s, g_mps2, down = rng.uniform(0.01, 0.1), rng.uniform(1, 10), rng.choice([-1, 1])
    w_mps = g_mps2 * dt_s * rng.uniform(2, 80) / 2 / CR
    return Scene(
        motion=motion, correction=correction, CR=CR, a_mps2=down * g_mps2, v_mps=down * w_mps,
        x_m=-down * rng.random() * w_mps * dt_s, fps_target=1 / dt_s,
        left_edge_m=min(0, -1000 * down), right_edge_m=max(0, -1000 * down))


@cache
def random_hops(motion: str, correction: str, CR: float, cars: int,
                number: int) -> list[list[Hop]]:
    """The first hops of some cars."""
    rng = random.Random(f"{motion} {correction} {CR}")
    return [measured(random_scene(rng, motion, correction, CR), number) for _ in range(cars)]


FORMULAS = (
    "w - u = k * g * dt", "w + u = hop * g * dt", "next = CR * (hop + k) + k'",
    "w = (hop + k) * g * dt/2", "u = (hop - k) * g * dt/2", "drop = (k - s) * hop * g * dt^2/2")
OF_EXACT = "drop = (w - u)/2 * hop * dt", "drop = k * hop * g * dt^2/2"


@pytest.mark.parametrize(("motion", "correction"), METHODS)
def test_in_every_hop_the_law_holds_and_k_is_between_the_listing_s_bounds_and_gets_near_them(
        motion: str, correction: str) -> None:
    formulas = FORMULAS + OF_EXACT if motion == "exact" else FORMULAS
    for formula in formulas:
        assert f" {formula} " in WORDS
    ks = []
    for CR in (1, 0.91, 0.8, 0.67, 0.5, 0.23):
        for hops in random_hops(motion, correction, CR, 30, 12):
            for hop, after in pairwise(hops):
                values = {
                    "g": 1, "dt": 1, "CR": CR, "hop": hop.frames, "next": after.frames,
                    "u": hop.u, "w": hop.w, "k": hop.k, "next_k": after.k, "s": S[motion],
                    "drop": hop.drop_m / hop.way_m * hop.frames / 2}  # with g and dt as units
                for formula in formulas:
                    left, right = sides(formula, **values)
                    assert left == pytest.approx(right, abs=1e-9), formula
            ks += [hop.k for hop in hops if hop.frames > 1]
    low, high = BOUNDS[motion, correction]
    assert low - 1e-9 < min(ks) < low + 0.1
    assert high - 0.2 < max(ks) < high + 1e-9


# What k does.

@pytest.mark.parametrize(("motion", "correction"), METHODS)
def test_at_CR_1_hops_grow_where_k_is_above_0_and_end_in_rest_where_it_is_below(
        motion: str, correction: str) -> None:
    low, high = BOUNDS[motion, correction]
    changes = set[int]()
    for hops in random_hops(motion, correction, 1, 60, 12 if low >= 0 else 120):
        frames = [hop.frames for hop in hops if hop.frames > 1]
        changes.update(after - before for before, after in pairwise(frames))
        assert high > 0 or hops[-1].frames == 1
    assert (min(changes) < 0, max(changes) > 0) == (low < 0, high > 0)
    assert low < 0 or 0 not in changes  # each hop is longer


def cycle(hops: list[Hop]) -> list[Hop]:
    """The hops that repeat, all through the last hundred."""
    frames = [hop.frames for hop in hops[-100:]]
    for length in range(1, 50):
        if frames[length:] == frames[:-length]:
            return hops[-length:]
    raise AssertionError(f"no cycle: {frames}")


@pytest.mark.parametrize("CR", [0.3, 0.5, 0.8, 0.9])
@pytest.mark.parametrize(("motion", "correction"), [
    method for method in METHODS if method != ("backward", "rebound")])  # it may find no cycle
def test_at_CR_below_1_hops_end_in_one_length_or_with_rebound_in_a_cycle_and_k_says_which(
        motion: str, correction: str, CR: float) -> None:
    low, high = [k * (1 + CR) / (1 - CR) for k in BOUNDS[motion, correction]]
    for hops in random_hops(motion, correction, CR, 15, 600 if CR == 0.9 else 250):
        frames = [hop.frames for hop in cycle(hops)]
        assert len(frames) == 1 or correction == "rebound"
        assert high >= 2 or frames == [1]  # all hops die out
        assert low < 2 or min(frames) > 1  # none does


# The listing's drawn hop and its worked numbers.

def test_the_drawn_hop_and_the_numbers_of_its_three_steps_are_the_program_s() -> None:
    CR, g, dt, u, floor_m = 1, 4, 0.1, 1.1, 0.1
    scene = Scene(motion="exact", correction="surface", CR=CR, a_mps2=-g, x_m=floor_m, v_mps=u,
                  left_edge_m=floor_m, fps_target=1 / dt, m_to_px=100, width_px=40)
    x_m, v_mps, mark_m = floor_m, float(u), None
    drawn = [render_track(scene, {"*": x_m}, mark_m)]
    while mark_m is None:
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt)
        drawn.append(render_track(scene, {"*": x_m}, mark_m))
    told = re.findall(r"(?m)^#     (\d):  ([0 ] +[*|].{0,19})", LAW)
    assert [(int(frame), line.rstrip()) for frame, line in told] == [
        (frame, line[4:].rstrip()) for frame, line in enumerate(drawn)]

    hop, after = measured(replace(scene, v_mps=g * dt - u), 2)  # a frame before, with a collision
    assert hop.u * g * dt == pytest.approx(u)
    assert (hop.k, after.k) == pytest.approx((0.5, 0.5))
    w, drop, way = (f"{number:.10g}" for number in (
        hop.w * g * dt, 100 * hop.drop_m, 100 * hop.way_m))
    g_dt = f"{g * dt:.10g}"
    for sentence in (
            f"exact + surface. CR is {CR}, g is {g} m/s^2, dt is {dt} s, and a column is 1 cm.",
            f"with u = {u} m/s upwards",
            f"The hop ends {drop} cm lower (0), with w = {w} m/s downwards.",
            f"This hop has {hop.frames} frames.",
            f"here {w} - {u} = k * {g_dt}, so k is 1/2 ",
            f"here {after.frames} = {CR} * ({hop.frames} + 1/2) + 1/2 ",
            f"is followed by one of {after.frames} frames, which has k' = 1/2, too",
            f"here {w} + {u} = {hop.frames} * {g_dt} ",
            f"here {w} = ({hop.frames} + 1/2) * {g * dt / 2:.10g} ",
            f"here {u} = ({hop.frames} - 1/2) * {g * dt / 2:.10g} ",
            f"Here it is {drop} cm.",
            f"here {drop} cm = {(hop.w * g * dt - u) / 2:.10g} m/s * {hop.frames} * {dt} s ",
            f"here {drop} cm = 1/2 * {way} cm "):
        assert sentence in WORDS


@pytest.mark.parametrize(("motion", "after_n", "bounds"), [
    ("exact", "height after n frames = n * dt * {}", "So k is more than {} and at most {}."),
    ("forward", "With forward, {} stands there", "and k is more than {} and at most {}."),
    ("backward", "With backward it is {}, and", "and k is more than {} and at most {}.")])
def test_the_proof_holds_in_every_hop_of_two_frames_or_more(
        motion: str, after_n: str, bounds: str) -> None:
    factor, = re.findall(re.escape(after_n).replace(r"\{\}", r"(\(u - .*? \* g \* dt/2\))"), WORDS)
    assert bounds.format(*BOUNDS[motion, "surface"]) in WORDS
    assert "for n = hop it is below 0: u is less than hop * g * dt/2" in WORDS
    assert "for n = hop - 1 it is not: u is at least (hop - 1) * g * dt/2" in WORDS
    assert "by (2): u is (hop - k) * g * dt/2" in WORDS
    assert "Let s be 1 for forward, 0 for exact and -1 for backward" in WORDS  # as S has them
    for hops in random_hops(motion, "surface", 0.9, 20, 20):
        for hop in [hop for hop in hops if hop.frames > 1]:
            height, rise = 0.0, hop.u
            for n in range(1, hop.frames + 1):
                moved, rise = MOTIONS[motion](0, rise, -1, 1)
                height += moved
                assert (height < -1e-9) is (n == hop.frames)
                assert height == pytest.approx(n * value(factor, u=hop.u, n=n, g=1, dt=1), abs=1e-9)


def test_with_rebound_k_is_up_to_1_larger() -> None:
    assert "so its drop may be larger, and k up to 1 larger." in WORDS
    for motion in S:
        low, high = BOUNDS[motion, "surface"]
        assert BOUNDS[motion, "rebound"] == (low, high + 1)


def test_the_hop_that_repeats_and_the_k_of_a_speed() -> None:
    for formula in ("k * (1 + CR)/(1 - CR)", "hop = CR * (hop + k) + k,",
                    "hop * (1 - CR) = k * (1 + CR)", "By (2), k is hop - 2 * u/(g * dt)."):
        assert formula in WORDS
    for CR, k in ((0.8, 1.5), (0.3, 0.7)):
        hop = value("k * (1 + CR)/(1 - CR)", CR=CR, k=k)
        assert hop == pytest.approx(value("CR * (hop + k) + k", CR=CR, k=k, hop=hop))
        u = value("(hop - k) * g * dt/2", hop=hop, k=k, g=2, dt=3)
        assert k == pytest.approx(value("hop - 2 * u/(g * dt)", hop=hop, u=u, g=2, dt=3))


def test_examples_19_and_20_have_the_k_that_is_told() -> None:
    nineteen = Scene(**EXAMPLES[19].settings)
    g_dt = -nineteen.a_mps2 / nineteen.fps_target
    method = f"{nineteen.motion} + {nineteen.correction}"
    assert f"Example 19 is {method} at CR = {nineteen.CR:g}," in WORDS
    assert f"g * dt is {g_dt} m/s, and the start velocity is {nineteen.v_mps} m/s." in WORDS
    assert f"Each frame changes the velocity by {g_dt} m/s" in WORDS
    assert all(hop.k < 0 for hop in measured(nineteen, 100) if hop.frames > 1)
    twenty = Scene(**EXAMPLES[20].settings)
    hop, = cycle(measured(twenty, 150))
    assert hop.k == pytest.approx(1, abs=1e-6)
    method = f"{twenty.motion} + {twenty.correction}"
    length = f"1 * {1 + twenty.CR}/{1 - twenty.CR:.10g} = {hop.frames} frames"
    assert (f"Example 20 is {method} at CR = {twenty.CR}. "
            f"From its start the hops get to k = 1, so to {length}") in WORDS


def test_the_lengths_and_the_cycle_that_are_told_occur() -> None:
    assert "With exact + surface at CR = 0.8 k is at most 1, so the hops that repeat" in WORDS
    assert f"have 2 to {BOUNDS['exact', 'surface'][1] * 1.8 / 0.2:.0f} frames" in WORDS
    told, = re.findall(r"in a cycle, as ([\d ]+) with exact \+ rebound at CR = 0.8\.", WORDS)
    cycles = [" ".join(str(hop.frames) for hop in cycle(hops) * 2)
              for hops in random_hops("exact", "rebound", 0.8, 40, 250)]
    assert any(told in each for each in cycles)


def test_a_ball_dropped_from_rest_may_repeat_one_hop_with_backward_and_surface_at_CR_1() -> None:
    hops = measured(Scene(**EXAMPLES[22].settings | {"CR": 1, "motion": "backward"}), 50)[2:]
    assert all(hop.k == pytest.approx(0, abs=1e-9) for hop in hops)
