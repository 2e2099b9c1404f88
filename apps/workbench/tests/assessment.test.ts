// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import assert from "node:assert/strict";
import { test } from "node:test";
import { GraspIndex } from "../types";
import { useLanguage } from "../texts";
import { bandComparison, errorBandSection } from "../components/error_band";
import { comparison } from "../components/comparison";
import { faceSection, placementTable, settingsTable, summaryTable } from "../components/contact_tables";
import { terms } from "../components/glossary";
import { resolutionNote } from "../components/resolution";
import { sensorSection } from "../components/sensors";
import { indexComparison, indexSection } from "../components/indices";
import { comfortSection, gripWords, readingAdvice, statusVerdict, statusWords, graspNotes } from "../components/verdicts";
import { assessmentPage } from "../pages/assessment";
import { assessment, page, vocabulary, withBand } from "./fixture";

function text(markup: { text: string } | null): string {
  return markup ? markup.text : "";
}

function count(all: string, part: string): number {
  return all.split(part).length - 1;
}

test("three questions of comfort have one scale each, with source and figure", () => {
  const one = assessment();
  const section = text(comfortSection(one, vocabulary));
  assert.equal(count(section, "data-question="), 3);
  for (const part of ["A moment of this grip doesn’t hurt.", "Johansson", "Chalmers", "12 % of the onset", "60 % of the onset", "62 %", "2.1 %"]) {
    assert.ok(section.indexOf(part) >= 0, part);
  }
  assert.match(section, /data-question="moment"[^]*badge good[^]*data-question="repeated"[^]*badge fair/);
  one.verdict.comfort = null;
  assert.match(text(comfortSection(one, vocabulary)), /no pressure to judge/);
});

test("nothing on the page contradicts the verdict", () => {
  const whole = assessmentPage(page([assessment()]));
  assert.equal(count(whole, "film"), 0);
  assert.doesNotMatch(whole, /algometer|far below pain|381/);
});

test("the first screen has the answer, pictures, a chart with its numbers, and what to do next", () => {
  const whole = assessmentPage(page([assessment(), assessment()]));
  const first = whole.split('id="answer"')[1].split("</section>")[0];
  for (const part of ["B presses 27 % less &lt;than&gt; A.", "Because &amp; why.", "Ask others:", "palmar study run --hands 12",
                      'src="attachment:p"', "<svg", 'class="unseen"', "(1, 2, 3) mm"]) {
    assert.ok(first.indexOf(part) >= 0, part);
  }
  // Every link of the contents leads to a section that is there.
  const links = whole.split('class="contents"')[1].split("</nav>")[0].match(/href="#[^"]+"/g) || [];
  assert.ok(links.length >= 5);
  for (const link of links) assert.equal(count(whole, 'id="' + link.slice(7, -1) + '"'), 1, link);
});

test("German pages have no English sentences of their own", () => {
  const shown = page([assessment(), assessment()]);
  shown.view.language = "de";
  const whole = assessmentPage(shown);
  assert.match(whole, /<html lang="de">/);
  for (const part of ["Was folgt", "Alle Zahlen nebeneinander", "Daumenballen", "0,0600"]) assert.ok(whole.indexOf(part) >= 0, part);
  assert.doesNotMatch(whole, /What follows|Results at a glance|Whole hand|Sections unfold/);
  useLanguage("en");
});

test("what is not held has dashes instead of verdicts", () => {
  const one = assessment();
  one.grasp.status = "too_small";
  const row = text(summaryTable([one], vocabulary)).split("<tbody>")[1];
  assert.match(row, /badge bad/);
  assert.match(row, /not in the hand/);
  assert.doesNotMatch(row, /pain|data-value/);
});

