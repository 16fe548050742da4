"""The pages: their commands are taken, their blocks of code work as printed, their links lead
somewhere, and their figures of films, chart and map are those of the program."""

import contextlib
import io
import random
import re
from math import floor, isfinite, sqrt
from types import CodeType
from typing import Any

import pytest

import airtrack
from airtrack import Track, main, step
from examples import EXAMPLES
from films import HERE, bounces, filmed, furthest_m, hops, shown, tops_m, true_m

FILES = {path.name: path for path in (HERE / "README.md", *sorted(HERE.glob(".github/*.md")))}
PAGES = {name: path.read_text(encoding="utf-8") for name, path in FILES.items()}
README, CURE_PAGE, LAW = PAGES["README.md"], PAGES["cure.md"], PAGES["law.md"]
LESSON, EXERCISES = PAGES["lesson.md"], PAGES["exercises.md"]
COMMANDS = sorted(set(re.findall(
    r"(?:python3?|py|uv run) airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", "".join(PAGES.values())))
    - {"-h"})

def figures(page: str, pattern: str) -> list[float]:
    """The figures on a page, in the order in which the pattern has its groups."""
    found = re.search(pattern, " ".join(page.replace("\N{MINUS SIGN}", "-").split()))
    assert found, pattern
    return [float(figure) for figure in found.groups()]

def block(page: str, part: str) -> str:
    """The first block of code on a page that has this part."""
    blocks: list[str] = re.findall(r"(?ms)^```\w*\n(.*?)^```$", page)
    return [code for code in blocks if part in code][0]  # noqa: RUF015

# Commands, links and pictures.

