// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/job_request.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"
#include "palmar/records/study/people_range.h"
#include "palmar/server/access.h"
#include "palmar/workflow/live/live_person.h"

namespace palmar::server {
namespace {

using JobJson = nlohmann::ordered_json;

constexpr std::size_t kMostJobProducts = 12;  // our choice: what a report still shows side by side
constexpr std::size_t kMostCompared = 3;      // our choice: as many pictures as one screen holds
constexpr int kMostJobHands = 2000;           // our choice: some hours on two cores
constexpr int kPreviewHands = 4;              // our choice: some seconds
constexpr std::size_t kMostVaried = 8;        // features of one search
constexpr double kReportShare = 0.15;         // of a study's time, about

[[noreturn]] void refuse_job(const std::string& member, const JobJson& value,
                             const std::string& allowed) {
  throw UsageError(
      "job: \"" + member + "\" is " +
      formats::in_quotes(value.dump(-1, ' ', false, JobJson::error_handler_t::replace)) + "; " +
      allowed + " is required");
}

JobJson member_or_null(const JobJson& json, const char* name) {
  return json.contains(name) ? json[name] : JobJson(nullptr);
}

std::optional<double> job_number(const JobJson& json, const char* name, double low, double high) {
  const JobJson value = member_or_null(json, name);
  if (value.is_null()) return std::nullopt;
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(number >= low && number <= high)) {
    refuse_job(name, value,
               "a number from " + formats::shortest(low) + " to " + formats::shortest(high));
  }
  return number;
}

std::optional<int> job_count(const JobJson& json, const char* name, int low, int high) {
  const JobJson value = member_or_null(json, name);
  if (value.is_null()) return std::nullopt;
  if (!value.is_number_integer() || value.get<double>() < low || value.get<double>() > high) {
    refuse_job(name, value,
               "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return value.get<int>();
}

std::string job_text(const JobJson& json, const char* name) {
  const JobJson value = member_or_null(json, name);
  if (value.is_null()) return "";
  if (!value.is_string()) refuse_job(name, value, "a text");
  return value.get<std::string>();
}

std::vector<std::string> job_texts(const JobJson& json, const char* name, std::size_t fewest,
                                   std::size_t most) {
  const JobJson value = member_or_null(json, name);
  const std::string allowed =
      "a list of " + std::to_string(fewest) + " to " + std::to_string(most) + " different names";
  if (!value.is_array() || value.size() < fewest || value.size() > most) {
    refuse_job(name, value, allowed);
  }
  std::vector<std::string> all;
  for (const JobJson& one : value) {
    if (!one.is_string()) refuse_job(name, value, allowed);
    all.push_back(one.get<std::string>());
    if (std::count(all.begin(), all.end(), all.back()) > 1) refuse_job(name, value, allowed);
  }
  return all;
}

/// A built-in population or people from one size to another; never a file of this machine.
void check_population(const std::string& name) {
  const bool is_range = records::is_people_range(name);
  const bool is_plain =
      !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
      std::all_of(name.begin(), name.end(), [is_range](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || (is_range && (c == ':' || c == '.'));
      });
  if (!is_plain) {
    throw UsageError("job: population " + formats::in_quotes(name) +
                     ": the name of a built-in one is required (palmar population list)");
  }
  records::population_requests(name);  // throws for unknown ends of a range
}

JobKind kind_named(const std::string& name) {
  if (name == "study") return JobKind::kStudy;
  if (name == "compare") return JobKind::kCompare;
  if (name == "redesign") return JobKind::kRedesign;
  if (name == "hand") return JobKind::kHand;
  throw UsageError("job: \"kind\" is " + formats::in_quotes(name) +
                   "; study, compare, redesign or hand is allowed");
}

std::string kind_name(JobKind kind) {
  switch (kind) {
    case JobKind::kStudy:
      return "study";
    case JobKind::kCompare:
      return "compare";
    case JobKind::kRedesign:
      return "redesign";
    case JobKind::kHand:
      return "hand";
  }
  return {};
}

void read_people(const JobJson& json, JobRequest& request) {
  request.populations = job_texts(json, "populations", 1, 4);
  bool are_drawn = false;
  for (const std::string& one : request.populations) {
    check_population(one);
    are_drawn = are_drawn || !records::is_people_range(one);
  }
  request.hands = job_count(json, "hands", 0, kMostJobHands).value_or(0);
  if (are_drawn && request.hands == 0) {
    refuse_job("hands", member_or_null(json, "hands"),
               "a whole number from 1 to " + std::to_string(kMostJobHands));
  }
  if (!are_drawn) request.hands = 0;
}

void add_task(const JobRequest& request, std::vector<std::string>& words) {
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (request.hold) add("--hold", std::to_string(*request.hold));
  if (request.grip_force) add("--grip-force-n", formats::shortest(*request.grip_force));
  if (request.mass) add("--mass-kg", formats::shortest(*request.mass));
}

void add_people(const JobRequest& request, std::vector<std::string>& words) {
  for (const std::string& one : request.populations) {
    words.insert(words.end(), {"--population", one});
  }
  if (request.hands > 0) words.insert(words.end(), {"--hands", std::to_string(request.hands)});
}

/// "fillet:face=7=2:6", "offset:sides=-2:2", "groove:at=40=1", "diameter_mm=25:45": as `palmar
/// redesign features --vary` takes it, but for the file of a groove's line.
void check_vary(const std::string& words) {
  const std::size_t equals = words.rfind('=');
  const bool is_plain =
      words.size() <= 100 && equals != std::string::npos && equals > 0 &&
      std::isalpha(static_cast<unsigned char>(words.front())) != 0 &&
      std::all_of(words.begin(), words.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("_+-=:.").find(static_cast<char>(c)) != std::string_view::npos;
      });
  const bool is_file = words.starts_with("groove:") && !words.starts_with("groove:at=");
  const std::string range = is_plain ? words.substr(equals + 1) : "";
  const std::size_t colon = std::min(range.find(':'), range.size());
  const bool has_numbers =
      formats::parse_double(range.substr(0, colon)).has_value() &&
      (colon == range.size() || formats::parse_double(range.substr(colon + 1)));
  const bool has_path = words.find("..") != std::string::npos;
  if (is_plain && !is_file && !has_path && has_numbers) return;
  throw UsageError("job: \"vary\" has " + formats::in_quotes(words) +
                   "; fillet:EDGES=1:15, offset:FACES=-2:2, taper:FACES=0:4, groove:at=40=0:2 or "
                   "a parameter as diameter_mm=25:45 is required");
}

/// "fillet:long=4" of "fillet:long=1:7"; one value stays.
std::string middle_of_range(const std::string& words) {
  const std::size_t equals = words.rfind('='), colon = words.find(':', equals);
  if (colon == std::string::npos) return words;
  const auto low = formats::parse_double(words.substr(equals + 1, colon - equals - 1));
  const auto high = formats::parse_double(words.substr(colon + 1));
  return words.substr(0, equals + 1) +
         formats::shortest((low.value_or(0.0) + high.value_or(0.0)) / 2.0);
}

void add_unit(const JobPlaces& places, std::vector<std::string>& words) {
  if (places.unit) words.insert(words.end(), {"--unit", name_of(*places.unit)});
}

std::vector<std::string> study_words(const JobRequest& request, const JobPlaces& places) {
  std::vector<std::string> words;
  for (const std::string& one : places.products) words.insert(words.end(), {"--product", one});
  add_unit(places, words);
  add_people(request, words);
  add_task(request, words);
  return words;
}

/// A shape that is just looked at is made with fewer hands, of one size, and held by none again.
std::vector<std::string> redesign_words(const JobRequest& request, const JobPlaces& places,
                                        bool is_preview) {
  JobRequest asked = request;
  if (is_preview) asked.hands = std::min(asked.hands, kPreviewHands);
  std::vector<std::string> words = {"redesign", asked.verb, places.products.front()};
  add_unit(places, words);
  add_people(asked, words);
  if (asked.hold) words.insert(words.end(), {"--hold", std::to_string(*asked.hold)});
  if (asked.largest_depth) {
    words.insert(words.end(), {"--largest-depth-mm", formats::shortest(*asked.largest_depth)});
  }
  if (asked.verb == "fillet") {
    words.insert(words.end(), {"--edges", "long"});
    const auto [low, high] = asked.radius.value_or(std::pair(1.0, 15.0));
    words.insert(words.end(),
                 {"--radius-mm",
                  is_preview ? formats::shortest(asked.preview_radius.value_or((low + high) / 2.0))
                             : formats::shortest(low) + ":" + formats::shortest(high)});
  }
  if (asked.verb == "features") {
    if (asked.vary.empty()) words.emplace_back("--propose");
    for (const std::string& one : asked.vary) {
      words.insert(words.end(), {"--vary", is_preview ? middle_of_range(one) : one});
    }
  }
  if (is_preview) {
    words.emplace_back("--no-compare");
    if (asked.verb == "press" || asked.verb == "region") words.emplace_back("--no-pictures");
  }
  return words;
}

void append(std::vector<std::string>& words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
}

}  // namespace

JobRequest parse_job_request(std::string_view text) {
  const JobJson json = JobJson::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    throw UsageError("job: " + formats::in_quotes(text.substr(0, 100)) + " is no JSON object");
  }
  JobRequest request;
  request.kind = kind_named(job_text(json, "kind"));
  const std::string language = job_text(json, "language");
  if (!language.empty()) request.language = language_named(language);
  request.hold = job_count(json, "hold", 1, 1000);
  switch (request.kind) {
    case JobKind::kStudy:
      request.products = job_texts(json, "products", 1, kMostJobProducts);
      read_people(json, request);
      break;
    case JobKind::kCompare: {
      request.products = job_texts(json, "products", 2, kMostCompared);
      request.person = job_text(json, "person");
      if (request.person.starts_with(kOwnHand)) {
        request.own_hand = request.person.substr(kOwnHand.size());
        request.person.clear();
        if (!is_plain_name(request.own_hand)) refuse_job("person", json["person"], "a hand's key");
      } else if (!request.person.empty()) {
        request.person = workflow::person_argument(workflow::parse_person_of_size(request.person));
      }
      const JobJson left = member_or_null(json, "left");
      if (!left.is_null() && !left.is_boolean()) refuse_job("left", left, "true or false");
      request.is_left = left.is_boolean() && left.get<bool>();
      break;
    }
    case JobKind::kRedesign: {
      request.products = job_texts(json, "products", 1, 1);
      read_people(json, request);
      request.verb = job_text(json, "verb");
      const bool is_known = request.verb == "press" || request.verb == "region" ||
                            request.verb == "fillet" || request.verb == "features";
      if (!is_known) {
        refuse_job("verb", member_or_null(json, "verb"), "press, region, fillet or features");
      }
      const bool has_depth = request.verb == "press" || request.verb == "region";
      if (has_depth) request.largest_depth = job_number(json, "largest_depth_mm", 0.1, 50.0);
      if (request.verb == "features" && !member_or_null(json, "vary").is_null()) {
        request.vary = job_texts(json, "vary", 0, kMostVaried);
        for (const std::string& one : request.vary) check_vary(one);
      }
      if (request.verb == "fillet") {
        request.preview_radius = job_number(json, "preview_mm", 0.1, 200.0);
      }
      const JobJson radius = member_or_null(json, "radius_mm");
      if (request.verb != "fillet" || radius.is_null()) return request;
      const bool are_two =
          radius.is_array() && radius.size() == 2 && radius[0].is_number() && radius[1].is_number();
      const double low = are_two ? radius[0].get<double>() : NAN;
      const double high = are_two ? radius[1].get<double>() : NAN;
      if (!(low >= 0.1 && low < high && high <= 200.0)) {
        refuse_job("radius_mm", radius, "two numbers from 0.1 to 200, the smaller one first,");
      }
      request.radius = {low, high};
      return request;
    }
    case JobKind::kHand:
      request.hand = parse_hand_request(json);
      return request;
  }
  request.grip_force = job_number(json, "grip_force_n", 0.1, 2000.0);
  request.mass = job_number(json, "mass_kg", 0.001, 100.0);
  return request;
}

