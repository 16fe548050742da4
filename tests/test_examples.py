"""The examples: what their texts say of the films. The figures are worked out from the films."""

import math
import re
from itertools import pairwise

import pytest

from airtrack import METHODS, Car
from examples import EXAMPLES
from films import film, filmed

Capture = pytest.CaptureFixture[str]


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


def first_off(car: Car) -> int:
    """The first frame in which the car is not where its true car is."""
    return [frame.error_m() < 1e-9 for frame in car.frames].index(False)


@pytest.mark.parametrize(("words", "frame", "told_by"), [
    ("1", 251, 1), ("4", 1882, 4), ("5", 235, 6), ("6", 235, 6), ("12", 119, None),
    ("12 correction=replay", 119, None), ("19", 135, 19), ("22 motion=backward", 220, 22)])
def test_the_film_stops_in_this_frame_because_the_car_is_at_rest(
        words: str, frame: int, told_by: int | None, capsys: Capture) -> None:
    assert len(film(capsys, *words.split()).lines) == frame
    if told_by is not None:
        tells(told_by, f"{frame}")


def test_0_is_at_the_left_wall_after_45_s_and_flies_no_more() -> None:
    frames = filmed(0, 3000).frames
    assert frames[-1].x_m == pytest.approx(0.5, abs=1e-3)
    flies_s = [frame.t_s for frame in frames if frame.mark_m is None]
    tells(0, f"{flies_s[-1]:.0f} s")


def test_1_gets_back_less_far_each_time() -> None:
    tells(1, *[f"{x_m - 0.25:.2f} m" for x_m in turns_m(filmed(1, 240))[:3]])


def test_2_comes_out_of_the_walls_each_time() -> None:
    car = filmed(2, 1000)
    deepest_m = max(frame.x_m for frame in car.frames) - 2.2
    tells(2, f"{100 * deepest_m:.0f} cm", f"{100 * (car.frames[1].x_m - 1.65):.0f} cm")
    assert min(hops(car)) > 1


def test_3_is_caught_and_gets_out_of_the_picture(capsys: Capture) -> None:
    xs_m = [frame.x_m for frame in filmed(3, 600).frames]
    caught = bounces(filmed(3, 100))[0]
    tells(3, f"frame {caught}", f"{caught / 30:.2f} s", f"{1000 * (xs_m[500] - xs_m[501]):.0f} mm")
    assert max(xs_m[caught:]) < 0.25
    left = [line[0] for line in film(capsys, "3", "--frames=300").lines]
    assert 9 <= left.index("<") / 30 <= 10


def test_5_shows_a_0_for_few_of_its_bounces_and_6_is_the_same_motion(capsys: Capture) -> None:
    count = len(bounces(filmed(5, 235)))
    tells(5, f"{count}")
    five, six = film(capsys, "5", "d").lines, film(capsys, "6", "d").lines
    assert 0 < len([line for line in five if "0" in line[:135]]) < count / 2
    assert [line[135:] for line in five] == [line[135:] for line in six]
    coarse = film(capsys, "5", "fps_target=10", "--frames=100").lines
    for frame in bounces(filmed(5, 100, fps_target=10.0))[:5]:
        assert "0" in coarse[frame - 1]


def test_7_and_8_come_back_to_the_mark_every_second_time() -> None:
    fine, coarse = filmed(7, 1500), filmed(8, 150)
    turn_m, mark_m, *_ = turns_m(fine)
    frame = [frame.x_m for frame in fine.frames].index(turn_m)
    tells(7, f"{100 * (2 - turn_m):.1f} cm", f"frame {frame}", f"{frame / 240:.2f} s")
    assert mark_m == pytest.approx(2, abs=0.001)
    turn_m, mark_m, next_m, *_ = turns_m(coarse)
    tells(8, f"{turn_m:.2f} m", f"{100 * (2 - turn_m):.0f} cm", f"{hops(coarse)[0]} cm")
    assert mark_m == pytest.approx(2)
    assert next_m == pytest.approx(turn_m)


def test_9_wanders_and_gets_beyond_the_mark_after_about_half_a_minute() -> None:
    car = filmed(9, 400)
    tells(9, f"{turns_m(car)[0]:.2f} m")
    beyond_s = [frame.t_s for frame in car.frames if frame.x_m > 2.05]
    assert beyond_s[0] == pytest.approx(30, abs=3)


