// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/replace_handle.h"

#include <fmt/format.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>

#include <cmath>
#include <numbers>

#include "palmar/cad/edits/solid_edit.h"
#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/solids/finished_solid.h"
#include "palmar/cad/solids/handle_solid.h"
#include "palmar/cad/solids/loft.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kBeyond = 0.5;       // mm; what is cut out is so much wider than the outlines
constexpr double kStep = 0.1;         // mm; outlines are off the faces by less
constexpr double kSameVolume = 2e-3;  // of the volume
constexpr int kToolColumns = 48;
constexpr double kToolRows = 4.0;  // mm

/// Everything within the outlines that the handle has now.
CadModel old_handle(const redesign::HandleShape& shape) {
  const redesign::HandleBody& body = shape.body;
  const auto section = [&](double z, double t) {
    const double phi = 2.0 * std::numbers::pi * t;
    const Eigen::Vector2d centre = body.centre_at(z);
    const double r = shape.radius_before(z, phi) + kBeyond;
    return SectionPoint{centre.x() + r * std::cos(phi), centre.y() + r * std::sin(phi)};
  };
  return finished_solid(make_loft(section, {.bottom = body.bottom,
                                            .top = body.top,
                                            .columns = kToolColumns,
                                            .row_distance = kToolRows,
                                            .bands = {{body.bottom, body.top, {}, {"side"}}}}),
                        "old handle", body.product_from_handle);
}

/// What a boolean operation has made of a face: itself if it is left as it is.
TopTools_ListOfShape made_of(BRepAlgoAPI_BooleanOperation& operation, const TopoDS_Face& face) {
  if (operation.IsDeleted(face)) return {};
  TopTools_ListOfShape faces = operation.Modified(face);
  if (faces.IsEmpty()) faces.Append(face);
  return faces;
}

TopTools_ListOfShape solids_in(const TopoDS_Shape& shape) {
  TopTools_ListOfShape solids;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) solids.Append(it.Current());
  return solids;
}

}  // namespace

CadModel replace_handle(const CadModel& product, const redesign::HandleShape& shape) {
  const std::string feature = "the handle in its product";
  const CadModel::Impl& before = product.impl();
  if (before.bodies.size() != 1 || product.solid_count() != 1) {
    throw NumericalError(fmt::format("{}: the product has {} bodies and {} solids; one is required",
                                     feature, before.bodies.size(), product.solid_count()));
  }
  // Outlines that nearly are those of the faces give slivers where they cross, or, made one, edges
  // off their faces: within them they meet in a clear step.
  redesign::HandleShape within = shape;
  for (std::vector<double>& row : within.body.outlines.radius) {
    for (double& one : row) one -= kStep;
  }
  const CadModel handle = make_handle_solid(within), old = old_handle(shape);
  NamedSolid made;
  try_feature(feature, [&] {
    BRepAlgoAPI_Cut cut(before.shape, old.impl().shape);
    if (!cut.IsDone()) throw NumericalError(feature + ": the old handle can't be cut out");
    TopTools_ListOfShape rest = solids_in(cut.Shape()), fresh;
    if (rest.IsEmpty()) throw NumericalError(feature + ": nothing is left of the product");
    fresh.Append(handle.impl().shape);
    BRepAlgoAPI_Fuse fuse;
    fuse.SetArguments(rest);
    fuse.SetTools(fresh);
    fuse.Build();
    if (!fuse.IsDone()) throw NumericalError(feature + ": it can't be united with the rest");
    made.shape = checked_solid(fuse.Shape(), feature);
    const double both = volume_of(cut.Shape()) + volume_of(handle);
    const double whole = volume_of(made.shape);
    if (std::abs(whole - both) > kSameVolume * both) {
      throw NumericalError(
          fmt::format("{}: {:.0f} mm3 come out of parts of {:.0f} mm3", feature, whole, both));
    }
    const auto name = [&](const TopTools_ListOfShape& faces, const std::string& text) {
      for (const TopoDS_Shape& face : faces) made.names.push_back({TopoDS::Face(face), text});
    };
    for (const auto& [number, text] : before.face_name) {
      for (const TopoDS_Shape& left : made_of(cut, TopoDS::Face(before.faces(number)))) {
        name(made_of(fuse, TopoDS::Face(left)), text);
      }
    }
    for (const auto& [number, text] : handle.impl().face_name) {
      name(made_of(fuse, TopoDS::Face(handle.impl().faces(number))), text);
    }
  });
  return finished_solid(made, before.bodies.front().name);
}

}  // namespace palmar::cad
