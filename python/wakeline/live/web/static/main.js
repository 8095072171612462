// The page: settings, the loop that draws, the card of a target, keys, the replay bar, sound.
import { Echoes } from "./echoes.js";
import { Link } from "./link.js";
import { Overlay } from "./overlay.js";
import { PALETTES } from "./palette.js";
import { Panel, element, setText } from "./panel.js";
import { Store, acquiring } from "./store.js";
import { HINTS, Tools } from "./tools.js";
import { NAUTICAL_MILE_M, RANGES_M, angle, clock, degreesAt, distance, latitude, longitude, minutes, percent, rangeName, shortAngle, speed } from "./units.js";
import { View } from "./view.js";

const byId = (id) => document.getElementById(id);
const KEPT = "wakeline-settings";
const PANEL_MS = 500;
const BLINK_MS = 500;
const FRAME_MS = 40;
const SYMBOLS_MS = [90, 1000]; // between drawings of the symbols: least and most
const STEP_PX = 0.5; // that they move in between
const SOFTWARE_MS = 400; // between pictures of the server, where the processor draws
const TRAIL_MINUTES = [1, 3, 6, 15, 30];
const VECTOR_MINUTES = [1, 3, 6, 12, 30];
const SPEEDS = [0.25, 0.5, 1, 2, 4, 10, 20, 50];
const DEFAULTS = {
  up: "north", motion: "relative", vectors: "true", vectorMinutes: 6, trails: "true", trailMinutes: 6,
  palette: "day", units: "nautical", gain: 4, gl: true,
  show: { rings: true, labels: true, past: true, uncertainty: true, plots: true, ais: true, echoes: true },
};

// Settings: as they were, changed by the part of the address after #.
const chosen = new Set(); // by the operator, here or before; kept for the next time
const given = new Set(); // by the address, for this time
function readSettings() {
  const settings = structuredClone(DEFAULTS);
  try {
    const kept = JSON.parse(localStorage.getItem(KEPT) ?? "{}");
    for (const name of Object.keys(DEFAULTS)) {
      if (typeof kept[name] === typeof DEFAULTS[name] && name !== "show") {
        settings[name] = kept[name];
        chosen.add(name);
      }
    }
    for (const name of Object.keys(DEFAULTS.show)) {
      if (typeof kept.show?.[name] !== "boolean") continue;
      settings.show[name] = kept.show[name];
      chosen.add(`show-${name}`);
    }
  } catch {
    // a broken store is no store
  }
  const address = new URLSearchParams(location.hash.slice(1));
  for (const [name, text] of address) {
    given.add(name);
    if (name in settings.show) settings.show[name] = text !== "0";
    else if (typeof DEFAULTS[name] === "number") settings[name] = Number(text);
    else if (typeof DEFAULTS[name] === "boolean") settings[name] = text !== "0";
    else if (typeof DEFAULTS[name] === "string") settings[name] = text;
  }
  if (!(settings.palette in PALETTES)) settings.palette = DEFAULTS.palette;
  if (!(settings.units in RANGES_M)) settings.units = DEFAULTS.units;
  settings.range_m = Number(address.get("range")) || null;
  return settings;
}

const settings = readSettings();
const view = new View();
const store = new Store();
const echoes = new Echoes(byId("echoes"), settings.gl);
const overlay = new Overlay(byId("overlay"), echoes.isSoftware);
let selected = null;
let dirty = true;
let fresh = false; // a picture that is not drawn yet
let panelDue = true;
let fitted = false;
let connected = false;
let offered = null; // place of the card without a target

function keep() {
  try {
    const pick = (values, prefix) => Object.fromEntries(Object.keys(values).filter((name) => chosen.has(prefix + name)).map((name) => [name, values[name]]));
    localStorage.setItem(KEPT, JSON.stringify({ ...pick(settings, ""), show: pick(settings.show, "show-") }));
  } catch {
    // private windows have no store
  }
  changed();
  panelDue = true;
}

const changed = () => {
  dirty = true;
};

