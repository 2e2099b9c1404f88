// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node tests/layers/layers_test.mjs: the check of the layering sees what it is there for.
import assert from "node:assert/strict";
import { join } from "node:path";
import { layering_faults } from "./layers.mjs";
import { in_tree } from "./made_up_tree.mjs";

const include = (path) => `#include "${path}"\n`;
const kModules = { "src/palmar/modules.txt": "# a comment\ncore: errors\ncontact: of skin\nmy_study: many\n" };
const faults = (files) => in_tree({ ...kModules, ...files }, (root) => layering_faults(join(root, "src")));

// What is in order: down the modules and the folders, tests up their module's folders.
assert.deepEqual(faults({
  "src/palmar/core/error.h": "",
  "src/palmar/contact/contact.h": include("palmar/core/error.h"),
  "src/palmar/contact/solve/lcp.cpp": include("palmar/contact/contact.h"),
  "src/palmar/contact/contact_test.cpp": include("palmar/contact/solve/lcp.h"),
  "src/palmar/my_study/study.h": include("palmar/contact/solve/lcp.h") + include("palmar/my_study/study.h"),
}), []);

// A module that includes one above it; one that modules.txt doesn't name; a test is no excuse here.
assert.deepEqual(faults({ "src/palmar/core/error_test.cpp": include("palmar/contact/contact.h") }),
  ['palmar/core/error_test.cpp: #include "palmar/contact/contact.h"']);
assert.deepEqual(faults({ "src/palmar/extra/a.h": "", "src/palmar/my_study/b.h": include("palmar/extra/a.h") }),
  ["palmar/extra: not in palmar/modules.txt", 'palmar/my_study/b.h: #include "palmar/extra/a.h"']);

// Folders in a circle: two, with the module's own folder; and three, of which none includes another both ways.
assert.deepEqual(faults({
  "src/palmar/contact/contact.cpp": include("palmar/contact/solve/lcp.h"),
  "src/palmar/contact/solve/lcp.h": include("palmar/contact/contact.h"),
}), [
  "palmar/contact: folders form a circle: . -> solve -> .",
  '  palmar/contact/contact.cpp: #include "palmar/contact/solve/lcp.h"',
  '  palmar/contact/solve/lcp.h: #include "palmar/contact/contact.h"',
]);
assert.deepEqual(faults({
  "src/palmar/contact/a/a.h": include("palmar/contact/b/deep/b.h"),
  "src/palmar/contact/b/deep/b.cpp": include("palmar/contact/c/c.h"),
  "src/palmar/contact/c/c.h": include("palmar/contact/a/a.h"),
}), [
  "palmar/contact: folders form a circle: a -> b/deep -> c -> a",
  '  palmar/contact/a/a.h: #include "palmar/contact/b/deep/b.h"',
  '  palmar/contact/b/deep/b.cpp: #include "palmar/contact/c/c.h"',
  '  palmar/contact/c/c.h: #include "palmar/contact/a/a.h"',
]);

// The house next door: it may include Palmar, wherever its module stands, and isn't included.
const kHands = { "src/hands/modules.txt": "imaging: volumes\nscan: of a hand\n" };
assert.deepEqual(faults({ ...kHands, "src/hands/imaging/volume.h": include("palmar/my_study/study.h") }), []);
assert.deepEqual(faults({ ...kHands, "src/palmar/my_study/study.h": include("hands/imaging/volume.h") }),
  ['palmar/my_study/study.h: #include "hands/imaging/volume.h"']);
assert.deepEqual(faults({ ...kHands, "src/hands/imaging/volume.h": include("hands/scan/scan.h") }),
  ['hands/imaging/volume.h: #include "hands/scan/scan.h"']);
assert.deepEqual(faults({
  ...kHands,
  "src/hands/scan/marks/mark.h": include("hands/scan/skin/skin.h"),
  "src/hands/scan/skin/skin.h": include("hands/scan/marks/mark.h"),
})[0], "hands/scan: folders form a circle: marks -> skin -> marks");

// An empty place is no tree in order.
assert.throws(() => in_tree({ "src/a.h": "" }, (root) => layering_faults(join(root, "src"))), /No modules.txt/);
console.log("The check of the layering fails where it must");
