// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/phantom/phantom_photos.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hands/images/exif.h"
#include "hands/person_records/painted_hand_file.h"
#include "hands/person_records/photo_worker.h"
#include "hands/phantom/person/block.h"
#include "hands/phantom/photo/painted_hand.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/records/json_values.h"
#include "palmar/report/picture/image.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Fingers up, the forearm through the board, the wrist joint (origin of the hand frame) above it.
geometry::Rigid3 board_from_hand_frame(const geometry::ColouredMesh& hand) {
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

/// A block that stands in the hand's place, turned a little.
geometry::ColouredMesh block_of(const Vec3& edges) {
  geometry::ColouredMesh block = phantom::make_block(edges);
  constexpr double kTurn = 25.0 * std::numbers::pi / 180.0;
  const geometry::Rigid3 place{Quat(Eigen::AngleAxisd(kTurn, Vec3::UnitZ())),
                               Vec3(0.0, 0.0, 0.5 * edges.z())};
  for (Vec3& vertex : block.mesh.vertices) vertex = place * vertex;
  return block;
}

report::Image png_of(const geometry::RgbImage& photograph) {
  report::Image image(photograph.width, photograph.height);
  for (std::size_t p = 0; p < image.pixels.size(); ++p) {
    image.pixels[p] = {photograph.rgb[3 * p], photograph.rgb[3 * p + 1], photograph.rgb[3 * p + 2]};
  }
  return image;
}

/// The file of a photograph; a JPEG says of itself what cameras do: the lens' focal length as it is
/// sold, rounded, on a sensor of 1.4 micrometres a pixel.
std::string encoded(const geometry::RgbImage& photograph, const phantom::PhotoShot& shot,
                    const PhantomPhotosRequest& request) {
  if (request.jpeg == 0) return report::encode_png(png_of(photograph));
  constexpr double kPixelsPerMm = 1.0 / 0.0014;
  const double focal = request.photographs.focal * photograph.height;
  images::PhotoExif exif;
  exif.camera = fmt::format("Phantom c{}", shot.camera);
  exif.focal_mm = std::round(100.0 * focal / kPixelsPerMm) / 100.0;
  exif.focal_35mm =
      std::round(focal * std::hypot(36.0, 24.0) / std::hypot(photograph.width, photograph.height));
  exif.pixels_per_mm = kPixelsPerMm;
  exif.width = photograph.width;
  exif.height = photograph.height;
  return formats::format_jpeg(photograph, request.jpeg, images::format_exif(exif));
}

Json rigid_json(const geometry::Rigid3& rigid) {
  const Quat& q = rigid.rotation;
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", records::vector3(rigid.translation)}};
}

Json shot_json(const phantom::PhotoShot& shot, const phantom::LensTerms& terms,
               const std::string& file) {
  const capture::PhotoLens& lens = shot.pose.lens;
  Json json = {{"file", file},
               {"camera", fmt::format("c{}", shot.camera)},
               {"position", shot.position},
               {"gain", shot.gain},
               {"camera_from_board", rigid_json(shot.pose.camera_from_world)},
               {"width_px", lens.width},
               {"height_px", lens.height},
               {"focal_x_px", lens.focal_x},
               {"focal_y_px", lens.focal_y},
               {"centre_x_px", lens.centre_x},
               {"centre_y_px", lens.centre_y},
               {"k1", lens.k1},
               {"k2", lens.k2}};
  if (terms.p1 != 0.0 || terms.p2 != 0.0) json.update({{"p1", terms.p1}, {"p2", terms.p2}});
  if (terms.k3 != 0.0) json["k3"] = terms.k3;
  return json;
}

/// What stands on the board, in the board's frame.
struct StandingSubject {
  geometry::ColouredMesh surface;
  std::optional<phantom::PaintedHand> hand;  ///< nothing: a block
  geometry::Rigid3 board_from_hand;
};

StandingSubject make_subject(const PhantomPhotosRequest& request) {
  StandingSubject subject;
  if (request.block) {
    subject.surface = block_of(*request.block);
    return subject;
  }
  phantom::PaintedHandOptions person;
  person.seed = request.photographs.seed;
  if (request.is_free) {
    person.dispersion = phantom::kFreePerson;
    person.paint.is_tinted = true;
  }
  person.restless = request.restless;
  if (request.restless > 0.0) person.takes = request.photographs.positions;
  person.side = request.side;
  person.paint.skin = request.skin;
  person.paint.texture = 0.0;  // the photographs add it, finer than the mesh could hold it
  subject.hand =
      phantom::make_painted_hand(*workflow::load_hand(request.base), {request.posture}, person);
  subject.surface = phantom::surface_of(*subject.hand, request.posture);
  subject.board_from_hand = board_from_hand_frame(subject.surface);
  for (Vec3& vertex : subject.surface.mesh.vertices) vertex = subject.board_from_hand * vertex;
  return subject;
}

/// The hand as it stands there with its skin somewhere else.
geometry::ColouredMesh standing(const phantom::PaintedHand& hand, const std::vector<Vec3>& skin,
                                const StandingSubject& subject) {
  geometry::ColouredMesh surface = phantom::surface_of(hand, skin);
  for (Vec3& vertex : surface.mesh.vertices) vertex = subject.board_from_hand * vertex;
  return surface;
}

void write_truth(const fs::path& folder, const PhantomPhotosRequest& request,
                 const StandingSubject& subject, const phantom::PhotoShoot& shoot,
                 const Json& cameras) {
  const Json board = {{"squares", request.board.squares},
                      {"square_mm", request.board.square},
                      {"marker_mm", request.board.marker}};
  if (subject.hand) {
    person_records::write_painted_hand(folder.string(), *subject.hand, request.photographs.seed,
                                       {{request.posture, {"photos", subject.board_from_hand}}});
  } else {
    formats::write_mesh(folder / "block.ply", subject.surface.mesh);
  }
  Json motions = Json::array();
  for (const geometry::Rigid3& motion : shoot.board_from_hand)
    motions.push_back(rigid_json(motion));
  const Json truth = {{"board", board}, {"motions", motions}, {"photographs", cameras}};
  formats::write_file(folder / "cameras.json", truth.dump(1) + "\n");
}

}  // namespace

