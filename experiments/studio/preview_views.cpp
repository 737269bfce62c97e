#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/server/request_filter.h"
#include "experiments/studio/views_internal.h"

// The views of an experiment before anybody runs it: its page, and a trial to try.

namespace haptrial::experiments {

namespace fs = std::filesystem;
using nlohmann::json;

json StudioViews::preview(const std::string& file, const std::string& text, int trial,
                          bool virtual_trial, const std::string& language) const {
  const Draft draft(folder_.definition(file), folder_.path(), text);
  const int number = next_number();
  CommandWords words{"show", file, "--trial", std::to_string(trial)};
  if (!virtual_trial) {
    words.emplace_back("--no-virtual-trial");
  }
  if (language == "de") {
    words.insert(words.end(), {"--headings", language});
  }
  const json asked{{"file", draft.name()},
                   {"trial", trial},
                   {"virtual", virtual_trial},
                   {"headings", language},
                   {"out", preview_file(number).string()}};
  const json answer = json::parse(page_answer_to(asked.dump()), nullptr, false);
  json out{{"command", shown_command(words)}};
  if (answer.is_object() && answer.contains("page")) {
    const fs::path page = preview_file(number);
    write_text(page, draft.renamed(file_text(page)));
    out["page"] = number;
  } else {
    const std::string failure = answer.is_object() ? answer.value("failure", "") : "";
    out["failure"] = draft.renamed(failure);
  }
  return out;
}

/// One command makes all pages, since it keeps what takes long to be prepared. It is begun again if
/// it has ended.
std::string StudioViews::page_answer_to(const std::string& asked) const {
  const std::lock_guard lock(pages_mutex_);
  if (pages_ > 0) {
    try {
      return page_maker_.answer(pages_, {asked}).front();
    } catch (const std::runtime_error&) {
      page_maker_.end(pages_);
    }
  }
  const LineCommands::StartedCommand begun = page_maker_.begin({"show", "-", "--pages"});
  pages_ = begun.number;
  if (pages_ == 0) {
    throw RunError(begun.first);
  }
  return page_maker_.answer(pages_, {asked}).front();
}

fs::path StudioViews::preview_file(int number) const {
  return scratch_ / fmt::format("preview-{}.html", number);
}

WebAnswer StudioViews::preview_page(const std::string& number) const {
  const ShortLivedFile page(preview_file(number_of(number)));
  if (!fs::is_regular_file(page.path())) {
    throw InputError("this preview was shown before; ask for a new one");
  }
  const std::string nonce = make_token();
  // The element's text cannot come from a definition, whose texts are escaped.
  WebAnswer answer = framed("text/html; charset=utf-8",
                            replaced(file_text(page.path()), "<script nonce=\"NONCE\">",
                                     fmt::format("<script nonce=\"{}\">", nonce)));
  answer.headers["Content-Security-Policy"] =
      fmt::format("sandbox allow-scripts; script-src 'nonce-{}'; {}", nonce, kFramedPolicy);
  return answer;
}

json StudioViews::try_trial(const std::string& file, const std::string& text, int trial) const {
  const Draft draft(folder_.definition(file), folder_.path(), text);
  const CommandWords words{"show", file, "--trial", std::to_string(trial), "--try"};
  CommandWords asked = words;
  asked[1] = draft.name();
  const LineCommands::StartedCommand begun = tried_.begin(asked);
  json out{{"command", shown_command(words)},
           {"device", shown_command({"run", file, "--pilot", "--device", "mouse", "--window"})}};
  if (begun.number > 0) {
    out["try"] = begun.number;
    out["head"] = json::parse(begun.first, nullptr, false);
  } else {
    out["failure"] = draft.renamed(begun.first);
  }
  return out;
}

json StudioViews::try_move(int number, const json& lines) const {
  constexpr std::size_t kMostLines = 400, kLongestLine = 200;
  std::vector<std::string> words;
  for (const json& line : lines) {
    const std::string text = line.is_string() ? line.get<std::string>() : "\n";
    if (words.size() >= kMostLines || text.size() > kLongestLine || text.find('\n') != text.npos) {
      throw InputError(fmt::format("the body's \"lines\" are not at most {} texts of {} bytes",
                                   kMostLines, kLongestLine));
    }
    words.push_back(text);
  }
  return {{"lines", tried_.answer(number, words)}};
}

json StudioViews::try_end(int number) const {
  tried_.end(number);
  return json::object();
}

}  // namespace haptrial::experiments
