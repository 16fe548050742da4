"""The little window, on an X server of its own (Xvfb), with keys pressed by xdotool; and none."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from PIL import ImageGrab

from films import COMMAND, HERE, PATIENCE_S, Terminal, environment, quick

# Pygame itself is not imported here: it would set environment variables that a run then inherits.
HAS_PYGAME = importlib.util.find_spec("pygame") is not None
MISSING = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
MISSING += [] if HAS_PYGAME else ["pygame"]
needs_window = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")

WAITING = "waiting Enter: begin p: hold x: quit"
RUNNING, PAUSED = "running p: pause s: step x: quit", "PAUSED p: resume s: step x: quit"
BLUE, WHITE, BLACK, DARK_ORANGE = (173, 216, 230), (255, 255, 255), (0, 0, 0), (255, 140, 0)


class Screen(NamedTuple):
    """An X server without a window manager."""

    name: str

    def xdotool(self, *words: str) -> str:
        return subprocess.run(["xdotool", *words], env=environment(DISPLAY=self.name), text=True,
                              capture_output=True, check=False, timeout=PATIENCE_S).stdout.strip()

    def window_of(self, process: "subprocess.Popen[bytes]") -> str:
        """Its window, when it has come."""
        return self.xdotool("search", "--sync", "--onlyvisible", "--pid", str(process.pid))


@pytest.fixture(scope="module")
def screen() -> Iterator[Screen]:
    read, write = os.pipe()
    # Without -noreset it starts anew when its last window closes, and loses what comes meanwhile.
    with subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24",
                           "-noreset"], pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as pipe:
            yield Screen(f":{pipe.readline().strip()}")
        server.terminate()


class Film:
    """A run with a window. Its output goes into a file, so only the window has keys."""

    def __init__(self, screen: Screen, process: "subprocess.Popen[bytes]", out: Path) -> None:
        self.screen, self.process, self.out = screen, process, out
        self.window = screen.window_of(process)
        self.shows(WAITING, BLUE)
        assert set(self.face(margin_px=3)) == {BLUE}  # no word is cut off
        screen.xdotool("windowfocus", "--sync", self.window)
        self.press("Return")
        self.shows(RUNNING, WHITE)

    def press(self, *keys: str) -> None:
        self.screen.xdotool("key", *keys)

    def place(self) -> list[int]:
        """Left, top, width and height."""
        geometry = self.screen.xdotool("getwindowgeometry", "--shell", self.window)
        return [int(re.findall(f"{name}=([0-9]+)", geometry)[0])
                for name in ("X", "Y", "WIDTH", "HEIGHT")]

    def face(self, margin_px: int = 150) -> Counter[object]:
        """How often each colour is on it, or on its left and right margins: a screenshot."""
        left, top, width, height = self.place()
        counts: Counter[object] = Counter()
        for at in (left, left + width - margin_px):
            box = at, top, at + margin_px, top + height
            for count, colour in ImageGrab.grab(box, xdisplay=self.screen.name).getcolors() or []:
                counts[colour] += count
        return counts

    def shows(self, caption: str, colour: tuple[int, int, int]) -> None:
        """Wait until caption and face do."""
        deadline_s = time.monotonic() + PATIENCE_S
        while True:
            assert self.process.poll() is None, self.out.read_text()[-200:]
            shown, counts = self.screen.xdotool("getwindowname", self.window), self.face()
            if shown == caption and counts[colour] > 300 * 20 / 2 and counts[BLACK] > 100:
                return
            assert time.monotonic() < deadline_s, (shown, counts.most_common(3))
            time.sleep(0.05)

    def goes_on(self) -> None:
        """Wait for some more frames, and so for a look at the keys."""
        size, deadline_s = self.out.stat().st_size, time.monotonic() + PATIENCE_S
        while self.out.stat().st_size < size + 1000:
            assert time.monotonic() < deadline_s
            time.sleep(0.01)

    def ends(self, why: str) -> str:
        """Wait for the end: with this reason. All that was printed."""
        assert self.process.wait(PATIENCE_S) == 0
        out = self.out.read_text()
        assert f" s: {why}.\n" in out
        return out


@pytest.fixture
def film(screen: Screen, tmp_path: Path) -> Iterator[Film]:
    with (tmp_path / "out").open("wb") as out, subprocess.Popen(
            quick(pause_s=1e6), stdin=subprocess.DEVNULL, stdout=out, stderr=out, cwd=HERE,
            env=environment(DISPLAY=screen.name, SDL_VIDEODRIVER=None)) as process:
        try:
            yield Film(screen, process, tmp_path / "out")
        finally:
            process.kill()


@needs_window
def test_caption_and_face_say_which_keys_there_are_and_whether_the_film_waits_runs_or_is_paused(
        film: Film) -> None:
    assert film.place() == [60, 60, 300, 20]  # away from the film's newest line
    assert set(film.face(margin_px=3)) == {WHITE}
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
    assert "\nKeys in the little window: p pauses" in film.ends("Esc was pressed")


@needs_window
def test_other_keys_in_the_window_do_nothing(film: Film) -> None:
    film.press("KP_Enter")
    for key in ("Up", "F1", "q", "shift", "alt+x", "super+x", "ISO_Level3_Shift+x",
                "203+x", "ctrl+x", "ctrl+semicolon", "alt+p", "ctrl+p"):  # 203: Mode_switch
        film.press(key)
        film.goes_on()
    film.press("p")
    film.shows(PAUSED, DARK_ORANGE)
    film.press("X")
    assert film.ends("x was pressed").count("paused") == 1


@needs_window
def test_closing_the_window_quits(screen: Screen) -> None:
    close = "pygame.event.post(pygame.event.Event(pygame.QUIT))"  # as a click on its x does
    program = quick("import pygame; real = airtrack.step; "
                    f"airtrack.step = lambda *a: [{close}, real(*a)][1]")
    with Terminal(*program, DISPLAY=screen.name, SDL_VIDEODRIVER=None) as terminal:
        terminal.until(" s: the window was closed.\r\n")
        terminal.ends(0)


@needs_window
def test_window_and_terminal_serve_together_and_a_signal_ends_both(screen: Screen) -> None:
    with Terminal(*quick(pause_s=1e6), DISPLAY=screen.name, SDL_VIDEODRIVER=None) as terminal:
        terminal.until("Keys here and in the little window: p ", "+06 s, ")
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