std::string job_request_json(const JobRequest& request) {
  const auto or_null_json = [](const auto& value) {
    return value ? JobJson(*value) : JobJson(nullptr);
  };
  JobJson json = {{"kind", kind_name(request.kind)},
                  {"products", request.products},
                  {"language", std::string(name_of(request.language))},
                  {"hold", or_null_json(request.hold)}};
  if (request.kind == JobKind::kHand) {
    write_hand_request(request.hand, json);
    return json.dump(-1, ' ', false, JobJson::error_handler_t::replace);
  }
  if (request.kind != JobKind::kCompare) {
    json["populations"] = request.populations;
    json["hands"] = request.hands;
  } else {
    json["person"] =
        request.own_hand.empty() ? request.person : std::string(kOwnHand) + request.own_hand;
    json["left"] = request.is_left;
  }
  if (request.kind != JobKind::kRedesign) {
    json["grip_force_n"] = or_null_json(request.grip_force);
    json["mass_kg"] = or_null_json(request.mass);
  } else {
    json["verb"] = request.verb;
    json["largest_depth_mm"] = or_null_json(request.largest_depth);
    json["preview_mm"] = or_null_json(request.preview_radius);
    json["vary"] = request.vary;
    if (request.radius) json["radius_mm"] = {request.radius->first, request.radius->second};
  }
  return json.dump();
}

