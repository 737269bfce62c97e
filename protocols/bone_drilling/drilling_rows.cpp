#include "protocols/bone_drilling/drilling_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace haptrial::protocols {
namespace {

constexpr std::uint64_t kBetweenCameraRows = 10;  // ticks at least, while the view moves

std::array<std::int32_t, 3> indices(const bone::Voxel& voxel) noexcept {
  return {voxel.x(), voxel.y(), voxel.z()};
}

constexpr int kBetweenPieceRows = 100;  // ticks, while a hand carries a piece

}  // namespace

/// The bone itself lies as it did at the beginning.
record::PieceRow piece_row(const bone::Simulator& simulator, std::uint64_t sequence, int piece,
                           std::int64_t voxels) noexcept {
  const bone::BoneWorld& world = simulator.world();
  const Eigen::Isometry3d motion = world.pose(piece) * world.pose(0).inverse(Eigen::Isometry);
  const Eigen::AngleAxisd turn(motion.linear());
  record::PieceRow row;
  row.sequence = sequence;
  row.piece = piece;
  row.voxels = voxels;
  row.shift = motion.translation();
  row.turn = turn.angle() * turn.axis();
  return row;
}

void DrillingLogs::record(std::uint64_t sequence, const Readings& readings,
                          device::Fault /*fault*/) noexcept {
  record::ToolRow row = std::exchange(row_, record::ToolRow{});
  row.sequence = sequence;
  row.orientation = readings[0].orientation;
  row.buttons = readings[0].buttons;
  row.keys = readings[0].keys;
  row.pedal = readings[0].pedal;
  tool.push(row);
  if (two_hands_) {
    record::SecondHandRow other = std::exchange(second_row_, record::SecondHandRow{});
    other.sequence = sequence;
    other.orientation = readings.size() > 1 ? readings[1].orientation : other.orientation;
    second.push(other);
  }
  if (watches_handpiece_) {
    record::HandpieceRow held = std::exchange(handpiece_row_, record::HandpieceRow{});
    held.sequence = sequence;
    handpiece.push(held);
  }
  if (watches_tool_contact_) {
    record::ToolContactRow contact = std::exchange(tool_contact_, record::ToolContactRow{});
    contact.sequence = sequence;
    tool_contact.push(contact);
  }
  if (beside_ != nullptr) {
    nerve::NerveTick tick = std::exchange(nerves_, nerve::NerveTick{});
    tick.sequence = sequence;
    beside_->after_tick(tick);
  }
}

void DrillingRows::log(std::uint64_t sequence, double speed) noexcept {
  const bone::SimulatorOutput& out = simulator_.output();
  const double force = out.force.norm();
  for (const bone::EmptiedIn& gone : simulator_.emptied()) {
    record::RemovalRow row;
    row.sequence = sequence;
    row.piece = gone.piece;
    row.voxel = indices(gone.voxel);
    row.label = gone.label;
    row.cut = gone.by_cut;
    row.force = gone.by_cut ? 0.0 : force;
    row.speed = speed;
    logs_.removals.push(row);
  }
  for (const bone::Tear& tear : simulator_.tears()) {
    logs_.tears.push({sequence, tear.label, tear.by_second ? record::kSecondHand : out.tool,
                      tear.by_suction, tear.force, tear.depth, tear.place_B});
  }
  for (const bone::Opening& opening : simulator_.bleeding().begun()) {
    logs_.openings.push({sequence, opening.label, opening.place_B});
  }
  for (const bone::WorldEvent& event : simulator_.separations()) {
    using Kind = bone::WorldEvent::Kind;
    if (event.kind == Kind::kBorn) {
      for (const bone::Voxel& seed : simulator_.world().seeds(event.piece)) {
        logs_.splits.push({sequence, event.parent, event.piece, indices(seed)});
      }
    } else if (event.kind == Kind::kCrumb) {
      logs_.splits.push({sequence, event.piece, -1, indices(event.seed)});
    }
  }
}

void DrillingRows::log_camera(std::uint64_t sequence, bool changed) noexcept {
  camera_due_ = camera_due_ || changed;
  const bool at_rest = !changed;
  const bool first = std::exchange(first_, false);
  if (!camera_due_ || !(first || at_rest || sequence - camera_logged_ >= kBetweenCameraRows)) {
    return;
  }
  const Camera& camera = simulator_.camera();
  record::CameraRow row;
  row.sequence = sequence;
  row.time_ns = std::llround(static_cast<double>(sequence) * 1e9 / rate_);
  row.eye = camera.eye;
  row.target = camera.target;
  row.up = camera.up;
  row.field_of_view = camera.field_of_view;
  logs_.camera.push(row);
  camera_logged_ = sequence;
  camera_due_ = false;
}

