"""Four estimators on one maneuver: error, consistency and time of each.

A boat goes straight, turns at 1 degree a second and goes straight again; 200 radar recordings of it
differ in their noise. Writes which_estimator.png, the error over time.
"""

import time

import numpy as np

import wakeline as wl

PERIOD_S = 3.0
radar = wl.RangeBearing(range_std_m=60.0, bearing_std_rad=np.deg2rad(0.5))
noise = wl.WhiteAcceleration(psd_m2s3=0.01)
straight, turn = wl.scenario.Segment(120.0), wl.scenario.Segment(90.0, np.deg2rad(1.0))
truth = wl.scenario.Truth([4000.0, 6.0, 3000.0, -8.0], [straight, turn, straight])
simulator = wl.scenario.RadarSimulator(60.0, np.deg2rad(0.5), period_s=PERIOD_S)
recordings = [simulator.observe(truth, scans=110, rng=seed) for seed in range(200)]
time_s, z = recordings[0][0][2:], np.stack([z for _, z in recordings])
starts = [wl.two_point(radar, run[0], run[1], dt_s=PERIOD_S) for run in z]


def turning(rate_deg_s):
    return wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate_deg_s), noise=noise))


restless = wl.WhiteAcceleration(psd_m2s3=0.3)
estimators = {
    "one quiet filter": wl.Ekf(wl.ConstantVelocity(noise=noise)),
    "one restless filter": wl.Ekf(wl.ConstantVelocity(noise=restless)),
    "IMM of three": wl.Imm(
        filters=[turning(rate) for rate in (0.0, 1.0, -1.0)],
        chain=wl.ModeChain.from_sojourn_s([120.0, 60.0, 60.0]),
    ),
    "mode histories": wl.ModeHistory(
        turning(0.0), np.deg2rad([-1.0, 0.0, 1.0]), straight_sojourn_s=120.0, turn_sojourn_s=60.0
    ),
}

true_state = truth.state_at(time_s)
errors = {}
print("                     position m  velocity m/s   NIS  us a step")
for name, estimator in estimators.items():
    began_s = time.perf_counter()
    result = estimator.run(z[:, 2:], dt_s=PERIOD_S, sensor=radar, start=starts)
    step_us = 1e6 * (time.perf_counter() - began_s) / result.nis.size
    off = (result.mean[..., :4] - true_state) ** 2
    errors[name] = np.sqrt(np.mean(off[..., 0] + off[..., 2], axis=0))
    position_m = np.sqrt(np.mean(off[..., 0] + off[..., 2]))
    velocity_mps = np.sqrt(np.mean(off[..., 1] + off[..., 3]))
    nis = np.nanmean(result.nis)
    print(f"{name:19}  {position_m:10.1f}  {velocity_mps:12.2f}  {nis:4.1f}  {step_us:9.2f}")

picture = wl.plot.figure(7.2, 3.6)
wl.plot.error_panel(picture.add_subplot(), time_s, errors, switch_s=[120.0, 210.0])
wl.plot.save(picture, "which_estimator.png")
