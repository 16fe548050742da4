"""The command line: what it does, and what it says to whatever it should not be given."""

import math
import os
import re
import subprocess
import sys
from dataclasses import fields
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest

import airtrack
from airtrack import MOTIONS, SETTINGS, Scene, main
from examples import EXAMPLES
from films import COMMAND, HERE, environment, film

Capture = pytest.CaptureFixture[str]
BELOW, ABOVE = math.nextafter(-1000, -2000), math.nextafter(1000, 2000)
YES_OR_NO = "False or True"

# Name, default, what is allowed, some values that are, and some that are not.
TABLE: list[tuple[str, Any, str, list[Any], list[Any]]] = [
    ("x_m", 1.1, "a number from -1000 to 1000 m", [-1000, 1000, 0], [BELOW, ABOVE, "1"]),
    ("v_mps", 0.0, "a number from -1000 to 1000 m/s", [-1000, 1000], [BELOW, ABOVE]),
    ("a_mps2", 0.0, "a number from -1000 to 1000 m/s^2", [-1000, 1000], [BELOW, ABOVE]),
    ("left_edge_m", 0.25, "a number from -1000 to 1000 m", [-1000, 2.19], [BELOW, ABOVE]),
    ("right_edge_m", 2.2, "a number from -1000 to 1000 m", [0.26, 1000], [BELOW, ABOVE]),
    ("CR", 0.8, "a number from 0 to 1", [0, 1, 0.5], [-1e-9, 1.0000001]),
    ("motion", "backward", " or ".join(MOTIONS), [*MOTIONS], ["Exact", 1]),
    ("correction", "rebound", "none or surface or rebound or conserve or rewind or replay",
     ["none", "surface"], ["bounce", False]),
    ("fps_target", 30.0, "a number from 0.1 to 1000 1/s", [0.1, 1000], [0.0999, ABOVE]),
    ("use_observed_dt", False, YES_OR_NO, [False, True], ["True", 2]),
    ("jitter", 0.0, "a number from 0 to 0.9", [0, 0.9], [-0.001, 0.901]),
    ("auto_off", True, YES_OR_NO, [False, True], ["no", -1]),
    ("m_to_px", 55.0, "a number from 0.001 to 1000 px/m", [0.001, 1000], [0, 0.00099, ABOVE]),
    ("width_px", 135, "a whole number from 10 to 1000 px", [10, 1000], [9, 1001, 50.5, 50.0]),
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
        with pytest.raises(ValueError, match=r"^right_edge_m must be at least 0\.01 m to the "):
            Scene(left_edge_m=left_m + 1e-6, right_edge_m=right_m)


def test_h_prints_usage_examples_and_every_setting_with_default_unit_range_and_meaning(
        capsys: Capture) -> None:
    assert main(["-h"]) == 0
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= 80
    for part in ("python airtrack.py [EXAMPLE] [d] [NAME=VALUE ...] [--fast] [--frames N]",
                 "README.md", ".github/lesson.md"):
        assert part in text
    for number, example in EXAMPLES.items():
        assert f"\n  {number:2}  {example.title}\n" in text
    settings = re.sub(r"\n {31}", " ", text.partition("\nSettings")[2])
    for row, (name, default, allowed, *_), field in zip(
            settings.splitlines()[1:], TABLE, fields(Scene), strict=True):
        assert row.split()[:2] == [name, str(default)]
        assert row.endswith(f"{field.metadata['meaning']} ({allowed})")
    assert main(["3", "d", "--help"]) == 0
    assert capsys.readouterr().out == text


IT_MUST_BE = ("it must be the number of an EXAMPLE, d, chart, stability, an option or NAME=VALUE "
              "without spaces")
WRONG = {  # a command line that is refused: what is said of it
    "x_m=5000": "x_m must be a number from -1000 to 1000 m, not 5000.0",
    "chart 3 v_mps=nan": "v_mps must be a number from -1000 to 1000 m/s, not nan",
    "fps_target=": "fps_target must be a number from 0.1 to 1000 1/s, not ",
    "CR=0,9": "CR must be a number from 0 to 1, not 0,9: write 0.9",
    "m_to_px=1=2": "m_to_px must be a number from 0.001 to 1000 px/m, not 1=2",
    "width_px=99.5": "width_px must be a whole number from 10 to 1000 px, not 99.5",
    "auto_off=no": "auto_off must be False or True, not no",
    "motion=euler": f"motion must be {' or '.join(MOTIONS)}, not euler: did you mean forward or "
                    "backward?",
    "10 correction=exact": "correction must be none or surface or rebound or conserve or rewind or "
                           "replay, not exact: did you mean rewind or replay?",
    "10 left_edge_m=3": "right_edge_m must be at least 0.01 m to the right of left_edge_m, not 2.2 "
                        "and 3.0",
    "10 motion=forward": "motion must be exact with correction=rewind, not forward: "
                         "choose motion=exact or another correction",
    "12 x_m=0.2": "x_m must be from 0.25 to 2.2 with correction=rewind, not 0.2",
    "3 d 4": "one command and one EXAMPLE at a time, not [3, 4]",
    "chart 3 stability": "one command and one EXAMPLE at a time, not ['chart', 'stability', 3]",
    "chart d": "d, --fast and --frames are for a film, not for chart",
    "stability --fast": "d, --fast and --frames are for a film, not for stability",
    "stability 3 --frames 9": "d, --fast and --frames are for a film, not for stability",
    "--frames 0": "--frames N must be a whole number from 1 up, not 0",
    "--frames -5": "--frames N must be a whole number from 1 up, not -5",
    "--frames x": "argument --frames: invalid int value: 'x'",
    "--frames": "argument --frames: expected one argument",
    "chart motion=exakt": f"motion must be {' or '.join(MOTIONS)}, not exakt",
    "stability 10 x_m=9999": "x_m must be a number from -1000 to 1000 m, not 9999.0",
}
MEANT = {  # a word that is none: what was meant
    "fps=10": "fps_target", "dt=0.1": "use_observed_dt or fps_target",
    "g=9.8": "a_mps2", "gravity=9.8": "a_mps2", "zoom=20": "m_to_px",
    "cr=0.5": "CR", "v=3": "v_mps", "a=2": "a_mps2", "x=1": "x_m", "jiter=0.1": "jitter",
    "restitution=1": "CR", "fps_taget=10": "fps_target", "chrat": "chart",
    "stabilty": "stability", "map": "stability", "--fats": "--fast", "12d": "12 d",
    "motion": "motion", "rewind": "correction",
}
HINTS = {word: f"; did you mean {meant}?" for word, meant in MEANT.items()}
HINTS |= dict.fromkeys(("qqqq", "=3", "12x"), "")


@pytest.mark.parametrize(("words", "sentence"), [
    *WRONG.items(),
    *((f"10 {word}", f"unknown word {word}: {IT_MUST_BE}{hint}") for word, hint in HINTS.items())])
def test_wrong_input_gets_one_line_and_exit_status_2(
        words: str, sentence: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    for name in ("run", "simulate"):
        monkeypatch.setattr(airtrack, name, lambda *_: pytest.fail("it ran"))
    assert main(words.split()) == 2
    out, err = capsys.readouterr()
    assert (out, err) == ("", f"airtrack.py: error: {sentence}\n")


def test_motion_equals_exact_in_three_words_says_that_no_spaces_belong_there(
        capsys: Capture) -> None:
    assert main(["10", "motion", "=", "exact"]) == 2
    assert "NAME=VALUE without spaces; did you mean motion?" in capsys.readouterr().err


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
def test_a_command_comes_in_any_place_too_and_is_for_example_10_unless_another_is_named(
        command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Scene] = []
    monkeypatch.setattr(airtrack, command, lambda scene, *_: asked.append(scene))
    for words in ([command], *permutations([command, "3", "CR=0.5"])):
        assert main([*words]) == 0
    assert [(scene.a_mps2, scene.CR) for scene in asked] == [(-2.0, 1.0)] + 6 * [(-1.5, 0.5)]


@pytest.mark.parametrize("changes", ["motion=forward", "x_m=5", "correction=surface",
                                     "motion=forward correction=rewind"])
def test_chart_and_map_set_motion_and_correction_and_start_on_the_track(
        changes: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for command in ("chart", "stability"):
        scenes: list[Scene] = []
        monkeypatch.setattr(airtrack, command, lambda *args, to=scenes: to.append(args[0]))
        assert main([command, "12", *changes.split()]) == 0
        assert scenes[0].x_m == (2.2 if changes == "x_m=5" else 2.0)


def test_settings_come_on_top_of_the_example(capsys: Capture) -> None:
    intro, lines, _ = film(capsys, "10", "d", "x_m=1", "v_mps=2", "a_mps2=0", "--frames", "1")
    assert lines[0][135:] == "x =   1.20, v =  2.00, FPS =  10"
    assert intro.startswith("Example 10: The exact solution, x_m=1.0, v_mps=2.0, a_mps2=0.0 ")
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
    header, lines = done.stdout.split("\n\n")
    assert " ".join(header.split()).endswith(EXAMPLES[10].look_for)
    assert set(lines.partition("Stopped")[0]) == set(" |*.\n")


def test_without_frames_a_film_ends_after_50_000(capsys: Capture) -> None:
    assert film(capsys, "2").ending == (
        "Stopped after 50000 frames, t = 1666.67 s: that is the frame limit.")


def test_examples_py_imports_nothing_of_airtrack_py() -> None:
    code = "import sys, examples; sys.exit('airtrack' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], cwd=HERE, check=False).returncode == 0


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX pipe")
@pytest.mark.parametrize(("words", "lines"), [
    ("stability", 0), ("chart", 0), ("-h", 0), ("10 --fast --frames 3", 0), ("7 --fast", 1),
    ("10", 1)])
def test_a_reader_that_leaves_early_is_no_error(words: str, lines: int) -> None:
    with subprocess.Popen([*COMMAND, *words.split()], stdout=subprocess.PIPE, text=True,
                          stderr=subprocess.PIPE, env=environment()) as head:
        assert head.stdout is not None
        assert head.stderr is not None
        for _ in range(lines):
            head.stdout.readline()
        head.stdout.close()
        assert (head.stderr.read(), head.wait(timeout=60)) == ("", 0)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("words", ["10 --fast", "-h"])
def test_a_full_disk_is_one_line(words: str) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([*COMMAND, *words.split()], stdout=full, text=True,
                              stderr=subprocess.PIPE, env=environment(), check=False)
    assert done.returncode == 2
    assert done.stderr == "airtrack.py: error: [Errno 28] No space left on device\n"


def test_every_setting_is_one_that_a_user_finds_by_its_own_name() -> None:
    for name in SETTINGS:
        assert f"did you mean {name}?" in airtrack.unknown(name)
