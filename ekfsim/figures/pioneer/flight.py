"""Document 001: the error of the time of flight over the SNR, the UKF against a threshold."""

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from ekfsim.figures.album import BLACK, BLUE, GREY, ORANGE, Album, labelled
from ekfsim.figures.pioneer.echo import MM, US
from ekfsim.figures.track import rmse
from ekfsim.geometry import Array
from ekfsim.scene import Scene
from ekfsim.simulation.bench import echoes, heard, sigma_of
from ekfsim.systems.echo import (
    SHARE,
    Pair,
    estimate_echo,
    flight_bound,
    hilbert_envelope,
    noise_of,
    threshold_crossing,
    typical_delay,
)

LOUDNESS = tuple(range(0, 31, 5))  # dB
SHARES = (0.05, 0.1, SHARE, 0.3, 0.5, 0.7)  # of the peak, the thresholds that are tried
TRIALS = 200
FAR_OFF = 1e-4  # s, 17 mm: an error beyond this is counted as a miss
FLIGHT = """
Root mean square error of the time of flight over the SNR, {trials} echoes at each, from 0.1 to 2 m.
T and α of each differ by {spread:.0f} % (one standard deviation) from what is typical of the pair;
the UKF is told that much and no more. Grey: when the envelope crosses {share:.0f} % of its peak, as
it comes, late by {delay:.0f} µs. Orange: the same less the delay of a typical echo; what is left at
high SNR is that no echo is typical. Blue: the UKF. Dashed: the bound of Cramér and Rao, which no
unbiased estimator undercuts. At 20 dB: {raw:.0f}, {less:.0f} and {ukf:.0f} µs, the bound
{bound:.0f} µs.

Where the UKF is better: {better}, by a factor of {gain:.1f} at 20 dB and {top:.1f} at 30 dB, for it
finds the T and α of each echo. Of thresholds from {lowest:.0f} to {highest:.0f} % the best one is
at {best_20:.0f} % for 20 dB and at {best_30:.0f} % for 30 dB; against these the UKF is better by
{gain_best:.1f} and {top_best:.1f}. Where it is not: at the lowest SNR the highest point of the
envelope, where every method here begins to look, is often noise. At {quietest:g} dB {missed:.0f} %
of the UKF's errors exceed 100 µs, and its own σ is no warning: it claims {claimed:.0f} µs where the
error is {low:.0f} µs. From 10 dB up it is {least:.1f} to {most:.1f} times the bound, and errs by
more than it claims ({honest:.1f} times at 20 dB): the noise of a Hilbert envelope is neither white
nor Gaussian where the echo begins. The document claims to find the echo even at "high signal to
noise ratio", and surely means high noise; it prints no numbers.
"""
TABLE = """
The same in numbers, and medians of |error|, which a few lost echoes do not move. "Missed": off by
more than 100 µs (17 mm). "Claimed": the median of the UKF's own σ of τ. "Threshold": less the delay
of a typical echo; "crossing": as it comes.
"""


class Trial(NamedTuple):
    """What was made of the echoes at one SNR. Errors are of the time of flight in s : (N,)"""

    snr: float  # dB
    ukf: Array
    claimed: Array  # σ of τ
    crossing: Array
    threshold: Array  # the crossing less the typical delay
    bound: float
    # the best threshold as a share of the peak, and the root mean square of its error
    best: tuple[float, float]


def trial(pair: Pair, snr: float, n: int, seed: int) -> Trial:
    """Time n echoes, the same ones at every SNR."""
    sigma = sigma_of(snr)
    echo = echoes(pair, n, np.random.default_rng([seed, 5]))
    samples = heard(pair, echo, sigma, np.random.default_rng([seed, 5, round(10 * snr)]))
    measured, noise = hilbert_envelope(samples), noise_of(samples, pair)
    x, P = estimate_echo(measured, noise, pair)
    late = {
        share: threshold_crossing(measured, noise, pair, share) - echo[:, 1] for share in SHARES
    }
    errors = {
        share: rmse(crossing - typical_delay(pair, share)) for share, crossing in late.items()
    }
    best = min(errors, key=errors.__getitem__)
    threshold, bound = late[SHARE] - typical_delay(pair), rmse(flight_bound(echo, sigma, pair))
    claimed = np.sqrt(P[:, 1, 1])
    return Trial(
        snr, x[:, 1] - echo[:, 1], claimed, late[SHARE], threshold, bound, (best, errors[best])
    )


