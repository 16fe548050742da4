"""The air track's companion: the numbered examples, as data, and the keys.

An example is a title, the settings in which its scene differs from the default one, and what it
shows. The keys work in a little pygame window and in the terminal, whichever has the focus.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import sys
import time
import warnings
from typing import Any, NamedTuple

if sys.platform == "win32":
    import msvcrt
else:
    import select
    import termios


# ==== The examples ==============================================================================

class Example(NamedTuple):
    """One numbered example: a scene and what to look for in it."""

    title: str
    settings: dict[str, Any]
    look_for: str = ""
    pause_s: float = 3.0  # to read the header in
    details: bool = False  # shown even without d


ELASTIC = {"x_m": 2.0, "a_mps2": -2.0, "CR": 1.0, "show_start_mark": True}
COARSE = ELASTIC | {"fps_target": 10.0}
EXACT = COARSE | {"motion": "exact", "correction": "replay"}
QUICK = {"x_m": 1.65, "v_mps": 40.0, "CR": 1.0, "fps_target": 10.0}
IRREGULAR = {"use_observed_dt": True}

EXAMPLES = {
    0: Example("The one-pager: the whole engine in its simplest form", {
        "x_m": 11.0, "v_mps": 17.0, "a_mps2": -2.0, "CR": 0.8,
        "left_edge_m": 0.5, "right_edge_m": 17.5, "m_to_px": 7.0, "width_px": 126,
        "fps_target": 1 / 0.015, "correction": "surface", "auto_off": False,
        "show_collision_mark": False},
        details=True),
    1: Example("A first look", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.7, "show_collision_mark": False},
        "Every line is one moment: | are the walls, * is the car. Keep your eyes on the bottom row "
        "and let the lines scroll away; above it stands the car's path, time running down. The car "
        "starts at rest, is pulled to the left, and keeps 70 % of its speed at each bounce, until "
        "it rests against the wall and the run stops by itself, after 251 frames.", pause_s=5.0),
    2: Example("No correction", {
        "x_m": 1.65, "v_mps": 2.7, "CR": 1.0, "correction": "none", "show_collision_mark": False},
        "Nothing puts the car back on the track after a collision: look how it is drawn inside the "
        "walls, up to 8 cm beyond them. It is elastic (CR = 1) and nothing pulls at it, so it "
        "comes back out as fast as it went in, and never stops: press x."),
    3: Example("No correction, and stuck", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.6, "correction": "none", "auto_off": False,
        "show_collision_mark": False},
        "In frame 46 the car is beyond the left wall. It is turned round and keeps 60 % of its "
        "speed, too little to get back out in one frame against the pull. So the next frame finds "
        "it in collision again and turns it round again, inwards. It never comes back: it sinks, "
        "about 1 mm a frame, and after frame 272 it has left the picture. Press x.", pause_s=4.0),
    4: Example("A high frame rate", {
        "x_m": 0.2, "v_mps": 10.0, "a_mps2": -10.0, "CR": 0.8, "fps_target": 300.0,
        "show_collision_mark": False},
        "At 300 FPS a bounce is many lines long, and the shrinking bounces are drawn as a tail. "
        "The car starts just beyond the left wall, at 10 m/s. That is a collision in each of the "
        "first two frames, which is why it leaves the wall at 6.4 m/s."),
    5: Example("Where each collision was found", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7},
        "Pulled to the right. Each 0 is where the move alone had put the car, beyond the wall, and "
        "the * in its line is where the correction put it instead: on the other side of the wall, "
        "at 70 % of that distance. At rest after 236 frames."),
    6: Example("Example 5 zoomed out", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7, "m_to_px": 30.0},
        "The drawing changes, the physics does not: with d the figures are those of example 5, and "
        "the run ends after 236 frames again."),
    7: Example("Elastic, small steps", ELASTIC | {"fps_target": 240.0},
        "No speed is lost in a bounce, so the car should come back to the start mark, the dot at "
        "2 m, every time. At 240 FPS it does, or turns at 1.99 m, a centimetre short of it."),
    8: Example("Elastic, large steps", COARSE,
        "Example 7 at 10 FPS. The car moves as much as 0.26 m in a frame, and the correction does "
        "not know when in the frame the bounce was. After the first bounce it turns at 1.88 m, "
        "12 cm short of the start mark; after the second one, whose error undoes the first's, "
        "at the mark; and so on by turns."),
    9: Example("Elastic, large and irregular steps", COARSE | IRREGULAR,
        "Example 8 with the length that each frame really had (the observed dt). No two of them "
        "are quite the same, so neither are the bounces, nor any two runs of this example."),
    10: Example("The exact solution", EXACT,
        "Pulled to the left, elastic, at only 10 FPS. The car is moved by the formulas of "
        "kinematics, and each bounce worked out at its own moment. So it comes back to the start "
        "mark, the dot at 2 m, every time; in example 8, by Euler's method, it does not."),
    11: Example("The exact solution, irregular steps", EXACT | IRREGULAR,
        "Example 10 with the length that each frame really had. The exact solution does not depend "
        "on how the time is cut into frames: the car comes back to the start mark all the same."),
    12: Example("The exact solution, losing energy", EXACT | IRREGULAR | {"CR": 0.8},
        "Example 11, keeping 80 % of the speed at each bounce. The bounces come faster and faster: "
        "infinitely many before t = 11.91 s, the Zeno point, from where on the car is at rest."),
    13: Example("Forward Euler gains energy", COARSE | {
        "motion": "forward", "show_exact_mark": True},
        "Example 8 by forward Euler. Each step adds a^2 dt^2/2 = 0.02 m^2/s^2 to the car's energy "
        "v^2/2 - a x. So it climbs past its start mark after the first bounce, and hits the far "
        "wall in frame 24. The o is where the exact solution has the car; the error is with d."),
    14: Example("The rebound throws the car through the walls", QUICK,
        "The car moves 4 m a frame, on a track of 1.95 m. The rebound puts it as far on the other "
        "side of the wall as it was beyond it, and that is beyond the far wall: from the first "
        "frame on it is outside, 4.1 m further every other frame, and neither * nor 0 is in the "
        "picture. With d there is its position. Press x to quit."),
    15: Example("The same, settled wall by wall", QUICK | {
        "motion": "exact", "correction": "replay"},
        "Example 14 by the exact solution. In a frame of 4 m the car meets both walls, goes 3.9 m "
        "from wall to wall and back, and is 0.1 m from where it was: it seems to creep along the "
        "track. It never stops: press x."),
    16: Example("Example 8 beside the truth", COARSE | {"show_exact_mark": True},
        "Watch the * leave the o, which is where the exact solution has the car. They are 2 cm "
        "apart in frame 2, and as much as 0.9 m within 20 s; the error is with d."),
}
OWN_SCENE = Example("Your own scene", {},
    "A car at rest, until you set it going: python airtrack.py 99 x_m=1 v_mps=3 CR=0.9 d, for "
    "example. python airtrack.py -h lists all settings.")


# ==== The terminal's keys =======================================================================

if sys.platform == "win32":
    class Terminal:
        """The keys of a Windows console, which msvcrt gives one by one and unechoed."""

        is_ours = False
        was_suspended = False

        def take(self) -> None:
            """Use the console, if there is one."""
            self.is_ours = sys.stdin.isatty() and sys.stdout.isatty()

        def give_back(self) -> None:
            """Nothing to restore: the console was not changed."""

        def read(self) -> str:
            """The keys pressed since the last call, as characters."""
            keys = ""
            while self.is_ours and msvcrt.kbhit():
                key = msvcrt.getwch()
                if key in "\x00\xe0":
                    msvcrt.getwch()  # the second half of an arrow or a function key
                else:
                    keys += key
            return keys

else:
    # What a terminal sends for a key that is no character: Esc [ ... for an arrow, Esc O ... for
    # F1, Esc and the character for Alt. Only an Esc that nothing follows is the Esc key.
    SEQUENCE = re.compile(r"\x1b+(\[[0-?]*[ -/]*[@-~]|O?[^\x1b])")
    UNFINISHED = re.compile(r"\x1b(\[[0-?]*[ -/]*|O)?$")

    def is_in_foreground() -> bool:
        """Whether the terminal is this process's to read from and to set."""
        try:
            return os.tcgetpgrp(0) == os.getpgrp()
        except OSError:  # not its controlling terminal
            return False

    class Terminal:
        """The keys of a terminal, one by one, unechoed; it is left as it was found."""

        is_ours = False
        was_suspended = False

        def take(self) -> None:
            """Use the terminal, if there is one and this process is in its foreground.

            With the output in a pipe, the terminal is left to the program at the pipe's end.
            """
            if os.isatty(0) and os.isatty(1) and is_in_foreground():
                self.found = termios.tcgetattr(0)
                self.is_ours = True
                self.handlers = [(number, signal.signal(number, handler)) for number, handler in (
                    (signal.SIGTSTP, self.suspend), (signal.SIGCONT, self.resume))]
                self.set_mode()

        def set_mode(self) -> None:
            """Keys without waiting for Enter, without echo, and with Ctrl-S as a key."""
            mode = termios.tcgetattr(0)
            mode[0] &= ~termios.IXON
            mode[3] &= ~(termios.ICANON | termios.ECHO)
            termios.tcsetattr(0, termios.TCSANOW, mode)

        def restore_mode(self) -> None:
            """The terminal as it was found."""
            with contextlib.suppress(termios.error):  # it may be gone
                termios.tcsetattr(0, termios.TCSANOW, self.found)

        def suspend(self, *_: object) -> None:
            """Ctrl-Z: lend the terminal to the shell until fg."""
            self.restore_mode()
            signal.signal(signal.SIGTSTP, signal.SIG_DFL)
            signal.raise_signal(signal.SIGTSTP)  # the process stops here
            signal.signal(signal.SIGTSTP, self.suspend)
            self.resume()

        def resume(self, *_: object) -> None:
            """After a suspension (also one by SIGSTOP, which calls nothing): take it again."""
            self.set_mode()
            self.was_suspended = True

        def give_back(self) -> None:
            """Leave the terminal as it was found."""
            if self.is_ours:
                self.restore_mode()
                for number, handler in self.handlers:
                    signal.signal(number, handler)
                self.is_ours = False

        def read(self) -> str:
            """The keys pressed since the last call, as characters."""
            keys = ""
            # A sequence may come in two pieces: the rest follows at once, or never.
            while self.is_ours and select.select(
                    [0], [], [], 0.05 if UNFINISHED.search(keys) else 0)[0]:
                piece = os.read(0, 1024)
                if not piece:
                    break
                keys += piece.decode("ascii", "ignore")
            return SEQUENCE.sub("", keys)


