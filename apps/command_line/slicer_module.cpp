// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "slicer_module.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <regex>
#include <string_view>

#include "cli.h"
#include "help_pages.h"
#include "palmar/core/version.h"
#include "palmar/formats/text_scan.h"

namespace palmar::cli {
namespace {

constexpr const char* kAsUsual = "(default)";  // of a choice that a panel needn't make
bool is_panel_open = false;

/// Names of formats in help texts, and the ends of their files.
struct Format {
  const char* word;
  const char* ends;
};
constexpr std::array kFormats = {
    Format{"STL", ".stl"},
    Format{".stl", ".stl"},
    Format{"OBJ", ".obj"},
    Format{".obj", ".obj"},
    Format{"PLY", ".ply"},
    Format{".ply", ".ply"},
    Format{"3MF", ".3mf"},
    Format{"GLB", ".glb"},
    Format{"glTF", ".glb,.gltf"},
    Format{".glb", ".glb"},
    Format{"STEP", ".step,.stp"},
    Format{".step", ".step"},
    Format{"IGES", ".iges,.igs"},
    Format{"CSV", ".csv"},
    Format{".csv", ".csv"},
    Format{"TOML", ".toml"},
    Format{".toml", ".toml"},
    Format{"JSON", ".json"},
    Format{".json", ".json"},
    Format{".palmar file", ".palmar"},
    Format{".palmar-project", ".palmar-project"},
    Format{".png", ".png"},
    Format{".jpg", ".jpg,.jpeg"},
    Format{".svg", ".svg"},
    Format{".nii", ".nii,.nii.gz"},
    Format{"C3D", ".c3d"},
    Format{"VTP", ".vtp"},
};

enum class Kind { kFlag, kChoice, kInteger, kNumber, kFile, kFolder, kText };

struct Parameter {
  const CLI::Option* option = nullptr;
  Kind kind = Kind::kText;
  bool is_output = false, is_repeated = false;
  std::string negative;              ///< "no-error-band": given to turn a thing off
  std::vector<std::string> choices;  ///< of kChoice
  std::optional<std::pair<std::string, std::string>> range;
};

bool has(const std::string& text, const char* pattern) {
  return std::regex_search(text, std::regex(pattern));
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at = text.find(separator); at != std::string::npos;
       at = text.find(separator, from)) {
    parts.push_back(text.substr(from, at - from));
    from = at + 1;
  }
  parts.push_back(text.substr(from));
  return parts;
}

/// "[template]" and "\"mm\"" as the parser prints a list's or a text's default.
std::string default_of(const CLI::Option& option) {
  std::string text = option.get_default_str();
  if (text.size() >= 2 && text.front() == '[' && text.back() == ']') {
    text = text.substr(1, text.size() - 2);
  }
  text.erase(std::remove(text.begin(), text.end(), '"'), text.end());
  return text;
}

/// What a help text says of the value: the parser itself knows texts and numbers only.
Kind kind_of_text(const CLI::Option& option, const std::string& about) {
  if (has(about, "^Folder")) return Kind::kFolder;
  // Where a file is one of several things that may be given, its name is typed.
  if (!default_of(option).empty() || has(about, "^\"template\"|, or |; or a |or a name")) {
    return Kind::kText;
  }
  if (has(about,
          "^Files?[ :]|^[A-Z]\\w+ file|file to write|^(CSV|Mesh|Picture|TOML|OBJ)\\b|"
          "\\*\\.[a-z]")) {
    return Kind::kFile;
  }
  return Kind::kText;
}

std::optional<Parameter> parameter_of(const CLI::Option& option) {
  const std::string& about = option.get_description();
  Parameter one;
  one.option = &option;
  one.is_output = option.check_lname("out") || has(about, "to write");
  if (option.get_items_expected_max() == 0) {
    one.kind = Kind::kFlag;
    // "--refine,--no-refine{false}": on unless the second is given.
    for (const std::string& name : option.get_fnames()) one.negative = name;
    return one;
  }
  one.is_repeated = option.get_expected_max() > 1;
  if (one.is_repeated && option.nonpositional() && has(about, "[A-Z],[A-Z]|_MM,")) return {};
  const std::string type = option.get_type_name();  // "FLOAT:FLOAT in [0 - 1]", "TEXT:{inp,stl}"
  std::smatch found;
  if (std::regex_search(type, found, std::regex("\\{(.*)\\}")) && !one.is_repeated) {
    one.kind = Kind::kChoice;
    one.choices = split(found[1], ',');
    return one;
  }
  if (type.rfind("TEXT", 0) == 0) {
    one.kind = kind_of_text(option, about);
    return one;
  }
  // A number without a default may be left out; a panel's fields for numbers can't be empty.
  if (one.is_repeated || default_of(option).empty() || option.get_items_expected_max() > 1) {
    return one;
  }
  const bool is_whole = type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0;
  one.kind = is_whole ? Kind::kInteger : Kind::kNumber;
  if (std::regex_search(type, found, std::regex("in \\[(.*) - (.*)\\]"))) {
    one.range = {found[1], found[2]};
  }
  return one;
}

const char* element_of(Kind kind) {
  switch (kind) {
    case Kind::kFlag:
      return "boolean";
    case Kind::kChoice:
      return "string-enumeration";
    case Kind::kInteger:
      return "integer";
    case Kind::kNumber:
      return "double";
    case Kind::kFile:
      return "file";
    case Kind::kFolder:
      return "directory";
    case Kind::kText:
      break;
  }
  return "string";
}

std::string underscored(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::tolower(c));
  });
  return name;
}

