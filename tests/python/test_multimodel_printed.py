"""AGMM and SGMM by the letter of paper B: missed scans, uneven steps, across the seam of angles.

Source: Le Minh Hoang, A. A. Konovalov, Dao Van Luc, J. Russian Universities. Radioelectronics,
2023, 26(3).
"""

import numpy as np
import pytest

import wakeline as wl
from wakeline.scenario import Segment, Truth

GRID_RAD_S = np.deg2rad([-4.0, -2.0, 0.0, 2.0, 4.0])
MOST_RAD_S, SPACING_RAD_S, T1, T2, T3 = np.deg2rad(5.0), np.deg2rad(0.5), 0.3, 0.25, 0.75
T = 0.5
CHAIN = np.full((3, 3), 0.05) + 0.85 * np.eye(3)
STD_MPS2 = 0.05
RADAR = wl.RangeBearing(range_std_m=30.0, bearing_std_rad=np.deg2rad(0.5))
START = wl.Gaussian([-3000.0, 1.0, 200.0, -9.0], np.diag([100.0, 1.0, 100.0, 1.0]))
TURN = wl.Ekf(wl.CoordinatedTurn(noise=wl.PiecewiseAcceleration(std_mps2=STD_MPS2)))


def moved_rates(rates, mu):
    """Step 1.1."""
    left, centre, right = rates
    middle = mu @ rates if mu[1] < T1 else centre
    d_left, d_right = max(centre - left, SPACING_RAD_S), max(right - centre, SPACING_RAD_S)
    leading = np.argmax(mu)
    if leading == 0 and mu[0] > T3:
        d_left *= 2
    if leading == 1 and mu[0] < T2:
        d_left /= 2
    if leading == 1 and mu[2] < T2:
        d_right /= 2
    if leading == 2 and mu[2] > T3:
        d_right *= 2
    return np.clip([middle - d_left, middle, middle + d_right], -MOST_RAD_S, MOST_RAD_S)


def moved_centre(centre, mu, rule):
    """Step 1.2."""
    if mu[0] > T:
        return max(centre - 1, 1)
    goes_right = mu[2] > T if rule == "symmetric" else not mu[1] > T
    return min(centre + goes_right, len(GRID_RAD_S) - 2)


def mixed(means, covariances, weights):
    mean = weights @ means
    spread = [p + np.outer(m - mean, m - mean) for m, p in zip(means, covariances, strict=True)]
    return mean, np.einsum("k,kij->ij", weights, spread)


def predicted(mean, covariance, rate, dt_s):
    s = np.sin(rate * dt_s) / rate if rate else dt_s
    c = (1 - np.cos(rate * dt_s)) / rate if rate else 0.0
    cosine, sine = np.cos(rate * dt_s), np.sin(rate * dt_s)
    f = np.array([[1, s, 0, -c], [0, cosine, 0, -sine], [0, c, 1, s], [0, sine, 0, cosine]])
    g = np.kron(np.eye(2), [[dt_s**2 / 2], [dt_s]])
    return f @ mean, f @ covariance @ f.T + STD_MPS2**2 * g @ g.T


def corrected(mean, covariance, z):
    """By an extended Kalman filter; and its likelihood but for a constant."""
    range_m = np.hypot(mean[0], mean[2])
    cosine, sine = mean[0] / range_m, mean[2] / range_m
    h = np.array([[cosine, 0, sine, 0], [-sine / range_m, 0, cosine / range_m, 0]])
    off = z - [range_m, np.arctan2(mean[2], mean[0])]
    off[1] = (off[1] + np.pi) % (2 * np.pi) - np.pi
    r = np.diag([RADAR.range_std_m**2, RADAR.bearing_std_rad**2])
    s = h @ covariance @ h.T + r
    gain = covariance @ h.T @ np.linalg.inv(s)
    likelihood = np.exp(-0.5 * off @ np.linalg.solve(s, off)) / np.sqrt(np.linalg.det(s))
    return mean + gain @ off, covariance - gain @ s @ gain.T, likelihood


