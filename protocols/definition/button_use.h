#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace haptrial::protocols {

/// A key of a definition that gives buttons of the devices a function.
struct ButtonUse {
  std::string key;           // "buttons.next_tool"
  std::uint32_t buttons{0};  // any of these, a bit each
  /// The part of a trial in which they are heard, by its place in the definition: "stages[2]" is
  /// within "stages", and all are within "".
  std::string heard_in{};
  std::optional<std::size_t> device{};  // whose buttons, from 0; nothing: any device's
};

}  // namespace haptrial::protocols
