"""Runs of the program, for the tests: in this process, or as a user starts it."""

import contextlib
import functools
import io
import os
import re
import select
import signal
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import airtrack
from airtrack import COMPARED, Car, Scene, main, measured, scene_of, step, ticks, truth_of
from examples import EXAMPLES, OWN_SCENE

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
    table: list[str]
    rows: dict[str, str]  # of the table, by their marks
    answer: str

def shown(words: str) -> Film:
    """What a command line with --fast shows. Empty lines part header, film and table."""
    with contextlib.redirect_stdout(io.StringIO()) as out:
        assert main([*words.split(), "--fast"]) == 0
    header, frames, table = out.getvalue().split("\n\n", 2)
    *lines, ending = frames.splitlines()
    rows, _, answer = table.partition("Was the *")
    by_mark = {row[0]: " ".join(row[1:].split()) for row in rows.splitlines()[2:]}
    return Film(" ".join(header.split()), lines, ending, table.splitlines(), by_mark,
                " ".join(answer.split()))

def details(line: str) -> tuple[float, float]:
    """x and v in the details behind a line."""
    x_text, v_text = re.findall(r"[xv] = +(-?[0-9.]+)", line)
    return float(x_text), float(v_text)

def environment(**changes: str | None) -> dict[str, str]:
    """A clean environment with the changes (None: unset)."""
    wanted: dict[str, str | None] = {**CLEAN, **changes}
    return {name: value for name, value in wanted.items() if value is not None}

def filmed(number: int, frames: int, **changes: Any) -> Car:
    """The car of an example, or of one's own scene, with changes, after a --fast film."""
    car = Car(scene_of(EXAMPLES.get(number, OWN_SCENE).settings | changes))
    for dt_s, _ in ticks(car.scene, frames, None):
        car.move(dt_s)
    return car

def true_m(car: Car) -> list[float]:
    """Where the true car is in each of its frames: in one step from the start."""
    truth = truth_of(car.scene)
    found, t_s = [truth.x_m], 0.0
    for dt_s, _ in ticks(car.scene, len(car.places_m) - 1, None):
        t_s += dt_s
        found.append(step(truth, truth.x_m, truth.v_mps, t_s)[0])
    return found

def furthest_m(car: Car) -> float:
    """How far the car was from its true car at most."""
    return max(abs(x_m - place_m) for x_m, place_m in zip(car.places_m, true_m(car), strict=True))

def compared(number: int, fps: float) -> Scene:
    """An example as chart and map take it."""
    settings = EXAMPLES[number].settings
    kept = {name: settings[name] for name in COMPARED if name in settings}
    return scene_of(kept | {"fps_target": fps})

@functools.cache
def chart_errors_m(number: int, fps: float) -> dict[str, float]:
    """The errors in the chart of an example at a rate, by their letters. Costs are not measured."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(airtrack, "costs_us", lambda scenes: dict.fromkeys(scenes, 1.0))
        return {point.letter: point.error_m for point in measured(compared(number, fps))}

def bounces(car: Car) -> list[int]:
    """The frames in which a collision was found."""
    return [number for number, mark_m in enumerate(car.marks_m) if mark_m is not None]

def hops(car: Car) -> list[int]:
    """How many frames there are from bounce to bounce."""
    return [after - before for before, after in pairwise(bounces(car))]

def tops_m(found_m: list[float]) -> list[float]:
    """The heights, or the places to the right, at which something turned."""
    return [found_m[n] for n in range(1, len(found_m) - 1)
            if found_m[n - 1] <= found_m[n] > found_m[n + 1]]

PATIENCE_S = 30  # for what must come: only a test that fails waits so long

def quick(change: str = "pass", pause_s: float = 0.01) -> list[str]:
    """The program, with another pause to read each header in, and with a change to it."""
    code = (f"import os, sys, time, airtrack, examples; examples.READING_S = {pause_s}; "
            f"examples.READING_WITHOUT_KEYS_S = {pause_s}; {change}; sys.exit(airtrack.main())")
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
        self.command = command
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
        """Type keys, or send the signal of that name to what runs in the foreground."""
        if keys.startswith("SIG"):
            os.killpg(os.tcgetpgrp(self.ours), signal.Signals[keys])
        else:
            os.write(self.ours, keys.encode())

    def hang_up(self) -> None:
        """Take the terminal away."""
        nothing = os.open(os.devnull, os.O_RDWR)
        os.dup2(nothing, self.ours)
        os.close(nothing)

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

    def goes_on(self) -> None:
        """Wait until frames come for which it has looked at the keys again."""
        while self.read(0):
            pass
        self.seen = len(self.all)
        self.until("FPS", "FPS", "FPS")  # the first may be of an earlier look

    def ends(self, *statuses: int) -> None:
        """Wait for the end: with such a status, without a traceback, the terminal as found."""
        deadline_s = time.monotonic() + PATIENCE_S
        while self.program.poll() is None or self.read(0):
            assert time.monotonic() < deadline_s, f"it does not end: {self.all[-1000:]}"
            self.read(0.05)
        assert self.mode() == self.found, self.all[-1000:]
        assert "Traceback" not in self.all, self.all[-1000:]
        assert self.program.returncode in statuses, self.all[-1000:]
