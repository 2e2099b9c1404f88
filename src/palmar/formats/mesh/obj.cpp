// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/obj.h"

#include <algorithm>
#include <array>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/mesh_build.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

/// Statements of the format; others are unknown.
constexpr std::array<std::string_view, 21> kSkipped = {
    "vn",       "vt",       "vp",     "g",          "o",         "s",    "mtllib",
    "usemtl",   "usemap",   "maplib", "l",          "p",         "mg",   "bevel",
    "c_interp", "d_interp", "lod",    "shadow_obj", "trace_obj", "call", "csh"};
constexpr std::array<std::string_view, 15> kFreeForm = {"cstype", "deg",  "bmat", "step", "curv",
                                                        "curv2",  "surf", "parm", "trim", "hole",
                                                        "scrv",   "sp",   "end",  "con",  "ctech"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name, ObjColours* colours)
      : scan_(text), name_(name), colours_(colours) {}

  MeshFile read() {
    file_.format = "OBJ";
    while (next_statement()) read_statement();
    if (!has_known_) {
      throw InputError(name_ + ": is no OBJ: no line of it states a vertex or face; starts with " +
                       in_quotes(first_));
    }
    add_notes();
    if (colours_ != nullptr) finish_colours();
    finish_mesh(file_, name_, colours_ == nullptr ? nullptr : &colours_->surface);
    return std::move(file_);
  }

 private:
  /// Puts the next line into statement_, with continuations joined and comments cut.
  bool next_statement() {
    auto line = scan_.next_line();
    if (!line) return false;
    line_ = scan_.line();
    if (line->empty() || line->back() != '\\') {
      statement_ = *line;
    } else {
      joined_.clear();
      while (line && !line->empty() && line->back() == '\\') {
        joined_.append(line->substr(0, line->size() - 1)).push_back(' ');
        line = scan_.next_line();
      }
      if (line) joined_.append(*line);
      statement_ = joined_;
    }
    statement_ = statement_.substr(0, statement_.find('#'));
    return true;
  }

  std::string_view next_word() {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; };
    std::size_t start = 0;
    while (start < statement_.size() && blank(statement_[start])) ++start;
    std::size_t end = start;
    while (end < statement_.size() && !blank(statement_[end])) ++end;
    const std::string_view word = statement_.substr(start, end - start);
    statement_.remove_prefix(end);
    return word;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(line_) + ": " + what);
  }

  void read_statement() {
    const std::string_view whole = statement_;
    const std::string_view keyword = next_word();
    if (keyword.empty()) return;
    if (first_.empty()) first_ = std::string(whole.substr(0, 60));
    if (keyword == "v") {
      read_vertex();
      has_known_ = true;
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
      has_known_ = true;
    } else if (contains(kSkipped, keyword)) {
      if (colours_ != nullptr) read_colour_statement(keyword);
    } else if (contains(kFreeForm, keyword)) {
      ++free_form_count_;
    } else if (!has_known_) {
      // Before the first vertex an unknown word means: this is some other text.
      throw InputError(name_ + ": is no OBJ: line " + std::to_string(line_) + " starts with " +
                       in_quotes(keyword) + "; \"v\", \"f\" or another OBJ statement is required");
    } else {
      ++unknown_count_;
      if (first_unknown_line_ == 0) first_unknown_line_ = line_;
    }
  }

  void read_vertex() {
    Vec3 p = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      const std::string_view word = next_word();
      const auto value = parse_double(word);
      if (!value) {
        fail(std::string("vertex ") + std::to_string(file_.mesh.vertices.size() + 1) + ": " +
             "xyz"[c] + " is " + (word.empty() ? "missing" : in_quotes(word)) +
             "; a number is required");
      }
      p[c] = *value;
    }
    if (!p.allFinite() || !(p.cwiseAbs().maxCoeff() <= 1e12)) {
      check_position(p, name_ + ":" + std::to_string(line_) + ": vertex " +
                            std::to_string(file_.mesh.vertices.size() + 1));
    }
    if (file_.mesh.vertices.size() >= std::size_t{3} * kMaxTriangles) {
      fail("more than " + std::to_string(3 * kMaxTriangles) + " vertices");
    }
    file_.mesh.vertices.push_back(p);
    if (colours_ != nullptr) read_vertex_colour();
  }

  void read_vertex_colour() {
    geometry::Srgb colour = geometry::Srgb::Zero();
    for (int c = 0; c < 3; ++c) {
      const auto value = parse_double(next_word());
      if (!value || !(*value >= 0.0 && *value <= 255.0)) {
        all_have_colour_ = false;
        break;
      }
      colour[c] = static_cast<float>(*value);
    }
    colours_->surface.vertex.push_back(colour);
  }

  void read_colour_statement(std::string_view keyword) {
    if (keyword == "vt") {
      // From the lower left; Palmar counts from the upper left.
      const double u = parse_double(next_word()).value_or(0.0);
      const double v = parse_double(next_word()).value_or(0.0);
      places_.emplace_back(static_cast<float>(u), static_cast<float>(1.0 - v));
    } else if (keyword == "mtllib") {
      colours_->library.push_back(rest_of_line());
    } else if (keyword == "usemtl") {
      const std::string material = rest_of_line();
      auto& all = colours_->material;
      const auto found = std::find(all.begin(), all.end(), material);
      material_ = static_cast<int>(found - all.begin());
      if (found == all.end()) all.push_back(material);
    }
  }

  /// Names of files and materials may hold blanks.
  std::string rest_of_line() {
    const auto from = statement_.find_first_not_of(" \t");
    if (from == statement_.npos) return {};
    return std::string(statement_.substr(from, statement_.find_last_not_of(" \t\r") - from + 1));
  }

  /// Index of the texture place of a corner "v/vt/vn", -1 for none.
  int place_index(std::string_view word) const {
    const auto slash = word.find('/');
    if (slash == word.npos) return -1;
    const std::string_view rest = word.substr(slash + 1);
    const auto index = parse_integer(rest.substr(0, rest.find('/')));
    if (!index) return -1;
    const auto count = static_cast<long long>(places_.size());
    const long long resolved = *index > 0 ? *index - 1 : count + *index;
    if (*index == 0 || resolved < 0 || resolved >= count) {
      fail("face names texture place " + std::to_string(*index) + "; " + std::to_string(count) +
           " come before it");
    }
    return static_cast<int>(resolved);
  }

  /// Places of the triangles that the last face was split into.
  void place_triangles(std::size_t first) {
    for (std::size_t t = first; t < file_.mesh.triangles.size(); ++t) {
      std::array<Eigen::Vector2f, 3> place;
      bool is_placed = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = std::find(corners_.begin(), corners_.end(), file_.mesh.triangles[t][k]);
        const int index = corner_places_[static_cast<std::size_t>(corner - corners_.begin())];
        is_placed = is_placed && index >= 0;
        place[k] =
            index < 0 ? Eigen::Vector2f::Zero().eval() : places_[static_cast<std::size_t>(index)];
      }
      colours_->surface.place.push_back(place);
      colours_->surface.texture.push_back(is_placed ? material_ : -1);
    }
  }

  void finish_colours() {
    geometry::SurfaceColours& surface = colours_->surface;
    if (!all_have_colour_) surface.vertex.clear();
    float largest = 0.0F;
    for (const geometry::Srgb& c : surface.vertex) largest = std::max(largest, c.maxCoeff());
    if (largest > 1.0F) {
      for (geometry::Srgb& c : surface.vertex) c /= 255.0F;
    }
  }

  int vertex_index(std::string_view word) const {
    const std::string_view digits = word.substr(0, word.find('/'));
    const auto index = parse_integer(digits);
    if (!index) fail("face corner " + in_quotes(word) + "; a vertex number is required");
    const auto count = static_cast<long long>(file_.mesh.vertices.size());
    const long long resolved = *index > 0 ? *index - 1 : count + *index;
    if (*index == 0 || resolved < 0 || resolved >= count) {
      fail("face names vertex " + std::to_string(*index) + "; " + std::to_string(count) +
           " vertices come before it");
    }
    return static_cast<int>(resolved);
  }

  void read_face() {
    corners_.clear();
    corner_places_.clear();
    for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
      corners_.push_back(vertex_index(word));
      if (colours_ != nullptr) corner_places_.push_back(place_index(word));
    }
    if (corners_.size() < 3) {
      ++small_face_count_;
      return;
    }
    check_triangle_count(name_, file_.mesh.triangles.size() + corners_.size() - 2);
    const std::size_t first = file_.mesh.triangles.size();
    splitter_.split(file_.mesh.vertices, corners_, file_.mesh.triangles);
    if (colours_ != nullptr) place_triangles(first);
  }

  void add_notes() {
    const auto note = [this](int count, const std::string& what) {
      if (count > 0) file_.notes.push_back(std::to_string(count) + " " + what);
    };
    note(small_face_count_, "faces with fewer than 3 corners skipped");
    note(free_form_count_, "statements of free-form curves and surfaces skipped");
    note(unknown_count_,
         "unknown statements skipped, the first in line " + std::to_string(first_unknown_line_));
    note(splitter_.doubtful_count(), "polygons cross themselves; split as fans");
  }

  TextScanner scan_;
  const std::string& name_;
  std::string_view statement_;
  std::string joined_;
  std::string first_;
  int line_ = 0;
  bool has_known_ = false;
  int small_face_count_ = 0;
  int free_form_count_ = 0;
  int unknown_count_ = 0;
  int first_unknown_line_ = 0;
  std::vector<int> corners_;
  PolygonSplitter splitter_;
  MeshFile file_;
  ObjColours* colours_;  ///< null: only the shape is wanted
  bool all_have_colour_ = true;
  std::vector<Eigen::Vector2f> places_;
  std::vector<int> corner_places_;
  int material_ = -1;
};

