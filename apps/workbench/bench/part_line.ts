// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Places along the centre line of a product's part.
export type Triple = [number, number, number];

export interface Station {
  along: number; // 0 to 1
  centre_mm: Triple;
  axis: Triple; // unit
}

/// Between the stations, which stand in ascending order.
export function stationAt(line: Station[], along: number): { centre: Triple; axis: Triple } {
  const after = line.findIndex((one) => one.along >= along);
  const b = line[after < 0 ? line.length - 1 : after], a = line[Math.max(0, (after < 0 ? line.length : after) - 1)];
  const share = b.along > a.along ? Math.min(1, Math.max(0, (along - a.along) / (b.along - a.along))) : 0;
  const between = (from: Triple, to: Triple) => from.map((one, k) => one + share * (to[k] - one)) as Triple;
  const axis = between(a.axis, b.axis), size = Math.hypot(...axis) || 1;
  return { centre: between(a.centre_mm, b.centre_mm), axis: axis.map((one) => one / size) as Triple };
}
