// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/hand/anatomy.h"

namespace palmar::contact {

/// A vertex of the skin over another part of the same skin.
struct SkinMeeting {
  int vertex = 0;
  Triangle on{};                   ///< the triangle below which the vertex is, or above
  std::array<double, 3> weight{};  ///< barycentric, of the point that faces it
  Vec3 normal =
      Vec3::Zero();       ///< unit, common to both: out of the triangle's skin, into the vertex'
  double distance = 0.0;  ///< mm along it; negative where the two cross
};

/// Skin pressed on other skin of the same hand: `force` along meeting.normal on the vertex, the
/// opposite on the triangle's corners in parts of its weights.
struct SkinTouch {
  SkinMeeting meeting;
  double force = 0.0;  ///< N, more than 0
};

/// All touches between two regions of a hand's skin.
struct SkinOnSkin {
  hand::Region region{}, other{};    ///< whose skin brings the vertices, and whose the triangles
  double force = 0.0;                ///< sum over the touches, N
  Vec3 force_vector = Vec3::Zero();  ///< on `region`, N; in the frame of the normals
  double area = 0.0;                 ///< of the skin of `region` that touches, mm^2
  double peak_pressure = 0.0;        ///< MPa
  double deepest = 0.0;              ///< largest crossing before the skin gives way, mm
};

/// Per pair of regions, ascending. `area` [mm^2] per skin vertex, `skin_region` likewise.
std::vector<SkinOnSkin> skin_on_skin(const std::vector<SkinTouch>& touches,
                                     const std::vector<hand::Region>& skin_region,
                                     const std::vector<double>& area);

}  // namespace palmar::contact
