#include "protocols/tutoring/tutored_pass.h"

#include "core/base/longer.h"
#include "core/control/pd_controller.h"

namespace haptrial::protocols {

TutoredPass::TutoredPass(Pass& inner, const TutoringOptions& options, const ModelMotion& motion,
                         double from, TutoringLog& log) noexcept
    : inner_(&inner),
      options_(&options),
      playback_(motion, options.speed, from),
      log_(&log),
      handover_(options.ramp) {}

void TutoredPass::begin(std::uint64_t sequence) noexcept {
  sequence_ = sequence;
  inner_->begin(sequence);
}

bool TutoredPass::wants_attention() noexcept {
  return inner_->wants_attention() || log_->taken() > log_->capacity() / 2;
}

PassOutput TutoredPass::tick(const Readings& readings, double dt) noexcept {
  PassOutput out = inner_->tick(readings, dt);
  const bool runs = out.stage == record::Stage::kRun && !playback_.over();
  playback_.wait(!runs || asks_to_wait(*options_, readings[0]));
  handover_.ask(runs ? 1.0 : 0.0);
  handover_.step(dt);
  if (runs || handover_.share() > 0.0) {
    lead(out, readings[0]);
    playback_.step(dt);
  }
  ++sequence_;
  return out;
}

/// A tutor works on the hand: of his force only the spring has to be passive about his motion.
void TutoredPass::lead(PassOutput& out, const device::DeviceReading& reading) noexcept {
  const PointState& own = reading.tool;
  const tutoring::Partner tutor = playback_.now();
  const double share = handover_.share();
  const tutoring::TutoringGains& gains = options_->gains;
  const Eigen::Vector3d own_force = out.force;
  const Eigen::Vector3d wanted =
      tutoring::tutoring_force(gains, {share, 0.0}, tutor, own, own_force, reading.shares);
  out.force = control::saturate(wanted, options_->most_force);
  out.saturated = out.saturated || longer(wanted, options_->most_force);
  const Eigen::Vector3d stretch = tutor.tool.position - own.position;
  out.intent.push =
      out.force - share * tutoring::coupling_force(gains, tutor.tool, own, reading.shares);
  out.intent.drive = tutor.tool.velocity;
  out.intent.stored =
      0.5 * share * reading.shares.stiffness * gains.stiffness * stretch.squaredNorm();
  out.intent.stimulus = share * gains.force_share * tutor.force;
  log_->push({sequence_, playback_.time(), share, tutor.tool.position, tutor.force,
              out.force - (1.0 - share) * own_force});
}

}  // namespace haptrial::protocols
