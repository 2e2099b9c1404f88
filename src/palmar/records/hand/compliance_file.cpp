// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/compliance_file.h"

#include <string_view>
#include <system_error>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/file.h"
#include "palmar/formats/sha256.h"

namespace palmar::records {
namespace {

constexpr std::string_view kMagic = "palmar skin compliance 2\n";
constexpr std::uint64_t kMostComplianceBytes = std::uint64_t{1} << 30;

void append_mesh(std::string& bytes, const geometry::TriangleMesh& mesh) {
  formats::append_value<std::uint64_t>(bytes, mesh.vertices.size());
  formats::append_value<std::uint64_t>(bytes, mesh.triangles.size());
  for (const Vec3& x : mesh.vertices) {
    for (int k = 0; k < 3; ++k) formats::append_value<double>(bytes, x[k]);
  }
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) formats::append_value<std::int32_t>(bytes, v);
  }
}

/// Reads values one after the other; `is_good` until there are too few.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <typename T>
  T next() {
    if (at_ + sizeof(T) > bytes_.size()) {
      is_good = false;
      return T{};
    }
    at_ += sizeof(T);
    return formats::read_value<T>(bytes_, at_ - sizeof(T));
  }
  std::string_view text(std::size_t length) {
    if (at_ + length > bytes_.size()) {
      is_good = false;
      return {};
    }
    at_ += length;
    return bytes_.substr(at_ - length, length);
  }
  std::size_t left() const { return bytes_.size() - at_; }
  bool is_good = true;

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// A count that the rest of the file has room for.
std::optional<int> count_from(ByteReader& reader, std::size_t bytes_each) {
  const auto count = reader.next<std::uint32_t>();
  if (!reader.is_good || count > reader.left() / bytes_each) return std::nullopt;
  return static_cast<int>(count);
}

/// Ascending indices below `end`.
bool read_ascending(ByteReader& reader, std::int64_t end, std::vector<int>& result) {
  const auto count = count_from(reader, 4);
  if (!count) return false;
  for (int i = 0; i < *count; ++i) {
    const auto value = reader.next<std::int32_t>();
    if (value < 0 || value >= end || (!result.empty() && value <= result.back())) return false;
    result.push_back(value);
  }
  return true;
}

/// Entries of the rows, one after the other; each row's last is its diagonal.
bool read_rows(ByteReader& reader, contact::SkinCompliance& result) {
  result.begin.push_back(0);
  for (std::size_t i = 0; i < result.vertex.size(); ++i) {
    std::vector<int> row;
    if (!read_ascending(reader, static_cast<std::int64_t>(i) + 1, row)) return false;
    if (row.empty() || row.back() != static_cast<int>(i)) return false;
    result.other.insert(result.other.end(), row.begin(), row.end());
    result.begin.push_back(result.other.size());
  }
  const std::string_view values = reader.text(9 * sizeof(float) * result.other.size());
  if (!reader.is_good) return false;
  result.tensor.resize(result.other.size());
  for (std::size_t k = 0; k < result.tensor.size(); ++k) {
    for (std::size_t e = 0; e < 9; ++e) {
      result.tensor[k].data()[e] = formats::read_value<float>(values, sizeof(float) * (9 * k + e));
    }
  }
  return true;
}

std::optional<contact::SkinCompliance> compliance_from(ByteReader& reader, std::int64_t vertices) {
  contact::SkinCompliance result;
  for (double& v : result.volume) v = reader.next<double>();
  if (!read_ascending(reader, vertices, result.vertex)) return std::nullopt;
  if (!read_rows(reader, result)) return std::nullopt;
  if (!reader.is_good || reader.left() != 0) return std::nullopt;
  return result;
}

void append_indices(std::string& bytes, const std::vector<int>& values) {
  formats::append_value<std::uint32_t>(bytes, static_cast<std::uint32_t>(values.size()));
  for (const int v : values) formats::append_value<std::int32_t>(bytes, v);
}

}  // namespace

std::string compliance_key(const hand::Hand& hand, const contact::SkinComplianceOptions& options) {
  std::string bytes(kMagic);
  append_mesh(bytes, hand.skin);
  for (const hand::Segment segment : hand.segment) bytes += static_cast<char>(segment);
  for (const hand::Region region : hand.region) bytes += static_cast<char>(region);
  for (const hand::Bone& bone : hand.bones) append_mesh(bytes, bone.mesh);
  formats::append_value(bytes, options.mesh.finger_edge);
  formats::append_value(bytes, options.reach);
  return formats::sha256_hex(bytes);
}

void write_compliance(const std::filesystem::path& path, const std::string& key,
                      const contact::SkinCompliance& compliance) {
  std::string bytes(kMagic);
  bytes += key;
  for (const double v : compliance.volume) formats::append_value(bytes, v);
  append_indices(bytes, compliance.vertex);
  for (std::size_t i = 0; i < compliance.vertex.size(); ++i) {
    const auto first = compliance.other.begin();
    append_indices(bytes, {first + static_cast<std::ptrdiff_t>(compliance.begin[i]),
                           first + static_cast<std::ptrdiff_t>(compliance.begin[i + 1])});
  }
  for (const Eigen::Matrix3f& tensor : compliance.tensor) {
    for (int e = 0; e < 9; ++e) formats::append_value<float>(bytes, tensor.data()[e]);
  }
  // Two programs may write at once: each under a name of its own.
  std::filesystem::path part = path;
  part += "." + key.substr(0, 8) + "-" +
          std::to_string(reinterpret_cast<std::uintptr_t>(&part) % 1'000'000) + ".part";
  formats::write_file(part, bytes);
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw OutputError(path.string() + ": can't be put in place: " + error.message());
  }
}

std::optional<contact::SkinCompliance> read_compliance(const std::filesystem::path& path,
                                                       const std::string& key,
                                                       const hand::Hand& hand) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::string bytes;
  try {
    bytes = formats::read_file(path, kMostComplianceBytes);
  } catch (const Error&) {
    return std::nullopt;
  }
  ByteReader reader(bytes);
  if (reader.text(kMagic.size()) != kMagic || reader.text(key.size()) != key) return std::nullopt;
  return compliance_from(reader, hand.skin.vertex_count());
}

}  // namespace palmar::records
