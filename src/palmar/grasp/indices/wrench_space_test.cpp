// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/wrench_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

using ::testing::HasSubstr;

constexpr double kTight = 1e-6;

/// Distance of the origin from the hull of points, by trying the plane through every choice of D of
/// them: slow, simple, and nothing of convex_body.cpp.
template <int D>
double distance_by_all_planes(const std::vector<Eigen::Matrix<double, D, 1>>& points) {
  double nearest = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> pick(D);
  const auto n = points.size();
  for (std::size_t i = 0; i < D; ++i) pick[i] = i;
  for (;;) {
    Eigen::Matrix<double, D, D> m;
    for (int i = 0; i < D; ++i) m.row(i) = points[pick[i]].transpose();
    // Plane n . x = 1 through all of them, unless it goes through the origin.
    const Eigen::FullPivLU<Eigen::Matrix<double, D, D>> lu(m);
    if (std::abs(lu.determinant()) > 1e-9) {
      const Eigen::Matrix<double, D, 1> plane = lu.solve(Eigen::Matrix<double, D, 1>::Ones());
      bool is_facet = true;
      for (const auto& p : points) is_facet = is_facet && plane.dot(p) < 1.0 + 1e-9;
      if (is_facet) nearest = std::min(nearest, 1.0 / plane.norm());
    }
    std::size_t at = D;
    while (at > 0 && pick[at - 1] == n - D + at - 1) --at;
    if (at == 0) return nearest;
    ++pick[at - 1];
    for (std::size_t i = at; i < D; ++i) pick[i] = pick[i - 1] + 1;
  }
}

std::vector<Wrench6> flat_list(const PointGroups<6>& groups) {
  std::vector<Wrench6> list;
  for (const auto& group : groups.group) list.insert(list.end(), group.begin(), group.end());
  return list;
}

GraspContact contact(const Vec3& position, const Vec3& normal, double friction,
                     double torsion = 0.0) {
  GraspContact one;
  one.position = position;
  one.normal = normal.normalized();
  one.friction = friction;
  one.torsion = torsion;
  return one;
}

/// Thumb and finger against each other, 2 r apart.
std::vector<GraspContact> antipodal(double r, double friction, double torsion) {
  return {contact({r, 0, 0}, {-1, 0, 0}, friction, torsion),
          contact({-r, 0, 0}, {1, 0, 0}, friction, torsion)};
}

/// Contacts all over an ellipsoid, pushing inwards.
std::vector<GraspContact> on_ellipsoid(int count, unsigned seed, double friction, double torsion) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<GraspContact> contacts;
  const Vec3 radii(20, 30, 50);
  for (int k = 0; k < count; ++k) {
    const Vec3 u = Vec3(normal(random), normal(random), normal(random)).normalized();
    contacts.push_back(contact(u.cwiseProduct(radii), -u.cwiseQuotient(radii), friction, torsion));
  }
  return contacts;
}

TEST(WrenchSpace, TwoHardFingersCannotTwistAboutTheirLine) {
  const WrenchSpace<6> space =
      measure_wrench_space(antipodal(25.0, 0.5, 0.0), Vec3::Zero(), WrenchNorm::kL1);
  EXPECT_EQ(space.status, ClosureStatus::kRankDeficient);
  EXPECT_EQ(space.body.rank, 5);
  EXPECT_EQ(space.epsilon, 0.0);
  EXPECT_EQ(space.body.volume, 0.0);
  EXPECT_NEAR(std::abs(space.weakest[3]), 1.0, 1e-9);  // the moment about x
  EXPECT_DOUBLE_EQ(space.torque_scale, 25.0);
}

TEST(WrenchSpace, TwoSoftFingersHoldWhatTheyShould) {
  // Torsion so large that it isn't what limits. With u = (force, moment / r), a = (u2 + u6,
  // u3 - u5), b = (u2 - u6, u3 + u5), so that |a|^2 + |b|^2 = 2 (1 - u1^2), the support functions
  // of the two fingers are -u1 + m |a| and u1 + m |b|, m = mu cos(pi / sides) where a octagon's
  // edge lies across. L1, the larger of both: least at b = 0, u1 = m |a| / 2: m / sqrt(2 + m^2).
  // Linf, the sum of their positive parts: least at b = 0, u1 = m |a|: sqrt(2) m / sqrt(1 + 2 m^2).
  const double mu = 0.5;
  for (const int sides : {8, 12, 16}) {
    WrenchOptions options;
    options.sides = sides;
    const double m = mu * std::cos(std::numbers::pi / sides);
    const WrenchSpace<6> l1 =
        measure_wrench_space(antipodal(25.0, mu, 50.0), Vec3::Zero(), WrenchNorm::kL1, options);
    EXPECT_EQ(l1.status, ClosureStatus::kForceClosure);
    EXPECT_NEAR(l1.epsilon, m / std::sqrt(2.0 + m * m), 1e-9) << sides;
    const WrenchSpace<6> linf =
        measure_wrench_space(antipodal(25.0, mu, 50.0), Vec3::Zero(), WrenchNorm::kLinf, options);
    EXPECT_NEAR(linf.epsilon, std::sqrt(2.0) * m / std::sqrt(1.0 + 2.0 * m * m), 1e-9) << sides;
  }
}

