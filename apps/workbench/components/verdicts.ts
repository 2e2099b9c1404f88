// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the results of one assessment mean, in sentences and in one table: three questions of
// comfort with one scale each, and the strength that the grip takes.

import { Assessment, ContactResult, OnsetVerdict, Vocabulary } from "../types";
import { say, sayList, sayMarkup, sayName } from "../texts";
import { Child, Markup, html, joined } from "./markup";
import { capitalised, length, percent, shortNumber } from "./numbers";
import { Verdict, badge, note } from "./parts";
import { cell, rowHead, table, words } from "./tables";
import { term } from "./glossary";

export function regionWords(name: string, vocabulary: Vocabulary): string {
  return sayName("region", name, vocabulary.regions[name] ? vocabulary.regions[name].words : name);
}

/// Whether the product is held, at least partly, and presses on the skin: only then do its forces and
/// pressures say how it feels to hold it.
export function isInHand(assessment: Assessment): boolean {
  const status = assessment.grasp.status;
  return (status === "held" || status === "partly_held") && assessment.contact.regions.length > 0;
}

/// Green only for a hold that nothing speaks against: at rest, with all that its grip needs.
export function statusVerdict(assessment: Assessment): Verdict {
  const status = assessment.grasp.status;
  // Held without contact is doubtful, too.
  if (status === "held") return isInHand(assessment) && assessment.doubts.length === 0 ? "good" : "fair";
  return status === "partly_held" ? "fair" : "bad";
}

export function isPower(assessment: Assessment, vocabulary: Vocabulary): boolean {
  return vocabulary.grips[assessment.grasp.grip].is_power;
}

/// "Held", "Too large for this hand"
export function statusWords(assessment: Assessment, vocabulary: Vocabulary): string {
  const { status, grip } = assessment.grasp;
  if (status === "not_graspable" && !isPower(assessment, vocabulary)) return say("badge.no_place");
  const unheld = status === "held" ? unheldWords[grip] : undefined;
  const shown = unheld ? say(unheld) : sayName("badge", status, vocabulary.statuses[status]);
  const doubts = assessment.doubts.map((one) => say("badge.doubt." + one.key));
  return doubts.length > 0 && status === "held" ? say("badge.but", { status: shown, doubts: sayList(doubts) }) : shown;
}

/// Of grips that hold nothing.
const unheldWords: { [grip: string]: string } = {
  resting_hand: "badge.rests",
  flat_hand: "badge.rests",
  finger_push: "badge.pushes",
};

/// "power grip", "tripod grip", "tip pinch"
export function gripWords(assessment: Assessment, vocabulary: Vocabulary): string {
  if (isPower(assessment, vocabulary)) return say("grip.power");
  const name = assessment.grasp.grip.replace(/_/g, " ");
  return /pinch$/.test(name) || assessment.grasp.grip in unheldWords ? name : say("grip.other", { name });
}

/// What decided how hard the hand grips, and how far to trust the figures.
export function readingAdvice(assessments: Assessment[], vocabulary: Vocabulary): string {
  const first = assessments[0];
  const force = first ? first.settings.grip_force_asked_n : null;
  const advice = " " + say("advice.compare");
  if (force !== null && first.settings.balance) {
    const from = first.settings.grip_force_from;
    return say(from ? "advice.asked_from" : "advice.asked", { force: shortNumber(force), from }) + advice;
  }
  return say(first && !isPower(first, vocabulary) ? "advice.pinch_depth" : "advice.depth") + advice;
}

function onsetAnswer(one: OnsetVerdict, vocabulary: Vocabulary): string {
  return say("comfort.answer." + one.level, {
    region: regionWords(one.region, vocabulary), percent: percent(one.share),
    pressure: shortNumber(one.pressure_mpa), onset: shortNumber(one.onset_mpa),
  });
}

