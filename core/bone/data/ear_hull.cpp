#include <algorithm>

#include "core/bone/data/ear_anatomy.h"

// The outside of a temporal bone, the skull's inside, and the spaces of outer and middle ear.

namespace haptrial::bone {
namespace {

/// Intersection whose edge is rounded over about `width` > 0.
double smooth_intersection(double a, double b, double width) {
  return -smooth_union(-a, -b, width);
}

/// A bound of the distance to an ellipse across y and z, of any depth.
double upright_ellipse(const Point& p, double y, double z, double along_y, double along_z) {
  return ellipsoid({0.0, p.y(), p.z()}, {0.0, y, z}, {along_y, along_y, along_z});
}

/// 1 over the middle of the mastoid, and little over the ossicles and the labyrinth.
double over_mastoid(const Point& p) {
  const double dx = (p.x() - 13.0) / 10.0;
  const double dy = (p.y() - 33.0) / 10.0;
  const double bump = 1.0 + dx * dx + dy * dy;
  return 1.0 / (bump * bump);
}

}  // namespace

double EarAnatomy::sinus(const Point& p) const { return sinus_.distance(p, 6.0); }

/// A gentle bow that leans inwards on its way down, and bends inwards with the vault of the skull
/// towards the top and the front.
double EarAnatomy::outer_side(const Point& p) const {
  const double bow = (p.y() - 26.0) / 26.0;
  const double lean = (48.0 - p.z()) / 20.0;
  const double above = std::max(0.0, p.z() - 38.0) / 20.0;
  const double before = std::max(0.0, 16.0 - p.y()) / 20.0;
  return 0.6 + 1.6 * bow * bow + 2.0 * lean + 4.0 * above * above + 3.0 * before * before - p.x();
}

/// The squama's arch, and the mastoid part down to a tip behind which the border rises.
double EarAnatomy::outline(const Point& p) const {
  const double squama = upright_ellipse(p, 20.5, 27.0, 27.0, 30.5);
  const double rising = 0.822 * (p.y() - 40.0) - 0.569 * p.z();
  const double mastoid =
      smooth_intersection(upright_ellipse(p, 33.0, 20.0, 21.5, 25.0), rising, 5.0);
  return smooth_union(squama, mastoid, 5.0) + 0.4 * noise(v_.noise + 13, p / 2.5);
}

double EarAnatomy::wall(const Point& p) const {
  return 4.2 + 1.6 * std::clamp((34.0 - p.z()) / 12.0, 0.0, 1.5) +
         2.2 * std::clamp((p.y() - 34.0) / 10.0, 0.0, 1.0);
}

/// Higher over the superior canal (arcuate eminence), lower to the front and the side.
double EarAnatomy::tegmen(const Point& p) const {
  const double dx = (p.x() - 31.5) / 5.0;
  const double dy = (p.y() - 25.0) / 5.0;
  const double bump = 1.0 + dx * dx + dy * dy;
  return 31.2 + v_.tegmen + 3.6 / (bump * bump) + 0.26 * std::min(0.0, p.y() - 24.0) -
         0.10 * std::max(0.0, 22.0 - p.x()) + 0.5 * noise(v_.noise + 9, p / 5.0) -
         v_.mastoid_roof * over_mastoid(p);
}

double EarAnatomy::behind(const Point& p) const {
  return -(0.55 * (p.x() - 30.0) + 0.835 * (p.y() - 34.2)) + 0.4 * noise(v_.noise + 11, p / 7.0);
}

double EarAnatomy::fossa_floor(const Point& p) const {
  return 10.0 + 0.3 * std::max(0.0, 40.0 - p.y());
}

EarAnatomy::Surfaces EarAnatomy::surfaces(const Point& p) const {
  const double outer = outer_side(p);
  return {outer, outer + wall(p), outline(p), tegmen(p), behind(p)};
}

double EarAnatomy::hull(const Point& p, const Surfaces& s) const {
  const double uneven = 0.3 * noise(v_.noise + 7, p / 6.0);
  const double outer = s.outer;
  const double squama =
      smooth_intersection(std::max(outer, -outer - wall(p) - 0.8), 22.0 - p.z(), 8.0);
  const Point tip(14.2, 34.6, 5.0 - v_.mastoid_tip);
  const double mastoid = smooth_union(
      smooth_union(round_cone(p, {13.0, 36.0, 24.0}, tip, 12.0, 5.8),
                   round_cone(p, {13.5, 43.0, 25.0}, {13.5, 41.0, 11.0}, 12.0, 7.0), 4.0),
      round_cone(p, {11.0, 50.0, 30.0}, {12.5, 47.0, 11.0}, 11.0, 7.0), 4.0);
  const double border = s.outline;
  double bone = smooth_union(squama, smooth_intersection(mastoid, outer - 0.2, 5.0), 5.0);
  bone = smooth_intersection(bone, border, 3.0);
  const double petrous =
      smooth_intersection(round_cone(p, {20.0, 31.0, 24.5}, {52.0, 16.0, 26.0}, 12.5, 9.0),
                          0.9 * (p.x() - 47.0) - 0.43 * (p.y() - 20.0), 8.0);
  bone = smooth_union(bone, std::max(petrous, outer), 2.5);
  const double roof = s.tegmen - p.z();
  const double front = -s.behind;
  const double floor_of_middle =
      std::max({-roof - 0.8, roof - 2.4, front, outer + 2.5, border, p.x() - 38.0 + 0.6 * p.y()});
  bone = smooth_union(bone, floor_of_middle, 2.0);
  // The tympanic bone around the ear canal, the root of the zygoma, the roof of the jaw joint.
  const double plate = std::max(
      round_cone(p, {6.5, 26.4, 15.8}, kDrum, v_.canal + 2.3, v_.canal + 2.2), kBony - p.x());
  bone = smooth_union(bone, plate, 2.5);
  bone = smooth_union(bone, round_cone(p, {6.5, 21.5, 24.0}, {3.0, 3.0, 21.5}, 3.0, 2.4), 2.5);
  bone = smooth_union(bone, round_cone(p, {3.0, 3.0, 21.5}, {1.0, -6.0, 20.5}, 2.4, 2.0), 1.5);
  const double above_joint =
      std::max({-roof - 0.8, roof - 11.0, front, outer,
                ellipsoid(p, {16.5, 11.0, 19.0}, {14.0, 11.0, 14.0}), 16.0 - p.z()});
  bone = smooth_union(bone, above_joint, 2.0);
  bone = std::max(bone, -ellipsoid(p, {16.5, 10.0, 13.0}, {11.6, 6.8, 7.2}));
  bone = smooth_union(bone, round_cone(p, {25.2, 25.6, 12.0}, {27.8, 19.5, -8.0}, 2.2, 0.9), 1.5);
  // The temporal line above the canal and the spine of Henle behind its upper edge.
  bone = smooth_union(bone, temporal_line_.distance(p), 3.0);
  bone = smooth_union(bone, round_cone(p, {5.4, 31.2, 20.0}, {3.6, 28.8, 21.2}, 1.5, 0.9), 2.0);
  const double low = fossa_floor(p) - p.z();
  bone = smooth_union(
      bone,
      std::max({-low - 0.5, low - 4.0, ellipsoid(p, {16.0, 47.0, 8.0}, {16.0, 12.0, 9.0}),
                13.0 - p.x(), border}),
      2.5);
  bone = std::max(bone, -round_cone(p, {23.0, 31.0, 1.0}, {21.5, 44.0, 6.0}, 2.6, 2.2));
  return bone + uneven;
}

double EarAnatomy::cranium(const Point& p, const Surfaces& s) const {
  const double above = std::max(s.tegmen - p.z(), s.inner);
  const double posterior = std::max({s.behind, fossa_floor(p) - p.z(), s.inner});
  return smooth_union(above, posterior, 2.0);
}

double EarAnatomy::drum(const Point& p) const {
  static const Point inward = Point(0.76, -0.30, 0.55).normalized();
  return (p - kDrum).dot(inward);
}

double EarAnatomy::ear_canal(const Point& p) const {
  const double tube =
      std::min(round_cone(p, kMeatus, {13.0, 24.6, 17.3}, v_.canal + 0.9, v_.canal - 0.3),
               round_cone(p, {13.0, 24.6, 17.3}, kDrum, v_.canal - 0.3, v_.canal));
  return std::max(tube, drum(p));
}

/// The space through which a bare facial nerve is seen from the tympanum.
double EarAnatomy::niche(const Point& p) const {
  constexpr double kFar = 1e3;  // there is none
  return v_.bare_nerve ? round_cone(p, {26.4, 22.2, 25.2}, kBareNerve, 1.4, 1.4) : kFar;
}

double EarAnatomy::middle_ear(const Point& p) const {
  const double tympanum =
      std::max(ellipsoid(p, {26.6, 20.6, 21.6}, {3.0, 4.8, 5.4}), 0.3 - drum(p));
  const double attic = ellipsoid(p, {24.6, 21.2, 26.8}, {2.8, 4.0, 2.7});
  const double antrum = ellipsoid(p, kAntrum, v_.antrum * Point(3.6, 4.4, 3.2));
  const double aditus =
      round_cone(p, {24.0, 23.0, 27.0}, kAntrum, 2.0 * v_.antrum, 2.2 * v_.antrum);
  return std::min({smooth_union(smooth_union(tympanum, attic, 1.0), std::min(antrum, aditus), 1.0),
                   tube_.distance(p), niche(p)});
}

}  // namespace haptrial::bone
