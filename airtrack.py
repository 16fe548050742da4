#!/usr/bin/env python3
"""Air track: a car on a 1-D track between two walls, drawn as one line of text a frame.

    python airtrack.py             the one-pager
    python airtrack.py 10 d        example 10, with details
    python airtrack.py -h          every example, every setting

The car is a point: a position and a velocity, nothing else. Each frame moves it, settles any
collision with a wall and prints the track as a line, so that the scrolling terminal is the film.

Names carry their units:
    x_m       position in metres                                     2.0
    v_mps     velocity in metres per second, to the right above 0   -1.5
    a_mps2    acceleration, constant, in metres per second squared  -2.0
    dt_s      the length of a frame in seconds, 1 / FPS              0.1
    CR        coefficient of restitution: speed after / before       0.8
    free_m    where the move alone, as if without walls, ends        0.2
    m_to_px   zoom in characters per metre                          55.0

Read it from top to bottom; each section uses what stands above it:
    1. Moving     2. Settling a collision     3. The scene     4. One frame
    5. Drawing    6. The run                  7. The command line
The examples, as data, and the keys are in examples.py.
"""

from __future__ import annotations

import argparse
import difflib
import math
import os
import re
import shutil
import signal
import sys
import textwrap
from collections import deque
from collections.abc import Iterable
from contextlib import nullcontext
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from time import perf_counter as clock_s
from typing import Any, NoReturn

from examples import EXAMPLES, OWN_SCENE, Example, Keys, Terminated

State = tuple[float, float]  # x_m, v_mps


# ==== 1. Moving: where is the car dt_s later, if there are no walls? ============================
#
# The velocity changes during the frame. Euler's methods act as if it did not: forward takes the
# one at the frame's start for the whole frame, backward the one at its end.

def forward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Forward Euler. The energy E = v^2/2 - a x changes by +a^2 dt^2/2 a step: it grows."""
    return x_m + v_mps * dt_s, v_mps + a_mps2 * dt_s


def backward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Backward Euler (for a constant a, semi-implicit too). E changes by -a^2 dt^2/2 a step."""
    v_mps += a_mps2 * dt_s
    return x_m + v_mps * dt_s, v_mps


