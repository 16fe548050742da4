#!/usr/bin/env python3
"""Air track: a car between two walls, drawn as one line of text a frame.

    python airtrack.py [EXAMPLE] [d] [NAME=VALUE ...] [--fast] [--frames N]
    python airtrack.py chart [EXAMPLE] [NAME=VALUE ...] [--save FILE]
    python airtrack.py stability [EXAMPLE] [NAME=VALUE ...]

    EXAMPLE      a number of the list below; default 0, for the other two 10
    d            details after each line: position, velocity, frame rate
    NAME=VALUE   a setting of the list below, on top of the example's own
    --fast       no pacing, no pauses, no window: for a pipe or a file
    --frames N   stop after N frames, otherwise after 50000
    chart        speed against accuracy, with --save also as .png, .svg or .pdf
    stability    where methods fail
"""
# Sections 1 to 5 are the lesson, to be read from top to bottom. Each uses what stands above it
# (only Scene calls its check, in section 8). The examples and the keys are in examples.py.

from __future__ import annotations

import sys

if __name__ == "__main__":  # Ctrl-C, even during the imports below, is no fault to be traced
    sys.excepthook = lambda *it: None if it[0] is KeyboardInterrupt else sys.__excepthook__(*it)

import difflib
import errno
import io
import math
import os
import re
import shutil
import textwrap
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import nullcontext
from dataclasses import Field, dataclass, field, fields, replace
from itertools import islice, repeat
from time import perf_counter as clock_s
from time import process_time as processor_s
from typing import Any

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))  # python -P leaves it out
from examples import EXAMPLES, OWN_SCENE, Keys

State = tuple[float, float]  # x_m, v_mps


# ==== 1. The scene: all that a run starts from ==================================================

def setting(default: Any, meaning: str, allowed: tuple[Any, ...] = (False, True),
            unit: str = "") -> Any:
    """A row of the table below. allowed: the lowest and highest of a number, or every choice."""
    return field(default=default, metadata={"meaning": meaning, "allowed": allowed, "unit": unit})

@dataclass(frozen=True)
class Scene:
    """The settings; their names carry their units. Raises ValueError for what is not allowed."""

    x_m: float = setting(1.1, "starting position", (-1000, 1000), "m")
    v_mps: float = setting(0.0, "starting velocity, to the right above 0", (-1000, 1000), "m/s")
    a_mps2: float = setting(0.0, "constant acceleration", (-1000, 1000), "m/s^2")
    left_edge_m: float = setting(0.25, "the left wall", (-1000, 1000), "m")
    right_edge_m: float = setting(2.2, "the right wall", (-1000, 1000), "m")
    CR: float = setting(0.8, "coefficient of restitution: speed after / before a bounce", (0, 1))
    motion: str = setting("backward", "how the car is moved", ("forward", "backward", "exact"))
    correction: str = setting("rebound", "how a collision is settled",
                              ("none", "surface", "rebound", "rewind", "replay"))
    fps_target: float = setting(30.0, "frames a second: step and pace at once", (0.1, 1000), "1/s")
    use_observed_dt: bool = setting(False, "step by the observed length of the frame before")
    auto_off: bool = setting(True, "stop when the car rests against a wall")
    m_to_px: float = setting(55.0, "zoom, in characters a metre", (0.001, 1000), "px/m")
    width_px: int = setting(135, "characters in a line, from x = 0 on", (10, 1000), "px")
    show_start_mark: bool = setting(False, "draw a . where the car started")
    show_collision_mark: bool = setting(True, "draw a 0 where the move alone ended, in a collision")
    show_exact_mark: bool = setting(False, "draw an o where it truly is")

    def __post_init__(self) -> None:
        check(self)

    def to_track(self, x_m: float) -> float:
        """x_m itself, or the wall that it is beyond."""
        if x_m < self.left_edge_m:
            return self.left_edge_m
        return self.right_edge_m if x_m > self.right_edge_m else x_m


# ==== 2. Moving: where is the car dt_s later, if there are no walls? ============================
#
# v changes during the frame. Euler's methods act as if it did not: forward takes the v of the
# frame's start for the whole frame, backward (here the same as semi-implicit) that of its end.
# E = v^2/2 - a x is the car's energy per kilogram; in free flight it should stay as it is.

def forward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Forward Euler: x + v dt, then v + a dt. E changes by +a^2 dt^2/2."""
    return x_m + v_mps * dt_s, v_mps + a_mps2 * dt_s

def backward(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Backward Euler: v + a dt, then x + v dt. E changes by -a^2 dt^2/2."""
    v_mps += a_mps2 * dt_s
    return x_m + v_mps * dt_s, v_mps

def exact(x_m: float, v_mps: float, a_mps2: float, dt_s: float) -> State:
    """Kinematics: x + v dt + a dt^2/2, which is x + (v0 + v1)/2 dt, and v + a dt. E stays."""
    return x_m + v_mps * dt_s + a_mps2 * dt_s * dt_s / 2, v_mps + a_mps2 * dt_s

# A fourth motion is written above, and named here and in the Scene's table.
MOTIONS = {"forward": forward, "backward": backward, "exact": exact}


# ==== 3. Colliding: the move ended beyond a wall; where is the car really? ======================
#
# The corrections, from the crudest to the best. Each gets the x and v that the move ended with, the
# wall that x is beyond, a and CR. The first three turn v round, keep CR of it, and differ in x.

