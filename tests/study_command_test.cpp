// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// `palmar study` as a whole: what is killed, separated or run on other threads ends with the same
// bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "run_program.h"

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kStudy = R"(
[study]
name = "small"
seed = 3
[[population]]
preset = "ansur2_women"
hands = 4
[[product]]
name = "cylinder"
kind = "cylinder"
diameter_mm = 35
length_mm = 120
[[product]]
name = "handle"
file = "handle.stl"
unit = "mm"
[settings]
indices = false
)";

/// A folder with a study file, its product, and the store of an uninterrupted run.
class StudyCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = temporary_folder();
    write_text(folder_ + "/study.toml", kStudy);
    ASSERT_EQ(run("product make prism --width-mm 32 --depth-mm 32 --length-mm 120 --fillet-mm 6 "
                  "--out handle.stl")
                  .exit_code,
              0);
    const ProgramRun whole = run("study run study.toml --threads 2 --out whole.palmar --quiet");
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    ASSERT_THAT(whole.out, HasSubstr("4 hands x 2 products = 8 grasps"));
  }
  static ProgramRun run(const std::string& arguments) { return run_palmar(arguments, folder_); }
  static std::string bytes(const std::string& name) { return read_text(folder_ + "/" + name); }
  /// Runs palmar and kills it by `signal` after a time.
  static int run_killed(const std::string& arguments, const std::string& signal, double seconds) {
    const std::string command = "cd " + folder_ + " && timeout -s " + signal + " " +
                                std::to_string(seconds) + " " + PALMAR_EXECUTABLE + " " +
                                arguments + " >killed.out 2>killed.err";
    return std::system(command.c_str());
  }
  static std::string folder_;
};
std::string StudyCommand::folder_;

TEST_F(StudyCommand, ThoroughThreadsDontMatter) {
  for (const char* threads : {"1", "4"}) {
    const std::string name = std::string("threads") + threads + ".palmar";
    ASSERT_EQ(
        run(std::string("study run study.toml --quiet --threads ") + threads + " --out " + name)
            .exit_code,
        0);
    EXPECT_EQ(bytes(name), bytes("whole.palmar")) << threads;
  }
}

TEST_F(StudyCommand, ThoroughFoldersDontMatter) {
  const std::string parent = fs::path(folder_).parent_path().string();
  const std::string name = fs::path(folder_).filename().string();
  ASSERT_EQ(run_palmar("study run " + name + "/study.toml --quiet --out " + name + "/above.palmar",
                       parent)
                .exit_code,
            0);
  EXPECT_EQ(bytes("above.palmar"), bytes("whole.palmar"));
  fs::create_directory(folder_ + "/copy");
  for (const char* file : {"/study.toml", "/handle.stl"}) {
    fs::copy_file(folder_ + file, folder_ + "/copy" + file);
  }
  ASSERT_EQ(run("study run copy/study.toml --quiet --out new/shards/copied.palmar").exit_code, 0);
  EXPECT_EQ(bytes("new/shards/copied.palmar"), bytes("whole.palmar"));
  // The same study once it is there, from the other folder.
  EXPECT_EQ(run("study run " + folder_ + "/copy/study.toml --quiet --out whole.palmar").exit_code,
            0);
}

TEST_F(StudyCommand, ThoroughPathsAsTypedDontMatter) {
  const std::string rest =
      " --unit mm --population ansur2_men --hands 2 --grip medium_wrap --quiet --json ";
  fs::create_directory(folder_ + "/typed");
  fs::copy_file(folder_ + "/handle.stl", folder_ + "/typed/handle.stl");
  const auto digest = [](const ProgramRun& done) {
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(done.out)["results_sha256"].get<std::string>();
  };
  const std::string plain =
      digest(run("study run --product handle.stl" + rest + "--out typed1.palmar"));
  EXPECT_EQ(digest(run("study run --product typed/handle.stl" + rest + "--out typed2.palmar")),
            plain);
  EXPECT_EQ(
      digest(run("study run --product " + folder_ + "/handle.stl" + rest + "--out typed1.palmar")),
      plain);
  ASSERT_EQ(run("study run --product ./handle.stl --shard 1/2" + rest + "--out a.palmar").exit_code,
            0);
  ASSERT_EQ(
      run("study run --product typed/handle.stl --shard 2/2" + rest + "--out b.palmar").exit_code,
      0);
  EXPECT_EQ(digest(run("study merge b.palmar a.palmar --out ab.palmar --json")), plain);
}

