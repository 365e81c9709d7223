// The HTTP API. Every refusal is a Problem with what to do about it.

export class Problem extends Error {
  constructor(document) {
    super(document.detail);
    this.document = document;
  }
}

const UNREACHABLE = {
  title: "The daemon does not answer",
  detail: "The request did not reach the daemon.",
  hint: "Check that hapticd is running; the page reconnects by itself.",
};

async function call(method, path, body) {
  const headers = body === undefined ? {} : { "Content-Type": "application/json" };
  let response;
  try {
    response = await fetch(`/api/v1${path}`, { method, headers, body: JSON.stringify(body) });
  } catch {
    throw new Problem(UNREACHABLE);
  }
  const document = await response.json().catch(() => UNREACHABLE);
  if (!response.ok) throw new Problem(document);
  return document;
}

export const get = (path) => call("GET", path);
export const put = (path, body) => call("PUT", path, body);
export const post = (path, body) => call("POST", path, body);
export const patch = (path, body) => call("PATCH", path, body);
export const remove = (path) => call("DELETE", path);
