# ruff: noqa: E501
"""A student's filter as they write it, and every known mistake made in it by changing its lines."""

RIGHT = """
import numpy as np

walls_met = None
before = first = None


def predict(x, P, u, motion):
    global before, first
    d, a = u
    th = x[2]
    c, s = np.cos(th), np.sin(th)
    new = [x[0] + d * c, x[1] + d * s, x[2] + a]
    Jx = np.array([[1, 0, -d * s], [0, 1, d * c], [0, 0, 1.0]])
    Ju = np.array([[c, 0], [s, 0], [0, 1.0]])
    sd, sa = motion.distance_ratio * d, motion.angle_ratio * a
    Pu = np.diag([sd**2, sa**2])
    before = x, P
    first = None
    spread = Jx @ P @ Jx.T
    noise = Ju @ Pu @ Ju.T
    P = spread + noise
    return np.array(new), P


def meet(x, bearing, walls, z):
    at = x[2] + bearing
    dx, dy = np.cos(at), np.sin(at)
    hits = []
    for (ax, ay), (bx, by) in walls:
        nx, ny = by - ay, ax - bx
        nd = nx * dx + ny * dy
        if abs(nd) < 1e-12:
            continue
        r = (nx * (ax - x[0]) + ny * (ay - x[1])) / nd
        px, py = x[0] + r * dx, x[1] + r * dy
        t = ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
        if r > 0 and -1e-9 < t < 1 + 1e-9:
            hits.append((r, -nx / nd, -ny / nd, r * (nx * dy - ny * dx) / nd))
    return min(hits)


def update(x, P, z, sensor):
    global before, first
    z = z[0]
    at = x
    r, hx, hy, ht = meet(at, sensor.bearing, sensor.walls, z)
    H = np.array([[hx, hy, ht]])
    R = (sensor.range_ratio * r) ** 2
    v = z - r
    S = (H @ P @ H.T)[0, 0] + R
    K = P @ H.T / S
    new = x + K[:, 0] * v
    P = (np.eye(3) - K @ H) @ P
    before = first = None
    return new, P
"""


def written(*changes):
    """The right file with some of its lines changed: old, new, old, new, …"""
    text = RIGHT
    for old, new in zip(changes[::2], changes[1::2], strict=True):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


C_S, NEW, DA = (
    "    c, s = np.cos(th), np.sin(th)\n",
    "new = [x[0] + d * c, x[1] + d * s, x[2] + a]",
    "d, a = u",
)
JX, JU = "[[1, 0, -d * s], [0, 1, d * c], [0, 0, 1.0]]", "[[c, 0], [s, 0], [0, 1.0]]"
PU, SIGMAS = "np.diag([sd**2, sa**2])", "motion.distance_ratio * d, motion.angle_ratio * a"
SPREAD, NOISE, SUM = "spread = Jx @ P @ Jx.T", "noise = Ju @ Pu @ Ju.T", "P = spread + noise"
LOOK, HITS = "at = x[2] + bearing", "if r > 0 and -1e-9 < t < 1 + 1e-9:"
MIN, MEET = "return min(hits)", "meet(at, sensor.bearing, sensor.walls, z)"
ROW, R, V = "[[hx, hy, ht]]", "R = (sensor.range_ratio * r) ** 2", "v = z - r"
S, K, X = "S = (H @ P @ H.T)[0, 0] + R", "K = P @ H.T / S", "new = x + K[:, 0] * v"
P, AT = "P = (np.eye(3) - K @ H) @ P", "    at = x\n"
HERE = "    before = x, P\n    first = None\n"
# after a reading the estimate before the first of its batch is kept
KEPT = (
    "    before = first = None\n    return new, P",
    "    before = None\n    return new, P",
)
BATCH = "    first = x if first is None else first\n"

