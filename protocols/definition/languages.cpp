#include "protocols/definition/languages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

namespace fs = std::filesystem;

std::string own_begin(const fs::path& definition) { return definition.stem().string() + ".texts."; }

constexpr std::string_view kCommonBegin = "texts.";
constexpr std::string_view kEnd = ".toml";

/// Language between the beginning and the end of a file's name; empty if it is another name or no
/// language's.
std::string between(const std::string& name, std::string_view begin) {
  if (!name.starts_with(begin) || !name.ends_with(kEnd) ||
      name.size() <= begin.size() + kEnd.size()) {
    return "";
  }
  const std::string word = name.substr(begin.size(), name.size() - begin.size() - kEnd.size());
  return word.find('.') == std::string::npos ? word : "";
}

}  // namespace

fs::path language_file(const fs::path& definition, const std::string& language) {
  std::error_code ignored;
  for (const std::string& begin : {own_begin(definition), std::string(kCommonBegin)}) {
    const fs::path file = definition.parent_path() / (begin + language + std::string(kEnd));
    if (fs::is_regular_file(file, ignored)) {
      return file;
    }
  }
  return {};
}

fs::path own_language_file(const fs::path& definition, const std::string& language) {
  return definition.parent_path() / (own_begin(definition) + language + std::string(kEnd));
}

void check_language(const std::string& language) {
  constexpr std::size_t kLongest = 16;
  const bool plain = std::all_of(language.begin(), language.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  });
  if (!plain || language.empty() || language.size() > kLongest) {
    throw InputError(
        fmt::format("--language is '{}'; allowed: a language such as de or pt-BR", language));
  }
}

std::vector<std::string> languages_of(const fs::path& definition) {
  std::set<std::string> languages;
  std::error_code ignored;
  const fs::path folder = definition.has_parent_path() ? definition.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    for (const std::string& language :
         {between(name, own_begin(definition)), between(name, kCommonBegin)}) {
      if (!language.empty()) {
        languages.insert(language);
      }
    }
  }
  return {languages.begin(), languages.end()};
}

Translations translations_for(const fs::path& definition, const std::string& language) {
  check_language(language);
  const fs::path file = language_file(definition, language);
  const std::vector<std::string>& known = program_languages();
  const bool program_speaks = std::find(known.begin(), known.end(), language) != known.end();
  if (file.empty() && !program_speaks) {
    const std::vector<std::string> there = languages_of(definition);
    throw InputError(
        fmt::format("{}: there is no {}{}{} with texts for --language {}; languages there: {}",
                    definition.string(), own_begin(definition), language, kEnd, language,
                    there.empty() ? fmt::format("{}", fmt::join(known, ", "))
                                  : fmt::format("{}", fmt::join(there, ", "))));
  }
  Translations translations =
      file.empty() ? Translations{language, own_language_file(definition, language).string()}
                   : load_translations(file, language);
  translations.by_text = program_words(language);
  return translations;
}

Translations recorded_translations(const std::string& language, std::string text,
                                   std::string_view session) {
  Translations translations = parse_translations(std::move(text), session, language);
  translations.by_text = program_words(language);
  return translations;
}