TEST(WrenchSpace, TwoSoftFingersOfRealTorsionAgreeWithAllPlanes) {
  for (const double torsion : {1.0, 4.0, 10.0}) {
    const auto contacts = antipodal(25.0, 0.6, torsion);
    const WrenchSpace<6> space = measure_wrench_space(contacts, Vec3::Zero(), WrenchNorm::kL1);
    const auto points = flat_list(primitive_wrenches(contacts, Vec3::Zero(), 25.0, {}));
    ASSERT_EQ(points.size(), 20u);  // 2 x (8 + 2 poles)
    EXPECT_NEAR(space.epsilon, distance_by_all_planes<6>(points), kTight) << torsion;
  }
}

TEST(WrenchSpace, ThreeContactsOnADiscAgreeWithGeometry) {
  // Wrenches (n_i +- mu s_i, -+ mu): two triangles of radius q = sqrt(1 + mu^2) at heights -mu and
  // mu, turned against each other by 2 atan(mu): an antiprism.
  const double mu = 0.4, q = std::sqrt(1.0 + mu * mu), turn = std::atan(mu);
  std::vector<PlanarContact> contacts;
  std::vector<Eigen::Vector3d> points;
  std::vector<Vec2> middle;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 3.0;
    const Vec2 outward(std::cos(angle), std::sin(angle));
    contacts.push_back({17.0 * outward, -outward, mu});
    for (const double sign : {-1.0, 1.0}) {
      const double at = angle + std::numbers::pi + sign * turn;
      points.emplace_back(q * std::cos(at), q * std::sin(at), -sign * mu);
    }
  }
  const WrenchSpace<3> space = measure_wrench_space(contacts, Vec2::Zero(), WrenchNorm::kL1);
  EXPECT_EQ(space.status, ClosureStatus::kForceClosure);
  EXPECT_NEAR(space.epsilon, distance_by_all_planes<3>(points), 1e-9);
  // Prismatoid: height / 6 (top + 4 middle + bottom); the middle section is the hexagon of the mean
  // of both triangles' corners next to each other.
  const double triangle = 0.75 * std::sqrt(3.0) * q * q;
  for (int k = 0; k < 6; ++k) {
    const double low = (k / 2) * 2.0 * std::numbers::pi / 3.0 + turn;  // the lower one's corner
    const double high = ((k + 1) / 2) * 2.0 * std::numbers::pi / 3.0 - turn;
    middle.emplace_back(0.5 * q * (std::cos(low) + std::cos(high)),
                        0.5 * q * (std::sin(low) + std::sin(high)));
  }
  double section = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec2 a = middle[k], b = middle[(k + 1) % 6];
    section += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_NEAR(space.body.volume, 2.0 * mu / 6.0 * (2.0 * triangle + 4.0 * section), 1e-9);
}

