// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Message_ProgressIndicator.hxx>
#include <string>

#include "palmar/core/progress.h"

namespace palmar::cad {

/// OpenCASCADE's progress as Palmar's: its whole stands for the shares [begin, end] of the work.
/// When cancelled, OpenCASCADE stops early and what it gives is not to be used.
class OcctProgress : public Message_ProgressIndicator {
 public:
  OcctProgress(const Progress& progress, double begin, double end, std::string activity);

  Standard_Boolean UserBreak() override { return progress_.is_cancelled(); }
  void Show(const Message_ProgressScope& scope, const Standard_Boolean force) override;

 private:
  Progress progress_;
  double begin_, end_, last_;
  std::string activity_;
};

}  // namespace palmar::cad
