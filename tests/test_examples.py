"""The examples: the lesson's checkpoints, and every figure that an example's text gives."""

import math
import re
from dataclasses import replace
from itertools import accumulate, islice, pairwise, product

import pytest

from airtrack import METHODS, Scene, planned, render_track, step, truth_of
from examples import EXAMPLES
from films import HERE, K, apart_m, beside_the_truth, details, film, hops_nearby

Capture = pytest.CaptureFixture[str]


def states(number: int, frames: int) -> list[tuple[float, float, float | None]]:
    """(x_m, v_mps, mark_m) after each frame of an example, as long as it should be."""
    scene = Scene(**EXAMPLES[number].settings)
    state: tuple[float, float, float | None] = (scene.x_m, scene.v_mps, None)
    found = []
    for length_s, fps in islice(planned(scene), frames):
        state = step(scene, *state[:2], length_s if scene.use_observed_dt else 1 / fps)
        found.append(state)
    return found


def turns_m(number: int, frames: int) -> list[float]:
    """The highest position of each flight of an example, from left to right and back."""
    xs = [EXAMPLES[number].settings["x_m"]] + [x_m for x_m, _, _ in states(number, frames)]
    return [b for (a, b), (_, c) in pairwise(pairwise(xs)) if a <= b > c]


# The lesson's film, frame for frame and column for column.

def test_the_one_pager_shows_details(capsys: Capture) -> None:
    for words in ((), ("0",)):
        shown = film(capsys, *words, "--frames", "600")
        assert shown.intro.startswith("Example 0: The one-pager")
        first = shown.lines[0]
        assert [i for i, c in enumerate(first[:126]) if c == "|"] == [4, 122]
        assert first.index("*") == 79
        assert first[126:] == "x =  11.25, v = 16.97, FPS =  67"
        assert details(shown.lines[599]) == (13.89, -4.51)


def test_example_10_at_frames_13_and_14(capsys: Capture) -> None:
    _, lines, _ = film(capsys, "10", "d", "--frames", "14")
    thirteen, fourteen = lines[12:14]
    assert (thirteen.index("*"), details(thirteen)[0]) == (17, 0.31)
    assert "0" not in thirteen[:135]
    assert (fourteen.index("0"), fourteen.index("*")) == (2, 25)
    assert details(fourteen) == (0.45, 2.49)


@pytest.mark.parametrize(("words", "frames", "t_s", "x_m"), [
    ("1", 251, 8.37, 0.25), ("4", 1880, 6.27, 0.25), ("6", 236, 7.87, 2.20),
    ("12", 130, 12.96, 0.25), ("12 correction=replay", 122, 12.19, 0.25),
    ("19", 134, 13.4, 0.25)])
def test_these_come_to_rest_in_the_frame_that_their_text_says(
        words: str, frames: int, t_s: float, x_m: float, capsys: Capture) -> None:
    says(int(words.split()[0]), str(frames))
    _, lines, ending = film(capsys, *words.split(), "d", "--frames", "9" * 20)
    assert len(lines) == frames
    assert details(lines[-1])[0] == x_m
    assert ending == (f"Stopped after {frames} frames, t = {t_s:.2f} s: "
                      "the car is at rest against a wall.")


def test_examples_py_imports_nothing_from_airtrack_py() -> None:
    assert not re.search(r"(?m)^ *(import|from) +airtrack", (HERE / "examples.py").read_text())


# What the texts say.

def says(number: int, *figures: str) -> None:
    """The figures that the test below checks are in the example's text, and not before the film."""
    example = EXAMPLES[number]
    for figure in figures:
        assert re.search(rf"(?<![\d.]){re.escape(figure)}(?!\.?\d)", example.seen), figure
        assert figure not in example.look_for


def test_0_bounces_26_times_and_then_lies_at_the_left_wall() -> None:
    says(0, "20 %", "26 bounces", "frame 2930", "t = 44 s")
    frames = [n for n, (_, _, mark_m) in enumerate(states(0, 4000), 1) if mark_m is not None]
    assert frames[:26][-1] == 2930 == round(44 / 0.015, -1)
    assert frames[24] < 2929
    assert frames[25:] == list(range(2930, 4001))


def test_1_comes_back_about_half_as_far_each_time() -> None:
    assert EXAMPLES[1].settings["x_m"] - Scene().left_edge_m == 1.75
    says(1, "1.75 m", "70 %", "0.7^2 = 0.49", "0.87 m", "0.46 m", "0.21 m")
    assert [round(turn - 0.25, 2) for turn in turns_m(1, 240)[:3]] == [0.87, 0.46, 0.21]


