// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The first screen of every report, which prints as one page: the answer in one sentence, pictures,
// one small chart, what limits it, and one thing to do next.

import { ColourBar, Picture } from "../types";
import { say } from "../texts";
import { Child, Markup, html } from "./markup";
import { coordinate, shortNumber } from "./numbers";
import { Verdict } from "./parts";

export interface FirstScreen {
  kicker: string; // what this is a report of
  tone: Verdict;
  sentence: string;
  reasons: Child[];
  cards: { title: string; badge: Child; pictures: Picture[]; facts: [Child, string][] }[];
  scale: ColourBar | null; // of the pressure maps, each card's second picture; null: pictures stay whole
  chart: Child;
  next: string;
  command: string;
  warning?: Child;
}

function card(one: FirstScreen["cards"][0], isCut: boolean): Markup {
  const pictures = one.pictures.map((picture) =>
    html`<span><img src="${picture.src}" alt="${picture.alt}"></span>`);
  const facts = one.facts.map(([name, value]) => html`<div><dt>${name}</dt><dd>${value}</dd></div>`);
  return html`<article class="hold"><h3>${one.title} ${one.badge}</h3>${pictures.length > 0 && html`<div class="hold-pictures${isCut && " cut"}">${pictures}</div>`}${facts.length > 0 && html`<dl>${facts}</dl>`}</article>`;
}

/// The colours of the pressure maps in letters that can be read: those in the pictures are too small
/// here and are cut off with the pictures' titles (style.css).
function legend(scale: ColourBar): Markup {
  const left = 150, width = 200, band = width / scale.colours.length;
  const bands = scale.colours.map((colour, i) =>
    html`<rect x="${coordinate(left + i * band)}" y="2" width="${coordinate(band + 0.5)}" height="10" fill="${colour}"/>`);
  const most = (scale.is_open_ended ? "≥ " : "") + shortNumber(scale.upper, 2);
  return html`<svg class="legend" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 420 14" role="img" font-size="12" fill="#1d2329" data-unit="${scale.unit}" aria-label="${say("colourbar.label", { quantity: scale.quantity, upper: shortNumber(scale.upper), unit: scale.unit })}"><text x="0" y="12">${scale.quantity}, ${scale.unit}</text><text x="${left - 6}" y="12" text-anchor="end" data-value="0">0</text>${bands}<text x="${left + width + 6}" y="12" data-value="${String(scale.upper)}">${most}</text></svg>`;
}

/// A command that breaks between its options, and inside one only where it is longer than the line: words
/// of a shell, an option together with its values.
export function commandParts(command: string): string[][] {
  const words = command.match(/(?:'[^']*'|"[^"]*"|\\.|[^\s'"\\])+/g) || [];
  const parts: string[][] = [];
  let isOption = false;
  for (const word of words) {
    const starts = /^--?[a-z]/.test(word);
    if (starts || !isOption) parts.push([word]);
    else parts[parts.length - 1].push(word);
    isOption = isOption || starts;
  }
  return parts;
}

function commandMarkup(command: string): Markup {
  const spaced = (all: Markup[]): Markup => html`${all.map((one, i) => html`${i > 0 && " "}${one}`)}`;
  return spaced(commandParts(command).map((part) =>
    html`<span class="part">${spaced(part.map((word) => html`<span class="part">${word}</span>`))}</span>`));
}

export function firstScreen(screen: FirstScreen): Markup {
  const isMany = screen.cards.length > 2;
  const hasMap = screen.cards.length < 4 && screen.cards.some((one) => one.pictures.length > 1);
  return html`<section class="answer" id="answer" aria-label="${say("answer.label")}">
<p class="kicker">${screen.kicker}</p>
<p class="sentence ${screen.tone}">${screen.sentence}</p>
${screen.warning}<div class="answer-body"><div class="holds${isMany && " many"} n${Math.min(screen.cards.length, 4)}">${screen.cards.map((one) => card(one, screen.scale !== null))}${hasMap && screen.scale && legend(screen.scale)}</div>
<div class="why">${screen.chart}<ul class="plain">${screen.reasons.map((one) => html`<li>${one}</li>`)}</ul></div></div>
${screen.command && html`<p class="next"><strong>${screen.next}</strong> <code>${commandMarkup(screen.command)}</code> <button type="button" class="copy" data-copy="${screen.command}" hidden>${say("answer.copy")}</button></p>`}
</section>
`;
}
