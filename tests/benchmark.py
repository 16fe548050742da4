"""What the air track costs, as ratios: python tests/benchmark.py

Not a test: a test must not depend on a machine's speed. Costs are processor time, the least of
several runs.
"""

import io
import math
import sys
import time
from collections.abc import Callable
from contextlib import redirect_stdout
from dataclasses import replace
from functools import partial
from pathlib import Path
from timeit import repeat
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from airtrack import SERIES, Scene, run, step, truth_of
from examples import EXAMPLES

STEPS = 20_000


def least_s(call: Callable[[], object]) -> float:
    """Processor time of a call, the least of several."""
    return min(repeat(call, number=1, repeat=7, timer=time.process_time))


def cost_s(scene: Scene) -> float:
    """What a step of 0.1 s costs in a run of the scene."""
    def steps() -> None:
        x_m, v_mps = scene.x_m, scene.v_mps
        for _ in range(STEPS):
            x_m, v_mps, _ = step(scene, x_m, v_mps, 0.1)
    return least_s(steps) / STEPS


def frame() -> None:
    """A frame's step beside the rest of it, drawing and printing its line (into memory)."""
    ten = Scene(**EXAMPLES[10].settings)

    def film() -> None:
        with redirect_stdout(io.StringIO()):
            run(ten, False, STEPS, None)
    line_s = least_s(film) / STEPS - cost_s(ten)
    for motion, correction in SERIES.values():
        step_s = cost_s(replace(ten, motion=motion, correction=correction))
        print(f"example 10 by {motion} + {correction}: a step takes {step_s * 1e6:.2f} us, drawing "
              f"its line {line_s / step_s:.0f} times as long")


def elsewhere() -> None:
    """The same 20 s by scipy's solve_ivp, which finds the walls as events."""
    try:
        from scipy.integrate import solve_ivp
    except ImportError:
        print("scipy is not installed: not compared")
        return

    def solve(scene: Scene, max_step_s: float) -> list[float]:
        """Where the car is every 0.1 s."""
        def left(_: float, y: Any) -> float:
            return float(y[0] - scene.left_edge_m)

        def right(_: float, y: Any) -> float:
            return float(scene.right_edge_m - y[0])

        for event in (left, right):
            event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
        t_s, y, xs = 0.0, [scene.x_m, scene.v_mps], []
        while t_s < 20:
            part = solve_ivp(lambda _, y: (y[1], scene.a_mps2), (t_s, 20), y, events=(left, right),
                             rtol=1e-6, atol=1e-6, max_step=max_step_s, dense_output=True)
            end_s = part.t[-1]
            xs += [float(part.sol(k / 10)[0]) for k in range(1, 201) if t_s < k / 10 <= end_s]
            t_s, y = end_s, [part.y[0][-1], -scene.CR * part.y[1][-1]]
        return xs

    ten, thrown = Scene(**EXAMPLES[10].settings), Scene(v_mps=10, a_mps2=-9.81, CR=0.95)

    def off_m(scene: Scene, xs: list[float]) -> float:
        truth = truth_of(scene)
        true = (step(truth, truth.x_m, truth.v_mps, k / 10)[0] for k in range(1, 201))
        return max(abs(x_m - true_m) for x_m, true_m in zip(xs, true, strict=False))

    for max_step_s in (math.inf, 0.1):
        call = partial(solve, ten, max_step_s)
        print(f"solve_ivp, max_step {max_step_s}, example 10: "
              f"{least_s(call) / 200 / cost_s(truth_of(ten)):.0f} times exact + replay at 10 FPS, "
              f"{off_m(ten, call()):.1g} m off; with v = 10, a = -9.81, CR = 0.95 "
              f"{off_m(thrown, solve(thrown, max_step_s)):.2g} m off")


if __name__ == "__main__":
    frame()
    elsewhere()
