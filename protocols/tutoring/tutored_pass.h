#pragma once

#include "core/realtime/block_log.h"
#include "core/record/rows/tutoring_row.h"
#include "protocols/definition/tutoring_options.h"
#include "protocols/interface/pass.h"
#include "protocols/tutoring/model_motion.h"

namespace haptrial::protocols {

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
