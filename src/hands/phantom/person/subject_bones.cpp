// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/subject_bones.h"
#include "hands/phantom/person/person_random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "hands/phantom/person/long_bone.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/smooth.h"
#include "palmar/hand/bones/bone_shape.h"

namespace palmar::phantom {
namespace {

constexpr std::uint64_t kStream = 20;
// Buryanov & Kotiuk 2010, Table I (66 adults): metacarpals I to V, soft tissue beyond the tip, mm;
// in hands whose third MCP joint lies 92.5 mm from the wrist joint.
constexpr std::array<double, hand::kFingerCount> kMetacarpal{46.22, 68.12, 64.60, 58.00, 53.69};
constexpr std::array<double, hand::kFingerCount> kTipTissue{5.67, 3.84, 3.95, 3.95, 3.73};
constexpr double kTypicalWristToMcp = 92.5;

struct Draft {
  SubjectBone bone;
  std::vector<Vec3> core;  ///< per vertex: where it is shrunk towards
  double thickness = 1.2;  ///< of the cortex in the middle, mm
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};

class BoneMaker {
 public:
  BoneMaker(const SubjectPerson& person, std::uint64_t seed)
      : person_(person), skin_(person.skin), random_(seed, kStream) {
    const hand::Skeleton& skeleton = person.skeleton;
    wrist_ = skeleton.joint(hand::JointId::kWrist).centre;
    scale_ =
        (skeleton.joint(hand::JointId::kMiddleMcp).centre - wrist_).norm() / kTypicalWristToMcp;
    for (const auto& [name, posture] : person.postures) {
      motions_.push_back(body_motions(person.joints, posture));
    }
    // Half way, where joints may be nearer to each other than at their ends.
    for (const auto& [name, posture] : person.postures) {
      hand::Posture half = person.reference;
      for (std::size_t k = 0; k < half.angle.size(); ++k) {
        half.angle[k] = 0.5 * (half.angle[k] + posture.angle[k]);
      }
      motions_.push_back(body_motions(person.joints, half));
    }
  }

  std::vector<SubjectBone> make() {
    for (int f = 0; f < hand::kFingerCount; ++f) make_ray(f);
    make_carpals();
    make_forearm();
    std::vector<SubjectBone> bones(placed_.size());
    parallel_for(static_cast<int>(placed_.size()), [&](int i) {
      placed_[i].bone.marrow = marrow_of(placed_[i]);
      bones[i] = std::move(placed_[i].bone);
    });
    return bones;
  }

 private:
  double varied(double deviation) {
    return 1.0 + deviation * std::clamp(random_.normal(), -2.5, 2.5);
  }

  void place(Draft draft);
  void draw_in(Draft& draft, const std::function<bool(const Vec3&)>& is_free) const;
  geometry::TriangleMesh marrow_of(const Draft& draft) const;
  void make_ray(int finger);
  void make_carpals();
  void make_forearm();
  Vec3 metacarpal_base(int finger, double head_radius) const;

  const SubjectPerson& person_;
  geometry::MeshDistance skin_;
  RandomStream random_;
  Vec3 wrist_;
  double scale_ = 1.0;
  std::vector<std::array<geometry::Rigid3, kBodyCount>> motions_;
  std::vector<Draft> placed_;
  std::vector<std::unique_ptr<geometry::MeshDistance>> distance_;
  std::array<Vec3, hand::kFingerCount> base_;
};

// Draws vertices in until each is free; neighbours follow, so that no dent has a sharp rim.
void BoneMaker::draw_in(Draft& draft, const std::function<bool(const Vec3&)>& is_free) const {
  geometry::TriangleMesh& mesh = draft.bone.bone.mesh;
  const int count = mesh.vertex_count();
  std::vector<double> share(count, 1.0);
  parallel_for(count, [&](int i) {
    const Vec3 &core = draft.core[i], &v = mesh.vertices[i];
    if (is_free(v)) return;
    double inside = 0.05, outside = 1.0;
    for (int k = 0; k < 9; ++k) {
      const double middle = 0.5 * (inside + outside);
      (is_free(core + middle * (v - core)) ? inside : outside) = middle;
    }
    share[i] = inside;
  });
  constexpr double kRelief = 0.05;  // per edge of 0.8 mm
  for (int pass = 0; pass < 8; ++pass) {
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        double& mine = share[t[k]];
        mine = std::min(mine, share[t[(k + 1) % 3]] + kRelief);
        mine = std::min(mine, share[t[(k + 2) % 3]] + kRelief);
      }
    }
  }
  for (int i = 0; i < count; ++i) {
    Vec3& v = mesh.vertices[i];
    v = draft.core[i] + share[i] * (v - draft.core[i]);
  }
}

