// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the workbench keeps, and what takes minutes, in a real browser: node bench_jobs_browser_test.mjs
// PALMAR [--designs] [--pictures FOLDER] does what a person does: recent projects and their steps after the
// server was killed; a small study, loaded again in the middle, stopped, gone on with, its dots. --designs:
// instead compares designs and has a better shape pressed. --pictures: leaves the pictures of the documents
// there. Ends with 77 where no browser is found.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { Bench, choose, contrasts } from "./bench_server.mjs";
import { Browser, browserProgram, wait } from "./browser.mjs";

const palmar = resolve(process.argv[2]);
const isDesigns = process.argv.includes("--designs");
const pictures = process.argv.includes("--pictures") ? resolve(process.argv[process.argv.indexOf("--pictures") + 1]) : null;
if (!browserProgram) {
  console.log("skipped: no browser (chromium, google-chrome) is installed");
  process.exit(77);
}
const { folder, serve, stop, end } = new Bench(palmar);

const bench = "document.querySelector('.bench')";
const rests = `${bench}?.dataset.field === 'rest' && ${bench}.dataset.working === 'false'`;
const job = "document.querySelector('.job')";
const stands = (...states) => `${JSON.stringify(states)}.includes(${job}?.dataset.state)`;
const startPage = "document.querySelector('[data-example]') !== null";
const figures = async (page) => page.value("[...document.querySelectorAll('[data-figure]')].map((one) => one.textContent)");
const minutes = 60000; // ms; generous, for machines that are busy

async function snap(page, name) {
  if (!pictures) return;
  mkdirSync(pictures, { recursive: true });
  await wait(300);
  await page.picture(join(pictures, `${name}.png`));
}

async function after(page, act) {
  const before = Number(await page.value(`${bench}.dataset.results ?? 0`));
  await act();
  await page.until(`Number(${bench}.dataset.results) > ${before} && ${bench}.dataset.working === 'false'`, minutes);
}

/// Projects are kept by themselves; after the server was killed they are there with their steps.
async function recentProjects(page, server) {
  await page.open(server.url);
  await page.until(startPage);
  assert.equal(await page.value("document.querySelector('[data-recent]')"), null);
  await page.click("[data-example=ball]");
  await page.until(rests, minutes);
  for (const force of [30, 40]) await after(page, () => page.set(".force input[type=number]", force, ["change"]));
  const left = await figures(page);
  assert.equal(await page.value("document.querySelectorAll('.steps button img').length"), 3);
  await page.until(`Number(${bench}.dataset.kept) >= 3`);
  // To a step by its picture, and by the keyboard back to where one was.
  await after(page, () => page.click("[data-step='1']"));
  assert.match(await page.value("document.querySelector('.force input[type=number]').value"), /^30$/);
  await after(page, () => page.key("z", 10));
  assert.deepEqual(await figures(page), left);
  await page.until(`Number(${bench}.dataset.kept) >= 5`);
  await stop(server, "SIGKILL");
  await page.until("document.querySelector('.lost').checkVisibility()");

  const again = await serve();
  await page.open(again.url);
  await page.until("document.querySelector('[data-recent] img') !== null");
  await page.click("[data-recent]");
  await page.until(rests, minutes);
  assert.deepEqual(await figures(page), left, "the server was killed and started again");
  await after(page, () => page.key("z", 2));
  await after(page, () => page.key("z", 2));
  assert.equal(await page.value("document.querySelector('.usual input').checked"), true, "back to the first step");
  // Two tabs with one project don't hurt it.
  const second = await browser.page();
  await second.open(again.url);
  await second.until("document.querySelector('[data-recent]') !== null");
  await second.click("[data-recent]");
  await second.until(rests, minutes);
  await second.close();
  // Nor do two servers: what was done last is kept, and both go on.
  const beside = await serve();
  const third = await browser.page();
  await third.open(beside.url);
  await third.until("document.querySelector('[data-recent]') !== null");
  await third.click("[data-recent]");
  await third.until(rests, minutes);
  await after(third, () => third.set(".force input[type=number]", 55, ["change"]));
  await third.until(`Number(${bench}.dataset.kept) >= 1`);
  await after(page, () => page.set(".force input[type=number]", 65, ["change"]));
  const kept = Number(await page.value(`${bench}.dataset.kept`));
  await page.until(`Number(${bench}.dataset.kept) >= ${Math.max(1, kept)}`);
  await wait(1500);
  await third.send("Page.reload");
  await third.until(rests, minutes);
  await third.click(".top button");
  await third.until("document.querySelectorAll('[data-recent]').length === 1");
  await third.click("[data-recent]");
  await third.until(rests, minutes);
  assert.match(await third.value("document.querySelector('.force input[type=number]').value"), /^(55|65)$/);
  await third.close();
  await stop(beside);
  await page.click(".top button");
  await page.until("document.querySelectorAll('[data-recent]').length === 1");
  return again;
}

