// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Sentences and numbers in inches and pounds.

export interface Unit {
  name: string;
  factor: number;
}

export const units: { [metric: string]: Unit } = {
  "N mm": { name: "lbf in", factor: 0.00885075 },
  "mm²": { name: "in²", factor: 1 / 645.16 },
  mm: { name: "in", factor: 1 / 25.4 },
  MPa: { name: "psi", factor: 145.0377 },
  kPa: { name: "psi", factor: 0.1450377 },
  N: { name: "lbf", factor: 0.2248089 },
  kg: { name: "lb", factor: 2.2046226 },
};
const unit = "(N mm|mm²|mm|MPa|kPa|N|kg)";
const number = "[-−+]?\\d+(?:[.,]\\d+)?";
// "0.21 to 0.34 MPa", "0.27 of 0.5 MPa", "12 N"; not "(22, 0, 16) mm", which is a place on the product.
const measured = new RegExp(`(?<![\\w.,(])(${number}(?:(?: to | bis | of | von | and | und | against | gegen |–| ± )${number})*)[ \u00a0]${unit}(?![\\w²³])`, "g");
/// A head of a column that ends in a unit: "Force, N".
export const headed = new RegExp(`(?:, | \\()${unit}\\)?$`);

/// Three digits, none of those before the point lost.
export function shortened(value: number): string {
  const size = Math.abs(value);
  if (!isFinite(value) || size === 0) return "0";
  const before = Math.floor(Math.log10(size)) + 1;
  return value.toFixed(Math.max(0, 3 - before));
}

/// Every number of a text times a factor.
export function converted(text: string, factor: number, comma: boolean): string {
  return text.replace(new RegExp(number, "g"), (one) => {
    const value = Number(one.replace("−", "-").replace(",", ".")) * factor;
    const said = shortened(value).replace("-", "−");
    return (one[0] === "+" ? "+" : "") + (comma ? said.replace(".", ",") : said);
  });
}

/// A sentence in inches and pounds.
export function inUsUnits(text: string, comma: boolean): string {
  return text.replace(measured, (_, values: string, metric: string) =>
    converted(values, units[metric].factor, comma) + " " + units[metric].name);
}
