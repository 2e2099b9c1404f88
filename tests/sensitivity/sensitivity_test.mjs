// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node --test tests/sensitivity/sensitivity_test.mjs: docs/method/sensitivity.md names the constants that the
// sources have, with the values that they have. On made-up sources and pages: it sees what it is there for.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { constants_of, with_changeable_constants } from "../../scripts/sensitivity/constants.mjs";
import { named_on, stale_names } from "../../scripts/sensitivity/page.mjs";

const root = dirname(dirname(dirname(fileURLToPath(import.meta.url))));

test("the page names constants that the sources have, with their values", () => {
  const page = readFileSync(join(root, "docs", "method", "sensitivity.md"), "utf8");
  assert.ok(named_on(page).length > 100, "docs/method/sensitivity.md names hardly any constants");
  assert.deepEqual(stale_names(page, constants_of(root)), [],
                   "docs/method/sensitivity.md is stale; `node scripts/sensitivity.mjs --page` makes it anew");
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
  double spread = 0.35, none = 0.0;  ///< rad
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
  assert.deepEqual(stale_names("| grasp/rest/other.cpp | kStep |\n", constants), ["kStep of src/palmar/grasp/rest/other.cpp is gone"]);
});
