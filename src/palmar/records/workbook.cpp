// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/workbook.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"
#include "palmar/formats/zip_write.h"

namespace palmar::records {
namespace {

struct UnitEnd {
  const char* end;
  const char* unit;
  int style;  // index into the cell formats of kStyles
};

// Cell formats: 0 general, 1 heading, 2 text that wraps, 3 "0", 4 "0.0", 5 "0.00", 6 "0.000",
// 7 title. The digits are our choice: three of those that a unit's usual values have.
constexpr std::array kUnits = {
    UnitEnd{"_n_mm", "N mm", 4}, UnitEnd{"_mm2", "mm²", 3}, UnitEnd{"_mm3", "mm³", 3},
    UnitEnd{"_mm", "mm", 4},     UnitEnd{"_mpa", "MPa", 6}, UnitEnd{"_kpa", "kPa", 4},
    UnitEnd{"_n", "N", 4},       UnitEnd{"_deg", "°", 4},   UnitEnd{"_percent", "%", 4},
    UnitEnd{"_kg", "kg", 6},     UnitEnd{"_s", "s", 4},     UnitEnd{"_share", "share", 6},
};

constexpr const char* kStyles =
    R"(<?xml version="1.0" encoding="UTF-8" standalone="yes"?>
<styleSheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><numFmts count="2"><numFmt numFmtId="164" formatCode="0.0"/><numFmt numFmtId="165" formatCode="0.000"/></numFmts><fonts count="3"><font><sz val="11"/><name val="Calibri"/></font><font><b/><sz val="11"/><name val="Calibri"/></font><font><b/><sz val="14"/><name val="Calibri"/></font></fonts><fills count="3"><fill><patternFill patternType="none"/></fill><fill><patternFill patternType="gray125"/></fill><fill><patternFill patternType="solid"><fgColor rgb="FFE8EDF2"/><bgColor indexed="64"/></patternFill></fill></fills><borders count="1"><border><left/><right/><top/><bottom/><diagonal/></border></borders><cellStyleXfs count="1"><xf numFmtId="0" fontId="0" fillId="0" borderId="0"/></cellStyleXfs><cellXfs count="8"><xf numFmtId="0" fontId="0" fillId="0" borderId="0" xfId="0"/><xf numFmtId="0" fontId="1" fillId="2" borderId="0" xfId="0" applyFont="1" applyFill="1" applyAlignment="1"><alignment vertical="top" wrapText="1"/></xf><xf numFmtId="0" fontId="0" fillId="0" borderId="0" xfId="0" applyAlignment="1"><alignment vertical="top" wrapText="1"/></xf><xf numFmtId="1" fontId="0" fillId="0" borderId="0" xfId="0" applyNumberFormat="1"/><xf numFmtId="164" fontId="0" fillId="0" borderId="0" xfId="0" applyNumberFormat="1"/><xf numFmtId="2" fontId="0" fillId="0" borderId="0" xfId="0" applyNumberFormat="1"/><xf numFmtId="165" fontId="0" fillId="0" borderId="0" xfId="0" applyNumberFormat="1"/><xf numFmtId="0" fontId="2" fillId="0" borderId="0" xfId="0" applyFont="1"/></cellXfs><cellStyles count="1"><cellStyle name="Normal" xfId="0" builtinId="0"/></cellStyles></styleSheet>
)";
constexpr int kHeading = 1, kWrapped = 2, kTitle = 7;

const UnitEnd* unit_of(const std::string& column) {
  for (const UnitEnd& one : kUnits) {
    if (column.ends_with(one.end)) return &one;
  }
  return nullptr;
}

/// A number as tables have it; nothing for text, also not for "nan", "1e999" or "007".
std::optional<double> number_in(const std::string& text) {
  if (text.empty() || text.size() > 30) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  const std::size_t first = text[0] == '-' ? 1 : 0;
  const bool has_leading_zero = text.size() > first + 1 && text[first] == '0' &&
                                text[first + 1] >= '0' && text[first + 1] <= '9';
  return has_leading_zero ? std::nullopt : std::optional(value);
}

/// 0 -> "A", 26 -> "AA"
std::string letters_of(std::size_t column) {
  std::string letters;
  for (++column; column > 0; column = (column - 1) / 26) {
    letters.insert(letters.begin(), static_cast<char>('A' + (column - 1) % 26));
  }
  return letters;
}

/// Characters that XML can't have are left out.
std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (code >= 32 || c == '\n' || c == '\t')
      out += c;
  }
  return out;
}

std::string text_cell(const std::string& place, const std::string& text, int style) {
  if (text.empty()) return "";
  return "<c r=\"" + place + "\" t=\"inlineStr\" s=\"" + std::to_string(style) +
         "\"><is><t xml:space=\"preserve\">" + xml_text(text) + "</t></is></c>";
}

