// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/response/skin_geometry.h"

namespace palmar::contact {

/// Compliance of a skin of which parts were divided, from that of the skin before:
///
///     C = w H + P (C_0 - w H_0) P^T
///
/// C_0: before; H_0, H: the half-space among the discs of its vertices before and after
/// (disc_tensor()); w: 1 up to 3.6 edges of the skin before, 0 from 7.2 on; P: the shares of the
/// vertices before in those after, linear on each triangle. What is between is smooth over an edge:
/// bones and the shape of the hand act there (skin_compliance.h). What is narrower the half-space
/// has in closed form, so that a small patch has the compliance of a small patch. On a half-space
/// entries are exact within 1 % up to 3 edges, and beyond within 0.3 % of a vertex' own. Where
/// nothing was divided C is C_0. Symmetric as listed.
///
/// `scale` as in LoadedSkin, of `compliance` to the skin `before`; the result is the skin's own.
/// `share` per vertex after; the first are those before. Vertices whose shares lie on skin without
/// compliance have none. Pairs of a new vertex with a vertex that isn't `wanted` (per vertex after)
/// are left out.
SkinCompliance divided_compliance(const SkinCompliance& compliance,
                                  const std::vector<double>& scale, const SkinGeometry& before,
                                  const SkinGeometry& after,
                                  const std::vector<std::vector<std::pair<int, double>>>& share,
                                  const std::vector<char>& wanted,
                                  double reach = SkinComplianceOptions{}.reach);

}  // namespace palmar::contact
