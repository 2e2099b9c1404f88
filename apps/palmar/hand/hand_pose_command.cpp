// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_pose_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "hand/posture_notes.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/motion/marker_file.h"
#include "palmar/hand/posture/marker_set.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/posture/posture_fit.h"
#include "palmar/hand/posture/posture_from_mesh.h"
#include "palmar/product/intake/unit_guard.h"
#include "palmar/records/posture/marker_set_file.h"
#include "palmar/records/posture/posture_report.h"
#include "palmar/report/picture/hand_export.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct PoseArguments {
  std::string hand = "template", posture, angles, markers, marker_set, mesh, unit, frame;
  std::vector<std::string> settings, out;
  double height_mm = 0.0, marker_sd_mm = hand::PostureFitOptions{}.point_sd;
  bool fits_scale = false;
};

hand::Dof dof_for(const std::string& name) {
  if (const auto dof = hand::dof_named(name)) return *dof;
  std::vector<std::string> known;
  for (int d = 0; d < hand::kDofCount; ++d) known.emplace_back(name_of(static_cast<hand::Dof>(d)));
  const std::string nearest = nearest_name(name, known);
  throw UsageError(
      "--set: \"" + name + "\" is no degree of freedom" +
      (nearest.empty() ? "; `palmar hand info` lists them" : "; did you mean " + nearest + "?"));
}

hand::Posture named(const hand::Skeleton& skeleton, const std::string& name) {
  if (name.empty() || name == "reference") return hand::reference_posture(skeleton);
  if (const auto found = hand::named_posture(skeleton, name)) return *found;
  const std::string nearest = nearest_name(name, hand::posture_names());
  throw UsageError("--posture: \"" + name + "\" is not known" +
                   (nearest.empty() ? "" : "; did you mean " + nearest + "?") +
                   " Known: reference, " + palmar::joined(hand::posture_names(), ", "));
}

/// Single angles "index_pip_flexion=60" (degrees) over a posture, held to the range of motion.
void set_angles(const std::vector<std::string>& settings, const hand::Skeleton& skeleton,
                const CommonOptions& common, records::PostureFrame& frame) {
  if (settings.empty()) return;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw UsageError("--set: \"" + setting + "\" is not of the form index_pip_flexion=60 (deg)");
    }
    const double angle = workflow::parse_list("--set", setting.substr(equals + 1)).front();
    frame.posture[dof_for(setting.substr(0, equals))] = radians(angle);
  }
  const hand::ClampedPosture held = hand::clamp_to_range(skeleton, frame.posture);
  note_clamped(common, frame.name, held.clamped);
  frame.posture = held.posture;
  frame.clamped.insert(frame.clamped.end(), held.clamped.begin(), held.clamped.end());
}

