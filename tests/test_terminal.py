"""The keys of a real terminal (a pseudo-terminal), and how the terminal is left."""

import contextlib
import os
import select
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from types import TracebackType

import pytest

import examples
from films import COMMAND, HERE, environment

if sys.platform == "win32":
    pytest.skip("needs a POSIX pseudo-terminal", allow_module_level=True)

import fcntl
import struct
import termios

PATIENCE_S = 15


class Terminal:
    """A program in a pseudo-terminal of its own, as somebody at the keyboard sees it."""

    def __init__(self, *command: str, columns: int = 200, **changes: str | None) -> None:
        self.ours, self.theirs = os.openpty()
        fcntl.ioctl(self.theirs, termios.TIOCSWINSZ, struct.pack("4H", 40, columns, 0, 0))
        self.found = termios.tcgetattr(self.theirs)
        self.text = ""
        self.program = subprocess.Popen(
            command, stdin=self.theirs, stdout=self.theirs, stderr=self.theirs, cwd=HERE,
            env=environment(COLUMNS=None, LINES=None, PS1="$ ", **changes), start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))

    def __enter__(self) -> "Terminal":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.program.pid, signal.SIGKILL)
        self.program.wait()
        os.close(self.ours)
        os.close(self.theirs)

    def read(self, wait_s: float) -> bool:
        """Read what there is; False if nothing came in that time."""
        ready = bool(select.select([self.ours], [], [], wait_s)[0])
        if ready:
            self.text += os.read(self.ours, 65536).decode()
        return ready

    def until(self, *texts: str) -> str:
        """Wait until the texts have come, one after the other; what came before the last's end."""
        deadline_s, seen = time.monotonic() + PATIENCE_S, ""
        for text in texts:
            while text not in self.text:
                assert self.read(1) or time.monotonic() < deadline_s, f"no {text!r}: {self.text}"
            before, _, self.text = self.text.partition(text)
            seen += before + text
        return seen

    def type(self, keys: str) -> None:
        os.write(self.ours, keys.encode())

    def quiet(self, for_s: float) -> bool:
        """Whether nothing more is printed, after what is on its way."""
        while self.read(0.3):
            pass
        return not self.read(for_s)

    def ends(self) -> int:
        """Wait for the program's end, reading on; its exit status."""
        deadline_s = time.monotonic() + PATIENCE_S
        while self.program.poll() is None:
            self.read(0.1)
            assert time.monotonic() < deadline_s, self.text
        while self.read(0):
            pass
        return self.program.returncode

    def mode(self) -> list[object]:
        return termios.tcgetattr(self.theirs)


def airtrack(*words: str, columns: int = 200, **changes: str | None) -> Terminal:
    return Terminal(*COMMAND, *words, columns=columns, **changes)


@pytest.fixture
def film() -> Iterator[Terminal]:
    """The one-pager, running."""
    with airtrack() as terminal:
        terminal.until("FPS =  67")
        yield terminal


def local_flags(terminal: Terminal) -> int:
    flags = terminal.mode()[3]
    assert isinstance(flags, int)
    return flags


def test_while_it_runs_keys_come_singly_and_unechoed_and_flow_control_is_off(
        film: Terminal) -> None:
    film.until("\n")
    assert not local_flags(film) & (termios.ICANON | termios.ECHO)
    assert local_flags(film) & termios.ISIG
    assert not int(str(film.mode()[0])) & termios.IXON


@pytest.mark.parametrize(("key", "why"), [
    ("x", "x was pressed"), ("X", "x was pressed"), ("\x1b", "Esc was pressed"),
    ("\x03", "Ctrl-C was pressed")])
def test_a_key_quits_and_leaves_the_terminal_as_it_was_found(
        key: str, why: str, film: Terminal) -> None:
    film.type(key)
    film.until("Stopped after ", f": {why}.\r\n")
    assert film.ends() == 0
    assert film.mode() == film.found
    assert "Traceback" not in film.text


@pytest.mark.parametrize("key", ["p", "\x13"])
def test_a_key_pauses_and_resumes(key: str, film: Terminal) -> None:
    film.type(key)
    film.until("paused: p goes on, x quits\r\n")
    assert film.quiet(0.5)
    film.type(key)
    film.until("FPS", "FPS", "FPS")
    film.type("p")
    film.until("paused")
    film.type("x")
    assert film.ends() == 0