/// A study of two designs: its time is estimated, it runs, is loaded again, stopped, gone on with.
async function smallStudy(page, server) {
  await page.click("[data-new=study]");
  await page.until("document.querySelector('.job-form') !== null");
  assert.equal(await page.value("document.querySelector('.job-form [type=submit]').disabled"), true);
  writeFileSync(join(folder, "broken.stl"), "solid broken\nthis is no facet\n");
  await choose(page, join(folder, "broken.stl"));
  await page.until("/broken\\.stl/.test(document.querySelector('.message').textContent)");
  for (const one of ["example/round-handle", "example/edged-handle"]) {
    const before = await page.value("document.querySelectorAll('.designs strong').length");
    await page.set("[data-more]", one, ["change"]);
    await page.until(`document.querySelectorAll('.designs strong').length === ${before + 1}`);
  }
  await page.set("[name=population]", "women", ["change"]);
  await page.set("[name=hands]", 6);
  await snap(page, "workbench-study-form");
  await page.click(".job-form [type=submit]");
  await page.until(stands("new"), minutes);
  assert.match(await page.text(".status"), /^12 grasps: about \d+ (s|min) on this computer\.$/);
  await page.click("[data-job-act=start]");
  await page.until(`${stands("running")} && document.querySelector('progress').value > 0.05`, minutes);
  await snap(page, "workbench-study-running");
  await page.send("Page.reload");
  await page.until(stands("running", "done"), minutes);
  if (await page.value(stands("running"))) await page.click("[data-job-act=cancel]");
  await page.until(stands("stopped", "done"), minutes);
  assert.equal(await page.value(`${job}.dataset.state`), "stopped", "it was done before it could be stopped");
  assert.match(await page.text(".status"), /goes on from there/);

  // Killed and started again, it goes on where it was.
  await stop(server, "SIGKILL");
  const again = await serve();
  await page.open(again.url);
  await page.until("document.querySelector('[data-job]') !== null");
  assert.match(await page.text("[data-job]"), /round-handle, edged-handle.*stopped/);
  await page.click("[data-job]");
  await page.until(stands("stopped"));
  await page.click("[data-job-act=start]");
  // The live channel goes on meanwhile.
  const other = await browser.page();
  await other.open(again.url);
  await other.until(startPage);
  await other.click("[data-example=ball]");
  await other.until(rests, minutes);
  await other.close();
  await page.until(stands("done", "failed"), 5 * minutes);
  assert.equal(await page.value(`${job}.dataset.state`), "done", await page.text(".status"));

  // The same as on the command line.
  const stores = readdirSync(join(folder, "data/palmar/jobs")).map((key) => join(folder, "data/palmar/jobs", key, "study.palmar"));
  assert.ok(existsSync(stores[0]));
  const compared = JSON.parse(execFileSync(palmar, ["study", "compare", stores[0], "--json", "--quiet"], { encoding: "utf8" }));
  const said = JSON.stringify(compared);
  await page.until("document.querySelectorAll('.dot').length === 12");
  const means = await page.value("[...document.querySelectorAll('.dot-table tbody td:nth-child(3)')].map((one) => parseFloat(one.textContent))");
  assert.equal(means.length, 2);
  const listed = (said.match(/"mean":[\d.]+/g) ?? []).map((one) => Number(one.slice(7)));
  for (const mean of means) assert.ok(listed.some((one) => Math.abs(one - mean) < 0.006 * mean), `${mean} is none of ${listed.join(" ")}`);
  // Long hands alone; a click on a dot opens that hand in the report.
  const longest = Number(await page.value("document.querySelector('[data-dots=high]').value"));
  await page.set("[data-dots=low]", longest - 3, ["change"]);
  const few = Number(await page.value("document.querySelectorAll('.dot').length"));
  assert.ok(few >= 2 && few < 12, `${few} dots`);
  await page.click(".dot[data-of='1']");
  await page.until("document.querySelector('.dot.is-open') !== null");
  const shown = await page.frameValue("document.querySelector('#turn [data-palmar-scene]')?.dataset.shown", (value) => /^1\/\d+$/.test(value ?? ""), minutes);
  assert.match(shown, /^1\/\d+$/);
  await page.set("[data-dots=low]", await page.value("document.querySelector('[data-dots=low]').min"), ["change"]);
  await page.until("document.querySelectorAll('.dot').length === 12");
  await snap(page, "workbench-study");
  const looked = await page.value(contrasts);
  assert.deepEqual(looked.poor, []);
  assert.deepEqual(looked.nameless, []);
  return again;
}

