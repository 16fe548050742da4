"""The main loop and its keys, on a clock that the test sets."""

import re
from itertools import pairwise

import pytest

import examples
from airtrack import PYTHON
from clock import Clock, Play, plain, steps_s
from examples import EXAMPLES, OWN_SCENE

FREE = "99 d v_mps=10 right_edge_m=990"  # it meets no wall, so that steps_s() can tell its dt
ENTER, CTRL_C, CTRL_S = "\r", "\x03", "\x13"
NOW = {0: ENTER}  # begin at once: then frame 1 comes at 0.05 s, after a look at the keys


# Pacing.

@pytest.mark.parametrize("fps", [10, 300])
def test_a_long_film_keeps_its_rate_however_long_the_work_takes(
        fps: int, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.3 / fps
    play(f"99 fps_target={fps} auto_off=False --frames 1001", NOW)
    assert clock.frames_s[-1] - clock.frames_s[0] == pytest.approx(1000 / fps, rel=0.001)


@pytest.mark.parametrize(("late_s", "is_made_up"), [(0.14, True), (0.16, False), (9, False)])
def test_a_short_delay_is_made_up_but_after_a_stall_the_film_does_not_race(
        late_s: float, is_made_up: bool, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: late_s + 0.1 if frame == 10 else 0.0
    play("99 fps_target=10 auto_off=False --frames 60", NOW)
    took_s = 5.9 if is_made_up else 5.9 + late_s
    assert clock.frames_s[-1] - clock.frames_s[0] == pytest.approx(took_s, abs=0.001)
    if not is_made_up:
        assert min(clock.lengths_s()) > 0.099


@pytest.mark.parametrize(("fps", "late_s", "counted_s"), [
    (30, 0.12, 0.12), (30, 0.19, 1 / 30), (2, 0.64, 0.64), (2, 0.66, 0.5), (2, 9, 0.5)])
def test_an_observed_frame_counts_as_long_as_it_lasts_but_in_a_stall_the_car_does_not_leap(
        fps: int, late_s: float, counted_s: float, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: late_s if frame == 5 else 0.0
    found_s = steps_s(play(f"{FREE} fps_target={fps} use_observed_dt=True --frames 9", NOW))
    assert found_s[4] == pytest.approx(counted_s, abs=0.002)
    assert found_s[:3] == pytest.approx([1 / fps] * 3, abs=0.002)


def test_a_film_whose_every_frame_is_late_steps_by_what_it_observes(
        clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.06
    out = play(f"{FREE} fps_target=30 use_observed_dt=True --frames 50", NOW)
    assert sum(steps_s(out)) == pytest.approx(49 * 0.06, abs=0.01)
    assert sum(steps_s(play(f"{FREE} fps_target=30 --frames 50", NOW))) == pytest.approx(
        49 / 30, abs=0.01)


def test_a_clock_that_does_not_tick_between_two_frames_does_no_harm(
        clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.14 if frame == 5 else 0.0  # 6 to 9 are due at once
    found_s = steps_s(play(f"{FREE} fps_target=30 use_observed_dt=True --frames 20", NOW))
    assert found_s[5:7] == [0, 0]
    assert sum(found_s) == pytest.approx(19 / 30, abs=0.01)


def test_jitter_makes_frames_irregular_but_not_the_film_longer_and_a_fast_film_has_the_same(
        clock: Clock, play: Play) -> None:
    words = f"{FREE} fps_target=10 jitter=0.9 use_observed_dt=True --frames 500"
    found_s = steps_s(play(words, NOW))
    assert found_s == pytest.approx(clock.lengths_s(), abs=0.002)
    assert found_s == pytest.approx(steps_s(play(f"{words} --fast")), abs=0.002)
    assert (min(found_s), max(found_s)) == pytest.approx((0.01, 0.19), abs=0.003)
    assert sum(found_s) == pytest.approx(49.9, abs=0.2)
    early, late = sorted(found_s)[100], sorted(found_s)[400]  # spread evenly, not long and short
    assert (early, late) == pytest.approx((0.046, 0.154), abs=0.005)


def test_the_details_show_the_rate_that_was_observed(clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.05 if frame == 3 else 0.0
    words = "99 d fps_target=100 --frames 6"
    assert re.findall(r"FPS = +([0-9]+)", play(words, NOW))[::3] == ["100", "20"]
    assert set(re.findall(r"FPS = +([0-9]+)", play(f"{words} --fast"))) == {"100"}


# Keys in a film.

@pytest.mark.parametrize("key", ["p", "P", CTRL_S])
def test_p_pauses_and_then_the_film_goes_on_without_a_race_or_a_leap(
        key: str, clock: Clock, play: Play) -> None:
    out = play(f"{FREE} fps_target=10 use_observed_dt=True",
               {0: ENTER, 1: key, 31: key, 32: "x"})
    shortest_s, *_, second_s, longest_s = sorted(clock.lengths_s())
    assert (shortest_s, second_s) == pytest.approx((0.1, 0.1), abs=0.002)
    assert longest_s == pytest.approx(30, abs=0.2)
    assert steps_s(out) == pytest.approx([0.1] * (len(clock.frames_s) - 1), abs=0.002)


def test_s_shows_a_frame_for_each_time_that_it_is_pressed_and_p_goes_on(
        clock: Clock, play: Play) -> None:
    play("10", {0: ENTER, 1: "s", 10: "s", 20: "ss", 30: "p", 31: "x"})
    spans_s = pairwise([0, 1, 9, 19, 29, 40])
    assert [clock.frames_between(*span_s) for span_s in spans_s] == [10, 1, 1, 2, 10]


@pytest.mark.parametrize(("keys", "frames_after_5_s"), [
    ({1: "sp", 3: "p"}, 0),  # p has let the film go on: what s asked for is forgotten
    ({1: "s", 3: "p", 4: "p", 6: "s"}, 1)])
def test_after_p_steps_are_counted_anew(
        keys: dict[float, str], frames_after_5_s: int, clock: Clock, play: Play) -> None:
    play("10", {0: ENTER} | keys | {30: "x"})
    assert clock.frames_between(5, 30) == frames_after_5_s


def test_x_is_answered_within_a_long_frame(clock: Clock, play: Play) -> None:
    play("99 fps_target=0.1", {0: ENTER, 3: "x"})
    assert clock.now_s - clock.began_s == pytest.approx(3, abs=0.1)


@pytest.mark.parametrize(("words", "keys", "why"), [
    ("10 d", {4: "x"}, "x"), ("10", {4: "X"}, "x"), ("10", {4: CTRL_C}, "Ctrl-C"),
    ("10", {4: f"{ENTER}q", 5: "\n", 6: "x"}, "x"), ("10", {4: "p", 5: "x"}, "x"),
    ("10", {4: "p", 5: CTRL_C}, "Ctrl-C"), ("1", {}, "at rest"), ("10 --frames 7", {}, "limit"),
    ("1 auto_off=False --frames 300", {}, "limit")])
def test_the_end_says_when_and_why_and_then_what_was_to_be_seen(
        words: str, keys: dict[float, str], why: str, clock: Clock, play: Play) -> None:
    out = play(words, NOW | keys)
    example = EXAMPLES[int(words.split()[0])]
    fps = example.settings.get("fps_target", 30)
    (frames, t_s, reason), = re.findall(r"Stopped after (\d+) frames, t = (.*) s: (.*)\.\n", out)
    assert int(frames) == len(clock.frames_s)
    assert float(t_s) == pytest.approx(len(clock.frames_s) / fps, abs=0.006)
    assert re.search(rf"\b{why}\b", reason)
    assert example.seen in plain(out)
    if keys:
        assert clock.now_s - clock.began_s == pytest.approx(max(keys), abs=0.2)


def test_a_pause_is_told_in_a_line_that_vanishes_and_a_pipe_is_spared_it(
        play: Play, monkeypatch: pytest.MonkeyPatch) -> None:
    keys = {1: "p", 2: "p", 20: "p", 25: "p", 26: "s", 30: "x"}  # first before the film
    assert "\r" not in play("10", keys)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "50")
    told = re.findall(r"([^\r\n]*)\r", play("10", keys))
    assert len(told) == 6
    for text, blanks in zip(told[::2], told[1::2], strict=True):
        assert blanks == " " * len(text)
        assert 10 < len(text) < 50  # it would begin a new line in the last column
    assert re.search(r"\b100\b.*\b10\.0", told[2])  # which frame and moment it is
    assert re.search(r"\b111\b", told[4])


# Before and after a film.

def test_before_the_film_p_holds_the_text_s_shows_frame_1_and_holds_and_x_quits(
        clock: Clock, play: Play) -> None:
    play("10 --frames 1", {1: "p", 60: "p"})
    assert clock.frames_s == pytest.approx([60], abs=0.11)
    play("10", {1: "s", 60: "x"})
    assert clock.frames_s == pytest.approx([1], abs=0.11)
    out = play("10", {1: "x"})
    assert clock.frames_s == []
    assert clock.now_s - clock.began_s < 1.2
    assert "Stopped after 0 frames" in out
    assert EXAMPLES[10].seen not in plain(out)  # it would tell what there is still to be guessed


@pytest.mark.parametrize("key", ["\r", "\n", CTRL_C])
def test_enter_and_ctrl_c_begin_the_film_at_once_and_let_go_of_a_pause(
        key: str, clock: Clock, play: Play) -> None:
    for keys in ({1: key}, {0.5: "p", 1: key}):
        out = play("10 --frames 20", keys)
        assert clock.frames_s[0] == pytest.approx(1, abs=0.11)
        assert clock.lengths_s() == pytest.approx([0.1] * 19, abs=0.001)
        head, _, _ = out.partition("|")
        assert bool(re.search(r"\n +\*\n +\* \*\n", head)) is (key == CTRL_C)  # a diamond


@pytest.mark.parametrize(("has_terminal", "has_window", "reading_s"), [
    (True, False, 10), (False, True, 10), (False, False, 3)])
def test_before_a_film_there_is_time_to_read_the_question_and_what_the_keys_do(
        has_terminal: bool, has_window: bool, reading_s: int, clock: Clock, play: Play,
        monkeypatch: pytest.MonkeyPatch) -> None:
    def open_or_not(window: examples.Window) -> None:
        window.why_shut = "" if has_window else "somebody has bricked it up"

    monkeypatch.setattr(examples, "HAS_TERMINAL", has_terminal)
    monkeypatch.setattr(examples.Window, "__init__", open_or_not)
    for name in ("keys", "close"):
        monkeypatch.setattr(examples.Window, name, lambda window: [])
    for number, example in ((8, EXAMPLES[8]), (99, OWN_SCENE)):
        out = play(f"{number} --frames 1")
        header = plain(out.partition("\n\n")[0])
        assert clock.frames_s[0] == pytest.approx(reading_s, abs=0.11)
        assert f"{reading_s} s" in header
        assert example.look_for in header
        assert ("bricked" in header) is not has_window
        assert bool(re.search(r"\bp\b.*\bs\b.*\bx\b", header)) is (has_terminal or has_window)
        if not has_terminal and not has_window:
            assert re.search(r"Ctrl-C[^.]*\bends?\b", header)


def test_a_film_says_what_comes_next_and_a_fast_one_says_no_more_than_it_shows(play: Play) -> None:
    for number, following in ((1, "2"), (max(EXAMPLES), "chart"), (99, "chart"), (-3, "chart")):
        last_line = play(f"{number} --frames 3", NOW).splitlines()[-1]
        assert last_line.endswith(f"{PYTHON} airtrack.py {following}")
    out = plain(play("1 --frames 3 --fast"))
    assert EXAMPLES[1].look_for in out
    assert EXAMPLES[1].seen not in out
    assert "airtrack.py" not in out
