// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/named_postures.h"

#include <array>
#include <cstddef>

#include "palmar/geometry/degrees.h"

namespace palmar::hand {
namespace {

struct FingerAngles {
  double mcp = 0, pip = 0, dip = 0;  ///< flexion, degrees
  double abduction = 0;              ///< from the reference posture, towards the thumb, degrees
};

struct NamedAngles {
  std::string_view name;
  double cmc_flexion = 0, cmc_abduction = 29, mp = 0, ip = 0;  ///< degrees
  std::array<FingerAngles, 4> finger;                          ///< index to little
};

constexpr std::array<NamedAngles, 10> kPostures = {{
    {"flat", -20, 0, 0, 0, {{{0, 0, 0, -2}, {0, 0, 0, 1}, {0, 0, 0, 5}, {0, 0, 0, 5}}}},
    {"relaxed",
     4,
     32,
     12,
     12,
     {{{22, 28, 10, 0}, {28, 32, 12, 1}, {32, 34, 13, 4}, {36, 34, 13, 4}}}},
    {"spread", -20, 30, -8, -8, {{{0, 2, 0, 16}, {0, 2, 0, 1}, {0, 2, 0, -9}, {0, 2, 0, -24}}}},
    {"fist",
     -10,
     45,
     50,
     34,
     {{{84, 86, 65, 5}, {84, 86, 62, 2}, {86, 92, 55, 2}, {84, 88, 62, 5}}}},
    {"point", -4, 50, 42, 48, {{{4, 6, 2, 0}, {82, 94, 63, 2}, {85, 92, 55, 2}, {83, 88, 62, 5}}}},
    {"thumb_to_little",
     28,
     59,
     43,
     10,
     {{{12, 18, 8, 0}, {20, 25, 10, 1}, {34, 40, 15, 2}, {37, 62, 27, -3}}}},
    {"key_pinch",
     5,
     23,
     31,
     3,
     {{{54, 90, 40, 0}, {62, 86, 33, 1}, {66, 88, 33, 3}, {68, 86, 42, 5}}}},
    {"tip_pinch",
     20,
     51,
     0,
     35,
     {{{48, 56, 31, 0}, {20, 25, 10, 1}, {16, 22, 8, 2}, {12, 20, 8, 2}}}},
    {"tripod",
     20,
     47,
     3,
     18,
     {{{50, 50, 35, 0}, {59, 59, 46, 1}, {46, 54, 24, 2}, {42, 50, 24, 2}}}},
    {"cylinder_grip",
     15,
     45,
     15,
     20,
     {{{45, 50, 28, 0}, {48, 52, 30, 2}, {52, 52, 30, 4}, {56, 50, 28, 5}}}},
}};

void set(Posture& posture, Dof dof, double angle_deg) {
  posture[dof] = geometry::kDegree * angle_deg;
}

}  // namespace

std::vector<std::string> posture_names() {
  std::vector<std::string> names;
  for (const NamedAngles& one : kPostures) names.emplace_back(one.name);
  return names;
}

std::optional<Posture> named_posture(const Skeleton& skeleton, std::string_view name) {
  for (const NamedAngles& one : kPostures) {
    if (one.name != name) continue;
    Posture posture = reference_posture(skeleton);
    set(posture, Dof::kThumbCmcFlexion, one.cmc_flexion);
    set(posture, Dof::kThumbCmcAbduction, one.cmc_abduction);
    set(posture, Dof::kThumbMpFlexion, one.mp);
    set(posture, Dof::kThumbIpFlexion, one.ip);
    for (std::size_t f = 0; f < one.finger.size(); ++f) {
      const int first = static_cast<int>(Dof::kIndexMcpFlexion) + 4 * static_cast<int>(f);
      const FingerAngles& angles = one.finger[f];
      set(posture, static_cast<Dof>(first), angles.mcp);
      posture[static_cast<Dof>(first + 1)] += geometry::kDegree * angles.abduction;
      set(posture, static_cast<Dof>(first + 2), angles.pip);
      set(posture, static_cast<Dof>(first + 3), angles.dip);
    }
    return clamp_to_range(skeleton, posture).posture;
  }
  return std::nullopt;
}

}  // namespace palmar::hand
