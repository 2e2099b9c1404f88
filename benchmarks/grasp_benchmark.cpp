// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// grasp_benchmark HAND_ASSET: closing a power grasp round a cylinder, contact not included. To
// reach: 0.4 s on one core of a quiet machine (0.5 s with contact).
#include <benchmark/benchmark.h>

#include <cstdio>

#include "palmar/core/parallel.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/grip_axis.h"
#include "palmar/hand/template_hand.h"
#include "palmar/io/hand_asset.h"
#include "palmar/product/primitives.h"

namespace {

palmar::Product cylinder(double diameter) {
  palmar::CylinderProductOptions options;
  options.diameter = diameter;
  return palmar::make_cylinder_product(options);
}

void find_sites(benchmark::State& state) {
  const palmar::Product product = cylinder(static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(palmar::find_grip_sites(product.mesh));
  state.counters["triangles"] = product.mesh.triangle_count();
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fputs("usage: grasp_benchmark HAND_ASSET (right.glb of the generic hand)\n", stderr);
    return 2;
  }
  palmar::set_thread_count(1);
  const palmar::Hand hand = palmar::build_template(palmar::read_hand_asset(argv[1]));
  benchmark::RegisterBenchmark("find_sites", find_sites)->Arg(35)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(
      "power_grasp",
      [&hand](benchmark::State& state) {
        const palmar::Product product = cylinder(static_cast<double>(state.range(0)));
        for (auto _ : state) {
          benchmark::DoNotOptimize(palmar::close_power_grasp(hand, product));
        }
      })
      ->Arg(35)
      ->Arg(60)
      ->Arg(100)
      ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
