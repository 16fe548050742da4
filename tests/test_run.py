"""The main loop, on a clock that the test sets: pacing, stalls, observed dt, the ends of a run."""

import io
import re
from itertools import pairwise

import pytest

import examples
from airtrack import Scene, main, step
from clock import Capture, Clock, Keyboard, positions_m


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


@pytest.mark.parametrize("observed", [True, False])
def test_after_a_stall_the_car_holds_still_for_one_frame(
        observed: bool, clock: Clock, capsys: Capture) -> None:
    clock.when_drawn = lambda frame: 2.0 if frame == 10 else 0.0
    main(["99", "d", "v_mps=0.3", "fps_target=10", "--frames", "15", f"use_observed_dt={observed}"])
    xs = positions_m(capsys)
    moved_m = [round(b - a, 2) for a, b in pairwise(xs)]
    assert moved_m == [0.03] * 9 + [0.0] + [0.03] * 4


def test_what_a_stall_is(clock: Clock, capsys: Capture) -> None:
    # Longer than 0.15 s and than one and a half frames.
    for fps, late_s, stalls in ((30, 0.14, False), (30, 0.16, True), (2, 0.74, False),
                                (2, 0.76, True)):
        clock.frames_s = []
        clock.when_drawn = lambda frame, late_s=late_s: late_s * (frame == 5)  # type: ignore[misc]
        main(["99", "d", "v_mps=0.4", f"fps_target={fps}", "--frames", "8"])
        xs = positions_m(capsys)
        assert (xs[4] == xs[5]) is stalls


def test_observed_dt_is_the_length_of_the_frame_before(clock: Clock, capsys: Capture) -> None:
    clock.when_drawn = lambda frame: 0.12 if frame % 3 == 0 else 0.0
    main(["99", "d", "right_edge_m=100", "v_mps=10", "fps_target=10", "--frames", "12",
          "use_observed_dt=True"])
    xs, lengths_s = positions_m(capsys), clock.lengths_s()
    assert max(lengths_s) > 1.15 * min(lengths_s)
    for frame, length_s in enumerate(lengths_s, start=1):
        assert xs[frame] - xs[frame - 1] == pytest.approx(10 * length_s, abs=0.0101)


def test_the_details_show_the_observed_rate(clock: Clock, capsys: Capture) -> None:
    clock.when_drawn = lambda frame: 0.05 if frame == 3 else 0.0
    main(["99", "d", "fps_target=100", "--frames", "6"])
    rates = re.findall(r"FPS = +([0-9]+)", capsys.readouterr().out)
    assert rates[0] == "100"
    assert rates[3] == "20"


def test_fast_runs_at_the_nominal_dt_whatever_use_observed_dt_says(capsys: Capture) -> None:
    main(["9", "d", "--fast", "--frames", "50"])
    scene = Scene(**examples.EXAMPLES[9].settings)
    x_m, v_mps = scene.x_m, scene.v_mps
    for shown_m in positions_m(capsys):
        x_m, v_mps, _ = step(scene, x_m, v_mps, 0.1)
        assert shown_m == round(x_m, 2)


def ending(capsys: Capture) -> str:
    return capsys.readouterr().out.splitlines()[-1]


@pytest.mark.parametrize(("key", "why"), [
    ("x", "x was pressed"), ("X", "x was pressed"), ("\x1b", "Esc was pressed"),
    ("\x03", "Ctrl-C was pressed")])
def test_keys_that_quit(key: str, why: str, clock: Clock, monkeypatch: pytest.MonkeyPatch,
                        capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t4=key)
    assert main(["10"]) == 0
    assert len(clock.frames_s) in (10, 11)
    assert ending(capsys) == f"Stopped after {len(clock.frames_s)} frames: {why}."


class Output(io.StringIO):
    """A standard output that knows what has not been flushed yet."""

    waiting = ""

    def write(self, text: str) -> int:
        self.waiting += text
        return super().write(text)

    def flush(self) -> None:
        self.waiting = ""


def test_each_line_goes_out_at_once_and_does_not_wait_in_a_buffer(
        clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    output, sleep = Output(), clock.sleep

    def sleep_when_all_is_out(seconds: float) -> None:
        assert output.waiting == ""
        sleep(seconds)

    monkeypatch.setattr("examples.time.sleep", sleep_when_all_is_out)
    monkeypatch.setattr("sys.stdout", output)
    assert main(["10", "--frames", "5"]) == 0
    assert output.getvalue().count("*") >= 5


def test_x_is_answered_within_a_long_frame(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    Keyboard(clock, monkeypatch, t7="x")
    began_s = clock.now_s
    main(["99", "fps_target=0.1"])
    assert clock.now_s - began_s == pytest.approx(7, abs=0.1)


@pytest.mark.parametrize("key", ["p", "P", "\x13"])
def test_p_pauses_and_resumes_and_the_clock_stands_still_meanwhile(
        key: str, clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t4_05=key, t24=key, t25_05="x")
    main(["99", "d", "v_mps=0.4", "fps_target=10", "use_observed_dt=True"])
    assert max(clock.lengths_s()) == pytest.approx(20, abs=0.1)
    xs = positions_m(capsys)
    # No leap over the pause: the frame that it interrupts and the next one share 0.2 s.
    assert max(b - a for a, b in pairwise(xs)) <= 0.4 * 0.2
    assert len(xs) in range(20, 24)


def test_x_pressed_in_the_header_s_pause_counts(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t1="x")
    main(["10"])
    assert ending(capsys) == "Stopped after 0 frames: x was pressed."


def test_p_pressed_in_the_header_s_pause_counts(
        clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    Keyboard(clock, monkeypatch, t1="p", t60="p")
    began_s = clock.now_s
    main(["10", "--frames", "1"])
    assert clock.frames_s[0] - began_s == pytest.approx(60, abs=0.1)


def test_ctrl_c_cuts_the_header_s_pause_short_and_a_diamond_says_so(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t1="\x03")
    began_s = clock.now_s
    main(["10", "--frames", "1"])
    assert clock.frames_s[0] - began_s == pytest.approx(1, abs=0.1)
    assert "   *\n  * *\n *   *\n  * *\n   *\n" in capsys.readouterr().out


def test_keys_that_come_together_with_ctrl_c_count(
        clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    Keyboard(clock, monkeypatch, t1="\x03x")
    main(["10"])
    out = capsys.readouterr().out
    assert "   *\n  * *\n" in out
    assert out.splitlines()[-1] == "Stopped after 0 frames: x was pressed."


@pytest.mark.parametrize(("columns", "width_px"), [(80, 48), (200, 135), (168, 135), (20, 10)])
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
    walls = [i for i, c in enumerate(lines[0]) if c == "|"]
    scale = lines[0].index("x =") / 135
    assert walls == [round(0.25 * 55 * scale), round(2.2 * 55 * scale)]
    assert lines[13].endswith("x =   0.45, v =  2.49, FPS =  10")


def test_in_a_pipe_the_width_is_the_scene_s(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    main(["10", "d", "--fast", "--frames", "1"])
    assert capsys.readouterr().out.splitlines()[-2].index("x =") == 135
