// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/search_story.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>

#include "palmar/records/csv.h"
#include "palmar/report/chart/line_chart.h"
#include "palmar/report/chart/scatter_chart.h"

namespace palmar::workflow {
namespace {

using Json = nlohmann::ordered_json;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + ", " + unit;
}

/// "fillet_long_mm": a heading as CSV files have it.
std::string heading(const std::string& name, const std::string& unit) {
  std::string text;
  for (const char c : name + (unit.empty() ? "" : "_" + unit)) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_plain) {
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!text.empty() && text.back() != '_') {
      text += '_';
    }
  }
  return name.ends_with("_" + unit) ? text.substr(0, text.size() - unit.size() - 1) : text;
}

std::string cell(double value) { return fmt::format("{:.6g}", value); }

/// "3, 7, 12", counted from 1.
std::string numbers_of(const std::vector<int>& candidates) {
  std::string text;
  for (const int i : candidates) text += fmt::format("{}{}", text.empty() ? "" : ", ", i + 1);
  return text;
}

bool may_be_chosen(const redesign::SearchTrial& trial) {
  return trial.is_feasible && !trial.outcome.is_rough();
}

}  // namespace

void run_search(SearchStory& story, const CandidateJudge& judge,
                const redesign::SearchOptions& options, const Progress& progress) {
  redesign::SearchProblem& problem = story.problem;
  problem.evaluate = [&](const std::vector<double>& values) {
    story.beside.emplace_back();
    return judge(values, story.beside.back());
  };
  story.result = problem.variables.empty() ? redesign::as_given(problem)
                                           : redesign::search_features(problem, options, progress);
  problem.evaluate = nullptr;  // what they refer to ends with the search
  problem.measure = nullptr;
}

bool is_better_than_original(const SearchStory& story) {
  const double best = story.result.history[static_cast<size_t>(*story.result.best)].outcome.goal;
  return story.goal.is_lower_better ? best < story.original.value : best > story.original.value;
}

std::string history_csv(const SearchStory& story) {
  records::CsvTable table;
  table.header = {"candidate"};
  for (const redesign::SearchVariable& variable : story.problem.variables) {
    table.header.push_back(heading(variable.name, variable.unit));
  }
  table.header.push_back(heading(story.goal.name, story.goal.unit));
  table.header.emplace_back("standard_error");
  for (const redesign::SearchConstraint& constraint : story.problem.constraints) {
    table.header.push_back(heading(constraint.name, constraint.unit));
  }
  for (std::size_t u = 0; u < story.uses.size(); ++u) {
    table.header.push_back(fmt::format("use_{}_by_original", u + 1));
  }
  for (const char* const name :
       {"hands", "grip_force_ratio", "volume_ratio", "is_feasible", "failure", "seconds"}) {
    table.header.emplace_back(name);
  }
  for (size_t i = 0; i < story.result.history.size(); ++i) {
    const redesign::SearchTrial& trial = story.result.history[i];
    const bool is_made = trial.outcome.failure.empty();
    std::vector<std::string> row = {std::to_string(i + 1)};
    for (const double value : trial.values) row.push_back(cell(value));
    row.push_back(is_made ? cell(trial.outcome.goal) : "");
    row.push_back(is_made && trial.outcome.goal_error > 0.0 ? cell(trial.outcome.goal_error) : "");
    for (size_t k = 0; k < story.problem.constraints.size(); ++k) {
      row.push_back(is_made ? cell(trial.outcome.constraint[k]) : "");
    }
    for (std::size_t u = 0; u < story.uses.size(); ++u) {
      row.push_back(is_made && u < story.beside[i].by_use.size() ? cell(story.beside[i].by_use[u])
                                                                 : "");
    }
    row.push_back(is_made ? std::to_string(story.beside[i].hands) : "");
    row.push_back(is_made ? cell(story.beside[i].grip_force_ratio) : "");
    row.push_back(is_made ? cell(story.beside[i].volume_ratio) : "");
    row.push_back(trial.is_feasible ? "yes" : "no");
    row.push_back(trial.outcome.failure);
    row.push_back(fmt::format("{:.2f}", trial.seconds));
    table.rows.push_back(std::move(row));
  }
  return records::format_csv(table);
}

