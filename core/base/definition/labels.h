#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

/// The words of a definition, each with a number: formulas compute with numbers only. A word gets
/// its number when it is first named.
class Labels {
 public:
  double number_of(std::string_view word);
  /// The word of a number; nothing if there is none.
  std::optional<std::string> word_of(double number) const;

 private:
  std::vector<std::string> words_;
};

}  // namespace haptrial
