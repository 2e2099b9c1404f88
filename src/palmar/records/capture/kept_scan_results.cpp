// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/capture/kept_scan_results.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/sha256.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/json_values.h"

namespace palmar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void add_points(const std::vector<Vec3>& points, Sha256& digest) {
  std::string bytes;
  bytes.reserve(points.size() * 3 * sizeof(double));
  for (const Vec3& p : points) {
    for (int a = 0; a < 3; ++a) {
      const auto bits = std::bit_cast<std::uint64_t>(p[a]);
      for (int b = 0; b < 64; b += 8) bytes += static_cast<char>((bits >> b) & 0xFF);
    }
  }
  digest.add(fmt::format("{} points:", points.size()));
  digest.add(bytes);
}

void add_mesh(const TriangleMesh& mesh, Sha256& digest) {
  add_points(mesh.vertices, digest);
  std::string text = fmt::format("{} triangles:", mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) text += fmt::format("{},{},{};", t[0], t[1], t[2]);
  digest.add(text);
}

Vec3 vector_in(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json pose_json(const Rigid3& pose) {
  const Quat& q = pose.rotation;
  return {{"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", vector3(pose.translation)}};
}

Rigid3 pose_in(const Json& json) {
  const Json& q = json.at("quaternion_wxyz");
  Rigid3 pose;
  pose.rotation = Quat(q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>(),
                       q.at(3).get<double>());
  pose.translation = vector_in(json.at("translation_mm"));
  return pose;
}

std::optional<double> number_or_null(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return json.get<double>();
}

ScanPosture posture_in(const Json& json) {
  const auto name = json.get<std::string>();
  for (int k = 0; k < kScanPostureCount; ++k) {
    if (name == name_of(static_cast<ScanPosture>(k))) return static_cast<ScanPosture>(k);
  }
  throw InputError("\"" + name + "\" is no posture");
}

/// `read` of the file's JSON if its key fits; nothing of a file that isn't whole.
template <typename Read>
auto kept(const fs::path& path, const std::string& key, const Read& read)
    -> std::optional<decltype(read(Json()))> {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  try {
    const Json json = Json::parse(read_file(path));
    if (json.value("key", "") != key) return std::nullopt;
    return read(json);
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

std::string digest_of(const ScanSurfaces& surfaces) {
  Sha256 digest;
  digest.add(fmt::format("{} hand;", name_of(surfaces.side)));
  add_mesh(surfaces.skin, digest);
  for (const ScannedBone& bone : surfaces.bones) {
    digest.add(fmt::format("bone {}:{} {};", bone.name.size(), bone.name, bone.is_cut));
    add_mesh(bone.mesh, digest);
  }
  add_points(surfaces.markers, digest);
  return digest.hex();
}

namespace {

/// Null for a motion that no image showed. Errors that are infinite are null.
Json image_fit_json(const std::optional<ImageFit>& fit) {
  if (!fit) return nullptr;
  return {{"fixed_from_moving", pose_json(fit->fixed_from_moving)},
          {"correlation", fit->correlation},
          {"overlap", fit->overlap},
          {"turn_error_rad", fit->turn_error},
          {"shift_error_mm", fit->shift_error},
          {"has_converged", fit->has_converged}};
}

std::optional<ImageFit> image_fit_in(const Json& json) {
  if (json.is_null()) return {};
  const auto or_infinite = [&](const char* key) {
    const Json& value = json.at(key);
    return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
  };
  ImageFit fit;
  fit.fixed_from_moving = pose_in(json.at("fixed_from_moving"));
  fit.correlation = json.at("correlation").get<double>();
  fit.overlap = json.at("overlap").get<double>();
  fit.turn_error = or_infinite("turn_error_rad");
  fit.shift_error = or_infinite("shift_error_mm");
  fit.has_converged = json.at("has_converged").get<bool>();
  return fit;
}

}  // namespace

void keep_bone_motions(const std::string& folder, const std::string& key,
                       const std::vector<BoneMotion>& motions) {
  Json list = Json::array();
  for (const BoneMotion& motion : motions) {
    const IcpResult& fit = motion.fit;
    list.push_back({{"bone", motion.bone},
                    {"counterpart", motion.counterpart},
                    {"posture_from_reference", pose_json(motion.posture_from_reference)},
                    {"fit",
                     {{"fixed_from_moving", pose_json(fit.fixed_from_moving)},
                      {"mean_mm", fit.mean},
                      {"trimmed_rms_mm", fit.trimmed_rms},
                      {"overlap", fit.overlap},
                      {"conditioning", fit.conditioning},
                      {"iterations", fit.iterations},
                      {"has_converged", fit.has_converged}}},
                    {"image", image_fit_json(motion.image)},
                    {"is_cut_out", motion.is_cut_out}});
  }
  create_folder(folder);
  write_file(fs::path(folder) / "motions.json",
             Json{{"key", key}, {"motions", std::move(list)}}.dump(1) + "\n");
}

std::optional<std::vector<BoneMotion>> kept_bone_motions(const std::string& folder,
                                                         const std::string& key) {
  return kept(fs::path(folder) / "motions.json", key, [](const Json& json) {
    std::vector<BoneMotion> motions;
    for (const Json& one : json.at("motions")) {
      const Json& fit = one.at("fit");
      BoneMotion motion;
      motion.bone = one.at("bone").get<std::string>();
      motion.counterpart = one.at("counterpart").get<std::string>();
      motion.posture_from_reference = pose_in(one.at("posture_from_reference"));
      motion.fit.fixed_from_moving = pose_in(fit.at("fixed_from_moving"));
      motion.fit.mean = fit.at("mean_mm").get<double>();
      motion.fit.trimmed_rms = fit.at("trimmed_rms_mm").get<double>();
      motion.fit.overlap = fit.at("overlap").get<double>();
      motion.fit.conditioning = fit.at("conditioning").get<double>();
      motion.fit.iterations = fit.at("iterations").get<int>();
      motion.fit.has_converged = fit.at("has_converged").get<bool>();
      motion.image = image_fit_in(one.at("image"));
      motion.is_cut_out = one.at("is_cut_out").get<bool>();
      motions.push_back(std::move(motion));
    }
    return motions;
  });
}

void keep_scanned_hand(const std::string& folder, const std::string& key,
                       const ScannedHand& scanned) {
  Json errors = Json::array();
  for (const SkinError& error : scanned.skin_errors) {
    errors.push_back({{"posture", std::string(name_of(error.posture))},
                      {"skinning_only_mm", error.skinning_only},
                      {"corrected_mm", or_null(error.corrected)},
                      {"markers_alone_mm", or_null(error.by_markers)}});
  }
  const std::string hand = format_hand(scanned.hand);
  const Json json = {{"key", key},
                     {"hand", sha256_hex(hand)},
                     {"patient_from_hand", pose_json(scanned.patient_from_hand)},
                     {"registration_mean_mm", scanned.registration_mean},
                     {"registration_p95_mm", scanned.registration_p95},
                     {"skin_errors", std::move(errors)},
                     {"notes", scanned.notes}};
  create_folder(folder);
  write_file(fs::path(folder) / "hand.glb", hand);
  write_file(fs::path(folder) / "hand.json", json.dump(1) + "\n");
}

std::optional<ScannedHand> kept_scanned_hand(const std::string& folder, const std::string& key) {
  return kept(fs::path(folder) / "hand.json", key, [&](const Json& json) {
    const std::string path = (fs::path(folder) / "hand.glb").string();
    const std::string bytes = read_file(path);
    if (sha256_hex(bytes) != json.at("hand").get<std::string>()) {
      throw InputError(path + ": isn't the one that was kept");
    }
    ScannedHand scanned;
    scanned.hand = parse_hand(bytes, path);
    scanned.patient_from_hand = pose_in(json.at("patient_from_hand"));
    scanned.registration_mean = json.at("registration_mean_mm").get<double>();
    scanned.registration_p95 = json.at("registration_p95_mm").get<double>();
    for (const Json& error : json.at("skin_errors")) {
      scanned.skin_errors.push_back(
          {posture_in(error.at("posture")), error.at("skinning_only_mm").get<double>(),
           number_or_null(error.at("corrected_mm")), number_or_null(error.at("markers_alone_mm"))});
    }
    scanned.notes = json.at("notes").get<std::vector<std::string>>();
    return scanned;
  });
}

}  // namespace palmar
