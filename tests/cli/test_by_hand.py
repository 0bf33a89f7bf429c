"""Every number that the long form tells of the tour, recomputed from other numbers that it tells.

Given are what no one can compute: commands, odometry, ranges, the truth, the ratios, the corners of
walls. How far a number may be off is what the last digits of those that it is computed from let it
be.
"""

import math
import re

import numpy as np
import pytest
from program import ekfsim
from scipy.stats import chi2

K2 = -2 * math.log(1 - 0.954)  # k² of the ellipse
NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?"
DATA = [
    r"ekfsim .*", r"matrices, derivatives .*", r"innovation  .*", r"NIS  .*", r"NEES  .*",
    r"degrees of freedom .*",
    r"guard  .*", r"run  .*", r"==>[A-Z][^0-9]*",
]  # fmt: skip


class Told(float):
    """A number as it is told, which may stand for any that is rounded to it."""

    def __new__(cls, text):
        told = super().__new__(cls, text)
        digits = re.sub(r"e.*|[-.]", "", text).lstrip("0")
        told.half = (
            0.5 * 10.0 ** (math.floor(math.log10(abs(told))) - max(len(digits), 6) + 1)
            if told
            else 0.0
        )
        return told


def agrees(told, function, *given):
    """Whether numbers told are those that a function makes of other numbers told, whatever these
    were rounded from."""
    flat = [number for each in given for number in np.ravel(np.array(each, object))]
    shapes = [np.shape(each) for each in given]

    def value(numbers):
        numbers, arguments = list(map(float, numbers)), []
        for shape in shapes:
            count = math.prod(shape)
            part, numbers = numbers[:count], numbers[count:]
            arguments.append(np.reshape(part, shape) if shape else part[0])
        return np.ravel(np.asarray(function(*arguments), float))

    expected = value(flat)
    slack = np.array([getattr(number, "half", 0.0) for number in told])
    for i, number in enumerate(flat):
        if half := getattr(number, "half", 0.0):
            moved = [value([*flat[:i], number + side * half, *flat[i + 1 :]]) for side in (1, -1)]
            slack = slack + np.nanmax(np.abs(np.array(moved) - expected), axis=0)
    off = np.abs(np.array(told, float) - expected)
    assert (off <= 1.01 * slack + 1e-13).all(), (list(map(float, told)), expected, slack)
    # or nothing would be held against anything
    assert (slack < 1e-2 * np.abs(expected) + 2e-3).all(), (told, slack)
    return True


class Narrative:
    """Reads a narrative line by line. A line that it does not know is a mistake."""

    def __init__(self, text):
        self.lines = [line for line in text.splitlines() if line]
        self.at, self.checked = 0, 0

    def comes(self, pattern):
        return self.at < len(self.lines) and re.fullmatch(pattern, self.lines[self.at]) is not None

    def take(self, pattern):
        """The numbers of the next line; an equation's number and what stands between marks in a
        pattern are none."""
        line = self.lines[self.at]
        assert self.comes(pattern), (pattern, line)
        self.at += 1
        found = re.fullmatch(pattern, line)
        return [Told(number) for group in found.groups() for number in re.findall(NUMBER, group)]

    def matrix(self, rows, columns):
        row = rf"\[{{1,2}}({NUMBER}(?: {NUMBER})*)\]{{1,2}}"
        numbers = [number for _ in range(rows) for number in self.take(row)]
        assert len(numbers) == rows * columns
        return np.array(numbers, object).reshape(rows, columns)


def pose(x):
    return np.array([x[0], x[1], np.radians(x[2])])


def degrees(x):
    """With the heading in (−180, 180]."""
    θ = math.degrees(x[2]) % 360
    return [x[0], x[1], θ - 360 if θ > 180 else θ]


def f(x, u):
    x, (d, a) = pose(x), u
    return degrees([x[0] + d * math.cos(x[2]), x[1] + d * math.sin(x[2]), x[2] + math.radians(a)])


def P_u(ratios, u):
    return np.diag([(ratios[2] * u[0]) ** 2, (ratios[3] * math.radians(u[1])) ** 2])


def J_x(x, u):
    θ = math.radians(x[2])
    return np.array([[1, 0, -u[0] * math.sin(θ)], [0, 1, u[0] * math.cos(θ)], [0, 0, 1]])


def J_u(x):
    θ = math.radians(x[2])
    return np.array([[math.cos(θ), 0], [math.sin(θ), 0], [0, 1]])


