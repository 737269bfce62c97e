// Effects of tools on dust: they make it, push it and suck it in.

#include <algorithm>
#include <cmath>

#include "core/bone/dust/dust.h"
#include "core/bone/dust/dust_state.h"

namespace haptrial::bone {
namespace {

using Ref = DustGrid::Ref;

/// How far outside a tool a point is [m]; negative inside.
double outside(const DustTool& tool, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d from_tip = p_W - tool.tip;
  const double along = std::clamp(from_tip.dot(tool.axis), 0.0, tool.length);
  return (from_tip - along * tool.axis).norm() - tool.radius;
}

/// The box around everything within `reach` of a tool, in cells.
Eigen::AlignedBox3d around(const DustTool& tool) {
  Eigen::AlignedBox3d box(tool.tip);
  box.extend(tool.tip + tool.length * tool.axis);
  return {box.min().array() - tool.radius, box.max().array() + tool.radius};
}

}  // namespace

double DustState::outside_tools(const Eigen::Vector3d& p_W) const {
  double least_distance = std::numeric_limits<double>::infinity();
  for (const DustTool& tool : tools.tools) {
    if (tool.radius > 0.0) {
      least_distance = std::min(least_distance, outside(tool, p_W));
    }
  }
  return least_distance;
}

/// Notes whether a cell lies in a tool.
void DustState::flag_tools(Ref ref) {
  if (!(outside_tools(centre(grid.cell(ref))) < 0.0)) {
    return;
  }
  std::uint32_t& flags = grid.at(ref).flags;
  if ((flags & kTool) == 0) {
    ++grid.block_of(ref).pins;
  }
  if ((flags & kStays) == 0) {
    tool_cells.push_back(ref);
  }
  flags |= kTool | kStays;
}

/// The first and the last cell of a box of W.
std::pair<DustCell, DustCell> DustState::cells_around(const Eigen::AlignedBox3d& box) const {
  DustCell low = cell_at(box.min());
  DustCell high = low;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    const DustCell cell = cell_at(box.corner(type));
    low = low.cwiseMin(cell);
    high = high.cwiseMax(cell);
  }
  return {low, high};
}

bool DustState::in_water(const Eigen::Vector3d& p_W) const {
  const DustWater& water = tools.water;
  return water.radius > 0.0 && (p_W - water.centre).squaredNorm() <= water.radius * water.radius;
}

/// Dust that rests in the water may flow from now on.
void DustState::wake_in(const DustWater& water) {
  const Eigen::Vector3d extent = Eigen::Vector3d::Constant(water.radius);
  const auto [low, high] = cells_around({water.centre - extent, water.centre + extent});
  grid.for_each_in(low, high, [&](Ref ref) { wake(ref); });
}

void Dust::place(const DustTools& tools) {
  DustState& state = *state_;
  const double moved = (tools.water.centre - state.tools.water.centre).norm();
  const bool runs_elsewhere =
      tools.water.radius > 0.0 &&
      (tools.water.radius != state.tools.water.radius || moved > 0.5 * state.parameters.cell);
  const Eigen::Vector3d before_water = state.tools.water.centre;
  state.tools = tools;
  if (runs_elsewhere) {
    state.wake_in(tools.water);
  } else if (tools.water.radius > 0.0) {
    state.tools.water.centre =
        before_water;  // until it has moved far enough to wake what lies there
  }
  std::vector<Ref> before;
  before.swap(state.tool_cells);
  for (const Ref ref : before) {
    state.grid.at(ref).flags &= ~DustState::kStays;
  }
  for (const DustTool& tool : tools.tools) {
    if (tool.radius > 0.0) {
      const auto [low, high] = state.cells_around(around(tool));
      state.grid.for_each_in(low, high, [&](Ref ref) { state.flag_tools(ref); });
    }
  }
  for (const Ref ref : before) {
    if ((state.grid.at(ref).flags & DustState::kStays) == 0) {
      state.grid.at(ref).flags &= ~DustState::kTool;
      if (--state.grid.block_of(ref).pins == 0) {
        state.maybe_idle.push_back(DustGrid::number(ref));
      }
      state.wake_above_and_beside(ref);
    }
  }
  state.tidy();
}

