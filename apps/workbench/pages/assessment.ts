// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Assessment, AssessmentPage, AssessmentView, Picture, RegionContact } from "../types";
import { say, useLanguage } from "../texts";
import { errorBandSection } from "../components/error_band";
import { comparison } from "../components/comparison";
import { faceSection, frictionSection, placementTable, postureTable, regionTable, settingsTable, stopTable, summaryTable } from "../components/contact_tables";
import { FirstScreen, firstScreen } from "../components/first_screen";
import { term } from "../components/glossary";
import { indexSection } from "../components/indices";
import { Child, Markup, html } from "../components/markup";
import { resolutionNote } from "../components/resolution";
import { sensorSection } from "../components/sensors";
import { capitalised, percent, shortNumber } from "../components/numbers";
import { Section, Toggle, Verdict, badge, charts, colourBar, folded, licence, list, note, pictureFigures, turnableView } from "../components/parts";
import { groupedBars } from "../components/small_charts";
import { balanceVerdict, comfortSection, graspNotes, gripWords, isInHand, readingAdvice, regionWords, statusVerdict, statusWords } from "../components/verdicts";
import { documentPage } from "./document";

const shownRegions = 6; // in the small chart; the sections below have all

function viewToggles(): Toggle[] {
  return [
    { key: "skin", words: say("view.skin"), isOn: true },
    { key: "pressure", words: say("view.pressure"), isOn: true },
    { key: "undeformed", words: say("view.undeformed"), isOn: false },
    { key: "product", words: say("view.product"), isOn: true },
    { key: "footprint", words: say("view.footprint"), isOn: false },
    { key: "see-through", words: say("view.see_through"), isOn: true },
  ];
}

/// Where the view says what is pointed at.
function pointLine(): Markup {
  return html`<p class="view-says view-point" aria-live="polite">${say("view.point")}</p>`;
}

/// The first two products side by side, looked at from the same side of the hand.
function pairView(all: Assessment[], view: AssessmentView): Markup | null {
  if (all.length < 2) return null;
  const names = [all[0].product.name, all[1].product.name];
  return html`<div class="on-screen"><h3>${say("view.pair", { first: names[0], second: names[1] })}</h3>${turnableView({
    id: "scene-0 scene-1",
    label: names.map((product) => say("view.label", { product })).join("\n"),
    fallback: say("view.pictures"),
    bars: colourBar(view.scale),
    below: pointLine(),
    toggles: viewToggles(),
    scene: null,
  })}</div>`;
}

function productSection(one: Assessment, view: AssessmentView, index: number): Section {
  const { vocabulary } = view;
  const shown = view.products[index];
  const isJudged = isInHand(one);
  const contact = isJudged
    ? html`<h3>${say("section.where")}</h3>${charts(shown.charts.map((chart) => chart.svg))}${regionTable(one.contact, vocabulary)}${resolutionNote(one.contact, vocabulary)}${faceSection(one)}${sensorSection(one, shown.sensor_map, vocabulary)}${errorBandSection(one, shown.sensitivity_chart, vocabulary)}`
    : one.contact.regions.length > 0 && folded(say("section.touches"), regionTable(one.contact, vocabulary));
  const pictures = pictureFigures(shown.pictures.filter((picture) => picture.name !== "holds"));
  return {
    id: "product-" + index,
    title: one.product.name,
    isOpen: index === 0,
    content: html`${graspNotes(one, vocabulary)}<h3>${say("section.comfort")}</h3>${comfortSection(one, vocabulary)}${isJudged && balanceVerdict(one)}<h3 class="on-screen">${say("section.view")}</h3>${turnableView({
      id: "scene-" + index,
      label: say("view.label", { product: one.product.name }),
      fallback: say("view.pictures"),
      bars: colourBar(view.scale),
      below: pointLine(),
      toggles: viewToggles(),
      scene: shown.scene,
    })}${contact}${frictionSection(one.friction, shown.friction_words, vocabulary)}${waysSection(shown)}${pictures && folded(say("section.pictures"), pictures)}${indexSection(one.index_table, vocabulary)}${folded(say("stops.caption"), stopTable(one, vocabulary))}${folded(say("section.posture"), html`${postureTable(one, vocabulary)}${placementTable(one)}`)}${folded(say("section.settings"), html`${settingsTable(one)}<p>${say("product.from", { source: one.product.source, unit: one.product.unit, from: one.product.unit_from, triangles: one.product.triangles })}</p>`)}`,
  };
}

