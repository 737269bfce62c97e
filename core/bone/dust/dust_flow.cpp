// One step of the dust: amounts fall, then flow where they stand too steep.

#include <algorithm>

#include "core/bone/dust/dust_state.h"

namespace haptrial::bone {
namespace {

using Ref = DustGrid::Ref;

constexpr int kSides = 8;
constexpr int kPace = 8;    // a flow takes this part of an excess
constexpr int kFull = 256;  // with less room than this part a cell counts as full
constexpr int kBelow = DustGrid::direction(0, 0, -1);

constexpr int direction_of(int step) {
  const auto& s = kDustSteps[static_cast<std::size_t>(step)];
  return DustGrid::direction(s[0], s[1], s[2]);
}

/// Steps to the cells that are woken around a cell that has all its neighbours in its own block.
constexpr std::array<int, 18> steps_around() {
  std::array<int, 18> steps{};
  for (int i = 0; i < 18; ++i) {
    steps[static_cast<std::size_t>(i)] =
        i % 3 - 1 + DustGrid::kEdge * (i / 3 % 3 - 1 + DustGrid::kEdge * (i / 9));
  }
  return steps;
}
constexpr std::array<int, 18> kStepsAround = steps_around();

}  // namespace

void DustState::change(Ref ref, std::int32_t by) {
  DustGrid::Cell& cell = grid.at(ref);
  const bool before = cell.amount > 0;
  cell.amount += by;
  const int filled = static_cast<int>(cell.amount > 0) - static_cast<int>(before);
  if (filled != 0) {
    DustGrid::Block& block = grid.block_of(ref);
    block.filled += filled;
    cells += static_cast<std::size_t>(filled);  // wraps to one less
    if (block.filled == 0) {
      maybe_idle.push_back(DustGrid::number(ref));
    }
  }
  ++version;
}

void DustState::wake(Ref ref) {
  if (ref == kNone) {
    return;
  }
  DustGrid::Cell& cell = grid.at(ref);
  if (cell.amount == 0 || (cell.flags & kQueued) != 0) {
    return;
  }
  cell.flags |= kQueued;
  ++grid.block_of(ref).pins;
  next[static_cast<std::size_t>(grid.cell(ref).z() - lowest_layer)].push_back(ref);
  ++waiting;
}

/// A cell has more room than before: wakes what may move into it or past it, and itself.
void DustState::wake_above_and_beside(Ref ref) {
  if (DustGrid::is_inside(ref)) {
    for (const int step : kStepsAround) {
      wake(ref + step);
    }
    return;
  }
  for (int direction = DustGrid::direction(-1, -1, 0); direction < 27; ++direction) {
    wake(grid.beside(ref, direction));
  }
}

/// Out of the region, and out of the memory that there may be, is out. Whoever moves dust wakes
/// what is around the cell that it came from: once, where it went to several.
void DustState::move(Ref from, const CandidateCell& to, std::int32_t amount) {
  const Ref ref = to.outside || to.ref != kNone ? to.ref : make(to.cell);
  if (to.outside || ref == kNone) {
    fallen += amount;
    lying -= amount;
  } else if (to.ref == kNone && (grid.at(ref).flags & kTool) != 0) {
    return;  // nobody knew that a tool is there
  } else {
    change(ref, amount);
    wake(ref);
  }
  change(from, -amount);
}

void DustState::make_flows() {
  for (std::size_t i = 0; i < flows.size(); ++i) {
    const Flow& flow = flows[i];
    move(flow.from, flow.to, flow.amount);
    if (i + 1 == flows.size() || flows[i + 1].from != flow.from) {
      wake_above_and_beside(flow.from);
    }
  }
  flows.clear();
}

void DustState::fall(Ref ref) {
  if (!passage(ref, kDown)) {
    return;
  }
  const CandidateCell here = look(grid.cell(ref), ref);
  const CandidateCell below = look_beside(here, kBelow);
  const std::int32_t amount = below.outside ? here.amount : std::min(here.amount, below.room);
  if (amount > 0) {
    move(ref, below, amount);
    wake_above_and_beside(ref);
  }
}

/// Finds where an amount that rests on something stands steeper than it may, and what flows.
void DustState::seek(Ref ref) {
  if (solid(ref)) {
    seek_way_out(ref);
    return;
  }
  const CandidateCell here = look(grid.cell(ref), ref);
  const auto& stands = in_water(centre(here.cell)) ? wet_limit : limit;
  std::array<Flow, kSides> out;
  std::size_t count = 0;
  std::int64_t sum = 0;
  for (int step = 1; step <= kSides; ++step) {
    if (!passage(ref, step)) {
      continue;
    }
    const CandidateCell side = look_beside(here, direction_of(step));
    if (side.room == 0) {
      continue;
    }
    const CandidateCell below = look_beside(side, kBelow);
    const bool room_below = below.outside || below.room > capacity / kFull;
    const bool drops =
        side.outside ||
        (room_below && (side.ref != kNone ? passage(side.ref, kDown) : passage(side, below)));
    const CandidateCell& to = drops && !side.outside ? below : side;
    const std::int32_t excess =
        (drops ? capacity : 0) + here.amount - to.amount - stands[static_cast<std::size_t>(step)];
    const std::int32_t amount = std::min(excess / kPace, to.room / kSides);
    if (excess > least && amount > 0) {
      out[count++] = {ref, to, amount};
      sum += amount;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (sum > here.amount) {  // there is not so much: each gets its part
      out[i].amount = static_cast<std::int32_t>(std::int64_t{out[i].amount} * here.amount / sum);
    }
    if (out[i].amount > 0) {
      flows.push_back(out[i]);
    }
  }
}

/// Bone has moved onto dust: it goes to whatever cell around is free, also above.
void DustState::seek_way_out(Ref ref) {
  constexpr int kAround = 26;
  const CandidateCell here = look(grid.cell(ref), ref);
  std::int32_t left = here.amount;
  for (int direction = 26; direction >= 0 && left > 0; --direction) {
    const CandidateCell to = look_beside(here, direction);
    const bool into_bone = to.ref != kNone ? solid(to.ref) : bones.hold(centre(to.cell));
    if (to.ref != ref && !into_bone) {
      const std::int32_t amount = std::min(left, to.room / kAround);
      left -= amount;
      if (amount > 0) {
        flows.push_back({ref, to, amount});
      }
    }
  }
}

/// The order of the cells in a layer does not matter: each cell has one above that falls into it,
/// and flows are found before any is made. Lower layers come first and make room for the upper.
void DustState::substep() {
  suck();
  expel();
  current.swap(next);
  waiting = 0;
  for (std::vector<Ref>& layer : current) {
    for (const Ref ref : layer) {
      grid.at(ref).flags &= ~kQueued;
      if (--grid.block_of(ref).pins == 0) {
        maybe_idle.push_back(DustGrid::number(ref));
      }
    }
    for (const Ref ref : layer) {
      if (grid.at(ref).amount > 0) {
        fall(ref);
      }
    }
    for (const Ref ref : layer) {
      if (grid.at(ref).amount > 0) {
        seek(ref);
      }
    }
    make_flows();
    layer.clear();
  }
  tidy();
}

void DustState::tidy() {
  for (const std::int32_t block : maybe_idle) {
    grid.release_if_idle(block);
  }
  maybe_idle.clear();
}

}  // namespace haptrial::bone