@pytest.mark.parametrize("keys", ["\x1b[A", "\x1bOP", "\x1b[1;5C", "\x1b[15~", "\x1bp", "\x1bx",
                                  "qwy\t\r\n", "\u00e4\u20ac"])
def test_arrows_and_other_keys_do_nothing(keys: str, film: Terminal) -> None:
    film.type(keys)
    film.until(*["FPS"] * 30)
    assert film.program.poll() is None
    assert "paused" not in film.text


def test_an_arrow_s_sequence_may_come_in_two_pieces(film: Terminal) -> None:
    for first, second in (("\x1b", "[A"), ("\x1b[", "A"), ("\x1b[1;", "5C")):
        film.type(first)
        time.sleep(0.01)
        film.type(second)
        film.until(*["FPS"] * 10)
    assert film.program.poll() is None


def test_after_a_lone_Esc_the_rest_of_a_sequence_is_waited_for_and_no_longer(
        monkeypatch: pytest.MonkeyPatch) -> None:
    pieces = [b"\x1b", b"[A", b"p\x1b"]
    waits_s = []

    def ready(fds: list[int], _: object, __: object, wait_s: float) -> tuple[list[int], ...]:
        waits_s.append(wait_s)
        come = wait_s > 0 or pieces[:1] in ([b"\x1b"], [b"p\x1b"])
        return (fds if pieces and come else [], [], [])

    monkeypatch.setattr("examples.select.select", ready)
    monkeypatch.setattr("examples.os.read", lambda *_: pieces.pop(0))
    terminal = examples.Terminal()
    terminal.is_ours = True
    assert terminal.read() == "p\x1b"  # the arrow is gone, the last Esc is a key
    assert max(waits_s) <= 0.1


def test_x_in_the_header_s_pause_quits_and_p_holds_the_film() -> None:
    with airtrack("1") as terminal:
        terminal.until("Keys: ")
        terminal.type("p")
        terminal.until("paused")
        terminal.type("x")
        terminal.until("Stopped after 0 frames: x was pressed.")
        assert terminal.ends() == 0


def test_ctrl_c_in_the_header_s_pause_cuts_it_short_with_a_diamond() -> None:
    with airtrack("10", "d") as terminal:
        terminal.until("Keys: ", "\n")
        time.sleep(0.1)
        terminal.type("\x03")
        terminal.until("   *\r\n  * *\r\n *   *\r\n  * *\r\n   *\r\n", "FPS =  10", "FPS =  10")
        terminal.type("\x03")
        terminal.until(": Ctrl-C was pressed.")
        assert terminal.ends() == 0
        assert terminal.mode() == terminal.found


def test_ctrl_c_at_any_moment_leaves_no_traceback_and_the_terminal_as_it_was_found() -> None:
    for tenths in range(12):
        with airtrack("10") as terminal:
            terminal.until("Example 10")
            time.sleep(tenths / 30)
            terminal.type("\x03")
            time.sleep(0.2)
            terminal.type("\x03\x03")
            terminal.until("Ctrl-C was pressed.")
            assert terminal.ends() in (0, 130)
            assert terminal.mode() == terminal.found
            assert "Traceback" not in terminal.text


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_to_end_leaves_the_terminal_as_it_was_found(
        number: signal.Signals, film: Terminal) -> None:
    film.program.send_signal(number)
    film.until(f": {number.name}.")
    assert film.ends() == 128 + number
    assert film.mode() == film.found


def test_an_exception_leaves_the_terminal_as_it_was_found() -> None:
    code = ("import airtrack; airtrack.render_track = lambda *_: 1 / 0; "
            "airtrack.main(['0'])")
    with Terminal(sys.executable, "-c", code) as terminal:
        terminal.until("ZeroDivisionError")
        assert terminal.ends() == 1
        assert terminal.mode() == terminal.found


SHELLS = [pytest.param(words, marks=pytest.mark.skipif(
    shutil.which(words[0]) is None, reason=f"needs {words[0]}, for its job control"), id=words[0])
    for words in (("bash", "--norc", "-i"), ("dash", "-i"))]  # dash does not put modes right itself


