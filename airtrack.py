#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text for each frame.
So its film is a graph: position to the right, time downwards.

A WORD is one of these, in any order:
    EXAMPLE      the number of an example (if you give none: for a film 1, for
                 chart and stability 12)
    d            details after each line: position x, velocity v, frame rate FPS
                 and, if the true car o is drawn, err: how far the car is to the
                 right of the o
    NAME=VALUE   a setting that replaces the example's own
    chart        no film, but speed against accuracy: what each method costs,
                 and how wrong it is
    stability    no film, but the map: at which frame rates each method fails

For example: python airtrack.py 10 d CR=0.9

In a film, * is the car and | is a wall. < or > is the car, too, when it is out
of the picture. If the car bounces, 0 is where the frame would have ended
without walls. A . is the start. o is the true car. If you change the car or the
track of an example, but not its frames, + is the car of the example as it is.
a to e are the cars of five methods.

README.md says what this is good for. .github/lesson.md is a lesson for a class.
"""
# What is where?
#     Sections 1 to 4     the physics: how a car moves and bounces, and where it truly is.
#                         Section 4 ends with a table: which method is good for what.
#     Sections 5 and 6    the film: how a frame is drawn, and the main loop.
#     Sections 7 to 9     how wrong the methods are: the chart, the map, and the law behind the map.
#     Sections 10 to 12   the texts before and after a film, the settings, and the command line.
# The file examples.py holds the numbered examples and the keys.

import argparse
import difflib
import math
import os
import shutil
import sys
import textwrap
import time
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import dataclass, fields, replace
from functools import partial
from itertools import pairwise
from statistics import fmean, linear_regression
from typing import Any, NamedTuple

from examples import CHANGED, CHANGED_FRAMES, EXAMPLES, OWN_SCENE, Example, Keys, NoKeys, taken_keys

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
# see section 4.) Rewind and replay do not go with it, because they need the exact motion.
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
#     conserve   0       *                    0.000      -1.93     1.86
#     rewind     0       |    *              -0.048      -1.33     1.86
#
# A bounce, at depth 0, keeps the part CR of the speed, so CR^2 of the energy: 0.64 * 2.90 is 1.86.
# Surface settles the place. Conserve settles the energy, too. Rewind settles the moment, too: of
# these five only rewind puts the car where a true car is at the end of this frame.
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
    caught, and the acceleration makes it sink. Such a car is said to stick. The other corrections
    prevent this.
    """
    return depth_m, -CR * inward_mps

