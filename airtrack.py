#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text a frame.
So its film is a graph: position to the right, time downwards.

    python airtrack.py [EXAMPLE] [d] [NAME=VALUE ...] [--fast] [--frames N]
    python airtrack.py chart [EXAMPLE] [NAME=VALUE ...] [--save FILE]
    python airtrack.py stability [EXAMPLE] [NAME=VALUE ...]

    chart        speed against accuracy; --save draws it as .png, .svg or .pdf
    stability    the map: where methods fail
    EXAMPLE      its number, listed by -h; default 0, for chart and stability 10
    d            details after each line: position, velocity, frame rate
    NAME=VALUE   a setting, listed by -h, on top of the example's own
    --fast       no pacing, no pauses, no keys: for a pipe or a file
    --frames N   stop after N frames; without it, after 50000
"""
# Sections 1 to 7 are the lesson: read them from the top. examples.py has the examples and the keys.

import difflib
import math
import os
import re
import shutil
import sys
import textwrap
import time
import timeit
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import nullcontext
from dataclasses import Field, dataclass, field, fields, replace
from functools import cache
from itertools import count, pairwise, takewhile
from statistics import fmean
from typing import Any

from examples import EXAMPLES, OWN_SCENE, Keys, taken_keys

# ==== 1. Moving: where is the car dt_s later, if there are no walls? ============================
#     x_m, v_mps   the car's position (m) and velocity (m/s), positive to the right
#     a_mps2       its constant acceleration (m/s^2): the pull
#     dt_s         the time step (s): how long a frame lasts
#
# The pull changes v during the frame. Euler's methods ignore this: they move the car at the same
# velocity all through the frame. forward takes that of the frame's start, backward that of its end.
# (For a constant a, backward is the same as semi-implicit Euler.) Both are of first order: half the
# dt makes half the error after a given time. exact has no error if a is constant. In free flight
# the car's energy should not change. Per kilogram it is E = v^2/2 - a x, and each docstring says
# what a step does to it. (Friction would go into these functions, as an a that depends on v.)

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

MOTIONS = {"forward": forward, "backward": backward, "exact": exact}  # name a new one here

# ==== 2. Colliding: the stickiness corrections ==================================================
#     wall_m       the position of a wall (m)
#     CR           the coefficient of restitution: speed after a bounce / speed before
#
# A collision is found when a move has ended beyond a wall. A correction takes the x and v of that
# moment, and returns the x and v after the bounce. The overlap, x - wall, is how far beyond the
# wall the car is (it is negative at the left wall). Why "stickiness"? Without a correction the car
# may stick in the wall: see none(). Section 7 tells what becomes of a car that hops on a wall.

def none(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Reverse v, but leave the car beyond the wall. It may never get out.

    A frame later the car may still be beyond the wall. Perhaps CR < 1 has slowed it (example 3). Or
    the way out is shorter than the way in, as with backward under a pull towards the wall, and with
    forward under a pull away from it. Then v is reversed again, into the wall: the car is caught.
    """
    return x_m, -CR * v_mps

def surface(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car on the wall.

    If the pull is into the wall, this moves the car against the pull. That should cost speed, but v
    is not made smaller for it. So the car has too much energy.
    """
    return wall_m, -CR * v_mps

def rebound(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car in front of the wall, CR * overlap away. Without a pull it would be there by now.

    If the pull is into the wall, the car has too much energy, for the same reason as with surface.
    If CR * overlap is longer than the track, the car is thrown out (example 14).
    """
    overlap_m = x_m - wall_m
    return wall_m - CR * overlap_m, -CR * v_mps

def conserve(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car where rebound does, at the speed with which it has the right energy there.

    If this energy is too small to get there, put the car on the wall. With the exact motion, if a
    bounce is found, only its moment is wrong. This error is of second order: with half the dt it is
    a quarter as large. Conserve may throw the car out, too, as rebound does.
    """
    overlap_m = x_m - wall_m
    # Take the car back to the wall. E is constant: w^2 = v^2 - 2 a overlap. The bounce leaves CR w.
    bounced_mps = CR * math.sqrt(max(0.0, v_mps * v_mps - 2 * a_mps2 * overlap_m))
    # Take it to its new place. E is constant again: u^2 = (CR w)^2 - 2 a CR overlap.
    u_squared = bounced_mps * bounced_mps - 2 * a_mps2 * CR * overlap_m
    if u_squared < 0:
        return wall_m, math.copysign(bounced_mps, -overlap_m)
    return wall_m - CR * overlap_m, math.copysign(math.sqrt(u_squared), -overlap_m)

def arrival(d_m: float, u_mps: float, a_mps2: float) -> tuple[float, float]:
    """When the car reaches a wall d_m ahead, and how fast it is there: t_s, w_mps.

    u_mps is its velocity now. u_mps and a_mps2 are positive if they point towards the wall.
    """
    # Energy gives the speed w at the wall: w^2 = u^2 + 2 a d. (Round-off may make it negative.)
    w_mps = math.sqrt(max(0.0, u_mps * u_mps + 2 * a_mps2 * d_m))
    # The time t follows from the mean velocity, d = t (u + w)/2, or from w = u + a t. If u > 0 take
    # the first, as w - u may be mostly round-off; otherwise the second, as u + w may be that.
    return (2 * d_m / (u_mps + w_mps) if u_mps > 0 else (w_mps - u_mps) / a_mps2), w_mps

def rewind(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Take the car back in time to the wall, let it bounce, and move it on to the frame's end.

    With the exact motion this is right if the frame holds one bounce and the move ends beyond the
    wall (example 10). Rewind cannot settle a second bounce. If the pull brings the car back on the
    track before the frame ends, no collision is found: a missed event (example 18).
    """
    # Let time run backwards: v changes its sign, a does not, and the car arrives at the wall.
    side = math.copysign(1, x_m - wall_m)  # 1 beyond the right wall, -1 beyond the left one
    t_s, w_mps = arrival(abs(x_m - wall_m), side * v_mps, -side * a_mps2)
    x_m, v_mps = exact(wall_m, -side * CR * w_mps, a_mps2, t_s)
    return (wall_m if side * (x_m - wall_m) > 0 else x_m), v_mps  # beyond again: on the wall

CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "conserve": conserve,
               "rewind": rewind}
EVERY_CORRECTION = (*CORRECTIONS, "replay")  # replay redoes the whole frame: see section 4
EXACT_ONLY = ("rewind", "replay")  # they need the exact motion
# The five methods that example 21 and the chart compare, by their letters:
METHODS = {"a": ("backward", "rebound"), "b": ("exact", "rebound"), "c": ("exact", "conserve"),
           "d": ("exact", "rewind"), "e": ("exact", "replay")}

# ==== 3. The scene: all that a run starts from ==================================================

def setting(default: Any, meaning: str, allowed: Any = (False, True), unit: str = "") -> Any:
    """A row of the table below. allowed: a number's least and largest value, or all the choices."""
    return field(default=default, metadata={"meaning": meaning, "allowed": allowed, "unit": unit})

@dataclass(frozen=True)
class Scene:
    """The settings. The default method is that of the tutorial in README.md. Raises BadInput."""

    x_m: float = setting(1.1, "starting position", (-1000, 1000), "m")
    v_mps: float = setting(0.0, "starting velocity: speed to the right", (-1000, 1000), "m/s")
    a_mps2: float = setting(0.0, "acceleration: the pull, gravity g", (-1000, 1000), "m/s^2")
    left_edge_m: float = setting(0.25, "the left wall", (-1000, 1000), "m")
    right_edge_m: float = setting(2.2, "the right wall", (-1000, 1000), "m")
    CR: float = setting(0.8, "coefficient of restitution: speed after / before a bounce", (0, 1))
    motion: str = setting("backward", "how the car is moved", tuple(MOTIONS))
    correction: str = setting("rebound", "stickiness correction of a collision", EVERY_CORRECTION)
    fps_target: float = setting(30.0, "frames a second; time step dt = 1/fps", (0.1, 1000), "1/s")
    use_observed_dt: bool = setting(False, "dt is the time that the frame before took")
    jitter: float = setting(0.0, "frame lengths vary by up to this fraction", (0, 0.9))
    auto_off: bool = setting(True, "stop when the car rests against a wall")
    m_to_px: float = setting(55.0, "zoom; a pixel is a character", (0.001, 1000), "px/m")
    width_px: int = setting(135, "width of the picture, which begins at x = 0", (10, 1000), "px")
    show_start_mark: bool = setting(False, "draw a . where the car started")
    show_collision_mark: bool = setting(True, "in a collision, draw a 0 where the move ended")
    show_exact_mark: bool = setting(False, "draw an o where the car truly is")
    show_methods: bool = setting(False, "draw a to e where the chart's methods have the car")

    def __post_init__(self) -> None:
        check(self)

    def to_track(self, x_m: float) -> float:
        """Return x_m itself or, if x_m is beyond a wall, the position of that wall."""
        if x_m < self.left_edge_m:
            return self.left_edge_m
        return self.right_edge_m if x_m > self.right_edge_m else x_m

# ==== 4. A frame ================================================================================

def step(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, float | None]:
    """One frame of dt_s: move the car, then settle any collision. Returns x_m, v_mps, mark_m.

    mark_m is None or, in a collision, where the move alone ended. So one sees how deep it was.
    """
    free_m, free_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, dt_s)
    on_track_m = scene.to_track(free_m)  # the wall, if the move ended beyond one
    is_beyond = on_track_m != free_m
    # Replay is called also if v changed sign: the car may have been beyond a wall and come back.
    if scene.correction == "replay" and (is_beyond or v_mps * free_mps < 0):
        x_m, v_mps = replay(scene, x_m, v_mps, dt_s)
        is_bounce = is_beyond or v_mps != free_mps  # without a bounce, v is that of the move
        return x_m, v_mps, (free_m if is_bounce else None)
    if is_beyond:
        correction = CORRECTIONS[scene.correction]
        return *correction(free_m, free_mps, on_track_m, scene.a_mps2, scene.CR), free_m
    return free_m, free_mps, None

