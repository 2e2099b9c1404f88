// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/pressure_thresholds.h"
#include "palmar/report/chart/bar_chart.h"
#include "palmar/report/page/assessment_report.h"
#include "palmar/report/picture/assessment_pictures.h"
#include "palmar/report/picture/stroke_text.h"
#include "palmar/report/words/html_text.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {
namespace {

using testing::HasSubstr;
using testing::Not;

// A ball that stands for a hand, pressed against a box at its palmar pole with known numbers.
study::AssessmentSet ball_set() {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "ball <hand>";
  hand->skin = geometry::make_icosphere(30.0, 2);
  hand->segment.assign(hand->skin.vertices.size(), hand::Segment::kPalm);
  hand->region.assign(hand->skin.vertices.size(), hand::Region::kCentralPalm);
  hand->dimensions.hand_length = 186.5;
  study::AssessedProduct one;
  one.product.name = "box & \"co\"";
  one.product.mesh = geometry::make_box({20, 60, 20}, 6);
  for (Vec3& v : one.product.mesh.vertices) v.z() += 38.0;
  one.assessment.grasp.status = grasp::GraspStatus::kPartlyHeld;
  one.assessment.grasp.message = "only the palm <touches>";
  contact::ContactResult& contact = one.assessment.contact;
  contact.status = contact::ContactStatus::kSolved;
  contact.undeformed = hand->skin.vertices;
  contact.deformed = hand->skin.vertices;
  for (Vec3& v : contact.deformed) {
    contact.pressure.push_back(v.z() > 25.0 ? 0.123456789 : 0.0);
    v.z() = std::min(v.z(), 28.0);
  }
  contact::RegionContact palm{.region = hand::Region::kCentralPalm,
                              .force = 12.3456789,
                              .area = 345.678901,
                              .peak_pressure = 0.123456789,
                              .peak_pressure_cells = 0.0987654321,
                              .mean_pressure = 0.0357142857};
  contact.regions = {palm};
  contact.total = palm;
  return {.hand = hand, .assessments = {one, one}, .command_line = "palmar assess a b"};
}

class ReportFolder : public testing::Test {
 protected:
  formats::TestFolder own_;
  std::filesystem::path folder_ = own_ / "report";
};

// Elements of an HTML or SVG text that are not closed in order; scripts and styles are skipped.
std::vector<std::string> badly_nested(const std::string& text) {
  std::vector<std::string> open;
  std::vector<std::string> wrong;
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i)) {
    if (text.compare(i, 2, "<!") == 0) {
      i = text.find('>', i);
      continue;
    }
    const std::size_t end = text.find('>', i);
    const bool is_end = text[i + 1] == '/';
    std::size_t stop = i + 1;
    while (stop < end && text[stop] != ' ' && !(stop > i + 1 && text[stop] == '/')) ++stop;
    const std::string name = text.substr(i + 1 + (is_end ? 1 : 0), stop - i - 1 - (is_end ? 1 : 0));
    if (is_end) {
      if (open.empty() || open.back() != name) {
        wrong.push_back(name);
      } else {
        open.pop_back();
      }
    } else if (text[end - 1] != '/' && name != "meta" && name != "img" && name != "input") {
      open.push_back(name);
      if (name == "script" || name == "style") {
        i = text.find("</" + name, end);
        continue;
      }
    }
    i = end;
  }
  wrong.insert(wrong.end(), open.begin(), open.end());
  return wrong;
}

