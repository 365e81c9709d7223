// The live page: every device of the daemon, as it is now.

import { get, put } from "./api.js";
import { DevicePanel } from "./device_panel.js";
import { EventList } from "./events.js";
import { LinkStatus } from "./link_status.js";
import { Stream } from "./stream.js";
import { attempt } from "./toast.js";

const byId = (id) => document.getElementById(id);
const protocol = location.protocol === "https:" ? "wss:" : "ws:";
const stream = new Stream(`${protocol}//${location.host}/api/v1/stream`);
const link = new LinkStatus(byId("link"), byId("lost"));
const events = new EventList(byId("events"));
const panels = new Map();
let bootId = null;

async function build() {
  const { devices } = await get("/devices");
  const models = await Promise.all(devices.map(({ id }) => get(`/devices/${id}/model`)));
  devices.forEach((device, index) => panels.set(device.id, new DevicePanel(device, models[index], stream)));
  byId("devices").replaceChildren(...[...panels.values()].map(({ root }) => root));
}

// Called on every welcome: the first builds the page, later ones find it standing.
async function welcome({ daemon }) {
  if (bootId !== null && bootId !== daemon.boot_id) return location.reload();
  bootId = daemon.boot_id;
  link.live();
  if (!panels.size) await attempt(build);
  await attempt(() => events.catchUp());
}

function frame() {
  for (const panel of panels.values()) panel.draw(link.connected);
  requestAnimationFrame(frame);
}

stream.addEventListener("live", ({ detail }) => welcome(detail));
stream.addEventListener("lost", ({ detail }) => link.lost(detail.retryAt));
stream.addEventListener("latency", ({ detail }) => link.latency(detail.ms));
stream.addEventListener("data", ({ detail }) => panels.get(detail.sub.split("/")[0])?.take(detail));
stream.addEventListener("snapshot", ({ detail }) => panels.get(detail.device)?.show(detail.snapshot));
stream.addEventListener("event", ({ detail }) => events.add(detail.event));
byId("stop-all").addEventListener("click", () => attempt(() => put("/estop")));

stream.open();
requestAnimationFrame(frame);
