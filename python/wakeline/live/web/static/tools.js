// Mouse, finger and keys on the picture: select, acquire, measure, draw zones, move the picture.
import { TURN } from "./units.js";

const CLICK_PX = 6;
const NEAR_PX = { mouse: 16, pen: 20, touch: 26 };
const CLOSE_PX = 14;
const ARROWS = { ArrowUp: [0, -1], ArrowDown: [0, 1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

export const HINTS = {
  select: "Click a target for its figures, an echo to acquire it; drag to move the picture.",
  measure: "Drag from own ship to a place: bearing line and range marker. Click own ship to remove them.",
  guard: "Guard zone: drag a rectangle, or click corners and finish at the first one (or Enter).",
  exclusion: "No targets are acquired inside: drag a rectangle, or click corners and finish at the first one.",
  land: "Land: drag a rectangle, or click corners and finish at the first one.",
  sector: "Guard zone about own ship: drag from one corner of the sector to the opposite one.",
};

export class Tools {
  /** `app` has view, store, overlay, own(), and takes what happens: see main.js. */
  constructor(canvas, app) {
    this.canvas = canvas;
    this.app = app;
    this.tool = "select";
    this.corners = [];
    this.sketch = null;
    this.measures = [];
    this.cursor = null;
    this.keyed = false;
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.lift(event));
    canvas.addEventListener("pointercancel", (event) => this.cancelPointer(event));
    canvas.addEventListener("pointerleave", () => {
      if (!this.pointers.size) this.cursor = this.keyed ? this.cursor : null;
      app.changed();
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.wheel = (this.wheel ?? 0) + event.deltaY;
      if (Math.abs(this.wheel) < 60) return;
      app.step(Math.sign(this.wheel));
      this.wheel = 0;
    }, { passive: false });
    canvas.addEventListener("dblclick", () => this.corners.length >= 3 && this.finish());
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  choose(tool) {
    this.tool = tool;
    this.corners = [];
    this.sketch = null;
    this.canvas.dataset.tool = tool;
    this.app.toolChosen(tool);
  }

  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  down(event) {
    if (event.button > 0) return;
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    const at = this.place(event);
    this.pointers.set(event.pointerId, at);
    if (this.pointers.size === 2) {
      const [a, b] = [...this.pointers.values()];
      this.pinch = Math.hypot(a[0] - b[0], a[1] - b[1]);
      this.drag = null;
      return;
    }
    this.keyed = false;
    this.cursor = at;
    this.drag = { from: at, last: at, moved: false, place: this.app.view.toPlace(...at), kind: event.pointerType };
  }

  move(event) {
    const at = this.place(event);
    if (!this.pointers.has(event.pointerId)) {
      this.keyed = false;
      this.cursor = at;
      if (this.corners.length) this.sketchCorners(this.app.view.toPlace(...at));
      this.app.changed();
      return;
    }
    this.pointers.set(event.pointerId, at);
    if (this.pointers.size === 2 && this.pinch) {
      const [a, b] = [...this.pointers.values()];
      const apart = Math.hypot(a[0] - b[0], a[1] - b[1]);
      if (apart > 1.4 * this.pinch || apart < this.pinch / 1.4) {
        this.app.step(apart > this.pinch ? -1 : 1);
        this.pinch = apart;
      }
      return;
    }
    const { drag } = this;
    if (!drag) return;
    this.cursor = at;
    if (Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) > CLICK_PX) drag.moved = true;
    if (drag.moved) this.dragged(drag, at);
    drag.last = at;
    this.app.changed();
  }

  dragged(drag, at) {
    const { view } = this.app;
    const here = view.toPlace(...at);
    if (this.tool === "select") {
      if (!drag.panning) {
        drag.panning = true;
        this.app.closeCard();
      }
      view.pan(at[0] - drag.last[0], at[1] - drag.last[1]);
    } else if (this.tool === "measure") this.measures[drag.index ??= this.measures.length % 2] = this.polar(here);
    else if (this.tool === "sector") this.sketch = { zone: this.sectorOf(drag.place, here) };
    else if (!this.corners.length) {
      const [[x0, y0], [x1, y1]] = [drag.from, at];
      this.sketch = { zone: { outline_m: [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map((corner) => view.toPlace(...corner)) } };
    }
  }

  lift(event) {
    this.move(event);
    this.pointers.delete(event.pointerId);
    if (this.pointers.size < 2) this.pinch = null;
    const { drag } = this;
    this.drag = null;
    if (!drag) return;
    const at = this.place(event);
    if (!drag.moved) this.click(at, drag.kind);
    else if (this.sketch?.zone) this.made(this.sketch.zone);
    else if (this.tool === "measure") this.choose("select");
    this.app.changed();
  }

  cancelPointer(event) {
    this.pointers.delete(event.pointerId);
    this.drag = null;
    this.sketch = null;
  }

  click(at, kind = "mouse") {
    const { view } = this.app;
    const here = view.toPlace(...at);
    if (this.tool === "select") {
      const target = this.nearest(at, NEAR_PX[kind] ?? NEAR_PX.mouse);
      if (target) this.app.select(target.id);
      else this.app.offer(here, at);
    } else if (this.tool === "measure") {
      this.measures = [];
      this.choose("select");
    } else if (this.tool !== "sector") {
      if (this.corners.length >= 3) {
        const [x, y] = view.toScreen(...this.corners[0]);
        if (Math.hypot(x - at[0], y - at[1]) < CLOSE_PX) {
          this.finish();
          return;
        }
      }
      this.corners.push(here);
      this.sketchCorners(here);
    }
  }

  nearest(at, limit) {
    let best = null;
    for (const target of this.app.overlay.shown ?? []) {
      const away = Math.hypot(target.x - at[0], target.y - at[1]);
      if (away < limit && (!best || away < best.away)) best = { ...target, away };
    }
    return best;
  }

  sketchCorners(here) {
    this.sketch = { corners: this.corners, zone: { outline_m: [...this.corners, here] } };
  }

  finish() {
    if (this.corners.length >= 3) this.made({ outline_m: this.corners });
    this.app.changed();
  }

  made(zone) {
    const kind = this.tool === "sector" ? "guard" : this.tool;
    this.choose("select");
    this.app.zoneDrawn({ ...zone, kind });
  }

  polar([north, east]) {
    const own = this.app.own();
    const [dn, de] = [north - own.north, east - own.east];
    return { bearing: (Math.atan2(de, dn) + TURN) % TURN, range_m: Math.hypot(dn, de) };
  }

  /** A sector between two places; of the two ways round the shorter one. */
  sectorOf(a, b) {
    const own = this.app.own();
    const [p, q] = [this.polar(a), this.polar(b)];
    const width = (q.bearing - p.bearing + 1.5 * TURN) % TURN - TURN / 2;
    const ahead = own.heading ?? 0;
    const from = (width < 0 ? q.bearing : p.bearing) - ahead;
    return {
      near_m: Math.min(p.range_m, q.range_m),
      far_m: Math.max(p.range_m, q.range_m),
      from_rad: from,
      to_rad: from + Math.abs(width),
      from_bow: own.heading !== null,
    };
  }

  key(event) {
    const { app } = this;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = ARROWS[event.key];
    if (arrow) {
      event.preventDefault();
      const by = event.shiftKey ? 20 : 5;
      const at = this.cursor ?? app.view.middle;
      this.cursor = [Math.max(0, Math.min(app.view.width, at[0] + by * arrow[0])), Math.max(app.view.top, Math.min(app.view.height, at[1] + by * arrow[1]))];
      this.keyed = true;
      if (this.corners.length) this.sketchCorners(app.view.toPlace(...this.cursor));
      app.changed();
    } else if (event.key === "Enter") {
      event.preventDefault();
      if (this.corners.length >= 3 && !this.keyed) this.finish();
      else this.click(this.cursor ?? app.view.middle);
      app.changed();
    }
  }
}