TEST_F(ReportFolder, HoldsEverythingADesignerOpens) {
  const study::AssessmentSet set = ball_set();
  write_report(folder_.string(), set, {.picture_width = 200, .picture_height = 140});
  for (const char* name : {"report.html", "assessment.json", "regions.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
  int pictures = 0;
  int folders = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    if (entry.is_directory()) ++folders;
    if (entry.path().extension() != ".png") continue;
    ++pictures;
    const Image image = decode_png(formats::read_file(entry.path()));
    EXPECT_EQ(image.width, 200) << entry.path();
  }
  EXPECT_EQ(folders, 2);  // two products of the same name don't overwrite each other
  EXPECT_EQ(pictures, 26);

  const std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_EQ(badly_nested(html), std::vector<std::string>{});
  EXPECT_THAT(html, HasSubstr("box &amp; &quot;co&quot;"));
  EXPECT_THAT(html, HasSubstr("Only the palm &lt;touches&gt;"));
  EXPECT_THAT(html, HasSubstr("Permission is hereby granted"));  // licence of three.js
  EXPECT_THAT(html, HasSubstr("What this does not model"));

  // No address but the names of XML vocabularies, which nobody fetches.
  const std::regex address("https?://[^\"'`\\s<]*");
  for (auto it = std::sregex_iterator(html.begin(), html.end(), address);
       it != std::sregex_iterator(); ++it) {
    EXPECT_THAT(it->str(), testing::StartsWith("http://www.w3.org/"));
  }
  EXPECT_THAT(html, Not(HasSubstr("src=\"//")));
}

TEST_F(ReportFolder, NumbersInTheHtmlAreThoseOfTheJson) {
  write_report(folder_.string(), ball_set(), {.pictures = false});
  const auto json = nlohmann::json::parse(formats::read_file(folder_ / "assessment.json"));
  const std::string html = formats::read_file(folder_ / "report.html");
  const auto& contact = json["assessments"][0]["contact"];
  for (const char* key : {"force_n", "contact_area_mm2", "peak_pressure_mpa",
                          "peak_pressure_cells_mpa", "mean_pressure_mpa"}) {
    const double value = contact[key].get<double>();
    EXPECT_THAT(html, HasSubstr("data-value=\"" + exact_number(value) + "\"")) << key;
  }
  // The JSON inside the report is the file itself.
  const std::string opening = "id=\"palmar-assessment\">";
  const auto from = html.find(opening) + opening.size();
  const std::string inside = html.substr(from, html.find("</script>", from) - from);
  EXPECT_EQ(nlohmann::json::parse(inside), json);
}

TEST_F(ReportFolder, SameInputGivesTheSameBytes) {
  write_report(folder_.string(), ball_set(), {.picture_width = 128, .picture_height = 96});
  const std::string first = formats::read_file(folder_ / "report.html");
  write_report(folder_.string(), ball_set(), {.picture_width = 128, .picture_height = 96});
  EXPECT_EQ(formats::read_file(folder_ / "report.html"), first);
}

TEST_F(ReportFolder, NothingTouchedIsReportedToo) {
  study::AssessmentSet set = ball_set();
  set.assessments.resize(1);
  set.assessments[0].assessment.contact = {};
  set.assessments[0].assessment.grasp.status = grasp::GraspStatus::kTooLarge;
  write_report(folder_.string(), set, {.picture_width = 100, .picture_height = 80});
  const std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_THAT(html, HasSubstr("Too large for this hand"));
  EXPECT_THAT(html, HasSubstr("so there is no pressure to judge"));
  EXPECT_THAT(html, HasSubstr("too large for this hand"));
}

TEST_F(ReportFolder, WhatIsNotHeldHasDashesInsteadOfVerdicts) {
  study::AssessmentSet set = ball_set();
  set.assessments[1].assessment.grasp.status = grasp::GraspStatus::kTooSmall;
  write_report(folder_.string(), set, {.pictures = false});
  const std::string html = formats::read_file(folder_ / "report.html");
  const auto results = html.find("Results at a glance");
  const auto row = html.find("href=\"#product-1\"", results);
  const std::string cells = html.substr(row, html.find("</tr>", row) - row);
  EXPECT_THAT(cells, HasSubstr("badge bad"));
  EXPECT_THAT(cells, HasSubstr("not in the hand"));
  EXPECT_THAT(cells, Not(HasSubstr("pain")));
  EXPECT_THAT(cells, Not(HasSubstr("data-value")));
  const auto held = html.find("href=\"#product-0\"", results);
  EXPECT_THAT(html.substr(held, row - held), HasSubstr("badge fair"));
  EXPECT_THAT(html, HasSubstr("<p class=\"note bad\"><strong>Too small"));
  EXPECT_THAT(html, HasSubstr("<p class=\"note fair\"><strong>Partly held"));
}

TEST_F(ReportFolder, TwoProductsStandSideBySideWithTheirDifferences) {
  study::AssessmentSet set = ball_set();
  contact::ContactResult& second = set.assessments[1].assessment.contact;
  second.regions[0].force = 10.0;
  second.total.force = 10.0;
  second.regions.push_back({.region = hand::Region::kThenar, .force = 1.5, .area = 20.0});
  write_report(folder_.string(), set, {.picture_width = 100, .picture_height = 80});
  std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_EQ(badly_nested(html), std::vector<std::string>{});
  const auto from = html.find("id=\"difference\"");
  ASSERT_NE(from, std::string::npos);
  const std::string table = html.substr(from, html.find("</table>", from) - from);
  EXPECT_THAT(table, HasSubstr("data-value=\"" + exact_number(10.0 - 12.3456789) + "\""));
  EXPECT_THAT(table, HasSubstr(">+1.50<"));  // only the second touches the thenar
  set.assessments.resize(1);
  write_report(folder_.string(), set, {.pictures = false});
  EXPECT_THAT(formats::read_file(folder_ / "report.html"), Not(HasSubstr("id=\"difference\"")));
  set = ball_set();
  set.assessments.push_back(set.assessments[0]);
  write_report(folder_.string(), set, {.pictures = false});
  html = formats::read_file(folder_ / "report.html");
  EXPECT_THAT(html, HasSubstr("No product is clearly the best"));
  EXPECT_THAT(html, Not(HasSubstr("id=\"difference\"")));
}

// The ball's palm with soft and stiff tissue.
void add_band(contact::ContactResult& contact, double force_low, double force_high) {
  const contact::ContactBandRow row{.region = hand::Region::kCentralPalm,
                                    .force_low = force_low,
                                    .force_high = force_high,
                                    .area_low = 340.0,
                                    .area_high = 350.0,
                                    .peak_pressure_low = 0.08,
                                    .peak_pressure_high = 0.19,
                                    .peak_pressure_cells_low = 0.04,
                                    .peak_pressure_cells_high = 0.13,
                                    .force_per_modulus = 12.0};
  contact.band = contact::ContactBand{.regions = {row}, .total = row};
}

TEST_F(ReportFolder, ReportsHowSureTheNumbersAre) {
  study::AssessmentSet set = ball_set();
  add_band(set.assessments[0].assessment.contact, 8.5, 15.5);
  add_band(set.assessments[1].assessment.contact, 8.0, 16.0);
  write_report(folder_.string(), set, {.pictures = false});
  const std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_EQ(badly_nested(html), std::vector<std::string>{});
  EXPECT_THAT(html, HasSubstr("8.50 to 15.5 N (middle 12.3 N)"));
  EXPECT_THAT(html, HasSubstr("10 % stiffer (middle of the palm), the hand would press with 1.2 N "
                              "more"));
  EXPECT_THAT(html, HasSubstr("data-value=\"15.5\""));
  // Softer, the second presses less; stiffer, more.
  EXPECT_THAT(html, HasSubstr("−0.50 N with soft, 0 with middle and +0.50 with stiff tissue. Which "
                              "is higher depends on the skin."));
}

TEST_F(ReportFolder, EndOfTheBandWithoutSolutionIsADash) {
  study::AssessmentSet set = ball_set();
  add_band(set.assessments[0].assessment.contact, 0.0, 15.5);
  write_report(folder_.string(), set, {.pictures = false});
  const std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_THAT(html, HasSubstr("– to 15.5 N"));
  EXPECT_THAT(html, HasSubstr("could not be solved"));
  const auto json = nlohmann::json::parse(formats::read_file(folder_ / "assessment.json"));
  const auto& force = json["assessments"][0]["contact"]["band"]["force_n"];
  EXPECT_TRUE(force["low"].is_null());
  EXPECT_EQ(force["high"], 15.5);
}

TEST_F(ReportFolder, LimitsAreThoseOfTheEquationsThatRan) {
  study::AssessmentSet set = ball_set();
  write_report(folder_.string(), set, {.pictures = false});
  const std::string palmar = formats::read_file(folder_ / "report.html");
  EXPECT_THAT(palmar, Not(HasSubstr("solved one by one;")));
  EXPECT_THAT(palmar, Not(HasSubstr("How sure are these numbers?")));  // no band was asked for
  for (study::AssessedProduct& one : set.assessments) {
    one.assessment.contact.model = contact::xie2014_model();
    one.assessment.options.contact.coatings = {
        {.thickness = 3.0, .shear_modulus = 0.1, .poisson = 0.4, .where = {}}};
  }
  write_report(folder_.string(), set, {.pictures = false});
  const std::string xie = formats::read_file(folder_ / "report.html");
  EXPECT_THAT(xie, HasSubstr("solved one by one;"));
  EXPECT_THAT(xie, HasSubstr("Equations that ran: xie2014."));
  EXPECT_THAT(xie, HasSubstr("Under its sleeve the product is rigid"));
  EXPECT_THAT(xie, HasSubstr("3.00 mm thick, shear modulus 100 kPa, Poisson’s ratio 0.40, on "
                             "the whole product"));
}

TEST_F(ReportFolder, CancelledKeepsTheNumbersAndAReport) {
  std::atomic<bool> stop{true};
  const Progress progress{.report = {}, .cancel = &stop};
  EXPECT_THROW(write_report(folder_.string(), ball_set(), {}, progress), Cancelled);
  const auto json = nlohmann::json::parse(formats::read_file(folder_ / "assessment.json"));
  EXPECT_EQ(json["assessments"].size(), 2U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "regions.csv"));
  const std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_EQ(badly_nested(html), std::vector<std::string>{});
  EXPECT_THAT(html, HasSubstr("This run was cancelled."));
}

