"""The air track's companion: the numbered examples, as data, and the keys.

An example is a title, the settings in which its scene differs from the default one, and what it
shows. The keys work in a little pygame window and in the terminal, whichever has the focus. If you
came for the physics, you need not read about the keys.
"""

import os
import shutil
import signal
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any, NamedTuple

if sys.platform == "win32":
    import msvcrt
else:
    import select
    import termios
    import tty


# ==== The examples ==============================================================================

class Example(NamedTuple):
    """One numbered example: a scene, what to look for in it, and what was to be seen, and why."""

    title: str
    settings: dict[str, Any]
    look_for: str  # before the film, without the answer
    seen: str  # after it

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
        "show_collision_mark": False, "show_details": True},
        "An air track: * is the car, | are the walls, and each line is one moment. Where will the "
        "car be after 45 s?",
        "At the left wall: the acceleration points there. Each bounce takes 20 % of its speed. "
        "After three bounces at the right wall it does not get there any more. Then each hop from "
        "the left wall is shorter than the one before. From about t = 44 s on each frame moves it "
        "a little into the wall and puts it back."),
    1: Example("A first look", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.7, "show_collision_mark": False},
        "Watch the bottom row only. There the car (*) moves between its walls (|). At each "
        "bounce, guess: what part of the way to the wall does it go back?",
        "About half. It starts 1.75 m from the left wall, and gets back to 0.87 m, 0.46 m and "
        "0.21 m. In a bounce it keeps 70 % of its speed, so 0.7^2 = 0.49 of its energy. The "
        "energy decides how far it gets. In frame 251 the film stops by itself: for 0.3 s the car "
        "was too low above its wall to be seen moving. If you type d after the number, as in 1 d, "
        "each line shows figures."),
    2: Example("No correction", {
        "x_m": 1.65, "v_mps": 2.7, "CR": 1.0, "correction": "none", "show_collision_mark": False},
        "Nothing puts the car back on the track after a collision. Only its velocity is reversed. "
        "How far does it go into the walls, and does it come out again?",
        "It goes up to 8 cm into the walls, and it comes out again each time. A frame moves it by "
        "9 cm. So a move that begins just in front of a wall ends nearly 9 cm beyond it. There "
        "its velocity is reversed. It keeps all its speed (CR=1), and its acceleration is 0. So "
        "the next move is as long as the one before, and brings it out."),
    3: Example("No correction, losing speed", {
        "x_m": 2.0, "a_mps2": -1.5, "CR": 0.6, "correction": "none", "auto_off": False,
        "show_collision_mark": False},
        "Now the car loses speed in each bounce, and it is accelerated to the left. Does it come "
        "back from the left wall? Watch for ten seconds.",
        "No. In frame 46 (t = 1.53 s) the car is beyond the left wall, so its velocity is "
        "reversed. But it has kept only 60 % of its speed, and a frame later it is still beyond "
        "the wall. So its velocity is reversed again, now into the wall, and so on. The car is "
        "caught. It swings for some frames, and then the acceleration makes it sink into the "
        "wall, in the end by 1 mm a frame. After nine or ten seconds it is out of the picture, "
        "and a < stands at the edge."),
    4: Example("A high frame rate", {
        "x_m": 0.2, "v_mps": 10.0, "a_mps2": -10.0, "CR": 0.8, "fps_target": 300.0,
        "show_collision_mark": False},
        "Each line is a 300th of a second. Wait until the film ends. Then scroll back, as far as "
        "your terminal keeps the lines. What does the motion look like?",
        "Like a row of arcs, each of them a parabola. The film is a graph: position to the right, "
        "time downwards. A constant acceleration draws parabolas there, as in a textbook, only "
        "turned by 90 degrees. The right wall cuts the first arc off. The first arcs are hundreds "
        "of lines long, and the last ones draw a tail. The film stops after 1878 frames. (The car "
        "starts 5 cm beyond the left wall, and moves out of it at 10 m/s. But after frame 1 it is "
        "still beyond the wall. So it is reversed, to -7.97 m/s, and put back on the track. In "
        "frame 2 it is beyond the wall again, and is reversed to 6.41 m/s. The table compares it "
        "with a car that starts on the wall.)"),
    5: Example("Where each collision was found", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7},
        "A 0 shows where the move alone put the car, beyond the wall. Where is the * in the same "
        "line? Does every collision show a 0?",
        "The rebound has put the * back on the track, 70 % as far from the wall as the 0 is on "
        "the other side. Often that is so near that the * stands in the wall's column. And no: 12 "
        "of the 19 collisions show no 0. It falls into the wall's column, too, and the wall hides "
        "it. With fps_target=10 the moves end further beyond the wall, and the first five "
        "collisions show their 0."),
    6: Example("Example 5 zoomed out", {
        "x_m": 2.0, "v_mps": 3.0, "a_mps2": 2.0, "CR": 0.7, "m_to_px": 30.0},
        "The drawing is smaller than in example 5. Does the motion change, too? Compare after how "
        "many frames the film stops.",
        "No, only the drawing changes: it is about half as wide (30/55). The film stops after 236 "
        "frames, as example 5 does. With d, each line has the figures of example 5."),
    7: Example("Elastic, small steps", ELASTIC | {"fps_target": 240.0},
        "No speed is lost in a bounce. So the car should come back to the start mark, the dots at "
        "2 m, every time. Does it? Watch for six seconds.",
        "Nearly. It turns 1.1 cm short of the mark, first in frame 633 (t = 2.64 s). The next "
        "time it turns at the mark, then short of it again, and so on. The 1.1 cm are less than a "
        "column. So the * turns at the dots, or one column beside them. With d you see them "
        "better, and in example 8 the same happens with larger steps."),
    8: Example("Elastic, large steps", COARSE,
        "No speed is lost in a bounce, and each step lasts 0.1 s. How near to the start mark, the "
        "dots at 2 m, does the car come back? Watch it come back four times.",
        "First only to 1.88 m, 12 cm short of the mark. The next time it reaches the mark, then "
        "again only 1.88 m, and so on. In each frame backward Euler takes as much energy as 1 cm "
        "of the track is worth. To the left wall and back are 26 frames, so they take 26 cm. The "
        "rebound gives energy back: it puts the car as far in front of the wall as it was beyond, "
        "and does not slow it. In the first bounce the car was 7 cm beyond the wall, so this "
        "gives 2 * 7 = 14 cm: 12 cm too few. In the second it was 19 cm beyond, so this gives 2 * "
        "19 = 38 cm: 12 cm too many."),
    9: Example("Elastic, large and irregular steps", COARSE | IRREGULAR,
        "Example 8 with irregular frames: each lasts from 0.075 to 0.125 s. How near to the start "
        "mark does the car come back? Watch for half a minute.",
        "It comes back elsewhere each time. First it turns at about 1.81 m, then at 1.68 m and "
        "1.6 m. The rebound gives back more energy if the car is found deeper in the left wall. "
        "In irregular frames the depth is irregular, too. If you run the film again, the first "
        "turns are nearly the same. The later ones are not: the frames of a computer are never "
        "quite the same, and most bounces make this difference larger."),
    10: Example("The exact solution", EXACT,
        "Only 10 FPS, but exact formulas. How near to the start mark does the car come back? If "
        "you have keys, begin with s, and press it until you see the 0 of the first bounce, in "
        "line 14. Then p lets the film go on.",
        "It comes back to the start mark, the dots at 2 m, every time. The car moves by the "
        "formulas of kinematics. The correction, rewind, works out at what moment of the frame "
        "the car met the wall, and lets it bounce at that moment. The 0 in frame 14 shows where "
        "the move alone had put the car. In example 8, at the same 10 FPS, the car comes back to "
        "the mark only every second time."),
    11: Example("The exact solution, irregular steps", EXACT | IRREGULAR,
        "Example 10 with irregular frames. How near to the start mark does the car come back?",
        "To the mark itself, every time, as in example 10. For this method it does not matter how "
        "the time is cut into frames. There are two exceptions: a frame that holds two bounces, "
        "as in example 12, and a frame that misses a bounce, as in example 18."),
    12: Example("The exact solution, losing energy", EXACT | IRREGULAR | {"CR": 0.8},
        "Example 11, but the car keeps only 80 % of its speed in a bounce. The bounces come "
        "faster and faster. Is there a last one? When does the car rest?",
        "There is no last bounce. In truth the car bounces infinitely often before t = 11.91 s, "
        "the Zeno point, and then it lies still. The film calls the * at rest from frame 121 on. "
        "But it never lies still: to come to rest it would need infinitely many bounces in a "
        "frame, and rewind can settle only one. With auto_off=False the car makes hops of some "
        "mm for ever, too low to see. With correction=replay it lies still from the Zeno point on. "
        "Rewind is good enough for this scene: until the film ends it is at most about 4.2 mm "
        "off, less than a quarter of a column. These figures differ a little from run to run, and "
        "on a busy computer the film may stop much later."),
    13: Example("Forward Euler beside the truth", {
        "x_m": 0.25, "v_mps": 2.48, "a_mps2": -2.0, "CR": 1.0, "motion": "forward",
        "fps_target": 10.0, "show_exact_mark": True},
        "The * is moved by forward Euler, and the o is the true car. Which gets further to the "
        "right before it turns? Watch both turn.",
        "The * does. It turns at 1.91 m, in frame 13, and the o at 1.79 m. Forward Euler moves "
        "the car through a whole frame at the velocity that it had when the frame began. That is "
        "too fast on the way out and too slow on the way back. So in each frame of the flight the "
        "* gets 1 cm further to the right of the o. Its energy grows, too: by 0.02 J/kg in each "
        "frame. With motion=exact the * stays on the o until it meets the wall, in frame 25."),
    14: Example("Four metres a frame", QUICK,
        "The car moves 4 m in a frame, but the track is only 1.95 m long. Does the car stay "
        "between the walls? (< and > mean: out of the picture.)",
        "No. The rebound puts the car as far in front of the wall as it was beyond it. Here that "
        "is further than the track is long. So the car lands beyond the other wall: out to the "
        "left (<), then out to the right (>), and so on. Each time it is on the same side again, "
        "it is 4.1 m further out. It bounces off walls that it has left behind. In a minute it is "
        "1.2 km away."),
    15: Example("Four metres a frame, wall by wall", QUICK | {
        "motion": "exact", "correction": "replay"},
        "Example 14 with the exact solution, which settles every bounce. The car still moves 4 m "
        "in a frame. What will its motion look like?",
        "The car seems to creep along the track. In most frames it goes 3.9 m to the walls and "
        "back, and ends 0.1 m from where it was. In the same way the wheels of a wagon seem to "
        "turn slowly in a film. This is the stroboscopic effect."),
    16: Example("Example 8 beside the truth", COARSE | {"show_exact_mark": True},
        "The o is the true car, and the * is the car of example 8. When does the * leave the o, "
        "and how far do they get apart? Watch for 20 s.",
        "At once: they are 1 cm apart in frame 1, 2 cm in frame 2, and up to 0.9 m within 20 s. "
        "There are two reasons. In flight, backward Euler moves the * through a whole frame at "
        "the velocity that it has when the frame ends. In a bounce, the rebound does not know at "
        "what moment of the frame the car met the wall."),
    17: Example("Exact motion with the rebound", COARSE | {
        "motion": "exact", "show_exact_mark": True},
        "Now the motion is exact, but the correction is the rebound. When does the * leave the o? "
        "Does it gain energy or lose some? Watch for 20 s.",
        "The * stays on the o until the first bounce, in frame 14. After that it is wrong, by up "
        "to 1.8 m within 20 s. The motion is exact, so the error comes from the rebound. The "
        "acceleration points to the left wall. There the rebound puts the car up the track, "
        "against the acceleration, and does not slow it. So the car gains energy. At the right "
        "wall it loses some of it. The table tells its mean energy in the last 5 s. With "
        "correction=conserve the energy is right, and the car comes back to the start mark each "
        "time, but each bounce comes up to a frame late. With correction=rewind the * stays on "
        "the o."),
    18: Example("The exact solution at 4 FPS", {
        "x_m": 0.65, "v_mps": 5.0, "a_mps2": -8.0, "CR": 1.0, "motion": "exact",
        "correction": "rewind", "fps_target": 4.0, "show_exact_mark": True},
        "If you have keys, press s four times: the first s begins the film. Watch the right wall. "
        "What does the o do there, and what does the *?",
        "By frame 3 the o has bounced off the right wall. The * has turned without a bounce, and "
        "in frame 4 they are about 0.4 m apart. In frame 3 the move goes 1 cm beyond the wall and "
        "comes back before it ends. So no collision is found: a missed event. A method that looks "
        "only at the end of a step may miss one. With correction=replay the * stays on the o."),
    19: Example("Elastic hops, counted", {
        "x_m": 0.84, "v_mps": 0.098, "a_mps2": -2.0, "CR": 1.0, "correction": "surface",
        "fps_target": 10.0, "show_exact_mark": True},
        "No speed is lost in a bounce. Count lines from bounce to bounce: how long is each hop of "
        "the *, compared with the one before? With d after the number you see each bounce: there "
        "v jumps up, and in all other lines it falls by 0.20 m/s.",
        "One line shorter: the hops take 15, 14, 13 ... lines, down to 2 and 1, too low to see."
        " In frame 136 the film stops: the * is at rest. A true car comes back each time as "
        "fast as it left. The * leaves at 1.502, 1.498, 1.302, 1.298 ... m/s, so it comes back "
        "slower, by 0.004 and 0.196 m/s in turn. (Hops of one line begin at 0.098 and 0.102 m/s"
        " in turn: the car lies, but its velocity is never 0.) With motion=exact it comes back "
        "faster, by 0.196 and 0.004 m/s in turn. Then the hops take 18, 19, 20 ... lines for "
        "half a minute, until the * meets the right wall."),
    20: Example("Hops that lose speed, counted", {
        "x_m": 0.66, "v_mps": 0.75, "a_mps2": -2.0, "CR": 0.8, "motion": "exact",
        "fps_target": 10.0, "show_exact_mark": True},
        "Each bounce takes 20 % of the speed. Which comes to rest, the o or the *? Count the lines "
        "of each hop of the *, from bounce to bounce. Watch for 10 s.",
        "Only the o comes to rest: in truth it lies still from t = 7.05 s on, after infinitely "
        "many bounces. (The table calls it at rest from frame 66 on, because its last hops are too "
        "low to see.) The hops of the * take 14, 12, 10 lines and, from frame 48 on, 9 for ever. "
        "Each hop ends below the floor, because the bounce is found late. Then the rebound lifts "
        "the car, and does not slow it. So in each hop the car comes back faster than it left: in "
        "the end it leaves at 0.8 m/s and comes back at 1 m/s. A bounce takes 20 % of this, so it "
        "leaves at 0.8 m/s again. A higher frame rate makes these hops lower, and in the end too "
        "low to see, but does not end them. The cure is correction=conserve: with it the * comes "
        "to rest, too."),
    21: Example("Five methods on one track", EXACT | {"show_methods": True},
        "The * is the car of example 10. Which letter leaves it first, which gets furthest away, "
        "and which two are never seen? Watch for 20 s.",
        "Letter a leaves the * first, by 1 cm in frame 1. Within 20 s it gets up to 0.9 m away. "
        "Letters b and c are moved exactly, so they leave the * only after the first bounce, in "
        "frame 14. The rebound lifts b off the wall, against the acceleration, and does not slow "
        "it. So b gets furthest away, up to 1.8 m, with far too much energy. Conserve puts c on "
        "the wall with the right energy, but up to a frame late each time: in 20 s it bounces "
        "seven times, and gets up to 0.9 m away. Letters d and e are right, so the * always hides "
        "them."),
    22: Example("The order of three lines", {
        "x_m": 1.0, "a_mps2": -10.0, "CR": 0.8, "left_edge_m": 0.0, "right_edge_m": 2.0,
        "fps_target": 60.0, "m_to_px": 500.0, "motion": "forward", "correction": "surface",
        "show_exact_mark": True},
        "The left wall is a floor. The * is the ball of a game. In each frame the game adds "
        "gravity to the velocity, settles a contact with the floor, and moves the ball. The o is "
        "the true ball. Which of them comes to rest? Watch for eight seconds. (> means: higher "
        "than 27 cm, out of the picture.)",
        "Only the o does: in truth it lies still from t = 4.02 s on. (The table calls it at rest "
        "from frame 234 on.) From frame 327 on the * hops for ever, in hops of 16 lines that are "
        "about 80 mm high. The order of the three lines is to blame. The game repeats gravity, "
        "contact, move, gravity, contact, move ... This is the same as move, gravity, contact, "
        "move, gravity, contact ... So it is forward + surface, which the film draws after each "
        "contact. In each hop the ball gets 0.3 m/s that it should not have, and a bounce takes "
        "no more. There are only two orders. Move, gravity, contact hops for ever, and it does "
        "not matter which of the three comes first in a frame. Gravity, move, contact comes to "
        "rest: this is backward + surface. To see it, add motion=backward: the film stops in "
        "frame 222."),
}

