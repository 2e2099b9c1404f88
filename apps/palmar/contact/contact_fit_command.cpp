// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "contact/contact_fit_command.h"

#include <fmt/format.h>

#include "palmar/core/error.h"
#include "palmar/records/tissue_fit_json.h"
#include "palmar/workflow/fit_tissue.h"
#include "palmar/workflow/words/press_words.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct FitArguments {
  std::string curves, specimen = "plane", indenter, layer, group, out;
  std::string tissue_model = "halfspace", law = "stiffening", residuals = "absolute";
  double tilt_deg = 0.0;
  double spacing = contact::PressOptions{}.spacing;
  double poisson = 0.5;
  double confidence_percent = 100.0 * contact::TissueFitOptions{}.confidence;
  std::optional<double> limit_depth;
};

bool is_one_of(const std::string& option, const std::string& text, const std::string& yes,
               const std::string& no) {
  if (text != yes && text != no) {
    throw UsageError(option + ": \"" + text + "\" is not known; " + no + " or " + yes +
                     " is allowed");
  }
  return text == yes;
}

contact::TissueFitOptions fit_options(const FitArguments& arguments) {
  contact::TissueFitOptions options;
  options.is_constant = is_one_of("--law", arguments.law, "constant", "stiffening");
  options.is_relative = is_one_of("--residuals", arguments.residuals, "relative", "absolute");
  options.limit_depth = arguments.limit_depth;
  options.confidence = arguments.confidence_percent / 100.0;
  if (options.is_constant && options.limit_depth) {
    throw UsageError("--limit-depth-mm has no meaning with --law constant");
  }
  options.check();
  return options;
}

/// Sets the test up; the layer is a known thickness, fitted, or the hand's own.
struct TestSetup {
  contact::PressOptions press;
  std::string hand;
  bool is_layered = false;
  bool is_layer_fitted = false;
};

TestSetup setup_of(const FitArguments& arguments) {
  TestSetup setup;
  setup.press.specimen = workflow::parse_specimen(arguments.specimen, setup.hand);
  setup.press.indenter = workflow::parse_indenter(arguments.indenter);
  setup.press.tilt = radians(arguments.tilt_deg);
  setup.press.spacing = arguments.spacing;
  const contact::TissueModel model = workflow::parse_tissue_model(arguments.tissue_model);
  if (model == contact::TissueModel::kBone) {
    throw UsageError(
        "--tissue-model bone: its law stiffens with energy, not with depth, and isn't fitted here; "
        "halfspace or layered is allowed");
  }
  setup.is_layered = model == contact::TissueModel::kLayered || !arguments.layer.empty();
  if (!setup.hand.empty()) {
    if (!arguments.layer.empty()) {
      throw UsageError("--layer-mm: a hand has its own depth of skin over bone; leave it out");
    }
    return setup;
  }
  setup.press.poisson = arguments.poisson;
  if (setup.is_layered) {
    if (arguments.layer.empty()) {
      throw UsageError("--tissue-model layered: --layer-mm is needed, a thickness or \"fitted\"");
    }
    setup.is_layer_fitted = arguments.layer == "fitted";
    if (!setup.is_layer_fitted) {
      const std::vector<double> thickness = workflow::parse_list("--layer-mm", arguments.layer);
      if (thickness.size() != 1) {
        throw UsageError("--layer-mm: \"" + arguments.layer +
                         "\"; one thickness in mm, or \"fitted\", is needed");
      }
      setup.press.layer_thickness = thickness.front();
    }
  }
  return setup;
}

std::string describe(const FitArguments& arguments, const TestSetup& setup) {
  std::string text = arguments.specimen + " pressed by " + arguments.indenter;
  if (arguments.tilt_deg != 0.0) text += fmt::format(" at {} deg", arguments.tilt_deg);
  if (!setup.is_layered) return text + ", half-space";
  if (!setup.hand.empty()) return text + ", layered over the hand's own bones";
  return text + (setup.is_layer_fitted ? ", layer of fitted thickness"
                                       : ", layer of " + arguments.layer + " mm");
}

