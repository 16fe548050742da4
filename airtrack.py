#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text a frame.

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
from itertools import count, pairwise
from statistics import fmean
from typing import Any

from examples import EXAMPLES, OWN_SCENE, Keys, taken_keys

# ==== 1. Moving: where is the car dt_s later, if there are no walls? ============================
#     x_m, v_mps   the car's position (m) and velocity (m/s), positive to the right
#     a_mps2       its constant acceleration (m/s^2): the pull
#     dt_s         how long a frame lasts (s), and so the time step
#
# v changes during the frame. Euler's methods hold it constant: forward takes it from the frame's
# start, backward (for a constant a the same as semi-implicit Euler) from its end. Both are of first
# order: half the dt, half the error after a given time. exact has no error, for a constant a. In
# free flight the car's energy per kilogram, E = v^2/2 - a x, should not change.

State = tuple[float, float]  # x_m, v_mps

def forward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Forward Euler: x + v dt, then v + a dt. Each step changes E by +a^2 dt^2/2."""
    return x_m + v_mps * dt_s, v_mps + a_mps2 * dt_s

def backward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Backward Euler: v + a dt, then x + v dt. Each step changes E by -a^2 dt^2/2."""
    v_mps += a_mps2 * dt_s
    return x_m + v_mps * dt_s, v_mps

