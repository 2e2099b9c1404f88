// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// CAD files through the child process: limits, hostile files, what the command line says.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <regex>
#include <sstream>
#include <thread>

#include "gmock/gmock.h"
#include "palmar/core/error.h"
#include "palmar/formats/process/child_process.h"
#include "palmar/records/product/cad_file.h"
#include "palmar/records/product/product_file.h"
#include "run_program.h"

namespace palmar::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A ball as one would write it by hand: one face on a sphere, bounded by a point.
std::string ball_step(const std::string& unit, double radius) {
  const std::string r = std::to_string(radius);
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
         "FILE_NAME('ball','2022-11-07T00:00:00',(''),(''),'','','');\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
         "#1=CARTESIAN_POINT('',(0.,0.,0.));\n#2=DIRECTION('',(0.,0.,1.));\n"
         "#3=DIRECTION('',(1.,0.,0.));\n#4=AXIS2_PLACEMENT_3D('',#1,#2,#3);\n"
         "#5=SPHERICAL_SURFACE('',#4," +
         r + ");\n#6=CARTESIAN_POINT('',(0.,0.,-" + r +
         "));\n"
         "#7=VERTEX_POINT('',#6);\n#8=VERTEX_LOOP('',#7);\n#9=FACE_BOUND('',#8,.T.);\n"
         "#10=ADVANCED_FACE('skin',(#9),#5,.T.);\n#11=CLOSED_SHELL('',(#10));\n"
         "#12=MANIFOLD_SOLID_BREP('ball',#11);\n"
         "#13=(" +
         unit +
         ");\n"
         "#14=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n"
         "#15=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());\n"
         "#17=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#13,#14,#15))"
         "REPRESENTATION_CONTEXT('',''));\n"
         "#18=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#4,#12),#17);\n"
         "#19=APPLICATION_CONTEXT('automotive "
         "design');\n#20=PRODUCT_CONTEXT('',#19,'mechanical');\n"
         "#21=PRODUCT('ball','ball','',(#20));\n#22=PRODUCT_DEFINITION_FORMATION('','',#21);\n"
         "#23=PRODUCT_DEFINITION_CONTEXT('part definition',#19,'design');\n"
         "#24=PRODUCT_DEFINITION('design','',#22,#23);\n"
         "#25=PRODUCT_DEFINITION_SHAPE('','',#24);\n"
         "#26=SHAPE_DEFINITION_REPRESENTATION(#25,#18);\n"
         "#27=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
         "#28=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#29);\n"
         "#29=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
         "ENDSEC;\nEND-ISO-10303-21;\n";
}

/// A cylinder of 35 x 130 mm by the child, its folder, and a temporary folder of the test's own in
/// which nothing may be left.
class CadImport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    ::setenv("PALMAR_CAD", PALMAR_CAD_PROGRAM, 1);
    const records::CadFolder folder;
    records::run_cad("make",
                     R"({"kind": "cylinder", "parameters": {"diameter_mm": 35, "length_mm": 130},)"
                     R"( "step": true})",
                     folder, "cylinder");
    step() = text_of(folder.path() / "product.step");
  }
  static std::string& step() {
    static std::string text;
    return text;
  }

  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "palmar-test-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    fs::create_directory(folder_ / "tmp");
    const char* const old = std::getenv("TMPDIR");
    old_temporary_ = old != nullptr ? old : "";
    ::setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
  }
  void TearDown() override {
    for (const fs::directory_entry& left : fs::directory_iterator(folder_ / "tmp")) {
      EXPECT_EQ(left.path().filename().string().find("palmar-cad"), std::string::npos)
          << left.path() << " was left";
    }
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
    if (old_temporary_.empty()) {
      ::unsetenv("TMPDIR");
    } else {
      ::setenv("TMPDIR", old_temporary_.c_str(), 1);
    }
    fs::remove_all(folder_);
  }

  fs::path file(const std::string& name, const std::string& text) const {
    write_text(folder_ / name, text);
    return folder_ / name;
  }
  static std::string message_of(const fs::path& path, const records::CadLimits& limits = {}) {
    try {
      records::import_cad(path, {}, limits);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  }

  fs::path folder_;
  std::string old_temporary_;
};

TEST_F(CadImport, ProductOfAStepKnowsItsFaces) {
  const product::Product product = records::load_product(file("bar.step", step()));
  EXPECT_EQ(product.name, "bar");
  EXPECT_EQ(product.unit, geometry::LengthUnit::kMillimetre);
  EXPECT_EQ(product.unit_source, product::UnitSource::kFile);
  ASSERT_NE(product.faces, nullptr);
  ASSERT_EQ(product.faces->face_of_triangle.size(), product.mesh.triangles.size());
  double side = 0.0;
  for (const product::ProductFace& face : product.faces->face) {
    if (face.kind == product::FaceKind::kCylinder) side += face.area;
  }
  EXPECT_GT(side, 0.9 * std::numbers::pi * 35.0 * 100.0);
  EXPECT_NEAR(product.distance->at(Vec3::Zero()).distance, -17.5, 0.1);
}

