"""Uses in Python what was added to the library: a motion model, a sensor and a setting."""

import copy
import pickle

import numpy as np
import pytest

import wakeline as wl

model = wl.DampedVelocity(decay_time_s=10.0)
sensor = wl.NorthEast(north_std_m=1.0, east_std_m=1000.0)
assert "s" in {field.unit for field in model.fields()}
assert "1/e" in type(model).decay_time_s.__doc__
assert pickle.loads(pickle.dumps(model)) == copy.deepcopy(model) == model
assert model != wl.DampedVelocity()

start = wl.Gaussian([0.0, 10.0, 0.0, 0.0], np.eye(4))
z = np.random.default_rng(1).normal(size=(3, 20, 2))
for filter_of in (wl.Kalman, wl.Ekf, wl.Ukf, wl.SquareRootUkf):
    result = filter_of(model).run(z, dt_s=1.0, sensor=sensor, start=start)
    assert (np.asarray(result.status) == 0).all(), filter_of
    assert result.lanes >= 1
filters = [wl.Ekf(model), wl.Ekf(wl.ConstantVelocity()), wl.Ukf(wl.Singer())]
imm = wl.Imm(filters, wl.ModeChain(np.full((3, 3), 1 / 3)))
assert np.isfinite(imm.run(z, dt_s=1.0, sensor=sensor, start=start).mean).all()

assert wl.TrackerConfig().added_margin_m == 2.0
assert "margin" in wl.TrackerConfig.added_margin_m.__doc__
assert pickle.loads(pickle.dumps(wl.TrackerConfig(added_margin_m=3.0))).added_margin_m == 3.0
assert "added_margin_m" in wl.tracking.Settings.default().toml()
with pytest.raises(ValueError, match="added_margin_m"):
    wl.TrackerConfig(added_margin_m=-1.0)
print("a motion model, a sensor and a setting were added and used")
