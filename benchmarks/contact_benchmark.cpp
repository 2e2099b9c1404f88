// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The template hand around a cylinder of 48 mm, on one core. Must reach: hand prepared in 1 s,
// contact of the whole grasp in 30 ms (10 ms wanted). The argument is the template's asset file.
#include <benchmark/benchmark.h>

#include <iostream>
#include <memory>

#include "palmar/contact/contact.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh_distance.h"
#include "palmar/geometry/primitive_meshes.h"
#include "palmar/grasp/grasp.h"
#include "palmar/hand/skinning.h"
#include "palmar/hand/template_hand.h"
#include "palmar/io/hand_asset.h"

namespace {

using namespace palmar;

std::shared_ptr<const Hand> template_hand;

void prepare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(PreparedHand(template_hand));
}
BENCHMARK(prepare)->Unit(benchmark::kMillisecond);

void whole_grasp(benchmark::State& state) {
  const PreparedHand hand(template_hand);
  Product product;
  product.mesh = make_cylinder(
      {.radius = 24.0, .length = 150.0, .segments = 96, .rings = 20, .is_capped = true});
  product.distance = std::make_shared<MeshDistance>(product.mesh);
  const Grasp grasp = close_power_grasp(*template_hand, product);
  const std::vector<Vec3> posed = pose_skin(*template_hand, grasp.posture);
  ContactResult contact;
  for (auto _ : state) {
    contact = solve_hand_contact(hand, posed, grasp.product_from_hand, *product.distance);
  }
  state.counters["force_n"] = contact.total.force;
  state.counters["area_mm2"] = contact.total.area;
}
BENCHMARK(whole_grasp)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::cerr << "contact_benchmark: one argument is required: the template's asset, right.glb\n";
    return 2;
  }
  set_thread_count(1);
  template_hand = std::make_shared<const Hand>(build_template(read_hand_asset(argv[1])));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
