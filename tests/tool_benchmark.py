"""A tool, no test: what methods cost beside each other, and a move beside its frame.

    python tests/tool_benchmark.py

A test must not depend on a machine's speed. Costs are the least of several runs.
"""

import io
import sys
import time
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from timeit import repeat

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from airtrack import METHODS, Scene, cars_of, cost_us, run
from examples import EXAMPLES, NoKeys

FRAMES = 20_000

def frame_us(scene: Scene) -> float:
    """A frame of its film, printed into memory."""
    def play() -> None:
        run(cars_of(scene, None), scene, scene, False, FRAMES, NoKeys())

    with redirect_stdout(io.StringIO()):
        costs_s = repeat(play, number=1, repeat=7, timer=time.process_time)
    return 1e6 / FRAMES * min(costs_s)

def main() -> None:
    ten = Scene(**EXAMPLES[10].settings)
    for fps in (10, 120, 960):
        costs_us = [cost_us(replace(ten, motion=motion, correction=correction), fps)
                    for motion, correction in METHODS.values()]
        ratio = max(costs_us) / min(costs_us)
        print(f"example 10 at {fps} FPS: the dearest method costs {ratio:.2f} times the cheapest")
    print(f"example 10: the move takes {cost_us(ten, 10) / 10 / frame_us(ten):.0%} of a frame")

if __name__ == "__main__":
    main()
