#pragma once

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/bone/model/bone_volume.h"
#include "core/bone/model/flood.h"
#include "core/bone/model/occupancy.h"
#include "core/bone/model/world_poses.h"

namespace haptrial::bone {

inline constexpr int kMaxPieces = 64;  // one bit each in a PieceSet
inline constexpr int kMaxPlates = 16;
inline constexpr int kMaxAnchors = 100;
using PieceSet = std::uint64_t;  // bit i: piece i

struct WorldParameters {
  int capacity{32};           // pieces, from 1 to kMaxPieces; the first is the bone itself
  int smallest_piece{64};     // parts of fewer voxels turn to dust; 1: none does [voxels]
  int moves_per_tick{5000};   // voxels that change their object in a tick, >= smallest_piece
  bool split_initial{false};  // parts that are separate from the start become pieces too
};

/// The keys of [pieces].
const Schema<WorldParameters>& world_schema();

/// An event of the pieces in a tick.
struct WorldEvent {
  enum class Kind {
    kBorn,    // `piece` can be moved by itself from now on; its seeds are BoneWorld::seeds(piece)
    kCrumb,   // a part below the smallest piece was taken out of `piece`: `amount` turned to dust
    kNoRoom,  // `voxels` in parts that found no free piece stay where they are
  };
  Kind kind{Kind::kBorn};
  int piece{0};
  int parent{-1};             // of a piece that was born: where its voxels came from
  Voxel seed{Voxel::Zero()};  // one voxel of it
  std::int64_t voxels{0};
  double amount{0.0};  // sum of densities [voxels]
};

/// A voxel that a tool emptied.
struct EmptiedIn {
  int piece{0};  // that held it, as BoneWorld::known_as() has it
  Voxel voxel{Voxel::Zero()};
  std::uint8_t label{0};
  bool by_cut{false};  // by the cut plane, without any force
};

/// Contact of a tool with bone.
struct PieceTouch {
  int piece{0};
  Voxel voxel{Voxel::Zero()};
  double distance{0.0};  // from the tool to the voxel's centre [m]
};

/// All bone objects of a simulation: at first the one that was imported, and every part that was
/// cut off since. Each has a volume and a pose from the bone frame B, which all pieces share, to W;
/// a voxel keeps its (i, j, k) for ever and is in one piece at a time.
///
/// Two threads work on it. The *servo thread* owns poses and densities and calls step() once a
/// tick. The *searching thread* calls search() whenever it likes: it floods what has changed and
/// offers at most one part at a time. Both may be the same thread: a session on a simulated clock
/// calls search() every so many ticks and is then a function of what was drilled.
///
/// A part goes through four steps, handed to and fro by one atomic number:
///   1. search() makes an empty volume with room for the part and offers it.
///   2. step() moves the part's densities as they are by then, moves_per_tick a tick. Until the
///      piece is born it is rigidly joined with its parent, so nobody can tell where a voxel is.
///   3. search() looks at the new piece and notes a seed voxel of everything in it.
///   4. step() bears the piece if nothing in it has changed since, else goes back to 3.
/// Bone only ever goes away, so a part that was separate when it was seen is separate for ever;
/// and because of step 4 the seeds, with the tick of the birth, say exactly what the piece is made
/// of: split_at() repeats it in a replay. Source: Morris 2006, §3.2.6.
class BoneWorld {
 public:
  /// @param pose_WB  of the bone [m].
  /// @throws std::invalid_argument as check() does, or naming a parameter out of bounds.
  explicit BoneWorld(const BoneModel& model,
                     const Eigen::Isometry3d& pose_WB = Eigen::Isometry3d::Identity(),
                     const WorldParameters& parameters = {});
  BoneWorld(const BoneWorld&) = delete;
  BoneWorld& operator=(const BoneWorld&) = delete;

  // Any thread -----------------------------------------------------------------------------------

