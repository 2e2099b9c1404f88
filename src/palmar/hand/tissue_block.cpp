// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue_block.h"

#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/winding_number.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/plane_cut.h"

namespace palmar::hand {
namespace {

constexpr double kSnap = 0.15;        // mm; a tenth of the finest edges in use
constexpr double kInsideBone = 0.05;  // mm below its surface: bones are thicker

Vec3 corner(const geometry::TriangleMesh& mesh, const Triangle& t, std::size_t k) {
  return mesh.vertices[t[k]];
}

Vec3 normal_of(const geometry::TriangleMesh& mesh, const Triangle& t) {
  return (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0));
}

Vec3 middle_of(const geometry::TriangleMesh& mesh, const Triangle& t) {
  return (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3.0;
}

Vec3 middle_of_region(const Hand& hand, Region region) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t v = 0; v < hand.skin.vertices.size(); ++v) {
    if (hand.region[v] != region) continue;
    sum += hand.skin.vertices[v];
    ++count;
  }
  if (count == 0) {
    throw UsageError("tissue block: hand \"" + hand.name + "\" has no skin in region " +
                     std::string(name_of(region)));
  }
  return sum / count;
}

struct Plane {
  Vec3 point, normal;
};

Plane cut_plane(const Hand& hand, const TissueBlockOptions& options) {
  const Vec3 middle = middle_of_region(hand, options.region);
  const auto segment = segment_of(options.region);
  const auto finger = segment ? finger_of(*segment) : std::nullopt;
  if (!finger) {
    const Vec3 normal = options.cut_normal.value_or(Vec3::UnitY());
    return {middle + options.cut_offset.value_or(-30.0) * normal, normal};
  }
  const auto segments = segments_of(*finger);
  const Vec3 joint = hand.skeleton.joint(joint_of(*segment)).centre;
  Vec3 end = hand.skeleton.fingertips[index_of(*finger)];
  Vec3 before = joint;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (segments[k] != segment) continue;
    if (k + 1 < segments.size() && segments[k + 1]) {
      end = hand.skeleton.joint(joint_of(*segments[k + 1])).centre;
    }
    if (k > 0) before = hand.skeleton.joint(joint_of(*segments[k - 1])).centre;
  }
  const Vec3 normal = options.cut_normal.value_or((end - joint).normalized());
  return {joint + options.cut_offset.value_or(-0.5 * (joint - before).norm()) * normal, normal};
}

/// Puts the parts of a block together.
class BlockBuilder {
 public:
  explicit BlockBuilder(TissueBlock& block) : block_(block) { cut_face_.face = BlockFace::kCut; }

  /// Triangles with use[t]; `face` says what each is. `is_bone`: rims are holes of the cut face.
  template <typename FaceOf>
  void add(const geometry::CutMesh& part, const std::vector<bool>& use, bool is_bone, FaceOf face) {
    std::vector<int> index(part.mesh.vertices.size(), -1);
    const auto vertex = [&](int v) {
      int& mine = index[v];
      if (mine < 0) {
        mine = static_cast<int>(block_.vertices.size());
        block_.vertices.push_back(part.mesh.vertices[v]);
      }
      return mine;
    };
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      if (!use[t]) continue;
      const Triangle& c = part.mesh.triangles[t];
      block_.facets.push_back({face(t), {{vertex(c[0]), vertex(c[1]), vertex(c[2])}}, {}});
    }
    for (const std::vector<int>& rim : part.rim) {
      if (index[rim.front()] < 0) continue;
      std::vector<int> loop;
      Vec3 middle = Vec3::Zero();
      for (const int v : rim) {
        loop.push_back(vertex(v));
        middle += part.mesh.vertices[v];
      }
      if (is_bone) cut_face_.hole.emplace_back(middle / static_cast<double>(rim.size()));
      cut_face_.loop.push_back(std::move(loop));
    }
  }

  void finish() {
    if (!cut_face_.loop.empty()) block_.facets.push_back(std::move(cut_face_));
  }

 private:
  TissueBlock& block_;
  BlockFacet cut_face_;
};

}  // namespace

void TissueBlockOptions::check() const {
  if (region == Region::kDorsum) {
    throw UsageError("tissue block: the dorsum is no region to press; name a palmar region");
  }
  if (cut_normal && std::abs(cut_normal->norm() - 1.0) > 1e-6) {
    throw UsageError("tissue block: the cut's normal has length " +
                     std::to_string(cut_normal->norm()) + "; a unit vector is required");
  }
}

TissueBlock make_tissue_block(const Hand& hand, const TissueBlockOptions& options) {
  options.check();
  if (hand.bones.empty()) {
    throw UsageError("tissue block: hand \"" + hand.name +
                     "\" has no bones; tissue without them is not held anywhere");
  }
  const Plane plane = cut_plane(hand, options);
  TissueBlock block;
  block.cut_point = plane.point;
  block.cut_normal = plane.normal;
  const geometry::CutMesh skin =
      geometry::cut_by_plane(hand.skin, plane.point, plane.normal, kSnap);

  // The part that the region lies on; the plane may cut off other fingers as well.
  const auto is_of_region = [&](std::size_t t) {
    const Triangle& c = hand.skin.triangles[skin.triangle_of[t]];
    int corners = 0;
    for (const int v : c) corners += hand.region[v] == options.region;
    return corners >= 2;
  };
  const std::vector<int> component =
      geometry::triangle_components(skin.mesh, geometry::build_topology(skin.mesh));
  int wanted = -1;
  for (std::size_t t = 0; t < component.size() && wanted < 0; ++t) {
    if (is_of_region(t)) wanted = component[t];
  }
  if (wanted < 0) {
    throw UsageError("tissue block: the cut leaves nothing of region " +
                     std::string(name_of(options.region)));
  }
  std::vector<bool> use(component.size());
  geometry::CutMesh kept_skin = skin;
  kept_skin.mesh.triangles.clear();
  for (std::size_t t = 0; t < component.size(); ++t) {
    use[t] = component[t] == wanted;
    if (use[t]) kept_skin.mesh.triangles.push_back(skin.mesh.triangles[t]);
  }

  BlockBuilder builder(block);
  builder.add(skin, use, false, [&](std::size_t t) {
    return is_of_region(t) ? BlockFace::kRegion : BlockFace::kSkin;
  });
  // Bones inside it. An open skin has winding numbers near 1 inside all the same: the cut is small.
  const geometry::WindingNumber winding(kept_skin.mesh);
  for (const Bone& bone : hand.bones) {
    const geometry::CutMesh part =
        geometry::cut_by_plane(bone.mesh, plane.point, plane.normal, kSnap);
    if (part.mesh.triangles.empty()) continue;
    // Far from the cut, where the winding number is clearest.
    std::size_t farthest = 0;
    double height = -1.0;
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      const double h =
          (middle_of(part.mesh, part.mesh.triangles[t]) - plane.point).dot(plane.normal);
      if (h > height) {
        height = h;
        farthest = t;
      }
    }
    const Triangle& t = part.mesh.triangles[farthest];
    const Vec3 inside =
        middle_of(part.mesh, t) - kInsideBone * normal_of(part.mesh, t).normalized();
    if (winding.at(inside) < 0.5) continue;
    builder.add(part, std::vector<bool>(part.mesh.triangles.size(), true), true,
                [](std::size_t) { return BlockFace::kBone; });
    block.hole.push_back(inside);
    block.bone.push_back(bone.name);
  }
  builder.finish();
  return block;
}

}  // namespace palmar::hand
