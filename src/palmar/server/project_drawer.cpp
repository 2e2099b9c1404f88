// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/project_drawer.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/server/access.h"

namespace palmar::server {
namespace {

using DrawerJson = nlohmann::ordered_json;

constexpr int kDrawerVersion = 1;
constexpr const char* kProjectJson = "project.json";
constexpr const char* kHistoryJson = "history.json";
constexpr const char* kProductFolder = "product";
constexpr std::size_t kLongestPicture = 60'000;  // of its data URL

std::int64_t now_ms() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

std::string drawer_text(const DrawerJson& json) {
  return json.dump(-1, ' ', false, DrawerJson::error_handler_t::replace);
}

/// Its project.json; nothing if it is none of ours.
std::optional<DrawerJson> kept_in(const std::filesystem::path& folder) {
  try {
    DrawerJson json = DrawerJson::parse(formats::read_file(folder / kProjectJson));
    if (json.at("palmar_kept") == kDrawerVersion && json.at("file_name").is_string() &&
        json.at("argument").is_string() && json.at("made_by").is_string() &&
        json.at("changed_ms").is_number_integer() && json.at("picture").is_string() &&
        json.at("state").is_object() &&
        safe_file_name(json["file_name"].get<std::string>()) == json["file_name"]) {
      return json;
    }
  } catch (const Error&) {
  } catch (const DrawerJson::exception&) {
  }
  return std::nullopt;
}

}  // namespace

ProjectDrawer::ProjectDrawer(std::optional<std::filesystem::path> folder)
    : folder_(std::move(folder)) {}

std::filesystem::path ProjectDrawer::place(const std::string& key) const {
  if (!is_plain_name(key)) {
    throw UsageError("project " + formats::in_quotes(key) +
                     ": letters, digits, - and _ are allowed, 1 to 64 of them");
  }
  if (!folder_) {
    throw OutputError("neither XDG_DATA_HOME nor HOME says where to keep projects");
  }
  return *folder_ / key;
}

std::vector<KeptProject> ProjectDrawer::list() const {
  std::vector<KeptProject> all;
  if (!folder_) return all;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(*folder_, error)) {
    const std::string key = entry.path().filename().string();
    if (!is_plain_name(key)) continue;
    if (const auto json = kept_in(entry.path())) {
      all.push_back({key, json->at("file_name"), json->at("changed_ms"), json->at("picture")});
    }
  }
  std::sort(all.begin(), all.end(), [](const KeptProject& a, const KeptProject& b) {
    return std::pair(b.changed, a.key) < std::pair(a.changed, b.key);
  });
  return all;
}

void ProjectDrawer::keep(const std::string& key, const ShelvedProduct& product,
                         std::string_view content) {
  const std::scoped_lock lock(mutex_);
  const std::filesystem::path folder = place(key);
  const DrawerJson json = DrawerJson::parse(content, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains("state") ||
      !json["state"].is_object()) {
    throw UsageError("project: an object with \"state\" is required");
  }
  std::string picture;
  if (json.contains("picture") && json["picture"].is_string()) picture = json["picture"];
  if (!picture.starts_with("data:image/") || picture.size() > kLongestPicture) picture.clear();
  const bool is_new = !kept_in(folder).has_value();
  const std::filesystem::path file = folder / kProductFolder / product.file_name;
  formats::create_folder(file.parent_path());
  if (!std::filesystem::exists(file)) formats::write_file(file, formats::read_file(product.path));
  if (json.contains("history"))
    formats::write_file(folder / kHistoryJson, drawer_text(json["history"]));
  const DrawerJson kept = {
      {"palmar_kept", kDrawerVersion},
      {"file_name", product.file_name},
      {"argument", product.argument},
      {"unit", product.unit ? DrawerJson(name_of(*product.unit)) : DrawerJson(nullptr)},
      {"made_by", product.made_by},
      {"changed_ms", now_ms()},
      {"picture", picture},
      {"state", json["state"]}};
  formats::write_file(folder / kProjectJson, drawer_text(kept));
  if (is_new) remove_oldest();
}

void ProjectDrawer::remove_oldest() {
  const std::vector<KeptProject> all = list();
  for (std::size_t k = kMost; k < all.size(); ++k) {
    std::error_code ignored;
    std::filesystem::remove_all(*folder_ / all[k].key, ignored);
  }
}

ProjectDrawer::Opened ProjectDrawer::open(const std::string& key) const {
  const std::filesystem::path folder = place(key);
  const auto json = kept_in(folder);
  if (!json) throw UsageError("project " + formats::in_quotes(key) + " is not there (any more)");
  Opened opened;
  ShelvedProduct& product = opened.product;
  product.file_name = json->at("file_name");
  product.argument = json->at("argument");
  product.made_by = json->at("made_by");
  product.path = folder / kProductFolder / product.file_name;
  if (json->at("unit").is_string()) product.unit = geometry::length_unit(json->at("unit"));
  if (!std::filesystem::is_regular_file(product.path)) {
    throw InputError(product.path.string() + ": the project's product is not there (any more)");
  }
  opened.state = drawer_text(json->at("state"));
  opened.history = "null";
  try {
    const DrawerJson history = DrawerJson::parse(formats::read_file(folder / kHistoryJson));
    opened.history = drawer_text(history);
  } catch (const std::exception&) {
    // The steps are gone; what stood on the bench is here.
  }
  return opened;
}

void ProjectDrawer::remove(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  const std::filesystem::path folder = place(key);
  if (!kept_in(folder))
    throw UsageError("project " + formats::in_quotes(key) + " is not there (any more)");
  // Without it the folder counts for nothing, whatever happens to the rest.
  std::error_code ignored;
  std::filesystem::remove(folder / kProjectJson, ignored);
  std::filesystem::remove_all(folder, ignored);
}

}  // namespace palmar::server
