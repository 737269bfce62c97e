#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// A random-dot stereogram of an upright bar before a background: its edges are where the depth of
/// the dots steps, and nothing else shows them. Each dot's depth is spread by a share of the step,
/// so that the edges can be made as hard to see as wanted (Ernst and Banks 2002, Nature 415, 429).
struct RandomDots {
  std::array<double, 3> centre{};  // of the bar, in W; its depth is that of the screen [m]
  double width{0.12};              // > 0 [m]
  double height{0.05};             // > 0 [m]
  double step{0.03};               // from the background to the bar, towards the eyes [m]
  double noise{0.0};               // standard deviation of a dot's depth, as a share of the step
  double diameter{0.0012};         // of a dot > 0 [m]
  std::int32_t count{2500};        // of dots on the whole screen
};
static_assert(std::is_trivially_copyable_v<RandomDots>);

/// A content of a stage beside marks.
struct Look {
  std::string name;  // of the table [looks.NAME]
  RandomDots dots;
};

/// Reads every table of [looks]. Problems are noted; keys in brackets are optional.
///
///     type           "random_dots"
///     width, height  of the bar [m]; these and what follows, but [dots], may be formulas
///     [centre]       in W [m]; [step], [dot] [m]; [noise] share of the step; [dots] their number
std::vector<Look> read_looks(Table& looks);

/// Place from which the screen is seen.
struct TwoEyes {
  double eye_distance{0.063};     // > 0 [m]
  double viewing_distance{0.50};  // from the eyes to the screen > 0 [m]
};

/// A dot on the screen for one eye, from the middle of the screen: x to the right, y down [m].
using EyeDot = Eigen::Vector2d;

/// The dots of a stereogram on a screen of the size `screen` [m], the bar placed by `centre` on it
/// [m]. A point at the depth z before the screen is seen by an eye at (e, 0, D) at
/// p + (p - e) z / (D - z).
/// @param side  -1 left eye, +1 right eye
/// @param seed  the same dots for the same seed, and for both eyes
/// @throws std::invalid_argument naming the parameter that breaks its bound
std::vector<EyeDot> dots_for_eye(const RandomDots& dots, const Eigen::Vector2d& screen,
                                 const Eigen::Vector2d& centre, const TwoEyes& eyes, int side,
                                 std::uint64_t seed);

}  // namespace haptrial::protocols
