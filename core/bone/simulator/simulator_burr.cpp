// The burr of a simulator at bone, at soft tissue and at the tube in the other hand.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/bone/simulator/felt_part.h"
#include "core/bone/simulator/saw.h"
#include "core/bone/simulator/simulator.h"

namespace haptrial::bone {
namespace {

// Removal depends on the force: rounded to this, a sum of two contacts gives the same bits as the
// one contact that it was before a part was separated.
constexpr double kForceStep = 0x1p-13;  // [N]

class RodsOfTool {
 public:
  void add(const Rod& rod) noexcept {
    if (count_ < rods_.size()) {
      rods_[count_++] = rod;
    }
  }
  std::span<const Rod> all() const noexcept { return std::span(rods_).first(count_); }

 private:
  std::array<Rod, ToolContact::kMost> rods_;
  std::size_t count_{0};
};

/// The parts of a tool that another tool can meet: within a burr, but for its edges, and its
/// holder; a tube or a probe. Plates, planes and grips have no such parts.
RodsOfTool rods_of(const ToolSpec& tool, const BurrShape* shape, const ToolState& state) noexcept {
  RodsOfTool rods;
  const Eigen::Vector3d& tip = state.tip.position;
  const Eigen::Vector3d axis = state.axis();
  if (const auto* burr = tool.as<BurrTool>()) {
    const std::span<const BurrShape::Ball> balls = shape->balls();
    for (std::size_t i = 0; i < std::max<std::size_t>(balls.size() - 1, 1); ++i) {
      const BurrShape::Ball& next = balls[std::min(i + 1, balls.size() - 1)];
      rods.add(
          {tip + balls[i].z * axis, tip + next.z * axis, std::min(balls[i].radius, next.radius)});
    }
    const double thin =
        std::min(burr->radius(), burr->shaft ? burr->shaft->radius : tool.handle_radius);
    const double top = shape->half_length();
    rods.add({tip + top * axis, tip + (top + tool.handle_length) * axis, thin});
  } else if (const auto* suction = tool.as<SuctionTool>()) {
    rods.add({tip, tip + tool.handle_length * axis, suction->radius});
  } else if (const auto* probe = tool.as<ProbeTool>()) {
    rods.add({tip, tip + tool.handle_length * axis, probe->radius});
  }
  return rods;
}

BurrTuning tuning_of(const BurrTool& tool) noexcept {
  return {tool.feel, tool.burr.removal_rate, tool.burr.falloff, tool.burr.tangential_gain};
}

}  // namespace

bool Simulator::Reach::is_near(const Eigen::Vector3d& p_B, double radius) const noexcept {
  return ((p_B - low).array() > -radius).all() && ((high - p_B).array() > -radius).all();
}

/// Bricks of a piece are there from its beginning.
const Simulator::Reach& Simulator::reach_of(int piece) noexcept {
  for (; reaches_known_ <= piece; ++reaches_known_) {
    const BoneVolume& volume = std::as_const(world_).volume(reaches_known_);
    Reach& reach = reaches_[static_cast<std::size_t>(reaches_known_)];
    reach.low.setConstant(std::numeric_limits<double>::infinity());
    reach.high = -reach.low;
    const double half = 0.5 * volume.grid().spacing;
    for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
      const Voxel& first = volume.brick_origin(brick);
      const Eigen::Vector3d centre = volume.grid().centre(first);
      const double width = volume.grid().spacing * BoneVolume::kEdge;
      reach.low = reach.low.cwiseMin(centre - Eigen::Vector3d::Constant(half));
      reach.high = reach.high.cwiseMax(centre + Eigen::Vector3d::Constant(width - half));
    }
  }
  return reaches_[static_cast<std::size_t>(piece)];
}

Tuning tuning_of(const SimulatorParameters& parameters) noexcept {
  Tuning tuning;
  for (std::size_t i = 0; i < std::min(kMostTools, parameters.tools.size()); ++i) {
    if (const auto* burr = parameters.tools[i].as<BurrTool>()) {
      tuning.burrs[i] = tuning_of(*burr);
    }
  }
  tuning.tube = parameters.tube ? parameters.tube->feel : FeelParameters{};
  return tuning;
}

void Simulator::tune(const Tuning& tuning) noexcept {
  for (std::size_t i = 0; i < std::min(kMostTools, tools_.size()); ++i) {
    if (auto* burr = std::get_if<BurrTool>(&tools_[i].kind)) {
      const BurrTuning& to = tuning.burrs[i];
      before_[i] = tuning_of(*burr);
      burr->feel = to.feel;
      burr->burr.removal_rate = to.removal_rate;
      burr->burr.falloff = to.falloff;
      burr->burr.tangential_gain = to.tangential_gain;
      drills_[i]->set_rates(to.removal_rate, to.falloff);
    }
  }
  if (second_) {
    second_->feel_as(tuning.tube);
  }
  transition_.begin();
}

/// Forces of a burr in contact.
void Simulator::feel(const BurrTool& tool, const Contact& contact, double turning) noexcept {
  output_.force = bone_force(contact, tool.feel, tool.burr, turning);
  output_.drag = drag_force(contact, tool.burr, turning);
  if (transition_.is_on()) {
    const BurrTuning& was = before_[in_hand()];
    BurrParameters burr = tool.burr;
    burr.tangential_gain = was.tangential_gain;
    const double w = transition_.weight();
    output_.force = (1.0 - w) * bone_force(contact, was.feel, burr, turning) + w * output_.force;
    output_.drag = (1.0 - w) * drag_force(contact, burr, turning) + w * output_.drag;
  }
}

