// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import assert from "node:assert/strict";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { test } from "node:test";
import english from "../texts/en.json";
import german from "../texts/de.json";

// Tests run in the root of the repository.
function filesIn(folder: string, endings: string[]): string[] {
  let all: string[] = [];
  for (const name of readdirSync(folder)) {
    const path = folder + "/" + name;
    if (statSync(path).isDirectory()) all = all.concat(filesIn(path, endings));
    else if (endings.some((one) => path.slice(-one.length) === one) && !/[_.]test\./.test(path)) all.push(path);
  }
  return all;
}

/// All string literals; neighbours that a compiler joins as one, and format places as {}.
function literals(paths: string[]): string[] {
  let all: string[] = [];
  for (const path of paths) {
    const text = readFileSync(path, "utf8").replace(/^\s*\/\/.*$/gm, "");
    const joined = text.replace(/"\s*\n\s*"/g, "").replace(/\{:[^{}"]*\}/g, "{}");
    all = all.concat(joined.match(/"(?:[^"\\\n]|\\.)*"/g) || []);
  }
  return all.map((one) => one.slice(1, -1).replace(/\\u00b2/g, "²").replace(/\\"/g, '"'));
}

const ours = filesIn("apps/workbench", [".ts"]).concat(filesIn("src/palmar/report", [".cpp", ".h"]), filesIn("src/hands/person_report", [".cpp", ".h"]))
  .map((path) => readFileSync(path, "utf8")).join("\n");
const sources = literals(filesIn("src", [".cpp", ".h"]).concat(filesIn("apps", [".cpp"])));

test("every text has its place in the other language and none is empty", () => {
  assert.equal(String(Object.keys(english).sort()), String(Object.keys(german).sort()));
  for (const key of Object.keys(german)) assert.ok((german as { [key: string]: string })[key].length > 0, key);
});

test("no sentence but short words is the same in both languages", () => {
  const same: string[] = [];
  for (const key of Object.keys(english)) {
    const text = (english as { [key: string]: string })[key];
    const letters = text.replace(/\{[a-z_0-9]+\}/g, "").replace(/[^A-Za-z ]/g, "").trim();
    if (text === (german as { [key: string]: string })[key] && letters.split(/ +/).length > 3) same.push(key);
  }
  assert.equal(String(same), "");
});

test("every text is asked for somewhere", () => {
  const isIn = (part: string) => ours.indexOf(part) >= 0;
  const unused = Object.keys(english).filter((key) => {
    if (/^said\./.test(key) || isIn(`"${key}"`) || isIn(`"${key.replace(/\.(one|many)$/, "")}"`)) return false;
    // "region." + name, sayName("region", name): a beginning that ends in a dot.
    for (let at = key.indexOf("."); at >= 0; at = key.indexOf(".", at + 1)) {
      const group = key.slice(0, at);
      if (isIn(`"${group}."`) || isIn(`sayName("${group}"`)) return false;
    }
    return true;
  });
  assert.equal(String(unused), "");
});

// Put together from parts in grasp_verdict.cpp, grip_needs.cpp, check.cpp, friction_words.cpp,
// study_verdict.cpp, study_analysis.cpp and load_hand.cpp, so that no piece of them stands anywhere as a whole.
const puzzles = ["It asks for more range of motion than {n_count} of {n_all} hands have.",
  "It asks for more grip strength than {n_count} of {n_all} hands have.",
  "the base of the {finger}", "the middle part of the {finger}",
  "only {n_count} finger besides the thumb touches it; a {grip} needs {n_needed}",
  "only {n_count} fingers besides the thumb touch it; a {grip} needs {n_needed}",
  "{part} of the {n_p}th percentile (ANSUR II)", "{part} of the {n_p}st percentile (ANSUR II)",
  "{part} of the {n_p}nd percentile (ANSUR II)", "{part} of the {n_p}rd percentile (ANSUR II)",
  "{n_pairs} pairs of triangles go through each other",
  "But stick and slip of the skin were not found; the map shows one way to hold the load, and the motion is left out.",
  "in {n_count} grasps fewer parts of the hand touch it than the grip needs: those hands would hold it otherwise.",
  "in {n_count} grasp fewer parts of the hand touch it than the grip needs: those hands would hold it otherwise."];

test("what is said in other layers is still said there", () => {
  const whole = sources.join("\n");
  const gone: string[] = [];
  for (const key of Object.keys(english)) {
    const text = (english as { [key: string]: string })[key];
    if (!/^said\./.test(key) || puzzles.indexOf(text) >= 0) continue;
    // The longest piece without a place, without what a list or a clause may begin with.
    const pieces = text.split(/\{[a-z_0-9]+\}|; |: |, |\. /).map((one) => one.replace(/^[ .;:,(]+|[ .;:,)]+$/g, ""));
    const longest = pieces.sort((a, b) => b.length - a.length)[0];
    const words = longest.split(" ");
    const is_known = whole.indexOf(longest) >= 0 || whole.toLowerCase().indexOf(longest.toLowerCase()) >= 0 ||
      // Put together from parts: then its first two and its last two words are somewhere.
      (words.length > 3 && whole.indexOf(words.slice(0, 3).join(" ")) >= 0 && whole.indexOf(words.slice(-2).join(" ")) >= 0) ||
      (words.length <= 3 && words.every((one) => whole.indexOf(one) >= 0 || whole.indexOf(one.toLowerCase()) >= 0));
    if (!is_known) gone.push(text);
  }
  assert.equal(String(gone), "");
});