def exact(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Kinematics: x + v dt + a dt^2/2, and v + a dt. E does not change."""
    return x_m + v_mps * dt_s + a_mps2 * dt_s * dt_s / 2, v_mps + a_mps2 * dt_s

MOTIONS = {"forward": forward, "backward": backward, "exact": exact}  # name a new one here


# ==== 2. Colliding: the stickiness corrections ==================================================
#     wall_m       the position of a wall (m)
#     CR           the coefficient of restitution: speed after a bounce / speed before
#
# Stickiness: a car whose move ends beyond a wall may stay there (see none). So a correction takes
# that move's x and v, the wall, a and CR, and returns x and v after the bounce. The overlap is
# x - wall. Off a wall is back towards the track; the other way is into it. The law of the hops,
# section 7, says what none, surface, rebound and conserve do to a car that hops on a wall.

def none(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Reverse v, but leave the car beyond the wall: a trap.

    A frame later it may still be beyond: if CR < 1 has slowed it (example 3), or if the way back is
    shorter, by a dt^2, as by backward with the pull into the wall, or by forward with the pull off
    it. Then v is reversed once more, now into the wall, and so on: the car is caught, often for
    good.
    """
    return x_m, -CR * v_mps

def surface(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car on the wall. Moved against a pull into it, unslowed, it keeps too much energy."""
    return wall_m, -CR * v_mps

def rebound(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car CR * overlap off the wall, where it would be by now if nothing pulled at it.

    Moved further against a pull into the wall, and unslowed, it keeps even more energy. With CR *
    overlap longer than the track, it is thrown through the far wall (example 14).
    """
    overlap_m = x_m - wall_m
    return wall_m - CR * overlap_m, -CR * v_mps

def conserve(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car where rebound puts it, at the speed that its energy after the bounce gives there.

    If that energy does not carry it so far, put it on the wall. Otherwise, with the exact motion,
    only the moment of the bounce is wrong, by second order: half the dt, a quarter of the error.
    """
    overlap_m = x_m - wall_m
    # Back at the wall E is the same, w^2 = v^2 - 2 a overlap, and the bounce leaves CR w.
    bounced_mps = CR * math.sqrt(max(0.0, v_mps * v_mps - 2 * a_mps2 * overlap_m))
    # From there E stays the same: CR overlap off the wall u^2 = (CR w)^2 - 2 a CR overlap.
    u_squared = bounced_mps * bounced_mps - 2 * a_mps2 * CR * overlap_m
    if u_squared < 0:
        return wall_m, math.copysign(bounced_mps, -overlap_m)
    return wall_m - CR * overlap_m, math.copysign(math.sqrt(u_squared), -overlap_m)

def arrival(d_m: float, u_mps: float, a_mps2: float) -> tuple[float, float]:
    """How long to a wall d_m ahead, and how fast there: t_s, w_mps. u and a are + towards it."""
    # The speed w at the wall, from energy: w^2 = u^2 + 2 a d. (max: for round-off.)
    w_mps = math.sqrt(max(0.0, u_mps * u_mps + 2 * a_mps2 * d_m))
    # The time t, from the mean velocity, d = (u + w)/2 t, or from w = u + a t: whichever does not
    # subtract nearly equal numbers, since their difference is mostly round-off.
    return (2 * d_m / (u_mps + w_mps) if u_mps > 0 else (w_mps - u_mps) / a_mps2), w_mps

def rewind(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Go back to the wall, bounce there, and go on for as long as the car was beyond.

    Right for the exact motion, in a frame that holds one bounce and whose move ends beyond the wall
    (example 10). It cannot settle a second bounce. If the pull brings the car back before the frame
    ends, rewind is not asked: a missed event (example 18).
    """
    # Run time backwards: v changes its sign, a does not, and the car arrives at the wall.
    side = math.copysign(1, x_m - wall_m)  # 1 beyond the right wall, -1 beyond the left one
    t_s, w_mps = arrival(abs(x_m - wall_m), side * v_mps, -side * a_mps2)
    x_m, v_mps = exact(wall_m, -side * CR * w_mps, a_mps2, t_s)
    return (wall_m if side * (x_m - wall_m) > 0 else x_m), v_mps  # beyond again: a second bounce

CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "conserve": conserve,
               "rewind": rewind}
EVERY_CORRECTION = (*CORRECTIONS, "replay")  # which redoes the whole frame, in section 4
EXACT_ONLY = ("rewind", "replay")  # they need the exact motion
METHODS = {"a": ("backward", "rebound"), "b": ("exact", "rebound"), "c": ("exact", "conserve"),
           "d": ("exact", "rewind"), "e": ("exact", "replay")}  # of example 21 and the chart


# ==== 3. The scene: all that a run starts from ==================================================

def setting(default: Any, meaning: str, allowed: Any = (False, True), unit: str = "") -> Any:
    """A row of the table below. allowed: a number's lowest and highest value, or every choice."""
    return field(default=default, metadata={"meaning": meaning, "allowed": allowed, "unit": unit})

@dataclass(frozen=True)
class Scene:
    """The settings, which no run changes; BadInput (a ValueError) for a wrong one."""

    x_m: float = setting(1.1, "starting position", (-1000, 1000), "m")
    v_mps: float = setting(0.0, "starting velocity: speed to the right", (-1000, 1000), "m/s")
    a_mps2: float = setting(0.0, "acceleration: the pull, gravity g", (-1000, 1000), "m/s^2")
    left_edge_m: float = setting(0.25, "the left wall", (-1000, 1000), "m")
    right_edge_m: float = setting(2.2, "the right wall", (-1000, 1000), "m")
    CR: float = setting(0.8, "coefficient of restitution: speed after / before a bounce", (0, 1))
    motion: str = setting("backward", "how the car is moved", tuple(MOTIONS))
    correction: str = setting("rebound", "stickiness correction of a collision", EVERY_CORRECTION)
    fps_target: float = setting(30.0, "frames a second; time step dt = 1/fps", (0.1, 1000), "1/s")
    use_observed_dt: bool = setting(False, "the step is how long the frame before took")
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
        """x_m itself, or the wall that it is beyond."""
        if x_m < self.left_edge_m:
            return self.left_edge_m
        return self.right_edge_m if x_m > self.right_edge_m else x_m


# ==== 4. A frame ================================================================================

def step(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, float | None]:
    """One frame of dt_s: move the car, settle any collision. Returns x_m, v_mps, mark_m.

    mark_m is where the move alone ended, before the correction; None without a collision.
    """
    free_m, free_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, dt_s)
    on_track_m = scene.to_track(free_m)  # the wall, if the move ended beyond one
    is_beyond = on_track_m != free_m
    # replay. A move that ends on the track can have been beyond a wall only if v changed its sign.
    if scene.correction == "replay" and (is_beyond or v_mps * free_mps < 0):
        x_m, v_mps = replay(scene, x_m, v_mps, dt_s)
        is_bounce = is_beyond or v_mps != free_mps  # without a bounce v is exactly the move's
        return x_m, v_mps, (free_m if is_bounce else None)
    if is_beyond:
        correction = CORRECTIONS[scene.correction]
        return *correction(free_m, free_mps, on_track_m, scene.a_mps2, scene.CR), free_m
    return free_m, free_mps, None

GRAZE_M = 5e-11  # far above the round-off of a position

def replay(scene: Scene, x_m: float, v_mps: float, t_s: float) -> State:
    """Replace the move: follow the exact motion from the frame's start, from wall to wall.

    Right for several bounces (example 15) or infinitely many, not for grazes. Think of a ball in a
    room: gravity pulls it to the floor (without a pull, the left wall), h is its height. The loop
    ends: trips to the ceiling take time, and without them hops() ends it. A ball that would pass
    the ceiling by less than GRAZE_M misses it: 1e-16 off in h can be 1e-8 off in v there. Each miss
    shifts it by up to 4 sqrt(room GRAZE_M), 4e-5 m with the default walls, and these add up.
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
    """Take at once all whole hops that fit into t_s. Returns the time still to fly, and v.

    The first hop lasts T = 2 v/g, each next one CR times as long, and all of them, infinitely many,
    T (1 + CR + CR^2 + ...) = T/(1 - CR). Then the ball is at rest: the Zeno point.
    """
    hop_s = 2 * v_mps / g_mps2
    zeno_s = hop_s / (1 - CR) if CR < 1 else math.inf
    if hop_s > t_s:  # not even one
        return t_s, v_mps
    if zeno_s <= t_s or t_s + hop_s == t_s:  # all fit, or one is too short to count
        return 0.0, 0.0
    if CR == 1:
        return math.fmod(t_s, hop_s), v_mps
    # n hops last zeno (1 - CR^n). (log1p(y) is log(1 + y), expm1(y) e^y - 1, right for a small y.)
    n = math.floor(math.log1p(-t_s / zeno_s) / math.log(CR))
    return t_s + zeno_s * math.expm1(n * math.log(CR)), v_mps * CR**n


# ==== 5. Drawing: one frame, one line, painted from back to front ===============================

def paint(line: bytearray, mark: str, x_px: float) -> None:
    """Paint the mark over what is in its column, if the line has that column."""
    column = round(x_px)  # int would round -0.9 to 0, into the picture
    if 0 <= column < len(line):
        line[column] = ord(mark)

def render_track(scene: Scene, x_m: float, mark_m: float | None = None,
                 others: Mapping[str, State] = {}) -> str:
    """The picture: scene.width_px characters. others are the other cars, by their marks."""
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
    # < and >: outside the picture. After the walls, to be seen even there.
    mark, column = ("<", 0) if column < 0 else (">", last) if column > last else ("*", column)
    paint(line, mark, column)
    return line.decode()

def details_text(x_m: float, v_mps: float, fps: float, truth: State | None) -> str:
    """What d adds to a line: position, velocity, frame rate and, given the truth, the error."""
    text = f"x = {x_m:6.2f}, v = {v_mps:5.2f}, FPS = {fps:3.0f}"
    return f"{text}, err = {x_m - truth[0]:9.2e}" if truth else text


# ==== 6. The run: the main loop =================================================================

def planned(scene: Scene) -> Iterator[tuple[float, float]]:
    """Yield how long each frame should last, and the target rate in FPS; the same in every run."""
    for frame in count(1):
        fraction = 0.618 * frame % 1  # 0.618, from the golden ratio, spreads the lengths evenly
        yield (1 + scene.jitter * (2 * fraction - 1)) / scene.fps_target, scene.fps_target

STALL_S, STALL_FRAMES = 0.15, 1.5  # longer than both is a stall: a dragged window, say
LATE_S = 0.02  # a delay up to this, or of a frame if longer, is made up for by the next frames

def paced(scene: Scene, keys: Keys) -> Iterator[tuple[float, float]]:
    """Wait until each frame is due. Yield how long the last one took, and the rate in FPS.

    After a pause or a stall the length is the planned one, so that the car does not leap. The
    deadlines are absolute: a sleep of dt after each frame would add the time to compute and print.
    """
    began_s = deadline_s = time.perf_counter() - 1 / scene.fps_target  # the first is due at once,
    for due_s, fps in planned(scene):  # but for jitter
        deadline_s += due_s
        was_paused = keys.wait_until(deadline_s)
        if keys.why_quit:
            return
        now_s = time.perf_counter()
        took_s = now_s - began_s or due_s  # 0 where the clock has not ticked yet
        rate = fps if was_paused else 1 / took_s
        if was_paused or took_s > max(STALL_S, STALL_FRAMES * due_s):
            took_s = due_s
        yield took_s, rate
        began_s = now_s
        if was_paused or now_s > deadline_s + max(LATE_S, due_s):  # do not race to catch up
            deadline_s = now_s

def truth_of(scene: Scene) -> Scene:
    """The same scene, solved exactly. It has to start on the track."""
    return replace(scene, motion="exact", correction="replay", x_m=scene.to_track(scene.x_m))

def scenes_beside(scene: Scene) -> dict[str, Scene]:
    """The scenes of the other cars in its film, by their marks, from back to front."""
    truth = truth_of(scene)
    methods = {letter: replace(truth, motion=motion, correction=correction)
               for letter, (motion, correction) in METHODS.items() if scene.show_methods}
    return methods | ({"o": truth} if scene.show_exact_mark else {})

def is_at_rest(scene: Scene, v_mps: float, last_m: deque[float]) -> bool:
    """Whether the car rests against the wall that it is pulled to or, without a pull, against any.

    In the last frames its mean distance from the wall is at most 1 mm, and its v at most what the
    pull adds in that time. (A car that leans on a wall may have some v in each frame.)
    """
    side = scene.a_mps2 or last_m[-1] - (scene.left_edge_m + scene.right_edge_m) / 2
    wall_m = scene.right_edge_m if side > 0 else scene.left_edge_m
    most_m = 0.001 * len(last_m)  # for the sum of all distances, and so for the newest
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
    for frame, (length_s, fps) in zip(range(1, max_frames + 1), beats):  # range ends without a wait
        # Move and settle; then the other cars, where there are any.
        dt_s = length_s if scene.use_observed_dt else 1 / scene.fps_target
        t_s += dt_s
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        others = others and {mark: step(beside[mark], *xv, dt_s)[:2] for mark, xv in others.items()}
        # Draw, on a terminal in colours.
        line = render_track(scene, x_m, mark_m, others)
        text = details_text(x_m, v_mps, fps, others.get("o")) if details else ""
        sys.stdout.write(f"{inked(line) if keys else line}{text}\n")
        if keys:
            keys.count(frame, t_s)
        # At rest?
        last_m.append(x_m)
        if scene.auto_off and is_at_rest(scene, v_mps, last_m):
            why = "the car is at rest against a wall"
            break
    if keys:
        why = keys.why_quit or why
    print(f"Stopped after {frame} frame{'s' * (frame != 1)}, t = {t_s:.2f} s: {why}.", flush=True)


# ==== 7. The law of the hops ====================================================================
# A car hops on the wall that it is pulled to. Each hop should last CR times as long as the one
# before. Count a hop in lines of the film, from one in which a bounce is found to the next such
# line. After a hop of many lines the next one has, on average over many starts,
#     next = CR (hop + k) + k lines, where k is the motion's number plus the correction's:
#     forward 1    exact 0    backward -1      surface 1/2    rebound 1    conserve 0    none 0
# (none only at CR = 1, until it catches the car). Here is the hop that example 20 ends with, and
# repeats: exact + rebound, CR = 0.8, dt = 0.1, the pull into the wall g = 2; a column is 1 cm. From
# line 0 to line 9 are nine frames. The 0 is where a move ended, 5 cm in the wall, at v = -1.00.
#     0:   0    |   *                    v =  0.80
#     1:        |          *             v =  0.60
#     2:        |               *        v =  0.40
#     3:        |                  *     v =  0.20
#     4:        |                   *    v =  0.00
#     5:        |                  *     v = -0.20
#     6:        |               *        v = -0.40
#     7:        |          *             v = -0.60
#     8:        |   *                    v = -0.80
#     9:   0    |   *                    v =  0.80
# Why? Let u be a hop's first speed, off the wall (after the correction: 0.8), w its last one, into
# the wall (before the correction: 1.0), m the motion's number (0), and drop by how much further
# into the wall the hop ends than it begins (0.05 + 0.04 = 0.09).
# (1) Each frame the pull adds g dt:  u + w = hop g dt                          0.8 + 1.0 = 9 * 0.2
# (2) v^2/2 grows by g drop, from the pull, and in each frame by what the motion adds to E (section
#     1), m g^2 dt^2/2:  (w^2 - u^2)/2 = g drop + hop m g^2 dt^2/2               0.18 = 2 * 0.09 + 0
# (3) Twice (2), divided by (1):  w - u = 2 drop/(hop dt) + m g dt               0.2 = 0.18/0.9 + 0
# (4) The drop, on average. A bounce is found late by a part s of a frame, on average 1/2: so a hop
#     ends about s w dt in the wall (0.05). Where it begins, the correction decides. Let its two
#     bounces be equally late, as they are on average.
#     rebound: CR times the last overlap off the wall, s u dt (0.04). The drop is s (u + w) dt, by
#         (1) s hop g dt^2, and makes 2 s g dt in (3). Its number is 2 s, on average 1.
#     surface: on the wall. The drop is s w dt, in long hops half as much: s, on average 1/2.
#     none, at CR = 1: in the wall, as deep as it ends. No drop: 0.
#     conserve: take u and w at the wall. (1) still holds, as both are equally late. No drop: 0.
# So w - u = k g dt: so much speed a hop gains, even a short one. With (1) w = (hop + k) g dt/2 and
# u = (hop - k) g dt/2. The next u, (next - k) g dt/2, is CR w: next - k = CR (hop + k), the law.
# Where it leads, in equal frames. At CR = 1, from most starts, hops grow by 2 k lines on average,
# up to the other wall. If k < 0 they shrink to rest (by none: until caught); if k = 0 they last or,
# by backward + rebound, wander. At CR < 1 a hop repeats if s, above 0 and below 1, stays the same
# (at 1 a hair of speed ends it): then hop = k (1 + CR)/(1 - CR), with the k of that s. Long hops
# shrink until s stays or recurs, by surface at over 1/2. If k > 0 short ones grow, or repeat. So
# hops of 30 to 90 lines end at CR = 0.9, from 98 of 100 starts, at one length or several, mixed:
#                   + surface     + rebound            + conserve
#     forward       29 to 37      33 to 48             18 and 19 lines
#     exact         10 to 18      14 to 30             rest
#     backward      rest          rest or up to 16     rest
# Rest: a bounce in every line; v need not be 0. By forward, short hops grow, to 18 lines at least.


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
    """Run for SPAN_S; every 0.1 s, or frame if longer, yield x_m, v_mps and the true two.

    Where in a frame the car meets a wall is luck. So cut 0 begins at the scene's start, and cut k,
    1 to 9, (k - 2/3)/9 of a frame later, at the true state of that moment. The truth takes one
    step: no error adds up.
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
    """The number without an exponent; more digits would be noise."""
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
    print(f"From {CHART_FPS[-4]} FPS on, twice the rate divides the error by (2: first order, 4: "
          "second)")
    orders = (f"{(series[-4][0] / series[-1][0])**(1 / 3):.1f}" if series[-1][0] > 1e-9 else "-"
              for series in points.values())  # three doublings apart; the rest is round-off
    print("    " + "".join(f"{order:>9}{'':6}" for order in orders) + "\n")
    return points

def error_px(error_m: float) -> int:
    """An error's column: eight a power of ten, from 1e-6 to 10 m. Others are drawn at the edge."""
    return round(8 * math.log10(min(max(error_m, 1e-6), 10) / 1e-6))

def picture(points: Points, pixel_m: float) -> None:
    """Print the points: error to the right, processor time down, four rows to a power of ten."""
    marks = [(round(4 * math.log10(us)), error_px(error_m), letter)
             for letter, series in points.items() for error_m, us in series]
    limit_px = error_px(pixel_m)
    say("To the right: largest error of ten runs, every 0.1 s. Down: processor time for a "
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
    """Say from which rate on each series stays within a pixel, and at what cost: the answer."""
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
    """Print table and picture; with a file, save it too. Raises BadInput where it cannot."""
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
    "G": "gain: in the last 5 s over 1 % more energy than the true car, on average",
    "L": "loss: over 1 % less (1 % of v^2/2 at the start + |a| * the track's length)",
    "P": "energy within 1 %, but over a drawn pixel off; at CR < 1 it may still hop",
    "-": "within a drawn pixel of the truth at every sample"}

def verdict(scene: Scene, fps: int, cut: int) -> str:
    """The letter of one run: the first of X, S, -, G, L and P that fits. W takes several runs."""
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
    """One letter for ten runs: the worst, or its small letter where not all are so bad."""
    worst = min(found, key=list(VERDICTS).index)
    if worst == "G" and "L" in found:
        return "W"
    return worst if len(found) == 1 else worst.lower()

def stability(scene: Scene, whose: str, heading: str) -> None:
    """Print the map: a row for each method, a column for each rate, a letter for ten runs."""
    say(f"Stability. {heading} {MEASURED} Which methods are right, and from which rate on?")
    print("\nFrom the worst to the best, judged every 0.1 s, or frame if longer:")
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
            "wall gain energy by surface, rebound or conserve if k > 0, lose if k < 0." if
            scene.CR == 1 else "At CR < 1 a G car hops on, or is on its wall with too large a v.")


