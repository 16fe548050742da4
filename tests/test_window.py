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

FACE = "Enter: begin p: pause s: step x: quit"
WHITE, BLACK = (255, 255, 255), (0, 0, 0)


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
        self.shows_its_keys()
        screen.xdotool("windowfocus", "--sync", self.window)

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

    def shows_its_keys(self) -> None:
        """Wait until caption and face do, and no word is cut off."""
        deadline_s = time.monotonic() + PATIENCE_S
        while True:
            assert self.process.poll() is None, self.out.read_text()[-200:]
            shown, counts = self.screen.xdotool("getwindowname", self.window), self.face()
            words = " ".join(shown.split())
            if words == FACE and counts[WHITE] > 300 * 20 / 2 and counts[BLACK] > 100:
                break
            assert time.monotonic() < deadline_s, (shown, counts.most_common(3))
            time.sleep(0.05)
        assert set(self.face(margin_px=3)) == {WHITE}

    def goes_on(self) -> None:
        """Wait for some more frames, and so for a look at the keys."""
        size, deadline_s = self.out.stat().st_size, time.monotonic() + PATIENCE_S
        while self.out.stat().st_size < size + 1000:
            assert time.monotonic() < deadline_s
            time.sleep(0.01)

    def stands_still(self) -> None:
        """Wait until no more frames come."""
        deadline_s, size = time.monotonic() + PATIENCE_S, -1
        while self.out.stat().st_size != size:
            assert time.monotonic() < deadline_s
            size = self.out.stat().st_size
            time.sleep(0.4)

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
def test_caption_and_face_say_what_the_keys_do_and_they_do_it(film: Film) -> None:
    assert film.place() == [60, 60, 300, 20]  # away from the film's newest line
    film.press("Return")
    film.goes_on()
    film.press("p")
    film.stands_still()
    lines = film.out.read_text().count("\n")
    film.press("s", "s")
    film.stands_still()
    assert film.out.read_text().count("\n") == lines + 2
    for change in ("windowunmap", "windowmap", "windowfocus"):  # it was covered, and is not
        film.screen.xdotool(change, "--sync", film.window)
    film.shows_its_keys()
    film.press("ctrl+s")
    film.goes_on()
    film.press("Escape")
    assert "\nKeys in the little window: p pauses" in film.ends("Esc was pressed")


@needs_window
def test_other_keys_in_the_window_do_nothing(film: Film) -> None:
    film.press("KP_Enter")
    for key in ("Up", "F1", "q", "shift", "alt+x", "super+x", "ISO_Level3_Shift+x",
                "203+x", "ctrl+x", "ctrl+semicolon", "alt+p", "ctrl+p"):  # 203: Mode_switch
        film.press(key)
        film.goes_on()
    film.press("X")
    film.ends("x was pressed")


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
        window = screen.window_of(terminal.program)
        screen.xdotool("windowfocus", "--sync", window, "key", "ctrl+c")
        terminal.until("   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n", "FPS", "FPS")
        terminal.press("SIGTERM")
        terminal.ends(143)


def why_shut(*options: str, **changes: str | None) -> str:
    """Why a window stays shut; and nothing else is said, by pygame or by the sound system."""
    code = ("import sys; from examples import Window; window = Window(); "
            "mixer = sys.modules.get('pygame.mixer'); assert not (mixer and mixer.get_init()); "
            "print(window.why_shut)")
    done = subprocess.run([COMMAND[0], *options, "-c", code], env=environment(**changes), cwd=HERE,
                          text=True, capture_output=True, check=False, timeout=PATIENCE_S)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.removesuffix("\n")


@needs_window
def test_it_opens_without_a_word_and_leaves_the_sound_system_alone(screen: Screen) -> None:
    assert why_shut(DISPLAY=screen.name, SDL_VIDEODRIVER=None) == ""


def test_without_pygame_it_stays_shut_and_says_that() -> None:
    assert why_shut("-S", DISPLAY=":0") == "pygame is not installed"  # -S: without site-packages


@pytest.mark.parametrize(("text", "fault"), [
    ("raise ModuleNotFoundError('No module', name='pygame')", "No module"),
    ("def", "invalid syntax (__init__.py, line 1)"),
    ("import warnings; warnings.warn('old'); raise OSError(7)", "7")])
def test_with_a_broken_pygame_it_stays_shut_and_says_the_fault(
        text: str, fault: str, tmp_path: Path) -> None:
    (tmp_path / "pygame").mkdir()
    (tmp_path / "pygame/__init__.py").write_text(text)
    assert why_shut(PYTHONPATH=str(tmp_path), DISPLAY=":0") == f"pygame does not work: {fault}"


@pytest.mark.skipif(sys.platform != "linux" or not HAS_PYGAME, reason="needs X11, and pygame")
@pytest.mark.parametrize(("display", "driver", "why"), [
    (None, None, "there is no display"), ("", None, "there is no display"),
    (":0", "dummy", "there is no display"), (":0", "offscreen", "there is no display"),
    (":4711", None, "pygame does not work: x11 not available")])
def test_without_a_display_that_shows_something_it_stays_shut_and_says_why(
        display: str | None, driver: str | None, why: str) -> None:
    assert why_shut(DISPLAY=display, SDL_VIDEODRIVER=driver) == why
