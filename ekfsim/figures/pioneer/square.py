"""Document 001, figure 7: the square by odometry alone and by the filter."""

import math

import numpy as np
from matplotlib.axes import Axes

from ekfsim.figures.album import BLACK, BLUE, GREY, ORANGE, Album, labelled, square
from ekfsim.figures.track import Track, rmse
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.ellipse import outline
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.systems.drive import Course

DRIVEN = """
The square of 2 × 2 m in a room of {room}, driven once in {seconds:.0f} s (run {run} of seed
{seed}). The driver holds the robot to the square by its true pose, so that only estimates stray. On
the right its corners are shaded.
"""
RECORDED = """
A recorded run of {seconds:.0f} s in a room of {room}.
"""
SQUARE = """
{whence} Left: the true way (black), what the wheels alone make of it (orange) and the {filter}'s
estimate with its 95.4 % ellipses, ten times as large, every {every:.0f} s (blue, close to the black
line). Right: the errors over time. Odometry ends {end:.2f} m and {turned:.1f}° off (RMSE
{odometry:.3f} m): the wheels' errors turn the heading, and nothing turns it back. The filter, which
also hears and sees the walls, keeps to {filtered:.1f} mm and {heading:.2f}°.

Compared with the print: of figure 7 the text says that the trajectory is noisy and drifts in
orientation, "which is hard to detect even with the EKF": that EKF was given no walls, and without
them no filter can. Here ultrasonic and infrared readings tell them. {arctan}
"""
UNKNOWN = """
{whence} Orange: what the wheels alone make of it; blue: the {filter}'s estimate with its 95.4 %
ellipses, ten times as large, every {every:.0f} s. The log tells no truth, so there are no errors to
draw; at the end the two are {apart:.2f} m apart.
"""
ARCTAN = """
Eq. 33 turns the heading by the arctangent of the wheels' difference over W, and the simulated
wheels obey it. On an arc the turn is that ratio itself (`robot: {{odometry: midpoint}}`): at
{rate:g} inputs a second the two differ by {gained:.2f}° over the four corners. No equation of this
filter is printed wrongly and the document comes without code, so `--reading printed` and `coded`
change nothing here.
"""


def draw_square(scene: Scene, album: Album, arctan: str) -> None:
    """Figure 7: the square by odometry and by the filter."""
    track = Track.of(play(scene), scene.world.layout)
    reckoned = scene.world.layout.pose(track.reckoned)
    odometry = np.hypot(*(reckoned - track.truth)[:, :2].T)
    turned = wrap(reckoned[:, 2] - track.truth[:, 2])
    known = bool(np.any(track.has_truth))
    figure = album.figure(10.0 if known else 5.4, 4.9)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.1, 1)) if known else figure.add_gridspec(2, 1)
    _draw_floor(square(figure.add_subplot(grid[:, 0])), scene, track, reckoned)
    if known:
        position = figure.add_subplot(grid[0, 1])
        heading = figure.add_subplot(grid[1, 1], sharex=position)
        for axes in (position, heading):
            shade_corners(axes, scene)
        position.plot(track.t, 1e3 * odometry, color=ORANGE, lw=1.4)
        position.plot(track.t, 1e3 * track.position_error, color=BLUE, lw=1.0)
        heading.plot(track.t, np.degrees(turned), color=ORANGE, lw=1.4)
        heading.plot(track.t, np.degrees(track.heading_error), color=BLUE, lw=1.0)
        labelled(position, "", "position error (mm)").set(
            yscale="log", ylim=(0.3, None), xlim=track.t[[0, -1]]
        )
        labelled(heading, "time (s)", "heading error (°)")
    title = "Figure 7: the square by odometry and by the filter"
    album.add(figure, "fig7-square", title, _caption(scene, track, odometry, turned, arctan))


def _draw_floor(floor: Axes, scene: Scene, track: Track, reckoned: Array) -> None:
    """The ways in the room."""
    for number, (_, ring) in enumerate(scene.world.map.rings()):
        floor.plot(
            *np.vstack([ring, ring[:1]]).T, color=GREY, lw=2.5, label="_" if number else "walls"
        )
    if np.any(track.has_truth):
        floor.plot(*track.truth[:, :2].T, color=BLACK, lw=2.4, label="truth")
    floor.plot(*reckoned[:, :2].T, color=ORANGE, lw=1.5, label="odometry alone")
    floor.plot(*track.pose[:, :2].T, color=BLUE, lw=1.0, label=scene.filter.upper())
    for number, i in enumerate(np.linspace(0, len(track.t) - 1, 9).astype(int)):
        label = "_" if number else "its 95.4 % ellipse, ten times as large"
        ring = outline(track.pose[i], 100 * track.pose_covariance[i], 0.954)
        floor.plot(*ring.T, color=BLUE, lw=0.9, alpha=0.7, label=label)
    floor.legend(loc="upper center", bbox_to_anchor=(0.5, 0.93), fontsize=7.5, ncols=2)


def _caption(scene: Scene, track: Track, odometry: Array, turned: Array, arctan: str) -> str:
    """What is to be seen in figure 7.
    odometry and turned : (N,) m and rad, errors of the wheels alone
    """
    boundary = scene.world.map.boundary
    width, height = (0.0, 0.0) if boundary is None else np.ptp(boundary, axis=0)
    whence = (DRIVEN if scene.log is None else RECORDED).strip().format(
        room=f"{width:g} × {height:g} m", seconds=track.t[-1] - track.t[0], run=scene.run,
        seed=scene.seed
    )  # fmt: skip
    filter, every = scene.filter.upper(), (track.t[-1] - track.t[0]) / 8
    known = np.flatnonzero(track.has_truth)
    if not known.size:
        apart = np.hypot(*(scene.world.layout.pose(track.reckoned) - track.pose)[-1, :2])
        return UNKNOWN.format(whence=whence, filter=filter, every=every, apart=apart)
    return SQUARE.format(
        whence=whence, filter=filter, every=every, end=odometry[known[-1]],
        turned=abs(math.degrees(turned[known[-1]])), odometry=rmse(odometry),
        filtered=1e3 * rmse(track.position_error), heading=math.degrees(rmse(track.heading_error)),
        arctan=arctan,
    )  # fmt: skip


def told_of_arctan(scene: Scene) -> str:
    """What eq. 33's arctangent makes of the corners, beside the ratio that it is taken of."""
    dt, course = course_of(scene)
    ratio = np.tan(course.turn_rate * dt)
    return ARCTAN.strip().format(
        rate=1 / dt, gained=math.degrees(np.sum(np.abs(ratio - np.arctan(ratio))))
    )


def course_of(scene: Scene) -> tuple[float, Course]:
    """The drive's tick in s, and what it asks for at each."""
    assert scene.drive is not None
    assert scene.world.robot is not None
    dt = 1 / scene.world.robot.rate
    return dt, scene.drive.course(dt)


def corners(scene: Scene) -> tuple[Array, Booleans]:
    """When the drive's ticks begin and end : (T + 1,) s, and which of them turn in place : (T,)"""
    dt, course = course_of(scene)
    turning: Booleans = (course.speed == 0) & (course.turn_rate != 0)
    return dt * np.arange(len(course.speed) + 1.0), turning


def shade_corners(axes: Axes, scene: Scene) -> None:
    """Grey where the robot turns in place."""
    if scene.drive is None:
        return
    t, turning = corners(scene)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], turning, [False]]).astype(int)))
    for start, end in edges.reshape(-1, 2):
        axes.axvspan(t[start], t[end], color="#EEEEEE", lw=0, zorder=0)