MISTAKES = {
    # the mean of a move, and its input
    "turn-before-move": (C_S, "    th = th + a\n" + C_S),
    "command-for-odometry": (DA, "d, a = motion.command"),
    "degrees-in-f": (NEW, NEW.replace("+ a]", "+ np.degrees(a)]")),
    "radians-twice": (DA, DA + "\n    a = a * np.pi / 180"),
    "degrees-in-cosine": (NEW, NEW.replace("* c", "* np.cos(th * 180 / np.pi)").replace(
        "* s", "* np.sin(th * 180 / np.pi)")),
    "middle-heading": (C_S, "    th = th + a / 2\n" + C_S),
    "heading-radians-twice": (NEW, NEW.replace("* c", "* np.cos(np.radians(th))").replace(
        "* s", "* np.sin(np.radians(th))")),
    "heading-modulo-pi": (NEW, NEW.replace("x[2] + a", "(x[2] + a) % np.pi")),
    "turn-for-heading": (C_S, "    th = a\n" + C_S),
    "sine-for-cosine": (C_S, C_S.replace("c, s", "s, c"), JX, "[[1, 0, d * s], [0, 1, -d * c], [0, 0, 1]]"),
    "y-sign": (NEW, NEW.replace("+ d * s", "- d * s")),
    "turn-sign": (NEW, NEW.replace("+ a", "- a")),
    "turn-forgotten": (NEW, NEW.replace(" + a", "")),
    "not-moved": (NEW, "new = x"),
    # Jacobians of a move
    "J_x-after-move": (SPREAD, "c, s = np.cos(new[2]), np.sin(new[2])\n    Jx = np.array(" + JX + ")\n    " + SPREAD),
    "J_u-after-move": (NOISE, "c, s = np.cos(new[2]), np.sin(new[2])\n    Ju = np.array(" + JU + ")\n    " + NOISE),
    "Jacobians-after-move": ("    Jx =", "    c, s = np.cos(new[2]), np.sin(new[2])\n    Jx ="),
    "J_x-sign-x": (JX, JX.replace("-d", "d")),
    "J_x-sign-y": (JX, JX.replace("1, d", "1, -d")),
    "J_x-signs": (JX, JX.replace("-d", "d").replace("1, d", "1, -d")),
    "J_x-identity": (JX, "np.eye(3)"),
    "J_x-exchanged": (JX, "[[1, 0, -d * c], [0, 1, d * s], [0, 0, 1]]"),
    "J_x-of-its-own": (JX, "[[1, 0, -0.9 * d * s], [0, 1, 1.2 * d * c], [0, 0, 1]]"),
    "J_x-without-d": (JX, "[[1, 0, -s], [0, 1, c], [0, 0, 1]]"),
    "J_x-without-ones": (JX, "[[0, 0, -d * s], [0, 0, d * c], [0, 0, 0]]"),
    "J_x-transposed": (SPREAD, "spread = Jx.T @ P @ Jx"),
    "J_x-untransposed": (SPREAD, "spread = Jx @ P @ Jx"),
    "J_x-one-sided": (SPREAD, "spread = Jx @ P"),
    "J_x-elementwise": (SPREAD, "spread = Jx * P * Jx.T"),
    "J_u-exchanged": (JU, "[[s, 0], [c, 0], [0, 1]]"),
    "J_u-across": (JU, "[[-s, 0], [c, 0], [0, 1]]"),
    "J_u-sign": (JU, "[[c, 0], [-s, 0], [0, 1]]"),
    "J_u-without-turn": (JU, "[[c, 0], [s, 0], [0, 0]]"),
    "J_u-without-way": (JU, "[[0, 0], [0, 0], [0, 1]]"),
    "Jacobians-at-the-turn": ("    Jx =", "    c, s = np.cos(a), np.sin(a)\n    Jx ="),
    "degrees-in-Jacobians": ("    Jx =", "    th = np.degrees(th)\n" + C_S + "    Jx ="),
    # P_u and P
    "sigma-in-P_u": (PU, "np.diag([abs(sd), abs(sa)])"),
    "noise-without-J_u": (NOISE, "noise = np.diag([sd**2, 0, sa**2])"),
    "command-in-P_u": (SIGMAS, SIGMAS.replace("* d", "* motion.command[0]").replace("* a", "* motion.command[1]")),
    "degrees-in-P_u": (SIGMAS, SIGMAS.replace("* a", "* a * 180 / np.pi")),
    "noise-before-J_x": (SPREAD, "P = P + Ju @ Pu @ Ju.T\n    " + SPREAD, NOISE, "noise = 0"),
    "P_u-of-its-own": (PU, "np.diag([0.03**2, 0.01])"),
    "diagonal-of-its-own": (SUM, SUM + " + np.diag([0.01, 0.02, 0.003])"),
    "P-inflated": (SUM, SUM + " + 0.01 * np.eye(3)"),
    "P-scaled": (SUM, "P = 1.05 * (spread + noise)"),
    "no-noise": (SUM, "P = spread"),
    "P-not-predicted": (SUM, ""),
    "P-forgotten": (SUM, "P = noise"),
    "P-predicted-twice": (SUM, SUM + "\n    P = Jx @ P @ Jx.T + noise"),
    "noise-twice": (SUM, SUM + " + noise"),
    "noise-subtracted": (SUM, "P = spread - noise"),
    "noise-uncorrelated": (SUM, "P = spread + np.diag([(c * sd) ** 2, (s * sd) ** 2, sa**2])"),
    "P_u-without-way": (SIGMAS, "motion.distance_ratio, motion.angle_ratio"),
    "P_u-ratio-not-squared": (PU, "np.diag([motion.distance_ratio * d**2, motion.angle_ratio * a**2])"),
    "P_u-way-not-squared": (PU, "np.diag([motion.distance_ratio**2 * abs(d), motion.angle_ratio**2 * abs(a)])"),
    "P_u-squared-twice": (PU, "np.diag([sd**4, sa**4])"),
    "P_u-exchanged": (PU, "np.diag([sa**2, sd**2])"),
    "ratios-exchanged": (SIGMAS, "motion.angle_ratio * d, motion.distance_ratio * a"),
    "one-ratio": (SIGMAS, "motion.distance_ratio * d, motion.distance_ratio * a"),
    "turn-noise-of-the-way": (SIGMAS, "motion.distance_ratio * d, motion.angle_ratio * d"),
    "way-noise-of-the-turn": (SIGMAS, "motion.distance_ratio * a, motion.angle_ratio * a"),
    "P_u-correlated": (PU, "np.array([[sd**2, abs(sd * sa)], [abs(sd * sa), sa**2]])"),
    "cross-dropped": (SUM, SUM + "\n    P[0, 2] = P[2, 0] = P[1, 2] = P[2, 1] = 0"),
    # the reading
    "innovation-sign": (V, "v = r - z"),
    "innovation-absolute": (V, "v = abs(z - r)"),
    "reading-for-innovation": (X, X.replace("* v", "* z")),
    "J_H-sign-theta": (ROW, "[[hx, hy, -ht]]"),
    "J_H-without-theta": (ROW, "[[hx, hy, 0]]"),
    "J_H-theta-without-range": (ROW, "[[hx, hy, ht / r]]"),
    "J_H-theta-of-the-reading": (ROW, "[[hx, hy, ht / r * z]]"),
    "J_H-direction": (ROW, "[[hx, hy, r * (hy * np.cos(x[2]) - hx * np.sin(x[2]))]] / -(hx * np.cos(x[2]) + hy * np.sin(x[2]))"),
    "J_H-sign-x": (ROW, "[[-hx, hy, ht]]"),
    "J_H-sign-y": (ROW, "[[hx, -hy, ht]]"),
    "J_H-signs-xy": (ROW, "[[-hx, -hy, ht]]"),
    "J_H-exchanged": (ROW, "[[hy, hx, ht]]"),
    "J_H-of-a-point": (ROW, "[[-np.cos(x[2] + sensor.bearing), -np.sin(x[2] + sensor.bearing), 0]]"),
    "J_H-without-slant": (ROW, "[[hx, hy, ht]] / np.sqrt(hx**2 + hy**2)"),
    "J_H-of-its-own": (ROW, "[[1.1 * hx, 0.9 * hy, ht + 0.1]]"),
    "J_H-in-degrees": (ROW, "[[hx, hy, ht * np.pi / 180]]"),
    "sigma-in-C_v": (R, "R = sensor.range_ratio * r"),
    "C_v-of-the-reading": (R, R.replace("* r)", "* z)")),
    "no-C_v": (R, "R = 0"),
    "C_v-without-range": (R, "R = sensor.range_ratio**2"),
    "C_v-ratio-not-squared": (R, "R = sensor.range_ratio * r**2"),
    "C_v-range-not-squared": (R, "R = sensor.range_ratio**2 * r"),
    "C_v-is-ratio": (R, "R = sensor.range_ratio"),
    "C_v-squared-twice": (R, "R = (sensor.range_ratio * r) ** 4"),
    "C_v-of-its-own": (R, "R = 0.05**2"),
    "S-inflated": (S, S + " + 1e-6"),
    "C_v-subtracted": (S, S.replace("+ R", "- R")),
    # the beam
    "endless-walls": (HITS, "if r > 0:"),
    "bearing-forgotten": (LOOK, "at = x[2]"),
    "heading-forgotten": (LOOK, "at = bearing"),
    "bearing-sign": (LOOK, "at = x[2] - bearing"),
    "degrees-in-bearing": (LOOK, "at = x[2] + np.degrees(bearing)"),
    "bearing-radians-twice": (LOOK, "at = x[2] + bearing * np.pi / 180"),
    "degrees-in-beam": (LOOK, "at = (x[2] + bearing) * 180 / np.pi"),
    "obstacles-ignored": (MEET, MEET.replace("walls", "walls[:4]")),
    "far-wall": (MIN, "return max(hits)"),
    "wall-of-the-list": (MIN, "return hits[-1]"),
    "wall-behind": (HITS, HITS.replace("r > 0 and ", ""), MIN, "return min(hits, key=lambda hit: abs(hit[0]))"),
    "nearest-line": (
        HITS, "if r > 0:",
        "hits.append((", "hits.append((abs(r * nd) / np.hypot(nx, ny), ",
        MIN, "return min(hits)[1:]"),
    "another-wall": (MIN, "return sorted(hits)[2 if len(hits) > 3 else 0]"),
    "innovation-of-its-own": (V, V + " - 0.05"),
    "wall-by-reading": (MIN, "return min(hits, key=lambda hit: abs(hit[0] - z))"),
    "shortest-distance": (V, "r = r / np.hypot(hx, hy)\n    R = (sensor.range_ratio * r) ** 2\n    " + V),
    "stale-estimate": (*KEPT, AT, BATCH + "    at = first\n"),
    "stale-J_H": (*KEPT, AT, BATCH + AT, ROW, "[meet(first, sensor.bearing, sensor.walls, z)[1:]]"),
    "estimate-before-move": (AT, "    at = x if before is None else before[0]\n"),
    "J_H-before-move": (ROW, "[meet(x if before is None else before[0], sensor.bearing, sensor.walls, z)[1:]]"),
    # S, K, x and P
    "P-not-updated": (P, ""),
    "K-without-inverse": (K, "K = P @ H.T * S"),
    "K-without-S": (K, "K = P @ H.T"),
    "K-by-C_v": (K, "K = P @ H.T / R"),
    "K-by-root": (K, "K = P @ H.T / np.sqrt(S)"),
    "K-without-P": (K, "K = H.T / S"),
    "S-without-P": (S, "S = (H @ H.T)[0, 0] + R"),
    "x-not-updated": (X, "new = x"),
    "x-is-the-correction": (X, "new = K[:, 0] * v"),
    "x-corrected-twice": (X, X + "\n    new = new + K[:, 0] * v"),
    "heading-not-corrected": (X, X + "\n    new[2] = x[2]"),
    "P-is-the-decrease": (P, "P = K @ H @ P"),
    "x-by-the-new-P": (X, "", P, P + "\n    K = P @ H.T / ((H @ P @ H.T)[0, 0] + R)\n    " + X),
    "P-updated-twice": (P, P + "\n    K = P @ H.T / ((H @ P @ H.T)[0, 0] + R)\n    " + P),
    "reading-used-twice": (
        "def update(",
        "def update(x, P, z, sensor):\n    return once(*once(x, P, z, sensor), z, sensor)\n\n\n"
        "def once(",
    ),
    "J_H-after-update": (P, "H = np.array([meet(new, sensor.bearing, sensor.walls, z)[1:]])\n"
        "    R = (sensor.range_ratio * meet(new, sensor.bearing, sensor.walls, z)[0]) ** 2\n"
        "    K = P @ H.T / ((H @ P @ H.T)[0, 0] + R)\n    " + P),
    "iterated-update": (P, "new = x\n"
        "    for _ in range(3):\n"
        "        h, *H = meet(new, sensor.bearing, sensor.walls, z)\n"
        "        H = np.array([H])\n"
        "        K = P @ H.T / ((H @ P @ H.T)[0, 0] + R)\n"
        "        new = x + K[:, 0] * (z - h - H[0] @ (x - new))\n    " + P),
    "P-is-zero": (P, "P = 0 * P"),
    "P-plus": (P, P.replace("-", "+")),
    "P-wrong-side": (P, "P = P @ (np.eye(3) - K @ H)"),
    "P-without-P": (P, "P = np.eye(3) - K @ H"),
    "P-minus-K-H": (P, "P = P - K @ H"),
    "P-of-ones": (P, "P = (1 - K @ H) @ P"),
    "P-elementwise": (P, "P = (np.eye(3) - K @ H) * P"),
    "K-H-a-number": (P, "P = (1 - K[:, 0] @ H[0]) * P"),
    "Joseph-without-noise": (P, "I_KH = np.eye(3) - K @ H\n    P = I_KH @ P @ I_KH.T"),
    "Joseph-sign": (P, "I_KH = np.eye(3) - K @ H\n    P = I_KH @ P @ I_KH.T - R * K @ K.T"),
    "P-minus-K-R-K": (P, "P = P - R * K @ K.T"),
    "reading-refused": (V, V + "\n    if v * v / (R + (H @ P @ H.T)[0, 0]) < 100:\n        return x, P"),
    "P-before-move": (AT, AT + "    P = P if before is None else before[1]\n"),
    "x-before-move": (AT, "    x = x if before is None else before[0]\n" + AT),
    "own-first-P": ("before = first = None\n\n\ndef predict", "before = first = None\nfresh = True\n\n\ndef predict",
        DA, "global fresh\n    P, fresh = (np.eye(3) if fresh else P), False\n    " + DA),
    "own-first-x": ("before = first = None\n\n\ndef predict", "before = first = None\nfresh = True\n\n\ndef predict",
        DA, "global fresh\n    x, fresh = (np.zeros(3) if fresh else x), False\n    " + DA),
}  # fmt: skip


