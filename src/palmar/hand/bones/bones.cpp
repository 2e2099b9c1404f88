// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/bones/bones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/hand/bones/bone_shape.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::hand {
namespace {

constexpr double kJointGap = 1.2;            // mm, between the ends of two bones of a ray
constexpr double kTypicalWristToMcp = 92.5;  // mm; see bones.h
// Buryanov & Kotiuk 2010, Table I (66 adults), I to V: metacarpals, soft tissue beyond the tip, mm.
constexpr std::array<double, kFingerCount> kMetacarpalLength{46.22, 68.12, 64.60, 58.00, 53.69};
constexpr std::array<double, kFingerCount> kTipTissue{5.67, 3.84, 3.95, 3.95, 3.73};

// A bone being placed: its mesh and, per vertex, the point of its axis it is shrunk towards.
struct Draft {
  Bone bone;
  std::vector<Vec3> core;
};

std::vector<Vec3> core_on_axis(const geometry::TriangleMesh& mesh, const Vec3& from, const Vec3& to,
                               double inset_from, double inset_to) {
  const Vec3 along = (to - from).normalized();
  const double length = (to - from).norm();
  const double first = std::min(inset_from, 0.45 * length);
  const double last = length - std::min(inset_to, 0.45 * length);
  std::vector<Vec3> core;
  core.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    core.push_back(from + std::clamp(along.dot(v - from), first, last) * along);
  }
  return core;
}

// How much of the way from core to vertex is allowed: the largest share at which `is_free` holds.
template <typename IsFree>
double allowed_share(const Vec3& core, const Vec3& vertex, const IsFree& is_free) {
  if (is_free(vertex)) return 1.0;
  double lower = 0.1, upper = 1.0;  // never to a point
  for (int k = 0; k < 10; ++k) {
    const double middle = 0.5 * (lower + upper);
    (is_free(core + middle * (vertex - core)) ? lower : upper) = middle;
  }
  return lower;
}

// Draws a bone in until every vertex keeps its distance. Neighbouring vertices follow, so that the
// bone gets slimmer instead of dented.
template <typename IsFree>
void draw_in(Draft& draft, const IsFree& is_free) {
  geometry::TriangleMesh& mesh = draft.bone.mesh;
  std::vector<double> share(mesh.vertices.size());
  for (std::size_t i = 0; i < share.size(); ++i) {
    share[i] = allowed_share(draft.core[i], mesh.vertices[i], is_free);
  }
  constexpr double kRelief = 0.12;  // share that a neighbour may be larger
  for (int pass = 0; pass < 8; ++pass) {
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        double& mine = share[t[k]];
        mine = std::min(mine, share[t[(k + 1) % 3]] + kRelief);
        mine = std::min(mine, share[t[(k + 2) % 3]] + kRelief);
      }
    }
  }
  for (std::size_t i = 0; i < share.size(); ++i) {
    mesh.vertices[i] = draft.core[i] + share[i] * (mesh.vertices[i] - draft.core[i]);
  }
}

// Skin round a point of a finger: half breadth, and depth of skin towards palm and back.
struct Surroundings {
  double half_width = 0.0, palmar = 0.0, dorsal = 0.0;  // mm
};

class BoneMaker {
 public:
  BoneMaker(const geometry::TriangleMesh& skin, const Skeleton& skeleton)
      : skin_(skin), skeleton_(skeleton), creases_(skin, skeleton), distance_(skin) {
    const Vec3& wrist = skeleton.joint(JointId::kWrist).centre;
    scale_ = (skeleton.joint(JointId::kMiddleMcp).centre - wrist).norm() / kTypicalWristToMcp;
  }

  std::vector<Bone> make() {
    for (int f = 0; f < kFingerCount; ++f) make_ray(static_cast<Finger>(f));
    make_carpals();
    make_forearm();
    std::vector<Bone> bones;
    for (Draft& draft : placed_) bones.push_back(std::move(draft.bone));
    return bones;
  }

