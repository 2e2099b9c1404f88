// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Reports in a real browser: node browser_test.mjs PALMAR [FOLDER] makes reports of two products and of
// a study, does in each page what people do, and reads what came of it from the page. With FOLDER it also
// leaves screenshots there. Ends with 77 where no browser is found.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { Browser, browserProgram } from "./browser.mjs";

const palmar = resolve(process.argv[2]);
const pictures = process.argv[3] && resolve(process.argv[3]);
if (!browserProgram) {
  console.log("skipped: no browser (chromium, google-chrome) is installed");
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), "palmar-browser-"));
const browser = new Browser();

function run(words) {
  execFileSync(palmar, words.split(" "), { cwd: folder, stdio: ["ignore", "ignore", "pipe"] });
}

/// What `script`, the body of an async function, gives back in that page, in a window of that size.
async function inPage(page, [width, height], script) {
  const tab = await browser.page(width, height);
  await tab.open(`file://${page}`);
  const found = await tab.value(`(async () => {
    const wait = (ms) => new Promise((done) => setTimeout(done, ms));
    const isLive = async (view) => {
      for (let i = 0; i < 600; ++i, await wait(50)) if (view.classList.contains("is-live")) return;
      throw new Error("the view didn't start within 30 s");
    };
    ${script} })()`);
  await tab.close();
  return found;
}

/// The page as the browser prints it.
async function printed(address) {
  const tab = await browser.page(1280, 720);
  await tab.open(address);
  const { data } = await tab.send("Page.printToPDF", { preferCSSPageSize: true, printBackground: true });
  await tab.close();
  return Buffer.from(data, "base64").toString("latin1");
}

const firstScreen = `
  const answer = document.querySelector("#answer").getBoundingClientRect();
  const images = [...document.querySelectorAll("#answer img")];
  for (let i = 0; i < 50 && !images.every((one) => one.complete); ++i) await wait(50);
  return { bottom: answer.bottom + scrollY, images: images.length, drawn: images.every((one) => one.naturalWidth > 100),
           sentence: document.querySelector(".sentence").textContent, command: document.querySelector(".next code")?.textContent ?? "",
           charts: document.querySelectorAll("#answer .small-chart svg").length, rows: document.querySelectorAll("#answer .unseen tbody tr").length };`;

const folding = `
  const shut = [];
  for (const link of document.querySelectorAll(".contents a")) {
    const target = document.getElementById(link.getAttribute("href").slice(1));
    link.click();
    await wait(50);
    if (!target || !target.open) shut.push(link.textContent);
  }
  const term = document.querySelector("details[open] button.term");
  term.click();
  const entry = document.getElementById(term.getAttribute("popovertarget"));
  return { shut, links: document.querySelectorAll(".contents a").length, opened: entry.matches(":popover-open"), text: entry.textContent };`;

const pointing = `
  document.querySelector("#product-0").open = true;
  const view = document.querySelector("#product-0 [data-palmar-scene]");
  view.scrollIntoView({ block: "center" });
  await isLive(view);
  const canvas = view.querySelector("canvas");
  const wheel = () => !canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: 10, bubbles: true, cancelable: true }));
  const before = wheel();
  const box = canvas.getBoundingClientRect();
  // The hand and the product needn't be in the middle of the view: the first place that says something.
  let place = [0.5, 0.5];
  const at = (type) => canvas.dispatchEvent(new PointerEvent(type, { pointerType: "mouse", pointerId: 1, button: 0, bubbles: true,
    clientX: box.left + box.width * place[0], clientY: box.top + box.height * place[1] }));
  canvas.setPointerCapture = canvas.releasePointerCapture = () => {};
  let says = "";
  // A busy machine draws late: twice, the second time more slowly.
  search: for (const round of [1, 4]) for (const y of [0.5, 0.4, 0.6, 0.3, 0.7]) for (const x of [0.5, 0.4, 0.6, 0.3, 0.7]) {
    place = [x, y];
    at("pointermove");
    await wait(round * 150);
    says = view.querySelector(".view-point").textContent;
    if (/\\) mm/.test(says)) break search;
  }
  at("pointerdown"); at("pointerup");
  const after = wheel();
  return { says, before, after, copied: view.querySelector(".view-copied code").textContent,
           scale: view.querySelector(".view-overlay text:last-of-type").textContent };`;

// The plane that cuts, and the picture as a file: what the link that saves it would give.
const cutAndSaved = `
  document.querySelector("#product-0").open = true;
  const view = document.querySelector("#product-0 [data-palmar-scene]");
  view.scrollIntoView({ block: "center" });
  await isLive(view);
  const canvas = view.querySelector("canvas"), cut = view.querySelector("[data-cut]");
  const drawnAt = (share) => {
    cut.value = String(share * Number(cut.max));
    cut.dispatchEvent(new Event("input", { bubbles: true }));
    return canvas.toDataURL(); // of the frame that this has drawn
  };
  const whole = drawnAt(1), half = drawnAt(0.5);
  let saved = null;
  HTMLAnchorElement.prototype.click = function () { saved = { name: this.download, href: this.href }; };
  view.querySelector("[data-save]").click();
  for (let i = 0; i < 100 && !saved; ++i) await wait(50);
  const picture = new Image();
  picture.src = saved.href;
  await picture.decode();
  return { isCut: half !== whole, name: saved.name, isPng: saved.href.startsWith("data:image/png"),
           hasBar: picture.width > canvas.width };`;

