// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/thumb_ball_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hands/capture/marker_matching.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/skin/hand_points.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/skin/thumb_ball.h"

namespace palmar::capture {
namespace {

/// A point of the skin in the reference posture.
struct SkinPoint {
  Triangle vertex{};
  std::array<double, 3> share{};
  Vec3 place = Vec3::Zero();
  double height = 0.0;  ///< of the marker's centre above it
};

Vec3 point_on(const SkinPoint& point, const std::vector<Vec3>& skin) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t c = 0; c < 3; ++c) sum += point.share[c] * skin[point.vertex[c]];
  return sum;
}

/// Normal of the scanned skin round a marker, without the marker's own bump.
std::optional<Vec3> normal_round(const SkinScan& scan, const std::vector<Vec3>& normal,
                                 const Vec3& centre) {
  const double inner = 1.9 * scan.marker_radius, outer = 4.0 * scan.marker_radius;
  Vec3 sum = Vec3::Zero();
  for (std::size_t v = 0; v < normal.size(); ++v) {
    const double d = (scan.skin.vertices[v] - centre).norm();
    if (d < inner || d > outer) continue;
    sum += normal[v];
  }
  constexpr double kLeast = 3.0;  // normals that agree
  if (sum.norm() < kLeast) return std::nullopt;
  return sum.normalized();
}

/// Points of the skin's vertices `spacing` apart from each other and from what is there already.
std::vector<int> spread_points(const std::vector<Vec3>& skin, const std::vector<int>& vertices,
                               std::vector<Vec3> taken, double spacing) {
  std::vector<double> free(vertices.size(), std::numeric_limits<double>::max());
  const auto shade = [&](const Vec3& p) {
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      free[k] = std::min(free[k], (skin[vertices[k]] - p).norm());
    }
  };
  for (const Vec3& p : taken) shade(p);
  std::vector<int> chosen;
  while (!vertices.empty()) {
    const auto next = std::max_element(free.begin(), free.end());
    if (*next < spacing) break;
    chosen.push_back(vertices[next - free.begin()]);
    shade(skin[chosen.back()]);
  }
  return chosen;
}

constexpr std::array<const char*, 4> kLimitName{"flexion", "extension", "abduction", "adduction"};

}  // namespace

void ThumbBallScanOptions::check() const {
  if (!(spacing >= 4.0 && spacing <= 30.0)) {
    throw UsageError(fmt::format("thumb ball: spacing is {:g} mm; 4 to 30 mm is allowed", spacing));
  }
}

std::vector<int> thumb_ball_skin(const hand::Hand& hand) {
  constexpr double kMoved = 0.05, kBeyond = 12.0;
  const hand::JointWeights* cmc = nullptr;
  for (const hand::JointWeights& weights : hand.weights) {
    if (weights.joint == hand::JointId::kThumbCmc) cmc = &weights;
  }
  if (cmc == nullptr) return {};
  const Vec3& mp = hand.skeleton.joint(hand::JointId::kThumbMp).centre;
  std::vector<int> result;
  for (std::size_t k = 0; k < cmc->vertex.size(); ++k) {
    if (cmc->w1[k] * cmc->w2[k] < kMoved) continue;
    const int v = cmc->vertex[k];
    const hand::Segment segment = hand.segment[v];
    const bool is_near = (hand.skin.vertices[v] - mp).norm() < 2.0 * kBeyond;
    if (segment == hand::Segment::kPalm || (segment == hand::Segment::kThumbProximal && is_near)) {
      result.push_back(v);
    }
  }
  return result;
}

