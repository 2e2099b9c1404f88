// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/product_faces.h"
#include "palmar/redesign/held_hand.h"
#include "palmar/redesign/imprint.h"

namespace palmar::redesign {

/// Parts of the hand that a product's designer distinguishes (Xie 2014, fig. 5-16: red and blue).
enum class HandPart { kFingers, kThumb, kPalm };
inline constexpr int kHandParts = 3;
std::string name_of(HandPart part);  ///< "fingers", "thumb", "palm"
/// Nothing of the dorsum.
std::optional<HandPart> part_of(hand::Region region);

/// How many hands touch each vertex of a product's map.
struct ContactCount {
  int hands = 0;
  double threshold = 0.0;                            ///< MPa; a hand touches where it presses more
  std::vector<int> any;                              ///< per vertex
  std::array<std::vector<int>, kHandParts> of_part;  ///< per vertex, with that part of the hand
};
/// Nobody yet. Throws UsageError unless the threshold is at least 0.
ContactCount start_count(const geometry::TriangleMesh& map, double threshold = 0.0);
/// One hand more. Touched is where the product's pressure says so, and, because the skin's facets
/// cut sharp edges short there, wherever the skin as it was before it gave way reaches in (`reach`,
/// per vertex of the map) and the nearest pressed skin presses enough. A vertex belongs to the part
/// of the hand whose pressed skin, before it gave way, is nearest.
void add_hand(ContactCount& count, const geometry::TriangleMesh& map, const HeldHand& held,
              const Imprint& reach = {});

struct RegionOptions {
  /// Share of the hands that must touch, 0 to 1; 0: any hand.
  double share = 0.5;
  /// mm; corners of the region are rounded like by a bell of this standard deviation. A map's edges
  /// are up to 3 mm long, and hands agree no better than that.
  double smoothing = 2.0;
  double smallest_area = 20.0;  ///< mm^2; smaller specks and holes are dropped
  double spacing = 1.0;         ///< mm, of the outlines' points
  void check() const;           ///< throws UsageError: field, value, allowed range
};

/// Closed outline; seen from outside of the product the region is on its left.
struct RegionOutline {
  std::vector<Vec3> points;  ///< on the surface, evenly spaced, mm; the first isn't repeated
  double length = 0.0;       ///< mm
};

/// One piece of a region that hangs together.
struct RegionPatch {
  double area = 0.0;                   ///< mm^2
  Vec3 centre = Vec3::Zero();          ///< mean of its surface, mm
  std::vector<int> vertices;           ///< of the map, inside
  std::vector<RegionOutline> outline;  ///< a belt round a handle has two, a disc one
};

/// Where a share of the hands touch a product.
struct ContactRegion {
  std::string title;                 ///< "fingers, half of 30 hands"
  std::optional<HandPart> part;      ///< nothing: the whole hand
  int least_hands = 0;               ///< that touch everywhere inside
  std::vector<double> field;         ///< per vertex of the map; inside from 0 on
  std::vector<double> area_of;       ///< mm^2 inside, per triangle of the map
  double area = 0.0;                 ///< mm^2
  std::vector<RegionPatch> patches;  ///< the largest first
  int dropped_specks = 0, dropped_holes = 0;
  double dropped_area = 0.0;  ///< mm^2, of both
};

/// The region of the whole hand, or of one part of it. The count's "inside or not" is smoothed
/// along the surface, specks and holes below the smallest area are dropped, the level lines are
/// spaced evenly, smoothed without shrinking (Taubin 1995) and projected back onto the surface.
/// Empty, without patches, if too few hands touch anywhere. Throws UsageError if count and map
/// don't belong together.
ContactRegion contact_region(const geometry::TriangleMesh& map, const ContactCount& count,
                             std::optional<HandPart> part = {}, const RegionOptions& options = {});

/// How much of one CAD face lies in a region.
struct FaceShare {
  int face = 0;             ///< index into ProductFaces::face
  double area = 0.0;        ///< mm^2, inside
  double share = 0.0;       ///< of the face
  double peak_hands = 0.0;  ///< largest share of hands that touch one place of it
};
/// Faces with any area inside, the largest first. `face_of_triangle` is that of the map.
std::vector<FaceShare> face_shares(const geometry::TriangleMesh& map,
                                   const std::vector<int>& face_of_triangle, int faces,
                                   const ContactCount& count, const ContactRegion& region);

}  // namespace palmar::redesign
