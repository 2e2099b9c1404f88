// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "population/population_table_commands.h"

#include <algorithm>
#include <memory>

#include "palmar/core/error.h"
#include "palmar/workflow/population/table_correlate.h"
#include "palmar/workflow/population/table_describe.h"
#include "palmar/workflow/population/table_regress.h"
#include "table_text.h"

namespace palmar::cli {
namespace {

std::vector<std::string> names_in(const std::string& option, const std::string& list) {
  std::vector<std::string> names;
  for (std::size_t start = 0; !list.empty() && start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    names.push_back(list.substr(start, end - start));
    if (names.back().empty()) throw UsageError(option + ": \"" + list + "\" has an empty name");
    start = end + 1;
  }
  return names;
}

/// Fields that go by other words.
const SettingOptions kTableOptions = {{"conditions", "--where"}, {"predictors", "--on"}};

/// What the three verbs share: the table, who of it, what of it.
struct TableArguments {
  workflow::TableChoice table;
  std::string dimensions, out;

  void add_to(CLI::App& verb) {
    verb.add_option("FILE", table.file,
                    "Table of subjects: CSV, one line per person, units in headings")
        ->required();
    verb.add_option("--by", table.by,
                    "Column whose values group the subjects: sex, age (by ten years) ...");
    verb.add_option("--where", table.conditions,
                    "Only subjects that meet it: sex=F, \"age>=40\"; may be given several times");
    verb.add_option("--dimension", dimensions, "Only these columns: A,B,...");
    verb.add_option("--unit", table.unit,
                    "Unit of hand dimensions whose heading names none: mm, cm, m, in");
    verb.add_option("--out", out, "Folder for tables (CSV) and pictures (SVG, PNG, PDF)");
  }

  workflow::TableChoice choice() const {
    workflow::TableChoice chosen = table;
    chosen.columns = names_in("--dimension", dimensions);
    return chosen;
  }
};

void add_level_to(CLI::App& verb, double& level) {
  verb.add_option("--confidence", level, "Confidence level")->capture_default_str();
}

workflow::NoteSink notes_for(const Context& context) {
  return [&context](const std::string& text) { note(context.common, text); };
}

void add_describe(CLI::App& noun, Context& context) {
  const auto o = std::make_shared<TableArguments>();
  CLI::App* verb =
      add_verb(noun, "describe", "Mean, deviation and percentiles of every dimension of a table",
               "palmar population describe hands.csv --by sex");
  o->add_to(*verb);
  verb->callback([&context, o] {
    context.setting_options = kTableOptions;
    context.run = [&context, o] {
      const records::Descriptions results = workflow::describe_table(
          {.table = o->choice(), .out = o->out, .note = notes_for(context)});
      print(context.common.json ? records::descriptions_json(results) + "\n"
                                : descriptions_text(results));
      return 0;
    };
  });
}

void add_correlate(CLI::App& noun, Context& context) {
  struct Options {
    TableArguments table;
    workflow::TableCorrelateRequest request;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(noun, "correlate",
               "Correlations between the dimensions of a table: r, interval, significance",
               "palmar population correlate hands.csv --by sex --out figures");
  o->table.add_to(*verb);
  add_level_to(*verb, o->request.level);
  verb->callback([&context, o] {
    context.setting_options = kTableOptions;
    context.run = [&context, o] {
      workflow::TableCorrelateRequest request = o->request;
      request.table = o->table.choice();
      request.out = o->table.out;
      request.note = notes_for(context);
      const records::Correlations results = workflow::correlate_table(request);
      print(context.common.json ? records::correlations_json(results) + "\n"
                                : correlations_text(results));
      return 0;
    };
  });
}

void add_regress(CLI::App& noun, Context& context) {
  struct Options {
    TableArguments table;
    std::string on;
    workflow::TableRegressRequest request;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(noun, "regress",
               "Every dimension on hand length and circumference; a population file for studies",
               "palmar population regress hands.csv --by sex --population-out our_people.toml");
  o->table.add_to(*verb);
  add_level_to(*verb, o->request.level);
  verb->add_option("--on", o->on,
                   "Predictors A,B,...; default: hand_length and hand_circumference");
  verb->add_option("--population-out", o->request.population_out,
                   "Population file (TOML) to write, driven by the predictors");
  verb->add_option("--name", o->request.name, "Name of the population; default: that of its file");
  verb->add_option("--title", o->request.title, "Title of the population, for people");
  verb->callback([&context, o] {
    context.setting_options = kTableOptions;
    context.run = [&context, o] {
      workflow::TableRegressRequest request = o->request;
      request.table = o->table.choice();
      request.predictors = names_in("--on", o->on);
      request.out = o->table.out;
      request.note = notes_for(context);
      const records::Regressions results = workflow::regress_table(request).regressions;
      if (!request.population_out.empty()) {
        note(context.common, "wrote " + request.population_out);
      }
      print(context.common.json ? records::regressions_json(results) + "\n"
                                : regressions_text(results));
      return 0;
    };
  });
}

}  // namespace

void add_population_table_verbs(CLI::App& population, Context& context) {
  add_describe(population, context);
  add_correlate(population, context);
  add_regress(population, context);
}

}  // namespace palmar::cli
