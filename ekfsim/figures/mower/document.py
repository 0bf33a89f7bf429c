"""Document 000, the golf-course mower:
figures 4 to 7, and the tables of many runs (or of one recorded log).
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ekfsim.figures.album import Album
from ekfsim.figures.mower.pictures import (
    blind_stretches,
    close_up,
    errors,
    markers_and_trace,
    paths,
)
from ekfsim.figures.mower.runs import ALONE, RUNS, Outcome, Way, as_shaken_as_told, outcomes
from ekfsim.figures.mower.tables import differences, readings_of_log, readings_of_runs, table_1
from ekfsim.figures.mower.told import as_told_by, with_angles_of
from ekfsim.figures.track import Track
from ekfsim.geometry import Array
from ekfsim.localization import filter_of, first_belief, localize
from ekfsim.records import Entry, Reading
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.systems.document import READINGS, DocumentReading

IDEAL = Way("corrected", ideal=True)
WAYS = (*map(Way, READINGS), IDEAL, ALONE)


def draw_mower(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
    entries = tuple(simulate(scene)) if scene.log is None else scene.log.entries
    real, ideal = (
        filtered(scene, entries, scene.reading),
        filtered(scene, with_ideal_angles(entries), "corrected"),
    )
    blind = blind_stretches(real)
    paths(scene, real, album)
    markers_and_trace(real, blind, album)
    errors(real, blind, album)
    close_up(scene, ideal, blind, album)
    differences(entries, album)
    if scene.log is None:
        _tables_of_runs(scene, album)
    else:
        _tables_of_log(scene, entries, real, ideal, album)


def _tables_of_runs(scene: Scene, album: Album) -> None:
    """Table 1 and the readings over many runs:
    of the mower as it is, and of one that is as the filter is told.
    """
    here = outcomes(
        scene, dict.fromkeys((*WAYS, Way(scene.reading), Way(scene.reading, ideal=True))), RUNS
    )
    table_1(here[Way(scene.reading)], here[IDEAL], here[ALONE], album)
    if scene.reading != "corrected":
        _strayed(scene.reading, here[Way(scene.reading, ideal=True)], album)
    shaken = outcomes(as_shaken_as_told(scene), (*map(Way, READINGS), ALONE), RUNS)
    as_it_is, as_told = (
        {reading: of[Way(reading)] for reading in READINGS} for of in (here, shaken)
    )
    readings_of_runs(as_it_is, as_told, album)


def _tables_of_log(
    scene: Scene, entries: tuple[Entry, ...], real: Track, ideal: Track, album: Album
) -> None:
    """The same of a single log."""
    reckoned = replace(real, state=real.reckoned)
    table_1(Outcome.of(real), Outcome.of(ideal), Outcome.of(reckoned), album)
    if scene.reading != "corrected":
        _strayed(
            scene.reading,
            Outcome.of(filtered(scene, with_ideal_angles(entries), scene.reading)),
            album,
        )
    tracks = {reading: filtered(scene, entries, reading) for reading in READINGS}
    readings_of_log(
        {reading: Outcome.of(track) for reading, track in tracks.items()}, scene.reading, album
    )


def _strayed(reading: DocumentReading, outcome: Outcome, album: Album) -> None:
    """What another reading makes of ideal angles."""
    album.note(
        "Ideal angles",
        "Figure 7 and the ideal columns of table 1 are filtered by the *corrected* reading. The "
        f"reading *{reading}* trusts ideal angles as much, but not at the right place: its "
        f"position RMSE with them is {told_range(outcome.rmse)}.",
    )


def told_range(metres: Array) -> str:
    """Of single runs : (N,) m, from the least to the largest."""
    if len(metres) == 1:
        return f"{metres[0]:.3g} m on this log"
    return f"{np.min(metres):.2g} to {np.max(metres):.2g} m in single runs"


def filtered(scene: Scene, entries: Iterable[Entry], reading: DocumentReading) -> Track:
    """What the scene's filter makes of a log when it follows a reading of the document."""
    scene = replace(scene, reading=reading)
    steps = localize(
        as_read(entries, reading), filter_of(scene), first_belief(scene), layout=scene.world.layout
    )
    return Track.of(steps, scene.world.layout)


def as_read(entries: Iterable[Entry], reading: DocumentReading) -> Iterator[Entry]:
    """The same log, its marker sensors with the derivatives of a reading."""
    for entry in entries:
        given = entry.given
        yield (
            replace(entry, given=as_told_by(reading, given))
            if isinstance(given, Reading)
            else entry
        )


def with_ideal_angles(entries: Iterable[Entry]) -> Iterator[Entry]:
    """The same log as if cameras did not err:
    the angles of the true pose, and R = 1e-12 I. eq. 31
    """
    for entry in entries:
        given = entry.given
        if isinstance(given, Reading) and entry.truth is not None:
            yield replace(entry, given=with_angles_of(entry.truth, given))
        else:
            yield entry