def to_wall(x, bearing, corners):
    """Range, its derivatives, and the angle between beam and wall, along a beam to the line through
    two corners."""
    x, y, θ = pose(x)
    θ += math.radians(bearing)
    a, along = corners[:2], corners[2:] - corners[:2]
    normal = np.array([-along[1], along[0]]) / np.hypot(*along)
    d, across = np.array([math.cos(θ), math.sin(θ)]), np.array([-math.sin(θ), math.cos(θ)])
    r = normal @ (a - (x, y)) / (normal @ d)
    H = [*(-normal / (normal @ d)), -r * (normal @ across) / (normal @ d)]
    return r, H, math.degrees(math.asin(min(1.0, abs(normal @ d))))


def ellipse(P):
    λ, V = np.linalg.eigh(P[:2, :2])
    λ = np.maximum(λ, 0)
    round_one = λ[1] - λ[0] <= 1e-12 * λ[1]
    turned = 0.0 if round_one else math.degrees(math.atan2(V[1, 1], V[0, 1])) % 180
    return [*np.sqrt(K2 * λ), turned, 2 * math.degrees(math.sqrt(P[2, 2]))]


def error(x, truth):
    e = pose(x) - pose(truth)
    return np.array([e[0], e[1], math.remainder(e[2], 2 * math.pi)])


def nees(P, x, truth):
    """Of the entries that P leaves uncertain; told in six digits, P has no other rank than it has
    rows."""
    alive = np.diagonal(P) > 1e-24
    return (
        error(x, truth)[alive] @ np.linalg.solve(P[np.ix_(alive, alive)], error(x, truth)[alive])
        if alive.any()
        else 0.0
    )


