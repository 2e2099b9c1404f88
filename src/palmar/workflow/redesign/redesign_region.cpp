// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/redesign_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/coloured_mesh_file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/records/product/cad_format.h"
#include "palmar/records/product/cad_worker.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/records/product/made_product.h"
#include "palmar/redesign/contact_study.h"
#include "palmar/report/picture/region_picture.h"
#include "palmar/workflow/redesign/region_files.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Along the handle that hands hold: what was asked for; else the bar whose axis is nearest to
/// across their fingers; and where the whole product is such a bar, its own principal axis, which
/// is exact.
Vec3 handle_axis(const RedesignRequest& request, const HeldOriginal& original) {
  if (request.axis) return request.axis->normalized();
  constexpr double kOblique = 0.8, kSame = 0.998;  // cosines of 37 and 3.6 degrees
  Vec3 across = Vec3::Zero();
  for (const study::StudyRecord& record : original.records) {
    if (study::is_in_hand(record)) across += record.product_from_hand.rotation * Vec3::UnitX();
  }
  const geometry::TriangleMesh& mesh = original.product().mesh;
  const grasp::PrincipalFrame frame = grasp::principal_frame(mesh);
  if (!(across.norm() > 1e-9)) return frame.axes.col(0);
  Vec3 axis = across.normalized();
  double nearest = kOblique;
  for (const grasp::GripSite& site : grasp::find_grip_sites(mesh)) {
    const double cosine = std::abs(site.axis.dot(across.normalized()));
    if (cosine <= nearest) continue;
    nearest = cosine;
    axis = site.axis;
  }
  for (int k = 0; k < 3; ++k) {
    if (std::abs(frame.axes.col(k).dot(axis)) > kSame) return frame.axes.col(k);
  }
  return axis;
}

/// Surfaces of one patch: one, or one for each piece of it if it goes over edges.
void fit_patch(RegionFindings& findings, int region, int number, const std::vector<Vec3>& normals,
               double pressed_share) {
  const redesign::RegionPatch& patch = findings.regions[static_cast<std::size_t>(region)]
                                           .patches[static_cast<std::size_t>(number - 1)];
  std::vector<Vec3> points, directions, targets;
  for (const int v : patch.vertices) {
    const auto i = static_cast<std::size_t>(v);
    points.push_back(findings.map.mesh.vertices[i]);
    directions.push_back(normals[i]);
    targets.push_back(points.back() - pressed_share * findings.imprint[i] * normals[i]);
  }
  // The product's own edges decide, not how unevenly hands press.
  const auto pieces = redesign::split_patch(points, directions);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    FittedPatch fitted;
    fitted.region = region;
    fitted.number = number;
    fitted.piece = pieces.size() > 1 ? static_cast<int>(p) + 1 : 0;
    std::vector<Vec3> at, out;
    for (const int k : pieces[p]) {
      const auto i = static_cast<std::size_t>(k);
      at.push_back(points[i]);
      out.push_back(directions[i]);
      fitted.target_points.push_back(targets[i]);
      fitted.mean_depth += findings.imprint[static_cast<std::size_t>(patch.vertices[i])];
    }
    fitted.mean_depth /= static_cast<double>(at.size());
    fitted.product = redesign::choose_surface(at, out);
    fitted.target = redesign::choose_surface(fitted.target_points, out);
    findings.patches.push_back(std::move(fitted));
  }
}

