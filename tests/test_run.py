"""The main loop, on a clock that the test sets: pacing, stalls, keys, rest, the end's words."""

import io
import re
from collections.abc import Callable
from contextlib import nullcontext
from itertools import pairwise

import pytest

import examples
from airtrack import PYTHON, Rest, Scene, main, planned_length
from clock import Clock, positions_m
from examples import EXAMPLES, OWN_SCENE

Capture = pytest.CaptureFixture[str]
Play = Callable[..., str]


@pytest.fixture
def play(clock: Clock, capsys: Capture) -> Play:
    """Run a command line, pressing keys at set moments: what was printed."""
    def played(words: str, **keys: str) -> str:
        clock.press(**keys)
        assert main(words.split()) == 0
        return capsys.readouterr().out
    return played


@pytest.fixture
def at_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if input and output were a terminal with keys."""
    monkeypatch.setattr(examples, "HAS_TERMINAL", True)
    monkeypatch.setattr(examples, "taken_terminal", nullcontext)
    monkeypatch.setattr(examples, "print_for_now", lambda text: print(text, end="\r"))


def plain(out: str) -> str:
    return " ".join(out.split())


def ending(out: str) -> str:
    return next(line for line in out.splitlines() if line.startswith("Stopped"))


# Pacing.

@pytest.mark.parametrize("fps", [300, 240, 10])
def test_work_and_oversleeping_do_not_slow_the_film(fps: int, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.3 / fps
    play(f"99 fps_target={fps} --frames 1001")
    took_s = clock.frames_s[-1] - clock.frames_s[0]
    assert 1000 / took_s == pytest.approx(fps, rel=0.002)
    assert clock.now_s - clock.frames_s[-1] < 0.5 / fps  # it does not wait for another frame


@pytest.mark.parametrize(("late_s", "is_made_up"), [(0.14, True), (0.16, False)])
def test_a_delay_is_made_up_unless_it_is_a_stall_of_150_ms(
        late_s: float, is_made_up: bool, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: late_s + 1 / 30 if frame == 10 else 0.0
    play("99 d fps_target=30 --frames 60")
    assert clock.lengths_s()[9] == pytest.approx(late_s + 1 / 30, rel=0.01)
    took_s = 59 / 30 + (0 if is_made_up else late_s)
    assert clock.frames_s[-1] - clock.frames_s[0] == pytest.approx(took_s, abs=0.001)
    assert clock.lengths_s()[30:] == pytest.approx([1 / 30] * 29, rel=0.02)


@pytest.mark.parametrize(("fps", "late_s", "is_stall"), [
    (30, 0.14, False), (30, 0.19, True), (2, 0.64, False), (2, 0.66, True)])
@pytest.mark.parametrize("observed", [True, False])
def test_a_frame_that_lasts_150_ms_longer_than_planned_counts_as_long_as_planned(
        fps: float, late_s: float, is_stall: bool, observed: bool, clock: Clock,
        play: Play) -> None:
    clock.when_drawn = lambda frame: late_s * (frame == 5)
    out = play(f"99 d v_mps=10 right_edge_m=99 fps_target={fps} --frames 9 "
               f"use_observed_dt={observed}")
    moved_m = [b - a for a, b in pairwise(positions_m(out))]
    moves_s = late_s if observed and not is_stall else 1 / fps
    assert moved_m[4] == pytest.approx(10 * moves_s, abs=0.02)


def test_a_film_over_a_slow_line_steps_by_what_it_observes(clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.06
    xs = positions_m(play("99 d v_mps=1 right_edge_m=9 fps_target=30 use_observed_dt=True "
                          "--frames 50"))
    assert xs[-1] - xs[0] == pytest.approx(49 * 0.06, abs=0.02)


def test_frame_k_lasts_1_plus_jitter_times_2_frac_0_618_k_minus_1_over_fps() -> None:
    scene = Scene(fps_target=10, jitter=0.25)
    lengths_s = [planned_length(scene, frame) for frame in range(1, 2001)]
    for k in (1, 2, 3, 1999):
        fraction = 618 * k % 1000 / 1000
        assert lengths_s[k - 1] == pytest.approx((1 + 0.25 * (2 * fraction - 1)) / 10)
    assert sum(lengths_s) / 2000 == pytest.approx(0.1, rel=1e-3)
    assert (min(lengths_s), max(lengths_s)) == pytest.approx((0.075, 0.125), rel=0.001)


@pytest.mark.parametrize("jitter", [0, 0.25, 0.9])
def test_the_film_in_time_and_the_fast_one_have_the_same_frames(
        jitter: float, clock: Clock, play: Play) -> None:
    words = f"99 d v_mps=1 right_edge_m=100 fps_target=10 jitter={jitter} --frames 30"
    for observed in (True, False):
        out = play(f"{words} use_observed_dt={observed}")
        paced = positions_m(out)
        assert observed or "t = 3.00 s" in ending(out)  # 30 frames of 0.1 s
        fast = positions_m(play(f"{words} use_observed_dt={observed} --fast"))
        assert paced == pytest.approx(fast, abs=0.0101)
        nominal_m = [1.1 + 0.1 * k for k in range(1, 31)]
        is_even = fast == pytest.approx(nominal_m, abs=0.0051)
        assert is_even is (not observed or jitter == 0)


def test_the_details_show_the_observed_rate_and_the_target_under_fast_or_after_a_pause(
        clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.05 if frame == 3 else 0.0
    words = "99 d fps_target=100 use_observed_dt=True --frames 6"
    rates = re.findall(r"FPS = +([0-9]+)", play(words))
    assert (rates[0], rates[3]) == ("100", "20")
    assert set(re.findall(r"FPS = +([0-9]+)", play(f"{words} jitter=0.5 --fast"))) == {"100"}


def test_the_true_car_takes_the_steps_of_the_car(play: Play) -> None:
    errors_m = re.findall("err = (.*)", play("11 d show_exact_mark=True --fast --frames 99"))
    assert len(errors_m) == 99
    assert max(abs(float(error_m)) for error_m in errors_m) < 1e-9


def test_each_line_goes_out_at_once_and_does_not_wait_in_a_buffer(
        clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    raw, walls = io.BytesIO(), []
    clock.when_drawn = lambda frame: walls.append(raw.getvalue().count(b"|")) or 0.0  # type: ignore
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(io.BufferedRandom(raw)))  # type: ignore
    assert main(["10", "--frames", "5"]) == 0
    assert walls == [0, 2, 4, 6, 8]


# At rest.

@pytest.mark.parametrize(("words", "frames"), [
    ("x_m=0.2509", 10), ("x_m=0.2511", 0), ("x_m=2.1991", 10), ("x_m=2.1989", 0),
    ("left_edge_m=0 x_m=0", 10), ("x_m=0.25 auto_off=False", 0),
    # without a: 9.7 cm a frame, put on a wall in frame 12 or 9, there for ten frames
    ("v_mps=2.9 CR=0", 21), ("v_mps=-2.9 CR=0", 18), ("x_m=2.19 v_mps=0.01 CR=0.9", 0),
    # at the wall to which it is accelerated, at either without an acceleration
    ("x_m=0.25 a_mps2=-1", 10), ("x_m=2.2 a_mps2=1", 10), ("x_m=2.2 a_mps2=-1e-9", 0),
    ("x_m=0.25 a_mps2=1e-9", 0), ("x_m=2.2 a_mps2=-0.01", 0),
    # ten frames, or a third of a second where that is more
    ("x_m=0.25 fps_target=10", 10), ("x_m=0.25 fps_target=50", 17),
    ("x_m=0.25 fps_target=240", 80), ("x_m=0.25 fps_target=999", 333),
    # where it still climbs, by |v| > |a| times that: v = 0.000333 after 14 frames, 0.0001 after 15
    ("x_m=0.25 v_mps=0.005 a_mps2=-0.0001", 0), ("x_m=0.25 v_mps=0.0006 a_mps2=-0.001", 10),
    ("x_m=0.25 v_mps=0.00079 a_mps2=-0.001", 14), ("x_m=2.2 v_mps=-0.00079 a_mps2=0.001", 14),
    ("x_m=0.25 v_mps=0.000245 a_mps2=-0.0001 fps_target=10", 15)])
def test_at_rest_is_a_third_of_a_second_within_a_millimetre_of_a_wall(
        words: str, frames: int, play: Play) -> None:
    out = play(f"99 {words} --fast --frames 400")
    assert ending(out).startswith(f"Stopped after {frames or 400} frames, ")
    why = "the car is at rest at a wall." if frames else "that is the frame limit."
    assert ending(out).endswith(f" s: {why}")


@pytest.mark.parametrize(("off_mm", "rests"), [
    ((0,) * 9 + (9,), True), ((9,) + (0,) * 9, True), ((5, -5) * 5, False)])
def test_the_mean_of_the_distances_decides_on_rest(off_mm: tuple[int, ...], rests: bool) -> None:
    rest = Rest(Scene(a_mps2=-2))
    assert [rest.is_reached(0.25 + mm / 1000, 0.0) for mm in off_mm] == [False] * 9 + [rests]


@pytest.mark.parametrize("fps", [30, 240, 1000])
@pytest.mark.parametrize("words", [
    "7 x_m=2.2", "99 x_m=1.1 v_mps=4.65 a_mps2=-9.81 CR=0.9", "7 x_m=2.2 a_mps2=-0.05"])
def test_a_car_that_turns_at_a_wall_or_was_just_released_there_is_not_at_rest(
        words: str, fps: int, play: Play) -> None:
    assert ending(play(f"{words} fps_target={fps} --fast --frames {fps}")).endswith("frame limit.")


# Keys. The film begins 3 s after the start, as there is no keyboard here but that of the clock.

@pytest.mark.parametrize(("key", "why"), [
    ("x", "x was pressed"), ("X", "x was pressed"), ("\x03", "Ctrl-C was pressed")])
def test_keys_that_quit(key: str, why: str, clock: Clock, play: Play) -> None:
    out = play("10", t4_05=key)
    frames = len(clock.frames_s)
    assert frames in (10, 11)
    assert ending(out) == f"Stopped after {frames} frames, t = {frames / 10:.2f} s: {why}."


@pytest.mark.parametrize(("key", "why"), [
    ("\x1b", "Esc was pressed"), (examples.CLOSED, "the window was closed")])
def test_esc_and_a_click_quit_in_the_window(
        key: str, why: str, clock: Clock, monkeypatch: pytest.MonkeyPatch, play: Play) -> None:
    monkeypatch.setattr(examples.Window, "keys", lambda _: [key] if clock.now_s > 1004 else [])
    assert ending(play("10")).endswith(f" s: {why}.")


def test_ctrl_c_in_mid_frame_is_a_key_like_x(clock: Clock, play: Play) -> None:
    def interrupted(frame: int) -> float:
        if frame == 6:
            raise KeyboardInterrupt
        return 0.0

    clock.when_drawn = interrupted
    out = play("10")
    assert ending(out) == "Stopped after 6 frames, t = 0.60 s: Ctrl-C was pressed."
    assert plain(EXAMPLES[10].seen) in plain(out)


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
    out = play("99 d v_mps=0.4 right_edge_m=9 fps_target=10 use_observed_dt=True",
               t0_5="\r", t4_05="s", t30="s", t40="ss", t50="p", t50_5="x")
    frames = [int(frame) for frame in re.findall("paused after frame ([0-9]+)", out)]
    assert [frame - frames[0] for frame in sorted(set(frames))] == [0, 1, 3]
    xs = positions_m(out)
    assert len(xs) - frames[-1] in (5, 6)
    for a_m, b_m in pairwise(xs):
        assert b_m - a_m == pytest.approx(0.04, abs=0.011)


def test_keys_before_the_film_p_holds_the_text_s_shows_frame_1_and_x_quits(
        clock: Clock, play: Play) -> None:
    out = play("10", t1="x")
    assert ending(out) == "Stopped after 0 frames, t = 0.00 s: x was pressed."
    began_s = clock.now_s
    play("10 --frames 1", t1="p", t60="p")
    assert clock.frames_s[0] - began_s == pytest.approx(60, abs=0.1)
    began_s = clock.now_s
    out = play("10", t1="s", t60="x")
    assert clock.frames_s == pytest.approx([began_s + 1], abs=0.1)


@pytest.mark.parametrize("key", ["\r", "\n", "\x03"])
def test_enter_and_ctrl_c_begin_the_film_even_where_p_holds_the_text(
        key: str, clock: Clock, play: Play) -> None:
    began_s = clock.now_s
    out = play("10 --frames 20", t1="p", t60=key, t61_05="\r")
    assert [clock.frames_s[0] - began_s, clock.lengths_s()] == [
        pytest.approx(60, abs=0.1), pytest.approx([0.1] * 19, rel=0.01)]
    assert ("   *\n  * *\n *   *\n  * *\n   *\n" in out) is (key == "\x03")
    assert ending(out).endswith("that is the frame limit.")
    assert ending(play("10", t1=f"{key}x")).endswith("x was pressed.")  # what comes with it counts


# What stands before a film.

@pytest.mark.parametrize(("has_terminal", "why_shut", "keys", "begins", "pause_s"), [
    (True, "no", "Keys here: p pauses, s steps, x quits. (No window: no.)", "p holds the text.",
     10),
    (False, "", "Keys in the little window: p pauses, s steps, x quits.", "p holds the text.", 10),
    (True, "", "Keys here and in the little window: p pauses, s steps, x quits.",
     "or now with Enter or Ctrl-C. p holds the text.", 10),
    (False, "no", "No keys here. (No window: no.)", "begins in 3 s, or now with Ctrl-C.", 3)])
@pytest.mark.usefixtures("at_a_terminal")
def test_before_a_film_the_question_stands_last_and_at_most_60_words_beside_it(
        has_terminal: bool, why_shut: str, keys: str, begins: str, pause_s: float, clock: Clock,
        monkeypatch: pytest.MonkeyPatch, play: Play) -> None:
    monkeypatch.setattr(examples, "HAS_TERMINAL", has_terminal)
    monkeypatch.setattr(examples.Window, "__init__", lambda window: setattr(
        window, "why_shut", why_shut))
    for name in ("keys", "close"):
        monkeypatch.setattr(examples.Window, name, lambda *_: [])
    for number in (*EXAMPLES, 99):
        question = EXAMPLES.get(number, OWN_SCENE).look_for
        began_s = clock.now_s
        header = plain(play(f"{number} --frames 1").split("\n\n")[0])
        before, _, after = header.partition(question)
        assert before.endswith(f" {keys} ")
        assert after.endswith(begins)
        assert len((before + after).split()) <= 60 or number == 21  # which explains its letters
        assert clock.frames_s[0] - began_s == pytest.approx(pause_s, abs=0.1)


@pytest.mark.parametrize(("words", "told"), [
    ("8", "Example 8: Elastic, large steps x_m=2 v_mps=0 a_mps2=-2 CR=1, walls at 0.25 and 2.2 m; "
     "backward + rebound, 10 FPS Now example 7"),
    ("9 CR=0.9", "Example 9: Elastic, large and irregular steps, CR=0.9 x_m=2 v_mps=0 a_mps2=-2 "
     "CR=0.9, walls at 0.25 and 2.2 m; backward + rebound, 10 FPS, jitter=0.25, "
     "use_observed_dt=True"),
    ("21", "Example 21: Five methods on one track x_m=2 v_mps=0 a_mps2=-2 CR=1, walls at 0.25 and "
     "2.2 m; exact + rewind, 10 FPS; a: backward + rebound; b: exact + rebound; "
     "c: exact + conserve; d: exact + rewind; e: exact + replay"),
    ("-3 x_m=1.23456 left_edge_m=-1", "Your own scene (the examples are 0 to 22), x_m=1.23456, "
     "left_edge_m=-1.0 x_m=1.23456 v_mps=0 a_mps2=0 CR=0.8, walls at -1 and 2.2 m; backward + "
     "rebound, 30 FPS")])
def test_the_header_tells_number_title_changes_and_the_scene_by_names_to_type(
        words: str, told: str, play: Play) -> None:
    assert plain(play(f"{words} --fast --frames 1")).startswith(told)


# What stands after a film.

def last_words(out: str) -> str:
    return plain(out.partition("Stopped after ")[2].partition(".\n")[2])


def test_after_every_film_its_hops_are_told_in_one_line(play: Play) -> None:
    for words, told in (("20 --frames 58", "14 12 10 9"), ("20 --frames 80", "14 12 10 9 9 9"),
                        ("20 --frames 99", "14 12 10 9 ... 9 9"), ("19", "15 14 13 12 ... 1 1"),
                        ("20 motion=backward correction=none --frames 99", "10 6 1 1 ... 1 1"),
                        ("99 x_m=0.25 a_mps2=-2 correction=surface", "1 1 1 1 ... 1 1")):
        assert re.findall("lines from collision to collision: (.*)\\.\n", play(words)) == [told]
    assert "lines from" not in play("8 --frames 45")  # one hop
    assert "lines from" not in play("20 --fast --frames 80")


@pytest.mark.parametrize(("words", "is_changed"), [
    ("10", False), ("10 CR=1", False), ("10 width_px=60", False), ("10 auto_off=False", False),
    ("10 m_to_px=9 show_exact_mark=True", False), ("10 CR=0.9", True), ("10 fps_target=11", True),
    ("9 jitter=0.9", True), ("9 use_observed_dt=False", True), ("21 show_methods=False", True),
    ("10 x_m=2.000001", True)])
def test_a_changed_example_asks_what_differs_and_names_the_command_of_the_unchanged_one(
        words: str, is_changed: bool, play: Play) -> None:
    number = int(words.split()[0])
    out = play(words, t4="x")
    assert (f"What differs from example {number} as it is?" in out) is is_changed
    assert (plain(EXAMPLES[number].look_for) in plain(out)) is not is_changed
    answer = EXAMPLES[number].seen
    if is_changed:
        answer = f"Example {number} as it is: {PYTHON} airtrack.py {number}"
    assert last_words(out) == f"{answer} Next: {PYTHON} airtrack.py {number + 1}"


@pytest.mark.parametrize(("words", "is_advised"), [
    ("v_mps=2 --frames 99", False), ("a_mps2=-2 CR=1 --frames 99", False),
    ("a_mps2=-2 --frames 99", True), ("a_mps2=-2 correction=surface", False),  # it rests
    ("a_mps2=-2 motion=exact --frames 99", True),
    ("a_mps2=-2 motion=exact correction=conserve --frames 30", False)])
def test_a_scene_of_one_s_own_gets_the_cure_only_where_it_applies(
        words: str, is_advised: bool, play: Play) -> None:
    told = last_words(play(f"99 {words}"))
    assert "In hops of 1 line the car lies on a wall, or is caught beyond it." in told
    assert ("add motion=exact correction=conserve" in told) is is_advised
    assert told.endswith(f"Next: {PYTHON} airtrack.py -h")


def test_the_last_example_leads_to_the_chart_and_a_fast_film_says_nothing_more(play: Play) -> None:
    assert play("22 --frames 3").endswith(f"Next: {PYTHON} airtrack.py chart\n")
    assert play("1 --frames 3 --fast").endswith("that is the frame limit.\n")
    assert plain(EXAMPLES[3].seen) not in plain(play("3", t1="x"))


# The picture and the terminal.

@pytest.mark.parametrize(("columns", "width_px"), [(80, 43), (200, 135), (172, 135), (20, 10)])
def test_a_narrow_terminal_shrinks_picture_and_zoom_together(
        columns: int, width_px: int, monkeypatch: pytest.MonkeyPatch, play: Play) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    assert play("10 d --fast --frames 1").splitlines()[-2].index("x =") == 135  # in a pipe
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert play("10 d m_to_px=0.001 --fast --frames 1")  # the least zoom
    out = play("10 d --fast --frames 40")
    lines = [line for line in out.splitlines() if "FPS =" in line]
    assert {line.index("x =") for line in lines} == {width_px}
    zoom = 55 * (width_px - 1) / 134  # what is in the last column stays in the last one
    told = f"The picture is drawn {width_px} columns wide, to fit into the terminal."
    assert (told in plain(out)) is (width_px < 135)
    walls = [i for i, c in enumerate(lines[0]) if c == "|"]
    assert walls == [round(at_m * zoom) for at_m in (0.25, 2.2)]


@pytest.mark.parametrize(("words", "column"), [
    ("99", 121), ("99 right_edge_m=20", 134), ("99 right_edge_m=1000", 134),
    ("8 width_px=60", 59), ("99 right_edge_m=20 m_to_px=55", -1), ("6", 66)])
def test_the_zoom_shows_the_right_wall_where_nobody_gave_one(
        words: str, column: int, play: Play) -> None:
    line = play(f"{words} --fast --frames 1").splitlines()[-2]
    assert line.rfind("|") == max(column, line.find("|"))


def test_print_for_now_says_nothing_in_a_pipe(play: Play) -> None:
    assert "paused" not in play("99 fps_target=10", t4="p", t5="x")
    assert examples.NoKeys().wait_until(1e9, 1, 1.0) is False
