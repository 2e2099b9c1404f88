// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/texts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>

#include "palmar/core/error.h"
#include "palmar/hand/anatomy.h"
#include "palmar/report/words/page_parts.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::set<std::string> places_of(const std::string& sentence) {
  static const std::regex place("\\{[a-z_0-9]+\\}");
  return {std::sregex_token_iterator(sentence.begin(), sentence.end(), place),
          std::sregex_token_iterator()};
}

TEST(Texts, BothLanguagesSayTheSameThings) {
  const json english = json::parse(english_texts()), german = json::parse(german_texts());
  EXPECT_EQ(english.size(), german.size());
  for (const auto& [key, sentence] : english.items()) {
    ASSERT_TRUE(german.contains(key)) << key;
    EXPECT_EQ(places_of(sentence), places_of(german[key])) << key;
    EXPECT_FALSE(german[key].get<std::string>().empty()) << key;
  }
}

TEST(Texts, RegionsHaveTheirWordsInBoth) {
  const Texts english(Language::kEnglish), german(Language::kGerman);
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const auto region = static_cast<hand::Region>(r);
    const std::string name(name_of(region));
    EXPECT_EQ(english("region." + name), plain_words(region));
    EXPECT_TRUE(german.has("region_at." + name)) << name;
  }
}

TEST(Texts, ValuesGoIntoTheirPlaces) {
  const Texts texts(Language::kEnglish);
  EXPECT_EQ(texts("strength.not_reached", {{"force", "86"}, {"asked", "107"}}),
            "This hold reaches 86 N of the 107 N that were asked for.");
  EXPECT_EQ(texts.percent(-0.274), "27");
  EXPECT_EQ(texts.listed({"a", "b", "c"}), "a, b and c");
  EXPECT_EQ(texts.listed({"a"}), "a");
  EXPECT_EQ(Texts(Language::kGerman).number(0.3012, 2), "0,30");
}

TEST(Texts, AMissingKeyOrValueIsAMistakeOfTheProgram) {
  const Texts texts(Language::kEnglish);
  EXPECT_THROW(texts("no.such.key"), std::logic_error);
  try {
    texts("strength.not_reached", {{"force", "86"}});
    FAIL();
  } catch (const std::logic_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("{asked}"));
  }
}

TEST(Language, IsNamed) {
  EXPECT_EQ(language_named("de"), Language::kGerman);
  EXPECT_EQ(name_of(Language::kEnglish), "en");
  try {
    language_named("fr");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("en or de"));
  }
}

}  // namespace
}  // namespace palmar::report
