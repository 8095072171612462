"""Own ship from the log of its instruments (NMEA 0183), with and without satellites.

Writes own.csv, which wl.track_recording takes as `own`, and own_map.png.
"""

import wakeline as wl
from wakeline import own_ship

log = wl.recording.load_navigation(variation_deg=2.5)
voyage = own_ship.navigate_log(log)
for note in voyage.notes:
    print(f"note: {note}")

print("median error in m after a time without satellites")
for method, errors in voyage.hold_out().items():
    medians = ", ".join(f"{s:.0f} s: {m:.1f}" for s, m in own_ship.medians(errors).items())
    print(f"{method:18} {medians}")

own_ship.write_own("own.csv", [leg.track for leg in voyage.legs])
wl.plot.save(wl.plot.own_map_figure(voyage.legs[0]), "own_map.png")
