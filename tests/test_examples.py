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


def says(number: int, *claims: tuple[object, ...]) -> None:
    """The texts of an example have these sentences, with these values in their braces, and no
    figure that does not stand in one of them."""
    example = EXAMPLES[number]
    text = " ".join([example.title, example.look_for, example.seen])
    for sentence, *values in claims:
        told = str(sentence).format(*values)
        assert text.count(told) == 1, told
        text = text.replace(told, "...")
    assert re.findall("[0-9].*", text) == []


def scene_of(number: int) -> Scene:
    return Scene(**EXAMPLES[number].settings)


def twin(number: int, *names: str) -> int:
    """The example that differs from this one in these settings alone."""
    scene, found = vars(scene_of(number)), []
    for other in EXAMPLES:
        differs = {name for name, value in vars(scene_of(other)).items() if value != scene[name]}
        if differs == set(names):
            found.append(other)
    only, = found
    return only


def turns_m(number: int, frames: int, **changes: object) -> list[float]:
    """The highest position of each flight of an example, from left to right and back."""
    xs = [EXAMPLES[number].settings["x_m"], *(x_m for x_m, *_ in states(number, frames, **changes))]
    return [b for (a, b), (_, c) in pairwise(pairwise(xs)) if a <= b > c]


def hops_of(number: int, frames: int, **changes: object) -> list[int]:
    return [after - before for before, after in pairwise(
        collisions(states(number, frames, **changes)))]


def bounds_of_k(number: int, frames: int, **changes: object) -> tuple[int, int]:
    """The whole numbers between which k is in all hops of two frames or more on the left wall."""
    scene = Scene(**EXAMPLES[number].settings | changes)
    found = states_of(scene, frames)
    met = [frame for frame in collisions(found) if found[frame - 1][1] > 0]
    ks = []
    for before, after in pairwise(met):
        u_mps, w_mps = found[before - 1][1], found[after - 1][1] / scene.CR
        if after - before > 1:
            ks.append((w_mps - u_mps) / abs(scene.a_mps2) * scene.fps_target)
    return math.floor(min(ks) + 1e-9), math.ceil(max(ks) - 1e-9)


def frames_to_rest(capsys: Capture, words: str) -> int:
    ending = film(capsys, *words.split()).ending
    frames, why = re.findall(r"after (\d+) frames, t = .* s: (.*)\.", ending)[0]
    assert why == "the car is at rest"
    return int(frames)


def test_0() -> None:
    found = collisions(states(0, 4000))
    assert found[24] + 1 < found[25]
    assert found[25:] == list(range(found[25], 4001))
    says(0, ("in frame {} (t = {:.0f} s), after {} bounces", found[25], found[25] * 0.015, 26),
         ("Each of them took {:.0f} % of its speed", 100 * (1 - scene_of(0).CR)),
         ("Where will the car be after {} s?", 45))
    assert states(0, round(45 / 0.015))[-1][0] == pytest.approx(0.5, abs=1e-3)


def test_1(capsys: Capture) -> None:
    scene = scene_of(1)
    says(1, ("It starts {} m from the left wall", scene.x_m - scene.left_edge_m),
         ("gets back to {:.2f} m, {:.2f} m and {:.2f} m", *[x - 0.25 for x in turns_m(1, 240)]),
         ("keeps {:.0f} % of its speed, so {}^2 = {:.2f}", 100 * scene.CR, scene.CR, scene.CR**2),
         ("for a third of a second, in frame {},", frames_to_rest(capsys, "1")),
         ("as in {} d,", 1))


def test_2() -> None:
    scene, found = scene_of(2), states(2, 1000)
    deepest_m = max(abs(x_m - 1.225) for x_m, *_ in found) - 0.975
    says(2, ("up to {:.0f} cm into the walls", 100 * deepest_m),
         ("A frame moves it by {:.0f} cm", 100 * scene.v_mps / scene.fps_target),
         ("(CR={:.0f})", scene.CR), ("its acceleration is {:.0f}.", scene.a_mps2))
    assert {abs(v_mps) for _, v_mps, _ in found} == {scene.v_mps}


