// Symbols over the echoes: those of IMO SN.1/Circ.243 as far as they apply, rings, zones, labels.
import { placeLabels } from "./labels.js";
import { acquiring } from "./store.js";
import { TURN, distance, minutes, percent, rangeName, shortAngle, angle, speed } from "./units.js";

const FONT = '12px system-ui, "Segoe UI", Roboto, sans-serif';
const SMALL = '11px system-ui, "Segoe UI", Roboto, sans-serif';
const LABELS_MS = 400;
const ELLIPSE_STDS = 2.4477; // 95 % of a position
const MOST_PAST_SHOWN = 12; // of a target, fewer where there are many targets
const LEAST_PAST_SHOWN = 4;
const MOST_DOTS = 4000;
const TARGET_PX = 6;
const DANGER_PX = 10;
const CIRCLE_PX = 8;
const TEXT_PX = 3; // about a text, for its halo
const MOST_TEXTS = 600;

export class Overlay {
  constructor(canvas, isSoftware) {
    this.canvas = canvas;
    this.kind = { willReadFrequently: isSoftware }; // drawn by the processor, not by an emulation
    this.isSoftware = isSoftware;
    this.texts = new Map();
    this.context = canvas.getContext("2d", this.kind);
    this.offsets = new Map();
    this.labels_ms = -Infinity;
    this.widths = new Map();
    this.vectors = new Map();
    this.circles = new Map();
    this.fastest_px = Infinity; // of all symbols, a second
    this.flashes = true;
  }

