"""The keys of a real terminal (a pseudo-terminal), its signals, and how it is left.

What a key does to the film is tested on a set clock, in test_run.py. Here a test waits for what
must come, however slow the machine is.
"""

import importlib.util
import re
import shlex
import shutil
import signal
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

BASH = ["bash", "--norc", "--noprofile", "-i"]
DASH = ["dash", "-i"]


@pytest.fixture
def film() -> Iterator[Terminal]:
    """The one-pager, running."""
    with Terminal(*quick()) as terminal:
        terminal.until("Keys here: p ", "FPS")
        yield terminal


def has_keys_singly(terminal: Terminal) -> bool:
    return not terminal.mode()[3] & (termios.ICANON | termios.ECHO)


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
        film.until("Stopped after ", "was pressed.\r\n", "The hops in frames")
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
    with Terminal(*quick(pause_s=1e6), "2", columns=40, NO_COLOR="1") as terminal:
        terminal.until("p holds the", "text.\r\n")
        paused = "paused after frame "
        for key, *told in (("p", "the text is held: p lets go, Enter begi\r"),
                           ("\x03", diamond, "\r\n"), ("p", paused), ("s", paused),
                           ("p", "\r\n", "\r\n"), ("p", paused)):
            terminal.press(key)
            terminal.until(*told)
        terminal.ends_at_x()
    notice = re.compile("((?:the text is held|paused after frame)[^\r]*)\r( *)\r")
    assert len(notice.findall(terminal.all)) == 4
    for told_of, blanks in notice.findall(terminal.all):
        assert len(told_of) == len(blanks) < 40
    film, _, ending = notice.sub("", terminal.all).partition(diamond)[2].partition("Stopped after ")
    frames = film.splitlines()
    assert ending.startswith(f"{len(frames)} frames, ")
    assert all(re.fullmatch("[ |*]{40}", frame) for frame in frames)


def test_keys_that_are_typed_while_pygame_loads_count() -> None:
    with Terminal(*quick(pause_s=1e6)) as terminal:
        terminal.press("p")  # long before Python runs the program
        terminal.until("p holds the text.\r\n", "the text is held")
        terminal.ends_at_x()


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


def test_the_first_reason_to_end_is_told(film: Terminal) -> None:
    film.press("xpps")
    film.until("Stopped after ", " s: x was pressed.\r\n")
    film.ends(0)


@pytest.mark.parametrize(("line", "is_plain"), [
    ('"$@" | cat', True), ('"$@" < /dev/null', False), ('setsid -w "$@" | cat', True),
    ('setsid -w "$@"', False)])  # setsid: it could not be given back
def test_a_terminal_that_is_not_the_program_s_own_input_and_output_is_left_alone(
        line: str, is_plain: bool) -> None:
    if shutil.which("setsid") is None and "setsid" in line:
        pytest.skip("setsid is not installed")
    with Terminal("sh", "-c", line, "sh", *quick(), "--frames=50") as terminal:
        terminal.until("No keys here.", "or now with Ctrl-C.", "FPS")
        assert terminal.mode() == terminal.found
        terminal.until("Stopped after ")
        terminal.ends(0)
        assert ("\x1b" not in terminal.all) is is_plain  # colours are for a terminal only


def test_when_the_terminal_is_gone_the_film_ends_even_if_sighup_is_ignored(tmp_path: Path) -> None:
    out = tmp_path / "out"  # somewhere to tell it
    line = "trap '' HUP; exec \"$@\""
    change = ("real = airtrack.run; airtrack.run = lambda *a: [print('begun', flush=True), "
              f"setattr(sys, 'stdout', open({str(out)!r}, 'w')), real(*a)]")
    with Terminal("sh", "-c", line, "sh", *quick(change)) as terminal:
        terminal.until("begun")
        terminal.hang_up()
        assert terminal.program.wait(PATIENCE_S) == 0
    assert " s: the terminal is gone.\n" in out.read_text()


def test_keys_that_were_typed_and_not_read_do_not_reach_the_shell() -> None:
    change = ("real = airtrack.render_track; airtrack.render_track = lambda *a: "
              "[print('drawing', flush=True), time.sleep(1), real(*a)][2]")
    with Terminal(*BASH, PS1="% ") as shell:
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

