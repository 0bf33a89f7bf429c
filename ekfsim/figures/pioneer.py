"""The figures of the document pioneer: its sensors, the square, and LKF, EKF and UKF side by side."""

import math
from dataclasses import replace

import numpy as np

from ekfsim.figures.album import BLACK, BLUE, ORANGE, VERMILLION, Album, labelled
from ekfsim.figures.beams import draw_infrared, draw_ultrasonic
from ekfsim.figures.crowd import Crowd, crowd_of, over_runs, set_down
from ekfsim.figures.echo import draw_echo
from ekfsim.figures.polar import draw_polar
from ekfsim.figures.square import corners, draw_square, shade_corners, told_of_arctan
from ekfsim.figures.track import Track, rmse
from ekfsim.geometry import Array
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.version import VERSION

RUNS = 100
NAMES = {"kf": "LKF", "ekf": "EKF", "ukf": "UKF"}
COLORS = {"kf": VERMILLION, "ekf": BLUE, "ukf": BLACK}
LINES = {"kf": ("-", 1.5), "ekf": ("-", 3.2), "ukf": ("--", 1.3)}  # EKF and UKF lie on one another
STARTS = ((0.02, 2.0), (0.2, 20.0), (0.3, 30.0))  # m, degrees: how well the robot is set down on its mark
FILTERS = """
RMSE of position (top) and heading (bottom) over {runs} runs, at every instant; the robot is set down on its mark to 2
cm and 2°. Corners are shaded. All three filters are given the same readings. The LKF, linearised once at the first
belief, is nearly as good as the others on the first side ({kf_first:.1f} mm against {ekf_first:.1f} mm) and lost from
the first corner on: it goes on believing that the robot drives east and that each beam looks at the wall it looked at
first. Over the run it is {kf:.2f} m off, which is worse than no filter ({odometry:.2f} m). EKF and UKF cannot be told
apart: within the centimetre and the degree by which they are unsure, everything is as good as linear.

The document has no such figure: it names the three and compares them in words.
"""
TABLE = """
{runs} runs (0 to {last}, seed {seed}), driven alike and read alike. "Set down to": the standard deviation of the
first pose, which all filters are told. RMSE over all instants and runs, and of the median run; NEES of the pose at
the end (a mean of 3, a median of 2.4 are right; a few lost runs dominate a mean); lost: NEES beyond the 99.9 % point
of χ², 16.3. "Blind": readings in a run that the filter refused because it predicted none.

- Set down to 2 cm and 2°: EKF and UKF are equally good ({ekf:.1f} and {ukf:.1f} mm) and honest; the EKF is the
  simpler one. The LKF fails in every run, because it is linearised once: a square has four headings, and it knows
  one.

- To 20 cm and 20°: {middle}

- To 30 cm and 30°: {wide} The UKF is blind where any one of its sigma points is.

So the document's "advantages" of the unscented filter are real while a belief is wide, and not too wide; once
readings have made it narrow there are none. It prints no numbers to compare with.
"""


LOG = """
Errors at every instant of the recorded run whose truth is known. One run cannot tell NEES or the share of lost runs:
the simulated twin's table, drawn without `--log`, does. The LKF is linearised once, at the first belief, and fails
where the robot has turned.
"""


