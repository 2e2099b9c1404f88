// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/feature_choice.h"

#include <fmt/format.h>

#include <BRepAdaptor_Surface.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include "palmar/cad/model/face_relations.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kAlong =
    15 * std::numbers::pi / 180;  // rad; a tapered handle's edges are still long
constexpr double kLongShare = 1.0 / 3;

struct Word {
  std::string key, value;
};

/// "edge=3+5+long" as edge 3, edge 5, long.
std::vector<Word> words_in(const std::string& text) {
  std::vector<Word> words;
  std::string key;
  size_t from = 0;
  while (from <= text.size()) {
    const size_t to = std::min(text.find('+', from), text.size());
    const std::string item = text.substr(from, to - from);
    from = to + 1;
    const size_t equals = item.find('=');
    if (item.empty() || equals == 0 || equals + 1 == item.size()) {
      throw UsageError(fmt::format("choice \"{}\": an empty word", text));
    }
    const bool is_number = item.find_first_not_of("0123456789") == std::string::npos;
    if (equals != std::string::npos) {
      key = item.substr(0, equals);
      words.push_back({key, item.substr(equals + 1)});
    } else if (is_number) {
      if (key.empty()) {
        throw UsageError(fmt::format("choice \"{}\": number {} of what? edge={} or face={}", text,
                                     item, item, item));
      }
      words.push_back({key, item});
    } else {
      words.push_back({item, ""});
    }
  }
  return words;
}

int number_in(const Word& word, int count) {
  int number = 0;
  const char* const end = word.value.data() + word.value.size();
  const auto [at, error] = std::from_chars(word.value.data(), end, number);
  if (error != std::errc() || at != end || number < 1 || number > count) {
    throw UsageError(
        fmt::format("{} {}: the product has {}s 1 to {}", word.key, word.value, word.key, count));
  }
  return number;
}

std::vector<int> faces_named(const CadModel::Impl& model, const std::string& name) {
  std::vector<int> faces;
  std::set<std::string> names;
  for (const auto& [number, of_face] : model.face_name) {
    names.insert(of_face);
    if (of_face == name) faces.push_back(number);
  }
  if (faces.empty()) {
    std::string known;
    for (const std::string& one : names) known += (known.empty() ? "\"" : ", \"") + one + "\"";
    throw UsageError(
        fmt::format("no face is named \"{}\"; {}", name,
                    known.empty() ? "the product's faces have no names" : "there are " + known));
  }
  return faces;
}

bool is_along(const LongAxis& axis, const gp_Dir& direction) {
  const double angle = axis.direction.Angle(direction);
  return std::min(angle, std::numbers::pi - angle) < kAlong;
}

struct Features {
  std::vector<EdgeRelation> edges;
  std::vector<Blend> blends;
  const Blend* blend(int face) const {
    const auto at = std::find_if(blends.begin(), blends.end(),
                                 [&](const Blend& blend) { return blend.face == face; });
    return at == blends.end() ? nullptr : &*at;
  }
};

Features features_of(const CadModel::Impl& model) {
  if (model.bodies.empty() || model.faces.Extent() == 0) {
    throw UsageError("the product has no faces, so no edge of it can be chosen");
  }
  Features features;
  features.edges = edge_relations(model);
  features.blends = blends_of(model, features.edges);
  return features;
}

bool is_sharp(const EdgeRelation& edge) {
  return edge.face[0] != 0 && edge.face[1] != 0 && !edge.is_smooth && edge.angle > 0.0;
}

void choose_by_rule(const CadModel::Impl& model, const Features& features, const std::string& rule,
                    EdgeChoice& choice) {
  const bool is_convex = rule != "concave";
  const LongAxis axis = rule == "long" ? long_axis_of(model) : LongAxis{};
  const auto fits = [&](const gp_Dir& along, double length, bool is_closed) {
    return rule != "long" ||
           (!is_closed && is_along(axis, along) && length >= kLongShare * axis.length);
  };
  for (const EdgeRelation& edge : features.edges) {
    if (is_sharp(edge) && edge.is_convex == is_convex &&
        fits(edge.along, edge.length, edge.is_closed)) {
      choice.sharp.push_back(edge.edge);
    }
  }
  for (const Blend& blend : features.blends) {
    if (blend.is_convex == is_convex && fits(blend.along, blend.length, false)) {
      choice.rounded.push_back(blend.face);
    }
  }
}

void choose_face(const Features& features, int face, EdgeChoice& choice) {
  if (features.blend(face) != nullptr) {
    choice.rounded.push_back(face);
    return;
  }
  const size_t before = choice.sharp.size();
  for (const EdgeRelation& edge : features.edges) {
    if (is_sharp(edge) && (edge.face[0] == face || edge.face[1] == face)) {
      choice.sharp.push_back(edge.edge);
    }
  }
  if (choice.sharp.size() == before) {
    throw UsageError(fmt::format("face {}: neither a fillet nor a face with sharp edges", face));
  }
}

