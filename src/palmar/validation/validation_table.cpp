// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "palmar/validation/validation.h"

namespace palmar::validation {
namespace {

std::string number(double value) {
  if (!std::isfinite(value)) return "no number";
  if (value != 0.0 && std::abs(value) < 1e-4) return fmt::format("{:.0e}", value);
  if (std::abs(value) >= 1000.0) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

std::string theirs(const ValidationTarget& target) {
  if (target.value) return number(*target.value);
  if (target.lowest && target.highest) {
    return number(*target.lowest) + " to " + number(*target.highest);
  }
  if (target.lowest) return "at least " + number(*target.lowest);
  if (target.highest) return "at most " + number(*target.highest);
  return "-";
}

std::string difference(const ValidationRow& row) {
  if (!row.difference) return "-";
  const double d = *row.difference;
  if (!row.target.value && d == 0.0) return "inside";
  if (std::abs(d) > 10.0) return fmt::format("{:.0f} times", 1.0 + d);
  return fmt::format("{:+.1f} %", 100.0 * d);
}

/// "2 %", for a value with edges.
std::string allowed(const ValidationTarget& target) {
  if (!target.value || !target.highest || !target.lowest) return "-";
  const double value = std::abs(*target.value);
  const double below = *target.value - *target.lowest, above = *target.highest - *target.value;
  if (value > 0.0 && std::abs(above - below) < 1e-9 * value) {
    return fmt::format("{:.3g} %", 100.0 * above / value);
  }
  return number(*target.lowest) + " to " + number(*target.highest);
}

std::string with_unit(const ValidationRow& row) {
  return row.unit.empty() ? row.quantity : row.quantity + ", " + row.unit;
}

/// "no", or "yes" with the commit that chose.
std::string chosen(const ValidationRow& row) {
  if (row.chosen_in.empty()) return "no";
  return "yes, in " + row.chosen_in;
}

std::vector<std::string> cells(const ValidationRow& row) {
  return {with_unit(row),      row.ours ? number(*row.ours) : "-",
          theirs(row.target),  difference(row),
          allowed(row.target), name_of(row.verdict),
          chosen(row),         row.added_in.empty() ? "-" : row.added_in,
          row.target.source};
}

const std::vector<std::string> kHead = {
    "what",     "ours",  "theirs", "difference", "allowed", "verdict", "chosen on this case?",
    "row from", "source"};

std::string summary(const ValidationReport& report) {
  return fmt::format("{} met, {} missed, {} for information, {} not built yet",
                     report.count(Verdict::kMet), report.count(Verdict::kMissed),
                     report.count(Verdict::kInformation), report.count(Verdict::kNotBuilt));
}

std::string markdown_line(const std::vector<std::string>& fields) {
  std::string line = "|";
  for (const std::string& field : fields) line += " " + field + " |";
  return line + "\n";
}

}  // namespace

std::string validation_markdown(const ValidationReport& report) {
  std::string text = fmt::format(
      "# Checked against closed forms and measurements\n\n"
      "`palmar validate --markdown > docs/method/validation.md` writes this page, with the hand "
      "\"{}\". Don't edit it.\n\n"
      "- **allowed**: the difference from a figure that counts as met. Where \"theirs\" is a range "
      "or a limit, that decides.\n"
      "- **verdict**: a figure that was measured on people is always judged. \"Information\" is "
      "for "
      "figures that somebody\n  computed, or that have no published counterpart. `palmar validate` "
      "ends with exit code 5 if a row is missed;\n  [limits](limits.md) says what the misses "
      "mean.\n"
      "- **chosen on this case?**: \"yes\" if a setting of the program was chosen with this row in "
      "view, with the commit that\n  chose it. Such a row is no independent check.\n"
      "- **row from**: the commit that added the row and its target.\n\n"
      "{}.\n",
      report.hand_name, summary(report));
  for (const ValidationCase& one : report.cases) {
    text += "\n## " + one.id + ": " + one.title + "\n\n" + markdown_line(kHead) +
            markdown_line(std::vector<std::string>(kHead.size(), "---"));
    for (const ValidationRow& row : one.rows) {
      std::vector<std::string> fields = cells(row);
      if (row.verdict == Verdict::kMissed) fields[5] = "**missed**";
      text += markdown_line(fields);
    }
  }
  return text;
}

std::string validation_text(const ValidationReport& report) {
  std::string text;
  for (const ValidationCase& one : report.cases) {
    text += fmt::format("{}: {} ({:.1f} s)\n", one.id, one.title, one.seconds);
    std::vector<std::vector<std::string>> lines = {kHead};
    for (const ValidationRow& row : one.rows) lines.push_back(cells(row));
    std::vector<std::size_t> width(kHead.size(), 0);
    for (const auto& line : lines) {
      for (std::size_t i = 0; i < line.size(); ++i) width[i] = std::max(width[i], line[i].size());
    }
    for (const auto& line : lines) {
      std::string out = "  ";
      for (std::size_t i = 0; i < line.size(); ++i) {
        const bool is_last = i + 1 == line.size();
        out += is_last ? line[i] : fmt::format("{:<{}}  ", line[i], width[i]);
      }
      text += out + "\n";
    }
    text += "\n";
  }
  return text + summary(report) + "\n";
}

}  // namespace palmar::validation
