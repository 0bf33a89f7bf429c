"""Whether the numbers of one step hang together: what can be calculated from those printed before
it, whatever world and run they are of.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.printed.narrative.numbers import Check, Formula, Wrong
from ekfsim.student.printed.narrative.reading import Block, Number

AXES = ("x", "y", "θ")
UNITS = ("m", "m", "degrees")
PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
PERIODS = (math.inf, math.inf, 360.0)
RADIAN = math.pi / 180

Whole = Callable[[Array], Array]
Numbers = Sequence[Number]
Due = tuple[Check, Numbers]  # a check, and the numbers that it follows from


@dataclass(frozen=True, slots=True)
class Printed:
    """A belief as it is printed, as much of it as is."""

    state: Numbers | None = None  # x, y in m, θ in degrees
    P: Numbers | None = None  # its nine entries


def printed(block: Block, before: Printed) -> Printed:
    """The belief that a step ends with; what it does not print is not known."""
    which = {"start": "first", "move": "new", "sense": "revised"}.get(block.kind)
    if which is None:
        return before
    return Printed(block.facts.get(f"{which} state"), block.facts.get(f"{which} covariance"))


def begun_with(block: Block, before: Printed) -> Printed:
    """The belief that a step begins with: the state that it prints itself, where it does."""
    return Printed(block.facts.get("current state", before.state), before.P)


def carried_over(block: Block, before: Printed) -> Iterator[Due]:
    """The current state is that which the step before ended with."""
    current = block.facts.get("current state")
    if current is not None and before.state is not None:
        yield from _state("of the current state", current, before.state, lambda n: n[:3])


def moved(block: Block, begun: Printed, u: Numbers | None) -> Iterator[Due]:
    """The new state, by the odometry. u : d in m, a in degrees, None where they are not known"""
    new = block.facts.get("new state")
    if new is None or begun.state is None:
        return
    if u is None:
        yield from _direction(begun.state, new)
        return
    command = block.facts.get("commanded")
    guesses = list[tuple[str, Whole]]()
    if command is not None:
        c = [one.value for one in command]
        guesses.append((COMMANDED, lambda n: _driven(np.array([*n[:3], *c]), n[2])))
    guesses += [
        ("the robot turns before it moves", lambda n: _driven(n, n[2] + n[4])),
        ("cos and sin are taken of degrees", lambda n: _driven(n, n[2] / RADIAN)),
        ("cos and sin are exchanged", lambda n: _driven(n, 90 - n[2])),
        ("a sign is wrong", lambda n: _driven(n, n[2] + 180)),
        ("a sign is wrong", lambda n: _driven(n, -n[2])),
        ("a is not added", lambda n: np.array([*_driven(n, n[2])[:2], n[2]])),
    ]
    yield from _state(
        "of the new state", new, (*begun.state, *u), lambda n: _driven(n, n[2]),
        guesses, read="eqs 3, 4: x + d cos θ, y + d sin θ, θ + a",
    )  # fmt: skip


def sensed(block: Block) -> Iterator[Due]:
    """Innovation and NIS, from the numbers beside them."""
    facts = block.facts
    if all(name in facts for name in ("innovation", "range", "predicted range")):
        yield Check(
            "the innovation", facts["innovation"][0], lambda n: n[0] - n[1], "m",
            (("its sign is wrong", lambda n: n[1] - n[0]),), read="eq 9: r = z - h",
        ), (*facts["range"], *facts["predicted range"])  # fmt: skip
    if all(name in facts for name in ("innovation", "deviation", "NIS")):
        yield Check(
            "NIS", facts["NIS"][0], lambda n: n[0] ** 2 / n[1] ** 2,
            guesses=(("its root is told", lambda n: abs(n[0]) / n[1]),),
        ), (*facts["innovation"], *facts["deviation"])  # fmt: skip


def shape(P: Numbers) -> Iterator[Due]:
    """P is symmetric."""
    for i, j in ((1, 0), (2, 0), (2, 1)):
        name = f"P_{AXES[i]}{AXES[j]}"
        check = Check(name, P[3 * i + j], lambda n: n[0], read="eq 2: P is symmetric")
        yield check, (P[3 * j + i],)


def finite(numbers: Numbers) -> bool:
    """Whether all of them are numbers."""
    return all(math.isfinite(one.value) for one in numbers)


def no_numbers(block: Block) -> Iterator[Wrong]:
    """What is printed and is none."""
    for name, numbers in block.facts.items():
        for one in numbers:
            if not math.isfinite(one.value):
                yield Wrong(one.line, f"the {name}", one.value, math.nan)


def impossible(P: Numbers) -> Iterator[Wrong]:
    """Variances below 0, and correlations beyond 1."""
    for i, name in enumerate(AXES):
        one = P[4 * i]
        if not one.value >= -one.half:
            told = "no variance is negative"
            yield Wrong(one.line, f"P_{name}{name}", one.value, 0.0, "", told, "eq 2", "at least")
    for i, j in ((0, 1), (0, 2), (1, 2)):
        most = math.sqrt(
            max(P[4 * i].value + P[4 * i].half, 0) * max(P[4 * j].value + P[4 * j].half, 0)
        )
        one = P[3 * i + j]
        if abs(one.value) > most + one.half:
            name, bound = f"P_{AXES[i]}{AXES[j]}", math.copysign(most, one.value)
            told, side = "the correlation is beyond 1", "at most" if bound > 0 else "at least"
            yield Wrong(one.line, name, one.value, bound, "", told, "eq 2", side)


def grown(before: Numbers, after: Numbers) -> Iterator[Wrong]:
    """Variances that a reading has made larger."""
    for i, name in enumerate(AXES):
        old, new = before[4 * i], after[4 * i]
        if new.value > old.value + old.half + new.half:
            told = "a reading never makes a variance larger than it was"
            yield Wrong(
                new.line, f"P_{name}{name}", new.value, old.value, "", told, "eqs 11, 12", "at most"
            )


def revised(block: Block, before: Printed) -> Iterator[Due]:
    """The revised state goes along P Jᵀ, in any run."""
    H, new = block.facts.get("derivatives"), block.facts.get("revised state")
    if H is None or new is None or before.state is None or before.P is None:
        return
    if block.unused:
        yield from _state("of the revised state", new, before.state, lambda n: n[:3])
        return
    yield from _state(
        "of the revised state", new, (*before.state, *before.P, *H, *new), _along_gain,
        read="eqs 10, 11: x + K r, K along P J_H'",
    )  # fmt: skip


def revised_covariance(block: Block, before: Printed) -> Iterator[Due]:
    """The revised P is P − s g gᵀ, g = P J_Hᵀ, in any run; s is what its diagonal tells."""
    H, P = block.facts.get("derivatives"), block.facts.get("revised covariance")
    if H is None or P is None or before.P is None or block.unused or any(grown(before.P, P)):
        return
    numbers = (*before.P, *H, *P)
    for i, j in PAIRS:
        yield Check(
            f"P_{AXES[i]}{AXES[j]}", P[3 * i + j], _revised_entry(i, j), least=1e-9,
            read="eqs 11, 12: P - K J_H P, K along P J_H'",
        ), numbers  # fmt: skip


def _revised_entry(i: int, j: int) -> Formula:
    """n : P (9), J_H (3), the printed P (9)"""

    def entry(n: Array) -> float:
        P, after = n[:9].reshape(3, 3), n[12:21].reshape(3, 3)
        g, σ = P @ n[9:12], np.sqrt(np.maximum(np.diagonal(P), 1e-12))
        size = float(np.sum(np.square(g / σ)))
        less = float(np.sum(np.diagonal(P - after) / np.square(σ)))
        return float(P[i, j] - (less / size * g[i] * g[j] if size else 0.0))

    return entry


def moved_covariance(block: Block, begun: Printed) -> Iterator[Due]:
    """P after a move: what no ratio can change."""
    new, P = block.facts.get("new state"), block.facts.get("new covariance")
    if new is None or P is None or begun.state is None or begun.P is None:
        return
    numbers = (*begun.state, *begun.P, *new[:2], *P)
    for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2)):
        yield Check(
            f"P_{AXES[i]}{AXES[j]}", P[3 * i + j], _moved_entry(i, j),
            guesses=((f"J_x is not there: P_{AXES[i]}{AXES[j]} stays as it was", _kept_entry(i, j)),
                     ("the sign of d sin θ or d cos θ in J_x is wrong", _moved_entry(i, j, -1.0))),
            least=1e-9, read="eq 7: J_x P J_x' + J_u P_u J_u'",
        ), numbers  # fmt: skip


COMMANDED = "the command stands here in place of what the odometry measured"


def turned(degrees: float) -> float:
    """An angle in (−180, 180], nan where it is none."""
    return math.remainder(degrees, 360.0) if math.isfinite(degrees) else math.nan


def _driven(n: Array, heading: float) -> Array:
    """x, y, θ, d, a → the pose after it, along a heading in degrees."""
    x, y, θ, d, a = n[:5]
    return np.array([x + d * math.cos(heading * RADIAN), y + d * math.sin(heading * RADIAN), θ + a])


def _state(
    of: str, new: Numbers, numbers: Numbers, formula: Whole,
    guesses: Sequence[tuple[str, Whole]] = (), read: str = "",
) -> Iterator[Due]:  # fmt: skip
    """A check for each entry of a state."""
    for i, axis in enumerate(AXES):
        others = tuple((told, _entry(other, i)) for told, other in guesses)
        yield Check(
            f"{axis} {of}", new[i], _entry(formula, i), UNITS[i], others, PERIODS[i], read=read
        ), numbers  # fmt: skip


def _entry(formula: Whole, i: int) -> Formula:
    return lambda n: float(formula(n)[i])


def _direction(before: Numbers, new: Numbers) -> Iterator[Due]:
    """Without odometry: the way goes along the heading."""
    numbers = (*before[:2], *new[:2])
    x, y = (new[i].value - before[i].value for i in (0, 1))
    way, fine = math.hypot(x, y), 2 * max(one.half for one in numbers)
    if way > 100 * fine:
        direction = Number(math.atan2(y, x) / RADIAN, fine / way / RADIAN, new[0].line)
        yield Check(
            "the direction from the current to the new state", direction, lambda n: n[0],
            "degrees", (("the robot turns before it moves", lambda n: n[1]),), 180.0,
            read="eqs 3, 4: the robot moves along its heading, then turns",
        ), (before[2], new[2])  # fmt: skip


def _along_gain(n: Array) -> Array:
    """The revised state nearest to the printed one on the line x + t P J_Hᵀ.

    n : state (3), P (9), J_H (3), the printed revised state (3)
    """
    P, H = n[3:12].reshape(3, 3), n[12:15]
    g = P @ H
    apart = n[15:18] - n[:3]
    apart[2] = turned(float(apart[2])) * RADIAN
    σ = np.sqrt(np.maximum(np.diagonal(P), 1e-12))
    size = float((g / σ) @ (g / σ))
    t = float((apart / σ) @ (g / σ)) / size if size else 0.0
    along: Array = n[:3] + t * g * np.array([1.0, 1.0, 1 / RADIAN])
    return along


def _moved_entry(i: int, j: int, sign: float = 1.0) -> Formula:
    """An entry of P after a move, σ_d² being what the trace of the position tells.

    n : state (3), P (9), the new position (2), the printed P (9)
    """

    def entry(n: Array) -> float:
        F = np.eye(3)
        F[0, 2], F[1, 2] = sign * (n[1] - n[13]), sign * (n[12] - n[0])
        spread, P = F @ n[3:12].reshape(3, 3) @ F.T, n[14:23].reshape(3, 3)
        added = float(np.trace((P - spread)[:2, :2]))
        way = np.array([math.cos(n[2] * RADIAN), math.sin(n[2] * RADIAN), 0.0])
        return float(spread[i, j] + added * way[i] * way[j])

    return entry


def _kept_entry(i: int, j: int) -> Formula:
    return lambda n: float(n[3:12].reshape(3, 3)[i, j])
