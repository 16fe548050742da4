"""A clock that a test sets, and keys that it presses at set moments."""

import signal
from collections.abc import Callable
from contextlib import nullcontext
from itertools import pairwise
from types import SimpleNamespace

import pytest

import airtrack
import examples

Play = Callable[..., str]

class Clock:
    """A clock that goes on only while somebody sleeps, or when a test says so."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now_s = 0.0  # from the start of the run
        self.frames_s: list[float] = []  # when each frame was drawn
        self.when_drawn: Callable[[int], float] = lambda frame: 0.0  # how long drawing it takes
        self.due: dict[float, str] = {}  # the keys still to be pressed, and when
        stand_in = SimpleNamespace(perf_counter=lambda: self.now_s, sleep=self.sleep)
        monkeypatch.setattr(airtrack, "time", stand_in)
        monkeypatch.setattr(examples, "time", stand_in)
        monkeypatch.setattr(examples, "HAS_TERMINAL", True)
        monkeypatch.setattr(examples, "taken_terminal", nullcontext)
        monkeypatch.setattr(examples, "terminal_keys", self.pressed)
        render_track = airtrack.render_track

        def render(*args: object) -> str:
            self.frames_s.append(self.now_s)
            self.now_s += self.when_drawn(len(self.frames_s))
            return render_track(*args)  # type: ignore[arg-type]

        monkeypatch.setattr(airtrack, "render_track", render)

    def sleep(self, seconds: float) -> None:
        assert seconds >= 0
        assert self.now_s < 10_000, "it waits for ever"
        self.now_s += seconds + 60e-6  # a little too long, as real ones are

    def pressed(self) -> list[str]:
        """The keys that were pressed since the last call. Ctrl-C comes as a signal."""
        keys = ""
        for at_s in [at_s for at_s in self.due if at_s <= self.now_s]:
            keys += self.due.pop(at_s)
        if "\x03" in keys:
            signal.raise_signal(signal.SIGINT)
        return list(keys.replace("\x03", ""))

    def lengths_s(self) -> list[float]:
        """How long each frame lasted."""
        return [after_s - before_s for before_s, after_s in pairwise(self.frames_s)]

def plain(text: str) -> str:
    """A text without its line breaks."""
    return " ".join(text.split())
