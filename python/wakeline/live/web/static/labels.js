// Places for labels beside their symbols, so that none covers another one or a symbol.

const CELL = 48;
const NEAR = 13;
const FAR = [24, 40, 60];
const SIDES = [[1, -1], [1, 1], [-1, -1], [-1, 1], [1, 0], [-1, 0], [0, -1], [0, 1]];

class Taken {
  constructor() {
    this.cells = new Map();
  }

  *keys([x0, y0, x1, y1]) {
    for (let i = Math.floor(x0 / CELL); i <= Math.floor(x1 / CELL); i += 1)
      for (let j = Math.floor(y0 / CELL); j <= Math.floor(y1 / CELL); j += 1) yield i * 100003 + j;
  }

  add(box) {
    for (const key of this.keys(box)) {
      const list = this.cells.get(key);
      if (list) list.push(box);
      else this.cells.set(key, [box]);
    }
  }

  meets(box) {
    for (const key of this.keys(box))
      for (const other of this.cells.get(key) ?? [])
        if (box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3]) return true;
    return false;
  }
}

/** Places beside a symbol for a label of each of its sizes, the best first: [dx, dy, number of the size]. */
function* placesOf({ sizes }) {
  for (const [k, [width, height]] of sizes.entries())
    for (const far of [NEAR, ...FAR])
      for (const [sx, sy] of SIDES) {
        const dx = sx > 0 ? far : sx < 0 ? -far - width : -width / 2;
        const dy = sy > 0 ? far - 6 : sy < 0 ? -far - height + 6 : -height / 2;
        yield [dx, dy, k];
      }
}

/**
 * Offsets of labels from their symbols, with the number of the size that has room.
 * items: [{id, x, y, sizes: [[width, height], ...]}] in order of importance, the wanted size first; symbols: [{x, y, radius}];
 * covered: boxes [x0, y0, x1, y1] of what lies over the picture; before: Map of earlier offsets, tried first so that labels stay. Those without room get none.
 */
export function placeLabels(items, symbols, covered, before, bounds, most = 100) {
  const taken = new Taken();
  for (const box of covered) taken.add(box);
  for (const { x, y, radius } of symbols) taken.add([x - radius, y - radius, x + radius, y + radius]);
  const offsets = new Map();
  for (const item of items.slice(0, most)) {
    const box = ([dx, dy, k]) => [item.x + dx, item.y + dy, item.x + dx + item.sizes[k][0], item.y + dy + item.sizes[k][1]];
    const fits = (offset) => {
      const [x0, y0, x1, y1] = box(offset);
      return x0 >= bounds[0] && y0 >= bounds[1] && x1 <= bounds[2] && y1 <= bounds[3] && !taken.meets([x0, y0, x1, y1]);
    };
    const tried = before.get(item.id);
    let chosen = tried && tried[2] === 0 && fits(tried) ? tried : null;
    for (const place of chosen ? [] : placesOf(item)) {
      if (!fits(place)) continue;
      chosen = place;
      break;
    }
    if (!chosen) continue;
    offsets.set(item.id, chosen);
    taken.add(box(chosen));
  }
  return offsets;
}
