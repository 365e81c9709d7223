// The simulated hand, moved by the pointer.

import { put } from "./api.js";
import { attempt } from "./toast.js";

/** Sends one request at a time: while one is on its way only the newest target waits. */
export class Hand {
  #path;
  #dof;
  #busy = false;
  #next = null;

  constructor(deviceId, dof) {
    this.#path = `/devices/${deviceId}/twin/hand`;
    this.#dof = dof;
  }

  /** Where the hand was last sent; the hand itself when it was sent nowhere. */
  target = null;

  async follow(point) {
    this.target = point;
    this.#next = { type: "follow", target_m: point.slice(0, this.#dof) };
    if (this.#busy) return;
    this.#busy = true;
    while (this.#next) {
      const script = this.#next;
      this.#next = null;
      await attempt(() => put(this.#path, script));
    }
    this.#busy = false;
  }

  async tell(script) {
    this.target = null;
    this.#next = null;
    await attempt(() => put(this.#path, script));
  }

}
