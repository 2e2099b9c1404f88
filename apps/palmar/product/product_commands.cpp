// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli.h"
#include "output_guard.h"
#include "palmar/core/error.h"
#include "palmar/product/intake/check.h"
#include "palmar/product/intake/repair.h"
#include "palmar/workflow/product_files.h"
#include "product/cad_arguments.h"
#include "product/product_cad_text.h"
#include "product/product_make_command.h"
#include "product/product_parts_command.h"
#include "product/product_repair_command.h"
#include "text.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

Json check_json(const product::Product& product, const product::ProductCheck& check) {
  Json findings = Json::array();
  for (const product::Finding& finding : check.findings) {
    findings.push_back({{"severity", name_of(finding.severity)}, {"text", finding.text}});
  }
  const auto vector = [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
  return {{"product", product.name},
          {"source", product.source},
          {"verdict", name_of(check.verdict)},
          {"triangles", check.triangles},
          {"vertices", check.vertices},
          {"parts", check.parts},
          {"tiny_parts", check.tiny_parts},
          {"is_closed", check.is_closed},
          {"boundary_edges", check.boundary_edges},
          {"holes", check.holes},
          {"non_manifold_edges", check.non_manifold_edges},
          {"flipped_triangles", check.flipped_triangles},
          {"crossing_pairs", check.crossing_pairs},
          {"euler_number", check.euler_number},
          {"is_too_big", check.is_too_big},
          {"is_too_small", check.is_too_small},
          {"size_mm", vector(check.size)},
          {"principal_extent_mm", vector(check.extent)},
          {"area_mm2", check.area},
          {"volume_mm3", check.volume},
          {"findings", std::move(findings)},
          {"fixes", product::fix_list(check, product::repair_limits({}, check.size.norm()))}};
}

std::string check_text(const product::Product& product, const product::ProductCheck& check) {
  std::string text = fmt::format(
      "{}: {} triangles, {} vertices, {} part{}\n"
      "size {:.1f} x {:.1f} x {:.1f} mm, area {:.0f} mm2, volume {}, Euler number {}\n",
      product.source, check.triangles, check.vertices, check.parts, check.parts == 1 ? "" : "s",
      check.size.x(), check.size.y(), check.size.z(), check.area, volume_text(check.volume),
      check.euler_number);
  for (const product::Finding& finding : check.findings) {
    text += fmt::format("{:<8} {}\n", name_of(finding.severity), finding.text);
  }
  for (const std::string& fix :
       product::fix_list(check, product::repair_limits({}, check.size.norm()))) {
    text += "fix      " + fix + "\n";
  }
  return text + "verdict: " + name_of(check.verdict) + "\n";
}

struct FileArguments {
  std::string product, unit, out;
  CadArguments cad;
};

constexpr const char* kProductHelp = "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES";

int inspect(const FileArguments& o, const Context& context, bool fails_on_error) {
  const auto [product, check, read, kernel] = workflow::inspect_product(
      {.file = o.product, .reading = o.cad.options(o.unit), .asks_kernel = fails_on_error},
      make_progress(context.common));
  Json cad;
  std::string text;
  std::string fault;  // that the CAD kernel finds
  if (read) {
    text = cad_text(*read, o.unit);
    cad = cad_json(*read);
  }
  if (kernel) {
    text += verdict_text(*kernel);
    cad["kernel"] = verdict_json(*kernel);
    if (!kernel->is_good()) {
      fault = kernel->findings.empty() ? "no valid closed solid" : kernel->findings.front();
    }
  }
  for (const std::string& line : product.notes) note(context.common, line);
  if (context.common.json) {
    Json json = check_json(product, check);
    if (read) json["cad"] = std::move(cad);
    print(json.dump(2) + "\n");
  } else {
    print(check_text(product, check) + text);
  }
  if (fails_on_error && check.verdict >= product::Severity::kWarning) {
    throw CheckFailed(o.product + ": " + check.findings.front().text);
  }
  if (!fault.empty()) throw CheckFailed(o.product + ": " + fault);
  return 0;
}

void add_inspection(CLI::App& noun, Context& context, const std::string& name,
                    const std::string& description, bool fails_on_error) {
  const auto o = std::make_shared<FileArguments>();
  CLI::App* verb = add_verb(noun, name, description, "palmar product " + name + " handle.step");
  verb->add_option("PRODUCT", o->product, kProductHelp)->required();
  verb->add_option("--unit", o->unit, "Unit of a file that carries none: mm, cm, m, inch");
  o->cad.add_to(*verb);
  verb->callback([&context, o, fails_on_error] {
    context.run = [&context, o, fails_on_error] { return inspect(*o, context, fails_on_error); };
  });
}

int convert(const FileArguments& o, const Context& context) {
  check_shape_output(o.out, true);
  refuse_same_file(o.product, o.out);
  const workflow::ConvertRequest request{
      .file = o.product,
      .out = o.out,
      .reading = o.cad.options(o.unit),
      .note = [&context](const std::string& text) { note(context.common, text); }};
  workflow::convert_product(request, make_progress(context.common));
  note(context.common, "wrote " + o.out + " (unit: mm)");
  return 0;
}

void add_convert(CLI::App& noun, Context& context) {
  const auto o = std::make_shared<FileArguments>();
  CLI::App* verb =
      add_verb(noun, "convert", "Convert to another format, in mm, welded and oriented",
               "palmar product convert handle.step --out handle.stl");
  verb->add_option("PRODUCT", o->product, kProductHelp)->required();
  verb->add_option("--unit", o->unit, "Unit of a file that carries none: mm, cm, m, inch");
  verb->add_option("--out", o->out, "File to write: .stl, .obj or .ply; .step if it was CAD")
      ->required();
  o->cad.add_to(*verb);
  verb->callback([&context, o] { context.run = [&context, o] { return convert(*o, context); }; });
}

}  // namespace

void add_product_commands(CLI::App& app, Context& context) {
  CLI::App* product = app.add_subcommand("product", "Check, convert and make products");
  product->require_subcommand(1);
  product->fallthrough();
  add_inspection(*product, context, "info", "Size, area, volume and state of a mesh", false);
  add_inspection(*product, context, "check",
                 "Check a product like info, with exit code 5 if something is wrong", true);
  add_convert(*product, context);
  add_product_repair(*product, context);
  add_product_parts_command(*product, context);
  add_product_make_command(*product, context);
}

}  // namespace palmar::cli
