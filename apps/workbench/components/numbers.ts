// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

export const nothing = "–";

/// "0.182", "1235", "0": rounded for reading, at most five decimals; digits before the point stay.
export function shortNumber(value: number | null | undefined, significant = 3): string {
  if (value === null || value === undefined || !isFinite(value)) return nothing;
  const size = Math.abs(value);
  if (size === 0) return "0";
  const exponent = Number(size.toExponential().split("e")[1]);
  const decimals = Math.max(0, Math.min(5, significant - 1 - exponent));
  return value.toFixed(decimals);
}

/// 100 times as much with a sign: "63 %".
export function percent(share: number, significant = 2): string {
  return shortNumber(100 * share, significant) + " %";
}

export function length(vector: number[]): number {
  let sum = 0;
  for (const one of vector) sum += one * one;
  return Math.sqrt(sum);
}

/// "1 hand", "6 hands"
export function counted(count: number, one: string): string {
  return count + " " + one + (count === 1 ? "" : "s");
}

/// The first letter of ASCII as a capital.
export function capitalised(text: string): string {
  return /^[a-z]/.test(text) ? text.charAt(0).toUpperCase() + text.slice(1) : text;
}
