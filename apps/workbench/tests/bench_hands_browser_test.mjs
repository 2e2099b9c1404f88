// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A person's hand on the workbench, in a real browser: node bench_hands_browser_test.mjs PALMAR [--scan]
// [--mri] [--pictures FOLDER] makes a hand of a photograph of a person that doesn't exist, corrects it, holds a
// product in it and compares what the page shows with what the command line says. --scan: a scan with creases
// and dots instead, one of which is dragged elsewhere; --mri: MR images, in which two bones change names.
// Ends with 77 where no browser is found.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { Bench, contrasts } from "./bench_server.mjs";
import { Browser, browserProgram, wait } from "./browser.mjs";

const palmar = resolve(process.argv[2]);
const pictures = process.argv.includes("--pictures") ? resolve(process.argv[process.argv.indexOf("--pictures") + 1]) : null;
if (!browserProgram) {
  console.log("skipped: no browser (chromium, google-chrome) is installed");
  process.exit(77);
}
const { folder, serve, stop, end } = new Bench(palmar);

const job = "document.querySelector('.job')";
const stands = (...states) => `${JSON.stringify(states)}.includes(${job}?.dataset.state)`;
const bench = "document.querySelector('.bench')";
const minutes = 60000; // ms
const run = (words) => execFileSync(palmar, [...words, "--quiet"], { cwd: folder, encoding: "utf8", maxBuffer: 1 << 28 });
const jobFolder = () => join(folder, "data/palmar/jobs", readdirSync(join(folder, "data/palmar/jobs"))[0]);

async function snap(page, name) {
  if (!pictures) return;
  mkdirSync(pictures, { recursive: true });
  await wait(500);
  await page.picture(join(pictures, `${name}.png`));
}

async function choose(page, selector, files) {
  const { root } = await page.send("DOM.getDocument");
  const { nodeId } = await page.send("DOM.querySelector", { nodeId: root.nodeId, selector });
  await page.send("DOM.setFileInputFiles", { nodeId, files });
}

async function openForm(page, server, method) {
  await page.open(server.url);
  await newHand(page, method);
}

async function newHand(page, method) {
  await page.until("document.querySelector('[data-new=hand]') !== null");
  await page.click("[data-new=hand]");
  await page.until("document.querySelector('.hand-form') !== null");
  await page.click(`[name=method][value=${method}]`);
  await page.set("[name=name]", "anna");
}

async function make(page, ms) {
  await page.click(".hand-form [type=submit]");
  await page.until(stands("done", "failed"), ms);
  assert.equal(await page.value(`${job}.dataset.state`), "done", await page.text(".status"));
  await page.until("document.querySelector('.found')?.dataset.ready !== undefined", minutes);
}

/// With what was corrected; until it is done again.
async function makeAgain(page, ms, state = "done") {
  await page.click("[data-found=again]");
  await page.until(stands("waiting", "running"), minutes);
  await page.until(stands("done", "failed"), ms);
  assert.equal(await page.value(`${job}.dataset.state`), state, await page.text(".status"));
  await page.until("document.querySelector('.found')?.dataset.ready !== undefined", minutes);
}

/// The file of the person as the page lists it, and the command that takes it.
async function whatIsKnown(page) {
  await page.until("document.querySelector('.files a[download=\"person.toml\"]') !== null");
  const toml = await page.value("fetch(document.querySelector('.files a[download=\"person.toml\"]').href).then((one) => one.text())");
  assert.equal(toml, readFileSync(join(jobFolder(), "person.toml"), "utf8"));
  const command = await page.text(".job .command code");
  assert.match(command, / --known person\.toml /);
  assert.doesNotMatch(command, /--(marks|labels|dimension|side)/);
  return { toml, command };
}

async function looksRight(page) {
  const looked = await page.value(contrasts);
  assert.deepEqual([looked.poor, looked.nameless], [[], []]);
}

