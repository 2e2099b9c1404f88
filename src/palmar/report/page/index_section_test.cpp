// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/index_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

GraspIndex index(const std::string& key, const std::string& group, std::optional<double> value) {
  GraspIndex one;
  one.key = key;
  one.name = "name of " + key;
  one.group = group;
  one.value = value;
  one.unit = "mm2";
  one.lowest = 0.0;
  one.highest = 100.0;
  one.better = Better::kDown;
  one.definition = "area < limit";
  one.source = "Someone 1999";
  return one;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(IndexSection, HasATablePerGroupAndUnfoldsDefinitions) {
  const std::string html =
      index_section({index("a", "stability", 0.123456), index("b", "stability", std::nullopt),
                     index("c", "comfort", 12.0)});
  EXPECT_EQ(count(html, "<table"), 2u);
  EXPECT_EQ(count(html, "</table>"), 2u);
  EXPECT_EQ(count(html, "<details>"), 3u);
  EXPECT_EQ(count(html, "<tr"), count(html, "</tr>"));
  EXPECT_THAT(html, HasSubstr("data-value=\"0.123456\""));
  EXPECT_THAT(html, HasSubstr("mm²"));
  EXPECT_THAT(html, HasSubstr("area &lt; limit"));
  EXPECT_THAT(html, HasSubstr("less is better"));
  EXPECT_THAT(html, HasSubstr("0 to 100"));
  EXPECT_EQ(index_section({}), "");
}

TEST(IndexSection, ComparesProductsRowByRow) {
  const std::string html = index_comparison(
      {"old", "new <2>"}, {{index("a", "stability", 1.0), index("c", "comfort", 2.0)},
                           {index("b", "stability", 3.0), index("c", "comfort", 4.0)}});
  EXPECT_EQ(count(html, "data-index=\"a\""), 1u);
  EXPECT_EQ(count(html, "data-index=\"c\""), 1u);
  EXPECT_THAT(html, HasSubstr("new &lt;2&gt;"));
  // b belongs to the first group though only the second product has it.
  EXPECT_LT(html.find("data-index=\"b\""), html.find("data-index=\"c\""));
  EXPECT_THAT(index_comparison({"one"}, {{index("a", "ease", 1.0)}}), Not(HasSubstr("table")));
  EXPECT_THROW(index_comparison({"one", "two"}, {{}}), UsageError);
}

}  // namespace
}  // namespace palmar