void DrillingRows::log_pieces(std::uint64_t sequence) noexcept {
  if (!logs_.watches_pieces()) {
    return;
  }
  const bone::SimulatorOutput& out = simulator_.output();
  for (const bone::WorldEvent& event : simulator_.separations()) {
    if (event.kind == bone::WorldEvent::Kind::kBorn) {
      logs_.pieces.push(piece_row(simulator_, sequence, event.piece, event.voxels));
    }
  }
  const bool due = out.let_go || (out.moved != 0 && carried_for_++ % kBetweenPieceRows == 0);
  carried_for_ = out.let_go || out.moved == 0 ? 0 : carried_for_;
  for (int piece = 0; due && piece < simulator_.world().pieces(); ++piece) {
    if (((out.moved >> piece) & 1U) != 0 && simulator_.world().is_born(piece)) {
      logs_.pieces.push(piece_row(simulator_, sequence, piece, 0));
    }
  }
  const bone::Screws& screws = simulator_.screws();
  const auto log_screw = [&](const bone::Screw& screw) {
    const bone::ScrewPlace& at = screw.place;
    logs_.screws.push({sequence, at.tool, at.plate, at.hole, screw.piece, screw.depth,
                       screw.purchase, screw.torque});
  };
  if (const bone::Screw* ended = screws.ended()) {
    log_screw(*ended);
  }
  for (int number = 0; out.detached >= 0 && number < screws.count(); ++number) {
    if (screws.place(number).plate == out.detached) {
      log_screw(screws.screw(number));
    }
  }
}

void DrillingRows::log_tool(double removed, const Eigen::Vector3d& contact) noexcept {
  const bone::SimulatorOutput& out = simulator_.output();
  record::ToolRow tool;
  tool.tool = out.tool;
  tool.mode = static_cast<std::uint8_t>(out.mode);
  tool.active = true;
  tool.power = out.power > 0.0;
  tool.piece = simulator_.world().held();
  tool.immersed = out.immersed;
  tool.removed = removed;
  tool.contact = contact;
  logs_.set_tool(tool);
}

void DrillingRows::log_handpiece(const Eigen::Vector3d& shaft) noexcept {
  const bone::SimulatorOutput& out = simulator_.output();
  record::HandpieceRow row;
  row.reversed = simulator_.handpiece().reversed();
  row.sharpness = simulator_.handpiece().sharpness(out.tool);
  row.shaft = shaft;
  row.tube_shaft = out.tube.shaft;
  logs_.set_handpiece(row);
}

void DrillingRows::log_second(const bone::TubeInput& tube) noexcept {
  const bone::TubeOutput& out = simulator_.output().tube;
  record::SecondHandRow row;
  row.sucks = tube.sucks;
  row.rinses = tube.rinses;
  row.immersed = out.immersed;
  row.contact = out.force;
  logs_.set_second(row);
  logs_.set_tool_contact(simulator_.output().pushed);
}

namespace {

/// Adds the balls that fill a burr that is no ball.
void add_balls(const bone::Simulator& simulator, const Eigen::Isometry3d& X_WB,
               const ToolState& tool, nerve::ToolAtNerves& at) noexcept {
  const std::span<const bone::BurrShape::Ball> balls = simulator.burr_balls();
  if (balls.size() < 2) {
    return;
  }
  const Eigen::Vector3d axis_B = X_WB.linear().transpose() * tool.axis();
  for (const bone::BurrShape::Ball& ball : balls.first(std::min(balls.size(), at.more.size()))) {
    at.more[at.balls++] = {at.tip_B + ball.z * axis_B, ball.radius};
  }
  at.radius = balls[balls.size() / 2].radius;
}

}  // namespace

void tell_hints(hint::HintsBeside& hints, std::uint64_t sequence, const bone::Simulator& simulator,
                const bone::SimulatorInput& input) noexcept {
  using What = hint::HintVoxel::What;
  const double force = simulator.output().force.norm();
  const double speed = input.tool.tip.velocity.norm();
  for (const bone::WorldEvent& event : simulator.separations()) {
    if (event.kind == bone::WorldEvent::Kind::kCrumb) {
      hints.voxel({sequence, What::kCrumb, event.seed, 0.0, 0.0});
    }
  }
  for (const bone::EmptiedIn& gone : simulator.emptied()) {
    const What what = gone.by_cut ? What::kCut : What::kRemoved;
    hints.voxel({sequence, what, gone.voxel, force, speed});
  }
  const auto* burr = simulator.tool().as<bone::BurrTool>();
  const bone::BurrShape* shape = simulator.burr_shape();
  hints.after_tick({sequence,
                    {input.tool.tip.position, burr != nullptr ? burr->radius() : 0.0,
                     shape != nullptr && !shape->is_ball() ? shape : nullptr,
                     input.tool.axis().cast<float>().cast<double>()},  // as the analysis has it
                    simulator.camera().eye});
}

nerve::ToolAtNerves tool_at_nerves(const bone::Simulator& simulator,
                                   const bone::SimulatorInput& input) noexcept {
  using Kind = nerve::ToolAtNerves::Kind;
  const bone::SimulatorOutput& out = simulator.output();
  const bone::ToolSpec& tool = simulator.tool();
  nerve::ToolAtNerves at;
  if (out.mode != bone::HandMode::kTool) {
    return at;
  }
  if (const auto* burr = tool.as<bone::BurrTool>()) {
    at.kind = Kind::kBurr;
    at.radius = burr->radius();
  } else if (const auto* suction = tool.as<bone::SuctionTool>()) {
    at.kind = Kind::kSuction;
    at.radius = suction->radius;
  } else if (const auto* probe = tool.as<bone::ProbeTool>()) {
    at.kind = Kind::kProbe;
    at.radius = probe->radius;
  }
  const Eigen::Isometry3d& X_WB = simulator.world().pose(0);
  at.tip_B = X_WB.inverse(Eigen::Isometry) * input.tool.tip.position;
  add_balls(simulator, X_WB, input.tool, at);
  at.speed = input.tool.tip.velocity.norm();
  at.force = out.force.norm();
  at.power = out.power;
  return at;
}

}  // namespace haptrial::protocols
