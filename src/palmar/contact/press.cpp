// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>

#include "palmar/contact/half_space_press.h"
#include "palmar/core/error.h"
#include "palmar/hand/tissue.h"

namespace palmar {
namespace {

constexpr double kDeepest = 30.0;         // mm
constexpr double kForceTolerance = 1e-3;  // relative

void require(bool holds, const std::string& name, double value, const std::string& unit,
             const std::string& allowed) {
  if (holds) return;
  std::ostringstream message;
  message << name << " is " << value << (unit.empty() ? "" : " ") << unit << "; " << allowed
          << " is required";
  throw UsageError(message.str());
}

bool is_between(double value, double lower, double upper) {
  return value >= lower && value <= upper;  // false for NaN
}

void check_tissue(const PressOptions& options) {
  if (options.layer_thickness) {
    require(is_between(*options.layer_thickness, 0.05, 1000.0), "press: thickness of the layer",
            *options.layer_thickness, "mm", "0.05 to 1000 mm");
  }
  if (options.poisson) {
    require(is_between(*options.poisson, 0.0, 0.5), "press: Poisson's ratio", *options.poisson, "",
            "0 to 0.5");
  }
  if (options.specimen.kind == PressSpecimen::Kind::kHandRegion) {
    if (!options.layer_thickness && !options.poisson) return;
    throw UsageError(
        "press: a hand has its own bones and tissue; thickness of a layer and Poisson's ratio are "
        "for a plane or ellipsoid (of a hand, take the tissue model \"layered\")");
  }
  if (options.kernel == Kernel::kPoint && (options.layer_thickness || options.coating)) {
    throw UsageError(
        "press: kernel \"point\" knows neither a layer over bone nor a coating; kernel \"patch\" "
        "is required");
  }
}

/// Depth at which the test gives a force. Between two depths the force grows like a power of the
/// depth (1.5 for a sphere of fixed G), so the next depth comes from the power through both ends.
PressStep press_to_force(double force, const std::function<PressStep(double)>& press_at) {
  double lower = 0.0;
  PressStep below;
  PressStep step = press_at(0.25);
  while (step.force < force) {
    below = step;
    lower = step.depth;
    const double upper = 2.0 * lower;
    if (upper > kDeepest) {
      std::ostringstream message;
      message << "press: " << force << " N is not reached within " << kDeepest << " mm (force at "
              << lower << " mm: " << step.force << " N)";
      throw NumericalError(message.str());
    }
    step = press_at(upper);
  }
  PressStep above = step;
  for (int i = 0; i < 40 && std::abs(step.force - force) > kForceTolerance * force; ++i) {
    const double width = above.depth - lower;
    double depth = 0.5 * (lower + above.depth);
    if (below.force > 0.0 && above.force > below.force && i % 3 != 2) {
      const double share = std::log(force / below.force) / std::log(above.force / below.force);
      depth = lower * std::pow(above.depth / lower, share);
    }
    depth = std::clamp(depth, lower + 1e-3 * width, above.depth - 1e-3 * width);
    step = press_at(depth);
    if (step.force < force) {
      below = step;
      lower = depth;
    } else {
      above = step;
    }
  }
  return step;
}

}  // namespace

PressOptions::PressOptions() : tissue(finger_tissue()) {}

void PressOptions::check() const {
  if (depths.empty() == forces.empty()) {
    throw UsageError("press: either depths (mm) or forces (N) are required, not both");
  }
  for (const double d : depths) {
    require(d > 0.0 && d <= kDeepest, "press: depth", d, "mm", "more than 0 and at most 30 mm");
    if (indenter.kind == PressIndenter::Kind::kSphere ||
        indenter.kind == PressIndenter::Kind::kCylinder) {
      require(d <= indenter.radius, "press: depth", d, "mm", "at most the indenter's radius");
    }
  }
  for (const double f : forces) {
    require(f > 0.0 && f <= 1000.0, "press: force", f, "N", "more than 0 and at most 1000 N");
  }
  require(is_between(spacing, 0.05, 10.0), "press: spacing", spacing, "mm", "0.05 to 10 mm");
  require(is_between(std::abs(tilt), 0.0, std::numbers::pi / 3), "press: tilt",
          tilt * 180.0 / std::numbers::pi, "deg", "-60 to 60 deg");
  require(is_between(cell_area, 1e-3, 1000.0), "press: cell area", cell_area, "mm^2",
          "0.001 to 1000 mm^2");
  if (shear_modulus) {
    require(is_between(*shear_modulus, 1e-6, 1e6), "press: shear modulus", *shear_modulus, "MPa",
            "0.000001 to 1000000 MPa");
  }
  if (indenter.kind != PressIndenter::Kind::kPlane) {
    require(is_between(indenter.radius, 0.1, 1000.0), "press: radius of the indenter",
            indenter.radius, "mm", "0.1 to 1000 mm");
  }
  if (indenter.kind == PressIndenter::Kind::kTwoPunches) {
    require(is_between(indenter.distance, 2.0 * indenter.radius, 1000.0),
            "press: distance of the punches", indenter.distance, "mm",
            "at least their diameter and at most 1000 mm");
  }
  if (coating) {
    require(is_between(coating->thickness, 0.01, 1000.0), "press: thickness of the coating",
            coating->thickness, "mm", "0.01 to 1000 mm");
    require(is_between(coating->shear_modulus, 1e-6, 1e6), "press: shear modulus of the coating",
            coating->shear_modulus, "MPa", "0.000001 to 1000000 MPa");
    require(is_between(coating->poisson, 0.0, 0.5), "press: Poisson's ratio of the coating",
            coating->poisson, "", "0 to 0.5");
  }
  check_tissue(*this);
  if (specimen.kind == PressSpecimen::Kind::kEllipsoid) {
    require(is_between(specimen.radius_x, 0.1, 1000.0), "press: radius x of the ellipsoid",
            specimen.radius_x, "mm", "0.1 to 1000 mm");
    require(is_between(specimen.radius_y, 0.1, 1000.0), "press: radius y of the ellipsoid",
            specimen.radius_y, "mm", "0.1 to 1000 mm");
  }
  if (specimen.kind == PressSpecimen::Kind::kPlane) {
    if (indenter.kind == PressIndenter::Kind::kPlane) {
      throw UsageError(
          "press: a plane on a plane touches without end; press an ellipsoid or a hand, "
          "or use a sphere or a punch");
    }
    if (indenter.kind == PressIndenter::Kind::kCylinder) {
      throw UsageError(
          "press: a cylinder on a plane touches along a line without end; press an "
          "ellipsoid or a hand, or use a sphere or a punch");
    }
  }
}

Hand hand_at_tissue_level(Hand hand, TissueLevel level) {
  for (RegionTissue& tissue : hand.tissue.region) {
    for (TissueStiffness* stiffness : {&tissue.half_space, &tissue.layered}) {
      stiffness->nominal = law_at(*stiffness, level);
    }
  }
  return hand;
}

std::vector<PressStep> press(const PressOptions& options, const PreparedHand* hand) {
  options.check();
  std::function<PressStep(double)> press_at;
  if (options.specimen.kind == PressSpecimen::Kind::kHandRegion) {
    if (hand == nullptr) {
      throw UsageError("press: region " + std::string(name_of(options.specimen.region)) +
                       " needs a hand");
    }
    press_at = [&](double depth) { return press_hand_region(options, *hand, depth); };
  } else {
    press_at = [&](double depth) { return press_half_space(options, depth); };
  }
  std::vector<PressStep> steps;
  for (const double depth : options.depths) steps.push_back(press_at(depth));
  for (const double force : options.forces) steps.push_back(press_to_force(force, press_at));
  return steps;
}

}  // namespace palmar