std::string workbook_heading(const std::string& column) {
  const ColumnWords words = words_of_column(column);
  return words.words + (words.unit.empty() ? "" : " [" + words.unit + "]");
}

constexpr const char* kSheetStart =
    "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n<worksheet "
    "xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\">";

std::string sheet_xml(const CsvTable& table) {
  const std::size_t columns = table.header.size();
  std::string xml = kSheetStart;
  xml +=
      "<sheetViews><sheetView workbookViewId=\"0\"><pane ySplit=\"1\" topLeftCell=\"A2\" "
      "activePane=\"bottomLeft\" state=\"frozen\"/></sheetView></sheetViews><cols>";
  for (std::size_t c = 0; c < columns; ++c) {
    std::size_t widest = std::min<std::size_t>(workbook_heading(table.header[c]).size(), 18);
    for (const auto& row : table.rows) {
      if (!number_in(row[c])) widest = std::max(widest, std::min<std::size_t>(row[c].size(), 40));
    }
    const std::string number = std::to_string(c + 1);
    xml += "<col min=\"" + number + "\" max=\"" + number + "\" width=\"" +
           std::to_string(std::max<std::size_t>(widest + 2, 10)) + "\" customWidth=\"1\"/>";
  }
  xml += "</cols><sheetData><row r=\"1\">";
  for (std::size_t c = 0; c < columns; ++c) {
    xml += text_cell(letters_of(c) + "1", workbook_heading(table.header[c]), kHeading);
  }
  xml += "</row>";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::string row = std::to_string(r + 2);
    xml += "<row r=\"" + row + "\">";
    for (std::size_t c = 0; c < columns; ++c) {
      const std::string& cell = table.rows[r][c];
      const std::string place = letters_of(c) + row;
      if (!number_in(cell)) {
        xml += text_cell(place, cell, 0);
        continue;
      }
      const UnitEnd* unit = unit_of(table.header[c]);
      xml += "<c r=\"" + place + "\" s=\"" + std::to_string(unit ? unit->style : 0) + "\"><v>" +
             cell + "</v></c>";
    }
    xml += "</row>";
  }
  xml += "</sheetData>";
  if (!table.rows.empty() && columns > 0) {
    xml += "<autoFilter ref=\"A1:" + letters_of(columns - 1) +
           std::to_string(table.rows.size() + 1) + "\"/>";
  }
  return xml + "</worksheet>\n";
}

std::string about_xml(const std::string& title, const std::vector<std::string>& notes,
                      const std::vector<WorkbookSheet>& sheets,
                      const std::vector<std::string>& tabs) {
  std::string xml = kSheetStart;
  xml +=
      "<cols><col min=\"1\" max=\"1\" width=\"34\" customWidth=\"1\"/><col min=\"2\" max=\"2\" "
      "width=\"44\" customWidth=\"1\"/><col min=\"3\" max=\"4\" width=\"24\" "
      "customWidth=\"1\"/></cols><sheetData>";
  int row = 0;
  const auto add = [&](const std::vector<std::string>& cells, int style) {
    const std::string number = std::to_string(++row);
    xml += "<row r=\"" + number + "\">";
    for (std::size_t c = 0; c < cells.size(); ++c) {
      xml += text_cell(letters_of(c) + number, cells[c], style);
    }
    xml += "</row>";
  };
  add({title}, kTitle);
  for (const std::string& note : notes) add({note}, 0);
  add({}, 0);
  add({"Sheet", "What a row is"}, kHeading);
  for (std::size_t i = 0; i < sheets.size(); ++i) add({tabs[i], sheets[i].about}, kWrapped);
  add({}, 0);
  add({"Column", "Name in files (CSV, JSON)", "Unit", "Sheet"}, kHeading);
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    for (const std::string& column : sheets[i].table.header) {
      const ColumnWords words = words_of_column(column);
      add({words.words, column, words.unit, tabs[i]}, 0);
    }
  }
  return xml + "</sheetData></worksheet>\n";
}

/// Names of tabs as Excel allows them, none twice.
std::vector<std::string> tabs_of(const std::vector<WorkbookSheet>& sheets) {
  constexpr std::size_t kLongest = 31;
  std::vector<std::string> tabs;
  std::set<std::string> used = {"about"};
  for (const WorkbookSheet& sheet : sheets) {
    std::string tab;
    for (const char c : sheet.name) {
      if (std::string("[]:*?/\\").find(c) == std::string::npos) tab += c;
    }
    if (tab.empty()) tab = "table";
    tab.resize(std::min(tab.size(), kLongest));
    const std::string plain = tab;
    for (int k = 2; !used.insert(lower_case(tab)).second; ++k) {
      const std::string end = " " + std::to_string(k);
      tab = plain.substr(0, kLongest - end.size()) + end;
    }
    tabs.push_back(tab);
  }
  return tabs;
}

}  // namespace