# These texts stand for those of a changed example, and of a scene of one's own. Nobody knows what
# is to be seen there, so the film's own table answers.
CHANGED = Example("changed", {},
    "The o is the true car. A car that you do not see is under another mark, or out of the "
    "picture. What does your change do to the *? The table after the film says how far it was "
    "from the o, how much energy it had, and since when it is at rest.", "")
OWN_SCENE = Example(f"your own scene (the examples are 0 to {max(EXAMPLES)})", {
    "show_exact_mark": True},
    "The * is your car, and the o is the true car. Where you see no o, it is under the * or out of "
    "the picture. Does the * stay on the o? Does it come to rest? (Set the scene by NAME=VALUE, as "
    "in a_mps2=-2. Without settings the car stands still.)", "")

# ==== The terminal's keys =======================================================================
# Each system has its own way to get keys one by one, without Enter and without showing them.

Handler = Any  # a function, SIG_DFL or SIG_IGN

@contextmanager
def handled(number: int, handler: Handler) -> Iterator[None]:
    """Let handler act on this signal in the `with` block."""
    found = signal.signal(number, handler)
    try:
        yield
    finally:
        signal.signal(number, found)

HAS_TERMINAL = os.isatty(0) and os.isatty(1)

if sys.platform == "win32":
    taken_terminal = nullcontext  # there is nothing to take or to give back

    def terminal_keys() -> list[str]:
        """The keys that were pressed since the last call."""
        keys = []
        while HAS_TERMINAL and msvcrt.kbhit():
            key = msvcrt.getwch()
            if key in ("\x00", "\xe0"):
                msvcrt.getwch()  # an arrow, for example, is two characters: drop both
            else:
                keys.append(key)
        return keys

