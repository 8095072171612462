"""Settings of a radar from plots alone, and what they are worth.

The search begins with the defaults of any radar and does not see the truth; the score does.
"""

import wakeline as wl

recording = wl.recording.load("joyride")
tuned = wl.tune(recording, radar=wl.Radar())

print("setting                   given     found       +-  determined")
for found in tuned.parameters:
    determined = "yes" if found.determined else "no"
    figures = f"{found.before:8.3f}  {found.value:8.3f}  {found.std:7.3f}"
    print(f"{found.name:22} {figures}  {determined:>10}")

print("\nsettings     coverage  position m  velocity m/s")
for name, settings in (("default", {"radar": wl.Radar()}), ("tuned", {"config": tuned.settings})):
    score = wl.metrics.score(wl.track_recording(recording, **settings), recording).overall
    position_m = score.errors.position_rmse_debiased_m
    velocity_mps = score.errors.velocity_rmse_mps
    print(f"{name:11}  {100 * score.coverage:6.1f} %  {position_m:10.1f}  {velocity_mps:12.2f}")
