"""The keys of a real terminal (a pseudo-terminal), its signals, and how it is left.

What a key does to the film is tested on a set clock, in test_run.py. Here a test waits for what
must come, however slow the machine is.
"""

import importlib.util
import os
import re
import shlex
import shutil
import signal
import socket
import sys
from collections.abc import Iterator
from pathlib import Path

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
    """Whether keys come one by one and unechoed, and Ctrl-C is still a signal."""
    _, _, _, local_flags, *_, characters = terminal.mode()
    flags = local_flags & (termios.ICANON | termios.ECHO | termios.ISIG)
    return (flags, characters[termios.VMIN], characters[termios.VTIME]) == (termios.ISIG, 1, 0)


@pytest.fixture(params=[BASH, DASH], ids=["bash", "dash"])
def shell(request: pytest.FixtureRequest) -> Iterator[Terminal]:
    if shutil.which(request.param[0]) is None:
        pytest.skip(f"{request.param[0]} is not installed")
    with Terminal(*request.param, PS1="% ") as terminal:
        yield terminal


def begin(shell: Terminal, change: str = "pass", words: str = "", seen: str = "FPS") -> None:
    """Begin a film in a shell, and wait until something of it is seen."""
    shell.until("% ")
    shell.press(f"{shlex.join(quick(change))} {words}\n")
    shell.until("p holds the text.", seen)


def bring_back(shell: Terminal) -> None:
    """Bring a stopped film to the foreground, where it must go on and have its keys again."""
    shell.press("fg\n")
    shell.until("FPS")
    shell.press("s")
    shell.until("paused after frame ")
    assert has_keys_singly(shell)
    shell.press("p")
    shell.until("FPS")


def is_given_back(shell: Terminal) -> bool:
    """Whether a shell has the terminal as found. (bash has a mode of its own while it waits.)"""
    return shell.command == tuple(BASH) or shell.mode() == shell.found


def leave(shell: Terminal) -> None:
    """End the film and the shell."""
    shell.press("x")
    shell.until("Next:", "% ")
    assert is_given_back(shell)
    shell.press("exit\n")
    shell.ends(0)


# Keys.

@pytest.mark.parametrize(("key", "status"), [
    ("x", 0), ("\x03", 0), ("SIGTERM", 143), ("SIGHUP", 129), ("SIGQUIT", 131)],
    ids=["x", "Ctrl-C", "SIGTERM", "SIGHUP", "SIGQUIT"])
def test_a_key_or_a_signal_ends_the_run_and_leaves_the_terminal_as_it_was_found(
        key: str, status: int, film: Terminal) -> None:
    film.press(key)
    if status == 0:
        film.until("Stopped after ", "was pressed.\r\n", "The hops in frames")
    film.ends(status)
    assert ("Next: " in film.all) is (status == 0)


def test_keys_count_from_the_start_and_a_pause_leaves_the_frames_alone() -> None:
    diamond = "   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n\r\n"
    with Terminal(*quick(pause_s=1e6), "2", columns=40, NO_COLOR="1") as terminal:
        terminal.press("p")  # long before Python runs the program
        terminal.until("p holds the", "text.\r\n", "the text is held: p lets go, Enter begi\r")
        for key, *told in (("\x03", diamond, "\r\n"), ("p", "paused after "), ("s", "paused after"),
                           ("p", "\r\n", "\r\n"), ("p", "paused after ")):
            terminal.press(key)
            terminal.until(*told)
        terminal.ends_at_x()
    notice = re.compile("((?:the text is held|paused after frame)[^\r]*)\r( *)\r")
    for told_of, blanks in notice.findall(terminal.all):
        assert len(told_of) == len(blanks) < 40
    film, _, ending = notice.sub("", terminal.all).partition(diamond)[2].partition("Stopped after ")
    frames = film.splitlines()
    assert ending.startswith(f"{len(frames)} frames, ")
    assert all(re.fullmatch("[ |*]{40}", frame) for frame in frames)


