"""What the air track costs, as ratios: python tests/benchmark.py

Not a test: a test must not depend on a machine's speed. Processor times are of whole processes,
the least of several runs; frame rates are of a film in a pseudo-terminal.
"""

import math
import os
import pty
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from timeit import repeat
from typing import Any

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from airtrack import Scene, exactly, step  # noqa: E402
from examples import EXAMPLES  # noqa: E402

AIRTRACK = [sys.executable, str(HERE / "airtrack.py")]
FRAMES = 100_000

# Example 7 told again in the plainest way: state in dictionaries, a line built character by
# character, print. What a beginner writes first, and what the program is compared with.
PLAIN = """
env = {"m_to_px": 55.0, "left_m": 0.25, "right_m": 2.2, "dt_s": 1 / 240, "fps": 240.0}
car = {"x_m": 2.0, "v_mps": 0.0, "a_mps2": -2.0, "CR": 1.0, "start_m": 2.0}
recent = []
for frame in range(FRAMES):
    car["v_mps"] += car["a_mps2"] * env["dt_s"]
    car["x_m"] += car["v_mps"] * env["dt_s"]
    for wall_m in (env["left_m"], env["right_m"]):
        beyond = car["x_m"] < wall_m if wall_m == env["left_m"] else car["x_m"] > wall_m
        if beyond:
            car["x_m"] -= (car["x_m"] - wall_m) * (1 + car["CR"])
            car["v_mps"] *= -car["CR"]
    marks = {round(car["start_m"] * env["m_to_px"]): ".",
             round(env["left_m"] * env["m_to_px"]): "|",
             round(env["right_m"] * env["m_to_px"]): "|",
             round(car["x_m"] * env["m_to_px"]): "*"}
    line = ""
    for column in range(136):
        if column in marks:
            line += marks[column]
        else:
            line += " "
    recent = (recent + [car["x_m"]])[-10:]
    mean_m = sum(recent) / len(recent)
    if len(recent) == 10 and min(abs(mean_m - env["left_m"]), abs(mean_m - env["right_m"])) < 1e-3:
        break
    print(f"{line}x = {car['x_m']:6.2f}, v = {car['v_mps']:5.2f}, FPS = {env['fps']:3.0f}")
"""


