// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "palmar/core/progress.h"

namespace palmar::report {

/// Sizes of paper.
enum class Paper { kA4, kLetter };
std::string name_of(Paper paper);  ///< "a4", "letter"
/// Throws UsageError with what is allowed.
Paper paper_named(const std::string& name);

/// Prints a report's page with a headless browser: beside it answer.pdf, its first screen on one
/// page, and report.pdf, all of it unfolded. Looks for chromium, chromium-browser, google-chrome,
/// google-chrome-stable, microsoft-edge on PATH. Throws ProgramMissing naming them if there is
/// none, OutputError if the browser writes nothing, Cancelled.
void print_pdf(const std::filesystem::path& report_html, Paper paper,
               const Progress& progress = {});

/// Pictures of 1920 x 1080 for slides beside a report's page, by the same browser:
/// slide-answer.png, its first screen; slide-hold.png and slide-map.png, how each product is held
/// and where it presses. A page without pictures gets the first alone. Throws as print_pdf().
void take_slides(const std::filesystem::path& report_html, const Progress& progress = {});

}  // namespace palmar::report
