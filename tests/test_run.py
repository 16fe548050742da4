"""The main loop, on a clock that the test sets: pacing, stalls, observed dt, keys, the ends."""

import io
import re
import signal
from itertools import pairwise

import pytest

import examples
from airtrack import Scene, main, step
from clock import Capture, Clock, Keyboard, positions_m
from examples import EXAMPLES


def ending(capsys: Capture) -> str:
    return capsys.readouterr().out.splitlines()[-1]


# Pacing.

@pytest.mark.parametrize("fps", [300, 240, 10])
def test_work_and_oversleeping_do_not_slow_the_film(fps: int, clock: Clock) -> None:
    clock.when_drawn = lambda frame: 0.3 / fps
    assert main(["99", f"fps_target={fps}", "--frames", "1001"]) == 0
    took_s = clock.frames_s[-1] - clock.frames_s[0]
    assert 1000 / took_s == pytest.approx(fps, rel=0.002)


def test_a_missed_deadline_is_not_made_up_by_a_burst(clock: Clock) -> None:
    clock.when_drawn = lambda frame: 0.5 if frame == 10 else 0.001
    assert main(["99", "fps_target=100", "--frames", "40"]) == 0
    lengths_s = clock.lengths_s()
    assert lengths_s[9] == pytest.approx(0.5, rel=0.01)
    assert lengths_s[10:] == pytest.approx([0.01] * 29, rel=0.02)


def test_the_pause_before_the_first_frame(clock: Clock) -> None:
    for number, pause_s in (("0", 0), ("1", 5), ("3", 4), ("5", 3)):
        began_s, clock.frames_s = clock.now_s, []
        assert main([number, "--frames", "1"]) == 0
        assert clock.frames_s[0] - began_s == pytest.approx(pause_s, abs=0.01)


