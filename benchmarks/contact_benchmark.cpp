// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The template hand around a cylinder of 48 mm, on one core. Must reach: hand prepared in 1 s,
// contact of the whole grasp in 10 ms, its force along a motion without jumps above 2 % per 0.05 mm
// step. The steps of a contact one by one show where the time goes; `bound` is what no direct
// method goes below: one read of the responses among the loaded vertices and one factorisation of
// them. The argument is the template's asset file.
#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/prepared/contact_totals.h"
#include "palmar/contact/prepared/deformed_skin.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/prepared/pressed_skin.h"
#include "palmar/contact/prepared/skin_displacement.h"
#include "palmar/contact/solve/contact_system.h"
#include "palmar/contact/solve/skin_product.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/records/hand/hand_asset.h"

namespace {

using namespace palmar;

std::shared_ptr<const hand::Hand> template_hand;

/// The grasp with its contact; made once.
struct Case {
  contact::PreparedHand hand{template_hand};
  product::Product product;
  geometry::Rigid3 product_from_hand;
  std::vector<Vec3> posed;  // hand frame
  std::vector<Vec3> at;     // product frame
  contact::ContactResult contact;
  contact::SkinOnProduct skin;
  contact::SkinLoad load;     // as solved
  std::vector<double> right;  // G d, MPa mm
  std::vector<int> loaded;

  Case() {
    product.mesh = geometry::make_cylinder(
        {.radius = 24.0, .length = 150.0, .segments = 96, .rings = 20, .is_capped = true});
    product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
    const grasp::Grasp grasp = grasp::close_power_grasp(*template_hand, product);
    product_from_hand = grasp.product_from_hand;
    posed = hand::pose_skin(*template_hand, grasp.posture);
    for (const Vec3& x : posed) at.push_back(product_from_hand * x);
    contact = contact::solve_hand_contact(hand, posed, product_from_hand, *product.distance);
    skin = contact::find_skin_on_product(*template_hand, at, *product.distance, std::nullopt);
    // The modulus of each region's deepest vertex stands for all of it: good enough for times.
    load.vertex = skin.collision;
    for (const int v : load.vertex) {
      double modulus = 0.05;  // MPa
      for (const contact::RegionContact& part : contact.regions) {
        if (part.region == template_hand->region[v]) modulus = part.shear_modulus;
      }
      const double force = contact.force[v];
      load.depth.push_back(-skin.sample[v].distance);
      load.shear_modulus.push_back(modulus);
      load.force.push_back(force);
      load.gap.push_back(0.0);
      load.in_contact.push_back(force > 0.0);
      right.push_back(modulus * skin.sample[v].distance);
      if (force > 0.0) loaded.push_back(v);
    }
  }
};
const Case& grasp_case() {
  static const Case made;
  return made;
}

void prepare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(contact::PreparedHand(template_hand));
}
BENCHMARK(prepare)->Unit(benchmark::kMillisecond);

void whole_grasp(benchmark::State& state) {
  const Case& c = grasp_case();
  contact::ContactResult contact;
  for (auto _ : state) {
    contact =
        contact::solve_hand_contact(c.hand, c.posed, c.product_from_hand, *c.product.distance);
  }
  state.counters["force_n"] = contact.total.force;
  state.counters["area_mm2"] = contact.total.area;
  state.counters["loaded"] = static_cast<double>(c.loaded.size());
}
BENCHMARK(whole_grasp)->Unit(benchmark::kMillisecond);

void step_sampling(benchmark::State& state) {
  const Case& c = grasp_case();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        contact::find_skin_on_product(*template_hand, c.at, *c.product.distance, std::nullopt));
  }
  state.counters["near"] = static_cast<double>(c.skin.near.size());
}
BENCHMARK(step_sampling)->Unit(benchmark::kMillisecond);

void step_assembling(benchmark::State& state) {
  const Case& c = grasp_case();
  contact::ContactSystem system(c.hand.impl().blocks);
  for (auto _ : state) system.assemble(c.hand.impl().response, c.load.vertex, nullptr);
  state.counters["unknowns"] = system.size();
  state.counters["entries"] = static_cast<double>(system.entry_count());
}
BENCHMARK(step_assembling)->Unit(benchmark::kMillisecond);

/// Factorising and solving, from the guess that a first contact starts with (argument 0) or from
/// the answer (1).
void step_solving(benchmark::State& state) {
  const Case& c = grasp_case();
  contact::ContactSystem system(c.hand.impl().blocks);
  system.assemble(c.hand.impl().response, c.load.vertex, nullptr);
  contact::ContactSystem::Outcome outcome;
  for (auto _ : state) {
    std::vector<char> in_contact = c.load.in_contact;
    std::vector<double> force, gap;
    if (state.range(0) == 1) force = c.load.force;
    for (std::size_t k = 0; k < in_contact.size() && state.range(0) == 0; ++k) {
      in_contact[k] = c.load.depth[k] > 2.0;  // mm; half of the limit depth
    }
    outcome = system.solve(c.right, in_contact, force, gap);
  }
  state.counters["iterations"] = outcome.iterations;
  state.counters["pivots"] = outcome.pivots;
}
BENCHMARK(step_solving)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void step_displacement(benchmark::State& state) {
  const Case& c = grasp_case();
  for (auto _ : state) {
    const std::vector<contact::LoadedPart> parts = contact::loaded_parts(c.hand.impl(), c.load);
    benchmark::DoNotOptimize(
        contact::skin_displacement(c.hand.impl(), c.skin, c.load, parts, true));
  }
}
BENCHMARK(step_displacement)->Unit(benchmark::kMillisecond);

