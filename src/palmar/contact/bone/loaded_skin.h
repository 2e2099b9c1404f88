// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/response/skin_response.h"
#include "palmar/contact/response/sparse_rows.h"

namespace palmar::contact {

/// The compliance of a skin on bone among some vertices, each with the direction in which it is
/// pressed: entries m_i . C_ij m_j. Skin without tissue elements (the back of the hand) has the
/// normal response of a half-space among itself in every direction, r_ij m_i . m_j, and none with
/// the rest: pressed aslant it gives way as it does straight. Keeps its memory.
/// What is pointed to, skin and compliance must outlive it.
class LoadedSkin {
 public:
  /// `scale`: `compliance` is that of a hand 1 / scale as large, per skin vertex: entries are
  /// divided by sqrt(s_i s_j). Exact for a hand scaled as a whole; symmetric, and as definite as
  /// the compliance itself. Empty: of the hand itself. `half_space` is needed where skin without
  /// tissue elements is loaded.
  LoadedSkin(const SkinGeometry& skin, const SkinCompliance& compliance,
             const SkinResponse* half_space, const std::vector<double>& scale);

  /// Vertices ascending; directions [unit] in the frame of the compliance (hand, reference
  /// posture).
  void set(const std::vector<int>& vertices, const std::vector<Vec3>& directions);
  const std::vector<int>& vertices() const { return vertex_; }  ///< as they were set
  /// Symmetric, 1/mm.
  const SparseRows& responses() const { return responses_; }

  /// Displacement times modulus [N/mm] of other vertices along their directions under forces [N] on
  /// the vertices that were set.
  std::vector<double> displacement(const std::vector<double>& force, const std::vector<int>& at,
                                   const std::vector<Vec3>& along) const;
  /// The same as vectors, in the frame of the compliance; of skin without tissue elements zero.
  std::vector<Vec3> motion(const std::vector<double>& force, const std::vector<int>& at) const;

  /// How directions turn: per vertex that was set (column, change of its direction per unit).
  using Turns = std::vector<std::vector<std::pair<int, Vec3>>>;
  /// What that adds to the displacements times modulus of the same vertices along their directions
  /// at forces held [N/mm per unit]: sum over j of f_j d(m_i . C_ij m_j), a row per vertex.
  /// Directions of skin without tissue elements are held.
  Eigen::MatrixXd turned(const std::vector<double>& force, const Turns& turns, int columns) const;

 private:
  std::vector<Eigen::Vector3f> moved_rows(const std::vector<double>& force,
                                          const std::vector<int>& at) const;

  const SkinCompliance* compliance_;
  const SkinResponse* half_space_;
  std::vector<float> root_scale_;  // 1 / sqrt(s) per skin vertex
  std::vector<int> row_of_;        // per skin vertex, in the compliance; -1 for none
  std::vector<int> local_;         // per skin vertex, in vertex_; -1 for none
  std::vector<int> local_of_row_;  // the same per row of the compliance
  std::vector<int> vertex_;
  std::vector<Eigen::Vector3f> direction_;
  std::vector<Eigen::Vector3f> scaled_;  // directions times root_scale_
  SparseRows lower_, responses_;
  std::vector<std::size_t> count_, next_;
  std::vector<std::pair<int, int>> met_;  // of a row: place in vertex_, entry
};

}  // namespace palmar::contact
