"""LKF, EKF and UKF side by side on document 001's square: over time, and in a table with what
chance makes of it.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.figures.album import BLACK, BLUE, GREEN, ORANGE, SKY, VERMILLION, Album, labelled
from ekfsim.figures.crowd import Crowd, crowd_of, over_runs, set_down
from ekfsim.figures.pioneer.square import corners, shade_corners
from ekfsim.figures.track import rmse
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.arithmetic.unscented import sigma_points, weights
from ekfsim.filters.belief import Belief, Correction, Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Sensor
from ekfsim.scene import Scene
from ekfsim.study.comparison import of_shares
from ekfsim.study.pairs import Shared
from ekfsim.study.results import Share

RUNS = 200
NAMES = {
    "kf": "LKF about the start", "kf-nominal": "LKF about the plan", "ekf": "EKF", "ukf": "UKF",
    "ukf-augmented": "augmented UKF",
}  # fmt: skip
CAUTIOUS = "cautious EKF"
COLORS = {"kf": VERMILLION, "kf-nominal": GREEN, "ekf": BLUE, "ukf": BLACK, "ukf-augmented": SKY}
LINES = {  # all but the first lie on one another
    "kf": ("-", 1.5), "kf-nominal": ("-", 5.0), "ekf": ("-", 3.2), "ukf": ("--", 1.3),
    "ukf-augmented": (":", 1.6),
}  # fmt: skip
# m, degrees: how well the robot is set down on its mark
STARTS = ((0.02, 2.0), (0.2, 20.0), (0.3, 30.0))
RESAMPLED = 2000  # times, to see what other runs might have said
OVER_TIME = """
RMSE of position (top) and heading (bottom) over {runs} runs, at every instant; the robot is set
down on its mark to 2 cm and 2°. Corners are shaded. All filters are given the same readings. The
LKF that is linearised once, at the first belief, is nearly as good as the others on the first side
({kf_first:.1f} mm against {ekf_first:.1f} mm) and lost from the first corner on: it goes on
believing that the robot drives east and that each beam looks at the wall it looked at first. Over
the run it is {kf:.2f} m off, which is worse than no filter ({odometry:.2f} m). Linearised about the
path as it is planned, the same LKF is {nominal:.1f} mm off, the EKF {ekf:.1f} mm and the UKF
{ukf:.1f} mm. What fails is not the linear filter, but a line that is drawn where the robot no
longer is.

The document has no such figure: it names the three and compares them in words.
"""
TABLE = """
{runs} runs (0 to {last}, seed {seed}), driven alike and read alike. "Set down to": the standard
deviation of the first pose, which all filters are told. RMSE over all instants and runs, and of the
median run; NEES of the pose at the end (a mean of 3, a median of 2.4 are right; a few lost runs
dominate a mean); lost: NEES beyond the 99.9 % point of χ², 16.3. In brackets are 95 % intervals: of
an RMSE or a ratio of two by drawing these runs again and again, of a share Wilson's. "Refused":
readings in a run that the filter did not use because it predicted none.

- The LKF about the start (`kf`) fails in every run: a square has four headings, and it knows one.
The same filter   about the plan (`kf-nominal`) knows where the robot should be. The driver holds
the robot to its path by its true   pose, so the plan is nearly the truth: this is the best that
such a filter can do.

- Set down to 2 cm and 2°: {usual}

- To 20 cm and 20°: {middle}

- To 30 cm and 30°: {wide}

- A UKF refuses a reading where any one of its sigma points sees no wall, an EKF where its mean sees
none. The cautious   EKF is an EKF with the UKF's rule. At 30 cm and 30° the EKF refuses
{ekf_blind:.0f} readings a run and loses   {ekf_lost} of the runs, the cautious EKF
{cautious_blind:.0f} and {cautious_lost}, the UKF {ukf_blind:.0f} and   {ukf_lost}. In percentage
points of lost runs the rule costs {rule}, and what is unscented {points}.

- The augmented UKF (`ukf-augmented`) has the noise in its sigma points, as eq. 22 has it; the UKF
adds it. {eq_22}

