// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A STEP file of more than 500 faces: read and turned into triangles that know their face. Must
// reach: 3 s. For comparison, the kernel alone: read without names and meshed with its defaults.
#include <benchmark/benchmark.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>

#include <filesystem>

#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/model/tessellation.h"

namespace {

using namespace palmar;

/// A plate of 130 x 130 x 30 mm with 16 x 16 blind holes: 518 faces.
std::filesystem::path plate() {
  static const std::filesystem::path path = [] {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    TopTools_ListOfShape plates, drills;
    plates.Append(BRepPrimAPI_MakeBox(130, 130, 30).Shape());
    for (int i = 0; i < 16; ++i) {
      for (int j = 0; j < 16; ++j) {
        const gp_Ax2 axis(gp_Pnt(5 + 8 * i, 5 + 8 * j, 10), gp_Dir(0, 0, 1));
        drills.Append(BRepPrimAPI_MakeCylinder(axis, 2.5, 30).Shape());
      }
    }
    BRepAlgoAPI_Cut cut;
    cut.SetArguments(plates);
    cut.SetTools(drills);
    cut.Build();
    const auto file = std::filesystem::temp_directory_path() / "palmar_cad_benchmark.step";
    cad::write_step(
        file, cad::make_cad_model(TopExp_Explorer(cut.Shape(), TopAbs_SOLID).Current(), "plate"));
    return file;
  }();
  return path;
}

void ReadAndTessellate(benchmark::State& state) {
  const auto path = plate();
  for (auto _ : state) {
    const cad::CadFile file = cad::read_step(path);
    const cad::Tessellation mesh = cad::tessellate(file.model);
    state.counters["faces"] = file.model.face_count();
    state.counters["triangles"] = mesh.mesh.triangle_count();
  }
}
BENCHMARK(ReadAndTessellate)->Unit(benchmark::kMillisecond)->UseRealTime();

void KernelAlone(benchmark::State& state) {
  const auto path = plate();
  for (auto _ : state) {
    STEPControl_Reader reader;
    reader.ReadFile(path.c_str());
    reader.TransferRoots();
    const TopoDS_Shape shape = reader.OneShape();
    BRepMesh_IncrementalMesh(shape, 0.065, Standard_False, 0.25, Standard_True);
    int faces = 0;
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) ++faces;
    state.counters["faces"] = faces;
  }
}
BENCHMARK(KernelAlone)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
