#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/realtime/block_log.h"
#include "core/record/rows/partner_rows.h"
#include "protocols/definition/tutoring_options.h"
#include "protocols/interface/pass.h"
#include "protocols/interface/trials.h"
#include "protocols/tutoring/model_motion.h"

namespace haptrial::protocols {

/// Trials of any protocol whose first phase is led by what somebody did in a recorded run
/// (haptic playback; source: Morris 2006, §3.4.1): while the pass runs, the tool is held to the
/// tutor's by a spring of low gain, and the tutor's forces are played. What the own pass would give
/// is faded out meanwhile, and comes back at the end of the recording. What the tutor did is
/// recorded in /tutoring, tick by tick.
/// @param definition  the session's, as text: a recording by another one is said in a notice
/// @param led  whether a trial is led, by its number; practice has 0
std::unique_ptr<Trials> tutored(std::unique_ptr<Trials> trials, const TutoringOptions& options,
                                const TutorChoice& tutor, const std::string& definition,
                                std::function<bool(int trial)> led);

using TutoringLog = realtime::BlockLog<record::TutoringRow>;

/// A pass whose first device is led while it runs. It decides alone when it is over.
class TutoredPass final : public Pass {
 public:
  /// All of it outlives the pass.
  TutoredPass(Pass& inner, const TutoringOptions& options, const ModelMotion& motion, double from,
              TutoringLog& log) noexcept;

  void begin(std::uint64_t sequence) noexcept override;
  PassOutput tick(const Readings& readings, double dt) noexcept override;
  std::span<const Drive> others() const noexcept override { return inner_->others(); }
  void note_suspension() noexcept override { inner_->note_suspension(); }
  PassState state() const noexcept override { return inner_->state(); }
  bool names_onsets() const noexcept override { return inner_->names_onsets(); }
  bool wants_attention() noexcept override;

 private:
  void lead(PassOutput& out, const device::DeviceReading& reading) noexcept;

  Pass* inner_;
  const TutoringOptions* options_;
  Playback playback_;
  TutoringLog* log_;
  tutoring::Handover handover_;
  std::uint64_t sequence_{0};
};

}  // namespace haptrial::protocols
