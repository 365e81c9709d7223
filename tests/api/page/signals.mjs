// Prints every signal the page subscribes to, for the test that compares them with the tick record.

import { POSE_SIGNALS } from "../../../api/hapticd_api/page/device_panel.js";
import { charts } from "../../../api/hapticd_api/page/traces.js";

const shown = charts({ dof: 3, twin: true, traits: ["brakes"] });
console.log(JSON.stringify([...POSE_SIGNALS, ...shown.flatMap(({ signals }) => signals)]));
