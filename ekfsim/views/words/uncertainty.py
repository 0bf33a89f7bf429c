"""What is said of a belief: how uncertain it is, and how it stands beside the truth."""

import numpy as np

from ekfsim.diagnostics.coverage import inside_cone, inside_ellipse
from ekfsim.diagnostics.verdict import SURPRISING
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Belief, Correction, Gaussian, Particles
from ekfsim.geometry.ellipse import cone_factor, cone_halfwidth, ellipse
from ekfsim.records import Nees, Step
from ekfsim.views.playback.view import View
from ekfsim.views.words.numbers import fine, heading, number, turn

NO_IDEA_YET = (
    "No idea yet where the robot is: its particles lie all over the room, mean and covariance are "
    "theirs and no place, and no ellipse is drawn\n"
)


def uncertain(view: View, probability: float) -> str:
    """How uncertain the pose is in a view, and how it stands beside the truth; that there is no
    idea, where its particles may be anywhere.
    """
    if view.unplaced:
        return NO_IDEA_YET
    pose = view.pose
    return uncertainty(pose, probability) + judged(view.step, pose, probability)


def uncertainty(pose: Gaussian, probability: float) -> str:
    """The ellipse of the position and the cone of the heading."""
    drawn, factor = ellipse(pose.covariance, probability), cone_factor(probability)
    halfwidth = cone_halfwidth(float(pose.covariance[2, 2]), probability)
    return (
        "Uncertainty ellipse is:\n"
        f"  minor radius is {fine(float(drawn.minor))}\n"
        f"  major radius is {fine(float(drawn.major))}\n"
        f"  orientation is {heading(float(drawn.orientation))} degrees\n"
        f"  {factor:.4g}*sigma_theta is {turn(halfwidth)} degrees\n"
    )


def judged(step: Step, pose: Gaussian, probability: float) -> str:
    """The belief of the pose after a step held against the truth, where the truth is known."""
    if step.entry.truth is None or step.nees is None:
        return ""
    ellipse_side = "inside" if inside_ellipse(pose, step.entry.truth, probability) else "outside"
    cone_side = "inside" if inside_cone(pose, step.entry.truth, probability) else "outside"
    told = (
        f"The true position lies {ellipse_side} the ellipse, "
        f"the true heading {cone_side} the cone; "
    )
    return told + _nees(step.nees)


def _nees(measured: Nees) -> str:
    if measured.impossible:
        return (
            "the belief is impossible: the error has a part where the covariance claims certainty\n"
        )
    value, dof = float(measured.value), int(measured.dof)
    told = f"NEES is {number(value)} ({dof} {'degree' if dof == 1 else 'degrees'} of freedom)\n"
    return told + (surprise("NEES", value, dof) if dof else "")


def surprise(name: str, value: float, dof: int) -> str:
    """A line of its own for a single value above its 99 % quantile.
    A small one is none: 0 is the mode of χ²₁.
    """
    limit = quantile(SURPRISING, dof)
    if value <= limit:
        return ""
    return f"{name} lies above its {100 * SURPRISING:.0f} % quantile, {number(limit)}\n"


def rest(c: Correction) -> str:
    """A line of its own where the search of an iterated filter was cut off;
    all others need none.
    """
    if c.settled:
        return ""
    return (
        "The search for the most probable state did not settle: "
        "where it was cut off stands for the end of it\n"
    )


def crowd(belief: Belief) -> str:
    """How many of the particles count, where the belief is a crowd:
    1/Σ wᵢ² alike ones say as much.
    """
    if not isinstance(belief, Particles):
        return ""
    told = _weighed(belief)
    if type(belief) is Particles:
        return told
    from ekfsim.filters.particles.roaming import Roaming  # which no other filter needs

    if not isinstance(belief, Roaming):
        return told
    return (
        f"{told}Readings were explained to {float(belief.fast):.2f} lately, and to "
        f"{float(belief.slow):.2f} over long, of 1: {float(belief.astray):.0%} of the next crowd "
        "come from anywhere\n"
    )


def _weighed(belief: Particles) -> str:
    weights = belief.weights
    if np.all(weights == weights[0]):
        return (
            "The particles were weighed by the reading, "
            f"and {len(weights)} alike ones drawn anew by their weights\n"
        )
    alike = 1 / float(np.sum(weights**2))
    return (
        "The particles were weighed by the reading; "
        f"the {len(weights)} say as much as {alike:.0f} alike\n"
    )
