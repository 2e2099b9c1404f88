// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/placement_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar::records {
namespace {

using PlainJson = nlohmann::json;

constexpr double kRoundingOfFiles = 0.01;  // of a unit length: numbers in files are rounded

double finite_number(const PlainJson& json) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) {
    throw InputError(formats::in_quotes(json.dump()) + " is where a number is needed");
  }
  return json.get<double>();
}

const PlainJson& list_of(const PlainJson& json, const char* name, std::size_t size) {
  if (!json.contains(name)) throw InputError(std::string("\"") + name + "\" is missing");
  const PlainJson& list = json[name];
  if (!list.is_array() || list.size() != size) {
    throw InputError(std::string("\"") + name + "\" needs " + std::to_string(size) + " entries");
  }
  return list;
}

geometry::Rigid3 from_matrix(const PlainJson& json) {
  const PlainJson& rows = list_of(json, "matrix_rows_mm", 4);
  Eigen::Matrix4d m;
  for (std::size_t r = 0; r < 4; ++r) {
    if (!rows[r].is_array() || rows[r].size() != 4) {
      throw InputError("\"matrix_rows_mm\" needs 4 rows of 4 numbers");
    }
    for (std::size_t c = 0; c < 4; ++c) {
      m(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = finite_number(rows[r][c]);
    }
  }
  const Eigen::Matrix3d turn = m.topLeftCorner<3, 3>();
  const bool is_rotation =
      (turn * turn.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
          kRoundingOfFiles &&
      turn.determinant() > 0 &&
      (m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < 1e-9;
  if (!is_rotation) {
    throw InputError(
        "\"matrix_rows_mm\" is no rotation (without mirroring or scale) beside a "
        "translation, last row 0 0 0 1");
  }
  return {Quat(turn).normalized(), m.topRightCorner<3, 1>()};
}

}  // namespace

geometry::Rigid3 placement_from_json(const PlainJson& json) {
  if (!json.is_object()) throw InputError("an object is needed");
  if (!json.contains("quaternion_wxyz") && json.contains("matrix_rows_mm")) {
    return from_matrix(json);
  }
  const PlainJson& q = list_of(json, "quaternion_wxyz", 4);
  const PlainJson& t = list_of(json, "translation_mm", 3);
  const Quat turn(finite_number(q[0]), finite_number(q[1]), finite_number(q[2]),
                  finite_number(q[3]));
  if (!(std::abs(turn.norm() - 1.0) < kRoundingOfFiles)) {
    throw InputError("\"quaternion_wxyz\" has length " + formats::shortest(turn.norm()) +
                     "; 1 is needed");
  }
  // A unit quaternion stays as it is to the last bit.
  return {std::abs(turn.norm() - 1.0) < 1e-14 ? turn : turn.normalized(),
          Vec3(finite_number(t[0]), finite_number(t[1]), finite_number(t[2]))};
}

nlohmann::ordered_json placement_with_matrix(const geometry::Rigid3& product_from_hand) {
  using PlacementJson = nlohmann::ordered_json;
  const Quat& q = product_from_hand.rotation;
  const Eigen::Matrix3d r = q.toRotationMatrix();
  const Vec3& t = product_from_hand.translation;
  PlacementJson matrix = PlacementJson::array();
  for (int row = 0; row < 3; ++row) matrix.push_back({r(row, 0), r(row, 1), r(row, 2), t[row]});
  matrix.push_back({0.0, 0.0, 0.0, 1.0});
  return {{"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", {t.x(), t.y(), t.z()}},
          {"matrix_rows_mm", std::move(matrix)}};
}

}  // namespace palmar::records
