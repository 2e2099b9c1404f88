// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/table_population.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "palmar/core/error.h"
#include "palmar/population/palm_ruler.h"
#include "palmar/population/sex_names.h"
#include "palmar/population/table_statistics.h"

namespace palmar::population {
namespace {

constexpr int kSmallGroup = 30;
constexpr double kSignificant = 0.05;
constexpr const char* kProportion = "; mean in the template's proportion";

/// The regression that the population keeps of one dimension.
const TableRegression& kept(const std::vector<TableRegression>& regressions,
                            const std::string& name) {
  for (const TableRegression& r : regressions) {
    if (r.name != name || r.predictors.size() < 2) continue;
    const bool all_help =
        std::all_of(r.fit.slopes.begin(), r.fit.slopes.end(),
                    [](const statistics::Coefficient& c) { return c.p_value < kSignificant; });
    if (all_help) return r;
  }
  return regressions[best_predictor(regressions, name)];
}

std::string rounded(double value, int places) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", places, value);
  return text.data();
}

std::string sentence(const TableRegression& r, const std::string& source) {
  return source + ": linear regression, n = " + std::to_string(r.fit.n) +
         ", R2 = " + rounded(r.fit.r2, 3);
}

/// Palm lengths that reach further than Palmar's, brought into the template's proportion at the
/// mean hand of each group; they change and scatter as measured. Says so in `cautions`.
std::vector<TableGroup> with_our_palm(std::vector<TableGroup> groups,
                                      std::vector<std::string>& cautions) {
  for (TableGroup& group : groups) {
    const auto share = palm_share(group.table);
    if (!share || *share <= kLargestPalmShare) continue;
    const double factor = template_palm_share() / *share;
    for (TableColumn& column : group.table.columns) {
      if (column.name != kPalmLength) continue;
      for (auto& value : column.values) {
        if (value) *value *= factor;
      }
    }
    cautions.push_back(group.name + ": palm_length is measured as " + rounded(100.0 * *share, 1) +
                       " % of hand length; from the wrist crease to the base crease of the middle "
                       "finger, as Palmar measures, it is " +
                       rounded(100.0 * template_palm_share(), 1) + " %. It is taken times " +
                       rounded(factor, 3) +
                       ": the mean is in the template's proportion, only how it varies is "
                       "measured. Left out of the table, it follows in proportion altogether");
  }
  return groups;
}

Stratum stratum_of(const TableGroup& group, const std::vector<std::string>& driving,
                   const std::string& source, bool is_converted,
                   std::vector<std::string>& cautions) {
  Stratum stratum;
  stratum.name = group.name;
  const DimensionTable table = having(group.table, driving);
  if (table.subjects() < 3) {
    table.fail(0, table.column(driving[0]),
               std::to_string(table.subjects()) + " subjects of \"" + group.name +
                   "\" have all driving dimensions; at least 3 are needed");
  }
  for (const ColumnDescription& d : describe(table, driving)) {
    DrivingDimension dimension;
    dimension.dimension = *hand::hand_dimension_named(d.name);
    dimension.mean = d.summary->mean;
    dimension.sd = d.summary->sd;
    dimension.source = source + ", n = " + std::to_string(d.summary->n);
    if (is_converted && d.name == kPalmLength) {
      dimension.evidence = Evidence::kScaled;
      dimension.source += kProportion;
    }
    stratum.driving.push_back(dimension);
  }
  stratum.correlation = Eigen::MatrixXd::Identity(1, 1);
  if (driving.size() > 1) stratum.correlation = correlate(table, driving).r;
  std::vector<std::string> others;
  for (const TableColumn& column : table.columns) {
    if (!column.dimension || !column.is_number) continue;
    if (std::find(driving.begin(), driving.end(), column.name) != driving.end()) continue;
    const auto known = std::count_if(column.values.begin(), column.values.end(),
                                     [](const auto& value) { return value.has_value(); });
    if (known == 0) continue;
    others.push_back(column.name);
  }
  const std::vector<TableRegression> regressions =
      others.empty() ? std::vector<TableRegression>{} : regress(table, driving, others);
  for (const std::string& name : others) {
    const TableRegression& r = kept(regressions, name);
    DimensionRegression regression;
    regression.dimension = *hand::hand_dimension_named(name);
    regression.intercept = r.fit.intercept.estimate;
    for (std::size_t k = 0; k < r.predictors.size(); ++k) {
      regression.terms.push_back(
          {*hand::hand_dimension_named(r.predictors[k]), r.fit.slopes[k].estimate});
    }
    // In the order that a file keeps them.
    std::sort(regression.terms.begin(), regression.terms.end(), [](const auto& a, const auto& b) {
      return name_of(a.predictor) < name_of(b.predictor);
    });
    regression.residual_sd = r.fit.residual_sd;
    regression.evidence = Evidence::kMeasured;
    regression.source = sentence(r, source);
    if (is_converted && name == kPalmLength) {
      regression.evidence = Evidence::kRegressed;
      regression.source += kProportion;
    }
    stratum.regressions.push_back(std::move(regression));
  }
  if (table.subjects() < kSmallGroup) {
    cautions.push_back(group.name + ": only " + std::to_string(table.subjects()) +
                       " subjects; means and deviations are uncertain");
  }
  return stratum;
}

/// What is known of all people of a group: their sex and mean age.
void add_sex_and_age(const DimensionTable& table, Stratum& stratum, bool& is_mixed) {
  for (const TableColumn& column : table.columns) {
    if (column.quantity == Quantity::kAge && column.is_number) {
      std::vector<double> ages;
      for (const auto& age : column.values) {
        if (age) ages.push_back(*age);
      }
      if (!ages.empty()) stratum.age = statistics::summarise(ages).mean;
    }
    if ((column.name != "sex" && column.name != "gender") || column.is_number) continue;
    std::optional<grasp::Sex> sex;
    bool is_one = true;
    for (const std::string& text : column.texts) {
      const auto one = sex_of_text(text);
      if (!one) continue;
      if (sex && *sex != *one) is_one = false;
      sex = one;
    }
    if (is_one) {
      stratum.sex = sex;
    } else {
      is_mixed = true;
    }
  }
}

}  // namespace