# ==== 11. Checking a scene ======================================================================

class BadInput(ValueError):
    """One sentence on what a user asked for and cannot have."""

NUMBERS = {int: "a whole number", float: "a number"}  # settings of other types are choices

def allowed_text(row: Field[Any]) -> str:
    """What a setting may be, in words."""
    allowed, noun = row.metadata["allowed"], NUMBERS.get(type(row.default))
    if noun:
        return f"{noun} from {allowed[0]} to {allowed[1]} {row.metadata['unit']}".rstrip()
    return " or ".join(", ".join(map(str, allowed)).rsplit(", ", 1))

def check(scene: Scene) -> None:
    """Raise BadInput, naming setting, range and value, for a scene that is not allowed."""
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
    """How it starts, motion, correction, frame rate and, where set, jitter and observed dt."""
    irregular = f", irregular by up to {100 * scene.jitter:g} %" if scene.jitter else ""
    observed = ", each step as long as the frame before" * scene.use_observed_dt
    return (f"{in_words(scene)} Motion {scene.motion}, correction {scene.correction}, "
            f"{scene.fps_target:g} frames a second{irregular}{observed}.")

def fitted(scene: Scene, details: bool) -> Scene:
    """The scene with picture and zoom shrunk together until line and details fit the terminal."""
    truth = (0.0, 0.0) if scene.show_exact_mark else None
    widest = details_text(-9999.99, -9999.99, scene.fps_target, truth) if details else ""
    columns = shutil.get_terminal_size().columns - len(widest)
    if columns >= scene.width_px or not sys.stdout.isatty():
        return scene
    columns = max(10, columns)  # the least that a scene may have; likewise the zoom
    # Columns run from 0 to width - 1: what is in the last one stays in the last one.
    m_to_px = max(0.001, scene.m_to_px * (columns - 1) / (scene.width_px - 1))
    say(f"Drawn {columns} columns wide, to fit.")
    return replace(scene, width_px=columns, m_to_px=m_to_px)

