#pragma once

#include <cstdint>
#include <vector>

#include "core/bone/data/anatomy.h"
#include "core/bone/data/shapes.h"

namespace haptrial::bone {

/// Differences from one temporal bone to the next; lengths in millimetres.
struct EarVariation {
  double scale{1.0};         // of everything
  double cells{15.0};        // how far they reach from the antrum
  double cell_fill{0.85};    // 0 to 1
  double sinus{0.0};         // forward, towards the ear canal
  double tegmen{0.0};        // up
  double nerve{0.0};         // the second genu of the facial nerve, to the back
  double mastoid_tip{0.0};   // down
  double canal{4.1};         // radius of the ear canal
  double bulb{0.0};          // the jugular bulb, up
  double mastoid_roof{0.0};  // a dip of the tegmen over the mastoid, down
  double antrum{1.0};        // width of antrum and aditus, as a share
  bool bare_nerve{false};    // the tympanic part of the facial nerve lies bare above the stapes
  double spongy{0.75};       // density of bone deep in the mastoid, 0 to 1
  std::uint64_t noise{1};    // seed of cells and unevenness
};
EarVariation ear_variation(std::uint64_t seed);

/// A right temporal bone as shapes; millimetres, LPS, in a box from 0 to 49 and kAround about it.
/// The course of the nerves and the sizes are from the texts in
/// docs/algorithms/procedural-bones.md.
class EarAnatomy {
 public:
  static constexpr double kBox = 49.0;  // the middle of this is the middle of the volume
  inline static const Point kAround{3.0, 9.0, 10.0};  // beyond it, at both ends

  /// @param least  radius that no nerve or vessel falls below, so that it stays in one piece
  EarAnatomy(const EarVariation& variation, double least);

  struct Material {
    Anatomy label{Anatomy::kNothing};
    double density{0.0};  // 0 to 1
  };
  Material at(const Point& p) const;

  const Tube& facial_nerve() const { return facial_; }

 private:
  struct Part {
    Anatomy label;
    Tube worm;
    double wall;  // bone around it that cells leave alone
  };
  /// Surfaces at a place that several shapes share.
  struct Surfaces {
    double outer;    // side of the skull; below 0 inwards
    double inner;    // of its inside, likewise
    double outline;  // of the bone as the side shows it; below 0 within
    double tegmen;   // z of the floor of the middle fossa
    double behind;   // the back of the petrous bone; below 0 behind it
  };
  Surfaces surfaces(const Point& p) const;
  void add_nerves(double least);
  void add_labyrinth(double least);
  void add_ossicles(double least);
  void add_vessels(double least);

  double outer_side(const Point& p) const;
  double outline(const Point& p) const;
  double wall(const Point& p) const;  // thickness of the skull
  double tegmen(const Point& p) const;
  double behind(const Point& p) const;
  double fossa_floor(const Point& p) const;                 // z of the floor of the posterior fossa
  double hull(const Point& p, const Surfaces& s) const;     // the bone without anything cut out
  double cranium(const Point& p, const Surfaces& s) const;  // the space inside the skull
  double sinus(const Point& p) const;
  double ear_canal(const Point& p) const;
  double drum(const Point& p) const;  // below 0 on the canal's side of the ear drum
  double niche(const Point& p) const;
  double middle_ear(const Point& p) const;
  bool walled(const Point& p) const;
  bool air_cell(const Point& p, double depth, double inside, double middle) const;
  Material jaw(const Point& p) const;
  Material lining(const Point& p, double canal) const;

  EarVariation v_;
  std::vector<Part> parts_;  // the first that holds a place has it
  Tube facial_;
  Tube sinus_;
  Tube tube_;  // of Eustachius
  Tube internal_canal_;
  Tube temporal_line_;
  double lining_;  // of the ear canal and the drum: no voxel lets through
  Cells cells_;
};

/// Places of a mean right ear that several parts of its shape follow from [mm].
inline const Point kVestibule{31.5, 24.4, 26.2};
inline const Point kCochlea{35.2, 20.2, 25.2};
inline const Point kDrum{24.6, 20.4, 20.9};  // middle of the ear drum
inline const Point kAntrum{22.6, 28.6, 27.2};
inline const Point kMeatus{3.5, 27.3, 15.2};      // beyond where the ear canal opens
inline const Point kBareNerve{28.0, 22.9, 26.3};  // where the facial nerve may lack its canal
inline constexpr double kBony = 6.2;              // x where the bony canal begins

}  // namespace haptrial::bone
