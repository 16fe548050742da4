#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text for each frame.
Each line is printed below the one before. So the film is a graph: position to
the right, time downwards.

Type some of these WORDs, in any order:
    EXAMPLE      the number of an example. Without it, a film shows example 1,
                 and chart and stability take example 12.
    d            details at the end of each line: position x, velocity v, frame
                 rate FPS and, if the true car o is drawn, err: how far to the
                 right of the o the car is
    NAME=VALUE   a setting that replaces the example's own
    chart        no film, but speed against accuracy: how much computing time
                 five methods need, and how wrong they are
    stability    no film, but the map: at which frame rates each method fails

For example: python airtrack.py 10 d CR=0.9

In a film, * is the car and | is a wall. < or > is the car, too, when it is out
of the picture. A 0 is where the car would be now without the wall that it met.
Some films also draw the start (.), the true car (o), or the cars of five
methods (a to e). If you change the motion or the correction of an example, + is
the car without this change. A table after the film says how far each car was
from the true car. The wall to which a car is accelerated is called its floor.
"""
# What is where?
#     Sections 1 to 5    the demo: how a car moves and bounces, how a frame is drawn, and the main
#                        loop. You may stop reading after section 5.
#     Section 6          the truth, and a table: which method is good for what.
#     Sections 7 and 8   how wrong the methods are: the chart and the map.
#     Sections 9 and 10  what stands before and after a film, and the command line.
# The file examples.py holds the numbered examples, and what the keyboard does. The folder .github
# has pages: a lesson, exercises, the law behind the map, and a cure for balls in games.

import argparse
import difflib
import math
import os
import shutil
import sys
import textwrap
import time
from collections.abc import Iterator
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field, fields, replace
from statistics import fmean
from typing import Any, NamedTuple

from examples import CHANGED, EXAMPLES, OWN_SCENE, Example, Keys, taken_keys

# ==== 1. Moving =================================================================================
# Where is the car dt_s later, if there are no walls?
#
#     x_m      the position of the car in m. A larger x is further to the right.
#     v_mps    the velocity of the car in m/s. It is positive if the car moves to the right.
#     a_mps2   the acceleration of the car in m/s^2. It is the same all the time.
#     dt_s     the time step in s: how much time passes for the car in a frame.
#
# The velocity changes during the frame. But Euler's methods move the car at one velocity through
# the whole frame. The method forward takes the velocity at the start of the frame, and backward
# takes the velocity at its end. Both are of first order: half the dt makes half the error after a
# given time. The method exact has no error, because a is constant. For a constant a, backward is
# the same as the method that is called semi-implicit Euler.
#
# In free flight the energy of the car should not change. For each kilogram of the car this energy
# is E = v^2/2 - a x. The docstring of each method says what one step does to E.

State = tuple[float, float]  # x_m and v_mps

def forward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Forward Euler: x + v dt, then v + a dt. Each step adds a^2 dt^2/2 to v^2/2 - a x."""
    return x_m + v_mps * dt_s, v_mps + a_mps2 * dt_s

def backward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Backward Euler: v + a dt, then x + v dt. Each step takes a^2 dt^2/2 from v^2/2 - a x."""
    v_mps += a_mps2 * dt_s
    return x_m + v_mps * dt_s, v_mps

def exact(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Kinematics: x + v dt + a dt^2/2, and v + a dt. No step changes v^2/2 - a x."""
    return x_m + v_mps * dt_s + a_mps2 * dt_s * dt_s / 2, v_mps + a_mps2 * dt_s

def arrival(d_m: float, u_mps: float, a_mps2: float) -> tuple[float, float]:
    """When is a car at a place d_m ahead, and how fast is it there? Returns t_s and w_mps.

    exact() tells the place at a time. This tells the time at a place. u_mps is the velocity of the
    car now. Here u_mps and a_mps2 are positive if they point to that place. The car must be able to
    get there: with d = 1, u = 1 and a = -20 it turns before.
    """
    # Energy gives the speed w there: w^2 = u^2 + 2 a d. Round-off may make w^2 negative.
    w_mps = math.sqrt(max(0.0, u_mps * u_mps + 2 * a_mps2 * d_m))
    # Two formulas give the time t. If two numbers are nearly equal, their difference is mostly
    # round-off. So take the formula in which the speeds are added.
    if u_mps > 0:
        t_s = 2 * d_m / (u_mps + w_mps)  # from the mean velocity: d = t (u + w)/2
    else:
        t_s = (w_mps - u_mps) / a_mps2  # from w = u + a t. Here u <= 0, so w - u is a sum.
    return t_s, w_mps

# If you write another motion, with the same arguments and a docstring, add it to MOTIONS. Then you
# can watch it in films, and the map has it. But:
#     The true car o, the energies and conserve are right only for a constant acceleration.
#     The chart compares only METHODS (section 6).
#     The corrections rewind and replay need the motion exact.
MOTIONS = {"forward": forward, "backward": backward, "exact": exact}

# ==== 2. Colliding ==============================================================================
# Where is the car after it has met a wall, and how fast is it?
#
# A collision is found when a move has ended beyond a wall. Then a correction changes the velocity
# and, except with none, the place. (The lesson that this program follows calls it a stickiness
# correction, because without a good one the car may stick in the wall.) The same correction works
# at both walls, because it counts place, velocity and acceleration from the wall and into it:
#
#     depth_m       how far the car is beyond the wall. In front of the wall, depth_m is negative.
#     inward_mps    the velocity of the car. It is positive if the car moves into the wall.
#     inward_mps2   the acceleration of the car. It is positive if it points into the wall.
#     CR            the coefficient of restitution: the speed after a bounce / the speed before it.
#
# Here is one collision at the right wall, where inward is to the right. The motion is exact,
# inward_mps2 is 20, CR is 0.8, and a column is 1 cm. In one frame of 0.1 s the car moves from the
# start to the 0, which is 8 cm beyond the wall. Then each correction puts the car where the * is.
# E is the energy in J/kg, counted from the wall: v^2/2 - a * depth, with inward_mps as v.
#
#                                            depth_m   inward_mps   E
#     start      *           |               -0.120       1.00     2.90
#     the move               |       0        0.080       3.00     2.90
#     none                   |       *        0.080      -2.40     1.28
#     surface                *       0        0.000      -2.40     2.88
#     rebound          *     |       0       -0.064      -2.40     4.16
#     conserve               *       0        0.000      -1.93     1.86
#     rewind            *    |       0       -0.048      -1.33     1.86
#
# What is right? At the wall E is v^2/2. A bounce multiplies v by CR, so E by CR^2: 0.64 * 2.90 is
# 1.86. The correction none leaves the car in the wall, and takes too much energy from it. Surface
# and rebound put it on the track, but leave it too much energy. Conserve leaves it the right
# energy. Rewind bounces it at the right moment, too. So of these five only rewind puts the car
# where a true car is at the end of this frame.
#
# The five corrections of this section take the same four arguments, and return a new depth_m and a
# new inward_mps. So step() can call any of them.

Contact = tuple[float, float]  # depth_m and inward_mps