  draw(scene) {
    const { view, store, settings, palette, own, time_s } = scene;
    const c = this.context;
    const ratio = (this.ratio = this.canvas.width / view.width);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, view.width, view.height);
    c.lineCap = "butt";
    c.lineJoin = "round";
    this.scene = scene;
    const [x, y] = view.toScreen(own.north, own.east);
    this.own = { x, y };
    if (settings.show.rings) this.drawRings();
    this.drawZones();
    this.drawOwn();
    if (settings.show.plots) this.drawPlots();
    const targets = this.targets(time_s);
    if (settings.show.past) this.drawPast(targets);
    for (const one of targets) this.drawVector(one);
    this.strokeVectors();
    if (settings.show.uncertainty) this.drawEllipses(targets);
    for (const danger of store.dangers) this.drawEncounter(danger);
    for (const one of targets) this.drawTarget(one);
    for (const one of store.lost.values()) this.drawLost(one);
    const vessels = settings.show.ais ? this.drawAis(time_s) : [];
    this.drawMeasures();
    this.drawSketch();
    if (settings.show.labels) this.drawLabels(targets, vessels);
    this.drawCursor();
    this.shown = targets;
  }

  // Frame -------------------------------------------------------------------------------------------

  drawRings() {
    const { view, settings, palette } = this.scene;
    const c = this.context;
    const { x, y } = this.own;
    const ring = view.ring_m * view.scale;
    const reach = Math.hypot(Math.max(x, view.width - x), Math.max(y, view.height - y));
    for (let k = 1; k * ring <= reach && k <= 40; k += 1) {
      c.strokeStyle = palette.ring;
      c.lineWidth = 1;
      c.beginPath();
      c.arc(x, y, k * ring, 0, TURN);
      c.stroke();
      const name = rangeName(k * view.ring_m, settings.units);
      const [lx, ly] = [x + k * ring * Math.SQRT1_2, y + k * ring * Math.SQRT1_2];
      if (lx > 30 && lx < view.width - 30 && ly > view.top && ly < view.height - view.bottom) this.text(name, lx, ly, palette.muted);
    }
    const [mx, my] = view.middle;
    if (Math.hypot(x - mx, y - my) > 0.03 * view.radius) return;
    const edge = view.radius;
    c.beginPath();
    for (let k = 0; k < 72; k += 1) {
      const a = view.screenAngle((k * TURN) / 72);
      const long = k % 6 === 0 ? 9 : k % 2 === 0 ? 6 : 3;
      c.moveTo(x + edge * Math.sin(a), y - edge * Math.cos(a));
      c.lineTo(x + (edge + long) * Math.sin(a), y - (edge + long) * Math.cos(a));
    }
    c.strokeStyle = palette.muted;
    c.lineWidth = 1;
    c.stroke();
    for (let k = 0; k < 12; k += 1) {
      const a = view.screenAngle((k * TURN) / 12);
      this.text(shortAngle((k * TURN) / 12).slice(0, 3), x + (edge + 18) * Math.sin(a), y - (edge + 18) * Math.cos(a), palette.muted);
    }
  }

  text(text, x, y, color, { font = SMALL, align = "center" } = {}) {
    if (!this.isSoftware) {
      this.write(this.context, text, x, y, color, font, align);
      return;
    }
    const made = this.written(text, color, font);
    const [width, height] = [made.width / this.ratio, made.height / this.ratio];
    const left = align === "left" ? x - TEXT_PX : x - width / 2;
    this.copy(made, left, y - height / 2);
  }

  /** Copies a picture to whole pixels, so that nothing is mixed. */
  copy(made, x, y) {
    const { ratio } = this;
    this.context.drawImage(made, Math.round(x * ratio) / ratio, Math.round(y * ratio) / ratio, made.width / ratio, made.height / ratio);
  }

  write(c, text, x, y, color, font, align) {
    c.font = font;
    c.textAlign = align;
    c.textBaseline = "middle";
    c.lineWidth = 3;
    c.strokeStyle = this.scene.palette.halo;
    c.strokeText(text, x, y);
    c.fillStyle = color;
    c.fillText(text, x, y);
  }

  /** A text as a picture, for a processor that copies faster than it draws. */
  written(text, color, font) {
    const key = `${text}\n${color} ${font} ${this.ratio}`;
    let made = this.texts.get(key);
    if (!made) {
      if (this.texts.size >= MOST_TEXTS) this.texts.clear();
      this.context.font = font;
      const width = this.context.measureText(text).width + 2 * TEXT_PX;
      made = this.picture(width, 18, (c) => this.write(c, text, TEXT_PX, 9, color, font, "left"));
      this.texts.set(key, made);
    }
    return made;
  }

  drawOwn() {
    const { view, own, palette, settings } = this.scene;
    const c = this.context;
    const { x, y } = this.own;
    c.strokeStyle = palette.own;
    if (!own.known) {
      c.lineWidth = 1.5;
      c.beginPath();
      c.moveTo(x - 7, y);
      c.lineTo(x + 7, y);
      c.moveTo(x, y - 7);
      c.lineTo(x, y + 7);
      c.stroke();
      return;
    }
    c.lineWidth = 1.5;
    for (const radius of [3.5, 7]) {
      c.beginPath();
      c.arc(x, y, radius, 0, TURN);
      c.stroke();
    }
    if (own.heading !== null) {
      const a = view.screenAngle(own.heading);
      const reach = Math.hypot(view.width, view.height);
      c.lineWidth = 1;
      c.beginPath();
      c.moveTo(x, y);
      c.lineTo(x + reach * Math.sin(a), y - reach * Math.cos(a));
      c.stroke();
    }
    if (settings.vectors === "true" && own.speed > 0.1) {
      this.vector(x, y, own.vnorth, own.veast, palette.own);
    }
  }

  /** Adds a vector to the path of its color; all of a color are drawn at once. */
  vector(x, y, vnorth, veast, color) {
    const { view, settings } = this.scene;
    const length = settings.vectorMinutes * 60 * view.scale;
    const [cos, sin] = [Math.cos(view.rotation), Math.sin(view.rotation)];
    const [dx, dy] = [(veast * cos - vnorth * sin) * length, -(vnorth * cos + veast * sin) * length];
    if (Math.hypot(dx, dy) < 3) return;
    let path = this.vectors.get(color);
    if (!path) this.vectors.set(color, (path = new Path2D()));
    path.moveTo(x, y);
    path.lineTo(x + dx, y + dy);
  }

  strokeVectors() {
    const c = this.context;
    c.setLineDash([6, 3]);
    for (const [color, path] of this.vectors) {
      c.strokeStyle = color;
      // A thousand lines of one pixel take a processor 2 ms, wider ones 50.
      c.lineWidth = this.isSoftware ? 1 / this.ratio : 1.6;
      c.stroke(path);
      if (this.isSoftware && color === this.scene.palette.danger) {
        c.translate(0.6, 0.6);
        c.stroke(path);
        c.translate(-0.6, -0.6);
      }
    }
    c.setLineDash([]);
    this.vectors.clear();
  }

  /** A picture that `paint` draws with a context: it is copied faster than drawn. */
  picture(width, height, paint) {
    const canvas = new OffscreenCanvas(Math.ceil(width * this.ratio), Math.ceil(height * this.ratio));
    const c = canvas.getContext("2d", this.kind);
    c.scale(this.ratio, this.ratio);
    paint(c);
    return canvas.transferToImageBitmap();
  }

  circle(color, dashed) {
    const key = `${color} ${dashed} ${this.ratio}`;
    let made = this.circles.get(key);
    if (!made) {
      made = this.picture(2 * CIRCLE_PX, 2 * CIRCLE_PX, (c) => {
        c.strokeStyle = color;
        c.lineWidth = 1.6;
        c.setLineDash(dashed ? [3, 3] : []);
        c.beginPath();
        c.arc(CIRCLE_PX, CIRCLE_PX, TARGET_PX, 0, TURN);
        c.stroke();
      });
      this.circles.set(key, made);
    }
    return made;
  }

  drawPlots() {
    const { view, store, palette } = this.scene;
    const c = this.context;
    c.fillStyle = palette.plot;
    for (const [north, east] of store.plots ?? []) {
      const [x, y] = view.toScreen(north, east);
      c.fillRect(x - 1.5, y - 1.5, 3, 3);
    }
  }

  // Targets -----------------------------------------------------------------------------------------

  targets(time_s) {
    const { view, store, selected, own } = this.scene;
    const { x0, xn, xe, y0, yn, ye } = view.projection;
    const shown = [];
    this.fastest_px = 0;
    this.flashes = store.lost.size > 0 || store.zones.length > 0;
    const dangers = store.dangerOfEach();
    const alarmed = new Map();
    for (const alarm of store.alarms) {
      if (alarm.state === "ended") continue;
      for (const id of alarm.tracks) alarmed.set(id, (alarmed.get(id) ?? false) || !alarm.acknowledged);
    }
    for (const track of store.tracks.values()) {
      const { north, east } = store.at(track, time_s);
      const [x, y] = [x0 + xn * north + xe * east, y0 + yn * north + ye * east];
      if (x < -60 || y < -60 || x > view.width + 60 || y > view.height + 60) continue;
      track.x = x; // beside the values of the message, so that a frame makes no objects
      track.y = y;
      track.danger = dangers.get(track.id) ?? null;
      track.alarmed = alarmed.has(track.id);
      track.flashes = alarmed.get(track.id) ?? false;
      track.selected = track.id === selected;
      this.flashes ||= track.flashes;
      this.fastest_px = Math.max(this.fastest_px, view.scale * (Math.hypot(track.vnorth, track.veast) + own.speed));
      shown.push(track);
    }
    return shown;
  }

  colorOf(target) {
    const { palette } = this.scene;
    return target.danger || target.alarmed ? palette.danger : palette.target;
  }

  drawTarget(target) {
    const { palette, blink } = this.scene;
    const c = this.context;
    const { x, y } = target;
    const alert = target.danger || target.alarmed;
    c.strokeStyle = this.colorOf(target);
    if (target.flashes && blink) {
      c.lineWidth = 1;
      c.beginPath();
      c.arc(x, y, TARGET_PX, 0, TURN);
      c.stroke();
    } else {
      if (alert) {
        c.lineWidth = 2.5;
        c.beginPath();
        c.arc(x, y, DANGER_PX, 0, TURN);
        c.stroke();
      } else {
        this.copy(this.circle(palette.target, acquiring(target)), x - CIRCLE_PX, y - CIRCLE_PX);
      }
      if (target.identity) this.triangle(x, y, target, this.colorOf(target), 4);
    }
    if (target.status === "coasting") {
      c.lineWidth = 1.2;
      c.beginPath();
      c.moveTo(x - 9, y);
      c.lineTo(x + 9, y);
      c.stroke();
    }
    if (target.selected) {
      c.strokeStyle = palette.selected;
      c.lineWidth = 2;
      const s = 14;
      c.beginPath();
      for (const [sx, sy] of [[1, 1], [1, -1], [-1, 1], [-1, -1]]) {
        c.moveTo(x + sx * s, y + sy * (s - 6));
        c.lineTo(x + sx * s, y + sy * s);
        c.lineTo(x + sx * (s - 6), y + sy * s);
      }
      c.stroke();
    }
  }

  drawLost(track) {
    const { view, palette, blink } = this.scene;
    const [x, y] = view.toScreen(track.north, track.east);
    if (blink) return;
    const c = this.context;
    c.strokeStyle = palette.lost;
    c.lineWidth = 1.6;
    c.beginPath();
    c.arc(x, y, TARGET_PX, 0, TURN);
    c.stroke();
    c.lineWidth = 2.5;
    c.beginPath();
    for (const s of [-1, 1]) {
      c.moveTo(x - 9, y - s * 9);
      c.lineTo(x + 9, y + s * 9);
    }
    c.stroke();
  }

  drawVector(target) {
    const { settings, own } = this.scene;
    if (settings.vectors === "off") return;
    const relative = settings.vectors === "relative";
    const [vnorth, veast] = relative ? [target.vnorth - own.vnorth, target.veast - own.veast] : [target.vnorth, target.veast];
    this.vector(target.x, target.y, vnorth, veast, this.colorOf(target));
  }

  drawPast(targets) {
    const { view, palette, settings, time_s } = this.scene;
    const c = this.context;
    const { ratio } = this;
    const { x0, xn, xe, y0, yn, ye } = view.projection;
    const whole = (v) => Math.round((v - 1.5) * ratio) / ratio; // a pixel that is not cut is filled faster
    const length_s = settings.trailMinutes * 60;
    const most = Math.min(Math.max(Math.floor(MOST_DOTS / targets.length), LEAST_PAST_SHOWN), MOST_PAST_SHOWN);
    const step_s = Math.max(length_s / most, 6);
    c.fillStyle = palette.past;
    for (const target of targets) {
      let next_s = Infinity;
      for (let k = target.past.length - 1; k >= 0; k -= 1) {
        const [when, north, east] = target.past[k];
        if (time_s - when > length_s) break;
        if (when > next_s) continue;
        next_s = when - step_s + 0.5;
        const [x, y] = [x0 + xn * north + xe * east, y0 + yn * north + ye * east];
        if (Math.hypot(x - target.x, y - target.y) < 5) continue;
        c.globalAlpha = 1 - 0.7 * Math.min((time_s - when) / length_s, 1);
        c.fillRect(whole(x), whole(y), 3, 3);
      }
    }
    c.globalAlpha = 1;
  }

  /** Regions that contain the position with 95 %, where they are larger than the symbol. */
  drawEllipses(targets) {
    const { view } = this.scene;
    const c = this.context;
    c.globalAlpha = 0.55;
    c.lineWidth = 1;
    for (const target of targets) {
      if (target.major === null || target.major * ELLIPSE_STDS * view.scale < TARGET_PX + 1) continue;
      const [a, b] = [target.major, target.minor].map((std) => Math.min(std * ELLIPSE_STDS * view.scale, 4000));
      c.strokeStyle = this.colorOf(target);
      c.beginPath();
      c.ellipse(target.x, target.y, a, Math.max(b, 0.5), view.screenAngle(target.axis) - TURN / 4, 0, TURN);
      c.stroke();
    }
    c.globalAlpha = 1;
  }

  drawEncounter(danger) {
    const { view, palette, selected } = this.scene;
    const c = this.context;
    const [a, b] = [danger.first_at_cpa_m, danger.second_at_cpa_m].map((place) => view.toScreen(...place));
    if (Math.max(Math.abs(a[0]), Math.abs(a[1])) > 20000 || danger.tcpa_s < 0) return;
    c.strokeStyle = palette.danger;
    c.lineWidth = 1.5;
    c.setLineDash([2, 3]);
    c.beginPath();
    c.moveTo(...a);
    c.lineTo(...b);
    c.stroke();
    c.setLineDash([]);
    for (const [x, y] of [a, b]) {
      c.beginPath();
      c.moveTo(x, y - 5);
      c.lineTo(x + 5, y);
      c.lineTo(x, y + 5);
      c.lineTo(x - 5, y);
      c.closePath();
      c.stroke();
    }
    if (danger.second === selected || (danger.first === selected && danger.first !== 0)) {
      const { settings } = this.scene;
      const text = `CPA ${distance(danger.cpa_m, settings.units)} in ${minutes(danger.tcpa_s)}, ${percent(danger.probability)}`;
      this.text(text, (a[0] + b[0]) / 2, Math.max(a[1], b[1]) + 18, palette.danger, { font: FONT });
    }
  }

  // AIS ---------------------------------------------------------------------------------------------

  triangle(x, y, vessel, color, size) {
    const { view } = this.scene;
    const c = this.context;
    const moves = Math.hypot(vessel.vnorth, vessel.veast) > 0.2;
    const direction = vessel.heading ?? (moves ? Math.atan2(vessel.veast, vessel.vnorth) : 0);
    c.save();
    c.translate(x, y);
    c.rotate(view.screenAngle(direction));
    c.strokeStyle = color;
    c.lineWidth = 1.6;
    c.beginPath();
    c.moveTo(0, -1.9 * size);
    c.lineTo(size, size);
    c.lineTo(-size, size);
    c.closePath();
    c.stroke();
    c.restore();
  }

  drawAis(time_s) {
    const { view, store, palette, settings, own } = this.scene;
    const shown = [];
    for (const vessel of store.ais.values()) {
      const place = store.at(vessel, time_s);
      const track = vessel.track === null ? null : store.tracks.get(vessel.track);
      const [x, y] = view.toScreen(place.north, place.east);
      if (x < -40 || y < -40 || x > view.width + 40 || y > view.height + 40) continue;
      if (track) {
        const there = store.at(track, time_s);
        const [tx, ty] = view.toScreen(there.north, there.east);
        const apart = Math.hypot(tx - x, ty - y);
        const disagrees = store.alarms.some((alarm) => alarm.kind === "ais disagrees" && alarm.state !== "ended" && alarm.tracks.includes(track.id));
        if (!disagrees) continue; // one symbol for a matched pair
        const c = this.context;
        c.strokeStyle = palette.lost;
        c.setLineDash([2, 4]);
        c.lineWidth = 1.2;
        c.beginPath();
        c.moveTo(x, y);
        c.lineTo(tx, ty);
        c.stroke();
        c.setLineDash([]);
        if (apart < 4) continue;
      }
      this.triangle(x, y, vessel, palette.ais, 5.5);
      if (settings.vectors !== "off") {
        const relative = settings.vectors === "relative";
        this.vector(x, y, vessel.vnorth - (relative ? own.vnorth : 0), vessel.veast - (relative ? own.veast : 0), palette.ais);
      }
      shown.push({ ...vessel, x, y, isAis: true });
    }
    this.strokeVectors();
    return shown;
  }

  // Labels ------------------------------------------------------------------------------------------

  linesOf(target) {
    const { settings } = this.scene;
    if (target.isAis) return [target.name || target.id];
    const lines = [this.scene.store.nameOf(target) || String(target.id)];
    if (target.mode?.startsWith("turning")) lines.push(target.mode);
    if (target.danger && target.danger.tcpa_s >= 0) {
      lines.push(`CPA ${distance(target.danger.cpa_m, settings.units)} · ${percent(target.danger.probability)}`);
    } else if (target.selected && !acquiring(target)) {
      lines.push(`${speed(Math.hypot(target.vnorth, target.veast), settings.units)} · ${angle(Math.atan2(target.veast, target.vnorth))}`);
    }
    return lines;
  }

  drawLabels(targets, vessels) {
    const { palette, view, own, now_ms } = this.scene;
    const c = this.context;
    c.font = FONT;
    const rank = (one) => (one.selected ? 0 : one.danger || one.alarmed ? 1 : one.isAis ? 4 : this.scene.store.nameOf(one) ? 2 : 3);
    const near = (one) => Math.hypot(one.x - this.own.x, one.y - this.own.y);
    const due = now_ms - this.labels_ms > LABELS_MS;
    const items = [];
    for (const one of [...targets, ...vessels]) {
      if (!due && !this.offsets.has(one.id)) continue;
      const lines = this.linesOf(one);
      // Where all lines have no room, the first alone may have.
      const sizes = [...new Set([lines.length, 1])].map((n) => [Math.max(...lines.slice(0, n).map((line) => this.widthOf(line))) + 4, 14 * n]);
      items.push({ one, lines, id: one.id, x: one.x, y: one.y, sizes, rank: rank(one), near: near(one) });
    }
    if (due) {
      this.labels_ms = now_ms;
      items.sort((a, b) => a.rank - b.rank || a.near - b.near);
      const symbols = items.map(({ one }) => ({ x: one.x, y: one.y, radius: one.danger || one.alarmed || one.selected ? 13 : 8 }));
      symbols.push({ x: this.own.x, y: this.own.y, radius: 9 });
      this.offsets = placeLabels(items, symbols, this.scene.covered(), this.offsets, [4, view.top + 2, view.width - 4, view.height - view.bottom]);
    }
    for (const item of items) {
      const offset = this.offsets.get(item.id);
      if (!offset) continue;
      const [width, height] = item.sizes[Math.min(offset[2], item.sizes.length - 1)];
      const [x, y] = [item.x + offset[0], item.y + offset[1]];
      const color = item.one.isAis ? palette.ais : item.one.danger || item.one.alarmed ? palette.danger : palette.label;
      const [nx, ny] = [Math.max(x, Math.min(item.x, x + width)), Math.max(y, Math.min(item.y, y + height))];
      const away = Math.hypot(nx - item.x, ny - item.y);
      if (away > 22) {
        c.strokeStyle = color;
        c.lineWidth = 0.8;
        c.beginPath();
        c.moveTo(item.x + ((nx - item.x) * 9) / away, item.y + ((ny - item.y) * 9) / away);
        c.lineTo(nx, ny);
        c.stroke();
      }
      item.lines.slice(0, height / 14).forEach((line, k) => this.text(line, x + 2, y + 7 + 14 * k, color, { font: FONT, align: "left" }));
    }
  }

  widthOf(text) {
    let width = this.widths.get(text);
    if (width === undefined) {
      if (this.widths.size > 4000) this.widths.clear();
      width = this.context.measureText(text).width;
      this.widths.set(text, width);
    }
    return width;
  }

  // Zones, measures, what is being drawn ------------------------------------------------------------

  outline(zone) {
    const { view, own } = this.scene;
    const c = this.context;
    c.beginPath();
    if (zone.outline_m) {
      zone.outline_m.forEach(([north, east], k) => {
        const [x, y] = view.toScreen(north, east);
        if (k) c.lineTo(x, y);
        else c.moveTo(x, y);
      });
      c.closePath();
      return;
    }
    const { x, y } = this.own;
    const ahead = zone.from_bow ? own.heading ?? 0 : 0;
    const width = (((zone.to_rad - zone.from_rad) % TURN) + TURN) % TURN || TURN;
    const from = view.screenAngle(zone.from_rad + ahead) - TURN / 4;
    const [near, far] = [zone.near_m * view.scale, zone.far_m * view.scale];
    c.arc(x, y, far, from, from + width);
    if (width >= TURN - 1e-9) c.moveTo(x + near * Math.cos(from), y + near * Math.sin(from));
    c.arc(x, y, near, from + width, from, true);
    c.closePath();
  }

  drawZones() {
    const { store, palette, blink } = this.scene;
    const c = this.context;
    for (const zone of store.zones) {
      const color = { guard: palette.zone, exclusion: palette.exclusion, land: palette.land }[zone.kind];
      const alarmed = store.alarms.some((alarm) => alarm.zone_id === zone.zone_id && alarm.state === "active");
      this.outline(zone);
      c.globalAlpha = zone.kind === "land" ? 0.3 : alarmed && !blink ? 0.3 : 0.12;
      c.fillStyle = color;
      c.fill();
      c.globalAlpha = 1;
      c.strokeStyle = color;
      c.lineWidth = 1.6;
      c.setLineDash(zone.kind === "exclusion" ? [8, 4] : []);
      c.stroke();
      c.setLineDash([]);
      const [x, y] = this.zonePlace(zone);
      this.text(zone.name, x, y, color, { font: FONT });
    }
  }

  zonePlace(zone) {
    const { view, own } = this.scene;
    if (zone.outline_m) {
      const n = zone.outline_m.length;
      const middle = zone.outline_m.reduce(([a, b], [north, east]) => [a + north / n, b + east / n], [0, 0]);
      return view.toScreen(...middle);
    }
    const ahead = zone.from_bow ? own.heading ?? 0 : 0;
    const width = (((zone.to_rad - zone.from_rad) % TURN) + TURN) % TURN || TURN;
    const a = view.screenAngle(zone.from_rad + ahead + width / 2);
    const r = ((zone.near_m + zone.far_m) / 2) * view.scale;
    return [this.own.x + r * Math.sin(a), this.own.y - r * Math.cos(a)];
  }

  drawSketch() {
    const { sketch, palette } = this.scene;
    if (!sketch) return;
    const c = this.context;
    if (sketch.zone) {
      this.outline(sketch.zone);
      c.fillStyle = palette.zone;
      c.globalAlpha = 0.18;
      c.fill();
      c.globalAlpha = 1;
      c.strokeStyle = palette.zone;
      c.lineWidth = 2;
      c.setLineDash([5, 4]);
      c.stroke();
      c.setLineDash([]);
    }
    c.fillStyle = palette.zone;
    for (const [north, east] of sketch.corners ?? []) {
      const [x, y] = this.scene.view.toScreen(north, east);
      c.fillRect(x - 4, y - 4, 8, 8);
    }
  }

  drawMeasures() {
    const { measures, view, palette, settings, own } = this.scene;
    const c = this.context;
    const { x, y } = this.own;
    measures.forEach(({ bearing, range_m }, k) => {
      const a = view.screenAngle(bearing);
      const reach = Math.hypot(view.width, view.height);
      c.strokeStyle = palette.measure;
      c.lineWidth = 1.2;
      c.setLineDash(k ? [2, 4] : [8, 5]);
      c.beginPath();
      c.moveTo(x, y);
      c.lineTo(x + reach * Math.sin(a), y - reach * Math.cos(a));
      c.stroke();
      c.beginPath();
      c.arc(x, y, range_m * view.scale, 0, TURN);
      c.stroke();
      c.setLineDash([]);
      const r = range_m * view.scale;
      const text = `EBL ${angle(bearing)} · VRM ${distance(range_m, settings.units)}`;
      this.text(text, x + r * Math.sin(a), y - r * Math.cos(a) - 12, palette.measure, { font: FONT });
    });
  }

  drawCursor() {
    const { cursor, palette, keyed } = this.scene;
    if (!cursor || !keyed) return;
    const c = this.context;
    const [x, y] = cursor;
    c.strokeStyle = palette.ink;
    c.lineWidth = 1.5;
    c.beginPath();
    for (const [sx, sy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      c.moveTo(x + 4 * sx, y + 4 * sy);
      c.lineTo(x + 14 * sx, y + 14 * sy);
    }
    c.stroke();
  }
}