void BoneMaker::place(Draft draft) {
  draw_in(draft, [&](const Vec3& p) {
    geometry::DistanceSample sample;
    skin_.sample({&p, 1}, kLeastSkinCover + 0.5, {&sample, 1});
    return sample.distance <= -kLeastSkinCover;
  });
  const Box3 box = geometry::bounding_box(draft.bone.bone.mesh);
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const int mine = draft.bone.body, other = placed_[i].bone.body;
    std::vector<geometry::Rigid3> relative{geometry::Rigid3{}};
    if (mine != other) {
      for (const auto& m : motions_) relative.push_back(m[other].inverse() * m[mine]);
    }
    const Box3 placed_box = distance_[i]->bounding_box();
    std::vector<geometry::Rigid3> near;
    for (const geometry::Rigid3& r : relative) {
      // The box's image in a box of its own, which is somewhat too large.
      const Vec3 half = r.rotation.toRotationMatrix().cwiseAbs() * (0.5 * box.sizes());
      const Vec3 middle = r * Vec3(box.center());
      const Box3 moved(middle - half, middle + half);
      if (moved.exteriorDistance(placed_box) < kLeastBoneGap) near.push_back(r);
    }
    if (near.empty()) continue;
    draw_in(draft, [&](const Vec3& p) {
      for (const geometry::Rigid3& r : near) {
        const Vec3 q = r * p;
        if (placed_box.exteriorDistance(q) > kLeastBoneGap) continue;
        geometry::DistanceSample sample;
        distance_[i]->sample({&q, 1}, kLeastBoneGap + 0.5, {&sample, 1});
        if (sample.distance < kLeastBoneGap) return false;
      }
      return true;
    });
  }
  distance_.push_back(std::make_unique<geometry::MeshDistance>(draft.bone.bone.mesh));
  placed_.push_back(std::move(draft));
}

geometry::TriangleMesh BoneMaker::marrow_of(const Draft& draft) const {
  // Cortex: thick in the shaft, 0.6 mm at the ends; never more than leaves a canal.
  geometry::TriangleMesh marrow = draft.bone.bone.mesh;
  const std::vector<Vec3> normal = geometry::vertex_normals(marrow);
  const Vec3 along = draft.to - draft.from;
  for (std::size_t i = 0; i < marrow.vertices.size(); ++i) {
    Vec3& v = marrow.vertices[i];
    const double t = along.dot(v - draft.from) / along.squaredNorm();
    const double middle = std::clamp(1.5 - std::abs(t - 0.5) / 0.25, 0.0, 1.0);
    const double thickness = 0.6 + (draft.thickness - 0.6) * middle;
    const double depth = (v - draft.core[i]).norm();
    v -= std::min(thickness, 0.45 * depth) * normal[i];
  }
  return marrow;
}

std::vector<Vec3> core_on_chord(const geometry::TriangleMesh& mesh, const Vec3& from,
                                const Vec3& to) {
  const double length = (to - from).norm();
  const Vec3 along = (to - from) / length;
  std::vector<Vec3> core;
  core.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    core.push_back(from + std::clamp(along.dot(v - from), 0.0, length) * along);
  }
  return core;
}

Vec3 BoneMaker::metacarpal_base(int f, double head_radius) const {
  const auto finger = static_cast<hand::Finger>(f);
  const Vec3 head = person_.joints.phalanx[index_of(*hand::segments_of(finger)[0])].centre;
  // Bases stand closer together than heads, and more dorsal.
  const double length = kMetacarpal[f] * scale_ - head_radius;
  Vec3 base(wrist_.x() + 0.58 * (head.x() - wrist_.x()), 0.0,
            wrist_.z() + 0.5 * (head.z() - wrist_.z()) - 0.5);
  const double aside = (head - base).x(), deep = (head - base).z();
  base.y() = head.y() - std::sqrt(std::max(1.0, length * length - aside * aside - deep * deep));
  return base;
}

