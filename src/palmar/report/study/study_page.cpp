// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_page.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/page/face_tables.h"
#include "palmar/report/page/html_style.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/page/viewer_bundle.h"
#include "palmar/report/study/study_sections.h"
#include "palmar/report/study/study_words.h"

namespace palmar {
namespace {

constexpr std::size_t kMostDrawnConditions = 4;  // the page stays small; files hold all

constexpr std::string_view kStudyStyle =
    ".figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(420px,1fr));gap:18px}"
    ".figures figure{padding:8px}.figures svg{width:100%;height:auto;display:block}"
    ".controls select{font:inherit;max-width:100%;padding:.15rem .4rem;border:1px solid #8a949e;"
    "border-radius:4px;background:#fff;color:var(--ink)}"
    ".view-says{margin:0;padding:.5rem .9rem;border-top:1px solid var(--line);font-size:.9rem}"
    "[data-bar][hidden]{display:none}"
    "@media(max-width:720px){.figures{grid-template-columns:1fr}}";

std::string figures_of(const StudyPage& page, int condition) {
  std::string html = "<div class=\"figures\">";
  for (const StudyFigure& one : page.figures) {
    if (one.condition != condition) continue;
    html += "<figure>" + to_svg(one.figure) + "<figcaption>" + html_escaped(one.description) +
            "</figcaption></figure>\n";
  }
  return html + "</div>\n";
}

std::string pictures_of(const StudyPage& page) {
  std::string html;
  for (std::size_t p = 0; p < page.pictures.size(); ++p) {
    if (page.pictures[p].empty()) continue;
    html +=
        "<h3>" + html_escaped(page.results.plan.products[p].name) + "</h3><div class=\"pictures\">";
    for (const EncodedPicture& picture : page.pictures[p]) {
      html += "<figure><img src=\"data:image/png;base64," + base64(picture.png) + "\" alt=\"" +
              html_escaped(picture.alt) + "\"><figcaption>" + html_escaped(picture.title) +
              "</figcaption></figure>";
    }
    html += "</div>\n";
  }
  if (html.empty()) return {};
  const StudyCondition& condition = page.analysis.conditions.front().condition;
  const std::string which = condition_words(page.results.plan, condition);
  return "<h2 id=\"maps\">Where all hands press" +
         (which.empty() ? "" : html_escaped(": " + which)) +
         "</h2>\n<p>Means over the hands that hold the "
         "product, vertex by vertex of the template’s skin and of the product; hands that don’t "
         "touch there count with 0. The threshold of " +
         short_number(1000.0 * page.threshold) +
         " kPa is of the family <em>blood flow</em>: at more, the skin’s blood flow stops if the "
         "grip is held long (Chalmers thesis 2004, publication 208). It says nothing of "
         "pain.</p>\n" +
         html;
}

}  // namespace

std::string study_page(const StudyPage& page) {
  const StudyPlan& plan = page.results.plan;
  if (page.analysis.conditions.empty() || plan.products.empty()) {
    throw UsageError("study report: the plan has no condition or no product");
  }
  const std::string title = plan.title.empty() ? plan.name : plan.title;
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
      "'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:\">\n"
      "<meta name=\"generator\" content=\"Palmar " +
      html_escaped(version()) + "\">\n<title>" + html_escaped("Palmar study: " + title) +
      "</title>\n<style>" + std::string(kReportStyle) + std::string(kStudyStyle) +
      "</style>\n</head>\n<body>\n<header><h1>" + html_escaped("Palmar study: " + title) +
      "</h1><p>" + counted(static_cast<int>(plan.hands.size()), "hand") + " × " +
      counted(static_cast<int>(plan.products.size()), "product") + ", " +
      std::to_string(page.results.records.size()) + " of " + std::to_string(task_count(plan)) +
      " grasps.</p></header>\n<main>\n" + summary_section(page);
  for (std::size_t c = 0; c < page.analysis.conditions.size(); ++c) {
    const ConditionAnalysis& one = page.analysis.conditions[c];
    html += "<h2 id=\"condition-" + std::to_string(c) + "\">" +
            html_escaped(capitalised(title_of(plan, one.condition))) + "</h2>\n";
    if (c == 0) {
      html += figures_of(page, 0);
    } else if (c < kMostDrawnConditions) {
      html += "<details><summary>Figures</summary>" + figures_of(page, static_cast<int>(c)) +
              "</details>\n";
    } else {
      html += "<p>Its figures stand beside this file in the folder figures.</p>\n";
    }
    html +=
        face_statistics_section(plan, page.products, page.faces, one.condition, page.threshold) +
        condition_tables(page, one);
  }
  html += scene_section(page) + pictures_of(page) + method_section(page) + provenance_section(page);
  return html + "</main>\n<footer><p>Made by Palmar " + html_escaped(version()) +
         ". This file works without a network.</p></footer>\n" +
         (page.scene.empty() ? "" : "<script>" + script_escaped(viewer_bundle()) + "</script>\n") +
         "</body>\n</html>\n";
}

}  // namespace palmar
