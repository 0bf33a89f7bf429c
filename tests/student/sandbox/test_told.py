import dataclasses
import importlib
import json
import pkgutil

import numpy as np
import pytest

import ekfsim.models
from ekfsim.models.layout import SPEED_POSE, Layout
from ekfsim.models.motions.biased import Misread
from ekfsim.models.motions.unicycle import Unicycle
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.mounted import Mount
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.raycast.walls import Walls
from ekfsim.records import Control, Reading
from ekfsim.student.sandbox.told import SLOTS, Listener, Teller

WALLS = Walls.of({"boundary": np.array([[0.0, 0.0], [7.0, 0.0], [7.0, 5.0], [0.0, 5.0]])})
PARTS = {
    float: lambda number: 0.1 + number,
    bool: lambda number: False,
    Walls: lambda number: WALLS,
    Layout: lambda number: SPEED_POSE,
    Mount: lambda number: Mount(0.1, 0.2, 0.3 + number),
    tuple[Misread, ...]: lambda number: (Misread((0, 1), True), Misread((2,), False, 3, 0.5)),
    int | None: lambda number: None,
    Motion: lambda number: Unicycle(0.1, 0.2),
    Sensor: lambda number: Yaw(0.1, 0.2),
    tuple[tuple[float, float], ...]: lambda number: ((0.1, 0.2), (0.3, 0.4), (0.5, number)),
}
MODELS = [
    kind
    for found in pkgutil.walk_packages(ekfsim.models.__path__, "ekfsim.models.")
    for kind in vars(importlib.import_module(found.name)).values()
    if isinstance(kind, type)
    and dataclasses.is_dataclass(kind)
    and kind.__module__ == found.name
    and kind is not Layout
]


def made(kind):
    """One of a class of models, each of its parts another number."""
    return kind(
        *(
            PARTS.get(one.type, lambda number: np.arange(4.0).reshape(2, 2) + number)(number)
            for number, one in enumerate(dataclasses.fields(kind))
        )
    )


def over(teller, listener, given):
    """What arrives of an input or a reading."""
    return listener.given(json.loads(json.dumps(teller.told(given))))


def equal(one, other):
    if dataclasses.is_dataclass(one):
        return type(one) is type(other) and all(
            equal(getattr(one, part.name), getattr(other, part.name))
            for part in dataclasses.fields(one)
        )
    return type(one) is type(other) and np.array_equal(one, other)


@pytest.mark.parametrize("kind", MODELS, ids=lambda kind: kind.__name__)
def test_every_model_arrives_as_it_was(kind):
    model, value = made(kind), np.array([1 / 3, np.nan, np.inf])
    given = Reading(model, value) if hasattr(kind, "h") else Control(model, value)
    arrived = over(Teller(), Listener(), given)
    assert type(arrived) is type(given)
    theirs = arrived.sensor if hasattr(kind, "h") else arrived.motion
    assert equal(theirs, model)
    assert not equal(theirs, made(MODELS[0] if kind is MODELS[1] else MODELS[1]))
    assert np.array_equal(arrived.z if hasattr(kind, "h") else arrived.u, value, equal_nan=True)


def test_of_many_models_each_arrives_and_walls_are_told_once_in_a_while():
    teller, listener, z = Teller(), Listener(), np.ones(1)
    lasers = [Laser(WALLS, bearing, 0.1) for bearing in np.arange(3.0 * SLOTS).tolist()]
    sent = []
    for laser in [*lasers, *lasers[::-1]]:
        told = json.dumps(teller.told(Reading(laser, z)))
        sent.append(told)
        assert equal(listener.given(json.loads(told)).sensor, laser)
    assert sum("boundary" in told for told in sent) < 0.05 * len(sent)


def test_the_same_model_is_told_once():
    teller, model = Teller(), made(MODELS[0])
    first, again = (teller.told(Control(model, np.zeros(2))) for _ in range(2))
    assert len(first[0]) == 1
    assert again[0] == []
    assert again[1] == first[1]


class Foreign:
    """No model of the package's."""


def test_what_is_no_model_is_not_told():
    with pytest.raises(TypeError, match="Foreign is no model of ekfsim's; it cannot be told"):
        Teller().told(Reading(Foreign(), np.zeros(1)))
    with pytest.raises(TypeError, match="is no part of a model"):
        Listener().given(([(0, ["model", "subprocess", "Popen", ["true"]])], 0, [], True))
