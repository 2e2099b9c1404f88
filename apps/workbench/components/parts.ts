// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Pieces that several pages show.

import { ColourBar, Picture, TrustedMarkup } from "../types";
import { say } from "../texts";
import { Child, Markup, html, trusted } from "./markup";
import { coordinate, shortNumber } from "./numbers";

export type Verdict = "good" | "fair" | "bad";

export function badge(verdict: Verdict, words: Child): Markup {
  return html`<span class="badge ${verdict}">${words}</span>`;
}

/// A paragraph that stands out, begun by a word or two.
export function note(verdict: Verdict | "", begin: Child, words: Child): Markup {
  return html`<p class="note${verdict && " " + verdict}"><strong>${begin}</strong> ${words}</p>
`;
}

export function folded(summary: Child, content: Child): Markup {
  return html`<details class="inner"><summary>${summary}</summary>${content}</details>
`;
}

/// One section of a page below its first screen: it unfolds, and the contents link to it.
export interface Section {
  id: string;
  title: string;
  content: Child;
  isOpen?: boolean;
}

export function sections(list: (Section | null)[]): Markup {
  return html`${list.map((one) => one && html`<details class="part" id="${one.id}"${one.isOpen && html` open`}><summary><h2>${one.title}</h2></summary>
${one.content}</details>
`)}`;
}

/// Links to the sections.
export function contents(list: (Section | null)[]): Markup {
  return html`<nav class="contents" aria-label="${say("contents.title")}"><h2>${say("contents.title")}</h2><ol>${list.map((one) => one && html`<li><a href="#${one.id}">${one.title}</a></li>`)}</ol><p class="hint">${say("contents.hint")}</p></nav>
`;
}

export function list(items: Child[]): Markup {
  return html`<ul class="plain">${items.map((one) => html`<li>${one}</li>`)}</ul>
`;
}

export function charts(figures: TrustedMarkup[]): Markup {
  return html`<div class="charts">${figures.map(trusted)}</div>
`;
}

export function pictureFigures(pictures: Picture[]): Markup | null {
  if (pictures.length === 0) return null;
  return html`<div class="pictures">${pictures.map((one) =>
    html`<figure data-picture="${one.name}"><img src="${one.src}" alt="${one.alt}"><figcaption>${one.title}</figcaption></figure>`)}</div>
`;
}

export function licence(text: string): Markup {
  return html`<div class="on-screen">${folded(say("licence.title"), html`<pre>${text}</pre>`)}</div>`; // paper has no scripts
}

/// Which colour means how much. `key` and `isShown`: one of several that a view changes between.
export function colourBar(scale: ColourBar, key?: string, isShown = true): Markup {
  const top = 40, height = 380, count = scale.colours.length;
  const band = height / count;
  const bands = scale.colours.map((colour, i) =>
    html`<rect x="0" y="${coordinate(top + height - (i + 1) * band)}" width="22" height="${coordinate(band + 0.5)}" fill="${colour}"/>`);
  const ticks = scale.ticks.map((tick) => {
    const y = top + height * (1 - tick.value / scale.upper);
    return html`<path d="M22 ${coordinate(y)}h5" stroke="#47515b"/><text x="31" y="${coordinate(y + 4.5)}">${tick.text}</text>`;
  });
  const label = say("colourbar.label", { quantity: scale.quantity, upper: shortNumber(scale.upper), unit: scale.unit });
  return html`<svg${key && html` data-bar="${key}"`}${!isShown && html` hidden`} xmlns="http://www.w3.org/2000/svg" viewBox="0 0 112 480" width="112" height="480" role="img" font-size="13" fill="#1d2329" aria-label="${label}"><text x="0" y="14">${scale.quantity},</text><text x="0" y="30">${scale.unit}</text>${bands}${ticks}<rect x="0" y="442" width="22" height="14" fill="${scale.neutral}" stroke="#47515b"/><text x="31" y="454">${say("colourbar.none")}</text></svg>`;
}

export interface Toggle {
  key: string;
  words: string;
  isOn: boolean;
}

/// The place of a 3-D view with its controls: what they do is the viewer's (viewer/viewer.ts), which
/// finds them by data-toggle and data-look. `scene` is JSON.
export function turnableView(options: {
  id: string;
  kind?: "study";
  label: string; // of a view of two scenes: their names, parted by a line break
  fallback: string;
  above?: Child;
  bars: Child;
  below?: Child;
  toggles: Toggle[];
  scene: TrustedMarkup | null; // null: the scenes of `id`, two of them parted by a blank, stand elsewhere
}): Markup {
  const toggles = options.toggles.map((one) =>
    html`<label><input type="checkbox" data-toggle="${one.key}"${one.isOn && html` checked`}> ${one.words}</label>`);
  const look = (key: string) => html`<button type="button" data-look="${key}">${say("view.look." + key)}</button>`;
  return html`<section class="view${options.scene === null && " pair"}" data-palmar-scene="${options.id}"${options.kind && html` data-palmar-kind="${options.kind}"`} aria-label="${say("view.title")}">${options.above}<div class="view-body">${options.label.split("\n").map((label) => html`<div class="view-canvas" data-label="${label}"><p class="view-fallback">${say("view.fallback")} ${options.fallback}</p></div>`)}<div class="view-bar">${options.bars}</div></div>${options.below}<p class="view-says view-copied" hidden>${say("view.copied")} <code></code></p><div class="controls">${toggles}<label>${say("view.cut")} <input type="range" data-cut min="0" max="100" value="100"></label><button type="button" data-save="${options.id.replace(" ", "-")}">${say("view.save")}</button></div><div class="controls"><span>${say("view.look")}</span>${look("palm")}${look("back")}${look("thumb")}${look("little")}<span>${say("view.help")}</span></div>${options.scene !== null && html`<script type="application/json" id="${options.id}">${trusted(options.scene)}</script>`}</section>
`;
}