def test_2_is_drawn_up_to_8_cm_beyond_the_walls_and_never_stops(capsys: Capture) -> None:
    says(2, "8 cm", "9 cm")
    assert pytest.approx(0.09) == 2.7 / 30
    _, lines, ending = film(capsys, "2")
    columns = [line.index("*") for line in lines]
    assert max(14 - min(columns), max(columns) - 121) / 55 == pytest.approx(0.08, abs=1 / 55)
    assert max(abs(x_m - 1.225) for x_m, _, _ in states(2, 1000)) - 0.975 == pytest.approx(0.08)
    assert ending == "Stopped after 50000 frames, t = 1666.67 s: that is the frame limit."
    assert {abs(v_mps) for _, v_mps, _ in states(2, 1000)} == {2.7}


def test_3_is_caught_in_frame_46_and_sinks_a_millimetre_a_frame(capsys: Capture) -> None:
    says(3, "frame 46", "t = 1.53 s", "60 %", "1 mm", "nine or ten seconds")
    assert round(46 / 30, 2) == 1.53
    xs = [x_m for x_m, _, _ in states(3, 600)]
    assert [x_m < 0.25 for x_m in xs].index(True) + 1 == 46
    assert all(x_m < 0.25 for x_m in xs[45:])
    assert min(b - a for a, b in pairwise(xs[45:52])) < 0 < max(
        b - a for a, b in pairwise(xs[45:52]))  # swings, in and out
    assert (xs[99] - xs[599]) / 500 == pytest.approx(1e-3, rel=0.1)
    assert round(xs[599], 2) == -0.35
    for narrower, frames in (("width_px=135", 272), ("width_px=80 m_to_px=32.425", 278),
                             ("width_px=43 m_to_px=17.239", 291)):
        _, lines, _ = film(capsys, "3", *narrower.split(), "--frames", "300")
        assert [line.strip()[0] for line in lines[250:]] == ["*"] * (frames - 250) + ["<"] * (
            300 - frames)
        assert 9 < frames / 30 < 10


def test_4_draws_arcs_of_hundreds_of_lines_of_which_the_right_wall_cuts_off_the_first() -> None:
    says(4, "hundreds of lines")
    bounces = [n for n, (_, _, mark_m) in enumerate(states(4, 1880)) if mark_m is not None]
    walls = [states(4, n + 1)[n][0] > 1 for n in bounces[2:5]]
    assert walls == [True, False, False]
    assert min(b - a for a, b in pairwise(bounces[3:7])) > 100
    assert max(b - a for a, b in pairwise(bounces[-9:])) < 10  # the tail


def test_5_shows_a_0_where_its_text_says(capsys: Capture) -> None:
    vs = [details(line)[1] for line in film(capsys, "5", "d").lines]
    assert sum(abs(b - a - 0.07) > 0.011 for a, b in pairwise([3.0, *vs])) == 19
    says(5, "70 %", "19 collisions", "fps_target=10", "the first five", "to end with x")
    assert film(capsys, "5", "fps_target=10", "--frames=9999").ending.endswith("frame limit.")
    for fps, columns in product((30, 10), (135, 120, 100, 80, 43)):
        scene = Scene(**EXAMPLES[5].settings | {"fps_target": fps})
        view = replace(scene, width_px=columns, m_to_px=scene.m_to_px * (columns - 1) / 134)
        x_m, v_mps, bounces, zeros = scene.x_m, scene.v_mps, [], []
        for frame in range(1, 237):
            x_m, v_mps, mark_m = step(scene, x_m, v_mps, 1 / fps)
            if mark_m is not None:
                bounces.append(frame)
                assert 2.2 - x_m == pytest.approx(0.7 * (mark_m - 2.2))
            zeros += [frame] if "0" in render_track(view, x_m, mark_m) else []
        assert zeros[:5] == bounces[:5] if fps == 10 else len(bounces) == 19 >= len(zeros) + 5
        assert (fps, columns) != (30, 43) or len(zeros) == 1  # as with d at 80 columns


def test_6_is_5_drawn_smaller(capsys: Capture) -> None:
    says(6, "30/55")
    five, six = film(capsys, "5", "d"), film(capsys, "6", "d")
    assert [line[135:] for line in five.lines] == [line[135:] for line in six.lines]
    walls = [[i for i, c in enumerate(shown.lines[9]) if c == "|"] for shown in (five, six)]
    assert [right - left for left, right in walls] == [107, 58]


