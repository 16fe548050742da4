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
from airtrack import Scene
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


def test_the_film_as_text_is_the_program_s(capsys: Capture) -> None:
    words, = re.findall(r"`python airtrack.py (16 --fast [^`]*)`", README)
    assert listing("*  .     |").splitlines() == [
        line.rstrip() for line in film(capsys, *words.split()).lines]


def test_the_lines_of_python_print_what_it_says() -> None:
    with redirect_stdout(io.StringIO()) as out:
        exec(listing("from airtrack import"), {})
    assert out.getvalue() == listing("after 11.9 s")


def test_the_map_and_the_chart_s_errors_are_those_of_the_program() -> None:
    assert listing("X  out") in printed("stability", "10")
    figures = [re.findall("[0-9.]+e[+-][0-9]+", text) for text in (
        listing("FPS  error m"), printed("chart", "10"))]
    assert len(figures[0]) == 45
    assert figures[0] == figures[1]


def test_the_examples_are_those_of_the_program() -> None:
    rows = re.findall(r"^\| ([0-9]+) \| (.*) \|$", README, re.MULTILINE)
    assert rows == [(str(number), example.title) for number, example in EXAMPLES.items()]


def test_the_hops_are_counted_in_the_table_and_in_the_exercise() -> None:
    table = re.findall(r"^\| (\w+): \S+ \| (\d.*) \| (\d.*) \| (\d.*) \|$", README, re.MULTILINE)
    assert [motion for motion, *_ in table] == ["forward", "exact", "backward"]
    told = [(19, motion, correction, cell) for motion, *cells in table
            for correction, cell in zip(("none", "surface", "rebound"), cells, strict=True)]
    answers = re.findall(": ([0-9 ]+) \u2026 lines", README)
    told += [(13, "backward", correction, answer) for correction, answer in zip(
        ("surface", "none"), answers, strict=True)]
    w_mps = math.sqrt(0.098**2 + 2 * 2 * (0.84 - 0.25))
    assert f"{2 * w_mps / (2 * 0.1):.1f} lines" in README  # in truth
    for number, motion, correction, cell in told:
        lines = [int(text) for text in re.findall("[0-9]+", cell.partition(" \u2026")[0])]
        assert len(lines) >= 3
        scene = Scene(**EXAMPLES[number].settings | {"motion": motion, "correction": correction})
        assert lines_between_bounces(scene, 200)[:len(lines)] == lines


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
