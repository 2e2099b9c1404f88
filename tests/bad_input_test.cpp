// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "run_program.h"

// Every kind of bad input ends with the documented exit code and a message that names the file, the
// place, the value and what is allowed; nothing is left behind.

namespace palmar::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class BadInput : public ::testing::Test {
 protected:
  std::string folder = temporary_folder();

  std::string file(const std::string& name, const std::string& content) {
    return write_text(folder + "/" + name, content);
  }
  ProgramRun assess(const std::string& arguments) {
    return run_palmar("assess --out '" + folder + "/report' " + arguments, folder);
  }
  void expect_input_error(const ProgramRun& run, const std::string& name, const std::string& text) {
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr(name), HasSubstr(text)));
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(folder + "/report"));
  }
  /// A binary STL of one tetrahedron with corner coordinates scaled by `scale`.
  static std::string tetrahedron(float scale) {
    const float p[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    std::string bytes(84, '\0');
    const std::uint32_t count = 4;
    std::memcpy(bytes.data() + 80, &count, 4);
    for (const auto& face : faces) {
      float values[12] = {};
      for (int corner = 0; corner < 3; ++corner) {
        for (int axis = 0; axis < 3; ++axis)
          values[3 + 3 * corner + axis] = scale * p[face[corner]][axis];
      }
      bytes.append(reinterpret_cast<const char*>(values), sizeof values);
      bytes.append(2, '\0');
    }
    return bytes;
  }
};

TEST_F(BadInput, MissingFile) {
  expect_input_error(assess("nowhere.stl"), "nowhere.stl", "o such file");
}

TEST_F(BadInput, Directory) { expect_input_error(assess("."), ".", "directory"); }

TEST_F(BadInput, EmptyFile) {
  file("empty.stl", "");
  expect_input_error(assess("empty.stl"), "empty.stl", "empty");
}

TEST_F(BadInput, TruncatedBinaryStl) {
  file("cut.stl", tetrahedron(60).substr(0, 150));
  expect_input_error(assess("cut.stl"), "cut.stl", "150");
}

TEST_F(BadInput, TextThatIsNoMesh) {
  file("letter.stl", "Dear designer,\nplease find the handle attached.\n");
  expect_input_error(assess("letter.stl"), "letter.stl", "");
  file("letter.obj", "Dear designer,\nplease find the handle attached.\n");
  expect_input_error(assess("letter.obj"), "letter.obj", "");
}

TEST_F(BadInput, NotANumberAndInfinityNameThePlace) {
  file("nan.obj", "v 0 0 0\nv 50 0 0\nv nan 50 0\nf 1 2 3\n");
  expect_input_error(assess("nan.obj"), "nan.obj", "3");
  std::string bytes = tetrahedron(60);
  const float infinity = INFINITY;
  std::memcpy(bytes.data() + 84 + 12, &infinity, 4);
  file("inf.stl", bytes);
  expect_input_error(assess("inf.stl"), "inf.stl", "inf");
}

TEST_F(BadInput, ZeroTriangles) {
  file("none.stl", std::string(84, '\0'));
  expect_input_error(assess("none.stl"), "none.stl", "triangle");
}

TEST_F(BadInput, OneTriangle) {
  file("one.obj", "v 0 0 0\nv 50 0 0\nv 0 50 0\nf 1 2 3\n");
  expect_input_error(assess("one.obj --unit mm"), "one.obj", "triangle");
}

TEST_F(BadInput, VerticesWithoutFaces) {
  file("points.obj", "v 0 0 0\nv 50 0 0\nv 0 50 0\n");
  expect_input_error(assess("points.obj"), "points.obj", "face");
}

TEST_F(BadInput, AbsurdSize) {
  file("huge.stl", tetrahedron(1e9F));
  expect_input_error(assess("huge.stl --unit mm"), "huge.stl", "mm");
  expect_input_error(assess("huge.stl"), "huge.stl", "");
}

TEST_F(BadInput, UndecidableUnitSaysHowToGiveIt) {
  file("unit.stl", tetrahedron(5000));
  expect_input_error(assess("unit.stl"), "unit.stl", "--unit");
}

TEST_F(BadInput, UnknownEnding) {
  file("part.xyz", "1 2 3\n");
  expect_input_error(assess("part.xyz"), "part.xyz", "STL");
}

TEST_F(BadInput, WrongHandFile) {
  file("part.stl", tetrahedron(60));
  file("not.hand.glb", "not a hand at all");
  expect_input_error(assess("part.stl --unit mm --hand not.hand.glb"), "not.hand.glb", "");
  expect_input_error(assess("part.stl --unit mm --hand absent.hand.glb"), "absent.hand.glb", "");
}

TEST_F(BadInput, UnwritableOutput) {
  file("part.stl", tetrahedron(60));
  file("occupied", "a file, not a folder");
  const ProgramRun run = run_palmar("assess part.stl --unit mm --out occupied/report", folder);
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("occupied"));
  EXPECT_EQ(read_text(folder + "/occupied"), "a file, not a folder");
}

TEST_F(BadInput, FullDisk) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full on this machine";
  const ProgramRun run = run_palmar("hand measure > /dev/full");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("output"));
}

TEST_F(BadInput, FileSizeLimitLeavesNoHalfFile) {
  // A limit of 8 blocks of 512 bytes stands in for a disk that fills up while writing.
  const ProgramRun run =
      run_palmar("--version >/dev/null; ulimit -f 8; trap '' XFSZ; '" PALMAR_EXECUTABLE
                 "' product make sphere --diameter-mm 60 --out ball.stl",
                 folder);
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("ball.stl"));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(BadInput, UnknownOptionNamesTheNearest) {
  const ProgramRun run = run_palmar("assess part.stl --untt mm");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("--untt"), HasSubstr("--unit")));
}

