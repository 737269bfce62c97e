#include "protocols/force_training/pass_pictures.h"

#include <fmt/format.h>

namespace haptrial::protocols {

FrameCapture::FrameCapture(int frames_per_pass)
    : wanted_(static_cast<std::size_t>(frames_per_pass)) {
  moments_.reserve(wanted_);
}

void FrameCapture::observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept {
  const stimulus::Presentation seen = stimulus::presentation_of(shown);
  const auto count = static_cast<double>(moments_.size());
  const bool runs = seen.progress > 0.0 && seen.progress < 1.0;
  if (runs && moments_.size() < wanted_ &&
      seen.progress >= (count + 0.5) / static_cast<double>(wanted_)) {
    moments_.push_back(seen);
  }
}

std::vector<stimulus::Presentation> FrameCapture::take() {
  std::vector<stimulus::Presentation> taken = moments_;
  moments_.clear();
  return taken;
}

PassPictures::PassPictures(const render::TrialDisplayStyle& style, const SessionPlace& place)
    : place_(place), capture_(place.frames_per_pass) {
  if (place.frames_per_pass > 0) {
    renderer_ = std::make_unique<render::FrameRenderer>(style);
  }
}

void PassPictures::set_trajectory(const std::vector<Eigen::Vector3d>& points) {
  if (renderer_) {
    renderer_->set_trajectory(points);
  }
}

void PassPictures::draw(const PlannedTrial& trial, const record::Phase& phase) {
  int number = 0;
  for (const stimulus::Presentation& moment : capture_.take()) {
    const auto file =
        place_.frames_folder /
        fmt::format("{}-trial{:02}-{}-{:02}.png", place_.subject, trial.trial,
                    phase == record::Phase::kTest ? "test" : trial.condition, ++number);
    render::write_png(file, renderer_->draw(moment));
  }
}

}  // namespace haptrial::protocols
