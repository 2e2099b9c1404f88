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
std::vector<palmar::hand::SizedDimension> everything(const palmar::hand::Hand& hand) {
  std::vector<palmar::hand::SizedDimension> targets;
  double scatter = 0.04;
  for (const palmar::hand::HandDimension d : palmar::hand::all_hand_dimensions()) {
    using palmar::hand::DimensionKind;
    if (d.kind == palmar::hand::DimensionKind::kHandWidth ||
        d.kind == palmar::hand::DimensionKind::kHandThickness)
      continue;
    if (d.segment == palmar::hand::Segment::kMiddleProximal &&
        d.kind == palmar::hand::DimensionKind::kSegmentLength) {
      continue;  // what the others leave
    }
    const bool is_whole = d.segment == palmar::hand::Segment::kPalm;
    targets.push_back(
        {d, palmar::hand::value_of(hand.dimensions, d) * (1.08 + (is_whole ? 0.0 : scatter))});
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
  const palmar::hand::Hand hand =
      palmar::hand::build_template(palmar::records::read_hand_asset(argv[1]));
  const palmar::hand::HandInstanceMaker maker(hand);
  using palmar::hand::DimensionKind;
  const std::vector<palmar::hand::SizedDimension> two = {
      {{palmar::hand::DimensionKind::kHandLength}, 193.0},
      {{palmar::hand::DimensionKind::kHandCircumference}, 200.0}};
  const std::vector<palmar::hand::SizedDimension> all = everything(hand);
  const auto add = [](const char* name, const auto& run) {
    benchmark::RegisterBenchmark(name, [run](benchmark::State& state) {
      for (auto _ : state) benchmark::DoNotOptimize(run());
    })->Unit(benchmark::kMillisecond);
  };
  add("measure a hand", [&] { return palmar::hand::measure_hand(hand); });
  add("one hand of two dimensions <= 30 ms",
      [&] { return palmar::hand::make_hand_instance(hand, two); });
  add("one hand of 44 dimensions <= 30 ms",
      [&] { return palmar::hand::make_hand_instance(hand, all); });
  add("of many: two dimensions", [&] { return maker.make(two); });
  add("of many: 44 dimensions", [&] { return maker.make(all); });
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
