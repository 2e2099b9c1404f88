// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "cli.h"
#include "palmar/grasp/grasp_settings.h"

namespace palmar::cli {

/// The options that say by which part of the product and how it is held, without coordinates.
class HoldArguments {
 public:
  /// Adds --hold to a verb: a file, or the number of a ranked hold.
  void add_hold_to(CLI::App& verb);
  /// Adds --part, --along, --toward, --up and --purpose to a verb.
  void add_to(CLI::App& verb);
  /// What was given, the file of a hold read. Throws UsageError naming the option, InputError
  /// naming the file.
  HoldRequest request() const;

 private:
  std::string hold_, part_, toward_, up_, purpose_ = "use";
  std::optional<double> along_;
};

/// "+x", "-z", "x", "0,0.5,1": a direction in the product's frame. Throws UsageError naming the
/// option.
Vec3 parse_direction(const std::string& option, const std::string& text);

/// "any" (as people would choose) and "power" have no grip; else the grip of that name. Throws
/// UsageError naming --grip, the nearest grip and those that are allowed.
std::optional<Grip> parse_grip(const std::string& text);
/// "any, power, medium_wrap, ...".
std::string grip_list();

}  // namespace palmar::cli
