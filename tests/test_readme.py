"""The README: what it shows is what the program shows, and what it lists runs."""

import importlib.metadata
import io
import math
import re
import shutil
import subprocess
import sys
from contextlib import redirect_stdout
from pathlib import Path

import pytest

import airtrack
from airtrack import SETTINGS, Scene
from examples import EXAMPLES
from figures import errors_m, printed
from films import HERE, environment, film, lines_between_bounces

Capture = pytest.CaptureFixture[str]
README = (HERE / "README.md").read_text(encoding="utf-8")
LISTINGS: list[str] = re.findall(r"^```\w*\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
COMMANDS = sorted(set(re.findall(r"python\s+airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", README)))


def listing(part: str) -> str:
    """The one listing that has the part."""
    found, = [text for text in LISTINGS if part in text]
    return found


def test_the_one_pager_is_a_page_and_shows_what_the_program_shows(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    code, slept_s = listing("def settle("), []

    def sleep(seconds: float) -> None:
        slept_s.append(seconds)
        if len(slept_s) == 600:
            raise KeyboardInterrupt

    monkeypatch.setattr("time.sleep", sleep)
    names: dict[str, object] = {}
    with redirect_stdout(io.StringIO()) as out:
        exec(code, names)
    assert code.count("\n") <= 40
    assert set(names) == {"__builtins__", "time", "move", "settle", "draw", "film"}  # no globals
    assert set(slept_s) == {0.015}
    *lines, ending = out.getvalue().splitlines()
    assert ending == "Stopped: Ctrl-C was pressed."
    shown = film(capsys, "--frames", "600").lines
    assert [line[:126] for line in lines] == [line[:126] for line in shown]


def test_the_film_as_it_is_met_is_the_program_s(capsys: Capture) -> None:
    words, = re.findall(r"`python airtrack.py (16 --fast [^`]*)`", README)
    assert listing("*  .     |").splitlines() == [
        line.rstrip() for line in film(capsys, *words.split()).lines]
    quoted = [quote.replace("\n> ", " ") for quote in re.findall(
        r"^> (.*?)$(?!\n>)", README, re.MULTILINE | re.DOTALL)]
    assert quoted == [EXAMPLES[16].look_for, EXAMPLES[16].seen]


def test_the_lines_of_python_print_what_it_says() -> None:
    with redirect_stdout(io.StringIO()) as out:
        exec(listing("from airtrack import"), {})
    assert out.getvalue() == listing("after 11.9 s")


def test_the_map_and_the_chart_s_errors_are_those_of_the_program() -> None:
    assert listing("X  out") in printed("stability", "10")
    shown, whole = (
        re.sub("  +[0-9.]+(?= |$)", "", text, flags=re.MULTILINE).splitlines()  # without the times
        for text in (listing("FPS  error m"), printed("chart", "10")))
    assert len(shown) == 9
    assert [line for line in whole if line in shown] == shown


def test_the_examples_are_those_of_the_program() -> None:
    rows = re.findall(r"^\| ([0-9]+) \| (.*) \| (.*) \| (.*) \| (.*) \|$", README, re.MULTILINE)
    scenes = {number: Scene(**example.settings) for number, example in EXAMPLES.items()}
    assert rows == [
        (str(number), EXAMPLES[number].title, f"{scene.motion} + {scene.correction}",
         f"{scene.fps_target:.3g}", f"{scene.CR:g}") for number, scene in scenes.items()]


def test_the_settings_have_the_units_and_defaults_of_the_program() -> None:
    rows = re.findall(r"^\| `(\w+)` \| .* \| (.*) ?\| (\S+) \|$", README, re.MULTILINE)
    assert len(rows) == 12
    for name, unit, default in rows:
        assert SETTINGS[name].metadata["unit"] == unit.strip().replace("\u00b2", "^2")
        assert str(SETTINGS[name].default) == default


def test_the_hops_are_counted_in_the_table_and_in_the_exercise() -> None:
    cell = r"\*\*\S+\*\*: (\d.*)"
    table = re.findall(rf"^\| (\w+): \S+ \| {cell} \| {cell} \| {cell} \|$", README, re.MULTILINE)
    told = [(19, 1.0, motion, correction, text) for motion, *cells in table
            for correction, text in zip(("none", "surface", "rebound"), cells, strict=True)]
    assert len(told) == 9
    answer, = re.findall(r"film:\s+([0-9 ]+) \u2026 lines", README)
    for number, CR, motion, correction, text in (*told, (20, 0.6, "forward", "surface", answer)):
        lines = [int(word) for word in re.findall("[0-9]+", text.partition(" \u2026")[0])]
        assert len(lines) >= 3
        scene = Scene(**EXAMPLES[number].settings | {
            "motion": motion, "correction": correction, "CR": CR})
        assert lines_between_bounces(scene, 200)[:len(lines)] == lines
    w_mps = math.sqrt(0.098**2 + 2 * 2 * (0.84 - 0.25))
    assert f"{2 * w_mps / (2 * 0.1):.1f} lines" in README  # in truth


def test_luck_and_the_exercises_end_as_it_says(capsys: Capture) -> None:
    at_rest = "the car is at rest against a wall"
    assert lines_between_bounces(Scene(**EXAMPLES[8].settings | {"correction": "surface"}),
                                 2000)[-20:] == [26] * 20
    assert re.search(rf"t = 36\.\d\d s: {at_rest}", film(capsys, "9", "correction=surface").ending)
    ending = film(capsys, "12", "CR=0.9", "correction=replay").ending
    assert f"t = 24.99 s: {at_rest}" in ending
    assert math.sqrt(1.75) * 1.9 / 0.1 == pytest.approx(25.1, abs=0.05)
    for words, worst_m in (("16", 0.9), ("16 v_mps=0.03", 1.7)):
        lines = film(capsys, *words.split(), "d", "--frames", "200").lines
        errors = [abs(float(line.partition("err = ")[2])) for line in lines]
        assert max(errors) == pytest.approx(worst_m, abs=0.05)


def test_the_rates_and_errors_of_which_method_when_are_those_of_the_chart() -> None:
    ten, twelve = (printed("chart", number) for number in ("10", "12"))
    assert re.search("^Within.*\n.* 10 +[0-9.]+ +10 +[0-9.]+$", ten, re.MULTILINE)
    assert re.search("^Within.*\n +960 ", twelve, re.MULTILINE)
    assert errors_m("12", "d")[0] == 1.8e-3 < errors_m("12", "a")[6]


def test_the_exercise_s_fourth_motion_has_the_letters_of_exact(tmp_path: Path) -> None:
    text = (HERE / "airtrack.py").read_text()
    for old, new in (
            ("MOTIONS = {", listing("def mean(") + "\nMOTIONS = {"),
            ('"exact": exact}', '"exact": exact, "mean": mean}')):
        assert text.count(old) == 1
        text = text.replace(old, new)
    (tmp_path / "airtrack.py").write_text(text)
    shutil.copy(HERE / "examples.py", tmp_path)
    out = subprocess.run(
        [sys.executable, "airtrack.py", "stability", "12"], cwd=tmp_path, text=True,
        capture_output=True, env=environment(), check=True).stdout
    rows = {name: letters.split() for name, letters in re.findall(
        r"^(\w+ \+ \w+) +(.*)$", out, re.MULTILINE)}
    for correction in ("none", "surface", "rebound"):
        assert len(rows[f"mean + {correction}"]) == 9
        assert rows[f"mean + {correction}"] == rows[f"exact + {correction}"]
    assert len(rows) == 14


def test_no_command_is_broken_over_two_lines() -> None:
    for line in re.sub("^```.*?^```", "", README, flags=re.MULTILINE | re.DOTALL).splitlines():
        assert line.count("`") % 2 == 0, line


@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_line_is_one(words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("film", "chart", "stability"):
        monkeypatch.setattr(airtrack, name, lambda *_: 0)
    assert airtrack.obey(words.split()) == 0


def test_pip_install_brings_the_dependencies_alone() -> None:
    try:
        files = importlib.metadata.files("airtrack") or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the project is not installed")
    assert [file.name for file in files if file.suffix == ".py"] == []
