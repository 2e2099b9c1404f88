// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/service.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/server/client_files.h"
#include "palmar/server/live_answer.h"
#include "palmar/server/service_routes.h"

namespace palmar::server {
namespace {

using ServiceJson = nlohmann::ordered_json;

constexpr std::string_view kApi = "/api/";

ServiceAnswer json_answer(const ServiceJson& json, int status = 200) {
  return {.status = status,
          .body = json.dump(-1, ' ', false, ServiceJson::error_handler_t::replace)};
}

ServiceAnswer shelved(const ShelvedProduct& product) {
  ServiceAnswer answer;
  answer.body = shelved_product_json(product);
  return answer;
}

/// The sides of what is asked about, in mm, for every unit that it may be in.
ServiceAnswer which_unit(const ShelvedProduct& product, const UnitQuestion& question) {
  ServiceJson choices = ServiceJson::array();
  for (const geometry::LengthUnit unit :
       {geometry::LengthUnit::kMillimetre, geometry::LengthUnit::kCentimetre,
        geometry::LengthUnit::kInch, geometry::LengthUnit::kMetre}) {
    const Vec3 sides = geometry::millimetres_per(unit) * question.sides;
    choices.push_back({{"unit", name_of(unit)}, {"sides_mm", {sides.x(), sides.y(), sides.z()}}});
  }
  return json_answer({{"error", product.file_name + " doesn't say which unit it is in"},
                      {"file_name", product.file_name},
                      {"units", std::move(choices)}},
                     409);
}

}  // namespace

ServiceAnswer refusal(int status, const std::string& message) {
  return json_answer({{"error", message}}, status);
}

Service::Service(std::string token, std::shared_ptr<ProductShelf> shelf, KeptData kept)
    : token_(std::move(token)),
      shelf_(std::move(shelf)),
      kept_(std::move(kept)),
      uploads_(std::make_shared<UploadDrawer>(shelf_->folder() / "uploads")) {
  if (kept_.jobs) {
    shelf_->set_own_hands(
        [jobs = kept_.jobs](const std::string& key) { return jobs->hand_file(key); });
  }
}

std::string Service::give(const std::filesystem::path& file,
                          std::optional<geometry::LengthUnit> unit) {
  given_.push_back(shelf_->add_file(file, unit).key);
  return given_.back();
}

std::optional<ServiceAnswer> Service::refused(const ServiceRequest& head) const {
  if (!is_own_host(head.host, at_)) {
    return refusal(403, "this server is called " + at_.address + ":" + std::to_string(at_.port) +
                            ", not " + formats::in_quotes(head.host));
  }
  if (!is_own_origin(head.origin, at_)) {
    return refusal(403, "pages of " + formats::in_quotes(head.origin) + " may not use this server");
  }
  const Target target = parse_target(head.target);
  if (!target.path.starts_with(kApi)) return std::nullopt;
  if (!is_same_secret(token_, token_of(target, head.authorization))) {
    return refusal(401,
                   "the token is missing or wrong; it stands in the URL that palmar serve "
                   "prints");
  }
  return std::nullopt;
}

std::uint64_t Service::largest_body(const ServiceRequest& head) const {
  const std::string path = parse_target(head.target).path;
  const bool is_file = path == "/api/products" || path.starts_with("/api/uploads/");
  return head.method == "POST" && is_file ? kLargestUpload : kLargestRequest;
}

ServiceAnswer Service::answer(const ServiceRequest& request, const Progress& progress) const {
  if (auto refused_as = refused(request)) return *refused_as;
  try {
    return routed(request, parse_target(request.target), progress);
  } catch (const UsageError& error) {
    return refusal(400, error.what());
  } catch (const InputError& error) {
    return refusal(422, error.what());
  } catch (const std::exception& error) {
    return refusal(500, error.what());
  }
}

ServiceAnswer Service::routed(const ServiceRequest& request, const Target& target,
                              const Progress& progress) const {
  const bool is_get = request.method == "GET";
  const bool is_post = request.method == "POST";
  if (!target.path.starts_with(kApi)) {
    return is_get ? client_file(target.path) : refusal(405, "only GET is allowed here");
  }
  if (target.path == "/api/state" && is_get) return state();
  if (target.path == "/api/products" && is_post) return add_product(request, target, progress);
  if (target.path == "/api/examples" && is_post) {
    return shelved(shelf_->add_example(target.query("name").value_or("")));
  }
  constexpr std::string_view kProducts = "/api/products/";
  if (const auto key = name_between(target.path, kProducts, "/file"); key && is_get) {
    if (const auto product = shelf_->find(*key)) {
      return {.type = "application/octet-stream",
              .body = formats::read_file(product->path),
              .file_name = product->file_name};
    }
  }
  if (const auto key = name_between(target.path, kProducts); key && is_get) {
    if (const auto product = shelf_->find(*key)) return shelved(*product);
  }
  if (kept_.projects) {
    if (auto answer = projects_answer(request, target, *shelf_, *kept_.projects)) return *answer;
  }
  if (auto answer = uploads_answer(request, target, *uploads_)) return *answer;
  if (kept_.jobs) {
    if (auto answer = hands_answer(request, target, *kept_.jobs)) return *answer;
    if (auto answer = jobs_answer(request, target, *shelf_, *kept_.jobs, *uploads_)) return *answer;
  }
  return refusal(404, formats::in_quotes(request.method + " " + target.path) + " is nothing here");
}

ServiceAnswer Service::client_file(const std::string& path) const {
  const auto file = [](std::string_view content, const char* type) {
    return ServiceAnswer{.type = type, .body = std::string(content)};
  };
  if (path == "/") return file(bench_page(), "text/html; charset=utf-8");
  if (path == "/bench.js") return file(bench_script(), "text/javascript; charset=utf-8");
  if (path == "/bench.css") return file(bench_style(), "text/css; charset=utf-8");
  if (path == "/icon.svg") return file(bench_icon(), "image/svg+xml");
  if (path == "/licence.txt") return file(bench_licence(), "text/plain; charset=utf-8");
  return refusal(404, formats::in_quotes(path) + " is nothing here");
}

ServiceAnswer Service::state() const {
  ServiceJson examples = ServiceJson::array(), given = ServiceJson::array();
  for (const ShelvedExample& one : shelved_examples()) examples.push_back(one.name);
  for (const std::string& key : given_) {
    if (const auto product = shelf_->find(key)) {
      given.push_back(ServiceJson::parse(shelved_product_json(*product)));
    }
  }
  return json_answer({{"version", version()},
                      {"colours", ServiceJson::parse(colours_json())},
                      {"examples", std::move(examples)},
                      {"given", std::move(given)},
                      {"largest_upload_bytes", kLargestUpload}});
}

ServiceAnswer Service::add_product(const ServiceRequest& request, const Target& target,
                                   const Progress& progress) const {
  std::optional<geometry::LengthUnit> unit;
  if (const auto text = target.query("unit"); text && !text->empty())
    unit = geometry::length_unit(*text);
  const ProductShelf::Added added =
      shelf_->add_bytes(target.query("name").value_or("product"), request.body, unit, progress);
  return added.question ? which_unit(added.product, *added.question) : shelved(added.product);
}

}  // namespace palmar::server
