// One device on the page: its drawing, readings, buttons, chart and walls.

import { put } from "./api.js";
import { Chart } from "./chart.js";
import { copyOf, element, partsOf } from "./dom.js";
import { Drawing } from "./drawing.js";
import { Hand } from "./hand.js";
import { views } from "./kinematics.js";
import { notices } from "./notices.js";
import { answerPointer } from "./pointer.js";
import { attempt } from "./toast.js";
import { norm, written } from "./vector.js";
import { Walls } from "./walls.js";

const STATES = ["offline", "disabled", "enabled", "paused", "fault"];
const IDLE = {
  offline: "",
  disabled: "Disabled: walls give no force",
  paused: "Paused: walls give no force",
  fault: "Fault: walls give no force",
};
const SILENT_AFTER_MS = 700;
const CONTACT_FLAG = 32;
export const POSE_SIGNALS = [
  "state", "flags", "joint_position_rad", "tip_position_m", "setpoint_position_m", "tip_force_n",
  "contact_wall", "contact_depth_m", "stiffness_n_per_m", "hand_position_m",
];

export class DevicePanel {
  constructor(device, model, stream) {
    this.device = device;
    this.path = `/devices/${device.id}`;
    this.snapshot = device;
    this.root = copyOf("device");
    this.parts = partsOf(this.root);
    this.root.querySelector("h2").textContent = device.id;
    const kind = device.twin ? "twin" : device.driver;
    this.kind = `${device.model} · ${kind} · ${device.rate_hz / 1000} kHz`;
    this.drawings = views(model.kinematics).map((view) => this.#drawing(view, model));
    this.walls = new Walls(device, this.parts, {
      tip: () => this.pose?.tip.slice(0, device.dof),
      stiffness: () => this.pose?.stiffness ?? null,
      changed: () => (this.stale = true),
    });
    this.chart = new Chart(device, this.parts, stream);
    this.#wireButtons();
    this.#wirePointer(device.twin ? this.#hand() : null);
    stream.subscribe({ id: `${device.id}/pose`, device: device.id, signals: POSE_SIGNALS, rate_hz: 60 });
    this.show(device);
    this.walls.refresh();
  }

  #drawing(view, model) {
    const figure = element("div", "", "view");
    const canvas = element("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${this.device.id}, ${view.title.toLowerCase()} view`);
    figure.append(canvas, element("span", `${view.title} view`));
    this.parts.stage.append(figure);
    return new Drawing(canvas, view, model);
  }

  #wireButtons() {
    const { enable, pause, estop } = this.parts;
    const desire = (desired) => attempt(() => put(`${this.path}/state`, { desired }));
    enable.addEventListener("click", () => desire(this.state === "enabled" || this.state === "paused" ? "disabled" : "enabled"));
    pause.addEventListener("click", () => desire(this.state === "paused" ? "enabled" : "paused"));
    estop.addEventListener("click", () => attempt(() => put(`${this.path}/estop`)));
  }

