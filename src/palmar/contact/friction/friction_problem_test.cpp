// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/friction/friction_problem.h"
#include "palmar/contact/response/tangential_response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/response/response.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::contact {
namespace {

TEST(TangentialResponse, DirectedPartIsTheIntegralOverTheDisc) {
  // cos(2 phi) / (4 pi s) averaged over a disc of radius 1 in polar rings about its centre.
  const auto by_quadrature = [](double r) {
    constexpr int kRings = 800, kAngles = 800;
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
      const double rho = (i + 0.5) / kRings;
      for (int k = 0; k < kAngles; ++k) {
        const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kAngles;
        const double x = rho * std::cos(angle) - r, y = rho * std::sin(angle);
        const double s2 = x * x + y * y;
        sum += rho * (x * x - y * y) / (s2 * std::sqrt(s2));
      }
    }
    return sum * (2.0 * std::numbers::pi / kAngles / kRings) /
           (4.0 * std::numbers::pi * std::numbers::pi);
  };
  for (const double r : {0.3, 0.7, 0.95, 1.05, 1.5, 3.0, 8.0}) {
    EXPECT_NEAR(directed_disc_response(r, 1.0) * 4.0 * std::numbers::pi,
                by_quadrature(r) * 4.0 * std::numbers::pi, 4e-3)
        << r;
  }
  EXPECT_EQ(directed_disc_response(0.0, 2.0), 0.0);
  EXPECT_NEAR(directed_disc_response(300.0, 1.0), 1.0 / (4.0 * std::numbers::pi * 300.0), 1e-8);
  EXPECT_DOUBLE_EQ(directed_disc_response(1.4, 0.5), directed_disc_response(2.8, 1.0) * 2.0);
}

TEST(TangentialResponse, FarAwayIsCerruti) {
  const Eigen::Matrix3d far = tangential_response(Vec3(30, 40, 0), 0.5, 0.7);
  const double unit = 1.0 / (4.0 * std::numbers::pi * 50.0);
  EXPECT_NEAR(far(0, 0), unit * 1.36, 1e-4 * unit);
  EXPECT_NEAR(far(1, 1), unit * 1.64, 1e-4 * unit);
  EXPECT_NEAR(far(0, 1), unit * 0.48, 1e-4 * unit);
  // Under the middle of an evenly rubbed disc: q a (2 - nu) / 2 G (Johnson 1985, section 3.6).
  EXPECT_NEAR(tangential_response(Vec3::Zero(), 2.0, 2.0)(0, 0),
              0.75 * 2.0 / (4.0 * std::numbers::pi), 1e-5);
}

/// Hertz contact of radius a with mean friction limits mu p, on a triangular lattice in z = 0.
struct Hertz {
  double radius = 5.0;          // a, mm
  double modulus = 0.03;        // G, MPa
  double friction_force = 2.0;  // mu P, N
};

std::vector<RubbingPatch> hertz_patches(const Hertz& hertz, double spacing) {
  std::vector<RubbingPatch> patches;
  const double cell = spacing * spacing * std::sqrt(3.0) / 2.0;
  double sum = 0.0;
  for (const Vec3& v : geometry::make_lattice_patch(1.2 * hertz.radius, spacing).vertices) {
    // Mean pressure of a cell, so that cells on the edge count in part.
    double mean = 0.0;
    constexpr int kSteps = 10;
    for (int i = 0; i < kSteps; ++i) {
      for (int k = 0; k < kSteps; ++k) {
        const double x = v.x() + spacing * ((i + 0.5) / kSteps - 0.5);
        const double y = v.y() + spacing * std::sqrt(0.75) * ((k + 0.5) / kSteps - 0.5);
        mean += std::sqrt(std::max(0.0, 1.0 - (x * x + y * y) / hertz.radius / hertz.radius));
      }
    }
    if (mean < 1e-3) continue;
    patches.push_back({.position = v,
                       .normal = Vec3::UnitZ(),
                       .limit = mean,
                       .radius = std::sqrt(cell / std::numbers::pi),
                       .shear_modulus = hertz.modulus,
                       .rest = v});
    sum += mean;
  }
  for (RubbingPatch& patch : patches) patch.limit *= hertz.friction_force / sum;
  return patches;
}

