// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_quick.h"

#include <fmt/format.h>

#include <cmath>

#include "hands/capture/sheet/card_view.h"
#include "hands/capture/sheet/skin_mask.h"
#include "hands/images/exif.h"
#include "hands/person_workflow/steps/outline_picture.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/mirror.h"
#include "palmar/population/segment_regressions.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/person/person_file.h"
#include "palmar/records/population/population_file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

constexpr double kMostTilt = 25.0;  // deg: docs/method/outline.md

bool is_beside_card(const PhotographedHand& photo) {
  return photo.scene.sheet.format.name == capture::card_format().name;
}

PhotographedHand photographed(const HandQuickRequest& request) {
  const std::string bytes = formats::read_file(request.photo, std::uint64_t{256} << 20);
  PhotographedHand result;
  result.image = formats::read_texture(bytes, request.photo);
  capture::SheetOptions sheet;
  sheet.most_tilt = kMostTilt;
  if (!request.sheet.empty()) sheet.format = capture::sheet_format_named(request.sheet);
  if (const auto exif = images::read_exif(bytes)) {
    if (exif->is_cropped(result.image.width, result.image.height)) {
      throw InputError(fmt::format(
          "{}: has {} x {} pixels, but the camera took {} x {}: it is cropped, and where the lens "
          "looked isn't known any more; take the photograph as the camera wrote it",
          request.photo, result.image.width, result.image.height, exif->width, exif->height));
    }
    sheet.focal = exif->focal_pixels(result.image.width, result.image.height);
  }
  const bool is_card = sheet.format && sheet.format->name == capture::card_format().name;
  capture::OutlineScene& scene = result.scene;
  scene.sheet = is_card ? capture::find_card(result.image, request.photo, sheet)
                        : capture::find_sheet(result.image, request.photo, sheet);
  scene.grid = is_card ? capture::grid_beside_card(scene.sheet, capture::kOutlineCell)
                       : capture::grid_of_sheet(scene.sheet, capture::kOutlineCell);
  scene.proportions = capture::outline_proportions(population::template_proportions());
  scene.options.wrist = request.wrist_inside;
  scene.options.palm_up = request.palm_up;
  const capture::Ground ground = is_card ? capture::Ground::kTable : capture::Ground::kPaper;
  const imaging::VoxelMask skin = capture::skin_mask(
      capture::draw_sheet(result.image, scene.sheet, scene.grid, ground), ground, request.photo);
  result.outline = capture::measure_outline(scene.grid, skin, scene.sheet, scene.proportions,
                                            request.photo, scene.options);
  return result;
}

void note_photograph(const PhotographedHand& photo, const workflow::NoteSink& on_note) {
  const capture::SheetView& sheet = photo.scene.sheet;
  const bool is_card = is_beside_card(photo);
  const double finger = photo.scene.proportions.finger_height[2] * photo.outline.hand_length;
  on_note(fmt::format(
      "{}, edges straight within {:.2f} mm; camera {:.0f} mm above it, {:.0f} "
      "degrees off its normal{}",
      is_card ? "bank card" : sheet.format.name + " sheet", sheet.edge_error, sheet.eye.z(),
      sheet.tilt,
      sheet.focal_source == "usual" ? " if its lens is that of most telephones (26 mm on film)"
                                    : ""));
  if (is_card) {
    on_note(fmt::format("lengths follow from so small a card within {:.1f} % (standard error)",
                        100.0 * sheet.scale_error));
  }
  on_note(
      fmt::format("skin above the paper looks larger: fingertips by {:.1f} %, which is taken off",
                  100.0 * finger / (sheet.eye.z() - finger)));
  if (photo.outline.hand_width <= 0.0) {
    on_note("the thumb covers the breadth over the knuckles, which follows from the rest");
  }
}

/// The side that the photograph shows, which must be the one that the user says.
hand::Side side_of(const PhotographedHand& photo, const HandQuickRequest& request) {
  const hand::Side seen = photo.outline.is_right ? hand::Side::kRight : hand::Side::kLeft;
  if (!request.side || seen == *request.side) return seen;
  throw UsageError(
      fmt::format("setting \"side\" {}: the thumb is that of a {} hand with its {} to the camera{}",
                  name_of(*request.side), name_of(seen), request.palm_up ? "palm" : "back",
                  request.palm_up ? "; is setting \"palm up\" meant?"
                                  : "; give setting \"palm up\" if the palm is seen, and don't "
                                    "mirror photographs"));
}

