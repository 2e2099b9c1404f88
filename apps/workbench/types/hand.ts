// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A hand in figures.

import { Vector3 } from "./common";

export interface SegmentSize {
  length_mm: number;
  width_mm: number;
  thickness_mm: number;
}

/// What `palmar hand info --json` says of a hand.
export interface HandInfo {
  name: string;
  side: "left" | "right";
  vertices: number;
  triangles: number;
  hand_length_mm: number;
  hand_circumference_mm: number;
  hand_width_mm: number;
  hand_thickness_mm: number;
  segments: { [name: string]: SegmentSize };
  degree_of_freedom_count: number;
  joints: {
    joint: string;
    centre_mm: Vector3;
    degrees_of_freedom: {
      dof: string;
      axis: Vector3;
      centre_mm: Vector3;
      lower_deg: number;
      upper_deg: number;
      reference_deg: number;
      source: string;
    }[];
  }[];
  bones: string[];
  tissue_source: string;
  provenance: string;
}
