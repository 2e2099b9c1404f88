// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// stability_benchmark HAND_ASSET: stability of a power grasp's contact, and the growing hull
// against the whole hull by Qhull (where that was there when this was built). To reach on one core
// of a quiet machine: 50 ms for all of stability. Ends with 1 if the two hulls differ by more than
// 1e-6.
#include <benchmark/benchmark.h>
#ifdef PALMAR_WITH_QHULL
#include <libqhull_r/qhull_ra.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <vector>

#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/indices/stability.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/product/primitives.h"
#include "palmar/records/hand/hand_asset.h"
#include "palmar/study/assessment/assessment.h"

namespace {

/// Processor time, ms.
double now() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Held {
  palmar::product::Product product;
  palmar::study::Assessment assessment;
  palmar::Vec3 centre;
};

Held hold_cylinder(const palmar::contact::PreparedHand& hand, double diameter) {
  palmar::product::CylinderProductOptions options;
  options.diameter = diameter;
  Held held{palmar::product::make_cylinder_product(options), {}, {}};
  held.assessment = palmar::study::assess(hand, held.product);
  held.centre = palmar::geometry::centre_of_volume(held.product.mesh);
  return held;
}

#ifdef PALMAR_WITH_QHULL
struct WholeHull {
  double distance = 0.0, volume = 0.0, time = 0.0;
  int facets = 0;
};

WholeHull whole_hull(const palmar::grasp::PointGroups<6>& groups) {
  std::vector<double> points;
  for (const auto& group : groups.group) {
    for (const auto& w : group) points.insert(points.end(), w.data(), w.data() + 6);
  }
  const double start = now();
  WholeHull result;
  qhT memory;
  qhT* qh = &memory;
  QHULL_LIB_CHECK
  qh_zero(qh, stderr);
  char command[] = "qhull FA";
  if (qh_new_qhull(qh, 6, static_cast<int>(points.size() / 6), points.data(), 0, command, nullptr,
                   stderr) == 0) {
    result.distance = std::numeric_limits<double>::infinity();
    facetT* facet;
    FORALLfacets {
      result.distance = std::min(result.distance, -static_cast<double>(facet->offset));
      ++result.facets;
    }
    result.volume = qh->totvol;
  }
  qh_freeqhull(qh, qh_ALL);
  result.time = now() - start;
  return result;
}
#endif

/// Prints both hulls; whether they agree.
bool compare_hulls(const Held& held, const palmar::hand::Hand& hand, int contacts) {
  palmar::grasp::ReductionOptions reduction;
  reduction.max_contacts = contacts;
  const auto reduced = palmar::grasp::reduce_contact(hand, held.assessment.contact, reduction);
  const double scale = palmar::grasp::torque_scale_of(reduced, held.centre);
  const auto groups = palmar::grasp::primitive_wrenches(reduced, held.centre, scale, {});
  palmar::grasp::BodyOptions options;
  options.max_volume_facets = 1'000'000;
  options.with_volume = false;
  const double start = now();
  const auto distance = palmar::grasp::measure(groups, options);
  const double middle = now();
  options.with_volume = true;
  const auto ours = palmar::grasp::measure(groups, options);
  const double end = now();
  std::printf("%2zu contacts: epsilon %.9f in %.1f ms; with volume %.9g (%d facets) in %.1f ms\n",
              reduced.size(), distance.distance, middle - start, ours.volume, ours.facets,
              end - middle);
#ifdef PALMAR_WITH_QHULL
  const WholeHull theirs = whole_hull(groups);
  std::printf("    Qhull:   epsilon %.9f,            volume %.9g (%d facets) in %.1f ms\n",
              theirs.distance, theirs.volume, theirs.facets, theirs.time);
  return std::abs(ours.distance - theirs.distance) < 1e-6 &&
         std::abs(ours.volume - theirs.volume) < 1e-6 * theirs.volume;
#else
  return true;
#endif
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fputs("usage: stability_benchmark HAND_ASSET (right.glb of the generic hand)\n", stderr);
    return 2;
  }
  palmar::set_thread_count(1);
  const auto hand = std::make_shared<const palmar::hand::Hand>(
      palmar::hand::build_template(palmar::records::read_hand_asset(argv[1])));
  const palmar::contact::PreparedHand prepared(hand);
  bool agrees = true;
  for (const double diameter : {35.0, 51.0, 70.0}) {
    const auto held = std::make_shared<const Held>(hold_cylinder(prepared, diameter));
    std::printf("cylinder of %.0f mm\n", diameter);
    for (const int contacts : {6, 10, 16, 24}) {
      agrees = compare_hulls(*held, *hand, contacts) && agrees;
    }
    benchmark::RegisterBenchmark(
        ("stability <= 50 ms/" + std::to_string(static_cast<int>(diameter))).c_str(),
        [held, hand](benchmark::State& state) {
          palmar::grasp::StabilityOptions options;
          options.load = palmar::contact::ProductLoad{.weight = 10.0};
          for (auto _ : state) {
            benchmark::DoNotOptimize(palmar::grasp::assess_stability(
                *hand, held->assessment.contact, held->centre, options));
          }
        })
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RunSpecifiedBenchmarks();
  return agrees ? 0 : 1;
}
