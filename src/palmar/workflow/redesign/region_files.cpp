// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/region_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/report/picture/region_picture.h"

namespace palmar::workflow {
namespace {

using Json = nlohmann::ordered_json;

Json region_vector(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

std::array<float, 3> cad_colour(std::optional<redesign::HandPart> part) {
  const report::Rgb c = report::colour_of(part);
  return {c.r / 255.0F, c.g / 255.0F, c.b / 255.0F};
}

Json fit_json(const redesign::SurfaceFit& fit) {
  const redesign::SimpleSurface& s = fit.surface;
  Json json = {{"kind", name_of(s.kind)},
               {"title", title_of(s)},
               {"point_mm", region_vector(s.point)},
               {"axis", region_vector(s.axis)}};
  if (s.kind != product::FaceKind::kPlane) json["radius_mm"] = s.radius;
  if (s.kind == product::FaceKind::kTorus) json["tube_radius_mm"] = s.tube_radius;
  if (s.kind == product::FaceKind::kCone) {
    json["half_angle_deg"] = s.half_angle * 180.0 / std::numbers::pi;
  }
  json["rms_mm"] = fit.rms;
  json["max_mm"] = fit.max;
  json["has_converged"] = fit.has_converged;
  return json;
}

Json choice_json(const redesign::SurfaceChoice& choice) {
  Json json = fit_json(choice.best());
  Json others = Json::array();
  for (const redesign::SurfaceFit& fit : choice.fits) {
    others.push_back({{"kind", name_of(fit.surface.kind)},
                      {"rms_mm", fit.has_converged ? Json(fit.rms) : Json()},
                      {"max_mm", fit.has_converged ? Json(fit.max) : Json()}});
  }
  json["all"] = std::move(others);
  return json;
}

Json relief_json(const redesign::ReliefPlan& plan) {
  Json list = Json::array();
  for (const redesign::RidgeRelief& one : plan.reliefs) {
    list.push_back({{"name", one.name},
                    {"radius_mm", one.radius},
                    {"radius_before_mm", one.radius_before},
                    {"depth_mm", one.depth},
                    {"length_mm", (one.end - one.start).norm()},
                    {"start_mm", region_vector(one.start)},
                    {"end_mm", region_vector(one.end)},
                    {"outward", region_vector(one.outward)},
                    {"half_angle_deg", one.half_angle * 180.0 / std::numbers::pi},
                    {"run_out_mm", one.run_out},
                    {"goes_through_start", one.is_open_start},
                    {"goes_through_end", one.is_open_end}});
  }
  return {{"axis", region_vector(plan.axis)}, {"reliefs", std::move(list)}, {"notes", plan.notes}};
}

std::vector<redesign::FaceShare> shares_of(const RegionFindings& findings,
                                           const redesign::ContactRegion& region,
                                           const product::Product& product) {
  return redesign::face_shares(findings.map.mesh, findings.map.face_of_triangle,
                               static_cast<int>(product.faces->face.size()), findings.count,
                               region);
}

bool has_faces(const RegionFindings& findings, const product::Product& product) {
  return product.faces != nullptr && !findings.map.face_of_triangle.empty();
}

}  // namespace

std::string name_of(const RegionFindings& findings, const FittedPatch& patch) {
  const redesign::ContactRegion& region = findings.regions[static_cast<std::size_t>(patch.region)];
  return fmt::format("contact {}, patch {}", region.title, patch.number) +
         (patch.piece > 0 ? fmt::format(", piece {}", patch.piece) : "");
}

std::vector<records::NamedCurve> curves_of(const RegionFindings& findings) {
  std::vector<records::NamedCurve> curves;
  for (const redesign::ContactRegion& region : findings.regions) {
    int number = 0;
    for (const redesign::RegionPatch& patch : region.patches) {
      for (const redesign::RegionOutline& outline : patch.outline) {
        const std::string whose = region.part ? "" : "hand, ";
        curves.push_back({.name = fmt::format("outline {}{}, {}", whose, region.title, ++number),
                          .colour = cad_colour(region.part),
                          .points = outline.points});
      }
    }
  }
  return curves;
}

std::vector<records::NamedSurface> surfaces_of(const RegionFindings& findings) {
  std::vector<records::NamedSurface> surfaces;
  for (const FittedPatch& one : findings.patches) {
    const redesign::SurfaceFit& fit = one.target.best();
    const redesign::ContactRegion& region = findings.regions[static_cast<std::size_t>(one.region)];
    const redesign::RegionPatch& patch = region.patches[static_cast<std::size_t>(one.number - 1)];
    records::NamedSurface surface{
        .name = fmt::format("{}: {}", name_of(findings, one), title_of(fit.surface)),
        .colour = cad_colour(region.part),
        .surface = fit.surface,
        .points = one.target_points,
        .outline = {}};
    if (one.piece == 0 && patch.outline.size() == 1) {
      surface.outline = patch.outline.front().points;
    }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

std::string region_json(const RegionFindings& findings, const product::Product& product) {
  Json json = {{"hands", findings.count.hands},
               {"threshold_mpa", findings.count.threshold},
               {"regions", Json::array()}};
  for (std::size_t r = 0; r < findings.regions.size(); ++r) {
    const redesign::ContactRegion& region = findings.regions[r];
    Json patches = Json::array();
    for (std::size_t k = 0; k < region.patches.size(); ++k) {
      const redesign::RegionPatch& patch = region.patches[k];
      Json lengths = Json::array();
      for (const redesign::RegionOutline& outline : patch.outline)
        lengths.push_back(outline.length);
      Json one = {{"patch", k + 1},
                  {"area_mm2", patch.area},
                  {"centre_mm", region_vector(patch.centre)},
                  {"outline_lengths_mm", std::move(lengths)}};
      Json surfaces = Json::array();
      for (const FittedPatch& fitted : findings.patches) {
        if (fitted.region != static_cast<int>(r) || fitted.number != static_cast<int>(k) + 1) {
          continue;
        }
        surfaces.push_back({{"name", name_of(findings, fitted)},
                            {"points", fitted.target_points.size()},
                            {"mean_imprint_mm", fitted.mean_depth},
                            {"surface", choice_json(fitted.product)},
                            {"pressed_surface", choice_json(fitted.target)}});
      }
      one["surfaces"] = std::move(surfaces);
      patches.push_back(std::move(one));
    }
    Json entry = {{"title", region.title},
                  {"part", region.part ? name_of(*region.part) : "hand"},
                  {"least_hands", region.least_hands},
                  {"area_mm2", region.area},
                  {"dropped_specks", region.dropped_specks},
                  {"dropped_holes", region.dropped_holes},
                  {"dropped_area_mm2", region.dropped_area},
                  {"patches", std::move(patches)}};
    if (has_faces(findings, product)) {
      Json faces = Json::array();
      for (const redesign::FaceShare& share : shares_of(findings, region, product)) {
        const product::ProductFace& face =
            product.faces->face[static_cast<std::size_t>(share.face)];
        faces.push_back({{"face", face.number},
                         {"title", title_of(face)},
                         {"area_mm2", share.area},
                         {"share", share.share},
                         {"most_hands_share", share.peak_hands}});
      }
      entry["faces"] = std::move(faces);
    }
    json["regions"].push_back(std::move(entry));
  }
  if (findings.plan) json["redesign"] = relief_json(*findings.plan);
  if (findings.sheet) {
    json["unrolled"] = {{"width_mm", findings.sheet->width},
                        {"length_mm", findings.sheet->high - findings.sheet->low},
                        {"axis", region_vector(findings.sheet->axis)},
                        {"cut_mm", region_vector(findings.sheet->cut)},
                        {"section_change_mm", findings.sheet->section_change}};
  }
  return json.dump();
}

std::string region_csv(const RegionFindings& findings, const product::Product& product) {
  if (!has_faces(findings, product)) return "";
  std::string csv = "region,face,title,area_mm2,share_of_face,most_hands_share\n";
  for (const redesign::ContactRegion& region : findings.regions) {
    for (const redesign::FaceShare& share : shares_of(findings, region, product)) {
      const product::ProductFace& face = product.faces->face[static_cast<std::size_t>(share.face)];
      std::string title = title_of(face);
      for (std::size_t q = title.find('"'); q != std::string::npos; q = title.find('"', q + 2)) {
        title.insert(q, 1, '"');
      }
      csv += fmt::format("{},{},\"{}\",{:.3f},{:.5f},{:.4f}\n",
                         region.part ? name_of(*region.part) : "hand", face.number, title,
                         share.area, share.share, share.peak_hands);
    }
  }
  return csv;
}

formats::Drawing region_drawing(const redesign::UnrolledOutline& sheet,
                                const std::vector<redesign::ContactRegion>& regions,
                                const std::string& product) {
  formats::Drawing drawing;
  const double height = sheet.high - sheet.low;
  drawing.title =
      fmt::format("{}: contact region unrolled, {:.2f} x {:.2f} mm", product, sheet.width, height);
  drawing.layers = {{"sheet", {90, 96, 104}, 7, 0.25, false},
                    {"centre", {90, 96, 104}, 8, 0.15, true},
                    {"edges", {150, 156, 164}, 8, 0.13, false},
                    {"text", {40, 46, 54}, 7, 0.2, false}};
  const auto add = [&](int layer, std::vector<Eigen::Vector2d> points, bool is_closed) {
    for (Eigen::Vector2d& p : points) p.y() -= sheet.low;
    drawing.lines.push_back({layer, std::move(points), is_closed});
  };
  add(0, {{0.0, sheet.low}, {sheet.width, sheet.low}, {sheet.width, sheet.high}, {0.0, sheet.high}},
      true);
  add(1, {{0.5 * sheet.width, sheet.low - 4.0}, {0.5 * sheet.width, sheet.high + 4.0}}, false);
  for (const double x : sheet.edges) add(2, {{x, sheet.low}, {x, sheet.high}}, false);
  for (const redesign::ContactRegion& region : regions) {
    const report::Rgb c = report::colour_of(region.part);
    const int dxf = region.part == redesign::HandPart::kPalm      ? 5
                    : region.part == redesign::HandPart::kThumb   ? 30
                    : region.part == redesign::HandPart::kFingers ? 1
                                                                  : 6;
    drawing.layers.push_back({"outline " + (region.part ? name_of(*region.part) : "hand"),
                              {c.r, c.g, c.b},
                              dxf,
                              0.35,
                              false});
    const int layer = static_cast<int>(drawing.layers.size()) - 1;
    for (const redesign::UnrolledLine& line : sheet.lines) {
      if (line.name == region.title) add(layer, line.points, line.is_closed);
    }
  }
  drawing.texts.push_back({3, {0.0, height + 8.0}, 3.0, drawing.title});
  std::string legend = "mm, true scale; axis upwards, seen from outside";
  for (const redesign::ContactRegion& region : regions) legend += "; " + region.title;
  drawing.texts.push_back({3, {0.0, -8.0}, 2.2, legend});
  return drawing;
}

}  // namespace palmar::workflow
