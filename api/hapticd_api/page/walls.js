// The list of a device's walls.

import { get, patch, put, remove } from "./api.js";
import { copyOf, element, partsOf } from "./dom.js";
import { attempt } from "./toast.js";
import { newWall, WallForm } from "./wall_form.js";
import { numbers, placed, remarks, softness } from "./wall_words.js";

const EMPTY = "No walls yet. Add one, enable the device, and drag the hand into it.";

export class Walls {
  walls = [];
  #rows = new Map();

  /** `tip` and `stiffness` tell those of now. */
  constructor(device, parts, { tip, stiffness, changed }) {
    this.path = `/devices/${device.id}/scene`;
    this.list = parts.walls;
    this.stiffness = stiffness;
    this.changed = changed;
    this.form = new WallForm(parts.form, device.dof, (wall) => this.#save(wall), stiffness);
    parts.add.addEventListener("click", () => {
      const taken = this.walls.map(({ id }) => id);
      this.form.open(newWall(device.dof, tip(), taken), false);
    });
  }

  /** Reads the scene anew. */
  async refresh() {
    const scene = await attempt(() => get(this.path));
    if (!scene) return;
    this.walls = scene.walls;
    this.#show();
    this.changed();
  }

  /** Shows what changes by itself: which wall is touched, how stiff each is here. */
  update(touched) {
    const rigid = this.stiffness();
    for (const wall of this.walls) {
      const row = this.#rows.get(wall.id);
      if (!row) continue;
      row.classList.toggle("touched", wall.id === touched);
      if (wall.law.type !== "motion") continue;
      const eta = Number(row.querySelector("input").value);
      row.querySelector("output").textContent = softness(eta, rigid);
    }
  }

  /** Shows a wall at another place, and stores it there when `done`. */
  async move(wall, point_m, done) {
    const shape = { ...wall.shape, point_m };
    this.walls = this.walls.map((other) => (other.id === wall.id ? { ...other, shape } : other));
    this.changed();
    if (!done) return;
    await attempt(() => patch(this.#address(wall), { shape: { point_m } }));
    await this.refresh();
  }

  #address({ id }) {
    return `${this.path}/walls/${encodeURIComponent(id)}`;
  }

  async #save(wall) {
    await put(this.#address(wall), wall);
    await this.refresh();
  }

  #show() {
    this.#rows.clear();
    this.list.replaceChildren(...this.walls.map((wall) => this.#row(wall)));
    if (!this.walls.length) this.list.append(element("li", EMPTY, "none"));
    this.update(null);
  }

  #row(wall) {
    const row = copyOf("wall");
    const parts = partsOf(row);
    const change = (part) => attempt(() => patch(this.#address(wall), part));
    row.querySelector("strong").textContent = wall.id;
    const what = row.querySelector(".what .quiet");
    what.textContent = what.title = [remarks(wall), placed(wall.shape)].filter(Boolean).join(" · ");
    row.classList.toggle("off", !wall.enabled);
    if (wall.law.type === "motion") this.#slider(row, wall, change);
    else parts.law.replaceChildren(...numbers(wall.law).map((number) => numberField(number, change)));
    parts.toggle.textContent = wall.enabled ? "On" : "Off";
    parts.toggle.setAttribute("aria-pressed", String(wall.enabled));
    parts.toggle.addEventListener("click", () => change({ enabled: !wall.enabled }));
    parts.edit.hidden = wall.shape.type !== "plane"; // the form places planes
    parts.edit.addEventListener("click", () => this.form.open(wall, true));
    parts.delete.addEventListener("click", () => attempt(() => remove(this.#address(wall))));
    this.#rows.set(wall.id, row);
    return row;
  }

  #slider(row, wall, change) {
    const slider = row.querySelector("input");
    slider.value = wall.law.eta;
    slider.addEventListener("input", () => this.update(null));
    slider.addEventListener("change", () => change({ law: { eta: Number(slider.value) } }));
  }
}

function numberField({ field, label, value }, change) {
  const shown = element("label", label, "softness");
  const input = element("input");
  Object.assign(input, { type: "number", min: 0, step: "any", placeholder: "as the form has it", value: value ?? "" });
  input.addEventListener("change", () => change({ law: { [field]: input.value === "" ? null : Number(input.value) } }));
  shown.append(input);
  return shown;
}
