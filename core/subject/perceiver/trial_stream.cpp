#include "core/subject/perceiver/trial_stream.h"

#include <algorithm>
#include <charconv>

namespace haptrial::subject {

RandomStream trial_stream(std::uint64_t seed, std::string_view name, int trial) noexcept {
  constexpr std::size_t kLongest = 40;
  char text[kLongest + 16];
  name = name.substr(0, kLongest);
  char* end = std::copy(name.begin(), name.end(), text);
  *end++ = ' ';
  end = std::to_chars(end, text + sizeof(text), trial).ptr;
  return {seed, std::string_view(text, static_cast<std::size_t>(end - text))};
}

}  // namespace haptrial::subject