const linked = `
  const view = document.querySelector(".pair");
  view.scrollIntoView({ block: "center" });
  await isLive(view);
  const second = view.querySelectorAll("canvas")[1];
  const before = second.toDataURL();
  view.querySelector("canvas").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
  return { canvases: view.querySelectorAll("canvas").length, follows: second.toDataURL() !== before };`;

// Text that is seen, with too little contrast against what is behind it (WCAG 2.1, 1.4.3: 4.5 to 1, of
// large text 3 to 1). Pictures and drawings aren't looked at.
const contrasts = `
  for (const one of document.querySelectorAll("details")) one.open = true;
  await wait(300);
  const channels = (colour) => colour.match(/[\\d.]+/g).map(Number);
  const light = (c) => c.slice(0, 3).map((v) => (v /= 255) <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = (one) => {
    for (; one; one = one.parentElement) {
      const c = channels(getComputedStyle(one).backgroundColor);
      if (c.length < 4 || c[3] === 1) return c;
    }
    return [255, 255, 255];
  };
  const poor = [];
  let seen = 0;
  for (const one of document.querySelectorAll("body *")) {
    if (one.closest("svg,script,style,.skip") || !one.checkVisibility()) continue;
    if (![...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim())) continue;
    const style = getComputedStyle(one), a = light(channels(style.color)), b = light(behind(one));
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    const size = parseFloat(style.fontSize), isLarge = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    ++seen;
    if (ratio < (isLarge ? 3 : 4.5)) poor.push(one.tagName + "." + one.className + " " + ratio.toFixed(2) + " " + one.textContent.slice(0, 40));
  }
  return { seen, poor: [...new Set(poor)].slice(0, 10) };`;

const units = `
  const sentence = () => document.querySelector(".sentence").textContent;
  const facts = () => document.querySelector("#answer dl").textContent;
  for (const one of document.querySelectorAll("details")) one.open = true;
  const table = [...document.querySelectorAll("table")].find((one) => /, MPa/.test(one.tHead?.textContent ?? "") && one.tHead.rows.length === 1);
  const column = [...table.tHead.rows[0].cells].findIndex((one) => /, MPa/.test(one.textContent));
  const cell = () => parseFloat(table.tBodies[0].rows[0].cells[column].textContent);
  const before = { sentence: sentence(), facts: facts(), cell: cell() };
  const button = document.querySelector("button.units");
  button.click();
  const us = { chart: document.querySelector(".small-chart svg").textContent, sentence: sentence(), facts: facts(), cell: cell(), head: table.tHead.textContent };
  button.click();
  return { before, us, after: { sentence: sentence(), facts: facts(), cell: cell() }, says: button.textContent };`;

const narrow = `
  for (const one of document.querySelectorAll("details")) one.open = true;
  await wait(200);
  return document.documentElement.scrollWidth;`;

// Words of the command that take more than one line: it may break between words only.
const brokenWords = `
  const line = parseFloat(getComputedStyle(document.querySelector(".next")).lineHeight);
  return [...document.querySelectorAll(".next .part .part")].filter((one) => one.getBoundingClientRect().height > 1.5 * line)
    .map((one) => one.textContent);`;

const screen = [1280, 720];

