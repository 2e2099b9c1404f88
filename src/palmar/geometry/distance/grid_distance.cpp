// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/grid_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

constexpr double kMaxNodes = 20e6;  // 320 MB
constexpr int kBlock = 8;           // nodes per side of what one query can rule out

/// Distance and gradient at a node; out of the band the gradient is zero and of the distance only
/// the sign counts.
struct GridNode {
  float distance = 0.0f;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  bool is_known() const { return gradient != Eigen::Vector3f::Zero(); }
};

}  // namespace

void GridDistanceOptions::check() const {
  if (!(spacing >= 0.05 && spacing <= 20.0)) {
    throw UsageError("distance grid: spacing is " + std::to_string(spacing) +
                     " mm; 0.05 to 20 mm is allowed");
  }
  if (!(band > 0.0 && band <= 1000.0)) {
    throw UsageError("distance grid: band is " + std::to_string(band) +
                     " mm; above 0 to 1000 mm is allowed");
  }
  if (!(least_gradient >= 0.0 && least_gradient < 1.0)) {
    throw UsageError("distance grid: least gradient is " + std::to_string(least_gradient) +
                     "; 0 or more and below 1 is allowed");
  }
}

struct GridDistance::Impl {
  std::shared_ptr<const DistanceField> source;
  double band = 0.0;
  double least_gradient = 0.0;
  double spacing = 0.0;
  Vec3 origin = Vec3::Zero();
  Eigen::Vector3i count = Eigen::Vector3i::Zero();
  std::vector<GridNode> nodes;

  int index(int i, int j, int k) const { return (k * count.y() + j) * count.x() + i; }
  Vec3 position(int i, int j, int k) const { return origin + spacing * Vec3(i, j, k); }

  void fill();
  /// Node with the smallest indices of the cell that holds the point; -1 outside the grid.
  int cell(const Vec3& grid_point) const;
  enum class Answer {
    kGood,
    kFar,     ///< farther than the band; sample.distance has the right sign only
    kUnsure,  ///< where nodes look different ways
  };
  Answer interpolate(const Vec3& point, DistanceSample& sample) const;
};

void GridDistance::Impl::fill() {
  nodes.resize(static_cast<std::size_t>(count.x()) * count.y() * count.z());
  // A cell that a point within the band lies in has all its nodes within this.
  const double reach = band + 1.75 * spacing;
  // One query per block says whether any of its nodes can be near enough.
  std::vector<Eigen::Vector3i> starts;
  std::vector<Vec3> centres;
  for (int k = 0; k < count.z(); k += kBlock) {
    for (int j = 0; j < count.y(); j += kBlock) {
      for (int i = 0; i < count.x(); i += kBlock) {
        starts.emplace_back(i, j, k);
        centres.push_back(position(i, j, k) + Vec3::Constant(0.5 * spacing * (kBlock - 1)));
      }
    }
  }
  const double half_diagonal = 0.5 * std::sqrt(3.0) * spacing * (kBlock - 1);
  const double block_reach = reach + half_diagonal;
  std::vector<DistanceSample> found(centres.size());
  source->sample(centres, block_reach, found);

  std::vector<Vec3> points;
  std::vector<int> targets;
  for (std::size_t b = 0; b < starts.size(); ++b) {
    const bool is_far = std::abs(found[b].distance) >= block_reach;
    const Eigen::Vector3i end = (starts[b] + Eigen::Vector3i::Constant(kBlock)).cwiseMin(count);
    for (int k = starts[b].z(); k < end.z(); ++k) {
      for (int j = starts[b].y(); j < end.y(); ++j) {
        for (int i = starts[b].x(); i < end.x(); ++i) {
          const Vec3 x = position(i, j, k);
          // The block's centre already says how far the node is at least.
          if (is_far || std::abs(found[b].distance) - (x - centres[b]).norm() > reach) {
            nodes[index(i, j, k)].distance = static_cast<float>(found[b].distance);
            continue;
          }
          targets.push_back(index(i, j, k));
          points.push_back(x);
        }
      }
    }
  }
  std::vector<DistanceSample> samples(points.size());
  source->sample(points, reach, samples);
  for (std::size_t n = 0; n < points.size(); ++n) {
    GridNode& node = nodes[targets[n]];
    node.distance = static_cast<float>(samples[n].distance);
    if (std::abs(samples[n].distance) < reach) node.gradient = samples[n].normal.cast<float>();
  }
}

