// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/contact/press/press.h"
#include "palmar/records/csv.h"

namespace palmar::records {

/// What an indentation test was made with, beside its options.
struct PressSetting {
  std::string hand;             ///< name of the hand; empty for a plane or ellipsoid
  contact::ContactModel model;  ///< that ran
};

/// What `palmar contact press --json` prints: {"test": {"specimen", "hand", "indenter", "tilt_deg",
/// "kernel", "tissue_model", "tissue_level", "layer_mm", "poisson", "coating"}, "steps":
/// [{"depth_mm", "force_n", "contact_area_mm2", "peak_pressure_mpa", "peak_pressure_cells_mpa",
/// "mean_pressure_mpa", ...}], "versions"}. Numbers read back exactly.
std::string press_json(const contact::PressOptions& options, const PressSetting& setting,
                       const std::vector<contact::PressStep>& steps);

/// One row per step, units in the header.
CsvTable press_table(const std::vector<contact::PressStep>& steps);

}  // namespace palmar::records
