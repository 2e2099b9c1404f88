// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What stands on the bench and the steps that led there, as the server keeps them.
import { BenchState } from "./bench_state";
import { parseState, stateMembers } from "./project";
import { Step } from "./undo";

export const kMostKeptSteps = 60; // some 4 kB each; the server takes 1 MB
const kLongestPicture = 12000;

export interface History {
  at: number;
  steps: Step<BenchState>[];
}

export function keptText(state: BenchState, history: History): string {
  const picture = (text: string) => (text.length <= kLongestPicture ? text : "");
  return JSON.stringify({
    product: state.product, state: stateMembers(state), picture: picture(history.steps[history.at]?.picture ?? ""),
    history: { at: history.at, steps: history.steps.map((one) => ({ state: stateMembers(one.state), picture: picture(one.picture) })) },
  });
}

/// The steps of a project that was kept, for the product as it lies on the shelf now; nothing if they
/// are none.
export function keptHistory(value: unknown, product: string): History | null {
  try {
    const kept = value as { at: number; steps: { state: Record<string, unknown>; picture: string }[] };
    const steps = kept.steps.map((one) => ({
      state: { ...parseState(one.state), product },
      picture: typeof one.picture === "string" && one.picture.startsWith("data:image/") ? one.picture : "",
    }));
    return Number.isInteger(kept.at) && kept.at >= 0 && kept.at < steps.length ? { at: kept.at, steps } : null;
  } catch {
    return null;
  }
}
