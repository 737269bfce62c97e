#include "protocols/bone_drilling/display/placement_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/bone/data/ear_side.h"
#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"

namespace haptrial::protocols {

PlacedBone placed_bone(const BoneDefinition& d, std::size_t bone) {
  PlacedBone placed{d.bones[bone],   d.placement,      d.mirror, d.simulator.camera.start,
                    d.display.width, d.display.height, {},       {},
                    smallest_burr(d)};
  if (d.cavity) {
    placed.beside = d.cavity->beside;
  }
  if (!d.charts.empty()) {
    placed.cavity = d.charts[bone];
  }
  return placed;
}

namespace {

constexpr double kFirstRow = 5.0;                        // of names, from the top [em]
constexpr double kBar = 0.010;                           // the scale's bar [m]
const render::Colour kInk{0.96, 0.96, 0.96};             // of words and arrows
const render::Colour kWordPlate{0.05, 0.06, 0.08, 0.7};  // under words

/// Pixel at which a point is seen [px].
Eigen::Vector2d pixel_of(const Camera& camera, const Eigen::Vector3d& p_W, int width, int height) {
  const Eigen::Vector3d p = camera.pose().inverse() * p_W;
  const double scale = 0.5 * height / std::tan(0.5 * camera.field_of_view) / -p.z();
  return {0.5 * width + scale * p.x(), 0.5 * height - scale * p.y()};
}

template <class Visit>
void each_voxel(const bone::BoneModel& model, Visit&& visit) {
  geometry::visit_voxels(model.grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (model.labels[at] != 0) {
      visit(model.grid.centre(voxel), at);
    }
  });
}

/// Voxel of each label that is nearest to the middle of all of its voxels; none if it has no voxel.
std::vector<std::optional<Eigen::Vector3d>> middles_in(const bone::BoneModel& model) {
  const std::size_t labels = model.structures.size();
  std::vector<Eigen::Vector3d> sums(labels, Eigen::Vector3d::Zero());
  std::vector<double> counts(labels, 0.0);
  each_voxel(model, [&](const Eigen::Vector3d& p, std::size_t at) {
    sums[model.labels[at]] += p;
    counts[model.labels[at]] += 1.0;
  });
  std::vector<std::optional<Eigen::Vector3d>> middles(labels);
  std::vector<double> nearest(labels, std::numeric_limits<double>::infinity());
  each_voxel(model, [&](const Eigen::Vector3d& p, std::size_t at) {
    const std::uint8_t label = model.labels[at];
    const double distance = (p - sums[label] / counts[label]).squaredNorm();
    if (distance < nearest[label]) {
      nearest[label] = distance;
      middles[label] = p;
    }
  });
  return middles;
}

/// Whether two segments cross.
bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& d) {
  const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                       const Eigen::Vector2d& r) {
    const Eigen::Vector2d along = q - p;
    const Eigen::Vector2d to = r - p;
    return along.x() * to.y() - along.y() * to.x();
  };
  return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

/// Words and lines over a picture.
class Legend {
 public:
  Legend(const render::Gl& gl, const PlacedBone& bone)
      : bone_(bone),
        width_(bone.width),
        height_(bone.height),
        painter_(gl, width_, height_),
        text_(gl, width_, height_) {
    constexpr double kLines = 40.0;  // of text in a picture's height
    style_ = {std::max(9, static_cast<int>(height_ / kLines)), false, kInk};
  }
  void draw() {
    std::vector<PlacedStructure> all = placed_structures(bone_);
    std::ranges::stable_sort(all, {}, [](const auto& one) { return one.pixel.x(); });
    const auto half = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::vector<PlacedStructure> left(all.begin(), half);
    std::vector<PlacedStructure> right(half, all.end());
    names(left, true);
    names(right, false);
    words();
    axes();
    scale();
  }

 private:
  double row() const { return 1.5 * style_.size; }

  void plate(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    painter_.fill({low, high}, 0.25 * style_.size, kWordPlate);
  }

