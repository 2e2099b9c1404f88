// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/photo/painted_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "hands/phantom/person/person_random.h"
#include "hands/phantom/person/smooth_noise.h"
#include "hands/phantom/person/soft_tissue.h"
#include "hands/phantom/person/subject_bones.h"
#include "hands/phantom/person/subject_creases.h"
#include "hands/phantom/person/subject_person.h"
#include "hands/phantom/photo/skin_tint.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/subdivide.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::phantom {
namespace {

enum Stream : std::uint64_t { kPattern = 61, kDots, kRestless = 67 };

/// A place on the surface of the reference posture that goes with it.
struct SkinPlace {
  int triangle = 0;
  std::array<double, 3> weights{};
  Vec3 in(const std::vector<Vec3>& skin, const std::vector<Triangle>& triangles) const {
    Vec3 p = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      p += weights[k] * skin[triangles[triangle][k]];
    }
    return p;
  }
};

struct Paint {
  std::vector<geometry::Srgb> colour;
  std::vector<std::pair<hand::Segment, SkinPlace>> dots;
  std::map<hand::Segment, std::vector<SkinPlace>> crease;
};

/// Outermost skin from a point inside along a direction, within 25 mm.
std::optional<SkinPlace> skin_along(const geometry::RayQuery& rays,
                                    const geometry::ClosestPointQuery& nearest, const Vec3& from,
                                    const Vec3& direction) {
  const auto hit = rays.first_hit(from, direction, 0.0, 25.0);
  if (!hit) return {};
  const auto place = nearest.closest(from + hit->distance * direction, 0.5);
  if (!place) return {};
  return SkinPlace{place->triangle, place->weights};
}

std::vector<std::pair<hand::Segment, SkinPlace>> place_dots(const SubjectPerson& person,
                                                            const geometry::TriangleMesh& skin,
                                                            const hand::HandCreases& creases,
                                                            std::uint64_t seed) {
  std::vector<std::pair<hand::Segment, SkinPlace>> dots;
  const geometry::RayQuery rays(skin);
  const geometry::ClosestPointQuery nearest(skin);
  RandomStream random(seed, kDots);
  const auto add = [&](hand::Segment segment, const Vec3& from, const Vec3& direction) {
    if (const auto place = skin_along(rays, nearest, from, direction.normalized())) {
      dots.emplace_back(segment, *place);
    }
  };
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const auto chain = hand::segments_of(finger);
    const int count = chain[2] ? 3 : 2;
    const int first_node = f == 0 ? 2 : 1;
    for (int k = 0; k < count; ++k) {
      const hand::Joint& joint = person.skeleton.joint(hand::joint_of(*chain[k]));
      const Vec3 end = k + 1 < count ? person.skeleton.joint(hand::joint_of(*chain[k + 1])).centre
                                     : person.skeleton.fingertips[f];
      const Vec3 along = end - joint.centre;
      const Vec3 palmar = creases.palmar_direction(finger, first_node + k);
      const Vec3 aside = along.cross(palmar).normalized();
      // A triangle on the back, in the middle half of the phalanx; clear of the nail on the last.
      const bool is_last = k + 1 == count;
      const std::array<std::array<double, 2>, 3> spot{{{is_last ? 0.18 : 0.30, 0.0},
                                                       {is_last ? 0.42 : 0.62, -0.6},
                                                       {is_last ? 0.42 : 0.62, 0.6}}};
      for (const auto& [share, side] : spot) {
        const Vec3 from = joint.centre + (share + spread(random, 0.02)) * along;
        add(*chain[k], from, -palmar + (side + spread(random, 0.04)) * aside);
      }
    }
  }
  const auto mcp = [&](hand::JointId id) { return person.skeleton.joint(id).centre; };
  const std::array<Vec3, 4> head{mcp(hand::JointId::kIndexMcp), mcp(hand::JointId::kMiddleMcp),
                                 mcp(hand::JointId::kRingMcp), mcp(hand::JointId::kLittleMcp)};
  const Vec3 wrist = mcp(hand::JointId::kWrist);
  for (const Vec3& h : head) {
    for (const double share : {0.45, 0.72}) {
      add(hand::Segment::kPalm, wrist + share * (h - wrist), -Vec3::UnitZ());
    }
  }
  return dots;
}

/// How far a crease reaches from the finger's axis, mm: round the palmar half of the finger; at the
/// thumb's base, which widens into the ball, farther.
double crease_reach(const SubjectPerson& person, hand::Segment segment) {
  const double width = person.finger_width[static_cast<int>(*hand::finger_of(segment))];
  return segment == hand::Segment::kThumbProximal ? width + 6.0 : 0.75 * width + 3.0;
}

