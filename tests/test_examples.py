"""The examples: every figure that a text gives is worked out and written into its sentence."""

import math
import re
from itertools import accumulate, pairwise

import pytest

from airtrack import METHODS, Scene, planned_length, step, truth_of
from examples import EXAMPLES
from films import (
    apart_m,
    beside_the_truth,
    collisions,
    details,
    film,
    hops_nearby,
    states,
    states_of,
)

Capture = pytest.CaptureFixture[str]


def says(number: int, sentence: str, *values: float) -> None:
    """The text of an example has this sentence, with these values in its braces."""
    example = EXAMPLES[number]
    assert sentence.format(*values) in f"{example.look_for} {example.seen}"


def turns_m(number: int, frames: int, **changes: object) -> list[float]:
    """The highest position of each flight of an example, from left to right and back."""
    xs = [EXAMPLES[number].settings["x_m"], *(x_m for x_m, *_ in states(number, frames, **changes))]
    return [b for (a, b), (_, c) in pairwise(pairwise(xs)) if a <= b > c]


def frames_to_rest(capsys: Capture, words: str) -> int:
    ending = film(capsys, *words.split()).ending
    frames, why = re.findall(r"after (\d+) frames, t = .* s: (.*)\.", ending)[0]
    assert why == "the car is at rest at a wall"
    return int(frames)


def test_the_frames_in_which_films_stop(capsys: Capture) -> None:
    says(1, "for a third of a second, in frame {}", frames_to_rest(capsys, "1"))
    says(4, "The film stops after {} frames.", frames_to_rest(capsys, "4"))
    says(6, "The film stops after {} frames, as example 5 does.", frames_to_rest(capsys, "6"))
    assert frames_to_rest(capsys, "5") == frames_to_rest(capsys, "6")
    says(12, "in about frame {}. Replay", frames_to_rest(capsys, "12"))
    says(12, "in about frame {}. Still", frames_to_rest(capsys, "12 correction=replay"))
    says(19, "In frame {} the film calls the * at rest", frames_to_rest(capsys, "19"))
    says(22, "the film stops in frame {}.", frames_to_rest(capsys, "22 motion=backward"))
    for words in ("2", "8", "14", "15", "20", "22"):
        assert film(capsys, *words.split(), "--frames", "2000").ending.endswith("frame limit.")


def test_0() -> None:
    found = collisions(states(0, 4000))
    says(0, "in frame {} (t = {:.0f} s), after {} bounces", found[25], found[25] * 0.015, 26)
    assert found[25:] == list(range(found[25], 4001))
    assert found[24] < found[25] - 1


def test_1() -> None:
    rises_m = [turn - 0.25 for turn in turns_m(1, 240)]
    says(1, "gets back to {:.2f} m, {:.2f} m and {:.2f} m", *rises_m)
    says(1, "starts {} m from the left wall", EXAMPLES[1].settings["x_m"] - 0.25)
    says(1, "keeps {:.0f} % of its speed, so {}^2 = {:.2f}", 70, 0.7, 0.7**2)


def test_2() -> None:
    deepest_m = max(abs(x_m - 1.225) for x_m, *_ in states(2, 1000)) - 0.975
    says(2, "up to {:.0f} cm into the walls", 100 * deepest_m)
    says(2, "A frame moves it by {:.0f} cm", 100 * 2.7 / 30)
    assert {abs(v_mps) for _, v_mps, _ in states(2, 1000)} == {2.7}


def test_3(capsys: Capture) -> None:
    xs = [x_m for x_m, *_ in states(3, 600)]
    first = [x_m < 0.25 for x_m in xs].index(True) + 1
    says(3, "In frame {} (t = {:.2f} s)", first, first / 30)
    assert max(xs[first - 1:]) < 0.25
    says(3, "in the end by {:.0f} mm a frame", 1000 * (xs[499] - xs[599]) / 100)
    for narrower in ("width_px=135", "width_px=80 m_to_px=32.425", "width_px=43 m_to_px=17.239"):
        lines = film(capsys, "3", *narrower.split(), "--frames", "300").lines
        assert 9 * 30 < [line[0] for line in lines].index("<") < 10 * 30
    assert "After nine or ten seconds it is out of the picture" in EXAMPLES[3].seen


def test_4() -> None:
    found = collisions(states(4, 1880))
    hops = [after - before for before, after in pairwise(found)]
    assert min(hops[3:6]) > 100
    assert max(hops[-9:]) < 10  # the tail
    walls = [states(4, frame)[-1][0] > 1 for frame in found[2:5]]
    assert walls == [True, False, False]  # the right wall cuts the first arc off