const link = new Link({
  onHello: (message) => store.hello(message),
  onPicture: (message) => {
    if (store.take(message, performance.now())) {
      echoes.clear();
      view.moored = null;
    }
    if (!fitted) fit();
    if (selected !== null && !store.tracks.has(selected)) {
      if (acquiring(store.lost.get(selected))) say(`Target ${selected} is given up: there is no echo.`, true);
      select(null);
    }
    warn(store.note ?? "");
    fresh = true;
  },
  onEchoes: (buffer) => {
    echoes.take(buffer, settings.gain, store.now(performance.now()), placeOf(own()));
    if (!fitted) fit();
  },
  onGap: (rows) => {
    echoes.gap += rows;
  },
  onBusy: () => warn("The server is busy: the picture is old"),
  onState: (open) => {
    connected = open;
    warn(open ? "" : "No connection: the picture is old");
  },
});

/** Says why the picture is old; nothing if it is not. */
function warn(text) {
  if (byId("link").textContent === text) return;
  byId("link").hidden = !text;
  setText(byId("link"), text);
  document.body.classList.toggle("old", Boolean(text));
  changed();
}

/** Where the antenna of an echo image is: ashore, or aboard own ship. */
const placeOf = (here) => (number) => {
  const radar = store.radars.find((one) => one.image === number);
  const ashore = radar && radar.aboard === false && Number.isFinite(radar.north_m);
  return ashore ? { north: radar.north_m, east: radar.east_m } : here;
};

const own = () => store.ownAt(store.now(performance.now()));

/** The range at first: that of the echoes, else what shows the targets. */
function fit() {
  if (settings.range_m) {
    view.range_m = settings.range_m;
    fitted = true;
    return;
  }
  const here = own();
  const away = [...store.tracks.values(), ...store.ais.values()].map((one) => Math.hypot(one.north - here.north, one.east - here.east));
  for (const [north, east] of store.plots ?? []) away.push(Math.hypot(north - here.north, east - here.east));
  const reach = echoes.reach(placeOf(here), here);
  if (!away.length && !reach) return;
  away.sort((a, b) => a - b);
  const targets_m = away.length ? away[Math.floor(0.95 * (away.length - 1))] : 0;
  view.fit(reach || targets_m, settings.units);
  if (!chosen.has("vectorMinutes") && !given.has("vectorMinutes")) {
    settings.vectorMinutes = view.range_m < 2000 ? 1 : view.range_m < 6000 ? 3 : 6;
    applySettings();
  }
  const placed = [...echoes.radars.keys()].every((number) => store.radars.some((radar) => radar.image === number));
  fitted = (echoes.range_m > 0 && placed) || !settings.show.echoes || store.radars.every((radar) => radar.range_m === undefined);
}

async function command(wanted) {
  const answer = await link.command(wanted);
  if (!answer.ok) say(answer.error, true);
  return answer;
}

let sayTimer = 0;
function say(text, bad = false) {
  const hint = byId("hint");
  setText(hint, text);
  hint.classList.toggle("bad", bad);
  clearTimeout(sayTimer);
  sayTimer = setTimeout(() => {
    hint.classList.remove("bad");
    setText(hint, HINTS[tools.tool]);
  }, 6000);
}

// Target card ---------------------------------------------------------------------------------------

function select(id) {
  selected = id;
  offered = null;
  if (id === null) closeCard();
  else openCard();
  changed();
  panelDue = true;
}

function closeCard() {
  byId("card").hidden = true;
  offered = null;
}

function openCard() {
  const card = byId("card");
  const track = store.tracks.get(selected);
  if (!track) return;
  const name = element("input", { type: "text", maxlength: "31", placeholder: "Name", "aria-label": "Name of the target", value: track.name });
  const rename = async (event) => {
    event.preventDefault();
    const answer = await command({ command: "rename", track_id: track.id, name: name.value });
    if (!answer.ok) return;
    name.value = answer.name ?? name.value;
    say(name.value ? `Target ${track.id} is now ${name.value}.` : `Target ${track.id} has no name now.`);
  };
  const drop = async () => {
    if ((await command({ command: "drop", track_id: track.id })).ok) {
      say(`Target ${track.id} is no longer tracked.`);
      select(null);
    }
  };
  card.replaceChildren(
    element("header", {}, element("h3", { id: "card-title" }), element("button", { text: "×", "aria-label": "Close", className: "close", onclick: () => select(null) })),
    element("form", { onsubmit: rename }, name, element("button", { text: "Name" })),
    element("dl", { id: "card-figures" }),
    element("button", { text: "Cancel target", className: "drop", onclick: drop }),
  );
  card.hidden = false;
  fillCard();
  placeCard();
}

