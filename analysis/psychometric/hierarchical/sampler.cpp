#include "analysis/psychometric/hierarchical/sampler.h"

#include <fmt/format.h>

#include "core/base/parallel.h"
#include "core/base/require.h"

namespace haptrial::analysis::hierarchical {

NumberPlaces::NumberPlaces(const Model& model) {
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    if (family.entries() == 0) {
      continue;
    }
    families[f].means = count;
    families[f].between = count + family.columns;
    families[f].within = families[f].between + 1;
    families[f].values = families[f].within + (family.within ? 1 : 0);
    count = families[f].values + family.entries();
  }
}

std::vector<double> numbers_of(const Model& model, const State& state) {
  std::vector<double> all;
  for (std::size_t f = 0; f < kFamilies; ++f) {
    const Family& family = model.family(f);
    if (family.entries() == 0) {
      continue;
    }
    all.insert(all.end(), state[f].means.begin(), state[f].means.end());
    all.push_back(state[f].between);
    if (family.within) {
      all.push_back(state[f].within);
    }
    all.insert(all.end(), state[f].values.begin(), state[f].values.end());
  }
  return all;
}

Sampler::Sampler(const Model& model, const Sampling& sampling)
    : model_(model), threads_(sampling.threads), drawn_(sampling.chains) {
  require(sampling.chains >= 1, "chains must be at least 1");
  require(sampling.draws >= 8, "draws must be at least 8");
  require(sampling.threads >= 1, "threads must be at least 1");
  for (std::size_t i = 0; i < sampling.chains; ++i) {
    chains_.emplace_back(model, sampling.seed, fmt::format("hierarchical chain {}", i));
  }
  parallel_for(chains_.size(), threads_,
               [&](std::size_t i) { chains_[i].warm_up(sampling.warm_up); });
}

void Sampler::extend(std::size_t draws) {
  parallel_for(chains_.size(), threads_, [&](std::size_t i) {
    for (std::size_t draw = 0; draw < draws; ++draw) {
      chains_[i].sweep();
      drawn_[i].push_back(numbers_of(model_, chains_[i].state()));
    }
  });
  length_ += draws;
}

std::vector<double> Sampler::draws(std::size_t number) const {
  std::vector<double> all;
  all.reserve(chains_.size() * length_);
  for (const auto& chain : drawn_) {
    for (const std::vector<double>& numbers : chain) {
      all.push_back(numbers[number]);
    }
  }
  return all;
}

}  // namespace haptrial::analysis::hierarchical
