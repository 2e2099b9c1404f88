// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A hand of two regions that holds a box, with numbers that can be followed by hand.

import { Assessment, AssessmentPage, ContactTotals, OnsetVerdict, Proportion, StudyPage, TissueRange, Vocabulary } from "../types";

export const vocabulary: Vocabulary = {
  regions: {
    index_distal: { words: "index finger, tip", colour: "#aa0000", pain_onset_mpa: 0.496, discomfort_onset_mpa: 0.188 },
    thenar: { words: "ball of the thumb (thenar)", colour: "#00aa00", pain_onset_mpa: 0.447, discomfort_onset_mpa: 0.1 },
  },
  segments: { palm: "palm", index_distal: "index finger, tip" },
  motions: {
    wrist_flexion: { words: "wrist flexion", lower_deg: null, upper_deg: null },
    index_pip_flexion: { words: "index PIP flexion", lower_deg: 0, upper_deg: 110 },
  },
  stops: { limit_depth: "pressed in to the limit depth" },
  statuses: { held: "Held", partly_held: "Partly held", too_large: "Too large for this hand",
              too_small: "Too small for this hand", not_graspable: "No place for a power grip" },
  grips: { medium_wrap: { is_power: true }, tripod: { is_power: false }, tip_pinch: { is_power: false } },
  blood_flow_stop_mpa: 0.05,
};

export function range(low: number | null, nominal: number, high: number | null): TissueRange {
  return { low, nominal, high };
}

function totals(force: number, area: number, peak: number, cells: number): ContactTotals {
  return {
    force_n: force, contact_area_mm2: area, peak_pressure_mpa: peak, peak_pressure_cells_mpa: cells, unresolved_force_n: 0,
    mean_pressure_mpa: 0.0123456789, force_vector_n: [0, 3, 4], centre_mm: [0, 0, 0], max_penetration_mm: 1.5, band: null,
  };
}

export function onset(region: string, pressure: number, limit: number, above: number): OnsetVerdict {
  const share = pressure / limit;
  return { region, pressure_mpa: pressure, onset_mpa: limit, share, regions_above: above,
           level: share >= 1 ? "above" : share >= 0.5 ? "near" : "below" };
}

export function assessment(): Assessment {
  return {
    product: { name: "box & \"co\"", source: "box.stl", unit: "mm", unit_from: "option", vertices: 8, triangles: 12,
               size_mm: [20, 60, 20], notes: [] },
    hand: { name: "ball <hand>", side: "right", hand_length_mm: 186.5, hand_circumference_mm: 200, hand_width_mm: 80,
            hand_thickness_mm: 30, vertices: 10, triangles: 16, provenance: "made for a test" },
    hold: null,
    doubts: [],
    grasp: {
      grip: "medium_wrap", status: "held", message: "held by <five> fingers",
      posture: { wrist_flexion_deg: 0, index_pip_flexion_deg: 45.678 },
      product_from_hand: { quaternion_wxyz: [Math.SQRT1_2, 0, 0, -Math.SQRT1_2], translation_mm: [1, 2, 3], matrix_rows_mm: [] },
      grip_point_mm: [0, 0, 0], grip_axis: [1, 0, 0], grip_girth_mm: 110,
      segments: [{ segment: "palm", stopped_by: "limit_depth", penetration_mm: 6.9 }],
      fingertips: [], score: 1, candidates: 1, runners_up: [],
    },
    certainty: null,
    balance: { status: "off", message: "" },
    contact: {
      ...totals(12.3456789, 345, 1.2, 0.06), status: "solved", message: "", grip_force_n: 5.4321, complementarity_error_n_mm: 0,
      residual_penetration_contact_mm: 0, residual_penetration_other_mm: 0, iterations: 1, resolved: true, refinement: null,
      // 1.2 / 3.0 = 0.4 is farther from pain than 1.0 / 2.0 = 0.5, though the pressure is higher.
      regions: [{ ...totals(8, 200, 1.2, 0.06), region: "index_distal", shear_modulus_mpa: 0.03 },
                { ...totals(4.3456789, 145, 1.0, 0.04), region: "thenar", shear_modulus_mpa: 0.02 }],
    },
    verdict: {
      held: "held", sentence: "box is held with 5.43 N.",
      comfort: {
        sentence: "A moment of this grip doesn’t hurt.",
        moment: onset("index_distal", 0.06, 0.496, 0), repeated: onset("thenar", 0.06, 0.1, 0),
        minutes: { limit_mpa: 0.05, share_of_skin: 0.62, area_mm2: 214 }, regions_touched: 2,
      },
      strength: { sentence: "A grip of 5.43 N takes 2.1 % of the strength of the muscles of people in this hold.", grip_force_n: 5.43, share: 0.021, limited_by: "fingers", whose: "people", for_comparison: { dynamometer_n: 427, share: 0.0127 } },
      hardest: { sentence: "It presses hardest at the tip.", region: "index_distal", pressure_mpa: 0.06, on_product_mm: [1, 2, 3], face: null },
    },
    indices: {},
    index_table: [],
    settings: {
      palm_limit_depth_mm: 7, finger_limit_depth_mm: 4, at_mm: null, axis: null, turn_deg: null, balance: false,
      balance_friction: 0.5, grip_force_asked_n: null, grip_force_from: "", contact_model: "palmar", kernel: "patch", tissue_model: "halfspace",
      regions: "coupled", swelling: true, skin_on_skin: false, refine: true, coatings: [], error_band: true, cell_area_mm2: 24, shear_modulus_mpa: null, seed: 0,
    },
  };
}

