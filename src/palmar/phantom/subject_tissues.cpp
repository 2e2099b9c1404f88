// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/phantom/subject_tissues.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/geometry/mesh_measures.h"
#include "palmar/geometry/primitive_meshes.h"

namespace palmar {
namespace {

// Signals of a T1-weighted spin echo at 1.5 T against fat.
constexpr double kFat = 200.0, kMarrow = 185.0, kMuscle = 80.0, kSkin = 100.0, kCartilage = 105.0,
                 kCortex = 14.0, kMarker = 225.0;
constexpr double kSkinThickness = 1.7;  // mm

std::size_t at(int i) { return static_cast<std::size_t>(i); }

TriangleMesh moved(const TriangleMesh& mesh, const Rigid3& by) {
  TriangleMesh result = mesh;
  for (Vec3& v : result.vertices) v = by * v;
  return result;
}

// The skin drawn in by a depth of its own at every vertex, at most to `most` of the way to the
// bone.
TriangleMesh drawn_in(const TriangleMesh& skin, const std::vector<double>& depth) {
  TriangleMesh result = skin;
  const std::vector<Vec3> normal = vertex_normals(skin);
  for (std::size_t i = 0; i < depth.size(); ++i) result.vertices[i] -= depth[i] * normal[i];
  return result;
}

}  // namespace

std::vector<int> marker_vertices(const SubjectPerson& person, const SoftTissue& tissue, int count) {
  const std::vector<Vec3>& skin = person.skin.vertices;
  const std::vector<Vec3> normal = vertex_normals(person.skin);
  const Vec3 ball = skin[at(tissue.thumb_ball_vertex())];
  const Vec3 facing = normal[at(tissue.thumb_ball_vertex())];
  const double size = person.skeleton.joint(JointId::kMiddleMcp).centre.norm() / 92.5;
  std::vector<int> candidates;
  for (int i = 0; i < person.skin.vertex_count(); ++i) {
    if ((skin[at(i)] - ball).norm() < 27.0 * size && normal[at(i)].dot(facing) > 0.1) {
      candidates.push_back(i);
    }
  }
  std::vector<int> chosen{tissue.thumb_ball_vertex()};
  while (static_cast<int>(chosen.size()) < count) {
    int best = -1;
    double farthest = -1.0;
    for (const int i : candidates) {
      double nearest = std::numeric_limits<double>::max();
      for (const int c : chosen) nearest = std::min(nearest, (skin[at(i)] - skin[at(c)]).norm());
      if (nearest > farthest) {
        farthest = nearest;
        best = i;
      }
    }
    if (best < 0) break;
    chosen.push_back(best);
  }
  chosen.resize(std::min(chosen.size(), at(count)));
  return chosen;
}

std::vector<ImagedPart> tissue_parts(const SubjectPerson& person,
                                     const std::vector<SubjectBone>& bones,
                                     const SoftTissue& tissue, const std::vector<Vec3>& skin,
                                     const std::array<Rigid3, kBodyCount>& motion,
                                     const std::vector<Vec3>& markers, const TissueOptions&) {
  std::vector<ImagedPart> parts;
  const TriangleMesh outer{skin, person.skin.triangles};
  parts.push_back({outer, kSkin});
  parts.push_back({drawn_in(outer, std::vector<double>(skin.size(), kSkinThickness)), kFat});
  static_cast<void>(tissue);
  static_cast<void>(kMuscle);
  // Cartilage and capsule fill the joints.
  for (int body = 1; body < kSegmentCount; ++body) {
    const RollingJoint& joint = person.joints.phalanx[at(body)];
    TriangleMesh blob = make_icosphere(1.05 * joint.radius + 0.4, 3);
    for (Vec3& v : blob.vertices) v += joint.centre + 0.5 * joint.radius * joint.along;
    parts.push_back({moved(blob, motion[at(body)]), kCartilage});
  }
  for (const SubjectBone& bone : bones) {
    parts.push_back({moved(bone.bone.mesh, motion[at(bone.body)]), kCortex});
  }
  for (const SubjectBone& bone : bones) {
    parts.push_back({moved(bone.marrow, motion[at(bone.body)]), kMarrow});
  }
  for (const Vec3& centre : markers) {
    TriangleMesh ball = make_icosphere(kMarkerRadius, 3);
    for (Vec3& v : ball.vertices) v += centre;
    parts.push_back({ball, kMarker});
  }
  return parts;
}

}  // namespace palmar
