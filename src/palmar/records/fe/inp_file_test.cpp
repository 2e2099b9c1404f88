// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/fe/inp_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/records/fe/ccx_results.h"
#include "palmar/records/fe/tetgen.h"

namespace palmar::records {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<Vec3> kCorners = {Vec3(0.0, 0.0, 0.0), Vec3(2.0, 0.0, 0.0), Vec3(0.0, 2.0, 0.0),
                                    Vec3(0.0, 0.0, 2.0)};

/// One tetrahedron: bone below (z = 0), the slanted side pressed, the side x = 0 cut.
BlockMesh one_tet(const std::array<int, 4>& corners = {0, 1, 2, 3}) {
  return make_block_mesh(kCorners, {corners}, {{{0, 2, 1}, 3}, {{1, 2, 3}, 2}, {{0, 3, 2}, 4}});
}

PressDeck one_tet_deck() {
  PressDeck deck;
  deck.title = "one tetrahedron";
  deck.block = one_tet();
  deck.indenter = indenter_surface({.kind = contact::PressIndenter::Kind::kPlane},
                                   {Quat::Identity(), Vec3(0.0, 0.0, 2.0)});
  deck.depths = {0.5, 1.0};
  return deck;
}

/// Lines after the first that starts with `keyword`, up to the next keyword.
std::vector<std::string> block_after(const std::string& deck, const std::string& keyword) {
  std::istringstream stream(deck);
  std::vector<std::string> lines;
  bool is_inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (is_inside && line.starts_with("*")) break;
    if (is_inside) lines.push_back(line);
    if (line.starts_with(keyword)) is_inside = true;
  }
  return lines;
}

TEST(TetMesh, MiddlesStandOnTheEdgesInTheOrderOfC3D10) {
  // CalculiX manual, "Ten-node tetrahedral element": 5 on 1-2, 6 on 2-3, 7 on 3-1, 8 on 1-4, 9 on
  // 2-4, 10 on 3-4.
  const TetMesh mesh = one_tet().mesh;
  ASSERT_EQ(mesh.tets.size(), 1u);
  const auto& t = mesh.tets[0];
  constexpr std::array<std::array<int, 2>, 6> kEnds = {
      {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}}};
  const auto at = [&](int k) { return mesh.nodes[t[k - 1]]; };
  for (int k = 0; k < 6; ++k) {
    const auto [a, b] = kEnds[k];
    EXPECT_LT((at(5 + k) - 0.5 * (at(a) + at(b))).norm(), 1e-12) << "node " << 5 + k;
  }
  EXPECT_NEAR(smallest_jacobian(mesh), 8.0, 1e-12);  // 6 V, V = 8 / 6 mm^3
  EXPECT_NEAR(volume(mesh), 8.0 / 6.0, 1e-12);
}

TEST(TetMesh, TetrahedronInsideOutIsTurned) {
  const BlockMesh turned = one_tet({1, 0, 2, 3});
  EXPECT_NEAR(smallest_jacobian(turned.mesh), 8.0, 1e-12);
}

TEST(TetMesh, BoundaryIsSortedByItsMarks) {
  const BlockMesh block = one_tet();
  ASSERT_EQ(block.pressed.size(), 1u);
  EXPECT_EQ(block.pressed[0].side, 3);  // C3D10: face 3 is 2-4-3
  EXPECT_THAT(block.on_bone, ElementsAre(0, 1, 2, 4, 5, 6));
  EXPECT_THAT(block.on_cut, ElementsAre(3, 7, 9));  // corners and middles that bone doesn't hold
}

TEST(TetMesh, SaysWhatIsWrongWithATetrahedron) {
  EXPECT_THAT(
      [] {
        make_block_mesh(kCorners, {{0, 1, 2, 9}}, {});
      },
      ThrowsMessage<InputError>(HasSubstr("node 9; 0 to 3 is allowed")));
  EXPECT_THAT(
      [] {
        make_block_mesh(kCorners, {{0, 1, 2, 2}}, {});
      },
      ThrowsMessage<InputError>(HasSubstr("has no volume")));
}

