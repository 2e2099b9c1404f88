// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { language } from "../texts";

export const nothing = "–";

/// With a minus sign, not a hyphen, and with the decimal sign of the language.
export function localised(text: string): string {
  const signed = text.replace(/^-/, "−");
  return language() === "de" ? signed.replace(".", ",") : signed;
}

/// "0.182", "1235", "0": rounded for reading, at most five decimals; digits before the point stay.
export function shortNumber(value: number | null | undefined, significant = 3): string {
  if (value === null || value === undefined || !isFinite(value)) return nothing;
  const size = Math.abs(value);
  if (size < 5e-6) return "0"; // would be 0.00000
  const exponent = Number(size.toExponential().split("e")[1]);
  const decimals = Math.max(0, Math.min(5, significant - 1 - exponent));
  return localised(value.toFixed(decimals));
}

/// A number with just so many decimals.
export function fixedNumber(value: number | null | undefined, decimals: number): string {
  return value === null || value === undefined ? nothing : localised(value.toFixed(decimals));
}

/// A whole number or three digits, with its sign: "+12", "−0.031".
export function signedNumber(value: number | null | undefined, significant = 3): string {
  if (value === null || value === undefined) return nothing;
  return (value > 0 ? "+" : value < 0 ? "−" : "") + shortNumber(Math.abs(value), significant);
}

/// For markup that is drawn: always with a point.
export function coordinate(value: number): string {
  return String(Math.round(100 * value) / 100);
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

/// The first letter of ASCII as a capital.
export function capitalised(text: string): string {
  return /^[a-z]/.test(text) ? text.charAt(0).toUpperCase() + text.slice(1) : text;
}
