"""What several tests share: a vessel, a radar that sees it, estimators of every kind."""

import struct

import numpy as np

import wakeline as wl
from wakeline.scenario import RadarSimulator, Segment, Truth

DT_S = 3.0
RADAR = wl.RangeBearing(range_std_m=30.0, bearing_std_rad=np.deg2rad(0.5))
CONVERTED = wl.ConvertedRangeBearing(range_std_m=30.0, bearing_std_rad=np.deg2rad(0.5))
POSITION = wl.Position(position_std_m=25.0)
START_MEAN = np.array([4000.0, 6.0, 3000.0, -8.0])
START = wl.Gaussian(START_MEAN, np.diag([50.0**2, 4.0, 50.0**2, 4.0]))
SMALL_NOISE = wl.WhiteAcceleration(psd_m2s3=0.05)

LINEAR_MOTIONS = {
    "ConstantVelocity": wl.ConstantVelocity(noise=SMALL_NOISE),
    "ConstantAcceleration": wl.ConstantAcceleration(noise=wl.WhiteJerk(psd_m2s5=0.01)),
    "CoordinatedTurn": wl.CoordinatedTurn(turn_rate_rad_s=0.02, noise=SMALL_NOISE),
    "Singer": wl.Singer(maneuver_time_s=20.0, accel_std_mps2=0.3),
}
MOTIONS = LINEAR_MOTIONS | {
    "CoordinatedTurnRate": wl.CoordinatedTurnRate(noise=SMALL_NOISE),
    "WanderingCourse": wl.WanderingCourse(),
}


def turning_imm(kind=wl.Ekf, rates_deg_s=(0.0, 1.0, -1.0), stay=0.95):
    """An Imm of known turn rates whose chain shares what does not stay."""
    modes = len(rates_deg_s)
    matrix = np.full((modes, modes), (1.0 - stay) / (modes - 1))
    np.fill_diagonal(matrix, stay)
    filters = [
        kind(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate), noise=SMALL_NOISE))
        for rate in rates_deg_s
    ]
    return wl.Imm(filters, wl.ModeChain(matrix, period_s=DT_S))


def mixed_imm():
    """An Imm of filters of three kinds and three sizes of state."""
    filters = [
        wl.Ekf(MOTIONS["ConstantVelocity"]),
        wl.Ukf(MOTIONS["CoordinatedTurnRate"]),
        wl.SquareRootUkf(MOTIONS["ConstantAcceleration"]),
    ]
    return wl.Imm(filters, wl.ModeChain.from_sojourn_s([60.0, 30.0, 30.0]))


ESTIMATORS = {
    **{
        f"{kind.__name__}-{name}": (lambda kind=kind, motion=motion: kind(motion))
        for kind in (wl.Ekf, wl.Ukf, wl.SquareRootUkf)
        for name, motion in MOTIONS.items()
    },
    "Imm": turning_imm,
    "Imm-mixed": mixed_imm,
}


def readings(scans=30, seed=1, miss=()):
    """(T, 2) range and bearing of a vessel that turns half way; NaN rows where it is missed."""
    truth = Truth(START_MEAN, [Segment(scans * DT_S / 2), Segment(scans * DT_S, 0.02)])
    simulator = RadarSimulator(30.0, np.deg2rad(0.5), DT_S)
    _, z = simulator.observe(truth, scans, seed, start_time_s=DT_S)
    z[list(miss)] = np.nan
    return z


def stepwise(estimator, z, dt_s=DT_S, sensor=RADAR, start=START):
    """What `run` shall give, by single steps: mean, covariance, innovation, NIS and
    log-likelihood."""
    estimator.start(start)
    rows = []
    for row in z:
        estimator.predict(dt_s)
        step = None if np.isnan(row).all() else estimator.update(sensor, row)
        belief = estimator.estimate()
        rows.append(
            (
                belief.mean,
                belief.covariance,
                step.innovation if step else np.full(len(row), np.nan),
                step.nis if step else np.nan,
                step.log_likelihood if step else np.nan,
            )
        )
    return [np.array(column) for column in zip(*rows, strict=True)]


def blocks_of(octets):
    """The data blocks of a sound file."""
    blocks = []
    while octets:
        (length,) = struct.unpack(">H", octets[1:3])
        blocks.append(octets[:length])
        octets = octets[length:]
    return blocks
