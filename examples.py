"""The air track's companion: the numbered examples, as data, and the keys.

An example is a title, the settings in which its scene differs from the default one, and what it
shows. The keys work in a little pygame window and in the terminal, whichever has the focus.
"""

import contextlib
import math
import os
import shutil
import signal
import sys
import time
import warnings
from collections.abc import Iterator
from typing import Any, NamedTuple

if sys.platform == "win32":
    import msvcrt
else:
    import select
    import termios


# ==== The examples ==============================================================================

class Example(NamedTuple):
    """One numbered example: a scene, what to look for in it, and what was to be seen, and why."""

    title: str
    settings: dict[str, Any]
    look_for: str  # before the film, without the answer
    seen: str = ""  # after it
    details: bool = False  # shown even without d

ELASTIC = {"x_m": 2.0, "a_mps2": -2.0, "CR": 1.0, "show_start_mark": True}
COARSE = ELASTIC | {"fps_target": 10.0}
EXACT = COARSE | {"motion": "exact", "correction": "rewind"}
QUICK = {"x_m": 1.65, "v_mps": 40.0, "CR": 1.0, "fps_target": 10.0}
IRREGULAR = {"use_observed_dt": True, "jitter": 0.25}

EXAMPLES = {
    0: Example("The one-pager: the whole engine in its simplest form", {
        "x_m": 11.0, "v_mps": 17.0, "a_mps2": -2.0, "CR": 0.8,
        "left_edge_m": 0.5, "right_edge_m": 17.5, "m_to_px": 7.0, "width_px": 126,
        "fps_target": 1 / 0.015, "correction": "surface", "auto_off": False,
        "show_collision_mark": False},
        "An air track: * is the car, | are the walls, and each line is one moment. Where will the "
        "car be after 45 s? Then end the film with x.",
        "From frame 2930 on (t = 44 s) it lies at the left wall, to which it is pulled. It lost 20 "
        "% of its speed in each of 26 bounces. Now each frame pulls it in and puts it back.",
        details=True),
    1: Example("A first look", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.7, "show_collision_mark": False},
        "Watch the bottom row (cover those above with paper): there the car (*) moves between its "
        "walls (|). At each bounce, guess what part of the way it will go back.",
        "About half of it each time: it starts 1.75 m from the wall, and gets back to 0.87 m, 0.46 "
        "m, 0.21 m. It keeps 70 % of its speed in a bounce, so 0.7^2 = 0.49 of its energy. When it "
        "has been at rest for a third of a second, in frame 251, the film stops by itself. (The "
        "word d after an example's number, as in 1 d, adds figures to each line.)"),
    2: Example("No correction", {
        "x_m": 1.65, "v_mps": 2.7, "CR": 1.0, "correction": "none", "show_collision_mark": False},
        "Nothing puts the car back on the track after a collision. How far does it go into the "
        "walls, and does it come out again? End the film with x.",
        "It goes into the walls by up to 8 cm, nearly as far as it moves in a frame, 9 cm. It is "
        "elastic (CR=1) and nothing pulls at it, so it comes back out as fast as it went in."),
    3: Example("No correction, losing speed", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.6, "correction": "none", "auto_off": False,
        "show_collision_mark": False},
        "Now the car loses speed in a bounce, and it is pulled to the left. Does it come back from "
        "the left wall? Give it ten seconds, then press x.",
        "In frame 46 (t = 1.53 s) it is beyond the left wall, and its velocity is reversed. But "
        "with 60 % of its speed it is not out again a frame later. So it is reversed once more, "
        "now into the wall, and so on: it is caught. From then on the pull makes it sink, at last "
        "by 1 mm a frame. (With d, v is then 0.02 though x falls: it is shown after the reversal.) "
        "After nine or ten seconds it is out of the picture: <"),
    4: Example("A high frame rate", {
        "x_m": 0.2, "v_mps": 10.0, "a_mps2": -10.0, "CR": 0.8, "fps_target": 300.0,
        "show_collision_mark": False},
        "Each line is a 300th of a second. Wait for its end. Then scroll back, as far as your "
        "terminal keeps the lines: what does the motion look like?",
        "Each hop is an arc, a parabola (the right wall cuts the first one off). They are hundreds "
        "of lines long at first, the last ones draw a tail, and the film stops after 1880 frames. "
        "As the car starts beyond the wall, frames 1 and 2 both reverse it: it leaves at 6.4 m/s."),
    5: Example("Where each collision was found", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7},
        "A 0 is where the move alone put the car, beyond the wall. Where is the * in the same "
        "line? Does every collision show a 0?",
        "The rebound has put the * back on the track, 70 % as far off the wall as it was beyond "
        "it: often in the wall's column. The wall hides the 0 of many of the 19 collisions (with d "
        "v tells them: it does not rise by 0.06 or 0.07). At fps_target=10, a film to end with x, "
        "at least the first five show theirs."),
    6: Example("Example 5 zoomed out", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7, "m_to_px": 30.0},
        "The drawing is smaller than in example 5. Does the motion change? Compare after how many "
        "frames the film stops.",
        "Only the drawing changes: it is about half as wide (30/55). With d the figures are those "
        "of example 5, and the film stops after 236 frames again."),
    7: Example("Elastic, small steps", ELASTIC | {"fps_target": 240.0},
        "No speed is lost in a bounce. So the car should come back to the start mark, the dot at 2 "
        "m, every time. Does it? End the film with x.",
        "Nearly: it turns 1.1 cm short of the mark, first in frame 633 (t = 2.64 s), the next time "
        "at the mark, and so on, alternately. That is less than a column, but d tells."),
    8: Example("Elastic, large steps", COARSE,
        "Example 7 at 10 FPS: the car moves up to 0.26 m in a frame. How near to the start mark "
        "does it come back? Watch four times, then press x.",
        "It comes back to 1.88 m, 12 cm short of the mark, then to the mark, and so on, "
        "alternately. Backward Euler takes 1 cm off the way in each frame, 26 cm in a fall and the "
        "rise after it. The rebound puts the car as far off the wall as it was beyond it, and does "
        "not slow it: so it gives back twice that distance. The first bounce gives back 2 * 7 = 14 "
        "cm, 12 too few. The next one gives back 2 * 19 = 38 cm, 12 too many."),
    9: Example("Elastic, large and irregular steps", COARSE | IRREGULAR,
        "Example 8 with irregular frames: each is up to a quarter longer or shorter. How near to "
        "the start mark does it come back? Press x after 30 s.",
        "The errors of the bounces are irregular too. So the car turns elsewhere each time: first "
        "at 1.81 m, and after about half a minute beyond the start mark as well. It wanders."),
    10: Example("The exact solution", EXACT,
        "Only 10 FPS, but exact formulas. How near to the start mark does the car come back? Begin "
        "with s, press it fourteen times to see the first bounce, then p.",
        "The car moves by the formulas of kinematics, and each bounce is worked out at its own "
        "moment. (The 0 in frame 14 is where the move alone had put it.) So it comes back to the "
        "start mark, the dot at 2 m, every time. In example 8 it does not."),
    11: Example("The exact solution, irregular steps", EXACT | IRREGULAR,
        "Example 10 with irregular frames. How near to the start mark does the car come back? End "
        "the film with x.",
        "At the start mark, all the same. The exact solution does not depend on how the time is "
        "cut into frames, as long as no frame holds two bounces (example 12) or misses one (18)."),
    12: Example("The exact solution, losing energy", EXACT | IRREGULAR | {"CR": 0.8},
        "Example 11, but the car keeps 80 % of its speed at each bounce, and the bounces come "
        "faster and faster. Is there a last one? When does the car rest?",
        "No bounce is the last: infinitely many are over by t = 11.91 s, the Zeno point. But "
        "rewind can settle only one a frame. So the car hops on, too low to see, until the film "
        "calls it at rest, in frame 130. (12 d shows 20 bounces: lines in which v rises.) Yet "
        "rewind is all that this scene needs: it is up to 4 mm off here, less than a quarter of a "
        "column. With correction=replay it is at rest in frame 122."),
    13: Example("Forward Euler beside the truth", {
        "x_m": 0.25, "v_mps": 2.48, "a_mps2": -2.0, "CR": 1.0, "motion": "forward",
        "fps_target": 10.0, "show_exact_mark": True},
        "The * is moved by forward Euler, the o is the true car. Which gets further to the right, "
        "before either meets a wall? See both turn, then press x.",
        "The * turned at 1.91 m, in frame 13, the o at 1.79 m, and neither had met a wall. Forward "
        "Euler moves the car at the velocity of the frame's start: too fast on the way out, too "
        "slow on the way back. Each step adds a^2 dt^2/2 = 0.02 m^2/s^2 to v^2/2 - a x, the energy "
        "per kilogram. With motion=exact the * stays with the o until the wall, in frame 25."),
    14: Example("Four metres a frame", QUICK,
        "The car moves 4 m a frame, on a track of 1.95 m. Does it stay between the walls? (< and "
        ">: out of the picture.) End the film with x.",
        "The rebound puts it as far off the wall as it was beyond it. That is beyond the far wall: "
        "out to the left (<), then out to the right (>), and so on, 4.1 m further every other "
        "frame. It bounces off walls that it has left behind. In a minute it is 1.2 km away."),
    15: Example("Four metres a frame, wall by wall", QUICK | {
        "motion": "exact", "correction": "replay"},
        "Example 14 by the exact solution, which settles every bounce. The car still moves 4 m a "
        "frame. What will it look like? End the film with x.",
        "In a frame of 4 m the car goes from wall to wall and back, 3.9 m, and ends 0.1 m from "
        "where it was. So it seems to creep along the track, as wagon wheels in a film seem to "
        "turn slowly: the stroboscopic effect."),
    16: Example("Example 8 beside the truth", COARSE | {"show_exact_mark": True},
        "The o is the true car. When does the * leave it, and how far apart do they get? (d shows "
        "the error.) Press x after 20 s.",
        "At once: they are 1 cm apart in frame 1, 2 cm in frame 2, and up to 0.9 m within 20 s. In "
        "flight, backward Euler moves the * at the velocity of the frame's end; and the rebound "
        "does not know when in the frame the bounce was."),
    17: Example("Exact motion with the rebound", COARSE | {
        "motion": "exact", "show_exact_mark": True},
        "Now the motion is exact, but the correction is the rebound. When does the * leave the o? "
        "Does it gain energy or lose some? Press x after 20 s.",
        "The * stays on the o until the first bounce, in frame 14, and then leaves it: by up to "
        "1.8 m within 20 s. What fails is the rebound. It lifts the car off the wall without "
        "slowing it. So the car gains energy at each bounce off the left wall, to which it is "
        "pulled, and gives some back at the right one. With correction=conserve it comes back to "
        "the start mark each time, within 6 cm of the o for 20 s; with rewind it stays on the o."),
    18: Example("The exact solution at 4 FPS", {
        "x_m": 0.65, "v_mps": 5.0, "a_mps2": -8.0, "CR": 1.0, "motion": "exact",
        "correction": "rewind", "fps_target": 4.0, "show_exact_mark": True},
        "Begin with s, press it four times, and watch the right wall. What does the o do there, "
        "and what does the *? End the film with x.",
        "In frame 3 the o has bounced off the right wall, the * turned without a bounce. In frame "
        "4 they are about 0.4 m apart. The move of frame 3 goes 1 cm beyond the wall and ends back "
        "on the track, so no collision is found: a missed event. Any method that looks only at the "
        "two ends of a step may miss one. With correction=replay the * stays on the o."),
    19: Example("Elastic hops, counted", {
        "x_m": 0.84, "v_mps": 0.098, "a_mps2": -2.0, "CR": 1.0, "correction": "surface",
        "fps_target": 10.0, "show_exact_mark": True},
        "Elastic, so the o bounces on for ever. And the *? Count lines from bounce to bounce. (19 "
        "d shows v, which falls by 0.20 a line, except at a bounce.)",
        "The hops of the * take 15, 14, 13 ... lines, down to 2 and 1, which are too low to see. "
        "In frame 134 the film calls it at rest. At CR = 1 each hop is on average 2 k lines longer "
        "than the one before. k is a sum: -1 for backward, 1/2 for surface. So here it is one line "
        "shorter. With motion=exact, 0 for exact, they last 18, 19, 20 ... lines, for half a "
        "minute: then the * meets the right wall. Predict others, with 1 for forward, 1 for "
        "rebound, 0 for conserve, 0 for none."),
    20: Example("Hops that lose speed, counted", {
        "x_m": 0.66, "v_mps": 0.75, "a_mps2": -2.0, "CR": 0.8, "motion": "exact",
        "fps_target": 10.0, "show_exact_mark": True},
        "Each bounce takes 20 % of the speed. Which comes to rest, o or *, and when? Count the "
        "hops of the * as in 19. Press x after 10 s.",
        "The hops of the * take 14, 12, 10 lines and, from frame 48 on (t = 4.8 s), 9 for ever, "
        "about 20 cm high. On average over many starts a hop is followed by one of CR (hop + k) + "
        "k lines. Exact has k = 0, rebound adds 1: after 9 come 0.8 (9 + 1) + 1 = 9. The o lies "
        "still from t = 7.05 s on, its Zeno point. At 30 or 60 FPS the hops end at 7 to 13 lines, "
        "so they are lower; at 120 the film calls them rest. The cure is correction=conserve: with "
        "it the * comes to rest, as the o does, at about 7 s."),
    21: Example("Five methods on one track", EXACT | {"show_methods": True},
        "The * is the car of example 10. Which letter leaves it first, which gets furthest away, "
        "and which two are never seen? Press x after 20 s.",
        "From this start, a leaves the * at once, by 1 cm in frame 1, and gets up to 0.9 m away "
        "within 20 s. b and c are moved exactly, as the * is. They leave it only after the first "
        "bounce, in frame 14. The rebound puts b off the wall, against the pull, and does not slow "
        "it: it gets furthest away, up to 1.8 m within 20 s. Conserve puts c there too, but slower "
        "by what that costs: it stays within 10 cm for 20 s. d and e are right, under the *, so "
        "they are never seen. The chart measures costs, too, and other starts."),
}
OWN_SCENE = Example("Your own scene", {},
    "How far does the car get from each wall? Does it come to rest?",
    "To go on, change one setting at a time; -h lists them all. If the car hops on and should come "
    "to rest, add motion=exact correction=conserve. Films 19 and 20 say why.")


