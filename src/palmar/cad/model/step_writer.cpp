// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepVisual_MechanicalDesignGeometricPresentationRepresentation.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/model/xcaf_bodies.h"
#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"

namespace palmar::cad {
namespace {

void set_name(const TDF_Label& label, const std::string& name) {
  // Multi-byte UTF-8 becomes wide characters, which the writer escapes as ISO 10303-21 wants.
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), Standard_True));
}

void set_colour(const Handle(XCAFDoc_ColorTool) & tool, const TDF_Label& label,
                const std::array<float, 3>& colour, XCAFDoc_ColorType type = XCAFDoc_ColorSurf) {
  tool->SetColor(label, Quantity_Color(colour[0], colour[1], colour[2], Quantity_TOC_sRGB), type);
}

Handle(TDocStd_Document) document_of(const CadModel& model) {
  const CadModel::Impl& impl = model.impl();
  const Handle(TDocStd_Document) document = new_document();
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  for (const CadModel::Impl::Body& body : impl.bodies) {
    const TDF_Label label = shapes->NewShape();
    // A body that is a moved instance is written where it is, as a part of its own.
    shapes->SetShape(label, body.shape);
    set_name(label, body.name.empty() ? "body" : body.name);
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(body.shape, TopAbs_FACE, faces);
    if (body.colour) {
      // A wire has no surface to colour.
      set_colour(colours, label, *body.colour,
                 faces.IsEmpty() ? XCAFDoc_ColorCurv : XCAFDoc_ColorSurf);
    }
    for (int f = 1; f <= faces.Extent(); ++f) {
      const int number = impl.faces.FindIndex(faces(f));
      const auto name = impl.face_name.find(number);
      const auto colour = impl.face_colour.find(number);
      if (name == impl.face_name.end() && colour == impl.face_colour.end()) continue;
      const TDF_Label sub = shapes->AddSubShape(label, faces(f));
      if (sub.IsNull()) continue;
      if (name != impl.face_name.end()) set_name(sub, name->second);
      if (colour != impl.face_colour.end()) set_colour(colours, sub, colour->second);
    }
  }
  shapes->UpdateAssemblies();
  return document;
}

Handle(TCollection_HAsciiString) text(const std::string& value) {
  return new TCollection_HAsciiString(value.c_str());
}

/// The header names Palmar, and nothing of the day, the user or the machine.
void set_header(const Handle(StepData_StepModel) & model) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text("product"));
  header.SetTimeStamp(text("1970-01-01T00:00:00"));
  header.SetAuthorValue(1, text(""));
  header.SetOrganizationValue(1, text(""));
  header.SetPreprocessorVersion(text("Palmar"));
  header.SetOriginatingSystem(text("Palmar"));
  header.SetAuthorisation(text(""));
  header.SetDescriptionValue(1, text("Palmar model"));
}

/// Where the shape that a presentation gives its colour to stands in the model; 0: nowhere.
int place_of_shape(const Handle(StepRepr_Representation) & presentation,
                   const Handle(StepData_StepModel) & model) {
  if (presentation->Items().IsNull() || presentation->NbItems() == 0) return 0;
  const auto item = Handle(StepVisual_StyledItem)::DownCast(presentation->ItemsValue(1));
  return item.IsNull() || item->Item().IsNull() ? 0 : model->Number(item->Item());
}

/// The kernel keeps the colours of bodies in a map by address and writes them in its order, another
/// one in every run. Shapes come first, in the order of the bodies: colours follow that order.
void settle_order(const Handle(StepData_StepModel) & model) {
  using Presentation = StepVisual_MechanicalDesignGeometricPresentationRepresentation;
  std::vector<Handle(Standard_Transient)> shapes, rest;
  std::vector<std::pair<int, Handle(Standard_Transient)>> colours;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) one = model->Value(i);
    if (const auto colour = Handle(Presentation)::DownCast(one); !colour.IsNull()) {
      colours.emplace_back(place_of_shape(colour, model), colour);
    } else {
      (colours.empty() ? shapes : rest).push_back(one);
    }
  }
  if (colours.size() < 2) return;
  std::stable_sort(colours.begin(), colours.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  model->ClearEntities();
  for (const auto& one : shapes) model->AddEntity(one);
  for (const auto& [place, colour] : colours) model->AddWithRefs(colour);
  for (const auto& one : rest) {
    if (!model->Contains(one)) model->AddEntity(one);
  }
}

}  // namespace

void write_step(const std::filesystem::path& path, const CadModel& model) {
  if (model.is_empty())
    throw OutputError(path.string() + ": a model without bodies can't be written");
  STEPCAFControl_Writer writer;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.product.name", "product");
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 1);
  Interface_Static::SetIVal("write.surfacecurve.mode", 1);
  writer.SetNameMode(Standard_True);
  writer.SetColorMode(Standard_True);
  writer.SetLayerMode(Standard_False);
  writer.SetPropsMode(Standard_False);
  writer.SetDimTolMode(Standard_False);
  if (!writer.Transfer(document_of(model), STEPControl_AsIs)) {
    throw OutputError(path.string() + ": the CAD kernel can't turn the model into STEP");
  }
  settle_order(writer.ChangeWriter().Model());
  set_header(writer.ChangeWriter().Model());
  std::filesystem::path temporary = path;
  temporary += ".part";
  const bool is_written = writer.Write(temporary.c_str()) == IFSelect_RetDone;
  std::error_code error;
  if (is_written) std::filesystem::rename(temporary, path, error);
  if (!is_written || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw OutputError(
        path.string() + ": can't be written" +
        (error ? ": " + error.message() : " (folder missing, no permission or disk full)"));
  }
}

}  // namespace palmar::cad
