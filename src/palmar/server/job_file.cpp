// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/job_file.h"

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/server/access.h"

namespace palmar::server {
namespace {

using JobFileJson = nlohmann::ordered_json;

constexpr int kJobFileVersion = 1;

std::string job_dump(const JobFileJson& json) {
  return json.dump(-1, ' ', false, JobFileJson::error_handler_t::replace);
}

std::optional<JobState> job_state_named(const std::string& name) {
  for (int s = 0; s <= static_cast<int>(JobState::kDone); ++s) {
    const auto state = static_cast<JobState>(s);
    if (name_of(state) == name) return state;
  }
  return std::nullopt;
}

JobFileJson seconds_or_null(const std::optional<double>& value) {
  return value ? JobFileJson(*value) : JobFileJson(nullptr);
}

}  // namespace

void write_job(const std::filesystem::path& folder, const Job& job) {
  JobFileJson products = JobFileJson::array();
  for (const ShelvedProduct& one : job.products) {
    products.push_back({{"file_name", one.file_name},
                        {"argument", one.argument},
                        {"unit", one.unit ? JobFileJson(name_of(*one.unit)) : JobFileJson(nullptr)},
                        {"made_by", one.made_by}});
  }
  formats::create_folder(folder);
  formats::write_file(folder / kJobJson,
                      job_dump({{"palmar_job", kJobFileVersion},
                                {"title", job.title},
                                {"request", JobFileJson::parse(job_request_json(job.request))},
                                {"products", std::move(products)},
                                {"created_ms", job.created},
                                {"state", std::string(name_of(job.state))},
                                {"message", job.message},
                                {"estimate_seconds", seconds_or_null(job.estimate_seconds)},
                                {"grasps", job.grasps},
                                {"commands", job.commands}}));
}

std::optional<Job> read_job(const std::filesystem::path& folder) {
  try {
    const JobFileJson json = JobFileJson::parse(formats::read_file(folder / kJobJson));
    if (json.at("palmar_job") != kJobFileVersion) return std::nullopt;
    Job job;
    job.title = json.at("title");
    job.request = parse_job_request(json.at("request").dump());
    for (const JobFileJson& one : json.at("products")) {
      ShelvedProduct product;
      product.file_name = one.at("file_name");
      if (safe_file_name(product.file_name) != product.file_name) return std::nullopt;
      product.argument = one.at("argument");
      product.made_by = one.at("made_by");
      if (one.at("unit").is_string()) product.unit = geometry::length_unit(one.at("unit"));
      product.path =
          folder / "products" / std::to_string(job.products.size() + 1) / product.file_name;
      job.products.push_back(std::move(product));
    }
    if (job.products.size() != job.request.products.size()) return std::nullopt;
    job.created = json.at("created_ms");
    const auto state = job_state_named(json.at("state"));
    if (!state) return std::nullopt;
    job.state = *state;
    job.message = json.at("message");
    if (json.at("estimate_seconds").is_number()) job.estimate_seconds = json["estimate_seconds"];
    job.grasps = json.at("grasps");
    job.commands = json.at("commands").get<std::vector<std::string>>();
    return job;
  } catch (const Error&) {
  } catch (const JobFileJson::exception&) {
  }
  return std::nullopt;
}

std::optional<SaidProgress> progress_in(const std::string& line) {
  constexpr std::string_view kBegin = "progress ";
  if (!line.starts_with(kBegin)) return std::nullopt;
  const std::size_t space = std::min(line.find(' ', kBegin.size()), line.size());
  const auto share = formats::parse_double(line.substr(kBegin.size(), space - kBegin.size()));
  if (!share || !(*share >= 0.0 && *share <= 1.0)) return std::nullopt;
  return SaidProgress{*share, line.substr(std::min(space + 1, line.size()))};
}

StudyEstimateWords study_estimate_in(std::string_view json) {
  StudyEstimateWords words;
  // The two members that are wanted stand on lines of their own.
  const auto number_at = [](std::string_view line, std::string_view name) -> std::optional<double> {
    if (!line.starts_with(name)) return std::nullopt;
    line.remove_prefix(name.size());
    if (line.ends_with(',')) line.remove_suffix(1);
    return formats::parse_double(std::string(line));
  };
  while (!json.empty()) {
    const std::size_t end = std::min(json.find('\n'), json.size());
    const std::string_view line = json.substr(0, end);
    if (const auto seconds = number_at(line, "  \"estimated_seconds\": ")) words.seconds = seconds;
    if (const auto grasps = number_at(line, "  \"grasps\": ")) {
      words.grasps = static_cast<std::int64_t>(*grasps);
    }
    json.remove_prefix(std::min(end + 1, json.size()));
  }
  return words;
}

std::string job_answer(const Job& job, const std::vector<std::string>& files,
                       const std::vector<std::string>& made) {
  const JobFileJson request = JobFileJson::parse(job_request_json(job.request));
  JobFileJson products = JobFileJson::array();
  for (const ShelvedProduct& one : job.products) products.push_back(one.file_name);
  return job_dump({{"key", job.key},
                   {"kind", request["kind"]},
                   {"title", job.title},
                   {"request", request},
                   {"product_files", std::move(products)},
                   {"created_ms", job.created},
                   {"state", std::string(name_of(job.state))},
                   {"message", job.message},
                   {"estimate_seconds", seconds_or_null(job.estimate_seconds)},
                   {"grasps", job.grasps},
                   {"share", job.share},
                   {"doing", job.doing},
                   {"commands", job.commands},
                   {"has_report", job.has_report},
                   {"has_preview", job.has_preview},
                   {"has_hand", job.has_hand},
                   {"files", files},
                   {"made", made}});
}

}  // namespace palmar::server
