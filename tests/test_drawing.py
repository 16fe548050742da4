"""One line of the film: marks, columns and details."""

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airtrack import METHODS, Scene, cars_of, details_text, render_track
from films import film

Capture = pytest.CaptureFixture[str]
ALL_MARKS: dict[str, Any] = {"show_start_mark": True, "show_collision_mark": True,
                             "show_exact_mark": True, "show_methods": True}
near = st.sampled_from([0.25, 1.0, 2.2]) | st.floats(-3, 3)  # so that marks meet
metres = near | st.floats(-1e6, 1e6)


@given(places=st.lists(metres, min_size=8, max_size=8), hit_m=metres | st.none(), start_m=near,
       left_m=st.sampled_from([0.25, -0.5]) | st.floats(-3, 3), track_m=st.floats(0.01, 5),
       width_px=st.integers(10, 200), m_to_px=st.floats(1, 20))
@settings(max_examples=300)
def test_every_column_shows_the_first_of_the_marks_that_belong_there(
        places: list[float], hit_m: float | None, start_m: float, left_m: float, track_m: float,
        width_px: int, m_to_px: float) -> None:
    scene = Scene(x_m=start_m, left_edge_m=left_m, right_edge_m=left_m + track_m,
                  width_px=width_px, m_to_px=m_to_px, **ALL_MARKS)
    cars = cars_of(scene, replace(scene, CR=0.5))  # a changed example: the film has all of them
    places_m = dict(zip(cars, places, strict=True))
    first_m = min(0, left_m)
    ranked = [(mark, places_m[mark]) for mark in "*+oedcba"]
    ranked += [("|", left_m), ("|", left_m + track_m), (".", start_m)]
    if hit_m is not None:
        ranked.append(("0", hit_m))
    columns = [(mark, round((x_m - first_m) * m_to_px)) for mark, x_m in ranked]
    _, car_px = columns[0]
    if car_px < 0:
        columns[0] = "<", 0
    elif car_px >= width_px:
        columns[0] = ">", width_px - 1
    line = render_track(scene, places_m, hit_m)
    assert len(line) == width_px
    for column, shown in enumerate(line):
        here = [mark for mark, at_px in columns if at_px == column]
        assert shown == (here[0] if here else " ")


@pytest.mark.parametrize(("setting", "mark"), [
    ("show_start_mark", "."), ("show_collision_mark", "0"), ("show_exact_mark", "o"),
    ("show_methods", "a"), ("show_methods", "e")])
def test_a_mark_that_is_off_is_not_drawn(setting: str, mark: str) -> None:
    for shown in (True, False):
        scene = Scene(**ALL_MARKS | {setting: shown})
        places_m = {each: 0.4 + number / 10 for number, each in enumerate(cars_of(scene, None))}
        assert (mark in render_track(scene, places_m, 1.8)) is shown


@pytest.mark.parametrize(("words", "start", "seen"), [
    ("9 show_exact_mark=True", "", "bco"), ("14", "", "e"),
    ("4 m_to_px=100", "x_m=0.25", "abe")])  # 4: from beyond a wall the letters start on it
def test_each_letter_stands_where_the_film_of_its_method_has_the_car(
        words: str, start: str, seen: str, capsys: Capture) -> None:
    asked = [*words.split(), "--frames", "200", "auto_off=False"]
    shown = film(capsys, *asked, "show_methods=True").lines
    marks = "".join(METHODS)
    for letter, (motion, correction) in METHODS.items():
        alone = film(capsys, *asked, f"motion={motion}", f"correction={correction}", *start.split())
        for line, its in zip(shown, alone.lines, strict=True):
            column = its.find("*")  # -1: out of the picture
            hides = "*<>o" + marks[marks.index(letter) + 1:]
            assert line.find(letter) == column or (
                letter not in line and (column == -1 or line[column] in hides))
    assert set(seen) <= set("".join(shown)) - set(" |*<>.0")


@pytest.mark.parametrize(("true_m", "text"), [
    (None, "x =  -1.25, v = 12.50, FPS =  60"),
    (-1.0, "x =  -1.25, v = 12.50, FPS =  60, err = -2.50e-01")])
def test_the_details(true_m: float | None, text: str) -> None:
    assert details_text(-1.25, 12.5, 59.6, true_m) == text
