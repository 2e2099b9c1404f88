// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Names of creases, dots and bones, as the commands have them.

const fingers = ["index", "middle", "ring", "little"];
const segments = ["thumb_proximal", "thumb_distal", ...fingers.flatMap((one) => ["proximal", "middle", "distal"].map((part) => `${one}_${part}`))];

/// A crease is called by the segment behind it.
export const creaseNames = ["wrist", ...segments];
export const dotNames = ["palm", ...segments];
export const boneNames = ["thumb_metacarpal", "thumb_proximal_phalanx", "thumb_distal_phalanx",
  ...fingers.flatMap((one) => ["metacarpal", "proximal_phalanx", "middle_phalanx", "distal_phalanx"].map((part) => `${one}_${part}`))];

/// Postures of a scan, the reference first.
export const postures = ["reference", "finger_flexion", "finger_abduction", "thumb_flexion", "thumb_extension", "thumb_abduction", "thumb_adduction"];

/// The posture that a file's name says.
export function postureInName(name: string): string {
  const lower = name.toLowerCase();
  return postures.slice(1).find((one) => lower.includes(one)) ??
    (/flex|bent/.test(lower) ? "finger_flexion" : /spread|abduct/.test(lower) ? "finger_abduction" : "reference");
}
