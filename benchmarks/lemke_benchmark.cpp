// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Contact of one sub-active region: block principal pivoting against Lemke's method on the same
// response matrices, those of a ball of skin pressed on a plane. Must reach: 30 times faster at
// about 600 vertices. The argument is the number of subdivisions of the ball.
#include <benchmark/benchmark.h>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/lcp.h"
#include "palmar/contact/lemke.h"
#include "palmar/contact/prepared_hand.h"

namespace {

using namespace palmar;

ContactProblem pressed_region(int subdivisions) {
  const PreparedHand hand(contact_test::ball_hand(20.0, subdivisions));
  const RegionResponse& response =
      hand.impl().region[static_cast<std::size_t>(Region::kMiddleDistal)];
  const double shear_modulus = 0.05;  // MPa
  const double depth = 4.0;           // mm
  ContactProblem problem;
  problem.response = response.bou.topRows(response.columns).cast<double>() / shear_modulus;
  problem.distance.resize(response.columns);
  for (int i = 0; i < response.columns; ++i) {
    problem.distance[i] = hand.impl().skin.position[response.vertex[i]].z() + 20.0 - depth;
  }
  return problem;
}

void block_pivoting(benchmark::State& state) {
  const ContactProblem problem = pressed_region(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(solve_contact(problem));
  state.counters["vertices"] = static_cast<double>(problem.distance.size());
}
BENCHMARK(block_pivoting)->Arg(3)->Arg(4)->Unit(benchmark::kMillisecond);

void lemke(benchmark::State& state) {
  const ContactProblem problem = pressed_region(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(solve_contact_lemke(problem));
  state.counters["vertices"] = static_cast<double>(problem.distance.size());
}
BENCHMARK(lemke)->Arg(3)->Arg(4)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
