#include "protocols/definition/program_words.h"

#include <array>
#include <utility>

namespace haptrial::protocols {
namespace {

using Words = std::pair<const char*, const char*>;

constexpr std::array kSessionInGerman{
    Words{"Welcome\nFollow what you feel and answer what you are asked.",
          "Willkommen\nFolgen Sie dem, was Sie spüren, und beantworten Sie die Fragen."},
    Words{"Practice\nThese trials do not count.", "Übung\nDiese Durchgänge zählen nicht."},
    Words{"Time for a rest\nLet go of the handle.",
          "Zeit für eine Pause\nLassen Sie den Griff los."},
    Words{"Thank you\nThe session is over.", "Vielen Dank\nDie Sitzung ist zu Ende."},
    Words{"Now it counts\nFrom here on every trial counts.",
          "Jetzt zählt es\nVon hier an zählt jeder Durchgang."},
    Words{"Take the handle again\nThe break ends now.",
          "Nehmen Sie den Griff wieder\nDie Pause ist gleich vorbei."},
    Words{"✓ Correct", "✓ Richtig"},
    Words{"✗ Wrong", "✗ Falsch"},
    Words{"Too fast", "Zu schnell"},
    Words{"Too slow", "Zu langsam"},
    Words{"Stopped\nThe forces are off. Please wait for the experimenter.",
          "Angehalten\nDie Kräfte sind abgeschaltet. Bitte warten Sie auf die Versuchsleitung."},
    Words{"A short pause\nThe session continues in a moment.",
          "Eine kurze Pause\nEs geht gleich weiter."},
    Words{"One moment\nWhat you are going to work on is being prepared.",
          "Einen Moment\nWoran Sie arbeiten werden, wird vorbereitet."},
    Words{"One moment\nThe forces are off for a few seconds. Hold the handle loosely: it will "
          "guide your hand to the start.",
          "Einen Moment\nDie Kräfte sind für einige Sekunden abgeschaltet. Halten Sie den Griff "
          "locker: Er führt Ihre Hand gleich zum Anfang."},
    Words{"A square in the upper right corner shows that the device is at its force limit.",
          "Ein Quadrat oben rechts zeigt, dass das Gerät nicht stärker drücken kann."},
    Words{"The experimenter will start", "Die Versuchsleitung beginnt"},
    Words{"Press Enter or the space bar to begin",
          "Drücken Sie die Eingabe- oder die Leertaste, um zu beginnen"},
    Words{"Press Enter to go on", "Weiter mit der Eingabetaste"},
    Words{"Choose with a number key or the arrows, then press Enter",
          "Wählen Sie mit einer Zifferntaste oder den Pfeiltasten, dann die Eingabetaste"},
    Words{"Move the mark with the arrow keys or type a number, then press Enter",
          "Bewegen Sie die Marke mit den Pfeiltasten oder geben Sie eine Zahl ein, dann die "
          "Eingabetaste"},
    Words{"Type a number, then press Enter", "Geben Sie eine Zahl ein, dann die Eingabetaste"},
    Words{"Type your answer, then press Enter",
          "Geben Sie Ihre Antwort ein, dann die Eingabetaste"},
    Words{"Thank you\nThe session ends here.", "Vielen Dank\nDie Sitzung endet hier."},
    Words{"I agree to take part", "Ich stimme zu und nehme teil"},
    Words{"I do not agree", "Ich stimme nicht zu"},
};

// Load scales in the wording of common German forms; no authorised translation exists.
constexpr std::array kQuestionnairesInGerman{
    Words{"Mental demand", "Geistige Anforderung"},
    Words{"How mentally demanding was the task?", "Wie geistig anfordernd war die Aufgabe?"},
    Words{"Physical demand", "Körperliche Anforderung"},
    Words{"How physically demanding was the task?", "Wie körperlich anfordernd war die Aufgabe?"},
    Words{"Temporal demand", "Zeitliche Anforderung"},
    Words{"How hurried or rushed was the pace of the task?",
          "Wie hastig oder gehetzt war das Tempo der Aufgabe?"},
    Words{"Performance", "Leistung"},
    Words{"How successful were you in accomplishing what you were asked to do?",
          "Wie gut ist Ihnen gelungen, was Sie tun sollten?"},
    Words{"Effort", "Anstrengung"},
    Words{"How hard did you have to work to accomplish your level of performance?",
          "Wie sehr mussten Sie sich für Ihre Leistung anstrengen?"},
    Words{"Frustration", "Frustration"},
    Words{"How insecure, discouraged, irritated, stressed and annoyed were you?",
          "Wie unsicher, entmutigt, gereizt, gestresst und verärgert waren Sie?"},
    Words{"Very low", "Sehr gering"},
    Words{"Very high", "Sehr hoch"},
    Words{"Perfect", "Perfekt"},
    Words{"Failure", "Misserfolg"},
    Words{"Which contributed more to the workload of the task?",
          "Was trug mehr zur Belastung durch die Aufgabe bei?"},
    Words{"Writing", "Schreiben"},
    Words{"Drawing", "Zeichnen"},
    Words{"Throwing", "Werfen"},
    Words{"Scissors", "Schere"},
    Words{"Toothbrush", "Zahnbürste"},
    Words{"Knife (without fork)", "Messer (ohne Gabel)"},
    Words{"Spoon", "Löffel"},
    Words{"Broom (upper hand)", "Besen (obere Hand)"},
    Words{"Striking a match (the match)", "Ein Streichholz anzünden (das Streichholz)"},
    Words{"Opening a box (the lid)", "Eine Schachtel öffnen (der Deckel)"},
    Words{"Which hand do you prefer to use?", "Welche Hand benutzen Sie lieber?"},
    Words{"Left; the other only if I am forced to", "Links; die andere nur, wenn ich muss"},
    Words{"Left", "Links"},
    Words{"Right", "Rechts"},
    Words{"Either hand", "Beide gleich"},
    Words{"Right; the other only if I am forced to", "Rechts; die andere nur, wenn ich muss"},
    Words{"I have no experience of it", "Damit habe ich keine Erfahrung"},
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
