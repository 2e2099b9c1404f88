// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"
#include "palmar/workflow/words/hold_words.h"

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
  grasp::HoldRequest request() const { return workflow::hold_request(words_); }

 private:
  workflow::HoldWords words_;
};

}  // namespace palmar::cli