# ==== The window's keys =========================================================================

WINDOW_CLOSED = "closed"


class Window:
    """The little pygame window. Without pygame or a display it stays shut and says why."""

    why_shut = "not opened"
    pygame: Any

    def open(self) -> None:
        """Open the window, or set why_shut.

        Only pygame's display and font are initialised: its sound prints errors where there is none.
        """
        if sys.platform == "linux" and "WAYLAND_DISPLAY" not in os.environ:
            if "DISPLAY" not in os.environ:
                self.why_shut = "there is no display"
                return
            os.environ.setdefault("SDL_VIDEODRIVER", "x11")  # trying Wayland prints an error
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
        os.environ.setdefault("SDL_VIDEO_WINDOW_POS", "60,60")  # not over the film's newest line
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # pygame's own, about setuptools
                import pygame
                import pygame.font
        except ImportError:
            self.why_shut = "pygame is not installed"
            return
        try:
            pygame.display.init()
            if pygame.display.get_driver() in ("dummy", "offscreen"):  # they show nothing
                raise pygame.error("no display")
            pygame.display.set_mode((300, 20))
        except pygame.error:
            pygame.display.quit()
            self.why_shut = "there is no display"
            return
        pygame.font.init()
        self.pygame, self.why_shut = pygame, ""
        self.show(paused=False)

    def show(self, paused: bool) -> None:
        """Say on the window's face and in its caption which keys do what now."""
        if not self.why_shut:
            words = "PAUSED   p: go on   x: quit" if paused else "running   p: pause   x: quit"
            self.pygame.display.set_caption(" ".join(words.split()))  # no room for more
            surface = self.pygame.display.get_surface()
            surface.fill("darkorange" if paused else "white")
            text = self.pygame.font.Font(None, 22).render(words, True, "black")
            surface.blit(text, text.get_rect(center=surface.get_rect().center))
            self.pygame.display.flip()

    def read(self) -> list[str]:
        """The keys pressed since the last call, as a terminal would give them."""
        keys = []
        for event in [] if self.why_shut else self.pygame.event.get():
            if event.type == self.pygame.QUIT:
                keys.append(WINDOW_CLOSED)
            elif event.type == self.pygame.VIDEOEXPOSE:  # it was covered
                self.pygame.display.flip()
            elif (event.type == self.pygame.KEYDOWN and event.key < 128
                    and not event.mod & self.pygame.KMOD_ALT):
                # A terminal sends the letter's low five bits for Ctrl and a letter.
                ctrl = event.mod & self.pygame.KMOD_CTRL
                keys.append(chr(event.key & 0x1f if ctrl else event.key))
        return keys

    def close(self) -> None:
        """Close the window."""
        if not self.why_shut:
            self.pygame.display.quit()


