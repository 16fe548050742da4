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
    ("x_m=1,5", ["x_m", "'1,5'", "from -1000 to 1000 m"]),
    ("x_m=1=2", ["x_m", "'1=2'"]),
    ("x_m=1_0", ["x_m", "'1_0'"]),
    ("x_m=\u0661", ["x_m", "'\u0661'"]),
    ("CR=1.01", ["CR", "1.01", "from 0 to 1"]),
    ("cr=0.5", ["'cr'", "nearest: CR"]),
    ("fps_taget=10", ["'fps_taget'", "nearest: fps_target"]),
    ("=3", ["''", "-h"]),
    ("fps_target=0", ["fps_target", "0.0", "from 0.1 to 1000"]),
    ("m_to_px=0", ["m_to_px", "0.0", "from 0.001 to 1000 px/m"]),
    ("width_px=99.5", ["width_px", "'99.5'", "whole", "10 to 1000"]),
    ("width_px=5", ["width_px", "5", "10 to 1000"]),
    ("motion=bakward", ["motion", "'bakward'", "forward, backward or exact"]),
    ("correction=Replay", ["correction", "'Replay'", "none, surface, rebound, rewind or replay"]),
    ("auto_off=no", ["auto_off", "'no'", "False or True"]),
    ("8 left_edge_m=2.2", ["left_edge_m", "right_edge_m", "0.01 m", "2.2"]),
    ("8 correction=rewind", ["motion", "exact", "'backward'"]),
    ("4 motion=exact correction=replay", ["x_m", "0.25 to 2.2", "0.2"]),
    ("3.5", ["'3.5'", f"0 to {max(EXAMPLES)}"]),
    ("ten", ["'ten'", f"0 to {max(EXAMPLES)}", "-h"]),
    ("D", ["'D'", "nearest: d"]),
    ("3 4", ["3 and 4", "one EXAMPLE"]),
    ("10 -d", ["'-d'", "nearest: d"]),
    ("CR = 0.9", ["'CR'", "nearest: CR=VALUE"]),
    ("frames=5", ["'frames'", "nearest: --frames"]),
    ("chart d", ["d is for a film, not for chart"]),
    ("chart 3 --fast", ["--fast is for a film, not for chart"]),
    ("stability --frames 5", ["--frames is for a film, not for stability"]),
    ("stability --save map.png", ["--save is for chart, not for stability"]),
    ("7 --save film.png", ["--save is for chart, not for a film"]),
    ("chrat", ["'chrat'", "nearest: chart"]),
    ("stabillity 3", ["'stabillity'", "nearest: stability"]),
    ("3 chart", ["'chart'", "first word", "python airtrack.py chart 10"]),
    ("chart 3 x_m=1001", ["x_m", "1001", "from -1000 to 1000 m"]),
    ("chart --save", ["--save"]),
    ("--fats", ["'--fats'", "nearest: --fast"]),
    ("--frame 5", ["'--frame'", "nearest: --frames"]),
    ("-x", ["'-x'", "-h"]),
    ("--frames 0", ["'0'", "from 1 up"]),
    ("--frames -3", ["'-3'", "from 1 up"]),
    ("--frames 2.5", ["'2.5'", "from 1 up"]),
    ("--frames \u0661", ["'\u0661'", "from 1 up"]),
    ("--frames " + "0" * 5000, ["'0", "from 1 up"]),
    ("--frames", ["--frames", "from 1 up"]),
    ("--frames=", ["--frames", "''", "from 1 up"]),
    ("--fast=yes", ["--fast", "'--fast=yes'"]),
]


