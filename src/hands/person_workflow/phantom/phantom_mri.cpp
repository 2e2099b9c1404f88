// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/phantom/phantom_mri.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

#include "hands/images/dicom.h"
#include "hands/person_records/mri_subject_file.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

/// The other hand beside a hand: its mirror image, 15 mm away on the patient's left. Its skin is
/// added to `skin`.
void add_other_hand(phantom::SubjectPosture& state, std::vector<Vec3>& skin) {
  double edge = -std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : state.skin.vertices) edge = std::max(edge, vertex.x());
  constexpr double kGap = 15.0;  // mm
  const double sum = 2.0 * edge + kGap;
  for (const Vec3& vertex : state.skin.vertices) {
    skin.emplace_back(sum - vertex.x(), vertex.y(), vertex.z());
  }
  const std::size_t parts = state.parts.size();
  for (std::size_t p = 0; p < parts; ++p) {
    phantom::ImagedPart other = state.parts[p];
    for (Vec3& vertex : other.mesh.vertices) vertex.x() = sum - vertex.x();
    for (Triangle& triangle : other.mesh.triangles) std::swap(triangle[1], triangle[2]);
    state.parts.push_back(std::move(other));
  }
}

/// How many vertices of the skin the image doesn't show; the forearm is always cut.
std::size_t count_outside(const std::vector<Vec3>& skin, const imaging::VolumeGrid& grid) {
  std::size_t outside = 0;
  for (const Vec3& vertex : skin) {
    const Vec3 at = grid.to_voxel(vertex);
    const bool is_in = at[0] >= 0.0 && at[0] <= grid.size[0] - 1.0 && at[1] >= 0.0 &&
                       at[2] >= 0.0 && at[2] <= grid.size[2] - 1.0;
    outside += is_in ? 0 : 1;
  }
  return outside;
}

/// The series of one posture in `folder`, which is written again.
void write_posture(const std::filesystem::path& folder, const imaging::Volume& image,
                   hand::ScanPosture posture, const phantom::MriSubjectOptions& person,
                   double fat_shift) {
  // What an earlier run left would be a second series.
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  images::DicomHeader header;
  header.patient = "Phantom^" + std::to_string(person.seed);
  header.description = name_of(posture);
  header.laterality = person.side == hand::Side::kLeft ? "L" : "R";
  header.number = static_cast<int>(posture) + 1;
  header.fat_shift = fat_shift;
  images::write_dicom_series(folder.string(), image, header);
}

}  // namespace

void PhantomMriRequest::check() const {
  if (out.empty()) throw UsageError("setting \"out\" is empty; a folder to write to is required");
  grid.check();
  scanner.check();
  person.check();
}

PhantomMriOutcome make_phantom_mri(const PhantomMriRequest& request, const Progress& progress) {
  request.check();
  const phantom::MriSubjectOptions& person = request.person;
  const std::vector<hand::ScanPosture> postures = sorted_postures(request.postures);
  progress.update(0.0, "making the person");
  phantom::MriSubject subject =
      phantom::make_mri_subject(*workflow::load_hand(request.base), person);
  const std::filesystem::path out(request.out);
  PhantomMriOutcome outcome;
  std::map<hand::ScanPosture, std::string> series;
  for (std::size_t p = 0; p < postures.size(); ++p) {
    const std::string name(name_of(postures[p]));
    const double length = 0.95 / static_cast<double>(postures.size());
    phantom::SubjectPosture& state = subject.postures.at(postures[p]);
    std::vector<Vec3> skin = state.skin.vertices;
    if (request.both_hands) add_other_hand(state, skin);
    const imaging::VolumeGrid grid = phantom::scan_grid(skin, request.grid);
    const std::size_t outside = count_outside(skin, grid);
    if (outside > 0) {
      workflow::note_to(request.note,
                        fmt::format("{}: {} of {} vertices of the skin are outside the image", name,
                                    outside, skin.size()));
    }
    phantom::ScannerOptions scanner = request.scanner;
    scanner.seed = person.seed * hand::kScanPostureCount + static_cast<std::uint64_t>(postures[p]);
    const imaging::Volume image =
        phantom::image_of(state.parts, grid, scanner,
                          part_of(progress, 0.05 + length * static_cast<double>(p),
                                  0.05 + length * static_cast<double>(p + 1), name));
    const std::filesystem::path folder = out / "mri" / name;
    write_posture(folder, image, postures[p], person, scanner.fat_shift);
    series[postures[p]] = "mri/" + name;
    outcome.series.push_back({postures[p], folder.string(), grid});
  }
  progress.update(0.98, "writing the truth");
  const std::string truth = (out / "truth").string();
  person_records::write_mri_subject(truth, subject, series, person.seed);
  outcome.person = {subject.name, person.side, truth + "/subject.json"};
  return outcome;
}

}  // namespace palmar::person_workflow
