// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace palmar {

/// How long work says where it stands and learns that it should stop. Cheap to copy; a
/// default-constructed one reports nowhere and never cancels.
struct Progress {
  /// Called with the share done in [0, 1] and what is being done now. May be empty.
  std::function<void(double share, const std::string& activity)> report;
  /// Set to true (by a signal handler, say) to stop soon; may be null.
  const std::atomic<bool>* cancel = nullptr;

  void update(double share, const std::string& activity) const {
    throw_if_cancelled();
    if (report) report(share, activity);
  }
  bool is_cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
  /// Throws Cancelled when the user asked to stop.
  void throw_if_cancelled() const;
};

}  // namespace palmar
