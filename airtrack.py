#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text for each frame.
Each line is printed below the one before. So the film is a graph: position to
the right, time downwards.

Type any of these WORDs, in any order:
    EXAMPLE      the number of an example. Without it, a film shows example 1,
                 and chart and stability take example 12.
    d            details after each line: position x, velocity v, frame rate FPS
                 and, if the true car o is drawn, err: how far the car is to the
                 right of the o
    NAME=VALUE   a setting that replaces the example's own
    chart        no film, but speed against accuracy: what five methods cost,
                 and how wrong they are
    stability    no film, but the map: at which frame rates each method fails

For example: python airtrack.py 10 d CR=0.9

In a film, * is the car and | is a wall. < or > is the car, too, when it is out
of the picture. A 0 is where the car would be now without the wall that it met.
A . is the start. o is the true car. a to e are the cars of five methods. If you
change the car or the track of an example, + is the car without this change.
(With other frames there is no +.) A table after the film says which cars are
right. The wall to which a car is accelerated is called its floor.
"""
# What is where?
#     Sections 1 to 5    the demo: how a car moves and bounces, how a frame is drawn, and the main
#                        loop. You may stop reading after section 5.
#     Section 6          the truth, and a table: which method is good for what.
#     Sections 7 and 8   how wrong the methods are: the chart and the map.
#     Sections 9 and 10  what stands before and after a film, and the command line.
# The file examples.py holds the numbered examples and the keys. The folder .github has pages: a
# lesson, exercises, the law behind the map, and a cure for balls in games.

import argparse
import difflib
import math
import os
import re
import shutil
import sys
import textwrap
import time
from contextlib import nullcontext
from dataclasses import dataclass, field, fields, replace
from itertools import pairwise
from statistics import fmean, linear_regression
from typing import Any, NamedTuple

from examples import CHANGED, CHANGED_FRAMES, EXAMPLES, OWN_SCENE, Example, Keys, taken_keys

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
    """Forward Euler: x + v dt, then v + a dt. Each step adds a^2 dt^2/2 to the energy E."""
    return x_m + v_mps * dt_s, v_mps + a_mps2 * dt_s

def backward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Backward Euler: v + a dt, then x + v dt. Each step takes a^2 dt^2/2 from the energy E."""
    v_mps += a_mps2 * dt_s
    return x_m + v_mps * dt_s, v_mps

