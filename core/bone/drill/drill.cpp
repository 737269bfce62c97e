#include "core/bone/drill/drill.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::bone {
namespace {

constexpr double kWidest = 5000.0;          // reach of a burr in voxels
constexpr std::size_t kMostHits = 400'000;  // of a burr in cells, in cells on the bone's surface
constexpr std::int32_t kTurn = 64;          // samples that take bone in the same ticks

/// Room for hits: as much as the burr needs and no more than a burr in cells is to have.
std::size_t room_for_hits(const Burr& burr, bool any_soft) {
  const auto samples = static_cast<std::size_t>(burr.samples());
  const bool few = burr.cells().empty() || any_soft;
  const std::size_t all = samples * Drill::kBonesAtOnce;
  return few ? all : std::min(all, kMostHits);
}

std::size_t room_for_emptied(const Burr& burr) {
  const auto all = static_cast<std::size_t>(burr.samples()) * Drill::kBonesAtOnce;
  return burr.cells().empty() ? all
                              : std::min<std::size_t>(all, std::size_t{4} * Drill::kMostTaking);
}

enum class Held { kNothing, kAll, kSome };

/// Spreads each byte: eight bits for each of its bits.
constexpr std::array<std::uint64_t, 256> spread_bits() {
  std::array<std::uint64_t, 256> spread{};
  for (std::size_t byte = 0; byte < spread.size(); ++byte) {
    for (std::size_t bit = 0; bit < 8; ++bit) {
      spread[byte] |= (byte >> bit & 1U) != 0 ? 0xFFULL << (8 * bit) : 0;
    }
  }
  return spread;
}

/// Bone in a box of voxels, both ends included.
Held held_in(const BoneVolume::View& view, const std::array<std::int32_t, 3>& low,
             const std::array<std::int32_t, 3>& high) noexcept {
  std::array<std::int32_t, 3> from = low;
  std::array<std::int32_t, 3> to = high;
  bool nothing = false;
  bool all = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    nothing = nothing || low[axis] < 0 || high[axis] >= view.size[axis];
    from[axis] = std::max(low[axis], 0);
    to[axis] = std::min(high[axis], view.size[axis] - 1);
    if (from[axis] > to[axis]) {
      return Held::kNothing;
    }
  }
  constexpr std::uint64_t kEachRow = 0x0101010101010101U;
  static constexpr auto kSpread = spread_bits();
  /// Bits first .. last of eight.
  const auto bits = [](std::int32_t first, std::int32_t last, std::int32_t origin) {
    const std::int32_t begin = std::max(first - origin, 0);
    const std::int32_t end = std::min(last - origin, 7);
    return (0xFFULL >> (7 - end)) & (0xFFULL << begin);
  };
  for (std::int32_t k = from[2] >> 3; k <= to[2] >> 3; ++k) {
    for (std::int32_t j = from[1] >> 3; j <= to[1] >> 3; ++j) {
      const std::uint64_t spread = kSpread[bits(from[1], to[1], 8 * j)];
      for (std::int32_t i = from[0] >> 3; i <= to[0] >> 3; ++i) {
        const auto brick = static_cast<std::size_t>(
            view.table[i + view.table_size[0] * (j + view.table_size[1] * k)]);
        const int holding = view.holding[brick];
        if (holding == 0 || holding == BoneVolume::kBrickVoxels) {
          nothing = nothing || holding == 0;
          all = all || holding > 0;
        } else {
          const std::uint64_t mask = kEachRow * bits(from[0], to[0], 8 * i) & spread;
          const std::int32_t last = std::min(to[2] - 8 * k, 7);
          for (std::int32_t z = std::max(from[2] - 8 * k, 0); z <= last; ++z) {
            const std::uint64_t there = view.filled[8 * brick + static_cast<std::size_t>(z)] & mask;
            nothing = nothing || there != mask;
            all = all || there != 0;
          }
        }
        if (nothing && all) {
          return Held::kSome;
        }
      }
    }
  }
  return all ? Held::kAll : Held::kNothing;
}

/// Bone in the voxels that a cell of the burr may reach.
class CellBoxes {
 public:
  CellBoxes(const BoneVolume::View& view, const kernel::Placement& at) noexcept
      : view_(view), at_(at) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::int32_t turn : at.turn[axis]) {
        span_[axis] += std::abs(static_cast<std::int64_t>(turn));
      }
    }
  }
  Held held_by(const Burr::Cell& cell) const noexcept {
    std::array<std::int32_t, 3> low{};
    std::array<std::int32_t, 3> high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::int64_t middle = at_.offset[axis];
      for (std::size_t of = 0; of < 3; ++of) {
        middle += std::int64_t{at_.turn[axis][of]} * cell.centre[of];
      }
      const std::int64_t reach = span_[axis] * cell.half;
      low[axis] = static_cast<std::int32_t>((middle - reach) >> at_.shift) + at_.base[axis];
      high[axis] = static_cast<std::int32_t>((middle + reach) >> at_.shift) + at_.base[axis];
    }
    return held_in(view_, low, high);
  }

 private:
  const BoneVolume::View& view_;
  const kernel::Placement& at_;
  std::array<std::int64_t, 3> span_{};  // of a cell whose half is 1
};

