// The two streams of the server: pictures and commands as JSON, echoes as octets.

const WAIT_MS = [100, 200, 400]; // the last again and again: the picture is back within 1 s
const SILENT_MS = 4000; // a server that is busy says so in between
const DEAD_MS = 12000; // then a new connection is made

class Stream {
  constructor(path, onMessage, onState) {
    this.path = path;
    this.onMessage = onMessage;
    this.onState = onState;
    this.failures = 0;
    this.wanted = true;
    this.alive = null; // unknown
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}${this.path}`);
    this.socket = socket;
    this.heard_ms = performance.now();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.failures = 0;
    };
    socket.onmessage = (event) => {
      if (this.socket !== socket) return;
      this.heard_ms = performance.now();
      this.state(true);
      this.onMessage(event.data);
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.state(false);
      if (!this.wanted) return;
      setTimeout(() => this.wanted && this.open(), WAIT_MS[Math.min(this.failures, WAIT_MS.length - 1)]);
      this.failures += 1;
    };
  }

  state(alive) {
    if (alive === this.alive) return;
    this.alive = alive;
    this.onState(alive);
  }

  /** A server that is silent shows an old picture as one that is gone does. */
  check() {
    const silent_ms = performance.now() - this.heard_ms;
    if (silent_ms > SILENT_MS) this.state(false);
    if (silent_ms > DEAD_MS && this.socket.readyState <= WebSocket.OPEN) {
      this.socket.close();
      this.open();
    }
  }

  send(text) {
    if (this.socket.readyState !== WebSocket.OPEN) return false;
    this.socket.send(text);
    return true;
  }

  close() {
    this.wanted = false;
    this.socket.close();
  }
}

export class Link {
  constructor({ onHello, onPicture, onBusy, onEchoes, onGap, onState }) {
    this.number = 0;
    this.version = 0; // of the last picture, which a command is about
    this.waiting = new Map();
    this.onEchoes = onEchoes;
    this.onGap = onGap;
    this.pictures = new Stream(
      "/picture",
      (data) => {
        const message = JSON.parse(data);
        if (message.type === "hello") onHello(message);
        else if (message.type === "picture") {
          this.version = message.version;
          onPicture(message);
        } else if (message.type === "busy") onBusy();
        else if (message.type === "answer") this.answered(message);
      },
      (open) => {
        if (!open) {
          for (const done of this.waiting.values()) done({ ok: false, error: "the connection was lost" });
          this.waiting.clear();
        }
        onState(open);
      },
    );
    setInterval(() => this.pictures.check(), 1000);
    this.echoes = null;
  }

  /** Echoes are sent only while they are shown. */
  showEchoes(shown) {
    if (shown && !this.echoes) {
      this.echoes = new Stream(
        "/echoes",
        (data) => (typeof data === "string" ? this.onGap(JSON.parse(data).rows) : this.onEchoes(data)),
        () => {},
      );
    } else if (!shown && this.echoes) {
      this.echoes.close();
      this.echoes = null;
    }
  }

  /** Resolves to {ok, error}. */
  command(command) {
    this.number += 1;
    const number = this.number;
    return new Promise((done) => {
      const open = this.pictures.alive && this.pictures.send(JSON.stringify({ ...command, number, version: this.version }));
      if (!open) {
        done({ ok: false, error: "there is no connection" });
        return;
      }
      this.waiting.set(number, done);
    });
  }

  answered(message) {
    this.waiting.get(message.number)?.(message);
    this.waiting.delete(message.number);
  }
}
