// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// hand_instance_benchmark HAND_ASSET: one hand scaled segment by segment, from two dimensions and
// from all of a population's, the template laid out again or once for many; and measuring a hand.
// To reach on one core of a quiet machine: 30 ms a hand.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <vector>

#include "palmar/core/parallel.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/records/hand/hand_asset.h"

namespace {

/// Segments a few percent away from the hand's proportions, in turn longer and shorter.
std::vector<palmar::SizedDimension> everything(const palmar::Hand& hand) {
  std::vector<palmar::SizedDimension> targets;
  double scatter = 0.04;
  for (const palmar::HandDimension d : palmar::all_hand_dimensions()) {
    using palmar::DimensionKind;
    if (d.kind == DimensionKind::kHandWidth || d.kind == DimensionKind::kHandThickness) continue;
    if (d.segment == palmar::Segment::kMiddleProximal && d.kind == DimensionKind::kSegmentLength) {
      continue;  // what the others leave
    }
    const bool is_whole = d.segment == palmar::Segment::kPalm;
    targets.push_back({d, value_of(hand.dimensions, d) * (1.08 + (is_whole ? 0.0 : scatter))});
    scatter = -scatter;
  }
  return targets;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fputs("usage: hand_instance_benchmark HAND_ASSET (right.glb of the generic hand)\n",
               stderr);
    return 2;
  }
  palmar::set_thread_count(1);
  const palmar::Hand hand = palmar::build_template(palmar::read_hand_asset(argv[1]));
  const palmar::HandInstanceMaker maker(hand);
  using palmar::DimensionKind;
  const std::vector<palmar::SizedDimension> two = {{{DimensionKind::kHandLength}, 193.0},
                                                   {{DimensionKind::kHandCircumference}, 200.0}};
  const std::vector<palmar::SizedDimension> all = everything(hand);
  const auto add = [](const char* name, const auto& run) {
    benchmark::RegisterBenchmark(name, [run](benchmark::State& state) {
      for (auto _ : state) benchmark::DoNotOptimize(run());
    })->Unit(benchmark::kMillisecond);
  };
  add("measure a hand", [&] { return palmar::measure_hand(hand); });
  add("one hand of two dimensions <= 30 ms", [&] { return make_hand_instance(hand, two); });
  add("one hand of 44 dimensions <= 30 ms", [&] { return make_hand_instance(hand, all); });
  add("of many: two dimensions", [&] { return maker.make(two); });
  add("of many: 44 dimensions", [&] { return maker.make(all); });
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
