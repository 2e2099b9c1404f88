// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/hold_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/degrees.h"

namespace palmar::report {
namespace {

constexpr int kRound = 16;       // directions round the product
constexpr int kGrid = 120;       // pixels on the longer side of the pictures that are counted
constexpr double kReach = 1.25;  // hand lengths from the hand's middle that a picture shows
constexpr std::array<double, 3> kRise = {15.0 * geometry::kDegree, 38.0 * geometry::kDegree,
                                         -15.0 * geometry::kDegree};

// What a pixel shows.
enum Seen : int {
  kNothing = -1,
  kFirstFinger = 0,  // palmar skin of thumb, index, ..., little: 0 to 4
  kBackOfFinger = 5,
  kPalm = 6,
  kBack = 7,
  kHeldPart = 8,
  kRestOfProduct = 9,
  kSeenCount = 10
};
using Counts = std::array<double, kSeenCount>;

struct Painted {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<int> seen;  // per triangle
};

int seen_on_hand(const hand::Hand& hand, int vertex) {
  const hand::Region region = hand.region[vertex];
  const std::optional<hand::Finger> finger = hand::finger_of(hand.segment[vertex]);
  if (region == hand::Region::kDorsum) return finger ? kBackOfFinger : kBack;
  return finger ? kFirstFinger + static_cast<int>(index_of(*finger)) : kPalm;
}

Painted painted(const HeldScene& scene) {
  Painted all;
  all.vertices = scene.skin;
  for (const Triangle& t : scene.hand->skin.triangles) {
    all.triangles.push_back(t);
    all.seen.push_back(seen_on_hand(*scene.hand, t[0]));
  }
  const int shift = static_cast<int>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), scene.product->vertices.begin(),
                      scene.product->vertices.end());
  for (std::size_t k = 0; k < scene.product->triangles.size(); ++k) {
    Triangle t = scene.product->triangles[k];
    for (int& i : t) i += shift;
    all.triangles.push_back(t);
    const bool is_held = !scene.is_held_part.empty() && scene.is_held_part[k] != 0;
    all.seen.push_back(is_held ? kHeldPart : kRestOfProduct);
  }
  return all;
}

/// How many pixels show what, by a depth buffer.
Counts count_seen(const Painted& all, const Camera& camera, double aspect) {
  const int width = kGrid, height = std::max(1, static_cast<int>(kGrid / aspect));
  const double scale = height / camera.view_height;
  const Vec3 right = camera.direction.cross(camera.up).normalized();
  const Vec3 up = right.cross(camera.direction);
  std::vector<Vec3> screen(all.vertices.size());  // pixels, pixels, mm away
  for (std::size_t i = 0; i < screen.size(); ++i) {
    const Vec3 q = all.vertices[i] - camera.position;
    screen[i] = {0.5 * width + scale * right.dot(q), 0.5 * height - scale * up.dot(q),
                 camera.direction.dot(q)};
  }
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<double> depth(size, std::numeric_limits<double>::infinity());
  std::vector<int> seen(size, kNothing);
  for (std::size_t k = 0; k < all.triangles.size(); ++k) {
    const Triangle& t = all.triangles[k];
    const Vec3 &a = screen[t[0]], &b = screen[t[1]], &c = screen[t[2]];
    const double twice = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (std::abs(twice) < 1e-9) continue;
    const auto low = [](double p, double q, double r) {
      return static_cast<int>(std::ceil(std::min({p, q, r}) - 0.5));
    };
    const auto high = [](double p, double q, double r) {
      return static_cast<int>(std::floor(std::max({p, q, r}) - 0.5));
    };
    for (int y = std::max(0, low(a.y(), b.y(), c.y()));
         y <= std::min(height - 1, high(a.y(), b.y(), c.y())); ++y) {
      for (int x = std::max(0, low(a.x(), b.x(), c.x()));
           x <= std::min(width - 1, high(a.x(), b.x(), c.x())); ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double v = ((px - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (py - a.y())) / twice;
        const double w = ((b.x() - a.x()) * (py - a.y()) - (px - a.x()) * (b.y() - a.y())) / twice;
        if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
        const double z = a.z() + v * (b.z() - a.z()) + w * (c.z() - a.z());
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x);
        if (z >= depth[at]) continue;
        depth[at] = z;
        seen[at] = all.seen[k];
      }
    }
  }
  Counts counts{};
  for (const int one : seen) {
    if (one != kNothing) counts[one] += 1.0;
  }
  return counts;
}

