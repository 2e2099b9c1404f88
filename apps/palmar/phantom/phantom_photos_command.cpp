// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_photos_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "hand/side_argument.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/formats/image/exif.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/phantom/person/block.h"
#include "palmar/phantom/photo/painted_hand.h"
#include "palmar/phantom/photo/photographs.h"
#include "palmar/records/capture/painted_hand_file.h"
#include "palmar/records/capture/photo_worker.h"
#include "palmar/records/json_values.h"
#include "palmar/report/picture/image.h"
#include "phantom/phantom_output.h"
#include "product/colour_argument.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct PhantomPhotosArguments {
  std::string base = "template", out, side = "right", posture = "reference";
  std::string skin = "#cc9980";
  PhotographsOptions photographs;
  BoardPattern board;
  int calibration = 12;
  int jpeg = 0;       ///< quality; 0: PNG
  std::string block;  ///< edges; empty: the hand
  bool no_hand = false;
};

/// Fingers up, the forearm through the board, the wrist joint (origin of the hand frame) above it.
Rigid3 board_from_hand_frame(const ColouredMesh& hand) {
  constexpr double kWrist = 25.0, kBelow = 5.0;  // mm
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& vertex : hand.mesh.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return {Quat(turn), Vec3(-0.5 * (low.x() + high.x()), 0.5 * (low.z() + high.z()),
                           std::min(kWrist, -low.y() - kBelow))};
}

/// The block that stands in the hand's place, turned a little; nothing if it is a hand.
ColouredMesh block_of(const PhantomPhotosArguments& arguments) {
  if (arguments.block.empty()) return {};
  const Vec3 edges = parse_vector("--block-mm", arguments.block);
  ColouredMesh block = make_block(edges);
  constexpr double kTurn = 25.0 * std::numbers::pi / 180.0;
  const Rigid3 place(Quat(Eigen::AngleAxisd(kTurn, Vec3::UnitZ())),
                     Vec3(0.0, 0.0, 0.5 * edges.z()));
  for (Vec3& vertex : block.mesh.vertices) vertex = place * vertex;
  return block;
}

Image picture_of(const RgbImage& photograph) {
  Image image(photograph.width, photograph.height);
  for (std::size_t p = 0; p < image.pixels.size(); ++p) {
    image.pixels[p] = {photograph.rgb[3 * p], photograph.rgb[3 * p + 1], photograph.rgb[3 * p + 2]};
  }
  return image;
}

/// The file of a photograph; a JPEG says of itself what cameras do: the lens' focal length as it is
/// sold, rounded, on a sensor of 1.4 micrometres a pixel.
std::string encoded(const RgbImage& photograph, const PhotoShot& shot,
                    const PhantomPhotosArguments& arguments) {
  if (arguments.jpeg == 0) return encode_png(picture_of(photograph));
  constexpr double kPixelsPerMm = 1.0 / 0.0014;
  const double focal = arguments.photographs.focal * photograph.height;
  PhotoExif exif;
  exif.camera = fmt::format("Phantom c{}", shot.camera);
  exif.focal_mm = std::round(100.0 * focal / kPixelsPerMm) / 100.0;
  exif.focal_35mm =
      std::round(focal * std::hypot(36.0, 24.0) / std::hypot(photograph.width, photograph.height));
  exif.pixels_per_mm = kPixelsPerMm;
  exif.width = photograph.width;
  exif.height = photograph.height;
  return format_jpeg(photograph, arguments.jpeg, format_exif(exif));
}

Json json_of(const Rigid3& rigid) {
  const Quat& q = rigid.rotation;
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", vector3(rigid.translation)}};
}

Json json_of(const PhotoShot& shot, const std::string& file) {
  const PhotoLens& lens = shot.pose.lens;
  return {{"file", file},
          {"camera", fmt::format("c{}", shot.camera)},
          {"position", shot.position},
          {"gain", shot.gain},
          {"camera_from_board", json_of(shot.pose.camera_from_world)},
          {"width_px", lens.width},
          {"height_px", lens.height},
          {"focal_x_px", lens.focal_x},
          {"focal_y_px", lens.focal_y},
          {"centre_x_px", lens.centre_x},
          {"centre_y_px", lens.centre_y},
          {"k1", lens.k1},
          {"k2", lens.k2}};
}

