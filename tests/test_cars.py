"""The cars of a film: where each is drawn, when it rests, and what the table and the advice say."""

import math
import re
from bisect import bisect_right
from fractions import Fraction
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import airtrack
from airtrack import METHODS, PYTHON, Car, Scene, main, step, truth_of
from clock import Clock, Play, last_words, plain
from examples import CHANGED, EXAMPLES, OWN_SCENE
from films import film, lengths_s, states, states_of

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


# The + of a changed example.

def ends_s(scene: Scene, frames: int) -> list[Fraction]:
    """When each frame of a --fast film ends, without round-off."""
    fps = Fraction(scene.fps_target).limit_denominator(1000)
    jitter = Fraction(str(scene.jitter)) if scene.use_observed_dt else Fraction(0)
    lengths = [(1 + jitter * (2 * Fraction(618 * k % 1000, 1000) - 1)) / fps
               for k in range(1, frames + 1)]
    return list(accumulate(lengths))


@pytest.mark.parametrize(("number", "changes"), [
    (8, {"fps_target": 20}), (8, {"fps_target": 300}), (8, {"fps_target": 7}),
    (4, {"fps_target": 10}), (7, {"fps_target": 100, "a_mps2": -3}), (0, {"CR": 0.5}),
    (9, {"jitter": 0.5}), (9, {"use_observed_dt": False}), (9, {"correction": "surface"}),
    (8, {"jitter": 0.3, "use_observed_dt": True}), (8, {"jitter": 0.3}), (13, {"x_m": 1}),
    (20, {"motion": "backward", "fps_target": 30}), (3, {"right_edge_m": 3})])
def test_the_plus_is_where_a_film_of_the_example_as_it_is_has_its_car(
        number: int, changes: dict[str, Any], places: Places, capsys: Capture) -> None:
    words = [f"{name}={value}" for name, value in changes.items()]
    film(capsys, str(number), *words, "--frames=200")
    as_it_is = Scene(**EXAMPLES[number].settings)
    own_ends_s = ends_s(as_it_is, 6000)
    own_m = [as_it_is.x_m, *[x_m for x_m, *_ in states(number, 6000)]]
    film_ends_s = ends_s(Scene(**EXAMPLES[number].settings | changes), len(places))
    wanted_m = [own_m[bisect_right(own_ends_s, end_s)] for end_s in film_ends_s]
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

class Row(NamedTuple):
    """What the table says of a car: two lines, word by word."""

    words: list[str]
    end: str


def four_digits(number: float) -> str:
    return "0" if abs(number) < 0.001 else f"{number:.4g}"


def floor_m(scene: Scene) -> float:
    return scene.right_edge_m if scene.a_mps2 > 0 else scene.left_edge_m


def energy(scene: Scene, x_m: float, v_mps: float) -> float:
    """In J/kg: 0 for a car that stands still on the wall to which it is accelerated."""
    height_m = x_m - scene.left_edge_m
    if scene.a_mps2 > 0:
        height_m = scene.right_edge_m - x_m
    return v_mps**2 / 2 + abs(scene.a_mps2) * height_m


def lies(scene: Scene, x_m: float, v_mps: float) -> bool:
    return scene.a_mps2 != 0 and v_mps == 0 and x_m == floor_m(scene)


def rest_frames(scene: Scene) -> int:
    """How many frames are asked on rest: a third of a second, but ten at least."""
    return max(10, round(scene.fps_target / 3))


def is_at_rest(scene: Scene, last: list[tuple[float, float]]) -> bool:
    """Whether a car rests that had these places and velocities in the last frames."""
    x_m, v_mps = last[-1]
    if scene.a_mps2 == 0:
        return len(last) == rest_frames(scene) and set(last) == {(x_m, 0.0)}
    if lies(scene, x_m, v_mps) or scene.correction == "replay":
        return lies(scene, x_m, v_mps)
    mean_m = math.fsum(abs(each_m - floor_m(scene)) for each_m, _ in last) / len(last)
    asked_s = rest_frames(scene) / scene.fps_target
    is_slow = abs(v_mps) <= abs(scene.a_mps2) * asked_s
    return len(last) == rest_frames(scene) and mean_m <= 0.001 and is_slow


def end_of(scene: Scene, found: list[tuple[float, float]], ends_s: list[float]) -> str:
    """What a car does at the end, from its places and velocities in all frames."""
    asked = rest_frames(scene)
    rests = [is_at_rest(scene, found[max(0, frame - asked + 1):frame + 1])
             for frame in range(len(found))]
    if rests[-1]:
        first = len(rests) - [*rests[::-1], False].index(False)
        if not lies(scene, *found[first]):
            first -= asked - 1
        return f"rests from {ends_s[first]:.2f} s"
    are_on_track = [scene.left_edge_m <= x_m <= scene.right_edge_m for x_m, _ in found[-asked:]]
    if len(found) >= asked and not any(are_on_track):
        return "is beyond a wall"
    return "moves"


