// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/occt_progress.h"

#include <utility>

namespace palmar::cad {

OcctProgress::OcctProgress(const Progress& progress, double begin, double end, std::string activity)
    : progress_(progress), begin_(begin), end_(end), last_(-1.0), activity_(std::move(activity)) {}

void OcctProgress::Show(const Message_ProgressScope&, const Standard_Boolean) {
  constexpr double kStep = 0.01;  // of the whole; more often nobody can read it
  const double share = begin_ + (end_ - begin_) * GetPosition();
  if (!progress_.report || share < last_ + kStep) return;
  last_ = share;
  progress_.report(share, activity_);
}

}  // namespace palmar::cad