@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_is_taken(words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(airtrack, "film", lambda *_: None)
    monkeypatch.setattr(airtrack, "COMMANDS", dict.fromkeys(airtrack.COMMANDS, lambda *_: None))
    assert main(words.split()) == 0

def anchors(page: str) -> list[str]:
    """What a link may name of a page: its headings in small letters, with - for each space."""
    headings = re.findall("(?m)^#+ (.*)$", re.sub("(?ms)^```.*?^```", "", page))
    return [re.sub("[^a-z0-9 -]", "", heading.lower()).replace(" ", "-") for heading in headings]

@pytest.mark.parametrize("page", PAGES)
def test_every_link_between_the_pages_leads_to_a_file_and_a_heading(page: str) -> None:
    links = re.findall(r"\]\((?!http)([^)#]*)#?([^)]*)\)", PAGES[page].replace("\n", " "))
    assert links
    for path, heading in links:
        target = FILES[page].parent / path if path else FILES[page]
        assert target.exists(), path
        assert not heading or heading in anchors(target.read_text(encoding="utf-8")), heading

# The README.

def test_the_whole_engine_draws_example_0(capsys: pytest.CaptureFixture[str],
                                          monkeypatch: pytest.MonkeyPatch) -> None:
    def sleep(_: float) -> None:
        lines.append(capsys.readouterr().out.rstrip("\n"))
        if len(lines) == 200:
            raise KeyboardInterrupt

    lines: list[str] = []
    monkeypatch.setattr("time.sleep", sleep)
    exec(block(README, "def settle("), {})
    assert lines == [line.partition(", FPS")[0] for line in shown("0 --frames 200").lines]

LISTING = (HERE / "airtrack.py").read_text(encoding="utf-8")

@pytest.mark.parametrize("page", [README, LISTING])
def test_the_drawn_collision_by_each_correction(page: str) -> None:
    """At the right wall. A column is 1 cm."""
    lines = [line.removeprefix("#     ") for line in page.splitlines()]
    wall = next(line for line in lines if line.startswith("the move")).index("|")
    for name in airtrack.CORRECTIONS:
        track = Track(motion="exact", correction=name, a_mps2=20, left_edge_m=-1, right_edge_m=0)
        x_m, v_mps, mark_m = step(track, -0.12, 1.0, 0.1)
        picture = next(line for line in lines if re.match(rf"{name} +[*|]", line))
        assert picture.index("*") - wall == round(100 * x_m)
        assert picture.find("0", 0, wall + 10) in (-1, wall + 8)
        assert mark_m == pytest.approx(0.08)
        figures = [float(text) for text in re.findall(r"-?\d+\.\d+|\d+ ", picture[wall + 10:])]
        depth, speed, energy = figures
        in_m = 1 if page is LISTING else 0.01
        assert in_m * abs(depth) == pytest.approx(abs(x_m), abs=0.0006)
        assert abs(speed) == pytest.approx(abs(v_mps), abs=0.005)
        assert energy == pytest.approx(track.energy(x_m, v_mps), abs=0.005)

def test_the_two_lines_of_cure_are_those_of_the_whole_cure() -> None:
    text = "from math import sqrt\n" + block(README, "; v += g*dt")
    two_lines = compile(text, "README.md", "exec")
    for CR in (0.5, 1.0):
        assert heights_m(two_lines, 300, CR=CR) == heights_m(CODE, 300, CR=CR)

def test_the_rows_of_the_map_are_the_program_s(capsys: pytest.CaptureFixture[str]) -> None:
    main(["stability"])
    out = capsys.readouterr().out
    for row in block(README, "480 FPS").splitlines():
        assert row in out

def test_a_method_stays_within_a_column_from_the_rate_that_is_told(
        monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(airtrack, "costs_us", lambda scenes: dict.fromkeys(scenes, 1.0))
    settings = EXAMPLES[12].settings
    rows = re.findall(r"(?m)^\| (\w+) \+ (\w+) \|[^|]*\| from (\d+) FPS on", README)
    assert len(rows) == 3
    letters = {method: letter for letter, method in airtrack.METHODS.items()}
    for motion, correction, fps in rows:
        at = airtrack.CHART_FPS.index(int(fps))
        for rate, is_within in ((airtrack.CHART_FPS[at], True), (airtrack.CHART_FPS[at - 1], False)):
            points = airtrack.measured(airtrack.scene_of(settings | {"fps_target": rate}))
            error_m, = [point.error_m for point in points
                        if point.letter == letters[motion, correction]]
            assert (error_m <= 1 / 55) is is_within

def test_at_10_fps_rewind_is_better_than_three_others_at_960(
        monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(airtrack, "costs_us", lambda scenes: dict.fromkeys(scenes, 1.0))
    rewind_mm, least_mm, most_mm = figures(
        README, r"rewind at 10 FPS is ([\d.]+) mm off .* table are ([\d.]+) to ([\d.]+) mm off")
    errors_mm = []
    for fps in (10, 960):
        points = airtrack.measured(airtrack.scene_of(EXAMPLES[12].settings | {"fps_target": fps}))
        errors_mm.append([1000 * point.error_m for point in points])
    assert errors_mm[0][3] == pytest.approx(rewind_mm, abs=0.05)
    assert [min(errors_mm[1][:3]), max(errors_mm[1][:3])] == pytest.approx(
        [least_mm, most_mm], rel=0.02)

# The cure, as printed.

CURE = block(CURE_PAGE, "from math import sqrt")
PADDLE = block(CURE_PAGE, "u = (paddle")

def in_game(paddle: str) -> CodeType:
    """The cure with a block for a paddle in its place."""
    return compile(CURE.replace("if x < left + r", paddle + "if x < left + r"), "cure.md", "exec")

CODE = compile(CURE, "cure.md", "exec")

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
    other = compile(CURE.replace(v_line + y_line, y_line + v_line), "cure.md", "exec")
    assert tops_m(heights_m(other, 200))[1] > 1.05

def test_y_may_grow_upwards() -> None:
    turn = "y = -y\nv = -v\n"
    upwards = compile(turn + CURE + turn, "cure.md", "exec")
    game = ball(floor=-2.0, y=3.1)  # the floor is at 2, with a minus
    found = []
    for _ in range(300):
        exec(upwards, game)
        found.append(game["y"] - 2.1)
    assert found == pytest.approx(heights_m(CODE, 300))

@pytest.mark.parametrize("CR", [0.0, 0.3, 0.8, 0.98])
def test_no_ball_falls_through_a_platform_from_above_and_all_come_to_lie_still(CR: float) -> None:
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

def test_a_platform_is_one_way_and_ends_and_one_face_takes_its_part_of_a_frame() -> None:
    game = ball(CR=0.0, vx=1.0, floor=5.0, platforms=[(1.0, 0.0, 2.0)])
    for _ in range(300):
        exec(CODE, game)
    assert game["y"] == 4.9
    game = ball(CR=0.5, v=60.0, floor=1.05, platforms=[(1.0, 0.0, 2.0)])
    exec(CODE, game)  # platform and floor in one frame
    assert game["y"] == 0.9
    assert game["v"] == pytest.approx(-0.5 * sqrt(60.0**2 + 2 * 10 * 0.9))
    game = ball(y=2.0, v=-8.0, platforms=[(1.0, 0.0, 2.0)])
    for _ in range(20):
        exec(CODE, game)
    assert game["y"] < 0.9

def left_paddle() -> str:
    """The block for a paddle at the left side, by what the page says of it."""
    code = re.sub(r"\b(old_)?paddle(_top|_bottom)?\b", r"\1paddle2\2", PADDLE)
    for name in ("before", "after", "x"):
        told, = re.findall(rf"`({name} = [^`]*2 [^`]*)`", CURE_PAGE)
        code = re.sub(rf"(?m)\b{name} = [^#\n]*", told, code)
    return code

@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("side", [-1, 1])
def test_a_paddle_takes_each_ball_and_gives_it_its_speed_even_in_a_corner(
        side: int, seed: int) -> None:
    rng = random.Random(seed)
    code = in_game(PADDLE if side == 1 else left_paddle())
    name = "paddle" if side == 1 else "paddle2"
    u, CR = rng.uniform(-3, 3), rng.uniform(0, 1)
    face, came = side * 1.0, u + side * rng.uniform(0.1, 30)
    game = ball(CR=CR, g=0.0, ceiling=2.0, floor=3.0, x=face - side * rng.uniform(0.11, 1), vx=came,
                y=rng.uniform(2.1, 2.9), v=rng.choice([-20.0, 0.0, 20.0]))
    game |= {f"old_{name}": face, f"{name}_top": 2.0, f"{name}_bottom": 3.0}
    behind = game | {"x": face + side * 0.2, "vx": u}
    for _ in range(600):
        face += u / 60
        for each in (game, behind):
            each[name] = face
            exec(code, each)
        assert side * (face - game["x"]) >= 0.1 - 1e-12
        assert side * (behind["x"] - face) > 0  # it does not jump
    assert game["vx"] == pytest.approx(u - CR * (came - u))

def test_a_paddle_takes_only_the_balls_that_cross_its_face() -> None:
    rng = random.Random(4)
    code = in_game(PADDLE)
    for _ in range(300):
        x, y, slope = rng.uniform(720, 747), rng.uniform(0, 400), rng.uniform(-1.5, 1.5)
        game = ball(r=12.8, g=0.0, x=x, y=y, vx=2383.0, v=2383.0 * slope, ceiling=-1e9, floor=1e9,
                    paddle=760.0, old_paddle=760.0, paddle_top=150.0, paddle_bottom=262.0)
        game["right"] = game["floor"]
        true_y = y + slope * (760 - 12.8 - x)
        exec(code, game)
        if min(abs(true_y - 150), abs(true_y - 262)) > 1e-6:
            assert (game["vx"] < 0) is (150 < true_y < 262)

def test_in_pong_mirroring_is_exact() -> None:
    told, = re.findall(r"write `(y = floor - r - [^`]*)`", CURE_PAGE)
    mirrored = compile(CURE.replace("y = floor - r\n", told + "\n"), "cure.md", "exec")
    for code, is_exact in ((mirrored, True), (CODE, False)):
        game = ball(g=0.0, floor=5.0, y=4.2, v=1.7, CR=0.6)
        for _ in range(60):
            exec(code, game)
        true_y = 4.9 - 0.6 * (1.7 - 0.7)
        assert (abs(game["y"] - true_y) < 1e-9) is is_exact

def test_a_frame_of_up_to_5_s_makes_no_energy() -> None:
    rng = random.Random(6)
    for CR in (1.0, 0.8, 0.3):
        game = ball(left=0.0, right=6.0, floor=5.0, y=3.0, v=-7.0, CR=CR)
        first = energy(game)
        for _ in range(2000):
            game["dt"] = rng.choice([1 / 60, rng.uniform(0, 5)])
            exec(CODE, game)
            assert energy(game) <= first * (1 + 1e-9)

def test_the_figures_of_the_cure() -> None:
    # From 1 m, as the game's usual two lines move it.
    usual = CURE.replace("y += v*dt + g*dt*dt/2  # an exact move: first y,\nv += g*dt ",
                         "v += g*dt\ny += v*dt ")
    assert usual != CURE
    told = figures(CURE_PAGE, r"a ball from 1 m comes back to ([\d.]+), ([\d.]+) and ([\d.]+) m")
    heights = heights_m(compile(usual, "cure.md", "exec"), 300)
    assert tops_m(heights)[:3] == pytest.approx(told, abs=0.006)
    # A true ball bounces at the moments T, 3 T, 5 T and so on; this one up to a frame later.
    game = ball(floor=5.0, y=3.9, g=9.81)
    bounces_s = []
    for frame in range(1, 1400):
        before = game["v"]
        exec(CODE, game)
        if before > 0 > game["v"]:
            bounces_s.append(frame / 60)
    fall_s = sqrt(2 / 9.81)
    in_20_s = [(2 * n + 1) * fall_s for n in range(22)]
    late = [60 * (found_s - true_s) for found_s, true_s in zip(bounces_s, in_20_s, strict=False)]
    assert in_20_s[-1] < 20
    assert figures(CURE_PAGE, r"the ball is (\d+) frames late") == pytest.approx(late[-1:], abs=1)
    high_px = []
    for fps in (30, 60):
        v, y_px = -600.0, [0.0]
        while v < 0:
            v += 1000 / fps
            y_px.append(y_px[-1] + v / fps)
        high_px.append(-min(y_px))
    assert figures(CURE_PAGE, r"(\d+) px high at 30 FPS, and (\d+) px at 60 FPS") == high_px

# The law: its formulas are read from the page.

MINUS = "\N{MINUS SIGN}"

def formula(text: str) -> CodeType:
    """A formula of the page, such as √(U² + 2gH)/(g dt), as Python."""
    text = text.replace("gH", "g H").replace(MINUS, "-").replace("√", "sqrt").replace("·", "*")
    text = re.sub(r"(\d)([a-zA-Z])", r"\1 \2", text.replace("²", "**2"))
    text = re.sub(r"(?<=[\w)]) +(?=[\w(])", "*", text)  # a space between factors
    return compile(text.replace("n*g*dt*-*u", "n*g*dt-u"), "law.md", "eval")

def of_step(number: int, pattern: str) -> CodeType:
    line, = re.findall(rf"(?m)^{number}\. (.*(?:\n   .*)*)", LAW)
    return formula(re.findall(pattern, line)[0])

BIG_U = {motion: formula(text) for text, motion in
         re.findall(rf"(u(?: [+{MINUS}] g dt/2)?) with (forward|exact|backward)", LAW)}
Q = of_step(2, r"\*\*q = (.*?)\*\*")
W = of_step(4, r"\*\*w = (.*?)\*\*")
DEPTH = of_step(5, r"\*\*depth = (.*?)\*\*")
NEXT_U = {"surface": of_step(6, r"u is (CR w)\*\*"), "conserve": of_step(6, r"(CR √.*?) with")}
NEXT_U["rebound"] = NEXT_U["surface"]
NEXT_H = {"rebound": of_step(7, r"H is (CR depth)\*\*"), "surface": formula("0"),
          "conserve": formula("0")}

def forecast(motion: str, correction: str, H: float, u: float, g: float, dt: float, CR: float,
             count: int) -> list[tuple[int, float, float, bool]]:
    """By the page's steps: frames, w and depth of so many hops, and if round-off may decide."""
    found = []
    for _ in range(count):
        names: dict[str, Any] = {"u": u, "H": H, "g": g, "dt": dt, "CR": CR, "sqrt": sqrt}
        names["U"] = eval(BIG_U[motion], names)
        q = eval(Q, names)
        names["n"] = max(floor(q) + 1, 1)
        names["w"] = eval(W, names)
        names["depth"] = eval(DEPTH, names)
        is_close = q > 0.5 and abs(q - round(q)) < 1e-6
        found.append((names["n"], names["w"], names["depth"], is_close))
        H, u = eval(NEXT_H[correction], names), eval(NEXT_U[correction], names)
    return found

def k_bounds(motion: str, correction: str) -> tuple[float, float]:
    """What the page's table says of k."""
    if correction == "conserve":
        return -9, 9
    column = ("forward", "exact", "backward").index(motion)
    cells = re.findall(rf"(?m)^\| {correction} \| (.*) \|$", LAW)[0].replace(MINUS, "-").split(" | ")
    least, largest = cells[column].split(" to ")
    return float(least), float(largest)

@pytest.mark.parametrize(("motion", "correction"), [
    ("forward", "surface"), ("forward", "rebound"), ("exact", "surface"), ("exact", "rebound"),
    ("backward", "surface"), ("backward", "rebound"), ("exact", "conserve")])
def test_the_forecast_foretells_2000_hops_of_each_pair(motion: str, correction: str) -> None:
    rng = random.Random(5)
    foretold = 0
    least, largest = k_bounds(motion, correction)
    while foretold < 2000:
        g, dt, CR = rng.uniform(0.5, 20), rng.uniform(0.005, 0.2), rng.uniform(0, 1)
        H, u = rng.uniform(0, 2), rng.uniform(-3, 5)
        track = Track(x_m=H, v_mps=u, a_mps2=-g, CR=CR, left_edge_m=0, right_edge_m=1e6,
                      motion=motion, correction=correction)
        x_m, v_mps = H, u
        steps = forecast(motion, correction, H, u, g, dt, CR, 10)
        for number, (n, w, depth_m, is_close) in enumerate(steps):
            if is_close:
                break  # the page's exception
            assert number == 0 or n == 1 or least < n - 2 * v_mps / (g * dt) <= largest
            for _ in range(n):
                before_mps = v_mps
                x_m, v_mps, mark_m = step(track, x_m, v_mps, dt)
                if _ < n - 1:
                    assert mark_m is None
            assert mark_m == pytest.approx(-depth_m, abs=1e-8)
            assert g * dt - before_mps == pytest.approx(w, abs=1e-8)
            foretold += 1

@pytest.mark.parametrize(("film", "motion", "correction", "g", "CR", "rows"), [
    ("drawn", "exact", "surface", 4, 0.8, 3), ("20", "exact", "rebound", 2, 0.8, 4),
    ("8", "backward", "rebound", 2, 1, 3)])
def test_the_worked_rows_of_the_law_are_those_of_its_steps(
        film: str, motion: str, correction: str, g: float, CR: float, rows: int) -> None:
    printed = []
    for cells in re.findall(rf"(?m)^\| {film} \| (.*) \|$", LAW):
        numbers = [cell.rpartition("= ")[2].replace(MINUS, "-") for cell in cells.split(" | ")]
        u, H, _, _, n, w, depth_m = [float(number) for number in numbers]
        printed.append((u, H, n, w, depth_m))
    assert len(printed) == rows
    u, H, *_ = printed[0]
    steps = forecast(motion, correction, H, u, g, 0.1, CR, rows)
    for (_, _, *found), (n, w, depth_m, _) in zip(printed, steps, strict=True):
        assert found == pytest.approx([n, w, depth_m], abs=1e-4)

@pytest.mark.parametrize(("number", "changes", "printed"), [
    (20, {}, "14 12 10 9 ..."), (8, {"x_m": 1.55, "v_mps": -0.07},
                                     "23 24 25 25 24 23 23 23 22 21 21 22 ...")])
def test_the_hops_that_the_law_names_are_those_of_the_film(
        number: int, changes: dict[str, Any], printed: str) -> None:
    assert printed in LAW
    first = [int(n) for n in printed.partition(" ...")[0].split()]
    assert hops(filmed(number, 400, **changes))[:len(first)] == first

def test_forward_and_conserve_hops_for_ever_and_steady_hops_have_at_most_8_frames() -> None:
    endless = hops(filmed(10, 3000, motion="forward", correction="conserve", CR=0.9))
    assert min(endless[-20:]) > 1
    rng = random.Random(3)
    for _ in range(50):
        car = filmed(20, 2000, correction="surface", x_m=rng.uniform(0.3, 1), v_mps=rng.random())
        *_, last = hops(car)
        assert last <= 8

# The lesson.

SHEET = (HERE / ".github/worksheet.txt").read_text(encoding="utf-8")

def test_the_worksheet_shows_the_film_of_the_lesson_s_command() -> None:
    words, = re.findall(r"`python3 airtrack\.py (8 --fast [^`]*)`", LESSON)
    printed = shown(words.replace("--fast ", "")).lines
    rows = re.findall(r"(?m)^ *(\d+)  (.{71}) +(\d+\.\d)$", SHEET)
    assert [int(number) for number, _, _ in rows] == list(range(1, len(printed) + 1))
    for (number, row, t_s), line in zip(rows, printed, strict=True):
        assert float(t_s) == pytest.approx(int(number) / 10)
        without_scale = "".join(["." if column == 64 and mark == "." else mark.replace(".", " ")
                                 for column, mark in enumerate(row)])
        assert without_scale == line.ljust(71)

def test_the_answers_of_the_worksheet() -> None:
    car = filmed(8, 120)
    places_m, true = car.places_m, true_m(car)
    line_1, t_1, line_2, t_2 = figures(
        LESSON, r"first bounce is in line (\d+), at ([\d.]+) s. The second is in line (\d+), at "
                r"([\d.]+) s")
    assert bounces(car)[:2] == [line_1, line_2] == pytest.approx([10 * t_1, 10 * t_2])
    for line, (depth_cm, _, lift_cm) in zip(bounces(car), (
            figures(LESSON, r"2\. (\d+) cm \+ (\d+) cm = (\d+) cm"),
            figures(LESSON, r"14 cm, and (\d+) cm \+ (\d+) cm = (\d+) cm")), strict=False):
        mark_m = car.marks_m[line]
        assert mark_m is not None
        assert 100 * (0.25 - mark_m) == pytest.approx(depth_cm)
        assert 100 * (places_m[line] - mark_m) == pytest.approx(lift_cm)
    at_6, at_10, off_6, off_10 = figures(
        LESSON, r"true car is at ([\d.]+) m, then at ([\d.]+) m. The `\*` is (\d+) cm further down, "
                r"then (\d+) cm")
    assert [true[6], true[10]] == pytest.approx([at_6, at_10])
    assert [true[6] - places_m[6], true[10] - places_m[10]] == pytest.approx(
        [off_6 / 100, off_10 / 100])
    energies = [car.scene.energy(*state) for state in zip(places_m, car.velocities_mps, strict=True)]
    assert figures(LESSON, r"0 \+ 2 · 1.75 = ([\d.]+) J/kg.*= 2 \+ 1.3 = ([\d.]+) J/kg") == (
        pytest.approx([energies[0], energies[10]]))
    assert tops_m(places_m)[:4] == pytest.approx(
        figures(LESSON, r"first turn, at ([\d.]+) m, is wrong")
        + figures(LESSON, r"In line 52 the `\*` is at ([\d.]+) m")
        + figures(LESSON, r"third turn is at ([\d.]+) m, and the fourth at ([\d.]+) m"))
    assert figures(LESSON, r"In line 52 .* true car is at ([\d.]+) m. So .* In line 40 the `\*` is at "
                           r"([\d.]+) m, and the true car is at ([\d.]+) m") == (
        pytest.approx([true[52], places_m[40], true[40]], abs=0.005))
    assert [car.velocities_mps[26], car.velocities_mps[52]] == pytest.approx([0, 0])
    told = figures(LESSON, r"least in line (\d+), ([\d.]+) J/kg, and most in line (\d+), ([\d.]+)")
    assert told == pytest.approx([energies.index(min(energies[:60])), min(energies),
                                  energies.index(max(energies[:60])), max(energies)], abs=0.005)
    line = re.findall(r"(?m)^ 26  (.{71})", SHEET)[0]
    assert line.rindex(".") - line.index("*") == 4
    gain, loss, result = figures(SHEET, r"to the first turn: +(\d+) +- +26 · +(\d+) += +(-\d+) +cm")
    assert gain - 26 * loss == result == pytest.approx(100 * (places_m[26] - places_m[0]))

def drawn(words: str, columns: int, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The lines of a film as a terminal of this width shows them."""
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setenv("COLUMNS", str(columns))
    with contextlib.redirect_stdout(Terminal()) as out:
        main([*words.split(), "--fast"])
    return out.getvalue().split("\n\n")[1].splitlines()[:-1]

def test_the_columns_of_the_lesson_are_those_on_a_screen_of_100(
        monkeypatch: pytest.MonkeyPatch) -> None:
    lines = drawn("1", 100, monkeypatch)
    wall, = {line.index("|") for line in lines if line.index("|") < 50}
    columns = [line.find("*") - wall for line in lines]
    turns = [max(columns[:70]), max(columns[70:120]), max(columns[125:160]), max(columns[165:185])]
    assert turns == figures(LESSON, r"starts and turns: (\d+), (\d+), (\d+) and (\d+)")
    ends_s, = figures(LESSON, r"After ([\d.]+) s the film would end by itself")
    assert len(lines) / 30 == pytest.approx(ends_s, abs=0.05)
    lines = drawn("16 --frames=52", 100, monkeypatch)
    apart, = figures(LESSON, r"In line 40 they are (\d+) columns apart")
    assert lines[39].index("*") - lines[39].index("o") == apart
    assert "o" not in lines[51]
    lines = drawn("13 motion=backward --frames=15", 100, monkeypatch)
    assert "o" not in lines[0]
    apart, = figures(LESSON, r"In line 15 this is 15 cm, so (\d+) columns")
    marks = {mark: lines[-1].index(mark) for mark in "*o+"}
    assert [marks["o"] - marks["*"], marks["+"] - marks["o"]] == [apart, apart]
    line = drawn("10 --frames=14", 100, monkeypatch)[-1]
    wall = line.index("|")
    apart, = figures(LESSON, r"are both (\d+) columns from the wall")
    assert [wall - line.index("0"), line.index("*") - wall] == [apart, apart]

def test_the_figures_of_the_other_films_of_the_lesson() -> None:
    fine_m, coarse_m = figures(LESSON, r"at most ([\d.]+) m from it. In example 16.* ([\d.]+) m in the")
    assert furthest_m(filmed(8, 1000, fps_target=100.0)) == pytest.approx(fine_m, abs=0.005)
    assert furthest_m(filmed(16, 100)) == pytest.approx(coarse_m, abs=0.005)
    places_m = figures(LESSON, r"`\*` ([\d.]+) m, `o` ([\d.]+) m, `\+` ([\d.]+) m")
    speed_mps, = figures(LESSON, r"All three velocities are (-[\d.]+) m/s")
    energies = figures(LESSON, r"computes one E: ([\d.]+), ([\d.]+) and ([\d.]+) J/kg")
    for motion, place_m, energy_left in zip(
            ("backward", "exact", "forward"), places_m, energies, strict=True):
        car = filmed(13, 15, motion=motion)
        state = car.places_m[15], car.velocities_mps[15]
        assert state == pytest.approx((place_m, speed_mps))
        assert car.scene.energy(*state) == pytest.approx(energy_left, abs=0.001)

# The exercises.

def energy_of_the_engine(changes: str) -> float:
    """In J/kg, after 8000 frames with CR = 1, with some of its functions replaced."""
    code = block(README, "def settle(").partition("\ntry:")[0]
    code = code.replace("while True:", "for _ in range(8000):").replace("CR=0.8", "CR=1.0")
    code = re.sub(r"        (print|time).*\n", "", code)
    code += "    return x_m, v_mps\n"
    if "a_mps2, left_m" in changes:
        call, = re.findall(r"call `(settle\(.*?\))`", EXERCISES)
        code = re.sub(r"settle\(x_m, v_mps, 0.*?\)", call, code)
    names: dict[str, Any] = {}
    exec(f"{code}\n{changes}\nx_m, v_mps = film(11.0, 17.0, 0.015)", names)
    return float(names["v_mps"]**2 / 2 + 2 * (names["x_m"] - 0.5))

def test_the_energies_of_exercise_1() -> None:
    answer = block(EXERCISES, "def settle(")
    move, _, settle = answer.partition("\ndef settle")
    parts = {("as it was", "as it was"): "", ("exact", "as it was"): move, ("exact", "cured"):
             answer, ("as it was", "cured"): f"from math import sqrt\ndef settle{settle}"}
    rows = re.findall(r"(?m)^\| (exact|as it was) \| (cured|as it was) \| ([\d.]+) \|$", EXERCISES)
    assert len(rows) == 4
    for moved, settled, told in rows:
        found = energy_of_the_engine(parts[moved, settled])
        assert found == pytest.approx(float(told), abs=0.005)

def test_the_motion_of_exercise_2_moves_as_exact(monkeypatch: pytest.MonkeyPatch) -> None:
    names: dict[str, Any] = {"State": tuple}
    exec(block(EXERCISES, "def mean("), names)
    for v in (-3, 0, 8):
        ended = step(Track(x_m=1, v_mps=v, a_mps2=-2, motion="exact"), 1, v, 0.1)
        assert names["mean"](1, v, -2, 0.1) == pytest.approx(ended[:2])

def test_the_zeno_points_and_the_hops_of_the_other_exercises(
        capsys: pytest.CaptureFixture[str]) -> None:
    lies = airtrack.scene_of(EXAMPLES[12].settings | {"CR": 0.9, "correction": "replay"})
    zeno_s, = figures(EXERCISES, r"T \(1 \+ CR\)/\(1 - CR\) = ([\d.]+) s")
    assert step(lies, 2.0, 0.0, zeno_s + 0.1)[1] == 0
    assert step(lies, 2.0, 0.0, zeno_s - 0.1)[1] != 0
    exec(block(EXERCISES, "6.31"), {})
    moves, rests = [float(line.split()[1]) for line in capsys.readouterr().out.splitlines()]
    assert isfinite(moves)
    assert moves != 0
    assert rests == 0
    car = filmed(20, 60, CR=0.6, motion="forward", correction="surface")
    assert hops(car)[:6] == figures(EXERCISES, r"hops of (\d+) (\d+) (\d+) (\d+) (\d+) (\d+) 6 …")
    rows = re.findall(r"\| (0\.\d+) \| [\d.]+ \| (\d+) \| ([\d.]+) \|", EXERCISES)
    assert len(rows) == 4
    for (u, n, w), bounce in zip(rows, bounces(car), strict=False):
        assert float(u) == pytest.approx(car.velocities_mps[bounce], abs=0.0006)
        assert float(w) == pytest.approx(0.2 * int(n) - float(u), abs=0.0006)

def test_the_hops_and_turns_of_the_lab() -> None:
    words = block(EXERCISES, "x_m=1.5").split()[4:]
    settings = dict(word.split("=") for word in words)
    car = filmed(99, 500, **{name: airtrack.value_of(name, text) for name, text in settings.items()})
    rows = re.findall(r"(?m)^\| (\d) \| (\d+) \| ([\d.]+) \| ([\d.]+) m \| ([\d.]+) m \|$", EXERCISES)
    assert len(rows) == 4
    first_s = 2 * 0.9 * sqrt(2 * 1.5 / 0.1)
    for (number, lines, formula, turn_m, high_m), found, top_m in zip(
            rows, hops(car), tops_m(car.places_m), strict=False):
        earlier = int(number) - 1
        assert found == int(lines)
        assert 10 * first_s * 0.9**earlier == pytest.approx(float(formula), abs=0.051)
        assert f"{top_m:.2f}" == turn_m
        assert 1.5 * 0.81**int(number) == pytest.approx(float(high_m), abs=0.0006)
