// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/remesh/remesh.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/posture/posture_from_mesh.h"
#include "palmar/hand/skin/skinning.h"
#include "template_fixture.h"

// Meshes of posed hands, made by another skinning than the one that is fitted: linear blending of
// the bones' matrices with weights of distance, so that folds and joints look different.

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

constexpr double kRadians = std::numbers::pi / 180.0;

class PostureMeshTest : public TemplateTest {};

/// Distance of a point from a segment.
double distance_to(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (p - a - t * d).norm();
}

/// Skin moved by matrices blended with weights that fall off with the distance from each bone.
geometry::TriangleMesh blended_skin(const hand::Hand& hand, const hand::Posture& posture) {
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand.skeleton, posture);
  struct Link {
    Vec3 from, to;
    geometry::Rigid3 motion;
    int finger = -1;  // palm
  };
  std::vector<Link> links;
  const auto centre = [&](hand::JointId id) { return hand.skeleton.joint(id).centre; };
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const Vec3 tip = hand.skeleton.fingertips[static_cast<std::size_t>(f)];
    std::vector<hand::Segment> segments;
    for (const auto& one : hand::segments_of(finger)) {
      if (one) segments.push_back(*one);
    }
    for (std::size_t k = 0; k < segments.size(); ++k) {
      const Vec3 from = centre(hand::joint_of(segments[k]));
      const Vec3 to = k + 1 < segments.size() ? centre(hand::joint_of(segments[k + 1])) : tip;
      links.push_back({from, to, posed.segment[static_cast<std::size_t>(segments[k])], f});
    }
    const Vec3 knuckle = centre(hand::joint_of(segments.front()));
    if (finger == hand::Finger::kThumb) {
      links.push_back({centre(hand::JointId::kThumbCmc), knuckle, posed.thumb_metacarpal, f});
    } else {
      links.push_back({Vec3(0.6 * knuckle.x(), 18, knuckle.z()), knuckle, geometry::Rigid3{}, -1});
    }
  }
  links.push_back({Vec3(0, -35, 0), Vec3(0, 0, 0), posed.forearm, -2});
  geometry::TriangleMesh skin = hand.skin;
  for (Vec3& v : skin.vertices) {
    std::vector<double> distance;
    double nearest = 1e9;
    std::size_t first = 0;
    for (std::size_t k = 0; k < links.size(); ++k) {
      distance.push_back(distance_to(v, links[k].from, links[k].to));
      if (distance[k] < nearest) {
        nearest = distance[k];
        first = k;
      }
    }
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (std::size_t k = 0; k < links.size(); ++k) {
      // Skin of one finger doesn't follow another one.
      const bool is_other = links[k].finger >= 0 && links[first].finger >= 0 &&
                            links[k].finger != links[first].finger;
      if (is_other) continue;
      const double w = std::pow(std::max(distance[k], 1.0), -8);
      sum += w * (links[k].motion * v);
      weights += w;
    }
    v = sum / weights;
  }
  return skin;
}

const geometry::Rigid3 kMeshPlace{Quat(Eigen::AngleAxisd(1.9, Vec3(-0.5, 0.7, 0.51).normalized())),
                                  Vec3(-300, 120, 55)};

geometry::TriangleMesh placed(geometry::TriangleMesh mesh, const geometry::Rigid3& place,
                              double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, 1.0);
  for (Vec3& v : mesh.vertices) {
    v = place * v + noise * Vec3(error(random), error(random), error(random));
  }
  return mesh;
}

/// Largest and root mean square error over the fingers' angles, degrees.
struct AngleError {
  double rms = 0.0, worst = 0.0;
  std::string text;
};
AngleError angle_error(const hand::Posture& found, const hand::Posture& truth) {
  AngleError error;
  int count = 0;
  for (int d = static_cast<int>(hand::Dof::kThumbCmcFlexion); d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    const double e = std::abs(found[dof] - truth[dof]) / kRadians;
    error.rms += e * e;
    ++count;
    if (e > error.worst) error.worst = e;
    if (e > 5) error.text += std::string(name_of(dof)) + " " + std::to_string(e) + "; ";
  }
  error.rms = std::sqrt(error.rms / count);
  return error;
}

