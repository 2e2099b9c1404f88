// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/cad_file.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>
#include <numbers>
#include <regex>

#include "gmock/gmock.h"
#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_test_files.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/cad/model/xcaf_bodies.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A plain STEP file as another program would write it, in a unit of the kernel's writer.
void write_plain(const std::filesystem::path& path, const TopoDS_Shape& shape,
                 const char* unit = "MM") {
  STEPControl_Writer writer;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("write.step.unit", unit);
  writer.Model(Standard_True);  // a new one, in this unit
  ASSERT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
  ASSERT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
  Interface_Static::SetCVal("write.step.unit", "MM");
}

void write_iges(const std::filesystem::path& path, const TopoDS_Shape& shape,
                const char* unit = "MM") {
  IGESControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  IGESControl_Writer writer(unit, 0);  // trimmed surfaces without topology, as most old programs
  ASSERT_TRUE(writer.AddShape(shape));
  writer.ComputeModel();
  ASSERT_TRUE(writer.Write(path.c_str()));
}

std::string message_of(const std::filesystem::path& path, const ReadCadOptions& options = {}) {
  try {
    read_cad(path, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

CadModel named_box() {
  const CadModel plain = make_cad_model(rounded_box(40, 30, 120, 3), "grip");
  auto impl = std::make_shared<CadModel::Impl>(plain.impl());
  impl->face_name[3] = "palm side";
  impl->face_name[7] = "Daumenfläche";
  impl->face_colour[5] = {1.0F, 0.5F, 0.25F};
  impl->bodies[0].colour = std::array<float, 3>{0.2F, 0.4F, 0.6F};
  return CadModel(std::move(impl));
}

TEST(WriteStep, ReadBackHasTheSameFacesByNumberNameAndColour) {
  const TestFolder folder;
  const CadModel model = named_box();
  write_step(folder / "grip.step", model);
  const CadFile file = read_step(folder / "grip.step");
  EXPECT_EQ(file.format, "STEP AP214");
  EXPECT_THAT(body_names(file.model), ElementsAre("grip"));
  EXPECT_TRUE(check_cad(file.model).is_good());
  EXPECT_NEAR(volume_of(file.model), volume_of(model), 1e-6 * volume_of(model));
  const product::ProductFaces before = describe_faces(model), after = describe_faces(file.model);
  ASSERT_EQ(after.face.size(), before.face.size());
  for (std::size_t f = 0; f < before.face.size(); ++f) {
    EXPECT_EQ(after.face[f].name, before.face[f].name) << f;
    EXPECT_EQ(after.face[f].kind, before.face[f].kind) << f;
    EXPECT_NEAR(after.face[f].area, before.face[f].area, 1e-6) << f;
    ASSERT_EQ(after.face[f].colour.has_value(), before.face[f].colour.has_value()) << f;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR((*after.face[f].colour)[c], (*before.face[f].colour)[c], 1e-3) << f;
    }
  }
  ASSERT_EQ(after.edge.size(), before.edge.size());
  for (std::size_t e = 0; e < before.edge.size(); ++e) {
    EXPECT_NEAR(after.edge[e].length, before.edge[e].length, 1e-6) << e;
    EXPECT_EQ(after.edge[e].faces, before.edge[e].faces) << e;
  }
}

TEST(WriteStep, SameModelGivesTheSameBytesWithoutDayOrMachine) {
  const TestFolder folder;
  write_step(folder / "a.step", named_box());
  write_step(folder / "b.step", named_box());
  const std::string text = text_of(folder / "a.step");
  EXPECT_EQ(text, text_of(folder / "b.step"));
  const std::string header = text.substr(0, text.find("ENDSEC"));
  EXPECT_THAT(header, HasSubstr("1970-01-01T00:00:00"));
  EXPECT_THAT(header, Not(HasSubstr(std::filesystem::temp_directory_path().string())));
}

TEST(WriteStep, SaysWhereItCannotWrite) {
  const TestFolder folder;
  try {
    write_step(folder / "missing" / "a.step", named_box());
    FAIL() << "no error";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("missing/a.step"));
  }
}

TEST(ReadStep, UnitOfTheFileIsRespectedAndReported) {
  // A cylinder of 32 mm across and 120 mm: pi 16^2 120 mm^3 whatever the file counts in.
  const TestFolder folder;
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(16.0, 120.0).Shape();
  const std::vector<std::tuple<const char*, std::string, double>> units = {
      {"MM", "millimetre", 1.0},
      {"CM", "centimetre", 10.0},
      {"M", "metre", 1000.0},
      {"INCH", "inch", 25.4},
      {"FT", "foot", 304.8}};
  for (const auto& [unit, name, millimetres] : units) {
    write_plain(folder / "c.step", cylinder, unit);
    const CadFile file = read_step(folder / "c.step");
    EXPECT_EQ(file.unit, name);
    EXPECT_NEAR(file.millimetres_per_unit, millimetres, 1e-9);
    EXPECT_NEAR(volume_of(file.model), std::numbers::pi * 256.0 * 120.0, 1e-3) << unit;
  }
}

TEST(ReadStep, UnitOfTheUserWins) {
  const TestFolder folder;
  write_plain(folder / "c.step", BRepPrimAPI_MakeCylinder(1.0, 4.0).Shape());
  const CadFile file = read_step(folder / "c.step", {.millimetres_per_unit = 25.4});
  EXPECT_EQ(file.unit, "millimetre");  // what the file says, for the user to be informed
  EXPECT_NEAR(volume_of(file.model), std::numbers::pi * 4.0 * 25.4 * 25.4 * 25.4, 1e-3);
}

/// "drill" of a handle, two screws (one turned by 90 degrees about x) and a "head" of a box.
void write_assembly(const std::filesystem::path& path) {
  const Handle(TDocStd_Document) document = new_document();
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto part = [&](const TopoDS_Shape& shape, const char* name) {
    const TDF_Label label = shapes->AddShape(shape, Standard_False);
    TDataStd_Name::Set(label, TCollection_ExtendedString(name));
    return label;
  };
  const TDF_Label handle = part(BRepPrimAPI_MakeCylinder(16.0, 120.0).Shape(), "handle");
  const TDF_Label screw = part(BRepPrimAPI_MakeCylinder(2.0, 10.0).Shape(), "screw");
  const TDF_Label box = part(BRepPrimAPI_MakeBox(50, 40, 30).Shape(), "box");
  const TDF_Label head = shapes->NewShape();
  TDataStd_Name::Set(head, TCollection_ExtendedString("head"));
  const auto at = [](double x, double y, double z) {
    gp_Trsf move;
    move.SetTranslation(gp_Vec(x, y, z));
    return move;
  };
  shapes->AddComponent(head, box, TopLoc_Location(at(0, 0, 5)));
  const TDF_Label drill = shapes->NewShape();
  TDataStd_Name::Set(drill, TCollection_ExtendedString("drill"));
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), std::numbers::pi / 2);
  shapes->AddComponent(drill, handle, TopLoc_Location());
  shapes->AddComponent(drill, screw, TopLoc_Location(at(100, 0, 0)));
  shapes->AddComponent(drill, screw, TopLoc_Location(at(200, 0, 0) * turn));
  shapes->AddComponent(drill, head, TopLoc_Location(at(0, 0, 120)));
  shapes->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  ASSERT_TRUE(writer.Transfer(document));
  ASSERT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
}

