"""The keys of a real terminal (a pseudo-terminal), its signals, and how it is left.

What a key does to the film is tested on a set clock, in test_run.py. Here a test waits for what
must come, however slow the machine is.
"""

import importlib.util
import os
import re
import shlex
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

def test_keys_come_singly_and_unechoed_without_flow_control_and_again_after_a_stop(
        film: Terminal) -> None:
    for _ in range(2):
        film.press("s")
        film.until("paused after frame ")
        input_flags, _, _, local_flags, *_, characters = film.mode()
        assert (characters[termios.VMIN], characters[termios.VTIME]) == (1, 0)
        assert local_flags & (termios.ICANON | termios.ECHO | termios.ISIG) == termios.ISIG
        assert not input_flags & termios.IXON
        film.press("SIGSTOP")
        os.waitid(os.P_PID, film.program.pid, os.WSTOPPED)
        termios.tcsetattr(film.theirs, termios.TCSANOW, film.found)  # as a shell would
        film.press("SIGCONT")
    film.ends_at_x()


@pytest.mark.parametrize(("key", "why", "status"), [
    ("x", "x was pressed", 0), ("\x03", "Ctrl-C was pressed", 0),
    ("SIGTERM", "SIGTERM", 143), ("SIGHUP", "SIGHUP", 129), ("SIGQUIT", "SIGQUIT", 131)],
    ids=["x", "Ctrl-C", "SIGTERM", "SIGHUP", "SIGQUIT"])
def test_a_key_or_a_signal_ends_the_run_and_leaves_the_terminal_as_it_was_found(
        key: str, why: str, status: int, film: Terminal) -> None:
    film.press(key)
    film.until("Stopped after ", f" s: {why}.\r\n")
    film.ends(status)
    following = f"Next: {Path(sys.executable).name} airtrack.py 1\r\n"
    assert (following in film.all) is (status == 0)


def test_the_next_command_names_the_python_that_runs(tmp_path: Path) -> None:
    (tmp_path / "python7.1").symlink_to(sys.executable)
    with Terminal(str(tmp_path / "python7.1"), *quick()[1:], "1", "--frames=1") as terminal:
        terminal.until("\r\nNext: python7.1 airtrack.py 2\r\n")
        terminal.ends(0)


def test_pausing_and_stepping_leave_on_a_narrow_screen_the_frames_alone() -> None:
    diamond = "   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n\r\n"
    with Terminal(*quick(pause_s=1e6), "1", columns=40, NO_COLOR="1") as terminal:
        terminal.until("It begins in ", "text.\r\n")
        paused = "paused after frame "
        for key, *told in (("p", paused), ("p", "   \r"), ("p", paused), ("\x03", diamond, "\r\n"),
                           ("p", paused), ("s", paused), ("\x13", "\r\n", "\r\n"),
                           ("\x13", paused)):
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
        terminal.until("or with Ctrl-C.", "FPS")
        assert terminal.mode() == terminal.found


# Signals.

@pytest.mark.parametrize("calls", ["[kill(), real(*a)][1]", "[real(*a), kill()][0]"])
@pytest.mark.parametrize(("place", "at_int", "at_term"), [
    ("airtrack.say", 130, -15), ("examples.Window.open", -2, -15),
    ("examples.Terminal.take", 0, 143), ("examples.Keys.look", 0, 143), ("airtrack.step", 0, 143),
    ("examples.Terminal.give_back", 0, 143), ("examples.Window.close", -2, -15)])
def test_a_signal_at_any_step_of_a_run_leaves_no_traceback_and_the_terminal_as_it_was_found(
        place: str, at_int: int, at_term: int, calls: str) -> None:
    """While the window opens or closes, which may hang, the signal is the system's."""
    for number, status in ((2, at_int), (15, at_term)):
        change = (f"kill = lambda: os.kill(os.getpid(), {number}); real = {place}; "
                  f"{place} = lambda *a: {calls}")
        with Terminal(*quick(change), "--frames", "1") as terminal:
            terminal.ends(status)


def test_a_film_that_is_killed_while_it_is_stopped_ends_when_the_shell_takes_it_up_again() -> None:
    stopped = "until jobs | grep -q Stopped; do sleep 0.1; done"
    with Terminal("bash", "--norc", "--noprofile", "-i", PS1="% ") as shell:
        for line, told in ((f"{shlex.join(quick())} &", "% "), (stopped, "% "),
                           ("kill %1", "holds this text."), (stopped, "% "),  # goes on, and stops
                           ("fg", "s: SIGTERM."), ("echo status $?", "status 143"), ("exit", "")):
            shell.press(f"{line}\n")
            shell.until(told)
        shell.ends(0)


def test_a_terminal_is_given_back_also_if_a_signal_interrupts_that() -> None:
    change = ("import termios as t, unittest.mock as m; real = examples.Terminal.give_back; "
              "t.tcsetattr = m.Mock(wraps=t.tcsetattr); examples.Terminal.give_back = lambda self: "
              "[setattr(t.tcsetattr, 'side_effect', [t.error, m.DEFAULT]), real(self)]")
    with Terminal(*quick(change), "--frames=9") as terminal:
        terminal.ends(0)


def test_a_terminal_that_refuses_to_change_is_no_error() -> None:
    change = "import termios as t, unittest.mock as m; t.tcsetattr = m.Mock(side_effect=t.error)"
    with Terminal(*quick(change), "--frames=9") as terminal:
        terminal.ends(0)


def test_a_signal_that_was_ignored_from_the_start_stays_ignored() -> None:
    with Terminal("sh", "-c", "trap '' HUP; exec \"$@\"", "sh", *quick()) as terminal:  # nohup
        terminal.until("FPS")
        terminal.press("SIGHUP")
        terminal.until("FPS", "FPS")  # it has had its look, and goes on
        terminal.ends_at_x()


def test_an_exception_leaves_the_terminal_as_it_was_found() -> None:
    with Terminal(*quick("airtrack.render_track = lambda *_: sys.exit(3)")) as terminal:
        terminal.ends(3)


@pytest.mark.parametrize("words", ["2 --fast", "chart", "stability"])
def test_what_has_no_keys_is_ended_by_ctrl_c_as_any_program(words: str) -> None:
    with Terminal(*COMMAND, *words.split()) as terminal:
        terminal.until("\r\n")
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
            terminal.until("66.6667")  # the header: Ctrl-C may flush what is not yet read
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
    assert ("columns wide, to fit." in " ".join(film.all.split())) is (columns < widest)
