// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "cli.h"
#include "companion.h"
#include "contact/press_deck_command.h"
#include "hand/hand_pose_command.h"
#include "hand/hand_scale_command.h"
#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/hand/dimensions/tape_measures.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skeleton.h"
#include "palmar/hand/skin/drawn_creases.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/records/hand/compliance_file.h"
#include "palmar/records/hand/hand_asset.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/hand/hand_json.h"
#include "palmar/records/tissue_file.h"
#include "palmar/report/picture/hand_export.h"
#include "text.h"

namespace palmar::cli {
namespace {

constexpr const char* kHandHelp = "\"template\" or a .hand.glb file";

/// The creases seen on the hand that load_hand() loads by this name.
hand::DrawnCreases drawn_creases(const std::string& name) {
  return name == "template" ? hand::DrawnCreases() : records::read_drawn_creases(name);
}

void add_template(CLI::App& hand, Context& context) {
  struct Options {
    std::string asset, out, compliance;
    double edge = hand::TemplateOptions{}.edge_length;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb = add_verb(hand, "template", "Make the template hand from the generic hand asset",
                            "palmar hand template --edge-mm 3 --out coarse.hand.glb");
  verb->add_option("--asset", o->asset,
                   "Generic hand of the WebXR input profiles (right.glb); "
                   "default: the copy that came with Palmar");
  verb->add_option("--edge-mm", o->edge, "Mean edge length of the skin mesh, mm")
      ->capture_default_str();
  verb->add_option("--out", o->out, "File to write, *.hand.glb")->required();
  verb->add_option("--compliance", o->compliance,
                   "File to write as well: how its skin gives way on its bones (some 13 s)");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      const std::string asset =
          o->asset.empty() ? workflow::share_folder() + "/generic-hand-right.glb" : o->asset;
      const hand::Hand made =
          hand::build_template(records::read_hand_asset(asset), {.edge_length = o->edge});
      records::write_hand(o->out, made);
      note(context.common, fmt::format("wrote {} ({} vertices)", o->out, made.skin.vertex_count()));
      if (!o->compliance.empty()) {
        // Of the hand as a file has it, in single precision.
        const auto written = workflow::load_hand(o->out);
        records::write_compliance(
            o->compliance, records::compliance_key(*written),
            contact::skin_compliance(*written, contact::skin_geometry(written->skin)));
        note(context.common, "wrote " + o->compliance);
      }
      return 0;
    };
  });
}

void add_info(CLI::App& hand, Context& context) {
  const auto name = std::make_shared<std::string>("template");
  CLI::App* verb = add_verb(hand, "info", "Dimensions, joints, ranges of motion, origin of a hand",
                            "palmar hand info template");
  verb->add_option("HAND", *name, kHandHelp)->capture_default_str();
  verb->callback([&context, name] {
    context.run = [&context, name] {
      const auto loaded = workflow::load_hand(*name);
      print(context.common.json ? records::hand_info_json(*loaded) + "\n" : hand_text(*loaded));
      return 0;
    };
  });
}

void add_tissue(CLI::App& hand, Context& context) {
  struct Options {
    std::string hand = "template", tissue, out;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb = add_verb(hand, "tissue", "Stiffness of a hand's skin by region, with its ranges",
                            "palmar hand tissue template --out my-tissue.toml");
  verb->add_option("HAND", o->hand, kHandHelp)->capture_default_str();
  verb->add_option("--tissue", o->tissue,
                   "Tissue file that replaces values of the hand's own tissue");
  verb->add_option("--out", o->out, "Tissue file to write, *.toml, to start your own from");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      const auto loaded = workflow::load_hand(o->hand, o->tissue);
      if (!o->out.empty()) {
        records::write_tissue(o->out, loaded->tissue);
        note(context.common, "wrote " + o->out);
      }
      print(context.common.json ? records::tissue_json(loaded->tissue) + "\n"
                                : tissue_text(loaded->tissue));
      return 0;
    };
  });
}