void BoneMaker::make_ray(int f) {
  const auto finger = static_cast<hand::Finger>(f);
  const bool is_thumb = f == 0;
  const auto segments = hand::segments_of(finger);
  const int count = is_thumb ? 2 : 3;
  const std::string name(name_of(finger));
  const double w = person_.finger_width[f];
  const double build = varied(0.05);  // of this ray's bones
  std::array<JointSurface, 3> head;   // that the joint of each phalanx turns on
  std::array<Vec3, 4> node;
  for (int k = 0; k < count; ++k) {
    const RollingJoint& joint = person_.joints.phalanx[index_of(*segments[k])];
    node[k] = joint.centre;
    const double size = w * build * varied(0.03);
    head[k] = k == 0 ? JointSurface{0.38 * size, 0.41 * size, 0.0}
                     : JointSurface{(k == 1 ? 0.25 : 0.22) * size, (k == 1 ? 0.33 : 0.29) * size,
                                    0.055 * size * varied(0.2)};
  }
  const Vec3 tip = person_.skeleton.fingertips[f];
  node[count] = tip;

  const auto add = [&](const std::string& bone_name, std::optional<hand::Segment> segment, int body,
                       const LongBoneShape& shape, double thickness) {
    Draft draft;
    draft.bone.bone.name = bone_name;
    draft.bone.bone.segment = segment;
    draft.bone.bone.is_thumb_metacarpal = body == kThumbMetacarpalBody;
    draft.bone.body = body;
    draft.bone.bone.mesh = long_bone_mesh(shape);
    draft.from = shape.base + (shape.socket ? shape.socket->radius + shape.gap : shape.gap) *
                                  (shape.head - shape.base).normalized();
    draft.to = shape.head;
    const Vec3 inset =
        std::min(4.0, 0.3 * (draft.to - draft.from).norm()) * (draft.to - draft.from).normalized();
    draft.core = core_on_chord(draft.bone.bone.mesh, draft.from + inset, draft.to);
    draft.thickness = thickness * varied(0.08);
    place(std::move(draft));
  };

  LongBoneShape metacarpal;
  base_[f] = is_thumb ? person_.joints.cmc.centre : metacarpal_base(f, head[0].radius);
  metacarpal.base = base_[f];
  metacarpal.head = node[0];
  metacarpal.lateral = person_.joints.phalanx[index_of(*segments[0])].axis;
  metacarpal.gap = is_thumb ? 1.5 : 0.0;
  metacarpal.condyles = head[0];
  metacarpal.base_half_width = (is_thumb ? 0.40 : 0.42) * w * build * varied(0.05);
  metacarpal.base_half_depth = (is_thumb ? 0.40 : 0.46) * w * build * varied(0.05);
  metacarpal.waist_half_width = 0.24 * w * build * varied(0.05);
  metacarpal.waist_half_depth = 0.26 * w * build * varied(0.05);
  metacarpal.bow = 1.6 * scale_ * varied(0.25);
  metacarpal.ripple = 0.05;
  metacarpal.twist = 0.5 * varied(0.5);
  add(is_thumb ? "thumb_metacarpal" : name + "_metacarpal", hand::Segment::kPalm,
      is_thumb ? kThumbMetacarpalBody : 0, metacarpal, 1.7);

  for (int k = 0; k < count; ++k) {
    const bool is_last = k + 1 == count;
    const hand::Segment segment = *segments[k];
    LongBoneShape shape;
    shape.base = node[k];
    shape.socket = head[k];
    shape.gap = 1.5 * varied(0.08);
    shape.lateral = person_.joints.phalanx[index_of(segment)].axis;
    const JointSurface& on = head[k];
    shape.base_half_width = (k == 0 ? 1.0 : 1.08) * on.half_width * varied(0.03);
    shape.base_half_depth = (k == 0 ? 0.92 : 1.12) * on.radius * varied(0.03);
    shape.ripple = 0.04;
    shape.twist = varied(0.4);
    if (is_last) {
      const Vec3 along = (tip - node[k]).normalized();
      const double tuft = 0.15 * w * build * varied(0.05);
      // The tuft lies close under the nail, where the finger is thick enough for it.
      shape.head = sunk(skin_, tip - (kTipTissue[f] * scale_ + tuft) * along,
                        shape.lateral.cross(along), kLeastSkinCover + tuft, 3.0);
      shape.condyles = {tuft, 0.25 * w * build * varied(0.05), 0.0};
      shape.waist_half_width = 0.19 * w * build * varied(0.05);
      shape.waist_half_depth = 0.15 * w * build * varied(0.05);
      shape.bow = 0.3 * scale_;
    } else {
      shape.head = node[k + 1];
      shape.condyles = head[k + 1];
      shape.waist_half_width = 0.235 * w * build * varied(0.05);
      shape.waist_half_depth = 0.19 * w * build * varied(0.05);
      shape.bow = 1.0 * scale_ * varied(0.25);
    }
    const std::string which = is_last ? "distal" : (k == 0 ? "proximal" : "middle");
    add(name + "_" + which + "_phalanx", segment, static_cast<int>(segment), shape,
        is_last ? 0.9 : (k == 0 ? 1.5 : 1.3));
  }
}

