// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Whether TOML files may hold what the tables of docs/using say, by what the readers refuse: which keys they list for
// an unknown one, a key of another type, a number beyond its range.
import assert from "node:assert/strict";
import {writeFileSync} from "node:fs";
import {join} from "node:path";

/** A file that is read without a word, as tables: section -> lines; and the command that reads it. */
const study = {
  "[study]": [], "[[population]]": ['preset = "xie2014"'], "[[profile]]": ['name = "none"', "range_share = 1.0"],
  "[[product]]": ['kind = "sphere"'], "[settings]": [], "[[limit]]": ['quantity = "force_n"', "highest = 1.0"],
};
const setting = {...study, "[settings]": undefined, "[[setting]]": ['name = "a"']};
const population = {
  "": ['name = "ours"'], "[[stratum]]": ['name = "women"'],
  "[[stratum.driving]]": ['dimension = "hand_length"', "mean_mm = 175.0", "sd_mm = 9.0"],
  "[[stratum.driving]] # 2": ['dimension = "hand_circumference"', "mean_mm = 182.0", "sd_mm = 8.0"],
  "[[stratum.correlation]]": ['between = ["hand_length", "hand_circumference"]', "r = 0.5"],
  "[[stratum.regression]]": ['dimension = "index_middle_length"', "intercept_mm = 1.5", "slope = { hand_length = 0.12 }"],
};
const tissue = {
  "[finger]": [], "[finger.half_space]": [], "[finger.layered]": [], "[finger.on_bone]": [], "[palm]": [], "[dorsum]": [],
  "[region.thenar]": [],
};
const hold = {
  "": ["part = 1", 'grip = "tripod"', "along = 0.5"],
  "[[fingertip]]": ['finger = "thumb"', "along = 0.5", "turn_deg = 0.0", "height_mm = 8.0"],
};
const handle = {"": ["version = 1"], "[features]": ["width_mm = 30.0", "depth_mm = 30.0"], "[ends]": [], "[frame]": []};
const mat = {"": ['name = "a"', 'kind = "mat"', "pitch_mm = 5.0", "rows = 3"]};
const glove = {
  "": ['name = "a"', 'kind = "glove"', "pitch_mm = 5.0"],
  "[[patch]]": ['region = "thenar"', "rows = 2", "columns = 2"],
};
const free = {"": ['name = "a"', 'kind = "free"'], "[[sensor]]": ['name = "s"', "at_mm = [0.0, 0.0, 0.0]", "area_mm2 = 20.0"]};
const knownPerson = (file) => ["hand", "quick", "--population", "xie2014", "--known", file];
const person = {
  "": [], "[scan]": [], "[[mark]]": ['mark = "dot"', 'name = "none"', "at_mm = [0.0, 0.0, 0.0]"],
  "[[bone]]": ['name = "scaphoid"', "at_mm = [0.0, 0.0, 0.0]"], "[measured_mm]": ["hand_length = 181.0"],
};
const project = {"": []};

export const readers = [
  {format: "study.toml", file: study, command: (file) => ["study", "plan", file, "--no-sample"]},
  {format: "study.toml", file: setting, only: "[[setting]]", as: "settings",
    command: (file) => ["study", "plan", file, "--no-sample"]},
  {format: "population.toml", file: population, command: (file) => ["population", "show", file]},
  {format: "tissue.toml", file: tissue, command: (file) => ["hand", "tissue", "--tissue", file]},
  {format: "hold.toml", file: hold,
    command: (file, folder) => ["grasp", "close", join(folder, "bar.stl"), "--unit", "mm", "--hold", file]},
  {format: "handle.toml", file: handle, command: (file, folder) =>
    ["redesign", "shape", join(folder, "no.stl"), "--unit", "mm", "--features", file, "--out", join(folder, "no")]},
  ...[mat, glove, free].map((file) => ({format: "sensors.toml", file, isPart: true, command: (path, folder) =>
    ["assess", join(folder, "bar.stl"), "--unit", "mm", "--sensors", path, "--out", join(folder, "no")]})),
  {format: "person.toml", file: person, command: knownPerson},
  {format: "project.toml", file: project, command: (path, folder) =>
    ["assess", join(folder, "no.stl"), "--unit", "mm", "--project", path, "--out", join(folder, "no")]},
];