def tell_of_walls(scene: Scene) -> None:
    """Say that a wall is outside the picture, and what would show both."""
    if round(scene.left_edge_m * scene.m_to_px) < 0:
        say("The picture begins at x = 0: shift x_m and the walls.")
    elif round(scene.right_edge_m * scene.m_to_px) >= scene.width_px:
        enough = math.floor(1000 * (scene.width_px - 1) / scene.right_edge_m) / 1000
        say(f"The picture ends before a wall: m_to_px={enough:g} would show both.")

def account(scene: Scene, until_s: float) -> str:
    """What a film shows until then: the scene once more, in the steps that were planned."""
    x_m, v_mps, t_s, bounces, turns_m = scene.x_m, scene.v_mps, 0.0, list[int](), list[str]()
    for frame, (length_s, _) in enumerate(planned(scene), 1):
        dt_s = length_s if scene.use_observed_dt else 1 / scene.fps_target
        t_s += dt_s
        if t_s > until_s * (1 + 1e-9):
            break
        was_m, was_mps = x_m, v_mps
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
        if mark_m is not None:
            bounces.append(frame)
        elif was_mps and was_mps * v_mps <= 0:  # a turn in flight: which frame was further?
            turns_m.append(f"{(max if was_mps > 0 else min)(was_m, x_m):.2f}")
    apart = [str(b - a) for a, b in pairwise(bounces)]
    for figures, last in (apart, 2), (turns_m, 1):  # the first four and the last ones are enough
        figures[4:-last] = ["..."] * (len(figures) > 4 + last)
    return (f"{len(bounces) or 'no'} bounce{'s' * (len(bounces) != 1)}"
            + f", {', '.join(apart)} lines apart" * bool(apart)
            + (f"; it turned at {', '.join(turns_m)} m" if turns_m else "; no turn in flight")
            + " (about: the clock set the steps)" * scene.use_observed_dt)

