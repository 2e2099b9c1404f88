// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/skin_geometry.h"

namespace palmar {

/// The responses of one palmar region to forces on its own vertices (Xie 2014, eq. 3-11). Rows are
/// the region's vertices in ascending order, then the vertices around it within the growth distance
/// of its active region; columns are the region's vertices. Single precision: the relative rounding
/// of 6e-8 is far below every other error, and half the memory is half the time.
struct RegionResponse {
  std::vector<int> vertex;  ///< skin vertex of each row
  int columns = 0;          ///< the first `columns` rows are the region itself
  Eigen::MatrixXf bou;      ///< R_Bou, 1/mm; its upper square is symmetric
  Eigen::MatrixXf gau;      ///< R_Gau, no unit
};

struct PreparedHand::Impl {
  std::shared_ptr<const Hand> hand;
  ContactModel model;
  SkinGeometry skin;
  std::array<RegionResponse, kRegionCount>
      region;  ///< empty for the dorsum: see response_between()
  std::vector<int>
      row;  ///< per vertex: its row in its own region's responses; unused on the dorsum

  const RegionTissue& tissue(Region r) const {
    return hand->tissue.region[static_cast<std::size_t>(r)];
  }
};

/// The responses of skin outside the 19 regions, computed when it is touched: rows and columns are
/// any vertices, distances by arc_distance().
RegionResponse response_between(const PreparedHand::Impl& prepared, const RegionTissue& tissue,
                                const std::vector<int>& columns,
                                const std::vector<int>& further_rows);

}  // namespace palmar
