"""The examples: what their texts say of the films. The figures are worked out from the films."""

import math
import re
from itertools import pairwise
from typing import Any

import pytest

from airtrack import METHODS, Car, rest_began_s
from examples import EXAMPLES
from films import filmed, shown

TRUTH = {"motion": "exact", "correction": "replay"}


def tells(number: int, *figures: str) -> None:
    """The text after the film has these figures."""
    for figure in figures:
        pattern = rf"(?<![\d.]){re.escape(figure)}(?!\d|\.\d)"
        assert re.search(pattern, EXAMPLES[number].seen), figure


def bounces(car: Car) -> list[int]:
    """The frames in which a collision was found."""
    return [number for number, frame in enumerate(car.frames) if frame.mark_m is not None]


def hops(car: Car) -> list[int]:
    """How many frames there are from bounce to bounce."""
    return [after - before for before, after in pairwise(bounces(car))]


def turns_m(car: Car) -> list[float]:
    """Where the car turned on its way to the right."""
    xs_m = [frame.x_m for frame in car.frames]
    return [xs_m[n] for n in range(1, len(xs_m) - 1) if xs_m[n - 1] <= xs_m[n] > xs_m[n + 1]]


def furthest_m(car: Car) -> float:
    """How far the car was from its true car at most."""
    return max(frame.error_m() for frame in car.frames)


@pytest.mark.parametrize(("words", "frame", "told_by"), [
    ("1", 251, 1), ("4", 1882, 4), ("5", 235, 6), ("6", 235, 6), ("12", 119, None),
    ("12 correction=replay", 119, None), ("19", 135, 19), ("22 motion=backward", 220, 22)])
def test_the_film_stops_in_this_frame(words: str, frame: int, told_by: int | None) -> None:
    assert len(shown(words).lines) == frame
    if told_by is not None:
        tells(told_by, f"{frame}")


@pytest.mark.parametrize(("number", "frame", "changes"), [
    (3, 46, {}), (10, 14, {}), (13, 25, {"motion": "exact"}), (17, 14, {}), (21, 14, {}),
    (21, 14, {"correction": "conserve"})])
def test_the_first_bounce_is_in_this_frame(
        number: int, frame: int, changes: dict[str, Any]) -> None:
    assert bounces(filmed(number, 100, **changes))[0] == frame
    tells(number, f"frame {frame}")


@pytest.mark.parametrize(("number", "turns"), [
    (8, ["1.88"]), (9, ["1.81"]), (13, ["1.91"]), (1, ["0.87", "0.46", "0.21"])])
def test_the_car_turns_at_this_place(number: int, turns: list[str]) -> None:
    from_m = 0.25 if number == 1 else 0  # example 1 counts from the wall
    assert [f"{x_m - from_m:.2f}" for x_m in turns_m(filmed(number, 240))[:len(turns)]] == turns
    tells(number, *turns)


@pytest.mark.parametrize(("number", "unit_m", "off", "frames", "changes"), [
    (12, 0.001, "4.2", 119, {}), (16, 1, "0.9", 200, {}), (17, 1, "1.8", 200, {}),
    (21, 1, "0.9", 200, {"motion": "backward", "correction": "rebound"}),
    (21, 1, "1.8", 200, {"correction": "rebound"}), (21, 1, "0.9", 200, {"correction": "conserve"})])
def test_the_car_gets_so_far_from_the_truth(
        number: int, unit_m: float, off: str, frames: int, changes: dict[str, Any]) -> None:
    assert f"{furthest_m(filmed(number, frames, **changes)) / unit_m:.1f}" == off
    tells(number, off)


@pytest.mark.parametrize(("number", "first_hops", "changes"), [
    (19, [*range(15, 4, -1)], {}), (19, [*range(18, 26)], {"motion": "exact"}),
    (20, [14, 12, 10, *[9] * 50], {})])
def test_the_hops_take_so_many_lines(
        number: int, first_hops: list[int], changes: dict[str, Any]) -> None:
    assert hops(filmed(number, 600, **changes))[:len(first_hops)] == first_hops
    tells(number, ", ".join([str(hop) for hop in first_hops[:3]]))


@pytest.mark.parametrize(("number", "height_m", "v_mps", "g", "rest_s"), [
    (12, 1.75, 0, 2, "10.99"), (20, 0.41, 0.75, 2, "6.10"), (22, 1, 0, 10, "3.78")])
def test_the_true_car_lies_still_from_the_zeno_point_on_and_is_called_at_rest_before(
        number: int, height_m: float, v_mps: float, g: float, rest_s: str) -> None:
    speed_mps = math.sqrt(v_mps**2 + 2 * g * height_m)
    zeno_s = (v_mps + speed_mps) / g + 2 * speed_mps / g * 0.8 / (1 - 0.8)
    truth = filmed(number, 300, **TRUTH)
    lies_s = [frame.t_s for frame in truth.frames[1:] if frame.v_mps == 0]
    assert 0 <= lies_s[0] - zeno_s < 0.125  # in the same frame
    assert f"{rest_began_s(truth):.2f}" == rest_s
    tells(number, f"{zeno_s:.2f} s", f"{rest_s} s")