def film(scene: Scene, number: int, title: str, options: dict[str, str]) -> int:
    """Print what to look for, leave time to guess, run, and print what was to be seen."""
    example = EXAMPLES.get(number, OWN_SCENE)
    details = "d" in options or example.details
    max_frames = value_of(int, options.get("--frames", "50000"))
    if not isinstance(max_frames, int) or max_frames < 1:
        raise BadInput(f"--frames N must be a whole number from 1 up, not {max_frames!r}")
    say(f"{title}.")
    say(film_in_words(scene))
    if scene.show_methods:
        say(f"{LETTERS}.")
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
            usual, shown = account(as_it_is, keys.t_s), account(scene, keys.t_s)
            if is_changed:
                say(f"As it is, in the same {keys.t_s:.2f} s: {usual}.")
                say(f"Changed: {shown if shown != usual else 'no figure differs'}.")
            else:
                say(example.seen if number in EXAMPLES else f"Your film: {shown}. {example.seen}")
            following = number + 1 if number + 1 in EXAMPLES else "chart"
            if number in EXAMPLES and keys.where():
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
    """The error for an unknown word, and what it is nearest to."""
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
    near = difflib.get_close_matches(start, names, cutoff=0.7)  # at 0.6 dt would be near to d
    near = near or [name for name in names if start and name.startswith(start)]
    hint = names[near[0]] if near else meanings[start]
    hint = f"nearest: {hint}" if hint else "-h lists all"
    return BadInput(f"unknown word {word!r}: it must be an EXAMPLE (whole number), a command, an "
                    f"option or a setting (NAME=VALUE); {hint}")

def parsed(words: list[str]) -> tuple[dict[str, str], dict[str, Any]]:
    """What the words give: EXAMPLE, command and options; and the settings that they change."""
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
    for name in methods.keys() & changes:  # chart and map set both, but a wrong word is told
        Scene(**{"motion": "exact", name: changes[name]})
    scene = Scene(**(example.settings | changes | methods))
    changed = "".join(f", {name}={value}" for name, value in changes.items())
    if number not in EXAMPLES:
        say(f"The examples are 0 to {max(EXAMPLES)}.")
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
