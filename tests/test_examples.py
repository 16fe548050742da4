"""The examples: the figures of their texts are read there, and compared with the films."""

import math
import re
from collections.abc import Callable
from typing import Any

import pytest

from airtrack import METHODS, scene_of
from clock import plain
from examples import EXAMPLES
from films import bounces, filmed, furthest_m, hops, shown, tops_m

Changes = dict[str, Any]
EXACT = {"motion": "exact"}
A, B, C, D, REPLAY = [{"motion": motion, "correction": correction}
                      for motion, correction in METHODS.values()]

def stops(number: int, **changes: Any) -> list[float]:
    """The frame in which the film stops."""
    words = [f"{name}={value}" for name, value in changes.items()]
    return [len(shown(" ".join([str(number), *words])).lines)]

def first_bounce(number: int, **changes: Any) -> list[float]:
    return [float(frame) for frame in bounces(filmed(number, 100, **changes))[:1]]

def turns_m(number: int, **changes: Any) -> list[float]:
    """Where it turns on its way to the right; in example 1 from the wall, after the start."""
    places_m = filmed(number, 3000, **changes).places_m
    if number == 1:
        return [x_m - 0.25 for x_m in (places_m[0], *tops_m(places_m))]
    return tops_m(places_m)

def hop_lines(number: int, **changes: Any) -> list[float]:
    return [float(lines) for lines in hops(filmed(number, 600, **changes))]

def off(frames: int, unit_m: float = 1.0) -> Callable[..., list[float]]:
    """How far it is from the truth within so many frames, in this unit."""
    return lambda number, **changes: [furthest_m(filmed(number, frames, **changes)) / unit_m]

@pytest.mark.parametrize(("number", "pattern", "found", "changes"), [
    (1, r"In frame (\d+) the film stops", stops, {}), (4, r"stops after (\d+) frames", stops, {}),
    (6, r"stops after (\d+) frames", stops, {}), (6, r"stops after (\d+) frames", stops,
                                                  {"m_to_px": 55.0}),  # as example 5
    (19, r"In frame (\d+) the film stops", stops, {}),
    (22, r"the film stops in frame (\d+)", stops, {"motion": "backward"}),
    (3, r"In frame (\d+) \(t", first_bounce, {}), (10, r"bounce, in line (\d+)", first_bounce, {}),
    (10, r"The 0 in frame (\d+)", first_bounce, {}),
    (13, r"meets the wall, in frame (\d+)", first_bounce, EXACT),
    (17, r"first bounce, in frame (\d+)", first_bounce, {}),
    (21, r"first bounce, in frame (\d+)", first_bounce, C),
    (1, r"starts ([\d.]+) m .* back to ([\d.]+) m, ([\d.]+) m and ([\d.]+) m", turns_m, {}),
    (8, r"First only to ([\d.]+) m", turns_m, {}), (13, r"It turns at ([\d.]+) m", turns_m, {}),
    (9, r"turns at about ([\d.]+) m, then at ([\d.]+) m and ([\d.]+) m", turns_m, {}),
    (13, r"and the o at ([\d.]+) m", turns_m, REPLAY),
    (19, r"the hops take (\d+), (\d+), (\d+) \.\.\. lines, down", hop_lines, {}),
    (19, r"Then the hops take (\d+), (\d+), (\d+) \.\.\. lines", hop_lines, EXACT),
    (20, r"take (\d+), (\d+), (\d+) lines and", hop_lines, {}),
    (12, r"about ([\d.]+) mm off", off(130, 0.001), {}),
    (16, r"they are ([\d.]+) cm apart in frame 1", off(1, 0.01), {}),
    (16, r"([\d.]+) cm in frame 2", off(2, 0.01), {}),
    (16, r"up to ([\d.]+) m within", off(200), {}),
    (17, r"up to ([\d.]+) m within 20 s", off(200), {}),
    (18, r"about ([\d.]+) m apart", off(4), {}), (21, r"first, by ([\d.]+) cm", off(1, 0.01), A),
    (21, r"Within 20 s it gets up to ([\d.]+) m away", off(200), A),
    (21, r"b gets furthest away, up to ([\d.]+) m", off(200), B),
    (21, r"seven times, and gets up to ([\d.]+) m away", off(200), C)])
