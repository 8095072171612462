// Figures for people: distances, speeds, angles and times, each with its unit.

export const NAUTICAL_MILE_M = 1852;
export const KNOT_MPS = 1852 / 3600;
export const TURN = 2 * Math.PI;
const NONE = "–";

export const RANGES_M = {
  nautical: [0.125, 0.25, 0.5, 0.75, 1.5, 3, 6, 12, 24, 48, 96].map((miles) => miles * NAUTICAL_MILE_M),
  metric: [100, 250, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000, 200000],
};

const known = (value) => value !== null && value !== undefined && Number.isFinite(value);

export function distance(value_m, units) {
  if (!known(value_m)) return NONE;
  if (units === "nautical") {
    const miles = value_m / NAUTICAL_MILE_M;
    return `${miles.toFixed(miles < 10 ? 2 : 1)} NM`;
  }
  return value_m < 9995 ? `${value_m.toFixed(0)} m` : `${(value_m / 1000).toFixed(1)} km`;
}

/** A range of the picture or a ring: no more digits than it has. */
export function rangeName(value_m, units) {
  if (units === "nautical") return `${+(value_m / NAUTICAL_MILE_M).toFixed(4)} NM`;
  return value_m < 1000 ? `${+value_m.toFixed(1)} m` : `${+(value_m / 1000).toFixed(3)} km`;
}

export function speed(value_mps, units) {
  if (!known(value_mps)) return NONE;
  return units === "nautical" ? `${(value_mps / KNOT_MPS).toFixed(1)} kn` : `${value_mps.toFixed(1)} m/s`;
}

export function angle(value_rad) {
  if (!known(value_rad)) return NONE;
  const degrees = Math.round((((value_rad % TURN) + TURN) % TURN) * 1800 / Math.PI) / 10 % 360;
  return `${degrees.toFixed(1).padStart(5, "0")}°`;
}

export function shortAngle(value_rad) {
  if (!known(value_rad)) return NONE;
  const degrees = Math.round((((value_rad % TURN) + TURN) % TURN) * 180 / Math.PI) % 360;
  return `${String(degrees).padStart(3, "0")}°`;
}

export function minutes(value_s) {
  if (!known(value_s)) return NONE;
  const sign = value_s < 0 ? "−" : "";
  const all = Math.round(Math.abs(value_s));
  if (all >= 5999) return `${sign}${(all / 3600).toFixed(all < 35999 ? 1 : 0)} h`;
  return `${sign}${Math.floor(all / 60)}:${String(all % 60).padStart(2, "0")}`;
}

export function percent(probability) {
  if (!known(probability)) return NONE;
  if (probability > 0 && probability < 0.01) return "<1 %";
  return `${Math.round(100 * probability)} %`;
}

export function latitude(value_deg) {
  return half(value_deg, 2, value_deg < 0 ? "S" : "N");
}

export function longitude(value_deg) {
  return half(value_deg, 3, value_deg < 0 ? "W" : "E");
}

function half(value_deg, digits, side) {
  const whole = Math.round(Math.abs(value_deg) * 60000);
  const degrees = Math.floor(whole / 60000);
  const rest = (whole - degrees * 60000) / 1000;
  return `${String(degrees).padStart(digits, "0")}°${rest.toFixed(3).padStart(6, "0")}′ ${side}`;
}

export function clock(time_s) {
  if (time_s > 1e8 && time_s < 1e10) return `${new Date(time_s * 1000).toISOString().slice(11, 19)} UTC`;
  return minutes(time_s);
}

/** Latitude and longitude of a place near an origin, on a sphere with the radii of WGS 84 there. */
export function degreesAt(origin_deg, north_m, east_m) {
  if (!origin_deg) return null;
  const sin = Math.sin((origin_deg[0] * Math.PI) / 180);
  const w = 1 - 6.69437999014e-3 * sin * sin;
  const meridian_m = (6378137 * (1 - 6.69437999014e-3)) / w ** 1.5;
  const latitude_deg = origin_deg[0] + (north_m / meridian_m) * (180 / Math.PI);
  const parallel_m = (6378137 / Math.sqrt(w)) * Math.cos((latitude_deg * Math.PI) / 180);
  return [latitude_deg, origin_deg[1] + (east_m / parallel_m) * (180 / Math.PI)];
}
