#include "core/bone/data/bone_file.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "core/bone/data/label_names.h"

namespace haptrial::bone {
namespace {

constexpr int kLevel = 6;

std::string bone_head(const BoneModel& model) {
  const geometry::VoxelGrid& grid = model.grid;
  const bool two = !model.density.empty();
  const double h = 1e3 * grid.spacing;
  const Eigen::Vector3d origin = 1e3 * grid.origin;
  std::string head = fmt::format(
      "NRRD0005\n# a bone: labels{}\ntype: uint8\ndimension: {}\n"
      "space: left-posterior-superior\nsizes: {}{} {} {}\n"
      "space directions: {}({},0,0) (0,{},0) (0,0,{})\nkinds: {}domain domain domain\n"
      "encoding: gzip\nspace units: \"mm\" \"mm\" \"mm\"\nspace origin: ({},{},{})\n",
      two ? " and densities times 255" : "", two ? 4 : 3, two ? "2 " : "", grid.size[0],
      grid.size[1], grid.size[2], two ? "none " : "", h, h, h, two ? "list " : "", origin.x(),
      origin.y(), origin.z());
  head += fmt::format("haptrial_bone:={}\nhaptrial_source:={}\n", one_line(model.name),
                      one_line(model.source));
  // The grid is written in metres and to the last bit, which millimetres are not.
  head += fmt::format("haptrial_grid:={} {} {} {}\n", grid.spacing, grid.origin.x(),
                      grid.origin.y(), grid.origin.z());
  for (std::size_t n = 0; n < model.notes.size(); ++n) {
    head += fmt::format("{}{:03}:={}\n", kNoteKey, n, one_line(model.notes[n]));
  }
  for (const auto& [key, value] : keys_of(model.structures)) {
    head += fmt::format("{}:={}\n", key, value);
  }
  return head + "\n";
}

std::vector<std::uint8_t> bytes_of(const BoneModel& model) {
  if (model.density.empty()) {
    return model.labels;
  }
  std::vector<std::uint8_t> bytes(2 * model.labels.size());
  for (std::size_t i = 0; i < model.labels.size(); ++i) {
    bytes[2 * i] = model.labels[i];
    // A density that is n/255 gives n; any other above 0 at least 1.
    bytes[2 * i + 1] = static_cast<std::uint8_t>(
        std::ceil(std::min(255.0, 255.0 * static_cast<double>(model.density[i]) - 1e-3)));
  }
  return bytes;
}

std::vector<char> compressed(const std::vector<std::uint8_t>& bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), &libdeflate_free_compressor);
  if (!compressor) {
    throw std::bad_alloc();
  }
  std::vector<char> result(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()));
  result.resize(libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(),
                                         result.data(), result.size()));
  return result;
}

}  // namespace

void save_bone(const std::filesystem::path& file, const BoneModel& model, bool overwrite) {
  if (file.extension() != ".nrrd") {
    throw InputError(
        fmt::format("{}: ends in '{}'; allowed: .nrrd", file.string(), file.extension().string()));
  }
  check(model);
  WholeFile out(file, overwrite);
  out.write(bone_head(model));
  const std::vector<char> bytes = compressed(bytes_of(model));
  out.write({bytes.data(), bytes.size()});
  out.finish();
}

}  // namespace haptrial::bone
