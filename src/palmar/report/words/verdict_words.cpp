// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/verdict_words.h"

#include <algorithm>
#include <cmath>

#include "palmar/contact/prepared/resolution.h"
#include "palmar/core/text.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/task_force.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/study/assessment/hold_doubts.h"

namespace palmar::report {
namespace {

constexpr double kNoBlood = 0.01;    // of the touched skin; less isn't spoken of: our choice
constexpr double kSafeForce = 0.95;  // of what the weaker hold reaches: a force that it keeps
constexpr int kHandsToAsk = 12;      // enough for a sign: 6 pairs are the fewest that show anything

std::string at_words(hand::Region region, const Texts& texts) {
  return texts("region_at." + std::string(name_of(region)));
}

std::string with_capital(std::string text) { return capitalised(std::move(text)); }

/// Why a product isn't held firmly, as a clause.
std::string why_not_held(const study::Assessment& assessment, const Texts& texts) {
  std::vector<std::string> clauses;
  for (const study::HoldDoubt& doubt : study::doubts_of(assessment)) {
    clauses.push_back(
        texts("doubt." + doubt.key, {{"words", Phrases(texts.language())(doubt.words)}}));
  }
  if (clauses.empty()) {
    clauses.push_back(texts("status." + std::string(name_of(assessment.grasp.status))));
  }
  return texts.listed(clauses);
}

std::string hardest_words(const study::AssessedProduct& product, const study::HardestPlace& place,
                          const Texts& texts) {
  std::string words = texts("hardest.sentence", {{"at", at_words(place.region, texts)},
                                                 {"pressure", texts.number(place.pressure, 2)}});
  if (place.face && product.product.faces != nullptr) {
    const product::ProductFace& face = product.product.faces->face[*place.face];
    words +=
        " " + texts("hardest.face", {{"face", Phrases(texts.language())(product::title_of(face))}});
  } else if (place.on_product) {
    const Vec3& p = *place.on_product;
    words += " " + texts("hardest.place", {{"x", texts.number(std::round(p.x()), 1)},
                                           {"y", texts.number(std::round(p.y()), 1)},
                                           {"z", texts.number(std::round(p.z()), 1)}});
  }
  return words;
}

/// Whether the place that presses hardest is on edges that the skin's mesh doesn't resolve.
bool is_hardest_unresolved(const study::AssessedProduct& product,
                           const study::ProductVerdict& verdict) {
  if (!verdict.hardest || contact::is_resolved(product.assessment.contact)) return false;
  for (const contact::RegionContact& region : product.assessment.contact.regions) {
    if (region.region == verdict.hardest->region) {
      return region.unresolved_force > contact::kToldShare * region.force;
    }
  }
  return false;
}

std::string strength_words(const study::ProductVerdict& verdict, const Texts& texts) {
  std::string words;
  if (verdict.strength) {
    const study::StrengthUse& use = *verdict.strength;
    std::string whose = use.whose;
    if (whose.empty()) whose = texts("strength.nobody", {{"strength", texts.number(use.reached)}});
    if (whose == grasp::usual_people()) {
      whose = texts("strength.usual", {{"age", texts.number(grasp::kUsualAge, 2)}});
    } else {
      whose = Phrases(texts.language())(whose);
    }
    const std::string force = texts.number(use.grip_force, 2);
    if (use.share) {
      words = texts(use.is_by_wrist ? "strength.wrist" : "strength.sentence",
                    {{"force", force}, {"percent", texts.percent(*use.share)}, {"whose", whose}}) +
              " ";
    } else if (use.is_judged) {
      words = texts("strength.beyond", {{"force", force}, {"whose", whose}}) + " ";
    }
    words += texts(use.is_pinch ? "strength.pinch" : "strength.compared",
                   {{"force", force},
                    {"percent", texts.percent(use.compared())},
                    {"reached", texts.number(use.reached, 3)},
                    {"whose", whose}});
  }
  if (verdict.asked && verdict.grip_force > 0.0 &&
      !study::are_equally_firm(verdict.grip_force, *verdict.asked)) {
    words += (words.empty() ? "" : " ") +
             texts("strength.not_reached", {{"force", texts.number(verdict.grip_force, 2)},
                                            {"asked", texts.number(*verdict.asked, 2)}});
  }
  return words;
}

records::ProductWords product_words(const study::AssessedProduct& product,
                                    const study::ProductVerdict& verdict, const Texts& texts) {
  records::ProductWords words;
  words.comfort = with_capital(comfort_words(verdict.comfort, texts));
  words.strength = strength_words(verdict, texts);
  if (verdict.hardest) words.hardest = hardest_words(product, *verdict.hardest, texts);
  const std::string& name = product.product.name;
  switch (verdict.held) {
    case study::HeldVerdict::kHeld:
      if (product.assessment.grasp.grip == grasp::Grip::kFixedHook) {
        words.held = texts("verdict.one.carried",
                           {{"product", name}, {"comfort", comfort_words(verdict.comfort, texts)}});
        break;
      }
      words.held = texts("verdict.one.held", {{"product", name},
                                              {"force", texts.number(verdict.grip_force, 2)},
                                              {"comfort", comfort_words(verdict.comfort, texts)}});
      break;
    case study::HeldVerdict::kRests:
    case study::HeldVerdict::kPushes:
      words.held = texts("verdict.one." + std::string(name_of(verdict.held)),
                         {{"product", name},
                          {"force", texts.number(verdict.grip_force, 2)},
                          {"comfort", comfort_words(verdict.comfort, texts)}});
      break;
    case study::HeldVerdict::kDoubtful:
      words.held = texts("verdict.one.doubtful",
                         {{"product", name}, {"why", why_not_held(product.assessment, texts)}});
      break;
    case study::HeldVerdict::kNotHeld:
      words.held = texts("verdict.one.not_held",
                         {{"product", name}, {"why", why_not_held(product.assessment, texts)}});
      break;
  }
  return words;
}

/// Words of a command line as a shell would see them, quotes kept.
std::vector<std::string> words_of_line(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '\'') is_quoted = !is_quoted;
    if (c != ' ' || is_quoted) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

/// What a command said of the task and the hold, so that another one asks for the same:
/// " --grip-force-n 60".
std::string task_options(const std::string& command_line) {
  static const std::vector<std::string> options = {
      "--along",        "--grip",    "--grip-force-n", "--hold",    "--hold-weights",
      "--limit-depths", "--mass-kg", "--part",         "--purpose", "--strength-share",
      "--task",         "--toward",  "--turn-n-m",     "--up"};
  const std::vector<std::string> words = words_of_line(command_line);
  std::string line;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string option = words[i].substr(0, words[i].find('='));
    if (std::find(options.begin(), options.end(), option) == options.end()) continue;
    line += " " + words[i];
    const bool has_value =
        option == words[i] && i + 1 < words.size() && !words[i + 1].starts_with("--");
    if (has_value) line += " " + words[i + 1];
  }
  return line;
}

class SetSpeaker {
 public:
  SetSpeaker(const study::AssessmentSet& set, const study::SetVerdict& verdict, const Texts& texts)
      : set_(set), verdict_(verdict), texts_(texts) {}

