// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The first screen of every report, which prints as one page: the answer in one sentence, pictures,
// one small chart, what limits it, and one thing to do next.

import { Picture } from "../types";
import { say } from "../texts";
import { Child, Markup, html } from "./markup";
import { Verdict } from "./parts";

export interface FirstScreen {
  kicker: string; // what this is a report of
  tone: Verdict;
  sentence: string;
  reasons: Child[];
  cards: { title: string; badge: Child; pictures: Picture[]; facts: [Child, string][] }[];
  chart: Child;
  next: string;
  command: string;
  warning?: Child;
}

function card(one: FirstScreen["cards"][0]): Markup {
  const pictures = one.pictures.map((picture) =>
    html`<img src="${picture.src}" alt="${picture.alt}">`);
  const facts = one.facts.map(([name, value]) => html`<div><dt>${name}</dt><dd>${value}</dd></div>`);
  return html`<article class="hold"><h3>${one.title} ${one.badge}</h3>${pictures.length > 0 && html`<div class="hold-pictures">${pictures}</div>`}${facts.length > 0 && html`<dl>${facts}</dl>`}</article>`;
}

export function firstScreen(screen: FirstScreen): Markup {
  const isMany = screen.cards.length > 2;
  return html`<section class="answer" id="answer" aria-label="${say("answer.label")}">
<p class="kicker">${screen.kicker}</p>
<p class="sentence ${screen.tone}">${screen.sentence}</p>
${screen.warning}<div class="answer-body"><div class="holds${isMany && " many"} n${Math.min(screen.cards.length, 4)}">${screen.cards.map(card)}</div>
<div class="why">${screen.chart}<ul class="plain">${screen.reasons.map((one) => html`<li>${one}</li>`)}</ul></div></div>
${screen.command && html`<p class="next"><strong>${screen.next}</strong> <code>${screen.command}</code> <button type="button" class="copy" data-copy="${screen.command}" hidden>${say("answer.copy")}</button></p>`}
</section>
`;
}
