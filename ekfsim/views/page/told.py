"""What a page holds of one view: its words, what each filter believes, and by which matrices."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ekfsim.commands import Say
from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Particles, parts
from ekfsim.geometry import Array
from ekfsim.printable import shown
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene
from ekfsim.views.page.numbers import length, points, row, rows, short, triangle
from ekfsim.views.page.seen import seen
from ekfsim.views.picture.look import Look
from ekfsim.views.picture.panels import CERTAIN, close_width
from ekfsim.views.picture.sights import sight
from ekfsim.views.playback.trail import Way
from ekfsim.views.playback.view import View
from ekfsim.views.words.beams.beam import beam
from ekfsim.views.words.captions import away, notes, spread, title
from ekfsim.views.words.judgement import judgement, standing
from ekfsim.views.words.narrative.narrating import narrate

FAR = 2  # of what is shown of the plane: how long a beam is drawn that meets nothing
CROWD = 150  # particles that are drawn of a belief, at most


@dataclass
class Lines:
    """Lines of text, each of which a page holds once."""

    texts: list[str] = field(default_factory=list)
    _places: dict[str, int] = field(default_factory=dict)

    def places(self, text: str) -> list[int]:
        """Where the lines of a text stand."""
        return [self._place(line) for line in text.rstrip("\n").split("\n")]

    def _place(self, line: str) -> int:
        if line not in self._places:
            self._places[line] = len(self.texts)
            self.texts.append(line)
        return self._places[line]


@dataclass
class Teller:
    """Tells views of one scene, one after another."""

    scene: Scene
    look: Look
    origin: Array  # (2,) m
    size: float  # m, the longer side of what is shown of the plane
    total: int  # commands, 0 where that is not known
    lines: Lines = field(default_factory=Lines)
    following: int = 0  # the number of the view that comes next where none is left out

    def tell(self, view: View) -> dict[str, Any]:
        """All that the page holds of it. Keys of what is not there are left out."""
        entry, alone = view.step.entry, self.scene.alone()
        read = (beam(view.step, self.scene) or sight(view.step)) if view.beam else None
        told: dict[str, Any] = {
            "step": entry.index,
            "title": shown(title(view, self.total)),
            "judged": judgement(view, self.scene, self.look.probability),
            "notes": [shown(note) for note in notes(view, self.scene, read, self.look.probability)],
            "by": [
                self._believed(each, one)
                for each, one in zip((view, *view.others), alone, strict=True)
            ],
            "wide": short(close_width(view, self.look.probability, CERTAIN * self.size)),
            "true": view.true.n,
            "reckoned": view.reckoned.n,
        }
        if (hidden := self._away(view)) is not None:
            told["away"] = hidden
        if view.beam:
            told["beam"] = 1
        if view.number != self.following:
            told["apart"] = 1
        self.following = view.number + 1
        if isinstance(entry.command, Say):
            told["say"] = shown(entry.command.text.strip())
        if entry.truth is not None:
            told["truth"] = self._pose(entry.truth)
        if entry.fix is not None and not self.scene.log:
            told["fix"] = points(entry.fix[None], self.origin)
        if view.inputs > 1:
            told["inputs"] = view.inputs
        return told

    def _believed(self, view: View, scene: Scene) -> dict[str, Any]:
        """What one of the filters believes, and what is said of it."""
        stands, nees, c = (
            standing(view, self.look.probability),
            view.step.nees,
            view.step.correction,
        )
        told: dict[str, Any] = {
            "pose": self._pose(view.pose.mean),
            "P": triangle(view.belief.covariance),
            "path": view.settled.n,
            "spread": spread(view, self.look.probability),
            "told": self.lines.places(narrate(view, scene, self.look.probability)),
            "long": self.lines.places(narrate(view, scene, self.look.probability, explain=True)),
            **self._linearised(view),
        }
        if told["long"] == told["told"]:
            del told["long"]
        if view.unplaced:
            told["unplaced"] = 1
        if stands.outside_ellipse or stands.outside_cone:
            told["outside"] = [int(stands.outside_ellipse), int(stands.outside_cone)]
        if stands.lost_from is not None:
            told["lost"] = stands.lost_from
        if not view.beam and nees is not None and int(nees.dof):
            bound = short(quantile(LOST, int(nees.dof)))
            told["nees"] = [None if nees.impossible else short(float(nees.value)), bound]
        if c is not None and not np.isnan(c.nis):
            told["nis"] = [short(float(c.nis)), short(quantile(LOST, len(c.innovation)))]
        if isinstance(view.belief, Particles):
            states = view.layout.pose(view.belief.states)[:, :2]
            told["crowd"] = points(states[:: max(1, len(states) // CROWD)][:CROWD], self.origin)
        if several := parts(view.belief, view.layout):
            told["several"] = [
                [short(w), *points(x[None, :2], self.origin), *triangle(P[:2, :2])]
                for w, (x, P) in several
            ]
        return told

    def _linearised(self, view: View) -> dict[str, Any]:
        """The matrices that made the belief, and what is drawn of the reading while it is shown."""
        step, given = view.step, view.step.entry.given
        if isinstance(given, Control) and step.prediction is not None:
            F, G = step.prediction.F, step.prediction.G
            return {"F": rows(F), "G": rows(G), "u": [what.name for what in given.motion.inputs]}
        c = step.correction
        if not isinstance(given, Reading) or c is None:
            return {}
        told: dict[str, Any] = {
            "z": [what.name for what in given.sensor.outputs],
            "H": rows(c.H),
            "R": rows(c.R),
            "S": rows(c.S),
            "ν": row(c.innovation.tolist()),
            "K": rows(c.K),
        }
        if view.beam:
            told["seen"] = seen(step, self.scene, self.origin, FAR * self.size)
        return told

    def _away(self, view: View) -> str | None:
        """Where the truth is, while the close-up does not show it."""
        truth = view.step.entry.truth
        wide = close_width(view, self.look.probability, CERTAIN * self.size)
        hidden = (
            not view.unplaced
            and truth is not None
            and abs(truth[:2] - view.pose.mean[:2]).max() > wide / 2
        )
        return away(view.step, view) if hidden else None

    def _pose(self, pose: Array) -> list[Any]:
        x, y, θ = pose.tolist()
        return [length(x - float(self.origin[0])), length(y - float(self.origin[1])), length(θ)]


def way(last: Way, origin: Array) -> list[Any]:
    """The whole of a way, of which each view shows its own part."""
    return points(last.points(), origin)


def ways(view: View, origin: Array) -> dict[str, Any]:
    """The ways of a run, as they are in its last view."""
    each: Sequence[View] = (view, *view.others)
    return {
        "paths": [way(one.settled, origin) for one in each],
        "true": way(view.true, origin),
        "reckoned": way(view.reckoned, origin),
    }
