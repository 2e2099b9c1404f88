// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Picture, StudyConditionResult, StudyPage, StudyProvenance } from "../types";
import { say, sayCount, sayMarkup, useLanguage } from "../texts";
import { FirstScreen, firstScreen } from "../components/first_screen";
import { term } from "../components/glossary";
import { Child, Markup, html, trusted } from "../components/markup";
import { capitalised, shortNumber } from "../components/numbers";
import { Section, badge, colourBar, folded, licence, list, pictureFigures, turnableView } from "../components/parts";
import { changeBars, groupedBars } from "../components/small_charts";
import { accommodationSection, comparisonTable, dependenceTable, faceStatisticsSection, holdTable, overviewTable, quantityTable, sizeSections, studyRegionTable } from "../components/study_tables";
import { regionWords } from "../components/verdicts";
import { documentPage } from "./document";

const shownRegions = 6; // in the small chart

function warningNote(page: StudyPage): Child {
  const isOutside = page.warnings.some((one) => one.is_outside);
  const warnings = page.warnings.map((one) => html`<li><strong>${one.subject}:</strong> ${one.text}</li>`);
  return warnings.length > 0 && html`<div class="note ${isOutside ? "bad" : "fair"}"><strong>${say(isOutside ? "study.warning" : "study.caution")}</strong><ul class="plain">${warnings}</ul></div>
`;
}

function verdictSection(page: StudyPage): Section {
  return {
    id: "summary",
    title: say("study.section.verdict"),
    isOpen: true,
    content: html`${list(page.verdict)}${warningNote(page)}${overviewTable(page)}`,
  };
}

/// Mean pressures by region, product by product.
function regionChart(page: StudyPage): Markup | null {
  const first = page.conditions[0];
  const groups: { name: string; values: number[]; mark: number; most: number }[] = [];
  for (const name in page.vocabulary.regions) {
    const values = first.products.map((one) => one.regions[name] ? one.regions[name].peak_pressure_cells_mpa : 0);
    const mark = page.vocabulary.regions[name].discomfort_onset_mpa;
    const most = Math.max(...values) / mark;
    if (most > 0) groups.push({ name: regionWords(name, page.vocabulary), values, mark, most });
  }
  if (groups.length === 0) return null;
  groups.sort((a, b) => b.most - a.most);
  return groupedBars({
    title: say("chart.regions"), unit: "MPa", mark: say("chart.regions.mark"),
    names: page.products.map((one) => one.name), groups: groups.slice(0, shownRegions),
  });
}

function answer(page: StudyPage): FirstScreen {
  const first = page.conditions[0];
  const { answer: found } = page;
  const isPair = found.better !== null && found.worse !== null && found.changes.length > 1;
  const cards = page.products.map((product, p) => {
    const one = first.products[p];
    const mean = (key: string) => one.quantities[key] ? one.quantities[key].mean : null;
    const pictures: Picture[] = [];
    for (const name of ["hold", "mean_hand"]) {
      for (const picture of product.pictures) if (picture.name === name) pictures.push(picture);
    }
    const isAll = one.hands_holding === one.hands;
    return {
      title: product.name,
      badge: badge(isAll ? "good" : one.hands_holding > 0 ? "fair" : "bad",
                   say("study.fact.held") + " " + say("study.of", { count: one.hands_holding, n: one.hands })),
      pictures,
      facts: one.hands_holding === 0 ? [] : [
        [term("grip_force", say("study.fact.grip")), shortNumber(mean("grip_force_n")) + " N"],
        [term("peak_on_cells", say("study.fact.mean_cells")), shortNumber(mean("peak_pressure_cells_mpa")) + " MPa"],
        [term("contact_area", say("study.fact.area")), shortNumber(mean("contact_area_mm2")) + " mm²"],
      ] as [Child, string][],
    };
  });
  const populations = page.provenance.populations.map((one) => one.title || one.name).join(", ");
  return {
    kicker: say("study.kicker", {
      hands: sayCount("study.hands", page.hands), products: sayCount("study.products", page.products.length),
      grasps: page.grasps, planned: page.grasps_planned, population: populations,
    }),
    tone: found.tone,
    sentence: found.sentence,
    reasons: found.reasons,
    cards,
    scale: page.scene ? page.scene.scales.mean : null,
    chart: isPair
      ? changeBars(say("study.changes"), found.changes, page.products[found.better || 0].name, page.products[found.worse || 0].name)
      : regionChart(page),
    next: found.next,
    command: found.command,
  };
}

