// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/vertex_colours.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::capture {
namespace {

/// A photograph that sees a vertex, and how well the vertex faces it.
struct Sighting {
  double cosine = 0.0;
  std::size_t photograph = 0;
  Eigen::Vector2d pixel;
};

class Sightings {
 public:
  Sightings(const geometry::TriangleMesh& mesh, const std::vector<Photograph>& photographs,
            const std::vector<PhotoOutline>& outlines, double least)
      : mesh_(mesh), photographs_(photographs), outlines_(outlines), least_(least), query_(mesh) {
    normals_ = geometry::vertex_normals(mesh);
    for (const Photograph& photograph : photographs) {
      centres_.push_back(photograph.camera.centre());
    }
  }

  /// Best-facing first.
  std::vector<Sighting> of(std::size_t vertex) const {
    std::vector<Sighting> result;
    const Vec3& point = mesh_.vertices[vertex];
    for (std::size_t p = 0; p < photographs_.size(); ++p) {
      const Vec3 way = centres_[p] - point;
      const double distance = way.norm();
      const double cosine = normals_[vertex].dot(way) / distance;
      if (cosine < least_) continue;
      const PhotoCamera& camera = photographs_[p].camera;
      const auto pixel = camera.project(point);
      if (!pixel || pixel->x() < 1.0 || pixel->y() < 1.0 || pixel->x() > camera.lens.width - 2.0 ||
          pixel->y() > camera.lens.height - 2.0) {
        continue;
      }
      if (!outlines_.empty() && !outlines_[p].holds(point)) continue;
      constexpr double kLift = 0.3;  // mm; the skin round the vertex itself is no obstacle
      if (query_.first_hit(point + kLift * normals_[vertex], way / distance, kLift, distance)) {
        continue;
      }
      result.push_back({cosine, p, *pixel});
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const Sighting& a, const Sighting& b) { return a.cosine > b.cosine; });
    return result;
  }

 private:
  const geometry::TriangleMesh& mesh_;
  const std::vector<Photograph>& photographs_;
  const std::vector<PhotoOutline>& outlines_;
  double least_;
  geometry::RayQuery query_;
  std::vector<Vec3> normals_;
  std::vector<Vec3> centres_;
};

float brightness(const Photograph& photograph, const Eigen::Vector2d& pixel) {
  return pixel_colour(photograph.image, pixel).sum();
}

/// Alternately: what a vertex' brightness is, and what each photograph makes of it.
std::vector<double> gains_of(const Sightings& sightings, std::size_t vertices,
                             const std::vector<Photograph>& photographs) {
  struct Sample {
    std::size_t vertex, photograph;
    double value;
  };
  constexpr std::size_t kVertices = 4000;
  const std::size_t step = std::max<std::size_t>(1, vertices / kVertices);
  std::vector<std::vector<Sample>> seen((vertices + step - 1) / step);
  parallel_for(static_cast<int>(seen.size()), [&](int i) {
    const auto n = static_cast<std::size_t>(i);
    for (const Sighting& one : sightings.of(n * step)) {
      constexpr double kFrontal = 0.5;
      const double value = brightness(photographs[one.photograph], one.pixel);
      if (one.cosine > kFrontal && value > 30.0) seen[n].push_back({n, one.photograph, value});
    }
  });
  std::vector<double> gain(photographs.size(), 1.0);
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> sum(gain.size(), 0.0), weight(gain.size(), 0.0);
    for (const auto& of_vertex : seen) {
      double mean = 0.0;
      for (const Sample& s : of_vertex) mean += gain[s.photograph] * s.value;
      mean /= static_cast<double>(std::max<std::size_t>(1, of_vertex.size()));
      for (const Sample& s : of_vertex) {
        sum[s.photograph] += mean;
        weight[s.photograph] += s.value;
      }
    }
    double logs = 0.0;
    for (std::size_t p = 0; p < gain.size(); ++p) {
      constexpr double kMost = 4.0;
      if (weight[p] > 0.0) gain[p] = std::clamp(sum[p] / weight[p], 1.0 / kMost, kMost);
      logs += std::log(gain[p]);
    }
    const double mean = std::exp(logs / static_cast<double>(gain.size()));
    for (double& g : gain) g /= mean;
  }
  return gain;
}

