"""Where the cost of a set of numbers is least, and how far each can be moved until it has risen by
so much: Newton's method in the logarithms of numbers, the points of a step tried side by side.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array

STEP = 0.05  # of a derivative, in the logarithm
FLAT = 0.05  # of a second derivative, by which it is taken to curve where it hardly does
DAMPINGS = (0.0, 1.0, 10.0, 100.0)  # of a step downhill: the first is Newton's own
LONGEST = 1.5  # of a step, in the logarithm
STEPS = 25  # at most, downhill
ENDS = 16  # at most, to the end of an interval
SETTLED = 1e-4  # of a cost: a step that promises less is not taken
CREDIBLE = 0.5  # of a cost: where the others promise more, they have not followed yet
NARROW = 0.005  # of where an end lies, in the logarithm
REACHED = 0.02  # of a cost, at the end of an interval

Costs = Callable[[Array], Array]  # of points (m, n) : (m)


@dataclass(frozen=True)
class Bowl:
    """A cost near a point, to the second order."""

    at: Array  # (n,)
    cost: float
    g: Array  # (n,) its first derivatives
    H: Array  # (n, n) its second derivatives

    def step(self, damping: float) -> Array:
        """Downhill, as far as a bowl of such curves would have it: −(|H| + damping)⁻¹ g, (n,)"""
        curved = upright(self.H) + damping * np.eye(len(self.g))
        return shortened(np.linalg.solve(curved, -self.g).astype(float))

    @property
    def promise(self) -> float:
        """By how much the cost is expected to fall in one step."""
        return float(self.g @ np.linalg.solve(upright(self.H), self.g)) / 2


def bowls(costs: Costs, points: Array, others: Array) -> tuple[list[Bowl], Array]:
    """The cost near each of some points (m, n), and that of others (k, n), all tried at once."""
    stencil = stencil_of(points.shape[1])
    tried = (points[:, None] + STEP * stencil).reshape(-1, points.shape[1])
    found = costs(np.concatenate([tried, others]))
    near = found[: len(tried)].reshape(len(points), -1)
    return [_bowl(at, some) for at, some in zip(points, near, strict=True)], found[len(tried) :]


def stencil_of(n: int) -> Array:
    """Nowhere, each way up, each way down, each two ways up : (1 + 2 n + n (n − 1)/2, n)"""
    ways = np.eye(n)
    both = [ways[i] + ways[j] for i in range(n) for j in range(i)]
    return np.array([np.zeros(n), *ways, *-ways, *both])


def _bowl(at: Array, found: Array) -> Bowl:
    """What the costs of a stencil say. found : as the stencil is long"""
    n, here = len(at), float(found[0])
    up, down, both = found[1 : n + 1], found[n + 1 : 2 * n + 1], iter(found[2 * n + 1 :])
    H = np.diag(up - 2 * here + down)
    for i in range(n):
        for j in range(i):
            H[i, j] = H[j, i] = next(both) - up[i] - up[j] + here
    return Bowl(at, here, (up - down) / (2 * STEP), H / STEP**2)


def upright(H: Array) -> Array:
    """H with its curvatures taken upwards, and none less than FLAT : (n, n)"""
    curvatures, V = np.linalg.eigh(H)
    curved: Array = (V * np.maximum(np.abs(curvatures), FLAT)) @ V.T
    return curved


def shortened(step: Array) -> Array:
    """A step no longer than LONGEST."""
    longest = float(np.abs(step).max(initial=0.0))
    return step if longest <= LONGEST else step * (LONGEST / longest)


def none(point: Array) -> Array:
    """No points : (0, n)"""
    return np.empty((0, len(point)))


def lowest(costs: Costs, start: Array, far: float) -> Bowl:
    """The cost where it is least, no further than `far` from the start (n,) in any number."""
    (here,), _ = bowls(costs, start[None], none(start))
    for _ in range(STEPS):
        if here.promise < SETTLED:
            break
        steps = np.array([here.step(damping) for damping in DAMPINGS])
        points = np.clip(here.at + steps, start - far, start + far)
        (there,), others = bowls(costs, points[:1], points[1:])
        least = int(np.argmin([there.cost, *others]))
        if least:
            (there,), _ = bowls(costs, points[least : least + 1], none(start))
        if there.cost > here.cost - SETTLED:
            return there if there.cost < here.cost else here
        here = there
    return here


@dataclass
class End:
    """One end of the interval of one number, as far as it is found."""

    i: int
    way: int  # 1 up, −1 down
    at: Array  # (n,)
    inside: float = 0.0  # so far away from the best the cost has not yet risen enough
    outside: float = np.inf  # and so far it has
    done: bool = False
    open: bool = False  # the cost never rises so far


def ends(
    costs: Costs, best: Bowl, rise: float, farthest: tuple[float, float]
) -> tuple[list[End], Bowl]:
    """How far each number can be moved down, and up, all others being the most likely ones then,
    until the cost has risen: the ends of the profile likelihood's intervals (Venzon & Moolgavkar,
    A method for computing profile-likelihood-based confidence intervals, 1988). And the lowest bowl
    that was met: a filter that predicts another wall makes the cost jump, and the best may have
    been one of several.

    farthest : down and up; an end that is not found so far is open. In the order of the numbers,
    the lower end first.
    """
    covariance, lowest = np.linalg.inv(upright(best.H)), best
    found = []
    for i, ridge in enumerate(covariance):
        for way in (-1, 1):
            step = way * np.sqrt(2 * rise / ridge[i]) * ridge
            found.append(End(i, way, best.at + shortened(step)))
    for _ in range(ENDS):
        looked = [end for end in found if not end.done]
        if not looked:
            break
        near, _ = bowls(costs, np.array([end.at for end in looked]), none(best.at))
        for end, bowl in zip(looked, near, strict=True):
            lowest = bowl if bowl.cost < lowest.cost else lowest
            _moved(end, bowl, best, rise, farthest[end.way > 0])
    for end in found:
        if not end.done and np.isfinite(end.outside):
            end.at[end.i] = best.at[end.i] + end.way * end.outside
    return found, lowest


def _moved(end: End, bowl: Bowl, best: Bowl, rise: float, farthest: float) -> None:
    """One step of an end to where the bowl there has the cost risen, the others lowest:

    least(δ) = A + B δ + C δ²/2, the cost where the number is moved by δ and the others follow

    What is known of where the end lies, inside and outside, wins over what the bowl promises.
    """
    i, rest = end.i, np.arange(len(bowl.at)) != end.i
    followed = np.linalg.inv(upright(bowl.H[rest][:, rest]))
    along, g = bowl.H[rest, i], bowl.g[rest]
    promise = float(g @ followed @ g) / 2
    left = rise - (bowl.cost - best.cost - promise)
    gone = end.way * float(bowl.at[i] - best.at[i])
    if left > 0:
        end.inside = max(end.inside, gone)
    elif promise < CREDIBLE:
        end.outside = min(end.outside, gone)
    if end.inside >= end.outside:  # it rose enough, and less farther out: the end is out there
        end.outside = np.inf
    if abs(left) < REACHED and promise < REACHED:
        end.done = True
        return
    B, C = bowl.g[i] - along @ followed @ g, bowl.H[i, i] - along @ followed @ along
    then = gone + end.way * _root(end.way, left, float(B), float(C))
    if not end.inside < then < end.outside:
        near, far = end.inside, min(end.outside, end.inside + LONGEST)
        then = (near + far) / 2 if end.outside < np.inf else far
    at = bowl.at.copy()
    at[i] = best.at[i] + end.way * then
    at[rest] += shortened(-followed @ (g + along * (at[i] - bowl.at[i])))
    end.at = at
    end.open = then > farthest
    end.done = end.open or end.outside - end.inside < NARROW


def _root(way: int, left: float, B: float, C: float) -> float:
    """δ, no longer than LONGEST: B δ + C δ²/2 = left on the side where the cost rises."""
    inside = B * B + 2 * C * left
    if way * B <= 0 and inside <= 0:
        return way * LONGEST  # it does not rise here at all
    root = np.sqrt(max(inside, 0.0))
    bottom = B + way * root
    δ = 2 * left / bottom if bottom != 0 else way * LONGEST
    return float(np.clip(δ, -LONGEST, LONGEST))