// Carpals: each direction from a bone's middle ends at its own bumpy outline, or half way to a
// neighbour less half of the joint space.
void BoneMaker::make_carpals() {
  const Vec3 away = (person_.joints.cmc.centre -
                     person_.joints.phalanx[index_of(hand::Segment::kThumbProximal)].centre)
                        .normalized();
  struct Carpal {
    const char* name;
    Vec3 centre, half;
  };
  const auto below = [&](int f, double aside, double proximal) -> Vec3 {
    return base_[f] + scale_ * Vec3(aside, -proximal, 0.0);
  };
  const double carpus = base_[2].y() - wrist_.y();
  const auto row = [&](double aside, double share, double palmar) -> Vec3 {
    return wrist_ + Vec3(aside * scale_, share * carpus,
                         0.5 * (base_[2].z() - wrist_.z()) + palmar * scale_);
  };
  std::vector<Carpal> carpals{
      {"trapezium", person_.joints.cmc.centre + 7.0 * scale_ * away, {7.5, 7.5, 7.5}},
      {"trapezoid", below(1, -1.0, 7.0), {8.5, 9.0, 9.0}},
      {"capitate", below(2, -0.5, 10.0), {6.5, 12.0, 9.0}},
      {"hamate", below(3, -3.0, 9.0), {8.0, 10.0, 8.5}},
      {"scaphoid", row(12.0, 0.30, 1.5), {8.0, 10.0, 7.5}},
      {"lunate", row(-1.0, 0.22, 0.0), {7.5, 7.0, 8.5}},
      {"triquetrum", row(-13.0, 0.32, -1.0), {7.0, 7.5, 7.0}},
      {"pisiform", row(-16.0, 0.36, 9.0), {4.5, 5.0, 4.0}}};
  for (Carpal& c : carpals) {
    for (int d = 0; d < 3; ++d) {
      c.centre[d] += 0.5 * (varied(1.0) - 1.0);
      c.half[d] *= scale_ * varied(0.05);
    }
  }
  // Squarer than ellipsoids.
  const auto norm = [&](const Carpal& c, const Vec3& p) {
    return std::cbrt((p - c.centre).cwiseQuotient(c.half).cwiseAbs().array().cube().sum());
  };
  constexpr int kRings = 22, kAround = 28;
  const double gap = 1.5;
  for (std::size_t i = 0; i < carpals.size(); ++i) {
    const Carpal& c = carpals[i];
    std::array<Vec3, 5> bump;
    std::array<double, 5> height{};
    for (std::size_t k = 0; k < 5; ++k) {
      bump[k] = normal_vector(random_).normalized();
      height[k] = 0.13 * (varied(0.8) - 0.9);
    }
    const auto radius = [&](const Vec3& direction) {
      double size = 1.0;
      for (std::size_t k = 0; k < 5; ++k) {
        size += height[k] * std::exp(4.0 * (direction.dot(bump[k]) - 1.0));
      }
      double inside = 0.0, outside = 1.5 * c.half.maxCoeff();
      for (int step = 0; step < 24; ++step) {
        const double t = 0.5 * (inside + outside);
        const Vec3 p = c.centre + t * direction;
        const double own = norm(c, p);
        bool is_in = own < size;
        for (std::size_t j = 0; j < carpals.size() && is_in; ++j) {
          if (j == i) continue;
          const double mean = 0.5 * (c.half.mean() + carpals[j].half.mean());
          is_in = norm(carpals[j], p) - own > gap / mean;
        }
        (is_in ? inside : outside) = t;
      }
      return inside;
    };
    std::vector<Vec3> vertices;
    const auto push = [&](double polar, double angle) {
      const Vec3 direction(std::sin(polar) * std::cos(angle), std::cos(polar),
                           std::sin(polar) * std::sin(angle));
      vertices.push_back(c.centre + radius(direction) * direction);
    };
    push(0.0, 0.0);
    for (int ring = 0; ring < kRings; ++ring) {
      for (int k = 0; k < kAround; ++k) {
        push(std::numbers::pi * (ring + 1) / (kRings + 1), 2.0 * std::numbers::pi * k / kAround);
      }
    }
    push(std::numbers::pi, 0.0);
    Draft draft;
    draft.bone.bone.name = c.name;
    draft.bone.bone.segment = hand::Segment::kPalm;
    draft.bone.bone.mesh =
        geometry::smooth_taubin(hand::close_rings(std::move(vertices), kAround), {.rounds = 8});
    draft.core.assign(draft.bone.bone.mesh.vertices.size(), c.centre);
    draft.from = c.centre - Vec3(0.0, c.half.y(), 0.0);
    draft.to = c.centre + Vec3(0.0, c.half.y(), 0.0);
    draft.thickness = 0.7;
    place(std::move(draft));
  }
}