TEST_F(BadInput, UnknownCommandAndMissingArguments) {
  EXPECT_EQ(run_palmar("asess part.stl").exit_code, 2);
  EXPECT_EQ(run_palmar("assess").exit_code, 2);
  EXPECT_EQ(run_palmar("").exit_code, 2);
}

TEST_F(BadInput, OptionsOutsideTheirRange) {
  file("part.stl", tetrahedron(60));
  for (const std::string option :
       {"--finger-limit-depth-mm -1", "--palm-limit-depth-mm 500", "--kernel magic", "--grip hug",
        "--unit parsec", "--at 1,2", "--axis 0,0,0", "--shear-modulus-kpa 0", "--threads -2"}) {
    const ProgramRun run = assess("part.stl --unit mm " + option);
    EXPECT_EQ(run.exit_code, 2) << option << ": " << run.err;
    EXPECT_NE(run.err, "") << option;
  }
}

TEST_F(BadInput, MessagesNameOptionsAsTheyAreTyped) {
  file("part.stl", tetrahedron(60));
  file("people.csv", "sex,arm_mm\nF,600\nM,650\n");
  const std::string part = " part.stl --unit mm ";
  const std::string prism = " 'made: prism' --out made ";
  const struct {
    std::string arguments, said;
  } cases[] = {
      {"assess" + part + "--mass-kg 0", "palmar: --mass-kg is 0; more than 0"},
      {"assess" + part + "--strength-n 300",
       "palmar: --strength-n and --person say how strong the user is; --strength-share is "
       "required"},
      {"assess" + part + "--strength-share 0.5 --person male,95",
       "palmar: --person: no grip strength is known for 95 years; 17 to 90 is allowed, or give "
       "--strength-n\n"},
      {"assess" + part + "--no-balance --grip-force-n 20", "palmar: --no-balance keeps the hand"},
      {"assess" + part + "--fingertip thumb:1,2,3",
       "palmar: --fingertip: grip power holds with the whole hand; a precision grip is required, "
       "such as --grip tripod\n"},
      {"assess" + part + "--grip tripod --box 0,0,0,9,9,9",
       "takes fingertips to points; --at or --fingertip says where\n"},
      // There is a --strength of the muscles, too.
      {"effort grasp" + part + "--strength-share 0.5",
       "palmar: --strength-share needs --person or --strength-n\n"},
      {"grasp evaluate" + part +
           "--posture p.json --placement 0,0,0,1,0,0,0 --measured-from-product 0,0,0,1,0,0,0",
       "palmar: --placement and --measured-from-product exclude each other\n"},
      {"contact press --indenter sphere:5 --depth-mm 1 --out curve.xls",
       "palmar: --out: \"curve.xls\" ends with none of"},
      {"contact fit curves.csv --indenter sphere:5 --group thumbs",
       "palmar: --group: \"thumbs\" is not known"},
      {"validate --out table.pdf", "palmar: --out: \"table.pdf\" ends with none of"},
      {"study plan --product part.stl --population hands.csv --hands 5",
       "palmar: --hands has no meaning with the given hands of hands.csv\n"},
      {"population describe people.csv --where sex",
       "palmar: --where: \"sex\" is not understood; COLUMN=VALUE"},
      {"population correlate people.csv --by sex --where sex=X",
       "palmar: --where: no subject of people.csv has sex=X\n"},
      {"population regress people.csv", "name the predictors by --on\n"},
      {"product convert" + part + "--out part.step", "--out with .stl, .obj or .ply is required\n"},
      {"product make sphere --out ball.pdf", "palmar: --out is ball.pdf; .step"},
      {"product make sphere --format pdf --out balls/", "palmar: --format is \"pdf\"; step"},
      {"redesign press" + prism + "--hold-posture kept --grip-force-n 20",
       "palmar: --grip-force-n: in a kept posture the shape decides the force; --hold-posture new "
       "goes"},
      {"redesign press" + prism + "--over most", "palmar: --over is \"most\"; mean"},
      {"redesign press" + prism + "--largest-depth-mm 99",
       "--largest-depth-mm is 99 mm; 0.1 to 50"},
      {"redesign press" + prism + "--rim-mm 99", "--rim-mm is 99 mm; 0.5 to 50"},
      {"redesign press" + prism + "--edge-mm 99", "--edge-mm is 99 mm; 0.3 to 10"},
      {"redesign press" + prism + "--keep-blend-mm 999", "--keep-blend-mm is 999 mm; 0 to 100"},
      {"redesign features" + prism, "palmar: --vary is needed"},
      {"redesign features" + prism, "fillet:long=1:15; or --propose\n"},
      {"redesign features" + prism + "--propose --largest-offset-mm 0",
       "palmar: --largest-offset-mm is 0; above 0"},
      {"redesign features" + prism + "--propose --lost-hands 2", "palmar: --lost-hands is 2; 0 to"},
      {"redesign features" + prism +
           "--vary groove:at=0=1 --groove-radius-mm 2 "
           "--smallest-groove-radius-mm 3",
       "palmar: --groove-radius-mm is 2 mm; at least --smallest-groove-radius-mm, 3 mm"},
      {"redesign fillet" + prism + "--radius-mm 9:2",
       "palmar: --edges with --radius-mm \"9:2\": from 9 to 2"},
  };
  for (const auto& one : cases) {
    const ProgramRun run = run_palmar(one.arguments, folder);
    EXPECT_EQ(run.exit_code, 2) << one.arguments << run.err;
    EXPECT_THAT(run.err, HasSubstr(one.said)) << one.arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(folder + "/made"));
}

}  // namespace
}  // namespace palmar::testing