def test_each_line_goes_out_at_once_and_does_not_wait_in_a_buffer(
        clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    class Output(io.StringIO):
        waiting = ""

        def write(self, text: str) -> int:
            self.waiting += text
            return super().write(text)

        def flush(self) -> None:
            self.waiting = ""

    output, sleep = Output(), clock.sleep

    def sleep_when_all_is_out(seconds: float) -> None:
        assert output.waiting == ""
        sleep(seconds)

    monkeypatch.setattr("examples.time.sleep", sleep_when_all_is_out)
    monkeypatch.setattr("sys.stdout", output)
    assert main(["10", "--frames", "5"]) == 0
    assert output.getvalue().count("*") >= 5


# Stalls and the observed dt.

@pytest.mark.parametrize(("fps", "late_s", "is_stall"), [
    (30, 0.14, False), (30, 0.16, True), (2, 0.74, False), (2, 0.76, True)])
@pytest.mark.parametrize("observed", [True, False])
def test_after_a_stall_longer_than_150_ms_and_one_and_a_half_frames_the_car_holds_still(
        fps: float, late_s: float, is_stall: bool, observed: bool, clock: Clock,
        capsys: Capture) -> None:
    clock.when_drawn = lambda frame: late_s * (frame == 5)
    main(["99", "d", "v_mps=0.4", "right_edge_m=9", f"fps_target={fps}", "--frames", "9",
          f"use_observed_dt={observed}"])
    lines = capsys.readouterr().out.splitlines()
    xs = positions_m("\n".join(lines))
    moved_m = [b - a for a, b in pairwise(xs)]
    assert (moved_m[4] == 0) is is_stall
    assert 0 < moved_m[5] <= 0.4 / fps + 0.011  # and no longer than for that frame
    if not observed:
        assert f"t = {(9 - is_stall) / fps:.2f} s" in lines[-1]


def test_while_the_car_holds_still_no_collision_is_marked_again(
        clock: Clock, capsys: Capture) -> None:
    clock.when_drawn = lambda frame: 1.0 * (frame == 14)  # example 10's first bounce
    main(["10", "--frames", "15"])
    *_, fourteen, fifteen, _ = capsys.readouterr().out.splitlines()
    assert (fourteen.index("0"), fourteen.index("*")) == (2, 25)
    assert fifteen.index("*") == 25
    assert "0" not in fifteen


def test_observed_dt_is_the_length_of_the_frame_before(clock: Clock, capsys: Capture) -> None:
    clock.when_drawn = lambda frame: 0.12 if frame % 3 == 0 else 0.0
    for observed in (True, False):
        clock.frames_s = []
        main(["99", "d", "right_edge_m=100", "v_mps=10", "fps_target=10", "--frames", "12",
              f"use_observed_dt={observed}"])
        xs, lengths_s = positions_m(capsys.readouterr().out), clock.lengths_s()
        assert max(lengths_s) > 1.15 * min(lengths_s)
        for (a_m, b_m), length_s in zip(pairwise(xs), lengths_s, strict=True):
            assert b_m - a_m == pytest.approx(10 * (length_s if observed else 0.1), abs=0.0101)


def test_examples_9_11_and_12_are_irregular_and_no_others() -> None:
    irregular = {number for number, example in EXAMPLES.items()
                 if Scene(**example.settings).use_observed_dt}
    assert irregular == {9, 11, 12}


def test_the_details_show_the_observed_rate(clock: Clock, capsys: Capture) -> None:
    clock.when_drawn = lambda frame: 0.05 if frame == 3 else 0.0
    main(["99", "d", "fps_target=100", "--frames", "6"])
    rates = re.findall(r"FPS = +([0-9]+)", capsys.readouterr().out)
    assert rates[0] == "100"
    assert rates[3] == "20"


def test_fast_runs_at_the_nominal_dt_whatever_use_observed_dt_says(capsys: Capture) -> None:
    main(["9", "d", "--fast", "--frames", "50"])
    scene = Scene(**EXAMPLES[9].settings)
    x_m, v_mps = scene.x_m, scene.v_mps
    for shown_m in positions_m(capsys.readouterr().out):
        x_m, v_mps, _ = step(scene, x_m, v_mps, 0.1)
        assert shown_m == round(x_m, 2)


# At rest.

def test_at_rest_is_when_the_last_ten_positions_average_to_a_wall_within_a_millimetre(
        capsys: Capture) -> None:
    for start_m, is_rest in ((0.2509, True), (0.2511, False), (2.1991, True)):
        main(["99", f"x_m={start_m}", "--fast", "--frames", "20"])
        end = ending(capsys)
        assert end.startswith("Stopped after 10 frames, t = 0.33 s: the car is at rest against a "
                              "wall." if is_rest else "Stopped after 20 frames")
    main(["99", "left_edge_m=0", "x_m=0", "--fast", "--frames", "20"])  # at a wall, but ten frames
    assert ending(capsys).startswith("Stopped after 10 frames")
    main(["99", "x_m=0.25", "--fast", "--frames", "1"])
    assert ending(capsys) == "Stopped after 1 frame, t = 0.03 s: that is the frame limit."
    main(["99", "x_m=0.25", "auto_off=False", "--fast", "--frames", "20"])
    assert ending(capsys) == "Stopped after 20 frames, t = 0.67 s: that is the frame limit."


# Keys.

@pytest.mark.parametrize(("key", "why"), [
    ("x", "x was pressed"), ("X", "x was pressed"), ("\x1b", "Esc was pressed"),
    ("\x03", "Ctrl-C was pressed"), (examples.WINDOW_CLOSED, "the window was closed")])
def test_keys_that_quit(key: str, why: str, clock: Clock, monkeypatch: pytest.MonkeyPatch,
                        capsys: Capture) -> None:
    monkeypatch.setattr(examples.Window, "read", lambda _: [key] if clock.now_s > 1004 else [])
    assert main(["10"]) == 0
    frames = len(clock.frames_s)
    assert frames in (10, 11)
    assert ending(capsys) == f"Stopped after {frames} frames, t = {frames / 10:.2f} s: {why}."


def test_x_is_answered_within_a_long_frame(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    Keyboard(clock, monkeypatch, t7="x")
    began_s = clock.now_s
    main(["99", "fps_target=0.1"])
    assert clock.now_s - began_s == pytest.approx(7, abs=0.1)


@pytest.mark.parametrize("key", ["p", "P", "\x13"])
def test_p_pauses_tells_the_moment_and_resumes_without_a_leap(
        key: str, clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t4_05=key, t24=key, t25_05="x")
    main(["99", "d", "v_mps=0.4", "fps_target=10", "use_observed_dt=True"])
    out = capsys.readouterr().out
    assert max(clock.lengths_s()) == pytest.approx(20, abs=0.1)
    paused = re.findall(r"^paused after frame (\d+), t = (.*) s: p goes on, s steps, x quits$", out,
                        re.MULTILINE)
    assert [int(frame) for frame, _ in paused] == [11]
    assert float(paused[0][1]) == pytest.approx(1.1, abs=0.02)
    xs = positions_m(out)
    assert len(xs) in (21, 22)
    for a_m, b_m in pairwise(xs):  # nor does it stand still: the frame is as long as any other
        assert b_m - a_m == pytest.approx(0.04, abs=0.011)


def test_s_goes_one_frame_further_and_pauses(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t4_05="s", t30="s", t40="ss", t50="p", t50_5="x")
    main(["99", "d", "v_mps=0.4", "fps_target=10", "use_observed_dt=True"])
    out = capsys.readouterr().out
    frames = [int(frame) for frame in re.findall("paused after frame ([0-9]+)", out)]
    assert [frame - frames[0] for frame in frames] == [0, 1, 3]
    xs = positions_m(out)
    assert len(xs) - frames[-1] in (5, 6)
    for a_m, b_m in pairwise(xs):
        assert b_m - a_m == pytest.approx(0.04, abs=0.011)


def test_keys_pressed_in_the_header_s_pause_count(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t1="x")
    main(["10"])
    assert ending(capsys) == "Stopped after 0 frames, t = 0.00 s: x was pressed."
    Keyboard(clock, monkeypatch, t1="p", t60="p")
    began_s = clock.now_s
    main(["10", "--frames", "1"])
    assert clock.frames_s[0] - began_s == pytest.approx(60, abs=0.1)
    clock.frames_s = []
    Keyboard(clock, monkeypatch, t1="s", t60="x")
    began_s = clock.now_s
    main(["10"])
    assert clock.frames_s == pytest.approx([began_s + 1], abs=0.1)
    assert "paused after frame 1, t = 0.10 s" in capsys.readouterr().out


def test_ctrl_c_cuts_the_header_s_pause_short_and_a_diamond_says_so(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    diamond = "   *\n  * *\n *   *\n  * *\n   *\n"
    Keyboard(clock, monkeypatch, t1="\x03")
    began_s = clock.now_s
    main(["10", "--frames", "1"])
    assert clock.frames_s[0] - began_s == pytest.approx(1, abs=0.1)
    assert diamond in capsys.readouterr().out
    Keyboard(clock, monkeypatch, t1="\x03x")  # it does not swallow what comes with it
    main(["10"])
    out = capsys.readouterr().out
    assert diamond in out
    assert out.endswith("Stopped after 0 frames, t = 0.00 s: x was pressed.\n")


def test_on_a_terminal_the_pause_s_notice_stands_only_until_the_run_goes_on(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    Keyboard(clock, monkeypatch, t4_05="p", t6="s", t7="x")
    main(["99", "fps_target=10"])
    notice, frames = re.compile(r"paused after frame \d+, t = [0-9.]+ s: [^\r\n]*"), 0
    for line in capsys.readouterr().out.split("\n"):
        found = notice.search(line)
        if found:
            rest = line[found.end():]
            assert rest.startswith("\r" + " " * len(found[0]) + "\r")
            frames += 1
    assert frames == 2


def test_of_several_signals_the_first_is_the_reason_and_Ctrl_C_in_the_header_is_none(
        clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os._exit", lambda status: pytest.fail("ended at once"))
    keys = examples.Keys()
    keys.is_reading = True
    keys.note(signal.SIGINT, None)
    keys.look()
    assert (keys.is_reading, keys.why_quit) == (False, "")
    clock.now_s += 2
    for number in (signal.SIGTERM, signal.SIGINT):
        keys.note(number, None)
    keys.look()
    assert (keys.why_quit, keys.status) == ("SIGTERM", 128 + signal.SIGTERM)


def test_the_help_line_names_the_places_in_which_keys_work(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    for is_raw, why_shut, places in (
            (True, "no", "Keys, in this terminal: p or"),
            (False, "", "Keys, in the little window: p"),
            (True, "", "Keys, in the little window and in this terminal: p"),
            (False, "no", "Keys: Ctrl-C quits.")):
        keys = examples.Keys()
        keys.terminal.is_raw, keys.window.why_shut = is_raw, why_shut
        assert keys.help().startswith(places)
        assert ("s steps one frame further" in keys.help()) is (places[4] == ",")


# The picture and the terminal.

@pytest.mark.parametrize(("columns", "width_px"), [(80, 48), (200, 135), (168, 136), (20, 10)])
def test_a_narrow_terminal_shrinks_track_and_zoom_together(
        columns: int, width_px: int, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    main(["10", "d", "--fast", "--frames", "40"])
    text = capsys.readouterr().out
    lines = [line for line in text.splitlines() if "FPS =" in line]
    assert {abs(line.index("x =") - width_px) <= 1 for line in lines} == {True}
    assert max(map(len, lines)) <= max(columns, 43)
    assert ("physics is untouched" in " ".join(text.split())) is (width_px < 135)
    scale = lines[0].index("x =") / 135
    walls = [i for i, c in enumerate(lines[0]) if c == "|"]
    assert walls == [round(0.25 * 55 * scale), round(2.2 * 55 * scale)]
    assert lines[13].endswith("x =   0.45, v =  2.49, FPS =  10")


def test_the_smallest_zoom_survives_the_narrowest_terminal(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("COLUMNS", "12")
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert main(["10", "d", "m_to_px=0.001", "--fast", "--frames", "1"]) == 0
    assert capsys.readouterr().err == ""


def test_in_a_pipe_the_width_is_the_scene_s(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    main(["10", "d", "--fast", "--frames", "1"])
    assert capsys.readouterr().out.splitlines()[-2].index("x =") == 135


def test_a_wall_outside_the_picture_is_told_with_the_zoom_that_would_show_it(
        capsys: Capture) -> None:
    def intro(*words: str) -> str:
        main(["99", *words, "--fast", "--frames", "1"])
        return " ".join(capsys.readouterr().out.split())

    for right_m, width_px in ((20, 135), (3, 40), (999.9, 10), (1000, 1000)):
        words = f"right_edge_m={right_m}", f"width_px={width_px}"
        told = intro(*words)
        found = re.search(r"ends before a wall: m_to_px=([0-9.]+) would show both", told)
        assert found
        told = intro(*words, f"m_to_px={found[1]}")
        assert "ends before" not in told
        assert "|" in told
    assert "to the left of x = 0" in intro("left_edge_m=-1")
    assert "wall" not in intro().replace("|", "")
