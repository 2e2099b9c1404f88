// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The page of a study.

import { ColourBar, Desk, Language, Maker, Picture, TrustedMarkup, Vocabulary } from "./common";

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
  /// How they hold it, that of most hands first; null: where coordinates say.
  holds: { hands: number; words: string | null; part: number | null; part_name: string; along: number | null }[];
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
  lower_in_second: number; // of them those in which the second has the lower value
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
    grip_force_words: string; // "grip force 107 N: 25 % of ..."; "": not brought to rest
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

/// The answer: of the first condition, by the highest pressure on sensor cells.
export interface StudyAnswer {
  tone: "good" | "fair" | "bad";
  sentence: string;
  reasons: string[];
  next: string;
  command: string;
  better: number | null; // index of a product; null: one product
  worse: number | null;
  changes: number[]; // by hand, of the peak: better over worse, less 1
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
  language: Language;
  desk: Desk;
  answer: StudyAnswer;
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
