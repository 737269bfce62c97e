#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace haptrial::bone {

using DustCell = Eigen::Vector3i;  // (i, j, k) in the lattice of cells, k up

/// Cells of dust in blocks of 8 x 8 x 8 that are found by a hash of their place, and know their
/// neighbours. A cell that has a block is named by a number: 512 times its block's and its place.
class DustGrid {
 public:
  using Ref = std::int32_t;
  static constexpr Ref kNone = -1;
  static constexpr int kEdge = 8;
  static constexpr int kBlockCells = kEdge * kEdge * kEdge;

  /// Steps to the 26 cells around one and to itself, by (dx + 1) + 3 (dy + 1) + 9 (dz + 1).
  static constexpr int direction(int dx, int dy, int dz) {
    return dx + 1 + 3 * (dy + 1) + 9 * (dz + 1);
  }
  static DustCell offset(int direction) {
    return {direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
  }

  struct Cell {
    std::int32_t amount{0};
    std::uint32_t flags{0};
  };
  struct Block {
    std::array<Cell, kBlockCells> cells;
    std::array<std::int32_t, 27> around;  // numbers of the blocks around; kNone where there is none
    DustCell place{0, 0, 0};              // cell with the lowest coordinates / 8
    int filled{0};                        // cells that hold dust
    int pins{0};                          // reasons beside dust to keep the block
    bool used{false};
  };

  explicit DustGrid(int max_blocks) : max_blocks_(max_blocks) {}

  static constexpr int place(Ref ref) { return ref & (kBlockCells - 1); }  // in its block
  static constexpr std::int32_t number(Ref ref) { return ref >> 9; }       // of its block

  Cell& at(Ref ref) { return block_of(ref).cells[static_cast<std::size_t>(place(ref))]; }
  const Cell& at(Ref ref) const {
    return block_of(ref).cells[static_cast<std::size_t>(place(ref))];
  }
  Block& block_of(Ref ref) { return blocks_[static_cast<std::size_t>(number(ref))]; }
  const Block& block_of(Ref ref) const { return blocks_[static_cast<std::size_t>(number(ref))]; }
  DustCell cell(Ref ref) const {
    const int at = place(ref);
    return kEdge * block_of(ref).place + DustCell(at & 7, (at >> 3) & 7, at >> 6);
  }
  /// Whether all cells around one are in its block: their numbers then differ by fixed steps.
  static bool is_inside(Ref ref) {
    const int at = place(ref);
    const auto between = [](int i) { return i > 0 && i < kEdge - 1; };
    return between(at & 7) && between((at >> 3) & 7) && between(at >> 6);
  }
  Ref beside(Ref ref, int direction) const {
    const Step step =
        kSteps[static_cast<std::size_t>(direction)][static_cast<std::size_t>(place(ref))];
    const std::int32_t block = block_of(ref).around[step.around];
    return block == kNone ? kNone : block * kBlockCells + step.place;
  }

  /// kNone where the cell has no block.
  Ref find(const DustCell& cell) const;
  /// The cell's, with a new block where it had none; kNone where there may be no more blocks.
  Ref make(const DustCell& cell);
  /// Whether the last make() made a block, whose cells are all new then.
  bool made_block() const { return made_; }
  /// Gives back the block if nothing needs it.
  void release_if_idle(std::int32_t block);

  /// The number of all blocks, also unused ones.
  std::int32_t block_count() const { return static_cast<std::int32_t>(blocks_.size()); }
  std::size_t used() const { return places_.size(); }
  const Block& block(std::int32_t number) const {
    return blocks_[static_cast<std::size_t>(number)];
  }

  /// f(Ref) for every cell from `low` to `high`, both included, that has a block.
  template <class F>
  void for_each_in(const DustCell& low, const DustCell& high, F&& f) {
    if (places_.empty()) {
      return;
    }
    const DustCell first = place_of(low);
    const DustCell last = place_of(high);
    for (int k = first.z(); k <= last.z(); ++k) {
      for (int j = first.y(); j <= last.y(); ++j) {
        for (int i = first.x(); i <= last.x(); ++i) {
          const DustCell place(i, j, k);
          if (const auto found = places_.find(key(place)); found != places_.end()) {
            const DustCell begin = (low - kEdge * place).cwiseMax(0);
            const DustCell end = (high - kEdge * place).cwiseMin(kEdge - 1);
            for_each_between(found->second, begin, end, f);
          }
        }
      }
    }
  }

 private:
  /// Target of a step in a direction, from each place in a block.
  struct Step {
    std::uint16_t place;   // in the block there
    std::uint16_t around;  // which of the blocks around that is
  };
  using Steps = std::array<std::array<Step, kBlockCells>, 27>;
  static Steps make_steps();
  static const Steps kSteps;

  template <class F>
  void for_each_between(std::int32_t block, const DustCell& begin, const DustCell& end, F& f) {
    for (int z = begin.z(); z <= end.z(); ++z) {
      for (int y = begin.y(); y <= end.y(); ++y) {
        for (int x = begin.x(); x <= end.x(); ++x) {
          f(block * kBlockCells + x + kEdge * (y + kEdge * z));
        }
      }
    }
  }
  static DustCell place_of(const DustCell& cell) {
    return {cell.x() >> 3, cell.y() >> 3, cell.z() >> 3};  // rounds down
  }
  static std::uint64_t key(const DustCell& place);
  void link(std::int32_t number, bool present);

  int max_blocks_;
  std::vector<Block> blocks_;
  std::vector<std::int32_t> free_;
  std::unordered_map<std::uint64_t, std::int32_t> places_;  // looked up, never gone through
  bool made_{false};
};

}  // namespace haptrial::bone
