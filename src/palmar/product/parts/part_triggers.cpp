// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_triggers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/product/parts/part_place.h"

namespace palmar::product {
namespace {

constexpr double kShortestTrigger = 10.0, kLongestTrigger = 70.0;  // mm
constexpr double kLeastReach = 4.0, kMostReach = 45.0;             // mm before the bar
constexpr double kCarriedBeyond = 12.0;   // mm that what the bar carries reaches farther
constexpr double kBodyNear = 25.0;        // mm from the trigger to where that begins
constexpr double kBeside = 4.0;           // mm beside the mid-plane
constexpr double kStepInFace = 8.0;       // mm
constexpr std::size_t kStepStations = 5;  // that such a step takes at most
constexpr double kStation = 1.0;          // mm
constexpr double kBeyondEnd = 60.0;       // mm that are looked at beyond the bar's end
constexpr double kOffAxis = 0.5;          // radii that what it carries lies to one side at least
constexpr double kLeastDiameter = 14.0;   // mm; thinner bars aren't held in a fist

// Where what lies beyond an end of a bar reaches out to: unit, across the bar's axis there.
std::optional<Vec3> side_of_load(const geometry::TriangleMesh& mesh, const ProductPart& bar,
                                 const Vec3& end, const Vec3& outwards) {
  Vec3 moment = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 r = (a + b + c) / 3.0 - end;
    if (outwards.dot(r) < 0.0) continue;
    const double weight = geometry::triangle_area(a, b, c);
    moment += weight * (r - outwards * outwards.dot(r));
    area += weight;
  }
  if (area <= 0.0 || moment.norm() / area < kOffAxis * 0.5 * bar.diameter()) return std::nullopt;
  return moment.normalized();
}

// How far the product reaches from a point along a direction, seen from far off; mm, 0 if nothing
// is met before the point.
double front_at(const geometry::DistanceField& product, const Vec3& point, const Vec3& front,
                double far) {
  double way = far;
  for (int step = 0; step < 300 && way > 0.0; ++step) {
    const double distance = product.at(point + way * front).distance;
    if (distance < 0.05) return way;
    way -= std::max(distance, 0.05);
  }
  return 0.0;
}

// Half the extent of the bar's usual section in a direction.
double radius_towards(const ProductPart& bar, double along, const Vec3& direction) {
  const PartSection* nearest = &bar.sections.front();
  for (const PartSection& section : bar.sections) {
    if (std::abs(section.along - along) < std::abs(nearest->along - along)) nearest = &section;
  }
  const double w = direction.dot(nearest->wide);
  const double t = std::sqrt(std::max(0.0, 1.0 - w * w));
  return 0.5 * std::hypot(w * nearest->width, t * nearest->thickness);
}

std::optional<PartTrigger> trigger_at(const geometry::TriangleMesh& mesh,
                                      const geometry::DistanceField& surface,
                                      const ProductPart& bar, std::size_t end, double diagonal) {
  const Vec3 start = bar.ends[1 - end].point, last_point = bar.ends[end].point;
  const double chord = (last_point - start).norm();
  if (chord < 1.0) return std::nullopt;
  const Vec3 outwards = (last_point - start) / chord;
  const auto front = side_of_load(mesh, bar, last_point, outwards);
  if (!front) return std::nullopt;
  const Vec3 beside = outwards.cross(*front);
  // Along the bar's chord, from its far end over the near one into what it carries.
  std::vector<double> reach, own;
  const int steps = static_cast<int>((chord + kBeyondEnd) / kStation);
  for (int k = 0; k <= steps; ++k) {
    const Vec3 point = start + k * kStation * outwards;
    double farthest = 0.0;
    for (const double off : {0.0, -kBeside, kBeside}) {
      farthest = std::max(farthest, front_at(surface, point + off * beside, *front, diagonal));
    }
    reach.push_back(farthest);
    if (k * kStation > chord) continue;
    const double share = k * kStation / chord, at = end == 1 ? share : 1.0 - share;
    const double centre = front->dot(part_frame(bar, at, 0.0).translation - point);
    own.push_back(std::min(farthest, centre + radius_towards(bar, at, *front)));
  }
  // How far the bar itself reaches: the lower quartile, since the trigger is before a part of it.
  std::nth_element(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(own.size() / 4),
                   own.end());
  const double base = own[own.size() / 4];
  const auto is_before = [&](std::size_t k) {
    const double before = reach[k] - base;
    const double slope = k + 1 < reach.size() ? std::abs(reach[k + 1] - reach[k]) / kStation : 0.0;
    return before >= kLeastReach && before <= kMostReach && slope < 1.0;
  };
  for (std::size_t k = 0; k < reach.size();) {
    if (!is_before(k)) {
      ++k;
      continue;
    }
    std::size_t last = k;
    double farthest = reach[k];
    while (true) {
      // Over a step in its face, too.
      std::size_t next = last + 1;
      while (next < reach.size() && next <= last + kStepStations && !is_before(next)) ++next;
      if (next >= reach.size() || next > last + kStepStations ||
          std::abs(reach[next] - reach[last]) > kStepInFace) {
        break;
      }
      last = next;
      farthest = std::max(farthest, reach[last]);
    }
    const double length = static_cast<double>(last - k) * kStation;
    bool is_below = false;  // what the bar carries is right beyond
    const auto near = static_cast<std::size_t>(kBodyNear / kStation);
    for (std::size_t next = last + 1; next < std::min(reach.size(), last + 1 + near); ++next) {
      is_below = is_below || reach[next] > farthest + kCarriedBeyond;
    }
    if (is_below && length >= kShortestTrigger && length <= kLongestTrigger) {
      const std::size_t middle = (k + last) / 2;
      PartTrigger trigger;
      trigger.part = bar.number;
      trigger.end = end;
      trigger.front = *front;
      trigger.point =
          start + static_cast<double>(middle) * kStation * outwards + reach[middle] * *front;
      const double share = static_cast<double>(middle) * kStation / chord;
      trigger.along = end == 1 ? share : 1.0 - share;
      trigger.length = length;
      trigger.reach = reach[middle] - base;
      return trigger;
    }
    k = last + 1;
  }
  return std::nullopt;
}

}  // namespace

std::vector<PartTrigger> triggers_of(const Product& product,
                                     const std::vector<ProductPart>& parts) {
  std::vector<PartTrigger> triggers;
  std::shared_ptr<const geometry::DistanceField> surface = product.distance;
  const double diagonal = geometry::bounding_box(product.mesh).diagonal().norm();
  for (const ProductPart& part : parts) {
    if (part.kind != PartKind::kBar || part.diameter() < kLeastDiameter || part.sections.empty()) {
      continue;
    }
    // The shanks of scissors aren't held in a fist, either.
    const bool joins_ring = std::any_of(part.joined.begin(), part.joined.end(), [&](int other) {
      return parts[other - 1].opening && parts.size() > 2;
    });
    if (joins_ring) continue;
    // A bar that was measured as a body doesn't know what its ends join: it is between two.
    const bool knows_ends = part.ends[0].joined || part.ends[1].joined;
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
      if (knows_ends ? !part.ends[end].joined : part.joined.size() < 2) continue;
      if (!surface) surface = std::make_shared<geometry::MeshDistance>(product.mesh);
      if (auto trigger = trigger_at(product.mesh, *surface, part, end, diagonal)) {
        triggers.push_back(*trigger);
      }
    }
  }
  return triggers;
}

}  // namespace palmar::product
