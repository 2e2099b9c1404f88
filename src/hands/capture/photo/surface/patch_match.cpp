// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/patch_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "hands/capture/photo/pinhole.h"
#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"

namespace palmar::capture {
namespace {

using Mat3f = Eigen::Matrix3f;

constexpr int kMostSources = 12;
constexpr int kMostSide = 15;
constexpr float kNoCost = 2.0F;
constexpr float kFlat = 1.5F;  // grey levels; patches with less contrast say nothing

// Eight samples of a patch's row at once; GCC makes of them what the processor has. Sums keep their
// order, so every processor gives the same.
constexpr int kLanes = 8;
typedef float Floats __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t Ints __attribute__((vector_size(4 * kLanes)));
static_assert(kMostSide <= 2 * kLanes);

/// A view to compare with, seen from the reference.
struct Source {
  const PackedView* view = nullptr;
  Mat3f m = Mat3f::Identity();  ///< K_s R K^-1
  Vec3f a = Vec3f::Zero();      ///< K_s t
};

struct Plane {
  Vec3f normal = Vec3f::UnitZ();
  float depth = 0.0F;
};

constexpr int kRow = 2 * kLanes;  // of a patch in memory

/// The patch of the reference round a pixel: values without mean, of unit length; 0 beyond.
struct Patch {
  std::array<float, kMostSide * kRow> value;
  bool has_contrast = false;
};

class Matcher {
 public:
  Matcher(const std::vector<PhotoView>& views, const std::vector<PackedView>& packed, int view,
          const std::vector<int>& sources, const PatchMatchOptions& options)
      : view_(views[view]), options_(options), number_(view) {
    const PhotoCamera& camera = view_.camera;
    const Eigen::Matrix3d k = Pinhole::matrix_of(camera.lens);
    const Eigen::Matrix3d inverse = k.inverse();
    k_inverse_ = inverse.cast<float>();
    for (const int s : sources) {
      const PhotoView& other = views[s];
      const geometry::Rigid3 move =
          other.camera.camera_from_world * camera.camera_from_world.inverse();
      const Eigen::Matrix3d k_s = Pinhole::matrix_of(other.camera.lens);
      sources_.push_back({&packed[s],
                          (k_s * move.rotation.toRotationMatrix() * inverse).cast<float>(),
                          (k_s * move.translation).cast<float>()});
    }
    for (int l = 0; l < kRow; ++l) {
      const bool is_in = l <= 2 * options.radius;
      steps_[l / kLanes][l % kLanes] = is_in ? static_cast<float>(l - options.radius) : 0.0F;
      inside_[l / kLanes][l % kLanes] = is_in ? 1.0F : 0.0F;
    }
    const std::size_t count = view_.grey.size();
    plane_.resize(count);
    cost_.assign(count, kNoCost);
    nearest_.assign(count, 0.0F);
    farthest_.assign(count, 0.0F);
  }

  /// Where depths begin, from the bound; false: none along this ray.
  void start(const PhotoMask& mask, const geometry::RayQuery& bound,
             const geometry::TriangleMesh& bound_mesh) {
    const Vec3 centre = view_.camera.centre();
    const Quat& rotation = view_.camera.camera_from_world.rotation;
    for (int y = options_.radius; y < view_.height() - options_.radius; ++y) {
      for (int x = options_.radius; x < view_.width() - options_.radius; ++x) {
        const std::size_t at = view_.at(x, y);
        if (mask.inside[at] == 0) continue;
        const Vec3 ray = view_.camera.ray({x, y});
        const auto hit = bound.first_hit(centre, ray);
        if (!hit) continue;
        const double z = (rotation * ray).z();
        nearest_[at] = static_cast<float>(std::max(1.0, (hit->distance - options_.front) * z));
        farthest_[at] = static_cast<float>((hit->distance + options_.behind) * z);
        active_.push_back({x, y});
        const Triangle& t = bound_mesh.triangles[hit->triangle];
        const auto corner = [&](int c) -> const Vec3& { return bound_mesh.vertices[t[c]]; };
        const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
        Plane plane;
        plane.normal = facing((rotation * normal).cast<float>(), x, y);
        plane.depth = static_cast<float>(hit->distance * z);
        const Patch patch = patch_at(x, y);
        plane_[at] = plane;
        cost_[at] = cost_of(patch, x, y, plane);
        const auto random = numbers(x, y, -1, 0);
        plane.depth = nearest_[at] + random[0] * (farthest_[at] - nearest_[at]);
        try_plane(patch, x, y, at, plane);
      }
    }
  }

