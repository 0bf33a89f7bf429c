"""The tables of document 000:
table 1 beside the print, and what each reading of the document costs.
"""

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from ekfsim.figures.album import Album
from ekfsim.figures.mower.runs import Outcome
from ekfsim.geometry import Array
from ekfsim.models.sensors.landmarks import MarkerAngles
from ekfsim.records import Entry, Reading
from ekfsim.systems.document import DocumentReading

PRINTED = {  # table 1 of the document: position and heading with real angles, then with ideal ones
    "mean": ("0.352", "0.244", "0.123", "−0.233"),
    "standard deviation": ("0.296", "3.488", "0.171", "1.301"),
    "variance (unit²)": ("0.088", "2.168", "0.029", "1.695"),
}
STATISTICS: dict[str, Callable[..., Array]] = {
    "mean": np.nanmean, "standard deviation": np.nanstd, "variance (unit²)": np.nanvar
}  # fmt: skip
MEANING: dict[DocumentReading, str] = {
    "corrected": "right derivatives, each marker linearised at the newest estimate (section 3.2)",
    "coded": "the listing: every marker linearised where the robot stood before the time update",
    "printed": "eq. 25 to the letter: ∂η/∂x and ∂η/∂y with the wrong sign",
}
READ = ["position RMSE (m)", "heading RMSE (°)", "mean NEES (3 expected)",
"mean NIS per number (1 expected)",
        "what it is"]  # fmt: skip
LISTING = (
    "the listing's derivatives are of before the last motion input, which is a centimetre and "
    "matters little, but it holds every marker of a picture against the estimate from before that "
    "picture, so that an error which the first marker has corrected is corrected once more by the "
    "next, while P shrinks as if each had told something new"
)


def table_1(real: Outcome, ideal: Outcome, alone: Outcome, album: Album) -> None:
    """Table 1: position and heading error with real and with ideal angles,
    beside the document's own numbers.
    """
    header = [
        "",
        *(
            f"{what}, {angles} angles"
            for angles in ("real", "ideal")
            for what in ("position (m)", "heading (°)")
        ),
    ]
    columns = [
        e for outcome in (real, ideal) for e in (outcome.position, np.degrees(outcome.heading))
    ]
    rows = []
    for name, statistic in STATISTICS.items():
        rows.append(
            [f"{name}, here", *(spread(statistic(column, axis=0), 3) for column in columns)]
        )
        rows.append([f"{name}, printed", *PRINTED[name]])
    mean, turned = (
        100 * np.array(statistic(b, axis=0)).mean() / np.array(statistic(a, axis=0)).mean()
        for statistic, a, b in (
            (np.nanmean, real.position, ideal.position), (np.nanstd, real.heading, ideal.heading)
        )
    )  # fmt: skip
    drift, strayed = np.degrees(rms(alone.heading[-1])), rms(alone.position[-1])
    runs = real.position.shape[1]
    whose = (
        f"Over {runs} runs, each figure the mean of the runs' ± its standard deviation between "
        "them; errors are counted five times a second. What truly disturbs this mower is less than "
        "the filter is told (see its world file): the document chose Q with room to spare, and "
        "where a mower is shaken by 0.5° every 10 ms no ideal angles can halve the errors of "
        "its heading."
        if runs > 1 else f"Of one log, errors at {len(real.position)} motion inputs."
    )  # fmt: skip
    album.table(
        "table1-errors", "Table 1: position and heading error statistics", header, rows,
        f"{whose}\n\nIdeal angles are those of the true pose, with R = 10⁻¹² I (eq. 31). They "
        f"leave {mean:.0f} % of the mean position error and {turned:.0f} % of the heading's "
        "standard deviation; in the print it is 35 % and 37 %. What accumulates between two sights "
        "of a marker no angle can undo; the document blames, besides, camera stamps that do not "
        f"quite fit its pose log. By the motion inputs alone the last pose is off by {drift:.2g}° "
        f"and {strayed:.2g} m{' (RMS)' if runs > 1 else ''}: the gyro keeps the heading, though Q "
        "does not trust it, and the place needs the markers.\n\nThe printed column of real "
        "headings does not hang together: a standard deviation of 3.488° has a variance of 12.17, "
        "not 2.168, which belongs to 1.472°. In the other columns the variance is the square.",
    )  # fmt: skip


def differences(entries: Iterable[Entry], album: Album) -> None:
    """R as the document finds it:
    by the differences of the measured angles and those of the true pose (eq. 30).
    """
    apart, told = list[Array](), list[Array]()
    for entry in entries:
        given = entry.given
        if (
            isinstance(given, Reading)
            and isinstance(given.sensor, MarkerAngles)
            and entry.truth is not None
        ):
            h, _, R = given.sensor.linearize(entry.truth)
            apart.append(given.sensor.residual(given.z, h))
            told.append(np.sqrt(np.diagonal(R)))
    if len(apart) < 2:
        return
    e, σ = np.degrees(np.array(apart)), np.degrees(np.array(told))
    rows = [
        [
            angle,
            _signed(f"{e[:, i].mean():.3f}"),
            f"{e[:, i].std(ddof=1):.3f}",
            f"{σ[:, i].mean():.3f}",
        ]
        for i, angle in enumerate(("azimuth", "elevation"))
    ]
    header = ["angle", "mean (°)", "standard deviation (°)", "as the filter is told (°)"]
    album.table(
        "differences", "R: measured angles less those of the true pose", header, rows,
        f"{len(e)} sights of one run. So the document has found the R of eq. 30: 0.048 rad are "
        "2.750°, 0.006 rad are 0.344°. A standard deviation of so many is itself unsure by "
        f"{100 / np.sqrt(2 * len(e)):.1f} %, a mean by the {np.sqrt(len(e)):.0f}th part of it. A "
        "mean that is far from 0 tells of a bias, which no R makes up for.",
    )  # fmt: skip


