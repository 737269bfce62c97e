#include "protocols/psychophysics/studied_definition.h"

#include <fmt/format.h>

namespace haptrial::protocols {

std::vector<std::string> StudiedDefinition::description() const {
  std::vector<std::string> lines = TrialsDefinition::description();
  if (observer.script) {
    lines.push_back(fmt::format("virtual participants answer by {} (observer.script)",
                                observer.script->file.filename().string()));
  }
  return lines;
}

std::string StudiedDefinition::presenting_script() const { return script ? script->text : ""; }

std::string StudiedDefinition::scripts() const {
  return presenting_script() + (observer.script ? observer.script->text : "");
}

}  // namespace haptrial::protocols
