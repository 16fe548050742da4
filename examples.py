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
EXACT = COARSE | {"motion": "exact", "correction": "rewind"}
QUICK = {"x_m": 1.65, "v_mps": 40.0, "CR": 1.0, "fps_target": 10.0}
IRREGULAR = {"use_observed_dt": True}

EXAMPLES = {
    0: Example("The one-pager: the whole engine in its simplest form", {
        "x_m": 11.0, "v_mps": 17.0, "a_mps2": -2.0, "CR": 0.8,
        "left_edge_m": 0.5, "right_edge_m": 17.5, "m_to_px": 7.0, "width_px": 126,
        "fps_target": 1 / 0.015, "correction": "surface", "auto_off": False,
        "show_collision_mark": False},
        "An air track: * is the car, | are the walls, every line is a moment. This is the engine "
        "in its simplest form; python airtrack.py 1 begins the tour, -h lists it.",
        pause_s=0.0, details=True),
    1: Example("A first look", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.7, "show_collision_mark": False},
        "Every line is one moment: | are the walls, * is the car. Keep your eyes on the bottom "
        "row, or cover the rows above it with a sheet of paper: there the car moves. The rows "
        "above are its path, time running down. From rest it is pulled to the left, and it keeps "
        "70 % of its speed at each bounce, until it rests against the wall and the run stops by "
        "itself, after 251 frames.", pause_s=5.0),
    2: Example("No correction", {
        "x_m": 1.65, "v_mps": 2.7, "CR": 1.0, "correction": "none", "show_collision_mark": False},
        "Nothing puts the car back on the track after a collision: look how it is drawn inside the "
        "walls, up to 8 cm beyond them. It is elastic (CR = 1) and nothing pulls at it, so it "
        "comes back out as fast as it went in, and never stops: press x."),
    3: Example("No correction, and stuck", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.6, "correction": "none", "auto_off": False,
        "show_collision_mark": False},
        "In frame 46 (t = 1.53 s) the car is beyond the left wall. It is turned round and keeps "
        "60 % of its speed, too little to get back out in one frame against the pull. So the next "
        "frame finds it in collision again and turns it round again, inwards. It never comes back: "
        "it sinks, about 1 mm a frame, and where it has left the picture, at full width from "
        "frame 273 on, there is a < instead. Press x.", pause_s=4.0),
    4: Example("A high frame rate", {
        "x_m": 0.2, "v_mps": 10.0, "a_mps2": -10.0, "CR": 0.8, "fps_target": 300.0,
        "show_collision_mark": False},
        "At 300 FPS a bounce is hundreds of lines long. It stops after 1830 frames; scroll back "
        "then, as far as your terminal keeps them, and the shrinking bounces are drawn as a tail. "
        "The car starts just beyond the left wall, at 10 m/s: a collision in each of the first two "
        "frames, which is why it leaves the wall at 6.4 m/s."),
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
        "2 m, every time. At 240 FPS it does, to a centimetre, which only d shows: it comes back "
        "to 1.99 m (first in frame 633, t = 2.64 s) and to 2.00 m by turns."),
    8: Example("Elastic, large steps", COARSE,
        "Example 7 at 10 FPS. The car moves as much as 0.26 m in a frame, and the correction does "
        "not know when in the frame the bounce was. After the first bounce it turns at 1.88 m, "
        "12 cm short of the start mark; after the second one, whose error undoes the first's, "
        "at the mark; and so on by turns."),
    9: Example("Elastic, large and irregular steps", COARSE | IRREGULAR,
        "Example 8 with the length that each frame really had (the observed dt). No two of them "
        "are quite the same, so neither are the bounces, nor any two runs of this example."),
    10: Example("The exact solution", EXACT,
        "Elastic, at only 10 FPS. The car is moved by the formulas of kinematics, and each bounce "
        "is worked out at its own moment. So it comes back to the start mark, the dot at 2 m, "
        "every time; in example 8, by Euler's method, it does not. The first bounce is in frame "
        "14: p pauses, and s, s, s goes through it."),
    11: Example("The exact solution, irregular steps", EXACT | IRREGULAR,
        "Example 10 with the length that each frame really had. The exact solution does not depend "
        "on how the time is cut into frames: the car comes back to the start mark all the same."),
    12: Example("The exact solution, losing energy", EXACT | IRREGULAR | {
        "CR": 0.8, "correction": "replay"},
        "Example 11, keeping 80 % of the speed at each bounce. The bounces come faster and faster: "
        "infinitely many before t = 11.91 s, the Zeno point, from where on the car is at rest. One "
        "frame may hold many of them, and the last infinitely many: that takes replay."),
    13: Example("Forward Euler gains energy", COARSE | {
        "motion": "forward", "show_exact_mark": True},
        "Example 8 by forward Euler. Each step adds a^2 dt^2/2 = 0.02 m^2/s^2 to the car's energy "
        "v^2/2 - a x. So it climbs past its start mark after the first bounce, and hits the far "
        "wall in frame 24. The o is where the exact solution has the car; the error is with d."),
    14: Example("The rebound throws the car through the walls", QUICK,
        "The car moves 4 m a frame, on a track of 1.95 m. The rebound puts it as far on the other "
        "side of the wall as it was beyond it, and that is beyond the far wall: out to the left "
        "(<), out to the right (>), and so on, 4.1 m further every other frame, still bouncing off "
        "walls that it has left behind. In a minute it is 1.2 km away. With d there is its "
        "position. Press x to let it go."),
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

        is_raw = False  # whether its keys come to this process

        def read(self) -> str:
            """The keys pressed since the last call, as characters."""
            self.is_raw = sys.stdin.isatty() and sys.stdout.isatty()
            keys = ""
            while self.is_raw and msvcrt.kbhit():
                key = msvcrt.getwch()
                if key in "\x00\xe0":
                    msvcrt.getwch()  # the second half of an arrow or a function key
                else:
                    keys += key
            return keys

        def give_back(self) -> None:
            """Nothing to restore: the console was not changed."""