def test_5_and_6(capsys: Capture) -> None:
    says(5, "Many of the {} collisions show no 0", len(collisions(states(5, 236))))
    lines = film(capsys, "5").lines
    assert sum("0" in line for line in lines) < 15
    for columns in (135, 80, 43):
        zoom = 55 * (columns - 1) / 134
        lines = film(capsys, "5", "fps_target=10", f"width_px={columns}", f"m_to_px={zoom}",
                     "--frames", "200").lines
        zeros = [number for number, line in enumerate(lines, 1) if "0" in line]
        assert zeros[:5] == collisions(states(5, 200, fps_target=10))[:5]
    assert film(capsys, "5", "fps_target=10", "--frames=999").ending.endswith("frame limit.")
    assert [line[135:] for line in film(capsys, "5", "d").lines] == [
        line[135:] for line in film(capsys, "6", "d").lines]
    assert EXAMPLES[6].settings["m_to_px"] == 30
    for x_m, _, mark_m in states(5, 236):
        assert mark_m is None or 2.2 - x_m == pytest.approx(0.7 * (mark_m - 2.2))


def test_7_and_8() -> None:
    xs = [x_m for x_m, *_ in states(7, 700)]
    first = xs.index(max(xs[400:])) + 1
    says(7, "It turns {:.1f} cm short of the mark, first in frame {} (t = {:.2f} s)",
         100 * (2 - xs[first - 1]), first, first / 240)
    assert [round(turn_m, 3) for turn_m in turns_m(7, 60 * 240)][:20] == [1.989, 2.0] * 10
    turns = turns_m(8, 600)
    assert {round(turn_m, 2) for turn_m in turns[1::2]} == {2.0}
    says(8, "Only to {:.2f} m, {:.0f} cm short", turns[0], 100 * (2 - turns[0]))
    assert {round(turn_m, 2) for turn_m in turns[::2]} == {round(turns[0], 2)}
    found = states(8, 60)
    for fall, deep, text in ((0, 7, "First it was {:.0f} cm below: 2 * 7 = 14 cm, 12 too few."),
                             (26, 19, "Then it was {:.0f} cm below: 2 * 19 = 38 cm, 12 too many.")):
        x_m, _, mark_m = found[fall + 12]
        assert mark_m is not None
        assert x_m - mark_m == pytest.approx(2 * deep / 100)
        says(8, text, 100 * (0.25 - mark_m))
        heights_m = [x + v**2 / 4 for x, v, _ in found[fall + 12:fall + 26]]  # E/2
        assert [a - b for a, b in pairwise(heights_m)] == pytest.approx([0.01] * 13)
    says(8, "takes away {} cm of height, so {} cm in a fall and the rise", 1, 26)
    assert 2 * (7 - 13) == 14 - 26 == -(38 - 26)


def test_9() -> None:
    turns = turns_m(9, 500)
    says(9, "First it turns at about {:.2f} m", turns[0])
    later = [x_m > 2.05 for x_m, *_ in states(9, 400)].index(True)
    assert later / 10 == pytest.approx(30, abs=3)
    assert len({round(turn_m, 2) for turn_m in turns[:8]}) > 5


@pytest.mark.parametrize("number", [10, 11])
def test_10_and_11(number: int) -> None:
    assert "press it fourteen times" in EXAMPLES[10].look_for
    assert collisions(states(10, 30))[0] == 14
    assert "The 0 in frame 14" in EXAMPLES[10].seen
    turns = turns_m(number, 6000)
    assert len(turns) > 200
    assert {round(turn * 55) for turn in turns} == {110}


def test_12() -> None:
    fall_s = math.sqrt(2 * 1.75 / 2)
    says(12, "before t = {:.2f} s, the Zeno point", fall_s + 2 * fall_s * 0.8 / (1 - 0.8))
    scene = Scene(**EXAMPLES[12].settings)
    truth = truth_of(scene)
    assert step(truth, 2.0, 0.0, 11.90)[1] != 0
    assert step(truth, 2.0, 0.0, 11.92)[:2] == (0.25, 0.0)
    moments_s = accumulate(planned_length(scene, frame) for frame in range(1, 131))
    off_m = [abs(x_m - step(truth, 2.0, 0.0, t_s)[0])
             for (x_m, *_), t_s in zip(states(12, 130), moments_s, strict=True)]
    says(12, "it is at most about {:.1f} mm off, less than a quarter of a column",
         1000 * max(off_m))
    assert off_m.index(max(off_m)) + 1 == 119
    assert max(off_m) < 1 / 55 / 4


