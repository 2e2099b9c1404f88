// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Long use of the workbench in a real browser: node bench_long_use.mjs PALMAR [--minutes 15] [--seed 1] does what
// a person does, one thing after the other as fast as they are answered, and watches the memory of server and
// page. Ends with 1 if either grows: the middle of the last third of the time lies more than kGrowth above that
// of the second third. --minutes 480 runs for a working day. Ends with 77 where no browser is found.
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { Bench } from "./bench_server.mjs";
import { Browser, browserProgram, wait } from "./browser.mjs";

const palmar = resolve(process.argv[2]);
const option = (name, usual) => (process.argv.includes(name) ? Number(process.argv[process.argv.indexOf(name) + 1]) : usual);
const minutes = option("--minutes", 15);
if (!browserProgram) {
  console.log("skipped: no browser (chromium, google-chrome) is installed");
  process.exit(77);
}
// MB; a server keeps up to six hands of some 60 MB, and allocators keep what they had at most once.
const kGrowth = { server: 40, page: 8 };
const kBetweenLooks = 5000; // ms

let state = option("--seed", 1) >>> 0;
const chance = () => { // mulberry32
  state = (state + 0x6d2b79f5) >>> 0;
  let t = Math.imul(state ^ (state >>> 15), 1 | state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
};
const pick = (all) => all[Math.floor(chance() * all.length)];

const bench = "document.querySelector('.bench')";
const rests = `${bench}?.dataset.working === 'false' && Number(${bench}.dataset.results ?? 0) > 0`;
const isStart = "document.querySelector('[data-example]') !== null";

async function settled(page, act) {
  await act();
  await wait(30);
  await page.until(rests, 120000);
}

const acts = {
  force: (page) => settled(page, () => page.set(".force input[type=number]", 20 + Math.floor(100 * chance()), ["change"])),
  hold: (page) => settled(page, async () => {
    const holds = await page.value("[...document.querySelectorAll('[data-hold]')].map((one) => one.dataset.hold)");
    if (holds.length > 0) await page.click(`[data-hold='${pick(holds)}']`);
  }),
  person: (page) => settled(page, () => page.set(".who select", pick(["", "woman:P5", "man:P95"]))),
  side: (page) => settled(page, () => page.set(".who select:nth-child(2)", pick(["right", "left"]))),
  drag: async (page) => {
    for (let k = 0; k < 12; ++k) {
      await page.set("[data-offset=move-x]", (2 * chance() - 1).toFixed(1), ["input"]);
      await page.set("[data-offset=turn-y]", (6 * chance() - 3).toFixed(1), ["input"]);
      await wait(15);
    }
    await settled(page, () => page.set("[data-offset=move-z]", (2 * chance() - 1).toFixed(1)));
  },
  joint: (page) => settled(page, () => page.set("[data-angle=index_pip_flexion][type=number]", Math.floor(60 * chance()))),
  close: (page) => settled(page, () => page.click("[data-act=close]")),
  rest: (page) => settled(page, () => page.click("[data-act=rest]")),
  again: (page) => settled(page, () => page.click("[data-act=again]")),
  undo: (page) => settled(page, () => page.key("z", 2)),
  redo: (page) => settled(page, () => page.key("z", 10)),
  look: (page) => page.click(`[data-look=${pick(["palm", "back", "thumb", "little"])}]`),
  cut: (page) => page.set("[data-cut]", Math.floor(100 * chance()), ["input"]),
  product: (page) => page.set("[data-product]", pick(["clear", "solid", "hidden", "alone"]), ["change"]),
  language: (page) => settled(page, () => page.set(".language", pick(["de", "en"]), ["change"])),
  point: async (page) => {
    const box = await page.box(".view-canvas canvas");
    for (let k = 0; k < 10; ++k) await page.mouse("mouseMoved", box.x + box.width * chance(), box.y + box.height * chance());
  },
  other: async (page) => { // to the start page and to another product
    await page.click(".top button");
    await page.until(isStart);
    await settled(page, () => page.click(pick(["[data-example=round-handle]", "[data-example=edged-handle]", "[data-example=ball]"])));
  },
};
const often = { force: 4, hold: 3, person: 1, side: 1, drag: 8, joint: 3, close: 1, rest: 1, again: 2, undo: 4, redo: 2, look: 3, cut: 2, product: 2, language: 0.3, point: 4, other: 1 };
const all = Object.entries(often).reduce((sum, [, weight]) => sum + weight, 0);
function nextAct() {
  let left = chance() * all;
  for (const [name, weight] of Object.entries(often)) if ((left -= weight) < 0) return name;
  return "look";
}

const residentMb = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;
const middle = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

const { serve, stop, end } = new Bench(palmar);
const browser = new Browser();
try {
  const server = await serve();
  const page = await browser.page();
  page.acceptDialogs();
  await page.send("HeapProfiler.enable");
  await page.open(server.url);
  await page.until(isStart);
  await page.click("[data-example=edged-handle]");
  await page.until(rests, 120000);
  const looks = [];
  const counts = {};
  const begun = Date.now();
  let done = 0, looked = 0;
  while (Date.now() - begun < minutes * 60000) {
    const name = nextAct();
    await acts[name](page);
    counts[name] = (counts[name] ?? 0) + 1;
    ++done;
    if (Date.now() - looked < kBetweenLooks) continue;
    looked = Date.now();
    await page.send("HeapProfiler.collectGarbage");
    const { usedSize } = await page.send("Runtime.getHeapUsage");
    const elements = await page.value("document.querySelectorAll('*').length");
    looks.push({ server: residentMb(server.child.pid), page: usedSize / 1048576, elements });
  }
  const third = Math.floor(looks.length / 3);
  const part = (from, of) => middle(looks.slice(from, from + third).map((one) => one[of]));
  console.log(`${done} operations in ${((Date.now() - begun) / 60000).toFixed(1)} min: ${Object.entries(counts).map(([name, count]) => `${name} ${count}`).join(", ")}`);
  let isGrowing = false;
  for (const of of ["server", "page", "elements"]) {
    const thirds = [0, third, 2 * third].map((from) => part(from, of).toFixed(1));
    console.log(`${of}: ${thirds.join(", ")} ${of === "elements" ? "elements" : "MB"} in the thirds of the time`);
    if (kGrowth[of] !== undefined && thirds[2] - thirds[1] > kGrowth[of]) isGrowing = true;
  }
  const complaints = page.complaints.filter((one) => !/4(04|09|22)/.test(one));
  if (complaints.length > 0) console.log(`the page complained: ${complaints.slice(0, 5).join("; ")}`);
  await stop(server);
  if (isGrowing || complaints.length > 0 || done === 0) {
    console.log(isGrowing ? "memory grows" : "something went wrong");
    process.exitCode = 1;
  }
} finally {
  await browser.close();
  end();
}