@pytest.mark.parametrize("shell", SHELLS)
def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(shell: tuple[str, ...]) -> None:
    with Terminal(*shell) as terminal:
        terminal.until("$ ")
        terminal.type("stty -a; echo fou''nd\n")
        before = terminal.until("found\r\n")
        terminal.type(" ".join(COMMAND) + " 0\n")
        terminal.until("FPS", "FPS")
        terminal.type("\x1a")
        terminal.until("Stopped", "$ ")
        assert terminal.quiet(0.5)
        terminal.type("stty -a; echo fou''nd\n")
        assert modes(terminal.until("found\r\n")) == modes(before)
        terminal.type("fg\n")
        terminal.until("FPS", "FPS")
        terminal.type("p")  # a single key again, without Enter
        terminal.until("paused")
        terminal.type("x")
        terminal.until(": x was pressed.", "$ ")
        terminal.type("stty -a; echo fou''nd\n")
        assert modes(terminal.until("found\r\n")) == modes(before)


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash, for its job control")
def test_after_ctrl_z_and_fg_a_paused_run_says_that_it_is_paused() -> None:
    with Terminal("bash", "--norc", "-i") as terminal:
        terminal.until("$ ")
        terminal.type(" ".join(COMMAND) + " 0\n")
        terminal.until("FPS")
        terminal.type("p")
        terminal.until("paused: p goes on")
        terminal.type("\x1a")
        terminal.until("Stopped", "$ ")
        terminal.type("fg\n")
        terminal.until("paused: p goes on, x quits")
        terminal.type("x")
        terminal.until("x was pressed.")


def test_a_terminal_that_is_not_the_controlling_one_is_left_alone(film: Terminal) -> None:
    run = subprocess.run([*COMMAND, "0", "--frames", "3"], stdin=film.theirs, stdout=film.theirs,
                         stderr=subprocess.PIPE, text=True, env=environment(), check=False,
                         start_new_session=True)
    assert (run.returncode, run.stderr) == (0, "")


def modes(text: str) -> list[str]:
    """The switches in what stty -a printed, such as -echo."""
    return [word for word in text.split(";")[-1].split() if word.lstrip("-").isalnum()]


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash, for its job control")
def test_a_run_in_the_background_leaves_the_terminal_alone() -> None:
    with Terminal("bash", "--norc", "-i") as terminal:
        terminal.until("$ ")
        terminal.type(" ".join(COMMAND) + " 0 --frames 30 &\n")
        terminal.until("Stopped after 30 frames")


def test_a_process_stopped_and_continued_takes_its_keys_again(film: Terminal) -> None:
    film.program.send_signal(signal.SIGSTOP)
    assert film.quiet(0.3)
    termios.tcsetattr(film.theirs, termios.TCSANOW, film.found)  # as a shell would
    film.program.send_signal(signal.SIGCONT)
    film.until("FPS", "FPS")
    film.type("x")
    film.until("x was pressed")
    assert film.ends() == 0
    assert film.mode() == film.found


@pytest.mark.parametrize("columns", [80, 120, 200])
@pytest.mark.parametrize("words", ["0", "10 d", "99"])
def test_no_line_is_wider_than_the_terminal(words: str, columns: int) -> None:
    with airtrack(*words.split(), columns=columns) as terminal:
        shown = ""
        if words != "0":
            shown = terminal.until("Keys: ", "once.\r\n")
            terminal.type("\x03")  # no need to read it all
        shown += terminal.until("|  ", "\n")
        terminal.type("x")
        shown += terminal.until("x was pressed.")
        assert max(len(line) for line in shown.splitlines()) <= columns
        assert ("physics is untouched" in " ".join(shown.split())) is (
            columns < {"0": 160, "10 d": 168, "99": 135}[words])


def test_the_notice_that_there_is_no_window_is_one_line() -> None:
    with airtrack(columns=200) as terminal:
        shown = terminal.until("FPS")
        assert shown.count("\n") == 1
        assert shown.startswith("No window for the keys: there is no display.\r\n")
