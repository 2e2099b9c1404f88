// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_answer.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/text.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/report/study/study_options.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"
#include "palmar/report/words/texts.h"
#include "palmar/report/words/verdict_words.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::report {
namespace {

constexpr const char* kPeak = "peak_pressure_cells_mpa";
constexpr const char* kArea = "contact_area_mm2";
constexpr double kReachedByMost = 0.9;  // of the mean grip force of the weaker hold: our choice
constexpr int kHandsOfRedesign = 12;
constexpr int kFewHands = 3;    // that are named one by one: our choice
constexpr int kManyHands = 30;  // of a study that is to decide; as in Xie 2014, chapter 5

study::StudyQuantity hand_quantity(const std::string& key) {
  for (const study::StudyQuantity& one : study::hand_quantities()) {
    if (one.key == key) return one;
  }
  return {.key = key, .name = key, .unit = ""};
}

class StudySpeaker {
 public:
  StudySpeaker(const study::StudyResults& results, const StudyAnswerOptions& options)
      : results_(results),
        options_(options),
        texts_(options.language),
        phrases_(options.language),
        condition_(study::conditions_of(results.plan).front()) {}

  StudyAnswer speak() {
    const study::StudyPlan& plan = results_.plan;
    for (int p = 0; p < static_cast<int>(plan.products.size()); ++p) {
      statistics_.push_back(
          study::product_statistics(results_, {hand_quantity(kPeak)}, condition_, p));
    }
    if (plan.products.size() == 1) {
      speak_of_one();
    } else {
      speak_of_pair();
    }
    const auto count = study::conditions_of(plan).size();
    if (count > 1) {
      answer_.reasons.push_back(texts_(
          "study.conditions",
          {{"condition", condition_words(plan, condition_)}, {"count", std::to_string(count)}}));
    }
    return std::move(answer_);
  }

 private:
  const std::string& name(int p) const { return results_.plan.products[as_index(p)].name; }
  static std::size_t as_index(int i) { return static_cast<std::size_t>(i); }

  std::optional<double> mean_peak(int p) const {
    const study::QuantitySummary* one = study::summary_of(statistics_[as_index(p)], kPeak);
    return one != nullptr ? std::optional(one->summary.mean) : std::nullopt;
  }

  void next(const std::string& key, const std::string& command) {
    if (command.empty()) return;
    answer_.next = texts_("next." + key);
    answer_.command = command;
  }

  void run_again(const std::string& key, int hands, const std::string& added) {
    const std::string line = product_options(results_.plan);
    if (line.empty() || results_.plan.populations.size() != 1) {
      look_at_report();
      return;
    }
    next(key, "palmar study run " + line + mass_option(results_.plan) + population() + " --hands " +
                  std::to_string(hands) + added + " --out again.palmar");
  }
  std::string population() const {
    const std::string& name = results_.plan.populations.front().population.name;
    return name == "xie2014" ? "" : " --population " + shell_word(name);
  }
  void look_at_report() {
    if (options_.store.empty()) return;
    next("report", "palmar study report " + shell_word(options_.store) + " --out report");
  }

  void redesign(int p) {
    const study::StudyProduct& product = results_.plan.products[as_index(p)];
    if (!is_plain_product(product)) {
      look_at_report();
      return;
    }
    const bool is_one = results_.plan.populations.size() == 1;
    next("redesign", "palmar redesign press " + shell_word(product.file) +
                         (is_mesh_file(product) ? " --unit " + product.unit : "") +
                         (is_one ? population() : "") + " --hands " +
                         std::to_string(kHandsOfRedesign) + " --out pressed");
  }

  void add_hardest_region(int p) {
    const study::ProductStatistics& one = statistics_[as_index(p)];
    const auto worst =
        std::max_element(one.regions.begin(), one.regions.end(),
                         [](const study::RegionSummary& a, const study::RegionSummary& b) {
                           return a.peak_pressure_cells < b.peak_pressure_cells;
                         });
    if (worst == one.regions.end()) return;
    answer_.reasons.push_back(
        texts_("study.region", {{"product", name(p)},
                                {"at", texts_("region_at." + std::string(name_of(worst->region)))},
                                {"pressure", texts_.number(worst->peak_pressure_cells, 2)}}));
  }

