"""The little window, on an X server of its own (Xvfb), with keys pressed by xdotool; and none."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PIL import ImageGrab
from test_terminal import FRAME, HELD, falls_silent

from clock import plain
from films import COMMAND, PATIENCE_S, Terminal, environment, quick

# Pygame itself is not imported here: it would set environment variables that a run then inherits.
HAS_PYGAME = importlib.util.find_spec("pygame") is not None


@pytest.fixture(scope="module")
def screen() -> Iterator[str]:
    """The name of an X server without a window manager."""
    missing = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
    if missing or not HAS_PYGAME:
        pytest.skip(f"needs Xvfb, xdotool and pygame: not installed are {missing or 'pygame'}")
    read, write = os.pipe()
    # Without -noreset it starts anew when its last window closes, and loses what comes meanwhile.
    with subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24",
                           "-noreset"], pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as pipe:
            yield f":{pipe.readline().strip()}"
        server.terminate()


def xdotool(screen: str, words: str) -> str:
    return subprocess.run(["xdotool", *words.split()], env=environment(DISPLAY=screen), text=True,
                          capture_output=True, check=False, timeout=PATIENCE_S).stdout.strip()


def find_window(screen: str, film: Terminal) -> None:
    """Wait for the window of a film, and let it have the keys."""
    search = f"search --sync --onlyvisible --pid {film.program.pid}"
    xdotool(screen, f"{search} windowfocus --sync")


def wait_for(is_so: Callable[[], bool]) -> None:
    deadline_s = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < deadline_s
        time.sleep(0.05)


def test_caption_and_face_say_what_the_keys_do_and_they_do_it(screen: str) -> None:
    def has_text() -> bool:
        """Whether the screen has more than the black around the window and its white."""
        return len(ImageGrab.grab(xdisplay=screen).getcolors() or []) > 2

    with Terminal(*HELD, DISPLAY=screen, SDL_VIDEODRIVER=None) as film:
        find_window(screen, film)
        caption = xdotool(screen, "getwindowfocus getwindowname")
        assert re.search(r"(?i)\benter\b.*\bp\b.*\bs\b.*\bx\b", caption)
        wait_for(has_text)
        xdotool(screen, "key Return")
        film.until(FRAME)
        for key in ("p", "ctrl+s"):
            xdotool(screen, f"key {key}")
            falls_silent(film)
            xdotool(screen, f"key {key}")
            film.goes_on()
        xdotool(screen, "key s")
        falls_silent(film)
        xdotool(screen, "getwindowfocus windowunmap --sync windowmap --sync windowfocus --sync")
        wait_for(has_text)  # as after another window has covered it
        xdotool(screen, "key Escape")
        film.ends(0)
        assert re.search(r"Stopped after .*\bEsc\b", film.all)
        assert "Hello" not in film.all  # pygame says that if it is not told to be silent


def test_other_keys_in_the_window_do_nothing_and_those_of_the_terminal_work(screen: str) -> None:
    with Terminal(*HELD, DISPLAY=screen, SDL_VIDEODRIVER=None) as film:
        find_window(screen, film)
        xdotool(screen, "key ctrl+c")  # begins it
        for key in ("Up", "F1", "q", "shift", "alt+x", "super+x", "ISO_Level3_Shift+x", "203+x",
                    "ctrl+x", "ctrl+semicolon", "alt+p", "ctrl+p"):  # 203 is Mode_switch, as AltGr
            xdotool(screen, f"key {key}")
            film.goes_on()
        film.press("x")
        film.ends(0)


def test_closing_the_window_ends_the_film_and_after_a_film_the_window_is_shut(screen: str) -> None:
    # A click on its x would post this event. But Xvfb has no window manager, so nothing to click.
    click = "pygame.event.post(pygame.event.Event(pygame.QUIT))"
    change = (f"import pygame; step, real = airtrack.step, airtrack.main; "
              f"airtrack.step = lambda *words: [{click}, step(*words)][1]; "
              "airtrack.main = lambda: [real(), print('it is ov' + 'er', flush=True), input()][0]")
    with Terminal(*quick(change, pause_s=1e6), DISPLAY=screen, SDL_VIDEODRIVER=None) as film:
        find_window(screen, film)
        xdotool(screen, "key KP_Enter")
        film.until("Stopped after ", "window", "it is over")
        wait_for(lambda: not xdotool(screen, "search --onlyvisible --name ."))
        film.press("\n")
        film.ends(0)


@pytest.mark.skipif(sys.platform != "linux" or not HAS_PYGAME, reason="needs X11, and pygame")
@pytest.mark.parametrize(("option", "display", "driver", "reason"), [
    ("-S", ":0", None, "pygame"),  # without what pip has installed
    ("-u", ":0", None, "worm-eaten"),  # with what stands below in its place
    ("-u", None, None, "display"), ("-u", ":0", "dummy", "display"),
    ("-u", ":0", "offscreen", "display"), ("-u", ":4711", None, "x11")])
def test_without_a_window_a_film_says_why_and_goes_on(
        option: str, display: str | None, driver: str | None, reason: str, tmp_path: Path) -> None:
    broken = "import warnings; warnings.warn('old wood'); raise OSError('worm-eaten')"
    if reason == "worm-eaten":
        (tmp_path / "pygame.py").write_text(broken)
    with Terminal(COMMAND[0], option, COMMAND[1], "0", DISPLAY=display, SDL_VIDEODRIVER=driver,
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
