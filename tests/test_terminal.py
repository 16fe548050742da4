"""The keys of a real terminal (a pseudo-terminal), its signals and job control, and how it is left.

What a key does to the film is tested on a set clock, in test_run.py. Here a test waits for what
must come, however slow the machine is.
"""

import contextlib
import os
import re
import select
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import examples
from films import COMMAND, HERE, environment

if sys.platform == "win32":
    pytest.skip("needs a POSIX pseudo-terminal", allow_module_level=True)

import fcntl
import struct
import termios

PATIENCE_S = 30  # for what must come: only a test that fails waits so long


def sit_down() -> None:
    """At the terminal that is standard input. Ctrl-C works there, even if the tests ignore it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    for number in (signal.SIGINT, signal.SIGQUIT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


class Terminal:
    """A program in a pseudo-terminal of its own, as somebody at the keyboard sees it."""

    def __init__(self, *command: str, columns: int = 200, stderr: int | None = None,
                 env: dict[str, str] | None = None) -> None:
        self.ours, self.theirs = os.openpty()
        fcntl.ioctl(self.theirs, termios.TIOCSWINSZ, struct.pack("4H", 40, columns, 0, 0))
        self.found = self.mode()
        self.all = self.text = ""  # all that came; what is still to be looked at, without colours
        self.program = subprocess.Popen(
            command, stdin=self.theirs, stdout=self.theirs, stderr=stderr or self.theirs, cwd=HERE,
            env=env or environment(PS1="$ "), start_new_session=True, preexec_fn=sit_down)

    def __enter__(self) -> "Terminal":
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.program.pid, signal.SIGKILL)
        self.program.communicate()
        os.close(self.ours)
        os.close(self.theirs)

    def mode(self) -> list[Any]:
        return termios.tcgetattr(self.ours)

    def type(self, keys: str) -> None:
        os.write(self.ours, keys.encode())

    def stop(self) -> None:
        self.program.send_signal(signal.SIGSTOP)
        os.waitid(os.P_PID, self.program.pid, os.WSTOPPED)

    def read(self, wait_s: float) -> bool:
        """Read some of what there is; False if nothing came in that time."""
        is_ready = bool(select.select([self.ours], [], [], wait_s)[0])
        if is_ready:
            piece = os.read(self.ours, 65536).decode(errors="replace")
            self.all += piece
            self.text = plain(self.text + piece)
        return is_ready

    def until(self, *texts: str) -> str:
        """Wait until the texts have come, one after the other; all that came up to the last."""
        deadline_s, seen = time.monotonic() + PATIENCE_S, ""
        for text in texts:
            while text not in self.text:
                assert time.monotonic() < deadline_s, f"no {text!r}: {self.text[-1000:]}"
                self.read(0.1)
            before, _, self.text = self.text.partition(text)
            seen += before + text
        return seen

    def ends(self, *statuses: int) -> None:
        """Wait for the end: with one of these, without a traceback, the terminal as found."""
        deadline_s = time.monotonic() + PATIENCE_S
        while self.program.poll() is None:
            assert time.monotonic() < deadline_s, self.text[-1000:]
            self.read(0.05)
        while self.read(0):
            pass
        assert self.program.returncode in statuses, self.text[-1000:]
        assert self.mode() == self.found
        assert "Traceback" not in self.all


def plain(text: str) -> str:
    """A text without its colours."""
    return re.sub("\x1b\\[[0-9]*m", "", text)


@pytest.fixture
def film() -> Iterator[Terminal]:
    """The one-pager, running."""
    with Terminal(*COMMAND) as terminal:
        terminal.until("Keys, in this terminal: p ", "FPS")
        yield terminal


# Keys.

def test_while_it_runs_keys_come_singly_and_unechoed_and_flow_control_is_off(
        film: Terminal) -> None:
    input_flags, _, _, local_flags, *_ = film.mode()
    assert not local_flags & (termios.ICANON | termios.ECHO)
    assert local_flags & termios.ISIG
    assert not input_flags & termios.IXON


@pytest.mark.parametrize(("key", "why", "status"), [
    ("x", "x was pressed", 0), ("\x1b", "Esc was pressed", 0),
    ("\x1b" * 4000, "Esc was pressed", 0), ("\x03", "Ctrl-C was pressed", 0),
    ("SIGTERM", "SIGTERM", 143), ("SIGHUP", "SIGHUP", 129), ("SIGQUIT", "SIGQUIT", 131)],
    ids=["x", "Esc", "4000 Esc", "Ctrl-C", "SIGTERM", "SIGHUP", "SIGQUIT"])
def test_a_key_or_a_signal_ends_the_run_and_leaves_the_terminal_as_it_was_found(
        key: str, why: str, status: int, film: Terminal) -> None:
    if why == key:
        film.program.send_signal(signal.Signals[key])
    else:
        film.type(key)
    ending = film.until(" s: ", f"{why}.\r\n").splitlines()[-1]
    assert re.fullmatch(rf"Stopped after [0-9]+ frames?, t = [0-9.]+ s: {why}\.", ending)
    film.ends(status)


def test_p_and_ctrl_s_pause_and_resume_and_s_goes_one_frame_further(film: Terminal) -> None:
    def paused() -> tuple[int, int]:
        told = film.until("paused after frame ", " s: p goes on")
        frame, t_s = re.findall("([0-9]+), t = ([0-9.]+) s: p goes on", told)[0]
        assert float(t_s) == round(int(frame) * 0.015, 2)
        return int(frame), told.count("FPS")

    film.type("p")
    first, _ = paused()
    for frame in (first + 1, first + 2):
        film.type("s")
        assert paused() == (frame, 1)
    film.type("\x13")
    film.until("FPS", "FPS", "FPS")
    film.type("\x13")
    last, shown = paused()
    assert last == first + 2 + 3 + shown
    film.type("x")
    film.ends(0)
    # Blanks replace what tells of the pause, so that on the screen there are frames alone.
    told = re.compile("(paused[^\r\n]*)\r( *)\r")
    assert {len(notice) - len(blanks) for notice, blanks in told.findall(film.all)} == {0}
    lines = told.sub("", plain(film.all)).split("\r\n\r\n")[1].splitlines()
    assert [bool(re.match("    .*FPS =", line)) for line in lines] == [True] * last + [False]


def test_arrows_and_other_keys_do_nothing(film: Terminal) -> None:
    shift_F1, shift_F4 = "\x1bO2P", "\x1bO2S"  # as Konsole sends them
    for keys in ("\x1b[A", "\x1bOP", "\x1b[1;5C", "\x1b[15~", shift_F1, shift_F4, "\x1bp", "\x1bx",
                 "\x1b\x1b[A", "qwy\t\r\n", "\u00e4\u20ac\u0178"):
        film.type(keys)
        film.until("FPS", "FPS")
    film.type("p")
    film.until("paused")
    film.type("x")
    film.until("x was pressed")
    film.ends(0)
    assert film.all.count("paused") == 1


def typed(monkeypatch: pytest.MonkeyPatch, *pieces: bytes, at_once: int = 1) -> str:
    """Which keys the pieces are: at_once are there, the others come while somebody waits.

    A stand-in types them: how fast a second piece comes must not depend on the machine.
    """
    left, looks = list(pieces), []

    def ready(fds: list[int], _: object, __: object, wait_s: float) -> tuple[list[int]]:
        assert wait_s <= 0.1
        looks.append(wait_s)
        return (fds if left and (wait_s or len(looks) <= at_once) else [],)

    monkeypatch.setattr(examples, "select", SimpleNamespace(select=ready))
    monkeypatch.setattr(examples, "os", SimpleNamespace(read=lambda *_: left.pop(0)))
    monkeypatch.setattr(examples.Terminal, "take", lambda _: None)
    terminal = examples.Terminal()
    terminal.is_raw = True
    return terminal.read()


@pytest.mark.parametrize(("first", "rest"), [
    (b"\x1b", b"[A"), (b"\x1b[", b"A"), (b"\x1b[1;", b"5C"), (b"\x1bO", b"P"), (b"\x1bO2", b"P"),
    (b"\x1b", b"p"), (b"\x1b[A" * 1365 + b"\x1b", b"[A")])  # the last: as much as it reads at once
def test_a_sequence_may_come_in_two_pieces(
        first: bytes, rest: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    assert typed(monkeypatch, first, rest + b"p\x1b") == "p\x1b"  # and the last Esc is a key


@pytest.mark.timeout(20)  # where the time grows with the square of the number, it takes hours
def test_a_flood_of_keys_does_not_hold_the_film(monkeypatch: pytest.MonkeyPatch) -> None:
    assert typed(monkeypatch, b"\x1b" * 2_000_000) == "\x1b"
    assert typed(monkeypatch, b"\x1b[" * 1_000_000) == ""
    assert typed(monkeypatch, *[b"q" * 1000] * 100, at_once=100) == "q" * 5000  # a portion of it


def test_keys_count_in_the_header_s_pause_and_ctrl_c_cuts_it_short_with_a_diamond() -> None:
    code = ("import sys, airtrack; from examples import EXAMPLES; "
            "EXAMPLES[1] = EXAMPLES[1]._replace(pause_s=1e6); sys.exit(airtrack.main(['1', 'd']))")
    with Terminal(sys.executable, "-c", code) as terminal:
        terminal.until("The film begins in ", "\r\n")
        terminal.type("p")
        terminal.until("paused after frame 0, t = 0.00 s: p goes on")
        terminal.type("\x03")
        time.sleep(1.1)  # long enough to tell that a signal to end came in vain; this one did not
        terminal.until("   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n\r\n", "paused after frame 0")
        terminal.type("p")
        terminal.until("FPS", "FPS")
        terminal.type("\x03")
        terminal.until(": Ctrl-C was pressed.")
        terminal.ends(0)


def test_ctrl_c_before_a_film_without_a_pause_quits_it(tmp_path: Path) -> None:
    (tmp_path / "pygame.py").write_text(
        "import os, signal; os.kill(os.getpid(), signal.SIGINT); raise ImportError")
    with Terminal(*COMMAND, env=environment(PYTHONPATH=str(tmp_path), DISPLAY=":0")) as terminal:
        terminal.until("Stopped after 0 frames, t = 0.00 s: Ctrl-C was pressed.")
        terminal.ends(0)


def test_standard_input_that_is_open_for_writing_only_has_no_keys_and_is_no_error() -> None:
    with Terminal("sh", "-c", 'exec "$@" 0> /dev/tty', "sh", *COMMAND) as terminal:
        terminal.until("FPS")
        terminal.type("x")
        terminal.until("FPS", "FPS", "FPS")
        terminal.type("\x03")
        terminal.until(": Ctrl-C was pressed.")
        terminal.ends(0)


# Signals.

@pytest.mark.parametrize(("names", "why"), [
    ("INT TERM", "Ctrl-C was pressed"), ("HUP TERM QUIT", "SIGHUP"), ("TERM CONT", "SIGTERM"),
    ("TERM wait INT", " s: "), ("INT wait INT wait INT wait INT", "Ctrl-C was pressed")])
def test_signals_close_together_end_the_run_as_the_first_does(
        names: str, why: str, film: Terminal) -> None:
    for name in names.split():
        if name == "wait":
            time.sleep(0.001)
        else:
            film.program.send_signal(signal.Signals[f"SIG{name}"])
    film.until("Stopped after ", why, ".\r\n")
    # One that comes when the run is over is Python's again.
    film.ends(0, *(128 + number for number in (1, 2, 3, 15)), *(-1, -2, -3, -15))


# The program, with a signal at a line of one of its functions, once it can answer for it.
INTERRUPTED = """if True:
    import os, runpy, signal, sys
    _, number, name, left, *sys.argv = sys.argv
    number, left, home = int(number), int(left), os.path.dirname(sys.argv[0])

    def trace(frame, event, _):
        global left
        code, is_ready = frame.f_code, sys.excepthook is not sys.__excepthook__
        is_place = os.path.dirname(code.co_filename) == home and code.co_name == name
        if is_place and event == "line" and is_ready:
            left -= 1
            if left == 0:
                os.kill(os.getpid(), number)
        return trace

    sys.settrace(trace)
    runpy.run_path(sys.argv[0], run_name="__main__")
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(("function", "lines"), [
    ("<module>", range(1, 250, 30)), ("main", range(1, 12, 3)), ("film", range(1, 18, 4)),
    ("__enter__", range(1, 28, 4)), ("__exit__", range(1, 16, 3)), ("look", range(1, 11, 4))])
