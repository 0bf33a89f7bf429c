"""The whole of a trace once more, from its raw readings and from the words of its definition, in
plain floats.

`true_course` plays the robot from the draws; `believed` filters what a trace says that the robot
measured. Nothing of ekfsim is used but the description of the world.
"""

import math

import numpy as np
import shapely
from scipy.stats import chi2

from ekfsim.commands import Kidnap, Move, Repeat, Say

FAR = math.inf


def expanded(commands):
    for command in commands:
        if isinstance(command, Repeat):
            yield from list(expanded(command.commands)) * command.times
        else:
            yield command


def wrapped(angle):
    """In (−π, π]."""
    turned = math.remainder(angle, 2 * math.pi)
    return math.pi if turned == -math.pi else turned


class Edges:
    """The edges of a map, each with its polygon, its number there and the straight line it lies
    on."""

    def __init__(self, floor_plan):
        everywhere = shapely.box(-1e9, -1e9, 1e9, 1e9)
        indoors = (
            everywhere if floor_plan.boundary is None else shapely.Polygon(floor_plan.boundary)
        )
        self.open = indoors - shapely.union_all(
            [shapely.Polygon(o.points) for o in floor_plan.obstacles]
        )
        self.all = []
        for name, ring in floor_plan.rings():
            points = ring.tolist()
            if points[0] == points[-1]:
                points = points[:-1]
            size = max(math.dist(points[0], point) for point in points)
            lines = []
            for number, (a, b) in enumerate(zip(points, points[1:] + points[:1], strict=True)):
                if a == b:
                    continue
                same = next(
                    (k for k, (p, q) in enumerate(lines) if straight(p, q, a, b, 1e-9 * size)),
                    len(lines),
                )
                if same == len(lines):
                    lines.append((a, b))
                self.all.append((a, b, name, number, (name, same)))

    def first(self, x, y, heading):
        """Range and edge along a beam; FAR and None where there is none."""
        dx, dy = math.cos(heading), math.sin(heading)
        hits = [(self._range(edge, x, y, dx, dy), k) for k, edge in enumerate(self.all)]
        nearest = min((r for r, _ in hits), default=FAR)
        if nearest == FAR:
            return FAR, None
        return next(
            (nearest, self.all[k]) for r, k in hits if r <= nearest + 1e-12 * (10 + nearest)
        )

    @staticmethod
    def _range(edge, x, y, dx, dy):
        (ax, ay), (bx, by), *_ = edge
        sx, sy = bx - ax, by - ay
        wx, wy = ax - x, ay - y
        slant = dx * sy - dy * sx
        length = math.hypot(sx, sy)
        if abs(slant) <= 1e-15 * length:
            return FAR
        r, s = (wx * sy - wy * sx) / slant, (wx * dy - wy * dx) / slant
        slack = 1e-14 * (1 + abs(x) + abs(y)) / abs(slant)
        return max(r, 0.0) if r >= -1e-14 and -slack <= s <= 1 + slack else FAR


def straight(p, q, a, b, near):
    """Whether both a and b lie on the line through p and q."""
    length = math.dist(p, q)
    return all(
        abs((q[0] - p[0]) * (c[1] - p[1]) - (q[1] - p[1]) * (c[0] - p[0])) <= near * length
        for c in (a, b)
    )


def draws(seed, i, run):
    """Normals and uniforms of draw i of a run."""
    generator = np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, i, run // 1024])))
    normals, uniforms = generator.standard_normal((1024, 4)), generator.random((1024, 2))
    return normals[run % 1024].tolist(), uniforms[run % 1024].tolist()


def true_course(scene):
    """What happens in a run, from its draws: truth, bump, odometry or range of each step."""
    world, edges = scene.world, Edges(scene.world.map)
    noise, faults = world.noise, world.faults
    normals, _ = draws(scene.seed, 0, scene.run)
    x, y, th = (
        m + s * n
        for m, s, n in zip(world.start.tolist(), world.start_sigma.tolist(), normals, strict=False)
    )
    th = wrapped(th)
    yield {"truth": [x, y, th]}
    i = 0
    for command in expanded(scene.commands):
        line = {}
        if isinstance(command, Kidnap):
            x, y, th = command.x, command.y, wrapped(command.theta)
        elif isinstance(command, Move):
            i += 1
            (n0, n1, n2, n3), _ = draws(scene.seed, i, scene.run)
            d, a, slip = command.distance, command.angle, command.slip
            wheels = d + noise.execution_distance * abs(d) * n0
            way = (1 - slip) * wheels
            free, edge = edges.first(x, y, th if way >= 0 else th + math.pi)
            free = max(free - 0.001, 0.0)
            line["bump"] = edge[2] if edge and abs(way) > free else None
            way = math.copysign(min(abs(way), free), way)
            turn = a + noise.execution_angle * abs(a) * n1
            rolled = way / (1 - slip) if slip < 1 else wheels
            line["odometry"] = {
                "distance": faults.odometry_distance_scale * rolled
                + noise.odometry_distance * abs(rolled) * n2,
                "angle": faults.odometry_angle_scale * turn + noise.odometry_angle * abs(turn) * n3,
            }
            x, y, th = x + way * math.cos(th), y + way * math.sin(th), wrapped(th + turn)
        elif not isinstance(command, Say):
            i += 1
            (n0, *_), (u0, u1) = draws(scene.seed, i, scene.run)
            r, _ = edges.first(x, y, th + command.angle)
            if u0 < faults.short_returns:
                r = u1 * r
            reading = (
                faults.range_scale * r + faults.range_bias + noise.range * r * n0
                if r < FAR
                else FAR
            )
            line["range"] = max(0.0, reading) if r < FAR else None
        yield {**line, "truth": [x, y, th]}


