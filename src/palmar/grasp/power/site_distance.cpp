// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/site_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "palmar/geometry/distance/grid_distance.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::grasp {
namespace {

constexpr double kFinest = 2.0;  // mm between nodes; the final closing is checked exactly
constexpr double kCoarsest = 5.0;
constexpr double kPerDiameter = 14.0;  // nodes along the handle's diameter
constexpr double kPerWall = 0.5;       // of the wall of a hollow product
constexpr double kAlong = 110.0;       // mm from the site along its axis that a hand can touch
constexpr double kSideways = 130.0;    // ... across it

// A field seen from another frame and through a window.
class TurnedField : public geometry::DistanceField {
 public:
  TurnedField(std::shared_ptr<const DistanceField> field, const geometry::Rigid3& field_from_here,
              const Box3& window)
      : field_(std::move(field)), there_from_here_(field_from_here), window_(window) {}

  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    const Eigen::Matrix3d rotation = there_from_here_.rotation.toRotationMatrix();
    std::vector<Vec3> there(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      there[i] = rotation * points[i] + there_from_here_.translation;
    }
    field_->sample(there, range, samples);
    for (geometry::DistanceSample& sample : samples) {
      sample.normal = rotation.transpose() * sample.normal;
      sample.closest = rotation.transpose() * (sample.closest - there_from_here_.translation);
    }
  }
  Box3 bounding_box() const override { return window_; }

 private:
  std::shared_ptr<const DistanceField> field_;
  geometry::Rigid3 there_from_here_;
  Box3 window_;
};

class RefinedField : public geometry::DistanceField {
 public:
  RefinedField(const DistanceField& quick, const DistanceField& exact, double margin)
      : quick_(&quick), exact_(&exact), margin_(margin) {}

  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    quick_->sample(points, range, samples);
    std::vector<Vec3> touched;
    std::vector<std::size_t> place;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (samples[i].distance > margin_) continue;
      touched.push_back(points[i]);
      place.push_back(i);
    }
    std::vector<geometry::DistanceSample> found(touched.size());
    exact_->sample(touched, range, found);
    for (std::size_t i = 0; i < place.size(); ++i) samples[place[i]] = found[i];
  }
  Box3 bounding_box() const override { return exact_->bounding_box(); }

 private:
  const DistanceField* quick_;
  const DistanceField* exact_;
  double margin_;
};

}  // namespace

std::unique_ptr<geometry::DistanceField> exact_where_touched(const geometry::DistanceField& quick,
                                                             const geometry::DistanceField& exact,
                                                             double margin) {
  return std::make_unique<RefinedField>(quick, exact, margin);
}

std::unique_ptr<geometry::DistanceField> distance_near(
    const geometry::TriangleMesh& mesh, std::shared_ptr<const geometry::DistanceField> product,
    const GripSite& site) {
  const Vec3 wide = (site.wide - site.axis * site.axis.dot(site.wide)).normalized();
  Eigen::Matrix3d axes;
  axes << site.axis, wide, site.axis.cross(wide);
  const geometry::Rigid3 product_from_site{Quat(axes), site.point};
  const geometry::Rigid3 site_from_product = product_from_site.inverse();
  const Box3 box = product->bounding_box();
  Box3 window;  // not from `box`: that would turn with the file's axes
  for (const Vec3& v : mesh.vertices) window.extend(site_from_product * v);
  const Vec3 reach(kAlong, kSideways, kSideways);
  window = window.intersection(Box3(-reach, reach));
  geometry::GridDistanceOptions options;
  options.spacing =
      std::clamp(std::min(site.girth / std::numbers::pi / kPerDiameter, kPerWall * site.wall),
                 kFinest, kCoarsest);
  // Nodes in mirrored places for a mirrored product (there the third axis points the other way) and
  // none in the middle plane, where a symmetric product leaves the gradient open.
  const double margin = kSiteBand + 2.0 * options.spacing;  // that the grid adds
  const double side = std::max(-window.min().z(), window.max().z()) + margin;
  window.max().z() = (std::ceil(side / options.spacing - 0.5) + 0.5) * options.spacing - margin;
  window.min().z() = -window.max().z();
  auto near = std::make_shared<TurnedField>(std::move(product), product_from_site, window);
  options.band = kSiteBand;
  auto grid = std::make_shared<geometry::GridDistance>(std::move(near), options);
  return std::make_unique<TurnedField>(std::move(grid), site_from_product, box);
}

double wall_at(const geometry::TriangleMesh& mesh, const geometry::DistanceField& distance,
               const GripSite& site, double palm_breadth) {
  constexpr double kStep = 0.75;            // mm
  constexpr std::size_t kMostProbes = 150;  // a quartile of that many is within a few per cent
  struct Probe {
    Vec3 start, inward;
    double area;  // mm^2; twice
  };
  std::vector<Probe> probes;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const Vec3 centre = (a + b + c) / 3.0;
    const Vec3 r = centre - site.point;
    const double along = site.axis.dot(r);
    const Vec3 across = r - along * site.axis;
    if (std::abs(along) > 0.5 * palm_breadth || across.norm() > 0.75 * site.width) continue;
    const Vec3 normal = (b - a).cross(c - a);
    // Outer faces of the handle only: a bore's face the other way.
    if (normal.dot(across) <= 0.5 * normal.norm() * across.norm()) continue;
    probes.push_back({centre, -normal.normalized(), normal.norm()});
  }
  if (probes.empty()) return 2.0 * kSiteBand;
  const std::size_t stride = probes.size() / kMostProbes + 1;
  std::vector<std::pair<double, double>> depths;  // mm, and the area it stands for
  double whole = 0.0;
  std::vector<Vec3> points;
  std::vector<geometry::DistanceSample> samples;
  for (std::size_t k = 0; k < probes.size(); k += stride) {
    points.clear();
    for (double s = kStep; s <= kSiteBand + 1e-9; s += kStep) {
      points.push_back(probes[k].start + s * probes[k].inward);
    }
    samples.resize(points.size());
    distance.sample(points, 2.0 * kSiteBand, samples);
    double deepest = 0.0;
    for (const geometry::DistanceSample& sample : samples) {
      if (sample.distance > 0.0 || -sample.distance < deepest - kStep) break;  // out again
      deepest = std::max(deepest, -sample.distance);
    }
    depths.emplace_back(deepest, probes[k].area);
    whole += probes[k].area;
  }
  // Close to an edge of a solid bar the next face is near, too: that is no thin wall. Two thirds of
  // the area would have to be thin.
  std::sort(depths.begin(), depths.end());
  double below = 0.0;
  for (const auto& [depth, area] : depths) {
    below += area;
    if (below >= 0.65 * whole) return 2.0 * depth;
  }
  return 2.0 * depths.back().first;
}

}  // namespace palmar::grasp
