"""The two pages: their commands run, their listings work, their figures are worked out here."""

import importlib.metadata
import io
import math
import re
import shutil
import subprocess
import sys
from contextlib import redirect_stdout
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Any
from unittest.mock import Mock, patch

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from test_chart_and_map import RATES, errors_m, map_rows, printed
from test_law import CORRECTION, MOTION, ORDERS, game

import airtrack
from airtrack import ALL_CORRECTIONS, CORRECTIONS, METHODS, MOTIONS, Scene, step
from examples import EXAMPLES
from films import (
    HERE,
    apart_m,
    beside_the_truth,
    collisions,
    details,
    environment,
    film,
    hops_nearby,
    states,
)

Capture = pytest.CaptureFixture[str]
README = (HERE / "README.md").read_text(encoding="utf-8")
LESSON = (HERE / ".github/lesson.md").read_text(encoding="utf-8")
LISTINGS: list[str] = re.findall(r"^```\w*\n(.*?)^```$", README + LESSON, re.MULTILINE | re.DOTALL)
PLAIN = {page: " ".join(text.replace("\u2212", "-").replace("\n> ", " ").split())
         for page, text in (("README", README), ("LESSON", LESSON))}


def says(page: str, sentence: str, *values: object) -> None:
    """The page has this sentence, with these values in its braces."""
    assert sentence.format(*values) in PLAIN[page]


def listing(part: str) -> str:
    """The one listing that has the part."""
    found, = [text for text in LISTINGS if part in text]
    return found


# Commands.

COMMANDS = sorted(set(re.findall(
    r"(?:python3?|py|uv run) airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", README + LESSON)))


