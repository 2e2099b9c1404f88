// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/civilian_populations.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "palmar/population/segment_regressions.h"
#include "palmar/population/sex_names.h"
#include "palmar/population/survey_figures.h"

namespace palmar::population {
namespace {

constexpr hand::HandDimension kSurveyLength{hand::DimensionKind::kHandLength};
constexpr hand::HandDimension kSurveyGirth{hand::DimensionKind::kHandCircumference};
constexpr hand::HandDimension kSurveyBreadth{hand::DimensionKind::kHandWidth};

struct LengthAndBreadth {
  Moment length, breadth;  // mm
};

/// A survey that measured length and breadth of both sexes, and what is said about it.
struct Survey {
  std::string name;
  std::string of_men, of_women, of_both;  // titles
  double age = 0.0;                       // mean, years
  LengthAndBreadth men, women;
  std::string source;
  std::vector<std::string> cautions;
};

/// A stratum of whom only length and breadth were measured: circumference follows from breadth with
/// ANSUR II's ratio, elasticity and relative residual of the same sex.
Stratum length_and_breadth_stratum(grasp::Sex sex, double age, const LengthAndBreadth& figures,
                                   const std::string& source) {
  const Moment &hand = figures.length, &breadth = figures.breadth;
  const AnsurFigures& ansur = ansur2_figures(sex);
  const double girth = breadth.mean * ansur.circumference.mean / ansur.breadth.mean;
  const double r = ansur.r_circumference_breadth;
  const double elasticity = r * (ansur.circumference.sd / ansur.circumference.mean) /
                            (ansur.breadth.sd / ansur.breadth.mean);
  const double residual =
      ansur.circumference.sd / ansur.circumference.mean * std::sqrt(1.0 - r * r) * girth;
  std::vector<DimensionRegression> regressions = {
      {.dimension = kSurveyGirth,
       .intercept = girth * (1.0 - elasticity),
       .terms = {{kSurveyBreadth, elasticity * girth / breadth.mean}},
       .residual_sd = residual,
       .evidence = Evidence::kRegressed,
       .source = "ratio, elasticity and residual of ANSUR II " + people_of(sex)}};
  for (DimensionRegression& one : segment_regressions({sex, hand.mean, girth})) {
    regressions.push_back(std::move(one));
  }
  const double lw = ansur.r_length_breadth;
  return {.name = people_of(sex),
          .sex = sex,
          .share = 1.0,
          .age = age,
          .driving = {{kSurveyLength, hand.mean, hand.sd, source},
                      {kSurveyBreadth, breadth.mean, breadth.sd, source}},
          .correlation = Eigen::Matrix2d{{1.0, lw}, {lw, 1.0}},
          .regressions = std::move(regressions)};
}

Population population_of(const Survey& survey, std::string name, std::string title,
                         std::vector<Stratum> strata) {
  Population population{.name = std::move(name),
                        .title = std::move(title),
                        .strata = std::move(strata),
                        .source = survey.source,
                        .cautions = survey.cautions};
  population.cautions.emplace_back(kSegmentCaution);
  return population;
}

std::vector<Stratum> halves(Stratum one, Stratum other) {
  one.share = other.share = 0.5;
  return {std::move(one), std::move(other)};
}

/// The survey's men, its women, and half of each.
void add(const Survey& survey, std::vector<Population>& list) {
  const Stratum men =
      length_and_breadth_stratum(grasp::Sex::kMale, survey.age, survey.men, survey.source);
  const Stratum women =
      length_and_breadth_stratum(grasp::Sex::kFemale, survey.age, survey.women, survey.source);
  list.push_back(population_of(survey, survey.name + "_men", survey.of_men, {men}));
  list.push_back(population_of(survey, survey.name + "_women", survey.of_women, {women}));
  list.push_back(population_of(survey, survey.name, survey.of_both, halves(men, women)));
}

constexpr const char* kGirth =
    "Circumference wasn't measured: regressed from breadth as in ANSUR II; the correlation of "
    "length and breadth is ANSUR II's as well.";
constexpr const char* kSecondHand =
    "The survey's figures are taken from a third party's transcription.";
constexpr const char* kRounded =
    "Means and deviations are rounded to 1 mm; deviations of breadth are sure to 10 to 17 %.";

std::string age_caution(int years) {
  return "Age is taken as " + std::to_string(years) + " years; grip strength is that of Germans.";
}

Population delhi_men() {
  Survey survey;
  survey.source =
      "Kakkar & Kushwaha 2021, Hand index of the male Khatris of Delhi (abstract), n = 160";
  survey.cautions = {
      "Circumference wasn't measured: regressed from breadth as in ANSUR II men; "
      "the correlation of length and breadth is ANSUR II's as well.",
      age_caution(35)};
  return population_of(survey, "delhi_men", "Khatri men of Delhi, 18-50 years",
                       {length_and_breadth_stratum(grasp::Sex::kMale, 35.0,
                                                   {{182.9, 11.2}, {80.5, 4.9}}, survey.source)});
}

/// The abstract's +- (0.8 and 0.3 mm of men, 0.7 and 0.3 mm of women) can only be standard errors
/// of the mean: they are 0.4 % of it, while people scatter by 4 to 6 %. Times the square root of
/// 150 they are 9.8, 3.7, 8.6 and 3.7 mm; rounded to one digit they are sure to about 6 % (lengths)
/// and 17 % (breadths).
Survey nigerian() {
  const double root = std::sqrt(150.0);
  const std::string students = "Students of Port Harcourt, Nigeria, ";
  return {.name = "nigerian",
          .of_men = students + "men, 18-30 years",
          .of_women = students + "women, 18-30 years",
          .of_both = students + "18-30 years",
          .age = 24.0,
          .men = {{190.2, 0.8 * root}, {85.8, 0.3 * root}},
          .women = {{176.2, 0.7 * root}, {76.9, 0.3 * root}},
          .source =
              "Ibeachu, Abu & Didia 2011, Asian J Med Sci 3(8):146-150 (abstract), right "
              "hands, n = 150 men and 150 women",
          .cautions = {"Students of one university. The abstract's scatter is taken as standard "
                       "errors, as it is far too small for people; deviations are sure to 6 to "
                       "17 %.",
                       kGirth, age_caution(24)}};
}

Survey mexican() {
  return {.name = "mexican",
          .of_men = "Men of north-west Mexico, 15-59 years",
          .of_women = "Women of north-west Mexico, 15-59 years",
          .of_both = "People of north-west Mexico, 15-59 years",
          .age = 34.0,
          .men = {{188.2, 8.5}, {87.9, 5.1}},
          .women = {{174.6, 8.0}, {78.0, 5.2}},
          .source =
              "Rodriguez-Vega & Rodriguez-Vega 2024, European Public & Social Innovation "
              "Review 9, doi 10.31637/epsir-2024-932, table 3, n = 2275 men and 562 women",
          .cautions = {kSecondHand, kGirth, age_caution(34)}};
}

// DINED's own page (dined.io.tudelft.nl), saved by a third party; it gives no numbers of people.
constexpr const char* kDined = "DINED (TU Delft), web page at second hand: ";

Survey dutch() {
  return {.name = "dutch",
          .of_men = "Dutch men, 20-60 years",
          .of_women = "Dutch women, 20-60 years",
          .of_both = "Dutch adults, 20-60 years",
          .age = 40.0,
          .men = {{196.0, 11.0}, {91.0, 5.0}},
          .women = {{178.0, 8.0}, {80.0, 4.0}},
          .source = std::string(kDined) + "Dutch adults 20-60 (DINED 2004)",
          .cautions = {kRounded, kGirth, age_caution(40)}};
}

Survey dutch_over_60() {
  return {.name = "dutch_over_60",
          .of_men = "Dutch men over 60 years",
          .of_women = "Dutch women over 60 years",
          .of_both = "Dutch people over 60 years",
          .age = 70.0,
          .men = {{191.0, 10.0}, {90.0, 5.0}},
          .women = {{178.0, 9.0}, {81.0, 4.0}},
          .source = std::string(kDined) + "Dutch adults 60+ (DINED 2004)",
          .cautions = {kRounded, kGirth, age_caution(70)}};
}

Survey dutch_over_80() {
  return {.name = "dutch_over_80",
          .of_men = "Dutch men over 80 years",
          .of_women = "Dutch women over 80 years",
          .of_both = "Dutch people over 80 years",
          .age = 84.0,
          .men = {{188.0, 12.0}, {89.0, 4.0}},
          .women = {{174.0, 9.0}, {80.0, 4.0}},
          .source = std::string(kDined) + "Dutch elderly 80+ (Geron 1998)",
          .cautions = {kRounded, kGirth, age_caution(84)}};
}

Survey beijing_over_65() {
  return {.name = "beijing_over_65",
          .of_men = "Men of Beijing over 65 years",
          .of_women = "Women of Beijing over 65 years",
          .of_both = "People of Beijing over 65 years",
          .age = 72.0,
          .men = {{179.0, 8.1}, {84.0, 4.5}},
          .women = {{168.0, 8.1}, {78.0, 4.2}},
          .source = "Hu et al. 2007, Int J Ind Ergon 37:303-311, n = 50 men and 58 women",
          .cautions = {kSecondHand, kGirth, age_caution(72)}};
}

/// Length, circumference at the metacarpals and breadth were all measured; only their correlations
/// are borrowed.
Population indian_women() {
  Survey survey;
  survey.source = "Nag, Nag & Desai 2003, Indian J Med Res 117:260-269, n = 95";
  survey.cautions = {
      "Women of workshops in Ahmedabad. The survey's figures are taken from a third party's "
      "transcription; correlations are ANSUR II's.",
      age_caution(33)};
  const Moment length{169.6, 9.4}, girth{172.3, 10.6}, breadth{68.0, 5.1};
  return population_of(
      survey, "indian_women", "Working women of Ahmedabad, India, 16-58 years",
      {{.name = people_of(grasp::Sex::kFemale),
        .sex = grasp::Sex::kFemale,
        .share = 1.0,
        .age = 33.0,
        .driving = {{kSurveyLength, length.mean, length.sd, survey.source},
                    {kSurveyGirth, girth.mean, girth.sd, survey.source},
                    {kSurveyBreadth, breadth.mean, breadth.sd, survey.source}},
        .correlation = ansur_correlation(grasp::Sex::kFemale),
        .regressions = segment_regressions({grasp::Sex::kFemale, length.mean, girth.mean})}});
}

struct ChildRow {
  int age;  // completed years
  LengthAndBreadth boys, girls;
};
// DINED, Dutch children (survey KIMA of 1993). Of younger ones some fingers are shorter than half
// of the template's, which can't be scaled to them.
constexpr std::array<ChildRow, 9> kDutchChildren = {
    {{4, {{119.0, 7.0}, {56.0, 3.0}}, {{118.0, 7.0}, {55.0, 3.0}}},
     {5, {{127.0, 7.0}, {60.0, 3.0}}, {{126.0, 6.0}, {58.0, 3.0}}},
     {6, {{133.0, 6.0}, {62.0, 3.0}}, {{132.0, 7.0}, {61.0, 3.0}}},
     {7, {{139.0, 7.0}, {64.0, 3.0}}, {{138.0, 7.0}, {64.0, 3.0}}},
     {8, {{145.0, 7.0}, {66.0, 3.0}}, {{143.0, 7.0}, {65.0, 3.0}}},
     {9, {{151.0, 7.0}, {69.0, 4.0}}, {{149.0, 8.0}, {66.0, 4.0}}},
     {10, {{156.0, 9.0}, {71.0, 4.0}}, {{156.0, 8.0}, {69.0, 4.0}}},
     {11, {{161.0, 9.0}, {73.0, 4.0}}, {{161.0, 9.0}, {71.0, 4.0}}},
     {12, {{167.0, 10.0}, {74.0, 4.0}}, {{166.0, 11.0}, {72.0, 5.0}}}}};

Population dutch_children(const ChildRow& row) {
  const std::string years = std::to_string(row.age);
  Survey survey;
  survey.source = kDined + ("Dutch children of " + years + " years (KIMA 1993)");
  survey.cautions = {
      kRounded, kGirth,
      "Fingers have adults' proportions, tissue adults' stiffness, joints adults' range.",
      "Grip strength isn't known below 17 years, so it excludes nobody. The usual grip force is "
      "adults': state one that children can give."};
  Stratum boys = length_and_breadth_stratum(grasp::Sex::kMale, row.age, row.boys, survey.source);
  Stratum girls =
      length_and_breadth_stratum(grasp::Sex::kFemale, row.age, row.girls, survey.source);
  boys.name = "boys";
  girls.name = "girls";
  return population_of(survey, "dutch_children_" + years, "Dutch children of " + years + " years",
                       halves(std::move(boys), std::move(girls)));
}

}  // namespace

std::vector<Population> civilian_populations() {
  std::vector<Population> list = {delhi_men()};
  add(nigerian(), list);
  add(mexican(), list);
  list.push_back(indian_women());
  add(dutch(), list);
  add(dutch_over_60(), list);
  add(dutch_over_80(), list);
  add(beijing_over_65(), list);
  for (const ChildRow& row : kDutchChildren) list.push_back(dutch_children(row));
  return list;
}

}  // namespace palmar::population
