// A strip chart of the last seconds, every tick of it.

import { written } from "./vector.js";

const SHOWN_S = 4;
const GAP_S = 0.05;
const PADDING = { left: 46, right: 8, top: 8, bottom: 18 };

/** The newest samples of some traces, by time. */
export class History {
  constructor(traces, capacity) {
    this.capacity = capacity;
    this.time_s = new Float64Array(capacity);
    this.traces = Array.from({ length: traces }, () => new Float64Array(capacity));
    this.count = 0;
  }

  push(time_s, values) {
    const at = this.count % this.capacity;
    this.time_s[at] = time_s;
    this.traces.forEach((trace, index) => (trace[at] = values[index] ?? NaN));
    this.count += 1;
  }

  /** Calls back with time and values of the samples kept since `from_s`, oldest first. */
  since(from_s, visit) {
    for (let n = Math.max(0, this.count - this.capacity); n < this.count; n += 1) {
      const at = n % this.capacity;
      if (this.time_s[at] >= from_s) visit(this.time_s[at], at);
    }
  }
}

/** A round step that divides `range` into about `parts`. */
export function roundStep(range, parts) {
  const rough = range / parts;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= rough);
}

export class Scope {
  constructor(canvas, labels, rateHz, atLeast = [Infinity, -Infinity]) {
    this.canvas = canvas;
    this.labels = labels;
    this.atLeast = atLeast;
    this.context = canvas.getContext("2d");
    this.history = new History(labels.length, Math.ceil(rateHz * SHOWN_S * 1.1));
    this.range = [0, 0];
  }

  /** Adds a sample. Where time passed without any, the traces have a gap. */
  push(time_s, values) {
    if (time_s - this.newest_s > GAP_S) this.history.push(time_s, []);
    this.history.push(time_s, values);
    this.newest_s = time_s;
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const density = window.devicePixelRatio || 1;
    const [w, h] = [Math.round(width * density), Math.round(height * density)];
    if (this.canvas.width !== w || this.canvas.height !== h) [this.canvas.width, this.canvas.height] = [w, h];
    this.context.setTransform(density, 0, 0, density, 0, 0);
    this.context.clearRect(0, 0, width, height);
    const style = getComputedStyle(this.canvas);
    this.color = (name) => style.getPropertyValue(`--${name}`);
    this.area = {
      x: PADDING.left,
      y: PADDING.top,
      w: width - PADDING.left - PADDING.right,
      h: height - PADDING.top - PADDING.bottom,
    };
    this.#fit();
    this.#axes();
    if (this.history.count) this.history.traces.forEach((trace, index) => this.#trace(trace, index));
  }

  #fit() {
    let [low, high] = this.atLeast;
    this.history.since((this.newest_s ?? 0) - SHOWN_S, (_, at) => {
      for (const trace of this.history.traces) {
        if (trace[at] < low) low = trace[at];
        if (trace[at] > high) high = trace[at];
      }
    });
    if (low > high) [low, high] = [0, 1];
    const margin = Math.max(high - low, Math.abs(high) * 0.02, 1e-3) * 0.12;
    const step = roundStep(high - low + 2 * margin, 3);
    this.step = step;
    this.range = [Math.floor((low - margin) / step) * step, Math.ceil((high + margin) / step) * step];
    if (low >= 0) this.range[0] = Math.max(0, this.range[0]);
  }

  #y(value) {
    const [low, high] = this.range;
    return this.area.y + this.area.h * (1 - (value - low) / (high - low));
  }

  #axes() {
    const { x, y, w, h } = this.area;
    const context = this.context;
    context.font = "11px system-ui, sans-serif";
    context.fillStyle = this.color("quiet");
    context.strokeStyle = this.color("grid");
    context.lineWidth = 1;
    context.textAlign = "right";
    const digits = Math.max(0, -Math.floor(Math.log10(this.step) + 1e-9));
    for (let value = this.range[0]; value <= this.range[1] + this.step / 2; value += this.step) {
      const at = Math.round(this.#y(value)) + 0.5;
      context.beginPath();
      context.moveTo(x, at);
      context.lineTo(x + w, at);
      context.stroke();
      context.fillText(written(value, digits), x - 6, at + 4);
    }
    context.textAlign = "left";
    context.fillText(`−${SHOWN_S} s`, x, y + h + 14);
    context.textAlign = "right";
    context.fillText("now", x + w, y + h + 14);
  }

  // Each column of pixels shows the smallest and largest sample in it: no peak is lost.
  #trace(trace, index) {
    const { x, w } = this.area;
    const from_s = this.newest_s - SHOWN_S;
    const context = this.context;
    context.strokeStyle = this.color(`trace-${index}`);
    context.lineWidth = 1.5;
    context.lineJoin = "round";
    context.beginPath();
    let [column, low, high, penUp] = [-1, 0, 0, true];
    const flush = () => {
      if (column < 0) return;
      if (penUp) context.moveTo(x + column, this.#y(low));
      context.lineTo(x + column, this.#y(low));
      if (high !== low) context.lineTo(x + column, this.#y(high));
      penUp = false;
    };
    this.history.since(from_s, (time_s, at) => {
      const value = trace[at];
      if (Number.isNaN(value)) {
        flush();
        [column, penUp] = [-1, true];
        return;
      }
      const here = Math.round(((time_s - from_s) / SHOWN_S) * w);
      if (here !== column) {
        flush();
        column = here;
        low = high = value;
      } else if (value < low) low = value;
      else if (value > high) high = value;
    });
    flush();
    context.stroke();
  }
}
