#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"
#include "core/render/flat/trial_display_style.h"

namespace haptrial::render {

/// Forces over the time of a pass, for a picture of it.
struct ForceCurves {
  std::string title;
  std::string remark;           // at the right end of the title's line
  std::vector<double> time;     // (N) rising, from 0 [s]
  std::vector<double> target;   // (N) [N]
  std::vector<double> applied;  // (N) [N]
  double run_begin{0.0};        // the part in which the target counts [s]
  double run_end{0.0};
};

/// Draws target and applied force over time up to an instant, with axes, in the colours of the
/// participant's bars. One thread and context, as Painter.
class ForcePanel {
 public:
  /// @param style  for colours and the force at the top of the axis.
  ForcePanel(const Gl& gl, const TrialDisplayStyle& style, int width, int height);

  /// @throws std::invalid_argument when the columns differ in length or are empty.
  void set_curves(ForceCurves curves);
  /// @param now  curves are drawn up to here [s]
  void draw(double now);

  /// Place of a time [s] and a force [N] in the picture [px].
  Eigen::Vector2d to_pixels(double time, double force) const;

 private:
  void draw_axes();
  void draw_curve(const std::vector<double>& forces, const Colour& colour, std::size_t count);
  void draw_words(std::size_t count);

  TrialDisplayStyle style_;
  int width_;
  int height_;
  Painter painter_;
  TextPainter text_;
  ForceCurves curves_;
  Rectangle plot_;
};

}  // namespace haptrial::render