/// "grip_force_n" -> "Grip force, N".
std::string label_of(const std::string& name) {
  struct Unit {
    const char* end;
    const char* unit;
  };
  static constexpr std::array kUnits = {
      Unit{"_g_cm3", "g/cm3"}, Unit{"_n_mm", "N mm"}, Unit{"_mm", "mm"}, Unit{"_kg", "kg"},
      Unit{"_deg", "deg"},     Unit{"_kpa", "kPa"},   Unit{"_mb", "MB"}, Unit{"_px", "px"},
      Unit{"_n", "N"},         Unit{"_s", "s"},       Unit{"_g", "g"}};
  std::string label = name, unit;
  for (const auto& [end, known] : kUnits) {
    if (!label.ends_with(end)) continue;
    label.resize(label.size() - std::string_view(end).size());
    unit = std::string(", ") + known;
    break;
  }
  std::replace(label.begin(), label.end(), '_', ' ');
  label.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(label.front())));
  return label + unit;
}

std::string extensions_of(const std::string& about) {
  std::string ends;
  for (const auto& [word, format_ends] : kFormats) {
    if (about.find(word) == std::string::npos) continue;
    for (const std::string& end : split(format_ends, ',')) {
      if (("," + ends + ",").find("," + end + ",") != std::string::npos) continue;
      ends += (ends.empty() ? "" : ",") + end;
    }
  }
  return ends;
}

/// One element. `name` is the option's or argument's, `place` its flag or index.
std::string element(const Parameter& one, const std::string& name, const std::string& place) {
  std::string about = one.option->get_description();
  if (!one.negative.empty()) about = "Turned off: " + about;
  const char* const tag = element_of(one.kind);
  std::string attributes;
  const std::string ends = one.kind == Kind::kFile ? extensions_of(about) : "";
  if (!ends.empty()) attributes += " fileExtensions=\"" + ends + "\"";
  if (one.is_repeated && one.option->nonpositional() && one.kind != Kind::kChoice) {
    attributes += " multiple=\"true\"";
  }
  std::string text = fmt::format(
      "    <{}{}>\n      <name>{}</name>\n      {}\n      <description>{}</description>\n"
      "      <label>{}</label>\n",
      tag, attributes, name, place, formats::xml_escaped(about),
      formats::xml_escaped(label_of(name)));
  std::string initial = default_of(*one.option);
  if (one.kind == Kind::kFlag) initial = "false";
  if (one.kind == Kind::kChoice && initial.empty()) initial = kAsUsual;
  if (!initial.empty())
    text += fmt::format("      <default>{}</default>\n", formats::xml_escaped(initial));
  if (one.kind == Kind::kFile || one.kind == Kind::kFolder) {
    text += fmt::format("      <channel>{}</channel>\n", one.is_output ? "output" : "input");
  }
  if (one.kind == Kind::kChoice) {
    if (initial == kAsUsual) text += fmt::format("      <element>{}</element>\n", kAsUsual);
    for (const std::string& choice : one.choices) {
      text += fmt::format("      <element>{}</element>\n", formats::xml_escaped(choice));
    }
  }
  if (one.range) {
    text += fmt::format(
        "      <constraints>\n        <minimum>{}</minimum>\n        <maximum>{}</maximum>\n"
        "        <step>{}</step>\n      </constraints>\n",
        one.range->first, one.range->second, one.kind == Kind::kInteger ? "1" : "0.1");
  }
  return text + fmt::format("    </{}>\n", tag);
}

