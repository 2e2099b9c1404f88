// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/progress.h"

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"

namespace palmar {

void Progress::throw_if_cancelled() const {
  if (is_cancelled()) throw Cancelled("cancelled; whatever was finished has been kept");
}

Progress part_of(const Progress& progress, double begin, double end, const std::string& what) {
  Progress part = progress;
  if (progress.report) {
    part.report = [report = progress.report, begin, end, what](double share,
                                                               const std::string& activity) {
      report(begin + share * (end - begin), what.empty() ? activity : what + ": " + activity);
    };
  }
  return part;
}

}  // namespace palmar
