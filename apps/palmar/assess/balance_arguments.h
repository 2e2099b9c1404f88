// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli.h"
#include "palmar/grasp/rest/rest_settings.h"

namespace palmar::cli {

/// How firmly the hand grips and whether the grasp comes to rest.
class BalanceArguments {
 public:
  /// Adds --no-balance, --grip-force-n, --strength-share, --strength-n and --person to a verb.
  void add_to(CLI::App& verb);
  RestSettings settings() const;  ///< throws UsageError naming the option

 private:
  RestSettings settings_;
  bool no_balance_ = false;
  std::string person_;
};

/// How the grasp came to rest, in one or two lines; empty if it wasn't asked to.
std::string balance_text(const Balance& balance);

}  // namespace palmar::cli
