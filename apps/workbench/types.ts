// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The JSON that pages are made of. Results (AssessmentReport) are the files that Palmar writes; a
// test holds these types to real ones, key by key. Units stand in the names.

export type Vector3 = [number, number, number];

/// Markup made by Palmar itself (a figure as SVG, a scene): goes into the page as it is.
export type TrustedMarkup = string;

export interface Placement {
  quaternion_wxyz: [number, number, number, number];
  translation_mm: Vector3;
  matrix_rows_mm: [number, number, number, number][];
}

/// Angles of the joints by name of motion with "_deg".
export interface PostureAngles {
  [motion: string]: number;
}

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
export interface BalanceResult {
  status: "off" | "balanced" | "slips_out" | "no_contact" | "not_converged" | "failed";
  message: string;
  friction_coefficient?: number;
  grip_force_n?: number;
  sum_of_normal_forces_n?: number;
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

export interface ContactResult extends ContactTotals {
  status: "solved" | "no_contact" | "not_converged" | "too_deep";
  message: string;
  complementarity_error_n_mm: number;
  residual_penetration_contact_mm: number;
  residual_penetration_other_mm: number;
  iterations: number;
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
  grip_force_asked_n: number | null;
  contact_model: string;
  kernel: "patch" | "point";
  tissue_model: "halfspace" | "layered";
  regions: "coupled" | "independent";
  swelling: boolean;
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

export interface Assessment {
  product: ProductResult;
  hand: HandResult;
  grasp: GraspResult;
  balance: BalanceResult;
  contact: ContactResult;
  indices: { [key: string]: number | string[] | null };
  index_table: GraspIndex[];
  settings: AssessmentSettings;
  faces?: FaceContact[]; // of products from CAD
  friction?: FrictionResult;
  times_s: { grasp: number; balance: number; contact: number; indices: number; friction?: number };
}

/// assessment.json
export interface AssessmentReport {
  assessments: Assessment[];
  versions: { palmar: string; build: string };
  command_line: string;
}

/// Words, colours and limits by Palmar's names, in anatomical order.
export interface Vocabulary {
  regions: { [name: string]: { words: string; colour: string; pain_onset_mpa: number } };
  segments: { [name: string]: string };
  motions: { [name: string]: { words: string; lower_deg: number | null; upper_deg: number | null } };
  stops: { [name: string]: string };
  statuses: { [name: string]: string };
  grips: { [name: string]: { is_power: boolean } };
  blood_flow_stop_mpa: number;
}

export interface Picture {
  name: string;
  title: string;
  alt: string;
  src: string; // an address; in a report that stands by itself, of data
  thumbnail: string | null; // a small one
}

export interface ColourBar {
  quantity: string;
  unit: string;
  upper: number;
  is_open_ended: boolean;
  colours: string[]; // from 0 up, equal steps
  neutral: string;
  ticks: { value: number; text: string }[];
}

/// What every page says of the program that made it.
export interface Maker {
  version: string;
  build: string;
  viewer_licence: string;
}

/// What the page of assessments shows beside the results themselves.
export interface AssessmentView {
  maker: Maker;
  is_cut_short: boolean;
  vocabulary: Vocabulary;
  scale: ColourBar;
  products: {
    charts: { title: string; svg: TrustedMarkup }[]; // force and peak pressure by region
    sensitivity_chart: TrustedMarkup | null;
    friction_words: string;
    pictures: Picture[];
    scene: TrustedMarkup; // JSON for the 3-D view
  }[];
}

export interface AssessmentPage {
  kind: "assessment";
  report: AssessmentReport;
  view: AssessmentView;
}

/// A count of n with its share and the share's interval; null where n is 0.
export interface Proportion {
  count: number;
  n: number;
  share: number | null;
  low: number | null;
  high: number | null;
}

export interface Estimate {
  value: number | null;
  low: number | null;
  high: number | null;
}

export interface Quantity {
  key: string;
  name: string;
  unit: string;
}

/// Over the hands that hold the product; percentiles from five hands on.
export interface QuantitySummary {
  n: number;
  mean: number | null;
  sd: number | null;
  median: number | null;
  p5: number | null;
  p95: number | null;
}

export interface CausedHands {
  words: string;
  hands: number;
}

/// One product under one condition.
export interface StudyProductResult {
  hands: number;
  hands_holding: number;
  quantities: { [key: string]: QuantitySummary };
  regions: {
    [name: string]: { force_n: number; area_mm2: number; peak_pressure_cells_mpa: number; touching: number };
  };
  accommodation: {
    in_hand: Proportion;
    inside: Proportion;
    outside_because_of: CausedHands[];
    not_run: number;
    shortest_outside_mm: number | null;
    longest_outside_mm: number | null;
  };
  exclusion: { excluded: Proportion; because_of: CausedHands[]; unknown: number };
}

export interface ProductPair {
  first: number; // index of a product
  second: number;
  hands: number;
  pairs: number; // hands that hold both
  left_out_words: string;
  difference: Estimate; // second - first
  effect_size: Estimate; // Cohen's dz
  t_p_holm: number | null;
  wilcoxon_p_holm: number | null;
  verdict: "too_few_pairs" | "none" | "not_shown" | "shown";
}

export interface ProductSizes {
  family: string;
  hands: number;
  choices: {
    sizes: {
      product: number;
      inside: number;
      alone: number;
      is_taken: boolean;
      from_mm: number | null;
      to_mm: number | null;
    }[];
    served: Proportion;
    served_by_length: Proportion;
  }[];
}

export interface SizeDependence {
  quantity: Quantity;
  product: number;
  size: "length" | "circumference";
  slope_per_mm: number | null;
  r2: number | null;
  rank_correlation: number | null;
  p_value: number | null;
  hands: number;
}

export interface FaceStatistics {
  product: number;
  words: string;
  hands: number;
  faces_touched: number;
  faces_in_all: number;
  faces: {
    title: string;
    part: string;
    has_peak: Proportion;
    touched: Proportion;
    above: Proportion;
    touching: number;
    peak_mean_mpa: number | null;
    peak_sd_mpa: number | null;
    peak_p95_mpa: number | null;
    peak_max_mpa: number | null;
    force_share: number | null;
  }[];
}

export interface StudyConditionResult {
  title: string;
  words: string; // what sets it apart; "" if it is the only one
  are_figures_shown: boolean;
  figures: { description: string; svg: TrustedMarkup }[];
  products: StudyProductResult[];
  comparisons: { quantity: Quantity; pairs: ProductPair[] }[];
  sizes: ProductSizes[];
  dependence: SizeDependence[];
  faces: FaceStatistics[];
  has_nails: boolean;
}

export interface StudyProvenance {
  study: string;
  seed: number;
  sha256: string; // of the results; "": not finished
  program: string;
  populations: {
    name: string;
    title: string;
    hands: number;
    design: "random" | "latin_hypercube" | "boundary" | "percentiles";
    boundary_share: number;
    seed: number;
    source: string;
    cautions: string[];
  }[];
  products: { name: string; file: string; size: number; mass_kg: number; posture_of: string; sha256: string }[];
  grips: (string | null)[];
  settings: {
    name: string;
    palm_limit_depth_mm: number;
    finger_limit_depth_mm: number;
    grip_force_n: number | null;
    strength_share: number | null;
    is_balanced: boolean;
    friction: number;
    is_place_per_hand: boolean;
    contact_model: string;
  }[];
  has_several_profiles: boolean;
  profiles: {
    name: string;
    range_share: number;
    strength_share: number;
    glove_thickness_mm: number;
    nail_length_mm: number;
    size_factor: number;
    source: string;
  }[];
  hand: {
    name: string;
    side: "left" | "right";
    hand_length_mm: number;
    hand_circumference_mm: number;
    sha256: string;
    provenance: string;
  };
  stiffness: { region: string; at_touch_mpa: number; at_limit_mpa: number; limit_depth_mm: number }[];
}

export interface StudyPage {
  kind: "study";
  maker: Maker;
  title: string;
  hands: number;
  grasps: number;
  grasps_planned: number;
  vocabulary: Vocabulary;
  products: { name: string; colour: string; pictures: Picture[] }[];
  verdict: string[];
  warnings: { is_outside: boolean; subject: string; text: string }[];
  limits: string[];
  threshold_mpa: number;
  main_quantities: string[];
  quantities: Quantity[];
  conditions: StudyConditionResult[];
  scene: null | {
    hands: string[]; // those in the view
    hands_in_all: number;
    has_faces: boolean;
    scales: { grasp: ColourBar; mean: ColourBar; sd: ColourBar; above: ColourBar };
    data: TrustedMarkup;
  };
  provenance: StudyProvenance;
}

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
    notes: string[];
  }[];
  hand: HandInfo;
  patient_from_hand: Turn;
  joints: {
    joint: string;
    dof: string;
    is_measured: boolean;
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

export interface HandFromMriPage {
  kind: "hand_from_mri";
  report: HandFromMri;
  view: {
    maker: Maker;
    vocabulary: Vocabulary;
    postures: string[]; // all that can be scanned
    charts: TrustedMarkup[]; // of bone errors
    pictures: Picture[]; // hand_..., error_..., scan_...
  };
}

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
