"""What is said of a belief of several Gaussians: how sure each is, where, of which wall, and what
became of those before: parted, merged, pruned, or sought elsewhere.
"""

from collections import Counter

import numpy as np

from ekfsim.diagnostics.ambiguity import BeamSensor
from ekfsim.filters.belief import Mixture
from ekfsim.models.sensors.mounted import bare
from ekfsim.records import Reading, Step
from ekfsim.views.words.beams.told import wall_name
from ekfsim.views.words.numbers import number, pose

SOUGHT = "No hypothesis explains the last readings: the robot was probably carried away\n"
WRITTEN = 0.01  # a lighter hypothesis is counted in a picture, and its weight not told
ORDINAL = "heaviest", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"


def hypotheses(step: Step) -> str:
    """What a reading made of the hypotheses before it, and a line for each that it left; nothing of
    other beliefs, nor where there is one hypothesis and was one.
    """
    belief = step.posterior
    if not isinstance(belief, Mixture) or step.correction is None:
        return ""
    used = [i for i, w in enumerate(belief.weights.tolist()) if w > 0]
    merged, pruned = belief.merged.tolist(), int(belief.pruned)
    parents = [int(belief.parents[i]) for i in used]
    if len(used) == 1 and merged[used[0]] < 2 and not pruned and parents[0] >= 0:
        return ""
    before = _number_before(step)
    told = _sought(parents)
    told += "It parted: " if before == 1 < len(used) and min(parents) == 0 else ""
    told += "1 hypothesis is left" if len(used) == 1 else f"{len(used)} hypotheses are left"
    told += f" of {before}" if before > 1 else ""
    if pruned:
        told += f"; the lightest {'was' if pruned == 1 else f'{pruned} were'} pruned"
    told += ":\n"
    given = step.entry.given
    beam = isinstance(given, Reading) and isinstance(bare(given.sensor), BeamSensor)
    for i, parent in zip(used, parents, strict=True):
        x = step.layout.pose(belief.means[i])
        told += f"  weight {number(float(belief.weights[i]))} at {pose(x.tolist())}"
        if beam and belief.walls[i] >= 0:
            told += f": the beam met {wall_name(step, int(belief.walls[i]))}"
        told += _origin(parent, Counter(parents), before)
        told += f"; {merged[i]} merged\n" if merged[i] > 1 else "\n"
    return told


def _number_before(step: Step) -> int:
    """How many hypotheses there were before the reading."""
    prior = step.prior
    return int((prior.weights > 0).sum()) if isinstance(prior, Mixture) else 1


def weights(step: Step) -> list[str]:
    """How heavy each hypothesis is, for a picture, and that the robot was sought elsewhere; nothing
    where there is one, and it was sought nowhere.
    """
    belief = step.posterior
    if not isinstance(belief, Mixture):
        return []
    used = belief.weights > 0
    found = bool((belief.parents[used] < 0).any())
    if np.count_nonzero(used) < 2 and not found:
        return []
    heavy = [f"{w:.2f}" for w in belief.weights[used].tolist() if w >= WRITTEN]
    lighter = np.count_nonzero(used) - len(heavy)
    each = ", ".join(heavy) + (f" and {lighter} lighter" if lighter else "")
    if found:
        return [f"no hypothesis explained the last readings: sought in the whole map; {each}"]
    return [f"hypotheses: {each}"]


def _sought(parents: list[int]) -> str:
    """That the robot was sought elsewhere, where it was."""
    if not (found := parents.count(-1)):
        return ""
    are = "is" if found == 1 else "are"
    return f"{SOUGHT}In the whole map it was sought: {found} of the hypotheses {are} found there\n"


def _origin(parent: int, all_of: Counter[int], before: int) -> str:
    """Where a hypothesis comes from: found elsewhere, or of one that parted, or that was not the
    only one.
    """
    if parent < 0:
        return "; found elsewhere"
    if before == 1:
        return ""
    name = ORDINAL[parent] if parent < len(ORDINAL) else f"{parent + 1}th"
    return f"; {'one part of' if all_of[parent] > 1 else 'was'} the {name} before"
