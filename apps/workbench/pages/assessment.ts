// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Assessment, AssessmentPage, AssessmentView } from "../types";
import { errorBandSection } from "../components/error_band";
import { comparison } from "../components/comparison";
import { faceSection, frictionSection, placementTable, postureTable, regionTable, settingsTable, stopTable, summaryTable } from "../components/contact_tables";
import { indexSection } from "../components/indices";
import { Markup, html } from "../components/markup";
import { capitalised, shortNumber } from "../components/numbers";
import { charts, colourBar, folded, licence, list, note, pictureFigures, turnableView } from "../components/parts";
import { balanceVerdict, graspNotes, gripWords, isInHand, plainSummary, pressureVerdict, readingAdvice } from "../components/verdicts";
import { documentPage } from "./document";

function productSection(one: Assessment, view: AssessmentView, index: number): Markup {
  const { vocabulary } = view;
  const shown = view.products[index];
  const isJudged = isInHand(one);
  const contact = isJudged
    ? html`${charts(shown.charts.map((chart) => chart.svg))}${regionTable(one.contact, vocabulary)}${faceSection(one)}${errorBandSection(one, shown.sensitivity_chart, vocabulary)}`
    : one.contact.regions.length > 0 && folded("What the hand touches all the same", regionTable(one.contact, vocabulary));
  const pictures = pictureFigures(shown.pictures.filter((picture) => picture.name !== "holds"));
  return html`<h2 id="product-${index}">${one.product.name}</h2>
${graspNotes(one, vocabulary)}${pressureVerdict(one, vocabulary)}${isJudged && balanceVerdict(one)}<h3>Turn it</h3>${turnableView({
    id: "scene-" + index,
    label: "3-D view of the hand and " + one.product.name,
    fallback: "The pictures below show the same result from four sides.",
    bars: colourBar(view.scale),
    toggles: [
      { key: "skin", words: "Hand", isOn: true },
      { key: "pressure", words: "Pressure on the skin", isOn: true },
      { key: "undeformed", words: "Skin before contact", isOn: false },
      { key: "product", words: "Product", isOn: true },
      { key: "footprint", words: "Pressure on the product", isOn: false },
      { key: "see-through", words: "See through the product", isOn: true },
    ],
    scene: shown.scene,
  })}${contact}${frictionSection(one.friction, shown.friction_words, vocabulary)}${indexSection(one.index_table)}${pictures && html`<h3>Pictures</h3>${pictures}`}${waysSection(shown)}${folded("What stopped each segment", stopTable(one, vocabulary))}${folded("Posture and placement", html`${postureTable(one, vocabulary)}${placementTable(one)}`)}${folded("Settings and product", html`${settingsTable(one)}<p>Product from ${one.product.source}; unit ${one.product.unit} (${one.product.unit_from}); ${one.product.triangles} triangles.</p>`)}`;
}

/// Other ways to hold the product, to look at and choose from.
function waysSection(shown: AssessmentView["products"][0]): Markup | null {
  if (shown.ways.length < 2) return null;
  const sheet = pictureFigures(shown.pictures.filter((picture) => picture.name === "holds"));
  const items = shown.ways.map((way) => html`${way.number}. ${capitalised(way.words)}${way.score !== null && " (score " + way.score.toFixed(1) + ")"}${way.against && "; against it: " + way.against}${way.number === shown.way_taken && html` <strong>This one is shown here.</strong>`}`);
  const other = shown.ways.filter((way) => way.number !== shown.way_taken && way.number >= 3)[0] ||
    shown.ways.filter((way) => way.number !== shown.way_taken)[0];
  return html`<h3>Other ways to hold it</h3><p>Add <code>--hold ${other.number}</code> to the command to take number ${other.number}; <code>palmar grasp holds</code> writes each to a file. Score 0 is best.</p>
${sheet}${list(items)}`;
}

