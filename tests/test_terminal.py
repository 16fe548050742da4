"""A real terminal (a pseudo-terminal): its keys, its signals, its picture, and how it is left."""

import re
import shlex
import shutil
import subprocess
import sys
import time

import pytest

from films import HERE, PATIENCE_S, Terminal, environment, quick

if sys.platform == "win32":
    pytest.skip("needs a POSIX pseudo-terminal", allow_module_level=True)

FILM = [*quick(), "0", "d"]  # it does not end by itself
FRAME = "FPS = "  # stands in each of its lines, and nowhere else
HELD = [*quick(pause_s=1e6), "0", "d"]  # the text before this one stands until a key is pressed

def until_it_is_paused(terminal: Terminal) -> None:
    """Wait until no frames come any more, and a line that is not complete says why."""
    deadline_s = time.monotonic() + PATIENCE_S
    while terminal.read(0.5) or terminal.all.endswith("\n"):
        assert time.monotonic() < deadline_s, terminal.all[-1000:]

@pytest.mark.parametrize(("key", "status"), [
    ("x", 0), ("\x03", 0), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_a_key_or_a_signal_ends_a_film_and_leaves_the_terminal_as_found(
        key: str, status: int) -> None:
    with Terminal(*FILM) as terminal:
        terminal.until(FRAME)
        terminal.press(key)
        terminal.ends(status)
        assert ("airtrack.py 1" in terminal.all) is (status == 0)  # what comes next

def test_an_exception_in_a_film_is_shown_and_leaves_the_terminal_as_found() -> None:
    with Terminal(*quick("airtrack.render_track = lambda *_: 1/0")) as terminal:
        terminal.until("ZeroDivisionError")
        assert terminal.program.wait(PATIENCE_S) == 1
        assert terminal.mode() == terminal.found

def test_a_film_whose_terminal_is_gone_ends() -> None:
    with Terminal(*FILM) as terminal:
        terminal.until(FRAME)
        terminal.hang_up()
        terminal.program.wait(PATIENCE_S)

def test_after_main_every_signal_does_what_it_did_before() -> None:
    change = ("import signal; handlers = lambda: [*map(signal.getsignal, range(1, 32))]; "
              "found, real = handlers(), airtrack.main; "
              "airtrack.main = lambda: [real(), print('the same:', handlers() == found)][0]")
    with Terminal(*quick(change), "0", "--frames=1") as terminal:
        terminal.until("the same: True")

def test_keys_count_from_the_very_start_but_arrows_and_other_keys_do_nothing() -> None:
    with Terminal(*HELD) as terminal:
        terminal.press("\r")  # long before Python runs the program
        terminal.until(FRAME)
        for keys in ("\x1b", "\x1b[A", "\x1bOP", "\x1bp", "\x1b[<0;10;10Mpx", "q\t\r\n", "\u20ac"):
            terminal.press(keys)
            terminal.goes_on()
        terminal.press("x\x1b[A")
        terminal.ends(0)

@pytest.mark.parametrize("line", ['"$@" < /dev/null', '"$@" | cat'])
def test_a_terminal_from_which_no_keys_can_come_is_left_alone(line: str) -> None:
    with Terminal("sh", "-c", line, "sh", *FILM, "--frames=100") as terminal:
        terminal.until(FRAME)
        assert terminal.mode() == terminal.found
        terminal.ends(0)
        assert re.search(r"Ctrl-C[^.]*\bends?\b", terminal.all.partition(FRAME)[0])

def test_in_a_pipe_each_frame_comes_at_once_and_ctrl_c_ends_the_film() -> None:
    words = ["0", "d", "fps_target=0.1", "--frames=3"]  # the second one would come after 10 s
    command = quick("import signal; signal.signal(2, signal.default_int_handler)")  # not ignored
    with subprocess.Popen([*command, *words], stdout=subprocess.PIPE, text=True, cwd=HERE,
                          env=environment()) as program:
        assert program.stdout
        assert any(FRAME in line for line in program.stdout)
        program.send_signal(2)
        assert "Stopped after 1 frames" in program.stdout.read()

SHELLS = {"bash": ["bash", "--norc", "--noprofile", "-i"], "dash": ["dash", "-i"]}

@pytest.mark.parametrize(("name", "is_sent_back", "is_killed"), [
    ("dash", False, False), ("bash", False, False), ("bash", False, True), ("bash", True, False),
    ("bash", True, True)])
def test_ctrl_z_gives_the_terminal_back_and_bg_fg_and_kill_work(
        name: str, is_sent_back: bool, is_killed: bool) -> None:
    if shutil.which(name) is None:
        pytest.skip(f"{name} is not installed")
    with Terminal(*SHELLS[name], PS1="% ") as shell:
        shell.until("% ")
        shell.press(shlex.join(FILM) + "\n")
        shell.until(FRAME)
        shell.press("\x1a")
        shell.until("topped", "% ")  # or Stopped
        assert name == "bash" or shell.mode() == shell.found  # bash sets the terminal itself
        if is_sent_back:
            shell.press('bg\nwhile [ -z "$(jobs -s)" ]; do sleep 0.1; done; echo "it st"ands\n')
            shell.until("it stands")
        if is_killed:
            shell.press('p=$(jobs -p); kill %1; while kill -0 $p; do sleep .1; done; echo "go"ne\n')
            shell.until("gone")
        else:
            shell.press("fg\n")
            shell.until(FRAME)
            shell.press("x")
            shell.until("airtrack.py 1")

def test_keys_that_were_typed_and_not_read_do_not_reach_the_shell() -> None:
    change = ("real = airtrack.render_track; airtrack.render_track = lambda *words: "
              "[print('dra' + 'wing', flush=True), examples.select.select([0], [], []), "
              "real(*words)][2]")  # it draws until a key has come, after the last look at the keys
    with Terminal(*SHELLS["bash"], PS1="% ") as shell:
        shell.until("% ")
        shell.press(shlex.join([*quick(change), "0", "--frames=1"]) + "\n")
        shell.until("drawing")
        shell.press("x")
        shell.until("airtrack.py 1", "% ")
        shell.press('echo "st"atus $?\n')
        shell.until("status 0")
        assert "xecho" not in shell.all

def test_a_terminal_shows_o_and_0_in_colours_for_any_background_unless_that_is_not_wanted() -> None:
    words = "0 d x_m=17 v_mps=100 width_px=140 show_collision_mark=True motion=exact --frames=1"
    frames = []
    for line in ('"$@"', 'NO_COLOR= "$@"', 'NO_COLOR=1 "$@"', 'TERM=dumb "$@"', 'env -u TERM "$@"',
                 '"$@" | cat'):
        with Terminal("sh", "-c", line, "sh", *quick(), *words.split()) as terminal:
            terminal.ends(0)
        shown, = [shown for shown in terminal.all.splitlines() if FRAME in shown]
        frames.append(shown.partition(FRAME)[0])
    coloured, also_coloured, *others = frames
    assert coloured == also_coloured
    assert "\x1b" not in coloured.partition("x = ")[2]  # figures are no marks
    found = re.findall("\x1b\\[([0-9]+)m(.)\x1b\\[0m", coloured)
    assert sorted(found) == [("31", "0"), ("32", "o")]  # red and green: yellow is not seen on white
    assert others == [re.sub("\x1b\\[[0-9]+m(.)\x1b\\[0m", r"\1", coloured)] * 4

def test_in_a_narrow_terminal_no_line_wraps_and_one_says_that_the_picture_is_smaller() -> None:
    for columns in (80, 200):
        with Terminal(*quick(), "10", "d", "--frames=1", columns=columns, NO_COLOR="1") as terminal:
            terminal.ends(0)
        lines = terminal.all.splitlines()
        assert max(len(line) for line in lines) <= columns
        # A paragraph is no wider than is good to read.
        assert max(len(line) for line in lines if FRAME not in line) <= 100
        picture, = [line.partition("x =")[0] for line in lines if FRAME in line]
        assert any(f" {len(picture)} columns" in line for line in lines) is (columns == 80)
        told = re.findall(r"A column is ([0-9.]+) m", " ".join(lines))
        assert bool(told) is (columns == 80)
        if told:
            walls = picture.rindex("|") - picture.index("|")
            assert float(told[0]) == pytest.approx((2.2 - 0.25) / walls, rel=0.05)
