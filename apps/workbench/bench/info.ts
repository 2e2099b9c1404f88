// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What a figure is: an "i" beside its name opens definition, range and source.
import { el } from "./dom";
import { say } from "./say";

export type InfoKey = "grip_force" | "contact_force" | "area" | "peak" | "mean" | "held";

/// The button and what it opens (the browser's own popover: Escape or a click elsewhere closes it).
export function info(key: InfoKey): (HTMLElement | string)[] {
  const id = `info-${key}`;
  const part = (name: "definition" | "range" | "source") => el("p", {}, el("strong", {}, `${say(`info.${name}`)} `), say(`info.${key}.${name}`));
  return [el("button", { type: "button", class: "info", popovertarget: id, "aria-label": say("info.about", { what: say(`info.${key}`) }) }, "i"),
    el("div", { class: "info-text", popover: "auto", id }, el("strong", {}, say(`info.${key}`)), part("definition"), part("range"), part("source"))];
}
