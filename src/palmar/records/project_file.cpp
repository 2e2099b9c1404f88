// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/project_file.h"

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/toml_section.h"

namespace palmar::records {
namespace {

constexpr std::uintmax_t kMostLogoBytes = 1'000'000;  // it stands in every page
constexpr std::size_t kMostLetters = 400;             // over the answer; more pushes it away

std::string type_of(const std::string& picture) {
  if (picture.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (picture.starts_with("\xff\xd8\xff")) return "image/jpeg";
  const std::string start = picture.substr(0, 1000);
  return start.find("<svg") != start.npos ? "image/svg+xml" : "";
}

std::string short_text(const formats::TomlSection& file, const char* key) {
  const std::string text = file.text(key).value_or("");
  if (text.size() > kMostLetters) {
    file.fail(key, "has " + std::to_string(text.size()) + " letters; at most " +
                       std::to_string(kMostLetters) + " are allowed");
  }
  return text;
}

}  // namespace

Project read_project(const std::filesystem::path& file) {
  const toml::table table = formats::parse_toml(formats::read_file(file), file.string());
  const formats::TomlSection top(file.string(), "", table);
  top.allow({"name", "author", "notes", "logo"});
  Project project{.name = short_text(top, "name"),
                  .author = short_text(top, "author"),
                  .notes = short_text(top, "notes"),
                  .logo = "",
                  .logo_type = ""};
  const std::string logo = top.text("logo").value_or("");
  if (logo.empty()) return project;
  const std::filesystem::path picture = file.parent_path() / logo;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(picture, error);
  if (error) top.fail("logo", "is \"" + logo + "\", which can't be read beside this file");
  if (size > kMostLogoBytes) {
    top.fail("logo", "is \"" + logo + "\" with " + std::to_string(size) + " bytes; at most " +
                         std::to_string(kMostLogoBytes) + " are allowed");
  }
  project.logo = formats::read_file(picture);
  project.logo_type = type_of(project.logo);
  if (project.logo_type.empty()) {
    top.fail("logo", "is \"" + logo + "\", which is no PNG, JPEG or SVG picture");
  }
  return project;
}

}  // namespace palmar::records