else:
    def terminal_keys() -> list[str]:
        """The keys that were pressed since the last call."""
        if not HAS_TERMINAL or not select.select([0], [], [], 0)[0]:
            return []
        read = os.read(0, 1024)
        if not read:
            raise OSError("the terminal is gone")
        typed = read.decode("ascii", "ignore")
        return list(typed.partition("\x1b")[0])  # an arrow, for example, begins with Esc: drop it

    @contextmanager
    def taken_terminal() -> Iterator[None]:
        """Get keys one by one, without Enter and without an echo. Then give the terminal back."""
        if not HAS_TERMINAL:
            yield
            return
        found = termios.tcgetattr(0)

        def stop(number: int, _: object) -> None:
            """Ctrl-Z: give the terminal back, stand still until fg, and take it again."""
            with handled(signal.SIGTTOU, signal.SIG_IGN):  # the shell may just have taken it
                if os.tcgetpgrp(0) == os.getpgrp():
                    termios.tcsetattr(0, termios.TCSANOW, found)
            with handled(number, signal.SIG_DFL), handled(signal.SIGTERM, signal.SIG_DFL):
                signal.raise_signal(number)
                tty.setcbreak(0, termios.TCSANOW)  # in the background this stands still, too

        def end(number: int, _: object) -> None:
            """SIGTERM or SIGHUP: end as a program that a signal has ended."""
            sys.exit(128 + number)

        try:
            tty.setcbreak(0, termios.TCSANOW)  # TCSANOW keeps the keys that wait
            with (handled(signal.SIGTSTP, stop), handled(signal.SIGTERM, end),
                  handled(signal.SIGHUP, end)):
                yield
        finally:
            termios.tcsetattr(0, termios.TCSAFLUSH, found)  # and drop the keys that wait

