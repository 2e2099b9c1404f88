// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/palm_placement.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "hands/capture/mri/bones/bone_chain.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/registration/icp.h"

namespace palmar::capture {
namespace {

constexpr std::array<std::string_view, 6> kPalm{"index_metacarpal", "middle_metacarpal",
                                                "ring_metacarpal",  "trapezoid",
                                                "capitate",         "little_metacarpal"};
constexpr std::size_t kSteady = 2;  // the first ones hold the palm; the others help to begin

void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& more) {
  const int first = mesh.vertex_count();
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Triangle& t : more.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

}  // namespace

std::optional<geometry::Rigid3> place_palm(const ScanSurfaces& reference,
                                           const ScanSurfaces& posture) {
  std::vector<Vec3> from, to;
  geometry::TriangleMesh moving, fixed;
  for (std::size_t b = 0; b < kPalm.size(); ++b) {
    const ScannedBone* mine = bone_named(reference, kPalm[b]);
    const ScannedBone* theirs = bone_named(posture, kPalm[b]);
    if (mine == nullptr || theirs == nullptr || mine->is_cut || theirs->is_cut) continue;
    from.push_back(geometry::centre_of_volume(mine->mesh));
    to.push_back(geometry::centre_of_volume(theirs->mesh));
    if (b >= kSteady && !moving.vertices.empty()) continue;
    append(moving, mine->mesh);
    append(fixed, theirs->mesh);
  }
  constexpr std::size_t kFewest = 3;  // middles that hold a motion
  if (from.size() < kFewest) return std::nullopt;
  const geometry::Rigid3 start = align_points(from, to);
  return geometry::register_rigidly(moving, fixed, start, {.start_turn = 0.0}).fixed_from_moving;
}

}  // namespace palmar::capture