/// @returns false where the burr cannot touch the grid, or its pose is none.
bool place(const geometry::VoxelGrid& grid, const Eigen::Vector3d& tip, double reach,
           const Eigen::Matrix3d& turn, kernel::Placement& at) noexcept {
  const double wide = reach / grid.spacing;  // in voxels
  // The centre is in units of voxels, with voxel i from i to i + 1.
  const Eigen::Array3d centre = ((tip - grid.origin) / grid.spacing).array() + 0.5;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = grid.size[static_cast<std::size_t>(axis)];
    if (!(centre[axis] + wide > -1.0 && centre[axis] - wide < size + 1.0)) {
      return false;
    }
  }
  if (!(wide < kWidest && turn.allFinite())) {
    return false;
  }
  // The shift has as many bits below the point as leave 30 for the burr and a voxel beside it.
  at.shift = 29 - std::ilogb(wide + 2.0);
  const double one = std::ldexp(1.0, at.shift);
  for (int axis = 0; axis < 3; ++axis) {
    const double base = std::floor(centre[axis]);
    at.base[axis] = static_cast<std::int32_t>(base);
    at.offset[axis] = static_cast<std::int32_t>(std::lround((centre[axis] - base) * one));
    for (int of = 0; of < 3; ++of) {
      at.turn[axis][of] =
          static_cast<std::int32_t>(std::lround(turn(axis, of) * wide / Burr::kRadius * one));
    }
  }
  return true;
}

kernel::Bricks bricks_of(const BoneVolume::View& view) noexcept {
  return {{view.size[0], view.size[1], view.size[2]},
          {view.table_size[0], view.table_size[1]},
          view.table,
          view.densities};
}

kernel::Cloud cloud_of(const Burr& of) noexcept {
  const Burr::Arrays burr = of.arrays();
  return {burr.x, burr.y, burr.z, burr.dx, burr.dy, burr.dz, burr.count};
}

}  // namespace

Contact in_world(const Contact& contact_B, const Eigen::Isometry3d& X_WB) noexcept {
  Contact contact = contact_B;
  contact.push = X_WB.linear() * contact_B.push;
  contact.turn = X_WB.linear() * contact_B.turn;
  if (contact) {
    contact.centroid = X_WB * contact_B.centroid;
  }
  return contact;
}

Contact together(const Contact& a, const Contact& b) noexcept {
  Contact sum;
  sum.samples = a.samples + b.samples;
  sum.volume = a.volume + b.volume;
  sum.push = a.push + b.push;
  sum.turn = a.turn + b.turn;
  if (sum) {
    sum.centroid = (a.volume * a.centroid + b.volume * b.centroid) / sum.volume;
  }
  return sum;
}

Drill::Drill(const BurrParameters& burr, std::span<const Structure> structures, InstructionSet set,
             const std::array<bool, 256>& soft)
    : burr_(burr),
      touch_(choose(set, kernel::touch_burr_baseline, HAPTRIAL_X86(kernel::touch_burr_avx2))),
      find_(choose(set, kernel::find_burr_baseline, HAPTRIAL_X86(kernel::find_burr_avx2))),
      soft_(soft),
      any_soft_(std::find(soft.begin(), soft.end(), true) != soft.end()),
      // One more: the kernel writes the next place before it knows whether it is kept.
      hits_(room_for_hits(burr_, any_soft_) + 1),
      cells_(burr_.cells().size() * kBonesAtOnce),
      emptied_(room_for_emptied(burr_)) {
  softness_.fill(1.0F);
  for (std::size_t label = 0; label < structures.size() && label < softness_.size(); ++label) {
    const double hardness = structures[label].hardness;
    if (!(hardness > 0.0) || !std::isfinite(hardness)) {
      throw std::invalid_argument(
          fmt::format("Drill: the hardness of '{}' is {}; allowed: a number above 0",
                      structures[label].name, hardness));
    }
    softness_[label] = static_cast<float>(1.0 / hardness);
  }
}