TEST_F(ReportFolder, CancelledBetweenProductsKeepsThePicturesOfTheFirst) {
  std::atomic<bool> stop{false};
  int calls = 0;
  const Progress progress{.report = [&](double, const std::string&) { stop = ++calls == 2; },
                          .cancel = &stop};
  EXPECT_THROW(write_report(folder_.string(), ball_set(),
                            {.picture_width = 100, .picture_height = 80}, progress),
               Cancelled);
  const std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_THAT(html, HasSubstr("alt=\"box &amp; &quot;co&quot;: pressure drawn"));
  EXPECT_THAT(html, HasSubstr("This run was cancelled."));
}

TEST_F(ReportFolder, NeverOverwritesWhatPalmarDidNotWrite) {
  std::filesystem::create_directories(folder_);
  for (const char* name : {"report.html", "assessment.json", "regions.csv"}) {
    formats::write_file(folder_ / name, "{\"mine\": 1}");
    try {
      write_report(folder_.string(), ball_set(), {.pictures = false});
      ADD_FAILURE() << name << " was overwritten";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(name));
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << name;
    std::filesystem::remove(folder_ / name);
  }
  write_report(folder_.string(), ball_set(), {.pictures = false});
  EXPECT_NO_THROW(check_report_folder(folder_.string()));  // its own report may be renewed
  EXPECT_NO_THROW(check_report_folder((folder_ / "new").string()));
  EXPECT_THROW(check_report_folder((folder_ / "report.html").string()), OutputError);
}

