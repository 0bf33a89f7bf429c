"""What a world of each system may hold, for the schema."""

import dataclasses
from collections.abc import Iterable

from pydantic import BaseModel
from pydantic.config import JsonDict

from ekfsim.files.keys.fields import (
    aliases,
)
from ekfsim.files.keys.worlds.documents import ODOMETRY, not_carried, robot_fields
from ekfsim.files.keys.worlds.faults import FaultKeys
from ekfsim.files.keys.worlds.robot import RobotKeys, ToldRobotKeys
from ekfsim.systems import SYSTEMS
from ekfsim.world import Faults


def only(names: Iterable[str], keys: type[BaseModel]) -> JsonDict:
    """A mapping with no other of a model's keys than these."""
    known = aliases(keys)
    return {"propertyNames": {"enum": [known[name] for name in names]}}


def of_system(system: str) -> JsonDict:
    """What a world of a driven robot may hold."""
    robot = robot_fields(system)
    turning: JsonDict = (
        {"properties": {"odometry": {"enum": list(ODOMETRY[system])}}} if system in ODOMETRY else {}
    )
    believed = only((name for name in robot if name != "rate"), ToldRobotKeys)
    told: JsonDict = {"noise": False, "robot": {**believed, **turning}}
    return {
        "noise": False,
        "robot": {**only(robot, RobotKeys), **turning},
        "faults": only((*SYSTEMS[system].robot.faults, "sensors"), FaultKeys),
        "belief": {"properties": told},
        "sensors": {"items": {"properties": dict.fromkeys(not_carried(system), False)}},
    }


IN_THE_CLASSROOM: JsonDict = {
    "robot": False,
    "sensors": False,
    "faults": only((field.name for field in dataclasses.fields(Faults)), FaultKeys),
    "belief": {"properties": {"robot": False, "sensors": False}},
}


CLASSROOM: JsonDict = {
    "if": {"properties": {"system": {"const": "classroom"}}},
    "then": {"required": ["noise"], "properties": IN_THE_CLASSROOM},
}


def where_it_is(system: str) -> JsonDict:
    """The condition of a system."""
    told: JsonDict = {"properties": {"system": {"const": system}}, "required": ["system"]}
    return {"if": told, "then": {"properties": of_system(system)}}


# what a world of each system may hold
BY_SYSTEM: JsonDict = {"allOf": [CLASSROOM, *map(where_it_is, SYSTEMS)]}
