// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/tissue_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/hand/tissue.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string temporary_tissue(const std::string& name) { return formats::own_file(name); }

hand::Tissue read_text(const std::string& toml) {
  const std::string path = temporary_tissue("text.toml");
  formats::write_file(path, toml);
  return read_tissue(path, hand::default_tissue());
}

std::string tissue_message(const std::string& toml) {
  try {
    read_text(toml);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

const hand::RegionTissue& of(const hand::Tissue& tissue, hand::Region region) {
  return tissue.region[index_of(region)];
}

void expect_same_law(const hand::StiffeningLaw& a, const hand::StiffeningLaw& b) {
  constexpr double kUnits = 1e-15;  // relative; the change of unit and back rounds
  EXPECT_NEAR(a.g0, b.g0, kUnits * b.g0);
  EXPECT_NEAR(a.g_limit, b.g_limit, kUnits * b.g_limit);
  EXPECT_DOUBLE_EQ(a.limit_depth, b.limit_depth);
}

TEST(TissueFile, ReadBackIsTheSameSet) {
  hand::Tissue tissue = hand::default_tissue();
  tissue.source = "somebody's \"own\" fingers\nand palms";
  hand::RegionTissue& thumb = tissue.region[index_of(hand::Region::kThumbDistal)];
  thumb.layered.high = {0.0123456789, 0.1 / 3.0, 2.5};
  thumb.source = "thumb alone";
  thumb.swelling_width = 1.0 / 3.0;
  tissue.region[index_of(hand::Region::kHypothenar)].poisson_layered = 0.45;
  const std::string path = temporary_tissue("same.toml");
  write_tissue(path, tissue);
  const hand::Tissue back = read_tissue(path, hand::Tissue());  // nothing comes from the base
  EXPECT_EQ(back.source, tissue.source);
  for (int r = 0; r < hand::kRegionCount; ++r) {
    SCOPED_TRACE(name_of(static_cast<hand::Region>(r)));
    const hand::RegionTissue& a = back.region[r];
    const hand::RegionTissue& b = tissue.region[r];
    for (const hand::TissueLevel level :
         {hand::TissueLevel::kLow, hand::TissueLevel::kNominal, hand::TissueLevel::kHigh}) {
      expect_same_law(hand::law_at(a.half_space, level), hand::law_at(b.half_space, level));
      expect_same_law(hand::law_at(a.layered, level), hand::law_at(b.layered, level));
    }
    EXPECT_DOUBLE_EQ(a.poisson_layered, b.poisson_layered);
    EXPECT_DOUBLE_EQ(a.swelling_width, b.swelling_width);
    EXPECT_DOUBLE_EQ(a.neighbourhood, b.neighbourhood);
    EXPECT_EQ(a.source, b.source);
  }
  const std::string first = formats::read_file(path);
  write_tissue(path, back);
  EXPECT_EQ(formats::read_file(path), first) << "writing again must give the same bytes";
}

TEST(TissueFile, AGroupReachesItsRegionsAndARegionOverridesItsGroup) {
  const hand::Tissue tissue = read_text(
      "[finger.half_space]\n"
      "g0_kpa = 8\n"
      "[region.index_distal.half_space]\n"
      "g0_kpa = 9.5\n"
      "[palm]\n"
      "swelling_height_mm = 0\n"
      "source = \"flat\"\n");
  EXPECT_DOUBLE_EQ(of(tissue, hand::Region::kLittleMiddle).half_space.nominal.g0, 0.008);
  EXPECT_DOUBLE_EQ(of(tissue, hand::Region::kIndexDistal).half_space.nominal.g0, 0.0095);
  EXPECT_DOUBLE_EQ(of(tissue, hand::Region::kThenar).half_space.nominal.g0, 0.0275);  // as it was
  EXPECT_EQ(of(tissue, hand::Region::kDorsum), of(hand::default_tissue(), hand::Region::kDorsum));
  EXPECT_EQ(of(tissue, hand::Region::kUlnarPalm).swelling_height, 0.0);
  EXPECT_EQ(of(tissue, hand::Region::kUlnarPalm).source, "flat");
}

TEST(TissueFile, AValueWithoutARangeHasNone) {
  const hand::Tissue tissue = read_text(
      "[palm.half_space]\n"
      "g0_kpa = 20\n"
      "g_limit_low_kpa = 35\n"
      "g_limit_kpa = 50\n"
      "g_limit_high_kpa = 65\n");
  const hand::TissueStiffness& palm = of(tissue, hand::Region::kThenar).half_space;
  EXPECT_DOUBLE_EQ(palm.low.g0, 0.020);
  EXPECT_DOUBLE_EQ(palm.high.g0, 0.020);
  EXPECT_DOUBLE_EQ(palm.low.g_limit, 0.035);
  EXPECT_DOUBLE_EQ(palm.nominal.g_limit, 0.050);
  EXPECT_DOUBLE_EQ(palm.high.g_limit, 0.065);
  EXPECT_DOUBLE_EQ(palm.high.limit_depth, 7.0);
}

TEST(TissueFile, UnknownKeysNameTheNearestOne) {
  EXPECT_THAT(tissue_message("[finger.half_space]\ng0_mpa = 5\n"),
              HasSubstr("text.toml:2: [finger.half_space]: key \"g0_mpa\" is not known; did you "
                        "mean g0_kpa?"));
  EXPECT_THAT(tissue_message("[fingers]\n"), HasSubstr("did you mean finger?"));
  EXPECT_THAT(tissue_message("[finger]\nswelling_hight_mm = 1\n"), HasSubstr("swelling_height_mm"));
  EXPECT_THAT(tissue_message("[finger.halfspace]\ng0_kpa = 1\n"), HasSubstr("half_space"));
  EXPECT_THAT(tissue_message("[region.index_tip]\n"), HasSubstr("index_distal"));
  EXPECT_THAT(tissue_message("[palm]\nzzz = 1\n"), HasSubstr("allowed are source, half_space"));
}

TEST(TissueFile, WrongValuesNameKeyValueAndWhatIsAllowed) {
  EXPECT_THAT(tissue_message("[finger.half_space]\n\ng0_kpa = -5\n"),
              HasSubstr("text.toml:3: [finger.half_space] g0_kpa is -5 kPa; 0.001 to 10000 kPa is "
                        "allowed"));
  EXPECT_THAT(tissue_message("[finger.half_space]\ng0_kpa = \"5\"\n"),
              HasSubstr("g0_kpa is no number; 0.001 to 10000 kPa is allowed"));
  EXPECT_THAT(tissue_message("[finger.half_space]\ng0_kpa = nan\n"), HasSubstr("g0_kpa is nan"));
  EXPECT_THAT(tissue_message("[finger.half_space]\nlimit_depth_mm = true\n"),
              HasSubstr("no number"));
  EXPECT_THAT(tissue_message("[finger]\npoisson_layered = 0.7\n"),
              HasSubstr("poisson_layered is 0.7; 0 to 0.5 is allowed"));
  EXPECT_THAT(tissue_message("[finger]\nsource = 7\n"), HasSubstr("source must be text in quotes"));
  EXPECT_THAT(tissue_message("finger = 7\n"), HasSubstr("must be a table, as in [finger]"));
  EXPECT_THAT(tissue_message("region = 7\n"), HasSubstr("must be a table"));
  EXPECT_THAT(tissue_message("[region]\nthenar = 7\n"),
              HasSubstr("[region.thenar] must be a table"));
  EXPECT_THAT(tissue_message("[finger]\nlayered = 7\n"), HasSubstr("must be a table"));
  EXPECT_THAT(tissue_message("[finger.half_space]\ng0_kpa = 200\n"),
              HasSubstr("G_lim is 95 kPa, below G0, 200 kPa"));
  EXPECT_THAT(tissue_message("[palm.half_space]\ng0_high_kpa = 10\n"),
              HasSubstr("ascending values are required"));
}

TEST(TissueFile, NewerVersionsAndBrokenFilesAreRefused) {
  EXPECT_THAT(tissue_message("version = 2\n"), HasSubstr("version 2; this program reads up to"));
  EXPECT_THAT(tissue_message("version = 0\n"), HasSubstr("whole number"));
  EXPECT_THAT(tissue_message("[finger\ng0_kpa = 5\n"), HasSubstr("text.toml:1: no TOML: "));
  EXPECT_THAT(tissue_message("[finger.half_space]\ng0_kpa = 5\ng0_kpa = 6\n"),
              HasSubstr(":3: no TOML"));
  EXPECT_THROW(read_tissue(temporary_tissue("missing.toml"), hand::default_tissue()), InputError);
  EXPECT_THROW(read_tissue(::testing::TempDir(), hand::default_tissue()), InputError);
}

TEST(TissueFile, EveryTruncationIsRefusedOrReadsAsPartOfTheSet) {
  const std::string whole = tissue_toml(hand::default_tissue());
  for (std::size_t length = 1; length < whole.size(); length += 13) {
    const std::string message = tissue_message(whole.substr(0, length));
    if (message == "no error") continue;  // cut between two lines, or inside a number
    EXPECT_THAT(message, HasSubstr("text.toml")) << length;
  }
}

}  // namespace
}  // namespace palmar::records
