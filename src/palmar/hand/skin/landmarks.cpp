// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/landmarks.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"

namespace palmar::hand {
namespace {

constexpr double kNailShare = 0.6;  // of the way from the last joint to the fingertip
/// Proximal of the wrist joint's centre, of the way from there to the third MCP joint: 8 mm.
constexpr double kStyloidShare = 0.09;

enum class Kind { kJoint, kPhalanx, kNail, kTip, kMetacarpal, kStyloid };
enum class Way { kDorsal, kPalmar, kRadial, kUlnar, kCentre };

/// What a name means.
struct Meaning {
  Kind kind{};
  Finger finger{};
  int place = 0;  ///< joint or phalanx from proximal; of a metacarpal: head, middle, base
  Way way = Way::kDorsal;
};

std::string text(std::string_view view) { return std::string(view); }

/// Sides that a place on a finger has; between two fingers, and inside the palm, there is none.
/// `place`: 0 the joint in the palm, 1 the phalanx beyond it, 2 further out.
std::vector<std::pair<std::string, Way>> ways_of(Finger finger, int place) {
  std::vector<std::pair<std::string, Way>> ways = {{"dorsal", Way::kDorsal}};
  if (finger == Finger::kThumb) {
    if (place > 0) ways.emplace_back("palmar", Way::kPalmar);
    return ways;
  }
  ways.emplace_back("palmar", Way::kPalmar);
  if (place > 1 || finger == Finger::kIndex) ways.emplace_back("radial", Way::kRadial);
  if (place > 1 || finger == Finger::kLittle) ways.emplace_back("ulnar", Way::kUlnar);
  return ways;
}

/// The joints of a finger by name, from proximal.
std::array<const char*, 3> joints_of(Finger finger) {
  return finger == Finger::kThumb ? std::array<const char*, 3>{"cmc", "mp", "ip"}
                                  : std::array<const char*, 3>{"mcp", "pip", "dip"};
}

std::map<std::string, Meaning> make_meanings() {
  constexpr std::array<const char*, 5> kOrdinal = {"first", "second", "third", "fourth", "fifth"};
  constexpr std::array<const char*, 3> kMetacarpal = {"head", "middle", "base"};
  std::map<std::string, Meaning> all;
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const std::string name = text(name_of(finger)) + "_";
    for (int j = 0; j < 3; ++j) {
      const std::string joint = name + joints_of(finger)[j] + "_";
      for (const auto& [way, value] : ways_of(finger, j == 0 ? 0 : 2)) {
        all[joint + way] = {Kind::kJoint, finger, j, value};
      }
      all[joint + "centre"] = {Kind::kJoint, finger, j, Way::kCentre};
      all[text(kOrdinal[f]) + "_metacarpal_" + kMetacarpal[j]] = {Kind::kMetacarpal, finger, j,
                                                                  Way::kDorsal};
    }
    const auto segments = segments_of(finger);
    for (int k = 0; k < 3; ++k) {
      if (!segments[k]) continue;
      const std::string phalanx = text(name_of(*segments[k])) + "_";
      for (const auto& [way, value] : ways_of(finger, k + 1)) {
        all[phalanx + way] = {Kind::kPhalanx, finger, k, value};
      }
    }
    all[name + "nail"] = {Kind::kNail, finger, 0, Way::kDorsal};
    all[name + "tip"] = {Kind::kTip, finger, 0, Way::kDorsal};
  }
  all["radial_styloid"] = {Kind::kStyloid, Finger::kThumb, 0, Way::kRadial};
  all["ulnar_styloid"] = {Kind::kStyloid, Finger::kLittle, 0, Way::kUlnar};
  return all;
}

const std::map<std::string, Meaning>& meanings() {
  static const std::map<std::string, Meaning> all = make_meanings();
  return all;
}

double radial_sign(const Hand& hand) { return hand.side == Side::kRight ? 1.0 : -1.0; }

/// Joints of a finger from proximal, then its tip.
struct Ray {
  std::array<Vec3, 4> node;
  std::array<Vec3, 3> axis;  ///< of flexion
};

Ray ray_of(const Hand& hand, Finger finger) {
  Ray ray;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::string name = text(name_of(finger)) + "_" + joints_of(finger)[j];
    const Joint& joint = hand.skeleton.joint(*joint_named(name));
    ray.node[j] = joint.centre;
    for (const JointDof& dof : joint.dofs) {
      if (name_of(dof.dof).ends_with("flexion")) ray.axis[j] = dof.axis;
    }
  }
  ray.node[3] = hand.skeleton.fingertips[index_of(finger)];
  // The saddle joint's flexion carries the thumb across the palm; the thumb's own palmar side is
  // that of its next joint.
  if (finger == Finger::kThumb) ray.axis[0] = ray.axis[1];
  return ray;
}

Vec3 direction(const Hand& hand, const Ray& ray, std::size_t joint, Way way) {
  const Vec3 along = (ray.node[joint + 1] - ray.node[joint]).normalized();
  const Vec3 palmar = ray.axis[joint].cross(along).normalized();
  const Vec3 radial = radial_sign(hand) * along.cross(palmar).normalized();
  switch (way) {
    case Way::kPalmar:
      return palmar;
    case Way::kRadial:
      return radial;
    case Way::kUlnar:
      return -radial;
    default:
      return -palmar;
  }
}

