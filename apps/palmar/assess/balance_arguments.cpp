// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "assess/balance_arguments.h"

#include <fmt/format.h>

#include <cstdlib>

#include "palmar/core/error.h"
#include "text.h"

namespace palmar::cli {
namespace {

/// "male,30" or "female,64". Throws UsageError.
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

}  // namespace

void BalanceArguments::add_to(CLI::App& verb) {
  verb.add_flag("--no-balance", no_balance_,
                "Leave the hand as it was closed to the limit depths, forces out of balance "
                "(Xie 2014)");
  CLI::Option* force =
      verb.add_option("--grip-force-n", settings_.grip_force,
                      "Grip with this force across the plane of largest squeeze, as a dynamometer "
                      "reads it, N; default: as firm as closing to the limit depths");
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