TEST(InpDeck, ElementsAndSetsCountFromOne) {
  const std::string deck = inp_deck(one_tet_deck());
  EXPECT_THAT(block_after(deck, "*ELEMENT, TYPE=C3D10"), ElementsAre("1,1,2,3,4,5,6,7,8,9,10"));
  EXPECT_THAT(block_after(deck, "*NSET, NSET=BONE"), ElementsAre("1,2,3,5,6,7"));
  EXPECT_THAT(block_after(deck, "*NSET, NSET=CUT"), ElementsAre("4,8,10"));
  EXPECT_THAT(block_after(deck, "*SURFACE, NAME=SKIN"), ElementsAre("1,S3"));
  EXPECT_THAT(block_after(deck, "*CONTACT PAIR"), ElementsAre("SKIN,TOOL"));
}

TEST(InpDeck, YoungsModulusIsInMegapascal) {
  PressDeck deck = one_tet_deck();
  deck.shear_modulus = 0.01;
  deck.poisson = 0.49;
  EXPECT_THAT(block_after(inp_deck(deck), "*ELASTIC"), ElementsAre("0.0298,0.49"));
  EXPECT_THAT(inp_deck(deck), testing::Not(HasSubstr("NLGEOM")));
  deck.material = DeckMaterial::kNeoHooke;
  // C10 = G / 2, D1 = 2 / K with K = E / 3 (1 - 2 nu) = 0.0298 / 0.06 MPa.
  EXPECT_THAT(block_after(inp_deck(deck), "*HYPERELASTIC, NEO HOOKE"),
              ElementsAre("0.005,4.02684564"));
  EXPECT_THAT(inp_deck(deck), HasSubstr("NLGEOM"));
}

TEST(InpDeck, IndenterMovesByTheDepthInEachStep) {
  const std::string deck = inp_deck(one_tet_deck());
  EXPECT_THAT(deck, HasSubstr("INDENTER,3,3,-0.5\n"));
  EXPECT_THAT(deck, HasSubstr("INDENTER,3,3,-1\n"));
  EXPECT_THAT(deck, HasSubstr("INDENTER,1,1,-0\n"));
}

TEST(InpDeck, WedgesOfTheIndenterHavePositiveVolumeBehindTheirFace) {
  const PressDeck deck = one_tet_deck();
  const Triangle& c = deck.indenter.triangles.front();
  const auto at = [&](int k) { return deck.indenter.vertices[c[k]]; };
  // Towards the skin, i.e. along the press.
  EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).dot(deck.direction), 0.0);
  // C3D6: corners 1-2-3 turn towards 4-5-6, which lie a millimetre back.
  const std::string text = inp_deck(deck);
  const std::string first = block_after(text, "*ELEMENT, TYPE=C3D6").front();
  const int nodes = static_cast<int>(deck.block.mesh.nodes.size());
  const int layer = deck.indenter.vertex_count();
  std::ostringstream expected;
  expected << 2;
  for (const int shift : {0, layer}) {
    for (const int k : {0, 2, 1}) expected << ',' << nodes + shift + c[k] + 1;
  }
  EXPECT_EQ(first, expected.str());
}

TEST(InpDeck, RefusesWhatCantBeSolved) {
  PressDeck deck = one_tet_deck();
  deck.poisson = 0.5;
  EXPECT_THAT([&] { inp_deck(deck); }, ThrowsMessage<UsageError>(HasSubstr("below 0.5")));
  deck = one_tet_deck();
  deck.depths = {1.0, 0.5};
  EXPECT_THAT([&] { inp_deck(deck); }, ThrowsMessage<UsageError>(HasSubstr("0.5 mm after 1 mm")));
  deck = one_tet_deck();
  std::swap(deck.block.mesh.tets[0][0], deck.block.mesh.tets[0][1]);
  EXPECT_THAT([&] { inp_deck(deck); }, ThrowsMessage<UsageError>(HasSubstr("inside out")));
  deck = one_tet_deck();
  deck.block.on_bone.clear();
  EXPECT_THAT([&] { inp_deck(deck); }, ThrowsMessage<UsageError>(HasSubstr("held by bone")));
}

TEST(IndenterSurface, SphereStandsOnItsLowestPoint) {
  const geometry::TriangleMesh mesh =
      indenter_surface({.kind = contact::PressIndenter::Kind::kSphere, .radius = 10.0}, {});
  double lowest = 1.0;
  for (const Vec3& v : mesh.vertices) {
    EXPECT_NEAR((v - Vec3(0.0, 0.0, 10.0)).norm(), 10.0, 1e-9);
    lowest = std::min(lowest, v.z());
  }
  EXPECT_NEAR(lowest, 0.0, 1e-12);
  EXPECT_THAT([] { indenter_surface({.kind = contact::PressIndenter::Kind::kPunch}, {}); },
              ThrowsMessage<UsageError>(HasSubstr("has a sharp edge")));
}