SPELT_OTHERWISE = (  # mistakes of the table, written in another way
    ("wall-behind", HITS, HITS.replace("r > 0 and ", "")),
    ("wall-behind", HITS, HITS.replace("r > 0 and ", ""), MIN,
        "r, hx, hy, ht = min(hits, key=lambda hit: abs(hit[0]))\n    return abs(r), hx, hy, ht * np.sign(r)"),
    ("J_x-exchanged", JX, "[[1, 0, d * c], [0, 1, -d * s], [0, 0, 1]]"),
    ("J_x-exchanged", JX, "[[1, 0, d * c], [0, 1, d * s], [0, 0, 1]]"),
    ("y-sign", NEW, NEW.replace("+ d * s", "- d * s"), JX, "[[1, 0, -d * s], [0, 1, -d * c], [0, 0, 1]]",
        JU, "[[c, 0], [-s, 0], [0, 1]]"),
    ("sigma-in-P_u", PU, "np.diag([sd, sa])"),
    ("sigma-in-P_u", PU, "np.diag([sd**2, abs(sa)])"),
    ("P_u-ratio-not-squared", PU, "np.diag([sd**2, motion.angle_ratio * a**2])"),
    ("J_H-of-a-point", ROW, "[[-np.cos(x[2] + sensor.bearing), -np.sin(x[2] + sensor.bearing), ht]]"),
    ("degrees-in-f", NEW, NEW.replace("x[2] + a", "np.degrees(x[2] + a)")),
    ("P-scaled", SPREAD, "spread = 1.02 * Jx @ P @ Jx.T"),
    ("own-first-P", "before = first = None\n\n\ndef predict", "before = first = None\nfresh = True\n\n\ndef predict",
        DA, "global fresh\n    P, fresh = (np.eye(3) / 100 if fresh else P), False\n    " + DA),
    ("iterated-update", P, "new = x\n"
        "    for _ in range(3):\n"
        "        h, *H = meet(new, sensor.bearing, sensor.walls, z)\n"
        "        H = np.array([H])\n"
        "        K = P @ H.T / ((H @ P @ H.T)[0, 0] + (sensor.range_ratio * h) ** 2)\n"
        "        new = x + K[:, 0] * (z - h - H[0] @ (x - new))\n    " + P),
)  # fmt: skip
# of many other numbers in J_H and J_x: derivatives by differences that are too large
BY_LARGE_DIFFERENCES = (
    ("J_x-of-its-own", JX, "[[1, 0, d * (np.cos(th + 0.02) - c) / 0.02], [0, 1, d * (np.sin(th + 0.02) - s) / 0.02], [0, 0, 1]]"),
    ("J_H-of-its-own", ROW, "[[(meet(x + e, sensor.bearing, sensor.walls, z)[0] - r) / 0.02 for e in 0.02 * np.eye(3)]]"),
)  # fmt: skip

