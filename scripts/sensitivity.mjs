// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/sensitivity.mjs [--modules grasp,contact,effort,hand,product] [--only TEXT] [--page]
//
// Which constants of the code shape results, and by how much? Copies the sources to build/sensitivity,
// gives every named `constexpr double` of the modules a factor that the environment sets, builds that
// copy, and assesses four products with each constant multiplied by 1.2, and by 0.8 if that moves anything.
// Prints a table, largest effect first; --page writes it to docs/method/sensitivity.md instead. --only:
// constants whose name or file contains the text. The program that people use keeps its constants as
// they are. Takes about an hour on two cores; what was measured before is kept in
// build/sensitivity/measured.json and isn't measured again while the sources stay as they are.
import { execFile, execFileSync, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, renameSync, symlinkSync, writeFileSync } from "node:fs";
import { availableParallelism } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const copy = join(root, "build", "sensitivity");
const kept = join(copy, "measured.json");
const page = join(root, "docs", "method", "sensitivity.md");
const factors = [1.2, 0.8];
/** Below it a change is rounding: how far the solvers' stop leaves results open. */
const least_change = 0.001;
/** Rounds of building: constants that have to be known to the compiler are found by its messages. */
const most_rounds = 8;

/** Products that are assessed in one go, with the same settings. */
const groups = [
  { settings: ["--limit-depths"], products: {
    bar: ["cylinder", "--diameter-mm", "35", "--length-mm", "130"],
    prism: ["prism", "--width-mm", "40", "--depth-mm", "30", "--length-mm", "120", "--fillet-mm", "4"],
    ball: ["sphere", "--diameter-mm", "70"] } },
  { settings: ["--grip", "tripod", "--limit-depths"], products: { pen: ["cylinder", "--diameter-mm", "10", "--length-mm", "140"] } },
];

// ---- The copy with factors ----------------------------------------------------------------------

function option(name, otherwise) {
  const k = process.argv.indexOf(name);
  return k < 0 ? otherwise : process.argv[k + 1];
}

/** Parts between commas that stand in no bracket. */
function declarators(text) {
  const parts = [""];
  let depth = 0;
  for (const c of text) {
    if ("([{<".includes(c)) ++depth;
    if (")]}>".includes(c)) --depth;
    if (c === "," && depth === 0) parts.push("");
    else parts[parts.length - 1] += c;
  }
  return parts;
}

