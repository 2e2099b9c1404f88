// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What stands on the bench, and the requests that bring it about.

import { Place } from "./live_frame";

/// Whose hand.
export interface Holder {
  person: string; // "woman:P5"; "" is the template hand
  left: boolean;
}

export interface Pose {
  postureDeg: number[];
  place: Place;
  grip: string;
}

export interface BenchState {
  product: string; // key on the server's shelf
  holder: Holder;
  gripForce: number | null; // N; null: the usual one
  hold: number; // that was chosen last
  pose: Pose | null; // set by hand; null: the hold as it was found
  settle: "close" | "rest" | null; // what was done from that pose: fingers closed, come to rest; null: nothing
}

/// The first hold, by the template hand.
export function firstState(product: string): BenchState {
  return { product, holder: { person: "", left: false }, gripForce: null, hold: 1, pose: null, settle: null };
}

export type LiveRequest = { do: string; id?: number } & Record<string, unknown>;

export function openRequest(state: BenchState, language: string): LiveRequest {
  return {
    do: "open", product: state.product, person: state.holder.person || null, left: state.holder.left, language,
  };
}

export function task(state: BenchState): Record<string, unknown> {
  return state.gripForce === null ? {} : { grip_force_n: state.gripForce };
}

export function poseMembers(pose: Pose): Record<string, unknown> {
  return {
    posture_deg: pose.postureDeg,
    product_from_hand: { quaternion_wxyz: pose.place.quaternion, translation_mm: pose.place.translation },
  };
}

/// What shows this state: the hold as it is found, the pose as it stands, or what comes of it.
export function stateRequest(state: BenchState): LiveRequest {
  if (state.pose && state.settle) return { do: state.settle, ...poseMembers(state.pose), grip: state.pose.grip, ...task(state) };
  if (state.pose) return { do: "evaluate", ...poseMembers(state.pose), grip: state.pose.grip };
  return { do: "hold", number: state.hold, ...task(state) };
}

/// Whether another hand or product has to be opened to come from one state to the other.
export function needsOpening(before: BenchState | null, after: BenchState): boolean {
  return before === null || before.product !== after.product || before.holder.person !== after.holder.person ||
    before.holder.left !== after.holder.left;
}