  void iterate(int iteration) {
    for (int colour = 0; colour < 2; ++colour) {
      for (const auto& [x, y] : active_) {
        if (((x + y) & 1) == colour) improve(x, y, iteration);
      }
    }
  }

  DepthMap result() const {
    DepthMap map;
    map.width = view_.width();
    map.height = view_.height();
    map.depth.assign(plane_.size(), 0.0F);
    map.normal.assign(plane_.size(), Vec3f::Zero());
    map.cost = cost_;
    for (const auto& [x, y] : active_) {
      const std::size_t at = view_.at(x, y);
      if (cost_[at] > static_cast<float>(options_.worst_cost)) continue;
      map.depth[at] = plane_[at].depth;
      map.normal[at] = plane_[at].normal;
    }
    return map;
  }

 private:
  Vec3f ray_of(int x, int y) const {
    return k_inverse_ * Vec3f(static_cast<float>(x), static_cast<float>(y), 1.0F);
  }

  /// Turned so far that the camera sees the front at no less than about 5 degrees.
  Vec3f facing(const Vec3f& normal, int x, int y) const {
    const Vec3f ray = ray_of(x, y).normalized();
    const float along = normal.dot(ray);
    constexpr float kLeast = 0.1F;
    if (along <= -kLeast) return normal;
    const Vec3f across = normal - along * ray;
    const float length = across.norm();
    if (length < 1e-6F) return -ray;
    return across * (std::sqrt(1.0F - kLeast * kLeast) / length) - kLeast * ray;
  }

  /// Four numbers in (0, 1).
  std::array<float, 4> numbers(int x, int y, int iteration, int which) const {
    const auto words =
        philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                static_cast<std::uint32_t>(iteration + 1), static_cast<std::uint32_t>(which)},
               {static_cast<std::uint32_t>(options_.seed), static_cast<std::uint32_t>(number_)});
    std::array<float, 4> result;
    for (std::size_t i = 0; i < 4; ++i) {
      result[i] = (static_cast<float>(words[i] >> 8) + 0.5F) * 0x1p-24F;
    }
    return result;
  }

  Patch patch_at(int x, int y) const {
    Patch patch;
    const int r = options_.radius, side = 2 * r + 1;
    float sum = 0.0F;
    for (int j = 0; j < side; ++j) {
      const float* const row = &view_.grey[view_.at(x - r, y + j - r)];
      float* const to = &patch.value[j * kRow];
      for (int i = 0; i < side; ++i) sum += to[i] = row[i];
    }
    const float mean = sum / static_cast<float>(side * side);
    float squares = 0.0F;
    for (int j = 0; j < side; ++j) {
      float* const to = &patch.value[j * kRow];
      for (int i = 0; i < side; ++i) {
        to[i] -= mean;
        squares += to[i] * to[i];
      }
    }
    patch.has_contrast = squares > kFlat * kFlat * static_cast<float>(side * side);
    const float scale = 1.0F / std::sqrt(std::max(squares, 1e-6F));
    for (int j = 0; j < side; ++j) {
      float* const to = &patch.value[j * kRow];
      for (int i = 0; i < side; ++i) to[i] *= scale;
      for (int i = side; i < kRow; ++i) to[i] = 0.0F;
    }
    return patch;
  }

