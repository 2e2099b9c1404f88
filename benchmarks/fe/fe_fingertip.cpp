// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Palmar's contact against CalculiX: first the finite elements against closed forms, then one
// fingertip on a plate with the same tissue. Prints tables; writes fe_fingertip.csv, profile.csv
// and fe_fingertip.svg. Needs the programs ccx and tetgen (Debian: calculix-ccx, tetgen); without
// them it says which is missing and ends with code 6.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <span>

#include "axisymmetric_deck.h"
#include "palmar/contact/hand/hand_contact.h"
#include "palmar/contact/press/half_space_press.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/hand/tissue_block.h"
#include "palmar/records/fe/ccx_results.h"
#include "palmar/records/fe/inp_file.h"
#include "palmar/records/fe/tetgen.h"
#include "palmar/records/hand/hand_asset.h"
#include "palmar/report/chart/line_chart.h"

namespace {

using namespace palmar;
using Clock = std::chrono::steady_clock;

constexpr std::array<report::Rgb, 3> kColours = {{{40, 40, 40}, {70, 110, 150}, {190, 90, 50}}};

struct Arguments {
  std::string asset, out = "fe_fingertip";
  double edge = 2.0;         // mm, of the hand's skin
  double largest_tet = 2.0;  // mm^3
  double tilt_deg = 30.0;
  double poisson = 0.495;
  bool is_large_strain = false;
  bool skips_closed_forms = false;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::filesystem::path require_program(const std::string& name, const std::string& package) {
  if (const auto found = formats::find_program(name)) return *found;
  throw formats::ProgramMissing("fe_fingertip: the program " + name +
                                " is not installed (Debian: apt-get " + "install " + package + ")");
}

std::vector<records::CcxStep> solve(const std::filesystem::path& ccx,
                                    const std::filesystem::path& folder, const std::string& job) {
  const int code = formats::run_program(ccx, {"-i", job}, folder, job + ".log");
  if (code != 0) {
    throw NumericalError(
        fmt::format("ccx ended with code {}; see {}", code, (folder / (job + ".log")).string()));
  }
  return records::read_ccx((folder / job).string());
}

/// Bonded incompressible layer under a sphere: force over Hertz' against the tabulated solution of
/// the layer's integral equation, at sqrt(R depth) / h = 0.5 and 1.
void against_closed_forms(const std::filesystem::path& ccx, const std::filesystem::path& folder) {
  constexpr double kTable[] = {2.156, 5.115};
  fe::SpherePress press;
  // So shallow that the skin's sideways motion under the sphere doesn't matter.
  press.radius = 2000.0;
  press.layer = 5.0;
  press.width = 40.0;
  press.fine_edge = 0.3;
  press.fine_radius = 9.0;
  press.depths = {0.003125, 0.0125};
  formats::write_file(folder / "layer.inp", fe::axisymmetric_deck(press));
  const std::vector<records::CcxStep> steps = solve(ccx, folder, "layer");
  std::cout << "bonded layer, sphere: force over Hertz\n";
  for (std::size_t k = 0; k < std::min<std::size_t>(2, steps.size()); ++k) {
    const double hertz =
        16.0 / 3.0 * press.shear_modulus * std::sqrt(press.radius) * std::pow(press.depths[k], 1.5);
    const double ours = -fe::kSectors * steps[k].force.y() / hertz;
    std::cout << fmt::format("  CalculiX {:.3f}, table {:.3f}, {:+.1f} %\n", ours, kTable[k],
                             100.0 * (ours / kTable[k] - 1.0));
  }
}

/// Pressure at points of the plate, for one depth.
struct Pressures {
  std::vector<Vec3> point;       // in the plate's frame, mm
  std::vector<double> pressure;  // MPa
};

struct Curve {
  std::string name;
  std::vector<double> force, area;
  std::vector<Pressures> field;  // per depth
  double prepare_seconds = 0.0, solve_seconds = 0.0;
};

/// Solid above z = 0.
class Plate : public geometry::DistanceField {
 public:
  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3& q = points[i];
      samples[i] = {-q.z(), {q.x(), q.y(), 0.0}, -Vec3::UnitZ(), -1};
      if (std::abs(q.z()) > range)
        samples[i] = {std::copysign(range, -q.z()), q, -Vec3::UnitZ(), -1};
    }
  }
  Box3 bounding_box() const override { return {Vec3(-1e4, -1e4, 0.0), Vec3(1e4, 1e4, 1e4)}; }
};

