#include "core/bone/dust/dust_grid.h"

namespace haptrial::bone {

DustGrid::Steps DustGrid::make_steps() {
  constexpr int kEdge = DustGrid::kEdge;
  Steps steps;
  for (int direction = 0; direction < 27; ++direction) {
    for (int place = 0; place < DustGrid::kBlockCells; ++place) {
      const DustCell to = DustCell(place % kEdge, place / kEdge % kEdge, place / (kEdge * kEdge)) +
                          DustGrid::offset(direction);
      DustCell block;
      DustCell within;
      for (int axis = 0; axis < 3; ++axis) {
        block[axis] = to[axis] < 0 ? -1 : to[axis] / kEdge;
        within[axis] = to[axis] - kEdge * block[axis];
      }
      steps[static_cast<std::size_t>(direction)][static_cast<std::size_t>(place)] = {
          static_cast<std::uint16_t>(within.x() + kEdge * (within.y() + kEdge * within.z())),
          static_cast<std::uint16_t>(DustGrid::direction(block.x(), block.y(), block.z()))};
    }
  }
  return steps;
}

const DustGrid::Steps DustGrid::kSteps = make_steps();

std::uint64_t DustGrid::key(const DustCell& place) {
  constexpr std::uint64_t kBits = 21;
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + (1 << 20)); };
  return part(place.x()) | part(place.y()) << kBits | part(place.z()) << (2 * kBits);
}

DustGrid::Ref DustGrid::find(const DustCell& cell) const {
  const DustCell place = place_of(cell);
  const auto found = places_.find(key(place));
  if (found == places_.end()) {
    return kNone;
  }
  const DustCell in = cell - kEdge * place;
  return found->second * kBlockCells + in.x() + kEdge * (in.y() + kEdge * in.z());
}

DustGrid::Ref DustGrid::make(const DustCell& cell) {
  made_ = false;
  if (const Ref there = find(cell); there != kNone) {
    return there;
  }
  std::int32_t number = 0;
  if (!free_.empty()) {
    number = free_.back();
    free_.pop_back();
  } else if (block_count() < max_blocks_) {
    number = block_count();
    blocks_.emplace_back();
  } else {
    return kNone;
  }
  Block& block = blocks_[static_cast<std::size_t>(number)];
  block = Block{};
  block.used = true;
  block.place = place_of(cell);
  places_.emplace(key(block.place), number);
  link(number, true);
  made_ = true;
  return find(cell);
}

/// Tells the blocks around of a new block, or of one that goes.
void DustGrid::link(std::int32_t number, bool present) {
  Block& block = blocks_[static_cast<std::size_t>(number)];
  for (int direction = 0; direction < 27; ++direction) {
    const auto found = places_.find(key(block.place + offset(direction)));
    const std::int32_t other = found == places_.end() ? kNone : found->second;
    block.around[static_cast<std::size_t>(direction)] = other;
    if (other != kNone) {
      blocks_[static_cast<std::size_t>(other)].around[static_cast<std::size_t>(26 - direction)] =
          present ? number : kNone;
    }
  }
}

void DustGrid::release_if_idle(std::int32_t number) {
  Block& block = blocks_[static_cast<std::size_t>(number)];
  if (!block.used || block.filled > 0 || block.pins > 0) {
    return;
  }
  link(number, false);
  places_.erase(key(block.place));
  block.used = false;
  free_.push_back(number);
}

}  // namespace haptrial::bone
