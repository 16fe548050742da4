#!/usr/bin/env python3
"""Air track: a car on a 1-D track between two walls, drawn as one line of text a frame.

    python airtrack.py             the one-pager
    python airtrack.py 10 d        example 10, with details
    python airtrack.py chart       speed against accuracy, charted
    python airtrack.py stability   where methods fail, mapped
    python airtrack.py -h          every example, every setting

The car is a point: a position and a velocity, nothing else. Each frame moves it, settles any
collision with a wall and prints the track as a line, so that the scrolling terminal is the film.

Names carry their units, and stand for:
    x_m       position in metres                                     2.0
    v_mps     velocity in metres per second, to the right above 0   -1.5
    a_mps2    acceleration, constant, in metres per second squared  -2.0
    dt_s      the length of a frame in seconds, 1 / FPS              0.1
    CR        coefficient of restitution: speed after / before       0.8
    free_m    where the move alone, as if without walls, ends        0.2
    m_to_px   zoom in characters per metre                          55.0

Read it from top to bottom: nine sections, each building on those above it; the first four are
the physics. The examples, as data, and the keys are in examples.py.
"""

from __future__ import annotations

import argparse
import difflib
import io
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
from itertools import product
from pathlib import Path
from time import perf_counter as clock_s
from time import process_time as processor_s
from typing import Any

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

# A fourth motion is added here, and to SERIES in section 7 if it is to be charted.
MOTIONS = {"forward": forward, "backward": backward, "exact": exact}


# ==== 2. Settling a collision: the move has put the car beyond a wall; where is it really? ======
#
# A correction gets the scene (section 3; here its walls, a and CR), the state at the frame's start,
# the state after the free move, the wall that this is beyond, and dt_s. The first three turn the
# velocity round, keep CR of it, and differ in where they put the car. Replay ignores the free move
# and the wall, goes back to the frame's start and works out what happened from there.

