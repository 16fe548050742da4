"""The cars of a film: what its table tells of them, when they are at rest, what is a change."""

import re
from decimal import Decimal
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import airtrack
from airtrack import ALL_CORRECTIONS, EXACT_ONLY, MOTIONS, scene_of
from clock import plain
from examples import EXAMPLES
from films import shown
from reference import states


def rest_frame(row: str) -> int | None:
    """From which frame on a row of the table calls its car at rest."""
    found = re.search(r"from frame (\d+)$", row)
    return int(found[1]) if found else None

# The table.

@pytest.mark.parametrize(("words", "rows", "answer"), [
    # It falls 10 cm at 2 m/s^2. With forward it is 10, 8, 4, -2 cm above its floor, then on it. The
    # true car is 9, 6, 1 and 2 cm above it. Forward gains 0.02 J/kg a frame, a bounce leaves 0.5^2.
    ("99 a_mps2=2 x_m=2.1 motion=forward correction=surface CR=0.5 fps_target=10 --frames=4", {
        "*": "forward + surface 0.03 m 0.2 0.2 not in this film",  # 0.2 0.22 0.24 0.26 0.08
        "o": "exact + replay the truth 0.2 0.17 not in this film"}, "No."),  # 0.2 4 times, 0.05
    # It loses all its speed 5 cm beyond the wall, and stays there. This is not at rest.
    ("99 x_m=0.3 v_mps=-1 CR=0 correction=none fps_target=10 --frames=12", {
        "*": "backward + none 0.05 m 0.5 0.0385 not in this film",  # 0.5/13
        "o": "exact + replay the truth 0.5 0.0385 from frame 1"}, "No."),
    # It starts 5 cm beyond its floor, and sinks by 2 cm. The true car starts on the floor.
    ("99 x_m=0.2 a_mps2=-2 CR=0 correction=none fps_target=10 --frames=1", {
        "*": "backward + none 0.07 m -0.1 -0.12 not in this film",
        "o": "exact + replay the truth 0 0 not in this film"}, "No."),
    # The example's own car, on the changed track: both start at 2.15 m and move 9 cm a frame.
    ("2 x_m=2.15 correction=rebound --frames=1", {
        "*": "backward + rebound 0 m 3.65 3.65 not in this film",
        "+": "backward + none 0.08 m 3.65 3.65 not in this film",
        "o": "exact + replay the truth 3.65 3.65 not in this film"}, "Yes."),
    # It leaves its floor at 1 m/s, and is there again after 1 s: a dt/2 t = 2 mm with backward.
    ("99 x_m=0.25 v_mps=1 a_mps2=-2 motion=exact fps_target=100 show_methods=True --frames=50", {
        "*": "exact + rebound 0 m 0.5 0.5 not in this film",
        "o": "exact + replay the truth 0.5 0.5 not in this film",
        # 0.0002 J/kg less in each of 50 frames
        "a": "backward + rebound 0.005 m 0.5 0.495 not in this film",
        **{letter: f"exact + {name} 0 m 0.5 0.5 not in this film"
           for letter, name in (("b", "rebound"), ("c", "conserve"), ("d", "rewind"))},
        "e": "exact + replay the truth 0.5 0.5 not in this film"}, "Yes.")])
def test_the_table_of_a_small_film_worked_out_by_hand(
        words: str, rows: dict[str, str], answer: str) -> None:
    film = shown(words)
    assert film.rows == rows
    assert film.answer.partition("? ")[2] == answer

def test_all_methods_but_those_that_cannot_begin_at_the_start_beyond_a_wall() -> None:
    rows = shown("99 x_m=3 a_mps2=-2 show_methods=True --frames=1").rows  # 2.75 m above the floor
    starts = {mark: row.replace("the truth", "0 m").split()[5] for mark, row in rows.items()}
    assert starts == dict.fromkeys("*abc", "5.5") | dict.fromkeys("ode", "3.9")

def test_the_answer_is_about_the_whole_film_and_a_car_may_rest_from_its_start_on() -> None:
    film = shown("3 correction=surface --frames=400")  # in the end both cars lie at the floor
    assert film.answer.endswith(" No.")
    for frames, answer in ((1, "Yes."), (2, "No.")):  # 1 cm off, 2 cm; a column is 1.8 cm
        film = shown(f"99 x_m=1 a_mps2=-2 fps_target=10 --frames={frames}")
        assert film.answer.endswith(f" {answer}")
    assert rest_frame(shown("99").rows["*"]) == 0

