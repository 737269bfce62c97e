#pragma once

#include <map>
#include <string>
#include <vector>

namespace haptrial::protocols {

struct Presented;

/// Gathers stages that wait until the hand is in a region while a field leads it to a place beside
/// it: a hand that lets itself be led never arrives, and the trial is aborted for ever.
class LeadReport {
 public:
  void add(const Presented& presented);
  /// A sentence for each such stage.
  std::vector<std::string> warnings() const;

 private:
  std::map<std::string, std::string> beside_;  // by stage: the sentence
};

}  // namespace haptrial::protocols
