// Small vectors as arrays.

export const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
export const norm = (a) => Math.hypot(...a);
export const minus = (a, b) => a.map((value, axis) => value - b[axis]);
export const plus = (a, b) => a.map((value, axis) => value + b[axis]);
export const times = (a, factor) => a.map((value) => value * factor);

/** A number for people: so many digits, and a minus sign that is one. */
export const written = (value, digits) => value.toFixed(digits).replace("-", "−");