TEST(CcxResults, TotalsAndPressuresOfEveryStep) {
  const std::string dat =
      "\n total force (fx,fy,fz) for set INDENTER and time  0.1000000E+01\n\n"
      "        1.000000E-02 -2.000000E-02  3.000000E-02\n\n"
      "   area,  normal force (+ = tension) and shear force (size)\n\n"
      "    9.500000E+00 -3.700000E-02  1.000000E-12\n\n";
  const std::string frd =
      " -4  CONTACT     6    1\n -5  COPEN       1    4    1    1\n"
      " -1         3 1.00000E-03 0.00000E+00 0.00000E+00 2.50000E-02 0.00000E+00 0.00000E+00\n"
      " -1         4 1.00000E-03 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00\n"
      " -3\n";
  const std::vector<CcxStep> steps = parse_ccx(dat, frd, "press");
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].force, Vec3(0.01, -0.02, 0.03));
  EXPECT_EQ(steps[0].area, 9.5);
  EXPECT_THAT(steps[0].node, ElementsAre(2));  // from 0
  EXPECT_THAT(steps[0].pressure, ElementsAre(0.025));
}

TEST(CcxResults, SaysThatNothingWasSolved) {
  EXPECT_THAT([] { parse_ccx("", "", "press"); },
              ThrowsMessage<InputError>(HasSubstr("press: no step was solved")));
  EXPECT_THAT(
      [] { parse_ccx(" total force (fx,fy,fz) for set INDENTER and time 1\n", "", "press"); },
      ThrowsMessage<InputError>(HasSubstr("did CalculiX end early?")));
}

TEST(TetgenFiles, PolyNamesFacetsWithHolesAndMarks) {
  hand::TissueBlock block;
  block.vertices = kCorners;
  block.facets = {{hand::BlockFace::kCut, {{0, 1, 2}, {1, 2, 3}}, {Vec3(0.5, 0.25, 0.0)}}};
  block.hole = {Vec3(1.0, 0.0, 0.5)};
  const std::string text = tetgen_poly(block);
  EXPECT_THAT(text, HasSubstr("\n4 3 0 0\n0 0 0 0\n1 2 0 0\n"));
  EXPECT_THAT(text, HasSubstr("\n1 1\n2 1 4\n3 0 1 2\n3 1 2 3\n1 0.5 0.25 0\n"));
  EXPECT_THAT(text, HasSubstr("\n1\n1 1 0 0.5\n"));
}

class TetgenFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("palmar_tetgen_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    formats::create_folder(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(TetgenFolder, ReadsMeshThatCountsFromOne) {
  formats::write_file(folder_ / "t.node",
                      "4 3 0 0\n 1 0 0 0\n 2 2 0 0\n 3 0 2 0 # comment\n 4 0 0 2\n");
  formats::write_file(folder_ / "t.ele", "1 4 0\n 1 1 2 3 4\n");
  formats::write_file(folder_ / "t.face", "1 1\n 1 1 3 2 3\n");
  const BlockMesh block = read_tetgen((folder_ / "t").string());
  EXPECT_NEAR(volume(block.mesh), 8.0 / 6.0, 1e-12);
  EXPECT_EQ(block.on_bone.size(), 6u);
}

TEST_F(TetgenFolder, NamesFileAndLineOfWhatIsWrong) {
  formats::write_file(folder_ / "t.node", "1 3 0 0\n 1 0 0 zero\n");
  EXPECT_THAT([&] { read_tetgen((folder_ / "t").string()); },
              ThrowsMessage<InputError>(HasSubstr("t.node:2: \"zero\" is no number")));
}

TEST_F(TetgenFolder, ProgramsReportTheirExitCode) {
  EXPECT_EQ(formats::find_program("no-such-program-anywhere"), std::nullopt);
  const auto shell = formats::find_program("sh");
  ASSERT_TRUE(shell);
  EXPECT_EQ(formats::run_program(*shell, {"-c", "echo said; exit 3"}, folder_, "log"), 3);
  EXPECT_EQ(formats::read_file(folder_ / "log"), "said\n");
  EXPECT_EQ(formats::run_program(*shell, {"-c", "kill -9 $$"}, folder_, "log"), 128 + 9);
}

}  // namespace
}  // namespace palmar::records
