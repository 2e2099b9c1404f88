// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/contact_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/iso_lines.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/redesign/surface_diffusion.h"

namespace palmar::redesign {
namespace {

void check_number(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw UsageError(fmt::format("contact region: {} is {:.6g}{}; {:.6g} to {:.6g}{} is allowed",
                               name, value, unit, low, high, unit));
}

/// Of so few hands a share says less than their number: half of 2 is one.
constexpr int kFewHands = 6;

int least_hands(int hands, double share) {
  return std::max(1, static_cast<int>(std::ceil(share * hands - 1e-9)));
}

std::string title(const ContactCount& count, std::optional<HandPart> part, double share) {
  std::string text = part ? name_of(*part) + ", " : "";
  if (count.hands == 1) {
    text += "one hand";
  } else if (share == 0.0) {
    text += fmt::format("any of {} hands", count.hands);
  } else if (share == 0.5) {
    text += fmt::format("half of {} hands", count.hands);
  } else if (share == 1.0) {
    text += fmt::format("all of {} hands", count.hands);
  } else {
    text += fmt::format("{:.4g} % of {} hands", 100.0 * share, count.hands);
  }
  if (count.hands > 1 && count.hands < kFewHands && share > 0.0 && share < 1.0) {
    text += fmt::format(" ({} or more)", least_hands(count.hands, share));
  }
  if (count.threshold > 0.0) text += fmt::format(", above {:.4g} MPa", count.threshold);
  return text;
}

/// Evenly spaced points of a closed line.
std::vector<Vec3> spaced(const std::vector<Vec3>& points, double spacing) {
  const std::size_t n = points.size();
  std::vector<double> way(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    way[i + 1] = way[i] + (points[(i + 1) % n] - points[i]).norm();
  }
  const int count = std::max(8, static_cast<int>(std::lround(way[n] / spacing)));
  std::vector<Vec3> result;
  result.reserve(count);
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double at = way[n] * k / count;
    while (i + 1 < n && way[i + 1] <= at) ++i;
    const double step = way[i + 1] - way[i];
    const double share = step > 0.0 ? (at - way[i]) / step : 0.0;
    result.push_back(points[i] + share * (points[(i + 1) % n] - points[i]));
  }
  return result;
}

/// Each point moves by `step` times the way to the middle of its neighbours.
void relax(std::vector<Vec3>& points, double step) {
  const std::vector<Vec3> before = points;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 middle = 0.5 * (before[(i + n - 1) % n] + before[(i + 1) % n]);
    points[i] = before[i] + step * (middle - before[i]);
  }
}

/// Takes waves shorter than about the smoothing out of a closed line on a surface.
RegionOutline smooth_outline(const std::vector<Vec3>& raw,
                             const geometry::ClosestPointQuery& surface,
                             const RegionOptions& options) {
  // Taubin's pass band and steps as in smooth.h; the number of rounds goes with the square of the
  // smoothing in steps between points.
  constexpr double kLambda = 0.5, kPassBand = 0.02;
  constexpr double kMu = 1.0 / (kPassBand - 1.0 / kLambda);
  RegionOutline outline;
  outline.points = spaced(raw, options.spacing);
  const double reach = options.smoothing / options.spacing;
  const int rounds = static_cast<int>(std::ceil(2.0 * reach * reach));
  const auto project_back = [&] {
    std::optional<int> hint;
    for (Vec3& x : outline.points) {
      const auto found = surface.closest(x, std::numeric_limits<double>::infinity(), hint);
      hint = found->triangle;
      x = found->point;
    }
  };
  for (int k = 0; k < rounds; ++k) {
    relax(outline.points, kLambda);
    relax(outline.points, kMu);
    project_back();
  }
  outline.points = spaced(outline.points, options.spacing);
  project_back();
  const std::size_t n = outline.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    outline.length += (outline.points[(i + 1) % n] - outline.points[i]).norm();
  }
  return outline;
}