def none(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> Contact:
    """Reverse the velocity, times CR, but leave the car beyond the wall, where it may be caught.

    The bounce has slowed the car. So after the next frame it may still be beyond the wall. Then its
    velocity is reversed again, now into the wall, and so on: the car is caught, and an acceleration
    into the wall may make it sink. Such a car is said to stick (example 3). The other corrections
    prevent this.
    """
    return depth_m, -CR * inward_mps

def surface(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> Contact:
    """Put the car on the wall, and reverse its velocity, times CR.

    If the acceleration points into the wall, this lifts the car against the acceleration. A lift
    should cost speed, but here it costs none. So with the exact motion, and a CR above 0, the car
    has more energy than it should: in the drawn collision 2.88 J/kg instead of 1.86.
    """
    return 0.0, -CR * inward_mps

def rebound(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> Contact:
    """Put the car in front of the wall, CR * depth away, and reverse its velocity, times CR.

    Without an acceleration this is right for one bounce in a frame: in the time in which the move
    went depth beyond the wall, the true car goes CR * depth back. If the acceleration points into
    the wall, the motion is exact and CR is above 0, rebound leaves too much energy, and more than
    surface does. If CR * depth is longer than the track, the car is thrown out at the other end
    (example 14).
    """
    return -CR * depth_m, -CR * inward_mps

def conserve(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> Contact:
    """Put the car on the wall, with CR times the speed at which it passed the wall.

    With the exact motion the energy is right if the car bounces once in the frame, and the move
    ends beyond that wall. Only the moment is wrong: the car leaves the wall at the end of the
    frame, so up to a frame late.
    """
    # Take the car back to the wall. E does not change, so its speed w there follows from
    # w^2 = v^2 - 2 a depth. This may be negative by round-off, after a start beyond the wall, or
    # after a move with backward, which has lost energy. The bounce leaves the speed CR w.
    w_squared = max(0.0, inward_mps * inward_mps - 2 * inward_mps2 * depth_m)
    return 0.0, -CR * math.sqrt(w_squared)  # 1.93 m/s in the drawn collision

def rewind(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> Contact:
    """Take the car back in time to the wall, let it bounce, and move it on to the frame's end.

    With the exact motion this is right if the car bounces once in the frame, and the move ends
    beyond that wall. So in example 10, where CR is 1, the car comes back to its start each time.
    But it settles only one bounce a frame. A car that comes to rest has infinitely many bounces in
    one frame, so with rewind it may make small hops instead (example 12). And if a move crosses a
    wall and comes back within a frame, no collision is found: the bounce is missed (example 18).
    """
    # How long ago did the car pass the wall, and how fast? Run the film backwards: the car goes
    # depth_m out of the wall, and begins at the speed inward_mps. An acceleration into the wall
    # slows it on this way, so its sign changes. In the drawn collision the car passed the wall
    # 0.030 s ago, at 2.41 m/s.
    late_s, met_mps = arrival(depth_m, inward_mps, -inward_mps2)
    # Run it forwards again, from the wall, after the bounce, for the same time.
    new_depth_m, new_inward_mps = exact(0.0, -CR * met_mps, inward_mps2, late_s)
    # If the car is in the wall again, there was a second bounce. Put the car on the wall, and leave
    # the second bounce to the next frame. (In the wall it has become faster, and it keeps this
    # speed. That is too much energy, but little if frames are short.)
    return min(new_depth_m, 0.0), new_inward_mps

CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "conserve": conserve,
               "rewind": rewind}

# The sixth correction, replay, is in section 6. It does the move and all bounces of a frame.
ALL_CORRECTIONS = [*CORRECTIONS, "replay"]
EXACT_ONLY = ["rewind", "replay"]  # they need the exact motion

# ==== 3. A frame ================================================================================
# How does the car get from one frame to the next?

def a_number(default: float, least: float, largest: float, meaning: str) -> Any:
    """A setting that is a number from least to largest."""
    return field(default=default, metadata={"meaning": meaning, "range": (least, largest)})

def a_choice(default: Any, choices: list[Any], meaning: str) -> Any:
    """A setting that is one of the choices."""
    return field(default=default, metadata={"meaning": meaning, "choices": choices})

@dataclass(frozen=True)  # frozen: nothing can change it. replace() makes a changed copy.
class Track:
    """The track and its car: all that the physics needs to know."""

    x_m: float = a_number(1.1, -10_000, 10_000, "start position in m")
    v_mps: float = a_number(0.0, -10_000, 10_000, "start velocity in m/s: below 0 to the left")
    a_mps2: float = a_number(0.0, -10_000, 10_000, "acceleration in m/s^2: below 0 to the left")
    left_edge_m: float = a_number(0.25, -10_000, 10_000, "position of the left wall in m")
    right_edge_m: float = a_number(2.2, -10_000, 10_000, "position of the right wall in m")
    CR: float = a_number(0.8, 0, 1, "speed after a bounce / speed before it")
    motion: str = a_choice("backward", [*MOTIONS], "how the car is moved")
    correction: str = a_choice("rebound", ALL_CORRECTIONS, "how a collision is settled")

    def length_m(self) -> float:
        """The distance between the walls."""
        return self.right_edge_m - self.left_edge_m

    def has_on_it(self, x_m: float) -> bool:
        """Whether x_m is a place on the track, and not beyond a wall."""
        return self.left_edge_m <= x_m <= self.right_edge_m

    def nearest_m(self, x_m: float) -> float:
        """The place on the track that is nearest to x_m: x_m itself, or the wall it is beyond."""
        return min(max(x_m, self.left_edge_m), self.right_edge_m)

    def floor_m(self) -> float:
        """The wall to which the car is accelerated. (If a_mps2 is 0, either would do.)"""
        return self.right_edge_m if self.a_mps2 > 0 else self.left_edge_m

    def energy(self, x_m: float, v_mps: float) -> float:
        """The energy in J/kg: 0 for a car that stands still at the floor."""
        return v_mps * v_mps / 2 - self.a_mps2 * (x_m - self.floor_m())

Moved = tuple[float, float, float | None]  # x_m, v_mps, mark_m

def step(track: Track, x_m: float, v_mps: float, dt_s: float) -> Moved:
    """Move the car by a frame of dt_s, and settle a collision. Returns x_m, v_mps and mark_m.

    mark_m is None or, in a collision, where the move alone ended. The film draws a 0 there.
    """
    if track.correction == "replay":
        return replay(track, x_m, v_mps, dt_s)  # it works out the whole frame, see section 6
    # Move the car as if there were no walls.
    move = MOTIONS[track.motion]
    free_m, free_mps = move(x_m, v_mps, track.a_mps2, dt_s)
    if track.has_on_it(free_m):
        return free_m, free_mps, None
    # The move ended beyond a wall. Count from this wall, and into it.
    if free_m > track.right_edge_m:
        wall_m, sign = track.right_edge_m, 1  # into it is to the right
    else:
        wall_m, sign = track.left_edge_m, -1  # into it is to the left
    depth_m = sign * (free_m - wall_m)
    inward_mps = sign * free_mps
    inward_mps2 = sign * track.a_mps2
    correct = CORRECTIONS[track.correction]
    new_depth_m, new_inward_mps = correct(depth_m, inward_mps, inward_mps2, track.CR)
    # Count from x = 0 and to the right again.
    return wall_m + sign * new_depth_m, sign * new_inward_mps, free_m

# ==== 4. Drawing ================================================================================
# How does a frame become a line of text, and why text?
#
# One line of code turns a place into a column: round((x_m - first_m) * m_to_px), where first_m is
# the place of the first column. And what is printed stays on the screen: the whole motion is seen
# at once, as a graph, and one may count its lines.

@dataclass(frozen=True)
class Scene(Track):
    """A track, and how it is filmed. It is a Track with more settings, so step() takes it, too."""

    fps_target: float = a_number(30.0, 0.1, 1000, "frames a second, 1/dt")
    use_observed_dt: bool = a_choice(False, [False, True], "dt is the measured length of a frame")
    jitter: float = a_number(0.0, 0, 0.9, "frames are up to this part longer or shorter")
    auto_off: bool = a_choice(True, [False, True], "stop when the car is at rest")
    m_to_px: float = a_number(55.0, 0.0001, 1000, "zoom in columns for each m")
    width_px: int = a_number(135, 10, 1000, "width of the picture in columns")
    show_start_mark: bool = a_choice(False, [False, True], "draw a . at the start")
    show_collision_mark: bool = a_choice(True, [False, True], "draw the 0 of a collision")
    show_exact_mark: bool = a_choice(False, [False, True], "draw an o for the true car")
    show_methods: bool = a_choice(False, [False, True], "draw a to e for five methods")
    show_details: bool = a_choice(False, [False, True], "write x, v and FPS, as d does")

    def column_m(self) -> float:
        """How wide a column of the film is."""
        return 1 / self.m_to_px

    def first_m(self) -> float:
        """The place of the first column: 0, or the left wall if that is further left."""
        return min(0.0, self.left_edge_m)

def render_track(scene: Scene, places_m: dict[str, float], mark_m: float | None) -> str:
    """Draw a frame: one line of scene.width_px columns. places_m has the cars by their marks.

    What is painted later covers what was there. So the car itself, *, must be the last of the cars:
    nothing hides it.
    """
    marks = []
    if scene.show_collision_mark and mark_m is not None:
        marks.append(("0", mark_m))
    if scene.show_start_mark:
        marks.append((".", scene.x_m))
    marks.append(("|", scene.left_edge_m))
    marks.append(("|", scene.right_edge_m))
    marks.extend(places_m.items())
    line = [" "] * scene.width_px
    first_m = scene.first_m()
    for mark, x_m in marks:
        column = round((x_m - first_m) * scene.m_to_px)
        if 0 <= column < scene.width_px:
            line[column] = mark
        elif mark == "*" and column < 0:
            line[0] = "<"  # it is out of the picture, on the left
        elif mark == "*":
            line[-1] = ">"
    return "".join(line)

def details_text(x_m: float, v_mps: float, fps: float, true_m: float | None) -> str:
    """What d adds to a line: position, velocity, frame rate and, given the truth, the error."""
    text = f"x = {x_m:6.2f}, v = {v_mps:5.2f}, FPS = {fps:3.0f}"
    if true_m is None:
        return text
    return f"{text}, err = {x_m - true_m:9.2e}"

# A terminal changes its colour where it reads "\033[" and a number and "m". 0 ends the colour.
COLOURS = str.maketrans({"o": "\033[32mo\033[0m", "0": "\033[31m0\033[0m"})  # green and red

def colours() -> dict[int, str]:
    """The colours of the marks. There are none if the output is not a terminal with colours."""
    is_dumb = os.environ.get("TERM", "dumb") == "dumb"
    if is_dumb or os.environ.get("NO_COLOR") or not sys.stdout.isatty():
        return {}
    return COLOURS

# ==== 5. The main loop ==========================================================================
# When is a film over, how does it keep its pace, and what happens in each frame? The main loop,
# run(), stands at the end of this section.

REST_S = 0.3  # long enough to be seen
REST_FRAMES = 10  # at a low frame rate 0.3 s may be a single frame

class Car:
    """A car on its track. It keeps what each frame ended with: for rest_began(), and the table."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        # Number 0 is the start, and number n is the end of frame n.
        self.places_m = [scene.x_m]
        self.velocities_mps = [scene.v_mps]
        self.marks_m: list[float | None] = [None]

    def move(self, dt_s: float) -> None:
        """Make a frame of dt_s, and keep it."""
        x_m, v_mps, mark_m = step(self.scene, self.places_m[-1], self.velocities_mps[-1], dt_s)
        self.places_m.append(x_m)
        self.velocities_mps.append(v_mps)
        self.marks_m.append(mark_m)

    def low_m(self) -> float:
        """Below this height above its floor a car counts as lying there: half a column or less."""
        # A 650th of the track is 3 mm in examples 1 to 12. With this, the films of examples 1, 5, 6
        # and 12 end in the same frame as in the lesson that this program follows.
        return min(self.scene.column_m() / 2, self.scene.length_m() / 650)

    def is_low(self, number: int) -> bool:
        """Whether the car may be at rest in the frame of this number.

        Its velocity does not count: with some methods a car that lies still has one. But without an
        acceleration a car may stand still anywhere. Then its velocity must be 0.
        """
        x_m = self.places_m[number]
        if not self.scene.has_on_it(x_m):
            return False
        if self.scene.a_mps2 == 0:
            return self.velocities_mps[number] == 0
        return abs(x_m - self.scene.floor_m()) <= self.low_m()

    def rest_began(self) -> int | None:
        """The number of the frame since which the car is at rest, or None if it is not.

        It must be low for ten frames, for 0.3 s, and for as long as a hop so low would last.
        """
        needed_s = REST_S
        g_mps2 = abs(self.scene.a_mps2)
        if g_mps2 > 0:
            fall_s = math.sqrt(2 * self.low_m() / g_mps2)  # from low = g fall^2/2
            needed_s = max(REST_S, 2 * fall_s)  # a hop is a rise and a fall
        first = len(self.places_m)
        while first > 0 and self.is_low(first - 1):
            first -= 1
        steps = len(self.places_m) - 1 - first
        if steps >= REST_FRAMES - 1 and steps >= needed_s * self.scene.fps_target:
            return first
        return None

def frame_text(cars: dict[str, Car], scene: Scene, fps: float, colour_of: dict[int, str]) -> str:
    """The newest frame of the cars, as it is printed."""
    places_m = {}
    for mark, car in cars.items():
        if mark != "o" or scene.show_exact_mark:
            places_m[mark] = car.places_m[-1]
    car = cars["*"]
    text = render_track(scene, places_m, car.marks_m[-1]).translate(colour_of)
    if scene.show_details:
        text += details_text(car.places_m[-1], car.velocities_mps[-1], fps, places_m.get("o"))
    return text

def planned_length_s(scene: Scene, number: int) -> float:
    """How long the frame of this number should last. With jitter, frames are irregular."""
    # Numbers that look random, but are the same each time: the multiples of 0.618 without their
    # whole parts. They are spread evenly from 0 to 1, because 0.618 is near the golden section.
    from_0_to_1 = (0.618 * number) % 1
    from_minus_1_to_1 = 2 * from_0_to_1 - 1
    return (1 + scene.jitter * from_minus_1_to_1) / scene.fps_target

STALL_S = 0.15  # a delay that everybody sees: people begin to notice one at about 0.1 s

def ticks(scene: Scene, max_frames: int, keys: Keys | None) -> Iterator[tuple[float, float]]:
    """For each frame: wait until it is due, and yield its dt_s and the rate that d shows.

    yield hands a frame to the loop in run(), and goes on here when that asks for the next one. The
    frames are due at planned moments. If each frame slept for dt instead, it would last longer than
    dt, because computing and printing take time, too. Without keys (--fast) nothing waits.
    """
    # Pretend that a frame was shown one frame ago. So frame 1, a frame later, is due now.
    due_s = shown_s = time.perf_counter() - planned_length_s(scene, 1)
    for number in range(1, max_frames + 1):
        shown_fps = scene.fps_target
        length_s = planned_length_s(scene, number)
        dt_s = length_s if scene.use_observed_dt else 1 / scene.fps_target
        if keys is None:
            yield dt_s, shown_fps
            continue
        due_s += length_s
        was_paused = keys.wait(due_s, number)
        if keys.why_quit:
            return
        now_s = time.perf_counter()
        lasted_s = now_s - shown_s
        shown_s = now_s
        # After a pause or a stall plan the next frames from now. Otherwise the film would race to
        # catch up. And leave dt as it was planned. Otherwise the car would leap.
        if was_paused or now_s > due_s + STALL_S:
            due_s = now_s
        elif scene.use_observed_dt:
            dt_s = lasted_s
        if not was_paused:
            shown_fps = 1 / max(lasted_s, 1e-6)  # the clock may not have ticked in between
        yield dt_s, shown_fps

def run(cars: dict[str, Car], drawn: Scene, max_frames: int, keys: Keys | None) -> None:
    """Show the film until a key, the car at rest or max_frames ends it, and say which of them.

    cars: by their marks, from back to front. drawn: their scene, smaller in a narrow terminal.
    """
    car = cars["*"]
    colour_of = colours()
    t_s = 0.0
    why = "that is the frame limit"
    for dt_s, fps in ticks(drawn, max_frames, keys):
        # Move the cars, and settle their collisions.
        for each in cars.values():
            each.move(dt_s)
        # Draw the frame.
        print(frame_text(cars, drawn, fps, colour_of))
        # Is it over?
        t_s += dt_s
        if drawn.auto_off and car.rest_began() is not None:
            why = "the car is at rest"
            break
    if keys is not None and keys.why_quit:
        why = keys.why_quit
    print(f"Stopped after {len(car.places_m) - 1} frames, t = {t_s:.2f} s: {why}.", flush=True)

# ==== 6. The truth ==============================================================================
# What would the car really do? And which method should I take?
#
# The correction replay is right for a frame of any length: with motion=exact, one step() of 20 s
# returns where the car truly is after 20 s. The film's o, the chart and the map rely on this. So
# the tests compare it with a reference that has 60 digits.
#
# Think of a ball in a room. The wall to which the car is accelerated is the floor, and the other
# wall is the ceiling. h is the height of the ball above the floor. The ball flies from bounce to
# bounce, and arrival() says when each flight ends.
#
# At CR < 1 each hop on the floor lasts CR times as long as the hop before, if the ball does not
# meet the ceiling. So infinitely many hops take a finite time: if the first hop lasts 1 s, all of
# them last 1 + CR + CR^2 + ... seconds, and this sum is 1/(1 - CR). The moment at which they end is
# called the Zeno point. From then on the ball lies still. Nobody can follow infinitely many hops
# one by one. So here a ball lies still if it would rise less than GRAZE times the height of the
# room. In example 12 it does so after bounce 55, and with CR=0.98 after bounce 602.

GRAZE = 2.5e-11  # on the lesson's track 5e-11 m: far more than round-off, less than an atom's width

def next_bounce(h_m: float, rise_mps: float, g_mps2: float,
                room_m: float) -> tuple[float, float, float]:
    """Which wall does the ball meet next, after how many s, and at how many m/s?

    The wall is told by its height: 0 is the floor, and room_m is the ceiling. h_m is the height of
    the ball, and rise_mps is its velocity, upwards.
    """
    # To rise to the ceiling takes the energy g * (room - h). If a ball only just gets there,
    # round-off would decide. So it meets the ceiling only if it could rise higher, by GRAZE * room.
    energy_to_meet_it = g_mps2 * (room_m - h_m + GRAZE * room_m)
    if rise_mps > 0 and rise_mps * rise_mps / 2 >= energy_to_meet_it:
        flight_s, speed_mps = arrival(room_m - h_m, rise_mps, -g_mps2)
        return room_m, flight_s, speed_mps
    flight_s, speed_mps = arrival(h_m, -rise_mps, g_mps2)
    return 0.0, flight_s, speed_mps

def replay(track: Track, x_m: float, v_mps: float, dt_s: float) -> Moved:
    """Follow the exact motion from bounce to bounce, as many as there are in the frame.

    It takes and returns what step() does.
    """
    # A car that has moved one way only, and is still on the track, has met no wall. The lines below
    # would find the same. This only saves time: most frames end here.
    free_m, free_mps = exact(x_m, v_mps, track.a_mps2, dt_s)
    has_turned = v_mps * free_mps < 0  # so it may have crossed a wall, and come back
    if track.has_on_it(free_m) and not has_turned:
        return free_m, free_mps, None
    # Turn the track into a room. up is the direction away from the floor.
    up = -1 if track.a_mps2 > 0 else 1
    g_mps2, room_m = abs(track.a_mps2), track.length_m()
    h_m, rise_mps = up * (track.nearest_m(x_m) - track.floor_m()), up * v_mps
    remaining_s, mark_m = dt_s, None
    while rise_mps != 0 or g_mps2 != 0:  # otherwise nothing moves the ball
        met_h_m, flight_s, speed_mps = next_bounce(h_m, rise_mps, g_mps2, room_m)
        if flight_s > remaining_s:
            break  # the frame is over before the ball gets there
        remaining_s -= flight_s
        mark_m = free_m
        h_m = met_h_m
        rise_mps = track.CR * speed_mps
        if h_m > 0:  # the ceiling
            rise_mps = -rise_mps
        elif rise_mps * rise_mps / 2 <= g_mps2 * GRAZE * room_m:
            return track.floor_m(), 0.0, mark_m  # it lies still: see GRAZE
        elif track.CR == 1:
            # It needs the same time from floor to floor again and again. Leave out whole periods:
            # if 7 s are left, and the period is 2 s, only the last 1 s matters.
            next_h_m, next_flight_s, _ = next_bounce(h_m, rise_mps, g_mps2, room_m)
            period_s = next_flight_s
            if next_h_m > 0:  # from the ceiling it needs the same time back to the floor
                period_s = 2 * next_flight_s
            remaining_s %= period_s
    h_m, rise_mps = exact(h_m, rise_mps, -g_mps2, remaining_s)
    # Turn the room into the track again. Round-off must not leave the car beyond a wall.
    return track.nearest_m(track.floor_m() + up * h_m), up * rise_mps, mark_m

# Which method should I take? A method is a motion and a correction. Of the fourteen possible ones,
# example 21 and the chart compare five. Order 1 means that half the dt makes half the error.
#
#     method                 energy       error of the place          take it for
#     a  backward + rebound  up and down  order 1                     seeing errors
#     b  exact + rebound     too much     order 1                     cars without an acceleration
#     c  exact + conserve    right        order 1: bounces come late  balls in a game
#     d  exact + rewind      right        none, until it rests        one bounce a frame
#     e  exact + replay      right        none                        the truth
#
# The table is for a CR above 0, and a car that bounces on its floor. The last frames before the
# Zeno point have several bounces, and d settles only one in each. There it gets a little too much
# energy: an error of order 2. Without an acceleration a, b, d and e have no error if no frame has
# more than one bounce, and c has one of order 1.
#
# Methods a to d look only at the end of a frame, so they may miss a bounce (example 18). In long
# frames a, b and d may even throw the car out at the other end (example 14). Methods c and e never
# do. But e must know, before it moves the car, which wall the car will meet. In a game with many
# things that move, that is hard to know. So take c for a game: there the ball does not get out. It
# bounces to the right height, a little late, and at a CR below 1 it comes to rest.
METHODS = {"a": ("backward", "rebound"), "b": ("exact", "rebound"), "c": ("exact", "conserve"),
           "d": ("exact", "rewind"), "e": ("exact", "replay")}

LEGEND = ", ".join([f"{letter}: {' + '.join(method)}" for letter, method in METHODS.items()])

def with_method(scene: Scene, motion: str, correction: str) -> Scene:
    """The scene with this method. With rewind and replay the car must start on the track."""
    x_m = scene.nearest_m(scene.x_m) if correction in EXACT_ONLY else scene.x_m
    return replace(scene, x_m=x_m, motion=motion, correction=correction)

def truth_of(scene: Scene) -> Scene:
    """The scene of the true car."""
    return with_method(scene, *METHODS["e"])

def furthest_m(car: Car, truth: Car) -> float:
    """How far the car was at most from the true car."""
    pairs = zip(car.places_m, truth.places_m, strict=True)
    return max(abs(x_m - true_m) for x_m, true_m in pairs)

LATE_S = 5  # the last seconds of a film or a run show what has become of a car

def late_states(car: Car) -> list[State]:
    """The car's place and velocity in each frame of the last 5 s, or of all a shorter film."""
    count = round(LATE_S * car.scene.fps_target) + 1
    return list(zip(car.places_m[-count:], car.velocities_mps[-count:], strict=True))

def late_energy(car: Car) -> float:
    """The mean energy of the car in its late states."""
    return fmean(car.scene.energy(x_m, v_mps) for x_m, v_mps in late_states(car))

# ==== 7. The chart: speed against accuracy ======================================================
# What does each method cost, and how wrong is it?

SPAN_S = 20  # of simulated time: in example 12 a true car bounces for 12 s, then it lies still
RUNS = 10  # of each method: with fewer, the largest error would be less reliable
CHART_FPS = [1, 2, 5, 10, 30, 60, 120, 240, 480, 960]

def say(text: str) -> None:
    """Print a paragraph, as wide as the terminal but no wider than is good to read."""
    width = min(100, shutil.get_terminal_size().columns)
    print(textwrap.fill(text, width), flush=True)

def frames_of(scene: Scene) -> int:
    """How many frames SPAN_S has."""
    return round(SPAN_S * scene.fps_target)

def simulated(scene: Scene) -> Car:
    """The car of the scene after SPAN_S in equal frames."""
    car = Car(scene)
    for _ in range(frames_of(scene)):
        car.move(1 / scene.fps_target)
    return car

def true_cars(scene: Scene) -> list[Car]:
    """The true car in several runs. All methods are compared with these.

    An error depends on the moment of a frame at which the car meets a wall. So each run begins a
    part of a frame later in the true motion than the run before. Run 0 begins at the start.
    """
    truth = truth_of(scene)
    cars = []
    for run_number in range(RUNS):
        # The parts are elevenths. With tenths, settings such as 0.5 may put a bounce at the very
        # end of a frame.
        later_s = run_number / (RUNS + 1) / scene.fps_target
        x_m, v_mps, _ = step(truth, truth.x_m, truth.v_mps, later_s)
        cars.append(simulated(replace(truth, x_m=x_m, v_mps=v_mps)))
    return cars

def costs_us(scenes: dict[str, Scene]) -> dict[str, float]:
    """How long the steps of a simulated second take in each scene, in microseconds.

    Other programs may slow this one. So the scenes take turns, and the least of several runs is
    nearest to the time that the steps themselves need.
    """
    costs = dict.fromkeys(scenes, math.inf)
    for _ in range(10):
        for letter, scene in scenes.items():
            x_m, v_mps, dt_s = scene.x_m, scene.v_mps, 1 / scene.fps_target
            began_s = time.perf_counter()
            for _ in range(frames_of(scene)):
                x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
            cost_us = 1e6 * (time.perf_counter() - began_s) / SPAN_S
            costs[letter] = min(costs[letter], cost_us)
    return costs

class Point(NamedTuple):
    """One method at one frame rate: a point of the chart."""

    letter: str
    fps: float
    error_m: float  # the largest in ten runs. For e it is 0: the true car is moved by e.
    cost_us: float

def measured(scene: Scene) -> list[Point]:
    """Measure each of the five methods at the frame rate of this scene."""
    truths = true_cars(scene)
    costs = costs_us({letter: with_method(scene, *method) for letter, method in METHODS.items()})
    points = []
    for letter, method in METHODS.items():
        errors_m = [furthest_m(simulated(with_method(truth.scene, *method)), truth)
                    for truth in truths]
        points.append(Point(letter, scene.fps_target, max(errors_m), costs[letter]))
    return points

DECADES = ["<=1 um", "10 um", "0.1 mm", "1 mm", "1 cm", "0.1 m", "1 m", ">=10 m"]
LEAST_ERROR_M = 1e-6  # the left edge. A decade is from one power of ten to the next.
COLUMNS_A_DECADE, ROWS_A_DECADE = 8, 4
LAST_COLUMN = COLUMNS_A_DECADE * (len(DECADES) - 1)

def error_column(error_m: float) -> int:
    """The column of an error in the picture. What is too small or too large is at its edge."""
    decades = math.log10(max(error_m, LEAST_ERROR_M) / LEAST_ERROR_M)
    return min(round(COLUMNS_A_DECADE * decades), LAST_COLUMN)

def placed(points: list[Point]) -> dict[tuple[int, int], str]:
    """The letters of the points by their row and column in the picture. + is where two meet."""
    letters: dict[tuple[int, int], str] = {}
    for point in points:
        place = round(ROWS_A_DECADE * math.log10(point.cost_us)), error_column(point.error_m)
        if place in letters and letters[place] != point.letter:
            letters[place] = "+"
        else:
            letters[place] = point.letter
    return letters

def print_picture(points: list[Point], column_m: float) -> None:
    """Draw the points as the film is drawn: error to the right, cost downwards."""
    letters = placed(points)
    rows = [row for row, _ in letters]
    limit = error_column(column_m)
    print("a column of the film |".rjust(10 + limit + 1))
    print("     us   " + "".join([text.ljust(COLUMNS_A_DECADE) for text in DECADES]).rstrip())
    for row in range(min(rows), max(rows) + 1):
        line = f"{10 ** (row / ROWS_A_DECADE):7.1f}   "
        for column in range(LAST_COLUMN + 1):
            behind = "|" if column == limit else " "
            line += letters.get((row, column), behind)
        print(line.rstrip())

def print_answers(points: list[Point], column_m: float) -> None:
    """Print from which rate on each method is good enough, and what it costs there."""
    answers = []
    for letter, method in METHODS.items():
        cost_us, text = math.inf, "at no rate"
        own = [point for point in points if point.letter == letter]
        for point in reversed(own):  # from the highest rate down, as long as it is good enough
            if point.error_m > column_m:
                break
            cost_us, text = point.cost_us, f"from {point.fps:4g} FPS on: {point.cost_us:6.1f} us"
        answers.append((cost_us, f"{letter}: {' + '.join(method):20} {text}"))
    for _, text in sorted(answers):  # by the cost, which stands first
        print(text)

def chart(scene: Scene) -> None:
    """Measure, print table and picture, and answer the question."""
    say("Which method is the cheapest that stays within a column of the film? Error: the largest "
        f"distance from the true car in {RUNS} runs of {SPAN_S} simulated seconds. Each run begins "
        "a little later in the motion. Cost: how long a simulated second takes, in microseconds "
        "(us).")
    say(f"{LEGEND}. (Method e has no error: the true car is moved by it.)")
    print()
    print(" " * 4 + "".join([letter.rjust(11) + " " * 4 for letter in METHODS]).rstrip())
    print(" FPS" + " error m     us" * len(METHODS))
    points = []
    for fps in CHART_FPS:
        row = measured(replace(scene, fps_target=fps))
        text = f"{fps:4}"
        for point in row:
            error = f"{point.error_m:.1e}" if point.error_m > 0 else "-"
            text += f"{error:>8}{point.cost_us:7.1f}"
        print(text, flush=True)
        points += row
    print()
    print_picture(points, scene.column_m())
    say("Error to the right, cost downwards: the best are in the upper left. + is where letters "
        f"meet. Within a column ({scene.column_m():.2g} m), at this and each higher rate measured:")
    print_answers(points, scene.column_m())

# ==== 8. The map: where methods fail ============================================================
# Which method fails at which frame rate, and how?

MAP_FPS = [1, 2, 5, 10, 30, 60, 120, 240, 480]
VERDICTS = {  # from the worst to the best
    "X": "gets out: further beyond a wall than the track is long",
    "S": "is stuck: beyond the same wall in the last 5 s, for ten frames or more",
    "H": "hops on: not at rest, but the true car lies still in the last 5 s",
    "G": "has too much energy: in the last 5 s, by over 1 % of that at the start",
    "L": "has too little energy: in the last 5 s, by over 1 % of that at the start",
    "P": "was over a column off, but has the right energy in the last 5 s",
    "-": "is right: never over a column from the true car",
}
FROM_WORST_TO_BEST = list(VERDICTS)

# Why do some cars hop for ever, and why do others get too much energy or too little? Let a car hop
# on its floor: |a| is 4 m/s^2, dt is 0.1 s, and it leaves at 1.1 m/s. A true car would come back to
# the floor at 1.1 m/s. But the program finds it only at the end of a frame, below the floor:
#
#     at the end of frame             1     2     3     4     5     6
#     velocity upwards, in m/s      0.7   0.3  -0.1  -0.5  -0.9  -1.3
#     height with exact, in cm        9    14    15    12     5    -6   found in frame 6: 1.3 m/s
#     height with backward, in cm     7    10     9     4    -5         found in frame 5: 0.9 m/s
#
# With exact + surface it comes back too fast. So at CR = 1 the hops get higher (G). At CR below 1,
# if it is not too small, a slow car gets in each hop what a bounce takes, and hops for ever (H).
# With backward + surface it comes back no faster, and mostly slower. So at CR = 1 it loses energy
# (L). The page .github/law.md has the law of this, and the other methods.

def verdict(car: Car, truth: Car) -> str:
    """The letter of a run of SPAN_S, compared with the true car's."""
    scene = car.scene
    left_m, right_m, track_m = scene.left_edge_m, scene.right_edge_m, scene.length_m()
    if max(car.places_m) > right_m + track_m or min(car.places_m) < left_m - track_m:
        return "X"
    late_m = [x_m for x_m, _ in late_states(car)]
    is_beyond = min(late_m) > right_m or max(late_m) < left_m
    if is_beyond and len(late_m) >= 10:  # fewer frames do not show that it stays there
        return "S"
    if furthest_m(car, truth) <= scene.column_m():
        return "-"
    # If replay has laid the true car on its floor, its energy is exactly 0.
    if late_energy(truth) == 0 and car.rest_began() is None:
        return "H"
    gain = late_energy(car) - late_energy(truth)
    one_percent = 0.01 * scene.energy(scene.x_m, scene.v_mps)
    if gain > one_percent:
        return "G"
    if gain < -one_percent:
        return "L"
    return "P"

def worst_of(letters: list[str]) -> str:
    """One letter for several runs: the worst, as a small letter if only some are so bad."""
    worst = min(letters, key=FROM_WORST_TO_BEST.index)
    return worst if set(letters) == {worst} else worst.lower()

def stability(scene: Scene) -> None:
    """Print the map: a row for each method, a column for each rate."""
    say(f"Which methods are right, and from which frame rate on? Each makes {RUNS} runs of "
        f"{SPAN_S} simulated seconds. Each run begins a little later in the motion. A capital "
        "letter: all runs have it. A small letter: only some runs have it. The others have letters "
        "that stand below it in the key.")
    print()
    print(" " * 20 + "".join([str(fps).rjust(6) for fps in MAP_FPS]) + " FPS")
    truths_by_rate = [true_cars(replace(scene, fps_target=fps)) for fps in MAP_FPS]
    found = set()
    for motion in MOTIONS:
        for correction in ALL_CORRECTIONS:
            if correction in EXACT_ONLY and motion != "exact":
                continue
            row = f"{motion} + {correction}".ljust(20)
            for truths in truths_by_rate:
                letters = [verdict(simulated(with_method(truth.scene, motion, correction)), truth)
                           for truth in truths]
                row += worst_of(letters).rjust(6)
                found.update(letters)
            print(row, flush=True)
    print()
    for letter, meaning in VERDICTS.items():
        if letter in found:
            print(f"{letter}  {meaning}")

# ==== 9. Before and after a film ================================================================
# What is said before a film, and what after it?

PYTHON = os.path.basename(sys.executable).removesuffix(".exe")  # what runs this: python3, say
SETTINGS = {each.name: each for each in fields(Scene)}
OF_THE_TRACK = [each.name for each in fields(Track)]

def as_typed(settings: dict[str, Any]) -> str:
    """The settings as one may type them."""
    words = []
    for name, value in settings.items():
        text = f"{value:.10g}" if isinstance(value, float) else str(value)
        words.append(f"{name}={text}")
    return " ".join(words)

def settings_text(scene: Scene, always: list[str]) -> str:
    """The settings named in always, and others that differ from their defaults.

    Which marks are drawn is not told, because one sees it.
    """
    told = {}
    for name, each in SETTINGS.items():
        value = getattr(scene, name)
        is_told = name in always or value != each.default
        if is_told and not name.startswith("show_"):
            told[name] = value
    return as_typed(told)

def fitted(scene: Scene) -> Scene:
    """The scene, drawn smaller if its lines are wider than the terminal."""
    if not sys.stdout.isatty():
        return scene
    room_px = shutil.get_terminal_size().columns
    if scene.show_details:
        true_m = 0.0 if scene.show_exact_mark else None
        # Places and speeds in a scene hardly ever need more characters than -1000.00.
        room_px -= len(details_text(-1000, -1000, scene.fps_target, true_m))
    width_px = min(scene.width_px, max(room_px, 10))  # 10 is the least, even if lines are broken
    # What was in the last column must stay in the last column. The first column has number 0.
    m_to_px = scene.m_to_px * ((width_px - 1) / (scene.width_px - 1))
    return replace(scene, width_px=width_px, m_to_px=m_to_px)

def cars_of(scene: Scene, unchanged: Scene | None) -> dict[str, Car]:
    """All cars of a film, by their marks, from back to front: on one track, by several methods.

    unchanged is the scene with the example's own method, if that was changed. + is its car.
    """
    cars = {}
    if scene.show_methods:
        for letter, method in METHODS.items():
            cars[letter] = Car(with_method(scene, *method))
    cars["o"] = Car(truth_of(scene))
    if unchanged is not None:
        cars["+"] = Car(unchanged)
    cars["*"] = Car(scene)
    return cars

def introduce(number: int, scene: Scene, drawn: Scene, cars: dict[str, Car],
              texts: Example) -> None:
    """Say which film this is, what one needs to know, and what to look for."""
    say(f"{number}, {texts.title}: {settings_text(scene, [*OF_THE_TRACK, 'fps_target'])}")
    if drawn.width_px < scene.width_px:
        say(f"The terminal is narrow, so the picture is drawn {drawn.width_px} columns wide. A "
            f"column is {drawn.column_m():.2g} m wide there.")
    if scene.show_methods:
        say(LEGEND)
    if not scene.has_on_it(scene.x_m):
        say("The car starts beyond a wall. The true car starts on this wall.")
    if "+" in cars:
        say("+ is the car with the example's own method. You have changed the method of the *.")
    say(texts.look_for)

def film(number: int, scene: Scene, cars: dict[str, Car], texts: Example, is_fast: bool,
         max_frames: int) -> None:
    """Say what to look for, leave time to guess, show the film, and say what was to be seen."""
    drawn = fitted(scene)
    introduce(number, scene, drawn, cars, texts)
    taking = nullcontext() if is_fast else taken_keys()
    with taking as keys:
        if keys is not None:
            say(keys.help_text())
            keys.leave_time()
        print()
        run(cars, drawn, max_frames, keys)
    if len(cars["*"].places_m) == 1:
        return  # it was ended before it began
    print_table(cars)
    if texts.seen and not is_fast:
        print()
        say(texts.seen)
        following = number + 1 if number + 1 in EXAMPLES else "chart"
        print(f"Next: {PYTHON} airtrack.py {following}")

def print_table(cars: dict[str, Car]) -> None:
    """Print what the cars have done, and whether the * was right."""
    truth, column_m = cars["o"], cars["*"].scene.column_m()
    filmed_s = (len(truth.places_m) - 1) / truth.scene.fps_target
    mean_of = f"mean of last {min(LATE_S, filmed_s):.2g} s"
    print()
    print("                      furthest from  energy in J/kg, 0 at the floor")
    print(f"                       the true car    start {mean_of:>17}  at rest")
    for mark, car in reversed(cars.items()):
        scene, began = car.scene, car.rest_began()
        method = f"{scene.motion} + {scene.correction}"
        off = f"{round(furthest_m(car, truth), 4):.4g} m"
        if scene == truth.scene:
            off = "the truth"
        first_energy = scene.energy(scene.x_m, scene.v_mps)
        energies = f"{first_energy:8.3g} {late_energy(car):17.3g}"
        rest = "not in this film" if began is None else f"from frame {began}"
        print(f"{mark} {method:19} {off:>12} {energies}  {rest}")
    answer = "Yes." if furthest_m(cars["*"], truth) <= column_m else "No."
    say(f"Was the * always within a column ({column_m:.2g} m in the full picture) of the true car? "
        f"{answer}")

# ==== 10. The command line ======================================================================
# What may be typed, and what does the user want?

class Refused(Exception):
    """What was typed is not allowed."""

COMMANDS = {"chart": chart, "stability": stability}
# Chart and map take these. They choose methods and frame rates themselves.
COMPARED = [name for name in OF_THE_TRACK if name not in ("motion", "correction")]
COMPARED += ["m_to_px", "width_px"]
# Whoever sets one of these changes what happens, and not only the picture.
MOVING = [*OF_THE_TRACK, "fps_target", "use_observed_dt", "jitter"]
MAX_FRAMES = 50_000  # enough for each example. It ends a film that would go on for ever.

# What people type because other programs have it, and what it is called here:
OTHER_NAMES = {
    "fps": "fps_target", "dt": "fps_target", "g": "a_mps2", "gravity": "a_mps2", "a": "a_mps2",
    "acceleration": "a_mps2", "left": "left_edge_m", "right": "right_edge_m", "x": "x_m",
    "height": "x_m", "v": "v_mps", "speed": "v_mps", "velocity": "v_mps", "e": "CR",
    "elasticity": "CR", "restitution": "CR", "bounciness": "CR", "zoom": "m_to_px",
    "map": "stability", "d": "d", "details": "d"}

def allowed_text(name: str) -> str:
    """What a setting may be, in words."""
    about = SETTINGS[name].metadata
    if "choices" in about:
        *others, last = [str(each) for each in about["choices"]]
        return f"{', '.join(others)} or {last}"
    least, largest = about["range"]
    kind = "a whole number" if isinstance(SETTINGS[name].default, int) else "a number"
    return f"{kind} from {least} to {largest}"

def value_of(name: str, text: str) -> Any:
    """The value of a setting, from what was typed after NAME=. Raises Refused."""
    about = SETTINGS[name].metadata
    if "choices" in about:
        for each in about["choices"]:
            if text.lower() == str(each).lower():
                return each
    else:
        least, largest = about["range"]
        digits = text.replace("\N{MINUS SIGN}", "-")  # pages are printed with it
        with suppress(ValueError):
            value = int(digits) if isinstance(SETTINGS[name].default, int) else float(digits)
            if least <= value <= largest:
                return value
    raise Refused(f"{name} must be {allowed_text(name)}, not {text!r}")

def hint(word: str) -> str:
    """What may have been meant by an unknown word."""
    meanings = {each.lower(): each for each in [*SETTINGS, *COMMANDS]} | OTHER_NAMES
    meanings |= {each: f"motion={each}" for each in MOTIONS}
    meanings |= {each: f"correction={each}" for each in ALL_CORRECTIONS}
    name = word.lstrip("-").partition("=")[0].lower()
    near = difflib.get_close_matches(name, meanings, n=1, cutoff=0.7)
    if not near:
        return "-h lists all that there are"
    meant = meanings[near[0]]
    if meant in SETTINGS:
        meant = f"{meant}=VALUE ({SETTINGS[meant].metadata['meaning']}; {allowed_text(meant)})"
    return f"did you mean {meant}?"

def read_words(words: list[str]) -> tuple[str, int, dict[str, Any]]:
    """Sort what was typed: what to show, of which number, with which settings. Raises Refused."""
    shows: list[str] = []
    numbers: list[int] = []
    typed: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if name in SETTINGS and equals:
            typed[name] = value_of(name, text)
        elif word == "d":
            typed["show_details"] = True
        elif word in COMMANDS:
            shows.append(word)
        elif word.isdecimal() and len(word) < 10:
            numbers.append(int(word))
        else:
            raise Refused(f"unknown word {word}: {hint(word)}")
    if len(shows) > 1:
        raise Refused(f"one command at a time, not {' and '.join(shows)}")
    if len(numbers) > 1:
        raise Refused(f"one EXAMPLE at a time, not {numbers[0]} and {numbers[1]}")
    show, number = "film", 1
    if shows:
        show, number = shows[0], 12
    if numbers:
        number = numbers[0]
    return show, number, typed

def scene_of(settings: dict[str, Any]) -> Scene:
    """The scene with these settings. Raises Refused if two of them exclude each other."""
    scene = Scene(**settings)
    if scene.length_m() < 0.01 - 1e-9:  # round-off: 2.21 - 2.2 is a little less than 0.01
        raise Refused(f"right_edge_m={scene.right_edge_m} must be 0.01 or more to the right of "
                      f"left_edge_m={scene.left_edge_m}")
    if scene.correction in EXACT_ONLY and scene.motion != "exact":
        raise Refused(f"correction={scene.correction} needs motion=exact")
    if scene.correction in EXACT_ONLY and not scene.has_on_it(scene.x_m):
        raise Refused(f"correction={scene.correction} needs an x_m on the track, not {scene.x_m}")
    if "m_to_px" in settings:
        return scene
    # Neither the user nor the example chose a zoom: take one that shows the right wall.
    fitting = (scene.width_px - 1) / (scene.right_edge_m - scene.first_m())
    return replace(scene, m_to_px=min(scene.m_to_px, fitting))

def compare(command: str, number: int, typed: dict[str, Any]) -> None:
    """Show the chart or the map of an example, or of one's own scene. Raises Refused."""
    example = EXAMPLES.get(number, OWN_SCENE)
    kept = {name: value for name, value in example.settings.items() if name in COMPARED}
    scene = scene_of(kept | typed)
    say(f"{command} {number}, {example.title}: {settings_text(scene, COMPARED)}")
    COMMANDS[command](scene)
    if command == "chart":
        print(f"Next: {PYTHON} airtrack.py stability {number} {as_typed(typed)}".rstrip())

def show_film(number: int, typed: dict[str, Any], is_fast: bool, max_frames: int) -> None:
    """Show the film of an example, perhaps a changed one, or of one's own scene. Raises Refused."""
    texts = EXAMPLES.get(number, OWN_SCENE)
    original = scene_of(texts.settings)
    scene = scene_of(texts.settings | typed)
    unchanged = None
    if number in EXAMPLES and differ(scene, original, MOVING):
        # Nobody knows what is to be seen there. So the film shows the true car, and asks.
        changes = {name: value for name, value in typed.items() if name in MOVING}
        texts = CHANGED._replace(title=f"changed, {as_typed(changes)}")
        scene = replace(scene, show_exact_mark=typed.get("show_exact_mark", True))
        if differ(scene, original, ["motion", "correction"]):
            unchanged = with_method(scene, original.motion, original.correction)
    film(number, scene, cars_of(scene, unchanged), texts, is_fast, max_frames)

def differ(one: Scene, other: Scene, names: list[str]) -> bool:
    """Whether the scenes differ in one of these settings."""
    return any(getattr(one, name) != getattr(other, name) for name in names)

def refuse_film_words(command: str, options: argparse.Namespace) -> None:
    """Raise Refused if something was typed that only a film takes."""
    for_films = []
    for word in options.words:
        name = word.partition("=")[0]
        if word == "d" or (name in SETTINGS and name not in COMPARED):
            for_films.append(word)
    if options.fast:
        for_films.append("--fast")
    if options.frames is not None:
        for_films.append("--frames")
    if for_films:
        raise Refused(f"{command} takes no {for_films[0]}. It chooses methods and frame rates "
                      f"itself, draws no film, and takes an EXAMPLE and {', '.join(COMPARED)}")

def carry_out(options: argparse.Namespace) -> None:
    """Show what is asked for. Raises Refused before it shows anything."""
    show, number, typed = read_words(options.words)
    if show == "film":
        max_frames = MAX_FRAMES if options.frames is None else options.frames
        show_film(number, typed, options.fast, max_frames)
    else:
        refuse_film_words(show, options)
        compare(show, number, typed)

def frame_count(text: str) -> int:
    """What was typed after --frames. argparse tells the user what this raises."""
    if text.isdecimal() and int(text) > 0:
        return int(text)
    raise argparse.ArgumentTypeError(f"N must be a whole number from 1 on, not {text}")

def epilog() -> str:
    """What -h shows at its end: the examples, the methods and the settings."""
    lines = ["examples (a larger number, of up to nine digits, is for your own scene):"]
    lines += [f"  {number:2}  {example.title}" for number, example in EXAMPLES.items()]
    lines += ["", "motions and corrections:"]
    for name, method in [*MOTIONS.items(), *CORRECTIONS.items(), ("replay", replay)]:
        first_line = str(method.__doc__).splitlines()[0]
        row = f"  {name:9} {first_line}"
        lines.append(textwrap.fill(row, 80, subsequent_indent=" " * 12))
    lines += ["", "settings: default, meaning and what is allowed"]
    for name, each in SETTINGS.items():
        lines.append(f"  {name:20}{each.default!s:9}{each.metadata['meaning']}")
        lines.append(f"{'':20}({allowed_text(name)})")
    return "\n".join(lines)

def main(argv: list[str] | None = None) -> int:
    """Do what argv or, without it, the command line asks for. Returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="airtrack.py", description=__doc__, epilog=epilog(),
        formatter_class=argparse.RawDescriptionHelpFormatter)  # it leaves our lines as they are
    parser.add_argument("words", nargs="*", metavar="WORD", help="see above")
    parser.add_argument("--fast", action="store_true",
                        help="no waiting, no keys, no text after the table")
    parser.add_argument("--frames", metavar="N", type=frame_count,
                        help=f"stop after N frames; without it, after {MAX_FRAMES}")
    options, unknown_options = parser.parse_known_intermixed_args(argv)
    options.words = [*unknown_options, *options.words]  # so that hint() sees --CR, too
    try:
        carry_out(options)
        sys.stdout.flush()
    except Refused as fault:
        parser.error(str(fault))  # this prints the text and ends the program with status 2
    except KeyboardInterrupt:
        return 130  # the status of a program that Ctrl-C has ended
    except OSError as fault:  # a full disk, a pipe that nobody reads, a terminal that is gone
        # Python prints what is left when it ends. From here on this goes nowhere.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(fault, BrokenPipeError):  # | head has read enough: this is no fault
            print(f"airtrack.py: error: {fault}", file=sys.stderr)
            return 2
    return 0

if __name__ == "__main__":
    sys.exit(main())