/// Another triangulation, coarser than the hand's.
geometry::TriangleMesh scanned(const geometry::TriangleMesh& skin, double noise, unsigned seed) {
  return placed(geometry::remesh(skin, {.edge_length = 4.0, .rounds = 4}).mesh, kMeshPlace, noise,
                seed);
}

/// Angles drawn between two postures that people take: fingers don't run through each other.
hand::Posture drawn_mesh_posture(const hand::Hand& hand, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const hand::Posture flat = *hand::named_posture(hand.skeleton, "flat");
  const hand::Posture bent = *hand::named_posture(hand.skeleton, "cylinder_grip");
  hand::Posture posture = flat;
  for (std::size_t d = 0; d < hand::kDofCount; ++d) {
    posture.angle[d] += share(random) * 1.2 * (bent.angle[d] - flat.angle[d]);
  }
  return hand::clamp_to_range(hand.skeleton, posture).posture;
}

TEST_F(PostureMeshTest, TheSameSkinIsFoundVertexForVertex) {
  hand::Posture truth = *hand::named_posture(hand().skeleton, "tripod");
  truth[hand::Dof::kWristFlexion] = 20 * kRadians;
  const geometry::TriangleMesh mesh =
      placed({hand::pose_skin(hand(), truth), hand().skin.triangles}, kMeshPlace, 0.0, 1);
  const hand::MeshFit fit = hand::fit_posture_to_mesh(hand(), mesh);
  EXPECT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
  EXPECT_TRUE(fit.is_vertex_to_vertex);
  EXPECT_GT(fit.partner_share, 0.99);
  EXPECT_LT(fit.percentile_95, 0.01);  // mm; the prior of 10 rad pulls by less
  for (std::size_t d = 0; d < hand::kDofCount; ++d) {
    EXPECT_NEAR(fit.posture.angle[d] / kRadians, truth.angle[d] / kRadians, 0.05);
  }
  EXPECT_LT((fit.mesh_from_hand.translation - kMeshPlace.translation).norm(), 0.05);
}

TEST_F(PostureMeshTest, AnglesOfAnotherSkinningComeOutWithinAFewDegrees) {
  for (const unsigned seed : {1U, 2U}) {
    const hand::Posture truth = drawn_mesh_posture(hand(), seed);
    const hand::MeshFit fit =
        hand::fit_posture_to_mesh(hand(), scanned(blended_skin(hand(), truth), 0.3, seed));
    ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
    EXPECT_FALSE(fit.is_vertex_to_vertex);
    const AngleError error = angle_error(fit.posture, truth);
    EXPECT_LT(error.rms, 3.0) << seed << ": " << error.text;
    EXPECT_LT(error.worst, 10.0) << seed << ": " << error.text;
    EXPECT_GT(fit.partner_share, 0.95);
    EXPECT_LT(fit.median, 0.8);  // mm: noise of 0.3 mm, facets of 4 mm, another skinning
    EXPECT_LE(fit.median, fit.percentile_95);
  }
}

