// What keeps a device from rendering, and what to do about it.

import { remove } from "./api.js";
import { element } from "./dom.js";
import { attempt } from "./toast.js";

// Said by a notice of their own, or of no use to a person who wants to enable.
const TOLD_OTHERWISE = new Set(["offline", "estop-latched", "fault-latched", "not-enabled"]);

/** The notices for a device as its snapshot has it. */
export function notices(snapshot) {
  const path = `/devices/${snapshot.id}`;
  const found = snapshot.faults.map(({ id, cause, cure }) =>
    notice(`Fault: ${id}`, `${cause} ${cure}`, {
      text: "Acknowledge",
      act: () => remove(`${path}/faults/${id}`),
    }),
  );
  if (found.length > 1) {
    found.push(
      notice(`${found.length} faults`, "Cure each as it says. One may have caused the others.", {
        text: "Acknowledge all",
        act: () => Promise.all(snapshot.faults.map(({ id }) => remove(`${path}/faults/${id}`))),
      }),
    );
  }
  if (snapshot.flags.estop) {
    found.unshift(
      notice("E-stop engaged", "All outputs are zero. Make the device safe, then acknowledge.", {
        text: "Acknowledge",
        act: () => remove(`${path}/estop`),
      }),
    );
  }
  for (const { id, ok, why, cure } of snapshot.interlocks) {
    if (!ok && !TOLD_OTHERWISE.has(id) && snapshot.state !== "offline") {
      found.push(notice(`Cannot be enabled: ${id}`, `${why} ${cure}`, null, "mild"));
    }
  }
  return found;
}

function notice(title, text, action, className = "") {
  const made = element("div", "", `notice ${className}`);
  const words = element("p");
  words.append(element("strong", title), text);
  made.append(words);
  if (action) {
    const button = element("button", action.text);
    button.type = "button";
    button.addEventListener("click", () => attempt(action.act));
    made.append(button);
  }
  return made;
}