def test_0_is_at_the_left_wall_after_45_s_and_flies_no_more() -> None:
    frames = filmed(0, 3000).frames
    assert frames[-1].x_m == pytest.approx(0.5, abs=1e-3)
    tells(0, f"{max(frame.t_s for frame in frames if frame.mark_m is None):.0f} s")


def test_2_comes_out_of_the_walls_each_time() -> None:
    car = filmed(2, 1000)
    tells(2, f"{100 * (max(frame.x_m for frame in car.frames) - 2.2):.0f} cm")
    assert min(hops(car)) > 1


def test_3_is_caught_and_gets_out_of_the_picture() -> None:
    xs_m = [frame.x_m for frame in filmed(3, 600).frames]
    assert max(xs_m[46:]) < 0.25
    tells(3, f"{1000 * (xs_m[500] - xs_m[501]):.0f} mm")
    assert 270 <= [line[0] for line in shown("3 --frames=300").lines].index("<") <= 300


def test_5_shows_a_0_for_few_of_its_bounces_and_6_is_the_same_motion() -> None:
    five, six = shown("5 d").lines, shown("6 d").lines
    count = len(bounces(filmed(5, 235)))
    tells(5, f"{count}")
    assert 0 < len([line for line in five if "0" in line[:135]]) < count / 2
    assert [line[135:] for line in five] == [line[135:] for line in six]


@pytest.mark.parametrize("number", [7, 8])
def test_7_and_8_come_back_to_the_mark_every_second_time(number: int) -> None:
    car = filmed(number, 2000)
    turn_m, mark_m, next_m, *_ = turns_m(car)
    assert mark_m == pytest.approx(2, abs=0.001)
    assert next_m == pytest.approx(turn_m, abs=0.001)
    tells(number, f"{100 * (2 - turn_m):.2g} cm")
    if number == 7:
        tells(7, f"frame {[frame.x_m for frame in car.frames].index(turn_m)}")


def test_9_gets_beyond_the_mark_after_about_half_a_minute() -> None:
    beyond_s = [frame.t_s for frame in filmed(9, 400).frames if frame.x_m > 2.05]
    assert beyond_s[0] == pytest.approx(30, abs=3)


@pytest.mark.parametrize(("number", "changes"), [
    (10, {}), (11, {}), (17, {"correction": "conserve"}), (21, {})])
def test_the_car_comes_back_to_the_mark_every_time(number: int, changes: dict[str, Any]) -> None:
    turns = turns_m(filmed(number, 2000, **changes))
    assert {round(55 * turn_m) for turn_m in turns} == {110}


def test_13_is_1_cm_further_ahead_of_the_truth_in_each_frame() -> None:
    for number, frame in enumerate(filmed(13, 24).frames):
        assert frame.x_m - frame.true_m == pytest.approx(0.01 * number)


def test_14_is_thrown_out_and_15_creeps() -> None:
    lines = shown("14 --frames=600").lines
    assert [line.strip(" |") for line in lines] == ["<", ">"] * 300
    thrown, creeping = filmed(14, 600).frames, filmed(15, 5).frames
    tells(14, f"{thrown[4].x_m - thrown[2].x_m:.1f} m", f"{thrown[-1].x_m / 1000:.1f} km")
    tells(15, f"{creeping[5].x_m - creeping[4].x_m:.1f} m")


def test_18_misses_a_bounce() -> None:
    car = filmed(18, 4)
    assert bounces(car) == []
    tells(18, f"{car.frames[4].error_m():.1f} m", f"{100 * (0.65 + 5**2 / 16 - 2.2):.0f} cm")
    assert furthest_m(filmed(18, 80, **TRUTH)) < 1e-9


def test_of_five_methods_two_are_never_seen() -> None:
    assert set("".join(shown("21 --frames=200").lines)) == set(" |*.0abc")
    for letter in "de":
        motion, correction = METHODS[letter]
        assert furthest_m(filmed(21, 200, motion=motion, correction=correction)) < 1e-9


def test_22_hops_for_ever_in_hops_of_one_length_and_height() -> None:
    car = filmed(22, 2000)
    steady = hops(car)[-1]
    first = max(number for number, hop in enumerate(hops(car)) if hop != steady) + 1
    tells(22, f"frame {bounces(car)[first]}", f"{steady} lines",
          f"{1000 * max(frame.x_m for frame in car.frames[1000:]):.0f} mm")