  records::VerdictWords speak() {
    for (std::size_t i = 0; i < set_.assessments.size(); ++i) {
      words_.products.push_back(product_words(set_.assessments[i], verdict_.products[i], texts_));
    }
    if (verdict_.comparisons.empty()) {
      speak_of_one();
    } else {
      speak_of_several();
      add_why_taken();
    }
    add_second_rests();
    if (set_.hand) {
      words_.reasons.push_back(texts_(
          "reason.one_hand", {{"length", texts_.number(set_.hand->dimensions.hand_length)}}));
    }
    return std::move(words_);
  }

 private:
  const std::string& name(int i) const { return set_.assessments[i].product.name; }
  /// In which grip two products are compared.
  std::string grip(const study::ProductComparison& pair) const {
    return grip_words(
        pair.are_of_task ? std::optional(verdict_.products[pair.worse].grip_force) : std::nullopt,
        verdict_.products[pair.better].grip_force, name(pair.worse), name(pair.better), texts_);
  }
  std::string grip_of_all(const study::ProductComparison& pair) const {
    return pair.are_of_task ? texts_("grip.all_of_task") : grip(pair);
  }
  std::string force(int i) const { return texts_.number(verdict_.products[i].grip_force, 2); }

  void next(const std::string& key, const std::string& command) {
    if (command.empty()) return;
    words_.next = texts_("next." + key);
    words_.command = command;
  }

