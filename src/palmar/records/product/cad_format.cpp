// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/cad_format.h"

#include <algorithm>
#include <cctype>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"

namespace palmar::records {
namespace {

constexpr std::size_t kEnds = 16384;  // bytes looked at on both ends
constexpr std::size_t kIgesLine = 80;

/// Lines of 80 columns; the letter in column 73 shows the section, a number follows.
bool is_iges_line(std::string_view line, char section) {
  return line.size() >= kIgesLine && line[72] == section &&
         line.substr(73, 7).find_first_not_of(" 0123456789") == line.npos;
}

std::string_view last_line(std::string_view text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n\x1a") + 1;
  const std::size_t start = text.substr(0, end).find_last_of('\n');
  return start == text.npos ? text.substr(0, end) : text.substr(start + 1, end - start - 1);
}

bool is_iges_end(std::string_view tail) {
  const std::string_view line = last_line(tail);
  return line.size() >= 73 && (is_iges_line(line, 'T') || line[72] == 'T');
}

}  // namespace

std::string name_of(CadFormat format) { return format == CadFormat::kStep ? "STEP" : "IGES"; }

std::optional<CadFormat> cad_format_of_content(std::string_view head) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (head.starts_with(kByteOrderMark)) head.remove_prefix(kByteOrderMark.size());
  const std::size_t start = head.find_first_not_of(" \t\r\n");
  if (start != head.npos && head.substr(start).starts_with("ISO-10303-21")) {
    return CadFormat::kStep;
  }
  if (is_iges_line(head.substr(0, head.find_first_of("\r\n")), 'S')) return CadFormat::kIges;
  return std::nullopt;
}

std::optional<CadFormat> cad_format_of_name(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".step" || extension == ".stp" || extension == ".p21") return CadFormat::kStep;
  if (extension == ".iges" || extension == ".igs") return CadFormat::kIges;
  return std::nullopt;
}

bool is_cad_file(const std::filesystem::path& path) {
  try {
    if (cad_format_of_content(formats::read_ends(path, kEnds).head)) return true;
  } catch (const Error&) {
    // Said by whoever reads it.
  }
  return cad_format_of_name(path).has_value();
}

CadFormatCheck check_cad_format(const std::filesystem::path& path) {
  const std::string object = path.string();
  formats::FileEnds ends = formats::read_ends(path, kEnds);
  const std::optional<CadFormat> format = cad_format_of_content(ends.head);
  if (!format) {
    throw InputError(object +
                     ": is neither STEP nor IGES: it begins neither with ISO-10303-21 nor with an "
                     "IGES start section" +
                     (ends.head.find('\0') != ends.head.npos ? "; it is binary" : ""));
  }
  const bool is_whole = *format == CadFormat::kStep
                            ? ends.tail.find("END-ISO-10303-21") != ends.tail.npos
                            : is_iges_end(ends.tail);
  if (!is_whole) {
    throw InputError(object + ": is cut off: its " + std::to_string(ends.bytes) +
                     " bytes don't end with " +
                     (*format == CadFormat::kStep ? "END-ISO-10303-21" : "a terminate section"));
  }
  return {*format, std::move(ends.head)};
}

}  // namespace palmar::records
