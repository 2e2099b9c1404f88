// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The sentences of all pages by key, one file per language. The program that writes the pages reads
// the same files for what it says itself.

import english from "./en.json";
import german from "./de.json";
import { Language } from "../types";
import { Child, Markup, html } from "../components/markup";

interface Sentences {
  [key: string]: string;
}

const all: { [language: string]: Sentences } = { en: english, de: german };
let chosen: Language = "en";

/// The language of everything that is said from now on.
export function useLanguage(language: Language): void {
  chosen = language;
}

export function language(): Language {
  return chosen;
}

export function hasText(key: string): boolean {
  return typeof all[chosen][key] === "string";
}

/// The sentence cut at its places: "a {b} c" -> ["a ", "b", " c"].
function pieces(key: string): string[] {
  const sentence = all[chosen][key];
  if (typeof sentence !== "string") throw new Error("no sentence " + key);
  return sentence.split(/\{([a-z_0-9]+)\}/);
}

/// The sentence with its values in their places.
export function say(key: string, values: { [name: string]: string | number } = {}): string {
  return pieces(key).map((piece, i) => {
    if (i % 2 === 0) return piece;
    if (values[piece] === undefined) throw new Error(key + " has no value for " + piece);
    return String(values[piece]);
  }).join("");
}

/// The same with markup in its places.
export function sayMarkup(key: string, values: { [name: string]: Child }): Markup {
  return html`${pieces(key).map((piece, i) => {
    if (i % 2 === 0) return piece;
    if (values[piece] === undefined) throw new Error(key + " has no value for " + piece);
    return values[piece];
  })}`;
}

/// "1 hand", "6 hands": the key ends in ".one" or ".many".
export function sayCount(key: string, count: number): string {
  return say(key + (count === 1 ? ".one" : ".many"), { count });
}

/// "a, b and c"
export function sayList(items: string[]): string {
  const last = items.length > 1 ? say("list.and", { last: items[items.length - 1] }) : "";
  return items.length > 1 ? items.slice(0, -1).join(", ") + last : items.join("");
}

export function sayName(group: string, name: string, otherwise: string): string {
  const key = group + "." + name;
  return hasText(key) ? say(key) : otherwise;
}

