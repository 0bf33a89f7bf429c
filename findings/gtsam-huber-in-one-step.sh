#!/usr/bin/env bash
# Guess:     where the robot is known to 10 m and stands 5 m from the mean, a reading to 0.1 m is no outlier: under
#            Huber's loss it leaves the belief as sharp as without one, 0.1 m, as an optimizer of the two factors says.
# Behaviour: gtsam's ExtendedKalmanFilter weighs the reading once, where it linearises, by the standard deviation of the
#            reading alone: 5 m are 50, however vague the belief, and the place is known to 0.6 m. Of 1000 starts and
#            readings that are all right each one is weighed down so, and the mean NEES is 0.06 where 2 is right: a
#            robust filter is far too cautious just where it is new, or lost. A second reading of the same instant
#            counts nearly whole. Right: an optimizer over belief and reading, which weighs anew at each of its steps.
# Version:   gtsam 4.3.0 (PyPI), Huber with k = 1.345
# Source:    run below; ExtendedKalmanFilter.update linearises the factor once, and a Robust noise model weighs there
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q gtsam==4.3.0 numpy==2.4.6 2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import gtsam
import numpy as np

KEY, VAGUE, K = 0, 10.0, 1.345
BELIEF, PLAIN = (gtsam.noiseModel.Isotropic.Sigma(2, sigma) for sigma in (VAGUE, 0.1))
HUBER = gtsam.noiseModel.Robust.Create(gtsam.noiseModel.mEstimator.Huber.Create(K), PLAIN)


def filtered(reading, model, times=1):
    """Mean and standard deviation (m) of the filter after a reading that comes so many times."""
    filter = gtsam.ExtendedKalmanFilterPoint2(KEY, np.zeros(2), BELIEF)
    for _ in range(times):
        mean = filter.update(gtsam.PriorFactorPoint2(KEY, reading, model))
    information = filter.Density().information()
    return mean, float(np.sqrt(np.linalg.inv(information)[0, 0]))


def optimized(reading, model):
    """The same of an optimizer that starts where the filter does."""
    graph, start = gtsam.NonlinearFactorGraph(), gtsam.Values()
    graph.add(gtsam.PriorFactorPoint2(KEY, np.zeros(2), BELIEF))
    graph.add(gtsam.PriorFactorPoint2(KEY, reading, model))
    start.insert(KEY, np.zeros(2))
    result = gtsam.LevenbergMarquardtOptimizer(graph, start).optimize()
    covariance = gtsam.Marginals(graph, result).marginalCovariance(KEY)
    return result.atPoint2(KEY), float(np.sqrt(covariance[0, 0]))


print("known after the reading (m)    filter: plain   Huber   twice     optimizer with Huber")
told = {}
for metres in (0.1, 1.0, 5.0, 20.0):
    reading = np.array([metres, 0.0])
    ways = filtered(reading, PLAIN), filtered(reading, HUBER), filtered(reading, HUBER, 2), optimized(reading, HUBER)
    told[metres] = [sigma for _, sigma in ways]
    print(f"{metres:5.1f} m from the mean" + "{:24.3f}{:8.3f}{:8.3f}{:15.3f}".format(*told[metres]))
draws = np.random.default_rng(1)
nees, weighed = {"plain": [], "Huber": []}, 0
for _ in range(1000):
    truth = draws.normal(0.0, VAGUE, 2)
    reading = truth + draws.normal(0.0, 0.1, 2)
    for name, model in (("plain", PLAIN), ("Huber", HUBER)):
        mean, sigma = filtered(reading, model)
        nees[name].append(np.sum((mean - truth) ** 2) / sigma**2)
    weighed += sigma > 0.11
means = {name: float(np.mean(each)) for name, each in nees.items()}
print(f"1000 right starts and readings: {weighed} weighed down; mean NEES", *(f"{n} {m:.2f}" for n, m in means.items()))
steps = [np.sqrt(1 / (1 / VAGUE**2 + 100 * min(1.0, K / (10 * metres)))) for metres in told]
once = np.allclose([each[1] for each in told.values()], steps, rtol=1e-3)
others = np.allclose([each[way] for each in told.values() for way in (0, 3)], 0.1, rtol=0.01)
second = all(each[2] < 0.15 for each in told.values())
cautious = weighed > 990 and 1.8 < means["plain"] < 2.2 and means["Huber"] < 0.1
raise SystemExit(0 if once and others and second and cautious else "this has changed")
PYTHON
