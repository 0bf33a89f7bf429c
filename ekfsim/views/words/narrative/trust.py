"""How far a filter that weighs its readings believed one, and what a filter that learns their noise
has learnt: why, by which formula, and the value.
"""

import math
from statistics import NormalDist

from ekfsim.diagnostics.shutting_out import ShutOut
from ekfsim.filters.belief import Correction
from ekfsim.filters.cures.huber import limit
from ekfsim.filters.place import forward
from ekfsim.scene import Scene
from ekfsim.views.words.narrative.long_form import SHORT, Form
from ekfsim.views.words.numbers import number

LITTLE = 0.01  # of β; a reading that is believed less changes nothing
HUBER = "w = min(1, k / sqrt(NIS)), k = %s; the reading acts as if %s + (1/w - 1) S were its noise"
MANY = "w = min(1, sqrt(%s / NIS)); the reading acts as if %s + (1/w - 1) S were its noise"
PDAF = (
    "beta = (1 - c) N(r; 0, S) / ((1 - c) N(r; 0, S) + c lambda%s), with c = %s of readings "
    "clutter, lambda = %s %s"
)

LEARNT = (
    "s <- a s + (1 - a) seen, a = %s; seen = %s, the factor on the told %s that this reading "
    "speaks for"
)
ONE, SEVERAL = "s + s (%s / S) (NIS - 1)", "tr(R^-1 (e e' + H P H')) / %s, e = z - h - H K r"


def trusted(c: Correction, scene: Scene, form: Form) -> str:
    """A line of its own; nothing of a filter that weighs no reading, or of one that is not used."""
    if c.trust is None or math.isnan(w := float(c.trust)):
        return ""
    told = _weight(c, scene, w) if forward(scene.filter) == "huber" else _beta(w)
    origin = "" if form is SHORT else f"   ({_formula(c, scene)})"
    return f"{told}{origin}\n"


def believed(c: Correction) -> str:
    """The same in a word or two, for a picture; nothing of a reading that is believed whole."""
    if c.noise_factor is not None and c.used:
        ratio = number(float(f"{math.sqrt(float(c.noise_factor)):.2g}"))
        return f"learnt: {ratio} times the told σ"
    if c.trust is None or not float(c.trust) < 1:
        return ""
    return f"believed to {number(float(f'{float(c.trust):.2g}'))}"


def shutting_out(found: ShutOut, lost: bool) -> str:
    """That a filter believes its readings no more, and what comes of it. lost : the run is"""
    of, weighing = f"{found.doubted} of the {found.readings} readings", found.weighing
    since = f"since step {found.since}"
    if weighing.name == "huber":
        limit = f"{number(sigmas(weighing.rare))} sigma"
        seldom = f"where 1 in {1 / weighing.rare:.3g} would"
        beyond = f"{of} {since} lay beyond {limit} of what huber expected, {seldom}"
        end = ", and together they could not call it back" if lost else ""
        return f"{beyond}; each pulled no harder than one at {limit}{end}"
    little = f"beta was below {number(weighing.little)} in {of} {since}"
    if not lost:
        told = f"{number(100 * weighing.rare)} %"
        return f"{little}: pdaf took them for clutter, of which it expects {told}"
    return (
        f"{little}: pdaf took them for clutter, for its own ellipse was too small, and so they "
        "could not call it back"
    )


def shut_briefly(found: ShutOut) -> str:
    """The same for a picture."""
    of = f"{found.doubted} of {found.readings} readings since step {found.since}"
    if found.weighing.name == "huber":
        return f"{of} lay beyond {number(sigmas(found.weighing.rare))}σ"
    return f"it took {of} for clutter"


def sigmas(rare: float) -> float:
    """Beyond how many σ an innovation lies with that probability.

    >>> round(sigmas(math.erfc(2 / math.sqrt(2))), 12)
    2.0
    """
    return NormalDist().inv_cdf(1 - rare / 2)


def learnt(c: Correction, scene: Scene, form: Form) -> str:
    """A line of its own; nothing of a filter that learns no noise, or of a reading that is not
    used.
    """
    if c.noise_factor is None or not c.used:
        return ""
    s, numbers, R = float(c.noise_factor), len(c.innovation), "C_v" if scene.commanded else "R"
    seen = ONE % R if numbers == 1 else SEVERAL % numbers
    told = LEARNT % (number(scene.tuning.adaptive), seen, R)
    origin = "" if form is SHORT else f"   ({told})"
    return (
        f"As the filter has learnt, such readings have {number(math.sqrt(s))} times the sigma that "
        f"it is told; s, the square of that factor, is {number(s)}{origin}\n"
    )


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