def row_of(mark: str, scene: Scene, frames: int) -> Row:
    """The row of a car whose frames are as long as planned."""
    truth = truth_of(scene)
    name = "the truth" if mark == "o" else f"{scene.motion} + {scene.correction}"
    moments_s = list(accumulate(lengths_s(scene, frames)))
    found = states_of(scene, frames)
    trues_m = [step(truth, truth.x_m, truth.v_mps, moment_s)[0] for moment_s in moments_s]
    off_m = max(abs(x_m - true_m) for (x_m, *_), true_m in zip(found, trues_m, strict=True))
    energies = [energy(scene, scene.x_m, scene.v_mps)]
    energies += [energy(scene, x_m, v_mps) for x_m, v_mps, _ in found]
    told = [energies[0], min(energies), max(energies), energies[-1]]
    off = [four_digits(off_m), "m"]
    if off_m < 0.001:
        off = ["under", "1", "mm"]
    if mark == "o":
        off = []
    met = [frame for frame, (*_, mark_m) in enumerate(found, 1) if mark_m is not None]
    hops = [str(after - before) for before, after in pairwise(met)]
    if len(hops) > 6:
        hops[4:-2] = ["..."]
    line = f"{mark} at {scene.fps_target:.4g} FPS: "
    if hops:
        line += " ".join(hops) + "; "
    places = [(x_m, v_mps) for x_m, v_mps, _ in found]
    return Row([mark, *name.split(), *off, *map(four_digits, told)],
               line + end_of(scene, places, moments_s))


@pytest.mark.parametrize(("number", "changes", "frames"), [
    (20, {"correction": "conserve"}, 500), (5, {"CR": 1}, 300), (1, {"a_mps2": 1.5}, 500),
    (21, {}, 200), (9, {"CR": 0.9}, 300), (22, {"motion": "backward"}, 500), (3, {}, 200),
    (3, {"correction": "surface", "left_edge_m": -0.5}, 100), (8, {"fps_target": 20}, 300),
    (12, {"correction": "replay"}, 200), (18, {"correction": "replay"}, 200), (2, {}, 200),
    (0, {"CR": 0.5, "fps_target": 20}, 400), (13, {"show_methods": True, "CR": 0.5}, 150),
    (8, {}, 45), (14, {}, 60), (14, {}, 9), (4, {}, 2000), (1, {"CR": 0}, 200),
    (99, {"v_mps": 3, "CR": 0.5}, 300), (99, {"v_mps": -3, "CR": 0}, 300),
    (99, {"a_mps2": 4, "motion": "exact"}, 500),
    (20, {"correction": "conserve", "fps_target": 50}, 400),
    (99, {"a_mps2": -4, "show_exact_mark": False, "x_m": 2.3}, 99), (20, {"x_m": 2.2}, 7)])
def test_the_table_tells_what_a_loop_of_one_s_own_finds(
        number: int, changes: dict[str, Any], frames: int, capsys: Capture) -> None:
    words = [f"{name}={value}" for name, value in changes.items()]
    shown = film(capsys, str(number), *words, f"--frames={frames}")
    as_it_is = EXAMPLES.get(number, OWN_SCENE).settings
    scene = Scene(**as_it_is | changes)
    moved = set(changes) - {"show_methods", "show_exact_mark"}
    scenes = {"*": scene}
    if moved and number in EXAMPLES:
        scenes["+"] = Scene(**as_it_is)
    if "+" in scenes or scene.show_exact_mark:
        scenes["o"] = truth_of(scene)
    if scene.show_methods:
        for letter, (motion, correction) in METHODS.items():
            scenes[letter] = Scene(**vars(scene) | {"motion": motion, "correction": correction})
    film_end_s = ends_s(scene, len(shown.lines))[-1]
    rows = []
    for mark, each in scenes.items():
        own_frames = bisect_right(ends_s(each, 2000), film_end_s)
        rows.append(row_of(mark, each, own_frames))
    assert [line.split() for line in shown.table[2:2 + len(rows)]] == [row.words for row in rows]
    assert shown.table[3 + len(rows):] == [row.end for row in rows]