# ==== The terminal's keys =======================================================================

ESC = "\x1b"  # a key of the window only: in a terminal arrows begin with it, and hold letters

# Whether a terminal's keys come to this process: with its output in a pipe they are the reader's.
HAS_KEYBOARD = os.isatty(0) and os.isatty(1)

if sys.platform == "win32":
    class Terminal:
        """The keys of a Windows console, which msvcrt gives one by one and unechoed."""

        def read(self) -> str:
            """The keys pressed since the last call, as characters."""
            keys = ""
            while HAS_KEYBOARD and msvcrt.kbhit():
                key = msvcrt.getwch()
                if key in "\x00\xe0":
                    msvcrt.getwch()  # the second half of an arrow or a function key
                elif key != ESC:
                    keys += key
            return keys

        def take(self) -> None:
            """Nothing to change in the console, and nothing to give back."""

        give_back = take

else:
    class Terminal:
        """The keys of a terminal, one by one and unechoed."""

        found: Any = None  # its mode, as it was found first

        def take(self) -> None:
            """Get keys one by one, unechoed, and Ctrl-S too; again at each look, as after fg."""
            if HAS_KEYBOARD:
                with contextlib.suppress(termios.error):  # a signal, or the shell has gone
                    mode = termios.tcgetattr(0)
                    self.found = self.found or termios.tcgetattr(0)
                    mode[0] &= ~termios.IXON
                    mode[3] &= ~(termios.ICANON | termios.ECHO)
                    mode[6][termios.VMIN], mode[6][termios.VTIME] = 1, 0
                    termios.tcsetattr(0, termios.TCSANOW, mode)

        def give_back(self) -> None:
            """Leave the terminal as it was found."""
            for _ in range(9 if self.found else 0):  # signals may interrupt it
                with contextlib.suppress(termios.error):
                    termios.tcsetattr(0, termios.TCSANOW, self.found)
                    break

        def read(self) -> str:
            """The keys since the last call, up to an Esc, with which arrows and reports begin."""
            self.take()
            if HAS_KEYBOARD and select.select([0], [], [], 0)[0]:
                return os.read(0, 65536).decode("ascii", "ignore").partition(ESC)[0]
            return ""


