// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/mri/subject_tissues.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hands/phantom/person/tube.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::phantom {
namespace {

// Signals of a T1-weighted spin echo at 1.5 T against fat.
constexpr double kFat = 200.0, kMarrow = 185.0, kMuscle = 78.0, kSkin = 95.0, kCartilage = 100.0,
                 kLigament = 60.0, kTendon = 16.0, kCortex = 12.0, kClay = 62.0, kMarker = 225.0;
constexpr double kSkinThickness = 1.7;  // mm

geometry::TriangleMesh moved(const geometry::TriangleMesh& mesh, const geometry::Rigid3& by) {
  geometry::TriangleMesh result = mesh;
  for (Vec3& v : result.vertices) v = by * v;
  return result;
}

geometry::TriangleMesh shrunk_skin(const geometry::TriangleMesh& skin, double depth) {
  geometry::TriangleMesh result = skin;
  const std::vector<Vec3> normal = geometry::vertex_normals(skin);
  for (std::size_t i = 0; i < normal.size(); ++i) result.vertices[i] -= depth * normal[i];
  return result;
}

// Muscle fills palm and forearm below the fat; towards the fingers it ends in a thread within the
// bones.
geometry::TriangleMesh muscle(const PosedSubject& subject, const geometry::TriangleMesh& skin) {
  geometry::TriangleMesh result = skin;
  const std::vector<Vec3> normal = geometry::vertex_normals(skin);
  const std::vector<Vec3> facing = geometry::vertex_normals(subject.person->skin);
  for (int i = 0; i < skin.vertex_count(); ++i) {
    const Vec3 &v = skin.vertices[i], &core = subject.posed.core[i];
    // Pads of the palm are thicker than the back of the hand.
    const double fat = 3.3 + 1.2 * facing[i].z();
    const double depth = std::min(fat, 0.7 * (v - core).norm());
    const double finger = std::clamp(1.6 * subject.tissue->finger_share(i), 0.0, 1.0);
    result.vertices[i] =
        (1.0 - finger) * (v - depth * normal[i]) + finger * (core + 0.08 * (v - core));
  }
  return result;
}

// Tendons run through points that are fixed to bones.
class Tendons {
 public:
  Tendons(const PosedSubject& subject, const geometry::TriangleMesh& skin)
      : subject_(subject), skin_(skin) {}

