"""The main loop, on a clock that the test sets: pacing, stalls, observed dt, keys, the ends."""

import io
import math
import re
import signal
from collections import deque
from collections.abc import Callable
from itertools import islice, pairwise

import pytest

import examples
from airtrack import ACCOUNT, PYTHON, Scene, is_at_rest, main, planned
from clock import Clock, positions_m
from examples import EXAMPLES

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


@pytest.mark.parametrize(("fps", "late_s", "is_made_up"), [
    (300, 0.019, True), (300, 0.022, False), (20, 0.04, True), (20, 0.06, False)])
def test_a_deadline_missed_by_20_ms_or_a_frame_is_made_up_and_a_later_one_is_not(
        fps: float, late_s: float, is_made_up: bool, clock: Clock, play: Play) -> None:
    # Where it is made up, the clock does not tick between two frames.
    clock.when_drawn = lambda frame: late_s + 1 / fps if frame == 10 else 0.0
    play(f"99 d fps_target={fps} --frames 40")
    assert clock.lengths_s()[9] == pytest.approx(late_s + 1 / fps, rel=0.01)
    took_s = 39 / fps + (0 if is_made_up else late_s)
    assert clock.frames_s[-1] - clock.frames_s[0] == pytest.approx(took_s, abs=0.001)
    assert clock.lengths_s()[20:] == pytest.approx([1 / fps] * 19, rel=0.02)


@pytest.mark.parametrize(("has_keyboard", "pause_s", "begins"), [
    (False, 3, "It begins in 3 s, or with Ctrl-C."),
    (True, 10, "It begins in 10 s, or with Enter; p holds this text.")])
def test_before_the_pause_the_question_stands_last_and_little_stands_beside_it(
        has_keyboard: bool, pause_s: float, begins: str, clock: Clock, play: Play,
        monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(examples, "HAS_KEYBOARD", has_keyboard)
    monkeypatch.setattr(examples.Terminal, "take", lambda _: None)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "80")
    for words in (*map(str, EXAMPLES), "99", "99 d left_edge_m=-1", "99 d right_edge_m=9"):
        question = (EXAMPLES.get(int(words.split()[0])) or examples.OWN_SCENE).look_for
        began_s = clock.now_s
        header = " ".join(play(f"{words} --frames 1").split("\n\n")[0].split())
        assert header.endswith(f" {question} {begins}")
        assert clock.frames_s[0] - began_s == pytest.approx(pause_s, abs=0.01)
        scene = r" a second(?:, irregular by up to 25 %, each step [a-z ]+)?\. (?:a: .* replay\. )?"
        beside = re.split(scene, header)[1].replace(question, "")
        assert len(beside.split()) <= 45
        assert len(question.split()) <= 36


def test_each_line_goes_out_at_once_and_does_not_wait_in_a_buffer(
        clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    raw, walls, headers = io.BytesIO(), [], []
    clock.when_drawn = lambda frame: walls.append(raw.getvalue().count(b"|")) or 0.0  # type: ignore
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(io.BufferedRandom(raw)))  # type: ignore
    monkeypatch.setattr(examples.Keys, "leave_time", lambda *_: headers.append(raw.getvalue()))
    assert main(["10", "--frames", "5"]) == 0
    assert walls == [0, 2, 4, 6, 8]
    assert b"It begins in 3 s" in headers[0]


# Irregular frames.

def test_frame_k_should_last_1_plus_jitter_times_a_fraction_of_0_618_k() -> None:
    scene = Scene(fps_target=10, jitter=0.25)
    lengths_s = [length_s for length_s, _ in islice(planned(scene), 2000)]
    for k in (1, 2, 3, 1999):
        fraction = 618 * k % 1000 / 1000
        assert lengths_s[k - 1] == pytest.approx((1 + 0.25 * (2 * fraction - 1)) / 10)
    assert sum(lengths_s) / 2000 == pytest.approx(0.1, rel=1e-3)
    assert (min(lengths_s), max(lengths_s)) == pytest.approx((0.075, 0.125), rel=0.001)
    even_s = {length_s for length_s, _ in islice(planned(Scene(fps_target=7)), 100)}
    assert even_s == {1 / 7}


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


def test_the_true_car_takes_the_steps_of_the_car(play: Play) -> None:
    errors_m = re.findall("err = (.*)", play("11 d show_exact_mark=True --fast --frames 99"))
    assert len(errors_m) == 99
    assert max(abs(float(error_m)) for error_m in errors_m) < 1e-9


# Stalls and the observed dt.

@pytest.mark.parametrize(("fps", "late_s", "is_stall"), [
    (30, 0.14, False), (30, 0.16, True), (2, 0.74, False), (2, 0.76, True)])
