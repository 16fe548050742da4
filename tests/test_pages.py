"""The pages: commands run, snippets work as printed, figures are worked out."""

import importlib.metadata
import io
import math
import random
import re
from contextlib import redirect_stdout
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any
from unittest.mock import Mock, patch

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from test_chart_and_map import errors_m, map_rows, printed

import airtrack
from airtrack import CHART_FPS, CORRECTIONS, METHODS, MOTIONS, SPAN_S, Scene, step, truth_of
from examples import EXAMPLES, READING_S
from films import (
    HERE,
    LISTING,
    collisions,
    details,
    film,
    hops,
    states,
)

Capture = pytest.CaptureFixture[str]
README = (HERE / "README.md").read_text(encoding="utf-8")
LESSON = (HERE / ".github/lesson.md").read_text(encoding="utf-8")
EXERCISES = (HERE / ".github/exercises.md").read_text(encoding="utf-8")
PAGES = README + LESSON + EXERCISES
LISTINGS: list[str] = re.findall(r"^```\w*\n(.*?)^```$", PAGES, re.MULTILINE | re.DOTALL)
TYPESET = str.maketrans({"\u2212": "-", "\u00b7": "*", "\u2192": ">"})
PLAIN = {page: " ".join(text.translate(TYPESET).split())
         for page, text in (("README", README), ("LESSON", LESSON), ("EXERCISES", EXERCISES))}


def says(page: str, sentence: str, *values: object) -> None:
    """The page has this sentence, with these values in its braces."""
    assert sentence.format(*values) in PLAIN[page]


def listing(part: str) -> str:
    """The one listing that has the part."""
    found, = [text for text in LISTINGS if part in text]
    return found


# Commands.

COMMANDS = sorted(set(re.findall(
    r"(?:python3?|py|uv run) airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", PAGES)))


