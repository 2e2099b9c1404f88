// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/product/make_product.h"
#include "palmar/records/product/cad_worker.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/records/product/made_product.h"
#include "palmar/redesign/contact_study.h"
#include "palmar/report/picture/region_picture.h"
#include "redesign/redesign_arguments.h"
#include "redesign/redesign_region_files.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct RegionArguments {
  RedesignArguments redesign;
  RegionOptions region;
  ReliefOptions relief;
  std::string share = "0.5";
  std::string relief_share = "any";
  double threshold = 0.0;        // MPa
  double pressed_share = 0.5;    // of the mean imprint, for fitted surfaces
  double smallest_patch = 40.0;  // mm^2; smaller ones are told but get no surface
  double junction_radius = 0.0;  // mm
  bool no_relief = false;
  bool no_pictures = false;
  bool no_compare = false;
};

/// "any" or a share.
double share_from(const std::string& option, const std::string& text) {
  if (text == "any") return 0.0;
  if (text == "half") return 0.5;
  const std::vector<double> numbers = parse_list(option, text);
  if (numbers.size() == 1 && numbers.front() >= 0.0 && numbers.front() <= 1.0) {
    return numbers.front();
  }
  throw UsageError(option + " is \"" + text + "\"; any, half, or a share of the hands from 0 to 1");
}