def readings_of_runs(
    quiet: Mapping[DocumentReading, Outcome],
    shaken: Mapping[DocumentReading, Outcome],
    album: Album,
) -> None:
    """What the print and the listing cost,
    over many runs of the mower as it is and of one as its filter is told.
    """
    mowers = {"as it is": quiet, "as told": shaken}
    rows = [[mower, *row] for mower, outcomes in mowers.items() for row in _rows(outcomes)]
    runs = quiet["corrected"].position.shape[1]
    album.table(
        "readings", "What the print and the listing cost", ["true mower", "reading", *READ], rows,
        f"Runs 0 to {runs - 1}, each drive filtered in every way; ± is the standard deviation "
        "between runs. *As it is* the mower is disturbed by less than the filter is told; *as "
        "told* it is disturbed as Q says (eq. 29).\n\nThe sign of eq. 25 makes the filter go away "
        "from a marker that is too near, and that does not depend on the mower: "
        f"{costs(quiet, 'printed')} as it is, {costs(shaken, 'printed')} as told.\n\nWhat the "
        f"listing costs does depend on it: {LISTING}. As it is: {costs(quiet, 'coded')}, and "
        f"{_turned(quiet)} the heading RMSE; its mean NEES is {_judged(quiet['coded'])}, as long "
        f"as Q has so much room to spare. As told: {costs(shaken, 'coded')}, {_turned(shaken)} the "
        f"heading RMSE, and its mean NEES is {_judged(shaken['coded'])}.",
    )  # fmt: skip


def readings_of_log(
    outcomes: Mapping[DocumentReading, Outcome], associated: DocumentReading, album: Album
) -> None:
    """What they cost on one log,
    whose pictures belong to its rows as the reading `associated` has it.
    """
    best, listing, wrong = (
        float(outcomes[reading].rmse[0]) for reading in ("corrected", "coded", "printed")
    )
    album.table(
        "readings", "What the print and the listing cost", ["reading", *READ], _rows(outcomes),
        f"One log, filtered three times, its pictures at the rows to which *{associated}* assigns "
        "them; one log proves little. The sign of eq. 25 makes the filter go away from a marker "
        f"that is too near: {wrong:.3g} m in place of {best:.3g} m. The listing gives "
        f"{listing:.3g} m: {LISTING}. What that costs depends on how much room Q leaves; the "
        "figures of the simulated mower tell it over many runs.",
    )  # fmt: skip


def _rows(outcomes: Mapping[DocumentReading, Outcome]) -> list[list[str]]:
    return [
        [
            reading, spread(of.rmse, 3), spread(np.degrees(of.heading_rmse), 2),
            spread(_mean(of.nees), 2),
            spread(of.nis, 2), MEANING[reading],
        ]
        for reading, of in outcomes.items()
    ]  # fmt: skip


def costs(outcomes: Mapping[DocumentReading, Outcome], reading: DocumentReading) -> str:
    """How a reading's position RMSE compares with the right one's, run by run."""
    ratio = outcomes[reading].rmse / outcomes["corrected"].rmse
    mean, worse = float(np.mean(ratio)), int(np.sum(ratio > 1))
    if mean > 2:
        return f"{mean:.1f} times the RMSE ({ratio.min():.1f} to {ratio.max():.1f} in single runs)"
    low, high = 100 * (ratio.min() - 1), 100 * (ratio.max() - 1)
    return (
        f"{abs(100 * (mean - 1)):.0f} % {'more' if mean > 1 else 'less'} RMSE "
        f"({_signed(f'{low:.0f}')} to {_signed(f'{high:.0f}')} % in single runs, worse in {worse} "
        f"of {len(ratio)})"
    )


def _turned(outcomes: Mapping[DocumentReading, Outcome]) -> str:
    """How many times as large the listing leaves the error of the heading."""
    return (
        f"{np.mean(outcomes['coded'].heading_rmse / outcomes['corrected'].heading_rmse):.2f} times"
    )


def _judged(outcome: Outcome) -> str:
    """A mean NEES, and what it says, held against the spread of its runs."""
    nees = _mean(outcome.nees)
    unsure = 2 * nees.std(ddof=1) / np.sqrt(len(nees))
    if nees.mean() - unsure > 3:
        word = "above the 3 that is right: over-confident"
    else:
        word = f"{'below' if nees.mean() + unsure < 3 else 'near'} the 3 that is right"
    return f"{spread(nees, 2)}, {word}"


def spread(values: Array, digits: int) -> str:
    """The mean of runs ± their standard deviation, or the one value;
    with the minus of the print.
    """
    known = values[~np.isnan(values)]
    if len(known) < 2:
        return _signed(f"{known[0]:.{digits}f}" if len(known) else "nan")
    return _signed(f"{known.mean():.{digits}f} ± {known.std(ddof=1):.{digits}f}")


def rms(values: Array) -> float:
    """√(mean v²)"""
    return float(np.sqrt(np.nanmean(values**2)))


def _mean(values: Array) -> Array:
    """Over time, of each run : (T, N) → (N,)"""
    return np.asarray(np.nanmean(values, axis=0), np.float64)


def _signed(number: str) -> str:
    return number.replace("-", "−")
