"""The little window, on an X server of its own (Xvfb), with keys pressed by xdotool; and none."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from PIL import ImageGrab
from test_terminal import FRAME, HELD, until_it_is_paused

from clock import plain
from films import COMMAND, PATIENCE_S, Terminal, environment, quick

# Pygame itself is not imported here: it would set environment variables that a run then inherits.
HAS_PYGAME = importlib.util.find_spec("pygame") is not None

@pytest.fixture(scope="module")
def server() -> Iterator[tuple[str, int]]:
    """The name and the process of an X server without a window manager."""
    if not (HAS_PYGAME and shutil.which("Xvfb") and shutil.which("xdotool")):
        pytest.skip("needs pygame, Xvfb and xdotool")
    read, write = os.pipe()
    # Without -noreset it starts anew when its last window closes, and loses what comes meanwhile.
    with subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24",
                           "-noreset"], pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as pipe:
            yield f":{pipe.readline().strip()}", server.pid
        server.terminate()

@pytest.fixture
def screen(server: tuple[str, int]) -> str:
    return server[0]

def xdotool(screen: str, words: str) -> str:
    return subprocess.run(["xdotool", *words.split()], env=environment(DISPLAY=screen), text=True,
                          capture_output=True, check=False, timeout=PATIENCE_S).stdout.strip()

def find_window(screen: str, film: Terminal) -> None:
    """Wait for the window of a film, and let it have the keys."""
    film.until("Ctrl-C")  # this is said when caption and face are there
    search = f"search --sync --onlyvisible --pid {film.program.pid}"
    xdotool(screen, f"{search} windowfocus --sync")

def face_is_readable(screen: str) -> bool:
    """Whether the window, the only thing on a black screen, shows a text that is not cut off."""
    picture = ImageGrab.grab(xdisplay=screen).convert("L")
    face = picture.crop(picture.getbbox())
    width, height = face.size
    middle, sides = face.crop((20, 0, width - 20, height)), [
        face.crop((left, 0, left + 3, height)) for left in (0, width - 3)]
    white = (255, 255)
    return middle.getextrema() != white and all(side.getextrema() == white for side in sides)

def test_caption_and_face_say_what_the_keys_do_and_they_do_it(screen: str) -> None:
    with Terminal(*HELD, DISPLAY=screen, SDL_VIDEODRIVER=None) as film:
        find_window(screen, film)
        caption = xdotool(screen, "getwindowfocus getwindowname")
        assert re.search(r"(?i)\benter\b.*\bp\b.*\bs\b.*\bx\b", caption)
        xdotool(screen, "key Return")
        film.until(FRAME)
        assert face_is_readable(screen)
        for key in ("p", "ctrl+s"):
            xdotool(screen, f"key {key}")
            until_it_is_paused(film)
            xdotool(screen, f"key {key}")
            film.goes_on()
        xdotool(screen, "key s")
        until_it_is_paused(film)
        xdotool(screen, "getwindowfocus windowunmap --sync windowmap --sync windowfocus --sync")
        xdotool(screen, "key p")
        film.goes_on()
        assert face_is_readable(screen)  # as after another window has covered it
        xdotool(screen, "key Escape")
        film.ends(0)
        assert re.search(r"Stopped after .*\bEsc\b", film.all)
        assert "Hello" not in film.all  # pygame says that if it is not told to be silent

def test_other_keys_in_the_window_do_nothing_and_those_of_the_terminal_work(screen: str) -> None:
    with Terminal(*HELD, DISPLAY=screen, SDL_VIDEODRIVER=None) as film:
        find_window(screen, film)
        xdotool(screen, "key ctrl+c")  # begins it
        for key in ("Up", "F1", "q", "shift", "ctrl+x", "ctrl+p"):
            xdotool(screen, f"key {key}")
            film.goes_on()
        film.press("x")
        film.ends(0)

def test_closing_the_window_ends_the_film(screen: str) -> None:
    # A click on its x would post this event. But Xvfb has no window manager, so nothing to click.
    click = "pygame.event.post(pygame.event.Event(pygame.QUIT))"
    change = (f"import pygame; draw = airtrack.render_track; "
              f"airtrack.render_track = lambda *words: [{click}, draw(*words)][1]")
    with Terminal(*quick(change, pause_s=1e6), DISPLAY=screen, SDL_VIDEODRIVER=None) as film:
        find_window(screen, film)
        xdotool(screen, "key KP_Enter")
        film.until("Stopped after ", "window")
        film.ends(0)

@pytest.mark.skipif(sys.platform != "linux" or not HAS_PYGAME, reason="needs X11, and pygame")
@pytest.mark.parametrize(("option", "display", "driver", "reason"), [
    ("-S", ":0", None, "pygame"),  # without what pip has installed
    ("-u", ":0", None, "rotten"),  # with what stands below in its place
    ("-u", ":0", None, "OSError"),
    ("-u", None, None, "x11"), ("-u", ":0", "dummy", "display"),
    ("-u", ":0", "offscreen", "display"), ("-u", ":4711", None, "x11")])
def test_without_a_window_a_film_says_why_and_goes_on(
        option: str, display: str | None, driver: str | None, reason: str, tmp_path: Path) -> None:
    broken = {"rotten": "import warnings; warnings.warn('old wood'); raise OSError('rotten')",
              "OSError": "raise OSError"}  # which does not say why
    if reason in broken:
        (tmp_path / "pygame.py").write_text(broken[reason])
    with Terminal(COMMAND[0], option, COMMAND[1], "0", "d", DISPLAY=display, SDL_VIDEODRIVER=driver,
                  PYTHONPATH=str(tmp_path)) as film:
        film.press("\r")
        film.until(FRAME)
        header, _, _ = film.all.partition("|  ")
        assert re.search(rf"(?i)no window[^)]*{reason}", plain(header))
        assert "old wood" not in header
        film.press("x")
        film.ends(0)

def test_a_fast_film_does_not_touch_pygame(tmp_path: Path) -> None:
    (tmp_path / "pygame.py").write_text("import os; os._exit(9)")
    with Terminal(*COMMAND, "2", "--fast", "--frames=3", PYTHONPATH=str(tmp_path),
                  DISPLAY=":0", SDL_VIDEODRIVER=None) as film:
        film.ends(0)