async function ofPhotograph(page, server) {
  run(["phantom", "sheet", "--seed", "3", "--out", "sheet3"]);
  await openForm(page, server, "quick");
  assert.equal(await page.value("document.querySelector('.hand-form [type=submit]').disabled"), true);
  await choose(page, ".hand-form input[type=file]", [join(folder, "sheet3/photo.jpg")]);
  await page.until("!document.querySelector('.hand-form [type=submit]').disabled");
  await page.value("document.querySelector('.top, .root').scrollIntoView()");
  await snap(page, "workbench-hand-form");
  await looksRight(page);
  await make(page, minutes);
  await page.until("document.querySelector('.found-picture').naturalWidth > 100");
  const length = async () => Number((await page.value("document.querySelector('[data-size=hand_length]').closest('tr').cells[1].textContent")).replace(",", "."));
  const found = await length();
  const said = JSON.parse(run(["hand", "quick", "sheet3/photo.jpg", "--population", "ansur2_women", "--out", "cli.hand.glb", "--json"]));
  assert.ok(Math.abs(found - said.dimensions.hand_length.value_mm) < 0.051, `${found} and ${said.dimensions.hand_length.value_mm}`);
  await snap(page, "workbench-hand-quick");
  await looksRight(page);
  // What somebody measured replaces it.
  await page.set("[data-size=hand_length]", Math.round(found) + 6);
  await makeAgain(page, minutes);
  const measured = await length();
  assert.ok(measured > found + 2, `${measured} after ${found}`);
  // The file of the person says so, on the command line and in another hand that is made here.
  const { toml, command: quick } = await whatIsKnown(page);
  assert.equal(toml, `[measured_mm]\nhand_length = ${Math.round(found) + 6}.0\n`);
  const saved = join(folder, "saved");
  mkdirSync(join(saved, "found"), { recursive: true });
  writeFileSync(join(saved, "person.toml"), toml);
  copyFileSync(join(folder, "sheet3/photo.jpg"), join(saved, "photo.jpg"));
  const again = JSON.parse(execFileSync(palmar, [...quick.replace(/^palmar /, "").split(" "), "--quiet"], { cwd: saved, encoding: "utf8" }));
  assert.ok(Math.abs(measured - again.dimensions.hand_length.value_mm) < 0.051, `${measured} and ${again.dimensions.hand_length.value_mm}`);
  await page.click(".top button");
  await newHand(page, "quick");
  await choose(page, ".hand-form input[type=file]", ["photo.jpg", "person.toml"].map((one) => join(saved, one)));
  await page.until("document.querySelectorAll('.hand-form .designs li').length === 2");
  await make(page, minutes);
  assert.equal(await length(), measured);
  assert.equal(await page.value("document.querySelector('[data-size=hand_length]').value"), String(Math.round(found) + 6));
  // It holds a product, and the command line says the same.
  await page.click("[data-job-act=use]");
  await page.until(`${bench}?.dataset.field === 'rest' && ${bench}.dataset.working === 'false'`, 2 * minutes);
  await page.until("/^hand:/.test(document.querySelector('.who select').value)");
  run((await page.text(".command code")).replace(/^palmar /, "").split(" "));
  const command = await page.text("[data-command]");
  assert.match(command, /--hand .*anna\.hand\.glb$/);
  const assessed = JSON.parse(run([...command.replace(/^palmar /, "").split(" "), "--json"])).assessments[0];
  const force = parseFloat((await page.text("[data-figure=grip_force]")).replace(",", "."));
  assert.ok(Math.abs(force - assessed.contact.grip_force_n) <= 0.051, `${force} N and ${assessed.contact.grip_force_n} N`);
  assert.ok(Math.abs(assessed.hand.dimensions?.hand_length_mm ?? measured - measured) < 300);
  await snap(page, "workbench-hand-bench");
}

