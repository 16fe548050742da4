"""The table of settings: defaults and ranges."""

import math
from dataclasses import FrozenInstanceError, fields
from typing import Any

import pytest

import airtrack
from airtrack import Scene


def test_the_defaults_are_a_scene_of_their_own() -> None:
    values = [getattr(Scene(), f.name) for f in fields(Scene)]
    assert values == [1.1, 0, 0, 0.25, 2.2, 0.8, "backward", "rebound", 30, False, True, 55, 135,
                      False, True, False]


def test_a_scene_cannot_be_changed() -> None:
    with pytest.raises(FrozenInstanceError):
        Scene().x_m = 2.0  # type: ignore[misc]


just_above, just_below = math.nextafter(1000, 2000), -math.nextafter(1000, 2000)


@pytest.mark.parametrize(("name", "good", "bad"), [
    ("x_m", [-1000, 1000, 0], [just_above, just_below, math.nan, math.inf, "1", None, True]),
    ("v_mps", [-1000, 1000], [just_above, just_below, math.nan, -math.inf]),
    ("a_mps2", [-1000, 1000], [just_above, just_below, math.nan]),
    ("left_edge_m", [-1000, 2.19], [just_below, 2.195, 3]),
    ("right_edge_m", [1000, 0.26], [just_above, 0.255, 0]),
    ("CR", [0, 1, 0.5], [-1e-9, 1.0000001, math.nan, False]),
    ("motion", ["forward", "backward", "exact"], ["Exact", "", None]),
    ("correction", ["none", "surface", "rebound"], ["bounce", "rewind", None]),
    ("fps_target", [0.1, 1000], [0.0999, just_above, math.nan]),
    ("use_observed_dt", [True, False], ["True", 2, None]),
    ("auto_off", [True, False], ["no", -1]),
    ("m_to_px", [0.001, 1000], [0, 0.00099, -1, just_above]),
    ("width_px", [10, 1000], [9, 1001, 50.5, 50.0, True]),
    ("show_start_mark", [True, False], ["yes"]),
    ("show_collision_mark", [True, False], [3]),
    ("show_exact_mark", [True, False], [None]),
])
def test_every_range(name: str, good: list[Any], bad: list[Any]) -> None:
    for value in good:
        assert getattr(Scene(**{name: value}), name) == value
    for value in bad:
        with pytest.raises(ValueError, match=name) as error:
            Scene(**{name: value})
        assert str(value) in str(error.value)


def test_the_error_names_field_value_and_range() -> None:
    with pytest.raises(ValueError, match=r"^CR must be from 0 to 1, not 1\.5$"):
        Scene(CR=1.5)
    with pytest.raises(ValueError, match=r"^motion must be forward, backward or exact, not 'up'$"):
        Scene(motion="up")


def test_rewind_and_replay_need_the_exact_motion_and_replay_a_start_on_the_track() -> None:
    Scene(motion="exact", correction="replay", x_m=0.25)
    Scene(motion="exact", correction="rewind", x_m=0.2)
    for correction in ("rewind", "replay"):
        with pytest.raises(ValueError, match=f"^motion must be exact with correction={correction}"):
            Scene(correction=correction)
    with pytest.raises(ValueError, match=r"^x_m must be on the track with correction=replay"):
        Scene(motion="exact", correction="replay", x_m=0.2)


def test_the_table_allows_what_the_tables_of_functions_have() -> None:
    allowed = {f.name: f.metadata["allowed"] for f in fields(Scene)}
    assert allowed["motion"] == tuple(airtrack.MOTIONS)
    assert allowed["correction"] == (*airtrack.CORRECTIONS, "replay")
