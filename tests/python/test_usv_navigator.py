"""Own ship's navigator on logs of IMU, GNSS, compass and log."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import wakeline as wl
from wakeline.navigation import UsvNavigator

DEG = np.pi / 180
BIAS = np.array([0.03, 0.02, 0.28 * DEG])


def voyage(seed=1, steps=600, bias=BIAS, current=(0.0, 0.5)):
    """1 m/s through water, a turn of 5 deg/s every 100 s; sensors as the navigator expects them."""
    rng = np.random.default_rng(seed)
    rate = np.where(np.arange(steps) % 100 < 12, 5 * DEG, 0.0)
    rate[0] = 0.0
    heading = 2.0 + np.cumsum(rate)
    velocity = np.stack([np.cos(heading), np.sin(heading)], 1) + current
    middle = (velocity[1:] + velocity[:-1]) / 2
    position = np.vstack([[0.0, 0.0], np.cumsum(middle, 0)])
    change = np.diff(velocity, axis=0)
    turned = (heading[1:] + heading[:-1]) / 2
    c, s = np.cos(turned), np.sin(turned)
    body = np.stack([c * change[:, 0] + s * change[:, 1], -s * change[:, 0] + c * change[:, 1]], 1)
    imu = np.column_stack([np.vstack([[0, 0], body]), rate]) + bias
    imu += rng.normal(size=(steps, 3)) * [0.004, 0.004, 0.033 * DEG]
    return {
        "time_s": np.arange(steps, dtype=float),
        "position": position,
        "velocity": velocity,
        "heading": heading,
        "imu": imu,
        "gnss": position + rng.normal(size=(steps, 2)) * [8, 7],
        "compass": (heading + rng.normal(size=steps) * DEG) % (2 * np.pi),
    }


def started(log, states=8, filter="ekf", **options):
    navigator = UsvNavigator(states, filter, **options)
    heading = log["heading"][0]
    navigator.start([0.0, 0.0], [np.cos(heading), np.sin(heading)], heading)
    return navigator


def sensors(log):
    return {name: log[name] for name in ("time_s", "imu", "gnss", "compass")}


def wrapped(angle_rad):
    return (np.asarray(angle_rad) + np.pi) % (2 * np.pi) - np.pi


@pytest.mark.parametrize("filter", ["ekf", "ukf", "augmented_ukf"])
@pytest.mark.parametrize("states", [5, 7, 8])
def test_a_run_is_its_steps(states, filter):
    log = voyage(steps=50, bias=0 * BIAS)
    run = started(log, states, filter).run(**sensors(log))
    navigator = started(log, states, filter)
    for k in range(50):
        if k > 0:
            navigator.predict(1.0, log["imu"][k])
        fixed = navigator.update_position(log["gnss"][k])
        turned = navigator.update_heading(log["compass"][k])
        assert fixed.nis == run.nis["gnss"][k]
        assert turned.rejected == run.rejected["compass"][k]
        np.testing.assert_array_equal(navigator.estimate.mean, run.mean[k])
        np.testing.assert_array_equal(navigator.estimate.covariance, run.covariance[k])
    assert run.mean.shape == (50, states)


@pytest.mark.parametrize("filter", ["ekf", "ukf", "augmented_ukf"])
def test_smoothing_helps_where_the_heading_is_hardly_known(filter):
    off_m = np.zeros(2)
    for seed in range(4):
        log = voyage(seed)
        readings = sensors(log) | {"compass": None}
        for k, smooth in enumerate((False, True)):
            run = started(log, filter=filter).run(**readings, smooth=smooth)
            off_m[k] += np.hypot(*(run.mean[:, :2] - log["position"]).T).mean()
    assert off_m[1] < 0.7 * off_m[0]


def test_biases_are_found_and_smoothing_helps():
    log = voyage()
    run = started(log).run(**sensors(log))
    np.testing.assert_allclose(run.mean[-1, 5:], BIAS, atol=0.006)
    smooth = started(log).run(**sensors(log), smooth=True)

    def error(result):
        return np.mean((result.mean[:, :2] - log["position"]) ** 2)

    assert error(run) < 0.15 * np.mean((log["gnss"] - log["position"]) ** 2)
    assert error(smooth) < 0.5 * error(run)
    np.testing.assert_array_equal(run.mean[-1], smooth.mean[-1])
    assert np.all(np.abs(wrapped(smooth.mean[:, 4] - log["heading"])) < 1 * DEG)


def test_a_vessel_that_keeps_turning_is_known_as_well_as_believed():
    """Rows of the IMU are means over a second in which the vessel turns by 5 degrees."""
    rng = np.random.default_rng(4)
    time_s, speed, rate = np.arange(301.0), 5.0, 5 * DEG
    heading = rate * time_s
    place = speed / rate * np.array([np.sin(heading), 1.0 - np.cos(heading)])
    velocity = speed * np.array([np.cos(heading), np.sin(heading)])
    truth = np.column_stack([*place, *velocity, heading, np.tile(BIAS, (301, 1))])
    noise = rng.normal(size=(301, 6)) * [0.004, 0.004, 0.033 * DEG, 8.0, 7.0, 1 * DEG]
    readings = {
        "imu": [0.0, speed * rate, rate] + BIAS + noise[:, :3],
        "gnss": truth[:, :2] + noise[:, 3:5],
        "compass": heading + noise[:, 5],
    }

    def nees(turned_at):
        navigator = UsvNavigator(turned_at=turned_at)
        navigator.start(truth[0, :2], truth[0, 2:4], 0.0)
        run = navigator.run(time_s, **readings)
        error = run.mean - truth
        error[:, 4] = wrapped(error[:, 4])
        return np.einsum("ti,tij,tj->t", error, np.linalg.inv(run.covariance), error)[50:].mean()

    assert 3.0 < nees(0.5) < 14.0
    assert nees(0.0) > 50.0


@pytest.mark.parametrize("turned_at", [-0.1, 1.5, np.nan])
def test_a_heading_outside_the_step_is_rejected(turned_at):
    with pytest.raises(ValueError, match="turned_at must be 0 to 1, got"):
        UsvNavigator(turned_at=turned_at)


def test_smoothing_ends_where_the_belief_was_widened():
    log = voyage(steps=300)
    log["gnss"][150:] += [400.0, 0.0]
    run = started(log).run(**sensors(log))
    smooth = started(log).run(**sensors(log), smooth=True)
    (widened,) = np.flatnonzero(~run.rejected["gnss"] & (run.nis["gnss"] > 100.0))
    cut = {name: log[name][:widened] for name in sensors(log)}
    alone = started(log).run(**cut, smooth=True)
    np.testing.assert_array_equal(smooth.mean[:widened], alone.mean)
    np.testing.assert_array_equal(smooth.covariance[:widened], alone.covariance)
    assert np.all(np.abs(smooth.mean[:widened, 0] - log["position"][:widened, 0]) < 15.0)
    assert np.all(smooth.mean[widened:, 0] - log["position"][widened:, 0] > 370.0)
    variance, filtered = (np.diagonal(r.covariance, axis1=1, axis2=2) for r in (smooth, run))
    assert np.all(variance <= filtered * (1.0 + 1e-9))


def unscented(mean, covariance, function, alpha, beta):
    """(13)-(18), kappa 0: mean and covariance of a function of what is known by these."""
    n = len(mean)
    root = np.linalg.cholesky(alpha**2 * n * covariance).T
    points = np.array([function(x) for x in (mean, *(mean + root), *(mean - root))])
    weights = np.full(2 * n + 1, 1 / (2 * alpha**2 * n))
    weights[0] = 1 - 1 / alpha**2
    average = weights @ points
    weights[0] += 1 - alpha**2 + beta
    off = points - average
    return average, (weights[:, None] * off).T @ off


def by_the_paper(log, alpha, beta):
    """(1)-(25): five states, accelerations turned by the heading at the start of a step."""
    heading = log["heading"][0]
    mean = np.array([0.0, 0.0, np.cos(heading), np.sin(heading), heading])
    covariance = np.diag([8.0, 7.0, 0.5, 0.5, DEG]) ** 2
    means, covariances = [], []
    steps = np.diff(log["time_s"], prepend=log["time_s"][0])
    for dt, imu, gnss, compass in zip(steps, log["imu"], log["gnss"], log["compass"], strict=True):
        g = np.vstack([dt**2 / 2 * np.eye(2), dt * np.eye(2)])

        def moved(x, dt=dt, imu=imu, g=g):
            c, s = np.cos(x[4]), np.sin(x[4])
            push = g @ [c * imu[0] - s * imu[1], s * imu[0] + c * imu[1]]
            return x + [*push, dt * imu[2]] + dt * np.array([x[2], x[3], 0, 0, 0])

        mean, covariance = unscented(mean, covariance, moved, alpha, beta)
        covariance[:4, :4] += 0.004**2 * g @ g.T
        covariance[4, 4] += (0.033 * DEG * dt) ** 2
        for z, rows, std in ((gnss, [0, 1], [8, 7]), ([compass], [4], [DEG])):
            if np.isnan(z[0]):
                continue
            off = z - mean[rows]
            if rows == [4]:
                off = (off + np.pi) % (2 * np.pi) - np.pi
            s = covariance[np.ix_(rows, rows)] + np.diag(np.square(std))
            gain = covariance[:, rows] @ np.linalg.inv(s)
            mean, covariance = mean + gain @ off, covariance - gain @ s @ gain.T
        means.append(mean)
        covariances.append(covariance)
    return np.array(means), np.array(covariances)


def test_five_states_are_the_equations_of_the_paper():
    """At uneven steps, through silent sensors and headings that go round."""
    log = voyage(seed=3, bias=np.zeros(3))
    turns = np.abs(log["imu"][:, 2]) > DEG
    kept = turns | (np.arange(600) == 0) | (np.random.default_rng(3).random(600) < 0.7)
    log = {name: value[kept] for name, value in log.items()}
    log["gnss"][::3] = np.nan
    log["compass"][1::4] = np.nan
    navigator = started(
        log, 5, "ukf", turned_at=0.0, alpha=0.5, rejections=0, gate_probability=1 - 1e-12
    )
    run = navigator.run(**sensors(log))
    mean, covariance = by_the_paper(log, alpha=0.5, beta=2.0)
    mean[:, 4] = (mean[:, 4] + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(run.mean, mean, atol=1e-8)
    np.testing.assert_allclose(run.covariance, covariance, rtol=1e-7, atol=1e-9)


def test_filters_agree():
    log = voyage()
    ekf, *others = (
        started(log, 8, name).run(**sensors(log)) for name in ("ekf", "ukf", "augmented_ukf")
    )
    for other in others:
        assert np.max(np.abs(ekf.mean[:, :2] - other.mean[:, :2])) < 0.05


def test_augmented_noise_is_additive_noise_at_points_as_far_out():
    """Turned at the start the IMU's errors enter linearly, and widen the points like kappa = 3."""
    log, start = voyage(steps=200), {"turned_at": 0.0}
    augmented = started(log, 8, "augmented_ukf", **start).run(**sensors(log))
    additive = started(log, 8, "ukf", kappa=3.0, **start).run(**sensors(log))
    plain = started(log, 8, "ukf", **start).run(**sensors(log))
    np.testing.assert_allclose(augmented.mean, additive.mean, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(augmented.covariance, additive.covariance, rtol=1e-8, atol=1e-12)
    assert np.any(augmented.mean != plain.mean)


def test_an_outage_grows_the_covariance_and_nothing_is_rejected_after_it():
    log = voyage(steps=400)
    out = slice(200, 260)
    log["gnss"][out] = np.nan
    run = started(log).run(**sensors(log))
    assert np.all(np.diff(run.covariance[out, 0, 0]) > 0)
    assert np.isnan(run.nis["gnss"][out]).all()
    assert np.isfinite(run.nis["compass"]).all()
    assert run.rejected["gnss"].sum() <= 2
    assert run.covariance[320, 0, 0] < 1.2 * run.covariance[199, 0, 0]


def test_an_outlier_is_rejected():
    log = voyage(steps=200)
    log["gnss"][150] += [300, 0]
    run = started(log).run(**sensors(log))
    assert run.rejected["gnss"][150]
    assert run.nis["gnss"][150] > 100
    assert np.abs(run.mean[150, 0] - log["position"][150, 0]) < 15


@pytest.mark.parametrize("filter", ["ekf", "ukf", "augmented_ukf"])
@pytest.mark.parametrize("states", [5, 7, 8])
@pytest.mark.parametrize("off_m", [1e12, 1e160, 1.7e308])
def test_absurd_fixes_are_rejected_and_nothing_else_is_lost(states, filter, off_m):
    absurd, lost = voyage(steps=200, bias=0 * BIAS), voyage(steps=200, bias=0 * BIAS)
    rows = [20, *range(100, 115)]
    absurd["gnss"][rows] = [off_m, -off_m]
    lost["gnss"][rows] = np.nan
    run = started(absurd, states, filter).run(**sensors(absurd))
    without = started(lost, states, filter).run(**sensors(lost))
    assert run.rejected["gnss"][rows].all()
    assert np.all(run.nis["gnss"][rows] > 1e9)
    np.testing.assert_array_equal(run.mean, without.mean)
    np.testing.assert_array_equal(run.covariance, without.covariance)


def test_headings_of_more_turns_than_a_number_can_report_are_rejected():
    absurd, lost = voyage(steps=200), voyage(steps=200)
    rows = [20, *range(100, 115)]
    absurd["compass"][rows], lost["compass"][rows] = 1e30, np.nan
    run, without = (started(log).run(**sensors(log)) for log in (absurd, lost))
    assert run.rejected["compass"][rows].all()
    np.testing.assert_array_equal(run.mean, without.mean)


def test_steps_without_the_imu_coast():
    log = voyage(steps=300)
    log["imu"][100:130] = np.nan
    run = started(log).run(**sensors(log))
    assert np.isfinite(run.mean).all()
    assert run.covariance[125, 2, 2] > 2 * run.covariance[99, 2, 2]


@pytest.mark.parametrize("filter", ["ekf", "ukf", "augmented_ukf"])
@pytest.mark.parametrize("states", [5, 7, 8])
def test_the_noise_of_each_step_may_be_given(states, filter):
    log = voyage(steps=100)
    log["imu"][40:60] = np.nan
    plain = started(log, states, filter).run(**sensors(log))
    std = np.full((100, 2), np.nan)
    std[:40] = std[60:] = 0.004, 0.033 * DEG
    reported = started(log, states, filter).run(**sensors(log), imu_std=std)
    np.testing.assert_array_equal(reported.mean, plain.mean)
    np.testing.assert_array_equal(reported.covariance, plain.covariance)
    std[45:55] = 0.3, 5 * DEG
    more = started(log, states, filter).run(**sensors(log), imu_std=std)
    np.testing.assert_array_equal(more.covariance[:45], plain.covariance[:45])
    heading = 2 if states == 7 else 4
    assert more.covariance[54, heading, heading] > 1.1 * plain.covariance[54, heading, heading]


@pytest.mark.parametrize("states", [5, 7])
def test_noise_of_more_in_shorter_steps_grows_the_same_in_any_steps(states):
    stds = []
    for steps in (60, 240, 1200):
        dt_s = 60 / steps
        std = np.full((steps + 1, 2), [0.2, 2 * DEG]) / np.sqrt(dt_s)
        navigator = UsvNavigator(states)
        navigator.start([0.0, 0.0], [5.0, 0.0], 0.0)
        run = navigator.run(dt_s * np.arange(steps + 1), imu_std=std)
        stds.append(np.sqrt(np.diagonal(run.covariance[-1])))
    np.testing.assert_allclose(stds[1:], [stds[0], stds[0]], rtol=1e-3)


def test_log_velocity_and_rate_of_turn():
    log = voyage(steps=200)
    rate = log["imu"][:, 2] - BIAS[2]
    run = started(log, 7).run(
        **sensors(log), velocity=log["velocity"], log=np.ones(200), rate_of_turn=rate
    )
    assert set(run.nis) == {"gnss", "compass", "velocity", "log", "rate_of_turn"}
    np.testing.assert_allclose(run.mean[-1, 5:], [0, 0.5], atol=0.05)
    np.testing.assert_allclose(run.mean[-1, 4], BIAS[2], atol=0.03 * DEG)


@pytest.mark.parametrize("states", [7, 8])
def test_beside_a_rate_of_turn_the_gyro_has_the_noise_that_is_reported(states):
    log = voyage(steps=200)
    log["imu"][:, 2] += np.random.default_rng(3).normal(size=200) * DEG
    log["rate_of_turn"] = log["imu"][:, 2] - BIAS[2]
    readings = {name: log[name] for name in (*sensors(log), "rate_of_turn")}
    plain = started(log, states, yaw_rate_std_rad_s=DEG).run(**readings)
    reported = started(log, states).run(**readings, imu_std=np.full((200, 2), [0.004, DEG]))
    np.testing.assert_array_equal(reported.mean, plain.mean)
    np.testing.assert_array_equal(reported.covariance, plain.covariance)


@pytest.mark.parametrize("states", [7, 8])
def test_smoothing_goes_by_rates_of_turn_as_well(states):
    at = 2 if states == 7 else 4
    squared = {False: 0.0, True: 0.0}
    for seed in range(10):
        log, rng = voyage(seed, steps=200), np.random.default_rng(seed)
        rate = np.diff(log["heading"], prepend=log["heading"][0]) + 0.1 * DEG * rng.normal(size=200)
        log["imu"][:, 2] += rng.normal(size=200) * DEG
        log["compass"][np.arange(200) % 7 > 0] = np.nan
        for smooth in squared:
            navigator = started(log, states, yaw_rate_std_rad_s=DEG)
            run = navigator.run(**sensors(log), rate_of_turn=rate, smooth=smooth)
            off = wrapped(run.mean[1:-1, at] - log["heading"][1:-1])
            squared[smooth] += np.sum(off**2)
    assert squared[True] < 0.8 * squared[False]


def test_errors_name_what_is_wrong():
    log = voyage(steps=20)
    with pytest.raises(ValueError, match="states must be 5, 7 or 8, got 6"):
        UsvNavigator(6)
    with pytest.raises(ValueError, match=r"filter must be 'ekf', .* got 'kf'"):
        UsvNavigator(8, "kf")
    with pytest.raises(ValueError, match=r"gate\.probability must be above 0 and below 1, got 2"):
        UsvNavigator(gate_probability=2)
    with pytest.raises(wl.FilterError, match="not started"):
        UsvNavigator().run(**sensors(log))
    assert not UsvNavigator().started
    with pytest.raises(wl.FilterError, match="estimate: not started"):
        UsvNavigator().estimate  # noqa: B018
    navigator = started(log)
    with pytest.raises(ValueError, match=r"imu must have shape \(20, 3\), got \(19, 3\)"):
        navigator.run(log["time_s"], log["imu"][1:])
    with pytest.raises(ValueError, match=r"imu_std must have shape \(20, 2\), got \(20, 3\)"):
        navigator.run(**sensors(log), imu_std=log["imu"])
    with pytest.raises(ValueError, match="yaw_rate_std_rad_s must be 0 to 1000"):
        navigator.run(**sensors(log), imu_std=np.full((20, 2), [0.1, -0.1]))
    with pytest.raises(ValueError, match=r"time_s must be finite and not decrease.*row 1"):
        navigator.run(log["time_s"][::-1], log["imu"])
    with pytest.raises(ValueError, match="log needs a navigator with a speed through water"):
        navigator.run(log["time_s"], log=np.ones(20))
    with pytest.raises(ValueError, match="a rate of turn needs a navigator with a gyro bias"):
        started(log, 5).update_rate_of_turn(0.0, 0.0)
    with pytest.raises(ValueError, match="rate_of_turn must be given together with imu"):
        navigator.run(log["time_s"], rate_of_turn=np.zeros(20))
    with pytest.raises(ValueError, match="compass_std_rad must be finite and positive, got 0"):
        navigator.run(log["time_s"], compass_std_rad=0)
    with pytest.raises(wl.FilterError, match="predict: negative time step"):
        navigator.predict(-1.0)
    with pytest.raises(wl.FilterError, match="predict: not finite"):
        navigator.predict(1.0, [np.nan, 0, 0])
    with pytest.raises(ValueError, match="heading_std_rad must be"):
        navigator.update_heading(0.0, 0.0)


def test_a_run_that_fails_names_the_row_and_leaves_the_navigator_as_it_was():
    log = voyage(steps=20)
    navigator = started(log)
    before = navigator.estimate
    imu = log["imu"].copy()
    imu[7] = 1e200
    with pytest.raises(wl.FilterError, match="predict in row 7: not finite"):
        navigator.run(log["time_s"], imu)
    np.testing.assert_array_equal(navigator.estimate.mean, before.mean)
    np.testing.assert_array_equal(navigator.estimate.covariance, before.covariance)


def test_runs_in_threads_are_runs_one_by_one():
    logs = [voyage(seed, steps=200) for seed in range(4)]

    def run(log):
        return started(log).run(**sensors(log), smooth=True).mean

    with ThreadPoolExecutor(2) as pool:
        for many, single in zip(pool.map(run, logs), map(run, logs), strict=True):
            np.testing.assert_array_equal(many, single)
