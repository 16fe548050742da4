#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text a frame.
So its film is a graph: position to the right, time downwards.

A WORD is one of these, in any order:
    EXAMPLE      the number of an example (without it 0, for a map or chart 10)
    d            details after each line: position x, velocity v, frame rate FPS
                 and, if the true car o is drawn, err: how far the car is to the
                 right of the o
    NAME=VALUE   a setting that replaces the example's own
    chart        no film, but speed against accuracy: what each method costs,
                 and how wrong it is
    stability    no film, but the map: at which frame rates each method fails

For example: python airtrack.py 10 d fps_target=30

In a film, * is the car and | is a wall. < or > is the car, too, when it is out of
the picture. If the car bounces, 0 is where the frame would have ended without walls.
A . is the start. o is the true car. If you changed an example, + is the car of the
unchanged example. a to e are the cars of five methods.

README.md says what this is good for. .github/lesson.md is a lesson for a class.
"""
# What is where?
#     Sections 1 to 4    the physics: how a car moves and bounces, and where it truly is.
#     Sections 5 and 6   the film: how a frame is drawn, and the main loop.
#     Sections 7 to 9    how wrong the methods are: the chart, the map, and the law behind the map.
#     Sections 10 to 12  what is said around a film, checks, the command line. They hold no physics.
# The file examples.py holds the numbered examples and the keys.
#
# Which method should I take? If you read nothing else, read this table. A method is a motion and a
# correction. The motion moves the car through a frame as if there were no walls. If the move has
# ended beyond a wall, the correction says where the car is instead, and how fast.
#
#     method                 order  energy       take it for
#     a  backward + rebound  1      up and down  scenery, where heights and times do not matter
#     b  exact + rebound     1      too much     nothing: a car that should come to rest hops on
#     c  exact + conserve    2      right        most things
#     d  exact + rewind      none   right        short frames, if the moments of the bounces matter
#     e  exact + replay      none   right        the truth, in frames of any length
#
# Order 1 means that frames of half the length make half the error, and order 2 that they make a
# quarter. Methods d and e have no order: where they are right, their only error is round-off. The
# energy is told for a car that bounces on the wall to which it is accelerated, as a ball bounces on
# a floor. Methods b to e need a constant acceleration. Methods a to d need short frames. In a
# frame they settle one bounce, and miss it if the car is back on the track when the frame ends
# (example 18). If a move is longer than the track, they may throw the car out at the other end.
# Replay is different: it works out the whole frame, from bounce to bounce.

import argparse
import difflib
import math
import os
import shutil
import signal
import sys
import textwrap
import time
from collections import deque
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field, fields, replace
from itertools import pairwise
from statistics import fmean
from typing import Any, NamedTuple, TypeVar

from examples import CHANGED, EXAMPLES, OWN_SCENE, Example, Keys, NoKeys, taken_keys

# ==== 1. Moving =================================================================================
# Where is the car dt_s later, if there are no walls?
#
#     x_m      the position of the car in m. A larger x is further to the right.
#     v_mps    the velocity of the car in m/s. It is positive if the car moves to the right.
#     a_mps2   the acceleration of the car in m/s^2. It is the same all the time.
#     dt_s     the time step in s: how much time passes for the car in a frame.
#
# The velocity changes during the frame. Euler's methods ignore this change: they move the car at
# one velocity through the whole frame. The method forward takes the velocity at the start of the
# frame, and backward takes the velocity at its end. Both are of first order: half the dt makes
# half the error after a given time. The method exact has no error, because a is constant.
# For a constant a, backward is the same as the method that is called semi-implicit Euler.
#
# In free flight the energy of the car should not change. For each kilogram of the car this energy
# is E = v^2/2 - a x. The docstring of each method says what one step does to E.

State = tuple[float, float]  # a place and a velocity

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

# If you write another motion, name it here. Then film and map know it. (The chart compares METHODS,
# see section 4.) Rewind and replay refuse it, because they need the exact motion.
MOTIONS = {"forward": forward, "backward": backward, "exact": exact}

# ==== 2. Colliding ==============================================================================
# Where is the car after it has met a wall, and how fast is it?
#
# A collision is found when a move has ended beyond a wall. Then a correction gives the car a new
# place and a new velocity. The correction need not know which of the two walls it is, because it
# counts from the wall, and into the wall:
#
#     depth_m       how far the car is beyond the wall. In front of the wall, depth_m is negative.
#     inward_mps    the velocity of the car. It is positive if the car moves into the wall.
#     inward_mps2   the acceleration of the car. It is positive if it points into the wall.
#     CR            the coefficient of restitution: the speed after a bounce / the speed before it.
#
# Here is one collision at the left wall. There, inward is to the left. The motion is exact,
# inward_mps2 is 20, CR is 0.8, and a column is 1 cm. In one frame of 0.1 s the car moves from the
# start to the 0, which is 8 cm beyond the wall. Then each correction gives the car a new place (*).
# E is the energy in J/kg: v^2/2 - a * depth, where v is inward_mps and a is inward_mps2.
#
#                                            depth_m   inward_mps   E
#     start              |           *       -0.120       1.00     2.90
#     the move   0       |                    0.080       3.00     2.90
#     none       *       |                    0.080      -2.40     1.28
#     surface    0       *                    0.000      -2.40     2.88
#     rebound    0       |     *             -0.064      -2.40     4.16
#     conserve   0       |     *             -0.064      -1.07     1.86
#     rewind     0       |    *              -0.048      -1.33     1.86
#
# A bounce, at depth 0, keeps the part CR of the speed, so CR^2 of the energy: 0.64 * 2.90 is 1.86.
# Only conserve and rewind leave the right energy. Only rewind leaves the right place, too.
#
# The five corrections of this section take the same four arguments, and return a new depth_m and a
# new inward_mps. So step() can call any of them.

def none(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Reverse the velocity, but leave the car beyond the wall, where it may be caught.

    In example 3 the motion is backward, inward_mps2 is 1.5, dt is 1/30 s, and CR is 0.6. Rounded:
        frame 46   The move ends 5.17 cm deep.   inward_mps changes from  2.30 to -1.38.
        frame 47   The move ends 0.73 cm deep.   inward_mps changes from -1.33 to  0.80.
        frame 48   The move ends 3.56 cm deep.   inward_mps changes from  0.85 to -0.51.
    In frame 47 the car was still beyond the wall, because the bounce had slowed it. So its velocity
    was reversed again, now into the wall. The same happens in frame 49, and so on: the car is
    caught. Such a car is said to stick. The other corrections are there to prevent this.
    """
    return depth_m, -CR * inward_mps