std::string parameters_text(const contact::TissueFit& fit, double confidence) {
  std::string text =
      fmt::format("parameter      value  unit   {:g} % confidence      \n", 100.0 * confidence);
  for (const contact::FittedParameter& one : fit.parameters) {
    const std::string interval =
        one.lower ? fmt::format("{:.4g} to {:.4g}", *one.lower, *one.upper) : "-";
    const std::string state = one.status == contact::ParameterStatus::kFitted ? ""
                              : one.status == contact::ParameterStatus::kHeld
                                  ? "held: "
                                  : "not identifiable: ";
    std::string row = fmt::format("{:<10} {:>9.4g}  {:<5}  {:<20}  {}{}", one.name, one.value,
                                  one.unit, interval, state, one.remark);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string points_text(const contact::TissueFit& fit) {
  const bool has_area = fit.area_ratio.has_value();
  std::string text = "\n  line     depth     force     model  residual";
  text += has_area ? "      area     model  subject\n" : "  subject\n";
  text += "              mm         N         N         N";
  text += has_area ? "       mm2       mm2\n" : "\n";
  for (const contact::FittedPoint& point : fit.points) {
    const contact::MeasuredPoint& measured = point.measured;
    text += fmt::format("{:6d} {:9.3f} {:9.4f} {:9.4f} {:9.4f}", measured.line, measured.depth,
                        measured.force, point.force, measured.force - point.force);
    if (has_area) {
      text += measured.area ? fmt::format(" {:9.2f}", *measured.area) : fmt::format(" {:>9}", "-");
      text += fmt::format(" {:9.2f}", point.area);
    }
    text += (measured.subject.empty() ? "" : "  " + measured.subject) + "\n";
  }
  return text;
}

std::string fit_text(const contact::TissueFit& fit, const std::string& test, double confidence) {
  std::string text = test + "\n\n" + parameters_text(fit, confidence);
  const hand::StiffeningLaw& low = fit.stiffness.low;
  const hand::StiffeningLaw& high = fit.stiffness.high;
  text +=
      fmt::format("\nrange          G0 {:.4g} to {:.4g} kPa, G_lim {:.4g} to {:.4g} kPa ({})\n",
                  1000.0 * low.g0, 1000.0 * high.g0, 1000.0 * low.g_limit, 1000.0 * high.g_limit,
                  fit.subjects.empty() ? "confidence of the mean stiffness" : "subjects");
  text += fmt::format("residual       {:.4g} N rms, {:.1f} % of the readings rms; R2 {:.5f}\n",
                      fit.force_rms, 100.0 * fit.force_rms_relative, fit.r_squared);
  if (fit.area_ratio) {
    text += fmt::format("area           measured / model {:.3f} mean, {:.1f} % rms\n",
                        *fit.area_ratio, 100.0 * *fit.area_rms_relative);
  }
  text +=
      fmt::format("fit            {} after {} steps, {} readings, condition {:.3g}\n",
                  records::name_of(fit.status), fit.iterations, fit.points.size(), fit.condition);
  if (fit.fitted.size() > 1) {
    text += "correlation    ";
    for (std::size_t i = 0; i < fit.fitted.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        text += fmt::format(
            "{}{}, {}: {:.3f}", i + j > 1 ? "; " : "", fit.fitted[j], fit.fitted[i],
            fit.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
    }
    text += "\n";
  }
  for (const contact::SubjectFit& one : fit.subjects) {
    text +=
        fmt::format("{:<14} G0 {:.4g}, G_lim {:.4g} kPa; {} readings, {:.4g} N rms\n", one.subject,
                    1000.0 * one.law.g0, 1000.0 * one.law.g_limit, one.points, one.force_rms);
  }
  for (const std::string& remark : fit.remarks) text += "\n" + remark;
  return text + (fit.remarks.empty() ? "" : "\n") + points_text(fit);
}

int run_fit(const FitArguments& arguments, const CommonOptions& common) {
  const TestSetup setup = setup_of(arguments);
  workflow::TissueFitRequest request;
  request.fit = fit_options(arguments);
  request.curves = arguments.curves;
  request.test = setup.press;
  request.hand.name = setup.hand;
  request.is_layered = setup.is_layered;
  request.is_layer_fitted = setup.is_layer_fitted;
  request.group = arguments.group;
  request.description = describe(arguments, setup);
  request.out = arguments.out;
  request.note = [&common](const std::string& text) { note(common, text); };
  request.check();
  const auto [fit, group] = fit_tissue(request);
  if (!arguments.out.empty()) note(common, "wrote " + arguments.out + " (" + group + ")");
  print(common.json
            ? records::tissue_fit_json(fit, request.description, request.fit.confidence) + "\n"
            : fit_text(fit, request.description, request.fit.confidence));
  return 0;
}

}  // namespace

void add_contact_fit_verb(CLI::App& contact, Context& context) {
  const auto o = std::make_shared<FitArguments>();
  CLI::App* verb = add_verb(contact, "fit", "Tissue parameters from measured depths and forces",
                            "palmar contact fit examples/fingertip-xie2014.csv --specimen "
                            "template:middle_distal --indenter plane "
                            "--tilt-deg 30 --out tissue.toml");
  verb->add_option("CSV", o->curves,
                   "Readings: columns depth_mm, force_n or force_mn; optional area_mm2, subject, "
                   "weight or force_sd_n")
      ->required();
  verb->add_option("--specimen", o->specimen,
                   "What was pressed: plane, ellipsoid:RX,RY (radii of curvature, mm) or "
                   "HAND:REGION")
      ->capture_default_str();
  verb->add_option("--indenter", o->indenter, "sphere:R, punch:A, cylinder:R (mm) or plane")
      ->required();
  verb->add_option("--tilt-deg", o->tilt_deg, "Tilt of the indenter, deg")->capture_default_str();
  verb->add_option("--tissue-model", o->tissue_model, "halfspace, or layered (skin over bone)")
      ->capture_default_str();
  verb->add_option("--layer-mm", o->layer,
                   "Thickness of the layer of a plane or ellipsoid, mm, or \"fitted\"");
  verb->add_option("--poisson", o->poisson, "Poisson's ratio of a plane or ellipsoid")
      ->capture_default_str();
  verb->add_option("--law", o->law, "stiffening (G0, G_lim, d_lim) or constant (one modulus)")
      ->capture_default_str();
  verb->add_option("--limit-depth-mm", o->limit_depth, "d_lim, mm; without it d_lim is fitted");
  verb->add_option(
          "--residuals", o->residuals,
          "absolute (a load cell's error in N) or relative (every depth has the same weight)")
      ->capture_default_str();
  verb->add_option("--confidence", o->confidence_percent, "Confidence of the intervals, %")
      ->capture_default_str();
  verb->add_option("--spacing-mm", o->spacing, "Vertex spacing of a plane or ellipsoid, mm")
      ->capture_default_str();
  verb->add_option("--group", o->group,
                   "Where the result goes in the tissue file: finger, palm, dorsum or a region; "
                   "default: the region's group, or finger");
  verb->add_option("--out", o->out, "Tissue file to write, *.toml");
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_fit(*o, context.common); }; });
}

}  // namespace palmar::cli