/// Two designs side by side in one hand.
async function comparison(page) {
  await page.click("[data-new=compare]");
  await page.until("document.querySelector('.job-form') !== null");
  for (const one of ["example/round-handle", "example/edged-handle"]) {
    const before = await page.value("document.querySelectorAll('.designs strong').length");
    await page.set("[data-more]", one, ["change"]);
    await page.until(`document.querySelectorAll('.designs strong').length === ${before + 1}`);
  }
  await page.click(".job-form [type=submit]");
  await page.until(stands("done", "failed"), 3 * minutes);
  assert.equal(await page.value(`${job}.dataset.state`), "done", await page.text(".status"));
  const answer = await page.frameValue("document.querySelector('#answer')?.textContent", (value) => /edged-handle/.test(value ?? ""), minutes);
  assert.match(answer, /round-handle/);
  assert.match(await page.text(".files"), /assessment\.json/);
  await page.frameValue("document.readyState", (value) => value === "complete", minutes);
  await snap(page, "workbench-compare");
  // Nothing of the page round it can be reached from the report.
  assert.equal(await page.frameValue("(() => { try { return String(window.parent.document.title); } catch { return 'refused'; } })()", () => true, minutes), "refused");
}

/// A better shape: the same hands hold both, and the shape is there as a file.
async function redesign(page) {
  await page.click(".top button");
  await page.until(startPage);
  await page.click("[data-new=redesign]");
  await page.until("document.querySelector('.job-form') !== null");
  await page.set("[data-more]", "example/edged-handle", ["change"]);
  await page.until("document.querySelectorAll('.designs strong').length === 1");
  await page.set("[name=verb]", "fillet", ["change"]);
  assert.equal(await page.value("document.querySelector('[name=low]').checkVisibility() && !document.querySelector('[name=depth]').checkVisibility()"), true);
  await page.set("[name=verb]", "press", ["change"]);
  await page.set("[name=depth]", "3");
  await page.set("[name=population]", "range", ["change"]);
  assert.equal(await page.value("document.querySelector('[name=hands]').checkVisibility()"), false, "as many as were named");
  await snap(page, "workbench-redesign-form");
  await page.click(".job-form [type=submit]");
  // First the shape, to be looked at.
  await page.until(stands("new", "failed"), 5 * minutes);
  assert.equal(await page.value(`${job}.dataset.state`), "new", await page.text(".status"));
  await page.until("document.querySelector('.shape')?.dataset.ready === 'true'", minutes);
  const most = Number(await page.value("document.querySelector('.shape').dataset.most"));
  assert.ok(most > 0.2 && most < 3.01, `pressed by ${most} mm; at most 3 was asked for`);
  await page.click("[data-shape=both]");
  await snap(page, "workbench-redesign-preview");
  // Changed, it is looked at anew: a smaller depth.
  await page.click("[data-job-act=change]");
  await page.until("document.querySelector('.designs strong') !== null");
  assert.equal(await page.value("document.querySelector('[name=depth]').value"), "3");
  await page.set("[name=depth]", "1");
  await page.click(".job-form [type=submit]");
  await page.until(`${stands("new", "failed")} && document.querySelector('.shape')?.dataset.ready === 'true'`, 5 * minutes);
  const less = Number(await page.value("document.querySelector('.shape').dataset.most"));
  assert.ok(less > 0.2 && less < 1.01, `pressed by ${less} mm; at most 1 was asked for`);
  await page.click("[data-job-act=start]");
  await page.until(stands("done", "failed"), 5 * minutes);
  assert.equal(await page.value(`${job}.dataset.state`), "done", await page.text(".status"));
  assert.match(await page.text(".files"), /pressed\.stl/);
  const answer = await page.frameValue("document.querySelector('#answer')?.textContent", (value) => /pressed/.test(value ?? ""), minutes);
  assert.match(answer, /edged-handle/);
  await snap(page, "workbench-redesign");
  await page.click("[data-on-bench='pressed.stl']");
  await page.until(rests, minutes);
  assert.match(await page.text(".title"), /pressed\.stl/);
}

