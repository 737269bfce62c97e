#include "protocols/trials/presentation/trial_drawing.h"

#include <fmt/format.h>

#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"
#include "core/render/flat/text_screen.h"
#include "protocols/trials/presentation/trial_view.h"

namespace haptrial::protocols {
namespace {

/// What is read of a question: its text, and below it how each choice is given.
std::string question_body(const Question& question, const TrialView& view) {
  if (question.types()) {
    return fmt::format("{}_", view.typed.data());
  }
  std::string body;
  for (std::size_t i = 0; i < question.choices.size(); ++i) {
    const Choice& choice = question.choices[i];
    body +=
        fmt::format("{}{}{}", body.empty() ? "" : "\n",
                    choice.hint.empty() ? "" : fmt::format("[{}]  ", choice.hint), choice.label);
  }
  return body;
}

class TrialDrawing final : public Drawing {
 public:
  TrialDrawing(const render::Gl& gl, int width, int height, const TrialsDefinition& d)
      : d_(d),
        painter_(gl, width, height),
        text_(gl, width, height),
        page_(gl, width, height, d.display.background, d.display.marker_colour,
              d.display.target_colour),
        middle_(0.5 * width, 0.5 * height),
        scale_(width / d.view.width) {}

  void draw(const stimulus::Shown& shown) override {
    const TrialView* view = shown.as<TrialView>();
    if (view != nullptr && view->question > 0) {
      draw_question(*view);
    } else if (view != nullptr) {
      draw_interval(*view);
    } else {
      painter_.begin(d_.display.background);
      painter_.end();
    }
  }
  std::optional<Eigen::Vector3d> to_world(const Eigen::Vector2d& pixel) const override {
    const Eigen::Vector2d p = (pixel - middle_) / scale_;
    return d_.view.from_above ? Eigen::Vector3d(p.x(), 0.0, p.y())
                              : Eigen::Vector3d(p.x(), -p.y(), 0.0);
  }

 private:
  Eigen::Vector2d pixel_of(const Eigen::Vector3d& p) const {
    return middle_ + scale_ * (d_.view.from_above ? Eigen::Vector2d(p.x(), p.z())
                                                  : Eigen::Vector2d(p.x(), -p.y()));
  }

  void draw_question(const TrialView& view) {
    const Question& question = d_.questions[view.question - 1U];
    render::TextPage page;
    page.title = question.text;
    page.body = question_body(question, view);
    if (view.verdict != Verdict::kNone) {
      page.title = view.verdict == Verdict::kRight ? d_.feedback_right : d_.feedback_wrong;
      page.body.clear();
    }
    page_.draw(page);
  }

  void draw_interval(const TrialView& view) {
    painter_.begin(d_.display.background);
    constexpr double kLine = 3.0, kDot = 6.0;  // [px]
    for (std::size_t i = 0; i < view.mark_count; ++i) {
      const Mark& mark = view.marks[i];
      const Eigen::Vector2d centre =
          pixel_of(Eigen::Vector3d(mark.place[0], mark.place[1], mark.place[2]));
      if (mark.radius > 0.0F) {
        painter_.circle(centre, scale_ * static_cast<double>(mark.radius), kLine,
                        d_.display.target_colour);
      } else {
        painter_.disc(centre, kDot, d_.display.target_colour);
      }
    }
    if (view.hand_shown) {
      painter_.disc(pixel_of(view.tool), scale_ * d_.view.hand_radius, d_.display.marker_colour);
    }
    painter_.end();
    if (view.number_shown) {
      text_.begin();
      const render::TextStyle style{static_cast<int>(0.12 * 2.0 * middle_.y()), true,
                                    d_.display.marker_colour};
      const double margin = d_.display.margin;
      text_.line(fmt::format("{}", view.interval), {margin, margin + style.size}, style);
      text_.end();
    }
  }

  const TrialsDefinition& d_;
  render::Painter painter_;
  render::TextPainter text_;
  render::TextScreen page_;
  Eigen::Vector2d middle_;  // [px]
  double scale_;            // [px/m]
};

}  // namespace

MakeDrawing trial_drawing(const TrialsDefinition& definition) {
  return [&definition](const render::Gl& gl, int width, int height) {
    return std::make_unique<TrialDrawing>(gl, width, height, definition);
  };
}

}  // namespace haptrial::protocols
