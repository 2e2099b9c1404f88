// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "product/product_repair_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "output_guard.h"
#include "palmar/core/error.h"
#include "palmar/workflow/product_files.h"
#include "text.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct RepairArguments {
  std::string product, unit, out;
  product::RepairOptions options;
};

Json actions_json(const std::vector<product::RepairAction>& actions) {
  Json list = Json::array();
  for (const product::RepairAction& action : actions) {
    Json places = Json::array();
    for (const Vec3& x : action.places) places.push_back({x.x(), x.y(), x.z()});
    list.push_back({{"name", action.name},
                    {"count", action.count},
                    {"text", action.text},
                    {"places_mm", std::move(places)}});
  }
  return list;
}

Json verdict_json(const product::ProductCheck& check) {
  Json findings = Json::array();
  for (const product::Finding& finding : check.findings) {
    findings.push_back({{"severity", name_of(finding.severity)}, {"text", finding.text}});
  }
  return {{"verdict", name_of(check.verdict)},
          {"triangles", check.triangles},
          {"is_closed", check.is_closed},
          {"euler_number", check.euler_number},
          {"area_mm2", check.area},
          {"volume_mm3", check.volume},
          {"findings", std::move(findings)}};
}

std::string verdict_text(const char* when, const product::ProductCheck& check) {
  return fmt::format("{}: {}, {} ({} triangles, Euler number {}, volume {})\n", when,
                     name_of(check.verdict), check.is_closed ? "closed" : "open", check.triangles,
                     check.euler_number, volume_text(check.volume));
}

int repair(const RepairArguments& o, const Context& context) {
  check_shape_output(o.out, false);
  refuse_same_file(o.product, o.out);
  const auto [before, repaired, after] = workflow::repair_product(
      {.file = o.product,
       .unit = parse_unit(o.unit),
       .out = o.out,
       .options = o.options,
       .note = [&context](const std::string& text) { note(context.common, text); }});
  if (context.common.json) {
    const product::RepairLimits& limits = repaired.limits;
    print(Json{{"product", o.product},
               {"out", o.out},
               {"weld_mm", limits.weld},
               {"hole_mm", limits.hole},
               {"speck_mm", limits.speck},
               {"done", actions_json(repaired.done)},
               {"left", actions_json(repaired.left)},
               {"before", verdict_json(before)},
               {"after", verdict_json(after)}}
              .dump(2) +
          "\n");
  } else {
    std::string text = fmt::format(
        "{}: welded within {:.4g} mm, holes up to {:.4g} mm round, specks below {:.4g} "
        "mm\n",
        o.product, repaired.limits.weld, repaired.limits.hole, repaired.limits.speck);
    text += verdict_text("before", before);
    for (const product::RepairAction& action : repaired.done)
      text += "done     " + action.text + "\n";
    if (!repaired.has_changed()) text += "nothing to repair\n";
    for (const product::RepairAction& action : repaired.left)
      text += "left     " + action.text + "\n";
    text += verdict_text("after", after);
    for (const product::Finding& finding : after.findings) {
      if (finding.severity == product::Severity::kOk) continue;
      text += fmt::format("{:<8} {}\n", name_of(finding.severity), finding.text);
    }
    print(text);
  }
  note(context.common, "wrote " + o.out + " (unit: mm); " + o.product + " is as it was");
  if (after.verdict >= product::Severity::kWarning) {
    throw CheckFailed(o.out + ": " + after.findings.front().text);
  }
  return 0;
}

}  // namespace

void add_product_repair(CLI::App& product, Context& context) {
  const auto o = std::make_shared<RepairArguments>();
  CLI::App* verb =
      add_verb(product, "repair", "Repair what is safe, and report what was done and what is left",
               "palmar product repair handle.stl --unit mm --out repaired.stl");
  verb->add_option("PRODUCT", o->product, "Mesh file: STL, OBJ, PLY, 3MF, glTF")->required();
  verb->add_option("--unit", o->unit, "Unit of a file that carries none: mm, cm, m, inch");
  verb->add_option("--out", o->out, "File to write, in mm: .stl, .obj or .ply")->required();
  verb->add_option("--weld-mm", o->options.weld,
                   "Vertices nearer than this become one; default: a millionth of the diagonal");
  verb->add_option("--hole-mm", o->options.hole,
                   "Longest border of a hole that is filled; default: a fifth of the diagonal");
  verb->add_option(
      "--speck-mm", o->options.speck,
      "Pieces with a smaller diagonal are dropped; default: a hundredth of the whole's");
  verb->callback([&context, o] { context.run = [&context, o] { return repair(*o, context); }; });
}

}  // namespace palmar::cli
