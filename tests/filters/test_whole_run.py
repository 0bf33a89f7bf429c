"""A whole linear run as one Gaussian of its start and all its noises, conditioned on all readings
at once.

It shares no recursion with the filters: one matrix, one solve. What a filter believes after each
reading must be what this says of the state then.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numerics import covariance
from problems import begun, problem

from ekfsim.filters.belief import Gaussian

STEPS = 12


def conditioned_at_once(model, first, U, Z):
    """Mean (n,) and covariance (n, n) of the state after the last of the readings Z : (t, k), U :
    (t, m) before each.

    With s = (x₀, w₁ … w_t), wᵢ the noise that step i adds, each state is xᵢ = cᵢ + Tᵢ s and each
    reading zᵢ = C xᵢ + vᵢ, so that (s, z) is one Gaussian, and E[x_t | z] = c_t + T_t Σ Hᵀ (H Σ Hᵀ
    + R)⁻¹ (z − H s̄).
    """
    n, t = len(model.A), len(Z)
    W = model.B @ model.input_noise @ model.B.T + model.process_noise
    Σ = np.zeros(((t + 1) * n, (t + 1) * n))
    Σ[:n, :n] = first.covariance
    for i in range(1, t + 1):
        Σ[i * n : (i + 1) * n, i * n : (i + 1) * n] = W
    c, T, rows, expected = first.mean, np.eye(n, (t + 1) * n), [], []
    for i, u in enumerate(U, start=1):
        c, T = model.A @ c + model.B @ u, model.A @ T
        T[:, i * n : (i + 1) * n] = np.eye(n)
        rows.append(model.C @ T)
        expected.append(model.C @ c)
    H = np.concatenate(rows)
    S = H @ Σ @ H.T + np.kron(np.eye(t), model.noise)
    gain = np.linalg.solve(S, H @ Σ @ T.T).T
    return c + gain @ (Z.ravel() - np.concatenate(expected)), T @ Σ @ T.T - gain @ H @ Σ @ T.T


@pytest.mark.parametrize("name", ["kf", "ekf", "iekf", "ukf", "ukf-augmented"])
@pytest.mark.parametrize(("n", "m", "k"), [(1, 1, 1), (3, 2, 1), (4, 2, 2)])
@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_filter_believes_what_all_readings_at_once_say(name, n, m, k, seed):
    random = np.random.default_rng(seed)
    model = problem(random, n, m, k)
    model.A = np.linalg.qr(model.A)[0]  # a turn: nothing grows without end, and digits are kept
    first = Gaussian(random.normal(size=n), covariance(random, n))
    U, Z = random.normal(size=(STEPS, m)), 5 * random.normal(size=(STEPS, k))
    filter, belief = begun(name, first, headings=()), first
    for t in range(1, STEPS + 1):
        belief, _ = filter.predict(belief, model, U[t - 1])
        belief, _ = filter.update(belief, model, Z[t - 1])
        mean, P = conditioned_at_once(model, first, U[:t], Z[:t])
        size = np.sqrt(np.diagonal(P))
        assert np.abs(belief.mean - mean).max() <= 1e-9 * max(1.0, np.abs(mean).max())
        assert (
            np.abs(belief.covariance - P) <= 1e-9 * (np.outer(size, size) + np.abs(P).max())
        ).all()
