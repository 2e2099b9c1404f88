// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "run_program.h"

// The commands beside assess, run as a user runs them.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST(HandCommand, InfoReportsASizeThatPeopleHave) {
  const ProgramRun run = run_palmar("hand info template --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json info = Json::parse(run.out);
  EXPECT_EQ(info.at("degree_of_freedom_count"), 23);
  // Adults, P1 women to P99 men (ANSUR II): hand length 165-215 mm, circumference 165-235 mm.
  EXPECT_GT(info.at("hand_length_mm").get<double>(), 165);
  EXPECT_LT(info.at("hand_length_mm").get<double>(), 215);
  EXPECT_GT(info.at("hand_circumference_mm").get<double>(), 165);
  EXPECT_LT(info.at("hand_circumference_mm").get<double>(), 235);
  EXPECT_EQ(info.at("segments").size(), 15U);
  EXPECT_GT(info.at("vertices").get<int>(), 8000);
  EXPECT_LT(info.at("vertices").get<int>(), 12000);
}

TEST(HandCommand, PoseSaysWhichAngleItClamped) {
  const std::string folder = temporary_folder();
  const ProgramRun run =
      run_palmar("hand pose --set index_pip_flexion=170 --out posed.ply", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("index_pip_flexion"));
  EXPECT_THAT(run.err, HasSubstr("170"));
  EXPECT_EQ(read_text(folder + "/posed.ply").substr(0, 3), "ply");
}

TEST(HandCommand, PoseRefusesUnknownNames) {
  const ProgramRun posture = run_palmar("hand pose --posture fits --out x.ply");
  EXPECT_EQ(posture.exit_code, 2);
  EXPECT_THAT(posture.err, HasSubstr("fist"));
  const ProgramRun dof = run_palmar("hand pose --set index_pip_flexon=20 --out x.ply");
  EXPECT_EQ(dof.exit_code, 2);
  EXPECT_THAT(dof.err, HasSubstr("index_pip_flexion"));
}

TEST(HandCommand, MirrorOfTheMirrorIsTheHand) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("hand mirror template --out left.hand.glb", folder).exit_code, 0);
  ASSERT_EQ(run_palmar("hand mirror left.hand.glb --out right.hand.glb", folder).exit_code, 0);
  const Json left = Json::parse(run_palmar("hand info left.hand.glb --json", folder).out);
  Json right = Json::parse(run_palmar("hand info right.hand.glb --json", folder).out);
  Json original = Json::parse(run_palmar("hand info template --json", folder).out);
  EXPECT_EQ(left.at("side"), "left");
  EXPECT_EQ(right.at("side"), "right");
  for (const char* key : {"hand_length_mm", "hand_circumference_mm", "joints"}) {
    EXPECT_EQ(right.at(key), original.at(key)) << key;
  }
}

TEST(CommandsOfOtherPrograms, AreListedWithTheWordsThatTheyUseThemselves) {
  std::vector<std::string> commands = {"redesign", "validate", "serve"};
  if (has_program("palmar-hands")) {
    commands.insert(commands.end(), {"mri", "phantom", "photos", "hand from-mri",
                                     "hand from-photos", "hand from-scan", "hand quick"});
  }
  for (const std::string& command : commands) {
    const std::size_t blank = command.find(' ');
    const std::string list =
        run_palmar((blank == std::string::npos ? "" : command.substr(0, blank) + " ") + "--help")
            .out;
    const ProgramRun own = run_palmar(command + " --help");
    ASSERT_EQ(own.exit_code, 0) << own.err;
    EXPECT_THAT(own.out, HasSubstr("palmar " + command));
    EXPECT_THAT(list, HasSubstr("  " + own.out.substr(0, own.out.find('\n')) + "\n")) << command;
  }
}

TEST(CommandsOfOtherPrograms, KeepExitCodesAndMessages) {
  const ProgramRun unknown = run_palmar("redesign pres");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean press?"));
  EXPECT_EQ(run_palmar("--json redesign fillet nothing.step --edges long --radius-mm 1:15 --out x")
                .exit_code,
            3);
}

TEST(CommandsOfOtherPrograms, SayHowToGetTheirProgram) {
  // palmar alone, as ./demo builds it: a link in a folder without the others.
  const std::string folder = temporary_folder();
  std::filesystem::copy_file(PALMAR_EXECUTABLE, folder + "/palmar");
  for (const std::string command :
       {"redesign", "redesign --help", "hand quick --help", "phantom --help", "serve --help"}) {
    const int status = std::system(
        ("cd '" + folder + "' && ./palmar " + command + " > out.txt 2> err.txt").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 6) << command;
    std::ifstream file(folder + "/err.txt");
    const std::string said((std::istreambuf_iterator<char>(file)), {});
    EXPECT_THAT(said, HasSubstr("`./demo --also ")) << command;
  }
}

