#pragma once

#include <span>
#include <string>

#include <CLI/CLI.hpp>

namespace haptrial::experiments {

/// Looks for mistyped words before the line is parsed, so that one sentence names the word and the
/// nearest one known.
/// @param words  what was typed after the command's name
/// @throws InputError for a missing or unknown subcommand and for an unknown option.
void check_words(const CLI::App& app, std::span<char* const> words);

/// CLI11's sentence about the words, with the page of help that tells more.
std::string sentence_of(const CLI::App& app, std::span<char* const> words,
                        const CLI::ParseError& error);

}  // namespace haptrial::experiments
