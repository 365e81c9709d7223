// The list of what happened, newest first.

import { get } from "./api.js";
import { element } from "./dom.js";

const SHOWN = 60;

export class EventList {
  #lastId = 0;

  constructor(list) {
    this.list = list;
  }

  /** Reads the newest events, and after a lost connection those that were missed. */
  async catchUp() {
    let page;
    do {
      page = await get(`/events?after=${this.#lastId}&limit=1000`);
      page.events.forEach((event) => this.add(event));
    } while (page.events.length === 1000);
  }

  // Of a device's summaries of missed ticks only the newest stays, or they would push out everything else.
  #replaceLike({ kind, device_id }, row) {
    if (kind !== "servo.miss") return;
    this.list.querySelector(`[data-missed="${CSS.escape(device_id)}"]`)?.remove();
    row.dataset.missed = device_id;
  }

  add(event) {
    if (event.id <= this.#lastId) return;
    this.#lastId = event.id;
    const row = element("li");
    const time = element("time", new Date(event.t_utc).toLocaleTimeString());
    time.dateTime = event.t_utc;
    row.append(time, element("span", event.message));
    this.#replaceLike(event, row);
    this.list.prepend(row);
    while (this.list.children.length > SHOWN) this.list.lastElementChild.remove();
  }
}
