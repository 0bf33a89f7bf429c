"""Which sensor of the world each number of a log belongs to."""

from dataclasses import replace

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.logs.table import Rows
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Instrument, Landmark, Target
from ekfsim.world import World


def of_landmarks(
    world: World,
    reading: DocumentReading,
    landmarks: tuple[Landmark, ...],
    kinds: tuple[type[Instrument], ...],
) -> list[tuple[Instrument, dict[int, Target]]]:
    """The world's instruments of these kinds,
    each with its sensor for every landmark, by the landmark's id.
    """
    around = replace(world, landmarks=landmarks).around(reading)
    found = [instrument for instrument in world.told_instruments if isinstance(instrument, kinds)]
    if not found:
        wanted = " or ".join(kind.name for kind in kinds)
        raise UsageError(f"{world.name}: this log belongs to a world with the sensor {wanted}")
    by_instrument = []
    for instrument in found:
        by_id = {
            mark.id: target
            for mark, target in zip(landmarks, instrument.targets(around), strict=True)
        }
        by_instrument.append((instrument, by_id))
    return by_instrument


def landmarks_of(rows: Rows) -> tuple[Landmark, ...]:
    """The landmarks in a table of id, x, y.
    Raises InputError where an id is no whole number, or stands twice.
    """
    found, mistakes = dict[int, Landmark](), list[Mistake]()
    for line, (id, x, y) in zip(rows.lines.tolist(), rows.values.tolist(), strict=True):
        place = Place(rows.file, line)
        if id != int(id):
            mistakes.append(
                Mistake(place, "", f"{id:g} names no landmark", "an id is a whole number")
            )
        elif int(id) in found:
            mistakes.append(
                Mistake(place, "", f"the landmark {id:g} stands here again", "name it once")
            )
        else:
            found[int(id)] = Landmark(int(id), x, y)
    if mistakes:
        raise InputError(mistakes)
    return tuple(found.values())


def by_name(world: World, reading: DocumentReading, instrument: Instrument) -> dict[str, Target]:
    """All sensors of an instrument of the world, by their names."""
    return {target.name: target for target in instrument.targets(world.around(reading))}


def only(world: World, reading: DocumentReading, *kinds: type[Instrument]) -> Target:
    """The one sensor that the world has of some kinds.
    Raises UsageError where it has none, or several.
    """
    found = [
        target for instrument, target in world.targets(reading) if isinstance(instrument, kinds)
    ]
    if len(found) != 1:
        names = " or ".join(kind.name for kind in kinds)
        wanted = f"this log belongs to a world with one thing that the sensor {names} sees"
        raise UsageError(f"{world.name}: {wanted}, not {len(found)}")
    return found[0]