def product(A, B):
    return [
        [sum(a * b for a, b in zip(row, column, strict=True)) for column in zip(*B, strict=True)]
        for row in A
    ]


def transposed(A):
    return [list(column) for column in zip(*A, strict=True)]


def total(A, B):
    return [[a + b for a, b in zip(p, q, strict=True)] for p, q in zip(A, B, strict=True)]


def halved(A):
    return [[(A[i][j] + A[j][i]) / 2 for j in range(len(A))] for i in range(len(A))]


def believed(scene, lines, confidence):
    """Every line of a trace that a filter must write for the raw readings in `lines`."""
    told, noise = scene.world.told, scene.world.told.noise
    edges = Edges(told.map)
    mean = told.start.tolist()
    P = [[float(s) ** 2 if i == j else 0.0 for j in range(3)] for i, s in enumerate(told.sigma)]
    yield {"mean": mean, "covariance": P}
    for line in lines[1:]:
        if line["type"] in ("kidnap", "say"):
            yield {}
            continue
        prior = {"mean": mean, "covariance": P}
        if line["type"] == "move":
            mean, P, said = moved(mean, P, line["odometry"], noise)
        else:
            mean, P, said = sensed(mean, P, line, edges, noise.range, scene.guard, scene.gate)
        posterior = {"mean": mean, "covariance": P}
        yield {
            **said,
            "prior": prior,
            "posterior": posterior,
            **judged(mean, P, line["truth"], confidence),
        }


def moved(mean, P, odometry, noise):
    """Equations 4 to 7 of the assignment."""
    x, y, th = mean
    d, a = odometry["distance"], odometry["angle"]
    F = [[1, 0, -d * math.sin(th)], [0, 1, d * math.cos(th)], [0, 0, 1]]
    G = [[math.cos(th), 0], [math.sin(th), 0], [0, 1]]
    Pu = [[(noise.odometry_distance * d) ** 2, 0], [0, (noise.odometry_angle * a) ** 2]]
    P = halved(total(product(product(F, P), transposed(F)), product(product(G, Pu), transposed(G))))
    return (
        [x + d * math.cos(th), y + d * math.sin(th), wrapped(th + a)],
        P,
        {"F": F, "G": G, "M": Pu},
    )


def sensed(mean, P, line, edges, ratio, guard, gate):
    """Equations 8 to 12, and what the definitions say of a beam."""
    x, y, th = mean
    bearing, z = line["command"]["angle"], line["range"]
    h, edge = edges.first(x, y, th + bearing)
    ambiguous = is_ambiguous(mean, P, bearing, edges, edge)
    undefined = dict.fromkeys(
        ("H", "innovation", "innovation_variance", "gain", "nis", "incidence", "wall")
    )
    said = {
        **undefined,
        "predicted_range": None,
        "range_variance": None,
        "updated": False,
        "ambiguous": ambiguous,
    }
    if edge is None:
        return mean, P, {**said, "refused": "no echo" if z is None else "no wall"}
    (ax, ay), (bx, by), name, number, _ = edge
    sx, sy = bx - ax, by - ay
    dx, dy = math.cos(th + bearing), math.sin(th + bearing)
    slant = dx * sy - dy * sx
    H = [-sy / slant, sx / slant, h * (dy * sy + dx * sx) / slant]
    R = (ratio * h) ** 2
    PHt = [sum(P[i][j] * H[j] for j in range(3)) for i in range(3)]
    S = sum(H[i] * PHt[i] for i in range(3)) + R
    certain = S <= 1e-18
    S = 0.0 if certain else S
    K = [0.0] * 3 if certain else [p / S for p in PHt]
    said |= {
        "predicted_range": h,
        "range_variance": R,
        "wall": {"name": name, "edge": number},
        "incidence": math.asin(min(1.0, abs(slant) / math.hypot(sx, sy))),
        "H": H,
        "innovation_variance": S,
        "gain": K,
    }
    if z is None:
        return mean, P, {**said, "refused": "no echo"}
    nu = z - h
    nis = None if certain else nu * nu / S
    said |= {"innovation": nu, "nis": nis}
    if ambiguous and guard == "skip":
        return mean, P, {**said, "refused": "guard"}
    if gate is not None and nis is not None and nis > chi2.ppf(gate, 1):
        return mean, P, {**said, "refused": "gate"}
    mean = [m + k * nu for m, k in zip(mean, K, strict=True)]
    I_KH = [[(i == j) - K[i] * H[j] for j in range(3)] for i in range(3)]
    return (
        [*mean[:2], wrapped(mean[2])],
        halved(product(I_KH, P)),
        {**said, "updated": True, "refused": None},
    )


