#pragma once

#include <cstdint>
#include <vector>

#include "core/bone/data/ear_anatomy.h"
#include "core/bone/data/shapes.h"

namespace haptrial::bone {

/// Differences from one mandible to the next; lengths in millimetres.
struct JawVariation {
  double scale{1.0};   // of everything
  double spread{0.0};  // of the rami, to each side
  double gonion{0.0};  // the angle, to the back
  double height{0.0};  // of the body, up
  double canal{0.0};   // the nerve in the body, up
  double mental{0.0};  // the mental foramen, to the back
  double cortex{2.2};  // thickness
  bool wisdom{true};   // third molars
  std::uint64_t noise{1};
};
JawVariation jaw_variation(std::uint64_t seed);

/// A mandible as shapes; millimetres, LPS, the middle at x = 0, the chin to the front (y = 0) and
/// the lower border near z = 0. Sizes: docs/algorithms/procedural-bones.md.
class JawAnatomy {
 public:
  static Point low() { return {-68.0, -6.0, -4.0}; }
  static Point high() { return {68.0, 98.0, 76.0}; }

  JawAnatomy(const JawVariation& variation, double least);

  /// Right and left are the same: it only looks at |x|.
  EarAnatomy::Material at(Point p) const;

  const Tube& nerve() const { return nerve_; }

 private:
  struct Tooth {
    Tube crown;
    std::vector<Tube> roots;
  };
  void add_teeth();
  double body(const Point& p) const;
  double ramus(const Point& p) const;
  double tooth(const Point& p) const;

  JawVariation v_;
  std::vector<Tube::TubeNode>
      arch_;  // middle of the body, from the chin to the angle; radius unused
  std::vector<Eigen::Vector2d> outline_;  // of the ramus, (y, z)
  Tube nerve_;
  std::vector<Tooth> teeth_;
};

}  // namespace haptrial::bone