TEST(ReadStep, AssemblyBecomesBodiesWhereTheirInstancesAre) {
  const TestFolder folder;
  write_assembly(folder / "drill.step");
  const CadFile file = read_step(folder / "drill.step");
  EXPECT_THAT(body_names(file.model), ElementsAre("drill / handle", "drill / screw",
                                                  "drill / screw (2)", "drill / head / box"));
  EXPECT_EQ(file.solids, 4);
  EXPECT_NEAR(volume_of(file.model), std::numbers::pi * (256.0 * 120.0 + 2 * 4.0 * 10.0) + 60000.0,
              1e-3);
  const Tessellation mesh = tessellate(file.model);
  std::map<std::string, Box3> boxes;
  for (int t = 0; t < mesh.mesh.triangle_count(); ++t) {
    Box3& box = boxes[mesh.faces.face[mesh.faces.face_of_triangle[t]].part];
    for (const int v : mesh.mesh.triangles[t]) box.extend(mesh.mesh.vertices[v]);
  }
  // Turned by 90 degrees about x, the axis z of the screw points along -y.
  const Box3 turned = boxes["drill / screw (2)"];
  EXPECT_NEAR(turned.min().y(), -10.0, 1e-9);
  EXPECT_NEAR(turned.max().y(), 0.0, 1e-9);
  EXPECT_NEAR(turned.max().z(), 2.0, 1e-3);
  EXPECT_NEAR(boxes["drill / head / box"].min().z(), 125.0, 1e-9);
  EXPECT_NEAR(boxes["drill / head / box"].max().z(), 155.0, 1e-9);
}