def draw_pioneer(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
    simulated = f"Simulated, whatever was recorded: ekfsim {VERSION}, seed {scene.seed}"
    bench = album if scene.log is None else replace(album, source=simulated)  # writes into the same pages
    draw_polar(scene, bench)
    draw_infrared(scene, bench)
    draw_echo(scene, bench)
    draw_ultrasonic(scene, bench)
    if scene.log is not None:
        draw_square(scene, album, "")
        _tabulate_log(scene, album)
        return
    starts = [set_down(scene, *start) for start in STARTS]
    crowds = [{name: crowd_of(replace(start, filter=name), RUNS) for name in NAMES} for start in starts]
    draw_square(scene, album, told_of_arctan(scene))
    _draw_filters(scene, album, crowds[0])
    _tabulate(scene, album, crowds)


def _draw_filters(scene: Scene, album: Album, crowds: dict[str, Crowd]) -> None:
    """Errors of the three filters over time."""
    figure = album.figure(8.0, 5.6)
    position, heading = figure.subplots(2, 1, sharex=True)
    first = crowds["ekf"]
    t = first.t
    reckoned = np.hypot(first.reckoned[..., 0], first.reckoned[..., 1])
    for axes, e, unit in ((position, reckoned, 1e3), (heading, first.reckoned[..., 2], math.degrees(1))):
        shade_corners(axes, scene)
        axes.plot(t, unit * over_runs(e), color=ORANGE, lw=1.5, label="odometry alone")
    for name, crowd in crowds.items():
        style, width = LINES[name]
        position.plot(t, 1e3 * over_runs(crowd.position), style, color=COLORS[name], lw=width, label=NAMES[name])
        heading.plot(t, np.degrees(over_runs(crowd.heading)), style, color=COLORS[name], lw=width)
    labelled(position, "", "position RMSE (mm)").set(yscale="log", xlim=(0, t[-1]), ylim=(1.5, None))
    labelled(heading, "time (s)", "heading RMSE (°)").set(yscale="log")
    position.legend(fontsize=8.5, ncols=4, loc="lower center")
    ticks, turning = corners(scene)
    before = t < ticks[np.argmax(turning)]
    album.add(
        figure, "fig8-filters", "LKF, EKF and UKF over time",
        FILTERS.format(
            runs=RUNS, kf_first=1e3 * rmse(crowds["kf"].position[before]), kf=rmse(crowds["kf"].position),
            ekf_first=1e3 * rmse(first.position[before]), odometry=rmse(reckoned),
        ),
    )  # fmt: skip


def _tabulate(scene: Scene, album: Album, crowds: list[dict[str, Crowd]]) -> None:
    header = (
        "set down to", "filter", "position RMSE (mm)", "of the median run (mm)", "heading RMSE (°)", "mean NEES",
        "median NEES", "lost", "blind",
    )  # fmt: skip
    rows = []
    for (metres, degrees), of in zip(STARTS, crowds, strict=True):
        start = f"{100 * metres:g} cm, {degrees:g}°"
        reckoned = of["ekf"].reckoned
        p = np.hypot(reckoned[..., 0], reckoned[..., 1])
        rows.append((start, "odometry alone", *_errors(p, reckoned[..., 2]), "–", "–", "–", "–"))
        for name, c in of.items():
            nees = f"{np.mean(c.nees):.4g}", f"{np.median(c.nees):.4g}"
            failed = f"{100 * c.lost:.0f} %", f"{c.blind:.1f}"
            rows.append((start, NAMES[name], *_errors(c.position, c.heading), *nees, *failed))
    usual, middle, wide = crowds
    album.table(
        "filters", "LKF, EKF and UKF", header, rows,
        TABLE.format(
            runs=RUNS, last=RUNS - 1, seed=scene.seed, ekf=1e3 * rmse(usual["ekf"].position),
            ukf=1e3 * rmse(usual["ukf"].position), middle=_compared(middle), wide=_compared(wide),
        ),
    )  # fmt: skip


def _tabulate_log(scene: Scene, album: Album) -> None:
    """The three filters on one recorded run."""
    tracks = {name: Track.of(play(replace(scene, filter=name)), scene.world.layout) for name in NAMES}
    track = tracks["ekf"]
    if not np.any(track.has_truth):
        album.note("LKF, EKF and UKF", "The log tells no truth, and without it no filter can be called the better one.")
        return
    reckoned = replace(track, state=track.reckoned)
    rows = []
    for name, of in {"odometry alone": reckoned, **{NAMES[name]: track for name, track in tracks.items()}}.items():
        position, heading = rmse(of.position_error), math.degrees(rmse(of.heading_error))
        rows.append((name, f"{1e3 * position:.1f}", f"{1e3 * np.nanmax(of.position_error):.1f}", f"{heading:.2f}"))
    header = ("filter", "position RMSE (mm)", "largest (mm)", "heading RMSE (°)")
    album.table("filters", "LKF, EKF and UKF", header, rows, LOG)


def _errors(position: Array, heading: Array) -> tuple[str, str, str]:
    """Position over all runs, and of the median run; heading."""
    median = np.median(np.sqrt(np.mean(position**2, axis=0)))
    return f"{1e3 * rmse(position):.1f}", f"{1e3 * median:.1f}", f"{math.degrees(rmse(heading)):.2f}"


def _compared(crowds: dict[str, Crowd]) -> str:
    """EKF and UKF in a sentence."""
    ekf, ukf = crowds["ekf"], crowds["ukf"]
    e, u = 1e3 * rmse(ekf.position), 1e3 * rmse(ukf.position)
    better, times = ("UKF", e / u) if u < e else ("EKF", u / e)
    return (
        f"{e:.0f} mm by the EKF, {u:.0f} mm by the UKF: the {better} is better by a factor of {times:.1f}. The EKF "
        f"loses {100 * ekf.lost:.0f} % of the runs, the UKF {100 * ukf.lost:.0f} %; the EKF is blind to "
        f"{ekf.blind:.1f} readings in a run, the UKF to {ukf.blind:.1f}."
    )
