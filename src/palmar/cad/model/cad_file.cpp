// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/cad_file.h"

#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <StepBasic_ConversionBasedUnit.hxx>
#include <StepBasic_ConversionBasedUnitAndLengthUnit.hxx>
#include <StepBasic_SiUnit.hxx>
#include <StepBasic_SiUnitAndLengthUnit.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <TCollection_HAsciiString.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "palmar/cad/model/occt_progress.h"
#include "palmar/cad/model/step_instances.h"
#include "palmar/cad/model/xcaf_bodies.h"
#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/records/product/cad_format.h"

namespace palmar::cad {
namespace {

struct FileUnit {
  std::string name;
  double millimetres = 1.0;
};

/// Length unit among the units of a representation's context.
std::optional<FileUnit> unit_of(const Handle(StepRepr_GlobalUnitAssignedContext) & context) {
  if (context.IsNull() || context->Units().IsNull()) return std::nullopt;
  for (int i = 1; i <= context->NbUnits(); ++i) {
    const Handle(StepBasic_NamedUnit) unit = context->UnitsValue(i);
    const auto converted = Handle(StepBasic_ConversionBasedUnitAndLengthUnit)::DownCast(unit);
    const auto si = Handle(StepBasic_SiUnitAndLengthUnit)::DownCast(unit);
    if (converted.IsNull() && si.IsNull()) continue;
    STEPConstruct_UnitContext factors;
    factors.ComputeFactors(unit);
    if (!factors.LengthDone()) return std::nullopt;
    FileUnit result{"", factors.LengthFactor()};
    if (!converted.IsNull() && !converted->Name().IsNull()) {
      result.name = lower_case(converted->Name()->ToCString());
    } else {
      static const std::map<double, std::string> names = {
          {1e-3, "micrometre"}, {1.0, "millimetre"}, {10.0, "centimetre"},
          {100.0, "decimetre"}, {1000.0, "metre"},   {1e6, "kilometre"}};
      for (const auto& [mm, name] : names) {
        if (std::abs(result.millimetres / mm - 1.0) < 1e-9) result.name = name;
      }
      if (result.name.empty()) result.name = significant(result.millimetres, 6) + " mm";
    }
    return result;
  }
  return std::nullopt;
}

/// Units of all shape representations; the first by entity number leads.
std::vector<FileUnit> units_of(const Handle(StepData_StepModel) & model) {
  std::vector<FileUnit> units;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto shape = Handle(StepShape_ShapeRepresentation)::DownCast(model->Value(i));
    if (shape.IsNull()) continue;
    const Handle(StepRepr_RepresentationContext) context = shape->ContextOfItems();
    std::optional<FileUnit> unit;
    if (const auto full = Handle(
            StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(context);
        !full.IsNull()) {
      unit = unit_of(full->GlobalUnitAssignedContext());
    } else if (const auto plain =
                   Handle(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::
                       DownCast(context);
               !plain.IsNull()) {
      unit = unit_of(plain->GlobalUnitAssignedContext());
    } else if (const auto bare = Handle(StepRepr_GlobalUnitAssignedContext)::DownCast(context);
               !bare.IsNull()) {
      unit = unit_of(bare);
    }
    if (!unit) continue;
    const bool is_known = std::any_of(units.begin(), units.end(), [&](const FileUnit& u) {
      return std::abs(u.millimetres / unit->millimetres - 1.0) < 1e-9;
    });
    if (!is_known) units.push_back(*unit);
  }
  return units;
}

/// What the file's lengths must still be multiplied by after the kernel turned them into mm.
double settle_unit(const std::vector<FileUnit>& units, const ReadCadOptions& options,
                   CadFile& file) {
  double from_file = 1.0;
  if (!units.empty()) {
    from_file = units.front().millimetres;
    file.unit = units.front().name;
  }
  if (!(from_file > 0.0) || !std::isfinite(from_file)) from_file = 1.0;
  if (units.size() > 1) {
    std::string names;
    for (const FileUnit& unit : units) names += (names.empty() ? "" : ", ") + unit.name;
    file.notes.push_back("its parts are in different units (" + names + "); each was converted");
  }
  file.millimetres_per_unit = options.millimetres_per_unit.value_or(from_file);
  return file.millimetres_per_unit / from_file;
}

/// "3 entities are broken, the first is #57"; "" if none is. Such files
/// may still hold what is wanted, or crash the kernel.
std::string broken_entities(const Handle(StepData_StepModel) & model) {
  int count = 0, first = 0;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (!model->Check(i, Standard_True)->HasFailed()) continue;
    if (count++ == 0) first = i;
  }
  if (count == 0) return "";
  return std::to_string(count) + (count == 1 ? " entity is" : " entities are") +
         " broken, the first is #" + std::to_string(model->IdentLabel(model->Value(first)));
}

/// Shapes that stand for something the kernel couldn't read, as an entity whose type it doesn't
/// know: it would crash on them. "" if there are none.
std::string unreadable_shape(const Handle(StepData_StepModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto shape = Handle(StepShape_ShapeRepresentation)::DownCast(model->Value(i));
    if (shape.IsNull() || shape->Items().IsNull()) continue;
    for (int k = 1; k <= shape->NbItems(); ++k) {
      if (!shape->ItemsValue(k).IsNull()) continue;
      return "item " + std::to_string(k) + " of the shape #" +
             std::to_string(model->IdentLabel(shape)) + " is no shape that can be read";
    }
  }
  return "";
}

std::string schema_of(const std::string& head) {
  const std::size_t begin = head.find("FILE_SCHEMA");
  if (begin == head.npos) return "";
  const std::size_t open = head.find('\'', begin);
  const std::size_t close = open == head.npos ? open : head.find('\'', open + 1);
  if (close == head.npos) return "";
  std::string name = head.substr(open + 1, close - open - 1);
  if (name.find("AUTOMOTIVE_DESIGN") != name.npos) return "AP214";
  if (name.find("CONFIG_CONTROL_DESIGN") != name.npos) return "AP203";
  if (name.find("AP203") != name.npos) return "AP203";
  if (name.find("AP242") != name.npos) return "AP242";
  return "schema " + name.substr(0, name.find(' '));
}

}  // namespace

void ReadCadOptions::check() const {
  if (millimetres_per_unit && !(*millimetres_per_unit > 0.0 && *millimetres_per_unit <= 1e6)) {
    throw UsageError("millimetres per unit " + significant(*millimetres_per_unit, 6) +
                     "; more than 0 and up to 1e6 is allowed");
  }
  if (max_bodies < 1) throw UsageError("max_bodies " + std::to_string(max_bodies) + "; 1 or more");
  if (max_faces < 1) throw UsageError("max_faces " + std::to_string(max_faces) + "; 1 or more");
}

CadFile read_step(const std::filesystem::path& path, const ReadCadOptions& options,
                  const Progress& progress) {
  options.check();
  const std::string object = path.string();
  const records::CadFormatCheck format = records::check_cad_format(path);
  CadFile file;
  file.format = "STEP " + schema_of(format.head);
  progress.update(0.0, "reading " + path.filename().string());

  STEPCAFControl_Reader reader;
  // Set after a reader exists: the kernel's own start would undo it.
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
  reader.SetNameMode(Standard_True);
  reader.SetColorMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  reader.SetPropsMode(Standard_False);
  reader.SetSHUOMode(Standard_False);
  reader.SetGDTMode(Standard_False);
  reader.SetMatMode(Standard_False);
  reader.SetViewMode(Standard_False);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    throw InputError(object + ": is not a STEP file that can be read: its text is broken");
  }
  const Handle(StepData_StepModel) model = reader.ChangeReader().StepModel();
  const std::string broken = broken_entities(model);
  if (const std::string unreadable = unreadable_shape(model); !unreadable.empty()) {
    throw InputError(object + ": " + unreadable + (broken.empty() ? "" : " (" + broken + ")") +
                     "; the file is damaged or its entities are misspelt, export it again");
  }
  const std::string activity =
      "translating " + path.filename().string() + (broken.empty() ? "" : " (" + broken + ")");
  if (!broken.empty()) file.notes.push_back(broken);
  progress.update(0.3, activity);  // reported if the kernel crashes on it
  if (const double instances = count_instances(model); instances > options.max_bodies) {
    throw InputError(object + ": " +
                     (std::isinf(instances)
                          ? "an assembly of it contains itself"
                          : "its assemblies repeat parts to " + significant(instances, 6) +
                                " bodies; up to " + std::to_string(options.max_bodies) +
                                " are read") +
                     ". Export the part that is held, not the whole assembly");
  }
  Handle(TDocStd_Document) document = new_document();
  const Handle(OcctProgress) indicator = new OcctProgress(progress, 0.3, 0.9, activity);
  const bool is_done = reader.Transfer(document, indicator->Start());
  progress.throw_if_cancelled();
  if (!is_done) {
    throw InputError(object + ": holds no shape (" + file.format + ", " +
                     std::to_string(model->NbEntities()) + " entities); export the solid");
  }
  const double scale = settle_unit(units_of(model), options, file);
  flatten(document, scale, options, object, progress, file);
  progress.update(1.0, "read " + path.filename().string());
  return file;
}

