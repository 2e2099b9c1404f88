// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "assess/balance_arguments.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "text.h"

namespace palmar::cli {
std::string usual_words() {
  const grasp::ShareOfStrength usual = grasp::usual_share(grasp::kUsualFriction);
  return fmt::format("{:.0f} N, {} (15 to 23 N in a pinch)", usual.force(grasp::Grip::kMediumWrap),
                     usual.words(grasp::Grip::kMediumWrap));
}

std::vector<std::string> task_names() {
  std::vector<std::string> names;
  for (const grasp::HandTask task : grasp::kHandTasks) names.emplace_back(name_of(task));
  return names;
}

void BalanceArguments::add_to(CLI::App& verb) {
  verb.add_flag("--no-balance", no_balance_,
                "Leave the hand as it was closed to the limit depths, forces out of balance "
                "(Xie 2014)");
  verb.add_flag(
      "--limit-depths", settings_.limit_depths,
      "Grip as firmly as closing to the limit depths made it: every product and hand with "
      "another force");
  CLI::Option* task =
      verb.add_option(
              "--task", task_,
              "What the hand does: usual, to squeeze handles and hold what thumb and "
              "fingers don't meet round; squeeze, with a grip force as the options below say; "
              "hold, with what each product's weight and load ask for: 1.4 times what "
              "friction needs (Westling & Johansson 1984), without a mass the weight of a "
              "solid of 1 g/cm3; carry, the same while walking, a fifth heavier unless "
              "--acceleration-g is given; turn, with what --turn-n-m takes")
          ->check(CLI::IsMember(task_names()))
          ->default_str("usual");
  verb.add_option("--turn-n-m", settings_.turn,
                  "With --task turn: the torque about the grip axis that the product is turned "
                  "with, N m; right-handed about the axis towards the thumb's side")
      ->needs(task);
  CLI::Option* force = verb.add_option(
      "--grip-force-n", settings_.grip_force,
      "Grip with this force across the plane of largest squeeze, as a dynamometer "
      "reads it, N; default: " +
          fmt::format("for all products {}, or what holds the heaviest", usual_words()));
  verb.add_option("--strength-share", settings_.strength_share,
                  "Grip with this share (0 to 1) of the strength of --person or --strength-n")
      ->excludes(force);
  CLI::Option* strength =
      verb.add_option("--strength-n", settings_.strength, "Largest grip force of the user, N");
  verb.add_option(
          "--person", person_,
          "Whose hand and strength: woman or man, a percentile of hand size (ANSUR II), an age (45 "
          "if none is given; strength: Steiber 2016): woman:P5, man:P50,age=60, "
          "woman:age=64; a hand of that size grips with 25 % of that strength unless a "
          "force or share is given")
      ->excludes(strength);
}

grasp::RestSettings BalanceArguments::settings() const {
  grasp::RestSettings result = settings_;
  result.is_balanced = !no_balance_;
  result.task = grasp::hand_task_named(task_);
  result = workflow::held_by(person_, result);
  result.check();
  return result;
}

std::optional<workflow::PersonOfSize> BalanceArguments::person() const {
  return workflow::parse_person_size(person_);
}

std::string balance_text(const study::Assessment& assessment) {
  const grasp::Balance& balance = assessment.balance;
  if (balance.status == grasp::BalanceStatus::kOff) return {};
  const grasp::BalanceOptions& options = assessment.options.balance;
  const grasp::Grip grip = assessment.grasp.grip;
  const std::optional<double> asked = options.asked_grip_force(grip);
  std::string text = "grip force:";
  // As they are printed.
  const bool is_reached = asked && std::lround(balance.grip_force) == std::lround(*asked);
  if (balance.grip_force > 0.0) text += fmt::format(" {:.0f} N,", balance.grip_force);
  if (asked && !is_reached) text += fmt::format(" {:.0f} N asked for:", *asked);
  text += " " + options.asked_words(grip) + "\n";
  return text + fmt::format("balance: {}\n", balance.message);
}

std::string rest_text(const study::Assessment& assessment) {
  const grasp::Balance& balance = assessment.balance;
  if (balance.status == grasp::BalanceStatus::kOff || !(balance.grip_force > 0.0)) return {};
  return fmt::format(
      "sum of normal forces {:.1f} N; left over {:.2f} N; friction {:.2f}, {:.0f} % of it in use; "
      "moved {:.1f} mm and {:.1f}° since it was closed\n",
      balance.sum_of_normals, balance.residual_force, balance.friction,
      100.0 * balance.friction_use, balance.moved, degrees(balance.turned));
}

}  // namespace palmar::cli