/// The three questions of comfort, each with its scale, source and answer, and the sentence that
/// joins them; the strength that the grip takes.
export function comfortSection(assessment: Assessment, vocabulary: Vocabulary): Markup {
  const { comfort, strength, hardest } = assessment.verdict;
  if (!comfort) return html`<p>${say("comfort.none")}</p>
`;
  const tone = (one: OnsetVerdict): Verdict => one.level === "above" ? "bad" : one.level === "near" ? "fair" : "good";
  const { minutes } = comfort;
  const row = (key: string, verdict: Verdict, answer: string, name: Child) =>
    html`<tr data-question="${key}">${rowHead(say("comfort.question." + key))}${cell(html`${badge(verdict, say("comfort.badge." + verdict))} ${answer}`)}${cell(say("comfort.figure." + key))}${cell(sayMarkup("comfort.limit." + key, { name }))}${cell(say("comfort.source." + key))}</tr>
`;
  const stops = minutes.share_of_skin >= 0.01;
  return html`<p class="lead">${comfort.sentence}</p>
${hardest && html`<p>${hardest.sentence}</p>
`}${table({
    caption: say("comfort.caption"),
    columns: [words(say("comfort.head.question")), words(say("comfort.head.answer")), words(say("comfort.head.figure")),
              words(say("comfort.head.limit")), words(say("comfort.head.source"))],
    rows: [
      row("moment", tone(comfort.moment), onsetAnswer(comfort.moment, vocabulary), term("pain", say("comfort.limit.moment.term"))),
      row("repeated", tone(comfort.repeated), onsetAnswer(comfort.repeated, vocabulary), term("discomfort", say("comfort.limit.repeated.term"))),
      row("minutes", stops ? "fair" : "good", say(stops ? "comfort.answer.stops" : "comfort.answer.flows", { percent: percent(minutes.share_of_skin), area: shortNumber(minutes.area_mm2) }), term("blood_flow", say("comfort.limit.minutes.term"))),
    ],
  })}${strength && html`<p>${sayMarkup("strength.lead", { term: term("strength") })} ${strength.sentence}</p>
`}`;
}

/// What happened to the grasp, and what to know about mesh and contact.
export function graspNotes(assessment: Assessment, vocabulary: Vocabulary): Markup {
  const { grasp, contact, product } = assessment;
  const doubts = assessment.doubts.filter((one) => one.key === "few_contacts").map((one) => one.words);
  const message = [grasp.message, ...doubts].filter((one) => one !== "").map((one) => capitalised(one) + ".").join(" ");
  return html`${note(statusVerdict(assessment), statusWords(assessment, vocabulary) + ".", message)}${assessment.hold && note("", say("note.hold"), capitalised(assessment.hold.words) + ".")}${contact.message && note("fair", say("note.contact"), contact.message)}${product.notes.length > 0 && note("", say("note.mesh"), joined(product.notes, html`<br>`))}`;
}

function leftOver(contact: ContactResult): Markup {
  return html`<p>${say("rest.left_over", { vector: shortNumber(length(contact.force_vector_n)), sum: shortNumber(contact.force_n) })}</p>
`;
}

/// Whether the grasp came to rest, and how.
export function balanceVerdict(assessment: Assessment): Markup {
  const { balance, contact } = assessment;
  if (balance.status === "off") return leftOver(contact);
  if (balance.status === "supported") {
    return html`${note("", say("rest.supported"), capitalised(balance.message) + ".")}`;
  }
  const slipsOut = balance.status === "slips_out";
  if (balance.status !== "balanced") {
    return html`${note("fair", say(slipsOut ? "rest.slips_out" : "rest.not"), capitalised(balance.message) + ".")}${slipsOut && html`<p>${say("rest.as_closed")}</p>
${leftOver(contact)}`}`;
  }
  return note("good", sayMarkup("rest.yes", { at_rest: term("at_rest", say("rest.yes.term")) }), html`${capitalised(balance.message)}. ${sayMarkup("rest.figures", {
    moved: shortNumber(balance.moved_mm, 2), turned: shortNumber(balance.turned_deg, 2),
    percent: percent(balance.friction_in_use || 0), friction: term("friction", say("rest.friction")),
    coefficient: shortNumber(balance.friction_coefficient, 2),
  })}`);
}
