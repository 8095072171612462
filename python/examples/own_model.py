"""Your own motion models: how the tracker follows a boat that turns hard.

In C++ a motion model and a sensor are structs of your own (cpp/examples/own_model.cpp). In Python
they are the engine's, with your parameters: here a tracker whose vessels turn seldom, beside one
whose vessels turn often and fast.
"""

import wakeline as wl

recording = wl.recording.load("joyride")
models = {
    "merchant ships": wl.VesselModels.ships(),
    "default": wl.VesselModels(),
    "agile boats": wl.VesselModels(turn_rate_psd_rad2s3=0.01, turning_sojourn_s=60.0),
}
print("motion models     position m  velocity m/s")
for name, vessels in models.items():
    tracks = wl.track_recording(recording, vessels=vessels)
    errors = wl.metrics.score(tracks, recording).overall.errors
    print(f"{name:16}  {errors.position_rmse_m:10.1f}  {errors.velocity_rmse_mps:12.2f}")
