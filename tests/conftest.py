"""What every test starts from: the same environment, wherever it is started."""

import os

import pytest
from hypothesis import HealthCheck, settings

from clock import Clock
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
