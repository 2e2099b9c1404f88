// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/fe/ccx_results.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::records {
namespace {

class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  bool next(std::string_view& line) {
    if (begin_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
    line = text_.substr(begin_, end - begin_);
    begin_ = end + 1;
    ++number_;
    return true;
  }
  /// The next line that isn't blank.
  bool next_full(std::string_view& line) {
    while (next(line)) {
      if (line.find_first_not_of(" \r") != std::string_view::npos) return true;
    }
    return false;
  }
  int number() const { return number_; }

 private:
  std::string_view text_;
  std::size_t begin_ = 0;
  int number_ = 0;
};

double number_in(std::string_view field, const std::string& name, int line) {
  const std::string text(field);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) {
    throw InputError(fmt::format("{}:{}: \"{}\" is no number", name, line, text));
  }
  return value;
}

/// First `count` numbers of the line after a heading.
std::vector<double> numbers_after(Lines& lines, std::size_t count, const std::string& name) {
  std::string_view line;
  std::vector<double> values;
  if (lines.next_full(line)) {
    while (values.size() < count) {
      const std::size_t begin = line.find_first_not_of(' ');
      if (begin == std::string_view::npos) break;
      line.remove_prefix(begin);
      const std::size_t end = std::min(line.find(' '), line.size());
      values.push_back(number_in(line.substr(0, end), name, lines.number()));
      line.remove_prefix(end);
    }
  }
  if (values.size() < count) {
    throw InputError(fmt::format("{}:{}: {} of {} numbers; did CalculiX end early?", name,
                                 lines.number(), values.size(), count));
  }
  return values;
}

void add_pressures(const std::string& frd, const std::string& name, std::vector<CcxStep>& steps) {
  constexpr std::size_t kFirst = 13;    // columns of "-1" and the node
  constexpr std::size_t kWidth = 12;    // of a value
  constexpr std::size_t kPressure = 3;  // COPEN, CSLIP1, CSLIP2, CPRESS
  Lines lines(frd);
  std::string_view line;
  bool is_contact = false;
  std::size_t blocks = 0;
  while (lines.next(line)) {
    if (line.starts_with(" -4")) {
      is_contact = line.find("CONTACT") != std::string_view::npos;
      if (is_contact) ++blocks;
    } else if (line.starts_with(" -3")) {
      is_contact = false;
    } else if (is_contact && line.starts_with(" -1") && blocks <= steps.size()) {
      const std::size_t begin = kFirst + kPressure * kWidth;
      if (line.size() < begin + kWidth) {
        throw InputError(fmt::format("{}:{}: the line is too short", name, lines.number()));
      }
      const double pressure = number_in(line.substr(begin, kWidth), name, lines.number());
      if (!(pressure > 0.0)) continue;
      CcxStep& step = steps[blocks - 1];
      step.node.push_back(static_cast<int>(number_in(line.substr(3, 10), name, lines.number())) -
                          1);
      step.pressure.push_back(pressure);
    }
  }
}

}  // namespace

std::vector<CcxStep> parse_ccx(const std::string& text, const std::string& frd,
                               const std::string& name) {
  std::vector<CcxStep> steps;
  Lines lines(text);
  std::string_view line;
  std::size_t areas = 0;
  while (lines.next(line)) {
    if (line.starts_with(" total force") && line.find("set INDENTER") != std::string_view::npos) {
      const std::vector<double> f = numbers_after(lines, 3, name);
      steps.emplace_back().force = {f[0], f[1], f[2]};
    } else if (line.find("area,  normal force") != std::string_view::npos) {
      if (++areas > steps.size()) {
        throw InputError(
            fmt::format("{}:{}: contact without a reaction before it", name, lines.number()));
      }
      steps[areas - 1].area = numbers_after(lines, 1, name)[0];
    }
  }
  if (steps.empty()) throw InputError(name + ": no step was solved");
  add_pressures(frd, name, steps);
  return steps;
}

std::vector<CcxStep> read_ccx(const std::string& stem) {
  return parse_ccx(formats::read_file(stem + ".dat"), formats::read_file(stem + ".frd"), stem);
}

}  // namespace palmar::records
