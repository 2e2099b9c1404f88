// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/grasp/holds/hold.h"

namespace palmar::tests {

/// One way in which people hold a product: an entry of people.toml or made.toml, which say what the
/// keys mean.
struct PeoplesHold {
  std::string product, use, part;
  std::vector<std::string> grips;       ///< families
  std::vector<Box3> centre;             ///< one of these, mm
  std::vector<Vec3> thumb_toward;       ///< one of these; empty: any
  std::vector<Vec3> palm_faces;         ///< one of these; empty: any
  double palm_within = 0.0;             ///< rad
  std::vector<Vec3> fingers_toward;     ///< one of these; empty: any
  std::optional<Box3> index_fingertip;  ///< where it lies, mm
};

/// Throws InputError naming file and key on anything that isn't understood.
std::vector<PeoplesHold> read_peoples_holds(const std::filesystem::path& file);

/// Whether a grip belongs to a family of made.toml ("power", "pinch", ...). Throws UsageError for
/// an unknown family.
bool is_of_family(grasp::Grip grip, const std::string& family);

/// What tells a hold from what people do, in words; "" if nothing does. The index finger's place is
/// not looked at.
std::string objection(const PeoplesHold& people, const grasp::RankedHold& found);
/// "" if any of them has no objection; else that of each, so that a miss explains itself.
std::string objection(const std::vector<PeoplesHold>& people, const grasp::RankedHold& found);

/// Centre of a hold: of a grip with the palm, the point of the axis that the hand is round; of
/// fingertips, the middle between the thumb's target and the mean of the others'; of a hand that
/// lies on the product, the mean of all. Product frame, mm.
Vec3 centre_of(const grasp::RankedHold& found);

/// Where the index finger's tip is, product frame, mm.
Vec3 index_fingertip(const hand::Hand& hand, const grasp::RankedHold& found);

}  // namespace palmar::tests
