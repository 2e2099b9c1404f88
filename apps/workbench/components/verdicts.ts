// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the results of one assessment mean, in sentences. Limits of pressure come in families that
// must not be mixed: film peaks at the onset of pain against the peak pressure, the stop of blood
// flow against the peak averaged on sensor cells.

import { Assessment, ContactResult, RegionContact, Vocabulary } from "../types";
import { Child, Markup, html, joined } from "./markup";
import { capitalised, length, percent, shortNumber } from "./numbers";
import { Verdict, note } from "./parts";

export interface NearestToPain {
  region: RegionContact;
  limit: number; // MPa
  share: number; // peak pressure / limit
}

/// The region whose peak pressure comes nearest to its onset of pain.
export function nearestToPain(contact: ContactResult, vocabulary: Vocabulary): NearestToPain | null {
  let nearest: NearestToPain | null = null;
  for (const region of contact.regions) {
    const limit = vocabulary.regions[region.region].pain_onset_mpa;
    const share = region.peak_pressure_mpa / limit;
    if (!nearest || share > nearest.share) nearest = { region, limit, share };
  }
  return nearest;
}

/// How many regions have a peak on sensor cells above the stop of blood flow.
export function regionsWithoutBloodFlow(contact: ContactResult, vocabulary: Vocabulary): number {
  return contact.regions.filter((one) => one.peak_pressure_cells_mpa > vocabulary.blood_flow_stop_mpa).length;
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
  if (assessment.grasp.status === "not_graspable" && !isPower(assessment, vocabulary)) {
    return "No place for this grip";
  }
  const status = assessment.grasp.status;
  const words = (status === "held" && unheldWords[assessment.grasp.grip]) || vocabulary.statuses[status];
  const doubts = assessment.doubts.map((one) => doubtWords[one.key]);
  return doubts.length > 0 && assessment.grasp.status === "held" ? words + ", but " + doubts.join(" and ") : words;
}

/// Of grips that hold nothing.
const unheldWords: { [grip: string]: string } = {
  resting_hand: "Rests on it",
  flat_hand: "Rests on it",
  finger_push: "Pushes it",
};

const doubtWords = {
  not_at_rest: "not at rest",
  slips_out: "slips out",
  few_contacts: "with too few fingers",
};

/// "power grip", "tripod grip", "tip pinch"
export function gripWords(assessment: Assessment, vocabulary: Vocabulary): string {
  if (isPower(assessment, vocabulary)) return "power grip";
  const name = assessment.grasp.grip.replace(/_/g, " ");
  return /pinch$/.test(name) || assessment.grasp.grip in unheldWords ? name : name + " grip";
}

/// What decided how hard the hand grips, and how far to trust the figures.
export function readingAdvice(assessments: Assessment[], vocabulary: Vocabulary): string {
  const first = assessments[0];
  const force = first ? first.settings.grip_force_asked_n : null;
  const advice = " Compare designs with each other; don't take the figures as absolute.";
  if (force !== null && first.settings.balance) {
    const from = first.settings.grip_force_from;
    return "The hand was asked to grip with " + shortNumber(force) + " N" + (from && " (" + from + ")") +
      "; how that force spreads over the skin was computed, not measured." + advice;
  }
  if (first && !isPower(first, vocabulary)) {
    return "The fingertips are pressed in to a set depth; the force that this takes was computed, not measured." + advice;
  }
  return "The fingers close to a set depth, as in a firm grip; nobody measured a force." + advice;
}

/// One sentence about pain and blood flow.
export function plainVerdict(assessment: Assessment, vocabulary: Vocabulary): string {
  const contact = assessment.contact;
  const nearest = nearestToPain(contact, vocabulary);
  if (!nearest) return "Nothing is touched, so there is no pressure to judge.";
  if (!isInHand(assessment)) return "It is not held, so there are no pressures of a grip to judge.";
  const where = vocabulary.regions[nearest.region.region].words;
  const moment = nearest.share >= 1 ? "A firm grip for a moment would hurt, first at the " + where
    : nearest.share >= 0.5 ? "A firm grip for a moment comes near to pain at the " + where
    : "A firm grip for a moment stays far below pain";
  const without = regionsWithoutBloodFlow(contact, vocabulary);
  if (without === 0) return moment + "; held for minutes, blood would still flow in the skin.";
  return moment + "; held just as firmly for minutes, the skin would go short of blood in " + without +
    " of the " + contact.regions.length + " regions it touches, and the hand would have to loosen or shift.";
}

