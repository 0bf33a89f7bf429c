"""Stamps in ms, µs and ns: as the same log in seconds, to the last bit; told, file by file."""

from decimal import Decimal

import numpy as np
import pytest
from log_worlds import lay, world

from ekfsim.errors import LogRemark
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import read_log
from ekfsim.files.logs.tables.stamps import to_seconds, unit_beside, unit_of_motion
from ekfsim.files.scenes.load import load_scene

DIGITS = {"s": 0, "ms": 3, "us": 6, "ns": 9}
WHEELS = [f"{k * 5}e-3" for k in range(41)]  # s, 200 Hz
FIXES = [f"{105 + 20 * k}e-3" for k in range(5)]
WORDS = {"ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}


def stamps(seconds, unit, begin):
    """Whole numbers where they are ms, µs or ns, as loggers write them."""
    exact = [(Decimal(begin) + Decimal(t)).scaleb(DIGITS[unit]) for t in seconds]
    return [str(t) if unit == "s" else f"{t:.0f}" for t in exact]


def log(folder, wheels="s", fixes=None, truth=None, begin="0"):
    """A log whose files have stamps in these units."""
    fixes, truth = fixes or wheels, truth or wheels
    rows = {
        "wheelspeeds.csv": ("t,vr,vl", WHEELS, wheels, "0.5,0.4"),
        "gnss.csv": ("t,x,y", FIXES, fixes, "0.01,0.02"),
        "groundtruth.csv": ("t,x,y,phi", WHEELS, truth, "0,0,0"),
    }
    return lay(
        folder,
        **{
            name: "\n".join([header, *(f"{t},{more}" for t in stamps(seconds, unit, begin)), ""])
            for name, (header, seconds, unit, more) in rows.items()
        },
    )


def read(path, unit=None):
    return read_log(RecordingKeys(format="gnss", timeUnit=unit), path, world("gnss"), "corrected")


def times(found):
    return np.array([entry.t for entry in found.log.entries])


@pytest.mark.parametrize("begin", ["0", "1506846691", "12345678.5"])
@pytest.mark.parametrize("unit", WORDS)
def test_a_log_in_another_unit_is_the_log_in_seconds(tmp_path, unit, begin):
    sound = read(log(tmp_path / "s", begin=begin))
    found = read(log(tmp_path / unit, unit, begin=begin))
    assert sound.warnings == []
    np.testing.assert_array_equal(times(found), times(sound))
    told = [one for one in found.warnings if f"t is taken as {WORDS[unit]}: " in one]
    assert len(told) == len(found.warnings) == 3
    assert all(one.endswith("say otherwise with --set recording.timeUnit=s") for one in told)
    said = read(tmp_path / unit, unit)
    np.testing.assert_array_equal(times(said), times(sound))
    assert said.warnings == []


@pytest.mark.parametrize("units", [("s", "ns", "s"), ("ms", "s", "us"), ("s", "s", "ms")])
@pytest.mark.parametrize("begin", ["0", "1506846691"])
def test_each_file_may_have_a_unit_of_its_own(tmp_path, units, begin):
    sound = read(log(tmp_path / "s", begin=begin))
    found = read(log(tmp_path / "mixed", *units, begin=begin))
    np.testing.assert_array_equal(times(found), times(sound))
    assert len(found.warnings) == sum(unit != "s" for unit in units)


def test_what_is_said_wins_over_what_is_likely(tmp_path):
    found = read(log(tmp_path / "ms", "ms"), "s")
    assert found.warnings == []
    assert found.log.entries[-1].t == 200.0


def test_no_digit_of_a_stamp_is_lost():
    assert to_seconds("1506846691104999936", "ns") == 1506846691.104999936
    assert to_seconds("1.248e+18", "ns") == 1.248e9
    assert to_seconds("-5", "ms") == -0.005
    assert np.isnan(to_seconds("nan", "ns"))


@pytest.mark.parametrize(
    ("step", "own", "unit"),
    [
        (1.0, 0.005, "s"),  # once a second is no odd log
        (2.0, 0.1, "s"),
        (5.0, 0.005, "ms"),
        (100.0, 0.1, "ms"),
        (5e3, 0.005, "us"),
        (1e4, 0.01, "us"),
        (5e6, 0.005, "ns"),
        (1e8, 0.1, "ns"),
        (1e12, 0.1, "s"),  # nothing fits
    ],
)
def test_the_unit_whose_usual_step_fits_the_robot(step, own, unit):
    assert unit_of_motion(np.arange(50) * step, own)[0] == unit


def test_readings_far_beyond_a_short_motion_are_still_of_its_unit():
    motion = np.arange(1000) * 0.005
    assert unit_beside(np.arange(0.1, 100, 0.1), motion)[0] == "s"
    assert unit_beside(motion[::20] + 1e6, motion)[0] == "s"  # another clock
    assert unit_beside(np.arange(0, 5000, 100.0), motion)[0] == "ms"


def test_python_is_told_of_it_too(tmp_path):
    with pytest.warns(LogRemark, match="t is taken as nanoseconds"):
        load_scene("gnss_log", log=log(tmp_path / "ns", "ns", begin="1506846691"))