def test_10_and_11_come_back_to_the_mark_every_time() -> None:
    for number in (10, 11):
        turns = turns_m(filmed(number, 3000))
        assert len(turns) > 100
        assert {round(55 * turn_m) for turn_m in turns} == {110}
    tells(10, f"frame {bounces(filmed(10, 30))[0]}")


def test_12_is_4_mm_off_and_truly_rests_from_the_zeno_point_on() -> None:
    fall_s = math.sqrt(2 * 1.75 / 2)
    tells(12, f"{fall_s + 2 * fall_s * 0.8 / (1 - 0.8):.2f} s",
          f"{1000 * furthest_m(filmed(12, 119)):.1f} mm")


def test_13_is_ahead_of_the_truth_by_1_cm_more_in_each_frame() -> None:
    frames = filmed(13, 24).frames
    for number, frame in enumerate(frames):
        assert frame.x_m - frame.true_m == pytest.approx(0.01 * number)
    furthest = max(range(25), key=lambda number: frames[number].x_m)
    tells(13, f"{frames[furthest].x_m:.2f} m", f"frame {furthest}",
          f"{max(frame.true_m for frame in frames):.2f} m",
          f"frame {bounces(filmed(13, 40, motion='exact'))[0]}")


def test_14_is_thrown_out_and_15_creeps(capsys: Capture) -> None:
    marks = [line.strip(" |") for line in film(capsys, "14", "--frames=600").lines]
    assert marks == ["<", ">"] * 300
    thrown, creeping = filmed(14, 600).frames, filmed(15, 5).frames
    tells(14, f"{thrown[4].x_m - thrown[2].x_m:.1f} m", f"{thrown[-1].x_m / 1000:.1f} km")
    tells(15, f"{creeping[5].x_m - creeping[4].x_m:.1f} m")


def test_16_17_and_21_are_as_far_from_the_truth_as_is_told(capsys: Capture) -> None:
    a, b, c, d, e = [filmed(21, 200, motion=motion, correction=correction)
                     for motion, correction in METHODS.values()]
    for number in (16, 21):
        tells(number, f"{100 * a.frames[1].error_m():.0f} cm", f"{furthest_m(a):.1f} m")
    for number in (17, 21):
        tells(number, f"frame {first_off(b)}", f"{furthest_m(b):.1f} m")
    tells(21, f"{furthest_m(c):.1f} m")
    assert first_off(c) == first_off(b)
    assert {round(55 * turn_m) for turn_m in turns_m(c)} == {110}  # that of the start mark
    assert furthest_m(d) + furthest_m(e) < 1e-9
    lines = film(capsys, "21", "--frames=200").lines
    assert set("".join(lines)) == set(" |*.0abc")  # d and e are never seen


def test_18_misses_a_bounce() -> None:
    car = filmed(18, 4)
    assert bounces(car) == []
    tells(18, f"frame {first_off(car)}", f"{car.frames[4].error_m():.1f} m",
          f"{100 * (0.65 + 5**2 / 16 - 2.2):.0f} cm")  # it turns at x + v^2/(2 a)
    assert furthest_m(filmed(18, 80, correction="replay")) < 1e-9


def test_19_hops_one_line_shorter_each_time_and_with_motion_exact_one_longer() -> None:
    assert hops(filmed(19, 120)) == [*range(15, 1, -1)]
    assert hops(filmed(19, 250, motion="exact"))[:8] == [*range(18, 26)]


def test_20_hops_for_ever_in_9_lines_and_with_conserve_comes_to_rest(capsys: Capture) -> None:
    car = filmed(20, 1000)
    tells(20, ", ".join([str(hop) for hop in hops(car)[:3]]), f"frame {bounces(car)[3]}")
    assert set(hops(car)[3:]) == {9}
    speed_mps = math.sqrt(0.75**2 + 2 * 2 * 0.41)
    tells(20, f"{(0.75 + speed_mps) / 2 + speed_mps * 0.8 / (1 - 0.8):.2f} s")
    assert len(film(capsys, "20", "correction=conserve", "--frames=200").lines) < 200


def test_22_hops_for_ever_where_the_true_ball_rests() -> None:
    car = filmed(22, 2000)
    steady = hops(car)[-1]
    first = max(number for number, hop in enumerate(hops(car)) if hop != steady) + 1
    tells(22, f"frame {bounces(car)[first]}", f"{steady} lines",
          f"{1000 * max(frame.x_m for frame in car.frames[1000:]):.0f} mm",
          f"{math.sqrt(0.2) * (1 + 0.8) / (1 - 0.8):.2f} s")