function fillCard() {
  const track = store.tracks.get(selected);
  const title = byId("card-title");
  if (!track || !title) return;
  const time_s = store.now(performance.now());
  const here = store.ownAt(time_s);
  const place = store.at(track, time_s);
  const [north, east] = [place.north - here.north, place.east - here.east];
  const called = store.nameOf(track);
  setText(title, called ? `${called} (${track.id})` : `Target ${track.id}`);
  const rows = [
    ["Range, bearing", `${distance(Math.hypot(north, east), settings.units)}, ${angle(Math.atan2(east, north))}`],
  ];
  const unknown = acquiring(track);
  if (!unknown) rows.push(["Speed, course", `${speed(Math.hypot(track.vnorth, track.veast), settings.units)}, ${angle(Math.atan2(track.veast, track.vnorth))}`]);
  if (track.mode && !unknown) rows.push(["Motion", track.mode]);
  const danger = !unknown && store.encounters.find((one) => one.first === 0 && one.second === track.id);
  if (danger || (track.cpa !== null && track.cpa_time !== null)) {
    const [cpa_m, ahead_s, share] = danger ? [danger.cpa_m, danger.tcpa_s, danger.probability] : [track.cpa, track.cpa_time - time_s, track.probability];
    rows.push(["CPA to own ship", ahead_s >= 0 ? `${distance(cpa_m, settings.units)} in ${minutes(ahead_s)}` : "past"]);
    if (ahead_s >= 0) rows.push([`Below ${store.limits ? distance(store.limits.cpa_limit_m, settings.units) : "the limit"}`, percent(share)]);
  }
  for (const one of store.encounters.filter(({ first, second }) => first !== 0 && (first === track.id || second === track.id)).slice(0, 2)) {
    const other = one.first === track.id ? one.second : one.first;
    rows.push([`CPA to ${(store.tracks.has(other) && store.nameOf(store.tracks.get(other))) || `target ${other}`}`, `${distance(one.cpa_m, settings.units)} in ${minutes(one.tcpa_s)}, ${percent(one.probability)}`]);
  }
  if (track.major !== null) rows.push(["Position, 95 %", `± ${distance(2.4477 * track.major, settings.units === "nautical" && track.major < 200 ? "metric" : settings.units)}`]);
  if (track.identity) rows.push(["Identity", `${track.identity}${track.identity_probability === null ? "" : `, ${percent(track.identity_probability)}`}`]);
  if (track.status !== "confirmed") rows.push(["State", { coasting: "without an echo", held: "being acquired", tentative: "being acquired" }[track.status] ?? track.status]);
  const list = byId("card-figures");
  const key = JSON.stringify(rows);
  if (list.dataset.key === key) return;
  list.dataset.key = key;
  list.replaceChildren(...rows.flatMap(([term, text]) => [element("dt", { text: term }), element("dd", { text })]));
}

/** The card of a place is beside it; that of a target at the side of the picture where it is not. */
function placeCard() {
  const card = byId("card");
  if (card.hidden) return;
  const [width, height] = [card.offsetWidth, card.offsetHeight];
  const right = view.width - width - 10;
  const lowest = view.height - view.bottom - height;
  let [x, y] = [right, byId("own").offsetTop + byId("own").offsetHeight + 10];
  if (offered) {
    const at = view.toScreen(...offered);
    x = at[0] + 28 <= right ? at[0] + 28 : at[0] - 28 - width;
    y = at[1] - 40;
  } else {
    const track = store.tracks.get(selected);
    if (!track) return;
    const place = store.at(track, store.now(performance.now()));
    const at = view.toScreen(place.north, place.east);
    if (at[0] > right - 30 && at[1] > y - 30 && at[1] < y + height + 30) x = byId("tools").offsetWidth + 20;
  }
  card.style.left = `${Math.max(8, Math.min(x, right))}px`;
  card.style.top = `${Math.max(view.top + 6, Math.min(y, lowest))}px`;
}

