// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The sentences of the workbench: one file per language in bench/texts.

import english from "./texts/en.json";
import german from "./texts/de.json";

export type BenchLanguage = "en" | "de";
export type TextKey = keyof typeof english;

const kKept = "palmar-language";
let language: BenchLanguage = "en";

export function benchLanguage(): BenchLanguage { return language; }

/// What was chosen before, else the browser's.
export function startLanguage(): void {
  let kept: string | null = null;
  try {
    kept = localStorage.getItem(kKept);
  } catch {
    // A browser that keeps nothing.
  }
  const wanted = kept ?? navigator.language;
  language = wanted.slice(0, 2) === "de" ? "de" : "en";
  document.documentElement.lang = language;
}

export function chooseLanguage(chosen: BenchLanguage): void {
  language = chosen;
  document.documentElement.lang = chosen;
  try {
    localStorage.setItem(kKept, chosen);
  } catch {
    // As above.
  }
}

/// The sentence with its values put in.
export function say(key: TextKey, values: Record<string, string | number> = {}): string {
  const text: string = (language === "de" ? german : english)[key];
  return text.replace(/\{([a-z_]+)\}/g, (whole, name: string) => name in values ? String(values[name]) : whole);
}

/// With so many decimals and the language's decimal sign.
export function decimal(value: number, decimals: number): string {
  const text = (Object.is(value, -0) ? 0 : value).toFixed(decimals).replace(/^-(?=0(\.0*)?$)/, "").replace("-", "−");
  return language === "de" ? text.replace(".", ",") : text;
}

/// "40 × 40 × 130", mm.
export function sidesText(sides: number[]): string {
  return sides.map((side) => decimal(side, side < 10 ? 1 : 0)).join(" × ");
}

/// "24 Nov, 20:15" as the language writes it.
export function dateText(ms: number): string {
  return new Date(ms).toLocaleString(language, { day: "numeric", month: "short", hour: "2-digit", minute: "2-digit" });
}
