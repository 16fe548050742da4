"""A clock that a test sets, keys that it presses, and what a run printed meanwhile."""

import re
from collections.abc import Callable
from itertools import pairwise
from types import SimpleNamespace

import pytest

import airtrack
import examples

Play = Callable[..., str]


class Clock:
    """A clock that goes on only while somebody sleeps, or when a test says so."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now_s = 1000.0
        self.frames_s: list[float] = []  # when each frame was drawn
        self.when_drawn: Callable[[int], float] = lambda frame: 1e-5  # how long that takes
        self.due: list[tuple[float, str]] = []  # when keys are pressed, and which
        stand_in = SimpleNamespace(perf_counter=lambda: self.now_s, sleep=self.sleep)
        monkeypatch.setattr(airtrack, "time", stand_in)
        monkeypatch.setattr(examples, "time", stand_in)
        monkeypatch.setattr(examples, "HAS_TERMINAL", False)
        monkeypatch.setattr(examples, "terminal_keys", self.pressed)
        render_track = airtrack.render_track

        def render(*args: object) -> str:
            self.frames_s.append(self.now_s)
            self.now_s += self.when_drawn(len(self.frames_s))
            return render_track(*args)  # type: ignore[arg-type]

        monkeypatch.setattr(airtrack, "render_track", render)

    def sleep(self, seconds: float) -> None:
        assert seconds >= 0
        self.now_s += seconds + 60e-6  # a little too long, as real ones are

    def press(self, **keys: str) -> None:
        """t4_05="p" presses p 4.05 s from now. The frames are counted anew."""
        self.frames_s = []
        self.due = [(self.now_s + float(at[1:].replace("_", ".")), key) for at, key in keys.items()]

    def pressed(self) -> str:
        keys = ""
        while self.due and self.now_s >= self.due[0][0]:
            keys += self.due.pop(0)[1]
        return keys

    def lengths_s(self) -> list[float]:
        return [b - a for a, b in pairwise(self.frames_s)]


def positions_m(out: str) -> list[float]:
    """The x of every frame in what was printed."""
    return [float(x) for x in re.findall(r"x = +(-?[0-9.]+), v", out)]


def plain(out: str) -> str:
    """A text without its line breaks."""
    return " ".join(out.split())


def ending(out: str) -> str:
    """The line that says why a film has stopped."""
    return next(line for line in out.splitlines() if line.startswith("Stopped"))


def last_words(out: str) -> str:
    """What stands behind the table, without its line breaks."""
    return plain(out.partition("\nThe hops in frames")[2].partition("\n\n")[2])
