"""The cars of a film: where each is drawn, when it rests, and what the table and the advice say."""

import math
import re
from bisect import bisect_right
from itertools import accumulate, pairwise
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import airtrack
from airtrack import METHODS, PYTHON, Car, Scene, step, truth_of
from clock import Clock, Play, last_words, plain
from examples import CHANGED, EXAMPLES, OWN_SCENE
from films import collisions, film, lengths_s, states, states_of

Capture = pytest.CaptureFixture[str]
Places = list[dict[str, float]]


@pytest.fixture
def places(monkeypatch: pytest.MonkeyPatch) -> Places:
    """Where a film draws its cars, by their marks, frame by frame."""
    drawn = []
    render_track = airtrack.render_track

    def render(scene: Scene, places_m: dict[str, float], mark_m: float | None) -> str:
        drawn.append(places_m)
        return render_track(scene, places_m, mark_m)

    monkeypatch.setattr(airtrack, "render_track", render)
    return drawn


def ends_s(scene: Scene, frames: int) -> list[float]:
    """When each frame of a --fast film ends."""
    return list(accumulate(lengths_s(scene, frames)))


# The + of a changed example.

@pytest.mark.parametrize(("number", "changes"), [
    (8, {"fps_target": 20}), (8, {"fps_target": 7}), (4, {"fps_target": 10}),
    (7, {"fps_target": 100, "a_mps2": -3}), (9, {"jitter": 0.5}), (9, {"use_observed_dt": False}),
    (9, {"correction": "surface"}), (8, {"jitter": 0.3, "use_observed_dt": True}),
    (13, {"x_m": 1})])
def test_the_plus_is_where_a_film_of_the_example_as_it_is_has_its_car(
        number: int, changes: dict[str, Any], places: Places, capsys: Capture) -> None:
    words = [f"{name}={value}" for name, value in changes.items()]
    film(capsys, str(number), *words, "--frames=200")
    as_it_is = Scene(**EXAMPLES[number].settings)
    own_ends_s = ends_s(as_it_is, 6000)
    own_m = [as_it_is.x_m, *[x_m for x_m, *_ in states(number, 6000)]]
    film_ends_s = ends_s(Scene(**EXAMPLES[number].settings | changes), len(places))
    wanted_m = [own_m[bisect_right(own_ends_s, end_s + 1e-9)] for end_s in film_ends_s]
    assert [each["+"] for each in places] == wanted_m


def test_in_a_film_on_time_too_the_plus_is_where_the_example_as_it_is_would_be(
        clock: Clock, places: Places, play: Play) -> None:
    clock.when_drawn = lambda frame: 0.03 * (frame % 7)  # so that frames last unequally long
    play("11 CR=0.9 --frames 150")  # as it is, it is right in all frames, whatever they last
    truth = truth_of(Scene(**EXAMPLES[11].settings))
    first_s = lengths_s(truth, 1)[0]
    for moment_s, places_m in zip(clock.frames_s, places, strict=True):
        t_s = first_s + moment_s - clock.frames_s[0]
        assert places_m["+"] == pytest.approx(step(truth, 2.0, 0.0, t_s)[0], abs=1e-9)


# The table, told again.

def four_digits(number: float) -> str:
    return "0" if abs(number) < 0.001 else f"{number:.4g}"


def floor_m(scene: Scene) -> float:
    return scene.right_edge_m if scene.a_mps2 > 0 else scene.left_edge_m


def energy(scene: Scene, x_m: float, v_mps: float) -> float:
    height_m = x_m - scene.left_edge_m
    if scene.a_mps2 > 0:
        height_m = scene.right_edge_m - x_m
    return v_mps**2 / 2 + abs(scene.a_mps2) * height_m


def lies(scene: Scene, x_m: float, v_mps: float) -> bool:
    return scene.a_mps2 != 0 and v_mps == 0 and x_m == floor_m(scene)


def rest_frames(scene: Scene) -> int:
    """How many frames are asked on rest: a third of a second, but ten at least."""
    return max(10, round(scene.fps_target / 3))


def is_at_rest(scene: Scene, found: list[tuple[float, float]]) -> bool:
    """Whether a car rests that has had these places and velocities."""
    x_m, v_mps = found[-1]
    asked = rest_frames(scene)
    last = found[-asked:]
    if scene.a_mps2 == 0:
        return len(last) == asked and set(last) == {(x_m, 0.0)}
    if lies(scene, x_m, v_mps) or scene.correction == "replay":
        return lies(scene, x_m, v_mps)
    mean_m = math.fsum(abs(each_m - floor_m(scene)) for each_m, _ in last) / len(last)
    is_slow = abs(v_mps) <= abs(scene.a_mps2) * asked / scene.fps_target
    return len(last) == asked and mean_m <= 0.001 and is_slow