# the same equations, written otherwise
FORMS = {
    "short": (),
    "Joseph": (P, "I_KH = np.eye(3) - K @ H\n    P = I_KH @ P @ I_KH.T + R * K @ K.T"),
    "Cholesky": (K, "L = np.linalg.cholesky([[S]])\n"
        "    K = np.linalg.solve(L.T, np.linalg.solve(L, H @ P)).T"),
    "information": (P, "if np.linalg.matrix_rank(P) == 3:\n"
        "        P = np.linalg.inv(np.linalg.inv(P) + H.T @ H / R)\n"
        "    else:\n        P = P - K @ K.T * S"),
    "lists": ("return np.array(new), P", "return new, P.tolist()"),
    "class": (
        DA, "global mine\n    x, P = mine = mine or (x, P)\n    " + DA,
        "return np.array(new), P", "mine = np.array(new), P\n    return mine",
        AT, "    global mine\n    x, P = mine = mine or (x, P)\n" + AT,
        "before = first = None\n    return new, P", "before = first = None\n    mine = new, P\n    return mine",
        "walls_met = None", "mine = None",
    ),
    "unwrapped": (NEW, NEW.replace("+ a", "+ a + 6 * np.pi")),
    "one number after the other": (K, "K = np.array([[(P[i] @ H[0]) / S] for i in range(3)])"),
}  # fmt: skip

