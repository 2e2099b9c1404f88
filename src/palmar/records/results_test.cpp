// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Results as files: VTK, CSV and JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/formats/test_files.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/records/csv.h"
#include "palmar/records/hand/hand_json.h"
#include "palmar/records/press_json.h"

namespace palmar::records {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using PlainJson = nlohmann::json;

TEST(Base64, HasTheTestVectorsOfRfc4648) {
  EXPECT_EQ(formats::base64(""), "");
  EXPECT_EQ(formats::base64("f"), "Zg==");
  EXPECT_EQ(formats::base64("fo"), "Zm8=");
  EXPECT_EQ(formats::base64("foo"), "Zm9v");
  EXPECT_EQ(formats::base64("foob"), "Zm9vYg==");
  EXPECT_EQ(formats::base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(formats::base64("foobar"), "Zm9vYmFy");
}

/// Bytes of a base64 text, by the table of RFC 4648.
std::string decoded(std::string_view text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits;
  for (const char c : text) {
    if (c == '=') break;
    for (int b = 5; b >= 0; --b) bits += (digits.find(c) >> b & 1) != 0 ? '1' : '0';
  }
  std::string bytes;
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8) {
    bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
  }
  return bytes;
}

/// Values of the array `name` as a reader finds them: by its offset into the appended data.
template <typename T>
std::vector<T> vtp_array(const std::string& vtp, const std::string& name) {
  const std::size_t element = vtp.find("Name=\"" + name + "\"");
  if (element == vtp.npos) return {};
  const std::size_t key = vtp.find("offset=\"", element) + 8;
  const std::size_t offset = std::stoul(vtp.substr(key));
  const std::size_t data = vtp.find("<AppendedData encoding=\"base64\">\n_") + 34;
  const std::string_view block(vtp.data() + data + offset, vtp.size() - data - offset);
  const auto length = formats::read_value<std::uint64_t>(decoded(block.substr(0, 12)), 0);
  const std::string raw = decoded(block.substr(0, (length + 8 + 2) / 3 * 4)).substr(8, length);
  std::vector<T> values;
  for (std::size_t i = 0; i < raw.size(); i += sizeof(T))
    values.push_back(formats::read_value<T>(raw, i));
  return values;
}

TEST(Vtp, PointsTrianglesAndFieldsReadBackExactly) {
  geometry::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1.0 / 3.0, 0, 0}, {0, 1e-9, 0}, {0, 0, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::string vtp =
      formats::format_vtp(mesh, {{"pressure_mpa", {0.1, 0.2, 0.3, 0.4}, 1},
                                 formats::vector_field("motion_mm", mesh.vertices)});
  EXPECT_THAT(vtp, HasSubstr("NumberOfPoints=\"4\""));
  EXPECT_THAT(vtp, HasSubstr("NumberOfPolys=\"2\""));
  EXPECT_THAT(vtp, HasSubstr("<PointData Scalars=\"pressure_mpa\">"));
  EXPECT_THAT(vtp_array<double>(vtp, "pressure_mpa"), ElementsAre(0.1, 0.2, 0.3, 0.4));
  EXPECT_THAT(vtp_array<double>(vtp, "position_mm"),
              ElementsAre(0, 0, 0, 1.0 / 3.0, 0, 0, 0, 1e-9, 0, 0, 0, 5));
  EXPECT_EQ(vtp_array<double>(vtp, "motion_mm"), vtp_array<double>(vtp, "position_mm"));
  EXPECT_THAT(vtp_array<std::int64_t>(vtp, "connectivity"), ElementsAre(0, 1, 2, 0, 2, 3));
  EXPECT_THAT(vtp_array<std::int64_t>(vtp, "offsets"), ElementsAre(3, 6));
}

TEST(Vtp, FieldsThatDontFitAreRefused) {
  EXPECT_EQ(formats::message_of<Error>([] {
              formats::format_vtp(formats::box_mesh({1, 1, 1}), {{"force_n", {1, 2}, 1}});
            }),
            "field \"force_n\": 2 numbers; 1 for each of 8 vertices are required");
}

TEST(Csv, QuotesWhatRfc4180Quotes) {
  EXPECT_EQ(format_csv({{"name", "force_n"}, {{"plain", "1.5"}, {"a,\"b\"", "line\nbreak"}}}),
            "name,force_n\nplain,1.5\n\"a,\"\"b\"\"\",\"line\nbreak\"\n");
  EXPECT_EQ(formats::message_of<Error>([] {
              format_csv({{"a", "b"}, {{"1"}}});
            }),
            "table row 1 has 1 cells; 2 are required");
}

study::AssessmentSet example() {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "template";
  hand->dimensions.hand_length = 190.0;
  study::Assessment assessment;
  assessment.hand_name = "template";
  grasp::Grasp& grasp = assessment.grasp;
  grasp.status = grasp::GraspStatus::kHeld;
  grasp.posture[hand::Dof::kIndexPipFlexion] = std::numbers::pi / 4.0;
  // A quarter turn about z: x -> y, then +10 in x.
  grasp.product_from_hand = {Quat(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vec3::UnitZ())),
                             Vec3(10, 0, 0)};
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    grasp.stops[s].segment = static_cast<hand::Segment>(s);
  }
  grasp.stops[5] = {static_cast<hand::Segment>(5), grasp::StopReason::kLimitDepth, 4.0};
  contact::ContactResult& contact = assessment.contact;
  contact.status = contact::ContactStatus::kSolved;
  contact.complementarity_error = 1e-12;
  contact.fallbacks.dense_solutions = 2;
  contact::RegionContact region;
  region.region = hand::Region::kIndexDistal;
  region.force = 0.1 + 0.2;  // 0.30000000000000004
  region.area = 100.0;
  region.peak_pressure = 0.25;
  region.centre = {1, 2, 3};
  contact.regions = {region};
  contact.total = region;
  assessment.options.seed = 18446744073709551615u;
  assessment.options.grasp.power.placement.turn = std::numbers::pi;
  product::Product product;
  product.name = "handle \xff";  // no UTF-8
  product.mesh = formats::box_mesh({120, 30, 20});
  product.unit = geometry::LengthUnit::kInch;
  product.unit_source = product::UnitSource::kUser;
  return {hand, {{product, assessment}}, "palmar assess handle.stl"};
}