/// The end of a finger's metacarpal bone towards the wrist.
Vec3 base_of(const Hand& hand, Finger finger, const Vec3& head) {
  const std::string bone = text(name_of(finger)) + "_metacarpal";
  const auto found = std::find_if(hand.bones.begin(), hand.bones.end(),
                                  [&](const Bone& one) { return one.name == bone; });
  if (found == hand.bones.end() || found->mesh.vertices.empty()) {
    throw InputError("base of the " + text(name_of(finger)) + " metacarpal: the hand has no bone " +
                     bone);
  }
  const std::vector<Vec3>& vertices = found->mesh.vertices;
  double longest = 0.0;
  for (const Vec3& v : vertices) longest = std::max(longest, (v - head).norm());
  constexpr double kEnd = 0.9;  // of the length: what lies beyond is the base
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (const Vec3& v : vertices) {
    if ((v - head).norm() < kEnd * longest) continue;
    sum += v;
    count += 1.0;
  }
  return sum / count;
}

}  // namespace

Landmarks::Landmarks(const Hand& hand) : hand_(&hand), rays_(hand.skin) {}

std::vector<std::string> Landmarks::names() {
  std::vector<std::string> names;
  for (const auto& [name, meaning] : meanings()) names.push_back(name);
  return names;
}

HandPoint Landmarks::on_skin(const std::string& name, const Vec3& from,
                             const Vec3& direction) const {
  const std::optional<geometry::RayHit> hit = rays_.first_hit(from, direction);
  if (!hit) throw InputError("landmark " + name + ": the hand has no skin there");
  return skin_point_near(*hand_, from + hit->distance * direction);
}

HandPoint Landmarks::at(const std::string& name) const {
  const auto found = meanings().find(name);
  if (found == meanings().end()) {
    throw UsageError("landmark \"" + name + "\" is not known; " +
                     did_you_mean(name, names(),
                                  "such as index_dip_dorsal, thumb_nail, third_metacarpal_head is "
                                  "needed"));
  }
  const Meaning& meaning = found->second;
  if (meaning.kind == Kind::kStyloid) {
    const Vec3 out =
        (meaning.way == Way::kRadial ? 1.0 : -1.0) * radial_sign(*hand_) * Vec3::UnitX();
    const Vec3 centre = hand_->skeleton.joint(JointId::kWrist).centre;
    const double behind =
        kStyloidShare * (hand_->skeleton.joint(JointId::kMiddleMcp).centre - centre).norm();
    const HandPoint skin = on_skin(name, centre - behind * Vec3::UnitY(), out);
    return part_point("forearm", skin.reference);
  }
  const Ray ray = ray_of(*hand_, meaning.finger);
  const auto k = static_cast<std::size_t>(meaning.place);
  switch (meaning.kind) {
    case Kind::kTip:
      return skin_point_near(*hand_, ray.node[3]);
    case Kind::kNail:
      return on_skin(name, (1 - kNailShare) * ray.node[2] + kNailShare * ray.node[3],
                     direction(*hand_, ray, 2, Way::kDorsal));
    case Kind::kPhalanx: {
      // The thumb's first phalanx starts at its second joint.
      const std::size_t j = meaning.finger == Finger::kThumb ? k == 0 ? 1 : 2 : k;
      return on_skin(name, 0.5 * (ray.node[j] + ray.node[j + 1]),
                     direction(*hand_, ray, j, meaning.way));
    }
    case Kind::kMetacarpal: {
      const std::size_t head_node = meaning.finger == Finger::kThumb ? 1 : 0;
      const Vec3& head = ray.node[head_node];
      const Vec3 dorsal = direction(*hand_, ray, head_node, Way::kDorsal);
      if (meaning.place == 0) return on_skin(name, head, dorsal);
      const Vec3 base = base_of(*hand_, meaning.finger, head);
      return on_skin(name, meaning.place == 1 ? Vec3(0.5 * (head + base)) : base, dorsal);
    }
    default:
      break;
  }
  if (meaning.way == Way::kCentre) {
    const Finger finger = meaning.finger;
    const auto segments = segments_of(finger);
    std::string part = "palm";
    if (finger == Finger::kThumb) {
      part = k == 0 ? "palm" : k == 1 ? "thumb_metacarpal" : "thumb_proximal";
    } else if (k > 0) {
      part = text(name_of(*segments[k - 1]));
    }
    return part_point(part, ray.node[k]);
  }
  return on_skin(name, ray.node[k], direction(*hand_, ray, k, meaning.way));
}

HandPoint Landmarks::at(const std::string& name, double height) const {
  HandPoint point = at(name);
  if (height == 0.0) return point;
  const int vertex =
      point.vertex ? *point.vertex : *skin_point_near(*hand_, point.reference).vertex;
  point.reference +=
      skin_point(*hand_, vertex, height).reference - skin_point(*hand_, vertex).reference;
  return point;
}

}  // namespace palmar::hand
