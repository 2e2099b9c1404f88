// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/mri/bones/bone_plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "palmar/capture/mri/bones/bone_chain.h"
#include "palmar/capture/mri/bones/bone_outline.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/statistics/median.h"

namespace palmar {
namespace {

struct SizedBone {
  const ScannedBone* bone;
  double length, expected;  // mm
};

double gap(const TriangleMesh& a, const TriangleMesh& b) {
  const ClosestPointQuery query(a);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : b.vertices) {
    if (const auto at = query.closest(vertex, least)) least = at->distance;
  }
  return least;
}

}  // namespace

std::vector<std::string> doubtful_bones(const ScanSurfaces& surfaces, const Hand& model) {
  std::vector<SizedBone> sized;
  std::vector<double> ratios;
  for (const Bone& expected : model.bones) {
    const ScannedBone* bone = bone_named(surfaces, expected.name);
    if (bone == nullptr || bone->is_cut || bone->mesh.triangle_count() == 0) continue;
    sized.push_back({bone, outline_of(bone->mesh).length, outline_of(expected.mesh).length});
    ratios.push_back(sized.back().length / sized.back().expected);
  }
  if (ratios.empty()) return {};
  const double scale = median(std::move(ratios));

  std::vector<std::string> doubts;
  for (const SizedBone& one : sized) {
    const std::string& name = one.bone->name;
    const bool is_long = name.ends_with("_phalanx") || name.ends_with("_metacarpal");
    const double ratio = one.length / (scale * one.expected);
    if (ratio >= (is_long ? 0.7 : 0.6) && ratio <= (is_long ? 1.4 : 1.7)) continue;
    doubts.push_back(fmt::format("{} is {:.0f} mm long, where about {:.0f} mm are expected", name,
                                 one.length, scale * one.expected));
  }
  constexpr double kFar = 8.0;  // mm
  constexpr std::array<const char*, 4> kChain = {"_metacarpal", "_proximal_phalanx",
                                                 "_middle_phalanx", "_distal_phalanx"};
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const ScannedBone* last = nullptr;
    for (const char* kind : kChain) {
      if (finger == Finger::kThumb && std::string_view(kind) == "_middle_phalanx") continue;
      const ScannedBone* bone = bone_named(surfaces, std::string(name_of(finger)) + kind);
      if (last != nullptr && bone != nullptr) {
        const double apart = gap(last->mesh, bone->mesh);
        if (apart > kFar) {
          doubts.push_back(
              fmt::format("{} and {} are {:.0f} mm apart", last->name, bone->name, apart));
        }
      }
      last = bone;
    }
  }
  return doubts;
}

}  // namespace palmar