bool is_wrist_front(const hand::HandCreases& creases, const Vec3& p) {
  return p.z() > creases.wrist().point.z() && std::abs(creases.wrist().value(p)) < 20.0;
}

/// Where edges of the skin cross a plane, of the points that lie on the crease.
template <typename IsOnIt>
void add_crossings(const geometry::TriangleMesh& skin, const hand::CreasePlane& plane,
                   const IsOnIt& is_on_it, std::vector<SkinPlace>& line) {
  for (int t = 0; t < skin.triangle_count(); ++t) {
    const Triangle& corner = skin.triangles[t];
    for (std::size_t e = 0; e < 3; ++e) {
      const std::size_t next = (e + 1) % 3;
      const int a = corner[e], b = corner[next];
      if (a > b) continue;  // every edge once
      const Vec3 &pa = skin.vertices[a], &pb = skin.vertices[b];
      const double va = plane.value(pa), vb = plane.value(pb);
      if ((va < 0.0) == (vb < 0.0)) continue;
      const double s = va / (va - vb);
      if (!is_on_it((1.0 - s) * pa + s * pb)) continue;
      SkinPlace place{t, {0.0, 0.0, 0.0}};
      place.weights[e] = 1.0 - s;
      place.weights[next] = s;
      line.push_back(place);
    }
  }
}

Paint painted(const SubjectPerson& person, const geometry::TriangleMesh& skin,
              const hand::HandCreases& creases, const PaintedHandOptions& options) {
  const SkinPaint& paint = options.paint;
  Paint result;
  if (paint.has_dots) result.dots = place_dots(person, skin, creases, options.seed);
  std::vector<Vec3> dot;
  for (const auto& [segment, place] : result.dots) {
    dot.push_back(place.in(skin.vertices, skin.triangles));
  }
  const SmoothNoise coarse(options.seed, kPattern, 9.0), middle(options.seed + 1, kPattern, 3.0),
      fine(options.seed + 2, kPattern, 1.2);
  std::optional<SkinTint> tint;
  if (paint.is_tinted) tint.emplace(person, creases, options.seed);
  result.colour.resize(skin.vertices.size());
  parallel_for(static_cast<int>(skin.vertices.size()), [&](int v) {
    const Vec3& p = skin.vertices[v];
    const double height = creases.palmar_height(p);
    // The palm is paler and redder than the back.
    const double palm = std::clamp(0.5 + height / 8.0, 0.0, 1.0);
    const auto tone = static_cast<float>(
        1.0 + paint.texture * (0.6 * coarse.at(p) + 0.6 * middle.at(p) + 0.5 * fine.at(p)));
    geometry::Srgb colour =
        tone * paint.skin.cwiseProduct(geometry::Srgb(static_cast<float>(0.94 + 0.10 * palm),
                                                      static_cast<float>(0.92 + 0.10 * palm),
                                                      static_cast<float>(0.90 + 0.12 * palm)));
    if (tint) colour = tint->at(p, creases.label(p).segment, colour);
    const auto ink = [&](const geometry::Srgb& with, double depth) {
      // Edges fade over 0.3 mm.
      const double share = paint.coverage * std::clamp(depth / 0.3 + 0.5, 0.0, 1.0);
      colour += static_cast<float>(share) * (with - colour);
    };
    if (paint.has_creases && height > 0.0) {
      const hand::SkinLabel label = creases.label(p);
      for (int k = 1; k < hand::kSegmentCount; ++k) {
        const auto segment = static_cast<hand::Segment>(k);
        const bool is_here = label.segment == segment || label.segment == hand::Segment::kPalm ||
                             hand::finger_of(label.segment) == hand::finger_of(segment);
        if (!is_here) continue;
        const hand::CreasePlane& plane = creases.proximal_crease(segment);
        // Base creases end where the finger does; the palm is wider.
        if ((p - plane.point).norm() > crease_reach(person, segment)) {
          continue;
        }
        ink(paint.crease, 0.5 * paint.crease_width - std::abs(plane.value(p)));
      }
    }
    if (paint.has_creases && is_wrist_front(creases, p)) {
      ink(paint.crease, 0.5 * paint.crease_width - std::abs(creases.wrist().value(p)));
    }
    for (const Vec3& d : dot) {
      const double distance = (p - d).norm();
      if (distance < paint.dot_diameter) ink(paint.dot, 0.5 * paint.dot_diameter - distance);
    }
    result.colour[v] = colour.cwiseMax(0.0F).cwiseMin(1.0F);
  });
  if (!paint.has_creases) return result;
  add_crossings(
      skin, creases.wrist(), [&](const Vec3& p) { return is_wrist_front(creases, p); },
      result.crease[hand::Segment::kPalm]);
  for (int k = 1; k < hand::kSegmentCount; ++k) {
    const auto segment = static_cast<hand::Segment>(k);
    const hand::CreasePlane& plane = creases.proximal_crease(segment);
    const auto is_on_it = [&](const Vec3& p) {
      if (creases.palmar_height(p) <= 0.0 ||
          (p - plane.point).norm() > crease_reach(person, segment)) {
        return false;
      }
      const hand::SkinLabel label = creases.label(p);
      return label.segment == hand::Segment::kPalm ||
             hand::finger_of(label.segment) == hand::finger_of(segment);
    };
    add_crossings(skin, plane, is_on_it, result.crease[segment]);
  }
  return result;
}

