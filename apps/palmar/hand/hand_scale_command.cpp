// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_scale_command.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/population/dimension_table_file.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct ScaleArguments {
  std::string hand = "template", table, row, out;
  std::optional<double> length, circumference, width, thickness, palm_length, factor;
  std::vector<std::string> dimensions;
};

hand::HandDimension dimension_for(const std::string& name) {
  if (const auto dimension = hand::hand_dimension_named(name)) return *dimension;
  std::vector<std::string> names;
  for (const hand::HandDimension dimension : hand::all_hand_dimensions())
    names.push_back(name_of(dimension));
  const std::string nearest = nearest_name(name, names);
  throw UsageError("--dimension: \"" + name + "\" is not a dimension of a hand; " +
                   (nearest.empty() ? "index_proximal_length, for one, is allowed"
                                    : "did you mean " + nearest + "?"));
}

/// Rows whose cell in a column of text is `label`.
std::vector<std::size_t> rows_with(const population::TableColumn& column,
                                   const std::string& label) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < column.texts.size(); ++i) {
    if (column.texts[i] == label) rows.push_back(i);
  }
  return rows;
}

/// The one row of `rows`; throws UsageError if there are several.
std::size_t only_row(const std::vector<std::size_t>& rows, const population::DimensionTable& table,
                     const population::TableColumn& column, const std::string& label) {
  if (rows.size() == 1) return rows.front();
  throw UsageError(fmt::format(
      "--row {}: {} subjects of {} have it in their column \"{}\"; one is needed, by {}", label,
      rows.size(), table.source, column.header,
      column.quantity == population::Quantity::kLabel
          ? std::string("labels that differ")
          : fmt::format("its number, 1 to {}, or a column subject", table.subjects())));
}

/// The subject called `label` in the table's column of subjects (subject, id, name, label ...); if
/// there is none, by the row's number from 1, or by text that one row alone has.
std::size_t subject_called(const population::DimensionTable& table, const std::string& label) {
  for (const population::TableColumn& column : table.columns) {
    if (column.quantity != population::Quantity::kLabel) continue;
    const std::vector<std::size_t> rows = rows_with(column, label);
    if (!rows.empty()) return only_row(rows, table, column, label);
    throw UsageError("--row " + label + ": " + table.source +
                     " has no such entry in its column \"" + column.header + "\"");
  }
  int number = 0;
  const char* end = label.data() + label.size();
  const auto [rest, error] = std::from_chars(label.data(), end, number);
  if (error == std::errc() && rest == end && number >= 1 && number <= table.subjects()) {
    return static_cast<std::size_t>(number) - 1;
  }
  for (const population::TableColumn& column : table.columns) {
    const std::vector<std::size_t> rows = rows_with(column, label);
    if (!rows.empty()) return only_row(rows, table, column, label);
  }
  throw UsageError(fmt::format(
      "--row {}: {} has no column of subjects (subject, id, name); a row's number, 1 to {}, is "
      "allowed",
      label, table.source, table.subjects()));
}

std::vector<hand::SizedDimension> targets_of(const ScaleArguments& arguments,
                                             const Context& context) {
  std::vector<hand::SizedDimension> targets;
  const auto add = [&](hand::DimensionKind kind, const std::optional<double>& value,
                       hand::Segment segment = hand::Segment::kPalm) {
    if (value) targets.push_back({{kind, segment}, *value});
  };
  add(hand::DimensionKind::kHandLength, arguments.length);
  add(hand::DimensionKind::kHandCircumference, arguments.circumference);
  add(hand::DimensionKind::kHandWidth, arguments.width);
  add(hand::DimensionKind::kHandThickness, arguments.thickness);
  add(hand::DimensionKind::kSegmentLength, arguments.palm_length);
  for (const std::string& setting : arguments.dimensions) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw UsageError("--dimension: \"" + setting +
                       "\" is not of the form index_proximal_length=20 (mm)");
    }
    targets.push_back({dimension_for(setting.substr(0, equals)),
                       workflow::parse_list("--dimension", setting.substr(equals + 1)).front()});
  }
  if (arguments.table.empty()) return targets;
  if (arguments.row.empty()) throw UsageError("--table needs --row, the hand's label");
  const population::DimensionTable table = records::read_dimension_table(arguments.table);
  for (const std::string& text : table.notes) note(context.common, text);
  const std::size_t subject = subject_called(table, arguments.row);
  for (const population::TableColumn& column : table.columns) {
    if (!column.dimension || !column.values[subject]) continue;
    targets.push_back({*column.dimension, *column.values[subject]});
  }
  return targets;
}

