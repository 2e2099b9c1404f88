// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/texture_file.h"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
// After stdio, which it needs and doesn't include.
#include <jpeglib.h>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

void check_size(std::uint64_t width, std::uint64_t height, const std::string& name) {
  if (width < 1 || height < 1 || width > kMaxTextureSide || height > kMaxTextureSide) {
    throw InputError(fmt::format("{}: has {} x {} pixels; 1 to {} each way are read", name, width,
                                 height, kMaxTextureSide));
  }
}

geometry::RgbImage read_png(std::string_view bytes, const std::string& name) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const auto fail = [&] {
    const std::string message = png.message;
    png_image_free(&png);
    throw InputError(name + ": is no valid PNG: " + message);
  };
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) fail();
  try {
    check_size(png.width, png.height, name);
  } catch (...) {
    png_image_free(&png);
    throw;
  }
  png.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(png));
  geometry::RgbImage image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  if (png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr) == 0) fail();
  image.rgb.resize(rgba.size() / 4 * 3);
  for (std::size_t p = 0; p < rgba.size() / 4; ++p) {
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * p + c] = rgba[4 * p + c];
  }
  return image;
}

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
  std::array<char, JMSG_LENGTH_MAX> message;
};

extern "C" void leave_jpeg(j_common_ptr decoder) {
  auto* errors = reinterpret_cast<JpegErrors*>(decoder->err);
  (*decoder->err->format_message)(decoder, errors->message.data());
  std::longjmp(errors->back, 1);
}
extern "C" void keep_silent(j_common_ptr /*decoder*/, int /*level*/) {}
/// Counts warnings, which say that data are damaged or missing, and keeps the first.
extern "C" void keep_warning(j_common_ptr decoder, int level) {
  if (level >= 0) return;  // traces
  auto* errors = reinterpret_cast<JpegErrors*>(decoder->err);
  if (errors->base.num_warnings++ == 0) {
    (*errors->base.format_message)(decoder, errors->message.data());
  }
}

// The decoder's part by itself: nothing with a destructor may live where longjmp() leaves from.
// Returns false with errors.message set.
bool decode_jpeg(std::string_view bytes, jpeg_decompress_struct& decoder, JpegErrors& errors,
                 geometry::RgbImage& image) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_create_decompress(&decoder);
  jpeg_mem_src(&decoder, reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&decoder, TRUE);
  decoder.out_color_space = JCS_RGB;
  image.width = static_cast<int>(decoder.image_width);
  image.height = static_cast<int>(decoder.image_height);
  if (image.width > kMaxTextureSide || image.height > kMaxTextureSide) return true;
  jpeg_start_decompress(&decoder);
  image.rgb.resize(std::size_t{3} * decoder.output_width * decoder.output_height);
  while (decoder.output_scanline < decoder.output_height) {
    JSAMPROW row =
        image.rgb.data() + std::size_t{3} * decoder.output_width * decoder.output_scanline;
    jpeg_read_scanlines(&decoder, &row, 1);
  }
  jpeg_finish_decompress(&decoder);
  return true;
}

geometry::RgbImage read_jpeg(std::string_view bytes, const std::string& name) {
  jpeg_decompress_struct decoder{};
  JpegErrors errors{};
  decoder.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = leave_jpeg;
  errors.base.emit_message = keep_warning;
  geometry::RgbImage image;
  const bool is_read = decode_jpeg(bytes, decoder, errors, image);
  const long warnings = errors.base.num_warnings;
  jpeg_destroy_decompress(&decoder);
  if (!is_read) throw InputError(name + ": is no valid JPEG: " + errors.message.data());
  check_size(static_cast<std::uint64_t>(image.width), static_cast<std::uint64_t>(image.height),
             name);
  if (warnings > 0) {
    throw InputError(name + ": is a damaged or truncated JPEG: " + errors.message.data());
  }
  return image;
}

// As decode_jpeg().
bool encode_jpeg(const geometry::RgbImage& image, int quality, const std::string& exif,
                 jpeg_compress_struct& encoder, JpegErrors& errors, unsigned char*& bytes,
                 unsigned long& size) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_create_compress(&encoder);
  jpeg_mem_dest(&encoder, &bytes, &size);
  encoder.image_width = static_cast<JDIMENSION>(image.width);
  encoder.image_height = static_cast<JDIMENSION>(image.height);
  encoder.input_components = 3;
  encoder.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  if (!exif.empty()) encoder.write_JFIF_header = FALSE;
  jpeg_start_compress(&encoder, TRUE);
  if (!exif.empty()) {
    jpeg_write_marker(&encoder, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                      static_cast<unsigned int>(exif.size()));
  }
  while (encoder.next_scanline < encoder.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image.rgb.data()) +
                   std::size_t{3} * encoder.image_width * encoder.next_scanline;
    jpeg_write_scanlines(&encoder, &row, 1);
  }
  jpeg_finish_compress(&encoder);
  return true;
}

}  // namespace

geometry::RgbImage read_texture(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\x89PNG")) return read_png(bytes, name);
  if (bytes.starts_with("\xff\xd8\xff")) return read_jpeg(bytes, name);
  throw InputError(name + ": is neither PNG nor JPEG: starts with " +
                   in_quotes(bytes.substr(0, 8)));
}

std::string format_png(const geometry::RgbImage& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    throw Error(std::string("can't make a PNG: ") + png.message);
  }
  bytes.resize(size);
  return bytes;
}

std::string format_jpeg(const geometry::RgbImage& image, int quality, const std::string& exif) {
  if (quality < 1 || quality > 100) {
    throw UsageError(fmt::format("JPEG quality {}; 1 to 100 is allowed", quality));
  }
  if (image.rgb.empty()) throw UsageError("an image without pixels can't be written");
  jpeg_compress_struct encoder{};
  JpegErrors errors{};
  encoder.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = leave_jpeg;
  errors.base.emit_message = keep_silent;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool is_written = encode_jpeg(image, quality, exif, encoder, errors, bytes, size);
  std::string result(reinterpret_cast<const char*>(bytes), is_written ? size : 0);
  jpeg_destroy_compress(&encoder);
  std::free(bytes);
  if (!is_written) throw Error(std::string("can't make a JPEG: ") + errors.message.data());
  return result;
}

}  // namespace palmar::formats