@pytest.mark.parametrize("observed", [True, False])
def test_after_a_stall_longer_than_150_ms_and_one_and_a_half_frames_the_car_does_not_leap(
        fps: float, late_s: float, is_stall: bool, observed: bool, clock: Clock,
        play: Play) -> None:
    clock.when_drawn = lambda frame: late_s * (frame == 5)
    out = play(f"99 d v_mps=10 right_edge_m=99 fps_target={fps} --frames 9 "
               f"use_observed_dt={observed}")
    moved_m = [b - a for a, b in pairwise(positions_m(out))]
    moves_s = late_s if observed and not is_stall else 1 / fps
    assert moved_m[4] == pytest.approx(10 * moves_s, abs=0.011)
    assert moved_m[6:] == pytest.approx([10 / fps] * 2, abs=0.011)


def test_where_every_frame_is_a_stall_the_car_moves_all_the_same(clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.2  # over a slow line
    xs = positions_m(play("99 d v_mps=1 right_edge_m=9 fps_target=30 "
                          "use_observed_dt=True --frames 50"))
    assert xs[-1] == pytest.approx(1.1 + 50 / 30, abs=0.01)


def test_the_details_show_the_observed_rate_and_the_target_under_fast(
        clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.05 if frame == 3 else 0.0
    words = "99 d fps_target=100 use_observed_dt=True --frames 6"
    rates = re.findall(r"FPS = +([0-9]+)", play(words))
    assert (rates[0], rates[3]) == ("100", "20")
    assert set(re.findall(r"FPS = +([0-9]+)", play(f"{words} jitter=0.5 --fast"))) == {"100"}


# At rest.

@pytest.mark.parametrize(("words", "frames"), [
    ("x_m=0.2509", 10), ("x_m=0.2511", 0), ("x_m=2.1991", 10), ("x_m=2.1989", 0),
    ("left_edge_m=0 x_m=0", 10), ("x_m=0.25 auto_off=False", 0),
    # without a pull: 9.7 cm a frame, put on a wall in frame 12 or 9, there for ten frames
    ("v_mps=2.9 CR=0", 21), ("v_mps=-2.9 CR=0", 18), ("x_m=2.19 v_mps=0.01 CR=0.9", 0),
    # of the wall that it is pulled to, of either without a pull
    ("x_m=0.25 a_mps2=-1", 10), ("x_m=2.2 a_mps2=1", 10), ("x_m=2.2 a_mps2=-1e-9", 0),
    ("x_m=0.25 a_mps2=1e-9", 0),
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
    why = "the car is at rest against a wall." if frames else "that is the frame limit."
    assert ending(out).endswith(f" s: {why}")


@pytest.mark.parametrize(("off_mm", "rests"), [((0,) * 9 + (9,), True), ((5, -5) * 5, False)])
def test_the_mean_of_the_distances_decides_on_rest(off_mm: tuple[int, ...], rests: bool) -> None:
    last_m = deque((0.25 + mm / 1000 for mm in off_mm), maxlen=10)
    assert is_at_rest(Scene(a_mps2=-2), 0.0, last_m) is rests


@pytest.mark.parametrize("fps", [30, 240, 1000])
@pytest.mark.parametrize("words", [
    "7 x_m=2.2", "99 x_m=1.1 v_mps=4.65 a_mps2=-9.81 CR=0.9", "7 x_m=2.2 a_mps2=-0.05"])
def test_a_car_that_turns_at_a_wall_or_was_just_released_there_is_not_at_rest(
        words: str, fps: int, play: Play) -> None:
    assert ending(play(f"{words} fps_target={fps} --fast --frames {fps}")).endswith("frame limit.")


# Keys.

@pytest.mark.parametrize(("key", "why"), [
    ("x", "x was pressed"), ("X", "x was pressed"), ("\x1b", "Esc was pressed"),
    ("\x03", "Ctrl-C was pressed"), (examples.WINDOW_CLOSED, "the window was closed")])
def test_keys_that_quit(key: str, why: str, clock: Clock, monkeypatch: pytest.MonkeyPatch,
                        play: Play) -> None:
    monkeypatch.setattr(examples.Window, "read", lambda _: [key] if clock.now_s > 1004 else [])
    out = play("10")
    frames = len(clock.frames_s)
    assert frames in (10, 11)
    assert ending(out) == f"Stopped after {frames} frames, t = {frames / 10:.2f} s: {why}."


def test_a_signal_acts_at_the_next_look_and_the_first_reason_to_end_wins() -> None:
    keys = examples.Keys()
    for number in (signal.SIGTERM, signal.SIGINT):
        keys.note(number, None)
        assert keys.why_quit == ""
    keys.look()
    assert (keys.why_quit, keys.status) == ("SIGTERM", 143)


def test_x_is_answered_within_a_long_frame(clock: Clock, play: Play) -> None:
    began_s = clock.now_s
    play("99 fps_target=0.1", t7="x")
    assert clock.now_s - began_s == pytest.approx(7, abs=0.1)


@pytest.mark.parametrize("key", ["p", "P", "\x13"])
def test_p_pauses_tells_the_moment_and_resumes_without_a_leap(
        key: str, clock: Clock, play: Play) -> None:
    out = play("99 d v_mps=0.4 fps_target=10 use_observed_dt=True", t4_05=key, t24=key, t25_05="x")
    assert max(clock.lengths_s()) == pytest.approx(20, abs=0.1)
    (frame, t_s), = re.findall(
        r"^paused after frame (\d+), t = (.*) s: p resumes, s steps, x quits$", out, re.MULTILINE)
    assert frame == "11"
    assert float(t_s) == pytest.approx(1.1, abs=0.02)
    xs = positions_m(out)
    assert len(xs) in (21, 22)
    assert set(re.findall(r"FPS = +([0-9]+)", out)) == {"10"}
    for a_m, b_m in pairwise(xs):  # nor does it stand still: the frame is as long as any other
        assert b_m - a_m == pytest.approx(0.04, abs=0.011)


def test_s_goes_one_frame_further_and_pauses(play: Play) -> None:
    out = play("99 d v_mps=0.4 fps_target=10 use_observed_dt=True",
               t4_05="s", t30="s", t40="ss", t50="p", t50_5="x")
    frames = [int(frame) for frame in re.findall("paused after frame ([0-9]+)", out)]
    assert [frame - frames[0] for frame in frames] == [0, 1, 3]
    xs = positions_m(out)
    assert len(xs) - frames[-1] in (5, 6)
    for a_m, b_m in pairwise(xs):
        assert b_m - a_m == pytest.approx(0.04, abs=0.011)


def test_quick_steps_do_not_delay_the_film_nor_show_in_its_rate(clock: Clock, play: Play) -> None:
    out = play("99 d fps_target=2", t20="p", t21="sssss", t21_3="p", t30="x")
    assert set(re.findall(r"FPS = +([0-9]+)", out)) == {"2"}
    after_s = [moment_s - 1021.3 for moment_s in clock.frames_s if moment_s > 1021.3]
    assert after_s[0] < 0.55
    assert len(after_s) in (17, 18)


def test_keys_pressed_in_the_header_s_pause_count(clock: Clock, play: Play) -> None:
    assert ending(play("10", t1="x")) == "Stopped after 0 frames, t = 0.00 s: x was pressed."
    began_s = clock.now_s
    play("10 --frames 1", t1="p", t60="p")
    assert clock.frames_s[0] - began_s == pytest.approx(60, abs=0.1)
    began_s = clock.now_s
    out = play("10", t1="s", t60="x")
    assert clock.frames_s == pytest.approx([began_s + 1], abs=0.1)
    assert "paused after frame 1, t = 0.10 s" in out


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


@pytest.mark.parametrize(("has_keyboard", "why_shut", "where"), [
    (True, "no", "here"), (False, "", "in the little window"),
    (True, "", "here and in the little window"), (False, "no", "")])
def test_the_keys_are_told_and_the_next_example_is_named_where_there_are_any(
        has_keyboard: bool, why_shut: str, where: str, monkeypatch: pytest.MonkeyPatch,
        play: Play) -> None:
    monkeypatch.setattr(examples, "HAS_KEYBOARD", has_keyboard)
    monkeypatch.setattr(examples.Terminal, "take", lambda _: None)
    monkeypatch.setattr(examples.Window, "open", lambda window: setattr(
        window, "why_shut", why_shut))
    for name in ("show", "read", "close"):
        monkeypatch.setattr(examples.Window, name, lambda *_: [])
    out = " ".join(play("3 --frames 2").split())
    why = " (no window: no)." if why_shut else "."
    told = f"Keys {where}: p pauses, s steps, x quits" if where else "No keys here"
    assert f"a second. {told}{why} Now the car loses" in out
    assert out.endswith(f"Next: {PYTHON} airtrack.py 4" if where else EXAMPLES[3].seen)
    assert (f"{EXAMPLES[22].seen} Next: {PYTHON} airtrack.py chart" in " ".join(
        play("22 --frames 2").split())) is bool(where)
    for own in ("99", "-1"):
        assert (f"Next: {PYTHON} airtrack.py -h" in play(f"{own} --frames 2")) is bool(where)
    assert "Next" not in play("3 --fast --frames 2")


def test_after_the_film_it_is_told_what_was_to_be_seen(
        play: Play, monkeypatch: pytest.MonkeyPatch) -> None:
    for words, is_changed in (("10", False), ("10 CR=1", False), ("10 width_px=60", False),
                              ("10 m_to_px=9 show_exact_mark=True", False), ("10 CR=0.9", True),
                              ("10 fps_target=11", True), ("9 jitter=0.9", True),
                              ("9 use_observed_dt=False", True), ("99 v_mps=1", False),
                              ("10 auto_off=False", True), ("21 show_methods=False", True)):
        number = int(words.split()[0])
        example = EXAMPLES.get(number) or examples.OWN_SCENE
        before, _, after = " ".join(play(words, t4="x").split()).partition(": x was pressed. ")
        question = f"What differs from example {number} as it is?"
        assert example.seen not in before
        assert f". {question if is_changed else example.look_for} It begins" in before
        assert after.startswith("in " if is_changed or number == 99 else example.seen)
        assert after.endswith("" if is_changed else example.seen)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)  # of 80 columns: no change to the scene
    assert EXAMPLES[10].seen in " ".join(play("10", t4="x").split())
    assert play("10", t1="x").endswith("Stopped after 0 frames, t = 0.00 s: x was pressed.\n")
    assert ending(play("10 --frames 9 --fast")).startswith("Stopped after 9 frames")


def account(out: str) -> list[list[str]]:
    """The account that a film's output ends with: the cells of each row."""
    rows = [line for line in out.splitlines() if line[:16].rstrip() in ACCOUNT]
    assert [row[:16].rstrip() for row in rows] == [*ACCOUNT]
    return [re.split(" {2,}", row[17:]) for row in rows]


@pytest.mark.parametrize(("words", "CR", "fps", "fall_m", "seconds"), [
    ("CR=0.9", 0.9, 10, 1.75, 15), ("CR=0.3", 0.3, 10, 1.75, 2.3), ("CR=0.99", 0.99, 10, 1.75, 7.7),
    ("fps_target=25", 1, 25, 1.75, 19), ("x_m=1.5", 1, 10, 1.25, 1.3)])
def test_after_a_changed_film_its_bounces_hops_and_turns_stand_beside_those_of_the_example(
        words: str, CR: float, fps: int, fall_m: float, seconds: float, play: Play) -> None:
    scenes = (1, 10, 1.75), (CR, fps, fall_m)
    out = play(f"10 {words} --frames {round(seconds * fps)}")
    heads = f"{f'in {seconds:.2f} s':17}{'* as it is, 10 FPS':32}* changed, {fps} FPS"
    assert f"\n{heads}\n{ACCOUNT[0]}" in out
    assert "No figure differs" not in out
    for (kept, rate, way_m), (bounces, hops, turns, beyond, speed, *_) in zip(
            scenes, zip(*account(out), strict=True), strict=True):
        # At 2 m/s^2 the car rises or falls d in sqrt(d) s. A bounce leaves CR^2 of d.
        found, tops_m, now_s, rise_s = list[int](), list[float](), 0.0, math.sqrt(way_m)
        deepest_m = 0.0
        while (now_s := now_s + rise_s) <= seconds:
            found.append(math.ceil(now_s * rate))  # the frame at whose end
            late_s = found[-1] / rate - now_s
            deepest_m = max(deepest_m, 2 * rise_s * late_s + late_s**2)
            rise_s *= kept
            now_s += rise_s
            tops_m += [0.25 + rise_s**2] * (math.ceil(now_s * rate) <= seconds * rate)
        told = [str(b - a) for a, b in pairwise(found)]
        told[4:-2] = ["..."] * (len(told) > 6)
        tops_m[4:-1] = []
        assert (bounces, hops, beyond) == (
            f"{len(found)} left, 0 right", " ".join(told) or "-", f"up to {deepest_m:.3f} m")
        assert float(speed[:-4]) == pytest.approx(2 * math.sqrt(way_m), abs=2 / rate)
        assert [float(top) for top in re.findall("[0-9.]+[0-9]", turns)] == pytest.approx(
            tops_m, abs=0.0076)  # the higher of two frames is within (dt/2)^2 of the turn


def test_the_account_says_how_far_beyond_a_wall_the_car_was_and_whether_it_rests(
        play: Play) -> None:
    *_, beyond, _, rests = account(play("3 correction=rebound --frames 600"))
    assert beyond == ["up to 0.600 m", "up to 0.052 m"]  # 0.25 + 0.35, 5.2 cm: as the page says
    assert rests[0] == "no: last 554 hops have 1 lines"  # from frame 46 on, it is caught
    assert account(play("8 auto_off=False --frames 150"))[5] == [
        "no: last 5 hops have 26 lines"] * 2
    assert account(play("1 jitter=0.1"))[5] == ["yes, noticed at 8.37 s"] * 2
    # v is 0 at the end of a frame: one turn, and not two.
    turned = account(play("99 v_mps=1 a_mps2=-2 fps_target=4 --frames 4"))
    assert turned[:3] == [["0 left, 0 right"], ["-"], ["1.23"]]
    ball = account(play("99 x_m=2.25 a_mps2=-9.81 right_edge_m=3 CR=0.9", t15="x"))
    assert ball[1] == ["34 30 26 23 ... 2 2"]
    assert re.fullmatch("no: last [0-9]+ hops have 2 lines", ball[5][0])


def test_the_account_of_one_s_own_film_stands_before_what_to_do_next(play: Play) -> None:
    for words, told in (
            ("--frames 9", "0 left, 0 right - - up to 0.000 m 0.00 m/s not in this time"),
            ("v_mps=1.2 --frames 34", "0 left, 1 right - only at walls up to 0.020 m 1.20 m/s not "
             "in this time"),
            ("x_m=0.25 a_mps2=-2 CR=0", "10 left, 0 right 1 1 1 1 ... 1 1 only at walls up to "
             "0.002 m 0.00 m/s yes, noticed at 0.33 s")):
        out = play(f"99 {words}")
        assert " ".join(out.split()).endswith(examples.OWN_SCENE.seen) is ("not in" in told)
        assert re.search(r"\nin +[0-9.]+ s +\* your film, 30 FPS\n", out)
        assert " ".join(cell for cell, in account(out)) == told


def test_where_a_film_shows_the_true_car_that_has_an_account_too(play: Play) -> None:
    *_, of_the_o = play("17 CR=0.9 --frames 150").partition(" o as it is, 10 FPS  ")
    assert account(of_the_o) == account(play("10 CR=0.9 --frames 150"))


def test_where_the_clock_sets_the_steps_the_account_says_about(play: Play) -> None:
    out = play("12 correction=replay --frames 80")
    assert re.search(r"\nin about [0-9.]+ s +\* as it is, 10 FPS +\* changed, 10 FPS\n", out)
    assert out.endswith("\nNo figure differs.\n")
    out = play("99 x_m=2 a_mps2=-2 fps_target=2 jitter=0.9 use_observed_dt=True --frames 2")
    t_s, = re.findall(" about (.*) s ", out)
    assert float(account(out)[4][0][:-4]) == pytest.approx(2 * float(t_s), abs=0.02)


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
    told = f"Drawn {width_px} columns wide, to fit."
    assert (told in " ".join(out.split())) is (width_px < 135)
    walls = [i for i, c in enumerate(lines[0]) if c == "|"]
    assert walls == [round(at_m * zoom) for at_m in (0.25, 2.2)]
    assert lines[13].endswith("x =   0.45, v =  2.49, FPS =  10")
    for words in ("d right_edge_m=20 m_to_px=6.7", "right_edge_m=2.43"):
        line = play(f"99 {words} --fast --frames 1").splitlines()[-2]
        assert line.partition("x =")[0][-1] == "|"


@pytest.mark.parametrize(("right_m", "width_px"), [
    (20, 135), (3, 40), (999.9, 10), (1000, 1000), (135 / 55, 135)])
def test_a_wall_outside_the_picture_is_told_with_the_zoom_that_would_show_it(
        right_m: float, width_px: int, play: Play) -> None:
    words = f"99 right_edge_m={right_m} width_px={width_px} --fast --frames 1"
    told = " ".join(play(words).split())
    found = re.search(r"ends before a wall: m_to_px=([0-9.]+) would show both", told)
    assert found
    told = play(f"{words} m_to_px={found[1]}")
    assert "ends before" not in told
    assert "|" in told


@pytest.mark.parametrize(("left_m", "is_told"), [
    (-1, True), (-0.01, True), (-0.009, False), (0, False), (0.25, False)])
def test_a_wall_left_of_the_picture_is_told(left_m: float, is_told: bool, play: Play) -> None:
    out = play(f"99 left_edge_m={left_m} --fast --frames 1")
    assert ("The picture begins at x = 0: shift x_m and the walls." in out) is is_told
    assert "before a wall" not in out
    assert ending(out) == "Stopped after 1 frame, t = 0.03 s: that is the frame limit."
