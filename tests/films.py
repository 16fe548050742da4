"""Runs of the program, for the tests: in this process, or as a user starts it."""

import contextlib
import os
import random
import re
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import count, islice, pairwise, product
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from airtrack import Scene, main, step, truth_of
from examples import EXAMPLES

if sys.platform != "win32":
    import fcntl
    import struct
    import termios

HERE = Path(__file__).resolve().parent.parent
COMMAND = [sys.executable, str(HERE / "airtrack.py")]

# Nothing else of the environment in which the tests are started reaches a run: no display, no
# colours turned off, no width. Where there is always a display, dummy keeps the window shut.
KEPT = ("PATH", "HOME", "USERPROFILE", "SYSTEMROOT", "TEMP", "TMP", "LD_LIBRARY_PATH",
        "XDG_RUNTIME_DIR")
CLEAN = {name: os.environ[name] for name in KEPT if name in os.environ} | {
    "TERM": "xterm", "LANG": "C.UTF-8", "SDL_VIDEODRIVER": "dummy"}


class Film(NamedTuple):
    """What a --fast run printed, taken apart."""

    intro: str
    lines: list[str]
    ending: str


def film(capsys: pytest.CaptureFixture[str], *words: str) -> Film:
    """Run main with --fast and the words. An empty line parts the header from the film."""
    assert main([*words, "--fast"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    header, _, rest = out.partition("\n\n")
    *lines, ending = rest.splitlines()
    return Film(" ".join(header.split()), lines, ending)


def details(line: str) -> tuple[float, float]:
    """x and v in the details behind a line."""
    x_text, v_text = re.findall(r"[xv] = +(-?[0-9.]+)", line)
    return float(x_text), float(v_text)


def environment(**changes: str | None) -> dict[str, str]:
    """A clean environment with the changes (None: unset)."""
    wanted: dict[str, str | None] = {**CLEAN, **changes}
    return {name: value for name, value in wanted.items() if value is not None}


def hops(scene: Scene, number: int) -> list[int]:
    """The first hops of a film in lines, from each in which a bounce is found to the next."""
    def bounces() -> Iterator[int]:
        x_m, v_mps = scene.x_m, scene.v_mps
        for line in count(1):
            x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / scene.fps_target)
            if mark_m is not None:
                yield line
    return [b - a for a, b in pairwise(islice(bounces(), number + 1))]


def hops_nearby(number: int, lines: int, **changes: object) -> list[list[int]]:
    """The hops of an example with changes, its x and v nine times shifted by up to 0.1 %."""
    scene = Scene(**EXAMPLES[number].settings | changes)
    return [hops(replace(scene, x_m=scene.x_m * of_x, v_mps=scene.v_mps * of_v), lines)
            for of_x, of_v in product((1 - 1e-3, 1, 1 + 1e-3), repeat=2)]


def starts(motion: str, correction: str, CR: float, low: float, high: float,
           number: int) -> Iterator[Scene]:
    """Cars about to meet the wall that they are pulled to, at x = 0, for hops of so many lines."""
    rng = random.Random(f"{motion} {correction} {CR}")
    for _ in range(number):
        dt_s, g_mps2, side = rng.uniform(0.01, 0.1), rng.uniform(1, 10), rng.choice([-1, 1])
        w_mps = g_mps2 * dt_s * rng.uniform(low, high) / 2 / CR
        yield Scene(
            motion=motion, correction=correction, CR=CR, a_mps2=side * g_mps2, v_mps=side * w_mps,
            x_m=-side * rng.random() * w_mps * dt_s, fps_target=1 / dt_s,
            left_edge_m=min(0, -1000 * side), right_edge_m=max(0, -1000 * side))


# The law of the hops: the k of each motion and correction, as airtrack.py has it.
README = (HERE / "README.md").read_text(encoding="utf-8")
LAW = (HERE / "airtrack.py").read_text().partition("# ==== 7. ")[2].partition("# ==== 8. ")[0]
K = {name: float(Fraction(k)) for name, k in re.findall("   ([a-z]+) (-?[0-9/]+)(?=\\s)", LAW)}

Beside = list[tuple[float, float, float | None]]  # x, the true x and mark_m, frame by frame


def beside_the_truth(number: int, frames: int, shift: float, **changes: object) -> Beside:
    """An example, with its v (its x where v is 0) shifted by a part of it, and with changes."""
    settings = EXAMPLES[number].settings
    name = "v_mps" if settings.get("v_mps") else "x_m"
    scene = Scene(**settings | changes | {name: settings[name] * (1 + shift)})
    truth, (x_m, v_mps), found = truth_of(scene), (scene.x_m, scene.v_mps), []
    for frame in range(1, frames + 1):
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / scene.fps_target)
        true_m = step(truth, truth.x_m, truth.v_mps, frame / scene.fps_target)[0]
        found.append((x_m, true_m, mark_m))
    return found


