// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Single grasps of a study (src/palmar/server/study_dots.h), and what they come to.

export interface Dots {
  products: { name: string; colour: [number, number, number] }[];
  hands: { length_mm: number | null; shown: number | null }[];
  quantities: { key: string; name: string; unit: string }[];
  grasps: { hand: number; product: number; outcome: string; values: (number | null)[] }[];
}

export interface DotSummary {
  name: string;
  held: number; // of so many hands
  hands: number;
  mean: number | null;
  sd: number | null; // of a sample
}

/// Of one quantity, product by product, over hands of a length from `low` to `high` mm; those whose
/// length isn't known are in it only where nothing is left out.
export function dotSummaries(dots: Dots, quantity: number, low: number, high: number, isAll: boolean): DotSummary[] {
  const isIn = (hand: number) => {
    const length = dots.hands[hand].length_mm;
    return isAll || (length !== null && length >= low && length <= high);
  };
  return dots.products.map((product, p) => {
    const grasps = dots.grasps.filter((one) => one.product === p && isIn(one.hand));
    const values = grasps.map((one) => one.values[quantity]).filter((one): one is number => one !== null);
    const mean = values.length > 0 ? values.reduce((sum, one) => sum + one, 0) / values.length : null;
    const squares = values.reduce((sum, one) => sum + (one - (mean ?? 0)) ** 2, 0);
    return { name: product.name, held: values.length, hands: grasps.length, mean, sd: values.length > 1 ? Math.sqrt(squares / (values.length - 1)) : null };
  });
}