@pytest.mark.parametrize("shift", [0.999, 1, 1.001])
def test_13(shift: float) -> None:
    found = beside_the_truth(13, 26, v_mps=2.48 * shift)
    xs, truth, marks = zip(*found, strict=True)
    ahead_m = [x_m - true_m for x_m, true_m in zip(xs[:24], truth[:24], strict=True)]
    assert [b - a for a, b in pairwise([0, *ahead_m])] == pytest.approx([0.01] * 24)
    assert set(marks[:25]) == {None}
    says(13, "in frame {}, and", xs.index(max(xs)) + 1)
    assert (max(xs), max(truth[:20])) == pytest.approx((1.91, 1.79), abs=0.01)
    says(13, "turned at {} m, in frame 13, and the o at {} m", 1.91, 1.79)
    says(13, "each frame adds {:.2f} m^2/s^2", 2.0**2 * 0.1**2 / 2)
    control = beside_the_truth(13, 25, v_mps=2.48 * shift, motion="exact")
    assert apart_m(control[:24]) < 1e-12
    found_at = [mark_m is not None for *_, mark_m in control].index(True) + 1
    says(13, "meets the wall, in frame {}", found_at)


def test_14_and_15(capsys: Capture) -> None:
    xs = [x_m for x_m, *_ in states(14, 600)]
    assert all(x_m < 0.25 or x_m > 2.2 for x_m in xs)
    says(14, "{:.1f} m further out every other frame", abs(xs[2]) - abs(xs[0]))
    assert {round(abs(b) - abs(a), 6) for a, b in zip(xs, xs[2:], strict=False)} == {4.1}
    says(14, "In a minute it is {:.1f} km away", xs[-1] / 1000)
    says(14, "{:.0f} m in a frame, but the track is only {:.2f} m long", 40 / 10, 2.2 - 0.25)
    shown = ["".join(line.split()) for line in film(capsys, "14", "--frames", "600").lines]
    assert shown == ["<||", "||>"] * 300
    xs = [1.65] + [x_m for x_m, *_ in states(15, 600)]
    assert sum(abs(b - a) == pytest.approx(0.1) for a, b in pairwise(xs)) > 550
    says(15, "{:.1f} m, and ends {:.1f} m from where it was", 2 * (2.2 - 0.25), abs(xs[1] - xs[0]))


@pytest.mark.parametrize("shift", [0.999, 1, 1.001])
def test_16_17_and_21(shift: float, capsys: Capture) -> None:
    sixteen = beside_the_truth(16, 200, x_m=2 * shift)
    says(16, "they are {:.0f} cm apart in frame 1, {:.0f} cm in frame 2, and up to {:.1f} m within",
         100 * apart_m(sixteen[:1]), 100 * apart_m(sixteen[1:2]), apart_m(sixteen))
    found = beside_the_truth(17, 200, x_m=2 * shift)
    assert apart_m(found[:13]) < 1e-12 < apart_m(found[:14])
    says(17, "until the first bounce, in frame {}. After that it is wrong, by up to {:.1f} m", 14,
         apart_m(found))
    for x_m, _, mark_m in found:  # at an unchanged speed, so E = v^2/2 + 2 x is lifted by 2 x
        if mark_m is not None:
            gained = 2 * (x_m - mark_m)
            assert gained > 0 if mark_m < 0.25 else gained <= 0
    assert apart_m(beside_the_truth(17, 200, x_m=2 * shift, correction="rewind")) < 1e-9
    cured = beside_the_truth(17, 200, x_m=2 * shift, correction="conserve")
    assert 0.03 < apart_m(cured) < 0.10
    if shift == 1:
        says(17, "stays within {:.0f} cm of the o for 20 s", 100 * apart_m(cured))
        says(21, "So c stays within {:.0f} cm", 100 * apart_m(cured))
        columns = [round(55 * x_m) for x_m, *_ in cured]
        assert max(columns) == 110  # that of the start mark
        assert sum(a < 110 == b for a, b in pairwise(columns)) == 7
    says(21, "by {:.0f} cm in frame 1. Within 20 s it gets up to {:.1f} m away",
         100 * apart_m(sixteen[:1]), apart_m(sixteen))
    says(21, "So b gets furthest away, up to {:.1f} m within 20 s", apart_m(found))
    for letter, first in (("a", 1), ("b", 14), ("c", 14)):
        motion, correction = METHODS[letter]
        each = beside_the_truth(21, 200, x_m=2 * shift, motion=motion, correction=correction)
        assert [apart_m([frame]) < 1e-9 for frame in each].index(False) + 1 == first
    for picture in ("width_px=135", "width_px=80 m_to_px=32.425"):
        words = ["21", *picture.split(), f"x_m={2 * shift}", "--frames", "200"]
        marks = set("".join(film(capsys, *words).lines))
        assert marks == set(" |*.0abc")  # d and e are never seen


