// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/align_imprints.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palmar::redesign {
namespace {

constexpr double kBin = 0.25;  // mm; bin of a profile and step of a shift
constexpr int kMaxRounds = 10;

using Profile = std::vector<double>;

/// Profiles with `padding` empty bins at both ends, smoothed over about a surface point's distance.
std::vector<Profile> profiles_of(std::span<const Imprint> imprints, std::span<const Vec3> points,
                                 std::span<const double> areas, const Vec3& axis, int padding) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& x : points) {
    low = std::min(low, axis.dot(x));
    high = std::max(high, axis.dot(x));
  }
  const auto bins = static_cast<std::size_t>(std::max(0.0, (high - low) / kBin)) + 2 +
                    2 * static_cast<std::size_t>(padding);
  std::vector<Profile> profiles;
  for (const Imprint& imprint : imprints) {
    Profile f(bins, 0.0);
    for (std::size_t k = 0; k < imprint.point.size(); ++k) {
      const int i = imprint.point[k];
      const auto bin = static_cast<std::size_t>((axis.dot(points[i]) - low) / kBin) +
                       static_cast<std::size_t>(padding);
      f[bin] += imprint.depth[k] * areas[i];
    }
    for (int round = 0; round < 2; ++round) {  // boxes of 9 bins: 2.25 mm
      Profile smooth(bins, 0.0);
      for (int b = 0; b < static_cast<int>(bins); ++b) {
        for (int d = -4; d <= 4; ++d) {
          if (b + d < 0 || b + d >= static_cast<int>(bins)) continue;
          smooth[b] += f[b + d] / 9.0;
        }
      }
      f = std::move(smooth);
    }
    profiles.push_back(std::move(f));
  }
  return profiles;
}

double value_at(const Profile& f, int bin) {
  return bin < 0 || bin >= static_cast<int>(f.size()) ? 0.0 : f[bin];
}

/// Mean of the shifted profiles; sums of sorted values don't depend on the order of the hands.
Profile mean_profile(const std::vector<Profile>& profiles, const std::vector<int>& shift) {
  Profile mean(profiles.front().size(), 0.0);
  std::vector<double> values(profiles.size());
  for (int b = 0; b < static_cast<int>(mean.size()); ++b) {
    for (std::size_t h = 0; h < profiles.size(); ++h) {
      values[h] = value_at(profiles[h], b - shift[h]);
    }
    std::sort(values.begin(), values.end());
    for (const double value : values) mean[b] += value;
  }
  return mean;
}

int best_shift(const Profile& f, const Profile& mean, int limit) {
  int best = 0;
  double highest = -1.0;
  // From no shift outwards: of equally good ones the smallest.
  for (int k = 0; k <= 2 * limit; ++k) {
    const int s = k % 2 == 0 ? -(k / 2) : (k + 1) / 2;
    double sum = 0.0;
    for (int b = 0; b < static_cast<int>(mean.size()); ++b) {
      sum += mean[b] * value_at(f, b - s);
    }
    if (sum > highest * (1.0 + 1e-12)) {
      highest = sum;
      best = s;
    }
  }
  return best;
}

}  // namespace

std::vector<double> align_imprints(std::span<const Imprint> imprints, std::span<const Vec3> points,
                                   std::span<const double> areas, const Vec3& axis, double limit) {
  std::vector<double> result(imprints.size(), 0.0);
  if (imprints.size() < 2 || points.empty() || !(limit > 0.0)) return result;
  const int most = static_cast<int>(limit / kBin);
  const std::vector<Profile> profiles = profiles_of(imprints, points, areas, axis, most);
  std::vector<int> shift(imprints.size(), 0);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Profile mean = mean_profile(profiles, shift);
    int change = 0;
    for (std::size_t h = 0; h < imprints.size(); ++h) {
      if (imprints[h].point.empty()) continue;
      const int s = best_shift(profiles[h], mean, most);
      change = std::max(change, std::abs(s - shift[h]));
      shift[h] = s;
    }
    if (change <= 1) break;
  }
  int total = 0;
  int hands = 0;
  for (std::size_t h = 0; h < imprints.size(); ++h) {
    if (imprints[h].point.empty()) continue;
    total += shift[h];
    ++hands;
  }
  for (std::size_t h = 0; h < imprints.size() && hands > 0; ++h) {
    if (imprints[h].point.empty()) continue;
    result[h] = std::clamp(kBin * (shift[h] - static_cast<double>(total) / hands), -limit, limit);
  }
  return result;
}

}  // namespace palmar::redesign
