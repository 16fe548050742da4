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
from films import HERE

LISTING = (HERE / "airtrack.py").read_text(encoding="utf-8")
LAW = LISTING.partition("# ==== 9. ")[2].partition("# ==== 10. ")[0]
WORDS = " ".join(LAW.replace("#", "").split())
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


def any_hops(motion: str, correction: str) -> list[tuple[float, list[Hop]]]:
    """The first hops of cars at common and at random CR, each beside its CR."""
    rng = random.Random(f"{motion} {correction}")
    CRs = [1, 0.9, 0.8, 0.5, *(rng.uniform(0.1, 1) for _ in range(10))]
    return [(CR, hops) for CR in CRs for hops in random_hops(motion, correction, CR, 30, 12)]


@pytest.mark.parametrize(("motion", "correction"), METHODS)
def test_the_law_holds_in_every_hop_to_round_off(motion: str, correction: str) -> None:
    for CR, hops in any_hops(motion, correction):
        for hop, after in pairwise(hops):
            assert hop.u + hop.w == pytest.approx(hop.frames, abs=1e-9)  # (1)
            assert hop.w - hop.u == pytest.approx(hop.k, abs=1e-9)  # (2)
            assert after.u == pytest.approx(CR * hop.w, abs=1e-9)  # (3)
            assert after.frames == pytest.approx(CR * (hop.frames + hop.k) + after.k, abs=1e-9)


@pytest.mark.parametrize(("motion", "correction"), METHODS)
def test_k_is_between_the_listing_s_bounds_in_every_hop_of_two_frames_or_more_and_gets_near_them(
        motion: str, correction: str) -> None:
    low, high = BOUNDS[motion, correction]
    ks = [hop.k for _, hops in any_hops(motion, correction) for hop in hops if hop.frames > 1]
    assert low - 1e-9 < min(ks) < low + 0.1
    assert high - 0.2 < max(ks) < high + 1e-9


@pytest.mark.parametrize("motion", S)
def test_the_two_inequalities_of_the_proof_hold_in_every_hop_with_surface(motion: str) -> None:
    # Until it is found, after n frames, the car is n dt (u - (n - s) g dt/2) above the floor.
    s = S[motion]
    for _, hops in any_hops(motion, "surface"):
        for hop in hops:
            if hop.frames > 1:
                assert (hop.frames - 1 - s) / 2 - 1e-9 < hop.u < (hop.frames - s) / 2 + 1e-9
                height_m = -hop.drop_m / hop.way_m * hop.frames / 2  # in g dt^2
                assert height_m == pytest.approx(
                    hop.frames * (hop.u - (hop.frames - s) / 2), abs=1e-9)


@pytest.mark.parametrize("motion", S)
def test_with_none_at_CR_1_drop_over_way_is_from_minus_1_to_1_and_0_on_average(motion: str) -> None:
    ratios = [hop.drop_m / hop.way_m for hops in random_hops(motion, "none", 1, 100, 12)
              for hop in hops if hop.frames > 1]
    assert -1 < min(ratios) < -0.9 < 0.9 < max(ratios) < 1
    assert sum(ratios) / len(ratios) == pytest.approx(0, abs=0.1)


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


@pytest.mark.parametrize("CR", [0.3, 0.5, 0.7, 0.8, 0.9])
@pytest.mark.parametrize(("motion", "correction"), [
    method for method in METHODS if method != ("backward", "rebound")])
def test_at_CR_below_1_hops_end_in_one_length_or_with_rebound_in_a_cycle_and_k_says_which(
        motion: str, correction: str, CR: float) -> None:
    low, high = [k * (1 + CR) / (1 - CR) for k in BOUNDS[motion, correction]]
    for hops in random_hops(motion, correction, CR, 40, 600 if CR == 0.9 else 250):
        last = cycle(hops)
        frames = [hop.frames for hop in last]
        assert len(last) == 1 or correction == "rebound"
        assert high >= 2 or frames == [1]  # all hops die out
        assert low < 2 or min(frames) > 1  # none does
        if min(frames) > 1:
            assert low - 1e-6 < sum(frames) / len(frames) < high + 1e-6
        if len(frames) == 1 and min(frames) > 1:
            hop, = last
            assert hop.k == pytest.approx(hop.frames * (1 - CR) / (1 + CR), abs=1e-6)
            assert hop.w == pytest.approx(hop.k / (1 - CR), abs=1e-6)


def test_with_backward_and_rebound_at_CR_below_1_some_cars_rest_and_others_hop_on() -> None:
    longest = {max(hop.frames for hop in hops[-100:])
               for hops in random_hops("backward", "rebound", 0.8, 40, 250)}
    assert min(longest) == 1 < max(longest) <= 9


# The listing's drawn hop and its worked numbers.

def number_text(number: float) -> str:
    return f"{number:.10g}"


