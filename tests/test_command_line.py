"""The command line: what it takes, what it says of what it does not take, and how it ends."""

import importlib.util
import io
import re
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import airtrack
from airtrack import ALL_CORRECTIONS, COMMANDS, MOTIONS, SETTINGS, main
from examples import EXAMPLES
from films import COMMAND, HERE, environment, shown


def ended(words: list[str]) -> tuple[object, str]:
    """The exit status of a command line, and what stands on standard error."""
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()) as err:
        try:
            status: object = main(words)
        except SystemExit as end:
            status = end.code
    return status, err.getvalue()

# What is refused.

def stubbed(patch: pytest.MonkeyPatch) -> list[Any]:
    """What films, charts and maps get, which now show nothing."""
    got: list[Any] = []
    patch.setattr(airtrack, "film", lambda *words: got.append(words))
    for command in COMMANDS:
        patch.setitem(COMMANDS, command, got.append)
    return got

@pytest.mark.parametrize(("words", "parts"), [  # what is wrong, and what is allowed
    ("CR=7", "CR 7 0 1"), ("x_m=nan", "x_m nan -10000 10000"), ("v_mps=-10001", "v_mps -10001"),
    ("fps_target=0.09", "fps_target 0.09 0.1 1000"), ("jitter=0.91", "jitter 0.91 0 0.9"),
    ("m_to_px=0", "m_to_px 0.0001 1000"), ("width_px=9", "width_px 9 10 1000"),
    ("width_px=99.5", "width_px 99.5 whole"), ("auto_off=yes", "auto_off yes True False"),
    ("motion=euler", "motion euler forward backward exact"),
    ("correction=bounce", "correction bounce none surface rebound conserve rewind replay"),
    ("CR=0,9", "CR 0,9"), ("CR=", "CR 0 1"), ("CR 0.7", "CR=VALUE 0 1"),
    ("10 left_edge_m=3", "right_edge_m 2.2 left_edge_m"),
    ("right_edge_m=0.255", "right_edge_m 0.255 0.01"), ("10 motion=forward", "rewind motion=exact"),
    ("12 x_m=0.2", "x_m 0.2 rewind"), ("3 d 4", "3 4 one"), ("--frames x", "--frames x whole"),
    ("chart stability", "chart stability one"), ("--frames 0", "--frames 0 1"),
    ("chart d", "chart d x_m CR"), ("chart --fast", "chart --fast"),
    ("chart --frames 50000", "chart --frames"), ("stability 3 --frames 9", "stability --frames"),
    ("stability 5 motion=exact", "stability motion x_m CR m_to_px"),
    ("chart show_methods=True", "chart show_methods"), ("stability auto_off=False", "auto_off"),
    ("chart jitter=0.1", "chart jitter"), ("stability fps_target=9", "stability fps_target"),
    # the nearest right name, if there is one
    ("dt=0.1", "dt=0.1 fps_target=VALUE"), ("widht_px=9", "width_px=VALUE"), ("-d", "-d d"),
    ("Stabilty", "stability"), ("conserv", "correction=conserve"), ("Exact", "motion=exact"),
    ("-5", "-5 -h"), ("9" * 5000, "999 -h"), ("qqqq", "qqqq -h"), ("friction=0.1", "friction -h")])
def test_wrong_input_ends_with_2_and_one_sentence_that_helps(
        words: str, parts: str, monkeypatch: pytest.MonkeyPatch) -> None:
    stubbed(monkeypatch)  # so that no film is started if this is taken
    status, err = ended(words.split())
    assert status == 2
    _, error = err.splitlines()  # below the usage
    assert error.startswith("airtrack.py: error: ")
    for part in parts.split():
        assert part in error.removeprefix("airtrack.py: error: ")

@pytest.mark.parametrize(("meant", "words"), [
    ("fps_target", "fps dt"), ("a_mps2", "g gravity a acceleration"), ("left_edge_m", "left"),
    ("right_edge_m", "right"), ("x_m", "x height"), ("v_mps", "v speed velocity"),
    ("CR", "e elasticity restitution bounciness"), ("m_to_px", "zoom")])
def test_what_other_programs_call_a_setting_leads_to_its_name(meant: str, words: str) -> None:
    for word in words.split():
        for typed in (f"{word}=0.5", f"--{word}", word.upper()):
            _, err = ended([typed])
            assert re.findall(r"did you mean (\w+)=VALUE", err) == [meant]

WORD = st.sampled_from(["d", "-d", "--fast", "--frames", "chart", "stability", "10", "-5", "CR="])
SETTING = st.tuples(st.sampled_from([*SETTINGS, "fps"]), st.sampled_from("=:,"), st.text() | WORD)