/** A click where there is no target. */
function offer(place, at) {
  const wasOpen = !byId("card").hidden;
  select(null);
  if (wasOpen) return;
  offered = place;
  const here = own();
  const [north, east] = [place[0] - here.north, place[1] - here.east];
  const acquire = async () => {
    closeCard();
    const answer = await command({ command: "acquire", north_m: place[0], east_m: place[1] });
    if (!answer.ok) return;
    say(`Acquiring target ${answer.track_id}: its figures follow in a few turns.`);
    if (answer.track_id) waitFor(answer.track_id);
  };
  const measure = () => {
    tools.measures = [tools.polar(place)];
    closeCard();
    changed();
  };
  byId("card").replaceChildren(
    element("header", {}, element("h3", { text: `${distance(Math.hypot(north, east), settings.units)}, ${angle(Math.atan2(east, north))}` }), element("button", { text: "×", "aria-label": "Close", className: "close", onclick: closeCard })),
    element("button", { text: "Acquire target here", className: "acquire", onclick: acquire }),
    element("button", { text: "Bearing line and range marker here", onclick: measure }),
  );
  byId("card").hidden = false;
  placeCard();
}

function waitFor(id, tries = 20) {
  if (store.tracks.has(id)) select(id);
  else if (tries > 0) setTimeout(() => waitFor(id, tries - 1), 150);
}

// Zones ---------------------------------------------------------------------------------------------

async function zoneDrawn(zone) {
  const count = store.zones.filter((one) => one.kind === zone.kind).length + 1;
  const name = `${{ guard: "guard", exclusion: "no acquire", land: "land" }[zone.kind]} ${count}`;
  const answer = await command({ command: "zone", zone: { ...zone, name } });
  if (answer.ok && zone.kind === "guard") {
    say("An alarm sounds when a target enters. Edit the zone to change that.");
    editZone({ inside: [], ...answer.zone });
  }
}

function editZone(zone) {
  select(null);
  const card = byId("card");
  const name = element("input", { type: "text", maxlength: "40", "aria-label": "Name of the zone", value: zone.name });
  const boxes = ["entry", "exit", "occupancy"].map((trigger) => {
    const box = element("input", { type: "checkbox", value: trigger });
    box.checked = zone.triggers.includes(trigger);
    return box;
  });
  const stay = element("input", { type: "number", min: "1", max: "86400", value: String(zone.occupancy_s), "aria-label": "Length of a stay in seconds" });
  const save = async (event) => {
    event.preventDefault();
    const { inside, ...plain } = zone;
    const triggers = boxes.filter((box) => box.checked).map((box) => box.value);
    const answer = await command({ command: "zone", zone: { ...plain, name: name.value, triggers, occupancy_s: Number(stay.value) } });
    if (answer.ok) closeCard();
  };
  const words = ["Target enters", "Target leaves", "Target stays"];
  card.replaceChildren(
    element("header", {}, element("h3", { text: zone.kind === "guard" ? "Guard zone" : "Zone" }), element("button", { text: "×", "aria-label": "Close", className: "close", onclick: closeCard })),
    element("form", { className: "zone", onsubmit: save }, name,
      ...(zone.kind === "guard" ? [...boxes.map((box, k) => element("label", {}, box, ` ${words[k]}`)), element("label", {}, "Stay of ", stay, " s")] : []),
      element("button", { text: "Save" })),
  );
  const middle = zone.outline_m ? zone.outline_m[0] : [own().north, own().east];
  offered = middle;
  card.hidden = false;
  placeCard();
}

// Tools and settings --------------------------------------------------------------------------------

const tools = new Tools(byId("overlay"), {
  view, store, overlay, own, changed, select, offer, closeCard, zoneDrawn,
  step: (direction) => {
    view.step(direction, settings.units);
    fitted = true;
    changed();
  },
  toolChosen: (tool) => {
    for (const button of document.querySelectorAll("#tools [data-tool]")) button.setAttribute("aria-pressed", String(button.dataset.tool === tool));
    setText(byId("hint"), HINTS[tool]);
    if (tool !== "select") closeCard();
    changed();
  },
});

const panel = new Panel({
  onSelect: (id) => {
    const track = store.tracks.get(id);
    if (!track) return;
    const place = store.at(track, store.now(performance.now()));
    view.show(place.north, place.east);
    select(id);
  },
  onCommand: command,
  onZoneEdit: editZone,
});

for (const button of document.querySelectorAll("#tools [data-tool]")) button.addEventListener("click", () => tools.choose(button.dataset.tool));

