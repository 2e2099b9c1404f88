// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/reference_hand.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "hands/capture/axis_fit.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/rotation.h"

namespace palmar::capture {
namespace {

constexpr std::array<hand::Finger, hand::kFingerCount> kFingers = {
    hand::Finger::kThumb, hand::Finger::kIndex, hand::Finger::kMiddle, hand::Finger::kRing,
    hand::Finger::kLittle};

using Meshes = std::map<std::string, geometry::TriangleMesh>;

Meshes named_meshes(const ScanSurfaces& scan) {
  Meshes meshes;
  for (const ScannedBone& bone : scan.bones) {
    if (!bone.name.empty() && geometry::surface_area(bone.mesh) > 0.0)
      meshes.emplace(bone.name, bone.mesh);
  }
  return meshes;
}

Meshes named_meshes(const hand::Hand& model) {
  Meshes meshes;
  for (const hand::Bone& bone : model.bones) meshes.emplace(bone.name, bone.mesh);
  return meshes;
}

const geometry::TriangleMesh* find(const Meshes& meshes, const std::string& name) {
  const auto found = meshes.find(name);
  return found == meshes.end() ? nullptr : &found->second;
}

/// A point farther out along the ray than the bone: the next bone, or away from the palm.
Vec3 beyond(const Meshes& meshes, const std::vector<std::string>& ray, std::size_t k) {
  for (std::size_t j = k + 1; j < ray.size(); ++j) {
    if (const geometry::TriangleMesh* next = find(meshes, ray[j]))
      return geometry::centre_of_volume(*next);
  }
  const Vec3 here = geometry::centre_of_volume(meshes.at(ray[k]));
  for (std::size_t j = k; j-- > 0;) {
    if (const geometry::TriangleMesh* last = find(meshes, ray[j])) {
      return here + (here - geometry::centre_of_volume(*last));
    }
  }
  // A metacarpal alone: its head is farther from the carpus than its base.
  Vec3 carpus = Vec3::Zero();
  int count = 0;
  for (const auto& [name, mesh] : meshes) {
    if (name == ray[k] || !is_palm_bone(name)) continue;
    carpus += geometry::centre_of_volume(mesh);
    ++count;
  }
  return count > 0 ? (2.0 * here - carpus / count).eval() : here;
}

/// The skin farthest out along the last bone of a finger, as fingertip() of hand_frame.h has it;
/// the bone's own end without skin.
Vec3 skin_tip(const geometry::TriangleMesh& skin, const std::array<Vec3, 2>& ends) {
  constexpr double kFingerRadius = 12.0, kTissue = 10.0;  // mm; more than a fingertip has
  const Vec3 along = (ends[1] - ends[0]).normalized();
  Vec3 best = ends[1];
  for (const Vec3& v : skin.vertices) {
    const double y = along.dot(v - ends[1]);
    if (y <= along.dot(best - ends[1]) || y > kTissue) continue;
    if ((v - ends[1] - y * along).norm() < kFingerRadius) best = v;
  }
  return best;
}

/// What is seen of a ray's nodes; the rest is left out.
std::vector<std::optional<Vec3>> seen_nodes(const Meshes& meshes,
                                            const geometry::TriangleMesh& skin,
                                            hand::Finger finger) {
  const std::vector<std::string> ray = ray_of(finger);
  std::vector<std::optional<Vec3>> nodes(ray.size() + 1);
  for (std::size_t k = 0; k < ray.size(); ++k) {
    const geometry::TriangleMesh* bone = find(meshes, ray[k]);
    if (bone == nullptr) continue;
    const std::array<Vec3, 2> ends = ends_of(*bone, beyond(meshes, ray, k));
    if (!nodes[k]) nodes[k] = ends[0];
    if (k + 1 == ray.size()) {
      nodes[k + 1] = skin_tip(skin, ends);
    } else if (const geometry::TriangleMesh* next = find(meshes, ray[k + 1])) {
      nodes[k + 1] = head_centre(*bone, *next);
    } else {
      nodes[k + 1] = ends[1];
    }
  }
  return nodes;
}

/// `has_skin`: the finger ends at its skin, else at its last bone.
std::vector<Vec3> model_nodes(const hand::Hand& model, const Meshes& meshes, hand::Finger finger,
                              bool has_skin) {
  const std::vector<std::optional<hand::Segment>> chain = [&] {
    std::vector<std::optional<hand::Segment>> list;
    for (const auto& s : hand::segments_of(finger)) {
      if (s) list.push_back(s);
    }
    return list;
  }();
  std::vector<Vec3> nodes;
  const Vec3 first = model.skeleton.joint(hand::joint_of(*chain.front())).centre;
  if (finger == hand::Finger::kThumb) {
    nodes.push_back(model.skeleton.joint(hand::JointId::kThumbCmc).centre);
  } else if (const geometry::TriangleMesh* metacarpal = find(meshes, ray_of(finger).front())) {
    nodes.push_back(ends_of(*metacarpal, first)[0]);
  } else {
    const Vec3& wrist = model.skeleton.joint(hand::JointId::kWrist).centre;
    nodes.push_back(wrist + 0.35 * (first - wrist));
  }
  for (const auto& segment : chain)
    nodes.push_back(model.skeleton.joint(hand::joint_of(*segment)).centre);
  const Vec3& skin_tip = model.skeleton.fingertips[index_of(finger)];
  nodes.push_back(skin_tip);
  if (has_skin) return nodes;
  if (const geometry::TriangleMesh* last = find(meshes, ray_of(finger).back())) {
    nodes.back() = ends_of(*last, skin_tip)[1];
  }
  return nodes;
}

/// Similarity that places the model's palm on the scan's.
struct Similarity {
  double scale = 1.0;
  geometry::Rigid3 motion;
  Vec3 operator*(const Vec3& p) const { return motion * (scale * p); }
};

Similarity similarity_of(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  const auto n = static_cast<Eigen::Index>(from.size());
  Eigen::Matrix3Xd a(3, n), b(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.col(i) = from[i];
    b.col(i) = to[i];
  }
  const Eigen::Matrix4d m = Eigen::umeyama(a, b, true);
  Similarity result;
  result.scale = std::cbrt(m.topLeftCorner<3, 3>().determinant());
  const Eigen::Matrix3d turn = m.topLeftCorner<3, 3>() / result.scale;
  result.motion = {Quat(turn).normalized(), m.topRightCorner<3, 1>()};
  return result;
}

Similarity palm_similarity(const Meshes& scan, const Meshes& model) {
  std::vector<Vec3> from, to;
  int bones = 0;
  for (const auto& [name, mesh] : scan) {
    const geometry::TriangleMesh* other = find(model, name);
    if (other == nullptr || !is_palm_bone(name)) continue;
    from.push_back(geometry::centre_of_volume(*other));
    to.push_back(geometry::centre_of_volume(mesh));
    ++bones;
  }
  for (const hand::Finger finger : kFingers) {
    if (finger == hand::Finger::kThumb) continue;
    const std::vector<std::string> ray = ray_of(finger);
    const geometry::TriangleMesh* a = find(model, ray.front());
    const geometry::TriangleMesh* b = find(scan, ray.front());
    if (a == nullptr || b == nullptr) continue;
    const std::array<Vec3, 2> ends_a = ends_of(*a, beyond(model, ray, 0));
    const std::array<Vec3, 2> ends_b = ends_of(*b, beyond(scan, ray, 0));
    from.insert(from.end(), ends_a.begin(), ends_a.end());
    to.insert(to.end(), ends_b.begin(), ends_b.end());
  }
  if (bones < 3 || from.size() < 4) {
    throw InputError("reference scan: " + std::to_string(bones) +
                     " bones of the palm (metacarpals II to V, carpals) are named; at least 3, "
                     "among them a metacarpal, are needed to find where the hand is");
  }
  // Wrong names stand out once the others agree.
  Similarity fit = similarity_of(from, to);
  for (int pass = 0; pass < 4 && from.size() > 5; ++pass) {
    std::vector<double> distance;
    for (std::size_t i = 0; i < from.size(); ++i)
      distance.push_back((fit * from[i] - to[i]).norm());
    const auto worst = std::max_element(distance.begin(), distance.end());
    const auto k = worst - distance.begin();
    std::vector<double> sorted = distance;
    std::sort(sorted.begin(), sorted.end());
    if (*worst < std::max(10.0, 3.0 * sorted[sorted.size() / 2])) break;
    from.erase(from.begin() + k);
    to.erase(to.begin() + k);
    fit = similarity_of(from, to);
  }
  return fit;
}

RayNodes completed(const std::vector<std::optional<Vec3>>& seen, const std::vector<Vec3>& model,
                   const Similarity& hand_from_model) {
  RayNodes ray;
  geometry::Rigid3 turn;  // of the last link known both in the scan and in the model
  turn.rotation = hand_from_model.motion.rotation;
  for (std::size_t k = 0; k < model.size(); ++k) {
    ray.is_seen.push_back(seen[k].has_value());
    if (seen[k]) {
      ray.node.push_back(*seen[k]);
    } else if (k == 0) {
      ray.node.push_back(hand_from_model * model[0]);
    } else {
      const Vec3 link = hand_from_model.scale * (turn.rotation * (model[k] - model[k - 1]));
      ray.node.push_back(ray.node[k - 1] + link);
    }
    if (k > 0 && seen[k] && seen[k - 1]) {
      const Vec3 link = turn.rotation * (model[k] - model[k - 1]);
      turn.rotation =
          geometry::shortest_rotation(link, ray.node[k] - ray.node[k - 1]) * turn.rotation;
    }
  }
  return ray;
}

}  // namespace

std::array<Vec3, 2> ends_of(const geometry::TriangleMesh& bone, const Vec3& distal) {
  constexpr double kLong = 1.5;  // over the second extent; a distal phalanx of which only the tuft
                                 // is found is broader than long
  const std::array<Vec3, 6> points = moment_points(bone);
  const Vec3 centre = 0.5 * (points[4] + points[5]);
  const auto extent = [&](std::size_t k) -> Vec3 { return points[2 * k] - points[2 * k + 1]; };
  Vec3 axis = extent(2).normalized();
  if (extent(2).norm() < kLong * extent(1).norm()) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3 other = extent(k).normalized();
      if (std::abs(other.dot(distal - centre)) > std::abs(axis.dot(distal - centre))) axis = other;
    }
  }
  if (axis.dot(distal - centre) < 0.0) axis = -axis;
  double lowest = 0.0, highest = 0.0;
  for (const Vec3& v : bone.vertices) {
    lowest = std::min(lowest, axis.dot(v - centre));
    highest = std::max(highest, axis.dot(v - centre));
  }
  return {centre + lowest * axis, centre + highest * axis};
}