  #wirePointer(hand) {
    this.parts.hand.hidden = !hand;
    this.parts.stage.classList.toggle("movable", hand !== null);
    for (const drawing of this.drawings) {
      answerPointer(drawing, {
        hand: () => hand && (hand.target ?? this.pose?.hand ?? null),
        moveHand: (point) => hand.follow(point),
        walls: () => this.walls.walls,
        moveWall: (wall, point_m, done) => this.walls.move(wall, point_m, done),
      });
    }
  }

  #hand() {
    const hand = new Hand(this.device.id, this.device.dof);
    this.parts.free.addEventListener("click", () => hand.tell({ type: "free" }));
    this.parts.stroke.addEventListener("click", () => {
      const { dof } = this.device;
      const center_m = (this.pose?.tip ?? [0, 0, 0]).slice(0, dof);
      const axis = dof === 3 ? [0, 0, 1] : [0, 1];
      hand.tell({ type: "stroke", center_m, axis, amplitude_m: dof === 3 ? 0.03 : 0.06, frequency_hz: 0.5 });
    });
    return hand;
  }

  /** Takes a telemetry frame of this device. */
  take(frame) {
    if (frame.sub === this.chart.id) {
      this.chart.take(frame);
    } else if (frame.sub === `${this.device.id}/pose`) {
      const { values } = frame;
      this.pose = {
        q: values.joint_position_rad,
        tip: values.tip_position_m,
        setPoint: values.setpoint_position_m,
        force: values.tip_force_n,
        depth: values.contact_depth_m,
        stiffness: values.stiffness_n_per_m,
        wall: values.contact_wall,
        inContact: (values.flags & CONTACT_FLAG) !== 0,
        hand: this.device.twin ? values.hand_position_m : null,
      };
      this.heardAt = performance.now();
      if (STATES[values.state] !== this.state) this.#showState(STATES[values.state]);
    }
    this.stale = true;
  }

  /** Takes the device as the daemon describes it. */
  show(snapshot) {
    const moved = snapshot.scene_revision !== this.snapshot.scene_revision;
    this.snapshot = snapshot;
    this.parts.notices.replaceChildren(...notices(snapshot));
    const { scheduling } = snapshot.health;
    this.parts.about.textContent = scheduling ? `${this.kind} · ${scheduling}` : this.kind;
    this.#showState(snapshot.state);
    if (moved) this.walls.refresh();
  }

  #showState(state) {
    this.state = state;
    const { estop } = this.snapshot.flags;
    const { parts } = this;
    parts.state.textContent = estop ? "E-stop" : state;
    parts.state.dataset.state = estop ? "stopped" : state;
    parts.idle.textContent = state === "enabled" ? "" : IDLE[state];
    const running = state === "enabled" || state === "paused";
    parts.enable.textContent = running ? "Disable" : "Enable";
    parts.enable.classList.toggle("primary", !running);
    parts.enable.disabled = state === "offline" || state === "fault" || estop;
    parts.pause.textContent = state === "paused" ? "Resume" : "Pause";
    parts.pause.disabled = !running;
    parts.estop.disabled = estop;
  }

  /** Draws what is new; says so when nothing is. */
  draw(connected) {
    const silent = performance.now() - (this.heardAt ?? 0) > SILENT_AFTER_MS;
    const dark = !connected || silent;
    this.root.classList.toggle("dark", dark);
    if (dark) this.parts.veil.textContent = connected ? this.#whySilent() : "Not live: connection lost";
    if (!this.stale) return;
    this.stale = false;
    const touched = this.pose?.inContact ? this.#touched() : null;
    for (const drawing of this.drawings) drawing.draw(this.pose, this.walls.walls, touched);
    this.chart.draw();
    this.walls.update(touched);
    if (this.pose) this.#showReadings(touched);
  }

  #whySilent() {
    if (!this.heardAt && this.snapshot.state !== "offline") return "Waiting for the first tick…";
    return `Offline. ${this.snapshot.health.why ?? "No ticks arrive."}`;
  }

  // The deepest wall the tip is in. The loop counts those that are on.
  #touched() {
    return this.walls.walls.filter(({ enabled }) => enabled)[this.pose.wall]?.id ?? null;
  }

  #showReadings(touched) {
    const { force, depth, stiffness, tip } = this.pose;
    const { parts } = this;
    parts.force.textContent = `${norm(force).toFixed(2)} N`;
    parts.depth.textContent = touched ? `${(depth * 1000).toFixed(2)} mm` : "–";
    parts.stiffness.textContent = `${(stiffness / 1000).toFixed(2)} N/mm`;
    parts.wall.textContent = touched ?? "nothing";
    parts.tip.textContent = tip.slice(0, this.device.dof).map((value) => written(value * 1000, 1)).join("   ");
  }
}
