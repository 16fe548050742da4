"""What every test starts from: the same environment, wherever it is started."""

import os
from contextlib import nullcontext

import pytest
from hypothesis import HealthCheck, settings

import examples
from airtrack import main
from clock import Clock, Play
from films import CLEAN

settings.register_profile("airtrack", deadline=None, derandomize=True,  # a slow machine is no fault
                          suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("airtrack")


@pytest.fixture(autouse=True)
def clean_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """No display, no width, no colours but those that a test sets."""
    for name in set(os.environ) - set(CLEAN) - {"PYTEST_CURRENT_TEST"}:
        monkeypatch.delenv(name)
    for name, value in CLEAN.items():
        monkeypatch.setenv(name, value)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """A clock that the test sets."""
    return Clock(monkeypatch)


@pytest.fixture
def play(clock: Clock, capsys: pytest.CaptureFixture[str]) -> Play:
    """Run a command line, pressing keys at set moments: what was printed."""
    def played(words: str, **keys: str) -> str:
        clock.press(**keys)
        assert main(words.split()) == 0
        return capsys.readouterr().out
    return played


@pytest.fixture
def at_a_terminal(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """As if input and output were a terminal with keys."""
    monkeypatch.setattr(examples, "HAS_TERMINAL", True)
    monkeypatch.setattr(examples, "taken_terminal", nullcontext)
    monkeypatch.setattr(examples, "print_for_now", lambda text: print(text, end="\r"))