/// A CAD file with rounder edges: shown before it is run, and the solid that comes out is what it says.
async function stepOut(page) {
  execFileSync(palmar, ["product", "make", "prism", "--width-mm", "40", "--depth-mm", "30", "--length-mm", "130", "--fillet-mm", "0", "--out", "bar.step", "--quiet"], { cwd: folder });
  await page.click(".top button");
  await page.until(startPage);
  await page.click("[data-new=redesign]");
  await page.until("document.querySelector('.job-form') !== null");
  await choose(page, join(folder, "bar.step"));
  await page.until("document.querySelectorAll('.designs strong').length === 1", minutes);
  await page.set("[name=verb]", "features", ["change"]);
  await page.set("[name=vary]", "fillet:long=6");
  await page.set("[name=population]", "range", ["change"]);
  await page.click(".job-form [type=submit]");
  await page.until(`${stands("new", "failed")} && document.querySelector('.shape')?.dataset.ready === 'true'`, 5 * minutes);
  // A sharp edge that gets the radius r goes back by (sqrt 2 - 1) r; the new surface lies (1 - 1 / sqrt 2) r deep.
  const most = Number(await page.value("document.querySelector('.shape').dataset.most"));
  assert.ok(Math.abs(most - 6 * (1 - Math.SQRT1_2)) < 0.15, `${most} mm`);
  await snap(page, "workbench-redesign-step");
  await page.click("[data-job-act=start]");
  await page.until(stands("done", "failed"), 5 * minutes);
  assert.equal(await page.value(`${job}.dataset.state`), "done", await page.text(".status"));
  const text = await page.value("fetch([...document.querySelectorAll('.files a')].find((one) => one.download === 'redesign.step').href).then((answer) => answer.text())");
  writeFileSync(join(folder, "redesign.step"), text);
  const info = JSON.parse(execFileSync(palmar, ["product", "info", "redesign.step", "--json", "--quiet"], { cwd: folder, encoding: "utf8", maxBuffer: 1 << 28 }));
  const volume = info.volume_mm3 ?? info.volume_ml * 1000;
  const truth = (40 * 30 - (4 - Math.PI) * 36) * 130; // mm^3
  assert.ok(Math.abs(volume - truth) < 0.003 * truth, `${volume} mm^3; a bar with edges of 6 mm has ${truth}`);
}

const browser = new Browser();
const begun = Date.now();
try {
  // What is wrong with a product that is given is said before there is an address.
  writeFileSync(join(folder, "empty.stl"), "");
  const empty = spawnSync(palmar, ["serve", "--no-browser", "empty.stl"], { cwd: folder, encoding: "utf8", timeout: 20000 });
  assert.deepEqual([empty.status, empty.stdout, empty.stderr], [3, "", "palmar: empty.stl: is empty (0 bytes)\n"]);
  let server = await serve();
  const page = await browser.page();
  page.acceptDialogs();
  if (isDesigns) {
    await page.open(server.url);
    await page.until(startPage);
    await comparison(page);
    await redesign(page);
    await stepOut(page);
  } else {
    server = await recentProjects(page, server);
    server = await smallStudy(page, server);
  }
  assert.deepEqual(page.complaints.filter((one) => !/4(04|09|22)|ERR_CONNECTION|WebSocket|Failed to fetch/.test(one)), []);
  await stop(server);
  console.log(`done in ${((Date.now() - begun) / 1000).toFixed(1)} s`);
} finally {
  await browser.close();
  end();
}
