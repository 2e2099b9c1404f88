// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/redesign/contact_region.h"

namespace palmar::redesign {

/// One ridge of a handle (an edge, a narrow side of an ellipse) rounded over the length where hands
/// touch it: a shape that can be machined. A round cutter leaves a cylinder that touches the flanks
/// on both sides without an edge; at both ends of the length the cutter leaves the material along
/// an arc, which makes a torus.
///
/// With s along the axis from `start`, h along `outward`, w across both, material is cut where
///
///     |s range|  sqrt(w^2 + h^2) > R,  |angle(w, h)| <= half_angle;
///
/// beyond the ends, where the cutter's path is an arc of radius r about h = R + r, the same with
/// H = R + r - sqrt(ds^2 + (h - R - r)^2) in the place of h.
struct RidgeRelief {
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();    ///< on the cylinder's axis, mm
  Vec3 outward = Vec3::UnitX();                     ///< unit, across the axis, towards the ridge
  double radius = 0.0;                              ///< R, mm
  double half_angle = 0.0;                          ///< rad; where the cylinder touches the flanks
  double run_out = 0.0;                             ///< r, mm
  double depth = 0.0;                               ///< mm, by which the ridge goes back
  double radius_before = 0.0;                       ///< mm; of the ridge, about
  bool is_open_start = false, is_open_end = false;  ///< goes on through the product's end
  std::string name;                                 ///< "relief 1"
};
bool is_cut(const RidgeRelief& relief, const Vec3& x);
/// The point of the relief's surface that a point which is cut away goes to.
Vec3 onto_relief(const RidgeRelief& relief, const Vec3& x);

struct ReliefOptions {
  std::optional<Vec3> axis;  ///< unit, along the handle; unset: the longest extent
  /// Share of the hands' mean imprint that the rounding is fitted to.
  double share = 1.0;
  double largest_depth = 4.0;    ///< mm, by which a ridge may go back: keeps the overall shape
  double smallest_radius = 6.0;  ///< mm; of the cutter. Ridges get no smaller one
  double run_out = 40.0;         ///< mm; radius of the arc along which the cutter leaves
  double margin = 3.0;           ///< mm; the full rounding goes on beyond the region
  void check() const;            ///< throws UsageError: field, value, allowed range
};

/// The reliefs of a handle, and what wasn't rounded and why.
struct ReliefPlan {
  Vec3 axis = Vec3::UnitZ();
  std::vector<RidgeRelief> reliefs;
  std::vector<std::string> notes;
};

/// Derives reliefs from where hands touch and how deep they reach in.
///
/// The handle is cut across its axis in the middle of the region's length, and at both ends of what
/// the region covers of each ridge. A ridge is where a disc of 0.95 times the radius of the largest
/// one inside the section doesn't reach the outline. Among the radii of whole half millimetres,
/// from the smallest allowed to that disc, the one is taken whose cylinder, tangent to both flanks,
/// is nearest to the imprint in least squares over the region's surface at that ridge, and which
/// doesn't cut deeper than allowed.
///
/// `imprint`: mean depth over hands per vertex of the map, mm. Throws UsageError naming what is
/// missing if nothing can be rounded: the region is empty, no ridge, no closed section.
ReliefPlan plan_reliefs(const geometry::TriangleMesh& map, const ContactRegion& region,
                        const ContactRegion& reach, const std::vector<double>& imprint,
                        const ReliefOptions& options = {});

/// The mesh with its reliefs: triangles near them are split to `edge_length` [mm], and vertices
/// that are cut away go onto the relief. Faces stay as they are connected. For bodies without a CAD
/// model, and where no CAD kernel is at hand; the solid itself is made by cut_reliefs() of module
/// cad.
geometry::TriangleMesh relieved_mesh(const geometry::TriangleMesh& mesh,
                                     std::span<const RidgeRelief> reliefs,
                                     double edge_length = 1.0);

}  // namespace palmar::redesign
