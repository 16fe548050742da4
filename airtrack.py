#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text a frame.
So its film is a graph: position to the right, time downwards.

    python airtrack.py [EXAMPLE] [d] [NAME=VALUE ...] [--fast] [--frames N]
    python airtrack.py chart [EXAMPLE] [NAME=VALUE ...]
    python airtrack.py stability [EXAMPLE] [NAME=VALUE ...]

    EXAMPLE      the number of an example; without it 0, or 10 for the commands
    d            details after each line: position, velocity, frame rate
    NAME=VALUE   a setting that replaces the example's own
    --fast       no waiting, no keys and no colours: for a pipe or a file
    --frames N   stop after N frames; without it, after 50000
    chart        speed against accuracy: what each method costs, how wrong it is
    stability    the map: at which frame rates each method fails

README.md says what this is good for. .github/lesson.md is a lesson for a class.
"""
# What is where?
#     Sections 1, 2 and 4    the physics: how a car moves and bounces, one frame at a time.
#     Sections 3, 5 and 6    the film: what a run starts from, how a frame is drawn, the main loop.
#     Sections 7 and 8       the truth, and a law that says what a bouncing car will do.
#     Sections 9 and 10      the two experiments: what each method costs, and where it fails.
#     Sections 11 to 13      printing, checks and the command line. Nobody needs to read them.
# The file examples.py holds the numbered examples and the keys.

import argparse
import difflib
import math
import os
import re
import shutil
import sys
import textwrap
import time
from collections import deque
from contextlib import nullcontext, suppress
from dataclasses import Field, dataclass, field, fields, replace
from itertools import pairwise
from statistics import fmean
from typing import Any, NamedTuple

from examples import CTRL_C, EXAMPLES, OWN_SCENE, Example, Keys, NoKeys, taken_keys

# ==== 1. Moving =================================================================================
# Where is the car dt_s later, if there are no walls?
#
#     x_m      the position of the car in m. A larger x is further to the right.
#     v_mps    the velocity of the car in m/s. It is positive if the car moves to the right.
#     a_mps2   the acceleration of the car in m/s^2. It is the same all the time.
#     dt_s     the time step in s: how long a frame lasts.
#
# The velocity changes during the frame. Euler's methods ignore this change: they move the car at
# one velocity through the whole frame. The method forward takes the velocity at the start of the
# frame, and backward takes the velocity at its end. Both are of first order: half the dt makes
# half the error after a given time. The method exact has no error, because a is constant.
# For a constant a, backward is the same as the method that is called semi-implicit Euler.
#
# In free flight the energy of the car should not change. For each kilogram of the car this energy
# is E = v^2/2 - a x. The docstring of each method says what one step does to E.

State = tuple[float, float]  # x_m, v_mps

def forward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Forward Euler: x + v dt, then v + a dt. Each step adds a^2 dt^2/2 to E."""
    return x_m + v_mps * dt_s, v_mps + a_mps2 * dt_s

def backward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Backward Euler: v + a dt, then x + v dt. Each step takes a^2 dt^2/2 from E."""
    v_mps += a_mps2 * dt_s
    return x_m + v_mps * dt_s, v_mps

def exact(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Kinematics: x + v dt + a dt^2/2, and v + a dt. No step changes E."""
    return x_m + v_mps * dt_s + a_mps2 * dt_s * dt_s / 2, v_mps + a_mps2 * dt_s

# If you write another motion, name it here. Then film and map know it. Rewind and replay refuse it,
# and the law of the hops (section 8) needs to know what it does to E.
MOTIONS = {"forward": forward, "backward": backward, "exact": exact}

# ==== 2. Colliding ==============================================================================
# Where is the car after it has met a wall, and how fast is it?
#
#     wall_m   the position of the wall in m.
#     CR       the coefficient of restitution: the speed after a bounce / the speed before it.
#
# A collision is found when a move has ended beyond a wall. Then a correction takes the x and v
# where the move ended, and returns the x and v after the bounce. There are six corrections. Five of
# them are in this section. The overlap is x - wall: it says how far beyond the wall the move ended.
# At the left wall it is negative.
#
# Here is one collision at the left wall. The motion is exact, CR is 0.8, a is -20 m/s^2, and a
# column is 1 cm. In one frame of 0.1 s the car moves from the start to the 0, which is 8 cm beyond
# the wall. Then each correction gives the car a new place (*) and a new v. The last column is the
# energy E, if we count x from the wall: then a car that stands still at the wall has E = 0.
#
#     start              |           *       v = -1.00 m/s   2.90 J/kg
#     none       *       |                   v =  2.40 m/s   1.28 J/kg
#     surface    0       *                   v =  2.40 m/s   2.88 J/kg
#     rebound    0       |     *             v =  2.40 m/s   4.16 J/kg
#     conserve   0       |     *             v =  1.07 m/s   1.86 J/kg
#     rewind     0       |    *              v =  1.33 m/s   1.86 J/kg
#
# A bounce keeps the part CR of the speed, so it keeps CR^2 of the energy: 0.64 * 2.90 is 1.86.
# Only conserve and rewind leave the right energy. Only rewind leaves the right place, too.
#
# Two functions come first, which some of the corrections use. The five corrections themselves all
# take the same five arguments, so that step() may call any of them.

def arrival(d_m: float, u_mps: float, a_mps2: float) -> tuple[float, float]:
    """When will a car be at a wall d_m ahead of it, and how fast? Returns t_s and w_mps.

    u_mps is the velocity of the car now. Both u_mps and a_mps2 count as positive if they point
    towards the wall. At least one of them must be greater than 0.
    """
    # Energy gives the speed w at the wall: w^2 = u^2 + 2 a d. Round-off may make w^2 negative.
    w_mps = math.sqrt(max(0.0, u_mps * u_mps + 2 * a_mps2 * d_m))
    # Two formulas give the time t. If two nearly equal numbers are subtracted, little but round-off
    # is left. So take the formula in which the speeds are added.
    if u_mps > 0:
        t_s = 2 * d_m / (u_mps + w_mps)  # from the mean velocity: d = t (u + w)/2
    else:
        t_s = (w_mps - u_mps) / a_mps2  # from w = u + a t. Here u <= 0, so w - u is a sum.
    return t_s, w_mps

def side_of(x_m: float, wall_m: float) -> int:
    """On which side of the track is a car that is beyond a wall? 1 is right, -1 is left."""
    if x_m > wall_m:
        return 1
    return -1

