// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import assert from "node:assert/strict";
import { test } from "node:test";
import { accommodationSection, comparisonTable, pWords, shareCell } from "../components/study_tables";
import { studyPage } from "../pages/study";
import { proportion, study } from "./fixture";

test("p values are told to what they are worth", () => {
  assert.equal(pWords(0.0004), "p < 0.001");
  assert.equal(pWords(0.0123), "p = 0.012");
  assert.equal(pWords(0.5), "p = 0.50");
});

test("a share stands with its interval", () => {
  assert.equal(shareCell(proportion(1, 4)).text,
               '<td class="n" data-value="0.25">25.0 %<br><span class="range">10 to 90 %</span></td>');
  assert.equal(shareCell({ count: 0, n: 0, share: null, low: null, high: null }).text, '<td class="n">–</td>');
});

test("pairs name the second less the first and who was left out", () => {
  const page = study();
  const table = comparisonTable(page, page.conditions[0]);
  assert.match(table ? table.text : "", /new − old.*5 of 6.*old: 1 slips out.*4 of 5.*−0.0400.*p &lt; 0.001.*p = 0.031.*differ/);
  // 0.01 of 0.25 MPa: shown by the tests, but less than a simulated grasp can resolve.
  page.conditions[0].comparisons[0].pairs[0].difference.value = -0.01;
  const small = comparisonTable(page, page.conditions[0]);
  assert.match(small ? small.text : "", /within the error/);
  page.conditions[0].comparisons[0].pairs[0].verdict = "too_few_pairs";
  const few = comparisonTable(page, page.conditions[0]);
  assert.match(few ? few.text : "", /too few hands/);
  page.products.pop();
  assert.equal(comparisonTable(page, page.conditions[0]), null);
});

test("nobody is left out unseen", () => {
  const page = study();
  const section = accommodationSection(page, page.conditions[0]).text;
  assert.match(section, /1 slips out, 1 not run/);
  assert.match(section, /160 to 170/);
  assert.match(section, /none stated, so inside means held/);
});

test("a study's page holds verdict, warnings and figures, and no script without a view", () => {
  const whole = studyPage(study());
  assert.match(whole, /Prisms &lt;of two sizes&gt;/);
  assert.match(whole, /6 hands × 2 products, 11 of 12 grasps/);
  assert.match(whole, /class="sentence good">New presses 16 % less than old\.</);
  assert.match(whole, /4 of 5 hands/); // bars below zero
  assert.match(whole, /<li>New is better.<\/li>/);
  assert.match(whole, /note bad.*Partly outside what was checked/);
  assert.match(whole, /<svg>dots<\/svg>/);
  assert.doesNotMatch(whole, /data-palmar-scene|undefined|NaN/);
});