  static std::string name_of(const PlacedStructure& one) {
    return one.in_sight ? one.name : one.name + " (out of sight)";
  }
  double wide(const PlacedStructure& one) {
    return text_.width_of(name_of(one), style_) + 2.0 * style_.size;
  }
  /// Where the line of a name in a row of a column begins [px].
  Eigen::Vector2d line_from(const PlacedStructure& one, std::size_t in_row, bool left) {
    const double across = 0.5 * style_.size + wide(one);
    return {left ? across : width_ - across,
            kFirstRow * style_.size + (static_cast<double>(in_row) + 0.5) * row()};
  }

  /// Swaps names whose lines cross. Each swap makes the two lines shorter together, so that it
  /// ends; names differ in width, so that it is also ended.
  void uncross(std::vector<PlacedStructure>& column, bool left) {
    bool swapped = true;
    for (std::size_t round = 0; swapped && round < column.size(); ++round) {
      swapped = false;
      for (std::size_t a = 0; a < column.size(); ++a) {
        for (std::size_t b = a + 1; b < column.size(); ++b) {
          if (column[a].in_sight && column[b].in_sight &&
              cross(line_from(column[a], a, left), column[a].pixel, line_from(column[b], b, left),
                    column[b].pixel)) {
            std::swap(column[a], column[b]);
            swapped = true;
          }
        }
      }
    }
  }

  /// Names in a column at one side, from top to bottom as they are seen.
  void names(std::vector<PlacedStructure>& column, bool left) {
    std::ranges::stable_sort(column, {}, [](const auto& one) { return one.pixel.y(); });
    uncross(column, left);
    const double em = style_.size;
    double y = kFirstRow * em;
    for (std::size_t in_row = 0; in_row < column.size(); ++in_row) {
      const PlacedStructure& one = column[in_row];
      const std::string name = name_of(one);
      const double wide = this->wide(one);
      const double x = left ? 0.5 * em : width_ - 0.5 * em - wide;
      painter_.begin_over();
      if (one.in_sight) {
        painter_.line(line_from(one, in_row, left), one.pixel, 1.2, render::with_alpha(kInk, 0.6));
        painter_.disc(one.pixel, 0.25 * em, kInk);
        painter_.disc(one.pixel, 0.17 * em, one.colour);
      }
      plate({x, y}, {x + wide, y + row() - 2.0});
      painter_.disc({x + 0.8 * em, y + 0.5 * row() - 1.0}, 0.4 * em, one.colour);
      painter_.end();
      line(name, {x + 1.6 * em, y + row() - 0.55 * em});
      y += row();
    }
  }

  void line(const std::string& words, const Eigen::Vector2d& anchor,
            render::Align align = render::Align::kLeft) {
    text_.begin();
    text_.line(words, anchor, style_, align);
    text_.end();
  }

  void words() {
    const double em = style_.size;
    const std::string side = placement_words(bone_);
    std::string asked;
    if (bone_.cavity) {
      asked = fmt::format("red: the cavity that is asked for, beside the {}", bone_.beside);
    }
    painter_.begin_over();
    plate({0.0, 0.0}, {static_cast<double>(width_), 3.2 * em});
    painter_.end();
    line(bone_.model->name, {em, 1.3 * em});
    line(asked, {width_ - em, 1.3 * em}, render::Align::kRight);
    line(side, {em, 2.7 * em});
  }

  /// Arrows of the bone's axes: those of the patient.
  void axes() {
    const double em = style_.size;
    const Eigen::Vector2d from(6.0 * em, height_ - 5.0 * em);
    const Eigen::Matrix3d to_picture = bone_.camera.axes().transpose() * bone_.placement.turn;
    const std::array<std::pair<Eigen::Vector3d, const char*>, 3> arrows{
        {{-Eigen::Vector3d::UnitX(), "right"},
         {Eigen::Vector3d::UnitY(), "back"},
         {Eigen::Vector3d::UnitZ(), "up"}}};
    painter_.begin_over();
    plate({0.5 * em, height_ - 9.5 * em}, {12.0 * em, height_ - 0.5 * em});
    painter_.end();
    std::array<Eigen::Vector2d, 3> along, words;
    for (std::size_t i = 0; i < arrows.size(); ++i) {
      const Eigen::Vector3d seen = to_picture * arrows[i].first;
      along[i] = {seen.x(), -seen.y()};
      const Eigen::Vector2d to = from + 3.0 * em * along[i];
      painter_.begin_over();
      painter_.line(from, to, 2.0, kInk);
      painter_.disc(to, 0.25 * em, kInk);
      painter_.end();
      words[i] = to + Eigen::Vector2d(0.0, 0.35 * em) +
                 (along[i].norm() > 0.2 ? 0.9 * em * along[i].normalized()
                                        : Eigen::Vector2d(0.6 * em, -em));
    }
    set_words_apart(words, 1.1 * em, 3.0 * em);
    for (std::size_t i = 0; i < arrows.size(); ++i) {
      line(arrows[i].second, words[i],
           along[i].x() < -0.3 ? render::Align::kRight : render::Align::kLeft);
    }
  }