std::string history_json(const SearchStory& story) {
  Json variables = Json::array(), constraints = Json::array(), history = Json::array();
  for (const redesign::SearchVariable& one : story.problem.variables) {
    variables.push_back({{"name", one.name},
                         {"unit", one.unit},
                         {"lowest", one.lowest},
                         {"highest", one.highest},
                         {"start", one.start},
                         {"step", one.step}});
  }
  for (const redesign::SearchConstraint& one : story.problem.constraints) {
    constraints.push_back({{"name", one.name},
                           {"unit", one.unit},
                           {one.is_highest ? "highest" : "lowest", one.limit}});
  }
  for (size_t i = 0; i < story.result.history.size(); ++i) {
    const redesign::SearchTrial& trial = story.result.history[i];
    Json one = {{"values", trial.values}, {"is_feasible", trial.is_feasible}};
    if (trial.outcome.failure.empty()) {
      one["goal"] = trial.outcome.goal;
      one["standard_error"] =
          trial.outcome.goal_error > 0.0 ? Json(trial.outcome.goal_error) : Json();
      one["is_broken_off"] = trial.outcome.is_rough();
      one["constraints"] = trial.outcome.constraint;
      one["hands"] = story.beside[i].hands;
      one["lost_hands"] = story.beside[i].lost;
      one["grip_force_ratio"] = story.beside[i].grip_force_ratio;
      one["volume_ratio"] = story.beside[i].volume_ratio;
      if (!story.beside[i].by_use.empty()) one["by_use"] = story.beside[i].by_use;
    } else {
      one["failure"] = trial.outcome.failure;
    }
    history.push_back(std::move(one));
  }
  Json json = {{"goal",
                {{"key", story.goal.key},
                 {"name", story.goal.name},
                 {"unit", story.goal.unit},
                 {"better", story.goal.is_lower_better ? "lower" : "higher"}}},
               {"original", story.original.value},
               {"uses", story.uses},
               {"optimiser", story.result.method},
               {"ending", story.result.ending},
               {"variables", std::move(variables)},
               {"constraints", std::move(constraints)},
               {"best", story.result.best ? Json(*story.result.best) : Json()},
               {"history", std::move(history)}};
  return json.dump();
}

std::string history_svg(const SearchStory& story) {
  report::LineSeries all{.name = "candidate", .points = {}};
  report::LineSeries best{
      .name = "best within the constraints", .points = {}, .colour = {190, 80, 60}};
  std::optional<double> lead;
  for (size_t i = 0; i < story.result.history.size(); ++i) {
    const redesign::SearchTrial& trial = story.result.history[i];
    const double x = static_cast<double>(i + 1);
    if (trial.outcome.failure.empty()) all.points.emplace_back(x, trial.outcome.goal);
    if (may_be_chosen(trial) &&
        (!lead ||
         (story.goal.is_lower_better ? trial.outcome.goal < *lead : trial.outcome.goal > *lead))) {
      lead = trial.outcome.goal;
    }
    if (lead) best.points.emplace_back(x, *lead);
  }
  std::vector<report::LineChart> charts = {{.title = "Search: " + story.goal.name,
                                            .x_label = "Candidate",
                                            .y_label = with_unit("Goal", story.goal.unit),
                                            .series = {all, best}}};
  if (story.problem.variables.size() == 1) {
    const redesign::SearchVariable& variable = story.problem.variables.front();
    report::LineSeries over{.name = "", .points = {}};
    for (const redesign::SearchTrial& trial : story.result.history) {
      if (trial.outcome.failure.empty()) {
        over.points.emplace_back(trial.values.front(), trial.outcome.goal);
      }
    }
    charts.push_back({.title = story.goal.name,
                      .x_label = with_unit(variable.name, variable.unit),
                      .y_label = with_unit("Goal", story.goal.unit),
                      .series = {over}});
  }
  return report::svg_stack(charts);
}

std::vector<int> fair_choices(const SearchStory& story) {
  const auto is_better = [&](double a, double b) {
    return story.goal.is_lower_better ? a < b : a > b;
  };
  std::vector<int> feasible;
  for (std::size_t i = 0; i < story.result.history.size(); ++i) {
    if (may_be_chosen(story.result.history[i])) feasible.push_back(static_cast<int>(i));
  }
  const auto change = [&](int i) {
    return story.beside[static_cast<std::size_t>(i)].largest_change;
  };
  const auto goal = [&](int i) {
    return story.result.history[static_cast<std::size_t>(i)].outcome.goal;
  };
  std::stable_sort(feasible.begin(), feasible.end(), [&](int a, int b) {
    return change(a) != change(b) ? change(a) < change(b) : is_better(goal(a), goal(b));
  });
  std::vector<int> fair;
  for (const int i : feasible) {
    if (fair.empty() || is_better(goal(i), goal(fair.back()))) fair.push_back(i);
  }
  return fair;
}