TEST(WrenchSpace, SevenFrictionlessContactsAreASimplex) {
  // Random contacts without friction on an ellipsoid; most choices don't close. One does just if
  // the null vector of its 6 x 7 wrench matrix has one sign.
  int closed = 0, open = 0;
  for (unsigned seed = 1; seed < 4000 && closed < 3; ++seed) {
    const auto contacts = on_ellipsoid(7, seed, 0.0, 0.0);
    const double scale = torque_scale_of(contacts, Vec3::Zero());
    const auto w = flat_list(primitive_wrenches(contacts, Vec3::Zero(), scale, {}));
    ASSERT_EQ(w.size(), 7u);
    Eigen::Matrix<double, 6, 7> m;
    for (int j = 0; j < 7; ++j) m.col(j) = w[j];
    const Eigen::Matrix<double, 7, 1> kernel = m.fullPivLu().kernel().col(0).normalized();
    const double sure = kernel.cwiseAbs().minCoeff();
    if (sure < 1e-3) continue;  // too near to the limit for a test
    const bool is_closed = kernel.minCoeff() > 0.0 || kernel.maxCoeff() < 0.0;
    if (!is_closed && open > 20) continue;
    const WrenchSpace<6> space = measure_wrench_space(contacts, Vec3::Zero(), WrenchNorm::kL1);
    ASSERT_EQ(space.status, is_closed ? ClosureStatus::kForceClosure : ClosureStatus::kNotClosed);
    if (!is_closed) {
      ++open;
      EXPECT_EQ(space.epsilon, 0.0);
      for (const Wrench6& one : w) EXPECT_LT(space.weakest.dot(one), 1e-6);
      continue;
    }
    ++closed;
    // Distance: planes through six of the seven points. Volume: determinant / 6!.
    double nearest = 1e9;
    for (int left_out = 0; left_out < 7; ++left_out) {
      Eigen::Matrix<double, 6, 6> rows;
      for (int i = 0, j = 0; j < 7; ++j) {
        if (j != left_out) rows.row(i++) = m.col(j).transpose();
      }
      nearest = std::min(nearest, 1.0 / rows.inverse().rowwise().sum().norm());
    }
    Eigen::Matrix<double, 6, 6> edges;
    for (int j = 0; j < 6; ++j) edges.col(j) = m.col(j) - m.col(6);
    EXPECT_NEAR(space.epsilon, nearest, kTight * nearest);
    EXPECT_NEAR(space.body.volume, std::abs(edges.determinant()) / 720.0, kTight);
  }
  EXPECT_EQ(closed, 3);
  EXPECT_GT(open, 5);
}

TEST(WrenchSpace, LinfOfFrictionlessContactsAgreesWithAllCorners) {
  // The sum of seven segments has at most 128 corners, all sums of a part of the wrenches.
  unsigned seed = 1;
  WrenchSpace<6> space;
  std::vector<GraspContact> contacts;
  for (;; ++seed) {
    contacts = on_ellipsoid(8, seed, 0.0, 0.0);
    space = measure_wrench_space(contacts, Vec3::Zero(), WrenchNorm::kLinf);
    if (space.status == ClosureStatus::kForceClosure) break;
    ASSERT_LT(seed, 4000u);
  }
  const auto w = flat_list(
      primitive_wrenches(contacts, Vec3::Zero(), torque_scale_of(contacts, Vec3::Zero()), {}));
  // Facets of a zonotope are spanned by five of its segments; its support is known at each normal.
  double nearest = 1e9;
  std::vector<int> pick = {0, 1, 2, 3, 4};
  for (;;) {
    Eigen::Matrix<double, 5, 6> rows;
    for (int i = 0; i < 5; ++i) rows.row(i) = w[pick[i]].transpose();
    const Wrench6 n = rows.fullPivLu().kernel().col(0).normalized();
    double plus = 0.0, minus = 0.0;
    for (const Wrench6& one : w) {
      plus += std::max(0.0, n.dot(one));
      minus += std::max(0.0, -n.dot(one));
    }
    nearest = std::min({nearest, plus, minus});
    int at = 5;
    while (at > 0 && pick[at - 1] == 8 - 5 + at - 1) --at;
    if (at == 0) break;
    ++pick[at - 1];
    for (int i = at; i < 5; ++i) {
      pick[i] = pick[i - 1] + 1;
    }
  }
  EXPECT_NEAR(space.epsilon, nearest, kTight * nearest);
}

TEST(WrenchSpace, MoreFrictionNeverLowersEpsilon) {
  const auto base = on_ellipsoid(5, 3, 0.0, 0.0);
  for (const WrenchNorm norm : {WrenchNorm::kL1, WrenchNorm::kLinf}) {
    double last = 0.0;
    WrenchOptions options;
    options.body.with_volume = false;
    for (double mu = 0.05; mu < 1.2; mu += 0.05) {
      auto contacts = base;
      for (GraspContact& one : contacts) {
        one.friction = mu;
        one.torsion = 3.0 * mu;
      }
      const double epsilon = measure_wrench_space(contacts, Vec3::Zero(), norm, options).epsilon;
      EXPECT_GE(epsilon, last - 1e-9) << mu;
      last = epsilon;
    }
    EXPECT_GT(last, 0.1);
  }
}

TEST(WrenchSpace, MoreContactsNeverLowerEpsilon) {
  const auto all = on_ellipsoid(14, 8, 0.4, 2.0);
  WrenchOptions options;
  options.torque_scale = 50.0;
  double last = 0.0, volume = 0.0;
  for (int count = 3; count <= 14; ++count) {
    const std::vector<GraspContact> some(all.begin(), all.begin() + count);
    const WrenchSpace<6> space = measure_wrench_space(some, Vec3::Zero(), WrenchNorm::kL1, options);
    EXPECT_GE(space.epsilon, last - 1e-9) << count;
    EXPECT_GE(space.body.volume_upper, volume * (1.0 - 1e-9)) << count;
    last = space.epsilon;
    volume = space.body.volume;
  }
  EXPECT_GT(last, 0.0);
}

