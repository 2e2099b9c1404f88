// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_scan_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hand/side_argument.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/coloured_mesh_file.h"
#include "palmar/geometry/mesh/cluster_vertices.h"
#include "palmar/phantom/mri/scan_defects.h"
#include "palmar/phantom/photo/painted_hand.h"
#include "palmar/product/product.h"
#include "palmar/records/capture/painted_hand_file.h"
#include "phantom/phantom_output.h"
#include "product/colour_argument.h"

namespace palmar::cli {
namespace {

struct PhantomScanArguments {
  std::string base = "template", out, side = "right", format = "ply", unit = "mm";
  std::string ring, ring_colour = "#c7c7cc";
  std::string skin = "#cc9980", crease = "green", dot = "blue";
  double ink = SkinPaint{}.coverage;
  ScanDefects defects;
  int texture_side = 4096;
  std::vector<std::string> postures{"reference", "finger_flexion", "finger_abduction"};
  bool no_creases = false, no_dots = false, ideal = false, mirrored = false;
};

PaintedHandOptions painted_options(const PhantomScanArguments& arguments, std::uint64_t seed) {
  PaintedHandOptions options;
  options.seed = seed;
  options.side = parse_side(arguments.side);
  options.paint.skin = parse_colour("--skin-colour", arguments.skin);
  options.paint.crease = parse_colour("--crease-colour", arguments.crease);
  options.paint.dot = parse_colour("--dot-colour", arguments.dot);
  options.paint.coverage = arguments.ink;
  options.paint.has_creases = !arguments.no_creases;
  options.paint.has_dots = !arguments.no_dots;
  if (!arguments.ring.empty()) {
    options.ring = finger_named(arguments.ring);
    if (!options.ring) {
      throw UsageError("--ring: \"" + arguments.ring +
                       "\" is no finger; thumb, index, middle, ring or little is");
    }
    options.paint.ring_colour = parse_colour("--ring-colour", arguments.ring_colour);
  }
  options.check();
  return options;
}

void write_scan(const std::filesystem::path& path, ColouredMesh surface, double millimetres,
                int texture_side) {
  for (Vec3& v : surface.mesh.vertices) v /= millimetres;
  if (path.extension() == ".ply") {
    write_coloured_mesh(path, surface);
    return;
  }
  // Coarser than its colours, as such programs write it.
  const TriangleMesh coarse = cluster_vertices(surface.mesh, 1.6 / millimetres);
  const TexturedSurface textured = textured_surface(coarse, surface, texture_side);
  write_textured_mesh(path, textured.mesh, textured.colours);
}

int run_phantom_scan(PhantomScanArguments arguments, const Context& context) {
  const PaintedHandOptions options = painted_options(arguments, context.common.seed);
  if (arguments.format != "ply" && arguments.format != "obj") {
    throw UsageError("--format: \"" + arguments.format +
                     "\" is neither ply (colours at the vertices) nor obj (a texture)");
  }
  const double millimetres = millimetres_per(length_unit(arguments.unit));
  if (arguments.ideal) {
    arguments.defects = {.noise = 0.0, .roughness = 0.0, .hidden = 0.0, .colour_noise = 0.0};
  }
  arguments.defects.check();
  const Progress progress = make_progress(context.common);
  progress.update(0.0, "making the person");
  const std::vector<ScanPosture> postures = chosen_postures(arguments.postures);
  const PaintedHand hand = make_painted_hand(*load_hand(arguments.base), postures, options);
  const std::filesystem::path out(arguments.out);
  create_folder(out / "scan");
  std::map<ScanPosture, PaintedHandPlace> places;
  nlohmann::ordered_json scans = nlohmann::ordered_json::array();
  std::string text;
  for (const ScanPosture posture : postures) {
    const std::string name(name_of(posture));
    progress.update(
        0.3 + 0.6 * static_cast<double>(places.size()) / static_cast<double>(postures.size()),
        name);
    ScanDefects defects = arguments.defects;
    defects.seed = 16 * context.common.seed + static_cast<std::uint64_t>(posture);
    ScannedSurface scan = scanned_surface(surface_of(hand, posture), 0.0, defects);
    if (arguments.mirrored) {
      for (Vec3& v : scan.surface.mesh.vertices) v.x() = -v.x();
      for (Triangle& t : scan.surface.mesh.triangles) std::swap(t[1], t[2]);
    }
    const std::filesystem::path file = out / "scan" / (name + "." + arguments.format);
    write_scan(file, scan.surface, millimetres, arguments.texture_side);
    places[posture] = {"scan/" + file.filename().string(), scan.scan_from_hand};
    scans.push_back({{"posture", name},
                     {"file", file.string()},
                     {"triangles", scan.surface.mesh.triangle_count()}});
    text += fmt::format("{:<17} {} triangles  {}\n", name, scan.surface.mesh.triangle_count(),
                        file.string());
  }
  const std::string truth = (out / "truth").string();
  write_painted_hand(truth, hand, context.common.seed, places);
  finish_progress();
  print_made_scans(context, hand.name, hand.side, scans, text, truth + "/subject.json");
  return 0;
}

}  // namespace

void add_phantom_scan(CLI::App& phantom, Context& context) {
  const auto o = std::make_shared<PhantomScanArguments>();
  CLI::App* verb =
      add_verb(phantom, "scan",
               "Coloured surface scans of a synthetic person's painted hand in several "
               "postures, with the truth beside them; --seed chooses the person",
               "palmar phantom scan --seed 3 --out subject3");
  verb->add_option("--out", o->out, "Folder; scan/POSTURE and truth/ go into it")->required();
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--format", o->format, "ply: colours at the vertices; obj: a texture")
      ->capture_default_str();
  verb->add_option("--texture-px", o->texture_side, "Side of that texture")->capture_default_str();
  verb->add_option("--unit", o->unit, "Of the files: mm, cm, m or inch")->capture_default_str();
  verb->add_option("--postures", o->postures,
                   "Which, with commas: reference, finger_flexion, finger_abduction (these by "
                   "default), the thumb's limits thumb_flexion, thumb_extension, thumb_abduction, "
                   "thumb_adduction, grasp")
      ->delimiter(',');
  verb->add_option("--skin-colour", o->skin, "#rrggbb")->capture_default_str();
  verb->add_option("--crease-colour", o->crease,
                   "Ink of the lines: green, blue, red, black, purple, orange or #rrggbb")
      ->capture_default_str();
  verb->add_option("--dot-colour", o->dot, "Ink of the dots")->capture_default_str();
  verb->add_option("--ink", o->ink, "Share of the ink's colour where it is drawn")
      ->capture_default_str();
  verb->add_option("--noise-mm", o->defects.noise, "Waviness of the scan")->capture_default_str();
  verb->add_option("--roughness-mm", o->defects.roughness, "Noise of every vertex")
      ->capture_default_str();
  verb->add_option("--hidden", o->defects.hidden,
                   "Share of directions in which skin must see the open to be scanned")
      ->capture_default_str();
  verb->add_option("--forearm-mm", o->defects.forearm, "Forearm that is scanned")
      ->capture_default_str();
  verb->add_option("--ring", o->ring, "Finger that wears one: thumb, index, middle, ring, little");
  verb->add_option("--ring-colour", o->ring_colour, "Of its metal, #rrggbb")->capture_default_str();
  verb->add_flag("--no-creases", o->no_creases, "No lines are drawn");
  verb->add_flag("--no-dots", o->no_dots, "No dots are drawn");
  verb->add_flag("--ideal", o->ideal, "No noise, no holes");
  verb->add_flag("--mirrored", o->mirrored,
                 "Mirror the scans, as a wrong export does; the truth stays");
  verb->add_option("--base", o->base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_phantom_scan(*o, context); }; });
}

}  // namespace palmar::cli
