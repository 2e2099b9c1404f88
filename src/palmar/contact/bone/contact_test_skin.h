// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Skins whose compliance is known, and bodies with an edge, for the tests of this module.

#include <cmath>
#include <memory>

#include "palmar/contact/bone/half_space_tensor.h"
#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/contact.h"
#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/hand/tissue.h"

namespace palmar::contact::contact_test {

/// Every pair of vertices as discs on a half-space.
inline SkinCompliance half_space_compliance(const SkinGeometry& skin) {
  SkinCompliance result;
  result.begin.push_back(0);
  for (int i = 0; i < skin.vertex_count(); ++i) {
    result.vertex.push_back(i);
    for (int j = 0; j <= i; ++j) {
      result.other.push_back(j);
      result.tensor.push_back(disc_tensor(skin.position[i] - skin.position[j], skin.radius[i],
                                          skin.radius[j], skin.normal[i], skin.normal[j])
                                  .cast<float>());
    }
    result.begin.push_back(result.other.size());
  }
  return result;
}

inline ContactModel on_bone_model() {
  ContactModel model;
  model.tissue = TissueModel::kBone;
  return model;
}

/// Flat skin in the plane z = 0 on a half-space, prepared as tissue on bone.
inline PreparedHand flat_skin_on_half_space(double radius, double spacing) {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "flat";
  hand->skin = geometry::make_lattice_patch(radius, spacing);
  hand->region.assign(hand->skin.vertices.size(), hand::Region::kCentralPalm);
  hand->segment.assign(hand->region.size(), hand::Segment::kPalm);
  hand->tissue = hand::default_tissue();
  const auto compliance =
      std::make_shared<const SkinCompliance>(half_space_compliance(skin_geometry(hand->skin)));
  return PreparedHand(hand, on_bone_model(), compliance);
}

constexpr double kTipRadius = 9.0;  // mm

/// A fingertip of sorts: a ball of skin about the origin round a ball of bone.
inline PreparedHand tip_on_bone(int subdivisions) {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "tip";
  hand->skin = geometry::make_icosphere(kTipRadius, subdivisions);
  hand->region.assign(hand->skin.vertices.size(), hand::Region::kIndexDistal);
  hand->segment.assign(hand->region.size(), hand::Segment::kIndexDistal);
  hand->bones.emplace_back().mesh = geometry::make_icosphere(4.0, 3);
  hand->tissue = hand::default_tissue();
  return PreparedHand(hand, on_bone_model());
}

/// The tip on the edge between two faces of a bar, `depth` deep from first touch.
inline ContactResult press_on_edge(const PreparedHand& tip, double fillet, double depth,
                                   const ContactOptions& options) {
  const auto bar = geometry::make_prism_distance(
      {.width = 40, .depth = 40, .length = 60, .fillet_radius = fillet});
  const double apex = std::sqrt(2.0) * (20.0 - fillet) + fillet;
  const double away = (apex + kTipRadius - depth) / std::sqrt(2.0);
  geometry::Rigid3 place;
  place.translation = Vec3(away, away, 0.0);
  return solve_hand_contact(tip, tip.hand().skin.vertices, place, *bar, options);
}

/// The tip on the edge of a plate, `depth` deep from first touch.
inline ContactResult press_on_plate(const PreparedHand& tip, double thickness, double depth,
                                    const ContactOptions& options) {
  constexpr double kHeight = 40.0;  // mm
  const auto plate = geometry::make_box_distance(Vec3(thickness, kHeight, kHeight));
  geometry::Rigid3 place;
  place.translation = Vec3(0.0, 0.0, 0.5 * kHeight + kTipRadius - depth);
  return solve_hand_contact(tip, tip.hand().skin.vertices, place, *plate, options);
}

}  // namespace palmar::contact::contact_test
