"""What the air track costs, as ratios: python tests/benchmark.py

Not a test: a test must not depend on a machine's speed. A frame's cost is processor time, without
that of the start, the least of several runs; frame rates are of a film in a pipe.
"""

import math
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from timeit import repeat
from typing import Any

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from airtrack import Scene, step, truth_of  # noqa: E402
from examples import EXAMPLES  # noqa: E402

AIRTRACK = [sys.executable, str(HERE / "airtrack.py")]
FRAMES = 100_000


def frame_s(command: Callable[[int], list[str]]) -> float:
    """Processor time of a frame, whose output goes into a file."""
    def spent_s(frames: int) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with tempfile.TemporaryFile() as file:
            subprocess.run(command(frames), stdout=file, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    whole_s, start_s = (min(spent_s(frames) for _ in range(5)) for frames in (FRAMES, 1))
    return (whole_s - start_s) / FRAMES


def film() -> None:
    """The film of example 0, beside the README's one-pager, which does not keep time here."""
    readme = (HERE / "README.md").read_text(encoding="utf-8")
    page, = re.findall(r"```python\n(import time.*?)```", readme, re.DOTALL)
    plain = page.replace("while True", "for _ in range(FRAMES)").replace("time.sleep(dt_s)", "pass")
    plain_s = frame_s(lambda frames: [sys.executable, "-c", plain.replace("FRAMES", str(frames))])
    ours_s = frame_s(lambda frames: [*AIRTRACK, "0", "--fast", "--frames", str(frames)])
    print(f"a frame of example 0 into a file: {ours_s * 1e6:.1f} us, by the one-pager "
          f"{plain_s * 1e6:.1f} us: {plain_s / ours_s:.1f} times as fast")


def cost_s(scene: Scene, take: Callable[..., Any] = step) -> float:
    """Processor time of a step of 0.1 s, in a run of the scene, the least of several runs."""
    def run() -> None:
        x_m, v_mps = scene.x_m, scene.v_mps
        for _ in range(20_000):
            x_m, v_mps, _ = take(scene, x_m, v_mps, 0.1)
    return min(repeat(run, number=1, repeat=7, timer=time.process_time)) / 20_000


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
        spent_s = min(repeat(call, number=1, repeat=5, timer=time.process_time))
        print(f"solve_ivp, max_step {max_step_s}, example 10: "
              f"{spent_s / 200 / cost_s(truth_of(ten)):.0f} times exact + replay at 10 FPS, "
              f"{off_m(ten, call()):.1g} m off; with v = 10, a = -9.81, CR = 0.95 "
              f"{off_m(thrown, solve(thrown, max_step_s)):.2g} m off")


def rates() -> None:
    """How well a film holds its frame rate, from 2 s on for 10 s."""
    for fps in (300, 240, 10):
        words = "0", f"fps_target={fps}", "--frames", str(12 * fps)
        with subprocess.Popen([*AIRTRACK, *words], stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout
            moments_s = [time.perf_counter() for line in process.stdout if "FPS =" in line]
        held = 10 / (moments_s[-1] - moments_s[2 * fps - 1])
        print(f"{fps} FPS in a pipe: held to {held:.2%}")


if __name__ == "__main__":
    film()
    elsewhere()
    rates()