CadFile read_iges(const std::filesystem::path& path, const ReadCadOptions& options,
                  const Progress& progress) {
  options.check();
  const std::string object = path.string();
  records::check_cad_format(path);
  CadFile file;
  file.format = "IGES";
  progress.update(0.0, "reading " + path.filename().string());
  IGESCAFControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  reader.SetNameMode(Standard_True);
  reader.SetColorMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    throw InputError(object + ": is not an IGES file that can be read: its text is broken");
  }
  std::vector<FileUnit> units;
  const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  if (!model.IsNull()) {
    const IGESData_GlobalSection& global = model->GlobalSection();
    static const std::map<int, FileUnit> known = {
        {1, {"inch", 25.4}},         {2, {"millimetre", 1.0}},  {4, {"foot", 304.8}},
        {5, {"mile", 1609344.0}},    {6, {"metre", 1000.0}},    {7, {"kilometre", 1e6}},
        {8, {"mil", 0.0254}},        {9, {"micrometre", 1e-3}}, {10, {"centimetre", 10.0}},
        {11, {"microinch", 2.54e-5}}};
    if (const auto found = known.find(global.UnitFlag()); found != known.end()) {
      units.push_back(found->second);
    }
  }
  Handle(TDocStd_Document) document = new_document();
  const Handle(OcctProgress) indicator =
      new OcctProgress(progress, 0.3, 0.9, "translating " + path.filename().string());
  const bool is_done = reader.Transfer(document, indicator->Start());
  progress.throw_if_cancelled();
  if (!is_done) throw InputError(object + ": holds no shape; export the solid");
  const double scale = settle_unit(units, options, file);
  flatten(document, scale, options, object, progress, file);
  progress.update(1.0, "read " + path.filename().string());
  return file;
}

CadFile read_cad(const std::filesystem::path& path, const ReadCadOptions& options,
                 const Progress& progress) {
  return records::check_cad_format(path).format == records::CadFormat::kIges
             ? read_iges(path, options, progress)
             : read_step(path, options, progress);
}

}  // namespace palmar::cad
