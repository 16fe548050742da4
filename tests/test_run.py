"""The main loop and its keys, on a clock that the test sets."""

import re
from itertools import pairwise
from types import SimpleNamespace

import pytest

import examples
from clock import Clock, Play, plain
from examples import EXAMPLES

FREE = "99 d v_mps=10 right_edge_m=990"  # it meets no wall, so that steps_s() can tell its dt
ENTER, CTRL_C, CTRL_S = "\r", "\x03", "\x13"
NOW = {0: ENTER}  # begin at once: then frame 1 comes at 0.05 s, after a look at the keys

def steps_s(out: str) -> list[float]:
    """How much time has passed for a car at 10 m/s from each frame to the next."""
    places_m = [float(x) for x in re.findall(r"x = +(-?[0-9.]+), v", out)]
    return [(after_m - before_m) / 10 for before_m, after_m in pairwise(places_m)]

@pytest.mark.parametrize("fps", [10, 300])
def test_a_long_film_keeps_its_rate_while_work_takes_time(
        fps: int, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.3 / fps
    play(f"99 fps_target={fps} auto_off=False --frames 1001", NOW)
    assert clock.frames_s[-1] - clock.frames_s[0] == pytest.approx(1000 / fps, rel=0.001)

@pytest.mark.parametrize(("late_s", "is_made_up"), [(0.14, True), (0.16, False), (9, False)])
def test_a_short_delay_is_made_up_but_after_a_stall_the_film_does_not_race(
        late_s: float, is_made_up: bool, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: late_s + 0.1 if frame == 10 else 0.0
    out = play(f"{FREE} fps_target=10 use_observed_dt=True --frames 60", NOW)
    took_s = 5.9 if is_made_up else 5.9 + late_s
    assert clock.frames_s[-1] - clock.frames_s[0] == pytest.approx(took_s, abs=0.002)
    assert sum(steps_s(out)) == pytest.approx(5.9, abs=0.002)
    # To make it up, two frames come at once. The clock does not even tick between them.
    assert min(clock.lengths_s()) == pytest.approx(0 if is_made_up else 0.1, abs=0.001)

@pytest.mark.parametrize(("fps", "late_s", "counted_s"), [
    (30, 0.12, 0.12), (30, 0.19, 1 / 30), (2, 0.64, 0.64), (2, 0.66, 0.5), (2, 9, 0.5)])
def test_an_observed_frame_counts_as_long_as_it_lasts_but_in_a_stall_the_car_does_not_leap(
        fps: int, late_s: float, counted_s: float, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: late_s if frame == 5 else 0.0
    out = play(f"{FREE} fps_target={fps} use_observed_dt=True --frames 9", NOW)
    assert steps_s(out)[:5] == pytest.approx([1 / fps] * 4 + [counted_s], abs=0.002)
    rates = re.findall(r"FPS = +([0-9]+)", out)  # what was observed, whatever counts
    assert [float(rate) for rate in rates[:6]] == pytest.approx([fps] * 5 + [1 / late_s], abs=0.6)

def test_with_jitter_frames_are_irregular_and_a_fast_film_has_the_same(
        clock: Clock, play: Play) -> None:
    words = f"{FREE} fps_target=10 jitter=0.9 use_observed_dt=True --frames 500"
    found_s = steps_s(play(words, NOW))
    assert found_s == pytest.approx(clock.lengths_s(), abs=0.002)
    assert found_s == pytest.approx(steps_s(play(f"{words} --fast")), abs=0.002)
    ending, = re.findall(r"Stopped after 500 frames, t = ([\d.]+) s", play(f"{words} --fast"))
    assert float(ending) == pytest.approx(sum(found_s) + found_s[0], abs=0.15)
    spread_s = [sorted(found_s)[place] for place in (0, 124, 249, 374, 498)]
    assert spread_s == pytest.approx([0.01, 0.055, 0.1, 0.145, 0.19], abs=0.003)

@pytest.mark.parametrize("keys", ["pp", "PP", CTRL_S * 2, CTRL_S + "p"])
def test_p_pauses_and_then_the_film_goes_on_without_a_race_or_a_leap(
        keys: str, clock: Clock, play: Play) -> None:
    out = play(f"{FREE} fps_target=10 use_observed_dt=True",
               NOW | {1: keys[0], 31: keys[1], 32: "x"})
    *others_s, longest_s = sorted(clock.lengths_s())
    assert others_s == pytest.approx([0.1] * 18, abs=0.002)
    assert longest_s == pytest.approx(30, abs=0.2)
    assert steps_s(out) == pytest.approx([0.1] * 19, abs=0.002)
    assert set(re.findall(r"FPS = +([0-9]+)", out)) == {"10"}

def test_the_frame_after_a_pause_shows_the_planned_rate(clock: Clock, play: Play) -> None:
    words = f"{FREE} fps_target=10 jitter=0.5 use_observed_dt=True"
    out = play(words, NOW | {1: "p", 3: "p", 5: "x"})
    rates = [float(rate) for rate in re.findall(r"FPS = +([0-9]+)", out)]
    lengths_s = clock.lengths_s()
    after = lengths_s.index(max(lengths_s)) + 1
    assert rates[after] == 10
    assert 10 not in (rates[after - 1], rates[after + 1])

def test_after_a_pause_the_next_frame_comes_at_once(clock: Clock, play: Play) -> None:
    play("99 v_mps=1 fps_target=0.2", NOW | {6: "p", 9: "p", 15: "x"})
    assert clock.frames_s == pytest.approx([0, 5, 9, 14], abs=0.2)

def test_s_shows_a_frame_for_each_time_that_it_is_pressed_and_p_goes_on(
        clock: Clock, play: Play) -> None:
    play("10", NOW | {1: "s", 10: "s", 20: "s" * 20, 21: "p", 22: "sp", 23: "p", 39: "x"})
    spans_s = pairwise([0, 1, 9, 19, 21, 22, 23, 40])
    counts = [sum(from_s <= at_s < to_s for at_s in clock.frames_s) for from_s, to_s in spans_s]
    assert counts == [10, 1, 1, 20, 10, 10, 0]

@pytest.mark.parametrize(("fps", "drawing_s"), [(0.1, 0), (30, 0.1)])
def test_x_is_answered_in_a_long_frame_and_where_every_frame_is_late(
        fps: float, drawing_s: float, clock: Clock, play: Play) -> None:
    clock.when_drawn = lambda frame: drawing_s
    play(f"99 fps_target={fps} auto_off=False --frames 100", NOW | {3: "x"})
    assert clock.now_s == pytest.approx(3, abs=0.2)

@pytest.mark.parametrize(("words", "keys", "why", "following"), [
    ("10", {4: "x"}, "x", "11"), ("10 d", {4: "X"}, "x", "11"), ("10", {4: CTRL_C}, "Ctrl-C", "11"),
    ("10", {4: f"{ENTER}q", 5: "p", 6: "x"}, "x", "11"), ("1", {}, "at rest", "2"),
    ("1 auto_off=False --frames 300", {}, "limit", "2"), ("22 --frames 7", {}, "limit", "chart")])
def test_the_end_says_when_and_why_it_came_what_was_to_be_seen_and_what_comes_next(
        words: str, keys: dict[float, str], why: str, following: str, clock: Clock,
        play: Play) -> None:
    out = play(words, NOW | keys)
    example = EXAMPLES[int(words.split()[0])]
    (frames, t_s, reason), = re.findall(r"Stopped after (\d+) frames, t = (.*) s: (.*)\.\n", out)
    assert int(frames) == len(clock.frames_s)
    t_in_frames = float(t_s) * example.settings.get("fps_target", 30)
    assert t_in_frames == pytest.approx(len(clock.frames_s), abs=0.5)
    assert re.search(rf"\b{why}\b", reason)
    assert example.seen in plain(out)
    assert out.endswith(f"airtrack.py {following}\n")

def test_a_pause_is_told_in_a_line_that_vanishes_and_a_pipe_is_spared_it(
        play: Play, monkeypatch: pytest.MonkeyPatch) -> None:
    keys = {1: "p", 2: "p", 20: "p", 25: "x"}  # first before the film
    assert "\r" not in play("10", keys)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "50")
    told, blanks, of_the_film, blanks_again = re.findall(r"([^\r\n]*)\r", play("10", keys))
    assert blanks == " " * len(told)
    assert blanks_again == " " * len(of_the_film)
    assert 10 < len(told) < 50  # from the last column on it would begin a new line
    assert re.search(r"\b100\b", of_the_film)  # which frame it is
    assert "\r" not in play("10", NOW | {4: "x"})

@pytest.mark.parametrize(("keys", "frames_s"), [
    ({1: "\r"}, [1, 1.1]), ({1: "\n"}, [1, 1.1]), ({1: CTRL_C}, [1, 1.1]),
    ({1: "p", 60: ENTER}, [60, 60.1]), ({1: "p", 60: CTRL_C}, [60, 60.1]),
    ({1: "p", 60: "p"}, [60, 60.1]), ({1: "p", 2: "p"}, [10, 10.1]),
    ({1: "s", 60: "x"}, [1]), ({1: "x"}, []), ({1: "q"}, [10, 10.1])])
def test_before_a_film_enter_and_ctrl_c_begin_it_p_holds_the_text_s_shows_frame_1_and_x_quits(
        keys: dict[float, str], frames_s: list[float], clock: Clock, play: Play) -> None:
    out = play("10 --frames 2", keys)
    assert clock.frames_s == pytest.approx(frames_s, abs=0.11)
    assert clock.now_s == pytest.approx(max(*keys, *frames_s, 0), abs=0.2)
    assert bool(re.search(r"\n +\*\n +\* \*\n", out)) is (CTRL_C in keys.values())  # a diamond
    assert (EXAMPLES[10].seen in plain(out)) is bool(frames_s)  # else it is still to be guessed

@pytest.mark.parametrize(("has_terminal", "why_shut", "reading_s"), [
    (True, "it is bricked up", 10), (False, "", 10), (False, "it is bricked up", 3)])
def test_before_a_film_there_is_time_to_read_the_question_and_what_the_keys_do(
        has_terminal: bool, why_shut: str, reading_s: int, clock: Clock, play: Play,
        monkeypatch: pytest.MonkeyPatch) -> None:
    window = SimpleNamespace(why_shut=why_shut, keys=list)
    monkeypatch.setattr(examples, "HAS_TERMINAL", has_terminal)
    monkeypatch.setattr(examples, "Window", lambda: window)
    header = plain(play("8 --frames 1").partition("\n\n")[0])
    assert clock.frames_s == pytest.approx([reading_s], abs=0.11)
    assert f"{reading_s} s" in header
    assert EXAMPLES[8].look_for in header
    assert why_shut in header
    if reading_s == 10:
        assert re.search(r"\bp\b.*\bs\b.*\bx\b.*\bEnter\b", header)
    else:
        assert re.search(r"Ctrl-C[^.]*\bends?\b", header)