def exact(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Kinematics: x + v dt + a dt^2/2, and v + a dt. No step changes the energy E."""
    return x_m + v_mps * dt_s + a_mps2 * dt_s * dt_s / 2, v_mps + a_mps2 * dt_s

def arrival(d_m: float, u_mps: float, a_mps2: float) -> tuple[float, float]:
    """The other way round: when is a car at a place d_m ahead, and how fast? Returns t_s and w_mps.

    u_mps is its velocity now. Here u_mps and a_mps2 are positive if they point to that place. The
    car must be able to get there: with d = 1, u = 1 and a = -20 it is not.
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

# If you write another motion, with the same arguments, name it here. Then you can watch it in
# films, and the map has it. But three things are not for it:
#     The true car o, the energies and conserve count on a constant acceleration.
#     The chart compares only METHODS (section 6).
#     The corrections rewind and replay need the motion exact.
MOTIONS = {"forward": forward, "backward": backward, "exact": exact}

# ==== 2. Colliding ==============================================================================
# Where is the car after it has met a wall, and how fast is it?
#
# A collision is found when a move has ended beyond a wall. Then a correction changes the velocity
# and, except with none, the place. (The lesson that this program follows calls it a stickiness
# correction, because without a good one the car may stick in the wall.) The same correction works
# at both walls, because all three numbers that it gets count as positive into the wall:
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
# 1.86. None leaves the car in the wall. Surface and rebound put it on the track, but give it too
# much energy. Conserve gives it the right energy. Rewind bounces it at the right moment, too. So of
# these five only rewind puts the car where a true car is at the end of this frame.
#
# The five corrections of this section take the same four arguments, and return a new depth_m and a
# new inward_mps. So step() can call any of them.

Contact = tuple[float, float]  # depth_m and inward_mps

def none(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> Contact:
    """Reverse the velocity, times CR, but leave the car beyond the wall, where it may be caught.

    In example 3 the motion is backward, inward_mps2 is 1.5, dt is 1/30 s, and CR is 0.6. Rounded:
        frame 46   The move ends 5.17 cm deep.   inward_mps changes from  2.30 to -1.38.
        frame 47   The move ends 0.73 cm deep.   inward_mps changes from -1.33 to  0.80.
        frame 48   The move ends 3.56 cm deep.   inward_mps changes from  0.85 to -0.51.
    In frame 47 the car is still beyond the wall, because the bounce has slowed it. So its velocity
    is reversed again, now into the wall. The same happens in frames 49, 51 and 53: the car is
    caught, and the acceleration makes it sink. Such a car is said to stick. The other corrections
    prevent this.
    """
    return depth_m, -CR * inward_mps

def surface(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> Contact:
    """Put the car on the wall, and reverse its velocity, times CR.

    If the acceleration points into the wall, this lifts the car against the acceleration. A lift
    should cost speed, but surface does not slow the car. So with the exact motion, and a CR above
    0, the car has more energy than it should: in the drawn collision 2.88 J/kg instead of 1.86.
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
    """Put the car on the wall, as surface does, but with the speed that the energy allows.

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
    There are three faults:
        In each frame the acceleration pushes a car that should lie still into its floor. Rewind
        settles one bounce, and leaves the next one to the next frame. So the car keeps a velocity.
        In irregular frames, or at CR = 1, it may go on to hop: in example 12 by some mm.
        The car may turn beyond the wall, and be back on the track when the frame ends. Then no
        collision is found: a missed event (example 18).
        In a frame in which the car should cross the whole track, it may be thrown out.
    """
    # How long ago did the car pass the wall, and how fast? Run the film backwards: the car has
    # depth_m to go, out of the wall, and begins with the velocity inward_mps. The acceleration is
    # the same in a film that runs backwards, but counted out of the wall it is -inward_mps2. In the
    # drawn collision the car passed the wall 0.030 s ago, at 2.41 m/s.
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

def a_number(default: float, meaning: str, least: float, largest: float) -> Any:
    """A setting that is a number. The field keeps meaning and range for section 10, as metadata."""
    return field(default=default, metadata={"meaning": meaning, "range": (least, largest)})

def a_choice(default: Any, meaning: str, *choices: Any) -> Any:
    """A setting that is one of several words, or True or False."""
    return field(default=default, metadata={"meaning": meaning, "choices": choices})

@dataclass(frozen=True)  # frozen: nothing can change it. replace() makes a changed copy.
class Track:
    """The track and its car: all that the physics needs to know."""

    x_m: float = a_number(1.1, "start position in m", -10_000, 10_000)
    v_mps: float = a_number(0.0, "start velocity in m/s: below 0 to the left", -10_000, 10_000)
    a_mps2: float = a_number(0.0, "acceleration in m/s^2: below 0 to the left", -10_000, 10_000)
    left_edge_m: float = a_number(0.25, "position of the left wall in m", -10_000, 10_000)
    right_edge_m: float = a_number(2.2, "position of the right wall in m", -10_000, 10_000)
    CR: float = a_number(0.8, "speed after a bounce / speed before it", 0, 1)
    motion: str = a_choice("backward", "how the car is moved", *MOTIONS)
    correction: str = a_choice("rebound", "how a collision is settled", *ALL_CORRECTIONS)

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
    if track.left_edge_m <= free_m <= track.right_edge_m:  # has_on_it(), but faster
        return free_m, free_mps, None
    # The move ended beyond a wall. Count from this wall, and into it: at the right wall this is to
    # the right, too, so the signs stay. At the left wall they change.
    wall_m = track.nearest_m(free_m)
    sign = 1 if free_m > wall_m else -1
    depth_m = sign * (free_m - wall_m)
    inward_mps = sign * free_mps
    inward_mps2 = sign * track.a_mps2
    correct = CORRECTIONS[track.correction]
    new_depth_m, new_inward_mps = correct(depth_m, inward_mps, inward_mps2, track.CR)
    # Count from x = 0 and to the right again.
    return wall_m + sign * new_depth_m, sign * new_inward_mps, free_m

class Frame(NamedTuple):
    """A car at the end of a frame. mark_m is that of step()."""

    t_s: float
    dt_s: float  # how much time has passed in this frame
    x_m: float
    v_mps: float
    mark_m: float | None

class Car:
    """A car on a track. It keeps its frames, so that one can tell later what happened."""

    def __init__(self, track: Track) -> None:
        self.track = track
        self.frames = [Frame(0.0, 0.0, track.x_m, track.v_mps, None)]  # the start

    def move(self, dt_s: float) -> None:
        """Make a frame of dt_s, and keep it."""
        last = self.frames[-1]
        x_m, v_mps, mark_m = step(self.track, last.x_m, last.v_mps, dt_s)
        self.frames.append(Frame(last.t_s + dt_s, dt_s, x_m, v_mps, mark_m))

# ==== 4. Drawing ================================================================================
# How does a frame become a line of text, and why text?
#
# With text there is nothing between the physics and the eye. A column of the line is a place in m,
# counted from the left edge of the picture, times m_to_px, and rounded. Each line is printed below
# the one before. So the film is the graph of the motion.

@dataclass(frozen=True)
class Scene:
    """A track, and how it is filmed."""

    track: Track = Track()
    fps_target: float = a_number(30.0, "frames a second, 1/dt", 0.1, 1000)
    use_observed_dt: bool = a_choice(False, "dt is how long the frame lasted", False, True)
    jitter: float = a_number(0.0, "frames are up to this part longer or shorter", 0, 0.9)
    auto_off: bool = a_choice(True, "stop when the car is at rest", False, True)
    m_to_px: float = a_number(55.0, "zoom in columns for each m", 0.0001, 1000)
    width_px: int = a_number(135, "width of the picture in columns", 10, 1000)
    show_start_mark: bool = a_choice(False, "draw a . at the start", False, True)
    show_collision_mark: bool = a_choice(True, "draw a 0 where a move ended", False, True)
    show_exact_mark: bool = a_choice(False, "draw an o for the true car", False, True)
    show_methods: bool = a_choice(False, "draw a to e for five methods", False, True)

    def column_m(self) -> float:
        """How wide a column of the film is."""
        return 1 / self.m_to_px

    def first_m(self) -> float:
        """The place of the first column: 0 or, further left, the left wall."""
        return min(0.0, self.track.left_edge_m)

def render_track(scene: Scene, places_m: dict[str, float], mark_m: float | None) -> str:
    """Draw a frame: one line of scene.width_px columns. places_m has the cars by their marks.

    The line is painted from back to front: what is painted later covers what was there. So the car
    itself, *, must be the last of the cars, and nothing hides it.
    """
    track = scene.track
    marks = []
    if scene.show_collision_mark and mark_m is not None:
        marks.append(("0", mark_m))
    if scene.show_start_mark:
        marks.append((".", track.x_m))
    marks.append(("|", track.left_edge_m))
    marks.append(("|", track.right_edge_m))
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
COLOURED_MARKS = str.maketrans({
    "*": "\033[33m*\033[0m",  # yellow
    "+": "\033[36m+\033[0m",  # cyan
    "o": "\033[32mo\033[0m",  # green
    "0": "\033[31m0\033[0m",  # red
})

class View(NamedTuple):
    """How a film is printed. In a narrow terminal this scene has a smaller picture."""

    scene: Scene
    has_details: bool
    has_colours: bool

    def line(self, cars: dict[str, Car], fps: float) -> str:
        """The newest frame of the cars, as it is printed."""
        places_m = {mark: car.frames[-1].x_m for mark, car in cars.items()}
        frame = cars["*"].frames[-1]
        text = render_track(self.scene, places_m, frame.mark_m)
        if self.has_colours:
            text = text.translate(COLOURED_MARKS)
        if self.has_details:
            text += details_text(frame.x_m, frame.v_mps, fps, places_m.get("o"))
        return text

# ==== 5. The main loop ==========================================================================
# When is a film over, how does it keep its speed, and what happens in each frame? The main loop,
# run(), stands at the end of this section.

REST_S = 0.3  # long enough to be seen
REST_FRAMES = 10  # at a low frame rate 0.3 s may be a single frame
ROUND_OFF_S = 1e-9  # times are sums of many dt, so the last digits are not to be trusted

class Rest:
    """Watches a car, frame by frame, and knows whether it is at rest, and since when.

    In most films the rule is: for 0.3 s and for ten frames the car has been on the track and low,
    at most about 3 mm above its floor. (Its velocity does not count: with some methods a car that
    lies still has one.)
        How low?    At most a 650th of the height that the car can reach with the energy of its
                    start (if it has none: of the track). On the whole of the lesson's track
                    this is 3 mm. And at most half a column of the film.
        How long?   At least as long as a hop to this height lasts. If the acceleration is small,
                    this is more than 0.3 s. A car that only passes by is gone before.
    Without an acceleration the car has no floor. Then its velocity must be 0.
    """

    def __init__(self, track: Track, column_m: float) -> None:
        self.track = track
        g_mps2 = abs(track.a_mps2)
        reach_m = track.length_m()
        energy = track.energy(track.nearest_m(track.x_m), track.v_mps)
        if energy > 0 and g_mps2 > 0:
            reach_m = min(reach_m, energy / g_mps2)  # from E = g * height
        self.low_m = min(reach_m / 650, column_m / 2)
        self.needed_s = REST_S
        if g_mps2 > 0:
            # Half of the hop is a fall from its top: low = g (hop/2)^2/2.
            hop_s = 2 * math.sqrt(2 * self.low_m / g_mps2)
            self.needed_s = max(REST_S, hop_s)
        self.began_s = 0.0  # since when it is low
        self.count = 0  # for how many frames it has been low

    def look(self, frame: Frame) -> bool:
        """Count the next frame of the car. Returns whether it is at rest now."""
        if self.track.a_mps2 == 0:
            is_low = frame.v_mps == 0
        else:
            is_low = abs(frame.x_m - self.track.floor_m()) <= self.low_m
        if not is_low or not self.track.has_on_it(frame.x_m):
            self.count = 0
            return False
        if self.count == 0:
            self.began_s = frame.t_s
        self.count += 1
        low_for_s = frame.t_s - self.began_s
        return self.count >= REST_FRAMES and low_for_s >= self.needed_s - ROUND_OFF_S

def rest_began_s(track: Track, frames: list[Frame], column_m: float) -> float | None:
    """The moment since which a car is at rest in the last of these frames, or None if it is not."""
    rest = Rest(track, column_m)
    is_at_rest = False
    for frame in frames[1:]:  # frames[0] is the start
        is_at_rest = rest.look(frame)
    return rest.began_s if is_at_rest else None

def planned_length_s(scene: Scene, number: int) -> float:
    """How long the frame of this number should last. With jitter, frames are irregular."""
    # Numbers that look random, but are the same each time: the multiples of 0.618 (the golden ratio
    # - 1) without their whole parts. They are spread evenly from 0 to 1.
    from_0_to_1 = (0.618 * number) % 1
    from_minus_1_to_1 = 2 * from_0_to_1 - 1
    return (1 + scene.jitter * from_minus_1_to_1) / scene.fps_target

def planned_dt_s(scene: Scene, number: int) -> float:
    """How much time should pass for the car in this frame."""
    if scene.use_observed_dt:
        return planned_length_s(scene, number)
    return 1 / scene.fps_target  # the same in each frame, however long it lasts

STALL_S = 0.15  # a delay that everybody sees: people begin to notice one at about 0.1 s

class Pace:
    """Makes a film keep its speed: it knows when each frame is due.

    The frames are due at planned moments. If each frame slept for dt instead, it would last longer
    than dt, because computing and printing take time, too.
    """

    def __init__(self, scene: Scene, keys: Keys | None) -> None:
        self.scene = scene
        self.keys = keys
        # As if a frame had been shown one frame ago. So frame 1 is due now.
        self.shown_s = time.perf_counter() - planned_length_s(scene, 1)
        self.due_s = self.shown_s

    def wait(self, number: int, t_s: float) -> tuple[float, float]:
        """Wait until the frame of this number is due. Returns its dt_s, and the rate that d shows.

        t_s is how much time has passed in the film, for the text of a pause. Without keys (--fast)
        nothing waits: dt_s is as planned, and the rate is fps_target.
        """
        dt_s, fps = planned_dt_s(self.scene, number), self.scene.fps_target
        if self.keys is None:
            return dt_s, fps
        self.due_s += planned_length_s(self.scene, number)
        was_timed = self.keys.wait(self.due_s, number, t_s)  # False after a pause
        now_s = time.perf_counter()
        lasted_s = now_s - self.shown_s
        self.shown_s = now_s
        if was_timed:
            fps = 1 / max(lasted_s, 1e-6)  # the clock may not have ticked in between
        # After a pause or a stall plan the next frames from now. Otherwise the film would race to
        # catch up. And keep the planned dt. Otherwise the car would leap.
        if not was_timed or now_s > self.due_s + STALL_S:
            self.due_s = now_s
        elif self.scene.use_observed_dt:
            dt_s = lasted_s
        return dt_s, fps

def run(cars: dict[str, Car], scene: Scene, view: View, max_frames: int,
        keys: Keys | None) -> None:
    """Show the film until a key, the car at rest or max_frames ends it, and say which of them.

    cars has the cars by their marks, from back to front. Without keys (--fast) nothing waits.
    """
    car = cars["*"]
    rest = Rest(car.track, scene.column_m())
    pace = Pace(scene, keys)
    why = "that is the frame limit"
    for number in range(1, max_frames + 1):
        # Wait until the frame is due. A key may end the film meanwhile.
        dt_s, fps = pace.wait(number, car.frames[-1].t_s)
        if keys is not None and keys.why_quit:
            why = keys.why_quit
            break
        # Move the cars, and settle their collisions.
        for each in cars.values():
            each.move(dt_s)
        # Draw the frame.
        print(view.line(cars, fps))
        # Is it over?
        if rest.look(car.frames[-1]) and scene.auto_off:
            why = "the car is at rest"
            break
    frames, t_s = len(car.frames) - 1, car.frames[-1].t_s
    print(f"Stopped after {frames} frames, t = {t_s:.2f} s: {why}.", flush=True)

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
# room. In example 12 it does so after bounce 55. With CR = 0.98 it would be after bounce 602.

GRAZE = 2.5e-11  # on the lesson's track 5e-11 m: far more than round-off, less than an atom's width

def next_bounce(h_m: float, rise_mps: float, g_mps2: float,
                room_m: float) -> tuple[str, float, float]:
    """Which wall does the ball meet next, after how many s, and at how many m/s?

    h_m is the height of the ball, and rise_mps is its velocity, upwards.
    """
    # To rise to the ceiling takes the energy g * (room - h). For a ball that only just
    # gets there, round-off would decide. So here it meets the ceiling only if it could rise higher,
    # by GRAZE times the height of the room.
    energy_to_meet_it = g_mps2 * (room_m - h_m + GRAZE * room_m)
    if rise_mps > 0 and rise_mps * rise_mps / 2 >= energy_to_meet_it:
        flight_s, speed_mps = arrival(room_m - h_m, rise_mps, -g_mps2)
        return "ceiling", flight_s, speed_mps
    flight_s, speed_mps = arrival(h_m, -rise_mps, g_mps2)
    return "floor", flight_s, speed_mps

def follow(h_m: float, rise_mps: float, g_mps2: float, room_m: float, CR: float,
           remaining_s: float) -> tuple[float, float, bool]:
    """Follow the ball from bounce to bounce. Where is it after remaining_s?

    Returns its height, its velocity upwards, and whether it has bounced.
    """
    has_bounced = has_met_floor = False
    since_floor_s = 0.0  # the time since the last bounce on the floor
    while rise_mps != 0 or g_mps2 != 0:  # otherwise nothing moves the ball
        wall, flight_s, speed_mps = next_bounce(h_m, rise_mps, g_mps2, room_m)
        if flight_s > remaining_s:
            break  # the time is over before the ball gets there
        has_bounced = True
        remaining_s -= flight_s
        since_floor_s += flight_s
        if wall == "ceiling":
            h_m, rise_mps = room_m, -CR * speed_mps
            continue
        h_m, rise_mps = 0.0, CR * speed_mps
        if rise_mps * rise_mps / 2 <= g_mps2 * GRAZE * room_m:
            return 0.0, 0.0, True  # it lies still: see GRAZE
        if CR == 1 and has_met_floor:
            # At CR = 1 the ball needs the same time from floor to floor again and again. So leave
            # out all whole periods. What remains is the remainder of a division.
            remaining_s = remaining_s % since_floor_s
        has_met_floor = True
        since_floor_s = 0.0
    h_m, rise_mps = exact(h_m, rise_mps, -g_mps2, remaining_s)
    return h_m, rise_mps, has_bounced

def replay(track: Track, x_m: float, v_mps: float, dt_s: float) -> Moved:
    """Follow the exact motion for a whole frame, from bounce to bounce, as a ball in a room.

    It takes and returns what step() does, and is right for a frame of any length.
    """
    # A car that has moved one way only, and is still on the track, has met no wall. The lines below
    # would find the same. But most frames of a flight end here, which is several times as fast.
    free_m, free_mps = exact(x_m, v_mps, track.a_mps2, dt_s)
    has_turned = v_mps * free_mps < 0  # its velocity has changed its sign
    if track.left_edge_m <= free_m <= track.right_edge_m and not has_turned:
        return free_m, free_mps, None
    # Turn the track into a room, and back again. up is the direction away from the floor.
    up = -1 if track.a_mps2 > 0 else 1
    floor_m = track.floor_m()
    h_m = up * (track.nearest_m(x_m) - floor_m)
    h_m, rise_mps, has_bounced = follow(h_m, up * v_mps, abs(track.a_mps2), track.length_m(),
                                        track.CR, dt_s)
    x_m = track.nearest_m(floor_m + up * h_m)  # round-off must not leave it beyond a wall
    if not has_bounced:
        return x_m, up * rise_mps, None
    return x_m, up * rise_mps, free_m

# Which method should I take? A method is a motion and a correction. Of the fourteen possible ones,
# example 21 and the chart compare five.
#
#     method                 energy       error of the place          take it for
#     a  backward + rebound  up and down  order 1                     seeing errors
#     b  exact + rebound     too much     order 1                     cars without an acceleration
#     c  exact + conserve    right        order 1: bounces come late  balls in a game
#     d  exact + rewind      right        none                        short frames
#     e  exact + replay      right        none                        the truth
#
# The table is for a CR above 0, and for a car that bounces on its floor, at most once in a frame.
# The energy is that after a bounce. Order 1 means that frames of half the length, if they are short
# enough, make about half the error. There are two exceptions:
#     At CR < 1 the last frames before the Zeno point have several bounces. There d gets a little
#     too much energy. So it has an error of order 2: frames of half the length make a quarter.
#     Without an acceleration a, b, d and e have no error, and c has one of order 1.
#
# Methods a to d need short frames, because they look only at the end of a frame, and settle one
# bounce there. They miss a bounce if the car is back on the track when the frame ends (example 18).
# In long frames a, b and d may even throw the car out at the other end (example 14). Methods c and
# e never do. Method e is right in frames of any length. Why not always take e? It needs a constant
# acceleration, as b to d do. And it needs to know all walls at once, to find the next bounce. The
# others settle only the wall that a move has met.
METHODS: dict[str, dict[str, Any]] = {
    "a": {"motion": "backward", "correction": "rebound"},
    "b": {"motion": "exact", "correction": "rebound"},
    "c": {"motion": "exact", "correction": "conserve"},
    "d": {"motion": "exact", "correction": "rewind"},
    "e": {"motion": "exact", "correction": "replay"},
}

THE_TRUTH = "e"  # the true car is moved by this method

def by_five_methods(track: Track) -> dict[str, Track]:
    """The track with each of the five methods, by their letters.

    All start on the track: a start beyond a wall is moved to the wall.
    """
    track = replace(track, x_m=track.nearest_m(track.x_m))
    return {letter: replace(track, **method) for letter, method in METHODS.items()}

def truth_of(track: Track) -> Track:
    """The track of the true car."""
    return by_five_methods(track)[THE_TRUTH]

def method_text(track: Track) -> str:
    """The method in words, as in backward + rebound."""
    return f"{track.motion} + {track.correction}"

LEGEND = {letter: f"{letter}: {method_text(track)}"
          for letter, track in by_five_methods(Track()).items()}

# ==== 7. The chart: speed against accuracy ======================================================
# What does each method cost, and how wrong is it?

SPAN_S = 20  # of simulated time: eight bounces in example 10, so errors have time to grow
RUNS = 10  # of each method: with fewer, the largest error would be less reliable

# PYTHON, say() and track_text() are for all that is printed from here on.

PYTHON = os.path.basename(sys.executable).removesuffix(".exe")  # what runs this: python3, say

def say(text: str) -> None:
    """Print a paragraph, as wide as the terminal but no wider than is good to read."""
    width = min(100, shutil.get_terminal_size().columns)
    print(textwrap.fill(text, width), flush=True)

def track_text(track: Track) -> str:
    """Car and track, by the names that one may type. (A number may have ten digits.)"""
    return (f"x_m={track.x_m:.10g} v_mps={track.v_mps:.10g} a_mps2={track.a_mps2:.10g} "
            f"CR={track.CR:.10g}, walls at {track.left_edge_m:.10g} and "
            f"{track.right_edge_m:.10g} m")

def simulate(track: Track, lengths_s: list[float]) -> list[Frame]:
    """The start of a car, and a frame of each of these lengths."""
    car = Car(track)
    for dt_s in lengths_s:
        car.move(dt_s)
    return car.frames

def beside(frames: list[Frame], track: Track) -> list[Frame]:
    """A car on this track that starts as those frames do, and makes frames of the same lengths."""
    start = frames[0]
    track = replace(track, x_m=track.nearest_m(start.x_m), v_mps=start.v_mps)
    return simulate(track, [frame.dt_s for frame in frames[1:]])

def furthest_m(frames: list[Frame], true_frames: list[Frame]) -> float:
    """How far a car was at most from its true car."""
    pairs = zip(frames, true_frames, strict=True)
    return max(abs(frame.x_m - true.x_m) for frame, true in pairs)

def ten_true_runs(track: Track, fps: int) -> list[list[Frame]]:
    """The frames of the true car in ten runs of SPAN_S. All methods are compared with them.

    An error depends on the moment of a frame at which the car meets a wall. So the runs begin at
    ten moments of the same motion. Run 0 begins at the start, and each other run a part of a frame
    after run 0, where the true car is then.
    """
    truth = truth_of(track)
    runs = []
    for run_number in range(RUNS):
        # The parts are elevenths. With tenths, round settings may put a bounce at a frame's end.
        later_s = run_number / (RUNS + 1) / fps
        x_m, v_mps, _ = step(truth, truth.x_m, truth.v_mps, later_s)
        later = replace(truth, x_m=x_m, v_mps=v_mps)
        runs.append(simulate(later, [1 / fps] * (SPAN_S * fps)))
    return runs

def costs_us(tracks: dict[str, Track], fps: int) -> dict[str, float]:
    """How long the steps of a simulated second take with each method, in microseconds.

    Other programs may slow this one. So the methods take turns, and the least of several runs is
    nearest to the time that the steps themselves need.
    """
    costs = dict.fromkeys(tracks, math.inf)
    for _ in range(max(10, 600 // fps)):  # at a low rate a run is short, so make more of them
        for letter, track in tracks.items():
            x_m, v_mps = track.x_m, track.v_mps
            began_s = time.perf_counter()
            for _ in range(SPAN_S * fps):  # the bare steps: keeping the states would cost, too
                x_m, v_mps, _ = step(track, x_m, v_mps, 1 / fps)
            cost_us = 1e6 * (time.perf_counter() - began_s) / SPAN_S
            costs[letter] = min(costs[letter], cost_us)
    return costs

class Point(NamedTuple):
    """One method at one frame rate: a point of the chart."""

    fps: int
    error_m: float  # the largest in ten runs. For e it is 0: e is how the true car is moved.
    cost_us: float

def measured(track: Track, fps: int) -> dict[str, Point]:
    """Measure each of the five methods at this rate."""
    tracks = by_five_methods(track)
    costs = costs_us(tracks, fps)
    true_runs = ten_true_runs(track, fps)
    points = {}
    for letter, method_track in tracks.items():
        error_m = 0.0
        for true_frames in true_runs:
            frames = beside(true_frames, method_track)
            error_m = max(error_m, furthest_m(frames, true_frames))
        points[letter] = Point(fps, error_m, costs[letter])
    return points

CHART_FPS = [1, 2, 5, 10, 30, 60, 120, 240, 480, 960]
GAME_FPS = 60  # most screens show so many frames a second

Series = dict[str, list[Point]]  # the points of each method, from the lowest rate to the highest

def order_text(points: list[Point], track_m: float) -> str:
    """The order of a method: at order 1 twice the rate divides the error by 2, at order 2 by 4."""
    # Errors as large as the track tell nothing of the order. So take those below a tenth of it.
    small = [point for point in points if point.error_m < track_m / 10]
    # Round-off has no order. (5e-10 of the lesson's track is 1e-9 m.)
    telling = [point for point in small if point.error_m >= 5e-10 * track_m]
    if small and not telling:
        return "none"
    if len(telling) < 3:
        return "?"  # too few for a straight line
    # error = constant / rate^order. In logarithms this is a straight line, and it goes down: its
    # slope is minus the order.
    rates = [math.log(point.fps) for point in telling]
    errors = [math.log(point.error_m) for point in telling]
    slope, _ = linear_regression(rates, errors)
    return f"{-slope:.1f}"

def row_text(row: dict[str, Point], fps: int) -> str:
    """A row of the table: all methods at one rate. A - is no error, not even round-off."""
    text = f"{fps:4}"
    for point in row.values():
        error = f"{point.error_m:.1e}" if point.error_m > 0 else "-"
        text += f"{error:>8}{point.cost_us:7.1f}"
    return text

DECADES = ["<=1 um", "10 um", "0.1 mm", "1 mm", "1 cm", "0.1 m", "1 m", ">=10 m"]
LEAST_ERROR_M = 1e-6  # the left edge. A decade is from one power of ten to the next.
COLUMNS_A_DECADE, ROWS_A_DECADE = 8, 4
LAST_COLUMN = COLUMNS_A_DECADE * (len(DECADES) - 1)

def error_column(error_m: float) -> int:
    """The column of an error in the picture. What is too small or too large is at its edge."""
    decades = math.log10(max(error_m, LEAST_ERROR_M) / LEAST_ERROR_M)
    return min(round(COLUMNS_A_DECADE * decades), LAST_COLUMN)

def print_picture(series: Series, column_m: float) -> None:
    """Draw the points as the film is drawn: error to the right, cost downwards."""
    letters: dict[tuple[int, int], str] = {}  # by row and column
    for letter, points in series.items():
        for point in points:
            row = round(ROWS_A_DECADE * math.log10(point.cost_us))
            place = row, error_column(point.error_m)
            there = letters.get(place, letter)  # what stands there already, if anything
            letters[place] = letter if there == letter else "+"
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

def print_answers(series: Series, column_m: float) -> None:
    """Print from which rate on a method is good enough, and its cost and error in a game."""
    rows = []
    for letter, points in series.items():
        cheapest_us = math.inf
        within = "at no rate"
        for point in reversed(points):  # from the highest rate down, as long as it is good enough
            if point.error_m > column_m:
                break
            cheapest_us = point.cost_us
            within = f"from {point.fps:4} FPS on: {cheapest_us:6.1f} us"
        in_game = next(point for point in points if point.fps == GAME_FPS)
        off = f"up to {in_game.error_m:.2g} m off"
        if letter == THE_TRUTH:
            off = "right by definition"
        text = f"{LEGEND[letter]:22} {within:27} {in_game.cost_us:5.1f} us, {off}"
        rows.append((cheapest_us, text))
    print(f"{'':22} {'within a column':27} at {GAME_FPS} FPS, as in a game")
    for _, text in sorted(rows):  # by the cost, which stands first
        print(text)

def chart(scene: Scene, words: str) -> None:
    """Measure, print table and picture, and answer the question.

    words are the number and the settings of the scene, as they were typed.
    """
    column_m = scene.column_m()
    say(f"Speed against accuracy. Scene {words}: {track_text(scene.track)}")
    say("Which method is the cheapest that stays within a column of the film? Each runs "
        f"{RUNS} times for {SPAN_S} simulated seconds in equal frames, from {RUNS} moments of the "
        "motion (the first is the film's). Error: the largest distance from the true car. (Method "
        "e has none, because the true car is moved by it.) Cost: the time that a simulated second "
        "takes, in us (microseconds). Order 1: half the dt makes half the error. Order 2: it makes "
        "a quarter. (The order is taken from the errors below a tenth of the track and above "
        "round-off. It is none if they are all round-off, and ? if fewer than three are left.)")
    say(", ".join(LEGEND.values()))
    print()
    print(" " * 4 + "".join([letter.rjust(11) + " " * 4 for letter in METHODS]).rstrip())
    print(" FPS" + " error m     us" * len(METHODS))
    series: Series = {letter: [] for letter in METHODS}
    for fps in CHART_FPS:
        row = measured(scene.track, fps)
        print(row_text(row, fps), flush=True)
        for letter, point in row.items():
            series[letter].append(point)
    orders = "order"
    for points in series.values():
        order = order_text(points, scene.track.length_m())
        orders += f"{order:>7}" + " " * 8
    print(orders.rstrip())
    print()
    print_picture(series, column_m)
    say("Error to the right, cost downwards: the best are in the upper left. + is where letters "
        f"meet. The answer: within a column ({column_m:.2g} m) in all runs, at this rate and at "
        "each higher one of the table:")
    print_answers(series, column_m)
    say("Why c in a game? It comes to rest on a floor if CR is below 1, it is never thrown out, "
        "and it need not know all walls before it moves, as e must. But its bounces come up to a "
        "frame late.")
    print(f"Next: {PYTHON} airtrack.py stability {words}")

# ==== 8. The map: where methods fail ============================================================
# Which method fails at which frame rate, and how? The table after a film judges by the same rules.

MAP_FPS = [1, 2, 5, 10, 30, 60, 120, 240, 480]
LATE_S = 15  # here the last 5 s of a run begin
VERDICTS = {  # from the worst to the best: a letter, its name, and what it means
    "X": ("gets out", "further beyond a wall than the track is long"),
    "S": ("is stuck", "beyond the same wall in all frames from 15 to 20 s, at least ten"),
    "H": ("hops on", "not at rest at 20 s, and the true car lies still from 15 s on"),
    "W": ("has a wrong energy", "a G in some runs, an L in others"),  # only in the map: worst_of()
    "G": ("has too much energy", "on average from 15 to 20 s, by over 1 % of the start's"),
    "L": ("has too little energy", "on average from 15 to 20 s, by over 1 % of the start's"),
    "P": ("was off, with the right energy", "over a column off, energy right from 15 s on"),
    "-": ("is right", "never over a column away from the true car"),
}
FROM_WORST_TO_BEST = list(VERDICTS)

# Why do some cars hop for ever (H), and why do others get too much energy (G) or too little (L)?
# Let a car hop on its floor. g is the size of its acceleration, 4 m/s^2 here, and dt is 0.1 s. The
# hop begins at the speed u = 1.1 m/s. A true car would come back to the floor at 1.1 m/s. But the
# program finds the car only at the end of a frame, below the floor:
#
#     at the end of frame             1     2     3     4     5     6
#     velocity upwards, in m/s      0.7   0.3  -0.1  -0.5  -0.9  -1.3
#     height with exact, in cm        9    14    15    12     5    -6   found in frame 6: 1.3 m/s
#     height with backward, in cm     7    10     9     4    -5         found in frame 5: 0.9 m/s
#
# In general a hop of n frames comes back at the speed
#             w = n g dt - u = u + k g dt,        where k = n - 2 u/(g dt).
#     With exact + surface n is the first number for which n g dt is above 2 u. So k is above 0, and
#     at most 1: in each hop the car gets speed from nothing. At CR = 1 it hops higher and higher,
#     up to the other wall (G). At CR below 1 it loses (1 - CR) w in each bounce. If CR is not too
#     small, a slow car gets in each hop as much as it loses, and hops for ever (H). Rebound gives
#     even more.
#     With backward + surface a hop ends one frame earlier than with exact + surface, if it has two
#     frames or more there. So k is above -1, and at most 0. If k is below 0, the next hop is
#     shorter, even at CR = 1. In the end the hops have one frame: the car lies on its floor (L). If
#     k is 0, as after a start at v = 0, the hops at CR = 1 stay as long as they are.
# The page .github/law.md has the other methods, the proofs and the exceptions.

def verdict(track: Track, frames: list[Frame], true_frames: list[Frame], column_m: float) -> str:
    """The letter of a car that ran for 20 s beside its true car: any letter but W."""
    left_m, right_m, track_m = track.left_edge_m, track.right_edge_m, track.length_m()
    places_m = [frame.x_m for frame in frames[1:]]  # the start may be anywhere
    if max(places_m) > right_m + track_m or min(places_m) < left_m - track_m:
        return "X"
    late = [frame for frame in frames if frame.t_s >= LATE_S - ROUND_OFF_S]
    late_m = [frame.x_m for frame in late]
    is_beyond = min(late_m) > right_m or max(late_m) < left_m
    if is_beyond and len(late) >= 10:  # fewer frames do not show that it stays there
        return "S"
    if furthest_m(frames, true_frames) <= column_m:
        return "-"
    # If replay has laid the true car on its floor, its energy is exactly 0.
    true_energies = [track.energy(true.x_m, true.v_mps) for true in true_frames[-len(late):]]
    if max(true_energies) == 0 and rest_began_s(track, frames, column_m) is None:
        return "H"
    energies = [track.energy(frame.x_m, frame.v_mps) for frame in late]
    gain = fmean(energies) - fmean(true_energies)
    # 100 % is the energy at the start. (If it is beyond a wall, the true car has another start.)
    starts = [track.energy(start.x_m, start.v_mps) for start in (frames[0], true_frames[0])]
    one_percent = 0.01 * max(abs(energy) for energy in starts)
    if gain > one_percent:
        return "G"
    if gain < -one_percent:
        return "L"
    return "P"

def worst_of(letters: list[str]) -> str:
    """One letter for several runs: the worst, as a small letter if only some are so bad."""
    if "G" in letters and "L" in letters:
        letters = ["W" if letter in "GL" else letter for letter in letters]
    worst = min(letters, key=FROM_WORST_TO_BEST.index)
    if any(letter != worst for letter in letters):
        return worst.lower()
    return worst

def stability(scene: Scene, words: str) -> None:
    """Print the map: a row for each method, a column for each rate. words are as in chart()."""
    column_m = scene.column_m()
    say(f"Stability. Scene {words}: {track_text(scene.track)}")
    say(f"Which methods are right, and from which frame rate on? Each runs {RUNS} times for "
        f"{SPAN_S} simulated seconds in equal frames, from {RUNS} moments of the motion (the first "
        "is the film's). A capital letter: all runs have it. A small letter: the worst runs have "
        "it, and others are better. The key goes from the worst to the best. Only a car that was "
        "over a column off at some time can have an H, W, G, L or P.")
    print(f"Next: {PYTHON} airtrack.py 20 (why hops get too much energy), or 19 (too little)")
    print()
    print(" " * 20 + "".join([str(fps).rjust(6) for fps in MAP_FPS]) + " FPS")
    true_runs = {fps: ten_true_runs(scene.track, fps) for fps in MAP_FPS}
    for motion in MOTIONS:
        for correction in ALL_CORRECTIONS:
            if correction in EXACT_ONLY and motion != "exact":
                continue
            track = replace(scene.track, motion=motion, correction=correction)
            row = method_text(track).ljust(20)
            for fps in MAP_FPS:
                letters = []
                for true_frames in true_runs[fps]:
                    frames = beside(true_frames, track)
                    letters.append(verdict(track, frames, true_frames, column_m))
                row += worst_of(letters).rjust(6)
            print(row, flush=True)
    for letter, (name, meaning) in VERDICTS.items():
        print(f"{letter}  {name}: {meaning}")

# ==== 9. Before and after a film ================================================================
# What is said before a film, and what after it?

class Film(NamedTuple):
    """A film as somebody wants it."""

    number: int  # of the example
    typed: list[str]  # the settings that were typed, as NAME=VALUE
    scene: Scene
    texts: Example  # what is said before and after it
    unchanged: Scene | None  # the example without the changes, if there are any
    plus: Track | None  # the track of the +, if one is drawn
    has_details: bool
    is_fast: bool
    max_frames: int

def cars_of(scene: Scene, plus: Track | None) -> dict[str, Car]:
    """All cars that a film draws, by their marks, from back to front."""
    cars = {}
    if scene.show_methods:
        for letter, track in by_five_methods(scene.track).items():
            cars[letter] = Car(track)
    if scene.show_exact_mark:
        cars["o"] = Car(truth_of(scene.track))
    if plus is not None:
        cars["+"] = Car(plus)
    cars["*"] = Car(scene.track)
    return cars

def scene_text(scene: Scene) -> str:
    """All that moves the car, in words."""
    text = f"{track_text(scene.track)}; {method_text(scene.track)}, {scene.fps_target:.10g} FPS"
    if scene.jitter > 0:
        text += f", jitter={scene.jitter:.10g}"
    if scene.use_observed_dt:
        text += ", use_observed_dt=True"
    if not scene.track.has_on_it(scene.track.x_m):
        text += "; it starts beyond a wall"
    if scene.show_methods:
        text = "; ".join([text, *LEGEND.values()])
    return text

def has_colours() -> bool:
    """Whether the output is a terminal that shows colours, and is to show them."""
    terminal = os.environ.get("TERM", "dumb")
    return sys.stdout.isatty() and terminal != "dumb" and not os.environ.get("NO_COLOR")

def fitted(scene: Scene, has_details: bool) -> Scene:
    """The scene, drawn smaller if its lines are wider than the terminal."""
    columns = shutil.get_terminal_size().columns
    if has_details:
        true_m = 0.0 if scene.show_exact_mark else None
        # Places and speeds in a scene hardly ever need more characters than -1000.00.
        columns -= len(details_text(-1000, -1000, scene.fps_target, true_m))
    columns = max(columns, 10)  # the least that a scene may have, even if lines are broken then
    if columns >= scene.width_px or not sys.stdout.isatty():
        return scene
    # What was in the last column must stay in the last column. The first column has number 0.
    m_to_px = scene.m_to_px * (columns - 1) / (scene.width_px - 1)
    return replace(scene, width_px=columns, m_to_px=m_to_px)

def energies_text(car: Car) -> str:
    """The first, the least, the most and the last energy, with up to four significant digits."""
    energies = [car.track.energy(frame.x_m, frame.v_mps) for frame in car.frames]
    text = ""
    for energy in (energies[0], min(energies), max(energies), energies[-1]):
        # Rounded to nine digits first. Otherwise round-off may decide the fourth.
        rounded = float(f"{energy:.9g}")
        text += f"{rounded:.4g}".rjust(10)
    return text

def hops_text(car: Car) -> str:
    """How many frames its hops have, from bounce to bounce. Of many, the first four and last two.

    A bounce in each frame is no hop, as of a car that lies, is stuck, or is very fast.
    """
    bounces = [number for number, frame in enumerate(car.frames) if frame.mark_m is not None]
    hops = [str(after - before) for before, after in pairwise(bounces) if after - before > 1]
    if not hops:
        return "no hop"
    if len(hops) > 6:
        hops = [*hops[:4], "...", *hops[-2:]]
    return " ".join(hops)

def end_text(car: Car, column_m: float) -> str:
    """What the car does at the end of the film."""
    began_s = rest_began_s(car.track, car.frames, column_m)
    if began_s is not None:
        return f"at rest from {began_s:.2f} s"
    if any(car.track.has_on_it(frame.x_m) for frame in car.frames[-10:]):
        return "still moves"
    return "is beyond a wall"  # in all of its last ten frames, not only after a bounce

def off_text(car: Car, true_frames: list[Frame]) -> str:
    """How far the car was at most from its true car."""
    off_m = furthest_m(car.frames, true_frames)
    little_m = float(f"{car.track.length_m() / 2000:.1g}")  # 1 mm on the lesson's track
    return f"under {little_m:g} m" if off_m < little_m else f"{off_m:.4g} m"

def film_verdict(car: Car, scene: Scene) -> str:
    """The verdict on the first SPAN_S. To a shorter film planned frames are added."""
    judged = Car(car.track)
    judged.frames = list(car.frames)
    while judged.frames[-1].t_s < SPAN_S - ROUND_OFF_S:
        judged.move(planned_dt_s(scene, len(judged.frames)))
    # The frames that began before the time was over.
    frames = [each for each in judged.frames if each.t_s - each.dt_s < SPAN_S - ROUND_OFF_S]
    return verdict(car.track, frames, beside(frames, truth_of(car.track)), scene.column_m())

def tell_cars(cars: dict[str, Car], scene: Scene, unchanged: Scene | None) -> None:
    """Print two tables of the cars, and whether the * is right."""
    column_m = scene.column_m()
    rows, ends = [], []
    verdicts = {}  # of the cars that are no true cars, by their marks
    true_frames = {}  # of the true cars, by their tracks: most cars have the same true car
    for mark, car in reversed(cars.items()):
        off = "the truth"
        end = f"{mark} {end_text(car, column_m) + ';':23}{hops_text(car)}"
        truth = truth_of(car.track)
        if car.track != truth:
            if truth not in true_frames:
                true_frames[truth] = beside(car.frames, truth)
            off = off_text(car, true_frames[truth])
            verdicts[mark] = film_verdict(car, scene)
            name, _ = VERDICTS[verdicts[mark]]
            end = f"{end + '; ':50}{name}"
        rows.append(f"{mark} {method_text(car.track):20}{off:>15}{energies_text(car)}")
        ends.append(end)
    print()
    print("                        furthest from     energy in J/kg (0: lies at its floor)")
    print("                         its true car     first     least      most      last")
    print(*rows, sep="\n")
    print()
    print(f"  at the film's end;     each hop in frames;      verdict on the first {SPAN_S} s")
    print(*ends, sep="\n")
    answer = "By definition: it is the true car."
    if "*" in verdicts:
        name, meaning = VERDICTS[verdicts["*"]]
        yes_or_no = "Yes" if verdicts["*"] == "-" else "No"
        is_short = cars["*"].frames[-1].t_s < SPAN_S - ROUND_OFF_S
        computed = " (computed on after the film's end)" if is_short else ""
        answer = f"{yes_or_no}. In its first {SPAN_S} s{computed} it {name}: {meaning}."
    if unchanged is not None:
        before = cars.get("+", Car(unchanged.track))  # with other frames there is no +
        name, _ = VERDICTS[film_verdict(before, unchanged)]
        answer += f" Without your change it {name}."
    say(f"Is the * right? {answer} (A column is 1/m_to_px, {column_m:.2g} m.)")

def film(wanted: Film) -> None:
    """Say what to look for, leave time to guess, show the film, and say what was to be seen."""
    scene, texts = wanted.scene, wanted.texts
    title = texts.title
    if wanted.number in EXAMPLES:
        title = f"Example {wanted.number}: {texts.title}"
    say(", ".join([title, *wanted.typed]))
    say(scene_text(scene))
    drawn = fitted(scene, wanted.has_details)
    if drawn.width_px < scene.width_px:
        say(f"The picture is drawn {drawn.width_px} columns wide, because the terminal is narrow.")
    view = View(drawn, wanted.has_details, has_colours() and not wanted.is_fast)
    cars = cars_of(scene, wanted.plus)
    taking = nullcontext() if wanted.is_fast else taken_keys()
    with taking as keys:
        if keys is None:
            say(texts.look_for)
        else:
            for text in keys.texts_before(texts.look_for):
                say(text)
            keys.leave_time()
        print()
        run(cars, scene, view, wanted.max_frames, keys)
    if len(cars["*"].frames) == 1:
        return  # it was ended before it began
    tell_cars(cars, scene, wanted.unchanged)
    if not wanted.is_fast:
        say_after(wanted)

def say_after(wanted: Film) -> None:
    """Say what was to be seen, and what comes next."""
    print()
    if wanted.texts.seen:
        say(wanted.texts.seen)
    else:
        say("At which frame rates is which method right? See the map:")
        words = [word for word in wanted.typed if word.partition("=")[0] in COMPARED]
        print(PYTHON, "airtrack.py stability", wanted.number, *words)
    following = wanted.number + 1 if wanted.number + 1 in EXAMPLES else "chart"
    say(f"Next: {PYTHON} airtrack.py {following}")

# ==== 10. The command line ======================================================================
# What may be typed, and what does the user want?

class Refused(ValueError):
    """What was typed is not allowed."""

FRAMES = 50_000  # a film that nobody stops ends then
COMMANDS = {"chart": chart, "stability": stability}
OF_THE_TRACK = {each.name: each for each in fields(Track)}
OF_THE_FILM = {each.name: each for each in fields(Scene) if each.name != "track"}
OF_THE_FRAMES = ["fps_target", "use_observed_dt", "jitter"]
SETTINGS = OF_THE_TRACK | OF_THE_FILM
# Chart and map take these. They choose methods and frame rates themselves.
COMPARED = [name for name in OF_THE_TRACK if name not in ("motion", "correction")]
COMPARED += ["m_to_px", "width_px"]

# What people type because other programs have it, and what it is called here:
OTHER_NAMES = {
    "fps": "fps_target", "dt": "fps_target", "time": "fps_target", "g": "a_mps2",
    "gravity": "a_mps2", "a": "a_mps2", "acceleration": "a_mps2", "left": "left_edge_m",
    "right": "right_edge_m", "x": "x_m", "y": "x_m", "position": "x_m", "h": "x_m",
    "height": "x_m", "v": "v_mps", "vx": "v_mps", "vy": "v_mps", "speed": "v_mps",
    "velocity": "v_mps", "e": "CR", "restitution": "CR", "bounciness": "CR", "elasticity": "CR",
    "zoom": "m_to_px", "euler": "motion=forward", "rk4": "motion=exact", "map": "stability",
    "details": "d", "help": "-h", "fast": "--fast", "frames": "--frames"}

def allowed_text(name: str) -> str:
    """What a setting may be, in words."""
    about = SETTINGS[name].metadata
    if "choices" in about:
        *others, last = [str(each) for each in about["choices"]]
        return f"{', '.join(others)} or {last}"
    least, largest = about["range"]
    kind = "a whole number" if name == "width_px" else "a number"
    return f"{kind} from {least} to {largest}"

def fault_text(name: str, text: str) -> str:
    """What is said of a value that a setting may not have."""
    return f"{name} must be {allowed_text(name)}, not {text}"

def value_of(name: str, text: str) -> Any:
    """The value of a setting, from what a user typed after NAME=. Raises Refused."""
    if "choices" in SETTINGS[name].metadata:
        for each in SETTINGS[name].metadata["choices"]:
            if text.lower() == str(each).lower():
                return each
        return text  # check() refuses it
    if "," in text:
        raise Refused(f"{fault_text(name, text)}: write a decimal point, not a comma")
    try:
        return int(text) if name == "width_px" else float(text)
    except ValueError:
        raise Refused(fault_text(name, text)) from None

def check(name: str, value: Any) -> None:
    """Raise Refused if the setting may not have this value."""
    about = SETTINGS[name].metadata
    if "choices" in about:
        if value not in about["choices"]:
            raise Refused(fault_text(name, value))
    elif not about["range"][0] <= value <= about["range"][1]:
        raise Refused(fault_text(name, f"{value:.10g}"))

def check_pairs(track: Track) -> None:
    """Raise Refused if two settings of the track exclude each other."""
    left_m, right_m = track.left_edge_m, track.right_edge_m
    if right_m - left_m < 0.01 - 1e-9:  # round-off: 2.21 - 2.2 is a little less than 0.01
        raise Refused(f"right_edge_m must be left_edge_m + 0.01 or more, so from "
                      f"{left_m + 0.01:.10g} on, not {right_m}")
    if track.correction not in EXACT_ONLY:
        return
    condition = f"with correction={track.correction}"
    if track.motion != "exact":
        raise Refused(f"motion must be exact {condition}, not {track.motion}: choose "
                      "motion=exact or another correction")
    if not track.has_on_it(track.x_m):
        raise Refused(f"x_m must be from {left_m} to {right_m} {condition}, not {track.x_m}: "
                      "choose a start on the track or another correction")

def scene_of(settings: dict[str, Any]) -> Scene:
    """The scene with these settings. Raises Refused, a ValueError, for what is not allowed."""
    for name, value in settings.items():
        check(name, value)
    track = Track(**{name: settings[name] for name in settings if name in OF_THE_TRACK})
    check_pairs(track)
    scene = Scene(track, **{name: settings[name] for name in settings if name in OF_THE_FILM})
    if "m_to_px" in settings:
        return scene
    # Nobody chose a zoom: take one that shows the right wall.
    shown_m = track.right_edge_m - scene.first_m()
    return replace(scene, m_to_px=min(scene.m_to_px, (scene.width_px - 1) / shown_m))

def fault_of(word: str) -> str:
    """What is wrong with an unknown word, and what may have been meant by it."""
    name = re.split("[=:]", word)[0].lstrip("-")
    if name in SETTINGS:  # as in CR 0.7, CR = 0.7, CR:0.7 or --CR 0.7
        return f"write {name}=VALUE as one word: {name} must be {allowed_text(name)}"
    # What is meant, by what may be typed:
    hints = OTHER_NAMES | {each.lower(): each for each in [*SETTINGS, *COMMANDS, "d"]}
    hints |= {each: f"motion={each}" for each in MOTIONS}
    hints |= {each: f"correction={each}" for each in ALL_CORRECTIONS}
    # With a lower cutoff more hints are wrong: a_mps2 for grafik, as that is like gravity.
    near = difflib.get_close_matches(name.lower(), hints, n=1, cutoff=0.7)
    if not near:
        return f"unknown word {word}: -h lists all that there are"
    meant = hints[near[0]]
    if meant in SETTINGS:
        meant = f"{meant}=VALUE ({SETTINGS[meant].metadata['meaning']})"
    return f"unknown word {word}: did you mean {meant}?"

def epilog() -> str:
    """What -h shows at its end: the examples, the methods and the settings."""
    lines = ["examples (any other whole number is for a scene of your own):"]
    lines += [f"  {number:2}  {example.title}" for number, example in EXAMPLES.items()]
    lines += ["", "motions and corrections:"]
    for name, method in [*MOTIONS.items(), *CORRECTIONS.items(), ("replay", replay)]:
        first_line = str(method.__doc__).splitlines()[0]
        row = f"  {name:9} {first_line}"
        lines.append(textwrap.fill(row, 80, subsequent_indent=" " * 12))
    lines += ["", "settings: default, meaning and what is allowed"]
    for name, each in SETTINGS.items():
        row = f"  {name:20}{each.default!s:9}{each.metadata['meaning']} ({allowed_text(name)})"
        lines.append(textwrap.fill(row, 80, subsequent_indent=" " * 31))
    return "\n".join(lines)

def frames_number(text: str) -> int:
    """The N of --frames N."""
    if not re.fullmatch("[0-9]{1,9}", text) or int(text) == 0:
        raise argparse.ArgumentTypeError(
            f"N must be a whole number from 1 to 999999999, not {text}")
    return int(text)

def make_parser() -> argparse.ArgumentParser:
    """What argparse needs to know of the command line. It adds -h by itself."""
    parser = argparse.ArgumentParser(
        prog="airtrack.py", description=__doc__, epilog=epilog(),
        formatter_class=argparse.RawDescriptionHelpFormatter)  # it leaves our lines as they are
    parser.add_argument("words", nargs="*", metavar="WORD", help="see above")
    parser.add_argument("-d", dest="details", action="store_true", help="as the word d")
    parser.add_argument("--fast", action="store_true",
                        help="no waiting, no keys, no colours, no text after the tables")
    parser.add_argument("--frames", metavar="N", type=frames_number,
                        help=f"stop after N frames; without it, after {FRAMES}")
    parser.add_argument("-help", action="help", help=argparse.SUPPRESS)
    return parser

class Words(NamedTuple):
    """The words of the command line, sorted."""

    command: str  # chart or stability, or nothing for a film
    number: int  # of the example
    texts: dict[str, str]  # what was typed for each setting, by its name
    has_d: bool

    def typed(self) -> list[str]:
        """The settings as they were typed."""
        return [f"{name}={text}" for name, text in self.texts.items()]

    def changes(self) -> dict[str, Any]:
        """The values of these settings. Raises Refused."""
        return {name: value_of(name, text) for name, text in self.texts.items()}

def sorted_words(words: list[str]) -> Words:
    """Sort the words. Raises Refused for one that is wrong."""
    commands, numbers, texts, has_d = [], [], {}, False
    for word in words:
        name, _, text = word.partition("=")
        if word in COMMANDS:
            commands.append(word)
        elif re.fullmatch("-?[0-9]{1,9}", word):
            numbers.append(word)
        elif word == "d":
            has_d = True
        elif name in SETTINGS and text.strip():
            texts[name] = text.strip()
        else:
            raise Refused(fault_of(word))
    if len(commands) > 1 or len(numbers) > 1:
        found = ", ".join([*commands, *numbers])
        raise Refused(f"one command and one EXAMPLE at a time, not {found}")
    command = commands[0] if commands else ""
    number = 12 if commands else 1
    if numbers:
        number = int(numbers[0])
    return Words(command, number, texts, has_d)

def film_of(words: Words, options: argparse.Namespace) -> Film:
    """The film that was asked for. Raises Refused."""
    example = EXAMPLES.get(words.number, OWN_SCENE)
    changes = words.changes()
    as_it_is = {name: each.default for name, each in SETTINGS.items()} | example.settings
    changed = [name for name, value in changes.items() if value != as_it_is[name]]
    changes_frames = any(name in OF_THE_FRAMES for name in changed)
    changes_car = any(name in OF_THE_TRACK for name in changed)
    settings = example.settings | changes
    texts, unchanged, plus = example, None, None
    if example is not OWN_SCENE and (changes_car or changes_frames):
        # Nobody knows what happens there. So the film shows the true car.
        settings = {"show_exact_mark": True} | settings
        texts = CHANGED_FRAMES
        unchanged = scene_of(example.settings)
        if not changes_frames:  # a + is moved in the same frames as the *
            texts = CHANGED
            plus = unchanged.track
    has_details = words.has_d or options.details or example.has_details
    max_frames = FRAMES if options.frames is None else options.frames
    return Film(words.number, words.typed(), scene_of(settings), texts, unchanged, plus,
                has_details, options.fast, max_frames)

def compared_scene(words: Words, options: argparse.Namespace) -> Scene:
    """The scene of a chart or a map. Raises Refused for what these do not take."""
    changes = words.changes()
    refused = [name for name in changes if name not in COMPARED]
    if refused:
        raise Refused(f"{words.command} takes no {refused[0]}: it chooses methods and frame "
                      f"rates itself, and takes an EXAMPLE and {', '.join(COMPARED)}")
    if words.has_d or options.details or options.fast or options.frames is not None:
        raise Refused(f"{words.command} is no film: it takes no d, --fast or --frames")
    settings = EXAMPLES.get(words.number, OWN_SCENE).settings | changes
    scene = scene_of({name: settings[name] for name in COMPARED if name in settings})
    # The truth of a start beyond a wall is a start at the wall.
    track = replace(scene.track, x_m=scene.track.nearest_m(scene.track.x_m))
    return replace(scene, track=track)

def show(options: argparse.Namespace, unknown_options: list[str]) -> None:
    """Show what is asked for. Raises Refused before it shows anything."""
    words = sorted_words([*unknown_options, *options.words])
    if words.command:
        scene = compared_scene(words, options)
        COMMANDS[words.command](scene, " ".join([str(words.number), *words.typed()]))
    else:
        film(film_of(words, options))

def main(argv: list[str] | None = None) -> int:
    """Do what argv or, without it, the command line asks for. Returns the exit status."""
    parser = make_parser()
    options, unknown_options = parser.parse_known_intermixed_args(argv)
    try:
        show(options, unknown_options)
        sys.stdout.flush()
    except Refused as fault:
        parser.error(str(fault))  # this prints the text and ends the program with status 2
    except KeyboardInterrupt:
        return 130  # the status of a program that Ctrl-C has ended
    except OSError as fault:  # the output takes no more
        # Python prints what is left when it ends. From here on this goes nowhere.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        if isinstance(fault, BrokenPipeError):
            return 0  # nobody reads any more, as after | head
        print(f"airtrack.py: error: {fault}", file=sys.stderr)  # the disk is full, say
        return 2
    return 0

if __name__ == "__main__":
    sys.exit(main())
