// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_labels.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/winding_number.h"

namespace palmar::capture {
namespace {

constexpr double kReach = 3.0;  // mm

std::string text_of(const Vec3& p) {
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", p.x(), p.y(), p.z());
}

void check_names(const std::vector<hand::BoneLabel>& labels, const hand::Hand& model) {
  std::vector<std::string> known;
  for (const hand::Bone& bone : model.bones) known.push_back(bone.name);
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const hand::BoneLabel& label = labels[k];
    if (std::find(known.begin(), known.end(), label.name) == known.end()) {
      throw InputError(
          label.place + ": \"" + label.name + "\" is no bone of the hand; " +
          did_you_mean(label.name, known, "index_middle_phalanx, for one, is allowed"));
    }
    for (std::size_t j = 0; j < k; ++j) {
      if (labels[j].name == label.name) {
        throw InputError(label.place + ": " + label.name + " appears twice, first in " +
                         labels[j].place);
      }
    }
  }
}

}  // namespace

void apply_bone_labels(ScanSurfaces& surfaces, const std::vector<hand::BoneLabel>& labels,
                       const hand::Hand& model) {
  check_names(labels, model);
  if (labels.empty()) return;
  std::vector<geometry::ClosestPointQuery> near;
  for (const ScannedBone& bone : surfaces.bones) near.emplace_back(bone.mesh);
  std::vector<int> label_of(surfaces.bones.size(), -1);
  for (std::size_t k = 0; k < labels.size(); ++k) {
    int best = -1;
    double least = kReach;
    for (std::size_t b = 0; b < surfaces.bones.size(); ++b) {
      const auto hit = near[b].closest(labels[k].point);
      if (!hit) continue;
      const bool is_inside =
          geometry::exact_winding_number(surfaces.bones[b].mesh, labels[k].point) > 0.5;
      const double distance = is_inside ? 0.0 : hit->distance;
      if (distance < least || (is_inside && best < 0)) {
        least = distance;
        best = static_cast<int>(b);
      }
    }
    if (best < 0) {
      throw InputError(fmt::format("{}: no bone was found within {:.0f} mm of {} for {}",
                                   labels[k].place, kReach, text_of(labels[k].point),
                                   labels[k].name));
    }
    int& taken = label_of[best];
    if (taken >= 0) {
      throw InputError(labels[k].place + ": " + labels[k].name + " and " + labels[taken].name +
                       " (" + labels[taken].place + ") are on the same bone");
    }
    taken = static_cast<int>(k);
  }
  for (std::size_t b = 0; b < surfaces.bones.size(); ++b) {
    if (label_of[b] >= 0) {
      surfaces.bones[b].name = labels[label_of[b]].name;
      continue;
    }
    const bool is_given_away = std::any_of(
        labels.begin(), labels.end(),
        [&](const hand::BoneLabel& label) { return label.name == surfaces.bones[b].name; });
    if (is_given_away) surfaces.bones[b].name.clear();
  }
}

}  // namespace palmar::capture