@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_runs(words: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    for name in ("film", "chart", "stability"):
        monkeypatch.setattr(airtrack, name, lambda *_: None)
    assert airtrack.main(words.partition(" > ")[0].split()) == 0


def test_no_command_is_broken_over_two_lines() -> None:
    for text in (README, LESSON):
        for line in re.sub("(?ms)^```.*?^```", "", text).splitlines():
            assert line.count("`") % 2 == 0, line


def test_the_two_set_up_commands_and_the_size_of_the_pages() -> None:
    start = "python3 -m venv .venv && . .venv/bin/activate && python -m pip install "
    assert f"`{start}. && python airtrack.py 10 d`" in README
    assert f'\n{start}".[test]" && python -m pytest\n' in README
    assert README.count("\n") <= 285
    assert LESSON.count("\n") <= 205
    for name, told in (("airtrack.py", "AIRTRACK"), ("examples.py", "EXAMPLES")):
        lines = (HERE / name).read_text().count("\n")
        (told_of,) = re.findall(rf"`{name}` \((\d+) lines\)", README)
        assert abs(int(told_of) - lines) <= 0.05 * lines, told


def test_every_picture_is_there_and_no_other() -> None:
    shown = set(re.findall(r"\]\(\.github/([a-z0-9-]+\.(?:png|gif))\)", README))
    assert shown == {path.name for path in (HERE / ".github").iterdir()
                     if path.suffix in (".png", ".gif")}


# One film.

def test_example_13_is_met_as_the_program_shows_it(capsys: Capture) -> None:
    words, = re.findall(r"`python airtrack.py (13 --fast --frames 18[^`]*)`", README)
    first, last = (text for text in LISTINGS if re.fullmatch(r"([ |*o]+\n){9}", text))
    assert (first + last).splitlines() == [
        line.rstrip() for line in film(capsys, *words.split()).lines]
    assert README.index(first) < README.index("<details>") < README.index(last)
    quoted = [quote.replace("\n> ", " ") for quote in re.findall(
        r"^> (.*?)$(?!\n>)", README, re.MULTILINE | re.DOTALL)]
    assert quoted == [EXAMPLES[13].look_for, EXAMPLES[13].seen]


def test_the_first_picture_s_car_should_come_back_and_flies_to_the_other_wall() -> None:
    found = beside_the_truth(17, 40)
    assert any(mark_m is not None and mark_m > 2.2 for *_, mark_m in found)
    assert max(true_m for _, true_m, _ in found) <= 2.0
    assert apart_m(found[:13]) < 1e-12


# The cure, and the order of three lines.

@given(depth=st.floats(0, 10), falling=st.floats(-50, 50), gravity=st.floats(-50, 50),
       CR=st.floats(0, 1))
@example(depth=1.0, falling=2.0, gravity=3.0, CR=0.1)  # its energy does not carry it so far
def test_the_cure_is_conserve_for_a_floor_a_side_wall_and_a_ceiling(
        depth: float, falling: float, gravity: float, CR: float) -> None:
    code, names = listing("def bounce("), dict[str, Any]()
    exec(code, names)
    for pull in (gravity, 0, -gravity):
        assert names["bounce"](depth, falling, pull, CR) == pytest.approx(
            CORRECTIONS["conserve"](-depth, -falling, 0.0, -pull, CR), abs=1e-12)


def test_the_loops_are_the_methods_that_the_page_names() -> None:
    for parts, motion, correction in (
            (("v -= gravity",), "backward", "surface"),
            (("def bounce(", "bounce(-y"), "exact", "conserve")):
        *before, loop = map(listing, parts)
        names: dict[str, Any] = {"y": 1, "v": 0, "gravity": 10, "CR": 0.5, "dt": 0.1}
        for code in before:
            exec(code, names)
        scene = Scene(a_mps2=-10, left_edge_m=0, CR=0.5, motion=motion, correction=correction)
        x_m, v_mps = 1.0, 0.0
        for _ in range(100):
            exec(loop, names)
            x_m, v_mps, _ = step(scene, x_m, v_mps, 0.1)
            assert (names["y"], names["v"]) == pytest.approx((x_m, v_mps), abs=1e-7)


def test_the_two_orders_are_the_six(capsys: Capture) -> None:
    order = r"(\w+, \w+, \w+)"
    rows = re.findall(rf"(?m)^\| {order} \| {order}; {order} \| (.*?)\.", README)
    told = {order: text for *orders, text in rows for order in orders}
    assert set(told) == set(ORDERS)
    for order, text in told.items():
        assert text.startswith("It hops for ever" if ORDERS[order] else "The ball comes to rest")
    heights_m = game("position, gravity, contact", 0.8, 6000)[1][-100:]
    says("README", "It hops for ever: in example 22 (CR 0.8, 10 m/s\u00b2, 60 FPS) {:.0f} mm high",
         1000 * max(heights_m))
    _, heights_m = game("gravity, position, contact", 1.0, 6000)
    says("README", "from 1 m, at 10 m/s\u00b2 and 60 FPS, {:.3f} m high", max(heights_m[500:]))


@pytest.mark.parametrize("CR", [0.5, 0.8])
def test_to_reverse_v_only_while_the_ball_moves_in_lets_it_sink_or_hop_with_k_1(CR: float) -> None:
    says("README", "the ball then sinks by g dt\u00b2/(1 + CR) each frame")
    for order in ("gpc", "pgc"):
        y_m, v_mps, dt_s, contacts, heights_m = 1.0, 0.0, 1 / 60, list[int](), list[float]()
        for frame in range(4000):
            for line in order:
                if line == "g":
                    v_mps -= 10 * dt_s
                elif line == "p":
                    y_m += v_mps * dt_s
                elif y_m < 0 and v_mps < 0:
                    v_mps = -CR * v_mps
                    contacts.append(frame)
            heights_m.append(y_m)
        if order == "gpc":
            assert heights_m[-2] - heights_m[-1] == pytest.approx(10 * dt_s**2 / (1 + CR), rel=1e-3)
        else:
            last = [after - before for before, after in pairwise(contacts[-21:])]
            assert sum(last) / len(last) == pytest.approx((1 + CR) / (1 - CR), abs=2)


def test_pixels_and_frames() -> None:
    v_px, g_px, fps = 5.0, 0.3, 60
    metres = 0.01 * (v_px * 30 + g_px * 30**2 / 2)  # after 30 frames, 1 px is 1 cm
    seconds, v_mps, g_mps2 = 30 / fps, v_px * fps / 100, g_px * fps**2 / 100
    assert metres == pytest.approx(v_mps * seconds + g_mps2 * seconds**2 / 2)
    says("README", "v \u00b7 FPS/100 m/s, and g px a frame\u00b2 are g \u00b7 FPS\u00b2/100 m/s")


SYMPTOMS = {  # what is seen: the examples that show it, as their titles and texts say
    "bounces higher each time": "17, 13", "never lies still": "20, 22", "sticks in the wall": "3",
    "goes through the wall": "14, 15, 18", "bounces differently": "8 beside 7",
    "slow ball sticks": "19"}
SENTENCES = [  # plain numbers and references, each with its page
    ("README", "They end near k (1 + CR)/(1 - CR) lines instead"),
    ("README", "with forward + surface 2 g dt/(1 - CR) is enough"),
    ("LESSON", "type `python3 airtrack.py 1`, on Windows `py airtrack.py 1`"),
    ("README", "Example 13 asks:"), ("README", "let 1 px be 1 cm"),
    ("README", "look for the floor, at y = 0"), ("README", "At rest v is not 0"),
    ("README", "call `bounce` with gravity 0"), ("README", "A hop lower than 5e-11 m is rest"),
    ("README", "1 for forward, 0 for exact and -1 for backward"),
    ("README", "drop/way is 1/2 for surface, 1 for rebound and 0 for none (at CR = 1)"),
    ("README", "from 10 FPS at its top to 3840 FPS at its end"),
    ("README", "is in section 8 of `airtrack.py`"),
    ("README", "hops grow, by 2 k lines each on average"), ("README", "if this is well over two"),
    ("README", "**k > 0**"), ("README", "**k < 0**: it gets too little. At CR = 1"),
    ("README", "**k = 0**"), ("README", "so 0.64 of the energy: 1.86 of 2.90 J/kg"),
    ("README", "a map of all 14"), ("README", "(Python 3.11, and 3.14 with pygame-ce)"),
    ("README", "at most about 1.7 times as much"), ("README", "frames of examples 9, 11 and 12"),
    ("LESSON", "the worksheet below for 8"), ("LESSON", "The car of example 12 starts"),
    ("LESSON", "1.75 m from the left wall, and a is -2"), ("LESSON", "This prints example 8"),
    ("LESSON", "With CR = 1 it keeps all"), ("LESSON", "the first hop of example 20 has 11 lines"),
    ("LESSON", "This is example 0 without"),
    ("LESSON", "There 34 columns are 1 m and 10 lines are 1"), ("LESSON", "must have met 13"),
    ("LESSON", "Here k is 1 + 1/2"),
    ("LESSON", "A ball with CR = 0.9 whose first hop takes 0.63 s"),
    ("LESSON", "heard a real one for 6.42 s"), ("LESSON", "The lesson: 40 minutes"),
    ("LESSON", "0 to 10 | `python airtrack.py 1`"),
    ("LESSON", "10 to 20 | `python airtrack.py 13`"),
    ("LESSON", "20 to 30 | `python airtrack.py 8`"),
    ("LESSON", "30 to 40 | `python airtrack.py 10`"), ("LESSON", "Press s fourteen times"),
    ("LESSON", "keeps 0.7 of its speed"), ("LESSON", "(Many say 70 %"),
    ("LESSON", "in the end by 1 mm"), ("LESSON", "T = \u221a(2 \u00b7 1.75/2) s = 1.323 s"),
    ("LESSON", "The first hop takes 2 CR T"),
    ("LESSON", "5 minutes: `python airtrack.py 3`"),
    ("LESSON", "10 minutes: `python airtrack.py 21`"), ("LESSON", "leave out 13"),
    ("LESSON", "the same for 10 with 54 frames"), ("LESSON", "about 100 of them fit side by side"),
    ("LESSON", "from about 16 years on"),
    ("LESSON", "bounces at `|`. It needs Python 3.11 or later"),
    ("LESSON", "Let it run for ten seconds"), ("LESSON", "in a terminal of 150 columns"),
    ("README", "You need Python 3.11 or later"),
    ("README", "15 minutes of reading, 40 minutes in class"),
    ("README", "At CR = 1 it should hop for ever, but as a rule"),
    ("README", "| begun with another line | at CR < 1 | at CR = 1 |"),
    ("README", "Three of its rows, for example 10"), ("README", "the hops of example 19 (CR = 1)"),
    ("README", "by nine methods, beside 2 k"), ("README", "dt is 0.1 s, the acceleration is -20"),
    ("LESSON", "of fixed width, 10 points"),
]


@pytest.mark.parametrize(("page", "sentence"), SENTENCES)
def test_plain_numbers_and_references_stand_in_their_sentences(page: str, sentence: str) -> None:
    says(page, sentence)


def test_each_symptom_names_the_examples_that_show_it() -> None:
    rows = re.findall(r"(?m)^\| ([A-Z][^|]*) \| [^|]* \| [^|]* \| ([0-9][^|]*) \|$", README)
    assert len(rows) == len(SYMPTOMS)
    for (seen, told), (symptom, examples) in zip(rows, SYMPTOMS.items(), strict=True):
        assert symptom in seen
        assert told == examples


# The methods, how good they are, and the law.

def test_one_collision_is_drawn_by_all_six_corrections(capsys: Capture) -> None:
    words = ("99 d x_m=0.32 v_mps=-1 a_mps2=-20 left_edge_m=0.2 fps_target=10 motion=exact "
             "m_to_px=100 width_px=60 --frames 1")
    told = listing("replay     0 ").splitlines()
    for correction, row in zip(ALL_CORRECTIONS, told[1:], strict=True):
        line, = film(capsys, *words.split(), f"correction={correction}").lines
        x_m, v_mps = details(line)
        scene = Scene(x_m=0.32, a_mps2=-20, left_edge_m=0.2, motion="exact", correction=correction)
        x_m, v_mps, _ = step(scene, 0.32, -1, 0.1)
        energy = v_mps**2 / 2 + 20 * (x_m - 0.2)
        assert row.split()[0] == correction
        assert row[11:35].rstrip() == line[12:36].rstrip()
        assert row.endswith(f"v = {v_mps:5.2f} m/s   {energy:.2f} J/kg")
    assert told[0].endswith(f"v = -1.00 m/s   {0.5 + 20 * 0.12:.2f} J/kg")


def test_the_table_of_methods_is_that_of_the_listing() -> None:
    rows = re.findall(r"(?m)^\| ([a-e]) (\w+) \+ (\w+) \| (\w+) \| (.*?) \| .*? \| .*? \|$",
                      README)
    assert {letter: (motion, correction) for letter, motion, correction, *_ in rows} == METHODS
    code = (HERE / "airtrack.py").read_text()
    for letter, motion, correction, order, energy in rows:
        start = rf"#     {letter}  {motion} \+ {correction} +{order} +{energy} "
        assert re.search(start, code), start


def test_what_the_chart_shows() -> None:
    a, b, c, d = (errors_m("10", letter) for letter in "abcd")
    says("README", "From {} FPS on, exact + rebound is worse than backward + rebound", 30)
    assert [b_m > a_m for b_m, a_m in zip(b, a, strict=True)] == [fps >= 30 for fps in RATES]
    assert (c[5] / c[8])**(1 / 3) == pytest.approx(4, rel=0.2)
    assert (a[5] / a[8])**(1 / 3) == pytest.approx(2, rel=0.2)
    says("README", "half the dt makes a quarter of the error of c, and half of the error of a.")
    says("README", "At 10 FPS, d takes under {} % of the time of a at 3840 FPS", 1)
    assert 2 * 10 / 3840 < 0.01  # so it is, if a step of d costs less than two of a
    assert d[0] < 1e-10
    surface_m = [largest for fps in (30, 60, 120, 240, 480) for largest in [
        airtrack.largest_error_m(Scene(x_m=2, a_mps2=-2, CR=1, correction="surface"), fps)]]
    assert surface_m == pytest.approx(a[1:6], rel=0.25)
    assert all(bad_m > 0.95 * a_m for bad_m, a_m in zip(surface_m, a[1:6], strict=True))
    says("README", "From {} FPS on it is about as inaccurate as method a", 30)


def test_three_rows_of_the_map() -> None:
    rows = map_rows(10)
    told = listing("1000 FPS").splitlines()
    assert told[0].strip() in printed("stability", "10")
    for row in told[1:]:
        (name, letters), = re.findall(r"(\w+ \+ \w+) +(.*)", row)
        assert letters.split() == rows[name]


def test_the_tables_of_k_and_of_the_hops_of_19(capsys: Capture) -> None:
    readme = README.replace("\u2212", "-")
    fractions = {"1/2": 0.5, "-1/2": -0.5, "3/2": 1.5}
    table = readme.partition("So k is on average")[2]
    for motion in MOTION:
        cells = re.findall(rf"(?m)^\| {motion} \|(.*)\|$", table)[0].split("|")
        for cell, correction in zip(cells, ("none", "surface", "rebound", "conserve"), strict=True):
            k = fractions.get(cell.strip()) or float(cell.strip())
            assert k == MOTION[motion] + CORRECTION[correction]
    rows = re.findall(r"(?m)^\| (\w+) \|" + 3 * r" \*\*(\S+)\*\*: (\d.*?) \|" + "$", readme)
    assert len(rows) == 3
    for motion, *cells in rows:
        for correction, twice, text in zip(("none", "surface", "rebound"), cells[::2], cells[1::2],
                                           strict=True):
            assert int(twice) == 2 * (MOTION[motion] + CORRECTION[correction])
            lines = [int(word) for word in re.findall("[0-9]+", text.partition(" \u2026")[0])]
            assert len(lines) >= 3
            found = hops_nearby(19, len(lines), motion=motion, correction=correction)
            assert found == [lines] * 9


# The lesson.

def test_the_lesson_s_table_of_starts_and_of_examples() -> None:
    plain = LESSON.replace("\u2212", "-").replace("\u00b2", "2")
    rows = re.findall(
        r"(?m)^\| (\d+) \| (\S+) m \| (\S+) m/s \| (\S+) m/s2 \| (\S+) \| (\d+) \| (\d+) s.*"
        r"\| (.*) \|$", plain)
    assert [int(row[0]) for row in rows] == [1, 13, 8, 10, 3, 21]
    for number, *told, _, method in rows:
        scene = Scene(**EXAMPLES[int(number)].settings)
        assert [float(figure) for figure in told] == [
            scene.x_m, scene.v_mps, scene.a_mps2, scene.CR, scene.fps_target]
        assert method == f"{scene.motion} + {scene.correction}"
    least_s = [251 / 30, 1.3, 4 * 2.6, 4 * 2.646, 273 / 30, 20]  # then their answers are seen
    for row, least in zip(rows, least_s, strict=True):
        assert least <= float(row[6]) <= least + 2
    rows = re.findall(r"(?m)^\| (\d+) \| (.*) \| (.* \+ .*) \| (\S+) \| (\S+) \|$", LESSON)
    assert rows == [
        (str(number), each.title, f"{scene.motion} + {scene.correction}",
         f"{scene.fps_target:.3g}", f"{scene.CR:g}") for number, each in EXAMPLES.items()
        for scene in [Scene(**each.settings)]]


def test_the_lesson_s_answers() -> None:
    says("LESSON", "so 0.7\u00b2 = {:.2f} of its energy", 0.7**2)
    says("LESSON", "it gets \u00bd |a| dt\u00b2 = {:.0f} cm too far", 100 * 2 * 0.1**2 / 2)
    says("LESSON", "a\u00b2 dt\u00b2/2 = {:.2f} m\u00b2/s\u00b2 in each step", 2**2 * 0.1**2 / 2)
    first, second = (100 * (0.25 - mark_m) for *_, mark_m in states(8, 60) if mark_m is not None)
    says("LESSON", "First this is {:.0f} cm: 2 - 0.26 + 2 \u00b7 0.07 = {:.2f} m", first,
         2 - 0.26 + 2 * 0.07)
    says("LESSON", "Then it is {:.0f} cm: 1.88 - 0.26 + 2 \u00b7 0.19 = {:.0f} m", second,
         1.88 - 0.26 + 2 * 0.19)
    fall_s = math.sqrt(1.75)
    says("LESSON", "s = {:.3f} s, so {:.3f} s after frame 13", fall_s, fall_s - 1.3)
    (_, v_mps, _), (_, after_mps, mark_m), (next_m, *_) = states(3, 47)[44:]
    assert mark_m is not None
    says("LESSON", "In frame {} it is {:.1f} cm beyond the wall, at {:.2f} m/s. It keeps 60 % of "
         "this: {:.2f} m/s. In the next frame the acceleration slows it to {:.2f} m/s, so it moves "
         "back only 1.33/30 m = {:.1f} cm", 46, 100 * (0.25 - mark_m), 1.5 / 30 - v_mps, after_mps,
         after_mps - 1.5 / 30, 100 * (next_m - mark_m))
    assert collisions(states(3, 46)) == [46]
    for letter, sentence in (("b", "furthest away, up to {:.1f} m within 20 s"),
                             ("c", "stays within {:.0f} cm")):
        motion, correction = METHODS[letter]
        off_m = apart_m(beside_the_truth(21, 200, motion=motion, correction=correction))
        says("LESSON", sentence, off_m if letter == "b" else 100 * off_m)


def test_the_worksheet_fits_on_A4_and_tells_no_answer(capsys: Capture) -> None:
    words, = re.findall(r"`python airtrack.py (8 --fast [^`>]*) >", LESSON)
    assert airtrack.main(words.split()) == 0
    sheet = capsys.readouterr().out
    assert max(map(len, sheet.splitlines())) <= 80  # 80 * 6 pt = 480 of 595 pt
    assert sheet.count("\n") <= 63  # 63 * 12 pt = 756 of 842 pt
    assert EXAMPLES[8].seen[:40] not in sheet
    for t_s, (x_m, *_) in zip((0.1 * frame for frame in range(1, 13)), states(8, 12), strict=True):
        assert x_m < 2 - t_s**2  # too far to the left


def filmed(code: str, frames: int) -> list[str]:
    """The lines that a listing prints until Ctrl-C comes in its last sleep."""
    sleep = Mock(side_effect=[None] * (frames - 1) + [KeyboardInterrupt])
    with patch("time.sleep", sleep), redirect_stdout(io.StringIO()) as out:
        exec(code, {})
    assert {args for args, _ in sleep.call_args_list} == {(0.015,)}
    *lines, ending = out.getvalue().splitlines()
    assert ending == "Stopped: Ctrl-C was pressed."
    return lines


def test_the_engine_is_a_page_and_example_0_and_a_spring_swings_on(capsys: Capture) -> None:
    code, old = listing("def settle("), "    v_mps += a_mps2 * dt_s\n"
    says("LESSON", "The engine in {} lines", code.count("\n"))
    lines = filmed(code, 600)
    assert [line[:126] for line in lines] == [
        line[:126] for line in film(capsys, "--frames", "600").lines]
    new, = re.findall(r"first line in `move` by `(v_mps .*)`", LESSON)
    lines = filmed(code.replace(old, f"    {new}\n"), 6000)
    for last in (lines[3000:4000], lines[5000:]):
        xs = [details(line)[0] for line in last]
        assert (min(xs), max(xs)) == (0.5, 17.5)


def test_the_exercises(capsys: Capture) -> None:
    ending = film(capsys, "12", "CR=0.9", "correction=replay").ending
    rest_s, = re.findall(r"t = (.*) s: the car is at rest", ending)
    says("LESSON", "at {} s, because", rest_s)
    says("LESSON", "T (1 + CR)/(1 - CR) = {:.1f} s: the Zeno point", math.sqrt(1.75) * 1.9 / 0.1)
    law = list(accumulate(range(99), lambda hop, _: 0.6 * (hop + 1.5) + 1.5, initial=11.0))
    says("LESSON", "The law foretells 11, {:g}, {:.1f}, {:.1f} \u2026, and that the hops end near "
         "{:.0f}", *law[1:4], law[-1])
    told, = re.findall(r"The film has ([0-9 ]+) \u2026", PLAIN["LESSON"])
    lines = [int(word) for word in told.split()]
    changes: dict[str, Any] = {"motion": "forward", "correction": "surface", "CR": 0.6}
    assert hops_nearby(20, len(lines), **changes) == [lines] * 9


def test_a_real_ball() -> None:
    says("LESSON", "should bounce for 0.63/(1 - 0.9) s = {:.1f} s", 0.63 / (1 - 0.9))
    rests, hops_on = map(float, re.findall(r"fter one of (\S+) s it is", PLAIN["LESSON"]))
    scene = Scene(x_m=0.25, v_mps=9.81 * 0.63 / 2, a_mps2=-9.81, CR=0.9, motion="exact",
                  correction="replay", right_edge_m=9)
    assert step(scene, scene.x_m, scene.v_mps, rests)[1] == 0
    assert step(scene, scene.x_m, scene.v_mps, hops_on)[1] != 0


def add_the_motion(folder: Path) -> None:
    """Do what the page says in its first exercise, if it is not done."""
    text = (HERE / "airtrack.py").read_text()
    for old, new in () if "mean" in MOTIONS else (
            ("MOTIONS = {", listing("def mean(") + "\nMOTIONS = {"),
            ('"exact": exact}', '"exact": exact, "mean": mean}')):
        assert text.count(old) == 1
        text = text.replace(old, new)
    (folder / "airtrack.py").write_text(text)


def test_the_exercise_s_fourth_motion_has_the_letters_of_exact(tmp_path: Path) -> None:
    add_the_motion(tmp_path)
    shutil.copy(HERE / "examples.py", tmp_path)
    out = subprocess.run(
        [sys.executable, "airtrack.py", "stability", "12"], cwd=tmp_path, text=True,
        capture_output=True, env=environment(), check=True).stdout
    rows = {name: letters.split() for name, letters in re.findall(
        r"(?m)^(\w+ \+ \w+) +(.*)$", out)}
    for correction in ("none", "surface", "rebound", "conserve"):
        assert rows[f"mean + {correction}"] == rows[f"exact + {correction}"]
    assert len(rows) == 18


def test_pip_install_brings_the_dependencies_alone() -> None:
    try:
        files = importlib.metadata.files("airtrack") or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the project is not installed")
    assert [file.name for file in files if file.suffix == ".py"] == []