  /// In how many hands that hold product `p` the pressure is above the onsets, in one sentence.
  /// How many find it uncomfortable; nothing if the study has no such indices.
  std::optional<int> add_comfort(int p, bool is_named) {
    int hands = 0, pain = 0, discomfort = 0;
    double no_blood = 0.0;
    for (const int hand : study::hands_of(results_.plan, condition_)) {
      const study::StudyRecord* record = study::record_of(results_, condition_, p, hand);
      if (record == nullptr || !study::is_in_hand(*record)) continue;
      const auto at_pain = index_value(*record, "pain_onset_percent");
      const auto at_discomfort = index_value(*record, "discomfort_onset_percent");
      const auto skin = index_value(*record, "skin_above_50_kpa_percent");
      if (!at_pain || !at_discomfort || !skin) continue;
      ++hands;
      pain += *at_pain >= 100.0 ? 1 : 0;
      discomfort += *at_discomfort >= 100.0 ? 1 : 0;
      no_blood += *skin / 100.0;
    }
    if (hands == 0) return std::nullopt;
    const auto of_hands = [&](int count) {
      if (hands == 1) return texts_(count == 0 ? "study.of_one_hand.none" : "study.of_one_hand");
      const char* key = count == 0 ? "study.of_hands.none" : "study.of_hands";
      return texts_(key, {{"count", std::to_string(count)}, {"hands", std::to_string(hands)}});
    };
    const std::string words =
        texts_("study.comfort", {{"pain", of_hands(pain)},
                                 {"discomfort", of_hands(discomfort)},
                                 {"percent", texts_.percent(no_blood / hands)}});
    answer_.reasons.push_back(is_named ? name(p) + ": " + words : capitalised(words));
    return discomfort;
  }
  static std::optional<double> index_value(const study::StudyRecord& record, std::string_view key) {
    for (const study::IndexRecord& one : record.indices) {
      if (one.key == key) return one.value;
    }
    return std::nullopt;
  }

  /// "Hand 1, P5 woman, doesn't hold mug: slips out." for the few that don't.
  void add_who_does_not(int p) {
    for (const int hand : study::hands_of(results_.plan, condition_)) {
      const study::StudyRecord* record = study::record_of(results_, condition_, p, hand);
      if (record == nullptr || study::is_in_hand(*record)) continue;
      answer_.reasons.push_back(texts_(
          "study.not_held_by", {{"hand", phrases_(hand_words(results_.plan, condition_, hand))},
                                {"product", name(p)},
                                {"why", phrases_(plain_words(record->outcome))}}));
    }
  }

  /// Products that not every hand holds.
  void add_missing() {
    for (int p = 0; p < static_cast<int>(statistics_.size()); ++p) {
      const study::OutcomeCounts& outcomes = statistics_[as_index(p)].outcomes;
      if (outcomes.in_hand() == outcomes.hands()) continue;
      if (outcomes.hands() - outcomes.in_hand() <= kFewHands) {
        add_who_does_not(p);
        continue;
      }
      answer_.reasons.push_back(
          texts_("study.suits", {{"product", name(p)},
                                 {"count", std::to_string(outcomes.in_hand())},
                                 {"hands", std::to_string(outcomes.hands())}}));
    }
  }

  void speak_of_one() {
    const study::ProductStatistics& one = statistics_.front();
    const study::QuantitySummary* peak = study::summary_of(one, kPeak);
    if (peak == nullptr) {
      answer_.tone = "bad";
      answer_.sentence = texts_("study.none", {{"product", name(0)}});
      return;
    }
    const bool is_held_by_all = one.outcomes.in_hand() == one.outcomes.hands();
    answer_.tone = is_held_by_all ? "good" : "fair";
    const bool has_ends = has_percentiles(*peak);
    answer_.sentence =
        texts_(one.outcomes.in_hand() == 1 ? "study.one.hand" : "study.one",
               {{"product", name(0)},
                {"count", std::to_string(one.outcomes.in_hand())},
                {"hands", std::to_string(one.outcomes.hands())},
                {"mean", texts_.number(peak->summary.mean, 2)},
                {"low", texts_.number(has_ends ? peak->p5 : peak->summary.min, 2)},
                {"high", texts_.number(has_ends ? peak->p95 : peak->summary.max, 2)}});
    if (one.outcomes.hands() - one.outcomes.in_hand() <= kFewHands) add_who_does_not(0);
    add_hardest_region(0);
    const std::optional<int> discomfort = add_comfort(0, false);
    if (!study::is_drawn_by_chance(results_.plan))
      answer_.reasons.push_back(texts_("study.chosen"));
    // Where nobody finds it uncomfortable there is nothing to press.
    if (discomfort == 0 && !study::is_drawn_by_chance(results_.plan)) {
      run_again("drawn", kManyHands, "");
    } else if (discomfort == 0) {
      look_at_report();
    } else {
      redesign(0);
    }
  }