test("the grip and what set its force are those that were asked for", () => {
  const one = assessment();
  assert.equal(gripWords(one, vocabulary), "power grip");
  assert.match(readingAdvice([one], vocabulary), /close to a set depth.*nobody measured a force/);
  one.grasp.grip = "tripod";
  assert.equal(gripWords(one, vocabulary), "tripod grip");
  assert.match(readingAdvice([one], vocabulary), /fingertips are pressed in to a set depth/);
  one.settings.grip_force_asked_n = 10;
  one.settings.balance = true;
  assert.match(readingAdvice([one], vocabulary), /asked to grip with 10.0 N;/);
  one.settings.grip_force_from = "25 % of a strength";
  assert.match(readingAdvice([one], vocabulary), /asked to grip with 10.0 N \(25 % of a strength\);/);
  assert.doesNotMatch(assessmentPage(page([one])), /nobody measured/);
  one.grasp.grip = "tip_pinch";
  assert.equal(gripWords(one, vocabulary), "tip pinch");
  one.grasp.status = "not_graspable";
  assert.equal(statusWords(one, vocabulary), "No place for this grip");
});

test("a hold that is not at rest or touches with too little has an amber badge", () => {
  const one = assessment();
  assert.equal(statusVerdict(one), "good");
  assert.equal(statusWords(one, vocabulary), "Held");
  one.doubts = [{ key: "slips_out", words: "it slips" }];
  assert.equal(statusVerdict(one), "fair");
  assert.equal(statusWords(one, vocabulary), "Held, but slips out");
  one.doubts = [{ key: "not_at_rest", words: "it moves" }, { key: "few_contacts", words: "the thumb doesn't touch it" }];
  assert.equal(statusVerdict(one), "fair");
  assert.equal(statusWords(one, vocabulary), "Held, but not at rest and with too few fingers");
  assert.match(text(graspNotes(one, vocabulary)), /class="note fair"[^]*The thumb doesn/);
  const table = text(summaryTable([one], vocabulary));
  assert.match(table, /class="badge fair"/);
  assert.doesNotMatch(table, /class="badge good"/);
  one.grasp.status = "too_large";
  assert.equal(statusVerdict(one), "bad");
});

test("other ways to hold it are shown with the option that takes one", () => {
  const shown = page([assessment()]);
  assert.doesNotMatch(assessmentPage(shown), /Other ways to hold it/);
  shown.view.products[0].ways = [1, 2, 3].map((number) => ({ number, words: "medium wrap of the <handle>", score: -number, against: number === 3 ? "no room" : "" }));
  shown.view.products[0].way_taken = 1;
  const made = assessmentPage(shown);
  assert.match(made, /Other ways to hold it/);
  assert.match(made, /--hold 3/);
  assert.match(made, /Medium wrap of the &lt;handle&gt; \(score −3.0\); against it: no room/);
  assert.match(made, /This one is shown here/);
});

test("two products stand side by side with their differences", () => {
  const first = assessment(), second = assessment();
  second.contact.force_n = 10;
  second.contact.regions = [second.contact.regions[0]];
  const both = text(comparison([first, second], vocabulary));
  assert.match(both, /id="difference"/);
  assert.match(both, new RegExp('data-value="' + (10 - 12.3456789) + '"'));
  assert.match(both, />−4.35</); // only the first touches the thenar
  assert.equal(comparison([first], vocabulary), null);
  assert.doesNotMatch(text(comparison([first, first, second], vocabulary)), /id="difference"/);
});

test("the range from soft to stiff tissue is told with its causes", () => {
  const one = withBand(assessment(), 8.5, 15.5);
  const section = text(errorBandSection(one, "<svg>stiffer</svg>", vocabulary));
  assert.match(section, /8.50 to 15.5 N \(middle 12.3 N\)/);
  // 0.1 x 12 x 0.7 N; that region alone is more than half.
  assert.match(section, /10 % stiffer \(index finger, tip\), the hand would press with 0.84 N more. That region alone/);
  assert.match(section, /<svg>stiffer<\/svg>/);
  const softer = withBand(assessment(), 8.0, 16.0);
  assert.match(text(bandComparison(one, softer)), /−0.50 N with soft, 0 with middle and \+0.50 with stiff tissue. Which is higher depends on the skin/);
  const unsolved = withBand(assessment(), null, 15.5);
  assert.match(text(errorBandSection(unsolved, null, vocabulary)), /– to 15.5 N[\s\S]*could not be solved/);
  assert.equal(bandComparison(one, unsolved), null);
  assert.equal(errorBandSection(assessment(), null, vocabulary), null);
});

