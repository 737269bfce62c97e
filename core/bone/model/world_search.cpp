#include <algorithm>
#include <map>
#include <unordered_set>

#include "core/bone/model/world.h"

namespace haptrial::bone {
namespace {

constexpr std::size_t kMaxCrumbs = 48;  // in an offer: their events must fit a tick's

/// Addresses of what hangs together with a voxel, in order; nothing where that is more than `most`
/// voxels. Looks at no other part of the bone, however large that is.
std::vector<std::int32_t> small_part(const BoneVolume& volume, const Voxel& seed,
                                     std::size_t most) {
  std::vector<std::int32_t> part;
  std::unordered_set<std::int32_t> known;
  const auto add = [&](const Voxel& voxel) {
    const std::int32_t address = volume.address(voxel);
    if (volume.density(address) > 0.0F && known.insert(address).second) {
      part.push_back(address);
    }
  };
  add(seed);
  for (std::size_t next = 0; next < part.size() && part.size() <= most; ++next) {
    const Voxel voxel = volume.voxel_at(part[next]);
    for (int axis = 0; axis < 3; ++axis) {
      add(voxel - Voxel::Unit(axis));
      add(voxel + Voxel::Unit(axis));
    }
  }
  if (part.size() > most) {
    return {};
  }
  std::sort(part.begin(), part.end());
  return part;
}

}  // namespace

/// Islands that do not hang together with the bone from the start, as an ossicle that ligaments
/// hold or a speck of a coarse scan, have not been cut off: they stay with the bone.
void BoneWorld::note_islands() {
  Piece& bone = at(0);
  bone.occupancy.follow(*bone.volume);
  flood_.look(*bone.volume, bone.occupancy);
  int island = 0;
  for (const Part& part : flood_.loose(*bone.volume)) {
    for (const Voxel& voxel : part) {
      islands_[bone.volume->address(voxel)] = island;
    }
    ++island;
  }
  bone.searched = true;
}

void BoneWorld::search() {
  const Phase phase = phase_.load(std::memory_order_acquire);
  if (phase == Phase::kSettled) {
    note_seeds();
    phase_.store(Phase::kConfirmed, std::memory_order_release);
  }
  if (phase != Phase::kIdle) {
    return;
  }
  std::int64_t unplaced = 0;
  for (int piece = 0; piece < pieces(); ++piece) {
    if (look_at(piece)) {
      return;
    }
    unplaced += at(piece).unplaced;
  }
  unplaced_.store(unplaced, std::memory_order_relaxed);
}

/// @returns whether something was offered.
bool BoneWorld::look_at(int number) {
  Piece& piece = at(number);
  changed_.clear();
  piece.occupancy.follow(*piece.volume, changed_);
  if (changed_.empty() && piece.searched) {
    return false;
  }
  piece.searched = false;
  piece.unplaced = 0;
  const std::vector<Part> parts = cut_loose(number);
  offer_.crumbs.clear();
  offer_.crumb_ends.clear();
  offer_.from = number;
  const Part* first = nullptr;  // that is large enough
  for (const Part& part : parts) {
    if (part.size() >= static_cast<std::size_t>(parameters_.smallest_piece)) {
      first = first == nullptr ? &part : first;
      piece.unplaced += static_cast<std::int64_t>(part.size());
    } else if (!add_crumb(part)) {
      break;
    }
  }
  if (!offer_.crumbs.empty()) {
    phase_.store(Phase::kCrumbs, std::memory_order_release);
    return true;
  }
  if (first != nullptr && pieces() < parameters_.capacity) {
    make_offer(number, *first);
    phase_.store(Phase::kOffered, std::memory_order_release);
    return true;
  }
  piece.searched = true;
  return false;
}

/// The parts of a piece that were cut off, in order of their lowest addresses.
std::vector<Part> BoneWorld::cut_loose(int number) {
  const BoneVolume& volume = *at(number).volume;
  flood_.look(volume, at(number).occupancy);
  std::vector<Part> parts = flood_.loose(volume);
  if (number != 0 || islands_.empty()) {
    return parts;
  }
  // The biggest part of each island still hangs where the island hung.
  std::map<int, std::size_t> stays;  // by island: number of the part
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto island = islands_.find(volume.address(parts[p].front()));
    if (island != islands_.end()) {
      const auto [place, added] = stays.emplace(island->second, p);
      if (!added && parts[place->second].size() < parts[p].size()) {
        place->second = p;
      }
    }
  }
  for (const auto& [island, part] : stays) {
    parts[part].clear();
  }
  std::erase_if(parts, [](const Part& part) { return part.empty(); });
  return parts;
}