@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_runs(words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("film", "chart", "stability"):
        monkeypatch.setattr(airtrack, name, lambda *_: None)
    monkeypatch.setattr(airtrack, "COMMANDS", {name: lambda *_: None for name in airtrack.COMMANDS})
    words = re.split(r" [>|] ", words)[0]
    assert airtrack.main(words.split()) == 0


def test_no_command_is_broken_over_two_lines() -> None:
    for text in (README, LESSON, EXERCISES):
        for line in re.sub("(?ms)^```.*?^```", "", text).splitlines():
            assert line.count("`") % 2 == 0, line


def test_the_two_set_up_commands_are_complete() -> None:
    start = "\npython3 -m venv .venv && . .venv/bin/activate && python -m pip install "
    assert f"{start}. && python airtrack.py 10 d\n" in README
    assert f'{start}".[test]" && python -m pytest\n' in README


def test_every_picture_is_there_and_no_other() -> None:
    shown = set(re.findall(r"\]\(\.github/([a-z0-9-]+\.(?:png|gif))\)", README))
    assert shown == {path.name for path in (HERE / ".github").iterdir()
                     if path.suffix in (".png", ".gif")}


def test_every_link_within_a_page_has_its_heading() -> None:
    for page in (README, LESSON, EXERCISES):
        headings = {re.sub("[^a-z0-9 -]", "", line.lower()).strip().replace(" ", "-")
                    for line in re.findall(r"(?m)^#+ (.*)$", page)}
        assert set(re.findall(r"\]\(#([a-z0-9-]+)\)", page)) <= headings


# The cure, as printed.

def room(**names: Any) -> dict[str, Any]:
    """The names that the page's snippets use, with bounce()."""
    code = listing("def bounce(")
    values: dict[str, Any] = {"r": 0.1, "g": 10.0, "CR": 1.0, "dt": 1 / 60, "v": 0.0} | names
    exec(code, values)
    return values


@given(depth=st.floats(0, 10), speed=st.floats(-50, 50), gravity=st.floats(-50, 50),
       CR=st.floats(0, 1))
@example(depth=1.0, speed=2.0, gravity=3.0, CR=0.1)  # its energy does not carry it so far
def test_the_cure_is_conserve(depth: float, speed: float, gravity: float, CR: float) -> None:
    depth_m, inward_mps = CORRECTIONS["conserve"](depth, speed, gravity, CR)
    distance, away = room()["bounce"](depth, speed, gravity, CR)
    assert (-distance, -away) == pytest.approx((depth_m, inward_mps), abs=1e-12)


DOWN, UP = "if y + r > floor:\n", "if y - r < 0:\n"


def heights(part: str, seconds: float, **names: Any) -> list[tuple[float, float]]:
    """Height above the floor and speed of a snippet's ball, dropped from 1 m, by frames."""
    values = room(floor=5.0, **names)
    values["y"] = 5.0 - values["r"] - 1.0 if part == DOWN else values["r"] + 1.0
    code = compile(listing(part), "a snippet", "exec")
    found = []
    for _ in range(round(seconds / values["dt"])):
        exec(code, values)
        above = values["floor"] - values["r"] - values["y"]
        if part == UP:
            above = values["y"] - values["r"]
        found.append((above, values["v"]))
    return found


def tops(found: list[tuple[float, float]]) -> list[float]:
    above = [height for height, _ in found]
    return [b for a, b, c in zip(above, above[1:], above[2:], strict=False) if a <= b > c]


@pytest.mark.parametrize("part", [DOWN, UP])
def test_the_cure_keeps_the_energy_for_ten_minutes(part: str) -> None:
    for height, v in heights(part, 600):
        assert v**2 / 2 + 10 * height == pytest.approx(10, rel=1e-9)


@pytest.mark.parametrize("part", [DOWN, UP])
@pytest.mark.parametrize("fps", [20, 30, 60, 144])
def test_the_cure_s_first_top_is_CR_squared_of_the_height_at_any_frame_rate(
        part: str, fps: int) -> None:
    for CR in (0.5, 0.8, 0.98):
        found = heights(part, 1.5, dt=1 / fps, CR=CR)
        after = [(height, v) for (height, v), (_, before) in zip(found[1:], found, strict=False)
                 if abs(v - before) < 1.5 * 10 / fps][fps // 2:]
        for height, v in after[:3]:
            assert v**2 / 2 + 10 * height == pytest.approx(10 * CR**2, rel=1e-9)
        assert CR**2 - 10 / fps**2 / 8 - 1e-9 <= tops(found)[0] <= CR**2 + 1e-9


@pytest.mark.parametrize("CR", [0.3, 0.5, 0.8, 0.9, 0.98])
def test_the_cure_s_ball_lies_on_the_floor_by_the_zeno_point_and_a_second(CR: float) -> None:
    zeno_s = math.sqrt(2 / 10) * (1 + CR) / (1 - CR)
    for height, v in heights(DOWN, zeno_s + 3, CR=CR)[round((zeno_s + 1) * 60):]:
        assert height == 0
        assert 0 <= -v <= 10 / 60


def test_the_cure_s_ball_lies_still_a_little_too_early() -> None:
    most = []
    for CR in (0.8, 0.98):
        rng, early = random.Random(1), []
        for _ in range(200):
            g, fps, y = rng.uniform(5, 20), rng.uniform(20, 144), rng.uniform(0.5, 3)
            zeno = math.sqrt(2 * y / g) * (1 + CR) / (1 - CR) * fps
            values = room(g=g, dt=1 / fps, CR=CR, y=-y, r=0.0, floor=0.0)
            code, last = compile(listing(DOWN), "a snippet", "exec"), 0
            for frame in range(1, round(zeno) + 5):
                exec(code, values)
                if values["y"] < 0:
                    last = frame
            early.append(zeno - last)
        assert min(early) > -2  # never later than the frame after
        most.append(math.ceil(max(early)))
    says("README", "in 200 random drops (20 to 144 FPS) up to {} frames before at CR 0.8, and up "
         "to {} at CR 0.98", *most)


def test_after_the_usual_move_the_ball_gets_lower_even_with_bounce() -> None:
    usual = listing(DOWN).replace("y, v = y + v*dt + g*dt*dt/2, v + g*dt", "v += g*dt; y += v*dt")
    values = room(floor=0.0, y=-1.1)
    found = []
    for _ in range(300):
        exec(usual, values)
        found.append((-0.1 - values["y"], values["v"]))
    says("README", "dropped from 1 m (60 FPS, g = 10, CR = 1) gets back to {:.2f}, {:.2f} and "
         "{:.2f} m, even with `bounce`", *tops(found))


def calls() -> dict[str, str]:
    """The page's table of walls, as code."""
    rows = re.findall(r"(?m)^\| (\w[\w ]*) \| `(.*?)` \| `(.*?)` \|$", README)
    return {wall: f"if {condition}: {then}" for wall, condition, then in rows}


def test_side_walls_floor_and_ceiling_keep_the_energy_of_a_ball_in_a_room() -> None:
    code = calls()
    assert list(code) == ["right", "left", "ceiling", "paddle on the right"]
    values = room(x=0.5, vx=3.1, y=0.7, v=-6.0, left=0.0, right=2.0, top=0.0, floor=2.0)
    step_code = compile("x += vx*dt\n" + listing(DOWN) + "\n".join(
        code[wall] for wall in ("right", "left", "ceiling")), "a snippet", "exec")
    energy, touched = 6.0**2 / 2 + 10 * (2.0 - 0.7), 0
    for _ in range(6000):
        exec(step_code, values)
        assert abs(values["vx"]) == pytest.approx(3.1)
        assert 0.1 <= values["x"] <= 1.9
        assert 0.1 <= values["y"] <= 1.9
        assert values["v"]**2 / 2 + 10 * (2.0 - values["y"]) == pytest.approx(energy, rel=1e-9)
        touched += values["y"] < 0.15
    assert touched > 100  # the ceiling is met, too


@given(u=st.floats(-3, 3), CR=st.floats(0, 1), x=st.floats(0, 0.8), vx=st.floats(3.5, 20))
def test_a_moving_paddle_leaves_the_ball_where_it_truly_is(
        u: float, CR: float, x: float, vx: float) -> None:
    meets_s = (0.9 - x) / (vx - u)
    rest_s = 0.1
    values = room(x=x, vx=vx, u=u, CR=CR, dt=meets_s + rest_s, paddle=1.0)
    exec("x += vx*dt; paddle += u*dt\n" + calls()["paddle on the right"], values)
    true_v = u - CR * (vx - u)
    true_x = 0.9 + u * meets_s + true_v * rest_s
    assert (values["x"], values["vx"]) == pytest.approx((true_x, true_v), abs=1e-9)


def test_a_thin_platform_or_wall_stops_every_bullet_and_carries_a_ball() -> None:
    snippet, rng = listing("old <= face < y"), random.Random(2)
    says("README", "write x, vx, X and 0 in place of y, v, Y and g")
    wall = re.sub(r"\bg\b", "0", re.sub(r"\by\b", "x", snippet)).replace("Y", "X")
    wall = re.sub(r"\bv\b", "vx", wall)
    platform, side = compile(snippet, "a snippet", "exec"), compile(wall, "a snippet", "exec")
    for name, place, code in (("y", "Y", platform), ("x", "X", side)):
        for _ in range(200):
            speed = rng.uniform(5, 500)
            values = room(v=speed, vx=speed, r=rng.uniform(0.01, 0.3),
                          **{name: 0.0, place: rng.uniform(1, 3)})
            for _ in range(60):
                exec(code, values)
                assert values[name] <= values["face"]
            assert name == "y" or values["vx"] < 0
    for _ in range(200):
        values = room(y=0.0, Y=rng.uniform(1, 3), r=rng.uniform(0.01, 0.3), CR=rng.uniform(0, 0.9))
        for _ in range(1500):
            exec(platform, values)
            assert values["y"] <= values["face"]
        assert values["y"] == values["face"]


def test_a_ball_that_is_put_on_the_wall_does_not_stick() -> None:
    code, = re.findall(r"`(if x - r < left: x, vx .*?)`", README)
    for CR in (0.1, 0.5, 0.9):
        for number in range(20):
            values = room(x=0.5, vx=-1.0 - number / 7, left=0.0, CR=CR)
            speed = values["vx"]
            for _ in range(60):
                exec("x += vx*dt\n" + code, values)
            assert values["vx"] == pytest.approx(-CR * speed)


def test_a_fixed_step_gives_the_same_number_of_steps_at_any_frame_rate() -> None:
    code = compile(listing("waiting += "), "a snippet", "exec")
    for fps in (24, 60, 144):
        names: dict[str, Any] = {"waiting": 0.0, "dt": 1 / 100, "step": Mock(), "y": 0.0}
        for _ in range(10 * fps):
            exec(code, names | {"frame_time": 1 / fps}, names)
        assert names["step"].call_count == pytest.approx(1000, abs=1)
    names = {"waiting": 0.0, "dt": 1 / 100, "step": Mock(), "y": 0.0}
    exec(code, names | {"frame_time": 60.0}, names)
    assert names["step"].call_count in (24, 25)  # the cap
    cap, = re.findall(r"min\(frame_time, (.*?)\)", README)
    says("README", "The cap of {} s keeps", cap)
    says("README", "multiply v by {} and g by {}", 60, 60**2)


# The order of three lines, and a threshold.

def game(order: str, seconds: float, CR: float, fps: float = 60, y: float = 1.0, v: float = 0.0,
         slowest: float = 0.0, g: float = 10.0) -> list[tuple[float, float | None]]:
    """A ball above a floor: its height, and its speed where it met the floor, frame by frame.

    slowest is a threshold: a bounce that comes in slower leaves v = 0.
    """
    gravity, position, contact = listing("# gravity").splitlines()
    code = {"g": gravity, "p": position, "c": contact}
    lines = compile("\n".join(code[letter] for letter in order), "a snippet", "exec")
    values: dict[str, Any] = {"y": -y, "v": v, "g": g, "CR": CR, "dt": 1 / fps}
    values |= {"r": 0.0, "floor": 0.0}
    found: list[tuple[float, float | None]] = []
    for _ in range(round(seconds * fps)):
        before = values["v"]
        exec(lines, values)
        met = None
        if values["y"] == 0 and (values["v"] < 0 or before > 0):
            met = -values["v"] / CR
            if met < slowest:
                values["v"] = 0.0
        found.append((-values["y"], met))
    return found


@pytest.mark.parametrize("order", ["gpc", "pcg", "cgp"])
def test_whichever_line_begins_the_good_order_comes_to_rest(order: str) -> None:
    for CR in (0.5, 0.8, 0.9):
        assert max(abs(y) for y, _ in game(order, 60, CR)[-100:]) <= 10 / 60**2


@pytest.mark.parametrize("order", ["pgc", "gcp", "cpg"])
def test_whichever_line_begins_the_other_order_hops_for_ever(order: str) -> None:
    rng = random.Random(1)
    for CR, lowest_mm, highest_mm in ((0.8, 62, 91), (0.3, 1.5, 2.5), (0.1, 0.4, 0.6)):
        for _ in range(50):
            found = game(order, 60, CR, y=rng.uniform(0.3, 3), v=rng.uniform(-2, 2))[-100:]
            assert lowest_mm < 1000 * max(y for y, _ in found) < highest_mm
    says("README", "at g = 10 and 60 FPS {} to {} mm high for CR 0.8, and {} mm high for CR 0.3",
         62, 91, 2)
    grows = tops([(y, 0.0) for y, _ in game(order, 10, 1.0)])
    assert sorted(grows) == grows


def test_at_CR_1_the_good_order_gets_lower_but_some_balls_repeat_their_hop() -> None:
    falls = tops([(y, 0.0) for y, _ in game("gpc", 20, 1.0, y=0.97, v=0.3)])
    assert falls[0] > falls[-1] + 0.3
    last = game("gpc", 200, 1.0, y=0.97, v=0.3)[-100:]
    assert max(y for y, _ in last) < 1e-9
    for part in range(1, 121):  # in rational numbers: a ball leaves the floor at part/12 of g dt
        dt, y, v = Fraction(1, 60), Fraction(0), Fraction(5) + Fraction(part, 12) * 10 / 60
        found, since = [], 0
        for _ in range(600):
            v -= 10 * dt
            y += v * dt
            since += 1
            if y < 0:
                y, v = Fraction(0), -v
                found.append(since)
                since = 0
        repeats = part % 6 == 0  # twice the speed is a whole multiple of g dt
        assert (len(set(found)) == 1) is repeats
        assert found == sorted(found, reverse=True)


def test_a_ball_that_lies_still_has_the_velocity_that_is_told() -> None:
    says("README", "after each contact it is -CR g dt/(1 + CR)")
    gravity, position, contact = listing("# gravity").splitlines()
    lines = compile("\n".join([gravity, position, contact]), "a snippet", "exec")
    for CR in (0.3, 0.5, 0.8, 0.9):
        values = room(y=-1.0, r=0.0, floor=0.0, CR=CR)
        for _ in range(60 * 60):
            exec(lines, values)
        assert values["v"] == pytest.approx(-CR * 10 / 60 / (1 + CR))


@pytest.mark.parametrize("CR", [0.5, 0.8, 0.9])
def test_a_threshold_of_2_g_dt_over_1_minus_CR_is_enough_and_most_of_it_is_needed(
        CR: float) -> None:
    rng, still_moving = random.Random(3), {1.0: 0, 2.0: 0}
    for _ in range(100):
        g, fps = rng.uniform(5, 20), rng.uniform(30, 144)
        y, v = rng.uniform(0.3, 1), rng.uniform(0, 1)
        for part in still_moving:
            slowest = part * g / fps / (1 - CR)
            found = game("pgc", 30, CR, fps, y, v, slowest, g)
            still_moving[part] += max(height for height, _ in found[-60:]) > 1e-6
    assert still_moving[2.0] == 0
    assert still_moving[1.0] > 50
    says("README", "at 60 FPS, g = 9.81 and CR = 0.95 it is {:.1f} m/s", 2 * 9.81 / 60 / 0.05)
    says("README", "so a ball that is dropped from {} m never bounces", 1)
    assert math.sqrt(2 * 9.81 * 1) < 2 * 9.81 / 60 / 0.05  # it comes in slower


# The methods, how good they are, and the law.

def test_the_drawn_collision_is_that_of_the_listing_and_replay_is_as_rewind() -> None:
    code = LISTING.splitlines()
    rows = listing("rewind     0 ").splitlines()[1:]
    for row in rows:
        line, = [line[6:] for line in code if line[6:42].rstrip() == row[:36].rstrip()]
        assert line.split() == row.split()
    scene = Scene(x_m=0.32, a_mps2=-20, left_edge_m=0.2, motion="exact", correction="replay")
    x_m, v_mps, _ = step(scene, 0.32, -1, 0.1)
    says("README", "is {:.0f} m/s\u00b2 into the wall, dt is 0.1 s, CR is {}, and a column is 1 cm",
         -scene.a_mps2, scene.CR)
    says("README", "keeps {} of the speed, so {:.2f} of the energy: {} of {} J/kg", scene.CR,
         scene.CR**2, rows[-1].split()[-1], rows[0].split()[-1])
    found = 0.2 - x_m, -v_mps, v_mps**2 / 2 + 20 * (x_m - 0.2)
    assert [float(text) for text in rows[-1].split()[-3:]] == pytest.approx(found, abs=0.005)


def test_the_table_of_methods_is_that_of_the_listing() -> None:
    rows = re.findall(r"(?m)^\| ([a-e]) (\w+) \+ (\w+) \| (\w+) \| (.*?) \| .*? \| .*? \|$",
                      README)
    assert {letter: (motion, correction) for letter, motion, correction, *_ in rows} == METHODS
    for letter, motion, correction, order, energy in rows:
        assert re.search(rf"#     {letter}  {motion} \+ {correction} +{order} +{energy} ", LISTING)


def test_what_the_chart_shows() -> None:
    a, b, c, d = (errors_m("10", letter) for letter in "abcd")
    says("README", "From {} FPS on, b is worse than a", 30)
    assert [b_m > a_m for b_m, a_m in zip(b, a, strict=True)] == [fps >= 30 for fps in CHART_FPS]
    assert (a[5] / a[8])**(1 / 3) == pytest.approx(2, rel=0.2)
    assert (c[5] / c[8])**(1 / 3) == pytest.approx(4, rel=0.2)
    assert max(d) < 1e-10
    says("README", "Each line goes from {} FPS, at its top, to {} FPS", CHART_FPS[0], CHART_FPS[-1])
    says("README", "five methods, from {} to {} frames a second", CHART_FPS[0], CHART_FPS[-1])
    says("README", "looked at every 0.1 s for {} s, in ten runs", SPAN_S)
    d = errors_m("12", "d")
    says("README", "Then d errs, too: {:.1f} mm at 10 FPS and {:.2f} mm at 60 FPS in example 12",
         1000 * d[0], 1000 * d[CHART_FPS.index(60)])


def test_four_rows_of_the_map() -> None:
    rows = map_rows(20)
    told = listing("1000 FPS").splitlines()
    assert told[0].strip() in printed("stability", "20")
    assert len(told) == 5
    for row in told[1:]:
        (name, letters), = re.findall(r"(\w+ \+ \w+) +(.*)", row)
        assert letters.split() == rows[name]
    own = [name for name in rows if name.split()[0] not in ("forward", "backward", "exact")]
    says("README", "over a column ({:.1f} cm) off", 100 / Scene().m_to_px)
    says("README", "so there are 3 * 4 + 2 = {} methods", len(rows) - len(own))
    says("README", "`python airtrack.py stability 20` prints a map of all {}, at CR = {}",
         len(rows) - len(own), EXAMPLES[20].settings["CR"])


def test_the_bounds_of_k_are_those_of_the_listing() -> None:
    for formula in ("w - u = k g dt.", "w + u = hop * g dt.", "2 w = (hop + k) g dt,",
                    "2 CR w = (next - k\u2032) g dt.", "**next = CR (hop + k) + k\u2032**"):
        says("README", formula)  # the listing's, which are tested in every hop
    for motion in ("forward", "exact", "backward"):
        surface, rebound = re.findall(rf"(?m)^\| {motion} \| (.*?) \| (.*?) \|$",
                                      README.replace("\u2212", "-"))[0]
        assert re.search(rf"#     {motion} +{surface} +{rebound}\n", LISTING)


def test_where_hops_end_from_random_starts() -> None:
    says("README", "If k is above 0, the ball gets too much energy.")
    says("README", "they have k (1 + CR)/(1 - CR) frames: at CR 0.8 that is {:.0f} k. If k is "
         "below 0, it gets too little", 1.8 / 0.2)
    says("README", "{} random starts at CR 0.8 (up to {} m/s, from {} to {} m, g {}, {} FPS) ended",
         300, 1, 0.5, 2, 10, 60)
    for name, motion, correction in (
            ("{} to {} frames with forward + surface", "forward", "surface"),
            ("{} to {} with forward + rebound", "forward", "rebound"),
            ("{} to {} with exact + surface", "exact", "surface"),
            ("{} to {} with exact + rebound", "exact", "rebound")):
        rng, ends = random.Random(7), set()
        for _ in range(300):
            scene = Scene(x_m=rng.uniform(0.5, 2), v_mps=rng.uniform(-1, 1), a_mps2=-10,
                          left_edge_m=0, right_edge_m=1000, fps_target=60, motion=motion,
                          correction=correction)
            ends.update(hops(scene, 120)[-12:])
        told = re.search(re.escape(name).replace(r"\{\}", r"(\d+)"), PLAIN["README"])
        assert told is not None
        assert (min(ends), max(ends)) == (int(told[1]), int(told[2])), name


# The lesson.

def energy(number: int, x_m: float, v_mps: float) -> float:
    return Scene(**EXAMPLES[number].settings).energy(x_m, v_mps)


def test_the_table_of_three_steps() -> None:
    rows = re.findall(r"\| [^|]*\| (\S+) cm \| (\S+) cm \| (\S+) cm \|", PLAIN["LESSON"])
    names = ["forward", "backward", "exact", "exact"]
    assert len(rows) == len(names)
    for row, name in zip(rows, names, strict=True):
        x_m, v_mps, places = 0.0, 0.0, []
        for _ in range(3):
            x_m, v_mps = MOTIONS[name](x_m, v_mps, -2.0, 0.1)
            places.append(100 * x_m)
        assert [float(text) for text in row] == pytest.approx(places, abs=1e-9)
    for row, sign, told in ((rows[0], 1, "Old velocity: {}, {}, {} cm too far to the right"),
                            (rows[1], -1, "New velocity: {}, {}, {} cm too far to the left")):
        off_cm = [sign * (int(a) - int(b)) for a, b in zip(row, rows[3], strict=True)]
        says("LESSON", told, *off_cm)
    says("LESSON", "a is -{} m/s\u00b2, dt is {} s, and the car starts at rest", 2, 0.1)
    says("LESSON", "After the first step its velocity is {:.0f} cm/s. In the second step the old "
         "velocity moves it by {:.0f} cm/s * {} s = {:.0f} cm", -20, -200 * 0.1, 0.1, -20 * 0.1)
    says("LESSON", "(The velocity is {:.0f} and {:.0f} cm/s after", -200 * 0.2, -200 * 0.3)
    assert rows[3] == tuple(f"{-100 * (n / 10) ** 2:.0f}" for n in (1, 2, 3))


def test_the_ways_back_of_example_1_and_the_energy_that_its_bounces_give() -> None:
    def ways_and_gifts(**changes: object) -> tuple[list[float], list[float], list[float]]:
        found, tops_m, gifts, depths_m = states(1, 251, **changes), [1.75], [], []
        scene = Scene(**EXAMPLES[1].settings)
        xs = [x_m for x_m, *_ in found]
        tops_m += [b - 0.25 for a, b, c in zip(xs, xs[1:], xs[2:], strict=False) if a < b >= c]
        before = scene.v_mps
        for x_m, v_mps, mark_m in found:
            if mark_m is not None:
                meets = scene.energy(mark_m, before - 1.5 / 30)
                gifts.append(scene.energy(x_m, v_mps) - 0.49 * meets)
                depths_m.append(0.25 - mark_m)
            before = v_mps
        return [b / a for a, b in pairwise(tops_m)][:3], gifts[:3], depths_m[:3]

    ways, gifts, depths_m = ways_and_gifts()
    says("LESSON", "The ways back are {:.2f}, {:.2f} and {:.2f} of the way before", *ways)
    assert [round(gift, 2) for gift in gifts] == [0.09, 0.09, 0.01]
    says("LESSON", "found {:.0f} cm deep in the wall and give {:.2f} J/kg too much",
         100 * depths_m[1], gifts[0])
    says("LESSON", "is found {:.1f} cm deep and gives {:.2f} J/kg", 100 * depths_m[2], gifts[2])
    scene = Scene(**EXAMPLES[1].settings)
    says("LESSON", "s = x - {} m, at the start {} m", scene.left_edge_m,
         scene.x_m - scene.left_edge_m)
    says("LESSON", "the car keeps {0:.0f} % of its speed. What", 100 * scene.CR)
    says("LESSON", "many say {:.0f} %. That is the speed.", 100 * scene.CR)
    says("LESSON", "so 0.7\u00b2 = {:.2f} of it is left", scene.CR**2)
    says("LESSON", "of the way before, and not {:.2f}.", scene.CR**2)
    says("LESSON", "If somebody measures {:.2f}: well seen", ways[1])
    says("LESSON", "With an exact method it is {:.2f} each time", scene.CR**2)
    says("LESSON", "each step takes {:.5f} J/kg", 1.5**2 / 30**2 / 2)
    ways, *_ = ways_and_gifts(motion="exact", correction="rewind")
    assert ways == pytest.approx([0.49] * 3, abs=0.005)
    for a, degrees in ((1.5, 9), (2, 12)):
        says("LESSON", "about {:.0f}\u00b0 for a = -{:g} m/s", degrees, a)
        assert math.degrees(math.asin(a / 9.81)) == pytest.approx(degrees, abs=0.5)


def test_the_figures_of_example_13() -> None:
    found = states(13, 20)
    truth = truth_of(Scene(**EXAMPLES[13].settings))
    true_xs = [step(truth, truth.x_m, truth.v_mps, n / 10)[0] for n in range(1, 21)]
    xs = [x_m for x_m, *_ in found]
    says("LESSON", "The `*` got to {:.2f} m, and the `o` only to {:.2f} m. Both turned near line "
         "12 or 13", max(xs), max(true_xs))
    assert (xs.index(max(xs)), true_xs.index(max(true_xs))) == (13 - 1, 12 - 1)
    says("LESSON", "In line 15 both go back, and the `*` is {:.0f} cm further to the right",
         100 * (xs[14] - true_xs[14]))
    says("LESSON", "in line 15 the `*` is {:.0f} cm higher on", 100 * (xs[14] - true_xs[14]))
    assert xs[14] < xs[13]
    assert true_xs[14] < true_xs[13]
    says("LESSON", "Both leave the left wall uphill, at {} m/s", EXAMPLES[13].settings["v_mps"])
    says("LESSON", "Each cm is worth 2 m/s\u00b2 * 0.01 m = {:.2f} J/kg.", 2 * 0.01)
    says("LESSON", "15 cm are worth 15 * 0.02 = {:.2f} J/kg", 15 * 0.02)
    says("LESSON", "the energy grew from {:.3f} to {:.3f} J/kg", energy(13, 0.25, 2.48),
         energy(13, *found[14][:2]))


def test_the_energies_of_example_8() -> None:
    found, before, bounces = states(8, 60), 0.0, []
    for x_m, v_mps, mark_m in found:
        if mark_m is not None:
            bounces.append((energy(8, mark_m, before - 0.2), energy(8, x_m, v_mps), 0.25 - mark_m))
        before = v_mps
    (low, high, depth_m), (low_2, high_2, depth_2_m) = bounces
    says("LESSON", "| start | {:.2f} J/kg |", energy(8, 2.0, 0.0))
    says("LESSON", "{:.2f} > {:.2f} J/kg | 13 steps have taken 13 * 0.02 = {:.2f}. The bounce "
         "gives 2 * 2 * {:.2f} = {:.2f}.", low, high, 13 * 0.02, depth_m, high - low)
    says("LESSON", "{:.2f} > {:.2f} J/kg | 13 steps have taken {:.2f}. The bounce gives "
         "2 * 2 * {:.2f} = {:.2f}.", low_2, high_2, 13 * 0.02, depth_2_m, high_2 - low_2)
    turns_m = [max(x_m for x_m, *_ in found[a:b]) for a, b in ((14, 38), (40, 60))]
    says("LESSON", "(The exact figure is {:.0f} cm.)", 100 * (2 - turns_m[0]))
    assert turns_m[1] == pytest.approx(2)
    taken = 13 * 2 * 0.01
    says("LESSON", "| first return | {:.2f} J/kg | 13 steps have taken {:.2f}. |", high - taken,
         taken)
    says("LESSON", "| second return | {:.2f} J/kg | 13 steps have taken {:.2f}. |", high_2 - taken,
         taken)
    says("LESSON", "Each step takes 1 cm, so {:.2f} J/kg. A bounce gives |a| times the lift, so "
         "{:.0f} m/s\u00b2 * (2 * {:.2f} m)", 2 * 0.01, 2, depth_m)
    says("LESSON", "a car {0:.0f} cm beyond it, and an arrow to {0:.0f} cm in front", 100 * depth_m)
    says("LESSON", "loses 1 cm, downhill and uphill, so {0} steps always lose {0} cm.", 26)
    says("LESSON", "The first bounce gains {:.0f} cm, too little, and the second {:.0f} cm, too "
         "much", 200 * depth_m, 200 * depth_2_m)
    says("LESSON", "Together {:.0f} cm are lost, and {:.0f} cm are gained", 26 + 26,
         200 * (depth_m + depth_2_m))
    four_returns_s = 4 * 26 / 10
    says("LESSON", "come back four times, for {} s", math.ceil(four_returns_s))
    says("LESSON", "the first. {0} + {1} = {2}: it", -12, 12, -12 + 12)
    assert low_2 == pytest.approx(high - 26 * 0.02)
    energies = [energy(8, x_m, v_mps) for x_m, v_mps, _ in found]
    says("LESSON", "says least {:.2f} and most {:.2f}", min(energies), max(energies))


def test_the_figures_of_example_10() -> None:
    fall_s = math.sqrt(1.75)
    says("LESSON", "so t = \u221a1.75 s = {:.3f} s", fall_s)
    says("LESSON", "the bounce was {:.3f} s after line 13", fall_s - 1.3)
    says("LESSON", "on for the other {:.3f} s", 1.4 - fall_s)
    says("LESSON", "as before: {} s. But now", 1 / EXAMPLES[10].settings["fps_target"])
    says("LESSON", "compute: {} m = \u00bd * {:.0f} m/s\u00b2 * t\u00b2, so", 2 - 0.25, 2)
    says("LESSON", "Line {0} is at {1} s, and line {2} at {3} s.", 13, 13 / 10, 14, 14 / 10)
    says("LESSON", "The table says {} J/kg, first to last", energy(10, 2, 0))
    says("LESSON", "fourteen times. Line {} has the `0`", 14)
    found = states(10, 14)
    says("LESSON", "from {:.2f} m to the `0` at {:.2f} m, through the wall at {} m", found[12][0],
         found[13][2], Scene().left_edge_m)
    assert collisions(found) == [14]
    says("LESSON", "may be up to {:.2f} cm short of it", 100 * 2 * 0.05**2 / 2)


def test_the_answer_to_example_3() -> None:
    (_, v_mps, _), (_, after_mps, mark_m), (next_m, *_) = states(3, 47)[44:]
    assert mark_m is not None
    says("LESSON", "In frame {} it is {:.1f} cm beyond the wall, at {:.2f} m/s. It keeps 60 % of "
         "this: {:.2f} m/s. In the next frame the acceleration slows it to {:.2f} m/s, so it moves "
         "back only 1.33/30 m = {:.1f} cm", 46, 100 * (0.25 - mark_m), 1.5 / 30 - v_mps, after_mps,
         after_mps - 1.5 / 30, 100 * (next_m - mark_m))
    late = states(3, 600)
    says("LESSON", "in the end by {:.0f} mm a frame", 1000 * (late[-2][0] - late[-1][0]))


def test_a_film_begins_after_the_seconds_that_the_lesson_tells() -> None:
    for told in ("A film begins by itself after {} s.", "and after {} s a `*` that moves"):
        says("LESSON", told, round(READING_S))


def test_the_worksheet_is_the_film_fits_on_A4_and_tells_no_answer(capsys: Capture) -> None:
    sheet = (HERE / ".github/worksheet.txt").read_text(encoding="utf-8")
    picture, tasks = sheet.split("\n\nTasks\n")
    lines = picture.splitlines()
    says("LESSON", "The film has {} lines of at most {} columns", len(lines), max(map(len, lines)))
    assert len(lines) * 12 + 2 * 72 <= 842  # points: 10-point lines and margins on A4
    assert max(map(len, sheet.splitlines())) * 6 + 2 * 72 <= 595
    scale = lines[-54]
    for metres in ("0.5", "1.0", "1.5", "2.0"):
        assert scale.find(metres) + 1 == round(30 * float(metres))
    shown = film(capsys, "8", "--frames", "53", "m_to_px=30", "width_px=67").lines
    for number, (line, wanted) in enumerate(zip(lines[-53:], shown, strict=True), 1):
        assert set(line[:67].strip()) <= set("|.*0 ")
        for mark in "*0|":
            assert line[:67].find(mark) == wanted.find(mark)
        if number % 5 == 0 or number == 1:
            assert line.endswith(f"{number / 10:.1f}")
    for told in ("1.88", "Stopped", "press"):
        assert told not in sheet
    bounces = [number for number, line in enumerate(lines[-53:], 1) if "0" in line[:8]]
    says("LESSON", "in the lines {} and {}, at {} and {} s", *bounces, *[n / 10 for n in bounces])
    at_1_s, first_turn = lines[5 + 9], min(lines[5 + 24:5 + 28], key=lambda line: -line.find("*"))
    says("LESSON", "The `*` is {} columns to the left", 30 - at_1_s.find("*"))
    columns = 60 - first_turn.find("*")
    says("LESSON", "First it turns {} columns before the dots, about {:.0f} cm", columns,
         100 * columns / 30)
    assert "x = 2 - t^2 (x in m, t in s). Where is it at t = 1.0 s?" in tasks
    says("LESSON", "The true car is at {:.2f} m.", 2 - 1.0**2)
    assert f"A column is {100 / 30:.1f} cm" in tasks
    for depth_cm in (7, 19):  # tested as the depths of example 8
        assert f" {depth_cm} cm beyond" in tasks
        says("LESSON", "{0} + {0} = {1} cm", depth_cm, 2 * depth_cm)
        says("LESSON", "{} - 26 = {:+}: the ", 2 * depth_cm, 2 * depth_cm - 26)


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
    says("EXERCISES", "The engine in {} lines", code.count("\n"))
    lines = filmed(code, 600)
    assert [line[:126] for line in lines] == [
        line[:126] for line in film(capsys, "--frames", "600").lines]
    new, = re.findall(r"first line in `move` by `(v_mps .*)`", EXERCISES)
    says("EXERCISES", "the car towards {} m", re.findall(r"x_m - (\d+)", new)[0])
    lines = filmed(code.replace(old, f"    {new}\n"), 6000)
    for last in (lines[3000:4000], lines[5000:]):
        xs = [details(line)[0] for line in last]
        assert (min(xs), max(xs)) == (0.5, 17.5)


def test_the_page_s_motion_is_exact() -> None:
    names: dict[str, Any] = {"State": tuple}
    exec(listing("def mean("), names)
    for state in ((1.0, 2.0, -3.0, 0.1), (0.3, -4.0, 9.81, 1.5)):
        assert names["mean"](*state) == pytest.approx(MOTIONS["exact"](*state))


def test_the_script_s_order_is_that_of_its_table_and_its_parts() -> None:
    order = re.findall(r"\d+", re.findall(r"its own order: ([\d, ]+)\.", PLAIN["LESSON"])[0])
    rows = re.findall(r"(?m)^\| (\d+) to (\d+) \| `python airtrack\.py (\d+)` \|", LESSON)
    parts = re.findall(r"(?m)^### Example (\d+): .* \((\d+) minutes\)$", LESSON)
    begins = 0
    for (first, last, number), (of_part, minutes), in_order in zip(rows, parts, order, strict=True):
        assert number == of_part == in_order
        assert (int(first), int(last)) == (begins, begins + int(minutes))
        begins = int(last)
    says("LESSON", "## The script: {} minutes", begins)


def test_the_board_sketch_is_the_track_of_the_examples() -> None:
    sketch = listing("right wall, ")
    for number in (1, 8, 10):
        scene = Scene(**EXAMPLES[number].settings)
        for text in (f"right wall, {scene.right_edge_m} m", f"car, starts at {scene.x_m:g} m",
                     f" {scene.left_edge_m} m "):
            assert text in sketch


def test_the_exercises(capsys: Capture) -> None:
    zeno_s = math.sqrt(1.75) * 1.9 / 0.1
    says("EXERCISES", "T (1 + CR)/(1 - CR) = {:.1f} s", zeno_s)
    says("EXERCISES", "When does it come to rest if CR is {}?", 0.9)
    ending = film(capsys, "12", "CR=0.9", "correction=replay").ending
    rest_s, = re.findall(r"t = (.*) s: the car is at rest", ending)
    assert zeno_s <= float(rest_s) <= zeno_s + 0.125
    says("EXERCISES", "more than 0.6 * (11 + 1) + 1 = {:.1f} and at most 0.6 * (11 + 2) + 2 = "
         "{:.1f}", 0.6 * 12 + 1, 0.6 * 13 + 2)
    says("EXERCISES", "so 9. After 9 come more than {:.0f} and at most {:.1f}: so 8", 0.6 * 10 + 1,
         0.6 * 11 + 2)
    says("EXERCISES", "k (1 + CR)/(1 - CR) = {:.0f} k lines: more than 4, at most 8", 1.6 / 0.4)
    told, = re.findall(r"The film has ([0-9 ]+) \u2026", PLAIN["EXERCISES"])
    lines = [int(word) for word in told.split()]
    scene = Scene(**EXAMPLES[20].settings | {
        "motion": "forward", "correction": "surface", "CR": 0.6})
    assert hops(scene, len(lines)) == lines


def test_a_real_ball() -> None:
    says("EXERCISES", "CR = {} whose first hop takes {} s bounces infinitely", 0.9, 0.63)
    says("EXERCISES", "within 0.63/(1 - 0.9) s = {:.1f} s", 0.63 / (1 - 0.9))
    rests, hops_on = map(float, re.findall(r"fter one of (\S+) s it is", PLAIN["EXERCISES"]))
    scene = Scene(x_m=0.25, v_mps=9.81 * 0.63 / 2, a_mps2=-9.81, CR=0.9, motion="exact",
                  correction="replay", right_edge_m=9)
    assert step(scene, scene.x_m, scene.v_mps, rests)[1] == 0
    assert step(scene, scene.x_m, scene.v_mps, hops_on)[1] != 0


def add_the_motion(folder: Path) -> None:
    """Do what the page says in its first exercise."""
    text = LISTING
    for old, new in (("MOTIONS = {", listing("def mean(") + "\nMOTIONS = {"),
                     ('"exact": exact}', '"exact": exact, "mean": mean}')):
        assert text.count(old) == 1
        text = text.replace(old, new)
    (folder / "airtrack.py").write_text(text, encoding="utf-8")


def test_what_differs_from_the_lesson_that_it_follows_names_its_examples() -> None:
    told, = re.findall(r"irregular frames in examples (.*?) repeat in each run", PLAIN["EXERCISES"])
    irregular = [number for number, each in EXAMPLES.items() if each.settings.get("jitter")]
    assert [int(number) for number in re.findall(r"\d+", told)] == irregular


def test_pip_install_brings_the_dependencies_alone() -> None:
    try:
        files = importlib.metadata.files("airtrack") or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the project is not installed")
    assert [file.name for file in files if file.suffix == ".py"] == []