def test_the_table_has_80_columns_at_most_and_its_heads_stand_above_their_columns(
        capsys: Capture) -> None:
    for words in ("99 v_mps=-1000 left_edge_m=-1000 right_edge_m=1000 x_m=-1000 a_mps2=-1000 CR=1 "
                  "motion=forward fps_target=0.1001 show_methods=True",
                  "22 v_mps=1000 left_edge_m=-1000 right_edge_m=-999.99 a_mps2=999.9 CR=0.9999 "
                  "motion=backward correction=conserve fps_target=666.66 use_observed_dt=True",
                  "99 x_m=-1000 v_mps=0.05 a_mps2=-6.5e-7 left_edge_m=-1000 right_edge_m=1000 "
                  "CR=0.65 motion=exact correction=conserve fps_target=0.1001 --frames=50000"):
        table = film(capsys, "--frames=9999", *words.split()).table
        assert max(len(line) for line in table) <= 80
        heads = [match.end() for match in re.finditer("car|first|least|most|last", table[1])]
        assert heads == [match.end() for match in re.finditer(r"\S+", table[2])][-5:]
        assert table[0].index("furthest") < table[1].index("car") < table[0].index("energy")
    longest = r"\* at 0\.1001 FPS: \d{5} (\d{4} ){3}\.\.\. \d+ \d+; rests from \d{6}\.\d\d s"
    assert re.fullmatch(longest, table[-2])


# At rest.

@pytest.mark.parametrize(("words", "frames"), [
    # within a millimetre of the wall to which it is accelerated
    ("x_m=0.2509 a_mps2=-1e-6", 10), ("x_m=0.2511 a_mps2=-1e-6", 0),
    ("x_m=2.1991 a_mps2=1e-6", 10), ("x_m=2.1989 a_mps2=1e-6", 0),
    ("x_m=2.2 a_mps2=-1e-9", 0), ("x_m=0.25 a_mps2=1e-9", 0), ("x_m=2.2 a_mps2=-0.01", 0),
    # without an acceleration: wherever it does not move; 9.7 cm a frame, on a wall in frame 12 or 9
    ("x_m=1", 10), ("x_m=1 auto_off=False", 0), ("x_m=1 v_mps=1e-9", 0),
    ("v_mps=2.9 CR=0", 21), ("v_mps=-2.9 CR=0", 18),
    # ten frames, or a third of a second where that is more
    ("fps_target=10", 10), ("fps_target=50", 17), ("fps_target=240", 80), ("fps_target=999", 333),
    # while it still climbs, by |v| > |a| times that: v = 0.000333 after 14 frames, 0.0001 after 15
    ("x_m=0.25 v_mps=0.005 a_mps2=-0.0001", 0), ("x_m=0.25 v_mps=0.0006 a_mps2=-0.001", 10),
    ("x_m=0.25 v_mps=0.00079 a_mps2=-0.001", 14), ("x_m=2.2 v_mps=-0.00079 a_mps2=0.001", 14),
    ("x_m=0.25 v_mps=0.000245 a_mps2=-0.0001 fps_target=10", 15)])
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
    is_legal = settings["correction"] not in ("rewind", "replay") or settings["motion"] == "exact"
    assume(is_legal)
    scene = Scene(**settings)
    car, frames = Car(scene, Car(truth_of(scene))), 300
    found = [(x_m, v_mps) for x_m, v_mps, _ in states_of(scene, frames)]
    for frame in range(1, frames + 1):
        car.move(1 / scene.fps_target)
        last = found[:frame][-rest_frames(scene):]
        assert car.is_at_rest() == (car.rest_began_s is not None) == is_at_rest(scene, last)


@pytest.mark.parametrize(("words", "height_m", "v_mps", "g", "told"), [
    ("20 --frames=80", 0.41, 0.75, 2, "o at 10 FPS: 12 9 8 6 ... 1 1; rests from 7.10 s"),
    ("22 --frames=250", 1.0, 0.0, 10, "rests from 4.03 s"),
    ("12 correction=replay", 1.75, 0.0, 2, "rests from 11.98 s")])
def test_the_true_car_rests_from_the_end_of_the_frame_that_holds_its_zeno_point(
        words: str, height_m: float, v_mps: float, g: float, told: str, capsys: Capture) -> None:
    speed_mps = math.sqrt(v_mps**2 + 2 * g * height_m)
    zeno_s = (v_mps + speed_mps) / g + 2 * speed_mps / g * 0.8 / (1 - 0.8)
    scene = Scene(**EXAMPLES[int(words[:2])].settings)
    frame = bisect_right(ends_s(scene, 250), zeno_s)
    assert f"{float(ends_s(scene, 250)[frame]):.2f}" in told
    shown = film(capsys, *words.split())
    true_car, = (line for line in shown.table if line.startswith("o at "))
    assert true_car.endswith(told)
    if "replay" in words:
        assert shown.ending == "Stopped after 120 frames, t = 11.98 s: the car is at rest."
        assert frame == 119


def test_without_a_bounce_back_a_car_rests_at_its_first_contact(capsys: Capture) -> None:
    fall_s = math.sqrt(2 * 1.75 / 1.5)
    frame = math.ceil(fall_s * 30)
    t = f"{frame / 30:.2f} s"
    shown = film(capsys, "1", "CR=0")
    assert shown.ending == f"Stopped after {frame} frames, t = {t}: the car is at rest."
    assert f"* at 30 FPS: rests from {t}" in shown.table


