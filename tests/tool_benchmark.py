"""A tool, no test: what methods cost beside each other, and a step beside its frame.

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

from airtrack import METHODS, Car, Scene, costs_us, run, scene_of, truth_of, with_method
from examples import EXAMPLES

FRAMES = 20_000

def frame_us(scene: Scene) -> float:
    """A frame of its film, with its true car, printed into memory."""
    def play() -> None:
        run({"o": Car(truth_of(scene)), "*": Car(scene)}, scene, FRAMES, None)

    with redirect_stdout(io.StringIO()):
        costs_s = repeat(play, number=1, repeat=7, timer=time.process_time)
    return 1e6 / FRAMES * min(costs_s)

def main() -> None:
    ten = scene_of(EXAMPLES[10].settings)
    for fps in (10, 120, 960):
        scene = replace(ten, fps_target=fps)
        costs = costs_us({letter: with_method(scene, *method)
                          for letter, method in METHODS.items()}).values()
        ratio = max(costs) / min(costs)
        print(f"example 10 at {fps} FPS: the dearest method costs {ratio:.2f} times the cheapest")
    step_us = costs_us({"*": ten})["*"] / ten.fps_target
    print(f"example 10: a step takes {step_us / frame_us(ten):.0%} of its frame with its line")

if __name__ == "__main__":
    main()