  /// The product with the lowest mean peak and the next one; products that nobody holds last.
  std::pair<int, int> lowest_two() const {
    std::vector<int> order;
    for (int p = 0; p < static_cast<int>(statistics_.size()); ++p) order.push_back(p);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      const auto one = mean_peak(a), other = mean_peak(b);
      if (!one || !other) return one.has_value() && !other.has_value();
      return *one < *other;
    });
    return {order[0], order[1]};
  }

  /// A pair of a quantity, turned so that its second product is `better`.
  study::ProductPair pair_of(const std::string& key, int better, int worse) const {
    const study::QuantityComparison all =
        study::compare_products(results_, condition_, hand_quantity(key), options_.comparison);
    for (const study::ProductPair& pair : all.pairs) {
      if (pair.first == worse && pair.second == better) return pair;
      if (pair.first != better || pair.second != worse) continue;
      study::ProductPair turned = pair;
      std::swap(turned.first, turned.second);
      std::swap(turned.mean_first, turned.mean_second);
      turned.t_test.interval = {-pair.t_test.interval.high, -pair.t_test.interval.low};
      turned.lower_in_second = 0;
      for (double& change : turned.change) {
        if (change > 0.0) ++turned.lower_in_second;
        change = change > -1.0 ? 1.0 / (1.0 + change) - 1.0 : 0.0;
      }
      return turned;
    }
    return {};
  }

  bool is_kept_posture(int a, int b) const {
    const auto& plan = results_.plan;
    return plan.products[as_index(a)].posture_of == name(b) ||
           plan.products[as_index(b)].posture_of == name(a);
  }

  void speak_of_pair() {
    const auto [better, worse] = lowest_two();
    answer_.better = better;
    answer_.worse = worse;
    const study::ProductPair peak = pair_of(kPeak, better, worse);
    answer_.changes = peak.change;
    TextValues values = {{"better", name(better)},
                         {"worse", name(worse)},
                         {"hands", std::to_string(peak.pairs)},
                         {"agree", std::to_string(peak.lower_in_second)},
                         {"limit", texts_.percent(grasp::kToldApart)}};
    if (peak.pairs < 2) {
      answer_.sentence = texts_("study.few", values);
      add_missing();
      look_at_report();
      return;
    }
    const double change = peak.mean_second / peak.mean_first - 1.0;
    const double low = peak.t_test.interval.low / peak.mean_first;
    const double high = peak.t_test.interval.high / peak.mean_first;
    values["percent"] = texts_.percent(change);
    const study::ProductPair area = pair_of(kArea, better, worse);
    values["area"] =
        area_words(area.mean_first > 0.0 ? area.mean_second / area.mean_first - 1.0 : 0.0, texts_);
    const auto forces = study::grip_forces(results_, condition_, worse, better);
    if (forces) {
      values["grip"] = grip_words(forces->are_of_task ? std::optional(forces->first) : std::nullopt,
                                  forces->second, name(worse), name(better), texts_);
      values["better_force"] = texts_.number(forces->second, 2);
      values["worse_force"] = texts_.number(forces->first, 2);
    }
    const bool is_drawn = study::is_drawn_by_chance(results_.plan);
    const bool is_shown = is_drawn ? peak.verdict == study::DifferenceVerdict::kShown
                                   : 2 * peak.lower_in_second > peak.pairs;
    const bool is_large = std::abs(change) >= grasp::kToldApart;
    const bool is_surely_small = std::max(std::abs(low), std::abs(high)) < grasp::kToldApart;
    if (forces && forces->are_unequal()) {
      speak_of_unequal(values, *forces, is_kept_posture(better, worse) && is_shown && is_large);
    } else if (is_shown && is_large) {
      answer_.tone = "good";
      answer_.sentence = texts_(is_kept_posture(better, worse) ? "study.kept_posture"
                                : forces                       ? "study.lower"
                                                               : "study.no_force",
                                values);
      redesign(better);
    } else if (is_shown || is_surely_small) {
      say_of_best_two(texts_(forces ? "study.same" : "study.same_no_force", values), values);
      look_at_report();
    } else {
      const bool do_all_agree = peak.lower_in_second == peak.pairs;
      say_of_best_two(texts_(do_all_agree ? "study.too_few" : "study.not_shown", values), values);
      run_again("more_hands", std::max(kManyHands, 2 * peak.hands), "");
    }
    if (is_drawn && !(forces && forces->are_unequal())) {
      const auto signed_number = [&](double share) {
        return std::string(share < 0.0 ? "−" : "+") + texts_.percent(share);
      };
      answer_.reasons.push_back(
          texts_("study.interval", {{"low", signed_number(low)}, {"high", signed_number(high)}}));
    }
    add_missing();
    add_hardest_region(worse);
    add_hardest_region(better);
    add_comfort(better, true);
    if (!is_drawn) answer_.reasons.push_back(texts_("study.chosen"));
  }

  /// Whether a product is shown to press by a difference that matters more than another one, at the
  /// same grip force; in words.
  std::optional<std::string> behind(int better, int worse) const {
    const study::ProductPair peak = pair_of(kPeak, better, worse);
    const auto forces = study::grip_forces(results_, condition_, worse, better);
    if (peak.pairs < 2 || !(peak.mean_second > 0.0) || !forces || forces->are_unequal()) return {};
    const double more = peak.mean_first / peak.mean_second - 1.0;
    const bool is_shown = study::is_drawn_by_chance(results_.plan)
                              ? peak.verdict == study::DifferenceVerdict::kShown
                              : 2 * peak.lower_in_second > peak.pairs;
    if (!is_shown || more < grasp::kToldApart) return {};
    return texts_("study.behind", {{"worse", name(worse)},
                                   {"better", name(better)},
                                   {"percent", texts_.percent(more)},
                                   {"agree", std::to_string(peak.lower_in_second)},
                                   {"hands", std::to_string(peak.pairs)}});
  }

  /// The two best aren't told apart: that is the answer, unless there are others that fall behind.
  void say_of_best_two(const std::string& of_two, const TextValues& values) {
    std::string others;
    std::optional<int> farthest;
    for (int p = 0; p < static_cast<int>(statistics_.size()); ++p) {
      if (p == answer_.better || p == answer_.worse) continue;
      const auto words = behind(*answer_.better, p);
      if (!words) continue;
      others += (others.empty() ? "" : "; ") + *words;
      farthest = farthest && *mean_peak(*farthest) > *mean_peak(p) ? farthest : p;
    }
    if (!farthest) {
      answer_.sentence = of_two;
      return;
    }
    answer_.worse = farthest;  // whose changes are drawn
    answer_.changes = pair_of(kPeak, *answer_.better, *farthest).change;
    TextValues all = values;
    all["others"] = others;
    answer_.tone = "good";
    answer_.sentence = texts_("study.two_best", all);
    answer_.reasons.push_back(of_two);
  }

  void speak_of_unequal(const TextValues& values, const study::GripForces& forces, bool is_kept) {
    answer_.sentence = texts_(is_kept ? "study.kept_unequal" : "study.unequal_force", values);
    // A kept posture makes the redesign's grip weak; in a posture of its own it reaches more.
    const bool is_redesign = !options_.command.empty();
    const double reached =
        is_redesign ? std::max(forces.first, forces.second) : std::min(forces.first, forces.second);
    const double force = std::floor(kReachedByMost * reached);
    if (!(force > 0.0)) return;
    const std::string same = " --grip-force-n " + significant(force, 4);
    if (is_redesign) {
      next("equal_redesign",
           changed_command(options_.command,
                           {"--posture", "--hold-posture", "--grip-force-n", "--out"},
                           "--hold-posture new" + same + " --out equal"));
    } else {
      run_again("equal_force", statistics_.front().outcomes.hands(), same);
    }
  }

  const study::StudyResults& results_;
  const StudyAnswerOptions& options_;
  Texts texts_;
  Phrases phrases_;
  study::StudyCondition condition_;
  std::vector<study::ProductStatistics> statistics_;
  StudyAnswer answer_;
};

}  // namespace

StudyAnswer study_answer(const study::StudyResults& results, const StudyAnswerOptions& options) {
  return StudySpeaker(results, options).speak();
}

}  // namespace palmar::report
