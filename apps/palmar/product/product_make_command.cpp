// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "product/product_make_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "output_guard.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/product/parametric_kinds.h"
#include "palmar/product/primitives.h"
#include "palmar/records/product/parameter_sweep.h"
#include "palmar/records/study/study_file.h"
#include "palmar/workflow/product_variants.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

const SettingOptions kMakeOptions = {{"files", "--out"}};

struct MakeArguments {
  std::string kind;
  /// As typed, per parameter of the kind; "": not given.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<std::string> params;  ///< name=value
  std::vector<std::string> out;
  std::string format = "step";
  double chordal_error = product::MeshFineness{}.chordal_error;  // mm
};

std::string option_of(const std::string& parameter) {
  std::string option = "--" + parameter;
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

std::string range_of(const product::KindParameter& one) {
  const std::string unit = product::unit_of_parameter(one.name);
  return fmt::format("{} to {}{}", formats::shortest(one.lowest), formats::shortest(one.highest),
                     unit.empty() ? "" : " " + unit);
}

std::string list_text() {
  std::string text;
  for (const product::ParametricKind& kind : product::parametric_kinds()) {
    text += kind.name + ": " + kind.description + "\n";
    for (const product::KindParameter& one : kind.parameters) {
      text += fmt::format("  {:<22} {:>6}  {} ({})\n", option_of(one.name),
                          formats::shortest(one.fallback), one.meaning, range_of(one));
    }
    for (const product::KindRelation& one : kind.relations) {
      text += fmt::format("  {} is at {} {}\n", one.parameter, one.is_highest ? "most" : "least",
                          one.words);
    }
  }
  return text +
         "plane: Flat slab whose upper face is z = 0 (mesh only)\n"
         "  --width-mm, --depth-mm, --thickness-mm\n";
}

Json list_json() {
  Json kinds = Json::array();
  for (const product::ParametricKind& kind : product::parametric_kinds()) {
    Json parameters = Json::array(), relations = Json::array();
    for (const product::KindParameter& one : kind.parameters) {
      parameters.push_back({{"name", one.name},
                            {"unit", product::unit_of_parameter(one.name)},
                            {"default", one.fallback},
                            {"lowest", one.lowest},
                            {"highest", one.highest},
                            {"is_whole", one.is_whole},
                            {"meaning", one.meaning}});
    }
    for (const product::KindRelation& one : kind.relations) {
      relations.push_back(
          {{"parameter", one.parameter}, {one.is_highest ? "at_most" : "at_least", one.words}});
    }
    kinds.push_back({{"kind", kind.name},
                     {"description", kind.description},
                     {"parameters", std::move(parameters)},
                     {"relations", std::move(relations)}});
  }
  return {{"kinds", std::move(kinds)}};
}

records::MadeSweep sweep_of(const MakeArguments& o) {
  records::MadeSweep sweep{o.kind, {}};
  for (const auto& [name, text] : o.options) {
    if (!text.empty()) sweep.given.emplace_back(name, records::parse_sweep(name, text));
  }
  for (const std::string& text : o.params) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos) {
      throw UsageError("--param is " + formats::in_quotes(text) +
                       "; name=value is allowed, as "
                       "diameter_mm=35 or diameter_mm=25:60:2.5");
    }
    const std::string name = text.substr(0, equals);
    sweep.given.emplace_back(name, records::parse_sweep(name, text.substr(equals + 1)));
  }
  return sweep;
}

/// A folder by its name: "handles/", or one that is there.
bool is_folder(const std::string& out) {
  return out.empty() || out.back() == '/' || fs::is_directory(out);
}

void make_variants(workflow::ProductVariantsRequest request, const Context& context) {
  request.on_note = [&context](const std::string& text) { note(context.common, text); };
  const workflow::ProductVariantsOutcome outcome =
      workflow::write_variants(request, make_progress(context.common));
  finish_progress();
  if (context.common.json) print(Json::parse(outcome.json).dump(2) + "\n");
}

void make_files(const MakeArguments& o, const Context& context) {
  const std::vector<records::MadeVariant> variants = records::variants_of(sweep_of(o));
  const bool in_folder = std::any_of(o.out.begin(), o.out.end(), is_folder);
  if (variants.size() > 1 && !in_folder) {
    throw UsageError(fmt::format(
        "the sweep makes {} products, but --out is one file, {}; a folder is allowed, as {}/",
        variants.size(), o.out.front(), fs::path(o.out.front()).stem().string()));
  }
  if (in_folder && o.out.size() > 1) {
    throw UsageError("--out " + o.out.front() + " and --out " + o.out[1] +
                     ": a folder can't be combined with other outputs; --format step,stl says "
                     "which files it gets");
  }
  workflow::ProductVariantsRequest files;
  files.chordal_error = o.chordal_error;
  if (!in_folder) {
    files.products.push_back({.name = title_of(variants.front().product),
                              .family = "",
                              .product = variants.front().product,
                              .files = o.out});
  } else {
    files.folder = o.out.front();
    files.command = context.command_line;
    for (const records::MadeVariant& one : variants) {
      workflow::ProductVariantsRequest::Entry entry;
      entry.name = o.kind + (one.suffix.empty() ? "" : " " + one.suffix);
      entry.family = one.suffix.empty() ? "" : o.kind;
      entry.product = one.product;
      entry.files = workflow::files_in_folder(files.folder, entry.name, o.format);
      files.products.push_back(std::move(entry));
    }
  }
  make_variants(std::move(files), context);
}