def test_3(capsys: Capture) -> None:
    xs = [x_m for x_m, *_ in states(3, 600)]
    first = [x_m < 0.25 for x_m in xs].index(True) + 1
    says(3, ("In frame {} (t = {:.2f} s)", first, first / 30),
         ("has kept only {:.0f} % of its speed", 100 * scene_of(3).CR),
         ("in the end by {:.0f} mm a frame", 1000 * (xs[499] - xs[599]) / 100))
    assert max(xs[first - 1:]) < 0.25
    for picture in ("width_px=135", "width_px=43 m_to_px=17.239"):  # of 200 columns, and of 80
        lines = film(capsys, "3", *picture.split(), "--frames", "300").lines
        assert 9 * 30 < [line[0] for line in lines].index("<") < 10 * 30


def test_4(capsys: Capture) -> None:
    says(4, ("Each line is a {:.0f}th of a second", scene_of(4).fps_target),
         ("turned by 90 degrees",), ("stops after {} frames.", frames_to_rest(capsys, "4")))
    hops = hops_of(4, 1880)
    assert min(hops[3:6]) > 100
    assert max(hops[-9:]) < 10  # the tail
    walls = [states(4, frame)[-1][0] > 1 for frame in collisions(states(4, 1880))[2:5]]
    assert walls == [True, False, False]  # the right wall cuts the first arc off


def test_5_and_6(capsys: Capture) -> None:
    scene, found = scene_of(5), states(5, 236)
    says(5, ("A 0 shows where",), ("Does every collision show a 0?",),
         ("{:.0f} % as far from the wall as the 0 is", 100 * scene.CR),
         ("Many of the {} collisions show no 0", len(collisions(found))),
         ("With fps_target=10, a film to end with x, at least the first five show their 0",))
    for x_m, _, mark_m in found:
        assert mark_m is None or 2.2 - x_m == pytest.approx(0.7 * (mark_m - 2.2))
    five, six = (film(capsys, number, "d") for number in "56")
    assert sum("0" in line[:135] for line in five.lines) < len(collisions(found)) / 2
    coarse = film(capsys, "5", "fps_target=10", "--frames", "200")
    zeros = [number for number, line in enumerate(coarse.lines, 1) if "0" in line]
    assert zeros[:5] == collisions(states(5, 200, fps_target=10))[:5]
    assert coarse.ending.endswith("frame limit.")
    as_5 = twin(6, "m_to_px")
    says(6, ("Example {} zoomed out", as_5), ("smaller than in example {}.", as_5),
         ("({:.0f}/{:.0f})", scene_of(6).m_to_px, scene.m_to_px),
         ("after {} frames, as example {} does", frames_to_rest(capsys, "6"), as_5),
         ("the figures of example {}.", as_5))
    assert [line[135:] for line in five.lines] == [line[135:] for line in six.lines]


def test_7_and_8() -> None:
    xs, coarse = [x_m for x_m, *_ in states(7, 700)], twin(7, "fps_target")
    first = xs.index(max(xs[400:])) + 1
    short_m = 2 - xs[first - 1]
    says(7, ("the dot at {:.0f} m", scene_of(7).x_m),
         ("turns {:.1f} cm short of the mark, first in frame {} (t = {:.2f} s)", 100 * short_m,
          first, first / 240),
         ("The {:.1f} cm are less than a column", 100 * short_m), ("In example {} the", coarse))
    assert short_m < 1 / 55
    assert [round(turn_m, 3) for turn_m in turns_m(7, 60 * 240)][:20] == [1.989, 2.0] * 10
    turns, found = turns_m(8, 600), states(8, 60)
    assert [round(turn_m, 2) for turn_m in turns[:20]] == [round(turns[0], 2), 2.0] * 10
    depths_cm = []
    for met in collisions(found)[:2]:
        heights_m = [x + v**2 / 4 for x, v, _ in found[met - 1:met + 13]]  # E/2
        assert [a - b for a, b in pairwise(heights_m)] == pytest.approx([0.01] * 13)
        depths_cm += [100 * (0.25 - mark_m) for _, _, mark_m in found[met - 1:met] if mark_m]
    lost_cm = 100 * 0.01 * hops_of(8, 60)[0]
    less_cm, more_cm = depths_cm
    says(8, ("Now example {} at only {:.0f} FPS", twin(8, "fps_target"), scene_of(8).fps_target),
         ("Only to {:.2f} m, {:.0f} cm short of", turns[0], 100 * (2 - turns[0])),
         ("then again only {:.2f} m, and so on", turns[2]),
         ("takes away {:.0f} cm of height, so {:.0f} cm in a fall", 100 * 0.01, lost_cm),
         ("First it was {:.0f} cm below: 2 * {:.0f} = {:.0f} cm, {:.0f} too few", less_cm, less_cm,
          2 * less_cm, lost_cm - 2 * less_cm),
         ("Then it was {:.0f} cm below: 2 * {:.0f} = {:.0f} cm, {:.0f} too many", more_cm, more_cm,
          2 * more_cm, 2 * more_cm - lost_cm))