function options(select, values, name) {
  select.replaceChildren(...values.map((value) => element("option", { value: String(value), text: name(value) })));
}

function bind(id, name, { numeric = false, after = () => {} } = {}) {
  const node = byId(id);
  node.value = String(settings[name]);
  node.addEventListener("change", () => {
    settings[name] = numeric ? Number(node.value) : node.value;
    chosen.add(name);
    after();
    keep();
  });
}

options(byId("vector-minutes"), VECTOR_MINUTES, (m) => `${m} min`);
options(byId("trail-minutes"), TRAIL_MINUTES, (m) => `${m} min`);
options(byId("speed"), SPEEDS, (x) => `${x}×`);

function applySettings() {
  document.body.dataset.palette = settings.palette;
  view.up = settings.up;
  view.motion = settings.motion;
  for (const [id, name] of [["up", "up"], ["motion", "motion"], ["vectors", "vectors"], ["vector-minutes", "vectorMinutes"], ["trails", "trails"], ["trail-minutes", "trailMinutes"], ["palette", "palette"], ["units", "units"], ["gain", "gain"]]) byId(id).value = String(settings[name]);
  for (const name of Object.keys(settings.show)) byId(`show-${name}`).checked = settings.show[name];
  link.showEchoes(settings.show.echoes);
  showLimits();
  changed();
}

for (const [id, name, numeric] of [["up", "up"], ["motion", "motion"], ["vectors", "vectors"], ["vector-minutes", "vectorMinutes", true], ["trails", "trails"], ["trail-minutes", "trailMinutes", true], ["palette", "palette"], ["units", "units"], ["gain", "gain", true]]) {
  bind(id, name, {
    numeric,
    after: () => {
      if (name === "up") view.offset = [0, 0];
      if (name === "units") view.fit(view.range_m * 0.8, settings.units);
      applySettings();
    },
  });
}
for (const name of Object.keys(settings.show)) {
  byId(`show-${name}`).addEventListener("change", (event) => {
    settings.show[name] = event.target.checked;
    chosen.add(`show-${name}`);
    applySettings();
    keep();
  });
}

const limitUnit = () => (settings.units === "nautical" ? NAUTICAL_MILE_M : 1);
const LIMITS = {
  "cpa-limit": () => +(store.limits.cpa_limit_m / limitUnit()).toFixed(3),
  "tcpa-limit": () => +(store.limits.tcpa_limit_s / 60).toFixed(2),
};
function showLimits() {
  setText(byId("cpa-unit"), settings.units === "nautical" ? "NM" : "m");
  if (!store.limits || document.activeElement === byId("cpa-limit") || document.activeElement === byId("tcpa-limit")) return;
  for (const [id, limit] of Object.entries(LIMITS)) byId(id).value = String(limit());
}
for (const id of Object.keys(LIMITS)) {
  byId(id).addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault(); // it would close the dialog
    byId(id).blur();
  });
  byId(id).addEventListener("change", async () => {
    const [cpa_limit_m, tcpa_limit_s] = [Number(byId("cpa-limit").value) * limitUnit(), Number(byId("tcpa-limit").value) * 60];
    const answer = await command({ command: "limits", cpa_limit_m, tcpa_limit_s });
    setText(byId("limit-answer"), answer.ok ? "" : answer.error);
    if (!answer.ok && store.limits) byId(id).value = String(LIMITS[id]());
  });
}
byId("settings-open").addEventListener("click", () => {
  setText(byId("limit-answer"), "");
  showLimits();
  byId("settings").showModal();
});
byId("range-less").addEventListener("click", () => tools.app.step(-1));
byId("range-more").addEventListener("click", () => tools.app.step(1));
byId("center").addEventListener("click", () => {
  view.centerOwn();
  changed();
});

// Replay --------------------------------------------------------------------------------------------