else:
    # What a terminal sends for a key that is no character: Esc [ ... for an arrow, Esc O ... for
    # F1 (O 2 ... with Shift), Esc and the character for Alt. Only an Esc that nothing follows is
    # the Esc key.
    SEQUENCE = re.compile(rb"\x1b+(\[[0-?]*[ -/]*[@-~]|O[0-9]*[^\x1b]|[^\x1b])?")
    UNFINISHED = re.compile(rb"\x1b(\[[0-?]*[ -/]*|O[0-9]*)?\Z")

    class Terminal:
        """The keys of a terminal, one by one, unechoed. It is touched from the foreground only."""

        is_raw = False  # whether its keys come to this process
        found: Any = None  # its mode, as it was found

        def is_in_foreground(self) -> bool:
            """Whether the terminal is this process's to read from and to set.

            With the output in a pipe, it is left to the program at the pipe's end.
            """
            try:
                return os.isatty(0) and os.isatty(1) and os.tcgetpgrp(0) == os.getpgrp()
            except OSError:  # not its controlling terminal, or gone
                return False

        def take(self) -> None:
            """Keys without waiting for Enter, without echo, and with Ctrl-S as a key."""
            if not self.is_in_foreground():
                self.is_raw = False
            elif not self.is_raw:
                with contextlib.suppress(termios.error):  # it may have gone just now
                    self.found = self.found or termios.tcgetattr(0)
                    mode = termios.tcgetattr(0)
                    mode[0] &= ~termios.IXON
                    mode[3] &= ~(termios.ICANON | termios.ECHO)
                    termios.tcsetattr(0, termios.TCSANOW, mode)
                    self.is_raw = True

        def give_back(self) -> None:
            """Leave the terminal as it was found."""
            if self.is_raw and self.is_in_foreground():
                with contextlib.suppress(termios.error):
                    termios.tcsetattr(0, termios.TCSANOW, self.found)
            self.is_raw = False

        def read(self) -> str:
            """The keys pressed since the last call, as characters."""
            self.take()
            keys, rest_s = b"", 0.0
            # A sequence may come in two pieces: the rest follows at once, or never. Not more than
            # 4096 bytes at a time, but for such a rest.
            while self.is_raw and (len(keys) < 4096 or rest_s) and select.select(
                    [0], [], [], rest_s)[0]:
                try:
                    piece = os.read(0, 1024)
                except OSError:  # not open for reading, or gone
                    break
                if not piece:
                    break
                keys += piece
                rest_s = 0.05 if UNFINISHED.search(keys[-32:]) else 0.0
            keys = SEQUENCE.sub(lambda found: b"" if found[1] else b"\x1b", keys)
            return keys.decode("ascii", "ignore")