  static float total(const Floats& lanes) {
    float sum = 0.0F;
    for (int l = 0; l < kLanes; ++l) sum += lanes[l];
    return sum;
  }

  /// 1 - correlation of the patch with a source.
  float source_cost(const Patch& patch, const Source& source, const Vec3f& b, float x,
                    float y) const {
    // q = (M + a b^T) (x, y, 1)
    const Vec3f row0 = source.m.row(0).transpose() + source.a[0] * b;
    const Vec3f row1 = source.m.row(1).transpose() + source.a[1] * b;
    const Vec3f row2 = source.m.row(2).transpose() + source.a[2] * b;
    const float w = row2[0] * x + row2[1] * y + row2[2];
    if (!(w > 1e-6F)) return kNoCost;
    const float scale = 1.0F / w;
    const float u = (row0[0] * x + row0[1] * y + row0[2]) * scale;
    const float v = (row1[0] * x + row1[1] * y + row1[2]) * scale;
    const float ux = (row0[0] - u * row2[0]) * scale, uy = (row0[1] - u * row2[1]) * scale;
    const float vx = (row1[0] - v * row2[0]) * scale, vy = (row1[1] - v * row2[1]) * scale;
    const auto r = static_cast<float>(options_.radius);
    const float reach_u = r * (std::abs(ux) + std::abs(uy));
    const float reach_v = r * (std::abs(vx) + std::abs(vy));
    if (!(u - reach_u >= 0.0F && v - reach_v >= 0.0F &&
          u + reach_u < static_cast<float>(source.view->width - 1) &&
          v + reach_v < static_cast<float>(source.view->height - 1))) {
      return kNoCost;
    }
    const int side = 2 * options_.radius + 1;
    Floats sum{}, squares{}, products{};
    const std::uint32_t* const corners = source.view->corners.data();
    const auto width = static_cast<float>(source.view->width);
    for (int j = 0; j < side; ++j) {
      const float dy = static_cast<float>(j) - r;
      for (int first = 0; first < side; first += kLanes) {
        const Floats step = steps_[first / kLanes];
        const Floats in = inside_[first / kLanes];
        // Lanes beyond the patch sample its middle, and don't count.
        const Floats su = (u + dy * uy) + step * ux;
        const Floats sv = (v + dy * vy) + step * vx;
        const Floats iu = __builtin_convertvector(__builtin_convertvector(su, Ints), Floats);
        const Floats iv = __builtin_convertvector(__builtin_convertvector(sv, Ints), Floats);
        const Floats fu = su - iu, fv = sv - iv;
        const Ints place = __builtin_convertvector(iv * width + iu, Ints);
        Ints four;
        for (int l = 0; l < kLanes; ++l) {
          four[l] = static_cast<std::int32_t>(corners[place[l]]);
        }
        const Floats a = __builtin_convertvector(four & 0xff, Floats);
        const Floats b1 = __builtin_convertvector((four >> 8) & 0xff, Floats);
        const Floats c = __builtin_convertvector((four >> 16) & 0xff, Floats);
        const Floats d = __builtin_convertvector((four >> 24) & 0xff, Floats);
        const Floats top = a + fu * (b1 - a);
        const Floats bottom = c + fu * (d - c);
        const Floats value = (top + fv * (bottom - top)) * in;
        Floats reference;
        std::memcpy(&reference, &patch.value[j * kRow + first], sizeof reference);
        sum += value;
        squares += value * value;
        products += reference * value;
      }
    }
    const auto n = static_cast<float>(side * side);
    const float whole = total(sum);
    const float variance = total(squares) - whole * whole / n;
    if (!(variance > kFlat * kFlat * n * 0.25F)) return kNoCost;
    return 1.0F - total(products) / std::sqrt(variance);
  }