 private:
  Surroundings look_round(const Vec3& point, const Vec3& along, const Vec3& palmar) const {
    const Vec3 across = along.cross(palmar).normalized();
    const Vec3 up = across.cross(along);
    const std::vector<geometry::SectionCurve> curves = geometry::plane_section(skin_, point, along);
    Surroundings s;
    double best = std::numeric_limits<double>::max();
    for (const geometry::SectionCurve& curve : curves) {
      const double d = (geometry::curve_centre(curve) - point).norm();
      if (d >= best) continue;
      best = d;
      s = {};
      s.half_width = 0.5 * geometry::extent(curve.point, across);
      for (const Vec3& p : curve.point) {
        s.palmar = std::max(s.palmar, up.dot(p - point));
        s.dorsal = std::max(s.dorsal, -up.dot(p - point));
      }
    }
    return s;
  }

  // Shift towards the back of the hand that leaves a third of the soft tissue dorsal of a bone of
  // half depth `half_depth` and two thirds palmar; at most `limit`.
  static double dorsal_shift(const Surroundings& s, double half_depth, double limit) {
    const double tissue = std::max(0.0, s.palmar + s.dorsal - 2.0 * half_depth);
    return std::clamp(s.dorsal - half_depth - tissue / 3.0, 0.0, limit);
  }

  void place(Draft draft, double least_space = kLeastJointSpace) {
    draw_in(draft, [&](const Vec3& p) { return distance_.at(p).distance <= -kLeastSkinOverBone; });
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      Box3 box;
      for (const Vec3& v : draft.bone.mesh.vertices) box.extend(v);
      if (box.exteriorDistance(placed_distance_[i]->bounding_box()) > least_space) continue;
      draw_in(draft,
              [&](const Vec3& p) { return placed_distance_[i]->at(p).distance >= least_space; });
    }
    placed_distance_.push_back(std::make_unique<geometry::MeshDistance>(draft.bone.mesh));
    placed_.push_back(std::move(draft));
  }

  void make_ray(Finger finger);
  void make_carpals();
  void make_forearm();
  Vec3 metacarpal_base(Finger finger, double head_radius) const;
  void place_ellipsoid(const std::string& name, const Vec3& centre, const Vec3& half_axes);

  const geometry::TriangleMesh& skin_;
  const Skeleton& skeleton_;
  HandCreases creases_;
  geometry::MeshDistance distance_;
  double scale_ = 1.0;
  std::vector<Draft> placed_;
  std::vector<std::unique_ptr<geometry::MeshDistance>> placed_distance_;
  std::array<Vec3, kFingerCount> base_;  ///< bases of the metacarpals
};

Vec3 BoneMaker::metacarpal_base(Finger finger, double head_radius) const {
  const auto mcp = [&](Finger f) { return skeleton_.joint(joint_of(*segments_of(f)[0])).centre; };
  if (finger == Finger::kThumb) {
    const Vec3& cmc = skeleton_.joint(JointId::kThumbCmc).centre;
    return cmc + 0.5 * kJointGap * (mcp(finger) - cmc).normalized();
  }
  // The metacarpals converge: their bases stand at 0.6 of the spread of the heads, somewhat more
  // dorsal, each at its measured distance from its head.
  const Vec3& wrist = skeleton_.joint(JointId::kWrist).centre;
  const Vec3 head = mcp(finger);
  const double length = kMetacarpalLength[index_of(finger)] * scale_ - head_radius;
  Vec3 base(wrist.x() + 0.6 * (head.x() - wrist.x()), 0.0,
            wrist.z() + 0.5 * (head.z() - wrist.z()));
  const double aside = (head - base).x(), deep = (head - base).z();
  base.y() = head.y() - std::sqrt(std::max(1.0, length * length - aside * aside - deep * deep));
  return base;
}

