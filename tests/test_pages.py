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
from airtrack import Track, main, step, verdict
from examples import EXAMPLES
from films import HERE, bounces, compared, filmed, furthest_m, hops, shown, tops_m, true_m

FILES = {path.name: path for path in (HERE / "README.md", *sorted(HERE.glob(".github/*.md")))}
PAGES = {name: path.read_text(encoding="utf-8") for name, path in FILES.items()}
README, CURE_PAGE, LAW = PAGES["README.md"], PAGES["cure.md"], PAGES["law.md"]
LESSON, EXERCISES = PAGES["lesson.md"], PAGES["exercises.md"]
COMMANDS = sorted(set(re.findall(
    r"(?:python3?|py|uv run) airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", "".join(PAGES.values())))
    - {"-h"})

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

@pytest.mark.parametrize("page", PAGES)
def test_no_command_is_broken_over_two_lines(page: str) -> None:
    for line in re.sub("(?ms)^```.*?^```", "", PAGES[page]).splitlines():
        assert line.count("`") % 2 == 0, line

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

def test_the_lines_of_the_first_film_are_the_program_s() -> None:
    words, = re.findall(r"`python3 airtrack\.py (10 d m_to_px[^`]*)`", README)
    assert block(README, "v = -2.20").splitlines() == shown(f"{words} --frames=18").lines[10:]

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

def test_the_rows_of_the_map_are_the_program_s() -> None:
    head, *rows = block(README, "480 FPS").splitlines()
    rates = [int(fps) for fps in head.split()[:-1]]
    assert len(rows) == 4
    for row in rows:
        motion, _, correction, *letters = row.split()
        track = compared(12, motion, correction)
        for fps, letter in zip(rates, letters, strict=True):
            runs = [verdict(track, airtrack.beside(true, track), true, 1 / 55)
                    for true in airtrack.ten_true_runs(track, fps)]
            assert airtrack.worst_of(runs) == letter

@pytest.mark.parametrize(("letter", "fps"), [("a", 480), ("c", 240), ("d", 5)])
def test_a_method_stays_within_a_column_from_the_rate_that_is_told(letter: str, fps: int) -> None:
    errors_m = {}
    for rate in (fps, airtrack.CHART_FPS[airtrack.CHART_FPS.index(fps) - 1]):
        track = compared(12, **airtrack.METHODS[letter])
        errors_m[rate] = max(airtrack.furthest_m(airtrack.beside(true, track), true)
                             for true in airtrack.ten_true_runs(track, rate))
    at_fps_m, below_m = errors_m.values()
    assert at_fps_m <= 1 / 55 < below_m

def test_in_example_18_rewind_is_up_to_1_8_m_wrong() -> None:
    assert furthest_m(filmed(18, 80)) == pytest.approx(1.8, abs=0.05)

# The cure, as printed.

CURE = block(CURE_PAGE, "from math import sqrt")
PADDLE = block(CURE_PAGE, "u = (paddle")
IN_GAME = CURE.replace("if x < left + r", PADDLE + "if x < left + r")
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

@pytest.mark.parametrize("seed", range(20))
def test_a_paddle_takes_each_ball_and_gives_it_its_speed_even_in_a_corner(seed: int) -> None:
    rng = random.Random(seed)
    moved = compile(IN_GAME, "cure.md", "exec")
    u, CR = rng.uniform(-3, 3), rng.uniform(0, 1)
    face, came = 1.0, u + rng.uniform(0.1, 30)
    game = ball(CR=CR, g=0.0, old_paddle=face, paddle_top=2.0, paddle_bottom=3.0, ceiling=2.0,
                floor=3.0, x=face - rng.uniform(0.11, 1), vx=came, y=rng.uniform(2.1, 2.9),
                v=rng.choice([-20.0, 0.0, 20.0]))
    behind = game | {"x": face + 0.2, "vx": u}
    for _ in range(600):
        face += u / 60
        for each in (game, behind):
            each["paddle"] = face
            exec(moved, each)
        assert game["x"] <= face - 0.1 + 1e-12
        assert behind["x"] > face  # it does not jump
    assert game["vx"] == pytest.approx(u - CR * (came - u))

