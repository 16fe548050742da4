"""The car's motion in 60-digit decimals, written independently of the program.

One bounce after the other, each found with the textbook root of g t^2/2 + u t - d = 0, whose
cancellation does no harm in 60 digits. No summed hops: the bounces are followed one by one, until
a hop lasts less than 1e-30 s.
"""

from collections.abc import Iterator
from decimal import Context, Decimal, localcontext

from airtrack import Scene

PRECISE = Context(prec=60)
TOO_SHORT_S = Decimal("1e-30")


def states(scene: Scene, times_s: list[Decimal]) -> Iterator[tuple[Decimal, Decimal]]:
    """Position and velocity at each of the times, which ascend."""
    with localcontext(PRECISE):
        x, v, a = Decimal(scene.x_m), Decimal(scene.v_mps), Decimal(scene.a_mps2)
        walls = {-1: Decimal(scene.left_edge_m), 1: Decimal(scene.right_edge_m)}
        bounciness = Decimal(scene.CR)
        now = Decimal(0)
        for moment in times_s:
            while True:
                flight, side = min((time_to(walls[s], s, x, v, a), s) for s in walls)
                if now + flight > moment:
                    break
                now += flight
                speed_there = v + a * flight
                x, v = walls[side], -bounciness * speed_there
                if side * a > 0 and 2 * abs(v) < TOO_SHORT_S * abs(a):
                    v = a = Decimal(0)  # at rest on the wall, for good
                elif v == 0 and side * a >= 0:
                    a = Decimal(0)
            t = moment - now
            x, v, now = x + v * t + a * t * t / 2, v + a * t, moment
            yield x, v


def time_to(wall: Decimal, side: int, x: Decimal, v: Decimal, a: Decimal) -> Decimal:
    """How long the car flies until it goes outwards through the wall."""
    d, u, g = side * (wall - x), side * v, side * a
    if g == 0:
        return d / u if u > 0 else Decimal("Infinity")
    discriminant = u * u + 2 * g * d
    if discriminant < 0 or (g < 0 and (u <= 0 or discriminant < Decimal("1e-40"))):
        return Decimal("Infinity")
    return (discriminant.sqrt() - u) / g