ScanPosture posture_named(const std::string& name) {
  for (int p = 0; p < kScanPostureCount; ++p) {
    if (name_of(static_cast<ScanPosture>(p)) == name) return static_cast<ScanPosture>(p);
  }
  throw UsageError("--posture: \"" + name + "\" is no posture of palmar phantom mri");
}

int run_photos(PhantomPhotosArguments arguments, const Context& context) {
  arguments.photographs.seed = context.common.seed;
  arguments.photographs.check();
  arguments.board.check();
  const Side side = parse_side(arguments.side);
  if (arguments.calibration < 0 || arguments.calibration > 200) {
    throw UsageError(fmt::format("--calibration {}; 0 to 200 is allowed", arguments.calibration));
  }
  if (arguments.jpeg < 0 || arguments.jpeg > 100) {
    throw UsageError(fmt::format("--jpeg {}; 0 (PNG) to 100 is allowed", arguments.jpeg));
  }
  const ScanPosture posture = posture_named(arguments.posture);
  const Progress progress = make_progress(context.common);
  progress.update(0.0, "painting what is photographed");
  const ColouredMesh block = block_of(arguments);
  std::optional<PaintedHand> hand;
  ColouredMesh surface = block;
  Rigid3 board_from_hand;
  if (block.mesh.triangles.empty()) {
    PaintedHandOptions person;
    person.seed = context.common.seed;
    person.side = side;
    person.paint.skin = parse_colour("--skin-colour", arguments.skin);
    person.paint.texture = 0.0;  // the photographs add it, finer than the mesh could hold it
    hand = make_painted_hand(*load_hand(arguments.base), {posture}, person);
    surface = surface_of(*hand, posture);
    board_from_hand = board_from_hand_frame(surface);
    for (Vec3& vertex : surface.mesh.vertices) vertex = board_from_hand * vertex;
  }

  constexpr int kPixelsPerSquare = 180;
  const BoardPicture picture = draw_board(arguments.board, kPixelsPerSquare);
  PrintedBoard board{picture.pixels, picture.grey, arguments.board.edge(),
                     arguments.board.edge() + 24.0};
  const PhotographsOptions& options = arguments.photographs;
  const PhotographsStage stage(arguments.no_hand ? ColouredMesh{} : surface, board, options);
  const PhotographsStage empty({}, board, options);
  const PhotoShoot shoot = plan_photographs(options);
  const std::vector<PhotoShot> tilted = plan_calibration(options, arguments.calibration);
  const std::size_t count = shoot.shots.size() + tilted.size();

  const fs::path out(arguments.out);
  for (const char* const folder : {"photos", "calibration"}) {
    std::error_code ignored;
    fs::remove_all(out / folder, ignored);
  }
  const char* const ending = arguments.jpeg == 0 ? ".png" : ".jpg";
  Json cameras = Json::array();
  int number = 0;
  const auto take = [&](const PhotographsStage& from, const PhotoShot& shot, const Rigid3& moved,
                        const std::string& file) {
    progress.update(0.05 + 0.9 * number / static_cast<double>(count), "photographing");
    write_file(out / file, encoded(from.take(shot, moved, number++), shot, arguments));
    cameras.push_back(json_of(shot, file));
  };
  create_folder(out);
  create_folder(out / "photos");
  create_folder(out / "truth");
  for (const PhotoShot& shot : shoot.shots) {
    take(stage, shot, shoot.board_from_hand[static_cast<std::size_t>(shot.position)],
         fmt::format("photos/p{:02d}_c{}{}", shot.position, shot.camera, ending));
  }
  if (!tilted.empty()) create_folder(out / "calibration");
  for (const PhotoShot& shot : tilted) {
    take(empty, shot, {},
         fmt::format("calibration/p{:02d}_c{}{}", shot.position, shot.camera, ending));
  }
  progress.update(0.97, "writing the truth");
  const Json board_json = {{"squares", arguments.board.squares},
                           {"square_mm", arguments.board.square},
                           {"marker_mm", arguments.board.marker}};
  if (hand) {
    write_painted_hand((out / "truth").string(), *hand, context.common.seed,
                       {{posture, {"photos", board_from_hand}}});
  } else {
    write_mesh(out / "truth" / "block.ply", surface.mesh);
  }
  Json motions = Json::array();
  for (const Rigid3& motion : shoot.board_from_hand) motions.push_back(json_of(motion));
  const Json truth = {{"board", board_json}, {"motions", motions}, {"photographs", cameras}};
  write_file(out / "truth" / "cameras.json", truth.dump(1) + "\n");
  finish_progress();
  if (context.common.json) {
    print(Json{{"photographs", shoot.shots.size()},
               {"calibration", tilted.size()},
               {"folder", (out / "photos").string()},
               {"truth", (out / "truth").string()}}
              .dump(2) +
          "\n");
  } else {
    print(fmt::format("{} photographs: {}\n{} of the board for the lenses: {}\ntruth: {}\n",
                      shoot.shots.size(), (out / "photos").string(), tilted.size(),
                      (out / "calibration").string(), (out / "truth").string()));
  }
  return 0;
}

}  // namespace

