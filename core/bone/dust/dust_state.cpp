#include <algorithm>
#include <cmath>

#include "core/bone/dust/dust_state.h"

#include "core/base/require.h"

namespace haptrial::bone {
namespace {

using Ref = DustGrid::Ref;

/// Rotation from a frame whose z axis is up. Exact where up is an axis of W.
Eigen::Matrix3d frame_with_up(const Eigen::Vector3d& up) {
  const Eigen::Vector3d z = up.normalized();
  Eigen::Index least = 0;
  z.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d helper = Eigen::Vector3d::Unit(least);
  const Eigen::Vector3d x = (helper - helper.dot(z) * z).normalized();
  Eigen::Matrix3d frame;
  frame << x, z.cross(x), z;
  return frame;
}

const DustParameters& checked(const DustParameters& p) {
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(positive(p.cell) && positive(p.voxel), "Dust: cells and voxels must be above 0 m");
  require(p.bulking >= 1.0 && p.bulking <= 100.0, "Dust: bulking must be from 1 to 100");
  require(positive(p.fall_speed), "Dust: fall_speed must be above 0 m/s");
  require(p.slope >= kLeastSlope && p.slope <= 0.7, "Dust: slope must be from 0.05 to 0.7");
  require(positive(p.suction_rate), "Dust: suction_rate must be above 0 m3/s");
  require(positive(p.suction_reach), "Dust: suction_reach must be above 0 m");
  require(p.water_rate >= 0.0 && std::isfinite(p.water_rate),
          "Dust: water_rate must not be below 0 m3/s");
  require(positive(p.water_reach), "Dust: water_reach must be above 0 m");
  require(p.up.allFinite() && p.up.norm() > 0.0, "Dust: up must be a direction");
  require(p.max_blocks >= 1 && p.max_blocks <= 100'000, "Dust: max_blocks must be 1 to 100,000");
  require(!p.region.isEmpty() && p.region.min().allFinite() && p.region.max().allFinite(),
          "Dust: the region must be a box");
  constexpr double kMostCells = 1e5;  // along an axis: blocks are found by 21 bits of their place
  const double reach = p.region.min().cwiseAbs().cwiseMax(p.region.max().cwiseAbs()).norm();
  require(reach < kMostCells * p.cell, "Dust: the region must be less than 100,000 cells wide");
  return p;
}

std::int32_t capacity_of(const DustParameters& p) {
  const double edge = p.cell / p.voxel;
  const double units = edge * edge * edge / p.bulking / kDustUnit;
  require(units >= 1024.0 && units <= 2.6e8, "Dust: cells and voxels must be of like sizes");
  return static_cast<std::int32_t>(std::lround(units));
}

}  // namespace

DustState::DustState(const DustParameters& given)
    : parameters(checked(given)),
      R_WD(frame_with_up(given.up)),
      capacity(capacity_of(given)),
      least(capacity / 32),
      grid(given.max_blocks) {
  for (std::size_t step = 0; step < limit.size(); ++step) {
    const double apart = step <= 4 ? 1.0 : std::sqrt(2.0);
    limit[step] = static_cast<std::int32_t>(apart * parameters.slope * capacity);
    wet_limit[step] = static_cast<std::int32_t>(apart * kLeastSlope * capacity);
  }
  lowest_layer = std::numeric_limits<int>::max();
  int highest = std::numeric_limits<int>::min();
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    const int layer = cell_at(parameters.region.corner(type)).z();
    lowest_layer = std::min(lowest_layer, layer - 1);
    highest = std::max(highest, layer + 1);
  }
  current.resize(static_cast<std::size_t>(highest - lowest_layer + 1));
  next.resize(current.size());
}

Eigen::Vector3d DustState::centre(const DustCell& cell) const {
  return R_WD * (parameters.cell * (cell.cast<double>().array() + 0.5)).matrix();
}

DustCell DustState::cell_at(const Eigen::Vector3d& p_W) const {
  const Eigen::Array3d at = (R_WD.transpose() * p_W).array() / parameters.cell;
  return at.floor().min(1e8).max(-1e8).cast<int>();
}

DustState::CandidateCell DustState::look(const DustCell& cell, Ref ref) const {
  if (ref == kNone) {
    return {ref, cell, 0, capacity, !in_region(cell)};
  }
  const DustGrid::Cell& there = grid.at(ref);
  const bool taken = (there.flags & kTool) != 0;
  return {ref, cell, there.amount, taken ? 0 : std::max(0, capacity - there.amount),
          (there.flags & kOutside) != 0};
}

DustState::CandidateCell DustState::look_beside(const CandidateCell& from, int direction) const {
  const DustCell cell = from.cell + DustGrid::offset(direction);
  return look(cell, from.ref == kNone ? grid.find(cell) : grid.beside(from.ref, direction));
}

bool DustState::passage(Ref ref, int step) {
  const std::uint32_t flags = grid.at(ref).flags;
  if ((flags & known(step)) != 0) {
    return (flags & open(step)) != 0;
  }
  const auto& s = kDustSteps[static_cast<std::size_t>(step)];
  const DustCell cell = grid.cell(ref);
  const bool free = bones.open(centre(cell), centre(cell + DustCell(s[0], s[1], s[2])));
  grid.at(ref).flags |= known(step) | (free ? open(step) : 0U);
  return free;
}

bool DustState::passage(const CandidateCell& from, const CandidateCell& to) const {
  return bones.open(centre(from.cell), centre(to.cell));
}

bool DustState::solid(Ref ref) {
  std::uint32_t& flags = grid.at(ref).flags;
  if ((flags & kSolidKnown) == 0) {
    flags |= kSolidKnown | (bones.hold(centre(grid.cell(ref))) ? kSolid : 0U);
  }
  return (flags & kSolid) != 0;
}

/// The cell's place in memory. A new block learns where the region ends and where tools are.
Ref DustState::make(const DustCell& cell) {
  const Ref ref = grid.make(cell);
  if (ref != kNone && grid.made_block()) {
    const Ref first = ref - DustGrid::place(ref);
    for (Ref each = first; each < first + DustGrid::kBlockCells; ++each) {
      if (!in_region(grid.cell(each))) {
        grid.at(each).flags |= kOutside;
      }
      flag_tools(each);
    }
    maybe_idle.push_back(DustGrid::number(ref));
  }
  return ref;
}

/// Forgets what bone decided about a cell, and wakes its dust.
void DustState::set_free(Ref ref) {
  grid.at(ref).flags &= ~kOfBone;
  wake(ref);
}

}  // namespace haptrial::bone
