// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Pieces that several pages show.

import { ColourBar, Picture, TrustedMarkup } from "../types";
import { Child, Markup, html, trusted } from "./markup";
import { shortNumber } from "./numbers";

export type Verdict = "good" | "fair" | "bad";

export function badge(verdict: Verdict, words: Child): Markup {
  return html`<span class="badge ${verdict}">${words}</span>`;
}

/// A paragraph that stands out, begun by a word or two.
export function note(verdict: Verdict | "", begin: string, words: Child): Markup {
  return html`<p class="note${verdict && " " + verdict}"><strong>${begin}</strong> ${words}</p>
`;
}

export function folded(summary: Child, content: Child): Markup {
  return html`<details><summary>${summary}</summary>${content}</details>
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
    html`<figure><img src="${one.src}" alt="${one.alt}"><figcaption>${one.title}</figcaption></figure>`)}</div>
`;
}

export function licence(text: string): Markup {
  return folded("Licence of the 3-D view (three.js, MIT)", html`<pre>${text}</pre>`);
}

/// Which colour means how much. `key` and `isShown`: one of several that a view changes between.
export function colourBar(scale: ColourBar, key?: string, isShown = true): Markup {
  const top = 40, height = 380, count = scale.colours.length;
  const band = height / count;
  const bands = scale.colours.map((colour, i) =>
    html`<rect x="0" y="${shortNumber(top + height - (i + 1) * band, 6)}" width="22" height="${shortNumber(band + 0.5, 4)}" fill="${colour}"/>`);
  const ticks = scale.ticks.map((tick) => {
    const y = top + height * (1 - tick.value / scale.upper);
    return html`<path d="M22 ${shortNumber(y, 5)}h5" stroke="#47515b"/><text x="31" y="${shortNumber(y + 4.5, 5)}">${tick.text}</text>`;
  });
  return html`<svg${key && html` data-bar="${key}"`}${!isShown && html` hidden`} xmlns="http://www.w3.org/2000/svg" viewBox="0 0 112 480" width="112" height="480" role="img" font-size="13" fill="#1d2329" aria-label="Colour scale: ${scale.quantity} from 0 to ${shortNumber(scale.upper)} ${scale.unit}"><text x="0" y="14">${scale.quantity},</text><text x="0" y="30">${scale.unit}</text>${bands}${ticks}<rect x="0" y="442" width="22" height="14" fill="${scale.neutral}" stroke="#47515b"/><text x="31" y="454">none</text></svg>`;
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
  label: string;
  fallback: string;
  above?: Child;
  bars: Child;
  below?: Child;
  toggles: Toggle[];
  scene: TrustedMarkup;
}): Markup {
  const toggles = options.toggles.map((one) =>
    html`<label><input type="checkbox" data-toggle="${one.key}"${one.isOn && html` checked`}> ${one.words}</label>`);
  const look = (key: string, from: string) => html`<button type="button" data-look="${key}">${from}</button>`;
  return html`<section class="view" data-palmar-scene="${options.id}"${options.kind && html` data-palmar-kind="${options.kind}"`} aria-label="3-D view">${options.above}<div class="view-body"><div class="view-canvas" data-label="${options.label}"><p class="view-fallback">The turnable 3-D view needs scripts and WebGL. ${options.fallback}</p></div><div class="view-bar">${options.bars}</div></div>${options.below}<div class="controls">${toggles}</div><div class="controls"><span>Look from:</span>${look("palm", "Palm")}${look("back", "Back")}${look("thumb", "Thumb side")}${look("little", "Little finger")}<span>Drag to turn, wheel or pinch to zoom, right drag to move; arrow keys, + and − after a click.</span></div><script type="application/json" id="${options.id}">${trusted(options.scene)}</script></section>
`;
}
