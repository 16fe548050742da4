"""What the air track costs, as ratios: python tests/benchmark.py

Not a test: a test must not depend on a machine's speed. Processor times are of whole processes,
the least of several runs; frame rates are of a film in a pseudo-terminal.
"""

import os
import pty
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from timeit import repeat

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from airtrack import Scene, step  # noqa: E402
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


def steps() -> None:
    """A step of examples 8 and 10: the same scene, backward Euler and exact."""
    def cost_s(number: int) -> float:
        scene = Scene(**EXAMPLES[number].settings)

        def run() -> None:
            x_m, v_mps = scene.x_m, scene.v_mps
            for _ in range(20_000):
                x_m, v_mps, _ = step(scene, x_m, v_mps, 0.1)
        return min(repeat(run, number=1, repeat=7)) / 20_000

    backward_s, exact_s = cost_s(8), cost_s(10)
    print(f"a step at 10 FPS: backward {backward_s * 1e6:.2f} us, exact {exact_s * 1e6:.2f} us: "
          f"{exact_s / backward_s:.1f} times")


def rates() -> None:
    """How well a film in a terminal holds its frame rate, from 2 s on for 10 s."""
    for fps in (300, 240, 10):
        out = in_terminal("0", f"fps_target={fps}", "--frames", str(12 * fps))
        moments_s = [moment_s for moment_s, lines in out for _ in range(lines)]
        first, last = moments_s[2 * fps], moments_s[-2]
        held = (len(moments_s) - 2 - 2 * fps) / (last - first) / fps
        print(f"{fps} FPS in a terminal: held to {100 * held:.2f} %")


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
    start()
    rates()
