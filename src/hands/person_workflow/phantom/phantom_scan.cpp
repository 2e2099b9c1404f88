// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/phantom/phantom_scan.h"

#include <filesystem>
#include <map>
#include <utility>

#include "hands/person_records/painted_hand_file.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/coloured_mesh_file.h"
#include "palmar/geometry/mesh/cluster_vertices.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

void write_scan(const std::filesystem::path& path, geometry::ColouredMesh surface,
                double millimetres, int texture_side) {
  for (Vec3& v : surface.mesh.vertices) v /= millimetres;
  if (path.extension() == ".ply") {
    formats::write_coloured_mesh(path, surface);
    return;
  }
  // Coarser than its colours, as such programs write it.
  const geometry::TriangleMesh coarse = geometry::cluster_vertices(surface.mesh, 1.6 / millimetres);
  const phantom::TexturedSurface textured =
      phantom::textured_surface(coarse, surface, texture_side);
  formats::write_textured_mesh(path, textured.mesh, textured.colours);
}

}  // namespace

void PhantomScanRequest::check() const {
  if (out.empty()) throw UsageError("setting \"out\" is empty; a folder to write to is required");
  person.check();
  if (format != "ply" && format != "obj") {
    throw UsageError("setting \"format\": \"" + format +
                     "\" is neither ply (colours at the vertices) nor obj (a texture)");
  }
  defects.check();
}

PhantomScanOutcome make_phantom_scan(const PhantomScanRequest& request, const Progress& progress) {
  request.check();
  progress.update(0.0, "making the person");
  const std::vector<hand::ScanPosture> postures = sorted_postures(request.postures);
  const std::uint64_t seed = request.person.seed;
  const phantom::PaintedHand hand =
      phantom::make_painted_hand(*workflow::load_hand(request.base), postures, request.person);
  const std::filesystem::path out(request.out);
  formats::create_folder(out / "scan");
  std::map<hand::ScanPosture, person_records::PaintedHandPlace> places;
  PhantomScanOutcome outcome;
  for (const hand::ScanPosture posture : postures) {
    const std::string name(name_of(posture));
    progress.update(
        0.3 + 0.6 * static_cast<double>(places.size()) / static_cast<double>(postures.size()),
        name);
    phantom::ScanDefects defects = request.defects;
    defects.seed = 16 * seed + static_cast<std::uint64_t>(posture);
    phantom::ScannedSurface scan =
        phantom::scanned_surface(phantom::surface_of(hand, posture), 0.0, defects);
    if (request.mirrored) {
      for (Vec3& v : scan.surface.mesh.vertices) v.x() = -v.x();
      for (Triangle& t : scan.surface.mesh.triangles) std::swap(t[1], t[2]);
    }
    const std::filesystem::path file = out / "scan" / (name + "." + request.format);
    write_scan(file, scan.surface, geometry::millimetres_per(request.unit), request.texture_side);
    places[posture] = {"scan/" + file.filename().string(), scan.scan_from_hand};
    outcome.scans.push_back(
        {posture, file.string(), static_cast<std::size_t>(scan.surface.mesh.triangle_count())});
  }
  const std::string truth = (out / "truth").string();
  person_records::write_painted_hand(truth, hand, seed, places);
  outcome.person = {hand.name, hand.side, truth + "/subject.json"};
  return outcome;
}

}  // namespace palmar::person_workflow
