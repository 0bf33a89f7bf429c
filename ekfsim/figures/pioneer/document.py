"""The figures of the document pioneer:
its sensors, the square, and LKF, EKF and UKF side by side.
"""

import math
from dataclasses import replace

import numpy as np

from ekfsim.figures.album import Album
from ekfsim.figures.pioneer.beams import draw_infrared, draw_ultrasonic
from ekfsim.figures.pioneer.echo import draw_echo
from ekfsim.figures.pioneer.filters import draw_filters
from ekfsim.figures.pioneer.flight import draw_flight
from ekfsim.figures.pioneer.polar import draw_polar
from ekfsim.figures.pioneer.square import draw_square, told_of_arctan
from ekfsim.figures.track import Track, rmse
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.version import VERSION

ON_LOGS = {"kf": "LKF", "ekf": "EKF", "ukf": "UKF"}
LOG = """
Errors at every instant of the recorded run whose truth is known. One run cannot tell NEES or the
share of lost runs: the simulated twin's table, drawn without `--log`, does. The LKF is linearised
once, at the first belief, and fails where the robot has turned; about the way as it was planned it
would not, and that a log does not tell.
"""


def draw_pioneer(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
    simulated = f"Simulated, whatever was recorded: ekfsim {VERSION}, seed {scene.seed}"
    # writes into the same pages
    bench = album if scene.log is None else replace(album, source=simulated)
    draw_polar(scene, bench)
    draw_infrared(scene, bench)
    draw_echo(scene, bench)
    draw_flight(scene, bench)
    draw_ultrasonic(scene, bench)
    if scene.log is not None:
        draw_square(scene, album, "")
        _tabulate_log(scene, album)
        return
    draw_square(scene, album, told_of_arctan(scene))
    draw_filters(scene, album)


def _tabulate_log(scene: Scene, album: Album) -> None:
    """The three filters on one recorded run."""
    tracks = {
        name: Track.of(play(replace(scene, filter=name)), scene.world.layout) for name in ON_LOGS
    }
    track = tracks["ekf"]
    if not np.any(track.has_truth):
        album.note(
            "LKF, EKF and UKF",
            "The log tells no truth, and without it no filter can be called the better one.",
        )
        return
    reckoned = replace(track, state=track.reckoned)
    rows = []
    for name, of in {
        "odometry alone": reckoned,
        **{ON_LOGS[name]: track for name, track in tracks.items()},
    }.items():
        position, heading = rmse(of.position_error), math.degrees(rmse(of.heading_error))
        rows.append(
            (
                name,
                f"{1e3 * position:.1f}",
                f"{1e3 * np.nanmax(of.position_error):.1f}",
                f"{heading:.2f}",
            )
        )
    header = ("filter", "position RMSE (mm)", "largest (mm)", "heading RMSE (°)")
    album.table("filters", "LKF, EKF and UKF", header, rows, LOG)
