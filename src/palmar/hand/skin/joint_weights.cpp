// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/joint_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/smooth_step.h"

namespace palmar::hand {
namespace {

using Field = std::vector<double>;  ///< one number per vertex

/// Where the skin of a joint turns from steady to moving, mm.
struct Band {
  double palmar_half = 9.0;                       ///< set from the depth of the joint
  double dorsal_half = 1.0;                       ///< first as a multiple of the palmar one
  double palmar_shift = 0.0, dorsal_shift = 0.0;  ///< distally
  double most_bulge = 1.4;  ///< mm/rad; more makes a visible ball of an interphalangeal joint
};

/// Axes of a joint in the reference posture.
struct JointAxes {
  Vec3 centre, along, palmar;
  double depth = 8.0;  ///< over which the band changes from dorsal to palmar, mm
};

/// w1: 0 on the steady side, 1 on the rigid side.
double along_bone(const JointAxes& axes, const Band& band, const Vec3& point) {
  const Vec3 arm = point - axes.centre;
  const double side = geometry::smooth_step(0.5 + 0.5 * arm.dot(axes.palmar) / axes.depth);
  const double half = band.dorsal_half + side * (band.palmar_half - band.dorsal_half);
  const double shift = band.dorsal_shift + side * (band.palmar_shift - band.dorsal_shift);
  return std::clamp(0.5 + 0.5 * (arm.dot(axes.along) - shift) / half, 0.0, 1.0);
}

/// Distance to a segment of bone with its skin's half thickness taken as unit.
double scaled_distance(const Vec3& a, const Vec3& b, double radius_a, double radius_b,
                       const Vec3& point) {
  const Vec3 ab = b - a;
  const double t = std::clamp((point - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (point - a - t * ab).norm() / (radius_a + t * (radius_b - radius_a));
}

struct Chain {
  std::vector<Vec3> node;
  std::vector<double> radius;  ///< half thickness of the flesh about the node, mm
};

double scaled_distance(const Chain& chain, const Vec3& point, std::size_t first = 0) {
  double best = 1e30;
  for (std::size_t k = first; k + 1 < chain.node.size(); ++k) {
    best = std::min(best, scaled_distance(chain.node[k], chain.node[k + 1], chain.radius[k],
                                          chain.radius[k + 1], point));
  }
  return best;
}

/// Bones of the five rays from the carpus (CMC for the thumb) to the tip.
std::array<Chain, kFingerCount> make_chains(const Skeleton& skeleton) {
  std::array<Chain, kFingerCount> chains;
  const auto centre = [&](JointId id) { return skeleton.joint(id).centre; };
  chains[0].node = {centre(JointId::kThumbCmc), centre(JointId::kThumbMp),
                    centre(JointId::kThumbIp), skeleton.fingertips[0]};
  chains[0].radius = {14, 12, 10, 8};
  for (int f = 1; f < kFingerCount; ++f) {
    const int mcp = static_cast<int>(JointId::kIndexMcp) + 3 * (f - 1);
    const Vec3 head = centre(static_cast<JointId>(mcp));
    // Metacarpal bases stand in the same order as the heads, at a third of the way from the wrist.
    const Vec3 base(0.45 * head.x(), 0.33 * head.y(), 0.8 * head.z());
    chains[f].node = {base, head, centre(static_cast<JointId>(mcp + 1)),
                      centre(static_cast<JointId>(mcp + 2)), skeleton.fingertips[f]};
    chains[f].radius = {11, 10.5, 8.5, 7.5, 6.5};
  }
  return chains;
}

/// Mean with the neighbours, `rounds` times, where `free` allows.
void diffuse(Field& field, const std::vector<std::vector<int>>& neighbours,
             const std::vector<char>& free, int rounds) {
  Field next = field;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t v = 0; v < field.size(); ++v) {
      if (!free[v]) continue;
      double sum = 0;
      for (const int n : neighbours[v]) sum += field[n];
      next[v] = 0.5 * field[v] + 0.5 * sum / static_cast<double>(neighbours[v].size());
    }
    std::swap(field, next);
  }
}

/// Diffusion never quite ends; cut its tails off, so that what is far away stays exactly at rest
/// (or moves exactly rigidly). Symmetric: two shares that add up to 1 still do.
void cut_tails(Field& share) {
  constexpr double kTail = 0.02;
  for (double& value : share) {
    value = std::clamp((value - kTail) / (1.0 - 2.0 * kTail), 0.0, 1.0);
  }
}

JointAxes axes_at(const Skeleton& skeleton, JointId id, const Vec3& proximal, const Vec3& distal,
                  Dof flexion) {
  JointAxes axes;
  axes.centre = skeleton.joint(id).centre;
  axes.along =
      ((axes.centre - proximal).normalized() + (distal - axes.centre).normalized()).normalized();
  axes.palmar = skeleton.dof(flexion).axis.cross(axes.along).normalized();
  return axes;
}

/// Greatest height of the skin above the joint's axis near its own plane, mm.
double palmar_depth(const geometry::TriangleMesh& skin, const JointAxes& axes, const Field& share) {
  double depth = 0;
  for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
    const Vec3 arm = skin.vertices[v] - axes.centre;
    if (share[v] > 0.5 && std::abs(arm.dot(axes.along)) < 4.0 && arm.norm() < 30.0) {
      depth = std::max(depth, arm.dot(axes.palmar));
    }
  }
  return depth;
}

JointWeights collect(JointId id, const Field& w1, const Field& w2) {
  JointWeights weights;
  weights.joint = id;
  for (std::size_t v = 0; v < w1.size(); ++v) {
    if (w1[v] * w2[v] <= 0) continue;
    weights.vertex.push_back(static_cast<int>(v));
    weights.w1.push_back(w1[v]);
    weights.w2.push_back(std::min(w2[v], 1.0));
  }
  return weights;
}

class WeightMaker {
 public:
  WeightMaker(const geometry::TriangleMesh& skin, const Skeleton& skeleton)
      : skin_(skin), skeleton_(skeleton), chains_(make_chains(skeleton)) {
    geometry::require_closed_manifold(skin, "skin");
    normal_ = geometry::vertex_normals(skin);
    neighbours_ = geometry::vertex_neighbours(geometry::build_topology(skin));
    find_owners();
  }