void add_measure(CLI::App& hand, Context& context) {
  const auto name = std::make_shared<std::string>("template");
  CLI::App* verb =
      add_verb(hand, "measure", "Dimensions of a hand as CSV, mm: straight and along the skin",
               "palmar hand measure template > dimensions.csv");
  verb->add_option("HAND", *name, kHandHelp)->capture_default_str();
  verb->callback([&context, name] {
    context.run = [&context, name] {
      const auto loaded = workflow::load_hand(*name);
      const hand::HandTape tape = hand::measure_with_tape(
          loaded->skin, loaded->skeleton,
          hand::creases_of(loaded->skin, loaded->skeleton, drawn_creases(*name)));
      print(context.common.json ? records::hand_measures_json(*loaded, tape) + "\n"
                                : dimensions_csv(*loaded, tape));
      return 0;
    };
  });
}

void add_mirror(CLI::App& hand, Context& context) {
  struct Options {
    std::string hand = "template", out;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb = add_verb(hand, "mirror", "The other hand: right to left or left to right",
                            "palmar hand mirror template --out left.hand.glb");
  verb->add_option("HAND", o->hand, kHandHelp)->capture_default_str();
  verb->add_option("--out", o->out, "File to write, *.hand.glb")->required();
  verb->callback([&context, o] {
    context.run = [&context, o] {
      const hand::Hand other = mirrored(*workflow::load_hand(o->hand));
      records::write_hand(o->out, other, mirrored(drawn_creases(o->hand)));
      note(context.common, fmt::format("wrote {} ({} hand)", o->out, name_of(other.side)));
      return 0;
    };
  });
}

void add_export(CLI::App& hand, Context& context) {
  struct Options {
    std::string hand = "template", out, format;
    PressDeckArguments deck;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb = add_verb(hand, "export", "A hand in its reference posture, as mesh or picture",
                            "palmar hand export template --out hand.ply");
  verb->add_option("HAND", o->hand, kHandHelp)->capture_default_str();
  verb->add_option("--out", o->out,
                   "File to write: .glb (skin by region and bones), .ply, .obj, .stl (skin), .png "
                   "(picture)")
      ->required();
  verb->add_option("--format", o->format,
                   "inp: a finite-element deck of one region under an indenter; --out is a folder")
      ->check(CLI::IsMember({"inp"}));
  add_press_deck_options(*verb, o->deck);
  verb->callback([&context, o] {
    context.run = [&context, o] {
      if (o->format == "inp") return run_press_deck(o->deck, o->hand, o->out, context.common);
      const auto loaded = workflow::load_hand(o->hand);
      report::export_posed_hand(o->out, *loaded, hand::reference_posture(loaded->skeleton));
      note(context.common, "wrote " + o->out);
      return 0;
    };
  });
}

}  // namespace

void add_hand_commands(CLI::App& app, Context& context) {
  CLI::App* hand = app.add_subcommand("hand", "Make, look at, pose and export hands");
  hand->require_subcommand(1);
  hand->fallthrough();
  add_template(*hand, context);
  add_elsewhere(*hand, context, kHandsProgram, "from-mri",
                "A person's hand from MR series of several postures");
  add_elsewhere(*hand, context, kHandsProgram, "from-scan",
                "A person's hand from surface scans: of any scanning app or photogrammetry "
                "program, with creases and dots drawn on the skin if possible");
  add_elsewhere(
      *hand, context, kHandsProgram, "from-photos",
      "A person's hand from photographs of it on the printed board (palmar photos board), "
      "a folder per posture");
  add_info(*hand, context);
  add_tissue(*hand, context);
  add_measure(*hand, context);
  add_mirror(*hand, context);
  add_hand_pose(*hand, context);
  add_hand_scale(*hand, context);
  add_elsewhere(
      *hand, context, kHandsProgram, "quick",
      "A hand from a few measurements, or from one photograph of it flat on a sheet of A4 or "
      "beside a bank card, and a population; says how well each dimension is known");
  add_export(*hand, context);
}

}  // namespace palmar::cli