  float cost_of(const Patch& patch, int x, int y, const Plane& plane) const {
    if (!patch.has_contrast) return kNoCost;
    const Vec3f ray = ray_of(x, y);
    const float distance = plane.normal.dot(ray) * plane.depth;
    const Vec3f b = k_inverse_.transpose() * plane.normal / distance;
    std::array<float, kMostSources> costs;
    std::size_t count = 0;
    for (const Source& source : sources_) {
      costs[count++] = source_cost(patch, source, b, static_cast<float>(x), static_cast<float>(y));
    }
    const auto best = std::min(count, static_cast<std::size_t>(options_.best));
    std::partial_sort(costs.begin(), costs.begin() + static_cast<long>(best),
                      costs.begin() + static_cast<long>(count));
    float sum = 0.0F;
    for (std::size_t i = 0; i < best; ++i) sum += costs[i];
    return best == 0 ? kNoCost : sum / static_cast<float>(best);
  }

  void try_plane(const Patch& patch, int x, int y, std::size_t at, const Plane& plane) {
    if (!(plane.depth >= nearest_[at] && plane.depth <= farthest_[at])) return;
    const float cost = cost_of(patch, x, y, plane);
    if (cost < cost_[at]) {
      cost_[at] = cost;
      plane_[at] = plane;
    }
  }

  void improve(int x, int y, int iteration) {
    const std::size_t at = view_.at(x, y);
    const Patch patch = patch_at(x, y);
    if (!patch.has_contrast) return;
    const Vec3f ray = ray_of(x, y);
    constexpr int kFar = 5;  // odd: the other colour
    constexpr std::array<std::array<int, 2>, 8> kNeighbours = {
        {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-kFar, 0}, {kFar, 0}, {0, -kFar}, {0, kFar}}};
    for (const auto& [dx, dy] : kNeighbours) {
      const int nx = x + dx, ny = y + dy;
      if (nx < 0 || ny < 0 || nx >= view_.width() || ny >= view_.height()) continue;
      const std::size_t from = view_.at(nx, ny);
      if (farthest_[from] == 0.0F) continue;  // no plane there
      Plane plane = plane_[from];
      const float along = plane.normal.dot(ray);
      if (along > -0.05F) continue;
      plane.depth *= plane.normal.dot(ray_of(nx, ny)) / along;
      // The same plane but for what can't be distinguished is no news.
      constexpr float kSameDepth = 0.02F, kSameNormal = 4e-4F;  // mm, square of a tangent
      const Plane& own = plane_[at];
      if (std::abs(plane.depth - own.depth) < kSameDepth &&
          (plane.normal - own.normal).squaredNorm() < kSameNormal) {
        continue;
      }
      try_plane(patch, x, y, at, plane);
    }
    constexpr float kShrink = 0.35F;
    const float shrunk = std::pow(kShrink, static_cast<float>(iteration));
    const float depth_range = 5.0F * shrunk, turn_range = 0.7F * shrunk;  // mm, tangent
    const auto random = numbers(x, y, iteration, 0);
    const auto tilt = numbers(x, y, iteration, 1);
    const Plane old = plane_[at];
    Plane moved = old;
    moved.depth += (2.0F * random[0] - 1.0F) * depth_range;
    try_plane(patch, x, y, at, moved);
    Plane turned = plane_[at];
    turned.normal =
        facing((turned.normal + turn_range * Vec3f(2.0F * tilt[0] - 1.0F, 2.0F * tilt[1] - 1.0F,
                                                   2.0F * tilt[2] - 1.0F))
                   .normalized(),
               x, y);
    try_plane(patch, x, y, at, turned);
    Plane both = plane_[at];
    both.depth += (2.0F * random[1] - 1.0F) * 0.3F * depth_range;
    both.normal = facing((both.normal + 0.5F * turn_range *
                                            Vec3f(2.0F * random[2] - 1.0F, 2.0F * random[3] - 1.0F,
                                                  2.0F * tilt[3] - 1.0F))
                             .normalized(),
                         x, y);
    try_plane(patch, x, y, at, both);
    if (iteration < 2) {
      Plane anywhere = plane_[at];
      const auto again = numbers(x, y, iteration, 2);
      anywhere.depth = nearest_[at] + again[0] * (farthest_[at] - nearest_[at]);
      try_plane(patch, x, y, at, anywhere);
    }
  }

  const PhotoView& view_;
  const PatchMatchOptions& options_;
  int number_;
  Mat3f k_inverse_;
  std::vector<Source> sources_;
  std::vector<std::array<int, 2>> active_;
  std::vector<Plane> plane_;
  std::vector<float> cost_, nearest_, farthest_;
  std::array<Floats, 2> steps_{}, inside_{};
};

}  // namespace

