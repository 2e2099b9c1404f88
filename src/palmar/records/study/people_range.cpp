// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/people_range.h"

#include <charconv>

#include "palmar/core/error.h"

namespace palmar::records {
namespace {

constexpr const char* kSmallToLarge = "small-to-large";
constexpr double kLowest = 1.0, kHighest = 99.0, kMiddle = 50.0;  // percentiles

struct End {
  bool is_woman = false;
  double percentile = 0.0;
};

[[noreturn]] void fail(const std::string& words) {
  throw UsageError("population \"" + words +
                   "\": people from one size to another are woman:P5..woman:P95, "
                   "man:P5..man:P95 or woman:P5..man:P95, percentiles from 1 to 99, the smaller "
                   "first");
}

End end_of(const std::string& text, const std::string& words) {
  End end;
  const std::size_t colon = text.find(":P");
  const std::string sex = text.substr(0, colon);
  end.is_woman = sex == "woman";
  if (colon == text.npos || (!end.is_woman && sex != "man")) fail(words);
  const char* const last = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + colon + 2, last, end.percentile);
  if (error != std::errc() || stop != last || !(end.percentile >= kLowest) ||
      !(end.percentile <= kHighest)) {
    fail(words);
  }
  return end;
}

PopulationRequest people(bool are_women, const std::vector<double>& percentiles) {
  PopulationRequest request = population_request(are_women ? "ansur2_women" : "ansur2_men");
  request.sampling.design = population::SamplingDesign::kPercentiles;
  request.sampling.percentiles = percentiles;
  request.sampling.residuals = false;
  return request;
}

}  // namespace

bool is_people_range(const std::string& words) {
  return words == kSmallToLarge || words.find(":P") != words.npos;
}

std::vector<PopulationRequest> population_requests(const std::string& words) {
  if (!is_people_range(words)) return {population_request(words)};
  const std::string range = words == kSmallToLarge ? "woman:P5..man:P95" : words;
  const std::size_t dots = range.find("..");
  if (dots == range.npos) {
    const End one = end_of(range, words);
    return {people(one.is_woman, {one.percentile})};
  }
  const End first = end_of(range.substr(0, dots), words);
  const End last = end_of(range.substr(dots + 2), words);
  if (!first.is_woman && last.is_woman) fail(words);
  if (first.is_woman == last.is_woman) {
    if (!(first.percentile < last.percentile)) fail(words);
    std::vector<double> percentiles = {first.percentile};
    if (first.percentile < kMiddle && last.percentile > kMiddle) percentiles.push_back(kMiddle);
    percentiles.push_back(last.percentile);
    return {people(first.is_woman, percentiles)};
  }
  std::vector<double> women = {first.percentile}, men;
  if (first.percentile < kMiddle) women.push_back(kMiddle);
  if (last.percentile > kMiddle) men.push_back(kMiddle);
  men.push_back(last.percentile);
  return {people(true, women), people(false, men)};
}

}  // namespace palmar::records
