#include "protocols/psychophysics/presentation/trial_drawing.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/render/flat/painter.h"
#include "core/render/flat/shaded_surface.h"
#include "core/render/flat/text.h"
#include "core/render/flat/text_screen.h"
#include "protocols/psychophysics/objects/deformable_sight.h"
#include "protocols/psychophysics/presentation/trial_page.h"
#include "protocols/psychophysics/presentation/trial_view.h"

namespace haptrial::protocols {
namespace {

/// The part of the window that one eye, or both, look at.
struct Part {
  int side{0};                                      // -1 left eye, +1 right eye, 0 both
  Eigen::Vector2d middle{Eigen::Vector2d::Zero()};  // [px]
};

class TrialDrawing final : public Drawing, public TextSource {
 public:
  TrialDrawing(const render::Gl& gl, int width, int height, const TrialsDefinition& d,
               std::shared_ptr<const SeenBodies> bodies)
      : d_(d),
        bodies_(std::move(bodies)),
        painter_(gl, width, height),
        surface_(gl, width, height),
        text_(gl, width, height),
        page_(gl, width, height, d.display.background, d.display.marker_colour,
              d.display.target_colour),
        half_(0.5 * width / (d.view.stereo ? 2.0 : 1.0), 0.5 * height),
        scale_(2.0 * half_.x() / d.view.width),
        right_(d.display.mirrored ? -1.0 : 1.0) {
    if (d.view.stereo) {
      parts_ = {{-1, half_}, {1, {3.0 * half_.x(), half_.y()}}};
    } else {
      parts_ = {{0, half_}};
    }
    dots_.resize(parts_.size());
  }

  void draw(const stimulus::Shown& shown) override {
    const TrialView* view = shown.as<TrialView>();
    if (view != nullptr && view->results) {
      page_.draw(text_of(d_, *view).page);
    } else if (view != nullptr && view->question > 0) {
      draw_question(*view);
    } else if (view != nullptr) {
      draw_interval(*view);
    } else {
      painter_.begin(d_.display.background);
      painter_.end();
    }
  }
  PictureText text(const stimulus::Shown& shown) const override {
    const TrialView* view = shown.as<TrialView>();
    return view != nullptr ? text_of(d_, *view) : PictureText{};
  }
  std::optional<Eigen::Vector3d> to_world(const Eigen::Vector2d& pixel) const override {
    const Eigen::Vector2d p = (pixel - parts_.front().middle) / scale_;
    return d_.view.from_above ? Eigen::Vector3d(right_ * p.x(), 0.0, p.y())
                              : Eigen::Vector3d(right_ * p.x(), -p.y(), 0.0);
  }

 private:
  /// Place on the screen from its middle, x to the right and y down [m].
  Eigen::Vector2d on_screen(const Eigen::Vector3d& p) const {
    return {right_ * p.x(), d_.view.from_above ? p.z() : -p.y()};
  }
  Eigen::Vector2d pixel_of(const Eigen::Vector3d& p, const Part& part) const {
    return part.middle + scale_ * on_screen(p);
  }
  static Eigen::Vector3d place_of(const std::array<float, 3>& p) {
    return Eigen::Vector3f(p[0], p[1], p[2]).cast<double>();
  }

  void draw_question(const TrialView& view) {
    const TrialQuestion& question = d_.questions[view.question - 1U];
    if (question.touched() && !view.told()) {
      draw_places(question, view);
    } else {
      page_.draw(text_of(d_, view).page);
    }
  }

  /// The places to touch with their choices, the hand, and above them the question; below them the
  /// choices that are given in another way.
  void draw_places(const TrialQuestion& question, const TrialView& view) {
    painter_.begin(d_.display.background);
    for (const Part& part : parts_) {
      draw_marks(view, part);
    }
    painter_.end();
    text_.begin();
    const double margin = d_.display.margin;
    const render::TextStyle asked{static_cast<int>(0.1 * half_.y()), true,
                                  d_.display.marker_colour};
    const render::TextStyle label{static_cast<int>(0.07 * half_.y()), false,
                                  d_.display.marker_colour};
    for (const Part& part : parts_) {
      const Eigen::Vector2d top{part.middle.x(), margin};
      text_.paragraphs(question.text, top, 2.0 * (half_.x() - margin), asked);
      double y = 2.0 * half_.y() - margin;
      std::size_t mark = 0;
      for (std::size_t i = 0; i < question.choices.size(); ++i) {
        const bool touched = !question.means[i].touch.empty();
        if (touched && mark < view.mark_count) {
          draw_label(question.choices[i], view.marks[mark++], part, label);
        } else if (!touched) {
          text_.line(line_of(question, i), {part.middle.x(), y}, label, render::Align::kCentre);
          y -= text_.line_height(label);
        }
      }
    }
    text_.end();
  }

