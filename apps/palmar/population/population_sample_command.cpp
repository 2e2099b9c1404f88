// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "population/population_sample_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/hand_profile.h"
#include "palmar/records/population/hand_sample_table.h"
#include "palmar/records/population/population_file.h"
#include "palmar/workflow/population/population_sample.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNameOrFile = "Built-in population (see list) or a file ending in .toml";

void add_list(CLI::App& noun, Context& context) {
  CLI::App* verb = add_verb(noun, "list", "Populations and profiles that come with Palmar",
                            "palmar population list");
  verb->callback([&context] {
    context.run = [&context] {
      Json populations = Json::array(), profiles = Json::array();
      std::string text = "populations\n";
      for (const population::Population& one : population::built_in_populations()) {
        populations.push_back({{"name", one.name}, {"title", one.title}, {"source", one.source}});
        text += fmt::format("  {:<16} {}\n", one.name, one.title);
      }
      text +=
          "people from one size to another, for assess, study and redesign\n"
          "  woman:P5..man:P95   women of P5 and P50, men of P50 and P95 (ANSUR II); the same as "
          "small-to-large\n"
          "  woman:P5..woman:P95 women of P5, P50 and P95; men alike\n"
          "profiles\n";
      for (const population::HandProfile& one : population::built_in_profiles()) {
        profiles.push_back({{"name", one.name},
                            {"range_share", one.range_share},
                            {"strength_share", one.strength_share},
                            {"glove_thickness_mm", one.glove_thickness},
                            {"nail_length_mm", one.nail_length},
                            {"size_factor", one.size_factor},
                            {"source", one.source}});
        text += fmt::format(
            "  {:<16} range {:.2f}, strength {:.2f}, glove {:g} mm, nails {:g} mm, "
            "size {:.2f}\n",
            one.name, one.range_share, one.strength_share, one.glove_thickness, one.nail_length,
            one.size_factor);
      }
      print(context.common.json
                ? Json{{"populations", populations}, {"profiles", profiles}}.dump(2) + "\n"
                : text);
      return 0;
    };
  });
}

std::string dimension_line(hand::HandDimension dimension, double mean, double sd,
                           population::Evidence evidence, const std::string& source) {
  return fmt::format("  {:<26} {:>7.1f} {:>6} {:<9} {}\n", name_of(dimension), mean,
                     sd > 0.0 ? fmt::format("{:.1f}", sd) : "-", name_of(evidence), source);
}

std::string population_text(const population::Population& population) {
  std::string text =
      fmt::format("{}: {}\nsource: {}\n", population.name, population.title, population.source);
  for (const population::Stratum& stratum : population.strata) {
    text += fmt::format("\n{}, {:.1f} % of the population", stratum.name, 100.0 * stratum.share);
    if (stratum.sex && stratum.age) {
      const auto strength = grasp::grip_strength(*stratum.sex, *stratum.age);
      if (strength) {
        text +=
            fmt::format(", {:g} years, grip strength {:.0f} +- {:.0f} N", *stratum.age, *strength,
                        grasp::grip_strength_sd(*stratum.sex, *stratum.age).value_or(0.0));
      }
    }
    text += fmt::format("\n  {:<26} {:>7} {:>6} {:<9} {}\n", "dimension, mm", "mean", "SD",
                        "known as", "source");
    for (const population::DrivingDimension& one : stratum.driving) {
      text += dimension_line(one.dimension, one.mean, one.sd, one.evidence, one.source);
    }
    for (const population::DimensionRegression& one : stratum.regressions) {
      const population::DimensionMoments moments =
          population::moments_of(stratum, one.dimension).value();
      text += dimension_line(one.dimension, moments.mean, moments.sd, one.evidence, one.source);
    }
    text += fmt::format("  {:<26} {:>7} {:>6} {:<9} {}\n", "all others", "", "", "scaled",
                        "in the template's proportions");
    for (std::size_t i = 0; i < stratum.driving.size(); ++i) {
      for (std::size_t j = i + 1; j < stratum.driving.size(); ++j) {
        text += fmt::format(
            "  correlation of {} and {}: {:.3f}\n", name_of(stratum.driving[i].dimension),
            name_of(stratum.driving[j].dimension),
            stratum.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
    }
  }
  if (!population.cautions.empty()) text += "\ncautions\n";
  for (const std::string& caution : population.cautions) text += "  " + caution + "\n";
  return text;
}

void add_show(CLI::App& noun, Context& context) {
  struct Arguments {
    std::string population, out;
  };
  const auto o = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(
      noun, "show", "Dimensions of a population: mean, deviation, how each is known, cautions",
      "palmar population show ansur2_women");
  verb->add_option("POPULATION", o->population, kNameOrFile)->required();
  verb->add_option("--out", o->out, "Population file to write: .toml; to edit or to keep");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      const population::Population population = records::load_population(o->population);
      if (!o->out.empty()) {
        records::write_population(o->out, population);
        note(context.common, "wrote " + o->out);
        return 0;
      }
      print(context.common.json ? records::population_json(population)
                                : population_text(population));
      return 0;
    };
  });
}