def test_a_signal_at_any_moment_leaves_no_traceback_and_the_terminal_as_it_was_found(
        function: str, lines: range, number: signal.Signals) -> None:
    for line in lines:
        with Terminal(sys.executable, "-c", INTERRUPTED, str(int(number)), function, str(line),
                      COMMAND[1], "--frames", "3") as terminal:
            terminal.ends(0, 128 + number, -number)


def test_a_signal_that_was_ignored_from_the_start_stays_ignored() -> None:
    with Terminal("sh", "-c", "trap '' HUP; exec \"$@\"", "sh", *COMMAND) as terminal:  # nohup
        terminal.until("FPS")
        terminal.program.send_signal(signal.SIGHUP)
        terminal.until("FPS", "FPS")
        terminal.type("x")
        terminal.until("x was pressed")
        terminal.ends(0)


def test_an_exception_leaves_the_terminal_as_it_was_found() -> None:
    code = "import airtrack; airtrack.render_track = lambda *_: 1 / 0; airtrack.main([])"
    with Terminal(sys.executable, "-c", code) as terminal:
        terminal.until("ZeroDivisionError")
        assert terminal.program.wait(PATIENCE_S) == 1
        assert terminal.mode() == terminal.found


def test_a_run_that_hangs_in_a_terminal_that_does_not_read_is_ended_by_a_later_signal(
        film: Terminal) -> None:
    film.stop()
    fill(film.theirs)
    for number in (signal.SIGCONT, signal.SIGTERM, signal.SIGTERM):
        film.program.send_signal(number)
    time.sleep(1.2)
    assert film.program.poll() is None  # for a second, it might end by itself yet
    film.program.send_signal(signal.SIGTERM)
    assert film.program.wait(PATIENCE_S) == 128 + signal.SIGTERM
    assert film.mode() == film.found


