"""The pages: their commands are taken, their blocks of code work as printed, and their figures of
films, chart and map are those of the program."""

import random
import re
from math import sqrt
from types import CodeType
from typing import Any

import pytest

import airtrack
from airtrack import Scene, main, simulate, step, verdict
from examples import EXAMPLES
from films import HERE, bounces, compared, filmed, hops, shown, tops_m

PAGES = {path.name: path.read_text(encoding="utf-8") for path in
         (HERE / "README.md", HERE / ".github/lesson.md", HERE / ".github/exercises.md")}
README, LESSON, EXERCISES = PAGES.values()
COMMANDS = sorted(set(re.findall(
    r"(?:python3?|py|uv run) airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", "".join(PAGES.values())))
    - {"-h"})

def block(page: str, part: str) -> str:
    """The one block of code on a page that has this part."""
    blocks: list[str] = re.findall(r"(?ms)^```\w*\n(.*?)^```$", page)
    found, = [code for code in blocks if part in code]
    return found

# Commands, links and pictures.

@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_is_taken(words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(airtrack, "film", lambda *_: None)
    monkeypatch.setattr(airtrack, "COMMANDS", dict.fromkeys(airtrack.COMMANDS, lambda *_: None))
    assert main(words.split()) == 0

@pytest.mark.parametrize("page", PAGES)
def test_no_command_is_broken_over_two_lines(page: str) -> None:
    for line in re.sub("(?ms)^```.*?^```", "", PAGES[page]).splitlines():
        assert line.count("`") % 2 == 0, line

# The cure, as printed.

CURE = block(README, "from math import sqrt").replace("dt = clock.tick(60)/1000\n", "")
PADDLE = block(README, "u = (paddle")
LIFTS = block(README, "u = (Y - old_Y)")
FIXED = CURE[CURE.index("for Y, x1"):CURE.index("if y > floor")]
IN_GAME = CURE.replace(FIXED, LIFTS).replace("if x > right", PADDLE + "if x > right")
CODE = compile(CURE, "README.md", "exec")

def ball(**names: Any) -> dict[str, Any]:
    """What the cure works with, in metres: a ball far from all walls, but for the names."""
    return {"r": 0.1, "g": 10.0, "CR": 1.0, "dt": 1 / 60, "x": 1.0, "vx": 0.0, "y": 0.0, "v": 0.0,
            "left": -1e3, "right": 1e3, "ceiling": -1e3, "floor": 1e3, "platforms": []} | names

def heights_m(code: CodeType, frames: int, **names: Any) -> list[float]:
    """How high a ball is above the floor, frame by frame, after a drop from 1 m."""
    game = ball(floor=5.0, y=3.9, **names)
    found = []
    for _ in range(frames):
        exec(code, game)
        found.append(4.9 - game["y"])
    return found

def energy(game: dict[str, Any]) -> float:
    """In J/kg, above the floor."""
    return float(game["v"]**2 / 2 + game["g"] * (game["floor"] - game["r"] - game["y"]))

@pytest.mark.parametrize("fps", [20, 30, 60, 144, None])
def test_the_cure_keeps_a_ball_s_energy_in_a_box_for_ten_minutes(fps: int | None) -> None:
    rng = random.Random(1)
    game = ball(left=0.0, right=6.0, ceiling=2.0, floor=5.0, x=2.0, vx=2.3, y=3.0, v=-7.0)
    first, past_s = energy(game), 0.0
    while past_s < 600:
        if fps is None:
            game["dt"] = rng.uniform(1 / 144, 1 / 20)  # irregular frames
        else:
            game["dt"] = 1 / fps
        exec(CODE, game)
        past_s += game["dt"]
        assert energy(game) == pytest.approx(first, rel=1e-9)
        assert abs(game["vx"]) == 2.3
        assert 0.1 <= game["x"] <= 5.9
        assert 2.1 <= game["y"] <= 4.9

def test_a_contact_in_the_other_order_does_not() -> None:
    v_line, y_line = re.findall(r"    (?:v = -CR.*floor\)\)\)|y = floor - r)\n", CURE)
    other = compile(CURE.replace(v_line + y_line, y_line + v_line), "README.md", "exec")
    assert tops_m(heights_m(other, 200))[1] > 1.05

def test_the_two_lines_of_the_first_screen_are_the_cure() -> None:
    text = "from math import sqrt\n" + block(README, "; v += g*dt")
    two_lines = compile(text, "README.md", "exec")
    for CR in (0.5, 1.0):
        assert heights_m(two_lines, 300, CR=CR) == heights_m(CODE, 300, CR=CR)

def test_y_may_grow_upwards() -> None:
    turn = "y = -y\nv = -v\n"
    upwards = compile(turn + CURE + turn, "README.md", "exec")
    game = ball(floor=-2.0, y=3.1)  # the floor is at 2, with a minus
    found = []
    for _ in range(300):
        exec(upwards, game)
        found.append(game["y"] - 2.1)
    assert found == pytest.approx(heights_m(CODE, 300))

@pytest.mark.parametrize("CR", [0.0, 0.3, 0.8, 0.98])
def test_no_ball_falls_through_a_platform_and_all_come_to_lie_still(CR: float) -> None:
    rng = random.Random(2)
    for _ in range(20):
        game = ball(CR=CR, r=rng.uniform(0.01, 0.3), v=rng.uniform(-5, 5), vx=rng.uniform(-3, 3),
                    left=0.0, right=6.0, x=3.0, floor=9.0,
                    platforms=[(rng.uniform(1, 3), 0.0, 6.0), (4.0, 0.0, 6.0)])
        face = game["platforms"][0][0] - game["r"]
        bullet = game | {"v": rng.uniform(20, 500)}
        for _ in range(6000):
            exec(CODE, game)
            exec(CODE, bullet)
            assert max(game["y"], bullet["y"]) <= face
        assert game["y"] == pytest.approx(face, abs=1e-3)

def test_a_ball_leaves_a_platform_at_its_end_and_one_face_takes_its_part_of_a_frame() -> None:
    game = ball(CR=0.0, vx=1.0, floor=5.0, platforms=[(1.0, 0.0, 2.0)])
    for _ in range(300):
        exec(CODE, game)
    assert game["y"] == 4.9
    game = ball(CR=0.5, v=60.0, floor=1.05, platforms=[(1.0, 0.0, 2.0)])
    exec(CODE, game)  # platform and floor in one frame
    assert game["y"] == 0.9
    assert game["v"] == pytest.approx(-0.5 * sqrt(60.0**2 + 2 * 10 * 0.9))

@pytest.mark.parametrize("seed", range(20))
def test_a_paddle_and_a_lift_take_each_ball_and_give_it_their_speed(seed: int) -> None:
    rng = random.Random(seed)
    moved = compile(IN_GAME, "README.md", "exec")
    u, CR = rng.uniform(-3, 3), rng.uniform(0, 1)
    for place, speed in (("x", "vx"), ("y", "v")):
        face, came = 1.0, u + rng.uniform(0.1, 30)
        game = ball(CR=CR, g=0.0, paddle=1e3, old_paddle=1e3, paddle_top=-1e3, paddle_bottom=1e3)
        game |= {place: face - rng.uniform(0.11, 1), speed: came}
        behind = game | {place: face + 0.2, speed: u}
        for _ in range(600):
            old_face, face = face, face + u / 60
            if place == "x":
                where: dict[str, Any] = {"old_paddle": old_face, "paddle": face}
            else:
                where = {"platforms": [(old_face, face, -1e3, 1e3)]}
            for each in (game, behind):
                each |= where
                exec(moved, each)
            assert game[place] <= face - 0.1 + 1e-12
            assert behind[place] > face  # it does not jump
        assert game[speed] == pytest.approx(u - CR * (came - u))

# How good are the methods?

def test_the_rows_of_the_map_are_the_program_s() -> None:
    head, *rows = block(README, "1000 FPS").splitlines()
    rates = [int(fps) for fps in head.split()[:-1]]
    for row in rows:
        motion, _, correction, *letters = row.split()
        method = compared(12, motion, correction)
        for fps, letter in zip(rates, letters, strict=True):
            runs = [verdict(method, 1 / 55, fps, cut) for cut in range(airtrack.CUTS)]
            assert airtrack.cell(runs) == letter

@pytest.mark.parametrize(("letter", "fps"), [("a", 480), ("c", 240), ("d", 10)])
def test_a_method_stays_within_a_column_from_the_rate_that_is_told(letter: str, fps: int) -> None:
    method = compared(12, *airtrack.METHODS[letter])
    assert airtrack.largest_error_m(method, fps) <= 1 / 55
    if fps > 10:
        assert max(frame.error_m() for frame in simulate(method, fps // 2, 0, 1)) > 1 / 55

# The lesson.

SHEET = (HERE / ".github/worksheet.txt").read_text(encoding="utf-8")

def test_the_worksheet_shows_the_film_of_the_lesson_s_command() -> None:
    words, = re.findall(r"`python airtrack\.py (8 --fast [^`]*)`", LESSON)
    printed = shown(words.replace("--fast ", "")).lines
    rows = re.findall(r"(?m)^ *(\d+)  (.{71}) +(\d+\.\d)$", SHEET)
    assert [int(number) for number, _, _ in rows] == list(range(1, len(printed) + 1))
    for (number, row, t_s), line in zip(rows, printed, strict=True):
        assert float(t_s) == pytest.approx(int(number) / 10)
        without_scale = "".join(["." if column == 64 and mark == "." else mark.replace(".", " ")
                                 for column, mark in enumerate(row)])
        assert without_scale == line.ljust(71)

def test_the_answers_of_the_worksheet() -> None:
    frames = filmed(8, 60).frames
    first, second = [frame for frame in frames if frame.mark_m is not None][:2]
    assert [first.t_s, second.t_s] == pytest.approx([1.3, 3.9])
    for bounce, lift_cm, columns in ((first, 14, 2), (second, 38, 6)):
        assert bounce.mark_m is not None
        assert 100 * (bounce.x_m - bounce.mark_m) == pytest.approx(lift_cm)
        assert [8 - round(32 * bounce.mark_m), round(32 * bounce.x_m) - 8] == [columns, columns]
    assert [frames[10].x_m, frames[10].true_m] == pytest.approx([0.90, 1.00])
    turns_m = tops_m([frame.x_m for frame in frames])
    assert turns_m == pytest.approx([1.88, 2.00])
    assert [64 - round(32 * turn_m) for turn_m in turns_m] == [4, 0]

def test_the_figures_of_the_other_films_of_the_lesson() -> None:
    for fps, least, most in ((10.0, 3.02, 3.76), (100.0, 3.44, 3.53)):
        car = filmed(8, round(20 * fps), fps_target=fps)
        energies = [car.track.energy(frame.x_m, frame.v_mps) for frame in car.frames]
        assert [min(energies), max(energies)] == pytest.approx([least, most], abs=0.005)
    for motion, apart_m in (("forward", 0.15), ("backward", -0.15)):
        frame = filmed(13, 15, motion=motion).frames[15]
        assert frame.x_m - frame.true_m == pytest.approx(apart_m)
    car = filmed(10, 60)
    assert [frame.mark_m is not None for frame in car.frames[:15]] == [False] * 14 + [True]
    turns_m = tops_m([frame.x_m for frame in car.frames])
    assert all(2 - 0.0025 <= turn_m <= 2 for turn_m in turns_m)
    turns_m = tops_m([frame.x_m - 0.25 for frame in filmed(1, 200).frames])[:3]
    assert [round(turn_m * 55 * 99 / 134) for turn_m in turns_m] == [35, 19, 8]

# The exercises.

def test_the_engine_on_one_page_draws_example_0(capsys: pytest.CaptureFixture[str],
                                                monkeypatch: pytest.MonkeyPatch) -> None:
    def sleep(_: float) -> None:
        drawn.append(capsys.readouterr().out.rstrip("\n"))
        if len(drawn) == 200:
            raise KeyboardInterrupt

    drawn: list[str] = []
    monkeypatch.setattr("time.sleep", sleep)
    exec(block(EXERCISES, "def settle("), {})
    assert drawn == [line.partition(", FPS")[0] for line in shown("0 --frames 200").lines]

def test_the_motion_of_exercise_1_moves_as_exact(monkeypatch: pytest.MonkeyPatch) -> None:
    names: dict[str, Any] = {"State": tuple}
    exec(block(EXERCISES, "def mean("), names)
    monkeypatch.setitem(airtrack.MOTIONS, "exact", names["mean"])
    found = [step(Scene(x_m=1, v_mps=v, a_mps2=-2, motion="exact"), 1, v, 0.1) for v in (-3, 0, 8)]
    monkeypatch.undo()
    for v, ended in zip((-3, 0, 8), found, strict=True):
        assert ended == pytest.approx(step(Scene(x_m=1, v_mps=v, a_mps2=-2, motion="exact"), 1, v,
                                           0.1))

def test_the_zeno_point_and_the_hops_of_the_other_exercises() -> None:
    lies = Scene(**EXAMPLES[12].settings | {"CR": 0.9, "correction": "replay"})
    assert step(lies, 2.0, 0.0, 25.2)[1] == 0
    assert step(lies, 2.0, 0.0, 25.0)[1] != 0
    car = filmed(20, 60, CR=0.6, motion="forward", correction="surface")
    assert hops(car) == [11, 9, 8, 7, 6, 6]
    rows = re.findall(r"\| (0\.\d+) \| [\d.]+ \| (\d+) \| ([\d.]+) \|", EXERCISES)
    for (u, n, w), bounce in zip(rows, bounces(car), strict=False):
        assert float(u) == pytest.approx(car.frames[bounce].v_mps, abs=0.0006)
        assert float(w) == pytest.approx(0.2 * int(n) - float(u), abs=0.0006)
