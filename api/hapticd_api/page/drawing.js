// One view of a device on a canvas: links, walls, tip, set-point, forces, hand.

import { chains } from "./kinematics.js";
import { Projection } from "./projection.js";
import { silhouette } from "./silhouette.js";
import { norm } from "./vector.js";

const GRID_M = 0.05;
const ARROW_SHARE_OF_VIEW = 0.32;
const ARROW_SHARE_OF_LIMIT = 0.4; // this much of the largest tip force makes a full arrow
const ARROW_LONGEST = 1.4;
const AXIS_NAMES = ["x", "y", "z"];

export class Drawing {
  constructor(canvas, view, model) {
    this.canvas = canvas;
    this.view = view;
    this.model = model;
    this.context = canvas.getContext("2d");
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const density = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * density);
    this.canvas.height = Math.round(height * density);
    this.context.setTransform(density, 0, 0, density, 0, 0);
    this.projection = new Projection(this.view, [Math.max(width, 1), Math.max(height, 1)]);
    if (this.last) this.draw(...this.last);
  }

  /** Draws a pose, the newest tick, with the walls of the scene. */
  draw(pose, walls, touched) {
    this.last = [pose, walls, touched];
    const style = getComputedStyle(this.canvas);
    this.color = (name) => style.getPropertyValue(`--${name}`);
    this.context.clearRect(0, 0, ...this.projection.size);
    this.#grid();
    if (!pose) return;
    for (const wall of walls) this.#wall(wall, pose.tip, wall.id === touched);
    this.#hand(pose);
    this.#links(pose);
    this.#setPoint(pose);
    this.#force(pose);
    this.#tip(pose);
  }

  #grid() {
    const [width, height] = this.projection.size;
    const [[left, low], , [right, high]] = this.projection.corners();
    this.#stroke("grid", 1);
    for (let x = Math.ceil(left / GRID_M) * GRID_M; x < right; x += GRID_M) {
      const [px] = this.#at(x, 0);
      this.#line([px, 0], [px, height]);
    }
    for (let y = Math.ceil(low / GRID_M) * GRID_M; y < high; y += GRID_M) {
      const [, py] = this.#at(0, y);
      this.#line([0, py], [width, py]);
    }
    this.#scale(width, height);
  }

  #scale(width, height) {
    const length = GRID_M * this.projection.pxPerM;
    const [across, up] = this.view.axes.map((axis) => AXIS_NAMES[axis]);
    this.#stroke("quiet", 2);
    this.#line([width - 12 - length, height - 12], [width - 12, height - 12]);
    this.#text(`${GRID_M * 1000} mm`, [width - 12 - length / 2, height - 18], "quiet", "center");
    this.#text(`${across} →  ${up} ↑`, [12, height - 12], "quiet", "left");
  }

  #wall(wall, tip, isTouched) {
    if (wall.shape.type === "plane") this.#plane(wall, tip, isTouched);
    else this.#body(wall, isTouched);
  }

  #body({ shape, enabled }, isTouched) {
    const outline = silhouette(shape, this.view.axes).map(([x, y]) => this.#at(x, y));
    const context = this.context;
    context.save();
    this.#path(outline);
    context.globalAlpha = (enabled ? 0.22 : 0.06) * (shape.hollow ? 0.3 : 1);
    context.fillStyle = this.color(isTouched ? "touched" : "wall");
    context.fill();
    context.globalAlpha = enabled ? 1 : 0.35;
    context.setLineDash(enabled ? [] : [6, 6]);
    this.#stroke(isTouched ? "touched" : "wall", isTouched ? 3 : 2);
    context.stroke();
    context.restore();
  }

  #plane({ shape, law, enabled }, tip, isTouched) {
    const padded = { point_m: pad(shape.point_m), normal: pad(shape.normal) };
    const { polygon, edge } = this.projection.wall(padded, tip);
    if (polygon.length < 3) return;
    const context = this.context;
    context.save();
    this.#path(polygon);
    // A wall that faces the viewer fills the view: only a tint, or nothing else could be seen.
    const strength = edge ? 0.08 + 0.22 * (1 - (law.eta ?? 0)) : 0.1;
    context.globalAlpha = enabled ? strength : 0.04;
    context.fillStyle = this.color(isTouched ? "touched" : "wall");
    context.fill();
    context.globalAlpha = enabled ? 1 : 0.35;
    context.setLineDash(enabled ? [] : [6, 6]);
    this.#stroke(isTouched ? "touched" : "wall", isTouched ? 3 : 2);
    if (edge) this.#line(...edge);
    context.restore();
  }

  #links({ q }) {
    const context = this.context;
    context.lineCap = context.lineJoin = "round";
    for (const chain of chains(this.model.kinematics, q)) {
      const points = chain.map((point) => this.projection.toScreen(point));
      this.#path(points, false);
      this.#stroke("link-edge", 11);
      context.stroke();
      this.#stroke("link", 8);
      context.stroke();
      points.slice(0, -1).forEach((point, index) => this.#dot(point, index ? 4 : 7, "link-edge"));
    }
  }

  #tip({ tip }) {
    this.#dot(this.projection.toScreen(tip), 6, "tip", "panel");
  }

  #setPoint({ tip, setPoint, inContact }) {
    if (!inContact) return;
    const [from, to] = [tip, setPoint].map((point) => this.projection.toScreen(point));
    this.#stroke("touched", 1.5);
    this.#line(from, to);
    this.#path([[0, -5], [5, 0], [0, 5], [-5, 0]].map(([x, y]) => [to[0] + x, to[1] + y]));
    this.context.stroke();
  }

  #hand({ tip, hand }) {
    if (!hand) return;
    const [from, to] = [tip, hand].map((point) => this.projection.toScreen(point));
    this.context.save();
    this.context.setLineDash([3, 4]);
    this.#stroke("hand", 2);
    this.#line(from, to);
    this.context.restore();
    this.#dot(to, 11, "hand");
  }

  #force({ tip, force }) {
    const [i, j] = this.view.axes;
    const size = norm(force);
    const full = ARROW_SHARE_OF_VIEW * Math.min(...this.projection.size);
    const scale = full / (ARROW_SHARE_OF_LIMIT * this.model.limits.tip_force_n);
    const shown = Math.min(1, (ARROW_LONGEST * full) / Math.max(size * scale, 1e-9)) * scale;
    const [dx, dy] = [force[i] * shown, -force[j] * shown];
    const length = Math.hypot(dx, dy);
    if (length < 3) return;
    const [x, y] = this.projection.toScreen(tip);
    const [ux, uy] = [dx / length, dy / length];
    this.#stroke("force", 3.5);
    this.#line([x, y], [x + dx - ux * 8, y + dy - uy * 8]);
    const head = [[0, 0], [-11, 5.5], [-11, -5.5]];
    this.#path(head.map(([a, b]) => [x + dx + a * ux - b * uy, y + dy + a * uy + b * ux]));
    this.context.fillStyle = this.color("force");
    this.context.fill();
    const [width, height] = this.projection.size;
    const label = [clamp(x + dx + ux * 10 + 8, 8, width - 52), clamp(y + dy + uy * 10, 30, height - 26)];
    this.#text(`${size.toFixed(1)} N`, label, "force", "left", 600);
  }

  #at(x, y) {
    const point = [0, 0, 0];
    point[this.view.axes[0]] = x;
    point[this.view.axes[1]] = y;
    return this.projection.toScreen(point);
  }

  #stroke(name, width) {
    this.context.strokeStyle = this.color(name);
    this.context.lineWidth = width;
  }

  #line(from, to) {
    this.#path([from, to], false);
    this.context.stroke();
  }

  #path(points, close = true) {
    this.context.beginPath();
    points.forEach((point) => this.context.lineTo(...point));
    if (close) this.context.closePath();
  }

  #dot([x, y], radius, fill, edge = null) {
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    this.context.fillStyle = this.color(fill);
    this.context.fill();
    if (edge) {
      this.#stroke(edge, 2);
      this.context.stroke();
    }
  }

  #text(text, [x, y], name, align, weight = 400) {
    this.context.font = `${weight} 12px system-ui, sans-serif`;
    this.context.fillStyle = this.color(name);
    this.context.textAlign = align;
    this.context.lineJoin = "round";
    this.#stroke("panel", 3);
    this.context.strokeText(text, x, y);
    this.context.fillText(text, x, y);
  }
}

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/** A vector as wide as the base frame; a device with two coordinates lies in the plane z = 0. */
export const pad = (vector) => [...vector, 0, 0].slice(0, 3);