def test_the_film_has_the_figures_that_its_text_tells(
        number: int, pattern: str, found: Callable[..., list[float]], changes: Changes) -> None:
    figures = told(number, pattern)
    assert found(number, **changes)[:len(figures)] == pytest.approx(figures, rel=0.04, abs=0.006)

def told(number: int, pattern: str) -> list[float]:
    """The figures in an example's texts, in the order in which the pattern has its groups."""
    example = EXAMPLES[number]
    found = re.search(pattern, plain(f"{example.look_for} {example.seen}"))
    assert found, f"example {number} has no {pattern}"
    return [float(figure) for figure in found.groups()]

@pytest.mark.parametrize(("number", "frames", "changes"), [
    (10, 200, {}), (11, 200, {}), (13, 24, EXACT), (17, 13, {}), (18, 2, {}), (18, 80, REPLAY),
    (21, 13, C), (21, 200, D)])
def test_it_stays_on_the_truth(number: int, frames: int, changes: Changes) -> None:
    assert furthest_m(filmed(number, frames, **changes)) < 1e-9

@pytest.mark.parametrize(("words", "frames"), [
    ("1", 251), ("4", 1878), ("5", 236), ("6", 236), ("12", 130), ("12 correction=replay", 124),
    ("19", 136), ("22 motion=backward", 222)])
def test_the_film_stops_in_this_frame_and_1_5_6_and_12_in_that_of_the_lesson(
        words: str, frames: int) -> None:
    assert len(shown(words).lines) == frames

@pytest.mark.parametrize(("words", "mark"), [("12", "*"), ("20 --frames=600", "o"),
                                             ("22 --frames=600", "o")])
def test_a_car_is_at_rest_from_the_frame_that_is_told(words: str, mark: str) -> None:
    frame, = told(int(words[:2]), r"at rest from frame (\d+)")
    assert shown(words).rows[mark].endswith(f" from frame {frame:g}")

@pytest.mark.parametrize(("number", "pattern", "count"), [
    (20, r"from frame (\d+) on, (\d+) for ever", 50),
    (22, r"From frame (\d+) on the \* hops for ever, in hops of (\d+) lines", 15)])
def test_from_this_frame_on_all_hops_are_equal(number: int, pattern: str, count: int) -> None:
    frame, lines = told(number, pattern)
    first = bounces(filmed(number, 600)).index(round(frame))
    assert hop_lines(number)[first:first + count] == [lines] * count
    assert hop_lines(number)[first - 1] != lines

@pytest.mark.parametrize(("number", "changes", "every"), [
    (7, {}, 2), (8, {}, 2), (10, {}, 1), (11, {}, 1), (17, C, 1)])