def none(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Reverse v, but leave the car beyond the wall. It may never get out again.

    In example 3 the left wall is at 0.25 m, and CR is 0.6:
        frame 46   The move ends at 0.198 m.   v is reversed from -2.30 to  1.38 m/s.
        frame 47   The move ends at 0.243 m.   v is reversed from  1.33 to -0.80 m/s.
        frame 48   The move ends at 0.214 m.   v is reversed from -0.85 to  0.51 m/s.
    In frame 47 the car was still beyond the wall, because the bounce had slowed it. So its velocity
    was reversed again, now into the wall: the car is caught. Such a car is said to stick. The other
    corrections are there to prevent this.
    """
    return x_m, -CR * v_mps

def surface(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car on the wall.

    If a points into the wall, this lifts the car against a. That should cost speed, but surface
    takes nothing from v for it. So the car has more energy than it should: in the drawn collision
    2.88 J/kg instead of 1.86.
    """
    return wall_m, -CR * v_mps

def rebound(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car in front of the wall, CR * overlap away.

    If a is 0, this is right: in the time in which the move went beyond the wall by the overlap, the
    true car went back by CR times as much. If a points into the wall, rebound adds energy, as
    surface does. If CR * overlap is longer than the track, the car is thrown out at the other end
    (example 14).
    """
    overlap_m = x_m - wall_m
    return wall_m - CR * overlap_m, -CR * v_mps

def conserve(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car where rebound does, at the speed with which it has the right energy there.

    If this energy is too small to get there, put the car on the wall. With the exact motion only
    the moment of the bounce is wrong. The error is of second order: half the dt makes a quarter of
    it. Like rebound, conserve may throw the car out.
    """
    # Count everything positive into the wall. (The numbers are those of the drawn collision.)
    side = side_of(x_m, wall_m)
    depth_m = side * (x_m - wall_m)  # 0.08 m
    inward_mps2 = side * a_mps2  # 20 m/s^2
    # Take the car back to the wall. E does not change, so its speed w there follows from
    # w^2 = v^2 - 2 a depth. This may come out negative, by round-off or if backward has taken too
    # much energy. The bounce leaves the speed CR w.
    w_squared = max(0.0, v_mps * v_mps - 2 * inward_mps2 * depth_m)
    bounced_mps = CR * math.sqrt(w_squared)  # 1.93 m/s
    # Take the car to its new place, CR * depth in front of the wall. E does not change, so its
    # speed u there follows from u^2 = (CR w)^2 - 2 a CR depth.
    u_squared = bounced_mps * bounced_mps - 2 * inward_mps2 * CR * depth_m
    if u_squared < 0:
        return wall_m, -side * bounced_mps
    return wall_m - side * CR * depth_m, -side * math.sqrt(u_squared)  # 0.064 m away, 1.07 m/s

def rewind(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Take the car back in time to the wall, let it bounce, and move it on to the frame's end.

    With the exact motion this is right if the frame holds one bounce and the move ends beyond the
    wall (example 10). Rewind cannot settle a second bounce. If the car turns beyond the wall and is
    back on the track when the frame ends, no collision is found: a missed event (example 18).
    """
    # Count everything positive into the wall, as conserve does.
    side = side_of(x_m, wall_m)
    depth_m = side * (x_m - wall_m)  # 0.08 m
    inward_mps = side * v_mps  # 3.00 m/s
    inward_mps2 = side * a_mps2  # 20 m/s^2
    # Run the film backwards: the car comes out of the wall, at first with the speed inward_mps. In
    # reversed time v changes its sign, but a does not. So a, which points into the wall, slows the
    # car down. When is it at the surface of the wall, and how fast?
    late_s, met_mps = arrival(depth_m, inward_mps, -inward_mps2)  # 0.030 s, 2.41 m/s
    # Run it forwards again, from the surface, after the bounce, for the same time.
    new_depth_m, new_inward_mps = exact(0.0, -CR * met_mps, inward_mps2, late_s)  # -0.048, -1.33
    if new_depth_m > 0:
        new_depth_m = 0.0  # it is in the wall again, by a second bounce: put it on the wall
    return wall_m + side * new_depth_m, side * new_inward_mps

CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "conserve": conserve,
               "rewind": rewind}

# The sixth correction, replay, works out a whole frame anew: see section 7.
ALL_CORRECTIONS = [*CORRECTIONS, "replay"]
EXACT_ONLY = ["rewind", "replay"]  # they need the exact motion

# A method is a motion and a correction. Example 21 and the chart compare five methods, which have
# the letters a to e. Whoever reads nothing else should read this table. Its column energy says what
# happens to the energy of a car that hops on a wall, as a ball hops on a floor.
#
#     method                 order  energy       it fails if                    take it for
#     a  backward + rebound  1      up and down  heights or times matter;       scenery
#                                                it may hop for ever
#     b  exact + rebound     1      too much     the car should come to rest;   nothing (c is hardly
#                                                it may hop for ever            dearer)
#     c  exact + conserve    2      right        it misses a bounce             most things
#     d  exact + rewind      none   right        it misses a bounce, or         short frames
#                                                a frame holds two
#     e  exact + replay      none   right        never: dt may have any length  the truth
#
# Order 1 means that half the dt makes half the error, and order 2 that it makes a quarter. Where d
# and e do not fail, their only error is round-off, so they have no order. With a, b and c a car may
# be thrown out if CR * overlap is longer than the track. Methods b to e need a constant a.
METHODS = {"a": ("backward", "rebound"), "b": ("exact", "rebound"), "c": ("exact", "conserve"),
           "d": ("exact", "rewind"), "e": ("exact", "replay")}

# ==== 3. The scene ==============================================================================
# What does a run start from?

def a_number(default: float, unit: str, least: float, largest: float, meaning: str) -> Any:
    """A setting that is a number, with its unit and its range.

    The metadata of a field is a dictionary that dataclasses keep for us and do not use. Here the
    command line finds in it what is allowed, so that this is said only once.
    """
    metadata = {"unit": unit, "least": least, "largest": largest, "meaning": meaning}
    return field(default=default, metadata=metadata)

def a_choice(default: Any, choices: list[Any], meaning: str) -> Any:
    """A setting that is one of several choices."""
    return field(default=default, metadata={"choices": choices, "meaning": meaning})

YES_OR_NO = [False, True]

@dataclass(frozen=True)  # frozen: no run can change its scene. replace() makes a changed copy.
class Scene:
    """The settings of a run. The unit is part of a name: x_m is in m.

    Raises ValueError if a setting is out of its range, or if two settings exclude each other.
    """

    x_m: float = a_number(1.1, "m", -1000, 1000, "position at the start")
    v_mps: float = a_number(0.0, "m/s", -1000, 1000, "velocity at the start: speed to the right")
    a_mps2: float = a_number(
        0.0, "m/s^2", -1000, 1000, "acceleration, gravity g: positive to the right")
    left_edge_m: float = a_number(0.25, "m", -1000, 1000, "position of the left wall")
    right_edge_m: float = a_number(2.2, "m", -1000, 1000, "position of the right wall")
    CR: float = a_number(0.8, "", 0, 1, "coefficient of restitution: speed after / before a bounce")
    motion: str = a_choice("backward", list(MOTIONS), "how the car is moved")
    correction: str = a_choice("rebound", ALL_CORRECTIONS, "how a collision is settled")
    fps_target: float = a_number(30.0, "1/s", 0.1, 1000, "frames a second; dt is 1/fps_target")
    use_observed_dt: bool = a_choice(False, YES_OR_NO, "dt is how long the frame before lasted")
    jitter: float = a_number(0.0, "", 0, 0.9, "frames are longer or shorter by up to this fraction")
    auto_off: bool = a_choice(True, YES_OR_NO, "stop when the car is at rest at a wall")
    m_to_px: float = a_number(55.0, "px/m", 0.001, 1000, "zoom: columns for each metre")
    width_px: int = a_number(135, "px", 10, 1000, "columns of the picture, which begins at x = 0")
    show_start_mark: bool = a_choice(False, YES_OR_NO, "draw a . where the car started")
    show_collision_mark: bool = a_choice(
        True, YES_OR_NO, "draw a 0 where the move alone ended, in a collision")
    show_exact_mark: bool = a_choice(False, YES_OR_NO, "draw an o where the car truly is")
    show_methods: bool = a_choice(False, YES_OR_NO, "draw a to e where five methods have the car")

    def __post_init__(self) -> None:
        """Refuse a scene that is not allowed. Python calls this when a scene is made."""
        check(self)  # see section 12

    def wall_passed(self, x_m: float) -> float | None:
        """The position of the wall that x_m is beyond, or None if x_m is on the track."""
        if x_m < self.left_edge_m:
            return self.left_edge_m
        if x_m > self.right_edge_m:
            return self.right_edge_m
        return None

    def to_track(self, x_m: float) -> float:
        """The place on the track that is nearest to x_m."""
        wall_m = self.wall_passed(x_m)
        if wall_m is None:
            return x_m
        return wall_m

# ==== 4. A frame ================================================================================
# How does the car get from one frame to the next?

def step(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, float | None]:
    """Move the car by a frame of dt_s, and settle a collision. Returns x_m, v_mps and mark_m.

    mark_m is None or, in a collision, where the move alone ended. The film draws a 0 there.
    """
    # Move the car as if there were no walls.
    move = MOTIONS[scene.motion]
    free_m, free_mps = move(x_m, v_mps, scene.a_mps2, dt_s)
    wall_m = scene.wall_passed(free_m)
    # Replay works out the whole frame anew. It is also asked if v has changed its sign, because
    # then the car may have met a wall, turned beyond it and come back.
    may_have_met_wall = wall_m is not None or v_mps * free_mps < 0
    if scene.correction == "replay" and may_have_met_wall:
        x_m, v_mps, has_bounced = replay(scene, x_m, v_mps, dt_s)
        if has_bounced:
            return x_m, v_mps, free_m
        return x_m, v_mps, None
    # The move ended on the track: there is nothing to settle.
    if wall_m is None:
        return free_m, free_mps, None
    # The move ended beyond a wall: settle the collision.
    correction = CORRECTIONS[scene.correction]
    x_m, v_mps = correction(free_m, free_mps, wall_m, scene.a_mps2, scene.CR)
    return x_m, v_mps, free_m

# ==== 5. Drawing ================================================================================
# How does a frame become a line of text?

def paint(line: list[str], mark: str, x_px: float) -> None:
    """Put the mark into its column, over what is there, if the line has that column."""
    column = round(x_px)
    if 0 <= column < len(line):
        line[column] = mark

def render_track(scene: Scene, x_m: float, mark_m: float | None, others: dict[str, State]) -> str:
    """Draw a frame: one line of scene.width_px columns. others has the other cars by their marks.

    The line is painted from back to front: what is painted later covers what was there.
    """
    line = [" "] * scene.width_px
    zoom = scene.m_to_px
    if scene.show_collision_mark and mark_m is not None:
        paint(line, "0", mark_m * zoom)
    if scene.show_start_mark:
        paint(line, ".", scene.x_m * zoom)
    paint(line, "|", scene.left_edge_m * zoom)
    paint(line, "|", scene.right_edge_m * zoom)
    for mark, (other_m, _) in others.items():
        paint(line, mark, other_m * zoom)
    # The car comes last, so that nothing hides it. Outside the picture it is < or >, at the edge.
    column = round(x_m * zoom)
    if column < 0:
        line[0] = "<"
    elif column >= scene.width_px:
        line[-1] = ">"
    else:
        line[column] = "*"
    return "".join(line)

# A terminal changes its colour where it reads "\033[" and a number and "m". 0 ends the colour.
COLOURED_MARKS = str.maketrans({
    "*": "\033[33m*\033[0m",  # yellow
    "o": "\033[32mo\033[0m",  # green
    "0": "\033[31m0\033[0m",  # red
})

def details_text(x_m: float, v_mps: float, fps: float, truth: State | None) -> str:
    """What d adds to a line: position, velocity, frame rate and, given the truth, the error."""
    text = f"x = {x_m:6.2f}, v = {v_mps:5.2f}, FPS = {fps:3.0f}"
    if truth is None:
        return text
    true_m, _ = truth
    return f"{text}, err = {x_m - true_m:9.2e}"

# ==== 6. The run ================================================================================
# How do the frames become a film that runs at the right speed?
# The main loop is run(), at the end of this section.

def planned_length(scene: Scene, frame: int) -> float:
    """How long this frame should last, in s. With jitter, frames are irregular in a fixed way."""
    # The multiples of 0.618 (the golden ratio - 1) without their whole parts are spread evenly
    # over the numbers from 0 to 1.
    from_0_to_1 = (0.618 * frame) % 1
    from_minus_1_to_1 = 2 * from_0_to_1 - 1
    return (1 + scene.jitter * from_minus_1_to_1) / scene.fps_target

STALL_S = 0.15  # a delay that everybody sees: people begin to notice one at about 0.1 s

class Pace:
    """The pace of a film: when is the next frame due, and how long did it take to come?"""

    def __init__(self, scene: Scene, keys: Keys | NoKeys) -> None:
        self.scene = scene
        self.keys = keys
        self.shown_s = time.perf_counter() - planned_length(scene, 1)  # so that frame 1 is due now
        self.due_s = self.shown_s

    def wait(self, frames: int, t_s: float) -> tuple[float, float]:
        """Wait until the next frame is due. frames and t_s say how far the film is.

        Returns how long the last frame lasted, in s, and the frame rate. The frames are due at
        planned moments. If each frame slept for dt instead, it would last longer than dt, because
        computing and printing take time, too.
        """
        planned_s = planned_length(self.scene, frames + 1)
        self.due_s += planned_s
        is_on_time = self.keys.wait_until(self.due_s, frames, t_s)  # False after a pause
        now_s = time.perf_counter()
        lasted_s = now_s - self.shown_s
        self.shown_s = now_s
        if not is_on_time:
            self.due_s = now_s
            return planned_s, self.scene.fps_target
        # If the film is far behind its plan, the plan begins anew from now. Otherwise the film
        # would race to catch up.
        if now_s > self.due_s + STALL_S:
            self.due_s = now_s
        # A frame that lasted far too long counts as long as planned. Otherwise the car would leap.
        fps = 1 / max(lasted_s, 1e-6)  # the clock may not have ticked in between
        if lasted_s > planned_s + STALL_S:
            return planned_s, fps
        return lasted_s, fps

def truth_of(scene: Scene) -> Scene:
    """The same scene, solved exactly. A start beyond a wall is moved to the wall."""
    return replace(scene, motion="exact", correction="replay", x_m=scene.to_track(scene.x_m))

def scenes_beside(scene: Scene) -> dict[str, Scene]:
    """The scenes of the other cars in the film, by their marks, from back to front."""
    truth = truth_of(scene)
    scenes = {}
    if scene.show_methods:
        for letter, (motion, correction) in METHODS.items():
            scenes[letter] = replace(truth, motion=motion, correction=correction)
    if scene.show_exact_mark:
        scenes["o"] = truth
    return scenes

REST_M = 0.001  # 1 mm: less than a column, even in example 22

class Rest:
    """Is the car at rest at a wall? Its last frames decide.

    They last 1/3 s, which is enough to see that the car does not move. But at a low rate 1/3 s is
    only a few frames, and for so long a car in flight may be near a wall, too. So they are never
    fewer than ten.
    """

    def __init__(self, scene: Scene) -> None:
        self.frames = max(10, round(scene.fps_target / 3))
        self.last_m: deque[float] = deque(maxlen=self.frames)  # it forgets the oldest by itself
        # How fast the acceleration makes a car in these frames:
        self.slow_mps = abs(scene.a_mps2) * self.frames / scene.fps_target
        # The car can rest at the wall to which it is accelerated or, without a, at any wall.
        self.walls_m = []
        if scene.a_mps2 <= 0:
            self.walls_m.append(scene.left_edge_m)
        if scene.a_mps2 >= 0:
            self.walls_m.append(scene.right_edge_m)

    def is_reached(self, x_m: float, v_mps: float) -> bool:
        """Whether the car is at rest. x_m and v_mps are its state after the newest frame.

        Some methods never leave the car quite still. So it is enough that its mean distance from
        the wall is small, and that it is no faster than a would make it in these frames.
        """
        self.last_m.append(x_m)
        if len(self.last_m) < self.frames or abs(v_mps) > self.slow_mps:
            return False
        for wall_m in self.walls_m:
            if abs(x_m - wall_m) > REST_M * self.frames:
                continue  # this distance alone makes the mean too large
            distances_m = [abs(last_m - wall_m) for last_m in self.last_m]
            if sum(distances_m) / self.frames <= REST_M:
                return True
        return False

class Shown(NamedTuple):
    """What a film has shown."""

    frames: int
    collisions: list[int]  # the frames in which a collision was found
    is_resting: bool  # whether the car was at rest in the last frame

def run(scene: Scene, has_details: bool, max_frames: int, keys: Keys | NoKeys) -> Shown:
    """Show the film until a key, the car at rest or max_frames ends it, and say which it was."""
    x_m, v_mps = scene.x_m, scene.v_mps
    other_scenes = scenes_beside(scene)
    others = {mark: (other.x_m, other.v_mps) for mark, other in other_scenes.items()}
    frame, t_s = 0, 0.0
    collisions: list[int] = []
    rest = Rest(scene)
    is_resting = False
    pace = Pace(scene, keys)
    try:
        while frame < max_frames and not (is_resting and scene.auto_off):
            # Wait until the next frame is due.
            length_s, fps = pace.wait(frame, t_s)
            if keys.why_quit:
                break
            # Move the car and settle its collision. Then do the same for the other cars.
            dt_s = length_s if scene.use_observed_dt else 1 / scene.fps_target
            x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
            for mark, other_scene in other_scenes.items():
                other_m, other_mps = others[mark]
                other_m, other_mps, _ = step(other_scene, other_m, other_mps, dt_s)
                others[mark] = other_m, other_mps
            # Keep what is to be told when the film is over.
            frame += 1
            t_s += dt_s
            if mark_m is not None:
                collisions.append(frame)
            is_resting = rest.is_reached(x_m, v_mps)
            # Draw the frame.
            line = render_track(scene, x_m, mark_m, others)
            if keys.has_colours:
                line = line.translate(COLOURED_MARKS)
            if has_details:
                line += details_text(x_m, v_mps, fps, others.get("o"))
            print(line)
    except KeyboardInterrupt:
        keys.press(CTRL_C)
    if keys.why_quit:
        why = keys.why_quit
    elif is_resting and scene.auto_off:
        why = "the car is at rest at a wall"
    else:
        why = "that is the frame limit"
    print(f"Stopped after {frame} frames, t = {t_s:.2f} s: {why}.", flush=True)
    return Shown(frame, collisions, is_resting)

# ==== 7. The truth ==============================================================================
# What would the car really do?
#
# The correction replay knows it, for a frame of any length: one step() of 20 s with motion=exact
# and correction=replay is where the car truly is after 20 s. The film's o, the chart and the map
# rely on this. So the tests compare it with a reference that is worked out with 60 digits.
#
# Think of a ball in a room. The wall to which the car is accelerated is the floor, and the other
# wall is the ceiling. h is the height of the ball above the floor. The ball flies from bounce to
# bounce, and arrival() says when each flight ends.
#
# At CR < 1 each hop on the floor lasts CR times as long as the hop before. So infinitely many hops
# take a finite time: if the first hop lasts T, all of them last T (1 + CR + CR^2 + ...), and this
# sum is T/(1 - CR). The moment at which they end is called the Zeno point. From then on the ball
# is at rest. Nobody can follow infinitely many hops one by one, so a ball that would rise less
# than GRAZE_M is at rest here. The heights of the hops shrink so fast that a few hundred of them
# are enough, as a rule.

GRAZE_M = 5e-11  # far more than the round-off of a position, and less than an atom's width

def next_bounce(h_m: float, rise_mps: float, g_mps2: float,
                room_m: float) -> tuple[str, float, float]:
    """Which wall does the ball meet next, after how many s, and at how many m/s?

    h_m is the height of the ball, and rise_mps is its velocity, upwards.
    """
    # To get so high takes the energy g * height. A ball may touch the ceiling at almost no speed,
    # and then round-off would decide whether it does. So a ball that would turn less than GRAZE_M
    # beyond the ceiling does not meet it.
    energy_to_ceiling = g_mps2 * (room_m - h_m + GRAZE_M)
    if rise_mps > 0 and rise_mps * rise_mps / 2 >= energy_to_ceiling:
        flight_s, speed_mps = arrival(room_m - h_m, rise_mps, -g_mps2)
        return "ceiling", flight_s, speed_mps
    flight_s, speed_mps = arrival(h_m, -rise_mps, g_mps2)
    return "floor", flight_s, speed_mps

def replay(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, bool]:
    """Follow the exact motion for dt_s, from bounce to bounce. Returns x_m, v_mps, has_bounced."""
    if scene.a_mps2 > 0:
        up, floor_m = -1, scene.right_edge_m  # upwards is to the left
    else:
        up, floor_m = 1, scene.left_edge_m  # upwards is to the right
    room_m = scene.right_edge_m - scene.left_edge_m
    g_mps2 = abs(scene.a_mps2)
    h_m = up * (scene.to_track(x_m) - floor_m)
    rise_mps = up * v_mps
    left_s = dt_s  # the time that is left until the frame ends
    last_wall = ""  # where it bounced last in this frame
    while rise_mps != 0 or g_mps2 != 0:  # otherwise nothing moves the ball
        wall, flight_s, speed_mps = next_bounce(h_m, rise_mps, g_mps2, room_m)
        if scene.CR == 1 and wall == "floor" and last_wall == "floor":
            # From now on all hops last equally long. Leave out those that fit in as a whole. Then
            # less time is left than a hop lasts.
            left_s %= flight_s
        if flight_s > left_s:
            break  # the frame ends before the ball gets there
        left_s -= flight_s
        last_wall = wall
        if wall == "ceiling":
            h_m, rise_mps = room_m, -scene.CR * speed_mps
        else:
            h_m, rise_mps = 0.0, scene.CR * speed_mps
            if rise_mps * rise_mps / 2 <= g_mps2 * GRAZE_M:
                return floor_m, 0.0, True  # at rest, as it cannot rise by GRAZE_M
    h_m, rise_mps = exact(h_m, rise_mps, -g_mps2, left_s)
    x_m = scene.to_track(floor_m + up * h_m)  # round-off must not leave it beyond a wall
    return x_m, up * rise_mps, last_wall != ""

# ==== 8. The law of the hops ====================================================================
# Why do some cars hop for ever, and others lie still too soon?
# There is no code here. Every line can be checked with pen and paper.
#
# A car hops on the wall to which it is accelerated. Think of this wall as a floor: up is away from
# it, and g is the size of a. The car does not meet the other wall, and all frames last dt. Count
# each hop in lines of the film: from a line in which a collision is found to the next such line.
#
#     hop     how many lines the hop has.
#     u       the first speed of the hop, upwards. The car has it where the correction put it (*).
#     w       the last speed of the hop, downwards. The car has it where the last move ended (0).
#     drop    how much lower the hop ends (its last 0) than it begins (its first *), in m.
#     motion  the number of the motion: forward 1, exact 0, backward -1.
#
# Here is a hop with exact + rebound. CR is 0.8, g is 2 m/s^2, dt is 0.1 s, a column is 1 cm.
#     0:   0    |   *                    v =  0.80    The hop begins 4 cm above the floor (*):
#     1:        |          *             v =  0.60    u = 0.80 m/s.
#     2:        |               *        v =  0.40
#     3:        |                  *     v =  0.20
#     4:        |                   *    v =  0.00    In each frame the car gets g dt downwards:
#     5:        |                  *     v = -0.20    0.20 m/s.
#     6:        |               *        v = -0.40
#     7:        |          *             v = -0.60
#     8:        |   *                    v = -0.80    The last move ends 5 cm below the floor (0):
#     9:   0    |   *                    v =  0.80    w = 1.00 m/s. Then comes the bounce.
# The hop has 9 lines, 1 to 9, and its drop is 4 + 5 = 9 cm. To see it, type  python airtrack.py 99
# d and then, in the same line,
#     x_m=0.29 v_mps=0.8 a_mps2=-2 CR=0.8 motion=exact fps_target=10 m_to_px=100 width_px=50
#
# (1) Each frame of a hop adds g dt downwards. So from u upwards to w downwards,
#         u + w = hop g dt                                in the drawn hop: 0.8 + 1.0 = 9 * 0.2
# (2) How much larger is w than u? With the exact motion E does not change in flight, so w^2/2 is
#     larger than u^2/2 by g drop. Forward and backward change E, too: in each frame by motion times
#     g^2 dt^2/2 (section 1). So
#         (w^2 - u^2)/2 = g drop + motion hop g^2 dt^2/2
#     The left side is (w - u) times (w + u)/2, and by (1) that is (w - u) hop g dt/2. Divide both
#     sides by hop g dt/2:
#         w - u = 2 drop/(hop dt) + motion g dt
#     We want to compare both parts. So let way = hop g dt^2/2. Then 2 drop/(hop dt) is
#     (drop/way) g dt, and
#         w - u = k g dt    with    k = motion + drop/way
#     In the drawn hop way is 9 * 2 * 0.1^2/2 = 0.09 m = 9 cm. So k is 0 + 9/9 = 1.
# (3) By (1) and (2), w is (hop + k) g dt/2 and u is (hop - k) g dt/2. With none, surface and
#     rebound the u of the next hop is CR w. The next hop has a k of its own: call it k'. So
#     (next - k') g dt/2 is CR (hop + k) g dt/2, and
#         next = CR (hop + k) + k'                        in the drawn hop: 0.8 (9 + 1) + 1 = 9
# This is the law. No step was approximate. So with none, surface and rebound it holds in every hop.
# Here is another hop. Example 20 is exact + rebound, too. Its first hop has 14 lines, a drop of
# 11.2 cm and a way of 14 cm, so k is 0.8. Its second hop has a drop of 1.92 cm and a way of 12 cm,
# so k' is 0.16. The law says 0.8 (14 + 0.8) + 0.16 = 12.0 lines for the second hop, and it has 12.
#
# We can only foretell a hop if we know its drop. What is the average drop? A collision is found
# at the end of a frame. On average the car met the floor half a frame before, so a hop ends w dt/2
# below the floor. By (1), way is (u + w) dt/2. Let the hop be long, so that u and w differ little.
#     surface    The hop begins on the floor. So the drop is w dt/2 on average, which is half a way.
#     rebound    Let W be the w of the hop before. That hop ended W dt/2 below the floor. So this
#                hop begins CR W dt/2 above the floor. As CR W is u, this is u dt/2. So the drop is
#                u dt/2 + w dt/2 on average, which is one way.
#     none       At CR = 1 the hop begins as deep as the hop before ended. So the drop is 0, on
#                average.
#     conserve   Here the next u is not CR w, because this correction also takes from v what the
#                lift costs. But it is so for the speeds at the floor. So let u and w be the speeds
#                when the car leaves the floor and when it is back. Between these two moments there
#                is no drop, and on average they are hop frames apart.
# Rewind and replay have no k: if they are right, so are their hops. So the average k is
#                   none at CR = 1   surface   rebound   conserve (at the floor)
#     forward              1          1 1/2       2          1
#     exact                0            1/2       1          0
#     backward            -1           -1/2       0         -1
#
# What does it mean? All this is an average: the start decides how late each collision is found.
#     k > 0    The car gets too much energy. At CR = 1 it hops higher and higher: each hop is 2 k
#              lines longer than the hop before. At CR < 1 its hops should die out. But there is a
#              length for which the law says next = hop: k (1 + CR)/(1 - CR). If that is two lines
#              or more, the hops end near it. (Hops of one line are rest.)
#     k < 0    The car gets too little energy. At CR = 1 it should hop for ever, but it comes to
#              rest (with none it is caught).
#     k = 0    The energy is right on average.
# For example, with exact + surface at CR = 1 a hop of 60 lines is followed by 61, then by 62 lines.
# With exact + rebound at CR = 0.8 hops end near 1 * 1.8/0.2 = 9 lines.
#
# Three remarks for the curious.
# - A hop that repeats for ever has the same drop each time, and this may be another drop than the
#   average one. By (3), its k is hop (1 - CR)/(1 + CR). How large may k be? Before its last move
#   the car was not below the floor. So its last 0 is at most one move deep. That makes k at most 1
#   with exact + surface and backward + rebound, and less than 2 with exact + rebound. So backward +
#   rebound may hop for ever, too.
# - A ball that is dropped from rest may be back on the floor exactly at the end of a frame, and
#   round-off may find each collision a whole frame late. Then with surface at CR = 1 the drop is
#   one way: backward + surface has k = 0 and repeats one hop for ever. Forward + surface has k = 2.
# - Many programs set a small speed to 0, so that things lie still. By (2), a hop that repeats ends
#   with w = k g dt/(1 - CR), and with forward + surface k is at most 2. So with this method it is
#   enough to set v to 0 in a bounce with a w of at most 2 g dt/(1 - CR). Do not do it at CR = 1.

# ==== 9. The chart: speed against accuracy ======================================================
# What does each method cost, and how wrong is it?

SPAN_S = 20  # of simulated time: about eight bounces in example 10, enough for errors to grow
CUTS = 10  # runs of each method: with fewer, the largest error would depend on luck
CHART_FPS = [10, 30, 60, 120, 240, 480, 960, 1920, 3840]

class Sample(NamedTuple):
    """A car and the true car at the same moment."""

    x_m: float
    v_mps: float
    true_m: float
    true_mps: float

def simulate(scene: Scene, fps: int, cut: int) -> list[Sample]:
    """Run for SPAN_S. Take a sample every 0.1 s or, if frames are longer, every frame.

    It is luck at which moment of a frame the car meets a wall. So there are ten cuts of the same
    motion into frames. Cut 0 begins at the start of the scene. Each other cut begins a part of a
    frame later, at the true state of that moment.
    """
    dt_s = 1 / fps
    truth = truth_of(scene)
    part = 0.0
    if cut > 0:
        # 1/27, 4/27, ... 25/27: they are evenly spread, and none is at the edge of a frame, where
        # it would be cut 0 again.
        part = (3 * cut - 2) / 27
    true_m, true_mps, _ = step(truth, truth.x_m, truth.v_mps, part * dt_s)
    x_m, v_mps = true_m, true_mps
    frames_a_sample = max(1, fps // 10)
    samples = []
    for _ in range(SPAN_S * fps // frames_a_sample):
        for _ in range(frames_a_sample):
            x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
        # One step of any length gives the truth. So the true car takes a single, longer step.
        true_m, true_mps, _ = step(truth, true_m, true_mps, frames_a_sample * dt_s)
        samples.append(Sample(x_m, v_mps, true_m, true_mps))
    return samples

def largest_error_m(scene: Scene, fps: int) -> float:
    """The largest distance from the true car in all samples of all cuts."""
    largest_m = 0.0
    for cut in range(CUTS):
        for sample in simulate(scene, fps, cut):
            largest_m = max(largest_m, abs(sample.x_m - sample.true_m))
    return largest_m

def cost_us(scene: Scene, fps: int) -> float:
    """The processor time that a simulated second takes, in microseconds. Only steps count.

    Other programs may slow this one, and nothing can speed it up. So the least of several runs is
    nearest to the time that the processor needs.
    """
    dt_s = 1 / fps
    costs_s = []
    for _ in range(max(5, 200 // fps)):
        x_m, v_mps = scene.x_m, scene.v_mps
        began_s = time.perf_counter()
        for _ in range(SPAN_S * fps):
            x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
        costs_s.append(time.perf_counter() - began_s)
    return 1e6 * min(costs_s) / SPAN_S

class Point(NamedTuple):
    """One method at one frame rate: a point of the chart."""

    fps: int
    error_m: float
    cost_us: float

def measure(scene: Scene) -> dict[str, list[Point]]:
    """Measure every method at every rate, and print the table row by row."""
    motions = "".join([f"{letter}: {METHODS[letter][0]}".rjust(15) for letter in METHODS])
    corrections = "".join([f"+ {correction}".rjust(15) for _, correction in METHODS.values()])
    print()
    print("    " + motions)
    print("    " + corrections)
    print(" FPS" + "  error m    us" * len(METHODS))
    points: dict[str, list[Point]] = {letter: [] for letter in METHODS}
    for fps in CHART_FPS:
        row = f"{fps:4}"
        for letter, (motion, correction) in METHODS.items():
            method = replace(scene, motion=motion, correction=correction)
            point = Point(fps, largest_error_m(method, fps), cost_us(method, fps))
            points[letter].append(point)
            row += f"{point.error_m:9.1e}{point.cost_us:6.0f}"
        print(row, flush=True)
    orders = "".join([order_text(series).rjust(7) + " " * 8 for series in points.values()])
    print("order" + orders.rstrip())
    print()
    return points

def order_text(series: list[Point]) -> str:
    """The order of a method, from the last three doublings of the rate.

    At order 1 twice the rate divides the error by 2, at order 2 by 4.
    """
    last_m = series[-1].error_m
    if last_m < 1e-9:  # this is round-off, which has no order
        return "none"
    doublings = math.log2(series[-4].error_m / last_m)
    return f"{doublings / 3:.1f}"

COLUMNS_A_DECADE, ROWS_A_DECADE = 8, 4  # a decade is from one power of ten to the next
LEAST_ERROR_M, LARGEST_ERROR_M = 1e-6, 10.0  # other errors are drawn at the edge of the picture

def error_column(error_m: float) -> int:
    """The column of an error in the picture."""
    error_m = max(error_m, LEAST_ERROR_M)
    error_m = min(error_m, LARGEST_ERROR_M)
    return round(COLUMNS_A_DECADE * math.log10(error_m / LEAST_ERROR_M))

def picture(points: dict[str, list[Point]], pixel_m: float) -> None:
    """Draw the points as the film is drawn: error to the right, processor time downwards."""
    lines: dict[int, list[str]] = {}
    for letter, series in points.items():
        for point in series:
            row = round(ROWS_A_DECADE * math.log10(point.cost_us))
            if row not in lines:
                lines[row] = [" "] * (error_column(LARGEST_ERROR_M) + 1)
            column = error_column(point.error_m)
            if lines[row][column] in (" ", letter):
                paint(lines[row], letter, column)
            else:
                paint(lines[row], "+", column)  # here stands another letter
    pixel_column = error_column(pixel_m)
    print("one drawn pixel |".rjust(10 + pixel_column + 1))
    print("    us    <=1 um  10 um   0.1 mm  1 mm    1 cm    0.1 m   1 m     >=10 m")
    for row in range(min(lines), max(lines) + 1):
        line = lines.get(row, [" "] * (pixel_column + 1))
        if line[pixel_column] == " ":
            paint(line, "|", pixel_column)
        row_us = 10 ** (row / ROWS_A_DECADE)
        print(f"{row_us:6.0f}    {''.join(line).rstrip()}")
    print()

def conclude(points: dict[str, list[Point]], pixel_m: float) -> None:
    """Answer the question: which methods stay within a pixel, and what do they cost?"""
    answers = []
    for letter, series in points.items():
        answer = (math.inf, f"{letter} at none of these rates")
        for fps, error_m, us in reversed(series):
            if error_m > pixel_m:
                break  # no lower rate counts
            answer = (us, f"{letter} from {fps} FPS on, for {us:.0f} us")
        answers.append(answer)
    answers.sort()  # by the cost, which stands first
    texts = [text for _, text in answers]
    say(f"Within a drawn pixel, {pixel_m:.2g} m, in all ten runs, the cheapest first: "
        f"{'; '.join(texts)}.")

def chart(scene: Scene, title: str) -> None:
    """Measure, print the table, draw the picture and answer the question."""
    pixel_m = 1 / scene.m_to_px
    say(f"Speed against accuracy: {title}")
    say("Which method is the cheapest that stays within a drawn pixel of the truth? Each method "
        "runs ten times for 20 simulated seconds. Error: the largest distance from the true car in "
        "these runs, looked at every 0.1 s. Cost: processor time for a simulated second in us "
        "(microseconds). Order: 1 if half the dt makes half the error, 2 if it makes a quarter. "
        "Method e is the truth's own method, so its error can be nothing but round-off.")
    points = measure(scene)
    picture(points, pixel_m)
    say("Error to the right, cost downwards: the best are in the upper left. Where letters meet "
        "there is a +.")
    conclude(points, pixel_m)

# ==== 10. The map: where methods fail ===========================================================
# Which method fails at which frame rate, and how?

MAP_FPS = [1, 2, 5, 10, 30, 60, 120, 240, 1000]
VERDICTS = {  # from the worst to the best
    "X": "out: further beyond a wall than the track is long",
    "S": "stuck: beyond the same wall all through the last 5 s",
    "W": "in some runs as G, in others as L",
    "G": "too much energy, by over 1 % on average over the last 5 s",
    "L": "too little energy, by over 1 % on average over the last 5 s",
    "P": "the energy is right, but the car is over a drawn pixel off",
    "-": "within a drawn pixel of the truth",
}
FROM_WORST_TO_BEST = list(VERDICTS)

def verdict(scene: Scene, fps: int, cut: int) -> str:
    """The letter of one run: the first of X, S, -, G, L and P that fits. W needs several runs."""
    samples = simulate(scene, fps, cut)
    last_samples = samples[len(samples) * 3 // 4:]  # those of the last 5 of 20 s
    track_m = scene.right_edge_m - scene.left_edge_m
    # X: how far beyond a wall was the car?
    beyond_m = [abs(sample.x_m - scene.to_track(sample.x_m)) for sample in samples]
    if max(beyond_m) > track_m:
        return "X"
    # S: which walls was it beyond in the last 5 s? (None stands for the track.)
    walls = {scene.wall_passed(sample.x_m) for sample in last_samples}
    if len(walls) == 1 and None not in walls:
        return "S"
    # -: how far from the true car was it?
    errors_m = [abs(sample.x_m - sample.true_m) for sample in samples]
    if max(errors_m) <= 1 / scene.m_to_px:
        return "-"
    # G or L: how much more energy than the true car had it? 100 % is its energy at the start, and
    # what a could add on the whole length of the track.
    all_energy = scene.v_mps**2 / 2 + abs(scene.a_mps2) * track_m
    gain = fmean([energy_gain(scene, sample) for sample in last_samples])
    if gain > 0.01 * all_energy:
        return "G"
    if gain < -0.01 * all_energy:
        return "L"
    return "P"

def energy_gain(scene: Scene, sample: Sample) -> float:
    """How much more energy the car has than the true car: the difference of v^2/2 - a x."""
    energy = sample.v_mps**2 / 2 - scene.a_mps2 * sample.x_m
    true_energy = sample.true_mps**2 / 2 - scene.a_mps2 * sample.true_m
    return energy - true_energy

def cell(letters: list[str]) -> str:
    """One letter for ten runs: the worst, as a small letter if only some runs are so bad."""
    worst = min(letters, key=FROM_WORST_TO_BEST.index)
    if worst == "G" and "L" in letters:
        return "W"
    if letters.count(worst) < len(letters):
        return worst.lower()
    return worst

def stability(scene: Scene, title: str) -> None:
    """Print the map: a row for each method, a column for each rate, a letter for ten runs."""
    say(f"Stability: {title}")
    say("Which methods are right, and from which frame rate on? Each runs ten times for 20 "
        "simulated seconds. 100 % of the energy is v^2/2 at the start + |a| * length of the track.")
    rates = "".join([str(fps).rjust(6) for fps in MAP_FPS])
    print()
    print(" " * 20 + rates + " FPS")
    for motion in MOTIONS:
        for correction in ALL_CORRECTIONS:
            if correction in EXACT_ONLY and motion != "exact":
                continue
            method = replace(scene, motion=motion, correction=correction)
            row = f"{motion} + {correction}".ljust(20)
            for fps in MAP_FPS:
                letters = [verdict(method, fps, cut) for cut in range(CUTS)]
                row += cell(letters).rjust(6)
            print(row, flush=True)
    for letter, meaning in VERDICTS.items():
        print(f"{letter}  {meaning}")
    print("A small letter: only some of the ten runs are so bad.")

# The lesson ends here.

# ==== 11. Printing ==============================================================================
# What is said before and after a film?

PYTHON = os.path.basename(sys.executable).removesuffix(".exe")  # python3 where there is no python

def say(text: str) -> None:
    """Print a paragraph, as wide as the terminal but no wider than is good to read."""
    width = min(100, shutil.get_terminal_size().columns)
    print(textwrap.fill(text, width), flush=True)

def start_text(scene: Scene) -> str:
    """Car and track, by the names that one may type. (A number may have ten digits.)"""
    return (f"x_m={scene.x_m:.10g} v_mps={scene.v_mps:.10g} a_mps2={scene.a_mps2:.10g} "
            f"CR={scene.CR:.10g}, walls at {scene.left_edge_m:.10g} and "
            f"{scene.right_edge_m:.10g} m")

def scene_text(scene: Scene) -> str:
    """The whole scene but for its drawing: two scenes with the same text move alike."""
    text = (f"{start_text(scene)}; {scene.motion} + {scene.correction}, "
            f"{scene.fps_target:.10g} FPS")
    if scene.jitter:
        text += f", jitter={scene.jitter:.10g}"
    if scene.use_observed_dt:
        text += ", use_observed_dt=True"
    if scene.show_methods:
        for letter, (motion, correction) in METHODS.items():
            text += f"; {letter}: {motion} + {correction}"
    return text

def fitted(scene: Scene, has_details: bool) -> Scene:
    """The scene, drawn smaller if its lines are wider than the terminal."""
    columns = shutil.get_terminal_size().columns
    if has_details:
        truth = (0.0, 0.0) if scene.show_exact_mark else None
        columns -= len(details_text(-9999.99, -9999.99, scene.fps_target, truth))
    columns = max(columns, 10)  # the least that a scene may have
    if columns >= scene.width_px or not sys.stdout.isatty():
        return scene
    # What was in the last column must stay in the last column. The first column has number 0.
    m_to_px = scene.m_to_px * (columns - 1) / (scene.width_px - 1)
    return replace(scene, width_px=columns, m_to_px=max(m_to_px, 0.001))

def hops_text(collisions: list[int]) -> str:
    """How long the hops of the * were: the first four and the last two, if there are more."""
    hops = [str(after - before) for before, after in pairwise(collisions)]
    if len(hops) > 6:
        hops = [*hops[:4], "...", *hops[-2:]]
    hops_in_words = " ".join(hops)
    return f"The hops of the *, in lines from collision to collision: {hops_in_words}."

def advice(scene: Scene, shown: Shown) -> str:
    """What may be said of a scene of the user's own, after its film."""
    text = "In hops of 1 line the car lies on a wall, or is caught beyond it."
    is_cured = scene.motion == "exact" and scene.correction in ("conserve", "rewind", "replay")
    if scene.a_mps2 != 0 and scene.CR < 1 and not shown.is_resting and not is_cured:
        text += " " + OWN_SCENE.seen
    return text

def film(scene: Scene, title: str, options: argparse.Namespace) -> None:
    """Say what to look for, leave time to guess, show the film, and say what was to be seen."""
    number = options.number
    example = EXAMPLES.get(number, OWN_SCENE)
    is_changed = number in EXAMPLES and scene_text(scene) != scene_text(scene_of(example, {}))
    question = example.look_for
    if is_changed:
        question = f"What differs from example {number} as it is?"
    has_details = options.details or number == 0  # the first film should show what there is
    say(title)
    say(scene_text(scene))
    view = fitted(scene, has_details)
    if view.width_px < scene.width_px:
        say(f"The picture is drawn {view.width_px} columns wide, to fit into the terminal.")
    taking = nullcontext(NoKeys()) if options.fast else taken_keys()
    with taking as keys:
        try:
            for text in keys.texts_before(question):
                say(text)
            keys.leave_time()
        except KeyboardInterrupt:
            keys.press(CTRL_C)  # it begins the film
        print()
        shown = run(view, has_details, options.frames, keys)
    if not options.fast and shown.frames > 0:
        tell(scene, number, is_changed, shown)

def tell(scene: Scene, number: int, is_changed: bool, shown: Shown) -> None:
    """Say after a film what was to be seen, and what to type next."""
    if len(shown.collisions) > 2:
        say(hops_text(shown.collisions))
    following = str(number + 1)
    if is_changed:
        say(f"Example {number} as it is: {PYTHON} airtrack.py {number}")
    elif number in EXAMPLES:
        say(EXAMPLES[number].seen)
    else:
        say(advice(scene, shown))
        following = "-h"
    if number == max(EXAMPLES):
        following = "chart"
    say(f"Next: {PYTHON} airtrack.py {following}")

# ==== 12. Checks ================================================================================
# Which scenes are allowed?

SETTINGS = {setting.name: setting for setting in fields(Scene)}

# Values that people type because other programs have them, and what they are called here:
OTHER_WORDS = {"motion=euler": "forward or backward", "correction=exact": "rewind or replay"}

def allowed_text(setting: Field[Any]) -> str:
    """What a setting may be, in words."""
    metadata = setting.metadata
    if "choices" in metadata:
        return " or ".join([str(choice) for choice in metadata["choices"]])
    kind = "a number"
    if isinstance(setting.default, int):
        kind = "a whole number"
    return f"{kind} from {metadata['least']} to {metadata['largest']} {metadata['unit']}".rstrip()

def check_value(name: str, value: Any) -> None:
    """Raise ValueError if the setting of this name may not have this value."""
    setting = SETTINGS[name]
    metadata = setting.metadata
    if "choices" in metadata:
        is_allowed = value in metadata["choices"]
    elif isinstance(value, (int, type(setting.default))):
        is_allowed = metadata["least"] <= value <= metadata["largest"]
    else:
        is_allowed = False
    if not is_allowed:
        text = f"{name} must be {allowed_text(setting)}, not {value}"
        typed = f"{name}={value}"
        if typed in OTHER_WORDS:
            text += f": did you mean {OTHER_WORDS[typed]}?"
        elif "," in typed:
            with_a_point = str(value).replace(",", ".")
            text += f": write {with_a_point}"
        raise ValueError(text)

def check(scene: Scene) -> None:
    """Raise ValueError for a scene that is not allowed."""
    for name in SETTINGS:
        check_value(name, getattr(scene, name))
    left_m, right_m = scene.left_edge_m, scene.right_edge_m
    if right_m - left_m < 0.01 - 1e-9:  # round-off: 2.21 - 2.2 is a little less than 0.01
        raise ValueError("right_edge_m must be at least 0.01 m to the right of left_edge_m, not "
                         f"{right_m} and {left_m}")
    if scene.correction in EXACT_ONLY:
        needed_by = f"with correction={scene.correction}"
        if scene.motion != "exact":
            raise ValueError(f"motion must be exact {needed_by}, not {scene.motion}: choose "
                             "motion=exact or another correction")
        if scene.wall_passed(scene.x_m) is not None:
            raise ValueError(f"x_m must be from {left_m} to {right_m} {needed_by}, not {scene.x_m}")

def scene_of(example: Example, changes: dict[str, Any]) -> Scene:
    """The scene of an example, with what the user changed. Raises ValueError."""
    settings = example.settings | changes
    scene = Scene(**settings)
    if "m_to_px" not in settings and scene.right_edge_m > 0:
        # Nobody chose a zoom: take one that shows the right wall.
        widest = (scene.width_px - 1) / scene.right_edge_m
        scene = replace(scene, m_to_px=min(scene.m_to_px, widest))
    return scene

# ==== 13. The command line ======================================================================
# What does the user want?

COMMANDS = ["chart", "stability"]
# The names that a user may type, with the words that describe them:
NAMES = {"chart": "speed against accuracy", "stability": "the map: where methods fail",
         "--fast": "no waiting", "--frames": "stop after N frames", "--help": "-h"}
for each in SETTINGS.values():
    NAMES[each.name] = f"{each.metadata['meaning']}: {allowed_text(each)}"

def unknown(word: str) -> str:
    """The error text for a word that means nothing, with the names that may have been meant."""
    start = word.partition("=")[0].lower()
    near = [name for name in NAMES if start in name.lower().split("_")]
    if len(start) > 1 or not near:  # "a" is a word in many descriptions
        for name, description in NAMES.items():
            if name not in near and start in re.findall("[a-z]+", description.lower()):
                near.append(name)
    if not near:
        near = difflib.get_close_matches(start, NAMES, n=1)
    if re.fullmatch("[0-9]+d", start):
        near = [f"{start[:-1]} d"]
    text = (f"unknown word {word}: it must be the number of an EXAMPLE, d, chart, stability, an "
            "option or NAME=VALUE without spaces")
    if near:
        text += f"; did you mean {' or '.join(near[:3])}?"
    return text

def value_of(name: str, text: str) -> Any:
    """The value of a setting, from what a user typed after NAME=. Raises ValueError."""
    kind: Any = type(SETTINGS[name].default)
    value: Any = text
    if kind is bool:
        value = {"true": True, "false": False}.get(text.lower(), text)
    else:
        with suppress(ValueError):  # what is no number stays a text, which check_value refuses
            value = kind(text)
    check_value(name, value)
    return value

def wanted(argv: list[str] | None) -> argparse.Namespace:
    """What the command line asks for: help, command, number, changes, details, fast and frames.

    Raises ValueError or argparse.ArgumentError for what is wrong.
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False, exit_on_error=False)
    parser.add_argument("words", nargs="*")
    parser.add_argument("-h", "--help", action="store_true")
    parser.add_argument("-d", "-D", dest="details", action="store_true")
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--frames", type=int)
    options, others = parser.parse_known_intermixed_args(argv)
    commands, numbers, changes = [], [], {}
    for word in [*options.words, *others]:
        name, equals, text = word.partition("=")
        if word in ("d", "D"):
            options.details = True
        elif word in COMMANDS:
            commands.append(word)
        elif word.removeprefix("-").isdecimal():
            numbers.append(int(word))
        elif name in SETTINGS and equals:
            changes[name] = value_of(name, text)
        else:
            raise ValueError(unknown(word))
    if len(commands) > 1 or len(numbers) > 1:
        raise ValueError(f"one command and one EXAMPLE at a time, not {commands + numbers}")
    if commands and (options.details or options.fast or options.frames is not None):
        raise ValueError(f"d, --fast and --frames are for a film, not for {commands[0]}")
    if options.frames is None:
        options.frames = 50_000
    if options.frames < 1:
        raise ValueError(f"--frames N must be a whole number from 1 up, not {options.frames}")
    options.command = commands[0] if commands else "film"
    options.number = 10 if commands else 0
    if numbers:
        options.number = numbers[0]
    options.changes = changes
    return options

def print_manual() -> None:
    """Print what -h shows: the usage, the examples and the settings."""
    print(__doc__)
    print("Examples (any other whole number is for a scene of your own):")
    for number, example in EXAMPLES.items():
        print(f"  {number:2}  {example.title}")
    print("\nSettings: default, meaning and what is allowed")
    for name, setting in SETTINGS.items():
        meaning = setting.metadata["meaning"]
        row = f"  {name:20}{setting.default!s:9}{meaning} ({allowed_text(setting)})"
        print(textwrap.fill(row, 80, subsequent_indent=" " * 31))

def title_of(number: int, changes: dict[str, Any]) -> str:
    """The title of an example, and what the user changed."""
    title = f"{OWN_SCENE.title} (the examples are 0 to {max(EXAMPLES)})"
    if number in EXAMPLES:
        title = f"Example {number}: {EXAMPLES[number].title}"
    for name, value in changes.items():
        title += f", {name}={value}"
    return title

def scene_wanted(options: argparse.Namespace) -> Scene:
    """The scene for what the options ask for. Raises ValueError."""
    example = EXAMPLES.get(options.number, OWN_SCENE)
    if options.command == "film":
        return scene_of(example, options.changes)
    # Chart and map choose motion and correction themselves, and start on the track.
    any_method = {"motion": "exact", "correction": "none"}
    return truth_of(scene_of(example, options.changes | any_method))

def obey(options: argparse.Namespace, scene: Scene) -> None:
    """Do what the user asks for."""
    title = title_of(options.number, options.changes)
    if options.help:
        print_manual()
    elif options.command == "chart":
        chart(scene, f"{title}. {start_text(scene)}")
        say(f"Next: {PYTHON} airtrack.py stability")
    elif options.command == "stability":
        stability(scene, f"{title}. {start_text(scene)}")
    else:
        film(scene, title, options)

def refuse(fault: Exception) -> int:
    """Print an error as one line. Returns the exit status for it."""
    print(f"airtrack.py: error: {fault}", file=sys.stderr)
    return 2

def main(argv: list[str] | None = None) -> int:
    """Do what argv or, without it, the command line asks for. Returns the exit status."""
    try:
        options = wanted(argv)
        scene = scene_wanted(options)
    except (ValueError, argparse.ArgumentError) as fault:
        return refuse(fault)
    try:
        obey(options, scene)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return 130
    except OSError as fault:
        # Nobody reads any more, as after | head, or the disk is full. When Python ends, it would
        # try again to print what is left.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(fault, BrokenPipeError):
            return refuse(fault)
    return 0


if __name__ == "__main__":
    sys.exit(main())