// Radius and ulna: flared distal ends, shafts that run on to the end of the forearm's skin.
void BoneMaker::make_forearm() {
  double end = 0.0;
  for (const Vec3& v : person_.skin.vertices) end = std::min(end, v.y());
  const auto make = [&](const char* name, double aside, double gap, double wide, double deep,
                        double shaft) {
    LongBoneShape shape;
    shape.lateral = Vec3::UnitX();
    shape.condyles = {deep * scale_ * varied(0.04), wide * scale_ * varied(0.04), 0.0};
    shape.head = wrist_ + Vec3(aside * scale_, -gap * scale_ - shape.condyles.radius, 0.0);
    shape.base = Vec3(wrist_.x() + 0.8 * aside * scale_, end, wrist_.z());
    while (shape.base.y() < wrist_.y() - 30.0 && skin_.at(shape.base).distance > -kLeastSkinCover) {
      shape.base.y() += 1.0;
    }
    shape.gap = 1.0;
    shape.waist_half_width = shaft * scale_ * varied(0.05);
    shape.waist_half_depth = 0.85 * shaft * scale_ * varied(0.05);
    shape.base_half_width = shape.waist_half_width;
    shape.base_half_depth = shape.waist_half_depth;
    shape.bow = 0.0;
    shape.ripple = 0.05;
    Draft draft;
    draft.bone.bone.name = name;
    draft.bone.bone.mesh = long_bone_mesh(shape);
    draft.from = shape.base;
    draft.to = shape.head;
    const Vec3 along = (shape.head - shape.base).normalized();
    draft.core =
        core_on_chord(draft.bone.bone.mesh, shape.base + (shape.gap + 4.0) * along, shape.head);
    draft.thickness = 2.0;
    place(std::move(draft));
  };
  make("radius", 7.0, -1.5, 12.5, 7.0, 7.0);
  make("ulna", -14.0, 2.0, 6.5, 5.5, 5.5);
}

}  // namespace

std::vector<SubjectBone> make_subject_bones(const SubjectPerson& person, std::uint64_t seed) {
  return BoneMaker(person, seed).make();
}

}  // namespace palmar::phantom