TEST_F(ReportFolder, UnwritableFolderIsAnOutputError) {
  std::filesystem::create_directories(folder_);
  const auto file = folder_ / "taken";
  formats::write_file(file, "x");
  EXPECT_THROW(write_report((file / "inside").string(), ball_set()), OutputError);
  EXPECT_THROW(write_report(folder_.string(), ball_set(), {.picture_width = 10}), UsageError);
}

TEST(AssessmentPictures, PressedPoleIsColouredInTheCommonScale) {
  const study::AssessmentSet set = ball_set();
  const ColourScale scale = pressure_scale(set);
  EXPECT_DOUBLE_EQ(scale.upper, 0.1);  // MPa; next round number above 0.0988 on cells
  const auto pictures =
      assessment_pictures(*set.hand, set.assessments[0], scale, {.width = 300, .height = 210});
  ASSERT_EQ(pictures.size(), 13U);
  const auto palm = std::find_if(pictures.begin(), pictures.end(),
                                 [](const Picture& p) { return p.name == "pressure_palm"; });
  ASSERT_NE(palm, pictures.end());
  const auto coloured =
      std::count_if(palm->image.pixels.begin(), palm->image.pixels.begin() + 300 * 180,
                    [](Rgb c) { return c.r > c.g + 60; });
  EXPECT_GT(coloured, 200);
  EXPECT_THAT(palm->alt, HasSubstr("palm side"));
}

