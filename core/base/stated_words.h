#pragma once

#include <string_view>

namespace haptrial {

/// Whether a text has a word, or several in a row, that no letter or digit continues: "ill" is in
/// "Ill, left" but not in "still". Capital and small letters of every alphabet are the same.
/// Letters of scripts without spaces, as Han, Kana and Thai, continue no word: "眠い" is in
/// "眠いので".
/// @param text, word  UTF-8; a word without characters is in no text
bool has_stated_word(std::string_view text, std::string_view word);

}  // namespace haptrial
