"""A custom motion model and sensor: a ferry that has stopped its engines.

The water slows it in proportion to its speed; radar reports where it is, and every tenth second its
AIS a speed. The drag is a fifth state. Prints where the ferry will rest, and writes own_model.png.
"""

import numpy as np

import wakeline as wl


def coast(x, dt_s):
    """v' = e^(-k dt) v, x' = x + v (1 - e^(-k dt)) / k, with the drag k in 1/s."""
    keeps = np.exp(-x[4] * dt_s)
    glides_s = (1.0 - keeps) / x[4] if x[4] else dt_s
    return [x[0] + glides_s * x[1], keeps * x[1], x[2] + glides_s * x[3], keeps * x[3], x[4]]


def gusts(_, dt_s):
    """White acceleration, and a drag that hardly changes."""
    q = np.diag([0.0, 0.0, 0.0, 0.0, 1e-10 * dt_s])
    q[:2, :2] = q[2:4, 2:4] = 1e-4 * np.array([[dt_s**3 / 3, dt_s**2 / 2], [dt_s**2 / 2, dt_s]])
    return q


def speed(velocity):
    """Over ground, of [vx, vy]."""
    return [np.hypot(*velocity)]


state = ["x", "vx", "y", "vy", "drag"]
ferry = wl.FunctionMotion(coast, gusts, state=state, prior_std={"drag": 0.02})
ais = wl.FunctionSensor(speed, covariance=[[0.1**2]], reads=["vx", "vy"])
radar = wl.RangeBearing(range_std_m=10.0, bearing_std_rad=np.deg2rad(0.2))
plot_std, random = [radar.range_std_m, radar.bearing_std_rad], np.random.default_rng(1)

truth = np.array([1500.0, -6.0, -800.0, 5.0, 0.02])
ukf = wl.Ukf(ferry)
ukf.start(wl.one_point(radar, random.normal(radar.measure(truth[[0, 2]]), plot_std), 5.0))
rows = []
for scan in range(1, 33):
    truth = ferry.transition(truth, 2.5)
    plot = random.normal(radar.measure(truth[[0, 2]]), plot_std)
    ukf.predict(2.5)
    ukf.update(radar, plot)
    if scan % 4 == 0:
        ukf.update(ais, random.normal(speed(truth[[1, 3]]), 0.1))
    mean, drag_std = ukf.estimate().mean, np.sqrt(ukf.estimate().covariance[4, 4])
    rows.append([2.5 * scan, *truth[:4], *radar.position(plot).mean, *mean, drag_std])

time_s, states, plots_m, estimates = np.hsplit(np.array(rows), [1, 5, 7])
drag, drag_std = estimates[:, 4], estimates[:, 5]
for k in range(7, 32, 8):
    rest_m = np.hypot(*estimates[k, [1, 3]]) / drag[k]
    print(f"{time_s[k, 0]:4.0f} s  drag {drag[k]:.4f} ± {drag_std[k]:.4f} /s  {rest_m:4.0f} m left")

picture = wl.plot.figure(7.2, 7.0)
above, below = picture.subplots(2, 1, height_ratios=[2, 1])
wl.plot.paths_view(above, states, {"Ukf": estimates[:, :4]}, plots_m=plots_m, radar=False)
below.fill_between(time_s[:, 0], drag - 2 * drag_std, drag + 2 * drag_std, alpha=0.2, linewidth=0)
below.plot(time_s, drag)
below.set(xlabel="time (s)", ylabel="drag (1/s), ± 2 standard deviations", ylim=(0.0, 0.05))
wl.plot.dress(below)
wl.plot.save(picture, "own_model.png")