TEST(ProductCommand, MakesWhatItsNameSays) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make cylinder --diameter-mm 48 --length-mm 100 --out c.stl", folder)
                .exit_code,
            0);
  const ProgramRun run = run_palmar("product info c.stl --unit mm --json", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // pi r^2 l = 180 956 mm3, less what the chords cut off.
  EXPECT_NEAR(Json::parse(run.out).at("volume_mm3").get<double>(), 180956, 181);
}

TEST(ProductCommand, CheckEndsWithFiveForAMeshWithAHole) {
  const std::string folder = temporary_folder();
  write_text(folder + "/open.obj",
             "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const ProgramRun run = run_palmar("product check open.obj --unit mm", folder);
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_THAT(run.out + run.err, HasSubstr("1 hole with 3 edges"));
}

TEST(ContactCommand, PressOfASphereIsHertz) {
  // VALIDATION.md G1: R = 20 mm, G = 50 kPa: F = 16/3 G sqrt(R) d^1.5; peak 40.26 kPa at 2 mm.
  const ProgramRun run = run_palmar(
      "contact press --specimen plane --indenter sphere:20 --depth-mm 0.5,1,2 --spacing-mm 0.8 "
      "--shear-modulus-kpa 50 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json steps = Json::parse(run.out).at("steps");
  ASSERT_EQ(steps.size(), 3U);
  const double force[] = {0.4216, 1.1926, 3.3731};  // N
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(steps[i].at("force_n").get<double>(), force[i], 0.02 * force[i]);
  }
  EXPECT_NEAR(steps[2].at("peak_pressure_mpa").get<double>(), 0.04026, 0.05 * 0.04026);
}

TEST(ContactCommand, PunchOnSkinPressesHarderTheDeeperItGoes) {
  for (const std::string region : {"thenar", "middle_distal", "central_palm"}) {
    const ProgramRun run = run_palmar("contact press --specimen template:" + region +
                                      " --indenter punch:4 --depth-mm 0.5,1,2,3,4 --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    double before = 0.0;
    for (const Json& step : Json::parse(run.out).at("steps")) {
      const double force = step.at("force_n");
      EXPECT_GT(force, before) << region << " at " << step.at("depth_mm") << " mm";
      EXPECT_NEAR(
          force,
          step.at("mean_pressure_mpa").get<double>() * step.at("contact_area_mm2").get<double>(),
          1e-9 + 1e-6 * force);
      before = force;
    }
  }
}

TEST(ContactCommand, MeanPressureNeverExceedsThePeak) {
  // Patches of one or two vertices are the hard case.
  for (const std::string indenter : {"sphere:7", "plane", "cylinder:10"}) {
    const ProgramRun run = run_palmar("contact press --specimen template:central_palm --indenter " +
                                      indenter + " --depth-mm 0.05,0.1,0.2,0.5,1,2 --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    for (const Json& step : Json::parse(run.out).at("steps")) {
      EXPECT_LE(step.at("mean_pressure_mpa").get<double>(),
                step.at("peak_pressure_mpa").get<double>() * (1 + 1e-9))
          << indenter << " at " << step.at("depth_mm") << " mm";
    }
  }
}

TEST(ContactCommand, PressRefusesWhatItDoesNotKnow) {
  EXPECT_EQ(run_palmar("contact press --indenter cone:3 --depth-mm 1").exit_code, 2);
  EXPECT_EQ(run_palmar("contact press --indenter sphere:-3 --depth-mm 1").exit_code, 2);
  EXPECT_EQ(run_palmar("contact press --indenter sphere:20").exit_code, 2);
  EXPECT_EQ(run_palmar("contact press --indenter sphere:20 --depth-mm one").exit_code, 2);
}

TEST(VersionOption, NamesTheCommitAndTheLibraries) {
  const ProgramRun run = run_palmar("--version");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, ::testing::StartsWith("palmar "));
  EXPECT_THAT(run.out, HasSubstr("Eigen 3."));
  if (!fs::exists(PALMAR_SOURCE_DIR "/.git")) GTEST_SKIP() << "not a clone: there is no commit";
  EXPECT_THAT(run.out, ::testing::ContainsRegex("\ncommit [0-9a-f]{10}"));
}

TEST(DoctorCommand, FindsNothingMissingInTheBuild) {
  const ProgramRun run = run_palmar("doctor");
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
}

TEST(DoctorCommand, NamesAMissingTemplate) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar("--version > /dev/null; PALMAR_SHARE='" + folder +
                                    "' '" PALMAR_EXECUTABLE "' doctor");
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_THAT(run.out + run.err, HasSubstr("template.hand.glb"));
}

