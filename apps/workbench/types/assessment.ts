// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Assessments: the JSON that Palmar writes as assessment.json, and its page.

import { ColourBar, Desk, Language, Maker, Picture, Placement, PostureAngles, TrustedMarkup, Vector3, Vocabulary } from "./common";

export interface ProductResult {
  name: string;
  source: string;
  unit: string;
  unit_from: string;
  vertices: number;
  triangles: number;
  size_mm: Vector3;
  notes: string[];
}

export interface HandResult {
  name: string;
  side: "left" | "right";
  hand_length_mm: number;
  hand_circumference_mm: number;
  hand_width_mm: number;
  hand_thickness_mm: number;
  vertices: number;
  triangles: number;
  provenance: string;
}

export type GraspStatus = "held" | "partly_held" | "too_large" | "too_small" | "not_graspable";

export interface GraspResult {
  grip: string;
  status: GraspStatus;
  message: string;
  posture: PostureAngles;
  product_from_hand: Placement;
  grip_point_mm: Vector3;
  grip_axis: Vector3;
  grip_girth_mm: number;
  segments: { segment: string; stopped_by: string; penetration_mm: number }[];
  fingertips: {
    finger: string;
    target_mm: Vector3;
    reached_mm: Vector3;
    normal: Vector3;
    miss_mm: number;
  }[];
  score: number;
  candidates: number;
  runners_up: { grip: string; score: number; posture: PostureAngles; product_from_hand: Placement }[];
}

/// What is there whatever the status; the rest unless it is "off".
/// How often the contact solver had to fall back, by kind.
export type Fallbacks = Record<string, number>;

/** Shares by which figures change. */
export interface FigureChange {
  sum_of_normal_forces: number;
  area: number;
  peak_pressure_cells: number;
  mean_pressure: number;
}

export interface Certainty {
  hand_1_percent_larger: FigureChange;
  force_1_percent_more: FigureChange;
  second_rest: { change: FigureChange; effort_over_first: number } | null;
}

export interface BalanceResult {
  status: "off" | "balanced" | "supported" | "slips_out" | "no_contact" | "failed";
  message: string;
  fallbacks?: Fallbacks;
  friction_coefficient?: number;
  grip_force_n?: number;
  sum_of_normal_forces_n?: number;
  turn_n_m?: number | null;
  residual_force_n?: number;
  residual_moment_n_mm?: number;
  residual_over_grip_force?: number;
  friction_in_use?: number;
  flexion_strength_in_use?: number | null;
  moved_mm?: number;
  turned_deg?: number;
  slip_direction_in_hand?: Vector3 | null;
  iterations?: number;
}

/// A value with soft, middle and stiff tissue; null where the contact could not be solved.
export interface TissueRange {
  low: number | null;
  nominal: number;
  high: number | null;
}

export interface ContactBand {
  force_n: TissueRange;
  contact_area_mm2: TissueRange;
  peak_pressure_mpa: TissueRange;
  peak_pressure_cells_mpa: TissueRange;
  force_per_modulus_n: number;
}

export interface ContactTotals {
  force_n: number;
  contact_area_mm2: number;
  peak_pressure_mpa: number;
  peak_pressure_cells_mpa: number;
  unresolved_force_n: number; // on edges that are sharper than the skin's mesh
  mean_pressure_mpa: number;
  force_vector_n: Vector3;
  centre_mm: Vector3;
  max_penetration_mm: number;
  band: ContactBand | null;
}

export interface RegionContact extends ContactTotals {
  region: string;
  shear_modulus_mpa: number;
}

/** Skin of two regions of the hand on each other; no force on the product. */
export interface SkinOnSkin {
  region: string;
  other_region: string;
  skin_on_skin_force_n: number;
  force_vector_n: Vector3; // on `region`, product frame
  contact_area_mm2: number;
  peak_pressure_mpa: number;
  crossing_before_mm: number; // deepest, before the skins give way
}

/** What was done to the skin on sharp edges of the product. */
export interface Refinement {
  halvings: number; // 0: it would have taken too many points
  vertices_added: number;
  finest_edge_mm: number;
  last_change_of_peaks: number; // share by which the last halving moved the highest pressures on cells
  peak_pressure_cells_before_mpa: number;
}

