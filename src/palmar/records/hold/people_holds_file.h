// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/grasp/holds/fit_holds.h"

namespace palmar::records {

/// How a person was seen to hold an object. The object's frame, mm.
struct PeopleHold {
  grasp::HandPoints points;
  Vec3 up = Vec3::UnitZ();  ///< which way was up where it lay before, unit
};

/// How people were seen to hold one object.
struct PeopleHolds {
  std::string object;
  std::vector<PeopleHold> holds;
};

/// A table of people's holds, *.csv: a row per hold, "object", wrist_x_mm, wrist_y_mm, wrist_z_mm,
/// thumb_x_mm ... little_z_mm and up_x, up_y, up_z in the object's frame; other columns are passed
/// over. Objects in the order in which they come. Right hands. Throws InputError naming file, line
/// and column.
std::vector<PeopleHolds> read_people_holds(const std::string& path);

/// Weights of a chooser as TOML, a table per feature with weight, mean and spread.
std::string hold_weights_toml(const grasp::HoldWeights& weights);
/// Throws InputError naming file, line and key: a feature that is missing or not known, a spread
/// that isn't above 0.
grasp::HoldWeights read_hold_weights(const std::string& path);

/// What `palmar grasp fit-holds --json` prints.
std::string hold_fit_json(const grasp::HoldFit& fit);

}  // namespace palmar::records