@given(st.lists(WORD | st.text() | SETTING.map("".join) | st.from_regex("-{0,2}[a-z0-9=.]*")))
def test_no_words_end_in_a_traceback(words: list[str]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        stubbed(patch)
        status, err = ended(words)
    assert status in (0, 2)
    assert ("\nairtrack.py: error: " in err) is (status == 2)

# What is taken.

def test_h_names_every_setting_example_motion_and_correction_in_80_columns() -> None:
    text = subprocess.run([*COMMAND, "-h"], env=environment(COLUMNS="80"), stdout=subprocess.PIPE,
                          text=True, check=True).stdout
    assert max(len(line) for line in text.splitlines()) <= 80
    for number, example in EXAMPLES.items():
        assert re.search(rf"(?m)^ +{number} +{re.escape(example.title)}$", text)
    for name in [*MOTIONS, *ALL_CORRECTIONS, *COMMANDS]:
        assert re.search(rf"(?m)^ +{name} +\w", text)
    for name in SETTINGS:
        assert re.search(rf"(?m)^ +{name} +\S", text)

def test_without_frames_a_film_ends_after_as_many_as_h_says() -> None:
    text = subprocess.run([*COMMAND, "-h"], env=environment(), stdout=subprocess.PIPE, text=True,
                          check=True).stdout
    limit, = re.findall(r"stop after N frames; without it, after\s+(\d+)", text)
    assert len(shown("14").lines) == int(limit) == 50_000

@pytest.mark.parametrize("name", ["v_mps", "a_mps2"])
def test_h_says_to_which_side_a_negative_velocity_or_acceleration_points(name: str) -> None:
    side, = re.findall(r"below 0 to the (left|right)", SETTINGS[name].metadata["meaning"])
    places = [line.index("*") for line in shown(f"99 {name}=-1 --frames=30").lines]
    assert side == ("left" if places[-1] < places[0] else "right")

@pytest.mark.parametrize(("ending", "unit"), [
    ("_m", "in m"), ("_mps", "in m/s"), ("_mps2", "in m/s^2"), ("_px", "columns")])
def test_h_names_the_unit_that_a_setting_has_in_its_name(ending: str, unit: str) -> None:
    named = [name for name in SETTINGS if name.endswith(ending)]
    assert named
    for name in named:
        assert re.search(rf"{re.escape(unit)}(?![/\w])", SETTINGS[name].metadata["meaning"])
    assert re.search(r"columns for each m$", SETTINGS["m_to_px"].metadata["meaning"])

@pytest.mark.parametrize(("words", "title"), [
    ("", "1, A first look"), ("10", "10, The exact solution"), ("23", "23, your own scene"),
    ("999999999", "999999999, your own scene")])
def test_without_a_number_it_is_example_1_and_any_larger_number_is_a_scene(
        words: str, title: str) -> None:
    assert title in shown(f"{words} --frames=1").intro
    assert "jitter=0.25" in shown("9 --frames=1").intro  # all that moves the car is told
    assert "x_m=1.23456789 " in shown("9 x_m=1.23456789 --frames=1").intro  # and as it was typed

def test_words_and_true_and_false_may_be_typed_in_small_or_large_letters_and_a_minus_as_printed(
        monkeypatch: pytest.MonkeyPatch) -> None:
    got = stubbed(monkeypatch)
    main(["99", "motion=EXACT", "correction=Replay", "show_start_mark=tRUE",
          "a_mps2=\N{MINUS SIGN}2"])
    main(["99", "motion=exact", "correction=replay", "show_start_mark=True", "a_mps2=-2"])
    assert got[0][1] == got[1][1]
    assert got[0][1].a_mps2 == -2

@pytest.mark.parametrize("command", ["chart", "stability"])
def test_a_command_in_any_place_is_for_example_12_or_another(
        command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    got = stubbed(monkeypatch)
    for words in ([command], *permutations([command, "3", "CR=0.5"])):
        assert main([*words]) == 0
    told = re.findall(r"a film shows example (\d+),\s+and chart and stability take example (\d+)",
                      str(airtrack.__doc__))
    assert told == [("1", "12")]  # for a film without a number see above
    starts = [(scene.x_m, scene.a_mps2, scene.CR) for scene in got]
    assert starts == [(2.0, -2.0, 0.8), *[(2.0, -1.5, 0.5)] * 6]

# How it ends.

@pytest.mark.skipif(sys.platform == "win32", reason="needs a POSIX pipe")
@pytest.mark.parametrize("words", ["stability", "-h", "7 --fast"])
def test_a_reader_that_leaves_early_is_no_error(words: str) -> None:
    with subprocess.Popen([*COMMAND, *words.split()], stdout=subprocess.PIPE, text=True,
                          stderr=subprocess.PIPE, env=environment()) as program:
        assert program.stdout is not None
        program.stdout.readline()
        program.stdout.close()
        assert program.stderr is not None
        assert (program.stderr.read(), program.wait()) == ("", 0)

@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_told_in_a_sentence() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([*COMMAND, "10", "--fast"], stdout=full, text=True,
                              stderr=subprocess.PIPE, env=environment(), check=False)
    assert done.returncode == 2
    error, = done.stderr.splitlines()
    assert error.startswith("airtrack.py: error: ")

@pytest.mark.parametrize("words", ["10 --fast", "chart", "stability"])
def test_ctrl_c_ends_with_130_what_takes_no_keys(
        words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(airtrack, "step", interrupted)
    assert ended(words.split()) == (130, "")

RUNPY = """import contextlib, runpy
with contextlib.suppress(SystemExit):
    runpy.run_path("airtrack.py", run_name="__main__")
print("function calls")"""
FILM = ["10", "--fast", "--frames=3"]
HOSTS = [["-m", "cProfile", "airtrack.py", *FILM], ["-c", RUNPY, *FILM]]
if importlib.util.find_spec("IPython"):
    in_ipython = f"%run airtrack.py {' '.join(FILM)}\nprint('function calls')"
    HOSTS.append(["-m", "IPython", "-c", in_ipython])

@pytest.mark.parametrize("host", HOSTS)
def test_what_runs_the_program_lives_on(host: list[str]) -> None:
    done = subprocess.run([sys.executable, *host], cwd=HERE, env=environment(),
                          capture_output=True, text=True, check=False)
    _, _, after_the_film = done.stdout.partition("Stopped after 3 frames")
    assert "function calls" in after_the_film
    assert done.returncode == 0
