"""The command line: what it does, and what it says to whatever it should not be given."""

import os
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest

import airtrack
from airtrack import Scene, main
from examples import EXAMPLES
from films import COMMAND, HERE, environment, film, program

Capture = pytest.CaptureFixture[str]

# A bad command line, and what its one sentence must name: input, range, nearest right name.
BAD = [
    ("x_m=5000", ["x_m", "5000", "from -1000 to 1000 m"]),
    ("x_m=nan", ["x_m", "nan", "from -1000 to 1000 m"]),
    ("x_m=1e999", ["x_m", "inf", "from -1000 to 1000 m"]),
    ("x_m=", ["x_m", "''", "from -1000 to 1000 m"]),
    ("x_m=one", ["x_m", "'one'", "from -1000 to 1000 m"]),
    ("x_m=1,5", ["x_m", "'1,5'", "from -1000 to 1000 m"]),
    ("x_m=1=2", ["x_m", "'1=2'"]),
    ("CR=1.01", ["CR", "1.01", "from 0 to 1"]),
    ("cr=0.5", ["'cr'", "nearest: CR"]),
    ("fps=10", ["'fps'", "nearest: fps_target"]),
    ("v=3", ["'v'", "nearest: v_mps"]),
    ("=3", ["''", "nearest:"]),
    ("fps_target=0", ["fps_target", "0.0", "from 0.1 to 1000"]),
    ("m_to_px=0", ["m_to_px", "0.0", "above 0", "1000 px/m"]),
    ("width_px=99.5", ["width_px", "'99.5'", "whole", "10 to 1000"]),
    ("width_px=5", ["width_px", "5", "10 to 1000"]),
    ("motion=bakward", ["motion", "'bakward'", "forward, backward or exact", "nearest: backward"]),
    ("correction=Replay", ["correction", "'Replay'", "nearest: replay"]),
    ("auto_off=no", ["auto_off", "'no'", "False or True"]),
    ("8 left_edge_m=2.2", ["left_edge_m", "right_edge_m", "0.01 m", "2.2"]),
    ("8 correction=replay", ["motion", "exact", "'backward'"]),
    ("4 motion=exact correction=replay", ["x_m", "0.25 to 2.2", "0.2"]),
    ("x_m=1 x_m=2", ["x_m", "twice"]),
    ("3.5", ["'3.5'", f"0 to {max(EXAMPLES)}"]),
    ("ten", ["'ten'", f"0 to {max(EXAMPLES)}", "nearest:"]),
    ("D", ["'D'", "nearest: d"]),
    ("3 4", ["3 and 4", "one EXAMPLE"]),
    ("10 -d", ["'-d'", "nearest: d"]),
    ("CR = 0.9", ["'CR'", "nearest: CR=VALUE"]),
    ("frames=5", ["'frames'", "nearest: --frames"]),
    ("chart d", ["d", "chart"]),
    ("chart 3 --fast", ["--fast", "chart"]),
    ("stability --frames 5", ["--frames", "stability"]),
    ("stability --save map.png", ["--save", "chart"]),
    ("7 --save film.png", ["--save", "chart"]),
    ("chrat", ["'chrat'", "nearest: chart"]),
    ("stabillity 3", ["'stabillity'", "nearest: stability"]),
    ("3 chart", ["'chart'"]),
    ("chart 3 x_m=1001", ["x_m", "1001", "from -1000 to 1000 m"]),
    ("chart --save", ["--save"]),
    ("chart --save no_such_folder/chart.png", ["--save", "no_such_folder/chart.png"]),
    ("chart --save chart.doc", ["--save", "chart.doc", "png", "svg"]),
    ("--fats", ["'--fats'", "nearest: --fast"]),
    ("--frame 5", ["'--frame'", "nearest: --frames"]),
    ("-x", ["'-x'", "nearest:"]),
    ("--frames 0", ["'0'", "from 1 up"]),
    ("--frames -3", ["'-3'", "from 1 up"]),
    ("--frames 2.5", ["'2.5'", "from 1 up"]),
    ("--frames", ["--frames"]),
    ("--frames=", ["--frames", "''", "from 1 up"]),
    ("--fast=yes", ["--fast", "'yes'"]),
]


