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
        "At the left wall, to which it is pulled. It comes to lie there in frame 2930 (t = 44 s), "
        "after 26 bounces. Each of them took 20 % of its speed. From then on each frame pulls it "
        "into the wall and puts it back.",
        details=True),
    1: Example("A first look", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.7, "show_collision_mark": False},
        "Watch the bottom row only, and cover the rows above with paper. There the car (*) moves "
        "between its walls (|). At each bounce, guess: what part of the way will it go back?",
        "About half. It starts 1.75 m from the left wall, and gets back to 0.87 m, 0.46 m and 0.21 "
        "m. In a bounce it keeps 70 % of its speed, so 0.7^2 = 0.49 of its energy, and the energy "
        "decides how far it gets. When it has been at rest for a third of a second, in frame 251, "
        "the film stops by itself. If you type d after the number, as in 1 d, each line shows "
        "figures."),
    2: Example("No correction", {
        "x_m": 1.65, "v_mps": 2.7, "CR": 1.0, "correction": "none", "show_collision_mark": False},
        "Nothing puts the car back on the track after a collision. Only its velocity is reversed. "
        "How far does it go into the walls, and does it come out again? End the film with x.",
        "It goes up to 8 cm into the walls, and it comes out again each time. A frame moves it by "
        "9 cm, so a move may end nearly as far beyond the wall. There its velocity is reversed. It "
        "keeps all its speed (CR=1) and nothing pulls at it. So the next move is as long as the "
        "one before, and brings it out."),
    3: Example("No correction, losing speed", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.6, "correction": "none", "auto_off": False,
        "show_collision_mark": False},
        "Now the car loses speed in each bounce, and it is pulled to the left. Does it come back "
        "from the left wall? Watch for ten seconds, then press x.",
        "No. In frame 46 (t = 1.53 s) the car is beyond the left wall, so its velocity is "
        "reversed. But it has kept only 60 % of its speed, and a frame later it is still beyond "
        "the wall. So its velocity is reversed again, now into the wall, and so on. The car is "
        "caught. From then on the pull makes it sink, in the end by 1 mm a frame. After nine or "
        "ten seconds it is out of the picture, and a < stands at the edge."),
    4: Example("A high frame rate", {
        "x_m": 0.2, "v_mps": 10.0, "a_mps2": -10.0, "CR": 0.8, "fps_target": 300.0,
        "show_collision_mark": False},
        "Each line is a 300th of a second. Wait until the film ends. Then scroll back, as far as "
        "your terminal keeps the lines. What does the motion look like?",
        "Like a row of arcs, each of them a parabola. For a film is a graph: position to the "
        "right, time downwards. A constant pull draws parabolas there, as in a textbook, only "
        "turned on their side. The right wall cuts the first arc off. The first arcs are hundreds "
        "of lines long, and the last ones draw a tail. The film stops after 1880 frames."),
    5: Example("Where each collision was found", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7},
        "A 0 shows where the move alone put the car, beyond the wall. Where is the * in the same "
        "line? Does every collision show a 0?",
        "The rebound has put the * back on the track, 70 % as far from the wall as the 0 is on the "
        "other side. Often that is so near that the * stands in the wall's column. Many of the 19 "
        "collisions show no 0. It falls into the wall's column, too, and the wall hides it. With "
        "fps_target=10, a film to end with x, at least the first five show their 0."),
    6: Example("Example 5 zoomed out", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7, "m_to_px": 30.0},
        "The drawing is smaller than in example 5. Does the motion change, too? Compare after how "
        "many frames the film stops.",
        "No, only the drawing changes: it is about half as wide (30/55). The film stops after 236 "
        "frames, as example 5 does. With d, each line has the figures of example 5."),
    7: Example("Elastic, small steps", ELASTIC | {"fps_target": 240.0},
        "No speed is lost in a bounce. So the car should come back to the start mark, the dot at 2 "
        "m, every time. Does it? End the film with x.",
        "Nearly. It turns 1.1 cm short of the mark, first in frame 633 (t = 2.64 s). The next time "
        "it turns at the mark, then short of it again, and so on. The 1.1 cm are less than a "
        "column, so only d shows them. In example 8 the same happens with larger steps, and there "
        "one sees it."),
    8: Example("Elastic, large steps", COARSE,
        "Now example 7 at only 10 FPS. How near to the start mark does the car come back? Watch it "
        "come back four times, then press x.",
        "Only to 1.88 m, 12 cm short of the mark. The next time it reaches the mark, then again "
        "only 1.88 m, and so on. Think of the left wall as a floor. In each frame backward Euler "
        "takes away 1 cm of height, so 26 cm in a fall and the rise after it. The rebound gives "
        "height back: it puts the car as far above the floor as it was below, and does not slow "
        "it. First it was 7 cm below: 2 * 7 = 14 cm, 12 too few. Then it was 19 cm below: 2 * 19 = "
        "38 cm, 12 too many."),
    9: Example("Elastic, large and irregular steps", COARSE | IRREGULAR,
        "Example 8 with irregular frames: each is up to a quarter longer or shorter. How near to "
        "the start mark does the car come back? Press x after 30 s.",
        "It comes back elsewhere each time: it wanders. First it turns at 1.81 m, and after about "
        "half a minute even beyond the start mark. The rebound gives back more height if the car "
        "is found deeper in the wall. In irregular frames this depth is irregular, too."),
    10: Example("The exact solution", EXACT,
        "Only 10 FPS, but exact formulas. How near to the start mark does the car come back? Begin "
        "with s, press it fourteen times to see the first bounce, then p.",
        "It comes back to the start mark, the dot at 2 m, every time. The car moves by the "
        "formulas of kinematics. The correction, rewind, works out at what moment of the frame the "
        "car met the wall, and lets it bounce at that moment. The 0 in frame 14 shows where the "
        "move alone had put the car. In example 8, at the same 10 FPS, it does not come back."),
    11: Example("The exact solution, irregular steps", EXACT | IRREGULAR,
        "Example 10 with irregular frames. How near to the start mark does the car come back? End "
        "the film with x.",
        "To the mark itself, every time, as in example 10. For the exact solution it does not "
        "matter how the time is cut into frames. There are two exceptions: a frame that holds two "
        "bounces, as in example 12, and a frame that misses a bounce, as in example 18."),
    12: Example("The exact solution, losing energy", EXACT | IRREGULAR | {"CR": 0.8},
        "Example 11, but the car keeps only 80 % of its speed in a bounce. The bounces come faster "
        "and faster. Is there a last one? When does the car rest?",
        "There is no last bounce. In truth the car bounces infinitely often before t = 11.91 s, "
        "the Zeno point, and then it rests. But rewind can settle only one bounce a frame. So its "
        "car hops on, too low to see, until the film calls it at rest in frame 130. Replay settles "
        "them all: with correction=replay the car is at rest in frame 122. Still, rewind is good "
        "enough for this scene. It is never more than 4 mm off, less than a quarter of a column."),
    13: Example("Forward Euler beside the truth", {
        "x_m": 0.25, "v_mps": 2.48, "a_mps2": -2.0, "CR": 1.0, "motion": "forward",
        "fps_target": 10.0, "show_exact_mark": True},
        "The * is moved by forward Euler, and the o is the true car. Which gets further to the "
        "right before it turns? Watch both turn, then press x.",
        "The * does. It turned at 1.91 m, in frame 13, and the o at 1.79 m. Forward Euler moves "
        "the car through a whole frame at the velocity that it had when the frame began. That is "
        "too fast on the way out and too slow on the way back. So in each frame the * gets 1 cm "
        "further to the right of the o. Its energy grows, too: each frame adds 0.02 m^2/s^2 to "
        "v^2/2 + 2 x, the energy per kilogram. With motion=exact the * stays on the o until it "
        "meets the wall, in frame 25."),
    14: Example("Four metres a frame", QUICK,
        "The car moves 4 m in a frame, but the track is only 1.95 m long. Does the car stay "
        "between the walls? (< and > mean: out of the picture.) End the film with x.",
        "No. The rebound puts the car as far in front of the wall as it was beyond it. Here that "
        "is further than the track is long. So the car lands beyond the other wall: out to the "
        "left (<), then out to the right (>), and so on, 4.1 m further out every other frame. It "
        "bounces off walls that it has left behind. In a minute it is 1.2 km away."),
    15: Example("Four metres a frame, wall by wall", QUICK | {
        "motion": "exact", "correction": "replay"},
        "Example 14 with the exact solution, which settles every bounce. The car still moves 4 m "
        "in a frame. What will its motion look like? End the film with x.",
        "The car seems to creep along the track. In a frame of 4 m it goes to the walls and back, "
        "3.9 m, and ends 0.1 m from where it was. In the same way the wheels of a wagon seem to "
        "turn slowly in a film. This is the stroboscopic effect."),
    16: Example("Example 8 beside the truth", COARSE | {"show_exact_mark": True},
        "The o is the true car, and the * is the car of example 8. When does the * leave the o, "
        "and how far do they get apart? Press x after 20 s.",
        "At once: they are 1 cm apart in frame 1, 2 cm in frame 2, and up to 0.9 m within 20 s. "
        "There are two reasons. In flight, backward Euler moves the * through a whole frame at the "
        "velocity that it has when the frame ends. In a bounce, the rebound does not know at what "
        "moment of the frame the car met the wall."),
    17: Example("Exact motion with the rebound", COARSE | {
        "motion": "exact", "show_exact_mark": True},
        "Now the motion is exact, but the correction is the rebound. When does the * leave the o? "
        "Does it gain energy or lose some? Press x after 20 s.",
        "The * stays on the o until the first bounce, in frame 14. After that it is wrong, by up "
        "to 1.8 m within 20 s. The motion is exact, so the error comes from the rebound. The car "
        "is pulled to the left wall. There the rebound lifts it against the pull and does not slow "
        "it, so the car gains energy. At the right wall it gives some back. With "
        "correction=conserve it comes back to the start mark each time, and stays within 10 cm of "
        "the o for 20 s. With correction=rewind it stays on the o."),
    18: Example("The exact solution at 4 FPS", {
        "x_m": 0.65, "v_mps": 5.0, "a_mps2": -8.0, "CR": 1.0, "motion": "exact",
        "correction": "rewind", "fps_target": 4.0, "show_exact_mark": True},
        "Begin with s, press it four times, and watch the right wall. What does the o do there, "
        "and what does the *? End the film with x.",
        "By frame 3 the o has bounced off the right wall. The * has turned without a bounce, and "
        "in frame 4 they are about 0.4 m apart. In frame 3 the move goes 1 cm beyond the wall and "
        "comes back before it ends. So no collision is found: a missed event. A method that looks "
        "only at both ends of a step may miss one. With correction=replay the * stays on the o."),
    19: Example("Elastic hops, counted", {
        "x_m": 0.84, "v_mps": 0.098, "a_mps2": -2.0, "CR": 1.0, "correction": "surface",
        "fps_target": 10.0, "show_exact_mark": True},
        "No speed is lost in a bounce. Count lines from bounce to bounce: how long is each hop of "
        "the *, beside the one before? (In 19 d, v falls by 0.20 a line in between.)",
        "One line shorter: the hops take 15, 14, 13 ... lines, down to 2 and 1, too low to see. In "
        "frame 134 the film calls the * at rest. By a law, each hop at CR = 1 is on average 2 k "
        "lines longer than the one before. To get k, add the motion's number (1 for forward, 0 for "
        "exact, -1 for backward) and the correction's (1/2 for surface, 1 for rebound, 0 for "
        "conserve, 0 for none). Here k is -1 + 1/2 = -1/2. With motion=exact k is 1/2, and the "
        "hops take 18, 19, 20 ... lines for half a minute, until the * meets the right wall."),
    20: Example("Hops that lose speed, counted", {
        "x_m": 0.66, "v_mps": 0.75, "a_mps2": -2.0, "CR": 0.8, "motion": "exact",
        "fps_target": 10.0, "show_exact_mark": True},
        "Each bounce takes 20 % of the speed. Which comes to rest, the o or the *? Count the hops "
        "of the * as in 19. Press x after 10 s.",
        "Only the o comes to rest, at t = 7.05 s, its Zeno point. The hops of the * take 14, 12, "
        "10 lines and, from frame 48 on, 9 for ever. The law for any CR is: on average, a hop is "
        "followed by one of CR (hop + k) + k lines. Here k is 1: exact has 0 and rebound 1. So "
        "after 9 lines come 0.8 (9 + 1) + 1 = 9. A higher frame rate makes these hops lower, but "
        "at 30 or 60 FPS they do not end either. The cure is correction=conserve: with it the * "
        "comes to rest at about 7 s, as the o does."),
    21: Example("Five methods on one track", EXACT | {"show_methods": True},
        "The * is the car of example 10. Which letter leaves it first, which gets furthest away, "
        "and which two are never seen? Press x after 20 s.",
        "Letter a leaves the * first, by 1 cm in frame 1. Within 20 s it gets up to 0.9 m away. "
        "Letters b and c are moved exactly, so they leave the * only after the first bounce, in "
        "frame 14. The rebound lifts b off the wall, against the pull, and does not slow it. So b "
        "gets furthest away, up to 1.8 m within 20 s. Conserve lifts c, too, but slows it by what "
        "that costs. So c stays within 10 cm for these 20 s. Letters d and e are right, so the * "
        "always hides them. The chart shows more: other starts, and costs."),
    22: Example("The order of three lines", {
        "x_m": 1.0, "a_mps2": -10.0, "CR": 0.5, "left_edge_m": 0.0, "right_edge_m": 2.0,
        "fps_target": 60.0, "m_to_px": 1000.0, "motion": "forward", "correction": "surface",
        "show_exact_mark": True},
        "The left wall is a floor. In each frame gravity changes v, contacts are settled, then the "
        "ball moves. Does it ever lie still? Press x after five seconds. (> means: above 13 cm.)",
        "No. From frame 104 on the * hops for ever, in hops of 5 lines, about 6.5 mm high. (At "
        "full width a column is 1 mm.) From contact to contact, a game with this order of its "
        "lines is forward + surface. So k is 1 + 1/2, and by the law of film 20 hops should end "
        "near k (1 + CR)/(1 - CR) = 4.5 lines. The change that mends it: settle contacts last. "
        "That is backward + surface, and k is -1/2. The film of it, 22 motion=backward, is at rest "
        "in frame 86. The o, the true ball, lies still from t = 1.35 s on."),
}
OWN_SCENE = Example("Your own scene", {},
    "Where does the car turn? Does it come to rest?",
    "With a pull and CR < 1 a true car comes to rest. If yours does not, and its last hops are "
    "equally long, the method is to blame: set motion=exact correction=conserve. Films 19 and 20 "
    "say why. (In hops of 1 line the car lies at a wall.)")


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
