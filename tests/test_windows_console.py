"""The keys of a Windows console: examples.py as Windows sees it, with a stand-in for msvcrt."""

import importlib.util
import signal
import sys
from collections import deque
from types import SimpleNamespace

import pytest

from films import HERE


@pytest.mark.parametrize(("is_console", "typed", "keys"), [
    (True, "pS\x13\x03\xe0P\x00Sx\xe0H", "pS\x13\x03x"),  # P is the second half of the arrow down
    (False, "x", "")], ids=["in a console", "in a pipe"])
def test_the_console_gives_its_keys_and_no_arrows_and_a_pipe_has_none(
        is_console: bool, typed: str, keys: str, monkeypatch: pytest.MonkeyPatch) -> None:
    waiting = deque(typed)
    monkeypatch.setitem(sys.modules, "msvcrt", SimpleNamespace(
        kbhit=lambda: bool(waiting), getwch=waiting.popleft))
    for name in ("select", "termios", "tty"):  # what only POSIX has
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("SIGHUP", "SIGTSTP"):
        monkeypatch.delattr(signal, name, raising=False)
    monkeypatch.setattr("os.isatty", lambda number: number == 0 or is_console)
    monkeypatch.setattr(sys, "platform", "win32")
    spec = importlib.util.spec_from_file_location("examples_on_windows", HERE / "examples.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    with module.taken_keys():
        assert module.terminal_keys() == list(keys)
