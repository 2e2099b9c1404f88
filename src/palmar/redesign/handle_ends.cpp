// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/redesign/press_limits.h"

namespace palmar::redesign {
namespace {

constexpr double kOnceRound = 2.0 * std::numbers::pi;
constexpr double kOutermost = 0.02;  // share of a hand's pressures beyond its gripped length
constexpr double kOther = 1.0;       // mm, root mean square; what is no more of the handle
constexpr double kLeastEnd = 3.0;    // mm
constexpr double kFar = 30.0;        // mm; beyond it a face has no influence
constexpr double kOnFace = 1.0;      // mm; by how much outlines may be off a face

/// z below which a share of the pressures lies.
double quantile_of(std::vector<std::pair<double, double>>& pressures, double share) {
  std::sort(pressures.begin(), pressures.end());
  double sum = 0.0;
  for (const auto& [z, pressure] : pressures) sum += pressure;
  double below = 0.0;
  for (const auto& [z, pressure] : pressures) {
    below += pressure;
    if (below >= share * sum) return z;
  }
  return pressures.back().first;
}

/// Radii as straight lines along z, one for every direction, through some of the sections.
struct StraightOutlines {
  std::vector<double> at_zero, slope;

  StraightOutlines(const HandleOutlines& outlines, const std::vector<std::size_t>& sections) {
    for (int k = 0; k < outlines.columns; ++k) {
      double n = 0.0, z1 = 0.0, z2 = 0.0, r1 = 0.0, zr = 0.0;
      for (const std::size_t j : sections) {
        const double z = outlines.z[j], r = outlines.radius[j][static_cast<std::size_t>(k)];
        n += 1.0;
        z1 += z;
        z2 += z * z;
        r1 += r;
        zr += z * r;
      }
      const double spread = n * z2 - z1 * z1;
      slope.push_back(spread > 0.0 ? (n * zr - z1 * r1) / spread : 0.0);
      at_zero.push_back(n > 0.0 ? (r1 - slope.back() * z1) / n : 0.0);
    }
  }
  double mean(double z) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < slope.size(); ++k) sum += at_zero[k] + slope[k] * z;
    return sum / static_cast<double>(slope.size());
  }
  double rms_off(double z, const std::vector<double>& radius) const {
    double squares = 0.0;
    for (std::size_t k = 0; k < radius.size(); ++k) {
      squares += std::pow(radius[k] - at_zero[k] - slope[k] * z, 2);
    }
    return std::sqrt(squares / static_cast<double>(radius.size()));
  }
};

constexpr double kAnother = 0.25;  // of a mean radius; what is so much off is no handle

std::vector<std::size_t> sections_between(const HandleOutlines& outlines, double low, double high) {
  std::vector<std::size_t> sections;
  for (std::size_t j = 0; j < outlines.z.size(); ++j) {
    if (outlines.z[j] >= low && outlines.z[j] <= high) sections.push_back(j);
  }
  return sections;
}

/// The gripped sections that are of the handle itself: about as thick as the median one. Where
/// fingers lie on a neck the grip has others, too.
std::vector<std::size_t> sections_of_handle(const HandleBody& body) {
  std::vector<std::size_t> sections =
      sections_between(body.outlines, body.gripped[0], body.gripped[1]);
  if (sections.empty()) return sections;
  const auto thickness = [&](std::size_t j) {
    const std::vector<double>& radius = body.outlines.radius[j];
    return std::accumulate(radius.begin(), radius.end(), 0.0);
  };
  std::vector<double> all;
  for (const std::size_t j : sections) all.push_back(thickness(j));
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  const double median = *middle;
  std::erase_if(sections,
                [&](std::size_t j) { return std::abs(thickness(j) - median) > kAnother * median; });
  return sections;
}

/// Length of the top (or the bottom) over which the handle is a quarter thinner or thicker than
/// it would be if it went on: a neck, even if fingers lie on it.
double neck_length(const HandleBody& body, bool at_top) {
  const double middle = 0.5 * (body.gripped[0] + body.gripped[1]);
  const StraightOutlines straight(body.outlines, sections_of_handle(body));
  const double margin = body.is_whole ? body.end_radius + 0.5 : 0.0;
  const auto rows = static_cast<int>(body.outlines.z.size());
  double length = 0.0;
  for (int k = 0; k < rows; ++k) {  // from the end inwards
    const auto j = static_cast<std::size_t>(at_top ? rows - 1 - k : k);
    const double z = body.outlines.z[j];
    if (z < body.bottom + margin || z > body.top - margin) continue;
    if (at_top ? z < middle : z > middle) break;
    if (straight.rms_off(z, body.outlines.radius[j]) < kAnother * straight.mean(z)) break;
    length = at_top ? body.top - z : z - body.bottom;
  }
  return length < kLeastEnd ? 0.0 : length;
}

}  // namespace

std::array<double, 2> gripped_length(const HandleBody& body, const HandsOnHandle& hands) {
  const geometry::Rigid3 to_handle = body.product_from_handle.inverse();
  double low = 0.0, high = 0.0, count = 0.0;
  for (const std::vector<HandPressure>& hand : hands.pressures) {
    if (hand.empty()) continue;
    std::vector<std::pair<double, double>> along;
    for (const HandPressure& one : hand) along.emplace_back((to_handle * one.at).z(), one.pressure);
    low += quantile_of(along, kOutermost);
    high += quantile_of(along, 1.0 - kOutermost);
    count += 1.0;
  }
  if (count == 0.0) return {body.bottom, body.top};
  return {std::clamp(low / count - hands.spread, body.bottom, body.top),
          std::clamp(high / count + hands.spread, body.bottom, body.top)};
}

