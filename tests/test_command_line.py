"""The command line: what it takes, what it says of what it does not take, and how it ends."""

import importlib.util
import io
import re
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from itertools import permutations
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import airtrack
from airtrack import ALL_CORRECTIONS, COMMANDS, MOTIONS, SETTINGS, Scene, main
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

@pytest.mark.parametrize(("words", "parts"), [  # what is wrong, and what is allowed
    ("CR=7", "CR 7 0 1"), ("x_m=nan", "x_m nan -10000 10000"), ("v_mps=-10001", "v_mps -10001"),
    ("fps_target=0.09", "fps_target 0.09 0.1 1000"), ("jitter=0.91", "jitter 0.91 0 0.9"),
    ("m_to_px=0", "m_to_px 0.0001 1000"), ("width_px=9", "width_px 9 10 1000"),
    ("width_px=99.5", "width_px 99.5 whole"), ("auto_off=yes", "auto_off yes True False"),
    ("motion=euler", "motion euler forward backward exact"),
    ("correction=bounce", "correction bounce none surface rebound conserve rewind replay"),
    ("CR=0,9", "CR 0,9 point"), ("CR=", "CR=VALUE 0 1"), ("CR 0.7", "CR=VALUE 0 1"),
    ("CR:0.7", "CR=VALUE 0 1"), ("10 left_edge_m=3", "right_edge_m 2.2 3.01"),
    ("right_edge_m=0.255", "right_edge_m 0.26"), ("10 motion=forward", "rewind motion=exact"),
    ("12 x_m=0.2", "x_m 0.2 rewind 0.25 2.2"), ("3 d 4", "3 4 one"), ("--frames x", "--frames x"),
    ("chart stability", "chart stability one"), ("--frames 0", "--frames 0 1"),
    ("chart d", "chart d"), ("chart --fast", "chart --fast"),
    ("stability 3 --frames 9", "stability --frames"),
    ("stability 5 motion=exact", "stability motion x_m CR m_to_px"),
    # the nearest right name, if there is one
    ("dt=0.1", "dt=0.1 fps_target=VALUE"), ("--fps=9", "--fps=9 fps_target=VALUE"),
    ("g=9.8", "a_mps2=VALUE m/s^2"), ("e=1", "CR=VALUE"), ("SPEED=3", "v_mps=VALUE"),
    ("zoom=9", "m_to_px=VALUE"), ("widht_px=9", "width_px=VALUE"), ("Stabilty", "stability"),
    ("conserv", "correction=conserve"), ("Exact", "motion=exact"), ("--fats", "--fast"),
    ("qqqq", "qqqq -h"), ("grafik=1", "grafik -h"), ("friction=0.1", "friction -h")])
def test_wrong_input_ends_with_2_and_one_sentence_that_helps(words: str, parts: str) -> None:
    status, err = ended(words.split())
    assert status == 2
    _, error = err.splitlines()  # below the usage
    assert error.startswith("airtrack.py: error: ")
    for part in parts.split():
        assert part in error.removeprefix("airtrack.py: error: ")

WORD = st.sampled_from(["d", "-d", "--fast", "--frames", "chart", "stability", "10", "-5", "CR="])
SETTING = st.tuples(st.sampled_from([*SETTINGS, "fps"]), st.sampled_from("=:,"), st.text() | WORD)

@given(st.lists(WORD | st.text() | SETTING.map("".join) | st.from_regex("-{0,2}[a-z0-9=.]*")))
def test_no_words_end_in_a_traceback(words: list[str]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(airtrack, "film", lambda *_: None)
        for command in COMMANDS:
            patch.setitem(COMMANDS, command, lambda *_: None)
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
    for name, field in SETTINGS.items():
        assert re.search(rf"(?m)^ +{name} +{field.default} +\w", text)

@pytest.mark.parametrize(("words", "title"), [
    ("", "Example 1:"), ("10", "Example 10:"), ("23", "Your own"), ("-5", "Your own")])
def test_without_a_number_it_is_example_1_and_any_whole_number_is_a_scene(
        words: str, title: str) -> None:
    assert shown(f"{words} --frames=1").intro.startswith(title)
    assert "jitter=0.25" in shown("9 --frames=1").intro  # all that moves the car is told

def test_words_and_true_and_false_may_be_typed_in_small_or_large_letters() -> None:
    film = shown("99 motion=EXACT correction=Replay show_start_mark=tRUE --frames=3")
    same = shown("99 motion=exact correction=replay show_start_mark=True --frames=3")
    assert film.lines == same.lines
    assert film.table == same.table

@pytest.mark.parametrize("command", ["chart", "stability"])
def test_a_command_in_any_place_is_for_example_12_or_another_from_a_start_on_the_track(
        command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Scene] = []
    monkeypatch.setitem(COMMANDS, command, lambda scene, _: asked.append(scene))
    for words in ([command], *permutations([command, "3", "CR=0.5"]), [command, "12", "x_m=5"]):
        assert main([*words]) == 0
    tracks = [scene.track for scene in asked]
    starts = [(track.x_m, track.a_mps2, track.CR) for track in tracks]
    assert starts == [(2.0, -2.0, 0.8), *[(2.0, -1.5, 0.5)] * 6, (2.2, -2.0, 0.8)]

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
