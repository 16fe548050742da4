"""The README: what it shows is what the program shows, and what it lists runs."""

import importlib.metadata
import io
import math
import re
import shutil
import subprocess
import sys
from contextlib import redirect_stdout
from fractions import Fraction
from itertools import accumulate
from pathlib import Path
from typing import Any
from unittest.mock import Mock, patch

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import airtrack
from airtrack import CORRECTIONS, EVERY_CORRECTION, METHODS, MOTIONS, Scene, step
from examples import EXAMPLES
from figures import RATES, errors_m, printed
from films import HERE, README, K, details, environment, film, hops_nearby
from test_examples import states
from test_stability import ORDERS

Capture = pytest.CaptureFixture[str]
LISTINGS: list[str] = re.findall(r"^```\w*\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
COMMANDS = sorted(set(re.findall(
    r"(?:python3?|py)\s+airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", README)))


def listing(part: str) -> str:
    """The one listing that has the part."""
    found, = [text for text in LISTINGS if part in text]
    return found


def filmed(code: str, frames: int) -> tuple[list[str], set[str]]:
    """The lines that a listing prints until Ctrl-C comes in its last sleep, and its names."""
    sleep, names = Mock(side_effect=[None] * (frames - 1) + [KeyboardInterrupt]), dict[str, Any]()
    with patch("time.sleep", sleep), redirect_stdout(io.StringIO()) as out:
        exec(code, names)
    assert {args for args, _ in sleep.call_args_list} == {(0.015,)}
    *lines, ending = out.getvalue().splitlines()
    assert ending == "Stopped: Ctrl-C was pressed."
    return lines, set(names)


def test_the_one_pager_is_a_page_and_shows_what_the_program_shows(capsys: Capture) -> None:
    code = listing("def settle(")
    lines, names = filmed(code, 600)
    assert code.count("\n") == int(re.findall("in ([0-9]+) lines", README)[0]) <= 40
    assert names == {"__builtins__", "time", "move", "settle", "draw", "film"}  # no globals
    shown = film(capsys, "--frames", "600").lines
    assert [line[:126] for line in lines] == [line[:126] for line in shown]


def test_a_spring_swings_on_from_wall_to_wall() -> None:
    code, old = listing("def settle("), "    v_mps += a_mps2 * dt_s\n"
    assert code.index(old) == code.index("dt_s):\n") + len("dt_s):\n")  # the first line of move
    new, = re.findall(r"first line of `move` by `(v_mps .*)`", README)
    lines, _ = filmed(code.replace(old, f"    {new}\n"), 6000)
    for last in (lines[3000:4000], lines[5000:]):
        xs = [details(line)[0] for line in last]
        assert (min(xs), max(xs)) == (0.5, 17.5)


def test_the_film_as_it_is_met_is_the_program_s(capsys: Capture) -> None:
    words, = re.findall(r"`python airtrack.py (13 --fast [^`]*)`", README)
    first, last = (text for text in LISTINGS if re.fullmatch(r"([ |*o]+\n){9}", text))
    assert (first + last).splitlines() == [
        line.rstrip() for line in film(capsys, *words.split()).lines]
    assert README.index(first) < README.index("<details>") < README.index(last)
    quoted = [quote.replace("\n> ", " ") for quote in re.findall(
        r"^> (.*?)$(?!\n>)", README, re.MULTILINE | re.DOTALL)]
    assert quoted == [EXAMPLES[13].look_for, EXAMPLES[13].seen]
    scene = Scene(**EXAMPLES[13].settings)
    assert "Each line is a tenth of a second. The walls are at 0.25 and 2.2 m." in README
    assert (scene.fps_target, scene.left_edge_m, scene.right_edge_m) == (10, 0.25, 2.2)


LESSON = [1, 3, 13, 8, 10, 21]


def test_the_lesson_s_films_are_there_and_its_minutes_add_up() -> None:
    rows = re.findall(r"^\| (\d+) \| .*\? \| .* \| (\d+) \|$", README, re.MULTILINE)
    assert [int(number) for number, _ in rows] == LESSON
    assert f"They add up to {sum(int(minutes) for _, minutes in rows)}," in README


def test_the_teacher_s_sheet_has_the_program_s_figures() -> None:
    sheet = README.partition("<summary>For the teacher")[2].partition("</details>")[0]
    rows = re.findall(
        r"^\| (\d+) \| (\S+) m \| (\S+) m/s \| (\S+) m/s\u00b2 \| (\S+) \| (\d+) \| (\d+) s", sheet,
        re.MULTILINE)
    assert [int(row[0]) for row in rows] == LESSON
    for number, *told, _ in rows:
        scene = Scene(**EXAMPLES[int(number)].settings)
        assert [float(figure) for figure in told] == [
            scene.x_m, scene.v_mps, -scene.a_mps2, scene.CR, scene.fps_target]
    least_s = [251 / 30, 273 / 30, 1.3, 4 * 2.6, 4 * 2.646, 20]  # then their answers are seen
    assert all(least <= float(row[-1]) <= least + 2 for row, least in zip(
        rows, least_s, strict=True))
    told = " ".join(sheet.split())

    (x_m, v_mps, _), (_, after_mps, mark_m), (next_m, *_) = states(3, 47)[44:]
    assert mark_m is not None
    figures = [100 * (0.25 - mark_m), 1.5 / 30 - v_mps, after_mps, after_mps - 1.5 / 30,
               100 * (next_m - mark_m)]
    assert x_m > 0.25 > next_m
    assert "frame 46 it is {:.1f} cm beyond the wall, with {:.2f} m/s. It keeps 60 % of this " \
           "speed, which is {:.2f} m/s. In the next frame the pull slows it to {:.2f} m/s, so it " \
           "moves back only 1.33/30 m = {:.1f} cm.".format(*figures) in told
    told = told.translate({0xb2: "2", 0xb7: "*"})
    for figure in (f"CR2 = {0.7**2:.2f}", f"* (0.1 s)2 = {100 * 2 * 0.1**2 / 2:.0f} cm too far",
                   f"a2 dt2/2 = {2**2 * 0.1**2 / 2:.2f} m2/s2", "1 cm too far to the left",
                   "take 26 frames, so this is 26 cm",
                   "7 cm, and 2 \u2212 0.26 + 2 * 0.07 = 1.88 m.",
                   "19 cm, and 1.88 \u2212 0.26 + 2 * 0.19 = 2 m.", "1.8 m within 20 s",
                   "within 10 cm", "first 14 frames with s",
                   f"{math.sqrt(1.75):.3f} s after it starts, so 0.023 s after frame 13"):
        assert figure in told  # those of 8 and 21: test_examples.py
    for letter, (motion, correction) in METHODS.items():
        assert f"{letter} ({motion} + {correction})" in told


@given(depth=st.floats(0, 10), falling=st.floats(-50, 50), pull=st.floats(-50, 50),
       CR=st.floats(0, 1))
@example(depth=1.0, falling=2.0, pull=3.0, CR=0.1)  # its energy does not carry it so far
def test_the_cure_to_take_away_is_conserve(
        depth: float, falling: float, pull: float, CR: float) -> None:
    code, names = listing("def bounce("), dict[str, Any]()
    assert code.count("\n") == 8
    exec(code, names)
    assert names["bounce"](depth, falling, pull, CR) == pytest.approx(
        CORRECTIONS["conserve"](-depth, -falling, 0.0, -pull, CR))


def test_the_map_is_that_of_the_program() -> None:
    told, shown = printed("stability", "10"), listing("X out, ")
    told = " ".join(re.sub("(?m)^mean .*", "", told).split())
    assert shown.count("\n") == 17
    assert " ".join(shown.split()) in told


def test_one_collision_is_drawn_by_each_correction_as_the_program_does(capsys: Capture) -> None:
    words = ("99 d x_m=0.8 v_mps=-5 a_mps2=-20 left_edge_m=0.5 right_edge_m=1.5 fps_target=10 "
             "motion=exact show_exact_mark=True m_to_px=24 width_px=38 --frames 1")
    drawn = []
    for correction in EVERY_CORRECTION:
        line, = film(capsys, *words.split(), f"correction={correction}").lines
        track, x_m, v_mps = line[:38].rstrip(), *details(line)
        drawn.append(f"{correction:9}{track}   x = {x_m:.2f}, v = {v_mps:.2f}, turns at "
                     f"{x_m + v_mps**2 / 2 / 20:.2f} m")
    assert listing("conserve      0 ").splitlines() == drawn
    assert MOTIONS["exact"](0.8, -5, -20, 0.1) == pytest.approx((0.2, -7))


def test_the_lines_of_20_are_those_of_its_film(capsys: Capture) -> None:
    lines = film(capsys, "20", "d", "--frames", "26").lines
    told = re.findall(r"(?m)^(\d+)   (x = .{6}, v = .{5})", listing("a bounce was found"))
    assert [number for number, _ in told] == ["12", "25", "26"]
    assert all(figures in lines[int(number) - 1] for number, figures in told)


def test_the_examples_are_those_of_the_program() -> None:
    rows = re.findall(
        r"^\| (\d+) \| (.*) \| (.* \+ .*) \| (.*) \| (.*) \|$", README, re.MULTILINE)
    scenes = {number: Scene(**example.settings) for number, example in EXAMPLES.items()}
    assert rows == [
        (str(number), EXAMPLES[number].title, f"{scene.motion} + {scene.correction}",
         f"{scene.fps_target:.3g}", f"{scene.CR:g}") for number, scene in scenes.items()]


def test_the_hops_are_counted_and_predicted_as_its_tables_say() -> None:
    readme = README.replace("\u2212", "-")
    names, _, numbers = readme[readme.index("| forward | exact |"):].splitlines()[:3]
    assert {name.strip(): float(Fraction(k.split()[0])) for name, k in zip(
        names.split("|"), numbers.split("|"), strict=True) if k.strip()} == K
    told = []
    for motion, *cells in re.findall(
            r"^\| (\w+) \|" + 3 * r" \*\*(\S+)\*\*: (\d.*) \|" + "$", readme, re.MULTILINE):
        for correction, twice, text in zip(
                ("none", "surface", "rebound"), cells[::2], cells[1::2], strict=True):
            assert int(twice) == 2 * (K[motion] + K[correction])
            told.append((19, 1.0, motion, correction, text.partition(" \u2026")[0]))
    assert len(told) == 9
    answer, = re.findall(r"film has ([0-9\s]+) \u2026 lines", README)
    counted, predicted = (line.split("|")[2:-1] for line in re.findall(
        r"^\| (?:counted|predicted) \|.*$", README, re.MULTILINE))
    for number, CR, motion, correction, text in (
            *told, (20, 0.6, "forward", "surface", answer),
            (20, 0.8, "exact", "rebound", " ".join(counted))):
        lines = [int(word) for word in re.findall("[0-9]+", text)]
        assert len(lines) >= 3
        changes = {"motion": motion, "correction": correction, "CR": CR}
        assert hops_nearby(number, len(lines), **changes) == [lines] * 9
    assert predicted[1:] == [f" {0.8 * (int(hop) + 1) + 1:.1f} " for hop in counted[:-1]]
    law = list(accumulate(range(99), lambda hop, _: 0.6 * (hop + 1.5) + 1.5, initial=11.0))
    assert (f": 11, {law[1]:g}, {law[2]:.1f}, {law[3]:.1f} \u2026, and they end near {law[-1]:.0f}."
            ) in README


def test_the_orders_of_three_lines_are_those_of_the_loops() -> None:
    rows = re.findall(r"^\| (\w+, \w+, \w+) \| (\S+) \| It (.*)\. \|$", README, re.MULTILINE)
    assert {order: float(Fraction(k.replace("\u2212", "-"))) for order, k, _ in rows} == ORDERS
    assert [end[:13] for *_, end in rows] == ["hops for ever"] + 2 * ["comes to rest"]


def test_the_loops_are_those_of_the_methods_that_the_page_names() -> None:
    for parts, motion, correction in (
            (("v -= gravity",), "backward", "surface"),
            (("def bounce(", "bounce(-y"), "exact", "conserve")):
        *before, loop = map(listing, parts)
        names: dict[str, Any] = {"y": 1, "v": 0, "gravity": 10, "pull": 10, "CR": 0.5, "dt": 0.1}
        for code in before:
            exec(code, names)
        scene = Scene(a_mps2=-10, left_edge_m=0, CR=0.5, motion=motion, correction=correction)
        x_m, v_mps = 1.0, 0.0
        for _ in range(100):
            exec(loop, names)
            x_m, v_mps, _ = step(scene, x_m, v_mps, 0.1)
            assert (names["y"], names["v"]) == pytest.approx((x_m, v_mps), abs=1e-7)


def test_figures_of_films_and_chart_are_what_it_says(capsys: Capture) -> None:
    ending = film(capsys, "12", "CR=0.9", "correction=replay").ending
    assert "t = 24.99 s: the car is at rest against a wall" in ending
    assert math.sqrt(1.75) * 1.9 / 0.1 == pytest.approx(25.1, abs=0.05)
    page = " ".join(README.split())
    a, b, c, d = (errors_m("10", letter) for letter in "abcd")
    first, = re.findall("from ([0-9]+) FPS on, b is worse than a", page)
    assert [b_m > a_m for b_m, a_m in zip(b, a, strict=True)] == [
        fps >= int(first) for fps in RATES]
    assert "half the step makes the error of c four times smaller, that of a only twice" in page
    assert (c[5] / c[8])**(1 / 3) == pytest.approx(4, rel=0.2)
    assert (a[5] / a[8])**(1 / 3) == pytest.approx(2, rel=0.2)
    assert "a million million times as accurate as method a at 3840 FPS" in page
    assert round(math.log10(a[8] / d[0])) == 12  # the rest is round-off
    assert "From 5 to 240 FPS it has a G: in all ten runs the car gains energy." in page
    row, = re.findall(r"(?m)^exact \+ rebound +(.*)$", listing("X out, "))
    assert row.split()[2:8] == ["G"] * 6


def add_the_motion(folder: Path) -> None:
    """Do what the page says under "Add a motion", if it is not done."""
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
        r"^(\w+ \+ \w+) +(.*)$", out, re.MULTILINE)}
    for correction in ("none", "surface", "rebound", "conserve"):
        assert len(rows[f"mean + {correction}"]) == 9
        assert rows[f"mean + {correction}"] == rows[f"exact + {correction}"]
    assert len(rows) == 18


def test_no_command_is_broken_over_two_lines() -> None:
    for line in re.sub("^```.*?^```", "", README, flags=re.MULTILINE | re.DOTALL).splitlines():
        assert line.count("`") % 2 == 0, line


@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_line_is_one(words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("film", "chart", "stability"):
        monkeypatch.setattr(airtrack, name, lambda *_: 0)
    assert airtrack.obey(words.partition(" > ")[0].split()) == 0


def test_pip_install_brings_the_dependencies_alone() -> None:
    try:
        files = importlib.metadata.files("airtrack") or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the project is not installed")
    assert [file.name for file in files if file.suffix == ".py"] == []
