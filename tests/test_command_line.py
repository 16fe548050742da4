"""The command line: what it does, and what it says to whatever it should not be given."""

import math
import os
import re
import shlex
import subprocess
import sys
from dataclasses import fields
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest

import airtrack
from airtrack import MOTIONS, Scene, main
from examples import EXAMPLES
from films import COMMAND, HERE, environment, film

Capture = pytest.CaptureFixture[str]
BELOW, ABOVE = math.nextafter(-1000, -2000), math.nextafter(1000, 2000)
YES_OR_NO = "False or True"

# Name, default, what is allowed, some values that are, and some that are not.
TABLE: list[tuple[str, Any, str, list[Any], list[Any]]] = [
    ("x_m", 1.1, "a number from -1000 to 1000", [-1000, 1000, 0], [BELOW, ABOVE, "1"]),
    ("v_mps", 0.0, "a number from -1000 to 1000", [-1000, 1000], [BELOW, ABOVE]),
    ("a_mps2", 0.0, "a number from -1000 to 1000", [-1000, 1000], [BELOW, ABOVE]),
    ("left_edge_m", 0.25, "a number from -1000 to 1000", [-1000, 2.19], [BELOW, ABOVE]),
    ("right_edge_m", 2.2, "a number from -1000 to 1000", [0.26, 1000], [BELOW, ABOVE]),
    ("CR", 0.8, "a number from 0 to 1", [0, 1, 0.5], [-1e-9, 1.0000001]),
    ("motion", "backward", " or ".join(MOTIONS), ["exact"], ["Exact", 1]),
    ("correction", "rebound", "none or surface or rebound or conserve or rewind or replay",
     ["none"], ["bounce", False]),
    ("fps_target", 30.0, "a number from 0.1 to 1000", [0.1, 1000], [0.0999, ABOVE]),
    ("use_observed_dt", False, YES_OR_NO, [False, True], ["True", 2]),
    ("jitter", 0.0, "a number from 0 to 0.9", [0, 0.9], [-0.001, 0.901]),
    ("auto_off", True, YES_OR_NO, [False, True], ["no", 1]),
    ("m_to_px", 55.0, "a number from 0.001 to 1000", [0.001, 1000], [0, 0.00099, ABOVE]),
    ("width_px", 135, "a whole number from 10 to 1000", [10, 1000], [9, 1001, 50.5, 50.0]),
    ("show_start_mark", False, YES_OR_NO, [False, True], ["yes"]),
    ("show_collision_mark", True, YES_OR_NO, [False, True], [3]),
    ("show_exact_mark", False, YES_OR_NO, [False, True], ["o"]),
    ("show_methods", False, YES_OR_NO, [False, True], ["abcde"]),
]


@pytest.mark.parametrize(("name", "default", "allowed", "good", "bad"), TABLE)
def test_a_scene_out_of_range_cannot_be_made(name: str, default: Any, allowed: str,
                                             good: list[Any], bad: list[Any]) -> None:
    assert getattr(Scene(), name) == default
    for value in good:
        assert getattr(Scene(**{name: value}), name) == value
    for value in (*bad, math.nan, math.inf, -math.inf, "", None):
        with pytest.raises(ValueError, match="must be") as error:
            Scene(**{name: value})
        assert str(error.value) == f"{name} must be {allowed}, not {value}"


def test_walls_are_at_least_a_centimetre_apart_round_off_aside() -> None:
    for left_m, right_m in ((0.05, 0.06), (2.2, 2.21), (-0.01, 0)):
        Scene(left_edge_m=left_m, right_edge_m=right_m)
        with pytest.raises(ValueError, match=r"^right_edge_m must be -?[0-9.]+ \+ 0\.01 or more"):
            Scene(left_edge_m=left_m + 1e-6, right_edge_m=right_m)