def end_of(scene: Scene, found: list[tuple[float, float]], moments_s: list[float]) -> str:
    """What a car does at the end that had these places and velocities at these moments."""
    asked = rest_frames(scene)
    if is_at_rest(scene, found):
        first = len(found)
        while first > 0 and is_at_rest(scene, found[:first]):
            first -= 1
        if not lies(scene, *found[first]):
            first -= asked - 1
        return f"rests from {moments_s[first]:.2f} s"
    are_on_track = [scene.left_edge_m <= x_m <= scene.right_edge_m for x_m, _ in found[-asked:]]
    if len(found) >= asked and not any(are_on_track):
        return "is beyond a wall"
    return "still moves"


def told_of(mark: str, scene: Scene, frames: int) -> tuple[str, str]:
    """A car's row and line in the table, if its frames are as long as planned."""
    truth, found = truth_of(scene), states_of(scene, frames)
    moments_s = ends_s(scene, frames)
    energies = [energy(scene, scene.x_m, scene.v_mps)]
    off_m = 0.0
    for (x_m, v_mps, _), moment_s in zip(found, moments_s, strict=True):
        energies.append(energy(scene, x_m, v_mps))
        off_m = max(off_m, abs(x_m - step(truth, truth.x_m, truth.v_mps, moment_s)[0]))
    name, off = f"{scene.motion} + {scene.correction}", f"{four_digits(off_m)} m"
    if off_m < 0.001:
        off = "under 1 mm"
    if mark == "o":
        name, off = "the truth", ""
    four = map(four_digits, (energies[0], min(energies), max(energies), energies[-1]))
    row = " ".join([mark, name, off, *four])
    hops = [str(after - before) for before, after in pairwise(collisions(found))]
    if len(hops) > 6:
        hops[4:-2] = ["..."]
    line = f"{mark} at {scene.fps_target:.4g} FPS: "
    if hops:
        line += " ".join(hops) + "; "
    return plain(row), line + end_of(scene, [(x_m, v_mps) for x_m, v_mps, _ in found], moments_s)


@pytest.mark.parametrize(("number", "changes", "frames"), [
    (20, {"correction": "conserve"}, 300), (1, {"a_mps2": 1.5}, 500), (21, {}, 200),
    (9, {"CR": 0.9}, 300), (3, {}, 200), (3, {}, 50),
    (3, {"correction": "surface", "left_edge_m": -0.5}, 100),
    (8, {"fps_target": 20}, 300), (12, {"correction": "replay"}, 200), (14, {}, 7), (14, {}, 9),
    (13, {"show_methods": True, "CR": 0.5}, 150), (99, {"v_mps": 3, "CR": 0.5}, 300),
    (99, {"v_mps": -3, "CR": 0}, 300), (99, {"a_mps2": -4, "x_m": 2.3}, 99)])
def test_the_table_tells_what_a_loop_of_one_s_own_finds(
        number: int, changes: dict[str, Any], frames: int, capsys: Capture) -> None:
    words = [f"{name}={value}" for name, value in changes.items()]
    shown = film(capsys, str(number), *words, f"--frames={frames}")
    as_it_is = EXAMPLES.get(number, OWN_SCENE).settings
    scene = Scene(**as_it_is | changes)
    scenes = {"*": scene}
    if set(changes) - {"show_methods"} and number in EXAMPLES:
        scenes["+"] = Scene(**as_it_is)
    if "+" in scenes or scene.show_exact_mark:
        scenes["o"] = truth_of(scene)
    if scene.show_methods:
        for letter, (motion, correction) in METHODS.items():
            scenes[letter] = Scene(**vars(scene) | {"motion": motion, "correction": correction})
    film_end_s = ends_s(scene, len(shown.lines))[-1] + 1e-9  # round-off
    told = [told_of(mark, each, bisect_right(ends_s(each, 1000), film_end_s))
            for mark, each in scenes.items()]
    rows, lines = shown.table[2:2 + len(told)], shown.table[4 + len(told):]
    assert list(zip(map(plain, rows), lines, strict=True)) == told


@pytest.mark.parametrize("words", [
    "99 v_mps=-1000 left_edge_m=-1000 right_edge_m=1000 x_m=-1000 a_mps2=-1000 CR=1 "
    "motion=forward fps_target=0.1001 show_methods=True --frames=2000",
    "99 x_m=-1000 v_mps=0.05 a_mps2=-6.5e-5 left_edge_m=-1000 right_edge_m=1000 CR=0.65 "
    "motion=exact correction=conserve fps_target=0.1001 --frames=9999"])
