// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/product/product.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::study {

/// What an assessment's figures depend on without anybody knowing it exactly.
enum class ErrorSource {
  kTissue,    ///< softest and stiffest tissue that measurements allow
  kBone,      ///< what stands under the skin: endless tissue or the hand's own bones
  kMesh,      ///< the skin's mesh, every triangle split into four
  kFriction,  ///< coefficient of friction while the grasp comes to rest
  kPosture    ///< how the fingers are bent
};
std::string_view name_of(ErrorSource source);  ///< "tissue", "bone", ...

/// The same product held once more with one thing changed.
struct ErrorCase {
  ErrorSource source{};
  std::string changed;               ///< "soft tissue", "friction 0.3"
  std::string failure;               ///< why there are no figures, or empty
  double grip_force = 0.0;           ///< N, across the plane of largest squeeze
  double force = 0.0;                ///< N, sum of normal forces
  double area = 0.0;                 ///< mm^2
  double peak_pressure = 0.0;        ///< MPa
  double peak_pressure_cells = 0.0;  ///< MPa
  double mean_pressure = 0.0;        ///< MPa
};

struct ErrorBudget {
  ErrorCase nominal;  ///< nothing changed; `source` is meaningless
  std::vector<ErrorCase> cases;
};

struct ErrorBudgetOptions {
  double friction_change = 0.2;  ///< up and down; skin on products: 0.3 to 1.2 (friction.md)
  double bend = 0.0873;  ///< rad (5 degrees, our choice): MCP more and PIP less, and reverse
  /// The hand for TissueModel::kBone, asked for once; unset: made here (13 s).
  std::function<std::shared_ptr<const contact::SkinCompliance>(const hand::Hand&)> compliance;
};

/// How much the figures of an assessment change with one source of error at a time. Tissue, bone,
/// friction and posture: the closed grasp comes to rest again under the same options, so at the
/// same grip force if one was asked for. Mesh: the contact is solved again in the posture at rest,
/// as no hand can be posed on the finer skin; its vertices lie on the facets of the given one, so
/// that this is the error of the solution and not that of the shape. (Tissue on bone takes no skin
/// as fine as that: there the change of the half-space's figures is shown.)
///
/// `closed`: the grasp before it came to rest. Cost: about eight contacts and six settlings.
/// Cases without figures say why. Throws UsageError, Cancelled.
ErrorBudget error_budget(const std::shared_ptr<const hand::Hand>& hand,
                         const contact::PreparedHand& prepared, const product::Product& product,
                         const grasp::Grasp& closed, const Assessment& nominal,
                         const ErrorBudgetOptions& options = {}, const Progress& progress = {});

/// Every triangle of a skin split into four at the middles of its edges; a middle belongs to the
/// region and segment of its edge's first corner. `points`, one per vertex of the skin, gets the
/// middles of the posed skin.
hand::Hand split_skin(const hand::Hand& hand, std::vector<Vec3>& points);

}  // namespace palmar::study
