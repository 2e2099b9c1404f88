// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <utility>

#include "palmar/core/parallel.h"
#include "palmar/core/progress.h"

namespace palmar::capture {

/// body(i) for each of `count` views, several at once, with the share that is done reported as
/// `what`.
template <typename Body>
void over_views(std::size_t count, const Progress& progress, const char* what, Body&& body) {
  std::atomic<int> done{0};
  progress.update(0.0, what);
  parallel_for(static_cast<int>(count), [&](int i) {
    progress.throw_if_cancelled();
    body(i);
    ++done;
    if (progress.report)
      progress.report(static_cast<double>(done) / static_cast<double>(count), what);
  });
}

}  // namespace palmar::capture