def test_the_table_has_80_columns_at_most_and_its_heads_stand_above_their_columns(
        words: str, capsys: Capture) -> None:
    table = film(capsys, *words.split()).table
    assert max(len(line) for line in table) <= 80
    heads = [match.end() for match in re.finditer("truth|first|least|most|last", table[1])]
    assert heads == [match.end() for match in re.finditer(r"\S+", table[2])][-5:]
    assert table[0].index("furthest") < table[1].index("truth") < table[0].index("energy")


# At rest.

@pytest.mark.parametrize(("words", "frames"), [
    # within a millimetre of the wall to which it is accelerated
    ("x_m=0.2509 a_mps2=-1e-6", 10), ("x_m=0.2511 a_mps2=-1e-6", 0),
    ("x_m=2.1991 a_mps2=1e-6", 10), ("x_m=2.2 a_mps2=-1e-9", 0),
    ("x_m=2 a_mps2=-1.5 CR=0", 46),  # it lies there, after a fall of 1.53 s
    # without an acceleration: wherever it does not move; 9.7 cm a frame, on a wall in frame 12
    ("x_m=1", 10), ("x_m=1 auto_off=False", 0), ("x_m=1 v_mps=1e-9", 0), ("v_mps=2.9 CR=0", 21),
    # ten frames, or a third of a second where that is more
    ("fps_target=10", 10), ("fps_target=50", 17), ("fps_target=240", 80),
    # while it still climbs, by |v| > |a| times that: v = 0.000333 after 14 frames
    ("x_m=0.25 v_mps=0.005 a_mps2=-0.0001", 0), ("x_m=0.25 v_mps=0.00079 a_mps2=-0.001", 14),
    ("x_m=2.2 v_mps=-0.00079 a_mps2=0.001", 14)])
def test_at_rest_is_a_third_of_a_second_within_a_millimetre_of_the_floor_or_without_a_move(
        words: str, frames: int, capsys: Capture) -> None:
    ending = film(capsys, "99", *words.split(), "--frames=400").ending
    assert ending.startswith(f"Stopped after {frames or 400} frames, ")
    assert ending.endswith(": the car is at rest." if frames else ": that is the frame limit.")


@given(x_m=st.sampled_from([0.25, 0.2505, 0.26, 0.3, 2.19, 2.1995, 2.2]),
       v_mps=st.floats(-0.3, 0.3), a_mps2=st.sampled_from([-9.81, -2.0, -0.1, 0.0, 2.0, 9.81]),
       CR=st.sampled_from([0, 0.3, 0.8, 1]), motion=st.sampled_from([*airtrack.MOTIONS]),
       correction=st.sampled_from(airtrack.ALL_CORRECTIONS),
       fps_target=st.sampled_from([4.0, 10.0, 30.0, 60.0, 240.0]))
def test_a_car_rests_in_the_frames_in_which_the_rule_says_so(**settings: Any) -> None:
    assume(settings["correction"] not in ("rewind", "replay") or settings["motion"] == "exact")
    scene = Scene(**settings)
    car, frames = Car(scene, Car(truth_of(scene))), 300
    found = [(x_m, v_mps) for x_m, v_mps, _ in states_of(scene, frames)]
    for frame in range(1, frames + 1):
        car.move(1 / scene.fps_target)
        assert (car.rest_began_s is not None) == is_at_rest(scene, found[:frame])


@pytest.mark.parametrize(("number", "height_m", "v_mps", "g"), [
    (20, 0.41, 0.75, 2), (22, 1.0, 0.0, 10), (12, 1.75, 0.0, 2)])
def test_the_true_car_rests_from_the_end_of_the_frame_that_holds_its_zeno_point(
        number: int, height_m: float, v_mps: float, g: float, capsys: Capture) -> None:
    speed_mps = math.sqrt(v_mps**2 + 2 * g * height_m)
    zeno_s = (v_mps + speed_mps) / g + 2 * speed_mps / g * 0.8 / (1 - 0.8)
    frames_s = ends_s(Scene(**EXAMPLES[number].settings), 250)
    end_s = frames_s[bisect_right(frames_s, zeno_s)]
    table = film(capsys, str(number), "show_exact_mark=True", "--frames=250").table
    true_car, = (line for line in table if line.startswith("o at "))
    assert true_car.endswith(f"rests from {end_s:.2f} s")


# What is a change, and what to try next.

@pytest.mark.parametrize(("words", "is_changed"), [
    ("10 CR=1", False), ("10 m_to_px=30 width_px=60 show_start_mark=False", False),
    ("10 show_methods=True auto_off=False fps_target=10.0 jitter=0", False), ("16 x_m=2", False),
    ("0 CR=0.7", True), ("10 x_m=2.000001", True), ("10 v_mps=-1", True),
    ("10 left_edge_m=0", True), ("13 motion=backward", True), ("10 fps_target=11", True),
    ("9 jitter=0.9", True), ("9 use_observed_dt=False", True)])
