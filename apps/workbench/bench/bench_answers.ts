// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the server answers on the live channel (src/palmar/server/live_answer.h), as far as the page
// reads it.
import { ShelvedProduct } from "./api";
import { RegionName } from "./figures_panel";
import { Answer } from "./live_channel";
import { Triple } from "./live_frame";
import { Angle } from "./pose_panel";
import { Colours } from "./scene";
import { ShownPart } from "./snap";

export interface OpenedHold {
  number: number;
  words: string;
  against: string;
  part: number;
  along: number;
  score: number | null;
  grip: string;
  thumb_towards: Triple; // product frame
}

export interface Opened extends Answer {
  product: ShelvedProduct;
  hand: { name: string; side: string; angles: Angle[]; regions: RegionName[] };
  holds: OpenedHold[];
  parts: ShownPart[];
  colours: Colours;
}

export interface Result extends Answer {
  is_hold: boolean;
  command: string;
  posture: { posture: Record<string, number>; product_from_hand: { quaternion_wxyz: number[]; translation_mm: number[] }; grip: string };
  upper_mpa: number;
  hold_words: string;
  assessment: {
    assessments: {
      verdict: { held: string; sentence: string };
      grasp: { message: string; grip: string };
      contact: { centre_mm: Triple; message: string };
      doubts?: { words: string }[];
    }[];
    verdict: { sentence: string; reasons: string[] };
  };
}
