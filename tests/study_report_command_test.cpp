// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// `palmar study report` and `compare`: what the page holds, what it never does, and that the same
// results give the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "run_program.h"

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// Two sizes of one prism, and the big one twice: under its own name and, posture and all, as its
// twin. The load makes nothing slip.
constexpr const char* kStudy = R"(
[study]
name = "report-test"
title = "Prisms <of two sizes>"
seed = 5
[[population]]
preset = "xie2014"
hands = 5
[[product]]
name = "prism"
kind = "prism"
width_mm = 35
depth_mm = 35
length_mm = 120
fillet_mm = 5
sizes = [0.9, 1.0]
[[product]]
name = "twin"
kind = "prism"
width_mm = 35
depth_mm = 35
length_mm = 120
fillet_mm = 5
[settings]
indices = false
[[limit]]
quantity = "peak_pressure_cells_mpa"
highest = 0.7
)";

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::string cell;
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.push_back(cell);
      cell.clear();
    } else {
      cell += c;
    }
  }
  cells.push_back(cell);
  return cells;
}

/// Rows of a CSV file, cells by column name.
std::vector<std::map<std::string, std::string>> table(const std::string& path) {
  std::istringstream text(read_text(path));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> header = split(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(text, line)) {
    const std::vector<std::string> cells = split(line);
    EXPECT_EQ(cells.size(), header.size()) << path << ": " << line;
    for (rows.emplace_back(); rows.back().size() < header.size();) {
      const std::size_t k = rows.back().size();
      rows.back().emplace(header[k], cells[k]);
    }
  }
  return rows;
}

class StudyReportCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = temporary_folder();
    write_text(folder_ + "/study.toml", kStudy);
    const ProgramRun made = run("study run study.toml --out study.palmar --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const ProgramRun report = run("study report study.palmar --out report --quiet");
    ASSERT_EQ(report.exit_code, 0) << report.err;
    page_ = read_text(folder_ + "/report/report.html");
  }
  static ProgramRun run(const std::string& arguments) { return run_palmar(arguments, folder_); }
  static std::string folder_, page_;
};
std::string StudyReportCommand::folder_, StudyReportCommand::page_;

TEST_F(StudyReportCommand, PageNeedsNoNetworkAndIsSmall) {
  EXPECT_LT(page_.size(), 15U << 20);
  EXPECT_THAT(page_, HasSubstr("default-src 'none'"));
  for (const char* reach :
       {"http://", "https://", "src=\"//", "<link", "@import", "XMLHttpRequest", "WebSocket"}) {
    std::size_t at = page_.find(reach);
    // Names of XML are addresses that nobody opens.
    while (at != std::string::npos && page_.compare(at, 18, "http://www.w3.org/") == 0) {
      at = page_.find(reach, at + 1);
    }
    EXPECT_EQ(at, std::string::npos) << reach << ": " << page_.substr(at, 80);
  }
  EXPECT_THAT(page_, HasSubstr("Prisms &lt;of two sizes&gt;"));
}

TEST_F(StudyReportCommand, PageHoldsTheNumbersOfTheTables) {
  int seen = 0;
  for (const auto& row : table(folder_ + "/report/statistics.csv")) {
    if (row.at("quantity") != "peak_pressure_cells_mpa" && row.at("quantity") != "force_n")
      continue;
    EXPECT_EQ(row.at("n"), "5");
    EXPECT_THAT(page_, HasSubstr("data-value=\"" + row.at("mean") + "\"")) << row.at("product");
    ++seen;
  }
  EXPECT_EQ(seen, 6);
  for (const char* words : {"Verdict", "Mixes the sexes", "seed 5", "SHA-256", "Sizes of prism",
                            "blood flow", "three.js"}) {
    EXPECT_THAT(page_, HasSubstr(words));
  }
}

TEST_F(StudyReportCommand, FacesSumUpToTheirProduct) {
  std::map<std::string, double> total;  // N, on the skin
  for (const auto& row : table(folder_ + "/report/statistics.csv")) {
    if (row.at("quantity") == "force_n") total[row.at("product")] = std::stod(row.at("mean"));
  }
  std::map<std::string, double> force, share;
  std::map<std::string, int> with_peak;
  std::map<std::string, std::string> of_prism;  // peaks by face
  for (const auto& row : table(folder_ + "/report/faces.csv")) {
    const std::string& product = row.at("product");
    force[product] += std::stod(row.at("force_mean_n"));
    share[product] += std::stod(row.at("force_share_mean"));
    with_peak[product] += std::stoi(row.at("has_peak"));
    EXPECT_LE(std::stod(row.at("peak_mean_mpa")), std::stod(row.at("peak_max_mpa")) + 1e-12);
    EXPECT_EQ(row.at("hands"), "5");
    if (row.at("kind") == "cylinder") {
      EXPECT_EQ(row.at("is_fillet"), "1");
      EXPECT_EQ(row.at("radius_mm"), product == "prism x 0.9" ? "4.5" : "5");
    }
    if (product == "prism") of_prism[row.at("face")] = row.at("peak_mean_mpa");
    if (product == "twin") {
      EXPECT_EQ(row.at("peak_mean_mpa"), of_prism.at(row.at("face")));
    }
  }
  ASSERT_EQ(force.size(), 3U);
  for (const auto& [product, sum] : force) {
    // The map's vertices are 3 mm apart, the skin's 2.3 mm.
    EXPECT_NEAR(sum, total.at(product), 0.12 * total.at(product)) << product;
    EXPECT_NEAR(share.at(product), 1.0, 1e-9) << product;
    EXPECT_EQ(with_peak.at(product), 5) << product;
  }
  EXPECT_THAT(page_, HasSubstr("Faces of the products"));
  EXPECT_THAT(page_, HasSubstr("highest of the product in"));
  EXPECT_THAT(page_, HasSubstr("\"ofTriangle\":\""));
}