namespace {

using GermanText = std::pair<const char*, const char*>;

constexpr std::array kSessionInGerman{
    GermanText{"Welcome\nFollow what you feel and answer what you are asked.",
               "Willkommen\nFolgen Sie dem, was Sie spüren, und beantworten Sie die Fragen."},
    GermanText{"Practice\nThese trials do not count.", "Übung\nDiese Durchgänge zählen nicht."},
    GermanText{"Time for a rest\nLet go of the handle.",
               "Zeit für eine Pause\nLassen Sie den Griff los."},
    GermanText{"Thank you\nThe session is over.", "Vielen Dank\nDie Sitzung ist zu Ende."},
    GermanText{"Now it counts\nFrom here on every trial counts.",
               "Jetzt zählt es\nVon hier an zählt jeder Durchgang."},
    GermanText{"Take the handle again\nThe break ends now.",
               "Nehmen Sie den Griff wieder\nDie Pause ist gleich vorbei."},
    GermanText{"✓ Correct", "✓ Richtig"},
    GermanText{"✗ Wrong", "✗ Falsch"},
    GermanText{"Too fast", "Zu schnell"},
    GermanText{"Too slow", "Zu langsam"},
    GermanText{"seconds", "Sekunden"},
    GermanText{
        "Stopped\nThe forces are off. Please wait for the experimenter.",
        "Angehalten\nDie Kräfte sind abgeschaltet. Bitte warten Sie auf die Versuchsleitung."},
    GermanText{"A short pause\nThe session continues in a moment.",
               "Eine kurze Pause\nEs geht gleich weiter."},
    GermanText{"One moment\nWhat you are going to work on is being prepared.",
               "Einen Moment\nWoran Sie arbeiten werden, wird vorbereitet."},
    GermanText{
        "One moment\nThe forces are off for a few seconds. Hold the handle loosely: it will "
        "guide your hand to the start.",
        "Einen Moment\nDie Kräfte sind für einige Sekunden abgeschaltet. Halten Sie den Griff "
        "locker: Er führt Ihre Hand gleich zum Anfang."},
    GermanText{"A square in the upper right corner shows that the device is at its force limit.",
               "Ein Quadrat oben rechts zeigt, dass das Gerät nicht stärker drücken kann."},
    GermanText{"The experimenter will start", "Die Versuchsleitung beginnt"},
    GermanText{"Press Enter or the space bar to begin",
               "Drücken Sie die Eingabe- oder die Leertaste, um zu beginnen"},
    GermanText{"Press Enter to go on", "Weiter mit der Eingabetaste"},
    GermanText{"Choose with a number key or the arrows, then press Enter",
               "Wählen Sie mit einer Zifferntaste oder den Pfeiltasten, dann die Eingabetaste"},
    GermanText{"Move the mark with the arrow keys or type a number, then press Enter",
               "Bewegen Sie die Marke mit den Pfeiltasten oder geben Sie eine Zahl ein, dann die "
               "Eingabetaste"},
    GermanText{"Move your hand along the line, then press the button or Enter",
               "Bewegen Sie die Hand entlang der Linie, dann drücken Sie den Knopf oder die "
               "Eingabetaste"},
    GermanText{"Click on the line", "Klicken Sie auf die Linie"},
    GermanText{"Type a number, then press Enter", "Geben Sie eine Zahl ein, dann die Eingabetaste"},
    GermanText{"Type your answer, then press Enter",
               "Geben Sie Ihre Antwort ein, dann die Eingabetaste"},
    GermanText{"Press Backspace to go back", "Zurück mit der Rücktaste"},
    GermanText{"Noted: your last answer was a mistake",
               "Vermerkt: Ihre letzte Antwort war ein Versehen"},
    GermanText{"Thank you\nThese were all questions for now.",
               "Vielen Dank\nDas waren vorerst alle Fragen."},
    GermanText{"Thank you\nThe session ends here.", "Vielen Dank\nDie Sitzung endet hier."},
    GermanText{"You opened the {structure} after {time}", "Eröffnet: {structure}, nach {time}"},
    GermanText{"{time} left", "noch {time}"},
    GermanText{
        "green: planned, removed   blue: planned, left   orange: beyond the plan   red: vital",
        "grün: geplant, entfernt   blau: geplant, übrig   orange: über den Plan hinaus   rot: "
        "zu schonen"},
    GermanText{"I agree to take part", "Ich stimme zu und nehme teil"},
    GermanText{"I do not agree", "Ich stimme nicht zu"},
};

// Load scales in the wording of common German forms; no authorised translation exists.
constexpr std::array kQuestionnairesInGerman{
    GermanText{"Mental demand", "Geistige Anforderung"},
    GermanText{"How mentally demanding was the task?", "Wie geistig anfordernd war die Aufgabe?"},
    GermanText{"Physical demand", "Körperliche Anforderung"},
    GermanText{"How physically demanding was the task?",
               "Wie körperlich anfordernd war die Aufgabe?"},
    GermanText{"Temporal demand", "Zeitliche Anforderung"},
    GermanText{"How hurried or rushed was the pace of the task?",
               "Wie hastig oder gehetzt war das Tempo der Aufgabe?"},
    GermanText{"Performance", "Leistung"},
    GermanText{"How successful were you in accomplishing what you were asked to do?",
               "Wie gut ist Ihnen gelungen, was Sie tun sollten?"},
    GermanText{"Effort", "Anstrengung"},
    GermanText{"How hard did you have to work to accomplish your level of performance?",
               "Wie sehr mussten Sie sich für Ihre Leistung anstrengen?"},
    GermanText{"Frustration", "Frustration"},
    GermanText{"How insecure, discouraged, irritated, stressed and annoyed were you?",
               "Wie unsicher, entmutigt, gereizt, gestresst und verärgert waren Sie?"},
    GermanText{"Very low", "Sehr gering"},
    GermanText{"Very high", "Sehr hoch"},
    GermanText{"Perfect", "Perfekt"},
    GermanText{"Failure", "Misserfolg"},
    GermanText{"Which contributed more to the workload of the task?",
               "Was trug mehr zur Belastung durch die Aufgabe bei?"},
    GermanText{"Writing", "Schreiben"},
    GermanText{"Drawing", "Zeichnen"},
    GermanText{"Throwing", "Werfen"},
    GermanText{"Scissors", "Schere"},
    GermanText{"Toothbrush", "Zahnbürste"},
    GermanText{"Knife (without fork)", "Messer (ohne Gabel)"},
    GermanText{"Spoon", "Löffel"},
    GermanText{"Broom (upper hand)", "Besen (obere Hand)"},
    GermanText{"Striking a match (the match)", "Ein Streichholz anzünden (das Streichholz)"},
    GermanText{"Opening a box (the lid)", "Eine Schachtel öffnen (der Deckel)"},
    GermanText{"Which hand do you prefer to use?", "Welche Hand benutzen Sie lieber?"},
    GermanText{"Left; the other only if I am forced to", "Links; die andere nur, wenn ich muss"},
    GermanText{"Left", "Links"},
    GermanText{"Right", "Rechts"},
    GermanText{"Either hand", "Beide gleich"},
    GermanText{"Right; the other only if I am forced to", "Rechts; die andere nur, wenn ich muss"},
    GermanText{"I have no experience of it", "Damit habe ich keine Erfahrung"},
};

}  // namespace

std::map<std::string, std::string, std::less<>> program_words(std::string_view language) {
  std::map<std::string, std::string, std::less<>> words;
  if (language == "de") {
    for (const auto& [english, german] : kSessionInGerman) {
      words[english] = german;
    }
    for (const auto& [english, german] : kQuestionnairesInGerman) {
      words[english] = german;
    }
  }
  return words;
}

const std::vector<std::string>& program_languages() {
  static const std::vector<std::string> kLanguages{"de"};
  return kLanguages;
}

}  // namespace haptrial::protocols
