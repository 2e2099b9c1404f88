// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/hand_export.h"

#include <algorithm>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/glb_fields.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/image.h"
#include "palmar/report/picture/render.h"

namespace palmar::report {
namespace {

formats::VertexColour vertex_colour(Rgb colour) { return {colour.r, colour.g, colour.b}; }

std::string format_hand_glb(const hand::Hand& hand, const geometry::TriangleMesh& skin,
                            const hand::Posture& posture) {
  formats::FieldMesh skin_mesh{.name = "skin", .mesh = skin, .colour = {}, .field = {}};
  for (const hand::Region region : hand.region)
    skin_mesh.colour.push_back(vertex_colour(region_colour(region)));
  std::vector<formats::FieldMesh> meshes = {std::move(skin_mesh)};
  const std::vector<geometry::TriangleMesh> bones = hand::pose_bones(hand, posture);
  for (std::size_t i = 0; i < bones.size(); ++i) {
    meshes.push_back({.name = hand.bones[i].name,
                      .mesh = bones[i],
                      .colour = {vertex_colour(kBoneColour)},
                      .field = {}});
  }
  return formats::format_glb_fields(meshes);
}

/// The posed skin seen from the palmar, the dorsal and the thumb's side, next to each other at one
/// scale.
Image hand_picture(const geometry::TriangleMesh& skin, hand::Side side) {
  const double radial = side == hand::Side::kRight ? 1.0 : -1.0;
  const Scene scene = {{.mesh = skin, .colour = kSkinColour, .vertex_colours = {}}};
  std::vector<Camera> cameras;
  double view_height = 0.0;
  for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(-radial, 0, -0.15)}) {
    cameras.push_back(fit_camera(scene, direction, Vec3::UnitY(), {.aspect = 0.8}));
    view_height = std::max(view_height, cameras.back().view_height);
  }
  constexpr int kWidth = 480, kHeight = 600;  // pixels of one view
  Image picture(kWidth * static_cast<int>(cameras.size()), kHeight);
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    cameras[v].view_height = view_height;
    const Image view = render_scene(scene, cameras[v], {.width = kWidth, .height = kHeight});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x)
        picture.at(kWidth * static_cast<int>(v) + x, y) = view.at(x, y);
    }
  }
  return picture;
}

}  // namespace

void export_posed_hand(const std::string& path, const hand::Hand& hand,
                       const hand::Posture& posture) {
  const std::string ending = std::filesystem::path(path).extension().string();
  const geometry::TriangleMesh skin{hand::pose_skin(hand, posture), hand.skin.triangles};
  if (ending == ".glb") {
    formats::write_file(path, format_hand_glb(hand, skin, posture));
  } else if (ending == ".png") {
    formats::write_file(path, encode_png(hand_picture(skin, hand.side)));
  } else if (ending == ".ply" || ending == ".obj" || ending == ".stl") {
    formats::write_mesh(path, skin);
  } else {
    throw UsageError(path + ": the ending \"" + ending +
                     "\" is not known; .glb, .ply, .obj, .stl or .png is allowed");
  }
}

}  // namespace palmar::report