std::vector<JobCommand> commands_of(const JobRequest& request, const JobPlaces& places) {
  const std::string language(name_of(request.language));
  switch (request.kind) {
    case JobKind::kStudy: {
      const std::string store = places.folder + kJobStore;
      std::vector<std::string> run = {"study", "run"};
      append(run, study_words(request, places));
      append(run, {"--out", store});
      return {
          {std::move(run), 1.0 - kReportShare},
          {{"study", "report", store, "--out", places.folder + "report", "--language", language},
           kReportShare}};
    }
    case JobKind::kCompare: {
      std::vector<std::string> words = {"assess"};
      append(words, places.products);
      add_unit(places, words);
      if (!request.person.empty()) append(words, {"--person", request.person});
      if (!request.own_hand.empty()) append(words, {"--hand", places.hand});
      if (request.is_left) words.emplace_back("--left");
      add_task(request, words);
      append(words, {"--language", language, "--out", places.folder + "report"});
      return {{std::move(words), 1.0}};
    }
    case JobKind::kRedesign: {
      std::vector<std::string> words = redesign_words(request, places, false);
      append(words, {"--language", language, "--out", places.folder + "redesign"});
      return {{std::move(words), 1.0}};
    }
    case JobKind::kHand:
      return {{hand_words(request.hand, places.sources, places.folder, language), 1.0}};
  }
  return {};
}

