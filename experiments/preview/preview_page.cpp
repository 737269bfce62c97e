#include "experiments/preview/preview_page.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "analysis/document/figure_gnuplot.h"

namespace haptrial::experiments {

void Preview::add(analysis::Figure figure, std::string svg) {
  drawings_.push_back({std::move(figure), std::move(svg)});
  document.picture(drawings_.back());
}

std::string Preview::html() const {
  std::string page = with_headings_in(analysis::to_html(document), language);
  return page.insert(page.rfind("</body>"), preview_script());
}

void Preview::draw_figures() {
  std::vector<analysis::Figure> waiting;
  for (const analysis::Drawing& drawing : drawings_) {
    if (drawing.svg.empty()) {
      waiting.push_back(drawing.figure);
    }
  }
  std::vector<analysis::Drawing> drawn = analysis::drawn(waiting);
  std::size_t next = 0;
  for (analysis::Drawing& drawing : drawings_) {
    if (drawing.svg.empty()) {
      drawing.svg = std::move(drawn[next++].svg);
    }
  }
}

namespace {

/// German words by the English ones.
const std::map<std::string, std::string, std::less<>>& german() {
  static const std::map<std::string, std::string, std::less<>> words{
      {"Checks", "Prüfung"},
      {"One trial, stage by stage", "Ein Durchgang, Abschnitt für Abschnitt"},
      {"What the participant sees", "Was die Versuchsperson sieht"},
      {"Objects and places", "Gegenstände und Orte"},
      {"What is felt", "Was zu fühlen ist"},
      {"What hands and device carry", "Was Hände und Gerät tragen"},
      {"What the certified device presents", "Was das vermessene Gerät darstellt"},
      {"Trials of the study", "Durchgänge der Studie"},
      {"The trial of a virtual participant", "Der Durchgang einer virtuellen Versuchsperson"},
      {"Contents", "Inhalt"},
      {"Play", "Abspielen"},
      {"Pause", "Anhalten"},
      {"Time in the trial", "Zeit im Durchgang"},
      {"Speed", "Geschwindigkeit"},
      {"Turn", "Drehen"},
      {"Tilt", "Neigen"}};
  return words;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

std::string in_language(std::string_view english, std::string_view language) {
  const auto found = german().find(english);
  return language == "de" && found != german().end() ? found->second : std::string(english);
}

std::string with_headings_in(std::string page, std::string_view language) {
  if (language != "de") {
    return page;
  }
  for (const auto& [english, words] : german()) {
    for (const char* end : {"</h2>", "</h3>", "</a>", "</summary>"}) {
      replace_all(page, fmt::format(">{}{}", english, end),
                  fmt::format("><span lang=\"de\">{}</span>{}", words, end));
    }
  }
  return page;
}

}  // namespace haptrial::experiments