  std::vector<JointWeights> make() const {
    std::vector<JointWeights> result;
    result.push_back(wrist());
    result.push_back(thumb_cmc());
    const Vec3 cmc = centre(JointId::kThumbCmc), mp = centre(JointId::kThumbMp),
               ip = centre(JointId::kThumbIp);
    result.push_back(hinge(JointId::kThumbMp, Dof::kThumbMpFlexion, cmc, ip, own_[0], 1.05, {}));
    result.push_back(hinge(JointId::kThumbIp, Dof::kThumbIpFlexion, mp, skeleton_.fingertips[0],
                           own_[0], 1.15, {}));
    for (int f = 1; f < kFingerCount; ++f) add_finger(f, result);
    return result;
  }

 private:
  const Vec3& centre(JointId id) const { return skeleton_.joint(id).centre; }

  /// Which ray each vertex lies on, first hard, then smooth in palm and webs.
  void find_owners() {
    const std::size_t n = skin_.vertices.size();
    for (Field& field : own_) field.assign(n, 0.0);
    for (Field& field : hard_) field.assign(n, 0.0);
    for (std::size_t v = 0; v < n; ++v) {
      std::size_t best = 0;
      double nearest = 1e30;
      for (std::size_t f = 0; f < chains_.size(); ++f) {
        const double d = scaled_distance(chains_[f], skin_.vertices[v]);
        if (d < nearest) {
          nearest = d;
          best = f;
        }
      }
      hard_[best][v] = 1.0;
    }
    own_ = hard_;
    const std::vector<char> everywhere(n, 1);
    for (Field& share : own_) {
      diffuse(share, neighbours_, everywhere, 12);
      cut_tails(share);
    }
  }

  JointWeights hinge(JointId id, Dof flexion, const Vec3& proximal, const Vec3& distal,
                     const Field& share, double slack, Band band) const {
    JointAxes axes = axes_at(skeleton_, id, proximal, distal, flexion);
    const double depth = palmar_depth(skin_, axes, share);
    const JointDof& dof = skeleton_.dof(flexion);
    band.palmar_half = slack * 0.5 * depth * (dof.upper - dof.reference);
    // Wider over a knuckle than under it: rounder, and each mm^2 of (dorsal half)^2 - (palmar
    // half)^2 gives back theta / 6 mm^3 per mm of breadth.
    band.dorsal_half *= band.palmar_half;
    axes.depth = depth;
    Field w1(skin_.vertices.size());
    for (std::size_t v = 0; v < w1.size(); ++v) {
      w1[v] = share[v] > 0 ? along_bone(axes, band, skin_.vertices[v]) : 0.0;
    }
    JointWeights weights = collect(id, w1, share);
    add_bulge(axes, band, dof, weights);
    return weights;
  }

  /// Volume of the whole skin with one joint bent to its limit and bulged by `amplitude`.
  double bent_volume(const JointWeights& weights, const JointDof& dof, double amplitude) const {
    geometry::TriangleMesh bent = skin_;
    const double turn = dof.upper - dof.reference;
    for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
      Vec3& v = bent.vertices[weights.vertex[k]];
      v += amplitude * turn * weights.bulge[k];
      v = geometry::Rigid3::about_axis(dof.axis, dof.centre, weights.w1[k] * weights.w2[k] * turn) *
          v;
    }
    return geometry::signed_volume(bent);
  }

