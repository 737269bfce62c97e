// Definitions with one line that was changed at random: what is read without a problem runs to its
// end, and every problem has its place.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "experiments/command/start/examples.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/study_run.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::mutated_definitions_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Longer or more trials would only take longer.
bool lengthens(const std::string& line) {
  static const std::regex kLengths(
      "time|duration|after|for =|repetitions|trials|count|participants");
  return std::regex_search(line, kLengths);
}

/// Multiplies a number of the line, or takes the line away. @returns what was done; empty: nothing
std::string mutate(std::string& line, RandomStream& random) {
  static const std::regex kNumber("-?[0-9]+(\\.[0-9]+)?(e-?[0-9]+)?");
  constexpr std::array kFactors{0.0, 0.1, 0.5, -1.0, 2.0, 10.0};
  const std::string before = line;
  const auto equals = line.find('=');
  const auto comment = line.find('#');
  if (equals == std::string::npos || comment < equals) {
    return "";
  }
  if (random.below(8) == 0) {
    line.clear();
    return before + " -> gone";
  }
  std::vector<std::pair<std::size_t, std::string>> numbers;
  for (std::sregex_iterator
           at(line.begin() + static_cast<std::ptrdiff_t>(equals), line.end(), kNumber),
       end;
       at != end; ++at) {
    const auto from = equals + static_cast<std::size_t>(at->position());
    if (from < comment) {
      numbers.emplace_back(from, at->str());
    }
  }
  if (numbers.empty()) {
    return "";
  }
  const auto& [from, number] = numbers[random.below(numbers.size())];
  const double factor = kFactors[random.below(lengthens(line) ? 4 : kFactors.size())];
  const double value = factor * std::stod(number);
  const bool whole = number.find_first_of(".e") == std::string::npos;
  line.replace(from, number.size(),
               whole ? fmt::format("{:.0f}", value) : fmt::format("{:#.6g}", value));
  return before + " -> " + line;
}

struct Mutated {
  std::string text;
  std::string done;  // what was changed
};

/// @param name  of a shipped definition
Mutated mutated(std::string_view name, RandomStream& random) {
  std::vector<std::string> lines = lines_of(example_named(name).text);
  std::string done;
  while (done.empty()) {
    done = mutate(lines[random.below(lines.size())], random);
  }
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return {text, done};
}

/// @returns whether the definition was read
bool runs_or_is_refused(const fs::path& folder, const Mutated& mutated) {
  const fs::path file = folder / "study.toml";
  write_text(file, mutated.text);
  Experiment experiment;
  try {
    experiment = load_experiment(file);
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("study.toml:")) << mutated.done;
    return false;
  }
  DryRun dry;
  dry.participants = 1;
  dry.jobs = 1;
  dry.folder = folder / "out";
  try {
    const DryRunSummary done = run_dry(experiment.study->protocol(), *experiment.definition, dry);
    EXPECT_GT(done.passes, 0) << mutated.done;
  } catch (const std::exception& error) {
    ADD_FAILURE() << mutated.done << "\n" << error.what();
  }
  return true;
}

TEST(MutatedDefinitionsTest, WhatIsReadRunsToItsEnd) {
  constexpr std::array kNames{"first_experiment", "grating_discrimination", "viscosity_magnitude",
                              "wall_detection"};
  constexpr std::size_t kEach = 10;
  RandomStream random(3, "mutations");
  std::size_t read = 0;
  for (const char* name : kNames) {
    for (std::size_t i = 0; i < kEach; ++i) {
      SCOPED_TRACE(fmt::format("{}, mutation {}", name, i));
      const test::TemporaryFolder folder;
      read += runs_or_is_refused(folder.path(), mutated(name, random)) ? 1 : 0;
    }
  }
  EXPECT_GT(read, 10u) << "or nothing was tried";
  EXPECT_LT(read, kNames.size() * kEach) << "or nothing was wrong";
}

}  // namespace
}  // namespace haptrial::experiments::mutated_definitions_test
