// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/service_routes.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/records/product/cad_format.h"
#include "palmar/server/job_file.h"
#include "palmar/server/live_answer.h"
#include "palmar/server/shape_change.h"
#include "palmar/server/study_dots.h"

namespace palmar::server {
namespace {

using RouteJson = nlohmann::ordered_json;

constexpr std::string_view kProjects = "/api/projects", kJobs = "/api/jobs";

ServiceAnswer route_answer(const RouteJson& json) {
  ServiceAnswer answer;
  answer.body = json.dump(-1, ' ', false, RouteJson::error_handler_t::replace);
  return answer;
}

ServiceAnswer done() { return route_answer({{"done", true}}); }

ServiceAnswer kept_projects(const ProjectDrawer& drawer) {
  RouteJson projects = RouteJson::array();
  for (const KeptProject& one : drawer.list()) {
    projects.push_back({{"key", one.key},
                        {"file_name", one.file_name},
                        {"changed_ms", one.changed},
                        {"picture", one.picture}});
  }
  return route_answer({{"projects", std::move(projects)},
                       {"most", ProjectDrawer::kMost},
                       {"folder", drawer.folder() ? drawer.folder()->string() : ""}});
}

ServiceAnswer opened_project(const std::string& key, ProductShelf& shelf,
                             const ProjectDrawer& drawer) {
  ProjectDrawer::Opened opened = drawer.open(key);
  const ShelvedProduct product = shelf.add_known(std::move(opened.product));
  return route_answer({{"product", RouteJson::parse(shelved_product_json(product))},
                       {"state", RouteJson::parse(opened.state)},
                       {"history", RouteJson::parse(opened.history)}});
}

ServiceAnswer kept_project(const std::string& key, const ServiceRequest& request,
                           ProductShelf& shelf, ProjectDrawer& drawer) {
  const RouteJson json = RouteJson::parse(request.body, nullptr, false);
  const bool has_product =
      json.is_object() && json.contains("product") && json["product"].is_string();
  if (!has_product) throw UsageError("project: \"product\" is missing; its key is required");
  const auto product = shelf.find(json["product"].get<std::string>());
  if (!product) throw UsageError("project: its product is not there (any more)");
  drawer.keep(key, *product, request.body);
  return done();
}

ServiceAnswer job_answered(const Job& job, const JobShelf& jobs) {
  ServiceAnswer answer;
  answer.body = job_answer(job, jobs.files(job), jobs.made(job));
  return answer;
}

ServiceAnswer job_list(const JobShelf& jobs) {
  RouteJson all = RouteJson::array();
  for (const Job& one : jobs.list()) all.push_back(RouteJson::parse(job_answer(one, {}, {})));
  return route_answer({{"jobs", std::move(all)}});
}

ServiceAnswer added_job(const ServiceRequest& request, ProductShelf& shelf, JobShelf& jobs,
                        UploadDrawer& uploads) {
  const JobRequest asked = parse_job_request(request.body);
  std::vector<ShelvedProduct> products;
  for (const std::string& key : asked.products) {
    const auto product = shelf.find(key);
    if (!product)
      throw UsageError("job: product " + formats::in_quotes(key) + " is not there (any more)");
    products.push_back(*product);
  }
  const std::string& sent = asked.hand.uploads;
  if (sent.empty()) return job_answered(jobs.add(asked, products), jobs);
  try {
    const Job job = jobs.add(asked, products, uploads.folder(sent));
    uploads.forget(sent);
    return job_answered(job, jobs);
  } catch (const Error&) {
    uploads.forget(sent);  // a client sends them again
    throw;
  }
}

ServiceAnswer bytes_answer(std::string bytes) {
  return {.type = "application/octet-stream", .body = std::move(bytes)};
}

/// GET /api/jobs/KEY/shape?of=preview|result&what=before|after
ServiceAnswer shape_of_job(const Job& job, const Target& target, const JobShelf& jobs) {
  const bool is_preview = target.query("of").value_or("preview") == "preview";
  const bool is_after = target.query("what").value_or("after") == "after";
  for (const char* name : {"pressed.stl", "redesign.stl"}) {
    const auto path = is_preview ? jobs.made_file(job, std::string(kJobPreview) + "/" + name)
                                 : jobs.file(job, name);
    if (path) return bytes_answer(shape_frame(job.products.front(), is_after ? *path : ""));
  }
  // A region alone changes nothing.
  if (!is_after) return bytes_answer(shape_frame(job.products.front(), ""));
  return refusal(404, "there is no new shape (yet)");
}

/// A report is a page by itself with a script of its own, shown in a frame: it may run that, reach
/// nothing, and knows nothing of the page round it.
constexpr const char* kReportPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: "
    "blob:; font-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'; sandbox "
    "allow-scripts allow-downloads";

ServiceAnswer job_page(const Job& job, const JobShelf& jobs) {
  if (!job.has_report) return refusal(404, "there is no report yet");
  ServiceAnswer answer;
  answer.type = "text/html; charset=utf-8";
  answer.body = formats::read_file(jobs.report(job));
  answer.policy = kReportPolicy;
  return answer;
}

/// What a redesign made, as a product; Palmar writes its files in mm.
ServiceAnswer shelved_shape(const Job& job, const std::string& name, ProductShelf& shelf,
                            const JobShelf& jobs) {
  const auto path = jobs.file(job, name);
  if (!path) return refusal(404, formats::in_quotes(name) + " is none of this job's files");
  ShelvedProduct product;
  product.file_name = name;
  product.path = *path;
  product.argument = path->string();
  if (!records::is_cad_file(*path)) product.unit = geometry::LengthUnit::kMillimetre;
  ServiceAnswer answer;
  answer.body = shelved_product_json(shelf.add_known(std::move(product)));
  return answer;
}

/// GET /api/jobs/KEY...
std::optional<ServiceAnswer> read_of_job(const Job& job, const std::string& rest,
                                         const Target& target, const JobShelf& jobs) {
  if (rest.empty()) return job_answered(job, jobs);
  if (rest == "/shape" && job.request.kind == JobKind::kRedesign) {
    return shape_of_job(job, target, jobs);
  }
  if (rest == "/made") {
    const std::string name = target.query("file").value_or("");
    const auto path = jobs.made_file(job, name);
    if (!path) return refusal(404, formats::in_quotes(name) + " is none of what this job made");
    ServiceAnswer answer = bytes_answer(formats::read_file(*path));
    if (path->extension() == ".png") answer.type = "image/png";
    return answer;
  }
  if (rest == "/report") return job_page(job, jobs);
  if (rest == "/dots" && job.request.kind == JobKind::kStudy) {
    if (!job.has_report) return refusal(404, "there are no results yet");
    ServiceAnswer answer;
    answer.body = study_dots_json(jobs.store(job));
    return answer;
  }
  if (const auto name = name_between(rest, "/files/")) {
    if (const auto path = jobs.file(job, *name)) {
      return ServiceAnswer{.type = "application/octet-stream",
                           .body = formats::read_file(*path),
                           .file_name = *name};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> name_between(std::string_view path, std::string_view begin,
                                        std::string_view end) {
  if (path.size() <= begin.size() + end.size() || !path.starts_with(begin) ||
      !path.ends_with(end)) {
    return std::nullopt;
  }
  path.remove_prefix(begin.size());
  path.remove_suffix(end.size());
  if (path.find('/') != path.npos) return std::nullopt;
  return std::string(path);
}

std::optional<ServiceAnswer> projects_answer(const ServiceRequest& request, const Target& target,
                                             ProductShelf& shelf, ProjectDrawer& drawer) {
  if (target.path == kProjects && request.method == "GET") return kept_projects(drawer);
  const auto key = name_between(target.path, std::string(kProjects) + "/");
  if (!key) return std::nullopt;
  if (request.method == "GET") return opened_project(*key, shelf, drawer);
  if (request.method == "POST") return kept_project(*key, request, shelf, drawer);
  if (request.method != "DELETE") return std::nullopt;
  drawer.remove(*key);
  return done();
}

std::optional<ServiceAnswer> uploads_answer(const ServiceRequest& request, const Target& target,
                                            UploadDrawer& uploads) {
  const auto key = name_between(target.path, "/api/uploads/");
  if (!key || request.method != "POST") return std::nullopt;
  uploads.add(*key, target.query("name").value_or(""), request.body);
  return done();
}

std::optional<ServiceAnswer> hands_answer(const ServiceRequest& request, const Target& target,
                                          const JobShelf& jobs) {
  if (request.method != "GET") return std::nullopt;
  if (const auto key = name_between(target.path, "/api/hands/", "/file")) {
    const auto path = jobs.hand_file(*key);
    if (!path) return refusal(404, "hand " + formats::in_quotes(*key) + " is not there (any more)");
    return ServiceAnswer{.type = "application/octet-stream",
                         .body = formats::read_file(*path),
                         .file_name = path->filename().string()};
  }
  if (target.path != "/api/hands") return std::nullopt;
  RouteJson all = RouteJson::array();
  for (const Job& one : jobs.list()) {
    if (one.has_hand && one.state == JobState::kDone) {
      all.push_back({{"key", one.key}, {"name", one.title}, {"created_ms", one.created}});
    }
  }
  return route_answer({{"hands", std::move(all)}});
}

std::optional<ServiceAnswer> jobs_answer(const ServiceRequest& request, const Target& target,
                                         ProductShelf& shelf, JobShelf& jobs,
                                         UploadDrawer& uploads) {
  if (target.path == kJobs && request.method == "GET") return job_list(jobs);
  if (target.path == kJobs && request.method == "POST") {
    return added_job(request, shelf, jobs, uploads);
  }
  const std::string begin = std::string(kJobs) + "/";
  if (!target.path.starts_with(begin)) return std::nullopt;
  const std::size_t slash = std::min(target.path.find('/', begin.size()), target.path.size());
  const std::string key = target.path.substr(begin.size(), slash - begin.size());
  const std::string rest = target.path.substr(slash);
  const auto job = jobs.find(key);
  if (!job) return refusal(404, "job " + formats::in_quotes(key) + " is not there (any more)");
  if (request.method == "GET") return read_of_job(*job, rest, target, jobs);
  if (request.method == "DELETE" && rest.empty()) {
    jobs.remove(key);
    return done();
  }
  if (request.method == "POST" && rest == "/revise") {
    jobs.revise(key, parse_job_request(request.body));
    return job_answered(*jobs.find(key), jobs);
  }
  if (request.method == "POST" && rest == "/shelve" && target.query("product")) {
    if (job->products.empty()) return refusal(404, "this job has no product");
    ServiceAnswer answer;
    answer.body = shelved_product_json(shelf.add_known(job->products.front()));
    return answer;
  }
  if (request.method == "POST" && rest == "/shelve") {
    return shelved_shape(*job, target.query("name").value_or(""), shelf, jobs);
  }
  if (request.method != "POST" || (rest != "/start" && rest != "/cancel")) return std::nullopt;
  rest == "/start" ? jobs.start(key) : jobs.cancel(key);
  return job_answered(*jobs.find(key), jobs);
}

}  // namespace palmar::server
