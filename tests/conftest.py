"""What every test starts from: the same environment, wherever it is started."""

import os
import signal
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

from airtrack import main
from clock import Clock, Play
from films import CLEAN

settings.register_profile("airtrack", deadline=None, derandomize=True,  # a slow machine is no fault
                          suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("airtrack")

@pytest.fixture(autouse=True)
def clean_environment(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """No display, no width, no colours but those that a test sets. And Ctrl-C works."""
    for name in set(os.environ) - set(CLEAN) - {"PYTEST_CURRENT_TEST"}:
        monkeypatch.delenv(name)
    for name, value in CLEAN.items():
        monkeypatch.setenv(name, value)
    found = signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in the background
    yield
    signal.signal(signal.SIGINT, found)

@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """A clock that the test sets."""
    return Clock(monkeypatch)

@pytest.fixture
def play(clock: Clock, capsys: pytest.CaptureFixture[str]) -> Play:
    """Run a command line, and press keys at set moments, in s. Returns what was printed."""
    def played(words: str, keys: dict[float, str] | None = None) -> str:
        clock.now_s, clock.frames_s, clock.due = 0.0, [], dict(keys or {})
        assert main(words.split()) == 0
        return capsys.readouterr().out
    return played
