#!/usr/bin/env bash
# Guess:     sixteen steps ahead, predictor() tells what sixteen calls of update(None) do: it runs a copy of the filter.
# Behaviour: a copy of pfilter's has no noise: copy() hands on each function but noise_fn, so that the copy moves its
#            particles and spreads none. A robot known to 0.39 m whose steps are off by 0.5 m is known to 0.39 m sixteen
#            steps on, by predictor(), and to 2.0 m by update(None); the means agree, and the picture looks right. A
#            copy that goes on with readings gets ever surer: after thirty more it claims 0.07 m, where the filter
#            itself claims 0.39 m of the same readings, with a mean NEES of 39. Right: set the copy's noise_fn
#            to that of its filter, and call update(None) on that copy in place of predictor().
# Version:   pfilter 0.2.5 (PyPI)
# Source:    run below; ParticleFilter.copy names no noise_fn, and the constructor then takes the identity
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q pfilter==0.2.5 numpy==2.4.6 2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from pfilter import ParticleFilter, gaussian_noise

STEP, READ, AHEAD, MORE = 0.5, 0.5, 16, 30
np.random.seed(1)


def driven():
    """A filter of a robot that drives 1 m a step, give or take STEP, after five readings to READ."""
    filter = ParticleFilter(
        prior_fn=lambda n: np.random.normal(0.0, 0.4, (n, 1)),
        n_particles=4000,
        dynamics_fn=lambda x: x + 1.0,
        noise_fn=lambda x: gaussian_noise(x, [STEP]),
        weight_fn=lambda told, read: np.exp(-np.sum((told - read) ** 2, axis=1) / (2 * READ**2)),
    )
    for reading in range(1, 6):
        filter.update(np.array([float(reading)]))
    return filter


def mended(filter):
    copy = filter.copy()
    copy.noise_fn = filter.noise_fn
    return copy


def told(filter):
    return float(np.mean(filter.particles)), float(np.std(filter.particles))


filter = driven()
ways = {"predictor()": filter.copy(), "copy with its noise": mended(filter), "the filter itself": filter}
now = told(filter)[1]
print(f"{AHEAD} steps ahead of a place known to {now:.2f} m (right: {np.sqrt(now**2 + AHEAD * STEP**2):.2f} m)")
*_, ways["predictor()"] = filter.predictor(AHEAD)
for name in ("copy with its noise", "the filter itself"):
    for _ in range(AHEAD):
        ways[name].update(None)
ahead = [told(way) for way in ways.values()]
for name, (mean, sigma) in zip(ways, ahead, strict=True):
    print(f"  {name:21s}{mean:6.2f} ± {sigma:.2f}")

filter, draws, truth = driven(), np.random.default_rng(1), 5.0
ways = {"copy": filter.copy(), "copy with its noise": mended(filter), "the filter itself": filter}
nees = {name: [] for name in ways}
for _ in range(MORE):
    truth += 1.0 + draws.normal(0.0, STEP)
    reading = np.array([truth + draws.normal(0.0, READ)])
    for name, way in ways.items():
        way.update(reading)
        mean, sigma = told(way)
        nees[name].append((mean - truth) ** 2 / sigma**2)
print(f"after {MORE} readings more:  claimed (m)  mean NEES")
after = [(told(way)[1], float(np.mean(nees[name]))) for name, way in ways.items()]
for name, (sigma, mean) in zip(ways, after, strict=True):
    print(f"  {name:21s}{sigma:12.2f}{mean:11.1f}")
flat = np.isclose(ahead[0][1], now, rtol=0.01)
others = all(1.9 < sigma < 2.2 for _, sigma in ahead[1:])
means = all(abs(mean - 21.0) < 0.15 for mean, _ in ahead)
sure = after[0][0] < 0.15 and after[0][1] > 10
right = all(0.35 < sigma < 0.45 and mean < 2 for sigma, mean in after[1:])
raise SystemExit(0 if flat and others and means and sure and right else "this has changed")
PYTHON