  std::vector<const product::Product*> all_products() const {
    std::vector<const product::Product*> products;
    for (const study::AssessedProduct& one : set_.assessments) products.push_back(&one.product);
    return products;
  }

  void ask_other_hands(const std::string& key) {
    const std::string products = product_arguments(all_products(), "--product ");
    if (products.empty()) return;
    next(key, "palmar study run " + products + task_options(set_.command_line) + " --hands " +
                  std::to_string(kHandsToAsk) + " --out hands.palmar");
  }

  void try_other_hold(int i) {
    const study::AssessedProduct& one = set_.assessments[i];
    const std::string product = product_arguments({&one.product});
    if (product.empty() || one.ways == nullptr) return;
    const auto rank = static_cast<std::size_t>(one.ways->taken);
    if (rank >= one.ways->holds.size()) return;
    std::string changed = "--hold " + std::to_string(rank + 1);
    std::vector<std::string> replaced = {"--hold"};
    if (one.ways->purpose == grasp::HoldPurpose::kHandOver) {
      replaced.emplace_back("--purpose");
      changed += " --purpose hand-over";
    }
    const std::string options = changed_command(task_options(set_.command_line), replaced, changed);
    next("other_hold", "palmar assess " + product + " " + options);
  }

  /// What a measurement is laid beside the simulation for.
  void add_measured(const study::PressureComparison& beside) {
    constexpr double kKiloPascal = 1000.0;  // of an MPa
    words_.reasons.push_back(texts_(
        "reason.measured", {{"source", beside.source},
                            {"r", texts_.number(beside.pearson.r, 2)},
                            {"cells", std::to_string(beside.pearson.n)},
                            {"simulated", texts_.number(kKiloPascal * beside.peak_simulated, 3)},
                            {"measured", texts_.number(kKiloPascal * beside.peak_measured, 3)},
                            {"force_simulated", texts_.number(beside.force_simulated, 3)},
                            {"force_measured", texts_.number(beside.force_measured, 3)}}));
  }

  /// Why it isn't the hold that the product's shape suggests.
  void add_why_taken() {
    const Phrases phrases(texts_.language());
    for (const study::AssessedProduct& one : set_.assessments) {
      if (!one.ways || one.ways->why_taken.empty()) continue;
      words_.reasons.push_back(
          texts_("reason.taken_otherwise",
                 {{"product", one.product.name}, {"why", phrases(one.ways->why_taken)}}));
    }
  }

  /// What the user has to say, as the shape doesn't.
  void add_other_way(const study::AssessedProduct& one) {
    const std::optional<int> other =
        one.ways && one.ways->why_taken.empty() && one.assessment.options.grasp.leaves_hold_open()
            ? grasp::other_as_likely(*one.ways)
            : std::nullopt;
    if (!other) return;
    const std::string& way = one.ways->holds[static_cast<std::size_t>(*other) - 1].words;
    words_.reasons.push_back(
        texts_("reason.other_way", {{"product", one.product.name},
                                    {"number", std::to_string(*other)},
                                    {"way", Phrases(texts_.language())(way)}}));
  }

  /// Whose figures hang on which of two ways the hand rests in.
  void add_second_rests() {
    for (std::size_t i = 0; i < set_.assessments.size(); ++i) {
      const auto& certainty = set_.assessments[i].assessment.certainty;
      if (!certainty || !certainty->second) continue;
      const double change = certainty->second->change.peak_pressure_cells;
      words_.reasons.push_back(
          texts_(change < 0.0 ? "reason.second_rest.lower" : "reason.second_rest.higher",
                 {{"product", name(static_cast<int>(i))}, {"percent", texts_.percent(change)}}));
    }
  }