@pytest.fixture(params=[BASH, DASH], ids=["bash", "dash"])
def shell(request: pytest.FixtureRequest) -> Iterator[Terminal]:
    """A shell, waiting for a command."""
    if shutil.which(request.param[0]) is None:
        pytest.skip(f"{request.param[0]} is not installed")
    with Terminal(*request.param, PS1="% ") as terminal:
        terminal.until("% ")
        yield terminal


def is_given_back(shell: Terminal) -> bool:
    """Whether a shell has the terminal as found. (bash has a mode of its own while it waits.)"""
    return shell.command == tuple(BASH) or shell.mode() == shell.found


@pytest.mark.parametrize("key", ["\x1a", "SIGSTOP"], ids=["Ctrl-Z", "SIGSTOP"])
def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(key: str, shell: Terminal) -> None:
    shell.press(f"{shlex.join(quick())}\n")
    shell.until("p holds the text.", "FPS")
    for _ in range(2):
        shell.stop(key)
        shell.until("topped", "% ")  # bash: Stopped, dash: Suspended or Stopped
        assert key == "SIGSTOP" or is_given_back(shell)
        shell.press("fg\n")
        shell.until("FPS")
        shell.press("s")
        shell.until("paused after frame ")
        assert has_keys_singly(shell)
        shell.press("p")
        shell.until("FPS")
    shell.press("x")
    shell.until("Next:", "% ")
    assert is_given_back(shell)
    shell.press("exit\n")
    shell.ends(0)


def test_a_film_in_the_background_stands_still_and_fg_takes_the_terminal_again(
        shell: Terminal) -> None:
    shell.press(f"{shlex.join(quick())}\n")
    shell.until("p holds the text.", "FPS")
    shell.press("\x1a")
    shell.until("topped", "% ")
    shell.press("bg\n")
    shell.until("% ")
    shell.press("echo sh''ell\n")
    shell.until("shell", "% ")
    shell.press("fg\n")
    shell.until("FPS")
    shell.press("s")
    shell.until("paused after frame ")
    assert has_keys_singly(shell)
    shell.press("x")
    shell.until("Next:", "% ")
    shell.press("exit\n")
    shell.ends(0)


def test_two_stops_at_once_leave_the_terminal_as_found_after_each(shell: Terminal) -> None:
    # Another stop comes right before the program stops itself, as it does if Ctrl-Z comes twice.
    change = ("import signal; real = os.kill; os.kill = lambda process, number: "
              "[real(process, signal.SIGSTOP), real(process, number)]")
    shell.press(f"{shlex.join(quick(change))}\n")
    shell.until("p holds the text.", "FPS")
    shell.press("\x1a")
    for _ in range(2):
        shell.until("topped", "% ")
        assert is_given_back(shell)
        shell.press("fg\n")
    shell.until("FPS")
    shell.press("x")
    shell.until("Next:", "% ")
    shell.press("exit\n")
    shell.ends(0)


def test_ctrl_z_where_no_shell_could_continue_it_does_not_stop_it(film: Terminal) -> None:
    film.press("\x1a")
    film.until("FPS", "FPS")
    film.press("s")
    film.until("paused after frame ")
    assert has_keys_singly(film)
    film.ends_at_x()


@pytest.mark.parametrize("key", ["\x1a", "SIGSTOP"], ids=["Ctrl-Z", "SIGSTOP"])
def test_a_film_that_is_stopped_and_killed_ends(key: str) -> None:
    with Terminal(*BASH, PS1="% ") as shell:
        shell.until("% ")
        shell.press(f"{shlex.join(quick())}\n")
        shell.until("p holds the text.", "FPS")
        shell.stop(key)
        shell.until("Stopped", "% ")
        shell.press("p=$(jobs -p); kill %1; while kill -0 $p; do sleep 0.1; done; echo go''ne\n")
        shell.until("gone", "% ")
        shell.press("exit\n")
        shell.ends(0)


@pytest.mark.parametrize("names", ["HUP TERM", "TERM TERM", "STOP HUP TERM CONT"])
def test_two_signals_at_once_end_it_as_one_does(names: str) -> None:
    for _ in range(5):
        with Terminal(*quick()) as film:
            film.until("p holds the text.", "FPS")
            for name in names.split():
                film.press(f"SIG{name}")
            film.ends_by("SIGHUP", "SIGTERM")


