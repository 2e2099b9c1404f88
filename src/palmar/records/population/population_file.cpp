// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/population/population_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/formats/toml_section.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/segment_regressions.h"
#include "palmar/population/sex_names.h"

namespace palmar::records {
namespace {

constexpr std::uint64_t kMostPopulationBytes = 1 << 22;
constexpr double kLargestDimension = 400.0;  // mm; as fault_of() allows
constexpr double kLargestNumber = 1e6;       // of intercepts and slopes
constexpr double kSmallest = 1e-6;           // stands for "more than 0"

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

hand::HandDimension dimension_named(const formats::TomlSection& section, std::string_view key,
                                    const std::string& name) {
  if (const auto dimension = hand::hand_dimension_named(name)) return *dimension;
  std::vector<std::string> known;
  for (const hand::HandDimension one : hand::all_hand_dimensions()) known.push_back(name_of(one));
  section.fail(key, "names " + formats::in_quotes(name) + ", which is no dimension of a hand; " +
                        did_you_mean(name, known, "hand_length, index_middle_width ... are"));
}

hand::HandDimension dimension_of(const formats::TomlSection& section) {
  return dimension_named(section, "dimension", section.need_text("dimension"));
}

population::Evidence evidence_of(const formats::TomlSection& section,
                                 population::Evidence otherwise) {
  const auto word = section.text("evidence");
  if (!word) return otherwise;
  const auto evidence = population::evidence_named(*word);
  if (!evidence) {
    section.fail("evidence", "is " + formats::in_quotes(*word) +
                                 "; \"measured\", \"regressed\" or \"scaled\" is allowed");
  }
  return *evidence;
}

std::optional<grasp::Sex> sex_of(const formats::TomlSection& section) {
  const auto word = section.text("sex");
  if (!word) return std::nullopt;
  if (const auto sex = population::sex_named(*word)) return sex;
  section.fail("sex", "is " + formats::in_quotes(*word) + "; \"female\" or \"male\" is allowed");
}

/// Mean sizes [mm] that people can have, children to giants: wide about the template's.
std::array<double, 2> mean_range(hand::HandDimension dimension) {
  if (dimension.kind == hand::DimensionKind::kHandLength) return {60.0, 300.0};
  if (dimension.kind == hand::DimensionKind::kHandCircumference) return {70.0, 350.0};
  const double usual = hand::value_of(population::template_proportions(), dimension);
  return {0.4 * usual, 2.5 * usual};
}

void check_size(const formats::TomlSection& section, std::string_view key,
                hand::HandDimension dimension, double mean) {
  const auto [low, high] = mean_range(dimension);
  if (mean >= low && mean <= high) return;
  const bool is_cm = 10.0 * mean >= low && 10.0 * mean <= high;
  section.fail(key, "of " + name_of(dimension) + " is " + number_text(mean) + " mm; " +
                        number_text(low) + " to " + number_text(high) + " mm is allowed" +
                        (is_cm ? ": these figures look like cm" : ""));
}

population::DrivingDimension read_driving(const formats::TomlSection& section) {
  section.allow({"dimension", "mean_mm", "sd_mm", "evidence", "source"});
  population::DrivingDimension driving;
  driving.dimension = dimension_of(section);
  driving.mean = section.need_number("mean_mm", "mm", 1.0, kLargestDimension);
  check_size(section, "mean_mm", driving.dimension, driving.mean);
  driving.sd = section.number("sd_mm", "mm", kSmallest, 0.2 * driving.mean).value_or(0.0);
  driving.evidence = evidence_of(section, population::Evidence::kMeasured);
  driving.source = section.text("source").value_or("");
  return driving;
}

population::DimensionRegression read_regression(const formats::TomlSection& section) {
  section.allow({"dimension", "intercept_mm", "slope", "residual_sd_mm", "evidence", "source"});
  population::DimensionRegression regression;
  regression.dimension = dimension_of(section);
  regression.intercept =
      section.number("intercept_mm", "mm", -kLargestNumber, kLargestNumber).value_or(0.0);
  if (const auto slopes = section.table("slope")) {
    for (const auto& [key, ignored] : slopes->values()) {
      regression.terms.push_back(
          {dimension_named(*slopes, key.str(), std::string(key.str())),
           slopes->need_number(key.str(), "", -kLargestNumber, kLargestNumber)});
    }
  }
  regression.residual_sd =
      section.number("residual_sd_mm", "mm", 0.0, kLargestDimension).value_or(0.0);
  regression.evidence = evidence_of(section, population::Evidence::kRegressed);
  regression.source = section.text("source").value_or("");
  return regression;
}

Eigen::Index driving_index(const population::Stratum& stratum, hand::HandDimension dimension) {
  const auto found = std::find_if(stratum.driving.begin(), stratum.driving.end(),
                                  [&](const auto& one) { return one.dimension == dimension; });
  return found == stratum.driving.end() ? -1 : found - stratum.driving.begin();
}

void read_correlations(const formats::TomlSection& section, population::Stratum& stratum) {
  const auto n = static_cast<Eigen::Index>(stratum.driving.size());
  stratum.correlation = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXi is_given = Eigen::MatrixXi::Identity(n, n);
  for (const formats::TomlSection& pair : section.tables("correlation")) {
    pair.allow({"between", "r", "source"});
    const std::vector<std::string> names = pair.texts("between");
    if (names.size() != 2) {
      pair.fail("between names " + std::to_string(names.size()) +
                " dimensions; two driving dimensions are required");
    }
    std::array<Eigen::Index, 2> at{};
    for (std::size_t k = 0; k < 2; ++k) {
      at[k] = driving_index(stratum, dimension_named(pair, "between", names[k]));
      if (at[k] < 0) {
        pair.fail("between", "names " + formats::in_quotes(names[k]) +
                                 ", which doesn't drive this stratum; add it as "
                                 "[[stratum.driving]]");
      }
    }
    if (at[0] == at[1]) pair.fail("between", "names one dimension twice; two are required");
    if (is_given(at[0], at[1]) != 0) {
      pair.fail("between", "names a pair whose correlation is given already");
    }
    const double r = pair.need_number("r", "", -1.0, 1.0);
    if (r == 1.0 || r == -1.0)
      pair.fail("r", "is " + formats::shortest(r) + "; between -1 and 1 is allowed");
    stratum.correlation(at[0], at[1]) = stratum.correlation(at[1], at[0]) = r;
    is_given(at[0], at[1]) = is_given(at[1], at[0]) = 1;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const population::DrivingDimension& a = stratum.driving[j];
      const population::DrivingDimension& b = stratum.driving[i];
      if (is_given(i, j) != 0 || a.sd == 0.0 || b.sd == 0.0) continue;
      section.fail("correlation of " + name_of(a.dimension) + " and " + name_of(b.dimension) +
                   " is missing; [[stratum.correlation]] is required for every pair of driving "
                   "dimensions with a deviation");
    }
  }
}

population::Stratum read_stratum(const formats::TomlSection& section) {
  section.allow({"name", "sex", "share", "age_years", "driving", "correlation", "regression"});
  population::Stratum stratum;
  stratum.name = section.need_text("name");
  stratum.sex = sex_of(section);
  stratum.share = section.number("share", "", kSmallest, 1.0).value_or(1.0);
  stratum.age = section.number("age_years", "years", 0.0, 120.0);
  for (const formats::TomlSection& one : section.tables("driving")) {
    const population::DrivingDimension driving = read_driving(one);
    if (driving_index(stratum, driving.dimension) >= 0) {
      one.fail("dimension", "names " + name_of(driving.dimension) +
                                ", which drives this stratum already; each may appear once");
    }
    stratum.driving.push_back(driving);
  }
  read_correlations(section, stratum);
  for (const formats::TomlSection& one : section.tables("regression")) {
    stratum.regressions.push_back(read_regression(one));
    // What is wrong with this regression is reported where it stands.
    const std::string fault = population::fault_of(stratum);
    if (!fault.empty() && fault.starts_with("regression")) one.fail(fault);
    if (!fault.empty()) continue;
    const hand::HandDimension dimension = stratum.regressions.back().dimension;
    if (const auto moments = population::moments_of(stratum, dimension)) {
      check_size(one, "mean", dimension, moments->mean);
    }
  }
  const std::string fault = population::fault_of(stratum);
  if (!fault.empty()) section.fail("stratum \"" + stratum.name + "\": " + fault);
  return stratum;
}

void check_version(const formats::TomlSection& file) {
  const auto version = file.integer("version", 1, std::numeric_limits<int>::max());
  if (version.value_or(1) > kPopulationFileVersion) {
    file.fail("version", "is " + std::to_string(*version) + "; this program reads up to version " +
                             std::to_string(kPopulationFileVersion) +
                             " (a newer Palmar wrote the file)");
  }
}

std::string driving_toml(const population::DrivingDimension& driving) {
  std::string text = "\n[[stratum.driving]]\n";
  text += "dimension = " + formats::toml_string(name_of(driving.dimension)) + "\n";
  text += "mean_mm = " + formats::toml_number(driving.mean) + "\n";
  if (driving.sd > 0.0) text += "sd_mm = " + formats::toml_number(driving.sd) + "\n";
  text += "evidence = " + formats::toml_string(name_of(driving.evidence)) + "\n";
  if (!driving.source.empty()) text += "source = " + formats::toml_string(driving.source) + "\n";
  return text;
}

std::string regression_toml(const population::DimensionRegression& regression) {
  std::string text = "\n[[stratum.regression]]\n";
  text += "dimension = " + formats::toml_string(name_of(regression.dimension)) + "\n";
  text += "intercept_mm = " + formats::toml_number(regression.intercept) + "\n";
  std::string slopes;
  for (const population::DimensionRegression::Term& term : regression.terms) {
    slopes += (slopes.empty() ? " " : ", ") + name_of(term.predictor) + " = " +
              formats::toml_number(term.slope);
  }
  if (!slopes.empty()) text += "slope = {" + slopes + " }\n";
  text += "residual_sd_mm = " + formats::toml_number(regression.residual_sd) + "\n";
  text += "evidence = " + formats::toml_string(name_of(regression.evidence)) + "\n";
  if (!regression.source.empty())
    text += "source = " + formats::toml_string(regression.source) + "\n";
  return text;
}

std::string stratum_toml(const population::Stratum& stratum) {
  std::string text = "\n[[stratum]]\nname = " + formats::toml_string(stratum.name) + "\n";
  if (stratum.sex)
    text += "sex = " + formats::toml_string(population::name_of(*stratum.sex)) + "\n";
  text += "share = " + formats::toml_number(stratum.share) + "\n";
  if (stratum.age) text += "age_years = " + formats::toml_number(*stratum.age) + "\n";
  for (const population::DrivingDimension& one : stratum.driving) text += driving_toml(one);
  const auto n = static_cast<Eigen::Index>(stratum.driving.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j) {
      const auto name = [&](Eigen::Index k) {
        return formats::toml_string(name_of(stratum.driving[k].dimension));
      };
      text += "\n[[stratum.correlation]]\nbetween = [" + name(i) + ", " + name(j) + "]\n";
      text += "r = " + formats::toml_number(stratum.correlation(i, j)) + "\n";
    }
  }
  for (const population::DimensionRegression& one : stratum.regressions)
    text += regression_toml(one);
  return text;
}

}  // namespace