/// The frames that --frame asks for, as indices; `numbers` are the frames' own.
std::vector<std::size_t> chosen_frames(const std::string& frame, const std::vector<int>& numbers,
                                       const std::string& path) {
  std::vector<std::size_t> all(numbers.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  if (frame.empty() || frame == "all") return all;
  int wanted = 0;
  const char* end = frame.data() + frame.size();
  const auto [stop, error] = std::from_chars(frame.data(), end, wanted);
  if (error != std::errc() || stop != end) {
    throw UsageError("--frame: \"" + frame + "\" is not known; a number or all is allowed");
  }
  const auto found = std::find(numbers.begin(), numbers.end(), wanted);
  if (found == numbers.end()) {
    throw UsageError(fmt::format("--frame: {} has no frame {}; it has {} to {}", path, wanted,
                                 numbers.front(), numbers.back()));
  }
  return {static_cast<std::size_t>(found - numbers.begin())};
}

records::PostureReport from_angles(const PoseArguments& arguments, const hand::Hand& hand,
                                   const CommonOptions& common) {
  const records::PostureFile file = records::read_postures(arguments.angles, hand.skeleton);
  for (const std::string& text : file.notes) note(common, arguments.angles + ": " + text);
  std::vector<int> numbers;
  for (std::size_t i = 0; i < file.frames.size(); ++i) numbers.push_back(static_cast<int>(i) + 1);
  records::PostureReport report{
      .hand = hand.name, .source = arguments.angles, .labels = {}, .postures = {}};
  for (const std::size_t i : chosen_frames(arguments.frame, numbers, arguments.angles)) {
    note_frame(common, file.frames[i]);
    records::FoundPosture found;
    found.frame = file.frames[i];
    found.number = numbers[i];
    report.postures.push_back(std::move(found));
  }
  return report;
}

std::string names_of(const std::vector<hand::Dof>& dofs) {
  std::string text;
  for (const hand::Dof dof : dofs) text += (text.empty() ? "" : ", ") + std::string(name_of(dof));
  return text;
}

/// What a person should know about one frame's fit.
void note_fit(const CommonOptions& common, const std::string& place, const hand::PostureFit& fit,
              const hand::MarkerSet& set) {
  note(common, place + ": " + fit.message);
  for (const int i : fit.outliers) {
    const auto k = static_cast<std::size_t>(i);
    note(common, fmt::format("{}: marker {} is left out: it is {:.1f} mm from its place", place,
                             set.label[k], *fit.residual[k]));
  }
  for (const auto& [a, b] : fit.swapped) {
    note(common, fmt::format("{}: {} and {} look swapped: each is where the other belongs", place,
                             set.label[static_cast<std::size_t>(a)],
                             set.label[static_cast<std::size_t>(b)]));
  }
  if (!fit.not_observed.empty()) {
    note(common, fmt::format("{}: the markers don't determine {}: at or near the reference posture",
                             place, names_of(fit.not_observed)));
  }
  if (!fit.at_limit.empty()) {
    note(common,
         fmt::format("{}: at the end of the range of motion: {}", place, names_of(fit.at_limit)));
  }
}

records::PostureReport from_markers(const PoseArguments& arguments, const hand::Hand& hand,
                                    const CommonOptions& common) {
  const formats::MarkerRecording recording =
      formats::read_markers(arguments.markers, parse_unit(arguments.unit));
  for (const std::string& text : recording.notes) note(common, arguments.markers + ": " + text);
  const hand::MarkerSet set = arguments.marker_set.empty() || arguments.marker_set == "dorsal"
                                  ? hand::dorsal_marker_set(hand, arguments.height_mm)
                                  : records::read_marker_set(arguments.marker_set, hand);
  const records::MatchedMarkers matched = records::match_markers(set, recording, arguments.markers);
  for (const std::string& text : matched.notes) note(common, arguments.markers + ": " + text);
  const hand::PostureFitter fitter(
      hand, matched.set.point,
      {.point_sd = arguments.marker_sd_mm, .fits_scale = arguments.fits_scale});

  std::vector<int> numbers;
  for (const auto& frame : recording.frames) numbers.push_back(frame.number);
  const std::vector<std::size_t> chosen =
      chosen_frames(arguments.frame, numbers, arguments.markers);
  records::PostureReport report{
      .hand = hand.name, .source = arguments.markers, .labels = matched.set.label, .postures = {}};
  const Progress progress = make_progress(common);
  std::optional<hand::PostureFit> before;
  int skipped = 0, changes = 0;
  double sum = 0.0, worst = 0.0;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::size_t i = chosen[k];
    progress.update(static_cast<double>(k) / static_cast<double>(chosen.size()),
                    fmt::format("frame {}", numbers[i]));
    const hand::PostureFit fit = fitter.fit(matched.frames[i], before ? &*before : nullptr);
    const std::string place = fmt::format("frame {}", numbers[i]);
    if (fit.status == hand::PostureFitStatus::kMirrored ||
        fit.status == hand::PostureFitStatus::kWrongUnit) {
      throw InputError(arguments.markers + ": " + place + ": " + fit.message);
    }
    if (fit.status == hand::PostureFitStatus::kTooFew) {
      if (chosen.size() == 1)
        throw InputError(arguments.markers + ": " + place + ": " + fit.message);
      if (++skipped <= 3) note(common, place + " is left out: " + fit.message);
      continue;
    }
    // Of a long recording the first frame is reported in full, the others are summed up.
    if (report.postures.empty() || fit.status == hand::PostureFitStatus::kPoor ||
        !fit.outliers.empty()) {
      note_fit(common, place, fit, matched.set);
    }
    if (before && fit.not_observed != before->not_observed && ++changes <= 5) {
      note(common, place + (fit.not_observed.empty()
                                ? ": all angles are observed"
                                : ": the markers don't determine " + names_of(fit.not_observed)));
    }
    before = fit;
    sum += fit.rms;
    worst = std::max(worst, fit.rms);
    records::FoundPosture found;
    found.frame.posture = fit.posture;
    found.frame.time = recording.frames[i].time;
    found.number = numbers[i];
    found.markers = fit;
    report.postures.push_back(std::move(found));
  }
  finish_progress();
  if (report.postures.empty()) {
    throw InputError(arguments.markers + ": no frame has enough markers");
  }
  if (chosen.size() > 1) {
    note(common,
         fmt::format("{} frames: residual {:.1f} mm on average, {:.1f} mm at most (root mean "
                     "square over the markers); {} left out",
                     report.postures.size(), sum / static_cast<double>(report.postures.size()),
                     worst, skipped));
  }
  return report;
}

