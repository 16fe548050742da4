"""The little window, on an X server of its own (Xvfb), with keys pressed by xdotool."""

import ctypes
import ctypes.util
import os
import re
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from films import COMMAND, environment

MISSING = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
pytestmark = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
pytest.importorskip("pygame", reason="pygame is not installed")

PATIENCE_S = 30


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    """An X server without a window manager; its name, such as :3."""
    read, write = os.pipe()
    with subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24"],
                          pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as pipe:
            yield f":{pipe.readline().strip()}"
        server.terminate()


class Run:
    """A run with a window; its output goes into a pipe, so only the window has keys."""

    def __init__(self, display: str, program: "subprocess.Popen[str]") -> None:
        self.display, self.program = display, program
        self.window = self.xdotool("search", "--sync", "--class", "airtrack").split()[0]
        self.xdotool("windowfocus", "--sync", self.window)

    def xdotool(self, *words: str) -> str:
        return subprocess.run(["xdotool", *words], env=environment(DISPLAY=self.display), text=True,
                              capture_output=True, check=True, timeout=PATIENCE_S).stdout

    def press(self, key: str) -> None:
        self.xdotool("key", key)

    def caption(self) -> str:
        return self.xdotool("getwindowname", self.window).strip()

    def shows(self, text: str) -> None:
        """Wait until the caption has the text."""
        deadline_s = time.monotonic() + PATIENCE_S
        while text not in self.caption():
            assert time.monotonic() < deadline_s, self.caption()
            time.sleep(0.05)

    def ending(self) -> str:
        out, err = self.program.communicate(timeout=PATIENCE_S)
        assert err == ""
        assert self.program.returncode == 0
        return re.sub("[0-9]+", "N", out.splitlines()[-1])


@contextmanager
def run(display: str, *words: str) -> Iterator[Run]:
    with subprocess.Popen([*COMMAND, *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True,
                          env=environment(DISPLAY=display)) as program:
        try:
            yield Run(display, program)
        finally:
            program.kill()


@pytest.mark.parametrize(("key", "why"), [
    ("x", "x was pressed"), ("Escape", "Esc was pressed"), ("ctrl+c", "Ctrl-C was pressed"),
    ("X", "x was pressed")])
def test_a_key_in_the_window_quits(key: str, why: str, display: str) -> None:
    with run(display, "0") as shown:
        shown.shows("running")
        time.sleep(0.1)  # let the film begin
        shown.press(key)
        assert shown.ending() == f"Stopped after N frames: {why}."


@pytest.mark.parametrize("key", ["p", "ctrl+s"])
def test_a_key_in_the_window_pauses_and_resumes_and_the_caption_says_so(
        key: str, display: str) -> None:
    with run(display, "0") as shown:
        for state in ("running p: pause x: quit", "PAUSED p: go on x: quit",
                      "running p: pause x: quit"):
            shown.shows(state)
            shown.press(key)
        shown.press("x")
        assert shown.ending() == "Stopped after N frames: x was pressed."


@pytest.mark.parametrize("key", ["Up", "F1", "alt+x", "shift", "q", "ctrl+x", "ctrl+p"])
def test_other_keys_do_nothing(key: str, display: str) -> None:
    with run(display, "0") as shown:
        shown.press(key)
        shown.press("p")
        shown.shows("PAUSED")
        shown.press("x")
        assert shown.ending() == "Stopped after N frames: x was pressed."


def test_ctrl_c_in_the_window_cuts_the_header_s_pause_short(display: str) -> None:
    with run(display, "10") as shown:
        shown.press("ctrl+c")
        shown.press("x")
        out, _ = shown.program.communicate(timeout=PATIENCE_S)
        assert "\n   *\n  * *\n *   *\n  * *\n   *\n" in out


def test_closing_the_window_quits(display: str) -> None:
    with run(display, "0") as shown:
        close(display, int(shown.window))
        assert shown.ending() == "Stopped after N frames: the window was closed."


def test_the_window_is_300_by_20(display: str) -> None:
    with run(display, "0") as shown:
        geometry = shown.xdotool("getwindowgeometry", "--shell", shown.window)
        assert "WIDTH=300\nHEIGHT=20\n" in geometry


def test_the_sound_system_is_left_alone(display: str) -> None:
    code = ("import airtrack, pygame; airtrack.main(['0', '--frames', '3']); "
            "assert pygame.mixer.get_init() is None")
    done = subprocess.run([COMMAND[0], "-c", code], env=environment(DISPLAY=display),
                          cwd=os.path.dirname(COMMAND[1]), text=True, capture_output=True,
                          check=False)
    assert (done.returncode, done.stderr) == (0, "")


class ClientMessage(ctypes.Structure):
    """Xlib's XClientMessageEvent, padded to an XEvent's size."""

    _fields_ = (
        ("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong),
        ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("pad", ctypes.c_long * 24))


def close(display: str, window: int) -> None:
    """Click the window's x, as a window manager tells it: WM_PROTOCOLS, WM_DELETE_WINDOW."""
    x11 = ctypes.CDLL(ctypes.util.find_library("X11") or pytest.skip("libX11 is not installed"))
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XInternAtom.restype = ctypes.c_ulong
    server = ctypes.c_void_p(x11.XOpenDisplay(display.encode()))
    protocols, delete = (x11.XInternAtom(server, name, 0)
                         for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
    message = ClientMessage(type=33, window=window, message_type=protocols, format=32)
    message.data[0] = delete
    x11.XSendEvent(server, ctypes.c_ulong(window), 0, 0, ctypes.byref(message))
    x11.XCloseDisplay(server)
