// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// proposals.csv, as `palmar redesign features --propose` writes it.
export interface Proposal {
  vary: string;
  gain: number | null; // %
  isFeasible: boolean;
  failure: string;
  reason: string;
}

/// Cells of a line of CSV, some in quotes.
function cells(line: string): string[] {
  return [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)].map((one) => one[1] !== undefined ? one[1].replace(/""/g, '"') : one[2]);
}

/// proposals.csv: vary,goal,gain_percent,grip_force_ratio,is_feasible,failure,reason.
export function parseProposals(csv: string): Proposal[] {
  return csv.trim().split(/\r?\n/).slice(1).map((line) => {
    const [vary, , gain, , isFeasible, failure, reason] = cells(line);
    return { vary, gain: gain === "" ? null : Number(gain), isFeasible: isFeasible === "yes", failure, reason };
  });
}