@pytest.mark.parametrize("shift", [0.999, 1, 1.001])
def test_18(shift: float) -> None:
    found = beside_the_truth(18, 5, v_mps=5 * shift)
    assert collisions([(x_m, 0, mark_m) for x_m, _, mark_m in found]) == []
    assert apart_m(found[:2]) < 1e-12
    assert found[2][0] - found[2][1] > 0.1  # the o is on its way back
    says(18, "in frame 4 they are about {} m apart", 0.4)
    assert found[3][0] - found[3][1] == pytest.approx(0.4, abs=0.08)
    beyond_m = 0.65 + (5 * shift) ** 2 / 16 - 2.2
    assert 0.004 < beyond_m < 0.022
    says(18, "the move goes {} cm beyond the wall", 1)
    assert apart_m(beside_the_truth(18, 80, v_mps=5 * shift, correction="replay")) < 1e-9


def test_19(capsys: Capture) -> None:
    vs = [details(line)[1] for line in film(capsys, "19", "d").lines]
    jumps = [line for line, (a, b) in enumerate(pairwise(vs)) if b - a > -0.19]
    assert [b - a for a, b in pairwise(jumps)][:15] == [*range(15, 0, -1)]
    assert "the hops take 15, 14, 13 ... lines, down to 2 and 1" in EXAMPLES[19].seen
    says(19, "falls by {:.2f} m/s", 2 * 0.1)
    assert hops_nearby(19, 11, motion="exact") == [[*range(18, 29)]] * 9
    assert "18, 19, 20 ... lines for half a minute" in EXAMPLES[19].seen
    longer = states(19, 300, motion="exact")
    meets = next(frame for frame, (*_, mark_m) in enumerate(longer, 1) if mark_m and mark_m > 2.2)
    assert meets / 10 == pytest.approx(30, abs=3)
    says(19, "(1 for forward, 0 for exact, -1 for backward) and the correction's (1/2 for surface, "
         "1 for rebound, 0 for conserve, 0 for none). Here k is -1 + 1/2 = -1/2")  # see test_law.py


def test_20(capsys: Capture) -> None:
    found = collisions(states(20, 200))
    hops = [after - before for before, after in pairwise(found)]
    assert hops == [14, 12, 10] + [9] * (len(hops) - 3)
    says(20, "take 14, 12, 10 lines and, from frame {} on, 9 for ever", found[3])
    says(20, "0.8 (9 + 1) + 1 = {:.0f}", 0.8 * (9 + 1) + 1)
    truth = truth_of(Scene(**EXAMPLES[20].settings))
    rest_s = next(n / 100 for n in range(1000) if step(truth, 0.66, 0.75, n / 100)[0] == 0.25)
    assert rest_s == pytest.approx(7.05, abs=0.011)
    says(20, "at t = {} s, its Zeno point", 7.05)
    for fps in (30, 60):  # as many lines, of shorter frames: so lower
        for lines in hops_nearby(20, 200, fps_target=fps):
            assert 7 <= min(lines[-20:]) <= max(lines[-20:]) <= 13
    for fps in (10, 30, 60, 120, 240):
        frames = frames_to_rest(capsys, f"20 correction=conserve fps_target={fps}")
        assert frames / fps == pytest.approx(7, abs=0.25)


def test_22(capsys: Capture) -> None:
    found = states(22, 4000)
    lines = collisions(found)
    hops = [after - before for before, after in pairwise(lines)]
    first = len(hops) - hops[::-1].index(next(hop for hop in hops[::-1] if hop != 16))
    says(22, "From frame {} on the * hops for ever, in hops of {} lines that are {:.0f} mm high",
         lines[first], hops[-1], 1000 * max(x_m for x_m, *_ in found[3000:]))
    for shift in (0.999, 1.001):
        assert set(hops_nearby(22, 200, x_m=shift)[4][-50:]) == {16}
    says(22, "near k (1 + CR)/(1 - CR) = {:.1f} lines", 1.5 * (1 + 0.8) / (1 - 0.8))
    truth = truth_of(Scene(**EXAMPLES[22].settings))
    assert step(truth, 1.0, 0.0, 4.025)[:2] == (0.0, 0.0)
    assert step(truth, 1.0, 0.0, 4.020)[:2] != (0.0, 0.0)
    says(22, "from t = {:.2f} s on it lies still", math.sqrt(0.2) * (1 + 0.8) / (1 - 0.8))
    line = film(capsys, "22", "--frames", "500").lines
    assert max(each.index("*") for each in line[330:]) == pytest.approx(40, abs=1)  # 80 mm
    assert (line[0][-1], line[400][0]) in ((">", "o"), (">", "*"))
    says(22, "higher than {:.0f} cm, out of the picture", 100 * 135 / 500)