  void draw(std::vector<ImagedPart>& sheaths, std::vector<ImagedPart>& tendons) const {
    const SubjectPerson& person = *subject_.person;
    const Vec3 wrist = person.skeleton.joint(hand::JointId::kWrist).centre;
    const double size = person.skeleton.joint(hand::JointId::kMiddleMcp).centre.norm() / 92.5;
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto segments = hand::segments_of(static_cast<hand::Finger>(f));
      const int count = f == 0 ? 2 : 3;
      const double w = person.finger_width[f];
      std::array<const RollingJoint*, 3> joint{};
      for (int k = 0; k < count; ++k) {
        joint[k] = &person.joints.phalanx[index_of(*segments[k])];
      }
      const int metacarpal = f == 0 ? kThumbMetacarpalBody : 0;
      const Vec3 mcp = joint[0]->centre;
      const auto palmar = [&](int k) -> Vec3 { return joint[k]->axis.cross(joint[k]->along); };
      // Flexor: forearm, carpal tunnel, palm, then along the phalanges.
      const double aside = (f - 2.3) * -2.9 * size, layer = f % 2 == 0 ? 1.6 : -1.6;
      std::vector<Vec3> in_palm{wrist + Vec3(1.4 * aside, -40.0, (9.0 + layer) * size),
                                wrist + Vec3(1.1 * aside, -12.0, (9.5 + layer) * size),
                                wrist + Vec3(aside, 8.0 * size, (11.0 + layer) * size),
                                wrist + Vec3(aside, 24.0 * size, (12.5 + layer) * size)};
      std::vector<Vec3> flexor = in_palm;
      const Vec3 back = f == 0 ? person.joints.cmc.along : (mcp - wrist).normalized();
      flexor.push_back(
          at_body(metacarpal, mcp - 13.0 * size * back + (joint[0]->radius + 3.6) * palmar(0)));
      std::vector<Vec3> sheath(flexor.begin() + 2, flexor.end());
      for (int k = 0; k < count; ++k) {
        const int body = static_cast<int>(*segments[k]);
        const bool is_last = k + 1 == count;
        const Vec3 end = is_last ? person.skeleton.fingertips[f] : joint[k + 1]->centre;
        const double length = (end - joint[k]->centre).norm();
        for (const double share : {0.4, 0.68}) {
          if (is_last && share > 0.5) continue;
          const double off = 0.19 * w + (is_last ? 1.2 : 2.7);
          flexor.push_back(
              at_body(body, joint[k]->centre + share * length * joint[k]->along + off * palmar(k)));
        }
      }
      tendons.push_back({tube_mesh(below_skin(flexor, 0.115 * w), 0.115 * w), kTendon});
      sheaths.push_back({tube_mesh(below_skin(sheath, 0.115 * w + 0.6), 0.115 * w + 0.6), kFat});
      // Extensor: flat on the back of the bones.
      std::vector<Vec3> extensor;
      if (f > 0) {
        extensor.push_back(wrist + Vec3(0.8 * aside, -40.0, -10.5 * size));
        extensor.push_back(wrist + Vec3(0.9 * aside, 6.0 * size, -11.0 * size));
      }
      extensor.push_back(
          at_body(metacarpal, mcp - 20.0 * size * back - (0.26 * w + 2.6) * palmar(0)));
      extensor.push_back(at_body(metacarpal, mcp - (joint[0]->radius + 1.5) * palmar(0)));
      for (int k = 0; k + 1 < count; ++k) {
        const int body = static_cast<int>(*segments[k]);
        const Vec3 here = joint[k]->centre, next = joint[k + 1]->centre;
        extensor.push_back(at_body(body, 0.5 * (here + next) - (0.19 * w + 1.9) * palmar(k)));
        extensor.push_back(at_body(body, next - (joint[k + 1]->radius + 1.0) * palmar(k)));
      }
      tendons.push_back({tube_mesh(below_skin(extensor, 0.9), 0.9), kTendon});
    }
  }

 private:
  /// A tendon of that radius lies below skin and some fat everywhere: where the posed skin comes
  /// nearer it is pressed towards the bone, which covers it in the image where the two meet. Points
  /// half way hold the curve between.
  std::vector<Vec3> below_skin(const std::vector<Vec3>& through, double radius) const {
    std::vector<Vec3> path;
    for (std::size_t i = 0; i < through.size(); ++i) {
      if (i > 0) path.push_back(0.5 * (through[i - 1] + through[i]));
      path.push_back(through[i]);
    }
    const double least = radius + kSkinThickness + 0.7;
    std::vector<geometry::DistanceSample> sample(path.size());
    for (int round = 0; round < 3; ++round) {  // the nearest skin changes with the point
      skin_.sample(path, std::numeric_limits<double>::infinity(), sample);
      for (std::size_t i = 0; i < path.size(); ++i) {
        const double short_by = least + sample[i].distance;
        if (short_by > 0.0) path[i] -= short_by * sample[i].normal;
      }
    }
    return path;
  }
  Vec3 at_body(int body, const Vec3& reference) const { return subject_.motion[body] * reference; }
  const PosedSubject& subject_;
  geometry::MeshDistance skin_;
};

// Cartilage and capsule of a joint: what shows of an ellipsoid between two bones.
geometry::TriangleMesh joint_filling(const Vec3& centre, const Vec3& along, const Vec3& lateral,
                                     const Vec3& half) {
  Eigen::Matrix3d axes;
  axes.col(0) = (lateral - lateral.dot(along) * along).normalized();
  axes.col(1) = along;
  axes.col(2) = axes.col(0).cross(axes.col(1));
  geometry::TriangleMesh blob = geometry::make_icosphere(1.0, 3);
  for (Vec3& v : blob.vertices) v = centre + axes * v.cwiseProduct(half);
  return blob;
}

}  // namespace

