"""The cars of a film: which are drawn, and what the table tells of them."""

import math
import re
from decimal import Decimal
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import airtrack
from airtrack import ALL_CORRECTIONS, EXACT_ONLY, MOTIONS, Scene, main
from clock import Play, plain
from examples import EXAMPLES
from films import shown
from reference import states


def told(table: list[str]) -> dict[str, list[str]]:
    """What the table has for each car: its row, and its hops and its end."""
    lines: dict[str, list[str]] = {}
    for line in table:
        if line.startswith("Is the * right?"):
            break
        if re.match(r"[*+oa-e] ", line):
            lines.setdefault(line[0], []).append(plain(line[1:]))
    return lines

def rest_text(table: list[str], mark: str) -> str | None:
    """From when on the table calls a car at rest, in s."""
    _, end = told(table)[mark]
    found = re.search(r"at rest from ([0-9.]+) s", end)
    return found[1] if found else None

@pytest.mark.parametrize(("words", "lines"), [
    # It falls 10 cm at 2 m/s^2. With forward it is 10, 8, 4, -2 cm above its floor, then on it.
    ("99 a_mps2=2 x_m=2.1 motion=forward correction=surface CR=0.5 fps_target=10 --frames=4", {
        "*": ["forward + surface 0.03 m 0.2 0.08 0.26 0.08", "still moves; no hop; hops on"],
        "o": ["exact + replay the truth 0.2 0.05 0.2 0.05",  # a bounce leaves 0.5^2
              "still moves; no hop"]}),
    # It loses all its speed 5 cm beyond the wall, and stays there. This is not at rest.
    ("99 x_m=0.3 v_mps=-1 CR=0 correction=none fps_target=10 --frames=12", {
        "*": ["backward + none 0.05 m 0.5 0 0.5 0", "is beyond a wall; no hop; is stuck"],
        "o": ["exact + replay the truth 0.5 0 0.5 0", "at rest from 0.10 s; no hop"]}),
    # It starts 5 cm beyond its floor, and sinks by 2 cm. The true car starts on the floor.
    ("99 x_m=0.2 a_mps2=-2 CR=0 correction=none fps_target=10 --frames=1", {
        "*": ["backward + none 0.07 m -0.1 -0.14 -0.1 -0.14",
              "is beyond a wall; no hop; gets out"],
        "o": ["exact + replay the truth 0 0 0 0", "still moves; no hop"]}),
    # It ends just beyond a wall, from which it will come back. (The true car has come back.)
    ("2 x_m=2.15 --frames=1", {
        "*": ["backward + none 0.08 m 3.645 3.645 3.645 3.645",
              "still moves; no hop; was off, with the right energy"],
        "o": ["exact + replay the truth 3.645 3.645 3.645 3.645", "still moves; no hop"],
        "+": ["backward + none under 0.001 m 3.645 3.645 3.645 3.645",
              "still moves; no hop; was off, with the right energy"]}),
    # From 1 m above the floor, with backward: 0.98 m after 0.1 s, 0.94 m after 0.2 s.
    ("8 x_m=1.25 --frames=2", {
        "*": ["backward + rebound 0.02 m 2 1.96 2 1.96",
              "still moves; no hop; has too much energy"],
        "o": ["exact + replay the truth 2 2 2 2", "still moves; no hop"],
        "+": ["backward + rebound 0.02 m 3.5 3.46 3.5 3.46",
              "still moves; no hop; has too little energy"]}),
    # A step is a dt^2/2 too far: 8 mm, then 0.8 mm, which is less than a 2000th of the track.
    ("99 x_m=0.75 a_mps2=-1.6 CR=0 correction=surface fps_target=10 --frames=1", {
        "*": ["backward + surface 0.008 m 0.8 0.7872 0.8 0.7872",
              "still moves; no hop; was off, with the right energy"],
        "o": ["exact + replay the truth 0.8 0.8 0.8 0.8", "still moves; no hop"]}),
    ("99 x_m=0.75 a_mps2=-0.16 CR=0 correction=surface fps_target=10 --frames=1", {
        "*": ["backward + surface under 0.001 m 0.08 0.07987 0.08 0.07987",
              "still moves; no hop; was off, with the right energy"],
        "o": ["exact + replay the truth 0.08 0.08 0.08 0.08", "still moves; no hop"]})])
def test_the_table_of_a_small_film_worked_out_by_hand(
        words: str, lines: dict[str, list[str]]) -> None:
    assert told(shown(words).table) == lines