def test_arrows_mouse_reports_late_replies_and_other_keys_do_nothing(film: Terminal) -> None:
    for keys in ("\x1b", "\x1b[A", "\x1bOP", "\x1b[1;5C", "\x1bp", "\x1b[<0;10;10Mpx", "\x1b[M xp",
                 "\x1bP>|xterm(379)\x1b\\", "\x1b_ixp\x1b\\", "qwy\t\r\n", "\u00e4\u20ac\u0178"):
        film.press(keys)
        film.goes_on()
    film.press("s\x1b[A")  # what comes before an Esc counts
    film.until("paused after frame")
    film.press("xps")  # nor does anything do after x
    film.until(" s: x was pressed.")
    film.ends(0)
    assert film.all.count("paused") == 1


@pytest.mark.parametrize("line", [
    '"$@" | cat', '"$@" < /dev/null', 'setsid -w "$@"'])  # setsid: it could not be given back
def test_a_terminal_that_is_not_the_program_s_own_input_and_output_is_left_alone(
        line: str) -> None:
    if shutil.which("setsid") is None and "setsid" in line:
        pytest.skip("setsid is not installed")
    with Terminal("sh", "-c", line, "sh", *quick(), "--frames=50") as terminal:
        terminal.until("No keys here.", "or now with Ctrl-C.", "FPS")
        assert terminal.mode() == terminal.found
        terminal.ends(0)
        assert ("\x1b" in terminal.all) is ("cat" not in line)  # colours are for a terminal only


def test_keys_that_were_typed_and_not_read_do_not_reach_the_shell() -> None:
    change = ("real = airtrack.render_track; airtrack.render_track = lambda *a: "
              "[print('drawing', flush=True), examples.select.select([0], [], []), real(*a)][2]")
    with Terminal(*BASH, PS1="% ") as shell:
        begin(shell, change, "2 --frames 1", "drawing")  # after the last look at the keys
        shell.press("x")
        shell.until("Next:", "% ")
        shell.press("echo status $?\n")
        shell.until("status 0")
        assert "xecho" not in shell.all


# Signals.

@pytest.mark.parametrize("key", ["\x1a", "SIGSTOP"], ids=["Ctrl-Z", "SIGSTOP"])
def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(key: str, shell: Terminal) -> None:
    begin(shell)
    for _ in range(2):
        shell.press(key)
        shell.until("topped", "% ")  # bash: Stopped, dash: Suspended or Stopped
        assert key == "SIGSTOP" or is_given_back(shell)
        bring_back(shell)
    leave(shell)


def test_a_film_in_the_background_stands_still_and_fg_takes_the_terminal_again(
        shell: Terminal) -> None:
    begin(shell)
    shell.press("\x1a")
    shell.until("topped", "% ")
    in_the_background = len(shell.all)
    shell.press("bg\n")
    shell.until("% ")
    shell.press("echo sh''ell\n")
    shell.until("shell", "% ")
    assert "FPS" not in shell.all[in_the_background:]
    bring_back(shell)
    leave(shell)


def test_two_stops_at_once_leave_the_terminal_as_found_after_each(shell: Terminal) -> None:
    # Another stop comes right before the program stops itself, as it does if Ctrl-Z comes twice.
    begin(shell, "import signal; real = os.kill; os.kill = lambda process, number: "
          "[real(process, signal.SIGSTOP), real(process, number)]")
    shell.press("\x1a")
    for _ in range(2):
        shell.until("topped", "% ")
        assert is_given_back(shell)
        shell.press("fg\n")
    shell.until("FPS")
    leave(shell)


def test_ctrl_z_where_no_shell_could_continue_it_does_not_stop_it(film: Terminal) -> None:
    film.press("\x1a")
    film.goes_on()
    assert has_keys_singly(film)
    film.ends_at_x()


@pytest.mark.parametrize("key", ["\x1a", "SIGSTOP"], ids=["Ctrl-Z", "SIGSTOP"])
def test_a_film_that_is_stopped_and_killed_ends(key: str) -> None:
    with Terminal(*BASH, PS1="% ") as shell:
        begin(shell)
        shell.press(key)
        shell.until("Stopped", "% ")
        shell.press("p=$(jobs -p); kill %1; while kill -0 $p; do sleep 0.1; done; echo go''ne\n")
        shell.until("gone", "% ")
        shell.press("exit\n")
        shell.ends(0)