  void speak_of_one() {
    const study::AssessedProduct& one = set_.assessments.front();
    const study::ProductVerdict& verdict = verdict_.products.front();
    const records::ProductWords& words = words_.products.front();
    words_.sentence = words.held;
    add_why_taken();
    add_other_way(one);
    if (one.assessment.measured) add_measured(*one.assessment.measured);
    if (!words.hardest.empty()) words_.reasons.push_back(words.hardest);
    if (!words.strength.empty()) words_.reasons.push_back(words.strength);
    if (!study::is_sound(verdict.held)) {
      try_other_hold(0);
      return;
    }
    const bool is_uncomfortable =
        verdict.comfort.discomfort &&
        grasp::level_of(*verdict.comfort.discomfort) == grasp::OnsetLevel::kAbove;
    const std::string product = product_arguments({&one.product});
    if (!is_uncomfortable || product.empty()) {
      ask_other_hands("study_one");
    } else if (one.product.unit_source == product::UnitSource::kFile &&
               one.product.faces != nullptr) {
      next("fillet", "palmar redesign fillet " + product + " --hands " +
                         std::to_string(kHandsToAsk) + " --out fillet");
    } else {
      next("redesign", "palmar redesign press " + product + " --hands " +
                           std::to_string(kHandsToAsk) + " --out pressed");
    }
  }

  std::string pair_sentence(const study::ProductComparison& pair) const {
    const TextValues names = {{"better", name(pair.better)}, {"worse", name(pair.worse)}};
    TextValues values = names;
    values["grip"] = grip(pair);
    values["percent"] = texts_.percent(pair.peak_change);
    switch (pair.verdict) {
      case study::PairVerdict::kLower:
        values["area"] = area_words(pair.area_change, texts_);
        return texts_("verdict.lower", values);
      case study::PairVerdict::kSame:
        values["limit"] =
            texts_.percent(std::max(grasp::kToldApart, pair.peak_unsure.value_or(0.0)));
        return texts_("verdict.same", values);
      case study::PairVerdict::kDependsOnSkin:
        return texts_("verdict.depends_on_skin", values);
      case study::PairVerdict::kDependsOnRest:
        return texts_("verdict.depends_on_rest", values);
      case study::PairVerdict::kUnequalForce:
        values["better_force"] = force(pair.better);
        values["worse_force"] = force(pair.worse);
        return texts_("verdict.unequal_force", values);
      case study::PairVerdict::kOnlyOneHeld:
      case study::PairVerdict::kNoneHeld:
        break;
    }
    values["why"] = why_not_held(set_.assessments[pair.worse].assessment, texts_);
    values["worse_name"] = name(pair.worse);
    return texts_(pair.verdict == study::PairVerdict::kOnlyOneHeld ? "verdict.only_one_held"
                                                                   : "verdict.none_held",
                  values);
  }

  /// The comparison that decides: of several the one that stands in the way of an answer.
  const study::ProductComparison& deciding() const {
    for (const study::ProductComparison& one : verdict_.comparisons) {
      if (one.verdict != study::PairVerdict::kLower &&
          one.verdict != study::PairVerdict::kOnlyOneHeld) {
        return one;
      }
    }
    return verdict_.comparisons.front();
  }

