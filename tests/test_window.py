"""The little window, on an X server of its own (Xvfb), with keys pressed by xdotool; and none."""

import ctypes
import ctypes.util
import importlib.util
import os
import re
import shutil
import struct
import subprocess
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from films import COMMAND, HERE, environment, program

# Pygame itself is not imported here: it would set environment variables that a run then inherits.
HAS_PYGAME = importlib.util.find_spec("pygame") is not None
MISSING = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
MISSING += [] if HAS_PYGAME else ["pygame"]
needs_window = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")

PATIENCE_S = 30  # for what must come: only a test that fails waits so long
RUNNING, PAUSED = "running p: pause s: step x: quit", "PAUSED p: go on s: step x: quit"
WHITE, DARK_ORANGE = (255, 255, 255), (255, 140, 0)


class Screen:
    """An X server without a window manager, which keeps its picture in a file."""

    def __init__(self, name: str, picture: Path) -> None:
        self.name, self.picture = name, picture

    def xdotool(self, *words: str) -> str:
        return subprocess.run(["xdotool", *words], env=environment(DISPLAY=self.name), text=True,
                              capture_output=True, check=False, timeout=PATIENCE_S).stdout.strip()

    def pixels(self, left: int, top: int, width: int, height: int) -> Counter[tuple[int, int, int]]:
        """How often each colour (red, green, blue) is there."""
        content = self.picture.read_bytes()  # as xwd writes it
        header = struct.unpack(">25I", content[:100])
        row_bytes, first = header[12], header[0] + 12 * header[19]
        counts: Counter[tuple[int, int, int]] = Counter()
        for row in range(top, top + height):
            at = first + row * row_bytes + 4 * left
            counts.update((red, green, blue) for blue, green, red, _ in struct.iter_unpack(
                "4B", content[at:at + 4 * width]))
        return counts


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
        self.window = ""
        deadline_s = time.monotonic() + PATIENCE_S
        while not self.window or screen.xdotool("getwindowname", self.window) != RUNNING:
            assert time.monotonic() < deadline_s, out.read_text()[:1000]
            time.sleep(0.05)
            self.window = screen.xdotool("search", "--onlyvisible", "--pid", str(process.pid))
        screen.xdotool("windowfocus", "--sync", self.window)

    def press(self, *keys: str) -> None:
        self.screen.xdotool("key", *keys)

    def face(self) -> Counter[tuple[int, int, int]]:
        shell = self.screen.xdotool("getwindowgeometry", "--shell", self.window)
        place = dict(re.findall("([A-Z]+)=([0-9]+)", shell))
        return self.screen.pixels(*(int(place[name]) for name in ("X", "Y", "WIDTH", "HEIGHT")))

    def shows(self, caption: str, colour: tuple[int, int, int]) -> None:
        """Wait until caption and face do."""
        deadline_s = time.monotonic() + PATIENCE_S
        while True:
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
        assert re.fullmatch(rf"Stopped after [0-9]+ frames?, t = [0-9.]+ s: {why}\.",
                            out.splitlines()[-1])
        return out


@contextmanager
def run(screen: Screen, folder: Path, *command: str) -> Iterator[Film]:
    with (folder / "out").open("wb") as out, subprocess.Popen(
            command or COMMAND, stdin=subprocess.DEVNULL, stdout=out, stderr=out, cwd=HERE,
            env=environment(DISPLAY=screen.name)) as process:
        try:
            yield Film(screen, process, folder / "out")
        finally:
            process.kill()


@needs_window
def test_caption_and_face_say_which_keys_there_are_and_whether_the_film_is_paused(
        screen: Screen, tmp_path: Path) -> None:
    with run(screen, tmp_path) as film:
        film.shows(RUNNING, WHITE)
        assert film.face().total() == 300 * 20
        film.press("p")
        film.shows(PAUSED, DARK_ORANGE)
        film.press("s", "s", "ctrl+s")
        film.shows(RUNNING, WHITE)
        film.press("s")
        film.shows(PAUSED, DARK_ORANGE)
        for change in ("windowunmap", "windowmap", "windowfocus"):  # it was covered, and is not
            film.screen.xdotool(change, "--sync", film.window)
        film.shows(PAUSED, DARK_ORANGE)
        film.press("p")
        film.shows(RUNNING, WHITE)
        film.press("x")
        out = film.ends("x was pressed")
    assert "\nKeys, in the little window: p or Ctrl-S pauses" in out


