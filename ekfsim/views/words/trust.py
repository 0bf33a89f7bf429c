"""How far a filter that weighs its readings believed one: why, by which formula, and the value."""

import math

from ekfsim.filters.belief import Correction
from ekfsim.filters.cures.huber import limit
from ekfsim.filters.place import forward
from ekfsim.scene import Scene
from ekfsim.views.words.long_form import SHORT, Form
from ekfsim.views.words.numbers import number

LITTLE = 0.01  # of β; a reading that is believed less changes nothing
HUBER = "w = min(1, k / sqrt(NIS)), k = %s; the reading acts as if %s + (1/w - 1) S were its noise"
MANY = "w = min(1, sqrt(%s / NIS)); the reading acts as if %s + (1/w - 1) S were its noise"
PDAF = (
    "beta = (1 - c) N(r; 0, S) / ((1 - c) N(r; 0, S) + c lambda%s), with c = %s of readings "
    "clutter, lambda = %s %s"
)


def trusted(c: Correction, scene: Scene, form: Form) -> str:
    """A line of its own; nothing of a filter that weighs no reading, or of one that is not used."""
    if c.trust is None or math.isnan(w := float(c.trust)):
        return ""
    told = _weight(c, scene, w) if forward(scene.filter) == "huber" else _beta(w)
    origin = "" if form is SHORT else f"   ({_formula(c, scene)})"
    return f"{told}{origin}\n"


def believed(c: Correction) -> str:
    """The same in a word or two, for a picture; nothing of a reading that is believed whole."""
    if c.trust is None or not float(c.trust) < 1:
        return ""
    return f"believed to {number(float(f'{float(c.trust):.2g}'))}"


def _weight(c: Correction, scene: Scene, w: float) -> str:
    k = math.sqrt(limit(scene.tuning.huber, len(c.innovation)))
    off, bound = number(math.sqrt(float(c.nis))), number(k)
    if w == 1:
        return f"Huber's weight is 1: sqrt(NIS) is {off}, not beyond {bound}"
    return (
        f"Huber's weight is {number(w)}: sqrt(NIS) is {off}, and beyond {bound} a reading pulls no "
        "harder than there"
    )


def _beta(β: float) -> str:
    told = f"beta, how probably the reading is of what was expected and no clutter, is {number(β)}"
    return told + ("; it changes next to nothing" if β < LITTLE else "")


def _formula(c: Correction, scene: Scene) -> str:
    numbers, own = len(c.innovation), scene.tuning
    R = "C_v" if scene.commanded else "R"
    if forward(scene.filter) != "huber":
        power, unit = ("", "per m or rad") if numbers == 1 else (f"^{numbers}", "per m or rad each")
        if scene.commanded:
            unit = "per m"
        return PDAF % (power, number(own.clutter), number(own.clutter_density), unit)
    if numbers == 1:
        return HUBER % (number(own.huber), R)
    return MANY % (number(limit(own.huber, numbers)), R)
