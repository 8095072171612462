// The panel beside the picture: alarms, targets by danger, zones, sources. Names are texts, never markup.
import { acquiring } from "./store.js";
import { TURN, distance, shortAngle, minutes, percent, speed, clock } from "./units.js";

const FAR_DEG = 0.5; // of the plane's north from true north
const MOST_ROWS = 150;
const MOST_ENDED = 6;
const LATE_S = 60; // that late data count as a fault

export function element(tag, { text, className, title, ...rest } = {}, ...children) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  if (title) made.title = title;
  for (const [name, value] of Object.entries(rest)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/** A figure without the unit that stands in the head of its column; kilometers keep theirs. */
const bare = (text) => text.replace(/ (NM|kn|m|m\/s)$/, "");
const unitOf = (kind, units) => ({ nautical: { distance: "NM", speed: "kn" }, metric: { distance: "m", speed: "m/s" } })[units][kind];

const byId = (id) => document.getElementById(id);

/** Sets text only where it differs, so that nothing is laid out in vain. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

export class Panel {
  constructor({ onSelect, onCommand, onZoneEdit }) {
    this.onSelect = onSelect;
    this.onCommand = onCommand;
    this.onZoneEdit = onZoneEdit;
    this.rows = new Map();
    this.keys = {};
    this.late = { count: 0, until_s: 0 };
    byId("silence-all").addEventListener("click", () => onCommand({ command: "silence", alarm_id: "all" }));
    byId("acknowledge-all").addEventListener("click", () => onCommand({ command: "acknowledge", alarm_id: "all" }));
  }

  draw(scene) {
    this.scene = scene;
    this.drawAlarms();
    this.drawTargets();
    this.drawZones();
    this.drawSources();
    this.drawOwn();
  }

  changed(name, value) {
    const key = JSON.stringify(value);
    if (this.keys[name] === key) return false;
    this.keys[name] = key;
    return true;
  }

  // Targets -----------------------------------------------------------------------------------------

  /** All targets in order of danger: dangers by time, then by probability, then by distance. */
  static sorted(store, own, time_s) {
    const rank = (one) => {
      if (one.danger && one.danger.tcpa_s >= 0) return 0;
      if (one.ahead_s >= 0 && one.probability >= 0.01) return 1;
      return one.ahead_s >= 0 ? 2 : 3;
    };
    const dangers = store.dangerOfEach();
    const all = [...store.tracks.values()].map((track) => {
      const place = store.at(track, time_s);
      const [north, east] = [place.north - own.north, place.east - own.east];
      const danger = dangers.get(track.id) ?? null;
      return {
        track,
        danger,
        range_m: Math.hypot(north, east),
        bearing: Math.atan2(east, north),
        cpa_m: danger ? danger.cpa_m : track.cpa,
        ahead_s: danger ? danger.tcpa_s : track.cpa_time === null ? null : track.cpa_time - time_s,
        probability: danger ? danger.probability : track.probability,
      };
    });
    const last = (value) => (value === null || value === undefined ? Infinity : value);
    return all.sort((a, b) => {
      const [ra, rb] = [rank(a), rank(b)];
      if (ra !== rb) return ra - rb;
      if (ra === 0) return last(a.ahead_s) - last(b.ahead_s) || b.probability - a.probability;
      if (ra === 1) return b.probability - a.probability || last(a.ahead_s) - last(b.ahead_s);
      return last(a.cpa_m) - last(b.cpa_m) || a.range_m - b.range_m || a.track.id - b.track.id;
    });
  }

  drawTargets() {
    const { store, settings, own, time_s, selected } = this.scene;
    const sorted = Panel.sorted(store, own, time_s);
    const more = sorted.length > MOST_ROWS ? `, the first ${MOST_ROWS} listed` : "";
    for (const node of document.querySelectorAll("[data-unit]")) setText(node, unitOf(node.dataset.unit, settings.units));
    setText(byId("target-count"), `${sorted.length}${more}`);
    const body = byId("target-rows");
    const shown = new Set();
    sorted.slice(0, MOST_ROWS).forEach((one, k) => {
      const { track } = one;
      shown.add(track.id);
      let row = this.rows.get(track.id);
      if (!row) {
        row = element("tr", { tabindex: "0", onclick: () => this.onSelect(track.id) });
        row.addEventListener("keydown", (event) => event.key === "Enter" && this.onSelect(track.id));
        for (let c = 0; c < 8; c += 1) row.append(element(c ? "td" : "th", c ? {} : { scope: "row" }));
        this.rows.set(track.id, row);
      }
      row.dataset.id = track.id;
      const past = one.ahead_s !== null && one.ahead_s < 0;
      const other = one.danger && one.danger.first !== 0 ? (one.danger.first === track.id ? one.danger.second : one.danger.first) : null;
      const unknown = acquiring(track);
      const figures = [
        `${store.nameOf(track) || track.id}${track.status === "coasting" ? " ·" : ""}`,
        bare(distance(one.range_m, settings.units)),
        shortAngle(one.bearing),
        unknown ? "" : bare(speed(Math.hypot(track.vnorth, track.veast), settings.units)),
        unknown ? "" : shortAngle(Math.atan2(track.veast, track.vnorth)),
        past ? "past" : bare(distance(one.cpa_m, settings.units)),
        past ? "" : minutes(one.ahead_s),
        past ? "" : percent(one.probability),
      ];
      figures.forEach((text, c) => setText(row.children[c], text));
      row.title = [store.nameOf(track), unknown ? "being acquired" : track.mode, other ? `closest approach to target ${other}` : "", track.status === "coasting" ? "without an echo at present" : ""].filter(Boolean).join(", ");
      row.className = [one.danger && !past ? "danger" : "", track.id === selected ? "selected" : "", track.status].filter(Boolean).join(" ");
      if (body.children[k] !== row) body.insertBefore(row, body.children[k] ?? null);
    });
    for (const [id, row] of this.rows) {
      if (shown.has(id)) continue;
      row.remove();
      this.rows.delete(id);
    }
  }

  // Alarms ------------------------------------------------------------------------------------------

  drawAlarms() {
    const { store, settings } = this.scene;
    const order = { alarm: 0, warning: 1, caution: 2 };
    const lasting = store.alarms.filter((alarm) => alarm.state !== "ended");
    const state = { active: 0, silenced: 1, acknowledged: 2 };
    const until_s = (alarm) => (alarm.tcpa_s >= 0 ? alarm.tcpa_s : Infinity);
    lasting.sort((a, b) => state[a.state] - state[b.state] || order[a.priority] - order[b.priority] || (until_s(a) < until_s(b) ? -1 : until_s(a) > until_s(b) ? 1 : b.begin_s - a.begin_s));
    const ended = store.alarms.filter((alarm) => alarm.state === "ended").slice(0, MOST_ENDED);
    const brief = [...lasting, ...ended].map((a) => [a.alarm_id, a.state, a.text, Math.round(a.cpa_m ?? -1), Math.round(a.tcpa_s ?? 0), Math.round(100 * (a.probability ?? 0)), settings.units]);
    if (!this.changed("alarms", brief)) return;
    const open = lasting.filter((alarm) => alarm.state === "active" || alarm.state === "silenced").length;
    setText(byId("alarm-count"), lasting.length ? open ? `${open} open` : `${lasting.length} acknowledged` : "none");
    byId("alarms").classList.toggle("open", open > 0);
    byId("acknowledge-all").disabled = byId("silence-all").disabled = open === 0;
    const focused = document.activeElement?.dataset?.alarm;
    byId("alarm-list").replaceChildren(...lasting.map((alarm) => this.alarmRow(alarm)), ...ended.map((alarm) => this.alarmRow(alarm)));
    if (focused) document.querySelector(`[data-alarm="${CSS.escape(focused)}"]`)?.focus();
  }

  alarmRow(alarm) {
    const { settings } = this.scene;
    const parts = [];
    if (alarm.cpa_m !== null) {
      parts.push(`CPA ${distance(alarm.cpa_m, settings.units)}`);
      parts.push(alarm.tcpa_s >= 0 ? `in ${minutes(alarm.tcpa_s)}` : "passed");
      if (alarm.tcpa_s >= 0) parts.push(percent(alarm.probability));
    }
    parts.push(alarm.state === "ended" ? `ended: ${alarm.reason}` : `since ${clock(alarm.begin_s)}`);
    if (alarm.state === "acknowledged" || alarm.state === "silenced") parts.push(alarm.state);
    const row = element("li", { className: `${alarm.priority} ${alarm.state}`, "data-id": alarm.alarm_id });
    const track = alarm.tracks.find((id) => id !== 0);
    const words = element("button", { className: "words", onclick: () => track && this.onSelect(track) }, element("strong", { text: alarm.text }), element("span", { text: parts.join(" · ") }));
    row.append(words);
    if (alarm.state === "active" || alarm.state === "silenced") {
      row.append(element("button", { text: "Acknowledge", className: "acknowledge", "data-alarm": alarm.alarm_id, onclick: () => this.onCommand({ command: "acknowledge", alarm_id: alarm.alarm_id }) }));
    }
    return row;
  }

  // Zones and sources -------------------------------------------------------------------------------

  drawZones() {
    const { store, settings } = this.scene;
    byId("zones").hidden = store.zones.length === 0;
    if (!this.changed("zones", [store.zones, settings.units])) return;
    byId("zone-list").replaceChildren(
      ...store.zones.map((zone) => {
        const inside = zone.inside.length;
        const kind = { guard: "guard zone", exclusion: "no targets acquired", land: "land" }[zone.kind];
        const on = zone.kind === "guard" ? ` on ${zone.triggers.join(", ") || "nothing"}` : "";
        const holds = zone.kind === "guard" ? `, ${inside} inside` : "";
        return element("li", { "data-id": zone.zone_id },
          element("span", {}, element("strong", { text: zone.name }), element("span", { text: ` ${kind}${on}${holds}` })),
          element("button", { text: "Edit", onclick: () => this.onZoneEdit(zone) }),
          element("button", { text: "Delete", onclick: () => this.onCommand({ command: "zone_delete", zone_id: zone.zone_id }) }));
      }),
    );
  }

  drawSources() {
    const { store } = this.scene;
    const rows = [];
    const status = store.status ?? {};
    if (store.note) rows.push(["Picture", store.note, "bad"]);
    if (Math.abs(status.north_off_deg) > FAR_DEG) rows.push(["Origin", `far away: north is off by ${Math.abs(status.north_off_deg).toFixed(1)}°; begin a new session`, "bad"]);
    if (status.frozen) rows.push(["Own ship", status.frozen, "bad"]);
    for (const [name, one] of Object.entries(status.radars ?? {})) {
      const age = Math.round(one.age_s ?? NaN);
      const off = Math.abs(one.clock_offset_s) > 0 ? `, its clock is ${minutes(Math.abs(one.clock_offset_s))} ${one.clock_offset_s > 0 ? "slow" : "fast"}` : "";
      const unused = one.unused_why ? `, not used: ${one.unused_why}` : "";
      rows.push([`Radar ${name}`, Number.isFinite(age) ? `${age} s old, ${one.plots} plots, ${(60 / one.period_s).toFixed(0)} turns/min${off}${unused}` : "nothing received", age > 10 || !Number.isFinite(age) || unused ? "bad" : "good"]);
    }
    for (const [name, one] of Object.entries(status.inputs ?? {})) {
      const age = Math.round(one.age_s ?? NaN);
      const problems = Object.values(one.problems ?? {}).reduce((sum, n) => sum + (Number(n?.count ?? n) || 0), 0);
      const lost = one.lost_sweeps ? `, ${one.lost_sweeps} sweeps lost` : "";
      const bad = problems ? `, ${problems} unreadable` : "";
      rows.push([name, `${Number.isFinite(age) ? `${age} s old` : "nothing received"}${lost}${bad}`, Number.isFinite(age) && age < 15 ? "good" : "bad"]);
    }
    const reports = status.late?.too_late_reports ?? 0;
    const late = (status.late?.too_late_inputs ?? 0) - reports;
    if (late > this.late.count) this.late.until_s = store.time_s + LATE_S;
    this.late.count = late;
    if (late) rows.push(["Late data", `${late} sectors, more than ${status.late.window_s} s`, store.time_s < this.late.until_s ? "bad" : ""]);
    if (reports) rows.push(["Late AIS", `${reports} positions, more than ${status.late.window_s} s`, ""]);
    for (const [name, one] of Object.entries(status.own ?? {})) {
      if (one?.source || one?.sources?.length || one?.rejected?.length) rows.push([name.replaceAll("_", " "), `${one.source ?? one.why}${one.age_s === null || one.age_s === undefined ? "" : `, ${Math.round(one.age_s)} s old`}`, one.source && one.fresh !== false ? "good" : "bad"]);
    }
    if (store.replay) rows.push(["Recording", `${store.replay.paused ? "paused" : "playing"} at ${clock(store.time_s)}`, "good"]);
    byId("sources").hidden = rows.length === 0;
    if (!this.changed("sources", rows)) return;
    byId("source-list").replaceChildren(...rows.flatMap(([name, text, state]) => [element("dt", { text: name }), element("dd", { text, className: state })]));
  }

  drawOwn() {
    const { store, own, settings, time_s } = this.scene;
    const rows = [];
    if (own.known) {
      const instead = settings.up === "head" ? "unknown: course up" : "unknown";
      rows.push(["HDG", own.heading === null ? instead : shortAngle(own.heading)]);
      if (own.lost) rows.push(["Position lost", ""]);
      else rows.push(["SOG", speed(own.speed, settings.units)], ["COG", shortAngle(own.course)]);
    } else rows.push([store.ashore ? "Shore station" : "No position of own ship", ""]);
    rows.push([clock(time_s), ""]);
    if (!this.changed("own", rows)) return;
    byId("own").replaceChildren(...rows.map(([name, text]) => element("span", {}, element("small", { text: name }), ` ${text}`)));
  }
}

export { TURN };