Population population_of_table(const std::vector<TableGroup>& as_measured,
                               const std::vector<std::string>& driving, const std::string& name,
                               const std::string& title) {
  Population population;
  const std::vector<TableGroup> groups = with_our_palm(as_measured, population.cautions);
  population.name = name;
  population.title = title;
  std::vector<std::string> names;
  for (const std::string& driver : driving) {
    const TableColumn& column = groups.front().table.column(driver);
    if (!column.dimension) {
      throw UsageError("a population is driven by dimensions of a hand; \"" + column.header +
                       "\" is none that Palmar knows");
    }
    names.push_back(column.name);
  }
  int subjects = 0;
  for (const TableGroup& group : groups) subjects += group.table.subjects();
  // The path of the file says nothing to others; its name does.
  const std::string& path = groups.front().table.source;
  population.source =
      path.substr(path.find_last_of('/') + 1) + ", " + std::to_string(subjects) + " subjects";
  bool is_mixed = false;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const TableGroup& group = groups[g];
    const bool is_converted = palm_share(as_measured[g].table).value_or(0.0) > kLargestPalmShare;
    Stratum stratum =
        stratum_of(group, names, population.source, is_converted, population.cautions);
    stratum.share = static_cast<double>(group.table.subjects()) / subjects;
    add_sex_and_age(group.table, stratum, is_mixed);
    population.strata.push_back(std::move(stratum));
  }
  if (is_mixed) {
    population.cautions.push_back(
        "men and women in one normal distribution; part the table by sex for two");
  }
  const bool has_strength =
      std::all_of(population.strata.begin(), population.strata.end(),
                  [](const Stratum& stratum) { return stratum.sex && stratum.age; });
  if (!has_strength) {
    population.cautions.push_back(
        "grip strength isn't known: it needs groups of one sex each and a column age");
  }
  population.check();
  return population;
}

}  // namespace palmar::population
