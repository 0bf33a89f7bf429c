"""A log halved: numbers are fitted to its first half, and tried on the second."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ekfsim.diagnostics.innovations import Found, Innovations
from ekfsim.diagnostics.verdict import Evidence
from ekfsim.errors import UsageError
from ekfsim.fitting.estimate import Estimate, Fit, fit
from ekfsim.fitting.noises import NoiseNumber, Retold, noises_of
from ekfsim.localization import entries_of, first_belief, play
from ekfsim.records import Log, Reading
from ekfsim.scene import Scene

LEAST = 40  # readings of a log
OUTLIERS = 0.999  # the gate of a fit where the file has none: an outlier is no noise
CLEARLY = 5.0  # of −ln p: what was told right may well do better than what is fitted, by less


@dataclass(frozen=True)
class Judged:
    """What the innovations of the second half say of a filter, and all of them for a picture."""

    evidence: Evidence
    found: Found
    at: list[float] = field(default_factory=list)  # of every reading of the log: s, or its step
    nis: list[float] = field(default_factory=list)  # per number read
    cost: float = 0.0  # −ln p of the second half's innovations but for a constant

    @property
    def mean(self) -> float:
        """NIS per number read."""
        return self.evidence.nis_sum / max(self.evidence.nis_dof, 1)


@dataclass(frozen=True)
class Trial:
    """What was fitted, and how the filter does with it where it was not fitted."""

    scene: Scene  # as it was
    tuned: Scene
    fit: Fit
    until: int  # entries of the log that were fitted to
    before: Judged
    after: Judged

    @property
    def is_worse(self) -> bool:
        """Whether the second half is clearly less likely under what was fitted to the first."""
        return self.after.cost > self.before.cost + CLEARLY

    @property
    def is_coloured(self) -> bool:
        """Whether what the fitted filter leaves of the second half is no noise."""
        return self.after.found.word == "not white"

    @property
    def used(self) -> tuple[Estimate, ...]:
        """What is to be told to the filter: nothing that does worse than what it was told."""
        return () if self.is_worse else self.fit.found

    @property
    def half(self) -> float:
        """Where the second half begins: s, or the step."""
        assert self.scene.log is not None
        entry = self.scene.log.entries[self.until]
        return float(entry.index if entry.t is None else entry.t)


def recorded(scene: Scene) -> Scene:
    """The scene, its simulated run as a log where it has none."""
    if scene.log is not None:
        return scene
    log = Log(tuple(entries_of(scene)), first_belief(scene))
    return replace(scene, log=log, log_source=f"a simulated run of {scene.commands_source}")


def chosen(scene: Scene, keys: Sequence[str]) -> tuple[NoiseNumber, ...]:
    """The numbers that are to be fitted. Raises UsageError where the log's filter has no such."""
    known = noises_of(scene)
    by_key = {one.key: one for one in known}
    for key in keys:
        if key.removeprefix("belief.") not in by_key:
            raise UsageError(f"--fit {key}: no noise that this filter is told of; "
                             f"known: {', '.join(by_key)}")  # fmt: skip
    return tuple(by_key[key.removeprefix("belief.")] for key in keys) if keys else known


def tried(
    scene: Scene, keys: Sequence[str] = (), heard: Callable[[int], None] = lambda _: None
) -> Trial:
    """Fit the numbers of a log's filter. `heard` hears of each trial.

    Raises UsageError where there is too little to fit, or nothing that could be.
    """
    if scene.filter == "pf":
        raise UsageError("pf: its own draws make every trial another; tune ekf or ukf")
    whole = recorded(scene)
    numbers = chosen(whole, keys)
    assert whole.log is not None
    read = [n for n, one in enumerate(whole.log.entries) if isinstance(one.given, Reading)]
    if len(read) < LEAST:
        raise UsageError(f"{scene.commands_source}: {len(read)} readings tell no noise; "
                         f"at least {LEAST} are wanted")  # fmt: skip
    until = read[len(read) // 2]
    fitted = fit(Retold(whole, numbers), until, whole.gate or OUTLIERS, heard)
    names, values = [one.number for one in fitted.found], fitted.values
    tuned = Retold(whole, tuple(names)).with_(values)
    index = whole.log.entries[until].index
    return Trial(whole, tuned, fitted, until, judged(whole, index), judged(tuned, index))


def judged(scene: Scene, first: int) -> Judged:
    """What the readings from the entry of this index on say."""
    evidence, innovations = Evidence(), Innovations()
    at, nis, cost = list[float](), list[float](), 0.0
    for step in play(scene):
        c = step.correction
        if c is None:
            continue
        if not np.isnan(c.nis):
            at.append(float(step.entry.index if step.entry.t is None else step.entry.t))
            nis.append(float(c.nis) / c.innovation.shape[-1])
        if step.entry.index >= first:
            evidence.add(replace(step, nees=None))
            innovations.add(step)
            cost += 0.0 if np.isnan(c.nis) else float(c.nis + np.linalg.slogdet(c.S)[1]) / 2
    return Judged(evidence, innovations.found(), at, nis, cost)
