// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Creases, dots, bones and dimensions in words.
import { say, TextKey } from "./say";

export function namedWords(name: string): string {
  if (name === "wrist" || name === "palm" || name === "none") return say(`found.name.${name}`);
  const cut = name.indexOf("_");
  return `${say(`finger.${name.slice(0, cut)}` as TextKey)}: ${say(`found.part.${name.slice(cut + 1)}` as TextKey)}`;
}

/// "Index finger: distal, width" of "index_distal_width", "Hand length" of "hand_length".
export function dimensionWords(name: string): string {
  if (name.startsWith("hand_")) return say(`found.dimension.${name}` as TextKey);
  const cut = name.lastIndexOf("_");
  const of = name.slice(0, cut);
  return `${of === "palm" ? say("found.dimension.palm") : namedWords(of)}, ${say(`found.dimension.${name.slice(cut + 1)}` as TextKey)}`;
}
