// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Whose hands can be chosen.
import { say, TextKey } from "./say";

/// By sex and percentile of hand size (ANSUR II); "" is the template hand.
export const people = ["", "woman:P5", "woman:P50", "woman:P95", "man:P5", "man:P50", "man:P95"];

export function personWords(person: string): string {
  if (!person) return say("bench.template");
  const [sex, percentile] = person.split(":P");
  return say(`bench.${sex}` as TextKey, { percentile });
}

/// Populations for many hands, as `palmar study run --population` takes them, and whether their hands
/// are drawn (else there are as many as were named).
export const populations: { key: "women" | "men" | "both" | "range"; names: string[]; areDrawn: boolean }[] = [
  { key: "women", names: ["ansur2_women"], areDrawn: true },
  { key: "men", names: ["ansur2_men"], areDrawn: true },
  { key: "both", names: ["ansur2"], areDrawn: true },
  { key: "range", names: ["woman:P5..man:P95"], areDrawn: false },
];