/// How far a ring on a finger's proximal phalanx stands off each vertex: a band across its bone,
/// nearer to its base crease than to the next, with edges 0.4 mm wide.
std::vector<double> ring_heights(const SubjectPerson& person, const geometry::TriangleMesh& skin,
                                 const hand::HandCreases& creases, hand::Finger finger) {
  constexpr double kWidth = 5.0, kThickness = 1.2, kEdge = 0.4, kPlace = 0.45;  // mm; share
  const auto chain = hand::segments_of(finger);
  const Vec3& base = creases.proximal_crease(*chain[0]).point;
  const Vec3& next = creases.proximal_crease(*chain[1]).point;
  const Vec3 along = (next - base).normalized();
  const Vec3 middle = base + kPlace * (next - base);
  const double reach = person.finger_width[static_cast<int>(finger)];
  std::vector<double> height(skin.vertices.size(), 0.0);
  for (std::size_t v = 0; v < height.size(); ++v) {
    const Vec3& p = skin.vertices[v];
    const double inside = 0.5 * kWidth - std::abs(along.dot(p - middle));
    const hand::SkinLabel label = creases.label(p);
    if (inside <= 0.0 || label.segment == hand::Segment::kPalm ||
        hand::finger_of(label.segment) != finger || (p - middle).norm() > reach) {
      continue;
    }
    height[v] = kThickness * std::min(1.0, inside / kEdge);
  }
  return height;
}

/// The posture with every finger a little elsewhere, so that its tip moves by `move` mm (root of
/// the mean square): flexion and abduction of the knuckle, for the thumb those of its saddle joint.
hand::Posture fidgeted(const SubjectPerson& person, hand::Posture posture, double move,
                       RandomStream& random) {
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const hand::Joint& joint = f == 0 ? person.skeleton.joint(hand::JointId::kThumbCmc)
                                      : person.skeleton.joint(hand::joint_of(
                                            *hand::segments_of(static_cast<hand::Finger>(f))[0]));
    const double reach = (person.skeleton.fingertips[f] - joint.centre).norm();
    for (const hand::JointDof& dof : joint.dofs) {
      posture[dof.dof] += random.normal() * move / (std::numbers::sqrt2 * reach);
    }
  }
  return posture;
}

}  // namespace

void SkinPaint::check() const {
  const auto hold = [](const char* field, double value, double least, double most) {
    if (!(value >= least && value <= most)) {
      throw UsageError(fmt::format("{} is {}; {} to {} is allowed", field, value, least, most));
    }
  };
  hold("coverage", coverage, 0.0, 1.0);
  hold("crease_width", crease_width, 0.3, 5.0);
  hold("dot_diameter", dot_diameter, 0.5, 8.0);
  hold("texture", texture, 0.0, 0.5);
}

void PaintedHandOptions::check() const {
  paint.check();
  if (takes < 1 || takes > 360) {
    throw UsageError(fmt::format("takes is {}; 1 to 360 is allowed", takes));
  }
  if (!(restless >= 0.0 && restless <= 10.0)) {
    throw UsageError(fmt::format("restless is {} mm; 0 to 10 is allowed", restless));
  }
  if (levels < 0 || levels > 3) {
    throw UsageError(fmt::format("levels is {}; 0 to 3 is allowed", levels));
  }
}

