"""What may have made a run diverge: each mechanism with the change that takes it away."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.why.changes import beams, faults, maps, told
from ekfsim.why.changes.alike import alike
from ekfsim.why.changes.singles import reading
from ekfsim.why.records import Change, Mechanism, together

HAS_NO_LINES = "pf"  # the filter that makes nothing linear
# filters that make their straight lines elsewhere than at the estimate
ELSEWHERE = {"kf": "the first belief", "kf-nominal": "the plan"}
PARTICLES = 10_000  # of one run's exact filter
FEW = 1000  # of each of many runs'
LONG = 500  # steps; of a longer run particles take too long, and sigma points take their place
PARTED = ("noise", "number", "start", "map", "fault")  # kinds whose whole is made of its members


@dataclass(frozen=True)
class Suspect:
    """A mechanism, and the change that takes it away."""

    mechanism: Mechanism
    change: Change
    # what the change is made of, or other ways of the same: one of them alone may cure
    members: tuple[Change, ...] = ()
    often: Change | None = None  # the change in many runs, where it is another
    reckoning: bool = False  # how the filter reckons, no mistake in what it is told
    slow: bool = False  # too slow for all of many runs

    @property
    def ways(self) -> tuple[Change, ...]:
        """Every change that may cure by itself for the mechanism's sake, the whole last."""
        return (*self.members, self.change)

    @property
    def has_parts(self) -> bool:
        """Whether the change is that of all members together."""
        return len(self.members) > 1 and self.change.kind in PARTED

    @property
    def in_many(self) -> Change:
        """The change in many runs."""
        return self.often or self.change


def suspects_of(scene: Scene, steps: Sequence[Step]) -> list[Suspect]:
    """Everything that may be wrong with a run of the classroom's robot, what explains more first.

    steps : of the run as it stands
    """
    entries = [step.entry for step in steps]
    found = list(_told(scene)) + list(_faults(scene))
    if any(beams.repeated(entries)):
        found.insert(0, Suspect(Mechanism.REPEATED_READINGS, beams.REPEATED))
    wrong = tuple(step for step in steps if beams.astray(step))
    if wrong:
        like = Mechanism.LOOK_ALIKE_WALLS if alike(wrong) else Mechanism.WRONG_WALL
        each = tuple(reading(step.entry.index) for step in wrong)
        found.append(Suspect(like, beams.ASTRAY, (*each, beams.WALL), reckoning=True))
    if any(map(beams.grazes, entries)):
        each = tuple(reading(entry.index) for entry in entries if beams.grazes(entry))
        found.append(Suspect(Mechanism.GRAZING_BEAMS, beams.GRAZING_BEAMS, each, reckoning=True))
    found.append(Suspect(Mechanism.CLOSE_TO_THE_WALL, beams.NOISE_AT_TRUTH, reckoning=True))
    return [*found, *_lines(scene, len(steps))]


def _lines(scene: Scene, steps: int) -> Iterator[Suspect]:
    """That straight lines are made of what bends."""
    if scene.filter in ELSEWHERE:
        yield Suspect(Mechanism.LINEARISED_ELSEWHERE, here(scene), reckoning=True)
    if scene.filter == HAS_NO_LINES:
        return
    exact, often = [sigma_points()], sigma_points()
    if steps <= LONG:
        exact, often = [*exact, particles(PARTICLES)], particles(FEW)
    yield Suspect(
        Mechanism.HEADING_SPREAD, exact[-1], tuple(exact), often, reckoning=True, slow=True
    )


def _told(scene: Scene) -> Iterator[Suspect]:
    """What the filter is told wrongly."""
    world = scene.world
    if each := tuple(told.ratios(world, told.ODOMETRY)):
        wrong = [name for name in told.ODOMETRY if _differs(scene, name)]
        trusted = told.overtrusted(world, wrong)
        yield Suspect(
            Mechanism.ODOMETRY_OVERTRUSTED if trusted else Mechanism.ODOMETRY_DISTRUSTED,
            together("the told ratios of the odometry", each), each,
        )  # fmt: skip
    if each := tuple(told.ratios(world, ("range",))):
        trusted = told.overtrusted(world, ("range",))
        yield Suspect(
            Mechanism.LASER_OVERTRUSTED if trusted else Mechanism.LASER_DISTRUSTED, each[0], each
        )
    if (each := tuple(told.starts(world))) and told.surer(world):
        yield Suspect(Mechanism.WRONG_START, together("the told start", each), each)
    if each := tuple(maps.map_changes(world)):
        leans = maps.leans(world)
        yield Suspect(
            Mechanism.SHEARED_MAP if leans else Mechanism.MISPLACED_WALL,
            together("the told map", each), each,
        )  # fmt: skip


def _differs(scene: Scene, name: str) -> bool:
    world = scene.world
    return bool(getattr(world.told.noise, name) != getattr(world.noise, name))


FAULTS = {
    "range_bias": Mechanism.RANGE_BIAS,
    "range_scale": Mechanism.RANGE_SCALE,
    "short_returns": Mechanism.SHORT_RETURNS,
    "odometry_distance_scale": Mechanism.WHEEL_SCALE,
    "odometry_angle_scale": Mechanism.TURN_SCALE,
}


def _faults(scene: Scene) -> Iterator[Suspect]:
    """What is wrong with the robot and what happens to it."""
    for name, mechanism in FAULTS.items():
        if (change := faults.fault(scene, name)) is not None:
            yield Suspect(mechanism, change, (change,))
    if each := tuple(faults.slips(scene)):
        yield Suspect(Mechanism.SLIP, together("the slips", each), each)
    if each := tuple(faults.kidnaps(scene)):
        yield Suspect(Mechanism.KIDNAP, together("the kidnaps", each), each)


def particles(number: int) -> Change:
    """Particles in place of the filter: nothing is made linear."""

    def of_scene(scene: Scene) -> Scene:
        return replace(scene, filter="pf", tuning=replace(scene.tuning, particles=number))

    name = "particles in place of straight lines"
    return Change("linear", name, f"{number} of them", of_scene=of_scene)


def sigma_points() -> Change:
    """Sigma points in place of the derivatives."""
    return Change(
        "linear", "sigma points in place of straight lines", "the ukf",
        of_scene=lambda scene: replace(scene, filter="ukf"),
    )  # fmt: skip


def here(scene: Scene) -> Change:
    """Straight lines about the estimate in place of another belief."""
    told = f"not about {ELSEWHERE[scene.filter]}: the ekf"
    return Change(
        "linear", "straight lines about the estimate", told,
        of_scene=lambda scene: replace(scene, filter="ekf"),
    )  # fmt: skip
