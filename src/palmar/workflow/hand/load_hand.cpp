// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/load_hand.h"

#include <cstdlib>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/core/program_folder.h"
#include "palmar/core/text.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/mirror.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/hand_sample.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/tissue_file.h"

namespace palmar {

namespace fs = std::filesystem;

namespace {

const Population& people_of(Sex sex) {
  return population_named(sex == Sex::kFemale ? "ansur2_women" : "ansur2_men");
}

std::shared_ptr<const Hand> sized_as(const Hand& base, const PersonOfSize& person) {
  person.check();
  SamplingOptions sampling;
  sampling.design = SamplingDesign::kPercentiles;
  sampling.percentiles = {person.percentile};
  const std::vector<HandSample> samples = sample_hands(people_of(person.sex), sampling);
  auto hand = std::make_shared<Hand>(make_hand_instance(base, samples.front().dimensions).hand);
  hand->name = name_of(person);
  hand->provenance += "; size of the " + name_of(person);
  return hand;
}

}  // namespace

void PersonOfSize::check() const {
  if (!(percentile > 0.0 && percentile < 100.0)) {
    throw UsageError("setting \"person\" has the percentile " + significant(percentile, 6) +
                     "; above 0 and below 100 is required");
  }
}

std::string name_of(const PersonOfSize& person) {
  const std::string number = significant(person.percentile, 6);
  const bool is_teen = person.percentile >= 10.0 && person.percentile < 20.0;
  const char last = number.back();
  const std::string end = is_teen || number.find('.') != number.npos ? "th"
                          : last == '1'                              ? "st"
                          : last == '2'                              ? "nd"
                          : last == '3'                              ? "rd"
                                                                     : "th";
  return std::string(person.sex == Sex::kFemale ? "woman" : "man") + " of the " + number + end +
         " percentile (ANSUR II)";
}

std::string share_folder() {
  if (const char* folder = std::getenv("PALMAR_SHARE")) return folder;
  return (program_folder().parent_path() / "share" / "palmar").string();
}

std::shared_ptr<const Hand> load_hand(const std::string& name) {
  if (name != "template") return std::make_shared<const Hand>(read_hand(name));
  const std::string path = share_folder() + "/template.hand.glb";
  if (!fs::exists(path)) {
    throw InputError("the template hand is missing: " + path +
                     " (run `palmar doctor`; it is made when Palmar is built)");
  }
  return std::make_shared<const Hand>(read_hand(path));
}

std::shared_ptr<const Hand> load_hand(const std::string& name, const std::string& tissue_file) {
  return load_hand(HandChoice{.name = name, .tissue = tissue_file, .value = nullptr});
}

std::shared_ptr<const Hand> load_hand(const HandChoice& choice) {
  auto hand = choice.value ? choice.value : load_hand(choice.name);
  if (choice.person) hand = sized_as(*hand, *choice.person);
  if (choice.is_left && hand->side == Side::kRight) {
    hand = std::make_shared<const Hand>(mirrored(*hand));
  }
  if (choice.tissue.empty()) return hand;
  auto other = std::make_shared<Hand>(*hand);
  other->tissue = read_tissue(choice.tissue, hand->tissue);
  return other;
}

}  // namespace palmar