TEST(AssessmentJson, HasTheShapeThatOtherProgramsRelyOn) {
  const PlainJson json = PlainJson::parse(assessment_json(example()));
  ASSERT_EQ(json.at("assessments").size(), 1u);
  const PlainJson& one = json["assessments"][0];
  for (const char* key : {"product", "hand", "grasp", "contact", "indices", "settings"}) {
    EXPECT_TRUE(one.contains(key)) << key;
  }
  EXPECT_TRUE(one["contact"].contains("grip_force_n"));
  for (const char* key : {"force_n", "contact_area_mm2", "peak_pressure_mpa",
                          "peak_pressure_cells_mpa", "mean_pressure_mpa"}) {
    EXPECT_TRUE(one["contact"].contains(key)) << key;
    EXPECT_TRUE(one["contact"]["regions"][0].contains(key)) << key;
  }
  EXPECT_EQ(one["contact"]["regions"][0]["region"], "index_distal");
  EXPECT_EQ(json["versions"]["palmar"], version());
  EXPECT_EQ(json["command_line"], "palmar assess handle.stl");
}

TEST(AssessmentJson, NumbersReadBackExactlyInTheirUnits) {
  const PlainJson one = PlainJson::parse(assessment_json(example()))["assessments"][0];
  EXPECT_EQ(one["contact"]["force_n"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(one["contact"]["fallbacks"]["dense_solutions"], 2);
  EXPECT_EQ(one["contact"]["fallbacks"]["unsolved_regions"], 0);
  EXPECT_EQ(one["contact"]["centre_mm"], PlainJson({1.0, 2.0, 3.0}));
  EXPECT_DOUBLE_EQ(one["grasp"]["posture"]["index_pip_flexion_deg"].get<double>(), 45.0);
  EXPECT_EQ(one["grasp"]["posture"].size(), 23u);
  EXPECT_EQ(one["grasp"]["segments"].size(), 15u);
  EXPECT_EQ(one["grasp"]["segments"][5]["stopped_by"], "limit_depth");
  EXPECT_EQ(one["grasp"]["segments"][5]["penetration_mm"], 4.0);
  EXPECT_EQ(one["settings"]["seed"].get<std::uint64_t>(), 18446744073709551615u);
  EXPECT_DOUBLE_EQ(one["settings"]["turn_deg"].get<double>(), 180.0);
  EXPECT_TRUE(one["settings"]["axis"].is_null());
  EXPECT_EQ(one["hand"]["hand_length_mm"], 190.0);
  EXPECT_EQ(one["product"]["size_mm"], PlainJson({120.0, 30.0, 20.0}));
  EXPECT_EQ(one["product"]["unit"], "inch");
  EXPECT_EQ(one["product"]["unit_from"], "user");
  EXPECT_EQ(one["indices"]["fingers_in_contact"], PlainJson({"index"}));
}

TEST(AssessmentJson, ThePlacementMapsHandPointsToTheProduct) {
  const PlainJson grasp = PlainJson::parse(grasp_json(example().assessments[0].assessment.grasp));
  const PlainJson& matrix = grasp["product_from_hand"]["matrix_rows_mm"];
  // The hand's point (1, 0, 0) stands at (10, 1, 0) in the product.
  Vec3 mapped;
  for (int r = 0; r < 3; ++r) {
    mapped[r] = matrix[r][0].get<double>() + matrix[r][3].get<double>();
  }
  EXPECT_NEAR((mapped - Vec3(10, 1, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(matrix[3], PlainJson({0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(grasp["product_from_hand"]["translation_mm"], PlainJson({10.0, 0.0, 0.0}));
  const PlainJson& q = grasp["product_from_hand"]["quaternion_wxyz"];
  EXPECT_NEAR(q[0].get<double>(), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(q[3].get<double>(), std::sqrt(0.5), 1e-15);
}

TEST(PressJson, HasTheShapeThatOtherProgramsRelyOn) {
  contact::PressStep step;
  step.depth = 1.5;
  step.force = 0.1 + 0.2;
  step.area = 20.0;
  step.peak_pressure = 0.03;
  contact::PressOptions options;
  options.indenter = {contact::PressIndenter::Kind::kTwoPunches, 2.0, 10.0};
  options.coating = contact::Coating{1.5, 0.2, 0.4, {}};
  options.layer_thickness = 6.0;
  PressSetting setting;
  setting.model.tissue = contact::TissueModel::kLayered;
  const PlainJson json = PlainJson::parse(press_json(options, setting, {step, step}));
  EXPECT_EQ(json["test"]["specimen"], "plane");
  EXPECT_EQ(json["test"]["indenter"], "punches:2,10");
  EXPECT_EQ(json["test"]["tissue_model"], "layered");
  EXPECT_EQ(json["test"]["layer_mm"], 6.0);
  EXPECT_EQ(json["test"]["coating"]["thickness_mm"], 1.5);
  EXPECT_TRUE(json["test"]["hand"].is_null());
  ASSERT_EQ(json.at("steps").size(), 2u);
  const PlainJson& one = json["steps"][0];
  EXPECT_EQ(one["depth_mm"], 1.5);
  EXPECT_EQ(one["force_n"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(one["contact_area_mm2"], 20.0);
  EXPECT_EQ(one["peak_pressure_mpa"], 0.03);
  for (const char* key : {"peak_pressure_cells_mpa", "mean_pressure_mpa"}) {
    EXPECT_TRUE(one.contains(key)) << key;
  }
}

TEST(PressTable, HasOneRowPerStepAndUnitsInTheHeader) {
  contact::PressStep step;
  step.depth = 1.5;
  step.force = 0.1 + 0.2;
  const CsvTable table = press_table({step, step, step});
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.header[0], "depth_mm");
  EXPECT_EQ(table.header[1], "force_n");
  EXPECT_EQ(table.header[2], "contact_area_mm2");
  EXPECT_EQ(table.rows[1][0], "1.5");
  EXPECT_EQ(std::stod(table.rows[1][1]), 0.1 + 0.2);
  EXPECT_THAT(format_csv(table), testing::StartsWith("depth_mm,force_n,contact_area_mm2,"));
}

TEST(RegionTable, HasOneRowPerRegionAndATotal) {
  const CsvTable table = region_table(example());
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.header[3], "grip_force_n");
  EXPECT_EQ(table.header[4], "force_n");
  // A grip force is one of the whole hand.
  EXPECT_THAT(format_csv(table),
              HasSubstr(",template,index_distal,,0.30000000000000004,100,0.25,"));
  EXPECT_EQ(table.rows[1][2], "total");
  EXPECT_NE(table.rows[1][3], "");
}

TEST(RegionTable, DistinguishesProductsOfOneNameBySource) {
  study::AssessmentSet set = example();
  set.assessments.push_back(set.assessments[0]);
  set.assessments[0].product.source = "old/handle.stl";
  set.assessments[1].product.source = "new/handle, 2.stl";
  const CsvTable table = region_table(set);
  EXPECT_EQ(table.header.back(), "source");
  EXPECT_EQ(table.rows.front().back(), "old/handle.stl");
  EXPECT_THAT(format_csv(table), HasSubstr(",\"new/handle, 2.stl\"\n"));
}

TEST(Csv, BrokenBytesAreReplacedAsInJson) {
  const std::string text = format_csv(region_table(example()));
  EXPECT_THAT(text, HasSubstr("\nhandle \xef\xbf\xbd,template,"));
  EXPECT_EQ(text.find('\xff'), text.npos);
  const PlainJson json = PlainJson::parse(assessment_json(example()));
  EXPECT_EQ(json["assessments"][0]["product"]["name"], "handle \xef\xbf\xbd");
}

TEST(HandJson, TakesNamesThatAreNoUtf8) {
  hand::Hand hand;
  hand.name = "hand \xff";
  EXPECT_EQ(PlainJson::parse(hand_info_json(hand))["name"], "hand \xef\xbf\xbd");
}

TEST(AssessmentJson, IsDistinguishedFromOtherJson) {
  EXPECT_TRUE(is_assessment_json(assessment_json(example())));
  for (const char* other :
       {"", "{", "[]", "{\"versions\": {\"palmar\": 1}}", "{\"versions\": 3}"}) {
    EXPECT_FALSE(is_assessment_json(other)) << other;
  }
}

}  // namespace
}  // namespace palmar::records
