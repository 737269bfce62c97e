#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/power/power_question.h"
#include "experiments/studies/study.h"

namespace haptrial::experiments {

/// The unit of work: some replications of one cell.
struct PowerUnit {
  std::size_t cell{0};       // of PowerQuestion::cells
  bool sessions{false};      // in full
  int first{0}, count{0};    // replications
  std::string file() const;  // its part's name: "r-00003-0000200.part"
};

/// Every unit of a question, in the order in which parts are merged.
std::vector<PowerUnit> units_of(const PowerQuestion& question);

/// Simulates the replications of a unit: a function of question, cell and replication and of
/// nothing else; random numbers are named after both. A replication that fails has its reason and
/// no tests. Any thread. @throws InputError for a cell whose definition cannot be used; RunError on
/// an interrupt
std::vector<SimulatedStudy> simulated(const PowerQuestion& question, const PowerUnit& unit);

/// The text of a part: what was simulated, with which definition and program, and a checksum.
std::string part_text(const PowerQuestion& question, const PowerUnit& unit,
                      const std::vector<SimulatedStudy>& replications);

/// Reports in a part.
/// @throws InputError for a part that is damaged, or of another definition, program or unit
std::vector<SimulatedStudy> read_part(const std::filesystem::path& file,
                                      const PowerQuestion& question, const PowerUnit& unit);

}  // namespace haptrial::experiments