function condition(page: StudyPage, one: StudyConditionResult, index: number): Section {
  const drawn = html`<div class="figures">${one.figures.map((figure) => html`<figure>${trusted(figure.svg)}<figcaption>${figure.description}</figcaption></figure>
`)}</div>
`;
  const figures = !one.are_figures_shown
    ? html`<p>${say("study.figures.beside")}</p>
`
    : index === 0 ? drawn : folded(say("study.figures"), drawn);
  return {
    id: "condition-" + index,
    title: capitalised(one.title),
    isOpen: index === 0,
    content: html`${figures}${holdTable(page, one)}${faceStatisticsSection(page, one)}${comparisonTable(page, one)}${accommodationSection(page, one)}${sizeSections(page, one)}${dependenceTable(page, one)}${studyRegionTable(page, one)}${quantityTable(page, one)}`,
  };
}

function thresholdWords(page: StudyPage): string {
  return shortNumber(1000 * page.threshold_mpa) + " kPa";
}

function sceneSection(page: StudyPage): Section | null {
  const { scene } = page;
  if (!scene) return null;
  const first = page.conditions[0];
  const option = (value: number, words: string) => html`<option value="${value}">${words}</option>`;
  const controls = html`<div class="controls"><label>${say("study.view.product")} <select data-toggle="which-product">${page.products.map((one, p) => option(p, one.name))}</select></label><label>${say("study.view.show")} <select data-toggle="which-hand"><optgroup label="${say("study.view.over_all")}"><option value="mean">${say("study.view.mean")}</option><option value="sd">${say("study.view.sd")}</option><option value="above">${say("study.view.above", { limit: thresholdWords(page) })}</option></optgroup><optgroup label="${say("study.view.one_hand")}">${scene.hands.map((words, i) => option(i, words))}</optgroup></select></label></div>`;
  const which = scene.hands.length === scene.hands_in_all ? say("study.view.every")
    : say("study.view.some", { count: scene.hands.length, all: scene.hands_in_all });
  return {
    id: "turn",
    title: say("study.section.view"),
    content: html`<p>${first.words && say("study.view.first", { condition: capitalised(first.words), count: page.conditions.length }) + " "}${which} ${say("study.view.skin")}</p>
${turnableView({
      id: "study-scene",
      kind: "study",
      label: say("study.view.label"),
      fallback: say("study.view.fallback"),
      above: controls,
      bars: [colourBar(scene.scales.grasp, "grasp", false), colourBar(scene.scales.mean, "mean"),
             colourBar(scene.scales.sd, "sd", false), colourBar(scene.scales.above, "above", false)],
      below: html`<p class="view-says" aria-live="polite"></p><p class="view-says view-face">${say("study.view.point")}</p>`,
      toggles: [
        { key: "skin", words: say("view.skin"), isOn: true },
        { key: "pressure", words: say("view.pressure"), isOn: true },
        { key: "product", words: say("view.product"), isOn: true },
        { key: "footprint", words: say("view.footprint"), isOn: false },
        { key: "see-through", words: say("view.see_through"), isOn: true },
        ...(scene.has_faces ? [{ key: "faces", words: say("study.view.faces"), isOn: true }] : []),
        { key: "open", words: say("study.view.open"), isOn: false },
      ],
      scene: scene.data,
    })}`,
  };
}

function mapSection(page: StudyPage): Section | null {
  const shown = page.products.filter((one) => one.pictures.length > 0);
  if (shown.length === 0) return null;
  const which = page.conditions[0].words;
  return {
    id: "maps",
    title: which ? say("study.section.maps_of", { which }) : say("study.section.maps"),
    content: html`<p>${sayMarkup("study.maps.words", { limit: thresholdWords(page), term: term("blood_flow", say("study.maps.term")) })}</p>
${shown.map((one) => html`<h3>${one.name}</h3>${pictureFigures(one.pictures)}`)}`,
  };
}

function method(provenance: StudyProvenance): Section {
  return {
    id: "method",
    title: say("study.section.method"),
    content: html`<p>${say("study.method.1")}</p>
<p>${sayMarkup("study.method.2", {
      t_test: term("t_test"), p: term("p_value", say("study.method.p")), effect: term("effect_size", say("study.method.effect")),
      interval: term("interval", say("study.method.interval")),
    })}</p>
<p>${say("study.method.3")}</p>
${provenance.has_several_profiles && html`<p>${say("study.method.profiles")}</p>
`}<p>${say("study.method.source")}</p>
`,
  };
}

function hashWords(hash: string): string {
  return hash && ", SHA-256 " + hash.substr(0, 16) + "…";
}

