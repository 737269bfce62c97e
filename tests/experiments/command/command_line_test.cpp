// The words of the command line: what the help says, and what is said of a mistyped word.

#include "experiments/command/line/whole_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <regex>
#include <string>
#include <vector>

#include "tests/experiments/command.h"

namespace haptrial {
namespace {

using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

/// Why a description does not read well; empty if it does.
std::string fault_of(const std::string& text) {
  if (!std::regex_search(text, std::regex("^(\\w+: )?[A-Z]"))) {
    return "does not begin with a capital letter";
  }
  static const std::vector<const char*> kBanned{"^Of ",
                                                "^With ",
                                                "^Such ",
                                                "^Also ",
                                                "^Likewise",
                                                "^How ",
                                                "^What ",
                                                "^Only ",
                                                "^In ",
                                                "^No ",
                                                "^At ",
                                                "^Say ",
                                                "^Give ",
                                                "^Let ",
                                                "that is none",
                                                "so many",
                                                "those there are",
                                                "that is there",
                                                "that are there",
                                                "that drill",
                                                "drills not",
                                                "by default",
                                                "as well",
                                                "allowed: a new",
                                                "go on with",
                                                "[ (]else[ )]",
                                                "  "};
  for (const char* banned : kBanned) {
    if (std::regex_search(text, std::regex(banned))) {
      return std::string("holds '") + banned + "'";
    }
  }
  // "(1)" or "(virtual)" at the end leaves open what it is.
  static const std::regex kBareDefault("\\((?!default: )-?[0-9.]+\\)$");
  if (std::regex_search(text, kBareDefault)) {
    return "has a default that is not written (default: VALUE)";
  }
  if (text.back() == '.') {
    return "ends in a full stop";
  }
  return "";
}

void for_every_description(
    const CLI::App& app, const std::string& name,
    const std::function<void(const std::string&, const std::string&)>& visit) {
  for (const CLI::Option* option : app.get_options()) {
    visit(name + " " + option->get_name(true), option->get_description());
  }
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    visit(name + " " + sub->get_name(), sub->get_description());
    for_every_description(*sub, name + " " + sub->get_name(), visit);
  }
}

TEST(CommandLineTest, EveryDescriptionReadsOnce) {
  CLI::App app;
  int status = 0;
  experiments::declare_subcommands(app, status);
  int count = 0;
  for_every_description(app, "haptrial", [&](const std::string& what, const std::string& text) {
    ++count;
    EXPECT_EQ(fault_of(text), "") << what << ": " << text;
  });
  EXPECT_GT(count, 150);
}

TEST(CommandLineTest, TheRulesForDescriptionsFindWhatBreaksThem) {
  for (const char* text :
       {"Of the study (1)", "Chance of finding one that is none (0.05)", "[px] (1280)",
        "Such as 18-25", "Seed of the study (1)", "Only the first so many",
        "Threads; one per processor by default", "virtual, mouse or replay:FILE",
        "Replace files that are there", "Analyze the sessions."}) {
    EXPECT_NE(fault_of(text), "") << text;
  }
  EXPECT_EQ(fault_of("Seed of the study (default: 1)"), "");
  EXPECT_EQ(fault_of("New picture (.png)"), "");
}

TEST(CommandLineTest, EverySubcommandShowsAnExampleAndItsExitStatuses) {
  CLI::App app;
  int status = 0;
  experiments::declare_subcommands(app, status);
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    EXPECT_THAT(sub->get_footer(), HasSubstr("Example:\n  haptrial " + sub->get_name()));
    EXPECT_THAT(sub->get_footer(), HasSubstr("Exit status: 0 done, 1 failed, 2 bad input."));
  }
  const CommandResult help = run_command("haptrial --help");
  EXPECT_THAT(help.output, HasSubstr("Exit status: 0 done"));
  EXPECT_THAT(help.output, HasSubstr("Documentation: "));
}

/// Exit status 2, the sentence alone on standard error.
void expect_refused(const std::string& line, const std::string& sentence) {
  const CommandResult result = run_command(line);
  EXPECT_EQ(result.status, 2) << line;
  EXPECT_EQ(result.output, "") << line;
  EXPECT_EQ(result.errors.rfind("haptrial: " + sentence, 0), 0u) << line << "\n" << result.errors;
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
}

TEST(CommandLineTest, AMistypedWordNamesTheNearestOne) {
  expect_refused("haptrial run experiment.toml --devcie mouse",
                 "--devcie is not an option of haptrial run; did you mean --device? see haptrial "
                 "run --help\n");
  expect_refused("haptrial run experiment.toml --devcie=mouse", "--devcie is not an option");
  expect_refused("haptrial analyze x --job 2",
                 "--job is not an option of haptrial analyze; did you mean --jobs? ");
  expect_refused("haptrial bone make temporal x.nrrd --sede 3",
                 "--sede is not an option of haptrial bone make; did you mean --seed? ");
  expect_refused("haptrial analyze x --colour",
                 "--colour is not an option of haptrial analyze; see haptrial analyze --help\n");
  expect_refused("haptrial analyze x -jobs 2",
                 "-jobs is not an option of haptrial analyze; did you mean --jobs? ");
  expect_refused(
      "haptrial anlayze x",
      "'anlayze' is not a subcommand of haptrial; did you mean "
      "analyze? allowed: examples, new, set, texts, doctor, studio, dry-run, start, run, "
      "secret, roster, next, withdraw, "
      "analyze, ");
  expect_refused("haptrial mesh voxelise a b",
                 "'voxelise' is not a subcommand of haptrial mesh; "
                 "did you mean voxelize? allowed: ");
  expect_refused("haptrial frobnicate", "'frobnicate' is not a subcommand of haptrial; allowed: ");
  expect_refused("haptrial bone", "haptrial bone needs a subcommand; allowed: import, ");
}

TEST(CommandLineTest, AMissingOrUnreadableValueIsSaidWithTheHelpToRead) {
  expect_refused("haptrial validate", "DEFINITION is missing; see haptrial validate --help\n");
  expect_refused("haptrial dry-run x.toml --subjects many",
                 "--subjects is 'many'; allowed: a whole number; see haptrial dry-run --help\n");
  expect_refused("haptrial power t --delta big",
                 "--delta is 'big'; allowed: a number; see haptrial power --help\n");
  expect_refused("haptrial statistics x.csv --seed -1",
                 "--seed is '-1'; allowed: a whole number from 0 to 18446744073709551615\n");
  expect_refused("haptrial dry-run x.toml --subjects 2 --subjects 3",
                 "--subjects is given 2 times; give it once; see haptrial dry-run --help\n");
  expect_refused("haptrial run x.toml --subject",
                 "--subject has no value; write one after it; see haptrial run --help\n");
}

TEST(CommandLineTest, ANegativeNumberAndWhatFollowsTwoHyphensAreNoOptions) {
  expect_refused("haptrial bone picture no.nrrd out.png --from -1,0,0 --at -5,0,0", "no.nrrd: ");
  expect_refused("haptrial validate -- --no-such.toml", "--no-such.toml: no such file");
}

}  // namespace
}  // namespace haptrial
