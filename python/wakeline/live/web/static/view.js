// Where the picture shows what: from metres north and east to pixels and back.
import { RANGES_M } from "./units.js";

const MARGIN_PX = 26;
const RESET_SHARE = 0.66; // of the radius, where own ship starts again in true motion

export class View {
  constructor() {
    this.width = this.height = 1;
    this.top = this.bottom = 0; // of it, covered by the bars
    this.range_m = RANGES_M.nautical[5];
    this.up = "north"; // or head, course
    this.motion = "relative"; // or true
    this.rotation = 0; // direction that is up, radians from north
    this.center = [0, 0]; // [north, east] in the middle of the picture
    this.offset = [0, 0]; // of own ship from the middle, in radii: right, down
    this.moored = null; // the center while the picture is fixed to the ground
  }

  resize(width, height, top, bottom) {
    Object.assign(this, { width, height, top, bottom });
  }

  get radius() {
    return Math.max(0.5 * Math.min(this.width, this.height - this.top - this.bottom) - MARGIN_PX, 20);
  }

  get middle() {
    return [this.width / 2, this.top + (this.height - this.top - this.bottom) / 2];
  }

  /** Pixels of a metre. */
  get scale() {
    return this.radius / this.range_m;
  }

  /** Follow own ship: {north, east, heading, course}, the angles null where unknown. */
  follow(own) {
    const wanted = this.up === "head" ? own.heading ?? own.course : this.up === "course" ? own.course : 0;
    this.rotation = wanted ?? 0;
    if (this.motion === "true") {
      if (!this.moored) this.moored = this.centered(own);
      this.center = this.moored;
      const [x, y] = this.toScreen(own.north, own.east);
      const [mx, my] = this.middle;
      if (Math.hypot(x - mx, y - my) > RESET_SHARE * this.radius && own.course !== null) {
        const [north, east] = [Math.cos(own.course), Math.sin(own.course)];
        this.moored = [own.north + 0.5 * this.range_m * north, own.east + 0.5 * this.range_m * east];
        this.center = this.moored;
      }
    } else {
      this.moored = null;
      this.center = this.centered(own);
    }
  }

  centered(own) {
    const [north, east] = this.turnedBack(-this.offset[0] * this.range_m, this.offset[1] * this.range_m);
    return [own.north + north, own.east + east];
  }

  /** Metres north and east of a vector to the right and up. */
  turnedBack(right, up) {
    const [cos, sin] = [Math.cos(this.rotation), Math.sin(this.rotation)];
    return [up * cos - right * sin, up * sin + right * cos];
  }

  /** The map of places to pixels: x = x0 + xn north + xe east, and y likewise. */
  get projection() {
    const [cos, sin] = [this.scale * Math.cos(this.rotation), this.scale * Math.sin(this.rotation)];
    const [mx, my] = this.middle;
    const [north, east] = this.center;
    return { x0: mx + north * sin - east * cos, xn: -sin, xe: cos, y0: my + north * cos + east * sin, yn: -cos, ye: -sin };
  }

  toScreen(north, east) {
    const { x0, xn, xe, y0, yn, ye } = this.projection;
    return [x0 + xn * north + xe * east, y0 + yn * north + ye * east];
  }

  toPlace(x, y) {
    const [mx, my] = this.middle;
    const [north, east] = this.turnedBack((x - mx) / this.scale, (my - y) / this.scale);
    return [this.center[0] + north, this.center[1] + east];
  }

  /** Direction on the screen, radians clockwise from up, of a bearing. */
  screenAngle(bearing) {
    return bearing - this.rotation;
  }

  /** Move the picture by pixels. */
  pan(dx, dy) {
    if (this.motion === "true" && this.moored) {
      const [north, east] = this.turnedBack(-dx / this.scale, dy / this.scale);
      this.moored = [this.moored[0] + north, this.moored[1] + east];
      return;
    }
    const r = this.radius;
    this.offset = [this.offset[0] + dx / r, this.offset[1] + dy / r];
  }

  /** Bring a place into the picture. */
  show(north, east) {
    const [x, y] = this.toScreen(north, east);
    const [mx, my] = this.middle;
    if (Math.max(Math.abs(x - mx), Math.abs(y - my)) > this.radius) this.pan(mx - x, my - y);
  }

  centerOwn() {
    this.offset = [0, 0];
    this.moored = null;
  }

  step(direction, units) {
    const steps = RANGES_M[units];
    const next = direction > 0 ? steps.find((s) => s > this.range_m * 1.001) : steps.findLast((s) => s < this.range_m * 0.999);
    if (next) this.range_m = next;
  }

  /** The smallest range that shows a distance. */
  fit(distance_m, units) {
    const steps = RANGES_M[units];
    this.range_m = steps.find((s) => s >= distance_m) ?? steps.at(-1);
  }

  /** Distance between range rings. */
  get ring_m() {
    return ringOf(this.range_m);
  }
}

function ringOf(range_m) {
  const shown = (step_m) => Math.abs(step_m - range_m) < 1e-6 * range_m;
  if (RANGES_M.metric.some(shown)) return range_m / 5;
  return range_m / (RANGES_M.nautical.slice(3).some(shown) ? 3 : 4); // thirds from 0.75 NM
}
