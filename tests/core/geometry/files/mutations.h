#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>

#include "core/base/random.h"

namespace haptrial::geometry {

/// Spoils a file in one of the ways in which files are spoiled, and in some in which they are not.
inline void mutate(std::string& bytes, RandomStream& random) {
  const auto place = [&] { return static_cast<std::size_t>(random.below(bytes.size() + 1)); };
  static const std::string_view kWords[] = {"0",    "-1",    "4294967296",  "99999999999999999999",
                                            "nan",  "-inf",  "1e999",       "1e-400",
                                            "\n",   "\r\n",  " ",           "#",
                                            "\\\n", "/",     "3",           "f ",
                                            "v ",   "list",  "\xFF",        "\xFF\xFF\xFF\xFF",
                                            "OFF",  "solid", "end_header\n"};
  switch (random.below(8)) {
    case 0:  // a byte
      if (!bytes.empty()) {
        bytes[place() % bytes.size()] = static_cast<char>(random.bits());
      }
      break;
    case 1:  // a bit
      if (!bytes.empty()) {
        bytes[place() % bytes.size()] ^= static_cast<char>(1u << random.below(8));
      }
      break;
    case 2:  // cut off
      bytes.resize(place());
      break;
    case 3: {  // a hole
      const std::size_t from = place();
      bytes.erase(from, random.below(64));
      break;
    }
    case 4: {  // something put in
      const auto word = kWords[random.below(std::size(kWords))];
      bytes.insert(place(), word);
      break;
    }
    case 5: {  // a part again, elsewhere
      const std::size_t from = place();
      const std::string part = bytes.substr(from, random.below(128));
      bytes.insert(place(), part);
      break;
    }
    case 6:  // a digit in the head, where the counts are
      for (std::size_t i = random.below(200); i < bytes.size(); ++i) {
        if (bytes[i] >= '0' && bytes[i] <= '9') {
          bytes[i] = static_cast<char>('0' + random.below(10));
          break;
        }
      }
      break;
    default: {  // a word for another
      const auto word = kWords[random.below(std::size(kWords))];
      const std::size_t from = place();
      bytes.replace(from, std::min(word.size(), bytes.size() - from), word);
    }
  }
}

}  // namespace haptrial::geometry
