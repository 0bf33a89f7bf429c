"""What is said of runs that Numba does not compile whole."""

from dataclasses import replace

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.tuning import Tuning
from ekfsim.study.running.whole_runs import by_parts


def test_what_is_not_compiled_whole_is_named_in_one_line():
    tour, mower = load_scene("tour"), load_scene("mower")
    whole = [replace(tour, filter=name) for name in ("ekf", "huber", "pdaf")]
    assert by_parts(whole) == []
    cross = Tuning(cross_covariances="dropped")
    parts = [
        replace(tour, filter="mhekf"), replace(tour, filter="amcl", guard="skip"),
        replace(tour, guard="skip"), mower, replace(tour, filter="huber", tuning=cross),
        replace(tour, filter="ekf-smoothed"), replace(tour, filter="/home/anna/mine.py"),
    ]  # fmt: skip
    assert by_parts([*whole, *parts, *parts]) == [
        "--fast compiles whole runs of ekf, huber, pdaf in the classroom; of mhekf, amcl, ekf with "
        "guard skip, ekf of a mower, huber without cross covariances, ekf-smoothed, mine.py only "
        "beams and matrices, which gains less"
    ]
