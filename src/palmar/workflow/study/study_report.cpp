// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/records/study/study_store.h"

namespace palmar::workflow {
namespace {

study::StudyResults results_of(const records::StudyStore& store) {
  study::StudyResults results{store.plan(), {}};
  store.for_each(false,
                 [&](const study::StudyRecord& record) { results.records.push_back(record); });
  if (results.records.empty()) {
    throw UsageError(store.path().string() +
                     ": no grasp was run yet; palmar study run or resume does");
  }
  return results;
}

std::vector<study::StudyQuantity> quantities_named(const study::StudyResults& results,
                                                   const std::vector<std::string>& keys) {
  std::vector<study::StudyQuantity> quantities;
  for (const std::string& key : keys) {
    if (key == "all") return study::quantities_of(results);
    quantities.push_back(study::quantity_named(results, key));
  }
  return quantities;
}

}  // namespace

void StudyReportRequest::check() const {
  constexpr double kMostThreshold = 1e5;               // kPa
  const double threshold = 1000.0 * report.threshold;  // kPa
  if (!(threshold >= 0.0 && threshold <= kMostThreshold)) {
    throw UsageError(fmt::format("setting \"threshold\" is {:g} kPa; 0 to {:.0f} kPa are allowed",
                                 threshold, kMostThreshold));
  }
  report.check();
}

std::filesystem::path report_study(const StudyReportRequest& request, const Progress& progress) {
  request.check();
  const records::StudyStore store(request.store);
  const study::StudyResults results = results_of(store);
  const study::StudyInputs inputs = store.inputs();
  const report::StudyReportInput input{
      results, inputs,
      [&store](const std::function<void(const study::StudyRecord&)>& visit) {
        store.for_each(true, visit);
      },
      store.program(), store.digest()};
  report::write_study_report(request.folder, input, request.report, progress);
  const std::filesystem::path page = std::filesystem::path(request.folder) / "report.html";
  if (request.pdf) report::print_pdf(page, *request.pdf, progress);
  if (request.report.extras.slides) report::take_slides(page, progress);
  return page;
}

void StudyCompareRequest::check() const {
  if (quantities.empty()) throw UsageError("quantities: none is given; at least one is required");
  comparison.check();
}

StudyCompareOutcome compare_results(study::StudyResults compared_results,
                                    const std::vector<study::StudyQuantity>& quantities,
                                    const report::StudyAnswerOptions& options) {
  StudyCompareOutcome outcome{std::move(compared_results), {}, {}};
  const study::StudyResults& results = outcome.results;
  for (const study::StudyCondition& condition : study::conditions_of(results.plan)) {
    ComparedCondition compared{condition, {}};
    for (const study::StudyQuantity& quantity : quantities) {
      ComparedQuantity one{quantity, {}, {}};
      for (int p = 0; p < static_cast<int>(results.plan.products.size()); ++p) {
        one.products.push_back(study::product_statistics(results, {quantity}, condition, p));
      }
      const study::QuantityComparison comparison =
          study::compare_products(results, condition, quantity, options.comparison);
      for (const study::ProductPair& pair : comparison.pairs) {
        one.pairs.push_back(
            {pair, study::grip_forces(results, condition, pair.first, pair.second)});
      }
      compared.quantities.push_back(std::move(one));
    }
    outcome.conditions.push_back(std::move(compared));
  }
  outcome.answer = report::study_answer(results, options);
  return outcome;
}

StudyCompareOutcome compare_study(const StudyCompareRequest& request) {
  request.check();
  study::StudyResults results = results_of(records::StudyStore(request.store));
  const auto quantities = quantities_named(results, request.quantities);
  return compare_results(std::move(results), quantities,
                         {.language = request.language,
                          .comparison = request.comparison,
                          .store = request.store.string(),
                          .command = ""});
}

}  // namespace palmar::workflow
