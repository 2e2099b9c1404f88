// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "assess/balance_arguments.h"

#include <fmt/format.h>

#include <cstdlib>

#include "palmar/core/error.h"
#include "palmar/grasp/joint_strength.h"
#include "text.h"

namespace palmar::cli {
namespace {

/// "male,30" or "female,64". Throws UsageError.
double strength_of_person(const std::string& text) {
  const std::size_t comma = text.find(',');
  const std::string sex = text.substr(0, comma);
  char* end = nullptr;
  const std::string years = comma == std::string::npos ? "" : text.substr(comma + 1);
  const double age = std::strtod(years.c_str(), &end);
  const bool is_number = !years.empty() && *end == '\0';
  if (!is_number || (sex != "male" && sex != "female")) {
    throw UsageError("--person is \"" + text + "\"; male,AGE or female,AGE is required");
  }
  const auto strength = grip_strength(sex == "male" ? Sex::kMale : Sex::kFemale, age);
  if (!strength) {
    throw UsageError(
        fmt::format("--person: no grip strength is known for {:g} years; 17 to 90 is "
                    "allowed, or give --strength-n",
                    age));
  }
  return *strength;
}

}  // namespace

void BalanceArguments::add_to(CLI::App& verb) {
  verb.add_flag("--no-balance", no_balance,
                "Leave the hand as it was closed to the limit depths, forces out of balance "
                "(Xie 2014)");
  CLI::Option* force =
      verb.add_option("--grip-force-n", grip_force_n,
                      "Grip with this force across the plane of largest squeeze, as a dynamometer "
                      "reads it, N; default: as firm as closing to the limit depths");
  verb.add_option("--strength-share", strength_share,
                  "Grip with this share (0 to 1) of the strength of --person or --strength-n")
      ->excludes(force);
  CLI::Option* strength =
      verb.add_option("--strength-n", strength_n, "Largest grip force of the user, N");
  verb.add_option("--person", person,
                  "male,AGE or female,AGE: mean grip strength of that group (Steiber 2016)")
      ->excludes(strength);
}

BalanceOptions BalanceArguments::options(const FrictionArguments& friction,
                                         std::optional<Grip> grip) const {
  BalanceOptions result;
  const bool has_strength = strength_n || !person.empty();
  if (has_strength != strength_share.has_value()) {
    throw UsageError(has_strength ? "--strength-n and --person say how strong the user is; "
                                    "--strength-share is required with them"
                                  : "--strength-share needs --person or --strength-n");
  }
  if (no_balance && (grip_force_n || strength_share)) {
    throw UsageError(
        "--no-balance keeps the hand at its limit depths; a grip force can't be "
        "given with it");
  }
  result.is_on = !no_balance;
  result.grip_force = grip_force_n;
  if (strength_share) {
    if (!(*strength_share > 0.0 && *strength_share <= 1.0)) {
      throw UsageError(fmt::format("--strength-share is {}; more than 0 and at most 1 is required",
                                   *strength_share));
    }
    const double strength = strength_n ? *strength_n : strength_of_person(person);
    result.grip_force = *strength_share * strength * (grip ? palmar::strength_share(*grip) : 1.0);
  }
  result.friction = friction.coefficient.value_or(kUsualFriction);
  result.check();
  return result;
}

std::string balance_text(const Balance& balance) {
  if (balance.status == BalanceStatus::kOff) return {};
  std::string text = fmt::format("at rest: {} ({})\n", name_of(balance.status), balance.message);
  if (balance.grip_force > 0.0) {
    text += fmt::format(
        "grip force {:.1f} N (sum of normal forces {:.1f} N); left over {:.2f} N; friction {:.2f}, "
        "{:.0f} % of it in use; moved {:.1f} mm and {:.1f} deg since it was closed\n",
        balance.grip_force, balance.sum_of_normals, balance.residual_force, balance.friction,
        100.0 * balance.friction_use, balance.moved, degrees(balance.turned));
  }
  return text;
}

}  // namespace palmar::cli
