// The page's own arithmetic: where links are drawn, what of a wall is seen, what the chart keeps.

import assert from "node:assert/strict";
import { test } from "node:test";

import { chains, views } from "../../../api/hapticd_api/page/kinematics.js";
import { clipped, Projection } from "../../../api/hapticd_api/page/projection.js";
import { History, roundStep, Scope } from "../../../api/hapticd_api/page/scope.js";
import { charts } from "../../../api/hapticd_api/page/traces.js";
import { hull, silhouette } from "../../../api/hapticd_api/page/silhouette.js";
import { newWall } from "../../../api/hapticd_api/page/wall_form.js";
import { numbers, placed, remarks } from "../../../api/hapticd_api/page/wall_words.js";

const PHANTOM = { type: "phantom", l1_m: 0.14, l2_m: 0.14 };
const HHD = { type: "rhombus", l_m: 0.2 };
const SIDE = { axes: [0, 2], center: [0.14, 0.02], span: [0.36, 0.36] };

const tipOf = (kinematics, q) => chains(kinematics, q)[0].at(-1);

function near(actual, expected, tolerance = 1e-9) {
  actual.forEach((value, index) =>
    assert.ok(Math.abs(value - expected[index]) < tolerance, `${actual} is not ${expected}`),
  );
}

test("the drawn tip is where the rest pose has it", () => {
  near(tipOf(PHANTOM, [0, 0.9, 0.9]), [0.1967, 0, 0.0226], 1e-4);
  near(tipOf(HHD, [Math.PI / 6, (5 * Math.PI) / 6]), [0, 0.2, 0]);
});

test("every chain of a device ends at the same tip", () => {
  const [left, right] = chains(HHD, [0.3, 2.2]);
  near(left.at(-1), right.at(-1));
});

test("links keep their length in every pose", () => {
  for (const q of [[0, 0, 0], [0.7, 1.2, 0.4], [-1, -0.3, 0.5]]) {
    const [[base, elbow, tip]] = chains(PHANTOM, q);
    for (const [a, b] of [[base, elbow], [elbow, tip]]) {
      near([Math.hypot(...a.map((value, axis) => value - b[axis]))], [0.14]);
    }
  }
});

test("the rest pose lies inside every view of its device", () => {
  const poses = [[PHANTOM, [0, 0.9, 0.9]], [HHD, [Math.PI / 6, (5 * Math.PI) / 6]]];
  for (const [kinematics, q] of poses) {
    for (const view of views(kinematics)) {
      const [x, y] = new Projection(view, [400, 300]).toScreen(tipOf(kinematics, q));
      assert.ok(x > 0 && x < 400 && y > 0 && y < 300);
    }
  }
});

test("a dragged point comes back to its pixel and keeps what the view hides", () => {
  const projection = new Projection(SIDE, [400, 300]);
  const point = projection.toBase([123, 45], [9, 0.05, 9]);
  near(projection.toScreen(point), [123, 45]);
  assert.equal(point[1], 0.05);
});

test("up in the base frame is up on the screen", () => {
  const projection = new Projection(SIDE, [400, 300]);
  assert.ok(projection.toScreen([0, 0, 0.1])[1] < projection.toScreen([0, 0, 0])[1]);
});

test("a floor fills what lies below it", () => {
  const projection = new Projection(SIDE, [360, 360]);
  const floor = { point_m: [0, 0, 0.02], normal: [0, 0, 1] };
  const { polygon, edge } = projection.wall(floor, [0, 0, 0]);
  near(polygon.map(([, y]) => y).sort((a, b) => a - b), [180, 180, 360, 360]);
  near(edge.map(([, y]) => y), [180, 180]);
});

test("a wall across the view is cut where the tip is", () => {
  const projection = new Projection(SIDE, [360, 360]);
  const slanted = { point_m: [0.14, 0, 0], normal: [0.6, 0.8, 0] };
  const x = (tip) => projection.wall(slanted, tip).edge[0][0];
  // 0.6 x + 0.8 y = 0.084: three centimetres in y move the cut by four in x.
  near([x([0, 0, 0]) - x([0, 0.03, 0])], [40]);
});

test("a wall that faces the viewer is seen only by a tip inside it", () => {
  const projection = new Projection(SIDE, [360, 360]);
  const side = { point_m: [0, 0.05, 0], normal: [0, 1, 0] };
  assert.equal(projection.wall(side, [0, 0.1, 0]).polygon.length, 0);
  assert.equal(projection.wall(side, [0, 0.0, 0]).polygon.length, 4);
  assert.equal(projection.wall(side, [0, 0.0, 0]).edge, null);
});

test("clipping keeps all, nothing, or the solid part", () => {
  const square = [[0, 0], [1, 0], [1, 1], [0, 1]];
  assert.equal(clipped(square, [1, 0], 2).length, 4);
  assert.equal(clipped(square, [1, 0], -1).length, 0);
  near(clipped(square, [1, 0], 0.5).map(([x]) => x), [0, 0.5, 0.5, 0]);
});

