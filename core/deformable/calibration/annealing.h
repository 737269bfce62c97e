#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/random.h"

namespace haptrial::deformable {

/// A range that is searched.
struct SearchRange {
  double low{0.0};
  double high{1.0};  // > low
};

struct AnnealingOptions {
  int samples{100};        // coarse ones before the search, >= 1
  int batch{1};            // candidates from one state, >= 1; 1: as published
  double ratio{1e-5};      // of the parameters' temperatures after `scale` candidates, (0, 1)
  double scale{100.0};     // > 1
  int accepted_until{50};  // candidates that are accepted before the temperatures are set anew
  double probe{1e-3};      // step of the sensitivities, of a range
};

/// Adaptive simulated annealing over a box, which asks for costs and is told them. A candidate is
///
///     x_i' = x_i + y_i (high_i - low_i),  y_i = sgn(u - 1/2) T_i ((1 + 1/T_i)^|2u - 1| - 1)
///     T_i = exp(-c k_i^(1/D)),  c = m exp(-n/D),  m = -ln ratio,  n = ln scale
///
/// drawn again until it lies inside, and is accepted with the probability
/// 1 / (1 + exp((E' - E) / T)). After every `accepted_until` of them the sensitivity |∂E/∂x_i| at
/// the best point is measured and temperatures are set anew: wide in the directions that matter
/// least. The search begins with the best of the coarse samples; if all are unstable it samples on.
/// What is told decides what is asked: told the same costs a search is the same, so that one that
/// was interrupted goes on by its recorded costs.
/// Sources: Ingber 1989, 1996; Morris 2006, §5.3.2.
class Annealing {
 public:
  /// @throws std::invalid_argument for no range, an empty one, or an option out of its bounds.
  Annealing(std::vector<SearchRange> ranges, std::uint64_t seed,
            const AnnealingOptions& options = {});

  /// The points whose costs are wanted next, `batch` or more of them; the same until tell().
  const std::vector<std::vector<double>>& ask();
  /// @param costs  of the points of ask(), in their order; infinite: unstable, never accepted
  /// @throws std::invalid_argument for another number of costs, or one that is no number.
  void tell(std::span<const double> costs);

  const std::vector<double>& best() const { return best_; }
  double best_cost() const { return best_cost_; }  // infinite: nothing stable was found yet
  long evaluations() const { return evaluations_; }

 private:
  enum class Phase { kSamples, kSearch, kSensitivities };
  std::vector<double> sample();
  std::vector<double> candidate();
  void keep_best(const std::vector<double>& point, double cost);
  void judge(const std::vector<double>& point, double cost);
  void set_temperatures(std::span<const double> costs);
  double temperature(std::size_t i) const;
  std::vector<double> probe_point(std::size_t i) const;

  std::vector<SearchRange> ranges_;
  AnnealingOptions options_;
  RandomStream random_;
  Phase phase_{Phase::kSamples};
  std::vector<std::vector<double>> asked_;
  std::vector<double> current_, best_;
  double cost_{std::numeric_limits<double>::infinity()};
  double best_cost_{std::numeric_limits<double>::infinity()};
  std::vector<double> steps_;  // k_i
  double cost_steps_{0.0};     // k of the acceptance
  double first_cost_temperature_{0.0};
  int accepted_{0};
  long evaluations_{0};
};

}  // namespace haptrial::deformable
