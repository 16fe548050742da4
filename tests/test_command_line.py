"""The command line: what it does, and what it says to whatever it should not be given."""

import os
import subprocess
import sys
from itertools import permutations
from pathlib import Path

import pytest

import airtrack
from airtrack import SETTINGS, Scene, main
from examples import EXAMPLES
from films import COMMAND, HERE, environment, film

Capture = pytest.CaptureFixture[str]

WRONG = {  # a command line that is refused: what is said of it
    "x_m=5000": "x_m must be a number from -1000 to 1000 m, not 5000.0",
    "chart 3 v_mps=nan": "v_mps must be a number from -1000 to 1000 m/s, not nan",
    "fps_target=": "fps_target must be a number from 0.1 to 1000 1/s, not ''",
    "CR=0,5": "CR must be a number from 0 to 1, not '0,5': write 0.5",
    "m_to_px=1=2": "m_to_px must be a number from 0.001 to 1000 px/m, not '1=2'",
    "width_px=99.5": "width_px must be a whole number from 10 to 1000 px, not '99.5'",
    "correction=x,y": "correction must be none, surface, rebound, conserve, rewind or replay, not "
                      "'x,y'",
    "auto_off=no": "auto_off must be False or True, not 'no'",
    "10 left_edge_m=3": "right_edge_m must be at least 0.01 m to the right of left_edge_m, not 2.2 "
                        "and 3.0",
    "10 motion=forward": "motion must be exact with correction=rewind, not forward: "
                         "choose motion=exact, or another correction",
    "12 x_m=0.2": "x_m must be from 0.25 to 2.2 with correction=rewind, not 0.2",
    "3 d 4": "one EXAMPLE at a time, not both 3 and 4",
    "chart 3 stability": "one command at a time, not both chart and stability",
    "chart d": "d is for the film, not for chart",
    "7 --save=film.png": "--save is for chart, not for the film",
    "chart --save": "--save FILE must end in .png, .svg or .pdf, not ''",
    "--frames 0": "--frames N must be a whole number from 1 up, not 0",
    "--frames 2.5": "--frames N must be a whole number from 1 up, not '2.5'",
    "--frames": "--frames N must be a whole number from 1 up, not ''",
    "chart motion=exakt": f"motion must be {airtrack.allowed_text(SETTINGS['motion'])}, not "
                          "'exakt'",
    "stability 10 correction=off": "correction must be none, surface, rebound, conserve, rewind or "
                                   "replay, not 'off'",
}
NEAREST = {  # a word that is none: the nearest name
    "fps_taget=10": "fps_target=VALUE", "cr=0.5": "CR=VALUE", "Chrat": "chart",
    "motion": "motion=VALUE, without spaces", "v": "v_mps=VALUE, without spaces",
    "frames=20": "--frames", "--fast=yes": "--fast", "v=3": "v_mps=VALUE",
    "a=-9.81": "a_mps2=VALUE", "fps=10": "fps_target=VALUE",
    "x=1": "x_m=VALUE", "width=80": "width_px=VALUE",
    "left=0": "left_edge_m=VALUE", "help": "--help", "stabilty": "stability", "d=1": "d",
    "exact": "motion=exact", "surface": "correction=surface", "rebond": "correction=rebound",
    **{key: f"the key {key.lower()}, while a film runs" for key in "spxS"},
    "10d": "10", "10,": "10", "3.5": "3"}
MEANT = {  # a word that people say for a setting: its name
    "dt=0.1": "fps_target", "gravity=9.8": "a_mps2", "g=9.8": "a_mps2", "Pull=2": "a_mps2",
    "zoom=20": "m_to_px", "restitution=1": "CR", "speed=3": "v_mps"}
OWN = f"The examples are 0 to {max(EXAMPLES)}; other numbers are yours. Your own scene"
HINTS = {word: f"nearest: {name}" for word, name in NEAREST.items()}
HINTS |= {word: f"nearest: {name}=VALUE ({SETTINGS[name].metadata['meaning']})"
          for word, name in MEANT.items()}
HINTS |= dict.fromkeys(("ten", "mass=2", "=3", "", "a\nb", "9" * 5000), "-h lists all")


@pytest.mark.parametrize(("words", "sentence"), [
    *((words.split(), sentence) for words, sentence in WRONG.items()),
    *((["10", word, "--fast"], f"unknown word {word!r}: it must be an EXAMPLE (whole number), a "
       f"command, an option or a setting (NAME=VALUE); {hint}") for word, hint in HINTS.items())],
    ids=lambda part: str(part)[:40])
