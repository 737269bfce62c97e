#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace haptrial::analysis::trials {

/// A text that many rows repeat, as names of a definition and chosen answers are: kept once in the
/// process and never given back, so that a copy is a number. Any thread.
class Word {
 public:
  Word() noexcept = default;  // empty
  /// @throws std::out_of_range after four million different words
  Word(std::string_view text) : number_(number_of(text)) {}
  Word(const std::string& text) : number_(number_of(text)) {}
  Word(const char* text) : number_(number_of(text)) {}

  const std::string& text() const noexcept;
  operator const std::string&() const noexcept { return text(); }
  operator std::string_view() const noexcept { return text(); }
  bool empty() const noexcept { return number_ == 0; }

  friend bool operator==(Word a, Word b) noexcept { return a.number_ == b.number_; }
  friend bool operator==(Word a, const std::string& b) noexcept { return a.text() == b; }
  friend bool operator==(Word a, const char* b) noexcept { return a.text() == b; }

 private:
  static std::uint32_t number_of(std::string_view text);

  std::uint32_t number_{0};
};

}  // namespace haptrial::analysis::trials
