// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import assert from "node:assert/strict";
import { test } from "node:test";
import { headed, inUsUnits, shortened } from "../viewer/unit_words";

test("numbers before a unit are converted, with ranges, and nothing else", () => {
  // 1 MPa = 145.04 psi, 1 N = 0.22481 lbf, 645.16 mm² = 1 in², 25.4 mm = 1 in.
  assert.equal(inUsUnits("It presses hardest: 0.27 MPa on a sensor cell.", false), "It presses hardest: 39.2 psi on a sensor cell.");
  assert.equal(inUsUnits("0.21 to 0.34 MPa", false), "30.5 to 49.3 psi");
  assert.equal(inUsUnits("a grip of 107 N takes 25 %", false), "a grip of 24.1 lbf takes 25 %");
  assert.equal(inUsUnits("6451.6 mm² and 254 mm", false), "10.0 in² and 10.0 in");
  assert.equal(inUsUnits("12 N mm", false), "0.106 lbf in");
  assert.equal(inUsUnits("A −3.5 N less", false), "A −0.787 lbf less");
  assert.equal(inUsUnits("25 kPa, (22, 0, 16) mm, 30 Nothing, M3 mm", false), "3.63 psi, (22, 0, 16) mm, 30 Nothing, M3 mm");
});

test("German pages have decimal commas", () => {
  assert.equal(inUsUnits("0,27 MPa auf einer Sensorzelle", true), "39,2 psi auf einer Sensorzelle");
});

test("heads of columns say their unit at the end", () => {
  assert.equal((headed.exec("Highest pressure, MPa") || [])[1], "MPa");
  assert.equal((headed.exec("Area, mm²") || [])[1], "mm²");
  assert.equal(headed.exec("Hands"), null);
});

test("three digits, none before the point lost", () => {
  assert.equal(shortened(1234.56), "1235");
  assert.equal(shortened(0.0123456), "0.0123");
  assert.equal(shortened(0), "0");
});
