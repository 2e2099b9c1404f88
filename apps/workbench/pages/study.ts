// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { StudyConditionResult, StudyPage, StudyProvenance } from "../types";
import { Child, Markup, html, trusted } from "../components/markup";
import { capitalised, counted, shortNumber } from "../components/numbers";
import { colourBar, folded, licence, list, pictureFigures, turnableView } from "../components/parts";
import { accommodationSection, comparisonTable, dependenceTable, faceStatisticsSection, holdTable, overviewTable, quantityTable, sizeSections, studyRegionTable } from "../components/study_tables";
import { documentPage } from "./document";

function summary(page: StudyPage): Markup {
  const isOutside = page.warnings.some((one) => one.is_outside);
  const warnings = page.warnings.map((one) => html`<li><strong>${one.subject}:</strong> ${one.text}</li>`);
  return html`<h2 class="first" id="summary">Verdict</h2>
${list(page.verdict)}${warnings.length > 0 && html`<div class="note ${isOutside ? "bad" : "fair"}"><strong>${isOutside ? "Warning: partly outside what was checked, or hands are missing." : "To be careful with."}</strong><ul class="plain">${warnings}</ul></div>
`}${overviewTable(page)}`;
}

function condition(page: StudyPage, one: StudyConditionResult, index: number): Markup {
  const drawn = html`<div class="figures">${one.figures.map((figure) => html`<figure>${trusted(figure.svg)}<figcaption>${figure.description}</figcaption></figure>
`)}</div>
`;
  const figures = !one.are_figures_shown
    ? html`<p>Its figures are beside this file in the folder figures.</p>
`
    : index === 0 ? drawn : folded("Figures", drawn);
  return html`<h2 id="condition-${index}">${capitalised(one.title)}</h2>
${figures}${holdTable(page, one)}${faceStatisticsSection(page, one)}${comparisonTable(page, one)}${accommodationSection(page, one)}${sizeSections(page, one)}${dependenceTable(page, one)}${studyRegionTable(page, one)}${quantityTable(page, one)}`;
}

function thresholdWords(page: StudyPage): string {
  return shortNumber(1000 * page.threshold_mpa) + " kPa";
}

function sceneSection(page: StudyPage): Markup | null {
  const { scene } = page;
  if (!scene) return null;
  const first = page.conditions[0];
  const option = (value: number, words: string) => html`<option value="${value}">${words}</option>`;
  const controls = html`<div class="controls"><label>Product <select data-toggle="which-product">${page.products.map((one, p) => option(p, one.name))}</select></label><label>Show <select data-toggle="which-hand"><optgroup label="Over all hands"><option value="mean">Mean pressure</option><option value="sd">Standard deviation</option><option value="above">Share of hands above ${thresholdWords(page)}</option></optgroup><optgroup label="One hand">${scene.hands.map((words, i) => option(i, words))}</optgroup></select></label></div>`;
  const which = scene.hands.length === scene.hands_in_all ? "Every hand with every product"
    : scene.hands.length + " of " + scene.hands_in_all + " hands, chosen evenly by hand length,";
  return html`<h2 id="turn">Turn it</h2>
<p>${first.words && html`<strong>${capitalised(first.words)}</strong>, the first of ${page.conditions.length} conditions. `}${which} and the maps over all hands. Skin that would be inside the product is drawn on its surface; the bulge beside the contact isn’t shown.</p>
${turnableView({
    id: "study-scene",
    kind: "study",
    label: "3-D view of hands and products",
    fallback: "The pictures below show the maps over all hands.",
    above: controls,
    bars: [colourBar(scene.scales.grasp, "grasp", false), colourBar(scene.scales.mean, "mean"),
           colourBar(scene.scales.sd, "sd", false), colourBar(scene.scales.above, "above", false)],
    below: html`<p class="view-says" aria-live="polite"></p>${scene.has_faces && html`<p class="view-says view-face">Point at the product: its face is named here.</p>`}`,
    toggles: [
      { key: "skin", words: "Hand", isOn: true },
      { key: "pressure", words: "Pressure on the skin", isOn: true },
      { key: "product", words: "Product", isOn: true },
      { key: "footprint", words: "Pressure on the product", isOn: false },
      { key: "see-through", words: "See through the product", isOn: true },
      ...(scene.has_faces ? [{ key: "faces", words: "Borders of faces", isOn: true }] : []),
      { key: "open", words: "Maps on the open hand", isOn: false },
    ],
    scene: scene.data,
  })}`;
}

function mapSection(page: StudyPage): Markup | null {
  const shown = page.products.filter((one) => one.pictures.length > 0);
  if (shown.length === 0) return null;
  const which = page.conditions[0].words;
  return html`<h2 id="maps">Where all hands press${which && ": " + which}</h2>
<p>Means over the hands that hold the product, vertex by vertex of the template’s skin and of the product; hands that don’t touch there count with 0. The threshold of ${thresholdWords(page)} is of the family <em>blood flow</em>: at more, the skin’s blood flow stops if the grip is held long (Chalmers thesis 2004, publication 208). It says nothing of pain.</p>
${shown.map((one) => html`<h3>${one.name}</h3>${pictureFigures(one.pictures)}`)}`;
}

