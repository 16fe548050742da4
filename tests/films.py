"""Runs of the program, for the tests: in this process, or as a user starts it."""

import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from airtrack import main

HERE = Path(__file__).resolve().parent.parent
COMMAND = [sys.executable, str(HERE / "airtrack.py")]


class Film(NamedTuple):
    """What a --fast run printed, taken apart."""

    intro: str
    lines: list[str]
    ending: str


def film(capsys: pytest.CaptureFixture[str], *words: str) -> Film:
    """Run main with --fast and the words."""
    assert main([*words, "--fast"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    *lines, ending = out.splitlines()
    first = next((i + 1 for i in range(len(lines) - 1, -1, -1) if lines[i] == ""), 0)
    return Film("\n".join(lines[:first]), lines[first:], ending)


def program(*words: str, **changes: str | None) -> subprocess.CompletedProcess[str]:
    """Run the program in a process of its own, with changes to the environment (None: unset)."""
    return subprocess.run([*COMMAND, *words], capture_output=True, text=True, timeout=60,
                          env=environment(**changes), stdin=subprocess.DEVNULL, check=False)


def environment(**changes: str | None) -> dict[str, str]:
    """This process's environment without a display, with the changes (None: unset)."""
    wanted = dict(os.environ) | {"DISPLAY": None, "WAYLAND_DISPLAY": None} | changes
    return {name: value for name, value in wanted.items() if value is not None}