void BoneMaker::make_ray(Finger finger) {
  const bool is_thumb = finger == Finger::kThumb;
  const auto chain = segments_of(finger);
  const std::string name(name_of(finger));
  const int count = is_thumb ? 2 : 3;
  const int first_node = is_thumb ? 2 : 1;  // of the ray in creases.h: MP or MCP
  const Vec3& tip = skeleton_.fingertips[index_of(finger)];
  // Joint centres from MP or MCP on, then the tip.
  std::vector<Vec3> node;
  for (int k = 0; k < count; ++k) node.push_back(skeleton_.joint(joint_of(*chain[k])).centre);
  node.push_back(tip);
  const auto along = [&](int k) { return (node[k + 1] - node[k]).normalized(); };

  // Breadth of the finger at its interphalangeal joints, free of the webs, sets all widths.
  std::vector<double> width(count, 0.0);
  std::vector<Surroundings> round(count);
  for (int k = 1; k < count; ++k) {
    round[k] = look_round(node[k], (along(k - 1) + along(k)).normalized(),
                          creases_.palmar_direction(finger, first_node + k));
    width[k] = 2.0 * round[k].half_width;
  }
  width[0] = width[1];
  // Radius of the head that each joint centre sits in, and its half width.
  std::vector<double> radius, half_width;
  for (int k = 0; k < count; ++k) {
    radius.push_back((k == 0 ? 0.38 : 0.25) * width[k]);
    half_width.push_back((k == 0 ? 0.40 : 0.32) * width[k]);
  }
  // The joints of the bones lie a little dorsal of the centres that the skin turns about.
  std::vector<Vec3> centre = node;
  for (int k = 1; k < count; ++k) {
    const double shift = dorsal_shift(round[k], radius[k], 1.5 * scale_);
    centre[k] -= shift * creases_.palmar_direction(finger, first_node + k);
  }

  // Metacarpal.
  const Vec3 base = metacarpal_base(finger, radius[0]);
  base_[index_of(finger)] = base;
  const Vec3 shaft = (centre[0] - base).normalized();
  Vec3 palmar = is_thumb ? creases_.palmar_direction(finger, 1) : Vec3::UnitZ();
  const double w = width[0];
  BoneShape metacarpal{.from = base,
                       .to = centre[0] + radius[0] * shaft,
                       .palmar = palmar,
                       .station = {{0.05, 0.36 * w, 0.36 * w},
                                   {0.5, 0.24 * w, 0.24 * w},
                                   {0.88, half_width[0], radius[0]}},
                       .base_cap = 2.5 * scale_,
                       .head_cap = radius[0],
                       .groove = 0.0,
                       .rings = 20,
                       .around = 20};
  Draft draft;
  draft.bone.name = is_thumb ? "thumb_metacarpal" : name + "_metacarpal";
  draft.bone.segment = Segment::kPalm;
  draft.bone.is_thumb_metacarpal = is_thumb;
  draft.bone.mesh = bone_mesh(metacarpal);
  draft.core = core_on_axis(draft.bone.mesh, metacarpal.from, metacarpal.to, 3.0, radius[0]);
  place(std::move(draft));

  for (int k = 0; k < count; ++k) {
    const bool is_last = k + 1 == count;
    Vec3 end = centre[k + 1];
    const Vec3 direction = (end - centre[k]).normalized();
    palmar = (creases_.palmar_direction(finger, first_node + k) +
              creases_.palmar_direction(finger, first_node + k + 1))
                 .normalized();
    const double here = width[k];
    BoneShape shape{.from = centre[k] + (radius[k] + kJointGap) * direction,
                    .to = {},
                    .palmar = palmar,
                    .station = {},
                    .base_cap = 2.0 * scale_,
                    .head_cap = 0.0,
                    .groove = 0.0,
                    .rings = 18,
                    .around = 20};
    if (is_last) {
      shape.to = end - kTipTissue[index_of(finger)] * scale_ * direction;
      shape.station = {{0.08, 0.34 * here, 0.24 * here},
                       {0.55, 0.16 * here, 0.15 * here},
                       {0.85, 0.25 * here, 0.15 * here}};
      shape.head_cap = 0.2 * here;
    } else {
      shape.to = end + radius[k + 1] * direction;
      const double next = width[k + 1];
      const double flare = k == 0 ? 0.42 : 0.38;
      shape.station = {{0.06, flare * here, 0.8 * flare * here},
                       {0.55, 0.26 * next, 0.22 * next},
                       {0.90, half_width[k + 1], radius[k + 1]}};
      shape.head_cap = radius[k + 1];
      shape.groove = 0.15 * radius[k + 1];
    }
    Draft phalanx;
    const std::string which = is_last ? "distal" : (k == 0 ? "proximal" : "middle");
    phalanx.bone.name = name + "_" + which + "_phalanx";
    phalanx.bone.segment = chain[k];
    phalanx.bone.mesh = bone_mesh(shape);
    phalanx.core =
        core_on_axis(phalanx.bone.mesh, shape.from, shape.to, 2.0 * scale_, shape.head_cap);
    place(std::move(phalanx));
  }
}

