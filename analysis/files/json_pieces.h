#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace haptrial::analysis {

/// An object of JSON that is written member by member, so that lists as long as a study never stand
/// in memory whole. Laid out with two spaces, as nlohmann::json::dump(2) does.
class JsonPieces {
 public:
  using Take = std::function<void(const std::string&)>;

  /// @param take  is given the text in pieces, in their order
  explicit JsonPieces(Take take) : take_(std::move(take)) {}

  /// @param name  plain: nothing of it is escaped
  /// @param json  one value, laid out with two spaces
  void member(std::string_view name, std::string_view json);
  /// @param element  gives the value at a place of the list
  void list(std::string_view name, std::size_t count,
            const std::function<std::string(std::size_t)>& element);
  /// The end of the object and of the last line.
  void end();

 private:
  void begin_member(std::string_view name);
  void add_indented(std::string_view json, std::string_view indentation);
  void give_if_long();

  Take take_;
  std::string text_;
  bool first_{true};
};

}  // namespace haptrial::analysis