def test_of_more_than_six_hops_the_first_four_and_the_last_two_are_told() -> None:
    for frames, hops in ((200, "65 45 32 23 17 13;"), (220, "65 45 32 23 ... 10 8;")):
        _, end = told(shown(f"5 --frames={frames}").table)["*"]
        assert end.startswith(f"still moves; {hops}")

NUMBERS = st.sampled_from([-1000.0, -1.0, -1e-5, 0.0, 1e-5, 1.0, 1000.0]) | st.floats(-1000, 1000)

@given(x_m=NUMBERS, v_mps=NUMBERS, a_mps2=NUMBERS, CR=st.floats(0, 1),
       right_edge_m=st.sampled_from([-999.0, 2.2, 1000.0]), motion=st.sampled_from([*MOTIONS]),
       correction=st.sampled_from(ALL_CORRECTIONS), fps_target=st.sampled_from([0.1, 7.0, 30.0]),
       jitter=st.floats(0, 0.9), use_observed_dt=st.booleans())
def test_the_table_of_any_scene_fits_in_80_columns_and_has_no_nan(**changes: Any) -> None:
    is_for_all = changes["motion"] == "exact" and changes["x_m"] <= changes["right_edge_m"]
    assume(is_for_all or changes["correction"] not in EXACT_ONLY)
    words = " ".join([f"{name}={value}" for name, value in changes.items()])
    table = shown(f"99 {words} left_edge_m=-1000 show_methods=True --frames=60").table
    assert "nan" not in "".join(table)
    assert max(len(line) for line in table) <= 80
    assert set(told(table)) == set("*oabcde")

# At rest.

@pytest.mark.parametrize(("words", "frames"), [
    ("99 fps_target=10", 10), ("99", 10),  # ten frames, if they last 0.3 s
    ("99 fps_target=50", 16), ("99 fps_target=240", 73),  # 0.3 s from the end of frame 1 on
    ("99 v_mps=2.9 CR=0", 21)])  # 9.7 cm a frame: it stops at the wall in frame 12
def test_a_film_ends_when_the_car_has_been_at_rest_for_0_3_s_and_ten_frames(
        words: str, frames: int) -> None:
    assert len(shown(words).lines) == frames

@pytest.mark.parametrize("words", [
    "15 v_mps=39",  # in a frame it goes to both walls and back to where it was
    "99 v_mps=1e-6",  # a slow drift
    "99 x_m=0.27 a_mps2=-2 CR=1 motion=exact correction=replay fps_target=60",  # a hop of 2 cm
    "99 x_m=0.35 a_mps2=-2 CR=1 motion=exact correction=replay fps_target=1"])  # one of 10 cm
def test_a_car_that_moves_is_not_at_rest(words: str) -> None:
    film = shown(f"{words} show_exact_mark=True --frames=300")
    assert len(film.lines) == 300
    assert rest_text(film.table, "*") is None
    assert rest_text(film.table, "o") is None

@pytest.mark.parametrize(("number", "low_m", "frames"), [
    (20, 0.550625 / 650, 150),  # it can rise to its start, 0.41 m, and v^2/2a more
    (22, 0.001, 300),  # half a column
    (1, 1.75 / 650, 300), (7, 1.75 / 650, 300)])
def test_the_truth_is_at_rest_from_the_frame_on_from_which_it_stays_low(
        number: int, low_m: float, frames: int) -> None:
    scene = airtrack.scene_of(EXAMPLES[number].settings)
    times_s = [Decimal(frame) / Decimal(scene.fps_target) for frame in range(frames + 1)]
    is_low = [float(place_m) - scene.track.left_edge_m <= low_m
              for place_m, _ in states(scene.track, times_s)]
    words = f"{number} show_exact_mark=True auto_off=False --frames={frames}"
    began = rest_text(shown(words).table, "o")
    if number == 7:  # it is elastic
        assert began is None
    else:
        last_high = max(frame for frame in range(frames) if not is_low[frame])
        assert began == f"{(last_high + 1) / scene.fps_target:.2f}"

@pytest.mark.parametrize("ceiling_m", [20, 100, 1000])
def test_a_ceiling_that_is_never_met_changes_nothing(ceiling_m: int) -> None:
    words = "99 x_m=2 a_mps2=-2 CR=0.7 m_to_px=55 show_exact_mark=False"
    film = shown(f"{words} right_edge_m={ceiling_m}")
    row, end = told(film.table)["*"]
    row_of_3_m, end_of_3_m = told(shown(f"{words} right_edge_m=3").table)["*"]
    assert end == end_of_3_m
    assert row.split()[-4:] == row_of_3_m.split()[-4:]