def draw_flight(scene: Scene, album: Album) -> None:
    """The error of the time of flight over the SNR, drawn and in numbers."""
    pair = Pair()
    trials = [trial(pair, snr, TRIALS, scene.seed) for snr in LOUDNESS]
    _draw_errors(album, pair, trials)
    _tabulate(album, trials)


def _draw_errors(album: Album, pair: Pair, trials: list[Trial]) -> None:
    snr = [t.snr for t in trials]
    figure = album.figure(7.6, 5.0)
    axes = labelled(
        figure.subplots(), "signal to noise ratio (dB)", "root mean square error of the flight (µs)"
    )
    _curve(
        axes,
        snr,
        [rmse(t.crossing) for t in trials],
        GREY,
        "v",
        f"threshold, {100 * SHARE:.0f} % of the peak",
    )
    _curve(
        axes,
        snr,
        [rmse(t.threshold) for t in trials],
        ORANGE,
        "s",
        "the same, less the typical delay",
    )
    _curve(axes, snr, [rmse(t.ukf) for t in trials], BLUE, "o", "UKF, four parameters")
    axes.plot(
        snr, [t.bound * US for t in trials], color=BLACK, ls="--", lw=1.4, label="Cramér-Rao bound"
    )
    axes.set_yscale("log")
    axes.legend(fontsize=8.5)
    distance = axes.secondary_yaxis("right", functions=(_millimetres, _microseconds))
    distance.set_ylabel("the same of the distance (mm)")
    _caption(album, figure, pair, trials)


def _caption(album: Album, figure: Figure, pair: Pair, trials: list[Trial]) -> None:
    ratio = {t.snr: rmse(t.threshold) / rmse(t.ukf) for t in trials}
    worse = [f"{snr:g}" for snr, times in ratio.items() if times <= 1]
    above = [rmse(t.ukf) / t.bound for t in trials if t.snr >= 10]
    (at, loud), quiet = (next(t for t in trials if t.snr == snr) for snr in (20, 30)), trials[0]
    album.add(
        figure, "fig5b-flight", "The time of flight: UKF against threshold",
        FLIGHT.format(
            trials=len(quiet.ukf), spread=100 * pair.spread, share=100 * SHARE,
            delay=typical_delay(pair) * US,
            raw=rmse(at.crossing) * US, less=rmse(at.threshold) * US, ukf=rmse(at.ukf) * US,
            bound=at.bound * US,
            better=f"at every SNR but {' and '.join(worse)} dB" if worse else "at every SNR drawn",
            gain=ratio[20],
            top=ratio[30], lowest=100 * SHARES[0], highest=100 * SHARES[-1],
            best_20=100 * at.best[0],
            best_30=100 * loud.best[0], gain_best=at.best[1] / rmse(at.ukf),
            top_best=loud.best[1] / rmse(loud.ukf),
            honest=rmse(at.ukf) / np.median(at.claimed), quietest=quiet.snr,
            missed=100 * np.mean(np.abs(quiet.ukf) > FAR_OFF),
            claimed=np.median(quiet.claimed) * US, low=rmse(quiet.ukf) * US, least=min(above),
            most=max(above),
        ),
    )  # fmt: skip


def _millimetres(flight: ArrayLike) -> ArrayLike:
    """of distance, for µs of flight"""
    return np.asarray(flight, float) / US * MM


def _microseconds(distance: ArrayLike) -> ArrayLike:
    """of flight, for mm of distance"""
    return np.asarray(distance, float) / MM * US


def _curve(
    axes: Axes, snr: list[float], error: list[float], color: str, marker: str, label: str
) -> None:
    axes.plot(snr, np.array(error) * US, marker + "-", color=color, lw=1.6, ms=5, label=label)


def _tabulate(album: Album, trials: list[Trial]) -> None:
    header = (
        "SNR (dB)", "UKF RMSE (µs)", "median", "missed", "claimed σ (µs)", "threshold RMSE (µs)",
        "median", "missed",
        "crossing RMSE (µs)", "bound (µs)",
    )  # fmt: skip
    rows = []
    for t in trials:
        ukf, threshold = (
            (
                f"{rmse(e) * US:.1f}",
                f"{np.median(np.abs(e)) * US:.1f}",
                f"{100 * np.mean(np.abs(e) > FAR_OFF):.1f} %",
            )
            for e in (t.ukf, t.threshold)
        )
        crossing, bound = f"{rmse(t.crossing) * US:.1f}", f"{t.bound * US:.1f}"
        rows.append(
            (f"{t.snr:g}", *ukf, f"{np.median(t.claimed) * US:.1f}", *threshold, crossing, bound)
        )
    album.table("flight", "Errors of the time of flight", header, rows, TABLE)