def test_9() -> None:
    turns = turns_m(9, 500)
    says(9, ("Example {} with irregular", twin(9, "use_observed_dt", "jitter")),
         ("First it turns at about {:.2f} m", turns[0]), ("Press x after {} s", 30))
    beyond = [x_m > 2.05 for x_m, *_ in states(9, 400)].index(True)
    assert beyond / 10 == pytest.approx(30, abs=3)
    assert len({round(turn_m, 2) for turn_m in turns[:8]}) > 5


def test_10_and_11() -> None:
    first, fps = collisions(states(10, 30))[0], scene_of(10).fps_target
    says(10, ("Only {:.0f} FPS, but", fps),
         ("you see the 0 of the first bounce, in line {}.", first),
         ("the dot at {:.0f} m", scene_of(10).x_m), ("The 0 in frame {} shows", first),
         ("In example {}, at the same {:.0f} FPS", twin(10, "motion", "correction"), fps))
    regular = twin(11, "use_observed_dt", "jitter")
    says(11, ("Example {} with irregular", regular), ("every time, as in example {}.", regular),
         ("two bounces, as in example {}, and", twin(11, "CR")),
         ("misses a bounce, as in example {}.", 18))  # see test_18
    for number in (10, 11):
        turns = turns_m(number, 6000)
        assert len(turns) > 200
        assert {round(turn_m * 55) for turn_m in turns} == {110}


def test_12(capsys: Capture) -> None:
    fall_s = math.sqrt(2 * 1.75 / 2)
    truth = truth_of(scene_of(12))
    rewound, replayed = (frames_to_rest(capsys, f"12 correction={name}")
                         for name in ("rewind", "replay"))
    moments_s = accumulate(planned_length(truth, frame) for frame in range(1, rewound + 1))
    off_m = max(abs(x_m - step(truth, 2.0, 0.0, t_s)[0])
                for (x_m, *_), t_s in zip(states(12, rewound), moments_s, strict=True))
    says(12, ("Example {}, but the car keeps only {:.0f} %", twin(12, "CR"), 100 * truth.CR),
         ("before t = {:.2f} s, the Zeno point", fall_s + 2 * fall_s * 0.8 / (1 - 0.8)),
         ("at rest in about frame {}. Replay", rewound),
         ("stops in about frame {}. Still", replayed),
         ("at most about {:.1f} mm off, less than a quarter of a column", 1000 * off_m))
    assert off_m < 1 / 55 / 4


def test_13() -> None:
    xs, truth, _ = zip(*beside_the_truth(13, 26), strict=True)
    ahead_m = [x_m - true_m for x_m, true_m in zip(xs[:24], truth[:24], strict=True)]
    assert [b - a for a, b in pairwise([0, *ahead_m])] == pytest.approx([0.01] * 24)
    control = beside_the_truth(13, 26, motion="exact")
    met = collisions(states(13, 26, motion="exact"))[0]
    assert apart_m(control[:met - 1]) < 1e-12
    says(13, ("It turned at {:.2f} m, in frame {}, and the o at {:.2f} m", max(xs),
              xs.index(max(xs)) + 1, max(truth)),
         ("gets {:.0f} cm further to the right", 100 * ahead_m[0]),
         ("each frame adds {:.2f} m^2/s^2 to v^2/2 + {:.0f} x", 2.0**2 * 0.1**2 / 2, 2),
         ("meets the wall, in frame {}.", met))


def test_14_and_15(capsys: Capture) -> None:
    xs = [x_m for x_m, *_ in states(14, 600)]
    assert {round(abs(b) - abs(a), 6) for a, b in zip(xs, xs[2:], strict=False)} == {4.1}
    says(14, ("The car moves {:.0f} m in a frame, but the track is only {:.2f} m long", 40 / 10,
              2.2 - 0.25),
         ("{:.1f} m further out every other frame", abs(xs[2]) - abs(xs[0])),
         ("In a minute it is {:.1f} km away", xs[-1] / 1000))
    shown = ["".join(line.split()) for line in film(capsys, "14", "--frames", "600").lines]
    assert shown == ["<||", "||>"] * 300
    xs = [1.65] + [x_m for x_m, *_ in states(15, 600)]
    says(15, ("Example {} with the", twin(15, "motion", "correction")),
         ("The car still moves {:.0f} m", 40 / 10), ("In a frame of {:.0f} m", 40 / 10),
         ("and back, {:.1f} m, and ends {:.1f} m from", 2 * (2.2 - 0.25), abs(xs[1] - xs[0])))
    assert sum(abs(b - a) == pytest.approx(0.1) for a, b in pairwise(xs)) > 550