TEST_F(CadImport, SuffixDoesNotMatterForWhatAFileIs) {
  EXPECT_NE(records::load_product(file("bar.txt", step())).faces, nullptr);
  EXPECT_THAT(message_of(file("rubbish.stp", std::string("\0\1\2\3\xff", 5))),
              HasSubstr("neither STEP nor IGES"));
}

TEST_F(CadImport, BallInMetresOrInchesIsTheSameBall) {
  const std::string metric = "LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(";
  const std::vector<std::tuple<std::string, double, std::string>> units = {
      {metric + ".MILLI.,.METRE.)", 30.0, "millimetre"},
      {metric + ".CENTI.,.METRE.)", 3.0, "centimetre"},
      {metric + "$,.METRE.)", 0.03, "metre"},
      {"CONVERSION_BASED_UNIT('INCH',#28)LENGTH_UNIT()NAMED_UNIT(#27)", 30.0 / 25.4, "inch"}};
  const double exact = 4.0 / 3.0 * std::numbers::pi * 27'000.0;
  for (const auto& [unit, radius, name] : units) {
    const records::ImportedCad cad =
        records::import_cad(file("ball.step", ball_step(unit, radius)));
    EXPECT_EQ(cad.unit, name);
    EXPECT_NEAR(cad.volume, exact, 1e-4 * exact) << name;  // radius in text has 6 decimals
    EXPECT_EQ(cad.bodies, std::vector<std::string>{"ball"});
    ASSERT_EQ(cad.mesh.faces.face.size(), 1U);
    EXPECT_EQ(cad.mesh.faces.face[0].name, "skin");
    EXPECT_NEAR(cad.mesh.faces.face[0].radius, 30.0, 1e-3);
  }
}

/// A torus about z as one face, mm.
std::string torus_step(double ring, double tube) {
  std::string text = ball_step("LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.)", ring + tube);
  const std::string r = std::to_string(ring + tube);
  const auto put = [&](const std::string& old, const std::string& fresh) {
    const std::size_t at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    text.replace(at, old.size(), fresh);
  };
  put("SPHERICAL_SURFACE('',#4," + r + ")",
      "TOROIDAL_SURFACE('',#4," + std::to_string(ring) + "," + std::to_string(tube) + ")");
  put("(0.,0.,-" + r + ")", "(" + r + ",0.,0.)");
  return text;
}

TEST_F(CadImport, ATorusThatCrossesItsAxisIsRefusedWithTheCause) {
  const std::string message = message_of(file("apple.step", torus_step(12.0, 20.0)));
  EXPECT_THAT(message, HasSubstr("apple.step: face 1 passes through itself"));
  EXPECT_THAT(message, HasSubstr("ring of radius 12 mm and a tube of 20 mm"));
  // Pappus: 2 pi R pi r^2.
  const double exact = 2.0 * std::pow(std::numbers::pi, 2) * 20.0 * 144.0;
  const records::ImportedCad ring = records::import_cad(file("ring.step", torus_step(20.0, 12.0)));
  EXPECT_NEAR(ring.volume, exact, 1e-4 * exact);
  const testing::ProgramRun run = testing::run_palmar("product info apple.step", folder_.string());
  EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
  EXPECT_THAT(run.err, HasSubstr("passes through itself"));
}

TEST_F(CadImport, UnitOfTheUserWinsAndTheContradictionIsReported) {
  const product::Product product =
      records::load_product(file("bar.step", step()), {.unit = geometry::LengthUnit::kCentimetre});
  Box3 box;
  for (const Vec3& v : product.mesh.vertices) box.extend(v);
  EXPECT_NEAR(box.sizes().maxCoeff(), 1300.0, 1e-6);
  EXPECT_THAT(product.notes, ::testing::Contains(HasSubstr("though the file says mm")));
}

TEST_F(CadImport, UnitThatGivesAnAbsurdSizeIsRefusedBySize) {
  // The same numbers in kilometres would be 130 km long.
  const std::string text = std::regex_replace(
      step(), std::regex(R"(SI_UNIT\(\.MILLI\.,\.METRE\.\))"), "SI_UNIT(.KILO.,.METRE.)");
  ASSERT_NE(text, step());
  try {
    records::load_product(file("huge.step", text));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("huge.step"));
    EXPECT_THAT(error.what(), HasSubstr("setting \"unit\""));
  }
}