@pytest.fixture
def no_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing must run on a bad command line."""
    monkeypatch.setattr(airtrack, "run", lambda *_: pytest.fail("it ran"))


@pytest.mark.usefixtures("no_run")
@pytest.mark.parametrize(("words", "named"), BAD, ids=[words for words, _ in BAD])
def test_a_bad_command_line_is_answered_in_one_sentence(
        words: str, named: list[str], capsys: Capture) -> None:
    assert main(words.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("airtrack.py: error: ")
    assert err.count("\n") == 1
    for part in named:
        assert part in err


@pytest.mark.usefixtures("no_run")
@pytest.mark.parametrize("word", ["", " ", "a\nb", "x_m=\n", "\x00", "\u00e4", "9" * 5000, "--\n"])
def test_so_is_a_strange_one(word: str, capsys: Capture) -> None:
    assert main([word]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("airtrack.py: error: ")
    assert err.count("\n") == 1


def test_a_bad_command_line_of_a_whole_process() -> None:
    done = program("motion=bakward")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == ("airtrack.py: error: motion must be forward, backward or exact, "
                           "not 'bakward'; nearest: backward\n")


def test_help_lists_every_example_and_every_setting_with_unit_default_and_range(
        capsys: Capture) -> None:
    assert main(["-h"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    for number, example in EXAMPLES.items():
        assert f" {number} {example.title}" in text
    for f in fields(Scene):
        assert f"{f.name} {f.default}" in text
        assert f.metadata["allowed"] in text
    for unit in ("m/s ", "m/s^2 ", "px/m ", "1/s ", "px "):
        assert unit in text


def test_help_is_no_wider_than_the_terminal() -> None:
    for columns in (80, 120):
        done = program("-h", COLUMNS=str(columns))
        assert max(len(line) for line in done.stdout.splitlines()) <= columns


def test_a_whole_number_that_is_no_example_runs_the_default_scene(capsys: Capture) -> None:
    for number in ("99", "-3"):
        intro, lines, _ = film(capsys, number, "--frames", "3")
        assert f"There is no example {number}" in intro
        assert [line.index("*") for line in lines] == [61] * 3


def test_settings_come_on_top_of_the_example(capsys: Capture) -> None:
    intro, lines, _ = film(capsys, "10", "d", "x_m=1", "v_mps=2", "a_mps2=0", "--frames", "1")
    assert "x_m=1.0, v_mps=2.0, a_mps2=0.0," in intro
    assert lines[0].endswith("x =   1.20, v =  2.00, FPS =  10")
    assert "motion=exact, correction=replay" in " ".join(intro.split())
    assert ": The exact solution, x_m=1.0, v_mps=2.0, a_mps2=0.0\n" in intro
    assert "(So it is without your changes.)" in " ".join(intro.split())
    assert "without your changes" not in film(capsys, "10", "d", "--frames", "1").intro


def test_words_and_options_come_in_any_order(capsys: Capture) -> None:
    assert film(capsys, "10", "d", "CR=0.5", "--frames", "20") == \
        film(capsys, "--frames=20", "CR=0.5", "d", "10")


def test_switches_are_read_in_any_case(capsys: Capture) -> None:
    intro = film(capsys, "10", "show_start_mark=false", "auto_off=FALSE", "--frames", "1").intro
    assert "show_start_mark=False" in intro
    assert "auto_off=False" in intro


def test_the_header_names_everything_that_a_run_starts_from(capsys: Capture) -> None:
    intro = film(capsys, "9", "d", "CR=0.5", "--frames", "1").intro
    assert intro.startswith(f"Example 9: {EXAMPLES[9].title}, CR=0.5\n")
    scene = Scene(**EXAMPLES[9].settings | {"CR": 0.5})
    named = [f"{f.name}={getattr(scene, f.name)}" for f in fields(scene)]
    assert ", ".join(named) + "; details on" in " ".join(intro.split())
    assert EXAMPLES[9].look_for in " ".join(intro.split())


def test_fast_does_not_even_import_pygame() -> None:
    code = ("import sys, airtrack; airtrack.main(['10', '--fast', '--frames', '5']); "
            "sys.exit('pygame' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code], cwd=HERE, capture_output=True,
                          check=False).returncode == 0


def test_a_run_ends_after_50_000_frames_by_itself(capsys: Capture) -> None:
    _, lines, ending = film(capsys, "2")
    assert len(lines) == 50_000
    assert ending == "Stopped after 50000 frames: that is the frame limit."


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
@pytest.mark.parametrize("words", [
    "stability", "chart", "-h", "10 --fast --frames 3", "0 --frames 3"])
def test_a_reader_that_never_reads_is_no_error(words: str) -> None:
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "w") as pipe:
        done = subprocess.run([*COMMAND, *words.split()], stdout=pipe, stderr=subprocess.PIPE,
                              text=True, env=environment(), check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_reader_that_leaves_early_is_no_error() -> None:
    for words in ("7 --fast", "10"):
        with subprocess.Popen([*COMMAND, *words.split()], stdout=subprocess.PIPE, text=True,
                              stderr=subprocess.PIPE, env=environment()) as head:
            assert head.stdout is not None
            assert head.stderr is not None
            head.stdout.readline()
            head.stdout.close()
            assert head.stderr.read() == ""
            assert head.wait(timeout=60) == 0


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
def test_a_closed_standard_output_is_one_sentence() -> None:
    done = subprocess.run(["sh", "-c", 'exec "$@" >&-', "sh", *COMMAND, "10", "--fast"],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == "airtrack.py: error: there is no standard output to draw on\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_one_sentence() -> None:
    for words in ("10 --fast", "10", "stability", "chart"):
        with Path("/dev/full").open("w") as full:
            done = subprocess.run([*COMMAND, *words.split()], stdout=full, text=True,
                                  stderr=subprocess.PIPE, env=environment(), check=False)
        assert done.returncode == 2
        assert done.stderr == ("airtrack.py: error: cannot write: "
                               "[Errno 28] No space left on device\n")


def test_without_pygame_one_line_says_so_and_the_film_runs(tmp_path: Path) -> None:
    (tmp_path / "pygame.py").write_text("raise ImportError")
    done = program("0", "--frames", "2", PYTHONPATH=str(tmp_path), DISPLAY=":0")
    assert done.stderr == ""
    assert done.stdout.splitlines()[0] == "No window for the keys: pygame is not installed."
    assert len(done.stdout.splitlines()) == 4


def test_without_a_display_one_line_says_so_and_the_film_runs() -> None:
    for changes in ({}, {"DISPLAY": ":0", "SDL_VIDEODRIVER": "dummy"},
                    {"DISPLAY": ":0", "SDL_VIDEODRIVER": "offscreen"},
                    {"DISPLAY": ":0", "SDL_VIDEODRIVER": "nonsense"},
                    {"DISPLAY": ":4711", "XDG_RUNTIME_DIR": None}):
        done = program("0", "--frames", "2", **changes)
        assert done.stderr == ""
        assert done.stdout.splitlines()[0] == "No window for the keys: there is no display."
        assert len(done.stdout.splitlines()) == 4