/// Dust within a tool goes to where the tool is less deep, and up.
void DustState::expel() {
  constexpr int kUp = -1;                                       // no step that dust takes by itself
  constexpr std::array<int, 6> kFaces{1, 2, 3, 4, kUp, kDown};  // in kDustSteps
  const double upwards = 0.1 * parameters.cell;
  for (const Ref ref : tool_cells) {
    if (grid.at(ref).amount == 0) {
      continue;
    }
    const CandidateCell here = look(grid.cell(ref), ref);
    const double depth = outside_tools(centre(here.cell));
    std::array<Flow, 6> out;
    std::array<double, 6> weights{};
    std::size_t count = 0;
    double sum = 0.0;
    for (const int face : kFaces) {
      const bool up = face == kUp;
      const auto& by = kDustSteps[up ? kDown : static_cast<std::size_t>(face)];
      const CandidateCell to = look_beside(here, DustGrid::direction(by[0], by[1], up ? 1 : by[2]));
      const double out_by = outside_tools(centre(to.cell)) - depth;
      const double gain = up ? std::max(0.0, out_by) + upwards : out_by;
      const std::int32_t room = (capacity - to.amount) / static_cast<int>(kFaces.size());
      if (gain > 0.0 && room > least && (up ? passage(here, to) : passage(ref, face))) {
        out[count] = {ref, to, room};
        weights[count++] = gain;
        sum += gain;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double part = here.amount * (weights[i] / sum);
      out[i].amount = std::min(out[i].amount, static_cast<std::int32_t>(part));
      if (out[i].amount > 0) {
        flows.push_back(out[i]);
      }
    }
  }
  make_flows();
}

/// Takes dust near the mouth of each sucking tool, and near each tool with water.
void DustState::suck() {
  for (std::size_t t = 0; t < tools.tools.size(); ++t) {
    const DustTool& tool = tools.tools[t];
    if (!(tool.radius > 0.0) || cells == 0) {
      continue;
    }
    if (tool.sucks) {
      take_near(t, parameters.suction_reach, parameters.suction_rate);
    }
    if (tool.rinses && parameters.water_rate > 0.0) {
      take_near(t, tool.radius + parameters.water_reach, parameters.water_rate);
    }
  }
}

/// Whether no bone lies between a tool's tip and a cell. The answer is kept, because lines are what
/// suction costs, while neither tools nor bone change.
bool DustState::reaches(std::size_t tool, Ref ref) {
  DustGrid::Cell& cell = grid.at(ref);
  if ((cell.flags & reach_known(tool)) == 0) {
    const bool free = !bones.cross(centre(grid.cell(ref)), tools.tools[tool].tip);
    cell.flags |= reach_known(tool) | (free ? reached(tool) : 0U);
    reach_cells.push_back(ref);
  }
  return (cell.flags & reached(tool)) != 0;
}

void DustState::forget_reach() {
  for (const Ref ref : reach_cells) {
    grid.at(ref).flags &= ~kOfReach;
  }
  reach_cells.clear();
}

/// Takes dust that a straight line from a tool's tip reaches, from every cell the same part of what
/// is there. @param rate  solid volume a second [m3/s]
void DustState::take_near(std::size_t tool, double reach, double rate) {
  const Eigen::Vector3d& place_W = tools.tools[tool].tip;
  const double voxel = parameters.voxel * parameters.voxel * parameters.voxel;
  std::vector<Ref> reached;
  std::int64_t there = 0;
  const DustCell middle = cell_at(place_W);
  const DustCell extent =
      DustCell::Constant(static_cast<int>(std::ceil(reach / parameters.cell)) + 1);
  grid.for_each_in(middle - extent, middle + extent, [&](Ref ref) {
    if (grid.at(ref).amount > 0 &&
        (centre(grid.cell(ref)) - place_W).squaredNorm() <= reach * reach && reaches(tool, ref)) {
      reached.push_back(ref);
      there += grid.at(ref).amount;
    }
  });
  const double step = parameters.cell / parameters.fall_speed;
  const double may = rate * step / voxel / kDustUnit;
  const double part = std::min(1.0, may / static_cast<double>(std::max<std::int64_t>(1, there)));
  for (const Ref ref : reached) {
    const auto amount = static_cast<std::int32_t>(std::ceil(part * grid.at(ref).amount));
    suctioned += amount;
    lying -= amount;
    change(ref, -amount);
    wake_above_and_beside(ref);
  }
}

void Dust::deposit(const DustDeposit& deposit) {
  DustState& state = *state_;
  if (!(deposit.amount >= 0.0 && deposit.radius >= 0.0 && deposit.centre.allFinite() &&
        deposit.amount < 1e9)) {
    throw std::invalid_argument("Dust: a deposit must be finite and not negative");
  }
  const double apart = (deposit.centre - state.pending.centre).squaredNorm();
  if (state.held > 0 && apart > 4.0 * state.parameters.cell * state.parameters.cell) {
    state.place_held();
  }
  state.pending = deposit;
  state.deposited_rest += deposit.amount / kDustUnit;
  const double whole = std::floor(state.deposited_rest);
  state.deposited_rest -= whole;
  state.held += static_cast<std::int64_t>(whole);
  state.deposited += static_cast<std::int64_t>(whole);
}

/// Puts what is held around the burr, as near as there is room. A rest that is too little for an
/// even part to each cell waits: looking for room farther out is what costs time.
void DustState::place_held() {
  constexpr int kShells = 8;
  for (int shell = 0; shell < kShells && held > 0; ++shell) {
    // A hair less, so that cells that are as far as each other are in the same shell.
    const double inner = std::max(0.0, pending.radius + (shell - 1e-6) * parameters.cell);
    const auto [placed, cells_with_room] = place_in_shell(inner, inner + parameters.cell, held);
    held -= placed;
    lying += placed;
    if (held < cells_with_room) {
      return;
    }
  }
}

/// Puts even parts of `rest` at this distance from the burr's centre.
DustState::PlacedDust DustState::place_in_shell(double inner, double outer, std::int64_t rest) {
  std::vector<std::pair<DustCell, std::int32_t>> free;
  const DustCell middle = cell_at(pending.centre);
  const int extent = static_cast<int>(std::ceil(outer / parameters.cell)) + 1;
  for (int k = -extent; k <= extent; ++k) {
    for (int j = -extent; j <= extent; ++j) {
      for (int i = -extent; i <= extent; ++i) {
        const DustCell cell = middle + DustCell(i, j, k);
        const Eigen::Vector3d at = centre(cell);
        const double distance = (at - pending.centre).squaredNorm();
        if (distance < inner * inner || distance >= outer * outer || !in_region(cell)) {
          continue;
        }
        const CandidateCell there = look(cell, grid.find(cell));
        if (there.room > 0 && outside_tools(at) >= 0.0 && bones.open(pending.centre, at)) {
          free.emplace_back(cell, there.room);
        }
      }
    }
  }
  std::int64_t placed = 0;
  const std::int64_t share = rest / std::max<std::int64_t>(1, std::ssize(free));
  for (const auto& [cell, room] : free) {
    const auto amount = static_cast<std::int32_t>(std::min<std::int64_t>(share, room));
    if (amount > 0) {
      if (const Ref ref = make(cell); ref != kNone) {
        change(ref, amount);
        wake(ref);
        placed += amount;
      }
    }
  }
  return {placed, std::ssize(free)};
}

}  // namespace haptrial::bone
