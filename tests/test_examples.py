"""The examples: every figure that a text gives is worked out, and so is what it says in words."""

import math
import re
from itertools import accumulate, pairwise

import pytest

from airtrack import METHODS, Scene, planned_length, step, truth_of
from examples import EXAMPLES
from films import apart_m, beside_the_truth, collisions, details, film, hops_nearby, states

Capture = pytest.CaptureFixture[str]


def tells(number: int, *figures: float) -> None:
    """The texts of an example have these figures in this order, each rounded as it is told.

    Where m is meant and cm is told, a figure is in cm, and so on. The mark 0 is a figure, too.
    """
    example = EXAMPLES[number]
    text = " ".join([example.title, example.look_for, example.seen])
    told = re.findall(r"(?<![\^.0-9])-?[0-9]+(?:\.[0-9]+)?", text)  # no exponents
    assert len(figures) == len(told), told
    rounded = []
    for figure, as_told in zip(figures, told, strict=True):
        places = len(as_told.partition(".")[2])
        rounded.append(f"{figure:.{places}f}")
    assert rounded == told


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


def turns_m(number: int, frames: int) -> list[float]:
    """The highest position of each flight of an example, from left to right and back."""
    xs = [scene_of(number).x_m, *(x_m for x_m, *_ in states(number, frames))]
    return [b for (a, b), (_, c) in pairwise(pairwise(xs)) if a <= b > c]


def hops_of(number: int, frames: int, **changes: object) -> list[int]:
    found = collisions(states(number, frames, **changes))
    return [after - before for before, after in pairwise(found)]


def bounds_of_k(number: int, frames: int, **changes: object) -> tuple[int, int]:
    """The whole numbers between which k is in all hops of two frames or more on the left wall."""
    scene, found = scene_of(number), states(number, frames, **changes)
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
    lies = next(frame for frame in found if frame + 1 in found)
    assert found[found.index(lies):] == list(range(lies, 4001))
    tells(0, 45, lies, lies * 0.015, found.index(lies) + 1, 100 * (1 - scene_of(0).CR))
    assert states(0, round(45 / 0.015))[-1][0] == pytest.approx(0.5, abs=1e-3)


def test_1(capsys: Capture) -> None:
    CR = scene_of(1).CR
    tells(1, 2 - 0.25, *[x_m - 0.25 for x_m in turns_m(1, 240)[:3]], 100 * CR, CR, CR**2,
          frames_to_rest(capsys, "1"), 1)


def test_2() -> None:
    scene, found = scene_of(2), states(2, 1000)
    deepest_m = max(abs(x_m - 1.225) for x_m, *_ in found) - 0.975
    tells(2, 100 * deepest_m, 100 * scene.v_mps / scene.fps_target, scene.CR, scene.a_mps2)
    assert {abs(v_mps) for _, v_mps, _ in found} == {scene.v_mps}


def test_3(capsys: Capture) -> None:
    xs = [x_m for x_m, *_ in states(3, 600)]
    caught = [x_m < 0.25 for x_m in xs].index(True) + 1
    tells(3, caught, caught / 30, 100 * scene_of(3).CR, 1000 * (xs[499] - xs[599]) / 100)
    assert max(xs[caught - 1:]) < 0.25
    for picture in ("width_px=135", "width_px=43 m_to_px=17.239"):  # of 200 columns, and of 80
        lines = film(capsys, "3", *picture.split(), "--frames", "300").lines
        assert 9 * 30 < [line[0] for line in lines].index("<") < 10 * 30


def test_the_first_examples_show_no_mark_that_nobody_has_explained(capsys: Capture) -> None:
    for number in range(5):
        lines = film(capsys, str(number), "--frames=300").lines
        assert set("".join(line.partition("x =")[0] for line in lines)) <= set(" *|<>")


def test_4(capsys: Capture) -> None:
    tells(4, scene_of(4).fps_target, 90, frames_to_rest(capsys, "4"))
    hops = hops_of(4, 1880)
    assert min(hops[3:6]) > 100
    assert max(hops[-9:]) < 10  # the tail
    found = states(4, 1880)
    are_right = [found[frame - 1][0] > 1 for frame in collisions(found)[2:5]]
    assert are_right == [True, False, False]  # the right wall cuts the first arc off