def test_7_turns_at_its_start_mark_and_a_centimetre_short_of_it_alternately() -> None:
    says(7, "1.1 cm", "frame 633", "t = 2.64 s")
    turns = [round(turn, 3) for turn in turns_m(7, 60 * 240)]
    assert turns[:20] == [1.989, 2.0] * 10
    xs = [x_m for x_m, _, _ in states(7, 700)]
    assert xs.index(max(xs[400:])) + 1 == 633
    assert round(633 / 240, 2) == 2.64
    assert (2.0 - turns[0]) * Scene(**EXAMPLES[7].settings).m_to_px < 1  # less than a column


def test_8_turns_12_cm_short_of_its_start_mark_every_other_time() -> None:
    says(8, "1.88 m", "12 cm", "1 cm", "26 cm", "2 * 7 = 14 cm, 12 too", "2 * 19 = 38 cm, 12 too")
    turns = turns_m(8, 600)
    assert len(turns) > 20
    assert {round(turn, 2) for turn in turns[::2]} == {1.88}
    assert {round(turn, 2) for turn in turns[1::2]} == {2.0}
    found = states(8, 600)
    assert max(abs(v_mps) * 0.1 for _, v_mps, _ in found) == pytest.approx(0.26)
    for fall, given_m in ((0, 0.14), (26, 0.38), (52, 0.14)):
        x_m, _, mark_m = found[fall + 12]  # 13 frames of fall, 13 of rise
        assert mark_m is not None
        assert 2 * (0.25 - mark_m) == pytest.approx(given_m) == x_m - mark_m
        heights_m = [x + v**2 / 4 for x, v, _ in found[fall + 12:fall + 26]]  # E/2
        assert [a - b for a, b in pairwise(heights_m)] == pytest.approx([0.01] * 13)


def test_9_turns_elsewhere_each_time_and_later_beyond_the_start_mark() -> None:
    says(9, "1.81 m")
    turns = [round(turn, 2) for turn in turns_m(9, 500)]
    assert turns[:6] == [1.81, 1.68, 1.59, 1.51, 1.52, 1.79]
    assert max(turns[:11]) < 2.0
    assert turns[11] == 2.13
    assert [x_m > 2.05 for x_m, _, _ in states(9, 300)].index(True) == pytest.approx(290, abs=5)


@pytest.mark.parametrize("number", [10, 11])
def test_10_and_11_are_drawn_on_their_start_mark_at_every_turn(number: int) -> None:
    assert "press it fourteen times" in EXAMPLES[10].look_for
    assert [mark_m is not None for _, _, mark_m in states(10, 14)] == [False] * 13 + [True]
    turns = turns_m(number, 6000)
    assert len(turns) > 200
    assert {round(turn * 55) for turn in turns} == {110}


def test_12_rests_from_its_Zeno_point_on() -> None:
    says(12, "t = 11.91 s", "4 mm", "quarter")
    fall_s = math.sqrt(2 * 1.75 / 2)
    assert fall_s + 2 * fall_s * 0.8 / (1 - 0.8) == pytest.approx(11.91, abs=0.005)
    scene = Scene(**EXAMPLES[12].settings)
    truth = truth_of(scene)
    assert step(truth, 2.0, 0.0, 11.90)[1] != 0
    assert step(truth, 2.0, 0.0, 11.92)[:2] == (0.25, 0.0)
    moments_s = accumulate(length_s for length_s, _ in planned(scene))
    off_m = max(abs(x_m - step(truth, 2.0, 0.0, t_s)[0])
                for (x_m, _, _), t_s in zip(states(12, 130), moments_s, strict=False))
    assert 0.0035 < off_m < 0.0045 < 1 / 55 / 4


@pytest.mark.parametrize("shift", [-1e-3, 0, 1e-3])
def test_13_turns_higher_than_the_truth_before_any_collision(shift: float) -> None:
    says(13, "frame 13", "1.91 m", "1.79 m", "1 cm", "0.02 m^2/s^2", "v^2/2 + 2 x", "frame 25")
    assert pytest.approx(0.02) == 2.0**2 * 0.1**2 / 2
    xs, truth, marks = zip(*beside_the_truth(13, 26, shift), strict=True)
    assert (max(xs), max(truth[:20])) == pytest.approx((1.91, 1.79), abs=0.01)
    assert (xs.index(max(xs)) + 1, set(marks[:25])) == (13, {None})
    ahead = [x_m - true_m for x_m, true_m in zip(xs[:24], truth[:24], strict=True)]
    assert [b - a for a, b in pairwise([0, *ahead])] == pytest.approx([0.01] * 24)
    control = beside_the_truth(13, 25, shift, motion="exact")
    assert apart_m(control[:24]) < 1e-12
    assert [mark_m is not None for _, _, mark_m in control] == [False] * 24 + [True]


