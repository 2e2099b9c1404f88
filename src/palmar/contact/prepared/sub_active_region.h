// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/solve/lcp.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar::contact {

// The steps of Xie 2014, section 3.3.2, as they are printed: A3 to A6. What the thesis leaves open,
// and what is taken for it, stands in docs/method/xie2014.md. Used with BulgeLaw::kPrinted.

/// A3. Distance of each vertex to the nearest point of the product, whatever side the skin came
/// from. Collision region: the penetrating vertices of the 19 regions; those of the dorsum, which
/// is none of them, are left out and named in the message. Fills all of `skin` but `traced`.
void find_skin_as_printed(const hand::Hand& hand, const std::vector<Vec3>& posed,
                          const geometry::DistanceField& product, std::optional<hand::Region> only,
                          SkinOnProduct& skin);

/// Rings of neighbours that cover `range` [mm] where edges are `mean_edge` [mm] long; the thesis
/// has 5 for 12.5 mm and 7 for 17.5 mm at 2.5 mm. At least 1.
int neighbour_rings(double range, double mean_edge);

/// A4. The collision region with its rings of neighbours, each vertex' as its own region has them,
/// across the borders of regions but not onto the dorsum; ascending.
std::vector<int> active_region(const hand::Hand& hand, const SkinGeometry& skin,
                               const std::vector<int>& collision);

/// Part of the active region in one of the 19 regions, with its own numbers.
struct SubActiveRegion {
  hand::Region region{};
  std::vector<int> vertex;     ///< ascending
  double d_max = 0.0;          ///< deepest penetration, mm
  double shear_modulus = 0.0;  ///< G(d_max), eq. (3-3), MPa
  double swelling = 0.0;       ///< a(d_max) outside the collision region, eq. (3-6), mm/N
};

/// A5 and eq. (3-3), (3-6): the sub-active regions that hold a penetrating vertex, ascending by
/// region (the others carry no force). `shear_modulus` [MPa] replaces G(d_max).
std::vector<SubActiveRegion> sub_active_regions(const PreparedHand::Impl& prepared,
                                                const SkinOnProduct& skin, hand::TissueLevel level,
                                                std::optional<double> shear_modulus);

/// Law of eq. (3-3) at a level of the tissue. G0 is the low end of the tissue's range at every
/// level: above about 10 kPa in the palm the printed equations have no solution in a power grasp.
hand::StiffeningLaw printed_law(const hand::RegionTissue& tissue, hand::TissueLevel level);

/// A6, the problem of eq. (3-10) to (3-13). R_act = R_Bou / G - a R_Gau, the second term in the
/// rows of vertices outside the collision region only (eq. 3-12).
ContactProblem printed_problem(const PreparedHand::Impl& prepared, const SubActiveRegion& part,
                               const SkinOnProduct& skin);

/// a R_Gau p in the rows outside the collision region, 0 in the others: how far the bulge stands
/// out, mm.
Eigen::VectorXd printed_bulge(const PreparedHand::Impl& prepared, const SubActiveRegion& part,
                              const SkinOnProduct& skin, const Eigen::VectorXd& force);

/// Area of the triangles with a corner that carries force, shared by the corners that do, mm^2 per
/// vertex (section 3.4.1: the sum of the area of each triangle in the contact region).
std::vector<double> contact_triangles(const std::vector<Vec3>& positions,
                                      const std::vector<Triangle>& triangles,
                                      const std::vector<double>& force);

}  // namespace palmar::contact
