// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Case G2: the middle fingertip on a plate.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "palmar/contact/press/press.h"
#include "palmar/core/enum_index.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/validation/validation_cases.h"

namespace palmar::validation {
namespace {

contact::PressOptions plate(std::vector<double> depths) {
  contact::PressOptions options;
  options.specimen.kind = contact::PressSpecimen::Kind::kHandRegion;
  options.specimen.region = hand::Region::kMiddleDistal;
  options.indenter.kind = contact::PressIndenter::Kind::kPlane;
  options.tilt = std::numbers::pi / 6.0;
  options.depths = std::move(depths);
  return options;
}

constexpr std::array<double, 8> kDepth = {0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0};  // mm
// reference/validation/fingertip_thesis_envelope.csv at a radius of 7 mm: Hertz' sphere with the
// moduli of four men, G0 = 5 kPa, G_lim = 70 and 120 kPa at 4 mm (Xie 2014, section 3.4.1), N.
constexpr std::array<double, 8> kLow = {0.065, 0.3, 0.761, 1.497, 2.545, 3.941, 5.717, 7.902};
constexpr std::array<double, 8> kHigh = {0.097, 0.476, 1.248, 2.494, 4.288, 6.691, 9.759, 13.546};

constexpr const char* kOnBone = "c98ee62";  // the commit with this law and its moduli
constexpr const char* kBand = "Xie 2014, four men, sphere of half the tip's width; 25 % outside";

std::string text(double depth) { return std::to_string(depth).substr(0, 3) + " mm"; }

// Pawluk and Howe 1999 measured a paraboloid (2.0) from 0 to 2 N; the pressure's tolerance is ours.
constexpr double kPeakTolerance = 0.10;
constexpr double kMeasuredDepth = 2.0;  // mm, at which about 2 N are reached

double peak_over_mean(const contact::PressStep& step) {
  return step.peak_pressure / step.mean_pressure;
}

void add_force(ValidationRows& rows, const std::vector<contact::PressStep>& steps, double scale) {
  for (std::size_t i = 0; i < kDepth.size(); ++i) {
    rows.push_back(judge("half-space, force at " + text(kDepth[i]), "N", steps[i].force,
                         between(0.75 * scale * kLow[i], 1.25 * scale * kHigh[i], kBand)));
  }
  // Over doublings of the depth: over shorter steps the facets of the skin show.
  const auto exponent = [&](std::size_t i, std::size_t j) {
    return std::log(steps[j].force / steps[i].force) / std::log(kDepth[j] / kDepth[i]);
  };
  const double first = exponent(0, 1), second = exponent(1, 3), third = exponent(3, 7);
  const std::string law = "force of fingertips rises ever faster (Pawluk and Howe 1999)";
  rows.push_back(judge("half-space, dlogF/dlogd, 0.5 to 1 mm", "", first, at_least(1.5, law)));
  rows.push_back(judge("half-space, dlogF/dlogd, 1 to 2 mm", "", second, at_least(first, law)));
  rows.push_back(judge("half-space, dlogF/dlogd, 2 to 4 mm", "", third, at_least(second, law)));
  double growth = steps[0].area;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    growth = std::min(growth, steps[i].area - steps[i - 1].area);
  }
  rows.push_back(judge("half-space, least growth of the area per 0.5 mm", "mm2", growth,
                       at_least(0.0, "area grows with depth")));
}

}  // namespace

ValidationRows validate_fingertip(ValidationBench& bench) {
  ValidationRows rows;
  const hand::HandDimensions size = hand::measure_hand(bench.hand());
  const double radius = 0.5 * size.segment[index_of(hand::Segment::kMiddleDistal)].width;
  const double scale = std::sqrt(radius / 7.0);
  const contact::PreparedHand& half_space = bench.prepared(contact::ContactModel{});
  const auto steps = contact::press(plate({kDepth.begin(), kDepth.end()}), &half_space);
  add_force(rows, steps, scale);

  contact::PressOptions options = plate({1.0, 2.0, 4.0});
  options.shear_modulus = 0.02;
  const auto soft = contact::press(options, &half_space);
  options.shear_modulus = 0.10;
  const auto stiff = contact::press(options, &half_space);
  double ratio = 1.0;
  for (std::size_t i = 0; i < soft.size(); ++i) {
    const double r = stiff[i].area / soft[i].area;
    if (!(std::abs(r - 1.0) <= std::abs(ratio - 1.0))) ratio = r;
  }
  rows.push_back(judge("half-space, area at G = 100 kPa / at 20 kPa, worst of 1, 2, 4 mm", "",
                       ratio, near_value(1.0, 0.02, "linear elasticity")));

  bench.update(0.5, "case G2, layered");
  const contact::PreparedHand& layer = bench.prepared(layered_model());
  const auto layered = contact::press(plate({kDepth.begin(), kDepth.end()}), &layer);
  bench.update(0.7, "case G2, tissue on bone");
  const contact::PreparedHand& bone = bench.prepared(contact::palmar_model());
  const auto on_bone = contact::press(plate({kDepth.begin(), kDepth.end()}), &bone);
  const std::string shape = "Pawluk and Howe 1999, measured on people: paraboloid, 0 to 2 N";
  const auto near_paraboloid = [&](double depth) {
    return depth <= kMeasuredDepth ? near_value(2.0, kPeakTolerance, shape)
                                   : information(2.0, shape + "; this is beyond 2 N");
  };
  for (const std::size_t i : {1U, 3U, 5U, 7U}) {
    const std::string at = text(kDepth[i]);
    rows.push_back(judge("half-space, peak / mean at " + at, "", peak_over_mean(steps[i]),
                         near_paraboloid(kDepth[i])));
    rows.push_back(judge("layered, peak / mean at " + at, "", peak_over_mean(layered[i]),
                         near_paraboloid(kDepth[i])));
    set_history(rows, "dc20bd8");
    rows.push_back(judge("layered, force at " + at, "N", layered[i].force,
                         between(0.75 * scale * kLow[i], 1.25 * scale * kHigh[i], kBand)));
    // The modulus of layered skin is fitted to this band.
    set_history(rows, "dc20bd8", "a26ebfc");
    rows.push_back(judge("bone, peak / mean at " + at, "", peak_over_mean(on_bone[i]),
                         near_paraboloid(kDepth[i])));
    set_history(rows, kOnBone);
    rows.push_back(judge("bone, force at " + at, "N", on_bone[i].force,
                         between(0.75 * scale * kLow[i], 1.25 * scale * kHigh[i], kBand)));
    // So is that of tissue on bone.
    set_history(rows, kOnBone, kOnBone);
  }
  for (const auto& [model, name] :
       {std::pair{&half_space, "half-space"}, {&layer, "layered"}, {&bone, "bone"}}) {
    contact::PressOptions force = plate({});
    force.forces = {2.0};
    const contact::PressStep step = contact::press(force, model).front();
    rows.push_back(judge(std::string(name) + ", peak / mean at 2 N", "", peak_over_mean(step),
                         near_value(2.0, kPeakTolerance, shape)));
    set_history(rows, model == &bone ? kOnBone : "dc20bd8");
  }
  return rows;
}

}  // namespace palmar::validation