struct SampleArguments {
  workflow::PopulationSampleRequest request;
  std::string design = name_of(population::SamplingOptions{}.design), percentiles;
  bool without_residuals = false, as_csv = false;
  const CLI::Option* design_option = nullptr;
  bool is_design_given() const { return design_option->count() > 0; }
};

population::SamplingDesign parse_design(const std::string& name) {
  if (const auto design = population::sampling_design_named(name)) return *design;
  std::vector<std::string> known;
  for (const population::SamplingDesign one : population::kSamplingDesigns)
    known.push_back(name_of(one));
  const std::string nearest = nearest_name(name, known);
  throw UsageError("--design " + name + ": " +
                   (nearest.empty() ? "random, latin_hypercube, boundary or percentiles is allowed"
                                    : "did you mean " + nearest + "?"));
}

void add_sample(CLI::App& noun, Context& context) {
  const auto o = std::make_shared<SampleArguments>();
  population::SamplingOptions& sampling = o->request.sampling;
  CLI::App* verb = add_verb(noun, "sample", "Sample hands of a population, one row each",
                            "palmar population sample ansur2 --hands 30 --out hands.csv");
  verb->add_option("POPULATION", o->request.population, kNameOrFile)->required();
  verb->add_option("--hands", sampling.hands, "Number of hands (random, latin_hypercube)")
      ->capture_default_str();
  o->design_option =
      verb->add_option("--design", o->design, "random, latin_hypercube, boundary or percentiles")
          ->capture_default_str();
  verb->add_option("--boundary", sampling.boundary, "Share of people inside the boundary hands")
      ->capture_default_str();
  verb->add_option("--points", sampling.boundary_points,
                   "Number of boundary hands beside the mean one")
      ->capture_default_str();
  verb->add_option("--percentiles", o->percentiles,
                   "Hands at these percentiles of every stratum: a list as in 5,50,95 (design "
                   "percentiles)");
  verb->add_flag("--no-residuals", o->without_residuals,
                 "Leave out the scatter of regressed dimensions about their regressions");
  verb->add_flag("--csv", o->as_csv, "Table on stdout (as without --json)");
  verb->add_option("--out", o->request.out, "File to write: .csv, or .json");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      workflow::PopulationSampleRequest request = o->request;
      request.sampling.design = parse_design(o->design);
      request.sampling.seed = context.common.seed;
      request.sampling.residuals = !o->without_residuals;
      if (!o->percentiles.empty()) {
        // Who asks for percentiles means them; another design would leave them out unseen.
        if (o->is_design_given() &&
            request.sampling.design != population::SamplingDesign::kPercentiles) {
          throw UsageError("--percentiles goes with --design percentiles, not with --design " +
                           o->design);
        }
        request.sampling.design = population::SamplingDesign::kPercentiles;
        request.sampling.percentiles = workflow::parse_list("--percentiles", o->percentiles);
      }
      request.note = [&context](const std::string& text) { note(context.common, text); };
      const auto [population, hands] = workflow::sample_population(request);
      if (!request.out.empty()) {
        note(context.common, fmt::format("wrote {} ({} hands)", request.out, hands.size()));
      } else if (context.common.json && !o->as_csv) {
        print(records::hand_sample_json(population, request.sampling, hands));
      } else {
        print(records::format_csv(records::hand_sample_table(hands)));
      }
      return 0;
    };
  });
}

}  // namespace

void add_population_sample_verbs(CLI::App& population, Context& context) {
  add_list(population, context);
  add_show(population, context);
  add_sample(population, context);
}

}  // namespace palmar::cli