void choose_edge(const Features& features, int number, EdgeChoice& choice) {
  const EdgeRelation& edge = features.edges[number - 1];
  if (is_sharp(edge)) {
    choice.sharp.push_back(number);
    return;
  }
  for (const Blend& blend : features.blends) {
    if (std::find(blend.sides.begin(), blend.sides.end(), number) != blend.sides.end()) {
      choice.rounded.push_back(blend.face);
      return;
    }
  }
  throw UsageError(fmt::format(
      "edge {}: {}, so it can't be rounded", number,
      edge.is_seam ? "the seam of a face that closes on itself"
                   : (edge.is_smooth ? "its faces meet without a kink" : "it has no two faces")));
}

void sort_once(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

std::string list_of(const char* one, const char* many, const std::vector<int>& numbers) {
  return fmt::format("{} {}", numbers.size() == 1 ? one : many, fmt::join(numbers, ", "));
}

}  // namespace

EdgeChoice choose_edges(const CadModel& model, const std::string& words) {
  const CadModel::Impl& impl = model.impl();
  const Features features = features_of(impl);
  EdgeChoice choice;
  for (const Word& word : words_in(words)) {
    if (word.value.empty() &&
        (word.key == "long" || word.key == "convex" || word.key == "concave")) {
      choose_by_rule(impl, features, word.key, choice);
    } else if (word.key == "edge" && !word.value.empty()) {
      choose_edge(features, number_in(word, impl.edges.Extent()), choice);
    } else if (word.key == "face" && !word.value.empty()) {
      choose_face(features, number_in(word, impl.faces.Extent()), choice);
    } else if (word.key == "name" && !word.value.empty()) {
      for (const int face : faces_named(impl, word.value)) choose_face(features, face, choice);
    } else {
      throw UsageError(fmt::format(
          "edges \"{}\": allowed are long, convex, concave, edge=NUMBER, face=NUMBER and "
          "name=NAME, joined by +",
          word.key));
    }
  }
  sort_once(choice.sharp);
  sort_once(choice.rounded);
  if (choice.is_empty()) {
    throw UsageError(fmt::format("edges \"{}\": the product has none", words));
  }
  return choice;
}

double mean_radius(const CadModel& model, const EdgeChoice& choice) {
  if (choice.rounded.empty()) return 0.0;
  const Features features = features_of(model.impl());
  double sum = 0.0;
  for (const int face : choice.rounded) {
    const Blend* const blend = features.blend(face);
    sum += blend == nullptr ? 0.0 : blend->radius;
  }
  return sum / static_cast<double>(choice.rounded.size());
}

std::vector<int> choose_faces(const CadModel& model, const std::string& words) {
  const CadModel::Impl& impl = model.impl();
  const Features features = features_of(impl);
  std::vector<int> faces;
  for (const Word& word : words_in(words)) {
    if (word.value.empty() && (word.key == "sides" || word.key == "ends" || word.key == "all")) {
      const LongAxis axis = long_axis_of(impl);
      for (int face = 1; face <= impl.faces.Extent(); ++face) {
        if (features.blend(face) != nullptr) continue;
        const BRepAdaptor_Surface surface(TopoDS::Face(impl.faces(face)));
        const bool is_end = surface.GetType() == GeomAbs_Plane &&
                            is_along(axis, surface.Plane().Axis().Direction());
        if (word.key == "all" || (word.key == "ends") == is_end) faces.push_back(face);
      }
    } else if (word.key == "face" && !word.value.empty()) {
      faces.push_back(number_in(word, impl.faces.Extent()));
    } else if (word.key == "name" && !word.value.empty()) {
      for (const int face : faces_named(impl, word.value)) faces.push_back(face);
    } else {
      throw UsageError(fmt::format(
          "faces \"{}\": allowed are sides, ends, all, face=NUMBER and name=NAME, joined by +",
          word.key));
    }
  }
  sort_once(faces);
  if (faces.empty()) {
    throw UsageError(fmt::format("faces \"{}\": the product has none", words));
  }
  return faces;
}

std::string words_of(const EdgeChoice& choice) {
  std::string text;
  if (!choice.sharp.empty()) text += list_of("edge", "edges", choice.sharp);
  if (!choice.rounded.empty()) {
    text += (text.empty() ? "" : " and ") + list_of("fillet", "fillets", choice.rounded);
  }
  return text;
}

}  // namespace palmar::cad
