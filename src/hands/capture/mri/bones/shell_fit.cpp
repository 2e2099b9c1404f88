// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/shell_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palmar::capture {
namespace {

// Profiles: samples along the normal, mm.
constexpr double kFirst = -3.6, kStep = 0.3;
constexpr int kSamples = 26;           // to +3.9
constexpr double kMarrowWithin = 0.9;  // mm outwards of the vertex at most
constexpr double kMisfit = 0.05;       // share of the contrast that the model leaves out
constexpr double kUsualOutside = 0.5;  // share of the contrast

/// One sample after the other, to where another bone, air or the border of the image begins.
struct Samples {
  std::array<double, kSamples> value{};
  std::array<bool, kSamples> is_own{};
  int first = 0, last = -1;
};

Samples samples_at(const Vec3& vertex, const Vec3& normal, std::int32_t own,
                   const ShellImage& shell) {
  const imaging::VolumeGrid& grid = shell.image.grid;
  Samples samples;
  const auto take = [&](int s) {
    const Vec3 voxel = grid.to_voxel(vertex + (kFirst + kStep * s) * normal);
    std::array<int, 3> near{};
    for (std::size_t a = 0; a < 3; ++a) {
      near[a] = static_cast<int>(std::lround(voxel[static_cast<Eigen::Index>(a)]));
      if (near[a] < 0 || near[a] >= grid.size[a]) return false;
    }
    const std::int32_t region = shell.region[grid.at(near[0], near[1], near[2])];
    samples.value[s] = static_cast<double>(imaging::value_at(shell.image, voxel));
    samples.is_own[s] = region == own;
    return region == -1 || region == own;
  };
  const int middle = static_cast<int>(std::lround(-kFirst / kStep));
  samples.first = middle;
  samples.last = middle - 1;
  while (samples.last + 1 < kSamples && take(samples.last + 1)) ++samples.last;
  while (samples.first > 0 && take(samples.first - 1)) --samples.first;
  return samples;
}

/// Keeps one layer of each kind: from the marrow inwards to where it ends on the far side, outwards
/// over the dip to the top of what follows.
void keep_nearest_layers(Samples& samples, const ShellImage& shell) {
  const double contrast = shell.bright - shell.dark;
  const double clearly = std::max(3.0 * shell.noise, 0.12 * contrast);
  const double half = shell.dark + 0.5 * contrast;
  int marrow = -1;
  for (int s = samples.last; s >= samples.first && marrow < 0; --s) {
    if (kFirst + kStep * s > kMarrowWithin) continue;
    if (samples.is_own[s] && samples.value[s] > half) marrow = s;
  }
  if (marrow < 0) return;
  double top = samples.value[marrow];
  for (int s = marrow; s >= samples.first; --s) {
    top = std::max(top, samples.value[s]);
    if (samples.value[s] > top - clearly) continue;
    samples.first = s + 1;
    break;
  }
  double bottom = samples.value[marrow];
  int highest = -1;
  for (int s = marrow; s <= samples.last; ++s) {
    const double value = samples.value[s];
    if (highest < 0) {
      bottom = std::min(bottom, value);
      if (value > bottom + clearly) highest = s;
    } else {
      if (value > samples.value[highest]) highest = s;
      if (value < samples.value[highest] - clearly) {
        samples.last = highest;
        break;
      }
    }
  }
}

}  // namespace

LayerFit fit_shell(const geometry::TriangleMesh& near, std::int32_t own, const ShellImage& shell) {
  const double contrast = shell.bright - shell.dark;
  LayerSearch search;
  search.bright = shell.bright;
  search.usual = shell.dark + kUsualOutside * contrast;
  search.scale = std::hypot(shell.noise, kMisfit * contrast);
  return fit_layers(near, search, [&](int v, const Vec3& normal) {
    Samples samples = samples_at(near.vertices[v], normal, own, shell);
    keep_nearest_layers(samples, shell);
    LayerProfile profile;
    profile.first = kFirst + kStep * samples.first;
    profile.step = kStep;
    profile.known = shell.dark;
    const imaging::VolumeGrid& grid = shell.image.grid;
    profile.blur = 0.5 * (grid.axes.transpose() * normal).cwiseProduct(grid.spacing).norm();
    if (samples.last >= samples.first) {
      profile.value.assign(samples.value.begin() + samples.first,
                           samples.value.begin() + samples.last + 1);
    }
    return profile;
  });
}

}  // namespace palmar::capture