def test_the_mean_energy_is_that_of_the_last_5_s_or_of_a_shorter_film() -> None:
    # At CR = 0 it falls 1 m in 1 s, so 2 J/kg, and then lies: in the last 5 s of 5.9 for 0.9 of 5.
    film = shown("99 x_m=1.25 a_mps2=-2 CR=0 motion=exact correction=replay fps_target=1000 "
                 "auto_off=False --frames=5900")
    assert "last 5 s" in film.table[1]
    assert "last 0.4 s" in shown("99 fps_target=10 --frames=4").table[1]
    mean = film.rows["*"].split()[6]
    assert float(mean) == pytest.approx(2 * 0.1 / 5, rel=0.02)  # a frame more or less

NUMBERS = st.sampled_from([-1000.0, -1.0, -1e-5, 0.0, 1e-5, 1.0, 1000.0]) | st.floats(-1000, 1000)

@given(x_m=NUMBERS, v_mps=NUMBERS, a_mps2=NUMBERS, CR=st.floats(0, 1),
       right_edge_m=st.sampled_from([-999.0, 2.2, 1000.0]), motion=st.sampled_from([*MOTIONS]),
       correction=st.sampled_from(ALL_CORRECTIONS), fps_target=st.sampled_from([0.1, 7.0, 30.0]),
       jitter=st.floats(0, 0.9), use_observed_dt=st.booleans())
def test_the_table_of_any_scene_fits_in_80_columns_and_has_no_nan(**changes: Any) -> None:
    is_for_all = changes["motion"] == "exact" and changes["x_m"] <= changes["right_edge_m"]
    assume(is_for_all or changes["correction"] not in EXACT_ONLY)
    words = " ".join([f"{name}={value}" for name, value in changes.items()])
    film = shown(f"99 {words} left_edge_m=-1000 show_methods=True --frames=60")
    assert "nan" not in "".join(film.table)
    assert max(len(line) for line in film.table) <= 80
    assert set(film.rows) == set("*oabcde")

# At rest.

@pytest.mark.parametrize(("words", "frames"), [
    ("99 fps_target=10", 9), ("99", 9),  # with the start ten frames, if they last 0.3 s
    ("99 fps_target=50", 15), ("99 fps_target=240", 72),
    ("99 v_mps=2.9 CR=0", 21)])  # 9.7 cm a frame: it stops at the wall in frame 12
def test_a_film_ends_when_the_car_has_been_at_rest_for_0_3_s_and_ten_frames(
        words: str, frames: int) -> None:
    film = shown(words)
    assert len(film.lines) == frames
    assert "at rest" in film.ending

@pytest.mark.parametrize("words", [
    "15 v_mps=39",  # in a frame it goes to both walls and back to where it was
    "99 v_mps=1e-6",  # a slow drift
    "99 v_mps=-1 CR=0 correction=none",  # it stands still, but beyond the wall
    # It rises from 2 mm to 8 mm: it only passes by.
    "99 x_m=0.252 v_mps=0.005 a_mps2=-0.002 motion=exact correction=replay CR=1",
    "99 x_m=0.27 a_mps2=-2 CR=1 motion=exact correction=replay fps_target=60",  # a hop of 2 cm
    # Its hops of 1.15 s rise to 3.3 mm. It is below 3 mm for 0.8 s, so for less than a hop.
    "99 x_m=0.2533 a_mps2=-0.02 CR=1 motion=exact correction=replay fps_target=60",
    "99 x_m=0.35 a_mps2=-2 CR=1 motion=exact correction=replay fps_target=1"])  # one of 10 cm
def test_a_car_that_moves_or_is_beyond_a_wall_is_not_at_rest(words: str) -> None:
    film = shown(f"{words} --frames=300")
    assert len(film.lines) == 300
    assert rest_frame(film.rows["*"]) is None

@pytest.mark.parametrize(("number", "low_m", "frames"), [
    (20, 0.003, 150), (22, 0.001, 300), (1, 0.003, 300)])  # half a column in 22
