// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/setting_names.h"

#include <gtest/gtest.h>

namespace palmar {
namespace {

const SettingNames kOptions = [](const std::string& setting) { return "--" + setting; };

TEST(WithSettingNames, EverySettingGetsTheReadersName) {
  EXPECT_EQ(
      with_setting_names(R"(leave it out with setting "skip", or say setting "side")", kOptions),
      "leave it out with --skip, or say --side");
  EXPECT_EQ(with_setting_names(R"(setting "work" here: no folder)", kOptions),
            "--work here: no folder");
}

TEST(WithSettingNames, OtherTextStaysAsItIs) {
  EXPECT_EQ(with_setting_names("", kOptions), "");
  EXPECT_EQ(with_setting_names(R"(a setting of "skip")", kOptions), R"(a setting of "skip")");
  EXPECT_EQ(with_setting_names(R"(setting "never closed)", kOptions), R"(setting "never closed)");
}

TEST(WithSettingNames, WithoutNamesTheWordsOfTheLibraryStay) {
  EXPECT_EQ(with_setting_names(R"(setting "side")", {}), R"(setting "side")");
}

}  // namespace
}  // namespace palmar
