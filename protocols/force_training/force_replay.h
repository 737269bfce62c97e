#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/record/read/session_reader.h"
#include "core/render/flat/force_panel.h"
#include "core/render/flat/trial_display.h"
#include "core/render/gl/offscreen.h"
#include "core/stimulus/stimulus.h"
#include "protocols/force_training/force_definition.h"

namespace haptrial::protocols {

/// A trial of a recorded session, to be seen again: at every instant the picture that the
/// participant saw, with the forces up to then below it. Passes follow one another without the time
/// between them; of a trial that was queued again, the last attempt.
class ForceReplay {
 public:
  static constexpr int kPanelHeight = 240;  // [px]

  /// @param phase  one pass of the trial; nothing: all
  /// @throws InputError where the file holds no such trial, with those that it holds, or where its
  /// definition is not one of this version.
  ForceReplay(const std::filesystem::path& session, int trial, std::optional<record::Phase> phase);

  double duration() const;  // [s]
  /// @param time  since the first pass began; what was last shown then is drawn [s]
  render::Image draw(double time);

  std::size_t passes() const { return passes_.size(); }
  const std::vector<stimulus::Presentation>& seen(std::size_t pass) const;
  /// Picture of the participant's screen at one sample of a pass, without the forces.
  render::Image trial_picture(std::size_t pass, std::size_t sample);
  /// A sentence where this program would draw another stimulus than the session's, so that the
  /// recorded one is shown; else empty.
  const std::string& notice() const { return notice_; }

 private:
  struct Pass {
    record::PassRow row;
    std::vector<double> time;  // since the pass began [s]
    std::vector<stimulus::Presentation> seen;
    std::vector<Eigen::Vector3d> path;
    render::ForceCurves curves;
  };

  Pass read(const record::SessionReader& reader, const record::PassRow& row);
  stimulus::Stimulus stimulus_of(const record::SessionReader& reader, const record::PassRow& row);
  void use(std::size_t pass);

  ForceDefinition definition_;
  std::string notice_;
  std::vector<Pass> passes_;
  std::size_t used_{static_cast<std::size_t>(-1)};  // pass that renderer and panel hold
  render::FrameRenderer renderer_;
  render::OffscreenContext panel_context_;
  render::ForcePanel panel_;
};

}  // namespace haptrial::protocols