  void scale() {
    const double em = style_.size;
    const Camera& camera = bone_.camera;
    const double length =
        kBar * 0.5 * height_ / std::tan(0.5 * camera.field_of_view) / camera.distance();
    const Eigen::Vector2d right(width_ - 1.5 * em, height_ - 1.2 * em);
    const Eigen::Vector2d left = right - Eigen::Vector2d(length, 0.0);
    const std::string words = fmt::format("{:.0f} mm", 1e3 * kBar);
    painter_.begin_over();
    plate({left.x() - em, height_ - 3.4 * em}, {width_ - 0.5 * em, height_ - 0.5 * em});
    painter_.line(left, right, 3.0, kInk);
    painter_.end();
    line(words, {0.5 * (left.x() + right.x()), height_ - 1.9 * em}, render::Align::kCentre);
  }

  const PlacedBone& bone_;
  int width_;
  int height_;
  render::Painter painter_;
  render::TextPainter text_;
  render::TextStyle style_;
};

}  // namespace

void set_words_apart(std::span<Eigen::Vector2d> places, double row, double wide) {
  std::vector<Eigen::Vector2d*> order;
  for (Eigen::Vector2d& place : places) {
    order.push_back(&place);
  }
  std::ranges::stable_sort(order, {}, [](const Eigen::Vector2d* place) { return place->y(); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    for (std::size_t above = 0; above < i; ++above) {
      if (std::abs(order[i]->x() - order[above]->x()) < wide) {
        order[i]->y() = std::max(order[i]->y(), order[above]->y() + row);
      }
    }
  }
}

std::vector<PlacedStructure> placed_structures(const PlacedBone& bone) {
  const bone::BoneModel& model = *bone.model;
  const Eigen::Isometry3d pose = pose_of(bone.placement, model.grid);
  const Camera& camera = bone.camera;
  const auto middles = middles_in(model);
  std::vector<PlacedStructure> placed;
  for (std::size_t label = 1; label < middles.size(); ++label) {
    const bone::Structure& structure = model.structures[label];
    if (!middles[label] || structure.name == bone::kPlainBone) {
      continue;
    }
    const Eigen::Vector3d p_W = pose * *middles[label];
    const Eigen::Vector2d pixel = pixel_of(camera, p_W, bone.width, bone.height);
    const bool before = (p_W - camera.eye).dot(camera.target - camera.eye) > 0.0;
    const bool within =
        (pixel.array() >= 0.0).all() && pixel.x() < bone.width && pixel.y() < bone.height;
    placed.push_back({structure.name,
                      {structure.colour[0], structure.colour[1], structure.colour[2]},
                      pixel,
                      before && within});
  }
  return placed;
}

std::string placement_words(const PlacedBone& bone) {
  const auto side = bone::ear_side(*bone.model);
  std::string words = !side
                          ? "no side is known: inner ear, ear canal and sinus are not all labelled"
                      : *side == bone::EarSide::kLeft ? "a left ear, by its structures"
                                                      : "a right ear, by its structures";
  if (bone.mirrored) {
    words += "; left and right exchanged by mirror = true";
  }
  if (bone.placement.left_ear) {
    words += "; placed as a surgeon sees a left ear";
  }
  return words;
}

void draw_placement_legend(const render::Gl& gl, const PlacedBone& bone) {
  Legend(gl, bone).draw();
}

}  // namespace haptrial::protocols
