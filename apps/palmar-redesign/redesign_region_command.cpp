// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "palmar/core/error.h"
#include "redesign_arguments.h"
#include "redesign_text.h"

namespace palmar::cli {
namespace {

std::string words_of_share(double share) {
  return share == 0.0 ? "any" : fmt::format("{:g}", share);
}

struct RegionArguments {
  RedesignArguments redesign;
  workflow::RedesignRegionRequest request;
  std::string share = words_of_share(workflow::RedesignRegionRequest{}.region.share);
  std::string relief_share = words_of_share(workflow::RedesignRegionRequest{}.relief_share);
  bool no_relief = false;
  bool no_pictures = false;
  double threshold_kpa = 1000.0 * workflow::RedesignRegionRequest{}.threshold;
  bool no_compare = false;
};

/// "any" or a share.
double share_from(const std::string& option, const std::string& text) {
  if (text == "any") return 0.0;
  if (text == "half") return 0.5;
  const std::vector<double> numbers = workflow::parse_list(option, text);
  if (numbers.size() == 1 && numbers.front() >= 0.0 && numbers.front() <= 1.0) {
    return numbers.front();
  }
  throw UsageError(option + " is \"" + text + "\"; any, half, or a share of the hands from 0 to 1");
}

int run_region(const RegionArguments& a, const Context& context) {
  workflow::RedesignRegionRequest request = a.request;
  request.threshold = a.threshold_kpa / 1000.0;
  request.region.share = share_from("--hands-share", a.share);
  request.relief_share = share_from("--relief-share", a.relief_share);
  request.redesign = a.redesign.read(context);
  request.relieves = !a.no_relief;
  request.draws = !a.no_pictures;
  request.compares = !a.no_compare;
  request.on_region = [&context](const workflow::RedesignRegionOutcome& outcome) {
    finish_progress();
    if (!context.common.json) print(region_text(outcome));
  };
  const workflow::RedesignRegionOutcome outcome =
      workflow::redesign_region(request, make_progress(context.common));
  print_redesign(outcome, context);
  return 0;
}

}  // namespace

void add_redesign_region_command(CLI::App& noun, Context& context) {
  const auto a = std::make_shared<RegionArguments>();
  CLI::App* verb = add_verb(
      noun, "region",
      "Export where hands touch for CAD: faces, outlines, simple surfaces; and round the ridges",
      "palmar redesign region handle.step --hands 30 --hands-share half --largest-depth-mm 4 --out "
      "region");
  a->redesign.add_to(*verb);
  verb->add_option("--hands-share", a->share,
                   "Share of the hands that must touch: any, half, or 0 to 1")
      ->capture_default_str();
  verb->add_option("--threshold-kpa", a->threshold_kpa,
                   "Pressure above which a hand counts as touching, kPa")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--smoothing-mm", a->request.region.smoothing, "Smoothing of the outlines, mm")
      ->capture_default_str();
  verb->add_option("--smallest-area-mm2", a->request.region.smallest_area,
                   "Smaller patches and holes are dropped, mm2")
      ->capture_default_str();
  verb->add_option("--pressed-share", a->request.pressed_share,
                   "Share of the mean imprint by which the surface is moved inwards before simple "
                   "surfaces are fitted to it")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_flag("--no-relief", a->no_relief, "Only export the region; no redesign");
  verb->add_option("--relief-share", a->relief_share,
                   "Ridges are rounded over the length that this share of the hands touches: any, "
                   "half, or 0 to 1")
      ->capture_default_str();
  verb->add_option("--fit-share", a->request.relief.share,
                   "Share of the mean imprint that a rounding is fitted to")
      ->capture_default_str();
  verb->add_option("--largest-depth-mm", a->request.relief.largest_depth,
                   "Largest depth by which a ridge may go back, mm")
      ->capture_default_str();
  verb->add_option("--smallest-radius-mm", a->request.relief.smallest_radius,
                   "Radius of the cutter: ridges get no smaller one, mm")
      ->capture_default_str();
  verb->add_option("--run-out-mm", a->request.relief.run_out,
                   "Radius of the arc along which the cutter leaves the product, mm")
      ->capture_default_str();
  verb->add_option("--junction-radius-mm", a->request.junction_radius,
                   "Rounds the edges in which the cutter leaves; 0: left as they are")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  verb->add_flag("--no-pictures", a->no_pictures, "Leave out the pictures");
  verb->add_flag("--no-compare", a->no_compare, "Only make the shape, without a comparison");
  verb->callback(
      [a, &context] { context.run = [a, &context] { return run_region(*a, context); }; });
}

}  // namespace palmar::cli
