// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/coordination_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/geometry/degrees.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

/// Joints with ranges alone.
hand::Skeleton bare_skeleton() {
  hand::Skeleton skeleton;
  for (int d = 0; d < hand::kDofCount; ++d) {
    hand::JointDof dof;
    dof.dof = static_cast<hand::Dof>(d);
    dof.lower = -1.5;
    dof.upper = 2.0;
    skeleton.joints[0].dofs.push_back(dof);
  }
  return skeleton;
}

std::string header(int count = grasp::kDigitDofCount) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    text += (k > 0 ? "," : "") + std::string(name_of(grasp::digit_dof(k))) + "_deg";
  }
  return text + "\n";
}

/// Row i: angle k is 20 + 10 sin(i + k) degrees.
std::string rows(int count, int columns = grasp::kDigitDofCount) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < columns; ++k) {
      text += (k > 0 ? "," : "") + std::to_string(20.0 + 10.0 * std::sin(i + k));
    }
    text += "\n";
  }
  return text;
}

std::string written_postures(const std::string& text) {
  const std::string path = formats::own_file("natural_postures.csv");
  formats::write_file(path, text);
  return path;
}

std::string coordination_message(const std::string& text) {
  try {
    read_coordination(written_postures(text), bare_skeleton());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CoordinationFile, GivesMeanAndComponentsOfItsRows) {
  const std::string path = written_postures(header() + rows(400));
  const grasp::CoordinationBasis basis = read_coordination(path, bare_skeleton());
  EXPECT_EQ(basis.postures, 400);
  EXPECT_EQ(basis.source, path);
  EXPECT_NEAR(basis.mean[3] / geometry::kDegree, 20.0, 0.1);  // the sine's mean over 400 rad
  // sin(i + k) spans two dimensions, so two components carry all but what is regularised.
  EXPECT_EQ(basis.retained, 2);
  EXPECT_NEAR(std::sqrt(basis.covariance(5, 5)) / geometry::kDegree, 10.0 / std::sqrt(2.0), 0.1);
}

TEST(CoordinationFile, TooFewRowsAreNamed) {
  EXPECT_THAT(coordination_message(header() + rows(29)),
              HasSubstr("/natural_postures.csv: it has 29 postures; at least 30"));
}

TEST(CoordinationFile, MissingColumnIsNamed) {
  EXPECT_THAT(coordination_message(header(19) + rows(40, 19)),
              HasSubstr("no little_dip_flexion_deg"));
}

TEST(CoordinationFile, BadValueIsNamedWithItsPlace) {
  std::string text = header() + rows(40);
  text.replace(text.find('\n') + 1, 2, "xx");
  const std::string message = coordination_message(text);
  EXPECT_THAT(message, HasSubstr("/natural_postures.csv:2"));
  EXPECT_THAT(message, HasSubstr("thumb_cmc_flexion_deg"));
  EXPECT_THAT(message, HasSubstr("xx"));
}

}  // namespace
}  // namespace palmar::records
