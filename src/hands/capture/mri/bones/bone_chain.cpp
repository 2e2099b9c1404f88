// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/rotation.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr std::array<std::string_view, 8> kCarpals = {
    "trapezium", "trapezoid", "capitate", "hamate", "scaphoid", "lunate", "triquetrum", "pisiform"};

}  // namespace

std::vector<std::string> ray_of(hand::Finger finger) {
  std::vector<std::string> names = {std::string(name_of(finger)) + "_metacarpal"};
  for (const std::optional<hand::Segment>& segment : hand::segments_of(finger)) {
    if (segment) names.push_back(phalanx_name(*segment));
  }
  return names;
}

std::string phalanx_name(hand::Segment segment) {
  if (!hand::finger_of(segment)) throw UsageError("phalanx: the palm is none");
  return std::string(name_of(segment)) + "_phalanx";
}

bool is_palm_bone(std::string_view name) {
  if (std::find(kCarpals.begin(), kCarpals.end(), name) != kCarpals.end()) return true;
  return name.ends_with("_metacarpal") && !name.starts_with("thumb");
}

bool is_forearm_bone(std::string_view name) { return name == "radius" || name == "ulna"; }

const ScannedBone* bone_named(const ScanSurfaces& surfaces, std::string_view name) {
  for (const ScannedBone& bone : surfaces.bones) {
    if (bone.name == name) return &bone;
  }
  return nullptr;
}

Vec3 joint_surface_point(const geometry::TriangleMesh& distal,
                         const geometry::TriangleMesh& proximal) {
  const geometry::ClosestPointQuery query(proximal);
  std::vector<double> distance;
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& v : distal.vertices) {
    const std::optional<geometry::ClosestPoint> found = query.closest(v);
    distance.push_back(found ? found->distance : std::numeric_limits<double>::infinity());
    least = std::min(least, distance.back());
  }
  constexpr double kBand = 1.0;  // mm
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (!(distance[i] <= least + kBand)) continue;
    sum += distal.vertices[i];
    ++count;
  }
  if (count == 0) throw UsageError("joint surface: one of the bones has no surface");
  return sum / count;
}

geometry::Rigid3 align_points(std::span<const Vec3> a, std::span<const Vec3> b,
                              std::span<const double> weight) {
  if (a.empty() || a.size() != b.size() || (!weight.empty() && weight.size() != a.size())) {
    throw UsageError("alignment of points: the lists are empty or not equally long");
  }
  double total = 0.0;
  Vec3 middle_a = Vec3::Zero(), middle_b = Vec3::Zero();
  const auto w = [&](std::size_t i) { return weight.empty() ? 1.0 : weight[i]; };
  for (std::size_t i = 0; i < a.size(); ++i) {
    total += w(i);
    middle_a += w(i) * a[i];
    middle_b += w(i) * b[i];
  }
  middle_a /= total;
  middle_b /= total;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    cross += w(i) * (b[i] - middle_b) * (a[i] - middle_a).transpose();
  }
  const Quat q = Quat(geometry::fit_rotation(cross)).normalized();
  return {q, middle_b - q * middle_a};
}

geometry::Rigid3 align_points_robustly(std::span<const Vec3> a, std::span<const Vec3> b,
                                       double tolerance) {
  // Start from the triple that most other pairs agree with: a few wrong pairs would pull a mean.
  geometry::Rigid3 best = align_points(a, b);
  const auto distances = [&](const geometry::Rigid3& motion) {
    std::vector<double> d;
    for (std::size_t i = 0; i < a.size(); ++i) d.push_back((motion * a[i] - b[i]).norm());
    return d;
  };
  if (a.size() > 3) {
    double least = statistics::median(distances(best));
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = i + 1; j < a.size(); ++j) {
        for (std::size_t k = j + 1; k < a.size(); ++k) {
          const std::array<Vec3, 3> from = {a[i], a[j], a[k]}, to = {b[i], b[j], b[k]};
          const geometry::Rigid3 motion = align_points(from, to);
          const double middle = statistics::median(distances(motion));
          if (middle >= least) continue;
          least = middle;
          best = motion;
        }
      }
    }
  }
  for (int pass = 0; pass < 5; ++pass) {
    const std::vector<double> d = distances(best);
    const double limit = std::max(tolerance, 3.0 * statistics::median(d));
    std::vector<double> weight;
    for (const double one : d) weight.push_back(one <= limit ? 1.0 : 0.0);
    if (std::count(weight.begin(), weight.end(), 1.0) < 3) break;
    best = align_points(a, b, weight);
  }
  return best;
}

}  // namespace palmar::capture