void BoneMaker::place_ellipsoid(const std::string& name, const Vec3& centre,
                                const Vec3& half_axes) {
  Draft draft;
  draft.bone.name = name;
  draft.bone.segment = Segment::kPalm;
  draft.bone.mesh = ellipsoid_mesh(centre, Eigen::Matrix3d::Identity(), half_axes, 13, 18);
  draft.core.assign(draft.bone.mesh.vertices.size(), centre);
  place(std::move(draft));
}

void BoneMaker::make_carpals() {
  // Two rows between the forearm and the bases of the metacarpals: the distal row just proximal of
  // the bases, the proximal row half way to the wrist joint.
  const Vec3& wrist = skeleton_.joint(JointId::kWrist).centre;
  const Vec3& cmc = skeleton_.joint(JointId::kThumbCmc).centre;
  const double s = creases_.radial_sign();
  const auto below = [&](Finger f, double aside, double proximal) -> Vec3 {
    return base_[index_of(f)] + scale_ * Vec3(s * aside, -proximal, 0.0);
  };
  const double carpus = base_[index_of(Finger::kMiddle)].y() - wrist.y();
  const auto proximal_row = [&](double aside, double share, double palmar) -> Vec3 {
    return wrist + Vec3(s * aside * scale_, share * carpus,
                        0.5 * (base_[index_of(Finger::kMiddle)].z() - wrist.z()) + palmar * scale_);
  };
  const Vec3 away = (cmc - skeleton_.joint(JointId::kThumbMp).centre).normalized();
  place_ellipsoid("trapezium", cmc + 7.0 * scale_ * away, scale_ * Vec3(6.5, 6.5, 6.5));
  place_ellipsoid("trapezoid", below(Finger::kIndex, 0.0, 8.0), scale_ * Vec3(5.5, 7.0, 7.0));
  place_ellipsoid("capitate", below(Finger::kMiddle, -0.5, 10.5), scale_ * Vec3(6.0, 11.0, 8.0));
  place_ellipsoid("hamate", below(Finger::kRing, -3.0, 9.0), scale_ * Vec3(7.5, 9.0, 7.5));
  place_ellipsoid("scaphoid", proximal_row(12.0, 0.30, 1.5), scale_ * Vec3(7.0, 8.5, 6.5));
  place_ellipsoid("lunate", proximal_row(-1.0, 0.24, 0.0), scale_ * Vec3(7.0, 6.5, 7.5));
  place_ellipsoid("triquetrum", proximal_row(-13.0, 0.34, 0.0), scale_ * Vec3(6.5, 7.0, 6.5));
  place_ellipsoid("pisiform", proximal_row(-16.0, 0.36, 10.0), scale_ * Vec3(4.0, 4.5, 3.5));
}

void BoneMaker::make_forearm() {
  // The stub holds only the ends of the two bones.
  const Vec3& wrist = skeleton_.joint(JointId::kWrist).centre;
  const double s = creases_.radial_sign();
  const auto make = [&](const char* name, double aside, double gap, double half_width,
                        double half_depth) {
    const Vec3 distal = wrist + Vec3(s * aside * scale_, -gap * scale_, 0.0);
    // The stub may be cut off at a slant: each bone ends where it would come too near to the cut.
    const double depth = kLeastSkinOverBone + 0.4 * half_depth * scale_;
    Vec3 proximal = distal;
    while (distance_.at(proximal).distance < -depth) proximal.y() -= 0.5;
    if (distal.y() - proximal.y() < 4.0 * scale_) return;  // hardly any forearm
    BoneShape shape{.from = proximal,
                    .to = distal,
                    .palmar = Vec3::UnitZ(),
                    .station = {{0.1, 0.85 * half_width * scale_, 0.9 * half_depth * scale_},
                                {0.9, half_width * scale_, half_depth * scale_}},
                    .base_cap = 2.0 * scale_,
                    .head_cap = 3.0 * scale_,
                    .groove = 0.0,
                    .rings = 12,
                    .around = 20};
    Draft draft;
    draft.bone.name = name;
    draft.bone.mesh = bone_mesh(shape);
    draft.core = core_on_axis(draft.bone.mesh, shape.from, shape.to, 4.0, 4.0);
    place(std::move(draft));
  };
  make("radius", 7.0, 1.0, 11.5, 7.0);
  make("ulna", -13.5, 3.0, 6.0, 6.0);
}

}  // namespace

std::vector<Bone> make_bones(const geometry::TriangleMesh& skin, const Skeleton& skeleton) {
  return BoneMaker(skin, skeleton).make();
}

}  // namespace palmar::hand