let scrubbing = false;
let seeking = false;
function showReplay() {
  const { replay } = store;
  byId("replay").hidden = !replay;
  if (!replay) return;
  const scrub = byId("scrub");
  if (!scrubbing) {
    [scrub.min, scrub.max] = [replay.start_s, replay.end_s];
    scrub.value = String(store.now(performance.now()));
  }
  setText(byId("clock"), `${seeking ? "Seeking " : ""}${clock(Number(scrub.value))} (${minutes(Number(scrub.value) - replay.start_s)} of ${minutes(replay.end_s - replay.start_s)})`);
  setText(byId("play"), replay.paused ? "▶" : "❚❚");
  byId("play").setAttribute("aria-label", replay.paused ? "Play" : "Pause");
  if (document.activeElement !== byId("speed")) byId("speed").value = String(replay.speed);
}
const pause = () => store.replay && command({ command: "replay", paused: !store.replay.paused });
byId("play").addEventListener("click", pause);
byId("speed").addEventListener("change", () => command({ command: "replay", speed: Number(byId("speed").value) }));
byId("scrub").addEventListener("input", () => {
  scrubbing = true;
});
byId("scrub").addEventListener("change", async () => {
  seeking = true;
  await command({ command: "replay", time_s: Number(byId("scrub").value) });
  seeking = scrubbing = false;
});
byId("replay").addEventListener("submit", (event) => event.preventDefault());

// Keys ----------------------------------------------------------------------------------------------

const cycle = (name, values) => {
  chosen.add(name);
  settings[name] = values[(values.indexOf(settings[name]) + 1) % values.length];
  applySettings();
  keep();
};
const set = (name, value) => () => {
  chosen.add(name);
  settings[name] = value;
  if (name === "up") view.offset = [0, 0];
  applySettings();
  keep();
};
const KEYS = {
  "+": () => tools.app.step(-1),
  "=": () => tools.app.step(-1),
  "-": () => tools.app.step(1),
  n: set("up", "north"),
  h: set("up", "head"),
  u: set("up", "course"),
  t: () => cycle("motion", ["relative", "true"]),
  v: () => cycle("vectors", ["true", "relative", "off"]),
  g: () => tools.choose("guard"),
  s: () => tools.choose("sector"),
  m: () => tools.choose("measure"),
  c: () => byId("center").click(),
  a: () => {
    const place = view.toPlace(...(tools.cursor ?? view.middle));
    command({ command: "acquire", north_m: place[0], east_m: place[1] }).then((answer) => answer.ok && waitFor(answer.track_id));
  },
  " ": pause,
  Escape: () => {
    if (tools.tool !== "select" || tools.corners.length) tools.choose("select");
    else select(null);
  },
};
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || byId("settings").open) return;
  const typing = event.target.closest("input:not([type=range]):not([type=checkbox]), select, textarea");
  if (typing && event.key !== "Escape") return;
  if (event.key === " " && event.target.closest("button")) return;
  const act = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act) return;
  event.preventDefault();
  act();
});

// Sound ---------------------------------------------------------------------------------------------

let audio = null;
let sounded_ms = 0;
byId("sound").addEventListener("click", () => {
  if (audio) {
    audio.close();
    audio = null;
  } else audio = new AudioContext();
  setText(byId("sound"), audio ? "Sound on" : "Sound off");
  byId("sound").setAttribute("aria-pressed", String(Boolean(audio)));
});
function sound(now_ms) {
  const loudest = store.alarms.find((alarm) => alarm.sounds && alarm.priority === "alarm") ?? store.alarms.find((alarm) => alarm.sounds);
  if (!audio || !loudest || now_ms - sounded_ms < (loudest.priority === "alarm" ? 1200 : 4000)) return;
  sounded_ms = now_ms;
  for (let k = 0; k < 2; k += 1) {
    const [tone, gain] = [audio.createOscillator(), audio.createGain()];
    tone.frequency.value = loudest.priority === "alarm" ? 880 : 620;
    gain.gain.value = 0.08;
    tone.connect(gain).connect(audio.destination);
    tone.start(audio.currentTime + 0.22 * k);
    tone.stop(audio.currentTime + 0.22 * k + 0.14);
  }
}

// Loop ----------------------------------------------------------------------------------------------

function resize() {
  const box = byId("screen").getBoundingClientRect();
  const top = byId("bar").offsetHeight;
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const replay = byId("replay").hidden ? 0 : byId("replay").offsetHeight + 6;
  view.resize(box.width, box.height, top, 42 + replay);
  for (const id of ["tools", "own", "link"]) byId(id).style.top = `${top + 8}px`;
  for (const [name, share] of [["echoes", echoes.share], ["overlay", 1]]) {
    byId(name).width = Math.round(box.width * ratio * share);
    byId(name).height = Math.round(box.height * ratio * share);
  }
  changed();
}
new ResizeObserver(resize).observe(byId("screen"));
new ResizeObserver(resize).observe(byId("bar"));
new ResizeObserver(resize).observe(byId("replay"));

