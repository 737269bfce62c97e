#include "analysis/files/json_pieces.h"

namespace haptrial::analysis {

void JsonPieces::begin_member(std::string_view name) {
  text_ += first_ ? "{\n  \"" : ",\n  \"";
  first_ = false;
  text_.append(name).append("\": ");
}

/// Within strings JSON has no line breaks, so every one is the layout's.
void JsonPieces::add_indented(std::string_view json, std::string_view indentation) {
  for (std::size_t end; (end = json.find('\n')) != std::string_view::npos;) {
    text_.append(json.substr(0, end + 1)).append(indentation);
    json.remove_prefix(end + 1);
  }
  text_.append(json);
}

void JsonPieces::give_if_long() {
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // [bytes]
  if (text_.size() >= kPiece) {
    take_(text_);
    text_.clear();
  }
}

void JsonPieces::member(std::string_view name, std::string_view json) {
  begin_member(name);
  add_indented(json, "  ");
  give_if_long();
}

void JsonPieces::list(std::string_view name, std::size_t count,
                      const std::function<std::string(std::size_t)>& element) {
  begin_member(name);
  text_ += '[';
  for (std::size_t i = 0; i < count; ++i) {
    text_ += i == 0 ? "\n    " : ",\n    ";
    add_indented(element(i), "    ");
    give_if_long();
  }
  text_ += count == 0 ? "]" : "\n  ]";
}

void JsonPieces::end() {
  text_ += first_ ? "{}\n" : "\n}\n";
  take_(text_);
}

}  // namespace haptrial::analysis