/// A STEP text with assemblies around its product: ten of ten of ten ... of it.
std::string nested(std::string text, int levels, bool in_a_ring = false) {
  const std::regex definition(R"(#(\d+)\s*=\s*PRODUCT_DEFINITION\('design','',#(\d+),#(\d+)\))");
  std::smatch found;
  EXPECT_TRUE(std::regex_search(text, found, definition));
  std::string more;
  std::string inner = "#" + found[1].str();
  const std::string first = inner;
  int next = 500'000;
  const auto use = [&](const std::string& outer, const std::string& part) {
    more += "#" + std::to_string(next++) + "=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','',''," + outer +
            "," + part + ",$);\n";
  };
  for (int level = 0; level < levels; ++level) {
    const std::string outer = "#" + std::to_string(next++);
    more += outer + "=PRODUCT_DEFINITION('design','',#" + found[2].str() + ",#" + found[3].str() +
            ");\n";
    for (int i = 0; i < 10; ++i) use(outer, inner);
    inner = outer;
  }
  if (in_a_ring) use(first, inner);
  return text.insert(text.rfind("ENDSEC"), more);
}

TEST(ReadStep, FewBytesThatStandForABillionBodiesAreRefusedByNumber) {
  const TestFolder folder;
  write_step(folder / "one.step", named_box());
  write_text(folder / "bomb.step", nested(text_of(folder / "one.step"), 9));
  EXPECT_LT(std::filesystem::file_size(folder / "bomb.step"), 100'000U);
  const std::string message = message_of(folder / "bomb.step");
  EXPECT_THAT(message, HasSubstr("bomb.step"));
  EXPECT_THAT(message, HasSubstr("1e+09 bodies; up to 2000 are read"));
  write_text(folder / "ring.step", nested(text_of(folder / "one.step"), 2, true));
  EXPECT_THAT(message_of(folder / "ring.step"), HasSubstr("contains itself"));
}

TEST(ReadStep, AShapeOfAnUnknownTypeIsRefusedByItsNumber) {
  const TestFolder folder;
  write_step(folder / "box.step", named_box());
  std::string text = text_of(folder / "box.step");
  const std::string solid = "MANIFOLD_SOLID_BREP";
  text.insert(text.find(solid) + solid.size(), "P");  // on which the kernel crashes
  write_text(folder / "misspelt.step", text);
  EXPECT_THAT(message_of(folder / "misspelt.step"),
              AllOf(HasSubstr("misspelt.step: item "), HasSubstr(" of the shape #"),
                    HasSubstr("is no shape that can be read")));
}

TEST(ReadStep, WireframePointsAndNothingAreDistinguished) {
  const TestFolder folder;
  TopoDS_Compound wires;
  const BRep_Builder builder;
  builder.MakeCompound(wires);
  builder.Add(wires, BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(100, 0, 0)).Edge());
  builder.Add(wires, BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(0, 50, 0)).Edge());
  write_plain(folder / "wires.step", wires);
  EXPECT_THAT(message_of(folder / "wires.step"), HasSubstr("only a wireframe (2 curves"));
  write_plain(folder / "point.step", BRepBuilderAPI_MakeVertex(gp_Pnt(1, 2, 3)).Vertex());
  EXPECT_THAT(message_of(folder / "point.step"), HasSubstr("only points (1)"));
  write_text(folder / "none.step",
             "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
             "FILE_NAME('n','2020-01-01T00:00:00',(''),(''),'','','');\n"
             "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
             "#1=CARTESIAN_POINT('',(0.,0.,0.));\nENDSEC;\nEND-ISO-10303-21;\n");
  EXPECT_THAT(message_of(folder / "none.step"), HasSubstr("holds no shape"));
}