@pytest.fixture
def no_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing must run on a bad command line."""
    for name in ("film", "chart", "stability"):
        monkeypatch.setattr(airtrack, name, lambda *_: pytest.fail("it ran"))


@pytest.mark.usefixtures("no_run")
@pytest.mark.parametrize(("words", "named"), BAD, ids=[words[:30] for words, _ in BAD])
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
                           "not 'bakward'\n")


@pytest.mark.parametrize(("words", "weak"), [
    ("speed=2", "use_observed_dt"), ("v=3", "v_mps"), ("motion=bakward", "nearest"),
    ("10 chart", "nearest: chart"), ("qqq", "nearest")])
def test_a_hint_that_is_not_near_or_repeats_what_is_said_is_not_given(
        words: str, weak: str, capsys: Capture) -> None:
    assert main(words.split()) == 2
    assert weak not in capsys.readouterr().err


def test_of_what_is_repeated_the_last_one_holds(capsys: Capture) -> None:
    twice = film(capsys, "10", "--frames", "5", "--frames=6", "CR=1", "CR=0.5", "d", "d", "--fast")
    assert len(twice.lines) == 6
    assert "CR = 0.5" in twice.intro


def test_a_fault_in_the_program_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def fault(*_: object) -> None:
        raise ValueError("a bug")

    monkeypatch.setattr(airtrack, "render_track", fault)
    with pytest.raises(ValueError, match="a bug"):
        main(["10", "--fast"])


def test_help_lists_every_example_and_every_setting_with_unit_default_and_range(
        capsys: Capture) -> None:
    assert main(["-h"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    for number, example in EXAMPLES.items():
        assert f" {number} {example.title}" in text
    for f in fields(Scene):
        assert f"{f.name} {f.default}" in text
        assert f.metadata["meaning"] in text
    for ranges in ("from -1000 to 1000 m/s ", "to 1000 m/s^2 ", "from 0.001 to 1000 px/m ",
                   "from 0.1 to 1000 1/s ", "whole, from 10 to 1000 px", "from 0 to 1 "):
        assert ranges in text


def test_help_is_no_wider_than_the_terminal() -> None:
    for columns in (80, 120):
        done = program("-h", COLUMNS=str(columns))
        assert max(len(line) for line in done.stdout.splitlines()) <= columns


def test_a_whole_number_that_is_no_example_runs_the_default_scene(capsys: Capture) -> None:
    for number in ("99", "-3"):
        intro, lines, _ = film(capsys, number, "--frames", "3")
        assert f"There is no example {number} (they are 0 to 16)" in intro
        assert [line.index("*") for line in lines] == [61] * 3


def test_settings_come_on_top_of_the_example(capsys: Capture) -> None:
    intro, lines, _ = film(capsys, "10", "d", "x_m=1", "v_mps=2", "a_mps2=0", "--frames", "1")
    assert lines[0].endswith("x =   1.20, v =  2.00, FPS =  10")
    assert intro.startswith("Example 10: The exact solution, x_m=1.0, v_mps=2.0, a_mps2=0.0. ")
    assert "Motion exact, correction rewind" in intro
    warning = "about the example as it is"
    assert intro.index(warning) < intro.index(EXAMPLES[10].look_for)
    assert warning not in film(capsys, "10", "--frames", "1").intro


def test_words_and_options_come_in_any_order(capsys: Capture) -> None:
    assert film(capsys, "10", "d", "CR=0.5", "--frames", "20") == \
        film(capsys, "--frames=20", "CR=0.5", "d", "10")


def test_switches_are_read_in_any_case(capsys: Capture) -> None:
    intro = film(capsys, "10", "show_start_mark=false", "auto_off=FALSE", "--frames", "1").intro
    assert "10 frames a second, auto_off=False. " in intro


@pytest.mark.parametrize(("words", "told"), [
    ("9 CR=0.5", "The car starts at x = 2 m, at rest, pulled to the left at 2 m/s^2; CR = 0.5. "
     "Motion backward, correction rebound, 10 frames a second, use_observed_dt=True, "
     "show_start_mark=True. "),
    ("99 v_mps=-3 a_mps2=1.5", "The car starts at x = 1.1 m, moving to the left at 3 m/s, pulled "
     "to the right at 1.5 m/s^2; CR = 0.8. Motion backward, correction rebound, 30 frames a "
     "second. "),
    ("99 v_mps=0.5 a_mps2=-0.5", "The car starts at x = 1.1 m, moving to the right at 0.5 m/s, "
     "pulled to the left at 0.5 m/s^2; CR = 0.8. "),
    ("15", "The car starts at x = 1.65 m, moving to the right at 40 m/s, not pulled; CR = 1. "
     "Motion exact, correction replay, 10 frames a second. ")])
def test_the_header_says_in_words_all_that_a_run_starts_from(
        words: str, told: str, capsys: Capture) -> None:
    assert told in film(capsys, *words.split(), "--frames", "1").intro


@pytest.mark.parametrize("number", [n for n, example in EXAMPLES.items() if example.pause_s])
def test_the_header_has_four_lines_at_the_most(number: int) -> None:
    out = program(str(number), "--fast", "--frames", "1", COLUMNS="80").stdout
    header = out[:out.index(EXAMPLES[number].look_for[:20])]
    assert header.count("\n") <= 4
    assert max(map(len, out.split("\n\n")[0].splitlines())) <= 80


def test_the_one_pager_says_what_it_is_and_which_keys_there_are_and_nothing_under_fast() -> None:
    lines = program("--frames", "3").stdout.splitlines()
    assert lines[0].startswith("An air track: * is the car, | are the walls")
    assert "Keys: Ctrl-C quits." in lines
    frames = lines[lines.index("") + 1:-1]
    assert len(frames) == 3
    fast = program("--frames", "3", "--fast").stdout.splitlines()[:3]
    assert [line[:126] for line in fast] == [line[:126] for line in frames]


def test_fast_does_not_even_import_pygame() -> None:
    code = ("import sys, airtrack; airtrack.main(['10', '--fast', '--frames', '5']); "
            "sys.exit('pygame' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code], cwd=HERE, capture_output=True,
                          check=False).returncode == 0


def test_a_run_ends_after_50_000_frames_by_itself(capsys: Capture) -> None:
    _, lines, ending = film(capsys, "2")
    assert len(lines) == 50_000
    assert ending == "Stopped after 50000 frames, t = 1666.67 s: that is the frame limit."


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
    for words in ("10 --fast", "10", "-h"):
        with Path("/dev/full").open("w") as full:
            done = subprocess.run([*COMMAND, *words.split()], stdout=full, text=True,
                                  stderr=subprocess.PIPE, env=environment(), check=False)
        assert done.returncode == 2
        assert done.stderr == ("airtrack.py: error: cannot write: "
                               "[Errno 28] No space left on device\n")


def test_python_P_finds_the_examples() -> None:
    done = subprocess.run([COMMAND[0], "-P", COMMAND[1], "10", "--fast", "--frames", "1"],
                          capture_output=True, text=True, env=environment(), check=False)
    assert (done.returncode, done.stderr) == (0, "")
