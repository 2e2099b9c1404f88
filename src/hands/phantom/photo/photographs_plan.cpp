// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hands/phantom/person/person_random.h"
#include "hands/phantom/photo/photographs.h"
#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"

namespace palmar::phantom {
namespace {

// Streams of the seed.
constexpr std::uint64_t kLenses = 1000, kShots = 2000, kMotions = 3000, kTilts = 4000,
                        kTerms = 5000;

/// One body of a make: focal lengths within 1 %, middles within 1 % of the picture.
capture::PhotoLens lens_of(const PhotographsOptions& options, int camera) {
  RandomStream random(options.seed, kLenses + static_cast<std::uint64_t>(camera));
  capture::PhotoLens lens;
  lens.width = options.width;
  lens.height = options.height;
  lens.focal_x = lens.focal_y = options.focal * options.height * (1.0 + 0.005 * random.normal());
  lens.centre_x = 0.5 * (options.width - 1) + 0.006 * options.height * random.normal();
  lens.centre_y = 0.5 * (options.height - 1) + 0.006 * options.height * random.normal();
  lens.k1 = -0.08 + 0.02 * random.normal();
  lens.k2 = 0.04 + 0.02 * random.normal();
  return lens;
}

Vec3 on_sphere(double radius, double azimuth, double elevation) {
  return radius * Vec3(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
}

}  // namespace

void PhotographsOptions::check() const {
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds) {
      throw UsageError(fmt::format("photographs {}: {:g}; {} is allowed", field, value, allowed));
    }
  };
  require(cameras >= 1 && cameras <= 64, "cameras", cameras, "1 to 64");
  require(positions >= 1 && positions <= 360, "positions", positions, "1 to 360");
  require(step > 0 && step <= 120, "step", step, "0 to 120 deg");
  require(width >= 64 && width <= 8192, "width", width, "64 to 8192 pixels");
  require(height >= 64 && height <= 8192, "height", height, "64 to 8192 pixels");
  require(focal >= 0.5 && focal <= 10, "focal", focal, "0.5 to 10 heights");
  require(distance >= 250 && distance <= 3000, "distance", distance, "250 to 3000 mm");
  require(low >= 0 && low <= 85, "low", low, "0 to 85 deg");
  require(high >= 0 && high <= 85, "high", high, "0 to 85 deg");
  require(middle >= 0 && middle <= 300, "middle", middle, "0 to 300 mm");
  require(texture >= 0 && texture <= 0.5, "texture", texture, "0 to 0.5");
  require(noise >= 0 && noise <= 50, "noise", noise, "0 to 50 of 255");
  require(blur >= 0 && blur <= 10, "blur", blur, "0 to 10 pixels");
  require(exposure >= 0 && exposure <= 0.5, "exposure", exposure, "0 to 0.5");
  require(aperture >= 0 && aperture <= 30, "aperture", aperture, "0 to 30 mm");
  require(std::abs(focus) <= 200, "focus", focus, "-200 to 200 mm");
  require(gloss >= 0 && gloss <= 1, "gloss", gloss, "0 to 1");
  require(decentring >= 0 && decentring <= 0.01, "decentring", decentring, "0 to 0.01");
  require(sixth >= 0 && sixth <= 1, "sixth", sixth, "0 to 1");
  require(vignetting >= 0 && vignetting <= 0.9, "vignetting", vignetting, "0 to 0.9");
  require(tone >= 0 && tone <= 1, "tone", tone, "0 to 1");
  require(motion >= 0 && motion <= 50, "motion", motion, "0 to 50 mm");
  require(motion_turn >= 0 && motion_turn <= 30, "motion_turn", motion_turn, "0 to 30 deg");
}

LensTerms lens_terms(const PhotographsOptions& options, int camera) {
  RandomStream random(options.seed, kTerms + static_cast<std::uint64_t>(camera));
  const double p1 = options.decentring * random.normal();
  const double p2 = options.decentring * random.normal();
  return {p1, p2, options.sixth * random.normal()};
}

