#include "core/bone/model/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "core/base/definition/schema.h"

namespace haptrial::bone {
namespace {

constexpr int kMaxReach = 8;  // of a touch [voxels]

constexpr PieceSet bit(int piece) { return PieceSet{1} << piece; }

void check(const WorldParameters& parameters) {
  if (parameters.capacity < 1 || parameters.capacity > kMaxPieces) {
    throw std::invalid_argument(
        fmt::format("bone world: capacity must be from 1 to {}", kMaxPieces));
  }
  if (parameters.smallest_piece < 1 || parameters.moves_per_tick < parameters.smallest_piece) {
    throw std::invalid_argument(
        "bone world: smallest_piece must be at least 1 and at most moves_per_tick");
  }
}

/// An order that does not know in which volume of a piece in the making a voxel is by now.
bool before(const PieceTouch& a, const PieceTouch& b) {
  return std::tuple(a.distance, a.piece, a.voxel.z(), a.voxel.y(), a.voxel.x()) <
         std::tuple(b.distance, b.piece, b.voxel.z(), b.voxel.y(), b.voxel.x());
}

/// Calls f(voxel, distance from p_B to its centre) for the voxels of a cube around a point, also
/// those outside of the grid; for none where the point is nowhere near it.
/// @param reach  half of the cube's edge at least [m]
template <class F>
void for_each_voxel_around(const geometry::VoxelGrid& grid, const Eigen::Vector3d& p_B,
                           double reach, F&& f) {
  const Eigen::Vector3d place = (p_B - grid.origin) / grid.spacing;
  if (!(place.cwiseAbs().maxCoeff() < 1e6)) {
    return;
  }
  const Voxel middle = place.array().round().cast<int>();
  const int steps = static_cast<int>(std::ceil(reach / grid.spacing));
  for (int k = -steps; k <= steps; ++k) {
    for (int j = -steps; j <= steps; ++j) {
      for (int i = -steps; i <= steps; ++i) {
        const Voxel voxel = middle + Voxel(i, j, k);
        f(voxel, (place - voxel.cast<double>()).norm() * grid.spacing);
      }
    }
  }
}

/// Calls f(i) for each bit i of a set.
template <class Set, class F>
void for_each_bit(Set set, F&& f) {
  for (; set != 0; set &= set - 1) {
    f(std::countr_zero(set));
  }
}

}  // namespace

const Schema<WorldParameters>& world_schema() {
  using P = WorldParameters;
  static const auto schema =
      Schema<P>()
          .integer("capacity", &P::capacity, 1, kMaxPieces,
                   "Greatest number of pieces of bone, the whole bone included")
          .required()
          .integer("smallest_piece", &P::smallest_piece, 1, 100'000,
                   "Voxels of the smallest part that becomes a piece; smaller parts turn to dust")
          .required()
          .integer("moves_per_tick", &P::moves_per_tick, 1, 100'000,
                   "Greatest number of voxels that go over to a new piece in one tick; fewer "
                   "spread a large piece over more ticks")
          .required()
          .flag("split_initial", &P::split_initial,
                "Whether parts that are separate at the start become pieces")
          .required()
          .check([](Table& table, P& p) {
            if (p.moves_per_tick < p.smallest_piece) {
              table.reject("moves_per_tick", fmt::format("{}", p.moves_per_tick),
                           fmt::format("at least smallest_piece ({})", p.smallest_piece));
            }
          });
  return schema;
}

BoneWorld::BoneWorld(const BoneModel& model, const Eigen::Isometry3d& pose_WB,
                     const WorldParameters& parameters)
    : parameters_((check(parameters), parameters)),
      pieces_(static_cast<std::size_t>(parameters.capacity)),
      poses_(parameters.capacity),
      plate_poses_(kMaxPlates) {
  Piece& bone = at(0);
  bone.volume = std::make_unique<BoneVolume>(model);
  bone.pose = pose_WB;
  bone.born = true;
  if (!parameters_.split_initial) {
    note_islands();
  }
  publish();
}

void BoneWorld::step() noexcept {
  event_count_ = 0;
  switch (phase_.load(std::memory_order_acquire)) {
    case Phase::kOffered:
      if (offer_.moved == 0) {
        begin_move();
      }
      if (move_some(static_cast<std::size_t>(parameters_.moves_per_tick))) {
        phase_.store(Phase::kSettled, std::memory_order_release);
      }
      break;
    case Phase::kConfirmed:
      if (unchanged_since_noted()) {
        bear();
        phase_.store(Phase::kIdle, std::memory_order_release);
      } else {
        phase_.store(Phase::kSettled, std::memory_order_release);
      }
      break;
    case Phase::kCrumbs:
      take_crumbs();
      phase_.store(Phase::kIdle, std::memory_order_release);
      break;
    case Phase::kIdle:
    case Phase::kSettled:
      break;  // the searcher's turn
  }
  if (const std::int64_t left = unplaced(); left != unplaced_told_) {
    unplaced_told_ = left;
    if (left > 0) {
      add_event({.kind = WorldEvent::Kind::kNoRoom, .voxels = left});
    }
  }
}

/// The new piece is seen from now on, where its parent is, and goes wherever that goes.
void BoneWorld::begin_move() noexcept {
  Piece& piece = at(offer_.to);
  piece.parent = offer_.from;
  piece.pose = at(offer_.from).pose;
  const auto to = static_cast<std::size_t>(offer_.to);
  held_poses_[to] = held_poses_[static_cast<std::size_t>(offer_.from)];
  if ((held_group_ & bit(offer_.from)) != 0) {
    held_group_ |= bit(offer_.to);
  }
  poses_.write(offer_.to + 1, [this](int i) { return at(i).pose; });
  count_.store(offer_.to + 1, std::memory_order_release);
}

/// @returns whether all have moved.
bool BoneWorld::move_some(std::size_t most) noexcept {
  BoneVolume& from = *at(offer_.from).volume;
  BoneVolume& to = *at(offer_.to).volume;
  const std::size_t all = offer_.from_addresses.size();
  const std::size_t end = offer_.moved + std::min(most, all - offer_.moved);
  for (; offer_.moved < end; ++offer_.moved) {
    const std::int32_t source = offer_.from_addresses[offer_.moved];
    const float density = from.density(source);
    if (density > 0.0F) {
      // Other threads may see it twice for an instant, but never a hole.
      to.put(offer_.to_addresses[offer_.moved], density);
      from.take(source, density);
    }
  }
  return end == all;
}

bool BoneWorld::unchanged_since_noted() const noexcept {
  const BoneVolume& volume = *at(offer_.to).volume;
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    if (volume.version(brick) != offer_.versions[static_cast<std::size_t>(brick)]) {
      return false;
    }
  }
  return true;
}