# ==== The window's keys =========================================================================

WINDOW_CLOSED = "closed"
FACES = {  # what the film does: the window's colour, and what the keys would do now
    "waiting": ("lightblue", "Enter: begin   p: hold   x: quit"),
    "running": ("white", "p: pause   s: step   x: quit"),
    "PAUSED": ("darkorange", "p: resume   s: step   x: quit"),
}

class Window:
    """The little pygame window. Without pygame or a display it stays shut; why_shut says why."""

    why_shut = "it was not opened"
    state = ""  # of the film, as its face shows it
    pygame: Any

    def open(self) -> None:
        """Open the window, or set why_shut. Pygame's sound stays off: it might print errors."""
        os.environ["SDL_NO_SIGNAL_HANDLERS"] = "1"  # SDL would set one for SIGINT
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
                    self.show("waiting")
        except BaseException as fault:  # a broken pygame may raise anything
            is_missing = isinstance(fault, ModuleNotFoundError) and fault.name == "pygame"
            self.why_shut = "pygame is not installed" if is_missing else (
                f"pygame does not work ({type(fault).__name__})")

    def show(self, state: str) -> None:
        """Say on the window's face and in its caption what the film and the keys do now."""
        if not self.why_shut and state != self.state:
            self.state, (colour, keys) = state, FACES[state]
            words = f"{state}   {keys}"
            self.pygame.display.set_caption(" ".join(words.split()))
            surface = self.pygame.display.get_surface()
            surface.fill(colour)
            text = self.pygame.font.Font(None, 22).render(words, True, "black")
            surface.blit(text, text.get_rect(center=surface.get_rect().center))
            self.pygame.display.flip()

    def read(self) -> list[str]:
        """The keys pressed since the last call, as the characters that they give."""
        if self.why_shut:
            return []
        pg, keys = self.pygame, []
        another = pg.KMOD_ALT | pg.KMOD_META | pg.KMOD_MODE  # with Alt, Super or AltGr
        for event in pg.event.get():
            if event.type == pg.QUIT:
                keys.append(WINDOW_CLOSED)
            elif event.type == pg.VIDEOEXPOSE:  # it was covered
                pg.display.flip()
            elif event.type == pg.KEYDOWN and not event.mod & another:
                keys.append(event.unicode)
        return keys

    def close(self) -> None:
        """Close the window."""
        if not self.why_shut:
            self.pygame.display.quit()