  /// Draws a label below its place.
  void draw_label(const questions::Choice& choice, const Mark& mark, const Part& part,
                  const render::TextStyle& style) {
    const double below = scale_ * static_cast<double>(mark.radius) + 1.2 * style.size;
    text_.line(choice.label, pixel_of(place_of(mark.place), part) + Eigen::Vector2d(0.0, below),
               style, render::Align::kCentre);
  }

  void draw_interval(const TrialView& view) {
    painter_.begin(d_.display.background);
    if (view.dots.shown) {
      lay_dots(view.dots);
    }
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (view.dots.shown) {
        draw_dots(view.dots, i);
      }
      draw_objects(view, parts_[i]);
      draw_marks(view, parts_[i]);
    }
    painter_.end();
    if (view.number_shown) {
      draw_number(view);
    }
  }

  /// The dots of both eyes, once for each stereogram.
  void lay_dots(const DotsShown& shown) {
    if (laid_ && *laid_ == shown.seed) {
      return;
    }
    laid_ = shown.seed;
    const auto& [x, y, z] = shown.dots.centre;
    const Eigen::Vector2d centre = on_screen({x, y, z});
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      dots_[i] = dots_for_eye(shown.dots, 2.0 * half_ / scale_, centre, d_.view.eyes,
                              parts_[i].side, shown.seed);
    }
  }

  void draw_dots(const DotsShown& shown, std::size_t part) {
    const double radius = 0.5 * scale_ * shown.dots.diameter;
    for (const EyeDot& dot : dots_[part]) {
      const Eigen::Vector2d from_middle = scale_ * dot;
      if (std::abs(from_middle.x()) < half_.x() - radius) {  // none reaches the other eye
        painter_.disc(parts_[part].middle + from_middle, radius, d_.display.marker_colour);
      }
    }
  }

