"""Document 004: what each reading of it, and what else was tried, costs."""

import numpy as np

from ekfsim.figures.album import (
    Album,
)
from ekfsim.figures.pylon.runs import (
    Runs,
    by_the_letter,
    every_other,
    in_its_own_frame,
    lidar_alone,
    timed,
)
from ekfsim.figures.track import Track, rmse
from ekfsim.geometry import Array
from ekfsim.geometry.outline import path_error
from ekfsim.systems.document import DocumentReading

OWN_FRAME = "corrected, read in the lidar's own frame: the yaw filtered, too"
COMPARED = (
    "The last column is the path RMSE that the authors' own program has on this log, which "
    "they published. "
)
WHAT: dict[DocumentReading, str] = {
    "corrected": "corrected: the yaw error × the lever arm in R, dt from the stamps",
    "coded": "coded: as the authors' program does",
    "printed": "printed: eq. 5 with its minus",
}


def table_of_readings(runs: Runs, album: Album) -> None:
    """What each reading, and what else was tried, does to the path-tracking error."""
    coded, corrected = runs.told["coded"], runs.told["corrected"]
    fix = runs.track.fix[~np.isnan(runs.track.fix[:, 0])]
    letter = coded.but(by_the_letter(coded.entries)).track()
    apart = rmse(np.linalg.norm(letter.pose[:, :2] - runs.tracks["coded"].pose[:, :2], axis=-1))
    rows = [
        _row(runs, WHAT["corrected"], runs.tracks["corrected"], "-"),
        _row(runs, OWN_FRAME, corrected.but(in_its_own_frame(corrected.entries)).track(), "-"),
        _row(
            runs,
            "corrected, every other correction",
            corrected.but(every_other(corrected.entries)).track(),
            "-",
        ),
        _row(runs, WHAT["coded"], runs.tracks["coded"], "0.230199"),
        _row(
            runs,
            "coded, every other correction",
            coded.but(every_other(coded.entries)).track(),
            "0.233241",
        ),
        _row(
            runs,
            "coded, dt from the stamps",
            coded.but(timed(coded.entries, None)).track(),
            "0.230220",
        ),
        _row(runs, WHAT["printed"], runs.tracks["printed"], "0.231986"),
        _row(runs, "coded, eq. 8 to the letter", letter, "-"),
        [
            "lidar and yaw alone, no filter",
            *_numbers(path_error(lidar_alone(coded), runs.ring)),
            "-",
            "-",
            "0.231313",
        ],
    ]
    if len(fix):
        rows.append(["GPS alone", *_numbers(path_error(fix, runs.ring)), "-", "-", "0.454782"])
    header = ["estimate", "path RMSE (m)", "mean (m)", "largest (m)", "RMSE to the truth (m)",
    "mean NIS per number",
              "the same of the authors' own program (m)"]  # fmt: skip
    published = runs.published
    album.table(
        "readings",
        "What each reading costs",
        header if published else header[:-1],
        rows if published else [row[:-1] for row in rows],
        f"Path RMSE by eqs 11 and 12. {COMPARED if published else ''}A NIS of 1 per number read is "
        f"what a filter that knows its own uncertainty has on average. {cost(runs)} Eq. 8 to the "
        f"letter, with θ where π/2 − θ belongs, puts the cart {apart:.2g} m away from where it is "
        "(RMS), at another place of the square; eq. 11, which asks for the nearest side, "
        "hardly notices.",
    )


def _row(runs: Runs, name: str, track: Track, reference: str) -> list[str]:
    truth = f"{rmse(track.position_error):.4f}" if track.has_truth.any() else "-"
    return [name, *_numbers(runs.off_path(track)), truth, f"{track.nis:.2f}", reference]


def _numbers(error: Array) -> list[str]:
    return [f"{rmse(error):.6f}", f"{np.mean(error):.4f}", f"{np.max(error):.4f}"]


def cost(runs: Runs) -> str:
    """What the difference between the readings costs."""
    path = {reading: rmse(runs.off_path(track)) for reading, track in runs.tracks.items()}
    nis = {reading: track.nis for reading, track in runs.tracks.items()}
    return (
        f"Path RMSE {path['corrected']:.4f} m corrected, {path['coded']:.4f} m coded, "
        f"{path['printed']:.4f} m printed; NIS per number on average {nis['corrected']:.1f}, "
        f"{nis['coded']:.0f} and {nis['printed']:.0f}, where 1 is right: the readings differ more "
        "in what they claim than in what they estimate."
    )