FOR_OTHERS = """
import numpy as np


def predict(x, P, u, motion):
    F, G, M = motion.F(x, u), motion.G(x, u), motion.M(u)
    P = F @ P @ F.T + G @ M @ G.T + motion.Q(u)
    return motion.f(x, u), P


def update(x, P, z, sensor):
    h, H, R = sensor.h(x), sensor.H(x), sensor.R(x)
    v = sensor.residual(z, h)
    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    x = x + K @ v
    P = (np.eye(len(x)) - K @ H) @ P
    return x, P
"""


def written_for_others(*changes):
    """The file for any robot, with some of its lines changed."""
    text = FOR_OTHERS
    for old, new in zip(changes[::2], changes[1::2], strict=True):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


ONE_AFTER_THE_OTHER = (
    """    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    x = x + K @ v
    P = (np.eye(len(x)) - K @ H) @ P
""",
    """    before = x
    for i, row in enumerate(H):
        k = P @ row / (row @ P @ row + R[i, i])
        x = x + k * (v[i] - row @ (x - before))
        P = P - np.outer(k, row @ P)
""",
)

OF_OTHERS = {  # mistake, scene → the change
    ("no-process-noise", "mower"): (" + motion.Q(u)", ""),
    ("K-entry-by-entry", "landmarks"): ("np.linalg.inv(S)", "(1 / S)"),
    ("innovation-not-wrapped", "behind"): ("sensor.residual(z, h)", "z - h"),
    ("innovation-sign", "behind"): ("sensor.residual(z, h)", "sensor.residual(h, z)"),
    ("sigma-in-P_u", "gnss"): ("motion.M(u)", "np.sign(motion.M(u)) * np.sqrt(abs(motion.M(u)))"),
    ("J_x-transposed", "landmarks"): ("F @ P @ F.T", "F.T @ P @ F"),
    ("J_x-after-move", "landmarks"): ("motion.F(x, u)", "motion.F(motion.f(x, u), u)"),
    ("J_x-exchanged", "landmarks"): ("    P = F", "    F[:2, 2] = F[1::-1, 2]\n    P = F"),
    ("P-not-updated", "pylon"): ("    P = (np.eye(len(x)) - K @ H) @ P\n", ""),
    ("sigma-in-C_v", "mower"): ("sensor.R(x)", "np.sqrt(sensor.R(x))"),
    ("J_H-sign-x", "ranges"): (
        "H, R = sensor.h(x), sensor.H(x)",
        "H, R = sensor.h(x), sensor.H(x) * [-1, 1, 1]",
    ),
}