  /// Draws objects as lines, found anew when an object is another one or elsewhere. An object whose
  /// mesh was a file that is not at hand is not drawn.
  void draw_objects(const TrialView& view, const Part& part) {
    constexpr double kLine = 2.0;  // [px]
    const Eigen::Vector3d along =
        d_.view.from_above ? -Eigen::Vector3d::UnitY() : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
      const SeenObject& seen = view.objects[i];
      if (DeformableSight* body = sight_of(seen, i)) {
        draw_body(*body, seen, view.pressed.on(i), part);
        continue;
      }
      if (!(seen == outlined_[i])) {
        outlined_[i] = seen;
        const auto at = static_cast<std::size_t>(seen.object);
        const bool known = seen.object >= 0 && at < d_.objects.size() && d_.objects[at].body;
        outlines_[i] = known ? outline_of(d_.objects[at].body->mesh, seen, along) : Outline{};
      }
      for (const auto& [from, to] : outlines_[i]) {
        painter_.line(pixel_of(from, part), pixel_of(to, part), kLine, d_.display.target_colour);
      }
    }
  }

  /// Null for an object that is seen at rest.
  DeformableSight* sight_of(const SeenObject& seen, std::size_t i) {
    if (seen.body < 0 || !bodies_) {
      return nullptr;
    }
    if (seen.body != sighted_[i] || !sights_[i]) {
      sighted_[i] = seen.body;
      const SeenBody body = bodies_->body(seen.body);
      const TrialObject& object = d_.objects[static_cast<std::size_t>(seen.object)];
      sights_[i] = body ? std::make_unique<DeformableSight>(
                              body, object.file.empty() ? nullptr : object.body)
                        : nullptr;
    }
    return sights_[i].get();
  }

  /// Draws the body's surface, and over it the sides of its cells, so that dents show from the
  /// front, too.
  void draw_body(DeformableSight& body, const SeenObject& seen,
                 std::span<const SeenForces::Force> pressed, const Part& part) {
    constexpr double kThin = 1.0;  // [px]
    constexpr double kPale = 0.3;  // share of the colour in the surface's
    body.update(pressed);
    const Eigen::Quaterniond turn(seen.turn[0], seen.turn[1], seen.turn[2], seen.turn[3]);
    const Eigen::Vector3d centre = place_of(seen.centre);
    pixels_.clear();
    for (const Eigen::Vector3d& vertex : body.vertices()) {
      const Eigen::Vector3d p = centre + turn * vertex;
      const Eigen::Vector2d pixel = pixel_of(p, part);
      const double near = scale_ * (d_.view.from_above ? p.y() : p.z());
      pixels_.emplace_back(Eigen::Vector3d(pixel.x(), pixel.y(), near).cast<float>());
    }
    const render::Colour& line = d_.display.target_colour;
    const render::Colour& back = d_.display.background;
    const auto mixed = [&](double a, double b) { return kPale * a + (1.0 - kPale) * b; };
    painter_.end();
    surface_.draw(
        pixels_, body.triangles(),
        {mixed(line.red, back.red), mixed(line.green, back.green), mixed(line.blue, back.blue)});
    painter_.begin_over();
    for (const deformable::Edge& side : body.grid()) {
      const auto end = [&](std::int32_t v) -> Eigen::Vector2d {
        return pixels_[static_cast<std::size_t>(v)].head<2>().cast<double>();
      };
      painter_.line(end(side[0]), end(side[1]), kThin, line);
    }
  }

  void draw_marks(const TrialView& view, const Part& part) {
    constexpr double kLine = 3.0, kDot = 6.0;  // [px]
    for (std::size_t i = 0; i < view.mark_count; ++i) {
      const Mark& mark = view.marks[i];
      const Eigen::Vector2d centre = pixel_of(place_of(mark.place), part);
      if (mark.radius > 0.0F) {
        painter_.circle(centre, scale_ * static_cast<double>(mark.radius), kLine,
                        d_.display.target_colour);
      } else {
        painter_.disc(centre, kDot, d_.display.target_colour);
      }
    }
    const double radius = scale_ * d_.view.hand_radius;
    if (view.cursor_shown) {
      painter_.disc(pixel_of(place_of(view.cursor), part), radius, d_.display.marker_colour);
    }
    if (!view.hand_shown) {
      return;
    }
    painter_.disc(pixel_of(view.tool, part), radius, d_.display.marker_colour);
    for (std::size_t i = 0; i < view.other_count; ++i) {
      if (!d_.hands[i + 1].is_tip()) {
        continue;  // it is nowhere in the world that is drawn
      }
      painter_.disc(pixel_of(place_of(view.others[i]), part), radius, d_.display.marker_colour);
    }
  }

  void draw_number(const TrialView& view) {
    text_.begin();
    const render::TextStyle style{static_cast<int>(0.12 * 2.0 * half_.y()), true,
                                  d_.display.marker_colour};
    const double margin = d_.display.margin;
    for (const Part& part : parts_) {
      text_.line(fmt::format("{}", view.interval),
                 {part.middle.x() - half_.x() + margin, margin + style.size}, style);
    }
    text_.end();
  }

  const TrialsDefinition& d_;
  std::shared_ptr<const SeenBodies> bodies_;
  render::Painter painter_;
  render::ShadedSurface surface_;
  render::TextPainter text_;
  render::TextScreen page_;
  Eigen::Vector2d half_;  // of a part [px]
  double scale_;          // [px/m]
  double right_;          // x of W on the screen: 1 to the right, -1 to the left
  std::vector<Part> parts_;
  std::vector<std::vector<EyeDot>> dots_;  // (parts)
  std::optional<std::uint64_t> laid_;      // seed of them
  std::array<SeenObject, kMostSeenObjects> outlined_{};
  std::array<Outline, kMostSeenObjects> outlines_{};
  std::array<std::int32_t, kMostSeenObjects> sighted_{-1, -1};  // numbers of the bodies
  std::array<std::unique_ptr<DeformableSight>, kMostSeenObjects> sights_{};
  std::vector<Eigen::Vector3f> pixels_;  // of a body's vertices, and towards the eye [px]
};

}  // namespace

MakeDrawing trial_drawing(const TrialsDefinition& definition,
                          std::shared_ptr<const SeenBodies> bodies) {
  return [&definition, bodies = std::move(bodies)](const render::Gl& gl, int width, int height) {
    return std::make_unique<TrialDrawing>(gl, width, height, definition, bodies);
  };
}

}  // namespace haptrial::protocols