GRAZE_M = 5e-11  # far more than the round-off of a position

def replay(scene: Scene, x_m: float, v_mps: float, t_s: float) -> State:
    """Replace the move: follow the exact motion from the frame's start, from bounce to bounce.

    This is right for several bounces in a frame (example 15), and even for infinitely many. The
    tests compare it with a reference of 60 digits. Think of a ball in a room. The wall that the car
    is pulled to is the floor, the other one is the ceiling, and h is the height above the floor. If
    the ball is on the floor and too slow for the ceiling, hops() takes all its whole hops at once.

    A graze is a touch of the ceiling at almost no speed. Round-off would decide whether there is a
    touch. So a ball that would rise less than GRAZE_M higher than the ceiling turns without one.
    With the default walls, each such miss makes an error of up to 4e-5 m, and these errors add up.
    """
    up, floor_m = (-1, scene.right_edge_m) if scene.a_mps2 > 0 else (1, scene.left_edge_m)
    room_m, g_mps2, CR = scene.right_edge_m - scene.left_edge_m, abs(scene.a_mps2), scene.CR
    h_m, v_mps = up * (scene.to_track(x_m) - floor_m), up * v_mps
    while v_mps or g_mps2:  # otherwise it rests for good. t_s is what is left of the frame.
        if v_mps > 0 and v_mps * v_mps >= 2 * g_mps2 * (room_m - h_m + GRAZE_M):  # to the ceiling
            flight_s, w_mps = arrival(room_m - h_m, v_mps, -g_mps2)
            bounced = room_m, -CR * w_mps
        elif v_mps < 0 or h_m > 0:  # falling, now or soon: to the floor
            flight_s, w_mps = arrival(h_m, -v_mps, g_mps2)
            bounced = 0.0, CR * w_mps
        else:  # on the floor, and too slow for the ceiling: hops until the frame's end
            t_s, v_mps = hops(v_mps, g_mps2, CR, t_s)
            break
        if flight_s > t_s:
            break  # the frame ends in flight
        t_s -= flight_s
        h_m, v_mps = bounced
    h_m, v_mps = exact(h_m, v_mps, -g_mps2, t_s)
    return scene.to_track(floor_m + up * h_m), up * v_mps  # round-off must not leave it beyond

def hops(v_mps: float, g_mps2: float, CR: float, t_s: float) -> tuple[float, float]:
    """Take in one go all whole hops that fit into t_s. Returns the time that is left, and v then.

    The first hop lasts T = 2 v/g, and each hop CR times as long as the one before. So all of them,
    infinitely many, last T (1 + CR + CR^2 + ...) = T/(1 - CR). Then comes the Zeno point: rest.
    """
    hop_s = 2 * v_mps / g_mps2
    zeno_s = hop_s / (1 - CR) if CR < 1 else math.inf
    if hop_s > t_s:  # not even one hop fits
        return t_s, v_mps
    if zeno_s <= t_s or t_s + hop_s == t_s:  # all fit, or hop_s is lost in round-off
        return 0.0, 0.0
    if CR == 1:
        return math.fmod(t_s, hop_s), v_mps
    # n hops last zeno_s (1 - CR^n). log1p(y) is log(1 + y) and expm1(y) is e^y - 1, precisely.
    n = math.floor(math.log1p(-t_s / zeno_s) / math.log(CR))
    return t_s + zeno_s * math.expm1(n * math.log(CR)), v_mps * CR**n

