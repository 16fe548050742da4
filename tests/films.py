"""Runs of the program, for the tests: in this process, or as a user starts it."""

import os
import re
import sys
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import pytest

from airtrack import Scene, main, step, truth_of
from examples import EXAMPLES

HERE = Path(__file__).resolve().parent.parent
COMMAND = [sys.executable, str(HERE / "airtrack.py")]

# Nothing else of the environment in which the tests are started reaches a run: no display, no
# colours turned off, no width. Where there is always a display, dummy keeps the window shut.
KEPT = ("PATH", "HOME", "USERPROFILE", "SYSTEMROOT", "TEMP", "TMP", "LD_LIBRARY_PATH",
        "XDG_RUNTIME_DIR")
CLEAN = {name: os.environ[name] for name in KEPT if name in os.environ} | {
    "TERM": "xterm", "LANG": "C.UTF-8", "SDL_VIDEODRIVER": "dummy"}


class Film(NamedTuple):
    """What a --fast run printed, taken apart."""

    intro: str
    lines: list[str]
    ending: str


def film(capsys: pytest.CaptureFixture[str], *words: str) -> Film:
    """Run main with --fast and the words. An empty line parts the header from the film."""
    assert main([*words, "--fast"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    header, _, rest = out.partition("\n\n")
    *lines, ending = rest.splitlines()
    return Film(" ".join(header.split()), lines, ending)


def details(line: str) -> tuple[float, float]:
    """x and v in the details behind a line."""
    x_text, v_text = re.findall(r"[xv] = +(-?[0-9.]+)", line)
    return float(x_text), float(v_text)


def environment(**changes: str | None) -> dict[str, str]:
    """A clean environment with the changes (None: unset)."""
    wanted: dict[str, str | None] = {**CLEAN, **changes}
    return {name: value for name, value in wanted.items() if value is not None}


def lines_between_bounces(scene: Scene, lines: int) -> list[int]:
    """How many lines of the film, from each collision to the next."""
    x_m, v_mps, found = scene.x_m, scene.v_mps, []
    for line in range(lines):
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / scene.fps_target)
        found += [line] if mark_m is not None else []
    return [b - a for a, b in pairwise(found)]


Beside = list[tuple[float, float, float | None]]  # x, the true x and mark_m, frame by frame


def beside_the_truth(number: int, frames: int, shift: float, **changes: object) -> Beside:
    """An example, with its v (its x where v is 0) shifted by a part of it, and with changes."""
    settings = EXAMPLES[number].settings
    name = "v_mps" if settings.get("v_mps") else "x_m"
    scene = Scene(**settings | changes | {name: settings[name] * (1 + shift)})
    truth, (x_m, v_mps), found = truth_of(scene), (scene.x_m, scene.v_mps), []
    for frame in range(1, frames + 1):
        x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / scene.fps_target)
        true_m = step(truth, truth.x_m, truth.v_mps, frame / scene.fps_target)[0]
        found.append((x_m, true_m, mark_m))
    return found


def apart_m(found: Beside) -> float:
    return max(abs(x_m - true_m) for x_m, true_m, _ in found)