/// Along the handle that hands hold: what was asked for; else the bar whose axis is nearest to
/// across their fingers; and where the whole product is such a bar, its own principal axis, which
/// is exact.
Vec3 handle_axis(const RedesignArguments& arguments, const HeldOriginal& original) {
  if (!arguments.axis.empty()) return parse_vector("--axis", arguments.axis).normalized();
  constexpr double kAslant = 0.8, kSame = 0.998;  // cosines of 37 and 3.6 degrees
  Vec3 across = Vec3::Zero();
  for (const StudyRecord& record : original.records) {
    if (is_in_hand(record)) across += record.product_from_hand.rotation * Vec3::UnitX();
  }
  const TriangleMesh& mesh = original.product().mesh;
  const PrincipalFrame frame = principal_frame(mesh);
  if (!(across.norm() > 1e-9)) return frame.axes.col(0);
  Vec3 axis = across.normalized();
  double nearest = kAslant;
  for (const GripSite& site : find_grip_sites(mesh)) {
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
void fit_patch(RegionFindings& findings, const ContactRegion& region, int number,
               const std::vector<Vec3>& normals, double pressed_share) {
  const RegionPatch& patch = region.patches[static_cast<std::size_t>(number - 1)];
  std::vector<Vec3> points, directions, targets;
  for (const int v : patch.vertices) {
    const auto i = static_cast<std::size_t>(v);
    points.push_back(findings.map.mesh.vertices[i]);
    directions.push_back(normals[i]);
    targets.push_back(points.back() - pressed_share * findings.imprint[i] * normals[i]);
  }
  // The product's own edges decide, not how unevenly hands press.
  const auto pieces = split_patch(points, directions);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    FittedPatch fitted;
    fitted.region = &region;
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
    fitted.product = choose_surface(at, out);
    fitted.target = choose_surface(fitted.target_points, out);
    findings.patches.push_back(std::move(fitted));
  }
}

RegionFindings find_regions(const HeldOriginal& original, const RegionArguments& a,
                            const Context& context, const Progress& progress) {
  RegionFindings findings;
  ContactStudy contact = study_contact(original.study.plan, original.study.inputs,
                                       original.source(), {}, 0, a.threshold, progress);
  findings.map = std::move(contact.map);
  findings.count = std::move(contact.count);
  findings.imprint = std::move(contact.imprint);
  findings.axis = handle_axis(a.redesign, original);
  const TriangleMesh& map = findings.map.mesh;
  findings.regions.push_back(contact_region(map, findings.count, {}, a.region));
  for (const HandPart part : {HandPart::kFingers, HandPart::kThumb, HandPart::kPalm}) {
    findings.regions.push_back(contact_region(map, findings.count, part, a.region));
  }
  if (findings.regions.front().patches.empty()) {
    throw UsageError(fmt::format(
        "redesign region: {} touch nowhere above {:g} MPa; a smaller --share or threshold has a "
        "region",
        findings.regions.front().title, a.threshold));
  }
  const std::vector<Vec3> normals = vertex_normals(map);
  for (std::size_t r = 1; r < findings.regions.size(); ++r) {
    const ContactRegion& region = findings.regions[r];
    for (std::size_t k = 0; k < region.patches.size(); ++k) {
      if (region.patches[k].area < a.smallest_patch || region.patches[k].vertices.size() < 8) {
        continue;
      }
      fit_patch(findings, region, static_cast<int>(k) + 1, normals, a.pressed_share);
    }
  }
  try {
    findings.sheet = unroll(original.product().mesh, findings.regions, findings.axis);
  } catch (const UsageError& error) {
    note(context.common, error.what());
  }
  if (!a.no_relief) {
    RegionOptions wide = a.region;
    wide.share = share_from("--relief-share", a.relief_share);
    ReliefOptions options = a.relief;
    options.axis = findings.axis;
    try {
      findings.plan =
          plan_reliefs(map, findings.regions.front(), contact_region(map, findings.count, {}, wide),
                       findings.imprint, options);
      for (const std::string& text : findings.plan->notes) note(context.common, text);
    } catch (const UsageError& error) {
      note(context.common, error.what());
    }
  }
  return findings;
}

bool is_cad_file(const std::string& path) {
  std::string suffix = fs::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix == ".step" || suffix == ".stp" || suffix == ".iges" || suffix == ".igs";
}

/// Runs the CAD program; gives its reply, and the redesign if a solid was cut.
Json run_region_cad(const RegionArguments& a, const RegionFindings& findings,
                    const Product& product, std::optional<RedesignedProduct>& redesign,
                    const Progress& progress) {
  const CadFolder folder;
  const bool made = is_made(a.redesign.product);
  const bool has_solid = made || is_cad_file(a.redesign.product);
  const std::vector<RidgeRelief> reliefs =
      findings.plan && has_solid ? findings.plan->reliefs : std::vector<RidgeRelief>();
  Json request = region_request(curves_of(findings), surfaces_of(findings), reliefs);
  request["junction_radius_mm"] = a.junction_radius;
  if (made) {
    MakeCadOptions options;
    options.mesh = false;
    write_file(folder.path() / "product.step",
               make_cad(made_from(a.redesign.product), options, progress).step);
    request["file"] = (folder.path() / "product.step").string();
  } else if (has_solid) {
    request["file"] = fs::absolute(a.redesign.product).string();
    if (!a.redesign.unit.empty()) {
      request["millimetres_per_unit"] = millimetres_per(length_unit(a.redesign.unit));
    }
  }
  CadLimits limits;
  limits.seconds = 300.0;
  const Json reply =
      Json::parse(run_cad("region", request.dump(), folder, product.name, limits, progress));
  const fs::path out = a.redesign.out;
  write_file(out / "region.step", read_file(folder.path() / "region.step"));
  if (!reliefs.empty()) {
    const std::string step = read_file(folder.path() / "redesign.step");
    write_file(out / "redesign.step", step);
    FaceMesh mesh = read_face_mesh(folder.path() / "mesh.bin");
    write_mesh(out / "redesign.stl", mesh.mesh);
    UnitDecision unit;
    unit.unit = LengthUnit::kMillimetre;
    unit.source = UnitSource::kMade;
    redesign = RedesignedProduct{
        make_product(product.name + ", reliefs", mesh.mesh, unit, "redesign.step", &mesh.faces),
        "reliefs", (out / "redesign.step").string()};
  }
  return reply;
}

std::string findings_text(const RegionFindings& findings, const Product& product) {
  std::string text;
  for (const ContactRegion& region : findings.regions) {
    text +=
        fmt::format("{}{}: {:.0f} mm2 in {} patch{}\n", region.part ? "" : "hand, ", region.title,
                    region.area, region.patches.size(), region.patches.size() == 1 ? "" : "es");
    if (region.part || product.faces == nullptr || findings.map.face_of_triangle.empty()) continue;
    int shown = 0;
    for (const FaceShare& share :
         face_shares(findings.map.mesh, findings.map.face_of_triangle,
                     static_cast<int>(product.faces->face.size()), findings.count, region)) {
      if (++shown > 12) break;
      text += fmt::format("  {}: {:.0f} % of its area, {:.0f} mm2\n",
                          title_of(product.faces->face[static_cast<std::size_t>(share.face)]),
                          100.0 * share.share, share.area);
    }
  }
  for (const FittedPatch& one : findings.patches) {
    text += fmt::format("{}: {} (rms {:.2f} mm); pressed {} (rms {:.2f} mm)\n", one.name(),
                        title_of(one.product.best().surface), one.product.best().rms,
                        title_of(one.target.best().surface), one.target.best().rms);
  }
  if (findings.plan) {
    for (const RidgeRelief& one : findings.plan->reliefs) {
      text += fmt::format(
          "{}: ridge of r {:.1f} mm becomes r {:.1f} mm over {:.0f} mm, {:.2f} mm deep\n", one.name,
          one.radius_before, one.radius, (one.end - one.start).norm(), one.depth);
    }
  }
  return text;
}

int run_region(RegionArguments a, const Context& context) {
  a.region.share = share_from("--share", a.share);
  share_from("--relief-share", a.relief_share);
  a.region.check();
  a.relief.check();
  const Progress progress = make_progress(context.common);
  const HeldOriginal original = grasp_original(a.redesign, context, progress);
  const Product& product = original.product();
  const RegionFindings findings = find_regions(original, a, context, progress);
  const fs::path out = a.redesign.out;
  create_folder(out);
  std::optional<RedesignedProduct> redesign;
  const Json cad = run_region_cad(a, findings, product, redesign, progress);
  if (findings.plan && !redesign) {
    // A mesh has no solid: its own triangles go back instead.
    redesign =
        RedesignedProduct{relieved_product(product, *findings.plan, product.name + ", reliefs"),
                          "reliefs", (out / "redesign.stl").string()};
    write_mesh(out / "redesign.stl", redesign->product.mesh);
    note(context.common,
         product.name +
             " is a mesh: region.step has outlines and surfaces but no solid, and the "
             "redesign is a mesh, too");
  }
  Json json = {{"product", product.name},
               {"source", product.source},
               {"command", context.command_line},
               {"seed", context.common.seed},
               {"population", a.redesign.populations},
               {"posture", a.redesign.posture}};
  json.update(region_json(findings, product));
  json["cad"] = cad;
  write_file(out / "region.json", json.dump(2) + "\n");
  if (const std::string csv = region_csv(findings, product); !csv.empty()) {
    write_file(out / "region.csv", csv);
  }
  const std::vector<ContactRegion> parts(findings.regions.begin() + 1, findings.regions.end());
  if (findings.sheet) {
    const Drawing drawing = region_drawing(*findings.sheet, findings.regions, product.name);
    write_file(out / "outline.dxf", dxf_of(drawing));
    write_file(out / "outline.svg", svg_of(drawing));
  }
  if (!a.no_pictures) {
    write_file(out / "region.png",
               encode_png(region_picture(findings.map.mesh, parts, findings.axis,
                                         product.name + ": contact region", {}, progress)));
  }
  finish_progress();
  if (!context.common.json) print(findings_text(findings, product));
  if (redesign && !a.no_compare) {
    const std::string comparison =
        compare_redesigns(a.redesign, original, {*redesign}, context, progress);
    if (context.common.json) json["comparison"] = Json::parse(comparison);
  }
  if (context.common.json) print(json.dump(2) + "\n");
  return 0;
}

}  // namespace

