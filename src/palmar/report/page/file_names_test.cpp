// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/file_names.h"

#include <gtest/gtest.h>

namespace palmar::report {
namespace {

TEST(FileNames, AreTakenByEveryFileSystemAndDiffer) {
  std::set<std::string> used;
  EXPECT_EQ(unique_file_name("v1.5 left", used, FullStops::kKept), "v1.5_left");
  EXPECT_EQ(unique_file_name("v1.5/left", used, FullStops::kKept), "v1.5_left_2");
  EXPECT_EQ(unique_file_name("v1.5 left", used, FullStops::kReplaced), "v1_5_left");
  EXPECT_EQ(unique_file_name("../a", used, FullStops::kKept), "_._a");
  EXPECT_EQ(unique_file_name("", used, FullStops::kKept), "product");
  EXPECT_EQ(unique_file_name(std::string(300, 'x'), used, FullStops::kKept).size(), 80U);
}

}  // namespace
}  // namespace palmar::report