TEST(PressureScale, OneBadVertexDoesNotDarkenThePictures) {
  study::AssessmentSet set = ball_set();
  set.assessments[1].assessment.contact.total.peak_pressure = 9.0;
  const ColourScale scale = pressure_scale(set);
  EXPECT_DOUBLE_EQ(scale.upper, 0.1);
  ASSERT_TRUE(scale.is_open_ended);
  EXPECT_EQ(ticks_of(scale).text.back(), "\u2265 0.10");
  for (study::AssessedProduct& one : set.assessments) {
    one.assessment.contact.total.peak_pressure = 0.0987;
  }
  EXPECT_FALSE(pressure_scale(set).is_open_ended);
  EXPECT_EQ(ticks_of(pressure_scale(set)).text.back(), "0.10");
}

TEST(PressureScale, IsSetByTheProductsThatAreHeld) {
  study::AssessmentSet set = ball_set();
  set.assessments[1].assessment.grasp.status = grasp::GraspStatus::kTooLarge;
  set.assessments[1].assessment.contact.total.peak_pressure_cells = 5.0;
  EXPECT_DOUBLE_EQ(pressure_scale(set).upper, 0.1);
}

TEST(PressureLimits, FilmValuesOfTheStandardAreHeldAgainstPeaks) {
  EXPECT_DOUBLE_EQ(grasp::pain_onset_film(hand::Region::kIndexDistal), 3.0);
  EXPECT_DOUBLE_EQ(grasp::pain_onset_film(hand::Region::kUlnarPalm), 2.6);
  EXPECT_DOUBLE_EQ(grasp::pain_onset_film(hand::Region::kThenar), 2.0);
}

TEST_F(ReportFolder, TheAnswerIsTheSameOnThePageAndInTheJson) {
  write_report(folder_.string(), ball_set(), {.picture_width = 100, .picture_height = 80});
  const auto json = nlohmann::json::parse(formats::read_file(folder_ / "assessment.json"));
  const std::string html = formats::read_file(folder_ / "report.html");
  const std::string sentence = html_escaped(json["verdict"]["sentence"].get<std::string>());
  ASSERT_FALSE(sentence.empty());
  const auto answer = html.find("id=\"answer\"");
  EXPECT_LT(html.find(sentence), html.find("</section>", answer));
  // What is doubtful isn't compared.
  EXPECT_THAT(sentence, HasSubstr("No verdict"));
  EXPECT_EQ(json["assessments"][0]["verdict"]["held"], "doubtful");
}

TEST_F(ReportFolder, SpeaksGerman) {
  write_report(folder_.string(), ball_set(), {.language = Language::kGerman, .pictures = false});
  const std::string html = formats::read_file(folder_ / "report.html");
  EXPECT_THAT(html, HasSubstr("<html lang=\"de\">"));
  EXPECT_THAT(html, HasSubstr("Kein Urteil"));
  EXPECT_THAT(html, Not(HasSubstr("What follows")));
}

