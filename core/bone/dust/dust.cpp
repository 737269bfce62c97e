#include "core/bone/dust/dust.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/bone/dust/dust_state.h"

namespace haptrial::bone {

using Ref = DustGrid::Ref;

Dust::Dust(const DustParameters& parameters) : state_(std::make_unique<DustState>(parameters)) {}
Dust::~Dust() = default;

void Dust::follow(std::span<const DustBone> bones) {
  DustState& state = *state_;
  const DustBones::Change& change = state.bones.follow(bones);
  constexpr std::size_t kMany = 20'000;  // voxels: looking at every cell is cheaper
  if (change.everything || change.centres.size() > kMany) {
    for (std::int32_t block = 0; block < state.grid.block_count(); ++block) {
      for (int place = 0; state.grid.block(block).used && place < DustGrid::kBlockCells; ++place) {
        state.set_free(block * DustGrid::kBlockCells + place);
      }
    }
    return;
  }
  // A passage is no longer than a cell along each axis; the corner of a voxel reaches this far.
  const double corner = 0.5 * std::sqrt(3.0) * change.spacing;
  const int extent = static_cast<int>(std::ceil(corner / state.parameters.cell)) + 1;
  for (const Eigen::Vector3d& centre : change.centres) {
    const DustCell middle = state.cell_at(centre);
    const DustCell around = DustCell::Constant(extent);
    state.grid.for_each_in(middle - around, middle + around, [&](Ref ref) { state.set_free(ref); });
  }
}

void Dust::step(double dt) {
  if (!(dt >= 0.0 && std::isfinite(dt))) {
    throw std::invalid_argument("Dust: time must not run backwards");
  }
  DustState& state = *state_;
  state.forget_reach();  // tools and bones may have changed since the last call, and do not in this
  if (state.held >= kWorthPlacing) {
    state.place_held();
  }
  const double each = step_time();
  state.time += dt;
  const double steps = std::floor(state.time / each + 1e-9);
  state.time = std::max(0.0, state.time - steps * each);
  const bool sucks = std::any_of(state.tools.tools.begin(), state.tools.tools.end(),
                                 [](const DustTool& tool) { return tool.sucks; });
  for (double i = 0.0; i < steps; i += 1.0) {
    if (state.cells == 0 || (state.waiting == 0 && state.tool_cells.empty() && !sucks)) {
      break;  // nothing can move any more
    }
    state.substep();
  }
  state.tidy();
}

DustBalance Dust::balance() const noexcept {
  const auto voxels = [](std::int64_t units) { return static_cast<double>(units) * kDustUnit; };
  return {voxels(state_->deposited), voxels(state_->lying), voxels(state_->held),
          voxels(state_->suctioned), voxels(state_->fallen)};
}

std::size_t Dust::cells() const noexcept { return state_->cells; }
std::size_t Dust::active() const noexcept { return state_->waiting; }
std::size_t Dust::blocks() const noexcept { return state_->grid.used(); }
std::uint64_t Dust::version() const noexcept { return state_->version; }
double Dust::capacity() const noexcept { return state_->capacity * kDustUnit; }
double Dust::step_time() const noexcept {
  return state_->parameters.cell / state_->parameters.fall_speed;
}

double Dust::amount_at(const Eigen::Vector3d& p_W) const noexcept {
  const Ref ref = state_->grid.find(state_->cell_at(p_W));
  return ref == DustGrid::kNone ? 0.0 : state_->grid.at(ref).amount * kDustUnit;
}

/// Whether the cell's dust cannot be seen for that in the six cells at its faces.
static bool is_buried(const DustGrid& grid, Ref ref, std::int32_t enough) {
  constexpr std::array<int, 6> kFaces{4, 10, 12, 14, 16, 22};  // directions of DustGrid
  return std::ranges::all_of(kFaces, [&](int direction) {
    const Ref beside = grid.beside(ref, direction);
    return beside != DustGrid::kNone && grid.at(beside).amount >= enough;
  });
}

/// Whether all of the cell's dust will fall on in the next step, as far as is known of it.
static bool falls(const DustState& state, Ref ref) {
  const DustGrid::Cell& cell = state.grid.at(ref);
  const std::uint32_t free = DustState::known(kDown) | DustState::open(kDown);
  const Ref below = state.grid.beside(ref, DustGrid::direction(0, 0, -1));
  return (cell.flags & free) == free &&
         (below == DustGrid::kNone || cell.amount + state.grid.at(below).amount <= state.capacity);
}

void Dust::quads(std::vector<DustQuad>& quads) const {
  constexpr double kLeast = 0.004;  // of a full cell: less is not seen
  constexpr double kSize = 1.6;     // neighbours overlap, so that a pile has no gaps
  constexpr float kAlpha = 0.55F;
  const std::int32_t enough = state_->capacity / 2;
  quads.clear();
  for (std::int32_t block = 0; block < state_->grid.block_count(); ++block) {
    if (!state_->grid.block(block).used || state_->grid.block(block).filled == 0) {
      continue;
    }
    for (int place = 0; place < DustGrid::kBlockCells; ++place) {
      const Ref ref = block * DustGrid::kBlockCells + place;
      const double filled = static_cast<double>(state_->grid.at(ref).amount) / state_->capacity;
      if (filled < kLeast || is_buried(state_->grid, ref, enough) || falls(*state_, ref)) {
        continue;
      }
      const double size = kSize * state_->parameters.cell * std::cbrt(std::min(1.0, filled));
      quads.push_back(
          {state_->centre(state_->grid.cell(ref)).cast<float>(), static_cast<float>(size), kAlpha});
    }
  }
}

}  // namespace haptrial::bone
