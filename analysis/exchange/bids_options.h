#pragma once

#include <string>
#include <vector>

namespace haptrial::exchange {

/// How a BIDS data set is to be written.
struct BidsOptions {
  std::string name{};                  // of the data set; empty: the experiment's
  std::vector<std::string> authors{};  // as the data set is to name them
  std::string program_version{};       // of the exporting program
  int jobs{1};
};

}  // namespace haptrial::exchange
