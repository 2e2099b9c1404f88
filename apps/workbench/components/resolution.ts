// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { ContactResult, Vocabulary } from "../types";
import { say, sayCount, sayList } from "../texts";
import { Markup } from "./markup";
import { percent } from "./numbers";
import { note } from "./parts";
import { regionWords } from "./verdicts";

const mostNamed = 3;
const toldShare = 0.3; // of a region's force, as in contact/prepared/resolution.h

/// What was done about sharp edges, or that pressures on them are not resolved, where that is so.
export function resolutionNote(contact: ContactResult, vocabulary: Vocabulary): Markup | null {
  const refinement = contact.refinement ?? null;
  if (refinement !== null && refinement.halvings > 0) {
    const words = say("resolution.refined", {
      vertices: String(refinement.vertices_added),
      edge: refinement.finest_edge_mm.toFixed(1),
      change: percent(refinement.last_change_of_peaks),
    });
    return contact.resolved
      ? note("good", say("resolution.good"), words)
      : note("fair", say("resolution.begin"), words);
  }
  const told = contact.regions.filter((one) => one.unresolved_force_n > toldShare * one.force_n);
  if (told.length === 0) return null;
  told.sort((a, b) => b.peak_pressure_cells_mpa - a.peak_pressure_cells_mpa);
  // "thumb, base": with the commas of a list it couldn't be read.
  const named = told.slice(0, mostNamed).map((one) => regionWords(one.region, vocabulary).replace(", ", " – "));
  if (told.length > mostNamed) named.push(sayCount("resolution.others", told.length - mostNamed));
  return note("fair", say("resolution.begin"), say("resolution.words", {
    share: percent(contact.unresolved_force_n / contact.force_n),
    regions: sayList(named),
  }));
}
