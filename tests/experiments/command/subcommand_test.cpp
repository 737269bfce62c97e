#include "experiments/command/subcommand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>

namespace haptrial::experiments {
namespace {

using testing::HasSubstr;

struct TriedOptions {
  std::string seed{"1"};
  int count{9999};
  double step{1e-3};
};

TEST(SubcommandTest, ShowsTheDefaultsOfItsStructAndReturnsAStatus) {
  CLI::App app;
  int status = 0;
  CLI::App* sub = subcommand(app, "try", "Try it", "haptrial try --count 7");
  auto& o = options_of<TriedOptions>(*sub, status, [](const TriedOptions& given) {
    return given.step == TriedOptions{}.step ? given.count : -1;
  });
  sub->add_option("--seed", o.seed, with_default("Seed", o.seed));
  sub->add_option("--count", o.count, with_default("Count", o.count));
  sub->add_option("--step", o.step, with_default("Step [s]", o.step));
  EXPECT_THAT(sub->help(), HasSubstr("Seed (default: 1)\n"));
  EXPECT_THAT(sub->help(), HasSubstr("Count (default: 9999)\n"));
  EXPECT_THAT(sub->help(), HasSubstr("Step [s] (default: 0.001)\n"));
  app.parse("try --count 7", false);
  EXPECT_EQ(status, 7);
  app.parse("try --step 0.002", false);
  EXPECT_EQ(status, -1);
}

}  // namespace
}  // namespace haptrial::experiments