std::vector<int> fair_uses(const SearchStory& story) {
  const auto is_drawn = [&](std::size_t i) {
    return may_be_chosen(story.result.history[i]) && !story.beside[i].by_use.empty();
  };
  const double sense = story.goal.is_lower_better ? 1.0 : -1.0;
  const auto beats = [&](std::size_t a, std::size_t b) {
    bool is_better = false;
    for (std::size_t u = 0; u < story.uses.size(); ++u) {
      const double by = sense * (story.beside[a].by_use[u] - story.beside[b].by_use[u]);
      if (by > 0.0) return false;
      is_better = is_better || by < 0.0;
    }
    return is_better;
  };
  std::vector<int> fair;
  for (std::size_t i = 0; i < story.result.history.size(); ++i) {
    if (!is_drawn(i)) continue;
    bool is_beaten = false;
    for (std::size_t k = 0; k < story.result.history.size() && !is_beaten; ++k) {
      is_beaten = k != i && is_drawn(k) && beats(k, i);
    }
    if (!is_beaten) fair.push_back(static_cast<int>(i));
  }
  std::stable_sort(fair.begin(), fair.end(), [&](int a, int b) {
    return story.beside[static_cast<std::size_t>(a)].by_use.front() <
           story.beside[static_cast<std::size_t>(b)].by_use.front();
  });
  return fair;
}

std::vector<report::Figure> uses_figures(const SearchStory& story) {
  std::vector<report::Figure> figures;
  const std::vector<int> fair = fair_uses(story);
  for (std::size_t u = 1; u < story.uses.size(); ++u) {
    const auto point = [&](std::size_t i) {
      const std::vector<double>& by_use = story.beside[i].by_use;
      return Eigen::Vector2d(100.0 * by_use.front(), 100.0 * by_use[u]);
    };
    report::ScatterSeries all{
        .name = "candidates", .points = {}, .line = {}, .colour = {150, 150, 150}};
    report::ScatterSeries front{.name = "none is better in every use", .points = {}, .line = {}};
    report::ScatterSeries best{.name = "the redesign", .points = {}, .line = {}};
    report::ScatterSeries original{.name = "the original", .points = {{100.0, 100.0}}, .line = {}};
    front.colour = report::series_colour(1);
    original.colour = report::series_colour(2);
    best.colour = report::series_colour(3);
    // Every candidate once, as points that lie on one another take each other's colour.
    for (std::size_t i = 0; i < story.result.history.size(); ++i) {
      if (!may_be_chosen(story.result.history[i]) || story.beside[i].by_use.empty()) continue;
      const int number = static_cast<int>(i);
      const bool is_fair = std::find(fair.begin(), fair.end(), number) != fair.end();
      const bool is_best = story.result.best && *story.result.best == number;
      (is_best ? best : is_fair ? front : all).points.push_back(point(i));
    }
    // With more than two uses the front is no line in this picture.
    for (const int i : story.uses.size() == 2 ? fair : std::vector<int>{}) {
      const Eigen::Vector2d at = point(static_cast<std::size_t>(i));
      front.line.x.push_back(at.x());
      front.line.value.push_back(at.y());
    }
    figures.push_back(
        report::scatter_chart({.title = "What one use costs the other",
                               .x_label = story.uses.front() + ": goal, % of the original's",
                               .y_label = story.uses[u] + ": goal, % of the original's",
                               .series = {all, front, original, best},
                               .notes = {"candidates of the front: " + numbers_of(fair)}}));
  }
  return figures;
}

std::string choices_svg(const SearchStory& story) { return report::to_svg(choices_figure(story)); }

report::Figure choices_figure(const SearchStory& story) {
  report::ScatterSeries all{
      .name = "candidates", .points = {}, .line = {}, .colour = {150, 150, 150}};
  report::ScatterSeries fair{.name = "none moves less and is better", .points = {}, .line = {}};
  report::ScatterSeries original{
      .name = "the original", .points = {{0.0, story.original.value}}, .line = {}};
  fair.colour = report::series_colour(1);
  original.colour = report::series_colour(2);
  const auto point = [&](std::size_t i) {
    return Eigen::Vector2d(story.beside[i].largest_change, story.result.history[i].outcome.goal);
  };
  for (std::size_t i = 0; i < story.result.history.size(); ++i) {
    if (story.result.history[i].is_feasible) all.points.push_back(point(i));
  }
  const std::vector<int> choices = fair_choices(story);
  for (const int i : choices) {
    fair.points.push_back(point(static_cast<std::size_t>(i)));
    fair.line.x.push_back(fair.points.back().x());
    fair.line.value.push_back(fair.points.back().y());
  }
  return report::scatter_chart(
      {.title = "What a gain costs",
       .x_label = "largest change of the surface, mm",
       .y_label = with_unit(story.goal.name, story.goal.unit),
       .series = {all, fair, original},
       .notes = {"joined, from the left: candidates " + numbers_of(choices)}});
}

}  // namespace palmar::workflow