function populationItems(one: StudyProvenance["populations"][0]): Child[] {
  return [say("study.p.population", {
    title: one.title || one.name, name: one.name, hands: sayCount("study.hands", one.hands), seed: one.seed,
    design: say("study.design." + one.design, { percent: shortNumber(100 * one.boundary_share) }),
  }) + (one.source && " " + say("study.p.source", { source: one.source })),
          ...one.cautions.map((text) => say("study.p.caution", { text }))];
}

function settingWords(one: StudyProvenance["settings"][0]): string {
  return say("study.p.setting", {
    name: one.name, palm: shortNumber(one.palm_limit_depth_mm), finger: shortNumber(one.finger_limit_depth_mm),
    force: one.grip_force_words && ", " + one.grip_force_words,
    rest: one.is_balanced ? say("study.p.rest", { friction: shortNumber(one.friction) }) : say("study.p.closed"),
    place: say(one.is_place_per_hand ? "study.p.per_hand" : "study.p.kept"), model: one.contact_model,
  });
}

function provenanceSection(page: StudyPage): Section {
  const p = page.provenance;
  const products = p.products.map((one) => say("study.p.product", {
    name: one.name, file: one.file, size: one.size !== 1 ? say("study.p.size", { size: shortNumber(one.size) }) : "",
    mass: one.mass_kg > 0 ? shortNumber(one.mass_kg) + " kg" : say("study.p.no_load"),
    posture: one.posture_of && say("study.p.posture", { name: one.posture_of }), hash: hashWords(one.sha256),
  }));
  const profiles = p.profiles.map((one) => say("study.p.profile", {
    name: one.name, range: shortNumber(one.range_share), strength: shortNumber(one.strength_share),
    gloves: shortNumber(one.glove_thickness_mm), nails: shortNumber(one.nail_length_mm), size: shortNumber(one.size_factor),
  }) + (one.source && " " + say("study.p.source", { source: one.source })));
  const grips = p.grips.map((one) => say("study.p.grip", { grip: one || say("study.p.auto") }));
  let populations: Child[] = [];
  for (const one of p.populations) populations = populations.concat(populationItems(one));
  const stiffness = p.stiffness.map((one) => say("study.p.stiffness.item", {
    region: one.region, touch: shortNumber(1000 * one.at_touch_mpa), limit: shortNumber(1000 * one.at_limit_mpa),
    depth: shortNumber(one.limit_depth_mm),
  }));
  return {
    id: "provenance",
    title: say("section.provenance"),
    content: html`<p>${say("study.p.study")} <code>${p.study}</code>, ${say("study.p.seed", { seed: p.seed })} ${p.sha256 ? html`${say("study.p.digest")} <code>${p.sha256}</code>.` : say("study.p.unfinished")}${p.program && " " + say("study.p.run_by", { program: p.program })} ${say("study.p.page_by", { build: page.maker.build })}</p>
<h3>${say("study.p.populations")}</h3>${list(populations)}<h3>${say("study.p.products")}</h3>${list(products)}<h3>${say("study.p.settings")}</h3>${list([...grips, ...p.settings.map(settingWords), ...profiles])}<h3>${say("study.p.hand")}</h3><p>${p.hand.name}, ${say("side." + p.hand.side)}; ${shortNumber(p.hand.hand_length_mm, 4)} mm, ${shortNumber(p.hand.hand_circumference_mm, 4)} mm${hashWords(p.hand.sha256)}. ${p.hand.provenance}</p>
<p>${say("study.p.stiffness", { list: stiffness.join("; ") })}</p>
<p>${say("study.p.valid")}</p>
${page.scene && licence(page.maker.viewer_licence)}`,
  };
}

/// A study without a name of its own is called after its products.
function titleOf(page: StudyPage): string {
  const names = page.products.map((one) => one.name);
  return page.title === names[0] ? names.join(" · ") : page.title;
}

/// The page of a study: the answer first; then the verdict in full with its cautions, by condition
/// figures, comparisons, who is left out, sizes; the 3-D view, maps, methods, provenance.
export function studyPage(page: StudyPage): string {
  useLanguage(page.language);
  return documentPage({
    title: say("study.title", { title: titleOf(page) }),
    first: firstScreen(answer(page)),
    sections: [
      verdictSection(page),
      ...page.conditions.map((one, i) => condition(page, one, i)),
      sceneSection(page),
      mapSection(page),
      method(page.provenance),
      provenanceSection(page),
    ],
    maker: page.maker,
    data: [{ id: "palmar-study", attachment: "data" }],
    desk: page.desk,
    hasViewer: page.scene !== null,
  });
}
