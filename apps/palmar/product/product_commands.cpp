// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli.h"
#include "output_guard.h"
#include "palmar/core/error.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/product/check.h"
#include "palmar/product/repair.h"
#include "palmar/records/product/cad_format.h"
#include "palmar/records/product/product_file.h"
#include "product/cad_arguments.h"
#include "product/product_cad_text.h"
#include "product/product_make_command.h"
#include "product/product_repair_command.h"
#include "text.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

Json check_json(const Product& product, const ProductCheck& check) {
  Json findings = Json::array();
  for (const Finding& finding : check.findings) {
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
          {"fixes", fix_list(check, repair_limits({}, check.size.norm()))}};
}

std::string check_text(const Product& product, const ProductCheck& check) {
  std::string text = fmt::format(
      "{}: {} triangles, {} vertices, {} part{}\n"
      "size {:.1f} x {:.1f} x {:.1f} mm, area {:.0f} mm2, volume {}, Euler number {}\n",
      product.source, check.triangles, check.vertices, check.parts, check.parts == 1 ? "" : "s",
      check.size.x(), check.size.y(), check.size.z(), check.area, volume_text(check.volume),
      check.euler_number);
  for (const Finding& finding : check.findings) {
    text += fmt::format("{:<8} {}\n", name_of(finding.severity), finding.text);
  }
  for (const std::string& fix : fix_list(check, repair_limits({}, check.size.norm()))) {
    text += "fix      " + fix + "\n";
  }
  return text + "verdict: " + name_of(check.verdict) + "\n";
}

struct FileArguments {
  std::string product, unit, out;
  CadArguments cad;
};

constexpr const char* kProductHelp = "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES";

/// The mesh as the file has it (in mm, not yet repaired), for an honest check.
ProductCheck check_of_mesh_file(const FileArguments& arguments, Product& product) {
  product = load_product(arguments.product, {.unit = parse_unit(arguments.unit)});
  MeshFile raw = read_mesh(arguments.product);
  const double scale = millimetres_per(product.unit);
  for (Vec3& vertex : raw.mesh.vertices) vertex *= scale;
  // STL has no shared corners; what the product's own weld joins isn't a fault of the file.
  return raw.format.find("STL") == std::string::npos ? check_mesh(raw.mesh)
                                                     : check_mesh(product.mesh);
}

int inspect(const FileArguments& o, const Context& context, bool fails_on_error) {
  const LoadProductOptions options = o.cad.options(o.unit, make_progress(context.common));
  const bool is_cad = is_cad_file(o.product);
  Product product;
  ProductCheck check;
  Json cad;
  std::string text;
  std::string fault;  // that the CAD kernel finds
  if (is_cad) {
    CadProduct read = load_cad_product(o.product, options);
    product = std::move(read.product);
    check = check_mesh(product.mesh);
    text = cad_text(read.cad, o.unit);
    cad = cad_json(read.cad);
    if (fails_on_error) {
      const CadVerdict verdict = check_cad_file(o.product, read.cad.millimetres_per_unit,
                                                options.limits, options.progress);
      text += verdict_text(verdict);
      cad["kernel"] = verdict_json(verdict);
      if (!verdict.is_good()) {
        fault = verdict.findings.empty() ? "no valid closed solid" : verdict.findings.front();
      }
    }
  } else {
    check = check_of_mesh_file(o, product);
  }
  for (const std::string& line : product.notes) note(context.common, line);
  if (context.common.json) {
    Json json = check_json(product, check);
    if (is_cad) json["cad"] = std::move(cad);
    print(json.dump(2) + "\n");
  } else {
    print(check_text(product, check) + text);
  }
  if (fails_on_error && check.verdict >= Severity::kWarning) {
    throw CheckFailed(o.product + ": " + check.findings.front().text);
  }
  if (!fault.empty()) throw CheckFailed(o.product + ": " + fault);
  return 0;
}

void add_inspection(CLI::App& noun, Context& context, const std::string& name,
                    const std::string& description, bool fails_on_error) {
  const auto o = std::make_shared<FileArguments>();
  CLI::App* verb =
      add_verb(noun, name, description, "palmar product " + name + " handle.stl --unit mm");
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
  const LoadProductOptions options = o.cad.options(o.unit, make_progress(context.common));
  if (cad_format_of_name(o.out) == CadFormat::kStep) {
    if (!is_cad_file(o.product)) {
      throw UsageError(o.product +
                       ": a mesh has no surfaces that STEP could hold; --out .stl, "
                       ".obj or .ply is required");
    }
    const std::optional<double> unit =
        options.unit ? std::optional(millimetres_per(*options.unit)) : std::nullopt;
    convert_to_step(o.product, o.out, unit, options.limits, options.progress);
  } else {
    const Product product = load_product(o.product, options);
    for (const std::string& text : product.notes) note(context.common, text);
    write_mesh(o.out, product.mesh);
  }
  note(context.common, "wrote " + o.out + " (unit: mm)");
  return 0;
}

void add_convert(CLI::App& noun, Context& context) {
  const auto o = std::make_shared<FileArguments>();
  CLI::App* verb = add_verb(noun, "convert", "Another format, in mm, welded and oriented",
                            "palmar product convert handle.3mf --out handle.stl");
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
  add_inspection(*product, context, "check", "Like info; exit code 5 if something is wrong", true);
  add_convert(*product, context);
  add_product_repair(*product, context);
  add_product_make_command(*product, context);
}

}  // namespace palmar::cli