def none(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Leave the car beyond the wall: a trap.

    Slowed by CR < 1, or pulled into the wall, it may not get back out within one frame. Then the
    next frame finds it in collision again, and turns it round again: deeper into the wall. From
    there on each way out is shorter than the way in before it. It is stuck, and under a pull it
    sinks (example 3).
    """
    return x_m, -CR * v_mps

def surface(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car on the wall, where it cannot be stuck.

    The part of the frame after the bounce is lost: the car leaves the wall up to dt late. And at
    CR = 1 it is lifted at the same speed, against a pull g: E gains g overlap.
    """
    return wall_m, -CR * v_mps

def rebound(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Put the car CR * overlap off the wall: about as far as it has bounced back by now.

    About, because it bounced with its speed at the wall, not with that of the frame's end. At
    CR = 1 it is lifted by 2 overlap, so E gains 2 g overlap: with v dt/2 for the average overlap,
    g v dt a bounce. Backward Euler loses g^2 dt^2/2 a frame, in the 2 v/(g dt) frames of a flight
    g v dt as well: the car wanders about the truth (example 16). Exact loses nothing: E grows.
    A CR * overlap longer than the track throws it through the far wall (example 14).
    """
    overlap_m = x_m - wall_m
    return x_m - overlap_m * (1 + CR), -CR * v_mps

def rewind(x_m: float, v_mps: float, wall_m: float, a_mps2: float, CR: float) -> State:
    """Go back to the wall, bounce there, and go forward again for as long as the car was beyond.

    Undoes the exact motion by its own formulas, so it goes with that one only (example 10). Right
    for one bounce a frame. Of a second one, on the way forward, it cannot know.
    """
    overlap_m = x_m - wall_m
    # The speed s at the wall, from energy: s^2 = v^2 - 2 a overlap. s points out, as overlap does.
    s_mps = math.copysign(math.sqrt(max(0.0, v_mps**2 - 2 * a_mps2 * overlap_m)), overlap_m)
    # The time t beyond, from the mean velocity: overlap = (s + v)/2 t. (A car that was beyond from
    # the start may have no such s and t: it is put on the wall.)
    crossed_it = (s_mps + v_mps) * overlap_m > 0
    t_s = 2 * overlap_m / (s_mps + v_mps) if crossed_it else 0.0
    x_m, v_mps = exact(wall_m, -CR * s_mps, a_mps2, t_s)
    is_beyond_again = (x_m - wall_m) * overlap_m > 0
    return wall_m if is_beyond_again else x_m, v_mps

CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "rewind": rewind}
EXACT_ONLY = ("rewind", "replay")  # they undo or follow that motion

def step(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> tuple[float, float, float | None]:
    """One frame of dt_s: move the car, settle any collision. Returns x_m, v_mps, mark_m.

    mark_m, None without a collision, is where the move alone ended: after the correction there
    would be nothing to see of the collision.
    """
    free_m, free_mps = MOTIONS[scene.motion](x_m, v_mps, scene.a_mps2, dt_s)
    wall_m = scene.to_track(free_m)
    is_beyond = wall_m != free_m
    if scene.correction == "replay":
        # Only where v changed its sign may the car have been beyond a wall and come back.
        if is_beyond or v_mps * free_mps <= 0:
            x_m, v_mps = replay(scene, x_m, v_mps, dt_s)
            return x_m, v_mps, None if (x_m, v_mps) == (free_m, free_mps) else free_m
    elif is_beyond:
        correct = CORRECTIONS[scene.correction]
        return *correct(free_m, free_mps, wall_m, scene.a_mps2, scene.CR), free_m
    return free_m, free_mps, None

def replay(scene: Scene, x_m: float, v_mps: float, dt_s: float) -> State:
    """Look at the frame again, from its start, and follow the exact motion from wall to wall.

    No correction of the move, then, but right for frames of any length, with several bounces
    (example 15) or infinitely many (example 12). The loop ends: after the first flight each one
    crosses the whole track, which takes time, or begins hops, which are taken all at once.
    """
    x_m, a_mps2, CR = scene.to_track(x_m), scene.a_mps2, scene.CR
    left_m, right_m = scene.left_edge_m, scene.right_edge_m
    graze_m = 1e-12 * (abs(left_m) + abs(right_m))  # no further beyond a wall is round-off
    t_s = dt_s  # what is left of the frame
    while True:
        # Which wall is next? Seen towards the left one, distance and speed change their sign.
        left_s, left_mps = arrival(x_m - left_m, -v_mps, -a_mps2, graze_m)
        right_s, right_mps = arrival(right_m - x_m, v_mps, a_mps2, graze_m)
        if left_s < right_s:
            side, wall_m, flight_s, s_mps = -1, left_m, left_s, left_mps
        else:
            side, wall_m, flight_s, s_mps = 1, right_m, right_s, right_mps
        if flight_s > t_s:
            break  # none within the frame
        # Go there, and bounce.
        t_s -= flight_s
        x_m, v_mps, g_mps2 = wall_m, -side * CR * s_mps, side * a_mps2
        # v^2/(2 g) <= track: too slow for the other wall, against the pull g back to this one.
        if g_mps2 > 0 and v_mps * v_mps <= 2 * g_mps2 * (right_m - left_m):
            t_s, v_mps = hops(v_mps, g_mps2, CR, t_s)
            break
    x_m, v_mps = exact(x_m, v_mps, a_mps2, t_s)
    return scene.to_track(x_m), v_mps  # round-off must not end beyond a wall

def arrival(d_m: float, u_mps: float, g_mps2: float, graze_m: float) -> tuple[float, float]:
    """When, and how fast, does the car reach a wall d_m ahead? (t_s, s_mps); never: (inf, 0).

    u_mps is its speed, g_mps2 its acceleration, both towards the wall.
    """
    never = math.inf, 0.0
    if u_mps <= 0 and g_mps2 <= 0:
        return never
    # The speed at the wall, from energy: s^2 = u^2 + 2 g d.
    s_squared = u_mps * u_mps + 2 * g_mps2 * d_m
    # Slowed down (g < 0), the car turns s^2/(-2 g) beyond the wall; before it, if s^2 < 0. A graze
    # is a miss, too: as a hit it would bounce at an s that is the root of round-off, 1e-8 from
    # 1e-16, and be that much off from there on.
    if s_squared < -2 * g_mps2 * graze_m:
        return never
    s_mps = math.sqrt(s_squared)
    # t = (s - u)/g = 2 d/(u + s): the form in which nothing cancels.
    return (2 * d_m / (u_mps + s_mps) if u_mps > 0 else (s_mps - u_mps) / g_mps2), s_mps

def hops(v_mps: float, g_mps2: float, CR: float, t_s: float) -> tuple[float, float]:
    """Take all whole hops that fit into t_s at once. Returns the time left, and v off the wall.

    So a frame costs the same with three hops and with a million, and ends even where they are
    infinitely many. Under a pull g the car hops for h = 2 v/g, then for CR h, CR^2 h, and so on; n
    hops last h (1 - CR^n)/(1 - CR). Infinitely many last only h/(1 - CR): the Zeno point, from
    where on the car is at rest. So it is where a hop is lost in the rounding of t_s.
    """
    h_s = 2 * abs(v_mps) / g_mps2
    if h_s <= t_s * (1 - CR) or t_s + h_s == t_s:
        return 0.0, 0.0
    if CR == 1:
        return math.fmod(t_s, h_s), v_mps
    # h (1 - CR^n)/(1 - CR) = t, solved for n. log1p(y) = log(1 + y) and expm1(y) = e^y - 1, without
    # the rounding of 1 + y that would spoil them near CR = 1.
    n = math.floor(math.log1p(-t_s * (1 - CR) / h_s) / math.log(CR))
    n_hops_s = -h_s * math.expm1(n * math.log(CR)) / (1 - CR)
    return max(0.0, t_s - n_hops_s), v_mps * CR**n


# ==== 4. Drawing: one frame, one line ===========================================================

def paint(line: bytearray, mark: str, x_px: float) -> None:
    """Put the mark into its column, if the line has it, over what is there."""
    column = round(x_px)  # int would round -0.9 to 0, into the picture
    if 0 <= column < len(line):
        line[column] = ord(mark)

def render_track(scene: Scene, x_m: float, mark_m: float | None = None,
                 exact_m: float | None = None) -> str:
    """The track as scene.width_px characters, painted from back to front; the last one is seen."""
    line, zoom = bytearray(b" " * scene.width_px), scene.m_to_px
    if scene.show_exact_mark and exact_m is not None:
        paint(line, "o", exact_m * zoom)
    if scene.show_collision_mark and mark_m is not None:
        paint(line, "0", mark_m * zoom)
    if scene.show_start_mark:
        paint(line, ".", scene.x_m * zoom)
    paint(line, "|", scene.left_edge_m * zoom)
    paint(line, "|", scene.right_edge_m * zoom)
    column, last = round(x_m * zoom), scene.width_px - 1
    mark = "<" if column < 0 else ">" if column > last else "*"
    paint(line, mark, min(max(column, 0), last))
    return line.decode()

def details_text(x_m: float, v_mps: float, fps: float, exact_m: float | None) -> str:
    """What d adds to a line: position, velocity, frame rate, and the error beside exact_m."""
    text = f"x = {x_m:6.2f}, v = {v_mps:5.2f}, FPS = {fps:3.0f}"
    return text if exact_m is None else f"{text}, err = {x_m - exact_m:9.2e}"


# ==== 5. The run: the main loop =================================================================

def paced(scene: Scene, keys: Keys) -> Iterator[tuple[float, float]]:
    """Yield dt_s and the rate in FPS at each frame's deadline. dt_s = 0: the car is to hold still.

    The deadlines are absolute. A sleep of dt after each frame would add to it the time that it
    takes to compute and to print, and what sleep oversleeps.
    """
    frame, t_s, nominal_s, deadline_s = 0, 0.0, 1 / scene.fps_target, clock_s()
    began_s = deadline_s - nominal_s
    while True:
        was_held = keys.wait_until(deadline_s, frame, t_s)
        if keys.why_quit:
            return
        now_s = clock_s()
        length_s = nominal_s if was_held else now_s - began_s
        # Long enough to be seen, and half as long again as a frame should be: a stall, such as a
        # dragged window. As an observed dt it would be a leap; a fixed one waits, to look alike.
        is_stall = length_s > max(0.15, 1.5 * nominal_s)
        dt_s = 0.0 if is_stall else length_s if scene.use_observed_dt else nominal_s
        yield dt_s, 1 / length_s
        frame, t_s, began_s = frame + 1, t_s + dt_s, now_s
        deadline_s += nominal_s
        if now_s > deadline_s:  # missed by a frame: no burst to make it up
            deadline_s = now_s + nominal_s

def exactly(scene: Scene) -> Scene:
    """The scene by the exact solution, which has to start on the track."""
    return replace(scene, motion="exact", correction="replay", x_m=scene.to_track(scene.x_m))

def run(scene: Scene, ink: dict[int, str], details: bool, limit: int, keys: Keys | None) -> int:
    """Film the scene in these inks, and say why it ended. Returns the exit status."""
    x_m, v_mps, truth = scene.x_m, scene.v_mps, exactly(scene)
    exact_m = truth.x_m if scene.show_exact_mark else None
    exact_mps = truth.v_mps
    recent_m = deque[float](maxlen=10)
    frame, t_s, why = 0, 0.0, "that is the frame limit"
    frames = paced(scene, keys) if keys else repeat((1 / scene.fps_target, scene.fps_target))
    for frame, (dt_s, fps) in enumerate(islice(frames, limit), start=1):
        # Move and settle.
        mark_m = None
        if dt_s:
            x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
            if exact_m is not None:
                exact_m, exact_mps, _ = step(truth, exact_m, exact_mps, dt_s)
        t_s += dt_s
        # Draw.
        line = render_track(scene, x_m, mark_m, exact_m).translate(ink)
        text = details_text(x_m, v_mps, fps, exact_m) if details else ""
        sys.stdout.write(f"{line}{text}\n")
        if keys:
            sys.stdout.flush()
        # At rest? Taken to be so when the last ten positions average to a wall's.
        recent_m.append(x_m)
        mean_m = sum(recent_m) / 10
        off_m = min(abs(mean_m - scene.left_edge_m), abs(mean_m - scene.right_edge_m))
        if scene.auto_off and frame >= 10 and off_m <= 0.001:
            why = "the car is at rest against a wall"
            break
    if keys and keys.why_quit:
        why = keys.why_quit
    print(f"Stopped after {frame} frame{'s' * (frame != 1)}, t = {t_s:.2f} s: {why}.", flush=True)
    return keys.status if keys else 0


# ==== 6. Speed against accuracy: the chart ======================================================

SPAN_S, CUTS = 20, 9  # what chart and map simulate, and in how many ways they cut it into frames
CHART_FPS = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)  # multiples of 10, or divisors
SERIES = {
    "f": ("forward", "rebound"),
    "s": ("backward", "surface"),
    "b": ("backward", "rebound"),
    "w": ("exact", "rewind"),
    "e": ("exact", "replay"),
}
RED, GREEN, AMBER, BLUE, VIOLET = 31, 32, 33, 34, 35  # as terminals number them
FILM_INK = {"*": AMBER, "<": AMBER, ">": AMBER, "0": RED, "o": GREEN}
CHART_INK = {"f": RED, "s": VIOLET, "b": BLUE, "w": GREEN, "e": AMBER}
NO_ERROR_M = 1e-16  # drawn for 0, which has no logarithm
Points = dict[str, list[tuple[int, float, float]]]  # letter: (fps, error_m, cost_s) at each rate

def inks(colours: dict[str, int]) -> dict[int, str]:
    """For str.translate: the characters in their colours, if standard output shows colours."""
    is_dumb = os.environ.get("TERM", "dumb") == "dumb" and "WT_SESSION" not in os.environ
    if is_dumb or os.environ.get("NO_COLOR") or not sys.stdout.isatty():
        return {}
    return {ord(mark): f"\033[{colour}m{mark}\033[0m" for mark, colour in colours.items()}

def columns() -> int:
    """The width of the terminal."""
    return shutil.get_terminal_size().columns

def picture_columns() -> int:
    """The width of a picture in characters: the terminal's, within reason."""
    return max(60, min(100, columns()))

def say(text: str, indent: int = 0) -> None:
    """Print a paragraph as wide as the terminal, or as is good to read."""
    print(textwrap.fill(text, min(100, columns()), subsequent_indent=" " * indent), flush=True)

def truths(scene: Scene) -> list[State]:
    """The true state at every tenth of a second, each by one exact step from the start."""
    truth = exactly(scene)
    times_s = (tenth / 10 for tenth in range(10 * SPAN_S + 1))
    return [step(truth, truth.x_m, truth.v_mps, t_s)[:2] for t_s in times_s]

def simulate(scene: Scene, fps: int, cut: int, tenths: list[State]) -> Iterator[
        tuple[float, float, float]]:
    """Yield x_m, v_mps and |x - truth| at the start and after each frame, for SPAN_S.

    Where in a frame the car meets a wall is luck. So a run begins cut/9 of a frame late, where the
    car then truly is. |x - truth| is taken every 0.1 s, or after each longer frame; 0 in between.
    """
    truth = exactly(scene)
    dt_s, late_s = 1 / fps, cut / CUTS / fps
    frames_a_sample = max(1, fps // 10)
    x_m, v_mps, _ = step(truth, *tenths[0], late_s)
    yield x_m, v_mps, 0.0
    for frame in range(1, SPAN_S * fps + 1):
        x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
        error_m = 0.0
        if frame % frames_a_sample == 0:
            true_m, _, _ = step(truth, *tenths[10 * frame // fps], late_s)
            error_m = abs(x_m - true_m)
        yield x_m, v_mps, error_m

def cost_s(scene: Scene, fps: int) -> float:
    """Processor time of the loop that steps the car, for a simulated second; best of several."""
    dt_s, costs_s = 1 / fps, []
    for _ in range(max(3, 200 // fps)):
        x_m, v_mps, began_s = scene.x_m, scene.v_mps, processor_s()
        for _ in range(SPAN_S * fps):
            x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
        costs_s.append((processor_s() - began_s) / SPAN_S)
    return max(min(costs_s), 1e-9)  # 0 where the clock is coarse

def measure(scene: Scene) -> Points:
    """Every series at every rate: the largest error in any of the cuts, and the cost."""
    tenths = truths(scene)
    points: Points = {}
    for letter, (motion, correction) in SERIES.items():
        method = replace(scene, motion=motion, correction=correction)
        points[letter] = []
        for fps in CHART_FPS:
            progress(f"measuring {motion} + {correction} at {fps} FPS")
            runs = (simulate(method, fps, cut, tenths) for cut in range(CUTS))
            error_m = max(error_m for run in runs for _, _, error_m in run)
            points[letter].append((fps, error_m, cost_s(method, fps)))
    return points

def progress(text: str = "") -> None:
    """On a terminal, show a line that the next one replaces; without a text, clear it."""
    if sys.stdout.isatty():
        print(f"\r{text:50}\r", end="", flush=True)

def powers_of_ten(values: list[float]) -> tuple[int, int]:
    """The exponents between which the values lie."""
    return math.floor(math.log10(min(values))), math.floor(math.log10(max(values))) + 1

def picture(points: Points, pixel_m: float, page: int) -> str:
    """The points as letters on log-log axes, error over cost, on a page so many columns wide."""
    every_point = [point for series in points.values() for point in series]
    left, right = powers_of_ten([cost_s for _, _, cost_s in every_point])
    bottom, top = powers_of_ten([max(error_m, NO_ERROR_M) for _, error_m, _ in every_point])
    # A power of ten is so many columns wide and rows high. A rate has room on either side.
    wide = (page - 28) // (right - left)
    high = max(1, 20 // (top - bottom))
    width = 4 + wide * (right - left) + 6

    def row_of(error_m: float) -> int:
        return round((top - math.log10(max(error_m, NO_ERROR_M))) * high)

    def column_of(cost_s: float) -> int:
        return 4 + round((math.log10(cost_s) - left) * wide)

    rows = [[" "] * width for _ in range(high * (top - bottom) + 1)]
    pixel_row = row_of(pixel_m)
    if 0 <= pixel_row < len(rows):
        rows[pixel_row] = ["-"] * width
    for letter, series in points.items():
        for _, error_m, cost_s in series:
            row, column = rows[row_of(error_m)], column_of(cost_s)
            is_free = row[column] in (" ", "-", letter)
            row[column] = letter if is_free else "+"
    for series in points.values():
        for fps, error_m, cost_s in (series[0], series[-1]):
            row, column = rows[row_of(error_m)], column_of(cost_s)
            is_first = fps == series[0][0]
            text = f"{fps} " if is_first else f" {fps}"
            begin = column - len(text) if is_first else column + 1
            place = slice(begin, begin + len(text))
            if set(row[place]) <= {" ", "-"}:
                row[place] = text
    lines, ink = ["error (m)"], inks(CHART_INK)
    for number, row in enumerate(rows):
        power = f"1e{top - number // high:+03d}" if number % high == 0 else ""
        name = " one pixel" if number == pixel_row else ""
        lines.append(f"{power:>6} |{''.join(row).rstrip().translate(ink)}{name}")
    ticks = [f"{10.0**(x + 6):g} us" for x in range(left, right + 1)]
    lines.append(" " * 7 + "+" + "-" * width)
    lines.append(" " * 12 + "".join(f"{tick:{wide}}" for tick in ticks).rstrip())
    lines.append(f"{'+ where series meet':23}processor time for a simulated second")
    return "\n".join(lines)

def two_digits(value: float) -> str:
    """As many as a measured cost is good for, and no exponent."""
    return f"{float(f'{value:.1e}'):g}"

def table(points: Points) -> str:
    """The figures: error in m and cost in us of every series at every rate."""
    motions, corrections, units = " " * 4, " " * 4, " FPS"
    for letter in points:
        motion, correction = SERIES[letter]
        motions += f"{f'{letter} {motion}':>15}"
        corrections += f"{f'+ {correction}':>15}"
        units += "  error m    us"
    lines = [motions, corrections, units]
    for row in zip(*points.values(), strict=True):
        cells = (f"{error_m:9.1e}{two_digits(1e6 * cost_s):>6}" for _, error_m, cost_s in row)
        lines.append(f"{row[0][0]:4}{''.join(cells)}")
    return "\n".join(lines)

def conclusion(points: Points, pixel_m: float) -> str:
    """What each method needs to stay within one drawn pixel, and what it costs beside replay."""
    exact_cost_s = points["e"][0][2]
    needs = []
    for letter, series in reversed(points.items()):
        too_coarse = [fps for fps, error_m, _ in series if error_m > pixel_m]
        enough = [point for point in series if point[0] > max(too_coarse, default=0)]
        need = f"more than {CHART_FPS[-1]} FPS"
        if enough:
            fps, _, cost_s = enough[0]
            times = f"{two_digits(cost_s / exact_cost_s)} times that"
            spent = f"{two_digits(1e6 * cost_s)} us of processor time for a simulated second"
            need = f"{fps} FPS and {spent if letter == 'e' else times}"
        needs.append(f"{' + '.join(SERIES[letter])} needs {need}")
    return (f"To stay within one drawn pixel of the truth ({1000 * pixel_m:.3g} mm) in all nine "
            f"cuts, {', '.join(needs)}.")

def new_figure(file: str) -> Any:
    """A picture with its title, by matplotlib. Raises ValueError if it could not be saved."""
    if not os.path.splitext(file)[1]:
        raise ValueError(f"--save needs a FILE that ends in .png, .svg or .pdf, not {file!r}")
    try:
        from matplotlib.figure import Figure
        figure = Figure(figsize=(8, 6), dpi=150, layout="constrained")
        figure.suptitle("Speed against accuracy", fontsize=18, fontweight="bold")
        rendered(figure, file)
        is_new = not os.path.exists(file)
        open(file, "ab").close()
        if is_new:
            os.remove(file)
        return figure
    except Exception as fault:  # matplotlib and what it draws with may raise anything
        why = " ".join(str(fault).split()) or repr(fault)
        if isinstance(fault, ModuleNotFoundError) and fault.name == "matplotlib":
            why = "this needs matplotlib: python -m pip install '.[chart]'"
        raise ValueError(f"--save {file!r}: {why}") from None

def rendered(figure: Any, file: str) -> bytes:
    """What is to stand in the file, in the format of its suffix."""
    content = io.BytesIO()
    figure.savefig(content, format=os.path.splitext(file)[1][1:])
    return content.getvalue()

def draw(figure: Any, points: Points, pixel_m: float, subtitle: str) -> None:
    """Draw the chart with matplotlib, so that it explains itself on a slide."""
    axes = figure.add_subplot()
    axes.set_title(textwrap.fill(subtitle, 80), fontsize=10)
    axes.set_xlabel("processor time for a simulated second (\N{MICRO SIGN}s)", fontsize=12)
    axes.set_ylabel(f"largest error in {SPAN_S} s (m)", fontsize=12)
    costs_us = [1e6 * cost_s for series in points.values() for _, _, cost_s in series]
    left_us, names_us = min(costs_us) / 20, 1.6 * max(costs_us)
    # From the largest error down, so that the names beside the lines' ends can keep a distance.
    ranked = sorted(points, key=lambda letter: -points[letter][-1][1])
    name_y = math.inf
    small = {"fontsize": 9.5, "textcoords": "offset points"}
    for letter in ranked:
        number = list(SERIES).index(letter)
        rates, errors_m, costs_s = zip(*points[letter], strict=True)
        xs_us = [1e6 * cost_s for cost_s in costs_s]
        ys_m = [max(error_m, NO_ERROR_M) for error_m in errors_m]
        axes.loglog(xs_us, ys_m, f"C{number}{'os^Dv'[number]}-", markersize=5)
        name_y = min(math.log10(ys_m[-1]), name_y - 0.75)
        axes.text(names_us, 10**name_y, " + ".join(SERIES[letter]), color=f"C{number}",
                  fontsize=12, fontweight="bold", verticalalignment="center")
        if letter in (ranked[0], ranked[-1]):
            above = 10 if letter == ranked[0] else -18
            for fps, x_us, y_m in zip(rates, xs_us, ys_m, strict=True):
                text = f"{fps} FPS" if fps == rates[0] else f"{fps}"
                axes.annotate(text, (x_us, y_m), (0, above), ha="center", **small)
    middle = len(xs_us) // 2
    axes.annotate("rises, as each frame is rounded once:\nmore frames, more roundings",
                  (xs_us[middle], ys_m[middle]), (35, -60), style="italic", **small)
    axes.plot((left_us, names_us), (pixel_m, pixel_m), "k--", linewidth=1)
    axes.annotate(f"one drawn pixel,\n{pixel_m:.2g} m", (1.2 * left_us, pixel_m), (0, -5),
                  va="top", **small)
    axes.annotate("better: faster,\nmore accurate", (0.02, 0.4), (0.08, 0.5), fontsize=11,
                  xycoords="axes fraction", textcoords="axes fraction", fontweight="bold",
                  arrowprops={"color": "black", "width": 2, "headwidth": 9})
    axes.set_xlim(left_us, 60 * names_us)
    bottom_m, top_m = axes.get_ylim()
    axes.set_ylim(bottom_m / 300, 4 * top_m)

def chart(scene: Scene, heading: str, file: str | None, figure: Any) -> int:
    """Measure; show picture, table and conclusion; with a file, draw the figure into it."""
    pixel_m = 1 / scene.m_to_px
    try:
        points = measure(scene)
    finally:
        progress()
    say(f"Speed against accuracy. {heading}")
    print(f"\n{picture(points, pixel_m, picture_columns())}\n\n{table(points)}\n")
    say(conclusion(points, pixel_m))
    if file is not None:
        start, _, _ = heading.partition(" (")
        draw(figure, points, pixel_m, f"{start} The worst of nine runs of {SPAN_S} s counts.")
        content = rendered(figure, file)
        with open(file, "wb") as picture_file:
            picture_file.write(content)
        print(f"\nSaved as {file!a}.")
    return 0


# ==== 7. Where methods fail: the stability map ==================================================

MAP_FPS = (1, 2, 5, 10, 30, 60, 120, 240, 1000)
MAP_INK = {"X": RED, "S": VIOLET, "G": AMBER, "P": BLUE, "-": GREEN}
VERDICTS = {
    "X": "thrown further than a track's length beyond a wall",
    "S": "stuck: beyond the same wall all through the last 5 s",
    "G": "gained more than 1 % of its energy",
    "P": "more than a drawn pixel from the truth at some sample",
    "-": "within a pixel of the truth at every sample",
}

def verdict(scene: Scene, fps: int, cut: int, tenths: list[State]) -> str:
    """The first of VERDICTS, which begin with the worst, that a run deserves."""
    track_m = scene.right_edge_m - scene.left_edge_m
    low_m = scene.right_edge_m if scene.a_mps2 > 0 else scene.left_edge_m  # it is pulled there
    beyond_m, energies, worst_m = deque[float](maxlen=5 * fps), [], 0.0
    for x_m, v_mps, error_m in simulate(scene, fps, cut, tenths):
        beyond_m.append(x_m - scene.to_track(x_m))
        if abs(beyond_m[-1]) > track_m:
            return "X"
        energies.append(v_mps * v_mps / 2 - scene.a_mps2 * (x_m - low_m))
        worst_m = max(worst_m, error_m)
    if min(beyond_m) > 0 or max(beyond_m) < 0:
        return "S"
    if max(energies) > 1.01 * energies[0] + 1e-9:
        return "G"
    return "P" if worst_m > 1 / scene.m_to_px else "-"

def stability(scene: Scene, heading: str) -> int:
    """Print the map: a row a method, a column a rate, a letter for the worst of the cuts."""
    tenths, ink, rows = truths(scene), inks(MAP_INK), {}
    say(f"Stability. {heading}")
    print(f"\n{'FPS':20}" + "".join(f"{fps:6}" for fps in MAP_FPS))
    for motion in MOTIONS:
        print()
        for correction in (*CORRECTIONS, "replay"):
            if motion != "exact" and correction in EXACT_ONLY:
                continue
            name = f"{motion} + {correction}"
            method = replace(scene, motion=motion, correction=correction)
            rows[name] = ""
            for fps in MAP_FPS:
                found = {verdict(method, fps, cut, tenths) for cut in range(CUTS)}
                rows[name] += next(letter for letter in VERDICTS if letter in found)
            print(f"{name:20}" + "".join(f"{letter:>6}" for letter in rows[name]).translate(ink))
    print()
    for letter, meaning in VERDICTS.items():
        print(f"{letter.translate(ink)}  {meaning}")
    print()
    say(map_conclusion(rows))
    return 0

def map_conclusion(rows: dict[str, str]) -> str:
    """Which methods get - at every rate, and from which rate on each of the others does."""
    parts = []
    for column in range(len(MAP_FPS) + 1):
        names = [name for name, letters in rows.items() if len(letters.rstrip("-")) == column]
        when = "at every rate" if column == 0 else f"not even at {MAP_FPS[-1]} FPS"
        if 0 < column < len(MAP_FPS):
            when = f"from {MAP_FPS[column]} FPS on"
        if names:
            parts.append(f"{when}: {', '.join(names)}")
    return f"Within a pixel in all nine cuts, {'; '.join(parts)}."


# ==== 8. Checking a scene =======================================================================

def is_number(row: Field[Any]) -> bool:
    """Whether a setting is a number in a range, rather than one of a few values."""
    return not isinstance(row.default, (bool, str))

def allowed_text(row: Field[Any]) -> str:
    """What a setting may be, in words."""
    allowed, unit = row.metadata["allowed"], row.metadata["unit"]
    if is_number(row):
        kind = "whole, " if isinstance(row.default, int) else ""
        return f"{kind}from {allowed[0]} to {allowed[1]} {unit}".rstrip()
    return " or ".join(", ".join(map(str, allowed)).rsplit(", ", 1))

def is_allowed(row: Field[Any], value: object) -> bool:
    """Whether a value is one that the setting may have."""
    allowed = row.metadata["allowed"]
    if is_number(row):
        kinds = int if isinstance(row.default, int) else (int, float)
        is_kind = isinstance(value, kinds) and not isinstance(value, bool)
        return is_kind and allowed[0] <= value <= allowed[1]
    return type(value) is type(row.default) and value in allowed

def check(scene: Scene) -> None:
    """Raise ValueError, with setting, value and range, for a scene that cannot be."""
    for row in fields(scene):
        value = getattr(scene, row.name)
        if not is_allowed(row, value):
            raise ValueError(f"{row.name} must be {allowed_text(row)}, not {value!r}")
    left_m, right_m = scene.left_edge_m, scene.right_edge_m
    if round(right_m - left_m, 9) < 0.01:  # 2.21 - 2.2 is a bit less
        raise ValueError("right_edge_m must be at least 0.01 m to the right of left_edge_m, "
                         f"{left_m!r}, not {right_m!r}")
    if scene.correction in EXACT_ONLY and scene.motion != "exact":
        raise ValueError(f"motion must be exact with correction={scene.correction}, "
                         f"not {scene.motion!r}")
    if scene.correction == "replay" and scene.x_m != scene.to_track(scene.x_m):
        raise ValueError(f"x_m must be on the track with correction=replay, from {left_m} to "
                         f"{right_m} m, not {scene.x_m}")


# ==== 9. The command line =======================================================================

SETTINGS = {row.name: row for row in fields(Scene)}
FILM, COMMANDS = "a film", ("chart", "stability")
OPTIONS = {"d": FILM, "--fast": FILM, "--frames": FILM, "--save": "chart"}

def in_words(scene: Scene) -> str:
    """How the car starts."""
    def towards(signed: float) -> str:
        return f"to the {'right' if signed > 0 else 'left'} at {abs(signed):g}"

    speed = f"moving {towards(scene.v_mps)} m/s" if scene.v_mps else "at rest"
    pull = f"pulled {towards(scene.a_mps2)} m/s^2" if scene.a_mps2 else "not pulled"
    return f"The car starts at x = {scene.x_m:g} m, {speed}, {pull}; CR = {scene.CR:g}."

def method_in_words(scene: Scene) -> str:
    """How it is moved and settled, how often, and what else is not as by default."""
    told = ("x_m", "v_mps", "a_mps2", "CR", "motion", "correction", "fps_target")
    text = (f"Motion {scene.motion}, correction {scene.correction}, "
            f"{scene.fps_target:g} frames a second")
    for row in fields(scene):
        value = getattr(scene, row.name)
        if row.name not in told and value != row.default:
            text += f", {row.name}={value}"
    return f"{text}."

def fit(scene: Scene, details: bool) -> Scene:
    """The scene with track and zoom shrunk together until line and details fit the terminal."""
    if not sys.stdout.isatty():
        return scene
    exact_m = 0.0 if scene.show_exact_mark else None
    x_m, v_mps = min(-99, scene.left_edge_m), min(-99, -abs(scene.v_mps))
    widest = details_text(x_m, v_mps, scene.fps_target, exact_m) if details else ""
    width_px = min(scene.width_px, columns() - len(widest))
    width_px = max(10, width_px)
    m_to_px = max(0.001, scene.m_to_px * width_px / scene.width_px)
    return replace(scene, width_px=width_px, m_to_px=m_to_px)

def notices(scene: Scene, view: Scene) -> Iterator[str]:
    """What a reader should know of the picture before it begins."""
    left_px = round(scene.left_edge_m * scene.m_to_px)
    right_px = round(scene.right_edge_m * scene.m_to_px)
    if left_px < 0:
        yield ("A wall is to the left of x = 0, where the picture begins, whatever m_to_px: only "
               "a scene further to the right would show it.")
    elif right_px >= scene.width_px:
        enough = math.floor(1000 * (scene.width_px - 1) / scene.right_edge_m) / 1000
        yield f"The picture ends before a wall: m_to_px={enough:g} would show both."
    if view.width_px < scene.width_px:
        yield (f"To fit this terminal, the track is drawn {view.width_px} px wide at "
               f"{view.m_to_px:.3g} px/m. The physics is untouched.")

def film(scene: Scene, introduction: list[str], pause_s: float, details: bool, limit: int,
         keys: Keys | None) -> int:
    """Say what is to be seen and which keys there are, leave time to read it, and run."""
    with keys or nullcontext():
        for paragraph in introduction:
            say(paragraph)
        view = fit(scene, details)
        for notice in notices(scene, view):
            say(notice)
        if keys:
            keys.open_window()
            say(keys.help())
            if pause_s:
                say(f"The film begins in {pause_s:g} s. p holds this text; Ctrl-C begins at once.")
            if keys.is_cut_short(pause_s):
                print("   *\n  * *\n *   *\n  * *\n   *")  # to say that it was
        if keys or introduction:
            print(flush=True)
        return run(view, inks(FILM_INK) if keys else {}, details, limit, keys)

def manual() -> int:
    """Print the usage, the examples and the settings."""
    print(__doc__)
    print("Examples:")
    for number, example in EXAMPLES.items():
        print(f"  {number:2}  {example.title}")
    print("\nSettings: default, meaning, what is allowed")
    for name, row in SETTINGS.items():
        text = f"  {name:20}{row.default!s:9}{row.metadata['meaning']}: {allowed_text(row)}"
        say(text, indent=31)
    return 0

def value_of(name: str, text: str) -> object:
    """The value of a setting that a text stands for; the text itself where it is none."""
    kind: Callable[[str], object] = type(SETTINGS[name].default)
    if kind is bool:
        return {"true": True, "false": False}.get(text.lower(), text)
    is_plain = kind is str or re.fullmatch("[-+.0-9eE]+", text)
    try:
        return kind(text) if is_plain else text
    except ValueError:
        return text

def nearest(word: str, names: Iterable[str]) -> str:
    """The end of a sentence about a wrong word: the name most like it, if there is one."""
    by_lower = {name.lower(): name for name in names}
    for lower in difflib.get_close_matches(word.lower(), by_lower, n=1):
        name = by_lower[lower]
        return f"; nearest: {name}{'=VALUE' if name in SETTINGS else ''}"
    return "; python airtrack.py -h lists all"

def refusal(word: str) -> str:
    """Why a word of the command line is none."""
    name, equals, _ = word.partition("=")
    if word in COMMANDS:
        return f"{word!r} has to be the first word, as in: python airtrack.py {word} 10"
    if name.startswith("-"):
        return f"there is no option {word!r}" + nearest(name, ("--help", *OPTIONS))
    if equals:
        return f"there is no setting {name!r}" + nearest(name, (*SETTINGS, *OPTIONS))
    return (f"{word!r} is no EXAMPLE ({min(EXAMPLES)} to {max(EXAMPLES)}), not d, not NAME=VALUE"
            + nearest(word, ("d", *COMMANDS, *SETTINGS)))

def taken_apart(words: list[str]) -> tuple[list[int], dict[str, Any], dict[str, str]]:
    """The EXAMPLE numbers, the changed settings and the options among the words."""
    numbers, changes, options, rest = [], {}, {}, iter(words)
    for word in rest:
        name, equals, text = word.partition("=")
        if word in ("d", "--fast"):
            options[word] = ""
        elif name in ("--frames", "--save"):
            options[name] = text if equals else next(rest, "")
        elif equals and name in SETTINGS:
            changes[name] = value_of(name, text)
        elif re.fullmatch("[-+]?[0-9]{1,18}", word):
            numbers.append(int(word))
        else:
            raise ValueError(refusal(word))
    if len(numbers) > 1:
        raise ValueError(f"one EXAMPLE at a time, not both {numbers[0]} and {numbers[1]}")
    return numbers, changes, options

def parse(words: list[str]) -> Callable[[], int]:
    """What a command line asks for, ready to be done. Raises ValueError for what is wrong in it."""
    if not {"-h", "--help"}.isdisjoint(words):
        return manual
    command = words[0] if words and words[0] in COMMANDS else FILM
    numbers, changes, options = taken_apart(words[command != FILM:])
    for option in options:
        if OPTIONS[option] != command:
            raise ValueError(f"{option} is for {OPTIONS[option]}, not for {command}")
    number = numbers[0] if numbers else 0 if command == FILM else 10
    example = EXAMPLES.get(number, OWN_SCENE)
    scene = Scene(**example.settings | changes)
    title = f"Example {number}: {example.title}"
    if example is OWN_SCENE:
        title = (f"There is no example {number} (they are {min(EXAMPLES)} to {max(EXAMPLES)}): "
                 "this is the default scene, with your settings")
    title += "".join(f", {name}={value}" for name, value in changes.items())
    if command == FILM:
        limit = options.get("--frames", "50000")
        if not re.fullmatch("0{0,99}[1-9][0-9]{0,17}", limit):
            raise ValueError(f"--frames N must be a whole number from 1 up, not {limit!r}")
        keys = None if "--fast" in options else Keys()
        introduction = [f"{title}.", f"{in_words(scene)} {method_in_words(scene)}"]
        if changes and example is not OWN_SCENE:
            introduction.append("(The text is about the example as it is, without your changes.)")
        introduction.append(example.look_for)
        if not example.pause_s:  # the one-pager
            introduction = [example.look_for] if keys else []
        details = "d" in options or example.details
        return lambda: film(scene, introduction, example.pause_s, details, int(limit), keys)
    on_track = replace(scene, x_m=scene.to_track(scene.x_m))
    beyond = "" if on_track == scene else "beyond a wall; here, for every method alike, on it; "
    heading = (f"{in_words(scene)} ({beyond}{title}; its own motion, correction and frame rate do "
               f"not matter here.) {SPAN_S} simulated seconds, cut into frames in nine ways: every "
               "figure is of the worst of the nine.")
    if command == "stability":
        return lambda: stability(on_track, heading)
    file = options.get("--save")
    figure = None if file is None else new_figure(file)
    return lambda: chart(on_track, heading, file, figure)

def main(argv: list[str] | None = None) -> int:
    """Carry out a command line, sys.argv's by default. Returns the exit status, 2 for an error."""
    try:
        if sys.stdout is None:
            raise ValueError("there is no standard output to draw on")
        task = parse(sys.argv[1:] if argv is None else argv)
    except ValueError as fault:
        print(f"airtrack.py: error: {fault}", file=sys.stderr)
        return 2
    try:
        status = task()
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        return 130
    except OSError as fault:
        # To print more, if only at exit, would fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(fault, BrokenPipeError):  # the reader has seen enough, as in | head
            return 0
        if fault.errno == errno.EIO:  # the terminal has hung up
            return 129  # as after SIGHUP
        print(f"airtrack.py: error: cannot write: {fault}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