TEST_F(StudyCommand, ThoroughKilledAgainAndAgainEndsWithTheSameBytes) {
  double seconds = 0.3;
  std::size_t last = 0;
  int kills = 0;
  for (;; ++kills) {
    ASSERT_LT(kills, 60);
    run_killed("study run study.toml --quiet --out killed.palmar", "KILL", seconds);
    if (!fs::exists(folder_ + "/killed.palmar")) {
      seconds *= 1.3;
      continue;
    }
    const ProgramRun status = run("study status killed.palmar --json");
    ASSERT_EQ(status.exit_code, 0) << status.err;
    const json store = json::parse(status.out)["stores"][0];
    if (store["state"] == "finished") break;
    EXPECT_EQ(store["state"], "stopped");
    EXPECT_GE(store["done"].get<std::size_t>(), last) << "a finished grasp was lost";
    // Longer only where nothing was gained, so that it is killed as often as may be.
    if (store["done"].get<std::size_t>() == last) seconds *= 1.3;
    last = store["done"].get<std::size_t>();
  }
  EXPECT_GE(kills, 3) << "killed too late to say anything";
  EXPECT_EQ(bytes("killed.palmar"), bytes("whole.palmar"));
}

TEST_F(StudyCommand, CtrlCKeepsWhatIsFinished) {
  // Before the first grasp begins there is nothing to keep, and no store.
  std::string said;
  const auto has = [&](const char* words) { return said.find(words) != said.npos; };
  for (double seconds = 0.5; !has("grasps are kept") && !has("grasps in"); seconds *= 1.5) {
    ASSERT_LT(seconds, 60.0);
    run_killed("study run study.toml --threads 1 --out stopped.palmar", "INT", seconds);
    said = bytes("killed.err");
  }
  if (has("cancelled")) {
    EXPECT_THAT(said,
                HasSubstr("of 8 grasps are kept; `palmar study resume stopped.palmar` continues"));
  }
  EXPECT_FALSE(fs::exists(folder_ + "/stopped.palmar-progress"));
  const ProgramRun resumed = run("study resume stopped.palmar --json");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(json::parse(resumed.out)["outcomes"]["held"], 8);
  EXPECT_EQ(bytes("stopped.palmar"), bytes("whole.palmar"));
}

TEST_F(StudyCommand, ShardsMergeToTheSameBytes) {
  for (const char* shard : {"1", "2", "3"}) {
    const ProgramRun one = run(std::string("study run study.toml --quiet --shard ") + shard +
                               "/3 --out part" + shard + ".palmar");
    ASSERT_EQ(one.exit_code, 0) << one.err;
  }
  const ProgramRun missing = run("study merge part1.palmar part3.palmar --out no.palmar");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("missing 2/3 of the study \"small\""));
  EXPECT_THAT(run("study status part1.palmar part3.palmar").out,
              HasSubstr("shard 2/3     has no store yet"));
  ASSERT_EQ(run("study merge part3.palmar part1.palmar part2.palmar --out merged.palmar").exit_code,
            0);
  EXPECT_EQ(bytes("merged.palmar"), bytes("whole.palmar"));
  EXPECT_EQ(run("study run study.toml --shard 1/5 --out no.palmar").exit_code, 2);
  EXPECT_THAT(run("study run study.toml --shard 4/3").err,
              HasSubstr("--shard is \"4/3\"; k/n with 1 <= k <= n is required"));
  EXPECT_THAT(run("study run study.toml --shard 2/3 --out part1.palmar").err,
              HasSubstr("part1.palmar: holds shard 1/3, not 2/3"));
}