def test_the_figures_of_the_cure() -> None:
    # From 1 m, as the game's usual two lines move it.
    usual = CURE.replace("y += v*dt + g*dt*dt/2  # an exact move: first y,\nv += g*dt ",
                         "v += g*dt\ny += v*dt ")
    assert usual != CURE
    heights = heights_m(compile(usual, "cure.md", "exec"), 300)
    assert tops_m(heights)[:3] == pytest.approx([0.93, 0.86, 0.79], abs=0.005)
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
    assert late[-1] == pytest.approx(18, abs=1)
    for fps, high_px in ((30, 170), (60, 175)):
        v = y = top_px = 0.0
        v = -600.0
        while v < 0:
            v += 1000 / fps
            y += v / fps
            top_px = max(top_px, -y)
        assert top_px == pytest.approx(high_px)

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
        names["n"] = floor(q) + 1
        names["w"] = eval(W, names)
        names["depth"] = eval(DEPTH, names)
        is_close = q > 0.5 and abs(q - round(q)) < 1e-6
        found.append((names["n"], names["w"], names["depth"], is_close))
        H, u = eval(NEXT_H[correction], names), eval(NEXT_U[correction], names)
    return found

@pytest.mark.parametrize(("motion", "correction"), [
    ("forward", "surface"), ("forward", "rebound"), ("exact", "surface"), ("exact", "rebound"),
    ("backward", "surface"), ("backward", "rebound"), ("exact", "conserve")])
def test_the_forecast_foretells_2000_hops_of_each_pair(motion: str, correction: str) -> None:
    rng = random.Random(5)
    foretold = 0
    while foretold < 2000:
        g, dt, CR = rng.uniform(0.5, 20), rng.uniform(0.005, 0.2), rng.uniform(0, 1)
        H, u = rng.uniform(0, 2), rng.uniform(-3, 5)
        track = Track(x_m=H, v_mps=u, a_mps2=-g, CR=CR, left_edge_m=0, right_edge_m=1e6,
                      motion=motion, correction=correction)
        x_m, v_mps = H, u
        for n, w, depth_m, is_close in forecast(motion, correction, H, u, g, dt, CR, 10):
            if is_close:
                break  # the page's exception
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
    frames, true = car.frames, true_m(car)
    first, second = [frame for frame in frames if frame.mark_m is not None][:2]
    assert [first.t_s, second.t_s] == pytest.approx([1.3, 3.9])
    for bounce, lift_cm in ((first, 14), (second, 38)):
        assert bounce.mark_m is not None
        assert 100 * (bounce.x_m - bounce.mark_m) == pytest.approx(lift_cm)
    assert [frames[6].x_m, true[6]] == pytest.approx([1.58, 1.64])
    assert [frames[10].x_m, true[10]] == pytest.approx([0.90, 1.00])
    energies = [car.track.energy(frame.x_m, frame.v_mps) for frame in frames]
    assert [energies[0], energies[10]] == pytest.approx([3.5, 3.3])
    turns_m = tops_m([frame.x_m for frame in frames])
    assert turns_m[:4] == pytest.approx([1.88, 2.00] * 2)
    assert [true[52], frames[40].x_m, true[40]] == pytest.approx([1.99, 0.68, 0.33], abs=0.005)
    assert [frames[52].x_m, frames[26].v_mps, frames[52].v_mps] == pytest.approx([2, 0, 0])
    line = re.findall(r"(?m)^ 26  (.{71})", SHEET)[0]
    assert line.rindex(".") - line.index("*") == 4

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
    assert len(lines) == 251  # 8.4 s
    wall, = {line.index("|") for line in lines if line.index("|") < 50}
    columns = [line.find("*") - wall for line in lines]
    turns = [max(columns[:70]), max(columns[70:120]), max(columns[125:160]), max(columns[165:185])]
    assert turns == [71, 36, 19, 9]
    lines = drawn("16 --frames=52", 100, monkeypatch)
    line_40, line_52 = lines[39], lines[51]
    assert line_40.index("*") - line_40.index("o") == 15
    assert "o" not in line_52
    lines = drawn("13 motion=backward --frames=15", 100, monkeypatch)
    assert "o" not in lines[0]
    marks = {mark: lines[-1].index(mark) for mark in "*o+"}
    assert [marks["o"] - marks["*"], marks["+"] - marks["o"]] == [6, 6]
    line = drawn("10 --frames=14", 100, monkeypatch)[-1]
    wall = line.index("|")
    assert [wall - line.index("0"), line.index("*") - wall] == [8, 8]