# ==== Both together, and the signals ============================================================

QUIT_KEYS = {"x": "x was pressed", ESC: "Esc was pressed", WINDOW_CLOSED: "the window was closed"}
PAUSE_KEYS = ("p", "\x13")  # Ctrl-S
CTRL_C = "\x03"
BEGIN_KEYS = ("\r", "\n", CTRL_C)
THINK_S, WAIT_S = 10.0, 3.0  # before the film: where a key can begin it, and where none can
SLICE_S = 0.05  # how long a key or a signal waits for an answer, at most
SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")  # Windows has only the first two

class Keys:
    """The keys of a run, and its signals."""

    def __init__(self) -> None:
        self.why_quit, self.status = "", 0  # why the run is to end, and its exit status then
        self.frame, self.t_s = 0, 0.0  # how far the film is
        self.to_show = math.inf  # frames before it is held: all, or, while paused, the steps
        self.begun_by = ""  # the key that began the film, or the clock
        self.signals: list[int] = []  # those that came since the last look
        self.pause_line = ""  # that the run is paused, while it stands on the screen
        self.terminal, self.window = Terminal(), Window()

    @property
    def is_paused(self) -> bool:
        """Whether the film shows no more frames than the steps that were asked for."""
        return self.to_show < math.inf

    def note(self, number: int, _: object) -> None:
        """Leave a signal to the next look: nothing changes in mid-action."""
        self.signals.append(number)

    def where(self) -> str:
        """Where keys work; nothing where they do not."""
        window = [] if self.window.why_shut else ["in the little window"]
        return " and ".join(["here"] * HAS_KEYBOARD + window)

    def help(self, question: str) -> Iterator[str]:
        """What to press, and where, or why nowhere; the question; how the film begins."""
        why = f" (no window: {self.window.why_shut})" if self.window.why_shut else ""
        if self.where():
            keys = f"Keys {self.where()}: p pauses, s steps, x quits"
            begins = f"It begins in {THINK_S:g} s, or with Enter; p holds this text."
        else:
            keys, begins = "No keys here", f"It begins in {WAIT_S:g} s, or with Ctrl-C."
        yield f"{keys}{why}."
        yield question
        yield begins

    def look(self) -> None:
        """Act on the signals and the keys that came since the last look."""
        self.heed_signals()
        for key in [*self.terminal.read(), *self.window.read()]:
            self.press(key)
        state = "running" if self.begun_by else "waiting"
        self.window.show("PAUSED" if self.is_paused else state)

    def heed_signals(self) -> None:
        """Act on the signals that were noted: Ctrl-C's is a key, the others end the run."""
        while self.signals:
            number = self.signals.pop(0)
            if number == signal.SIGINT:
                self.press(CTRL_C)
            else:
                self.quit(signal.Signals(number).name, 128 + number)

    def press(self, key: str) -> None:
        """Act on a key."""
        key = key.lower()
        if key in PAUSE_KEYS:
            self.to_show = math.inf if self.is_paused else 0
        elif key == "s":
            self.to_show = self.to_show + 1 if self.is_paused else 1
        elif key in QUIT_KEYS:
            self.quit(QUIT_KEYS[key])
        elif key in BEGIN_KEYS and not self.begun_by:
            self.begun_by, self.to_show = key, math.inf
        elif key == CTRL_C:
            self.quit("Ctrl-C was pressed")

    def quit(self, why: str, status: int = 0) -> None:
        """End the run. The first reason counts."""
        if not self.why_quit:
            self.why_quit, self.status = why, status

    def count(self, frame: int, t_s: float) -> None:
        """A frame has been printed: send it out at once, and keep how far the film is."""
        sys.stdout.flush()
        self.frame, self.t_s = frame, t_s
        self.to_show -= 1

    def leave_time(self) -> None:
        """Leave time to read the header. If Ctrl-C cuts it short, a diamond says so."""
        self.wait_until(time.perf_counter() + (THINK_S if self.where() else WAIT_S))
        if self.begun_by == CTRL_C:
            print("   *\n  * *\n *   *\n  * *\n   *")
        self.begun_by = self.begun_by or "the clock"

    def wait_until(self, moment_s: float) -> bool:
        """Sleep until moment_s of time.perf_counter, and while paused. Returns if it was paused."""
        begun_by, was_paused = self.begun_by, False
        while True:
            self.look()
            self.tell_pause()
            was_paused = was_paused or self.is_paused
            is_step = self.is_paused and self.to_show > 0
            is_due_now = is_step or self.begun_by != begun_by
            left_s = 0.0 if is_due_now else moment_s - time.perf_counter()
            if self.why_quit or (left_s <= 0 < self.to_show):
                return was_paused
            time.sleep(min(SLICE_S, left_s) if self.to_show else SLICE_S)

    def tell_pause(self) -> None:
        """Say that the film is held; on a terminal only as long as it is: the film stays whole."""
        is_terminal, is_held = sys.stdout.isatty(), not self.to_show and not self.why_quit
        if is_held and not self.pause_line:
            self.pause_line = (f"paused after frame {self.frame}, t = {self.t_s:.2f} s: p resumes, "
                               "s steps, x quits")
            if is_terminal:  # what wraps could not be taken back
                self.pause_line = self.pause_line[:shutil.get_terminal_size().columns - 1]
            print(self.pause_line, end="" if is_terminal else "\n", flush=True)
        elif self.pause_line and not is_held:
            if is_terminal:
                print("\r" + " " * len(self.pause_line) + "\r", end="", flush=True)
            self.pause_line = ""

def redirect(stack: contextlib.ExitStack, handler: Any, *names: str) -> None:
    """Give these signals to the handler until the stack closes, but leave ignored ones alone."""
    for name in names:
        number = getattr(signal, name, None)
        if number and signal.getsignal(number) != signal.SIG_IGN:
            before = signal.signal(number, handler)
            stack.callback(signal.signal, number, before)

@contextlib.contextmanager
def taken_keys() -> Iterator[Keys]:
    """Take window, signals and terminal for a run; give them back in the reverse order.

    A display that accepts and does not answer hangs pygame, when the window opens or closes. The
    terminal is not raw then, and Ctrl-C, left to the system meanwhile, ends the program.
    """
    keys = Keys()
    with contextlib.ExitStack() as stack:
        redirect(stack, signal.SIG_DFL, "SIGINT")
        keys.window.open()
        stack.callback(keys.window.close)
        redirect(stack, keys.note, *SIGNALS)
        stack.callback(keys.heed_signals)  # what came while the terminal was given back
        stack.callback(keys.terminal.give_back)
        keys.terminal.take()
        yield keys