def test_two_signals_at_once_end_it_as_one_does(film: Terminal) -> None:
    for name in ("SIGSTOP", "SIGHUP", "SIGTERM", "SIGCONT"):
        film.press(name)
    film.ends(129, 143)


SEND = "import signal; send = lambda name: os.kill(os.getpid(), signal.Signals[name]); "


def test_a_signal_while_the_terminal_is_taken_leaves_it_as_found() -> None:
    change = ("take = examples.tty.setcbreak; "
              "examples.tty.setcbreak = lambda *a: [take(*a), send('SIGTERM')]")
    with Terminal(*quick(SEND + change)) as film:
        film.ends(143)


def test_signals_while_the_terminal_is_given_back_are_ignored() -> None:
    change = ("give = examples.termios.tcsetattr; examples.termios.tcsetattr = "
              "lambda *a: [send('SIGHUP'), give(*a), send('SIGTSTP')]")
    with Terminal(*quick(SEND + change)) as film:
        film.until("p holds the text.", "FPS")
        film.ends_at_x()


def test_a_paused_film_for_which_sighup_is_ignored_ends_only_when_its_terminal_is_gone() -> None:
    with Terminal("sh", "-c", "trap '' HUP; exec \"$@\"", "sh", *quick()) as terminal:  # nohup
        terminal.until("p holds the text.", "FPS")
        terminal.press("SIGHUP")
        terminal.goes_on()
        terminal.press("p")
        terminal.until("paused after frame")
        terminal.hang_up()
        terminal.program.wait(PATIENCE_S)


def test_after_a_film_every_signal_does_what_it_did_before_and_the_python_that_runs_is_named(
        tmp_path: Path) -> None:
    change = ("import atexit, signal; all = lambda: [*map(signal.getsignal, range(1, 32))]; "
              "found = all(); atexit.register(lambda: print('as before:', all() == found))")
    (tmp_path / "python7.1").symlink_to(sys.executable)
    words = [str(tmp_path / "python7.1"), *quick(change)[1:], "1", "--frames=1"]
    with Terminal(*words, PYTHONPATH=os.pathsep.join(sys.path)) as terminal:
        terminal.until("\r\nNext: python7.1 airtrack.py 2\r\n", "as before: True")
        terminal.ends(0)


@pytest.mark.parametrize("words", ["2 --fast", "chart"])
def test_ctrl_c_kills_what_has_no_keys_so_that_a_loop_of_the_shell_ends_too(words: str) -> None:
    with Terminal(*COMMAND, *words.split()) as terminal:
        terminal.until("\r\n")
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

def test_the_marks_are_coloured_and_only_the_marks_unless_that_is_not_wanted() -> None:
    words = "0 v_mps=8 x_m=17 fps_target=10 show_collision_mark=True --frames=1"  # has every mark
    pictures = []
    for changes in ({}, {"NO_COLOR": "1"}, {"TERM": "dumb"}, {"TERM": None}):
        with Terminal(*quick(), *words.split(), **changes) as terminal:
            terminal.ends(0)
        picture, _, details = terminal.all.split("\r\n\r\n")[1].splitlines()[0].partition("x =")
        assert "\x1b" not in details
        pictures.append(picture)
    coloured, *plain = pictures
    marks = {("33", "*"), ("36", "+"), ("32", "o"), ("31", "0")}
    assert set(re.findall("\x1b\\[([0-9]+)m(.)\x1b\\[0m", coloured)) == marks
    assert plain == [re.sub("\x1b\\[[0-9]+m", "", coloured)] * 3


@pytest.mark.parametrize(("words", "widest"), [
    ("0", 163), ("1", 135), ("14 d x_m=999", 189), ("99 d v_mps=-1000 CR=1", 189)])
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
        assert (told in " ".join(header.split())) is (columns < widest)