double share_of_patches_that_stick(const StickSlip& answer, const std::vector<RubbingPatch>& p,
                                   double radius) {
  int stick = 0, inside = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i].position.norm() > radius) continue;
    ++inside;
    if (answer.force[i].norm() < 0.9999 * p[i].limit) ++stick;
  }
  return static_cast<double>(stick) / inside;
}

TEST(StickSlip, CattaneoMindlin) {
  // delta = 3 mu P (2 - nu) / (16 G a) (1 - (1 - Q / mu P)^(2/3)), stick radius
  // c = a (1 - Q / mu P)^(1/3) (Johnson 1985, eq. 7.41, 7.42); the product is rigid. The closed
  // form lets the slipping rim rub along the force alone, so it is itself off by a few per cent.
  const Hertz hertz;
  const auto patches = hertz_patches(hertz, 0.55);
  for (const double share : {0.3, 0.6, 0.9}) {
    const Wrench load{share * hertz.friction_force * Vec3::UnitX(), Vec3::Zero()};
    const HoldingLimit limit = holding_limit(patches, load);
    EXPECT_TRUE(limit.has_converged);
    EXPECT_NEAR(limit.factor * share, 1.0, 1e-6);  // slides as a whole at Q = mu P
    const StickSlip answer = solve_stick_slip(patches, load, limit);
    ASSERT_TRUE(answer.has_converged) << share;
    EXPECT_LT(answer.balance_error, 1e-9);
    const double left = 1.0 - share;
    const double delta = 3.0 * hertz.friction_force * 1.5 / (16.0 * hertz.modulus * hertz.radius) *
                         (1.0 - std::pow(left, 2.0 / 3.0));
    // The skin is dragged along the load.
    EXPECT_NEAR(answer.motion.at(Vec3::Zero()).x() / delta, 1.0, 0.03) << share;
    EXPECT_NEAR(answer.motion.at(Vec3::Zero()).y(), 0.0, 1e-6);
    EXPECT_NEAR(share_of_patches_that_stick(answer, patches, hertz.radius),
                std::pow(left, 2.0 / 3.0), 0.05)
        << share;
  }
}

TEST(StickSlip, BondedDiscHasTheStiffnessOfMindlinAndReissnerSagoci) {
  // Without slip: Q / delta = 8 G a / (2 - nu), M / beta = 16 G a^3 / 3 (Johnson 1985, sections
  // 7.2, 3.9), a the radius of the area of all patches.
  const Hertz hertz{.friction_force = 1e4};
  const auto patches = hertz_patches(hertz, 0.55);
  const double a = patches[0].radius * std::sqrt(static_cast<double>(patches.size()));
  const Wrench push{Vec3(0, -0.1, 0), Vec3::Zero()};
  const StickSlip pushed = solve_stick_slip(patches, push, holding_limit(patches, push));
  ASSERT_TRUE(pushed.has_converged);
  EXPECT_NEAR(pushed.motion.at(Vec3::Zero()).y() * 16.0 / 3.0 * hertz.modulus * a / -0.1, 1.0,
              0.01);
  const Wrench turn{Vec3::Zero(), Vec3(0, 0, 0.5)};
  const StickSlip turned = solve_stick_slip(patches, turn, holding_limit(patches, turn));
  ASSERT_TRUE(turned.has_converged);
  EXPECT_NEAR(turned.motion.rotation.z() * 16.0 / 3.0 * hertz.modulus * std::pow(a, 3) / 0.5, 1.0,
              0.03);
}

TEST(HoldingLimitOfFriction, TorsionOfAHertzContact) {
  // 3 pi / 16 mu P a (Lubkin 1951).
  const Hertz hertz;
  const auto patches = hertz_patches(hertz, 0.4);
  const HoldingLimit limit = holding_limit(patches, {Vec3::Zero(), Vec3(0, 0, 1)});
  EXPECT_TRUE(limit.has_converged);
  EXPECT_NEAR(limit.factor / (3.0 * std::numbers::pi / 16.0 * hertz.friction_force * hertz.radius),
              1.0, 0.005);
  // It turns about its middle, the rim fastest.
  EXPECT_LT(limit.slip.at(Vec3::Zero()).norm(), 0.02);
  EXPECT_GT(limit.slip.rotation.z(), 0.0);
}