def test_the_figures_of_the_other_films_of_the_lesson() -> None:
    for fps, seconds, least, most in ((10.0, 20, 3.02, 3.76), (100.0, 10, 3.44, 3.53)):
        car = filmed(8, round(seconds * fps), fps_target=fps)
        energies = [car.track.energy(frame.x_m, frame.v_mps) for frame in car.frames]
        assert [min(energies), max(energies)] == pytest.approx([least, most], abs=0.005)
    for motion, place_m, kept in (("forward", 1.87, 3.375), ("exact", 1.72, 3.075),
                                  ("backward", 1.57, 2.775)):
        car = filmed(13, 15, motion=motion)
        frame = car.frames[15]
        assert (frame.x_m, frame.v_mps) == pytest.approx((place_m, -0.52))
        assert car.track.energy(frame.x_m, frame.v_mps) == pytest.approx(kept, abs=0.001)
    car = filmed(10, 60)
    assert bounces(car)[0] == 14
    turns_m = tops_m([frame.x_m for frame in car.frames])
    assert all(2 - 0.0025 <= turn_m <= 2 for turn_m in turns_m)

# The exercises.

def energy_of_the_engine(changes: str) -> float:
    """In J/kg, after 8000 frames with CR = 1, with some of its functions replaced."""
    code = block(README, "def settle(").partition("\ntry:")[0]
    code = code.replace("while True:", "for _ in range(8000):").replace("CR=0.8", "CR=1.0")
    code = re.sub(r"        (line = draw|print|time).*\n", "", code)
    code += "    return x_m, v_mps\n"
    if "a_mps2, left_m" in changes:
        code = code.replace("settle(x_m, v_mps, left_m", "settle(x_m, v_mps, a_mps2, left_m")
    names: dict[str, Any] = {}
    exec(f"{code}\n{changes}\nx_m, v_mps = film(11.0, 17.0)", names)
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
    lies = airtrack.scene_of(EXAMPLES[12].settings | {"CR": 0.9, "correction": "replay"}).track
    assert step(lies, 2.0, 0.0, 25.2)[1] == 0
    assert step(lies, 2.0, 0.0, 25.0)[1] != 0
    exec(block(EXERCISES, "6.31"), {})
    moves, rests = [float(line.split()[1]) for line in capsys.readouterr().out.splitlines()]
    assert isfinite(moves)
    assert moves != 0
    assert rests == 0
    car = filmed(20, 60, CR=0.6, motion="forward", correction="surface")
    assert hops(car) == [11, 9, 8, 7, 6, 6]
    rows = re.findall(r"\| (0\.\d+) \| [\d.]+ \| (\d+) \| ([\d.]+) \|", EXERCISES)
    for (u, n, w), bounce in zip(rows, bounces(car), strict=False):
        assert float(u) == pytest.approx(car.frames[bounce].v_mps, abs=0.0006)
        assert float(w) == pytest.approx(0.2 * int(n) - float(u), abs=0.0006)
