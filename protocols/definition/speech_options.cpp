#include "protocols/definition/speech_options.h"

#include "core/base/definition/schema.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/languages.h"

namespace haptrial::protocols {

const Schema<SpeechOptions>& speech_schema() {
  using S = SpeechOptions;
  static const auto schema =
      Schema<S>()
          .flag("spoken", &S::spoken,
                "Whether the texts of the participant's window are spoken, by espeak-ng")
          .text("voice", &S::voice,
                "Voice of espeak-ng for the texts of the definition itself; those of "
                "`--language` have the voice of their language");
  return schema;
}

SpeechOptions speech_of(const Definition& definition) {
  SpeechOptions options;
  Table root = definition.root();
  if (root.has("display")) {
    Table display = root.table("display");
    speech_schema().read(display, options);
  }
  if (root.has("sounds") && root.table("sounds").has("device")) {
    options.card = root.table("sounds").text("device");
  }
  options.voice = definition.language.empty() ? options.voice : definition.language;
  const auto words = program_words(options.voice);
  if (const auto found = words.find(options.seconds); found != words.end()) {
    options.seconds = found->second;
  }
  return options;
}

}  // namespace haptrial::protocols
