// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node slicer_test.mjs PALMAR: what `palmar COMMAND --xml` says to 3D Slicer, held against the rules of the
// Slicer Execution Model by xmllint, and commands run as Slicer runs them. Skipped (77) without xmllint.
import assert from "node:assert/strict";
import {execFileSync, spawn, spawnSync} from "node:child_process";
import {existsSync, mkdtempSync, readdirSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join, resolve} from "node:path";
import {fileURLToPath} from "node:url";

import {parseHelp} from "../../scripts/manual.mjs";

const palmar = resolve(process.argv[2]);
const modules = join(dirname(palmar), "../lib/palmar/slicer");
const schema = join(dirname(fileURLToPath(import.meta.url)), "execution_model.rng");
if (spawnSync("xmllint", ["--version"]).status !== 0) {
  console.log("skipped: xmllint (libxml2-utils) isn't installed");
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), "palmar-slicer-"));

/** Elements of a tag as {name, longflag, index, default, ...}; texts without their escapes. */
const plain = (text) => text.replaceAll("&lt;", "<").replaceAll("&gt;", ">").replaceAll("&amp;", "&");
function parametersOf(xml) {
  const found = [];
  const kinds = "boolean|integer|double|string|directory|file|string-enumeration";
  for (const [, tag, attributes, inner] of xml.matchAll(new RegExp(`^    <(${kinds})( [^>]*)?>(.*?)^    </\\1>`, "gms"))) {
    const one = {tag, attributes: attributes ?? "", elements: []};
    for (const [, key, text] of inner.matchAll(/<([a-z]+)>([^<]*)<\/\1>/g)) {
      if (key === "element") one.elements.push(plain(text));
      else one[key] = plain(text);
    }
    found.push(one);
  }
  return found;
}

/** What a panel reads of a run: shares of progress, and that the whole is well-formed XML. */
function progressOf(output) {
  const file = join(folder, "output.xml");
  writeFileSync(file, `<module-root>${output}</module-root>`);
  execFileSync("xmllint", ["--noout", file]);
  return [...output.matchAll(/<filter-progress>([^<]*)<\/filter-progress>/g)].map(([, share]) => Number(share));
}

