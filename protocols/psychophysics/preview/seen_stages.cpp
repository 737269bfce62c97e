#include "protocols/psychophysics/preview/seen_stages.h"

#include <algorithm>

#include "core/render/gl/offscreen.h"
#include "protocols/psychophysics/presentation/trial_drawing.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::protocols {
namespace {

/// The part of a view that its stage or question settles.
TrialView view_of(const StageSight& sight, const TrialsDefinition& d,
                  const PreviewedInterval& interval) {
  TrialView view;
  view.show(sight.marks, sight.objects, sight.hand, sight.interval_number, sight.dots);
  view.tool = interval.start;
  for (std::size_t i = 1; i < d.hands.size(); ++i) {
    const Eigen::Vector3f p = d.hands[i].start.cast<float>();
    view.others[i - 1] = {p.x(), p.y(), p.z()};
  }
  view.other_count = static_cast<std::uint8_t>(d.hands.empty() ? 0 : d.hands.size() - 1);
  return view;
}

class PictureMaker {
 public:
  PictureMaker(const TrialsDefinition& d, const PreviewedTrial& trial, int width)
      : d_(d),
        trial_(trial),
        scale_((d.display.width + width - 1) / width),
        context_(d.display.width, d.display.height),
        drawing_(trial_drawing(d)(context_.gl(), d.display.width, d.display.height)) {}

  std::vector<SeenStage> make() {
    for (std::size_t i = 0; i < trial_.intervals.size(); ++i) {
      for (std::size_t s = 0; s < trial_.intervals[i].stages.size(); ++s) {
        TrialView view = view_of(trial_.intervals[i].sights[s], d_, trial_.intervals[i]);
        view.interval = static_cast<std::uint8_t>(i + 1);
        view.stage = static_cast<std::uint8_t>(s);
        add_stage({i, s}, picture_of(view));
      }
    }
    for (std::size_t q = 0; q < trial_.questions.size(); ++q) {
      TrialView view = view_of(trial_.questions[q].sight, d_, trial_.intervals.back());
      view.question = static_cast<std::uint8_t>(q + 1);
      seen_.push_back({{}, static_cast<int>(q), picture_of(view)});
    }
    return std::move(seen_);
  }

 private:
  render::Image picture_of(const TrialView& view) {
    context_.make_current();
    drawing_->draw(stimulus::Shown(view));
    return render::coarser(context_.read(), scale_);
  }
  void add_stage(const StagePlace& where, render::Image picture) {
    const auto same = std::ranges::find_if(
        seen_, [&](const SeenStage& seen) { return seen.picture.rgb == picture.rgb; });
    if (same == seen_.end()) {
      seen_.push_back({{where}, -1, std::move(picture)});
    } else {
      same->where.push_back(where);
    }
  }

  const TrialsDefinition& d_;
  const PreviewedTrial& trial_;
  int scale_;  // pixels that become one, in each direction
  render::OffscreenContext context_;
  std::unique_ptr<Drawing> drawing_;
  std::vector<SeenStage> seen_;
};

}  // namespace

std::vector<SeenStage> seen_stages(const TrialsDefinition& d, const PreviewedTrial& trial,
                                   int width) {
  return PictureMaker(d, trial, width).make();
}

}  // namespace haptrial::protocols
