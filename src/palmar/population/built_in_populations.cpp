// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/built_in_populations.h"

#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/population/civilian_populations.h"
#include "palmar/population/segment_regressions.h"
#include "palmar/population/sex_names.h"
#include "palmar/population/survey_figures.h"

namespace palmar::population {
namespace {

// Mean ages aren't among the figures: soldiers about 30, adults of 18-64 years about 40. They only
// choose the row of the grip strength table.
constexpr double kSoldiersAge = 30.0, kAdultsAge = 40.0;  // years

constexpr const char* kAnsurSource =
    "ANSUR II (Gordon et al. 2014, 2012 Anthropometric Survey of U.S. Army Personnel); moments of "
    "the public files";
constexpr const char* kJapaneseMeans =
    "mean of the AIST Japanese hand data (Kouchi 2012), second-hand via sizea.jp/palm-size";
constexpr const char* kBorrowedSpread =
    "; coefficient of variation and correlations borrowed from ANSUR II, same sex";
constexpr const char* kSoldierCaution =
    "Soldiers of 2010-2012, fit and of working age; grip strength is that of Germans of 30 years.";

Stratum ansur2_stratum(grasp::Sex sex, double share) {
  const AnsurFigures& figures = ansur2_figures(sex);
  return {
      .name = people_of(sex),
      .sex = sex,
      .share = share,
      .age = kSoldiersAge,
      .driving = {{hand::kHandLengthDimension, figures.length.mean, figures.length.sd,
                   kAnsurSource},
                  {hand::kCircumferenceDimension, figures.circumference.mean,
                   figures.circumference.sd, kAnsurSource},
                  {hand::kHandWidthDimension, figures.breadth.mean, figures.breadth.sd,
                   kAnsurSource}},
      .correlation = ansur_correlation(sex),
      .regressions = segment_regressions({sex, figures.length.mean, figures.circumference.mean})};
}

struct JapaneseMeans {
  int n;
  double length, breadth, circumference;  // mm
};
constexpr JapaneseMeans kJapaneseMen{327, 183.4, 83.3, 202.5};
constexpr JapaneseMeans kJapaneseWomen{203, 169.3, 74.4, 179.1};

Stratum japanese_stratum(grasp::Sex sex, double share) {
  const JapaneseMeans& means = sex == grasp::Sex::kMale ? kJapaneseMen : kJapaneseWomen;
  const AnsurFigures& ansur = ansur2_figures(sex);
  const auto driving = [](hand::HandDimension dimension, double mean, const Moment& other) {
    return DrivingDimension{dimension, mean, mean * other.sd / other.mean,
                            std::string(kJapaneseMeans) + kBorrowedSpread, Evidence::kScaled};
  };
  return {
      .name = people_of(sex),
      .sex = sex,
      .share = share,
      .age = kAdultsAge,
      .driving = {driving(hand::kHandLengthDimension, means.length, ansur.length),
                  driving(hand::kCircumferenceDimension, means.circumference, ansur.circumference),
                  driving(hand::kHandWidthDimension, means.breadth, ansur.breadth)},
      .correlation = ansur_correlation(sex),
      .regressions = segment_regressions({sex, means.length, means.circumference})};
}

Population xie2014() {
  constexpr const char* kSource = "Xie 2014, 5.4";
  return {
      .name = "xie2014",
      .title = "Preset of the thesis (Xie 2014)",
      .strata = {{.name = "adults",
                  .sex = std::nullopt,
                  .share = 1.0,
                  .age = std::nullopt,
                  .driving = {{hand::kHandLengthDimension, 184.0, 10.4,
                               std::string(kSource) + ", Japanese database"},
                              {hand::kCircumferenceDimension, 193.0, 14.0,
                               std::string(kSource) + ", Japanese database"}},
                  .correlation = Eigen::Matrix2d{{1.0, 0.36}, {0.36, 1.0}},
                  .regressions = {}}},
      .source =
          "Xie 2014, section 5.4: hand length and circumference from a Japanese hand "
          "database, their correlation from the thesis' own 20 subjects (18 men, 2 women)",
      .cautions = {"Mixes the sexes: the mean length is that of Japanese men, the mean "
                   "circumference that of men and women together, and one normal distribution "
                   "represents two. Hands as drawn are longer and narrower than people's.",
                   "The correlation, 0.36, comes from 20 other people; surveys find 0.56 to 0.59 "
                   "within a sex and 0.70 over both.",
                   "The thesis' regressions of the segments are lost: segments follow in the "
                   "template's proportions, lengths the hand length, the rest the circumference.",
                   "Grip strength isn't known: the sexes aren't distinguished."}};
}

Population ansur2_of(grasp::Sex sex) {
  const AnsurFigures& figures = ansur2_figures(sex);
  return {.name = "ansur2_" + people_of(sex),
          .title = std::string(sex == grasp::Sex::kMale ? "Men" : "Women") +
                   " of the US Army, 2010-2012",
          .strata = {ansur2_stratum(sex, 1.0)},
          .source = std::string(kAnsurSource) + ", n = " + std::to_string(figures.n),
          .cautions = {kSoldierCaution, kSegmentCaution}};
}

Population ansur2() {
  const double men = ansur2_figures(grasp::Sex::kMale).n,
               women = ansur2_figures(grasp::Sex::kFemale).n;
  return {.name = "ansur2",
          .title = "Men and women of the US Army, 2010-2012",
          .strata = {ansur2_stratum(grasp::Sex::kMale, men / (men + women)),
                     ansur2_stratum(grasp::Sex::kFemale, women / (men + women))},
          .source = std::string(kAnsurSource) + ", n = 4082 men and 1986 women",
          .cautions = {"In the survey's shares, two men to a woman, so that its pooled moments are "
                       "met; people at large are half women.",
                       kSoldierCaution, kSegmentCaution}};
}

std::vector<std::string> japanese_cautions() {
  return {
      "Only means are known, and at second hand. Deviations are the means times ANSUR II's "
      "coefficients of variation, correlations are ANSUR II's.",
      "Age is taken as 40 years (adults of 18 to 64); grip strength is that of Germans.",
      kSegmentCaution};
}

Population japanese_of(grasp::Sex sex) {
  const int n = sex == grasp::Sex::kMale ? kJapaneseMen.n : kJapaneseWomen.n;
  return {.name = "japanese_" + people_of(sex),
          .title = std::string("Japanese ") + people_of(sex) + ", 18-64 years",
          .strata = {japanese_stratum(sex, 1.0)},
          .source = std::string(kJapaneseMeans) + ", n = " + std::to_string(n) + kBorrowedSpread,
          .cautions = japanese_cautions()};
}

Population japanese() {
  const double men = kJapaneseMen.n, women = kJapaneseWomen.n;
  return {.name = "japanese",
          .title = "Japanese adults, 18-64 years",
          .strata = {japanese_stratum(grasp::Sex::kMale, men / (men + women)),
                     japanese_stratum(grasp::Sex::kFemale, women / (men + women))},
          .source = std::string(kJapaneseMeans) + ", n = 327 men and 203 women" + kBorrowedSpread,
          .cautions = [] {
            std::vector<std::string> cautions = japanese_cautions();
            cautions.insert(cautions.begin(), "In the survey's shares, three men to two women.");
            return cautions;
          }()};
}

}  // namespace

const std::vector<Population>& built_in_populations() {
  static const std::vector<Population> list = [] {
    std::vector<Population> all = {
        xie2014(), ansur2_of(grasp::Sex::kMale),   ansur2_of(grasp::Sex::kFemale),
        ansur2(),  japanese_of(grasp::Sex::kMale), japanese_of(grasp::Sex::kFemale),
        japanese()};
    for (Population& one : civilian_populations()) all.push_back(std::move(one));
    return all;
  }();
  return list;
}

const Population& population_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Population& population : built_in_populations()) {
    if (population.name == name) return population;
    names.push_back(population.name);
  }
  throw UsageError(
      "population \"" + name + "\" is not known; " +
      did_you_mean(name, names, "built in are " + joined(names, ", ") + "; a file ends in .toml"));
}

}  // namespace palmar::population