/// The tissue's range on the whole hand and both regions; `low` and `high`: of the force.
export function withBand(one: Assessment, low: number | null, high: number | null): Assessment {
  const band = (force: TissueRange, share: number) => ({
    force_n: force, contact_area_mm2: range(300, 345, 400), peak_pressure_mpa: range(0.8, 1.0, 1.5),
    peak_pressure_cells_mpa: range(0.03, 0.05, 0.07), force_per_modulus_n: 12 * share,
  });
  one.contact.band = band(range(low, one.contact.force_n, high), 1);
  one.contact.regions[0].band = band(range(low, 8, high), 0.7);
  one.contact.regions[1].band = band(range(low, 4.3, high), 0.3);
  return one;
}

export function page(assessments: Assessment[]): AssessmentPage {
  return {
    kind: "assessment",
    report: {
      assessments,
      verdict: { sentence: "B presses 27 % less <than> A.", reasons: ["Because & why."], next: "Ask others:", command: "palmar study run --hands 12",
                 best: null, told_apart: 0.1, comparisons: [] },
      versions: { palmar: "1", build: "1" }, command_line: "palmar assess a <b>",
    },
    view: {
      maker: { version: "1.2", build: "1.2 (test)", viewer_licence: "Permission is hereby granted" },
      language: "en",
      desk: { units: "metric", project: null },
      is_cut_short: false,
      vocabulary,
      scale: { quantity: "Pressure", unit: "MPa", upper: 0.5, is_open_ended: true, colours: ["#000000", "#ffffff"],
               neutral: "#888888", ticks: [{ value: 0, text: "0.0" }, { value: 0.5, text: "≥ 0.5" }] },
      products: assessments.map(() => ({
        charts: [{ title: "Force, N", svg: "<svg>force</svg>" }], sensor_map: null, sensitivity_chart: "<svg>stiffer</svg>",
        friction_words: "It slips.", scene: "{}", ways: [], way_taken: null, why_taken: "",
        pictures: [{ name: "grasp_palm", title: "Grasp", alt: "A hand", src: "attachment:p", thumbnail: "attachment:t" }],
      })),
    },
  };
}

export function proportion(count: number, n: number): Proportion {
  return { count, n, share: count / n, low: 0.1, high: 0.9 };
}

export function study(): StudyPage {
  const product = {
    hands: 6, hands_holding: 5,
    holds: [{ hands: 6, words: "medium wrap of the handle", part: 2, part_name: "handle", along: 0.4 }],
    quantities: { peak: { n: 5, mean: 0.25, sd: 0.05, median: 0.24, p5: 0.2, p95: 0.3 } },
    regions: { thenar: { force_n: 3, area_mm2: 100, peak_pressure_cells_mpa: 0.1, touching: 1 } },
    accommodation: { in_hand: proportion(5, 6), inside: proportion(4, 6),
                     outside_because_of: [{ words: "slips out", hands: 1 }], not_run: 1,
                     shortest_outside_mm: 160, longest_outside_mm: 170 },
    exclusion: { excluded: proportion(1, 6), because_of: [{ words: "strength", hands: 1 }], unknown: 0 },
  };
  const peak = { key: "peak", name: "peak pressure", unit: "MPa" };
  return {
    kind: "study",
    maker: { version: "1.2", build: "1.2 (test)", viewer_licence: "Permission is hereby granted" },
    title: "Prisms <of two sizes>",
    hands: 6, grasps: 11, grasps_planned: 12,
    vocabulary,
    products: [{ name: "old", colour: "#112233", pictures: [] }, { name: "new", colour: "#332211", pictures: [] }],
    language: "en",
    desk: { units: "metric", project: null },
    answer: { tone: "good", sentence: "New presses 16 % less than old.", reasons: ["4 of 5 <hands>."], next: "Press it:", command: "palmar redesign press new.stl",
              better: 1, worse: 0, changes: [-0.2, -0.1, -0.15, 0.05, -0.3] },
    verdict: ["New is better."],
    warnings: [{ is_outside: true, subject: "Hands", text: "Few." }],
    limits: [], threshold_mpa: 0.05, main_quantities: ["peak"], quantities: [peak],
    conditions: [{
      title: "people", words: "", are_figures_shown: true, figures: [{ description: "Dots", svg: "<svg>dots</svg>" }],
      products: [product, product],
      comparisons: [{ quantity: peak, pairs: [{
        first: 0, second: 1, hands: 6, pairs: 5, left_out_words: "old: 1 slips out", lower_in_second: 4,
        difference: { value: -0.04, low: -0.06, high: -0.02 }, effect_size: { value: -1.5, low: -2, high: -1 },
        t_p_holm: 0.0004, wilcoxon_p_holm: 0.03125, verdict: "shown" }] }],
      sizes: [], dependence: [], faces: [], has_nails: false,
    }],
    scene: null,
    provenance: {
      study: "s", seed: 5, sha256: "", program: "", populations: [], products: [], grips: [null], settings: [],
      has_several_profiles: false, profiles: [],
      hand: { name: "template", side: "right", hand_length_mm: 176, hand_circumference_mm: 193, sha256: "", provenance: "made" },
      stiffness: [],
    },
  };
}
