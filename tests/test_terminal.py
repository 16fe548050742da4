"""The keys of a real terminal (a pseudo-terminal), its signals, and how it is left.

What a key does to the film is tested on a set clock, in test_run.py. Here a test waits for what
must come, however slow the machine is.
"""

import importlib.util
import re
import shlex
import shutil
import socket
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from films import COMMAND, PATIENCE_S, Terminal, quick

if sys.platform == "win32":
    pytest.skip("needs a POSIX pseudo-terminal", allow_module_level=True)

import termios


@pytest.fixture
def film() -> Iterator[Terminal]:
    """The one-pager, running."""
    with Terminal(*quick()) as terminal:
        terminal.until("Keys here: p ", "FPS")
        yield terminal


# Keys.

def test_keys_come_singly_and_unechoed(film: Terminal) -> None:
    film.press("s")
    film.until("paused after frame ")
    _, _, _, local_flags, *_, characters = film.mode()
    assert (characters[termios.VMIN], characters[termios.VTIME]) == (1, 0)
    assert local_flags & (termios.ICANON | termios.ECHO | termios.ISIG) == termios.ISIG
    film.ends_at_x()


@pytest.mark.parametrize(("key", "status"), [
    ("x", 0), ("\x03", 0), ("SIGTERM", 143), ("SIGHUP", 129), ("SIGQUIT", 131)],
    ids=["x", "Ctrl-C", "SIGTERM", "SIGHUP", "SIGQUIT"])
def test_a_key_or_a_signal_ends_the_run_and_leaves_the_terminal_as_it_was_found(
        key: str, status: int, film: Terminal) -> None:
    film.press(key)
    if status == 0:
        film.until("Stopped after ", "was pressed.\r\n")
    film.ends(status)
    following = f"Next: {Path(sys.executable).name} airtrack.py 1\r\n"
    assert (following in film.all) is (status == 0)


def test_the_next_command_names_the_python_that_runs(tmp_path: Path) -> None:
    (tmp_path / "python7.1").symlink_to(sys.executable)
    with Terminal(str(tmp_path / "python7.1"), *quick()[1:], "1", "--frames=1") as terminal:
        terminal.until("\r\nNext: python7.1 airtrack.py 2\r\n")
        terminal.ends(0)


def test_ctrl_c_begins_the_film_with_a_diamond_and_a_pause_leaves_the_frames_alone() -> None:
    diamond = "   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n\r\n"
    with Terminal(*quick(pause_s=1e6), "1", columns=40, NO_COLOR="1") as terminal:
        terminal.until("p holds the", "text.\r\n")
        terminal.press("p")
        terminal.until_read()
        paused = "paused after frame "
        for key, *told in (("\x03", diamond, "\r\n"), ("p", paused), ("s", paused),
                           ("p", "\r\n", "\r\n"), ("p", paused)):
            terminal.press(key)
            terminal.until(*told)
        terminal.ends_at_x()
    notice = re.compile("(paused after frame[^\r]*)\r( *)\r")
    for told_of, blanks in notice.findall(terminal.all):
        assert len(told_of) == len(blanks) < 40
    film, _, ending = notice.sub("", terminal.all).partition(diamond)[2].partition("Stopped after ")
    frames = film.splitlines()
    assert ending.startswith(f"{len(frames)} frames, ")
    assert all(re.fullmatch("[ |*]{40}", frame) for frame in frames)


def test_arrows_mouse_reports_late_replies_and_other_keys_do_nothing(film: Terminal) -> None:
    for keys in ("\x1b", "\x1b[A", "\x1bOP", "\x1b[[A", "\x1b[1;5C", "\x1bp", "\x1bx", "\x1b\x1b[A",
                 "\x1b[<0;10;10Mpx", "\x1b[M xp", "\x1bP>|xterm(379)\x1b\\", "\x1b_ixp\x1b\\",
                 "\x1b]11;rgb:0/0/0\a", "qwy\t\r\n", "\u00e4\u20ac\u0178"):
        film.press(keys)
        film.until("FPS", "FPS")
    film.press("s\x1b[A")  # what comes before an Esc counts
    film.until("paused after frame")
    film.ends_at_x()
    assert film.all.count("paused") == 1


@pytest.mark.parametrize("line", ['"$@" | cat', '"$@" < /dev/null'])
def test_a_terminal_that_is_not_input_and_output_is_left_alone(line: str) -> None:
    with Terminal("sh", "-c", line, "sh", *quick()) as terminal:
        terminal.until("or now with Ctrl-C.", "FPS")
        assert terminal.mode() == terminal.found


def test_keys_that_were_typed_and_not_read_do_not_reach_the_shell() -> None:
    change = ("real = airtrack.render_track; airtrack.render_track = lambda *a: "
              "[print('drawing', flush=True), time.sleep(1), real(*a)][2]")
    with Terminal("bash", "--norc", "--noprofile", "-i", PS1="% ") as shell:
        shell.until("% ")
        shell.press(f"{shlex.join(quick(change))} 2 --frames 1\n")
        shell.until("p holds the text.", "drawing")  # after the last look at the keys
        shell.press("x")
        shell.until("Next:", "% ")
        shell.press("echo status $?\n")
        shell.until("status 0")
        assert "xecho" not in shell.all
        shell.press("exit\n")
        shell.ends(0)


# Signals.

