"""Document 001, figure 5: the echo, its Hilbert envelope and the UKF's fit of it."""

import numpy as np
from matplotlib.axes import Axes

from ekfsim.figures.album import BLACK, BLUE, GREEN, GREY, ORANGE, SKY, VERMILLION, Album, labelled
from ekfsim.geometry import Array
from ekfsim.models.sensors.echo import envelope, printed_envelope
from ekfsim.scene import Scene
from ekfsim.simulation.bench import heard, sigma_of
from ekfsim.systems.echo import (
    SHARE,
    SOUND,
    Pair,
    estimate_echo,
    height,
    hilbert_envelope,
    noise_of,
    threshold_crossing,
)

US, MM = 1e6, 1e3 * SOUND / 2  # what makes µs of s, and mm of distance
SHOWN, DISTANCE = 15.0, 1.0  # dB, m: of the echo that is drawn
ECHO = """
An echo from a wall {distance:g} m away at an SNR of {snr:g} dB (the carrier's power at the
envelope's peak over the noise's), sampled at {rate:g} kS/s: the signal (blue, a {carrier:g} kHz
carrier), the modulus of its Hilbert transform (red) and the envelope of eq. 38 with the parameters
that the UKF found (black). Bottom: its arrival. The UKF says τ = {flight:.1f} ± {sigma:.1f} µs
where {true:.1f} µs is true: {error:+.1f} µs, or {mm:+.1f} mm of distance. A threshold at
{share:.0f} % of the peak says {threshold:.1f} µs, for an echo takes time to get there. Estimated:
A₀ = {A0:.3f} V, T = {T:.0f} µs, α = {α:.2f}; true: {A0_true:.3f} V, {T_true:.0f} µs, {α_true:.2f};
typical of the pair, and the first guess: {T_pair:.0f} µs, {α_pair:g}. (Internally times are ms and
amplitudes shares of the peak.)

Compared with the print: signal, envelope and estimate in the print's colours; no numbers are
printed, and T and α are ours. Eq. 38 is printed without the minus in its exponent. To the letter it
does not end: at its peak, αT after its arrival, it would be e^{power:.1f} = {times:.0f} times as
high as the right one, and grow on; no parameters make it fit an echo{drawn}. Before a sample is
used, the noise's power is taken off the envelope's, which the document does not mention: without it
the envelope never falls to 0 and the fit begins too early.
"""


def draw_echo(scene: Scene, album: Album) -> None:
    """Figure 5."""
    pair = Pair()
    T, α = 1.12 * pair.rise, 0.9 * pair.power
    echo = np.array([1 / height(1.0, α), pair.flight(DISTANCE), T, α])
    samples = heard(pair, echo, sigma_of(SHOWN), np.random.default_rng([scene.seed, 5, 1]))
    measured, noise = hilbert_envelope(samples), noise_of(samples, pair)
    x, P = estimate_echo(measured, noise, pair)
    σ, crossing = float(np.sqrt(P[1, 1])), float(threshold_crossing(measured, noise, pair))
    t, arrival, error = pair.times * 1e3, x[1] * 1e3, x[1] - echo[1]
    figure = album.figure(9.0, 6.4)
    whole, close = figure.subplots(2, 1)
    for axes, color, width in ((whole, SKY, 0.6), (close, BLUE, 0.9)):
        axes.plot(t, samples, color=color, lw=width, label="signal")
        axes.plot(t, measured, color=VERMILLION, lw=1.1, label="Hilbert envelope")
        _envelopes(axes, pair, x, scene.reading == "printed")
        labelled(axes, "time since the emission (ms)", "received (V)").set(ylim=(-1.65, 1.65))
    whole.set_xlim(0, t[-1])
    close.set_xlim(arrival - 0.35, arrival + 1.25)
    near = (arrival - 2e3 * σ, arrival + 2e3 * σ)
    close.axvspan(*near, color=GREY, alpha=0.35, lw=0, label="τ ± 2σ by the UKF")
    close.axvline(echo[1] * 1e3, color=GREEN, lw=1.6, label="true τ")
    close.axvline(
        crossing * 1e3, color=ORANGE, ls="--", lw=1.6, label=f"{100 * SHARE:.0f} % of the peak"
    )
    whole.legend(loc="upper right", fontsize=8, ncols=2)
    close.legend(loc="lower right", fontsize=8, ncols=3)
    album.add(
        figure, "fig5-echo", "Figure 5: the echo, its Hilbert envelope and the UKF's fit",
        ECHO.format(
            distance=DISTANCE, snr=SHOWN, share=100 * SHARE, rate=pair.rate / 1e3,
            carrier=pair.carrier / 1e3,
            flight=x[1] * US, sigma=σ * US, true=echo[1] * US, error=error * US, mm=error * MM,
            threshold=crossing * US, A0=x[0], T=x[2] * US, α=x[3], A0_true=echo[0], T_true=T * US,
            α_true=α,
            T_pair=pair.rise * US, α_pair=pair.power,
            power=2 * α, times=np.exp(2 * α),
            drawn=" (green, cut off)" if scene.reading == "printed" else "",
        ),
    )  # fmt: skip


def _envelopes(axes: Axes, pair: Pair, x: Array, as_printed: bool) -> None:
    """Eq. 38 with the UKF's parameters, and without its minus where the print is followed."""
    t = pair.times * 1e3
    axes.plot(t, envelope(pair.times, *x), color=BLACK, lw=1.8, label="the UKF's eq. 38")
    if as_printed:
        grown = printed_envelope(pair.times, *x)
        shown = np.where(grown < 1.6, grown, np.nan)
        axes.plot(t, shown, color=GREEN, ls="--", lw=1.5, label="eq. 38 as printed")
