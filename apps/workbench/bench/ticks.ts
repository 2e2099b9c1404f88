// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

/// A round step that gives 4 to 9 ticks up to `upper`.
export function tickStep(upper: number): number {
  const rough = upper / 8;
  const power = 10 ** Math.floor(Math.log10(rough));
  const factor = [1, 2, 2.5, 5, 10].find((one) => one * power >= rough * 0.999) ?? 10;
  return factor * power;
}