  void speak_of_several() {
    const study::ProductComparison& pair = deciding();
    if (verdict_.comparisons.size() == 1) {
      words_.sentence = pair_sentence(pair);
    } else if (verdict_.best) {
      std::vector<std::string> list;
      for (const study::ProductComparison& one : verdict_.comparisons) {
        const bool is_held = one.verdict == study::PairVerdict::kLower;
        TextValues values = {{"worse", name(one.worse)}};
        if (is_held) values["percent"] = texts_.percent(one.peak_change);
        list.push_back(
            texts_(is_held ? "verdict.best_of.item" : "verdict.best_of.not_held", values));
      }
      words_.sentence =
          texts_("verdict.best_of", {{"count", std::to_string(set_.assessments.size())},
                                     {"best", name(*verdict_.best)},
                                     {"list", texts_.listed(list)},
                                     {"grip", grip_of_all(pair)}});
    } else {
      words_.sentence = texts_("verdict.no_best", {{"first", pair_sentence(pair)}});
    }
    for (const study::ProductComparison& one : verdict_.comparisons) add_other_hold(one);
    if (pair.verdict == study::PairVerdict::kLower) {
      if (pair.peak_change_soft && pair.peak_change_stiff) {
        const auto signed_percent = [&](double change) {
          return std::string(change < 0.0 ? "−" : "+") + texts_.percent(change);
        };
        words_.reasons.push_back(
            texts_("reason.skin", {{"soft", signed_percent(*pair.peak_change_soft)},
                                   {"stiff", signed_percent(*pair.peak_change_stiff)}}));
      } else {
        words_.reasons.push_back(texts_("reason.no_band"));
      }
      add_unresolved(pair);
    }
    const records::ProductWords& better = words_.products[pair.better];
    if (!better.comfort.empty() &&
        verdict_.products[pair.better].held != study::HeldVerdict::kNotHeld) {
      const grasp::ComfortResult& comfort = verdict_.products[pair.better].comfort;
      words_.reasons.push_back(name(pair.better) + ": " + comfort_words(comfort, texts_));
    }
    for (const int i : {pair.worse, pair.better}) {
      const study::ProductVerdict& one = verdict_.products[i];
      if (one.asked && one.grip_force > 0.0 &&
          !study::are_equally_firm(one.grip_force, *one.asked)) {
        words_.reasons.push_back(
            name(i) + ": " +
            texts_("strength.not_reached", {{"force", texts_.number(one.grip_force, 2)},
                                            {"asked", texts_.number(*one.asked, 2)}}));
      }
    }
    if (pair.verdict == study::PairVerdict::kUnequalForce) {
      compare_at_equal_force();
    } else if (pair.verdict == study::PairVerdict::kOnlyOneHeld ||
               pair.verdict == study::PairVerdict::kNoneHeld) {
      try_other_hold(pair.worse);
    } else {
      ask_other_hands(pair.verdict == study::PairVerdict::kLower ? "study" : "more_hands");
    }
  }

  /// How much of a difference may come from another hold.
  void add_other_hold(const study::ProductComparison& pair) {
    if (!pair.hand_turned || pair.are_held_alike()) return;
    words_.reasons.push_back(
        texts_("reason.other_hold",
               {{"better", name(pair.better)},
                {"worse", name(pair.worse)},
                {"turned", std::to_string(std::lround(*pair.hand_turned / geometry::kDegree))},
                {"shifted", std::to_string(std::lround(*pair.hand_shifted))}}));
  }

  /// Whose highest pressure hangs on edges sharper than the mesh.
  void add_unresolved(const study::ProductComparison& pair) {
    std::vector<std::string> names;
    for (const int i : {pair.worse, pair.better}) {
      if (is_hardest_unresolved(set_.assessments[i], verdict_.products[i])) {
        names.push_back(name(i));
      }
    }
    if (names.empty()) return;
    words_.reasons.push_back(texts_("reason.edges", {{"products", texts_.listed(names)}}));
  }

  void compare_at_equal_force() {
    double least = 0.0;
    for (const study::ProductVerdict& one : verdict_.products) {
      if (!study::is_sound(one.held)) continue;
      // Hooked fingers carry: no force can be asked of them.
      const auto number = static_cast<std::size_t>(&one - verdict_.products.data());
      if (set_.assessments[number].assessment.grasp.grip == grasp::Grip::kFixedHook) return;
      least = least > 0.0 ? std::min(least, one.grip_force) : one.grip_force;
    }
    const double force = std::floor(kSafeForce * least);
    if (!(force > 0.0)) return;
    const std::string added = "--grip-force-n " + significant(force, 4);
    const std::string products = product_arguments(all_products());
    const std::string line = set_.command_line.starts_with("palmar assess ") ? set_.command_line
                             : products.empty()                              ? ""
                                                : "palmar assess " + products;
    if (line.empty()) return;
    next("equal_force", changed_command(line,
                                        {"--grip-force-n", "--strength-share", "--strength-n",
                                         "--person", "--limit-depths", "--task", "--turn-n-m"},
                                        added));
  }

