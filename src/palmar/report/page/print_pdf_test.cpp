// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/print_pdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/program_missing.h"

namespace palmar::report {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A page that behaves as reports do is printed by report tests of the command line; here, that a
/// browser that isn't there is named.
TEST(PrintPdf, NamesTheBrowsersThatItLooksFor) {
  const char* path = std::getenv("PATH");
  const std::string before = path != nullptr ? path : "";
  setenv("PATH", "/nowhere", 1);
  try {
    print_pdf("report.html", Paper::kA4);
    ADD_FAILURE() << "printed without a browser";
  } catch (const formats::ProgramMissing& error) {
    EXPECT_THAT(error.what(), HasSubstr("chromium"));
    EXPECT_EQ(error.exit_code(), 6);
  }
  setenv("PATH", before.c_str(), 1);
}

TEST(PrintPdf, PaperIsNamed) {
  EXPECT_EQ(paper_named("A4"), Paper::kA4);
  EXPECT_EQ(name_of(paper_named("letter")), "letter");
  EXPECT_THROW(paper_named("a5"), UsageError);
}

}  // namespace
}  // namespace palmar::report