Contact Drill::touch(const BoneVolume& volume, const Eigen::Vector3d& tip_B,
                     const Eigen::Quaterniond& orientation_B) noexcept {
  Contact contact;
  contact.first = kept_;
  const Eigen::Matrix3d turn = orientation_B.normalized().toRotationMatrix();
  kernel::Placement at{};
  const double length = orientation_B.squaredNorm();
  if (!(length > 0.0 && std::isfinite(length)) ||
      !place(volume.grid(), tip_B, burr_.reach(), turn, at)) {
    return contact;
  }
  const kernel::Bricks bricks = bricks_of(volume.view());
  const kernel::Cloud cloud = cloud_of(burr_);
  kernel::Sums sums{};
  const std::int32_t cells_before = cells_kept_;
  if (burr_.cells().empty()) {
    const auto room = static_cast<std::int32_t>(hits_.size()) - 1 - kept_;
    const kernel::Range whole{0, cloud.count};
    contact.kept = touch_(cloud, whole, at, bricks, hits_.data() + kept_, room, sums);
  } else {
    contact.kept = touch_cells(volume.view(), at, sums);
  }
  contact.first_cell = cells_before;
  contact.cells = cells_kept_ - cells_before;
  contact.at = at;
  if (any_soft_) {
    leave_soft(volume, contact, sums);
  }
  kept_ += contact.kept;
  if (sums.count == 0) {
    return contact;
  }
  const auto vector = [](const std::int64_t(&v)[3]) {
    return Eigen::Vector3d(static_cast<double>(v[0]), static_cast<double>(v[1]),
                           static_cast<double>(v[2]));
  };
  const Eigen::Vector3d position_T = burr_.reach() / Burr::kRadius * vector(sums.position);
  const double each = burr_.sample_volume();
  contact.samples = static_cast<std::int32_t>(sums.count);
  contact.volume = each * static_cast<double>(sums.count);
  contact.push = turn * (each / Burr::kUnit * vector(sums.direction));
  // (p - sc) x d with d along z: the sum needs no more than the sum of positions.
  contact.turn = turn * (each * Eigen::Vector3d(position_T.y(), -position_T.x(), 0.0));
  contact.centroid = tip_B + turn * (position_T / static_cast<double>(sums.count));
  return contact;
}

/// Cells that lie in bone or beside it whole are counted at once; the samples of the others are
/// looked up. With soft structures a cell may lie in both, so that none counts as a whole.
/// @returns how many hits were kept
std::int32_t Drill::touch_cells(const BoneVolume::View& view, const kernel::Placement& at,
                                kernel::Sums& sums) noexcept {
  const kernel::Bricks bricks = bricks_of(view);
  const kernel::Cloud cloud = cloud_of(burr_);
  const std::vector<Burr::Cell>& cells = burr_.cells();
  std::int32_t kept = 0;
  kernel::Range some{0, 0};  // cells that are neighbours in the list are looked up as one
  const auto look_up = [&] {
    if (some.count > 0) {
      const auto room = static_cast<std::int32_t>(hits_.size()) - 1 - kept_ - kept;
      kept += touch_(cloud, some, at, bricks, hits_.data() + kept_ + kept, room, sums);
    }
  };
  const CellBoxes boxes(view, at);
  for (std::size_t c = 0; c < cells.size();) {
    const Burr::Cell& cell = cells[c];
    Held held = boxes.held_by(cell);
    const bool room = static_cast<std::size_t>(cells_kept_) < cells_.size();
    held = held == Held::kAll && (any_soft_ || !room) ? Held::kSome : held;
    if (held == Held::kAll) {
      cells_[static_cast<std::size_t>(cells_kept_++)] = static_cast<std::int32_t>(c);
      sums.count += cell.count;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sums.direction[axis] += cell.direction[axis];
        sums.position[axis] += cell.position[axis];
      }
    } else if (held == Held::kSome && cell.leaf) {
      if (some.first + some.count != cell.first) {
        look_up();
        some = {cell.first, 0};
      }
      some.count += cell.count;
    }
    c = held == Held::kSome ? c + 1 : static_cast<std::size_t>(cell.after);
  }
  look_up();
  return kept;
}

/// Takes hits in soft structures out of list and sums; the sums are whole numbers, so that nothing
/// of them stays.
void Drill::leave_soft(const BoneVolume& volume, Contact& contact, kernel::Sums& sums) noexcept {
  const Burr::Arrays burr = burr_.arrays();
  kernel::Hit* hits = hits_.data() + contact.first;
  std::int32_t kept = 0;
  for (std::int32_t n = 0; n < contact.kept; ++n) {
    if (!soft_[volume.label(hits[n].address)]) {
      hits[kept++] = hits[n];
      continue;
    }
    const std::int32_t i = hits[n].sample;
    --sums.count;
    sums.direction[0] -= burr.dx[i];
    sums.direction[1] -= burr.dy[i];
    sums.direction[2] -= burr.dz[i];
    sums.position[0] -= burr.x[i];
    sums.position[1] -= burr.y[i];
    sums.position[2] -= burr.z[i];
  }
  contact.kept = kept;
}