def none(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Leave the car beyond the wall: a trap.

    Slowed by CR < 1, or by a pull into the wall, the car may not get back out within a frame.
    Then the next one finds it in collision again and turns it round, deeper into the wall. From
    there on it goes out less than it goes in: it is stuck, and under a pull it sinks (example 3).
    """
    free_m, free_mps = free
    return free_m, -scene.CR * free_mps

def surface(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Put the car on the wall."""
    return wall_m, -scene.CR * free[1]

def rebound(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Put the car CR * overlap off the wall: as far as it would have bounced back by now.

    Only nearly right: the bounce was somewhere within the frame, but the car is turned with the
    speed of the frame's end. Unless a = 0, its energy is then a little wrong, and it gets out of
    step with the truth (example 8). A CR * overlap longer than the track throws it through the far
    wall (example 14).
    """
    free_m, free_mps = free
    overlap_m = free_m - wall_m
    return free_m - overlap_m * (1 + scene.CR), -scene.CR * free_mps

def arrival(d_m: float, u_mps: float, g_mps2: float, graze_m: float) -> tuple[float, float]:
    """When and how fast does the car reach a wall d_m ahead? (t_s, s_mps); never: (inf, 0).

    u_mps is its speed, g_mps2 its acceleration, both towards the wall. Energy gives the speed s
    at the wall, s^2 = u^2 + 2 g d. From s = u + g t the time is (s - u)/g = 2 d/(u + s). For
    u <= 0 the first form adds, for u > 0 the second: neither then loses digits to a difference.
    """
    s_squared = u_mps * u_mps + 2 * g_mps2 * d_m
    # A car that slows down (g < 0) would turn back s^2/(-2 g) beyond the wall. Where that is
    # no more than round-off (graze_m), it turns back just at the wall: a graze is a miss.
    if (u_mps <= 0 and g_mps2 <= 0) or s_squared < max(0.0, -2 * g_mps2 * graze_m):
        return math.inf, 0.0
    s_mps = math.sqrt(s_squared)
    return (s_mps - u_mps) / g_mps2 if u_mps <= 0 else 2 * d_m / (u_mps + s_mps), s_mps

def hops(v_mps: float, g_mps2: float, CR: float, t_s: float, dt_s: float) -> tuple[float, float]:
    """Take all the whole hops that fit into t_s at once: (time left, speed off the wall then).

    A car thrown off a wall into which it is pushed is back after h = 2 v/g, then after CR h,
    CR^2 h and so on: n hops last h (1 - CR^n)/(1 - CR). Even infinitely many last no longer than
    h/(1 - CR). That is the Zeno point: from then on the car is at rest, speed 0.
    """
    h_s = 2 * v_mps / g_mps2
    if h_s <= t_s * (1 - CR) or dt_s + h_s == dt_s:  # the Zeno point, or a hop lost in rounding
        return 0.0, 0.0
    if CR == 1:
        return math.fmod(t_s, h_s), v_mps
    # h (1 - CR^n)/(1 - CR) = t, solved for n. log1p(x) is log(1 + x) and expm1(x) is e^x - 1,
    # without the rounding of 1 + x, which would spoil them where CR is almost 1.
    n = math.floor(math.log1p(-t_s * (1 - CR) / h_s) / math.log(CR))
    n_hops_s = -h_s * math.expm1(n * math.log(CR)) / (1 - CR)
    return max(0.0, t_s - n_hops_s), v_mps * CR**n

def replay(scene: Scene, start: State, free: State, wall_m: float, dt_s: float) -> State:
    """Replay the frame from its start, from wall to wall, each flight in closed form.

    Goes with the exact motion only. Right for a frame of any length, be it 20 s.
    """
    x_m, v_mps = scene.to_track(start[0]), start[1]
    left_m, right_m, a_mps2, CR = scene.left_edge_m, scene.right_edge_m, scene.a_mps2, scene.CR
    graze_m = 1e-12 * (abs(left_m) + abs(right_m))  # what thousands of frames' rounding adds up to
    t_s = dt_s  # what is left of the frame
    while True:
        # Which wall comes next? Towards the left one, distances and speeds change their sign.
        to_left = arrival(x_m - left_m, -v_mps, -a_mps2, graze_m)
        to_right = arrival(right_m - x_m, v_mps, a_mps2, graze_m)
        arrival_s, s_mps, side, wall_m = min((*to_left, -1, left_m), (*to_right, 1, right_m))
        if arrival_s > t_s:  # No wall any more: coast. Round-off must not end beyond one.
            x_m, v_mps = exact(x_m, v_mps, a_mps2, t_s)
            return scene.to_track(x_m), v_mps
        # Go there and bounce: off it at CR s, pushed back into it by g.
        t_s -= arrival_s
        off_mps, g_mps2 = CR * s_mps, side * a_mps2
        # Too slow to reach the other wall against that push, v^2/(2 g) <= track: hop.
        if g_mps2 > 0 and off_mps * off_mps <= 2 * g_mps2 * (right_m - left_m):
            t_s, off_mps = hops(off_mps, g_mps2, CR, t_s, dt_s)
            if off_mps == 0:
                return wall_m, 0.0
        x_m, v_mps = wall_m, -side * off_mps

CORRECTIONS = {"none": none, "surface": surface, "rebound": rebound, "replay": replay}


# ==== 3. The scene: every setting, its default, its range =======================================

def ranged(default: float, low: float, high: float, unit: str, meaning: str) -> Any:
    """A setting that is a number from low to high, and a whole one if its default is."""
    kinds = (int,) if isinstance(default, int) else (int, float)
    lowest = "above 0," if 0 < low < 1e-300 else f"from {low}"
    allowed = f"{'' if float in kinds else 'whole, '}{lowest} to {high} {unit}".rstrip()
    return field(default=default, metadata={
        "meaning": meaning, "allowed": allowed, "names": (), "read": type(default),
        "is_ok": lambda value: (isinstance(value, kinds) and not isinstance(value, bool)
                                and low <= value <= high)})

def choice(default: object, values: Iterable[Any], meaning: str) -> Any:
    """A setting that is one of a few values."""
    named = {str(value): value for value in values}
    return field(default=default, metadata={
        "meaning": meaning, "allowed": " or ".join(", ".join(named).rsplit(", ", 1)),
        "names": tuple(named) if isinstance(default, str) else (),
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

    x_m: float = ranged(1.1, -1000, 1000, "m", "starting position")
    v_mps: float = ranged(0.0, -1000, 1000, "m/s", "starting velocity")
    a_mps2: float = ranged(0.0, -1000, 1000, "m/s^2", "constant acceleration")
    left_edge_m: float = ranged(0.25, -1000, 1000, "m", "the left wall")
    right_edge_m: float = ranged(2.2, -1000, 1000, "m", "the right wall")
    CR: float = ranged(0.8, 0, 1, "", "speed after a bounce / before it")
    motion: str = choice("backward", MOTIONS, "how the car is moved")
    correction: str = choice("rebound", CORRECTIONS, "how a collision is settled")
    fps_target: float = ranged(30.0, 0.1, 1000, "1/s", "frames a second")
    use_observed_dt: bool = choice(False, (False, True), "dt is the length of the frame before")
    auto_off: bool = choice(True, (False, True), "stop when the car rests against a wall")
    m_to_px: float = ranged(55.0, math.ulp(0), 1000, "px/m", "zoom")
    width_px: int = ranged(135, 10, 1000, "px", "characters in a line")
    show_start_mark: bool = choice(False, (False, True), "a . where the car started")
    show_collision_mark: bool = choice(True, (False, True), "a 0 where a collision was found")
    show_exact_mark: bool = choice(False, (False, True), "an o where it is in truth")

    def __post_init__(self) -> None:
        for f in fields(self):
            value, rule = getattr(self, f.name), f.metadata
            if not rule["is_ok"](value):
                hint = f"; nearest: {nearest(str(value), rule['names'])}" if rule["names"] else ""
                raise ValueError(f"{f.name} must be {rule['allowed']}, not {value!r}{hint}")
        if round(self.right_edge_m - self.left_edge_m, 9) < 0.01:  # 2.21 - 2.2 is a bit less
            raise ValueError("right_edge_m must be at least 0.01 m to the right of left_edge_m, "
                             f"{self.left_edge_m!r}, not {self.right_edge_m!r}")
        if self.correction == "replay" and self.motion != "exact":
            raise ValueError(f"motion must be exact with correction=replay, not {self.motion!r}")
        if self.correction == "replay" and self.x_m != self.to_track(self.x_m):
            raise ValueError(f"x_m must be on the track with correction=replay, from "
                             f"{self.left_edge_m} to {self.right_edge_m} m, not {self.x_m}")

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
    # With one sign of v at both ends, the car stayed between them all the time. If it turned round
    # on its way, it may have been beyond a wall and come back: replay finds out.
    if on_track and (scene.correction != "replay" or v_mps * free_mps > 0):
        return free_m, free_mps, None
    settle = CORRECTIONS[scene.correction]
    settled = settle(scene, (x_m, v_mps), free, scene.to_track(free_m), dt_s)
    return *settled, (None if on_track and settled == free else free_m)


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
    # An f-string would take half as much time again, and this is the longest part of a fast frame.
    text = "x = %6.2f, v = %5.2f, FPS = %3.0f" % (x_m, v_mps, fps)  # noqa: UP031
    return text if exact_m is None else f"{text}, err = {x_m - exact_m:9.2e}"

def fit(scene: Scene, details: bool) -> Scene:
    """The scene with track and zoom shrunk together until line and details fit the terminal."""
    columns = shutil.get_terminal_size().columns if sys.stdout.isatty() else math.inf
    widest = details_text(min(-99, scene.left_edge_m), min(-99, -abs(scene.v_mps)),
                          scene.fps_target, 0 if scene.show_exact_mark else None)
    width_px = int(max(10, min(scene.width_px, columns - len(widest) * details)))
    zoom = scene.m_to_px * width_px / scene.width_px
    return replace(scene, width_px=width_px, m_to_px=max(zoom, math.ulp(0)))


# ==== 6. The run ================================================================================

def say(text: str) -> None:
    """Print a paragraph as wide as the terminal, or as is good to read."""
    print(textwrap.fill(text, min(100, shutil.get_terminal_size().columns)), flush=True)

def introduce(scene: Scene, view: Scene, title: str, example: Example, details: bool,
              keys: Keys | None) -> None:
    """Say what is to be seen and which keys there are, and leave time to read it."""
    if example.look_for:  # the one-pager has no header and no pause
        say(title)
        settings = ", ".join(f"{f.name}={getattr(scene, f.name)}" for f in fields(scene))
        say(f"{settings}; details {'on' if details else 'off'}")
        print()
        say(example.look_for)
    if view.width_px < scene.width_px:
        say(f"To fit this terminal, the track is drawn {view.width_px} px wide at "
            f"{view.m_to_px:.3g} px/m. The physics is untouched.")
    if keys:
        keys.window.open()
        if keys.window.why_shut:
            say(f"No window for the keys: {keys.window.why_shut}.")
    if example.look_for and keys:
        try:
            say(f"{keys.help()} The film begins in {example.pause_s:g} s, with Ctrl-C at once.")
            keys.wait_until(clock_s() + example.pause_s)
        except KeyboardInterrupt:  # read enough
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
        length_s, self.began_s = now_s - self.began_s - paused_s, now_s
        if now_s > self.deadline_s + self.period_s:  # missed or paused: not made up by a burst
            self.deadline_s = now_s
        return length_s

def by_method(scene: Scene, motion: str = "exact", correction: str = "replay") -> Scene:
    """The scene by another method, by default exactly. (Replay has to start on the track.)"""
    x_m = scene.to_track(scene.x_m) if correction == "replay" else scene.x_m
    return replace(scene, x_m=x_m, motion=motion, correction=correction)

def run(scene: Scene, title: str, example: Example, details: bool, keys: Keys | None,
        frames: int) -> int:
    """Show the film and say why it ended. Without keys it runs as fast as it can.

    Returns the exit status: 0, or 128 + the number of the signal that ended it.
    """
    view, dt_s, fps, stalled = fit(scene, details), 1 / scene.fps_target, scene.fps_target, False
    exactly = by_method(scene)
    exact_m, exact_mps = exactly.x_m if scene.show_exact_mark else None, scene.v_mps
    x_m, v_mps, frame, recent_m = scene.x_m, scene.v_mps, 0, deque[float](maxlen=10)
    why, status = "that is the frame limit", 0
    try:
        with keys or nullcontext():
            introduce(scene, view, title, example, details, keys)
            pacer = Pacer(dt_s)
            while frame < frames:
                # 1. Wait for the frame's moment, and answer keys meanwhile.
                if keys:
                    length_s = pacer.next_frame(keys)
                    if keys.quit_reason:
                        why = keys.quit_reason
                        break
                    fps = 1 / length_s
                    if scene.use_observed_dt:
                        dt_s = length_s
                    stalled = length_s > max(0.15, 1.5 / scene.fps_target)
                # 2. Move the car and settle any collision. After a stall it holds still.
                mark_m = None
                if not stalled:
                    x_m, v_mps, mark_m = step(scene, x_m, v_mps, dt_s)
                    if exact_m is not None:
                        exact_m, exact_mps, _ = step(exactly, exact_m, exact_mps, dt_s)
                # 3. Draw.
                line = render_track(view, x_m, mark_m, exact_m)
                if details:
                    line += details_text(x_m, v_mps, fps, exact_m)
                sys.stdout.write(line + "\n")
                if keys:
                    sys.stdout.flush()
                frame += 1
                # 4. At rest? Taken to be so when the last ten positions average to a wall's.
                recent_m.append(x_m)
                if scene.auto_off and frame >= 10:
                    mean_m = sum(recent_m) / 10
                    if (abs(mean_m - scene.left_edge_m) <= 0.001
                            or abs(mean_m - scene.right_edge_m) <= 0.001):
                        why = "the car is at rest against a wall"
                        break
    except KeyboardInterrupt:
        why = "Ctrl-C was pressed"
    except Terminated as stop:  # a signal, such as SIGTERM
        why, status = signal.Signals(stop.args[0]).name, 128 + stop.args[0]
    print(f"Stopped after {frame} frame{'s' * (frame != 1)}: {why}.", flush=True)
    return status


# ==== 7. Speed against accuracy: the chart ======================================================

SPAN_S = 20  # what chart and map simulate
CHART_FPS = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)
SERIES = {"f": ("forward", "rebound"), "s": ("backward", "surface"),
          "b": ("backward", "rebound"), "e": ("exact", "replay")}
Points = dict[str, list[tuple[int, float, float]]]  # letter: (fps, error_m, cost_s) at each rate

def truth_m(scene: Scene, rate: int) -> list[float]:
    """Where the car truly is, rate times a second: each by one exact step from the start."""
    exactly = by_method(scene)
    return [step(exactly, exactly.x_m, exactly.v_mps, k / rate)[0]
            for k in range(1, SPAN_S * rate + 1)]

def measure(scene: Scene, fps: int, samples_m: list[float]) -> tuple[int, float, float]:
    """(fps, error_m, cost_s): the largest |x - truth| over the samples, one every 0.1 s, and the
    processor time of the steps alone for a simulated second, the best of several repeats."""
    dt_s, costs_s = 1 / fps, []
    for _ in range(max(3, 500 // fps)):
        x_m, v_mps, xs_m, began_s = scene.x_m, scene.v_mps, [], processor_s()
        for _ in samples_m:
            for _ in range(fps // 10):
                x_m, v_mps, _ = step(scene, x_m, v_mps, dt_s)
            xs_m.append(x_m)
        costs_s.append((processor_s() - began_s) / SPAN_S)
    error_m = max(abs(x_m - sample_m) for x_m, sample_m in zip(xs_m, samples_m, strict=True))
    return fps, error_m, max(min(costs_s), 1e-9)  # 0 where the clock is coarse

def picture(points: Points) -> str:
    """The points as letters on log-log axes, error over cost; + where series meet."""
    logs = [(math.log10(cost_s), math.log10(max(error_m, 1e-16)), letter)
            for letter, series in points.items() for _, error_m, cost_s in series]
    xs, ys, _ = zip(*logs, strict=True)
    left, right = math.floor(min(xs)), math.floor(max(xs)) + 1
    bottom, top = math.floor(min(ys)), math.floor(max(ys)) + 1
    wide, high = 66 // (right - left), max(1, 18 // (top - bottom))  # of a power of ten
    grid = [[" "] * (wide * (right - left) + 1) for _ in range(high * (top - bottom) + 1)]
    for x, y, letter in logs:
        row, column = round((top - y) * high), round((x - left) * wide)
        grid[row][column] = letter if grid[row][column] in (" ", letter) else "+"
    lines = ["error (m)"]
    for row, cells in enumerate(grid):
        label = f"1e{top - row // high:+03d}" if row % high == 0 else ""
        lines.append(f"{label:>8} |{''.join(cells)}".rstrip())
    ticks = "".join(f"{f'1e{x:+03d}':{wide}}" for x in range(left, right + 1))
    return "\n".join([*lines, " " * 9 + "+" + "-" * (wide * (right - left) + 1),
                      " " * 8 + ticks.rstrip(),
                      f"{'processor time (s) for a simulated second':>76}"])

def conclusion(points: Points, pixel_m: float) -> str:
    """What each method needs to stay within one drawn pixel, and what that costs beside exact."""
    needs, cost_of_exact_s = [], points["e"][0][2]
    for letter, series in points.items():
        enough = f"more than {CHART_FPS[-1]} FPS"
        for fps, error_m, cost_s in reversed(series):  # down to the last rate that will do
            if error_m > pixel_m:
                break
            enough = f"{fps} FPS"
            if letter != "e":
                ratio = float(f"{cost_s / cost_of_exact_s:.2g}")
                enough += f" at {ratio:g} times that time"
        needs.append(f"{' + '.join(SERIES[letter])} needs {enough}")
    return (f"Exact + replay at {CHART_FPS[0]} FPS takes {1e6 * cost_of_exact_s:.2g} us of "
            f"processor time for a simulated second. To stay within one drawn pixel of the truth "
            f"({1000 * pixel_m:.3g} mm), {', '.join(needs[:-1])}, and {needs[-1]}.")

def progress(text: str) -> None:
    """On a terminal, show a line that the next one replaces."""
    if sys.stdout.isatty():
        print(f"\r{text:50}\r", end="", flush=True)

def new_figure(file: str) -> Any:
    """An empty picture, by matplotlib. Raises ValueError if it could not be saved as that file."""
    try:
        from matplotlib.figure import Figure
        figure = Figure(figsize=(8, 5), layout="constrained")
        figure.savefig(io.BytesIO(), format=Path(file).suffix[1:])
    except ImportError:
        raise ValueError("--save needs matplotlib: python -m pip install '.[chart]'") from None
    except ValueError as fault:
        raise ValueError(f"--save {file!r}: {fault}") from None
    if not Path(file).parent.is_dir():
        raise ValueError(f"--save {file!r}: there is no such folder")
    return figure

def chart(scene: Scene, title: str, file: str | None, figure: Any) -> None:
    """Measure each method at each rate; show a picture, a table and what follows from them.

    With a figure, of matplotlib, the picture is drawn there too, and saved as the file.
    """
    samples_m = truth_m(scene, 10)
    points: Points = {letter: [] for letter in SERIES}
    for letter, method in SERIES.items():
        for fps in CHART_FPS:
            progress(f"measuring {' + '.join(method)} at {fps} FPS")
            points[letter].append(measure(by_method(scene, *method), fps, samples_m))
    progress("")
    say(title)
    print(f"Speed against accuracy, {SPAN_S} simulated seconds\n\n{picture(points)}\n")
    names = [f"{letter} {'+'.join(method)}" for letter, method in SERIES.items()]
    print("    " + "".join(f"{name:>19}" for name in names))
    print(" FPS" + f"{'error m':>10}{'cost s':>9}" * len(SERIES))
    for row in zip(*points.values(), strict=True):
        cells = (f"{error_m:10.1e}{cost_s:9.1e}" for _, error_m, cost_s in row)
        print(f"{row[0][0]:4}{''.join(cells)}")
    print()
    say(conclusion(points, 1 / scene.m_to_px))
    if figure:
        axes = figure.add_subplot()
        for name, series in zip(names, points.values(), strict=True):
            _, errors_m, costs_s = zip(*series, strict=True)
            axes.loglog(costs_s, [max(error_m, 1e-16) for error_m in errors_m], "o-", label=name)
        axes.set(title=title, xlabel="processor time (s) for a simulated second",
                 ylabel=f"largest error in {SPAN_S} s (m)")
        axes.legend()
        figure.savefig(file)
        print(f"\nSaved as {file}.")


# ==== 8. Where methods fail: the stability map ==================================================

MAP_FPS = (1, 2, 5, 10, 30, 60, 120, 240, 1000)
VERDICTS = {"X": "thrown further than a track's length beyond a wall",
            "S": "stuck: beyond the same wall all through the last 5 s",
            "G": "gained more than 1 % of its energy",
            "o": "more than a drawn pixel from the truth at some sample",
            ".": "within a pixel all along"}

def verdict(scene: Scene, fps: int, samples_m: list[float]) -> str:
    """The first of the VERDICTS that 20 s of the scene deserve."""
    low_m = scene.right_edge_m if scene.a_mps2 > 0 else scene.left_edge_m  # it is pulled there

    def energy(x_m: float, v_mps: float) -> float:
        return v_mps * v_mps / 2 - scene.a_mps2 * (x_m - low_m)

    x_m, v_mps, found, beyond_m = scene.x_m, scene.v_mps, {"."}, deque[float](maxlen=5 * fps)
    most = energy(x_m, v_mps) + 0.01 * abs(energy(x_m, v_mps)) + 1e-9
    frames_a_sample = SPAN_S * fps // len(samples_m)
    for frame in range(1, SPAN_S * fps + 1):
        x_m, v_mps, _ = step(scene, x_m, v_mps, 1 / fps)
        beyond_m.append(x_m - scene.to_track(x_m))
        if abs(beyond_m[-1]) > scene.right_edge_m - scene.left_edge_m:
            return "X"
        if energy(x_m, v_mps) > most:
            found.add("G")
        if frame % frames_a_sample == 0:
            error_m = abs(x_m - samples_m[frame // frames_a_sample - 1])
            if error_m > 1 / scene.m_to_px:
                found.add("o")
    if min(beyond_m) > 0 or max(beyond_m) < 0:
        found.add("S")
    return next(letter for letter in VERDICTS if letter in found)

def stability(scene: Scene, title: str) -> None:
    """Print the map: a row a method, a column a frame rate, a letter for what happened there."""
    say(title)
    print(f"Stability, {SPAN_S} simulated seconds\n")
    print(f"{'FPS':20}" + "".join(f"{fps:6}" for fps in MAP_FPS))
    samples_m = {rate: truth_m(scene, rate) for rate in {min(fps, 10) for fps in MAP_FPS}}
    for motion, correction in product(MOTIONS, CORRECTIONS):
        if correction != "replay" or motion == "exact":
            method = by_method(scene, motion, correction)
            row = (verdict(method, fps, samples_m[min(fps, 10)]) for fps in MAP_FPS)
            print(f"{f'{motion} + {correction}':20}{''.join(f'{letter:>6}' for letter in row)}")
    print("\n" + "\n".join(f"{letter}  {meaning}" for letter, meaning in VERDICTS.items()))


# ==== 9. The command line =======================================================================

USAGE = """python airtrack.py [EXAMPLE] [d] [NAME=VALUE ...] [--fast] [--frames N]
       python airtrack.py chart [EXAMPLE] [NAME=VALUE ...] [--save FILE]
       python airtrack.py stability [EXAMPLE] [NAME=VALUE ...]"""
SETTINGS = {f.name: f for f in fields(Scene)}
OPTIONS = ("--fast", "--frames", "--save", "--help")

def help_text() -> str:
    """The examples and the settings, for -h."""
    lines = ["examples:", *(f"  {n:2}  {example.title}" for n, example in EXAMPLES.items()), "",
             "settings (default, meaning, range), on top of the example's own:"]
    for name, f in SETTINGS.items():
        lines += textwrap.wrap(
            f"  {name:20}{f.default!s:9} {f.metadata['meaning']}: {f.metadata['allowed']}",
            shutil.get_terminal_size().columns, subsequent_indent=" " * 32)
    return "\n".join(lines)

def parse(argv: list[str] | None) -> argparse.Namespace:
    """Take the command line apart. Raises ValueError or ArgumentError for what is wrong in it."""
    parser = argparse.ArgumentParser(usage=USAGE, epilog=help_text(), allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter,
                                     exit_on_error=False)
    parser.add_argument("words", nargs="*", metavar="EXAMPLE",
                        help="a number; default 0, for chart and stability 10")
    parser.add_argument("--fast", action="store_true", help="no pacing, no pauses, no window")
    parser.add_argument("--frames", metavar="N", help="stop after N frames (default 50000)")
    parser.add_argument("--save", metavar="FILE", help="draw the chart into a .png, .svg, ... too")
    options, unknown = parser.parse_known_intermixed_args(argv)
    if unknown:
        hint = nearest(unknown[0], (*OPTIONS, "d"))
        raise ValueError(f"there is no option {unknown[0]!r}; nearest: {hint}")
    command, words = "run", options.words
    if words and words[0] in ("chart", "stability"):
        command, *words = words
    number, details, settings = None, False, {}
    for word in words:
        name, equals, text = word.partition("=")
        if equals and name not in SETTINGS:
            hint = nearest(name, (*SETTINGS, *OPTIONS))
            raise ValueError(f"there is no setting {name!r}; nearest: {hint}")
        if equals and name in settings:
            raise ValueError(f"{name} is set twice")
        if equals:
            try:
                settings[name] = SETTINGS[name].metadata["read"](text)
            except ValueError:
                settings[name] = text  # Scene will say what it should have been
        elif word == "d":
            details = True
        elif re.fullmatch("[-+]?[0-9]{1,18}", word):
            if number is not None:
                raise ValueError(f"one EXAMPLE at a time, not both {number} and {word}")
            number = int(word)
        else:
            names = ["d", *map(str, EXAMPLES), "chart", "stability"]
            names += [f"{setting}=VALUE" for setting in SETTINGS]
            raise ValueError(f"{word!r} is no EXAMPLE ({min(EXAMPLES)} to {max(EXAMPLES)}), "
                             f"not d, not NAME=VALUE; nearest: {nearest(word, names)}")
    if options.frames is not None and not re.fullmatch("0*[1-9][0-9]{0,17}", options.frames):
        raise ValueError(f"--frames N must be a whole number from 1 up, not {options.frames!r}")
    if command != "run" and (details or options.fast or options.frames):
        raise ValueError(f"d, --fast and --frames do not go with {command}")
    if command != "chart" and options.save is not None:
        raise ValueError("--save FILE goes with chart only")
    if number is None:
        number = 0 if command == "run" else 10
    example = EXAMPLES.get(number, OWN_SCENE)
    title = example.title if example is OWN_SCENE else f"Example {number}: {example.title}"
    title += "".join(f", {name}={value}" for name, value in settings.items())
    if settings and example.look_for and example is not OWN_SCENE:
        example = example._replace(look_for=f"{example.look_for} (So it is without your changes.)")
    vars(options).update(command=command, number=number, example=example, title=title,
                         details=details or example.details,
                         scene=Scene(**example.settings | settings))
    return options

def fail(message: object) -> int:
    """Tell in one line what is wrong, and return the exit status 2."""
    print(f"airtrack.py: error: {message}", file=sys.stderr)
    return 2

def carry_out(argv: list[str] | None) -> int:
    """Do what a command line asks for; the exit status."""
    try:
        options = parse(argv)
        figure = None if options.save is None else new_figure(options.save)
    except SystemExit as done:  # argparse, after -h
        return int(done.code or 0)
    except (ValueError, argparse.ArgumentError) as fault:
        return fail(fault)
    if options.example is OWN_SCENE:
        say(f"There is no example {options.number} (they are {min(EXAMPLES)} to {max(EXAMPLES)}): "
            "this is the default scene, with your settings.")
    if options.command == "run":
        return run(options.scene, options.title, options.example, options.details,
                   None if options.fast else Keys(), int(options.frames or 50_000))
    if options.command == "chart":
        chart(options.scene, options.title, options.save, figure)
    else:
        stability(options.scene, options.title)
    return 0

def main(argv: list[str] | None = None) -> int:
    """Carry out a command line, sys.argv's by default. Returns the exit status, 2 for an error."""
    if sys.stdout is None:
        return fail("there is no standard output to draw on")
    try:
        status = carry_out(argv)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        return 130
    except OSError as fault:
        # To print more, if only at exit, would fail again. If the reader has gone (| head), fine.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0 if isinstance(fault, BrokenPipeError) else fail(f"cannot write: {fault}")


if __name__ == "__main__":
    sys.exit(main())
