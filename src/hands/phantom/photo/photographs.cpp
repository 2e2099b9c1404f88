// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/photo/photographs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::phantom {
namespace {

float linear_of(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

float srgb_of(float linear) {
  const float c = std::clamp(linear, 0.0F, 1.0F);
  return c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
}

capture::Vec3f linear_of(const capture::Vec3f& srgb) {
  return {linear_of(srgb[0]), linear_of(srgb[1]), linear_of(srgb[2])};
}

/// Scrambles; a few steps suffice for pictures.
std::uint32_t scrambled(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

float unit_of(std::uint32_t bits) { return (static_cast<float>(bits >> 8) + 0.5F) * 0x1p-24F; }

/// Smooth noise about 0 with a deviation of about 0.4, one swell per unit.
float swell(const capture::Vec3f& at, std::uint32_t seed) {
  std::array<int, 3> low{};
  std::array<float, 3> f{};
  for (int a = 0; a < 3; ++a) {
    const float floor = std::floor(at[a]);
    low[a] = static_cast<int>(floor);
    const float t = at[a] - floor;
    f[a] = t * t * (3.0F - 2.0F * t);
  }
  float sum = 0.0F;
  for (std::uint32_t n = 0; n < 8; ++n) {
    std::uint32_t hash = seed;
    float share = 1.0F;
    for (std::size_t a = 0; a < 3; ++a) {
      const bool is_high = ((n >> a) & 1U) != 0;
      share *= is_high ? f[a] : 1.0F - f[a];
      hash = scrambled(hash ^ static_cast<std::uint32_t>(low[a] + (is_high ? 1 : 0)));
    }
    sum += share * (unit_of(hash) - 0.5F);
  }
  return 2.0F * sum;
}

/// Unevenness of skin at a point fixed to it: swells of 0.6 to 9 mm; deviation about 1.
float unevenness(const capture::Vec3f& at, std::uint32_t seed) {
  float sum = 0.0F;
  float size = 0.6F;  // mm
  constexpr int kOctaves = 5;
  for (std::uint32_t o = 0; o < kOctaves; ++o, size *= 2.0F)
    sum += swell(at / size, seed + 7919U * o);
  return sum * 1.3F;
}

/// A lamp: a sphere.
struct Lamp {
  Vec3 centre;
  double radius;
  float strength;
};

struct Colours {
  capture::Vec3f paper = capture::Vec3f::Constant(0.80F), ink = capture::Vec3f::Constant(0.04F);
  capture::Vec3f cloth = linear_of(capture::Vec3f(0.13F, 0.27F, 0.62F));
};

constexpr float kAmbient = 0.42F;
constexpr int kSide = 2;  // points of a pixel along an edge

}  // namespace

struct PhotographsStage::Impl {
  PhotographsOptions options;
  PrintedBoard board;
  geometry::TriangleMesh mesh;
  std::vector<capture::Vec3f> albedo;  ///< per vertex, linear
  std::vector<capture::Vec3f> normals;
  Box3 box;
  std::unique_ptr<geometry::RayQuery> query;
  Colours colours;

  /// Most rays don't come near the hand.
  std::optional<geometry::RayHit> first_hit(const Vec3& origin, const Vec3& direction, double from,
                                            double to) const {
    double enter = from, leave = to;
    for (int a = 0; a < 3; ++a) {
      const double inverse = 1.0 / direction[a];
      const double one = (box.min()[a] - origin[a]) * inverse;
      const double other = (box.max()[a] - origin[a]) * inverse;
      enter = std::max(enter, std::min(one, other));
      leave = std::min(leave, std::max(one, other));
    }
    if (!(enter <= leave)) return {};
    return query->first_hit(origin, direction, from, to);
  }

  float ink_at(double x, double y) const {
    const double half = 0.5 * board.edge;
    if (board.pixels == 0 || std::abs(x) >= half || std::abs(y) >= half) return 0.0F;
    const double u = (x + half) / board.edge * board.pixels,
                 v = (half - y) / board.edge * board.pixels;
    const int i = std::clamp(static_cast<int>(u), 0, board.pixels - 1);
    const int j = std::clamp(static_cast<int>(v), 0, board.pixels - 1);
    return 1.0F -
           static_cast<float>(board.grey[static_cast<std::size_t>(j) * board.pixels + i]) / 255.0F;
  }

  /// Whether a point of its plane lies on the sheet, whose corners may be round.
  bool is_on_sheet(const Vec3& at) const {
    const double height = board.sheet_height > 0.0 ? board.sheet_height : board.sheet;
    const Eigen::Vector2d out(std::abs(at.x()) - 0.5 * board.sheet + board.corner,
                              std::abs(at.y()) - 0.5 * height + board.corner);
    if (board.corner <= 0.0) return out.maxCoeff() < 0.0;
    return out.maxCoeff() < board.corner && out.cwiseMax(0.0).norm() < board.corner;
  }

  std::array<Lamp, 2> lamps(double turn) const {
    const Eigen::AngleAxisd about(turn, Vec3::UnitZ());
    return {Lamp{about * Vec3(500.0, -600.0, 800.0), 170.0, 0.75F},
            Lamp{about * Vec3(-700.0, 350.0, 700.0), 170.0, 0.55F}};
  }
};

namespace {

/// What one photograph needs.
class Shutter {
 public:
  Shutter(const PhotographsStage::Impl& stage, const PhotoShot& shot,
          const geometry::Rigid3& board_from_hand, int number)
      : stage_(stage), shot_(shot), hand_from_board_(board_from_hand.inverse()), number_(number) {
    const double turn = stage.options.light_on_rig
                            ? stage.options.step * shot.position * std::numbers::pi / 180.0
                            : 0.0;
    lamps_ = stage.lamps(turn);
    board_from_camera_ = shot.pose.camera_from_world.inverse();
    focus_ = stage.options.distance + stage.options.focus;
  }

  geometry::RgbImage take() {
    const capture::PhotoLens& lens = shot_.pose.lens;
    // Directions at the corners of the pixels; between them they are as good as linear.
    const int columns = lens.width + 1;
    const LensTerms terms = lens_terms(stage_.options, shot_.camera);
    corners_.resize(static_cast<std::size_t>(columns) * (lens.height + 1));
    parallel_for(lens.height + 1, [&](int y) {
      for (int x = 0; x < columns; ++x) {
        corners_[static_cast<std::size_t>(y) * columns + x] =
            bent(terms, lens.direction_of({x - 0.5, y - 0.5}));
      }
    });
    std::vector<capture::Vec3f> light(static_cast<std::size_t>(lens.width) * lens.height);
    parallel_for(lens.height, [&](int y) {
      for (int x = 0; x < lens.width; ++x) {
        capture::Vec3f sum = capture::Vec3f::Zero();
        for (int s = 0; s < kSide * kSide; ++s) sum += sample(x, y, s);
        light[static_cast<std::size_t>(y) * lens.width + x] =
            darkened(x, y) * sum / static_cast<float>(kSide * kSide);
      }
    });
    blur(light, lens.width, lens.height);
    return developed(light);
  }

 private:
  /// What the lens leaves of the light.
  float darkened(int x, int y) const {
    const capture::PhotoLens& lens = shot_.pose.lens;
    const Eigen::Vector2d half(0.5 * lens.width, 0.5 * lens.height);
    const double out = (Eigen::Vector2d(x, y) - half).squaredNorm() / half.squaredNorm();
    return static_cast<float>(1.0 - stage_.options.vignetting * out);
  }

  capture::Vec3f sample(int x, int y, int s) const {
    const std::uint32_t key =
        scrambled(static_cast<std::uint32_t>(x) ^
                  scrambled(static_cast<std::uint32_t>(y * kSide * kSide + s) ^
                            scrambled(static_cast<std::uint32_t>(number_) ^
                                      static_cast<std::uint32_t>(stage_.options.seed << 8))));
    std::uint32_t next = key;
    const auto random = [&next] { return unit_of(next = scrambled(next + 0x9e3779b9U)); };
    const double u = (s % kSide + random()) / kSide;
    const double v = (static_cast<double>(s / kSide) + random()) / kSide;
    // Through a point of the lens to where the pixel is in focus.
    const auto columns = static_cast<std::size_t>(shot_.pose.lens.width + 1);
    const Eigen::Vector2d* const corner = &corners_[static_cast<std::size_t>(y) * columns + x];
    const Eigen::Vector2d plane = (1 - v) * ((1 - u) * corner[0] + u * corner[1]) +
                                  v * ((1 - u) * corner[columns] + u * corner[columns + 1]);
    const Vec3 towards = plane.homogeneous();
    const double radius = 0.5 * stage_.options.aperture * std::sqrt(random());
    const double angle = 2.0 * std::numbers::pi * random();
    const Vec3 on_lens(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    const Vec3 origin = board_from_camera_ * on_lens;
    const Vec3 direction =
        (board_from_camera_.rotation * (focus_ * towards - on_lens)).normalized();
    return shot_.gain * seen(origin, direction, x, y, random);
  }

  template <typename Random>
  capture::Vec3f seen(const Vec3& origin, const Vec3& direction, int x, int y,
                      Random& random) const {
    double far = std::numeric_limits<double>::infinity();
    const PrintedBoard& board = stage_.board;
    double to_board = -1.0;
    bool is_sheet = false;
    if (direction.z() < 0.0) {
      to_board = (board.thickness - origin.z()) / direction.z();
      is_sheet = stage_.is_on_sheet(origin + to_board * direction);
      if (!is_sheet) to_board = -origin.z() / direction.z();
      if (board.table || is_sheet) {
        far = to_board;
      } else {
        to_board = -1.0;
      }
    }
    if (stage_.query) {
      const Vec3 o = hand_from_board_ * origin;
      const Vec3 d = hand_from_board_.rotation * direction;
      const auto hit = stage_.first_hit(o, d, 0.0, far);
      if (hit) {
        return skin(o + hit->distance * d, d, hit->triangle, random);
      }
    }
    if (to_board > 0.0) {
      const Vec3 at = origin + to_board * direction;
      const float ink = stage_.ink_at(at.x(), at.y());
      capture::Vec3f albedo =
          stage_.colours.paper + ink * (stage_.colours.ink - stage_.colours.paper);
      if (!is_sheet) {
        const capture::Vec3f grain(static_cast<float>(at.x()) / 60.0F,
                                   static_cast<float>(at.y()) / 4.0F, 0.0F);
        albedo = linear_of(*board.table) *
                 std::max(0.3F, 1.0F + static_cast<float>(board.grain) * swell(grain, 23U));
      }
      const Vec3 o = hand_from_board_ * at;
      const Vec3 n = hand_from_board_.rotation * Vec3::UnitZ();
      return albedo * irradiance(o, n, random);
    }
    return behind(x, y, direction);
  }

  /// Light on a point of the hand's frame.
  template <typename Random>
  float irradiance(const Vec3& at, const Vec3& normal, Random& random) const {
    const Vec3 up = hand_from_board_.rotation * Vec3::UnitZ();
    float sum = kAmbient * static_cast<float>(0.65 + 0.35 * normal.dot(up));
    for (const Lamp& lamp : lamps_) {
      const double z = random(), y = random(),
                   x = random();  // one after the other, for all compilers
      const Vec3 spread(x - 0.5, y - 0.5, z - 0.5);
      const Vec3 way = hand_from_board_ * Vec3(lamp.centre + 2.0 * lamp.radius * spread) - at;
      const double distance = way.norm();
      const double cosine = normal.dot(way) / distance;
      if (cosine <= 0.0) continue;
      if (stage_.query) {
        constexpr double kLift = 0.15;  // mm
        if (stage_.first_hit(at + kLift * normal, way / distance, 0.05, distance)) continue;
      }
      sum += lamp.strength * static_cast<float>(cosine);
    }
    return sum;
  }

  template <typename Random>
  capture::Vec3f skin(const Vec3& at, const Vec3& direction, int triangle, Random& random) const {
    const Triangle& t = stage_.mesh.triangles[triangle];
    const auto corner = [&](std::size_t c) -> const Vec3& { return stage_.mesh.vertices[t[c]]; };
    const Vec3 cross = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const double area = cross.squaredNorm();
    std::array<float, 3> share{};
    for (std::size_t c = 0; c < 3; ++c) {
      share[c] = static_cast<float>(
          (corner((c + 1) % 3) - at).cross(corner((c + 2) % 3) - at).dot(cross) / area);
    }
    capture::Vec3f albedo = capture::Vec3f::Zero(), normal = capture::Vec3f::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      albedo += share[c] * stage_.albedo[t[c]];
      normal += share[c] * stage_.normals[t[c]];
    }
    const auto texture = static_cast<float>(stage_.options.texture);
    if (texture > 0.0F) {
      albedo *= std::max(
          0.1F, 1.0F + texture * unevenness(at.cast<float>(),
                                            static_cast<std::uint32_t>(stage_.options.seed)));
    }
    const Vec3 n = normal.cast<double>().normalized();
    capture::Vec3f light = albedo * irradiance(at, n, random);
    if (stage_.options.gloss > 0.0) {
      const Vec3 mirrored = direction - 2.0 * n.dot(direction) * n;
      for (const Lamp& lamp : lamps_) {
        const Vec3 way = (hand_from_board_ * lamp.centre - at).normalized();
        constexpr double kExponent = 30.0;
        const double along = mirrored.dot(way);
        if (along > 0.0 && n.dot(way) > 0.0) {
          light += capture::Vec3f::Constant(static_cast<float>(
              stage_.options.gloss * lamp.strength * std::pow(along, kExponent)));
        }
      }
    }
    return light;
  }

  capture::Vec3f behind(int x, int y, const Vec3& direction) const {
    if (!stage_.options.clutter) {
      return stage_.colours.cloth * static_cast<float>(0.75 + 0.25 * direction.z());
    }
    const capture::Vec3f at(static_cast<float>(x) / 37.0F, static_cast<float>(y) / 37.0F,
                            static_cast<float>(shot_.camera) * 17.0F);
    const float a = swell(at, 11U) + 0.5F * swell(4.0F * at, 12U);
    const float b = swell(1.7F * at, 13U);
    return linear_of(
               capture::Vec3f(0.62F + 0.3F * a, 0.46F + 0.25F * a + 0.05F * b, 0.36F + 0.2F * a))
        .cwiseMax(0.02F)
        .cwiseMin(0.9F);
  }

  void blur(std::vector<capture::Vec3f>& light, int width, int height) const {
    const double sigma = stage_.options.blur;
    if (sigma <= 0.0) return;
    const int reach = static_cast<int>(std::ceil(3.0 * sigma));
    std::vector<float> weight;
    for (int i = -reach; i <= reach; ++i) {
      weight.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
    }
    std::vector<capture::Vec3f> other(light.size());
    const auto pass = [&](const std::vector<capture::Vec3f>& from, std::vector<capture::Vec3f>& to,
                          int dx, int dy) {
      parallel_for(height, [&](int y) {
        for (int x = 0; x < width; ++x) {
          capture::Vec3f sum = capture::Vec3f::Zero();
          float whole = 0.0F;
          for (int i = -reach; i <= reach; ++i) {
            const int u = std::clamp(x + i * dx, 0, width - 1);
            const int v = std::clamp(y + i * dy, 0, height - 1);
            const float w = weight[i + reach];
            sum += w * from[static_cast<std::size_t>(v) * width + u];
            whole += w;
          }
          to[static_cast<std::size_t>(y) * width + x] = sum / whole;
        }
      });
    };
    pass(light, other, 1, 0);
    pass(other, light, 0, 1);
  }

  geometry::RgbImage developed(const std::vector<capture::Vec3f>& light) const {
    const capture::PhotoLens& lens = shot_.pose.lens;
    geometry::RgbImage image{lens.width, lens.height, {}};
    image.rgb.resize(3 * light.size());
    const auto noise = static_cast<float>(stage_.options.noise);
    const auto tone = static_cast<float>(stage_.options.tone);
    parallel_for(lens.height, [&](int y) {
      RandomStream random(stage_.options.seed, (static_cast<std::uint64_t>(number_ + 1) << 32) +
                                                   static_cast<std::uint64_t>(y));
      for (int x = 0; x < lens.width; ++x) {
        const std::size_t at = capture::pixel_offset(image, x, y);
        for (std::size_t c = 0; c < 3; ++c) {
          const float even = srgb_of(light[at / 3][static_cast<int>(c)]);
          float value = 255.0F * (even + tone * even * (1.0F - even) * (2.0F * even - 1.0F));
          if (noise > 0.0F) {
            // The sum of four even numbers is near enough to a normal one.
            const std::uint64_t bits = random.bits();
            const float sum = static_cast<float>((bits & 0xffff) + ((bits >> 16) & 0xffff) +
                                                 ((bits >> 32) & 0xffff) + (bits >> 48)) /
                              65536.0F;
            value += noise * (sum - 2.0F) * std::sqrt(3.0F);
          }
          image.rgb[at + c] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
        }
      }
    });
    return image;
  }

  const PhotographsStage::Impl& stage_;
  const PhotoShot& shot_;
  geometry::Rigid3 hand_from_board_, board_from_camera_;
  int number_;
  std::array<Lamp, 2> lamps_;
  std::vector<Eigen::Vector2d> corners_;
  double focus_ = 0.0;
};

}  // namespace

PhotographsStage::PhotographsStage(const geometry::ColouredMesh& hand, const PrintedBoard& board,
                                   const PhotographsOptions& options) {
  options.check();
  if (hand.colour.size() != hand.mesh.vertices.size()) {
    throw UsageError("a hand to be photographed needs one colour per vertex");
  }
  auto impl = std::make_unique<Impl>();
  impl->options = options;
  impl->board = board;
  if (board.paper) impl->colours.paper = linear_of(*board.paper);
  impl->mesh = hand.mesh;
  for (const capture::Vec3f& colour : hand.colour) impl->albedo.push_back(linear_of(colour));
  for (const Vec3& normal : geometry::vertex_normals(hand.mesh))
    impl->normals.push_back(normal.cast<float>());
  impl->box = geometry::bounding_box(hand.mesh);
  if (!hand.mesh.triangles.empty()) impl->query = std::make_unique<geometry::RayQuery>(hand.mesh);
  impl_ = std::move(impl);
}

PhotographsStage::~PhotographsStage() = default;

geometry::RgbImage PhotographsStage::take(const PhotoShot& shot,
                                          const geometry::Rigid3& board_from_hand,
                                          int number) const {
  return Shutter(*impl_, shot, board_from_hand, number).take();
}

}  // namespace palmar::phantom
