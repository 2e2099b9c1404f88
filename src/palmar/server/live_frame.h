// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palmar/contact/contact.h"
#include "palmar/contact/footprint/footprint.h"
#include "palmar/contact/footprint/moving_footprint.h"
#include "palmar/grasp/grasp.h"
#include "palmar/hand/hand.h"

namespace palmar::server {

// What the live channel sends as bytes: little-endian numbers, read by
// apps/workbench/bench/live_frame.ts. Every frame begins with 4 times uint32: kFrameMagic, its
// kind, the request that it answers, a number (which hold; else 0).

inline constexpr std::uint32_t kFrameMagic = 0x314d4c50;  // "PLM1"

enum class FrameKind : std::uint32_t {
  kHand = 1,     ///< vertices, triangles, region of each vertex
  kProduct = 2,  ///< product frame, mm
  kMoving = 3,   ///< a field along a motion
  kAtRest = 4,   ///< a field with everything else finished
  kPreview = 5,  ///< a hold to choose from: skin without contact
  kFootprint = 6,
};

/// Of a product, for browsers without a good GPU.
inline constexpr int kMostShownTriangles = 120'000;

struct FrameHead {
  FrameKind kind{};
  std::uint32_t request = 0;
  std::uint32_t number = 0;
};

/// uint32 vertices, uint32 triangles, uint32 x 3 per triangle, uint8 region per vertex.
std::string hand_frame(const hand::Hand& hand, std::uint32_t request);

/// uint32 vertices, uint32 triangles, float32 x 3 per vertex, uint32 x 3 per triangle.
std::string product_frame(const geometry::TriangleMesh& mesh, std::uint32_t request);

/// The same with float32 pressure [MPa] per vertex behind it.
std::string footprint_frame(const contact::ProductFootprint& footprint, std::uint32_t request);

/// What is shown of a posed hand on a product.
struct LiveField {
  hand::Posture posture;
  geometry::Rigid3 product_from_hand;
  double grip_force = 0.0;                          ///< N
  const contact::ContactResult* contact = nullptr;  ///< null: none was solved
  const std::vector<Vec3>* posed_skin = nullptr;    ///< hand frame, mm; used without contact
  /// Along a motion: on the product's mesh as it was sent.
  const contact::MovingFootprint::Loaded* on_product = nullptr;
};

/// Places are kept to this, or to what spans the hand in 65535 steps.
inline constexpr double kFrameStep = 0.005;  // mm

/// float64 quaternion w, x, y, z and translation [mm] of product_from_hand; float32 grip force,
/// force [N], area [mm^2], peak, peak on sensor cells, mean [MPa]; uint32 ContactStatus; float32 x
/// 23 angles [deg]; float32 x 3 lower corner, float32 step [mm]; float32 step of pressures [MPa];
/// uint32 regions in contact, each 6 float32: region, force, area, peak, peak on cells, mean;
/// uint32 vertices; uint16 x 3 per vertex: place in the hand's frame, in steps from the corner;
/// uint16 per vertex: pressure, in steps; uint32 vertices of the product that are pressed on,
/// uint32 per such vertex: which; uint16 per such vertex: pressure, in the same steps.
std::string field_frame(const LiveField& field, const FrameHead& head);

}  // namespace palmar::server