ColumnWords words_of_column(const std::string& column) {
  const UnitEnd* unit = unit_of(column);
  const bool is_share = unit != nullptr && std::string(unit->unit) == "share";
  std::string words = column;
  if (unit != nullptr && !is_share) words.resize(words.size() - std::string(unit->end).size());
  std::replace(words.begin(), words.end(), '_', ' ');
  return {words, unit == nullptr || is_share ? "" : unit->unit};
}

std::string format_workbook(const std::string& title, const std::vector<std::string>& notes,
                            const std::vector<WorkbookSheet>& sheets) {
  if (sheets.empty()) throw UsageError("workbook: it has no sheet");
  for (const WorkbookSheet& sheet : sheets) {
    for (const auto& row : sheet.table.rows) {
      if (row.size() != sheet.table.header.size()) {
        throw UsageError("workbook: a row of sheet \"" + sheet.name + "\" has " +
                         std::to_string(row.size()) + " cells, its header " +
                         std::to_string(sheet.table.header.size()));
      }
    }
  }
  const std::vector<std::string> tabs = tabs_of(sheets);
  const std::string head = "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n";
  const std::string office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
  const std::string package = "http://schemas.openxmlformats.org/package/2006/";
  const std::string spreadsheet = "application/vnd.openxmlformats-officedocument.spreadsheetml.";
  std::string types = head + "<Types xmlns=\"" + package +
                      "content-types\"><Default Extension=\"rels\" "
                      "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
                      "<Default Extension=\"xml\" ContentType=\"application/xml\"/>"
                      "<Override PartName=\"/xl/workbook.xml\" ContentType=\"" +
                      spreadsheet +
                      "sheet.main+xml\"/><Override PartName=\"/xl/styles.xml\" "
                      "ContentType=\"" +
                      spreadsheet + "styles+xml\"/>";
  std::string book =
      head +
      "<workbook xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\" "
      "xmlns:r=\"" +
      office + "\"><sheets>";
  std::string links = head + "<Relationships xmlns=\"" + package + "relationships\">";
  std::vector<formats::ZipMember> parts;
  for (std::size_t i = 0; i <= sheets.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    const std::string file = "worksheets/sheet" + number + ".xml";
    types += "<Override PartName=\"/xl/" + file + "\" ContentType=\"" + spreadsheet +
             "worksheet+xml\"/>";
    book += "<sheet name=\"" + xml_text(i == 0 ? "About" : tabs[i - 1]) + "\" sheetId=\"" + number +
            "\" r:id=\"rId" + number + "\"/>";
    links += "<Relationship Id=\"rId" + number + "\" Type=\"" + office + "/worksheet\" Target=\"" +
             file + "\"/>";
    parts.push_back({"xl/" + file, i == 0 ? about_xml(title, notes, sheets, tabs)
                                          : sheet_xml(sheets[i - 1].table)});
  }
  links += "<Relationship Id=\"rId" + std::to_string(sheets.size() + 2) + "\" Type=\"" + office +
           "/styles\" Target=\"styles.xml\"/></Relationships>\n";
  std::vector<formats::ZipMember> members = {
      {"[Content_Types].xml", types + "</Types>\n"},
      {"_rels/.rels", head + "<Relationships xmlns=\"" + package +
                          "relationships\"><Relationship Id=\"rId1\" Type=\"" + office +
                          "/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>\n"},
      {"xl/workbook.xml", book + "</sheets></workbook>\n"},
      {"xl/_rels/workbook.xml.rels", links},
      {"xl/styles.xml", kStyles}};
  members.insert(members.end(), parts.begin(), parts.end());
  return formats::format_zip(members);
}

CsvTable rounded_table(CsvTable table, int significant) {
  if (significant < 1 || significant > 15) {
    throw UsageError("rounded table: " + std::to_string(significant) +
                     " significant digits; 1 to 15 are allowed");
  }
  for (auto& row : table.rows) {
    for (std::string& cell : row) {
      const std::optional<double> value = number_in(cell);
      if (!value || *value == std::round(*value)) continue;
      const int before =
          static_cast<int>(std::floor(std::log10(std::abs(*value)))) + 1;  // digits, or minus zeros
      std::array<char, 64> text{};
      std::snprintf(text.data(), text.size(), "%.*f", std::max(0, significant - before), *value);
      cell = text.data();
    }
  }
  return table;
}

}  // namespace palmar::records