/// Takes bone at one sample after the other.
class Drill::Taking {
 public:
  Taking(Drill& drill, BoneVolume& volume, double rate) noexcept
      : volume_(volume),
        rate_(static_cast<float>(rate)),
        powers_(drill.burr_.arrays().power),
        softness_(drill.softness_.data()),
        begin_(drill.emptied_.data() + drill.emptied_used_),
        emptied_(begin_),
        end_(drill.emptied_.data() + drill.emptied_.size()) {}

  /// @returns false where no more can be told to be empty; nothing is taken then
  bool at(std::int32_t address, std::int32_t sample) noexcept {
    if (emptied_ == end_) {
      return false;
    }
    const std::uint8_t label = volume_.label(address);
    const float wanted = rate_ * powers_[sample] * softness_[label];
    // Adding 1 rounds to a multiple of 2^-23.
    const float taken = volume_.take(address, wanted < 1.0F ? (wanted + 1.0F) - 1.0F : 1.0F);
    amount_ += static_cast<double>(taken);
    if (taken > 0.0F && !(volume_.density(address) > 0.0F)) {
      *emptied_++ = {address, label};
    }
    return true;
  }
  const BoneVolume& volume() const noexcept { return volume_; }
  double amount() const noexcept { return amount_; }
  std::span<const EmptiedVoxel> emptied() const noexcept { return {begin_, emptied_}; }

 private:
  BoneVolume& volume_;
  float rate_;
  const float* powers_;
  const float* softness_;
  EmptiedVoxel* begin_;
  EmptiedVoxel* emptied_;
  EmptiedVoxel* end_;
  double amount_{0.0};
};

/// Samples of cells that lie in bone whole, whose turn it is.
void Drill::take_cells(Taking& taking, const Contact& contact, std::uint64_t turns) noexcept {
  const BoneVolume& volume = taking.volume();
  const kernel::Bricks bricks = bricks_of(volume.view());
  const kernel::Cloud cloud = cloud_of(burr_);
  for (std::int32_t n = 0; n < contact.cells; ++n) {
    const auto listed = static_cast<std::size_t>(contact.first_cell + n);
    const Burr::Cell& cell = burr_.cells()[static_cast<std::size_t>(cells_[listed])];
    const std::int32_t end = cell.first + cell.count;
    for (std::int32_t first = cell.first; first < end;) {
      const std::int32_t block = first / kTurn;
      const std::int32_t next = std::min(end, (block + 1) * kTurn);
      if ((static_cast<std::uint64_t>(block) + ticks_) % turns == 0) {
        std::array<std::int32_t, kernel::kMostFound> address;
        find_(cloud, {first, next - first}, contact.at, bricks, address.data());
        for (std::int32_t s = first; s < next; ++s) {
          taking.at(address[static_cast<std::size_t>(s - first)], s);
        }
      }
      first = next;
    }
  }
}

Removal Drill::remove(BoneVolume& volume, const Contact& contact, double force, double power,
                      double dt) noexcept {
  Removal removal;
  const double spacing = volume.grid().spacing;
  const double voxel = spacing * spacing * spacing;
  const double rate = force * power * dt * burr_.sample_volume() / voxel;
  if (!(force > 0.0 && power > 0.0 && dt > 0.0) || !std::isfinite(rate) ||
      contact.first + contact.kept > kept_ ||  // of a tick that was forgotten
      contact.first_cell + contact.cells > cells_kept_) {
    return removal;
  }
  const auto immersed = static_cast<std::uint64_t>(contact.samples);
  const std::uint64_t turns =
      burr_.cells().empty()
          ? 1
          : std::max<std::uint64_t>(1, (immersed + kMostTaking - 1) / kMostTaking);
  Taking taking(*this, volume, rate * static_cast<double>(turns));
  const kernel::Hit* hits = hits_.data() + contact.first;
  for (std::int32_t n = 0; n < contact.kept; ++n) {
    const auto block = static_cast<std::uint64_t>(hits[n].sample / kTurn);
    if (turns == 1 || (block + ticks_) % turns == 0) {
      taking.at(hits[n].address, hits[n].sample);
    }
  }
  take_cells(taking, contact, turns);
  emptied_used_ += taking.emptied().size();
  removal.amount = taking.amount();
  removal.volume = removal.amount * voxel;
  removal.emptied = taking.emptied();
  return removal;
}

}  // namespace haptrial::bone
