#include "core/bone/simulator/simulator.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/bone/simulator/saw.h"

namespace haptrial::bone {
namespace {

constexpr std::array<std::string_view, kFunctions> kNames{
    "power", "next_tool", "previous_tool", "camera_move", "camera_turn", "zoom_in", "zoom_out",
    "carry", "apply",     "detach",        "finish",      "still",       "reverse"};

bool is_held(std::uint32_t functions, Function function) noexcept {
  return (functions & bit(function)) != 0;
}

std::vector<ToolSpec> checked(std::vector<ToolSpec> tools) {
  if (tools.empty()) {
    throw std::invalid_argument("Simulator: there must be a tool");
  }
  return tools;
}

/// The largest burr or tube has this radius [m].
double largest_radius(std::span<const ToolSpec> tools,
                      const std::optional<TubeParameters>& second) noexcept {
  double largest = second ? second->radius : 0.0;
  for (const ToolSpec& tool : tools) {
    const auto* burr = tool.as<BurrTool>();
    const auto* tube = tool.as<SuctionTool>();
    largest = std::max({largest, burr ? burr->radius() : 0.0, tube ? tube->radius : 0.0});
  }
  return largest;
}

/// Voxels whose centres a ball can reach, at most.
std::size_t most_in_ball(double radius, double spacing) noexcept {
  const double wide = 2.0 * std::ceil(radius / spacing) + 1.0;
  return static_cast<std::size_t>(wide * wide * wide);
}

/// Finalizer of SplitMix64: every bit of the input moves every bit of the output.
std::uint64_t mixed(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

}  // namespace

std::string_view name_of(Function function) noexcept {
  return kNames[static_cast<std::size_t>(function)];
}

Eigen::Isometry3d pose_of(const ToolState& tool) noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = tool.orientation.toRotationMatrix();
  pose.translation() = tool.tip.position;
  return pose;
}

Simulator::Simulator(const BoneModel& model, const SimulatorParameters& parameters)
    : tools_(checked(parameters.tools)),
      before_(tools_.size()),
      camera_parameters_(parameters.camera),
      structures_(model.structures),
      world_(model, parameters.pose_WB, parameters.world),
      soft_(model, parameters.soft_tissue, largest_radius(tools_, parameters.tube)),
      shafts_(tools_, structures_, model.grid.spacing, soft_.soft()),
      handpiece_(tools_),
      bleeding_(model, parameters.bleeding),
      injuries_(structures_),
      camera_(parameters.camera.start),
      start_(world_.volume(0).amount()) {
  std::size_t most = 1;
  for (const ToolSpec& tool : tools_) {
    const BurrTool* burr = tool.as<BurrTool>();
    const PlateTool* plate = tool.as<PlateTool>();
    drills_.push_back(burr ? std::make_unique<Drill>(for_bone(burr->burr, model.grid.spacing),
                                                     structures_, best_instruction_set(),
                                                     soft_.soft())
                           : nullptr);
    plates_.push_back(plate ? std::make_unique<PlateModel>(make_plate_model(tool.name, *plate))
                            : nullptr);
    if (burr != nullptr) {
      check(burr->feel);
      most = std::max(most, drills_.back()->most_emptied());
    }
  }
  const std::size_t torn =
      soft_.empty() ? 0 : most_in_ball(largest_radius(tools_, parameters.tube), model.grid.spacing);
  emptied_.reserve(most + 2 * torn + CutPlaneTool::kMostEmptied);
  deposits_.reserve(128);
  if (parameters.tube) {
    second_.emplace(*parameters.tube, structures_, model.grid.spacing, soft_.soft());
  }
  if (parameters.heat) {
    heat_.emplace(*parameters.heat);
  }
}

void Simulator::begin(std::uint32_t functions_held) noexcept {
  functions_ = functions_held;
  hand_known_ = false;
  waits_until_free_ = true;
  shafts_.wait();
  soft_.forget();
  soft_.forget_second();
  if (second_) {
    second_->begin();
  }
}

const SimulatorOutput& Simulator::tick(const SimulatorInput& input,
                                       std::span<const RecordedSplit> recorded) {
  emptied_.clear();
  deposits_.clear();
  soft_.begin_tick();
  bleeding_.begin_tick();
  screws_.begin_tick();
  const int tool = output_.tool;
  output_ = {};
  output_.tool = tool;
  transition_.step(input.dt);
  take_separations(recorded);
  const std::uint32_t pressed = input.functions & ~functions_;
  functions_ = input.functions;
  output_.finished = is_held(pressed, Function::kFinish);
  stills_asked_ += is_held(pressed, Function::kStill) ? 1 : 0;
  if (is_held(pressed, Function::kReverse)) {
    handpiece_.reverse();
  }
  change_tool((is_held(pressed, Function::kNextTool) ? 1 : 0) -
              (is_held(pressed, Function::kPreviousTool) ? 1 : 0));
  output_.mode = mode_of(input);
  steer(input);
  carry(input);
  if (output_.mode != HandMode::kTool || tools_[in_hand()].as<ScrewTool>() == nullptr) {
    screws_.rest();
  }
  if (output_.mode == HandMode::kTool) {
    work(input, pressed);
  } else {
    waits_until_free_ = true;
    shafts_.wait();
    soft_.forget();
  }
  if (cutter_.busy()) {
    go_on_cutting();
  }
  work_second(input);
  warm_up(input);
  bleed(input.dt);
  injuries_.tick(emptied_, soft_.tears(), input.dt);
  place_for_dust(input);
  hand_ = input.tool.tip.position;
  hand_known_ = true;
  removed_ += output_.removed;
  cut_ += output_.cut;
  emptied_count_ += emptied_.size();
  return output_;
}

void Simulator::take_separations(std::span<const RecordedSplit> recorded) {
  world_.step();
  for (const RecordedSplit& split : recorded) {
    if (split.to >= 0) {
      world_.split_at(split.from, split.seeds);
    } else if (!split.seeds.empty()) {
      world_.crumble_at(split.from, split.seeds.front());
    }
  }
  for (const WorldEvent& event : world_.events()) {
    if (event.kind == WorldEvent::Kind::kCrumb) {
      const geometry::VoxelGrid& grid = world_.volume(0).grid();
      const Eigen::Vector3d p_B = grid.centre(event.seed);
      deposits_.push_back({world_.pose(event.piece) * p_B, 0.0, event.amount});
      removed_ += event.amount;
    }
  }
}

void Simulator::change_tool(int by) noexcept {
  const auto count = static_cast<int>(tools_.size());
  if (by != 0 && count > 1) {
    output_.tool = (output_.tool + by + count) % count;
    waits_until_free_ = true;
    shafts_.wait();
    soft_.forget();
    if (second_) {
      second_->leave_tool();
    }
  }
}

HandMode Simulator::mode_of(const SimulatorInput& input) const noexcept {
  if (is_held(input.functions, Function::kCameraMove)) {
    return HandMode::kCameraMove;
  }
  if (is_held(input.functions, Function::kCameraTurn)) {
    return HandMode::kCameraTurn;
  }
  const bool grip = tools_[in_hand()].as<GripTool>() != nullptr && input.power > 0.0;
  return grip || is_held(input.functions, Function::kCarry) ? HandMode::kCarry : HandMode::kTool;
}

void Simulator::steer(const SimulatorInput& input) noexcept {
  const Camera before = camera_;
  const int zoom = (is_held(input.functions, Function::kZoomIn) ? 1 : 0) -
                   (is_held(input.functions, Function::kZoomOut) ? 1 : 0);
  if (zoom != 0) {
    const double factor = std::exp(zoom * camera_parameters_.zoom_rate * input.dt);
    camera_ = zoomed(camera_, factor, camera_parameters_);
  }
  if (hand_known_ && output_.mode == HandMode::kCameraMove) {
    const Eigen::Vector3d motion = input.tool.tip.position - hand_;
    camera_ = moved(camera_, camera_parameters_.move_gain * motion);
  }
  if (hand_known_ && output_.mode == HandMode::kCameraTurn) {
    const Eigen::Vector3d angles = camera_parameters_.turn_gain * (input.tool.tip.position - hand_);
    camera_ = turned(camera_, angles.x(), angles.y());
  }
  output_.camera_changed = !(camera_ == before);
}

void Simulator::carry(const SimulatorInput& input) noexcept {
  if (output_.mode != HandMode::kCarry) {
    if (world_.held() >= 0) {
      output_.moved = world_.held_group();
      output_.let_go = true;
      world_.release();
    }
    return;
  }
  const Eigen::Isometry3d pose = pose_of(input.tool);
  if (world_.held() < 0) {
    const ToolSpec& tool = tools_[in_hand()];
    const auto* burr = tool.as<BurrTool>();
    const auto* grip = tool.as<GripTool>();
    const double other = grip != nullptr ? grip->reach : GripTool{}.reach;
    const double reach = burr != nullptr ? burr->burr.diameter : other;
    const auto touched = world_.touch(input.tool.tip.position, reach);
    if (touched && !world_.is_fixed(touched->piece)) {
      world_.grab(*touched, pose);
      carried_.begin(pose);
    }
  } else {
    const HeldBone::HeldStep followed = carried_.follow(world_, pose, input.dt);
    world_.drag(followed.tool);
    output_.force = followed.force;
    output_.immersed = followed.touching;
    output_.contact = followed.touching > 0;
    output_.moved = world_.held_group();
  }
}

void Simulator::work(const SimulatorInput& input, std::uint32_t pressed) noexcept {
  const bool apply = is_held(pressed, Function::kApply);
  const ToolSpec& tool = tools_[in_hand()];
  if (const auto* burr = tool.as<BurrTool>()) {
    constexpr double kTurnsShown = 1.0 / 617.0;  // a tick: no screen keeps step with it
    const double turning = is_saw(*burr) ? 0.0 : handpiece_.turning(input.power);
    shown_turn_ += kTurnsShown * (burr->burr.clockwise ? -23.0 : 23.0) * turning;
    shown_turn_ -= std::floor(shown_turn_);
    drill(*burr, input);
    output_.shaft = shafts_.force(output_.tool, world_, input.tool);
    yield(drills_[in_hand()]->burr().shape().balls(), input);
  } else if (const auto* tube = tool.as<SuctionTool>()) {
    output_.power = input.power;
    const BurrShape::Ball end{0.0, tube->radius};
    yield({&end, 1}, input);
  } else if (tool.as<ProbeTool>() != nullptr) {
    output_.power = input.power;
  } else if (const auto* driver = tool.as<ScrewTool>()) {
    output_.power = input.power;
    screws_.drive(world_, plates_, *driver, output_.tool, input.tool, input.power, input.dt);
  } else if (tool.as<PlateTool>() != nullptr) {
    hold_plate(input, apply);
  } else if (const auto* plane = tool.as<CutPlane>(); plane != nullptr && apply) {
    begin_cut(*plane, input);
  }
  if (is_held(pressed, Function::kDetach)) {
    for (int plate = world_.plates() - 1; plate >= 0; --plate) {
      if (world_.plate_is_on(plate)) {
        world_.detach_plate(plate);
        screws_.take_out(plate);
        output_.detached = plate;
        break;
      }
    }
  }
}

void Simulator::work_second(const SimulatorInput& input) noexcept {
  if (!second_) {
    return;
  }
  output_.tube = second_->tick(world_, soft_, input.tube, transition_);
  if (output_.tube.tore) {
    const Eigen::Isometry3d& pose = world_.pose(0);
    empty_soft(pose.inverse(Eigen::Isometry) * input.tube.tool.tip.position, tube()->radius);
  }
  meet(input);
}

void Simulator::warm_up(const SimulatorInput& input) noexcept {
  if (!heat_) {
    return;
  }
  const auto* burr = tools_[in_hand()].as<BurrTool>();
  const bool turns = burr != nullptr && output_.mode == HandMode::kTool;
  const bool rinsed = second_ && second_->rinses(input.tube, input.tool.tip.position);
  const Rubbing rubbing =
      turns ? rubbing_of(*burr, output_.force, output_.drag, input.tool.axis()) : Rubbing{0.0, 0.0};
  heat_->tick(rubbing.force, rubbing.radius, turns ? input.power : 0.0, rinsed, input.dt);
}

/// Vessels bleed that lost a voxel on this tick, or were torn.
void Simulator::bleed(double dt) noexcept {
  if (bleeding_.empty()) {
    return;
  }
  for (const EmptiedIn& gone : emptied_) {
    if (bleeding_.bleeds(gone.label)) {
      const geometry::VoxelGrid& grid = world_.volume(0).grid();
      bleeding_.open(gone.label, grid.centre(gone.voxel));
    }
  }
  for (const Tear& tear : soft_.tears()) {
    bleeding_.open(tear.label, tear.place_B);
  }
  bleeding_.tick(world_.pose(0), dt);
}

/// The tick goes on with it.
void Simulator::begin_cut(CutPlane plane, const SimulatorInput& input) noexcept {
  plane.pose_WC = pose_of(input.tool);
  cutter_.begin(world_, plane);
  cut_of_present_ = 0.0;
}

/// Whatever is in hand by now.
void Simulator::go_on_cutting() noexcept {
  cutter_.step(world_);
  output_.cut = cutter_.removed().amount - cut_of_present_;
  cut_of_present_ = cutter_.removed().amount;
  emptied_.insert(emptied_.end(), cutter_.emptied().begin(), cutter_.emptied().end());
}

void Simulator::hold_plate(const SimulatorInput& input, bool fixes) noexcept {
  const PlateModel& plate = *plates_[in_hand()];
  const Eigen::Isometry3d pose = pose_of(input.tool);
  const PlateContact contact = press(plate, pose, world_);
  output_.contact = contact.touching > 0;
  output_.immersed = contact.touching;
  if (!output_.contact) {
    waits_until_free_ = false;
  }
  if (!waits_until_free_) {
    output_.force = contact.force;
  }
  if (fixes) {
    attach(plate, output_.tool, pose, world_);
  }
}

void Simulator::place_for_dust(const SimulatorInput& input) noexcept {
  const ToolSpec& tool = tools_[in_hand()];
  dust_tools_ = {};
  if (second_) {
    second_->place(input.tube, dust_tools_.tools[2], dust_tools_.water);
  }
  if (output_.mode != HandMode::kTool) {
    return;
  }
  const Eigen::Vector3d axis = input.tool.axis();
  const auto& tip = input.tool.tip.position;
  if (const auto* burr = tool.as<BurrTool>()) {
    const std::span<const BurrShape::Ball> balls = drills_[in_hand()]->burr().shape().balls();
    const double radius = burr->radius();
    const double top = drills_[in_hand()]->burr().shape().half_length();
    const double low = balls.front().z;
    dust_tools_.tools[0] = {tip + low * axis, axis,  balls.back().z - low,
                            radius,           false, output_.power > 0.0};
    const double thin = std::min(radius, burr->shaft ? burr->shaft->radius : tool.handle_radius);
    dust_tools_.tools[1] = {tip + top * axis, axis, tool.handle_length, thin, false};
  } else if (const auto* suction = tool.as<SuctionTool>()) {
    dust_tools_.tools[0] = {tip, axis, tool.handle_length, suction->radius, output_.power > 0.0};
  }
}

const BurrShape* Simulator::burr_shape() const noexcept {
  const Drill* drill = drills_[in_hand()].get();
  return drill != nullptr ? &drill->burr().shape() : nullptr;
}

std::span<const BurrShape::Ball> Simulator::burr_balls() const noexcept {
  const BurrShape* shape = burr_shape();
  return shape != nullptr ? shape->balls() : std::span<const BurrShape::Ball>{};
}

int Simulator::pieces() const noexcept {
  int born = 1;
  for (int piece = 1; piece < world_.pieces(); ++piece) {
    born += world_.is_born(piece) ? 1 : 0;
  }
  return born;
}

double Simulator::amount_left() const noexcept {
  double amount = 0.0;
  for (int piece = 0; piece < world_.pieces(); ++piece) {
    amount += world_.volume(piece).amount();
  }
  return amount;
}

std::uint64_t Simulator::checksum() const noexcept {
  std::uint64_t sum = 0;
  for (int piece = 0; piece < world_.pieces(); ++piece) {
    const BoneVolume& volume = world_.volume(piece);
    const auto known = static_cast<std::uint64_t>(world_.known_as(piece));
    for (std::int32_t address = BoneVolume::kBrickVoxels;
         address < volume.bricks() * BoneVolume::kBrickVoxels; ++address) {
      const float density = volume.density(address);
      if (density > 0.0F) {
        const Voxel voxel = volume.voxel_at(address);
        const std::uint64_t index = volume.grid().index(voxel);
        sum += mixed(mixed(index * kMaxPieces + known) ^ std::bit_cast<std::uint32_t>(density));
      }
    }
  }
  return sum;
}

}  // namespace haptrial::bone