/// What press() finds, vertex by vertex.
Pressures field_of(const contact::PreparedHand& prepared, const contact::PressOptions& options,
                   double depth) {
  geometry::Rigid3 hand_from_plate = contact::indenter_at_first_touch(options, prepared);
  hand_from_plate.translation -= depth * (hand_from_plate.rotation * Vec3::UnitZ());
  contact::ContactOptions contact_options;
  contact_options.swelling = false;
  contact_options.shear_modulus = options.shear_modulus;
  const contact::ContactResult result = contact::solve_region_contact(
      prepared, prepared.hand().skin.vertices, hand_from_plate.inverse(), Plate(), contact_options,
      options.specimen.region);
  Pressures field;
  for (std::size_t v = 0; v < result.pressure.size(); ++v) {
    if (prepared.hand().region[v] != options.specimen.region) continue;
    field.point.push_back(result.undeformed[v]);
    field.pressure.push_back(result.pressure[v]);
  }
  return field;
}

/// Mean pressure in rings of 1 mm round the centre of pressure, MPa against mm.
std::vector<Eigen::Vector2d> profile_of(const Pressures& field) {
  constexpr double kRing = 1.0;  // mm
  Vec3 centre = Vec3::Zero();
  double sum = 0.0;
  for (std::size_t i = 0; i < field.point.size(); ++i) {
    centre += field.pressure[i] * field.point[i];
    sum += field.pressure[i];
  }
  if (!(sum > 0.0)) return {};
  centre /= sum;
  std::vector<double> total(10, 0.0);
  std::vector<int> count(10, 0);
  for (std::size_t i = 0; i < field.point.size(); ++i) {
    const auto ring = static_cast<std::size_t>((field.point[i] - centre).head<2>().norm() / kRing);
    if (ring >= total.size()) continue;
    total[ring] += field.pressure[i];
    ++count[ring];
  }
  std::vector<Eigen::Vector2d> profile;
  for (std::size_t k = 0; k < total.size(); ++k) {
    if (count[k] > 0) profile.emplace_back((k + 0.5) * kRing, 1e3 * total[k] / count[k]);
  }
  return profile;
}

Curve press_with(contact::TissueModel tissue, const std::shared_ptr<const hand::Hand>& hand,
                 const contact::PressOptions& options) {
  Curve curve;
  curve.name = "Palmar " + std::string(name_of(tissue));
  const auto start = Clock::now();
  const contact::PreparedHand prepared(hand, contact::ContactModel{.tissue = tissue});
  curve.prepare_seconds = seconds_since(start);
  const auto begin = Clock::now();
  for (const contact::PressStep& step : contact::press(options, &prepared)) {
    curve.force.push_back(step.force);
    curve.area.push_back(step.area);
  }
  curve.solve_seconds = seconds_since(begin);
  for (const double depth : options.depths) {
    curve.field.push_back(field_of(prepared, options, depth));
  }
  return curve;
}

report::LineChart chart_of(const std::vector<Curve>& curves, const std::vector<double>& depths,
                           const std::string& title, bool is_area) {
  report::LineChart chart{.title = title,
                          .x_label = "Depth, mm",
                          .y_label = is_area ? "Area, mm2" : "Force, N",
                          .series = {}};
  for (std::size_t c = 0; c < curves.size(); ++c) {
    report::LineSeries& series = chart.series.emplace_back();
    series.name = curves[c].name;
    series.colour = kColours[c % kColours.size()];
    series.points.emplace_back(0.0, 0.0);
    for (std::size_t k = 0; k < depths.size(); ++k) {
      series.points.emplace_back(depths[k], is_area ? curves[c].area[k] : curves[c].force[k]);
    }
  }
  return chart;
}

report::LineChart profile_chart(const std::vector<Curve>& curves, std::size_t k, double depth) {
  report::LineChart chart{.title = fmt::format("Pressure at {} mm depth, mean of rings", depth),
                          .x_label = "Distance from the centre of pressure, mm",
                          .y_label = "Pressure, kPa",
                          .series = {}};
  for (std::size_t c = 0; c < curves.size(); ++c) {
    chart.series.push_back(
        {curves[c].name, profile_of(curves[c].field[k]), kColours[c % kColours.size()]});
  }
  return chart;
}