void add_redesign_region_command(CLI::App& noun, Context& context) {
  const auto a = std::make_shared<RegionArguments>();
  CLI::App* verb = add_verb(
      noun, "region",
      "Export where hands touch for CAD: faces, outlines, simple surfaces; and round the ridges",
      "palmar redesign region handle.step --hands 30 --share half --largest-depth-mm 4 --out "
      "region");
  a->redesign.add_to(*verb);
  verb->add_option("--share", a->share, "Of the hands that must touch: any, half, or 0 to 1")
      ->capture_default_str();
  verb->add_option("--threshold-mpa", a->threshold, "A hand touches where it presses more")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--smoothing-mm", a->region.smoothing, "By which outlines are rounded")
      ->capture_default_str();
  verb->add_option("--smallest-area-mm2", a->region.smallest_area,
                   "Smaller specks and holes are dropped")
      ->capture_default_str();
  verb->add_option("--pressed-share", a->pressed_share,
                   "Of the mean imprint by which the surface is set back before simple surfaces "
                   "are fitted to it")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_flag("--no-relief", a->no_relief, "Only export the region; no redesign");
  verb->add_option("--relief-share", a->relief_share,
                   "Ridges are rounded as far as that share of the hands touch them: any, half, or "
                   "0 to 1")
      ->capture_default_str();
  verb->add_option("--fit-share", a->relief.share,
                   "Of the mean imprint that a rounding is fitted to")
      ->capture_default_str();
  verb->add_option("--largest-depth-mm", a->relief.largest_depth, "By which a ridge may go back")
      ->capture_default_str();
  verb->add_option("--smallest-radius-mm", a->relief.smallest_radius,
                   "Of the cutter: ridges get no smaller one")
      ->capture_default_str();
  verb->add_option("--run-out-mm", a->relief.run_out,
                   "Radius of the arc along which the cutter leaves the product")
      ->capture_default_str();
  verb->add_option("--junction-radius-mm", a->junction_radius,
                   "Rounds the edges in which the cutter leaves; 0: left as they are")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  verb->add_flag("--no-pictures", a->no_pictures, "Leave out the pictures");
  verb->add_flag("--no-compare", a->no_compare, "Only make the shape; hands don't hold it again");
  verb->callback(
      [a, &context] { context.run = [a, &context] { return run_region(*a, context); }; });
}

}  // namespace palmar::cli