/// The vertices that a picture is to show.
Scene framed(const HeldScene& scene) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : scene.skin) middle += p;
  middle /= static_cast<double>(std::max<std::size_t>(1, scene.skin.size()));
  const double reach = kReach * std::max(100.0, scene.hand->dimensions.hand_length);
  SceneObject points;
  points.mesh.vertices = scene.skin;
  for (const Vec3& p : scene.product->vertices) {
    const Vec3 d = p - middle;
    points.mesh.vertices.push_back(d.norm() <= reach ? p : Vec3(middle + reach * d.normalized()));
  }
  // Cameras look at what triangles have: one for every point.
  for (int i = 0; i < points.mesh.vertex_count(); ++i) points.mesh.triangles.push_back({i, i, i});
  return {std::move(points)};
}

std::vector<Vec3> directions_round(const Vec3& up) {
  const Vec3 x = up.unitOrthogonal(), y = up.cross(x);
  std::vector<Vec3> result;
  for (const double rise : kRise) {
    for (int k = 0; k < kRound; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / kRound;
      const Vec3 eye =
          std::cos(rise) * (std::cos(turn) * x + std::sin(turn) * y) + std::sin(rise) * up;
      result.push_back(-eye);
    }
  }
  return result;
}

}  // namespace

Vec3 best_view_of_hold(const HeldScene& scene, const Vec3& up) {
  constexpr double kAspect = 4.0 / 3.0;
  const Vec3 upwards = up.normalized();
  const std::vector<Vec3> directions = directions_round(upwards);
  const Painted all = painted(scene);
  const Scene frame = framed(scene);
  std::vector<Counts> counts(directions.size());
  parallel_for(static_cast<int>(directions.size()), [&](int k) {
    counts[k] =
        count_seen(all, fit_camera(frame, directions[k], upwards, {.aspect = kAspect}), kAspect);
  });
  Counts most{};
  for (const Counts& one : counts) {
    for (int s = 0; s < kSeenCount; ++s) most[s] = std::max(most[s], one[s]);
  }
  const auto share = [&](const Counts& one, int s) {
    return most[s] > 0.0 ? one[s] / most[s] : 0.0;
  };
  double best = -1.0;
  std::size_t at = 0;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    double fingers = 0.0;  // half of what can be seen of a finger is enough
    for (int f = 0; f < hand::kFingerCount; ++f) {
      fingers += std::min(1.0, 2.0 * share(counts[k], kFirstFinger + f)) / hand::kFingerCount;
    }
    const double thumb = std::min(1.0, 2.0 * share(counts[k], kFirstFinger));
    const double part = std::min(1.0, 1.5 * share(counts[k], kHeldPart));
    const double product = std::min(1.0, 1.3 * share(counts[k], kRestOfProduct));
    const double score = 0.4 * fingers + 0.2 * thumb + 0.25 * part + 0.25 * product;
    if (score > best + 1e-9) {
      best = score;
      at = k;
    }
  }
  return directions[at];
}

Camera camera_of_hold(const HeldScene& scene, const Vec3& up, double aspect) {
  if (scene.hand == nullptr || scene.product == nullptr || scene.skin.empty()) {
    throw UsageError("picture of a hold: hand and product are required");
  }
  return fit_camera(framed(scene), best_view_of_hold(scene, up), up.normalized(),
                    {.aspect = aspect, .margin = 0.05});
}

}  // namespace palmar::report
