#pragma once

#include <fmt/format.h>
#include <libdeflate.h>

#include <Eigen/Core>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace haptrial::test {

/// A volume to write byte by byte, without any library: the reader's judge.
struct PlainVolume {
  std::array<int, 3> size{1, 1, 1};
  Eigen::Matrix3d steps{Eigen::Matrix3d::Identity()};  // columns, LPS [mm]
  Eigen::Vector3d origin{Eigen::Vector3d::Zero()};     // LPS [mm]
  std::vector<std::int16_t> values;
  std::string more;  // lines of an NRRD head

  explicit PlainVolume(std::array<int, 3> voxels)
      : size(voxels),
        values(static_cast<std::size_t>(voxels[0]) * static_cast<std::size_t>(voxels[1]) *
               static_cast<std::size_t>(voxels[2])) {}
  std::int16_t& at(int i, int j, int k) {
    return values[static_cast<std::size_t>(i + size[0] * (j + size[1] * k))];
  }
  Eigen::Vector3d place(int i, int j, int k) const {
    return origin + steps * Eigen::Vector3d(i, j, k);
  }
  /// Fills it with value(place in mm).
  template <class Value>
  PlainVolume& fill(Value&& value) {
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) {
          at(i, j, k) = static_cast<std::int16_t>(value(place(i, j, k)));
        }
      }
    }
    return *this;
  }
};

inline std::string bytes_of(const PlainVolume& volume) {
  return {reinterpret_cast<const char*>(volume.values.data()),
          volume.values.size() * sizeof(std::int16_t)};
}

inline std::string gzip(const std::string& bytes) {
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
  std::string result(libdeflate_gzip_compress_bound(compressor, bytes.size()), '\0');
  result.resize(libdeflate_gzip_compress(compressor, bytes.data(), bytes.size(), result.data(),
                                         result.size()));
  libdeflate_free_compressor(compressor);
  return result;
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}
inline std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// @param ras  the head speaks of right, anterior, superior
inline std::string nrrd_of(const PlainVolume& volume, bool ras = false, bool zipped = false) {
  const Eigen::Vector3d sign = ras ? Eigen::Vector3d(-1, -1, 1) : Eigen::Vector3d(1, 1, 1);
  const auto vector = [&](const Eigen::Vector3d& v) {
    const Eigen::Vector3d w = sign.cwiseProduct(v);
    return fmt::format("({},{},{})", w.x(), w.y(), w.z());
  };
  std::string head = fmt::format(
      "NRRD0004\ntype: int16\ndimension: 3\nspace: {}\nsizes: {} {} {}\n"
      "space directions: {} {} {}\nkinds: domain domain domain\nendian: little\n"
      "encoding: {}\nspace origin: {}\n{}\n",
      ras ? "right-anterior-superior" : "left-posterior-superior", volume.size[0], volume.size[1],
      volume.size[2], vector(volume.steps.col(0)), vector(volume.steps.col(1)),
      vector(volume.steps.col(2)), zipped ? "gzip" : "raw", vector(volume.origin), volume.more);
  return head + (zipped ? gzip(bytes_of(volume)) : bytes_of(volume));
}

/// NIfTI-1 as one file: 348 bytes of head, four of none, values. By the fields of its standard.
inline std::string nifti_of(const PlainVolume& volume, bool sform = true, int intent = 0) {
  std::string head(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(head.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t{348});
  put(40, std::int16_t{3});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(42 + 2 * axis, static_cast<std::int16_t>(volume.size[axis]));
    put(80 + 4 * axis, static_cast<float>(volume.steps.col(static_cast<long>(axis)).norm()));
  }
  for (std::size_t axis = 4; axis < 8; ++axis) {
    put(40 + 2 * axis, std::int16_t{1});
  }
  put(68, static_cast<std::int16_t>(intent));
  put(70, std::int16_t{4});  // int16
  put(72, std::int16_t{16});
  put(76, 1.0F);
  put(108, 352.0F);
  put(112, 1.0F);     // slope
  put(123, char{2});  // mm
  if (sform) {
    put(254, std::int16_t{1});
    for (int row = 0; row < 3; ++row) {
      const double sign = row < 2 ? -1.0 : 1.0;  // RAS
      const auto at = static_cast<std::size_t>(280 + 16 * row);
      for (int column = 0; column < 3; ++column) {
        put(at + 4 * static_cast<std::size_t>(column),
            static_cast<float>(sign * volume.steps(row, column)));
      }
      put(at + 12, static_cast<float>(sign * volume.origin[row]));
    }
  }
  head.replace(344, 4, std::string("n+1\0", 4));
  return head + bytes_of(volume);
}

}  // namespace haptrial::test