# ==== The window's keys =========================================================================

CLOSED = "closed"  # stands for a click that closes the window
WINDOW_TEXT = "Enter: begin   p: pause   s: step   x: quit"

class Window:
    """The little pygame window. If it cannot be opened, why_shut says why."""

    def __init__(self) -> None:
        self.why_shut = ""
        try:
            self.open()
        except Exception as fault:  # no pygame, no display, or a broken pygame
            self.why_shut = str(fault) or repr(fault)

    def open(self) -> None:
        """Open it, and write into it what the keys do."""
        os.environ["SDL_NO_SIGNAL_HANDLERS"] = "1"  # Ctrl-C and the like are for us
        os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
        os.environ.setdefault("SDL_VIDEO_WINDOW_POS", "60,60")  # not over the newest line
        if sys.platform == "linux":  # without a display SDL would else open an invisible window
            os.environ.setdefault("SDL_VIDEODRIVER", "x11")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # pygame's own, which do not concern the user
            import pygame
        self.pygame = pygame
        pygame.display.init()  # not pygame.init(): its sound may print errors
        if pygame.display.get_driver() in ("dummy", "offscreen"):
            raise OSError("there is no display")
        pygame.font.init()
        pygame.display.set_caption(WINDOW_TEXT)
        face = pygame.display.set_mode((300, 20))
        face.fill("white")
        text = pygame.font.Font(None, 20).render(WINDOW_TEXT, True, "black")
        face.blit(text, text.get_rect(center=face.get_rect().center))

    def keys(self) -> list[str]:
        """The keys that were pressed since the last call."""
        if self.why_shut:
            return []
        pygame = self.pygame
        events = pygame.event.get()
        if any(event.type == pygame.VIDEOEXPOSE for event in events):
            pygame.display.flip()  # it has just appeared, or another window has covered it
        closed = [CLOSED for event in events if event.type == pygame.QUIT]
        return closed + [event.unicode for event in events if event.type == pygame.KEYDOWN]

