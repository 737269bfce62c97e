#include "protocols/bone_drilling/replay_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "protocols/bone_drilling/drilling_rows.h"

namespace haptrial::protocols {
namespace {

std::string words(const record::RemovalRow& row) {
  return fmt::format("({}, {}, {}) of piece {} with label {}{}", row.voxel[0], row.voxel[1],
                     row.voxel[2], row.piece, row.label, row.cut ? ", cut" : "");
}

std::string words(const bone::EmptiedIn& gone) {
  return fmt::format("({}, {}, {}) of piece {} with label {}{}", gone.voxel.x(), gone.voxel.y(),
                     gone.voxel.z(), gone.piece, gone.label, gone.by_cut ? ", cut" : "");
}

template <class Voxel>
std::vector<std::string> in_order(std::span<const Voxel> voxels) {
  std::vector<std::string> all;
  for (const Voxel& voxel : voxels) {
    all.push_back(words(voxel));
  }
  std::ranges::sort(all);
  return all;
}

}  // namespace

std::string difference(std::uint64_t sequence, std::span<const record::RemovalRow> recorded,
                       std::span<const bone::EmptiedIn> emptied) {
  const std::vector<std::string> file = in_order(recorded);
  const std::vector<std::string> here = in_order(emptied);
  const auto [there, now] = std::mismatch(file.begin(), file.end(), here.begin(), here.end());
  if (there == file.end() && now == here.end()) {
    return "";
  }
  return fmt::format("on tick {} the record has {} emptied, and the simulation {}", sequence,
                     there != file.end() ? *there : "no further voxel",
                     now != here.end() ? *now : "none");
}

std::string difference(std::uint64_t sequence, std::span<const record::TearRow> recorded,
                       std::span<const bone::Tear> torn) {
  const auto same = [](const record::TearRow& a, const bone::Tear& b) {
    return a.label == b.label && a.by_suction == b.by_suction && a.force == b.force &&
           a.depth == b.depth && a.place == b.place_B;
  };
  return std::equal(recorded.begin(), recorded.end(), torn.begin(), torn.end(), same)
             ? ""
             : fmt::format(
                   "on tick {} the record has {} tears of soft tissue, and the simulation "
                   "{}, or others",
                   sequence, recorded.size(), torn.size());
}

std::string difference(std::uint64_t sequence, std::span<const record::PieceRow> recorded,
                       const bone::Simulator& simulator) {
  for (const record::PieceRow& row : recorded) {
    const bool known = row.piece >= 0 && row.piece < simulator.world().pieces();
    const record::PieceRow now =
        known ? piece_row(simulator, sequence, row.piece, 0) : record::PieceRow{};
    if (!known || now.shift != row.shift || now.turn != row.turn) {
      return fmt::format("on tick {} piece {} does not lie as in the record", sequence, row.piece);
    }
  }
  return "";
}

std::string difference(std::uint64_t sequence, std::span<const record::ScrewRow> recorded,
                       const bone::Screws& screws) {
  const bool same = std::ranges::all_of(recorded, [&](const record::ScrewRow& row) {
    int number = 0;
    while (number < screws.count() &&
           (screws.place(number).plate != row.plate || screws.place(number).hole != row.hole)) {
      ++number;
    }
    return number < screws.count() && screws.screw(number).purchase == row.purchase;
  });
  return same ? "" : fmt::format("on tick {} the screws are not those of the record", sequence);
}

}  // namespace haptrial::protocols