export function plainSummary(assessments: Assessment[], vocabulary: Vocabulary): Markup {
  const items = assessments.map((one) =>
    html`<li><strong>${one.product.name}.</strong> ${plainVerdict(one, vocabulary)}</li>`);
  return html`<ul class="plain">${items}</ul>
`;
}

/// The verdict with its figures and limits.
export function pressureVerdict(assessment: Assessment, vocabulary: Vocabulary): Markup {
  const plain = html`<p>${plainVerdict(assessment, vocabulary)}</p>`;
  const nearest = nearestToPain(assessment.contact, vocabulary);
  if (!isInHand(assessment) || !nearest) return plain;
  const count = assessment.contact.regions.length;
  const without = regionsWithoutBloodFlow(assessment.contact, vocabulary);
  const which = without === 0 ? "No region exceeds" : without + " of " + count + " regions exceed";
  return html`${plain}<p><strong>Short, firm grip.</strong> Nearest to pain: ${vocabulary.regions[nearest.region.region].words}. Its peak of ${shortNumber(nearest.region.peak_pressure_mpa)} MPa is ${percent(nearest.share)} of the ${shortNumber(nearest.limit, 2)} MPa at which pain begins there (peak pressure on a film; ISO/TS 15066:2016).</p><p><strong>Grip held long.</strong> ${which} ${shortNumber(vocabulary.blood_flow_stop_mpa, 1)} MPa (50 kPa) averaged on a sensor cell, above which the skin's blood flow stops (Chalmers thesis 2004). This limit belongs to another family, that of sustained grips: it is lower than the film values above because it answers another question.</p>`;
}

/// What happened to the grasp, and what to know about mesh and contact.
export function graspNotes(assessment: Assessment, vocabulary: Vocabulary): Markup {
  const { grasp, contact, product } = assessment;
  const doubts = assessment.doubts.filter((one) => one.key === "few_contacts").map((one) => one.words);
  const message = [grasp.message, ...doubts].filter((one) => one !== "").map(capitalised).join(". ");
  return html`${note(statusVerdict(assessment), statusWords(assessment, vocabulary) + ".", message)}${assessment.hold && note("", "How it is held.", capitalised(assessment.hold.words) + ".")}${contact.message && note("fair", "Contact.", contact.message)}${product.notes.length > 0 && note("", "About the mesh.", joined(product.notes, html`<br>`))}`;
}

function leftOver(contact: ContactResult): Markup {
  return html`<p>The forces of the skin on the product add up to ${shortNumber(length(contact.force_vector_n))} N as a vector, against ${shortNumber(contact.force_n)} N as a sum of amounts: what is left over is not balanced by this grasp alone.</p>
`;
}

/// Whether the grasp came to rest, and how.
export function balanceVerdict(assessment: Assessment): Markup {
  const { balance, contact } = assessment;
  if (balance.status === "off") return leftOver(contact);
  if (balance.status === "supported") {
    return html`${note("", "Rests on it or pushes it.", capitalised(balance.message) + ".")}`;
  }
  const slipsOut = balance.status === "slips_out";
  if (balance.status !== "balanced") {
    const begin = slipsOut ? "Slips out of the hand." : "Not at rest.";
    return html`${note("fair", begin, capitalised(balance.message) + ".")}${slipsOut && html`<p>What follows shows the hand as it was closed, out of balance.</p>
${leftOver(contact)}`}`;
  }
  const use = balance.flexion_strength_in_use;
  const strength = typeof use === "number" &&
    " The fingers' joints use " + percent(use) + " of the moments that people reach.";
  const words: Child = [
    capitalised(balance.message), ". The product moved by ", shortNumber(balance.moved_mm, 2),
    " mm and turned by ", shortNumber(balance.turned_deg, 2), "° in the hand since it was closed; ",
    percent(balance.friction_in_use || 0), " of the friction (coefficient ",
    shortNumber(balance.friction_coefficient, 2), ") is in use.", strength];
  return note("good", "At rest.", words);
}