def is_ambiguous(mean, P, bearing, edges, edge):
    """Whether a beam from one of the six poses 3σ away meets another wall line than the mean's
    does."""
    vectors, variances, _ = np.linalg.svd(np.array(P))  # of a covariance: its eigenpairs
    own = edge and edge[4]
    for variance, vector in zip(variances.tolist(), vectors.T.tolist(), strict=True):
        if variance > 1e-10 * variances[0]:
            for side in (3, -3):
                arm = [side * math.sqrt(variance) * v for v in vector]
                share = possible(edges.open, mean, arm)
                x, y, th = (m + share * a for m, a in zip(mean, arm, strict=True))
                _, other = edges.first(x, y, th + bearing)
                if (other and other[4]) != own:
                    return True
    return False


def possible(open_floor, mean, arm):
    """How far along an arm the last place lies where a robot can stand, 1 mm clear of what stops
    it; 0 if nowhere."""
    x, y, dx, dy = *mean[:2], *arm[:2]
    if open_floor.intersects(shapely.Point(x + dx, y + dy)):
        return 1.0
    way = open_floor.intersection(shapely.LineString([(x, y), (x + dx, y + dy)]))
    length = math.hypot(dx, dy)
    parts = [
        shapely.get_coordinates(part) - (x, y) for part in shapely.get_parts(way) if part.length > 0
    ]
    spans = [sorted((ends @ (dx, dy)) / length) for ends in parts]
    if not spans:
        return 0.0
    begin, *_, end = max(spans, key=lambda span: span[-1])
    return max(end - 0.001, (begin + end) / 2) / length


def judged(mean, P, truth, confidence):
    """The ellipse in closed form, and the error squared in the metric of the covariance."""
    half, cross = (P[0][0] - P[1][1]) / 2, P[0][1]
    middle, spread = (P[0][0] + P[1][1]) / 2, math.hypot(half, cross)
    k = math.sqrt(-2 * math.log(1 - confidence))
    determinant = P[0][0] * P[1][1] - P[0][1] ** 2
    small = determinant / (middle + spread) if middle > 0 else 0.0
    if small <= 1e-15 * middle:
        small = 0.0
    turned = math.atan2(cross, half) / 2 % math.pi if spread > 1e-12 * middle else None
    drawn = {
        "major": k * math.sqrt(middle + spread),
        "minor": k * math.sqrt(small),
        "orientation": turned,
    }
    value, dof, impossible = squared_error(mean, P, truth)
    return {
        "ellipse": drawn,
        "nees": None if impossible else value,
        "nees_dof": dof,
        "impossible": impossible,
    }


def squared_error(mean, P, truth):
    """eᵀ P⁺ e, the rank of P, and whether the error leaves its range, by singular values and least
    squares."""
    e = np.array([mean[0] - truth[0], mean[1] - truth[1], wrapped(mean[2] - truth[2])])
    P = np.array(P)
    alive = [i for i in range(3) if P[i, i] > 1e-24]  # what is less is rounding
    if not alive:
        return 0.0, 0, bool(np.linalg.norm(e) > 1e-6)
    D = np.sqrt(np.diagonal(P)[alive])
    C = P[np.ix_(alive, alive)] / np.outer(D, D)
    U, s, _ = np.linalg.svd(C)
    rank = int((s > 1e-10).sum())
    span = np.zeros((3, rank))
    span[alive] = D[:, None] * U[:, :rank]
    within = span @ np.linalg.lstsq(span, e, rcond=1e-300)[0]
    white = (U[:, :rank].T @ (within[alive] / D)) / np.sqrt(s[:rank])
    return float(white @ white), rank, bool(np.linalg.norm(e - within) > 1e-6)


def disagreements(got, expected, where="", tolerance=1e-9):
    """Every place where a line of a trace is not what it must be; numbers agree to 1e-9, or as much
    of their size."""
    if isinstance(expected, dict):
        return [
            d
            for key in expected
            for d in disagreements(got[key], expected[key], f"{where}.{key}", tolerance)
        ]
    if isinstance(expected, list | tuple) and isinstance(got, list):
        pairs = enumerate(zip(got, expected, strict=True))
        return [d for i, (g, e) in pairs for d in disagreements(g, e, f"{where}[{i}]", tolerance)]
    if where.endswith(".orientation"):
        return (
            []
            if expected is None or same_direction(got, expected, tolerance)
            else [f"{where}: {got}, not {expected}"]
        )
    if where.endswith(("mean[2]", "truth[2]")) and abs(wrapped(got - expected)) <= tolerance:
        return []
    exact = expected is None or got is None or isinstance(expected, bool | str)
    near = got == expected if exact else abs(got - expected) <= tolerance * max(1.0, abs(expected))
    return [] if near else [f"{where}: {got}, not {expected}"]


def same_direction(a, b, tolerance):
    return 0 <= a < math.pi and abs(math.remainder(a - b, math.pi)) <= tolerance