/** "[[stratum.driving]]" as stratum[].driving[]; lists are where the table of a format has one. */
function nodeOf(root, heading) {
  let node = root;
  for (const key of heading.replace(/#.*/, "").replaceAll(/[[\]]/g, "").trim().split(".").filter((one) => one)) {
    node = node.children.get(key) ?? node.patterns.find(({pattern}) => pattern.test(key))?.node;
    assert.ok(node, `${heading} isn't documented`);
    node = node.items ?? node;
  }
  return node;
}

const textOf = (file, heading, lines) => Object.entries(file).filter(([, all]) => all)
  .map(([name, all]) => [name, ...(name === heading ? lines(all) : all)].join("\n")).join("\n") + "\n";

/** A value of another type than the table says. */
const otherType = (row) => row.kind === "text" ? "07:32:00" : "1979-05-27";

/**
 * What the readers say otherwise than the tables. `ask(command)` returns standard error. With `all` also types and
 * ranges of every key; without `hasHands` not what palmar-hands reads.
 */
export function checkReaders(formats, folder, ask, all, hasHands) {
  const faults = [];
  const path = join(folder, "asked.toml");
  let asked = 0;
  for (const {format, file, command, only, as, isPart} of readers) {
    if (!hasHands && command === knownPerson) continue;
    const known = new Map();
    const say = (heading, lines) => {
      writeFileSync(path, textOf(file, heading, lines));
      ++asked;
      return ask(command(path, folder));
    };
    const headings = Object.keys(file).filter((one) => file[one] && !one.includes("#"));
    for (const heading of headings.filter((one) => !only || one === only)) {
      const node = nodeOf(formats.get(format), as ?? heading);
      const where = `${format} ${heading}`;
      if (node.children.size === 0) continue;  // names that are data
      const said = say(heading, (lines) => [...lines, "zzzzzzzzzzzzzzzz = 1"]);
      const list = said.match(/key "z+" is not known; allowed are (.*)/)?.[1].split(", ");
      if (!list && heading === "[frame]") continue;  // isn't looked at
      if (!list) {
        faults.push(`${where}: an unknown key is answered by: ${said}`);
        continue;
      }
      const documented = [...node.children.keys()];
      const isMade = format === "study.toml" && heading === "[[product]]";
      for (const key of list) {
        known.set(key, true);
        // Parameters of the kind are in `palmar product make --list`.
        if (documented.includes(key) || (isMade && key === "diameter_mm")) continue;
        faults.push(`${where}: ${key} isn't documented`);
      }
      for (const key of documented) {
        if (list.includes(key)) continue;
        if (!isPart) faults.push(`${where}: ${key} is documented and refused`);
      }
      if (!all) continue;
      for (const key of documented.filter((one) => list.includes(one))) {
        const {row} = node.children.get(key), inner = node.children.get(key).items ?? node.children.get(key);
        if (!row || row.kind === "object" || inner.children.size > 0 || /not read/.test(row.meaning)) continue;
        const without = (lines) => lines.filter((line) => !line.startsWith(`${key} =`));
        const tryValue = (value, what) => {
          const answer = say(heading, (lines) => [...without(lines), `${key} = ${value}`]);
          const names = new RegExp(`\\b${key}\\b`);
          if (!names.test(answer) || /is not known; (allowed|did)/.test(answer)) {
            faults.push(`${where}: ${key} = ${value} (${what}) is answered by: ${answer}`);
          }
        };
        tryValue(otherType(row), "another type");
        const outside = (limit, sign) =>
          limit + sign * (row.kind === "whole" ? 1 : Math.max(1e-3, Math.abs(limit) * 1e-3));
        const written = (value) => {
          const text = row.kind === "whole" ? String(value) : value.toFixed(9);
          return row.kind === "numbers" ? `[${Array(row.count ?? 1).fill(text).join(", ")}]` : text;
        };
        if (row.highest !== undefined) tryValue(written(outside(row.highest, 1)), "too large");
        if (row.lowest !== undefined) tryValue(written(outside(row.lowest, -1)), "too small");
      }
    }
    if (isPart) for (const key of known.keys()) (formats.get(format).readersKnow ??= new Set()).add(key);
  }
  for (const [format, root] of formats) {
    if (!root.readersKnow) continue;
    for (const key of root.children.keys()) {
      if (!root.readersKnow.has(key)) faults.push(`${format}: ${key} is documented and refused`);
    }
  }
  return {faults, asked};
}
