// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/remesh.h"
#include "palmar/geometry/smooth.h"
#include "palmar/hand/named_postures.h"
#include "palmar/hand/posture_from_mesh.h"
#include "palmar/hand/scaled_hand.h"
#include "palmar/hand/skinning.h"
#include "template_fixture.h"

// Meshes of posed hands, made by another skinning than the one that is fitted: linear blending of
// the bones' matrices with weights of distance, so that folds and joints look different.

namespace palmar {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

class PostureMeshTest : public TemplateTest {};

/// Distance of a point from a segment.
double distance_to(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (p - a - t * d).norm();
}

/// Skin moved by matrices blended with weights that fall off with the distance from each bone.
TriangleMesh blended_skin(const Hand& hand, const Posture& posture) {
  const PosedSkeleton posed = pose_skeleton(hand.skeleton, posture);
  struct Link {
    Vec3 from, to;
    Rigid3 motion;
    int finger = -1;  // palm
  };
  std::vector<Link> links;
  const auto centre = [&](JointId id) { return hand.skeleton.joint(id).centre; };
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const Vec3 tip = hand.skeleton.fingertips[static_cast<std::size_t>(f)];
    std::vector<Segment> segments;
    for (const auto& one : segments_of(finger)) {
      if (one) segments.push_back(*one);
    }
    for (std::size_t k = 0; k < segments.size(); ++k) {
      const Vec3 from = centre(joint_of(segments[k]));
      const Vec3 to = k + 1 < segments.size() ? centre(joint_of(segments[k + 1])) : tip;
      links.push_back({from, to, posed.segment[static_cast<std::size_t>(segments[k])], f});
    }
    const Vec3 knuckle = centre(joint_of(segments.front()));
    if (finger == Finger::kThumb) {
      links.push_back({centre(JointId::kThumbCmc), knuckle, posed.thumb_metacarpal, f});
    } else {
      links.push_back({Vec3(0.6 * knuckle.x(), 18, knuckle.z()), knuckle, Rigid3{}, -1});
    }
  }
  links.push_back({Vec3(0, -35, 0), Vec3(0, 0, 0), posed.forearm, -2});
  TriangleMesh skin = hand.skin;
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

const Rigid3 kPlace{Quat(Eigen::AngleAxisd(1.9, Vec3(-0.5, 0.7, 0.51).normalized())),
                    Vec3(-300, 120, 55)};

TriangleMesh placed(TriangleMesh mesh, const Rigid3& place, double noise, unsigned seed) {
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
AngleError angle_error(const Posture& found, const Posture& truth) {
  AngleError error;
  int count = 0;
  for (int d = static_cast<int>(Dof::kThumbCmcFlexion); d < kDofCount; ++d) {
    const auto dof = static_cast<Dof>(d);
    const double e = std::abs(found[dof] - truth[dof]) / kDegree;
    error.rms += e * e;
    ++count;
    if (e > error.worst) error.worst = e;
    if (e > 5) error.text += std::string(name_of(dof)) + " " + std::to_string(e) + "; ";
  }
  error.rms = std::sqrt(error.rms / count);
  return error;
}

TEST_F(PostureMeshTest, Survey) {
  for (const std::string& name : posture_names()) {
    const Posture truth = *named_posture(hand().skeleton, name);
    const TriangleMesh mesh =
        placed(remesh(blended_skin(hand(), truth), {.edge_length = 4.0, .rounds = 5}).mesh, kPlace,
               0.3, 3);
    const MeshFit fit = fit_posture_to_mesh(hand(), mesh);
    const AngleError error = angle_error(fit.posture, truth);
    std::cout << name << ": rms " << error.rms << " worst " << error.worst << " it "
              << fit.iterations << " " << fit.message << " | " << error.text << "\n";
  }
}

}  // namespace
}  // namespace palmar