def same_but(number: int, other: int) -> set[str]:
    """The settings in which two examples differ."""
    scene, another = (Scene(**EXAMPLES[each].settings) for each in (number, other))
    return {name for name, value in vars(scene).items() if value != getattr(another, name)}


@pytest.mark.parametrize(("number", "sentence", "other", "differs"), [
    (6, "smaller than in example 5", 5, {"m_to_px"}),
    (6, "as example 5 does", 5, {"m_to_px"}), (6, "the figures of example 5", 5, {"m_to_px"}),
    (7, "In example 8 the same happens with larger steps", 8, {"fps_target"}),
    (8, "Now example 7 at only 10 FPS", 7, {"fps_target"}),
    (9, "Example 8 with irregular frames", 8, {"use_observed_dt", "jitter"}),
    (10, "In example 8, at the same 10 FPS", 8, {"motion", "correction"}),
    (11, "Example 10 with irregular frames", 10, {"use_observed_dt", "jitter"}),
    (11, "every time, as in example 10", 10, {"use_observed_dt", "jitter"}),
    (11, "holds two bounces, as in example 12", 12, {"CR"}), (12, "Example 11, but", 11, {"CR"}),
    (15, "Example 14 with the exact solution", 14, {"motion", "correction"}),
    (16, "The o is the true car, and the * is the car of example 8", 8, {"show_exact_mark"}),
    (21, "The * is the car of example 10", 10, {"show_methods"})])
def test_an_example_names_the_example_from_which_it_differs_in_this(
        number: int, sentence: str, other: int, differs: set[str]) -> None:
    says(number, sentence)
    assert same_but(number, other) == differs


def test_plain_numbers_in_the_texts() -> None:
    for number, sentence in (
            (0, "car be after 45 s"), (0, "Each of them took 20 % of its speed"),
            (3, "kept only 60 % of its speed"), (4, "Each line is a 300th of a second"),
            (5, "A 0 shows where the move alone put the car"), (5, "70 % as far from the wall"),
            (6, "(30/55)"), (7, "the dot at 2 m"), (11, "misses a bounce, as in example 18"),
            (13, "to v^2/2 + 2 x, the"), (19, "Here k is -1 + 1/2 = -1/2"),
            (20, "Each bounce takes 20 % of the speed"), (20, "as in example 19"),
            (20, "Here k is 0 + 1 = 1"), (20, "at 30 or 60 FPS"), (22, "by the law of example 19"),
            (22, "k is 1 + 1/2 on average"), (22, "its k is -1/2"),
            (5, "Does every collision show a 0?"), (16, "Press x after 20 s"), (9, "after 30 s"),
            (17, "Press x after 20 s"), (20, "Press x after 10 s"), (21, "Press x after 20 s"),
            (8, "then again only 1.88 m, and so on"),
            (20, "So after 9 lines come 0.8 (9 + 1) + 1 = 9"), (19, "With motion=exact k is 1/2"),
            (19, "down to 2 and 1, too low"), (7, "The 1.1 cm are less than a column"),
            (12, "keeps only 80 % of its speed"), (15, "In a frame of 4 m it goes"),
            (10, "Only 10 FPS, but exact formulas")):
        says(number, sentence)
    scenes = {number: Scene(**each.settings) for number, each in EXAMPLES.items()}
    assert (scenes[0].CR, scenes[3].CR, scenes[5].CR, scenes[20].CR) == (0.8, 0.6, 0.7, 0.8)
    assert (scenes[4].fps_target, scenes[10].fps_target, scenes[7].x_m) == (300, 10, 2)


def test_no_example_stands_on_a_knife_s_edge() -> None:
    """A start that differs by a hair makes the same film, but where round-off grows by bounces."""
    for number in range(13, 23):
        scene = Scene(**EXAMPLES[number].settings)
        moved = Scene(**vars(scene) | {"x_m": scene.x_m + 1e-9})
        xs, others = ([x_m for x_m, *_ in states_of(each, 100)] for each in (scene, moved))
        assert xs == pytest.approx(others, abs=1e-5)