def fill(terminal: int) -> None:
    """Write to a terminal until it takes nothing more."""
    file, is_full = os.open(os.ttyname(terminal), os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY), False
    while not is_full:
        is_full = True
        with contextlib.suppress(BlockingIOError):
            while os.write(file, b"."):
                is_full = False
        time.sleep(0.1)  # the system may make some room yet
    os.close(file)


@pytest.mark.parametrize("key", ["p", "q"])
def test_a_terminal_that_hangs_up_ends_the_run_without_a_word(key: str) -> None:
    with Terminal(*COMMAND, stderr=subprocess.PIPE) as terminal:
        terminal.until("FPS")
        terminal.type(key)
        terminal.until("paused" if key == "p" else "FPS")
        with open(os.devnull) as nothing:
            os.dup2(nothing.fileno(), terminal.ours)
        _, err = terminal.program.communicate(timeout=PATIENCE_S)
        assert (terminal.program.returncode, err) == (128 + signal.SIGHUP, b"")


# Job control, in shells without a line editor: they leave the terminal's mode to the program, and
# dash does not put it right.

FILM = " ".join(COMMAND)


@pytest.fixture(params=["bash --norc --noediting -i", "dash -i"], ids=["bash", "dash"])
def shell(request: pytest.FixtureRequest) -> Iterator[Terminal]:
    """A shell, waiting for a command."""
    words = request.param.split()
    if shutil.which(words[0]) is None:
        pytest.skip(f"needs {words[0]}, for its job control")
    with Terminal(*words) as terminal:
        terminal.until("$ ")
        yield terminal
        assert "Traceback" not in terminal.all


