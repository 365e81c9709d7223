// Where the links of a device are, from its joint angles. Metres and radians, base frame.

// PHANTOM: base rotation q1; q2 and q3 are both measured against the base (parallelogram).
function phantom({ l1_m, l2_m }, [q1, q2, q3]) {
  const outwards = (r, z) => [r * Math.cos(q1), r * Math.sin(q1), z];
  const shoulder = [0, 0, 0];
  const elbow = outwards(l1_m * Math.cos(q2), l1_m * Math.sin(q2));
  const tip = outwards(
    l1_m * Math.cos(q2) + l2_m * Math.sin(q3),
    l1_m * Math.sin(q2) - l2_m * Math.cos(q3),
  );
  return [[shoulder, elbow, tip]];
}

// HHD: two coaxial joints and four equal links, a rhombus.
function rhombus({ l_m }, [theta1, theta2]) {
  const at = (angle) => [l_m * Math.cos(angle), l_m * Math.sin(angle), 0];
  const base = [0, 0, 0];
  const [a, b] = [at(theta1), at(theta2)];
  const tip = [a[0] + b[0], a[1] + b[1], 0];
  return [
    [base, a, tip],
    [base, b, tip],
  ];
}

const LINKAGES = { phantom, rhombus };

/** The chains of points that a device's links join, from base to tip. */
export function chains(kinematics, q) {
  return LINKAGES[kinematics.type](kinematics, q);
}

const VIEWS = {
  phantom: [
    { title: "Side", axes: [0, 2], center: [0.14, 0.02], span: [0.36, 0.36] },
    { title: "Top", axes: [0, 1], center: [0.14, 0], span: [0.36, 0.36] },
  ],
  rhombus: [{ title: "Top", axes: [0, 1], center: [0, 0.17], span: [0.72, 0.48] }],
};

/** The views in which a device is drawn: coordinates across and up, their middle and extent in metres. */
export function views(kinematics) {
  return VIEWS[kinematics.type];
}