/** The text of a source with factors, and its constants; those in `fixed` stay as they are. */
function with_factors(file, text, fixed) {
  const found = [];
  const statement = /^([ \t]*)((?:inline |static )?)constexpr double (k[A-Z]\w*\s*=[^;]*);([^\n]*(?:\n[ \t]*\/\/(?!\/)[^\n]*)*)/gm;
  const changed = text.replace(statement, (whole, indent, storage, list, behind) => {
    if (indent && storage) return whole; // a class's own
    const parts = declarators(list).map((part) => /^\s*(k\w+)\s*=\s*([\s\S]*)$/.exec(part));
    if (parts.some((part) => !part || fixed.has(`${file}:${part[1]}`))) return whole;
    const words = behind.split("\n").map((line) => line.replace(/^\s*\/\/+<?\s?/, "")).join(" ").trim();
    const given = parts.map(([, name, value]) => {
      found.push({ id: `${file}:${name}`, file, name, value: value.replace(/\s+/g, " ").trim(), words });
      return `${name} = palmar::varied("${file}:${name}", ${value})`;
    });
    return `${indent}${indent ? "static " : storage}const double ${given.join(", ")};${behind}`;
  });
  return { found, text: found.length ? changed.replace(/^(#include |#pragma once)/m, `#include "palmar/core/varied.h"\n$1`) : text };
}

const varied_header = `#pragma once
#include <cstdlib>
#include <cstring>
namespace palmar {
inline double varied(const char* name, double value) {
  const char* which = std::getenv("PALMAR_VARIED");
  return which && !std::strcmp(which, name) ? value * std::atof(std::getenv("PALMAR_FACTOR")) : value;
}
}
`;

function list_sources() {
  return execFileSync("git", ["ls-files", "-co", "--exclude-standard"], { cwd: root, encoding: "utf8" })
    .split("\n").filter((file) => file && existsSync(join(root, file)));
}

/** Writes a file of the copy only if it is new, so that little is compiled again. */
function put(file, text) {
  const target = join(copy, "tree", file);
  if (existsSync(target) && readFileSync(target).equals(Buffer.from(text))) return;
  mkdirSync(dirname(target), { recursive: true });
  writeFileSync(target, text);
}

function build_copy(modules) {
  const sources = list_sources();
  const in_modules = new RegExp(`^src/palmar/(${modules.join("|")})/.*(?<!_test)\\.(h|cpp)$`);
  const fixed = new Set();
  const binary = join(copy, "tree", "build", "release");
  let constants = [];
  for (let round = 1; round <= most_rounds; ++round) {
    constants = [];
    for (const file of sources) {
      let text = readFileSync(join(root, file));
      if (in_modules.test(file)) {
        const made = with_factors(file.replace("src/palmar/", ""), text.toString(), fixed);
        constants.push(...made.found);
        text = made.text;
      }
      put(file, text);
    }
    put("src/palmar/core/varied.h", varied_header);
    if (!existsSync(join(copy, "tree", "node_modules"))) symlinkSync(join(root, "node_modules"), join(copy, "tree", "node_modules"));
    if (!existsSync(join(binary, "build.ninja"))) {
      execFileSync("cmake", ["--preset", "release", "-DPALMAR_WERROR=OFF", "-DPALMAR_TESTS=OFF", "-DPALMAR_BENCHMARKS=OFF"],
                   { cwd: join(copy, "tree"), stdio: ["ignore", "ignore", "inherit"] });
    }
    console.error(`Building ${constants.length} constants with factors, round ${round}`);
    const build = spawnSync("ninja", ["-C", binary, "-k", "0", "palmar", "palmar_template"], { encoding: "utf8", maxBuffer: 1 << 28 });
    if (build.status === 0) return { constants, palmar: join(binary, "bin", "palmar") };
    // Constants that the compiler has to know: those of its messages about constant expressions.
    const before = fixed.size;
    for (const [, file, name] of build.stdout.matchAll(/src\/palmar\/([^:\n]+):\d+:\d+: (?:error|note): [^\n]*[‘'](?:[\w:{}]*::)?(k[A-Z]\w*)[’']/g)) {
      for (const one of constants) {
        if (one.name === name && dirname(one.file).split("/")[0] === dirname(file).split("/")[0]) fixed.add(one.id);
      }
    }
    if (fixed.size === before) {
      console.error(build.stdout.split("\n").filter((line) => /error/.test(line)).slice(0, 20).join("\n"));
      throw new Error("the copy doesn't build; its first errors are above");
    }
  }
  throw new Error(`the copy doesn't build after ${most_rounds} rounds`);
}

// ---- Results ------------------------------------------------------------------------------------

/** Results by product of a group with one constant changed, or none. */
function assess(palmar, group, id, factor) {
  const files = Object.keys(group.products).map((name) => join(copy, `${name}.stl`));
  const args = ["assess", ...files, "--unit", "mm", "--json", "--threads", "1", ...group.settings];
  const env = { ...process.env };
  if (id) Object.assign(env, { PALMAR_VARIED: id, PALMAR_FACTOR: String(factor) });
  return new Promise((resolve) => execFile(palmar, args, { env, maxBuffer: 1 << 28, timeout: 300000 }, (error, stdout) => {
    const results = {};
    let assessments = [];
    try {
      assessments = JSON.parse(stdout).assessments;
    } catch { /* nothing was printed: told below */ }
    for (const [k, name] of Object.keys(group.products).entries()) {
      const one = assessments[k];
      results[name] = one
        ? { status: one.grasp.status, grip: one.indices.grip_force_n, area: one.contact.contact_area_mm2,
            peak: one.contact.peak_pressure_cells_mpa, posture: one.grasp.posture }
        : { failed: error?.killed ? "no answer in 5 min" : "no result" };
    }
    resolve(results);
  }));
}

/** Largest change of a result: relative for force, area and peak; degrees for joints. */
function change(usual, other) {
  if (other.failed || usual.status !== other.status) return { failed: other.failed ?? `${usual.status} becomes ${other.status}` };
  const relative = (key) => (usual[key] ? Math.abs(other[key] / usual[key] - 1) : 0);
  const joints = Object.keys(usual.posture).map((key) => Math.abs(other.posture[key] - usual.posture[key]));
  return { grip: relative("grip"), area: relative("area"), peak: relative("peak"), joint_deg: Math.max(...joints) };
}

async function measure(palmar, constants) {
  const stamp = createHash("sha256").update(readFileSync(palmar)).digest("hex");
  let store = existsSync(kept) ? JSON.parse(readFileSync(kept, "utf8")) : {};
  if (store.stamp !== stamp) store = { stamp, changes: {} };
  const save = () => {
    writeFileSync(`${kept}.new`, JSON.stringify(store));
    renameSync(`${kept}.new`, kept);
  };
  const usual = [];
  for (const group of groups) {
    for (const [name, make] of Object.entries(group.products)) {
      execFileSync(palmar, ["product", "make", ...make, "--out", join(copy, `${name}.stl`)], { stdio: "ignore" });
    }
    usual.push(await assess(palmar, group));
    for (const [name, result] of Object.entries(usual.at(-1))) {
      if (result.failed) throw new Error(`${name} can't be assessed: ${result.failed}`);
    }
  }
  const tasks = constants.filter(({ id }) => !store.changes[id]);
  let done = 0;
  const worker = async () => {
    for (let one = tasks.shift(); one; one = tasks.shift()) {
      const changes = [];
      for (const factor of factors) {
        if (factor !== factors[0] && summary(changes).score < least_change) break; // idle: not tried the other way
        for (const [k, group] of groups.entries()) {
          const results = await assess(palmar, group, one.id, factor);
          for (const [product, result] of Object.entries(results)) {
            changes.push({ product, factor, ...change(usual[k][product], result) });
          }
        }
      }
      store.changes[one.id] = changes;
      if (++done % 10 === 0) {
        save();
        console.error(`${done} measured, ${tasks.length} to go`);
      }
    }
  };
  await Promise.all(Array.from({ length: availableParallelism() }, worker));
  save();
  return store.changes;
}

// ---- The table ----------------------------------------------------------------------------------

function summary(changes) {
  const largest = (key) => Math.max(...changes.map((one) => one[key] ?? 0));
  const failed = changes.filter((one) => one.failed);
  return { grip: largest("grip"), area: largest("area"), peak: largest("peak"), joint_deg: largest("joint_deg"), failed,
           score: failed.length ? 10 + failed.length : Math.max(largest("grip"), largest("area"), largest("peak")) };
}

function table(constants, changes) {
  const rows = constants.map((one) => ({ ...one, ...summary(changes[one.id]) })).sort((a, b) => b.score - a.score || (a.id < b.id ? -1 : 1));
  const moving = rows.filter((row) => row.score >= least_change);
  const still = rows.filter((row) => row.score < least_change);
  const percent = (x) => (x < 0.0005 ? "-" : `${(100 * x).toFixed(1)} %`);
  const cell = (text) => text.replace(/\|/g, "\\|");
  const line = (row) => {
    const failed = [...new Set(row.failed.map((one) => `${one.product}: ${one.failed}`))].join("; ");
    return `| ${row.name} | ${row.file} | ${cell(row.value)} | ${cell(row.words)} | ${percent(row.grip)} | ${percent(row.area)} | ${percent(row.peak)} | ${row.joint_deg.toFixed(1)} | ${failed} |`;
  };
  const by_file = new Map();
  for (const row of still) by_file.set(row.file, [...(by_file.get(row.file) ?? []), row.name]);
  // Strike this sentence out with the first table that is taken with holds.
  const note = "**Taken before the choice of [holds](holds.md)**, when every placement was searched; not yet taken anew.";
  return `# How much each constant moves results

${note}

\`node scripts/sensitivity.mjs --page\` writes this page; don't edit it. Each named constant of the code (those that are no
setting: settings are in the option structs and in \`--help\`) was multiplied by 1.2, one at a time, and by 0.8 where
that moved anything. The columns give the largest change over both and over four products held by the template hand with
everything else as usual: a bar of 35 mm, a prism of 40 x 30 mm, a ball of 70 mm (at rest as firmly as the closed hand
holds them), a pen of 10 mm in a tripod. Whole numbers (rounds, counts) aren't varied, nor are the few constants that the
compiler has to know.
What a result can't do without is its source: "our choice" in the words beside a constant means that there is none.

${moving.length} of ${rows.length} constants move a grip force, an area or a peak pressure by 0.1 % or more.

| constant | file of src/palmar | value | unit, source | grip force | area | peak on cells | joints, deg | status |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
${moving.map(line).join("\n")}

## Those that move none of these results

${still.length} constants. Most are tolerances, ends of ranges and rules for shapes or grips that the four products don't have;
that is why a constant here isn't idle by itself.

| file of src/palmar | constants |
| --- | --- |
${[...by_file].map(([file, names]) => `| ${file} | ${names.join(", ")} |`).join("\n")}
`;
}

mkdirSync(copy, { recursive: true });
const built = build_copy(option("--modules", "grasp,contact,effort,hand,product").split(","));
const only = option("--only", "");
const constants = built.constants.filter(({ id, value }) => id.includes(only) && !value.startsWith("std::numbers"));
const text = table(constants, await measure(built.palmar, constants));
if (process.argv.includes("--page")) writeFileSync(page, text);
else console.log(text);
