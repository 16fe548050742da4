"""What chart and stability map print, and the same told plainly."""

import io
import math
from contextlib import redirect_stdout
from dataclasses import replace
from decimal import Decimal
from functools import cache

import pytest

import airtrack
from airtrack import Scene, main
from reference import states

RATES = (10, 30, 60, 120, 240, 480, 960, 1920, 3840)
Samples = list[tuple[float, ...]]  # x, v, the true x and the true v
simulate = airtrack.simulate


def no_measuring(patch: pytest.MonkeyPatch) -> None:
    """Costs that depend on no machine. (That they are measured well, a test of its own tells.)"""
    patch.setattr(airtrack, "cost_us", lambda scene, fps: fps * len(scene.motion) / 10)


@cache
def simulated(scene: Scene, fps: int, cut: int) -> Samples:
    return list(simulate(scene, fps, cut))


@cache
def printed(*words: str) -> str:
    """What the program printed. Each run is simulated once, as the zoom does not change it."""
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as out:
        no_measuring(patch)
        patch.setenv("COLUMNS", "80")
        patch.setattr(airtrack, "simulate", lambda scene, fps, cut: simulated(
            replace(scene, m_to_px=1.0), fps, cut))
        assert main(list(words)) == 0
    assert max(map(len, out.getvalue().splitlines())) <= 80
    return out.getvalue()


@cache
def columns(*words: str) -> list[tuple[list[str], ...]]:
    """The columns of the chart's table, the rates' and each series': the words in each cell."""
    _, lines, *_ = printed("chart", *words).split("\n\n")
    return list(zip(*(
        [line[:4].split(), *(line[at:at + 15].split() for at in range(4, 79, 15))]
        for line in lines.splitlines()), strict=True))


def errors_m(example: str, letter: str) -> list[float]:
    """The errors of a series, one for each rate."""
    return [float(cell[0]) for cell in columns(example)[1 + "abcde".index(letter)][3:-2]]


def shift_of(cut: int, fps: int) -> float:
    """How long after the start a cut begins: none, or (k - 2/3)/9 of a frame."""
    return (3 * cut - 2) / 27 / fps if cut else 0.0


@cache
def truth(CR: float, fps: int, cut: int) -> list[tuple[float, float]]:
    """The true states at the samples of a fall from 2 m at 2 m/s^2, from 60-digit decimals."""
    shift_s, frames = shift_of(cut, fps), max(1, fps // 10)
    times_s = [Decimal(shift_s + frame / fps) for frame in range(frames, 20 * fps + 1, frames)]
    return [(float(x), float(v)) for x, v in states(Scene(x_m=2, a_mps2=-2, CR=CR), times_s)]


def bounced(correction: str, x: float, v: float, wall: float, CR: float) -> tuple[float, float]:
    """That car after a bounce."""
    if correction != "conserve":
        return {"none": x, "surface": wall, "rebound": wall - CR * (x - wall)}[correction], -CR * v
    energy = CR**2 * max(0.0, v**2 / 2 + 2 * (x - wall))  # above the wall
    rise = CR * (wall - x)
    rise = rise if 2 * rise <= energy else 0.0
    speed = math.sqrt(2 * energy - 4 * rise)
    return wall + rise, speed if x < wall else -speed


@cache
def told_plainly(motion: str, correction: str, CR: float, fps: int, cut: int) -> Samples:
    """The samples of that fall by a method, told plainly."""
    behind = {"forward": 0, "backward": 2}.get(motion, 1)  # exact, and a reader's own: the mean
    dt_s, shift_s, frames = 1 / fps, shift_of(cut, fps), max(1, fps // 10)
    x, v = 2 - shift_s**2, -2 * shift_s
    found: Samples = []
    for true_x, true_v in truth(CR, fps, cut):
        for _ in range(frames):
            x += (v - behind * dt_s) * dt_s
            v -= 2 * dt_s
            wall = min(max(x, 0.25), 2.2)
            if x != wall:
                x, v = bounced(correction, x, v, wall, CR)
        found.append((x, v, true_x, true_v))
    return found


def plain_letter(samples: Samples) -> str:
    """What a run of that fall gets on the map, at 55 px/m."""
    if any(x < 0.25 - 1.95 or x > 2.2 + 1.95 for x, *_ in samples):
        return "X"
    last = samples[len(samples) * 3 // 4:]
    if all(x < 0.25 for x, *_ in last) or all(x > 2.2 for x, *_ in last):
        return "S"
    if all(abs(x - true_x) * 55 <= 1 for x, _, true_x, _ in samples):
        return "-"
    mean, true_mean = (sum(car[at + 1]**2 / 2 + 2 * car[at] for car in last) / len(last)
                       for at in (0, 2))
    gain = (mean - true_mean) / (2 * 1.95)
    return "G" if gain > 0.01 else "L" if gain < -0.01 else "P"