void make_from_list(const std::string& list, const MakeArguments& o, const Context& context) {
  if (o.out.size() != 1 || !is_folder(o.out.front())) {
    throw UsageError("--from makes several products: --out must be one folder, as products/");
  }
  workflow::ProductVariantsRequest files;
  files.chordal_error = o.chordal_error;
  files.folder = o.out.front();
  files.command = context.command_line;
  for (const records::ProductRequest& one : records::read_study_file(list).products) {
    if (!one.file.empty()) continue;  // there already
    workflow::ProductVariantsRequest::Entry entry;
    entry.name = one.name.empty() ? title_of(one.made) : one.name;
    entry.family = one.held.family;
    entry.product = one.made;
    entry.files = workflow::files_in_folder(files.folder, entry.name, o.format);
    files.products.push_back(std::move(entry));
  }
  if (files.products.empty()) throw InputError(list + ": no [[product]] with a kind");
  make_variants(std::move(files), context);
}

void add_output(CLI::App& verb, const std::shared_ptr<MakeArguments>& o) {
  verb.add_option("--out", o->out,
                  "File to write, may be given several times: .step, .stl, .obj or .ply; or a "
                  "folder, as handles/, for a sweep")
      ->allow_extra_args(false)
      ->required();
  verb.add_option("--format", o->format,
                  "With a folder: which files, as step or step,stl (also obj, ply)")
      ->capture_default_str();
  verb.add_option("--chordal-error-mm", o->chordal_error, "Largest gap between mesh and solid, mm")
      ->capture_default_str();
}

void add_kind(CLI::App& make, Context& context, const product::ParametricKind& kind) {
  const auto o = std::make_shared<MakeArguments>();
  o->kind = kind.name;
  const product::KindParameter& first = kind.parameters.front();
  CLI::App* verb = add_verb(
      make, kind.name, kind.description,
      fmt::format("palmar product make {0} {1} {2} --out {0}.step --out {0}.stl\n"
                  "         palmar product make {0} {1} {3}:{2}:{4} --out {0}s/   (a sweep)",
                  kind.name, option_of(first.name), formats::shortest(first.fallback),
                  formats::shortest(std::floor(0.8 * first.fallback)),
                  formats::shortest(std::max(1.0, std::floor(0.1 * first.fallback)))));
  o->options.reserve(kind.parameters.size());
  for (const product::KindParameter& one : kind.parameters) {
    o->options.emplace_back(one.name, "");
    verb->add_option(option_of(one.name), o->options.back().second,
                     fmt::format("{}; {}, from:to:step or a,b,c", one.meaning, range_of(one)))
        ->default_str(formats::shortest(one.fallback));
  }
  verb->add_option("--param", o->params, "The same as name=value: diameter_mm=35")
      ->allow_extra_args(false);
  add_output(*verb, o);
  verb->callback([&context, o] {
    context.setting_options = kMakeOptions;
    context.run = [&context, o] {
      make_files(*o, context);
      return 0;
    };
  });
}

void add_plane(CLI::App& make, Context& context) {
  const auto options = std::make_shared<product::PlaneProductOptions>();
  const auto out = std::make_shared<std::vector<std::string>>();
  CLI::App* verb = add_verb(make, "plane", "Flat slab whose upper face is the plane z = 0",
                            "palmar product make plane --width-mm 200 --depth-mm 100 --out p.stl");
  const auto length = [&](const char* name, double& value) {
    verb->add_option(name, value, "mm")->capture_default_str();
  };
  length("--width-mm", options->width);
  length("--depth-mm", options->depth);
  length("--thickness-mm", options->thickness);
  length("--chordal-error-mm", options->fineness.chordal_error);
  verb->add_option("--out", *out, "File to write, may be given several times: .stl, .obj or .ply")
      ->allow_extra_args(false)
      ->required();
  verb->callback([&context, options, out] {
    context.run = [&context, options, out] {
      for (const std::string& file : *out) check_shape_output(file, false);
      const product::Product product = product::make_plane_product(*options);
      for (const std::string& file : *out) {
        formats::write_mesh(file, product.mesh);
        note(context.common,
             fmt::format("wrote {} ({} triangles, unit: mm)", file, product.mesh.triangle_count()));
      }
      return 0;
    };
  });
}

}  // namespace

void add_product_make_command(CLI::App& product, Context& context) {
  CLI::App* make = add_verb(
      product, "make", "Make a product from parameters: STEP and meshes, one or a sweep",
      "palmar product make bottle --diameter-mm 66 --out bottle.step\n"
      "         palmar product make tapered_handle --diameter-mm 30:45:2.5 --out handles/\n"
      "         palmar product make --list");
  make->require_subcommand(0, 1);
  const auto o = std::make_shared<MakeArguments>();
  const auto list = std::make_shared<bool>(false);
  const auto from = std::make_shared<std::string>();
  make->add_flag("--list", *list, "All kinds with their parameters, defaults and ranges");
  make->add_option("--from", *from, "Every product with a kind in this study file (.toml)");
  make->add_option("--out", o->out, "With --from: folder to write to, as products/");
  make->add_option("--format", o->format, "With --from: which files, as step or step,stl")
      ->capture_default_str();
  for (const product::ParametricKind& kind : product::parametric_kinds())
    add_kind(*make, context, kind);
  add_plane(*make, context);
  make->callback([&context, make, o, list, from] {
    if (!make->get_subcommands().empty()) return;
    context.setting_options = kMakeOptions;
    context.run = [&context, o, list, from] {
      if (*list) {
        print(context.common.json ? list_json().dump(2) + "\n" : list_text());
      } else if (!from->empty()) {
        make_from_list(*from, *o, context);
      } else {
        std::string kinds;
        for (const std::string& name : product::parametric_kind_names()) kinds += name + ", ";
        throw UsageError("a kind of product is required: " + kinds +
                         "plane; --list shows their parameters");
      }
      return 0;
    };
  });
}

}  // namespace palmar::cli
