"""The pages: their commands are taken, their blocks of code work as printed, their links lead
somewhere, and their figures, which are read on the page, are those of the program."""

import random
import re
from math import asin, degrees, floor, sqrt
from types import CodeType
from typing import Any

import pytest

import airtrack
from airtrack import METHODS, Track, main, scene_of, step
from examples import EXAMPLES
from films import HERE, bounces, chart_errors_m, filmed, furthest_m, hops, shown, tops_m, true_m

FILES = {path.name: path for path in (HERE / "README.md", *sorted(HERE.glob(".github/*.md")))}
PAGES = {name: path.read_text(encoding="utf-8") for name, path in FILES.items()}
README, CURE_PAGE, LAW = PAGES["README.md"], PAGES["cure.md"], PAGES["law.md"]
LESSON, EXERCISES = PAGES["lesson.md"], PAGES["exercises.md"]
LISTING = (HERE / "airtrack.py").read_text(encoding="utf-8")
SHEET = (HERE / ".github/worksheet.txt").read_text(encoding="utf-8")
MINUS = "\N{MINUS SIGN}"
COMMANDS = sorted(set(re.findall(r"(?:python3|py) airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)",
                                 "".join(PAGES.values()))) - {"-h"})

def block(page: str, part: str) -> str:
    """The first block of code on a page that has this part."""
    blocks: list[str] = re.findall(r"(?ms)^```\w*\n(.*?)^```$", page)
    return [code for code in blocks if part in code][0]  # noqa: RUF015

def figures(page: str, pattern: str) -> list[float]:
    """The figures on a page, in the order in which the pattern has its groups."""
    found = re.search(pattern, " ".join(page.replace(MINUS, "-").split()))
    assert found, pattern
    return [float(figure) for figure in found.groups()]

