// The WebSocket: subscribes, stays connected, and notices at once when it is not.

const SUBPROTOCOL = "hapticd.v1+json";
const PING_EVERY_MS = 1000;
const SILENT_AFTER_MS = 3000;
const RETRY_MS = [250, 500, 1000, 2000, 4000];
const NO_RETRY = new Set([1008, 4426]);

/** Emits `live`, `lost` {retryAt}, `welcome`, `data`, `snapshot`, `event`, `latency` {ms}. */
export class Stream extends EventTarget {
  #socket = null;
  #attempt = 0;
  #heardAt = 0;
  #pinger = 0;
  #subscriptions = [];

  constructor(address) {
    super();
    this.address = address;
  }

  /** Asks for signals, now and after every reconnect. */
  subscribe(subscription) {
    this.#subscriptions.push(subscription);
    if (this.#socket?.welcomed) this.#say({ type: "subscribe", ...subscription });
  }

  unsubscribe(id) {
    this.#subscriptions = this.#subscriptions.filter((subscription) => subscription.id !== id);
    if (this.#socket?.welcomed) this.#say({ type: "unsubscribe", id });
  }

  open() {
    const socket = new WebSocket(this.address, SUBPROTOCOL);
    this.#socket = socket;
    this.#heardAt = performance.now();
    socket.addEventListener("open", () => this.#say({ type: "hello", client: "live page" }));
    socket.addEventListener("message", ({ data }) => this.#hear(socket, JSON.parse(data)));
    socket.addEventListener("close", ({ code }) => this.#lost(socket, code));
    this.#pinger = setInterval(() => this.#check(socket), PING_EVERY_MS);
  }

  #say(message) {
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  #hear(socket, message) {
    this.#heardAt = performance.now();
    if (message.type === "welcome") {
      socket.welcomed = true;
      this.#attempt = 0;
      for (const subscription of this.#subscriptions) this.#say({ type: "subscribe", ...subscription });
      this.#emit("live", message);
    }
    if (message.type === "pong") {
      this.#emit("latency", { ms: performance.now() - Number(message.nonce) });
    } else {
      this.#emit(message.type, message);
    }
  }

  // A network that goes away without a word leaves the socket open: only silence tells.
  #check(socket) {
    if (performance.now() - this.#heardAt > SILENT_AFTER_MS) this.#lost(socket, 0);
    else this.#say({ type: "ping", nonce: String(performance.now()) });
  }

  #lost(socket, code) {
    if (socket !== this.#socket) return;
    this.#socket = null;
    clearInterval(this.#pinger);
    socket.close();
    const delay = RETRY_MS[Math.min(this.#attempt, RETRY_MS.length - 1)];
    this.#attempt += 1;
    const retries = !NO_RETRY.has(code);
    this.#emit("lost", { retryAt: retries ? performance.now() + delay : null });
    if (retries) setTimeout(() => this.open(), delay);
  }

  #emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
