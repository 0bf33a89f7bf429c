"""Document 003, the lawn mower:
figures 1 to 5, a table, and the recipe of its authors as a counter-example.
"""

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.figures.album import BLACK, BLUE, ORANGE, PURPLE, VERMILLION, Album, labelled, square
from ekfsim.figures.gnss.runs import FILTER, RECIPE, ManyRuns, Runs, length, pose_error
from ekfsim.figures.gnss.tables import table, table_over_runs, times
from ekfsim.figures.track import rmse, running_rmse
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.scene import Scene

# of the run, m: where figure 1 is drawn larger, and how much to each side
CLOSE_UP, REACH = 0.85, 2.5
FLOOR = 1e-3  # m or rad, the lower end of the logarithmic axes
QUANTITIES = (("x", "m"), ("y", "m"), ("φ", "rad"))
GNSS, WHEELS = "GNSS fixes", "wheels alone"
COLOURS = {GNSS: ORANGE, WHEELS: VERMILLION, FILTER: BLUE, RECIPE: PURPLE}


def draw_gnss(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
    runs = Runs.of(scene)
    if len(runs.fixes.t) == 0:
        source = scene.log_source or scene.commands_source
        raise UsageError(f"{source}: it holds no GNSS fix, and so there is nothing to draw")
    paths(runs, album)
    headings(runs, album)
    if not runs.right.has_truth.any():
        album.note("Figures 3 to 6 and the table", "They need the truth, and this log has none.")
        return
    for number in range(3):
        errors_so_far(runs, number, album)
    counter_example(runs, album)
    table(runs, album)
    if scene.log is None:
        table_over_runs(ManyRuns.of(scene), album)


def paths(runs: Runs, album: Album) -> None:
    """Figure 1."""
    figure = album.figure(10.0, 4.6)
    whole, close = figure.subplots(1, 2, width_ratios=(1.6, 1))
    truth, estimate = runs.right.truth, runs.estimate.pose
    for axes in (whole, close):
        square(axes)
        axes.plot(*runs.fixes.place.T, ".", ms=3 if axes is whole else 6, color=ORANGE, label=GNSS)
        axes.plot(*truth[:, :2].T, color=BLACK, lw=2.2, label="truth")
        axes.plot(*runs.wheels[:, :2].T, "--", color=VERMILLION, lw=1.2, label=WHEELS)
        axes.plot(
            *estimate[:, :2].T, color=COLOURS[runs.chosen], lw=1.1, label=f"estimate: {runs.chosen}"
        )
    whole.legend(loc="best", fontsize=8)
    whole.set_title("Truth, GNSS and estimate")
    row = int(CLOSE_UP * len(estimate))
    x, y = estimate[row, :2] if np.isnan(truth[row, 0]) else truth[row, :2]
    close.set_aspect("equal", adjustable="box")
    close.set(xlim=(x - REACH, x + REACH), ylim=(y - REACH, y + REACH))
    close.set_title(f"Close-up at {runs.estimate.t[row]:.0f} s")
    off = "" if np.isnan(truth[-1, 0]) else _end_of_the_wheels(runs)
    album.add(
        figure,
        "fig1-paths",
        "Figure 1: truth, GNSS fixes and estimate",
        f"{_seen(runs)}{off} The printed figure shows truth, fixes and estimate over the full run; "
        "its text says that they closely match, and tells no numbers.",
    )


def headings(runs: Runs, album: Album) -> None:
    """Figure 2."""
    figure = album.figure()
    axes = labelled(figure.add_subplot(), "time (s)", "heading φ (degrees)")
    t, truth = runs.right.t, np.degrees(np.unwrap(runs.right.truth[:, 2]))
    times, courses = runs.fixes.courses()
    axes.plot(
        times,
        _beside(courses, times, t, truth),
        ".",
        ms=3,
        color=ORANGE,
        label="course of fixes 1 s apart",
    )
    axes.plot(t, truth, color=BLACK, lw=2.2, label="truth")
    axes.plot(
        t, np.degrees(np.unwrap(runs.wheels[:, 2])), "--", color=VERMILLION, lw=1.2, label=WHEELS
    )
    estimate = _beside(runs.estimate.pose[:, 2], runs.estimate.t, t, truth)
    axes.plot(
        runs.estimate.t,
        estimate,
        color=COLOURS[runs.chosen],
        lw=1.1,
        label=f"estimate: {runs.chosen}",
    )
    axes.legend(loc="best", fontsize=8)
    axes.set_title("Heading")
    errors = "" if not runs.right.has_truth.any() else (
        f" RMSE: estimate {np.degrees(rmse(runs.estimate.heading_error)):.3g}°, wheels alone "
        f"{np.degrees(rmse(pose_error(runs.wheels, runs.right.truth)[:, 2])):.3g}°."
    )  # fmt: skip
    album.add(
        figure,
        "fig2-heading",
        "Figure 2: the heading φ",
        "A fix tells no heading: the filter learns it from how the fixes run against the wheels. "
        f"As a check, the course from each fix to the one a second later is drawn, too.{errors} "
        "The printed figure shows truth and estimate over the full run (its caption names GNSS, "
        "which has no heading of its own).",
    )


def errors_so_far(runs: Runs, number: int, album: Album) -> None:
    """Figures 3 to 5: the RMS error of all instants up to each. number : 0, 1, 2 for x, y, φ"""
    name, unit = QUANTITIES[number]
    figure = album.figure()
    axes = labelled(figure.add_subplot(), "time (s)", f"RMS error of {name} so far ({unit})")
    ends = dict[str, float]()
    for label, t, error in _errors(runs, number):
        so_far = running_rmse(error)
        width = 2.0 if label == runs.chosen else 1.2
        style = "--" if label == WHEELS else "-"
        axes.plot(
            t,
            so_far,
            style,
            color=COLOURS[label],
            lw=width,
            label=f"{label}: {so_far[-1]:.3g} {unit} in the end",
        )
        ends[label] = float(so_far[-1])
    axes.set_yscale("log")
    axes.set_ylim(bottom=FLOOR)
    axes.legend(loc="lower right", fontsize=8)
    axes.set_title(f"RMS error of {name} over time")
    worse = f"Wheels alone end {times(ends[WHEELS] / ends[FILTER])} the error of the filter. " + (
        f"Each fix alone is off by {ends[GNSS]:.3g} m. "
        if GNSS in ends
        else "A fix tells no heading. "
    )
    album.add(
        figure,
        f"fig{number + 3}-rms-{('x', 'y', 'phi')[number]}",
        f"Figure {number + 3}: RMS error of {name}",
        "The root of the mean of all squared errors up to each instant, on a logarithmic axis. "
        f"{worse}The authors' recipe ends at {ends[RECIPE]:.3g} {unit}. The printed figure has a "
        "line for the filter; its numbers are not in the text.",
    )


def counter_example(runs: Runs, album: Album) -> None:
    """What the authors' code does with the same data."""
    raw, recipe = rmse(length(runs.fixes.error)), rmse(runs.recipe.position_error)
    figure = album.figure(9.0, 4.2)
    place, time = figure.subplots(1, 2)
    square(place)
    labelled(time, "time (s)", "position error (m)")
    place.plot(*runs.recipe.pose[:, :2].T, color=PURPLE, lw=0.8, alpha=0.8, label=RECIPE)
    place.plot(*runs.fixes.place.T, ".", ms=3, color=ORANGE, label=GNSS)
    place.plot(*runs.right.truth[:, :2].T, color=BLACK, lw=1.8, label="truth")
    place.legend(loc="best", fontsize=8)
    for label, track in ((RECIPE, runs.recipe), (FILTER, runs.right)):
        time.plot(track.t, track.position_error, color=COLOURS[label], lw=0.8, label=label)
    time.axhline(raw, color=ORANGE, lw=1.5, label=f"{GNSS}: RMSE {raw:.3g} m")
    time.set_yscale("log")
    time.set_ylim(bottom=FLOOR)
    time.legend(loc="lower right", fontsize=8)
    figure.suptitle(
        f"Counter-example: the authors' recipe, {recipe:.3g} m against {raw:.3g} m of the fixes it "
        "is given"
    )
    album.add(
        figure,
        "fig6-recipe",
        "Counter-example: the recipe of the document's authors (--reading coded)",
        f"Position RMSE {recipe:.3g} m: {times(recipe / raw)} that of the raw fixes, {raw:.3g} m, "
        "which are all it has to go by. Its position prediction has no dt: every row of the wheels "
        "moves the robot by V metres in place of V dt. Its yaw rate is made of the mean speed, φ + "
        "0.27 V dt, and not of the wheels' difference. Q, R and P₀ are the identity, whatever the "
        "units and the length of a step. It takes each innovation at the state before the "
        "prediction. So it keeps up with the robot only because it corrects at every row, by a fix "
        "between two recorded ones, the later of which no robot can know yet; and those are spread "
        "evenly over the rows by their number, whatever their stamps say. Corrected at the "
        f"recorded fixes alone it is {rmse(runs.sparse.position_error):.3g} m off. "
        f"{_beside_the_wheels(runs)} The document prints the right equations and mentions none "
        "of this.",
    )


def _beside_the_wheels(runs: Runs) -> str:
    """What the recipe makes of the wheels, beside the wheels by themselves."""
    wheels = pose_error(runs.wheels, runs.right.truth)
    off, turned = rmse(length(wheels)), rmse(wheels[:, 2])
    recipe, heading = rmse(runs.recipe.position_error), rmse(runs.recipe.heading_error)
    return (
        f"The wheels alone, without any fix, have a position RMSE of {off:.3g} m and a heading "
        f"RMSE of {turned:.3g} rad, the recipe {recipe:.3g} m and {heading:.3g} rad: its heading "
        f"is {'worse than theirs' if heading > turned else 'the better one'}."
    )


def _errors(runs: Runs, number: int) -> list[tuple[str, Array, Array]]:
    """What figures 3 to 5 draw:
    the label, the instants with a known truth, and the errors there.
    """
    rows = [
        (WHEELS, runs.right.t, pose_error(runs.wheels, runs.right.truth)[:, number]),
        (FILTER, runs.right.t, pose_error(runs.right.pose, runs.right.truth)[:, number]),
        (RECIPE, runs.recipe.t, pose_error(runs.recipe.pose, runs.recipe.truth)[:, number]),
    ]
    if number < 2:
        rows.insert(0, (GNSS, runs.fixes.t, runs.fixes.error[:, number]))
    return [(label, t[~np.isnan(error)], error[~np.isnan(error)]) for label, t, error in rows]


def _beside(heading: Array, t: Array, times: Array, truth: Array) -> Array:
    """Headings in degrees, on the turn that is nearest to the true one where that is known.
    heading : rad
    """
    near = np.interp(t, times, truth)
    if np.isnan(near).any():
        return np.degrees(np.unwrap(heading))
    return near + np.degrees(wrap(heading - np.radians(near)))


def _seen(runs: Runs) -> str:
    if not runs.right.has_truth.any():
        return "The truth is not known."
    estimate, raw = rmse(runs.estimate.position_error), rmse(length(runs.fixes.error))
    numbers = f"position RMSE {estimate:.3g} m, of the fixes {raw:.3g} m."
    if estimate > raw:
        return (
            f"The estimate is farther from the truth than the fixes that it is made of: {numbers}"
        )
    return (
        "The estimate lies within the scatter of the fixes and is smoother than they "
        f"are: {numbers}"
    )


def _end_of_the_wheels(runs: Runs) -> str:
    off = float(length(pose_error(runs.wheels, runs.right.truth))[-1])
    return f" The wheels alone end {off:.3g} m from the truth."
