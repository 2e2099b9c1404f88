// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/mri/bones/bone_pairing.h"
#include "palmar/core/text.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/posture_from_mesh.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::capture {
namespace {

constexpr double kLargestUnnamed = 5.0e3;  // mm^3
// One size for the whole hand doesn't show how long a slender one is.
constexpr std::array<double, 4> kStretches = {1.0, 0.94, 1.06, 1.12};

/// Where the model's bones are, fitted into the skin.
struct Expected {
  std::vector<BoneOutline> bones;
  Vec3 along = Vec3::UnitY();  ///< the hand, towards the fingers
};

Expected expected_bones(const geometry::TriangleMesh& skin, const hand::Hand& model,
                        const Progress& progress) {
  const hand::MeshFit fit = hand::fit_posture_to_mesh(model, skin, {.fits_scale = true}, progress);
  Expected expected;
  expected.along = fit.mesh_from_hand.rotation * Vec3::UnitY();
  for (const geometry::TriangleMesh& mesh : hand::pose_bones(model, fit.posture)) {
    BoneOutline outline = outline_of(mesh);
    outline.centre = fit.mesh_from_hand * (fit.scale * outline.centre);
    outline.axis = fit.mesh_from_hand.rotation * outline.axis;
    for (Vec3& end : outline.ends) end = fit.mesh_from_hand * (fit.scale * end);
    outline.length *= fit.scale;
    outline.width *= fit.scale;
    expected.bones.push_back(outline);
  }
  return expected;
}

/// Longer along the hand, from its middle.
std::vector<BoneOutline> stretched(const Expected& expected, double factor) {
  std::vector<BoneOutline> bones = expected.bones;
  Vec3 middle = Vec3::Zero();
  for (const BoneOutline& bone : bones) middle += bone.centre;
  middle /= static_cast<double>(std::max<std::size_t>(1, bones.size()));
  const auto moved = [&](const Vec3& p) -> Vec3 {
    return p + (factor - 1.0) * expected.along.dot(p - middle) * expected.along;
  };
  for (BoneOutline& bone : bones) {
    const double share = std::pow(expected.along.dot(bone.axis), 2);
    bone.centre = moved(bone.centre);
    for (Vec3& end : bone.ends) end = moved(end);
    bone.length *= 1.0 + (factor - 1.0) * share;
  }
  return bones;
}

std::vector<std::vector<BoneOutline>> guesses(const Expected& expected) {
  std::vector<std::vector<BoneOutline>> all;
  for (const double factor : kStretches) all.push_back(stretched(expected, factor));
  return all;
}

}  // namespace

BoneNames name_bones(const std::vector<MarrowRegion>& candidates, const ScanLevels& levels,
                     const geometry::TriangleMesh& skin, const hand::Hand& model,
                     const KnownSide& known, const Progress& progress) {
  const hand::Hand other = hand::mirrored(model);
  const Expected as_model = expected_bones(skin, model, progress),
                 as_other = expected_bones(skin, other, progress);
  double longest = 0.0;
  for (const BoneOutline& bone : as_model.bones) longest = std::max(longest, bone.length);
  const BoneHypotheses hypotheses = bone_hypotheses(candidates, levels, 1.4 * longest);
  BonePairing own = pair_bones(hypotheses, levels, skin, model, guesses(as_model));
  progress.throw_if_cancelled();
  BonePairing opposite = pair_bones(hypotheses, levels, skin, other, guesses(as_other));
  bool is_own = own.cost <= opposite.cost;
  if (known.side) {
    const bool says_own = *known.side == model.side;
    const double said = says_own ? own.cost : opposite.cost;
    const bool is_doubted = (says_own ? opposite.cost : own.cost) < known.doubted_below * said;
    is_own = says_own != is_doubted;
  }
  BonePairing& best = is_own ? own : opposite;

  BoneNames names;
  names.side = is_own ? model.side : other.side;
  names.misfit = best.cost;
  names.other_misfit = is_own ? opposite.cost : own.cost;
  std::vector<std::string> missing;
  double level = 0.0;
  for (std::size_t e = 0; e < best.found.size(); ++e) {
    const int f = best.found[e];
    if (f >= 0) {
      const BoneOutline outline = outline_of(best.regions[f]);
      names.bones.push_back(best.regions[f]);
      names.bones.back().is_leaky = outline.length > 1.25 * best.expected[e].length ||
                                    outline.width > 1.4 * best.expected[e].width;
      level += best.regions[f].level;
      names.name.push_back(model.bones[e].name);
    } else {
      missing.push_back(model.bones[e].name);
    }
  }
  level /= static_cast<double>(std::max<std::size_t>(1, names.bones.size()));
  for (std::size_t f = 0; f < best.is_used.size(); ++f) {
    const MarrowRegion& left = best.regions[f];
    if (best.is_used[f] != 0 || left.volume < 150.0) continue;
    if (left.shell > levels.dark + 0.3 * (left.level - levels.dark)) continue;
    if (left.level < 0.9 * level || left.volume > kLargestUnnamed) continue;
    names.bones.push_back(left);
    names.name.emplace_back();
  }
  if (!missing.empty()) {
    names.notes.push_back(fmt::format("{} of {} bones not found: {}", missing.size(),
                                      model.bones.size(), palmar::joined(missing, ", ")));
  }
  if (!known.side && names.other_misfit < 1.2 * names.misfit) {
    names.notes.push_back(fmt::format(
        "the bones fit a {} hand little better than the other one ({:.1f} against {:.1f}): check "
        "the side",
        name_of(names.side), names.misfit, names.other_misfit));
  }
  return names;
}

}  // namespace palmar::capture
