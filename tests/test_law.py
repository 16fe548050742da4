"""The law of the hops, in rational numbers: no round-off decides when a hop ends.

A hop goes from a frame in which a collision is found to the next such frame. u is its first speed,
upwards, where the correction has put the car. w is its last, downwards, where its last move ended.
"""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airtrack import Track, step
from reference import Rational, rationals

DT_S: Rational = Fraction(1, 10)
G_MPS2: Rational = Fraction(4)
G_DT_MPS = G_MPS2 * DT_S

class Hop(NamedTuple):
    frames: int
    u_mps: Rational
    w_mps: Rational

cars = st.fixed_dictionaries({
    "CR": rationals(0.05, 1), "height_m": rationals(0, 1), "speed_mps": rationals(0.1, 8),
    "up": st.sampled_from([-1, 1])})  # 1 if the floor is the left wall

def hops(motion: str, correction: str, CR: Rational, height_m: Rational, speed_mps: Rational,
         up: int) -> list[Hop]:
    """Six hops of a car that falls to its floor, at 0, read from the program's frames."""
    track = Track(motion=motion, correction=correction, a_mps2=-up * G_MPS2, CR=CR,
                  left_edge_m=min(0, 1000 * up), right_edge_m=max(0, 1000 * up))
    endless = replace(track, left_edge_m=-1000, right_edge_m=1000)
    x_m, v_mps, u_mps = up * height_m, -up * speed_mps, None
    frames = 0
    found: list[Hop] = []
    while len(found) < 6:
        frames += 1
        _, moved_mps, _ = step(endless, x_m, v_mps, DT_S)
        x_m, v_mps, mark_m = step(track, x_m, v_mps, DT_S)
        if mark_m is None:
            continue
        if u_mps is not None:
            found.append(Hop(frames, u_mps, -up * moved_mps))
        x_m, v_mps = Fraction(x_m), Fraction(v_mps)  # the 0.0 of surface is a float
        u_mps = up * v_mps
        frames = 0
    return found

@pytest.mark.parametrize(("motion", "correction", "least", "largest"), [
    ("forward", "surface", 1, 2), ("forward", "rebound", 1, 3),
    ("exact", "surface", 0, 1), ("exact", "rebound", 0, 2),
    ("backward", "surface", -1, 0), ("backward", "rebound", -1, 1)])
@given(car=cars)
@settings(max_examples=50)
def test_next_w_is_CR_w_and_k_g_dt_and_k_is_within_the_table_s_bounds(
        motion: str, correction: str, least: int, largest: int, car: dict[str, Rational]) -> None:
    for hop, after in pairwise(hops(motion, correction, **car)):
        k = after.frames - 2 * after.u_mps / G_DT_MPS
        assert after.w_mps == car["CR"] * hop.w_mps + k * G_DT_MPS
        assert after.frames == 1 or least < k <= largest

@pytest.mark.parametrize(("motion", "more"), [("forward", 1), ("exact", 0), ("backward", -1)])
@given(car=cars)
@settings(max_examples=50)
def test_u_alone_foretells_the_frames_of_a_hop_from_the_surface(
        motion: str, more: int, car: dict[str, Rational]) -> None:
    for hop in hops(motion, "surface", **car):
        next_whole_number = math.floor(2 * hop.u_mps / G_DT_MPS) + 1
        assert hop.frames == max(next_whole_number + more, 1)

@given(car=cars)
def test_exact_and_conserve_leave_CR_of_the_speed_in_each_hop(car: dict[str, Rational]) -> None:
    for hop, after in pairwise(hops("exact", "conserve", **car)):
        assert after.u_mps == pytest.approx(float(car["CR"] * hop.u_mps), abs=1e-7)