std::vector<int> marker_vertices(const SubjectPerson& person, const SoftTissue& tissue, int count) {
  const std::vector<Vec3>& skin = person.skin.vertices;
  const std::vector<Vec3> normal = geometry::vertex_normals(person.skin);
  const Vec3 ball = skin[tissue.thumb_ball_vertex()];
  const Vec3 facing = normal[tissue.thumb_ball_vertex()];
  const double size = person.skeleton.joint(hand::JointId::kMiddleMcp).centre.norm() / 92.5;
  std::vector<int> candidates;
  for (int i = 0; i < person.skin.vertex_count(); ++i) {
    if ((skin[i] - ball).norm() < 27.0 * size && normal[i].dot(facing) > 0.1) {
      candidates.push_back(i);
    }
  }
  std::vector<int> chosen{tissue.thumb_ball_vertex()};
  while (static_cast<int>(chosen.size()) < count) {
    int best = -1;
    double farthest = -1.0;
    for (const int i : candidates) {
      double nearest = std::numeric_limits<double>::max();
      for (const int c : chosen) nearest = std::min(nearest, (skin[i] - skin[c]).norm());
      if (nearest > farthest) {
        farthest = nearest;
        best = i;
      }
    }
    if (best < 0) break;
    chosen.push_back(best);
  }
  chosen.resize(std::min(chosen.size(), static_cast<std::size_t>(count)));
  return chosen;
}

std::vector<ImagedPart> tissue_parts(const PosedSubject& subject, bool has_fixture) {
  const SubjectPerson& person = *subject.person;
  const Vec3 wrist = person.skeleton.joint(hand::JointId::kWrist).centre;
  const double size = person.skeleton.joint(hand::JointId::kMiddleMcp).centre.norm() / 92.5;
  std::vector<ImagedPart> parts, tendons;
  const geometry::TriangleMesh skin{subject.posed.skin, person.skin.triangles};
  if (has_fixture) parts.push_back({fixture_mesh(skin, wrist), kClay});
  parts.push_back({skin, kSkin});
  parts.push_back({shrunk_skin(skin, kSkinThickness), kFat, ImagedTissue::kFat});
  parts.push_back({muscle(subject, skin), kMuscle});
  Tendons(subject, skin).draw(parts, tendons);
  // Ligaments and cartilage between the carpals, then the joints of the fingers.
  const SaddleJoint& cmc = person.joints.cmc;
  parts.push_back({joint_filling(wrist + Vec3(-1.0, 15.0, 0.0) * size, Vec3::UnitY(), Vec3::UnitX(),
                                 Vec3(19.0, 16.0, 7.5) * size),
                   kLigament});
  parts.push_back(
      {joint_filling(cmc.centre, cmc.along, cmc.abduction_axis, Vec3(6.5, 4.5, 6.5) * size),
       kCartilage});
  for (int body = 1; body < hand::kSegmentCount; ++body) {
    const RollingJoint& joint = person.joints.phalanx[body];
    const double r = joint.radius;
    const geometry::TriangleMesh filling =
        joint_filling(joint.centre + 0.7 * r * joint.along, joint.along, joint.axis,
                      Vec3(1.15 * r, 0.9 * r, 0.95 * r));
    parts.push_back({moved(filling, subject.motion[body]), kCartilage});
  }
  parts.insert(parts.end(), tendons.begin(), tendons.end());
  for (const SubjectBone& bone : *subject.bones) {
    parts.push_back({moved(bone.bone.mesh, subject.motion[bone.body]), kCortex});
  }
  for (const SubjectBone& bone : *subject.bones) {
    parts.push_back(
        {moved(bone.marrow, subject.motion[bone.body]), kMarrow, ImagedTissue::kMarrow});
  }
  for (const Vec3& centre : subject.markers) {
    geometry::TriangleMesh ball = geometry::make_icosphere(kMarkerRadius, 3);
    for (Vec3& v : ball.vertices) v += centre;
    parts.push_back({ball, kMarker});
  }
  return parts;
}

}  // namespace palmar::phantom