MeshFile parse_obj_text(std::string_view bytes, const std::string& name, ObjColours* colours) {
  if (!looks_like_text(bytes)) {
    throw InputError(name + ": is no OBJ: its first 1024 bytes are not text");
  }
  return ObjReader(bytes, name, colours).read();
}

}  // namespace

bool is_obj(std::string_view bytes) {
  if (!looks_like_text(bytes)) return false;
  TextScanner scan(bytes);
  while (const auto line = scan.next_line()) {
    TextScanner words(line->substr(0, line->find('#')));
    const auto keyword = words.next_word();
    if (!keyword) continue;
    if (*keyword == "v" || *keyword == "f") {
      const auto argument = words.next_word();
      return argument && (parse_double(*argument) || argument->find('/') != argument->npos);
    }
    if (!contains(kSkipped, *keyword) && !contains(kFreeForm, *keyword)) return false;
  }
  return false;
}

MeshFile parse_obj(std::string_view bytes, const std::string& name) {
  return parse_obj_text(bytes, name, nullptr);
}

MeshFile parse_obj(std::string_view bytes, const std::string& name, ObjColours& colours) {
  return parse_obj_text(bytes, name, &colours);
}

std::string format_obj(const geometry::TriangleMesh& mesh) {
  std::string text = "# Palmar; millimetre\n";
  text.reserve(60 * mesh.vertices.size() + 24 * mesh.triangles.size() + 64);
  for (const Vec3& v : mesh.vertices) {
    text += "v " + shortest(v.x()) + " " + shortest(v.y()) + " " + shortest(v.z()) + "\n";
  }
  for (const Triangle& t : mesh.triangles) {
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  }
  return text;
}

}  // namespace palmar::formats
