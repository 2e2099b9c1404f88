// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/built_in_populations.h"

#include <cmath>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/population/segment_regressions.h"
#include "palmar/population/survey_figures.h"

namespace palmar {
namespace {

constexpr HandDimension kLength{DimensionKind::kHandLength};
constexpr HandDimension kCircumference{DimensionKind::kHandCircumference};
constexpr HandDimension kWidth{DimensionKind::kHandWidth};

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
constexpr const char* kSegmentCaution =
    "Segments are regressed: other people's scatter about the template's proportions (ANSUR II, "
    "Greiner 1991 at second hand, Buryanov & Kotiuk 2010).";
constexpr const char* kSoldierCaution =
    "Soldiers of 2010-2012, fit and of working age; grip strength is that of Germans of 30 years.";

std::string men_or_women(Sex sex) { return sex == Sex::kMale ? "men" : "women"; }

Eigen::MatrixXd ansur_correlation(const AnsurFigures& figures) {
  const double lc = figures.r_length_circumference, lw = figures.r_length_breadth,
               cw = figures.r_circumference_breadth;
  return Eigen::Matrix3d{{1.0, lc, lw}, {lc, 1.0, cw}, {lw, cw, 1.0}};
}

Stratum ansur2_stratum(Sex sex, double share) {
  const AnsurFigures& figures = ansur2_figures(sex);
  return {
      .name = men_or_women(sex),
      .sex = sex,
      .share = share,
      .age = kSoldiersAge,
      .driving = {{kLength, figures.length.mean, figures.length.sd, kAnsurSource},
                  {kCircumference, figures.circumference.mean, figures.circumference.sd,
                   kAnsurSource},
                  {kWidth, figures.breadth.mean, figures.breadth.sd, kAnsurSource}},
      .correlation = ansur_correlation(figures),
      .regressions = segment_regressions({sex, figures.length.mean, figures.circumference.mean})};
}

struct JapaneseMeans {
  int n;
  double length, breadth, circumference;  // mm
};
constexpr JapaneseMeans kJapaneseMen{327, 183.4, 83.3, 202.5};
constexpr JapaneseMeans kJapaneseWomen{203, 169.3, 74.4, 179.1};

Stratum japanese_stratum(Sex sex, double share) {
  const JapaneseMeans& means = sex == Sex::kMale ? kJapaneseMen : kJapaneseWomen;
  const AnsurFigures& ansur = ansur2_figures(sex);
  const auto driving = [](HandDimension dimension, double mean, const Moment& other) {
    return DrivingDimension{dimension, mean, mean * other.sd / other.mean,
                            std::string(kJapaneseMeans) + kBorrowedSpread, Evidence::kScaled};
  };
  return {.name = men_or_women(sex),
          .sex = sex,
          .share = share,
          .age = kAdultsAge,
          .driving = {driving(kLength, means.length, ansur.length),
                      driving(kCircumference, means.circumference, ansur.circumference),
                      driving(kWidth, means.breadth, ansur.breadth)},
          .correlation = ansur_correlation(ansur),
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
                  .driving = {{kLength, 184.0, 10.4, std::string(kSource) + ", Japanese database"},
                              {kCircumference, 193.0, 14.0,
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

Population ansur2_of(Sex sex) {
  const AnsurFigures& figures = ansur2_figures(sex);
  return {.name = "ansur2_" + men_or_women(sex),
          .title = std::string(sex == Sex::kMale ? "Men" : "Women") + " of the US Army, 2010-2012",
          .strata = {ansur2_stratum(sex, 1.0)},
          .source = std::string(kAnsurSource) + ", n = " + std::to_string(figures.n),
          .cautions = {kSoldierCaution, kSegmentCaution}};
}

Population ansur2() {
  const double men = ansur2_figures(Sex::kMale).n, women = ansur2_figures(Sex::kFemale).n;
  return {.name = "ansur2",
          .title = "Men and women of the US Army, 2010-2012",
          .strata = {ansur2_stratum(Sex::kMale, men / (men + women)),
                     ansur2_stratum(Sex::kFemale, women / (men + women))},
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

Population japanese_of(Sex sex) {
  const int n = sex == Sex::kMale ? kJapaneseMen.n : kJapaneseWomen.n;
  return {.name = "japanese_" + men_or_women(sex),
          .title = std::string("Japanese ") + men_or_women(sex) + ", 18-64 years",
          .strata = {japanese_stratum(sex, 1.0)},
          .source = std::string(kJapaneseMeans) + ", n = " + std::to_string(n) + kBorrowedSpread,
          .cautions = japanese_cautions()};
}

Population japanese() {
  const double men = kJapaneseMen.n, women = kJapaneseWomen.n;
  return {.name = "japanese",
          .title = "Japanese adults, 18-64 years",
          .strata = {japanese_stratum(Sex::kMale, men / (men + women)),
                     japanese_stratum(Sex::kFemale, women / (men + women))},
          .source = std::string(kJapaneseMeans) + ", n = 327 men and 203 women" + kBorrowedSpread,
          .cautions = [] {
            std::vector<std::string> cautions = japanese_cautions();
            cautions.insert(cautions.begin(), "In the survey's shares, three men to two women.");
            return cautions;
          }()};
}

/// A stratum of whom only length and breadth were measured: circumference follows from breadth with
/// ANSUR II's ratio, elasticity and relative residual of the same sex.
Stratum length_and_breadth_stratum(Sex sex, double share, double age, const Moment& hand,
                                   const Moment& breadth, const std::string& source) {
  const AnsurFigures& ansur = ansur2_figures(sex);
  const double girth = breadth.mean * ansur.circumference.mean / ansur.breadth.mean;
  const double r = ansur.r_circumference_breadth;
  const double elasticity = r * (ansur.circumference.sd / ansur.circumference.mean) /
                            (ansur.breadth.sd / ansur.breadth.mean);
  const double residual =
      ansur.circumference.sd / ansur.circumference.mean * std::sqrt(1.0 - r * r) * girth;
  std::vector<DimensionRegression> regressions = {
      {.dimension = kCircumference,
       .intercept = girth * (1.0 - elasticity),
       .terms = {{kWidth, elasticity * girth / breadth.mean}},
       .residual_sd = residual,
       .evidence = Evidence::kRegressed,
       .source = "ratio, elasticity and residual of ANSUR II " + men_or_women(sex)}};
  for (DimensionRegression& one : segment_regressions({sex, hand.mean, girth})) {
    regressions.push_back(std::move(one));
  }
  const double lw = ansur.r_length_breadth;
  return {.name = men_or_women(sex),
          .sex = sex,
          .share = share,
          .age = age,
          .driving = {{kLength, hand.mean, hand.sd, source},
                      {kWidth, breadth.mean, breadth.sd, source}},
          .correlation = Eigen::Matrix2d{{1.0, lw}, {lw, 1.0}},
          .regressions = std::move(regressions)};
}

Population delhi_men() {
  constexpr const char* kSource =
      "Kakkar & Kushwaha 2021, Hand index of the male Khatris of Delhi (abstract), n = 160";
  return {
      .name = "delhi_men",
      .title = "Khatri men of Delhi, 18-50 years",
      .strata = {length_and_breadth_stratum(Sex::kMale, 1.0, 35.0, {182.9, 11.2}, {80.5, 4.9},
                                            kSource)},
      .source = kSource,
      .cautions = {"Circumference wasn't measured: regressed from breadth as in ANSUR II men; "
                   "the correlation of length and breadth is ANSUR II's as well.",
                   "Age is taken as 35 years; grip strength is that of Germans.", kSegmentCaution}};
}

constexpr const char* kNigerians =
    "Ibeachu, Abu & Didia 2011, Asian J Med Sci 3(8):146-150 (abstract), right hands, n = 150 men "
    "and 150 women";

/// The abstract's +- (0.8 and 0.3 mm of men, 0.7 and 0.3 mm of women) can only be standard errors
/// of the mean: they are 0.4 % of it, while people scatter by 4 to 6 %. Times the square root of
/// 150 they are 9.8, 3.7, 8.6 and 3.7 mm; rounded to one digit they are sure to about 6 % (lengths)
/// and 17 % (breadths).
Stratum nigerian_stratum(Sex sex, double share) {
  const double root = std::sqrt(150.0);
  const bool is_man = sex == Sex::kMale;
  const Moment hand = is_man ? Moment{190.2, 0.8 * root} : Moment{176.2, 0.7 * root};
  const Moment breadth = is_man ? Moment{85.8, 0.3 * root} : Moment{76.9, 0.3 * root};
  return length_and_breadth_stratum(sex, share, 24.0, hand, breadth, kNigerians);
}

std::vector<std::string> nigerian_cautions() {
  return {
      "Students of one university. The abstract's scatter is taken as standard errors, as it "
      "is far too small for people; deviations are sure to 6 to 17 %.",
      "Circumference wasn't measured: regressed from breadth as in ANSUR II; the correlation "
      "of length and breadth is ANSUR II's as well.",
      "Age is taken as 24 years; grip strength is that of Germans.", kSegmentCaution};
}

Population nigerian_of(Sex sex) {
  return {.name = "nigerian_" + men_or_women(sex),
          .title = std::string("Students of Port Harcourt, Nigeria, ") + men_or_women(sex) +
                   ", 18-30 years",
          .strata = {nigerian_stratum(sex, 1.0)},
          .source = kNigerians,
          .cautions = nigerian_cautions()};
}

Population nigerian() {
  return {.name = "nigerian",
          .title = "Students of Port Harcourt, Nigeria, 18-30 years",
          .strata = {nigerian_stratum(Sex::kMale, 0.5), nigerian_stratum(Sex::kFemale, 0.5)},
          .source = kNigerians,
          .cautions = nigerian_cautions()};
}

}  // namespace

const std::vector<Population>& built_in_populations() {
  static const std::vector<Population> list = {xie2014(),
                                               ansur2_of(Sex::kMale),
                                               ansur2_of(Sex::kFemale),
                                               ansur2(),
                                               japanese_of(Sex::kMale),
                                               japanese_of(Sex::kFemale),
                                               japanese(),
                                               delhi_men(),
                                               nigerian_of(Sex::kMale),
                                               nigerian_of(Sex::kFemale),
                                               nigerian()};
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

}  // namespace palmar