/// What the equations that ran leave out.
function methodLimits(first: Assessment): Markup {
  const { settings } = first;
  const hasFriction = first.friction !== undefined;
  const items = [
    settings.tissue_model === "halfspace"
      ? "The skin is endlessly deep tissue whose stiffness grows with depth, region by region; the bone under it is not modelled, so peaks over bone are too low where the skin is thin."
      : "The skin is one elastic layer over bone, as thick as the skin over the bones of this hand; fat, nail and tendons are not distinguished.",
    settings.balance
      ? "Product and fingers come to rest once; people also change their hold, spread the fingers and press harder when they feel it slip."
      : "The hand is as it was closed to given depths: forces don't balance.",
    hasFriction
      ? "The margin against slip is that of friction alone at these pressures, whose own sum is not in it."
      : "No weight of the product and no tool forces were given.",
    "The sum of the forces is not the reading of a dynamometer, nor the grip force across a plane: the three differ by a factor of 2 to 3.",
    (settings.coatings.length > 0
      ? "Under its sleeve the product is rigid, and the sleeve is elastic at any squeeze, without bottoming out;"
      : "The product is rigid;") + " edges sharper than the skin's mesh (about 2.5 mm) are seen blunter than they are.",
    "One hand. Other people's hands are larger, smaller, stiffer or softer. Its bones are synthetic.",
    settings.regions === "independent" &&
      "Regions are solved one by one; neighbours don't push each other's skin down, which makes forces too high where they meet.",
    "Limits of pressure come in families that differ tenfold. Film peak values at pain onset (ISO/TS 15066:2016: finger 3.0, palm 2.6, ball of the thumb 2.0 MPa) are compared with the peak pressure; the 0.05 MPa at which blood flow stops is compared with the peak averaged on 24 mm² sensor cells and concern grips held long. Neither is a verdict on comfort.",
  ];
  return html`<h2 id="limits">What this does not model</h2>
<ul>
${items.map((one) => one && html`<li>${one}</li>
`)}</ul>
<p>Equations that ran: ${settings.contact_model}. Methods: Y. Xie, Plausible 3D Human Hand Modeling for Virtual Ergonomic Assessments of Handheld Product, Hokkaido University, 2014${settings.contact_model !== "xie2014" && ", with the changes that Palmar's documentation lists with their effects"}.</p>
`;
}

function provenance(page: AssessmentPage): Markup {
  const { hand } = page.report.assessments[0];
  const { maker } = page.view;
  return html`<h2 id="provenance">Provenance</h2>
<p>Hand: ${hand.name}, ${hand.side}; length ${shortNumber(hand.hand_length_mm, 4)} mm, circumference ${shortNumber(hand.hand_circumference_mm, 4)} mm, width ${shortNumber(hand.hand_width_mm, 3)} mm. ${hand.provenance}</p>
<p>Palmar ${maker.build}.</p>
${page.report.command_line && html`<p>Made by: <code>${page.report.command_line}</code></p>
`}${licence(maker.viewer_licence)}`;
}

/// The page of one hand and its products: summary, then a section per product.
export function assessmentPage(page: AssessmentPage): string {
  const { view } = page;
  const all = page.report.assessments;
  const { hand } = all[0];
  const title = "Palmar report: " + (all.length === 1 ? all[0].product.name : all.length + " products");
  const body = html`<h2 class="first" id="summary">Summary</h2>
${note("", "How to read it.", readingAdvice(all, view.vocabulary))}${view.is_cut_short && note("fair", "Cut short.", "This run was cancelled: pictures, and perhaps whole products, are missing. The numbers shown are complete.")}${summaryTable(all, view.vocabulary)}${plainSummary(all, view.vocabulary)}${comparison(all, view.products.map((one) => one.pictures), view.vocabulary)}<p>Peak pressure is the largest at one vertex of the skin; the peak on sensor cells is averaged over the area of a pressure mat's cell and is the figure to compare with measurements. Small figures under a result are its range from soft to stiff tissue. All pictures share one colour scale, 0 to ${shortNumber(view.scale.upper)} ${view.scale.unit}${view.scale.is_open_ended && "; single vertices above that have the colour of its end"} (1 MPa = 1 N/mm² = 1000 kPa). Numbers are shortened for reading; assessment.json holds them in full.</p>
${all.map((one, i) => productSection(one, view, i))}${methodLimits(all[0])}${provenance(page)}`;
  return documentPage({
    title,
    summary: html`<p>How a ${hand.side} hand of ${shortNumber(hand.hand_length_mm)} mm length holds it in a ${gripWords(all[0], view.vocabulary)}: where it presses and how hard.</p>`,
    body,
    maker: view.maker,
    data: [{ id: "palmar-assessment", attachment: "report" }, { id: "palmar-view", attachment: "view" }],
    hasViewer: true,
  });
}
