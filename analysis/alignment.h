#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "analysis/alignment_isa.h"

namespace haptrial::analysis {

/// The cost of pairing point i of the target with point j of the applied curve, and of stretching
/// time:
///
///     e(i,j) = w_f |F_i - G_j|^p + w_s |F'_i - G'_j|^p
///     D(i,j) = e(i,j) + min( D(i-1,j-1), min(D(i-1,j), D(i,j-1)) + penalty ),   D(0,0) = e(0,0)
///
/// Source: Morris 2006, §4.3; the source leaves p open (docs/algorithms/alignment.md).
struct AlignmentParameters {
  double force_weight{1.0};  // w_f >= 0 [1/N^p]
  double slope_weight{0.5};  // w_s >= 0 [(s/N)^p]
  double penalty{0.5};       // >= 0, for each step that moves along one curve only [1]
  int power{1};              // p, 1 or 2
};

/// A force curve and its slope on a common time base. Views only: the caller owns the samples.
struct CurveView {
  std::span<const double> force;  // (samples) [N]
  std::span<const double> slope;  // (samples) [N/s]
};

struct AlignmentPair {
  CurveView target;
  CurveView applied;
};

struct PathPoint {
  std::uint32_t target{0};   // i
  std::uint32_t applied{0};  // j
  bool operator==(const PathPoint&) const = default;
};

struct Alignment {
  double cost{0.0};             // sum of e along the path, and of the penalties [1]
  std::vector<PathPoint> path;  // from (0,0) to (N-1,M-1), each step (1,1), (1,0) or (0,1)
};

/// Pairs two curves at minimum cost, the whole matrix searched, and keeps its workspace: after the
/// largest sizes have been seen once, nothing is allocated but a result that has to grow.
///
/// Where several steps cost the same, (1,1) is taken before (1,0) and (1,0) before (0,1), as seen
/// from the end of the path. The path is searched in single precision; its cost is then summed
/// along it in double precision. One pair alone, a batch of any size and every instruction set give
/// the same path and the same cost bit for bit. One object per thread.
class Aligner {
 public:
  /// @throws std::invalid_argument when this machine cannot run `set`.
  explicit Aligner(InstructionSet set = best_instruction_set());
  ~Aligner();
  Aligner(Aligner&&) noexcept;
  Aligner& operator=(Aligner&&) noexcept;

  /// @throws std::invalid_argument for an empty curve or one of more than kMaxSamples, a force and
  ///   a slope of different lengths, a value that is not finite or above kMaxError after weighting,
  ///   or a parameter out of bounds.
  void align(const CurveView& target, const CurveView& applied,
             const AlignmentParameters& parameters, Alignment& result);

  /// The same for many pairs, side by side in the lanes of the vectors. Sizes may differ; the time
  /// is least when neighbours in the list have the same size.
  /// @param results  as many as pairs.
  void align_batch(std::span<const AlignmentPair> pairs, const AlignmentParameters& parameters,
                   std::span<Alignment> results);

  /// Pairs that one sweep of align_batch() takes.
  std::size_t lanes() const;

  static constexpr std::size_t kMaxSamples = 32768;
  static constexpr double kMaxError = 1e12;  // keeps every sum far inside single precision

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// One call; see Aligner for the errors. Threads: any.
Alignment align(const CurveView& target, const CurveView& applied,
                const AlignmentParameters& parameters);
std::vector<Alignment> align_batch(std::span<const AlignmentPair> pairs,
                                   const AlignmentParameters& parameters);

/// The cost of a given path in double precision, as Alignment::cost is computed.
/// Precondition: the path lies inside the curves.
double path_cost(const CurveView& target, const CurveView& applied,
                 const AlignmentParameters& parameters, std::span<const PathPoint> path);

}  // namespace haptrial::analysis