# ==== The window's keys =========================================================================

WINDOW_CLOSED = "closed"


class Window:
    """The little pygame window. Without pygame or a display it stays shut, for why_shut."""

    why_shut = "it was not opened"
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
            self.why_shut = "there is no display"
            with contextlib.suppress(pygame.error):
                pygame.display.init()
                if pygame.display.get_driver() not in ("dummy", "offscreen"):  # they show nothing
                    pygame.display.set_mode((300, 20))
                    pygame.font.init()
                    self.pygame, self.why_shut = pygame, ""
                    self.show(is_paused=False)
        except BaseException as fault:  # a broken pygame may raise anything
            is_missing = isinstance(fault, ModuleNotFoundError) and fault.name == "pygame"
            self.why_shut = "pygame is not installed" if is_missing else (
                f"pygame does not work ({type(fault).__name__})")

    def show(self, is_paused: bool) -> None:
        """Say on the window's face and in its caption which keys do what now."""
        if not self.why_shut:
            state, p_does = ("PAUSED", "go on") if is_paused else ("running", "pause")
            words = f"{state}   p: {p_does}   s: step   x: quit"
            self.pygame.display.set_caption(" ".join(words.split()))
            surface = self.pygame.display.get_surface()
            surface.fill("darkorange" if is_paused else "white")
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
            elif event.type == self.pygame.KEYDOWN and event.key < 128:
                key = chr(event.key)
                pg = self.pygame
                if event.mod & (pg.KMOD_ALT | pg.KMOD_META | pg.KMOD_MODE):  # Alt, Super, AltGr
                    continue
                if event.mod & pg.KMOD_CTRL:  # a terminal sends the letter's low five bits
                    key = chr(event.key & 0x1f) if key.isalpha() else ""
                keys.append(key)
        return keys

    def close(self) -> None:
        """Close the window."""
        if not self.why_shut:
            self.pygame.display.quit()


# ==== Both together, and the signals ============================================================

PAUSE_KEYS = ("p", "P", "\x13")  # \x13: Ctrl-S
STEP_KEYS = ("s", "S")
QUIT_KEYS = {"x": "x was pressed", "X": "x was pressed", "\x1b": "Esc was pressed",
             WINDOW_CLOSED: "the window was closed"}
CTRL_C = "\x03"
SLICE_S = 0.05  # how long a key or a signal waits for an answer, at the most
QUIT_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")  # Windows has only the first two
SIGNALS = (*QUIT_SIGNALS, "SIGTSTP", "SIGCONT")


