// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/redesign/handle_features.h"

namespace palmar::redesign {

/// Over which the features begin beside what is kept, mm; our choice.
inline constexpr double kShapeBlend = 14.0;

/// The outlines of a handle across its length, by polar radius about its centre line.
struct HandleOutlines {
  std::vector<double> z;                    ///< ascending, evenly, mm
  int columns = 0;                          ///< directions, evenly from +x counter-clockwise
  std::vector<std::vector<double>> radius;  ///< by z and direction, mm
  /// Between the sections and directions; the first or last section beyond them.
  double at(double z, double phi) const;
};

/// The part of a product that is held, as something to shape anew: a frame whose z runs along it,
/// the planes of constant z in which its sections are taken, and what it is like now.
///
/// Where the product is that part alone and ends in two flat parallel faces (a bar, a pistol grip),
/// sections are parallel to these, however the handle leans, and the shape goes from end to end.
/// Everywhere else they are across the part's centre line, and the shape runs into the product
/// over `run_out` at both ends.
struct HandleBody {
  geometry::Rigid3 product_from_handle;  ///< z towards the thumb's side, y towards the palm
  double bottom = 0.0, top = 0.0;        ///< z of the ends of what is shaped anew, mm
  bool is_whole = false;                 ///< it is all of the product, with flat ends
  double end_radius = 0.0;  ///< of the edges round flat ends, the larger; about, mm; 0: sharp
  double run_out = 0.0;     ///< mm; 0 at flat ends
  std::array<bool, 2> is_free = {true, true};  ///< nothing goes on beyond the bottom, the top
  std::array<double, 2> gripped = {0.0, 0.0};  ///< z between which hands press (handle_ends.h), mm
  /// Centre line (x, y) = c0 + c1 z + c2 z^2, mm.
  std::array<Eigen::Vector2d, 3> centre{};
  HandleOutlines outlines;  ///< now
  /// What is empty inside, as far out as it goes: radius 0 where nothing is. No rows if the handle
  /// is solid all along.
  HandleOutlines hollow = {};
  HandleHands hands;

  Eigen::Vector2d centre_at(double z) const;
};

/// Where a hand presses: product frame, mm, MPa.
struct HandPressure {
  Vec3 at = Vec3::Zero();
  double pressure = 0.0;
};

/// How hands lie on a product: means over them, product frame.
struct HandsOnHandle {
  Vec3 place = Vec3::Zero();        ///< middle of the hand, mm
  Vec3 thumb_side = Vec3::UnitZ();  ///< unit, along the handle
  Vec3 palm = Vec3::UnitY();        ///< unit, from the handle towards the palm
  Vec3 thumb = Vec3::Zero();        ///< where the thumb presses, mm
  double breadth = 80.0;            ///< of the four fingers, mm
  std::vector<std::vector<HandPressure>> pressures = {};  ///< by hand; may be empty
  double spread = 0.0;  ///< mm; how far along the handle hands lie from there
};

struct MeasureHandleOptions {
  /// Of a part of a product only the gripped length is shaped, and 7 mm more: where its ends are
  /// something else (kept_lengths()) they are left to the product. With this they are not.
  bool takes_all = false;
  bool smooths_scans = true;  ///< outlines of parts of a mesh, as smoothed() (handle_ends.h)
};
/// Throws UsageError naming the product if the part can't be shaped: no bar, a ring, bent by more
/// than its own thickness, or with sections that aren't seen whole from the centre line.
HandleBody measure_handle(const product::Product& product, const product::ProductPart& part,
                          const HandsOnHandle& hands, const MeasureHandleOptions& options = {});

/// The features that come nearest to what the handle is now, where they are wholly there: outside
/// of `kept_ends` (HandleShape) and of what runs out. Half axes by extents (of a section that fills
/// less than an ellipse, a fluted one, by area), taper by mean radii, squareness by area, turn by
/// principal axes; all swells 0. Root mean square of the distance to the outlines beside it, mm.
struct FittedFeatures {
  HandleFeatures features;
  double rms = 0.0;
};
FittedFeatures fit_features(const HandleBody& body,
                            const std::array<double, 2>& kept_ends = {0.0, 0.0});

}  // namespace palmar::redesign
