// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/gloved.h"

#include <cmath>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::product {
namespace {

/// A solid grown by a constant thickness.
class OffsetDistance final : public geometry::DistanceField {
 public:
  OffsetDistance(std::shared_ptr<const DistanceField> inner, double thickness)
      : inner_(std::move(inner)), thickness_(thickness) {}

  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    inner_->sample(points, range + thickness_, samples);
    grow(points, range, samples);
  }

  void resample(std::span<const Vec3> points, double range,
                std::span<geometry::DistanceSample> samples) const override {
    for (geometry::DistanceSample& sample : samples) {
      sample.distance += thickness_;
      sample.closest -= thickness_ * sample.normal;
    }
    inner_->resample(points, range + thickness_, samples);
    grow(points, range, samples);
  }

  bool is_lipschitz() const override { return inner_->is_lipschitz(); }

  Box3 bounding_box() const override {
    const Box3 box = inner_->bounding_box();
    return {box.min().array() - thickness_, box.max().array() + thickness_};
  }

 private:
  void grow(std::span<const Vec3> points, double range,
            std::span<geometry::DistanceSample> samples) const {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      geometry::DistanceSample& sample = samples[i];
      sample.distance -= thickness_;
      if (std::abs(sample.distance) >= range) {
        sample = {std::copysign(range, sample.distance), points[i], sample.normal, -1};
      } else {
        sample.closest += thickness_ * sample.normal;
      }
    }
  }

  std::shared_ptr<const DistanceField> inner_;
  double thickness_;
};

}  // namespace

Product gloved(const Product& product, double thickness) {
  if (!(thickness >= 0.0 && thickness <= 20.0)) {
    std::ostringstream text;
    text << "thickness of a glove is " << thickness << " mm; 0 to 20 mm is allowed";
    throw UsageError(text.str());
  }
  if (thickness == 0.0) return product;
  Product grown = product;  // with its faces, as their designer knows them: r 3 stays r 3
  grown.distance = std::make_shared<OffsetDistance>(product.distance, thickness);
  std::vector<geometry::DistanceSample> samples(grown.mesh.vertices.size());
  product.distance->sample(grown.mesh.vertices, 1.0, samples);
  for (std::size_t v = 0; v < samples.size(); ++v) {
    grown.mesh.vertices[v] += thickness * samples[v].normal;
  }
  return grown;
}

}  // namespace palmar::product
