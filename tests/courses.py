"""Runs as they are driven and as they are played, to be held against each other."""

import numpy as np

from ekfsim.localization import play
from ekfsim.views.playback.playback import together


def numbers(view):
    """All that is calculated of a view, as bytes: alike to the last digit or not at all."""
    step = view.step
    parts = [step.entry.truth, *step.prior, *step.posterior, view.path(), view.true.points()]
    parts += [view.reckoned.points()]
    if step.correction is not None:
        c = step.correction
        parts += [c.predicted, c.innovation, c.S, c.H, c.K, c.nis, c.refused]
    told = view.number, view.beam, step.entry.index, step.entry.command, view.judged.lost_from
    return (*told, *(np.asarray(part, float).tobytes() for part in parts))


def everything(views):
    return [[numbers(one) for one in (view, *view.others)] + [view.apart] for view in views]


def played(place):
    """The views of a scene as it is played from its file."""
    first, *others = place.alone()
    names = place.filter, *place.beside
    return everything(together(play(first), map(play, others), names))


def shown(course):
    return everything(course.view(n) for n in range(course.last.number + 1))