# What is a change, and what to try next.

@pytest.mark.parametrize(("words", "is_changed"), [
    ("10", False), ("10 CR=1", False), ("10 m_to_px=30", False), ("10 show_methods=True", False),
    ("10 width_px=60 show_start_mark=False show_collision_mark=False", False), ("0 CR=0.8", False),
    ("10 auto_off=False fps_target=10.0", False), ("10 jitter=0", False), ("16 x_m=2", False),
    ("0 CR=0.7", True), ("10 x_m=2.000001", True), ("10 v_mps=-1", True), ("10 a_mps2=-3", True),
    ("10 left_edge_m=0", True), ("10 right_edge_m=3", True), ("10 CR=0.9", True),
    ("10 correction=conserve", True), ("13 motion=backward", True), ("10 fps_target=11", True),
    ("9 jitter=0.9", True), ("9 use_observed_dt=False", True)])
def test_a_changed_example_shows_the_plus_and_the_o_and_asks_what_the_change_does(
        words: str, is_changed: bool, places: Places, play: Play) -> None:
    number = int(words.split()[0])
    out = play(f"{words} --frames=3")
    marks = set(places[0])
    assert ("+" in marks) is is_changed
    assert ("o" in marks) is (is_changed or number == 16)
    asked = CHANGED.look_for if is_changed else EXAMPLES[number].look_for
    assert plain(asked) in plain(out.partition("\n\n")[0])
    assert last_words(out).startswith(EXAMPLES[number].seen) is not is_changed
    assert (f"{PYTHON} airtrack.py stability {number} " in last_words(out)) is is_changed
    assert last_words(out).endswith(f"Next: {PYTHON} airtrack.py {number + 1}")


def test_a_scene_of_one_s_own_shows_the_o_and_asks_of_it_unless_that_is_not_wanted(
        places: Places, play: Play) -> None:
    assert plain(OWN_SCENE.look_for) in plain(play("99 --frames=3"))
    out = play("99 show_exact_mark=False --frames=3")
    assert [set(each) for each in places] == [{"*", "o"}] * 3 + [{"*"}] * 3
    assert "The * is your car, and the o is the true car." not in plain(out)
    assert "\no the truth" not in out


@pytest.mark.parametrize(("words", "tries"), [
    ("8 fps_target=20", ["conserve or rewind or replay"]),
    ("99 a_mps2=-2 --frames=99", ["conserve or rewind or replay"]),
    ("8 motion=exact", ["conserve or rewind or replay"]),
    ("8 correction=conserve m_to_px=500", ["conserve or rewind or replay"]),
    ("8 motion=exact correction=conserve m_to_px=500", ["rewind or replay"]),
    ("18 CR=0.9", ["replay"]), ("4 CR=0.7", ["conserve"]),
    ("4 motion=exact correction=conserve m_to_px=1000", []),
    ("8 motion=exact correction=rewind", []), ("99 v_mps=1 --frames=99", [])])
def test_what_to_try_is_told_only_where_it_applies_and_not_to_whom_has_it(
        words: str, tries: list[str], play: Play) -> None:
    told = last_words(play(f"{words} --frames=250"))
    assert re.findall(r"correction=([a-z ]+)\.", told) == tries
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
        assert f" {off_m:.4g} m" in told
        assert f" pixel ({a_pixel_m:.2g} m)" in told
        assert ("So its method is right for this film." in told) is is_right
        assert ("correction=" in told) is not is_right


@pytest.mark.parametrize(("words", "taken"), [
    ("5 CR=1", "5 CR=1"), ("8 fps_target=60", "8"), ("-7 v_mps=1", "-7 v_mps=1"),
    ("8 CR=.90 motion=exact correction=none jitter=0.1 use_observed_dt=True a_mps2=-2.50 x_m=1e0",
     "8 CR=.90 a_mps2=-2.50 x_m=1e0"),
    ("1 left_edge_m=0 right_edge_m=2 v_mps=+1 m_to_px=20 width_px=90 auto_off=False",
     "1 left_edge_m=0 right_edge_m=2 v_mps=+1 m_to_px=20")])
def test_the_map_is_advised_with_the_changes_that_it_takes_as_they_were_typed(
        words: str, taken: str, monkeypatch: pytest.MonkeyPatch, play: Play) -> None:
    told = last_words(play(f"{words} --frames=3"))
    command, = re.findall(rf"\? {PYTHON} airtrack\.py (.*) Next: ", told)
    assert command == f"stability {taken}"
    asked: list[Scene] = []
    monkeypatch.setitem(airtrack.COMMANDS, "stability", lambda scene, _: asked.append(scene))
    assert main(command.split()) == 0
    for change in taken.split()[1:]:
        name, _, text = change.partition("=")
        assert getattr(asked[0], name) == float(text)
