// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Damaged input: every reader must end with a mesh or an InputError, soon, whatever the bytes. The
// mutations come from a fixed seed, so a failure repeats.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <random>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/glb_fields.h"
#include "palmar/formats/mesh/gltf.h"
#include "palmar/formats/mesh/obj.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/formats/mesh/stl.h"
#include "palmar/formats/mesh/test_archives.h"
#include "palmar/formats/mesh/three_mf.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::string operator()(std::string bytes) {
    const int changes = 1 + below(4);
    for (int i = 0; i < changes && !bytes.empty(); ++i) change(bytes);
    return bytes;
  }

 private:
  // std::uniform_int_distribution differs between libraries; the remainder doesn't.
  int below(std::size_t bound) { return static_cast<int>(random_() % bound); }

  void change(std::string& bytes) {
    static const std::vector<std::string> kWords = {
        "-1",    "0",   "4294967295", "99999999999999999999",
        "1e309", "nan", "-inf",       "2147483648",
        "\n",    " ",   "/",          "\\\n",
        "\"",    "<",   ">",          "{",
        "[",     "f ",  "v ",         "list",
        "e",     "PK",  ":",          "-9223372036854775808"};
    const auto at = static_cast<std::size_t>(below(bytes.size()));
    switch (below(7)) {
      case 0:  // cut off
        bytes.resize(at);
        break;
      case 1:  // flip one bit
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:  // one byte at will
        bytes[at] = static_cast<char>(below(256));
        break;
      case 3:  // the extremes of a 32-bit number
        for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k) {
          bytes[k] = static_cast<char>(below(2) == 0 ? 0xff : 0x7f);
        }
        break;
      case 4: {  // replace a number in text
        const std::size_t start = bytes.find_first_of("0123456789", at);
        if (start == bytes.npos) break;
        const std::size_t end =
            std::min(bytes.find_first_not_of("0123456789.", start), bytes.size());
        bytes.replace(start, end - start, kWords[static_cast<std::size_t>(below(8))]);
        break;
      }
      case 5:  // put in a word that means something to a parser
        bytes.insert(at, kWords[static_cast<std::size_t>(below(kWords.size()))]);
        break;
      default: {  // repeat or drop a piece
        const std::string piece = bytes.substr(at, static_cast<std::size_t>(1 + below(60)));
        if (below(2) == 0) {
          bytes.insert(at, piece);
        } else {
          bytes.erase(at, piece.size());
        }
      }
    }
  }

  std::mt19937_64 random_;
};

void check_promises(const geometry::TriangleMesh& mesh) {
  ASSERT_GT(mesh.triangle_count(), 0);
  for (const Vec3& v : mesh.vertices) ASSERT_LE(v.cwiseAbs().maxCoeff(), 1e12);
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) ASSERT_TRUE(v >= 0 && v < mesh.vertex_count());
    ASSERT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
  }
}

/// Reads `count` mutations of `seed_bytes`; gives how many were still readable.
int fuzz(const std::string& seed_bytes, int count,
         const std::function<MeshFile(const std::string&)>& parse) {
  Mutator mutate(20140325);
  int readable = 0;
  double slowest = 0.0;
  for (int i = 0; i < count; ++i) {
    const std::string bytes = mutate(seed_bytes);
    const auto start = std::chrono::steady_clock::now();
    try {
      check_promises(parse(bytes).mesh);
      ++readable;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("x."), std::string::npos) << error.what();
    }
    slowest = std::max(
        slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (testing::Test::HasFatalFailure()) {
      ADD_FAILURE() << "mutation " << i;
      break;
    }
  }
  // A hang would show as seconds; a fair read of these small files takes microseconds.
  EXPECT_LT(slowest, 2.0) << "s for one file";
  return readable;
}

constexpr int kCount = 6000;

TEST(MeshFuzz, BinaryStl) {
  fuzz(format_stl(box_mesh({1, 2, 3})), kCount,
       [](const std::string& bytes) { return parse_stl(bytes, "x.stl"); });
}

TEST(MeshFuzz, AsciiStl) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.5 0 0\nvertex 0 1e1 "
      "0\nendloop\nendfacet\n";
  EXPECT_GT(fuzz("solid a\n" + facet + facet + "endsolid a\n", kCount,
                 [](const std::string& bytes) { return parse_stl(bytes, "x.stl"); }),
            0);
}

TEST(MeshFuzz, Obj) {
  EXPECT_GT(fuzz("# box\n" + format_obj(box_mesh({1, 2, 3})) +
                     "f 1 2 4 3 7 8 6 5\nf -1/1 -2//2 \\\n -3/3/3 -4\ncurv 1 2\n",
                 kCount, [](const std::string& bytes) { return parse_obj(bytes, "x.obj"); }),
            0);
}

TEST(MeshFuzz, AsciiPly) {
  EXPECT_GT(
      fuzz("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
           "y\nproperty double z\nproperty list uchar int k\nelement face 2\nproperty list "
           "uchar int vertex_indices\nend_header\n0 0 0 0\n1 0 0 1 5\n1 1 0 0\n0 1 0 0\n4 0 1 "
           "2 3\n3 0 1 2\n",
           kCount, [](const std::string& bytes) { return parse_ply(bytes, "x.ply"); }),
      0);
}

TEST(MeshFuzz, BinaryPly) {
  const std::string little = format_ply(box_mesh({1, 2, 3}));
  std::string big = little;
  big.replace(big.find("little"), 6, "big");
  for (const std::string& seed : {little, big}) {
    fuzz(seed, kCount, [](const std::string& bytes) { return parse_ply(bytes, "x.ply"); });
  }
}

TEST(MeshFuzz, GltfAndGlb) {
  const std::string glb =
      format_glb_fields({{.name = "b", .mesh = box_mesh({1, 2, 3}), .colour = {}, .field = {}}});
  EXPECT_GT(fuzz(glb, kCount, [](const std::string& bytes) { return parse_gltf(bytes, "x.glb"); }),
            0);
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,)"
      R"("children":[2],"scale":[1,2,3]},{"mesh":0},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1],)"
      R"("mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}],"buffers":)"
      R"([{"byteLength":36,"uri":"data:;base64,)" +
      base64(std::string(12, '\0') + std::string("\0\0\x80\x3f", 4) + std::string(12, '\0') +
             std::string("\0\0\x80\x3f", 4) + std::string(4, '\0')) +
      R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":3,"type":"VEC3"}]})";
  EXPECT_GT(
      fuzz(json, kCount, [](const std::string& bytes) { return parse_gltf(bytes, "x.gltf"); }), 0);
}

TEST(MeshFuzz, ThreeMf) {
  const std::string model = model_xml(
      "<object id=\"1\">" + mesh_xml(box_mesh({1, 2, 3})) +
          "</object><object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 "
          "0 0 1 5 0 0\"/><component objectid=\"1\"/></components></object>",
      "<item objectid=\"2\"/><item objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 0 0 0\"/>",
      "unit=\"inch\"");
  const auto parse = [](const std::string& bytes) { return parse_three_mf(bytes, "x.3mf"); };
  // The archive damaged, and the model inside a sound archive damaged.
  for (const bool deflated : {false, true}) {
    fuzz(zip_bytes({{"3D/3dmodel.model", model}}, deflated), kCount / 2, parse);
  }
  EXPECT_GT(fuzz(model, kCount,
                 [&](const std::string& bytes) {
                   return parse(zip_bytes({{"3D/3dmodel.model", bytes}}, false));
                 }),
            0);
}

}  // namespace
}  // namespace palmar::formats
