"""The little window, on an X server of its own (Xvfb), with keys pressed by xdotool; and none."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from PIL import Image, ImageGrab

from films import COMMAND, HERE, PATIENCE_S, Terminal, environment, quick

# Pygame itself is not imported here: it would set environment variables that a run then inherits.
HAS_PYGAME = importlib.util.find_spec("pygame") is not None
MISSING = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
MISSING += [] if HAS_PYGAME else ["pygame"]
needs_window = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")

FACE = "Enter: begin p: pause s: step x: quit"
WHITE, BLACK = (255, 255, 255), (0, 0, 0)


@pytest.fixture(scope="module")
def screen() -> Iterator[str]:
    """The name of an X server without a window manager."""
    read, write = os.pipe()
    # Without -noreset it starts anew when its last window closes, and loses what comes meanwhile.
    with subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24",
                           "-noreset"], pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as pipe:
            yield f":{pipe.readline().strip()}"
        server.terminate()


class Window:
    """The window of a film, when it has come."""

    def __init__(self, screen: str, film: Terminal) -> None:
        self.screen = screen
        self.name = self.xdotool("search", "--sync", "--onlyvisible", "--pid",
                                 str(film.program.pid))
        self.xdotool("windowfocus", "--sync", self.name)

    def xdotool(self, *words: str) -> str:
        return subprocess.run(["xdotool", *words], env=environment(DISPLAY=self.screen), text=True,
                              capture_output=True, check=False, timeout=PATIENCE_S).stdout.strip()

    def place(self) -> list[int]:
        """Left, top, width and height."""
        geometry = self.xdotool("getwindowgeometry", "--shell", self.name)
        return [int(re.findall(f"{name}=([0-9]+)", geometry)[0])
                for name in ("X", "Y", "WIDTH", "HEIGHT")]

    def face(self) -> Image.Image:
        """A screenshot."""
        left, top, width, height = self.place()
        box = left, top, left + width, top + height
        return ImageGrab.grab(box, xdisplay=self.screen)

    def shows_its_keys(self) -> None:
        """Wait until caption and face do, and no word is cut off."""
        deadline_s = time.monotonic() + PATIENCE_S
        while True:
            caption = " ".join(self.xdotool("getwindowname", self.name).split())
            face = self.face()
            counts = {colour: count for count, colour in face.getcolors() or []}
            if caption == FACE and counts.get(WHITE, 0) > 3000 and counts.get(BLACK, 0) > 100:
                break
            assert time.monotonic() < deadline_s, (caption, counts)
            time.sleep(0.05)
        width, height = face.size
        for left in (0, width - 3):
            edge = face.crop((left, 0, left + 3, height))
            assert edge.getcolors() == [(3 * height, WHITE)]


@pytest.fixture
def film(screen: str) -> Iterator[Terminal]:
    """A film whose input is no terminal, so that only its window has keys."""
    with Terminal("sh", "-c", 'exec "$@" < /dev/null', "sh", *quick(pause_s=1e6),
                  DISPLAY=screen, SDL_VIDEODRIVER=None) as terminal:
        terminal.until("Keys in the little window: p ")
        yield terminal


@needs_window
def test_caption_and_face_say_what_the_keys_do_and_they_do_it(screen: str, film: Terminal) -> None:
    window = Window(screen, film)
    window.shows_its_keys()
    assert window.place()[:2] == [60, 60]  # away from the film's newest line
    window.xdotool("key", "Return")
    film.until("FPS")
    for key in ("p", "s"):
        window.xdotool("key", key)
        film.until("paused after frame ")
    for change in ("windowunmap", "windowmap", "windowfocus"):  # it was covered, and is not
        window.xdotool(change, "--sync", window.name)
    window.shows_its_keys()
    window.xdotool("key", "ctrl+s")
    film.until("FPS")
    window.xdotool("key", "Escape")
    film.until(" s: Esc was pressed.\r\n")
    film.ends(0)


@needs_window
def test_other_keys_in_the_window_do_nothing(screen: str, film: Terminal) -> None:
    window = Window(screen, film)
    window.xdotool("key", "KP_Enter")
    for key in ("Up", "F1", "q", "shift", "alt+x", "super+x", "ISO_Level3_Shift+x",
                "203+x", "ctrl+x", "ctrl+semicolon", "alt+p", "ctrl+p"):  # 203: Mode_switch
        window.xdotool("key", key)
        film.goes_on()
    window.xdotool("key", "X")
    film.until(" s: x was pressed.\r\n")
    film.ends(0)


@needs_window
def test_closing_the_window_quits(screen: str) -> None:
    close = "pygame.event.post(pygame.event.Event(pygame.QUIT))"  # as a click on its x does
    change = f"airtrack.step = lambda *a: [{close}, real(*a)][1]"
    program = quick(f"import pygame; real = airtrack.step; {change}")
    with Terminal(*program, DISPLAY=screen, SDL_VIDEODRIVER=None) as terminal:
        terminal.until(" s: the window was closed.\r\n")
        terminal.ends(0)


@needs_window
def test_window_and_terminal_serve_together_and_a_signal_ends_both(screen: str) -> None:
    with Terminal(*quick(pause_s=1e6), DISPLAY=screen, SDL_VIDEODRIVER=None) as terminal:
        terminal.until("Keys here and in the little window: p ", "+06 s, ")
        Window(screen, terminal).xdotool("key", "ctrl+c")
        terminal.until("   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n", "FPS")
        terminal.press("s")
        terminal.until("paused after frame ")
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
def test_it_opens_without_a_word_and_leaves_the_sound_system_alone(screen: str) -> None:
    assert why_shut(DISPLAY=screen, SDL_VIDEODRIVER=None) == ""


def test_without_pygame_it_stays_shut_and_says_that() -> None:
    assert why_shut("-S", DISPLAY=":0") == "pygame is not installed"  # -S: without site-packages


@pytest.mark.parametrize(("text", "fault"), [
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