@pytest.mark.parametrize("shift", [-1e-3, 0, 1e-3])
def test_17_is_exact_until_its_first_bounce_and_gains_energy_at_the_left_wall(
        shift: float) -> None:
    says(17, "frame 14", "1.8 m", "10 cm")
    found = beside_the_truth(17, 200, shift)
    assert apart_m(found[:13]) < 1e-12 < apart_m(found[:14])
    assert apart_m(found) == pytest.approx(1.8, abs=0.05)
    for x_m, _, mark_m in found:  # at an unchanged speed, so E = v^2/2 + 2 x is lifted by 2 x
        if mark_m is not None:
            gained = 2 * (x_m - mark_m)
            assert gained > 0 if mark_m < 0.25 else gained <= 0
    sixteen = beside_the_truth(16, 200, shift)
    assert [apart_m([frame]) for frame in sixteen[:2]] == pytest.approx([0.01, 0.02])
    assert apart_m(sixteen) == pytest.approx(0.9, abs=0.05)
    says(16, "1 cm", "frame 1", "2 cm", "frame 2", "0.9 m")
    assert apart_m(beside_the_truth(17, 200, shift, correction="rewind")) < 1e-9
    cured = beside_the_truth(17, 200, shift, correction="conserve")
    assert 0.04 < apart_m(cured) < 0.10
    columns = [round(55 * x_m) for x_m, _, _ in cured]
    assert max(columns) == 110  # that of the start mark
    assert sum(a < 110 == b for a, b in pairwise(columns)) == 7


@pytest.mark.parametrize("shift", [-1e-3, 0, 1e-3])
def test_18_misses_a_bounce_in_frame_3(shift: float) -> None:
    says(18, "frame 3", "frame 4", "0.4 m", "1 cm")
    found = beside_the_truth(18, 5, shift)
    assert [mark_m for _, _, mark_m in found] == [None] * 5
    assert apart_m(found[:2]) < 1e-12
    assert found[2][0] - found[2][1] > 0.1  # the o is on its way back
    assert found[3][0] - found[3][1] == pytest.approx(0.4, abs=0.08)
    turn_m = 0.65 + (5 * (1 + shift)) ** 2 / 16
    assert turn_m - 2.2 == pytest.approx(0.01, abs=0.006)
    assert apart_m(beside_the_truth(18, 80, shift, correction="replay")) < 1e-9


def test_19_is_counted_as_its_question_says(capsys: Capture) -> None:
    says(19, "15, 14, 13 ...", "2 and 1", "frame 134", "One line shorter", "18, 19, 20 ...",
         "half a minute", "2 and 1", "-1 + 1/2 = -1/2")
    assert hops_nearby(19, 11, motion="exact") == [[*range(18, 29)]] * 9
    longer = beside_the_truth(19, 300, 0, motion="exact")
    meets, *_ = [n for n, (_, _, mark_m) in enumerate(longer) if mark_m and mark_m > 2.2]
    assert meets / 10 == pytest.approx(30, abs=3)
    for name in K:
        assert f"{K[name]:g} for {name}".replace("0.5", "1/2") in EXAMPLES[19].seen
    assert "v falls by 0.20 a line" in EXAMPLES[19].look_for
    vs = [details(line)[1] for line in film(capsys, "19", "d").lines]
    found = [line for line, (a, b) in enumerate(pairwise(vs)) if abs(b - a + 0.20) > 0.011]
    assert [b - a for a, b in pairwise(found)][:15] == [*range(15, 0, -1)]


def test_20_hops_9_lines_or_about_as_many_and_the_truth_lies_still(capsys: Capture) -> None:
    says(20, "14, 12, 10", "frame 48", "9 for ever", "0.8 (9 + 1) + 1 = 9", "7.05 s", "30 or 60",
         "7 s")
    bounces = [n for n, (_, _, mark_m) in enumerate(states(20, 57), 1) if mark_m is not None]
    assert bounces == [12, 26, 38, 48, 57]
    assert hops_nearby(20, 23) == [[14, 12, 10] + [9] * 20] * 9
    for fps in (30, 60):  # as many lines, of shorter frames: so lower
        for lines in hops_nearby(20, 200, fps_target=fps):
            assert 7 <= min(lines[-20:]) <= max(lines[-20:]) <= 13
        assert "limit" in film(capsys, "20", f"fps_target={fps}", "--frames", "2000").ending
    truth = truth_of(Scene(**EXAMPLES[20].settings))
    assert step(truth, truth.x_m, truth.v_mps, 7.05)[:2] != (0.25, 0.0)
    assert step(truth, truth.x_m, truth.v_mps, 7.06)[:2] == (0.25, 0.0)
    for fps in (10, 30, 60, 120, 240):
        ending = film(capsys, "20", "correction=conserve", f"fps_target={fps}").ending
        assert re.search(r"t = (6\.[89]|7\.[012])\d s: the car is at rest", ending)


