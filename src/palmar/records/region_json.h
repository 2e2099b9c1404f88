// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "palmar/redesign/ridge_relief.h"
#include "palmar/redesign/surface_fit.h"

namespace palmar::records {

/// A closed curve through points, for CAD.
struct NamedCurve {
  std::string name;               ///< as a CAD system shows it
  std::array<float, 3> colour{};  ///< sRGB, 0 to 1
  std::vector<Vec3> points;       ///< mm; the first isn't repeated
};

/// A part of a simple surface, for CAD.
struct NamedSurface {
  std::string name;
  std::array<float, 3> colour{};
  redesign::SimpleSurface surface;
  std::vector<Vec3> points;   ///< that it covers, mm; near the surface
  std::vector<Vec3> outline;  ///< that it ends at, projected onto the surface; may be empty
};

// Curves, surfaces and reliefs as the CAD program is given them (apps/palmar-cad/region.cpp): under
// "curves", "surfaces", "reliefs" of its request. Reading what isn't so throws InputError.
nlohmann::ordered_json region_request(const std::vector<NamedCurve>& curves,
                                      const std::vector<NamedSurface>& surfaces,
                                      const std::vector<redesign::RidgeRelief>& reliefs);
std::vector<NamedCurve> region_curves(const nlohmann::ordered_json& request);
std::vector<NamedSurface> region_surfaces(const nlohmann::ordered_json& request);
std::vector<redesign::RidgeRelief> region_reliefs(const nlohmann::ordered_json& request);

}  // namespace palmar::records
