"""One line of the film: which mark stands in which column, and how the picture fits."""

import contextlib
import io
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airtrack import Scene, cars_of, main, render_track
from films import details, shown


@pytest.mark.parametrize(("left_m", "line"), [
    (0.3, "   |o +  . a   0    |     *   "),  # the picture begins at 0
    (-0.2, "|     o +  . a   0    |     * ")])  # the picture begins at the left wall
def test_each_mark_stands_in_its_column(left_m: float, line: str) -> None:
    scene = Scene(x_m=0.9, left_edge_m=left_m, right_edge_m=2.0, m_to_px=10, width_px=len(line),
                  show_start_mark=True)
    places_m = {"a": 1.1, "o": 0.4, "+": 0.6, "*": 2.6}
    assert render_track(scene, places_m, 1.5) == line


@given(x_m=st.floats(-3, 3) | st.floats(-1e6, 1e6), left_m=st.floats(-3, 3),
       m_to_px=st.floats(0.1, 60), width_px=st.integers(10, 200))
def test_the_car_is_in_the_nearest_column_or_an_arrow_at_the_edge_beyond_which_it_is(
        x_m: float, left_m: float, m_to_px: float, width_px: int) -> None:
    scene = Scene(left_edge_m=left_m, right_edge_m=1000, m_to_px=m_to_px, width_px=width_px)
    line = render_track(scene, {"*": x_m}, None)
    assert len(line) == width_px
    columns = (x_m - min(0, left_m)) * m_to_px
    car, = set(line) & set("*<>")
    if car == "<":
        assert line[0] == "<"
        assert columns < 0
    elif car == ">":
        assert line[-1] == ">"
        assert columns > width_px - 1
    else:
        assert line.index("*") == pytest.approx(columns, abs=0.5 + 1e-9)


def test_where_marks_meet_the_one_that_is_first_in_this_order_is_seen() -> None:
    order = "*+oedcba|.0"
    for number, first in enumerate(order):
        there = order[number:]
        scene = Scene(x_m=1.0 if "." in there else 1.5, left_edge_m=1.0 if "|" in there else 0.5,
                      m_to_px=10, show_start_mark=True, show_exact_mark=True, show_methods=True)
        cars = cars_of(scene, replace(scene, CR=0.5))
        places_m = {mark: 1.0 if mark in there else 1.5 for mark in cars}
        assert render_track(scene, places_m, 1.0)[10] == first


@pytest.mark.parametrize(("setting", "mark"), [
    ("show_start_mark", "."), ("show_collision_mark", "0"), ("show_exact_mark", "o"),
    ("show_methods", "c")])
def test_a_mark_is_drawn_if_its_setting_is_True(setting: str, mark: str) -> None:
    for is_on in (True, False):
        lines = shown(f"9 CR=0.9 {setting}={is_on} --frames=30").lines
        assert (mark in "".join(lines)) is is_on


def test_the_details_are_those_of_the_picture_and_of_the_motion() -> None:
    lines = shown("17 d --frames=60").lines
    x_before_m, v_before_mps = 2.0, 0.0  # example 17: exact motion at 10 FPS, 55 columns/m
    for line in lines:
        x_m, v_mps = details(line)
        err_m = float(line.partition("err = ")[2])
        assert line.index("*") == pytest.approx(55 * x_m, abs=0.8)  # half a column, half a cm
        true_column = line.find("o", 0, 135)
        if true_column == -1:
            true_column = line.index("*")  # the * covers it
        assert (line.index("*") - true_column) / 55 == pytest.approx(err_m, abs=1 / 55)
        if "0" not in line[:135]:
            moved_m = (v_before_mps + v_mps) / 2 * 0.1
            assert x_m - x_before_m == pytest.approx(moved_m, abs=0.011)
        x_before_m, v_before_mps = x_m, v_mps


def wall_columns(lines: list[str]) -> list[int]:
    """The columns in which any of the lines shows a wall."""
    pairs = [(column, mark) for line in lines for column, mark in enumerate(line)]
    return sorted({column for column, mark in pairs if mark == "|"})


@pytest.mark.parametrize(("words", "columns"), [
    ("1", [14, 121]), ("1 left_edge_m=0.3", [16, 121]),  # 55 columns/m show them
    ("99 right_edge_m=50", [1, 134]), ("99 left_edge_m=-40 right_edge_m=-1 x_m=-2", [0, 134]),
    ("99 width_px=20", [2, 19]), ("99 m_to_px=100", [25])])
def test_the_zoom_shows_the_right_wall_unless_the_user_chose_it(
        words: str, columns: list[int]) -> None:
    assert wall_columns(shown(f"{words} --frames=30").lines) == columns


class TextOfATerminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("columns", [60, 80, 100, 250])
@pytest.mark.parametrize("words", ["1", "1 d", "0", "17 d", "99 right_edge_m=40 x_m=9 d"])
def test_in_a_narrow_terminal_lines_do_not_wrap_and_show_both_walls(
        words: str, columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    with contextlib.redirect_stdout(TextOfATerminal()) as out:
        main([*words.split(), "--fast", "--frames=60"])
    _, film, _ = out.getvalue().split("\n\n")
    lines = film.splitlines()[:-1]
    assert max(len(line) for line in lines) <= columns
    assert len(wall_columns(lines)) == 2
