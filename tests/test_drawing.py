"""One line of the film."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airtrack import Scene, render_track

ALL_MARKS: dict[str, Any] = {
    "show_start_mark": True, "show_collision_mark": True, "show_exact_mark": True}
near = st.sampled_from([0.25, 1.0, 2.2]) | st.floats(-3, 3)  # so that marks meet
metres = near | st.floats(-1e6, 1e6)


@given(x_m=metres, mark_m=metres | st.none(), exact_m=metres | st.none(),
       start_m=near, width_px=st.integers(10, 200), m_to_px=st.floats(1, 100))
def test_every_column_shows_the_first_of_the_marks_that_belong_there(
        x_m: float, mark_m: float | None, exact_m: float | None, start_m: float,
        width_px: int, m_to_px: float) -> None:
    scene = Scene(x_m=start_m, width_px=width_px, m_to_px=m_to_px, **ALL_MARKS)
    car_px = round(x_m * m_to_px)
    car = ("<", 0) if car_px < 0 else (">", width_px - 1) if car_px >= width_px else ("*", car_px)
    ranked = [("|", 0.25), ("|", 2.2), ("o", exact_m), (".", start_m), ("0", mark_m)]
    columns = [car] + [(mark, round(at_m * m_to_px)) for mark, at_m in ranked if at_m is not None]
    line = render_track(scene, x_m, mark_m, exact_m)
    assert len(line) == width_px
    for column, shown in enumerate(line):
        here = [mark for mark, at_px in columns if at_px == column]
        assert shown == (here[0] if here else " ")


@pytest.mark.parametrize(("setting", "mark"), [
    ("show_start_mark", "."), ("show_collision_mark", "0"), ("show_exact_mark", "o")])
def test_a_mark_that_is_off_is_not_drawn(setting: str, mark: str) -> None:
    assert mark in render_track(Scene(**ALL_MARKS), 0.5, 1.5, 2.0)
    assert mark not in render_track(Scene(**ALL_MARKS | {setting: False}), 0.5, 1.5, 2.0)


@pytest.mark.parametrize(("x_m", "mark", "column"), [
    (4.5, "*", 4), (5.5, "*", 6), (-0.4, "*", 0), (-0.9, "<", 0), (9.4, "*", 9), (9.6, ">", 9)])
def test_columns_are_rounded_half_ones_to_the_even_one(x_m: float, mark: str, column: int) -> None:
    assert render_track(Scene(m_to_px=1, width_px=10), x_m)[column] == mark