TEST(DoctorCommand, NamesACutComplianceOfTheTemplate) {
  const fs::path share = fs::path(PALMAR_EXECUTABLE).parent_path() / "../share/palmar";
  const fs::path folder = temporary_folder();
  for (const char* file : {"template.hand.glb", "generic-hand-right.glb", "template.compliance"}) {
    fs::copy_file(share / file, folder / file);
  }
  const fs::path cut = folder / "template.compliance";
  fs::resize_file(cut, fs::file_size(cut) / 2);
  const ProgramRun run = run_palmar("--version > /dev/null; PALMAR_SHARE='" + folder.string() +
                                    "' '" PALMAR_EXECUTABLE "' doctor");
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_THAT(run.out, HasSubstr("MISSING  template on bone"));
  EXPECT_THAT(run.out, HasSubstr(cut.string() + " is missing, cut"));
  EXPECT_THAT(run.out, HasSubstr("palmar hand template --out"));
}

TEST(Help, EveryVerbShowsAWorkedExample) {
  for (const std::string verb :
       {"assess", "hand template", "hand info", "hand measure", "hand mirror", "hand pose",
        "hand export", "product info", "product check", "product make", "product convert",
        "grasp close", "contact press", "doctor"}) {
    const ProgramRun run = run_palmar(verb + " --help");
    EXPECT_EQ(run.exit_code, 0) << verb;
    EXPECT_THAT(run.out, HasSubstr("Example: palmar ")) << verb;
    EXPECT_THAT(run.out, HasSubstr(" palmar " + verb)) << verb;
  }
}

TEST(Help, PutsWhatMattersMostFirst) {
  const std::string help = run_palmar("assess --help").out;
  const std::size_t start = help.find("Start here:"), more = help.find("Skin and contact:");
  ASSERT_NE(start, help.npos);
  ASSERT_NE(more, help.npos);
  for (const char* const option : {"--unit", "--out", "--person", "--grip", "--hold",
                                   "--grip-force-n", "--mass-kg", "--population"}) {
    const std::size_t at = help.find("\n  " + std::string(option) + " ");
    EXPECT_GT(at, start) << option;
    EXPECT_LT(at, more) << option;
  }
  EXPECT_GT(help.find("\n  --kernel "), more);
}

TEST(Help, GroupsOfCommandsHaveAnExampleOfTheirOwn) {
  std::vector<std::string> nouns = {"hand",   "product",    "grasp",    "contact",
                                    "effort", "population", "redesign", "study"};
  if (has_program("palmar-hands")) nouns.insert(nouns.end(), {"mri", "phantom", "photos"});
  for (const std::string& noun : nouns) {
    EXPECT_THAT(run_palmar(noun + " --help").out, HasSubstr(" palmar " + noun + " ")) << noun;
  }
}

TEST(OptionNames, OldOnesAreAcceptedWithANote) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make cylinder --diameter-mm 35 --out bar.stl", folder).exit_code,
            0);
  const std::string close = "grasp close bar.stl --unit mm --json ";
  const ProgramRun old = run_palmar(close + "--region -30,-30,0,30,30,60", folder);
  const ProgramRun present = run_palmar(close + "--box -30,-30,0,30,30,60", folder);
  EXPECT_EQ(old.exit_code, 0) << old.err;
  EXPECT_EQ(old.out, present.out);
  EXPECT_THAT(old.err, HasSubstr("--region is now called --box"));
  EXPECT_EQ(present.err.find("now called"), present.err.npos);
}

// The page for people says what the program does: the new name is in the help, the old one isn't.
TEST(OptionNames, TheTableOfOldAndNewNamesIsTrue) {
  std::istringstream page(read_text(PALMAR_SOURCE_DIR "/docs/using/options.md"));
  const std::map<std::string, std::string> verb_of = {
      {"`assess`, `grasp`, `effort`", "assess"},
      {"`redesign press`", "redesign press"},
      {"`photos mesh`, `hand from-photos`", "photos mesh"},
      {"`assess`, `effort`", "effort grasp"},
      {"`redesign region`", "redesign region"},
      {"`redesign`", "redesign press"},
      {"`phantom`", "phantom scan"},
      {"`redesign fillet`, `features`", "redesign fillet"},
      {"`population correlate`, `regress`", "population correlate"},
      {"`hand from-...`, `mri`, `phantom`", "hand from-scan"},
      {"`contact press`", "contact press"}};
  bool is_table = false;
  int rows = 0;
  for (std::string line; std::getline(page, line);) {
    if (line == "| old | new | where |") is_table = true;
    if (!is_table || !line.starts_with("| `--")) continue;
    std::vector<std::string> cells;
    for (std::size_t from = 2, end = 0; (end = line.find(" |", from)) != line.npos;
         from = end + 3) {
      cells.push_back(line.substr(from, end - from));
    }
    ASSERT_EQ(cells.size(), 3U) << line;
    const auto verb = verb_of.find(cells[2]);
    ASSERT_NE(verb, verb_of.end()) << cells[2];
    ++rows;
    const bool is_of_hands =
        std::regex_search(verb->second, std::regex("^(hand from|photos|phantom)"));
    if (is_of_hands && !has_program("palmar-hands")) continue;
    const std::string help = run_palmar(verb->second + " --help").out;
    const auto names = [](const std::string& cell) {
      std::vector<std::string> found;
      for (std::size_t at = cell.find("--"); at != cell.npos; at = cell.find("--", at + 2)) {
        found.push_back(cell.substr(at, cell.find_first_of("` ,", at) - at));
      }
      return found;
    };
    for (const std::string& name : names(cells[0])) {
      const bool is_model = name == "--base" && verb->second == "hand from-scan";
      EXPECT_TRUE(is_model || help.find("\n  " + name + " ") == help.npos)
          << name << " in " << line;
    }
    for (const std::string& name : names(cells[1])) {
      EXPECT_NE(help.find("\n  " + name + " "), help.npos) << name << " in " << line;
    }
  }
  EXPECT_EQ(rows, 14);
}

