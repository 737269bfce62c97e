#include "core/subject/perceiver/judgement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/subject/perceiver/trial_stream.h"

namespace haptrial::subject {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();
constexpr std::size_t kMostIntervals = 16;

void check_judgement(const JudgementParameters& p) {
  const auto require = [](bool good, const char* what) {
    if (!good) {
      throw std::invalid_argument(std::string("Judge: ") + what);
    }
  };
  const auto spread = [](double x) { return x >= 0.0 && std::isfinite(x); };
  const auto size = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(spread(p.noise), "noise must be at least 0");
  require(std::isfinite(p.bias_first), "bias_first must be finite");
  require(std::isfinite(p.repetition), "repetition must be finite");
  require(p.logarithmic ? size(p.criterion) : std::isfinite(p.criterion),
          "criterion must be finite, and above 0 if logarithmic");
  require(std::isfinite(p.drift), "drift must be finite");
  require(p.lapse >= 0.0 && p.lapse <= 1.0, "lapse must be from 0 to 1");
  require(size(p.exponent), "exponent must be above 0");
  require(size(p.modulus), "modulus must be above 0");
  require(spread(p.magnitude_noise), "magnitude_noise must be at least 0");
  require(spread(p.tolerance), "tolerance must be at least 0");
}

}  // namespace

Judge::Judge(const JudgementParameters& parameters, std::uint64_t session_seed)
    : parameters_(parameters), seed_(session_seed), random_(trial_stream(seed_, "judgement", 0)) {
  check_judgement(parameters);
}

void Judge::begin_trial(int trial) noexcept {
  trial_ = trial;
  random_ = trial_stream(seed_, "judgement", trial);
}

double Judge::evidence(double percept) const noexcept {
  if (std::isnan(percept)) {
    return kNothing;
  }
  if (!parameters_.logarithmic) {
    return percept;
  }
  return percept > 0.0 ? std::log(percept) : kNothing;
}

Decision Judge::lapse(int answers) noexcept {
  // Drawn in any case, so that a lapse does not change what else is drawn.
  const bool lapsed = random_.uniform() < parameters_.lapse;
  return {static_cast<int>(random_.below(static_cast<std::uint64_t>(answers))), 0.0, lapsed};
}

Decision Judge::between(std::span<const double> percepts, Extreme extreme) noexcept {
  const int count = static_cast<int>(std::min(percepts.size(), kMostIntervals));
  if (count == 0) {
    return {};
  }
  Decision decision = lapse(count);
  std::array<double, kMostIntervals> e{};
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    e[at] = evidence(percepts[at]) * (extreme == Extreme::kLargest ? 1.0 : -1.0) +
            parameters_.noise * random_.normal() + (i == 0 ? parameters_.bias_first : 0.0);
    if (previous_ >= 0) {
      e[at] += i == previous_ ? parameters_.repetition : -parameters_.repetition;
    }
  }
  if (decision.lapsed || count == 1) {
    return decision;
  }
  const auto end = e.begin() + count;
  const double best = *std::max_element(e.begin(), end);
  const auto ties = std::count(e.begin(), end, best);
  if (ties > 1) {
    auto which = random_.below(static_cast<std::uint64_t>(ties));
    for (int i = 0; i < count; ++i) {
      if (e[static_cast<std::size_t>(i)] == best && which-- == 0) {
        decision.answer = i;
        break;
      }
    }
    return decision;
  }
  decision.answer = static_cast<int>(std::max_element(e.begin(), end) - e.begin());
  std::partial_sort(e.begin(), e.begin() + 2, end, std::greater<>());
  decision.evidence = e[0] - e[1];
  return decision;
}

Decision Judge::yes_no(double percept) noexcept {
  Decision decision = lapse(2);
  double e = evidence(percept) - evidence(parameters_.criterion) - parameters_.drift * trial_ +
             parameters_.noise * random_.normal();
  if (previous_ >= 0) {
    e += previous_ == 1 ? parameters_.repetition : -parameters_.repetition;
  }
  if (!decision.lapsed && e != 0.0) {
    decision.answer = e > 0.0 ? 1 : 0;
    decision.evidence = std::abs(e);
  }
  return decision;
}

Decision Judge::nearest(double percept, std::span<const double> prototypes) noexcept {
  const int count = static_cast<int>(std::min(prototypes.size(), kMostIntervals));
  if (count == 0) {
    return {};
  }
  Decision decision = lapse(count);
  const double e = evidence(percept) + parameters_.noise * random_.normal();
  if (decision.lapsed || count == 1) {
    return decision;
  }
  std::array<double, kMostIntervals> apart{};
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    apart[at] = std::abs(e - evidence(prototypes[at]));
    if (previous_ >= 0) {
      apart[at] -= i == previous_ ? parameters_.repetition : -parameters_.repetition;
    }
  }
  const auto end = apart.begin() + count;
  decision.answer = static_cast<int>(std::min_element(apart.begin(), end) - apart.begin());
  std::partial_sort(apart.begin(), apart.begin() + 2, end);
  decision.evidence = std::isfinite(apart[1]) ? 0.5 * (apart[1] - apart[0]) : 0.0;
  return decision;
}

double Judge::magnitude(double percept) noexcept {
  return magnitude(percept, 1.0, parameters_.modulus);
}

double Judge::magnitude(double percept, double standard, double number) noexcept {
  const double noise = std::exp(parameters_.magnitude_noise * random_.normal());
  return number * std::pow(std::max(0.0, percept / standard), parameters_.exponent) * noise;
}

int Judge::adjust(double percept, double wanted) noexcept {
  const double noise = parameters_.noise * random_.normal();
  const double here = evidence(percept);
  const double there = evidence(wanted);
  if (here == there) {
    return 0;  // nothing and nothing too
  }
  const double e = here - there + noise;
  return std::abs(e) <= parameters_.tolerance ? 0 : e > 0.0 ? -1 : 1;
}

int confidence(const Decision& decision, double noise, int categories) noexcept {
  if (categories <= 1) {
    return 1;
  }
  const double z = noise > 0.0               ? decision.evidence / noise
                   : decision.evidence > 0.0 ? std::numeric_limits<double>::infinity()
                                             : 0.0;
  const double certainty = std::erf(z / std::numbers::sqrt2);  // 2 Phi(z) - 1
  return std::min(categories, 1 + static_cast<int>(certainty * categories));
}

}  // namespace haptrial::subject
