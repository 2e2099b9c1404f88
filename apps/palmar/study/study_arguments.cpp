// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "study/study_arguments.h"

#include <fmt/format.h>

#include <cmath>

#include "assess/balance_arguments.h"
#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar::cli {

void StudyArguments::add_to(CLI::App& verb) {
  CLI::Option* toml = verb.add_option("FILE", file_, "Study file (docs/using/studies.md)");
  const auto add = [&](const char* name, auto& value, const char* text) {
    CLI::Option* option = verb.add_option(name, value, text);
    option->excludes(toml);
    return option;
  };
  add("--product", quick_.products,
      "Without FILE: a product (STL, STEP ...), may be given several times")
      ->allow_extra_args(false);
  add("--unit", unit_, "Unit of files that carry none: mm, cm, m, inch");
  add("--population", populations_,
      "Without FILE: a built-in population (`palmar population list`), a population file (.toml) "
      "or "
      "a table of given hands (.csv); xie2014 if not given")
      ->allow_extra_args(false);
  add("--hands", quick_.hands, "Number of hands to sample from each population; 30 if not given")
      ->check(CLI::Range(1, workflow::QuickStudy::kMostHands));
  add("--profile", quick_.profiles,
      "none, reduced_range, thick_gloves ...; may be given several times")
      ->allow_extra_args(false);
  add("--grip", quick_.grips,
      "any (as people would choose), medium_wrap, tripod ...; may be given several times")
      ->allow_extra_args(false);
  holds_.add_hold_to(verb);
  holds_.add_to(verb);
  for (const char* name : {"--hold", "--part", "--along", "--toward", "--up", "--purpose"}) {
    verb.get_option(name)->excludes(toml);
  }
  add("--hand", quick_.hand, "Hand that is scaled: template or a *.hand.glb file");
  add("--mass-kg", quick_.mass, "Mass of every product, kg; without it nothing is carried");
  add("--task", task_,
      "What the hands do: usual, squeeze, hold, carry or turn, as in palmar assess")
      ->check(CLI::IsMember(task_names()))
      ->default_str("usual");
  add("--turn-n-m", quick_.turn,
      "With --task turn: the torque about the grip axis that the products are turned with, N m");
  add("--grip-force-n", quick_.grip_force,
      fmt::format("Grip force, N; if not given for all hands and products {}, or what holds the "
                  "heaviest",
                  usual_words())
          .c_str());
  add("--strength-share", quick_.strength_share,
      "Grip with this share (0 to 1) of each person's own strength");
  verb.add_flag(
          "--limit-depths", quick_.limit_depths,
          "Grip as firmly as closing to the limit depths made it: every hand and product with "
          "another force")
      ->excludes(toml);
}

records::StudyRequest StudyArguments::request(const Context& context) const {
  records::StudyRequest request;
  if (!file_.empty()) {
    request = records::read_study_file(file_);
  } else {
    workflow::QuickStudy quick = quick_;
    if (quick.products.empty()) {
      throw UsageError("what is to be studied is not said: FILE.toml or --product is required");
    }
    quick.unit = parse_unit(unit_);
    quick.task = grasp::hand_task_named(task_);
    quick.holding = holds_.request();
    if (!populations_.empty()) quick.populations = populations_;
    request = workflow::study_of(quick);
  }
  if (context.common.seed != 0) request.seed = context.common.seed;
  return request;
}

study::StudyShard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  const auto k = formats::parse_integer(std::string_view(text).substr(0, slash));
  const auto n = slash == text.npos
                     ? std::nullopt
                     : formats::parse_integer(std::string_view(text).substr(slash + 1));
  constexpr long long kMost = 1'000'000;
  if (!k || !n || *k < 1 || *n < *k || *n > kMost) {
    throw UsageError("--shard is \"" + text + "\"; k/n with 1 <= k <= n is required, as in 2/4");
  }
  return {static_cast<int>(*k), static_cast<int>(*n)};
}

std::string study_size_text(const study::StudyPlan& plan) {
  const auto counted = [](std::size_t count, const std::string& one) {
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
  };
  std::string text = counted(plan.hands.size(), "hand");
  const auto add = [&](std::size_t count, const std::string& one) {
    if (count > 1) text += " x " + counted(count, one);
  };
  add(plan.profiles.size(), "profile");
  add(plan.settings.size(), "setting");
  text += " x " + counted(plan.products.size(), "product");
  add(plan.grips.size(), "grip");
  return fmt::format("{} = {} grasps", text, study::task_count(plan));
}

std::string duration_text(double seconds) {
  if (seconds < 100.0) return fmt::format("{:.3g} s", seconds);
  if (seconds < 6000.0) return fmt::format("{:.0f} min", std::ceil(seconds / 60.0));
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

}  // namespace palmar::cli
