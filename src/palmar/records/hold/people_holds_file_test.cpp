// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hold/people_holds_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

std::string header() {
  std::string text = "object,subject";
  for (const char* point : {"wrist", "thumb", "index", "middle", "ring", "little"}) {
    for (const char axis : {'x', 'y', 'z'}) text += fmt::format(",{}_{}_mm", point, axis);
  }
  return text + ",spread_mm,up_x,up_y,up_z\n";
}

/// 0, 1, 2 ... 17 from `first` on.
std::string row(const std::string& object, double first) {
  std::string text = object + ",01";
  for (int k = 0; k < 18; ++k) text += fmt::format(",{}", first + k);
  return text + ",4.5,0,3,4\n";
}

class PeopleHoldsFile : public testing::Test {
 protected:
  std::string file(const std::string& text, const std::string& name = "people.csv") const {
    formats::write_file((folder_.path() / name).string(), text);
    return (folder_.path() / name).string();
  }
  template <class Read>
  std::string message(const std::string& path, const Read& read) const {
    try {
      read(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  formats::TestFolder folder_;
};

TEST_F(PeopleHoldsFile, HasHoldsByObject) {
  const std::vector<PeopleHolds> people =
      read_people_holds(file(header() + row("box", 0) + row("can", 100) + row("box", 50)));
  ASSERT_EQ(people.size(), 2U);
  EXPECT_EQ(people[0].object, "box");
  ASSERT_EQ(people[0].holds.size(), 2U);
  EXPECT_EQ(people[0].holds[0].points.wrist(), Vec3(0, 1, 2));
  EXPECT_EQ(people[0].holds[1].points.tip(4), Vec3(65, 66, 67));
  EXPECT_LT((people[0].holds[0].up - Vec3(0.0, 0.6, 0.8)).norm(), 1e-12);
  EXPECT_EQ(people[1].holds[0].points.tip(0), Vec3(103, 104, 105));
}

TEST_F(PeopleHoldsFile, SaysWhatIsWrongWithIt) {
  const auto why = [&](const std::string& text) {
    return message(file(text), [](const std::string& path) { read_people_holds(path); });
  };
  EXPECT_THAT(why("object,wrist_x_mm\nbox,1\n"), HasSubstr("no column \"wrist_y_mm\""));
  EXPECT_THAT(why(header()), HasSubstr("no holds below the header"));
  std::string far = row("box", 0);
  far.replace(far.find(",17,"), 4, ",17000,");
  EXPECT_THAT(why(header() + far), HasSubstr("people.csv:2: little_z_mm is 17000 mm; 5000 mm"));
  EXPECT_THAT(why(header() + row("", 0)), HasSubstr("people.csv:2: object is empty"));
  std::string flat = row("box", 0);
  flat.replace(flat.find(",0,3,4"), 6, ",0,0,0");
  EXPECT_THAT(why(header() + flat),
              HasSubstr("people.csv:2: up_x, up_y and up_z have no direction"));
  std::string none = row("box", 0);
  none.replace(none.find(",17,"), 4, ",,");
  EXPECT_THAT(why(header() + none), HasSubstr("people.csv:2"));
}

TEST_F(PeopleHoldsFile, WeightsReadBackExactly) {
  const grasp::HoldWeights& weights = grasp::hand_over_weights();
  const std::string path = file(hold_weights_toml(weights), "weights.toml");
  const grasp::HoldWeights back = read_hold_weights(path);
  EXPECT_EQ(back.weight, weights.weight);
  EXPECT_EQ(back.mean, weights.mean);
  EXPECT_EQ(back.spread, weights.spread);
  EXPECT_EQ(back.unseen, weights.unseen);
}

TEST_F(PeopleHoldsFile, WeightsOfAnotherKindAreRefused) {
  const auto why = [&](const std::string& text) {
    return message(file(text, "weights.toml"),
                   [](const std::string& path) { read_hold_weights(path); });
  };
  const std::string good = hold_weights_toml(grasp::hand_over_weights());
  EXPECT_THAT(why("[depth]\nweight = 1\nmean = 0\nspread = 1\n"),
              HasSubstr("table [fingers_on_it] is missing"));
  EXPECT_THAT(why(good + "[depths]\n"), HasSubstr("did you mean depth?"));
  std::string flat = good;
  const std::size_t at = flat.find("spread = ");
  flat.replace(at, flat.find('\n', at) - at, "spread = 0");
  EXPECT_THAT(why(flat), HasSubstr("spread"));
  std::string odd = good;
  odd.replace(odd.find("weight = "), 9, "weights = ");
  EXPECT_THAT(why(odd), HasSubstr("did you mean weight?"));
}

}  // namespace
}  // namespace palmar::records