Vec3 head_centre(const geometry::TriangleMesh& bone, const geometry::TriangleMesh& distal) {
  const std::array<Vec3, 2> ends = ends_of(bone, geometry::centre_of_volume(distal));
  const Vec3 axis = (ends[1] - ends[0]).normalized();
  const double length = (ends[1] - ends[0]).norm();
  // Head: the last fifth. Its thickness is the smaller of two extents perpendicular to each other.
  const Vec3 e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  Eigen::AlignedBox2d box;
  for (const Vec3& v : bone.vertices) {
    const Vec3 d = v - ends[1];
    if (axis.dot(d) > -0.2 * length) box.extend(Eigen::Vector2d(e1.dot(d), e2.dot(d)));
  }
  double radius = 0.5 * box.sizes().minCoeff();
  const Eigen::Vector2d middle = box.center();
  radius = std::min(radius, 0.3 * length);
  const Vec3 plain = ends[1] - radius * axis + middle.x() * e1 + middle.y() * e2;

  const geometry::ClosestPointQuery query(distal);
  std::vector<double> gap;
  for (const Vec3& v : bone.vertices) gap.push_back(query.closest(v)->distance);
  constexpr double kBand = 2.5;  // mm; cartilage covers more, the gap's rim curves away
  const double least = *std::min_element(gap.begin(), gap.end());
  // |v|^2 = 2 c.v + (r^2 - |c|^2), linear in the unknowns.
  std::vector<Vec3> near;
  for (std::size_t i = 0; i < gap.size(); ++i) {
    if (gap[i] <= least + kBand) near.push_back(bone.vertices[i] - plain);
  }
  if (near.size() < 12) return plain;
  const auto n = static_cast<Eigen::Index>(near.size());
  Eigen::MatrixXd A(n, 4);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3& v = near[i];
    A.row(i) << 2.0 * v.transpose(), 1.0;
    b[i] = v.squaredNorm();
  }
  const Eigen::Vector4d x = A.colPivHouseholderQr().solve(b);
  const Vec3 centre = x.head<3>();
  const double squared = x[3] + centre.squaredNorm();
  const double sphere = squared > 0.0 ? std::sqrt(squared) : 0.0;
  const bool is_head =
      sphere > 0.5 * radius && sphere < 1.6 * radius && centre.norm() < 0.7 * radius;
  return is_head ? (plain + centre).eval() : plain;
}

