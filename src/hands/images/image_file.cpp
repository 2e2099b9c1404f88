// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zlib.h>

#include <filesystem>

#include "hands/images/dicom.h"
#include "hands/images/dicom_elements.h"
#include "hands/images/dicom_slice.h"
#include "hands/images/image_formats.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::images {
namespace {

namespace fs = std::filesystem;

bool is_gzip(std::string_view head) { return head.starts_with("\x1f\x8b"); }

}  // namespace

ImageFile read_image(const std::string& path, const SeriesChoice& choice,
                     const Progress& progress) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return read_dicom(path, choice, progress);
  if (!fs::exists(path, ignored)) throw InputError(path + ": no such file or folder");
  progress.update(0.0, "reading " + path);
  const std::string head = formats::read_ends(path, 512).head;
  if (looks_like_dicom(head)) return read_dicom(path, choice, progress);
  const bool is_nifti = head.size() >= 348 && std::string_view(head).substr(344, 2) == "n+";
  if (!is_nifti && !is_gzip(head)) {
    throw InputError(
        path + ": is neither DICOM (a folder of files, or a file of several frames) nor NIfTI");
  }
  const std::string bytes = formats::read_file(path, kMaxImageBytes + 65536);
  ImageFile file = read_nifti(bytes, path);
  for (const imaging::OddSlice& odd : imaging::odd_slices(file.image)) {
    file.odd_slices.push_back(
        odd_slice_text(fmt::format("{}: slice {}", path, odd.index + 1), odd));
  }
  return file;
}

std::string odd_slice_text(const std::string& where, const imaging::OddSlice& odd) {
  return fmt::format(
      "{}: differs {:.1f} times more from both its neighbours than these from each other; it is "
      "damaged, or no part of this image",
      where, odd.ratio);
}

void write_image(const std::string& path, const imaging::Volume& image) {
  if (path.ends_with(".nii")) return formats::write_file(path, nifti_bytes(image, false));
  if (path.ends_with(".nii.gz")) return formats::write_file(path, nifti_bytes(image, true));
  throw OutputError(path + ": ends in neither .nii nor .nii.gz");
}

std::string gunzip(std::string_view bytes, std::size_t size, const std::string& name) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) throw InputError(name + ": zlib can't be started");
  std::string result;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  std::size_t given = 0;
  int status = Z_OK;
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  while (status == Z_OK && result.size() < size) {
    if (stream.avail_in == 0 && given < bytes.size()) {
      const std::size_t count = std::min(bytes.size() - given, kPiece);
      stream.avail_in = static_cast<uInt>(count);
      given += count;
    }
    const std::size_t before = result.size();
    const std::size_t room = std::min(kPiece, size - before);
    result.resize(before + room);
    stream.next_out = reinterpret_cast<Bytef*>(result.data() + before);
    stream.avail_out = static_cast<uInt>(room);
    status = inflate(&stream, Z_NO_FLUSH);
    result.resize(before + room - stream.avail_out);
    if (status == Z_BUF_ERROR && given >= bytes.size()) break;  // cut off
    if (status == Z_BUF_ERROR) status = Z_OK;
  }
  inflateEnd(&stream);
  if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
    throw InputError(
        fmt::format("{}: its compressed data are damaged behind {} bytes", name, result.size()));
  }
  return result;
}

std::string gzip(std::string_view bytes) {
  z_stream stream{};
  // Level 1: noise doesn't shrink by more work.
  if (deflateInit2(&stream, 1, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw OutputError("zlib can't be started");
  }
  std::string result(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  const int status = deflate(&stream, Z_FINISH);
  result.resize(result.size() - stream.avail_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw OutputError("data can't be compressed");
  return result;
}

}  // namespace palmar::images
