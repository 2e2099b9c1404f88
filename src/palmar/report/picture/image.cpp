// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/image.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "palmar/core/error.h"

namespace palmar::report {

namespace {

constexpr int kMaxSide = 16384;  // pixels

// libpng's simplified interface keeps its state in a png_image, which must be freed on every path.
struct PngState {
  png_image png{};
  PngState() { png.version = PNG_IMAGE_VERSION; }
  ~PngState() { png_image_free(&png); }
  PngState(const PngState&) = delete;
  PngState& operator=(const PngState&) = delete;
};

}  // namespace

std::string hex_colour(Rgb colour) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", colour.r, colour.g, colour.b);
  return text.data();
}

Image::Image(int image_width, int image_height, Rgb fill)
    : width(image_width), height(image_height) {
  if (width < 1 || width > kMaxSide || height < 1 || height > kMaxSide) {
    throw UsageError("image size " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels; each side must be 1 to " + std::to_string(kMaxSide));
  }
  pixels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill);
}

std::string encode_png(const Image& image, PngEffort effort) {
  static_assert(sizeof(Rgb) == 3, "rows are handed to libpng as they are");
  if (image.pixels.empty()) throw UsageError("an image of 0 pixels can't be written as PNG");
  PngState state;
  state.png.width = static_cast<png_uint_32>(image.width);
  state.png.height = static_cast<png_uint_32>(image.height);
  state.png.format = PNG_FORMAT_RGB;
  if (effort == PngEffort::kFast) state.png.flags = PNG_IMAGE_FLAG_FAST;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(state.png), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&state.png, bytes.data(), &size, 0, image.pixels.data(), 0,
                                nullptr) == 0) {
    throw OutputError(std::string("PNG encoder: ") + state.png.message);
  }
  bytes.resize(size);
  return bytes;
}

Image narrowed(const Image& image, int width) {
  if (image.width <= width) return image;
  const double step = static_cast<double>(image.width) / width;
  const int height = std::max(1, static_cast<int>(std::lround(image.height / step)));
  const double rise = static_cast<double>(image.height) / height;
  Image result(width, height);
  // Across first, then down: the mean over a rectangle is the mean of means.
  std::vector<std::array<double, 3>> rows(static_cast<std::size_t>(image.height) *
                                          static_cast<std::size_t>(width));
  const auto add_share = [](double from, double to, const auto& add) {
    for (int i = static_cast<int>(from); i < to - 1e-9; ++i) {
      add(i, (std::min(to, i + 1.0) - std::max(from, static_cast<double>(i))) / (to - from));
    }
  };
  const auto row_at = [&](int x, int y) -> std::array<double, 3>& {
    return rows[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::array<double, 3>& sum = row_at(x, y);
      add_share(x * step, std::min<double>((x + 1) * step, image.width), [&](int i, double share) {
        const Rgb c = image.at(i, y);
        sum[0] += share * c.r;
        sum[1] += share * c.g;
        sum[2] += share * c.b;
      });
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::array<double, 3> sum{};
      add_share(y * rise, std::min<double>((y + 1) * rise, image.height), [&](int i, double share) {
        for (std::size_t k = 0; k < 3; ++k) sum[k] += share * row_at(x, i)[k];
      });
      const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(sum[k] + 0.5); };
      result.at(x, y) = {byte(0), byte(1), byte(2)};
    }
  }
  return result;
}

Image decode_png(std::string_view bytes) {
  PngState state;
  if (png_image_begin_read_from_memory(&state.png, bytes.data(), bytes.size()) == 0) {
    throw InputError(std::string("not a PNG picture: ") + state.png.message);
  }
  Image image(static_cast<int>(state.png.width), static_cast<int>(state.png.height));
  state.png.format = PNG_FORMAT_RGB;
  const png_color background{255, 255, 255};
  if (png_image_finish_read(&state.png, &background, image.pixels.data(), 0, nullptr) == 0) {
    throw InputError(std::string("broken PNG picture: ") + state.png.message);
  }
  return image;
}

}  // namespace palmar::report