# ==== Both together =============================================================================

PAUSE_KEYS = {"p", "P", "\x13"}  # \x13: Ctrl-S
QUIT_KEYS = {"x": "x was pressed", "X": "x was pressed", "\x1b": "Esc was pressed",
             WINDOW_CLOSED: "the window was closed"}
CTRL_C = "\x03"
SLICE_S = 0.05  # how long a key waits for an answer, at the most


class Terminated(BaseException):
    """A signal asked the process to end. Its argument is the signal's number."""


def terminate(number: int, _: object) -> None:
    """Do not die at once but unwind, so that the terminal is restored on the way."""
    raise Terminated(number)


class Keys:
    """The keys of a run. `with Keys() as keys:` takes the terminal, and gives it back.

    paused: the run is to hold. quit_reason: why it is to end; empty until then.
    Ctrl-C raises KeyboardInterrupt, SIGTERM and its like raise Terminated.
    """

    def __init__(self) -> None:
        self.paused = False
        self.quit_reason = ""
        self.terminal = Terminal()
        self.window = Window()
        self.handlers: list[tuple[int, Any]] = []

    def __enter__(self) -> Keys:
        for name in ("SIGTERM", "SIGHUP", "SIGQUIT"):  # Windows has only the first
            number = getattr(signal, name, None)
            if number and signal.getsignal(number) == signal.SIG_DFL:
                self.handlers.append((number, signal.signal(number, terminate)))
        self.terminal.take()
        return self

    def __exit__(self, *_: object) -> None:
        self.terminal.give_back()
        self.window.close()
        for number, handler in self.handlers:
            signal.signal(number, handler)

    def help(self) -> str:
        """Which keys do what, and where, in one line."""
        places = []
        if not self.window.why_shut:
            places.append("in the little window")
        if self.terminal.is_ours:
            places.append("in this terminal")
        if not places:
            return "Keys: Ctrl-C quits."
        return f"Keys: p or Ctrl-S pauses, x or Esc quits, {' and '.join(places)}."

    def poll(self) -> None:
        """Act on the keys pressed since the last call."""
        if self.terminal.was_suspended:
            self.terminal.was_suspended = False
            self.say_paused()
        keys = [*self.terminal.read(), *self.window.read()]
        for key in keys:
            if key in PAUSE_KEYS:
                self.paused = not self.paused
                self.window.show(self.paused)
                self.say_paused()
            elif key in QUIT_KEYS:
                self.quit_reason = QUIT_KEYS[key]
        if CTRL_C in keys:  # only now: it must not swallow the keys that came with it
            raise KeyboardInterrupt

    def say_paused(self) -> None:
        """Tell the terminal that the run is paused, if it is."""
        if self.paused and self.terminal.is_ours:
            print("paused: p goes on, x quits", flush=True)

    def wait_until(self, moment_s: float) -> float:
        """Sleep until that moment of time.perf_counter, and for as long as the run is paused.

        Returns the seconds spent paused. A key that quits ends the wait at once.
        """
        paused_s = 0.0
        while True:
            self.poll()
            now_s = time.perf_counter()
            if self.quit_reason or (now_s >= moment_s and not self.paused):
                return paused_s
            if self.paused:
                time.sleep(SLICE_S)
                paused_s += time.perf_counter() - now_s
            else:
                time.sleep(min(SLICE_S, moment_s - now_s))
