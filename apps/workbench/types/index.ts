// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The JSON that pages are made of. Results (AssessmentReport) are the files that Palmar writes; a
// test (tests/check_types.mjs) holds these types to real ones, key by key. Units stand in the names.

export * from "./assessment";
export * from "./common";
export * from "./hand";
export * from "./hand_from_mri";
export * from "./hand_from_scan";
export * from "./study";