/// Inside from 0 on; specks and holes dropped.
void find_field(const geometry::TriangleMesh& map, const std::vector<int>& touching, int hands,
                const RegionOptions& options, ContactRegion& region) {
  // Hands that touch more or less than asked, up to a tenth of all either way: as far above as
  // below, or smoothing would move the border.
  const double asked = region.least_hands - 0.5;
  const double band = std::min({0.1 * hands, asked, hands - asked});
  region.field.reserve(touching.size());
  for (const int count : touching) {
    region.field.push_back(std::clamp((count - asked) / std::max(0.5, band), -1.0, 1.0));
  }
  region.field = SurfaceDiffusion(map, options.smoothing).smooth(region.field);
  for (const bool holes : {false, true}) {
    const geometry::IsoParts parts = geometry::iso_parts(map, region.field, 0.0);
    if (std::count(parts.is_inside.begin(), parts.is_inside.end(), holes ? 0 : 1) == 0) return;
    std::vector<char> is_dropped(parts.area.size(), 0);
    for (std::size_t p = 0; p < parts.area.size(); ++p) {
      if ((parts.is_inside[p] != 0) == holes || parts.area[p] >= options.smallest_area) continue;
      is_dropped[p] = 1;
      ++(holes ? region.dropped_holes : region.dropped_specks);
      region.dropped_area += parts.area[p];
    }
    for (std::size_t v = 0; v < touching.size(); ++v) {
      if (is_dropped[parts.of_vertex[v]] == 0) continue;
      const double size = std::max(1e-6, std::abs(region.field[v]));
      region.field[v] = holes ? size : -size;
    }
  }
}

}  // namespace

std::string name_of(HandPart part) {
  switch (part) {
    case HandPart::kFingers:
      return "fingers";
    case HandPart::kThumb:
      return "thumb";
    case HandPart::kPalm:
      return "palm";
  }
  return "";
}

std::optional<HandPart> part_of(hand::Region region) {
  if (region == hand::Region::kDorsum) return {};
  if (region == hand::Region::kThumbProximal || region == hand::Region::kThumbDistal)
    return HandPart::kThumb;
  return region >= hand::Region::kThenar ? HandPart::kPalm : HandPart::kFingers;
}

void RegionOptions::check() const {
  check_number("share of the hands", share, 0.0, 1.0, "");
  check_number("smoothing", smoothing, 0.0, 50.0, " mm");
  check_number("smallest area", smallest_area, 0.0, 1e6, " mm2");
  check_number("spacing of the outlines' points", spacing, 0.1, 20.0, " mm");
}

ContactCount start_count(const geometry::TriangleMesh& map, double threshold) {
  check_number("pressure threshold", threshold, 0.0, 100.0, " MPa");
  ContactCount count;
  count.threshold = threshold;
  count.any.assign(map.vertices.size(), 0);
  count.of_part.fill(count.any);
  return count;
}

void add_hand(ContactCount& count, const geometry::TriangleMesh& map, const HeldHand& held,
              const Imprint& reach) {
  struct Pressed {
    Vec3 at;
    HandPart part;
    double pressure;
  };
  std::vector<Pressed> pressed;
  for (std::size_t v = 0; v < held.pressure.size(); ++v) {
    const auto part = part_of(held.who->region[v]);
    if (part && held.pressure[v] > 0.0) {
      pressed.push_back({held.skin.vertices[v], *part, held.pressure[v]});
    }
  }
  ++count.hands;
  const std::string whose = "hand " + std::to_string(held.hand + 1);
  const auto check = [&](int vertex) {
    if (vertex >= 0 && static_cast<std::size_t>(vertex) < count.any.size()) return;
    throw UsageError("contact region: the pressure of " + whose +
                     " belongs to another map of the product");
  };
  const auto nearest = [&](int vertex) -> const Pressed* {
    const Vec3& x = map.vertices[vertex];
    const auto found =
        std::min_element(pressed.begin(), pressed.end(), [&x](const Pressed& a, const Pressed& b) {
          return (a.at - x).squaredNorm() < (b.at - x).squaredNorm();
        });
    return found == pressed.end() ? nullptr : &*found;
  };
  std::vector<char> is_counted(count.any.size(), 0);
  const auto add = [&](int vertex, const Pressed* by) {
    if (is_counted[vertex] != 0) return;
    is_counted[vertex] = 1;
    ++count.any[vertex];
    if (by != nullptr) ++count.of_part[index_of(by->part)][vertex];
  };
  for (std::size_t i = 0; i < held.product_pressure.vertex.size(); ++i) {
    const int vertex = held.product_pressure.vertex[i];
    check(vertex);
    if (held.product_pressure.value[i] > count.threshold) add(vertex, nearest(vertex));
  }
  for (const int vertex : reach.point) {
    check(vertex);
    if (is_counted[vertex] != 0) continue;
    const Pressed* const by = nearest(vertex);
    if (by != nullptr && by->pressure > count.threshold) add(vertex, by);
  }
}

