// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// grasp_benchmark HAND_ASSET: a power grasp round a cylinder, alone and with contact. To reach on
// one core of a quiet machine: 0.5 s with contact.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <memory>

#include "palmar/core/parallel.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/grip_axis.h"
#include "palmar/hand/template_hand.h"
#include "palmar/io/hand_asset.h"
#include "palmar/product/primitives.h"
#include "palmar/study/assessment.h"

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
  const auto shared = std::make_shared<const palmar::Hand>(
      palmar::build_template(palmar::read_hand_asset(argv[1])));
  const palmar::Hand& hand = *shared;
  const palmar::PreparedHand prepared(shared);
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
  benchmark::RegisterBenchmark(
      "power grasp with contact <= 0.5 s",
      [&prepared](benchmark::State& state) {
        const palmar::Product product = cylinder(static_cast<double>(state.range(0)));
        double seconds = 0.0;
        for (auto _ : state) {
          const palmar::Assessment result = palmar::assess(prepared, product);
          seconds += result.times.grasp + result.times.contact;
        }
        state.counters["share of the goal"] =
            seconds / static_cast<double>(state.iterations()) / 0.5;
      })
      ->Arg(35)
      ->Arg(60)
      ->Arg(100)
      ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
