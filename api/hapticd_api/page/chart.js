// The strip chart of one device: which signals it shows, and their subscription.

import { element } from "./dom.js";
import { Scope } from "./scope.js";
import { charts } from "./traces.js";

const NS_PER_S = 1e9;
const DROPPED_SHOWN_MS = 5000;

export class Chart {
  #chart;
  #generation = 0;

  constructor(device, parts, stream) {
    this.device = device;
    this.parts = parts;
    this.stream = stream;
    this.charts = charts(device);
    parts.signals.append(...this.charts.map(({ title, unit }, index) => new Option(`${title}, ${unit}`, index)));
    parts.signals.addEventListener("change", () => this.#choose(Number(parts.signals.value)));
    this.#choose(0);
  }

  #choose(index) {
    if (this.id) this.stream.unsubscribe(this.id);
    this.#chart = this.charts[index];
    // A new name for each choice: frames of the one before may still be on their way.
    this.#generation += 1;
    this.id = `${this.device.id}/chart/${this.#generation}`;
    const { labels, atLeast, signals } = this.#chart;
    this.scope = new Scope(this.parts.scope, labels, this.device.rate_hz, atLeast);
    this.parts.legend.replaceChildren(...labels.map(legend));
    this.stream.subscribe({ id: this.id, device: this.device.id, signals, rate_hz: 60, mode: "batch" });
  }

  /** Takes a frame; the ticks of a frame are one period apart. */
  take({ t_mono_ns, count, dropped, values }) {
    const { signals, values: made } = this.#chart;
    const start_s = t_mono_ns / NS_PER_S;
    for (let n = 0; n < count; n += 1) {
      const tick = signals.map((name) => values[name][n]);
      this.scope.push(start_s + n / this.device.rate_hz, tick.some(holdsNull) ? [] : made(tick));
    }
    if (dropped) this.#tellDropped(dropped);
  }

  #tellDropped(ticks) {
    this.parts.dropped.textContent = `${ticks} ticks not shown: this page is slow`;
    clearTimeout(this.forget);
    this.forget = setTimeout(() => (this.parts.dropped.textContent = ""), DROPPED_SHOWN_MS);
  }

  draw() {
    this.scope.draw();
  }
}

const holdsNull = (value) => value === null || (Array.isArray(value) && value.includes(null));

function legend(label, index) {
  const made = element("span");
  const line = element("i");
  line.style.background = `var(--trace-${index})`;
  made.append(line, label);
  return made;
}
