"""The keys of a Windows console: examples.py as Windows sees it, with a stand-in for msvcrt."""

import importlib.util
import signal
import sys
from collections import deque
from types import ModuleType, SimpleNamespace

import pytest

from films import HERE


def windows(monkeypatch: pytest.MonkeyPatch, is_console: bool) -> ModuleType:
    """examples.py without what only POSIX has; its msvcrt.typed are the keys still to be given."""
    typed = deque[str]()
    monkeypatch.setitem(sys.modules, "msvcrt", SimpleNamespace(
        typed=typed, kbhit=lambda: bool(typed), getwch=typed.popleft))
    for name in ("select", "termios", "tty"):
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("SIGHUP", "SIGQUIT", "SIGTSTP", "SIGCONT"):
        monkeypatch.delattr(signal, name, raising=False)
    monkeypatch.setattr("os.isatty", lambda number: number == 0 or is_console)
    monkeypatch.setattr(sys, "platform", "win32")
    spec = importlib.util.spec_from_file_location("examples_on_windows", HERE / "examples.py")
    module = importlib.util.module_from_spec(spec)  # type: ignore[arg-type]
    spec.loader.exec_module(module)  # type: ignore[union-attr]
    monkeypatch.setattr(module.Window, "__init__", lambda window: setattr(window, "why_shut", "no"))
    return module


@pytest.mark.parametrize(("is_console", "typed", "keys"), [
    (True, "pS\x13\x03\xe0P\x00Sx\xe0H", "pS\x13\x03x"),  # P is the second half of the arrow down
    (False, "x", "")], ids=["in a console", "in a pipe"])
def test_the_console_gives_its_keys_and_no_arrows_and_a_pipe_has_none(
        is_console: bool, typed: str, keys: str, monkeypatch: pytest.MonkeyPatch) -> None:
    module = windows(monkeypatch, is_console)
    module.msvcrt.typed.extend(typed)
    before = {name: signal.getsignal(name) for name in (signal.SIGINT, signal.SIGTERM)}
    with module.taken_keys() as taken:
        assert taken.texts_before("?")[0].startswith("Keys here" if is_console else "No keys here")
        assert module.terminal_keys() == list(keys)
    for name, handler in before.items():
        signal.signal(name, handler)