class ByHand(Narrative):
    """The tour, computed anew."""

    def __init__(self, text):
        super().__init__(text)
        self.nis, self.errors, self.reckoned_errors, self.moves, self.readings, self.says = (
            [],
            [],
            [],
            0,
            0,
            0,
        )

    def run(self):
        while not self.comes(r"The noise ratios: .*"):
            self.at += 1
        self.ratios = self.take(r"The noise ratios: (.*)")
        start = self.take(r"The robot starts at \(x, y, th\) = (.*)")
        while any(self.comes(line) for line in DATA):
            self.at += 1
        self.x = self.take(r"First state estimate is \(x, y, theta\) = (.*)")
        assert self.x == start
        self.reckoned = self.x
        self.take("First state covariance matrix is:")
        self.P = self.matrix(3, 3)
        assert not self.P.any()
        self.truth = self.take(r"True state is \(x, y, th\) = (.*)")
        assert self.truth == start
        self.judge()
        while not self.comes("The run is over .*"):
            if self.comes("==>The robot moved: .*"):
                self.move()
            elif self.comes("==>Commanding .*"):
                self.sense()
            else:
                self.take("==>.*")
                self.says += 1
        self.close()
        assert self.at == len(self.lines)

    def move(self):
        self.moves += 1
        self.take("==>The robot moved: (.*)")
        u = self.take("The odometry measured: (.*)")
        self.take(r"P_u is:   \(eq 1: .*\)")
        M = self.matrix(2, 2)
        assert agrees(M.ravel(), P_u, self.ratios, u)
        self.take(r"J_x is:   \(eqs 5, 6\)")
        F = self.matrix(3, 3)
        assert agrees(F.ravel(), J_x, self.x, u)
        self.take(r"J_u is:   \(eqs 5, 6\)")
        G = self.matrix(3, 2)
        assert agrees(G.ravel(), J_u, self.x)
        self.take("J_u P_u J_u' is:")
        from_input = self.matrix(3, 3)
        assert agrees(from_input.ravel(), lambda G, M: G @ M @ G.T, G, M)
        self.take("J_x P J_x' is:")
        carried = self.matrix(3, 3)
        assert agrees(carried.ravel(), lambda F, P: F @ P @ F.T, F, self.P)
        assert self.take(r"Current state estimate is \(x, y, th\) = (.*)") == self.x
        x = self.take(r"New state estimate is \(x, y, theta\) = (\(.*\))   \(eq 4: f\(x, u\)\)")
        assert agrees(x, f, self.x, u)
        self.x, self.reckoned = x, f(self.reckoned, u)
        self.take(r"New state covariance matrix is:   \(eq 7: J_x P J_x' \+ J_u P_u J_u'\)")
        self.P = self.matrix(3, 3)
        assert agrees(self.P.ravel(), lambda A, B: A + B, carried, from_input)
        self.truth = self.take(r"True state is \(x, y, th\) = (.*)")
        self.count()
        self.judge()

    def sense(self):
        self.readings += 1
        (bearing,) = self.take("==>Commanding the robot to sense at an angle of (.*)")
        if self.comes("This beam is ambiguous: .*"):
            self.doubt(bearing)
        (z,) = self.take("The range is (.*)")
        (h,) = self.take(r"The predicted range was (.*)   \(eq 8: h\(x\)\)")
        edge, angle = self.take(
            r"It was expected to meet edge (\d+) of [a-z]+; the angle between beam and wall is "
            r"(.*) degrees"
        )
        corners = self.take(r"That edge, counted from 1 in the file's order, goes from (.* to .*)")
        assert edge >= 1
        assert agrees([h, angle], lambda x, b, c: to_wall(x, b, c)[::2], self.x, bearing, corners)
        self.take(r"The derivatives are:   \(eq 11: J_H\)")
        H = self.take(rf"  dh/dx = ({NUMBER}), dh/dy = ({NUMBER}), dh/dth = ({NUMBER})")
        assert agrees(H, lambda x, b, c: to_wall(x, b, c)[1], self.x, bearing, corners)
        (C_v,) = self.take(r"C_v is (.*)   \(\(rangeSigmaRatio \* predicted range\)\^2\)")
        assert agrees([C_v], lambda r, h: (r[4] * h) ** 2, self.ratios, h)
        (S,) = self.take(r"S is (.*)   \(eq 11: J_H P J_H' \+ C_v\)")
        assert agrees([S], lambda H, P, C_v: H @ P @ H + C_v, H, self.P, C_v)
        r, σ, nis = self.take(
            rf"The innovation is ({NUMBER}), its standard deviation ({NUMBER}); NIS is ({NUMBER}) "
            rf"  \(eq 9: r = z - h\)"
        )
        assert agrees([r, σ], lambda z, h, S: [z - h, math.sqrt(S)], z, h, S)
        assert agrees([nis], lambda r, S: r * r / S, r, S)
        self.nis.append(nis)
        self.surprise("NIS", nis, 1)
        K = self.take(r"The Kalman gain is \(x, y, th\) = (\(.*\))   \(eq 11: P J_H' / S\)")
        assert agrees(K, lambda P, H, S: P @ H / S, self.P, H, S)
        x = self.take(r"Revised state estimate: \(x, y, theta\) = (\(.*\))   \(eq 10: x \+ K r\)")
        assert agrees(x, lambda x, K, r: degrees(pose(x) + K * r), self.x, K, r)
        self.take(r"Revised covariance matrix is:   \(eq 12: \(I - K J_H\) P\)")
        P = self.matrix(3, 3)
        assert agrees(P.ravel(), lambda P, K, H: (np.eye(3) - np.outer(K, H)) @ P, self.P, K, H)
        self.x, self.P = x, P
        self.count()
        self.judge()

    def doubt(self, bearing):
        """A pose at the end of one of the axes of P, what of it is told in words, and the way to
        the wall there."""
        told = self.take(r"This beam is ambiguous: expected to meet edge \d+ of [a-z]+, but from "
                         r"a pose within 3 sigma "
                         r"\((.*)\) it would meet edge \d+ of [a-z]+")  # fmt: skip
        place, corners, after = [], [], []
        found = re.fullmatch(
            r"  From \(x, y, th\) = (\(.*\)), it would meet edge \d+ of [a-z]+, from (.* to .*), "
            r"after (.*)",
            self.lines[self.at],
        )
        self.at += 1
        place, corners, (after,) = (
            [Told(n) for n in re.findall(NUMBER, group)] for group in found.groups()
        )
        assert agrees([after], lambda x, b, c: to_wall(x, b, c)[0], place, bearing, corners)
        for i in range(6):

            def arm(x, P, i=i):
                λ, V = np.linalg.eigh(P)
                # one of its two ends
                v = V[:, i % 3] * (1 if V[np.argmax(abs(V[:, i % 3])), i % 3] > 0 else -1)
                return degrees(pose(x) + (3 if i < 3 else -3) * math.sqrt(λ[i % 3]) * v)

            here = arm(np.array(self.x, float), np.array(self.P, float))
            if np.allclose(here, np.array(place, float), atol=1e-2):
                assert agrees(place, arm, self.x, self.P)
                break
        else:
            pytest.fail(f"{place} lies at no end of an axis")
        x, probe = pose(np.array(self.x, float)), pose(np.array(place, float))
        c, s = math.cos(x[2]), math.sin(x[2])
        east, north = probe[:2] - x[:2]
        parts = [
            abs(c * east + s * north),
            abs(c * north - s * east),
            math.degrees(abs(probe[2] - x[2])),
        ]
        assert told == pytest.approx(parts, rel=0.06)  # in two digits

    def judge(self):
        """The ellipse, the cone, and what is said of the truth."""
        self.take("Uncertainty ellipse is:")
        minor, major, turned, half = (
            self.take(pattern)[0]
            for pattern in (r"  minor radius is (.*)", r"  major radius is (.*)",
                            r"  orientation is (.*) degrees",
                            r"  2\*sigma_theta is (.*) degrees")
        )  # fmt: skip
        assert agrees([minor, major, half], lambda P: np.array(ellipse(P))[[0, 1, 3]], self.P)
        assert agrees([turned], lambda P: ellipse(P)[2], self.P)
        line = self.lines[self.at]
        value, dof = self.take(r"The true position lies \w+ the ellipse, the true heading \w+ the "
                               r"cone; "
                               r"NEES is (.*) \((\d) degrees? of freedom\)")  # fmt: skip
        P, x, truth = (np.array(each, float) for each in (self.P, self.x, self.truth))
        e = error(x, truth)
        assert dof == np.count_nonzero(np.diagonal(P))
        assert agrees([value], nees, self.P, self.x, self.truth)
        flat = np.where(np.diagonal(P)[:2] == 0, 1.0, 0.0)
        inside = e[:2] @ np.linalg.solve(P[:2, :2] + np.diag(flat), e[:2]) <= K2
        assert ("position lies inside" in line) == inside
        assert ("heading inside" in line) == (abs(e[2]) <= 2 * math.sqrt(P[2, 2]))
        self.last_nees, self.last_dof = value, int(dof)
        if dof:
            self.surprise("NEES", value, int(dof))

    def surprise(self, name, value, dof):
        limit = chi2.ppf(0.99, dof)
        assert self.comes(rf"{name} lies .*") == (value > limit)
        if value > limit:
            assert self.take(rf"{name} lies above its 99 % quantile, (.*)") == pytest.approx(
                [limit], rel=1e-5
            )

    def count(self):
        x, truth = np.array(self.x, float), np.array(self.truth, float)
        self.errors.append(error(x, truth))
        self.reckoned_errors.append(error(np.array(self.reckoned, float), truth))

    def close(self):
        """What is summed up at the end: of sums of rounded numbers five digits are right."""
        commands, updates = self.take(r"The run is over after (\d+) commands: (\d+) updates")
        assert (commands, updates) == (self.moves + self.readings + self.says, self.readings)
        here, reckoned = (np.array(each) for each in (self.errors, self.reckoned_errors))

        def of(e):
            return [math.sqrt(np.mean(e**2)), np.max(np.abs(e))]

        told = self.take(r"Position error: (.*)")
        assert told == pytest.approx(
            [*of(np.hypot(*here[:, :2].T)), *of(np.hypot(*reckoned[:, :2].T))], rel=2e-5
        )
        told = self.take(r"Heading error: (.*)")
        assert told == pytest.approx(
            [*of(np.degrees(here[:, 2])), *of(np.degrees(reckoned[:, 2]))], rel=2e-5
        )
        p, readings = self.take(r"Innovations: white around zero \(p (.*); (\d+) of laser\)")
        assert readings == self.readings
        assert 0.05 < p <= 1
        readings, total, each, low, high, last, bound, dof = self.take(
            r"Verdict: consistent: the NIS of (\d+) readings sums to (.*) \((.*) per number "
            r"read\), "
            r"within the 99 % band (.*); at the last step "
            r"NEES is (.*), below its 99\.9 % bound (.*)"
        )
        assert readings == self.readings
        assert total == pytest.approx(sum(self.nis), rel=1e-5)
        assert each == pytest.approx(total / readings, rel=1e-2)
        assert [low, high] == pytest.approx(chi2.ppf([0.005, 0.995], self.readings), rel=1e-5)
        assert (last, dof) == (self.last_nees, self.last_dof)
        assert bound == pytest.approx(chi2.ppf(0.999, self.last_dof), rel=1e-5)


def test_every_number_of_the_tour_can_be_checked_by_hand():
    told = ByHand(ekfsim("run", "tour", "--explain").out)
    told.run()
    assert (told.moves, told.readings) == (8, 15)
