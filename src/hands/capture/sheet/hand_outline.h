// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hands/capture/sheet/sheet_grid.h"
#include "hands/imaging/distance_transform.h"

namespace palmar::capture {

struct HandOutlineOptions {
  double wrist = 0.0;    ///< how far inside the sheet's edge the wrist crease lies, mm
  bool palm_up = false;  ///< the palm looks at the camera
  void check() const;    ///< throws UsageError: field, value, allowed range
};

/// One finger of an outline; mm, seen from above, heights taken into account.
struct OutlineFinger {
  Eigen::Vector2d tip = Eigen::Vector2d::Zero();         ///< sheet's frame
  Eigen::Vector2d base = Eigen::Vector2d::Zero();        ///< middle of the base crease, between the
                                                         ///< webs; of the thumb beside its web
  Eigen::Vector2d direction = Eigen::Vector2d::UnitY();  ///< unit, of the middle line as it is seen
  /// Tip and base where the picture shows them on the sheet: heights not taken into account.
  Eigen::Vector2d seen_tip = Eigen::Vector2d::Zero(), seen_base = Eigen::Vector2d::Zero();
  double length = 0.0;  ///< base to tip
  std::array<double, 3>
      width{};  ///< half way along the proximal, middle, distal segment, whose
                ///< lengths are in the shares given; thumb: 0, it lies on its side
};

/// What the outline of a hand lying on a sheet shows.
struct HandOutline {
  bool is_right = true;
  double hand_length = 0.0;  ///< middle of the wrist to the middle finger's tip, mm
  double hand_width =
      0.0;  ///< over the heads of metacarpals II and V; 0: the thumb lies in the way
  std::array<OutlineFinger, 5> finger;  ///< thumb to little
  std::array<Eigen::Vector2d, 4> web{}, seen_web{};
  Eigen::Vector2d wrist = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> contour;  ///< on the sheet as it is seen, from one side of the
                                         ///< forearm to the other; the thumb first
};

/// Proportions that an outline doesn't show, of the hand that others are compared with.
struct OutlineProportions {
  /// Lengths of a finger's segments as shares of it, proximal first; of the thumb the lengths of
  /// two over the hand length.
  std::array<std::array<double, 3>, 5> segment{};
  std::array<double, 5> finger_height{};  ///< half of the distal thickness over the hand length
  double web_height = 0.0;                ///< half of the proximal thickness over the hand length
  double palm_height = 0.0;               ///< half of the palm's thickness over the hand length
};

/// Cells of drawings, mm.
inline constexpr double kOutlineCell = 0.35;

/// Measures a hand whose skin on the sheet or table is known: tips and webs are the outline's
/// extremes from the palm's middle; the forearm crosses one edge of the grid, which lies under the
/// crease of the wrist. Throws InputError `name`: fingers that aren't apart, a hand that reaches
/// beyond the grid, no forearm over an edge.
HandOutline measure_outline(const SheetGrid& grid, const imaging::VoxelMask& mask,
                            const SheetView& sheet, const OutlineProportions& proportions,
                            const std::string& name, const HandOutlineOptions& options = {});

}  // namespace palmar::capture
