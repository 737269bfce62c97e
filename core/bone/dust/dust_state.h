#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/bone/dust/dust_grid.h"
#include "core/bone/dust/dust_parameters.h"
#include "core/bone/dust/dust_surroundings.h"

namespace haptrial::bone {

/// Steps that dust takes by itself: down, to the four sides and to the four corners of a layer.
inline constexpr std::array<std::array<int, 3>, 9> kDustSteps{{{0, 0, -1},
                                                               {1, 0, 0},
                                                               {-1, 0, 0},
                                                               {0, 1, 0},
                                                               {0, -1, 0},
                                                               {1, 1, 0},
                                                               {-1, -1, 0},
                                                               {1, -1, 0},
                                                               {-1, 1, 0}}};
inline constexpr int kDown = 0;

inline constexpr double kDustUnit = 1.0 / (1 << 20);    // of an amount [solid voxels]
inline constexpr std::int64_t kWorthPlacing = 1 << 10;  // less that is held waits [units]

/// All that a Dust holds.
struct DustState {
  using Ref = DustGrid::Ref;
  static constexpr Ref kNone = DustGrid::kNone;
  // Marks of a cell. Passages are found when they are asked for, until the bone around changes.
  static constexpr std::uint32_t kQueued = 1U << 0;      // waits to be looked at
  static constexpr std::uint32_t kTool = 1U << 1;        // within a tool
  static constexpr std::uint32_t kStays = 1U << 2;       // within a tool that was just placed
  static constexpr std::uint32_t kOutside = 1U << 3;     // of the region
  static constexpr std::uint32_t kSolidKnown = 1U << 4;  // kSolid says whether
  static constexpr std::uint32_t kSolid = 1U << 5;       // its centre lies in bone
  static constexpr std::uint32_t known(int step) { return 1U << (6 + step); }
  static constexpr std::uint32_t open(int step) { return 1U << (15 + step); }
  // Whether a straight line leads to the tip of a tool, until forget_reach().
  static constexpr std::uint32_t reach_known(std::size_t tool) { return 1U << (24 + tool); }
  static constexpr std::uint32_t reached(std::size_t tool) { return 1U << (28 + tool); }
  static_assert(DustTools::kMost <= 4, "a cell has four bits for what is known of each tool");
  static constexpr std::uint32_t kOfReach = ~0U << 24;
  static constexpr std::uint32_t kOfBone = ~0U << 4;  // all that bone decides

  /// A cell as dust finds it that might go there; it need not have a block.
  struct CandidateCell {
    Ref ref;
    DustCell cell;
    std::int32_t amount;
    std::int32_t room;
    bool outside;
  };
  struct Flow {
    Ref from;
    CandidateCell to;
    std::int32_t amount;
  };

  explicit DustState(const DustParameters& parameters);

  // Places
  Eigen::Vector3d centre(const DustCell& cell) const;
  DustCell cell_at(const Eigen::Vector3d& p_W) const;
  bool in_region(const DustCell& cell) const { return parameters.region.contains(centre(cell)); }
  CandidateCell look(const DustCell& cell, Ref ref) const;
  CandidateCell look_beside(const CandidateCell& from, int direction) const;
  bool passage(Ref ref, int step);
  bool passage(const CandidateCell& from, const CandidateCell& to) const;
  bool solid(Ref ref);
  Ref make(const DustCell& cell);

  // Amounts
  void change(Ref ref, std::int32_t by);
  void wake(Ref ref);
  void wake_above_and_beside(Ref ref);
  void move(Ref from, const CandidateCell& to, std::int32_t amount);
  void make_flows();

  // A step
  void substep();
  void fall(Ref ref);
  void seek(Ref ref);
  void seek_way_out(Ref ref);
  void tidy();

  // Tools and bone
  double outside_tools(const Eigen::Vector3d& p_W) const;
  void flag_tools(Ref ref);
  std::pair<DustCell, DustCell> cells_around(const Eigen::AlignedBox3d& box) const;
  bool in_water(const Eigen::Vector3d& p_W) const;
  void wake_in(const DustWater& water);
  void expel();
  void suck();
  void take_near(std::size_t tool, double reach, double rate);
  bool reaches(std::size_t tool, Ref ref);
  void forget_reach();
  void set_free(Ref ref);
  void place_held();
  struct PlacedDust {
    std::int64_t amount;
    std::int64_t cells;  // that had room
  };
  PlacedDust place_in_shell(double inner, double outer, std::int64_t rest);

  DustParameters parameters;
  Eigen::Matrix3d R_WD;  // from the lattice's frame D, whose z axis is up
  std::int32_t capacity;
  std::int32_t least;                     // excess that still flows
  std::array<std::int32_t, 9> limit;      // difference of two heights that stands, by step
  std::array<std::int32_t, 9> wet_limit;  // likewise, of slurry
  DustGrid grid;
  DustBones bones;

  std::vector<std::vector<Ref>> current;  // cells to look at, by layer
  std::vector<std::vector<Ref>> next;
  int lowest_layer;
  std::size_t waiting{0};  // in next
  std::vector<Flow> flows;
  std::vector<std::int32_t> maybe_idle;  // blocks

  DustTools tools;
  std::vector<Ref> tool_cells;
  std::vector<Ref> reach_cells;  // of which it is known whether a tool reaches them
  DustDeposit pending;           // where what is held waits

  double time{0.0};
  std::size_t cells{0};
  std::uint64_t version{0};
  // Amounts in units (docs/algorithms/bone-dust.md).
  std::int64_t deposited{0};
  double deposited_rest{0.0};
  std::int64_t lying{0};
  std::int64_t held{0};
  std::int64_t suctioned{0};
  std::int64_t fallen{0};
};

}  // namespace haptrial::bone