@pytest.fixture
def job(shell: Terminal) -> Terminal:
    """A shell, with a film in the foreground."""
    shell.type(f"{FILM}\n")
    shell.until("FPS")
    return shell


def suspend(job: Terminal, keys: str = "\x1a") -> None:
    """Press Ctrl-Z, and look how the terminal is left."""
    for key in keys:
        job.type(key)
        time.sleep(0.001)
    job.until("Stopped", "$ ")
    assert job.mode() == job.found


def pause_and_quit(job: Terminal) -> None:
    """Press keys, without Enter, and look how the terminal is left."""
    job.type("p")
    job.until("paused after frame")
    job.type("x")
    job.until(": x was pressed.", "$ ")
    assert job.mode() == job.found


def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(job: Terminal) -> None:
    for keys in ("\x1a", "\x1a", "\x1a\x1a"):  # twice is one suspension, and one fg
        suspend(job, keys)
        job.type("fg\n")
        job.until("FPS", "FPS")
    pause_and_quit(job)


def test_after_ctrl_z_and_fg_a_paused_run_says_again_that_it_is_paused(job: Terminal) -> None:
    job.type("p")
    job.until("paused after frame")
    suspend(job)
    job.type("fg\n")
    job.until("paused after frame")
    job.type("p")
    job.until("FPS")
    pause_and_quit(job)


