// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/skin_registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::capture {
namespace {

/// Which finger a point in space belongs to (1 thumb ... 5 little), 0 for palm and webs.
class Fingers {
 public:
  explicit Fingers(const hand::Skeleton& skeleton) {
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      Ray& ray = ray_[f];
      const auto chain = hand::segments_of(finger);
      ray.node.push_back(finger == hand::Finger::kThumb
                             ? skeleton.joint(hand::JointId::kThumbCmc).centre
                             : skeleton.joint(hand::JointId::kWrist).centre);
      for (const auto& s : chain) {
        if (s) ray.node.push_back(skeleton.joint(hand::joint_of(*s)).centre);
      }
      ray.node.push_back(skeleton.fingertips[f]);
    }
  }

  int of(const Vec3& point) const {
    constexpr double kFree = 0.4;  // of the first phalanx; nearer the joint lies the web
    double best = std::numeric_limits<double>::max();
    int part = 0;
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const Ray& ray = ray_[f];
      for (std::size_t k = 0; k + 1 < ray.node.size(); ++k) {
        const Vec3 along = ray.node[k + 1] - ray.node[k];
        const double t =
            std::clamp((point - ray.node[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        const double d = (point - ray.node[k] - t * along).squaredNorm();
        if (d >= best) continue;
        best = d;
        part = k == 0 || (k == 1 && t < kFree) ? 0 : f + 1;
      }
    }
    return part;
  }

 private:
  struct Ray {
    std::vector<Vec3> node;
  };
  std::array<Ray, hand::kFingerCount> ray_;
};

/// The model's cut through the forearm: faces proximally, beyond the wrist.
std::vector<char> cut_of(const hand::Hand& hand) {
  const std::vector<Vec3> normal = geometry::triangle_normals(hand.skin);
  const double wrist = hand.skeleton.joint(hand::JointId::kWrist).centre.y();
  std::vector<char> is_cut(hand.skin.vertices.size(), 0);
  for (std::size_t t = 0; t < normal.size(); ++t) {
    if (normal[t].y() > -0.8) continue;
    for (const int v : hand.skin.triangles[t]) {
      if (hand.skin.vertices[v].y() < wrist) is_cut[v] = 1;
    }
  }
  return is_cut;
}

FitSurface scanned_surface(const SkinScan& scan, const hand::Skeleton& skeleton) {
  FitSurface surface;
  surface.mesh = scan.skin;
  const Fingers fingers(skeleton);
  const std::vector<Vec3> normal = geometry::vertex_normals(scan.skin);
  const double wrist = skeleton.joint(hand::JointId::kWrist).centre.y();
  surface.is_silent.assign(scan.skin.vertices.size(), 0);
  surface.part.resize(scan.skin.vertices.size());
  // A spot of radius r stands on the skin; its rim is rounded off over about as much again.
  const double bump = 1.9 * scan.marker_radius;
  parallel_for(scan.skin.vertex_count(), [&](int v) {
    const Vec3& p = scan.skin.vertices[v];
    surface.part[v] = fingers.of(p);
    if (p.y() < wrist && normal[v].y() < -0.8) surface.is_silent[v] = 1;  // its own cut
    for (const Vec3& marker : scan.markers) {
      if ((p - marker).squaredNorm() < bump * bump) surface.is_silent[v] = 1;
    }
  });
  for (const auto& edge : geometry::boundary_edges(geometry::build_topology(scan.skin))) {
    for (const int v : edge) surface.is_silent[v] = 1;
  }
  return surface;
}

/// Parts surfaces that went through each other, a little at a time.
void part_crossings(geometry::TriangleMesh& skin) {
  constexpr int kRounds = 30;
  constexpr double kGap = 0.05;  // mm
  const std::vector<std::vector<int>> neighbours =
      geometry::vertex_neighbours(geometry::build_topology(skin));
  for (int round = 0; round < kRounds; ++round) {
    const geometry::CrossingDepth crossing = geometry::crossing_depth(skin);
    if (crossing.pairs.empty()) return;
    const std::vector<Vec3> normal = geometry::vertex_normals(skin);
    std::vector<Vec3> move(skin.vertices.size(), Vec3::Zero());
    for (std::size_t k = 0; k < crossing.vertex.size(); ++k) {
      const int v = crossing.vertex[k];
      move[v] = -(0.5 * crossing.depth[k] + kGap) * normal[v];
    }
    if (crossing.vertex.empty()) {  // a fold of the surface itself: smoothed away
      for (const auto& pair : crossing.pairs) {
        for (const int t : pair) {
          for (const int v : skin.triangles[t]) {
            Vec3 mean = Vec3::Zero();
            for (const int u : neighbours[v]) mean += skin.vertices[u];
            mean /= static_cast<double>(neighbours[v].size());
            move[v] = 0.5 * (mean - skin.vertices[v]);
          }
        }
      }
    }
    // Surroundings move with it, so that no dents remain.
    for (int pass = 0; pass < 2; ++pass) {
      std::vector<Vec3> spread = move;
      for (std::size_t v = 0; v < move.size(); ++v) {
        if (!move[v].isZero(0.0)) continue;
        Vec3 mean = Vec3::Zero();
        for (const int u : neighbours[v]) mean += move[u];
        spread[v] = 0.5 * mean / static_cast<double>(neighbours[v].size());
      }
      move = std::move(spread);
    }
    for (std::size_t v = 0; v < move.size(); ++v) skin.vertices[v] += move[v];
  }
}

/// Distances at the end: of skin distal of the wrist that lies over scanned skin.
void measure(const FitSurface& moving, const SkinScan& scan, const hand::Skeleton& skeleton,
             RegisteredSkin& result) {
  constexpr double kReach = 5.0;  // mm
  const double wrist = skeleton.joint(hand::JointId::kWrist).centre.y();
  const std::vector<double> area = geometry::vertex_areas(moving.mesh);
  const std::vector<double> distance = distances_to_scan(
      moving.mesh.vertices, geometry::vertex_normals(moving.mesh), scan, skeleton, kReach);
  result.has_partner.assign(distance.size(), 0);
  std::vector<double> partnered;
  double all = 0.0, with = 0.0;
  for (std::size_t v = 0; v < distance.size(); ++v) {
    if (moving.is_silent[v]) continue;
    result.has_partner[v] = distance[v] >= 0.0;
    if (moving.mesh.vertices[v].y() < wrist) continue;
    all += area[v];
    if (distance[v] < 0.0) continue;
    with += area[v];
    partnered.push_back(distance[v]);
    result.mean += distance[v];
  }
  result.partner_share = all > 0.0 ? with / all : 0.0;
  if (partnered.empty()) return;
  result.mean /= static_cast<double>(partnered.size());
  const auto k = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(partnered.size() - 1));
  std::nth_element(partnered.begin(), partnered.begin() + k, partnered.end());
  result.percentile_95 = partnered[k];
}

/// Throws InputError unless half of the skin has scanned skin near.
void require_near(const geometry::TriangleMesh& skin, const SkinScan& scan,
                  const hand::Skeleton& skeleton) {
  constexpr double kNear = 12.0;  // mm
  const std::vector<double> distance =
      distances_to_scan(skin.vertices, geometry::vertex_normals(skin), scan, skeleton, kNear);
  const auto near =
      std::count_if(distance.begin(), distance.end(), [](double d) { return d >= 0; });
  if (2 * near >= static_cast<std::ptrdiff_t>(distance.size())) return;
  throw InputError(fmt::format(
      "scanned skin: {:.0f} % of the model's skin, posed by the joints, has it within {:g} mm; 50 "
      "% are needed: skin and joints don't belong together",
      100.0 * static_cast<double>(near) / static_cast<double>(distance.size()), kNear));
}

/// Share of the scanned skin distal of the wrist that the registered one doesn't cover.
double left_over_share(const geometry::TriangleMesh& skin, const FitSurface& fixed,
                       const hand::Skeleton& skeleton) {
  constexpr double kFar = 2.0;  // mm
  const double wrist = skeleton.joint(hand::JointId::kWrist).centre.y();
  const geometry::ClosestPointQuery query(skin);
  const std::vector<double> area = geometry::vertex_areas(fixed.mesh);
  double all = 0.0, over = 0.0;
  for (std::size_t v = 0; v < area.size(); ++v) {
    const Vec3& p = fixed.mesh.vertices[v];
    if (fixed.is_silent[v] || p.y() < wrist) continue;
    all += area[v];
    if (!query.closest(p, kFar)) over += area[v];
  }
  return all > 0.0 ? over / all : 0.0;
}

/// Fingers of the segments: 1 thumb ... 5 little, 0 palm.
std::vector<int> parts_of(const std::vector<hand::Segment>& segments) {
  std::vector<int> part;
  for (const hand::Segment s : segments) {
    const auto finger = hand::finger_of(s);
    part.push_back(finger ? static_cast<int>(*finger) + 1 : 0);
  }
  return part;
}

/// Where joints and fingertips are in a posture; axes stay as they are.
hand::Skeleton posed_centres(const hand::Skeleton& skeleton, const hand::Posture& posture) {
  const hand::PosedSkeleton posed = hand::pose_skeleton(skeleton, posture);
  hand::Skeleton result = skeleton;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    geometry::Rigid3 carrier = f == 0 ? posed.thumb_metacarpal : geometry::Rigid3{};
    for (const auto& segment : hand::segments_of(static_cast<hand::Finger>(f))) {
      if (!segment) continue;
      Vec3& centre = result.joints[index_of(hand::joint_of(*segment))].centre;
      centre = carrier * centre;
      carrier = posed.segment[index_of(*segment)];
    }
    result.fingertips[f] = carrier * result.fingertips[f];
  }
  return result;
}

}  // namespace

