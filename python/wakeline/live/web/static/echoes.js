// Echoes and their trails: polar rows in, pixels out, by WebGL 2 or without it.

const HEADER = 16; // kind, radar, rows, columns, count, range_m, heading
const TRUE_CELLS = 1024; // of a side of the picture of true trails
const STRONG = 3; // levels above the gain that leave a trail
const ROUNDS_S = 65000;
const NEAR_ROWS = 4; // of an echo's own, that a pixel near the antenna may show

/** The echoes of one radar, and when each place last had one. */
class Radar {
  constructor(rows, columns, range_m) {
    this.rows = rows;
    this.columns = columns;
    this.range_m = range_m;
    this.levels = new Uint8Array(rows * columns);
    this.relative = new Uint16Array(rows * columns); // seconds, 0 never
    this.fixed = new Uint16Array(TRUE_CELLS * TRUE_CELLS); // by place on the ground, repeating
    this.cell_m = (2.2 * range_m) / TRUE_CELLS;
    this.dirty = new Uint8Array(rows);
    this.fixedFrom = TRUE_CELLS;
    this.fixedTo = -1;
    this.place = [0, 0];
    this.last = -1;
    this.fresh = true;
  }

  /** Take a message; `stamp` is the time in seconds, `own` [north, east] of the antenna. */
  take(view, count, threshold, stamp, own) {
    const { rows, columns, levels, relative, dirty } = this;
    const cells = columns / 2;
    const first = HEADER + 2 * count;
    const octets = new Uint8Array(view.buffer, view.byteOffset + first);
    this.place = own;
    const strong = Math.min(threshold + STRONG, 14);
    for (let k = 0; k < count; k += 1) {
      const row = view.getUint16(HEADER + 2 * k, true);
      if (row >= rows) continue;
      const base = row * columns;
      const from = k * cells;
      let any = false;
      for (let c = 0; c < cells; c += 1) {
        const octet = octets[from + c];
        const at = base + 2 * c;
        const [near, far] = [octet & 15, octet >> 4];
        levels[at] = near;
        levels[at + 1] = far;
        if (near >= strong) {
          relative[at] = stamp;
          any = true;
        }
        if (far >= strong) {
          relative[at + 1] = stamp;
          any = true;
        }
      }
      if (any) this.mark(row, strong, stamp, own);
      dirty[row] = 1;
      this.last = row;
    }
  }

  /** Mark the echoes of a row on the ground. */
  mark(row, strong, stamp, own) {
    const { columns, levels, fixed, cell_m, range_m, rows } = this;
    const mask = TRUE_CELLS - 1;
    const step = (2 * Math.PI) / rows;
    const wide = Math.max(1, Math.ceil((range_m * step) / cell_m));
    for (let w = 0; w < wide; w += 1) {
      const bearing = (row + (w + 0.5) / wide) * step;
      const [cos, sin] = [Math.cos(bearing), Math.sin(bearing)];
      for (let c = 0, at = row * columns; c < columns; c += 1, at += 1) {
        if (levels[at] < strong) continue;
        const range = ((c + 0.5) / columns) * range_m;
        const north = Math.floor((own[0] + range * cos) / cell_m) & mask;
        const east = Math.floor((own[1] + range * sin) / cell_m) & mask;
        fixed[north * TRUE_CELLS + east] = stamp;
        if (north < this.fixedFrom) this.fixedFrom = north;
        if (north > this.fixedTo) this.fixedTo = north;
      }
    }
  }
}

export class Echoes {
  constructor(canvas, wantsGl = true) {
    this.radars = new Map();
    this.gap = 0;
    this.painter = null;
    if (wantsGl) {
      try {
        this.painter = new GlPainter(canvas);
      } catch (error) {
        console.info(`echoes without WebGL 2: ${error.message}`);
      }
    }
    this.painter ??= new PlainPainter(canvas);
    this.changed = true;
  }

  get usesGl() {
    return this.painter instanceof GlPainter;
  }

  /** Whether this machine draws without a graphics processor. */
  get isSoftware() {
    if (!this.usesGl) return true;
    const { gl } = this.painter;
    const known = gl.getExtension("WEBGL_debug_renderer_info");
    return /swiftshader|llvmpipe|software/i.test(known ? gl.getParameter(known.UNMASKED_RENDERER_WEBGL) : "");
  }

  /** Canvas pixels of a screen's: fewer where the processor draws them. */
  get share() {
    return this.usesGl ? (this.isSoftware ? 0.5 : 1) : 2 / 3;
  }

