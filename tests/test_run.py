"""The main loop, on a clock that the test sets: pacing, stalls, keys, what is said around it."""

import io
import re
import signal
from itertools import pairwise

import pytest

import examples
from airtrack import PYTHON, main
from clock import Clock, Play, ending, last_words, plain, positions_m
from examples import EXAMPLES, OWN_SCENE
from films import film

Capture = pytest.CaptureFixture[str]


# Pacing.

@pytest.mark.parametrize("fps", [300, 10])
def test_work_and_oversleeping_do_not_slow_the_film(fps: int, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.3 / fps
    play(f"99 fps_target={fps} auto_off=False --frames 1001")
    took_s = clock.frames_s[-1] - clock.frames_s[0]
    assert 1000 / took_s == pytest.approx(fps, rel=0.002)
    assert clock.now_s - clock.frames_s[-1] < 0.5 / fps  # it does not wait for another frame


@pytest.mark.parametrize(("late_s", "is_made_up"), [(0.14, True), (0.16, False)])
def test_a_delay_is_made_up_unless_it_is_a_stall_of_150_ms(
        late_s: float, is_made_up: bool, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: late_s + 1 / 30 if frame == 10 else 0.0
    play("99 fps_target=30 auto_off=False --frames 60")
    assert clock.lengths_s()[9] == pytest.approx(late_s + 1 / 30, rel=0.01)
    took_s = 59 / 30 + (0 if is_made_up else late_s)
    assert clock.frames_s[-1] - clock.frames_s[0] == pytest.approx(took_s, abs=0.001)
    assert clock.lengths_s()[30:] == pytest.approx([1 / 30] * 29, rel=0.02)


@pytest.mark.parametrize(("fps", "late_s", "counted_s"), [
    (30, 0.14, 0.14), (30, 0.19, 1 / 30), (2, 0.64, 0.64), (2, 0.66, 0.5)])
def test_an_observed_frame_counts_as_long_as_planned_if_it_lasts_150_ms_longer(
        fps: float, late_s: float, counted_s: float, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: late_s * (frame == 5)
    out = play(f"99 d v_mps=10 right_edge_m=99 fps_target={fps} use_observed_dt=True --frames 9")
    moved_m = [b - a for a, b in pairwise(positions_m(out))]
    assert moved_m[4] == pytest.approx(10 * counted_s, abs=0.02)


def test_a_film_over_a_slow_line_steps_by_what_it_observes(clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.06
    xs = positions_m(play("99 d v_mps=1 right_edge_m=9 fps_target=30 use_observed_dt=True "
                          "--frames 50"))
    assert xs[-1] - xs[0] == pytest.approx(49 * 0.06, abs=0.02)


@pytest.mark.parametrize(("settings", "shortest_m", "longest_m"), [
    ("use_observed_dt=True", 0.1, 0.1), ("use_observed_dt=False jitter=0.9", 0.1, 0.1),
    ("use_observed_dt=True jitter=0.9", 0.01, 0.19)])
def test_a_film_on_time_and_a_fast_one_have_the_same_frames_irregular_if_jitter_is_observed(
        settings: str, shortest_m: float, longest_m: float, play: Play) -> None:
    words = f"99 d v_mps=1 right_edge_m=100 fps_target=10 {settings} --frames 400"
    xs = positions_m(play(f"{words} --fast"))
    assert positions_m(play(words)) == pytest.approx(xs, abs=0.0101)
    moved_m = [b - a for a, b in pairwise(xs)]
    assert (min(moved_m), max(moved_m)) == pytest.approx((shortest_m, longest_m), abs=0.0101)
    assert xs[-1] == pytest.approx(1.1 + 40, abs=0.1)


def test_the_details_show_the_observed_rate_and_with_fast_the_target(
        clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.05 if frame == 3 else 0.0
    words = "99 d fps_target=100 use_observed_dt=True --frames 6"
    rates = re.findall(r"FPS = +([0-9]+)", play(words))
    assert (rates[0], rates[3]) == ("100", "20")
    assert set(re.findall(r"FPS = +([0-9]+)", play(f"{words} jitter=0.5 --fast"))) == {"100"}


def test_each_line_goes_out_at_once_and_does_not_wait_in_a_buffer(
        clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    raw, walls = io.BytesIO(), []
    clock.when_drawn = lambda frame: walls.append(raw.getvalue().count(b"|")) or 0.0  # type: ignore
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(io.BufferedRandom(raw)))  # type: ignore
    assert main(["10", "--frames", "5"]) == 0
    assert walls == [0, 2, 4, 6, 8]


# Keys. Without a terminal the film begins 3 s after the start, and the keys are the clock's.

@pytest.mark.parametrize(("key", "why"), [
    ("x", "x was pressed"), ("X", "x was pressed"), ("\x03", "Ctrl-C was pressed")])
def test_keys_that_quit(key: str, why: str, clock: Clock, play: Play) -> None:
    out = play("10", t4_05=key)
    frames = len(clock.frames_s)
    assert frames in (10, 11)
    assert ending(out) == f"Stopped after {frames} frames, t = {frames / 10:.2f} s: {why}."
    assert last_words(out).startswith(EXAMPLES[10].seen)


def test_ctrl_c_in_mid_frame_is_a_key_like_x_but_ends_a_fast_film_with_130(
        clock: Clock, capsys: Capture, monkeypatch: pytest.MonkeyPatch, play: Play) -> None:
    def press_ctrl_c(frame: int) -> float:
        if frame == 6:
            signal.raise_signal(signal.SIGINT)
        return 0.0

    monkeypatch.setattr(examples, "IGNORED", [])  # the tests may run in the background
    found = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        clock.when_drawn = press_ctrl_c
        assert ending(play("10")) == "Stopped after 6 frames, t = 0.60 s: Ctrl-C was pressed."
        clock.press()
        assert main(["10", "--fast"]) == 130
        assert "Stopped" not in capsys.readouterr().out  # nor a table
    finally:
        signal.signal(signal.SIGINT, found)


def test_x_is_answered_within_a_long_frame(clock: Clock, play: Play) -> None:
    began_s = clock.now_s
    play("99 fps_target=0.1", t7="x")
    assert clock.now_s - began_s == pytest.approx(7, abs=0.1)


@pytest.mark.usefixtures("at_a_terminal")
@pytest.mark.parametrize("key", ["p", "P", "\x13"])
def test_p_pauses_tells_the_moment_and_resumes_without_a_leap(
        key: str, clock: Clock, play: Play) -> None:
    out = play("99 d v_mps=0.4 right_edge_m=9 fps_target=10 use_observed_dt=True",
               t0_5="\r", t1_65=key, t24=key, t25_05="x")
    assert max(clock.lengths_s()) == pytest.approx(22.4, abs=0.1)
    (frame, t_s), = re.findall(
        "paused after frame ([0-9]+), t = (.*) s: p resumes, s steps, x quits\r", out)
    assert frame == "11"
    assert float(t_s) == pytest.approx(1.1, abs=0.02)
    xs = positions_m(out)
    assert len(xs) in (22, 23)
    assert set(re.findall(r"FPS = +([0-9]+)", out)) == {"10"}
    for a_m, b_m in pairwise(xs):  # nor does it stand still: the frame is as long as any other
        assert b_m - a_m == pytest.approx(0.04, abs=0.011)


@pytest.mark.usefixtures("at_a_terminal")
def test_s_goes_one_frame_further_and_pauses(play: Play) -> None:
    out = play("10", t0_5="\r", t4_05="s", t30="s", t40="ss", t50="p", t50_5="x")
    frames = [int(frame) for frame in re.findall("paused after frame ([0-9]+)", out)]
    assert [frame - frames[0] for frame in sorted(set(frames))] == [0, 1, 3]
    last = int(re.findall("after ([0-9]+) frames", ending(out))[0])
    assert last - frames[-1] in (5, 6)


def test_after_quick_steps_p_goes_on_at_once(clock: Clock, play: Play) -> None:
    play("10 fps_target=1", t0_5="\r", t2_7="s", t2_8="s", t2_9="s", t3="s", t5="p", t9="x")
    assert clock.lengths_s()[-3:] == pytest.approx([1, 1, 1], abs=0.1)


@pytest.mark.usefixtures("at_a_terminal")
@pytest.mark.parametrize(("keys", "shows_one_more"), [
    ({"t4_05": "sp", "t6_05": "p"}, False),  # what s asked for is forgotten with p
    ({"t2_05": "p", "t4_05": "p", "t6_05": "s"}, True)])
def test_steps_are_counted_anew_after_p(
        keys: dict[str, str], shows_one_more: bool, clock: Clock, play: Play) -> None:
    play("10", t0_5="\r", **keys, t30="x")
    first_s, *_, last_s = clock.frames_s
    assert (last_s - first_s > 5.5) is shows_one_more  # the last key comes after 5.55 s


@pytest.mark.usefixtures("at_a_terminal")
def test_before_the_film_p_holds_the_text_s_shows_frame_1_and_x_quits(
        clock: Clock, play: Play) -> None:
    out = play("10", t1="x")
    assert out.endswith("Stopped after 0 frames, t = 0.00 s: x was pressed.\n")
    began_s = clock.now_s
    out = play("10 --frames 1", t1="p", t60="p")
    assert clock.frames_s[0] - began_s == pytest.approx(60, abs=0.1)
    assert "the text is held: p lets go, Enter begins the film, x quits\r" in out
    began_s = clock.now_s
    play("10", t1="s", t60="x")
    assert clock.frames_s == pytest.approx([began_s + 1], abs=0.1)


@pytest.mark.parametrize("key", ["\r", "\n", "\x03"])
def test_enter_and_ctrl_c_begin_the_film_whatever_was_pressed_before(
        key: str, clock: Clock, play: Play) -> None:
    began_s = clock.now_s
    out = play("10 --frames 20", t1="p", t60=key, t61_05="\r")
    assert clock.frames_s[0] - began_s == pytest.approx(60, abs=0.1)
    assert clock.lengths_s() == pytest.approx([0.1] * 19, rel=0.01)
    assert ("   *\n  * *\n *   *\n  * *\n   *\n" in out) is (key == "\x03")
    assert ending(out).endswith("that is the frame limit.")
    assert ending(play("10", t1=f"{key}x")).endswith("x was pressed.")  # what comes with it counts
    play("10", t1=f"ss{key}", t2_2="s", t9="x")  # the steps asked before it do not
    assert len(clock.frames_s) == 13  # 12 in 1.2 s, and one more at t2_2
    assert clock.lengths_s()[:11] == pytest.approx([0.1] * 11, rel=0.01)


def test_in_a_pipe_a_pause_is_not_told(play: Play) -> None:
    assert "paused" not in play("8", t4="p", t5="x")


# What stands around a film.

@pytest.mark.parametrize(("has_terminal", "why_shut", "keys", "begins", "pause_s"), [
    (True, "no", "Keys here: p pauses, s steps, x quits. (No window: no.)",
     "now with Enter or Ctrl-C. p holds the text.", 10),
    (False, "", "Keys in the little window: p pauses, s steps, x quits.", "p holds the text.", 10),
    (True, "", "Keys here and in the little window: p pauses, s steps, x quits.",
     "p holds the text.", 10),
    (False, "no", "No keys here. (No window: no.)", "or now with Ctrl-C.", 3)])
@pytest.mark.usefixtures("at_a_terminal")
def test_before_a_film_it_says_where_keys_work_the_question_and_when_the_film_begins(
        has_terminal: bool, why_shut: str, keys: str, begins: str, pause_s: float, clock: Clock,
        monkeypatch: pytest.MonkeyPatch, play: Play) -> None:
    monkeypatch.setattr(examples, "HAS_TERMINAL", has_terminal)
    monkeypatch.setattr(examples.Window, "__init__", lambda window: setattr(
        window, "why_shut", why_shut))
    for name in ("keys", "close"):
        monkeypatch.setattr(examples.Window, name, lambda *_: [])
    for number, example in ((8, EXAMPLES[8]), (99, OWN_SCENE)):
        began_s = clock.now_s
        header = plain(play(f"{number} --frames 1").split("\n\n")[0])
        told = f" {keys} {example.look_for} The film begins in {pause_s} s, or now with "
        assert told in header
        assert header.endswith(begins)
        assert clock.frames_s[0] - began_s == pytest.approx(pause_s, abs=0.1)


@pytest.mark.parametrize(("words", "told"), [
    ("9 CR=0.9", "Example 9: Elastic, large and irregular steps, CR=0.9 x_m=2 v_mps=0 a_mps2=-2 "
     "CR=0.9, walls at 0.25 and 2.2 m; backward + rebound, 10 FPS, jitter=0.25, "
     "use_observed_dt=True The +"),
    ("21", "Example 21: Five methods on one track x_m=2 v_mps=0 a_mps2=-2 CR=1, walls at 0.25 and "
     "2.2 m; exact + rewind, 10 FPS; a: backward + rebound; b: exact + rebound; "
     "c: exact + conserve; d: exact + rewind; e: exact + replay The *"),
    ("-3 x_m=1.23456 CR=.90", "Your own scene (the examples are 0 to 22), x_m=1.23456, CR=.90 "
     "x_m=1.23456 v_mps=0 a_mps2=0 CR=0.9, walls at 0.25 and 2.2 m; backward + rebound, 30 FPS "
     "The * is your car"),
    ("4", "Example 4: A high frame rate x_m=0.2 v_mps=10 a_mps2=-10 CR=0.8, walls at 0.25 and 2.2 "
     "m; backward + rebound, 300 FPS; it starts beyond a wall Each line")])
def test_the_header_tells_number_title_changes_and_the_scene_by_names_to_type(
        words: str, told: str, play: Play) -> None:
    assert plain(play(f"{words} --fast --frames 1")).startswith(told)


def test_a_film_says_what_to_type_next_and_a_fast_one_does_not(play: Play) -> None:
    for words, following in (("1", "2"), ("22", "chart"), ("99", "chart"), ("-3", "chart")):
        assert play(f"{words} --frames 3").endswith(f"\nNext: {PYTHON} airtrack.py {following}\n")
    assert "Next:" not in play("1 --frames 3 --fast")


# The picture and the terminal.

@pytest.mark.parametrize(("columns", "width_px"), [(80, 43), (172, 135), (171, 134)])
def test_a_narrow_terminal_shrinks_picture_and_zoom_together(
        columns: int, width_px: int, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    assert film(capsys, "10", "d", "--frames=1").lines[0].index("x =") == 135  # in a pipe
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert film(capsys, "10", "d", "m_to_px=0.001", "--frames=1").lines  # the least zoom
    intro, (line,), *_ = film(capsys, "10", "d", "--frames=1")
    assert line.index("x =") == width_px
    told = f"The picture is drawn {width_px} columns wide, to fit into the terminal."
    assert (told in intro) is (width_px < 135)
    zoom = 55 * (width_px - 1) / 134  # what is in the last column stays in the last one
    walls = [column for column, mark in enumerate(line) if mark == "|"]
    assert walls == [round(at_m * zoom) for at_m in (0.25, 2.2)]


def test_in_a_terminal_too_narrow_for_the_details_the_picture_has_ten_columns(
        capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert film(capsys, "10", "d", "--frames=1").lines[0].index("x =") == 10


@pytest.mark.parametrize(("words", "columns"), [
    ("99", [14, 121]), ("6", [8, 66]), ("8 width_px=60", [7, 59]),
    ("99 left_edge_m=-1000 right_edge_m=1000", [0, 134]), ("99 right_edge_m=20 m_to_px=55", [14]),
    ("99 left_edge_m=-3 right_edge_m=-1 x_m=-2", [0, 110])])
def test_the_picture_shows_the_right_wall_unless_a_zoom_is_given(
        words: str, columns: list[int], capsys: Capture) -> None:
    line = film(capsys, *words.split(), "--frames=1").lines[0]
    assert [column for column, mark in enumerate(line) if mark == "|"] == columns