# ==== What the keys do ==========================================================================

CTRL_C = "\x03"
WHY_QUIT = {"x": "x was pressed", CTRL_C: "Ctrl-C was pressed", "\x1b": "Esc was pressed",
            CLOSED: "the window was closed"}
PAUSE_KEYS = ("p", "\x13")  # "\x13" is Ctrl-S. A terminal takes that for itself, and stands still.
BEGIN_KEYS = ("\r", "\n", CTRL_C)
READING_S = 10.0  # enough for a short question. p holds the text for slower readers.
READING_WITHOUT_KEYS_S = 3.0  # nobody can begin it earlier with Enter, so do not keep them
LOOK_S = 0.05  # between two looks at the keys: too short to notice

# Who begins a film by Ctrl-C is greeted with it, as in the lesson that this program follows.
DIAMOND = "   *\n  * *\n *   *\n  * *\n   *"

class Keys:
    """What the keys have asked for: to begin the film, to pause it, to step, or to end it."""

    def __init__(self, window: Window) -> None:
        self.window = window
        self.has_begun = False  # before the film some keys do other things
        self.has_begun_by_ctrl_c = False
        self.why_quit = ""  # why the film is to end, or nothing
        self.is_paused = False
        self.steps = 0  # frames to show although the film is paused
        self.has_keys = HAS_TERMINAL or not window.why_shut
        self.reading_s = READING_S if self.has_keys else READING_WITHOUT_KEYS_S

    def press(self, key: str) -> None:
        """Act on a key."""
        if key in BEGIN_KEYS and not self.has_begun:
            self.has_begun = True
            self.is_paused = False
            self.has_begun_by_ctrl_c = key == CTRL_C
        elif key in WHY_QUIT:
            self.why_quit = WHY_QUIT[key]
        elif key in PAUSE_KEYS:
            self.is_paused = not self.is_paused
            self.steps = 0
        elif key == "s":
            self.has_begun = True
            self.is_paused = True
            self.steps += 1

    def look(self) -> None:
        """Act on the keys that were pressed since the last look."""
        for key in terminal_keys() + self.window.keys():
            self.press(key.lower())

    def wait(self, due_s: float, number: int) -> bool:
        """Wait until the frame of this number is due. Returns True if a key ended the wait.

        due_s is a moment of time.perf_counter().
        """
        sys.stdout.flush()
        self.look()
        while not self.is_paused and not self.why_quit:
            left_s = due_s - time.perf_counter()
            if left_s <= 0:
                return False
            time.sleep(min(left_s, LOOK_S))
            self.look()
        self.hold(f"paused after frame {number - 1}: p goes on, s steps, x ends it")
        self.steps = max(0, self.steps - 1)
        return True

    def is_held(self) -> bool:
        """Whether it is paused, and nobody has asked for a step or for the end."""
        return self.is_paused and self.steps == 0 and not self.why_quit

    def hold(self, text: str) -> None:
        """While it is held, show the text on a terminal. The next line covers it."""
        if not self.is_held():
            return
        text = text[:shutil.get_terminal_size().columns - 1]
        if sys.stdout.isatty():
            print(text, end="\r", flush=True)
        while self.is_held():
            time.sleep(LOOK_S)
            self.look()
        if sys.stdout.isatty():
            print(" " * len(text), end="\r", flush=True)

    def help_text(self) -> str:
        """Where the keys are, what they do, and when the film begins."""
        no_window = f" (No window: {self.window.why_shut}.)" if self.window.why_shut else ""
        if not self.has_keys:
            return (f"No keys here.{no_window} The film begins in {self.reading_s:g} s. Then "
                    "Ctrl-C ends it.")
        here = ["here"] if HAS_TERMINAL else []
        there = [] if self.window.why_shut else ["in the little window"]
        return (f"Keys {' and '.join(here + there)}: p pauses the film, s steps, x ends it."
                f"{no_window} It begins in {self.reading_s:g} s, or now with Enter or Ctrl-C. "
                "p holds this text.")

    def leave_time(self) -> None:
        """Leave time to read what is said before the film. Enter and s cut it short."""
        ends_s = time.perf_counter() + self.reading_s
        while not self.has_begun and not self.why_quit:
            self.look()
            self.hold("the text is held: p lets go, Enter begins the film, x ends it")
            if time.perf_counter() >= ends_s:
                self.has_begun = True
            time.sleep(LOOK_S)
        if self.has_begun_by_ctrl_c:
            print(DIAMOND)

@contextmanager
def taken_keys() -> Iterator[Keys]:
    """Open the window, and take the terminal. Whatever ends the `with` block gives it back."""
    # A display that does not answer hangs pygame, and Python with it. Then only the system's own
    # handler of Ctrl-C ends the program.
    with handled(signal.SIGINT, signal.SIG_DFL):
        keys = Keys(Window())
    with handled(signal.SIGINT, lambda *_: keys.press(CTRL_C)), taken_terminal():
        yield keys
