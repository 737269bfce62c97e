#pragma once

#include <chrono>
#include <string>

namespace haptrial::experiments {

/// A line on standard error with share, rate and time left, once the work has taken two seconds.
/// Says nothing where standard error is not a terminal.
class Progress {
 public:
  /// @param total  amount of work, in any unit
  Progress(std::string what, double total);
  ~Progress();  // clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param done  of the total.  @param detail  such as "3 of 12 sessions"; may be empty
  /// @param real_time_rate  units of work that are one second of real time; 0: none are
  void update(double done, const std::string& detail, double real_time_rate);

 private:
  std::string what_;
  double total_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
  std::size_t width_{0};
};

}  // namespace haptrial::experiments