def test_5_and_6(capsys: Capture) -> None:
    found = states(5, 236)
    bounces = len(collisions(found))
    tells(5, 0, 0, 100 * scene_of(5).CR, 0, bounces, 0, 10, 0)
    for x_m, _, mark_m in found:
        assert mark_m is None or 2.2 - x_m == pytest.approx(0.7 * (mark_m - 2.2))
    five, six = (film(capsys, number, "d") for number in "56")
    assert sum("0" in line[:135] for line in five.lines) < bounces / 2
    coarse = film(capsys, "5", "fps_target=10", "--frames", "200")
    zeros = [number for number, line in enumerate(coarse.lines, 1) if "0" in line]
    assert zeros[:5] == collisions(states(5, 200, fps_target=10))[:5]
    assert coarse.ending.endswith("frame limit.")
    as_5 = twin(6, "m_to_px")
    tells(6, as_5, as_5, scene_of(6).m_to_px, 55, frames_to_rest(capsys, "6"), as_5, as_5)
    assert [line[135:] for line in five.lines] == [line[135:] for line in six.lines]


def test_7() -> None:
    found = turns_m(7, 60 * 240)
    xs = [x_m for x_m, *_ in states(7, 700)]
    first, short_m = xs.index(found[0]) + 1, 2 - found[0]
    tells(7, 2, 100 * short_m, first, first / 240, 100 * short_m, twin(7, "fps_target"))
    assert short_m < 1 / 55
    assert [round(turn_m, 3) for turn_m in found][:20] == [1.989, 2.0] * 10


def test_8() -> None:
    turns, found = turns_m(8, 600), states(8, 60)
    assert [round(turn_m, 2) for turn_m in turns[:20]] == [round(turns[0], 2), 2.0] * 10
    less_cm, more_cm = [100 * (0.25 - mark_m) for *_, mark_m in found if mark_m is not None][:2]
    for met in collisions(found)[:2]:
        heights_m = [x + v**2 / 4 for x, v, _ in found[met - 1:met + 13]]  # E/2
        assert [a - b for a, b in pairwise(heights_m)] == pytest.approx([0.01] * 13)
    lost_cm = hops_of(8, 60)[0]  # 1 cm in each frame
    tells(8, twin(8, "fps_target"), 10, turns[0], 100 * (2 - turns[0]), turns[2], 1, lost_cm,
          less_cm, 2, less_cm, 2 * less_cm, lost_cm - 2 * less_cm,
          more_cm, 2, more_cm, 2 * more_cm, 2 * more_cm - lost_cm)


def test_9() -> None:
    turns = turns_m(9, 500)
    tells(9, twin(9, "use_observed_dt", "jitter"), 30, turns[0])
    beyond = [x_m > 2.05 for x_m, *_ in states(9, 400)].index(True)
    assert beyond / 10 == pytest.approx(30, abs=3)
    assert len({round(turn_m, 2) for turn_m in turns[:8]}) > 5


def test_10_and_11() -> None:
    first = collisions(states(10, 30))[0]
    tells(10, 10, 0, first, scene_of(10).x_m, 0, first, twin(10, "motion", "correction"), 10)
    regular = twin(11, "use_observed_dt", "jitter")
    tells(11, regular, regular, twin(11, "CR"), 18)  # see test_18
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
    tells(12, twin(12, "CR"), 100 * truth.CR, fall_s + 2 * fall_s * 0.8 / (1 - 0.8), rewound,
          replayed, 1000 * off_m)
    assert off_m < 1 / 55 / 4


def test_13() -> None:
    xs, truth, _ = zip(*beside_the_truth(13, 26), strict=True)
    ahead_m = [x_m - true_m for x_m, true_m in zip(xs[:24], truth[:24], strict=True)]
    assert [b - a for a, b in pairwise([0, *ahead_m])] == pytest.approx([0.01] * 24)
    met = collisions(states(13, 26, motion="exact"))[0]
    assert apart_m(beside_the_truth(13, met - 1, motion="exact")) < 1e-12
    tells(13, max(xs), xs.index(max(xs)) + 1, max(truth), 100 * ahead_m[0], 2.0**2 * 0.1**2 / 2,
          met)


def test_14_and_15(capsys: Capture) -> None:
    xs = [x_m for x_m, *_ in states(14, 600)]
    assert {round(abs(b) - abs(a), 6) for a, b in zip(xs, xs[2:], strict=False)} == {4.1}
    tells(14, 40 / 10, 2.2 - 0.25, abs(xs[2]) - abs(xs[0]), xs[-1] / 1000)
    shown = ["".join(line.split()) for line in film(capsys, "14", "--frames", "600").lines]
    assert shown == ["<||", "||>"] * 300
    moved_m = [abs(b - a) for a, b in pairwise(x_m for x_m, *_ in states(15, 600))]
    tells(15, twin(15, "motion", "correction"), 4, 40 / 10, 2 * (2.2 - 0.25), moved_m[0])
    assert sum(each_m == pytest.approx(0.1) for each_m in moved_m) > 550


