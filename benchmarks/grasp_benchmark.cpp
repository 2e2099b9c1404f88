// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// grasp_benchmark HAND_ASSET [MESH]: a power grasp round a cylinder, alone, with contact, and at
// rest; the whole of assess(); the search for a placement on a product's mesh (mm). To reach on one
// core of a quiet machine: 0.25 s for grasp and contact, 1 s for coming to rest, 5 s for the
// search.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <memory>
#include <string>

#include "palmar/core/parallel.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/product/primitives.h"
#include "palmar/records/hand/hand_asset.h"
#include "palmar/records/product/product_file.h"
#include "palmar/study/assessment/assessment.h"

namespace {

palmar::product::Product cylinder(double diameter) {
  palmar::product::CylinderProductOptions options;
  options.diameter = diameter;
  return palmar::product::make_cylinder_product(options);
}

void find_sites(benchmark::State& state) {
  const palmar::product::Product product = cylinder(static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(palmar::grasp::find_grip_sites(product.mesh));
  state.counters["triangles"] = product.mesh.triangle_count();
}

/// What a coming to rest took; the status as a label.
void balance(benchmark::State& state, const palmar::contact::PreparedHand& hand) {
  const palmar::product::Product product = cylinder(static_cast<double>(state.range(0)));
  const palmar::grasp::Grasp closed = palmar::grasp::find_grasp(hand.hand(), product);
  palmar::grasp::Balance found;
  for (auto _ : state) {
    palmar::grasp::Grasp grasp = closed;
    found = palmar::grasp::balance_grasp(hand, product, grasp);
  }
  state.SetLabel(std::string(name_of(found.status)));
  state.counters["iterations"] = found.iterations;
}

/// assess() as the command runs it, without its report; ms of each part beside the whole.
void assess_all(benchmark::State& state, const palmar::contact::PreparedHand& hand) {
  const palmar::product::Product product = cylinder(static_cast<double>(state.range(0)));
  palmar::study::AssessTimes sum;
  for (auto _ : state) {
    const palmar::study::AssessTimes times = palmar::study::assess(hand, product).times;
    sum.grasp += times.grasp;
    sum.balance += times.balance;
    sum.contact += times.contact;
    sum.indices += times.indices;
  }
  const double per_run = 1e3 / static_cast<double>(state.iterations());
  state.counters["grasp"] = per_run * sum.grasp;
  state.counters["balance"] = per_run * sum.balance;
  state.counters["contact"] = per_run * sum.contact;
  state.counters["indices"] = per_run * sum.indices;
}

void search(benchmark::State& state, const palmar::hand::Hand& hand,
            const palmar::product::Product& product) {
  palmar::grasp::PowerGraspOptions options;
  options.candidates = static_cast<int>(state.range(0));
  palmar::grasp::Grasp grasp;
  for (auto _ : state) grasp = palmar::grasp::close_power_grasp(hand, product, options);
  state.SetLabel(name_of(grasp.status));
  state.counters["tried"] = grasp.candidates;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 2 || argc > 3) {
    std::fputs("usage: grasp_benchmark HAND_ASSET (right.glb of the generic hand) [MESH]\n",
               stderr);
    return 2;
  }
  palmar::set_thread_count(1);
  const auto shared = std::make_shared<const palmar::hand::Hand>(
      palmar::hand::build_template(palmar::records::read_hand_asset(argv[1])));
  const palmar::hand::Hand& hand = *shared;
  const palmar::contact::PreparedHand prepared(shared);
  benchmark::RegisterBenchmark("find_sites", find_sites)->Arg(35)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(
      "power_grasp",
      [&hand](benchmark::State& state) {
        const palmar::product::Product product = cylinder(static_cast<double>(state.range(0)));
        for (auto _ : state) {
          benchmark::DoNotOptimize(palmar::grasp::close_power_grasp(hand, product));
        }
      })
      ->Arg(35)
      ->Arg(60)
      ->Arg(100)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("power grasp with contact <= 0.25 s",
                               [&prepared](benchmark::State& state) {
                                 const palmar::product::Product product =
                                     cylinder(static_cast<double>(state.range(0)));
                                 palmar::study::AssessOptions options;
                                 options.balance.is_on = false;
                                 double seconds = 0.0;
                                 for (auto _ : state) {
                                   const palmar::study::Assessment result =
                                       palmar::study::assess(prepared, product, options);
                                   seconds += result.times.grasp + result.times.contact;
                                 }
                                 state.counters["share of the goal"] =
                                     seconds / static_cast<double>(state.iterations()) / 0.25;
                               })
      ->Arg(35)
      ->Arg(60)
      ->Arg(100)
      ->Unit(benchmark::kMillisecond);
  const auto on_prepared = [&prepared](const auto& run) {
    return [&prepared, run](benchmark::State& state) { run(state, prepared); };
  };
  benchmark::RegisterBenchmark("equilibrium <= 1 s", on_prepared(balance))
      ->Arg(35)
      ->Arg(48)
      ->Arg(60)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("assess", on_prepared(assess_all))
      ->Arg(35)
      ->Arg(48)
      ->Arg(60)
      ->Unit(benchmark::kMillisecond);
  const palmar::product::Product product =
      argc == 3 ? palmar::records::load_product(argv[2],
                                                {.unit = palmar::geometry::LengthUnit::kMillimetre})
                : cylinder(48.0);
  benchmark::RegisterBenchmark("placement search <= 5 s",
                               [&](benchmark::State& state) { search(state, hand, product); })
      ->Arg(200)
      ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
