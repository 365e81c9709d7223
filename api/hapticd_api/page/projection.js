// Between the base frame and the pixels of one view, and what of a wall can be seen in it.

import { dot } from "./vector.js";

const EDGE_ON = 0.05;

/** A view on `size` pixels: two coordinates of the base frame, to scale. */
export class Projection {
  constructor({ axes, center, span }, [width, height]) {
    this.axes = axes;
    this.size = [width, height];
    this.pxPerM = Math.min(width / span[0], height / span[1]);
    this.center = center;
  }

  /** Pixels of a point of the base frame. */
  toScreen(point) {
    const [i, j] = this.axes;
    return [
      this.size[0] / 2 + (point[i] - this.center[0]) * this.pxPerM,
      this.size[1] / 2 - (point[j] - this.center[1]) * this.pxPerM,
    ];
  }

  /** The point under a pixel; what the view does not show is taken from `near`. */
  toBase([x, y], near) {
    const point = [...near];
    point[this.axes[0]] = this.center[0] + (x - this.size[0] / 2) / this.pxPerM;
    point[this.axes[1]] = this.center[1] - (y - this.size[1] / 2) / this.pxPerM;
    return point;
  }

  /** The corners of the view in its two coordinates. */
  corners() {
    const [w, h] = this.size.map((length) => length / 2 / this.pxPerM);
    const [x, y] = this.center;
    return [
      [x - w, y - h],
      [x + w, y - h],
      [x + w, y + h],
      [x - w, y + h],
    ];
  }

  /**
   * The solid side of a wall in the plane of this view through `tip`: a polygon in pixels, and its edge.
   * A wall that faces the viewer has no edge: it fills the view when the tip is in it, and is not seen else.
   */
  wall({ point_m, normal }, tip) {
    const [i, j] = this.axes;
    const seen = [normal[i], normal[j]];
    const hidden = normal.map((value, axis) => (axis === i || axis === j ? 0 : value));
    const offset = dot(normal, point_m) - dot(hidden, tip);
    if (Math.hypot(...seen) < EDGE_ON) {
      return { polygon: offset > 0 ? this.#pixels(this.corners()) : [], edge: null };
    }
    const polygon = clipped(this.corners(), seen, offset);
    const edge = polygon.filter((point) => Math.abs(dot(seen, point) - offset) < 1e-9);
    return { polygon: this.#pixels(polygon), edge: edge.length === 2 ? this.#pixels(edge) : null };
  }

  #pixels(points) {
    return points.map(([x, y]) => {
      const point = [0, 0, 0];
      point[this.axes[0]] = x;
      point[this.axes[1]] = y;
      return this.toScreen(point);
    });
  }
}

/** The part of a convex polygon where normal · p ≤ offset (Sutherland and Hodgman). */
export function clipped(polygon, normal, offset) {
  const result = [];
  polygon.forEach((here, index) => {
    const next = polygon[(index + 1) % polygon.length];
    const [a, b] = [dot(normal, here) - offset, dot(normal, next) - offset];
    if (a <= 0) result.push(here);
    if (a * b < 0) result.push(here.map((value, axis) => value + ((next[axis] - value) * a) / (a - b)));
  });
  return result;
}