export interface ContactResult extends ContactTotals {
  status: "solved" | "no_contact" | "not_converged" | "too_deep";
  message: string;
  grip_force_n: number;
  complementarity_error_n_mm: number;
  residual_penetration_contact_mm: number;
  residual_penetration_other_mm: number;
  residual_crossing_mm?: number; // by which skin still crosses other skin
  skin_on_skin_force_n?: number;
  skin_on_skin?: SkinOnSkin[];
  iterations: number;
  fallbacks?: Fallbacks;
  resolved?: boolean; // whether pressures hold against a finer skin
  refinement?: Refinement | null; // null: nothing had to be refined, or it was switched off
  regions: RegionContact[];
}

export interface GraspIndex {
  key: string;
  name: string;
  group: string;
  value: number | null;
  unit: string;
  lowest: number | null;
  highest: number | null;
  better: "up" | "down" | "neither";
  definition: string;
  source: string;
  remark: string;
  told_apart: number; // share by which two values must differ to be told apart
}

export interface Coating {
  thickness_mm: number;
  shear_modulus_mpa: number;
  poisson: number;
  box_corners_mm: [Vector3, Vector3] | null; // null: the whole product
}

export interface AssessmentSettings {
  palm_limit_depth_mm: number;
  finger_limit_depth_mm: number;
  at_mm: Vector3 | null;
  axis: Vector3 | null;
  turn_deg: number | null;
  balance: boolean;
  balance_friction: number;
  grip_force_asked_n: number | null; // null: as firm as it was closed
  grip_force_from: string; // where it comes from, or why nothing is asked for, for people
  contact_model: string;
  kernel: "patch" | "point";
  tissue_model: "halfspace" | "layered" | "bone";
  regions: "coupled" | "independent";
  swelling: boolean;
  skin_on_skin: boolean;
  refine: boolean;
  coatings: Coating[];
  error_band: boolean;
  cell_area_mm2: number;
  shear_modulus_mpa: number | null;
  seed: number;
}

export interface FaceContact {
  face: number;
  title: string;
  name: string;
  part: string;
  kind: string;
  is_fillet: boolean;
  radius_mm: number | null;
  area_mm2: number;
  force_n: number;
  contact_area_mm2: number;
  peak_pressure_mpa: number;
  mean_pressure_mpa: number;
  has_peak: boolean;
}

export interface Wrench {
  force_n: Vector3;
  moment_about_origin_n_mm: Vector3;
}

export interface SmallMotion {
  translation_mm: Vector3;
  rotation_deg: Vector3;
  about_mm: Vector3;
}

export interface FrictionResult {
  status: "off" | "held" | "slips" | "no_contact" | "not_converged";
  message: string;
  coefficient: number;
  given: {
    weight_n: number;
    gravity: Vector3;
    force_n: Vector3;
    torque_n_mm: Vector3;
    force_at_mm: Vector3;
    mass_centre_mm: Vector3;
    mass_centre_from: string;
  };
  load: Wrench;
  load_factor: number | null;
  slip_margin: number;
  slipping_share_of_area: number;
  motion: SmallMotion;
  slip_motion: SmallMotion;
  pressure_on_product: Wrench;
  balance_error: number;
  iterations: number;
  regions: {
    region: string;
    normal_force_n: number;
    friction_limit_n: number;
    friction_force_n: Vector3;
    slip_margin: number;
    slipping_share_of_area: number;
  }[];
}

/// One reason for or against a hold; scores add up.
export interface HoldTerm {
  name: string;
  value: number | null;
  unit: string;
  score: number | null;
  words: string;
}

/// By which part of the product the hand holds it, and how.
export interface HoldResult {
  part: number;
  part_name: string;
  kind: string | null;
  grip: string;
  along: number;
  edge: number;
  toward: number;
  turn_deg: number;
  over_end: boolean;
  words: string;
  fingertips?: { finger: string; along: number; turn_deg: number; height_mm: number }[];
  along_toward?: [number, number, number]; // where along grows, the product's frame
  turn_from?: [number, number, number];
  wrist?: [number, number, number]; // from the fingertips' middle, the product's frame
  score?: number | null; // where it was ranked
  terms?: HoldTerm[];
}

/// Why a hold is to be doubted though the product is in the hand.
export interface HoldDoubt {
  key: "not_at_rest" | "slips_out" | "few_contacts";
  words: string;
}