def test_a_signal_while_the_terminal_is_given_back_is_ignored() -> None:
    change = ("import signal; real = examples.termios.tcsetattr; examples.termios.tcsetattr = "
              "lambda *a: [os.kill(os.getpid(), signal.SIGHUP), real(*a)]")
    with Terminal(*quick(change)) as film:
        film.until("p holds the text.", "FPS")
        film.press("SIGTERM")
        film.ends(143)


def test_a_signal_while_the_terminal_is_taken_leaves_it_as_found() -> None:
    change = ("import signal; real = examples.tty.setcbreak; examples.tty.setcbreak = "
              "lambda *a: [real(*a), os.kill(os.getpid(), signal.SIGTERM)]")
    with Terminal(*quick(change)) as film:
        film.ends(143)


def test_a_signal_that_was_ignored_from_the_start_stays_ignored() -> None:
    with Terminal("sh", "-c", "trap '' HUP; exec \"$@\"", "sh", *quick()) as terminal:  # nohup
        terminal.until("p holds the text.", "FPS")
        terminal.press("SIGHUP")
        terminal.until("FPS", "FPS")
        terminal.ends_at_x()


def test_after_a_film_every_signal_does_what_it_did_before() -> None:
    change = ("import atexit, signal; all = lambda: [*map(signal.getsignal, range(1, 32))]; "
              "found = all(); atexit.register(lambda: print('as before:', all() == found))")
    with Terminal(*quick(change), "1", "--frames=1") as terminal:
        terminal.ends(0)
        assert "as before: True" in terminal.all


def test_an_exception_in_mid_film_leaves_the_terminal_as_it_was_found() -> None:
    with Terminal(*quick("airtrack.render_track = lambda *_: sys.exit(3)")) as terminal:
        terminal.ends(3)


@pytest.mark.parametrize(("words", "seen"), [
    ("2 --fast", "*"), ("chart", "\r\n"), ("stability", "\r\n")])
def test_ctrl_c_kills_what_has_no_keys_so_that_a_loop_of_the_shell_ends_too(
        words: str, seen: str) -> None:
    with Terminal(*COMMAND, *words.split()) as terminal:
        terminal.until("\r\n\r\n" if seen == "*" else seen, seen)
        terminal.press("\x03")
        terminal.ends(-signal.SIGINT)


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
    def frame(*words: str, **changes: Any) -> tuple[str, str]:
        """A frame in which every mark is, as it was printed, and its details."""
        scene = "0 v_mps=8 x_m=17 fps_target=10 show_collision_mark=True"
        with Terminal(*quick(), *scene.split(), "--frames=1", *words, **changes) as terminal:
            terminal.ends(0)
            line = terminal.all.partition("\r\n\r\n")[2].splitlines()[0]
            picture, _, details = line.partition("x =")
            return picture, details

    coloured, details = frame()
    for mark in ("\x1b[33m*\x1b[0m", "\x1b[31m0\x1b[0m", "\x1b[32mo\x1b[0m", "\x1b[36m+\x1b[0m"):
        assert mark in coloured
    assert "0" in details
    assert "\x1b" not in details
    plain = re.sub("\x1b\\[[0-9]*m", "", coloured)
    for others in ({"NO_COLOR": "1"}, {"TERM": "dumb"}, {"TERM": None}):
        assert frame(**others)[0] == plain
    assert frame("--fast")[0] == plain


@pytest.mark.parametrize(("words", "widest"), [
    ("0", 163), ("10 d", 172), ("14 d x_m=999", 189),  # 14: beyond 1000 m
    ("99 d v_mps=-1000 CR=1", 189), ("16 d", 189), ("1", 135)])
def test_no_line_is_wider_than_the_terminal_and_no_paragraph_than_100(
        words: str, widest: int) -> None:
    for columns in (80, widest - 1, widest):
        with Terminal(*quick(), *words.split(), "--frames=6", columns=columns,
                      NO_COLOR="1") as film:
            film.ends(0)
        assert max(map(len, film.all.splitlines())) <= columns
        header, _, *paragraphs = film.all.split("\r\n\r\n")
        for paragraph in (header, *paragraphs):
            assert max(map(len, paragraph.splitlines())) <= 100
        told = "columns wide, to fit into the terminal."
        assert (told in " ".join(film.all.split())) is (columns < widest)
