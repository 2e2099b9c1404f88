// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/contact/contact.h"

namespace palmar {

/// What is pressed.
struct PressSpecimen {
  enum class Kind {
    kPlane,      ///< flat half-space
    kEllipsoid,  ///< half-space with the curvatures of an ellipsoid
    kHandRegion  ///< skin of one region of a hand in its reference posture
  };
  Kind kind = Kind::kPlane;
  double radius_x = 10.0;  ///< ellipsoid: radius of curvature at the apex along x, mm
  double radius_y = 10.0;  ///< ellipsoid: along y, mm
  Region region = Region::kMiddleDistal;  ///< hand region
};

/// The rigid body that presses.
struct PressIndenter {
  enum class Kind {
    kSphere,
    kPunch,    ///< flat circular end, sharp edge
    kPlane,    ///< plate
    kCylinder  ///< axis along y (on a hand: across the finger)
  };
  Kind kind = Kind::kSphere;
  double radius = 5.0;  ///< of sphere, punch or cylinder, mm
};

struct PressOptions {
  PressSpecimen specimen;
  PressIndenter indenter;
  std::vector<double> depths;  ///< mm from first touch; either depths or forces
  std::vector<double> forces;  ///< N; the depth is found
  double tilt = 0.0;           ///< of the indenter, rad, about y; on a hand towards the fingertip
  double spacing = 1.25;       ///< mm between vertices of a plane or ellipsoid; a hand has its own
  std::optional<double> shear_modulus;  ///< MPa; else G(d) of the tissue
  RegionTissue tissue;                  ///< of a plane or ellipsoid; default that of a finger
  Kernel kernel = Kernel::kPatch;
  double cell_area = 24.0;                ///< mm^2
  std::optional<double> layer_thickness;  ///< mm; not available yet: check() refuses it
  PressOptions();
  void check() const;  ///< throws UsageError: field, value, allowed range
};

struct PressStep {
  double depth = 0.0;                  ///< mm
  double force = 0.0;                  ///< N, along the press
  double area = 0.0;                   ///< mm^2
  double peak_pressure = 0.0;          ///< largest vertex pressure, MPa
  double peak_pressure_cells = 0.0;    ///< largest mean over a sensor cell, MPa
  double mean_pressure = 0.0;          ///< MPa
  double shear_modulus = 0.0;          ///< MPa
  double complementarity_error = 0.0;  ///< max |s_i p_i|, N mm, recomputed
  double relative_residual = 0.0;      ///< see ContactSolution; 0 on a hand
};

/// The indentation test of a laboratory.
///
/// Plane and ellipsoid: a half-space on a triangular lattice. Gaps are those of small strain (Hertz
/// 1882; Johnson 1985, section 4.1), measured along the press in the common tangent plane at first
/// touch, d = x^2 / 2 R_x + y^2 / 2 R_y - depth with 1 / R = 1 / R_specimen + 1 / R_indenter. The
/// true distance to a sphere, measured radially, would be that of a sphere smaller by the depth
/// (5 % less force at a depth of a tenth of the radius) and the true height 1 % less; neither is
/// better than the half-space itself at such depths. The ellipsoid has semi-axes sqrt(R_x c),
/// sqrt(R_y c) and c = sqrt(R_x R_y) along the press; a plate or cylinder tilted about y touches it
/// where its normal is tilted, with the curvatures there.
/// `spacing` is that of the lattice under the middle of the contact; with Kernel::kPatch cells at
/// the edge of the contact, and all of them if fewer than 40 penetrate, are split until they are a
/// tenth of its radius (a twentieth under a punch), and cells under the edge of a punch are cut by
/// it. Kernel::kPoint keeps the lattice as it is.
///
/// Hand region: the skin as in solve_hand_contact(), pressed against the region's mean outward
/// normal; only that region can touch.
///
/// A force is met to 0.1 %. Throws UsageError on bad options, on a
/// contact without end (plane on plane, cylinder on plane), or for a hand region without a hand;
/// NumericalError if the contact has no solution or a force isn't reached within 30 mm.
std::vector<PressStep> press(const PressOptions& options, const PreparedHand* hand = nullptr);

}  // namespace palmar