records::PostureReport from_mesh(const PoseArguments& arguments, const hand::Hand& hand,
                                 const CommonOptions& common) {
  const formats::MeshFile file = formats::read_mesh(arguments.mesh);
  for (const std::string& text : file.notes) note(common, arguments.mesh + ": " + text);
  Box3 box;
  for (const Vec3& v : file.mesh.vertices) box.extend(v);
  const product::UnitDecision unit =
      product::decide_unit(box, file.unit, parse_unit(arguments.unit), arguments.mesh);
  if (!unit.explanation.empty()) note(common, arguments.mesh + ": " + unit.explanation);
  geometry::TriangleMesh mesh = file.mesh;
  for (Vec3& v : mesh.vertices) v *= geometry::millimetres_per(unit.unit);
  const hand::MeshFit fit = hand::fit_posture_to_mesh(
      hand, mesh, {.fits_scale = arguments.fits_scale}, make_progress(common));
  finish_progress();
  if (fit.status == hand::PostureFitStatus::kMirrored ||
      fit.status == hand::PostureFitStatus::kWrongUnit) {
    throw InputError(arguments.mesh + ": " + fit.message);
  }
  note(common, arguments.mesh + ": " + fit.message);
  if (!fit.not_observed.empty()) {
    note(common, arguments.mesh + ": the mesh doesn't determine " + names_of(fit.not_observed));
  }
  records::FoundPosture found;
  found.frame.posture = fit.posture;
  found.mesh = fit;
  return {.hand = hand.name, .source = arguments.mesh, .labels = {}, .postures = {found}};
}

void write_pose(const std::string& path, const hand::Hand& hand,
                const records::PostureReport& report, const CommonOptions& common) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".json") {
    formats::write_file(path, records::posture_report_json(report) + "\n");
  } else if (ending == ".csv") {
    formats::write_file(path, records::posture_report_csv(report));
  } else {
    if (report.postures.size() > 1) {
      throw UsageError(fmt::format("--out: {} takes one posture, {} are there; --frame picks one",
                                   path, report.postures.size()));
    }
    report::export_posed_hand(path, hand, report.postures.front().frame.posture);
  }
  note(common, "wrote " + path);
}

