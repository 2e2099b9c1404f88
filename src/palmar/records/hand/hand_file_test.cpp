// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/hand_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/glb.h"
#include "palmar/formats/test_files.h"
#include "palmar/hand/skin/thumb_cmc.h"

namespace palmar::records {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

geometry::TriangleMesh tetrahedron(double size) {
  return {{{0, 0, 0}, {size, 0, 0.1}, {0, size / 3, 0}, {0, 0, size}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// A hand with every member set to something, numbers without a short binary form.
hand::Hand small_hand() {
  hand::Hand hand;
  hand.name = "small";
  hand.side = hand::Side::kLeft;
  hand.skin = tetrahedron(50.0 / 7);
  hand.segment = {hand::Segment::kPalm, hand::Segment::kThumbDistal, hand::Segment::kLittleDistal,
                  hand::Segment::kPalm};
  hand.region = {hand::Region::kThenar, hand::Region::kThumbDistal, hand::Region::kDorsum,
                 hand::Region::kUlnarPalm};
  for (int j = 0; j < hand::kJointCount; ++j) {
    hand::Joint& joint = hand.skeleton.joints[j];
    joint = {static_cast<hand::JointId>(j), Vec3(j / 3.0, 1, 2), {}};
  }
  for (int d = 0; d < hand::kDofCount; ++d) {
    hand::JointDof dof;
    dof.dof = static_cast<hand::Dof>(d);
    dof.axis = Vec3(1, d / 7.0, 0).normalized();
    dof.centre = Vec3(0.1, 0.2, d);
    dof.reference = d / 9.0;
    dof.lower = -1;
    dof.upper = 3;
    dof.source = "somebody 1999";
    hand.skeleton.joints[d % hand::kJointCount].dofs.push_back(dof);
  }
  hand.skeleton.thumb_cmc = hand::make_cmc_limits(hand::make_cmc_joint({28, 36, 19}, {45, 59, 34}));
  hand.skeleton.fingertips = {Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9), Vec3(1, 1, 1.1),
                              Vec3(0, 0, 0.3)};
  hand.weights = {{hand::JointId::kWrist, {0, 2}, {0.1, 1}, {1.0 / 3, 1}, {}},
                  {hand::JointId::kThumbIp, {1}, {0.7}, {0.9}, {Vec3(0.1, 0.2, 0.3)}}};
  hand.thumb_ball.beta = 0.0048;
  hand.thumb_ball.marker = {{1, 2, 3.3}};
  hand.thumb_ball.vertex = {0, 3};
  for (auto& coefficient : hand.thumb_ball.coefficient) coefficient = {{0.1, 0.2, 0.3}};
  hand.bones = {{"thumb_metacarpal", hand::Segment::kPalm, true, tetrahedron(1)},
                {"radius", std::nullopt, false, tetrahedron(2)}};
  hand.dimensions.hand_length = 184.1;
  hand.dimensions.segment[3] = {40.1, 17.3, 15.9};
  hand.tissue = hand::default_tissue();
  hand.provenance = "made by hand";
  return hand;
}

std::string temporary(const std::string& name) { return formats::own_file(name); }

std::string hand_message(const std::string& path) {
  try {
    read_hand(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(HandFile, AJointFarFromTheHandIsRefused) {
  hand::Hand hand = small_hand();
  hand.skeleton.joints[0].dofs[0].centre.y() = 4.3e9;
  const std::string path = temporary("far.hand.glb");
  write_hand(path, hand);
  EXPECT_THAT(hand_message(path),
              AllOf(HasSubstr("far.hand.glb"), HasSubstr("4.3e+09 mm"), HasSubstr("at most 1000")));
}

TEST(HandFile, ReadBackIsTheIdenticalHand) {
  const hand::Hand hand = small_hand();
  const std::string path = temporary("same.hand.glb");
  write_hand(path, hand);
  const hand::Hand back = read_hand(path);
  EXPECT_EQ(back.name, hand.name);
  EXPECT_EQ(back.side, hand.side);
  EXPECT_EQ(back.provenance, hand.provenance);
  EXPECT_EQ(back.skin.vertices, hand.skin.vertices);
  EXPECT_EQ(back.skin.triangles, hand.skin.triangles);
  EXPECT_EQ(back.segment, hand.segment);
  EXPECT_EQ(back.region, hand.region);
  ASSERT_EQ(back.weights.size(), 2U);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_EQ(back.weights[j].joint, hand.weights[j].joint);
    EXPECT_EQ(back.weights[j].vertex, hand.weights[j].vertex);
    EXPECT_EQ(back.weights[j].w1, hand.weights[j].w1);
    EXPECT_EQ(back.weights[j].w2, hand.weights[j].w2);
    EXPECT_EQ(back.weights[j].bulge, hand.weights[j].bulge);
  }
  for (int d = 0; d < hand::kDofCount; ++d) {
    const hand::JointDof &a = back.skeleton.dof(static_cast<hand::Dof>(d)),
                         &b = hand.skeleton.dof(static_cast<hand::Dof>(d));
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.centre, b.centre);
    EXPECT_EQ(a.reference, b.reference);
    EXPECT_EQ(a.upper, b.upper);
    EXPECT_EQ(a.source, b.source);
  }
  EXPECT_EQ(back.skeleton.thumb_cmc.abduction.q.coeffs(),
            hand.skeleton.thumb_cmc.abduction.q.coeffs());
  EXPECT_EQ(back.skeleton.thumb_cmc.adduction.t, hand.skeleton.thumb_cmc.adduction.t);
  EXPECT_EQ(back.skeleton.fingertips, hand.skeleton.fingertips);
  EXPECT_EQ(back.thumb_ball.marker, hand.thumb_ball.marker);
  EXPECT_EQ(back.thumb_ball.coefficient, hand.thumb_ball.coefficient);
  EXPECT_EQ(back.thumb_ball.vertex, hand.thumb_ball.vertex);
  ASSERT_EQ(back.bones.size(), 2U);
  EXPECT_EQ(back.bones[0].segment, hand::Segment::kPalm);
  EXPECT_TRUE(back.bones[0].is_thumb_metacarpal);
  EXPECT_FALSE(back.bones[1].segment);
  EXPECT_EQ(back.bones[1].mesh.vertices, hand.bones[1].mesh.vertices);
  EXPECT_EQ(back.dimensions.hand_length, hand.dimensions.hand_length);
  EXPECT_EQ(back.dimensions.segment[3].width, hand.dimensions.segment[3].width);
  EXPECT_EQ(back.tissue.region, hand.tissue.region);
  EXPECT_EQ(back.tissue.source, hand.tissue.source);

  const std::string first = formats::read_file(path);
  write_hand(path, back);
  EXPECT_EQ(formats::read_file(path), first) << "writing again must give the same bytes";
}

TEST(HandFile, ViewersFindMetresAndBlendWeightsThatSumToOne) {
  const std::string path = temporary("scene.hand.glb");
  write_hand(path, small_hand());
  const formats::Glb glb = formats::read_glb(path);
  const auto& attributes = glb.json.at("meshes").at(0).at("primitives").at(0).at("attributes");
  const formats::AccessorData position =
      formats::read_accessor(glb, attributes.at("POSITION"), path);
  EXPECT_NEAR(position.value[3], 0.05 / 7, 1e-8);  // m, single precision
  const formats::AccessorData weight =
      formats::read_accessor(glb, attributes.at("WEIGHTS_0"), path);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_NEAR(weight.value[4 * v] + weight.value[4 * v + 1] + weight.value[4 * v + 2] +
                    weight.value[4 * v + 3],
                1, 1e-6);
  }
  EXPECT_EQ(formats::read_accessor(glb, attributes.at("_REGION"), path).value[1],
            static_cast<double>(hand::Region::kThumbDistal));
}

TEST(HandFile, ANewerVersionIsRefusedByName) {
  const std::string path = temporary("newer.hand.glb");
  write_hand(path, small_hand());
  formats::Glb glb = formats::read_glb(path);
  glb.json["extras"]["palmar_hand_version"] = kHandFileVersion + 1;
  formats::write_glb(glb, path);
  EXPECT_THAT(hand_message(path), HasSubstr("version 3; this program reads up to version 2"));
}

/// The tissue of a region as version 1 of the file has it.
nlohmann::json version_1_tissue(double g0_mpa, double g_limit_mpa) {
  return {{"g0_mpa", g0_mpa},          {"g_limit_mpa", g_limit_mpa}, {"limit_depth_mm", 3.5},
          {"swelling_height_mm", 1.5}, {"swelling_radius_mm", 7},    {"swelling_width_mm", 2.5},
          {"neighbourhood_mm", 11}};
}

TEST(HandFile, Version1HasTheStiffnessOfTheHalfSpaceAloneTheRestIsTheDefault) {
  const std::string path = temporary("version1.hand.glb");
  write_hand(path, small_hand());
  formats::Glb glb = formats::read_glb(path);
  glb.json["extras"]["palmar_hand_version"] = 1;
  nlohmann::json& regions = glb.json["extras"]["palmar_hand"]["tissue"]["regions"];
  for (auto& region : regions) region = version_1_tissue(0.006, 0.100);
  regions["thenar"] = version_1_tissue(0.060, 0.090);  // stiffer than the default's high law
  formats::write_glb(glb, path);

  const hand::Tissue tissue = read_hand(path).tissue;
  const hand::Tissue standard = hand::default_tissue();
  const auto of = [](const hand::Tissue& one, hand::Region region) {
    return one.region[index_of(region)];
  };
  const hand::RegionTissue index = of(tissue, hand::Region::kIndexDistal);
  EXPECT_EQ(index.half_space.nominal, (hand::StiffeningLaw{0.006, 0.100, 3.5}));
  EXPECT_EQ(index.half_space.high.g_limit,
            of(standard, hand::Region::kIndexDistal).half_space.high.g_limit);
  EXPECT_EQ(index.layered, of(standard, hand::Region::kIndexDistal).layered);
  EXPECT_EQ(index.poisson_layered, of(standard, hand::Region::kIndexDistal).poisson_layered);
  EXPECT_EQ(index.swelling_height, 1.5);
  EXPECT_EQ(index.neighbourhood, 11);
  // The range takes in what the file says.
  EXPECT_EQ(of(tissue, hand::Region::kThenar).half_space.high.g0, 0.060);
  EXPECT_EQ(of(tissue, hand::Region::kThenar).half_space.high.g_limit, 0.090);
}

TEST(HandFile, WrongFilesAreNamed) {
  const std::string path = temporary("wrong.hand.glb");
  EXPECT_THAT(hand_message(temporary("missing.hand.glb")), HasSubstr("missing.hand.glb"));
  formats::write_file(path, "solid not a glTF file at all\n");
  EXPECT_THAT(hand_message(path), HasSubstr("not a binary glTF file"));
  formats::Glb plain;
  plain.json["asset"]["version"] = "2.0";
  formats::write_glb(plain, path);
  EXPECT_THAT(hand_message(path), HasSubstr("no Palmar hand"));
}

TEST(HandFile, EveryTruncationIsAnInputError) {
  const std::string path = temporary("cut.hand.glb");
  write_hand(path, small_hand());
  const std::string whole = formats::read_file(path);
  for (std::size_t length = 1; length < whole.size(); length += 97) {
    formats::write_file(path, whole.substr(0, length));
    EXPECT_THROW(read_hand(path), InputError) << length << " bytes";
  }
}

TEST(HandFile, DataThatContradictThemselvesAreInputErrors) {
  const std::string path = temporary("broken.hand.glb");
  write_hand(path, small_hand());
  const formats::Glb good = formats::read_glb(path);
  const auto broken = [&](const char* pointer, const nlohmann::json& value) {
    formats::Glb glb = good;
    glb.json["extras"]["palmar_hand"][nlohmann::json::json_pointer(pointer)] = value;
    formats::write_glb(glb, path);
    return hand_message(path);
  };
  EXPECT_THAT(broken("/segment/count", 3), HasSubstr("bufferView"));
  EXPECT_THAT(broken("/side", "both"), HasSubstr("side \"both\""));
  EXPECT_THAT(broken("/weights/0/joint", "elbow"), HasSubstr("elbow"));
  EXPECT_THAT(broken("/skeleton/joints/3/joint", "wrist"), HasSubstr("thumb_ip"));
  EXPECT_THAT(broken("/skeleton/joints/0/dofs/0/axis", {0.3, 0, 0}), HasSubstr("0.3"));
  EXPECT_THAT(broken("/skin/vertices_mm/count", 1000000000000), HasSubstr("broken Palmar hand"));
  EXPECT_THAT(broken("/skin", nullptr), HasSubstr("broken Palmar hand"));
  EXPECT_THAT(broken("/tissue/regions/thenar/layered/nominal/g0_mpa", -0.01),
              HasSubstr("tissue of thenar: layered (nominal): G0 is -10 kPa"));
  EXPECT_THAT(broken("/tissue/regions/thenar/half_space/low/g0_mpa", 0.04),
              HasSubstr("tissue of thenar"));
}

}  // namespace
}  // namespace palmar::records
