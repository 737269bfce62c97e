#include "core/bone/dust.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/table.h"
#include "core/bone/dust_internal.h"

namespace haptrial::bone {
namespace {

using Ref = DustGrid::Ref;

/// From a frame whose z axis is up. Exact where up is an axis of W.
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

void require(bool good, const char* what) {
  if (!good) {
    throw std::invalid_argument(what);
  }
}

const DustParameters& checked(const DustParameters& p) {
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(positive(p.cell) && positive(p.voxel), "Dust: cells and voxels must be above 0 m");
  require(p.bulking >= 1.0 && p.bulking <= 100.0, "Dust: bulking must be from 1 to 100");
  require(positive(p.fall_speed), "Dust: fall_speed must be above 0 m/s");
  require(p.slope >= 0.05 && p.slope <= 0.7, "Dust: slope must be from 0.05 to 0.7");
  require(positive(p.suction_rate), "Dust: suction_rate must be above 0 m3/s");
  require(positive(p.suction_reach), "Dust: suction_reach must be above 0 m");
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

DustParameters read_dust_parameters(Table& table) {
  DustParameters p;
  p.cell = table.number("cell", {1e-4, 5e-3}, "m");
  p.bulking = table.number("bulking", {1.0, 100.0}, "");
  p.fall_speed = table.number("fall_speed", {0.0, 10.0, true}, "m/s");
  p.slope = table.number("slope", {0.05, 0.7}, "");
  p.suction_rate = table.number("suction_rate", {0.0, 1e-3, true}, "m3/s");
  p.suction_reach = table.number("suction_reach", {0.0, 0.02, true}, "m");
  return p;
}

Dust::Impl::Impl(const DustParameters& given)
    : parameters(checked(given)),
      R_WD(frame_with_up(given.up)),
      capacity(capacity_of(given)),
      least(capacity / 32),
      grid(given.max_blocks) {
  for (std::size_t step = 0; step < limit.size(); ++step) {
    const double apart = step <= 4 ? 1.0 : std::sqrt(2.0);
    limit[step] = static_cast<std::int32_t>(apart * parameters.slope * capacity);
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

Eigen::Vector3d Dust::Impl::centre(const DustCell& cell) const {
  return R_WD * (parameters.cell * (cell.cast<double>().array() + 0.5)).matrix();
}

DustCell Dust::Impl::cell_at(const Eigen::Vector3d& p_W) const {
  const Eigen::Array3d at = (R_WD.transpose() * p_W).array() / parameters.cell;
  return at.floor().min(1e8).max(-1e8).cast<int>();
}

Dust::Impl::Look Dust::Impl::look(const DustCell& cell, Ref ref) const {
  if (ref == kNone) {
    return {ref, cell, 0, capacity, !in_region(cell)};
  }
  const DustGrid::Cell& there = grid.at(ref);
  const bool taken = (there.flags & kTool) != 0;
  return {ref, cell, there.amount, taken ? 0 : std::max(0, capacity - there.amount),
          (there.flags & kOutside) != 0};
}

Dust::Impl::Look Dust::Impl::look_beside(const Look& from, int direction) const {
  const DustCell cell = from.cell + DustGrid::offset(direction);
  return look(cell, from.ref == kNone ? grid.find(cell) : grid.beside(from.ref, direction));
}

bool Dust::Impl::passage(Ref ref, int step) {
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

bool Dust::Impl::passage(const Look& from, const Look& to) const {
  return bones.open(centre(from.cell), centre(to.cell));
}

bool Dust::Impl::solid(Ref ref) {
  std::uint32_t& flags = grid.at(ref).flags;
  if ((flags & kSolidKnown) == 0) {
    flags |= kSolidKnown | (bones.hold(centre(grid.cell(ref))) ? kSolid : 0U);
  }
  return (flags & kSolid) != 0;
}

/// The cell's place in memory. A new block learns where the region ends and where tools are.
Ref Dust::Impl::make(const DustCell& cell) {
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
void Dust::Impl::set_free(Ref ref) {
  grid.at(ref).flags &= ~kOfBone;
  wake(ref);
}

Dust::Dust(const DustParameters& parameters) : impl_(std::make_unique<Impl>(parameters)) {}
Dust::~Dust() = default;

void Dust::follow(std::span<const DustBone> bones) {
  Impl& impl = *impl_;
  const DustBones::Change& change = impl.bones.follow(bones);
  constexpr std::size_t kMany = 20'000;  // voxels: looking at every cell is cheaper
  if (change.everything || change.centres.size() > kMany) {
    for (std::int32_t block = 0; block < impl.grid.block_count(); ++block) {
      for (int place = 0; impl.grid.block(block).used && place < DustGrid::kBlockCells; ++place) {
        impl.set_free(block * DustGrid::kBlockCells + place);
      }
    }
    return;
  }
  // A passage is no longer than a cell along each axis; the corner of a voxel reaches this far.
  const double corner = 0.5 * std::sqrt(3.0) * change.spacing;
  const int extent = static_cast<int>(std::ceil(corner / impl.parameters.cell)) + 1;
  for (const Eigen::Vector3d& centre : change.centres) {
    const DustCell middle = impl.cell_at(centre);
    const DustCell around = DustCell::Constant(extent);
    impl.grid.for_each_in(middle - around, middle + around, [&](Ref ref) { impl.set_free(ref); });
  }
}

void Dust::step(double dt) {
  require(dt >= 0.0 && std::isfinite(dt), "Dust: time must not run backwards");
  Impl& impl = *impl_;
  if (impl.held >= kWorthPlacing) {
    impl.place_held();
  }
  const double each = step_time();
  impl.time += dt;
  const double steps = std::floor(impl.time / each + 1e-9);
  impl.time = std::max(0.0, impl.time - steps * each);
  const bool sucks = std::any_of(impl.tools.tools.begin(), impl.tools.tools.end(),
                                 [](const DustTool& tool) { return tool.sucks; });
  for (double i = 0.0; i < steps; i += 1.0) {
    if (impl.cells == 0 || (impl.waiting == 0 && impl.tool_cells.empty() && !sucks)) {
      break;  // nothing can move any more
    }
    impl.substep();
  }
  impl.tidy();
}

DustBalance Dust::balance() const noexcept {
  const auto voxels = [](std::int64_t units) { return static_cast<double>(units) * kDustUnit; };
  return {voxels(impl_->deposited), voxels(impl_->lying), voxels(impl_->held),
          voxels(impl_->suctioned), voxels(impl_->fallen)};
}

std::size_t Dust::cells() const noexcept { return impl_->cells; }
std::size_t Dust::active() const noexcept { return impl_->waiting; }
std::size_t Dust::blocks() const noexcept { return impl_->grid.used(); }
std::uint64_t Dust::version() const noexcept { return impl_->version; }
double Dust::capacity() const noexcept { return impl_->capacity * kDustUnit; }
double Dust::step_time() const noexcept {
  return impl_->parameters.cell / impl_->parameters.fall_speed;
}

double Dust::amount_at(const Eigen::Vector3d& p_W) const noexcept {
  const Ref ref = impl_->grid.find(impl_->cell_at(p_W));
  return ref == DustGrid::kNone ? 0.0 : impl_->grid.at(ref).amount * kDustUnit;
}

void Dust::quads(std::vector<DustQuad>& quads) const {
  constexpr double kLeast = 0.004;  // of a full cell: less is not seen
  constexpr double kSize = 1.6;     // neighbours overlap, so that a pile has no gaps
  constexpr float kAlpha = 0.55F;
  quads.clear();
  for (std::int32_t block = 0; block < impl_->grid.block_count(); ++block) {
    if (!impl_->grid.block(block).used || impl_->grid.block(block).filled == 0) {
      continue;
    }
    for (int place = 0; place < DustGrid::kBlockCells; ++place) {
      const Ref ref = block * DustGrid::kBlockCells + place;
      const double filled = static_cast<double>(impl_->grid.at(ref).amount) / impl_->capacity;
      if (filled < kLeast) {
        continue;
      }
      const double size = kSize * impl_->parameters.cell * std::cbrt(std::min(1.0, filled));
      quads.push_back(
          {impl_->centre(impl_->grid.cell(ref)).cast<float>(), static_cast<float>(size), kAlpha});
    }
  }
}

}  // namespace haptrial::bone