def surface(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Put the car on the wall, with its velocity reversed.

    If the acceleration points into the wall, surface lifts the car against it. That should cost
    speed, but surface does not slow the car. So with the exact motion the car has more energy than
    it should: in the drawn collision 2.88 J/kg instead of 1.86.
    """
    return 0.0, -CR * inward_mps

def rebound(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Put the car in front of the wall, CR * depth away.

    Without an acceleration this is right: in the time in which the move went on into the wall, the
    true car went back, CR times as fast. If the acceleration points into the wall, and the motion
    is exact, rebound leaves too much energy, as surface does. If CR * depth is longer than the
    track, the car is thrown out at the other end (example 14).
    """
    return -CR * depth_m, -CR * inward_mps

def conserve(depth_m: float, inward_mps: float, inward_mps2: float, CR: float) -> State:
    """Put the car on the wall, as surface does, but with the speed that the energy allows.

    With the exact motion the energy is right after each bounce whose move ends beyond the wall.
    Only the moment is wrong: the car leaves the wall at the end of the frame, up to a frame late.
    """
    # Take the car back to the wall. E does not change, so its speed w there follows from
    # w^2 = v^2 - 2 a depth. Round-off may make this negative, and so may the motion backward or a
    # start beyond the wall. The bounce leaves the speed CR w.
    w_squared = max(0.0, inward_mps * inward_mps - 2 * inward_mps2 * depth_m)
    return 0.0, -CR * math.sqrt(w_squared)  # 1.93 m/s in the drawn collision

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
    settle a second bounce. So a car that should lie still on the wall keeps a velocity into it. In
    frames of one length this velocity is a dt/(1 + CR). If the car turns beyond the wall and is
    back on the track when the frame ends, no collision is found: a missed event (example 18). In a
    frame in which the car should cross the whole track, rewind may throw it out, too.
    """
    # How long ago did the car pass the wall, and how fast? Let time run backwards: then the car
    # moves out of the wall, at inward_mps. Its acceleration still points into the wall, so outwards
    # it is -inward_mps2.
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

# ==== 3. The track and a frame ==================================================================
# What does the physics need to know, and how does the car get from one frame to the next?

@dataclass(frozen=True)  # frozen: nothing can change it. replace() makes a changed copy.
class Track:
    """The track and its car: all that the physics needs to know.

    Raises ValueError if a setting is not allowed, or if two settings exclude each other.
    """

    x_m: float = 1.1  # the start of the car
    v_mps: float = 0.0
    a_mps2: float = 0.0
    left_edge_m: float = 0.25  # the left wall
    right_edge_m: float = 2.2  # the right wall
    CR: float = 0.8
    motion: str = "backward"
    correction: str = "rebound"

    def __post_init__(self) -> None:
        """Refuse settings that are not allowed. Python calls this when a Track is made."""
        check(self)  # see section 11

    def length_m(self) -> float:
        """The distance between the walls."""
        return self.right_edge_m - self.left_edge_m

    def has_on_it(self, x_m: float) -> bool:
        """Whether x_m is a place on the track, and not beyond a wall."""
        return self.left_edge_m <= x_m <= self.right_edge_m

    def to_track(self, x_m: float) -> float:
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
        return replay(track, x_m, v_mps, dt_s)  # it works out the whole frame, see section 4
    # Move the car as if there were no walls.
    move = MOTIONS[track.motion]
    free_m, free_mps = move(x_m, v_mps, track.a_mps2, dt_s)
    if track.left_edge_m <= free_m <= track.right_edge_m:  # has_on_it(), but faster
        return free_m, free_mps, None
    # The move ended beyond a wall. Count from this wall, and into it: at the right wall this is to
    # the right, too, so the signs stay. At the left wall they change.
    wall_m = track.to_track(free_m)
    sign = 1 if free_m > wall_m else -1
    depth_m = sign * (free_m - wall_m)
    inward_mps = sign * free_mps
    inward_mps2 = sign * track.a_mps2
    correct = CORRECTIONS[track.correction]
    new_depth_m, new_inward_mps = correct(depth_m, inward_mps, inward_mps2, track.CR)
    # Count from x = 0 and to the right again.
    return wall_m + sign * new_depth_m, sign * new_inward_mps, free_m

# ==== 4. The truth ==============================================================================
# What would the car really do? And which method should I take?
#
# The correction replay knows the truth, for a frame of any length: one step() of 20 s with
# motion=exact and correction=replay is where the car truly is after 20 s. The film's o, the chart
# and the map rely on this. So the tests compare it with a reference that has 60 digits.
#
# Think of a ball in a room. The wall to which the car is accelerated is the floor, and the other
# wall is the ceiling. h is the height of the ball above the floor. The ball flies from bounce to
# bounce, and arrival() says when each flight ends.
#
# At CR < 1 each hop on the floor lasts CR times as long as the hop before, if the ball does not
# meet the ceiling. So infinitely many hops take a finite time: if the first hop lasts 1 s, all of
# them last 1 + CR + CR^2 + ... seconds, and this sum is 1/(1 - CR). The moment at which they end is
# called the Zeno point. From then on the ball lies still. Nobody can follow infinitely many hops
# one by one. So a ball that would rise less than GRAZE_M lies still here. After a drop from 2 m
# this is at bounce 55 if CR is 0.8, and at bounce 605 if CR is 0.98.

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

def follow(h_m: float, rise_mps: float, g_mps2: float, room_m: float, CR: float,
           remaining_s: float) -> tuple[float, float, bool]:
    """Follow the ball from bounce to bounce. Where is it after remaining_s?

    Returns its height, its velocity upwards, and whether it has bounced.
    """
    has_bounced = has_met_floor = False
    since_floor_s = 0.0  # how long ago the ball met the floor, if it has
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
        if rise_mps * rise_mps / 2 <= g_mps2 * GRAZE_M:
            return 0.0, 0.0, True  # it lies still, as it cannot rise by GRAZE_M
        if CR == 1 and has_met_floor:
            # The ball needed since_floor_s from floor to floor. At CR = 1 it will need as long
            # again and again. Leave out all whole periods: a division leaves the remainder.
            remaining_s = remaining_s % since_floor_s
        has_met_floor = True
        since_floor_s = 0.0
    h_m, rise_mps = exact(h_m, rise_mps, -g_mps2, remaining_s)
    return h_m, rise_mps, has_bounced

def replay(track: Track, x_m: float, v_mps: float, dt_s: float) -> Moved:
    """Follow the exact motion for a whole frame, from bounce to bounce, as a ball in a room.

    It takes and returns what step() does, and is right for a frame of any length.
    """
    # A car that has not turned and is still on the track has met no wall. This quick way out is
    # not needed, but most frames take it, and it is several times as fast.
    free_m, free_mps = exact(x_m, v_mps, track.a_mps2, dt_s)
    has_turned = v_mps * free_mps < 0  # its velocity has changed its sign
    if track.left_edge_m <= free_m <= track.right_edge_m and not has_turned:
        return free_m, free_mps, None
    # Turn the track into a room, and back again. up is the direction away from the floor.
    up = -1 if track.a_mps2 > 0 else 1
    floor_m = track.floor_m()
    h_m = up * (track.to_track(x_m) - floor_m)
    h_m, rise_mps, has_bounced = follow(h_m, up * v_mps, abs(track.a_mps2), track.length_m(),
                                        track.CR, dt_s)
    x_m = track.to_track(floor_m + up * h_m)  # round-off must not leave it beyond a wall
    if not has_bounced:
        return x_m, up * rise_mps, None
    return x_m, up * rise_mps, free_m

def truth_of(track: Track) -> Track:
    """The same track, solved exactly. A start beyond a wall is moved to the wall."""
    return replace(track, motion="exact", correction="replay", x_m=track.to_track(track.x_m))

class Frame(NamedTuple):
    """A car and its true car at the end of a frame. mark_m is that of step()."""

    t_s: float
    x_m: float
    v_mps: float
    mark_m: float | None
    true_m: float
    true_mps: float

    def error_m(self) -> float:
        """How far the car is from the true car."""
        return abs(self.x_m - self.true_m)

class Car:
    """A car on a track, and beside it its true car. It keeps its frames for film, chart and map."""

    def __init__(self, track: Track) -> None:
        self.track = track
        self.truth = truth_of(track)
        self.frames = [Frame(0.0, track.x_m, track.v_mps, None, self.truth.x_m, self.truth.v_mps)]

    def start_later(self, by_s: float) -> None:
        """Start where the true car is after this time, and count the time from there."""
        x_m, v_mps, _ = step(self.truth, self.truth.x_m, self.truth.v_mps, by_s)
        self.frames = [Frame(0.0, x_m, v_mps, None, x_m, v_mps)]

    def move(self, dt_s: float, count: int = 1) -> None:
        """Make so many frames of dt_s, and keep the last of them. (The map does not need them all.)

        The true car makes one long step.
        """
        last = self.frames[-1]
        x_m, v_mps, mark_m = last.x_m, last.v_mps, last.mark_m
        for _ in range(count):
            x_m, v_mps, mark_m = step(self.track, x_m, v_mps, dt_s)
        moved_s = count * dt_s
        true_m, true_mps, _ = step(self.truth, last.true_m, last.true_mps, moved_s)
        self.frames.append(Frame(last.t_s + moved_s, x_m, v_mps, mark_m, true_m, true_mps))

# Which method should I take? A method is a motion and a correction. Of the fourteen possible ones,
# example 21 and the chart compare five.
#
#     method                 energy       error of the place          take it for
#     a  backward + rebound  up and down  order 1                     scenery
#     b  exact + rebound     too much     order 1                     cars without an acceleration
#     c  exact + conserve    right        order 1: bounces come late  balls in a game
#     d  exact + rewind      right        none, or order 2 at CR < 1  short frames
#     e  exact + replay      right        none                        the truth
#
# The table is for a car that bounces on its floor. Order 1 means that frames of half the length
# make half the error, and order 2 that they make a quarter. Method d is right while each frame
# holds at most one bounce, and the move of a frame with a bounce ends beyond the wall. But at
# CR < 1 the last frames before the Zeno point hold several bounces. Without an acceleration, and in
# short frames, a, b, d and e have no error, and c has one of order 1.
#
# Methods a to d need short frames, because they look only at the end of a frame, and settle one
# bounce there. They miss a bounce if the car is back on the track when the frame ends (example 18).
# In long frames a, b and d may even throw the car out at the other end (example 14). Methods c and
# e never do. Method e is right in frames of any length. Why not always take e? It needs a constant
# acceleration, as b to d do. And it needs to know all walls at once, to find the next bounce. The
# others settle only the wall that a move has met.
METHODS = {"a": ("backward", "rebound"), "b": ("exact", "rebound"), "c": ("exact", "conserve"),
           "d": ("exact", "rewind"), "e": ("exact", "replay")}

def method_text(motion: str, correction: str) -> str:
    """A method in words, as in backward + rebound."""
    return f"{motion} + {correction}"

LEGEND = [f"{letter}: {method_text(*method)}" for letter, method in METHODS.items()]

# ==== 5. Drawing ================================================================================
# How does a frame become a line of text?

@dataclass(frozen=True)
class Scene(Track):
    """A track, and how it is filmed. (SETTINGS in section 11 says what each setting means.)"""

    fps_target: float = 30.0
    use_observed_dt: bool = False
    jitter: float = 0.0
    auto_off: bool = True
    m_to_px: float = 55.0
    width_px: int = 135
    show_start_mark: bool = False
    show_collision_mark: bool = True
    show_exact_mark: bool = False
    show_methods: bool = False

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
        longest = details_text(-1000, -1000, scene.fps_target, true_m)
        columns -= len(longest)
    columns = max(columns, 10)  # the least that a scene may have
    if columns >= scene.width_px or not sys.stdout.isatty():
        return scene
    # What was in the last column must stay in the last column. The first column has number 0.
    m_to_px = scene.m_to_px * (columns - 1) / (scene.width_px - 1)
    return replace(scene, width_px=columns, m_to_px=max(m_to_px, 0.001))

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

# ==== 6. The run ================================================================================
# How do the frames become a film that runs at the right speed, and when does it end? The main loop
# is run(), at the end of this section.

def planned_length(scene: Scene, frame: int) -> float:
    """How long this frame should last, in s. With jitter, frames are irregular in a fixed way."""
    # The multiples of 0.618 (the golden ratio - 1) without their whole parts are spread evenly
    # over the numbers from 0 to 1.
    from_0_to_1 = (0.618 * frame) % 1
    from_minus_1_to_1 = 2 * from_0_to_1 - 1
    return (1 + scene.jitter * from_minus_1_to_1) / scene.fps_target

STALL_S = 0.15  # a delay that everybody sees: people begin to notice one at about 0.1 s

def paced(scene: Scene, keys: Keys | NoKeys, max_frames: int) -> Iterator[tuple[float, float]]:
    """Wait until each frame is due, and give its dt_s and its frame rate.

    This is a generator: run() loops over it, and each yield gives the loop the next frame.

    The frames are due at planned moments. If each frame slept for dt instead, it would last longer
    than dt, because computing and printing take time, too.
    """
    # Begin as if the time of frame 1 had just passed. So frame 1 is due now.
    shown_s = time.perf_counter() - planned_length(scene, 1)
    due_s = shown_s
    t_s = 0.0
    for frame in range(1, max_frames + 1):
        planned_s = planned_length(scene, frame)
        due_s += planned_s
        was_timed = keys.wait_until(due_s, frame - 1, t_s)  # False after a pause
        if keys.why_quit:
            return
        now_s = time.perf_counter()
        lasted_s = now_s - shown_s
        shown_s = now_s
        fps = scene.fps_target
        if was_timed:
            fps = 1 / max(lasted_s, 1e-6)  # the clock may not have ticked in between
        # After a pause, or if the film is far behind its plan, the plan begins anew from now.
        # Otherwise the film would race to catch up.
        if not was_timed or now_s > due_s + STALL_S:
            due_s = now_s
        # A frame with a pause or a stall counts as long as planned. Otherwise the car would leap.
        if not scene.use_observed_dt:
            dt_s = 1 / scene.fps_target
        elif was_timed and lasted_s <= planned_s + STALL_S:
            dt_s = lasted_s
        else:
            dt_s = planned_s
        t_s += dt_s
        yield dt_s, fps

REST_M = 0.003  # too low to be seen in most films
MOST_REST_M = 0.05  # at 10 FPS and 9.81 m/s^2 the speed a * dt lets a car rise 4.9 cm
REST_S = 0.3  # long enough to be seen
REST_FRAMES = 10  # at a low frame rate 0.3 s may be a single frame

def rest_began_s(car: Car) -> float | None:
    """Since when the car is at rest, or None if it is not.

    A car is at rest if in each frame, for 0.3 s and ten frames, it is on the track, and its energy
    is too small to rise 3 mm above its floor. With some methods a car that lies keeps a speed of
    up to a * dt. This speed would let it rise |a| * dt^2/2. So this height is allowed, too, but no
    more than 5 cm in all. (Without an acceleration the speed must be 0.)
    """
    track = car.track
    g_mps2 = abs(track.a_mps2)
    now_s = began_s = car.frames[-1].t_s
    quiet_frames = 0
    for frame, frame_before in pairwise(reversed(car.frames)):  # from the last frame back
        dt_s = frame.t_s - frame_before.t_s
        most_m = min(REST_M + g_mps2 * dt_s * dt_s / 2, MOST_REST_M)
        energy = track.energy(frame.x_m, frame.v_mps)
        if energy > g_mps2 * most_m or not track.has_on_it(frame.x_m):
            break
        began_s = frame.t_s
        quiet_frames += 1
    # From the end of the first quiet frame to the end of the tenth are nine frames. At 30 FPS this
    # is 0.3 s, but for round-off.
    lasted_s = now_s - began_s + 1e-9
    if quiet_frames < REST_FRAMES or lasted_s < REST_S:
        return None
    return began_s

def cars_of(scene: Scene, unchanged: Scene | None) -> dict[str, Car]:
    """All cars that a film draws, by their marks, from back to front.

    unchanged is the example as it is, if the film shows a + for it.
    """
    cars = {}
    if scene.show_methods:
        start_m = scene.to_track(scene.x_m)  # d and e need a start on the track
        for letter, (motion, correction) in METHODS.items():
            cars[letter] = Car(replace(scene, x_m=start_m, motion=motion, correction=correction))
    if scene.show_exact_mark:
        cars["o"] = Car(truth_of(scene))
    if unchanged is not None:
        cars["+"] = Car(unchanged)
    cars["*"] = Car(scene)
    return cars

def run(cars: dict[str, Car], scene: Scene, view: Scene, has_details: bool, max_frames: int,
        keys: Keys | NoKeys) -> None:
    """Show the film until a key, the car at rest or max_frames ends it, and say which it was.

    view is the scene as it is drawn: in a narrow terminal it is smaller.
    """
    car = cars["*"]
    why = "that is the frame limit"
    for dt_s, fps in paced(scene, keys, max_frames):
        # Move the cars, and settle their collisions.
        for each in cars.values():
            each.move(dt_s)
        # Draw the frame.
        places_m = {mark: each.frames[-1].x_m for mark, each in cars.items()}
        now = car.frames[-1]
        line = render_track(view, places_m, now.mark_m)
        if keys.has_colours:
            line = line.translate(COLOURED_MARKS)
        if has_details:
            line += details_text(now.x_m, now.v_mps, fps, places_m.get("o"))
        print(line)
        # Is it over?
        if scene.auto_off and rest_began_s(car) is not None:
            why = "the car is at rest"
            break
    if keys.why_quit:
        why = keys.why_quit
    frames, t_s = len(car.frames) - 1, car.frames[-1].t_s
    print(f"Stopped after {frames} frames, t = {t_s:.2f} s: {why}.", flush=True)

# ==== 7. The chart: speed against accuracy ======================================================
# What does each method cost, and how wrong is it? A column of the film is 1/m_to_px wide, in m.

SPAN_S = 20  # of simulated time: about eight bounces in example 10, enough for errors to grow
CUTS = 10  # runs of each method: with fewer, the largest error would depend on luck
CHART_FPS = [10, 30, 60, 120, 240, 480, 960]

def simulate(track: Track, fps: int, cut: int, count: int) -> list[Frame]:
    """Run for SPAN_S, and keep each count-th frame.

    It is luck at which moment of a frame the car meets a wall. So there are ten cuts of the same
    motion into frames. Cut 0 begins at the start of the scene. Each other cut begins a part of a
    frame later, at the true state of that moment.
    """
    car = Car(track)
    # The parts are elevenths, and not a half or a fifth, where round settings are a special case.
    car.start_later(cut / (CUTS + 1) / fps)
    for _ in range(SPAN_S * fps // count):
        car.move(1 / fps, count)
    return car.frames

def largest_error_m(track: Track, fps: int) -> float:
    """The largest distance from the true car in all frames of all cuts."""
    largest_m = 0.0
    for cut in range(CUTS):
        for frame in simulate(track, fps, cut, 1):
            largest_m = max(largest_m, frame.error_m())
    return largest_m

def cost_us(track: Track, fps: int) -> float:
    """How long the steps of a simulated second take, in microseconds.

    Other programs may slow this one. So the least of several runs is nearest to the time that the
    steps themselves need.
    """
    dt_s = 1 / fps
    costs_s = []
    runs = max(5, 200 // fps)  # at a low rate a run is short, so one disturbance may spoil it
    for _ in range(runs):
        x_m, v_mps = track.x_m, track.v_mps
        began_s = time.perf_counter()
        for _ in range(SPAN_S * fps):
            x_m, v_mps, _ = step(track, x_m, v_mps, dt_s)
        costs_s.append(time.perf_counter() - began_s)
    return 1e6 * min(costs_s) / SPAN_S

class Point(NamedTuple):
    """One method at one frame rate: a point of the chart."""

    fps: int
    error_m: float
    cost_us: float

def measure(track: Track, fps: int) -> dict[str, Point]:
    """Measure each of the five methods at this rate."""
    points = {}
    for letter, (motion, correction) in METHODS.items():
        method = replace(track, motion=motion, correction=correction)
        points[letter] = Point(fps, largest_error_m(method, fps), cost_us(method, fps))
    return points

ROUND_OFF_M = 1e-9  # smaller errors have no order

def order_text(series: list[Point], track_m: float) -> str:
    """The order of a method: at order 1 twice the rate divides the error by 2, at order 2 by 4."""
    if all(point.error_m < ROUND_OFF_M for point in series):
        return "none"
    # Errors as large as the track tell nothing of the order. So take those below a tenth of it.
    telling = [point for point in series if ROUND_OFF_M <= point.error_m < track_m / 10]
    if len(telling) < 3:
        return "?"  # too few for a straight line
    # error = constant / rate^order. So in logarithms the order is the slope of a straight line.
    rates = [math.log(point.fps) for point in telling]
    errors = [math.log(point.error_m) for point in telling]
    slope, _ = linear_regression(rates, errors)
    return f"{-slope:.1f}"

COLUMNS_A_DECADE, ROWS_A_DECADE = 8, 4  # a decade is from one power of ten to the next
LEAST_ERROR_M, LARGEST_ERROR_M = 1e-6, 10.0  # other errors are drawn at the edge of the picture

def error_column(error_m: float) -> int:
    """The column of an error in the picture."""
    error_m = max(error_m, LEAST_ERROR_M)
    error_m = min(error_m, LARGEST_ERROR_M)
    return round(COLUMNS_A_DECADE * math.log10(error_m / LEAST_ERROR_M))

def print_table(track: Track) -> dict[str, list[Point]]:
    """Print the table, row by row as it is measured. Returns the points of each method."""
    motions = corrections = "    "
    for letter, (motion, correction) in METHODS.items():
        motions += f"{letter}: {motion}".rjust(15)
        corrections += f"+ {correction}".rjust(15)
    print()
    print(motions)
    print(corrections)
    print(" FPS" + "  error m    us" * len(METHODS))
    points: dict[str, list[Point]] = {letter: [] for letter in METHODS}
    for fps in CHART_FPS:
        row = f"{fps:4}"
        for letter, point in measure(track, fps).items():
            points[letter].append(point)
            row += f"{point.error_m:9.1e}{point.cost_us:6.0f}"
        print(row, flush=True)
    row = "order"
    for series in points.values():
        row += order_text(series, track.length_m()).rjust(7) + " " * 8
    print(row.rstrip())
    print()
    return points

def print_picture(points: dict[str, list[Point]], column_m: float) -> None:
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
    limit = error_column(column_m)
    print("a column of the film |".rjust(10 + limit + 1))
    print("    us    <=1 um  10 um   0.1 mm  1 mm    1 cm    0.1 m   1 m     >=10 m")
    for row in range(min(rows), max(rows) + 1):
        line = f"{10 ** (row / ROWS_A_DECADE):6.0f}    "
        for column in range(error_column(LARGEST_ERROR_M) + 1):
            behind = "|" if column == limit else " "
            line += letters.get((row, column), behind)
        print(line.rstrip())

def print_answer(points: dict[str, list[Point]], column_m: float) -> None:
    """Answer the question: which methods stay within a column, and what do they cost?"""
    answers = []
    for letter, (motion, correction) in METHODS.items():
        good = []
        for point in reversed(points[letter]):  # from the highest rate down
            if point.error_m > column_m:
                break
            good.append(point)
        if good:
            cheapest = good[-1]
            text = f"  {letter}  {method_text(motion, correction):18}  "
            text += f"from {cheapest.fps:4} FPS on  {cheapest.cost_us:5.0f} us"
            answers.append((cheapest.cost_us, text))
    answers.sort()  # by the cost, which stands first
    say(f"These stay within a column of the film ({column_m:.2g} m) in all ten runs, "
        "the cheapest first:")
    for _, text in answers:
        print(text)
    if not answers:
        print("  none at these rates")

def chart(scene: Scene, number: int) -> None:
    """Measure, print the table, draw the picture and answer the question. number is the example."""
    column_m = 1 / scene.m_to_px
    say(f"Speed against accuracy. Scene {number}: {track_text(scene)}")
    say("Which method is the cheapest that stays within a column of the film? Each method runs ten "
        "times for 20 simulated seconds. Error: the largest distance from the true car. Cost: the "
        "time that a simulated second takes, in us (microseconds). Order: 1 if half the dt makes "
        "half the error, 2 if it makes a quarter, ? if fewer than three errors are more than "
        "round-off and less than a tenth of the track, none if all errors are round-off. Method e "
        "is how the true car is moved, so its error is 0.")
    points = print_table(scene)
    print_picture(points, column_m)
    say(f"{', '.join(LEGEND)}. Error to the right, cost downwards: the best are in the upper left. "
        "Where letters meet there is a +.")
    print_answer(points, column_m)
    say(f"Next: {PYTHON} airtrack.py stability {number}")

# ==== 8. The map: where methods fail ============================================================
# Which method fails at which frame rate, and how?

HOP_M = 0.001  # 1 mm: lower hops count as lying still
MAP_FPS = [1, 2, 5, 10, 30, 60, 120, 240, 1000]
VERDICTS = {  # from the worst to the best. W is not for one run, but for ten: see cell().
    "X": "out: further beyond a wall than the track is long",
    "S": "stuck: beyond the same wall all through the last 5 s",
    "H": "hops or hovers, over 1 mm off in the last 5 s, where the true car lies still",
    "W": "as G in some runs, as L in others",
    "G": "over a column off and, on average in the last 5 s, over 1 % too much energy",
    "L": "over a column off and, on average in the last 5 s, over 1 % too little energy",
    "P": "over a column off, but in the last 5 s its energy is right, as at rest",
    "-": "within a column of the film",
}
FROM_WORST_TO_BEST = list(VERDICTS)

def verdict(track: Track, column_m: float, fps: int, cut: int) -> str:
    """The letter of one run: X, S, H, G, L, P or -. (W needs several runs.)"""
    frames = simulate(track, fps, cut, max(1, fps // 10))  # every 0.1 s or, if longer, every frame
    first_late = len(frames) * 3 // 4  # here begin the last 5 of 20 s
    late = frames[first_late:]
    track_m = track.length_m()
    # X: how far beyond a wall was the car?
    # (Positive numbers are beyond the right wall, negative ones beyond the left wall.)
    beyond_m = [frame.x_m - track.to_track(frame.x_m) for frame in frames]
    if max(beyond_m) > track_m or min(beyond_m) < -track_m:
        return "X"
    # S: was it beyond the same wall all through the last 5 s?
    late_beyond_m = beyond_m[first_late:]
    if min(late_beyond_m) > 0 or max(late_beyond_m) < 0:
        return "S"
    # H: did the true car lie still all through the last 5 s, but not this one? (Its energy is
    # exactly 0 if replay has laid it on its floor.)
    true_energies = [track.energy(frame.true_m, frame.true_mps) for frame in late]
    if max(true_energies) == 0 and max(frame.error_m() for frame in late) > HOP_M:
        return "H"
    # G, L and P are for a car that is over a column off.
    if max(frame.error_m() for frame in frames) <= column_m:
        return "-"
    # G or L: how much more energy did it have than the true car? 100 % is v^2/2 at the start, and
    # what the acceleration could add on the whole length of the track.
    all_energy = track.v_mps**2 / 2 + abs(track.a_mps2) * track_m
    energies = [track.energy(frame.x_m, frame.v_mps) for frame in late]
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
    if any(letter != worst for letter in letters):
        return worst.lower()
    return worst

def stability(scene: Scene, number: int) -> None:
    """Print the map: a row for each method, a column for each rate, a letter for ten runs."""
    column_m = 1 / scene.m_to_px
    say(f"Stability. Scene {number}: {track_text(scene)}")
    say("Which methods are right, and from which frame rate on? Each runs ten times for 20 "
        "simulated seconds, and is looked at every 0.1 s or, if it is longer, every frame. A small "
        "letter: only some of the ten runs are so bad. 100 % of the energy is v^2/2 at the start + "
        "the acceleration * the length of the track. Example 20 says why hops get too much energy "
        "(H, G), and example 19 why they get too little (L).")
    print()
    print(" " * 20 + "".join([str(fps).rjust(6) for fps in MAP_FPS]) + " FPS")
    for motion in MOTIONS:
        for correction in ALL_CORRECTIONS:
            if correction in EXACT_ONLY and motion != "exact":
                continue
            method = replace(scene, motion=motion, correction=correction)
            row = method_text(motion, correction).ljust(20)
            for fps in MAP_FPS:
                letters = [verdict(method, column_m, fps, cut) for cut in range(CUTS)]
                row += cell(letters).rjust(6)
            print(row, flush=True)
    for letter, meaning in VERDICTS.items():
        print(f"{letter}  {meaning}")

# ==== 9. The law: why the map has its H, G and L ================================================
# Why do some cars hop for ever, and why do others lie still too soon?
# There is no code here. You need pen and paper.
#
# A car hops on its floor. It has started on the track, and does not meet the other wall. Up is away
# from the floor, g is the size of a, and all frames last dt. So each frame adds g * dt to the
# velocity downwards.
#
# A hop lasts from a frame in which a collision is found to the next such frame. It begins upwards,
# at the speed u, and ends downwards, at the speed w. Here is a hop with exact + surface. g is 4
# m/s^2, dt is 0.1 s, up is to the right, and a column is 1 cm. Each line has the number of its
# frame.
#     0:        *                   The hop begins on the floor (*), with u = 1.1 m/s upwards.
#     1:        |        *
#     2:        |             *
#     3:        |              *
#     4:        |           *
#     5:        |    *
#     6:  0     *                   The hop ends below the floor (0), with w = 1.3 m/s downwards.
# In truth a car comes back as fast as it left: w is u. This car comes back faster, because its
# collision is found only below the floor. The number k of a hop says how much faster:
#         w = u + k * g * dt                  here 1.3 = 1.1 + k * 0.4, so k is 1/2
# Then surface or rebound leaves the car the speed CR * w, but lifts it, too. (It should pay for the
# lift with speed.) So the next hop begins at CR * w. Call this hop 1, and the next hop 2. This is
# the law:
#         w2 = CR * w1 + k2 * g * dt
# In truth k is 0 in every hop.
#
# How large is k? In a hop of n frames the velocity downwards goes from -u to w:
#         w = n * g * dt - u                  here 1.3 = 6 * 0.4 - 1.1
# Subtract u once more. On the left, w - u is k * g * dt, by the definition of k:
#         k = n - 2 * u/(g * dt)              here 6 - 5.5 = 1/2
# And how large is n? After n frames the drawn car is n * dt * (u - n * g * dt/2) above the floor.
# This is below 0 as soon as n is above 2 * u/(g * dt). The hop ends with the first such frame:
#         n = the next whole number above 2 * u/(g * dt)          here above 5.5, so 6
# So k is the distance from 2 * u/(g * dt) to the next whole number: more than 0, and at most 1.
#
# With the lines for n and w one can foretell a film with exact + surface. Say CR is 0.8:
#         u                        2 * u/(g * dt)     n     w
#         1.1                      5.5                6     6 * 0.4 - 1.1 = 1.3
#         0.8 * 1.3 = 1.04         5.2                6     6 * 0.4 - 1.04 = 1.36
#         0.8 * 1.36 = 1.088       5.44               6     6 * 0.4 - 1.088 = 1.312
# In truth w would be 1.1, then 0.88, then 0.704. (If 2 * u/(g * dt) is a whole number, round-off
# decides whether the hop ends there or a frame later.)
#
# Compared with exact, each frame of forward adds g * dt^2/2 to the height, and each frame of
# backward takes as much. So with surface
#         forward:   n = the next whole number above 2 * u/(g * dt) + 1
#         backward:  n = the next whole number above 2 * u/(g * dt) - 1, but at least 1
# With forward k is one larger than with exact. With backward k is one smaller, if the hop has two
# frames or more. With rebound a hop begins above the floor, so it may last longer. In hops of two
# frames or more, k is more than the first number and at most the second:
#
#                  surface     rebound
#     forward      1 to 2      1 to 3
#     exact        0 to 1      0 to 2
#     backward    -1 to 0     -1 to 1
#
# (The tests check this table in every hop of many films. In hops of one frame backward may have a k
# above 0. So at 1 FPS the car of example 12 with backward + surface lies on its floor, keeps a
# velocity, and has a G in the map.)
#
# What does k do?
#     k > 0   The car gets speed from nothing. At CR = 1 it hops higher and higher (G in the map).
#             At CR < 1 it may hop for ever (H, if it hops over 1 mm high), as told below.
#     k < 0   The car loses speed. It comes to rest, even at CR = 1 (L).
#     k = 0   The car comes back as fast as it left.
#
# What does exact + conserve do? A hop that began at u has the same frames as with surface. But then
# conserve works out the speed at the floor itself, which is u. So the next hop begins at CR * u, as
# in truth. Only the hop is up to a frame too long: with u = 1.1 it has 6 frames instead of 5.5.
#
# Which hop is steady, so that the same hop follows it? Then u is CR * w. Put this into the lines
# for w and k:
#         w = n * g * dt/(1 + CR)             and             k = n * (1 - CR)/(1 + CR)
# With exact + surface k is at most 1. So a steady hop has at most (1 + CR)/(1 - CR) frames: 9 at
# CR = 0.8. Each whole n below this limit is possible, and the start of the film decides which of
# them it is. (At the limit itself the smallest error makes the hops shorter.) Hops may even get
# longer: with CR = 0.8, g * dt = 0.4 m/s and u = 0.1 m/s, hops of 1, 2, 3, 4 and 4 frames follow
# each other. In hops of one frame the car meets the floor in each frame, so it lies there. (In
# short frames the film calls steady hops of one or two frames at rest, because their energy is
# small enough.) Below CR = 1/3 only n = 1 is steady. With rebound k may be up to 2, so steady hops
# may be longer. And k is not the same in all hops of one length, so the hops may also go round in a
# cycle, as 7 7 8 9 9 8 frames.
#
# Example 20 is exact + rebound at CR = 0.8, and g * dt is 0.2 m/s. From its start the hops get
# steady at n = 9. So w is 9 * 0.2/1.8 = 1 m/s, and k is 1. The car hops like this for ever.
#
# Example 19 is backward + surface at CR = 1. There 2 * u/(g * dt) is 15.02, 14.98, 13.02, 12.98 ...
# and n is 15, 14, 13, 12 ... So k is -0.02 and -0.98 in turn, and the hops get shorter down to one
# frame: the car lies on the floor. If 2 * u/(g * dt) is a whole number, as for a car that starts
# from rest, k is 0. Then the car hops for ever, as it should, if round-off lets it.

# ==== 10. Before and after a film ===============================================================
# What is said before a film, and what after it? What happened to the cars is worked out after the
# film, from the frames that each car has kept.

class Wanted(NamedTuple):
    """What the user wants, by the words of the command line."""

    command: str | None  # chart, stability or, for a film, None
    number: int  # of the example
    typed: dict[str, str]  # the settings that replace the example's own, as they were typed
    changes: dict[str, Any]  # their values
    has_details: bool
    is_fast: bool
    max_frames: int

class Shown(NamedTuple):
    """What a film shows."""

    scene: Scene
    unchanged: Scene | None  # the example as it is, if a + is drawn for it
    texts: Example  # the one whose texts fit

def is_beyond_a_wall(car: Car) -> bool:
    """Whether the car was beyond a wall in all of its last ten frames, not only after a bounce."""
    return not any(car.track.has_on_it(frame.x_m) for frame in car.frames[-10:])

def energy_text(energy: float) -> str:
    """An energy with up to four significant digits."""
    if 0 < energy < 0.001:
        return "<0.001"
    return f"{energy:.4g}"

def hops_text(car: Car) -> str:
    """How many frames there are from bounce to bounce. Of many, the first four and the last two."""
    bounces = [number for number, frame in enumerate(car.frames) if frame.mark_m is not None]
    hops = [str(after - before) for before, after in pairwise(bounces)]
    if len(hops) > 6:
        hops = [*hops[:4], "...", *hops[-2:]]
    return " ".join(hops)

def end_text(car: Car) -> str:
    """What the car does at the end of the film."""
    began_s = rest_began_s(car)
    if began_s is not None:
        return f"at rest from {began_s:.2f} s on"
    if is_beyond_a_wall(car):
        return "is beyond a wall"
    return "still moves"

def table_row(mark: str, car: Car) -> str:
    """A car's row of the table: its method, how far off it was, and its energies."""
    if mark == "o":
        row = f"{'o the truth':35}"
    else:
        furthest_m = max(frame.error_m() for frame in car.frames)
        off = "under 1 mm" if furthest_m < 0.001 else f"{furthest_m:.4g} m"
        row = f"{mark} {method_text(car.track.motion, car.track.correction):20}{off:>13}"
    energies = [car.track.energy(frame.x_m, frame.v_mps) for frame in car.frames]
    for energy in (energies[0], min(energies), max(energies), energies[-1]):
        row += energy_text(energy).rjust(11)
    return row

def tell_cars(cars: dict[str, Car]) -> None:
    """Print a table with a row for each car, and a line for its hops and its end."""
    marks = [mark for mark in ("*", "o", "+", *METHODS) if mark in cars]
    print()
    print("                      furthest from    energy in J/kg")
    print("                     its own truth      first      least       most       last")
    for mark in marks:
        print(table_row(mark, cars[mark]))
    print("Energy 0: it lies on the wall to which it is accelerated. Below 0: beyond it.")
    print("A car that stays on the track is never further off than the track is long.")
    print("The hops in frames, each from one bounce to the next, and the end:")
    for mark in marks:
        words = [hops_text(cars[mark]), end_text(cars[mark])]
        print(mark, "; ".join([text for text in words if text]))
    print("At rest: for 0.3 s and ten frames it had too little energy to rise above its")
    print("floor by 5 cm, or by more than 3 mm + |a| dt^2/2. (If a is 0: it stood still.)")

def title_text(wanted: Wanted) -> str:
    """Which scene the film is of, and what the user changed."""
    title = OWN_SCENE.title
    if wanted.number in EXAMPLES:
        title = f"Example {wanted.number}: {EXAMPLES[wanted.number].title}"
    changes = [f"{name}={text}" for name, text in wanted.typed.items()]
    return ", ".join([title, *changes])

def scene_text(scene: Scene) -> str:
    """All that moves the car, in words."""
    text = f"{track_text(scene)}; {method_text(scene.motion, scene.correction)}"
    text += f", {scene.fps_target:.10g} FPS"
    if scene.jitter > 0:
        text += f", jitter={scene.jitter:.10g}"
    if scene.use_observed_dt:
        text += ", use_observed_dt=True"
    if not scene.has_on_it(scene.x_m):
        text += "; it starts beyond a wall"
    if scene.show_methods:
        text = "; ".join([text, *LEGEND])
    return text

# Chart and map use these settings alone. They choose methods and frame rates themselves.
FOR_COMMANDS = ["x_m", "v_mps", "a_mps2", "left_edge_m", "right_edge_m", "CR", "m_to_px",
                "width_px"]

def say_after(wanted: Wanted, shown: Shown) -> None:
    """Say what was to be seen or, where nobody knows it, what to try. Then say what comes next."""
    print()
    say(shown.texts.seen)
    if shown.texts in (CHANGED, CHANGED_FRAMES, OWN_SCENE):
        say("The map calls a method right if its car is never further off than a column of the "
            f"film, which is {1 / shown.scene.m_to_px:.2g} m wide there:")
        words = [f"{name}={text}" for name, text in wanted.typed.items() if name in FOR_COMMANDS]
        print(PYTHON, "airtrack.py stability", wanted.number, *words)
    following = wanted.number + 1 if wanted.number + 1 in EXAMPLES else "chart"
    say(f"Next: {PYTHON} airtrack.py {following}")

def film(wanted: Wanted, shown: Shown) -> None:
    """Say what to look for, leave time to guess, show the film, and say what was to be seen."""
    scene = shown.scene
    example = EXAMPLES.get(wanted.number, OWN_SCENE)
    has_details = wanted.has_details or example.has_details
    say(title_text(wanted))
    say(scene_text(scene))
    view = fitted(scene, has_details)
    if view.width_px < scene.width_px:
        say(f"The picture is drawn {view.width_px} columns wide, to fit into the terminal.")
    cars = cars_of(scene, shown.unchanged)
    taking = nullcontext(NoKeys()) if wanted.is_fast else taken_keys()  # NoKeys takes nothing
    with taking as keys:
        for text in keys.texts_before(shown.texts.look_for):
            say(text)
        keys.leave_time()
        print()
        run(cars, scene, view, has_details, wanted.max_frames, keys)
    if len(cars["*"].frames) == 1:
        return  # it was ended before it began
    tell_cars(cars)
    if not wanted.is_fast:
        say_after(wanted, shown)

# ==== 11. Settings ==============================================================================
# What does each setting mean, and what may it be?

class Setting(NamedTuple):
    """A setting's meaning, and what is allowed: a number from least to largest, or a choice."""

    meaning: str
    least: float = 0
    largest: float = 0
    choices: tuple[Any, ...] = ()

YES_OR_NO = (False, True)
SETTINGS = {
    "x_m": Setting("start position in m", -1000, 1000),
    "v_mps": Setting("start velocity in m/s, to the right", -1000, 1000),
    "a_mps2": Setting("acceleration in m/s^2, to the right", -1000, 1000),
    "left_edge_m": Setting("position of the left wall in m", -1000, 1000),
    "right_edge_m": Setting("position of the right wall in m", -1000, 1000),
    "CR": Setting("speed after a bounce / speed before it", 0, 1),
    "motion": Setting("how the car is moved", choices=tuple(MOTIONS)),
    "correction": Setting("how a collision is settled", choices=tuple(ALL_CORRECTIONS)),
    "fps_target": Setting("frames a second, 1/dt", 0.1, 1000),
    "use_observed_dt": Setting("dt is how long the frame lasted", choices=YES_OR_NO),
    "jitter": Setting("frames vary by up to this part", 0, 0.9),
    "auto_off": Setting("stop when the car is at rest", choices=YES_OR_NO),
    "m_to_px": Setting("zoom in columns for each m", 0.001, 1000),
    "width_px": Setting("width of the picture in columns", 10, 1000),
    "show_start_mark": Setting("draw a . at the start", choices=YES_OR_NO),
    "show_collision_mark": Setting("draw a 0 where a move ended", choices=YES_OR_NO),
    "show_exact_mark": Setting("draw an o for the true car", choices=YES_OR_NO),
    "show_methods": Setting("draw a to e for five methods", choices=YES_OR_NO),
}

def allowed_text(name: str) -> str:
    """What a setting may be, in words."""
    setting = SETTINGS[name]
    if setting.choices:
        *others, last = [str(choice) for choice in setting.choices]
        return f"{', '.join(others)} or {last}"
    kind = "a whole number" if name == "width_px" else "a number"
    return f"{kind} from {setting.least} to {setting.largest}"

def is_allowed(name: str, value: Any) -> bool:
    """Whether the setting of this name may have this value."""
    setting = SETTINGS[name]
    if setting.choices:
        return value in setting.choices
    return bool(setting.least <= value <= setting.largest)

def check(track: Track) -> None:
    """Raise ValueError for a Track or a Scene that is not allowed."""
    for each in fields(track):
        value = getattr(track, each.name)
        if not is_allowed(each.name, value):
            raise ValueError(f"{each.name} must be {allowed_text(each.name)}, not {value}")
    left_m, right_m = track.left_edge_m, track.right_edge_m
    if right_m - left_m < 0.01 - 1e-9:  # round-off: 2.21 - 2.2 is a little less than 0.01
        raise ValueError(f"right_edge_m must be left_edge_m + 0.01 or more, so from "
                         f"{left_m + 0.01:.10g} on, not {right_m}")
    condition = f"with correction={track.correction}"
    if track.correction in EXACT_ONLY and track.motion != "exact":
        raise ValueError(f"motion must be exact {condition}, not {track.motion}: choose "
                         "motion=exact or another correction")
    if track.correction in EXACT_ONLY and not track.has_on_it(track.x_m):
        raise ValueError(f"x_m must be from {left_m} to {right_m} {condition}, not {track.x_m}: "
                         "choose a start on the track or another correction")

# ==== 12. The command line ======================================================================
# What does the user want?

FRAMES = 50_000  # a film that nobody stops ends then
COMMANDS = {"chart": chart, "stability": stability}
DEFAULTS = vars(Scene())
OF_THE_TRACK = [each.name for each in fields(Track)]
OF_THE_FRAMES = ["fps_target", "use_observed_dt", "jitter"]

# What people type because other programs have it, and what it is called here:
OTHER_NAMES = {"fps": "fps_target", "dt": "fps_target", "g": "a_mps2", "gravity": "a_mps2",
               "a": "a_mps2", "acceleration": "a_mps2", "left": "left_edge_m",
               "right": "right_edge_m", "x": "x_m", "position": "x_m", "h": "x_m", "v": "v_mps",
               "speed": "v_mps", "velocity": "v_mps", "e": "CR", "restitution": "CR",
               "zoom": "m_to_px", "map": "stability", "details": "d", "help": "-h",
               "fast": "--fast", "frames": "--frames"}

def hint(word: str) -> str:
    """What may have been meant by an unknown word."""
    # What is meant, by what may be typed:
    hints = OTHER_NAMES | {each.lower(): each for each in [*SETTINGS, *COMMANDS]}
    hints |= {each: f"motion={each}" for each in MOTIONS}
    hints |= {each: f"correction={each}" for each in ALL_CORRECTIONS}
    # With a lower cutoff more hints are wrong: a_mps2 for grafik, as that is like gravity.
    near = difflib.get_close_matches(word.lower().lstrip("-"), hints, n=1, cutoff=0.7)
    if not near:
        return "-h lists all that there are"
    name = hints[near[0]]
    if name in SETTINGS:
        name = f"{name}=VALUE ({SETTINGS[name].meaning})"
    return f"did you mean {name}?"

def name_and_text(word: str) -> tuple[str, str]:
    """The two parts of NAME=VALUE. Raises ValueError for any other word."""
    name, _, text = word.partition("=")
    if name in SETTINGS and text:
        return name, text
    name, _, _ = name.partition(":")
    if name in SETTINGS:  # as in CR 0.7, CR = 0.7 or CR:0.7
        raise ValueError(f"write {name}=VALUE as one word: {name} must be {allowed_text(name)}")
    raise ValueError(f"unknown word {word}: {hint(name)}")

def value_of(name: str, text: str) -> Any:
    """The value of a setting, from what a user typed after NAME=. Raises ValueError."""
    fault = f"{name} must be {allowed_text(name)}, not {text}"
    choices = SETTINGS[name].choices
    if choices:
        for choice in choices:
            if text.lower() == str(choice).lower():
                return choice
        raise ValueError(fault)
    if "," in text:
        raise ValueError(f"{fault}: write a decimal point, not a comma")
    try:
        value = int(text) if name == "width_px" else float(text)
    except ValueError:
        raise ValueError(fault) from None
    if not is_allowed(name, value):
        raise ValueError(fault)
    return value

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
    for name, setting in SETTINGS.items():
        row = f"  {name:20}{DEFAULTS[name]!s:9}{setting.meaning} ({allowed_text(name)})"
        lines.append(textwrap.fill(row, 80, subsequent_indent=" " * 31))
    return "\n".join(lines)

def make_parser() -> argparse.ArgumentParser:
    """What argparse needs to know of the command line. It adds -h by itself."""
    parser = argparse.ArgumentParser(
        prog="airtrack.py", description=__doc__, epilog=epilog(),
        formatter_class=argparse.RawDescriptionHelpFormatter)  # it leaves our lines as they are
    parser.add_argument("words", nargs="*", metavar="WORD", help="see above")
    parser.add_argument("-d", "-D", dest="details", action="store_true", help="as the word d")
    parser.add_argument("--fast", action="store_true", help="no waiting, keys, colours, last text")
    parser.add_argument("--frames", metavar="N", default=str(FRAMES),
                        help=f"stop after N frames; without it, after {FRAMES}")
    return parser

class Words(NamedTuple):
    """The words of the command line, sorted."""

    commands: list[str]
    numbers: list[int]
    typed: dict[str, str]  # NAME=VALUE
    has_details: bool  # whether d is one of them

def sorted_words(words: list[str]) -> Words:
    """Sort the words of the command line. Raises ValueError for an unknown one."""
    commands, numbers, typed = [], [], {}
    for word in words:
        if word in COMMANDS:
            commands.append(word)
        elif word.removeprefix("-").isdecimal():  # -5 is a number, too
            numbers.append(int(word))
        elif word not in ("d", "D"):
            name, text = name_and_text(word)
            typed[name] = text
    return Words(commands, numbers, typed, "d" in words or "D" in words)

def wanted_by(options: argparse.Namespace, unknown_options: list[str]) -> Wanted:
    """What the words and options of the command line ask for. Raises ValueError."""
    commands, numbers, typed, has_d = sorted_words([*options.words, *unknown_options])
    if len(commands) > 1 or len(numbers) > 1:
        found = [str(each) for each in [*commands, *numbers]]
        raise ValueError(f"one command and one EXAMPLE at a time, not {', '.join(found)}")
    if not options.frames.isdecimal() or int(options.frames) == 0:
        raise ValueError(f"--frames N must be a whole number from 1 up, not {options.frames}")
    command, number = None, 1
    if commands:
        command, number = commands[0], 12
    if numbers:
        number = numbers[0]
    changes = {name: value_of(name, text) for name, text in typed.items()}
    return Wanted(command, number, typed, changes, has_details=options.details or has_d,
                  is_fast=options.fast, max_frames=int(options.frames))

def shown_by(wanted: Wanted) -> Shown:
    """What the film shows. Raises ValueError for settings that exclude each other."""
    changes = wanted.changes
    if wanted.number not in EXAMPLES:
        return Shown(scene_of(OWN_SCENE.settings | changes), None, OWN_SCENE)
    example = EXAMPLES[wanted.number]
    as_it_is = DEFAULTS | example.settings
    changed = [name for name in changes if changes[name] != as_it_is[name]]
    changes_track = any(name in OF_THE_TRACK for name in changed)
    changes_frames = any(name in OF_THE_FRAMES for name in changed)
    if not changes_track and not changes_frames:
        return Shown(scene_of(example.settings | changes), None, example)
    # Nobody knows what happens in a changed example. So the film shows its true car.
    scene = scene_of(example.settings | {"show_exact_mark": True} | changes)
    if changes_frames:
        return Shown(scene, None, CHANGED_FRAMES)  # a + would need frames of its own
    return Shown(scene, scene_of(example.settings), CHANGED)

def compared_by(wanted: Wanted) -> Scene:
    """The scene of a chart or a map. Raises ValueError for what these do not take."""
    refused = [name for name in wanted.changes if name not in FOR_COMMANDS]
    if refused:
        raise ValueError(f"{wanted.command} takes no {refused[0]}: it chooses methods and frame "
                         f"rates itself, and takes an EXAMPLE and {', '.join(FOR_COMMANDS)}")
    if wanted.has_details or wanted.is_fast or wanted.max_frames != FRAMES:
        raise ValueError(f"{wanted.command} is no film: it takes no d, --fast or --frames")
    settings = EXAMPLES.get(wanted.number, OWN_SCENE).settings | wanted.changes
    scene = scene_of({name: settings[name] for name in FOR_COMMANDS if name in settings})
    return replace(scene, x_m=scene.to_track(scene.x_m))  # a start beyond a wall is not compared

def main(argv: list[str] | None = None) -> int:
    """Do what argv or, without it, the command line asks for. Returns the exit status."""
    parser = make_parser()
    options, unknown_options = parser.parse_known_intermixed_args(argv)
    try:
        # First check all that was typed. A partial is a function that has its arguments already.
        wanted = wanted_by(options, unknown_options)
        if wanted.command is None:
            show = partial(film, wanted, shown_by(wanted))
        else:
            show = partial(COMMANDS[wanted.command], compared_by(wanted), wanted.number)
    except ValueError as fault:
        parser.error(str(fault))  # this prints the text and ends the program with status 2
    try:
        show()
        sys.stdout.flush()
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