std::vector<double> distances_to_scan(const std::vector<Vec3>& point,
                                      const std::vector<Vec3>& normal, const SkinScan& scan,
                                      const hand::Skeleton& skeleton, double reach) {
  const FitSurface fixed = scanned_surface(scan, skeleton);
  const geometry::ClosestPointQuery query(fixed.mesh);
  const std::vector<Vec3> fixed_normal = geometry::vertex_normals(fixed.mesh);
  std::vector<double> distance(point.size(), -1.0);
  parallel_for(static_cast<int>(point.size()), [&](int i) {
    const auto foot = query.closest(point[i], reach);
    if (!foot) return;
    Vec3 n = Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      const int u = fixed.mesh.triangles[foot->triangle][c];
      if (foot->weights[c] > 0.0 && fixed.is_silent[u]) return;
      n += foot->weights[c] * fixed_normal[u];
    }
    if (n.dot(normal[i]) > 0.0) distance[i] = foot->distance;
  });
  return distance;
}

std::vector<Vec3> bend_posed_skin(const hand::Hand& hand, const hand::Posture& posture,
                                  const SkinScan& scan, const std::vector<FitPin>& pins,
                                  const Progress& progress) {
  const FitSurface moving{
      {hand::pose_skin(hand, posture), hand.skin.triangles}, parts_of(hand.segment), cut_of(hand)};
  // The posed skin is near already; the scan shows how far muscle and folds differ.
  const NonrigidFitOptions options{
      .stiffness = 20.0, .last_stiffness = 1.0, .levels = 4, .rounds = 3};
  return fit_nonrigidly(moving, scanned_surface(scan, posed_centres(hand.skeleton, posture)), pins,
                        options, progress);
}