def test_what_is_wrong_is_answered_in_one_sentence_and_nothing_runs(
        words: list[str], sentence: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    for name in ("run", "simulate"):
        monkeypatch.setattr(airtrack, name, lambda *_: pytest.fail("it ran"))
    assert main(words) == 2
    assert capsys.readouterr() == ("", f"airtrack.py: error: {sentence}\n")


def test_a_typeset_minus_is_a_minus(capsys: Capture) -> None:
    wanted = film(capsys, "-1", "a_mps2=-2", "d", "--frames", "3")
    assert film(capsys, "\u22121", "a_mps2=\u22122", "d", "--frames", "3") == wanted
    assert "pulled to the left at 2 m/s^2" in wanted.intro


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


@pytest.mark.parametrize("changes", [["motion=forward"], ["x_m=5"], ["correction=surface"]])
def test_chart_and_map_set_motion_and_correction_themselves(
        changes: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    for command in ("chart", "stability"):
        monkeypatch.setattr(airtrack, command, lambda *_: None)
        for more in ([], ["motion=forward", "correction=rewind"]):
            assert main([command, "12", *changes, *more]) == 0


def test_settings_come_on_top_of_the_example(capsys: Capture) -> None:
    intro, lines, _ = film(capsys, "10", "d", "x_m=1", "v_mps=2", "a_mps2=0", "--frames", "1")
    assert lines[0][135:] == "x =   1.20, v =  2.00, FPS =  10"
    line = film(capsys, "16", "d", "--frames", "1").lines[0]  # x = 2 - 2 * 0.1**2, truly 1.99
    assert line[135:] == "x =   1.98, v = -0.20, FPS =  10, err = -1.00e-02"
    assert intro.startswith("Example 10: The exact solution, x_m=1.0, v_mps=2.0, a_mps2=0.0. ")
    assert intro.endswith(" 10 frames a second. What differs from example 10 as it is?")


@pytest.mark.parametrize(("words", "told"), [
    ("", "Example 0: The one-pager: the whole engine in its simplest form. The car starts at "
     "11 m, moving to the right at 17 m/s, pulled to the left at 2 m/s^2; walls at 0.5 and "
     "17.5 m; CR=0.8. Motion backward, correction surface, 66.6667 frames a second. An air "),
    ("9 jitter=0.29", "Example 9: Elastic, large and irregular steps, jitter=0.29. The car starts "
     "at 2 m, at rest, pulled to the left at 2 m/s^2; walls at 0.25 and 2.2 m; CR=1. Motion "
     "backward, correction rebound, 10 frames a second, irregular by up to 29 %, each step as long "
     "as the frame before. What differs from example 9 as it is?"),
    ("21", "Example 21: Five methods on one track. The car starts at 2 m, at rest, pulled to the "
     "left at 2 m/s^2; walls at 0.25 and 2.2 m; CR=1. Motion exact, correction rewind, 10 frames a "
     "second. a: backward + rebound; b: exact + rebound; c: exact + conserve; d: exact + rewind; "
     "e: exact + replay. The * is the car of "),
    ("99 x_m=5 auto_off=False m_to_px=9", f"{OWN}, x_m=5.0, auto_off=False, m_to_px=9.0. "
     "The car starts at 5 m, beyond a wall, at rest, not pulled; walls "),
    ("99", f"{OWN}. The car starts at 1.1 m, at rest, not pulled: nothing moves it until "
     "v_mps or a_mps2 is given; walls at 0.25 and 2.2 m; CR=0.8. Motion backward, correction "
     "rebound, 30 frames a second. Where does the car turn? "),
    ("99 v_mps=1", f"{OWN}, v_mps=1.0. The car starts at 1.1 m, moving to the right at 1 "),
    ("-3 v_mps=-3 a_mps2=1.5 motion=exact", f"{OWN}, v_mps=-3.0, a_mps2=1.5, motion=exact. "
     "The car starts at 1.1 m, moving to the left at 3 m/s, pulled to the right at 1.5 m/s^2; "
     "walls at 0.25 and 2.2 m; CR=0.8. Motion exact, correction rebound, 30 frames a second. "),
    ("1_0 x_m=1e0 width_px=0100 show_start_mark=false auto_off=FALSE", "Example 10: The exact "
     "solution, x_m=1.0, width_px=100, show_start_mark=False, auto_off=False. The car starts at "
     "1 m, at rest, ")])
def test_the_header_says_in_words_all_that_a_run_starts_from(
        words: str, told: str, capsys: Capture) -> None:
    assert film(capsys, *words.split(), "--frames", "1").intro.startswith(told)


def test_fast_neither_waits_nor_tells_of_keys_nor_colours_nor_imports_pygame() -> None:
    code = ("import sys, time, airtrack; time.sleep = None; sys.stdout.isatty = lambda: True; "
            "airtrack.main(['10', '--fast', '--frames', '5']); sys.exit('pygame' in sys.modules)")
    done = subprocess.run([sys.executable, "-c", code], cwd=HERE, env=environment(COLUMNS="200"),
                          capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    header, lines = done.stdout.split("\n\n")
    assert " ".join(header.split()).endswith(EXAMPLES[10].look_for)
    assert set(lines.partition("Stopped")[0]) == set(" |*.\n")


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX pipe")
@pytest.mark.parametrize(("words", "lines"), [
    ("stability", 0), ("chart", 0), ("-h", 0), ("10 --fast --frames 3", 0), ("0 --frames 3", 0),
    ("7 --fast", 1), ("10", 1)])
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
@pytest.mark.parametrize("words", ["10 --fast", "10", "-h", "stability"])
def test_a_full_disk_is_one_sentence(words: str) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([*COMMAND, *words.split()], stdout=full, text=True,
                              stderr=subprocess.PIPE, env=environment(), check=False)
    assert done.returncode == 2
    assert done.stderr == "airtrack.py: error: [Errno 28] No space left on device\n"