Eigen::Vector2d bent(const LensTerms& terms, const Eigen::Vector2d& direction) {
  const double x = direction.x(), y = direction.y(), r2 = direction.squaredNorm();
  const double radial = 1.0 + terms.k3 * r2 * r2 * r2;
  return {radial * x + 2.0 * terms.p1 * x * y + terms.p2 * (r2 + 2.0 * x * x),
          radial * y + terms.p1 * (r2 + 2.0 * y * y) + 2.0 * terms.p2 * x * y};
}

PhotoShoot plan_photographs(const PhotographsOptions& options) {
  options.check();
  PhotoShoot shoot;
  for (int p = 0; p < options.positions; ++p) {
    for (int c = 0; c < options.cameras; ++c) {
      RandomStream random(options.seed,
                          kShots + static_cast<std::uint64_t>(p * options.cameras + c));
      const bool is_high = c % 2 == 1 && !options.one_ring;
      const double azimuth = (360.0 / options.cameras * c + options.step * p) * geometry::kDegree;
      const double elevation = (is_high ? options.high : options.low) * geometry::kDegree;
      const Vec3 target(0.0, 0.0, options.middle);
      // Stands are never quite where they should be.
      const Vec3 aim = target + normal_vector(random).cwiseProduct(Vec3(2.0, 2.0, 3.0));
      const double far = options.distance * (1.0 + 0.01 * random.normal());
      PhotoShot shot;
      shot.camera = c;
      shot.position = p;
      shot.pose.lens = lens_of(options, c);
      // One after the other, for all compilers.
      const double raised = 0.01 * random.normal(), shaken = 0.01 * random.normal();
      shot.pose.camera_from_world =
          capture::looking_at(target + on_sphere(far, azimuth + shaken, elevation + raised), aim);
      shot.gain = std::exp(options.exposure * random.normal());
      shoot.shots.push_back(shot);
    }
    geometry::Rigid3 motion;
    if (p > 0) {
      RandomStream random(options.seed, kMotions + static_cast<std::uint64_t>(p));
      const auto vector = [&] { return Vec3(normal_vector(random) / std::sqrt(3.0)); };
      const Vec3 turn = vector() * (options.motion_turn * geometry::kDegree);
      const Vec3 shift = vector() * options.motion;
      const Vec3 centre(0.0, 0.0, options.middle);
      if (turn.norm() > 0.0)
        motion = geometry::Rigid3::about_axis(turn.normalized(), centre, turn.norm());
      motion.translation += shift;
    }
    shoot.board_from_hand.push_back(motion);
  }
  return shoot;
}

std::vector<PhotoShot> plan_calibration(const PhotographsOptions& options, int count) {
  options.check();
  std::vector<PhotoShot> shots;
  for (int c = 0; c < options.cameras; ++c) {
    for (int n = 0; n < count; ++n) {
      RandomStream random(options.seed, kTilts + static_cast<std::uint64_t>(c) * 1000 +
                                            static_cast<std::uint64_t>(n));
      // All round, near and far, the board in another part of the picture each time.
      const double azimuth = 2.0 * std::numbers::pi * (n + 0.3 * random.uniform()) / count * 3.0;
      const double elevation = (40.0 + 45.0 * random.uniform()) * geometry::kDegree;
      const double far = options.distance * (0.8 + 0.6 * random.uniform());
      PhotoShot shot;
      shot.camera = c;
      shot.position = n;
      shot.pose.lens = lens_of(options, c);
      const double aside = random.uniform() - 0.5, across = random.uniform() - 0.5;
      const geometry::Rigid3 level = capture::looking_at(on_sphere(far, azimuth, elevation),
                                                         Vec3(80.0 * across, 80.0 * aside, 0.0));
      // Rolled as well.
      const double roll = (n % 2 == 0 ? 0.0 : 0.5 * std::numbers::pi) + 0.2 * random.normal();
      shot.pose.camera_from_world =
          geometry::Rigid3::about_axis(Vec3::UnitZ(), Vec3::Zero(), roll) * level;
      shot.gain = std::exp(options.exposure * random.normal());
      shots.push_back(shot);
    }
  }
  return shots;
}

}  // namespace palmar::phantom