  get range_m() {
    return Math.max(0, ...[...this.radars.values()].map((radar) => radar.range_m));
  }

  /** The range at which most of every picture is seen from a place. */
  reach(placeOf, { north, east }) {
    const seen = [...this.radars].map(([number, radar]) => {
      const place = placeOf(number);
      const away = Math.hypot(place.north - north, place.east - east);
      return away + 0.85 * radar.range_m;
    });
    return Math.max(0, ...seen);
  }

  static stamp(time_s) {
    return 1 + (Math.floor(time_s) % ROUNDS_S);
  }

  /** Take a message; `placeOf` a radar's number is {north, east}. */
  take(buffer, threshold, time_s, placeOf) {
    const view = new DataView(buffer);
    if (view.byteLength < HEADER || view.getUint8(0) !== 1) return;
    const [number, rows, columns, count] = [view.getUint8(1), view.getUint16(2, true), view.getUint16(4, true), view.getUint16(6, true)];
    if (view.byteLength < HEADER + count * (2 + columns / 2)) return;
    const range_m = view.getFloat32(8, true);
    let radar = this.radars.get(number);
    if (!radar || radar.rows !== rows || radar.columns !== columns || radar.range_m !== range_m) {
      radar = new Radar(rows, columns, range_m);
      this.radars.set(number, radar);
    }
    const place = placeOf(number);
    radar.take(view, count, threshold, Echoes.stamp(time_s), [place.north, place.east]);
    this.changed = true;
  }

  clear() {
    for (const [number, radar] of this.radars) this.radars.set(number, new Radar(radar.rows, radar.columns, radar.range_m));
    this.changed = true;
  }

  /** Draw what differs from what is shown: new rows, another view, and trails once a second. */
  draw(view, settings, palette, time_s, placeOf) {
    const { canvas } = this.painter;
    const radars = [...this.radars].map(([number, radar]) => [number, radar, placeOf(number)]);
    const moved = radars.flatMap(([, , { north, east }]) => [view.center[0] - north, view.center[1] - east]);
    if (settings.trails === "true") moved.push(...view.center);
    const key = [
      ...moved.map((v) => (v * view.scale * 2).toFixed(0)),
      view.rotation.toFixed(4), view.range_m, ...view.middle, canvas.width, canvas.height,
      settings.gain, settings.trails, settings.trailMinutes, palette.background,
      this.radars.size && settings.trails !== "off" ? Math.floor(time_s) : 0,
    ].join();
    const whole = key !== this.key;
    if (!this.changed && !whole) return;
    this.key = key;
    this.painter.draw(radars, view, settings, palette, Echoes.stamp(time_s), whole);
    this.changed = false;
  }

  blank(palette) {
    const key = `${palette.background} ${this.painter.canvas.width} ${this.painter.canvas.height}`;
    if (key !== this.key) this.painter.blank(palette);
    this.key = key;
  }
}

function rgb(color) {
  return [1, 3, 5].map((k) => parseInt(color.slice(k, k + 2), 16));
}

// With WebGL 2 --------------------------------------------------------------------------------------

const VERTEX = `#version 300 es
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }`;

