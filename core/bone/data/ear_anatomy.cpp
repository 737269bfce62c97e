#include "core/bone/data/ear_anatomy.h"

#include <algorithm>

#include "core/base/random.h"

namespace haptrial::bone {
namespace {

using Beads = std::vector<Tube::TubeNode>;

Beads joined(std::initializer_list<Beads> parts) {
  Beads all;
  for (const Beads& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace

EarVariation ear_variation(std::uint64_t seed) {
  RandomStream random(seed, "temporal bone");
  EarVariation v;
  v.scale = random.uniform(0.94, 1.06);
  v.cells = random.uniform(9.0, 21.0);
  v.cell_fill = random.uniform(0.75, 1.0);
  v.sinus = random.uniform(-2.0, 3.5);
  v.tegmen = random.uniform(-0.8, 1.8);
  v.nerve = random.uniform(-1.0, 1.0);
  v.mastoid_tip = random.uniform(-2.0, 1.5);
  v.canal = random.uniform(3.7, 4.6);
  v.bulb = random.uniform(-2.0, 1.5);
  v.noise = random.bits();
  return v;
}

EarAnatomy::EarAnatomy(const EarVariation& variation, double least)
    : v_(variation), lining_(std::max(0.7, 1.4 * least)), cells_(variation.noise, 2.8, 0.4) {
  add_nerves(least);
  add_ossicles(least);
  add_labyrinth(least);
  add_vessels(least);
}

void EarAnatomy::add_nerves(double least) {
  const double back = v_.nerve;
  const Point genu(25.7, 27.3 + back, 24.6);
  const Point foramen(25.1, 29.2 + back, 12.0);  // stylomastoid
  facial_ = Tube(smooth({{{44.0, 22.6, 29.2}, 0.7},
                         {{33.6, 21.6, 29.0}, 0.6},
                         {{30.9, 18.7, 28.1}, 0.8},  // geniculate ganglion
                         {{28.3, 22.9, 26.5}, 0.7},
                         {genu, 0.8},
                         {{25.4, 28.3 + back, 20.0}, 0.8},
                         {foramen, 0.8},
                         {{24.6, 28.9 + back, 8.0}, 0.8}},
                        8),
                 least);
  parts_.push_back({Anatomy::kFacialNerve, facial_, 1.0});
  const Tube chorda(smooth({{{25.2, 28.6 + back, 16.6}, 0.35},
                            {{24.5, 25.4, 22.6}, 0.35},
                            {{25.5, 21.0, 24.9}, 0.35},
                            {{26.8, 17.5, 23.9}, 0.35},
                            {{28.6, 13.4, 19.5}, 0.35}},
                           6),
                    least);
  parts_.push_back({Anatomy::kChordaTympani, chorda, 0.6});
  const auto straight = [&](Anatomy label, const Point& from, const Point& to, double radius) {
    parts_.push_back({label, Tube({{from, radius}, {to, radius}}, least), 0.6});
  };
  straight(Anatomy::kSuperiorVestibularNerve, {32.2, 23.6, 28.2}, {38.5, 23.9, 29.2}, 0.6);
  straight(Anatomy::kInferiorVestibularNerve, {33.0, 24.2, 26.9}, {38.5, 24.0, 27.4}, 0.6);
  straight(Anatomy::kCochlearNerve, {35.6, 21.2, 26.2}, {38.5, 22.2, 27.4}, 0.7);
}

void EarAnatomy::add_ossicles(double least) {
  // Thinner than nerves may be: a few voxels at half a millimetre are all that they are.
  const double thin = 0.7 * least;
  const auto add = [&](Anatomy label, Beads beads) {
    parts_.push_back({label, Tube(std::move(beads), thin), 0.6});
  };
  add(Anatomy::kMalleus, {{{24.8, 19.6, 27.0}, 1.15},
                          {{24.8, 19.6, 25.4}, 0.6},
                          {{25.2, 19.9, 23.0}, 0.5},
                          {{25.6, 20.3, 21.2}, 0.45}});
  add(Anatomy::kIncus, {{{22.9, 24.8, 26.4}, 0.5},
                        {{24.5, 21.9, 26.8}, 1.2},
                        {{25.4, 22.0, 25.2}, 0.6},
                        {{26.6, 22.3, 23.4}, 0.45}});
  const Point head(27.3, 22.6, 23.6);
  const Point plate(29.6, 23.6, 25.0);
  const Point along(0.25, 0.95, 0.15);
  add(Anatomy::kStapes, {{head, 0.45}, {plate - 1.2 * along, 0.3}});
  add(Anatomy::kStapes, {{head, 0.45}, {plate + 1.2 * along, 0.3}});
  add(Anatomy::kStapes, {{plate - 1.4 * along, 0.35}, {plate + 1.4 * along, 0.35}});
}

void EarAnatomy::add_labyrinth(double least) {
  const Point& v = kVestibule;
  const Point up = Point::UnitZ();
  const Point along_axis = Point(0.7, -0.714, 0.0).normalized();  // of the petrous bone
  const Point across_axis = Point(0.714, 0.7, 0.0).normalized();  // to the back and inwards
  const Point outward = Point(-0.8, 0.6, 0.0).normalized();
  const Point sideways = Point(0.58, 0.77, -0.27).normalized();  // the lateral canal rises forward
  const double tube = 0.65;
  const Beads centre{{v, tube}};
  const Point crus = v + Point(0.9, 1.7, 1.9);
  const auto add = [&](Beads beads) {
    parts_.push_back({Anatomy::kLabyrinth, Tube(std::move(beads), 0.8 * least), 1.4});
  };
  add({{v + Point(0.3, -1.0, -0.3), 1.7}, {v + Point(-0.3, 0.9, 0.3), 1.8}});
  // Superior canal: its plane is square to the petrous axis; radius 3.2 mm.
  add(joined({centre,
              arc(v + Point(-0.2, 0.2, 3.0), across_axis, up, 3.2, 215.0, -35.0, tube, 14),
              {{crus, 0.8}},
              centre}));
  // Posterior canal: along the back of the petrous bone; radius 3.1 mm.
  add(joined({centre,
              {{crus, 0.8}},
              arc(v + Point(-0.8, 4.0, -0.2), -along_axis, up, 3.0, 130.0, -130.0, tube, 14),
              centre}));
  // Lateral canal: radius 2.3 mm.
  add(joined({centre,
              arc(v + Point(-2.5, 1.8, 0.6), outward, sideways, 2.3, -135.0, 135.0, tube, 12),
              centre}));
  // Cochlea: two and a half turns about an axis that points forward, outward and down.
  const Point apex = Point(-0.45, -0.85, -0.25).normalized();
  const Point right = (up - up.dot(apex) * apex).normalized();
  const Point left = apex.cross(right);
  Beads spiral{{v + Point(0.6, -1.2, -0.8), 1.1}};
  constexpr int kSteps = 45;
  for (int step = 0; step <= kSteps; ++step) {
    const double share = static_cast<double>(step) / kSteps;
    const Rotation turn =
        turn_by((205.0 - 900.0 * share + (share > 0.6 ? 720.0 : 0.0)) * 0.017453292519943295);
    const double radius = 3.3 - 2.5 * share;
    spiral.push_back(
        {kCochlea + apex * (3.2 * share) + radius * (turn.cosine * right + turn.sine * left),
         1.0 - 0.45 * share});
  }
  add(std::move(spiral));
  parts_.push_back({Anatomy::kVestibularAqueduct,
                    Tube(smooth({{v + Point(-0.2, 1.2, 0.2), 0.35},
                                 {{30.9, 28.4, 29.0}, 0.4},
                                 {{29.6, 31.4, 27.6}, 0.6},
                                 {{28.9, 33.4, 26.0}, 1.0}},
                                5),
                         least),
                    0.8});
}

void EarAnatomy::add_vessels(double least) {
  parts_.push_back({Anatomy::kCarotid,
                    Tube(smooth({{{35.2, 22.3, -3.0}, 2.5},
                                 {{35.6, 21.6, 9.0}, 2.5},
                                 {{36.6, 20.2, 15.2}, 2.5},
                                 {{40.5, 18.2, 18.3}, 2.4},
                                 {{45.5, 15.2, 19.8}, 2.4},
                                 {{54.0, 11.0, 21.0}, 2.4}},
                                5),
                         least),
                    1.2});
  internal_canal_ = Tube({{{34.0, 22.6, 28.2}, 2.0}, {{45.5, 23.0, 28.6}, 3.0}});
  const double y = 46.2 - v_.sinus;
  sinus_ = Tube(smooth({{{14.0, 57.0, 34.0}, 5.0},
                        {{12.6, 51.0, 31.5}, 5.0},
                        {{13.4, y, 25.5}, 4.9},
                        {{14.6, y - 2.3, 19.0}, 4.7},
                        {{18.5, 40.0 - 0.4 * v_.sinus, 12.5}, 4.5},
                        {{25.0, 34.6, 10.6 + v_.bulb}, 4.2},
                        {{30.5, 31.0, 13.0 + v_.bulb}, 4.0},  // jugular bulb
                        {{32.5, 30.0, 6.0}, 4.2},
                        {{33.0, 29.0, -4.0}, 4.4}},
                       5));
  temporal_line_ = Tube(smooth({{{4.6, 12.0, 25.6}, 1.5},
                                {{3.8, 21.0, 26.4}, 1.4},
                                {{3.6, 30.0, 28.0}, 1.3},
                                {{3.4, 38.0, 31.5}, 1.1},
                                {{3.4, 43.0, 36.5}, 0.7}},
                               4));
  tube_ = Tube(
      smooth({{{27.2, 17.0, 19.8}, 1.8}, {{32.5, 11.5, 16.6}, 1.1}, {{40.0, 4.0, 12.5}, 1.3}}, 4));
}

EarAnatomy::Material EarAnatomy::jaw(const Point& p) const {
  const double condyle = std::min(ellipsoid(p, {16.5, 10.0, 14.0}, {9.0, 4.2, 4.4}),
                                  round_cone(p, {15.8, 10.6, 11.5}, {15.2, 12.5, 4.0}, 3.0, 2.6));
  if (condyle >= 0.0) {
    return {};
  }
  return {Anatomy::kJaw, condyle > -1.2 ? 0.9 : 0.45};
}

bool EarAnatomy::air_cell(const Point& p, double depth, double inside, double middle) const {
  constexpr double kCortex = 1.8;
  constexpr double kPlate = 1.0;  // over dura, sinus and the canal
  if (depth > -kCortex || inside < kPlate || sinus(p) < kPlate || ear_canal(p) < 1.2 ||
      internal_canal_.distance(p) < 1.5) {
    return false;
  }
  for (const Part& part : parts_) {
    if (part.worm.distance(p) < part.wall) {
      return false;
    }
  }
  // Cells grow out of the antrum; few of them reach the petrous apex.
  const double reach = (p - kAntrum).norm() + 0.8 * std::max(0.0, p.x() - 27.0);
  const double share = (v_.cells - reach) / 4.0 + 0.5;
  return cells_.holds(p, v_.cell_fill * std::clamp(std::min(share, 1.0 - middle / 60.0), 0.0, 1.0));
}

/// The skin of the bony ear canal and the drum at its end; the rest of the canal is open.
/// @param canal  ear_canal() there, below 0
EarAnatomy::Material EarAnatomy::lining(const Point& p, double canal) const {
  if (drum(p) > -lining_) {
    return {Anatomy::kDrum, 1.0};
  }
  return canal > -lining_ && p.x() > kBony ? Material{Anatomy::kEarCanal, 1.0} : Material{};
}

/// The canal of the facial nerve and the capsule of the labyrinth bulge into the middle ear.
bool EarAnatomy::walled(const Point& p) const {
  constexpr double kWall = 0.55;
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    const bool bare = part.label == Anatomy::kFacialNerve && niche(p) < 0.0;
    const bool has_wall = part.label == Anatomy::kFacialNerve ||
                          part.label == Anatomy::kLabyrinth || part.label == Anatomy::kCarotid;
    return has_wall && !bare && part.worm.distance(p) < kWall;
  });
}

EarAnatomy::Material EarAnatomy::at(const Point& p) const {
  constexpr double kDura = 2.5;  // what is kept of the inside of the skull
  const Surfaces surface = surfaces(p);
  const double depth = hull(p, surface);
  const double inside = cranium(p, surface);
  const double border = surface.outline;  // what lies beyond belongs to other bones
  if (depth > 6.0 && inside > 6.0 && sinus(p) > 0.0) {
    const Material condyle = jaw(p);
    if (condyle.label != Anatomy::kNothing) {
      return condyle;
    }
  }
  for (const Part& part : parts_) {
    if (part.worm.distance(p, 1.0) < 0.0) {
      // In the open a nerve or vessel ends soon: this is a bone.
      if (depth > 2.0 && inside > 0.0) {
        return {};
      }
      return {part.label, 1.0};
    }
  }
  if (sinus(p) < 0.0 && border < -0.5 && (depth < 3.0 || inside < 0.0)) {
    return {Anatomy::kSinusAndDura, 1.0};
  }
  if (sinus(p) < 0.0 && border >= -0.5 && depth < 0.0) {  // its end
    return {Anatomy::kBone, 1.0};
  }
  if (internal_canal_.distance(p) < 0.0 && depth < 0.0 && inside > -1.0) {
    return {Anatomy::kInternalCanal, 1.0};
  }
  if (inside < 0.0) {
    const bool within = border < -1.5;  // bone closes the dura's edge
    if (within) {
      const bool lined = inside > -kDura && depth < kDura + 0.7;
      return lined ? Material{Anatomy::kSinusAndDura, 1.0} : Material{};
    }
    return depth < 0.0 ? Material{Anatomy::kBone, 1.0} : Material{};
  }
  if (const double canal = ear_canal(p); canal < 0.0) {
    return lining(p, canal);
  }
  const Material condyle = jaw(p);
  if (condyle.label != Anatomy::kNothing) {
    return condyle;
  }
  constexpr double kPlate = 1.0;  // over dura and sinus, also where the shapes leave a gap
  const bool plate = inside < kPlate || sinus(p) < kPlate;
  if (depth >= 0.0) {
    return plate && border < -0.5 && p.z() > 4.0 && depth < kDura + 0.8
               ? Material{Anatomy::kBone, 1.0}
               : Material{};
  }
  const double middle = middle_ear(p);
  if (middle < 0.0) {
    if (plate) {
      return {Anatomy::kBone, 1.0};
    }
    return walled(p) ? Material{Anatomy::kBone, 1.0} : Material{};
  }
  if (air_cell(p, depth, inside, middle)) {
    return {};
  }
  const double cortex = std::min({-depth, inside, middle + 0.5});
  const double capsule = (p - kVestibule).norm();
  return {Anatomy::kBone, cortex < 1.8 || capsule < 9.0 ? 1.0 : v_.spongy};
}

}  // namespace haptrial::bone