# ==== 5. Drawing: one frame, one line, painted from back to front ===============================

def paint(line: bytearray, mark: str, x_px: float) -> None:
    """Paint the mark in its column, over what is there, if the line has that column."""
    column = round(x_px)  # int would put -0.9 into column 0
    if 0 <= column < len(line):
        line[column] = ord(mark)

def render_track(scene: Scene, x_m: float, mark_m: float | None = None,
                 others: Mapping[str, State] = {}) -> str:
    """The line of a frame: scene.width_px characters. others: the other cars, by their marks."""
    line, zoom = bytearray(b" " * scene.width_px), scene.m_to_px
    if scene.show_collision_mark and mark_m is not None:
        paint(line, "0", mark_m * zoom)
    if scene.show_start_mark:
        paint(line, ".", scene.x_m * zoom)
    for mark in others:
        paint(line, mark, others[mark][0] * zoom)
    paint(line, "|", scene.left_edge_m * zoom)
    paint(line, "|", scene.right_edge_m * zoom)
    column, last = round(x_m * zoom), scene.width_px - 1
    # The car comes last, so no wall hides it. Outside the picture it is < or >, at the edge.
    mark, column = ("<", 0) if column < 0 else (">", last) if column > last else ("*", column)
    paint(line, mark, column)
    return line.decode()

def details_text(x_m: float, v_mps: float, fps: float, truth: State | None) -> str:
    """What d adds to a line: position, velocity, frame rate and, given the truth, the error."""
    text = f"x = {x_m:6.2f}, v = {v_mps:5.2f}, FPS = {fps:3.0f}"
    return f"{text}, err = {x_m - truth[0]:9.2e}" if truth else text

# ==== 6. The run: the main loop =================================================================

def planned(scene: Scene) -> Iterator[tuple[float, float]]:
    """Yield how long each frame should last, and the target rate (FPS), the same in every run."""
    for frame in count(1):
        fraction = 0.618 * frame % 1  # from 0 to 1; the golden ratio's 0.618 spreads it evenly
        yield (1 + scene.jitter * (2 * fraction - 1)) / scene.fps_target, scene.fps_target

STALL_S, STALL_FRAMES = 0.15, 1.5  # a stall: over 0.15 s, and over 1.5 times as long as due
LATE_S = 0.02  # a delay of at most this, or of at most a frame, is made up by the next frames

def paced(scene: Scene, keys: Keys) -> Iterator[tuple[float, float]]:
    """Wait until each frame is due. Yield how long the last one took, and the rate (FPS).

    After a pause or a stall the planned length counts, so that the car does not leap. The deadlines
    are absolute. If each frame slept for dt, it would last dt plus the time to compute and print.
    """
    began_s = deadline_s = time.perf_counter() - 1 / scene.fps_target  # the first is due about now
    for due_s, fps in planned(scene):
        deadline_s += due_s
        was_paused = keys.wait_until(deadline_s)
        if keys.why_quit:
            return
        now_s = time.perf_counter()
        took_s = now_s - began_s or due_s  # the difference is 0 if the clock has not ticked yet
        rate = fps if was_paused else 1 / took_s
        if was_paused or took_s > max(STALL_S, STALL_FRAMES * due_s):
            took_s = due_s
        yield took_s, rate
        began_s = now_s
        if was_paused or now_s > deadline_s + max(LATE_S, due_s):  # do not race to catch up
            deadline_s = now_s

def truth_of(scene: Scene) -> Scene:
    """The same scene, solved exactly. A start beyond a wall is moved to the wall."""
    return replace(scene, motion="exact", correction="replay", x_m=scene.to_track(scene.x_m))

def scenes_beside(scene: Scene) -> dict[str, Scene]:
    """The scenes of the film's other cars, by their marks, from back to front."""
    truth = truth_of(scene)
    methods = {letter: replace(truth, motion=motion, correction=correction)
               for letter, (motion, correction) in METHODS.items() if scene.show_methods}
    return methods | ({"o": truth} if scene.show_exact_mark else {})

def is_at_rest(scene: Scene, v_mps: float, last_m: deque[float]) -> bool:
    """Whether the car rests against the wall that it is pulled to or, without a pull, against any.

    It rests if in the last frames its mean distance from the wall is at most 1 mm, and if its v is
    at most what the pull adds in that time. (The pull may give it some v in each frame.)
    """
    side = scene.a_mps2 or last_m[-1] - (scene.left_edge_m + scene.right_edge_m) / 2
    wall_m = scene.right_edge_m if side > 0 else scene.left_edge_m
    most_m = 0.001 * len(last_m)  # the sum of the distances if their mean is 1 mm
    return (abs(last_m[-1] - wall_m) <= most_m and len(last_m) == last_m.maxlen
            and abs(v_mps) <= abs(scene.a_mps2) * len(last_m) / scene.fps_target
            and sum(abs(x_m - wall_m) for x_m in last_m) <= most_m)

def run(scene: Scene, details: bool, max_frames: int, keys: Keys | None) -> None:
    """Film the scene until a key, the car at rest or max_frames ends it, and say which it was."""
    x_m, v_mps = scene.x_m, scene.v_mps
    beside = scenes_beside(scene)
    others = {mark: (other.x_m, other.v_mps) for mark, other in beside.items()}
    last_m = deque[float](maxlen=max(10, round(scene.fps_target / 3)))  # 1/3 s, at least 10
    frame, t_s, why = 0, 0.0, "that is the frame limit"
    beats = paced(scene, keys) if keys else planned(scene)
    for frame, (length_s, fps) in zip(range(1, max_frames + 1), beats):  # no wait after the last
        # Move the car and settle its collision; then do the same for the other cars, if any.
        dt_s = length_s if scene.use_observed_dt else 1 / scene.fps_target
        t_s += dt_s
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        others = others and {mark: step(beside[mark], *xv, dt_s)[:2] for mark, xv in others.items()}
        # Draw. Only a terminal gets colours.
        line = render_track(scene, x_m, mark_m, others)
        text = details_text(x_m, v_mps, fps, others.get("o")) if details else ""
        sys.stdout.write(f"{inked(line) if keys else line}{text}\n")
        if keys:
            keys.count(frame, t_s)
        # Is it at rest?
        last_m.append(x_m)
        if scene.auto_off and is_at_rest(scene, v_mps, last_m):
            why = "the car is at rest against a wall"
            break
    if keys:
        why = keys.why_quit or why
    print(f"Stopped after {frame} frame{'s' * (frame != 1)}, t = {t_s:.2f} s: {why}.", flush=True)