@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_is_taken(words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(airtrack, "film", lambda *_: None)
    monkeypatch.setattr(airtrack, "COMMANDS", dict.fromkeys(airtrack.COMMANDS, lambda *_: None))
    assert main(words.split()) == 0

@pytest.mark.parametrize("page", PAGES)
def test_every_link_between_the_pages_leads_to_a_file_and_a_heading(page: str) -> None:
    text = PAGES[page].replace("\n", " ")
    for path, heading in re.findall(r"\]\((?!http)([^)#]*)#?([^)]*)\)", text):
        target = FILES[page].parent / path if path else FILES[page]
        assert target.exists(), path
        if heading:
            headings = re.findall("(?m)^#+ (.*)$", target.read_text(encoding="utf-8"))
            anchors = [re.sub("[^a-z0-9 -]", "", each.lower()) for each in headings]
            assert heading.replace("-", " ") in anchors

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
        depth, speed, energy = [float(text) for text in re.findall(r"-?\d+\.\d+|\d+ ",
                                                                   picture[wall + 10:])]
        in_m = 1 if page is LISTING else 0.01
        assert in_m * abs(depth) == pytest.approx(abs(x_m), abs=0.0006)
        assert abs(speed) == pytest.approx(abs(v_mps), abs=0.005)
        assert energy == pytest.approx(track.energy(x_m, v_mps), abs=0.005)

def test_the_film_needs_a_terminal_as_wide_as_told(monkeypatch: pytest.MonkeyPatch) -> None:
    columns, = figures(README, r"In a terminal below (\d+) columns it is drawn smaller")
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    scene = scene_of(EXAMPLES[10].settings | {"show_details": True})
    for fewer in (0, 1):
        monkeypatch.setenv("COLUMNS", str(round(columns) - fewer))
        assert (airtrack.fitted(scene) == scene) is (fewer == 0)

def test_the_three_lines_of_rewind_are_the_program_s() -> None:
    names = {"sqrt": sqrt, "v": 3.0, "a": 20.0, "depth": 0.08, "CR": 0.8}
    exec(block(README, "late = "), names)
    assert (names["depth"], names["v"]) == pytest.approx(airtrack.rewind(0.08, 3.0, 20.0, 0.8))

def test_the_rows_of_the_map_are_the_program_s(capsys: pytest.CaptureFixture[str]) -> None:
    main(["stability"])
    out = capsys.readouterr().out
    for row in block(README, "480 FPS").splitlines():
        assert row in out

def test_the_errors_of_the_chart_are_those_that_are_told() -> None:
    letters = {method: letter for letter, method in METHODS.items()}
    rows = re.findall(r"(?m)^\| (\w+) \+ (\w+) \|[^|]*\| from (\d+) FPS on", README)
    assert len(rows) == 3
    for motion, correction, fps in rows:
        below = airtrack.CHART_FPS[airtrack.CHART_FPS.index(int(fps)) - 1]
        at_m, below_m = [chart_errors_m(12, rate)[letters[motion, correction]]
                         for rate in (int(fps), below)]
        assert at_m <= 1 / 55 < below_m
    rewind_mm, least_mm, most_mm = figures(
        README, r"rewind at 10 FPS is ([\d.]+) mm off .* table are ([\d.]+) to ([\d.]+) mm off")
    assert 1000 * chart_errors_m(12, 10)["d"] == pytest.approx(rewind_mm, abs=0.05)
    late_cm, = figures(README, r"at 60 FPS the car is up to ([\d.]+) cm off")
    assert 100 * chart_errors_m(12, 60)["c"] == pytest.approx(late_cm, abs=0.05)
    others_mm = [1000 * chart_errors_m(12, 960)[letter] for letter in "abc"]
    assert [min(others_mm), max(others_mm)] == pytest.approx([least_mm, most_mm], rel=0.02)

# The cure, as printed.

CURE = block(CURE_PAGE, "from math import sqrt")
CODE = compile(CURE, "cure.md", "exec")

def with_paddle(name: str) -> CodeType:
    """The cure with the block for this paddle in its place."""
    move, v_line, contacts = re.split(r"(?m)^(v \+= g\*dt.*\n)", CURE)
    return compile(move + v_line + block(CURE_PAGE, f"u = ({name} -") + contacts, "cure.md", "exec")

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

def test_the_two_lines_of_cure_are_those_of_the_whole_cure() -> None:
    text = "from math import sqrt\n" + block(README, "; v += g*dt")
    two_lines = compile(text, "README.md", "exec")
    for CR in (0.5, 1.0):
        assert heights_m(two_lines, 300, CR=CR) == heights_m(CODE, 300, CR=CR)

@pytest.mark.parametrize("longest_s", [1 / 60, 0.05, 5])
def test_the_cure_keeps_a_ball_s_energy_in_a_box_in_even_and_irregular_frames(
        longest_s: float) -> None:
    rng = random.Random(1)
    game = ball(left=0.0, right=6.0, ceiling=2.0, floor=5.0, x=2.0, vx=2.3, y=3.0, v=-7.0)
    first = energy(game)
    for _ in range(10_000):
        game["dt"] = rng.uniform(1 / 144, longest_s) if longest_s > 1 / 60 else 1 / 60
        exec(CODE, game)
        assert energy(game) == pytest.approx(first, rel=1e-9)
        assert abs(game["vx"]) == 2.3
        assert 0.1 <= game["x"] <= 5.9
        assert 2.1 <= game["y"] <= 4.9

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

@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize(("name", "side", "x", "vx", "y", "v", "ends", "walls"), [
    ("paddle", 1, "x", "vx", "y", "v", "paddle_top paddle_bottom", "ceiling floor"),
    ("paddle2", -1, "x", "vx", "y", "v", "paddle2_top paddle2_bottom", "ceiling floor"),
    ("paddle3", 1, "y", "v", "x", "vx", "left3 right3", "left right")])
def test_a_paddle_takes_each_ball_and_gives_it_its_speed_even_in_a_corner(
        name: str, side: int, x: str, vx: str, y: str, v: str, ends: str, walls: str,
        seed: int) -> None:
    rng = random.Random(seed)
    code = with_paddle(name)
    u, CR, r = rng.uniform(-3, 3), rng.choice([0, rng.uniform(0, 1)]), rng.choice([0.1, 0.073])
    face, came = side * 1.0, u + side * rng.uniform(0.1, 30)
    game = ball(CR=CR, g=0.0, r=r) | {
        x: face - side * rng.uniform(0.11, 1), vx: came, y: rng.uniform(2.1, 2.9),
        v: rng.choice([-20.0, 0.0, 20.0]), f"old_{name}": face}
    game |= dict.fromkeys([*ends.split()[:1], *walls.split()[:1]], 2.0)
    game |= dict.fromkeys([*ends.split()[1:], *walls.split()[1:]], 3.0)
    behind = game | {x: face + side * 0.2, vx: u}
    for _ in range(600):
        face += u / 60
        for each in (game, behind):
            each[name] = face
            exec(code, each)
        assert side * (face - game[x]) >= r - 1e-12
        assert side * (behind[x] - face) > 0  # it does not jump
    assert game[vx] == pytest.approx(u - CR * (came - u))
    for _ in range(600):  # now the paddle pushes it, faster and faster
        u -= side * 0.05
        game[name] += u / 60
        exec(code, game)
        assert side * (game[name] - game[x]) >= r - 1e-12

def test_a_paddle_takes_only_the_balls_that_cross_its_face() -> None:
    rng = random.Random(4)
    code = with_paddle("paddle")
    for _ in range(300):
        x, y, slope = rng.uniform(720, 747), rng.uniform(0, 400), rng.uniform(-1.5, 1.5)
        game = ball(r=12.8, g=0.0, x=x, y=y, vx=2383.0, v=2383.0 * slope, paddle=760.0,
                    old_paddle=760.0, paddle_top=150.0, paddle_bottom=262.0)
        exec(code, game)
        assert (game["vx"] < 0) is (150 < y + slope * (760 - 12.8 - x) < 262)

def test_the_figures_of_the_cure() -> None:
    usual = CURE.replace("y += v*dt + g*dt*dt/2  # an exact move: first y,\nv += g*dt ",
                         "v += g*dt\ny += v*dt ")
    heights = tops_m(heights_m(compile(usual, "cure.md", "exec"), 300))[:3]
    assert figures(CURE_PAGE, r"comes back to ([\d.]+), ([\d.]+) and ([\d.]+) m") == pytest.approx(
        heights, abs=0.0051)
    game = ball(floor=5.0, y=3.9, g=9.81)
    found_s = []
    for frame in range(1, 1400):
        before = game["v"]
        exec(CODE, game)
        if before > 0 > game["v"]:
            found_s.append(frame / 60)
    true_s = (2 * 21 + 1) * sqrt(2 / 9.81)  # its last bounce within 20 s
    assert figures(CURE_PAGE, r"the ball is (\d+) frames late") == pytest.approx(
        [60 * (found_s[21] - true_s)], abs=0.5)
    for fps in (30, 60):  # with v - g dt, v - 2 g dt ... until it turns
        told, = figures(CURE_PAGE, rf"(\d+) px(?: high)? at {fps} FPS")
        speeds = [600 - 1000 / fps * n for n in range(1, 100)]
        assert told == pytest.approx(sum(speed for speed in speeds if speed > 0) / fps)

def test_what_was_for_60_fps_is_the_same_with_dt() -> None:
    speeds, g = figures(CURE_PAGE, r"multiply all speeds by (\d+) and g by (\d+)")
    assert (speeds, g) == (60, 60**2)  # px a frame, px a frame in each frame
    drag, = re.findall(r"write `(v \*= 0\.99\*\*[^`]*)`", CURE_PAGE)
    for fps in (30, 60):
        names = {"v": 1.0, "dt": 1 / fps}
        for _ in range(fps):
            exec(drag, names)
        assert names["v"] == pytest.approx(0.99**60)  # after a second

def test_a_lying_paddle_at_rest_is_a_floor() -> None:
    paddle = {"paddle3": 5.0, "old_paddle3": 5.0, "left3": -1e3, "right3": 1e3}
    game, code = ball(y=3.9, CR=0.9) | paddle, with_paddle("paddle3")
    for height_m in heights_m(CODE, 300, CR=0.9):
        exec(code, game)
        assert 4.9 - game["y"] == pytest.approx(height_m, abs=1e-9)

def test_in_pong_mirroring_is_exact() -> None:
    told, = re.findall(r"write `(y = floor - r - [^`]*)`", CURE_PAGE)
    mirrored = compile(CURE.replace("y = floor - r\n", told + "\n"), "cure.md", "exec")
    for code, is_exact in ((mirrored, True), (CODE, False)):
        game = ball(g=0.0, floor=5.0, y=4.2, v=1.7, CR=0.6)
        for _ in range(60):
            exec(code, game)
        assert (abs(game["y"] - (4.9 - 0.6 * (1.7 - 0.7))) < 1e-9) is is_exact

# The law: its formulas are read from the page.

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
Q, W = of_step(2, r"\*\*q = (.*?)\*\*"), of_step(4, r"\*\*w = (.*?)\*\*")
DEPTH = of_step(5, r"\*\*depth = (.*?)\*\*")
NEXT_U = {"surface": of_step(6, r"u is (CR w)\*\*"), "conserve": of_step(6, r"(CR √.*?) with")}
NEXT_U["rebound"] = NEXT_U["surface"]
NEXT_H = {"rebound": of_step(7, r"H is (CR depth)\*\*"), "surface": formula("0"),
          "conserve": formula("0")}
Foretold = list[tuple[int, float, float, bool]]

def forecast(motion: str, correction: str, H: float, u: float, g: float, dt: float, CR: float,
             count: int) -> Foretold:
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
        return -1e9, 1e9
    row, = re.findall(rf"(?m)^\| {correction} \| (.* to .*) \|$", LAW.replace(MINUS, "-"))
    least, largest = row.split(" | ")[("forward", "exact", "backward").index(motion)].split(" to ")
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
            for _ in range(n - 1):
                x_m, v_mps, mark_m = step(track, x_m, v_mps, dt)
                assert mark_m is None
            assert g * dt - v_mps == pytest.approx(w, abs=1e-8)
            x_m, v_mps, mark_m = step(track, x_m, v_mps, dt)
            assert mark_m == pytest.approx(-depth_m, abs=1e-8)
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

def test_the_longest_steady_hops_follow_from_the_bounds_of_k() -> None:
    factor, once, twice = figures(
        LAW, r"0.8 this factor is (\d+)\. .* at most (\d+) frames .* at most (\d+) with exact")
    assert factor == round(1.8 / 0.2)
    for longest, motion, correction in ((once, "exact", "surface"), (once, "backward", "rebound"),
                                        (twice, "exact", "rebound")):
        assert longest < k_bounds(motion, correction)[1] * factor <= longest + 1

# The lesson.

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

def test_the_answers_of_the_worksheet_and_the_figures_of_the_lesson() -> None:
    car = filmed(8, 120)
    places_m, true = car.places_m, true_m(car)
    energies = [car.scene.energy(x_m, v_mps)
                for x_m, v_mps in zip(places_m, car.velocities_mps, strict=True)]
    lifts_cm = [100 * (places_m[line] - (car.marks_m[line] or 0)) for line in bounces(car)[:2]]
    short_cm = 100 * (places_m[26] - places_m[0])
    fine, coarse = filmed(8, 1000, fps_target=100.0), filmed(16, 100)
    third = {motion: filmed(13, 15, motion=motion) for motion in ("backward", "exact", "forward")}
    third_m = [each.places_m[15] for each in third.values()]
    third_J = [each.scene.energy(each.places_m[15], -0.52) for each in third.values()]
    for page, pattern, found in (
            (LESSON, r"first bounce is in line (\d+), at .* second is in line (\d+)", [13, 39]),
            (LESSON, r"7 cm \+ 7 cm = (\d+) cm, and 19 cm \+ 19 cm = (\d+) cm", lifts_cm),
            (LESSON, r"true car is at ([\d.]+) m, then at ([\d.]+) m", [true[6], true[10]]),
            (LESSON, r"1.75 = ([\d.]+) J/kg.*\+ 1.3 = ([\d.]+) J", [energies[0], energies[10]]),
            (LESSON, r"first turn, in line 26: it is at ([\d.]+) m", [places_m[26]]),
            (LESSON, r"third turn is at ([\d.]+) m.* fourth at ([\d.]+) m", tops_m(places_m)[2:4]),
            (LESSON, r"In line 52 the `\*` is at ([\d.]+) m, and the true car is at ([\d.]+) m",
             [places_m[52], true[52]]),
            (LESSON, r"In line 40 the `\*` is at ([\d.]+) m, and the true car is at ([\d.]+) m",
             [places_m[40], true[40]]),
            (LESSON, r"least in line 38, ([\d.]+) J/kg, and most in line 39, ([\d.]+) J/kg",
             [energies[38], energies[39]]),
            (SHEET, r"to the first turn: +14 +- +26 · +1 += +(-\d+) +cm", [short_cm]),
            (LESSON, r"at most ([\d.]+) m from it.* is ([\d.]+) m in the same time",
             [furthest_m(fine), furthest_m(coarse)]),
            (LESSON, r"is 2 m/s², . is about (\d+)°. .* 1.5 m/s², it is about (\d+)°",
             [round(degrees(asin(a_mps2 / 9.81))) for a_mps2 in (2, 1.5)]),
            (LESSON, r"`\*` ([\d.]+) m, `o` ([\d.]+) m, `\+` ([\d.]+) m", third_m),
            (LESSON, r"that of the `\+`: ([\d.]+), ([\d.]+) and ([\d.]+) J/kg", third_J)):
        assert figures(page, pattern) == pytest.approx(found, abs=0.0051), pattern
    assert bounces(car)[:2] == [13, 39]
    assert energies.index(min(energies)) == 38
    assert energies.index(max(energies)) == 39

def test_the_columns_of_the_lesson_are_those_of_its_films() -> None:
    picture, = re.findall(r"with `(width_px=\d+ m_to_px=[\d.]+)` at the end", LESSON)
    lines = shown(f"1 {picture}").lines
    columns = [line.find("*") - line.index("|") for line in lines]
    turns = [max(columns[:70]), max(columns[70:120]), max(columns[125:160]), max(columns[165:185])]
    assert turns == figures(LESSON, r"starts and turns: (\d+), (\d+), (\d+) and (\d+)")
    ends_s, = figures(LESSON, r"After ([\d.]+) s the film would end by itself")
    assert ends_s == pytest.approx(len(lines) / 30, abs=0.05)
    lines = shown(f"16 {picture} --frames=52").lines
    assert "o" not in lines[51]
    apart = figures(LESSON, r"In line 40 they are (\d+) columns apart")
    assert [lines[39].index("*") - lines[39].index("o")] == apart
    lines = shown(f"13 motion=backward {picture} --frames=15").lines
    assert "o" not in lines[0]
    apart = figures(LESSON, r"In line 15 this is 15 cm, so (\d+) columns")
    assert [lines[14].index("o") - lines[14].index("*")] == apart
    assert [lines[14].index("+") - lines[14].index("o")] == apart

# The exercises.

def energy_of_the_engine(changes: str) -> float:
    """In J/kg, after 8000 frames with CR = 1, with some of its functions replaced."""
    code = block(README, "def settle(").partition("\ntry:")[0]
    code = code.replace("while True:", "for _ in range(8000):").replace("CR=0.8", "CR=1.0")
    code = re.sub(r"        (print|time).*\n", "", code) + "    return x_m, v_mps\n"
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

def test_the_hops_of_exercise_4_and_the_hops_and_turns_of_the_lab() -> None:
    car = filmed(20, 60, CR=0.6, motion="forward", correction="surface")
    assert hops(car)[:6] == figures(EXERCISES, r"hops of (\d+) (\d+) (\d+) (\d+) (\d+) (\d+) 6 …")
    rests = shown("12 CR=0.9 correction=replay auto_off=False --frames=270").rows["*"]
    assert figures(rests, r"from frame (\d+)")[0] / 10 == pytest.approx(
        figures(EXERCISES, r"at about ([\d.]+) s, because")[0], abs=0.3)
    assert figures(EXERCISES, r"If a frame is over ([\d.]+) s late") == [airtrack.STALL_S]
    words = block(EXERCISES, "x_m=1.5").split()[4:]
    car = filmed(99, 500, **{name: airtrack.value_of(name, text)
                             for name, text in [word.split("=") for word in words]})
    rows = re.findall(r"(?m)^\| \d \| (\d+) \| ([\d.]+) \| ([\d.]+) m \| ([\d.]+) m \|$", EXERCISES)
    for number, (lines, formula_lines, turn_m, formula_m) in enumerate(rows):
        assert hops(car)[number] == int(lines)
        assert f"{tops_m(car.places_m)[number]:.2f}" == turn_m
        hop_s = 2 * 0.9 * sqrt(2 * 1.5 / 0.1) * 0.9**number
        assert [hop_s * 10, 1.5 * 0.81**(number + 1)] == pytest.approx(
            [float(formula_lines), float(formula_m)], abs=0.051)
