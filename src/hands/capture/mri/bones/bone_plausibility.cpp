// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "hands/capture/mri/bones/bone_chain.h"
#include "hands/capture/mri/bones/bone_outline.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

struct SizedBone {
  const ScannedBone* bone;
  double length, expected;  // mm
};

// The model's scaphoid is an ellipsoid of two thirds of a real one's length. 50 scaphoids of 25
// cadavers: 26.5 mm (right), 25.5 mm (left), men 27.6, women 24.5 (University Journal of Pre and
// Paraclinical Sciences, Madras Medical College, article 10633); 43 in CT: 26 mm in the mean (J.
// Orthop. Surg. Res. 2021, doi 10.1186/s13018-021-02330-8).
constexpr double kScaphoid = 26.0;         // mm
constexpr double kThirdMetacarpal = 64.6;  // mm; Buryanov, Kotiuk 2010, Table I

/// Length that a bone of the model's hand should have, mm.
double expected_length(const hand::Bone& bone, const hand::Hand& model) {
  if (bone.name == "scaphoid") {
    for (const hand::Bone& other : model.bones) {
      if (other.name != "middle_metacarpal") continue;
      return kScaphoid / kThirdMetacarpal * outline_of(other.mesh).length;
    }
  }
  return outline_of(bone.mesh).length;
}

double gap(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b) {
  const geometry::ClosestPointQuery query(a);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : b.vertices) {
    if (const auto at = query.closest(vertex, least)) least = at->distance;
  }
  return least;
}

}  // namespace

std::vector<std::string> doubtful_bones(const ScanSurfaces& surfaces, const hand::Hand& model) {
  std::vector<SizedBone> sized;
  std::vector<double> ratios;
  for (const hand::Bone& expected : model.bones) {
    // Of the forearm an image shows more or less, the model a stump.
    if (expected.name == "radius" || expected.name == "ulna") continue;
    const ScannedBone* bone = bone_named(surfaces, expected.name);
    if (bone == nullptr || bone->is_cut || bone->mesh.triangle_count() == 0) continue;
    sized.push_back({bone, outline_of(bone->mesh).length, expected_length(expected, model)});
    ratios.push_back(sized.back().length / sized.back().expected);
  }
  if (ratios.empty()) return {};
  const double scale = statistics::median(std::move(ratios));

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
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const ScannedBone* last = nullptr;
    for (const char* kind : kChain) {
      if (finger == hand::Finger::kThumb && std::string_view(kind) == "_middle_phalanx") continue;
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

}  // namespace palmar::capture