Vec3 fingertip_of(const std::vector<Vec3>& skin, const std::vector<hand::Segment>& segment,
                  const hand::Skeleton& skeleton, hand::Finger finger) {
  const auto chain = hand::segments_of(finger);
  const hand::Segment last = chain[2] ? *chain[2] : *chain[1];
  const Vec3& joint = skeleton.joint(hand::joint_of(last)).centre;
  double farthest = 0.0;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (segment[v] == last) farthest = std::max(farthest, (skin[v] - joint).norm());
  }
  // A fingertip is blunt: the middle of what is nearly as far away shows the direction best.
  constexpr double kCap = 1.0;  // mm
  Vec3 sum = Vec3::Zero();
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (segment[v] != last) continue;
    const double above = (skin[v] - joint).norm() - (farthest - kCap);
    if (above > 0.0) sum += above * (skin[v] - joint);
  }
  return joint + farthest * sum.normalized();
}

RegisteredSkin register_skin(const hand::Hand& model, const SkinScan& scan,
                             const hand::Skeleton& skeleton, const Progress& progress) {
  progress.update(0.0, "posing the model by the joints");
  RegisteredSkin result;
  result.start = posed_model(model, skeleton);
  FitSurface moving;
  moving.mesh = {skin_at(result.start, skeleton), model.skin.triangles};
  moving.is_silent = cut_of(model);
  moving.part = parts_of(model.segment);
  const FitSurface fixed = scanned_surface(scan, skeleton);
  require_near(moving.mesh, scan, skeleton);
  moving.mesh.vertices = fit_nonrigidly(moving, fixed, {}, {}, progress);
  part_crossings(moving.mesh);
  measure(moving, scan, skeleton, result);
  result.left_over = left_over_share(moving.mesh, fixed, skeleton);
  result.skin = std::move(moving.mesh.vertices);
  return result;
}

}  // namespace palmar::capture
