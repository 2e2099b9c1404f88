// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_page.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/records/json_values.h"
#include "palmar/report/chart/study_charts.h"
#include "palmar/report/page/desk_json.h"
#include "palmar/report/study/face_words.h"
#include "palmar/report/words/html_text.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"
#include "palmar/study/statistics/study_holds.h"

namespace palmar::report {
namespace {

constexpr std::size_t kMostDrawnConditions = 4;  // the page stays small; files hold all
constexpr std::size_t kMostFaces = 12;           // in the page; faces.csv holds all

std::size_t page_index(int i) { return static_cast<std::size_t>(i); }

PageJson proportion_json(const statistics::Proportion& one) {
  return {{"count", one.count},
          {"n", one.n},
          {"share", records::finite_or_null(one.share)},
          {"low", records::finite_or_null(one.interval.low)},
          {"high", records::finite_or_null(one.interval.high)}};
}

PageJson estimate_json(double value, const statistics::Interval& interval) {
  return {{"value", records::finite_or_null(value)},
          {"low", records::finite_or_null(interval.low)},
          {"high", records::finite_or_null(interval.high)}};
}

PageJson quantity_json(const study::StudyQuantity& one) {
  return {{"key", one.key}, {"name", one.name}, {"unit", one.unit}};
}

PageJson summaries_json(const study::ProductStatistics& one) {
  PageJson all = PageJson::object();
  for (const study::QuantitySummary& summary : one.quantities) {
    const bool has_ends = has_percentiles(summary);
    all[summary.quantity.key] = {
        {"n", summary.summary.n},
        {"mean", records::finite_or_null(summary.summary.mean)},
        {"sd", records::finite_or_null(summary.summary.sd)},
        {"median", records::finite_or_null(summary.summary.median)},
        {"p5", has_ends ? records::finite_or_null(summary.p5) : PageJson(nullptr)},
        {"p95", has_ends ? records::finite_or_null(summary.p95) : PageJson(nullptr)}};
  }
  return all;
}

PageJson regions_json(const study::ProductStatistics& one) {
  PageJson all = PageJson::object();
  for (const study::RegionSummary& region : one.regions) {
    all[std::string(name_of(region.region))] = {
        {"force_n", region.force},
        {"area_mm2", region.area},
        {"peak_pressure_cells_mpa", region.peak_pressure_cells},
        {"touching", region.touching}};
  }
  return all;
}

PageJson accommodation_json(const study::Accommodation& one) {
  PageJson causes = PageJson::array();
  for (const study::OutsideCause& cause : one.causes) {
    causes.push_back({{"words", cause_words(cause.cause)}, {"hands", cause.hands}});
  }
  return {{"in_hand", proportion_json(one.in_hand)},
          {"inside", proportion_json(one.inside)},
          {"outside_because_of", std::move(causes)},
          {"not_run", one.not_run},
          {"shortest_outside_mm", records::or_null(one.shortest_outside)},
          {"longest_outside_mm", records::or_null(one.longest_outside)}};
}

PageJson exclusion_json(const study::Exclusion& one) {
  PageJson causes = PageJson::array();
  for (const auto& [cause, share] : one.causes) {
    if (cause == study::ExclusionCause::kNone || share.count == 0) continue;
    causes.push_back({{"words", words_of(cause)}, {"hands", share.count}});
  }
  return {{"excluded", proportion_json(one.excluded)},
          {"because_of", std::move(causes)},
          {"unknown", one.unknown}};
}

PageJson holds_json(const study::StudyResults& results, const study::ConditionAnalysis& one,
                    int product) {
  PageJson list = PageJson::array();
  for (const study::HandsByHold& held : study::holds_of(results, one.condition, product)) {
    const grasp::Hold* hold = held.hold ? &held.hold->hold : nullptr;
    list.push_back({{"hands", held.hands},
                    {"words", hold ? PageJson(held.hold->words) : PageJson(nullptr)},
                    {"part", hold ? PageJson(hold->part) : PageJson(nullptr)},
                    {"part_name", hold ? hold->part_name : ""},
                    {"along", hold ? PageJson(hold->along) : PageJson(nullptr)}});
  }
  return list;
}

PageJson products_json(const study::StudyResults& results, const study::ConditionAnalysis& one) {
  PageJson list = PageJson::array();
  for (std::size_t p = 0; p < one.products.size(); ++p) {
    const study::ProductStatistics& product = one.products[p];
    list.push_back({{"hands", product.outcomes.hands()},
                    {"hands_holding", product.outcomes.in_hand()},
                    {"holds", holds_json(results, one, product.product)},
                    {"quantities", summaries_json(product)},
                    {"regions", regions_json(product)},
                    {"accommodation", accommodation_json(one.accommodation[p])},
                    {"exclusion", exclusion_json(one.exclusion[p])}});
  }
  return list;
}

PageJson pair_json(const study::StudyPlan& plan, const study::ProductPair& pair) {
  return {{"first", pair.first},
          {"second", pair.second},
          {"hands", pair.hands},
          {"pairs", pair.pairs},
          {"lower_in_second", pair.lower_in_second},
          {"left_out_words", left_out_words(plan, pair)},
          {"difference", estimate_json(pair.t_test.difference, pair.t_test.interval)},
          {"effect_size", estimate_json(pair.t_test.effect_size, pair.t_test.effect_interval)},
          {"t_p_holm", records::finite_or_null(pair.t_p_holm)},
          {"wilcoxon_p_holm", records::finite_or_null(pair.wilcoxon_p_holm)},
          {"verdict", name_of(pair.verdict)}};
}

PageJson comparisons_json(const study::StudyPlan& plan, const study::ConditionAnalysis& one) {
  PageJson list = PageJson::array();
  if (plan.products.size() < 2) return list;
  for (const std::string& key : main_quantities()) {
    const study::QuantityComparison* comparison = study::comparison_of(one, key);
    if (comparison == nullptr) continue;
    PageJson pairs = PageJson::array();
    for (const study::ProductPair& pair : comparison->pairs) pairs.push_back(pair_json(plan, pair));
    list.push_back(
        {{"quantity", quantity_json(comparison->quantity)}, {"pairs", std::move(pairs)}});
  }
  return list;
}

PageJson sizes_json(const study::ConditionAnalysis& one) {
  PageJson list = PageJson::array();
  for (const study::ProductSizes& family : one.sizes) {
    PageJson choices = PageJson::array();
    for (const study::SizeChoice& choice : family.choices) {
      PageJson sizes = PageJson::array();
      for (const study::ServedBySize& size : choice.sizes) {
        sizes.push_back({{"product", size.product},
                         {"inside", size.inside},
                         {"alone", size.alone},
                         {"is_taken", size.is_taken},
                         {"from_mm", records::or_null(size.from)},
                         {"to_mm", records::or_null(size.to)}});
      }
      choices.push_back({{"sizes", std::move(sizes)},
                         {"served", proportion_json(choice.served)},
                         {"served_by_length", proportion_json(choice.served_by_length)}});
    }
    list.push_back(
        {{"family", family.family}, {"hands", family.hands}, {"choices", std::move(choices)}});
  }
  return list;
}

PageJson dependence_json(const StudyPage& page, const study::ConditionAnalysis& one) {
  PageJson list = PageJson::array();
  for (const std::string& key : main_quantities()) {
    const study::QuantityComparison* comparison = study::comparison_of(one, key);
    if (comparison == nullptr) continue;
    for (std::size_t p = 0; p < page.results.plan.products.size(); ++p) {
      for (const hand::HandDimension dimension : {study::kHandLength, study::kHandCircumference}) {
        const auto found = study::size_dependence(page.results, one.condition, static_cast<int>(p),
                                                  key, dimension);
        if (!found) continue;
        const statistics::Coefficient& slope = found->fit.slopes.front();
        list.push_back({{"quantity", quantity_json(comparison->quantity)},
                        {"product", p},
                        {"size", dimension == study::kHandLength ? "length" : "circumference"},
                        {"slope_per_mm", records::finite_or_null(slope.estimate)},
                        {"r2", records::finite_or_null(found->fit.r2)},
                        {"rank_correlation", records::finite_or_null(found->rank_correlation)},
                        {"p_value", records::finite_or_null(slope.p_value)},
                        {"hands", found->fit.n}});
      }
    }
  }
  return list;
}

/// Those with the product's peak in most hands first; among equals the higher peak.
std::vector<study::FaceSummary> by_peak(std::vector<study::FaceSummary> faces) {
  std::stable_sort(faces.begin(), faces.end(),
                   [](const study::FaceSummary& a, const study::FaceSummary& b) {
                     if (a.has_peak.count != b.has_peak.count)
                       return a.has_peak.count > b.has_peak.count;
                     return a.peak.mean > b.peak.mean;
                   });
  return faces;
}

PageJson faces_json(const StudyPage& page, const study::StudyCondition& condition) {
  PageJson list = PageJson::array();
  for (const study::FaceStatistics& one : page.faces) {
    if (!study::is_same(one.condition, condition) || one.faces.empty()) continue;
    const product::Product& product = page.products[page_index(one.product)];
    PageJson faces = PageJson::array();
    for (const study::FaceSummary& summary : by_peak(one.faces)) {
      if (faces.size() == kMostFaces) break;
      const product::ProductFace& face = product.faces->face[page_index(summary.face)];
      faces.push_back({{"title", title_of(face)},
                       {"part", face.part},
                       {"has_peak", proportion_json(summary.has_peak)},
                       {"touched", proportion_json(summary.touched)},
                       {"above", proportion_json(summary.above)},
                       {"touching", summary.peak.n},
                       {"peak_mean_mpa", records::finite_or_null(summary.peak.mean)},
                       {"peak_sd_mpa", records::finite_or_null(summary.peak.sd)},
                       {"peak_p95_mpa", records::finite_or_null(summary.peak_p95)},
                       {"peak_max_mpa", records::finite_or_null(summary.peak.max)},
                       {"force_share", records::finite_or_null(summary.force_share)}});
    }
    list.push_back({{"product", one.product},
                    {"words", face_words(page.results.plan, product, one)},
                    {"hands", one.hands},
                    {"faces_touched", one.faces.size()},
                    {"faces_in_all", product.faces->face.size()},
                    {"faces", std::move(faces)}});
  }
  return list;
}

PageJson condition_json(const StudyPage& page, std::size_t index, Attachments& attachments) {
  const study::StudyPlan& plan = page.results.plan;
  const study::ConditionAnalysis& one = page.analysis.conditions[index];
  PageJson figures = PageJson::array();
  for (const StudyFigure& figure : page.figures) {
    if (figure.condition != static_cast<int>(index) || index >= kMostDrawnConditions) continue;
    figures.push_back(
        {{"description", figure.description},
         {"svg", attached(attachments,
                          "figure-" + std::to_string(index) + "-" + std::to_string(figures.size()),
                          to_svg(figure.figure))}});
  }
  return {{"title", title_of(plan, one.condition)},
          {"words", condition_words(plan, one.condition)},
          {"are_figures_shown", index < kMostDrawnConditions},
          {"figures", std::move(figures)},
          {"products", products_json(page.results, one)},
          {"comparisons", comparisons_json(plan, one)},
          {"sizes", sizes_json(one)},
          {"dependence", dependence_json(page, one)},
          {"faces", faces_json(page, one.condition)},
          {"has_nails", plan.profiles[page_index(one.condition.profile)].nail_length > 0.0}};
}

PageJson scene_json(const StudyPage& page, Attachments& attachments) {
  if (page.scene.empty()) return nullptr;
  const study::StudyPlan& plan = page.results.plan;
  const study::StudyCondition& first = page.analysis.conditions.front().condition;
  PageJson hands = PageJson::array();
  for (const int hand : page.shown_hands) hands.push_back(hand_words(plan, first, hand));
  return {{"hands", std::move(hands)},
          {"hands_in_all", study::hands_of(plan, first).size()},
          {"has_faces", !page.faces.empty()},
          {"scales",
           {{"grasp", colour_bar_json(page.scales.grasp)},
            {"mean", colour_bar_json(page.scales.mean)},
            {"sd", colour_bar_json(page.scales.sd)},
            {"above", colour_bar_json(page.scales.above)}}},
          {"data", attached(attachments, "scene", script_escaped(page.scene))}};
}

PageJson populations_json(const study::StudyPlan& plan) {
  PageJson list = PageJson::array();
  for (std::size_t p = 0; p < plan.populations.size(); ++p) {
    const study::StudyPopulation& one = plan.populations[p];
    const auto hands = std::count_if(
        plan.hands.begin(), plan.hands.end(),
        [&](const study::StudyHand& hand) { return hand.population == static_cast<int>(p); });
    list.push_back({{"name", one.population.name},
                    {"title", one.population.title},
                    {"hands", hands},
                    {"design", name_of(one.sampling.design)},
                    {"boundary_share", one.sampling.boundary},
                    {"seed", one.sampling.seed},
                    {"source", one.population.source},
                    {"cautions", one.population.cautions}});
  }
  return list;
}

PageJson settings_json(const study::StudyPlan& plan) {
  PageJson list = PageJson::array();
  for (const study::StudySetting& one : plan.settings) {
    list.push_back({{"name", one.name},
                    {"palm_limit_depth_mm", one.palm_limit_depth},
                    {"finger_limit_depth_mm", one.finger_limit_depth},
                    {"grip_force_words", grip_force_words(one)},
                    {"is_balanced", one.is_balanced},
                    {"friction", one.friction},
                    {"is_place_per_hand", one.is_place_per_hand},
                    {"contact_model", name_of(one.model)}});
  }
  return list;
}

PageJson profiles_json(const study::StudyPlan& plan) {
  PageJson list = PageJson::array();
  for (const population::HandProfile& one : plan.profiles) {
    if (one.name == "none") continue;
    list.push_back({{"name", one.name},
                    {"range_share", one.range_share},
                    {"strength_share", one.strength_share},
                    {"glove_thickness_mm", one.glove_thickness},
                    {"nail_length_mm", one.nail_length},
                    {"size_factor", one.size_factor},
                    {"source", one.source}});
  }
  return list;
}

PageJson provenance_json(const StudyPage& page) {
  const study::StudyPlan& plan = page.results.plan;
  PageJson products = PageJson::array();
  for (const study::StudyProduct& one : plan.products) {
    products.push_back({{"name", one.name},
                        {"file", one.file},
                        {"size", one.size},
                        {"mass_kg", one.mass},
                        {"posture_of", one.posture_of},
                        {"sha256", one.content_hash}});
  }
  PageJson grips = PageJson::array();
  for (const std::optional<grasp::Grip>& grip : plan.grips) {
    grips.push_back(grip ? PageJson(name_of(*grip)) : PageJson(nullptr));
  }
  PageJson stiffness = PageJson::array();
  for (const hand::Region region : {hand::Region::kIndexDistal, hand::Region::kThenar}) {
    const auto& nominal =
        page.base.tissue.region[page_index(static_cast<int>(region))].half_space.nominal;
    stiffness.push_back({{"region", plain_words(region)},
                         {"at_touch_mpa", nominal.g0},
                         {"at_limit_mpa", nominal.g_limit},
                         {"limit_depth_mm", nominal.limit_depth}});
  }
  const hand::Hand& hand = page.base;
  return {{"study", plan.name},
          {"seed", plan.seed},
          {"sha256", page.digest},
          {"program", page.program},
          {"populations", populations_json(plan)},
          {"products", std::move(products)},
          {"grips", std::move(grips)},
          {"settings", settings_json(plan)},
          {"has_several_profiles", plan.profiles.size() > 1},
          {"profiles", profiles_json(plan)},
          {"hand",
           {{"name", hand.name},
            {"side", name_of(hand.side)},
            {"hand_length_mm", hand.dimensions.hand_length},
            {"hand_circumference_mm", hand.dimensions.hand_circumference},
            {"sha256", plan.hand_hash},
            {"provenance", hand.provenance}}},
          {"stiffness", std::move(stiffness)}};
}

PageJson verdict_json(const StudyPage& page) {
  PageJson sentences = study_verdict(page.results, page.analysis);
  for (std::string& sentence : face_sentences(page.results.plan, page.products, page.faces,
                                              page.analysis.conditions.front().condition)) {
    sentences.push_back(std::move(sentence));
  }
  return sentences;
}

PageJson answer_json(const StudyAnswer& answer) {
  return {{"tone", answer.tone},
          {"sentence", answer.sentence},
          {"reasons", answer.reasons},
          {"next", answer.next},
          {"command", answer.command},
          {"better", records::or_null(answer.better)},
          {"worse", records::or_null(answer.worse)},
          {"changes", answer.changes}};
}

PageJson warnings_json(const std::vector<study::StudyWarning>& warnings) {
  PageJson list = PageJson::array();
  for (const study::StudyWarning& one : warnings) {
    list.push_back({{"is_outside", one.is_outside}, {"subject", one.subject}, {"text", one.text}});
  }
  return list;
}

}  // namespace

std::string study_page(const StudyPage& page) {
  const study::StudyPlan& plan = page.results.plan;
  if (page.analysis.conditions.empty() || plan.products.empty()) {
    throw UsageError("study report: the plan has no condition or no product");
  }
  Attachments attachments;
  PageJson products = PageJson::array();
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    const std::string name = "product-" + std::to_string(p);
    products.push_back(
        {{"name", plan.products[p].name},
         {"colour", hex_colour(product_colour(static_cast<int>(p)))},
         {"pictures",
          pictures_json(p < page.pictures.size() ? page.pictures[p] : std::vector<EncodedPicture>{},
                        name, attachments)}});
  }
  PageJson quantities = PageJson::array();
  for (const study::StudyQuantity& one : page.analysis.quantities) {
    quantities.push_back(quantity_json(one));
  }
  PageJson limits = PageJson::array();
  for (const study::StudyLimit& limit : plan.limits)
    limits.push_back(words_of(page.results, limit));
  PageJson conditions = PageJson::array();
  for (std::size_t c = 0; c < page.analysis.conditions.size(); ++c) {
    conditions.push_back(condition_json(page, c, attachments));
  }
  PageJson json = {{"kind", "study"},
                   {"maker", maker_json()},
                   {"title", plan.title.empty() ? plan.name : plan.title},
                   {"hands", plan.hands.size()},
                   {"grasps", page.results.records.size()},
                   {"grasps_planned", study::task_count(plan)},
                   {"vocabulary", vocabulary_json(page.base)},
                   {"products", std::move(products)},
                   {"language", name_of(page.language)},
                   {"desk", desk_json(page.extras, attachments)},
                   {"answer", answer_json(page.answer)},
                   {"verdict", verdict_json(page)},
                   {"warnings", warnings_json(page.warnings)},
                   {"limits", std::move(limits)},
                   {"threshold_mpa", page.threshold},
                   {"main_quantities", main_quantities()},
                   {"quantities", std::move(quantities)},
                   {"conditions", std::move(conditions)},
                   {"scene", scene_json(page, attachments)},
                   {"provenance", provenance_json(page)}};
  // What scripts read stays as it is; what people read is in their language.
  attachments["data"] = script_escaped(page_text(json));
  put_in_language(json, Phrases(page.language));
  return render_page(page_text(json), std::move(attachments));
}

}  // namespace palmar::report