Vec3 ReferenceHand::from_model(hand::Finger finger, std::size_t link, const Vec3& direction) const {
  const Quat turn = geometry::shortest_rotation(model_ray[index_of(finger)].direction(link),
                                                ray[index_of(finger)].direction(link));
  return turn * direction;
}

ReferenceHand place_reference(const ScanSurfaces& reference, const hand::Hand& model) {
  const Meshes scan = named_meshes(reference), drawn = named_meshes(model);
  const Similarity patient_from_model = palm_similarity(scan, drawn);
  ReferenceHand hand;
  hand.scale = patient_from_model.scale;

  std::array<std::vector<std::optional<Vec3>>, hand::kFingerCount> seen;
  for (const hand::Finger finger : kFingers)
    seen[index_of(finger)] = seen_nodes(scan, reference.skin, finger);
  const auto mcp = [&](hand::Finger finger) -> Vec3 {
    const std::optional<Vec3>& node = seen[index_of(finger)][1];
    return node ? *node
                : patient_from_model *
                      model.skeleton.joint(hand::joint_of(*hand::segments_of(finger)[0])).centre;
  };
  const Vec3 wrist = patient_from_model * model.skeleton.joint(hand::JointId::kWrist).centre;
  const Vec3 y = (mcp(hand::Finger::kMiddle) - wrist).normalized();
  const double radial = model.side == hand::Side::kLeft ? -1.0 : 1.0;  // x of a left hand is ulnar
  const Vec3 across = radial * (mcp(hand::Finger::kIndex) - mcp(hand::Finger::kLittle));
  const Vec3 x = (across - across.dot(y) * y).normalized();
  Eigen::Matrix3d axes;
  axes << x, y, x.cross(y);
  if (!axes.allFinite() || x.norm() < 0.5) {
    throw InputError("reference scan: wrist and knuckles coincide; no hand frame can be made");
  }
  hand.patient_from_hand = {Quat(axes).normalized(), wrist};
  const geometry::Rigid3 hand_from_patient = hand.patient_from_hand.inverse();

  for (const auto& [name, mesh] : scan) {
    ReferenceBone bone{mesh, {}};
    for (Vec3& v : bone.mesh.vertices) v = hand_from_patient * v;
    bone.points = moment_points(bone.mesh);
    hand.bones.emplace(name, std::move(bone));
  }
  Similarity hand_from_model = patient_from_model;
  hand_from_model.motion = hand_from_patient * patient_from_model.motion;
  for (const hand::Finger finger : kFingers) {
    for (std::optional<Vec3>& node : seen[index_of(finger)]) {
      if (node) node = hand_from_patient * *node;
    }
    const std::vector<Vec3> nodes =
        model_nodes(model, drawn, finger, !reference.skin.vertices.empty());
    hand.model_ray[index_of(finger)] = {nodes, std::vector<bool>(nodes.size(), true)};
    hand.ray[index_of(finger)] = completed(seen[index_of(finger)], nodes, hand_from_model);
  }
  return hand;
}

