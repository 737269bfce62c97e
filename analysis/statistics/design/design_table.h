#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptrial::analysis {

/// One measured value: whose, and under which level of each factor.
struct Observation {
  std::string subject;
  std::vector<std::string> levels;  // (factors)
  double value{0.0};
};

/// A factor of the study. Within participants: somebody has several of its levels. Between:
/// everybody has one.
struct Factor {
  std::string name;
  std::vector<std::string> levels;
  bool within{true};
};

/// The means of each participant in each cell of a design: the values that every test with
/// participants as its unit takes.
struct DesignTable {
  std::vector<Factor> factors;
  std::vector<std::vector<std::size_t>> cells;  // (cells x factors) levels; the last runs fastest
  std::vector<std::string> names;               // (cells) levels joined by ", "
  std::vector<std::size_t> counts;              // (cells) values
  std::vector<std::string> subjects;            // in order of name
  std::vector<std::vector<std::optional<double>>> means;  // (subjects x cells)
  bool crossed{true};                                     // every combination of levels has a value

  /// Participants that have every cell of their own levels between participants.
  std::vector<std::size_t> complete() const;
  std::size_t participants(std::size_t cell) const;
  /// The levels of a factor under which a participant has values.
  std::vector<std::string> levels_of(std::size_t subject, std::size_t factor) const;
  /// Participants with several levels of a factor, by name.
  std::vector<std::string> with_several(std::size_t factor) const;
};

/// @param factors  names, as many as every observation has levels.
/// @param first    levels in the order wanted; others follow, numbers by value before names by
///   letters. Only levels that occur stay. @throws InputError where two conditions have one name
DesignTable design_table(std::span<const Observation> observations,
                         const std::vector<std::string>& factors,
                         const std::vector<std::string>& first = {});

}  // namespace haptrial::analysis