def exact(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Kinematics: x = x0 + v0 t + a t^2/2 and v = v0 + a t. E stays as it is."""
    return x_m + v_mps * dt_s + a_mps2 * dt_s * dt_s / 2, v_mps + a_mps2 * dt_s


MOTIONS = {"forward": forward, "backward": backward, "exact": exact}


# ==== 2. Settling a collision: the move has put the car beyond a wall; where is it really? ======
#
# Each correction gets the scene, the frame's start, the end of the free move, the wall that this
# end is beyond, and dt_s. All turn the velocity round and keep CR of it. The first three only
# shift the car from where it was found; replay goes back to see what happened in the frame.

def none(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Leave the car beyond the wall: a trap.

    With CR < 1 and an acceleration into the wall, the slowed car does not get back out in one
    frame. The next frame finds it in collision again and turns it round, inwards: it sinks.
    """
    free_m, free_mps = free
    return free_m, -scene.CR * free_mps


def surface(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Put the car on the wall."""
    return wall_m, -scene.CR * free[1]


def rebound(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Put the car CR * overlap off the wall: as far as it would have bounced back by now.

    An overlap * (1 + CR) longer than the track throws it beyond the far wall.
    """
    free_m, free_mps = free
    overlap_m = free_m - wall_m
    return free_m - overlap_m * (1 + scene.CR), -scene.CR * free_mps


def arrival(d_m: float, u_mps: float, g_mps2: float, graze_m: float) -> tuple[float, float]:
    """When and how fast does the car reach a wall d_m ahead? (t_s, s_mps); never: (inf, 0).

    u_mps is its speed, g_mps2 its acceleration, both towards the wall. Energy gives the speed
    s at the wall, s^2 = u^2 + 2 g d. From s = u + g t the time is (s - u)/g = 2 d/(u + s); each
    form is used where it does not subtract nearly equal numbers.
    """
    s_squared = u_mps * u_mps + 2 * g_mps2 * d_m
    if u_mps <= 0 < g_mps2:
        s_mps = math.sqrt(s_squared)
        return (s_mps - u_mps) / g_mps2, s_mps
    # A car that slows down (g < 0) would turn back s^2/(-2 g) beyond the wall. Where that is
    # no more than round-off, it turns back at the wall, untouched: a graze is a miss.
    if u_mps > 0 and s_squared >= max(0.0, -2 * g_mps2 * graze_m):
        s_mps = math.sqrt(s_squared)
        return 2 * d_m / (u_mps + s_mps), s_mps
    return math.inf, 0.0


def hops(v_mps: float, g_mps2: float, CR: float, t_s: float, dt_s: float) -> State:
    """Take all the whole hops that fit into t_s at once: (time left, speed off the wall then).

    A car thrown off a wall into which it is pushed is back after h = 2 v/g, then after CR h,
    CR^2 h and so on: n hops last h (1 - CR^n)/(1 - CR). Even infinitely many last no longer than
    h/(1 - CR). That is the Zeno point: from then on the car is at rest, speed 0.
    """
    h_s = 2 * v_mps / g_mps2
    if h_s <= t_s * (1 - CR) or dt_s + h_s == dt_s:  # Zeno point, or hops too short to count
        return 0.0, 0.0
    if h_s > t_s:
        return t_s, v_mps
    if CR == 1:
        return math.fmod(t_s, h_s), v_mps
    # h (1 - CR^n)/(1 - CR) = t, solved for n; log1p and expm1 stay precise where CR is almost 1
    n = math.floor(math.log1p(-t_s * (1 - CR) / h_s) / math.log(CR))
    n_hops_s = -h_s * math.expm1(n * math.log(CR)) / (1 - CR)
    return max(0.0, t_s - n_hops_s), v_mps * CR**n


def replay(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Replay the frame from its start, from wall to wall, each flight in closed form.

    Goes with the exact motion only. Right for a frame of any length, be it 20 s.
    """
    x_m, v_mps = scene.to_track(start[0]), start[1]
    left_m, right_m, a_mps2, CR = scene.left_edge_m, scene.right_edge_m, scene.a_mps2, scene.CR
    graze_m = 1e-12 * (abs(left_m) + abs(right_m))
    t_s = dt_s  # what is left of the frame
    while True:
        # Which wall comes next? Towards the left one, distances and speeds change their sign.
        to_left = arrival(x_m - left_m, -v_mps, -a_mps2, graze_m)
        to_right = arrival(right_m - x_m, v_mps, a_mps2, graze_m)
        (arrival_s, s_mps), side, wall_m = min((to_left, -1, left_m), (to_right, 1, right_m))
        if arrival_s > t_s:  # No wall any more: coast. Round-off must not end beyond one.
            x_m, v_mps = exact(x_m, v_mps, a_mps2, t_s)
            return scene.to_track(x_m), v_mps
        # Go there and bounce.
        t_s -= arrival_s
        off_mps, g_mps2 = CR * s_mps, side * a_mps2
        # Pushed back into this wall, and too slow to reach the other one: hop.
        if g_mps2 > 0 and off_mps * off_mps <= 2 * g_mps2 * (right_m - left_m):
            t_s, off_mps = hops(off_mps, g_mps2, CR, t_s, dt_s)
            if off_mps == 0:
                return wall_m, 0.0
        x_m, v_mps = wall_m, -side * off_mps


CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "replay": replay}


# ==== 3. The scene: every setting, its default, its range =======================================

def number(default: float, low: float, high: float, unit: str, meaning: str) -> Any:
    """A setting that is a number from low to high, and a whole one if its default is."""
    kinds = (int,) if isinstance(default, int) else (int, float)
    lowest = "above 0," if 0 < low < 1e-300 else f"from {low}"
    return field(default=default, metadata={
        "meaning": meaning,
        "allowed": f"{'' if float in kinds else 'whole, '}{lowest} to {high} {unit}".rstrip(),
        "names": (),
        "read": type(default),
        "is_ok": lambda value: (isinstance(value, kinds) and not isinstance(value, bool)
                                and low <= value <= high)})


def choice(default: object, values: Iterable[Any], meaning: str) -> Any:
    """A setting that is one of a few values."""
    named = {str(value): value for value in values}
    return field(default=default, metadata={
        "meaning": meaning,
        "allowed": " or ".join(", ".join(named).rsplit(", ", 1)),
        "names": tuple(named),
        "read": lambda text: named.get(text, named.get(text.capitalize(), text)),
        "is_ok": lambda value: value in named.values()})


def nearest(word: str, names: Iterable[str]) -> str:
    """The first of the names that begins with the word, or else the one most like it."""
    word, lower = word.lower(), {name.lower(): name for name in names}
    begins = [name for name in lower if word and name.startswith(word)]
    return lower[(begins or difflib.get_close_matches(word, lower, n=1, cutoff=0))[0]]


def with_mark(line: str, mark: str, at_px: float, over: str) -> str:
    """The line with the mark at its column, if it has that column and what is there is in over."""
    column = round(at_px)
    if 0 <= column < len(line) and line[column] in over:
        return f"{line[:column]}{mark}{line[column + 1:]}"
    return line


@dataclass(frozen=True)
class Scene:
    """All that a run needs to know. Raises ValueError for a value out of its range."""

    x_m: float = number(1.1, -1000, 1000, "m", "starting position")
    v_mps: float = number(0.0, -1000, 1000, "m/s", "starting velocity")
    a_mps2: float = number(0.0, -1000, 1000, "m/s^2", "constant acceleration")
    left_edge_m: float = number(0.25, -1000, 1000, "m", "the left wall")
    right_edge_m: float = number(2.2, -1000, 1000, "m", "the right wall")
    CR: float = number(0.8, 0, 1, "", "speed after a bounce / before it")
    motion: str = choice("backward", MOTIONS, "how the car is moved")
    correction: str = choice("rebound", CORRECTIONS, "how a collision is settled")
    fps_target: float = number(30.0, 0.1, 1000, "1/s", "frames a second")
    use_observed_dt: bool = choice(False, (False, True), "dt is the length of the frame before")
    auto_off: bool = choice(True, (False, True), "stop when the car rests against a wall")
    m_to_px: float = number(55.0, math.ulp(0), 1000, "px/m", "zoom")
    width_px: int = number(135, 10, 1000, "px", "characters in a line")
    show_start_mark: bool = choice(False, (False, True), "a . where the car started")
    show_collision_mark: bool = choice(True, (False, True), "a 0 where it was beyond a wall")
    show_exact_mark: bool = choice(False, (False, True), "an o where it is in truth")

    def __post_init__(self) -> None:
        for f in fields(self):
            value, rule = getattr(self, f.name), f.metadata
            if not rule["is_ok"](value):
                hint = f"; nearest: {nearest(str(value), rule['names'])}" if rule["names"] else ""
                raise ValueError(f"{f.name} must be {rule['allowed']}, not {value!r}{hint}")
        if round(self.right_edge_m - self.left_edge_m, 9) < 0.01:
            raise ValueError("right_edge_m must be at least 0.01 m to the right of left_edge_m, "
                             f"{self.left_edge_m!r}, not {self.right_edge_m!r}")
        if self.correction == "replay" and self.motion != "exact":
            raise ValueError(f"motion must be exact with correction=replay, not {self.motion!r}")
        if self.correction == "replay" and self.x_m != self.to_track(self.x_m):
            raise ValueError(f"x_m must be on the track with correction=replay, from "
                             f"{self.left_edge_m:g} to {self.right_edge_m:g} m, not {self.x_m:g}")

    def to_track(self, x_m: float) -> float:
        """x_m, or the wall that it is beyond."""
        return min(max(x_m, self.left_edge_m), self.right_edge_m)

    @cached_property
    def background(self) -> str:
        """A line without the car: the walls and the start mark."""
        line = " " * self.width_px
        if self.show_start_mark:
            line = with_mark(line, ".", self.x_m * self.m_to_px, " ")
        for edge_m in (self.left_edge_m, self.right_edge_m):
            line = with_mark(line, "|", edge_m * self.m_to_px, " .")
        return line


# ==== 4. One frame ==============================================================================

def step(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, float | None]:
    """Move the car for dt_s and settle any collision: (x_m, v_mps, mark_m).

    mark_m is where the move alone would have put the car, None without a collision.
    """
    free_m, free_mps = free = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, dt_s)
    on_track = scene.left_edge_m <= free_m <= scene.right_edge_m
    # A car that turned round in this frame may have met a wall and be back: replay finds out.
    if on_track and (scene.correction != "replay" or v_mps * free_mps > 0):
        return free_m, free_mps, None
    settle = CORRECTIONS[scene.correction]
    settled = settle(scene, (x_m, v_mps), free, scene.to_track(free_m), dt_s)
    return *settled, None if on_track and settled == free else free_m


# ==== 5. Drawing ================================================================================

def render_track(scene: Scene, x_m: float, mark_m: float | None = None,
                 exact_m: float | None = None) -> str:
    """The track as a line of scene.width_px characters, with such marks as the scene shows.

    Where marks meet, the first of these is seen: * car, | wall, . start, 0 collision, o exact.
    """
    line = scene.background
    if exact_m is not None and scene.show_exact_mark:
        line = with_mark(line, "o", exact_m * scene.m_to_px, " ")
    if mark_m is not None and scene.show_collision_mark:
        line = with_mark(line, "0", mark_m * scene.m_to_px, " o")
    return with_mark(line, "*", x_m * scene.m_to_px, " o0.|")


def details_text(x_m: float, v_mps: float, fps: float, exact_m: float | None = None) -> str:
    """What stands behind the line with d: position, velocity, rate and error."""
    # The % takes two thirds of an f-string's time, and this is half the time of a frame.
    text = "x = %6.2f, v = %5.2f, FPS = %3.0f" % (x_m, v_mps, fps)  # noqa: UP031
    return text if exact_m is None else f"{text}, err = {x_m - exact_m:9.2e}"


def fit(scene: Scene, details: bool) -> Scene:
    """The scene with track and zoom shrunk together until line and details fit the terminal."""
    columns = shutil.get_terminal_size().columns if sys.stdout.isatty() else math.inf
    widest = details_text(-99, -99, scene.fps_target, 0 if scene.show_exact_mark else None)
    width_px = int(max(10, min(scene.width_px, columns - len(widest) * details)))
    zoom = scene.m_to_px * width_px / scene.width_px
    return replace(scene, width_px=width_px, m_to_px=max(zoom, math.ulp(0)))


# ==== 6. The run ================================================================================

def truth(scene: Scene) -> Scene:
    """The same scene moved and settled exactly (from a start on the track)."""
    return replace(scene, x_m=scene.to_track(scene.x_m), motion="exact", correction="replay")


def header(scene: Scene, title: str, details: bool) -> str:
    """What a run starts from, in a few lines."""
    on = {True: "on", False: "off"}
    return f"""\
{title}
  start     x = {scene.x_m:g} m, v = {scene.v_mps:g} m/s, a = {scene.a_mps2:g} m/s^2
  walls     at {scene.left_edge_m:g} m and {scene.right_edge_m:g} m, CR = {scene.CR:g}
  method    motion {scene.motion}, correction {scene.correction}
  frames    {scene.fps_target:g} FPS, observed dt {on[scene.use_observed_dt]}, \
auto-off {on[scene.auto_off]}
  drawing   {scene.m_to_px:g} px/m, details {on[details]}
  marks     start {on[scene.show_start_mark]}, collision {on[scene.show_collision_mark]}, \
exact {on[scene.show_exact_mark]}
"""


def say(text: str) -> None:
    """Print a paragraph as wide as the terminal, or as is good to read."""
    print(textwrap.fill(text, min(100, shutil.get_terminal_size().columns)), flush=True)


def introduce(scene: Scene, title: str, example: Example, details: bool, keys: Keys | None) -> None:
    """Say what is to be seen and which keys there are, and leave time to read it."""
    if example.look_for:  # the one-pager has no header and no pause
        print(header(scene, title, details))
        say(example.look_for)
    view = fit(scene, details)
    if view.width_px < scene.width_px:
        say(f"To fit this terminal, the track is drawn {view.width_px} px wide at "
            f"{view.m_to_px:.3g} px/m. The physics is untouched.")
    if keys:
        keys.window.open()
        if keys.window.why_shut:
            say(f"No window for the keys: {keys.window.why_shut}.")
    if example.look_for and keys:
        say(keys.help())
        try:
            keys.wait_until(clock_s() + example.pause_s)
        except KeyboardInterrupt:
            print("   *\n  * *\n *   *\n  * *\n   *")
    if example.look_for:
        print()


class Pacer:
    """Begins frames at absolute deadlines, whatever time each takes to compute and to print."""

    def __init__(self, period_s: float) -> None:
        self.period_s = period_s
        self.began_s = self.deadline_s = clock_s() - period_s  # the first frame begins now

    def next_frame(self, keys: Keys) -> float:
        """Wait, answering keys, until the next frame begins. Returns the last one's length in s."""
        self.deadline_s += self.period_s
        paused_s = keys.wait_until(self.deadline_s)
        now_s = clock_s()
        length_s = now_s - self.began_s - paused_s
        self.began_s = now_s
        self.deadline_s += paused_s
        if now_s > self.deadline_s + self.period_s:  # missed, and not made up by a burst
            self.deadline_s = now_s
        return length_s


def run(scene: Scene, title: str, example: Example, details: bool, keys: Keys | None,
        frames: int) -> int:
    """Show the film, and say why it ended. Without keys it runs as fast as it can."""
    view, exact_scene = fit(scene, details), truth(scene)
    x_m, v_mps, mark_m, exact_m = scene.x_m, scene.v_mps, None, None
    dt_s, fps, stalled = 1 / scene.fps_target, scene.fps_target, False
    frame, elapsed_s, recent_m = 0, 0.0, deque[float](maxlen=10)
    why, status = "that is the frame limit", 0
    try:
        with keys or nullcontext():
            introduce(scene, title, example, details, keys)
            pacer = Pacer(dt_s)
            while frame < frames:
                # 1. Keys, and the wait for the frame's moment.
                if keys:
                    length_s = pacer.next_frame(keys)
                    if keys.quit_reason:
                        why = keys.quit_reason
                        break
                    fps = 1 / length_s
                    stalled = length_s > max(0.15, 1.5 / scene.fps_target)
                    if scene.use_observed_dt:
                        dt_s = length_s
                # 2. Move the car and settle any collision. After a stall it holds still.
                if not stalled:
                    x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
                    elapsed_s += dt_s
                # 3. Draw.
                if scene.show_exact_mark:
                    exact_m = step(exact_scene, exact_scene.x_m, scene.v_mps, elapsed_s)[0]
                line = render_track(view, x_m, mark_m, exact_m)
                if details:
                    line += details_text(x_m, v_mps, fps, exact_m)
                sys.stdout.write(line + "\n")
                if keys:
                    sys.stdout.flush()
                frame += 1
                # 4. At rest against a wall?
                recent_m.append(x_m)
                if scene.auto_off and frame >= 10:
                    mean_m = sum(recent_m) / 10
                    if (abs(mean_m - scene.left_edge_m) <= 0.001
                            or abs(mean_m - scene.right_edge_m) <= 0.001):
                        why = "the car is at rest against a wall"
                        break
    except KeyboardInterrupt:
        why = "Ctrl-C was pressed"
    except Terminated as stop:
        why, status = signal.Signals(stop.args[0]).name, 128 + stop.args[0]
    print(f"Stopped after {frame} frame{'s' * (frame != 1)}: {why}.", flush=True)
    return status


# ==== 7. The command line =======================================================================

SETTINGS = {f.name: f for f in fields(Scene)}


def help_text() -> str:
    """The examples and the settings, for -h."""
    columns = shutil.get_terminal_size().columns
    lines = ["examples:"]
    lines += [f"  {number:2}  {example.title}" for number, example in EXAMPLES.items()]
    lines += ["", "settings (default, meaning, range), on top of the example's own:"]
    for name, f in SETTINGS.items():
        lines += textwrap.wrap(f"  {name:20}{f.default!s:9} {f.metadata['meaning']}: "
                               f"{f.metadata['allowed']}", columns, subsequent_indent=" " * 32)
    return "\n".join(lines)


class Parser(argparse.ArgumentParser):
    """An ArgumentParser that leaves it to main to report an error."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(message)


def frame_count(text: str) -> int:
    """The N of --frames."""
    if not re.fullmatch("[0-9]{1,18}", text) or int(text) < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 up, not {text!r}")
    return int(text)


def parse(argv: list[str] | None) -> argparse.Namespace:
    """Take the command line apart. Raises ValueError for whatever does not belong there."""
    parser = Parser(
        prog="airtrack.py", description="A car on a 1-D track, a line of text a frame.",
        usage="python airtrack.py [EXAMPLE] [d] [NAME=VALUE ...] [--fast] [--frames N]",
        epilog=help_text(),
        formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("words", nargs="*", metavar="EXAMPLE", help="its number (default: 0)")
    parser.add_argument("--fast", action="store_true", help="no pacing, no pauses, no window")
    parser.add_argument("--frames", metavar="N", type=frame_count, default=50_000,
                        help="stop after N frames (default: 50 000)")
    options, unknown = parser.parse_known_intermixed_args(argv)
    if unknown:
        hint = nearest(unknown[0], ("--fast", "--frames", "--help"))
        raise ValueError(f"there is no option {unknown[0]!r}; nearest: {hint}")
    options.number, options.details, options.settings = None, False, {}
    for word in options.words:
        name, equals, text = word.partition("=")
        if equals and name not in SETTINGS:
            raise ValueError(f"there is no setting {name!r}; nearest: {nearest(name, SETTINGS)}")
        if name in options.settings:
            raise ValueError(f"{name} is set twice")
        if equals:
            try:
                options.settings[name] = SETTINGS[name].metadata["read"](text)
            except ValueError:
                options.settings[name] = text  # Scene will say what it should have been
        elif word == "d":
            options.details = True
        elif re.fullmatch("[-+]?[0-9]{1,18}", word):
            if options.number is not None:
                raise ValueError(f"one EXAMPLE at a time, not {options.number} and {word}")
            options.number = int(word)
        else:
            hint = nearest(word, ("d", *map(str, EXAMPLES), *SETTINGS))
            raise ValueError(f"{word!r} is no EXAMPLE ({min(EXAMPLES)} to {max(EXAMPLES)}), "
                             f"not d, not NAME=VALUE; nearest: {hint}")
    return options


def fail(message: object) -> int:
    """Tell in one line what is wrong; the exit status for that."""
    print(f"airtrack.py: error: {message}", file=sys.stderr)
    return 2


def main(argv: list[str] | None = None) -> int:
    """Carry out a command line, sys.argv's by default. Returns the exit status, 2 for an error."""
    if sys.stdout is None:
        return fail("there is no standard output to draw on")
    try:
        options = parse(argv)
        number = options.number or 0
        example = EXAMPLES.get(number, OWN_SCENE)
        scene = Scene(**example.settings | options.settings)
    except SystemExit:  # argparse, after -h
        return 0
    except ValueError as fault:
        return fail(fault)
    try:
        title = f"Example {number}: {example.title}"
        if number not in EXAMPLES:
            title = example.title
            say(f"There is no example {number} (there are {min(EXAMPLES)} to {max(EXAMPLES)}): "
                "the default scene runs.")
        return run(scene, title, example, options.details or example.details,
                   None if options.fast else Keys(), options.frames)
    except KeyboardInterrupt:
        return 130
    except OSError as fault:
        # Nothing more can be printed, not even at exit. Where the reader has gone (| head), fine.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0 if isinstance(fault, BrokenPipeError) else fail(f"cannot print: {fault.strerror}")


if __name__ == "__main__":
    sys.exit(main())
