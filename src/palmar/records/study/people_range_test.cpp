// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/people_range.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::records {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(PeopleRange, OfOneSexHasBothEndsAndTheMiddle) {
  const auto women = population_requests("woman:P5..woman:P95");
  ASSERT_EQ(women.size(), 1u);
  EXPECT_EQ(women[0].preset, "ansur2_women");
  EXPECT_EQ(women[0].sampling.design, population::SamplingDesign::kPercentiles);
  EXPECT_THAT(women[0].sampling.percentiles, ElementsAre(5, 50, 95));
  EXPECT_FALSE(women[0].sampling.residuals);
  EXPECT_THAT(population_requests("man:P75..man:P90")[0].sampling.percentiles, ElementsAre(75, 90));
  EXPECT_THAT(population_requests("woman:P2.5")[0].sampling.percentiles, ElementsAre(2.5));
}

TEST(PeopleRange, FromWomenToMenHasBoth) {
  for (const char* const words : {"woman:P5..man:P95", "small-to-large"}) {
    const auto people = population_requests(words);
    ASSERT_EQ(people.size(), 2u) << words;
    EXPECT_EQ(people[0].preset, "ansur2_women");
    EXPECT_THAT(people[0].sampling.percentiles, ElementsAre(5, 50));
    EXPECT_EQ(people[1].preset, "ansur2_men");
    EXPECT_THAT(people[1].sampling.percentiles, ElementsAre(50, 95));
  }
}

TEST(PeopleRange, OtherWordsAreAsBefore) {
  EXPECT_EQ(population_requests("japanese")[0].preset, "japanese");
  EXPECT_EQ(population_requests("folder/people.toml")[0].file, "folder/people.toml");
  EXPECT_FALSE(is_people_range("hands.csv"));
}

TEST(PeopleRange, RefusesWhatIsNoRange) {
  for (const char* const words : {"man:P5..woman:P95", "woman:P95..woman:P5", "woman:P0..man:P95",
                                  "child:P5..man:P95", "woman:P5..man", "woman:Px"}) {
    try {
      population_requests(words);
      ADD_FAILURE() << words;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
      EXPECT_THAT(error.what(), HasSubstr("woman:P5..man:P95"));
    }
  }
}

}  // namespace
}  // namespace palmar::records
