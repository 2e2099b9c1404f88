// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node --test tests/sensitivity/sensitivity_test.mjs: docs/method/sensitivity.md names the constants that the
// sources have, with the values that they have. On made-up sources, pages and answers: it sees what it is there for.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { constants_of, with_changeable_constants } from "../../scripts/sensitivity/constants.mjs";
import { chance_of, changes_on, named_on, noise_of, quantile, stale_names } from "../../scripts/sensitivity/page.mjs";
import { plain_words } from "../../scripts/sensitivity/plain_words.mjs";

const root = dirname(dirname(dirname(fileURLToPath(import.meta.url))));

test("the page names constants that the sources have, with their values", () => {
  const page = readFileSync(join(root, "docs", "method", "sensitivity.md"), "utf8");
  assert.ok(named_on(page).length > 100, "docs/method/sensitivity.md names hardly any constants");
  assert.deepEqual(stale_names(page, constants_of(root)), [],
                   "docs/method/sensitivity.md is stale; `node scripts/sensitivity.mjs --page` makes it anew");
});

test("constants with plain words are there", () => {
  const known = new Set(constants_of(root).map(({ id }) => id));
  assert.deepEqual(Object.keys(plain_words).filter((id) => !known.has(id)), [], "scripts/sensitivity/plain_words.mjs names constants that are gone");
});

const source = `#include <cmath>
namespace {
struct Descent {
  double level;  // of the force
  int most_tries;
  double gain;
};
constexpr Descent kOnSkin{1.0, 60, 5e-3};
constexpr double kStep = 8.0, kArm = 50.0;  // mm; our choice
// Somebody 1990, N.
constexpr double kForces[2] = {1.5,
                               2.5};
constexpr int kMost = 3;
}  // namespace
`;
const file = "grasp/equilibrium/made_up.cpp";
const header = `#pragma once
struct MadeUpModel {
  double spread = 0.35, none = 0.0, like = kOther;  ///< rad
};
`;

test("constants of a source: name, value, words", () => {
  const { constants } = with_changeable_constants(file, source);
  assert.deepEqual(constants.map(({ name, value }) => [name, value]), [
    ["kOnSkin.level", "1.0"], ["kOnSkin.gain", "5e-3"], ["kStep", "8.0"], ["kArm", "50.0"], ["kForces", "{1.5, 2.5}"]]);
  assert.equal(constants[2].words, "mm; our choice");
  assert.equal(constants[4].words, "Somebody 1990, N.");
  assert.deepEqual(with_changeable_constants("grasp/equilibrium/made_up.h", header).constants.map(({ name }) => name),
                   ["MadeUpModel.spread"]);
});

test("a constant that is gone, or has another value, is told", () => {
  const { constants } = with_changeable_constants(file, source);
  const page = (name, value) => `| constant | file |\n| ${name} | ${file} | ${value} | mm |\n`;
  assert.deepEqual(stale_names(page("kStep", "8.0") + page("kOnSkin.gain", "5e-3") + page("kForces", "{1.5, 2.5}"), constants), []);
  assert.deepEqual(stale_names(page("kStep", "9.0"), constants), [`kStep of src/palmar/${file} is 8.0 now; the page says 9.0`]);
  assert.deepEqual(stale_names(page("kGone", "8.0"), constants), [`kGone of src/palmar/${file} is gone`]);
  assert.deepEqual(stale_names(`| ${file} | kStep, kLost |\n`, constants), [`kLost of src/palmar/${file} is gone`]);
  assert.deepEqual(stale_names(`| ${file} | kStep | | kArm, kLost |\n`, constants), [`kLost of src/palmar/${file} is gone`]);
  assert.deepEqual(stale_names("| grasp/rest/other.cpp | kStep |\n", constants), ["kStep of src/palmar/grasp/rest/other.cpp is gone"]);
  assert.deepEqual(stale_names("Most of all `kStep` and `kOnSkin.gain`, `kMadeUp` and `MadeUpModel.spread`.\n", constants),
                   ["kMadeUp is gone", "MadeUpModel.spread is gone"]);
});

test("constants that only steer the search are told from those that say what it looks for", () => {
  const { constants } = with_changeable_constants("grasp/equilibrium/least_effort.cpp", source);
  assert.deepEqual(constants.filter(({ anew }) => anew === "steering").map(({ name }) => name), ["kStep", "kArm"]);
  const own = constants_of(root).filter(({ anew }) => anew === "steering").map(({ name }) => name);
  for (const name of ["kOnSkin.least_gain", "kInNeed.first_damping", "kRates", "kTolerance"]) assert.ok(own.includes(name), `${name} doesn't steer`);
  for (const name of ["kOnSkin.price", "kInNeed.price", "kNoMissing", "kToBoundary"]) assert.ok(!own.includes(name), `${name} steers`);
});

/** Answers of two starts, whose peaks are `more` and `less` by both factors. */
const tries = (more, less, status = "balanced") => [[1.05, more], [1 / 1.05, less]].map(([factor, peaks]) => (
  { factor, starts: peaks.map((peak) => ({ status, force: 1, area: 1, peak, angles: [10 * peak] })) }));
const usual = [1, 1].map((peak) => ({ status: "balanced", force: 1, area: 1, peak, angles: [10] }));

test("a change is half of the difference of both factors, the mean of two starts that agree", () => {
  const found = changes_on(tries([1.02, 1.04], [1, 1]), usual);
  assert.ok(Math.abs(found.peak.change - 50 * (Math.sqrt(1.02) + Math.sqrt(1.04) - 2)) < 1e-9);
  assert.equal(found.peak.agree, true);
  assert.ok(Math.abs(found.joint.change - 0.15) < 1e-9);
  assert.equal(found.force.change, 0);
  assert.equal(changes_on(tries([1.02, 0.96], [1, 1]), usual).peak.agree, false);
  // The other factor changes nothing.
  assert.ok(Math.abs(changes_on(tries([1.02, 1.02], [1, 1]).slice(0, 1), usual).peak.change - 100 * (Math.sqrt(1.02) - 1)) < 1e-9);
});

test("a product falls if it does from all starts", () => {
  assert.deepEqual(changes_on(tries([1, 1], [1, 1], "slips_out"), usual).falls, ["slips_out", "slips_out"]);
  const one = tries([1, 1], [1, 1]);
  one[0].starts[1].status = "slips_out";
  assert.deepEqual(changes_on(one, usual).falls, []);
  assert.equal(changes_on(one, usual).is_unsteady, true);
});

test("noise is twice the 90 % quantile of what constants that steer change, or of what both starts leave open", () => {
  assert.equal(quantile([5, 1, 4, 2, 3, 6, 7, 8, 9, 10], 0.9), 9);
  const on_bar = (more) => ({ on: new Map([["bar", changes_on(tries(more, [1, 1]), usual)]]) });
  const steering = Array.from({ length: 10 }, (_, k) => on_bar([1 + 0.01 * k, 1 + 0.01 * k]));
  const chance = chance_of(steering, [], "bar");
  assert.ok(Math.abs(noise_of(chance, "peak") - 2 * 100 * (Math.sqrt(1.08) - 1)) < 1e-9);
  assert.equal(noise_of(chance, "force"), 0.05);
  // One that moves the peak by 20 % from one start, and not at all from the other.
  assert.ok(Math.abs(noise_of(chance_of(steering, [on_bar([1.44, 1])], "bar"), "peak") - 20) < 1e-9);
  assert.equal(noise_of(chance_of(steering.slice(0, 2), [], "bar"), "peak"), Infinity);
  assert.equal(chance_of(steering, [], "ball").count, 0);
});
