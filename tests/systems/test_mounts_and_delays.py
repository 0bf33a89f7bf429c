"""Sensors with names, lever arms and delays, from the world file to the filter."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ekfsim.errors import InputError, UsageError
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.files.scenes.load import load_scene, load_world, read_scene
from ekfsim.files.scenes.settings import setting
from ekfsim.localization import localize, play
from ekfsim.records import Control, Reading
from ekfsim.simulation import simulate
from ekfsim.smoothing import smooth
from ekfsim.systems.instruments import Gnss, Ultrasonic
from ekfsim.twins import taking
from ekfsim.views.picture.sights import sight
from ekfsim.views.words.beams.beam import beam

GNSS = "name: field\nsystem: gnss\nstart: {x: 0, y: 0, theta: 30}\nrobot: {rate: 20}\n"
TWO = (
    "sensors:\n  - gnss: {name: front, mount: {x: 0.8}, sigma: 0.05, rate: 2}\n"
    "  - gnss: {name: rear, mount: {x: -0.5, y: 0.2}, sigma: 0.1, rate: 1, delay: 0.3}\n"
)
CIRCLE = {"path": "circle", "radius": 3, "laps": 0.5}


def scene_of(tmp_path, world, drive=CIRCLE, settings=()):
    (tmp_path / "world.yaml").write_text(world, encoding="utf-8")
    told = tmp_path / "commands.yaml"
    way = ", ".join(f"{key}: {value}" for key, value in drive.items())
    told.write_text(f"world: world.yaml\ndrive: {{{way}}}\n", encoding="utf-8")
    return read_scene(told, settings=[setting(one) for one in settings]).get()


def readings(entries, name):
    return [e for e in entries if isinstance(e.given, Reading) and e.given.name == name]


def test_several_of_one_kind_are_told_apart_by_their_names(tmp_path):
    more = "belief: {sensors: {rear: {sigma: 0.3}}}\nfaults: {sensors: {front: {xBias: 2}}}\n"
    scene = scene_of(tmp_path, GNSS + TWO + more)
    front, rear = scene.world.told_instruments
    assert (front.called, front.sigma, rear.called, rear.sigma) == ("front", 0.05, "rear", 0.3)
    assert set(scene.world.drive_faults.sensors) == {"front"}
    entries = list(simulate(scene))
    ends = len(readings(entries, "front")), len(readings(entries, "rear"))
    assert ends[0] == pytest.approx(2 * ends[1], abs=1)
    off = [e.given.z[0] - e.given.sensor.h(scene.world.layout.state(e.truth))[0]
           for e in readings(entries, "front")]  # fmt: skip
    assert np.mean(off) == pytest.approx(2, abs=0.1)


def test_a_setting_finds_its_sensor_by_its_name(tmp_path):
    settings = ["sensors.rear.sigma=0.2", "sensors.rear.mount.theta=90", "sensors.front.delay=0.1",
                "belief.sensors.front.mount.x=0.9", "faults.sensors.rear.xBias=1"]  # fmt: skip
    world = scene_of(tmp_path, GNSS + TWO, settings=settings).world
    front, rear = world.instruments
    assert (rear.sigma, rear.mount) == (0.2, (-0.5, 0.2, pytest.approx(math.pi / 2)))
    assert (front.delay, front.mount.x, world.told_instruments[0].mount.x) == (0.1, 0.8, 0.9)
    assert world.told_instruments[0].delay == 0.1
    assert world.drive_faults.sensors["rear"].bias[0] == 1


@pytest.mark.parametrize(
    ("key", "line"),
    [
        ("sensors.reer.sigma=1", "the world has no sensor 'reer'; did you mean 'rear'?"),
        ("sensors.gnss.sigma=1", "the world has no sensor 'gnss'; it has: front, rear"),
        (
            "belief.sensors.rear.delay=0.5",
            "the filter takes readings of 'rear' for 0.2 s older than they are, and would use "
            "them before they are made; write at most 0.3 as the delay in the world's "
            "belief.sensors",
        ),
        ("belief.sensors.rear.height=1", "unknown key 'height'; known keys of a sensor gnss: "
         "mount, delay, sigma"),
        ("sensors.rear.sgima=1", "unknown key 'rear'; known: markers, rangeBearing, range, "
         "bearing, gnss, pylon, lidar, ultrasonic, infrared, compass, gyro"),
    ],
)  # fmt: skip
def test_a_setting_of_none_is_told(tmp_path, key, line):
    with pytest.raises(UsageError) as refusal:
        scene_of(tmp_path, GNSS + TWO, settings=[key])
    assert str(refusal.value) == f"--set {key}: {line}"


def test_names_that_cannot_be_told_apart_are_refused(tmp_path):
    file = tmp_path / "world.yaml"
    items = "{name: rear}", "{name: rear}", "{name: compass}", "{name: 2nd}"
    file.write_text(GNSS + "sensors:\n" + "".join(f"  - gnss: {one}\n" for one in items))
    with pytest.raises(InputError) as refusal:
        load_world(file)
    assert [str(one).partition("world.yaml:")[2] for one in refusal.value.mistakes] == [
        "7:18: sensors[1].gnss.name: the sensor 'rear' on line 6 goes by the same name; give each "
        "a name of its own",
        "8:18: sensors[2].gnss.name: 'compass' is what sensors of another kind are called; write "
        "e.g. name: my-compass",
        "9:18: sensors[3].gnss.name: '2nd' is no name; write one line of text, e.g. rear",
    ]


def test_the_truth_is_measured_from_where_the_antenna_is(tmp_path):
    """Without noise: the fix is the pose and the arm turned by the true heading."""
    quiet = TWO.replace("sigma: 0.05", "sigma: 0").replace("sigma: 0.1", "sigma: 0")
    entries = list(simulate(scene_of(tmp_path, GNSS + quiet)))
    for name, arm in (("front", 0.8), ("rear", -0.5 + 0.2j)):
        fixes = readings(entries, name)
        assert len(fixes) > 5
        for e in fixes:
            x, y, θ = e.truth
            at = x + 1j * y + arm * np.exp(1j * θ)
            np.testing.assert_allclose(e.given.z, [at.real, at.imag], atol=1e-9)


def test_a_lever_arm_tells_the_heading_and_one_not_told_of_makes_the_filter_over_confident(
    tmp_path,
):
    fast = GNSS.replace("rate: 20", "rate: 100, turnDensity: 3")
    world = fast + "sensors: [{gnss: {mount: {x: 1.0}, sigma: 0.02, rate: 5}}]\n"
    told, untold = (
        scene_of(tmp_path, world + more, {"path": "circle", "radius": 3, "laps": 0.15})
        for more in ("", "belief: {sensors: {gnss: {mount: {x: 0}}}}\n")
    )
    errors = []
    for scene in (told, untold):
        steps = list(play(scene, np.arange(40)))
        errors.append((np.mean(steps[-1].nees.value), steps[-1].posterior.covariance))
    assert errors[0][0] == pytest.approx(3, abs=1.2)
    assert errors[1][0] > 30
    scene = told
    with taking("plain"):
        plain = list(play(scene, np.arange(3)))[-1]
    quick = list(play(scene, np.arange(3)))[-1]
    np.testing.assert_allclose(quick.posterior.mean, plain.posterior.mean, rtol=0, atol=1e-9)


def test_a_view_looks_where_the_camera_is_turned(tmp_path):
    """Turned about, and half a metre behind: what is ahead of the robot is out of its sight."""
    world = (
        "name: yard\nsystem: landmarks\nstart: {x: 0, y: 0, theta: 0}\nrobot: {rate: 5}\n"
        "landmarks: [{id: 1, x: 3, y: 0}, {id: 2, x: -3, y: 0}, {id: 3, x: -5.4, y: 0}]\n"
        "sensors: [{rangeBearing: {range: 5, mount: {x: -0.5, theta: 180}}}]\n"
    )
    (instrument,) = scene_of(tmp_path, world).world.instruments
    seen = scene_of(tmp_path, world).world.targets("corrected")
    pose = np.zeros(3)
    assert [bool(instrument.sees(target, pose)) for _, target in seen] == [False, True, True]
    assert seen[1][1].sensor.h(pose) == pytest.approx([2.5, 0])


def test_a_picture_begins_a_beam_where_the_sensor_sits(tmp_path):
    world = (
        "name: room\nsystem: pioneer\nstart: {x: 0, y: 0, theta: 90}\n"
        "boundary: [[-4, -4], [4, -4], [4, 4], [-4, 4]]\n"
        "sensors: [{ultrasonic: {bearings: [0], range: 9, mount: {x: 0.3, y: 0.2, theta: -90}}}]\n"
    )
    scene = scene_of(tmp_path, world)
    step = next(s for s in play(scene) if isinstance(s.entry.given, Reading))
    x, y, θ = step.prior.mean
    at = x + 1j * y + (0.3 + 0.2j) * np.exp(1j * θ)
    length = float(step.entry.given.z[0])
    end = at + length * np.exp(1j * (θ - math.pi / 2))
    np.testing.assert_allclose(sight(step).line, [[at.real, at.imag], [end.real, end.imag]])
    drawn = beam(step, scene)
    np.testing.assert_allclose(drawn.pose, [at.real, at.imag, θ - math.pi / 2], atol=1e-12)
    assert "room" in drawn.ending


def test_a_sensor_at_the_pose_is_no_other_than_before():
    for kind in (Gnss, Ultrasonic):
        assert kind() == kind(mount=(0.0, 0.0, 0.0), delay=0.0, label=None)


def test_a_delay_that_is_known_changes_no_number_of_the_filter(tmp_path):
    """The reading was made at t − delay, and is used there; one that is not known is a fault."""
    late, prompt = TWO, TWO.replace(", delay: 0.3", "")
    of_late, of_prompt = (list(simulate(scene_of(tmp_path, GNSS + w))) for w in (late, prompt))
    for one, other in zip(of_late, of_prompt, strict=True):
        if isinstance(one.given, Reading):
            assert one.given.z.tolist() == other.given.z.tolist()
        assert one.t == other.t
    untold = scene_of(tmp_path, GNSS + late + "belief: {sensors: {rear: {delay: 0}}}\n")
    fault = scene_of(tmp_path, GNSS + prompt + "faults: {sensors: {rear: {delay: 0.3}}}\n")
    for one, other in zip(simulate(untold), simulate(fault), strict=True):
        if isinstance(one.given, Reading):
            assert one.given.z.tolist() == other.given.z.tolist()


def timeline(scene, samples):
    """The motion of a drive, and readings in some order."""
    controls = [e for e in simulate(scene) if isinstance(e.given, Control)]
    end = np.array([e.t for e in controls])
    begin = np.concatenate([[0.0], end[:-1]])
    u = np.array([e.given.u for e in controls])
    motions = Motions(controls[0].given.motion, begin, end, u, np.array([False, False, True]))
    return Timeline("log", 0.0, motions, samples)


def test_late_readings_are_sorted_in_and_throw_none_away(tmp_path):
    """Whatever the order of the rows: the same entries as without the delay, and each is used. No
    two are of one instant, for these are used in the order of their rows.
    """
    scene = scene_of(tmp_path, GNSS + TWO)
    told = {target.name: target for _, target in scene.world.targets("corrected")}
    rows = list({e.t: e for e in simulate(scene) if isinstance(e.given, Reading)}.values())
    samples = [Sample(e.t + told[e.given.name].delay, e.given, told[e.given.name].delay)
               for e in rows]  # fmt: skip
    prompt = [Sample(e.t, e.given) for e in rows]
    assert any(sample.delay for sample in samples)
    random = np.random.default_rng(1)
    shuffled = [samples[i] for i in random.permutation(len(samples))]
    beliefs = []
    for some in (prompt, samples, samples[::-1], shuffled):
        log = timeline(scene, some).recorded(scene.world, "corrected", []).log
        assert np.all(np.diff([e.t for e in log.entries]) >= 0)
        # the world's start, which the fixes bear out, is the start: none of them is
        assert sum(isinstance(e.given, Reading) for e in log.entries) == len(rows)
        assert all(e.given.u[-1] >= 0 for e in log.entries if isinstance(e.given, Control))
        steps = localize(log.entries, filter_of(scene), log.first, "warn", scene.world.layout)
        beliefs.append(list(steps)[-1].posterior)
    for belief in beliefs[1:]:
        np.testing.assert_allclose(belief.mean, beliefs[0].mean, rtol=0, atol=1e-9)
        np.testing.assert_allclose(belief.covariance, beliefs[0].covariance, rtol=0, atol=1e-12)


def filter_of(scene):
    from ekfsim.localization import filter_of

    return filter_of(replace(scene, filter="ekf"))


def test_what_is_recorded_with_a_delay_reads_back_as_it_was(tmp_path):
    """Written with the stamps that the sensor would have given, read with the delay taken off."""
    from ekfsim.files.logs.writing.written import write_log

    one = GNSS + "sensors: [{gnss: {rate: 2, delay: 0.37, mount: {x: 0.4}}}]\n"
    scene = scene_of(tmp_path, one)
    write_log(scene, simulate(scene), tmp_path / "log", force=False, format="own")
    stamps = np.loadtxt(tmp_path / "log/gnss.csv", delimiter=",", skiprows=1)[:, 0]
    np.testing.assert_allclose(stamps, 0.5 * np.arange(1, len(stamps) + 1) + 0.37)
    told = tmp_path / "read.yaml"
    told.write_text("world: world.yaml\nrecording: {format: gnss, path: log}\n")
    again, ran = list(play(load_scene(told))), list(play(scene))
    assert len(again) == len(ran)
    np.testing.assert_allclose(again[-1].posterior.mean, ran[-1].posterior.mean, atol=1e-9)


@pytest.mark.parametrize("place", [0, 7, 99])
def test_a_reading_that_is_older_than_the_start_is_left_out_before_anything_is_kept(
    tmp_path, place
):
    """And said; whatever comes after it is as in a run that never had it, smoothed as well."""
    scene = scene_of(tmp_path, GNSS + TWO)
    prompt = [Sample(e.t, e.given) for e in simulate(scene) if isinstance(e.given, Reading)]
    old = Sample(0.2, prompt[3].reading, delay=0.5)
    runs, told = [], list[str]()
    for samples in (prompt, [*prompt[:place], old, *prompt[place:]]):
        log = timeline(scene, samples).recorded(scene.world, "corrected", told).log
        steps = list(localize(log.entries, filter_of(scene), log.first, "warn", scene.world.layout))
        runs.append((log, steps, smooth(steps)))
    (without, *_), (log, *_) = runs
    assert (
        len([one for one in told if "1 reading lies before or after the motion: left" in one]) == 1
    )
    assert [e.t for e in log.entries] == [e.t for e in without.entries]
    for steps, others in zip(runs[0][1:], runs[1][1:], strict=True):
        for one, other in zip(steps, others, strict=True):
            assert one.posterior.mean.tolist() == other.posterior.mean.tolist()
            assert one.posterior.covariance.tolist() == other.posterior.covariance.tolist()
