"""What the parts of a frame cost, as ratios: python tests/benchmark.py

Not a test, which must not depend on a machine's speed. Costs are the least of several runs.
"""

import io
import sys
import time
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from timeit import repeat

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from airtrack import Scene, cost_us, run
from examples import EXAMPLES

FRAMES = 20_000
BARE = """\
v += a * dt
x += v * dt
if not left <= x <= right:
    wall = left if x < left else right
    x, v = wall - CR * (x - wall), -CR * v
"""  # a step of example 8, written out: backward + rebound
START = "x, v, a, dt, left, right, CR = 2.0, 0.0, -2.0, 0.1, 0.25, 2.2, 1.0"


def frame_us(scene: Scene) -> float:
    """A frame of its film, printed into memory."""
    with redirect_stdout(io.StringIO()):
        return 1e6 / FRAMES * min(repeat(
            lambda: run(scene, False, FRAMES, None), number=1, repeat=7, timer=time.process_time))


def main() -> None:
    seven, eight = (Scene(**EXAMPLES[number].settings) for number in (7, 8))
    bare_us = 1e6 / FRAMES * min(repeat(BARE, START, number=FRAMES, timer=time.process_time))
    print(f"example 8: its step written out takes {10 * bare_us / cost_us(eight, 10):.0%} of it")
    rest = 1 - frame_us(replace(seven, auto_off=False)) / frame_us(seven)
    print(f"example 7: to ask whether the car is at rest takes {rest:.0%} of a frame")


if __name__ == "__main__":
    main()
