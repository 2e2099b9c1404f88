// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "assess/balance_arguments.h"

#include <fmt/format.h>

#include <cstdlib>

#include "palmar/core/error.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "text.h"

namespace palmar::cli {
PersonOfAge parse_person(const std::string& text) {
  const std::size_t comma = text.find(',');
  const std::string sex = text.substr(0, comma);
  char* end = nullptr;
  const std::string years = comma == std::string::npos ? "" : text.substr(comma + 1);
  const double age = std::strtod(years.c_str(), &end);
  const bool is_number = !years.empty() && *end == '\0';
  if (!is_number || (sex != "male" && sex != "female")) {
    throw UsageError("--person is \"" + text + "\"; male,AGE or female,AGE is required");
  }
  return {sex == "male" ? Sex::kMale : Sex::kFemale, age};
}

std::string usual_words() {
  const ShareOfStrength usual = usual_share(kUsualFriction);
  return fmt::format("{:.0f} N, {} (15 to 23 N in a pinch)", usual.force(Grip::kMediumWrap),
                     usual.words(Grip::kMediumWrap));
}

void BalanceArguments::add_to(CLI::App& verb) {
  verb.add_flag("--no-balance", no_balance_,
                "Leave the hand as it was closed to the limit depths, forces out of balance "
                "(Xie 2014)");
  verb.add_flag(
      "--limit-depths", settings_.limit_depths,
      "Grip as firmly as closing to the limit depths made it: every product and hand with "
      "another force");
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
  verb.add_option("--person", person_,
                  "male,AGE or female,AGE: mean grip strength of that group (Steiber 2016)")
      ->excludes(strength);
}

RestSettings BalanceArguments::settings() const {
  RestSettings result = settings_;
  result.is_balanced = !no_balance_;
  if (!person_.empty()) result.person = parse_person(person_);
  result.check();
  return result;
}

std::string balance_text(const Assessment& assessment) {
  const Balance& balance = assessment.balance;
  if (balance.status == BalanceStatus::kOff) return {};
  const BalanceOptions& options = assessment.options.balance;
  const Grip grip = assessment.grasp.grip;
  const std::optional<double> asked = options.asked_grip_force(grip);
  std::string text = "grip force";
  if (balance.grip_force > 0.0) text += fmt::format(" {:.1f} N", balance.grip_force);
  text += asked ? fmt::format("; {:.0f} N asked for: ", *asked) : "; ";
  text += options.asked_words(grip) + "\n";
  text += fmt::format("at rest: {} ({})\n", name_of(balance.status), balance.message);
  if (balance.grip_force > 0.0) {
    text += fmt::format(
        "sum of normal forces {:.1f} N; left over {:.2f} N; friction {:.2f}, {:.0f} % of it in "
        "use; "
        "moved {:.1f} mm and {:.1f} deg since it was closed\n",
        balance.sum_of_normals, balance.residual_force, balance.friction,
        100.0 * balance.friction_use, balance.moved, degrees(balance.turned));
  }
  return text;
}

}  // namespace palmar::cli