def surface(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Put the car on the wall, with its velocity reversed.

    If the acceleration points into the wall, surface lifts the car against it. That should cost
    speed, but surface does not slow the car. So the car has more energy than it should: in the
    drawn collision 2.88 J/kg instead of 1.86.
    """
    return 0.0, -CR * inward_mps

def rebound(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Put the car in front of the wall, CR * depth away.

    Without an acceleration this is right: while the move went on into the wall by the depth, the
    true car went back, CR times as fast. If the acceleration points into the wall, rebound adds
    energy, as surface does. If CR * depth is longer than the track, the car is thrown
    out at the other end (example 14).
    """
    return -CR * depth_m, -CR * inward_mps

def conserve(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Put the car where rebound does, at the speed with which it has the right energy there.

    If this energy is too small to get there, put the car on the wall. With the exact motion the
    energy is right, and only the moment of the bounce is wrong. The error is of second order: half
    the dt makes a quarter of it. Like rebound, conserve may throw the car out.
    """
    # Take the car back to the wall. E does not change, so its speed w there follows from
    # w^2 = v^2 - 2 a depth. This may come out negative: by round-off, if backward has taken too
    # much energy, or if the car started beyond the wall. The bounce leaves the speed CR w.
    w_squared = max(0.0, inward_mps * inward_mps - 2 * inward_mps2 * depth_m)
    bounced_mps = CR * math.sqrt(w_squared)  # 1.93 m/s in the drawn collision
    # Take the car to its new place, CR * depth in front of the wall. E does not change, so its
    # speed s there follows from s^2 = (CR w)^2 - 2 a CR depth.
    s_squared = bounced_mps * bounced_mps - 2 * inward_mps2 * CR * depth_m
    if s_squared < 0:
        return 0.0, -bounced_mps
    return -CR * depth_m, -math.sqrt(s_squared)

def arrival(d_m: float, u_mps: float, a_mps2: float) -> tuple[float, float]:
    """When will a car be at a wall d_m ahead of it, and how fast? Returns t_s and w_mps.

    u_mps is the velocity of the car now. Both u_mps and a_mps2 count as positive if they point
    towards the wall. The car must be able to get there: with d = 1, u = 1 and a = -20 it is not.
    """
    # Energy gives the speed w at the wall: w^2 = u^2 + 2 a d. Round-off may make w^2 negative.
    w_mps = math.sqrt(max(0.0, u_mps * u_mps + 2 * a_mps2 * d_m))
    # Two formulas give the time t. If two numbers are nearly equal, their difference is mostly
    # round-off. So take the formula in which the speeds are added.
    if u_mps > 0:
        t_s = 2 * d_m / (u_mps + w_mps)  # from the mean velocity: d = t (u + w)/2
    else:
        t_s = (w_mps - u_mps) / a_mps2  # from w = u + a t. Here u <= 0, so w - u is a sum.
    return t_s, w_mps

def rewind(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Take the car back in time to the wall, let it bounce, and move it on to the frame's end.

    With the exact motion this is right if the frame holds one bounce and the move ends beyond the
    wall. So in example 10, where CR is 1, the car comes back to its start each time. Rewind cannot
    settle a second bounce. If the car turns beyond the wall and is back on the track when the frame
    ends, no collision is found: a missed event (example 18). If a move goes further beyond the wall
    than the track is long, rewind may throw the car out, too.
    """
    # Run the film backwards: the car comes out of the wall. When is it at the wall, and how fast?
    # In this film it moves outwards at the speed inward_mps. An acceleration does not turn round in
    # a film that runs backwards: it still points inwards. So outwards it is -inward_mps2.
    late_s, met_mps = arrival(depth_m, inward_mps, -inward_mps2)  # 0.030 s, 2.41 m/s
    # Run it forwards again, from the wall, after the bounce, for the same time.
    new_depth_m, new_inward_mps = exact(0.0, -CR * met_mps, inward_mps2, late_s)
    # If the car is in the wall again, there was a second bounce. Put it on the wall, at this speed,
    # and leave the second bounce to the next frame. (So it has a little too much energy.)
    return min(new_depth_m, 0.0), new_inward_mps

CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "conserve": conserve,
               "rewind": rewind}

# The sixth correction, replay, is in section 4. It settles a whole frame.
ALL_CORRECTIONS = [*CORRECTIONS, "replay"]
EXACT_ONLY = ["rewind", "replay"]  # they need the exact motion

# ==== 3. The scene and a frame ==================================================================
# What does a run start from, and how does the car get from one frame to the next?

Value = TypeVar("Value")

def setting(default: Value, meaning: str, **allowed: Any) -> Value:
    """A setting of a scene: its default, its meaning and what is allowed.

    It returns a field, of which @dataclass makes the attribute of a Scene. For the type checker it
    returns the default, as dataclasses.field() does, because the attribute will be of that type.

    A field of a dataclass may carry metadata: a dictionary that dataclasses keep and do not use.
    The checks (section 11) and -h find there what is allowed, so it is said only once.
    """
    return field(default=default, metadata={"meaning": meaning} | allowed)

YES_OR_NO = [False, True]

@dataclass(frozen=True)  # frozen: no run can change its scene. replace() makes a changed copy.
class Scene:
    """The settings of a run. The unit is part of a name: x_m is in m.

    Raises ValueError if a setting is out of its range, or if two settings exclude each other.
    """

    x_m: float = setting(1.1, "start position in m", least=-1000, largest=1000)
    v_mps: float = setting(0.0, "start velocity in m/s, to the right", least=-1000, largest=1000)
    a_mps2: float = setting(0.0, "acceleration in m/s^2, to the right", least=-1000, largest=1000)
    left_edge_m: float = setting(0.25, "position of the left wall in m", least=-1000, largest=1000)
    right_edge_m: float = setting(2.2, "position of the right wall in m", least=-1000, largest=1000)
    CR: float = setting(0.8, "speed after a bounce / before it", least=0, largest=1)
    motion: str = setting("backward", "how the car is moved", choices=list(MOTIONS))
    correction: str = setting("rebound", "how a collision is settled", choices=ALL_CORRECTIONS)
    fps_target: float = setting(30.0, "frames a second; dt = 1/fps_target", least=0.1, largest=1000)
    use_observed_dt: bool = setting(False, "dt is how long a frame lasted", choices=YES_OR_NO)
    jitter: float = setting(0.0, "frames last longer or shorter by up to this fraction",
                            least=0, largest=0.9)
    auto_off: bool = setting(True, "stop when the car is at rest", choices=YES_OR_NO)
    m_to_px: float = setting(55.0, "zoom in columns for each m", least=0.001, largest=1000)
    width_px: int = setting(135, "width of the picture in columns", least=10, largest=1000)
    show_start_mark: bool = setting(False, "draw a . at the start", choices=YES_OR_NO)
    show_collision_mark: bool = setting(True, "draw a 0 where a move ended", choices=YES_OR_NO)
    show_exact_mark: bool = setting(False, "draw an o for the true car", choices=YES_OR_NO)
    show_methods: bool = setting(False, "draw a to e for five methods", choices=YES_OR_NO)

    def __post_init__(self) -> None:
        """Refuse a scene that is not allowed. Python calls this when a scene is made."""
        check(self)  # see section 11

    def to_track(self, x_m: float) -> float:
        """The place on the track that is nearest to x_m: x_m itself, or the wall it is beyond."""
        return min(max(x_m, self.left_edge_m), self.right_edge_m)

    def starts_on_track(self) -> bool:
        """Whether the car starts between the walls, and not beyond one."""
        return self.left_edge_m <= self.x_m <= self.right_edge_m

    def floor_m(self) -> float:
        """The wall to which the car is accelerated. (If a_mps2 is 0, either would do.)"""
        return self.right_edge_m if self.a_mps2 > 0 else self.left_edge_m

    def energy(self, x_m: float, v_mps: float) -> float:
        """The energy in J/kg: 0 for a car that stands still at the floor."""
        return v_mps * v_mps / 2 - self.a_mps2 * (x_m - self.floor_m())

Moved = tuple[float, float, float | None]  # x_m, v_mps, mark_m

def step(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> Moved:
    """Move the car by a frame of dt_s, and settle a collision. Returns x_m, v_mps and mark_m.

    mark_m is None or, in a collision, where the move alone ended. The film draws a 0 there.
    """
    if scene.correction == "replay":
        return replay(scene, x_m, v_mps, dt_s)  # it works out the whole frame, see section 4
    # Move the car as if there were no walls.
    move = MOTIONS[scene.motion]
    free_m, free_mps = move(x_m, v_mps, scene.a_mps2, dt_s)
    if scene.left_edge_m <= free_m <= scene.right_edge_m:
        return free_m, free_mps, None
    # The move ended beyond a wall. Count from this wall, and into it: at the right wall this is to
    # the right, too, so the signs stay. At the left wall they change.
    wall_m = scene.to_track(free_m)
    sign = 1 if free_m > wall_m else -1
    depth_m = sign * (free_m - wall_m)
    inward_mps = sign * free_mps
    inward_mps2 = sign * scene.a_mps2
    correct = CORRECTIONS[scene.correction]
    new_depth_m, new_inward_mps = correct(depth_m, inward_mps, inward_mps2, scene.CR)
    # Count from x = 0 and to the right again.
    return wall_m + sign * new_depth_m, sign * new_inward_mps, free_m

# ==== 4. The truth ==============================================================================
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
# take a finite time: if the first hop lasts 1 s, all of them last 1 + CR + CR^2 + ... seconds, and
# this sum is 1/(1 - CR). The moment at which they end is called the Zeno point. From then on the
# ball is at rest. Nobody can follow infinitely many hops one by one. So a ball that would rise less
# than GRAZE_M is at rest here. After a drop from 2 m this is at bounce 55 if CR is 0.8, and at
# bounce 605 if CR is 0.98.

GRAZE_M = 5e-11  # far more than the round-off of a position, and less than an atom's width

def next_bounce(h_m: float, rise_mps: float, g_mps2: float,
                room_m: float) -> tuple[str, float, float]:
    """Which wall does the ball meet next, after how many s, and at how many m/s?

    h_m is the height of the ball, and rise_mps is its velocity, upwards.
    """
    # To rise to the ceiling takes the energy g * (room - h). A ball may touch the ceiling at almost
    # no speed, and then round-off would decide whether it does. So a ball that would turn back less
    # than GRAZE_M beyond the ceiling does not meet it.
    energy_to_meet_it = g_mps2 * (room_m - h_m + GRAZE_M)
    if rise_mps > 0 and rise_mps * rise_mps / 2 >= energy_to_meet_it:
        flight_s, speed_mps = arrival(room_m - h_m, rise_mps, -g_mps2)
        return "ceiling", flight_s, speed_mps
    flight_s, speed_mps = arrival(h_m, -rise_mps, g_mps2)
    return "floor", flight_s, speed_mps

def replay(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> Moved:
    """Follow the exact motion for a whole frame, from bounce to bounce, as a ball in a room.

    Takes and returns what step() does. Right for a frame of any length.
    """
    # A car that has not turned and is still on the track has met no wall. This quick way out is
    # not needed, but most frames take it, and it is several times as fast.
    free_m, free_mps = exact(x_m, v_mps, scene.a_mps2, dt_s)
    has_turned = v_mps * free_mps < 0  # its velocity has changed its sign
    if scene.left_edge_m <= free_m <= scene.right_edge_m and not has_turned:
        return free_m, free_mps, None
    # Turn the track into a room. up is the direction away from the floor.
    up = -1 if scene.a_mps2 > 0 else 1
    floor_m = scene.floor_m()
    room_m = scene.right_edge_m - scene.left_edge_m
    g_mps2 = abs(scene.a_mps2)
    h_m = up * (scene.to_track(x_m) - floor_m)
    rise_mps = up * v_mps
    remaining_s = dt_s  # the part of the frame that is still to come
    has_bounced = False
    since_floor_s = math.inf  # how long ago the ball bounced on the floor: not yet in this frame
    while rise_mps != 0 or g_mps2 != 0:  # otherwise nothing moves the ball
        wall, flight_s, speed_mps = next_bounce(h_m, rise_mps, g_mps2, room_m)
        if flight_s > remaining_s:
            break  # the frame ends before the ball gets there
        remaining_s -= flight_s
        since_floor_s += flight_s
        has_bounced = True
        if wall == "ceiling":
            h_m, rise_mps = room_m, -scene.CR * speed_mps
        else:
            h_m, rise_mps = 0.0, scene.CR * speed_mps
            if rise_mps * rise_mps / 2 <= g_mps2 * GRAZE_M:
                return floor_m, 0.0, free_m  # at rest, as it cannot rise by GRAZE_M
            if scene.CR == 1:
                # The ball will be back on the floor after the same time, again and again. Leave out
                # these times as a whole: what is left over is the remainder of a division.
                remaining_s = remaining_s % since_floor_s
            since_floor_s = 0.0
    h_m, rise_mps = exact(h_m, rise_mps, -g_mps2, remaining_s)
    x_m = scene.to_track(floor_m + up * h_m)  # round-off must not leave it beyond a wall
    if not has_bounced:
        return x_m, up * rise_mps, None
    return x_m, up * rise_mps, free_m

def truth_of(scene: Scene) -> Scene:
    """The same scene, solved exactly. A start beyond a wall is moved to the wall."""
    return replace(scene, motion="exact", correction="replay", x_m=scene.to_track(scene.x_m))

# These are the five methods of the table at the head of this file. Example 21 and the chart compare
# them, by their letters.
METHODS = {"a": ("backward", "rebound"), "b": ("exact", "rebound"), "c": ("exact", "conserve"),
           "d": ("exact", "rewind"), "e": ("exact", "replay")}

def methods_of(scene: Scene) -> dict[str, Scene]:
    """The same scene with each of the five methods, by their letters."""
    scenes = {}
    for letter, (motion, correction) in METHODS.items():
        scenes[letter] = replace(scene, motion=motion, correction=correction)
    return scenes

def method_text(motion: str, correction: str) -> str:
    """A method in words, as in backward + rebound."""
    return f"{motion} + {correction}"

# ==== 5. Drawing ================================================================================
# How does a frame become a line of text, and how is a scene told in words?

def render_track(scene: Scene, places_m: dict[str, float], mark_m: float | None) -> str:
    """Draw a frame: one line of scene.width_px columns. places_m has the cars by their marks.

    The line is painted from back to front: what is painted later covers what was there. The cars
    are in this order, too. So the car itself, *, is the last of them, and nothing hides it.
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
    first_m = min(0.0, scene.left_edge_m)  # the picture begins at 0 or, further left, at the wall
    for mark, x_m in marks:
        column = round((x_m - first_m) * scene.m_to_px)
        if 0 <= column < scene.width_px:
            line[column] = mark
        elif mark == "*" and column < 0:
            line[0] = "<"  # it is out of the picture, on the left
        elif mark == "*":
            line[-1] = ">"
    return "".join(line)

# A terminal changes its colour where it reads "\033[" and a number and "m". 0 ends the colour.
COLOURED_MARKS = str.maketrans({
    "*": "\033[33m*\033[0m",  # yellow
    "+": "\033[36m+\033[0m",  # cyan
    "o": "\033[32mo\033[0m",  # green
    "0": "\033[31m0\033[0m",  # red
})

def details_text(x_m: float, v_mps: float, fps: float, true_m: float | None) -> str:
    """What d adds to a line: position, velocity, frame rate and, given the truth, the error."""
    text = f"x = {x_m:6.2f}, v = {v_mps:5.2f}, FPS = {fps:3.0f}"
    if true_m is None:
        return text
    return f"{text}, err = {x_m - true_m:9.2e}"

def scene_of(settings: dict[str, Any]) -> Scene:
    """The scene with these settings. Raises ValueError."""
    scene = Scene(**settings)
    if "m_to_px" in settings:
        return scene
    # Nobody chose a zoom: take one that shows the right wall.
    shown_m = scene.right_edge_m - min(0.0, scene.left_edge_m)
    return replace(scene, m_to_px=min(scene.m_to_px, (scene.width_px - 1) / shown_m))

def fitted(scene: Scene, has_details: bool) -> Scene:
    """The scene, drawn smaller if its lines are wider than the terminal."""
    columns = shutil.get_terminal_size().columns
    if has_details:
        true_m = 0.0 if scene.show_exact_mark else None
        longest = details_text(-1000, -1000, scene.fps_target, true_m)  # but for a car far out
        columns -= len(longest)
    columns = max(columns, 10)  # the least that a scene may have
    if columns >= scene.width_px or not sys.stdout.isatty():
        return scene
    # What was in the last column must stay in the last column. The first column has number 0.
    m_to_px = scene.m_to_px * (columns - 1) / (scene.width_px - 1)
    return replace(scene, width_px=columns, m_to_px=max(m_to_px, 0.001))

PYTHON = os.path.basename(sys.executable).removesuffix(".exe")  # python3 where there is no python

def start_text(scene: Scene) -> str:
    """Car and track, by the names that one may type. (A number may have ten digits.)"""
    return (f"x_m={scene.x_m:.10g} v_mps={scene.v_mps:.10g} a_mps2={scene.a_mps2:.10g} "
            f"CR={scene.CR:.10g}, walls at {scene.left_edge_m:.10g} and "
            f"{scene.right_edge_m:.10g} m")

def scene_text(scene: Scene) -> str:
    """The scene without its drawing. Cars whose scenes have the same text move alike."""
    method = method_text(scene.motion, scene.correction)
    text = f"{start_text(scene)}; {method}, {scene.fps_target:.10g} FPS"
    if scene.jitter > 0:
        text += f", jitter={scene.jitter:.10g}"
    if scene.use_observed_dt:
        text += ", use_observed_dt=True"
    if not scene.starts_on_track():
        text += "; it starts beyond a wall"
    return text

def say(text: str) -> None:
    """Print a paragraph, as wide as the terminal but no wider than is good to read."""
    width = min(100, shutil.get_terminal_size().columns)
    print(textwrap.fill(text, width), flush=True)

# ==== 6. The run ================================================================================
# How do the frames become a film that runs at the right speed?
# What happened to the cars? The main loop is run(), at the end of this section.

def planned_length(scene: Scene, frame: int) -> float:
    """How long this frame should last, in s. With jitter, frames are irregular in a fixed way."""
    # The multiples of 0.618 (the golden ratio - 1) without their whole parts are spread evenly
    # over the numbers from 0 to 1.
    from_0_to_1 = (0.618 * frame) % 1
    from_minus_1_to_1 = 2 * from_0_to_1 - 1
    return (1 + scene.jitter * from_minus_1_to_1) / scene.fps_target

def planned_dt(scene: Scene, frame: int) -> float:
    """The time step of a frame that lasts as long as planned, in s."""
    if scene.use_observed_dt:
        return planned_length(scene, frame)
    return 1 / scene.fps_target

def frame_settings(scene: Scene) -> tuple[float, float, bool]:
    """The settings on which the time steps depend."""
    return scene.fps_target, scene.jitter, scene.use_observed_dt

STALL_S = 0.15  # a delay that everybody sees: people begin to notice one at about 0.1 s

class Pace:
    """The pace of a film: when is the next frame due, and how long did it take to come?"""

    def __init__(self, scene: Scene, keys: Keys | NoKeys) -> None:
        self.scene = scene
        self.keys = keys
        # Begin as if the time of frame 1 had just passed. So frame 1 is due now.
        self.shown_s = time.perf_counter() - planned_length(scene, 1)  # when the last frame came
        self.due_s = self.shown_s  # when it was due

    def wait(self, frames: int, t_s: float) -> tuple[float, float]:
        """Wait until the next frame is due. frames and t_s say how far the film is.

        Returns dt_s, the time step for this frame, and the frame rate that was observed.

        The frames are due at planned moments. If each frame slept for dt instead, it would last
        longer than dt, because computing and printing take time, too.
        """
        planned_s = planned_length(self.scene, frames + 1)
        self.due_s += planned_s
        was_timed = self.keys.wait_until(self.due_s, frames, t_s)  # False after a pause
        now_s = time.perf_counter()
        lasted_s = now_s - self.shown_s
        self.shown_s = now_s
        fps = self.scene.fps_target
        if was_timed:
            fps = 1 / max(lasted_s, 1e-6)  # the clock may not have ticked in between
        # After a pause, or if the film is far behind its plan, the plan begins anew from now.
        # Otherwise the film would race to catch up.
        if not was_timed or now_s > self.due_s + STALL_S:
            self.due_s = now_s
        # A frame with a pause or a stall counts as long as planned. Otherwise the car would leap.
        was_disturbed = not was_timed or lasted_s > planned_s + STALL_S
        if self.scene.use_observed_dt and not was_disturbed:
            return lasted_s, fps
        return planned_dt(self.scene, frames + 1), fps

REST_M = 0.001  # 1 mm: less than a column in every example

class Car:
    """A car of the film: where it is, where it truly should be, and what has happened to it."""

    def __init__(self, scene: Scene, truth: "Car | None" = None) -> None:
        """truth is the true car of the same scene. Without one, this car is the true car itself."""
        self.scene = scene
        self.truth = self if truth is None else truth
        self.x_m, self.v_mps = scene.x_m, scene.v_mps
        self.mark_m: float | None = None  # where its last move ended, if it met a wall
        self.frames, self.t_s = 0, 0.0
        self.is_drawn = True  # a car that nobody sees keeps nothing for the table after the film
        self.collisions: list[int] = []  # the frames in which it met a wall
        self.most_off_m = 0.0  # how far it was at most from the true car
        self.energy = scene.energy(self.x_m, self.v_mps)  # in J/kg
        self.first_energy = self.least_energy = self.most_energy = self.energy
        # Whether a car rests is asked of its last frames. The frames of 1/3 s are enough to see it.
        # But ask ten frames at least, because a car in flight may be near a wall for some frames,
        # too. A deque with a maxlen forgets its oldest item when a new one comes.
        self.rest_frames = max(10, round(scene.fps_target / 3))
        self.last: deque[tuple[float, float]] = deque(maxlen=self.rest_frames)  # t_s and x_m
        self.rest_began_s: float | None = None  # since when it is at rest, if it is

    def move(self, dt_s: float) -> None:
        """Make a frame of dt_s. The true car must have made it already."""
        self.x_m, self.v_mps, self.mark_m = step(self.scene, self.x_m, self.v_mps, dt_s)
        self.frames += 1
        self.t_s += dt_s
        if self.is_drawn:
            self.keep()

    def keep(self) -> None:
        """Keep what is told after the film."""
        if self.mark_m is not None:
            self.collisions.append(self.frames)
        self.most_off_m = max(self.most_off_m, abs(self.x_m - self.truth.x_m))
        self.energy = self.scene.energy(self.x_m, self.v_mps)
        self.least_energy = min(self.least_energy, self.energy)
        self.most_energy = max(self.most_energy, self.energy)
        self.last.append((self.t_s, self.x_m))
        if not self.is_at_rest():
            self.rest_began_s = None
        elif self.rest_began_s is None and self.lies_still():
            self.rest_began_s = self.t_s  # it has come to rest in this frame
        elif self.rest_began_s is None:
            self.rest_began_s, _ = self.last[0]  # it has rested through all of the last frames

    def lies_still(self) -> bool:
        """Whether it lies exactly on the wall to which it is accelerated, with v = 0."""
        has_floor = self.scene.a_mps2 != 0
        return has_floor and self.v_mps == 0 and self.x_m == self.scene.floor_m()

    def has_last_frames(self) -> bool:
        """Whether there are enough frames to ask."""
        return len(self.last) == self.rest_frames

    def is_at_rest(self) -> bool:
        """Whether it rests on its floor or, without an acceleration, does not move at all."""
        if self.lies_still():
            return True
        if not self.has_last_frames():
            return False
        scene = self.scene
        if scene.a_mps2 == 0:
            _, first_m = self.last[0]
            return self.v_mps == 0 and self.x_m == first_m
        if scene.correction == "replay":
            return False  # a true car that does not lie still hops, however low
        # Other methods may never leave the car quite still. So it is enough that its mean distance
        # from the floor is small, and its speed no larger than what it could gain in these frames.
        floor_m = scene.floor_m()
        if abs(self.x_m - floor_m) > REST_M * self.rest_frames:
            return False  # the quick way out: this distance alone makes the mean too large
        gained_mps = abs(scene.a_mps2) * self.rest_frames / scene.fps_target
        if abs(self.v_mps) > gained_mps:
            return False
        return fmean([abs(x_m - floor_m) for _, x_m in self.last]) <= REST_M

    def is_beyond_a_wall(self) -> bool:
        """Whether it was beyond a wall in all of the last frames, not only after a bounce."""
        are_beyond = [x_m != self.scene.to_track(x_m) for _, x_m in self.last]
        return self.has_last_frames() and all(are_beyond)

class UnchangedCar(Car):
    """The + of a changed example: the car of the example as it is, in frames of its own.

    The film does not know its true car. So move() moves both.
    """

    def __init__(self, scene: Scene, film_scene: Scene) -> None:
        super().__init__(scene, Car(truth_of(scene)))
        self.truth.is_drawn = False
        self.has_film_frames = frame_settings(scene) == frame_settings(film_scene)
        self.behind_s = 0.0  # how far it is behind the film

    def move(self, dt_s: float) -> None:
        """Make the frames that end in the next dt_s of the film: one, many or none."""
        if self.has_film_frames:
            self.move_both(dt_s)
            return
        self.behind_s += dt_s
        own_s = planned_dt(self.scene, self.frames + 1)
        while own_s < self.behind_s + 1e-9:  # round-off: ten frames of 0.1 s are nearly 1 s
            self.behind_s -= own_s
            self.move_both(own_s)
            own_s = planned_dt(self.scene, self.frames + 1)

    def move_both(self, dt_s: float) -> None:
        """Make a frame with the car and its true car."""
        self.truth.move(dt_s)
        super().move(dt_s)

def cars_of(scene: Scene, unchanged: Scene | None) -> dict[str, Car]:
    """All cars that a film draws, by their marks, from back to front.

    unchanged is the example as it is, if the user changed it.
    """
    true_car = Car(truth_of(scene))
    cars = {}
    if scene.show_methods:
        for letter, method in methods_of(true_car.scene).items():
            cars[letter] = Car(method, true_car)
    if scene.show_exact_mark:
        cars["o"] = true_car
    if unchanged is not None:
        cars["+"] = UnchangedCar(unchanged, scene)
    if scene == true_car.scene:
        cars["*"] = true_car
    else:
        cars["*"] = Car(scene, true_car)
    true_car.is_drawn = true_car in cars.values()
    return cars

def number_text(number: float) -> str:
    """A number with up to four significant digits, or 0 if it is smaller than a thousandth."""
    if abs(number) < 0.001:
        return "0"
    return f"{number:.4g}"

def off_text(car: Car) -> str:
    """How far the car was at most from its true car."""
    if car.most_off_m < 0.001:
        return "under 1 mm"
    return f"{number_text(car.most_off_m)} m"

def hops_text(collisions: list[int]) -> str:
    """How many frames there are from bounce to bounce: the first four and the last two."""
    hops = [str(after - before) for before, after in pairwise(collisions)]
    if len(hops) > 6:
        hops = [*hops[:4], "...", *hops[-2:]]
    return " ".join(hops)

def end_text(car: Car) -> str:
    """What the car does at the end of the film."""
    if car.rest_began_s is not None:
        return f"rests from {car.rest_began_s:.2f} s"
    if car.is_beyond_a_wall():
        return "is beyond a wall"
    return "still moves"

def tell_cars(cars: dict[str, Car]) -> None:
    """Print a table with a row for each car, and a line for its hops and its end."""
    marks = [mark for mark in "*+oabcde" if mark in cars]
    print()
    print("                      furthest from     energy in J/kg")
    print("                      its own truth      first      least       most       last")
    for mark in marks:
        car = cars[mark]
        name = method_text(car.scene.motion, car.scene.correction)
        off = off_text(car)
        if mark == "o":
            name, off = "the truth", ""
        row = f"{mark} {name:20}{off:>13}"
        for energy in (car.first_energy, car.least_energy, car.most_energy, car.energy):
            row += number_text(energy).rjust(11)
        print(row)
    print("Energy 0 is rest on the wall to which a points. Below 0 the car is beyond it.")
    print("The hops in frames, each from one bounce to the next, and the end:")
    for mark in marks:
        car = cars[mark]
        row = f"{mark} at {car.scene.fps_target:.4g} FPS: "
        if len(car.collisions) > 1:
            row += hops_text(car.collisions) + "; "
        print(row + end_text(car))

def run(cars: dict[str, Car], view: Scene, has_details: bool, max_frames: int,
        keys: Keys | NoKeys) -> None:
    """Show the film until a key, the car at rest or max_frames ends it, and say which it was.

    view is the scene as it is drawn: in a narrow terminal it is smaller.
    """
    car = cars["*"]
    scene = car.scene
    pace = Pace(scene, keys)
    others = [each for each in cars.values() if each is not car.truth]
    moving = [car.truth, *others]  # the true car first, as the others are compared with it
    while True:
        # Wait until the next frame is due.
        dt_s, fps = pace.wait(car.frames, car.t_s)
        if keys.why_quit:
            why = keys.why_quit
            break
        # Move the cars, and settle their collisions.
        for each in moving:
            each.move(dt_s)
        # Draw the frame.
        places_m = {mark: each.x_m for mark, each in cars.items()}
        line = render_track(view, places_m, car.mark_m)
        if keys.has_colours:
            line = line.translate(COLOURED_MARKS)
        if has_details:
            line += details_text(car.x_m, car.v_mps, fps, places_m.get("o"))
        print(line)
        # Is it over?
        if scene.auto_off and car.rest_began_s is not None:
            why = "the car is at rest"
            break
        if car.frames >= max_frames:
            why = "that is the frame limit"
            break
    print(f"Stopped after {car.frames} frames, t = {car.t_s:.2f} s: {why}.", flush=True)

# ==== 7. The chart: speed against accuracy ======================================================
# What does each method cost, and how wrong is it? A drawn pixel is a column of the film: 1/m_to_px
# wide, in m.

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
    part = 0.0  # of a frame
    if cut > 0:
        # Nine parts, 1/9 of a frame apart: 1/27, 4/27, 7/27, ... 25/27. None of them is at the edge
        # of a frame, because a run from there would be cut 0 again.
        part = (cut - 2 / 3) / (CUTS - 1)
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
    """How long the steps of a simulated second take, in microseconds.

    Other programs may slow this one, and nothing can speed it up. So the least of several runs is
    nearest to the time that the steps themselves need.
    """
    dt_s = 1 / fps
    costs_s = []
    runs = max(5, 200 // fps)  # at a low rate a run is short, so one disturbance may spoil it
    for _ in range(runs):
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
    motions = "".join([f"{letter}: {motion}".rjust(15) for letter, (motion, _) in METHODS.items()])
    corrections = "".join([f"+ {correction}".rjust(15) for _, correction in METHODS.values()])
    print()
    print("    " + motions)
    print("    " + corrections)
    print(" FPS" + "  error m    us" * len(METHODS))
    points: dict[str, list[Point]] = {letter: [] for letter in METHODS}
    for fps in CHART_FPS:
        row = f"{fps:4}"
        for letter, method in methods_of(scene).items():
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
    if last_m < 1e-8:  # this is round-off, which has no order
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
    """Draw the points as the film is drawn: error to the right, cost downwards."""
    letters: dict[tuple[int, int], str] = {}  # by row and column
    for letter, series in points.items():
        for point in series:
            row = round(ROWS_A_DECADE * math.log10(point.cost_us))
            place = row, error_column(point.error_m)
            if place in letters and letters[place] != letter:
                letters[place] = "+"  # another letter stands there already
            else:
                letters[place] = letter
    rows = [row for row, _ in letters]
    pixel_column = error_column(pixel_m)
    print("one drawn pixel |".rjust(10 + pixel_column + 1))
    print("    us    <=1 um  10 um   0.1 mm  1 mm    1 cm    0.1 m   1 m     >=10 m")
    for row in range(min(rows), max(rows) + 1):
        line = f"{10 ** (row / ROWS_A_DECADE):6.0f}    "
        for column in range(error_column(LARGEST_ERROR_M) + 1):
            behind = "|" if column == pixel_column else " "
            line += letters.get((row, column), behind)
        print(line.rstrip())
    print()

def conclude(points: dict[str, list[Point]], pixel_m: float) -> None:
    """Answer the question: which methods stay within a pixel, and what do they cost?"""
    answers = []
    for letter, (motion, correction) in METHODS.items():
        name = method_text(motion, correction)
        answer = None
        for fps, error_m, us in reversed(points[letter]):
            if error_m > pixel_m:
                break  # no lower rate counts
            answer = us, f"  {letter}  {name:18}  from {fps:4} FPS on  {us:5.0f} us"
        if answer is not None:
            answers.append(answer)
    answers.sort()  # by the cost, which stands first
    say(f"These stay within a drawn pixel ({pixel_m:.2g} m) in all ten runs, the cheapest first:")
    for _, text in answers:
        print(text)
    if not answers:
        print("  none at these rates")

def chart(scene: Scene, title: str) -> None:
    """Measure, print the table, draw the picture and answer the question."""
    pixel_m = 1 / scene.m_to_px
    say(f"Speed against accuracy. {title}")
    say("Which method is the cheapest that stays within a drawn pixel of the truth? Each method "
        "runs ten times for 20 simulated seconds. Error: the largest distance from the true car in "
        "these runs, looked at every 0.1 s. Cost: the time that a simulated second takes, in us "
        "(microseconds). Order: 1 if half the dt makes half the error, 2 if it makes a quarter. "
        "Method e is the truth's own method, so its error can be nothing but round-off.")
    points = measure(scene)
    picture(points, pixel_m)
    legend = [f"{letter}: {method_text(*method)}" for letter, method in METHODS.items()]
    say(f"{', '.join(legend)}. Error to the right, cost downwards: the best are in the upper left. "
        "Where letters meet there is a +.")
    conclude(points, pixel_m)
    say(f"Next: {PYTHON} airtrack.py stability")

# ==== 8. The map: where methods fail ============================================================
# Which method fails at which frame rate, and how?

MAP_FPS = [1, 2, 5, 10, 30, 60, 120, 240, 1000]
VERDICTS = {  # from the worst to the best. W is not for one run, but for ten: see cell().
    "X": "out: further beyond a wall than the track is long",
    "S": "stuck: beyond the same wall all through the last 5 s",
    "H": "hops or hovers, over 1 mm off in the last 5 s, although the true car rests",
    "W": "as G in some runs, as L in others",
    "G": "over a pixel off and, on average in the last 5 s, over 1 % too much energy",
    "L": "over a pixel off and, on average in the last 5 s, over 1 % too little energy",
    "P": "over a pixel off, but with the right energy",
    "-": "within a drawn pixel of the truth",
}
FROM_WORST_TO_BEST = list(VERDICTS)

def verdict(scene: Scene, fps: int, cut: int) -> str:
    """The letter of one run: X, S, H, G, L, P or -. (W needs several runs.)"""
    samples = simulate(scene, fps, cut)
    late = len(samples) * 3 // 4  # here begin the samples of the last 5 of 20 s
    track_m = scene.right_edge_m - scene.left_edge_m
    # X: how far beyond a wall was the car?
    # (Positive numbers are beyond the right wall, negative ones beyond the left wall.)
    beyond_m = [sample.x_m - scene.to_track(sample.x_m) for sample in samples]
    if max(beyond_m) > track_m or min(beyond_m) < -track_m:
        return "X"
    # S: was it beyond the same wall all through the last 5 s?
    if min(beyond_m[late:]) > 0 or max(beyond_m[late:]) < 0:
        return "S"
    # H: did the true car rest all through the last 5 s, but not this one?
    errors_m = [abs(sample.x_m - sample.true_m) for sample in samples]
    has_true_rest = all(sample.true_mps == 0 for sample in samples[late:])
    if has_true_rest and max(errors_m[late:]) > REST_M:
        return "H"
    # G, L and P are for a car that is over a drawn pixel off.
    if max(errors_m) <= 1 / scene.m_to_px:
        return "-"
    # G or L: how much more energy did it have than the true car? 100 % is v^2/2 at the start, and
    # what the acceleration could add on the whole length of the track.
    all_energy = scene.v_mps**2 / 2 + abs(scene.a_mps2) * track_m
    energies = [scene.energy(sample.x_m, sample.v_mps) for sample in samples[late:]]
    true_energies = [scene.energy(sample.true_m, sample.true_mps) for sample in samples[late:]]
    gain = fmean(energies) - fmean(true_energies)
    if gain > 0.01 * all_energy:
        return "G"
    if gain < -0.01 * all_energy:
        return "L"
    return "P"

def cell(letters: list[str]) -> str:
    """One letter for ten runs: the worst, as a small letter if only some runs are so bad."""
    worst = min(letters, key=FROM_WORST_TO_BEST.index)  # the first in this list
    if worst == "G" and "L" in letters:
        return "W"
    if letters.count(worst) < len(letters):
        return worst.lower()
    return worst

def stability(scene: Scene, title: str) -> None:
    """Print the map: a row for each method, a column for each rate, a letter for ten runs."""
    say(f"Stability. {title}")
    say("Which methods are right, and from which frame rate on? Each runs ten times for 20 "
        "simulated seconds. A small letter: only some of the ten runs are so bad. 100 % of the "
        "energy is v^2/2 at the start + the acceleration * the length of the track. Example 20 "
        "says why a car gets too much energy (H, G), and example 19 why it gets too little (L).")
    print()
    print(" " * 20 + "".join([str(fps).rjust(6) for fps in MAP_FPS]) + " FPS")
    for motion in MOTIONS:
        for correction in ALL_CORRECTIONS:
            if correction in EXACT_ONLY and motion != "exact":
                continue
            method = replace(scene, motion=motion, correction=correction)
            row = method_text(motion, correction).ljust(20)
            for fps in MAP_FPS:
                letters = [verdict(method, fps, cut) for cut in range(CUTS)]
                row += cell(letters).rjust(6)
            print(row, flush=True)
    for letter, meaning in VERDICTS.items():
        print(f"{letter}  {meaning}")

# ==== 9. The law: why the map has its H, G and L ================================================
# Why do some cars hop for ever, and why do others lie still too soon?
# There is no code here. You need pen and paper.
#
# A car hops on the wall to which it is accelerated, as a ball hops on a floor. Call this wall the
# floor. Up is away from the floor, and g is the size of a. All frames last dt. The car does not
# meet the other wall. (In the drawing below up is to the right, and each line has the number of its
# frame.)
#
# A hop lasts from a frame in which a collision is found to the next such frame. It begins upwards,
# at the speed u, and ends downwards, at the speed w. Here is a hop with exact + surface. CR is 1, g
# is 4 m/s^2, dt is 0.1 s, and a column is 1 cm.
#     0:        *                   The hop begins on the floor (*), with u = 1.1 m/s upwards.
#     1:        |        *
#     2:        |             *
#     3:        |              *
#     4:        |           *
#     5:        |    *
#     6:  0     *                   The hop ends 6 cm lower (0), with w = 1.3 m/s downwards.
# This hop has 6 frames. A true car comes back as fast as it left: w is u. This car comes back
# faster. The number k of a hop says by how much:
#         w - u = k * g * dt                  here 1.3 - 1.1 = k * 0.4, so k is 1/2
# If a car comes back slower than it left, the k of this hop is negative.
#
# In truth each hop lasts CR times as long as the hop before. With surface and rebound the law is
#         next = CR * (hop + k) + k'          here 7 = 1 * (6 + 1/2) + 1/2
# Here hop and next are the lengths of a hop and of the hop after it, both in frames. The number k
# belongs to the hop, and k' to the next hop. (The drawn hop is followed by one of 7 frames, which
# has k' = 1/2, too.) If k and k' are 0, the law is the truth. It is found in three steps.
# (1) Each frame adds g * dt to the velocity downwards. All frames of the hop together take it from
#     -u to w:
#         w + u = hop * g * dt                here 1.3 + 1.1 = 6 * 0.4
# (2) Add w - u = k * g * dt to this, or subtract it. Then divide by 2:
#         w = (hop + k) * g * dt/2            here 1.3 = (6 + 1/2) * 0.2
#         u = (hop - k) * g * dt/2            here 1.1 = (6 - 1/2) * 0.2
# (3) By (2) the next hop begins at the speed (next - k') * g * dt/2. This is what the bounce has
#     left of w: CR * w. So next - k' is CR * (hop + k), and this is the law.
#
# Where does k come from? A collision is found late, so a hop ends lower (0) than it begins (*). How
# much lower is the drop of the hop. Here it is 6 cm. The mean velocity of the hop, downwards, is
# (w - u)/2, and the hop lasts hop * dt. So with the exact motion
#         drop = (w - u)/2 * hop * dt         here 6 cm = 0.1 m/s * 6 * 0.1 s
# Put in k * g * dt for w - u:
#         drop = k * hop * g * dt^2/2         here 6 cm = 1/2 * 12 cm
# So of two hops that are equally long, the one with the larger drop has the larger k. In the hop
# itself there is no error: a car that has fallen lower is faster. The error comes after it: surface
# lifts the car by the drop, and does not slow it. Forward makes an error in each frame of the hop,
# too. It moves the car at the velocity from the start of the frame, so the frame ends g * dt^2/2
# higher than with exact. With backward it ends as much lower. Let s be 1 for forward, 0 for exact
# and -1 for backward. Then
#         drop = (k - s) * hop * g * dt^2/2
#
# How large is k? Take exact + surface. The hop begins on the floor. It ends with the first frame
# after which the car is below the floor:
#         height after n frames = n * dt * (u - n * g * dt/2)
#         for n = hop it is below 0:          u is less than hop * g * dt/2
#         for n = hop - 1 it is not:          u is at least (hop - 1) * g * dt/2
#         by (2):                             u is (hop - k) * g * dt/2
# So k is more than 0 and at most 1. With forward, (u - (n - 1) * g * dt/2) stands there, and k is
# more than 1 and at most 2. With backward it is (u - (n + 1) * g * dt/2), and k is more than -1 and
# at most 0. With rebound a hop begins above the floor, so its drop may be larger, and k up to 1
# larger. (This proof is longer. The tests check it.) In every hop of two frames or more, at any CR,
# but for round-off, k is more than the first number and at most the second:
#
#                  surface     rebound
#     forward      1 to 2      1 to 3
#     exact        0 to 1      0 to 2
#     backward    -1 to 0     -1 to 1
#
# Which k a hop has depends on where in a frame the car meets the floor. So it depends on the start
# of the film.
#
# What does k do?
#     k > 0   The car gets too much energy. At CR = 1 each hop is longer than the hop before, by
#             k + k' frames (G in the map). At CR < 1 the hops should die out, but many do not.
#             When does a hop repeat? Put next = hop and k' = k into the law:
#                 hop = CR * (hop + k) + k,  so  hop * (1 - CR) = k * (1 + CR)
#             So a hop of k * (1 + CR)/(1 - CR) frames is followed by the same hop, for ever. (If
#             it is over 1 mm high, the map shows H. In hops of one frame the car meets the floor
#             in every frame: it rests.) With rebound the hops may also end in a cycle, as 7 7 8 9
#             9 8 with exact + rebound at CR = 0.8.
#     k < 0   The car gets too little energy. At CR = 1 it should hop for ever, but its hops get
#             shorter, and it comes to rest (L). At CR < 1 the next hop is shorter than CR * hop.
#     k = 0   The car gets the right energy.
#
# Example 20 is exact + rebound at CR = 0.8. From its start the hops get to k = 1, so to
# 1 * 1.8/0.2 = 9 frames, and stay so: the car never comes to rest. With exact + surface at CR = 0.8
# k is at most 1, so the hops that repeat have 2 to 9 frames.
#
# Example 19 is backward + surface at CR = 1, so k is more than -1 and at most 0. When is it 0? By
# (2), k is hop - 2 * u/(g * dt). If 2 * u is a whole number of g * dt, k is a whole number, too, so
# it is 0. In example 19 this never happens: g * dt is 0.2 m/s, and the start velocity is 0.098 m/s.
# Each frame changes the velocity by 0.2 m/s, and a bounce changes only its sign. So k is below 0 in
# each hop, and the car comes to rest. But for a car that starts from rest 2 * u is a whole number
# of g * dt. So it hops for ever, as it should. (Such a hop meets the floor at the very end of a
# frame. Because of round-off the program may find the collision there, one frame too early. Then k
# is -1.)
#
# Backward + rebound may have k above and below 0 in turn, so its car gets higher and lower.

# The physics ends here.

# ==== 10. Before and after a film ===============================================================
# What is said before a film, and what after it?

class Wanted(NamedTuple):
    """What the user wants."""

    command: str  # film, chart or stability
    number: int  # of the example
    changes: dict[str, Any]  # the settings that replace the example's own
    typed: dict[str, str]  # the same, as they were typed: NAME=VALUE by the name
    has_details: bool
    is_fast: bool
    max_frames: int

def say_before(scene: Scene, wanted: Wanted) -> None:
    """Say which scene the film is of: its title, what the user changed, and all that moves it."""
    title = OWN_SCENE.title
    if wanted.number in EXAMPLES:
        title = f"Example {wanted.number}: {EXAMPLES[wanted.number].title}"
    say(", ".join([title, *wanted.typed.values()]))
    texts = [scene_text(scene)]
    if scene.show_methods:
        texts += [f"{letter}: {method_text(*method)}" for letter, method in METHODS.items()]
    say("; ".join(texts))

def film(scene: Scene, wanted: Wanted) -> None:
    """Say what to look for, leave time to guess, show the film, and say what was to be seen."""
    example = EXAMPLES.get(wanted.number, OWN_SCENE)
    unchanged = None
    as_it_is = scene_of(example.settings)
    if wanted.number in EXAMPLES and scene_text(as_it_is) != scene_text(scene):
        example, unchanged = CHANGED, as_it_is
        shows_truth = wanted.changes.get("show_exact_mark", True)
        scene = replace(scene, show_exact_mark=shows_truth)
    has_details = wanted.has_details or wanted.number == 0  # the first film shows what there is
    say_before(scene, wanted)
    view = fitted(scene, has_details)
    if view.width_px < scene.width_px:
        say(f"The picture is drawn {view.width_px} columns wide, to fit into the terminal.")
    cars = cars_of(scene, unchanged)
    taking = nullcontext(NoKeys()) if wanted.is_fast else taken_keys()  # NoKeys takes nothing
    with taking as keys:
        question = example.look_for
        if not example.seen and not scene.show_exact_mark:
            question = "Does the * come to rest?"  # the other question is about the o
        for text in keys.texts_before(question):
            say(text)
        keys.leave_time()
        print()
        run(cars, view, has_details, wanted.max_frames, keys)
    if cars["*"].frames == 0:
        return
    tell_cars(cars)
    if not wanted.is_fast:
        say_after(cars["*"], example, wanted)

def say_after(car: Car, example: Example, wanted: Wanted) -> None:
    """Say what was to be seen or, where nobody knows it, what to try. Then say what comes next."""
    print()
    if example.seen:
        say(example.seen)
    else:
        say(advice(car))
        words = " ".join([word for name, word in wanted.typed.items() if name in OF_THE_TRACK])
        say(f"Which methods are right here? {PYTHON} airtrack.py stability {wanted.number} {words}")
    following = wanted.number + 1 if wanted.number + 1 in EXAMPLES else "chart"
    say(f"Next: {PYTHON} airtrack.py {following}")

def advice(car: Car) -> str:
    """Is the car's method right for its scene? If not, what may be tried, one after the other?"""
    scene = car.scene
    pixel = f"a drawn pixel ({1 / scene.m_to_px:.2g} m)"
    if not car.collisions:
        return "No collision of the * was found, so this film tells nothing of its correction."
    if car.most_off_m <= 1 / scene.m_to_px:
        return f"The * stayed within {pixel} of its true car. So its method is right for this film."
    text = f"The * was up to {off_text(car)} from its true car, which is over {pixel}."
    cures = ["conserve", "rewind", "replay"] if scene.starts_on_track() else ["conserve"]
    if scene.motion == "exact" and scene.correction in cures:
        cures = cures[cures.index(scene.correction) + 1:]
    if not cures:
        return text
    change = f"correction={', then '.join(cures)}"
    if scene.motion != "exact":
        change = f"motion=exact and, at the same time, {change}"
    return f"{text} Try {change}."

# ==== 11. Checks ================================================================================
# Which scenes are allowed?

SETTINGS = {each.name: each for each in fields(Scene)}

def allowed_text(name: str) -> str:
    """What a setting may be, in words."""
    allowed = SETTINGS[name].metadata
    if "choices" in allowed:
        return " or ".join([str(choice) for choice in allowed["choices"]])
    kind = "a whole number" if isinstance(SETTINGS[name].default, int) else "a number"
    return f"{kind} from {allowed['least']} to {allowed['largest']}"

def is_allowed(name: str, value: Any) -> bool:
    """Whether the setting of this name may have this value."""
    allowed = SETTINGS[name].metadata
    kind = type(SETTINGS[name].default)
    is_of_kind = type(value) is kind or (kind is float and type(value) is int)  # 1 is a number, too
    if "choices" in allowed:
        return is_of_kind and value in allowed["choices"]
    return is_of_kind and bool(allowed["least"] <= value <= allowed["largest"])

def check(scene: Scene) -> None:
    """Raise ValueError for a scene that is not allowed."""
    for name in SETTINGS:
        value = getattr(scene, name)
        if not is_allowed(name, value):
            raise ValueError(f"{name} must be {allowed_text(name)}, not {value}")
    left_m, right_m = scene.left_edge_m, scene.right_edge_m
    if right_m - left_m < 0.01 - 1e-9:  # round-off: 2.21 - 2.2 is a little less than 0.01
        raise ValueError(f"right_edge_m must be {left_m} + 0.01 or more, not {right_m}")
    needed_by = f"with correction={scene.correction}"
    if scene.correction in EXACT_ONLY and scene.motion != "exact":
        raise ValueError(f"motion must be exact {needed_by}, not {scene.motion}: choose "
                         "motion=exact or another correction")
    if scene.correction in EXACT_ONLY and not scene.starts_on_track():
        raise ValueError(f"x_m must be from {left_m} to {right_m} {needed_by}, not {scene.x_m}")

# ==== 12. The command line ======================================================================
# What does the user want?

FRAMES = 50_000  # a film that nobody stops ends then
COMMANDS = {"chart": chart, "stability": stability}
# The commands use these settings alone. They choose methods and frame rates themselves.
OF_THE_TRACK = ["x_m", "v_mps", "a_mps2", "left_edge_m", "right_edge_m", "CR", "m_to_px",
                "width_px"]

# What people type because other programs have it, and what it is called here:
OTHER_NAMES = {"fps": "fps_target", "dt": "fps_target", "g": "a_mps2", "gravity": "a_mps2",
               "a": "a_mps2", "x": "x_m", "position": "x_m", "h": "x_m", "height": "x_m",
               "v": "v_mps", "speed": "v_mps", "velocity": "v_mps", "e": "CR", "restitution": "CR",
               "zoom": "m_to_px", "map": "stability", "fast": "--fast", "frames": "--frames"}

def converted(name: str, text: str) -> Any:
    """The value that a text stands for or, if the setting has no such value, the text itself."""
    kind: Any = type(SETTINGS[name].default)
    if kind is bool:
        return {"true": True, "false": False}.get(text.lower(), text)
    try:
        return kind(text)
    except ValueError:
        return text

def value_of(name: str, text: str) -> Any:
    """The value of a setting, from what a user typed after NAME=. Raises ValueError."""
    value = converted(name, text)
    if is_allowed(name, value):
        return value
    fault = f"{name} must be {allowed_text(name)}, not {text}"
    with_point = text.replace(",", ".")
    if is_allowed(name, converted(name, with_point)):
        fault += f": write {name}={with_point}"
    raise ValueError(fault)

def unknown(word: str, following: list[str]) -> str:
    """The error text for a word that means nothing. What may have been meant?"""
    name, _, text = word.replace(":", "=").partition("=")
    if name in SETTINGS:  # CR 0.7, CR = 0.7 or CR:0.7
        values = [each for each in [text, *following] if is_allowed(name, converted(name, each))]
        values.append("VALUE")  # if there is no value
        return f"unknown word {word}: write {name}={values[0]}, without spaces"
    hints = OTHER_NAMES | {each.lower(): each for each in [*SETTINGS, *COMMANDS]}
    hints |= {each: f"motion={each}" for each in MOTIONS}
    hints |= {each: f"correction={each}" for each in ALL_CORRECTIONS}
    cutoff = 1.0 if len(name) == 1 else 0.6  # a single letter must be in the table itself
    near = difflib.get_close_matches(name.lower().lstrip("-"), hints, n=1, cutoff=cutoff)
    if not near:
        return f"unknown word {word}: -h lists all that there are"
    hint = hints[near[0]]
    if hint in SETTINGS:
        hint = f"{hint}=VALUE ({SETTINGS[hint].metadata['meaning']})"
    return f"unknown word {word}: did you mean {hint}?"

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

def make_parser() -> argparse.ArgumentParser:
    """What argparse needs to know of the command line. It adds -h by itself."""
    parser = argparse.ArgumentParser(
        prog="airtrack.py", description=__doc__, epilog=epilog(),
        formatter_class=argparse.RawDescriptionHelpFormatter)  # it leaves our lines as they are
    parser.add_argument("words", nargs="*", metavar="WORD", help="see above")
    parser.add_argument("-d", "-D", dest="details", action="store_true", help="as the word d")
    parser.add_argument("--fast", action="store_true", help="no waiting, keys, colours or advice")
    parser.add_argument("--frames", type=int, metavar="N", default=FRAMES,
                        help=f"stop after N frames; without it, after {FRAMES}")
    return parser

def read_command_line(parser: argparse.ArgumentParser, argv: list[str]) -> Wanted:
    """What the words and options of the command line ask for. Raises ValueError."""
    options, unknown_options = parser.parse_known_intermixed_args(argv)
    if unknown_options:
        raise ValueError(unknown(unknown_options[0], []))
    commands, numbers, changes, typed = [], [], {}, {}
    for place, word in enumerate(options.words):
        name, _, text = word.partition("=")
        if word in ("d", "D"):
            options.details = True
        elif word in COMMANDS:
            commands.append(word)
        elif word.removeprefix("-").isdecimal():
            numbers.append(int(word))
        elif name in SETTINGS and text:
            changes[name] = value_of(name, text)
            typed[name] = word
        else:
            raise ValueError(unknown(word, options.words[place + 1:]))
    if len(commands) > 1 or len(numbers) > 1:
        raise ValueError(f"one command and one EXAMPLE at a time, not {commands + numbers}")
    command, number = "film", 0
    if commands:
        command, number = commands[0], 10
        useless = [name for name in changes if name not in OF_THE_TRACK]
        if options.details or options.fast or options.frames != FRAMES:
            useless.append("d, --fast or --frames")
        if useless:
            raise ValueError(f"{command} takes no {useless[0]}: it chooses methods and frame rates "
                             f"itself, and takes an EXAMPLE and {', '.join(OF_THE_TRACK)}")
    if numbers:
        number = numbers[0]
    if options.frames < 1:
        raise ValueError(f"--frames N must be a whole number from 1 up, not {options.frames}")
    return Wanted(command, number, changes, typed, options.details, options.fast, options.frames)

def scene_wanted(wanted: Wanted) -> Scene:
    """The scene that the user wants. Raises ValueError."""
    settings = EXAMPLES.get(wanted.number, OWN_SCENE).settings | wanted.changes
    if wanted.command not in COMMANDS:
        return scene_of(settings)
    settings = {name: value for name, value in settings.items() if name in OF_THE_TRACK}
    return truth_of(scene_of(settings))  # the start is on the track, wherever it was

def obey(argv: list[str]) -> None:
    """Do what the command line asks for. Wrong input ends the program here, with status 2."""
    parser = make_parser()
    try:
        wanted = read_command_line(parser, argv)
        scene = scene_wanted(wanted)
    except ValueError as fault:
        parser.error(str(fault))  # this prints the text and ends the program
    if wanted.command in COMMANDS:
        COMMANDS[wanted.command](scene, f"Scene {wanted.number}: {start_text(scene)}")
    else:
        film(scene, wanted)

def status_of(argv: list[str]) -> int:
    """Obey the command line. Returns the exit status."""
    try:
        obey(argv)
    except KeyboardInterrupt:
        return 130
    except SystemExit as end:  # after -h, wrong input or a signal
        return int(end.code or 0)
    return 0

def main(argv: list[str] | None = None) -> int:
    """Obey argv or, without it, the command line. Returns the exit status."""
    if argv is None:
        argv = sys.argv[1:]
    try:
        status = status_of([word.replace("\u2212", "-") for word in argv])  # a typeset minus
        sys.stdout.flush()
    except BrokenPipeError:
        return 0  # nobody reads any more, as after | head
    except OSError as fault:  # the disk is full, say
        with suppress(OSError):  # the error may not be printable, either
            print(f"airtrack.py: error: {fault}", file=sys.stderr)
        return 2
    return status

if __name__ == "__main__":
    if sys.stdout is None:  # it was closed before the program began
        sys.stdout = open(os.devnull, "w")
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")
    status = main()
    if status == 130 and os.name == "posix":
        # Die by Ctrl-C's signal itself. Then a loop of the shell ends, too.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
    os._exit(status)  # sys.exit would try again to print what could not be printed