test("the chart forgets the oldest samples and keeps the order of the rest", () => {
  const history = new History(1, 4);
  for (let n = 0; n < 7; n += 1) history.push(n, [10 * n]);
  const seen = [];
  history.since(4, (time, at) => seen.push([time, history.traces[0][at]]));
  assert.deepEqual(seen, [[4, 40], [5, 50], [6, 60]]);
});

test("a sample that is not finite leaves a gap", () => {
  const history = new History(2, 4);
  history.push(0, []);
  assert.ok(Number.isNaN(history.traces[1][0]));
});

test("axis steps are round numbers", () => {
  assert.equal(roundStep(10, 3), 5);
  assert.equal(roundStep(0.9, 3), 0.5);
  assert.equal(roundStep(30, 3), 10);
});

test("every chart makes one number for each of its labels", () => {
  const device = { dof: 2, twin: true, traits: ["brakes"] };
  const scalars = new Set(["contact_depth_m", "lateness_ns", "exchange_ns", "compute_ns"]);
  for (const { signals, labels, values } of charts(device)) {
    const tick = signals.map((name) => (scalars.has(name) ? 1 : [1, 2, 3]));
    assert.equal(values(tick).length, labels.length);
  }
});

test("a device without brakes or hand is not asked for them", () => {
  const shown = charts({ dof: 3, twin: false, traits: [] });
  assert.ok(!shown.some(({ title }) => title === "Brakes"));
  assert.ok(!shown.some(({ signals }) => signals.includes("hand_force_n")));
});

test("a new wall lies beyond the tip and takes a free name", () => {
  const wall = newWall(2, [0, 0.2], ["wall", "wall-2"]);
  assert.equal(wall.id, "wall-3");
  assert.deepEqual(wall.shape, { type: "plane", point_m: [-0, 0.22], normal: [0, -1] });
});

test("time without samples leaves a gap instead of a line", () => {
  const scope = new Scope({ getContext: () => null }, ["depth"], 1000);
  scope.push(1.0, [5]);
  scope.push(1.001, [6]);
  scope.push(3.0, [7]);
  const seen = [];
  scope.history.since(0, (_, at) => seen.push(scope.history.traces[0][at]));
  assert.deepEqual(seen, [5, 6, NaN, 7]);
});

const extent = (polygon) => [0, 1].map((axis) => {
  const values = polygon.map((point) => point[axis]);
  return Math.max(...values) - Math.min(...values);
});

test("every shape is drawn as large as it is, in every view", () => {
  const ball = { type: "sphere", center_m: [0.2, 0, 0.01], radius_m: 0.02 };
  near(extent(silhouette(ball, [0, 2])), [0.04, 0.04]);
  const rod = { type: "capsule", from_m: [0, 0, 0], to_m: [0.1, 0, 0], radius_m: 0.01 };
  near(extent(silhouette(rod, [0, 1])), [0.12, 0.02]);
  const block = { type: "box", center_m: [0, 0, 0], size_m: [0.1, 0.06, 0.02] };
  near(extent(silhouette(block, [0, 2])), [0.1, 0.02]);
  const half = Math.SQRT1_2;
  near(extent(silhouette({ ...block, orientation: [half, 0, 0, half] }, [0, 1])), [0.06, 0.1]);
});

test("a turned rectangle of a planar device is drawn turned", () => {
  const tile = { type: "box", center_m: [0, 0.2], size_m: [0.1, 0.04], angle_rad: Math.PI / 2 };
  near(extent(silhouette(tile, [0, 1])), [0.04, 0.1]);
});

test("the hull keeps the corners and drops what is inside", () => {
  const square = [[0, 0], [1, 0], [1, 1], [0, 1]];
  assert.deepEqual(hull([...square, [0.5, 0.5], [0.2, 0.7]]).sort(), [...square].sort());
});

test("a wall is told by its shape, law, friction and switches", () => {
  assert.equal(placed({ type: "plane", point_m: [0, 0, -0.02], normal: [0, 0, 1] }), "free where z > −20.0 mm");
  assert.equal(
    placed({ type: "sphere", center_m: [0.2, 0, 0], radius_m: 0.02, hollow: true }),
    "hollow sphere of 20.0 mm about (200.0, 0.0, 0.0) mm",
  );
  const law = { type: "spring", stiffness_n_per_m: 800, damping_n_s_per_m: 2, passivity: true, brake: null };
  assert.equal(remarks({ law, friction: { static: 0.4, kinetic: 0.3 } }), "spring · passivity · friction 0.4 / 0.3");
  assert.deepEqual(numbers(law), [
    { field: "stiffness_n_per_m", label: "stiffness, N/m", value: 800 },
    { field: "damping_n_s_per_m", label: "damping, N·s/m", value: 2 },
  ]);
});
