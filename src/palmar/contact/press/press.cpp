// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press/press.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>

#include "palmar/contact/press/half_space_press.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/tissue.h"

namespace palmar::contact {
namespace {

constexpr double kFinestPointSpacing = 0.8;  // mm
constexpr double kDeepest = 30.0;            // mm
constexpr double kForceTolerance = 1e-3;     // relative

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
  if (options.kernel == Kernel::kPoint && options.spacing < kFinestPointSpacing &&
      options.specimen.kind != PressSpecimen::Kind::kHandRegion) {
    std::ostringstream message;
    message << "press: with kernel \"point\" the response is no longer positive definite where "
               "vertices are closer than "
            << kFinestPointSpacing << " mm; the spacing is " << options.spacing << " mm";
    throw NumericalError(message.str());
  }
  if (options.kernel == Kernel::kPoint && (options.layer_thickness || options.coating)) {
    throw UsageError(
        "press: kernel \"point\" knows neither a layer over bone nor a coating; kernel \"patch\" "
        "is required");
  }
}

/// Depth at which the test gives a force; the search starts at `depth`. Force grows like a power of
/// the depth (1.5 for a sphere of fixed G), whose exponent the last two depths give; it stays
/// between the depths known to give too little and too much.
PressStep press_to_force(double force, double depth, double deepest,
                         const std::function<PressStep(double)>& press_at) {
  double lower = 0.0;
  double upper = std::numeric_limits<double>::infinity();
  double exponent = 1.5;
  PressStep last;
  PressStep step;
  for (int i = 0; i < 60; ++i) {
    step = press_at(depth);
    if (std::abs(step.force - force) <= kForceTolerance * force) return step;
    if (step.force < force && depth >= deepest) {
      std::ostringstream message;
      message << "press: " << force << " N is not reached within " << deepest
              << " mm (force there: " << step.force << " N)";
      throw NumericalError(message.str());
    }
    (step.force < force ? lower : upper) = depth;
    if (last.force > 0.0 && step.force > 0.0 && step.force != last.force) {
      const double slope = std::log(step.force / last.force) / std::log(step.depth / last.depth);
      exponent = std::clamp(slope, 0.5, 8.0);
    }
    double next = 2.0 * depth;
    if (step.force > 0.0) next = depth * std::pow(force / step.force, 1.0 / exponent);
    // Every fourth step halves what is left, should the power law not hold.
    const bool is_outside = !(next > lower && next < upper);
    if (upper < deepest && (is_outside || i % 4 == 3)) next = 0.5 * (lower + upper);
    next = std::clamp(next, 0.1 * depth, 5.0 * depth);
    last = step;
    depth = std::min(next, deepest);
  }
  std::ostringstream message;
  message << "press: " << force << " N is not met to 0.1 %: the force jumps from below to "
          << step.force << " N at " << step.depth << " mm";
  throw NumericalError(message.str());
}

}  // namespace

double deepest_press(const PressOptions& options) {
  switch (options.indenter.kind) {
    case PressIndenter::Kind::kSphere:
    case PressIndenter::Kind::kCylinder:
      return std::min(kDeepest, options.indenter.radius);
    default:
      return kDeepest;
  }
}

std::string name_of(const PressSpecimen& specimen) {
  switch (specimen.kind) {
    case PressSpecimen::Kind::kPlane:
      return "plane";
    case PressSpecimen::Kind::kEllipsoid: {
      std::ostringstream text;
      text << "ellipsoid:" << specimen.radius_x << ',' << specimen.radius_y;
      return text.str();
    }
    case PressSpecimen::Kind::kHandRegion:
      break;
  }
  return std::string(name_of(specimen.region));
}

std::string name_of(const PressIndenter& indenter) {
  std::ostringstream text;
  switch (indenter.kind) {
    case PressIndenter::Kind::kPlane:
      text << "plane";
      break;
    case PressIndenter::Kind::kSphere:
      text << "sphere:" << indenter.radius;
      break;
    case PressIndenter::Kind::kCylinder:
      text << "cylinder:" << indenter.radius;
      break;
    case PressIndenter::Kind::kPunch:
      text << "punch:" << indenter.radius;
      break;
    case PressIndenter::Kind::kTwoPunches:
      text << "punches:" << indenter.radius << ',' << indenter.distance;
      break;
  }
  return text.str();
}

PressOptions::PressOptions() : tissue(hand::finger_tissue()) {}

void PressOptions::check() const {
  if (depths.empty() == forces.empty()) {
    throw UsageError("press: either depths (mm) or forces (N) are required, not both");
  }
  if (indenter.kind != PressIndenter::Kind::kPlane) {
    require(is_between(indenter.radius, 0.1, 1000.0), "press: radius of the indenter",
            indenter.radius, "mm", "0.1 to 1000 mm");
  }
  for (const double d : depths) {
    require(d > 0.0 && d <= kDeepest, "press: depth", d, "mm", "more than 0 and at most 30 mm");
    require(d <= deepest_press(*this), "press: depth", d, "mm", "at most the indenter's radius");
  }
  for (const double f : forces) {
    require(f > 0.0 && f <= 1000.0, "press: force", f, "N", "more than 0 and at most 1000 N");
  }
  require(is_between(spacing, 0.05, 10.0), "press: spacing", spacing, "mm", "0.05 to 10 mm");
  require(is_between(std::abs(tilt), 0.0, std::numbers::pi / 3), "press: tilt",
          tilt * geometry::kDegreesPerRadian, "deg", "-60 to 60 deg");
  require(is_between(cell_area, 1e-3, 1000.0), "press: cell area", cell_area, "mm^2",
          "0.001 to 1000 mm^2");
  if (shear_modulus) {
    require(is_between(*shear_modulus, 1e-6, 1e6), "press: shear modulus", *shear_modulus, "MPa",
            "0.000001 to 1000000 MPa");
  }
  if (indenter.kind == PressIndenter::Kind::kTwoPunches) {
    require(is_between(indenter.distance, 2.0 * indenter.radius, 1000.0),
            "press: distance of the punches", indenter.distance, "mm",
            "at least their diameter and at most 1000 mm");
  }
  if (coating) {
    require(is_between(coating->thickness, 0.05, 1000.0), "press: thickness of the coating",
            coating->thickness, "mm", "0.05 to 1000 mm");
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

std::string_view name_of(hand::TissueLevel level) {
  if (level == hand::TissueLevel::kLow) return "low";
  return level == hand::TissueLevel::kHigh ? "high" : "nominal";
}

std::optional<hand::TissueLevel> tissue_level_named(std::string_view name) {
  for (const hand::TissueLevel level :
       {hand::TissueLevel::kLow, hand::TissueLevel::kNominal, hand::TissueLevel::kHigh}) {
    if (name_of(level) == name) return level;
  }
  return std::nullopt;
}

hand::Hand hand_at_tissue_level(hand::Hand hand, hand::TissueLevel level) {
  for (hand::RegionTissue& tissue : hand.tissue.region) {
    for (hand::TissueStiffness* stiffness : {&tissue.half_space, &tissue.layered}) {
      stiffness->nominal = hand::law_at(*stiffness, level);
    }
    tissue.on_bone.nominal = hand::law_at(tissue.on_bone, level);
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
  double start = std::min(0.25, deepest_press(options));
  for (const double force : options.forces) {
    steps.push_back(press_to_force(force, start, deepest_press(options), press_at));
    start = steps.back().depth;
  }
  return steps;
}

}  // namespace palmar::contact