/// Two pads of 25 patches each on the sides x = +-10 mm of a block, finger and thumb.
std::vector<RubbingPatch> pinch(double limit_of_one_pad) {
  std::vector<RubbingPatch> patches;
  for (const double side : {-1.0, 1.0}) {
    for (int i = -2; i <= 2; ++i) {
      for (int k = -2; k <= 2; ++k) {
        const Vec3 at(side * 10.0, 1.5 * i, 1.5 * k);
        patches.push_back({.position = at,
                           .normal = side * Vec3::UnitX(),
                           .limit = limit_of_one_pad / 25.0,
                           .radius = 0.8,
                           .shear_modulus = 0.02,
                           .rest = at,
                           .body = side < 0.0 ? 0 : 1});
      }
    }
  }
  return patches;
}

Wrench at_origin(const Vec3& force) { return {force, Vec3::Zero()}; }

TEST(HoldingLimitOfFriction, PinchedBlockIsHeldByBothSides) {
  // 2 mu P, whatever the direction along the sides; mu P = 3 N.
  for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0, 0.6, 0.8)}) {
    const HoldingLimit limit = holding_limit(pinch(3.0), at_origin(direction));
    EXPECT_TRUE(limit.has_converged);
    EXPECT_NEAR(limit.factor, 6.0, 1e-5);
    EXPECT_GE(limit.upper_factor, limit.factor);
    // It slides along the load, as a whole.
    EXPECT_LT((limit.slip.at(Vec3::Zero()) - direction).norm(), 1e-2);
    EXPECT_LT(limit.slip.rotation.norm(), 1e-3);
  }
  // Turned about the line between the pads, each pad holds the sum of limit_i r_i.
  double expected = 0.0;
  for (const RubbingPatch& patch : pinch(3.0)) {
    expected += patch.limit * std::hypot(patch.position.y(), patch.position.z());
  }
  const HoldingLimit turned = holding_limit(pinch(3.0), {Vec3::Zero(), Vec3(1, 0, 0)});
  EXPECT_NEAR(turned.factor / expected, 1.0, 1e-5);
}

TEST(HoldingLimitOfFriction, NoFrictionAgainstLiftingOffAPlane) {
  const std::vector<RubbingPatch> patches = hertz_patches(Hertz{}, 1.0);
  const HoldingLimit limit = holding_limit(patches, at_origin(Vec3(0, 0, 1)));
  EXPECT_TRUE(limit.has_converged);
  EXPECT_EQ(limit.factor, 0.0);
  EXPECT_EQ(limit.upper_factor, 0.0);
  EXPECT_NEAR(limit.slip.at(Vec3::Zero()).z(), 1.0, 1e-9);
  const StickSlip answer = solve_stick_slip(patches, at_origin(Vec3(0, 0, 1)), limit);
  EXPECT_FALSE(answer.has_converged);
  for (const Vec3& force : answer.force) EXPECT_EQ(force.norm(), 0.0);
  // A pinch holds what is along its axis no better than a plane.
  EXPECT_LT(holding_limit(pinch(3.0), at_origin(Vec3(1, 0, 0))).factor, 1e-6);
}

TEST(HoldingLimitOfFriction, NothingToHoldAndNothingToHoldWith) {
  const HoldingLimit free = holding_limit(pinch(1.0), Wrench{});
  EXPECT_TRUE(std::isinf(free.factor));
  const StickSlip answer = solve_stick_slip(pinch(1.0), Wrench{}, free);
  EXPECT_TRUE(answer.has_converged);
  for (const Vec3& force : answer.force) EXPECT_EQ(force.norm(), 0.0);
  EXPECT_EQ(answer.motion.translation.norm(), 0.0);
  EXPECT_EQ(holding_limit({}, at_origin(Vec3(1, 0, 0))).factor, 0.0);
}

