"""One line of the film: which mark stands in which column, and how the picture fits."""

import contextlib
import io
import re
from dataclasses import replace

import pytest

import airtrack
from airtrack import Scene, cars_of, main, render_track
from films import details, shown


@pytest.mark.parametrize(("left_m", "car_m", "are_shown", "line"), [  # 10 columns/m
    (0.3, 2.6, True, "   |o +  . a   0    |     *   "),  # the picture begins at 0
    (-0.2, 2.6, True, "|     o +  . a   0    |     * "),  # the picture begins at the left wall
    (0.3, 2.6, False, "   |o +    a        |     *   "),
    (0.3, -0.04, True, "*  |o +  . a   0    |         "),  # the nearest column
    (0.3, 2.94, True, "   |o +  . a   0    |        *"),
    (0.3, -0.06, True, "<  |o +  . a   0    |         "),
    (0.3, 2.96, True, "   |o +  . a   0    |        >"),
    (-0.2, -40, True, "<     o +  . a   0    |       ")])
def test_each_mark_stands_in_its_column_and_an_arrow_where_the_car_is_out_of_the_picture(
        left_m: float, car_m: float, are_shown: bool, line: str) -> None:
    scene = Scene(x_m=0.94, left_edge_m=left_m, right_edge_m=2.0, m_to_px=10, width_px=len(line),
                  show_start_mark=are_shown, show_collision_mark=are_shown)
    places_m = {"a": 1.06, "b": -9.0, "c": 9.0, "o": 0.4, "+": 0.6, "*": car_m}
    assert render_track(scene, places_m, 1.5) == line

def test_where_marks_meet_the_one_that_is_first_in_this_order_is_seen() -> None:
    order = "*+oedcba|.0"
    for number, first in enumerate(order):
        place_m = dict.fromkeys(order, 1.5) | dict.fromkeys(order[number:], 1.0)
        scene = Scene(x_m=place_m["."], left_edge_m=place_m["|"], m_to_px=10, show_start_mark=True,
                      show_methods=True)
        cars = cars_of(scene, replace(scene, motion="exact"))
        places_m = {mark: place_m[mark] for mark in cars}
        assert render_track(scene, places_m, 1.0)[10] == first

def test_the_details_tell_the_place_of_the_car_and_how_far_to_the_right_of_the_o_it_is() -> None:
    assert re.findall(r"err: how far to the\s+(right|left)", str(airtrack.__doc__)) == [
        "right"]  # as -h says
    for line in shown("17 d --frames=60").lines:  # 55 columns/m
        picture, text = line[:135], line[135:]
        x_m, _ = details(text)
        err_m = float(text.partition("err = ")[2])
        car_column = picture.index("*")
        assert car_column == pytest.approx(55 * x_m, abs=0.8)  # half a column, half a cm
        true_column = picture.index("o") if "o" in picture else car_column  # the * covers it
        assert (car_column - true_column) / 55 == pytest.approx(err_m, abs=1 / 55)

def wall_columns(lines: list[str]) -> list[int]:
    """The columns in which any of the lines shows a wall."""
    columns = set()
    for line in lines:
        columns |= {column for column, mark in enumerate(line) if mark == "|"}
    return sorted(columns)

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

def on_a_terminal(words: str, columns: int, monkeypatch: pytest.MonkeyPatch) -> str:
    """What a command line with --fast prints on a terminal of so many columns."""
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setenv("NO_COLOR", "1")
    with contextlib.redirect_stdout(TextOfATerminal()) as out:
        assert main([*words.split(), "--fast"]) == 0
    return out.getvalue()

@pytest.mark.parametrize("columns", [60, 80, 100, 250])
@pytest.mark.parametrize("words", ["1", "1 d", "0", "17 d", "99 right_edge_m=40 x_m=9 d"])
def test_in_a_narrow_terminal_lines_do_not_wrap_and_show_both_walls(
        words: str, columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    _, film, _ = on_a_terminal(f"{words} --frames=60", columns, monkeypatch).split("\n\n", 2)
    lines = film.splitlines()[:-1]
    assert max(len(line) for line in lines) <= columns
    assert len(wall_columns(lines)) == 2

def test_the_film_and_its_table_are_as_long_in_a_narrow_terminal(
        monkeypatch: pytest.MonkeyPatch) -> None:
    # A column is 2 mm. In 60 columns it is drawn wider.
    rows = []
    for columns in (60, 250):
        _, film, table = on_a_terminal("1 m_to_px=500", columns, monkeypatch).split("\n\n", 2)
        rows.append((film.count("\n"), re.findall(r"from frame \d+", table)))
    assert rows[0] == rows[1]
