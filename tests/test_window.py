"""The little window, on an X server of its own (Xvfb), with keys pressed by xdotool; and none."""

import ctypes
import ctypes.util
import importlib.util
import os
import re
import shutil
import struct
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from films import COMMAND, HERE, environment

# Pygame itself is not imported here: it would set environment variables that a run then inherits.
HAS_PYGAME = importlib.util.find_spec("pygame") is not None
MISSING = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
MISSING += [] if HAS_PYGAME else ["pygame"]
needs_window = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")

PATIENCE_S = 30  # for what must come: only a test that fails waits so long
RUNNING, PAUSED = "running p: pause s: step x: quit", "PAUSED p: resume s: step x: quit"
WHITE, DARK_ORANGE = (255, 255, 255), (255, 140, 0)


class Screen(NamedTuple):
    """An X server without a window manager, which keeps its picture in a file."""

    name: str
    picture: Path

    def xdotool(self, *words: str) -> str:
        return subprocess.run(["xdotool", *words], env=environment(DISPLAY=self.name), text=True,
                              capture_output=True, check=False, timeout=PATIENCE_S).stdout.strip()

    def window_of(self, process: "subprocess.Popen[bytes]") -> str:
        """Its window, when it has come."""
        return self.xdotool("search", "--sync", "--onlyvisible", "--pid", str(process.pid))


@pytest.fixture(scope="module")
def screen(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Screen]:
    read, write = os.pipe()
    folder = tmp_path_factory.mktemp("screen")
    # Without -noreset it starts anew when its last window closes, and loses what comes meanwhile.
    with subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24",
                           "-noreset", "-fbdir", str(folder)], pass_fds=[write],
                          stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as pipe:
            yield Screen(f":{pipe.readline().strip()}", folder / "Xvfb_screen0")
        server.terminate()


class Film:
    """A run with a window. Its output goes into a file, so only the window has keys."""

    def __init__(self, screen: Screen, process: "subprocess.Popen[bytes]", out: Path) -> None:
        self.screen, self.process, self.out = screen, process, out
        self.window = screen.window_of(process)
        self.shows(RUNNING, WHITE)
        screen.xdotool("windowfocus", "--sync", self.window)

    def press(self, *keys: str) -> None:
        self.screen.xdotool("key", *keys)

    def place(self) -> list[int]:
        """Left, top, width and height."""
        geometry = self.screen.xdotool("getwindowgeometry", "--shell", self.window)
        return [int(re.findall(f"{name}=([0-9]+)", geometry)[0])
                for name in ("X", "Y", "WIDTH", "HEIGHT")]

    def face(self, margin_px: int = 0) -> Counter[tuple[int, int, int]]:
        """How often each colour (red, green, blue) is on it, or on its left and right margins."""
        left, top, width, height = self.place()
        content = self.screen.picture.read_bytes()  # as xwd writes it: header, colours, rows
        header = struct.unpack(">25I", content[:100])
        counts: Counter[tuple[int, int, int]] = Counter()
        for row in range(top, top + height):
            at = header[0] + 12 * header[19] + header[12] * row + 4 * left
            pixels = list(struct.iter_unpack("4B", content[at:at + 4 * width]))
            counts.update((red, green, blue) for blue, green, red, _ in (
                pixels[:margin_px] + pixels[-margin_px:] if margin_px else pixels))
        return counts

    def shows(self, caption: str, colour: tuple[int, int, int]) -> None:
        """Wait until caption and face do."""
        deadline_s = time.monotonic() + PATIENCE_S
        while True:
            assert self.process.poll() is None, self.out.read_text()[-200:]
            shown, counts = self.screen.xdotool("getwindowname", self.window), self.face()
            is_text = sum(count for (r, g, b), count in counts.items() if r + g + b < 100) > 100
            if shown == caption and counts[colour] > 300 * 20 / 2 and is_text:
                return
            assert time.monotonic() < deadline_s, (shown, counts.most_common(3))
            time.sleep(0.05)

    def ends(self, why: str) -> str:
        """Wait for the end: with this reason. All that was printed."""
        assert self.process.wait(PATIENCE_S) == 0
        out = self.out.read_text()
        assert f" s: {why}.\n" in out
        return out


@pytest.fixture
def film(screen: Screen, tmp_path: Path) -> Iterator[Film]:
    with (tmp_path / "out").open("wb") as out, subprocess.Popen(
            COMMAND, stdin=subprocess.DEVNULL, stdout=out, stderr=out, cwd=HERE,
            env=environment(DISPLAY=screen.name, SDL_VIDEODRIVER=None)) as process:
        try:
            yield Film(screen, process, tmp_path / "out")
        finally:
            process.kill()


