#include "core/geometry/files/volume_files.h"

#include <fmt/format.h>

#include <bit>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "core/geometry/files/hdf5_output.h"

namespace haptrial::geometry {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little);  // as the heads say

template <class T>
constexpr const char* nrrd_type() {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return "uint8";
  } else if constexpr (std::is_same_v<T, std::int32_t>) {
    return "int32";
  } else if constexpr (std::is_same_v<T, float>) {
    return "float";
  } else {
    return "double";
  }
}

template <class T>
constexpr h5::Number hdf5_type() {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return h5::Number::kU8;
  } else if constexpr (std::is_same_v<T, std::int32_t>) {
    return h5::Number::kI32;
  } else if constexpr (std::is_same_v<T, float>) {
    return h5::Number::kF32;
  } else {
    return h5::Number::kF64;
  }
}

std::string nrrd_head(const Volume& volume, const char* type) {
  const VoxelGrid& g = volume.grid;
  const bool many = volume.components > 1;
  const std::string h = fmt::format("{}", g.spacing);
  std::string content = volume.what;
  for (char& c : content) {
    c = c == '\n' ? ' ' : c;
  }
  return fmt::format(
      "NRRD0005\ncontent: {}\ntype: {}\ndimension: {}\nspace dimension: 3\nsizes: {}{} {} {}\n"
      "space directions: {}({},0,0) (0,{},0) (0,0,{})\nkinds: {}domain domain domain\n"
      "endian: little\nencoding: raw\nspace units: \"m\" \"m\" \"m\"\n"
      "space origin: ({},{},{})\n\n",
      content, type, many ? 4 : 3, many ? fmt::format("{} ", volume.components) : "", g.size[0],
      g.size[1], g.size[2], many ? "none " : "", h, h, h, many ? "vector " : "", g.origin.x(),
      g.origin.y(), g.origin.z());
}

void write_nrrd(const fs::path& file, const Volume& volume, bool overwrite) {
  WholeFile out(file, overwrite);
  std::visit(
      [&](const auto& values) {
        using T = std::remove_const_t<typename std::decay_t<decltype(values)>::element_type>;
        out.write(nrrd_head(volume, nrrd_type<T>()));
        out.write_all(values);
      },
      volume.values);
  out.finish();
}

void write_hdf5(const fs::path& file, const Volume& volume, bool overwrite) {
  WholeFile out(file, overwrite);
  out.close();
  h5::File content(out.part());
  std::vector<std::uint64_t> shape;
  for (const int axis : {2, 1, 0}) {
    shape.push_back(static_cast<std::uint64_t>(volume.grid.size[axis]));
  }
  if (volume.components > 1) {
    shape.push_back(static_cast<std::uint64_t>(volume.components));
  }
  std::visit(
      [&](const auto& values) {
        using T = std::remove_const_t<typename std::decay_t<decltype(values)>::element_type>;
        content.write("volume", hdf5_type<T>(), shape, values.data());
      },
      volume.values);
  const Eigen::Vector3d& origin = volume.grid.origin;
  content.put("volume", "origin_m", std::vector<double>{origin.x(), origin.y(), origin.z()});
  content.put("volume", "spacing_m", std::vector<double>{volume.grid.spacing});
  content.put("volume", "what", volume.what);
  content.close();
  out.finish();
}

}  // namespace

void check_volume_ending(const fs::path& file) {
  const std::string ending = file.extension().string();
  if (ending != ".nrrd" && ending != ".h5") {
    throw InputError(fmt::format("{}: ends in '{}'; allowed: .nrrd, .h5", file.string(), ending));
  }
}

void write_volume(const fs::path& file, const Volume& volume, bool overwrite) {
  check_volume_ending(file);
  const auto count = volume.grid.count() * static_cast<std::size_t>(volume.components);
  if (std::visit([](const auto& values) { return values.size(); }, volume.values) != count) {
    throw std::invalid_argument("write_volume: as many values as voxels times components");
  }
  file.extension() == ".h5" ? write_hdf5(file, volume, overwrite)
                            : write_nrrd(file, volume, overwrite);
}

Volume volume_of(const VoxelSolid& solid) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(solid.labels.data());
  return {solid.grid, std::span(bytes, solid.labels.size()), 1,
          "voxel label: 0 outside, 1 inside, 2 border"};
}

}  // namespace haptrial::geometry
