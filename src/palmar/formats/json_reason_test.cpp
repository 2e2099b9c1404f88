// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/json_reason.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace palmar::formats {
namespace {

TEST(JsonReason, LeavesOutTheLibrary) {
  try {
    const nlohmann::json none = nlohmann::json::parse("{\"a\": 1");
    FAIL() << none.dump();
  } catch (const nlohmann::json::exception& error) {
    EXPECT_EQ(json_reason(error).rfind("parse error at line 1, column 8", 0), 0U)
        << json_reason(error);
  }
  EXPECT_EQ(json_reason(std::runtime_error("disk full")), "disk full");
}

}  // namespace
}  // namespace palmar::formats
