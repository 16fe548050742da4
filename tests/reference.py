"""The car's motion in 60-digit decimals, written independently, and rational numbers.

In decimals each flight ends at the textbook root of g t^2/2 + u t - d = 0, as its cancellation does
no harm in 60 digits. The bounces are followed one by one, until a hop lasts less than 1e-30 s.
"""

from decimal import Context, Decimal, localcontext
from fractions import Fraction
from typing import Any

from hypothesis import strategies as st

from airtrack import Track

Rational = Any  # a Fraction: the program takes it for a float, but mypy does not
PRECISE = Context(prec=60)
TOO_SHORT_S = Decimal("1e-30")
NEVER_S = Decimal("Infinity")
GRAZE = Decimal("2.5e-11")  # of the track: a turn less than this beyond a wall is a miss

def rationals(least: float, largest: float) -> st.SearchStrategy[Rational]:
    """Thousandths from least to largest."""
    thousandths = st.integers(round(1000 * least), round(1000 * largest))
    return thousandths.map(lambda number: Fraction(number, 1000))

def states(track: Track, times_s: list[Decimal]) -> list[tuple[Decimal, Decimal]]:
    """Position and velocity at each of the times, which ascend."""
    found = []
    with localcontext(PRECISE):
        x_m, v_mps, a_mps2 = Decimal(track.x_m), Decimal(track.v_mps), Decimal(track.a_mps2)
        walls_m = {-1: Decimal(track.left_edge_m), 1: Decimal(track.right_edge_m)}
        graze_m = GRAZE * (walls_m[1] - walls_m[-1])
        now_s = Decimal(0)
        for moment_s in times_s:
            while True:
                flight_s, side = min(
                    (time_to(side * (at_m - x_m), side * v_mps, side * a_mps2, graze_m), side)
                    for side, at_m in walls_m.items())
                if now_s + flight_s > moment_s:
                    break
                now_s += flight_s
                x_m = walls_m[side]
                v_mps = -Decimal(track.CR) * (v_mps + a_mps2 * flight_s)
                if side * a_mps2 > 0 and 2 * abs(v_mps) < TOO_SHORT_S * abs(a_mps2):
                    v_mps = a_mps2 = Decimal(0)  # at rest on the wall, for good
            left_s = moment_s - now_s
            x_m += v_mps * left_s + a_mps2 * left_s * left_s / 2
            v_mps += a_mps2 * left_s
            now_s = moment_s
            found.append((x_m, v_mps))
    return found

def time_to(d: Decimal, u: Decimal, g: Decimal, graze_m: Decimal) -> Decimal:
    """How long the car flies until it goes outwards through a wall: d ahead, at the speed u."""
    if g == 0:
        return d / u if u > 0 else NEVER_S
    discriminant = u * u + 2 * g * d
    if g < 0 and (u <= 0 or discriminant < -2 * g * graze_m):
        return NEVER_S  # it moves away, or turns before it is there
    return (discriminant.sqrt() - u) / g
