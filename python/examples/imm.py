"""Three turn rates in an interacting multiple model estimator, on simulated plots.

Prints RMS position errors, and writes imm.png: the path, and the probability of each turn rate.
"""

import numpy as np

import wakeline as wl

radar = wl.RangeBearing(range_std_m=60.0, bearing_std_rad=np.deg2rad(0.5))
noise = wl.WhiteAcceleration(psd_m2s3=0.01)
imm = wl.Imm(
    filters=[
        wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate), noise=noise))
        for rate in (0.0, 1.0, -1.0)
    ],
    chain=wl.ModeChain.from_sojourn_s([60.0, 30.0, 30.0]),
)

straight, turn = wl.scenario.Segment(90.0), wl.scenario.Segment(90.0, np.deg2rad(1))
truth = wl.scenario.Truth([4000.0, 6.0, 3000.0, -8.0], [straight, turn])
simulator = wl.scenario.RadarSimulator(60.0, np.deg2rad(0.5), period_s=3.0)
time_s, z = simulator.observe(truth, scans=60, rng=1)

start = wl.two_point(radar, z[0], z[1], dt_s=3.0)
result = imm.run(z[2:], dt_s=3.0, sensor=radar, start=start)

true_state = truth.state_at(time_s[2:])
plots_m = z[2:, :1] * np.column_stack([np.cos(z[2:, 1]), np.sin(z[2:, 1])])
for name, position_m in (("plots", plots_m), ("IMM", result.mean[:, ::2])):
    error_m = np.sqrt(np.mean(np.sum((position_m - true_state[:, ::2]) ** 2, axis=1)))
    print(f"{name:5}  {error_m:5.1f} m")
print(f"probability of the turn to starboard: {result.mode_probability[-1, 1]:.2f}")

picture = wl.plot.figure(7.2, 6.4)
above, below = picture.subplots(2, 1, height_ratios=[3, 1])
wl.plot.paths_view(above, true_state, {"IMM": result.mean}, plots_m=plots_m, radar=False)
rates_rad_s = np.deg2rad([0.0, 1.0, -1.0])
wl.plot.probability_panel(below, time_s[2:], result.mode_probability, rates_rad_s, switch_s=[90.0])
wl.plot.save(picture, "imm.png")
