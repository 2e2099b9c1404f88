// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What several pages have.

export type Language = "en" | "de";

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

/// Words, colours and limits by Palmar's names, in anatomical order.
export interface Vocabulary {
  regions: { [name: string]: { words: string; colour: string; pain_onset_mpa: number; discomfort_onset_mpa: number } };
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

/// Whose a report is, and in which units it opens.
export interface Desk {
  units: "metric" | "us";
  project: null | { name: string; author: string; remarks: string; logo: string | null };
}

/// What every page says of the program that made it.
export interface Maker {
  version: string;
  build: string;
  viewer_licence: string;
}