def test_16_17_and_21(capsys: Capture) -> None:
    frames, span = 200, 20  # at 10 FPS
    a, b, c, d, e = (beside_the_truth(21, frames, motion=motion, correction=correction)
                     for motion, correction in METHODS.values())
    assert apart_m(d + e) < 1e-9
    met, met_too = ([apart_m([frame]) < 1e-9 for frame in each].index(False) + 1 for each in (b, c))
    assert met == met_too
    first_cm = 100 * apart_m(a[:1])
    as_8, as_10 = twin(16, "show_exact_mark"), twin(21, "show_methods")
    tells(16, as_8, as_8, span, first_cm, 1, 100 * apart_m(a[:2]), 2, apart_m(a), span)
    tells(17, span, met, apart_m(b), span, 100 * apart_m(c), span)
    tells(21, as_10, span, first_cm, 1, span, apart_m(a), met, apart_m(b), span,
          100 * apart_m(c), span)
    for x_m, _, mark_m in b:  # at an unchanged speed, so E = v^2/2 + 2 x is lifted by 2 x
        if mark_m is not None:
            assert (x_m > mark_m) is (mark_m < 0.25)
    columns = [round(55 * x_m) for x_m, *_ in c]
    assert max(columns) == 110  # that of the start mark
    assert sum(a < 110 == b for a, b in pairwise(columns)) == 7
    for picture in ("width_px=135", "width_px=80 m_to_px=32.425"):
        marks = set("".join(film(capsys, "21", *picture.split(), "--frames", "200").lines))
        assert marks == set(" |*.0abc")  # d and e are never seen


def test_18() -> None:
    found = beside_the_truth(18, 5)
    fps = scene_of(18).fps_target
    assert EXAMPLES[18].title.endswith(f" at {fps:g} FPS")
    missed = math.ceil(5 / 8 * fps)  # it turns after 5/8 s
    assert collisions(states(18, 5)) == []
    assert apart_m(found[:missed - 1]) < 1e-12
    assert found[missed - 1][0] - found[missed - 1][1] > 0.1  # the o is on its way back
    tells(18, fps, missed, missed + 1, apart_m([found[missed]]), missed,
          100 * (0.65 + 5**2 / 16 - 2.2))
    assert apart_m(beside_the_truth(18, 80, correction="replay")) < 1e-9


def test_19(capsys: Capture) -> None:
    vs = [details(line)[1] for line in film(capsys, "19", "d").lines]
    jumps = [line for line, (a, b) in enumerate(pairwise(vs)) if b - a > -0.19]
    hops = [b - a for a, b in pairwise(jumps)]
    assert hops[:15] == [*range(15, 0, -1)]
    longer = hops_nearby(19, 11, motion="exact")
    assert longer == [[*range(18, 29)]] * 9
    tells(19, 2 * 0.1, *hops[:3], 2, 1, frames_to_rest(capsys, "19"), scene_of(19).CR,
          *bounds_of_k(19, 120), *bounds_of_k(19, 290, motion="exact"), *longer[0][:3])
    meets = next(frame for frame, (*_, mark_m) in enumerate(states(19, 400, motion="exact"), 1)
                 if mark_m and mark_m > 2.2)
    assert meets / 10 == pytest.approx(30, abs=3)


def test_20(capsys: Capture) -> None:
    lasting, hops = collisions(states(20, 200))[3], hops_of(20, 200)
    hop = hops[3]
    assert set(hops[3:]) == {hop}
    speed_mps = math.sqrt(0.75**2 + 2 * 2 * 0.41)
    zeno_s = (0.75 + speed_mps) / 2 + speed_mps * 0.8 / (1 - 0.8)
    k = hop * (1 - 0.8) / (1 + 0.8)
    tells(20, 100 * (1 - scene_of(20).CR), 19, 10, zeno_s, math.ceil(zeno_s * 10) / 10, *hops[:3],
          lasting, hop, *bounds_of_k(20, 200), lasting, k, hop, 0.8, hop, k, k,
          0.8 * (hop + k) + k, 30, 60, 7)
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
    tells(22, 100 * 135 / scene_of(22).m_to_px, math.sqrt(0.2) * (1 + 0.8) / (1 - 0.8),
          collisions(found)[first], hops[-1], 1000 * max(x_m for x_m, *_ in found[3000:]),
          *bounds_of_k(22, 4000), min(ends), max(ends), *bounds_of_k(22, 200, motion="backward"),
          frames_to_rest(capsys, "22 motion=backward"))
    lines = film(capsys, "22", "--frames", "500").lines
    assert max(line.index("*") for line in lines[330:]) == pytest.approx(40, abs=1)  # 80 mm
    assert (lines[0][-1], lines[400][0]) in ((">", "o"), (">", "*"))


def test_examples_that_end_with_x_do_not_end_by_themselves(capsys: Capture) -> None:
    for number, example in EXAMPLES.items():
        if re.search(r"\bx(\.| ends| after)", example.look_for):
            assert film(capsys, str(number), "--frames=3000").ending.endswith("frame limit.")
