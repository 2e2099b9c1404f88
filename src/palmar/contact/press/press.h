// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// What is pressed.
struct PressSpecimen {
  enum class Kind {
    kPlane,      ///< flat half-space or layer
    kEllipsoid,  ///< the same with the curvatures of an ellipsoid
    kHandRegion  ///< skin of one region of a hand in its reference posture
  };
  Kind kind = Kind::kPlane;
  double radius_x = 10.0;  ///< ellipsoid: radius of curvature at the apex along x, mm
  double radius_y = 10.0;  ///< ellipsoid: along y, mm
  hand::Region region = hand::Region::kMiddleDistal;  ///< hand region
};

/// The rigid body that presses.
struct PressIndenter {
  enum class Kind {
    kSphere,
    kPunch,       ///< flat circular end, sharp edge
    kTwoPunches,  ///< two such in one holder, side by side along x (on a hand: along the finger)
    kPlane,       ///< plate
    kCylinder     ///< axis along y (on a hand: across the finger)
  };
  Kind kind = Kind::kSphere;
  double radius = 5.0;     ///< of sphere, cylinder or each punch, mm
  double distance = 20.0;  ///< between the axes of two punches, mm
};

/// As on the command line: "plane", "ellipsoid:8,12", "middle_distal"; "sphere:5", "punches:2,10".
std::string name_of(const PressSpecimen& specimen);
std::string name_of(const PressIndenter& indenter);

struct PressOptions {
  PressSpecimen specimen;
  PressIndenter indenter;
  std::optional<Coating> coating;  ///< of the indenter, all over; none: rigid
  std::vector<double> depths;      ///< mm from first touch; either depths or forces
  std::vector<double> forces;      ///< N; the depth is found
  double tilt = 0.0;        ///< of the indenter, rad, about y; on a hand towards the fingertip
  double spacing = 1.25;    ///< mm between vertices of a plane or ellipsoid; a hand has its own
  double cell_area = 24.0;  ///< mm^2
  std::optional<double> shear_modulus;  ///< MPa; else G(d) of the tissue
  // Of a plane or ellipsoid; a hand has its own tissue and its PreparedHand its own equations.
  hand::RegionTissue tissue;  ///< default: that of a finger
  hand::TissueLevel tissue_level = hand::TissueLevel::kNominal;
  Kernel kernel = Kernel::kPatch;
  std::optional<double> layer_thickness;  ///< mm; bonded to rigid bone. None: a half-space
  std::optional<double> poisson;          ///< none: 0.5; of a layer that of the tissue
  PressOptions();
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Depth that no test goes beyond, mm: the radius of a sphere or cylinder, 30 mm at most.
double deepest_press(const PressOptions& options);

struct PressStep {
  double depth = 0.0;                  ///< mm
  double force = 0.0;                  ///< N, along the press
  double area = 0.0;                   ///< mm^2
  double peak_pressure = 0.0;          ///< largest vertex pressure, MPa
  double peak_pressure_cells = 0.0;    ///< largest mean over a sensor cell, MPa
  double mean_pressure = 0.0;          ///< MPa
  double shear_modulus = 0.0;          ///< MPa
  double complementarity_error = 0.0;  ///< max |s_i p_i|, N mm, recomputed
  /// max |min(s_i / max|d|, p_i / max|p|)|, recomputed; on a hand max |s_i p_i| / (depth max|p|)
  double relative_residual = 0.0;
  int vertices = 0;      ///< that could touch
  double spacing = 0.0;  ///< of the lattice that ran, mm; 0 on a hand
};

/// The indentation test of a laboratory.
///
/// Plane and ellipsoid: a half-space, or with layer_thickness a layer bonded to rigid bone
/// (layered_response.h), on a triangular lattice. Gaps are those of small strain (Hertz 1882;
/// Johnson 1985, section 4.1), measured along the press in the common tangent plane at first touch,
/// d = x^2 / 2 R_x + y^2 / 2 R_y - depth with 1 / R = 1 / R_specimen + 1 / R_indenter. The true
/// distance to a sphere, measured radially, would be that of a sphere smaller by the depth (5 %
/// less force at a depth of a tenth of the radius) and the true height 1 % less; neither is better
/// than the half-space itself at such depths. The ellipsoid has semi-axes sqrt(R_x c), sqrt(R_y c)
/// and c = sqrt(R_x R_y) along the press; a plate or cylinder tilted about y touches it where its
/// normal is tilted, with the curvatures there.
///
/// `spacing` is that of the lattice under the middle of the contact; with Kernel::kPatch it is
/// doubled while more than 1200 vertices penetrate, cells at the edge of the contact, and all of
/// them if fewer than 40 penetrate, are split until they are a tenth of its radius (a twentieth
/// under a punch), and cells under the edge of a punch are cut by it. Kernel::kPoint keeps the
/// lattice as it is, and knows neither layer nor coating.
///
/// A coated indenter gives way in series with the skin: its response is that of a layer bonded to
/// the rigid core, its curvature left out (good while the contact is small against the radius).
///
/// Hand region: the skin as in solve_hand_contact(), pressed against the region's mean outward
/// normal; only that region can touch. Gaps are measured along the press here too.
///
/// A force is met to 0.1 %. Throws UsageError on bad options, on a
/// contact without end (plane on plane, cylinder on plane), or for a hand region without a hand;
/// NumericalError if the contact has no solution or a force isn't reached within 30 mm.
std::vector<PressStep> press(const PressOptions& options, const PreparedHand* hand = nullptr);

/// Which tissue a specimen has: "low", "nominal", "high".
std::string_view name_of(hand::TissueLevel level);
std::optional<hand::TissueLevel> tissue_level_named(std::string_view name);

/// The hand with the low or high tissue of every region in place of the nominal one.
hand::Hand hand_at_tissue_level(hand::Hand hand, hand::TissueLevel level);

}  // namespace palmar::contact