/// Linear light of a spot a millimetre wide, white being the board's paper.
Eigen::Vector3f spot_light(const Photograph& photograph, const Sighting& sighting, double distance,
                           double gain, const Eigen::Vector3f& paper) {
  constexpr double kApart = 0.5;  // mm
  constexpr float kPower = 2.2F;  // sRGB's, nearly
  const double step = std::max(1.0, kApart * photograph.camera.lens.focal_x / distance);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      sum += pixel_colour(photograph.image, sighting.pixel + step * Eigen::Vector2d(i, j));
    }
  }
  // Only the paper's hue: how bright it is, shadows decide.
  const Eigen::Vector3f white = paper / paper.mean();
  const Eigen::Array3f coded = static_cast<float>(gain) / (9.0F * 255.0F) * sum.array();
  return (coded / white.array()).pow(kPower).matrix();
}

/// What photographs say of some thousand spots that face them.
SkinLight light_on(const Sightings& sightings, const geometry::TriangleMesh& mesh,
                   const std::vector<Photograph>& photographs,
                   const std::vector<PhotoOutline>& outlines, const std::vector<double>& gain) {
  constexpr std::size_t kSpots = 4000;
  constexpr double kFrontal = 0.5;
  const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / kSpots);
  std::vector<std::vector<SkinSample>> spots((mesh.vertices.size() + step - 1) / step);
  parallel_for(static_cast<int>(spots.size()), [&](int i) {
    const std::size_t v = static_cast<std::size_t>(i) * step;
    for (const Sighting& one : sightings.of(v)) {
      if (one.cosine < kFrontal) continue;
      const std::size_t p = one.photograph;
      const double distance = (photographs[p].camera.centre() - mesh.vertices[v]).norm();
      spots[i].push_back(
          {p, spot_light(photographs[p], one, distance, gain[p],
                         outlines.empty() ? PhotoOutline{}.paper : outlines[p].paper)});
    }
  });
  return judge_skin_light(spots);
}

}  // namespace

void VertexColourOptions::check() const {
  if (best < 1 || best > 100) {
    throw UsageError("colours best: " + std::to_string(best) + "; 1 to 100 is allowed");
  }
  if (!(least_cosine >= 0.0 && least_cosine < 1.0)) {
    throw UsageError("colours least_cosine: " + std::to_string(least_cosine) +
                     "; 0 to 1 is allowed");
  }
}

bool PhotoOutline::holds(const Vec3& world) const {
  const auto pixel = camera.project(world);
  if (!pixel) return false;
  const auto x = std::lround(pixel->x()), y = std::lround(pixel->y());
  if (x < 0 || y < 0 || x >= camera.lens.width || y >= camera.lens.height) return false;
  return inside[y * camera.lens.width + x] != 0;
}

VertexColours colour_vertices(const geometry::TriangleMesh& mesh,
                              const std::vector<Photograph>& photographs,
                              const std::vector<PhotoOutline>& outlines,
                              const VertexColourOptions& options) {
  options.check();
  if (!outlines.empty() && outlines.size() != photographs.size()) {
    throw UsageError("one outline per photograph is required");
  }
  const Sightings sightings(mesh, photographs, outlines, options.least_cosine);
  const std::size_t count = mesh.vertices.size();
  VertexColours result;
  result.gain = gains_of(sightings, count, photographs);
  result.light = light_on(sightings, mesh, photographs, outlines, result.gain);
  result.colour.assign(count, Eigen::Vector3f::Zero());
  result.views.assign(count, 0);
  constexpr std::size_t kChunk = 256;
  parallel_for(static_cast<int>((count + kChunk - 1) / kChunk), [&](int chunk) {
    const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
    for (std::size_t v = begin; v < std::min(count, begin + kChunk); ++v) {
      const std::vector<Sighting> seen = sightings.of(v);
      result.views[v] = static_cast<int>(seen.size());
      const std::size_t used = std::min(seen.size(), static_cast<std::size_t>(options.best));
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t i = 0; i < used; ++i) {
        const std::size_t p = seen[i].photograph;
        sum +=
            static_cast<float>(result.gain[p]) * pixel_colour(photographs[p].image, seen[i].pixel);
      }
      if (used > 0) {
        result.colour[v] =
            (sum / (255.0F * static_cast<float>(used))).cwiseMax(0.0F).cwiseMin(1.0F);
      }
    }
  });
  return result;
}

}  // namespace palmar::capture