void add_phantom_photos_command(CLI::App& phantom, Context& context) {
  const auto o = std::make_shared<PhantomPhotosArguments>();
  CLI::App* verb =
      add_verb(phantom, "photos",
               "Photographs of a synthetic person's painted hand on a board, taken by a "
               "rig of cameras, with the truth beside them; --seed chooses the person",
               "palmar phantom photos --seed 3 --out subject3");
  PhotographsOptions& p = o->photographs;
  verb->add_option("--out", o->out, "Folder; photos/, calibration/ and truth/ go into it")
      ->required();
  verb->add_option("--posture", o->posture, "Which, by its name in palmar phantom mri")
      ->capture_default_str();
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--cameras", p.cameras, "Cameras, at two heights by turns")
      ->capture_default_str();
  verb->add_option("--positions", p.positions, "Positions of the rig")->capture_default_str();
  verb->add_option("--step-deg", p.step, "From position to position")->capture_default_str();
  verb->add_option("--width-px", p.width, "Of a photograph")->capture_default_str();
  verb->add_option("--height-px", p.height, "Of a photograph")->capture_default_str();
  verb->add_option("--calibration", o->calibration, "Photographs of the tilted board per camera")
      ->capture_default_str();
  verb->add_option("--jpeg", o->jpeg,
                   "JPEG of this quality (1 to 100) with what cameras say of themselves; 0: PNG")
      ->capture_default_str();
  verb->add_option("--skin-colour", o->skin, "#rrggbb")->capture_default_str();
  verb->add_option("--texture", p.texture, "Unevenness of the skin's colour, as a share")
      ->capture_default_str();
  verb->add_option("--noise", p.noise, "Deviation of the sensor's noise, of 255")
      ->capture_default_str();
  verb->add_option("--blur-px", p.blur, "Of lens and sensor")->capture_default_str();
  verb->add_option("--exposure", p.exposure, "Deviation of the exposures, as a share")
      ->capture_default_str();
  verb->add_option("--aperture-mm", p.aperture, "Of the lenses: blurs what isn't in focus")
      ->capture_default_str();
  verb->add_option("--focus-mm", p.focus, "Focus behind the hand's middle; negative: in front")
      ->capture_default_str();
  verb->add_option("--gloss", p.gloss, "Oily skin: share of the light that it mirrors")
      ->capture_default_str();
  verb->add_option("--motion-mm", p.motion, "Shift of the hand between positions, RMS")
      ->capture_default_str();
  verb->add_option("--motion-deg", p.motion_turn, "And turn, RMS")->capture_default_str();
  verb->add_flag("--light-on-rig", p.light_on_rig, "The lamps go round with the cameras");
  verb->add_flag("--clutter", p.clutter, "Warm things behind the hand, no cloth");
  verb->add_flag("--one-ring", p.one_ring, "All cameras at the lower height");
  verb->add_option("--block-mm", o->block,
                   "A cardboard box of these edges instead of the hand: width,depth,height");
  verb->add_flag("--no-hand", o->no_hand, "The board alone");
  verb->add_option("--base", o->base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_photos(*o, context); }; });
}

}  // namespace palmar::cli
