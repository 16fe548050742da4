"""One line of the film: marks, columns, colours and details."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airtrack import METHODS, Scene, details_text, render_track, scenes_beside
from films import film

Capture = pytest.CaptureFixture[str]
ALL_MARKS: dict[str, Any] = {"show_start_mark": True, "show_collision_mark": True}
near = st.sampled_from([0.25, 1.0, 2.2]) | st.floats(-3, 3)  # so that marks meet
metres = near | st.floats(-1e6, 1e6)


@given(x_m=metres, mark_m=metres | st.none(), others_m=st.lists(metres, min_size=6, max_size=6),
       start_m=near, width_px=st.integers(10, 200), m_to_px=st.floats(1, 100))
def test_every_column_shows_the_first_of_the_marks_that_belong_there(
        x_m: float, mark_m: float | None, others_m: list[float], start_m: float,
        width_px: int, m_to_px: float) -> None:
    scene = Scene(x_m=start_m, width_px=width_px, m_to_px=m_to_px, show_methods=True,
                  show_exact_mark=True, **ALL_MARKS)
    others = {mark: (at_m, 0.0) for mark, at_m in zip(scenes_beside(scene), others_m, strict=True)}
    car_px = round(x_m * m_to_px)
    car = ("<", 0) if car_px < 0 else (">", width_px - 1) if car_px >= width_px else ("*", car_px)
    ranked = [*((mark, others[mark][0]) for mark in "oedcba"), ("|", 0.25), ("|", 2.2),
              (".", start_m), ("0", mark_m)]
    columns = [car] + [(mark, round(at_m * m_to_px)) for mark, at_m in ranked if at_m is not None]
    line = render_track(scene, x_m, mark_m, others)
    assert len(line) == width_px
    for column, shown in enumerate(line):
        here = [mark for mark, at_px in columns if at_px == column]
        assert shown == (here[0] if here else " ")


@pytest.mark.parametrize(("setting", "mark"), [
    ("show_start_mark", "."), ("show_collision_mark", "0")])
def test_a_mark_that_is_off_is_not_drawn(setting: str, mark: str) -> None:
    assert mark in render_track(Scene(**ALL_MARKS), 0.5, 1.5, {})
    assert mark not in render_track(Scene(**ALL_MARKS | {setting: False}), 0.5, 1.5, {})


@pytest.mark.parametrize(("words", "start", "seen"), [
    ("21", "", "abc"), ("9 show_exact_mark=True", "", "bco"), ("14", "", "e"),
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
    assert not set(marks) & set("".join(film(capsys, *asked, "show_methods=False").lines))


@pytest.mark.parametrize(("truth", "text"), [
    (None, "x =  -1.25, v = 12.50, FPS =  60"),
    ((-1.0, 3.0), "x =  -1.25, v = 12.50, FPS =  60, err = -2.50e-01")])
def test_the_details(truth: tuple[float, float] | None, text: str) -> None:
    assert details_text(-1.25, 12.5, 59.6, truth) == text


def test_details_and_marks_of_the_lesson_s_films(capsys: Capture) -> None:
    first = film(capsys, "0", "--frames", "1").lines[0]
    assert [i for i, c in enumerate(first[:126]) if c == "|"] == [4, 122]
    assert (first.index("*"), first[126:]) == (79, "x =  11.25, v = 16.97, FPS =  67")
    thirteen, fourteen = film(capsys, "10", "d", "--frames", "14").lines[12:]
    assert (thirteen.index("*"), thirteen[135:]) == (17, "x =   0.31, v = -2.60, FPS =  10")
    assert (fourteen.index("0"), fourteen.index("*")) == (2, 25)
    assert fourteen.endswith("x =   0.45, v =  2.49, FPS =  10")