std::string elements_of_option(const CLI::Option& option) {
  if (option.get_lnames().empty() || option.check_lname("help") || option.check_lname("json")) {
    return {};
  }
  const auto one = parameter_of(option);
  if (!one) return {};
  const std::string name =
      underscored(one->negative.empty() ? option.get_lnames().front() : one->negative);
  return element(*one, name, "<longflag>" + name + "</longflag>");
}

std::string elements_of_arguments(const CLI::App& verb) {
  std::string text;
  int index = 0;
  for (const CLI::Option* option : verb.get_options(nullptr)) {
    if (!option->get_positional()) continue;
    const auto one = parameter_of(*option);
    const std::string name = underscored(option->get_name(true));
    const auto at = [&] { return fmt::format("<index>{}</index>", index++); };
    text += element(*one, name, at());
    if (one->is_repeated) text += element(*one, name + "_2", at());  // to compare with, or empty
  }
  return text;
}

std::string group_element(const std::string& label, bool is_advanced, const std::string& elements) {
  if (elements.empty()) return {};
  return fmt::format(
      "  <parameters{}>\n    <label>{}</label>\n    <description>{}</description>\n{}"
      "  </parameters>\n",
      is_advanced ? " advanced=\"true\"" : "", formats::xml_escaped(label),
      formats::xml_escaped(label), elements);
}

std::string title_of(std::string words) {
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words;
}

}  // namespace

std::string module_description(const CLI::App& verb) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<executable>\n"
      "  <category>Ergonomics.Palmar</category>\n  <title>{}</title>\n"
      "  <description>{}</description>\n  <version>{}</version>\n"
      "  <documentation-url></documentation-url>\n  <license>Apache-2.0</license>\n"
      "  <contributor>The Palmar authors</contributor>\n",
      formats::xml_escaped(title_of(full_name(verb))), formats::xml_escaped(verb.get_description()),
      version());
  text += group_element("What it works on", false, elements_of_arguments(verb));
  for (const std::string& group : option_groups(verb)) {
    std::string elements;
    for (const CLI::Option* option : options_in_group(verb, group)) {
      elements += elements_of_option(*option);
    }
    const bool is_first = group == "Start here" || group == "Options";
    text += group_element(group, !is_first, elements);
  }
  const CLI::App* root = &verb;
  while (root->get_parent() != nullptr) root = root->get_parent();
  std::string elements;
  for (const char* const name : {"--threads", "--seed", "--quiet"}) {
    elements += elements_of_option(*root->get_option(name));
  }
  return text + group_element("Of every command", true, elements) + "</executable>\n";
}

void add_descriptions(CLI::App& app) {
  for (CLI::App* sub : app.get_subcommands(nullptr)) {
    if (!sub->get_subcommands(nullptr).empty()) {
      add_descriptions(*sub);
      continue;
    }
    sub->add_flag_callback("--xml",
                           [sub] {
                             std::fputs(module_description(*sub).c_str(), stdout);
                             throw CLI::Success();
                           })
        ->group("");
  }
}

bool is_module() {
  const char* const wanted = std::getenv("PALMAR_PROGRESS");
  return wanted != nullptr && std::string_view(wanted) == "filter";
}

std::vector<std::string> module_words(const std::vector<std::string>& words) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string word = words[i];
    if (word.empty()) continue;
    if (word.rfind("--", 0) == 0) {
      std::replace(
          word.begin(),
          word.begin() + static_cast<std::ptrdiff_t>(std::min(word.find('='), word.size())), '_',
          '-');
      const bool is_left_out =
          i + 1 < words.size() && (words[i + 1].empty() || words[i + 1] == kAsUsual);
      if (is_left_out) {
        ++i;
        continue;
      }
    }
    kept.push_back(std::move(word));
  }
  return kept;
}

void print_panel_progress(double share, const std::string& activity) {
  if (!is_panel_open) {
    std::printf(
        "<filter-start><filter-name>palmar</filter-name><filter-comment>%s</filter-comment>"
        "</filter-start>\n",
        formats::xml_escaped(activity).c_str());
    is_panel_open = true;
  }
  std::printf("<filter-progress>%.4f</filter-progress>\n", share);
}

void finish_panel() {
  if (!is_panel_open) return;
  std::fputs("<filter-end></filter-end>\n", stdout);
  std::fflush(stdout);
  is_panel_open = false;
}

}  // namespace palmar::cli
