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

namespace palmar::workflow {

namespace fs = std::filesystem;

namespace {

const population::Population& people_of(grasp::Sex sex) {
  return population::population_named(sex == grasp::Sex::kFemale ? "ansur2_women" : "ansur2_men");
}

std::shared_ptr<const hand::Hand> sized_as(const hand::Hand& base, const PersonOfSize& person) {
  person.check();
  population::SamplingOptions sampling;
  sampling.design = population::SamplingDesign::kPercentiles;
  sampling.percentiles = {person.percentile};
  const std::vector<population::HandSample> samples =
      population::sample_hands(people_of(person.sex), sampling);
  auto hand =
      std::make_shared<hand::Hand>(hand::make_hand_instance(base, samples.front().dimensions).hand);
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
  return std::string(person.sex == grasp::Sex::kFemale ? "woman" : "man") + " of the " + number +
         end + " percentile (ANSUR II)";
}

std::string share_folder() {
  if (const char* folder = std::getenv("PALMAR_SHARE")) return folder;
  return (program_folder().parent_path() / "share" / "palmar").string();
}

std::shared_ptr<const hand::Hand> load_hand(const std::string& name) {
  if (name != "template") return std::make_shared<const hand::Hand>(records::read_hand(name));
  const std::string path = share_folder() + "/template.hand.glb";
  if (!fs::exists(path)) {
    throw InputError("the template hand is missing: " + path +
                     " (run `palmar doctor`; it is made when Palmar is built)");
  }
  return std::make_shared<const hand::Hand>(records::read_hand(path));
}

std::shared_ptr<const hand::Hand> load_hand(const std::string& name,
                                            const std::string& tissue_file) {
  return load_hand(HandChoice{.name = name, .tissue = tissue_file, .value = nullptr});
}

std::shared_ptr<const hand::Hand> load_hand(const HandChoice& choice) {
  auto hand = choice.value ? choice.value : load_hand(choice.name);
  if (choice.person) hand = sized_as(*hand, *choice.person);
  if (choice.is_left && hand->side == hand::Side::kRight) {
    hand = std::make_shared<const hand::Hand>(hand::mirrored(*hand));
  }
  if (choice.tissue.empty()) return hand;
  auto other = std::make_shared<hand::Hand>(*hand);
  other->tissue = records::read_tissue(choice.tissue, hand->tissue);
  return other;
}

}  // namespace palmar::workflow