/// The hand that most people of these measures have.
capture::OutlinePerson person_of_measures(const population::Population& population,
                                          const std::vector<population::KnownMeasure>& own,
                                          hand::Side side) {
  capture::OutlinePerson person;
  person.measures = static_cast<int>(own.size());
  person.estimate = population::estimate_person(population, own);
  person.hand = hand::make_hand_instance(*workflow::load_hand("template"),
                                         population::sizes_of(person.estimate))
                    .hand;
  if (side == hand::Side::kLeft) person.hand = hand::mirrored(person.hand);
  return person;
}

/// The request with what its file of the person says; what the request says itself counts more.
HandQuickRequest with_what_is_known(HandQuickRequest request) {
  if (request.known.empty()) return request;
  records::PersonFile said;
  said.side = request.side;
  said.sizes = request.sizes;
  const records::PersonFile known = records::merged(records::read_person(request.known), said);
  request.side = known.side;
  request.sizes = known.sizes;
  if (request.photo.empty() && request.sizes.empty()) {
    throw InputError(request.known +
                     ": no measure of the hand in [measured_mm], and no photograph is given");
  }
  return request;
}

}  // namespace

void HandQuickRequest::check() const {
  if (photo.empty() && sizes.empty() && known.empty()) {
    throw UsageError(
        "nothing is known of the hand: a photograph, setting \"hand length\", setting "
        "\"circumference\", setting \"width\" or setting \"dimension\" is required");
  }
  if (!photo.empty() && !sheet.empty()) capture::sheet_format_named(sheet);
}

HandQuickOutcome make_hand_quick(const HandQuickRequest& asked, const Progress& progress) {
  asked.check();
  const HandQuickRequest request = with_what_is_known(asked);
  const auto on_note = [&](const std::string& text) { workflow::note_to(request.note, text); };
  HandQuickOutcome outcome;
  outcome.population = records::load_population(request.population);
  const population::Population& population = outcome.population;
  std::vector<population::KnownMeasure> own;
  for (const hand::SizedDimension& one : request.sizes) {
    own.push_back(population::KnownMeasure::of(one.dimension, one.value, request.error));
  }
  capture::OutlinePerson& person = outcome.person;
  outcome.side = request.side.value_or(hand::Side::kRight);
  if (request.photo.empty()) {
    progress.update(0.1, "estimating");
    person = person_of_measures(population, own, outcome.side);
  } else {
    progress.update(0.1, "looking for sheet and hand");
    outcome.photograph = photographed(request);
    const PhotographedHand& photo = *outcome.photograph;
    outcome.side = side_of(photo, request);
    note_photograph(photo, on_note);
    progress.update(0.4, "measuring");
    try {
      person = capture::person_of_outline(*workflow::load_hand("template"), population, own,
                                          photo.outline, photo.scene);
    } catch (const UsageError& error) {
      if (!own.empty()) throw;  // a size that was given may be what is wrong
      throw InputError(
          fmt::format("{}: what is measured on it is no hand's: {}", request.photo, error.what()));
    }
    for (const std::string& text : person.notes) on_note(text);
    if (!request.picture.empty()) {
      formats::write_file(request.picture,
                          outline_picture(photo.image, photo.scene.sheet, photo.outline,
                                          person.model ? &person.model->outline : nullptr));
      on_note("wrote " + request.picture);
    }
  }
  for (const std::string& text : person.estimate.notes) on_note(text);
  for (const std::string& text : population.cautions) on_note(text);
  const char* const from = !outcome.photograph ? ""
                           : is_beside_card(*outcome.photograph)
                               ? " of a photograph beside a bank card"
                               : " of a photograph on a sheet of paper";
  person.hand.provenance += fmt::format("; sizes from {} measures{} and the people of {}",
                                        person.measures, from, population.name);
  progress.update(0.95, "writing");
  if (!request.out.empty()) {
    records::write_hand(request.out, person.hand);
    on_note(fmt::format("wrote {} ({} hand)", request.out, name_of(outcome.side)));
  }
  return outcome;
}

}  // namespace palmar::person_workflow
