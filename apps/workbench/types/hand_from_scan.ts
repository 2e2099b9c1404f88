// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A hand from surface scans.

import { Language, Maker, Picture, PostureAngles, Vector3, Vocabulary } from "./common";
import { SegmentSize } from "./hand";

/// scan.json of a hand from surface scans.
export interface HandFromScan {
  hand: string;
  side: "left" | "right";
  dimensions: { [name: string]: number };
  along_the_skin: { [name: string]: number };
  skin_mean_mm: number;
  skin_p95_mm: number;
  joints: {
    joint: string;
    dof: string;
    axis: Vector3;
    centre_mm: Vector3;
    axis_in_scan: Vector3;
    centre_in_scan_mm: Vector3;
    lower_deg: number;
    upper_deg: number;
    reference_deg: number;
    source: string;
  }[];
  scans: {
    [posture: string]: {
      angles: PostureAngles;
      fit_mean_mm?: number;
      fit_p95_mm?: number;
      skin_share_seen?: number;
      flexion_axes: { segment: string; axis: Vector3; centre_mm: Vector3 }[];
      thumb_metacarpal?: { turn_deg: number; axis: Vector3; residual_mm: number; dots: number };
    };
  };
  proximal_creases: { [segment: string]: { point_mm: Vector3; normal: Vector3; distal_of_expected_mm: number } };
  creases_not_found: string[];
  dots: { [segment: string]: number };
  joints_by_dots: {
    segment: string;
    posture: string;
    turn_deg: number;
    residual_mm: number;
    axis_change_deg: number;
    axis_error_deg: number;
    centre_change_mm: number;
    dots: number;
  }[];
  notes: string[];
}

export interface PlaceError {
  place_mm: number;
  axis_deg: number | null;
}

export interface HandFromScanPage {
  kind: "hand_from_scan";
  report: HandFromScan;
  view: {
    maker: Maker;
    language: Language;
    vocabulary: Vocabulary;
    segments: { [name: string]: SegmentSize };
    scans: { posture: string; file: string; triangles: number; dots: number; lines: number }[];
    truth: null | {
      dimensions: { axis: "x" | "y" | "z"; mean_mm: number; largest_mm: number }[];
      fingers: { posture: string; pip: PlaceError; dip: PlaceError | null; tip: PlaceError | null }[];
      thumb_limits: { posture: string; place_mm: number; axis_deg: number | null }[];
      skin: { mean_mm: number; p95_mm: number } | null;
    };
    pictures: Picture[]; // hand_..., distance_..., scan_...
  };
}
