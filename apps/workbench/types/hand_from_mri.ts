// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A hand from MR images.

import { Language, Maker, Picture, PostureAngles, TrustedMarkup, Vector3, Vocabulary } from "./common";
import { HandInfo } from "./hand";

export interface Turn {
  quaternion_wxyz: [number, number, number, number];
  translation_mm: Vector3;
}

/// Mean distance of a bone from the one scanned in another posture: moved freely, by joints with
/// fixed axes, by the thumb's interpolated saddle joint.
export interface BoneError {
  posture: string;
  bone: string;
  icp_mm: number;
  single_axis_mm: number;
  interpolated_cmc_mm: number | null;
}

/// scan.json of a hand from MR images.
export interface HandFromMri {
  side: "left" | "right";
  scans: {
    posture: string;
    series: string;
    side: string;
    was_kept: boolean;
    bones: string[];
    unnamed_bones: number;
    markers: number;
    air_threshold: number;
    bone_threshold: number;
    noise: number;
    bone_error_estimate_mm: number;
    fat_shift_mm: number[];
    notes: string[];
  }[];
  hand: HandInfo;
  patient_from_hand: Turn;
  joints: {
    joint: string;
    dof: string;
    is_measured: boolean;
    axis_error_deg: number | null; // standard error of a measured axis; null: none is known
    axis: Vector3;
    centre_mm: Vector3;
    axis_patient: Vector3;
    centre_patient_mm: Vector3;
    lower_deg: number;
    upper_deg: number;
    reference_deg: number;
  }[];
  thumb_cmc_limits: { flexion: Turn; extension: Turn; abduction: Turn; adduction: Turn };
  postures: { [name: string]: PostureAngles };
  bone_motions: {
    [posture: string]: {
      bone: string;
      counterpart: string;
      quaternion_wxyz: [number, number, number, number];
      translation_mm: Vector3;
      mean_distance_mm: number | null;
      overlap: number | null;
      conditioning: number | null;
      image: { correlation: number; overlap: number; turn_error_deg: number; shift_error_mm: number } | null;
    }[];
  };
  bone_errors: BoneError[];
  bone_error_rows: BoneError[];
  skin_errors: {
    posture: string;
    skinning_only_mm: number;
    markers_alone_mm: number | null;
    corrected_mm: number | null;
  }[];
  grasp_contact: null | {
    product: string;
    range_mm: number;
    hand_area_mm2: number;
    scanned_area_mm2: number;
    shared_area_mm2: number;
    intersection_over_union: number;
    share_of_hand: number;
    share_of_scan: number;
  };
  skin_registration: { mean_mm: number; p95_mm: number };
  notes: string[];
}

/// found.json of MR images that no hand came of.
export interface RefusedScans {
  refusal: {
    step: "surfaces" | "bones" | "motions" | "joints" | "hand" | "contact";
    posture: string | null; // whose scan it was about; null: all
    message: string;
  };
  side: "left" | "right";
  scans: HandFromMri["scans"];
  bone_motions: HandFromMri["bone_motions"];
  notes: string[];
}

export interface RefusedScansPage {
  kind: "refused_scans";
  report: RefusedScans;
  view: {
    maker: Maker;
    language: Language;
    postures: string[]; // all that can be scanned
    bones: number; // of a hand
    pictures: Picture[]; // scan_...
  };
}

export interface HandFromMriPage {
  kind: "hand_from_mri";
  report: HandFromMri;
  view: {
    maker: Maker;
    language: Language;
    vocabulary: Vocabulary;
    postures: string[]; // all that can be scanned
    charts: TrustedMarkup[]; // of bone errors
    pictures: Picture[]; // hand_..., error_..., scan_...
  };
}