  /// Pieces so far, one in the making among them; a piece keeps its number, and its volume lives as
  /// long as the world, though nothing may be left in it.
  int pieces() const noexcept { return count_.load(std::memory_order_acquire); }
  const BoneVolume& volume(int piece) const noexcept { return *at(piece).volume; }
  const WorldParameters& parameters() const noexcept { return parameters_; }
  /// The poses of pieces 0 .. pieces() - 1 and of plates, as of the last tick that moved any.
  const WorldPoses& published_poses() const noexcept { return poses_; }
  const WorldPoses& published_plates() const noexcept { return plate_poses_; }
  /// Plates attached so far; one that was taken off keeps its number.
  int plates() const noexcept { return plate_count_.load(std::memory_order_acquire); }
  int plate_model(int plate) const noexcept { return plate_at(plate).model; }
  bool plate_is_on(int plate) const noexcept {
    return plate_at(plate).on.load(std::memory_order_acquire);
  }
  /// Voxels in parts that the last search found no room for; they stay where they are.
  std::int64_t unplaced() const noexcept { return unplaced_.load(std::memory_order_relaxed); }

  // Servo thread: no allocation, lock, wait or throw ---------------------------------------------

  /// The volume of a piece for drills: densities may be taken from any piece at any time.
  BoneVolume& volume(int piece) noexcept { return *at(piece).volume; }
  const Eigen::Isometry3d& pose(int piece) const noexcept { return at(piece).pose; }
  bool is_born(int piece) const noexcept { return at(piece).born; }
  /// The volume in the making that bone of a piece is moving to; null where there is none.
  const BoneVolume* leaving(int piece) const noexcept;
  int parent(int piece) const noexcept { return at(piece).parent; }
  /// Piece that callers are told for a volume: one in the making is its parent's until its birth.
  int known_as(int piece) const noexcept { return is_born(piece) ? piece : parent(piece); }
  /// Whether a piece is the bone itself, or joined with it: that lies in a holder, and no hand
  /// carries it.
  bool is_fixed(int piece) const noexcept { return (joined_with(piece) & PieceSet{1}) != 0; }
  const Eigen::Isometry3d& plate_pose(int plate) const noexcept { return plate_at(plate).pose; }

  /// Carries on what search() has offered. Once a tick, before the tick's drilling.
  void step() noexcept;
  /// Events of the last step() (and of split_at and crumble_at since).
  std::span<const WorldEvent> events() const noexcept { return {events_.data(), event_count_}; }
  /// One voxel of everything that a piece was born with.
  std::span<const Voxel> seeds(int piece) const noexcept { return at(piece).seeds; }

  /// The bone voxel whose centre is nearest to a point, in any piece.
  /// @param reach  how far to look; voxels farther than 8 spacings are not looked at [m]
  std::optional<PieceTouch> touch(const Eigen::Vector3d& p_W, double reach) const noexcept;
  /// The piece that holds bone in a voxel; -1 where none does.
  int holder(const Voxel& voxel) const noexcept;

  /// Takes hold of the piece with the touched voxel, and of all that is joined with it by plates or
  /// not born yet. Where the piece is split while it is held, the part with that voxel stays held.
  /// @param pose_WT  of the tool
  void grab(const PieceTouch& touch, const Eigen::Isometry3d& pose_WT) noexcept;
  /// Moves what is held rigidly with the tool; without a hold nothing happens.
  void drag(const Eigen::Isometry3d& pose_WT) noexcept;
  void release() noexcept;
  int held() const noexcept { return held_; }  // piece; -1: none
  /// Everything that moves with what is held, one in the making among it.
  PieceSet held_group() const noexcept { return held_group_; }

  /// Fixes a plate to the bone in these voxels: it moves with every piece that holds one of them,
  /// and joins them where they are several.
  /// @param model    the caller's number for what it looks like
  /// @param anchors  at least one with bone; those beyond kMaxAnchors are left out
  /// @returns the plate's number; -1 where kMaxPlates are on, or no anchor holds bone.
  int attach_plate(int model, std::span<const Voxel> anchors,
                   const Eigen::Isometry3d& pose_WP) noexcept;
  void detach_plate(int plate) noexcept;
  /// Everything that moves when a piece moves, itself among it.
  PieceSet joined_with(int piece) const noexcept;

  // Searching thread -----------------------------------------------------------------------------