async function ofScan(page, server) {
  run(["phantom", "scan", "--seed", "3", "--out", "subject3"]);
  await openForm(page, server, "scan");
  await choose(page, ".hand-form input[type=file]", ["reference", "finger_flexion", "finger_abduction"].map((one) => join(folder, `subject3/scan/${one}.ply`)));
  await page.until("document.querySelectorAll('.hand-form .designs li').length === 3");
  await make(page, 5 * minutes);
  await page.until("document.querySelector('.found').dataset.ready === 'reference'", minutes);
  await snap(page, "workbench-hand-marks");
  await looksRight(page);
  const marks = () => readFileSync(join(jobFolder(), "found/marks.csv"), "utf8").trim().split("\n").slice(1);
  const before = marks();
  // A dot on the back of the hand goes 4 mm away, by the mouse; a crease is none.
  const rows = await page.value("[...document.querySelectorAll('[data-mark]')].map((one) => [one.dataset.mark, one.value, one.getAttribute('aria-label')])");
  const dot = rows.find(([, name, kind]) => name === "palm" && kind === "Dot");
  await page.value(`document.querySelector("[data-mark='${dot[0]}']").focus()`);
  const seen = JSON.parse(await page.value("document.querySelector('.found').dataset.seen"));
  await page.drag([seen.x, seen.y], [seen.x + 14, seen.y + 2], 8);
  await page.until("document.querySelector('.found').dataset.changes === '1'");
  await snap(page, "workbench-hand-dragged");
  const crease = rows.find(([, name, kind]) => name === "little_distal" && kind === "Crease");
  await page.set(`[data-mark='${crease[0]}']`, "none", ["change"]);
  await page.until("document.querySelector('.found').dataset.changes === '2'");
  await makeAgain(page, 5 * minutes);
  const { toml } = await whatIsKnown(page);
  for (const [mark, name] of [["dot", "none"], ["added_dot", "palm"], ["crease", "none"]]) {
    assert.ok(toml.includes(`[[mark]]\nposture = "reference"\nmark = "${mark}"\nname = "${name}"\n`), `${mark} ${name}: ${toml}`);
  }
  const now = marks(), used = (all, what) => all.filter((line) => line.startsWith(what)).length;
  assert.equal(used(before, "reference,crease,little_distal"), 1);
  assert.equal(used(now, "reference,crease,little_distal"), 0);
  const dots = (all) => all.filter((line) => line.startsWith("reference,dot,palm"));
  assert.equal(dots(now).filter((line) => !dots(before).includes(line)).length, 1, "one dot is elsewhere");
}

async function ofMri(page, server) {
  run(["phantom", "mri", "--seed", "3", "--posture", "reference", "--out", "subject3"]);
  await openForm(page, server, "mri");
  await choose(page, ".hand-form [data-folder]", [join(folder, "subject3/mri")]);
  await page.until("!document.querySelector('.hand-form [type=submit]').disabled");
  await make(page, 15 * minutes);
  await snap(page, "workbench-hand-bones");
  await looksRight(page);
  const bones = await page.value("[...document.querySelectorAll('[data-bone]')].map((one) => one.value)");
  assert.equal(bones.length, 29); // 19 of the fingers and the thumb, 8 of the wrist, radius and ulna
  // Two names change places by mistake: the other bone gets the name that is free.
  const ring = "[data-bone=ring_distal_phalanx]";
  const nameOf = (bone) => page.value(`document.querySelector("[data-bone=${bone}_distal_phalanx]").value`);
  await page.set(ring, "little_distal_phalanx", ["change"]);
  assert.equal(await nameOf("little"), "ring_distal_phalanx");
  assert.equal(await page.value("document.querySelector('.found').dataset.changes"), "2");
  const places = () => Object.fromEntries([...readFileSync(join(jobFolder(), "found/found.toml"), "utf8")
    .matchAll(/name = "(\w+_distal_phalanx)"\nat_mm = (.*)/g)].map(([, name, at]) => [name, at]));
  const before = places();
  await makeAgain(page, 15 * minutes, "failed");
  assert.match(await page.text(".status"), /make no whole hand/);
  assert.match((await whatIsKnown(page)).toml, /\[\[bone\]\]\nname = "little_distal_phalanx"\n/);
  const now = places();
  assert.deepEqual([now.little_distal_phalanx, now.ring_distal_phalanx], [before.ring_distal_phalanx, before.little_distal_phalanx]);
  // What was said is shown, and taken back.
  assert.deepEqual([await nameOf("ring"), await nameOf("little")], ["little_distal_phalanx", "ring_distal_phalanx"]);
  assert.equal(await page.value("document.querySelector('[data-found=again]').disabled"), true);
  await page.set(ring, "ring_distal_phalanx", ["change"]);
  assert.equal(await nameOf("little"), "little_distal_phalanx");
  await makeAgain(page, 15 * minutes);
  assert.deepEqual(places(), before);
}

const browser = new Browser();
const begun = Date.now();
try {
  const server = await serve();
  const page = await browser.page();
  page.acceptDialogs();
  if (process.argv.includes("--scan")) await ofScan(page, server);
  else if (process.argv.includes("--mri")) await ofMri(page, server);
  else await ofPhotograph(page, server);
  assert.deepEqual(page.complaints.filter((one) => !/4(04|09|22)/.test(one)), []);
  await stop(server);
  console.log(`done in ${((Date.now() - begun) / 1000).toFixed(1)} s`);
} finally {
  await browser.close();
  end();
}
