#pragma once

#include <filesystem>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace haptrial::analysis::reference {

/// Our procedures beside R's. A topic is a script reference/NAME.R, R's answers reference/NAME.csv
/// and a function that compares; reference_test.cpp runs all of them, checks that the scripts still
/// give the kept answers where R is installed, and makes docs/algorithms/statistics-accuracy.md:
///
///     void compare(Answers& r) {
///       const auto a = one_way_anova(DataSet("unequal").groups("value", "group"));
///       r.at("One-way ANOVA", "unequal").is("f", a->f).is("p", a->p);
///     }
///     const Topic kTopic("anova", compare);

/// tests/analysis/statistics/reference: scripts, answers, and data/*.csv, which both R and we read.
std::filesystem::path folder();

/// A column of numbers or texts by name; NaN where the file says NA.
class DataSet {
 public:
  /// @param name  data/NAME.csv. @throws std::runtime_error when it cannot be read.
  explicit DataSet(const std::string& name);

  std::vector<double> numbers(const std::string& column) const;
  const std::vector<std::string>& texts(const std::string& column) const;
  /// The values of each level of a factor, levels in order of their names.
  std::vector<std::vector<double>> groups(const std::string& column,
                                          const std::string& factor) const;
  /// Means of the cells (rows x columns), levels in order of their names.
  std::vector<std::vector<double>> means(const std::string& column, const std::string& rows,
                                         const std::string& columns) const;

 private:
  std::map<std::string, std::vector<std::string>> columns_;
};

/// R's answers to a topic, and how far ours lie from them.
class Answers {
 public:
  struct Procedure {
    std::string name;
    std::string call;                // in R
    std::size_t compared{0};         // values
    double largest_difference{0.0};  // relative to R's value; NaN where ours is one
    std::string where{};             // "case, quantity" of the largest difference
  };

  /// One case of a procedure; is() notes the difference between our value and R's.
  class Case {
   public:
    Case(Answers& answers, std::string procedure, std::string name);
    Case& is(const std::string& quantity, double ours);
    /// The quantities NAME.1, NAME.2, ...; NAME where there is one.
    Case& are(const std::string& quantity, const std::vector<double>& ours);

   private:
    Answers& answers_;
    std::string procedure_;
    std::string name_;
  };

  explicit Answers(const std::filesystem::path& file);
  Case at(const std::string& procedure, const std::string& name);

  const std::vector<Procedure>& procedures() const { return procedures_; }  // in R's order
  /// The comment lines of the file: versions of R and of its packages.
  const std::vector<std::string>& versions() const { return versions_; }
  /// "procedure, case, quantity" of what no comparison asked for.
  std::vector<std::string> unused() const;
  /// R's values by "procedure, case, quantity".
  const std::map<std::string, double>& values() const { return values_; }

 private:
  void note(const std::string& procedure, const std::string& where, double ours);

  std::vector<std::string> versions_;
  std::vector<Procedure> procedures_;
  std::map<std::string, double> values_;
  std::map<std::string, bool> used_;
};

/// |ours - r| / |r|; where r is 0, |ours|.
double relative_difference(double ours, double r);

/// Registers a topic; make it a constant at namespace level.
struct Topic {
  Topic(const std::string& topic, void (*compare)(Answers&));
  std::string name;
  void (*compare)(Answers&);
};
void PrintTo(const Topic& topic, std::ostream* out);  // for messages of failed tests
/// All topics by name.
std::vector<Topic> topics();

}  // namespace haptrial::analysis::reference
