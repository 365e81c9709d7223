// The pointer in a drawing: takes a wall by its edge, or else the hand.

import { pad } from "./drawing.js";
import { dot, plus, times } from "./vector.js";

const GRAB_PX = 9;
const HAND_PX = 18;

/**
 * Makes a drawing answer to the pointer. `hand()` is where the hand is, null without one; `moveHand(point)` sends it;
 * `walls()` lists those shown; `moveWall(wall, point_m, done)` shows one at another place, and stores it when done.
 */
export function answerPointer(drawing, { hand, moveHand, walls, moveWall }) {
  const { canvas } = drawing;
  let held = null;

  const pixel = ({ clientX, clientY }) => {
    const box = canvas.getBoundingClientRect();
    return [clientX - box.left, clientY - box.top];
  };
  const wallAt = (at) => {
    const near = hand();
    if (near && distance(at, drawing.projection.toScreen(near)) < HAND_PX) return null;
    const tip = drawing.last?.[0]?.tip;
    const planes = walls().filter(({ shape }) => shape.type === "plane");
    return tip ? planes.find((wall) => isNear(at, edgeOf(drawing.projection, wall, tip))) : null;
  };
  const move = (event, done) => {
    const at = pixel(event);
    const point = drawing.projection.toBase(at, held.near);
    if (held.wall) moveWall(held.wall, along(held.wall.shape, point, held.near), done);
    else moveHand(point);
  };

  canvas.addEventListener("pointerdown", (event) => {
    const wall = wallAt(pixel(event));
    const near = wall ? pad(wall.shape.point_m) : hand();
    if (!near) return;
    held = { wall, near };
    canvas.setPointerCapture(event.pointerId);
    if (!wall) move(event, false);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (held) move(event, false);
    else canvas.style.cursor = wallAt(pixel(event)) ? "move" : "";
  });
  canvas.addEventListener("pointerup", (event) => {
    if (held?.wall) move(event, true);
    held = null;
  });
  canvas.addEventListener("pointercancel", () => (held = null));
}

/** The point of a plane, moved along its normal until the plane goes through `point`. */
function along({ point_m, normal }, point, near) {
  const moved = dot(normal, point) - dot(normal, near);
  return plus(point_m, times(normal, moved));
}

const edgeOf = (projection, { shape }, tip) =>
  projection.wall({ point_m: pad(shape.point_m), normal: pad(shape.normal) }, tip).edge;

const distance = ([x, y], [u, v]) => Math.hypot(x - u, y - v);

function isNear(at, edge) {
  if (!edge) return false;
  const [[x0, y0], [x1, y1]] = edge;
  const [dx, dy] = [x1 - x0, y1 - y0];
  return Math.abs((at[0] - x0) * dy - (at[1] - y0) * dx) / Math.hypot(dx, dy) < GRAB_PX;
}
