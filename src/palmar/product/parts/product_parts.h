// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/product.h"

namespace palmar::product {

enum class PartKind {
  kBar,   ///< what a hand closes round: straight, curved or tapered
  kPen,   ///< a thin straight bar that is the whole product
  kLoop,  ///< a bar that joins at both ends, or a ring, with room for a finger within
  kBody,  ///< thicker than a hand closes round, or as short as it is thick; cups count as solid
  kBall,  ///< as long as wide as thick, and round
  kPlate  ///< thin in one direction
};
std::string name_of(PartKind kind);  ///< "bar", "pen", "loop", "body", "ball", "plate"

/// A section across a part's centre line. Product frame, mm. Holes within don't count.
struct PartSection {
  double along = 0.0;          ///< fraction of the part's length, 0 to 1
  Vec3 centre = Vec3::Zero();  ///< of the section's area
  Vec3 axis = Vec3::UnitX();   ///< unit, along the centre line
  Vec3 wide = Vec3::UnitY();   ///< unit, across the smallest thickness; its sign means nothing
  double area = 0.0;           ///< mm^2
  double girth = 0.0;          ///< of a tape put round it
  double width = 0.0;          ///< extent along `wide`
  double thickness = 0.0;      ///< smallest distance of two parallel tangents
};

/// A point of the centre line with the frame that turns are measured in.
struct PartStation {
  double along = 0.0;          ///< fraction of the part's length, 0 to 1
  Vec3 centre = Vec3::Zero();  ///< mm
  Vec3 axis = Vec3::UnitX();   ///< unit, along the centre line
  Vec3 zero = Vec3::UnitZ();   ///< unit, across the axis: turn 0
};

/// The opening of a loop, in the plane in which the loop lies.
struct PartOpening {
  Vec3 centre = Vec3::Zero();  ///< of the largest disc, mm
  Vec3 axis = Vec3::UnitZ();   ///< unit, across the plane; its sign means nothing
  Vec3 wide = Vec3::UnitX();   ///< unit, in the plane, along the width
  double disc = 0.0;           ///< diameter of the largest disc, mm
  double width = 0.0;          ///< longer side of the narrowest rectangle round it, mm
  double height = 0.0;         ///< shorter side, mm
};

/// Where the girth is least: the waist of a bottle, or its neck.
struct PartWaist {
  double along = 0.0;    ///< fraction of the part's length
  double girth = 0.0;    ///< mm
  bool is_neck = false;  ///< thinner than 0.6 of the largest girth
};

/// What an end of a part does.
struct PartEnd {
  Vec3 point = Vec3::Zero();  ///< on the centre line, mm
  std::optional<int> joined;  ///< number of the part that it joins; none: free
};

/// A part of a product that a hand can take hold of. Product frame, mm.
struct ProductPart {
  int number = 0;  ///< from 1: its place in ProductParts::parts + 1
  PartKind kind = PartKind::kBody;
  std::string name;  ///< "handle", "bar", "shaft", "loop", "ring", "body", "plate", "ball", ...
  std::vector<PartStation> line;      ///< centre line from along = 0 to 1, or once round a ring
  std::vector<PartSection> sections;  ///< evenly along the line
  bool is_ring = false;               ///< the line is closed: along 1 is along 0
  double length = 0.0;                ///< of the line, mm
  double straightness = 1.0;          ///< distance of the ends / length; 0 of a ring
  double girth = 0.0, width = 0.0, thickness = 0.0;  ///< medians over the sections
  double volume = 0.0;                               ///< about, cavities filled, mm^3
  double area = 0.0;                                 ///< of its triangles, mm^2
  std::array<PartEnd, 2> ends;                       ///< empty of a ring
  std::vector<int> joined;             ///< numbers of the parts that it touches, ascending
  std::optional<PartOpening> opening;  ///< of a loop
  std::vector<PartWaist> waists;       ///< of a body
  std::optional<Vec3> face_normal;     ///< of a plate; its sign means nothing

  /// Diameter of the circle with its girth, mm.
  double diameter() const;
};

/// Something small in front of a bar, next to what the bar carries, that a finger which reaches
/// round the bar comes to lie on: the trigger of a drill or of a spray bottle.
struct PartTrigger {
  int part = 1;                ///< number of the bar
  std::size_t end = 1;         ///< of its two ends the one that it is next to
  Vec3 point = Vec3::Zero();   ///< middle of its front, product frame, mm
  Vec3 front = Vec3::UnitX();  ///< unit, across the bar: where it faces
  double along = 1.0;          ///< of the part; may lie beyond its end
  double length = 0.0;         ///< along the bar, mm
  double reach = 0.0;          ///< it stands so far before the bar, mm
};

/// Something low on a flat face that a fingertip presses. Product frame, mm.
struct PartButton {
  int part = 1;                 ///< number of the part that it is on
  Vec3 point = Vec3::Zero();    ///< middle of its top
  Vec3 normal = Vec3::UnitZ();  ///< unit, out of the face
  double width = 0.0;           ///< the smaller of its two extents along the face
  double height = 0.0;          ///< how far it stands out
};

struct PartOptions {
  /// mm; a tunnel or gap that a disc of this diameter can't pass counts as closed. The index
  /// finger of women is 16 mm thick at its distal joint on average (circumference 50.8 mm, Greiner
  /// 1991), the little finger less; three quarters of it: choice.
  double finger = 12.0;
  int voxels = 250000;  ///< about; how fine the product is looked at, 10 000 to 4 000 000
  void check() const;   ///< throws UsageError: field, value, allowed range
};

struct ProductParts {
  std::vector<ProductPart> parts;     ///< largest volume first
  std::vector<int> part_of_triangle;  ///< index into `parts`, one per triangle of the mesh
  std::vector<PartTrigger> triggers;
  std::vector<PartButton> buttons;  ///< largest first
  /// Tunnels of the mesh that are no loop: too narrow for a finger, or faults of a scan; nothing
  /// unless the mesh is closed and 2-manifold.
  std::optional<int> narrow_tunnels;

  /// Index into `parts` of the part that is nearest to a point of the product's frame.
  int nearest(const Product& product, const Vec3& point) const;
};

/// Takes a product apart into what hands take hold of.
///
/// The product is looked at as voxels in a frame of its own (solid_grid.h), thinned to lines
/// (voxel_skeleton.h), which are cut where it becomes much thinner and put together where it is
/// convex (rough_parts.h). Everything told about a part is then measured on the mesh itself, by
/// sections across its centre line; so it doesn't depend on the voxels nor on how the surface is
/// meshed, only where a part ends depends on them a little. Deterministic on any number of threads.
///
/// A product that is moved, turned or mirrored has the same parts; where it is symmetric, the
/// direction of `along` and turn 0 are arbitrary among those that symmetry makes equal. A bar with
/// one free end runs from there; others towards the middle of the product's surface, else towards
/// their thicker half. Turn 0 points to the opening of a loop, else to the middle of the product's
/// surface, else (round: arbitrary) along the width. Seen against the axis, turns are
/// counter-clockwise; on a mirrored product they have the other sign.
///
/// Throws UsageError for options out of range. A product without triangles has no parts.
ProductParts find_parts(const Product& product, const PartOptions& options = {});

}  // namespace palmar::product