std::array<double, 2> other_ends(const HandleBody& body) {
  const std::array<double, 2> necks = {neck_length(body, false), neck_length(body, true)};
  const double low = std::max(body.gripped[0], body.bottom + necks[0]);
  const double high = std::min(body.gripped[1], body.top - necks[1]);
  const StraightOutlines straight(body.outlines, sections_between(body.outlines, low, high));
  // Roundings of flat ends are no other thing.
  const double margin = body.is_whole ? body.end_radius + 0.5 : 0.0;
  std::array<double, 2> lengths = {low - body.bottom, body.top - high};
  std::array<bool, 2> are_other = {necks[0] > 0.0, necks[1] > 0.0};
  for (std::size_t j = 0; j < body.outlines.z.size(); ++j) {
    const double z = body.outlines.z[j];
    if (z < body.bottom + margin || z > body.top - margin || (z >= low && z <= high)) continue;
    if (straight.rms_off(z, body.outlines.radius[j]) > kOther) are_other[z < low ? 0 : 1] = true;
  }
  for (const std::size_t end : {0, 1}) {
    if (!are_other[end] || lengths[end] < kLeastEnd) lengths[end] = 0.0;
  }
  return lengths;
}

std::array<double, 2> kept_lengths(const HandleBody& body) {
  const std::array<double, 2> other = other_ends(body);
  std::array<double, 2> kept = {0.0, 0.0};
  for (const std::size_t end : {0, 1}) {
    if (other[end] == 0.0) continue;
    kept[end] = std::max({0.0, other[end] - 0.5 * kShapeBlend, neck_length(body, end == 1)});
  }
  return kept;
}

HandleOutlines distances_to_faces(const HandleBody& body, const product::Product& product,
                                  const KeepOut& keep_out) {
  const std::vector<unsigned char> is_kept = kept_face_triangles(product, keep_out);
  if (is_kept.empty()) return {};
  geometry::TriangleMesh faces;
  faces.vertices = product.mesh.vertices;
  for (std::size_t t = 0; t < is_kept.size(); ++t) {
    if (is_kept[t] != 0) faces.triangles.push_back(product.mesh.triangles[t]);
  }
  HandleOutlines result = body.outlines;
  std::vector<Vec3> places;
  for (const double z : result.z) {
    const Eigen::Vector2d centre = body.centre_at(z);
    for (int k = 0; k < result.columns; ++k) {
      const double phi = kOnceRound * k / result.columns;
      const double r = body.outlines.at(z, phi);
      places.push_back(body.product_from_handle *
                       Vec3(centre.x() + r * std::cos(phi), centre.y() + r * std::sin(phi), z));
    }
  }
  const std::vector<double> distance = distance_to(faces, places, kFar);
  if (*std::min_element(distance.begin(), distance.end()) > kOnFace) {
    throw UsageError(fmt::format(
        "keep-out: none of these faces of \"{}\" lies on the handle; what lies elsewhere stays "
        "anyway",
        product.name));
  }
  auto next = distance.begin();
  for (std::vector<double>& row : result.radius) {
    // Outlines are off a face by as much as they are coarse.
    for (double& one : row) one = std::max(0.0, *next++ - 0.5 * kOnFace);
  }
  return result;
}

HandleOutlines smoothed(const HandleOutlines& outlines) {
  constexpr double kShare[] = {1.0, 1.0, 1.0, 2.0 / 3.0, 1.0 / 3.0};  // of waves round a section
  constexpr double kAlong = 4.0;                                      // mm, standard deviation
  HandleOutlines result = outlines;
  const auto n = static_cast<std::size_t>(outlines.columns);
  for (std::vector<double>& row : result.radius) {
    std::vector<double> kept(n, 0.0);
    for (std::size_t wave = 0; wave < std::size(kShare); ++wave) {
      double c = 0.0, s = 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        const double angle =
            kOnceRound * static_cast<double>(wave * k % n) / static_cast<double>(n);
        c += row[k] * std::cos(angle);
        s += row[k] * std::sin(angle);
      }
      const double weight = kShare[wave] * (wave == 0 ? 1.0 : 2.0) / static_cast<double>(n);
      for (std::size_t k = 0; k < n; ++k) {
        const double angle =
            kOnceRound * static_cast<double>(wave * k % n) / static_cast<double>(n);
        kept[k] += weight * (c * std::cos(angle) + s * std::sin(angle));
      }
    }
    row = std::move(kept);
  }
  const std::vector<std::vector<double>> around = result.radius;
  for (std::size_t j = 0; j < around.size(); ++j) {
    std::fill(result.radius[j].begin(), result.radius[j].end(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < around.size(); ++i) {
      const double weight = std::exp(-0.5 * std::pow((outlines.z[i] - outlines.z[j]) / kAlong, 2));
      sum += weight;
      for (std::size_t k = 0; k < n; ++k) result.radius[j][k] += weight * around[i][k];
    }
    for (double& one : result.radius[j]) one /= sum;
  }
  return result;
}

}  // namespace palmar::redesign
