// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/grasp/precision/reach.h"

namespace palmar::records {

/// What `palmar grasp reach --json` prints: {"grasp": {"grip", "status", "message"}, "buttons":
/// [{"name", "point_mm", "force_n", "best": finger or null, "message", "fingers": [{"finger",
/// "reached", "blocked", "miss_mm", "tilt_deg", "margin_deg", "tightest", "awkward", "grip_kept",
/// "posture"}]}], "map": null or {"points", "reached_area_mm2", "surface_area_mm2"}}.
std::string reach_json(const grasp::Grasp& grasp, const std::vector<grasp::ButtonReach>& buttons,
                       const grasp::ReachMap* map, double surface_area);

/// The product's surface with the map as point data (VTK PolyData, vtk.h): finger (-1 nobody, 0
/// thumb ... 4 little), margin_deg, miss_mm.
std::string format_reach_map(const geometry::TriangleMesh& surface, const grasp::ReachMap& map);

}  // namespace palmar::records