/// Other ways to hold the product, to look at and choose from.
function waysSection(shown: AssessmentView["products"][0]): Markup | null {
  if (shown.ways.length < 2) return null;
  const sheet = pictureFigures(shown.pictures.filter((picture) => picture.name === "holds"));
  const items = shown.ways.map((way) => html`${way.number}. ${capitalised(way.words)}${way.score !== null && say("ways.score", { score: shortNumber(way.score, 2) })}${way.against && say("ways.against", { against: way.against })}${way.number === shown.way_taken && html` <strong>${say("ways.taken")}</strong>${shown.why_taken && " " + shown.why_taken + "."}`}`);
  const other = shown.ways.filter((way) => way.number !== shown.way_taken && way.number >= 3)[0] ||
    shown.ways.filter((way) => way.number !== shown.way_taken)[0];
  return folded(say("ways.title"), html`<p><code>--hold ${other.number}</code>: ${say("ways.option", { number: other.number })}</p>
${sheet}${list(items)}`);
}

/// What the equations that ran leave out.
function methodLimits(first: Assessment): Section {
  const { settings } = first;
  const keys = [
    settings.tissue_model === "halfspace" ? "halfspace" : "layered",
    settings.balance ? "rest" : "closed",
    first.friction !== undefined ? "friction" : "no_load",
    "forces",
    settings.coatings.length > 0 ? "sleeve" : "rigid",
    "edges",
    "one_hand",
    settings.regions === "independent" ? "independent" : "",
    "comfort",
  ];
  return {
    id: "limits",
    title: say("section.limits"),
    content: html`${list(keys.filter((key) => key !== "").map((key) => say("limit." + key)))}<p>${say("limits.equations", { model: settings.contact_model })} ${say(settings.contact_model === "xie2014" ? "limits.method" : "limits.method_changed")}</p>
`,
  };
}

function provenance(page: AssessmentPage): Section {
  const { hand } = page.report.assessments[0];
  const { maker } = page.view;
  return {
    id: "provenance",
    title: say("section.provenance"),
    content: html`<p>${say("provenance.hand", {
      name: hand.name, side: say("side." + hand.side), length: shortNumber(hand.hand_length_mm, 4),
      circumference: shortNumber(hand.hand_circumference_mm, 4), width: shortNumber(hand.hand_width_mm),
    })} ${hand.provenance}</p>
<p>${capitalised(maker.build)}.</p>
${page.report.command_line && html`<p>${say("provenance.made_by")} <code>${page.report.command_line}</code></p>
`}${licence(maker.viewer_licence)}`,
  };
}

/// Peak pressures of the regions that are pressed hardest, product by product.
function regionChart(all: Assessment[], view: AssessmentView): Markup | null {
  const shown = all.filter(isInHand);
  if (shown.length === 0) return null;
  const of = (one: Assessment, name: string): RegionContact | undefined =>
    one.contact.regions.filter((region) => region.region === name)[0];
  const groups: { name: string; values: number[]; mark: number; most: number }[] = [];
  for (const name in view.vocabulary.regions) {
    const values = shown.map((one) => {
      const region = of(one, name);
      return region ? region.peak_pressure_cells_mpa : 0;
    });
    const mark = view.vocabulary.regions[name].discomfort_onset_mpa;
    const most = Math.max(...values) / mark;
    if (most > 0) groups.push({ name: regionWords(name, view.vocabulary), values, mark, most });
  }
  groups.sort((a, b) => b.most - a.most);
  return groupedBars({
    title: say("chart.regions"), unit: "MPa", mark: say("chart.regions.mark"),
    names: shown.map((one) => one.product.name), groups: groups.slice(0, shownRegions),
  });
}