void Simulator::drill(const BurrTool& tool, const SimulatorInput& input) noexcept {
  Drill& drill = *drills_[in_hand()];
  drill.begin_tick();
  Contact all;
  const int pieces = world_.pieces();
  for (int piece = 0; piece < pieces; ++piece) {
    const Eigen::Isometry3d& pose = world_.pose(piece);
    const Eigen::Vector3d tip_B = pose.inverse(Eigen::Isometry) * input.tool.tip.position;
    Contact& contact = contacts_[static_cast<std::size_t>(piece)];
    contact = {};
    if (!reach_of(piece).is_near(tip_B, drill.burr().reach())) {
      continue;
    }
    const Eigen::Quaterniond turn(pose.linear());
    contact = drill.touch(world_.volume(piece), tip_B, turn.conjugate() * input.tool.orientation);
    if (contact) {
      all = all ? together(all, in_world(contact, pose)) : in_world(contact, pose);
    }
  }
  output_.power = input.power;
  output_.contact = static_cast<bool>(all);
  output_.immersed = all.samples;
  if (!all) {
    waits_until_free_ = false;
    return;
  }
  if (waits_until_free_) {
    return;
  }
  const double turning = handpiece_.turning(input.power);
  feel(tool, all, turning);
  const double driving = removal_force(tool, output_.force, input.tool.axis());
  const double force = kForceStep * std::round(driving / kForceStep);
  const double sharp_power = input.power * handpiece_.sharpness(output_.tool);
  double volume_taken = 0.0;
  for (int piece = 0; piece < pieces; ++piece) {
    const Contact& contact = contacts_[static_cast<std::size_t>(piece)];
    if (!contact) {
      continue;
    }
    BoneVolume& volume = world_.volume(piece);
    const Removal removal = drill.remove(volume, contact, force, sharp_power, input.dt);
    output_.removed += removal.amount;
    volume_taken += removal.volume;
    for (const EmptiedVoxel& voxel : removal.emptied) {  // no more than there is room for
      emptied_.push_back(
          {world_.known_as(piece), volume.voxel_at(voxel.address), voxel.label, false});
    }
  }
  handpiece_.take(output_.tool, volume_taken);
  if (output_.removed > 0.0) {
    const bool ball = drill.burr().shape().is_ball();
    deposits_.push_back(
        {ball ? input.tool.tip.position : all.centroid, drill.burr().radius(), output_.removed});
  }
}

/// Soft tissue is part of the bone itself, not of pieces that come off it. It is torn open where it
/// tears, and then wherever a burr turns in a hole.
void Simulator::yield(std::span<const BurrShape::Ball> balls,
                      const SimulatorInput& input) noexcept {
  if (soft_.empty()) {
    return;
  }
  const Eigen::Isometry3d& pose = world_.pose(0);
  const BallAt ball = deepest_ball(balls, input.tool, pose, soft_);
  const bool is_tube = tools_[in_hand()].as<SuctionTool>() != nullptr;
  const Eigen::Vector3d force =
      soft_.tick(ball.centre_B, ball.radius, is_tube && input.power > 0.0);
  output_.yields = !force.isZero(0.0);
  output_.force += pose.linear() * force;
  const bool turns = !is_tube && input.power > 0.0;
  if (!soft_.tears().empty() || (turns && soft_.in_hole())) {
    empty_soft(ball.centre_B, ball.radius);
  }
}

/// The first hand's tool and the other's tube push each other apart.
void Simulator::meet(const SimulatorInput& input) noexcept {
  if (output_.mode != HandMode::kTool) {
    second_->leave_tool();
    return;
  }
  const RodsOfTool rods = rods_of(tool(), burr_shape(), input.tool);
  output_.pushed = second_->push(rods.all(), input.tool.tip.velocity, input.tube, input.dt);
}

/// Voxels of soft structures whose centres are in a ball.
void Simulator::empty_soft(const Eigen::Vector3d& tip_B, double radius) noexcept {
  BoneVolume& volume = world_.volume(0);
  const geometry::VoxelGrid& grid = volume.grid();
  const Eigen::Array3d middle = (tip_B - grid.origin).array() / grid.spacing;
  const double wide = radius / grid.spacing;
  const Eigen::Array3i low = (middle - wide).ceil().cast<int>().cwiseMax(0);
  const Eigen::Array3i high = (middle + wide).floor().cast<int>().cwiseMin(grid.last().array());
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        const std::int32_t address = volume.address({i, j, k});
        const std::uint8_t label = volume.label(address);
        const bool in_ball =
            (Eigen::Array3d(i, j, k) - middle).matrix().squaredNorm() <= wide * wide;
        if (address > 0 && in_ball && soft_.is_soft(label) && volume.density(address) > 0.0F) {
          output_.removed += static_cast<double>(volume.take(address, 1.0F));
          emptied_.push_back({world_.known_as(0), {i, j, k}, label, false});
        }
      }
    }
  }
}

}  // namespace haptrial::bone
