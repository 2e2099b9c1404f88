// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/assessment/verdict_json.h"

#include <nlohmann/json.hpp>

#include "palmar/geometry/degrees.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using VerdictJson = nlohmann::ordered_json;

VerdictJson onset_object(const std::optional<grasp::WorstRegion>& worst) {
  if (!worst) return nullptr;
  return {{"region", name_of(worst->region)},
          {"pressure_mpa", worst->pressure},
          {"onset_mpa", worst->onset},
          {"share", worst->share()},
          {"level", name_of(grasp::level_of(*worst))},
          {"regions_above", worst->above}};
}

VerdictJson comfort_object(const grasp::ComfortResult& comfort, const std::string& sentence) {
  if (!comfort.pain) return nullptr;
  return {{"sentence", sentence},
          {"moment", onset_object(comfort.pain)},
          {"repeated", onset_object(comfort.discomfort)},
          {"minutes",
           {{"limit_mpa", grasp::kBloodFlowStop},
            {"share_of_skin", comfort.sustained_share},
            {"area_mm2", comfort.sustained_area}}},
          {"regions_touched", comfort.regions.size()}};
}

VerdictJson hardest_object(const study::AssessedProduct& product, const study::HardestPlace& place,
                           const std::string& sentence) {
  const bool has_face = place.face && product.product.faces != nullptr;
  return {
      {"sentence", sentence},
      {"region", name_of(place.region)},
      {"pressure_mpa", place.pressure},
      {"on_product_mm", place.on_product ? vector3(*place.on_product) : VerdictJson(nullptr)},
      {"face", has_face ? VerdictJson(product::title_of(product.product.faces->face[*place.face]))
                        : VerdictJson(nullptr)}};
}

}  // namespace

nlohmann::ordered_json verdict_object(const study::SetVerdict& verdict, const VerdictWords& words,
                                      const std::vector<std::string>& names) {
  VerdictJson comparisons = VerdictJson::array();
  for (const study::ProductComparison& one : verdict.comparisons) {
    comparisons.push_back(
        {{"better", names.at(one.better)},
         {"worse", names.at(one.worse)},
         {"verdict", name_of(one.verdict)},
         {"peak_change", one.peak_change},
         {"area_change", one.area_change},
         {"peak_change_soft", or_null(one.peak_change_soft)},
         {"peak_change_stiff", or_null(one.peak_change_stiff)},
         {"peak_unsure", or_null(one.peak_unsure)},
         {"peak_change_second_rest", or_null(one.peak_change_second)},
         {"hand_turned_deg", one.hand_turned ? VerdictJson(*one.hand_turned / geometry::kDegree)
                                             : VerdictJson(nullptr)},
         {"hand_shifted_mm", or_null(one.hand_shifted)},
         {"held_alike", one.are_held_alike()}});
  }
  return {{"sentence", words.sentence},
          {"reasons", words.reasons},
          {"next", words.next},
          {"command", words.command},
          {"best", verdict.best ? VerdictJson(names.at(*verdict.best)) : VerdictJson(nullptr)},
          {"told_apart", grasp::kToldApart},
          {"comparisons", std::move(comparisons)}};
}

nlohmann::ordered_json verdict_object(const study::AssessedProduct& product,
                                      const study::ProductVerdict& verdict,
                                      const ProductWords& words) {
  VerdictJson strength = nullptr;
  if (verdict.strength) {
    strength = {
        {"sentence", words.strength},
        {"grip_force_n", verdict.strength->grip_force},
        {"share", or_null(verdict.strength->share)},
        {"limited_by", verdict.strength->is_judged
                           ? VerdictJson(verdict.strength->is_by_wrist ? "wrist" : "fingers")
                           : VerdictJson(nullptr)},
        {"whose", verdict.strength->whose},
        {"for_comparison",
         {{"dynamometer_n", verdict.strength->reached}, {"share", verdict.strength->compared()}}}};
  }
  return {{"held", name_of(verdict.held)},
          {"sentence", words.held},
          {"comfort", comfort_object(verdict.comfort, words.comfort)},
          {"strength", std::move(strength)},
          {"hardest", verdict.hardest ? hardest_object(product, *verdict.hardest, words.hardest)
                                      : VerdictJson(nullptr)}};
}

}  // namespace palmar::records