@needs_window
def test_caption_and_face_say_which_keys_there_are_and_whether_the_film_is_paused(
        film: Film) -> None:
    assert film.place() == [60, 60, 300, 20]  # away from the film's newest line
    assert set(film.face(margin_px=3)) == {WHITE}  # no word is cut off
    film.press("p")
    film.shows(PAUSED, DARK_ORANGE)
    assert set(film.face(margin_px=3)) == {DARK_ORANGE}
    film.press("s", "s", "ctrl+s")
    film.shows(RUNNING, WHITE)
    film.press("s")
    film.shows(PAUSED, DARK_ORANGE)
    for change in ("windowunmap", "windowmap", "windowfocus"):  # it was covered, and is not
        film.screen.xdotool(change, "--sync", film.window)
    film.shows(PAUSED, DARK_ORANGE)
    film.press("p")
    film.shows(RUNNING, WHITE)
    film.press("Escape")
    assert "\nKeys, in the little window: p or Ctrl-S pauses" in film.ends("Esc was pressed")


@needs_window
def test_other_keys_in_the_window_do_nothing(film: Film) -> None:
    film.press("Up", "F1", "q", "shift", "alt+x", "super+x", "ISO_Level3_Shift+x",
               "203+x", "ctrl+x", "ctrl+semicolon", "alt+p", "ctrl+p", "p")  # 203: Mode_switch
    film.shows(PAUSED, DARK_ORANGE)
    film.press("X")
    assert film.ends("x was pressed").count("paused") == 1


@needs_window
def test_closing_the_window_quits(film: Film) -> None:
    close(film.screen.name, int(film.window))
    film.ends("the window was closed")


def close(display: str, window: int) -> None:
    """Click the window's x, as a window manager tells it: WM_PROTOCOLS, WM_DELETE_WINDOW."""
    x11 = ctypes.CDLL(ctypes.util.find_library("X11") or pytest.skip("libX11 is not installed"))
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XInternAtom.restype = ctypes.c_ulong
    server = ctypes.c_void_p(x11.XOpenDisplay(display.encode()))
    protocols, delete = (x11.XInternAtom(server, name, 0)
                         for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
    # An XClientMessageEvent, in an XEvent's size: type, serial, send_event, display, ...
    event = (ctypes.c_long * 24)(33, 0, 0, 0, window, protocols, 32, delete)
    x11.XSendEvent(server, ctypes.c_ulong(window), 0, 0, event)
    x11.XCloseDisplay(server)


@needs_window
def test_window_and_terminal_serve_together_and_a_signal_ends_both(screen: Screen) -> None:
    from test_terminal import Terminal, quick

    with Terminal(*quick(pause_s=1e6), DISPLAY=screen.name, SDL_VIDEODRIVER=None) as terminal:
        terminal.until("Keys, in the little window and in this terminal: p ", "to begin.\r\n")
        terminal.press("p")
        terminal.until("paused")
        window = screen.window_of(terminal.program)
        assert screen.xdotool("getwindowname", window) == PAUSED
        screen.xdotool("windowfocus", "--sync", window, "key", "ctrl+c")
        terminal.until("   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n", "FPS", "FPS")
        terminal.press("SIGTERM")
        terminal.ends(143)


def why_shut(**changes: str | None) -> str:
    """Why a window stays shut; and nothing else is said, by pygame or by the sound system."""
    code = ("import sys; from examples import Window; window = Window(); window.open(); "
            "mixer = sys.modules.get('pygame.mixer'); assert not (mixer and mixer.get_init()); "
            "print(window.why_shut)")
    done = subprocess.run([COMMAND[0], "-c", code], env=environment(**changes), cwd=HERE, text=True,
                          capture_output=True, check=False, timeout=PATIENCE_S)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.removesuffix("\n")


@needs_window
def test_it_opens_without_a_word_and_leaves_the_sound_system_alone(screen: Screen) -> None:
    assert why_shut(DISPLAY=screen.name, SDL_VIDEODRIVER=None) == ""


@pytest.mark.parametrize(("text", "why"), [
    ("raise ModuleNotFoundError('No module', name='pygame')", "is not installed"),
    ("import no_such_module", "does not work (ModuleNotFoundError)"),
    ("", "does not work (ModuleNotFoundError)"), ("def", "does not work (SyntaxError)"),
    ("import warnings; warnings.warn('old'); raise OSError", "does not work (OSError)"),
    ("raise SystemExit(3)", "does not work (SystemExit)")])
def test_without_a_pygame_that_works_it_stays_shut(text: str, why: str, tmp_path: Path) -> None:
    (tmp_path / "pygame").mkdir()
    (tmp_path / "pygame/__init__.py").write_text(text)
    assert why_shut(PYTHONPATH=str(tmp_path), DISPLAY=":0") == f"pygame {why}"


@pytest.mark.skipif(sys.platform != "linux" or not HAS_PYGAME, reason="needs X11, and pygame")
@pytest.mark.parametrize(("display", "driver"), [
    (None, None), (":4711", None), (":0", "dummy"), (":0", "offscreen"), (":0", "nonsense")])
def test_without_a_display_it_stays_shut(display: str | None, driver: str | None) -> None:
    assert why_shut(DISPLAY=display, SDL_VIDEODRIVER=driver) == "there is no display"
