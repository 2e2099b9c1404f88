// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/effort/effort.h"
#include "palmar/grasp/indices/coordination.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/grasp/indices/stability.h"
#include "palmar/grasp/rest/balance.h"

namespace palmar::study {

struct IndexOptions {
  bool is_on = true;
  grasp::StabilityOptions stability;
  std::optional<grasp::CoordinationBasis> coordination;  ///< unset: built_in_coordination()
  effort::EffortOptions effort;
  /// Whether evaluate() adds the largest torque about the grip axis (held_torque.h).
  bool torque = false;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// One held product, for its indices.
struct HeldProductState {
  const grasp::Grasp& grasp;
  const grasp::Balance& balance;
  const contact::ContactResult& contact;
  const std::vector<Vec3>& posed_skin;  ///< hand frame, mm
};

/// Everything that is said of a grasp beside force, area and pressure: group "grip" (how firm, how
/// even, in balance), then stability, ease, fitness, comfort and effort. A grasp without contact
/// has rows without values. Friction of the grasp at rest counts in the effort.
grasp::GraspIndices grasp_indices(const hand::Hand& hand, const product::Product& product,
                                  const HeldProductState& held, const Vec3& mass_centre,
                                  const IndexOptions& options = {});

/// The rows that grasp_indices() can have, without values: what a key means, its unit, which way is
/// better. Bounds that depend on the grasp are not in it.
const grasp::GraspIndices& index_catalogue();

}  // namespace palmar::study
