// A wall in words: where it is, and how it answers.

import { dot, written } from "./vector.js";

const mm = (value) => written(value * 1000, 1);
const point = (vector) => `(${vector.map(mm).join(", ")}) mm`;

const PLACES = {
  plane: planePlace,
  sphere: ({ center_m, radius_m }) => `of ${mm(radius_m)} mm about ${point(center_m)}`,
  box: ({ center_m, size_m }) => `${size_m.map(mm).join(" × ")} mm about ${point(center_m)}`,
  capsule: ({ from_m, to_m, radius_m }) => `of ${mm(radius_m)} mm, ${point(from_m)} to ${point(to_m)}`,
};

/** Where a shape is, in millimetres. */
export function placed(shape) {
  const place = PLACES[shape.type](shape);
  if (shape.type === "plane") return place;
  return `${shape.hollow ? "hollow " : ""}${shape.type} ${place}`;
}

function planePlace({ point_m, normal }) {
  const offset = dot(normal, point_m);
  const axis = normal.findIndex((value) => Math.abs(Math.abs(value) - 1) < 1e-6);
  if (axis >= 0) return `free where ${"xyz"[axis]} ${normal[axis] > 0 ? ">" : "<"} ${mm(normal[axis] * offset)} mm`;
  return `facing (${normal.map((value) => written(value, 2)).join(", ")}), ${mm(offset)} mm`;
}

/** How a motion law with this η feels where a rigid wall has so many N/m. */
export function softness(eta, rigid) {
  if (eta === 1) return "free";
  const name = eta === 0 ? "rigid" : `η ${eta.toFixed(2)}`;
  return rigid ? `${name} · ${(((1 - eta) * rigid) / 1000).toFixed(2)} N/mm` : name;
}

/** What else a wall does: passivity, friction, its law where that is not told by its own controls. */
export function remarks({ law, friction }) {
  const told = [];
  if (law.type !== "motion") told.push(law.type.replace("_", " "));
  if (law.form) told.push(law.form);
  if (law.passivity) told.push("passivity");
  if (law.brake === false) told.push("no brakes");
  if (friction) told.push(`friction ${friction.static} / ${friction.kinetic}`);
  return told.join(" · ");
}

const UNITS = [
  ["_n_s3_per_m3", "N·s³/m³"],
  ["_n_s_per_m", "N·s/m"],
  ["_n_per_m", "N/m"],
];

/** The numbers of a law that can be changed in its row: field, label, value. */
export function numbers(law) {
  return Object.entries(law).flatMap(([field, value]) => {
    const [end, unit] = UNITS.find(([suffix]) => field.endsWith(suffix)) ?? [];
    return end ? [{ field, label: `${field.slice(0, -end.length)}, ${unit}`, value }] : [];
  });
}
