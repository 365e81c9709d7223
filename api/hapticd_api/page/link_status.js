// Whether what the page shows is live; unmistakable when it is not.

export class LinkStatus {
  connected = false;
  #wasLive = false;
  #lostAt = 0;
  #retryAt = null;

  constructor(pill, banner) {
    this.pill = pill;
    this.banner = banner;
    setInterval(() => this.#tell(), 200);
  }

  live() {
    this.connected = this.#wasLive = true;
    this.banner.hidden = true;
    document.title = "hapticd";
    this.#pill("live", "Live");
  }

  latency(ms) {
    if (this.connected) this.#pill("live", `Live · ${ms < 10 ? ms.toFixed(1) : Math.round(ms)} ms`);
  }

  lost(retryAt) {
    if (this.connected || !this.#lostAt) this.#lostAt = performance.now();
    this.connected = false;
    this.#retryAt = retryAt;
    document.title = "⚠ not live · hapticd";
    this.#pill("dead", "Not live");
    this.#tell();
  }

  #tell() {
    if (this.connected || !this.#lostAt) return;
    const now = performance.now();
    const age = Math.round((now - this.#lostAt) / 1000);
    const wait_s = Math.max(0, (this.#retryAt - now) / 1000).toFixed(1);
    const next = this.#retryAt === null ? "Reload the page." : `Trying again in ${wait_s} s.`;
    const told = this.#wasLive
      ? `Everything below is ${age} s old, and the devices may be moving.`
      : "The daemon does not answer.";
    this.banner.querySelector("span").textContent = `${told} ${next}`;
    this.banner.hidden = false;
  }

  #pill(className, text) {
    this.pill.className = `pill ${className}`;
    this.pill.lastElementChild.textContent = text;
  }
}