# ==== 7. The law of the hops ====================================================================
# A car hops on the wall that it is pulled to. Think of this wall as a floor: up is away from it.
# Each hop should last CR times as long as the one before. Count a hop in lines of the film, from
# one in which a bounce is found to the next such line. Then a long hop is followed, on average, by
#     next = CR (hop + k) + k    lines, where k is the motion's number plus the correction's:
#     forward 1   exact 0   backward -1    surface 1/2   rebound 1   conserve 0   none 0 (at CR = 1)
# Rewind and replay need no number: where they are right, their hops are right, too. Here is a hop
# of 9 lines with exact + rebound, so k is 1. The law predicts 0.8 (9 + 1) + 1 = 9 lines again.
#     0:   0    |   *                    v =  0.80    The hop begins upwards, at u = 0.80 m/s.
#     1:        |          *             v =  0.60
#     2:        |               *        v =  0.40    CR is 0.8, and dt is 0.1 s.
#     3:        |                  *     v =  0.20    A column is 1 cm.
#     4:        |                   *    v =  0.00    The pull g is 2 m/s^2. So in each frame
#     5:        |                  *     v = -0.20    the car gets g dt = 0.20 m/s downwards.
#     6:        |               *        v = -0.40
#     7:        |          *             v = -0.60
#     8:        |   *                    v = -0.80    The move ends at the 0 of line 9, downwards at
#     9:   0    |   *                    v =  0.80    w = 1.00 m/s. Then comes the rebound.
# Why this law? From u upwards to w downwards, each frame of the hop adds g dt:
#     (1)  u + w = hop g dt      0.8 + 1.0 = 9 * 0.2
# How much larger is w than u? A bounce is found late, by a part of a frame. Call this part the lag:
# on average it is 1/2. In this time the car falls below the floor and gains lag g dt. So at the
# floor it had w - lag g dt (about 0.9). With the exact motion a car comes down as fast as it rose.
#     surface:   The hop begins on the floor, with u. So w - u is lag g dt, on average g dt/2.
#     rebound:   The hop before ended with its own w, about lag w dt deep. The rebound puts the car
#                CR times as far above the floor, and u is CR times that w. So this hop begins about
#                lag u dt high (0.04), as if the car had left the floor with u + lag g dt (about
#                0.9). So, if both lags are equal, w - u is 2 lag g dt: on average g dt.
#     none:      At CR = 1 a hop ends, on average, as deep as it begins. So w - u is 0 on average.
#     conserve:  This correction keeps E on the way to the floor and off it. Here let u and w be the
#                speeds at the floor: w - u is 0. On average the time between is hop dt, as in (1).
# An Euler motion also changes E, in each frame by m g^2 dt^2/2, where m is the motion's number. So
# in the whole hop w^2/2 - u^2/2, or (w - u)(w + u)/2, changes by hop m g^2 dt^2/2. As (w + u)/2 is
# hop g dt/2, by (1), w - u changes by m g dt. In all,
#     (2)  w - u = k g dt        1.0 - 0.8 = 1 * 0.2
# By (1) and (2) w is (hop + k) g dt/2 and u is (hop - k) g dt/2. The next u is CR w. It is also
# (next - k) g dt/2. So next - k = CR (hop + k). With equal frames, from most starts, it leads to:
#     CR = 1: On average each hop is 2 k lines longer than the one before. If k > 0, hops grow until
#         the car meets the other wall. If k < 0, they shrink until the car rests (with the
#         correction none, until it is caught). If k = 0, their length stays, or goes up and down.
#     CR < 1, k > 0: By the law, a hop of n = k (1 + CR)/(1 - CR) lines repeats. Hops of over 2 n
#         lines shrink, until they have about n/2 to 2 n. Short ones grow, or repeat as they are.
#         Why may a hop repeat that has not n lines? The numbers of surface and rebound, 1/2 and 1,
#         are for a lag of 1/2. A hop that repeats has the same lag each time, perhaps another one.
#         Then the numbers are lag and 2 lag. As a lag is at most 1, k and n are at most doubled.
#     CR < 1, k <= 0: Hops shrink until the car rests: in each line it then bounces, on the wall or,
#         with rebound, up to g dt^2/4 from it. With the g and dt above this is 5 mm, and a film
#         runs on. But with backward + rebound k is 2 lag - 1. If this is over 0, hops may repeat.
# For the table, hops of 30 to 90 lines were followed to their end at CR = 0.9, where n is 19 k. The
# rarest 2 of 100 results are left out. If k > 0, surface ends above n: its lag is over 1/2.
#                   + surface     + rebound            + conserve
#     forward       29 to 37      33 to 48             18 and 19 lines
#     exact         10 to 18      14 to 30             rest
#     backward      rest          rest or up to 16     rest

# ==== 8. What film, chart and map share in printing =============================================

# The colours of the marks of film, chart and map: a terminal's number and matplotlib's name.
INKS = {"0Xx": (31, "red"), "od-": (32, "green"), "*<>eWGgLl": (33, "orange"),
        "cPp": (34, "blue"), "aSs": (35, "purple"), "b": (36, "cyan")}
COLOURED = {ord(mark): f"\033[{ink}m{mark}\033[0m"
            for marks, (ink, _) in INKS.items() for mark in marks}
LETTERS = "; ".join(f"{letter}: {' + '.join(method)}" for letter, method in METHODS.items())

def inked(line: str) -> str:
    """The line with its marks in colours, or as it is where nobody wants colours."""
    is_plain = os.environ.get("NO_COLOR") or os.environ.get("TERM", "dumb") == "dumb"
    return line if is_plain or not sys.stdout.isatty() else line.translate(COLOURED)

def say(text: str, indent: int = 0) -> None:
    """Print a paragraph, as wide as the terminal but no wider than is good to read."""
    width = min(100, shutil.get_terminal_size().columns)
    print(textwrap.fill(text, width, subsequent_indent=" " * indent), flush=True)

# ==== 9. Speed against accuracy: the chart ======================================================

SPAN_S, CUTS = 20, 10  # of chart and map: simulated seconds, runs of each method
MEASURED = ("The scene's own motion, correction and rate do not matter. Each method runs ten times "
            "for 20 simulated seconds, in equal frames: from the scene's start, and nine times "
            "from the true state a part of a frame later, to meet walls elsewhere in a frame.")
CHART_FPS = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)  # multiples of 10, for simulate
Points = dict[str, list[tuple[float, float]]]  # letter: (error_m, cost_us) at each rate
cached_step = cache(step)  # all methods need the truth at the same moments