@pytest.mark.parametrize("shell", [["bash", "--norc", "--noprofile", "-i"], ["dash", "-i"]])
def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(shell: list[str]) -> None:
    if shutil.which(shell[0]) is None:
        pytest.skip(f"{shell[0]} is not installed")
    with Terminal(*shell, PS1="% ") as terminal:
        terminal.until("% ")
        terminal.press(f"{shlex.join(quick())}\n")
        terminal.until("p holds the text.", "FPS")
        for _ in range(2):
            terminal.press("\x1a")
            terminal.until("topped", "% ")  # bash: Stopped, dash: Suspended or Stopped
            if shell[0] == "dash":  # bash has a mode of its own while it waits
                assert terminal.mode() == terminal.found
            terminal.press("fg\n")
            terminal.until("FPS")
            terminal.press("s")
            terminal.until("paused after frame ")
            assert not terminal.mode()[3] & (termios.ICANON | termios.ECHO)
            terminal.press("p")
            terminal.until("FPS")
        terminal.press("x")
        terminal.until("Next:", "% ")
        terminal.press("exit\n")
        terminal.ends(0)


def test_a_film_that_is_stopped_and_killed_ends() -> None:
    with Terminal("bash", "--norc", "--noprofile", "-i", PS1="% ") as shell:
        shell.until("% ")
        shell.press(f"{shlex.join(quick())}\n")
        shell.until("p holds the text.", "FPS")
        shell.press("\x1a")
        shell.until("Stopped", "% ")
        shell.press("p=$(jobs -p); kill %1; while kill -0 $p; do sleep 0.1; done; echo go''ne\n")
        shell.until("gone", "% ")
        shell.press("exit\n")
        shell.ends(0)


def test_the_first_reason_to_end_is_told(film: Terminal) -> None:
    film.press("xpps")
    film.until("Stopped after ", " s: x was pressed.\r\n")
    film.ends(0)


def test_a_signal_that_was_ignored_from_the_start_stays_ignored() -> None:
    with Terminal("sh", "-c", "trap '' HUP; exec \"$@\"", "sh", *quick()) as terminal:  # nohup
        terminal.until("FPS")
        terminal.press("SIGHUP")
        terminal.until("FPS", "FPS")
        terminal.ends_at_x()


def test_an_exception_in_mid_film_leaves_the_terminal_as_it_was_found() -> None:
    with Terminal(*quick("airtrack.render_track = lambda *_: sys.exit(3)")) as terminal:
        terminal.ends(3)


@pytest.mark.parametrize(("words", "seen"), [
    ("2 --fast", "*"), ("chart", "\r\n"), ("stability", "\r\n")])
def test_what_has_no_keys_is_ended_by_ctrl_c_with_130(words: str, seen: str) -> None:
    with Terminal(*COMMAND, *words.split()) as terminal:
        terminal.until("\r\n\r\n" if seen == "*" else seen, seen)
        terminal.press("\x03")
        terminal.ends(130)


@pytest.mark.skipif(sys.platform != "linux" or importlib.util.find_spec("pygame") is None,
                    reason="needs X11, and pygame")
@pytest.mark.parametrize(("key", "status"), [("\x03", -2), ("SIGTERM", -15)])
def test_while_a_display_does_not_answer_nothing_is_raw_and_a_signal_ends_the_program(
        key: str, status: int) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(PATIENCE_S)
        display = f"127.0.0.1:{server.getsockname()[1] - 6000}"
        with Terminal(*COMMAND, DISPLAY=display, SDL_VIDEODRIVER="x11") as terminal, (
                server.accept()[0]):
            terminal.until("66.666")  # the header: Ctrl-C may flush what is not yet read
            assert terminal.mode() == terminal.found
            terminal.press(key)
            terminal.ends(status)


# The picture.

def test_the_marks_are_coloured_and_only_coloured_unless_that_is_not_wanted() -> None:
    def frame(*words: str, **changes: Any) -> str:
        """A frame in which every mark is, as it was printed."""
        scene = "x_m=17 v_mps=8 fps_target=10 show_collision_mark=True show_exact_mark=True"
        with Terminal(*quick(), *scene.split(), "--frames=1", *words, **changes) as terminal:
            terminal.ends(0)
            return terminal.all.partition("\r\n\r\n")[2].splitlines()[0]

    coloured = frame()
    for mark in ("\x1b[33m*\x1b[0m", "\x1b[31m0\x1b[0m", "\x1b[32mo\x1b[0m"):
        assert mark in coloured
    plain = re.sub("\x1b\\[[0-9]*m", "", coloured)
    assert {frame(NO_COLOR="1"), frame(TERM="dumb"), frame(TERM=None), frame("--fast")} == {plain}


@pytest.mark.parametrize("columns", [20, 80, 120, 200])
@pytest.mark.parametrize(("words", "widest"), [
    ("0", 163), ("10 d", 172), ("14 d x_m=999", 172),  # 14: beyond 1000 m
    ("99 d v_mps=-1000 CR=1", 172), ("16 d", 189), ("1", 135)])
def test_no_line_is_wider_than_the_terminal(words: str, widest: int, columns: int) -> None:
    with Terminal(*quick(), *words.split(), "--frames=6", columns=columns, NO_COLOR="1") as film:
        film.ends(0)
    assert columns == 20 or max(map(len, film.all.splitlines())) <= columns  # 20: no room for d
    told = "columns wide, to fit into the terminal."
    assert (told in " ".join(film.all.split())) is (columns < widest)
