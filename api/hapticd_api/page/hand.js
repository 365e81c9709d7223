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

/** Lets the pointer drag the hand in a drawing. `whereNow` tells the hand's position. */
export function draggable(drawing, hand, whereNow) {
  const canvas = drawing.canvas;
  const move = (event) => {
    const box = canvas.getBoundingClientRect();
    const pixel = [event.clientX - box.left, event.clientY - box.top];
    hand.follow(drawing.projection.toBase(pixel, hand.target ?? whereNow() ?? [0, 0, 0]));
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    move(event);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) move(event);
  });
}
