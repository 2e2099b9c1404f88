// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// `palmar serve` for tests in a browser, in a folder of its own that is also the user's data folder.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export class Bench {
  folder = mkdtempSync(join(tmpdir(), "palmar-bench-"));
  servers = [];

  constructor(palmar) {
    this.palmar = palmar;
    for (const name of ["serve", "stop", "end"]) this[name] = this[name].bind(this);
  }

  /// `palmar serve` with its address, and the time until it was printed.
  async serve(words = []) {
    const start = Date.now();
    const child = spawn(this.palmar, ["serve", "--no-browser", "--quiet", ...words], {
      cwd: this.folder, stdio: ["ignore", "pipe", "inherit"], env: { ...process.env, XDG_DATA_HOME: join(this.folder, "data") },
    });
    this.servers.push(child);
    const url = await new Promise((done, fail) => {
      child.stdout.once("data", (text) => done(String(text).split("\n")[0]));
      child.once("exit", (code) => fail(new Error(`palmar serve ended with ${code}`)));
    });
    return { child, url, ms: Date.now() - start };
  }

  async stop(server, signal = "SIGINT") {
    const start = Date.now();
    const isOver = new Promise((done) => server.child.once("exit", done));
    server.child.kill(signal);
    const code = await isOver;
    return { ms: Date.now() - start, code };
  }

  end() {
    for (const child of this.servers) if (child.exitCode === null) child.kill("SIGKILL");
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

/// A file put into the page as if it had been chosen.
export async function choose(page, path) {
  const { root } = await page.send("DOM.getDocument");
  const { nodeId } = await page.send("DOM.querySelector", { nodeId: root.nodeId, selector: "input[type=file]" });
  await page.send("DOM.setFileInputFiles", { nodeId, files: [path] });
}

/// Texts with too little contrast (WCAG 2.1, AA: 4.5 to 1), and controls without a name.
export const contrasts = `(() => {
  for (const one of document.querySelectorAll("details")) one.open = true;
  const channels = (colour) => colour.match(/[\\d.]+/g).map(Number);
  const light = (c) => c.slice(0, 3).map((v) => (v /= 255) <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = (one) => { for (; one; one = one.parentElement) { const c = channels(getComputedStyle(one).backgroundColor); if (c.length < 4 || c[3] === 1) return c; } return [255, 255, 255]; };
  let seen = 0; const poor = [];
  for (const one of document.querySelectorAll("body *")) {
    if (one.closest("svg,.unseen,:disabled,[aria-hidden=true]") || !one.checkVisibility() || ![...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim())) continue;
    const a = light(channels(getComputedStyle(one).color)), b = light(behind(one)), ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    ++seen;
    if (ratio < 4.5) poor.push(one.tagName + "." + one.className + " " + ratio.toFixed(2) + " " + one.textContent.slice(0, 30));
  }
  const nameless = [...document.querySelectorAll("button,input,select")].filter((one) => one.checkVisibility() && !one.closest("[aria-hidden]") &&
    !(one.getAttribute("aria-label") || one.textContent.trim() || one.labels?.length)).map((one) => one.outerHTML.slice(0, 80));
  return { seen, poor, nameless };
})()`;