  /// Looks for separate parts, if it is this thread's turn, and offers one to step(). Allocates.
  void search();

  // Replay: one thread, no search() --------------------------------------------------------------

  /// Does at once what a recorded kBorn did. Call right after step() of the recorded tick.
  /// @returns false when a seed holds no bone, or there is no room.
  bool split_at(int parent, std::span<const Voxel> seeds);
  /// Does what a recorded kCrumb did.
  bool crumble_at(int piece, const Voxel& seed);

 private:
  enum class Phase : int { kIdle, kOffered, kSettled, kConfirmed, kCrumbs };
  struct Piece {
    std::unique_ptr<BoneVolume> volume;
    Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  // X_WB; servo's, as the next two
    bool born{false};
    int parent{-1};
    std::vector<Voxel> seeds;  // searcher's until birth
    // Searcher's:
    Occupancy occupancy;
    bool searched{false};      // unless something changes, there is nothing to do
    std::int64_t unplaced{0};  // voxels in loose parts without room
  };
  struct Plate {
    Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  // X_WP
    int model{0};
    int anchor_count{0};
    std::array<Voxel, kMaxAnchors> anchors;
    std::atomic<bool> on{false};
  };
  /// A message between the two threads; the thread whose turn it is owns it.
  struct Offer {
    int from{0};
    int to{0};
    std::vector<std::int32_t> from_addresses;  // of the voxels to move
    std::vector<std::int32_t> to_addresses;
    std::size_t moved{0};
    std::vector<std::uint32_t> versions;  // by brick of the new piece, when its seeds were noted
    std::int64_t voxels{0};               // in the new piece, by then
    double amount{0.0};
    std::vector<std::int32_t> crumbs;     // addresses in `from`
    std::vector<std::size_t> crumb_ends;  // in `crumbs`, by crumb
  };

  Piece& at(int piece) noexcept { return pieces_[static_cast<std::size_t>(piece)]; }
  const Piece& at(int piece) const noexcept { return pieces_[static_cast<std::size_t>(piece)]; }
  const Plate& plate_at(int plate) const noexcept {
    return plates_[static_cast<std::size_t>(plate)];
  }
  void note_islands();
  std::vector<Part> cut_loose(int piece);
  bool look_at(int piece);
  void make_offer(int from, const Part& part);
  bool add_crumb(const Part& part);
  void note_seeds();
  void begin_move() noexcept;
  bool move_some(std::size_t most) noexcept;
  void take_crumbs() noexcept;
  bool unchanged_since_noted() const noexcept;
  void bear() noexcept;
  void add_event(const WorldEvent& event) noexcept;
  PieceSet anchored(const Plate& plate) const noexcept;
  void hold_group() noexcept;
  void publish() noexcept;

  WorldParameters parameters_;
  std::vector<Piece> pieces_;  // parameters_.capacity of them, for ever
  std::atomic<int> count_{1};
  std::atomic<Phase> phase_{Phase::kIdle};
  std::atomic<std::int64_t> unplaced_{0};
  Offer offer_;

  // Servo thread's.
  std::array<WorldEvent, 64> events_;
  std::size_t event_count_{0};
  std::int64_t unplaced_told_{0};
  std::array<Plate, kMaxPlates> plates_;
  std::atomic<int> plate_count_{0};
  WorldPoses poses_;
  WorldPoses plate_poses_;
  int held_{-1};
  Voxel held_voxel_{Voxel::Zero()};
  PieceSet held_group_{0};
  std::uint32_t held_plates_{0};                                // bit i: plate i
  std::array<Eigen::Isometry3d, kMaxPieces> held_poses_;        // X_TB when they were taken hold of
  std::array<Eigen::Isometry3d, kMaxPlates> held_plate_poses_;  // X_TP
  Eigen::Isometry3d held_tool_{Eigen::Isometry3d::Identity()};  // the last X_WT

  // Searching thread's.
  Flood flood_;
  std::vector<Voxel> changed_;
  std::unordered_map<std::int32_t, int> islands_;  // address in piece 0: which initial part
};

}  // namespace haptrial::bone
