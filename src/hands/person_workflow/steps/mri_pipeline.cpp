// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/mri_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "hands/capture/hand_plausibility.h"
#include "hands/capture/length_plausibility.h"
#include "hands/capture/mri/bones/bone_plausibility.h"
#include "hands/capture/mri/bones/find_surfaces.h"
#include "hands/capture/mri/bones/image_edge.h"
#include "hands/capture/scan/grasp_contact.h"
#include "hands/images/dicom.h"
#include "hands/person_records/scan_surfaces_file.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/formats/sha256.h"
#include "palmar/hand/mirror.h"

namespace palmar::person_workflow {
namespace {

/// Digest of all that the surfaces of a scan depend on.
std::string key_of(const SelectedScan& selected, const capture::SurfaceOptions& options) {
  formats::Sha256 digest;
  for (const std::string& file : selected.files) {
    const std::string bytes = formats::read_file(file);
    digest.add(fmt::format("{}:", bytes.size()));
    digest.add(bytes);
  }
  digest.add(fmt::format("{} {} {} {} {} {} {} {}", build_description(), options.air_threshold,
                         options.bone_threshold, options.corrects_bias, options.edge_length,
                         options.marker_diameter, selected.choice.number.value_or(-1),
                         options.side ? name_of(*options.side) : "from the anatomy"));
  return digest.hex();
}

std::string folder_of(hand::ScanPosture posture, const std::string& work) {
  return (std::filesystem::path(work) / name_of(posture)).string();
}

/// What the tag says about the side, held against the user's word or the anatomy.
void check_laterality(capture::RecordedScan& scan, const MriPipelineOptions& options) {
  if (scan.laterality.empty()) return;
  const bool says_left = scan.laterality == "L";
  if (says_left == (scan.surfaces.side == hand::Side::kLeft)) return;
  const std::string_view side = name_of(scan.surfaces.side);
  const std::string note = fmt::format(
      "{}: its tag Laterality says {}, but {}", scan.title, scan.laterality,
      options.surfaces.side
          ? fmt::format("setting \"side\" {} counts", side)
          : fmt::format("the hand is a {} one; the anatomy counts (setting \"side\" decides)",
                        side));
  scan.surfaces.notes.push_back(with_setting_names(note, options.setting_names));
}

/// Names that the user gives to bones of the reference count over those that were found. What is
/// there is shown, also if a name is refused.
void name_and_show(capture::ScanSurfaces& reference, const hand::Hand& model,
                   const MriPipelineOptions& options, const Progress& progress) {
  const auto show = [&] {
    if (options.show_reference) options.show_reference(reference, progress);
  };
  try {
    capture::apply_bone_labels(reference, options.labels, model);
  } catch (const InputError&) {
    show();
    throw;
  }
  show();
}

/// Surfaces that an earlier run left, or that the user gave, maybe repaired.
capture::ScanSurfaces read_kept(const std::string& folder, bool is_users) {
  try {
    return person_records::read_scan_surfaces(folder);
  } catch (const InputError& error) {
    if (is_users) throw;
    throw InputError(std::string(error.what()) + "; without the folder " + folder +
                     " they are found in the image again");
  }
}

/// A scan's image for comparing; nothing if there are only its surfaces.
std::optional<capture::ImageLevels> levels_of(const SelectedScan& selected) {
  if (selected.has_surfaces) return {};
  return capture::blurred_levels(images::read_image(selected.path, selected.choice).image);
}

struct PlannedScan {
  const SelectedScan* selected = nullptr;
  std::string key;       ///< of the image and the options
  bool is_kept = false;  ///< surfaces are there already
};

/// What the reference scan shows of the others: the side, so that another one must be clearly the
/// other hand's to be taken for it, and to which side the read-out shows fat.
void take_from_reference(const capture::ScanSurfaces& reference, capture::SurfaceOptions& how) {
  if (!how.side) {
    how.side = reference.side;
    how.doubted_below = 0.75;
  }
  constexpr double kAlike = 0.25;  // of the shift: one read-out, or nearly
  const Vec3& shown = reference.fat_shift;
  const Vec3 towards = shown.dot(how.fat_shift) < 0.0 ? Vec3(-how.fat_shift) : how.fat_shift;
  if (shown == Vec3::Zero() || (towards - shown).norm() > kAlike * shown.norm()) return;
  how.fat_shift = towards;
  how.is_fat_side_known = true;
}

/// `reference`: surfaces of the reference scan, once there are any.
capture::RecordedScan surfaces_of(const PlannedScan& plan, const hand::Hand& model,
                                  const capture::ScanSurfaces* reference,
                                  const MriPipelineOptions& options, const Progress& progress) {
  const SelectedScan& selected = *plan.selected;
  capture::RecordedScan scan;
  scan.posture = selected.posture;
  scan.title = selected.title;
  scan.was_kept = plan.is_kept;
  const std::string folder = folder_of(selected.posture, options.work);
  if (plan.is_kept) {
    progress.update(0.0, "taking up what is there");
    scan.surfaces =
        read_kept(selected.has_surfaces ? selected.path : folder, selected.has_surfaces);
    if (options.surfaces.side) scan.surfaces.side = *options.surfaces.side;
    return scan;
  }
  const images::ImageFile file =
      images::read_image(selected.path, selected.choice, part_of(progress, 0.0, 0.1));
  scan.laterality = file.laterality;
  capture::SurfaceOptions how = options.surfaces;
  how.fat_shift = file.fat_shift;
  if (reference != nullptr) take_from_reference(*reference, how);
  scan.surfaces =
      capture::find_surfaces(file.image, selected.title, model, how, part_of(progress, 0.1, 1.0));
  scan.surfaces.notes.insert(scan.surfaces.notes.begin(), file.notes.begin(), file.notes.end());
  check_laterality(scan, options);
  capture::mark_cut_fingers(scan.surfaces, file.image.grid);
  const std::vector<std::string> cut = capture::cut_bones_of_fingers(scan.surfaces);
  if (!cut.empty()) {
    scan.surfaces.notes.push_back(
        fmt::format("the edge of the image cuts {}", fmt::join(cut, ", ")));
  }
  progress.throw_if_cancelled();
  person_records::write_scan_surfaces(folder, scan.surfaces, plan.key);
  if (options.surfaces.side) scan.surfaces.side = *options.surfaces.side;
  return scan;
}

/// A hand of which the image shows a part only would come out too short.
void require_whole(const capture::RecordedScan& scan) {
  const std::vector<std::string> cut = capture::cut_bones_of_fingers(scan.surfaces);
  if (cut.empty()) return;
  throw InputError(
      fmt::format("{}: the edge of the image cuts the hand at {}; the reference must show it whole",
                  scan.title, fmt::join(cut, ", ")));
}

/// Refuses scans that no hand can be made of, before the long work on the others.
void require_bones(const capture::RecordedScan& scan, const hand::Hand& model) {
  constexpr int kLeastPerFinger = 2;
  constexpr std::size_t kMostMissing = 5;  // of the 19 of fingers and palm
  std::vector<std::string> missing;
  std::string poor;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const std::string_view finger = name_of(static_cast<hand::Finger>(f));
    int seen = 0;
    for (const hand::Bone& bone : model.bones) {
      if (!bone.name.starts_with(finger)) continue;
      const bool is_seen = std::any_of(scan.surfaces.bones.begin(), scan.surfaces.bones.end(),
                                       [&](const auto& one) { return one.name == bone.name; });
      seen += is_seen ? 1 : 0;
      if (!is_seen) missing.push_back(bone.name);
    }
    if (seen < kLeastPerFinger) poor += (poor.empty() ? "" : ", ") + std::string(finger);
  }
  if (poor.empty() && missing.size() <= kMostMissing) return;
  throw InputError(fmt::format(
      "{}: too few bones were found to make a hand of: {} of the 19 of fingers and palm are "
      "missing ({}); up to {} may be, and each finger needs {}. What helps: setting \"labels\" for "
      "bones that were found without a name; setting \"bone threshold\" above the {:.0f} that was "
      "used, where the rim of small bones is grey instead of dark; {}",
      scan.title, missing.size(), fmt::join(missing, ", "), kMostMissing, kLeastPerFinger,
      scan.surfaces.bone_threshold, capture::better_scan(scan.surfaces)));
}

void require_same_side(const capture::RecordedScan& scan, hand::Side reference) {
  if (scan.surfaces.side == reference) return;
  throw InputError(scan.title + ": shows a " + std::string(name_of(scan.surfaces.side)) +
                   " hand, but the reference is a " + std::string(name_of(reference)) +
                   " one; leave it out with setting \"skip\" " +
                   std::string(name_of(scan.posture)) +
                   ", or say setting \"side\" if one of them is wrong");
}

/// Looks at every image before the long work begins: a slice that is damaged in one of them would
/// cost the time of all.
void require_sound_images(const std::vector<PlannedScan>& plans, bool accepts_odd_slices,
                          const Progress& progress,
                          const std::function<void(const std::string&)>& on_note) {
  std::string damaged;
  for (std::size_t k = 0; k < plans.size(); ++k) {
    if (plans[k].is_kept) continue;
    const SelectedScan& selected = *plans[k].selected;
    const double size = static_cast<double>(plans.size());
    const Progress part =
        part_of(progress, static_cast<double>(k) / size, static_cast<double>(k + 1) / size);
    for (const std::string& odd :
         images::read_image(selected.path, selected.choice, part).odd_slices) {
      if (accepts_odd_slices) on_note(std::string(name_of(selected.posture)) + ": " + odd);
      damaged += odd + "\n";
    }
  }
  if (damaged.empty() || accepts_odd_slices) return;
  throw InputError(damaged +
                   "restore them, leave the posture out with setting \"skip\", or continue with "
                   "setting \"accept odd slices\" if they look right");
}

/// What goes wrong here comes from bones that were found wrongly.
capture::ScannedHand make_hand(const hand::Hand& model,
                               const std::map<hand::ScanPosture, capture::ScanSurfaces>& surfaces,
                               const capture::ScanRecord& record, const Progress& progress) {
  try {
    capture::ScannedHand made =
        capture::make_scanned_hand(model, surfaces, record.joints, progress);
    const std::vector<std::string> impossible =
        capture::impossible_dimensions(made.hand.dimensions, model.dimensions);
    if (!impossible.empty()) throw InputError(fmt::format("{}", fmt::join(impossible, "; ")));
    return made;
  } catch (const InputError& error) {
    const capture::RecordedScan& reference = record.scans.front();
    const std::vector<std::string> doubts = capture::doubtful_bones(reference.surfaces, model);
    throw InputError(fmt::format(
        "{}: its bones and skin make no whole hand: {}. {}Look at the pictures; fingers that are "
        "curled or touch in the reference can be the cause, and so can bones",
        reference.title, error.what(),
        doubts.empty() ? "No bone of it looks wrong. "
                       : fmt::format("Bones that look wrong: {}. ", fmt::join(doubts, "; "))));
  }
}

/// Shares of the whole time by what the steps take, in seconds of a usual scan on two cores.
class Shares {
 public:
  void plan(double seconds) { left_ += seconds; }
  /// The next step's part.
  Progress next(const Progress& progress, double seconds, const std::string& what) {
    const double begin = at_;
    at_ += (1.0 - at_) * std::min(1.0, seconds / left_);
    left_ -= seconds;
    return part_of(progress, begin, at_, what);
  }