int GridDistance::Impl::cell(const Vec3& grid_point) const {
  if (!(grid_point.minCoeff() >= 0.0)) return -1;
  if (!((count.cast<double>().array() - 1.0 - grid_point.array()).minCoeff() > 0.0)) return -1;
  const Eigen::Vector3i low = grid_point.cast<int>();
  return index(low.x(), low.y(), low.z());
}

GridDistance::Impl::Answer GridDistance::Impl::interpolate(const Vec3& point,
                                                           DistanceSample& sample) const {
  const Vec3 u = (point - origin) / spacing;
  const int first = cell(u);
  sample.distance = std::numeric_limits<double>::infinity();
  if (first < 0) return Answer::kFar;
  const Eigen::Vector3f f = (u - u.array().floor().matrix()).cast<float>();
  const auto h = static_cast<float>(spacing);
  float distance = 0.0f;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  const GridNode* corner = &nodes[first];
  const std::array<int, 3> stride = {1, count.x(), count.x() * count.y()};
  for (int c = 0; c < 8; ++c) {
    const int a = c & 1, b = (c >> 1) & 1, d = c >> 2;
    const GridNode& node = corner[a * stride[0] + b * stride[1] + d * stride[2]];
    if (!node.is_known()) {
      sample.distance = static_cast<double>(node.distance);
      return Answer::kFar;
    }
    const Eigen::Vector3f away(f.x() - a, f.y() - b, f.z() - d);
    const float weight =
        (a ? f.x() : 1.0f - f.x()) * (b ? f.y() : 1.0f - f.y()) * (d ? f.z() : 1.0f - f.z());
    distance += weight * (node.distance + 0.5f * h * node.gradient.dot(away));
    gradient += weight * node.gradient;
  }
  sample.distance = static_cast<double>(distance);
  if (std::abs(sample.distance) > band) return Answer::kFar;
  const float length = gradient.norm();
  if (length < least_gradient) return Answer::kUnsure;
  sample.normal = length > 1e-3f ? Vec3((gradient / length).cast<double>().normalized())
                                 : Vec3(corner->gradient.cast<double>().normalized());
  sample.closest = point - sample.distance * sample.normal;
  sample.triangle = -1;
  return Answer::kGood;
}

GridDistance::GridDistance(std::shared_ptr<const DistanceField> source,
                           const GridDistanceOptions& options) {
  options.check();
  auto impl = std::make_unique<Impl>();
  impl->source = std::move(source);
  impl->band = options.band;
  impl->least_gradient = options.least_gradient;
  impl->spacing = options.spacing;
  const Box3 box = impl->source->bounding_box();
  if (!box.isEmpty()) {
    const Vec3 margin = Vec3::Constant(options.band + 2.0 * options.spacing);
    const Vec3 size = box.sizes() + 2.0 * margin;
    impl->spacing = std::max(options.spacing, std::cbrt(size.prod() / kMaxNodes));
    impl->origin = box.min() - margin;
    impl->count = (size / impl->spacing).array().ceil().cast<int>() + 1;
    impl->fill();
  }
  impl_ = std::move(impl);
}
GridDistance::~GridDistance() = default;

Box3 GridDistance::bounding_box() const { return impl_->source->bounding_box(); }
double GridDistance::spacing() const { return impl_->spacing; }

void GridDistance::sample(std::span<const Vec3> points, double range,
                          std::span<DistanceSample> samples) const {
  if (points.size() != samples.size()) {
    throw UsageError("distance grid: " + std::to_string(points.size()) + " points but room for " +
                     std::to_string(samples.size()) + " samples; the numbers must be equal");
  }
  std::vector<int> missed;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Impl::Answer answer = impl_->interpolate(points[i], samples[i]);
    if (answer == Impl::Answer::kUnsure || (answer == Impl::Answer::kFar && range > impl_->band)) {
      missed.push_back(static_cast<int>(i));
    } else if (answer == Impl::Answer::kFar) {
      samples[i] = {std::copysign(range, samples[i].distance), points[i], Vec3::UnitZ(), -1};
    } else if (std::abs(samples[i].distance) > range) {
      samples[i] = {std::copysign(range, samples[i].distance), points[i], samples[i].normal, -1};
    }
  }
  if (missed.empty()) return;
  std::vector<Vec3> far_points;
  far_points.reserve(missed.size());
  for (const int i : missed) far_points.push_back(points[i]);
  std::vector<DistanceSample> far_samples(missed.size());
  impl_->source->sample(far_points, range, far_samples);
  for (std::size_t n = 0; n < missed.size(); ++n) {
    samples[missed[n]] = far_samples[n];
    samples[missed[n]].triangle = -1;
  }
}

}  // namespace palmar::geometry