@pytest.mark.parametrize(("words", "is_at_rest"), [
    # It rises from 2 mm to 8 mm: it only passes by.
    ("99 x_m=0.252 v_mps=0.005 a_mps2=-0.002 motion=exact correction=replay CR=1", False),
    # A hop of one frame is drawn where the car lies: it begins at a dt/2, and nobody sees it rise.
    ("99 x_m=0.25 v_mps=0.1 a_mps2=-2 fps_target=10 CR=1 motion=exact correction=replay", True),
    ("99 x_m=0.25 v_mps=0.4 a_mps2=-2 fps_target=10 CR=1 motion=exact correction=replay", False),
    ("99 v_mps=-1 CR=0 correction=none", False),  # it stands still, but beyond the wall
    ("99 v_mps=-1 CR=0 correction=surface", True)])
def test_at_rest_is_what_is_low_for_as_long_as_a_hop_of_that_height(
        words: str, is_at_rest: bool) -> None:
    film = shown(f"{words} --frames=100")
    assert (rest_text(film.table, "*") is not None) is is_at_rest
    assert (len(film.lines) < 100) is is_at_rest

def test_a_car_is_not_at_rest_before_its_last_hop_above_the_limit_has_come_down() -> None:
    # It falls 1.95 m with 0.02 m/s^2. Its 13th hop rises 1.95 m * 0.78^26, 3.05 mm. The limit is
    # 3.00 mm, and a hop so high lasts 1.1 s.
    film = shown("99 x_m=2.2 a_mps2=-0.02 CR=0.78 motion=exact correction=replay fps_target=60")
    fall_s = math.sqrt(2 * 1.95 / 0.02)
    last_bounce_s = fall_s * (1 + 2 * sum(0.78**hop for hop in range(1, 14)))
    began = rest_text(film.table, "*")
    assert began is not None
    assert last_bounce_s - 0.6 < float(began) < last_bounce_s

@pytest.mark.parametrize(("beyond_m", "wall_m", "a_mps2"), [(0, 0.25, -2), (2.45, 2.2, 2)])
def test_after_a_start_beyond_its_floor_a_car_is_low_where_it_is_after_one_on_it(
        beyond_m: float, wall_m: float, a_mps2: float) -> None:
    starts = [airtrack.Track(x_m=x_m, v_mps=0.9, a_mps2=a_mps2) for x_m in (beyond_m, wall_m)]
    low_m, low_of_the_other_m = (airtrack.Rest(track, 1.0).low_m for track in starts)
    assert low_m == low_of_the_other_m == pytest.approx(0.9**2 / 2 / 2 / 650)

def test_a_car_that_takes_very_long_to_come_to_rest_is_asked_in_each_frame_at_no_cost() -> None:
    # With 1e-6 m/s^2 a hop of 3 mm lasts 155 s, so 155 000 frames: pytest's timeout would end it.
    words = "99 x_m=0.25 a_mps2=-1e-6 fps_target=1000 motion=exact correction=surface"
    assert len(shown(f"{words} --frames=40000 show_exact_mark=False").lines) == 40000

# Another unit.

@given(number=st.sampled_from([*EXAMPLES]), motion=st.sampled_from([*MOTIONS]),
       correction=st.sampled_from(ALL_CORRECTIONS), height=st.floats(0, 1), v_mps=st.floats(-2, 2))
@settings(max_examples=60)
def test_a_scene_in_another_unit_is_the_same_film_with_the_same_end_and_verdict(
        number: int, motion: str, correction: str, height: float, v_mps: float) -> None:
    assume(motion == "exact" or correction not in EXACT_ONLY)
    ours: dict[str, Any] = {name: each.default for name, each in airtrack.SETTINGS.items()}
    ours |= EXAMPLES[number].settings | {
        "motion": motion, "correction": correction, "v_mps": v_mps, "show_exact_mark": True}
    ours["x_m"] = ours["left_edge_m"] + height * (ours["right_edge_m"] - ours["left_edge_m"])
    theirs = ours | {"m_to_px": ours["m_to_px"] / 128}
    for name in ("x_m", "v_mps", "a_mps2", "left_edge_m", "right_edge_m"):
        theirs[name] = 128 * ours[name]  # a power of two, so without round-off
    films = []
    for each in (ours, theirs):
        words = " ".join([f"{name}={value}" for name, value in each.items()])
        films.append(shown(f"99 {words} --frames=200"))
    assert films[0].lines == films[1].lines
    assert films[0].ending == films[1].ending
    ends = [[end for _, end in told(film.table).values()] for film in films]
    assert ends[0] == ends[1]