ContactRegion contact_region(const geometry::TriangleMesh& map, const ContactCount& count,
                             std::optional<HandPart> part, const RegionOptions& options) {
  options.check();
  const std::vector<int>& touching = part ? count.of_part[index_of(*part)] : count.any;
  if (touching.size() != map.vertices.size() || count.hands < 1) {
    throw UsageError(
        fmt::format("contact region: {} vertices of {} hands were counted, the map has {} vertices",
                    touching.size(), count.hands, map.vertices.size()));
  }
  ContactRegion region;
  region.title = title(count, part, options.share);
  region.part = part;
  region.least_hands = least_hands(count.hands, options.share);
  find_field(map, touching, count.hands, options, region);
  region.area_of = geometry::areas_above(map, region.field, 0.0);
  const geometry::IsoParts parts = geometry::iso_parts(map, region.field, 0.0);
  std::vector<int> patch_of(parts.area.size(), -1);
  for (std::size_t p = 0; p < parts.area.size(); ++p) {
    if (parts.is_inside[p] == 0) continue;
    patch_of[p] = static_cast<int>(region.patches.size());
    region.patches.emplace_back().area = parts.area[p];
    region.area += parts.area[p];
  }
  for (int v = 0; v < map.vertex_count(); ++v) {
    const int p = patch_of[parts.of_vertex[v]];
    if (p >= 0) region.patches[p].vertices.push_back(v);
  }
  const geometry::ClosestPointQuery surface(map);
  for (const geometry::IsoLoop& loop : geometry::iso_loops(map, region.field, 0.0)) {
    const int p = patch_of[parts.of_vertex[loop.inside_vertex]];
    region.patches[p].outline.push_back(smooth_outline(loop.points, surface, options));
  }
  const std::vector<double> areas = geometry::vertex_areas(map);
  for (RegionPatch& patch : region.patches) {
    double weight = 0.0;
    for (const int v : patch.vertices) {
      patch.centre += areas[v] * map.vertices[v];
      weight += areas[v];
    }
    if (weight > 0.0) patch.centre /= weight;
  }
  std::stable_sort(region.patches.begin(), region.patches.end(),
                   [](const RegionPatch& a, const RegionPatch& b) { return a.area > b.area; });
  return region;
}

std::vector<FaceShare> face_shares(const geometry::TriangleMesh& map,
                                   const std::vector<int>& face_of_triangle, int faces,
                                   const ContactCount& count, const ContactRegion& region) {
  if (face_of_triangle.size() != map.triangles.size() ||
      region.area_of.size() != map.triangles.size()) {
    throw UsageError("contact region: faces, region and map don't belong together");
  }
  const std::vector<int>& touching =
      region.part ? count.of_part[index_of(*region.part)] : count.any;
  std::vector<FaceShare> all(faces);
  std::vector<double> whole(all.size(), 0.0);
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    const int face = face_of_triangle[t];
    const auto& [a, b, c] = map.triangles[t];
    all[face].area += region.area_of[t];
    whole[face] += geometry::triangle_area(map.vertices[a], map.vertices[b], map.vertices[c]);
    for (const int v : map.triangles[t]) {
      all[face].peak_hands =
          std::max(all[face].peak_hands, static_cast<double>(touching[v]) / count.hands);
    }
  }
  for (std::size_t f = 0; f < all.size(); ++f) {
    all[f].face = static_cast<int>(f);
    all[f].share = whole[f] > 0.0 ? all[f].area / whole[f] : 0.0;
  }
  std::erase_if(all, [](const FaceShare& one) { return one.area <= 0.0; });
  std::stable_sort(all.begin(), all.end(),
                   [](const FaceShare& a, const FaceShare& b) { return a.area > b.area; });
  return all;
}

}  // namespace palmar::redesign
