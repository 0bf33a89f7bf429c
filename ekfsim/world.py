"""What stands where, how noisy the robot is, and what the filter is told of both."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ekfsim.filters.belief import Gaussian
from ekfsim.floor import Map
from ekfsim.geometry import Array
from ekfsim.models.layout import POSE, Layout
from ekfsim.printable import in_a_line
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.faults import NOTHING_WRONG, DriveFaults
from ekfsim.systems.instrument import Instrument, Surroundings, Target
from ekfsim.systems.instrument import Landmark as Landmark
from ekfsim.systems.robot import Robot

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.random import Generator


@dataclass(frozen=True)
class Noise:
    """The assignment's five ratios: σ = ratio · |magnitude|."""

    execution_distance: float
    execution_angle: float
    odometry_distance: float
    odometry_angle: float
    range: float


@dataclass(frozen=True)
class Faults:
    """What is wrong with the robot and no one knows."""

    range_bias: float = 0.0  # m
    range_scale: float = 1.0
    short_returns: float = 0.0  # probability
    odometry_distance_scale: float = 1.0
    odometry_angle_scale: float = 1.0


Axes = tuple[bool, bool, bool]  # whether something holds of x, of y, of θ
NOTHING_SAID: Axes = (False, False, False)


@dataclass(frozen=True)
class Told:
    """What the filter is told: its first belief, noise and map. The truth may differ in each."""

    start: Array  # (3,) x, y, θ in m, m, rad
    sigma: Array  # (3,) standard deviations of the first belief
    noise: Noise
    map: Map
    robot: Robot | None = None  # None: as it is
    instruments: tuple[Instrument, ...] | None = None  # None: as they are
    # of which entries of its start the filter is told by itself, not by the world's own start
    start_said: Axes = NOTHING_SAID
    # of which of them somebody says how sure they are; None: of all where any sigma is more than 0
    sigma_said: Axes | None = None
    start_unknown: bool = False  # whether the filter has no idea where the robot starts