TEST_F(StudyCommand, TwoProcessesOnOneFileAreRefused) {
  const std::string command =
      "cd " + folder_ + " && (" + PALMAR_EXECUTABLE +
      " study run study.toml --threads 1 --out busy.palmar >busy.out 2>&1 & "
      "echo $! >busy.pid)";
  ASSERT_EQ(std::system(command.c_str()), 0);
  bool was_refused = false;
  for (int i = 0; i < 400 && bytes("busy.out").find("results") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (!fs::exists(folder_ + "/busy.palmar-progress")) continue;
    const ProgramRun second = run("study resume busy.palmar");
    if (second.exit_code == 0) break;
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_THAT(second.err, HasSubstr("busy.palmar: in use by another process"));
    const ProgramRun status = run("study status busy.palmar --json");
    if (json::parse(status.out)["stores"][0]["state"] == "running") was_refused = true;
    if (was_refused) break;
  }
  EXPECT_TRUE(was_refused) << bytes("busy.out");
  for (int i = 0; i < 1200 && bytes("busy.out").find("results") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_EQ(bytes("busy.palmar"), bytes("whole.palmar")) << "the first one went on undisturbed";
}

TEST_F(StudyCommand, ThoroughChangedInputsAreNamed) {
  run_killed("study run study.toml --quiet --out changed.palmar", "KILL", 0.3);
  for (double seconds = 0.5; !fs::exists(folder_ + "/changed.palmar"); seconds *= 1.5) {
    ASSERT_LT(seconds, 60.0);
    run_killed("study run study.toml --quiet --out changed.palmar", "KILL", seconds);
  }
  write_text(folder_ + "/other.toml", std::string(kStudy) + "friction = 0.3\n");
  const ProgramRun plan = run("study run other.toml --out changed.palmar");
  EXPECT_EQ(plan.exit_code, 2);
  EXPECT_THAT(plan.err, HasSubstr("setting \"default\": friction was 0.5, now 0.3"));
  fs::rename(folder_ + "/handle.stl", folder_ + "/kept.stl");
  ASSERT_EQ(run("product make prism --width-mm 33 --depth-mm 32 --length-mm 120 --fillet-mm 6 "
                "--out handle.stl")
                .exit_code,
            0);
  EXPECT_THAT(run("study run study.toml --out changed.palmar").err,
              HasSubstr("product \"handle\": its shape has changed (handle.stl)"));
  EXPECT_THAT(run("study resume changed.palmar").err,
              HasSubstr("handle.stl has changed since the study began"));
  // Without the file the study goes on with what it has kept of it.
  fs::remove(folder_ + "/handle.stl");
  EXPECT_EQ(run("study resume changed.palmar --quiet").exit_code, 0);
  fs::rename(folder_ + "/kept.stl", folder_ + "/handle.stl");
  EXPECT_EQ(bytes("changed.palmar"), bytes("whole.palmar"));
}

TEST_F(StudyCommand, RefusesWhatEveryGraspWouldFailFor) {
  const std::string thing = "[[product]]\nkind = \"cylinder\"\ndiameter_mm = 35\n";
  const std::string share = "[[setting]]\nname = \"firm\"\nstrength_share = 0.5\n";
  write_text(folder_ + "/share.toml",
             "[[population]]\npreset = \"xie2014\"\nhands = 2\n" + thing + share);
  write_text(folder_ + "/ageless.csv",
             "label,sex,hand_length_mm\nfirst,female,175\nsecond,male,190\n");
  write_text(folder_ + "/ageless.toml",
             "[[population]]\ntable = \"ageless.csv\"\n" + thing + share);
  write_text(folder_ + "/giant.csv",
             "label,hand_length_mm,palm_length_mm\nfirst,125,124\nsecond,126,125\n");
  write_text(folder_ + "/giant.toml", "[[population]]\ntable = \"giant.csv\"\n" + thing);
  for (const char* verb : {"study plan ", "study run --out refused.palmar "}) {
    const ProgramRun preset = run(std::string(verb) + "share.toml");
    EXPECT_EQ(preset.exit_code, 3);
    EXPECT_THAT(preset.err,
                HasSubstr("share.toml: setting \"firm\": strength_share is 0.5, but the "
                          "grip strength of 2 of 2 hands of population \"xie2014\""));
    const ProgramRun table = run(std::string(verb) + "ageless.toml");
    EXPECT_EQ(table.exit_code, 3);
    EXPECT_THAT(table.err, HasSubstr("(hand \"first\": the age is missing)"));
    const ProgramRun giant = run(std::string(verb) + "giant.toml");
    EXPECT_EQ(giant.exit_code, 3);
    EXPECT_THAT(giant.err, HasSubstr("population \"giant\": its hands can't be made: "));
  }
  EXPECT_FALSE(fs::exists(folder_ + "/refused.palmar"));
}

TEST_F(StudyCommand, StatusOfADamagedStoreIsAnError) {
  write_text(folder_ + "/broken.palmar", "no study");
  const ProgramRun status = run("study status whole.palmar broken.palmar");
  EXPECT_EQ(status.exit_code, 3);
  EXPECT_THAT(status.out, HasSubstr("broken.palmar (broken.palmar: is no study of Palmar)"));
  EXPECT_EQ(run("study status whole.palmar").exit_code, 0);
}

TEST_F(StudyCommand, NeedsNoFile) {
  const ProgramRun done =
      run("study run --product handle.stl --unit mm --population ansur2_men "
          "--hands 2 --grip medium_wrap --out men.palmar --json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(json::parse(done.out)["grasps"], 2);
  EXPECT_EQ(run("study run").exit_code, 2);
  EXPECT_THAT(run("study run").err, HasSubstr("FILE.toml or --product is required"));
}

/// Cells of a line of CSV, quotes taken off.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

// In gloves a product is thicker and its other side may do as well: it is held as without.
TEST_F(StudyCommand, AllProfilesHoldAProductInTheSameWay) {
  ASSERT_EQ(run("study run --product handle.stl --unit mm --hands 2 --profile none --profile "
                "thick_gloves --out gloves.palmar --quiet")
                .exit_code,
            0);
  ASSERT_EQ(run("study export gloves.palmar --out gloves").exit_code, 0);
  std::istringstream table(read_text(folder_ + "/gloves/grasps.csv"));
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> header = cells_of(line);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  std::set<std::string> profiles, ways;
  while (std::getline(table, line)) {
    const std::vector<std::string> cells = cells_of(line);
    ASSERT_EQ(cells.size(), header.size());
    profiles.insert(cells[column("profile")]);
    ways.insert(cells[column("part")] + " " + cells[column("grip")] + " " + cells[column("along")] +
                " " + cells[column("toward")] + " " + cells[column("turn_deg")]);
  }
  EXPECT_EQ(profiles.size(), 2U);
  EXPECT_EQ(ways.size(), 1U) << ::testing::PrintToString(ways);
}

// No hand closes round a large box: where the first hold doesn't come to rest in the mean hand, all
// hands take the one that does. A hold that is asked for stays.
TEST_F(StudyCommand, AllHandsTakeTheHoldThatComesToRestInTheMeanHand) {
  ASSERT_EQ(run("product make prism --width-mm 160 --depth-mm 60 --length-mm 210 --fillet-mm 2 "
                "--out box.stl")
                .exit_code,
            0);
  const auto grasps = [](const std::string& asked, const std::string& name) {
    const std::string ran = "study run --product box.stl --unit mm --mass-kg 0.4 --hands 2 " +
                            asked + " --out " + name + ".palmar --quiet";
    EXPECT_EQ(run(ran).exit_code, 0);
    EXPECT_EQ(run("study export " + name + ".palmar --out " + name).exit_code, 0);
    std::istringstream table(read_text(folder_ + "/" + name + "/grasps.csv"));
    std::string line;
    std::getline(table, line);
    const std::vector<std::string> header = cells_of(line);
    const auto column = [&](const std::string& wanted) {
      return static_cast<std::size_t>(std::find(header.begin(), header.end(), wanted) -
                                      header.begin());
    };
    std::multiset<std::string> list;
    while (std::getline(table, line)) {
      const std::vector<std::string> cells = cells_of(line);
      list.insert(cells[column("outcome")] + " " + cells[column("grip")]);
    }
    return list;
  };
  const std::multiset<std::string> open = grasps("", "open");
  ASSERT_EQ(open.size(), 2U);
  EXPECT_EQ(*open.begin(), *open.rbegin());
  EXPECT_THAT(*open.begin(), ::testing::AnyOf("held tripod", "held prismatic",
                                              "held precision_sphere", "held palmar_pinch"));
  const std::multiset<std::string> asked = grasps("--hold 1", "asked");
  ASSERT_EQ(asked.size(), 2U);
  EXPECT_THAT(*asked.begin(), ::testing::Not(HasSubstr("held")));
}

TEST_F(StudyCommand, SaysWhatWouldRunAndHowLong) {
  const ProgramRun plan = run("study plan study.toml");
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("small: 4 hands x 2 products = 8 grasps"));
  EXPECT_THAT(plan.out, HasSubstr("(measured on 2 grasps"));
  const json full = json::parse(run("study plan study.toml --json --no-sample").out);
  EXPECT_EQ(full["grasps"], 8);
  EXPECT_EQ(full["hands"].size(), 4U);
}

TEST_F(StudyCommand, WritesTheBatchScript) {
  const ProgramRun dry =
      run("study submit study.toml --shards 4 --out 'my shards' --dry-run "
          "--minutes 12.5 --memory-mb 700 --cores 2 --sbatch=--partition=long");
  ASSERT_EQ(dry.exit_code, 0) << dry.err;
  for (const char* line :
       {"#SBATCH --array=1-4\n", "#SBATCH --cpus-per-task=2\n", "#SBATCH --time=00:13:00\n",
        "#SBATCH --mem=700M\n", "#SBATCH --requeue\n", "#SBATCH --partition=long\n",
        "--shard \"$shard/4\"", "/my shards'"}) {
    EXPECT_THAT(dry.out, HasSubstr(line));
  }
  EXPECT_FALSE(fs::exists(folder_ + "/my shards"));
  EXPECT_THAT(run("study submit study.toml --shards 9 --out x --dry-run").err,
              HasSubstr("the study has 4 hands; 9 shards would leave some without one"));
}

TEST_F(StudyCommand, BadStudyFilesAreNamedWithTheirLine) {
  const std::string people = "[[population]]\npreset = \"xie2014\"\nhands = 2\n";
  const std::string thing = "[[product]]\nkind = \"cylinder\"\n";
  const struct {
    std::string text, said;
  } cases[] = {
      {"hands = [\n", "bad.toml:1: no TOML"},
      {"[[populations]]\n",
       "bad.toml:1: the file: key \"populations\" is not known; did you mean "
       "population?"},
      {people, "bad.toml:1: no [[product]]"},
      {thing, "bad.toml:1: no [[population]]"},
      {people + "[[product]]\nname = \"x\"\n", "bad.toml:4: product 1: has neither file nor kind"},
      {people + "[[product]]\nfile = \"none.stl\"\n", "none.stl: no such file"},
      {people + thing + "diametre_mm = 35\n",
       "bad.toml:6: product 1: key \"diametre_mm\" is not known; did you mean diameter_mm?"},
      {people + thing + "diameter_mm = -3\n", "bad.toml:6: product 1 diameter_mm is -3 mm"},
      {people + thing + "diameter_mm = { from = 30, to = 40 }\n", "step"},
      {people + "[[product]]\nkind = \"cylindre\"\n", "did you mean cylinder?"},
      {people + thing + "axis = [0, 0, 0]\n",
       "bad.toml:6: product 1 axis is 0, 0, 0; a direction is required"},
      {people + thing + "name = \"x\"\nposture_of = \"x\"\n",
       "bad.toml:4: product \"x\": keeps the posture of itself"},
      {people + thing + thing, "bad.toml:6: two products are called \"cylinder\""},
      {people + thing + "sizes = [1, 1]\n", "bad.toml:6: product 1 sizes has a size twice"},
      {people + thing + "posture_of = \"other\"\n", "\"other\", which is no product of the study"},
      {people + thing + "at_mm = [1, 2]\n", "bad.toml:6: product 1 at_mm has 2 numbers; three"},
      {"[[population]]\npreset = \"ansur_women\"\n" + thing, "ansur2_women"},
      {"[[population]]\npreset = \"xie2014\"\nfile = \"a.toml\"\n" + thing,
       "bad.toml:1: population 1: preset, file and table exclude each other"},
      {"[[population]]\npreset = \"xie2014\"\nhands = 0\n" + thing,
       "bad.toml:3: population 1 hands is 0; 1 to 1000000 is allowed"},
      {"[[population]]\npreset = \"xie2014\"\ndesign = \"latin\"\n" + thing,
       "bad.toml:3: population 1 design is \"latin\"; latin_hypercube, random"},
      {"[study]\ngrips = [\"tripot\"]\n" + people + thing,
       "grip \"tripot\" is not known; did you mean tripod?"},
      {people + thing + "[settings]\nfriction = \"high\"\n",
       "bad.toml:7: settings friction is no "
       "number; 0 to 3 is allowed"},
      {people + thing + "[settings]\ngrip_force_n = 20\nstrength_share = 0.5\n",
       "strength_share and grip_force_n exclude each other"},
      {people + thing + "[settings]\nlimit_depths = true\ngrip_force_n = 20\n",
       "limit_depths and grip_force_n exclude each other"},
      {people + thing + "[settings]\nstrength_n = 300\n", "strength_n needs strength_share"},
      {people + thing + "[settings]\ntask = \"strike\"\n",
       "bad.toml:7: settings task is \"strike\"; usual or squeeze or hold or carry or turn"},
      {people + thing + "[settings]\ntask = \"turn\"\n", "turn_n_m, a torque, is required with it"},
      {people + thing + "[settings]\nturn_n_m = 2\n", "turn_n_m needs task = \"turn\""},
      {people + thing + "[settings]\ntask = \"turn\"\nturn_n_m = 60\n", "-50 to 50"},
      {people + thing + "[settings]\ntask = \"hold\"\ngrip_force_n = 20\n",
       "grip_force_n doesn't go with task = \"hold\""},
      {people + thing + "[settings]\nplace = \"own\"\n", "shared or per_hand is allowed"},
      {people + thing + "[[limit]]\nquantity = \"peak_pressure_cell_mpa\"\nhighest = 1\n",
       "did you mean peak_pressure_cells_mpa?"},
      {people + thing + "[[limit]]\nquantity = \"force_n\"\n", "neither lowest nor highest"},
      {people + thing + "[[profile]]\nname = \"thin_glove\"\n", "thin_gloves"},
      {people + thing + "[[profile]]\nname = \"own\"\nrange_share = 1.5\n",
       "bad.toml:8: profile 1 range_share is 1.5; 0.01 to 1 is allowed"},
  };
  for (const auto& one : cases) {
    write_text(folder_ + "/bad.toml", one.text);
    const ProgramRun bad = run("study plan bad.toml --no-sample");
    EXPECT_EQ(bad.exit_code, 3) << one.text << bad.err;
    EXPECT_THAT(bad.err, HasSubstr(one.said)) << one.text;
  }
}

TEST_F(StudyCommand, VerbsRefuseWhatIsNoStore) {
  for (const char* verb : {"study resume study.toml", "study export study.toml --out x",
                           "study merge study.toml --out x.palmar"}) {
    const ProgramRun bad = run(verb);
    EXPECT_EQ(bad.exit_code, 3) << verb;
    EXPECT_THAT(bad.err, HasSubstr("study.toml: is no study of Palmar")) << verb;
  }
  const ProgramRun tables = run("study export whole.palmar --out tables");
  EXPECT_EQ(tables.exit_code, 0) << tables.err;
  EXPECT_THAT(bytes("tables/grasps.csv"), HasSubstr("peak_pressure_cells_mpa"));
}

}  // namespace
}  // namespace palmar::testing