/// A region's pressure over an onset, where that is largest.
export interface OnsetVerdict {
  region: string;
  pressure_mpa: number;
  onset_mpa: number;
  share: number;
  level: "below" | "near" | "above";
  regions_above: number;
}

/// What one product comes to; sentences as they are in the language of the report.
export interface ProductVerdict {
  held: "held" | "rests" | "pushes" | "doubtful" | "not_held";
  sentence: string;
  comfort: null | {
    sentence: string;
    moment: OnsetVerdict;
    repeated: OnsetVerdict;
    minutes: { limit_mpa: number; share_of_skin: number; area_mm2: number };
    regions_touched: number;
  };
  strength: null | {
    sentence: string; grip_force_n: number; share: number | null; limited_by: "fingers" | "wrist" | null; whose: string;
    for_comparison: { dynamometer_n: number; share: number };
  };
  hardest: null | {
    sentence: string;
    region: string;
    pressure_mpa: number;
    on_product_mm: Vector3 | null;
    face: string | null;
  };
}

/// The answer.
export interface SetVerdict {
  sentence: string;
  reasons: string[];
  next: string;
  command: string;
  best: string | null;
  told_apart: number;
  comparisons: {
    better: string;
    worse: string;
    verdict: "lower" | "same" | "depends_on_skin" | "depends_on_rest" | "unequal_force" | "only_one_held" | "none_held";
    peak_change: number;
    area_change: number;
    peak_change_soft: number | null;
    peak_change_stiff: number | null;
    peak_unsure: number | null;
    peak_change_second_rest: number | null;
    hand_turned_deg: number | null;
    hand_shifted_mm: number | null;
    held_alike: boolean;
  }[];
}

/// A sensor between hand and product, and what a real one measured.
export interface SensorResult {
  layout: { name: string; kind: "mat" | "glove" | "free"; pitch_mm: number; source: string };
  rows: number;
  columns: number;
  force_n: number;
  force_beside_n: number;
  peak_pressure_mpa: number;
  pressed_area_mm2: number;
  cells: {
    patch: string;
    row: number;
    column: number;
    area_mm2: number;
    force_n: number;
    mean_pressure_mpa: number;
    region: string | null;
  }[];
  measured: MeasuredPressure | null;
}

export interface MeasuredPressure {
  source: string;
  force_measured_n: number;
  force_simulated_n: number;
  peak_measured_mpa: number;
  peak_simulated_mpa: number;
  compared: number;
  pearson: { r: number; n: number; p_value: number; low?: number; high?: number };
  spearman: { r: number; n: number; p_value: number };
  rms_mpa: number;
  mean_difference_mpa: number;
  parts: { name: string; cells: number; measured_n: number; simulated_n: number }[];
  cell_force_n: number[]; // in the order of the cells
}

export interface Assessment {
  product: ProductResult;
  hand: HandResult;
  hold: HoldResult | null; // null: where coordinates say
  doubts: HoldDoubt[];
  grasp: GraspResult;
  balance: BalanceResult;
  certainty: Certainty | null;
  contact: ContactResult;
  verdict: ProductVerdict;
  indices: { [key: string]: number | string[] | null };
  index_table: GraspIndex[];
  settings: AssessmentSettings;
  faces?: FaceContact[]; // of products from CAD
  sensors?: SensorResult; // if they were asked for
  friction?: FrictionResult;
}

/// assessment.json
export interface AssessmentReport {
  assessments: Assessment[];
  verdict: SetVerdict;
  versions: { palmar: string; build: string };
  command_line: string;
}

/// What the page of assessments shows beside the results themselves.
export interface AssessmentView {
  maker: Maker;
  language: Language;
  desk: Desk;
  is_cut_short: boolean;
  vocabulary: Vocabulary;
  scale: ColourBar;
  products: {
    charts: { title: string; svg: TrustedMarkup }[]; // force and peak pressure by region
    sensor_map: TrustedMarkup | null;
    sensitivity_chart: TrustedMarkup | null;
    friction_words: string;
    pictures: Picture[];
    ways: { number: number; words: string; score: number | null; against: string }[]; // best first
    way_taken: number | null; // which of them
    why_taken: string; // why that isn't the first; "": it is, or it was asked for
    scene: TrustedMarkup; // JSON for the 3-D view
  }[];
}

export interface AssessmentPage {
  kind: "assessment";
  report: AssessmentReport;
  view: AssessmentView;
}
