// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "palmar/core/language.h"
#include "palmar/report/page/print_pdf.h"
#include "palmar/report/page/report_extras.h"

namespace palmar::cli {

/// How a report speaks, whose it is, and which files it gets: the same options for every report.
class ReportArguments {
 public:
  void add_to(CLI::App& verb);
  Language language() const;
  std::optional<report::Paper> pdf() const;  ///< nothing if no PDF is asked for
  report::ReportExtras extras() const;       ///< reads the project's file

 private:
  std::string language_ = "en", paper_ = "a4", units_ = "metric", project_;
  bool pdf_ = false, slides_ = false, excel_ = false, rounded_csv_ = false;
};

}  // namespace palmar::cli