bool is_tried_first(const JobRequest& request) {
  return request.kind == JobKind::kStudy || (request.kind == JobKind::kRedesign &&
                                             (request.verb != "features" || !request.vary.empty()));
}

JobCommand estimate_of(const JobRequest& request, const JobPlaces& places) {
  if (request.kind == JobKind::kRedesign) {
    std::vector<std::string> made = redesign_words(request, places, true);
    append(made, {"--out", places.folder + kJobPreview});
    return {std::move(made), 1.0};
  }
  std::vector<std::string> words = {"study", "plan"};
  append(words, study_words(request, places));
  words.emplace_back("--json");
  return {std::move(words), 1.0};
}

std::string command_text(const JobCommand& command) {
  std::string text = "palmar";
  for (const std::string& word : command.words) text += " " + shell_word(word);
  return text;
}

std::filesystem::path job_report(JobKind kind) {
  if (kind == JobKind::kHand) return std::filesystem::path(kHandFound) / "report.html";
  return kind == JobKind::kRedesign ? "redesign/report/report.html" : "report/report.html";
}

std::filesystem::path job_results(JobKind kind) {
  if (kind == JobKind::kHand) return kHandFound;
  return kind == JobKind::kRedesign ? "redesign" : "report";
}

}  // namespace palmar::server
