"""The table of settings: defaults and ranges, and the help that lists them."""

import math
import re
from dataclasses import fields
from typing import Any

import pytest

from airtrack import MOTIONS, Scene, main
from examples import EXAMPLES

BELOW, ABOVE = math.nextafter(-1000, -2000), math.nextafter(1000, 2000)

# Name, default, what is allowed, some values that are, and some that are not.
TABLE: list[tuple[str, Any, str, list[Any], list[Any]]] = [
    ("x_m", 1.1, "a number from -1000 to 1000 m", [-1000, 1000, 0], [BELOW, ABOVE, "1"]),
    ("v_mps", 0.0, "a number from -1000 to 1000 m/s", [-1000, 1000], [BELOW, ABOVE]),
    ("a_mps2", 0.0, "a number from -1000 to 1000 m/s^2", [-1000, 1000], [BELOW, ABOVE]),
    ("left_edge_m", 0.25, "a number from -1000 to 1000 m", [-1000, 2.19], [BELOW, ABOVE]),
    ("right_edge_m", 2.2, "a number from -1000 to 1000 m", [0.26, 1000], [BELOW, ABOVE]),
    ("CR", 0.8, "a number from 0 to 1", [0, 1, 0.5], [-1e-9, 1.0000001]),
    ("motion", "backward", " or ".join(", ".join(MOTIONS).rsplit(", ", 1)), [*MOTIONS],
     ["Exact", 1]),
    ("correction", "rebound", "none, surface, rebound, conserve, rewind or replay",
     ["none", "surface"], ["bounce", False]),
    ("fps_target", 30.0, "a number from 0.1 to 1000 1/s", [0.1, 1000], [0.0999, ABOVE]),
    ("use_observed_dt", False, "False or True", [False, True], ["True", 2]),
    ("jitter", 0.0, "a number from 0 to 0.9", [0, 0.9], [-0.001, 0.901]),
    ("auto_off", True, "False or True", [False, True], ["no", -1]),
    ("m_to_px", 55.0, "a number from 0.001 to 1000 px/m", [0.001, 1000], [0, 0.00099, ABOVE]),
    ("width_px", 135, "a whole number from 10 to 1000 px", [10, 1000], [9, 1001, 50.5, 50.0]),
    ("show_start_mark", False, "False or True", [False, True], ["yes"]),
    ("show_collision_mark", True, "False or True", [False, True], [3]),
    ("show_exact_mark", False, "False or True", [False, True], ["o"]),
    ("show_methods", False, "False or True", [False, True], ["abcde"]),
]


@pytest.mark.parametrize(("name", "default", "allowed", "good", "bad"), TABLE)
def test_every_range(name: str, default: Any, allowed: str, good: list[Any],
                     bad: list[Any]) -> None:
    assert getattr(Scene(), name) == default
    for value in good:
        assert getattr(Scene(**{name: value}), name) == value
    for value in (*bad, math.nan, math.inf, -math.inf, "", None):
        sentence = re.escape(f"{name} must be {allowed}, not {value!r}")
        with pytest.raises(ValueError, match=f"^{sentence}$"):
            Scene(**{name: value})


def test_walls_are_at_least_a_centimetre_apart_round_off_aside() -> None:
    for left_m, right_m in ((0.05, 0.06), (2.2, 2.21), (-0.01, 0)):
        Scene(left_edge_m=left_m, right_edge_m=right_m)
        with pytest.raises(ValueError, match=r"^right_edge_m must be at least 0\.01 m to the "):
            Scene(left_edge_m=left_m + 1e-6, right_edge_m=right_m)


def test_help_lists_every_example_and_every_setting_with_unit_default_and_range(
        monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    assert main(["-h"]) == 0
    text = capsys.readouterr().out
    for number, example in EXAMPLES.items():
        assert f"\n  {number:2}  {example.title}\n" in text
    usage, _, settings = text.partition("\nSettings")
    assert max(map(len, usage.splitlines())) <= 80
    assert max(map(len, settings.splitlines())) <= 60
    _, *rows = re.sub(r"\n {9,}", " ", settings).splitlines()
    for row, (name, default, allowed, *_), field in zip(rows, TABLE, fields(Scene), strict=True):
        assert row.split()[:2] == [name, str(default)]
        assert row.endswith(f"{field.metadata['meaning']} ({allowed})")
    assert main(["3", "d", "--help", "ten"]) == 0
    assert capsys.readouterr().out == text