@pytest.mark.parametrize("shift", [-1e-3, 0, 1e-3])
def test_21_shows_what_the_chart_measures(shift: float, capsys: Capture) -> None:
    says(21, "1 cm in frame 1", "0.9 m", "frame 14", "1.8 m", "10 cm")
    for letter, left, off_m in (("a", 1, 0.9), ("b", 14, 1.8), ("c", 14, 0.06)):
        motion, correction = METHODS[letter]
        found = beside_the_truth(21, 200, shift, motion=motion, correction=correction)
        assert apart_m(found) == pytest.approx(off_m, abs=0.05 if letter in "ab" else 0.03)
        assert [apart_m([frame]) < 1e-9 for frame in found].index(False) + 1 == left
    for picture in ("width_px=135", "width_px=80 m_to_px=32.425"):
        words = ["21", *picture.split(), f"x_m={2 * (1 + shift)}", "--frames", "200"]
        assert set("".join(film(capsys, *words).lines)) == set(" |*.0abc")


@pytest.mark.parametrize("shift", [-1e-3, 0, 1e-3])
def test_22_hops_5_lines_for_ever_and_rests_if_contacts_are_settled_last(
        shift: float, capsys: Capture) -> None:
    says(22, "frame 104", "5 lines", "6.5 mm", "k is 1 + 1/2", "= 4.5 lines", "k is -1/2",
         "frame 86", "1.35 s", "1 mm")
    assert [K["forward"], K["backward"], K["surface"]] == [1, -1, 1 / 2]
    assert pytest.approx(4.5) == 1.5 * (1 + 0.5) / (1 - 0.5)
    found = beside_the_truth(22, 2000, shift)
    bounces = [n for n, (_, _, mark_m) in enumerate(found, 1) if mark_m is not None]
    assert bounces[5:8] == [99, 104, 109]
    assert {b - a for a, b in pairwise(bounces[5:])} == {5}
    assert bounces[5] - bounces[4] > 5
    for first, close_m in ((104, 2e-4), (1900, 5e-5)):
        assert max(x_m for x_m, *_ in found[first:]) == pytest.approx(0.0065, abs=close_m)
    assert [true_m > 0 for _, true_m, _ in found[79:82]] == [True, False, False]  # 81/60 s
    start = f"x_m={1 + shift}"
    ending = film(capsys, "22", start, "motion=backward").ending
    assert ending == "Stopped after 86 frames, t = 1.43 s: the car is at rest against a wall."
    assert film(capsys, "22", start, "--frames=900").ending.endswith("that is the frame limit.")
    for picture in ("width_px=135", "width_px=80 m_to_px=589.55"):  # the last hops are seen
        lines = film(capsys, "22", start, *picture.split(), "--frames=200").lines
        assert len({line.index("*") for line in lines[99:]}) >= 4
        assert lines[0].endswith(">")


def test_14_is_thrown_out_to_the_left_and_to_the_right_alternately(capsys: Capture) -> None:
    says(14, "4.1 m", "1.2 km")
    xs = [x_m for x_m, _, _ in states(14, 600)]
    assert all(x_m < 0.25 or x_m > 2.2 for x_m in xs)
    assert {round(abs(b) - abs(a), 6) for a, b in zip(xs, xs[2:], strict=False)} == {4.1}
    assert xs[-1] == pytest.approx(1200, rel=0.05)
    shown = ["".join(line.split()) for line in film(capsys, "14", "--frames", "600").lines]
    assert shown == ["<||", "||>"] * 300


def test_15_creeps_a_tenth_of_a_metre_a_frame(capsys: Capture) -> None:
    says(15, "3.9 m", "0.1 m")
    xs = [1.65] + [x_m for x_m, _, _ in states(15, 600)]
    assert all(0.25 <= x_m <= 2.2 for x_m in xs)
    assert sum(abs(b - a) == pytest.approx(0.1) for a, b in pairwise(xs)) > 550
    assert film(capsys, "15", "--frames", "600").ending.endswith("that is the frame limit.")
