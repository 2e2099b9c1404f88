// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress.h"
#include "palmar/core/progress_part.h"
#include "palmar/core/version.h"

namespace palmar {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  std::vector<int> visits(1000, 0);
  parallel_for(1000, [&](int i) { ++visits[i]; });
  for (const int v : visits) EXPECT_EQ(v, 1);
}

TEST(ParallelFor, RethrowsTheErrorOfTheSmallestIndexWhateverTheOrder) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    try {
      parallel_for(200, [](int i) {
        if (i % 7 == 3) throw InputError("index " + std::to_string(i));
      });
      FAIL() << "no error was thrown";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), "index 3");
    }
  }
}

TEST(SetThreadCount, RefusesNegativeCounts) {
  EXPECT_THROW(set_thread_count(-1), UsageError);
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
  set_thread_count(0);
}

TEST(Progress, OfAPartRunsWithinItsShareOfTheWhole) {
  std::vector<std::pair<double, std::string>> reported;
  const Progress whole{.report = [&](double share, const std::string& activity) {
    reported.emplace_back(share, activity);
  }};
  const Progress part = part_of(whole, 0.2, 0.6, "index");
  part.update(0.0, "begins");
  part_of(part, 0.5, 1.0).update(0.5, "goes on");
  ASSERT_EQ(reported.size(), 2U);
  EXPECT_DOUBLE_EQ(reported[0].first, 0.2);
  EXPECT_EQ(reported[0].second, "index: begins");
  EXPECT_DOUBLE_EQ(reported[1].first, 0.2 + 0.4 * 0.75);
  EXPECT_EQ(reported[1].second, "index: goes on");
}

TEST(Progress, ThrowsCancelledOnceTheFlagIsSet) {
  std::atomic<bool> cancel{false};
  Progress progress{.report = {}, .cancel = &cancel};
  EXPECT_NO_THROW(progress.update(0.5, "half"));
  cancel = true;
  EXPECT_THROW(progress.update(0.6, "more"), Cancelled);
}

TEST(Errors, CarryTheDocumentedExitCodes) {
  EXPECT_EQ(Error("").exit_code(), 1);
  EXPECT_EQ(OutputError("").exit_code(), 1);
  EXPECT_EQ(UsageError("").exit_code(), 2);
  EXPECT_EQ(InputError("").exit_code(), 3);
  EXPECT_EQ(NumericalError("").exit_code(), 4);
  EXPECT_EQ(CheckFailed("").exit_code(), 5);
  EXPECT_EQ(Cancelled("").exit_code(), 130);
}

}  // namespace
}  // namespace palmar
