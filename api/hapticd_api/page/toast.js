// Says what went wrong, and what to do about it.

import { element } from "./dom.js";

const SHOWN_MS = 9000;

/** Shows a problem document. */
export function showProblem({ title, detail, hint }) {
  const toast = element("div", "", "toast");
  toast.append(element("strong", title), element("p", detail), element("p", hint));
  toast.addEventListener("click", () => toast.remove());
  document.getElementById("toasts").append(toast);
  setTimeout(() => toast.remove(), SHOWN_MS);
}

/** Runs an action of the person; a refusal is shown, and its answer is undefined. */
export async function attempt(action) {
  try {
    return await action();
  } catch (error) {
    if (!error.document) throw error;
    showProblem(error.document);
    return undefined;
  }
}
