// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import assert from "node:assert/strict";
import { test } from "node:test";
import { escaped, html, joined, trusted } from "../components/markup";
import { percent, shortNumber, signedNumber } from "../components/numbers";
import { commandParts } from "../components/first_screen";
import { say, sayCount, sayList, sayMarkup, useLanguage } from "../texts";
import { numberCell, numbers, table, words } from "../components/tables";

test("nothing that is put in breaks out of text or attributes", () => {
  assert.equal(html`<a title="${'"><script>'}">${"<b>&'"}</a>`.text,
               '<a title="&quot;&gt;&lt;script&gt;">&lt;b&gt;&amp;&#39;</a>');
  assert.equal(escaped("a\u0001b\nc"), "a\ufffdb\nc");
  assert.equal(escaped("mm² 😀"), "mm² 😀");
});

test("markup is kept, lists are joined, nothing leaves nothing", () => {
  assert.equal(html`${[html`<b>1</b>`, "<", 2]}${null}${undefined}${false}${trusted("<svg/>")}`.text, "<b>1</b>&lt;2<svg/>");
  assert.equal(joined(["a", "b", "c"], html`<br>`).text, "a<br>b<br>c");
});

test("numbers are shortened, digits before the point stay", () => {
  assert.equal(shortNumber(0.18234), "0.182");
  assert.equal(shortNumber(1234.6), "1235");
  assert.equal(shortNumber(0), "0");
  assert.equal(shortNumber(-2.5), "−2.50");
  assert.equal(shortNumber(0.0123456), "0.0123");
  assert.equal(shortNumber(1000), "1000");
  assert.equal(shortNumber(0.001), "0.00100");
  assert.equal(shortNumber(-1e-9), "0");
  assert.equal(shortNumber(null), "–");
  assert.equal(shortNumber(NaN), "–");
  assert.equal(percent(0.0731), "7.3 %");
  assert.equal(signedNumber(-0.031) + " " + signedNumber(12) + " " + signedNumber(0), "−0.0310 +12.0 0");
  useLanguage("de");
  assert.equal(shortNumber(0.18234), "0,182");
  useLanguage("en");
});

test("sentences take their values, and say what is missing", () => {
  assert.equal(sayCount("study.hands", 1) + ", " + sayCount("study.hands", 6), "1 hand, 6 hands");
  assert.equal(sayList(["a", "b", "c"]) + "; " + sayList(["a"]), "a, b and c; a");
  assert.equal(sayMarkup("range", { low: html`<b>1</b>`, high: "<" }).text, "<b>1</b> to &lt;");
  assert.throws(() => say("range", { low: 1 }), /no value for high/);
  assert.throws(() => say("no such key"), /no sentence/);
});

test("a cell holds its number in full", () => {
  assert.equal(numberCell(0.123456789).text, '<td class="n" data-value="0.123456789">0.123</td>');
  assert.equal(numberCell(null).text, '<td class="n">–</td>');
});

test("a table has a caption and heads of its columns", () => {
  const text = table({ caption: "A < B", columns: [words("What"), numbers("Force, N")], rows: [] }).text;
  assert.match(text, /<caption><span>A &lt; B<\/span><\/caption>/);
  assert.match(text, /<th scope="col" class="n">Force, N<\/th>/);
});

test("a command breaks between options, values stay with theirs, quotes stay whole", () => {
  const line = "palmar assess 'my handle.stl' --grip-force-n 60 --mass-kg 0.4 --percentiles 5,50 --out hands";
  const parts = commandParts(line);
  assert.deepEqual(parts, [["palmar"], ["assess"], ["'my handle.stl'"], ["--grip-force-n", "60"], ["--mass-kg", "0.4"],
                           ["--percentiles", "5,50"], ["--out", "hands"]]);
  assert.equal(parts.map((part) => part.join(" ")).join(" "), line); // as it is copied
});
