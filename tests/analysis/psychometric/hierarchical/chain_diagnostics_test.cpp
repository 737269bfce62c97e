#include "analysis/psychometric/hierarchical/chain_diagnostics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Chains = std::vector<std::vector<double>>;

/// Chains of an autoregression x' = memory x + noise.
Chains autoregression(double memory, std::size_t count, std::size_t length) {
  RandomStream random(5, "autoregression");
  Chains chains;
  for (std::size_t c = 0; c < count; ++c) {
    double x = random.normal();
    std::vector<double>& chain = chains.emplace_back();
    for (std::size_t i = 0; i < length; ++i) {
      x = memory * x + std::sqrt(1.0 - memory * memory) * random.normal();
      chain.push_back(x);
    }
  }
  return chains;
}

ChainDiagnostics diagnostics(const Chains& chains) {
  return chain_diagnostics({chains.begin(), chains.end()});
}

// The autocorrelation time of such a process is (1 + memory) / (1 - memory).
TEST(ChainDiagnosticsTest, EffectiveDrawsFollowTheAutocorrelationTime) {
  for (const double memory : {0.0, 0.5, 0.8, -0.4}) {
    const ChainDiagnostics d = diagnostics(autoregression(memory, 4, 5000));
    const double expected = 20'000.0 * (1.0 - memory) / (1.0 + memory);
    EXPECT_NEAR(d.effective / expected, 1.0, 0.15) << memory;
    EXPECT_LT(d.r_hat, 1.01) << memory;
  }
}

TEST(ChainDiagnosticsTest, ChainsInOtherPlacesOrWithOtherSpreadsDisagree) {
  Chains shifted = autoregression(0.0, 4, 500), spread = shifted;
  for (double& draw : shifted[2]) {
    draw += 1.0;
  }
  for (double& draw : spread[2]) {
    draw *= 4.0;
  }
  EXPECT_GT(diagnostics(shifted).r_hat, 1.05);
  EXPECT_GT(diagnostics(spread).r_hat, 1.05);
}

// A drift within a chain shows, as halves are compared.
TEST(ChainDiagnosticsTest, AChainThatDriftsDisagreesWithItself) {
  Chains chains = autoregression(0.0, 2, 500);
  for (std::vector<double>& chain : chains) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      chain[i] += 0.004 * static_cast<double>(i);
    }
  }
  EXPECT_GT(diagnostics(chains).r_hat, 1.05);
}

// Ranks do not change with a rising map, and draws without variance tell nothing.
TEST(ChainDiagnosticsTest, TakesRanks) {
  const Chains chains = autoregression(0.5, 4, 500);
  Chains mapped = chains;
  for (std::vector<double>& chain : mapped) {
    for (double& draw : chain) {
      draw = std::exp(3.0 * draw);
    }
  }
  EXPECT_DOUBLE_EQ(diagnostics(mapped).effective, diagnostics(chains).effective);
  const ChainDiagnostics still = diagnostics(Chains(4, std::vector<double>(100, 1.0)));
  EXPECT_TRUE(std::isnan(still.r_hat));
  EXPECT_THROW(diagnostics({{1.0, 2.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
