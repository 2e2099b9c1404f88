// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/posture_from_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/hand/posture/posture_registration.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::hand {
namespace {

using registration::Pose;

/// Every k-th vertex one to one; nothing if the mesh isn't this hand's skin.
std::optional<MeshFit> fit_vertices(const Hand& hand, const geometry::TriangleMesh& mesh,
                                    const MeshFitOptions& options) {
  if (mesh.vertices.size() != hand.skin.vertices.size()) return std::nullopt;
  constexpr int kPoints = 400;       // more show no more
  constexpr double kSameHand = 1.0;  // mm, root mean square
  const int stride = std::max(1, hand.skin.vertex_count() / kPoints);
  std::vector<HandPoint> points;
  std::vector<std::optional<Vec3>> measured;
  for (int v = 0; v < hand.skin.vertex_count(); v += stride) {
    points.push_back(skin_point(hand, v));
    measured.emplace_back(mesh.vertices[v]);
  }
  const PostureFitter fitter(hand, points,
                             {.point_sd = 0.5,
                              .fits_scale = options.fits_scale,
                              .is_robust = false,
                              .poor_rms = kSameHand});
  const PostureFit found = fitter.fit(measured);
  MeshFit fit;
  fit.iterations = found.iterations;
  fit.is_vertex_to_vertex = true;
  fit.status = found.status;
  if (found.status == PostureFitStatus::kMirrored) {
    fit.message = found.message;
    return fit;
  }
  if (found.status != PostureFitStatus::kFitted) return std::nullopt;
  fit.posture = found.posture;
  fit.mesh_from_hand = found.measured_from_hand;
  fit.scale = found.scale;
  fit.not_observed = found.not_observed;
  fit.at_limit = found.at_limit;
  return fit;
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto k = static_cast<std::ptrdiff_t>(
      std::min(share * static_cast<double>(values.size()), static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[k];
}

/// Distances of the whole skin, at the end.
void measure(const registration::SkinPoints& skin, const registration::Target& target,
             const MeshFitOptions& options, MeshFit& fit) {
  const Pose pose{fit.posture, fit.mesh_from_hand, fit.scale};
  const registration::PosedSkin posed = skin.pose(pose);
  std::vector<double> distances;
  double area = 0.0, all = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < posed.point.size(); ++i) {
    if (skin.is_forearm(i)) continue;
    all += skin.area(i);
    const auto partner = target.partner(posed.point[i], posed.normal[i], options.reach);
    if (!partner) continue;
    area += skin.area(i);
    distances.push_back(partner->distance);
    sum += partner->distance;
  }
  fit.partner_share = all > 0.0 ? area / all : 0.0;
  fit.mean = distances.empty() ? 0.0 : sum / static_cast<double>(distances.size());
  fit.median = quantile(distances, 0.5);
  fit.percentile_95 = quantile(distances, 0.95);
}

MeshFit registered(const Hand& hand, const registration::Target& target,
                   const MeshFitOptions& options, const Progress& progress) {
  MeshFit fit;
  const registration::Registration found =
      registration::run(hand, target, options.fits_scale, options.max_iterations, progress);
  fit.posture = found.pose.posture;
  fit.mesh_from_hand = found.pose.mesh_from_hand;
  fit.scale = found.pose.scale;
  fit.iterations = found.iterations;
  fit.not_observed = found.not_observed;
  fit.at_limit = found.at_limit;
  measure(registration::SkinPoints(hand, 1), target, options, fit);
  // A bottle, too, lies near some of a hand.
  constexpr double kLeastShare = 0.6, kUsualShare = 0.8;
  const bool is_poor = !(fit.median <= options.poor_median) || fit.partner_share < kLeastShare ||
                       (fit.partner_share < kUsualShare && fit.median > 0.5 * options.poor_median);
  fit.status = is_poor ? PostureFitStatus::kPoor : PostureFitStatus::kFitted;
  return fit;
}

geometry::TriangleMesh mirrored(geometry::TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) v.x() = -v.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace

void MeshFitOptions::check() const {
  const auto require = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
      throw UsageError(
          fmt::format("mesh fit: {} is {:g}; {:g} to {:g} is allowed", name, value, low, high));
    }
  };
  require("reach (mm)", reach, 0.1, 100.0);
  require("poor_median (mm)", poor_median, 0.01, 100.0);
  require("max_iterations", max_iterations, 1, 10000);
}

MeshFit fit_posture_to_mesh(const Hand& hand, const geometry::TriangleMesh& mesh,
                            const MeshFitOptions& options, const Progress& progress) {
  options.check();
  progress.update(0.0, "looking for the hand in the mesh");
  const registration::Target target(mesh);
  MeshFit fit;
  if (auto exact = fit_vertices(hand, mesh, options)) {
    fit = *exact;
    if (fit.status == PostureFitStatus::kMirrored) return fit;
    measure(registration::SkinPoints(hand, 1), target, options, fit);
  } else {
    const double size = target.extent();
    constexpr double kSmallest = 40.0, kLargest = 1500.0;  // mm; a fist, an arm
    if (size < kSmallest || size > kLargest) {
      fit.status = PostureFitStatus::kWrongUnit;
      fit.message = fmt::format(
          "the mesh is {:.3g} mm long; a hand has {:g} mm and more, an arm up to {:g} mm: is the "
          "unit right?",
          size, kSmallest, kLargest);
      return fit;
    }
    fit = registered(hand, target, options, progress);
    // A hand bends into the other one's shape astonishingly well: only what lies close by nearly
    // everywhere is beyond doubt.
    constexpr double kDoubtfulDistance = 3.0, kDoubtfulShare = 0.9;
    if (fit.status == PostureFitStatus::kPoor || fit.percentile_95 > kDoubtfulDistance ||
        fit.partner_share < kDoubtfulShare) {
      const registration::Target other_side(mirrored(mesh));
      const MeshFit other = registered(hand, other_side, options, progress);
      fit.iterations += other.iterations;
      constexpr double kMuchBetter = 0.7;
      if (other.status == PostureFitStatus::kFitted && other.mean < kMuchBetter * fit.mean &&
          other.partner_share > 0.95 * fit.partner_share) {
        fit.status = PostureFitStatus::kMirrored;
        fit.message = fmt::format(
            "the mesh fits the mirrored hand within {:.1f} mm on average, this one only within "
            "{:.1f} mm: is it the other hand? `palmar hand mirror` makes it",
            other.mean, fit.mean);
        return fit;
      }
    }
  }
  fit.message = fmt::format(
      "{:.0f} % of the skin has a partner on the mesh, {:.2f} mm away on average (median {:.2f}, "
      "95 "
      "% within {:.2f} mm)",
      100.0 * fit.partner_share, fit.mean, fit.median, fit.percentile_95);
  if (fit.is_vertex_to_vertex) fit.message += "; vertex for vertex";
  if (options.fits_scale) {
    fit.message += fmt::format("; the hand is {:.1f} % of this one's size", 100.0 * fit.scale);
  }
  if (fit.status == PostureFitStatus::kPoor) {
    fit.message = "the hand was not found in the mesh with certainty: " + fit.message;
  }
  return fit;
}

}  // namespace palmar::hand