 private:
  double at_ = 0.0, left_ = 0.0;  // share that is done; seconds that aren't
};
constexpr double kChecked = 0.5;
constexpr double kFound = 25.0, kKept = 0.1, kShown = 2.0, kTracked = 4.0, kMade = 15.0,
                 kWritten = 12.0;

/// Step and posture that the work is at, for when it fails.
struct MriStep {
  std::string name, posture;
};

/// The cause after the step, and where what was found lies.
std::string refusal_message(const MriPipelineOptions& options, const capture::ScanRecord& found,
                            const MriStep& step, const std::string& cause) {
  const std::string about = step.posture.empty() ? "" : " (" + step.posture + ")";
  std::string message = fmt::format("step {}{} failed: {}", step.name, about, cause);
  if (!options.write_found) return message;
  const std::string where = options.write_found(found, {step.name, step.posture, cause});
  return where.empty() ? message : message + ". " + where;
}

void run_steps(const std::vector<SelectedScan>& scans, const hand::Hand& model,
               const MriPipelineOptions& options, const Progress& progress,
               capture::ScanRecord& result, MriStep& step) {
  const auto on_note = [&](const std::string& text) {
    result.notes.push_back(with_setting_names(text, options.setting_names));
    workflow::note_to(options.note, result.notes.back());
  };
  if (options.product && scans.back().posture != hand::ScanPosture::kGrasp) {
    throw UsageError("setting \"product\" " + options.product->source +
                     ": none of the scans shows the posture grasp, in which it was held");
  }
  progress.update(0.0, "looking for what is there");
  std::vector<PlannedScan> plans;
  Shares shares;
  for (const SelectedScan& selected : scans) {
    progress.throw_if_cancelled();
    PlannedScan plan{&selected, "", selected.has_surfaces};
    if (!selected.has_surfaces) {
      plan.key = key_of(selected, options.surfaces);
      plan.is_kept = person_records::key_of_scan_surfaces(
                         folder_of(selected.posture, options.work)) == plan.key;
    }
    shares.plan(plan.is_kept ? kKept : kFound + kChecked);
    plans.push_back(std::move(plan));
  }
  shares.plan(kShown + kTracked * static_cast<double>(scans.size() - 1) + kMade + kWritten);

  const auto found = std::count_if(plans.begin(), plans.end(),
                                   [](const PlannedScan& plan) { return !plan.is_kept; });
  if (found > 0) {
    require_sound_images(plans, options.accepts_odd_slices,
                         shares.next(progress, kChecked * static_cast<double>(found), ""), on_note);
  }

  for (const PlannedScan& plan : plans) {
    const std::string name(name_of(plan.selected->posture));
    step = {"surfaces", name};
    const capture::ScanSurfaces* const reference =
        result.scans.empty() ? nullptr : &result.scans.front().surfaces;
    result.scans.push_back(surfaces_of(plan, model, reference, options,
                                       shares.next(progress, plan.is_kept ? kKept : kFound, name)));
    capture::RecordedScan& scan = result.scans.back();
    step = {"bones", name};
    if (result.scans.size() == 1) {
      name_and_show(scan.surfaces, model, options, shares.next(progress, kShown, ""));
    }
    for (const std::string& note : scan.surfaces.notes) on_note(name + ": " + note);
    const std::vector<std::string> doubts = capture::doubtful_bones(scan.surfaces, model);
    if (!doubts.empty()) {
      on_note(fmt::format(
          "{}: look at these bones, which may be found wrongly or bear a wrong name: {}{}", name,
          fmt::join(doubts, "; "),
          result.scans.size() == 1
              ? ". Joints and lengths of the hand hang on them: name them by setting \"labels\", "
                "mend their meshes, or make " +
                    capture::better_scan(scan.surfaces)
              : ""));
    }
    if (options.looks_only) return;
    if (result.scans.size() == 1) {
      require_bones(scan, model);
      require_whole(scan);
    }
    require_same_side(scan, result.scans.front().surfaces.side);
  }

  const capture::ScanSurfaces& reference = result.scans.front().surfaces;
  std::optional<capture::BoneImages> bones;
  for (std::size_t k = 1; k < result.scans.size(); ++k) {
    const capture::RecordedScan& scan = result.scans[k];
    const Progress part = shares.next(progress, kTracked, std::string(name_of(scan.posture)));
    part.update(0.0, "reading");
    step = {"motions", std::string(name_of(scan.posture))};
    if (!bones) {
      const std::optional<capture::ImageLevels> image = levels_of(scans.front());
      bones = image ? capture::images_of_bones(reference, *image) : capture::BoneImages();
    }
    const std::optional<capture::ImageLevels> image = levels_of(scans[k]);
    result.motions[scan.posture] =
        capture::track_bones(reference, scan.surfaces, {&*bones, image ? &*image : nullptr}, part);
  }

  const Progress part = shares.next(progress, kMade, "");
  part.update(0.0, "joints");
  step = {"joints", ""};
  const hand::Hand sided = reference.side == model.side ? model : hand::mirrored(model);
  std::map<hand::ScanPosture, capture::ScanSurfaces> surfaces;
  for (const capture::RecordedScan& scan : result.scans) surfaces[scan.posture] = scan.surfaces;
  result.joints = capture::measure_joints(surfaces, result.motions, sided);
  for (const std::string& note : result.joints.notes) on_note(note);
  step = {"hand", ""};
  result.made = make_hand(sided, surfaces, result, part_of(part, 0.1, 1.0));
  for (const std::string& note : result.made.notes) on_note(note);
  const std::string doubt = capture::length_doubt(result.made.hand.dimensions);
  if (!doubt.empty()) on_note(doubt);
  if (options.product) {
    step = {"contact", std::string(name_of(hand::ScanPosture::kGrasp))};
    result.contact = capture::grasp_contact(result, options.product->mesh, options.product->source);
  }
  if (options.write) options.write(result, shares.next(progress, kWritten, ""));
}

}  // namespace

capture::ScanRecord run_mri_pipeline(const std::vector<SelectedScan>& scans,
                                     const hand::Hand& model, const MriPipelineOptions& options,
                                     const Progress& progress) {
  capture::ScanRecord result;
  MriStep step;
  try {
    run_steps(scans, model, options, progress, result, step);
  } catch (const InputError& error) {
    if (result.scans.empty()) throw;
    throw InputError(refusal_message(options, result, step, error.what()));
  } catch (const NumericalError& error) {
    if (result.scans.empty()) throw;
    throw NumericalError(refusal_message(options, result, step, error.what()));
  }
  return result;
}

}  // namespace palmar::person_workflow
