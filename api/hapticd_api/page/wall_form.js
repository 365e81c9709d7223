// The form in which a wall is made or changed.

import { Problem } from "./api.js";
import { partsOf } from "./dom.js";
import { dot, norm, times } from "./vector.js";

const MM_PER_M = 1000;
const CUSTOM = "custom";

const FACINGS = {
  2: { "0,1": "up, +y", "0,-1": "down, −y", "1,0": "right, +x", "-1,0": "left, −x" },
  3: {
    "0,0,1": "up, +z (a floor)",
    "0,0,-1": "down, −z (a ceiling)",
    "1,0,0": "outwards, +x",
    "-1,0,0": "inwards, −x",
    "0,1,0": "left, +y",
    "0,-1,0": "right, −y",
  },
};

/** The wall a new one starts from: just beyond the tip, where the hand finds it. */
export function newWall(dof, tip, taken) {
  const normal = dof === 3 ? [0, 0, 1] : [0, -1];
  const offset = tip ? dot(normal, tip) - 0.02 : 0;
  const names = dof === 3 ? ["floor"] : ["wall"];
  const id = [...names, ...Array.from({ length: 300 }, (_, n) => `wall-${n + 2}`)].find((name) => !taken.includes(name));
  return {
    id,
    shape: { type: "plane", point_m: times(normal, Math.round(offset * MM_PER_M) / MM_PER_M), normal },
    law: { type: "motion", eta: 0 },
    enabled: true,
    fade_s: 0.2,
  };
}

/** −1 for a normal along a negative axis, whose place people tell by the coordinate; 1 otherwise. */
const sign = (normal) => (normal.some((value) => Math.abs(value + 1) < 1e-9) ? -1 : 1);

export class WallForm {
  #wall = null;

  /** `save(wall)` stores a wall and may throw a Problem; `stiffness()` is that of a rigid wall now, N/m. */
  constructor(form, dof, save, stiffness) {
    this.form = form;
    this.dof = dof;
    form.append(document.getElementById("wall-form").content.cloneNode(true));
    this.parts = partsOf(form);
    this.error = form.querySelector(".form-error");
    const facings = Object.entries({ ...FACINGS[dof], [CUSTOM]: "another way…" });
    form.facing.append(...facings.map(([value, text]) => new Option(text, value)));
    form.facing.addEventListener("change", () => this.#showCustom());
    form.eta.addEventListener("input", () => this.#showSoftness(stiffness()));
    this.parts.cancel.addEventListener("click", () => this.close());
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.#submit(save);
    });
    this.stiffness = stiffness;
  }

  /** Opens the form on a wall; the name of one that exists stays. */
  open(wall, exists) {
    const { form } = this;
    this.#wall = wall;
    const { point_m, normal } = wall.shape;
    form.elements.id.value = wall.id;
    form.elements.id.readOnly = exists;
    const facing = normal.map((value) => Math.round(value * 1e6) / 1e6).join(",");
    form.facing.value = facing in FACINGS[this.dof] ? facing : CUSTOM;
    form.normal.value = normal.join(", ");
    form.place_mm.value = Math.round(dot(normal, point_m) * sign(normal) * MM_PER_M * 1000) / 1000;
    form.fade_s.value = wall.fade_s;
    form.eta.value = wall.law.eta ?? 0;
    this.parts.motion.hidden = wall.law.type !== "motion";
    this.error.hidden = true;
    form.hidden = false;
    this.#showCustom();
    this.#showSoftness(this.stiffness());
    form.scrollIntoView({ block: "nearest" });
    (exists ? form.place_mm : form.elements.id).focus();
  }

  close() {
    this.form.hidden = true;
  }

  #showCustom() {
    const { value } = this.form.facing;
    this.parts.custom.hidden = value !== CUSTOM;
    const axis = value.split(",").findIndex((component) => component !== "0");
    this.parts.place.textContent = value === CUSTOM ? "Distance along the normal, mm" : `At ${"xyz"[axis]} =, mm`;
  }

  #showSoftness(rigid) {
    const eta = Number(this.form.eta.value);
    const here = rigid ? `, ${(((1 - eta) * rigid) / 1000).toFixed(2)} N/mm here` : "";
    const word = eta === 0 ? " rigid" : eta === 1 ? " free" : "";
    this.parts.softness.textContent = `${eta.toFixed(2)}${word}${here}`;
  }

  async #submit(save) {
    try {
      await save(this.#written());
      this.close();
    } catch (error) {
      if (!error.document) throw error;
      const { detail, hint } = error.document;
      this.error.textContent = `${detail} ${hint}`;
      this.error.hidden = false;
    }
  }

  #written() {
    const { form } = this;
    const normal = form.facing.value === CUSTOM ? this.#custom() : form.facing.value.split(",").map(Number);
    const offset = (Number(form.place_mm.value) * sign(normal)) / MM_PER_M;
    return {
      ...this.#wall,
      id: form.elements.id.value,
      shape: { type: "plane", point_m: times(normal, offset), normal },
      law: this.#wall.law.type === "motion" ? { ...this.#wall.law, eta: Number(form.eta.value) } : this.#wall.law,
      fade_s: Number(form.fade_s.value),
    };
  }

  #custom() {
    const typed = this.form.normal.value.split(/[\s,;]+/).filter(Boolean).map(Number);
    const length = norm(typed);
    if (typed.length !== this.dof || !Number.isFinite(length) || length === 0) {
      const hint = `Write ${this.dof} numbers that are not all zero, such as ${this.dof === 3 ? "0, 0.6, 0.8" : "0.6, 0.8"}.`;
      throw new Problem({ title: "No direction", detail: "The normal is not a direction.", hint });
    }
    return times(typed, 1 / length);
  }
}