void PhantomPhotosRequest::check() const {
  if (out.empty()) throw UsageError("setting \"out\" is empty; a folder to write to is required");
  photographs.check();
  board.check();
  if (calibration < 0 || calibration > 200) {
    throw UsageError(fmt::format("setting \"calibration\" {}; 0 to 200 is allowed", calibration));
  }
  if (jpeg < 0 || jpeg > 100) {
    throw UsageError(fmt::format("setting \"jpeg\" {}; 0 (PNG) to 100 is allowed", jpeg));
  }
}

PhantomPhotosOutcome make_phantom_photos(const PhantomPhotosRequest& request,
                                         const Progress& progress) {
  request.check();
  progress.update(0.0, "painting what is photographed");
  const StandingSubject subject = make_subject(request);
  constexpr int kPixelsPerSquare = 180;
  const capture::BoardPicture picture = person_records::draw_board(request.board, kPixelsPerSquare);
  phantom::PrintedBoard board{picture.pixels, picture.grey, request.board.edge(),
                              request.board.edge() + 24.0};
  const phantom::PhotographsOptions& options = request.photographs;
  const auto stage_of = [&](const geometry::ColouredMesh& hand) {
    return std::make_unique<phantom::PhotographsStage>(
        request.no_hand ? geometry::ColouredMesh{} : hand, board, options);
  };
  std::unique_ptr<phantom::PhotographsStage> stage = stage_of(subject.surface);
  const phantom::PhotographsStage empty({}, board, options);
  const phantom::PhotoShoot shoot = phantom::plan_photographs(options);
  const std::vector<phantom::PhotoShot> tilted =
      phantom::plan_calibration(options, request.calibration);
  const std::size_t count = shoot.shots.size() + tilted.size();

  const fs::path out(request.out);
  for (const char* const folder : {"photos", "calibration"}) {
    std::error_code ignored;
    fs::remove_all(out / folder, ignored);
  }
  const char* const ending = request.jpeg == 0 ? ".png" : ".jpg";
  Json cameras = Json::array();
  int number = 0;
  const auto take = [&](const phantom::PhotographsStage& from, const phantom::PhotoShot& shot,
                        const geometry::Rigid3& moved, const std::string& file) {
    progress.update(0.05 + 0.9 * number / static_cast<double>(count), "photographing");
    formats::write_file(out / file, encoded(from.take(shot, moved, number++), shot, request));
    cameras.push_back(shot_json(shot, phantom::lens_terms(options, shot.camera), file));
  };
  formats::create_folder(out);
  formats::create_folder(out / "photos");
  formats::create_folder(out / "truth");
  std::size_t position = 0;
  for (const phantom::PhotoShot& shot : shoot.shots) {
    if (const auto at = static_cast<std::size_t>(shot.position); at != position) {
      position = at;
      if (subject.hand && at <= subject.hand->takes.size()) {
        stage = stage_of(standing(*subject.hand, subject.hand->takes[at - 1], subject));
      }
    }
    take(*stage, shot, shoot.board_from_hand[static_cast<std::size_t>(shot.position)],
         fmt::format("photos/p{:02d}_c{}{}", shot.position, shot.camera, ending));
  }
  if (!tilted.empty()) formats::create_folder(out / "calibration");
  for (const phantom::PhotoShot& shot : tilted) {
    take(empty, shot, {},
         fmt::format("calibration/p{:02d}_c{}{}", shot.position, shot.camera, ending));
  }
  progress.update(0.97, "writing the truth");
  write_truth(out / "truth", request, subject, shoot, cameras);
  return {shoot.shots.size(), tilted.size(), (out / "photos").string(),
          (out / "calibration").string(), (out / "truth").string()};
}

}  // namespace palmar::person_workflow
