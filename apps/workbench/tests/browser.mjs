// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A browser without window that does what a person does, over the DevTools protocol on pipes
// (--remote-debugging-pipe): what is typed and clicked goes the browser's own way.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const browserProgram = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"]
  .find((name) => spawnSync(name, ["--version"]).status === 0);

export const wait = (ms) => new Promise((done) => setTimeout(done, ms));

export class Browser {
  constructor() {
    this.profile = mkdtempSync(join(tmpdir(), "palmar-profile-"));
    this.child = spawn(browserProgram, [
      "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
      "--ignore-gpu-blocklist", "--hide-scrollbars", "--remote-debugging-pipe", "--no-first-run", "--disable-extensions",
      `--user-data-dir=${this.profile}`, "--lang=en", "about:blank",
    ], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    this.last = 0;
    this.waiting = new Map();
    this.listeners = [];
    let rest = "";
    this.child.stdio[4].setEncoding("utf8");
    this.child.stdio[4].on("data", (text) => {
      const parts = (rest + text).split("\0");
      rest = parts.pop();
      for (const part of parts) this.take(JSON.parse(part));
    });
  }

  take(message) {
    if (message.id && this.waiting.has(message.id)) {
      const { done, fail } = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      if (message.error) fail(new Error(message.error.message));
      else done(message.result);
    } else {
      for (const listen of this.listeners) listen(message);
    }
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.last;
    this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((done, fail) => this.waiting.set(id, { done, fail }));
  }

  async page(width = 1280, height = 720) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    for (const domain of ["Page", "Runtime", "Log"]) await page.send(`${domain}.enable`);
    await page.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    return page;
  }

  async close() {
    const isOver = new Promise((done) => this.child.once("exit", done));
    this.send("Browser.close").catch(() => {});
    await Promise.race([isOver, wait(3000).then(() => this.child.kill("SIGKILL"))]);
    await isOver;
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

export class Page {
  constructor(browser, session, target) {
    this.browser = browser;
    this.session = session;
    this.target = target;
    /// What the page complained of: exceptions, refused requests, errors of the console.
    this.complaints = [];
    browser.listeners.push((message) => {
      if (message.sessionId !== session) return;
      if (message.method === "Runtime.exceptionThrown") {
        const { exceptionDetails } = message.params;
        this.complaints.push(exceptionDetails.exception?.description ?? exceptionDetails.text);
      }
      if (message.method === "Log.entryAdded" && message.params.entry.level === "error") {
        this.complaints.push(`${message.params.entry.text} ${message.params.entry.url ?? ""}`);
      }
    });
  }
  send(method, params) {
    return this.browser.send(method, params, this.session);
  }
  async open(url) {
    const loaded = new Promise((done) => this.browser.listeners.push((message) => {
      if (message.sessionId === this.session && message.method === "Page.loadEventFired") done();
    }));
    await this.send("Page.navigate", { url });
    await loaded;
  }
  /// What an expression comes to; promises are waited for.
  async value(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate",
      { expression, awaitPromise: true, returnByValue: true, userGesture: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }
  /// Until an expression is true.
  async until(expression, ms = 30000) {
    const end = Date.now() + ms;
    while (Date.now() < end) {
      const value = await this.value(expression);
      if (value) return value;
      await wait(30);
    }
    throw new Error(`${expression} didn't become true within ${ms} ms; the page says: ` +
      `${await this.value("document.body.innerText.slice(0, 600)")} ${this.complaints.join("; ")}`);
  }
  /// What an expression comes to in the frame of the only page that has one, once `isThere` is content
  /// with it. A frame without an origin is a process, and so a target, of its own.
  async frameValue(expression, isThere, ms = 30000) {
    const end = Date.now() + ms;
    let value;
    while (Date.now() < end) {
      const { targetInfos } = await this.browser.send("Target.getTargets", { filter: [{ type: "iframe" }] });
      for (const { targetId } of targetInfos) {
        const { sessionId } = await this.browser.send("Target.attachToTarget", { targetId, flatten: true });
        const { result } = await this.browser.send("Runtime.evaluate", { expression, returnByValue: true }, sessionId);
        await this.browser.send("Target.detachFromTarget", { sessionId });
        value = result.value;
        if (isThere(value)) return value;
      }
      await wait(200);
    }
    throw new Error(`${expression} in the frame is ${value}`);
  }
  /// Questions of the page are answered by yes.
  acceptDialogs() {
    this.browser.listeners.push((message) => {
      if (message.sessionId === this.session && message.method === "Page.javascriptDialogOpening") void this.send("Page.handleJavaScriptDialog", { accept: true });
    });
  }
  async box(selector) {
    const box = await this.value(`(() => { const one = document.querySelector(${JSON.stringify(selector)});
      if (!one) return null; one.scrollIntoView({ block: "nearest" }); const b = one.getBoundingClientRect();
      return { x: b.x, y: b.y, width: b.width, height: b.height }; })()`);
    if (!box) throw new Error(`${selector} isn't there`);
    return box;
  }
  mouse(type, x, y, more = {}) {
    return this.send("Input.dispatchMouseEvent", { type, x, y, ...more });
  }
  async click(selector) {
    const box = await this.box(selector);
    const x = box.x + box.width / 2, y = box.y + box.height / 2;
    await this.mouse("mouseMoved", x, y);
    await this.mouse("mousePressed", x, y, { button: "left", clickCount: 1 });
    await this.mouse("mouseReleased", x, y, { button: "left", clickCount: 1 });
  }
  /// From one place to another in so many steps.
  async drag(from, to, steps = 10) {
    await this.mouse("mouseMoved", from[0], from[1]);
    await this.mouse("mousePressed", from[0], from[1], { button: "left", clickCount: 1 });
    for (let k = 1; k <= steps; ++k) {
      const share = k / steps;
      await this.mouse("mouseMoved", from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]), { button: "left", buttons: 1 });
    }
    await this.mouse("mouseReleased", to[0], to[1], { button: "left", clickCount: 1 });
  }
  async key(key, modifiers = 0, code = 0) {
    const params = { key, modifiers, windowsVirtualKeyCode: code || key.toUpperCase().charCodeAt(0), code: key.length === 1 ? `Key${key.toUpperCase()}` : key };
    // Enter presses a button by the character that it types.
    const down = key === "Enter" ? { type: "keyDown", text: "\r" } : { type: "rawKeyDown" };
    await this.send("Input.dispatchKeyEvent", { ...down, ...params });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", ...params });
  }
  /// Chooses or types what a form's field is to hold.
  async set(selector, value, events = ["input", "change"]) {
    const isThere = await this.value(`(() => { const one = document.querySelector(${JSON.stringify(selector)}); if (!one) return false;
      one.value = ${JSON.stringify(String(value))};
      for (const name of ${JSON.stringify(events)}) one.dispatchEvent(new Event(name, { bubbles: true })); return true; })()`);
    if (!isThere) throw new Error(`${selector} isn't there`);
  }
  async text(selector) {
    return this.value(`document.querySelector(${JSON.stringify(selector)})?.textContent ?? null`);
  }
  async picture(path) {
    const { data } = await this.send("Page.captureScreenshot", { format: "png" });
    const { writeFileSync } = await import("node:fs");
    writeFileSync(path, Buffer.from(data, "base64"));
  }
  async close() {
    await this.browser.send("Target.closeTarget", { targetId: this.target });
  }
}
