#include "protocols/definition/program_words.h"

#include <array>
#include <utility>

namespace haptrial::protocols {
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