population::Population read_population(const std::string& path) {
  return parse_population(formats::read_file(path, kMostPopulationBytes), path);
}

population::Population parse_population(const std::string& text, const std::string& path) {
  const toml::table values = formats::parse_toml(text, path);
  const formats::TomlSection file(path, "", values);
  file.allow({"version", "name", "title", "source", "cautions", "stratum"});
  check_version(file);
  population::Population population;
  population.name = file.need_text("name");
  population.title = file.text("title").value_or(population.name);
  population.source = file.text("source").value_or("");
  population.cautions = file.texts("cautions");
  for (const formats::TomlSection& one : file.tables("stratum")) {
    population.strata.push_back(read_stratum(one));
  }
  const std::string fault = population::fault_of(population);
  if (!fault.empty()) file.fail(fault);
  return population;
}

population::Population load_population(const std::string& name_or_path) {
  return name_or_path.ends_with(".toml") ? read_population(name_or_path)
                                         : population::population_named(name_or_path);
}

std::string population_toml(const population::Population& population) {
  std::string text = "# Population of hands; see docs/using/populations.md. Lengths in mm.\n";
  text += "version = " + std::to_string(kPopulationFileVersion) + "\n";
  text += "name = " + formats::toml_string(population.name) + "\n";
  text += "title = " + formats::toml_string(population.title) + "\n";
  text += "source = " + formats::toml_string(population.source) + "\n";
  text += "cautions = [";
  for (const std::string& caution : population.cautions) {
    text += "\n  " + formats::toml_string(caution) + ",";
  }
  text += population.cautions.empty() ? "]\n" : "\n]\n";
  for (const population::Stratum& stratum : population.strata) text += stratum_toml(stratum);
  return text;
}

void write_population(const std::string& path, const population::Population& population) {
  population.check();
  formats::write_file(path, population_toml(population));
}

}  // namespace palmar::records