TEST_F(CadImport, TimeLimitHoldsByName) {
  // A program that sleeps stands for a kernel that waits for ever: five times the limit by the
  // clock.
  const fs::path sleeper = file("sleeper.sh", "#!/bin/sh\necho '0.5 sleeping'\nsleep 60\n");
  fs::permissions(sleeper, fs::perms::owner_all);
  ::setenv("PALMAR_CAD", sleeper.c_str(), 1);
  const auto start = Clock::now();
  const std::string message = message_of(file("bar.step", step()), {.seconds = 0.5});
  ::setenv("PALMAR_CAD", PALMAR_CAD_PROGRAM, 1);
  EXPECT_LT(seconds_since(start), 4.0);
  EXPECT_THAT(message, HasSubstr("bar.step"));
  EXPECT_THAT(message, HasSubstr("longer than 0.5 s"));
  EXPECT_THAT(message, HasSubstr("setting \"time limit\""));
}

TEST_F(CadImport, TimeIsThatOfTheProcessor) {
  // One that is busy for ever has its half second and not much more.
  const fs::path busy = file("busy.sh", "#!/bin/sh\nwhile :; do :; done\n");
  fs::permissions(busy, fs::perms::owner_all);
  ::setenv("PALMAR_CAD", busy.c_str(), 1);
  const std::string message = message_of(file("bar.step", step()), {.seconds = 0.5});
  ::setenv("PALMAR_CAD", PALMAR_CAD_PROGRAM, 1);
  EXPECT_THAT(message, HasSubstr("longer than 0.5 s of processor time"));
}

TEST_F(CadImport, CancelEndsTheChildWithinASecond) {
  const fs::path sleeper = file("sleeper.sh", "#!/bin/sh\necho '0.5 sleeping'\nsleep 60\n");
  fs::permissions(sleeper, fs::perms::owner_all);
  ::setenv("PALMAR_CAD", sleeper.c_str(), 1);
  std::atomic<bool> cancel = false;
  Progress progress;
  progress.cancel = &cancel;
  std::string last;
  progress.report = [&](double share, const std::string& activity) {
    EXPECT_EQ(share, 0.5);
    last = activity;
    cancel = true;
  };
  const fs::path bar = file("bar.step", step());
  const auto start = Clock::now();
  EXPECT_THROW(records::import_cad(bar, {}, {}, progress), Cancelled);
  ::setenv("PALMAR_CAD", PALMAR_CAD_PROGRAM, 1);
  EXPECT_LT(seconds_since(start), 1.0);
  EXPECT_EQ(last, "sleeping");
}

TEST_F(CadImport, CrashIsReportedBySignal) {
  const fs::path crasher = file("crasher.sh", "#!/bin/sh\nkill -SEGV $$\n");
  fs::permissions(crasher, fs::perms::owner_all);
  ::setenv("PALMAR_CAD", crasher.c_str(), 1);
  const std::string message = message_of(file("bar.step", step()));
  ::setenv("PALMAR_CAD", PALMAR_CAD_PROGRAM, 1);
  EXPECT_THAT(message, HasSubstr("bar.step: the CAD kernel crashed on it"));
  EXPECT_THAT(message, HasSubstr("segmentation fault (signal 11)"));
}

TEST_F(CadImport, ChildThatLiesIsNotBelieved) {
  const fs::path liar = file("liar.sh",
                             "#!/bin/sh\necho '{\"format\": 7}' > $2/reply.json\n"
                             "echo PalmarFM > $2/mesh.bin\n");
  fs::permissions(liar, fs::perms::owner_all);
  ::setenv("PALMAR_CAD", liar.c_str(), 1);
  const std::string message = message_of(file("bar.step", step()));
  ::setenv("PALMAR_CAD", (folder_ / "none").c_str(), 1);
  EXPECT_THROW(records::import_cad(folder_ / "bar.step"), OutputError);
  ::setenv("PALMAR_CAD", PALMAR_CAD_PROGRAM, 1);
  EXPECT_THAT(message, HasSubstr("the CAD program's answer is damaged"));
}

TEST_F(CadImport, ChildInheritsNoOpenFile) {
  const fs::path lister = file("lister.sh", "#!/bin/sh\nls /proc/self/fd | tr '\\n' ' '\n");
  fs::permissions(lister, fs::perms::owner_all);
  const int leak = ::dup(STDERR_FILENO);
  const int high = ::fcntl(leak, F_DUPFD, 77);
  std::string lines;
  const formats::ChildResult result =
      formats::run_child(lister, {}, folder_ / "log", {.seconds = 5.0},
                         [&](const std::string& line) { lines += line; }, {});
  ::close(leak);
  ::close(high);
  EXPECT_EQ(result.end, formats::ChildResult::End::kExited);
  EXPECT_THAT(lines, ::testing::Not(HasSubstr("77")));
}

