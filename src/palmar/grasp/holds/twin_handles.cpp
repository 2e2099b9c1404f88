// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/twin_handles.h"

#include <algorithm>
#include <cmath>

#include "palmar/geometry/degrees.h"

namespace palmar::grasp {
namespace {

constexpr double kTwinLength = 1.5;                           // times
constexpr double kNearestTwin = 10.0, kFarthestTwin = 100.0;  // mm
const double kTwinAngle = std::cos(35.0 * geometry::kDegree);

bool is_arm(const product::ProductPart& part) {
  return part.kind == product::PartKind::kBar && !part.joined.empty() && part.line.size() > 1 &&
         (!part.ends[0].joined || !part.ends[1].joined);
}

Vec3 chord_of(const product::ProductPart& part) {
  return (part.line.back().centre - part.line.front().centre).normalized();
}

}  // namespace

const product::ProductPart* twin_of(const product::ProductPart& part,
                                    const product::ProductParts& parts) {
  // What stands before a handle and is as long is its trigger.
  if (!is_arm(part) || !parts.triggers.empty()) return nullptr;
  for (const product::ProductPart& other : parts.parts) {
    if (other.number == part.number || !is_arm(other)) continue;
    const bool meet = std::any_of(part.joined.begin(), part.joined.end(), [&](int number) {
      return number == other.number ||
             std::find(other.joined.begin(), other.joined.end(), number) != other.joined.end();
    });
    if (!meet ||
        std::max(part.length, other.length) > kTwinLength * std::min(part.length, other.length)) {
      continue;
    }
    const Vec3 along = chord_of(part);
    if (std::abs(along.dot(chord_of(other))) < kTwinAngle) continue;
    Vec3 apart = 0.5 * (part.line.front().centre + part.line.back().centre) -
                 0.5 * (other.line.front().centre + other.line.back().centre);
    const double shift = std::abs(along.dot(apart));
    apart -= along * along.dot(apart);
    if (apart.norm() < kNearestTwin || apart.norm() > kFarthestTwin) continue;
    if (shift > 0.5 * std::min(part.length, other.length)) continue;  // one after the other
    return &other;
  }
  return nullptr;
}

}  // namespace palmar::grasp