@dataclass(frozen=True, repr=False)
class World:
    """A world file: the truth, and beside it what the filter is told.

    `world.with_("noise.rangeSigmaRatio", 0.1)` is the same with another number, of which the filter
    is told, as by `--set` on the command line. `dataclasses.replace(world, noise=n)` changes the
    truth alone, so that the filter is told wrongly of it. `World.of` makes a world of Python's
    values, as `load_world` does of a file.
    """

    name: str
    map: Map
    start: Array  # (3,) x, y, θ in m, m, rad
    start_sigma: Array  # (3,) the true start of each run is drawn from N(start, start_sigma²)
    noise: Noise
    told: Told
    faults: Faults = Faults()  # of the classroom's robot
    drive_faults: DriveFaults = NOTHING_WRONG  # of one that is driven
    landmarks: tuple[Landmark, ...] = ()
    description: str = ""
    system: str = "classroom"
    robot: Robot | None = None  # None in the classroom, whose robot obeys commands
    instruments: tuple[Instrument, ...] = ()
    # (n, 2) m, the outline that was meant to be driven; it closes by itself
    expected_path: Array | None = None
    # what it was read from; what `replace` makes of it was not, and has none
    given: object = field(default=None, init=False, compare=False, repr=False)

    def __repr__(self) -> str:
        n, (x, y, theta) = len(self.map.obstacles), self.start.tolist()
        things = [f"{n} obstacles" if n != 1 else "1 obstacle", f"{len(self.landmarks)} landmarks"]
        start = f"start {x:.6g}, {y:.6g}, {np.degrees(theta):.6g}°"
        return f"World({in_a_line(self.name)}: {', '.join([self.system, *things, start])})"

    @classmethod
    def of(
        cls,
        *,
        start: object,
        noise: object = None,
        name: str = "world",
        boundary: object = None,
        obstacles: object = None,
        walls: object = None,
        landmarks: object = None,
        sigma: object = None,
        belief: object = None,
        faults: object = None,
        system: str | None = None,
        robot: object = None,
        sensors: object = None,
        expected_path: object = None,
        description: str | None = None,
    ) -> "World":
        """The world that a file of these keys would hold, with all its checks. Metres and degrees:

            World.of(
                boundary=[[0, 0], [10, 0], [10, 8], [0, 8]],
                obstacles={"desk": [[4, 3], [5, 3], [5, 4], [4, 4]]},
                walls=[[[7, 0], [7, 5]]],
                start=(1, 1, 90),
                noise={"executionDstSigmaRatio": 0.05, …},  # all five, or a Noise
            )

        start : x, y, θ, or a dict; sigma : standard deviations of it, or under "sigma" in the dict.
        Every value may be a list, a tuple, an array, or what a file has there.
        Raises InputError with all mistakes, each with the path of its key.
        """  # fmt: skip
        from ekfsim.files.given.worlds import world_of  # the door to the files' checks

        told = {
            "name": name, "description": description, "system": system, "boundary": boundary,
            "obstacles": obstacles, "walls": walls, "landmarks": landmarks, "start": start,
            "sigma": sigma, "noise": noise, "robot": robot, "sensors": sensors,
            "expectedPath": expected_path, "belief": belief, "faults": faults,
        }  # fmt: skip
        return world_of(told)

    def with_(self, *pairs: object, **settings: object) -> "World":
        """The same world with other numbers, told to the filter as well: see `Scene.with_`.

        Raises UsageError or InputError where a key or a value is wrong.
        """
        from ekfsim.files.given.changes import changed_world  # the door to the files' checks

        return changed_world(self, pairs, settings)

    @property
    def layout(self) -> Layout:
        """What the entries of the filter's state are."""
        robot = self.told_robot
        return POSE if robot is None else robot.layout

    def follows(self, reading: DocumentReading) -> bool:
        """Whether anything of robot or instruments is printed, or coded, otherwise than right."""
        own = () if self.robot is None else self.robot.readings
        return reading in own or any(
            reading in instrument.readings for instrument in self.instruments
        )

    @property
    def perfect_beam(self) -> bool:
        """Whether the filter is told of a laser without noise while its own place is in doubt."""
        noise = self.told.noise
        unsure = (
            bool(self.told.sigma.any()) or noise.odometry_distance > 0 or noise.odometry_angle > 0
        )
        return self.robot is None and noise.range == 0 and unsure

    @property
    def told_robot(self) -> Robot | None:
        """The robot as the filter is told; None in the classroom."""
        return self.told.robot or self.robot

    @property
    def believed_robot(self) -> Robot:
        """The same where there is one, as wherever robots drive. Raises ValueError elsewhere."""
        if (robot := self.told_robot) is None:
            raise ValueError(f"{self.name}: this robot obeys commands, and does not drive")
        return robot

    @property
    def told_instruments(self) -> tuple[Instrument, ...]:
        """The instruments as the filter is told."""
        return self.instruments if self.told.instruments is None else self.told.instruments

    def first_belief(self, reading: DocumentReading) -> Gaussian:
        """What the filter is told of the start of a simulation: the document's own; the world file
        may say how uncertain its pose is.
        """
        told = self.told
        if told.start_unknown:
            return self._all_over
        if self.told_robot is None:
            return Gaussian(told.start, np.diag(told.sigma**2))
        return Gaussian(self.layout.state(told.start), self.first_covariance(reading))

    @property
    def _all_over(self) -> Gaussian:
        """Mean and covariance of no idea at all: uniform over a room's width and depth, and over
        all headings.
        """
        if (boundary := self.told.map.boundary) is None:
            raise ValueError(f"{self.name}: no boundary says where the robot can be")
        low, high = boundary.min(axis=0), boundary.max(axis=0)
        widths = np.append(high - low, 2 * np.pi)
        return Gaussian(np.append((low + high) / 2, 0.0), np.diag(widths**2 / 12))

    def first_covariance(self, reading: DocumentReading) -> Array:
        """P₀ : (n, n) of a robot that is driven or was recorded: the document's own, but for the
        entries of the pose of which somebody says how sure they are.
        """
        P = self.believed_robot.first_covariance(reading).copy()
        for axis in np.flatnonzero(self.sigma_said):
            place = self.layout.places[axis]
            P[place, :] = P[:, place] = 0
            P[place, place] = self.told.sigma[axis] ** 2
        return P

    @property
    def sigma_said(self) -> Axes:
        """Of which of x, y, θ of the first belief somebody says how sure they are."""
        told = self.told
        if told.sigma_said is None:
            return (bool(told.sigma.any()),) * 3
        # what `replace` has made of a belief is said, too
        x, y, theta = (
            said or bool(σ) for said, σ in zip(told.sigma_said, told.sigma.tolist(), strict=True)
        )
        return x, y, theta

    @property
    def anywhere(self) -> "Callable[[Generator, int], Array] | None":
        """States from all over the floor that the filter believes free, with any heading:
        (generator, number) → (p, n); None where no boundary says where the floor ends.
        """
        if self.told.map.boundary is None:
            return None

        def drawn(generator: "Generator", number: int) -> Array:
            return self.layout.state(self.told.map.walls.ground.anywhere(generator, number))

        return drawn

    def targets(self, reading: DocumentReading) -> list[tuple[Instrument, Target]]:
        """Everything that the instruments may read, with the sensors as the filter is told."""
        around = self.around(reading)
        return [
            (instrument, target)
            for instrument in self.told_instruments
            for target in instrument.targets(around)
        ]

    def true_targets(self) -> list[tuple[Instrument, Target]]:
        """The same in the same order, with the sensors as they are."""
        around = self._around("corrected", self.map, self.robot, self.start)
        return [
            (instrument, target)
            for instrument in self.instruments
            for target in instrument.targets(around)
        ]

    def around(self, reading: DocumentReading) -> Surroundings:
        """What the sensors that the filter is told of are made from."""
        return self._around(reading, self.told.map, self.told_robot, self.told.start)

    def _around(
        self, reading: DocumentReading, floor: Map, robot: Robot | None, start: Array
    ) -> Surroundings:
        yaw_sigma = 0.0
        if robot is not None:
            from ekfsim.systems.estimating import Estimating  # of no use to the classroom
            from ekfsim.systems.robots import PylonCart

            own = robot.robot if isinstance(robot, Estimating) else robot
            yaw_sigma = own.yaw_sigma if isinstance(own, PylonCart) else 0.0
        return Surroundings(
            self.landmarks, floor.walls, self.layout, reading, yaw_sigma, float(start[2])
        )
