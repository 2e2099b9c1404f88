// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/json_whole.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/formats/json_reason.h"

namespace palmar::formats {
namespace {

using nlohmann::json;

TEST(JsonWhole, TakesWhatFits) {
  EXPECT_EQ(json_whole<int>(json(-7)), -7);
  EXPECT_EQ(json_whole<int>(json(3.0)), 3);
  EXPECT_EQ(json_whole<std::uint64_t>(json::parse("18446744073709551615")), 18446744073709551615U);
  EXPECT_EQ(json_whole<std::int64_t>(json::parse("-9223372036854775808")),
            std::numeric_limits<std::int64_t>::min());
  const json object = {{"a", 5}};
  EXPECT_EQ(json_whole_or<int>(object, "a", 1), 5);
  EXPECT_EQ(json_whole_or<int>(object, "b", 1), 1);
}

TEST(JsonWhole, ListsOfThem) {
  const json object = json::parse(R"({"a": [1, 2], "b": [1, 1e20], "c": 3})");
  EXPECT_THAT(json_wholes<int>(object, "a"), testing::ElementsAre(1, 2));
  EXPECT_THAT(json_wholes<int>(object, "z"), testing::IsEmpty());
  EXPECT_THROW(json_wholes<int>(object, "b"), json::exception);
  EXPECT_THROW(json_wholes<int>(object, "c"), json::exception);
}

TEST(JsonWhole, RefusesWhatWouldBecomeAnotherNumber) {
  for (const char* text : {"4294967297", "2147483648", "-2147483649", "1e20", "-1e300", "2.5"}) {
    EXPECT_THROW(json_whole<int>(json::parse(text)), json::exception) << text;
  }
  EXPECT_THROW(json_whole<std::size_t>(json(-1)), json::exception);
  EXPECT_THROW(json_whole<std::size_t>(json(1e20)), json::exception);
  EXPECT_THROW(json_whole<int>(json("3")), json::exception);
  EXPECT_THROW(json_whole_or<int>(json(3), "a", 0), json::exception) << "no object";
  try {
    json_whole<std::uint16_t>(json(70000));
    FAIL();
  } catch (const json::exception& error) {
    EXPECT_EQ(json_reason(error), "70000 isn't a whole number from 0 to 65535");
  }
}

}  // namespace
}  // namespace palmar::formats
