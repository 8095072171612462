"""A recording to a picture: plots in, numbered tracks out, as tracked and smoothed.

Writes first_tracks.png. For another recording, give its file instead of the name: "plots.csv".
"""

import wakeline as wl

recording = wl.recording.load("joyride")
print(recording)
tracks = wl.track_recording(recording)

print("          coverage  position m  velocity m/s  course deg")
for name, these in (("tracked", tracks), ("smoothed", tracks.smooth())):
    score = wl.metrics.score(these, recording).overall
    errors = score.errors
    print(
        f"{name:8}  {100 * score.coverage:6.1f} %  {errors.position_rmse_debiased_m:10.1f}"
        f"  {errors.velocity_rmse_mps:12.2f}  {errors.course_rms_deg:10.1f}"
    )
wl.plot.save(tracks.plot(), "first_tracks.png")
