// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "run_program.h"

// contact fit and tissue files, run as a user runs them.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kSphere = " --specimen plane --indenter sphere:10 --spacing-mm 2.5";

/// Hertz forces of a sphere of 10 mm on tissue of G0 = 8, G_lim = 60 kPa at 3 mm.
std::string folder_with_curves() {
  std::string folder = temporary_folder();
  std::ofstream file(folder + "/curves.csv");
  file << "depth_mm,force_mN\n";
  for (int i = 1; i <= 10; ++i) {
    const double depth = 0.5 * i;
    const double modulus = 0.008 + 0.052 * std::min(1.0, depth / 3.0);
    file << depth << ',' << 16000.0 / 3.0 * modulus * std::sqrt(10.0) * std::pow(depth, 1.5)
         << '\n';
  }
  return folder;
}

TEST(ContactFitCommand, FindsTheLawAndWritesATissueFileThatPressTakes) {
  const std::string folder = folder_with_curves();
  const ProgramRun run = run_palmar(
      "contact fit curves.csv" + std::string(kSphere) + " --json --out fit.toml", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json fit = Json::parse(run.out);
  const Json& tissue = fit.at("tissue").at("nominal");
  EXPECT_NEAR(tissue.at("g0_kpa").get<double>(), 8.0, 0.4);
  EXPECT_NEAR(tissue.at("g_limit_kpa").get<double>(), 60.0, 1.0);
  EXPECT_NEAR(tissue.at("limit_depth_mm").get<double>(), 3.0, 0.1);
  EXPECT_EQ(fit.at("points").size(), 10U);
  EXPECT_EQ(fit.at("status"), "converged");

  // The tissue file gives the forces back: 2 mm by Hertz, G = 8 + 52 * 2/3 kPa.
  const ProgramRun press = run_palmar(
      "contact press" + std::string(kSphere) + " --depth-mm 2 --tissue fit.toml --json", folder);
  ASSERT_EQ(press.exit_code, 0) << press.err;
  const double force = Json::parse(press.out).at("steps").at(0).at("force_n").get<double>();
  const double truth = 16.0 / 3.0 * 0.042667 * std::sqrt(10.0) * std::pow(2.0, 1.5);
  EXPECT_NEAR(force, truth, 0.02 * truth);
}

TEST(ContactFitCommand, TextNamesWhatIsNotIdentifiable) {
  const std::string folder = temporary_folder();
  write_text(folder + "/short.csv", "depth_mm,force_n\n0.5,0.1\n1,0.4\n1.5,1.0\n2,2.1\n2.5,3.6\n");
  const ProgramRun run = run_palmar("contact fit short.csv" + std::string(kSphere), folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("d_lim is not identifiable"));
  EXPECT_THAT(run.out, HasSubstr("95 % confidence"));
}

TEST(ContactFitCommand, MistakesAreNamed) {
  const std::string folder = folder_with_curves();
  const auto message = [&](const std::string& arguments, int code) {
    const ProgramRun run = run_palmar("contact fit " + arguments, folder);
    EXPECT_EQ(run.exit_code, code) << arguments << "\n" << run.err;
    return run.err;
  };
  write_text(folder + "/bad.csv", "depth_mm,force_kg\n1,2\n");
  write_text(folder + "/few.csv", "depth_mm,force_n\n1,2\n2,5\n");
  write_text(folder + "/deep.csv", "depth_mm,force_n\n1,2\n12,5\n2,3\n3,4\n");
  EXPECT_THAT(message("nothing.csv --indenter sphere:10", 3), HasSubstr("nothing.csv"));
  EXPECT_THAT(message("bad.csv --indenter sphere:10", 3), HasSubstr("unit \"kg\" is not known"));
  EXPECT_THAT(message("deep.csv --indenter sphere:10", 3),
              HasSubstr("deep.csv:3: depth_mm is 12; at most 10 mm is allowed with the indenter "
                        "sphere:10"));
  EXPECT_THAT(message("few.csv --indenter sphere:10", 3), HasSubstr("2 readings; at least 4"));
  EXPECT_THAT(message("curves.csv --indenter sphere:10 --group fingers", 2), HasSubstr("finger?"));
  EXPECT_THAT(message("curves.csv --indenter sphere:10 --law linear", 2), HasSubstr("stiffening"));
  EXPECT_THAT(message("curves.csv --indenter sphere:10 --tissue-model layered", 2),
              HasSubstr("--layer-mm is needed"));
  EXPECT_THAT(message("curves.csv --indenter sphere:10 --tissue-model bone", 2),
              HasSubstr("stiffens with energy"));
  EXPECT_THAT(message("curves.csv --indenter plane", 2), HasSubstr("touches without end"));
}

TEST(TissueFileOption, MistakesAreNamedAndTheHandListsWhatItGot) {
  const std::string folder = temporary_folder();
  write_text(folder + "/own.toml", "[palm.half_space]\ng0_kpa = 12.5\n");
  write_text(folder + "/bad.toml", "[palm.half_space]\ng0_kp = 12.5\n");
  const ProgramRun listed = run_palmar("hand tissue template --tissue own.toml", folder);
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out, HasSubstr("G0 12.5 kPa (12.5 to 12.5)"));
  const ProgramRun bad = run_palmar("hand tissue template --tissue bad.toml", folder);
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, HasSubstr("bad.toml:2: [palm.half_space]: key \"g0_kp\" is not known; did "
                                 "you mean g0_kpa?"));
  const ProgramRun missing =
      run_palmar("contact press --indenter sphere:5 --depth-mm 1 --tissue nowhere.toml", folder);
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.toml"));
}

}  // namespace
}  // namespace palmar::testing
