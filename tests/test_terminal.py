"""The keys of a real terminal (a pseudo-terminal), its signals, and how it is left.

What a key does to a film is tested on a set clock, in test_run.py. Here a test waits for what must
come, however slow the machine is.
"""

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator

import pytest

from films import COMMAND, HERE, PATIENCE_S, Terminal, environment, quick

if sys.platform == "win32":
    pytest.skip("needs a POSIX pseudo-terminal", allow_module_level=True)

FILM = [*quick(), "0"]  # it does not end by itself, and its lines have details
FRAME = "FPS = "
HELD = [*quick(pause_s=1e6), "0"]  # the text before it stands until a key is pressed
DIAMOND = re.compile(r"\n +\*\r\n +\* \*\r\n")


@pytest.fixture
def film() -> Iterator[Terminal]:
    """A film that is running."""
    with Terminal(*FILM) as terminal:
        terminal.until(FRAME)
        yield terminal


# The end.

@pytest.mark.parametrize(("key", "status"), [
    ("x", 0), ("\x03", 0), ("SIGTERM", 143), ("SIGHUP", 129), ("SIGQUIT", 131)],
    ids=["x", "Ctrl-C", "SIGTERM", "SIGHUP", "SIGQUIT"])
def test_a_key_or_a_signal_ends_the_film_and_leaves_the_terminal_as_found(
        key: str, status: int, film: Terminal) -> None:
    film.press(key)
    film.ends(status)
    assert ("airtrack.py 1" in film.all) is (status == 0)  # what comes next


def test_an_exception_in_a_film_is_shown_and_leaves_the_terminal_as_found() -> None:
    with Terminal(*quick("airtrack.render_track = lambda *_: 1/0")) as terminal:
        terminal.until("ZeroDivisionError")
        assert terminal.program.wait(PATIENCE_S) == 1
        assert terminal.mode() == terminal.found


def test_while_a_signal_ends_the_film_another_one_is_ignored() -> None:
    change = ("real = examples.termios.tcsetattr; examples.termios.tcsetattr = "
              "lambda *words: [os.kill(os.getpid(), 1), real(*words)]")  # 1 is SIGHUP
    with Terminal(*quick(change), "0") as terminal:
        terminal.until(FRAME)
        terminal.press("SIGTERM")
        terminal.ends(143)


def test_a_film_whose_terminal_is_gone_ends(film: Terminal) -> None:
    film.hang_up()
    assert film.program.wait(PATIENCE_S) == 129


def test_under_nohup_sighup_does_nothing_but_a_film_without_its_terminal_ends() -> None:
    with Terminal("sh", "-c", "trap '' HUP; exec \"$@\"", "sh", *HELD) as terminal:
        terminal.press("\r")
        terminal.until(FRAME)
        terminal.press("SIGHUP")
        terminal.goes_on()
        terminal.press("p")
        falls_silent(terminal)
        terminal.hang_up()
        terminal.program.wait(PATIENCE_S)


def test_after_main_every_signal_does_what_it_did_before() -> None:
    change = ("import signal; handlers = lambda: [*map(signal.getsignal, range(1, 32))]; "
              "found, real = handlers(), airtrack.main; "
              "airtrack.main = lambda: [real(), print('the same:', handlers() == found)][0]")
    with Terminal(*quick(change), "0", "--frames=1") as terminal:
        terminal.until("the same: True")
        terminal.ends(0)


# Keys.

def falls_silent(terminal: Terminal) -> None:
    """Wait until no frames come any more."""
    for _ in range(PATIENCE_S):
        terminal.until(FRAME)
        if not terminal.read(0.5):
            return
    pytest.fail("it goes on")


def test_keys_count_from_the_start_even_before_python_runs_the_program() -> None:
    with Terminal(*HELD) as terminal:
        terminal.press("x")
        terminal.until("Stopped after 0 frames")
        terminal.ends(0)