/// @returns false when the offer is full.
bool BoneWorld::add_crumb(const Part& part) {
  if (offer_.crumb_ends.size() == kMaxCrumbs ||
      offer_.crumbs.size() + part.size() > static_cast<std::size_t>(parameters_.moves_per_tick)) {
    return false;
  }
  for (const Voxel& voxel : part) {
    offer_.crumbs.push_back(at(offer_.from).volume->address(voxel));
  }
  offer_.crumb_ends.push_back(offer_.crumbs.size());
  return true;
}

void BoneWorld::make_offer(int from, const Part& part) {
  offer_.from = from;
  offer_.to = pieces();
  offer_.moved = 0;
  offer_.from_addresses.clear();
  offer_.to_addresses.clear();
  const BoneVolume& source = *at(from).volume;
  Piece& piece = at(offer_.to);
  piece.volume = std::make_unique<BoneVolume>(source, part);
  for (const Voxel& voxel : part) {
    offer_.from_addresses.push_back(source.address(voxel));
    offer_.to_addresses.push_back(piece.volume->address(voxel));
  }
}

void BoneWorld::note_seeds() {
  Piece& piece = at(offer_.to);
  const BoneVolume& volume = *piece.volume;
  offer_.versions.assign(static_cast<std::size_t>(volume.bricks()), 0);
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    offer_.versions[static_cast<std::size_t>(brick)] = volume.version(brick);
  }
  piece.occupancy.follow(volume);
  offer_.voxels = static_cast<std::int64_t>(piece.occupancy.count());
  offer_.amount = volume.amount();
  flood_.look(volume, piece.occupancy);
  piece.seeds.clear();
  for (const Part& part : flood_.all(volume)) {
    piece.seeds.push_back(part.front());
  }
}

bool BoneWorld::split_at(int from, std::span<const Voxel> seeds) {
  if (from < 0 || from >= pieces() || pieces() >= parameters_.capacity) {
    return false;
  }
  const BoneVolume& volume = *at(from).volume;
  at(from).occupancy.follow(volume);
  at(from).searched = false;
  flood_.look(volume, at(from).occupancy);
  Part all;
  for (const Voxel& seed : seeds) {
    if (std::find(all.begin(), all.end(), seed) != all.end()) {
      continue;
    }
    const Part part = flood_.part_of(volume, seed);
    if (part.empty()) {
      return false;
    }
    all.insert(all.end(), part.begin(), part.end());
  }
  make_offer(from, all);
  begin_move();
  move_some(all.size());
  note_seeds();
  bear();
  return true;
}

bool BoneWorld::crumble_at(int number, const Voxel& seed) {
  if (number < 0 || number >= pieces()) {
    return false;
  }
  Piece& piece = at(number);
  piece.searched = false;
  offer_.from = number;
  offer_.crumbs =
      small_part(*piece.volume, seed, static_cast<std::size_t>(parameters_.moves_per_tick));
  if (offer_.crumbs.empty()) {
    piece.occupancy.follow(*piece.volume);
    flood_.look(*piece.volume, piece.occupancy);
    for (const Voxel& voxel : flood_.part_of(*piece.volume, seed)) {
      offer_.crumbs.push_back(piece.volume->address(voxel));
    }
  }
  if (offer_.crumbs.empty()) {
    return false;
  }
  offer_.crumb_ends.assign(1, offer_.crumbs.size());
  take_crumbs();
  return true;
}

}  // namespace haptrial::bone