std::string driven_text(const hand::HandInstance& instance) {
  std::string text = fmt::format("{:<26} {:>8} {:>9}  (mm)\n", "dimension", "asked", "measured");
  for (const hand::MetDimension& one : instance.driven) {
    text +=
        fmt::format("{:<26} {:8.2f} {:9.2f}\n", name_of(one.dimension), one.asked, one.measured);
  }
  return text + fmt::format("largest miss {:.3f} mm\n", instance.largest_miss);
}

Json driven_json(const hand::HandInstance& instance) {
  Json driven = Json::array(), measured = Json::object();
  for (const hand::MetDimension& one : instance.driven) {
    driven.push_back({{"dimension", name_of(one.dimension)},
                      {"asked_mm", one.asked},
                      {"measured_mm", one.measured}});
  }
  for (const hand::HandDimension dimension : hand::all_hand_dimensions()) {
    measured[name_of(dimension) + "_mm"] = hand::value_of(instance.hand.dimensions, dimension);
  }
  return {{"driven", driven},
          {"largest_miss_mm", instance.largest_miss},
          {"measured", measured},
          {"provenance", instance.hand.provenance}};
}

int run_scale(const ScaleArguments& arguments, const Context& context) {
  const auto base = workflow::load_hand(arguments.hand);
  const std::vector<hand::SizedDimension> targets = targets_of(arguments, context);
  if (arguments.factor && !targets.empty()) {
    throw UsageError("--factor scales everything alike; no dimension is allowed beside it");
  }
  if (!arguments.factor && targets.empty()) {
    throw UsageError(
        "no dimension is given; --hand-length-mm, --circumference-mm, --dimension NAME=MM, --table "
        "or --factor is required");
  }
  hand::HandInstance instance;
  if (arguments.factor) {
    instance.hand = scaled(*base, *arguments.factor);
  } else {
    instance = hand::make_hand_instance(*base, targets);
  }
  if (!arguments.out.empty()) {
    records::write_hand(arguments.out, instance.hand);
    note(context.common, "wrote " + arguments.out);
  }
  if (context.common.json) {
    print(driven_json(instance).dump(2) + "\n");
  } else if (!arguments.factor) {
    print(driven_text(instance));
  }
  return 0;
}

}  // namespace

void add_hand_scale(CLI::App& hand, Context& context) {
  const auto o = std::make_shared<ScaleArguments>();
  CLI::App* verb =
      add_verb(hand, "scale", "A hand of given dimensions, scaled segment by segment",
               "palmar hand scale --hand-length-mm 193 --circumference-mm 212 --out man.hand.glb");
  verb->add_option("HAND", o->hand, "\"template\" or a .hand.glb file")->capture_default_str();
  verb->add_option("--hand-length-mm", o->length, "Wrist crease to tip of the middle finger");
  verb->add_option("--circumference-mm", o->circumference, "Girth over the metacarpal heads");
  verb->add_option("--width-mm", o->width, "Breadth over the metacarpal heads");
  verb->add_option("--thickness-mm", o->thickness, "Thickness at the third metacarpal head");
  verb->add_option("--palm-length-mm", o->palm_length,
                   "Wrist crease to base crease of the middle "
                   "finger");
  verb->add_option("--dimension", o->dimensions,
                   "Any of the 47 dimensions, NAME=MM (index_proximal_length=22); repeatable")
      ->allow_extra_args(false);
  verb->add_option("--table", o->table,
                   "CSV of subjects; every dimension in the row's columns is requested");
  verb->add_option(
      "--row", o->row,
      "Which row: its entry in the column subject, id, name or label; its number from 1 if "
      "there is no such column");
  verb->add_option("--factor", o->factor, "Scale everything by one factor instead");
  verb->add_option("--out", o->out, "File to write, *.hand.glb; default: only print what is met");
  verb->callback([&context, o] { context.run = [&context, o] { return run_scale(*o, context); }; });
}

}  // namespace palmar::cli
