#include "protocols/force_training/path_drawing.h"

#include <utility>

#include "core/render/flat/trial_display.h"
#include "core/stimulus/presentation.h"

namespace haptrial::protocols {
namespace {

class PathDrawing final : public Drawing {
 public:
  PathDrawing(const render::Gl& gl, const render::TrialDisplayStyle& style, int width, int height,
              const std::vector<Eigen::Vector3d>& points)
      : display_(gl, style, width, height) {
    display_.set_trajectory(points);
  }
  void draw(const stimulus::Shown& shown) override {
    display_.draw(stimulus::presentation_of(shown));
  }
  std::optional<Eigen::Vector3d> to_world(const Eigen::Vector2d& pixel) const override {
    return display_.to_world(pixel);
  }

 private:
  render::TrialDisplay display_;
};

}  // namespace

MakeDrawing path_drawing(const render::TrialDisplayStyle& style,
                         std::vector<Eigen::Vector3d> points) {
  return [style, points = std::move(points)](const render::Gl& gl, int width, int height) {
    return std::make_unique<PathDrawing>(gl, style, width, height, points);
  };
}

}  // namespace haptrial::protocols
