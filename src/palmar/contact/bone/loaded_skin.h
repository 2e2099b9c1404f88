// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "palmar/contact/bone/skin_compliance.h"

namespace palmar {

/// The compliance of a skin on bone among some vertices, each with the direction in which it is
/// pressed: entries m_i . C_ij m_j. Skin without tissue elements (the back of the hand) has the
/// half-space's among itself and none with the rest. Keeps its memory. The arguments must outlive
/// it.
class LoadedSkin {
 public:
  /// `scale`: R, and lengths of the skin, are those of `compliance` of a hand 1 / scale as large,
  /// per node: entries are divided by sqrt(s_a s_b). Exact for a
  /// hand scaled as a whole, and symmetric in any case. Empty: of the hand itself.
  LoadedSkin(const SkinGeometry& skin, const SkinCompliance& compliance,
             const std::vector<double>& node_scale);

  /// Vertices ascending; directions [unit] in the frame of the compliance (hand, reference
  /// posture).
  void set(const std::vector<int>& vertices, const std::vector<Vec3>& directions);
  /// Symmetric, 1/mm.
  const Eigen::MatrixXf& matrix() const { return matrix_; }

  /// Displacement times modulus [N/mm] of other vertices along their directions under forces [N] on
  /// the vertices that were set.
  std::vector<double> displacement(const std::vector<double>& force, const std::vector<int>& at,
                                   const std::vector<Vec3>& along) const;

 private:
  double half_space(int v, const Vec3& along_v, int w, const Vec3& along_w) const;
  void set_smooth_part();

  const SkinGeometry* skin_;
  const SkinCompliance* compliance_;
  const std::vector<double>* node_scale_;
  std::vector<int> row_of_;
  std::vector<int> vertex_;
  std::vector<Vec3> direction_;
  std::vector<int> local_node_;  // per node: place among the active ones, -1
  std::vector<int> active_;      // nodes
  Eigen::MatrixXf smooth_;       // R among the active nodes
  Eigen::MatrixXf matrix_;
};

}  // namespace palmar