PaintedHand make_painted_hand(const hand::Hand& base,
                              const std::vector<hand::ScanPosture>& postures,
                              const PaintedHandOptions& options) {
  options.check();
  const hand::Hand right = base.side == hand::Side::kRight ? base : hand::mirrored(base);
  const SubjectPerson person = make_person(right, options.seed, options.dispersion);
  const std::vector<SubjectBone> bones = make_subject_bones(person, options.seed);
  const SoftTissue tissue(person, bones);
  geometry::SubdivisionOptions finer;
  finer.levels = options.levels;
  const geometry::TriangleMesh reference = geometry::subdivide(person.skin, finer);
  const hand::HandCreases creases =
      subject_creases(person.skin, person.skeleton, options.seed, options.dispersion);
  const Paint paint = painted(person, reference, creases, options);

  std::vector<double> ring;
  if (options.ring) ring = ring_heights(person, reference, creases, *options.ring);

  const bool is_left = options.side == hand::Side::kLeft;
  const auto side = [&](const Vec3& v) { return is_left ? Vec3(-v.x(), v.y(), v.z()) : v; };
  PaintedHand hand;
  hand.name = fmt::format("subject {}", options.seed);
  hand.side = options.side;
  hand.colour = paint.colour;
  hand.ring = std::move(ring);
  for (std::size_t v = 0; v < hand.ring.size(); ++v) {
    if (hand.ring[v] > 0.0) hand.colour[v] = options.paint.ring_colour;
  }
  hand.dimensions = hand::measure_hand(reference, person.skeleton, creases);
  hand.triangles = reference.triangles;
  if (is_left) {
    for (Triangle& t : hand.triangles) std::swap(t[1], t[2]);
  }
  std::map<hand::Segment, int> tips;  // vertex
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto chain = hand::segments_of(static_cast<hand::Finger>(f));
    const auto nearer = [&](const Vec3& a, const Vec3& b) {
      const Vec3& tip = person.skeleton.fingertips[f];
      return (a - tip).squaredNorm() < (b - tip).squaredNorm();
    };
    const auto& v = reference.vertices;
    tips[*chain[chain[2] ? 2 : 1]] =
        static_cast<int>(std::min_element(v.begin(), v.end(), nearer) - v.begin());
  }
  for (const hand::ScanPosture name : postures) {
    const hand::Posture& posture = person.postures.at(name);
    geometry::TriangleMesh skin = person.skin;
    if (name != hand::ScanPosture::kReference) skin.vertices = tissue.pose(posture).skin;
    skin = geometry::subdivide(skin, finer);
    PaintedPosture& result = hand.postures[name];
    result.angles = posture.angle;
    for (const auto& [segment, place] : paint.dots) {
      result.dots.push_back({segment, side(place.in(skin.vertices, reference.triangles))});
    }
    for (const auto& [segment, places] : paint.crease) {
      for (const SkinPlace& place : places) {
        result.crease[segment].push_back(side(place.in(skin.vertices, reference.triangles)));
      }
    }
    for (const auto& [segment, vertex] : tips) {
      result.fingertip[segment] = side(skin.vertices[vertex]);
    }
    const auto motion = body_motions(person.joints, posture);
    for (int body = 1; body < hand::kSegmentCount; ++body) {
      const auto& joint = person.joints.phalanx[body];
      const InstantAxis axis = instant_axis(person.joints, posture, body, joint.flexion);
      const geometry::Rigid3& before = motion[*parent_of(body)];
      // A rotation mirrored turns the other way round; axes show the same motion.
      const Vec3 direction = side(before.rotation * axis.axis);
      result.joint[static_cast<hand::Segment>(body)] = {is_left ? Vec3(-direction) : direction,
                                                        side(before * axis.point)};
    }
    for (Vec3& v : skin.vertices) v = side(v);
    result.skin = std::move(skin.vertices);
  }
  RandomStream random(options.seed, kRestless);
  for (int take = 1; take < options.takes; ++take) {
    const hand::Posture posture =
        fidgeted(person, person.postures.at(postures.at(0)), options.restless, random);
    geometry::TriangleMesh skin =
        geometry::subdivide({tissue.pose(posture).skin, person.skin.triangles}, finer);
    for (Vec3& v : skin.vertices) v = side(v);
    hand.takes.push_back(std::move(skin.vertices));
  }
  return hand;
}

geometry::ColouredMesh surface_of(const PaintedHand& hand, hand::ScanPosture posture) {
  const auto found = hand.postures.find(posture);
  if (found == hand.postures.end()) {
    throw UsageError(fmt::format("{} wasn't posed in {}", hand.name, name_of(posture)));
  }
  return surface_of(hand, found->second.skin);
}

geometry::ColouredMesh surface_of(const PaintedHand& hand, const std::vector<Vec3>& skin) {
  geometry::ColouredMesh surface{{skin, hand.triangles}, hand.colour};
  if (!hand.ring.empty()) {
    const std::vector<Vec3> normal = geometry::vertex_normals(surface.mesh);
    for (std::size_t v = 0; v < normal.size(); ++v) {
      surface.mesh.vertices[v] += hand.ring[v] * normal[v];
    }
  }
  return surface;
}

}  // namespace palmar::phantom