TEST(OptionNames, ANumberGoesWithItsUnit) {
  // 0.05 MPa are 50 kPa; a negative one is refused as it is called now.
  const ProgramRun run = run_palmar("redesign region bar.step --threshold-mpa=-0.05 --out x");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--threshold-kpa"));
  EXPECT_THAT(run.err, HasSubstr("-50"));
}

TEST(OptionNames, AWordThatStillMeansSomethingStays) {
  // A region of the hand is a region.
  const ProgramRun run = run_palmar("hand export template --format inp --region nowhere --out x");
  EXPECT_NE(run.exit_code, 0);
  EXPECT_EQ(run.err.find("now called"), run.err.npos) << run.err;
}

TEST(ProductCommand, RepairClosesASmallHoleAndLeavesTheOriginal) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make sphere --diameter-mm 60 --out ball.obj", folder).exit_code, 0);
  // Without its last triangle.
  std::string text = read_text(folder + "/ball.obj");
  text.resize(text.rfind("\nf ") + 1);
  std::ofstream(fs::path(folder) / "torn.obj", std::ios::binary) << text;
  const ProgramRun check = run_palmar("product check torn.obj --unit mm", folder);
  EXPECT_EQ(check.exit_code, 5);
  EXPECT_THAT(check.out, HasSubstr("fix      holes: `palmar product repair` fills"));
  const ProgramRun run =
      run_palmar("product repair torn.obj --unit mm --out whole.obj --json", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json result = Json::parse(run.out);
  EXPECT_EQ(result.at("done").size(), 1U);
  EXPECT_EQ(result.at("done")[0].at("name"), "holes");
  EXPECT_EQ(result.at("before").at("verdict"), "warning");
  EXPECT_EQ(result.at("after").at("euler_number"), 2);
  EXPECT_EQ(read_text(folder + "/torn.obj"), text);
  EXPECT_EQ(run_palmar("product check whole.obj --unit mm", folder).exit_code, 0);
}

TEST(ProductCommand, ConvertRefusesItsInputAndWhatItCantWriteBeforeReading) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make sphere --out ball.obj", folder).exit_code, 0);
  fs::create_symlink("ball.obj", fs::path(folder) / "link.obj");
  const std::string text = read_text(folder + "/ball.obj");
  const struct {
    std::string out, said;
  } cases[] = {{"./ball.obj", "is the product itself"},
               {"link.obj", "is the product itself"},
               {"ball.iges", "or .step if the product is CAD"},
               {".", "is a folder; a file is required"}};
  for (const auto& one : cases) {
    const ProgramRun run =
        run_palmar("product convert ball.obj --unit mm --out " + one.out, folder);
    EXPECT_EQ(run.exit_code, 2) << one.out;
    EXPECT_THAT(run.err, HasSubstr(one.said)) << one.out;
  }
  EXPECT_EQ(run_palmar("product convert none.obj --out a.iges", folder).exit_code, 2);
  EXPECT_EQ(read_text(folder + "/ball.obj"), text);
}

TEST(ProductCommand, RepairRefusesItsInputAndAbsurdLengths) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make sphere --out ball.obj", folder).exit_code, 0);
  const ProgramRun same = run_palmar("product repair ball.obj --unit mm --out ./ball.obj", folder);
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_THAT(same.err, HasSubstr("is the product itself"));
  const ProgramRun weld =
      run_palmar("product repair ball.obj --unit mm --out b.obj --weld-mm 1e9", folder);
  EXPECT_EQ(weld.exit_code, 2);
  EXPECT_THAT(weld.err, HasSubstr("the weld's tolerance is 1e+09 mm"));
  EXPECT_FALSE(fs::exists(fs::path(folder) / "b.obj"));
}

}  // namespace
}  // namespace palmar::testing