int run_pose(const PoseArguments& arguments, const Context& context) {
  const int sources =
      static_cast<int>(!arguments.posture.empty()) + static_cast<int>(!arguments.angles.empty()) +
      static_cast<int>(!arguments.markers.empty()) + static_cast<int>(!arguments.mesh.empty());
  if (sources > 1) {
    throw UsageError("hand pose: --posture, --angles, --markers and --mesh exclude each other");
  }
  if (arguments.markers.empty() && !arguments.marker_set.empty()) {
    throw UsageError("--marker-set needs --markers");
  }
  if (!arguments.frame.empty() && arguments.markers.empty() && arguments.angles.empty()) {
    throw UsageError("--frame needs --markers or --angles");
  }
  const auto hand = workflow::load_hand(arguments.hand);
  records::PostureReport report{.hand = hand->name, .source = "", .labels = {}, .postures = {}};
  if (!arguments.angles.empty()) {
    report = from_angles(arguments, *hand, context.common);
  } else if (!arguments.markers.empty()) {
    report = from_markers(arguments, *hand, context.common);
  } else if (!arguments.mesh.empty()) {
    report = from_mesh(arguments, *hand, context.common);
  } else {
    records::FoundPosture found;
    found.frame.posture = named(hand->skeleton, arguments.posture);
    report.source = arguments.posture.empty() ? "reference" : arguments.posture;
    report.postures.push_back(std::move(found));
  }
  for (records::FoundPosture& one : report.postures) {
    set_angles(arguments.settings, hand->skeleton, context.common, one.frame);
  }
  for (const std::string& path : arguments.out) write_pose(path, *hand, report, context.common);
  if (arguments.out.empty() || context.common.json)
    print(records::posture_report_json(report) + "\n");
  const bool is_poor = std::any_of(
      report.postures.begin(), report.postures.end(), [](const records::FoundPosture& one) {
        return (one.markers && one.markers->status == hand::PostureFitStatus::kPoor) ||
               (one.mesh && one.mesh->status == hand::PostureFitStatus::kPoor);
      });
  return is_poor ? 4 : 0;
}

}  // namespace

void add_hand_pose(CLI::App& hand, Context& context) {
  const auto o = std::make_shared<PoseArguments>();
  CLI::App* verb =
      add_verb(hand, "pose",
               "A hand in a posture: by name, from joint angles, from markers, from a posed mesh",
               "palmar hand pose --posture fist --set thumb_ip_flexion=20 --out fist.glb");
  verb->add_option("HAND", o->hand, "\"template\" or a .hand.glb file")->capture_default_str();
  verb->add_option("--posture", o->posture, "Named posture: reference, fist, ...");
  verb->add_option("--angles", o->angles, "Joint angles: JSON or CSV, NAME_deg");
  verb->add_option("--markers", o->markers, "Marker positions: C3D, or CSV with LABEL_x_mm ...");
  verb->add_option(
      "--marker-set", o->marker_set,
      "Where the markers are: a CSV or JSON file, or dorsal (25 landmarks); default dorsal");
  verb->add_option("--marker-height-mm", o->height_mm,
                   "Centres of the dorsal set's markers above the skin")
      ->capture_default_str();
  verb->add_option("--marker-sd-mm", o->marker_sd_mm,
                   "Expected error of a marker (standard deviation), mm")
      ->capture_default_str();
  verb->add_option("--mesh", o->mesh, "Mesh of a posed hand: STL, OBJ, PLY, 3MF, glTF");
  verb->add_option("--unit", o->unit, "Unit of the markers' or mesh's file: mm, cm, m or inch");
  verb->add_flag("--fit-scale", o->fits_scale, "Also fit one overall size of the hand");
  verb->add_option("--frame", o->frame, "Frame of a file that has several: its number, or all");
  verb->add_option("--set", o->settings, "Angle of one degree of freedom, NAME=DEG; repeatable");
  verb->add_option("--out", o->out,
                   "File to write, repeatable: .json, .csv (angles and residuals), .glb (skin by "
                   "region and bones), .ply, .obj, .stl (skin), .png (picture); default: JSON on "
                   "standard output")
      ->allow_extra_args(false);
  verb->callback([&context, o] { context.run = [&context, o] { return run_pose(*o, context); }; });
}

}  // namespace palmar::cli