def test_it_comes_back_to_its_mark_every_time_or_every_second_time(
        number: int, changes: Changes, every: int) -> None:
    found_m = turns_m(number, **changes)[:4]
    assert found_m[every - 1::every] == pytest.approx([2] * (4 // every), abs=0.006)
    assert every == 1 or max(found_m[::2]) < 1.99

@pytest.mark.parametrize(("number", "pattern"), [
    (12, r"before t = ([\d.]+) s, the Zeno point"), (20, r"still from t = ([\d.]+) s on"),
    (22, r"still from t = ([\d.]+) s on")])
def test_the_zeno_point_is_that_of_the_closed_form(number: int, pattern: str) -> None:
    scene = scene_of(EXAMPLES[number].settings)
    g, h_m, v_mps = -scene.a_mps2, scene.x_m - scene.left_edge_m, scene.v_mps
    hits_mps = math.sqrt(v_mps**2 + 2 * g * h_m)
    zeno_s = (v_mps + hits_mps) / g + 2 * 0.8 * hits_mps / g / (1 - 0.8)
    assert told(number, pattern) == pytest.approx([zeno_s], abs=0.006)

def test_the_speeds_of_the_hops_of_19_20_and_22() -> None:
    car = filmed(19, 100)
    leaves_mps = [car.velocities_mps[frame] for frame in bounces(car)]
    assert leaves_mps[:4] == pytest.approx(
        told(19, r"leaves at ([\d.]+), ([\d.]+), ([\d.]+), ([\d.]+) \.\.\. m/s"), abs=0.0006)
    car = filmed(20, 1000)
    leaves_mps = [car.velocities_mps[frame] for frame in bounces(car)]
    comes_mps = hops(car)[-1] * 0.2 - leaves_mps[-2]
    assert [leaves_mps[-2], comes_mps] == pytest.approx(
        told(20, r"in the end it leaves at ([\d.]+) m/s and comes back at ([\d.]+) m/s"), abs=0.006)
    car = filmed(22, 2000)
    high_mm, gain_mps = told(22, r"lines that are about (\d+) mm high.*ball gets ([\d.]+) m/s")
    assert 1000 * max(car.places_m[1000:]) == pytest.approx(high_mm, abs=5)
    leaves_mps = [car.velocities_mps[frame] for frame in bounces(car)]
    assert hops(car)[-1] / 6 - 2 * leaves_mps[-2] == pytest.approx(gain_mps, abs=0.05)  # w - u

def test_1_rests_for_as_long_as_it_is_told_before_its_film_ends() -> None:
    rests_s = len(shown("99 fps_target=50").lines) / 50
    assert told(1, r"for ([\d.]+) s the car was too low") == [rests_s]

def test_the_picture_of_22_ends_where_it_is_told() -> None:
    high_cm, = told(22, r"higher than (\d+) cm, out of the picture")
    lines = shown("22 --frames=60").lines
    places_m = filmed(22, 60).places_m[1:]
    out_m = [x_m for x_m, line in zip(places_m, lines, strict=True) if line.endswith(">")]
    in_m = [x_m for x_m, line in zip(places_m, lines, strict=True) if not line.endswith(">")]
    assert max(in_m) < high_cm / 100 + 0.001 < min(out_m) + 0.01

def test_0_is_at_the_left_wall_after_45_s_and_flies_until_44_s() -> None:
    car = filmed(0, 3000)
    assert car.places_m[-1] == pytest.approx(0.5, abs=1e-3)
    assert sum(mark_m > 17 for mark_m in car.marks_m if mark_m is not None) == 3
    last = max(number for number, mark_m in enumerate(car.marks_m) if mark_m is None)
    assert told(0, r"From about t = ([\d.]+) s on") == pytest.approx([last * 0.015], abs=0.5)
    line, = shown("0 --frames=1").lines
    assert "v = 16.97" in line  # 17 - 2 * 0.015, and details without d

def test_3_is_caught_sinks_by_1_mm_a_frame_and_gets_out_of_the_picture() -> None:
    places_m = filmed(3, 600).places_m
    assert max(places_m[46:]) < 0.25
    sinks_mm = 1000 * (places_m[500] - places_m[501])
    assert told(3, r"in the end by (\d+) mm a frame") == pytest.approx([sinks_mm], rel=0.5)
    assert 270 <= [line[0] for line in shown("3 --frames=300").lines].index("<") <= 300

def test_5_shows_only_some_of_its_collisions_8_is_deep_in_its_wall_and_14_is_far_away() -> None:
    seen = sum("0" in line for line in shown("5").lines)
    collisions = len(bounces(filmed(5, 236)))
    assert told(5, r"(\d+) of the (\d+) collisions show no 0") == [collisions - seen, collisions]
    depths_cm = [25 - 100 * mark_m for mark_m in filmed(8, 60).marks_m if mark_m is not None]
    assert told(8, r"car was (\d+) cm .* second it was (\d+) cm beyond") == pytest.approx(depths_cm)
    places_m = filmed(14, 600).places_m
    assert told(14, r"it is ([\d.]+) m further out.* it is ([\d.]+) km away") == pytest.approx(
        [abs(places_m[102]) - abs(places_m[100]), abs(places_m[600]) / 1000], rel=0.04)