PostureMotions motions_in_hand(const ReferenceHand& hand, const std::vector<BoneMotion>& motions,
                               hand::ScanPosture posture) {
  const geometry::Rigid3 hand_from_patient = hand.patient_from_hand.inverse();
  std::vector<Vec3> from, to;
  for (const BoneMotion& motion : motions) {
    const auto bone = hand.bones.find(motion.bone);
    if (bone == hand.bones.end() || !is_palm_bone(motion.bone)) continue;
    const bool is_metacarpal = motion.bone.ends_with("_metacarpal");
    // A metacarpal's ends show more than a carpal, whose turn is hardly held: all six points.
    const std::size_t count = is_metacarpal ? 6 : 1;
    for (std::size_t k = 0; k < count; ++k) {
      const auto& p = bone->second.points;
      const Vec3 point =
          hand.patient_from_hand * (is_metacarpal ? p[k] : (0.5 * (p[0] + p[1])).eval());
      from.push_back(point);
      to.push_back(motion.posture_from_reference * point);
    }
  }
  if (from.size() < 3) {
    throw InputError(std::string(name_of(posture)) +
                     ": no bones of the palm were found again; at least three carpals or a "
                     "metacarpal are needed to find how the hand moved");
  }
  PostureMotions result;
  constexpr double kTolerance = 0.7;  // mm; a bone that moves farther doesn't count as the palm
  geometry::Rigid3 palm = align_points(from, to);
  for (int pass = 0; pass < 10; ++pass) {
    // Weights that a few bones on the move don't pull: (1 + (d / c)^2)^-2.
    std::vector<double> weight;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double ratio = (palm * from[i] - to[i]).norm() / kTolerance;
      weight.push_back(std::pow(1.0 + ratio * ratio, -2));
    }
    palm = align_points(from, to, weight);
  }
  result.posture_from_reference = palm;
  const geometry::Rigid3 back = hand_from_patient * palm.inverse();
  for (const BoneMotion& motion : motions) {
    result.bone[motion.bone] = back * motion.posture_from_reference * hand.patient_from_hand;
  }
  return result;
}

}  // namespace palmar::capture