TEST(ReadStep, BrokenFilesAreNamed) {
  const TestFolder folder;
  write_step(folder / "whole.step", named_box());
  const std::string whole = text_of(folder / "whole.step");
  for (const double share : {0.01, 0.2, 0.5, 0.99}) {
    write_text(
        folder / "cut.step",
        whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    EXPECT_THAT(message_of(folder / "cut.step"), HasSubstr("is cut off")) << share;
  }
  write_text(folder / "empty.step", "");
  EXPECT_THAT(message_of(folder / "empty.step"), HasSubstr("is empty"));
  write_text(folder / "letter.step", "Dear Sir or Madam");
  EXPECT_THAT(message_of(folder / "letter.step"), HasSubstr("neither STEP nor IGES"));
  write_text(folder / "rubbish.step", std::string("\x7F"
                                                  "ELF\0\0\1\2",
                                                  8));
  EXPECT_THAT(message_of(folder / "rubbish.step"), HasSubstr("it is binary"));
  EXPECT_THAT(message_of(folder / "missing.step"), HasSubstr("no such file"));
}

TEST(ReadStep, OpenShellIsABodyThatSaysSo) {
  const TestFolder folder;
  TopoDS_Compound five;  // a box without its lid
  const BRep_Builder builder;
  builder.MakeCompound(five);
  int count = 0;
  for (TopExp_Explorer it(BRepPrimAPI_MakeBox(40, 30, 100).Shape(), TopAbs_FACE);
       it.More() && count < 5; it.Next(), ++count) {
    builder.Add(five, it.Current());
  }
  write_plain(folder / "open.step", five);
  const CadFile file = read_step(folder / "open.step");
  EXPECT_EQ(file.solids, 0);
  EXPECT_EQ(file.open_shells, 1);
  EXPECT_THAT(file.notes, Contains(HasSubstr("open shell")));
  const CadCheck check = check_cad(file.model);
  EXPECT_FALSE(check.is_closed);
  EXPECT_EQ(check.free_edges, 4);
}

TEST(ReadIges, LooseSurfacesThatCloseBecomeASolid) {
  const TestFolder folder;
  write_iges(folder / "box.igs", BRepPrimAPI_MakeBox(40, 30, 100).Shape());
  const CadFile file = read_cad(folder / "box.igs");
  EXPECT_EQ(file.format, "IGES");
  EXPECT_EQ(file.unit, "millimetre");
  EXPECT_EQ(file.solids, 1);
  EXPECT_EQ(file.open_shells, 0);
  EXPECT_NEAR(volume_of(file.model), 120000.0, 1e-3);
  EXPECT_THAT(file.notes, Contains(HasSubstr("made of surfaces that close")));
  write_iges(folder / "inch.iges", BRepPrimAPI_MakeBox(40, 30, 100).Shape(), "INCH");
  const CadFile inch = read_cad(folder / "inch.iges");
  EXPECT_EQ(inch.unit, "inch");
  EXPECT_NEAR(volume_of(inch.model), 120000.0, 1e-2);
}

TEST(ReadIges, OpenShellsAndCutOffFilesAreReportedByName) {
  const TestFolder folder;
  TopoDS_Compound two;
  const BRep_Builder builder;
  builder.MakeCompound(two);
  TopExp_Explorer it(BRepPrimAPI_MakeBox(40, 30, 100).Shape(), TopAbs_FACE);
  builder.Add(two, it.Current());
  it.Next();
  builder.Add(two, it.Current());
  write_iges(folder / "two.igs", two);
  const CadFile file = read_cad(folder / "two.igs");
  EXPECT_EQ(file.solids, 0);
  EXPECT_EQ(file.open_shells, 2);  // opposite sides of the box: they share no edge
  EXPECT_THAT(file.notes, Contains(HasSubstr("2 open shells")));
  const std::string whole = text_of(folder / "two.igs");
  write_text(folder / "cut.igs", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(message_of(folder / "cut.igs"), HasSubstr("is cut off"));
}

}  // namespace
}  // namespace palmar::cad