def test_ctrl_c_and_s_do_in_a_terminal_what_they_do_on_a_set_clock() -> None:
    with Terminal(*HELD) as terminal:
        terminal.until("Ctrl-C")
        terminal.press("\x03")
        terminal.until(FRAME)
        assert DIAMOND.search(terminal.all)
        terminal.press("s")
        falls_silent(terminal)
        before = terminal.all.count(FRAME)
        terminal.press("s")
        falls_silent(terminal)
        assert terminal.all.count(FRAME) == before + 1
        terminal.press("p")
        terminal.goes_on()


def test_arrows_mouse_reports_and_other_keys_do_nothing(film: Terminal) -> None:
    for keys in ("\x1b", "\x1b[A", "\x1bOP", "\x1b[1;5C", "\x1bp", "\x1b[<0;10;10Mpx", "\x1b[M xp",
                 "qwy\t\r\n", "\u00e4\u20ac\u0178"):
        film.press(keys)
        film.goes_on()
    film.press("x\x1b[A")
    film.ends(0)


@pytest.mark.parametrize("line", [
    '"$@" | cat', '"$@" < /dev/null', 'setsid -w "$@"'])  # setsid: it could not be given back
def test_a_terminal_that_is_not_the_film_s_own_is_left_alone(line: str) -> None:
    if "setsid" in line and shutil.which("setsid") is None:
        pytest.skip("setsid is not installed")
    with Terminal("sh", "-c", line, "sh", *FILM, "--frames=100") as terminal:
        terminal.until(FRAME)
        assert terminal.mode() == terminal.found
        terminal.ends(0)
        assert re.search(r"Ctrl-C[^.]*\bends?\b", terminal.all.partition(FRAME)[0])


def test_in_a_pipe_each_frame_comes_at_once_and_ctrl_c_ends_the_film() -> None:
    command = quick("import signal; signal.signal(2, signal.default_int_handler)")  # not ignored
    with subprocess.Popen([*command, "0", "fps_target=0.1"], stdout=subprocess.PIPE, text=True,
                          env=environment(), cwd=HERE) as program:
        assert program.stdout
        assert any(FRAME in line for line in program.stdout)  # the next one would come after 10 s
        program.send_signal(2)
        rest = program.stdout.read()
    assert program.returncode == 0
    assert "Stopped after 1 frames" in rest


# In a shell.

@pytest.fixture(params=["bash", "dash"])
def shell(request: pytest.FixtureRequest) -> Iterator[Terminal]:
    """A shell in which a film is running."""
    if shutil.which(request.param) is None:
        pytest.skip(f"{request.param} is not installed")
    words = {"bash": ["bash", "--norc", "--noprofile", "-i"], "dash": ["dash", "-i"]}
    with Terminal(*words[request.param], PS1="% ") as terminal:
        terminal.until("% ")
        terminal.press(shlex.join(FILM) + "\n")
        terminal.until(FRAME)
        yield terminal


def stop(shell: Terminal) -> None:
    """Press Ctrl-Z, and wait for the shell. It may set the terminal itself, as bash does."""
    shell.press("\x1a")
    shell.until("topped", "% ")  # or Stopped
    assert shell.command[0] == "bash" or shell.mode() == shell.found


def kill(shell: Terminal) -> None:
    """Kill a film that stands still, and wait until it is gone."""
    shell.press('job=$(jobs -p); kill %1; while kill -0 $job; do sleep 0.1; done; echo "go"ne\n')
    shell.until("gone")


def leave(shell: Terminal) -> None:
    shell.until("% ")
    assert shell.command[0] == "bash" or shell.mode() == shell.found
    shell.press("exit\n")
    shell.ends(0)


def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(shell: Terminal) -> None:
    for _ in range(2):
        stop(shell)
        shell.press("fg\n")
        shell.until(FRAME)
        shell.goes_on()
    shell.press("x")
    shell.until("airtrack.py 1")
    leave(shell)


