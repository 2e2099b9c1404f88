// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// How does the template hand hold a cylinder of 35 mm? A program of somebody else's, on the
// library.
#include <cstdio>
#include <exception>
#include <string>

#include "palmar/grasp/grip.h"
#include "palmar/product/primitives.h"
#include "palmar/workflow/assess.h"

int main() {
  try {
    palmar::workflow::AssessRequest request;
    request.products = {
        palmar::product::make_cylinder_product({.diameter = 35.0, .length = 130.0})};
    request.hand.name = PALMAR_TEMPLATE;
    const palmar::workflow::AssessOutcome outcome = palmar::workflow::assess_products(request);
    const palmar::study::Assessment& found = outcome.set.assessments.front().assessment;
    std::printf("%s, %.1f N on %.0f mm2, peak %.4f MPa\n",
                std::string(name_of(found.grasp.grip)).c_str(), found.contact.total.force,
                found.contact.total.area, found.contact.total.peak_pressure);
    for (const palmar::contact::RegionContact& region : found.contact.regions) {
      std::printf("  %-18s %6.2f N %7.1f mm2\n", std::string(name_of(region.region)).c_str(),
                  region.force, region.area);
    }
    return outcome.has_converged ? 0 : 4;
  } catch (const std::exception& error) {  // each names the value and what is allowed
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