# What is a change.

@pytest.mark.parametrize(("words", "marks", "is_changed"), [
    ("10 CR=1", "*", False), ("10 fps_target=10.0 jitter=0 show_methods=True", "*abcde", False),
    ("10 m_to_px=30 width_px=60 show_start_mark=False auto_off=False", "*", False),
    ("16 x_m=2", "*o", False), ("10 x_m=2.000001", "*+o", True), ("0 CR=0.7", "*+o", True),
    ("13 motion=backward show_methods=True", "*+oabcde", True), ("10 fps_target=11", "*o", True),
    ("9 jitter=0.9", "*o", True), ("9 use_observed_dt=False CR=0.5", "*o", True),
    ("10 CR=0.9 show_exact_mark=False", "*+", True), ("99", "*o", True),
    ("-5 show_exact_mark=False", "*", True)])
def test_a_changed_example_shows_the_o_and_if_the_frames_are_its_own_the_plus(
        words: str, marks: str, is_changed: bool) -> None:
    film = shown(f"{words} --frames=3")
    assert set(told(film.table)) == set(marks)
    question = re.sub(r"(forward|backward|exact) \+ ", "", film.intro)
    assert ("+" in question) is ("+" in marks)
    own_question = EXAMPLES.get(int(words.split()[0]), EXAMPLES[0]).look_for
    assert (plain(own_question) in film.intro) is not is_changed

@pytest.mark.parametrize("change", ["CR=0.5", "a_mps2=-3", "motion=exact", "x_m=1"])
def test_the_plus_is_where_the_example_as_it_is_has_its_car(change: str) -> None:
    as_it_is = shown("9 --frames=120").lines  # in irregular frames
    changed = shown(f"9 {change} auto_off=False --frames=120").lines
    seen = {after[before.index("*")] for before, after in zip(as_it_is, changed, strict=True)}
    assert "+" in seen
    assert seen <= {"+", "*"}  # the * may hide it

@pytest.mark.parametrize(("words", "is_right", "verdict", "without"), [
    ("14 fps_target=100", "Yes", "is right", "gets out"),
    ("8 fps_target=30 CR=0.5", "No", "", "has too little energy"),
    ("22 jitter=0.5 use_observed_dt=True", "No", "", "hops on"),
    ("3 correction=surface", "No", "was off, with the right energy", "is stuck"),
    ("15 CR=0.5", "By definition", "", "is right"), ("14", "No", "gets out", ""),
    ("99 x_m=2 a_mps2=-2 CR=0.8 motion=exact correction=rewind", "Yes", "is right", "")])
def test_after_a_film_it_is_told_if_the_car_is_right_and_if_it_was_without_the_change(
        words: str, is_right: str, verdict: str, without: str) -> None:
    text = plain("\n".join(shown(f"{words} --frames=5").table))
    _, _, answer = text.partition("Is the * right? ")
    assert answer.startswith(is_right)
    assert verdict in answer
    without_change = re.findall(r"Without your change it ([^.]*)\.", answer)
    assert without_change == ([without] if without else [])

@pytest.mark.parametrize("fps", [3, 7, 10])  # their dt add up to a little under 20 s, under, over
def test_after_20_s_the_answer_is_that_of_a_longer_film(fps: int) -> None:
    words = f"99 x_m=1 v_mps=1 CR=1 fps_target={fps}"
    shorter, whole, longer = (plain("\n".join(shown(f"{words} --frames={frames}").table)).partition(
        "Is the * right?")[2] for frames in (20 * fps - 1, 20 * fps, 30 * fps))
    assert shorter != whole == longer

def test_after_a_changed_film_the_map_is_advised_by_a_command_for_the_same_scene(
        play: Play, monkeypatch: pytest.MonkeyPatch) -> None:
    mapped: list[Scene] = []
    monkeypatch.setitem(airtrack.COMMANDS, "stability", lambda scene, _: mapped.append(scene))
    out = play("8 m_to_px=20 CR=.90 x_m=1e0 motion=exact fps_target=60 --frames=3")
    advised, = re.findall(r"(?m)airtrack\.py (stability .*)$", out)
    main(advised.split())
    scene, = mapped
    track = scene.track
    assert (track.x_m, track.a_mps2, track.CR, scene.m_to_px) == (1.0, -2.0, 0.9, 20.0)