class Keys:
    """The keys of a run. `with Keys() as keys:` takes the terminal, and gives it back.

    why_quit: why the run is to end; empty until then. status: the exit status.

    Signals are keys, too: their handler only notes them for the next look. So nothing raises in
    the middle of things, and the terminal is changed in one place at a time.
    """

    def __init__(self) -> None:
        self.why_quit, self.status = "", 0
        self.is_paused, self.steps = False, 0  # steps: frames to show although it is paused
        self.is_reading = False  # the header, which Ctrl-C cuts short
        self.notice = ""  # that the run is paused, once it is said
        self.terminal, self.window = Terminal(), Window()
        self.handlers: dict[int, Any] = {}
        self.noted: list[int] = []
        self.first_s = 0.0  # when the first signal to quit came

    def __enter__(self) -> Keys:
        for name in SIGNALS:
            number = getattr(signal, name, None)
            if number and signal.getsignal(number) != signal.SIG_IGN:
                self.handlers[number] = signal.signal(number, self.note)
        self.terminal.read()
        return self

    def __exit__(self, *_: object) -> None:
        self.terminal.give_back()
        self.window.close()
        for number, handler in self.handlers.items():
            signal.signal(number, handler)

    def note(self, number: int, _: object) -> None:
        """A signal: note it for the next look.

        Only a run that is still there a second later, because it hangs in a write to a terminal
        that no longer reads, is ended at once.
        """
        self.noted.append(number)
        now_s = time.monotonic()
        if signal.Signals(number).name not in QUIT_SIGNALS:
            return
        if self.first_s and now_s > self.first_s + 1:
            self.terminal.give_back()
            os._exit(128 + number)
        self.first_s = self.first_s or now_s

    def open_window(self) -> None:
        """Open the window; say so if there is none."""
        self.window.open()
        if self.window.why_shut:
            print(f"No window for the keys: {self.window.why_shut}.")

    def help(self) -> str:
        """Which keys do what, and where."""
        places = []
        if not self.window.why_shut:
            places.append("in the little window")
        if self.terminal.is_raw:
            places.append("in this terminal")
        if not places:
            return "Keys: Ctrl-C quits."
        return (f"Keys, {' and '.join(places)}: p or Ctrl-S pauses, s steps one frame "
                "further, x or Esc quits.")

    def look(self) -> None:
        """Act on the signals and the keys that came since the last look."""
        while self.noted:
            name = signal.Signals(self.noted.pop(0)).name
            if name == "SIGINT":
                self.press(CTRL_C)
            elif name == "SIGTSTP":
                self.suspend()
            elif name == "SIGCONT":  # somebody else may have set the terminal meanwhile
                self.terminal.is_raw, self.notice = False, ""
            else:
                self.quit(name, 128 + signal.Signals[name])
        for key in [*self.terminal.read(), *self.window.read()]:
            self.press(key)

    def press(self, key: str) -> None:
        """Act on a key."""
        if key in PAUSE_KEYS:
            self.is_paused, self.steps = not self.is_paused, 0
        elif key in STEP_KEYS:
            self.is_paused, self.steps = True, self.steps + 1
        elif key in QUIT_KEYS:
            self.quit(QUIT_KEYS[key])
        elif key == CTRL_C and self.is_reading:
            self.is_reading, self.first_s = False, 0.0
        elif key == CTRL_C:
            self.quit("Ctrl-C was pressed")
        if key in (*PAUSE_KEYS, *STEP_KEYS):
            self.window.show(self.is_paused)

    def quit(self, why: str, status: int = 0) -> None:
        """End the run, for the first reason that came."""
        if not self.why_quit:
            self.why_quit, self.status = why, status

    def suspend(self) -> None:
        """Ctrl-Z, once or several times before the process stops: lend the terminal until fg."""
        self.terminal.give_back()
        signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTSTP])
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        signal.raise_signal(signal.SIGTSTP)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTSTP])  # the process stops here
        signal.signal(signal.SIGTSTP, self.note)
        while signal.SIGTSTP in self.noted:  # in place: a signal may be noted meanwhile
            self.noted.remove(signal.SIGTSTP)

    def is_cut_short(self, pause_s: float) -> bool:
        """Leave time to read the header; whether Ctrl-C cut it short."""
        if not pause_s:
            return False
        self.is_reading = True
        self.wait_until(time.perf_counter() + pause_s, 0, 0.0)
        was_reading, self.is_reading = self.is_reading, False
        return not was_reading

    def wait_until(self, moment_s: float, frame: int, t_s: float) -> bool:
        """Sleep until that moment of time.perf_counter, and for as long as the run is paused.

        frame and t_s: how far the film is, to be told when it is paused. Returns whether the wait
        was another one than until the moment, because of a pause or a step.
        """
        was_reading, was_held = self.is_reading, False
        while True:
            self.look()
            is_held = self.is_paused and not self.steps
            was_held = was_held or self.is_paused
            left_s = moment_s - time.perf_counter()
            if self.why_quit or was_reading != self.is_reading or (
                    not is_held and (left_s <= 0 or self.steps)):
                break
            if is_held and not self.notice:
                self.tell(f"paused after frame {frame}, t = {t_s:.2f} s: "
                          "p goes on, s steps, x quits")
            time.sleep(SLICE_S if is_held else min(SLICE_S, left_s))
        self.tell("")
        if self.steps and not was_reading:
            self.steps -= 1
        return was_held

    def tell(self, notice: str) -> None:
        """Say that the run is paused; on a terminal only until it goes on: the film stays whole."""
        is_terminal = sys.stdout.isatty()
        if is_terminal and self.notice:
            print("\r" + " " * len(self.notice) + "\r", end="", flush=True)
        if notice:
            print(notice, end="" if is_terminal else "\n", flush=True)
        self.notice = notice