ThumbBallFit fit_scanned_thumb_ball(const hand::Hand& hand, const std::vector<Vec3>& markers,
                                    const std::array<std::optional<ThumbLimitScan>, 4>& limits,
                                    const ThumbBallScanOptions& options, const Progress& progress) {
  options.check();
  ThumbBallFit fit;
  hand::Hand bare = hand;
  bare.thumb_ball = {};
  const geometry::ClosestPointQuery query(hand.skin);
  std::vector<SkinPoint> marked;
  std::vector<hand::HandPoint> glued;
  for (const Vec3& marker : markers) {
    const geometry::ClosestPoint foot = *query.closest(marker);
    marked.push_back({hand.skin.triangles[foot.triangle], foot.weights, foot.point, foot.distance});
    glued.push_back(hand::skin_point_near(hand, marker));
  }

  // Markers found again, and how many times each.
  std::array<std::vector<std::optional<Vec3>>, 4> seen;
  std::vector<int> times(markers.size(), 0);
  int scanned = 0;
  for (std::size_t l = 0; l < 4; ++l) {
    seen[l].assign(markers.size(), std::nullopt);
    if (!limits[l]) continue;
    ++scanned;
    const SkinScan& scan = limits[l]->skin;
    if (markers.empty() || scan.markers.empty()) continue;
    const std::vector<Vec3> normal = geometry::vertex_normals(scan.skin);
    const auto match =
        match_markers(hand::PosablePoints(bare, glued).pose(limits[l]->posture), scan.markers);
    for (std::size_t i = 0; i < match.size(); ++i) {
      if (!match[i]) continue;
      const Vec3& centre = scan.markers[*match[i]];
      const auto up = normal_round(scan, normal, centre);
      if (!up) continue;
      seen[l][i] = centre - marked[i].height * *up;
      ++times[i];
    }
  }
  if (scanned == 0) {
    fit.notes.emplace_back("No limit posture of the thumb was scanned: its ball is not corrected.");
    return fit;
  }
  for (std::size_t l = 0; l < 4; ++l) {
    if (limits[l]) continue;
    fit.notes.push_back(
        fmt::format("The thumb's limit of {} was not scanned: there its ball is not corrected.",
                    kLimitName[l]));
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (2 * times[i] > scanned) kept.push_back(i);
  }
  fit.markers = static_cast<int>(kept.size());

  // The skin bent onto the scans shows the rest, and where a marker is that wasn't seen.
  std::array<std::vector<Vec3>, 4> posed, bent;
  for (std::size_t l = 0; l < 4; ++l) {
    if (!limits[l]) continue;
    progress.update(0.25 * static_cast<double>(l),
                    fmt::format("bending the thumb ball onto the scan of {}", kLimitName[l]));
    posed[l] = hand::pose_skin(bare, limits[l]->posture);
    std::vector<FitPin> pins;
    for (const std::size_t i : kept) {
      if (seen[l][i]) pins.push_back({marked[i].vertex, marked[i].share, *seen[l][i]});
    }
    bent[l] = bend_posed_skin(bare, limits[l]->posture, limits[l]->skin, pins);
  }

  hand::ThumbBallMarkers known;
  for (const std::size_t i : kept) {
    known.reference.push_back(marked[i].place);
    for (std::size_t l = 0; l < 4; ++l) {
      Vec3 missing = Vec3::Zero();
      if (limits[l]) {
        const Vec3 place = seen[l][i] ? *seen[l][i] : point_on(marked[i], bent[l]);
        missing = place - point_on(marked[i], posed[l]);
      }
      known.missing[l].push_back(missing);
    }
  }
  if (!kept.empty()) fit.by_markers = hand::fit_thumb_ball(hand.skin, known);
  const std::vector<int> more =
      spread_points(hand.skin.vertices, thumb_ball_skin(hand), known.reference, options.spacing);
  fit.skin_points = static_cast<int>(more.size());
  for (const int v : more) {
    known.reference.push_back(hand.skin.vertices[v]);
    for (std::size_t l = 0; l < 4; ++l) {
      known.missing[l].push_back(limits[l] ? Vec3(bent[l][v] - posed[l][v]) : Vec3(Vec3::Zero()));
    }
  }
  // phi = 1/2 at the points' spacing.
  hand::ThumbBallOptions kernel;
  kernel.beta = std::numbers::ln2 / (options.spacing * options.spacing);
  fit.correction = hand::fit_thumb_ball(hand.skin, known, kernel);
  return fit;
}

}  // namespace palmar::capture
