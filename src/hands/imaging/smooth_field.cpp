// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/smooth_field.h"

#include <algorithm>
#include <cmath>

namespace palmar::imaging {
namespace {

/// Patch of a place in [0, 1] and the weights of its four control points.
struct Span {
  int patch = 0;
  std::array<double, 4> weight{};
};

Span span_of(double u, int patches) {
  const double scaled = std::clamp(u, 0.0, 1.0) * patches;
  Span span;
  span.patch = std::min(static_cast<int>(scaled), patches - 1);
  const double t = scaled - span.patch;
  const double s = 1.0 - t;
  span.weight = {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
                 (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0};
  return span;
}

std::size_t cube(int points) {
  const auto n = static_cast<std::size_t>(points);
  return n * n * n;
}

/// Folds the slowest direction of `control`, of `size` numbers per layer, at place u.
std::vector<double> folded(const std::vector<double>& control, std::size_t size, double u,
                           int patches) {
  const Span span = span_of(u, patches);
  std::vector<double> result(size, 0.0);
  for (std::size_t p = 0; p < 4; ++p) {
    const double* layer = control.data() + (static_cast<std::size_t>(span.patch) + p) * size;
    for (std::size_t i = 0; i < size; ++i) result[i] += span.weight[p] * layer[i];
  }
  return result;
}

}  // namespace

SmoothField::SmoothField(int patches) : patches_(patches), control_(cube(patches + 3), 0.0) {}

SmoothField::Plane SmoothField::plane(double w) const {
  const auto n = static_cast<std::size_t>(patches_ + 3);
  return {patches_, folded(control_, n * n, w, patches_)};
}

SmoothField::Line SmoothField::Plane::line(double v) const {
  return {patches, folded(control, patches + 3, v, patches)};
}

double SmoothField::Line::at(double u) const {
  const Span span = span_of(u, patches);
  const double* c = control.data() + span.patch;
  return span.weight[0] * c[0] + span.weight[1] * c[1] + span.weight[2] * c[2] +
         span.weight[3] * c[3];
}

SmoothFieldFit::SmoothFieldFit(const SmoothField& field, const std::vector<Vec3>& places)
    : points_(field.patches_ + 3) {
  places_.reserve(places.size());
  for (const Vec3& at : places) {
    Place place{};
    place.square = 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const Span span = span_of(at[static_cast<Eigen::Index>(a)], field.patches_);
      place.patch[a] = span.patch;
      place.weight[a] = span.weight;
      double square = 0.0;
      for (const double w : span.weight) square += w * w;
      place.square *= square;
    }
    places_.push_back(place);
  }
}

std::vector<double> SmoothFieldFit::add_to(SmoothField& field,
                                           const std::vector<double>& values) const {
  const auto n = static_cast<std::size_t>(points_);
  std::vector<double> sum(cube(points_), 0.0);
  std::vector<double> weight(cube(points_), 0.0);
  // Calls `body` with each control point of a place and its weight.
  const auto each = [n](const Place& place, const auto& body) {
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t q = 0; q < 4; ++q) {
        const double wv = place.weight[2][r] * place.weight[1][q];
        const std::size_t row = ((static_cast<std::size_t>(place.patch[2]) + r) * n +
                                 static_cast<std::size_t>(place.patch[1]) + q) *
                                    n +
                                static_cast<std::size_t>(place.patch[0]);
        for (std::size_t p = 0; p < 4; ++p) body(row + p, wv * place.weight[0][p]);
      }
    }
  };
  for (std::size_t s = 0; s < places_.size(); ++s) {
    const double scaled = values[s] / places_[s].square;
    each(places_[s], [&](std::size_t c, double w) {
      sum[c] += w * w * w * scaled;
      weight[c] += w * w;
    });
  }
  std::vector<double> fitted(values.size(), 0.0);
  for (std::size_t c = 0; c < sum.size(); ++c) {
    sum[c] = weight[c] > 0.0 ? sum[c] / weight[c] : 0.0;
    field.control_[c] += sum[c];
  }
  for (std::size_t s = 0; s < places_.size(); ++s) {
    each(places_[s], [&](std::size_t c, double w) { fitted[s] += w * sum[c]; });
  }
  return fitted;
}

}  // namespace palmar::imaging
