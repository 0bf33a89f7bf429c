"""A student who fills a worksheet in: from the sheet alone, each gap from what stands before it.

Every answer is rounded to six digits before it is used again, as it would be on paper.
"""

import math
import re

import numpy as np

NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?"
GAP = r"\((\d+)\)_+"
FIELD = re.compile(rf"{GAP}|({NUMBER})")
K2 = -2 * math.log(1 - 0.954)


def six_digits(value):
    return float(f"{value:.6g}")


def turned(degrees):
    return 180 - (180 - degrees) % 360


class Solver:
    def __init__(self, sheet):
        self.lines, self.answers, self.at = sheet.splitlines(), {}, 0
        the_map = sheet.partition("## The map")[2].partition("## The start")[0]
        self.corners = {
            name: np.array(
                [[float(x), float(y)] for x, y in re.findall(rf"\(({NUMBER}), ({NUMBER})\)", ring)]
            )
            for name, ring in re.findall(r"^(.+): (\(.*\))$", the_map, re.M)
        }
        ratios = re.findall(
            rf"(odometryDst|odometryAng|range)SigmaRatio=({NUMBER})",
            "".join(line for line in self.lines if line.startswith("The noise ratios")),
        )
        self.ratio = {name: float(value) for name, value in ratios}  # as told comes last

    def solved(self):
        begun = False
        while self.at < len(self.lines):
            line = self.lines[self.at]
            self.at += 1
            begun = begun or line.startswith("## Step")
            if line.startswith("First state estimate"):
                self.x = self.take(line.partition("= ")[2], None)
                self.at += 1
                self.P = self.matrix(None)
            elif begun:
                self.read(line)
        return self.answers

    def take(self, text, expected):
        """The numbers of a line, gaps filled with what is expected."""
        found = []
        for i, (gap, told) in enumerate(FIELD.findall(text)):
            if gap:
                found.append(self.answers.setdefault(int(gap), six_digits(expected[i])))
            else:
                found.append(float(told))
        return found

    def matrix(self, expected):
        rows = []
        while self.lines[self.at].lstrip().startswith("["):
            told = self.lines[self.at]
            rows.append(self.take(told, None if expected is None else expected[len(rows)]))
            self.at += 1
        return np.array(rows)

    def read(self, line):
        body = line.split("   (")[0]
        numbers = body.partition("= (")[2]
        if body.startswith("The odometry measured"):
            self.d, self.a = (float(each) for each in re.findall(rf"=({NUMBER})", body))
            θ = math.radians(self.x[2])
            self.M = np.diag(
                [(self.ratio["odometryDst"] * self.d) ** 2,
                 (self.ratio["odometryAng"] * math.radians(self.a)) ** 2]
            )  # fmt: skip
            self.F = np.array(
                [[1, 0, -self.d * math.sin(θ)], [0, 1, self.d * math.cos(θ)], [0, 0, 1]]
            )
            self.G = np.array([[math.cos(θ), 0], [math.sin(θ), 0], [0, 1]])
        elif body == "P_u is:":
            self.M = self.matrix(self.M)
        elif body == "J_x is:":
            self.F = self.matrix(self.F)
        elif body == "J_u is:":
            self.G = self.matrix(self.G)
        elif body == "J_u P_u J_u' is:":
            self.matrix(self.G @ self.M @ self.G.T)
        elif body == "J_x P J_x' is:":
            self.matrix(self.F @ self.P @ self.F.T)
        elif body.startswith("Current state"):
            assert self.take(numbers, self.x) == list(self.x)
        elif body.startswith("New state estimate"):
            x, y, θ = self.x
            c, s = math.cos(math.radians(θ)), math.sin(math.radians(θ))
            moved = [x + self.d * c, y + self.d * s, turned(θ + self.a)]
            self.x = self.take(numbers, moved)
        elif body.startswith("New state covariance"):
            self.P = self.matrix(self.F @ self.P @ self.F.T + self.G @ self.M @ self.G.T)
        elif body.startswith("==>Commanding"):
            self.bearing = float(re.findall(NUMBER, body)[0])
        elif body.startswith("The range is"):
            self.z = float(re.findall(NUMBER, body)[0])
        elif body.startswith("The predicted range was"):
            # which edge it is stands in the next line
            edge, name = re.match(
                r"It was .* meet edge (\d+) of (.*);", self.lines[self.at]
            ).groups()
            self.h, self.H = self.to_edge(self.corners[name], int(edge))
            (self.h,) = self.take(body.partition("was ")[2], [self.h])
        elif body.startswith("  dh/dx"):
            self.H = np.array(self.take(body, self.H))
            self.R = (self.ratio["range"] * self.h) ** 2
            self.S = self.H @ self.P @ self.H + self.R
        elif body.startswith("C_v is"):
            (self.R,) = self.take(body, [self.R])
            self.S = self.H @ self.P @ self.H + self.R
        elif body.startswith("S is"):
            (self.S,) = self.take(body, [self.S])
        elif body.startswith("The innovation is"):
            ν, sd = self.z - self.h, math.sqrt(self.S)
            told = self.take(body, [ν, sd, ν**2 / self.S if sd else math.nan])
            self.ν = told[0]
            self.K = self.P @ self.H / self.S if sd else np.zeros(3)
        elif body.startswith("The Kalman gain"):
            self.K = np.array(self.take(numbers, self.K))
        elif body.startswith("Revised state"):
            x, y, θ = self.x + self.K * self.ν * [1, 1, 180 / math.pi]
            self.x = self.take(body.partition("(x, y, theta) = (")[2], [x, y, turned(θ)])
        elif body.startswith("Revised covariance"):
            self.P = self.matrix((np.eye(3) - np.outer(self.K, self.H)) @ self.P)
        elif "radius is" in body or "orientation is" in body or "sigma_theta is" in body:
            λ, V = np.linalg.eigh(self.P[:2, :2])
            drawn = {
                "minor": math.sqrt(max(K2 * λ[0], 0)),
                "major": math.sqrt(K2 * λ[1]),
                "orientation": math.degrees(math.atan2(V[1, 1], V[0, 1])) % 180,
                "2*sigma_theta": 2 * math.degrees(math.sqrt(self.P[2, 2])),
            }
            self.take(body.partition(" is ")[2], [drawn[body.split()[0]]])

    def to_edge(self, ring, edge):
        """Range and derivatives along the beam to the line through two corners."""
        a, b = ring[edge - 1], ring[edge % len(ring)]
        φ = math.radians(self.x[2] + self.bearing)
        d, across = np.array([math.cos(φ), math.sin(φ)]), np.array([-math.sin(φ), math.cos(φ)])
        n = np.array([a[1] - b[1], b[0] - a[0]]) / math.dist(a, b)
        r = n @ (a - self.x[:2]) / (n @ d)
        return r, np.array([*(-n / (n @ d)), -r * (n @ across) / (n @ d)])