void BoneWorld::bear() noexcept {
  Piece& piece = at(offer_.to);
  piece.born = true;
  add_event({.kind = WorldEvent::Kind::kBorn,
             .piece = offer_.to,
             .parent = offer_.from,
             .seed = piece.seeds.empty() ? Voxel(Voxel::Zero()) : piece.seeds.front(),
             .voxels = offer_.voxels,
             .amount = offer_.amount});
  if (held_ >= 0) {
    if (const int now = holder(held_voxel_); now >= 0) {
      held_ = now;
    }
    hold_group();
  }
}

/// Takes out the crumbs that are still as they were found; what is left of the others is found
/// again. So the voxels that hang together with the seed are all of a crumb.
void BoneWorld::take_crumbs() noexcept {
  BoneVolume& from = *at(offer_.from).volume;
  std::size_t begin = 0;
  for (const std::size_t end : offer_.crumb_ends) {
    bool whole = true;
    for (std::size_t i = begin; i < end; ++i) {
      whole = whole && from.density(offer_.crumbs[i]) > 0.0F;
    }
    double amount = 0.0;
    for (std::size_t i = begin; i < end && whole; ++i) {
      amount += static_cast<double>(from.take(offer_.crumbs[i], 1.0F));
    }
    if (whole) {
      add_event({.kind = WorldEvent::Kind::kCrumb,
                 .piece = offer_.from,
                 .seed = from.voxel_at(offer_.crumbs[begin]),
                 .voxels = static_cast<std::int64_t>(end - begin),
                 .amount = amount});
    }
    begin = end;
  }
}

void BoneWorld::add_event(const WorldEvent& event) noexcept {
  if (event_count_ < events_.size()) {
    events_[event_count_++] = event;
  }
}

const BoneVolume* BoneWorld::leaving(int piece) const noexcept {
  const int last = pieces() - 1;  // only the last one can be in the making
  return !is_born(last) && parent(last) == piece ? at(last).volume.get() : nullptr;
}

int BoneWorld::holder(const Voxel& voxel) const noexcept {
  for (int piece = 0; piece < pieces(); ++piece) {
    if (at(piece).volume->density(voxel) > 0.0F) {
      return piece;
    }
  }
  return -1;
}

std::optional<PieceTouch> BoneWorld::touch(const Eigen::Vector3d& p_W,
                                           double reach) const noexcept {
  std::optional<PieceTouch> nearest;
  for (int i = 0; i < pieces() && p_W.allFinite(); ++i) {
    const BoneVolume& volume = *at(i).volume;
    const double widest = kMaxReach * volume.grid().spacing;
    const double most = nearest ? nearest->distance : std::min(reach, widest);
    const auto take_if_nearer = [&](const Voxel& voxel, double distance) {
      const PieceTouch found{known_as(i), voxel, distance};
      if (distance <= most && (!nearest || before(found, *nearest)) &&
          volume.density(voxel) > 0.0F) {
        nearest = found;
      }
    };
    for_each_voxel_around(volume.grid(), at(i).pose.inverse() * p_W, most, take_if_nearer);
  }
  return nearest;
}