RegionFindings find_regions(const HeldOriginal& original, const RedesignRegionRequest& request,
                            const std::function<void(const std::string&)>& note,
                            const Progress& progress) {
  RegionFindings findings;
  redesign::ContactStudy contact =
      redesign::study_contact(original.study.plan, original.study.inputs, original.source(), {}, 0,
                              request.threshold, progress);
  findings.map = std::move(contact.map);
  findings.count = std::move(contact.count);
  findings.imprint = std::move(contact.imprint);
  findings.axis = handle_axis(request.redesign, original);
  const geometry::TriangleMesh& map = findings.map.mesh;
  findings.regions.push_back(redesign::contact_region(map, findings.count, {}, request.region));
  for (const redesign::HandPart part :
       {redesign::HandPart::kFingers, redesign::HandPart::kThumb, redesign::HandPart::kPalm}) {
    findings.regions.push_back(redesign::contact_region(map, findings.count, part, request.region));
  }
  if (findings.regions.front().patches.empty()) {
    throw UsageError(fmt::format(
        "redesign region: {} touch nowhere above {:g} MPa; a smaller setting \"share\" or setting "
        "\"threshold\" has a region",
        findings.regions.front().title, request.threshold));
  }
  const std::vector<Vec3> normals = geometry::vertex_normals(map);
  for (std::size_t r = 1; r < findings.regions.size(); ++r) {
    const redesign::ContactRegion& region = findings.regions[r];
    for (std::size_t k = 0; k < region.patches.size(); ++k) {
      if (region.patches[k].area < request.smallest_patch ||
          region.patches[k].vertices.size() < 8) {
        continue;
      }
      fit_patch(findings, static_cast<int>(r), static_cast<int>(k) + 1, normals,
                request.pressed_share);
    }
  }
  try {
    findings.sheet = redesign::unroll(original.product().mesh, findings.regions, findings.axis);
  } catch (const UsageError& error) {
    note(error.what());
  }
  if (request.relieves) {
    redesign::RegionOptions wide = request.region;
    wide.share = request.relief_share;
    redesign::ReliefOptions options = request.relief;
    options.axis = findings.axis;
    try {
      findings.plan = redesign::plan_reliefs(
          map, findings.regions.front(), redesign::contact_region(map, findings.count, {}, wide),
          findings.imprint, options);
      for (const std::string& text : findings.plan->notes) note(text);
    } catch (const UsageError& error) {
      note(error.what());
    }
  }
  return findings;
}

/// Runs the CAD program; gives its reply, and the redesign if a solid was cut.
Json run_region_cad(const RedesignRegionRequest& asked, const RegionFindings& findings,
                    const product::Product& product, std::optional<RedesignedProduct>& redesign,
                    const Progress& progress) {
  const records::CadFolder folder;
  const bool made = records::is_made(asked.redesign.product);
  const bool has_solid = made || records::is_cad_file(asked.redesign.product);
  const std::vector<redesign::RidgeRelief> reliefs =
      findings.plan && has_solid ? findings.plan->reliefs : std::vector<redesign::RidgeRelief>();
  Json request = records::region_request(curves_of(findings), surfaces_of(findings), reliefs);
  request["junction_radius_mm"] = asked.junction_radius;
  if (made) {
    records::MakeCadOptions options;
    options.mesh = false;
    formats::write_file(
        folder.path() / "product.step",
        records::make_cad(records::made_from(asked.redesign.product), options, progress).step);
    request["file"] = (folder.path() / "product.step").string();
  } else if (has_solid) {
    request["file"] = fs::absolute(asked.redesign.product).string();
    if (asked.redesign.unit) {
      request["millimetres_per_unit"] = geometry::millimetres_per(*asked.redesign.unit);
    }
  }
  records::CadLimits limits;
  limits.seconds = 300.0;
  const Json reply = Json::parse(
      records::run_cad("region", request.dump(), folder, product.name, limits, progress));
  const fs::path& out = asked.redesign.out;
  formats::write_file(out / "region.step", formats::read_file(folder.path() / "region.step"));
  if (!reliefs.empty()) {
    const std::string step = formats::read_file(folder.path() / "redesign.step");
    formats::write_file(out / "redesign.step", step);
    records::FaceMesh mesh = records::read_face_mesh(folder.path() / "mesh.bin");
    formats::write_mesh(out / "redesign.stl", mesh.mesh);
    product::UnitDecision unit;
    unit.unit = geometry::LengthUnit::kMillimetre;
    unit.source = product::UnitSource::kMade;
    redesign = RedesignedProduct{product::make_product(product.name + ", reliefs", mesh.mesh, unit,
                                                       "redesign.step", &mesh.faces),
                                 "reliefs", (out / "redesign.step").string()};
  }
  return reply;
}

}  // namespace

