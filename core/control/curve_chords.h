#pragma once

#include <cstddef>

// The arithmetic of a search on a sampled curve: eight chords at once.
namespace haptrial::control {

/// Chords side by side.
constexpr std::size_t kRun = 8;

/// Eight chords end to end, from (x, y, z)[c] to (x, y, z)[c + 1].
struct Chords {
  double x[kRun + 1], y[kRun + 1], z[kRun + 1];  // [m]
  double arc[kRun + 1];                          // where they begin and the last ends [m]
};

/// Eight nodes of one level of the tree.
struct alignas(64) ChordPack : Chords {
  double stray[kRun];  // no point of the node is farther from its chord [m]; NaN: no such node
};

/// A search's question at one moment.
struct ChordQuery {
  double x, y, z;                // the point [m]
  double low, high;              // arcs of interest [m]
  double known_low, known_high;  // arcs that need no look [m]
  double bound;                  // what is not nearer than this is of no interest [m]
};

/// Distances of eight chords to the point.
struct ChordLooks {
  alignas(64) double square[kRun];  // of the distance [m²]
  alignas(64) double along[kRun];   // nearest place, 0 at a chord's begin and 1 at its end
};

/// More than the rounding of a distance to a chord, relative to that distance and to the chord.
constexpr double kChordRounding = 0x1p-48;

/// The distance to each of eight chords.
void measure_chords(const Chords& chords, const ChordQuery& query, ChordLooks& looks);
/// The same for eight nodes; bit c says whether node c may hold a place that is of interest.
unsigned scan_chords(const ChordPack& pack, const ChordQuery& query, ChordLooks& looks);

}  // namespace haptrial::control
