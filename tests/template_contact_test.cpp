// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>

#include "palmar/contact/press/press.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

/// Case G2: the middle fingertip on a plate at 30 degrees.
class TemplateFingertip : public TemplateTest {
 protected:
  static const contact::PreparedHand& prepared() {
    static const contact::PreparedHand made(std::make_shared<const hand::Hand>(hand()));
    return made;
  }
  static contact::PressOptions plate_at_30_degrees(std::vector<double> depths) {
    contact::PressOptions options;
    options.specimen.kind = contact::PressSpecimen::Kind::kHandRegion;
    options.specimen.region = hand::Region::kMiddleDistal;
    options.indenter.kind = contact::PressIndenter::Kind::kPlane;
    options.tilt = std::numbers::pi / 6.0;
    options.depths = std::move(depths);
    return options;
  }
};

TEST_F(TemplateFingertip, ForceLiesInTheBandOfTheThesis) {
  // A sphere of 7 mm with the moduli that Xie 2014 (section 3.4.1) fitted to four men: G0 = 5 kPa,
  // G_lim = 70 to 120 kPa at 4 mm, F = 16/3 G sqrt(R) d^1.5. Computed from the thesis' figures
  // (fingertip_thesis_envelope.csv); forces grow with the root of the radius.
  constexpr std::array<double, 8> depth = {0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0};  // mm
  constexpr std::array<double, 8> lower = {0.065, 0.3,   0.761, 1.497,
                                           2.545, 3.941, 5.717, 7.902};  // N
  constexpr std::array<double, 8> upper = {0.097, 0.476, 1.248, 2.494,
                                           4.288, 6.691, 9.759, 13.546};  // N
  const double width = hand::measure_hand(hand())
                           .segment[static_cast<std::size_t>(hand::Segment::kMiddleDistal)]
                           .width;
  const double scale = std::sqrt(0.5 * width / 7.0);
  const auto steps = contact::press(
      plate_at_30_degrees(std::vector<double>(depth.begin(), depth.end())), &prepared());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    // 25 % outside either edge: the band is one of spheres, a fingertip is none.
    EXPECT_GT(steps[i].force, 0.75 * scale * lower[i]) << depth[i] << " mm";
    EXPECT_LT(steps[i].force, 1.25 * scale * upper[i]) << depth[i] << " mm";
    if (i > 0) {
      EXPECT_GT(steps[i].area, steps[i - 1].area) << depth[i] << " mm";
    }
  }
}

TEST_F(TemplateFingertip, ForceGrowsFasterThanHertzAndEverFaster) {
  // Over doublings of the depth: over shorter steps the facets of the skin show.
  const auto steps = contact::press(plate_at_30_degrees({0.5, 1.0, 2.0, 4.0}), &prepared());
  double before = 1.5;  // Hertz; G grows with the depth
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const double exponent = std::log2(steps[i].force / steps[i - 1].force);
    EXPECT_GT(exponent, before) << "up to " << steps[i].depth << " mm";
    before = exponent;
  }
}

TEST_F(TemplateFingertip, AreaDoesNotDependOnTheShearModulus) {
  contact::PressOptions options = plate_at_30_degrees({1.0, 2.0, 4.0});
  options.shear_modulus = 0.02;
  const auto soft = contact::press(options, &prepared());
  options.shear_modulus = 0.10;
  const auto stiff = contact::press(options, &prepared());
  for (std::size_t i = 0; i < soft.size(); ++i) {
    EXPECT_NEAR(stiff[i].area, soft[i].area, 0.02 * soft[i].area);
    EXPECT_NEAR(stiff[i].force, 5.0 * soft[i].force, 1e-4 * stiff[i].force);
  }
}

}  // namespace
}  // namespace palmar::tests