  const study::AssessmentSet& set_;
  const study::SetVerdict& verdict_;
  const Texts& texts_;
  records::VerdictWords words_;
};

}  // namespace

std::string grip_words(std::optional<double> worse_of_task, double better, const std::string& worse,
                       const std::string& better_name, const Texts& texts) {
  const std::string force = texts.number(better, 2);
  if (!worse_of_task || study::are_equally_firm(*worse_of_task, better)) {
    return texts("grip.same", {{"force", force}});
  }
  return texts("grip.of_task", {{"worse", worse},
                                {"better", better_name},
                                {"worse_force", texts.number(*worse_of_task, 2)},
                                {"better_force", force}});
}

std::string area_words(double change, const Texts& texts) {
  if (std::abs(change) < grasp::kToldApart) return texts("verdict.area.same");
  return texts(change > 0.0 ? "verdict.area.more" : "verdict.area.less",
               {{"percent", texts.percent(change)}});
}

std::string comfort_words(const grasp::ComfortResult& comfort, const Texts& texts) {
  if (!comfort.pain || !comfort.discomfort) return texts("comfort.none");
  const auto level = [](const grasp::WorstRegion& worst) {
    return std::string(name_of(grasp::level_of(worst)));
  };
  const std::string count = std::to_string(comfort.regions.size());
  const grasp::WorstRegion& pain = *comfort.pain;
  const grasp::WorstRegion& discomfort = *comfort.discomfort;
  const std::string where =
      texts(discomfort.above == 1 ? "comfort.repeated.one" : "comfort.repeated.many",
            {{"above", std::to_string(discomfort.above)}, {"count", count}});
  const bool flows = comfort.sustained_share < kNoBlood;
  return texts(
      "comfort.sentence",
      {{"moment", texts("comfort.moment." + level(pain), {{"at", at_words(pain.region, texts)}})},
       {"repeated", texts("comfort.repeated." + level(discomfort),
                          {{"at", at_words(discomfort.region, texts)}, {"where", where}})},
       {"minutes", texts(flows ? "comfort.minutes.flows" : "comfort.minutes.stops",
                         {{"percent", texts.percent(comfort.sustained_share)}})}});
}

std::string changed_command(const std::string& command_line,
                            const std::vector<std::string>& removed, const std::string& added) {
  const std::vector<std::string> words = words_of_line(command_line);
  std::string line;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string option = words[i].substr(0, words[i].find('='));
    if (std::find(removed.begin(), removed.end(), option) != removed.end()) {
      const bool has_value =
          option == words[i] && i + 1 < words.size() && !words[i + 1].starts_with("--");
      if (has_value) ++i;
      continue;
    }
    line += (line.empty() ? "" : " ") + words[i];
  }
  if (line.empty() || added.empty()) return line + added;
  return line + " " + added;
}

std::string product_arguments(const std::vector<const product::Product*>& products,
                              const std::string& option) {
  std::string line, unit;
  for (const product::Product* product : products) {
    if (product->unit_source == product::UnitSource::kMade || product->source.empty()) return "";
    line += (line.empty() ? "" : " ") + option + shell_word(product->source);
    if (product->unit_source != product::UnitSource::kFile) unit = name_of(product->unit);
  }
  return unit.empty() ? line : line + " --unit " + unit;
}

records::VerdictWords verdict_words(const study::AssessmentSet& set,
                                    const study::SetVerdict& verdict, Language language) {
  const Texts texts(language);
  return SetSpeaker(set, verdict, texts).speak();
}

}  // namespace palmar::report
