// Colors of the picture by day, dusk and night. Those of the panel are in style.css.

const ramp = (...stops) => {
  const levels = [];
  for (let k = 0; k < 16; k += 1) {
    const at = (k / 15) * (stops.length - 1);
    const i = Math.min(Math.floor(at), stops.length - 2);
    const share = at - i;
    levels.push(stops[i].map((v, c) => v + share * (stops[i + 1][c] - v)));
  }
  return levels;
};

export const PALETTES = {
  day: {
    background: "#0d2c44", beyond: "#0a2437", ink: "#f2f7fa", muted: "#a9c3d1", ring: "#3f6781",
    own: "#ffffff", target: "#8df0ff", danger: "#ff6b6b", lost: "#ffb454", ais: "#9cf59a",
    selected: "#fff27a", vector: "#8df0ff", past: "#8df0ff", plot: "#ffe9a8", zone: "#ff9ad5",
    exclusion: "#c3b1ff", land: "#d9c48a", measure: "#ffffff", label: "#e6f7ff", halo: "#0d2c44",
    echoes: ramp([20, 60, 84], [38, 128, 120], [104, 196, 96], [240, 206, 84], [255, 236, 170]),
    trail: [86, 142, 190],
  },
  dusk: {
    background: "#06141f", beyond: "#040e16", ink: "#d5e2ea", muted: "#8ea7b5", ring: "#274859",
    own: "#e8f0f4", target: "#6fd3e6", danger: "#ff6a64", lost: "#e89b3c", ais: "#7bd67d",
    selected: "#e9d75c", vector: "#6fd3e6", past: "#6fd3e6", plot: "#d9c07a", zone: "#e07fb8",
    exclusion: "#a795e6", land: "#b09c66", measure: "#d5e2ea", label: "#cfe3ec", halo: "#06141f",
    echoes: ramp([10, 40, 52], [22, 92, 88], [70, 150, 70], [200, 164, 58], [236, 208, 128]),
    trail: [56, 102, 140],
  },
  night: {
    background: "#000000", beyond: "#000000", ink: "#c9846f", muted: "#b07a66", ring: "#3a231c",
    own: "#d08a72", target: "#c98d3a", danger: "#ff4a3d", lost: "#b8762a", ais: "#7f9a45",
    selected: "#d8a63e", vector: "#c98d3a", past: "#c98d3a", plot: "#97743a", zone: "#b0608a",
    exclusion: "#8672b8", land: "#806a3a", measure: "#c9846f", label: "#c9906f", halo: "#000000",
    echoes: ramp([22, 8, 4], [58, 22, 10], [96, 42, 16], [136, 70, 24], [176, 104, 40]),
    trail: [44, 38, 52],
  },
};