@pytest.mark.parametrize("command", ["bg", "kill -CONT %1"])
def test_in_the_background_it_leaves_the_terminal_alone_until_fg(
        command: str, job: Terminal) -> None:
    suspend(job)
    job.type(f"{command}\n")
    job.until("FPS", "FPS", "FPS")
    assert job.mode() == job.found
    job.type("fg\n")
    pause_and_quit(job)


def test_started_in_the_background_it_takes_the_keys_at_fg(shell: Terminal) -> None:
    shell.type(f"{FILM} &\n")
    shell.until("Keys: Ctrl-C quits.", "FPS", "FPS")
    assert shell.mode() == shell.found
    shell.type("fg\n")
    pause_and_quit(shell)


def test_kill_ends_a_suspended_run(job: Terminal) -> None:
    suspend(job)
    job.type("kill %1; fg; echo en''ded\n")  # bash wakes it at kill; dash, as any program, at fg
    job.until("Stopped after ", ": SIGTERM.\r\n")
    job.until("ended\r\n", "$ ")
    assert job.mode() == job.found


def test_a_process_stopped_and_continued_takes_its_keys_again(film: Terminal) -> None:
    film.stop()
    termios.tcsetattr(film.theirs, termios.TCSANOW, film.found)  # as a shell would
    film.program.send_signal(signal.SIGCONT)
    film.until("FPS", "FPS")
    film.type("x")
    film.until("x was pressed")
    film.ends(0)


def test_a_terminal_that_is_not_the_controlling_one_is_left_alone(film: Terminal) -> None:
    run = subprocess.run([*COMMAND, "--frames", "3"], stdin=film.theirs, stdout=film.theirs,
                         stderr=subprocess.PIPE, text=True, env=environment(), check=False,
                         start_new_session=True)
    assert (run.returncode, run.stderr) == (0, "")
    film.until("Keys: Ctrl-C quits.")


# The picture.

def test_the_marks_are_coloured_and_only_coloured_unless_that_is_not_wanted() -> None:
    def frame(**changes: str | None) -> tuple[str, str]:
        """Every mark is in this frame: all that was printed, and the frame without colours."""
        words = "0 x_m=17 v_mps=8 fps_target=10 show_collision_mark=True show_exact_mark=True"
        with Terminal(*COMMAND, *words.split(), "--frames=1",
                      env=environment(**changes)) as terminal:
            line = terminal.until("\r\n\r\n", "FPS").splitlines()[-1]
            terminal.ends(0)
            return terminal.all, line

    coloured, line = frame()
    for mark in ("\x1b[33m*\x1b[0m", "\x1b[31m0\x1b[0m", "\x1b[32mo\x1b[0m"):
        assert mark in coloured
    for plain, same_line in (frame(NO_COLOR="1"), frame(TERM="dumb")):
        assert "\x1b" not in plain
        assert same_line == line


@pytest.mark.parametrize("columns", [20, 80, 120, 200])
@pytest.mark.parametrize(("words", "widest"), [("0", 159), ("10 d", 168), ("99", 135)])
def test_no_line_is_wider_than_the_terminal(words: str, widest: int, columns: int) -> None:
    with Terminal(*COMMAND, *words.split(), columns=columns) as terminal:
        shown = terminal.until("\r\n")
        if words != "0":
            terminal.program.send_signal(signal.SIGINT)  # no need to read it all
        shown += terminal.until("*", "\r\n", "|", "\r\n")
        terminal.type("x")
        shown += terminal.until("x was", "pressed.")
        terminal.ends(0)
    if columns > 20:  # which has no room for the details
        assert max(map(len, shown.splitlines())) <= columns
    assert ("physics is untouched" in " ".join(shown.split())) is (columns < widest)
