"""What is said of a belief of several Gaussians: how sure each is, where, and of which wall."""

from ekfsim.diagnostics.ambiguity import BeamSensor
from ekfsim.filters.belief import Mixture
from ekfsim.models.sensors.mounted import bare
from ekfsim.records import Reading, Step
from ekfsim.views.words.beams.told import wall_name
from ekfsim.views.words.numbers import number, pose


def hypotheses(step: Step) -> str:
    """A line for each hypothesis that a reading left, what was merged in it, and how many it left
    without a place; nothing of other beliefs, nor where there is one hypothesis and was one.
    """
    belief = step.posterior
    if not isinstance(belief, Mixture):
        return ""
    used = [i for i, w in enumerate(belief.weights.tolist()) if w > 0]
    merged, pruned = belief.merged.tolist(), int(belief.pruned)
    if len(used) == 1 and merged[used[0]] < 2 and not pruned:
        return ""
    told = "1 hypothesis is left" if len(used) == 1 else f"{len(used)} hypotheses are left"
    if pruned:
        told += f"; the lightest, {pruned} in number, {'was' if pruned == 1 else 'were'} pruned"
    told += ":\n"
    given = step.entry.given
    beam = isinstance(given, Reading) and isinstance(bare(given.sensor), BeamSensor)
    for i in used:
        x = step.layout.pose(belief.means[i])
        told += f"  weight {number(float(belief.weights[i]))} at {pose(x.tolist())}"
        if beam and belief.walls[i] >= 0:
            told += f": the beam met {wall_name(step, int(belief.walls[i]))}"
        told += f"; {merged[i]} merged\n" if merged[i] > 1 else "\n"
    return told