const FRAGMENT = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
uniform vec2 size;        // of the canvas in pixels
uniform vec2 middle;      // of the picture, from the top left
uniform vec2 center;      // [north, east] there, from the antenna
uniform vec2 ground;      // the antenna on the ground, modulo the picture of true trails
uniform float metres;     // of a pixel
uniform float rotation;
uniform float range;
uniform float cell;       // metres of a cell of true trails
uniform int threshold;
uniform int now;
uniform int length_s;     // of trails
uniform int trails;       // 0 none, 1 true, 2 relative
uniform vec3 ramp[16];
uniform vec3 trail;
uniform vec3 background;
uniform usampler2D levels;
uniform usampler2D relative;
uniform usampler2D fixedly;
out vec4 color;
const float TURN = 6.283185307179586;
void main() {
  vec2 pixel = vec2(gl_FragCoord.x, size.y - gl_FragCoord.y) - middle;
  float right = pixel.x * metres, up = -pixel.y * metres;
  float c = cos(rotation), s = sin(rotation);
  vec2 place = center + vec2(up * c - right * s, up * s + right * c);
  float r = length(place);
  if (r >= range) discard;
  ivec2 shape = textureSize(levels, 0);
  float bearing = atan(place.y, place.x);
  float row = fract(bearing / TURN + 1.0) * float(shape.y);
  float column = r / range * float(shape.x);
  float deep = 0.5 * metres / range * float(shape.x);
  float wide = min(0.5 * metres / max(r, metres) / TURN * float(shape.y), ${NEAR_ROWS}.0);
  int first = max(int(floor(column - deep + 0.5)), 0), last = min(int(floor(column + deep - 0.5)), shape.x - 1);
  first = min(first, int(column)); last = max(last, int(column)); last = min(last, min(first + 7, shape.x - 1));
  int low = int(floor(row - wide + 0.5)), high = int(floor(row + wide - 0.5));
  low = min(low, int(row)); high = max(high, int(row)); high = min(high, low + 7);
  uint level = 0u, seen = 0u;
  for (int k = low; k <= high; ++k) {
    int at = (k + shape.y) % shape.y;
    for (int j = first; j <= last; ++j) {
      level = max(level, texelFetch(levels, ivec2(j, at), 0).r);
      if (trails == 2) seen = max(seen, texelFetch(relative, ivec2(j, at), 0).r);
    }
  }
  if (trails == 1) {
    vec2 cells = (ground + place) / cell;
    seen = texelFetch(fixedly, ivec2(int(floor(cells.y)) & ${TRUE_CELLS - 1}, int(floor(cells.x)) & ${TRUE_CELLS - 1}), 0).r;
  }
  vec3 shown = background;
  int age = now - int(seen);
  if (trails != 0 && seen != 0u && age >= 0 && age < length_s) {
    float share = 1.0 - float(age) / float(length_s);
    shown = mix(background, trail, 0.25 + 0.75 * share);
  }
  if (int(level) >= threshold) shown = ramp[min(int(level), 15)];
  color = vec4(shown, 1.0);
}`;

class GlPainter {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no context");
    this.canvas = canvas;
    this.gl = gl;
    this.textures = new Map();
    this.setUp();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.textures.clear();
      this.setUp();
    });
  }

  setUp() {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 3, -1, -1, 3]), gl.STATIC_DRAW);
    const corner = gl.getAttribLocation(program, "corner");
    gl.enableVertexAttribArray(corner);
    gl.vertexAttribPointer(corner, 2, gl.FLOAT, false, 0, 0);
    this.at = (name) => gl.getUniformLocation(program, name);
    this.places = Object.fromEntries(
      ["size", "middle", "center", "ground", "metres", "rotation", "range", "cell", "threshold", "now", "length_s", "trails", "ramp", "trail", "background", "levels", "relative", "fixedly"].map((name) => [name, this.at(name)]),
    );
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.uniform1i(this.places.levels, 0);
    gl.uniform1i(this.places.relative, 1);
    gl.uniform1i(this.places.fixedly, 2);
  }

  texture(unit, kind, width, height) {
    const gl = this.gl;
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, kind, width, height);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    return texture;
  }

  /** Textures of a radar, with the rows that are new; `onRows` gets the first and the end of each run of these. */
  upload(number, radar, onRows) {
    const gl = this.gl;
    let set = this.textures.get(number);
    if (set?.radar !== radar) {
      for (const old of set?.textures ?? []) gl.deleteTexture(old);
      const textures = [
        this.texture(0, gl.R8UI, radar.columns, radar.rows),
        this.texture(1, gl.R16UI, radar.columns, radar.rows),
        this.texture(2, gl.R16UI, TRUE_CELLS, TRUE_CELLS),
      ];
      set = { radar, textures };
      this.textures.set(number, set);
      radar.dirty.fill(1);
      radar.fixedFrom = 0;
      radar.fixedTo = TRUE_CELLS - 1;
    }
    this.bind(number);
    for (let row = 0; row < radar.rows; ) {
      if (!radar.dirty[row]) {
        row += 1;
        continue;
      }
      let end = row;
      while (end < radar.rows && radar.dirty[end]) radar.dirty[end++] = 0;
      const part = [0, row, radar.columns, end - row, gl.RED_INTEGER];
      const [from, to] = [row * radar.columns, end * radar.columns];
      gl.activeTexture(gl.TEXTURE0);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, ...part, gl.UNSIGNED_BYTE, radar.levels.subarray(from, to));
      gl.activeTexture(gl.TEXTURE1);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, ...part, gl.UNSIGNED_SHORT, radar.relative.subarray(from, to));
      onRows(row, end);
      row = end;
    }
    if (radar.fixedTo >= radar.fixedFrom) {
      const [from, to] = [radar.fixedFrom, radar.fixedTo + 1];
      gl.activeTexture(gl.TEXTURE2);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, from, TRUE_CELLS, to - from, gl.RED_INTEGER, gl.UNSIGNED_SHORT, radar.fixed.subarray(from * TRUE_CELLS, to * TRUE_CELLS));
      [radar.fixedFrom, radar.fixedTo] = [TRUE_CELLS, -1];
    }
  }

  bind(number) {
    const gl = this.gl;
    this.textures.get(number).textures.forEach((texture, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    });
  }

  blank(palette) {
    const { gl } = this;
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...rgb(palette.background).map((v) => v / 255), 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /** The part of the canvas, in its pixels from the bottom left, that rows of a radar are in. */
  static box(radar, place, first, end, view, canvas) {
    const ratio = canvas.width / view.width;
    const [near, step] = [NEAR_ROWS + 1, (2 * Math.PI) / radar.rows];
    const from = (first - near) * step;
    const width = Math.min((end - first + 2 * near) * step, 2 * Math.PI);
    const [x, y] = view.toScreen(place.north, place.east);
    const reach = 1.02 * radar.range_m * view.scale;
    const around = 4 + radar.cell_m * view.scale;
    const box = [x, y, x, y];
    const pieces = Math.ceil(width / 0.15);
    for (let k = 0; k <= pieces; k += 1) {
      const a = view.screenAngle(from + (width * k) / pieces);
      const [px, py] = [x + reach * Math.sin(a), y - reach * Math.cos(a)];
      [box[0], box[1]] = [Math.min(box[0], px), Math.min(box[1], py)];
      [box[2], box[3]] = [Math.max(box[2], px), Math.max(box[3], py)];
    }
    const [left, right] = [box[0] - around, box[2] + around].map((v) => Math.min(Math.max(Math.round(v * ratio), 0), canvas.width));
    const [top, bottom] = [box[1] - around, box[3] + around].map((v) => Math.min(Math.max(Math.round(v * ratio), 0), canvas.height));
    return [left, canvas.height - bottom, right, canvas.height - top];
  }

  /** Draw the whole picture, or where the new rows are. */
  draw(radars, view, settings, palette, now, whole) {
    const { gl, places, canvas } = this;
    if (gl.isContextLost()) return;
    const ratio = canvas.width / view.width;
    const beyond = rgb(palette.beyond).map((v) => v / 255);
    let box = whole ? [0, 0, canvas.width, canvas.height] : [Infinity, Infinity, 0, 0];
    const join = (a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
    for (const [number, radar, place] of radars) {
      this.upload(number, radar, (first, end) => {
        if (!whole) box = join(box, GlPainter.box(radar, place, first, end, view, canvas));
      });
    }
    if (!(box[2] > box[0] && box[3] > box[1])) return;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(box[0], box[1], box[2] - box[0], box[3] - box[1]);
    gl.disable(gl.BLEND);
    gl.clearColor(...(radars.length ? beyond : rgb(palette.background).map((v) => v / 255)), 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.uniform2f(places.size, canvas.width, canvas.height);
    gl.uniform2f(places.middle, view.middle[0] * ratio, view.middle[1] * ratio);
    gl.uniform1f(places.metres, 1 / (view.scale * ratio));
    gl.uniform1f(places.rotation, view.rotation);
    gl.uniform1i(places.threshold, settings.gain);
    gl.uniform1i(places.now, now);
    gl.uniform1i(places.length_s, settings.trailMinutes * 60);
    gl.uniform1i(places.trails, { off: 0, true: 1, relative: 2 }[settings.trails]);
    gl.uniform3fv(places.ramp, palette.echoes.flat().map((v) => v / 255));
    gl.uniform3fv(places.trail, palette.trail.map((v) => v / 255));
    gl.uniform3fv(places.background, rgb(palette.background).map((v) => v / 255));
    radars.forEach(([number, radar, place], k) => {
      this.bind(number);
      if (k > 0) {
        gl.enable(gl.BLEND);
        gl.blendEquation(gl.MAX);
      }
      const window_m = radar.cell_m * TRUE_CELLS;
      const ground = [place.north, place.east].map((v) => ((v % window_m) + window_m) % window_m);
      gl.uniform2f(places.center, view.center[0] - place.north, view.center[1] - place.east);
      gl.uniform2f(places.ground, ...ground);
      gl.uniform1f(places.range, radar.range_m);
      gl.uniform1f(places.cell, radar.cell_m);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    });
  }
}

// Without WebGL -------------------------------------------------------------------------------------

const MOST_DEEP = 4; // cells of a pixel

class PlainPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.key = "";
  }

  /** For each pixel of the canvas its row and column, once for a range and a rotation. */
  table(radar, view, width, height, center) {
    const key = [width, height, ...view.middle, view.range_m, view.rotation.toFixed(3), ...center.map((v) => (v * view.scale).toFixed(1)), radar.rows, radar.columns, radar.range_m].join();
    if (key === this.key) return;
    this.key = key;
    this.index = new Int32Array(width * height);
    const [mx, my] = view.middle.map((v) => (v * width) / view.width);
    const metres = view.width / width / view.scale;
    for (let y = 0, at = 0; y < height; y += 1) {
      for (let x = 0; x < width; x += 1, at += 1) {
        const [dn, de] = view.turnedBack((x + 0.5 - mx) * metres, (my - y - 0.5) * metres);
        const [north, east] = [center[0] + dn, center[1] + de];
        const range = Math.hypot(north, east);
        if (range >= radar.range_m) {
          this.index[at] = -1;
          continue;
        }
        const turn = Math.atan2(east, north) / (2 * Math.PI);
        const row = Math.floor((turn < 0 ? turn + 1 : turn) * radar.rows) % radar.rows;
        const column = Math.floor((range / radar.range_m) * radar.columns);
        this.index[at] = row * radar.columns + Math.min(column, radar.columns - MOST_DEEP);
      }
    }
  }

  blank(palette) {
    this.context.fillStyle = palette.background;
    this.context.fillRect(0, 0, this.canvas.width, this.canvas.height);
  }

  /** The radar with the largest range alone: what a page can do without WebGL. */
  draw(radars, view, settings, palette, now) {
    const { canvas, context } = this;
    if (!radars.length) {
      this.blank(palette);
      return;
    }
    const [, radar, place] = radars.reduce((a, b) => (b[1].range_m > a[1].range_m ? b : a));
    const { width, height } = canvas;
    this.table(radar, view, width, height, [view.center[0] - place.north, view.center[1] - place.east]);
    if (this.image?.width !== width || this.image?.height !== height) this.image = new ImageData(width, height);
    const pixels = new Uint32Array(this.image.data.buffer);
    const packed = ([r, g, b]) => (255 << 24) | (b << 16) | (g << 8) | r;
    const background = rgb(palette.background);
    const beyond = packed(rgb(palette.beyond));
    const ramp = palette.echoes.map((color) => packed(color.map(Math.round)));
    const dark = packed(background);
    const trail = Array.from({ length: 16 }, (_, k) => packed(background.map((v, c) => Math.round(v + (0.25 + (0.75 * k) / 15) * (palette.trail[c] - v)))));
    const length_s = settings.trailMinutes * 60;
    const deep = Math.max(1, Math.min(MOST_DEEP, Math.round(((view.width / width / view.scale) * radar.columns) / radar.range_m)));
    const fixed = settings.trails === "true";
    const stamps = fixed ? radar.fixed : radar.relative;
    const [mx, my] = view.middle.map((v) => (v * width) / view.width);
    const metres = view.width / width / view.scale;
    for (let at = 0; at < pixels.length; at += 1) {
      const k = this.index[at];
      if (k < 0) {
        pixels[at] = beyond;
        continue;
      }
      let level = radar.levels[k];
      for (let j = 1; j < deep; j += 1) if (radar.levels[k + j] > level) level = radar.levels[k + j];
      if (level >= settings.gain) {
        pixels[at] = ramp[level];
        continue;
      }
      pixels[at] = dark;
      if (settings.trails === "off") continue;
      let cell = k;
      if (fixed) {
        const [y, x] = [Math.floor(at / width), at % width];
        const [dn, de] = view.turnedBack((x + 0.5 - mx) * metres, (my - y - 0.5) * metres);
        const north = Math.floor((view.center[0] + dn) / radar.cell_m) & (TRUE_CELLS - 1);
        const east = Math.floor((view.center[1] + de) / radar.cell_m) & (TRUE_CELLS - 1);
        cell = north * TRUE_CELLS + east;
      }
      const age = now - stamps[cell];
      if (stamps[cell] && age >= 0 && age < length_s) pixels[at] = trail[Math.floor(15.99 * (1 - age / length_s))];
    }
    context.putImageData(this.image, 0, 0);
  }
}