def test_16_17_and_21(capsys: Capture) -> None:
    frames, span = 200, 20  # at 10 FPS
    methods = {letter: beside_the_truth(21, frames, motion=motion, correction=correction)
               for letter, (motion, correction) in METHODS.items()}
    a, b, c, d, e = methods.values()
    leaves = [[apart_m([frame]) < 1e-9 for frame in each].index(False) + 1 for each in (a, b, c)]
    first, met, met_too = leaves
    assert met == met_too
    assert apart_m(d) < 1e-9
    assert apart_m(e) < 1e-9
    says(16, ("Example {} beside", twin(16, "show_exact_mark")),
         ("the car of example {}.", twin(16, "show_exact_mark")), ("Press x after {} s", span),
         ("they are {:.0f} cm apart in frame {}, {:.0f} cm in frame {}", 100 * apart_m(a[:1]), 1,
          100 * apart_m(a[:2]), 2), ("and up to {:.1f} m within {} s", apart_m(a), span))
    says(17, ("Press x after {} s", span), ("until the first bounce, in frame {}.", met),
         ("wrong, by up to {:.1f} m within {} s", apart_m(b), span),
         ("stays within {:.0f} cm of the o for {} s", 100 * apart_m(c), span))
    for x_m, _, mark_m in b:  # at an unchanged speed, so E = v^2/2 + 2 x is lifted by 2 x
        if mark_m is not None:
            assert (x_m > mark_m) is (mark_m < 0.25)
    columns = [round(55 * x_m) for x_m, *_ in c]
    assert max(columns) == 110  # that of the start mark
    assert sum(a < 110 == b for a, b in pairwise(columns)) == 7
    says(21, ("the car of example {}.", twin(21, "show_methods")), ("Press x after {} s", span),
         ("first, by {:.0f} cm in frame {}.", 100 * apart_m(a[:1]), first),
         ("Within {} s it gets up to {:.1f} m away", span, apart_m(a)),
         ("after the first bounce, in frame {}.", met),
         ("gets furthest away, up to {:.1f} m within {} s", apart_m(b), span),
         ("c stays within {:.0f} cm for these {} s", 100 * apart_m(c), span))
    for picture in ("width_px=135", "width_px=80 m_to_px=32.425"):
        marks = set("".join(film(capsys, "21", *picture.split(), "--frames", "200").lines))
        assert marks == set(" |*.0abc")  # d and e are never seen


def test_18() -> None:
    found = beside_the_truth(18, 5)
    turned_s, fps = 5 / 8, scene_of(18).fps_target
    missed = math.ceil(turned_s * fps)
    assert collisions(states(18, 5)) == []
    assert apart_m(found[:missed - 1]) < 1e-12
    assert found[missed - 1][0] - found[missed - 1][1] > 0.1  # the o is on its way back
    says(18, ("solution at {:.0f} FPS", fps), ("By frame {} the o", missed),
         ("frame {} they are about {:.1f} m apart", missed + 1, apart_m([found[missed]])),
         ("In frame {} the move goes {:.0f} cm beyond", missed, 100 * (0.65 + 5**2 / 16 - 2.2)))
    assert apart_m(beside_the_truth(18, 80, correction="replay")) < 1e-9


def test_19(capsys: Capture) -> None:
    vs = [details(line)[1] for line in film(capsys, "19", "d").lines]
    jumps = [line for line, (a, b) in enumerate(pairwise(vs)) if b - a > -0.19]
    assert [b - a for a, b in pairwise(jumps)][:15] == [*range(15, 0, -1)]
    longer = hops_nearby(19, 11, motion="exact")
    assert longer == [[*range(18, 29)]] * 9
    says(19, ("falls by {:.2f} m/s", 2 * 0.1),
         ("take {}, {}, {} ... lines, down to {} and {}, too", 15, 14, 13, 2, 1),
         ("In frame {} the film calls", frames_to_rest(capsys, "19")),
         ("at CR = {:.0f} each hop", scene_of(19).CR),
         ("With backward + surface k is between {} and {},", *bounds_of_k(19, 120)),
         ("surface k is between {} and {}: add", *bounds_of_k(19, 290, motion="exact")),
         ("the hops take {}, {}, {} ... lines for half", *longer[0][:3]))
    meets = next(frame for frame, (*_, mark_m) in enumerate(states(19, 400, motion="exact"), 1)
                 if mark_m and mark_m > 2.2)
    assert meets / 10 == pytest.approx(30, abs=3)


