// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/shape_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/records/handle_file.h"
#include "palmar/records/handle_json.h"
#include "palmar/records/product/cad_handle.h"
#include "palmar/report/picture/depth_pictures.h"

namespace palmar::workflow {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Deviation kept_deviation(const redesign::HandleShape& shape, const geometry::TriangleMesh& solid,
                         const product::Product& product) {
  constexpr double kFar = 20.0, kBeside = 0.05;  // mm
  const geometry::Rigid3 to_handle = shape.body.product_from_handle.inverse();
  // Roundings of the ends are made anew with the end radius.
  const double margin = std::max({shape.end_radius, shape.body.end_radius, kBeside});
  std::vector<Vec3> kept;
  for (const Vec3& x : solid.vertices) {
    const Vec3 p = to_handle * x;
    if (p.z() < shape.body.bottom + margin || p.z() > shape.body.top - margin) continue;
    const Eigen::Vector2d across = p.head<2>() - shape.body.centre_at(p.z());
    if (shape.share_at(p.z(), std::atan2(across.y(), across.x())) == 0.0) kept.push_back(x);
  }
  std::vector<geometry::DistanceSample> samples(kept.size());
  product.distance->sample(kept, kFar, samples);
  Deviation deviation;
  double sum = 0.0;
  for (const geometry::DistanceSample& one : samples) {
    deviation.largest = std::max(deviation.largest, std::abs(one.distance));
    sum += one.distance * one.distance;
  }
  if (!samples.empty()) deviation.rms = std::sqrt(sum / static_cast<double>(samples.size()));
  return deviation;
}

std::string replaced_words(const redesign::HandleShape& shape) {
  const redesign::HandleBody& body = shape.body;
  const auto at = [&](double z) { return fmt::format("{:.0f}", z - body.bottom); };
  if (!body.is_whole) {
    return fmt::format(
        "shaped anew: {:.0f} mm of the handle, where hands grip it; the rest of the product stays",
        body.top - body.bottom);
  }
  if (shape.kept_ends[0] == 0.0 && shape.kept_ends[1] == 0.0) {
    return "shaped anew: the whole handle from end to end" +
           std::string(shape.keeps() ? ", but for what is kept" : "");
  }
  return fmt::format(
      "shaped anew: from {} to {} mm of its {:.0f} mm, counted from the little finger's end; what "
      "lies beyond keeps its outline, into which the features run out over 14 mm",
      at(body.bottom + shape.kept_ends[0]), at(body.top - shape.kept_ends[1]),
      body.top - body.bottom);
}

std::string hollow_words(const std::string& product, double wall_before, double wall) {
  const std::string now =
      wall >= 0.0
          ? fmt::format("the wall over the hollow as it is now is {:.1f} mm at its thinnest", wall)
          : fmt::format("it cuts {:.1f} mm into the hollow as it is now", -wall);
  return fmt::format(
      "{} has a hollow handle (wall {:.1f} mm at its thinnest); what is made is solid, and {}. "
      "Shell it "
      "anew, or ask for --smallest-wall-mm",
      product, wall_before, now);
}

product::Product write_shape(const RedesignShapeRequest& request, const product::Product& original,
                             RedesignShapeOutcome& outcome, const Progress& progress) {
  const fs::path& folder = request.redesign.out;
  const redesign::HandleShape& shape = outcome.shape;
  const bool is_whole = shape.body.is_whole;
  std::optional<records::CadSource> source;
  if (!is_whole && original.faces != nullptr) source = cad_source_of(request.redesign);
  const records::MadeHandle made =
      records::make_handle(shape, original.name, source, 0.01, {}, progress);
  const records::HandleSolid& solid = made.handle;
  outcome.solid_volume = solid.volume;
  outcome.faces = solid.faces;
  outcome.poles = solid.poles;
  if (!made.failure.empty()) {
    outcome.add_note(
        request.redesign,
        original.name +
            ": the product with its new handle is written as a mesh only: " + made.failure);
  }
  product::UnitDecision unit;
  unit.unit = geometry::LengthUnit::kMillimetre;
  unit.source = product::UnitSource::kMade;
  if (is_whole && shape.keeps()) {
    outcome.kept_deviation = kept_deviation(shape, solid.mesh.mesh, original).largest;
  }
  const std::string name = original.name + " shaped";
  const records::HandleSolid* const step = is_whole ? &solid : made.whole ? &*made.whole : nullptr;
  product::Product product =
      step != nullptr
          ? product::make_product(name, step->mesh.mesh, unit, "redesign.step", &step->mesh.faces)
          : redesign::shaped_product(original, shape, name);
  outcome.file = folder / (step != nullptr ? "redesign.step" : "redesign.stl");
  if (step != nullptr) formats::write_file(folder / "redesign.step", step->step);
  if (!is_whole) formats::write_file(folder / "handle.step", solid.step);
  formats::write_mesh(folder / "redesign.stl", product.mesh);
  formats::write_file(folder / "handle.toml", records::handle_toml(shape, original.name));
  formats::write_file(folder / "handle.FCMacro", records::freecad_macro(shape, original.name));
  return product;
}

void write_search(const RedesignShapeRequest& request, const RedesignShapeOutcome& outcome) {
  const fs::path& folder = request.redesign.out;
  formats::write_file(folder / "history.csv", history_csv(outcome.story));
  formats::write_file(folder / "history.svg", history_svg(outcome.story));
  formats::write_file(folder / "choices.svg", choices_svg(outcome.story));
  int use = 2;
  for (const report::Figure& one : uses_figures(outcome.story)) {
    formats::write_file(folder / fmt::format("uses-{}.svg", use++), report::to_svg(one));
  }
}

void write_shape_pictures(const RedesignShapeRequest& request, const product::Product& original,
                          const product::Product& redesign, const redesign::HandleShape& shape,
                          const Progress& progress) {
  report::DepthScene scene;
  // The map's even triangles show shading better than a tessellation's long ones.
  scene.mesh = shape.body.is_whole ? redesign::handle_mesh(shape) : redesign.mesh;
  std::vector<geometry::DistanceSample> samples(scene.mesh.vertices.size());
  constexpr double kFar = 100.0;  // mm
  original.distance->sample(scene.mesh.vertices, kFar, samples);
  for (const geometry::DistanceSample& one : samples) scene.depth.push_back(std::abs(one.distance));
  scene.title = original.name + ", shaped anew";
  scene.subtitle = "colours: distance from the original's surface";
  scene.axis = shape.body.product_from_handle.rotation * Vec3::UnitZ();
  scene.palm = -(shape.body.product_from_handle.rotation * Vec3::UnitY());
  for (const report::Picture& picture : report::depth_pictures(scene, {}, progress)) {
    formats::write_file(request.redesign.out / (picture.name + ".png"),
                        report::encode_png(picture.image));
  }
}

Json json_of(const RedesignShapeRequest& request, const RedesignShapeOutcome& outcome) {
  Json json = {
      {"product", request.redesign.product},
      {"command", request.redesign.command},
      {"seed", request.redesign.seed},
      {"population", request.redesign.populations},
      {"search", Json::parse(history_json(outcome.story))},
      {"spread",
       {{"places", request.spread.places},
        {"along_mm", request.spread.along},
        {"turn_deg", redesign::handle_feature("turn").scale * request.spread.turn}}},
      {"features", records::features_json(outcome.shape.features)},
      {"is_whole", outcome.shape.body.is_whole},
      {"gripped_mm", outcome.shape.body.gripped},
      {"length_mm", {outcome.shape.body.bottom, outcome.shape.body.top}},
      {"kept_ends_mm", outcome.shape.kept_ends},
      {"kept_faces", outcome.shape.kept_faces},
      {"kept_deviation_mm", outcome.kept_deviation ? Json(*outcome.kept_deviation) : Json()},
      {"end_radius_mm", outcome.shape.end_radius},
      {"fit_rms_mm", outcome.fit_rms},
      {"largest_change_mm", outcome.change.largest},
      {"volume_ratio", outcome.change.volume_ratio},
      {"smallest_radius_mm", outcome.change.smallest_radius},
      {"wall_mm", outcome.wall ? Json(*outcome.wall) : Json()},
      {"original_wall_mm", outcome.wall_before ? Json(*outcome.wall_before) : Json()},
      {"file", outcome.file.string()},
      {"solid",
       {{"volume_mm3", outcome.solid_volume}, {"faces", outcome.faces}, {"poles", outcome.poles}}}};
  return json;
}

std::vector<report::StudyFigure> search_figures(const SearchStory& story) {
  if (story.result.history.size() < 2) return {};
  std::vector<report::StudyFigure> figures;
  for (report::Figure& one : uses_figures(story)) {
    figures.push_back({.name = fmt::format("uses_{}", figures.size() + 2),
                       .description =
                           "Candidates of the search in two uses, and those that no other "
                           "one beats in every use",
                       .figure = std::move(one)});
  }
  figures.push_back({.name = "choices",
                     .description = "Candidates of the search: the goal over how far the surface "
                                    "moves, and those that no other one beats in both",
                     .figure = choices_figure(story)});
  return figures;
}

}  // namespace palmar::workflow