def test_the_drawn_hop_and_the_numbers_of_its_three_steps_are_the_program_s() -> None:
    motion, correction, *values = re.findall(
        r"a hop with (\w+) \+ (\w+)\. CR is (.*?), g is (.*?) m/s\^2, dt is (.*?) s, and a column "
        r"is 1 cm", WORDS)[0]
    CR, g, dt = map(float, values)
    u = float(re.findall(r"\(\*\), with u = (.*) m/s upwards", LAW)[0])
    floor_m = 0.1
    scene = Scene(motion=motion, correction=correction, CR=CR, a_mps2=-g, x_m=floor_m, v_mps=u,
                  left_edge_m=floor_m, fps_target=1 / dt, m_to_px=100, width_px=40)
    x_m, v_mps, mark_m = floor_m, u, None
    drawn = [render_track(scene, {"*": x_m}, mark_m)]
    while mark_m is None:
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt)
        drawn.append(render_track(scene, {"*": x_m}, mark_m))
    told = re.findall(r"(?m)^#     (\d):  ([0 ] +[*|].{0,19})", LAW)
    assert [int(frame) for frame, _ in told] == list(range(len(drawn)))
    for (_, line), again in zip(told, drawn, strict=True):
        assert line.rstrip() == again[4:].rstrip()

    hop, after = measured(replace(scene, v_mps=g * dt - u), 2)  # a frame before, with a collision
    assert hop.frames == len(drawn) - 1
    assert hop.u * g * dt == pytest.approx(u)
    w, drop_cm, way_cm = hop.w * g * dt, 100 * hop.drop_m, 100 * hop.way_m
    n, s = number_text, S[motion]
    passage = WORDS.partition("Here is a hop")[2].partition("How large is k?")[0]
    for figure, values_told in (
            (r"(\S+) cm", [1, drop_cm, way_cm, 100 * after.drop_m, 100 * after.way_m]),
            (r"(\S+) frames", [hop.frames, after.frames]), (r"= (\S+) m/s ", [u, w])):
        told_once = dict.fromkeys(re.findall(figure, passage))
        assert list(told_once) == [n(value) for value in values_told]
    for equation in (
            f"here {n(u)} + {n(w)} = {hop.frames} * {n(g * dt)} ",
            f"here ({n(w**2)} - {n(u**2)})/2 = {n(g)} * {n(drop_cm / 100)} + {s} ",
            f"here k = {s} + {n(drop_cm)}/{n(way_cm)}, and {n(w)} - {n(u)} = k * {n(g * dt)} ",
            f"here {after.frames} = {n(CR)} ({hop.frames} + 1/2) + 1/2 "):
        assert equation in passage
    assert "k' is 1/2" in passage
    assert (hop.k, after.k) == pytest.approx((0.5, 0.5))


def test_the_law_s_examples_19_and_20_have_the_k_that_is_told() -> None:
    assert "Example 19 is backward + surface at CR = 1. Its k is below 0 in each hop" in WORDS
    nineteen = Scene(**EXAMPLES[19].settings)
    assert (nineteen.motion, nineteen.correction, nineteen.CR) == ("backward", "surface", 1)
    assert all(hop.k < 0 for hop in measured(nineteen, 100) if hop.frames > 1)
    twenty = Scene(**EXAMPLES[20].settings)
    assert (twenty.motion, twenty.correction) == ("exact", "rebound")
    CR, k, k_again, above, below, frames = re.findall(
        r"Example 20 is exact \+ rebound at CR = (.*?)\. .*? k = (.*?), .*? (\S+) \* (\S+)/(\S+) = "
        r"(\d+) frames", WORDS)[0]
    assert [float(CR), float(above), float(below)] == pytest.approx([
        twenty.CR, 1 + twenty.CR, 1 - twenty.CR])
    last = cycle(measured(twenty, 150))
    assert [(hop.frames, round(hop.k, 6)) for hop in last] == [(int(frames), float(k))]
    assert k == k_again


def test_the_lengths_and_the_cycle_that_are_told_occur() -> None:
    CR, k, least, most = re.findall(
        r"exact \+ surface at CR = (\S+) k is at most (\d), .*? (\d) to (\d) frames", WORDS)[0]
    assert int(k) == BOUNDS["exact", "surface"][1]
    assert int(most) == round(int(k) * (1 + float(CR)) / (1 - float(CR)), 9)
    assert int(least) == 2
    told, = re.findall(r"in a cycle, as ([\d ]+)\.", WORDS)
    cycles = [" ".join(str(hop.frames) for hop in cycle(hops) * 2)
              for hops in random_hops("exact", "rebound", 0.8, 40, 250)]
    assert any(told in each for each in cycles)


def test_a_ball_dropped_from_rest_may_repeat_one_hop_with_backward_and_surface_at_CR_1() -> None:
    scene = Scene(**EXAMPLES[22].settings | {"CR": 1, "motion": "backward"})
    hops = measured(scene, 200)[2:]
    assert {hop.frames for hop in hops} == {54}
    assert all(hop.k == pytest.approx(0, abs=1e-9) for hop in hops)
