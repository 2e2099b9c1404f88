// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/html_page.h"

#include <fmt/format.h>

#include "palmar/core/version.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/chart/svg_chart.h"
#include "palmar/report/page/html_style.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"

namespace palmar {

std::string html_page(const std::string& title, const std::string& summary,
                      const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'; img-src data:\">\n<title>" +
         html_escaped(title) + "</title>\n<style>" + std::string(kReportStyle) +
         "</style>\n</head>\n<body>\n<header><h1>" + html_escaped(title) + "</h1>" + summary +
         "</header>\n<main>\n" + body + "</main>\n<footer><p>Made by Palmar " +
         html_escaped(version()) +
         ". This file works without a network.</p></footer>\n</body>\n</html>\n";
}

std::string pictures_html(const std::vector<Picture>& pictures,
                          std::initializer_list<std::string_view> kinds) {
  std::string html;
  for (const Picture& one : pictures) {
    for (const std::string_view kind : kinds) {
      if (!one.name.starts_with(kind)) continue;
      html += "<figure><img src=\"data:image/png;base64," + base64(encode_png(one.image)) +
              "\" alt=\"" + html_escaped(one.alt) + "\"><figcaption>" + html_escaped(one.title) +
              "</figcaption></figure>";
    }
  }
  return html.empty() ? html : "<div class=\"pictures\">" + html + "</div>\n";
}

std::string titled(const std::string& title, const std::string& html) {
  return html.empty() ? html : "<h2>" + html_escaped(title) + "</h2>\n" + html;
}

std::string notes_section(const std::string& title, const std::vector<std::string>& notes) {
  if (notes.empty()) return {};
  std::string html = "<h2>" + html_escaped(title) + "</h2>\n<ul class=\"plain\">";
  for (const std::string& note : notes) html += "<li>" + html_escaped(note) + "</li>";
  return html + "</ul>\n";
}

std::string number_cell(const std::optional<double>& value, int decimals) {
  if (!value) return "<td class=\"n\">–</td>";
  return fmt::format("<td class=\"n\" data-value=\"{}\">{:.{}f}</td>", exact_number(*value), *value,
                     decimals);
}

std::string row_head(const std::string& text) {
  return "<th scope=\"row\">" + html_escaped(text) + "</th>";
}

std::string html_table(const std::string& caption, const std::vector<std::string>& heads,
                       const std::string& rows, std::size_t texts) {
  std::string html =
      "<div class=\"wide\"><table><caption>" + html_escaped(caption) + "</caption><thead><tr>";
  for (std::size_t k = 0; k < heads.size(); ++k) {
    html += std::string("<th scope=\"col\"") + (k < texts ? "" : " class=\"n\"") + ">" +
            html_escaped(heads[k]) + "</th>";
  }
  return html + "</tr></thead><tbody>" + rows + "</tbody></table></div>\n";
}

}  // namespace palmar
