// The list of a device's walls.

import { get, patch, put, remove } from "./api.js";
import { copyOf, element, partsOf } from "./dom.js";
import { attempt } from "./toast.js";
import { dot, written } from "./vector.js";
import { newWall, WallForm } from "./wall_form.js";

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
      const eta = Number(row.querySelector("input").value);
      row.querySelector("output").textContent = described(eta, rigid);
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
    row.querySelector(".what .quiet").textContent = placed(wall.shape);
    row.classList.toggle("off", !wall.enabled);
    const slider = row.querySelector("input");
    slider.value = wall.law.eta;
    slider.addEventListener("input", () => this.update(null));
    slider.addEventListener("change", () => change({ law: { eta: Number(slider.value) } }));
    parts.toggle.textContent = wall.enabled ? "On" : "Off";
    parts.toggle.setAttribute("aria-pressed", String(wall.enabled));
    parts.toggle.addEventListener("click", () => change({ enabled: !wall.enabled }));
    parts.edit.addEventListener("click", () => this.form.open(wall, true));
    parts.delete.addEventListener("click", () => attempt(() => remove(this.#address(wall))));
    this.#rows.set(wall.id, row);
    return row;
  }
}

function described(eta, rigid) {
  if (eta === 1) return "free";
  const name = eta === 0 ? "rigid" : `η ${eta.toFixed(2)}`;
  return rigid ? `${name} · ${(((1 - eta) * rigid) / 1000).toFixed(2)} N/mm` : name;
}

function placed({ point_m, normal }) {
  const offset_mm = dot(normal, point_m) * 1000;
  const axis = normal.findIndex((value) => Math.abs(Math.abs(value) - 1) < 1e-6);
  if (axis >= 0) {
    const side = normal[axis] > 0 ? ">" : "<";
    return `free where ${"xyz"[axis]} ${side} ${written(normal[axis] * offset_mm, 1)} mm`;
  }
  return `facing (${normal.map((value) => written(value, 2)).join(", ")}), ${written(offset_mm, 1)} mm`;
}