{verdict} What decides is where a filter linearises, and which readings it refuses. The document
prints no numbers.
"""


@dataclass(frozen=True)
class CautiousEKF(EKF):
    """An EKF with the UKF's rule:
    it refuses a reading that any sigma point of its belief does not predict.
    """

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """EKF.update, of fewer readings."""
        x, P = prior
        points = sigma_points(x, square_root(P), weights(x.shape[-1]).spread)
        unseen = np.isnan(sensor.h(points)).any(axis=(-2, -1))
        return EKF.update(self, prior, sensor, z, np.logical_or(skip, unseen))


def draw_filters(scene: Scene, album: Album) -> None:
    """The figure over time and the table."""
    crowds = []
    for start in (set_down(scene, *start) for start in STARTS):
        of = {name: crowd_of(replace(start, filter=name), RUNS) for name in NAMES}
        crowds.append(of | {CAUTIOUS: crowd_of(start, RUNS, CautiousEKF())})
    _draw_over_time(scene, album, crowds[0])
    _tabulate(scene, album, crowds)


def _draw_over_time(scene: Scene, album: Album, crowds: dict[str, Crowd]) -> None:
    """Errors of the filters over time."""
    figure = album.figure(8.0, 5.6)
    position, heading = figure.subplots(2, 1, sharex=True)
    first = crowds["ekf"]
    t = first.t
    reckoned = np.hypot(first.reckoned[..., 0], first.reckoned[..., 1])
    for axes, e, unit in (
        (position, reckoned, 1e3),
        (heading, first.reckoned[..., 2], math.degrees(1)),
    ):
        shade_corners(axes, scene)
        axes.plot(t, unit * over_runs(e), color=ORANGE, lw=1.5, label="odometry alone")
    for name, told in NAMES.items():
        crowd, (style, width) = crowds[name], LINES[name]
        position.plot(
            t, 1e3 * over_runs(crowd.position), style, color=COLORS[name], lw=width, label=told
        )
        heading.plot(t, np.degrees(over_runs(crowd.heading)), style, color=COLORS[name], lw=width)
    labelled(position, "", "position RMSE (mm)").set(
        yscale="log", xlim=(0, t[-1]), ylim=(1.2, None)
    )
    labelled(heading, "time (s)", "heading RMSE (°)").set(yscale="log")
    position.legend(fontsize=8, ncols=3, loc="lower center")
    ticks, turning = corners(scene)
    before = t < ticks[np.argmax(turning)]
    off = {name: 1e3 * rmse(crowd.position) for name, crowd in crowds.items()}
    album.add(
        figure, "fig8-filters", "LKF, EKF and UKF over time",
        OVER_TIME.format(
            runs=first.error.shape[1], kf_first=1e3 * rmse(crowds["kf"].position[before]),
            kf=off["kf"] / 1e3,
            ekf_first=1e3 * rmse(first.position[before]), odometry=rmse(reckoned),
            nominal=off["kf-nominal"],
            ekf=off["ekf"], ukf=off["ukf"],
        ),
    )  # fmt: skip


def _tabulate(scene: Scene, album: Album, crowds: list[dict[str, Crowd]]) -> None:
    header = (
        "set down to", "filter", "position RMSE (mm)", "95 % of it", "of the median run (mm)",
        "heading RMSE (°)",
        "mean NEES", "median NEES", "lost (%)", "95 % of them", "refused",
    )  # fmt: skip
    rows = []
    for (metres, degrees), of in zip(STARTS, crowds, strict=True):
        start = f"{100 * metres:g} cm, {degrees:g}°"
        reckoned = of["ekf"].reckoned
        p = np.hypot(reckoned[..., 0], reckoned[..., 1])
        rows.append((start, "odometry alone", *_errors(p, reckoned[..., 2]), *"–––––"))
        for name, c in of.items():
            share = _lost(c)
            rows.append((
                start, NAMES.get(name, name), *_errors(c.position, c.heading),
                f"{np.mean(c.nees):.4g}",
                f"{np.median(c.nees):.3g}", f"{100 * share.value:.1f}", _in(100 * share.low,
                100 * share.high, 1),
                f"{c.blind:.1f}",
            ))  # fmt: skip
    usual, middle, wide = crowds
    n = usual["ekf"].nees.size
    better = any(_ratio("ekf", "ukf", of)[0] > 1 for of in crowds)
    album.table(
        "filters", "LKF, EKF and UKF", header, rows,
        TABLE.format(
            runs=n, last=n - 1, seed=scene.seed, usual=_three(usual), middle=_three(middle),
            wide=_three(wide),
            ekf_blind=wide["ekf"].blind, cautious_blind=wide[CAUTIOUS].blind,
            ukf_blind=wide["ukf"].blind,
            ekf_lost=_share(wide["ekf"]), cautious_lost=_share(wide[CAUTIOUS]),
            ukf_lost=_share(wide["ukf"]),
            rule=_more_lost(wide["ekf"], wide[CAUTIOUS]), points=_more_lost(wide[CAUTIOUS],
            wide["ukf"]),
            eq_22=" ".join(f"{_compared('ukf', 'ukf-augmented', of)}." for of in crowds)
            + f" Its points lie further out, and it refuses more: "
              f"{wide['ukf-augmented'].blind:.0f} readings a run.",
            verdict='The "advantages" that the document sees in the unscented filter show in '
            + ("some of these runs." if better else "none of these runs."),
        ),
    )  # fmt: skip


def _errors(position: Array, heading: Array) -> tuple[str, str, str, str]:
    """Position over all runs with its interval, and of the median run; heading."""
    each = np.mean(position**2, axis=0)
    low, high = np.percentile(1e3 * np.sqrt(_again(each)), (2.5, 97.5))
    median = 1e3 * math.sqrt(np.median(each))
    return (
        f"{1e3 * rmse(position):.1f}",
        _in(low, high, 1),
        f"{median:.1f}",
        f"{math.degrees(rmse(heading)):.2f}",
    )


def _again(values: Array) -> Array:
    """The mean of N runs as other N of them might have it : (…, N) → (…, RESAMPLED).
    Efron's bootstrap.
    """
    n = values.shape[-1]
    picked = np.random.default_rng(0).integers(0, n, (RESAMPLED, n))
    means: Array = np.mean(values[..., picked], axis=-1)
    return means


def _three(crowds: dict[str, Crowd]) -> str:
    """LKF about the plan, EKF and UKF in two sentences."""
    return f"{_compared('ekf', 'kf-nominal', crowds)}. {_compared('ekf', 'ukf', crowds)}."


def _ratio(a: str, b: str, crowds: dict[str, Crowd]) -> tuple[float, float, float]:
    """How many times the RMSE of b goes into that of a, over the same runs: low, value, high."""
    squares = np.stack([np.mean(crowds[name].position ** 2, axis=0) for name in (a, b)])
    low, high = np.percentile(np.sqrt(np.divide(*_again(squares))), (2.5, 97.5))
    return float(low), math.sqrt(np.divide(*np.mean(squares, axis=-1))), float(high)


def _compared(a: str, b: str, crowds: dict[str, Crowd]) -> str:
    """Which of two filters is the better one, if these runs can tell."""
    low, ratio, high = _ratio(a, b, crowds)
    first, second = (NAMES[name] for name in (a, b))
    off = [1e3 * rmse(crowds[name].position) for name in (a, b)]
    told = f"The {first} errs by {off[0]:.1f} mm, the {second} by {off[1]:.1f} mm"
    if low <= 1 <= high:
        return (
            f"{told}: no difference that {crowds[a].nees.size} runs can tell ({ratio:.2f} times "
            f"{_in(low, high, 2)})"
        )
    if low > 1:
        return f"{told}: the {second} is better, {ratio:.2f} times {_in(low, high, 2)}"
    return f"{told}: the {first} is better, {1 / ratio:.2f} times {_in(1 / high, 1 / low, 2)}"


def _more_lost(a: Crowd, b: Crowd) -> str:
    """How many more of the same runs b loses, in percentage points with their interval."""
    in_a, in_b = a.is_lost, b.is_lost
    counts = (in_a & in_b, in_a & ~in_b, in_b & ~in_a, ~in_a & ~in_b)
    more = of_shares(Shared(*(int(np.count_nonzero(runs)) for runs in counts)))
    return f"{100 * more.value:+.1f} {_in(100 * more.low, 100 * more.high, 1)}".replace("-", "−")


def _lost(crowd: Crowd) -> Share:
    """The share of lost runs."""
    return Share(int(np.count_nonzero(crowd.is_lost)), crowd.nees.size)


def _share(crowd: Crowd) -> str:
    """Of lost runs, with its interval."""
    share = _lost(crowd)
    return f"{100 * share.value:.1f} % {_in(100 * share.low, 100 * share.high, 1)}"


def _in(low: float, high: float, digits: int) -> str:
    """An interval in brackets."""
    return f"[{low:.{digits}f}, {high:.{digits}f}]"