function showCursor(here) {
  const node = byId("cursor");
  node.hidden = !tools.cursor;
  if (!tools.cursor) return;
  const place = view.toPlace(...tools.cursor);
  const [north, east] = [place[0] - here.north, place[1] - here.east];
  const degrees = degreesAt(store.origin_deg, ...place);
  const parts = [`${distance(Math.hypot(north, east), settings.units)}  ${angle(Math.atan2(east, north))}`];
  if (here.heading !== null) parts.push(`${shortAngle(Math.atan2(east, north) - here.heading)} from the bow`);
  if (degrees) parts.push(`${latitude(degrees[0])}  ${longitude(degrees[1])}`);
  setText(node, parts.join("\n"));
}

/** Boxes of what lies over the picture, for labels to keep clear of. */
function covered() {
  return ["tools", "own", "card"].map(byId).filter((node) => !node.hidden).map((node) => [node.offsetLeft, node.offsetTop, node.offsetLeft + node.offsetWidth, node.offsetTop + node.offsetHeight]);
}

const spent = { frames: 0, total_ms: 0, most_ms: 0 };
let drawn_ms = 0;
let symbols_ms = 0;
let panel_ms = 0;
let blink = false;
function frame(now_ms) {
  requestAnimationFrame(frame);
  const due = now_ms - panel_ms > PANEL_MS;
  if (now_ms - drawn_ms < FRAME_MS || document.hidden) return;
  const blinks = Math.floor(now_ms / BLINK_MS) % 2 === 1;
  const moves = connected && !(store.replay?.paused) && now_ms - symbols_ms > pauseOfSymbols();
  const news = fresh && now_ms - symbols_ms > (overlay.isSoftware ? SOFTWARE_MS : 0);
  const symbols = dirty || moves || news || (blinks !== blink && overlay.flashes);
  const table = due || panelDue;
  if (!symbols && !table && !(settings.show.echoes && echoes.changed)) return;
  const began = performance.now();
  drawn_ms = now_ms;
  const time_s = store.now(now_ms);
  const here = store.ownAt(time_s);
  view.follow(here);
  const palette = PALETTES[settings.palette];
  if (settings.show.echoes) echoes.draw(view, settings, palette, time_s, placeOf(here));
  else echoes.blank(palette);
  const scene = { view, store, settings, palette, own: here, time_s, now_ms, selected, blink: blinks, sketch: tools.sketch, measures: tools.measures, cursor: tools.cursor, keyed: tools.keyed, covered };
  if (symbols) drawSymbols(scene);
  if (table) drawTable(scene);
  const took_ms = performance.now() - began;
  spent.frames += 1;
  spent.total_ms += took_ms;
  spent.most_ms = Math.max(spent.most_ms, took_ms);
}

/** How long the symbols can stay as they are drawn. */
function pauseOfSymbols() {
  const [least, most] = SYMBOLS_MS;
  const px_per_s = overlay.fastest_px * (store.replay?.speed ?? 1);
  return Math.min(Math.max((1000 * STEP_PX) / px_per_s, least), most);
}

/** All but the echoes: these change with every frame, the rest slowly. */
function drawSymbols(scene) {
  symbols_ms = scene.now_ms;
  dirty = fresh = false;
  blink = scene.blink;
  overlay.draw(scene);
  placeCard();
  showCursor(scene.own);
  setText(byId("range"), `${rangeName(view.range_m, settings.units)}`);
}

function drawTable(scene) {
  panel_ms = scene.now_ms;
  panelDue = false;
  panel.draw(scene);
  fillCard();
  showReplay();
  sound(scene.now_ms);
}

tools.choose("select");
applySettings();
resize();
requestAnimationFrame(frame);

/** For tests and for the console of the browser. */
window.wakeline = {
  store, view, settings, spent, tools,
  get echoes() {
    return { usesGl: echoes.usesGl, gap: echoes.gap, radars: echoes.radars.size, range_m: echoes.range_m };
  },
  get labels() {
    return overlay.offsets;
  },
  get selected() {
    return selected;
  },
};