@needs_window
def test_other_keys_in_the_window_do_nothing(screen: Screen, tmp_path: Path) -> None:
    with run(screen, tmp_path) as film:
        film.press("Up", "F1", "q", "shift", "alt+x", "super+x", "ISO_Level3_Shift+x",
                   "Mode_switch+x", "ctrl+x", "ctrl+semicolon", "alt+p", "ctrl+p", "p")
        film.shows(PAUSED, DARK_ORANGE)
        film.press("X")
        assert film.ends("x was pressed").count("paused") == 1


@needs_window
def test_ctrl_c_in_the_window_cuts_the_header_s_pause_short_and_then_quits(
        screen: Screen, tmp_path: Path) -> None:
    code = ("import sys, airtrack; from examples import EXAMPLES; "
            "EXAMPLES[1] = EXAMPLES[1]._replace(pause_s=1e6); sys.exit(airtrack.main(['1']))")
    with run(screen, tmp_path, COMMAND[0], "-c", code) as film:
        film.press("ctrl+c", "ctrl+c")
        assert "\n   *\n  * *\n *   *\n  * *\n   *\n" in film.ends("Ctrl-C was pressed")


@needs_window
def test_esc_and_closing_the_window_quit(screen: Screen, tmp_path: Path) -> None:
    with run(screen, tmp_path) as film:
        film.press("Escape")
        film.ends("Esc was pressed")
    with run(screen, tmp_path) as film:
        close(screen.name, int(film.window))
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
    from test_terminal import Terminal

    with Terminal(*COMMAND, env=environment(DISPLAY=screen.name)) as terminal:
        terminal.until("Keys, in the little window and in this terminal: p ", "FPS")
        terminal.type("p")
        terminal.until("paused")
        window = screen.xdotool("search", "--onlyvisible", "--pid", str(terminal.program.pid))
        assert screen.xdotool("getwindowname", window) == PAUSED
        screen.xdotool("windowfocus", "--sync", window, "key", "p")
        terminal.until("FPS", "FPS")
        terminal.program.terminate()
        terminal.until(": SIGTERM.")
        terminal.ends(143)


@needs_window
def test_the_sound_system_is_left_alone(screen: Screen) -> None:
    code = ("import airtrack, pygame; airtrack.main(['0', '--frames', '3']); "
            "assert pygame.mixer.get_init() is None")
    done = subprocess.run([COMMAND[0], "-c", code], env=environment(DISPLAY=screen.name), cwd=HERE,
                          text=True, capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "No window" not in done.stdout


# Without a window.

def told_why(**changes: str | None) -> str:
    """Why there is no window: one line, and the film runs."""
    done = program("--frames", "2", **changes)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("\nStopped after 2 frames, t = 0.03 s: that is the frame limit.\n")
    assert "Hello from" not in done.stdout  # as pygame greets
    told = re.findall(r"^No window for the keys: (.*)\.$", done.stdout, re.MULTILINE)
    assert len(told) == 1
    return str(told[0])


@pytest.mark.parametrize(("file", "text", "why"), [
    ("pygame.py", "raise ModuleNotFoundError('No module', name='pygame')", "is not installed"),
    ("pygame.py", "import no_such_module", "does not work (ModuleNotFoundError)"),
    ("pygame.py", "raise ImportError('x')", "does not work (ImportError)"),
    ("pygame.py", "import warnings; warnings.warn('old'); raise RuntimeError",
     "does not work (RuntimeError)"),
    ("pygame.py", "raise OSError('libSDL2.so')", "does not work (OSError)"),
    ("pygame.py", "raise SystemExit(3)", "does not work (SystemExit)"),
    ("pygame.py", "def", "does not work (SyntaxError)"),
    ("pygame/__init__.py", "", "does not work (ModuleNotFoundError)")])
def test_with_a_broken_pygame_one_line_says_so_and_the_film_runs(
        file: str, text: str, why: str, tmp_path: Path) -> None:
    (tmp_path / "pygame").mkdir()
    (tmp_path / file).write_text(text)
    assert told_why(PYTHONPATH=str(tmp_path), DISPLAY=":0") == f"pygame {why}"


@pytest.mark.skipif(not HAS_PYGAME, reason="not installed: pygame")
@pytest.mark.parametrize("changes", [
    {}, {"DISPLAY": ":4711"}, {"DISPLAY": ":0", "SDL_VIDEODRIVER": "dummy"},
    {"DISPLAY": ":0", "SDL_VIDEODRIVER": "offscreen"},
    {"DISPLAY": ":0", "SDL_VIDEODRIVER": "nonsense"}], ids=str)
def test_without_a_display_one_line_says_so_and_the_film_runs(changes: dict[str, str]) -> None:
    assert told_why(**changes) == "there is no display"
