// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/redesign/contact_region.h"

namespace palmar::redesign {

/// A line of an unrolled surface: x round the section, y along the axis, mm.
struct UnrolledLine {
  std::string name;  ///< of the region it belongs to
  std::vector<Eigen::Vector2d> points;
  bool is_closed = false;  ///< else the sheet's cut goes through it
};

/// The side of a cylinder or prism as a flat sheet of true lengths.
struct UnrolledOutline {
  double width = 0.0;               ///< mm round the section
  double low = 0.0, high = 0.0;     ///< mm; ends of the product along the axis
  double section_change = 0.0;      ///< mm; how far sections differ from each other
  std::vector<UnrolledLine> lines;  ///< outlines
  std::vector<double> edges;        ///< x where a flat side of the section begins or ends
  Vec3 axis = Vec3::UnitZ();        ///< y of the sheet, product frame
  Vec3 cut = Vec3::Zero();          ///< a point on the sheet's cut (x = 0 and x = width), mm
};

/// Unrolls the outlines of regions by arc length round the section, seen from outside with the axis
/// upwards, so that x grows against the clock seen from the axis' tip. The sheet is cut where the
/// outlines leave the widest gap. `axis`: unit; unset: the longest extent.
///
/// Only a surface whose sections are alike over the length of the outlines, to 0.1 mm, can be
/// unrolled true: UsageError naming the difference otherwise, or if an outline leaves the side
/// (over an end face), or if there is none.
UnrolledOutline unroll(const geometry::TriangleMesh& product,
                       const std::vector<ContactRegion>& regions, std::optional<Vec3> axis = {});

}  // namespace palmar::redesign
