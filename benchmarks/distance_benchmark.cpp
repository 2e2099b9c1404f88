// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Signed distance of 10 000 points within 10 mm of a bumpy handle of 200 000 triangles, on one
// core. Must reach: 20 ms for the exact field (closed mesh), 1 ms for the grid.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>

#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/grid_distance.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/distance/winding_number.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace {

using namespace palmar;

constexpr double kBand = 10.0;   // mm
constexpr double kRange = 15.0;  // mm

/// A closed handle of about 50 x 60 x 150 mm with waves along it; `rings` bands of 4/3 `rings`
/// segments.
geometry::TriangleMesh bumpy_handle(int rings, bool is_open) {
  geometry::TriangleMesh mesh = geometry::make_cylinder({.radius = 24.0,
                                                         .length = 150.0,
                                                         .segments = 4 * rings / 3,
                                                         .rings = rings,
                                                         .is_capped = !is_open});
  for (Vec3& x : mesh.vertices) {
    const double wave = 1.0 + 0.12 * std::sin(x.z() / 75.0 * 3.0 * std::numbers::pi) +
                        0.05 * std::cos(4.0 * std::atan2(x.y(), x.x()));
    x.x() *= wave;
    x.y() *= 1.2 * wave;
  }
  return mesh;
}

std::vector<Vec3> points_near(const geometry::TriangleMesh& mesh, int count) {
  std::mt19937 generator(1);
  const auto uniform = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  std::vector<Vec3> points;
  while (static_cast<int>(points.size()) < count) {
    const auto t = static_cast<std::size_t>(uniform() * mesh.triangle_count());
    const Triangle& k = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[k[0]], &b = mesh.vertices[k[1]], &c = mesh.vertices[k[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    points.emplace_back((a + b + c) / 3.0 + kBand * (2.0 * uniform() - 1.0) * normal);
  }
  return points;
}

/// Argument 0: rings of the handle; 250 give 200 000 triangles. Argument 1: 1 if open.
void signed_distance(benchmark::State& state) {
  set_thread_count(1);
  const geometry::TriangleMesh mesh =
      bumpy_handle(static_cast<int>(state.range(0)), state.range(1) == 1);
  const geometry::MeshDistance field(mesh);
  const auto points = points_near(mesh, 10000);
  std::vector<geometry::DistanceSample> samples(points.size());
  for (auto _ : state) {
    field.sample(points, kRange, samples);
    benchmark::DoNotOptimize(samples.data());
  }
  state.counters["triangles"] = mesh.triangle_count();
  state.counters["points"] = static_cast<double>(points.size());
}
BENCHMARK(signed_distance)
    ->Args({62, 0})
    ->Args({250, 0})
    ->Args({250, 1})
    ->Unit(benchmark::kMillisecond);

void closest_point(benchmark::State& state) {
  const geometry::TriangleMesh mesh = bumpy_handle(250, false);
  const geometry::ClosestPointQuery query(mesh);
  const auto points = points_near(mesh, 10000);
  for (auto _ : state) {
    for (const Vec3& p : points) benchmark::DoNotOptimize(query.closest(p, kRange));
  }
}
BENCHMARK(closest_point)->Unit(benchmark::kMillisecond);

void winding_number(benchmark::State& state) {
  const geometry::TriangleMesh mesh = bumpy_handle(250, false);
  const geometry::WindingNumber winding(mesh);
  const auto points = points_near(mesh, 10000);
  for (auto _ : state) {
    for (const Vec3& p : points) benchmark::DoNotOptimize(winding.at(p));
  }
}
BENCHMARK(winding_number)->Unit(benchmark::kMillisecond);

void build_mesh_distance(benchmark::State& state) {
  set_thread_count(1);
  const geometry::TriangleMesh mesh = bumpy_handle(250, false);
  for (auto _ : state) benchmark::DoNotOptimize(geometry::MeshDistance(mesh).is_closed());
}
BENCHMARK(build_mesh_distance)->Unit(benchmark::kMillisecond);

void build_grid(benchmark::State& state) {
  set_thread_count(1);
  const auto field = std::make_shared<const geometry::MeshDistance>(
      bumpy_handle(static_cast<int>(state.range(0)), false));
  for (auto _ : state) benchmark::DoNotOptimize(geometry::GridDistance(field).spacing());
}
BENCHMARK(build_grid)->Arg(62)->Arg(250)->Unit(benchmark::kMillisecond);

void grid_distance(benchmark::State& state) {
  set_thread_count(1);
  const geometry::TriangleMesh mesh = bumpy_handle(62, false);
  const geometry::GridDistance grid(std::make_shared<const geometry::MeshDistance>(mesh));
  const auto points = points_near(mesh, 10000);
  std::vector<geometry::DistanceSample> samples(points.size());
  for (auto _ : state) {
    grid.sample(points, 12.0, samples);
    benchmark::DoNotOptimize(samples.data());
  }
}
BENCHMARK(grid_distance)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
