// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// German reports of a product that no hand holds, of a redesign and of a scanned hand have no
// English in them: no word that German doesn't have stands in what people read or hear (text,
// alternatives to pictures, labels).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <string>
#include <vector>

#include "run_program.h"

namespace palmar::testing {
namespace {

/// Small words that every English sentence has some of, and that are no German words.
constexpr std::array kEnglishWords = {
    "the",    "of",     "and",  "is",    "are",  "with", "from",    "that",    "this",
    "which",  "its",    "it",   "be",    "has",  "have", "were",    "at",      "than",
    "but",    "what",   "they", "their", "each", "by",   "only",    "between", "after",
    "before", "hand's", "does", "to",    "for",  "on",   "touches", "held",    "finger's"};

/// What people read of a page: text, alt and aria-label, without scripts, styles, code, licences
/// and the titles of books.
std::vector<std::string> lines_of(std::string html) {
  for (const char* part : {"script", "style", "pre", "code"}) {
    const std::string open = std::string("<") + part, close = std::string("</") + part + ">";
    for (std::size_t at = html.find(open); at != html.npos; at = html.find(open, at)) {
      const std::size_t end = html.find(close, at);
      if (end == html.npos) break;
      html.erase(at, end + close.size() - at);
    }
  }
  std::vector<std::string> lines;
  static const std::regex attribute("(?:alt|aria-label)=\"([^\"]*)\"");
  std::size_t at = 0;
  while (at < html.size()) {
    const std::size_t open = html.find('<', at);
    lines.push_back(html.substr(at, open - at));
    if (open == html.npos) break;
    const std::size_t close = html.find('>', open);
    if (close == html.npos) break;
    const std::string tag = html.substr(open, close - open);
    std::smatch found;
    if (tag.size() < 4000 && std::regex_search(tag, found, attribute)) lines.push_back(found[1]);
    at = close + 1;
  }
  return lines;
}

/// Names that stay as they are in any language.
bool is_title(const std::string& line) {
  for (const char* name : {"Plausible 3D Human Hand Modeling", "Anthropometric Survey of",
                           "MIT License", "palmar assess ", "palmar study ", "palmar redesign "}) {
    if (line.find(name) != line.npos) return true;
  }
  return false;
}

std::string english_in(const std::string& line) {
  std::string word;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    const auto c = i < line.size() ? static_cast<unsigned char>(line[i]) : ' ';
    if (std::isalnum(c) != 0 || c == '\'' || c == '_' || c > 127) {
      word += static_cast<char>(std::tolower(c));
      continue;
    }
    if (std::find(kEnglishWords.begin(), kEnglishWords.end(), word) != kEnglishWords.end()) {
      return word;
    }
    word.clear();
  }
  return "";
}

void expect_no_english(const std::string& page) {
  const std::string html = read_text(page);
  ASSERT_FALSE(html.empty()) << page;
  EXPECT_NE(html.find("<html lang=\"de\">"), html.npos) << page;
  std::size_t seen = 0;
  for (const std::string& line : lines_of(html)) {
    ++seen;
    if (is_title(line)) continue;
    EXPECT_EQ(english_in(line), "") << page << ": " << line.substr(0, 300);
  }
  EXPECT_GT(seen, 100U) << page;
}

ProgramRun run_in(const std::string& folder, const std::string& arguments) {
  ProgramRun run = run_palmar(arguments, folder);
  EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
  return run;
}

TEST(GermanReport, EnglishIsSeenWhereItStands) {
  EXPECT_EQ(english_in("die Hand, the hand"), "the");
  EXPECT_EQ(english_in("Die Hand berührt es; joints_at_limit"), "");
  EXPECT_EQ(lines_of("a<script>the</script><img alt=\"of\">b").size(), 3U);
}

TEST(GermanReport, WhatIsNotHeld) {
  const std::string folder = temporary_folder();
  run_in(folder, "product make sphere --diameter-mm 200 --out ball.stl");
  run_in(folder, "assess ball.stl --unit mm --language de --limit-depths --out ball");
  expect_no_english(folder + "/ball/report.html");
}

TEST(GermanReport, ARedesign) {
  const std::string folder = temporary_folder();
  run_in(folder, "product make prism --fillet-mm 3 --out old.step");
  run_in(folder, "redesign press old.step --hands 3 --language de --out pressed");
  expect_no_english(folder + "/pressed/report/report.html");
}

TEST(GermanReport, APersonWithSensorsAndErrors) {
  const std::string folder = temporary_folder();
  run_in(folder, "product make prism --fillet-mm 3 --out old.step");
  run_in(folder,
         "assess old.step --person woman:P5,age=60 --left --sensors glove --error-budget "
         "--mass-kg 0.4 --friction 0.6 --coating 3,100 --hold 2 --language de --out person");
  expect_no_english(folder + "/person/report.html");
}

TEST(GermanReport, TwoProductsInAGrip) {
  const std::string folder = temporary_folder();
  run_in(folder, "product make prism --fillet-mm 3 --out old.step");
  run_in(folder, "product make cylinder --diameter-mm 30 --out new.stl");
  run_in(folder, "assess old.step new.stl --unit mm --grip tripod --language de --out two");
  expect_no_english(folder + "/two/report.html");
}

TEST(GermanReport, ASearchForABetterShape) {
  const std::string folder = temporary_folder();
  run_in(folder, "product make prism --fillet-mm 3 --out old.step");
  run_in(folder,
         "redesign fillet old.step --edges long --radius-mm 1:15 --hands 2 --evaluations 3 "
         "--language de --out search");
  expect_no_english(folder + "/search/report/report.html");
}

TEST(GermanReport, WhereHandsTouch) {
  const std::string folder = temporary_folder();
  run_in(folder, "product make prism --fillet-mm 3 --out old.step");
  run_in(folder, "redesign region old.step --hands 3 --language de --out region");
  expect_no_english(folder + "/region/report/report.html");
}

TEST(GermanReport, AStudyOfPeopleAndProducts) {
  const std::string folder = temporary_folder();
  run_in(folder, "product make prism --fillet-mm 3 --out old.step");
  run_in(folder, "product make cylinder --diameter-mm 90 --out large.stl");
  run_in(folder,
         "assess old.step large.stl --unit mm --population woman:P5..man:P95 --mass-kg 0.4 "
         "--language de --out people");
  expect_no_english(folder + "/people/report.html");
}

TEST(GermanReport, AHandFromAScan) {
  const std::string folder = temporary_folder();
  run_in(folder, "phantom scan --out person");
  run_in(folder,
         "hand from-scan person/scan/reference.ply --language de --truth "
         "person/truth/subject.json --out anna.hand.glb");
  expect_no_english(folder + "/anna.scan/report.html");
}

}  // namespace
}  // namespace palmar::testing
