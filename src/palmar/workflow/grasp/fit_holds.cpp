// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/fit_holds.h"

#include <filesystem>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/grasp/precision/precision_shape.h"
#include "palmar/records/hold/people_holds_file.h"
#include "palmar/records/product/product_file.h"

namespace palmar::workflow {
namespace {

std::string mesh_of(const std::string& folder, const std::string& object) {
  for (const char* ending : {".obj", ".stl", ".ply"}) {
    const std::filesystem::path path = std::filesystem::path(folder) / (object + ending);
    if (std::filesystem::exists(path)) return path.string();
  }
  throw InputError(folder + ": there is no " + object +
                   ".obj, .stl or .ply; a mesh is required for each object of the table");
}

}  // namespace

grasp::HoldFit fit_holds(const FitHoldsRequest& request, const Progress& progress) {
  const std::vector<records::PeopleHolds> people = records::read_people_holds(request.table);
  std::vector<std::string> meshes;
  meshes.reserve(people.size());
  for (const records::PeopleHolds& one : people) {
    meshes.push_back(mesh_of(request.products, one.object));
  }
  const std::shared_ptr<const hand::Hand> hand = load_hand(request.hand);
  if (hand->side != hand::Side::kRight) {
    throw UsageError("setting \"hand\" is a left hand; people's holds are a right hand's");
  }
  grasp::OpenedHand opened(*hand);
  std::vector<grasp::ObservedObject> objects;
  for (std::size_t k = 0; k < people.size(); ++k) {
    const double done = static_cast<double>(k) / static_cast<double>(people.size());
    progress.update(done, "looking for holds of " + people[k].object);
    const product::Product product =
        records::load_product(meshes[k], {.unit = geometry::LengthUnit::kMillimetre});
    grasp::ObservedObject object;
    object.name = people[k].object;
    object.candidates = grasp::opposed_holds(opened, product, grasp::kOpposedGrips, progress);
    for (const records::PeopleHold& hold : people[k].holds) {
      object.seen.push_back({hold.points, grasp::standing_with(product.mesh, hold.up)});
    }
    objects.push_back(std::move(object));
  }
  progress.update(0.95, "fitting weights");
  const grasp::HoldFit fit = grasp::fit_holds(objects);
  if (!request.out.empty()) {
    formats::write_file(request.out, records::hold_weights_toml(fit.weights));
  }
  return fit;
}

}  // namespace palmar::workflow