@pytest.mark.parametrize("shell", ["bash"], indirect=True)
@pytest.mark.parametrize("is_killed", [False, True])
def test_in_the_background_a_film_stands_still_until_fg_or_kill(
        is_killed: bool, shell: Terminal) -> None:
    stop(shell)
    shell.press("bg\n")
    shell.press('while [ -z "$(jobs -s)" ]; do sleep 0.1; done; echo it stands sti""ll\n')
    shell.until("it stands still", "% ")
    if is_killed:
        kill(shell)
    else:
        shell.press("fg\n")
        shell.until(FRAME)
        shell.press("x")
        shell.until("airtrack.py 1")
    leave(shell)


@pytest.mark.parametrize("shell", ["bash"], indirect=True)
def test_a_film_that_is_stopped_and_killed_ends(shell: Terminal) -> None:
    stop(shell)
    kill(shell)
    leave(shell)


def test_keys_that_were_typed_and_not_read_do_not_reach_the_shell() -> None:
    # It draws a frame until a key has come: after the last look at the keys.
    change = ("real = airtrack.render_track; airtrack.render_track = lambda *words: "
              "[print('dra' + 'wing', flush=True), examples.select.select([0], [], []), "
              "real(*words)][2]")
    with Terminal("bash", "--norc", "--noprofile", "-i", PS1="% ") as shell:
        shell.until("% ")
        shell.press(shlex.join([*quick(change), "0", "--frames=1"]) + "\n")
        shell.until("drawing")
        shell.press("x")
        shell.until("airtrack.py 1", "% ")
        shell.press('echo status "$?"\n')
        shell.until("status 0")
        assert "xecho" not in shell.all


# The picture.

EVERY_MARK = [*quick(), *"0 v_mps=8 x_m=17 fps_target=10 show_collision_mark=True".split()]


def first_frame(line: str, **changes: str) -> str:
    """The first frame of a film in a terminal, as a line of sh shows it."""
    with Terminal("sh", "-c", line, "sh", *EVERY_MARK, "--frames=1", **changes) as terminal:
        terminal.ends(0)
        return next(shown for shown in terminal.all.splitlines() if FRAME in shown)


def test_a_terminal_shows_the_marks_in_colours_unless_that_is_not_wanted() -> None:
    coloured = first_frame('"$@"')
    picture, _, details = coloured.partition("x =")
    marks = re.findall("\x1b\\[[0-9]+m(.)\x1b\\[0m", picture)
    assert sorted(marks) == ["*", "+", "0", "o"]
    assert "\x1b" not in details
    without = re.sub("\x1b\\[[0-9]+m", "", coloured)
    assert "\x1b" not in without
    assert first_frame('"$@"', NO_COLOR="1") == without
    assert first_frame('"$@"', TERM="dumb") == without
    assert first_frame('"$@" | cat') == without
    assert "\x1b" not in first_frame('"$@" --fast')


@pytest.mark.parametrize("words", ["1", "14 d v_mps=-40 x_m=999"])
def test_in_a_narrow_terminal_the_picture_is_smaller_and_a_line_says_so(words: str) -> None:
    walls = []
    for columns in (80, 200):
        with Terminal(*quick(), *words.split(), "--frames=6", columns=columns,
                      NO_COLOR="1") as terminal:
            terminal.ends(0)
        lines = terminal.all.splitlines()
        assert max(map(len, lines)) <= columns
        header, _, film = terminal.all.partition("\r\n\r\n")
        walls.append([mark.start() for mark in re.finditer(r"\|", film.splitlines()[0])])
        said = re.findall(r"([0-9]+) columns wide", header)
        width_px = len(lines[lines.index("") + 1].partition("x =")[0])
        assert said == ([str(width_px)] if columns == 80 else [])
    (left, right), (wide_left, wide_right) = walls
    assert left / right == pytest.approx(wide_left / wide_right, abs=0.02)