TEST_F(PostureMeshTest, AForearmAndHolesDontMislead) {
  const hand::Posture truth = drawn_mesh_posture(hand(), 5);
  geometry::TriangleMesh mesh = blended_skin(hand(), truth);
  // The forearm goes on for 200 mm as a tube of the wrist's girth, beside the stub's cut.
  const int first = mesh.vertex_count();
  constexpr int kRound = 24, kRings = 40;
  for (int r = 0; r < kRings; ++r) {
    for (int k = 0; k < kRound; ++k) {
      const double a = 2 * std::numbers::pi * k / kRound;
      mesh.vertices.emplace_back(24 * std::cos(a), -38 - 5.0 * r, 17 * std::sin(a) - 4);
    }
  }
  for (int r = 0; r + 1 < kRings; ++r) {
    for (int k = 0; k < kRound; ++k) {
      const int a = first + r * kRound + k, b = first + r * kRound + (k + 1) % kRound;
      mesh.triangles.push_back({a, a + kRound, b});
      mesh.triangles.push_back({b, a + kRound, b + kRound});
    }
  }
  // Holes: a tenth of the hand wasn't seen.
  std::vector<Triangle> kept;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& p = hand().skin.vertices[static_cast<std::size_t>(
        std::min(t[0], hand().skin.vertex_count() - 1))];
    const bool is_lost = (p - Vec3(-15, 60, 20)).norm() < 18 || (p - Vec3(18, 140, 2)).norm() < 8;
    if (!is_lost) kept.push_back(t);
  }
  mesh.triangles = kept;
  const hand::MeshFit fit = hand::fit_posture_to_mesh(hand(), placed(mesh, kMeshPlace, 0.2, 2));
  ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
  const AngleError error = angle_error(fit.posture, truth);
  EXPECT_LT(error.rms, 3.0) << error.text;
  EXPECT_LT(error.worst, 12.0) << error.text;
  EXPECT_LT(fit.partner_share, 0.99);
  EXPECT_GT(fit.partner_share, 0.85);
}

TEST_F(PostureMeshTest, AnotherSizeIsFoundIfAskedFor) {
  const hand::Hand large = hand::scaled(hand(), 1.1);
  const hand::Posture truth = drawn_mesh_posture(large, 6);
  const hand::MeshFit fit = hand::fit_posture_to_mesh(
      hand(), scanned(blended_skin(large, truth), 0.2, 1), {.fits_scale = true});
  ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
  EXPECT_NEAR(fit.scale, 1.1, 0.01);
  EXPECT_LT(angle_error(fit.posture, truth).rms, 3.5) << angle_error(fit.posture, truth).text;
}

TEST_F(PostureMeshTest, TheOtherHandIsRecognised) {
  const hand::Hand left = hand::mirrored(hand());
  const hand::Posture truth = drawn_mesh_posture(left, 3);
  const geometry::TriangleMesh skin{hand::pose_skin(left, truth), left.skin.triangles};
  const hand::MeshFit by_vertex =
      hand::fit_posture_to_mesh(hand(), placed(skin, kMeshPlace, 0.0, 1));
  EXPECT_EQ(by_vertex.status, hand::PostureFitStatus::kMirrored) << by_vertex.message;
  const hand::MeshFit by_shape = hand::fit_posture_to_mesh(hand(), scanned(skin, 0.2, 1));
  EXPECT_EQ(by_shape.status, hand::PostureFitStatus::kMirrored) << by_shape.message;
  EXPECT_THAT(by_shape.message, HasSubstr("hand mirror"));
}

TEST_F(PostureMeshTest, WhatIsNoHandIsNotTakenForOne) {
  geometry::TriangleMesh tube;
  constexpr int kRound = 48, kRings = 60;
  for (int r = 0; r <= kRings; ++r) {
    for (int k = 0; k < kRound; ++k) {
      const double a = 2 * std::numbers::pi * k / kRound;
      tube.vertices.emplace_back(25 * std::cos(a), 25 * std::sin(a), 2.5 * r);
    }
  }
  for (int r = 0; r < kRings; ++r) {
    for (int k = 0; k < kRound; ++k) {
      const int a = r * kRound + k, b = r * kRound + (k + 1) % kRound;
      tube.triangles.push_back({a, b, a + kRound});
      tube.triangles.push_back({b, b + kRound, a + kRound});
    }
  }
  EXPECT_EQ(hand::fit_posture_to_mesh(hand(), tube).status, hand::PostureFitStatus::kPoor);
  for (Vec3& v : tube.vertices) v *= 0.001;
  const hand::MeshFit metres = hand::fit_posture_to_mesh(hand(), tube);
  EXPECT_EQ(metres.status, hand::PostureFitStatus::kWrongUnit);
  EXPECT_THAT(metres.message, HasSubstr("unit"));
  EXPECT_THROW(hand::fit_posture_to_mesh(hand(), geometry::TriangleMesh{}), Error);
  EXPECT_THROW(hand::fit_posture_to_mesh(hand(), tube, {.reach = -1}), UsageError);
}

}  // namespace
}  // namespace palmar::tests