try {
  // Every command: valid, and nothing of its help page is missing but what a panel can't give.
  const descriptions = {};
  const visit = (words) => {
    const page = parseHelp(execFileSync(palmar, [...words, "--help"], {encoding: "utf8"}));
    const below = page.sections.find((one) => one.title === "Subcommands")?.items ?? [];
    for (const {term} of below) visit([...words, term]);
    if (below.length > 0) return;
    const xml = execFileSync(palmar, [...words, "--xml"], {encoding: "utf8"});
    const file = join(folder, words.join("-") + ".xml");
    writeFileSync(file, xml);
    const judged = spawnSync("xmllint", ["--noout", "--relaxng", schema, file], {encoding: "utf8"});
    assert.equal(judged.status, 0, judged.stderr);
    const parameters = descriptions[words.join(" ")] = parametersOf(xml);
    assert.equal(new Set(parameters.map((one) => one.name)).size, parameters.length, `${words}: a name twice`);
    const indices = parameters.filter((one) => one.index !== undefined).map((one) => Number(one.index));
    assert.deepEqual(indices, indices.map((_, i) => i), `${words}: arguments in order`);
    const flags = parameters.map((one) => one.longflag);
    for (const {term, text} of page.sections.filter((one) => one.title !== "Positionals").flatMap((one) => one.items)) {
      const long = term.split(" ")[0].split(",").filter((name) => name.startsWith("--"))
        .map((name) => name.slice(2).replace(/\{.*/, "").replaceAll("-", "_"));
      if (long.length === 0 || ["help", "json"].includes(long[0])) continue;
      const takesCommas = /\.\.\./.test(term) && /[A-Z],[A-Z]|_MM,/.test(text);
      assert.equal(long.some((name) => flags.includes(name)), !takesCommas, `${words}: ${term}`);
    }
  };
  visit([]);
  assert.ok(Object.keys(descriptions).length > 60);

  // What a panel offers for a product: its file, one to compare it with, a choice, numbers with limits.
  const assess = Object.fromEntries(descriptions.assess.map((one) => [one.name, one]));
  assert.equal(assess.product.tag, "file");
  assert.match(assess.product.attributes, /\.stl,.*\.step/);
  assert.deepEqual([assess.product.index, assess.product_2.index], ["0", "1"]);
  assert.deepEqual([assess.out.tag, assess.out.channel], ["directory", "output"]);
  assert.equal(assess.left.tag, "boolean");
  assert.equal(assess.no_error_band.tag, "boolean");
  assert.equal(assess.finger_limit_depth_mm.tag, "double");
  assert.equal(assess.finger_limit_depth_mm.label, "Finger limit depth, mm");
  assert.equal(assess.finger_limit_depth_mm.default, "4");
  // May be left out, so it must not begin with a number.
  assert.deepEqual([assess.grip_force_n.tag, assess.grip_force_n.default], ["string", undefined]);
  assert.equal(assess.coating, undefined);
  const fromMri = Object.fromEntries(descriptions["hand from-mri"].map((one) => [one.name, one]));
  assert.equal(fromMri.image.index, "0");
  const group = spawnSync(palmar, ["hand", "--xml"], {encoding: "utf8"});
  assert.equal(group.status, 2);
  assert.match(group.stderr, /--xml/);

  // As Slicer runs a module: empty fields are handed over, too.
  assert.ok(readdirSync(modules).length >= 8);
  for (const name of readdirSync(modules)) {
    const xml = execFileSync(join(modules, name), ["--xml"], {encoding: "utf8"});
    assert.match(xml, /<executable>/, name);
  }
  const handle = join(folder, "a & b.stl");
  execFileSync(palmar, ["product", "make", "cylinder", "--diameter-mm", "40", "--out", handle, "--quiet"]);
  const report = join(folder, "report");
  const run = spawnSync(join(modules, "palmar-assess"),
    ["--out", report, "--no_pictures", "--grip_force_n", "60", "--hold", "", "--language", "en", handle, ""],
    {encoding: "utf8"});
  assert.equal(run.status, 0, run.stderr);
  assert.ok(existsSync(join(report, "report.html")));
  const shares = progressOf(run.stdout);
  assert.ok(shares.length > 2 && shares.every((one, i) => one >= (shares[i - 1] ?? 0) && one <= 1), `${shares}`);
  assert.deepEqual(run.stdout.match(/<filter-(start|end)>/g), ["<filter-start>", "<filter-end>"]);
  assert.ok(run.stdout.lastIndexOf("<filter-progress>") < run.stdout.indexOf("<filter-end>"), run.stdout);
  assert.ok(run.stdout.indexOf("<filter-start>") < run.stdout.indexOf("<filter-progress>"), run.stdout);
  assert.match(run.stdout, /a &amp; b/);
  const wrong = spawnSync(join(modules, "palmar-assess"), ["--grip_force_n", "-3", handle], {encoding: "utf8"});
  assert.equal(wrong.status, 2);
  assert.match(wrong.stderr, /grip force is -3 N/);

  // Cancelled by its panel, a study keeps what is finished.
  const store = join(folder, "many.palmar");
  const study = spawn(join(modules, "palmar-study-run"),
    ["--product", handle, "--population", "ansur2_women", "--hands", "500", "--out", store]);
  let output = "";
  const ended = new Promise((resolve) => study.on("close", resolve));
  study.stdout.on("data", (data) => {
    output += data;
    if (/<filter-progress>0\.0*[1-9]/.test(output)) study.kill("SIGTERM");
  });
  assert.equal(await ended, 130);
  progressOf(output);
  const status = JSON.parse(execFileSync(palmar, ["study", "status", store, "--json"], {encoding: "utf8"}));
  assert.ok(JSON.stringify(status).includes("many.palmar"));
} finally {
  rmSync(folder, {recursive: true, force: true});
}
console.log("ok");
