// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// study_benchmark HAND_ASSET [MESH]: what one grasp of a study costs on one thread, what 30 hands
// with 4 products cost on one and on two, and the memory. Products: cylinder 35 mm, prisms of 35 mm
// with fillets 3 and 10 mm, cylinder 50 mm or the mesh (mm). Prints ours, what is asked, and their
// ratio; times are of a quiet machine, medians; of the whole also the processor time.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/footprint/footprint.h"
#include "palmar/contact/hand_family.h"
#include "palmar/core/parallel.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/product/primitives.h"
#include "palmar/records/hand/hand_asset.h"
#include "palmar/records/product/product_file.h"
#include "palmar/study/assessment/assessment.h"

namespace {

using namespace palmar;

constexpr int kHands = 30;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Processor time of all threads so far, s.
double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return of(usage.ru_utime) + of(usage.ru_stime);
}

/// As a study sets them (study_task.cpp).
study::AssessOptions study_options() {
  study::AssessOptions options;
  options.footprint = false;
  options.balance.aim = 0.005;
  return options;
}

/// A study's share after the grasp is at rest: contact, indices and the map on the product.
void judge_grasp(const contact::PreparedHand& prepared, const product::Product& product,
                 const grasp::Grasp& grasp, const grasp::Balance& balance) {
  const study::Assessment found =
      study::evaluate(prepared, product, grasp, study_options(), {}, balance);
  contact::map_to_product(prepared.hand(), found.contact, product.mesh, 1000.0);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

void row(const std::string& what, double ours, const char* unit,
         std::optional<double> asked = std::nullopt) {
  if (asked) {
    std::printf("%-66s %9.3f %-3s %9.3f %6.2f\n", what.c_str(), ours, unit, *asked, ours / *asked);
  } else {
    std::printf("%-66s %9.3f %-3s\n", what.c_str(), ours, unit);
  }
  std::fflush(stdout);
}

product::Product prism(double fillet) {
  product::PrismProductOptions options;
  options.width = options.depth = 35.0;
  options.fillet_radius = fillet;
  return product::make_prism_product(options);
}

product::Product cylinder(double diameter) {
  product::CylinderProductOptions options;
  options.diameter = diameter;
  return product::make_cylinder_product(options);
}

/// Hand k of 30: length and circumference on two rings about the mean, up to two standard
/// deviations (Xie 2014: 184 +- 10.4 mm, 193 +- 14.0 mm).
std::shared_ptr<const hand::Hand> hand_number(int k, const hand::Hand& base,
                                              const hand::HandDimensions& mean) {
  const double angle = 2.4 * k, radius = 0.4 + 1.6 * k / (kHands - 1);  // 2.4 rad: a sunflower
  const double length = 1.0 + radius * std::cos(angle) * 10.4 / 184.0;
  const double girth = 1.0 + radius * std::sin(angle) * 14.0 / 193.0;
  return std::make_shared<const hand::Hand>(
      hand::make_hand_instance(
          base, {{{hand::DimensionKind::kHandLength}, length * mean.hand_length},
                 {{hand::DimensionKind::kHandCircumference}, girth * mean.hand_circumference}})
          .hand);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fputs("usage: study_benchmark HAND_ASSET (right.glb of the generic hand) [MESH]\n",
               stderr);
    return 2;
  }
  set_thread_count(1);
  const auto base =
      std::make_shared<const hand::Hand>(hand::build_template(records::read_hand_asset(argv[1])));
  const hand::HandDimensions mean = hand::measure_hand(*base);
  std::vector<product::Product> products = {cylinder(35.0), prism(3.0), prism(10.0)};
  products.push_back(
      argc > 2 ? records::load_product(argv[2], {.unit = geometry::LengthUnit::kMillimetre})
               : cylinder(50.0));
  std::printf("%-66s %9s %-3s %9s %6s\n", "one thread", "ours", "", "asked", "ratio");

  std::optional<contact::HandFamily> family;
  row("family of hands, once", seconds_of([&] { family.emplace(base); }), "s");
  std::vector<double> made, full, quick;
  for (int k = 0; k < 5; ++k) {
    std::shared_ptr<const hand::Hand> hand;
    made.push_back(seconds_of([&] { hand = hand_number(k, *base, mean); }));
    full.push_back(seconds_of([&] { contact::PreparedHand prepared(hand); }));
    quick.push_back(seconds_of([&] { contact::PreparedHand prepared(hand, *family); }));
  }
  row("a hand from its dimensions", median(made), "s");
  row("prepared in full", median(full), "s");
  row("prepared as one of its family", median(quick), "s", 0.12);

  std::vector<grasp::GraspPlace> places;
  for (const product::Product& product : products) {
    row("place on " + product.name + ", once",
        seconds_of([&] { places.emplace_back(*base, product); }), "s");
  }
  for (std::size_t p = 0; p < products.size(); ++p) {
    std::vector<double> search, hold, rest, judge;
    for (int k = 0; k < 5; ++k) {
      const auto hand = hand_number(k, *base, mean);
      const contact::PreparedHand prepared(hand, *family);
      const grasp::GraspingHand grasping(hand);
      grasp::Grasp grasp;
      search.push_back(seconds_of([&] { grasp = grasp::find_grasp(*hand, products[p]); }));
      hold.push_back(seconds_of([&] { grasp = places[p].hold(grasping); }));
      grasp::Balance balance;
      rest.push_back(seconds_of([&] {
        balance = grasp::balance_grasp(prepared, products[p], grasp, study_options().balance);
      }));
      judge.push_back(seconds_of([&] { judge_grasp(prepared, products[p], grasp, balance); }));
    }
    const std::string& name = products[p].name;
    row(name + ": searched again", median(search), "s");
    row(name + ": held at the kept place", median(hold), "s", 0.05);
    row(name + ": comes to rest", median(rest), "s", 0.06);
    row(name + ": evaluated with all indices, mapped", median(judge), "s", 0.03);
  }

  const auto study = [&] {
    parallel_for(kHands, [&](int k) {
      run_isolated([&] {
        const auto hand = hand_number(k, *base, mean);
        const contact::PreparedHand prepared(hand, *family);
        const grasp::GraspingHand grasping(hand);
        for (std::size_t p = 0; p < products.size(); ++p) {
          grasp::Grasp grasp = places[p].hold(grasping);
          const grasp::Balance balance =
              grasp::balance_grasp(prepared, products[p], grasp, study_options().balance);
          judge_grasp(prepared, products[p], grasp, balance);
        }
      });
    });
  };
  const double before = processor_seconds();
  const double alone = seconds_of(study);
  row("30 hands x 4 products", alone, "s");
  row("the same, processor time per grasp, preparing included (asked: 0.18)",
      (processor_seconds() - before) / static_cast<double>(kHands * products.size()), "s", 0.18);
  set_thread_count(2);
  const double together = seconds_of(study);
  row("30 hands x 4 products, two threads", together, "s", 20.0);
  row("gain of the second thread (asked: at least)", alone / together, "", 1.85);
  set_thread_count(4);
  row("30 hands x 4 products, four threads", seconds_of(study), "s");
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  row("memory at most", static_cast<double>(usage.ru_maxrss) / 1024.0, "MB", 600.0);
  return 0;
}