try {
  run("product make cylinder --diameter-mm 22 --length-mm 120 --out thin.step");
  run("product make cylinder --diameter-mm 40 --length-mm 120 --out thick.step");
  run("assess thin.step thick.step --grip-force-n 40 --out two");
  run("study run --product thin.step --product thick.step --grip-force-n 40 --hands 6 --out six.palmar");
  run("study report six.palmar --no-figures --out six");
  const two = join(folder, "two/report.html"), six = join(folder, "six/report.html");
  const less = /thick presses \d+ % less than thin at its hardest place, in the same grip of 40 N/;
  for (const [page, images, sentence] of [[two, 4, less], [six, 4, /presses [\d.]+ % less than .* of 6 hands agree/]]) {
    const first = await inPage(page, screen, firstScreen);
    assert.ok(first.bottom <= 720, `${page}: the first screen ends at ${first.bottom}`);
    assert.equal(first.images, images);
    assert.ok(first.drawn && first.charts === 1 && first.rows > 3, JSON.stringify(first));
    assert.match(first.sentence, sentence);
    assert.match(first.command, /^palmar /);
    const folds = await inPage(page, screen, folding);
    assert.deepEqual(folds.shut, []);
    assert.ok(folds.links >= 5 && folds.opened && folds.text.length > 40, JSON.stringify(folds));
    for (const window of [500, 390]) {
      const width = await inPage(page, [window, 844], narrow);
      assert.ok(width <= window, `${page}: ${width} wide in a window of ${window}`);
      assert.deepEqual(await inPage(page, [window, 844], brokenWords), []);
    }
    const contrast = await inPage(page, screen, contrasts);
    assert.ok(contrast.seen > 100, JSON.stringify(contrast));
    assert.deepEqual(contrast.poor, []);
    const said = await inPage(page, screen, units);
    assert.deepEqual(said.after, said.before);
    assert.match(said.us.facts, /lbf.*psi/);
    assert.ok(!/ MPa| N\b/.test(said.us.facts), said.us.facts);
    assert.match(said.us.head, /, psi/);
    // The study's chart is of changes in per cent.
    if (page === two) assert.match(said.us.chart, /psi/);
    assert.ok(!/MPa/.test(said.us.chart), said.us.chart);
    // 1 MPa = 145.04 psi; both are rounded to three digits.
    assert.ok(Math.abs(said.us.cell / said.before.cell / 145.04 - 1) < 0.02, JSON.stringify(said));
  }
  const pointed = await inPage(two, screen, pointing);
  assert.match(pointed.says, /(MPa|face).*\(-?\d+\.\d, -?\d+\.\d, -?\d+\.\d\) mm/);
  assert.match(pointed.copied, /^--at -?\d+\.\d,-?\d+\.\d,-?\d+\.\d$/);
  assert.deepEqual([pointed.before, pointed.after], [false, true], "the wheel is the page's until the view is clicked");
  assert.match(pointed.scale, /^\d+ mm$/);
  assert.deepEqual(await inPage(two, screen, linked), { canvases: 2, follows: true });
  const kept = await inPage(two, screen, cutAndSaved);
  assert.ok(kept.isCut && kept.isPng && kept.hasBar && /\.png$/.test(kept.name), JSON.stringify(kept));
  // On paper: the answer on one page, all of it on several.
  for (const [what, paper, width] of [["answer", "a4", 595], ["answer", "letter", 612], ["all", "a4", 595]]) {
    const text = await printed(`file://${two}#print=${what},${paper}`);
    const pages = Number(text.match(/\/Count (\d+)/)[1]);
    assert.ok(what === "answer" ? pages === 1 : pages > 5, `${what} on ${paper}: ${pages} pages`);
    assert.equal(Math.round(Number(text.match(/\/MediaBox \[0 0 ([\d.]+)/)[1])), width);
  }
  // Slides and a project.
  writeFileSync(join(folder, "logo.svg"), '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="30"><rect width="90" height="30"/></svg>');
  writeFileSync(join(folder, "project.toml"), 'name = "Two bars"\nauthor = "Studio"\nnotes = "First round."\nlogo = "logo.svg"\n');
  run("assess thin.step thick.step --grip-force-n 40 --project project.toml --units us --slides --out desk");
  for (const name of ["answer", "hold", "map"]) {
    const png = readFileSync(join(folder, `desk/slide-${name}.png`));
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [1920, 1080], name);
    assert.ok(png.length > 30000, `slide-${name}.png has ${png.length} bytes: it is empty`);
  }
  const project = await inPage(join(folder, "desk/report.html"), screen, `
    const logo = document.querySelector(".project img");
    for (let i = 0; i < 50 && !logo.complete; ++i) await wait(50);
    return { text: document.querySelector(".project").textContent, logo: logo.naturalWidth,
             sentence: document.querySelector(".sentence").textContent };`);
  assert.match(project.text, /Two bars · Studio.*First round\./);
  assert.equal(project.logo, 90);
  assert.match(project.sentence, /same grip of 8\.99 lbf/);
  // No English left in a German page but names of works, licences and files.
  run("assess thin.step --mass-kg 0.3 --friction 0.6 --language de --no-pictures --out deutsch");
  run("study report six.palmar --language de --no-figures --no-pictures --out studie");
  for (const name of ["deutsch", "studie"]) {
    const text = await inPage(join(folder, name, "report.html"), screen, `
      for (const one of document.querySelectorAll("script,style,code,pre")) one.remove();
      return [...document.querySelectorAll("body *")].flatMap((one) => [...one.childNodes].filter((node) => node.nodeType === 3)
        .map((node) => node.data.trim())).filter((words) => / (the|of|and|is|are|with|not) /.test(" " + words + " "));`);
    const english = text.filter((words) => !/Plausible 3D|Gordon|Licen[cs]e|Lizenz|Ferrari|Kerr|Crowninshield|docs\/|npm/.test(words));
    assert.deepEqual(english, [], name);
  }
  if (pictures) {
    mkdirSync(pictures, { recursive: true });
    for (const [name, page] of [["two", two], ["six", six]]) {
      for (const size of [screen, [1920, 1080], [500, 844]]) {
        const tab = await browser.page(...size);
        await tab.open(`file://${page}`);
        await tab.picture(join(pictures, `${name}-${size.join("x")}.png`));
        await tab.close();
      }
    }
  }
  console.log("first screens, links, folding, glossary, 3-D places, linked views, narrow windows and paper are as they should be");
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