void RedesignRegionRequest::check() const {
  redesign.check();
  region.check();
  relief.check();
  require_setting(threshold >= 0.0, "threshold", threshold, "0 MPa or more");
  require_setting(pressed_share >= 0.0 && pressed_share <= 1.0, "pressed share", pressed_share,
                  "0 to 1");
  require_setting(smallest_patch >= 0.0, "smallest patch", smallest_patch, "0 mm2 or more");
  require_setting(relief_share >= 0.0 && relief_share <= 1.0, "relief share", relief_share,
                  "0 to 1");
  require_setting(junction_radius >= 0.0 && junction_radius <= 50.0, "junction radius",
                  junction_radius, "0 to 50 mm");
}

RedesignRegionOutcome redesign_region(const RedesignRegionRequest& request,
                                      const Progress& progress) {
  request.check();
  RedesignRegionOutcome outcome;
  const auto note = [&](const std::string& text) { outcome.add_note(request.redesign, text); };
  const HeldOriginal original = grasp_original(request.redesign, progress);
  outcome.notes = original.study.notes;
  outcome.product = std::make_shared<const product::Product>(original.product());
  const product::Product& product = *outcome.product;
  outcome.findings = find_regions(original, request, note, progress);
  const RegionFindings& findings = outcome.findings;
  const fs::path& out = request.redesign.out;
  formats::create_folder(out);
  std::optional<RedesignedProduct> redesign;
  const Json cad = run_region_cad(request, findings, product, redesign, progress);
  if (findings.plan && !redesign) {
    // A mesh has no solid: its own triangles go back instead.
    redesign = RedesignedProduct{
        redesign::relieved_product(product, *findings.plan, product.name + ", reliefs"), "reliefs",
        (out / "redesign.stl").string()};
    formats::write_mesh(out / "redesign.stl", redesign->product.mesh);
    note(product.name +
         " is a mesh: region.step has outlines and surfaces but no solid, and the redesign is a "
         "mesh, too");
  }
  Json json = {{"product", product.name},
               {"source", product.source},
               {"command", request.redesign.command},
               {"seed", request.redesign.seed},
               {"population", request.redesign.populations},
               {"posture", name_of(request.redesign.posture)}};
  json.update(Json::parse(region_json(findings, product)));
  json["cad"] = cad;
  formats::write_file(out / "region.json", json.dump(2) + "\n");
  if (const std::string csv = region_csv(findings, product); !csv.empty()) {
    formats::write_file(out / "region.csv", csv);
  }
  const std::vector<redesign::ContactRegion> parts(findings.regions.begin() + 1,
                                                   findings.regions.end());
  if (findings.sheet) {
    const formats::Drawing drawing =
        region_drawing(*findings.sheet, findings.regions, product.name);
    formats::write_file(out / "outline.dxf", formats::dxf_of(drawing));
    formats::write_file(out / "outline.svg", formats::svg_of(drawing));
  }
  formats::write_coloured_mesh(out / "region.ply",
                               report::region_surface(findings.map.mesh, parts));
  if (request.draws) {
    formats::write_file(out / "region.png", report::encode_png(report::region_picture(
                                                findings.map.mesh, parts, findings.axis,
                                                product.name + ": contact region", {}, progress)));
  }
  if (request.on_region) request.on_region(outcome);
  outcome.json = json.dump();
  if (redesign && request.compares) {
    outcome.judge(request.redesign, original, *redesign, progress);
  }
  return outcome;
}

}  // namespace palmar::workflow
