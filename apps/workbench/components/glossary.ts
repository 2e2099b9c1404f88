// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Words that a report explains where they stand: each opens its entry of the glossary.

import { say } from "../texts";
import { Markup, html } from "./markup";

export const terms = [
  "peak_on_cells", "peak_at_vertex", "contact_area", "grip_force", "sum_of_forces", "discomfort", "pain",
  "blood_flow", "error_band", "region", "at_rest", "friction", "strength", "epsilon", "coordination", "hold",
  "interval", "p_value", "effect_size", "t_test",
];

/// The word, or other words for it, as a button that opens its entry.
export function term(key: string, words?: string): Markup {
  return html`<button type="button" class="term" popovertarget="term-${key}">${words || say("term." + key)}</button>`;
}

/// The entries: beside their terms when they are opened, and as a list in the section "glossary".
export function glossaryEntries(): Markup {
  return html`${terms.map((key) => html`<div class="entry" popover id="term-${key}"><strong>${say("term." + key)}</strong> ${say("meaning." + key)}</div>
`)}`;
}

export function glossaryList(): Markup {
  return html`<dl class="glossary">${terms.map((key) => html`<dt>${say("term." + key)}</dt><dd>${say("meaning." + key)}</dd>`)}</dl>
`;
}