def test_the_truth_is_at_rest_from_the_frame_on_from_which_it_stays_low(
        number: int, low_m: float, frames: int) -> None:
    scene = scene_of(EXAMPLES[number].settings)
    times_s = [Decimal(frame) / Decimal(scene.fps_target) for frame in range(frames + 1)]
    last_high, = [frame for frame, (place_m, _) in enumerate(states(scene, times_s))
                  if float(place_m) - scene.left_edge_m > low_m][-1:]
    film = shown(f"{number} show_exact_mark=True auto_off=False --frames={frames}")
    assert rest_frame(film.rows["o"]) == last_high + 1

# Another unit.

@given(number=st.sampled_from([*EXAMPLES]), motion=st.sampled_from([*MOTIONS]),
       correction=st.sampled_from(ALL_CORRECTIONS), height=st.floats(0, 1), v_mps=st.floats(-2, 2))
@settings(max_examples=60)
def test_a_scene_in_another_unit_is_the_same_film_with_the_same_end(
        number: int, motion: str, correction: str, height: float, v_mps: float) -> None:
    assume(motion == "exact" or correction not in EXACT_ONLY)
    ours: dict[str, Any] = {name: each.default for name, each in airtrack.SETTINGS.items()}
    ours |= EXAMPLES[number].settings | {
        "motion": motion, "correction": correction, "v_mps": v_mps, "show_exact_mark": True,
        "show_details": False}
    ours["x_m"] = ours["left_edge_m"] + height * (ours["right_edge_m"] - ours["left_edge_m"])
    theirs = ours | {"m_to_px": ours["m_to_px"] / 128}
    for name in ("x_m", "v_mps", "a_mps2", "left_edge_m", "right_edge_m"):
        theirs[name] = 128 * ours[name]  # a power of two, so without round-off
    films = []
    for each in (ours, theirs):
        words = " ".join([f"{name}={value}" for name, value in each.items()])
        film = shown(f"99 {words} --frames=200")
        ends = {mark: rest_frame(row) for mark, row in film.rows.items()}
        films.append((film.lines, film.ending, ends, film.answer.partition("? ")[2]))
    assert films[0] == films[1]

# What is a change.

@pytest.mark.parametrize(("words", "rows", "drawn", "is_changed"), [
    ("10 CR=1", "*o", "*", False), ("10 fps_target=10.0 jitter=0 show_methods=True", "*oabcde",
                                    "*", False),
    ("10 m_to_px=30 width_px=60 show_start_mark=False auto_off=False", "*o", "*", False),
    ("16 x_m=2", "*o", "*o", False), ("10 x_m=1.9", "*o", "*", True),
    ("0 CR=0.7", "*o", "*o", True),
    ("13 motion=backward show_methods=True", "*+oabcde", "*+o", True),
    ("10 fps_target=11", "*o", "*", True), ("9 jitter=0.9", "*o", "*o", True),
    ("9 use_observed_dt=False CR=0.5", "*o", "*o", True),
    ("8 correction=conserve CR=0.5", "*+o", "*+o", True),
    ("8 CR=0.9 show_exact_mark=False", "*o", "*", True), ("99 a_mps2=-2", "*o", "*o", False)])
def test_a_changed_example_draws_the_o_and_with_another_method_the_plus(
        words: str, rows: str, drawn: str, is_changed: bool) -> None:
    film = shown(f"{words} --frames=30")
    assert set(film.rows) == set(rows)
    number = int(words.split()[0])
    for mark in "*+o":
        assert (mark in "".join(film.lines)) is (mark in drawn)  # where the * does not hide it
    assert "show_" not in film.intro  # that is no setting of the motion
    if number in EXAMPLES:
        assert ("changed" in film.intro) is is_changed
        assert (plain(EXAMPLES[number].look_for) in film.intro) is not is_changed

def test_the_plus_is_the_car_of_the_example_s_method_on_the_changed_track() -> None:
    film = shown("9 CR=0.5 x_m=1.5 motion=exact auto_off=False --frames=120")  # irregular frames
    same = shown("9 CR=0.5 x_m=1.5 --frames=120")
    assert film.rows["+"] == same.rows["*"] != film.rows["*"]
    seen = {line[other.index("*")] for line, other in zip(film.lines, same.lines, strict=True)}
    assert seen == {"+", "*"}  # the * may hide it