TEST_F(CadImport, MemoryLimitHoldsByName) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer reserves more than any limit";
#endif
  const fs::path eater = file("eater.sh", "#!/bin/sh\nexit 71\n");
  fs::permissions(eater, fs::perms::owner_all);
  ::setenv("PALMAR_CAD", eater.c_str(), 1);
  const std::string refused = message_of(file("bar.step", step()));
  ::setenv("PALMAR_CAD", PALMAR_CAD_PROGRAM, 1);
  EXPECT_THAT(refused, HasSubstr("needs more than 4096 MB of memory"));
  // The true program, asked for more than a million triangles.
  const fs::path ball =
      file("ball.step", ball_step("LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.)", 30.0));
  const nlohmann::json request = {
      {"file", ball.string()}, {"chordal_error_mm", 1e-4}, {"max_triangles", 20'000'000}};
  const records::CadFolder folder;
  const auto start = Clock::now();
  try {
    records::run_cad("import", request.dump(), folder, "ball.step",
                     {.seconds = 30.0, .memory_mb = 256.0});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ball.step: needs more than 256 MB of memory"));
    EXPECT_THAT(error.what(), HasSubstr("setting \"memory limit\""));
  }
  EXPECT_LT(seconds_since(start), 20.0);
}

TEST_F(CadImport, MutatedFilesHaveNamedOutcomes) {
  // A thousand by hand: PALMAR_CAD_MUTATIONS=1000.
  const char* const wanted = std::getenv("PALMAR_CAD_MUTATIONS");
  const int count = wanted != nullptr ? std::atoi(wanted) : 40;
  std::mt19937 random(20221107);
  const std::vector<std::string> words = {"1.E308",  "-1.E308", "NAN", "$",  "*", "()",    "#0",
                                          "#999999", "'",       "0.",  "-1", ";", "(((((", "#1"};
  int usable = 0;
  for (int i = 0; i < count; ++i) {
    std::string text = step();
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int c = 0; c < changes; ++c) {
      const std::size_t place = random() % text.size();
      switch (random() % 5) {
        case 0:
          text[place] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(place, 1 + random() % 40);
          break;
        case 2:
          text.insert(place, words[random() % words.size()]);
          break;
        case 3: {  // a reference to another entity
          const std::size_t hash = text.find('#', place);
          if (hash == text.npos) break;
          const std::size_t end = text.find_first_not_of("0123456789", hash + 1);
          text.replace(hash + 1, end - hash - 1, std::to_string(1 + random() % 150));
          break;
        }
        default: {  // another number
          const std::size_t point = text.find('.', place);
          if (point == text.npos || point < 1) break;
          text.replace(point - 1, 2, words[random() % 3]);
          break;
        }
      }
    }
    const fs::path path = file("mutant.step", text);
    const auto start = Clock::now();
    try {
      records::load_product(path, {.limits = {.seconds = 20.0, .memory_mb = 2048.0}});
      ++usable;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("mutant.step")) << i;
    } catch (const NumericalError&) {
      // the kernel gave up and said so
    }
    EXPECT_LT(seconds_since(start), 22.0) << i;
  }
  EXPECT_LT(usable, count);  // some were really broken
}

TEST_F(CadImport, CommandLineListsFacesAndRefusesMeshesAsStep) {
  const fs::path bar = file("bar.step", step());
  const auto info = testing::run_palmar("product info " + bar.string());
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("(cylinder r 17.5)"));
  EXPECT_THAT(info.out, HasSubstr("chordal error"));
  EXPECT_EQ(testing::run_palmar("product check " + bar.string()).exit_code, 0);
  const fs::path mesh = folder_ / "bar.stl", again = folder_ / "again.step";
  EXPECT_EQ(
      testing::run_palmar("product convert " + bar.string() + " --out " + mesh.string()).exit_code,
      0);
  EXPECT_EQ(
      testing::run_palmar("product convert " + bar.string() + " --out " + again.string()).exit_code,
      0);
  const auto json =
      nlohmann::json::parse(testing::run_palmar("product check --json " + again.string()).out);
  EXPECT_TRUE(json.at("cad").at("kernel").at("is_good").get<bool>());
  const auto refused = testing::run_palmar("product convert " + mesh.string() +
                                           " --unit mm --out " + (folder_ / "no.step").string());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("a mesh has no surfaces"));
  const auto limit = testing::run_palmar("product info --time-limit-s 0 " + bar.string());
  EXPECT_EQ(limit.exit_code, 2);
  EXPECT_THAT(limit.err, HasSubstr("0.1 to 86400 s is allowed"));
}

}  // namespace
}  // namespace palmar::tests