def test_20(capsys: Capture) -> None:
    found, hops = collisions(states(20, 200)), hops_of(20, 200)
    speed_mps = math.sqrt(0.75**2 + 2 * 2 * 0.41)
    zeno_s = (0.75 + speed_mps) / 2 + speed_mps * 0.8 / (1 - 0.8)
    lasting = found[3]
    assert hops == [14, 12, 10] + [9] * (len(hops) - 3)
    says(20, ("Each bounce takes {:.0f} % of", 100 * (1 - scene_of(20).CR)),
         ("as in example {}. Press x after {} s", 19, 10),
         ("at t = {:.2f} s, its Zeno", zeno_s),
         ("this frame, {:.2f} s.", math.ceil(zeno_s * 10) / 10),
         ("take {}, {}, {} lines and, from frame {} on, {} for ever", *hops[:3], lasting, hops[3]),
         ("rebound k is between {} and {}, and from frame {} on it is {:.0f}.",
          *bounds_of_k(20, 200), lasting, hops[-1] * (1 - 0.8) / (1 + 0.8)),
         ("after {} lines come {} ({} + {}) + {} = {:.0f}", 9, 0.8, 9, 1, 1, 0.8 * (9 + 1) + 1),
         ("at {} or {} FPS they do not end", 30, 60), ("at about {} s, as the o does", 7))
    for fps in (30, 60):
        for lines in hops_nearby(20, 200, fps_target=fps):
            assert min(lines[-20:]) > 1
    for fps in (10, 30, 60, 120, 240):
        frames = frames_to_rest(capsys, f"20 correction=conserve fps_target={fps}")
        assert frames / fps == pytest.approx(7, abs=0.25)


def test_22(capsys: Capture) -> None:
    found, hops = states(22, 4000), hops_of(22, 4000)
    first = max(number for number, hop in enumerate(hops) if hop != hops[-1]) + 1
    assert len(hops) > first + 100
    ends = {hops_of(22, 1500, x_m=0.5 + number / 50)[-1] for number in range(60)}
    says(22, ("higher than {:.0f} cm", 100 * 135 / scene_of(22).m_to_px),
         ("from t = {:.2f} s on it lies", math.sqrt(0.2) * (1 + 0.8) / (1 - 0.8)),
         ("From frame {} on the * hops for ever, in hops of {} lines that are {:.0f} mm high",
          collisions(found)[first], hops[-1], 1000 * max(x_m for x_m, *_ in found[3000:])),
         ("surface, so in the law of the hops k is between {} and {}: too", *bounds_of_k(22, 4000)),
         ("hops of {} to {} lines.", min(ends), max(ends)),
         ("whose k is between {} and {}. To", *bounds_of_k(22, 200, motion="backward")),
         ("stops in frame {}.", frames_to_rest(capsys, "22 motion=backward")))
    line = film(capsys, "22", "--frames", "500").lines
    assert max(each.index("*") for each in line[330:]) == pytest.approx(40, abs=1)  # 80 mm
    assert (line[0][-1], line[400][0]) in ((">", "o"), (">", "*"))


def test_examples_that_end_with_x_do_not_end_by_themselves(capsys: Capture) -> None:
    for number, example in EXAMPLES.items():
        if re.search(r"\bx(\.| ends| after)", example.look_for):
            assert film(capsys, str(number), "--frames=3000").ending.endswith("frame limit.")


def test_no_example_stands_on_a_knife_s_edge() -> None:
    """A start that differs by a hair makes the same film, but where round-off grows by bounces."""
    for number in range(13, 23):
        scene = scene_of(number)
        moved = Scene(**vars(scene) | {"x_m": scene.x_m + 1e-9})
        xs, others = ([x_m for x_m, *_ in states_of(each, 100)] for each in (scene, moved))
        assert xs == pytest.approx(others, abs=1e-5)