void BoneWorld::grab(const PieceTouch& touch, const Eigen::Isometry3d& pose_WT) noexcept {
  const bool known = touch.piece >= 0 && touch.piece < pieces();
  held_ = known ? known_as(touch.piece) : -1;
  held_voxel_ = touch.voxel;
  held_tool_ = pose_WT;
  hold_group();
}

void BoneWorld::hold_group() noexcept {
  held_group_ = held_ < 0 ? 0 : joined_with(held_);
  held_plates_ = 0;
  const Eigen::Isometry3d pose_TW = held_tool_.inverse();
  for_each_bit(held_group_,
               [&](int i) { held_poses_[static_cast<std::size_t>(i)] = pose_TW * at(i).pose; });
  for (int plate = 0; plate < plates(); ++plate) {
    if (plate_is_on(plate) && (anchored(plate_at(plate)) & held_group_) != 0) {
      held_plates_ |= 1U << plate;
      held_plate_poses_[static_cast<std::size_t>(plate)] = pose_TW * plate_at(plate).pose;
    }
  }
}

void BoneWorld::drag(const Eigen::Isometry3d& pose_WT) noexcept {
  if (held_ < 0 || !pose_WT.matrix().allFinite()) {
    return;
  }
  held_tool_ = pose_WT;
  for_each_bit(held_group_,
               [&](int i) { at(i).pose = pose_WT * held_poses_[static_cast<std::size_t>(i)]; });
  for_each_bit(held_plates_, [&](int i) {
    const auto plate = static_cast<std::size_t>(i);
    plates_[plate].pose = pose_WT * held_plate_poses_[plate];
  });
  publish();
}

void BoneWorld::release() noexcept {
  held_ = -1;
  held_group_ = 0;
  held_plates_ = 0;
}

int BoneWorld::attach_plate(int model, std::span<const Voxel> anchors,
                            const Eigen::Isometry3d& pose_WP) noexcept {
  const int number = plates();
  if (number >= kMaxPlates) {
    return -1;
  }
  Plate& plate = plates_[static_cast<std::size_t>(number)];
  plate.anchor_count = 0;
  for (const Voxel& anchor : anchors) {
    if (plate.anchor_count < kMaxAnchors && holder(anchor) >= 0) {
      plate.anchors[static_cast<std::size_t>(plate.anchor_count++)] = anchor;
    }
  }
  if (plate.anchor_count == 0) {
    return -1;
  }
  plate.model = model;
  plate.pose = pose_WP;
  plate.on.store(true, std::memory_order_release);
  plate_poses_.write(number + 1, [this](int i) { return plate_at(i).pose; });
  plate_count_.store(number + 1, std::memory_order_release);
  hold_group();
  return number;
}

void BoneWorld::detach_plate(int plate) noexcept {
  if (plate >= 0 && plate < plates()) {
    plates_[static_cast<std::size_t>(plate)].on.store(false, std::memory_order_release);
    hold_group();
  }
}

PieceSet BoneWorld::anchored(const Plate& plate) const noexcept {
  PieceSet set = 0;
  for (int i = 0; i < plate.anchor_count; ++i) {
    if (const int piece = holder(plate.anchors[static_cast<std::size_t>(i)]); piece >= 0) {
      set |= bit(piece);
    }
  }
  return set;
}

PieceSet BoneWorld::joined_with(int piece) const noexcept {
  std::array<PieceSet, kMaxPlates + kMaxPieces> joints;
  std::size_t count = 0;
  for (int plate = 0; plate < plates(); ++plate) {
    joints[count] = plate_is_on(plate) ? anchored(plate_at(plate)) : 0;
    ++count;
  }
  for (int i = 0; i < pieces(); ++i) {
    if (!is_born(i)) {
      joints[count++] = bit(i) | bit(parent(i));
    }
  }
  PieceSet set = bit(piece);
  for (PieceSet before = 0; before != set;) {
    before = set;
    for (std::size_t i = 0; i < count; ++i) {
      set |= (joints[i] & set) != 0 ? joints[i] : 0;
    }
  }
  return set;
}

void BoneWorld::publish() noexcept {
  poses_.write(pieces(), [this](int i) { return at(i).pose; });
  plate_poses_.write(plates(), [this](int i) { return plate_at(i).pose; });
}

}  // namespace haptrial::bone