def apart_m(found: Beside) -> float:
    return max(abs(x_m - true_m) for x_m, true_m, _ in found)


PATIENCE_S = 30  # for what must come: only a test that fails waits so long


def quick(change: str = "pass", pause_s: float = 0.01) -> list[str]:
    """The program, with another pause to read each header in, and with a change to it."""
    code = (f"import os, sys, time, airtrack, examples; examples.THINK_S = {pause_s}; "
            f"examples.WAIT_S = {pause_s}; {change}; sys.exit(airtrack.main())")
    return [sys.executable, "-c", code]


def sit_down() -> None:
    """At the terminal that is standard input. Ctrl-C works there, even if the tests ignore it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    for number in (signal.SIGINT, signal.SIGQUIT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


class Terminal(contextlib.AbstractContextManager["Terminal"]):
    """A program in a pseudo-terminal of its own, as somebody at the keyboard sees it."""

    def __init__(self, *command: str, columns: int = 200, **changes: Any) -> None:
        self.ours, self.theirs = os.openpty()
        fcntl.ioctl(self.theirs, termios.TIOCSWINSZ, struct.pack("4H", 40, columns, 0, 0))
        self.found = self.mode()
        self.all, self.seen = "", 0  # all that came, and how much of it was waited for
        self.program = subprocess.Popen(
            command, stdin=self.theirs, stdout=self.theirs, stderr=self.theirs, cwd=HERE,
            env=environment(**changes), start_new_session=True, preexec_fn=sit_down)

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.program.pid, signal.SIGKILL)
        self.program.wait()
        os.close(self.ours)
        os.close(self.theirs)

    def mode(self) -> list[Any]:
        return termios.tcgetattr(self.ours)

    def press(self, keys: str) -> None:
        """Type keys, or send the signal of that name."""
        if keys.startswith("SIG"):
            self.program.send_signal(signal.Signals[keys])
        else:
            os.write(self.ours, keys.encode())

    def read(self, wait_s: float) -> bool:
        """Read some of what there is; False if nothing came in that time."""
        is_ready = bool(select.select([self.ours], [], [], wait_s)[0])
        if is_ready:
            self.all += os.read(self.ours, 65536).decode(errors="replace")
        return is_ready

    def until(self, *texts: str) -> None:
        """Wait until the texts have come, one after the other."""
        deadline_s = time.monotonic() + PATIENCE_S
        for text in texts:
            while text not in self.all[self.seen:]:
                assert time.monotonic() < deadline_s, f"no {text!r}: {self.all[-1000:]}"
                self.read(0.05)
            self.seen = self.all.index(text, self.seen) + len(text)

    def ends(self, status: int) -> None:
        """Wait for the end: with this status, without a traceback, the terminal as found."""
        while self.program.poll() is None or self.read(0):
            self.read(0.05)
        assert self.program.returncode == status, self.all[-1000:]
        assert self.mode() == self.found
        assert "Traceback" not in self.all

    def ends_at_x(self) -> None:
        self.press("x")
        self.until(" s: x was pressed.")
        self.ends(0)