function method(provenance: StudyProvenance): Markup {
  return html`<h2 id="method">How this was computed</h2>
<p>Every hand is the template scaled segment by segment to a sampled person’s dimensions. It closes round the product (Xie 2014, 5.5.1), comes to rest on it unless a setting says otherwise, and the skin’s contact is solved; equations and tissue are under Provenance. All hands have one tissue: people differ in stiffness, too. The sum of normal forces is not the reading of a dynamometer; the grip force is nearer to it.</p>
<p>Products are compared over the same hands. The t-test is Student’s for pairs, as in the thesis; Wilcoxon’s signed-rank test needs no normal differences. p values are corrected after Holm over all pairs of a quantity. Cohen’s dz is the mean difference over the standard deviation of the differences. <strong>These are simulated hands: enough of them make any difference significant.</strong> Judge by the size of the difference and its interval; p says only that it isn’t the chance of which hands were drawn. It doesn’t cover the errors of the model, which are larger: compare products, don’t take single figures for people’s.</p>
<p>Shares have intervals after Wilson. A hand that doesn’t hold a product counts as outside the limits and is left out of means and tests; tables say how many and why. Sizes: every subset of a family’s sizes was tried.</p>
${provenance.has_several_profiles && html`<p>Profiles take range, strength, gloves, nails and size as factors on any population. They are not measured people.</p>
`}<p>Methods: Y. Xie, Plausible 3D Human Hand Modeling for Virtual Ergonomic Assessments of Handheld Product, Hokkaido University, 2014, chapter 5, with the changes that Palmar’s documentation lists.</p>
`;
}

function hashWords(hash: string): string {
  return hash && ", SHA-256 " + hash.substr(0, 16) + "…";
}

function populationItems(one: StudyProvenance["populations"][0]): Child[] {
  const designs = {
    random: "drawn at random",
    latin_hypercube: "Latin hypercube",
    boundary: "boundary of the " + shortNumber(100 * one.boundary_share) + " % ellipse",
    percentiles: "percentiles",
  };
  return [(one.title || one.name) + " (" + one.name + "): " + one.hands + " hands, " + designs[one.design] + ", seed " +
          one.seed + (one.source && ". Source: " + one.source),
          ...one.cautions.map((caution) => "Caution: " + caution)];
}

function settingWords(one: StudyProvenance["settings"][0]): string {
  return "Setting " + one.name + ": pressed in up to " + shortNumber(one.palm_limit_depth_mm) + " mm (palm) and " +
    shortNumber(one.finger_limit_depth_mm) + " mm (fingers)" +
    (one.grip_force_words && ", " + one.grip_force_words) +
    (one.is_balanced ? ", brought to rest with friction " + shortNumber(one.friction) : ", left as the hand was closed") +
    (one.is_place_per_hand ? "; place searched for every hand" : "; place found on the mean hand and kept") +
    "; equations: " + one.contact_model;
}

function provenanceSection(page: StudyPage): Markup {
  const p = page.provenance;
  const products = p.products.map((one) =>
    one.name + ": " + one.file + (one.size !== 1 ? ", size " + shortNumber(one.size) : "") +
    (one.mass_kg > 0 ? ", " + shortNumber(one.mass_kg) + " kg" : ", no load") +
    (one.posture_of && ", in the posture of " + one.posture_of) + hashWords(one.sha256));
  const profiles = p.profiles.map((one) =>
    "Profile " + one.name + ": range × " + shortNumber(one.range_share) + ", strength × " + shortNumber(one.strength_share) +
    ", gloves " + shortNumber(one.glove_thickness_mm) + " mm, nails " + shortNumber(one.nail_length_mm) + " mm, size × " +
    shortNumber(one.size_factor) + (one.source && ". Source: " + one.source));
  const grips = p.grips.map((one) => "Grip: " + (one || "the power grip that suits the shape"));
  let populations: Child[] = [];
  for (const one of p.populations) populations = populations.concat(populationItems(one));
  const stiffness = p.stiffness.map((one) =>
    one.region + " " + shortNumber(1000 * one.at_touch_mpa) + " and " + shortNumber(1000 * one.at_limit_mpa) + " kPa at " +
    shortNumber(one.limit_depth_mm) + " mm");
  return html`<h2 id="provenance">Provenance</h2>
<p>Study <code>${p.study}</code>, seed ${p.seed}. ${p.sha256 ? html`Results: SHA-256 <code>${p.sha256}</code>.` : "The study isn’t finished, so its results have no digest."}${p.program && " Run by Palmar " + p.program + "."} This page by ${page.maker.build}.</p>
<h3>Populations</h3>${list(populations)}<h3>Products</h3>${list(products)}<h3>Grips, settings, profiles</h3>${list([...grips, ...p.settings.map(settingWords), ...profiles])}<h3>Hand and tissue</h3><p>${p.hand.name}, ${p.hand.side}; length ${shortNumber(p.hand.hand_length_mm, 4)} mm, circumference ${shortNumber(p.hand.hand_circumference_mm, 4)} mm${hashWords(p.hand.sha256)}. ${p.hand.provenance}</p>
<p>Stiffness of the skin (shear modulus at first touch and at the limit depth): ${stiffness.join("; ")}.</p>
<p>Valid for: adult hands of about 150 to 215 mm, rigid products, handles of 25 to 70 mm, indentation up to 4 mm (fingers) and 7 mm (palm), a hold of some seconds.</p>
${page.scene && licence(page.maker.viewer_licence)}`;
}

/// The page of a study: verdict in words and what to be careful with first; then, by condition,
/// figures, comparisons, who is left out, sizes; the 3-D view, maps, methods, provenance.
export function studyPage(page: StudyPage): string {
  const title = "Palmar study: " + page.title;
  return documentPage({
    title,
    summary: html`<p>${counted(page.hands, "hand")} × ${counted(page.products.length, "product")}, ${page.grasps} of ${page.grasps_planned} grasps.</p>`,
    body: html`${summary(page)}${page.conditions.map((one, i) => condition(page, one, i))}${sceneSection(page)}${mapSection(page)}${method(page.provenance)}${provenanceSection(page)}`,
    maker: page.maker,
    data: [{ id: "palmar-study", attachment: "data" }],
    hasViewer: page.scene !== null,
  });
}