function pictureNamed(pictures: Picture[], names: string[]): Picture[] {
  const found: Picture[] = [];
  for (const name of names) {
    for (const one of pictures) if (one.name === name) found.push(one);
  }
  return found;
}

function tone(page: AssessmentPage): Verdict {
  const all = page.report.assessments;
  if (all.length > 1) {
    const { best, comparisons } = page.report.verdict;
    const isByShape = comparisons.every((one) => one.held_alike || one.verdict === "only_one_held");
    return best !== null && isByShape ? "good" : "fair";
  }
  const { held, comfort } = all[0].verdict;
  if (held === "not_held" || (comfort && comfort.moment.level === "above")) return "bad";
  return held !== "doubtful" && comfort && comfort.repeated.level === "below" ? "good" : "fair";
}

function answer(page: AssessmentPage): FirstScreen {
  const { view, report } = page;
  const all = report.assessments;
  const { hand } = all[0];
  const cards = all.map((one, i) => {
    const { contact } = one;
    const isHeld = isInHand(one);
    const facts: [Child, string][] = isHeld ? [
      [term("grip_force", say("fact.grip_force")), shortNumber(contact.grip_force_n) + " N"],
      [term("peak_on_cells", say("fact.cells")), shortNumber(contact.peak_pressure_cells_mpa) + " MPa"],
      [term("contact_area", say("fact.area")), shortNumber(contact.contact_area_mm2) + " mm²"],
    ] : [];
    if (one.verdict.hardest && isHeld) {
      const { region, face, on_product_mm } = one.verdict.hardest;
      facts.push([say("fact.hardest"), regionWords(region, view.vocabulary)]);
      const place = face || (on_product_mm && "(" + on_product_mm.map((x) => shortNumber(Math.round(x), 1)).join(", ") + ") mm");
      if (place) facts.push([say("fact.on_product"), place]);
    }
    if (isHeld && one.verdict.strength?.share != null) facts.push([term("strength", say("fact.strength")), percent(one.verdict.strength.share)]);
    return {
      title: one.product.name,
      badge: badge(statusVerdict(one), statusWords(one, view.vocabulary)),
      // Seen from the palm's side, what is too large would hide the hand.
      pictures: pictureNamed(view.products[i].pictures, isHeld ? ["grasp_palm", "map_open_hand"] : ["grasp_back"]),
      facts,
    };
  });
  return {
    kicker: say("answer.kicker", { side: say("side." + hand.side), length: shortNumber(hand.hand_length_mm), grip: gripWords(all[0], view.vocabulary) }),
    tone: tone(page),
    sentence: report.verdict.sentence,
    reasons: report.verdict.reasons,
    cards,
    scale: view.scale,
    chart: regionChart(all, view),
    next: report.verdict.next,
    command: report.verdict.command,
    warning: view.is_cut_short && note("fair", say("answer.cut_short"), say("answer.cut_short.words")),
  };
}

/// The page of one hand and its products: the answer, then a section per product.
export function assessmentPage(page: AssessmentPage): string {
  const { view } = page;
  useLanguage(view.language);
  const all = page.report.assessments;
  const side = comparison(all, view.vocabulary);
  const scale = say(view.scale.is_open_ended ? "scale.open" : "scale.closed", { upper: shortNumber(view.scale.upper), unit: view.scale.unit });
  return documentPage({
    title: all.map((one) => one.product.name).join(" · "),
    first: firstScreen(answer(page)),
    sections: [
      {
        id: "figures",
        title: say("section.figures"),
        isOpen: true,
        content: html`${summaryTable(all, view.vocabulary)}${pairView(all, view)}<p>${readingAdvice(all, view.vocabulary)}</p>
${side}<p>${say("figures.small")} ${scale} ${say("figures.full")}</p>
`,
      },
      ...all.map((one, i) => productSection(one, view, i)),
      methodLimits(all[0]),
      provenance(page),
    ],
    maker: view.maker,
    data: [{ id: "palmar-assessment", attachment: "report" }, { id: "palmar-view", attachment: "view" }],
    desk: view.desk,
    hasViewer: true,
  });
}
