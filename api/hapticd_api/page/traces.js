// What the strip chart can show: which signals it needs, and the traces made of them.

import { norm, times } from "./vector.js";

const JOINTS = ["joint 1", "joint 2", "joint 3"];
const AXES = ["x", "y", "z"];
const MM_PER_M = 1000;
const US_PER_NS = 0.001;

/**
 * The charts for a device: `values` makes one number per label from one tick's signals, `atLeast` is the range
 * that is always shown.
 */
export function charts({ dof, twin, traits }) {
  const all = [
    {
      title: "Force",
      unit: "N",
      atLeast: [0, 1],
      signals: ["tip_force_n", "tip_force_command_n", ...(twin ? ["hand_force_n"] : [])],
      labels: ["of the device", "motor command", ...(twin ? ["of the hand"] : [])],
      values: (tick) => tick.map(norm),
    },
    {
      title: "Penetration",
      unit: "mm",
      atLeast: [0, 1],
      signals: ["contact_depth_m"],
      labels: ["depth in the deepest wall"],
      values: (tick) => times(tick, MM_PER_M),
    },
    {
      title: "Position",
      unit: "mm",
      signals: ["tip_position_m"],
      labels: AXES.slice(0, dof),
      values: ([tip]) => times(tip.slice(0, dof), MM_PER_M),
    },
    {
      title: "Motors",
      unit: "N·m",
      signals: ["motor_torque_estimate_nm"],
      labels: JOINTS.slice(0, dof),
      values: ([torque]) => torque.slice(0, dof),
    },
    {
      title: "Brakes",
      unit: "N·m",
      signals: ["brake_torque_nm"],
      labels: JOINTS.slice(0, dof),
      values: ([torque]) => torque.slice(0, dof),
      needs: "brakes",
    },
    {
      title: "Timing",
      unit: "µs",
      atLeast: [0, 100],
      signals: ["lateness_ns", "exchange_ns", "compute_ns"],
      labels: ["late", "exchange", "compute"],
      values: (tick) => times(tick, US_PER_NS),
    },
  ];
  return all.filter(({ needs }) => !needs || traits.includes(needs));
}