def simulate(scene: Scene, fps: int, cut: int) -> Iterator[tuple[float, ...]]:
    """Run for SPAN_S. Every 0.1 s (or frame, if longer) yield x_m, v_mps and their true values.

    At which moment of a frame the car meets a wall is luck. So cut 0 begins at the scene's start,
    and cuts 1 to 9 begin later, at the true state of that moment. They are a ninth of a frame
    apart. A cut that began a whole frame later would meet the walls as cut 0 does.
    """
    truth = truth_of(scene)
    shift_s = (cut - 2 / 3) / (CUTS - 1) / fps if cut else 0.0
    frames_a_sample = max(1, fps // 10)
    x_m, v_mps, _ = step(truth, truth.x_m, truth.v_mps, shift_s)
    for frame in range(frames_a_sample, SPAN_S * fps + 1, frames_a_sample):
        for _ in range(frames_a_sample):
            x_m, v_mps, _ = step(scene, x_m, v_mps, 1 / fps)
        t_s = shift_s + frame / fps
        yield x_m, v_mps, *cached_step(truth, truth.x_m, truth.v_mps, t_s)[:2]

def cost_us(scene: Scene, fps: int) -> float:
    """Processor time of the bare steps for a simulated second, the best of several runs."""
    costs_s = timeit.repeat(
        "x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)", "x_m, v_mps = scene.x_m, scene.v_mps",
        number=SPAN_S * fps, repeat=max(5, 200 // fps), timer=time.process_time,
        globals={"step": step, "scene": scene, "dt_s": 1 / fps})
    return max(1e6 * min(costs_s) / SPAN_S, 0.01)  # a coarse clock may have measured 0

def two_digits(number: float) -> str:
    """The number with two digits, as more would be noise, and without an exponent."""
    return f"{float(f'{number:.1e}'):g}"

def table(scene: Scene) -> Points:
    """Measure every series at every rate, and print it row by row."""
    points: Points = {letter: [] for letter in METHODS}
    print("\n    ", *(f"{f'{letter}: {motion}':>14}" for letter, (motion, _) in METHODS.items()))
    print("    ", *(f"{f'+ {correction}':>14}" for _, correction in METHODS.values()))
    print(" FPS" + "  error m    us" * len(METHODS))
    for fps in CHART_FPS:
        row = f"{fps:4}"
        for letter, (motion, correction) in METHODS.items():
            method = replace(scene, motion=motion, correction=correction)
            errors_m = (abs(x_m - true_m) for cut in range(CUTS)
                        for x_m, _, true_m, _ in simulate(method, fps, cut))
            error_m, us = max(errors_m), cost_us(method, fps)
            points[letter].append((error_m, us))
            row += f"{error_m:9.1e}{two_digits(us):>6}"
        print(row, flush=True)
    print(f"Twice the rate divides errors by (2: first order, 4: second; from {CHART_FPS[-4]} FPS)")
    orders = (f"{(series[-4][0] / series[-1][0])**(1 / 3):.1f}" if series[-1][0] > 1e-9 else "-"
              for series in points.values())  # three doublings; smaller errors are round-off
    print("    " + "".join(f"{order:>9}{'':6}" for order in orders) + "\n")
    return points

def error_px(error_m: float) -> int:
    """An error's column, eight for each power of ten from 1e-6 to 10 m; others are at the edge."""
    return round(8 * math.log10(min(max(error_m, 1e-6), 10) / 1e-6))

def picture(points: Points, pixel_m: float) -> None:
    """Print the points: error to the right, processor time down, four rows for a power of ten."""
    marks = [(round(4 * math.log10(us)), error_px(error_m), letter)
             for letter, series in points.items() for error_m, us in series]
    limit_px = error_px(pixel_m)
    say("To the right: the largest error of ten runs, every 0.1 s. Down: processor time for a "
        "simulated second, in us (microseconds). The best are in the upper left.")
    say(f"{LETTERS}; +: several of them.")
    print(f"\n{'one drawn pixel |':>{limit_px + 11}}")
    print("    us    <=1 um  10 um   0.1 mm  1 mm    1 cm    0.1 m   1 m     >=10 m")
    for row in range(min(marks)[0], max(marks)[0] + 1):
        line = bytearray(b" " * 57)
        paint(line, "|", limit_px)
        for cost_px, column, letter in marks:
            if cost_px == row:
                paint(line, letter if chr(line[column]) in f" |{letter}" else "+", column)
        print(f"{two_digits(10 ** (row / 4)):>6}    {inked(line.decode().rstrip())}")

def conclude(points: Points, pixel_m: float) -> None:
    """Give the answer: from which rate on each series stays within a pixel, and at what cost."""
    told = []
    for letter, series in points.items():
        found = math.inf, f"{letter} at none of these rates"
        for fps, (error_m, us) in reversed(list(zip(CHART_FPS, series))):
            if error_m > pixel_m:
                break
            found = us, f"{letter} from {fps} FPS on, {two_digits(us)} us"
        told.append(found)
    say(f"Within a pixel ({two_digits(pixel_m)} m) in all ten runs, the cheapest first: "
        f"{'; '.join(text for _, text in sorted(told))}.")

def new_figure(file: str) -> Any:
    """An empty matplotlib figure. Raises BadInput for a wrong suffix or without matplotlib."""
    if not file.endswith((".png", ".svg", ".pdf")):
        raise BadInput(f"--save FILE must end in .png, .svg or .pdf, not {file!r}")
    try:
        from matplotlib.figure import Figure
        return Figure(figsize=(8, 6), dpi=150, layout="constrained")
    except Exception as fault:  # a broken one may raise anything
        how = ', pip install ".[chart]"' if isinstance(fault, ModuleNotFoundError) else " to work"
        raise BadInput(f"--save needs matplotlib{how}: {str(fault) or repr(fault)}") from fault

def draw(figure: Any, points: Points, pixel_m: float, heading: str) -> None:
    """Draw the points with matplotlib as well."""
    figure.suptitle(f"Speed against accuracy\n{textwrap.fill(heading, 126)}", fontsize=8)
    axes = figure.add_subplot(
        xscale="log", yscale="log", xlabel="largest error in ten runs (m): better to the left",
        ylabel="processor time for a simulated second (\N{MICRO SIGN}s):\nbetter upwards")
    axes.invert_yaxis()
    for (letter, series), name, mark in zip(points.items(), LETTERS.split("; "), "oxD+v"):
        errors_m = [max(error_m, 1e-16) for error_m, _ in series]  # 0 has no logarithm
        colour, = (colour for marks, (_, colour) in INKS.items() if letter in marks)
        axes.plot(errors_m, [us for _, us in series], f"{mark}-", color=f"tab:{colour}", label=name)
    axes.axvline(pixel_m, color="black", linestyle="--",
                 label=f"one drawn pixel, {two_digits(pixel_m)} m")
    figure.legend(loc="outside lower center", ncols=3, title="Each line begins at "
                  f"{CHART_FPS[0]} FPS, at the top, and ends at {CHART_FPS[-1]} FPS")

def chart(scene: Scene, heading: str, file: str | None) -> None:
    """Print table and picture. If a file is given, save the picture, or raise BadInput."""
    pixel_m = 1 / scene.m_to_px
    figure: Any = None if file is None else new_figure(file)  # fails before the measuring
    say(f"Speed against accuracy. {heading} {MEASURED} Which method costs least and stays within "
        "a pixel of the truth?")
    points = table(scene)
    picture(points, pixel_m)
    conclude(points, pixel_m)
    if file is not None:
        try:
            draw(figure, points, pixel_m, heading)
            figure.savefig(file, format=file[-3:])  # or it would write .svg as .svg.png
        except Exception as fault:  # whatever matplotlib or the disk refuses
            raise BadInput(f"--save {file!r}: {str(fault) or repr(fault)}") from fault
        print(f"\nSaved as {file!a}.")

# ==== 10. Where methods fail: the stability map =================================================

MAP_FPS = (1, 2, 5, 10, 30, 60, 120, 240, 1000)  # at most 10, or multiples of it
VERDICTS = {  # from the worst to the best
    "X": "out: further beyond a wall than the track is long",
    "S": "stuck: beyond the same wall all through the last 5 s",
    "W": "win or lose: some runs gain energy, others lose it; always a capital",
    "G": "gain: on average over the last 5 s the car has over 1 % too much energy",
    "L": "loss: on average over the last 5 s the car has over 1 % too little energy",
    "P": "energy within 1 %, but over a drawn pixel off; at CR < 1 it may still hop",
    "-": "within a drawn pixel of the truth, every 0.1 s (or frame, if longer)"}

def verdict(scene: Scene, fps: int, cut: int) -> str:
    """The letter of one run: the first of X, S, -, G, L and P that fits. (W needs several runs.)"""
    states = list(simulate(scene, fps, cut))
    late = len(states) * 3 // 4  # where the last 5 of 20 s begin
    beyond_m = [x_m - scene.to_track(x_m) for x_m, *_ in states]
    track_m = scene.right_edge_m - scene.left_edge_m
    if max(map(abs, beyond_m)) > track_m:
        return "X"
    if min(beyond_m[late:]) > 0 or max(beyond_m[late:]) < 0:
        return "S"
    if max(abs(x_m - true_m) for x_m, _, true_m, _ in states) <= 1 / scene.m_to_px:
        return "-"
    gain = fmean((v_mps**2 - true_mps**2) / 2 - scene.a_mps2 * (x_m - true_m)
                 for x_m, v_mps, true_m, true_mps in states[late:])  # in E
    one_percent = 0.01 * (scene.v_mps**2 / 2 + abs(scene.a_mps2) * track_m)
    return "G" if gain > one_percent else "L" if gain < -one_percent else "P"

def cell(found: set[str]) -> str:
    """One letter for ten runs: the worst, as a small letter if only some runs are so bad."""
    worst = min(found, key=list(VERDICTS).index)
    if worst == "G" and "L" in found:
        return "W"
    return worst if len(found) == 1 else worst.lower()

def stability(scene: Scene, whose: str, heading: str) -> None:
    """Print the map: a row for each method, a column for each rate, a letter for ten runs."""
    say(f"Stability. {heading} {MEASURED} Which methods are right, and from which rate on?")
    print("\nFrom the worst to the best. 100 % is v^2/2 at the start + |a| * track length:")
    for letter, meaning in VERDICTS.items():
        print(f"{inked(letter)}  {meaning}")
    print(f"\n{whose:20}" + "".join(f"{fps:6}" for fps in MAP_FPS), "FPS")
    right: dict[int, list[str]] = {}  # from which column on: the methods
    for motion in MOTIONS:
        for correction in EVERY_CORRECTION:
            if motion == "exact" or correction not in EXACT_ONLY:
                name, row = f"{motion} + {correction}", ""
                method = replace(scene, motion=motion, correction=correction)
                for fps in MAP_FPS:
                    row += cell({verdict(method, fps, cut) for cut in range(CUTS)})
                print(f"{name:20}" + inked("".join(f"{letter:>6}" for letter in row)), flush=True)
                right.setdefault(len(row.rstrip("-")), []).append(name)
    say("X out, S stuck, W win or lose, G gain, L loss, P energy right, - within a pixel; a small "
        "letter: the worst of some runs, not all.")
    told = [f"{', '.join(right[column])} from {fps} FPS on"
            for column, fps in enumerate(MAP_FPS) if column in right]
    say(f"Within a pixel in all ten runs: {'; '.join(told)}.")
    if scene.a_mps2:
        say("By the law of the hops (examples 19, 20; section 7 of airtrack.py), long hops on one "
            "wall gain energy with surface, rebound or conserve if k > 0, lose if k < 0." if
            scene.CR == 1 else "At CR < 1 a G car hops on, or lies on its wall with too large a v.")

# ==== 11. Checking a scene ======================================================================

class BadInput(ValueError):
    """One sentence: what a user asked for and cannot have, and what is allowed."""

NUMBERS = {int: "a whole number", float: "a number"}  # settings of other types are choices

def allowed_text(row: Field[Any]) -> str:
    """What a setting may be, in words."""
    allowed, noun = row.metadata["allowed"], NUMBERS.get(type(row.default))
    if noun:
        return f"{noun} from {allowed[0]} to {allowed[1]} {row.metadata['unit']}".rstrip()
    return " or ".join(", ".join(map(str, allowed)).rsplit(", ", 1))

def check(scene: Scene) -> None:
    """Raise BadInput for a scene that is not allowed. It names setting, range and value."""
    for row in fields(scene):
        value, allowed, kind = getattr(scene, row.name), row.metadata["allowed"], type(row.default)
        is_good = (isinstance(value, (int, kind)) and allowed[0] <= value <= allowed[1]
                   if kind in NUMBERS else value in allowed)
        if not is_good:
            text = str(value)
            point = f": write {text.replace(',', '.')}" if kind is float and "," in text else ""
            raise BadInput(f"{row.name} must be {allowed_text(row)}, not {value!r}{point}")
    left_m, right_m = scene.left_edge_m, scene.right_edge_m
    if round(right_m - left_m, 9) < 0.01:  # 2.21 - 2.2 is a bit less
        raise BadInput("right_edge_m must be at least 0.01 m to the right of left_edge_m, not "
                       f"{right_m} and {left_m}")
    if scene.correction in EXACT_ONLY:
        with_it = f"with correction={scene.correction}"
        if scene.motion != "exact":
            raise BadInput(f"motion must be exact {with_it}, not {scene.motion}: choose "
                           "motion=exact, or another correction")
        if scene.x_m != scene.to_track(scene.x_m):
            raise BadInput(f"x_m must be from {left_m} to {right_m} {with_it}, not {scene.x_m}")

# ==== 12. The command line ======================================================================

SETTINGS = {row.name: row for row in fields(Scene)}
PYTHON = os.path.basename(sys.executable).removesuffix(".exe")  # python3 where there is no python
COMMANDS = {"chart": f"\nNext: {PYTHON} airtrack.py stability",  # each with its last line
            "stability": "That was the tour. README.md has exercises."}
DRAWING = {"m_to_px", "width_px", "show_start_mark", "show_collision_mark", "show_exact_mark"}
OPTIONS = {"d": "the film", "--fast": "the film", "--frames": "the film", "--save": "chart"}

def in_words(scene: Scene) -> str:
    """How the car starts, in words."""
    v_mps, a_mps2, ways = scene.v_mps, scene.a_mps2, ("to the left", "to the right")
    beyond = "" if scene.x_m == scene.to_track(scene.x_m) else ", beyond a wall"
    speed = f"moving {ways[v_mps > 0]} at {abs(v_mps):g} m/s" if v_mps else "at rest"
    pull = f"pulled {ways[a_mps2 > 0]} at {abs(a_mps2):g} m/s^2" if a_mps2 else "not pulled"
    if not (beyond or v_mps or a_mps2):
        pull += ": nothing moves it until v_mps or a_mps2 is given"
    return (f"The car starts at {scene.x_m:g} m{beyond}, {speed}, {pull}; walls at "
            f"{scene.left_edge_m:g} and {scene.right_edge_m:g} m; CR={scene.CR:g}.")

def film_in_words(scene: Scene) -> str:
    """How the car starts, and then all that the user may set of its motion and its frames."""
    irregular = f", irregular by up to {100 * scene.jitter:g} %" if scene.jitter else ""
    observed = ", each step as long as the frame before" * scene.use_observed_dt
    return (f"{in_words(scene)} Motion {scene.motion}, correction {scene.correction}, "
            f"{scene.fps_target:g} frames a second{irregular}{observed}")

def fitted(scene: Scene, details: bool) -> Scene:
    """The scene, its picture and zoom made smaller until line and details fit the terminal."""
    truth = (0.0, 0.0) if scene.show_exact_mark else None
    widest = details_text(-9999.99, -9999.99, scene.fps_target, truth) if details else ""
    columns = max(10, shutil.get_terminal_size().columns - len(widest))  # 10: the least of a scene
    if columns >= scene.width_px or not sys.stdout.isatty():
        return scene
    # Columns run from 0 to width - 1: what is in the last one stays in the last one.
    m_to_px = max(0.001, scene.m_to_px * (columns - 1) / (scene.width_px - 1))
    say(f"Drawn {columns} columns wide, to fit.")
    return replace(scene, width_px=columns, m_to_px=m_to_px)

def tell_of_walls(scene: Scene) -> None:
    """If a wall is outside the picture, say so, and what would show both walls."""
    if round(scene.left_edge_m * scene.m_to_px) < 0:
        say("The picture begins at x = 0: shift x_m and the walls.")
    elif round(scene.right_edge_m * scene.m_to_px) >= scene.width_px:
        enough = math.floor(1000 * (scene.width_px - 1) / scene.right_edge_m) / 1000
        say(f"The picture ends before a wall: m_to_px={enough:g} would show both.")

ACCOUNT = "bounces", "lines per hop", "turned at x (m)", "move beyond wall", "top speed", "rests"

def account(name: str, scene: Scene, until_s: float) -> tuple[str, ...]:
    """A heading, and the rows of ACCOUNT: what the scene's film shows until that time."""
    states: list[tuple[float, float, float | None]] = [(scene.x_m, scene.v_mps, None)]
    last_m, t_s, rests = deque[float](maxlen=max(10, round(scene.fps_target / 3))), 0.0, ""
    for length_s, _ in planned(scene):
        t_s += (dt_s := length_s if scene.use_observed_dt else 1 / scene.fps_target)
        if rests or t_s > until_s * (1 + 1e-9):
            break
        states.append(step(scene, *states[-1][:2], dt_s))
        last_m.append(states[-1][0])
        rests = f"yes, noticed at {t_s:.2f} s" * is_at_rest(scene, states[-1][1], last_m)
    bounces = {n: mark_m for n, (_, _, mark_m) in enumerate(states) if mark_m is not None}
    left = sum(mark_m < (scene.left_edge_m + scene.right_edge_m) / 2 for mark_m in bounces.values())
    hops = [str(b - a) for a, b in pairwise(bounces)]
    equal = len(list(takewhile(lambda hop: hop == hops[-1], reversed(hops))))
    turns_m = [f"{(max if v > 0 else min)(x, x_m):.2f}" for (x, v, _), (x_m, v_mps, mark_m)
               in pairwise(states) if mark_m is None and v and v * v_mps <= 0]  # the further x
    for figures, last in (hops, 2), (turns_m, 1):  # the first four and the last ones are enough
        figures[4:-last] = ["..."] * (len(figures) > 4 + last)
    deepest_m = max((abs(at_m - scene.to_track(at_m)) for at_m in bounces.values()), default=0.0)
    return (f"{name}, {scene.fps_target:g} FPS", f"{left} left, {len(bounces) - left} right",
            " ".join(hops) or "-", " ".join(turns_m) or "only at walls" * bool(bounces) or "-",
            f"up to {deepest_m:.3f} m", f"{max(abs(v_mps) for _, v_mps, _ in states):.2f} m/s",
            rests or (f"no: last {equal} hops have {hops[-1]} lines" if equal > 3 else
                      "not in this time"))

def film(scene: Scene, number: int, title: str, options: dict[str, str]) -> int:
    """Print what to look for, leave time to guess, run, and print what was to be seen."""
    example = EXAMPLES.get(number, OWN_SCENE)
    details = "d" in options or example.details
    max_frames = value_of(int, options.get("--frames", "50000"))
    if not isinstance(max_frames, int) or max_frames < 1:
        raise BadInput(f"--frames N must be a whole number from 1 up, not {max_frames!r}")
    for told in (title, film_in_words(scene), *[LETTERS] * scene.show_methods):
        say(f"{told}.")
    tell_of_walls(scene)
    view = fitted(scene, details)
    as_it_is = Scene(**example.settings)
    changed = {name for name in SETTINGS if getattr(scene, name) != getattr(as_it_is, name)}
    is_changed = number in EXAMPLES and not changed <= DRAWING
    question = f"What differs from example {number} as it is?" if is_changed else example.look_for
    with nullcontext() if "--fast" in options else taken_keys() as keys:
        for paragraph in keys.help(question) if keys else [question]:
            say(paragraph)
        if keys:
            keys.leave_time()
        print(flush=True)
        run(view, details, max_frames, keys)
        if keys and keys.frame and not keys.status:
            films = {"as it is": as_it_is, "changed": scene} if is_changed else {"your film": scene}
            tables = [[account(f"{mark} {name}", truth_of(each) if mark == "o" else each, keys.t_s)
                       for name, each in films.items()] for mark in "*o"[:1 + scene.show_exact_mark]
                      if is_changed or number not in EXAMPLES]
            about = " about" * scene.use_observed_dt  # the clock set the steps
            for columns in tables:
                for row, *cells in zip((f"in{about} {keys.t_s:.2f} s", *ACCOUNT), *columns):
                    print(f"{row:16} " + " ".join(f"{cell:31}" for cell in cells).rstrip())
            if is_changed and all(usual[1:] == shown[1:] for usual, shown in tables):
                print("No figure differs.")
            elif not is_changed and not (tables and tables[0][0][-1].startswith("yes")):
                say(example.seen)
            following = [*EXAMPLES, "chart"][number + 1] if number in EXAMPLES else "-h"
            if keys.where():
                print(f"Next: {PYTHON} airtrack.py {following}", flush=True)
    return keys.status if keys else 0

def manual() -> int:
    """Print the usage, the examples and the settings."""
    print(f"{__doc__}\nExamples; any other whole number is for a scene of your own")
    for number, example in EXAMPLES.items():
        print(f"  {number:2}  {example.title}")
    print("\nSettings: default, meaning (what is allowed)")
    for row in fields(Scene):
        say(f"  {row.name:20}{row.default!s:9}{row.metadata['meaning']} ({allowed_text(row)})", 31)
    return 0

def value_of(kind: Callable[[str], object], text: str) -> object:
    """The text as a value of this kind, or the text itself where it cannot be one."""
    try:
        return {"True": True, "False": False}[text.capitalize()] if kind is bool else kind(text)
    except (KeyError, ValueError):
        return text

def refusal(word: str) -> BadInput:
    """The error for an unknown word. It names what is nearest: a name, a choice, a meaning."""
    start, equals, _ = word.lower().partition("=")
    value = "=VALUE" if equals else "=VALUE, without spaces"
    names = {name.lower(): name for name in ("--help", *COMMANDS, *OPTIONS)}
    names |= {name.lower(): name + value for name in SETTINGS}
    names |= {} if equals else {key: f"the key {key}, while a film runs" for key in "psx"}
    meanings = {start: "".join(re.findall(r"^([0-9]+)[^0-9]", start))}  # 10d: 10
    for name, row in reversed(SETTINGS.items()):  # of two with a word, the first one counts
        meaning, allowed = row.metadata["meaning"], row.metadata["allowed"]
        meanings |= dict.fromkeys(re.findall(r"\w+", meaning), f"{name}{value} ({meaning})")
        names |= {part: f"{name}={part}" for part in allowed if isinstance(part, str)}
    near = difflib.get_close_matches(start, names, cutoff=0.7)  # with 0.6, dt would be near to d
    near = near or [name for name in names if start and name.startswith(start)]
    hint = names[near[0]] if near else meanings[start]
    hint = f"nearest: {hint}" if hint else "-h lists all"
    return BadInput(f"unknown word {word!r}: it must be an EXAMPLE (whole number), a command, an "
                    f"option or a setting (NAME=VALUE); {hint}")

def parsed(words: list[str]) -> tuple[dict[str, str], dict[str, Any]]:
    """Take the words apart: into EXAMPLE, command and options, and into changes of settings."""
    given, changes = {}, {}
    rest = iter(words)
    for word in rest:
        word = "d" if word in ("-d", "D") else word.replace("\N{MINUS SIGN}", "-")  # of a page
        name, equals, text = word.partition("=")
        if name in ("--frames", "--save"):
            given[name] = text if equals else next(rest, "")
        elif word in OPTIONS:
            given[word] = ""
        elif equals and name in SETTINGS:
            changes[name] = value_of(type(SETTINGS[name].default), text)
        elif word in COMMANDS or isinstance(value_of(int, word), int):
            kind = "command" if word in COMMANDS else "EXAMPLE"
            if kind in given:
                raise BadInput(f"one {kind} at a time, not both {given[kind]} and {word}")
            given[kind] = word
        else:
            raise refusal(word)
    return given, changes

def obey(words: list[str]) -> int:
    """Do what the words ask for. Returns the exit status; raises BadInput."""
    if "-h" in words or "--help" in words:
        return manual()
    given, changes = parsed(words)
    command = given.pop("command", "the film")
    number = int(given.pop("EXAMPLE", 10 if command in COMMANDS else 0))
    for option in given:
        if OPTIONS[option] != command:
            raise BadInput(f"{option} is for {OPTIONS[option]}, not for {command}")
    example = EXAMPLES.get(number, OWN_SCENE)
    methods = {"motion": "exact", "correction": "none"} if command in COMMANDS else {}
    for name in methods.keys() & changes:  # chart and map set both; still, a wrong one is told
        Scene(**{"motion": "exact", name: changes[name]})
    scene = Scene(**(example.settings | changes | methods))
    changed = "".join(f", {name}={value}" for name, value in changes.items())
    if number not in EXAMPLES:
        say(f"The examples are 0 to {max(EXAMPLES)}; other numbers are yours.")
    if command not in COMMANDS:
        title = f"Example {number}: {example.title}" if number in EXAMPLES else example.title
        return film(scene, number, title + changed, given)
    on_track = truth_of(scene)  # chart and map set the methods, and keep the start
    whose = f"Example {number}'s scene" if number in EXAMPLES else example.title
    beyond = "" if on_track.x_m == scene.x_m else " Here all methods start on that wall."
    heading = f"{whose}{changed}. {in_words(scene)}{beyond}"
    if command == "stability":
        stability(on_track, whose, heading)
    else:
        chart(on_track, heading, given.get("--save"))
    if sys.stdout.isatty():
        print(COMMANDS[command])
    return 0

def main(argv: list[str] | None = None) -> int:
    """Run a command line, sys.argv's by default. Returns the exit status, 2 for an error."""
    try:
        status = obey(sys.argv[1:] if argv is None else argv)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        return 130
    except (BadInput, OSError) as fault:
        if isinstance(fault, OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # more output would fail
        if isinstance(fault, BrokenPipeError):  # the reader has seen enough, as in | head
            return 0
        print("airtrack.py: error:", *str(fault).split(), file=sys.stderr)  # on one line
        return 2


if __name__ == "__main__":
    sys.exit(main())