void PatchMatchOptions::check() const {
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds)
      throw UsageError(fmt::format("stereo {}: {:g}; {} is allowed", field, value, allowed));
  };
  require(radius >= 1 && radius <= kMostSide / 2, "radius", radius, "1 to 7 pixels");
  require(sources >= 1 && sources <= kMostSources, "sources", sources, "1 to 12");
  require(best >= 1 && best <= sources, "best", best, "1 to the number of sources");
  require(iterations >= 1 && iterations <= 20, "iterations", iterations, "1 to 20");
  require(wanted_angle >= 4 && wanted_angle <= 50, "wanted_angle", wanted_angle, "4 to 50 deg");
  require(front >= 0 && front <= 100, "front", front, "0 to 100 mm");
  require(behind > 0 && behind <= 500, "behind", behind, "0 to 500 mm");
  require(worst_cost > 0 && worst_cost <= 2, "worst_cost", worst_cost, "0 to 2");
}

PackedView packed(const PhotoView& view) {
  PackedView result{view.width(), view.height(), {}};
  result.corners.resize(view.grey.size());
  const auto value = [&](int x, int y) {
    const float grey =
        view.grey[view.at(std::min(x, view.width() - 1), std::min(y, view.height() - 1))];
    return static_cast<std::uint32_t>(std::clamp(grey + 0.5F, 0.0F, 255.0F));
  };
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      result.corners[view.at(x, y)] =
          value(x, y) | value(x + 1, y) << 8 | value(x, y + 1) << 16 | value(x + 1, y + 1) << 24;
    }
  }
  return result;
}

std::vector<std::vector<int>> choose_sources(const std::vector<PhotoView>& views, const Vec3& point,
                                             const PatchMatchOptions& options) {
  options.check();
  std::vector<Vec3> axes;
  for (const PhotoView& view : views) axes.push_back((view.camera.centre() - point).normalized());
  std::vector<std::vector<int>> chosen(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::vector<std::pair<double, int>> ranked;
    for (std::size_t o = 0; o < views.size(); ++o) {
      const double angle =
          std::acos(std::clamp(axes[v].dot(axes[o]), -1.0, 1.0)) / geometry::kDegree;
      if (o == v || angle < 4.0 || angle > 50.0) continue;
      ranked.emplace_back(std::abs(angle - options.wanted_angle), static_cast<int>(o));
    }
    std::sort(ranked.begin(), ranked.end());
    for (const auto& [_, other] : ranked) {
      if (static_cast<int>(chosen[v].size()) < options.sources) chosen[v].push_back(other);
    }
  }
  return chosen;
}

DepthMap match_patches(const std::vector<PhotoView>& views, const std::vector<PackedView>& packed,
                       int view, const PhotoMask& mask, const std::vector<int>& sources,
                       const geometry::RayQuery& bound, const geometry::TriangleMesh& bound_mesh,
                       const PatchMatchOptions& options) {
  options.check();
  Matcher matcher(views, packed, view, sources, options);
  matcher.start(mask, bound, bound_mesh);
  for (int i = 0; i < options.iterations; ++i) matcher.iterate(i);
  return matcher.result();
}

}  // namespace palmar::capture