TEST(StickSlip, PinchCarriesTheWeightHalfAndHalf) {
  const std::vector<RubbingPatch> patches = pinch(3.0);
  const Wrench weight = at_origin(Vec3(0, 0, -2.0));
  const StickSlip answer = solve_stick_slip(patches, weight, holding_limit(patches, weight));
  ASSERT_TRUE(answer.has_converged);
  Vec3 one = Vec3::Zero();
  for (std::size_t i = 0; i < 25; ++i) one += answer.force[i];
  EXPECT_LT((one - Vec3(0, 0, 1.0)).norm(), 1e-8);
  EXPECT_LT(answer.motion.at(Vec3::Zero()).z(), 0.0);
  EXPECT_LT(answer.balance_error, 1e-9);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    EXPECT_NEAR(answer.force[i].dot(patches[i].normal), 0.0, 1e-12);
    EXPECT_LE(answer.force[i].norm(), patches[i].limit * (1.0 + 1e-12));
  }
}

TEST(StickSlip, StiffSkinMovesLessAndSlipsAlike) {
  const Hertz soft{.modulus = 0.02}, stiff{.modulus = 0.08};
  const Wrench load{Vec3(1.1, 0.4, 0), Vec3(0, 0, 1.5)};
  const auto a = hertz_patches(soft, 0.9), b = hertz_patches(stiff, 0.9);
  const StickSlip one = solve_stick_slip(a, load, holding_limit(a, load));
  const StickSlip two = solve_stick_slip(b, load, holding_limit(b, load));
  ASSERT_TRUE(one.has_converged && two.has_converged);
  EXPECT_NEAR(one.motion.translation.norm() / two.motion.translation.norm(), 4.0, 1e-4);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((one.force[i] - two.force[i]).norm(), 1e-5 * a[i].limit);
  }
}

TEST(StickSlip, TurnedAndMovedWithItsLoadNothingChanges) {
  const auto patches = hertz_patches(Hertz{}, 0.9);
  const Wrench load{Vec3(1.0, -0.5, 0), Vec3(0, 0, 1.5)};
  const HoldingLimit limit = holding_limit(patches, load);
  const StickSlip answer = solve_stick_slip(patches, load, limit);
  const Quat turn(Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()));
  const Vec3 shift(120, -40, 33);
  std::vector<RubbingPatch> moved = patches;
  for (RubbingPatch& patch : moved) {
    patch.position = turn * patch.position + shift;
    patch.normal = turn * patch.normal;
    patch.contact_from_rest = turn;  // skin at rest stays where it is
  }
  const Wrench moved_load{turn * load.force, turn * load.moment + shift.cross(turn * load.force)};
  const HoldingLimit moved_limit = holding_limit(moved, moved_load);
  EXPECT_NEAR(moved_limit.factor / limit.factor, 1.0, 1e-6);
  const StickSlip moved_answer = solve_stick_slip(moved, moved_load, moved_limit);
  ASSERT_TRUE(answer.has_converged && moved_answer.has_converged);
  EXPECT_LT((moved_answer.motion.at(shift) - turn * answer.motion.at(Vec3::Zero())).norm(),
            1e-6 * answer.motion.at(Vec3::Zero()).norm());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    EXPECT_LT((moved_answer.force[i] - turn * answer.force[i]).norm(), 1e-4 * patches[i].limit);
  }
}

TEST(StickSlip, SameBytesForOneThreadAndTwo) {
  const std::vector<RubbingPatch> patches = pinch(2.0);
  const Wrench load{Vec3(0, 0.5, -2.5), Vec3(1.0, 0, 4.0)};
  const auto solve = [&](int threads) {
    set_thread_count(threads);
    StickSlip answer = solve_stick_slip(patches, load, holding_limit(patches, load));
    set_thread_count(0);
    return answer;
  };
  const StickSlip one = solve(1), two = solve(2);
  ASSERT_TRUE(one.has_converged);
  EXPECT_TRUE(one.force == two.force);
  EXPECT_TRUE(one.motion.translation == two.motion.translation);
}

TEST(StickSlip, CloseToItsLimitEverythingSlips) {
  const auto patches = hertz_patches(Hertz{}, 0.9);
  const Wrench load = at_origin(0.9999 * 2.0 * Vec3::UnitX());
  const HoldingLimit limit = holding_limit(patches, load);
  ASSERT_GT(limit.factor, 1.0);
  const StickSlip answer = solve_stick_slip(patches, load, limit);
  EXPECT_TRUE(answer.has_converged);
  EXPECT_LT(share_of_patches_that_stick(answer, patches, 5.0), 0.05);
}

}  // namespace
}  // namespace palmar::contact
