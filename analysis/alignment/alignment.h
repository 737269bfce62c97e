#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "analysis/alignment/cost.h"
#include "analysis/alignment/curves.h"
#include "analysis/alignment/isa.h"
#include "analysis/alignment/options.h"

namespace haptrial::analysis {

/// Pairs two curves at minimum cost, every path searched that the options allow, and keeps its
/// workspace: after the largest sizes have been seen once, nothing is allocated but a result that
/// has to grow.
///
/// Where several steps cost the same, (1,1) is taken before (1,0) and (1,0) before the last, as
/// seen from the end of the path; of equal open ends the latest. The published form, and others
/// where is_vectorized(), is searched in single precision in vector lanes, the rest in double
/// precision; the cost is then summed along the path in double precision. One pair alone, a batch
/// of any size and every instruction set give the same path and the same cost bit for bit. One
/// object per thread.
class Aligner {
 public:
  /// @throws std::invalid_argument when this machine cannot run `set`.
  explicit Aligner(InstructionSet set = best_instruction_set());
  ~Aligner();
  Aligner(Aligner&&) noexcept;
  Aligner& operator=(Aligner&&) noexcept;

  /// @throws std::invalid_argument for an empty curve or one of more than kMaxSamples, a force and
  ///   a slope of different lengths, a value that is not finite or above kMaxError after weighting,
  ///   options that problem_of() names, or a pattern that leaves no path between curves of these
  ///   lengths.
  void align(const CurveView& target, const CurveView& applied, const AlignmentOptions& options,
             Alignment& result);

  /// The same for many pairs, side by side in the lanes of the vectors. Sizes may differ; the time
  /// is least when neighbours in the list have the same size.
  /// @param results  as many as pairs.
  void align_batch(std::span<const AlignmentPair> pairs, const AlignmentOptions& options,
                   std::span<Alignment> results);

  /// Pairs that one sweep of align_batch() takes.
  std::size_t lanes() const;

  static constexpr std::size_t kMaxSamples = kMostAlignmentSamples;
  static constexpr double kMaxError = kLargestAlignmentError;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// One call; see Aligner for the errors. Threads: any.
Alignment align(const CurveView& target, const CurveView& applied, const AlignmentOptions& options);
/// @param jobs  threads >= 1; the results do not depend on it.
std::vector<Alignment> align_batch(std::span<const AlignmentPair> pairs,
                                   const AlignmentOptions& options, int jobs = 1);

}  // namespace haptrial::analysis