def processor_s(command: list[str], runs: int = 5) -> float:
    """The least processor time of the command, its output going into a file."""
    costs_s = []
    for _ in range(runs):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with tempfile.TemporaryFile() as file:
            subprocess.run(command, stdout=file, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        costs_s.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(costs_s)


def film() -> None:
    plain = [sys.executable, "-c", PLAIN.replace("FRAMES", str(FRAMES))]
    ours = [*AIRTRACK, "7", "d", "--fast", "--frames", str(FRAMES)]
    plain_s, ours_s = processor_s(plain), processor_s(ours)
    print(f"a frame of example 7 into a file, the whole process counted: "
          f"{ours_s / FRAMES * 1e6:.1f} us, told plainly {plain_s / FRAMES * 1e6:.1f} us: "
          f"{plain_s / ours_s:.1f} times as fast")


def cost_s(scene: Scene, dt_s: float = 0.1, take: Callable[..., Any] = step) -> float:
    """Processor time of a step of a run of the scene, the least of several runs."""
    def run() -> None:
        x_m, v_mps = scene.x_m, scene.v_mps
        for _ in range(20_000):
            x_m, v_mps, _ = take(scene, x_m, v_mps, dt_s)
    return min(repeat(run, number=1, repeat=7, timer=time.process_time)) / 20_000


def steps() -> None:
    """Steps of the same scene by three methods, and a step that does nothing."""
    eight, ten = (Scene(**EXAMPLES[number].settings) for number in (8, 10))
    backward_s, rewind_s, replay_s = cost_s(eight), cost_s(ten), cost_s(exactly(ten))
    print(f"a step at 10 FPS: backward + rebound {backward_s * 1e6:.2f} us, "
          f"exact + rewind {rewind_s / backward_s:.1f} times, "
          f"exact + replay {replay_s / backward_s:.1f} times that")
    nothing_s = cost_s(ten, take=lambda scene, x_m, v_mps, dt_s: (x_m, v_mps, None))
    print(f"a step that does nothing costs {nothing_s / backward_s:.0%} of backward's, "
          f"{nothing_s / replay_s:.0%} of exact + replay's")
    hopping = replace(exactly(ten), CR=0.8)

    def bounce(scene: Scene, *_: float) -> tuple[float, float, None]:
        step(scene, 0.3, -2.0, 0.1)
        return 0.3, -2.0, None
    print(f"a step of exact + replay that bounces: {cost_s(hopping, take=bounce) * 1e6:.2f} us")


def elsewhere() -> None:
    """The same 20 s by scipy's solve_ivp, which finds the walls as events."""
    try:
        from scipy.integrate import solve_ivp
    except ImportError:
        print("scipy is not installed: not compared")
        return

    def solve(scene: Scene, rtol: float, max_step_s: float) -> tuple[list[float], int]:
        """Where the car is every 0.1 s, and how often it bounced."""
        def left(_: float, y: Any) -> float:
            return float(y[0] - scene.left_edge_m)

        def right(_: float, y: Any) -> float:
            return float(scene.right_edge_m - y[0])

        for event in (left, right):
            event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
        t_s, y, xs, bounces = 0.0, [scene.x_m, scene.v_mps], [], 0
        while t_s < 20 and bounces < 1000:
            part = solve_ivp(lambda _, y: (y[1], scene.a_mps2), (t_s, 20), y, events=(left, right),
                             rtol=rtol, atol=rtol, max_step=max_step_s, dense_output=True)
            end_s = part.t[-1]
            xs += [float(part.sol(k / 10)[0]) for k in range(1, 201) if t_s < k / 10 <= end_s]
            t_s, y = end_s, [part.y[0][-1], -scene.CR * part.y[1][-1]]
            bounces += part.status == 1
        return xs, bounces

    ten, twelve = (Scene(**EXAMPLES[number].settings) for number in (10, 12))
    thrown = Scene(v_mps=10, a_mps2=-9.81, CR=0.95)
    def off_m(scene: Scene, xs: list[float]) -> float:
        truth = exactly(scene)
        true = (step(truth, truth.x_m, truth.v_mps, k / 10)[0] for k in range(1, 201))
        return max(abs(x_m - true_m) for x_m, true_m in zip(xs, true, strict=False))

    for rtol in (1e-6, 1e-10):
        for max_step_s in (math.inf, 0.1):
            call = partial(solve, ten, rtol, max_step_s)
            spent_s = min(repeat(call, number=1, repeat=5, timer=time.process_time))
            print(f"solve_ivp, rtol {rtol:g}, max_step {max_step_s}, example 10: "
                  f"{spent_s / 200 / cost_s(exactly(ten)):.0f} times exact + replay at 10 FPS, "
                  f"{off_m(ten, call()[0]):.1g} m off; with v = 10, a = -9.81, CR = 0.95 "
                  f"{off_m(thrown, solve(thrown, rtol, max_step_s)[0]):.2g} m off")
    xs, bounces = solve(twelve, 1e-6, 0.1)
    print(f"solve_ivp, example 12: after {bounces} bounces it is at t = {len(xs) / 10} s")


def rates() -> None:
    """How well a film in a terminal holds its frame rate, from 2 s on for 10 s."""
    for fps in (300, 240, 10):
        out = in_terminal("0", f"fps_target={fps}", "--frames", str(12 * fps))
        moments_s = [moment_s for moment_s, lines in out for _ in range(lines)]
        first, last = moments_s[2 * fps], moments_s[-2]
        held = (len(moments_s) - 2 - 2 * fps) / (last - first) / fps
        print(f"{fps} FPS in a terminal: held to {100 * held:.2f} %")


def plain_sleep() -> None:
    """What the rates below would be with a sleep of dt after each frame."""
    for fps in (300, 240):
        began_s = time.perf_counter()
        for _ in range(3 * fps):
            time.sleep(1 / fps)
        held = 3 / (time.perf_counter() - began_s)
        print(f"a sleep of 1/{fps} s after frames that cost nothing: {held:.1%} of {fps} FPS")


def start() -> None:
    """From the command to the one-pager's first line (it has no pause)."""
    waits_s = []
    for _ in range(5):
        began_s = time.perf_counter()
        out = in_terminal("0", "--frames", "2")
        waits_s.append(out[0][0] - began_s)
    print(f"from the command to the first line: {min(waits_s):.2f} s")


def in_terminal(*words: str) -> list[tuple[float, int]]:
    """When output of the program in a pseudo-terminal came, and how many lines."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.execv(AIRTRACK[0], [*AIRTRACK, *words])
    out = []
    try:
        while data := os.read(terminal, 65536):
            if lines := data.count(b"FPS ="):
                out.append((time.perf_counter(), lines))
    except OSError:  # the program has ended
        pass
    os.waitpid(pid, 0)
    os.close(terminal)
    return out


if __name__ == "__main__":
    film()
    steps()
    elsewhere()
    start()
    plain_sleep()
    rates()