function index(key: string, group: string, value: number | null): GraspIndex {
  return { key, name: "name of " + key, group, value, unit: "mm2", lowest: 0, highest: 100, better: "down",
           definition: "area < limit", source: "Someone 1999", remark: "", told_apart: 0.1 };
}

test("indices have a table per group and unfold to definitions", () => {
  const section = text(indexSection([index("a", "stability", 0.123456), index("b", "stability", null), index("c", "comfort", 12)], vocabulary));
  assert.equal(count(section, "<table"), 2);
  assert.equal(count(section, "<details>"), 3);
  assert.match(section, /^<details class="inner">/); // folded until it is asked for
  assert.equal(count(section, "<tr"), count(section, "</tr>"));
  for (const part of ['data-value="0.123456"', "mm²", "area &lt; limit", "less is better", "0 to 100"]) {
    assert.ok(section.indexOf(part) >= 0, part);
  }
  assert.equal(indexSection([], vocabulary), null);
});

test("indices of several products stand row by row", () => {
  const both = text(indexComparison(["old", "new <2>"], [[index("a", "stability", 1), index("c", "comfort", 2)],
                                                        [index("b", "stability", 3), index("c", "comfort", 4)]]));
  assert.equal(count(both, 'data-index="a"'), 1);
  assert.equal(count(both, 'data-index="c"'), 1);
  assert.match(both, /new &lt;2&gt;/);
  // b belongs to the first group though only the second product has it.
  assert.ok(both.indexOf('data-index="b"') < both.indexOf('data-index="c"'));
  assert.match(both, /data-index="c".*\+2\.00 mm²/);
  assert.equal(indexComparison(["one"], [[index("a", "ease", 1)]]), null);
});

test("a difference within an index's error is none", () => {
  const both = text(indexComparison(["old", "new"], [[index("a", "stability", 1)], [index("a", "stability", 1.05)]]));
  assert.match(both, /same within its error/);
  assert.doesNotMatch(both, /0\.0500/);
});

test("the turn of the hand is that of its quaternion", () => {
  // cos 45°, about -z: a quarter of a turn.
  const placed = text(placementTable(assessment()));
  assert.match(placed, />90.0</);
  assert.match(placed, />0, 0, −1.00</);
});

test("faces name the peak; settings name the sleeve", () => {
  const one = assessment();
  assert.equal(faceSection(one), null);
  one.faces = [{ face: 7, title: "face 7 \"fillet 3\" (fillet r 3)", name: "fillet 3", part: "a & b", kind: "cylinder",
                 is_fillet: true, radius_mm: 3, area_mm2: 100, force_n: 20, contact_area_mm2: 80,
                 peak_pressure_mpa: 0.41, mean_pressure_mpa: 0.25, has_peak: true }];
  assert.match(text(faceSection(one)), /face 7 &quot;fillet 3&quot; \(fillet r 3\): 0.41 MPa/);
  assert.match(text(faceSection(one)), /a &amp; b/);
  one.settings.coatings = [{ thickness_mm: 3, shear_modulus_mpa: 0.1, poisson: 0.4, box_corners_mm: null }];
  assert.match(text(settingsTable(one)), /3.00 mm thick, shear modulus 100 kPa, Poisson’s ratio 0.40, on the whole product/);
});

