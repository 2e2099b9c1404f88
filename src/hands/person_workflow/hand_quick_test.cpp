// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_quick.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

// Requests that are refused; photographs and what is made of them are tested with the whole
// program.

namespace palmar::person_workflow {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(HandQuickRequest, NamesTheSettingAndWhatIsAllowed) {
  HandQuickRequest request;
  const auto refusal = [&] { return formats::message_of<UsageError>([&] { request.check(); }); };
  EXPECT_THAT(refusal(), AllOf(HasSubstr("nothing is known of the hand"),
                               HasSubstr("setting \"hand length\""), Not(HasSubstr("--"))));
  request.photo = "hand.jpg";
  EXPECT_EQ(refusal(), "");
  request.sheet = "a5";
  EXPECT_THAT(refusal(), HasSubstr("a4, letter and card are allowed"));
}

TEST(MakeHandQuick, APhotographThatIsNotThereIsNamed) {
  HandQuickRequest request;
  request.photo = "nowhere/hand.jpg";
  EXPECT_THAT(formats::message_of<InputError>([&] { make_hand_quick(request); }),
              HasSubstr("nowhere/hand.jpg"));
}

TEST(MakeHandQuick, AnUnknownPopulationIsNamed) {
  HandQuickRequest request;
  request.sizes = {{{hand::DimensionKind::kHandLength}, 181.0}};
  request.population = "ansur3";
  EXPECT_THAT(formats::message_of<Error>([&] { make_hand_quick(request); }), HasSubstr("ansur3"));
}

TEST(MakeHandQuick, StopsWhenItIsCancelled) {
  HandQuickRequest request;
  request.sizes = {{{hand::DimensionKind::kHandLength}, 181.0}};
  const std::atomic<bool> cancel{true};
  EXPECT_THROW(make_hand_quick(request, {.report = {}, .cancel = &cancel}), Cancelled);
}

}  // namespace
}  // namespace palmar::person_workflow
