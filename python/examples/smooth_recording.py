"""A recorded target, filtered and then smoothed: each state also uses the plots after it.

Writes smooth_recording.png, the position error over time.
"""

import numpy as np

import wakeline as wl

PERIOD_S = 3.0
radar = wl.RangeBearing(range_std_m=60.0, bearing_std_rad=np.deg2rad(0.5))
truth = wl.scenario.Truth([4000.0, 6.0, 3000.0, -8.0])
simulator = wl.scenario.RadarSimulator(60.0, np.deg2rad(0.5), period_s=PERIOD_S)
time_s, z = simulator.observe(truth, scans=80, rng=1)

ekf = wl.Ekf(wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=0.01)))
start = wl.two_point(radar, z[0], z[1], dt_s=PERIOD_S)
filtered = ekf.run(z[2:], dt_s=PERIOD_S, sensor=radar, start=start)
smoothed_mean, smoothed_covariance = ekf.smooth(filtered.mean, filtered.covariance, PERIOD_S)

true_state = truth.state_at(time_s[2:])
errors = {}
print("          position m  velocity m/s")
for name, mean in (("filtered", filtered.mean), ("smoothed", smoothed_mean)):
    error = mean - true_state
    errors[name] = np.hypot(error[:, 0], error[:, 2])
    position_m = np.sqrt(np.mean(errors[name] ** 2))
    velocity_mps = np.sqrt(np.mean(error[:, 1] ** 2 + error[:, 3] ** 2))
    print(f"{name}  {position_m:10.1f}  {velocity_mps:12.2f}")

picture = wl.plot.figure(7.2, 3.2)
wl.plot.error_panel(picture.add_subplot(), time_s[2:], errors, ylabel="position error (m)")
wl.plot.save(picture, "smooth_recording.png")
