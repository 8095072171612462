// What the server has sent, and where everything is now.

const PAST_S = 6;
const MOST_PAST = 60;
const LOST_S = 30;
const MOST_AHEAD_S = 4;
const MOST_AGE_S = 30;

/** Whether a target has no figures yet. */
export const acquiring = (track) => track?.status === "held" || track?.status === "tentative";

export class Store {
  constructor() {
    this.tracks = new Map();
    this.ais = new Map();
    this.lost = new Map(); // targets that were lost a short time ago
    this.plots = [];
    this.alarms = [];
    this.zones = [];
    this.encounters = [];
    this.radars = [];
    this.status = {};
    this.limits = null;
    this.own = null;
    this.ashore = true;
    this.replay = null;
    this.origin_deg = null;
    this.note = null;
    this.time_s = 0;
    this.received_ms = 0;
    this.version = 0;
    this.columns = { track: [], ais: [] };
  }

  hello(message) {
    this.columns = { track: message.track_columns, ais: message.ais_columns };
  }

  take(message, now_ms) {
    const back = message.time_s < this.time_s - 1;
    if (message.all || back) {
      this.tracks.clear();
      this.ais.clear();
      this.lost.clear();
    }
    Object.assign(this, { time_s: message.time_s, received_ms: now_ms, version: message.version });
    for (const name of ["own", "replay"]) this[name] = message[name];
    this.ashore = message.ashore ?? !message.own;
    for (const name of ["radars", "alarms", "zones", "encounters", "status", "limits", "origin_deg", "note", "plots"]) {
      if (name in message) this[name] = message[name] ?? (Array.isArray(this[name]) ? [] : null);
    }
    for (const row of message.tracks ?? []) {
      const track = this.row(this.columns.track, row);
      const before = this.tracks.get(track.id);
      track.past = before?.past ?? [];
      for (const point of message.past?.[track.id] ?? []) this.addPast(track, point);
      this.addPast(track, [track.time, track.north, track.east]);
      this.tracks.set(track.id, track);
      this.lost.delete(track.id);
    }
    for (const row of message.ais ?? []) {
      const vessel = this.row(this.columns.ais, row);
      this.ais.set(vessel.id, vessel);
    }
    for (const id of message.gone ?? []) {
      const track = this.tracks.get(id);
      if (track) this.lost.set(id, { ...track, lost_s: message.time_s, ...this.at(track, message.time_s) });
      this.tracks.delete(id);
    }
    for (const id of message.ais_gone ?? []) this.ais.delete(id);
    for (const [id, track] of this.lost) if (message.time_s - track.lost_s > LOST_S) this.lost.delete(id);
    return back;
  }

  row(columns, values) {
    return Object.fromEntries(columns.map((name, k) => [name, values[k]]));
  }

  addPast(track, [time, north, east]) {
    const last = track.past.at(-1);
    if (last && time - last[0] < PAST_S) return;
    track.past.push([time, north, east]);
    if (track.past.length > MOST_PAST) track.past.shift();
  }

  /** The time of the picture now: it continues between messages. */
  now(now_ms) {
    const speed = this.replay ? (this.replay.paused ? 0 : this.replay.speed) : 1;
    const ahead_s = ((now_ms - this.received_ms) / 1000) * speed;
    const end_s = this.replay?.end_s ?? Infinity;
    return Math.min(this.time_s + Math.min(ahead_s, MOST_AHEAD_S * Math.max(speed, 1)), Math.max(end_s, this.time_s));
  }

  /** Where a track or vessel is at a time, by its velocity. */
  at(track, time_s) {
    const dt = Math.max(-MOST_AGE_S, Math.min(MOST_AGE_S, time_s - track.time));
    return { north: track.north + dt * track.vnorth, east: track.east + dt * track.veast };
  }

  ownAt(time_s) {
    const own = this.own;
    if (!own) {
      const radar = this.radars.find((one) => one.north_m !== null && one.north_m !== undefined);
      return { known: false, lost: false, north: radar?.north_m ?? 0, east: radar?.east_m ?? 0, vnorth: 0, veast: 0, heading: null, course: null, speed: 0 };
    }
    const dt = Math.min(time_s - this.time_s, MOST_AGE_S);
    const [vnorth, veast] = [own.vnorth_mps ?? 0, own.veast_mps ?? 0];
    const speed = own.lost ? null : Math.hypot(vnorth, veast);
    return {
      known: true,
      lost: Boolean(own.lost),
      north: own.north_m + dt * vnorth,
      east: own.east_m + dt * veast,
      vnorth,
      veast,
      heading: own.heading_rad ?? null,
      course: speed > 0.25 ? Math.atan2(veast, vnorth) : null,
      speed,
    };
  }

  /** What the operator calls a target, else the vessel that reports from it. */
  nameOf(track) {
    return track.name || (track.identity && this.ais.get(track.identity)?.name) || "";
  }

  /** Dangerous encounters: those of own ship, or, ashore, of any two. */
  get dangers() {
    return this.ashore ? this.encounters : this.encounters.filter((one) => one.first === 0);
  }

  /** The likeliest danger of each track. */
  dangerOfEach() {
    const worst = new Map();
    for (const one of this.dangers) {
      for (const id of [one.first, one.second]) {
        if (!(worst.get(id)?.probability >= one.probability)) worst.set(id, one);
      }
    }
    return worst;
  }
}