  /// Flesh pressed out of the palmar fold comes out at the sides and over the knuckle, as much as
  /// keeps the volume at the limit of flexion. (To first order, eq. 2-7 loses theta z A: turn times
  /// how far palmar of the axis the centroid of the section lies times the section's area.)
  void add_bulge(const JointAxes& axes, const Band& band, const JointDof& dof,
                 JointWeights& weights) const {
    const double half = std::max(band.palmar_half, band.dorsal_half);
    for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
      const int v = weights.vertex[k];
      const Vec3 arm = skin_.vertices[v] - axes.centre;
      const double t = arm.dot(axes.along) / half;
      const double bump = t * t < 1 ? (1 - t * t) * (1 - t * t) : 0.0;
      const double dorsal = geometry::smooth_step(0.75 - 0.5 * arm.dot(axes.palmar) / axes.depth);
      weights.bulge.emplace_back(bump * dorsal * weights.w2[k] * normal_[v]);
    }
    const double straight = geometry::signed_volume(skin_);
    const double bent = bent_volume(weights, dof, 0.0);
    const double gain = bent_volume(weights, dof, 1.0) - bent;
    const double amplitude =
        gain > 0 ? std::clamp((straight - bent) / gain, 0.0, band.most_bulge) : 0.0;
    for (Vec3& bulge : weights.bulge) bulge *= amplitude;
  }

  void add_finger(int f, std::vector<JointWeights>& result) const {
    const int j = static_cast<int>(JointId::kIndexMcp) + 3 * (f - 1);
    const int d = static_cast<int>(Dof::kIndexMcpFlexion) + 4 * (f - 1);
    const auto joint = [&](int k) { return static_cast<JointId>(j + k); };
    const Chain& chain = chains_[f];
    result.push_back(hinge(joint(0), static_cast<Dof>(d), chain.node[0], chain.node[2], own_[f],
                           1.1, {.dorsal_half = 1.25, .palmar_shift = 4.0, .most_bulge = 3.0}));
    result.push_back(
        hinge(joint(1), static_cast<Dof>(d + 2), chain.node[1], chain.node[3], hard_[f], 1.2, {}));
    result.push_back(
        hinge(joint(2), static_cast<Dof>(d + 3), chain.node[2], chain.node[4], hard_[f], 1.2, {}));
  }

  JointWeights thumb_cmc() const {
    Field w1(skin_.vertices.size(), 0.0), w2(skin_.vertices.size(), 1.0);
    const Vec3 cmc = centre(JointId::kThumbCmc), mp = centre(JointId::kThumbMp);
    const Vec3 along = (mp - cmc).normalized();
    const Chain& thumb = chains_[0];
    for (std::size_t v = 0; v < w1.size(); ++v) {
      const Vec3& p = skin_.vertices[v];
      const double to_thumb = scaled_distance(thumb, p);
      double to_palm = 1e30;
      for (std::size_t f = 1; f < chains_.size(); ++f) {
        to_palm = std::min(to_palm, scaled_distance(chains_[f], p));
      }
      w2[v] = geometry::smooth_step((to_palm / (to_palm + to_thumb) - 0.36) / 0.26);
      const double y = (p - cmc).dot(along);
      w1[v] = geometry::smooth_step((y + 8.0) / 34.0);  // the thumb ball takes up the turn
    }
    const std::vector<char> everywhere(w1.size(), 1);
    diffuse(w2, neighbours_, everywhere, 10);
    cut_tails(w2);
    return collect(JointId::kThumbCmc, w1, w2);
  }

  JointWeights wrist() const {
    Field w1(skin_.vertices.size()), w2(skin_.vertices.size(), 1.0);
    for (std::size_t v = 0; v < w1.size(); ++v) {
      w1[v] = std::clamp(0.5 - skin_.vertices[v].y() / 32.0, 0.0, 1.0);
    }
    return collect(JointId::kWrist, w1, w2);
  }

  const geometry::TriangleMesh& skin_;
  const Skeleton& skeleton_;
  std::array<Chain, kFingerCount> chains_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<Vec3> normal_;              ///< of the skin
  std::array<Field, kFingerCount> hard_;  ///< 1 on the vertices of a ray
  std::array<Field, kFingerCount> own_;   ///< the same, smooth in palm and webs
};

}  // namespace

std::vector<JointWeights> make_joint_weights(const geometry::TriangleMesh& skin,
                                             const Skeleton& skeleton) {
  return WeightMaker(skin, skeleton).make();
}

}  // namespace palmar::hand