def test_a_changed_example_shows_the_plus_and_the_o_and_asks_what_the_change_does(
        words: str, is_changed: bool, places: Places, play: Play) -> None:
    number = int(words.split()[0])
    out = play(f"{words} --frames=3")
    assert ("+" in places[0]) is is_changed
    assert ("o" in places[0]) is (is_changed or number == 16)
    asked = CHANGED.look_for if is_changed else EXAMPLES[number].look_for
    assert plain(asked) in plain(out.partition("\n\n")[0])
    assert last_words(out).startswith(EXAMPLES[number].seen) is not is_changed
    assert (f"{PYTHON} airtrack.py stability {number} " in last_words(out)) is is_changed


def test_a_scene_of_one_s_own_shows_the_o_and_asks_of_it(places: Places, play: Play) -> None:
    assert plain(OWN_SCENE.look_for) in plain(play("99 --frames=1"))
    assert set(places[0]) == {"*", "o"}


@pytest.mark.parametrize(("number", "marks"), [(99, {"*"}), (10, {"*", "+"})])
def test_whoever_wants_no_o_gets_none_and_is_not_asked_of_it(
        number: int, marks: set[str], places: Places, play: Play) -> None:
    out = play(f"{number} CR=0.9 show_exact_mark=False --frames=1")
    assert set(places[0]) == marks
    assert "Does the * come to rest? The film begins" in plain(out)
    assert "\no the truth" not in out


@pytest.mark.parametrize(("words", "tries"), [
    ("8 fps_target=20", ["conserve, then rewind, then replay"]),
    ("8 motion=exact", ["conserve, then rewind, then replay"]),
    ("8 correction=conserve m_to_px=500", ["conserve, then rewind, then replay"]),
    ("8 motion=exact correction=conserve m_to_px=500", ["rewind, then replay"]),
    ("18 CR=0.9", ["replay"]), ("4 CR=0.7", ["conserve"]),
    ("4 motion=exact correction=conserve m_to_px=1000", []),
    ("8 motion=exact correction=rewind", []), ("99 v_mps=1 --frames=99", [])])
def test_what_to_try_is_told_only_where_it_applies_and_not_to_whom_has_it(
        words: str, tries: list[str], play: Play) -> None:
    told = last_words(play(f"{words} --frames=250"))
    assert re.findall(r"correction=([a-z, ]+)\.", told) == tries
    has_motion = "motion=exact" in words or words.startswith("18 ")
    assert ("motion=exact and" in told) is (tries != [] and not has_motion)


def test_a_film_without_a_bounce_claims_nothing(play: Play) -> None:
    for frames, is_told in ((13, False), (14, True)):  # it meets the wall in frame 14
        told = last_words(play(f"8 motion=exact correction=conserve --frames={frames}"))
        assert ("its method is right" in told) is is_told


def test_more_than_a_drawn_pixel_off_is_wrong_and_less_is_right(play: Play) -> None:
    found = [x_m for x_m, *_ in states(8, 100, fps_target=20)]
    truth = truth_of(Scene(**EXAMPLES[8].settings))
    off_m = max(abs(x_m - step(truth, 2.0, 0.0, frame / 20)[0])
                for frame, x_m in enumerate(found, 1))
    for a_pixel_m, is_right in ((1.001 * off_m, True), (0.999 * off_m, False)):
        told = last_words(play(f"8 fps_target=20 --frames=100 m_to_px={1 / a_pixel_m}"))
        assert (f" {off_m:.4g} m" in told) is not is_right
        assert f" pixel ({a_pixel_m:.2g} m)" in told
        assert ("So its method is right for this film." in told) is is_right
        assert ("correction=" in told) is not is_right


@pytest.mark.parametrize(("words", "command"), [
    ("8 fps_target=60", "stability 8"), ("-7 v_mps=1", "stability -7 v_mps=1"),
    ("1 CR=.90 motion=exact jitter=0.1 left_edge_m=0 x_m=1e0 m_to_px=20 width_px=90",
     "stability 1 CR=.90 left_edge_m=0 x_m=1e0 m_to_px=20 width_px=90")])
def test_the_map_is_advised_with_the_changes_that_it_takes_as_they_were_typed(
        words: str, command: str, play: Play) -> None:
    told = last_words(play(f"{words} --frames=3"))
    assert re.findall(rf"\? {PYTHON} airtrack\.py (.*) Next: ", told) == [command]
