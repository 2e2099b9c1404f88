// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// effort_benchmark HAND_ASSET: tendon forces of all five digits in a power grasp, from the solved
// contact on. To reach on one core of a quiet machine: 5 ms.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <memory>

#include "palmar/core/parallel.h"
#include "palmar/effort/effort.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/product/primitives.h"
#include "palmar/records/hand/hand_asset.h"
#include "palmar/study/assessment/assessment.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fputs("usage: effort_benchmark HAND_ASSET (right.glb of the generic hand)\n", stderr);
    return 2;
  }
  palmar::set_thread_count(1);
  const auto hand = std::make_shared<const palmar::hand::Hand>(
      palmar::hand::build_template(palmar::records::read_hand_asset(argv[1])));
  const palmar::contact::PreparedHand prepared(hand);
  palmar::product::CylinderProductOptions shape;
  shape.diameter = 50.0;
  const palmar::product::Product product = palmar::product::make_cylinder_product(shape);
  const palmar::study::Assessment held = palmar::study::assess(prepared, product);
  benchmark::RegisterBenchmark("effort of a hand <= 5 ms", [&](benchmark::State& state) {
    for (auto _ : state) {
      benchmark::DoNotOptimize(
          palmar::effort::assess_effort(*hand, held.grasp.posture, held.contact,
                                        held.grasp.product_from_hand, *product.distance));
    }
  })->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
