#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// A number of a report by its name.
struct NamedNumber {
  std::string name;
  double value{0.0};
};

/// Report of one simulated study.
struct SimulatedStudy {
  std::vector<NamedNumber> tests;     // p by which the report decides each test
  std::vector<NamedNumber> values;    // on the report's scale; that of a test has the test's name
  std::vector<std::string> failures;  // reasons, each as often as it came up
  std::uint64_t trials{0};            // of the study proper
  double hours{0.0};                  // in the lab, roughly
};

/// A study whose report can be had for simulated participants, one report for each seed. What a
/// kind of study gives to the simulation of power (experiments/power), and all that it needs to
/// know of it. Calls from several threads at once.
class StudySimulation {
 public:
  virtual ~StudySimulation() = default;

  /// Whether virtual participants differ from each other: a test over participants who do not says
  /// nothing of people.
  virtual bool people_differ() const = 0;
  /// A study at the level of responses: a function of the seed.
  /// @throws InputError if this definition can only be simulated in full
  virtual SimulatedStudy responses(std::uint64_t seed) const = 0;
  /// The same of sessions that were recorded. @param files  at least one
  virtual SimulatedStudy sessions(const std::vector<std::filesystem::path>& files) const = 0;
};

}  // namespace haptrial::experiments