TEST(WrenchSpace, TurnedAndMirroredWorldsHaveEqualIndices) {
  const auto contacts = on_ellipsoid(6, 21, 0.45, 1.5);
  const Vec3 reference(3, -4, 5);
  const Quat turn(Eigen::AngleAxisd(1.234, Vec3(1, 2, -0.5).normalized()));
  const Vec3 shift(100, -30, 12);
  auto turned = contacts, mirrored = contacts;
  for (GraspContact& one : turned) {
    one.position = turn * one.position + shift;
    one.normal = turn * one.normal;
  }
  for (GraspContact& one : mirrored) {
    one.position.x() *= -1.0;
    one.normal.x() *= -1.0;
  }
  for (const WrenchNorm norm : {WrenchNorm::kL1, WrenchNorm::kLinf}) {
    WrenchOptions options;
    options.body.with_volume = norm == WrenchNorm::kL1;
    const WrenchSpace<6> here = measure_wrench_space(contacts, reference, norm, options);
    const WrenchSpace<6> there =
        measure_wrench_space(turned, turn * reference + shift, norm, options);
    const WrenchSpace<6> mirror = measure_wrench_space(
        mirrored, Vec3(-reference.x(), reference.y(), reference.z()), norm, options);
    EXPECT_NEAR(here.torque_scale, there.torque_scale, 1e-9);
    EXPECT_NEAR(here.epsilon, there.epsilon, 1e-7);
    EXPECT_NEAR(here.epsilon, mirror.epsilon, 1e-7);
    if (norm == WrenchNorm::kLinf) continue;
    EXPECT_NEAR(here.body.volume, there.body.volume, kTight * here.body.volume);
    EXPECT_NEAR(here.body.volume, mirror.body.volume, kTight * here.body.volume);
  }
}

TEST(WrenchSpace, FrictionlessGraspOfABallSpinsFreely) {
  std::vector<GraspContact> contacts;
  for (const Vec3& u : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
    contacts.push_back(contact(20.0 * u.normalized(), -u, 0.0));
  }
  const WrenchSpace<6> space = measure_wrench_space(contacts, Vec3::Zero(), WrenchNorm::kL1);
  EXPECT_EQ(space.status, ClosureStatus::kRankDeficient);
  EXPECT_EQ(space.body.rank, 3);
  EXPECT_NEAR(space.weakest.head<3>().norm(), 0.0, 1e-9);  // a pure moment
}

TEST(WrenchSpace, NoContactIsNamed) {
  const WrenchSpace<6> space =
      measure_wrench_space(std::vector<GraspContact>{}, Vec3::Zero(), WrenchNorm::kL1);
  EXPECT_EQ(space.status, ClosureStatus::kNoContact);
  EXPECT_EQ(name_of(space.status), "no_contact");
}

TEST(WrenchSpace, ConeOfTwelveSidesLiesWithinTheConeAndTorsionSharesWithFriction) {
  WrenchOptions options;
  options.sides = 12;
  options.torsion_rings = 2;
  const auto points = flat_list(
      primitive_wrenches({contact({0, 0, 9}, {0, 0, -1}, 0.5, 3.0)}, Vec3::Zero(), 9.0, options));
  EXPECT_EQ(points.size(), 12u * 5u + 2u);
  for (const Wrench6& w : points) {
    EXPECT_NEAR(w[2], -1.0, 1e-12);
    const double slip = w.head<2>().norm() / 0.5;
    const double torsion = 9.0 * w[5] / 3.0;  // moment about z, no arm
    EXPECT_NEAR(slip * slip + torsion * torsion, 1.0, 1e-12);
  }
}

TEST(WrenchSpace, BadContactsAndOptionsAreNamed) {
  const auto message = [](const std::vector<GraspContact>& contacts, const WrenchOptions& options) {
    try {
      measure_wrench_space(contacts, Vec3::Zero(), WrenchNorm::kL1, options);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  auto contacts = antipodal(20.0, 0.5, 0.0);
  EXPECT_THAT(message(contacts, {.sides = 2}), HasSubstr("2; 3 to 64"));
  EXPECT_THAT(message(contacts, {.torque_scale = -1.0}), HasSubstr("torque scale"));
  contacts[1].friction = -0.1;
  EXPECT_THAT(message(contacts, {}), HasSubstr("contact 1: friction"));
  contacts[1] = contacts[0];
  contacts[1].normal *= 2.0;
  EXPECT_THAT(message(contacts, {}), HasSubstr("a unit vector is required"));
}

}  // namespace
}  // namespace palmar::grasp