TEST(BarChart, IsWellFormedAndBarsAreInProportion) {
  // 254 wide at the scale's end, which is 10 N: 560 less 250 for labels and 56 for values.
  const std::string svg = to_svg(bar_figure({"Force, N", {{"a <b>", 10.0}, {"c", 5.0}}}));
  EXPECT_EQ(badly_nested(svg), std::vector<std::string>{});
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt;"));
  EXPECT_THAT(svg, HasSubstr("points=\"250,37 504,37 504,53 250,53\""));
  EXPECT_THAT(svg, HasSubstr("points=\"250,61 377,61 377,77 250,77\""));
  EXPECT_THAT(to_svg(bar_figure({"Force, N", {}, "No contact."})), HasSubstr("No contact."));
  // What isn't a chart of contact doesn't speak of it.
  const std::string empty = to_svg(bar_figure({"Thumb, mm", {}, "No posture shows it."}));
  EXPECT_THAT(empty, HasSubstr("No posture shows it."));
  EXPECT_THAT(empty, Not(HasSubstr("contact")));
  // The range widens the scale: 20 N is the chart's whole width.
  const std::string ranged =
      to_svg(bar_figure({"Force, N", {{"a", 10.0, {}, BarRange{5.0, 20.0}}}}));
  EXPECT_EQ(badly_nested(ranged), std::vector<std::string>{});
  EXPECT_THAT(ranged, HasSubstr("points=\"250,37 377,37 377,53 250,53\""));
  EXPECT_THAT(ranged, HasSubstr("points=\"313.5,45 504,45\""));  // 250 + 254 / 4 to 250 + 254
}

TEST(PlainWords, NumbersAreShortenedNotRoundedBeforeThePoint) {
  EXPECT_EQ(short_number(0.18234), "0.182");
  EXPECT_EQ(short_number(1234.6), "1235");
  EXPECT_EQ(short_number(0.0), "0");
  EXPECT_EQ(short_number(-2.5), "-2.50");
  EXPECT_EQ(short_number(0.0123456), "0.0123");
  EXPECT_EQ(std::stod(exact_number(0.1 + 0.2)), 0.1 + 0.2);
}

TEST(PlainWords, RegionsReadAsADesignerCallsThem) {
  EXPECT_EQ(plain_words(hand::Region::kIndexDistal), "index finger, tip");
  EXPECT_EQ(plain_words(hand::Region::kThumbProximal), "thumb, base");
  EXPECT_EQ(plain_words(hand::Segment::kLittleMiddle), "little finger, middle");
  EXPECT_EQ(plain_words(hand::Dof::kIndexPipFlexion), "index PIP flexion");
}

TEST(HtmlText, NothingBreaksOutOfTextOrScript) {
  EXPECT_EQ(html_escaped("<a href='x'>&\"</a>"), "&lt;a href=&#39;x&#39;&gt;&amp;&quot;&lt;/a&gt;");
  EXPECT_EQ(html_escaped("mm\xc2\xb2"), "mm\xc2\xb2");
  EXPECT_EQ(html_escaped("bad\xff\x01"), "bad\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(script_escaped("\"</script><!--\""), "\"<\\/script>\\u003c!--\"");
}

TEST(StrokeText, WidthGrowsWithTheTextAndInkStaysInside) {
  EXPECT_EQ(text_width(""), 0.0);
  EXPECT_GT(text_width("24 mm\xc2\xb2"), text_width("24 mm"));
  Image image(200, 40);
  draw_text(image, 100, 30, "0.25", {.cap_height = 16, .colour = kBlack, .align = Align::kCentre});
  const double half = 0.5 * text_width("0.25", {.cap_height = 16}) + 3.0;
  int ink = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y) == kWhite) continue;
      ++ink;
      EXPECT_LT(std::abs(x - 100), half);
      EXPECT_GT(y, 10);
      EXPECT_LT(y, 33);
    }
  }
  EXPECT_GT(ink, 60);
}

}  // namespace
}  // namespace palmar::report