void step_deforming(benchmark::State& state) {
  const Case& c = grasp_case();
  const contact::SkinDisplacement u = contact::skin_displacement(
      c.hand.impl(), c.skin, c.load, contact::loaded_parts(c.hand.impl(), c.load), true);
  contact::ContactResult contact = c.contact;
  for (auto _ : state) {
    contact.displacement = u.with_bulge;
    contact::deform_skin(c.hand.impl().skin, c.skin, *c.product.distance, u.is_active, {}, contact);
  }
}
BENCHMARK(step_deforming)->Unit(benchmark::kMillisecond);

void step_totals(benchmark::State& state) {
  const Case& c = grasp_case();
  const std::size_t n = c.at.size();
  std::vector<double> gap(n), modulus(n, 0.0);
  for (std::size_t v = 0; v < n; ++v) gap[v] = c.contact.distance[v] + c.contact.displacement[v];
  for (std::size_t k = 0; k < c.load.vertex.size(); ++k) {
    modulus[static_cast<std::size_t>(c.load.vertex[k])] = c.load.shear_modulus[k];
  }
  contact::ContactResult contact = c.contact;
  for (auto _ : state) {
    contact.regions.clear();
    contact.total = {};
    const contact::SkinGeometry pressed = contact::pressed_skin(c.hand.impl(), c.skin, c.at);
    contact::add_totals(c.hand.impl(), c.skin, pressed, gap, modulus, {}, {},
                        contact::kUsualCellArea, contact);
  }
}
BENCHMARK(step_totals)->Unit(benchmark::kMillisecond);

/// Responses among the loaded vertices, read once (argument 0), and factorised as one dense matrix
/// in single precision (1).
void bound(benchmark::State& state) {
  const Case& c = grasp_case();
  const Eigen::MatrixXd exact =
      contact::dense_response(c.hand.impl().response, c.loaded, template_hand->region, true);
  Eigen::MatrixXf matrix = exact.cast<float>();
  matrix.diagonal() *= 2.0F;  // so that it can be factorised whatever its far entries are
  for (auto _ : state) {
    if (state.range(0) == 0) {
      benchmark::DoNotOptimize(matrix.sum());
    } else {
      benchmark::DoNotOptimize(Eigen::LLT<Eigen::MatrixXf>(matrix).info());
    }
  }
  state.counters["loaded"] = static_cast<double>(c.loaded.size());
}
BENCHMARK(bound)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// The skin comes 2 mm nearer to the cylinder's axis in steps of 0.05 mm, everywhere at once. Time
/// per step; largest step of the total force against the force, from half the way on, and largest
/// bend in it: by how much a force is off the mean of its neighbours.
void closing_motion(benchmark::State& state) {
  const Case& c = grasp_case();
  constexpr int kSteps = 40;
  constexpr double kStep = 0.05;  // mm
  std::vector<std::vector<Vec3>> motion;
  for (int k = 0; k <= kSteps; ++k) {
    std::vector<Vec3>& skin = motion.emplace_back(c.at);
    for (Vec3& x : skin) {
      const Vec3 from_axis(x.x(), x.y(), 0.0);
      x += kStep * (kSteps - k) * from_axis.normalized();
    }
  }
  contact::ContactResult contact;
  std::vector<double> force;
  for (auto _ : state) {
    contact::ContactSolver solver(c.hand);
    force.clear();
    for (const std::vector<Vec3>& skin : motion) {
      solver.solve(skin, {}, *c.product.distance, contact);
      force.push_back(contact.total.force);
    }
  }
  double step = 0.0;
  double bend = 0.0;
  bool is_monotone = true;
  for (std::size_t k = 1; k < force.size(); ++k) {
    if (force[k] < force[k - 1]) is_monotone = false;
    if (k >= force.size() / 2) step = std::max(step, (force[k] - force[k - 1]) / force[k]);
    if (k + 1 < force.size()) {
      bend = std::max(bend, std::abs(force[k] - 0.5 * (force[k - 1] + force[k + 1])) / force[k]);
    }
  }
  state.counters["steps"] = kSteps + 1;
  state.counters["per_step"] = benchmark::Counter(
      kSteps + 1, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["first_n"] = force.front();
  state.counters["last_n"] = force.back();
  state.counters["largest_step"] = step;
  state.counters["largest_bend"] = bend;
  state.counters["is_monotone"] = is_monotone;
}
BENCHMARK(closing_motion)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::cerr << "contact_benchmark: one argument is required: the template's asset, right.glb\n";
    return 2;
  }
  set_thread_count(1);
  template_hand =
      std::make_shared<const hand::Hand>(hand::build_template(records::read_hand_asset(argv[1])));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