TEST_F(StudyReportCommand, TablesHaveMeansOfTheRecords) {
  // The mean over hands, computed here from the export of single grasps.
  const ProgramRun exported = run("study export study.palmar --out export --quiet");
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  std::string grasps;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ + "/export")) {
    if (entry.path().filename() == "grasps.csv") grasps = entry.path().string();
  }
  ASSERT_FALSE(grasps.empty());
  std::map<std::string, std::pair<double, int>> sums;
  for (const auto& row : table(grasps)) {
    auto& [sum, count] = sums[row.at("product")];
    sum += std::stod(row.at("peak_pressure_cells_mpa"));
    ++count;
  }
  ASSERT_EQ(sums.size(), 3U);
  for (const auto& row : table(folder_ + "/report/statistics.csv")) {
    if (row.at("quantity") != "peak_pressure_cells_mpa") continue;
    const auto& [sum, count] = sums.at(row.at("product"));
    EXPECT_NEAR(std::stod(row.at("mean")), sum / count, 1e-12) << row.at("product");
  }
}

TEST_F(StudyReportCommand, SameResultsGiveTheSameBytesOnAnyThreads) {
  const ProgramRun again = run("study report study.palmar --out again --threads 1 --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ + "/report")) {
    if (!entry.is_regular_file()) continue;
    const fs::path other =
        fs::path(folder_ + "/again") / fs::relative(entry.path(), folder_ + "/report");
    EXPECT_TRUE(read_text(entry.path().string()) == read_text(other.string())) << other;
    ++files;
  }
  EXPECT_GT(files, 40);
}

TEST_F(StudyReportCommand, AProductAndItsTwinDoNotDiffer) {
  const ProgramRun found = run("study compare study.palmar --json");
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const json object = json::parse(found.out);
  const json& quantity = object.at("conditions").at(0).at("quantities").at(0);
  EXPECT_EQ(quantity.at("quantity"), "peak_pressure_cells_mpa");
  ASSERT_EQ(quantity.at("pairs").size(), 3U);
  int twins = 0;
  for (const json& pair : quantity.at("pairs")) {
    EXPECT_EQ(pair.at("hands"), 5);
    EXPECT_EQ(pair.at("pairs"), 5);
    EXPECT_TRUE(pair.at("left_out").empty());
    if (pair.at("verdict") != "none") continue;
    ++twins;
    EXPECT_EQ(pair.at("difference"), 0.0);
    EXPECT_EQ(pair.at("t_test").at("p_value_holm"), 1.0);
  }
  EXPECT_EQ(twins, 1);
}

TEST_F(StudyReportCommand, FiguresAreThereWithoutADisplay) {
  for (const char* name :
       {"peak_pressure_cells_mpa", "contact_area_mm2_by_hand_length", "accommodation"}) {
    const std::string path = folder_ + "/report/figures/" + name;
    EXPECT_EQ(read_text(path + ".png").substr(1, 3), "PNG") << name;
    EXPECT_EQ(read_text(path + ".pdf").substr(0, 5), "%PDF-") << name;
    EXPECT_THAT(read_text(path + ".svg"), HasSubstr("<svg")) << name;
  }
}

TEST_F(StudyReportCommand, RefusesWithWords) {
  const ProgramRun quantity = run("study compare study.palmar --quantity forc_n");
  EXPECT_EQ(quantity.exit_code, 2);
  EXPECT_THAT(quantity.err, HasSubstr("did you mean force_n?"));
  const ProgramRun missing = run("study report nothing.palmar --out there");
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("nothing.palmar"));
  fs::create_directory(folder_ + "/mine");
  write_text(folder_ + "/mine/report.html", "<html>my own</html>");
  const ProgramRun foreign = run("study report study.palmar --out mine --quiet");
  EXPECT_EQ(foreign.exit_code, 2);
  EXPECT_THAT(foreign.err, HasSubstr("was not written by Palmar"));
  EXPECT_EQ(read_text(folder_ + "/mine/report.html"), "<html>my own</html>");
  const ProgramRun threshold = run("study report study.palmar --out t --threshold-kpa -1 --quiet");
  EXPECT_EQ(threshold.exit_code, 2);
  EXPECT_THAT(threshold.err, HasSubstr("--threshold-kpa is -1 kPa"));
}

}  // namespace
}  // namespace palmar::testing