def test_h_prints_usage_examples_and_every_setting_with_default_range_and_meaning(
        capsys: Capture) -> None:
    assert main(["3", "d", "-h"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("usage: airtrack.py [-h] [-d] [--fast] [--frames N] [WORD ...]\n")
    for word in ("\n    chart  ", "\n    stability  ", "\n    d  "):
        assert word in text
    for number, example in EXAMPLES.items():
        assert f"\n  {number:2}  {example.title}\n" in text
    _, _, methods = text.partition("\nmotions and corrections:\n")
    assert max(len(line) for line in methods.splitlines()) <= 80
    methods, _, settings = methods.partition("\n\nsettings: ")
    names = re.findall(r"^  (\w+)  +[A-Z].*", methods, re.MULTILINE)
    assert names == [*MOTIONS, *airtrack.ALL_CORRECTIONS]
    rows = re.sub(r"\n {31}", " ", settings).splitlines()[1:]
    for row, (name, default, allowed, *_), field in zip(rows, TABLE, fields(Scene), strict=True):
        assert row.split()[:2] == [name, str(default)]
        assert row.endswith(f"{field.metadata['meaning']} ({allowed})")


OF_THE_TRACK = "x_m, v_mps, a_mps2, left_edge_m, right_edge_m, CR, m_to_px, width_px"
CHOOSES = f"it chooses methods and frame rates itself, and takes an EXAMPLE and {OF_THE_TRACK}"
WRONG = {  # a command line that is refused: what is said of it
    "x_m=5000": "x_m must be a number from -1000 to 1000, not 5000",
    "chart 3 v_mps=nan": "v_mps must be a number from -1000 to 1000, not nan",
    "CR=0,9": "CR must be a number from 0 to 1, not 0,9: write CR=0.9",
    "CR=7,5": "CR must be a number from 0 to 1, not 7,5",
    "width_px=99.5": "width_px must be a whole number from 10 to 1000, not 99.5",
    "auto_off=1": "auto_off must be False or True, not 1",
    "motion=euler": f"motion must be {' or '.join(MOTIONS)}, not euler",
    "10 left_edge_m=3": "right_edge_m must be 3.0 + 0.01 or more, not 2.2",
    "10 motion=forward": "motion must be exact with correction=rewind, not forward: "
                         "choose motion=exact or another correction",
    "12 x_m=0.2": "x_m must be from 0.25 to 2.2 with correction=rewind, not 0.2",
    "3 d 4": "one command and one EXAMPLE at a time, not [3, 4]",
    "chart stability": "one command and one EXAMPLE at a time, not ['chart', 'stability']",
    "chart d": f"chart takes no d, --fast or --frames: {CHOOSES}",
    "stability --fast": f"stability takes no d, --fast or --frames: {CHOOSES}",
    "stability 3 --frames 9": f"stability takes no d, --fast or --frames: {CHOOSES}",
    "stability 5 CR=0.5 motion=exact": f"stability takes no motion: {CHOOSES}",
    "--frames 0": "--frames N must be a whole number from 1 up, not 0",
    "--frames x": "argument --frames: invalid int value: 'x'",
    "--fats": "unknown word --fats: did you mean --fast?",
    "3 --fps=9": "unknown word --fps=9: did you mean fps_target=VALUE (frames a second; dt = "
                 "1/fps_target)?",
    "CR 0.7": "unknown word CR: write CR=0.7, without spaces",
    "10 CR = 0.7": "unknown word CR: write CR=0.7, without spaces",
    "CR:0.7": "unknown word CR:0.7: write CR=0.7, without spaces",
    "CR 7": "unknown word CR: write CR=VALUE, without spaces",
    "CR=": "unknown word CR=: write CR=VALUE, without spaces",
}
MEANT = {  # a word that is none: what was meant
    "dt=0.1": "did you mean fps_target=VALUE (frames a second; dt = 1/fps_target)?",
    "g=9.8": "did you mean a_mps2=VALUE (acceleration in m/s^2, to the right)?",
    "SPEED=3": "did you mean v_mps=VALUE (start velocity in m/s, to the right)?",
    "cr=0.5": "did you mean CR=VALUE (speed after a bounce / before it)?",
    "Maps": "did you mean stability?", "frames=9": "did you mean --frames?",
    "conserve": "did you mean correction=conserve?", "Exact": "did you mean motion=exact?",
    "widht=9": "did you mean width_px=VALUE (width of the picture in columns)?",
    "Stabilty": "did you mean stability?",
    "qqqq": "-h lists all that there are", "r=3": "-h lists all that there are",
    "=3": "-h lists all that there are", "12x": "-h lists all that there are",
}


@pytest.mark.parametrize(("words", "sentence"), [
    *WRONG.items(),
    *((f"10 {word}", f"unknown word {word}: {hint}") for word, hint in MEANT.items())])
def test_wrong_input_gets_the_usage_one_line_and_exit_status_2(
        words: str, sentence: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    for name in ("run", "simulate"):
        monkeypatch.setattr(airtrack, name, lambda *_: pytest.fail("it ran"))
    assert main(words.split()) == 2
    out, err = capsys.readouterr()
    usage, error = err.splitlines()
    assert (out, error) == ("", f"airtrack.py: error: {sentence}")
    assert usage.startswith("usage: airtrack.py ")


def test_an_example_that_is_not_there_is_a_scene_of_one_s_own_and_says_which_are(
        capsys: Capture) -> None:
    for number in ("23", "-1"):
        intro = film(capsys, number, "--frames=1").intro
        assert intro.startswith(f"Your own scene (the examples are 0 to {max(EXAMPLES)}) x_m=1.1 ")


def test_without_an_example_the_film_is_example_0_with_details(capsys: Capture) -> None:
    zero = film(capsys, "--frames=1")
    assert zero.intro.startswith("Example 0: ")
    assert "x =  11.25, v = 16.97" in zero.lines[0]


def test_a_minus_as_pages_print_it_is_read_as_a_minus(capsys: Capture) -> None:
    assert film(capsys, "10", "v_mps=\N{MINUS SIGN}1", "--frames=3") == film(
        capsys, "10", "v_mps=-1", "--frames=3")


def test_words_come_in_any_order_and_of_what_is_repeated_the_last_one_holds(
        capsys: Capture) -> None:
    wanted = film(capsys, "10", "d", "CR=0.5", "--frames", "6")
    assert len(wanted.lines) == 6
    for words in permutations(["10", "d", "CR=0.5", "--frames=6"]):
        assert film(capsys, *words) == wanted
    assert film(capsys, "--frames", "5", "CR=1", "d", "10", "CR=0.5", "d", "--frames=6") == wanted
    for details in ("-d", "D"):
        assert film(capsys, "10", details, "CR=0.5", "--frames", "6") == wanted


@pytest.mark.parametrize("command", ["chart", "stability"])
def test_a_command_comes_in_any_place_is_for_example_10_or_another_and_starts_on_the_track(
        command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Scene] = []
    monkeypatch.setitem(airtrack.COMMANDS, command, lambda scene, _: asked.append(scene))
    for words in ([command], *permutations([command, "3", "CR=0.5"]), [command, "12", "x_m=5"]):
        assert main([*words]) == 0
    example_10, *others, beyond = [(scene.x_m, scene.a_mps2, scene.CR) for scene in asked]
    assert example_10 == (2.0, -2.0, 1.0)
    assert others == 6 * [(2.0, -1.5, 0.5)]
    assert beyond == (2.2, -2.0, 0.8)


def test_settings_come_on_top_of_the_example(capsys: Capture) -> None:
    lines = film(capsys, "10", "d", "x_m=1", "v_mps=2", "a_mps2=0", "--frames", "1").lines
    assert lines[0][135:] == "x =   1.20, v =  2.00, FPS =  10, err =  0.00e+00"
    line = film(capsys, "16", "d", "--frames", "1").lines[0]  # x = 2 - 2 * 0.1**2, truly 1.99
    assert line[135:] == "x =   1.98, v = -0.20, FPS =  10, err = -1.00e-02"
    line = film(capsys, "99", "v_mps=3", "show_start_mark=TRUE", "--frames", "1").lines[0]
    assert line[round(1.1 * 55)] == "."


def test_fast_neither_waits_nor_tells_of_keys_nor_colours_nor_imports_pygame() -> None:
    code = ("import sys, time, airtrack; time.sleep = None; sys.stdout.isatty = lambda: True; "
            "airtrack.main(['10', '--fast', '--frames', '5']); sys.exit('pygame' in sys.modules)")
    done = subprocess.run([sys.executable, "-c", code], cwd=HERE, env=environment(COLUMNS="200"),
                          capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    header, lines, _ = done.stdout.split("\n\n")
    assert " ".join(header.split()).endswith(EXAMPLES[10].look_for)
    assert set(lines.partition("Stopped")[0]) == set(" |*.\n")


def test_without_frames_a_film_ends_after_50_000(capsys: Capture) -> None:
    assert film(capsys, "2").ending == (
        "Stopped after 50000 frames, t = 1666.67 s: that is the frame limit.")


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX pipe")
@pytest.mark.parametrize(("words", "lines"), [
    ("stability", 0), ("-h", 0), ("7 --fast", 1), ("10", 1)])
def test_a_reader_that_leaves_early_is_no_error(words: str, lines: int) -> None:
    with subprocess.Popen([*COMMAND, *words.split()], stdout=subprocess.PIPE, text=True,
                          stderr=subprocess.PIPE, env=environment()) as head:
        assert head.stdout is not None
        assert head.stderr is not None
        for _ in range(lines):
            head.stdout.readline()
        head.stdout.close()
        assert (head.stderr.read(), head.wait(timeout=60)) == ("", 0)


NEEDS_DEV_FULL = pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")


@NEEDS_DEV_FULL
def test_a_full_disk_is_one_line() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([*COMMAND, "10", "--fast"], stdout=full, text=True,
                              stderr=subprocess.PIPE, env=environment(), check=False)
    assert done.returncode == 2
    assert done.stderr == "airtrack.py: error: [Errno 28] No space left on device\n"


@NEEDS_DEV_FULL
@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
@pytest.mark.parametrize("errors_to", ["2>&-", "2>/dev/full"])
@pytest.mark.parametrize("words", ["CR=7", "CR=7 >&-", "10 --fast >/dev/full"])
def test_an_error_that_cannot_be_printed_still_exits_with_2(words: str, errors_to: str) -> None:
    command = f"{shlex.join(COMMAND)} {words} {errors_to}"
    assert subprocess.run(command, shell=True, env=environment(), check=False).returncode == 2
