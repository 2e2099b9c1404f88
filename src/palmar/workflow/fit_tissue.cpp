// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/fit_tissue.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/hand/tissue.h"
#include "palmar/records/measured_curves.h"
#include "palmar/records/tissue_file.h"
#include "palmar/records/tissue_fit_json.h"

namespace palmar::workflow {
namespace {

/// Regions that the fit is for: a group's, or one.
std::vector<hand::Region> regions_of(const std::string& name) {
  std::vector<hand::Region> regions;
  const auto group = hand::tissue_class_named(name);
  if (const auto region = hand::region_named(name)) regions.push_back(*region);
  if (!group && !regions.empty()) return regions;
  regions.clear();
  std::vector<std::string> known;
  for (int c = 0; c < hand::kTissueClassCount; ++c) {
    known.emplace_back(name_of(static_cast<hand::TissueClass>(c)));
  }
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const auto region = static_cast<hand::Region>(r);
    known.emplace_back(name_of(region));
    if (group && hand::tissue_class_of(region) == *group) regions.push_back(region);
  }
  if (group) return regions;
  throw UsageError("setting \"group\": \"" + name + "\" is not known; " +
                   did_you_mean(name, known, "finger, palm, dorsum or a region is allowed"));
}

/// The default set with the fitted law in it.
hand::Tissue fitted_set(const TissueFitRequest& request, const contact::TissueFit& fit,
                        const std::vector<hand::Region>& regions) {
  const std::string file = std::filesystem::path(request.curves).filename().string();
  hand::Tissue tissue = hand::default_tissue();
  tissue.source = "Palmar's own set with " +
                  std::string(request.is_layered ? "layered" : "half-space") +
                  " tissue fitted to " + file;
  for (const hand::Region region : regions) {
    hand::RegionTissue& one = tissue.region[static_cast<std::size_t>(region)];
    (request.is_layered ? one.layered : one.half_space) = fit.stiffness;
    if (const std::string fault = hand::fault_of(one); !fault.empty()) {
      throw NumericalError(file + ": the fit gives no tissue that skin can have: " + fault +
                           ". Are the units of the columns right?");
    }
    if (request.is_layered)
      one.poisson_layered = request.test.poisson.value_or(one.poisson_layered);
    one.source = fmt::format("{}: fitted to {} ({} readings, {} subjects; {}), R2 {:.4f}; rest: {}",
                             request.is_layered ? "layered" : "half-space", file, fit.points.size(),
                             std::max<std::size_t>(1, fit.subjects.size()), request.description,
                             fit.r_squared, one.source);
  }
  return tissue;
}

bool is_of_hand(const TissueFitRequest& request) {
  return request.test.specimen.kind == contact::PressSpecimen::Kind::kHandRegion;
}

std::string group_of(const TissueFitRequest& request) {
  if (!request.group.empty()) return request.group;
  if (!is_of_hand(request)) return "finger";
  return std::string(name_of(hand::tissue_class_of(request.test.specimen.region)));
}

}  // namespace

void TissueFitRequest::check() const {
  fit.check();
  regions_of(group_of(*this));
}

TissueFitOutcome fit_tissue(const TissueFitRequest& request) {
  request.check();
  const std::string group = group_of(request);
  const records::MeasuredCurves curves = records::read_measured_curves(request.curves);
  contact::PressOptions test = request.test;
  test.depths.clear();
  const double deepest = contact::deepest_press(test);
  for (const contact::MeasuredPoint& point : curves.points) {
    if (point.depth > deepest) {
      throw InputError(
          fmt::format("{}:{}: depth_mm is {}; at most {} mm is allowed with the indenter {}",
                      request.curves, point.line, point.depth, deepest, name_of(test.indenter)));
    }
    test.depths.push_back(point.depth);
  }
  for (const std::string& column : curves.ignored) {
    note_to(request.note, request.curves + ": column \"" + column + "\" is left out");
  }
  if (curves.zero_depths > 0) {
    note_to(request.note,
            fmt::format("{}: {} rows at depth 0 are left out", request.curves, curves.zero_depths));
  }
  std::optional<contact::PreparedHand> hand;
  if (is_of_hand(request)) {
    contact::ContactModel model;
    if (request.is_layered) model.tissue = contact::TissueModel::kLayered;
    hand.emplace(load_hand(request.hand), model);
  }
  std::vector<double> thickness;
  if (request.is_layer_fitted) {
    thickness =
        contact::thicknesses_to_try(*std::max_element(test.depths.begin(), test.depths.end()));
  }
  test.check();
  const contact::SpecimenResponse response =
      contact::specimen_response(test, test.depths, thickness, hand ? &*hand : nullptr);
  TissueFitOutcome outcome{fit_tissue(curves.points, response, request.fit), group};
  const contact::TissueFit& fit = outcome.fit;
  if (fit.status == geometry::LeastSquaresStatus::kIterationLimit ||
      fit.status == geometry::LeastSquaresStatus::kBadStart) {
    throw NumericalError(request.curves + ": the fit ended without converging (" +
                         std::string(records::name_of(fit.status)) + "); nothing is written");
  }
  if (!request.out.empty()) {
    records::write_tissue(request.out, fitted_set(request, fit, regions_of(group)));
  }
  return outcome;
}

}  // namespace palmar::workflow
