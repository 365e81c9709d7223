// What of a shape is seen in a view: its outline on the two coordinates of the base frame that the view shows.

const CORNERS = [-1, 1];
const ARC_POINTS = 48;

/** The outline of a sphere, box or capsule as a polygon of [across, up] in metres. */
export function silhouette(shape, [i, j]) {
  const seen = (point) => [point[i] ?? 0, point[j] ?? 0];
  switch (shape.type) {
    case "sphere":
      return circle(seen(shape.center_m), shape.radius_m);
    case "capsule":
      return hull([shape.from_m, shape.to_m].flatMap((end) => circle(seen(end), shape.radius_m)));
    default:
      return hull(corners(shape).map(seen));
  }
}

function circle([x, y], radius) {
  return Array.from({ length: ARC_POINTS }, (_, n) => {
    const angle = (2 * Math.PI * n) / ARC_POINTS;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
  });
}

function corners({ center_m, size_m, orientation, angle_rad }) {
  const half = angle_rad / 2;
  const turn = rotation(orientation ?? (angle_rad ? [Math.cos(half), 0, 0, Math.sin(half)] : [1, 0, 0, 0]));
  const [x, y, z] = [0, 1, 2].map((axis) => (size_m[axis] ?? 0) / 2);
  return CORNERS.flatMap((a) =>
    CORNERS.flatMap((b) =>
      CORNERS.map((c) => turn([a * x, b * y, c * z]).map((offset, axis) => (center_m[axis] ?? 0) + offset)),
    ),
  );
}

/** The rotation of a unit quaternion: v + 2w (u × v) + 2u × (u × v). */
function rotation([w, ...u]) {
  return (v) => {
    const once = cross(u, v);
    const twice = cross(u, once);
    return v.map((value, axis) => value + 2 * w * once[axis] + 2 * twice[axis]);
  };
}

const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];

/** The convex hull of points (Andrew's monotone chain), anticlockwise. */
export function hull(points) {
  const sorted = [...points].sort(([a, b], [c, d]) => a - c || b - d);
  return [...chain(sorted), ...chain(sorted.reverse())];
}

function chain(points) {
  const kept = [];
  for (const point of points) {
    while (kept.length > 1 && turn(kept.at(-2), kept.at(-1), point) <= 0) kept.pop();
    kept.push(point);
  }
  return kept.slice(0, -1);
}

const turn = ([ax, ay], [bx, by], [cx, cy]) => (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