def by_the_letter(z, dt_s, rule, carry):
    """Means, covariances, probabilities and turn rates of steps 1 to 6, scan by scan."""
    centre, rates, mu = 2, GRID_RAD_S[1:4], np.array([0.05, 0.9, 0.05])
    means, covariances = np.tile(START.mean, (3, 1)), np.tile(START.covariance, (3, 1, 1))
    rows, seen = [], False
    for reading, dt in zip(z, dt_s, strict=True):
        if seen and rule == "adaptive":
            rates = moved_rates(rates, mu)
        elif seen:
            goes = moved_centre(centre, mu, rule) - centre
            centre += goes
            rates = GRID_RAD_S[centre - 1 : centre + 2]
            if goes and carry == "identity":
                entering = mixed(means, covariances, mu)
                means, covariances, mu = (np.roll(x, -goes, 0) for x in (means, covariances, mu))
                means[1 + goes], covariances[1 + goes] = entering
        seen = not np.isnan(reading[0])
        expected = mu @ CHAIN
        begin = [mixed(means, covariances, CHAIN[:, j] * mu / expected[j]) for j in range(3)]
        likelihood = np.ones(3)
        for j in range(3):
            means[j], covariances[j] = predicted(*begin[j], rates[j], dt)
            if seen:
                means[j], covariances[j], likelihood[j] = corrected(
                    means[j], covariances[j], reading
                )
        mu = expected * likelihood / (expected @ likelihood)
        rows.append((*mixed(means, covariances, mu), mu, rates))
    return [np.array(column) for column in zip(*rows, strict=True)]


def in_the_south(seed):
    """Readings of a vessel that weaves across the bearing of 180 degrees; one in six is missed."""
    rng = np.random.default_rng(seed)
    dt_s = rng.choice([1.0, 3.0, 3.0, 5.5], 60)
    turns = [Segment(60.0, rate) for rate in np.deg2rad([0.0, 3.0, -2.0, 4.0])]
    x, _, y, _ = Truth(START.mean, turns).state_at(np.cumsum(dt_s)).T
    z = np.column_stack([np.hypot(x, y), np.arctan2(y, x)])
    z += rng.standard_normal((60, 2)) * [RADAR.range_std_m, RADAR.bearing_std_rad]
    z[:, 1] = (z[:, 1] + np.pi) % (2 * np.pi) - np.pi
    z[rng.random(60) < 1 / 6] = np.nan
    return z, dt_s


def estimator(rule, carry):
    if rule == "adaptive":
        return wl.AdaptiveGridImm(
            TURN,
            max_turn_rate_rad_s=MOST_RAD_S,
            initial_turn_rates_rad_s=GRID_RAD_S[1:4],
            min_spacing_rad_s=SPACING_RAD_S,
            kept_spacing_rad_s=0.0,
            least_move_rad_s=0.0,
            centre_threshold=T1,
            centre_gain=1.0,
            unlikely_threshold=T2,
            likely_threshold=T3,
        )
    return wl.SwitchingGridImm(TURN, GRID_RAD_S, threshold=T, rule=rule, carry=carry)


@pytest.mark.filterwarnings("ignore:the ModeChain has no period")
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(
    ("rule", "carry"),
    [
        ("adaptive", "slot"),
        *(("symmetric", "slot"), ("symmetric", "identity")),
        *(("literal", "slot"), ("literal", "identity")),
    ],
)
def test_grids_move_by_the_letter_of_the_paper(rule, carry, seed):
    z, dt_s = in_the_south(seed)
    run = estimator(rule, carry).run(z, dt_s=dt_s, sensor=RADAR, start=START)
    mean, covariance, mu, rates = by_the_letter(z, dt_s, rule, carry)
    assert len(np.unique(rates, axis=0)) > 2
    np.testing.assert_allclose(run.mean, mean, rtol=1e-8, atol=1e-7)
    np.testing.assert_allclose(run.covariance, covariance, rtol=1e-7, atol=1e-7)
    np.testing.assert_allclose(run.mode_probability, mu, atol=1e-9)
    np.testing.assert_allclose(run.turn_rate_rad_s, rates, atol=1e-10)
