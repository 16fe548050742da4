"""The keys of a Windows console: examples.py as Windows sees it, with a stand-in for msvcrt."""

import importlib.util
import signal
import sys
from collections import deque
from types import ModuleType, SimpleNamespace

import pytest

from films import HERE


@pytest.fixture
def windows(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """examples.py without what only POSIX has; its msvcrt.typed are the keys still to be given."""
    typed = deque[str]()
    monkeypatch.setitem(sys.modules, "msvcrt", SimpleNamespace(
        typed=typed, kbhit=lambda: bool(typed), getwch=typed.popleft))
    for name in ("select", "termios"):
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("SIGHUP", "SIGQUIT", "SIGTSTP", "SIGCONT"):
        monkeypatch.delattr(signal, name, raising=False)
    for stream in (sys.stdin, sys.stdout):
        monkeypatch.setattr(stream, "isatty", lambda: True)
    monkeypatch.setattr(sys, "platform", "win32")
    spec = importlib.util.spec_from_file_location("examples_on_windows", HERE / "examples.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_console_s_keys_pause_and_step_and_an_arrow_does_nothing(windows: ModuleType) -> None:
    with windows.Keys() as keys:
        assert keys.help().startswith("Keys, in this terminal: p ")
        # An arrow's second half may be a letter: P is that of the arrow down.
        for typed, is_paused, steps in (("\xe0P\x00S", False, 0), ("p", True, 0), ("s", True, 1),
                                        ("\x13", False, 0)):
            windows.msvcrt.typed.extend(typed)
            keys.look()
            assert (keys.is_paused, keys.steps, keys.why_quit) == (is_paused, steps, "")


@pytest.mark.parametrize(("typed", "why"), [
    ("x", "x was pressed"), ("\x1b", "Esc was pressed"), ("\xe0Hx", "x was pressed")])
def test_a_key_of_the_console_quits(typed: str, why: str, windows: ModuleType) -> None:
    with windows.Keys() as keys:
        windows.msvcrt.typed.extend(typed)
        keys.look()
        assert (keys.why_quit, keys.status) == (why, 0)


def test_in_a_pipe_the_console_has_no_keys(
        windows: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: False)
    windows.msvcrt.typed.append("x")
    with windows.Keys() as keys:
        keys.look()
        assert (keys.help(), keys.why_quit) == ("Keys: Ctrl-C quits.", "")