test("a page is whole, forbids the network and asks for its attachments", () => {
  const whole = assessmentPage(page([withBand(assessment(), 8, 16), assessment()]));
  assert.match(whole, /^<!DOCTYPE html>/);
  assert.match(whole, /default-src 'none'/);
  assert.match(whole, /box &amp; &quot;co&quot;/);
  assert.match(whole, /Held by &lt;five&gt; fingers/);
  assert.match(whole, /palmar assess a &lt;b&gt;/);
  assert.match(whole, /id="palmar-assessment"><attachment:report>/);
  assert.doesNotMatch(whole, /undefined|\[object|NaN/);
  for (const tag of ["table", "tr", "td", "div", "details", "section", "p", "button", "article", "svg"]) {
    assert.equal(count(whole, "<" + tag + " ") + count(whole, "<" + tag + ">"), count(whole, "</" + tag + ">"), tag);
  }
});

test("every word of the glossary opens from where a report uses it", () => {
  // What only studies have: study.test.ts.
  const ofStudies = ["interval", "p_value", "effect_size", "t_test"];
  const one = withBand(assessment(), 8, 16);
  one.index_table = [index("a", "stability", 1), index("b", "ease", 1)];
  one.balance = { status: "balanced", message: "in balance", moved_mm: 1, turned_deg: 2, friction_in_use: 0.5, friction_coefficient: 0.5 } as typeof one.balance;
  const whole = assessmentPage(page([one]));
  const missing = terms.filter((key) => ofStudies.indexOf(key) < 0 && key !== "hold" && whole.indexOf(`popovertarget="term-${key}"`) < 0);
  assert.equal(String(missing), "");
});

test("a sensor's map and a measurement beside it are told in numbers", () => {
  const one = assessment();
  assert.equal(sensorSection(one, null, vocabulary), null);
  one.sensors = {
    layout: { name: "grip mat", kind: "mat", pitch_mm: 5, source: "" }, rows: 1, columns: 3, force_n: 10, force_beside_n: 1e-15,
    peak_pressure_mpa: 0.16, pressed_area_mm2: 75, cells: [], measured: null,
  };
  const alone = text(sensorSection(one, "<svg>map</svg>" as never, vocabulary));
  assert.match(alone, /“grip mat” is wrapped[^]*cells of 5 mm[^]*beside them 0 N[^]*160 kPa[^]*<svg>map/);
  assert.doesNotMatch(alone, /Pearson/);
  one.sensors.measured = {
    source: "grip.csv", force_measured_n: 20, force_simulated_n: 10, peak_measured_mpa: 0.32, peak_simulated_mpa: 0.16, compared: 3,
    pearson: { r: 0.5, n: 3, p_value: 0.6 }, spearman: { r: 0.25, n: 3, p_value: 0.8 }, rms_mpa: 0.05, mean_difference_mpa: -0.02,
    parts: [{ name: "thenar", cells: 2, measured_n: 14, simulated_n: 7 }, { name: "beside the hand", cells: 1, measured_n: 6, simulated_n: 0 }],
    cell_force_n: [],
  };
  const beside = text(sensorSection(one, null, vocabulary));
  assert.match(beside, /Over the 3 cells[^]*r 0.50, Spearman’s 0.25[^]*50.0 kPa/);
  assert.match(beside, /grip.csv[^]*no skin in the simulation/);
});

test("pressures on sharp edges are said not to be resolved", () => {
  const one = assessment();
  assert.equal(resolutionNote(one.contact, vocabulary), null);
  const region = one.contact.regions[0];
  region.unresolved_force_n = 0.2 * region.force_n;
  assert.equal(resolutionNote(one.contact, vocabulary), null);
  region.unresolved_force_n = 0.5 * region.force_n;
  one.contact.unresolved_force_n = region.unresolved_force_n;
  assert.match(text(resolutionNote(one.contact, vocabulary)), /not resolved[^]*of the force is on edges/);
  one.contact.refinement = { halvings: 2, vertices_added: 1442, finest_edge_mm: 0.49, last_change_of_peaks: 0.015, peak_pressure_cells_before_mpa: 0.227 };
  assert.match(text(resolutionNote(one.contact, vocabulary)), /refined on sharp edges[^]*1442 points[^]*0.5 mm[^]*1.5 %/);
  one.contact.resolved = false;
  assert.match(text(resolutionNote(one.contact, vocabulary)), /not resolved[^]*1442 points/);
  one.contact.refinement = null;
  assert.match(text(resolutionNote(one.contact, vocabulary)), /not resolved[^]*of the force is on edges/);
});