/// Corners and middles of a side of a tetrahedron.
std::array<int, 6> nodes_of(const records::TetMesh& mesh, const records::TetSide& side) {
  constexpr std::array<std::array<int, 6>, 4> kNodes = {
      {{0, 1, 2, 4, 5, 6}, {0, 3, 1, 7, 8, 4}, {1, 3, 2, 8, 9, 5}, {2, 3, 0, 9, 7, 6}}};
  std::array<int, 6> nodes{};
  const auto& tet = mesh.tets[static_cast<std::size_t>(side.tet)];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    nodes[k] = tet[static_cast<std::size_t>(kNodes[static_cast<std::size_t>(side.side - 1)][k])];
  }
  return nodes;
}

int run(const Arguments& arguments) {
  const std::filesystem::path ccx = require_program("ccx", "calculix-ccx");
  require_program("tetgen", "tetgen");
  const std::filesystem::path folder(arguments.out);
  formats::create_folder(folder);
  set_thread_count(1);
  if (!arguments.skips_closed_forms) against_closed_forms(ccx, folder);

  const auto hand = std::make_shared<const hand::Hand>(hand::build_template(
      records::read_hand_asset(arguments.asset), {.edge_length = arguments.edge}));
  contact::PressOptions options;
  options.specimen.kind = contact::PressSpecimen::Kind::kHandRegion;
  options.indenter.kind = contact::PressIndenter::Kind::kPlane;
  options.tilt = arguments.tilt_deg * std::numbers::pi / 180.0;
  options.depths = {0.5, 1.0, 1.5, 2.0};
  options.shear_modulus = 0.01;
  std::vector<Curve> curves(1);
  curves.push_back(press_with(contact::TissueModel::kHalfSpace, hand, options));
  curves.push_back(press_with(contact::TissueModel::kLayered, hand, options));
  curves.push_back(press_with(contact::TissueModel::kBone, hand, options));

  records::PressDeck deck;
  deck.title = fmt::format("middle_distal on a plate at {} deg", arguments.tilt_deg);
  const geometry::Rigid3 frame =
      contact::indenter_at_first_touch(options, contact::PreparedHand(hand));
  deck.indenter = records::indenter_surface(options.indenter, frame);
  deck.direction = -(frame.rotation * Vec3::UnitZ());
  deck.depths = options.depths;
  deck.shear_modulus = *options.shear_modulus;
  deck.poisson = arguments.poisson;
  deck.material =
      arguments.is_large_strain ? records::DeckMaterial::kNeoHooke : records::DeckMaterial::kLinear;
  Curve& elements = curves.front();
  elements.name = arguments.is_large_strain ? "CalculiX, large strain" : "CalculiX";
  auto start = Clock::now();
  deck.block = records::mesh_by_tetgen(
      hand::make_tissue_block(
          *hand, {.region = hand::Region::kMiddleDistal, .cut_offset = {}, .cut_normal = {}}),
      folder, arguments.largest_tet);
  formats::write_file(folder / "fingertip.inp", records::inp_deck(deck));
  elements.prepare_seconds = seconds_since(start);
  start = Clock::now();
  const std::vector<records::CcxStep> steps = solve(ccx, folder, "fingertip");
  elements.solve_seconds = seconds_since(start);
  if (steps.size() != options.depths.size()) {
    throw NumericalError(fmt::format("ccx solved {} of {} steps; see {}", steps.size(),
                                     options.depths.size(), folder.string()));
  }
  const geometry::Rigid3 indenter_from_hand = frame.inverse();
  std::set<int> skin_nodes;
  for (const records::TetSide& side : deck.block.pressed) {
    for (const int n : nodes_of(deck.block.mesh, side)) skin_nodes.insert(n);
  }
  for (const records::CcxStep& step : steps) {
    elements.force.push_back(step.force.dot(deck.direction));
    elements.area.push_back(step.area);
    std::map<int, double> pressure;
    for (std::size_t i = 0; i < step.node.size(); ++i) pressure[step.node[i]] = step.pressure[i];
    Pressures& field = elements.field.emplace_back();
    for (const int n : skin_nodes) {
      const auto found = pressure.find(n);
      field.point.push_back(indenter_from_hand *
                            deck.block.mesh.nodes[static_cast<std::size_t>(n)]);
      field.pressure.push_back(found == pressure.end() ? 0.0 : found->second);
    }
  }
  std::string profile = "model,depth_mm,x_mm,y_mm,pressure_kpa\n";
  for (const Curve& curve : curves) {
    for (std::size_t k = 0; k < options.depths.size(); ++k) {
      const Pressures& field = curve.field[k];
      for (std::size_t i = 0; i < field.point.size(); ++i) {
        if (field.pressure[i] <= 0.0) continue;
        profile += fmt::format("{},{},{:.3f},{:.3f},{:.4f}\n", curve.name, options.depths[k],
                               field.point[i].x(), field.point[i].y(), 1e3 * field.pressure[i]);
      }
    }
  }

  std::cout << fmt::format(
      "middle fingertip on a plate at {} deg, G = 10 kPa; CalculiX: nu = {}, "
      "{} nodes, {} tetrahedra, skin edges {} mm\n",
      arguments.tilt_deg, arguments.poisson, deck.block.mesh.nodes.size(),
      deck.block.mesh.tets.size(), arguments.edge);
  std::string csv = "model,depth_mm,force_n,area_mm2,force_over_calculix\n";
  for (const Curve& curve : curves) {
    for (std::size_t k = 0; k < options.depths.size(); ++k) {
      const double ratio = curve.force[k] / elements.force[k];
      csv += fmt::format("{},{},{:.5f},{:.3f},{:.4f}\n", curve.name, options.depths[k],
                         curve.force[k], curve.area[k], ratio);
      std::cout << fmt::format("  {:18} {:4.1f} mm {:8.4f} N {:7.2f} mm2  force/CalculiX {:.3f}\n",
                               curve.name, options.depths[k], curve.force[k], curve.area[k], ratio);
    }
  }
  for (const Curve& curve : curves) {
    std::cout << fmt::format("  {:18} prepared in {:.2f} s, solved in {:.4f} s", curve.name,
                             curve.prepare_seconds, curve.solve_seconds);
    if (&curve != &elements) {
      std::cout << fmt::format(": CalculiX takes {:.0f} times as long, {:.0f} with preparation",
                               elements.solve_seconds / curve.solve_seconds,
                               (elements.prepare_seconds + elements.solve_seconds) /
                                   (curve.prepare_seconds + curve.solve_seconds));
    }
    std::cout << '\n';
  }
  formats::write_file(folder / "fe_fingertip.csv", csv);
  formats::write_file(folder / "profile.csv", profile);
  std::vector<report::LineChart> charts = {
      chart_of(curves, options.depths, "Fingertip on a plate: force", false),
      chart_of(curves, options.depths, "Fingertip on a plate: area", true)};
  for (const std::size_t k : {std::size_t{1}, std::size_t{3}}) {
    charts.push_back(profile_chart(curves, k, options.depths[k]));
  }
  formats::write_file(folder / "fe_fingertip.svg", report::svg_stack(charts));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Palmar's contact against finite elements (CalculiX)");
  app.add_option("ASSET", arguments.asset, "The template's asset, right.glb")->required();
  app.add_option("--out", arguments.out, "Folder to write")->capture_default_str();
  app.add_option("--edge-mm", arguments.edge, "Mean edge of the skin, mm")->capture_default_str();
  app.add_option("--largest-tet-mm3", arguments.largest_tet, "Largest tetrahedron, mm3")
      ->capture_default_str();
  app.add_option("--tilt-deg", arguments.tilt_deg, "Tilt of the plate, deg")->capture_default_str();
  app.add_option("--poisson", arguments.poisson, "Of the elements; Palmar takes its tissue's")
      ->capture_default_str();
  app.add_flag("--large-strain", arguments.is_large_strain, "Neo-Hookean instead of linear");
  app.add_flag("--skip-closed-forms", arguments.skips_closed_forms, "Only the fingertip");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(arguments);
  } catch (const Error& error) {
    std::cerr << "fe_fingertip: " << error.what() << '\n';
    return error.exit_code();
  }
}
